"""Writing certificates: exact, canonical, whole or not at all."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import json
import pkgutil
import stat
from fractions import Fraction
from pathlib import Path

import pytest

from mcexact import certificate
from mcexact.certificate import Certificate, codec
from mcexact.certificate.controllability import ControllabilityCertificate
from mcexact.certificate.evidence import RateInterval, RootDisc, ShrunkSubspace, ZeroTransfer
from mcexact.certificate.fixed_spectrum import FixedFactorClaim, FixedSpectrumCertificate
from mcexact.checker.kinds import KINDS, check_document
from tests.checker.handmade import FIXED, PAPER, UNCONTROLLABLE


@dataclasses.dataclass(frozen=True)
class SomeMatrix:
    numerators: tuple[tuple[int, ...], ...]
    denominator: int = 1


@dataclasses.dataclass(frozen=True)
class SomePolynomial:
    coefficients: tuple[Fraction, ...]


@dataclasses.dataclass(frozen=True)
class SomePolynomialMatrix:
    coefficients: tuple[tuple[tuple[int, ...], ...], ...]
    denominator: int = 1


X_MINUS_1 = SomePolynomial((Fraction(-1), Fraction(1)))
FIXED_SPECTRUM = FixedSpectrumCertificate(
    system=PAPER,
    subject=(),
    polynomial=X_MINUS_1,
    factors=(FixedFactorClaim(X_MINUS_1, 3, 1, ("2", "3"), 2, False, (RootDisc("1", "0", "0"),)),),
    stabilizable=False,
    best_rate=RateInterval("-1", "-1"),
    gains=(SomeMatrix(((1, 0),)), SomeMatrix(((2,),)), SomeMatrix(((0,),))),
    modulus=101,
    subspaces=(
        ShrunkSubspace(
            ("1",),
            SomePolynomialMatrix((((1, 0), (0, 0), (0, 1)),)),
            SomePolynomialMatrix((((0, 0),),)),
            (0, 2),
        ),
    ),
    completion=(SomeMatrix(((0,), (0,), (1,))), SomeMatrix(((0, 0, 1),))),
)
CONTROLLABILITY = ControllabilityCertificate(
    UNCONTROLLABLE["system"],
    (),
    ("1",),
    1,
    False,
    SomePolynomial((Fraction(-2), Fraction(1))),
    7,
    SomeMatrix(((0, 1),)),
    (1,),
)


def test_a_certificate_becomes_the_document_of_the_format() -> None:
    assert codec.document(FIXED_SPECTRUM) == FIXED
    assert codec.document(CONTROLLABILITY) == UNCONTROLLABLE
    assert check_document(codec.encode(FIXED_SPECTRUM).encode()).verdict == "VALID"


def test_equal_certificates_give_equal_bytes() -> None:
    text = codec.encode(FIXED_SPECTRUM)
    assert text == codec.encode(dataclasses.replace(FIXED_SPECTRUM))
    assert text.isascii()
    assert text.endswith("}\n")
    assert json.loads(text) == FIXED
    assert " " not in text.replace("mcexact", "")


def test_a_float_has_no_place_in_a_certificate() -> None:
    with pytest.raises(TypeError, match="found float"):
        codec.encode(dataclasses.replace(CONTROLLABILITY, system={"A": [[0.5]]}))


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    target = tmp_path / "certificate.json"
    codec.write(CONTROLLABILITY, target)
    first = target.read_text()
    assert first == codec.encode(CONTROLLABILITY)
    assert stat.S_IMODE(target.stat().st_mode) & 0o600 == 0o600
    with pytest.raises(TypeError):
        codec.write(dataclasses.replace(CONTROLLABILITY, modulus=7.5), target)  # type: ignore[arg-type]
    assert target.read_text() == first
    assert list(tmp_path.iterdir()) == [target]
    with pytest.raises(OSError, match="No such file"):
        codec.write(CONTROLLABILITY, tmp_path / "missing" / "certificate.json")


def test_zero_transfers_are_written_with_their_channels() -> None:
    zero = ZeroTransfer(("2",), SomeMatrix(((0,), (1,))), (1,))
    assert codec.plain(zero) == {
        "from": ["2"],
        "X": {"denominator": 1, "entries": [[0], [1]]},
        "pivots": [1],
    }


def test_kinds_and_rules_correspond() -> None:
    kinds = set()
    for module in pkgutil.iter_modules(certificate.__path__):
        loaded = importlib.import_module(f"mcexact.certificate.{module.name}")
        for _, found in inspect.getmembers(loaded, inspect.isclass):
            if issubclass(found, Certificate) and found.kind:
                kinds.add(found.kind)
    assert set(KINDS) <= kinds
