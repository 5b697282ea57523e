"""The stored outputs of the notebooks are what their cells give."""

from __future__ import annotations

import ast
import contextlib
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))
SPARED = "not-compared"
"""The tag of a cell that is run and not compared: its numbers depend on the processor."""


def code_cells(path: Path) -> Iterator[dict[str, Any]]:
    """Yield the cells of a notebook that have code."""
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            yield cell


def stored(cell: dict[str, Any]) -> str:
    """What a cell printed and gave when it was stored, as text."""
    texts = (
        each["text"] if each["output_type"] == "stream" else each["data"]["text/plain"]
        for each in cell["outputs"]
    )
    return "".join("".join(text) for text in texts)


def given(source: str, names: dict[str, Any]) -> str:
    """Run a cell: what it prints, and the last expression as a notebook shows it."""
    *first, last = ast.parse(source).body
    out = io.StringIO()
    shown = isinstance(last, ast.Expr) and not source.rstrip().endswith(";")
    body = first if shown else [*first, last]
    value = None
    with contextlib.redirect_stdout(out):
        exec(compile(ast.Module(body, []), "<cell>", "exec"), names)
        if shown and isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "<cell>", "eval"), names)
    return out.getvalue() + ("" if value is None else repr(value))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore")
def test_a_notebook_gives_what_it_has_stored(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MPLBACKEND", "agg")
    names: dict[str, Any] = {"__name__": "__main__"}
    for cell in code_cells(path):
        source = "".join(cell["source"])
        found = given(source, names)
        if SPARED not in cell["metadata"].get("tags", []):
            assert found.split() == stored(cell).split(), source


def test_every_notebook_compares_cells_and_has_been_executed() -> None:
    assert len(NOTEBOOKS) == 3
    for path in NOTEBOOKS:
        spared = [SPARED in cell["metadata"].get("tags", []) for cell in code_cells(path)]
        assert spared.count(False) >= 5, path.stem
        assert all(cell["execution_count"] for cell in code_cells(path)), path.stem
