"""Certificates of answers: exact, canonical, written whole or not at all, and read back."""

from __future__ import annotations

import dataclasses
import json
import stat
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, fixed_spectrum
from mcexact.answer import protocol
from mcexact.answer.check import check, load_certificate
from mcexact.answer.evidence import RateInterval, RootDisc, ShrunkSubspace, ZeroTransfer
from mcexact.answer.modes import Completion, FixedFactor, FixedSpectrum, TwoPolynomials
from mcexact.checker.kinds import check_document
from mcexact.errors import InputError, NotWritten
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.text import plain
from tests.checker.handmade import FIXED
from tests.wording import refusal

PLANT = MultiChannelSystem(
    [[1, 0, 0], [0, 1, 0], [0, 1, 1]],
    [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
    [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
    neighbors={"1": ["2"], "2": ["3"], "3": ["1"]},
)
X_MINUS_1 = Polynomial.of(-1, 1)
EVIDENCE = TwoPolynomials(
    gains=tuple(Matrix.from_integers(F) for F in ([[1, 0]], [[2]], [[0]])),
    modulus=101,
    subspaces=(
        ShrunkSubspace(
            ("1",),
            PolynomialMatrix.from_matrices(Matrix.from_integers([[1, 0], [0, 0], [0, 1]])),
            PolynomialMatrix.from_matrices(Matrix.zeros(1, 2)),
            (0, 2),
        ),
    ),
    completion=Completion(Matrix.column([0, 0, 1]), Matrix.from_integers([[0, 0, 1]])),
)
FIXED_SPECTRUM = FixedSpectrum(
    PLANT,
    polynomial=X_MINUS_1,
    factors=(FixedFactor(X_MINUS_1, 3, 1, ("2", "3"), 2, False, (RootDisc("1", "0", "0"),)),),
    stabilizable=False,
    best_rate=RateInterval("-1", "-1"),
    evidence=EVIDENCE,
)


def with_modulus(number: float) -> FixedSpectrum:
    """The same with another modulus."""
    evidence = dataclasses.replace(EVIDENCE, modulus=number)  # type: ignore[arg-type]
    return dataclasses.replace(FIXED_SPECTRUM, evidence=evidence)


def test_an_answer_becomes_the_document_of_the_format() -> None:
    assert protocol.document(FIXED_SPECTRUM) == FIXED
    assert check_document(protocol.encode(FIXED_SPECTRUM).encode()).verdict == "VALID"


def test_equal_answers_give_equal_bytes() -> None:
    text = protocol.encode(FIXED_SPECTRUM)
    again = dataclasses.replace(FIXED_SPECTRUM)
    assert again == FIXED_SPECTRUM
    assert hash(again) == hash(FIXED_SPECTRUM)
    assert with_modulus(103) != FIXED_SPECTRUM
    assert text == protocol.encode(again)
    assert text.isascii()
    assert text.endswith("}\n")
    assert json.loads(text) == FIXED
    assert " " not in text.replace("mcexact", "")


def test_a_float_has_no_place_in_a_certificate() -> None:
    with pytest.raises(TypeError, match="found float"):
        protocol.encode(with_modulus(0.5))


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    target = tmp_path / "certificate.json"
    protocol.save_certificate(FIXED_SPECTRUM, target)
    first = target.read_text()
    assert first == protocol.encode(FIXED_SPECTRUM)
    assert stat.S_IMODE(target.stat().st_mode) & 0o600 == 0o600
    with pytest.raises(TypeError):
        protocol.save_certificate(with_modulus(7.5), target)
    assert target.read_text() == first
    assert list(tmp_path.iterdir()) == [target]
    with pytest.raises(NotWritten, match="No such file"):
        protocol.save_certificate(FIXED_SPECTRUM, tmp_path / "missing" / "certificate.json")


def test_a_file_is_read_back_as_the_answer_that_was_written(tmp_path: Path) -> None:
    file = tmp_path / "certificate.json"
    found = fixed_spectrum(PLANT)
    protocol.save_certificate(found, file)
    read = load_certificate(file)
    assert isinstance(read, FixedSpectrum)
    assert read == found
    assert read.about == PLANT
    assert read.factors == found.factors
    assert read.evidence == found.evidence


def test_a_file_that_names_its_plant_by_digest_is_read_with_the_plant(tmp_path: Path) -> None:
    file = tmp_path / "certificate.json"
    found = fixed_spectrum(PLANT)
    protocol.save_certificate(found, file, system_by_digest=True)
    assert json.loads(file.read_text())["system"] == PLANT.digest()
    assert {**json.loads(file.read_text()), "system": found.system} == protocol.document(found)
    assert load_certificate(file, PLANT) == found
    whole, named = check(found), check(file, PLANT)
    assert named == whole
    with refusal(InputError):
        load_certificate(file)
    with pytest.raises(InputError, match="NOT ABOUT system system: about another system"):
        load_certificate(file, MultiChannelSystem([[0]], [[[1]]], [[[1]]]))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"stabilizable": True}, r"certificate\.json: the checker does not accept it \(INVALID"),
        ({"polynomial": 3}, r"certificate\.json: the checker does not accept it \(MALFORMED"),
    ],
)
def test_only_what_the_checker_accepts_is_read(
    change: dict[str, Any], said: str, tmp_path: Path
) -> None:
    file = tmp_path / "certificate.json"
    document = protocol.document(FIXED_SPECTRUM)
    document["claim"] |= change
    file.write_text(json.dumps(document))
    with pytest.raises(InputError, match=said):
        load_certificate(file)
    with refusal(InputError):
        load_certificate(tmp_path / "missing.json")


def test_a_zero_transfer_is_written_with_its_channels() -> None:
    zero = ZeroTransfer(("2",), Matrix.column([0, 1]), (1,))
    assert plain(zero) == {
        "from": ["2"],
        "X": {"denominator": 1, "entries": [[0], [1]]},
        "pivots": [1],
    }
