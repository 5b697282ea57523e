"""Plants near a nominal one that have a fixed mode, or that their channels do not control."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np

from mcexact.analysis.boxes.rank_drops import Freedom, Uncertain
from mcexact.answer.protocol import Answer
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, to_float, vstack
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

_PAIRS = 6
FAILING = "failing_loop"
"""The name of the answer that the loop of a plant nearby is not stable."""


@dataclass(frozen=True)
class FailingPlant:
    """A plant near a nominal one that lacks the property in question.

    Attributes
    ----------
    plant : MultiChannelSystem
    distance : Fraction
        The largest change of an entry, as a multiple of its radius.
    mode : complex
        About the mode that is fixed, or not controlled, or on the border.
    channels : tuple of str
        The channels s whose outputs do not show the mode.
    refutation : Answer or None
        The exact answer that the plant, or its loop, fails, where it was decided.
    """

    plant: MultiChannelSystem
    distance: Fraction
    mode: complex
    channels: tuple[str, ...]
    refutation: Answer | None = None

    def facts(self, system: MultiChannelSystem) -> dict[str, Any]:
        """What a sentence says of it: its distance from a plant, and in which unit.

        Radii are the unit if the plant has some that are no part of the moduli of its entries, and
        else these moduli.
        """
        if system.uncertainty is None:
            return {"fails_within": self.distance, "of_radii": False}
        part = Box(system).part
        distance = self.distance if part is None else self.distance * part
        return {"fails_within": distance, "of_radii": part is None}


def tried_sets(m: int) -> list[tuple[int, ...]]:
    """The sets of channels that are tried: none, one or two, and all but so many.

    Of up to five channels these are all sets; of many channels pairs are left out.
    """
    small: list[tuple[int, ...]] = [(), *((i,) for i in range(m))]
    if m <= _PAIRS:
        small += combinations(range(m), 2)
    rests = [tuple(j for j in range(m) if j not in s) for s in small]
    return sorted({*small, *rests}, key=lambda s: (len(s), s))


def failing_plant(
    system: MultiChannelSystem,
    radii: Radii,
    sets: Iterable[tuple[int, ...]],
    tries: int,
    region: StabilityRegion | None = None,
) -> FailingPlant | None:
    """Search a plant near a system with a fixed mode, the pencil of a set s of which loses rank.

    Parameters
    ----------
    system : MultiChannelSystem
    radii : Radii
        The units in which changes of entries are measured.
    sets : iterable of tuples of int
        The sets s.
    tries : int
        How many sets and modes are tried, those that seem nearest first.
    region : StabilityRegion, optional
        The fixed mode is to be on its border, or outside.
    """
    starts = (
        [] if tries < 1 else sorted(_starts(system, radii, sets, region), key=lambda each: each[0])
    )
    best: FailingPlant | None = None
    for _, s, pencil, point, freedom in starts[:tries]:
        near = pencil.drop(point, freedom)
        if near is not None and freedom == "plane" and _is_inside(near.point, region):
            continue
        limit = None if best is None else best.distance
        if near is None or (limit is not None and near.size >= limit):
            continue
        made = pencil.exact(near, freedom)
        if made is None or (limit is not None and made[1] >= limit):
            continue
        plant = _changed(system, s, made[0])
        best = FailingPlant(plant, made[1], near.point, system.named(s))
    return best


def _is_inside(point: complex, region: StabilityRegion | None) -> bool:
    if region is None:
        return False
    return (abs(point) if region.discrete else point.real) < to_float(region.limit)


def _points(
    modes: list[complex], region: StabilityRegion | None
) -> Iterator[tuple[complex, Freedom]]:
    """Where a search begins: at modes that are not in the region, and at its border near all."""
    for mode in modes:
        if not _is_inside(mode, region):
            yield mode, "plane"
        if region is not None and region.discrete:
            yield (mode / abs(mode) if mode else 1.0) * to_float(region.limit), "circle"
        elif region is not None:
            yield complex(to_float(region.limit), mode.imag), "line"


def _starts(
    system: MultiChannelSystem,
    radii: Radii,
    sets: Iterable[tuple[int, ...]],
    region: StabilityRegion | None,
) -> Iterator[tuple[float, tuple[int, ...], Uncertain, complex, Freedom]]:
    """The singular values of the pencils of sets at numbers near eigenvalues, and what of."""
    values = np.linalg.eigvals(matrix_to_float(system.A)) if system.n else np.zeros(0)
    points = [*_points([complex(value) for value in values if value.imag >= 0], region)]
    for s in sets:
        T = [i for i in range(system.m) if i not in s]
        pencil = Uncertain(
            _pencil(system.A, [system.B[i] for i in T], [system.C[i] for i in s]),
            _pencil(radii.A, [radii.B[i] for i in T], [radii.C[i] for i in s]),
            system.n,
            system.n - 1,
        )
        for point, freedom in points:
            yield pencil.smallest(point), s, pencil, point, freedom


def _pencil(A: Matrix, B: list[Matrix], C: list[Matrix]) -> Matrix:
    """[A, B_T; C_s, 0]: λE less this has the rank of the pencil of s."""
    n = A.nrows
    top, low = hstack([A, *B], nrows=n), vstack(C, ncols=n)
    return vstack([top, hstack([low, Matrix.zeros(low.nrows, top.ncols - n)])])


def _changed(system: MultiChannelSystem, s: tuple[int, ...], change: Matrix) -> MultiChannelSystem:
    """The plant with a change of the matrix of the pencil of s."""
    n, column, row = system.n, system.n, system.n
    B, C = list(system.B), list(system.C)
    for i in range(system.m):
        if i in s:
            C[i] = C[i] + change.take(range(row, row + system.q(i)), range(n))
            row += system.q(i)
        else:
            B[i] = B[i] + change.take(range(n), range(column, column + system.p(i)))
            column += system.p(i)
    return MultiChannelSystem(
        system.A + change.take(range(n), range(n)),
        B,
        C,
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )


def severed_plants(
    system: MultiChannelSystem, radii: Radii, *, inputs: bool = False
) -> Iterator[FailingPlant]:
    """Plants whose channels have no inputs or no outputs, the nearer of both, and also A = 0.

    Every mode of these is fixed.  Where radii are parts of the entries, a plant within the whole
    entries always fails so, if not before.

    Parameters
    ----------
    system : MultiChannelSystem
    radii : Radii
        The units in which changes of entries are measured; an entry of radius 0 never vanishes.
    inputs : bool
        Whether all channels lose their inputs.

    Examples
    --------
    >>> from mcexact.model.box import Box
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> halves = Box.absolute(plant, B=[[["1/2"]]]).radii
    >>> [(found.distance, found.plant.B[0].is_zero()) for found in severed_plants(plant, halves)]
    [(Fraction(2, 1), True)]
    """
    B, C, distance = list(system.B), list(system.C), Fraction(0)
    shown = []
    for i in range(system.m):
        ways = [(_whole(B[i], radii.B[i]), B), (None if inputs else _whole(C[i], radii.C[i]), C)]
        able = [(size, matrices) for size, matrices in ways if size is not None]
        if not able:
            return
        size, matrices = min(able, key=lambda each: each[0])
        matrices[i] = matrices[i] * 0
        distance = max(distance, size)
        shown += [system.names[i]] if matrices is C else []
    for A, stop in ((system.A, Fraction(0)), (system.A * 0, _whole(system.A, radii.A))):
        if stop is not None:
            plant = MultiChannelSystem(
                A, B, C, time=system.time, names=system.names, neighbors=system.neighbors
            )
            yield FailingPlant(plant, max(distance, stop), 0j, tuple(shown))


def _whole(M: Matrix, D: Matrix) -> Fraction | None:
    """The multiple of the radii with which all entries can vanish; None if one is certain."""
    found = Fraction(0)
    for i, j, x in M.nonzero():
        if not D[i, j]:
            return None
        found = max(found, Fraction(abs(x), M.denominator) / D[i, j])
    return found
