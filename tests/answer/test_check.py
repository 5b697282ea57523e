"""Checking from Python is the same as checking files."""

from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, check, dual, fixed_spectrum
from mcexact.answer import codec
from mcexact.errors import InputError

PLANT = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])


def test_a_certificate_and_its_file_get_the_same_verdict(tmp_path: Path) -> None:
    certificate = fixed_spectrum(PLANT)
    file = tmp_path / "fixed_spectrum.json"
    codec.save_certificate(certificate, file)
    assert check(certificate) == check(file) == check(str(file), PLANT)
    assert check(file).verdict == "VALID"
    assert "x - 2" in check(file).theorem


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
