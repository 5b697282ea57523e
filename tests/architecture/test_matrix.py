"""The matrix of environments: what it runs, what it names, and that it goes on after failures."""

from pathlib import Path

import pytest

from tests import matrix
from tests.matrix import Cell, Outcome

BROKEN, SKIPPED, FINE = (Cell(name) for name in ("broken", "python3.99", "fine"))


@pytest.fixture
def three(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Cells of which the first fails and the second cannot be run."""
    outcomes = {
        "broken": Outcome("failed", "1 failed, 3 passed", 2.4),
        "python3.99": Outcome("skipped", "Python 3.99 is neither on PATH nor in PYTHONS"),
        "fine": Outcome("passed", "4 passed", 2.0),
    }
    monkeypatch.setattr(matrix, "FOLDER", tmp_path / "matrix")
    monkeypatch.setattr(matrix, "cells", lambda: iter((BROKEN, SKIPPED, FINE)))
    monkeypatch.setattr(matrix, "run", lambda cell, found: outcomes[cell.name])


@pytest.mark.usefixtures("three")
def test_a_failed_cell_stops_nothing_and_is_the_status(capsys: pytest.CaptureFixture[str]) -> None:
    assert matrix.main([]) == 1
    table = capsys.readouterr().out.rpartition("\n\n")[2].splitlines()
    assert [line.split()[:2] for line in table] == [
        ["broken", "failed"],
        ["python3.99", "skipped"],
        ["fine", "passed"],
    ]
    assert "1 failed, 3 passed" in table[0] and "Python 3.99" in table[1]


@pytest.mark.usefixtures("three")
def test_cells_are_chosen_by_patterns(capsys: pytest.CaptureFixture[str]) -> None:
    assert matrix.main(["python*", "fi*"]) == 0
    assert "broken" not in capsys.readouterr().out
    assert matrix.main(["nothing"]) == 2
    assert "broken, python3.99, fine" in capsys.readouterr().err


def test_kernels_are_run_with_one_thread_and_with_four_in_turn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    kernels = ("Haswell", "Prescott", "Zen")
    made = [
        {"OPENBLAS_CORETYPE": kernel, "OPENBLAS_NUM_THREADS": threads}
        for kernel in kernels
        for threads in ("1", "4")
    ]
    monkeypatch.setattr(matrix, "usable_kernels", lambda: kernels)
    monkeypatch.setattr(matrix, "environments", lambda: (*made, {"NPY_DISABLE_CPU_FEATURES": "X"}))
    chosen = [cell.name for cell in matrix.cells() if cell.chosen]
    assert chosen[:4] == ["Haswell-1", "Prescott-4", "Zen-1", "plain-loops"]
    assert [cell.name for cell in matrix.cells() if not cell.chosen] == [
        "Haswell-4",
        "Prescott-1",
        "Zen-4",
    ]


def test_a_version_that_is_not_there_is_named() -> None:
    outcome = matrix.run(Cell("python3.99", version="3.99"), {})
    assert outcome.verdict == "skipped"
    assert outcome.said == "Python 3.99 is neither on PATH nor in PYTHONS"


@pytest.mark.parametrize(
    ("output", "said"),
    [
        ("...\n4 passed in 2.00s\n", "4 passed"),
        ("FAILED x - in 3.1s\n1 failed, 3 passed, 2 errors in 65.1s (0:01:05)\n",
         "1 failed, 3 passed, 2 errors"),
        ("...\nKilled\n", "the tests did not end"),
    ],
)  # fmt: skip
def test_the_counts_are_those_of_the_last_line(output: str, said: str) -> None:
    assert matrix.counts(output) == said
