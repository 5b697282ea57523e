"""Plants near a nominal one that have a fixed mode, or that their channels do not control."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

import numpy as np

from mcexact.analysis.boxes.rank_drops import Uncertain
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.floats import matrix_to_float
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from mcexact.model.uncertainty import Radii

_PAIRS = 6


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
    """

    plant: MultiChannelSystem
    distance: Fraction
    mode: complex
    channels: tuple[str, ...]


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
    """
    starts = sorted(_starts(system, radii, sets), key=lambda each: each[0])
    best: FailingPlant | None = None
    for _, s, pencil, point in starts[:tries]:
        near = pencil.drop(point)
        limit = None if best is None else best.distance
        if near is None or (limit is not None and near.size >= limit):
            continue
        made = pencil.exact(near)
        if made is None or (limit is not None and made[1] >= limit):
            continue
        plant = _changed(system, s, made[0])
        best = FailingPlant(plant, made[1], near.point, system.named(s))
    return best


def _starts(
    system: MultiChannelSystem, radii: Radii, sets: Iterable[tuple[int, ...]]
) -> Iterator[tuple[float, tuple[int, ...], Uncertain, complex]]:
    """The singular values of the pencils of sets at the eigenvalues of A, and what they are of."""
    values = np.linalg.eigvals(matrix_to_float(system.A)) if system.n else np.zeros(0)
    modes = [complex(value) for value in values if value.imag >= 0]
    for s in sets:
        T = [i for i in range(system.m) if i not in s]
        pencil = Uncertain(
            _pencil(system.A, [system.B[i] for i in T], [system.C[i] for i in s]),
            _pencil(radii.A, [radii.B[i] for i in T], [radii.C[i] for i in s]),
            system.n,
            system.n - 1,
        )
        for mode in modes:
            yield pencil.smallest(mode), s, pencil, mode


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
