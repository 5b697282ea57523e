"""A library of an extra that is not installed is named with the line that installs it."""

from __future__ import annotations

import pickle
import sys
from pathlib import Path

import pytest

from mcexact.cli import main
from mcexact.errors import MissingExtra
from mcexact.floating.verdicts import control_rank
from mcexact.model import gallery
from mcexact.plot.canvas import _figure_class, empty_figure
from tests.wording import worded

PLANT = str(Path(gallery.__file__).with_name("hidden-triple-mode.json"))
DRAWING = {
    "analyze": ("analyze", PLANT, "--html", "FILE.html"),
    "certify": ("certify", PLANT, PLANT, "--html", "FILE.html"),
    "design": ("design", "decentralized", PLANT, "--html", "FILE.html"),
    "simulate": ("simulate", PLANT, PLANT, "-o", "FILE.png"),
    "a page of simulate": ("simulate", PLANT, PLANT, "-o", "FILE.html"),
    "reproduce": ("reproduce",),
}


@pytest.mark.parametrize("arguments", DRAWING.values(), ids=DRAWING)
def test_a_command_that_draws_ends_before_the_work(
    arguments: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(SystemExit) as ended:
        main([each.replace("FILE", str(tmp_path / "result")) for each in arguments])
    assert ended.value.code == 69
    assert worded(capsys.readouterr().err)
    assert not list(tmp_path.iterdir())


def test_a_table_is_written_without_the_library_that_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(SystemExit) as ended:
        main(["simulate", PLANT, PLANT, "-o", str(tmp_path / "run.csv")])
    assert ended.value.code == 3  # the second file is no controller
    assert "matplotlib" not in capsys.readouterr().err


def test_python_gets_an_import_error_that_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    _figure_class.cache_clear()
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(MissingExtra, match=r"pip install 'mcexact\[plot\]'") as raised:
        empty_figure(1, 1)
    assert isinstance(raised.value, ModuleNotFoundError)
    assert raised.value.name == "matplotlib.figure"


def test_another_library_that_is_missing_is_named_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "control", None)
    with pytest.raises(MissingExtra, match=r"needs control.*'mcexact\[control\]'"):
        control_rank("ctrb", None, None)


def test_the_error_comes_back_from_another_process() -> None:
    try:
        MissingExtra.require("plot", "a_library_that_is_missing")
    except MissingExtra as error:
        assert str(pickle.loads(pickle.dumps(error))) == str(error)
    else:
        raise AssertionError
