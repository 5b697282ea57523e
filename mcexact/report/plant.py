"""The matrices of a system on a page, large ones cut, and what else is known of it."""

from __future__ import annotations

import re
from fractions import Fraction
from itertools import islice
from typing import Any

from mcexact.answer.formats import count
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import approximated
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.box import radii_in_words
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.report.mathml import matrix

LARGEST, CUT = 12, 8
"""Up to how many rows and columns a matrix is shown whole, and how many are shown of a larger one;
the same for channels."""
_SINGLE = re.compile(r"\((\w+(?:\^\d+)?)\)")
"""A number, a parameter or its power in parentheses, which it does not need."""


def shown_plant(system: MultiChannelSystem | ParametricSystem) -> dict[str, Any]:
    """Return what a page shows of a system.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem

    Returns
    -------
    dict
        ``rows`` of labels and values, ``matrices`` in MathML, ``listed`` large matrices with few
        entries as labels and texts, and ``notes`` that say what was cut or rounded.
    """
    shown = _first(system.m)
    # Columns beside columns and rows beside rows take the least room.
    named: list[tuple[str, Any]] = [
        ("A", system.A),
        *((f"B_{k + 1}", system.B(k)) for k in range(shown)),
    ]
    named += [(f"C_{k + 1}", system.C(k)) for k in range(shown)]
    listed = {name: M for name, M in named if _is_listed(M)}
    drawn = [(name, M) for name, M in named if name not in listed]
    notes = []
    cut = [f"{name} is {M.nrows} × {M.ncols}" for name, M in drawn if max(M.shape) > LARGEST]
    if cut:
        some = ", ".join(cut[:4]) + (", …" if len(cut) > 4 else "")
        notes.append(
            f"Large matrices are cut: {some}; their first {CUT} rows and columns are shown."
        )
    if shown < system.m:
        notes.append(f"Of {system.m} channels the first {shown} are shown.")
    corners = [(name, _corner(M)) for name, M in drawn]
    entries = [x for _, M in corners for row in M.tolist() for x in row]
    entries += [M[i, j] for M in listed.values() for i, j, _ in M.nonzero()]
    if any(map(_is_rounded, entries)):
        notes.append("Numbers with ≈ are rounded; the system file has them exactly.")
    return {
        "rows": _facts(system),
        "matrices": [
            matrix(name, _texts(M, whole))
            for (name, M), (_, whole) in zip(corners, drawn, strict=True)
        ],
        "listed": [(f"{name}, {M.nrows} × {M.ncols}", _entries(M)) for name, M in listed.items()],
        "notes": notes,
    }


def _is_listed(M: Matrix | FunctionMatrix) -> bool:
    """Whether a matrix is large and has so few entries that these say more than a corner."""
    if isinstance(M, FunctionMatrix):
        return False
    return max(M.shape) > LARGEST and next(islice(M.nonzero(), CUT, None), None) is None


def _entries(M: Matrix) -> str:
    """The entries of a matrix that are not 0, with their places counted from 1."""
    texts = [f"({i + 1}, {j + 1}) is {_short(M[i, j])}" for i, j, _ in M.nonzero()]
    return f"0 except for {', '.join(texts)}" if texts else "0"


def _facts(system: MultiChannelSystem | ParametricSystem) -> tuple[tuple[str, str], ...]:
    names = ", ".join(system.names[: _first(system.m)])
    more = ", …" if _first(system.m) < system.m else ""
    rows = [
        ("time", system.time),
        ("states", str(system.n)),
        ("channels", f"{system.m}: {names}{more}"),
    ]
    if isinstance(system, ParametricSystem):
        rows.append(("parameters", ", ".join(system.parameters_in_words)))
    elif system.neighbors is not None:
        edges = sum(1 for j, i in system.neighbors.edges() if i != j)
        rows.append(("links between agents", count(edges, "link")))
    if system.uncertainty is not None:
        told = radii_in_words(system)
        rows.append(("uncertainty", f"{told}; the matrices are those of the nominal values"))
    rows.append(("source", system.source or "not stated in the system file"))
    rows.append(("SHA-256 of the system", system.digest()))
    return tuple(rows)


def _first(number: int) -> int:
    """How many of a number of things are shown."""
    return number if number <= LARGEST else CUT


def _corner(M: Any) -> Any:
    rows, columns = map(_first, M.shape)
    return M.take(rows=range(rows), cols=range(columns))


def _texts(corner: Any, whole: Any) -> list[list[str]]:
    """The entries of a corner as texts, with dots where the matrix goes on."""
    texts = [[_short(entry) for entry in row] for row in corner.tolist()]
    if corner.ncols < whole.ncols:
        texts = [[*row, "⋯"] for row in texts]
    if corner.nrows < whole.nrows:
        texts.append(["⋮"] * len(texts[0]) if texts else [])
    return texts


def _short(x: Fraction | RationalFunction) -> str:
    """A number exactly if that is short, otherwise rounded; a function as its text."""
    return _SINGLE.sub(r"\1", str(x)) if isinstance(x, RationalFunction) else approximated(x)


def _is_rounded(x: Fraction | RationalFunction) -> bool:
    return isinstance(x, Fraction) and approximated(x).startswith("≈")
