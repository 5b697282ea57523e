"""The help of every design shows one spectrum of each form that is accepted."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mcexact.cli import command_line
from mcexact.cli.design import COEFFICIENTS, NUMBERS, PAIRS, ROOTS, spectrum_text
from mcexact.errors import InputError
from mcexact.synthesis.state_feedback import require_numbers, spectrum_polynomial


def help_of(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    command_line.main(["design", name, "--help"], standalone_mode=False)
    return capsys.readouterr().out


@pytest.mark.parametrize("name", ["decentralized", "extended", "observer", "setpoint"])
def test_every_example_is_read_as_a_spectrum(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    _, examples = help_of(name, capsys).split("Examples for --spectrum")
    lines = [line.strip() for line in examples.splitlines()]
    documents = [json.loads(line) for line in lines if line.startswith('{"')]
    assert len(documents) == (4 if name == "decentralized" else 3)
    assert (f"'{NUMBERS}'" in lines) == (name in {"decentralized", "extended"})
    for document in documents:
        require_numbers(document)
        assert set(document) in ({"closed_loop"}, {"feedback", "error"})


def test_all_forms_are_the_same_polynomial() -> None:
    assert str(spectrum_polynomial(ROOTS, 3)) == "x^3 + 3*x^2 + 7*x + 5"
    assert spectrum_polynomial(ROOTS, 3) == spectrum_polynomial(COEFFICIENTS, 3)
    assert spectrum_polynomial(ROOTS, 3) == spectrum_polynomial(PAIRS, 3)
    assert spectrum_polynomial(ROOTS, 3) == spectrum_polynomial(typed(NUMBERS), 3)
    assert spectrum_polynomial(ROOTS, 3) == spectrum_polynomial(np.array([-1, -1 + 2j, -1 - 2j]), 3)


def typed(text: str) -> Any:
    found = spectrum_text(text)
    assert found is not None
    return json.loads(found)


@pytest.mark.parametrize(
    "text",
    ["-1+2i, -1-2i, -3", "-1 + 2i, -3", "-3,-1-2j", "15,11,5,1", ' ["-1+2i", -3]', "-3.0,-1e0+2i"],
)
def test_numbers_and_json_are_read_as_text(text: str) -> None:
    assert str(spectrum_polynomial(typed(text), 3)) == "x^3 + 5*x^2 + 11*x + 15"


@pytest.mark.parametrize("text", ["spectrum.json", "-", "spectrum", "", ",", "-1,x"])
def test_everything_else_is_the_name_of_a_file(text: str) -> None:
    assert spectrum_text(text) is None


def test_a_file_is_read_whatever_its_name_is(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    assert spectrum_text("-1,-2") is not None
    Path("-1,-2").write_text("[-3]", encoding="utf-8")
    assert spectrum_text("-1,-2") is None


def test_blanks_between_numbers_do_not_join_them() -> None:
    with pytest.raises(InputError, match="found '1 2'"):
        require_numbers(typed("1 2, 3"))
