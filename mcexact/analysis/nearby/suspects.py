"""Eigenvalues that hardly move, and the sets of channels at which they are nearly fixed.

A search in floating point, with numpy alone, for the modes λ and sets s of channels at which
P_s(λ) = [λI − A, B_T; C_s, 0], T the complement of s, nearly has a rank below n.  It proves
nothing: `corrections` makes a plant that exactly has such a mode.

1. Units (`balanced`).  A plant in other units of states, inputs, outputs and time has other
   entries and the same fixed modes.  The units are chosen such that the logarithms of all entries
   are as small as can be, by least squares with Huber's weights: then neither the user's units nor
   single entries that are rounding errors matter.
2. Eigenvalues.  Of a loop with drawn gains those are kept that have a near one in another drawn
   loop and in the open loop.
3. Widest paths.  With the singular vectors v and w of N = λI − A_F at its smallest singular values,
   let C_i v be the width of an edge source → i, w*B_j that of j → sink, and C_i N⁺ B_j that of
   j → i.  A mode is fixed exactly if no path leads from the source to the sink.  The widest path
   has the *bottleneck* β, and the channels that the source reaches over wider edges are T.  So no
   subset is enumerated; two more cuts, at the source and at the sink, are about all channels.
"""

from __future__ import annotations

# Of the standard library: numpy's own would load numpy.random and numpy.ma, for 0.02 s.
import random
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from statistics import median
from typing import Any

import numpy as np

from mcexact.exact.matrix import matrix_to_float
from mcexact.model.system import MultiChannelSystem

Floats = Any

_ROUNDS = 6
_HUBER = 3.0
"""Entries so many powers of 2 from 1 count less: they may be rounding errors."""
_RIDGE = 1e-6
_MOST = 12
_LARGE = 100
"""Of so many states fewer eigenvalues are looked at: each takes a decomposition."""
_FEW = 30
"""Of so few states both drawn loops are looked at, so that the luck of one draw matters less."""
_NEAR = 0.05
"""An eigenvalue that moves by a larger part of its size and of A is not looked at."""
_CLUSTERS = (1e-3, 3e-2)
_SMALL = 1e-2
_DIMENSIONS = 4
"""The most singular values that count as small together."""
_UNLIKELY = 1e-2
"""Wider paths are not looked at: the nearest plant with that mode is too far."""


@dataclass(frozen=True)
class Units:
    """Powers of 2 by which states, inputs and outputs are measured, and the rate of time.

    Attributes
    ----------
    states, inputs, outputs : ndarray of int
        The exponents; a state of the plant is 2^states times the balanced one.
    time : int
        The balanced A is 2^−time times that of the plant in these units.
    """

    states: Floats
    inputs: Floats
    outputs: Floats
    time: int


@dataclass(frozen=True)
class Balanced:
    """A plant in balanced units, with its channels.

    Attributes
    ----------
    A, B, C : ndarray
        B and C of all channels side by side and below each other.
    of_inputs, of_outputs : ndarray of int
        The channel of each column of B and of each row of C.
    m : int
    units : Units
    """

    A: Floats
    B: Floats
    C: Floats
    of_inputs: Floats
    of_outputs: Floats
    m: int
    units: Units


@dataclass(frozen=True)
class Suspect:
    """A mode that hardly moves.

    Attributes
    ----------
    bottleneck : float
        The width of the widest path, in balanced units; 0 of a fixed mode.
    point : complex
        The eigenvalue, in balanced units of time.
    outside : tuple of int
        T, the channels whose inputs nearly do not act on what the others show of the mode.
    """

    bottleneck: float
    point: complex
    outside: tuple[int, ...]


def balanced(system: MultiChannelSystem) -> Balanced | None:
    """Measure a plant in balanced units; None if an entry is beyond the range of floats.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 1024], ["-1/1024", 0]], [[[0], [8]]], [[["1/4", 0]]])
    >>> units = balanced(plant)
    >>> max(float(abs(M).max()) for M in (units.A, units.B, units.C)) <= 2
    True
    """
    A, m = matrix_to_float(system.A), system.m
    B = matrix_to_float(system.input_matrix())
    C = matrix_to_float(system.output_matrix())
    if not all(np.isfinite(M).all() for M in (A, B, C)):
        return None
    units = _units(A, B, C)
    t, u, v = units.states, units.inputs, units.outputs
    return Balanced(
        np.ldexp(A, t[None, :] - t[:, None] - units.time),
        np.ldexp(B, u[None, :] - t[:, None]),
        np.ldexp(C, t[None, :] + v[:, None]),
        np.repeat(np.arange(m), [p for p, _ in system.sizes]),
        np.repeat(np.arange(m), [q for _, q in system.sizes]),
        m,
        units,
    )


def _units(A: Floats, B: Floats, C: Floats) -> Units:
    """The exponents x that minimize Σ h(log₂|entry| + differences of x), h Huber's function.

    With D the incidence matrix of the entries this is a sequence of weighted least squares
    (Dᵀ W D) x = −Dᵀ W log₂|entries|.
    """
    n, p, q = len(A), B.shape[1], len(C)
    size = n + p + q + 1
    heads, tails, logs = [], [], []
    for M, row, column in ((A, 0, 0), (B, 0, n), (C, n + p, 0)):
        I, J = np.nonzero(M)
        logs.append(np.log2(np.abs(M[I, J])))
        # An entry from state j to state i is measured by t_j − t_i, and an output by t_j + v.
        tails.append(J + column)
        heads.append(I + row)
    signs = np.concatenate([np.full(len(k), s) for k, s in zip(heads, (-1, -1, 1), strict=True)])
    head, tail, log = map(np.concatenate, (heads, tails, logs))
    in_A = np.arange(len(log)) < len(logs[0])
    D = (head, tail, signs, in_A)
    x, weights = np.zeros(size), np.ones(len(log))
    start = median(logs[0].tolist()) if len(logs[0]) else 0.0
    for _ in range(_ROUNDS):
        x = _least_squares(D, log, weights, size, start)
        rest = log + np.where(head == tail, 0.0, x[tail] + signs * x[head]) - in_A * x[-1]
        weights = np.minimum(1.0, _HUBER / np.maximum(np.abs(rest), 1e-9))
    rounded = np.rint(x).astype(int)
    return Units(rounded[:n], rounded[n : n + p], rounded[n + p : n + p + q], int(rounded[-1]))


def _least_squares(D: Any, log: Floats, weights: Floats, size: int, start: float) -> Floats:
    """The weighted least squares of the logarithms; a small weight keeps each unknown near 0."""
    head, tail, signs, in_A = D
    normal, right = np.zeros((size, size)), np.zeros(size)
    last = size - 1
    loops = head == tail
    columns = [(tail, np.where(loops, 0.0, 1.0)), (head, np.where(loops, 0.0, signs))]
    columns.append((np.full(len(log), last), -in_A.astype(float)))
    for first, a in columns:
        np.add.at(right, first, -weights * a * log)
        for second, b in columns:
            np.add.at(normal, (first, second), weights * a * b)
    normal[np.arange(size), np.arange(size)] += _RIDGE
    right[last] += _RIDGE * start
    return np.linalg.solve(normal, right)


def suspects(plant: Balanced, discrete: bool) -> Iterator[Suspect]:
    """Yield modes that hardly move, for each of several cuts, those outside the region as well.

    Parameters
    ----------
    plant : Balanced
    discrete : bool
        Whether the region of stability is the unit disc.
    """
    n = len(plant.A)
    if not n:
        return
    rng = random.Random(1)
    size = max(float(np.abs(plant.A).sum(axis=1).max()) / np.sqrt(n), 1e-9)
    first, second = (_loop(plant, rng, size) for _ in range(2))
    moved, others = np.linalg.eigvals(first), np.linalg.eigvals(second)
    still = np.linalg.eigvals(plant.A)
    moved = moved[moved.imag >= 0]
    far = np.maximum(_distances(moved, others), _distances(moved, still))
    part = far / np.maximum(size, np.abs(moved) + 1e-3 * size)
    limit = 2.0**-plant.units.time if discrete else 0.0
    margin = 1e-3 * size
    unstable = np.abs(moved) >= limit - margin if discrete else moved.real >= -margin
    order = np.argsort(part)
    most, near = (_MOST, _NEAR) if n < _LARGE else (_MOST // 3, _NEAR / 50)
    chosen = [*order[:most], *order[unstable[order]][: most // 2]]
    for k in dict.fromkeys(int(k) for k in chosen):
        if part[k] < near:
            point = _rounded(complex(moved[k]), size)
            yield from _cuts(plant, first, point, size)
            if n <= _FEW:
                other = _rounded(complex(others[np.abs(others - point).argmin()]), size)
                yield from _cuts(plant, second, other, size)
            means = [_middle(point, moved, radius * size) for radius in _CLUSTERS]
            for middle in dict.fromkeys(means):
                if middle is not None:
                    yield from _cuts(plant, first, middle, size)


def _rounded(point: complex, size: float) -> complex:
    """A point near the real axis on it."""
    return complex(point.real, 0.0) if abs(point.imag) < 1e-9 * size else point


def _middle(point: complex, points: Floats, radius: float) -> complex | None:
    """The mean of several eigenvalues nearby, which is far more accurate than each of them."""
    whole = np.concatenate([points, points[points.imag > 0].conj()])
    cluster = whole[np.abs(whole - point) < radius]
    if len(cluster) < 2:
        return None
    mean = complex(cluster.mean())
    return complex(mean.real, 0.0) if abs(mean.imag) < 1e-6 * radius else mean


def _distances(points: Floats, others: Floats) -> Floats:
    return np.abs(points[:, None] - others[None, :]).min(axis=1)


def _loop(plant: Balanced, rng: random.Random, size: float) -> Floats:
    """A + Σ B_i F_i C_i, with gains of moduli from 1/2 to 1 times the size of A."""
    F = np.zeros((plant.B.shape[1], len(plant.C)))
    I, J = np.nonzero(plant.of_inputs[:, None] == plant.of_outputs[None, :])
    F[I, J] = [rng.uniform(0.5, 1.0) * rng.choice((-1.0, 1.0)) for _ in I]
    loop = plant.B @ F @ plant.C
    return plant.A + loop * (size / max(1.0, float(np.abs(loop).max(initial=0.0))))


def _cuts(plant: Balanced, loop: Floats, point: complex, size: float) -> Iterator[Suspect]:
    """The cuts at one eigenvalue of a loop, of the narrowest bottleneck of several dimensions."""
    n, m = len(loop), plant.m
    N = (point if point.imag else point.real) * np.eye(n) - loop
    U, sizes, Vh = np.linalg.svd(N)
    best: dict[str, Suspect] = {}
    for few in range(1, min(_DIMENSIONS, n) + 1):
        cut = n - few
        if few > 1 and sizes[cut] > _SMALL * sizes[0]:
            break
        shown = np.abs(plant.C @ Vh[cut:].conj().T).max(axis=1, initial=0.0)
        acted = np.abs(U[:, cut:].conj().T @ plant.B).max(axis=0, initial=0.0)
        inner = (U[:, :cut].conj().T @ plant.B) / np.maximum(sizes[:cut, None], 1e-300)
        through = np.abs(plant.C @ (Vh[:cut].conj().T @ inner)) * size
        source, sink, inside = np.zeros(m), np.zeros(m), np.zeros((m, m))
        np.maximum.at(source, plant.of_outputs, shown)
        np.maximum.at(sink, plant.of_inputs, acted)
        if through.size:
            np.maximum.at(inside, (plant.of_outputs[:, None], plant.of_inputs[None, :]), through)
        ways = {
            "path": widest(source, sink, inside),
            "source": (float(source.max(initial=0.0)), ()),
            "sink": (float(sink.max(initial=0.0)), tuple(range(m))),
        }
        for way, (bottleneck, T) in ways.items():
            if way not in best or bottleneck < best[way].bottleneck:
                best[way] = Suspect(bottleneck, point, T)
    unlike = {each.outside: each for each in sorted(best.values(), key=lambda s: -s.bottleneck)}
    yield from (each for each in unlike.values() if each.bottleneck < _UNLIKELY)


def widest(source: Floats, sink: Floats, inside: Floats) -> tuple[float, tuple[int, ...]]:
    """The bottleneck of the widest path from the source to the sink, and the cut that it leaves.

    Parameters
    ----------
    source, sink : ndarray, m
        The widths of the edges source → i and j → sink.
    inside : ndarray, m × m
        That of j → i is ``inside[i, j]``.

    Returns
    -------
    bottleneck : float
    T : tuple of int
        The channels to which a wider path leads from the source.

    Examples
    --------
    >>> widest(np.array([2.0, 0.0]), np.array([0.0, 3.0]), np.array([[9.0, 0.0], [0.5, 9.0]]))
    (0.5, (0,))
    """
    width, done = source.astype(float), np.zeros(len(source), dtype=bool)
    for _ in range(len(source)):
        k = int(np.argmax(np.where(done, -1.0, width)))
        done[k] = True
        width = np.maximum(width, np.minimum(width[k], inside[:, k]))
    bottleneck = float(np.minimum(width, sink).max(initial=0.0))
    return bottleneck, tuple(int(i) for i in np.nonzero(width > bottleneck)[0])


def by_bottleneck(found: Iterable[Suspect]) -> list[Suspect]:
    """The suspects, those with the narrowest bottleneck first, and of each mode and set one."""
    kept: dict[Any, Suspect] = {}
    for each in sorted(found, key=lambda each: each.bottleneck):
        kept.setdefault((round(each.point.real, 9), round(each.point.imag, 9), each.outside), each)
    return list(kept.values())
