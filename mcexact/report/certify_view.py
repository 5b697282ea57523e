"""The verdict on a controller as a table for people and as plain data for programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.exact.rational import to_float
from mcexact.report.text import Table
from mcexact.synthesis.certify import ControllerVerdict


def verdict_view(found: ControllerVerdict, warnings: Sequence[str] = ()) -> dict[str, Any]:
    """The verdict; ``certified`` is whether every eigenvalue lies in the region."""
    region = found.verdict.region
    return {
        "certified": found.verdict.stable,
        "time": region.time,
        "bound": None if region.bound is None else str(region.bound),
        "region": str(region),
        "method": found.verdict.method,
        "states": found.loop.n,
        "blocks": list(found.blocks),
        "largest": None if found.largest is None else str(found.largest),
        "warnings": list(warnings),
    }


def verdict_tables(found: ControllerVerdict) -> tuple[Table, ...]:
    """The verdict in a few lines."""
    region = found.verdict.region
    how = {
        "polynomial": "by the characteristic polynomial",
        "lyapunov": "by Lyapunov matrices"
        + (f", blocks of {_listed(found.blocks)} states" if len(found.blocks) > 1 else ""),
        "instability": "by a quadratic form that decreases and is not positive",
    }[found.verdict.method]
    answer = "yes, every one" if found.verdict.stable else "no, not every one"
    rows = [
        ("states of the loop", str(found.loop.n)),
        (f"eigenvalues in {region}", f"{answer}, exactly"),
        ("decided", how),
    ]
    if found.largest is not None:
        what = "largest rate" if region.time == "continuous" else "least radius"
        rows.append((f"{what} found", f"{found.largest} (about {to_float(found.largest):.6g})"))
    return (Table("closed loop", (), tuple(rows)),)


def _listed(sizes: tuple[int, ...]) -> str:
    """Numbers with commas and an and."""
    return ", ".join(map(str, sizes[:-1])) + f" and {sizes[-1]}"
