"""Checking from Python is the same as checking files."""

from pathlib import Path
from typing import Any

import pytest

from mcexact import (
    MultiChannelSystem,
    check,
    design_decentralized,
    dual,
    fixed_spectrum,
    save_controller,
)
from mcexact.answer import codec
from mcexact.errors import InputError

PLANT = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])


def test_a_certificate_and_its_file_get_the_same_verdict(tmp_path: Path) -> None:
    certificate = fixed_spectrum(PLANT)
    file = tmp_path / "fixed_spectrum.json"
    codec.save_certificate(certificate, file)
    assert check(certificate) == check(file) == check(str(file), PLANT)
    assert check(file).verdict == "VALID"
    assert "x - 2" in check(file).statement


def test_a_certificate_about_a_derived_system_is_about_its_plant() -> None:
    certificate = fixed_spectrum(dual(PLANT))
    assert check(certificate, PLANT).verdict == "VALID"
    assert check(certificate, dual(PLANT)).verdict == "VALID"


def test_what_is_no_certificate_is_not_valid(tmp_path: Path) -> None:
    file = tmp_path / "empty.json"
    file.write_bytes(b"")
    assert check(file).verdict == "MALFORMED"
    with pytest.raises(InputError, match=r"missing\.json: there is no such file"):
        check(tmp_path / "missing.json")


@pytest.mark.parametrize("value", [{}, None, 3, b"{}", [], PLANT])
def test_what_is_neither_a_certificate_nor_a_file_is_refused(value: Any) -> None:
    kind = type(value).__name__
    expected = f"certificate: expected an answer, such as .*, found {kind}"
    with pytest.raises(InputError, match=expected):
        check(value)


def test_what_is_no_system_is_refused() -> None:
    with pytest.raises(InputError, match="system: expected a MultiChannelSystem, found dict"):
        check(fixed_spectrum(PLANT), {})  # type: ignore[arg-type]


def test_the_controller_can_be_an_object_or_a_file(tmp_path: Path) -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    design, other = (design_decentralized(plant, rate=rate) for rate in (1, 3))
    save_controller(design.controller, tmp_path / "controller.json")
    for controller in (design.controller, tmp_path / "controller.json"):
        for certificate in map(design.certificates.get, ("stability", "closed_loop_spectrum")):
            assert check(certificate, plant, controller).verdict == "VALID"  # type: ignore[arg-type]
        refused = check(other.certificates["stability"], controller=controller)
        assert (refused.verdict, refused.code) == ("INVALID", "controller")


def test_the_statement_or_the_claim_can_be_expected() -> None:
    certificate, claim = fixed_spectrum(PLANT), codec.document(fixed_spectrum(PLANT))["claim"]
    found = check(certificate)
    for expected in (found.statement, found.statement_digest, claim):
        assert check(certificate, PLANT, expect=expected).verdict == "VALID"
    assert check(certificate, expect="0" * 64).code == "expected"
    assert check(certificate, expect={**claim, "stabilizable": True}).code == "expected"


def test_what_cannot_be_asked_is_refused(tmp_path: Path) -> None:
    certificate = fixed_spectrum(PLANT)
    with pytest.raises(InputError, match="controller: expected a Controller, found int"):
        check(certificate, controller=3)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"there is no such file"):
        check(certificate, controller=tmp_path / "controller.json")
    with pytest.raises(InputError, match="expect: expected a str, found list"):
        check(certificate, expect=[])  # type: ignore[arg-type]
    with pytest.raises(InputError, match="expect: file: expected a statement, its SHA-256, or"):
        check(certificate, expect="it is stable")
    (tmp_path / "controller.json").write_text("{}", encoding="ascii")
    with pytest.raises(InputError, match=r"controller: controller: the key .* is missing"):
        check(certificate, controller=tmp_path / "controller.json")
