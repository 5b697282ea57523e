"""The help of every design shows one spectrum of each form that is accepted."""

from __future__ import annotations

import json

import pytest

from mcexact.cli import command_line
from mcexact.cli.spectra import COEFFICIENTS, PAIRS, ROOTS
from mcexact.synthesis.methods.spectrum import require_numbers, spectrum_polynomial


def help_of(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    command_line.main(["design", name, "--help"], standalone_mode=False)
    return capsys.readouterr().out


@pytest.mark.parametrize("name", ["decentralized", "extended", "observer", "setpoint"])
def test_every_example_is_read_as_a_spectrum(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    _, examples = help_of(name, capsys).split("Examples of a file for --spectrum")
    lines = [line.strip() for line in examples.splitlines()]
    documents = [json.loads(line) for line in lines if line.startswith('{"')]
    assert len(documents) == (4 if name == "decentralized" else 3)
    for document in documents:
        require_numbers(document)
        assert set(document) in ({"closed_loop"}, {"feedback", "error"})


def test_all_forms_are_the_same_polynomial() -> None:
    assert str(spectrum_polynomial(ROOTS, 3)) == "x^3 + 3*x^2 + 7*x + 5"
    assert spectrum_polynomial(ROOTS, 3) == spectrum_polynomial(COEFFICIENTS, 3)
    assert spectrum_polynomial(ROOTS, 3) == spectrum_polynomial(PAIRS, 3)
