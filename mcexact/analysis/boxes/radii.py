"""The radii of the entries of a plant, or of a system that constructions made from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from mcexact.analysis.boxes.float_range import require_float_range
from mcexact.answer.reading import constructed
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.box import Box
from mcexact.model.radii import Radii, moduli
from mcexact.model.system import MultiChannelSystem


def radii_of(system: MultiChannelSystem) -> Radii:
    """Return the radii of all entries of a system; those of constants are 0.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, or a system made from one by constructions.

    Raises
    ------
    LimitReached
        If floating point cannot search with the entries.
    UsageError
        If a construction closes a loop: its stability is a matter of `box_stability`.

    Notes
    -----
    With |S| the moduli of all entries, D their radii, and T the constructions, which add and
    multiply entries, with the moduli of their gains: all T(S') are within T(|S| + D) − T(|S|) of
    T(S).  Where entries are copied this is the radius of each copy.  A sum, such as A + Σ B_i F_i
    C_i, may be uncertain in a way that no member is, as its terms are taken as independent.

    Examples
    --------
    >>> from mcexact import dual
    >>> from mcexact.derived.constructions import feedback
    >>> plant = MultiChannelSystem([[1]], [[[2, 3]]], [[[4]]])
    >>> box = Box.relative(plant, "1/2").system
    >>> radii_of(dual(box)).C[0].numerators
    ((2,), (3,))
    >>> radii_of(feedback(box, [[[0], [-1]]])).A[0, 0]  # 1/2, and 9/2 · 6 − 3 · 4
    Fraction(31, 2)
    """
    radii = Box(system.plant).radii
    require_float_range(_matrices(system), (D for _, D in radii.matrices()))
    if not system.subject:
        return radii
    low = _with_entries(system.plant, map(moduli, _matrices(system.plant)))
    both = zip(_matrices(low), radii.matrices(), strict=True)
    high = _with_entries(low, (M + D for M, (_, D) in both))
    for each in system.subject:
        if each["construction"] == "closed_loop":
            raise UsageError("radii of a closed loop are a matter of box_stability")
        low, high = (_made(each, known) for known in (low, high))
    A, *ports = (M - N for M, N in zip(_matrices(high), _matrices(low), strict=True))
    return Radii(A, ports[: high.m], ports[high.m :])


def _made(construction: Mapping[str, Any], system: MultiChannelSystem) -> MultiChannelSystem:
    """The moduli of what a construction with the moduli of its gains makes of a system."""
    given = dict(construction)
    if "gains" in given:
        sizes = [moduli(F) for F in given["gains"]]
        given["gains"] = [{"denominator": F.denominator, "entries": F.numerators} for F in sizes]
    made: MultiChannelSystem = constructed(system, [given])
    return _with_entries(made, map(moduli, _matrices(made)))


def _matrices(system: MultiChannelSystem) -> list[Matrix]:
    return [system.A, *(c.B for c in system.channels), *(c.C for c in system.channels)]


def _with_entries(system: MultiChannelSystem, entries: Iterable[Matrix]) -> MultiChannelSystem:
    """A plant with the channels and the neighbors of a system, and these A, B_i and C_i."""
    A, *ports = entries
    return MultiChannelSystem(
        A,
        ports[: system.m],
        ports[system.m :],
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )
