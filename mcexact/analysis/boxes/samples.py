"""Sampled plants near one whose loop with a controller is not stable.

The entries of a plant in continuous time act on its samples through the exponential, so that the
small changes of `boxes.failure` do not apply.  `failing_samples` follows a gradient instead: of an
eigenvalue of the loop with respect to all entries, by one derivative of the exponential.  In the
norm of a box the steepest direction moves every entry by all of its radius, up or down.  The first
plant along it whose loop leaves the region is found by bisection, and there the next direction is
computed.  So the plants are corners of boxes, whose entries have few digits.

All of this is floating point, and finding none proves nothing.  Whether the loop of such a plant
fails is decided exactly afterwards, for its samples to the decimals of the given one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any

import numpy as np

from mcexact.analysis.boxes.failure import FailingPlant
from mcexact.analysis.boxes.pencils import Floats
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, to_float, vstack
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem

_TURNS, _DOUBLINGS, _HALVINGS, _DIGITS = 4, 12, 20, 3
"""The directions that are tried one after the other, how often a border is doubled and halved, and
the digits of a distance."""
_FARTHEST = 1e3
_BEYOND = (Fraction(1), Fraction(1001, 1000), Fraction(101, 100))
"""How much farther a plant is than where an eigenvalue seems to be on the border."""


def failing_samples(
    loop: ClosedLoop, region: StabilityRegion, tries: int
) -> Iterator[FailingPlant]:
    """Yield plants near a sampled one whose loops seem to leave a region, the nearest first.

    Parameters
    ----------
    loop : ClosedLoop
        Of a sampled plant; the plant in continuous time has the radii that distances refer to.
    region : StabilityRegion
        In discrete time.
    tries : int
        From how many eigenvalues of the loop a search starts.

    Yields
    ------
    FailingPlant
        In continuous time, at a corner of a multiple of its box.

    Examples
    --------
    >>> from mcexact.derived.sampling import sampled_system
    >>> from mcexact.model.loop import closed_loop
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = Box.relative(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), 1).system
    >>> sampled = sampled_system(plant, "1/10")
    >>> loop = closed_loop(sampled, local_controllers(sampled, [[[-3]]]))
    >>> near = next(failing_samples(loop, StabilityRegion("discrete"), 1))
    >>> near.plant.A, near.plant.B[0], near.distance  # d = 1/3 has 1 + d = 3 (1 - d)^2
    (Matrix.from_rows([['667/500']]), Matrix.from_rows([['333/500']]), Fraction(167, 500))
    """
    samples = _Samples(loop)
    limit, D = to_float(region.limit), samples.radii
    found = list[tuple[float, Floats, complex]]()
    for first in samples.directions(np.zeros_like(D))[:tries]:
        direction = first
        for _ in range(_TURNS):
            distance = samples.border(direction, limit)
            if distance is None:
                break
            nearby = distance * direction * D
            found.append((distance, direction, samples.outermost(nearby)))
            direction = samples.directions(nearby, outermost=True)[0]
    for distance, direction, mode in sorted(found, key=lambda each: each[0]):
        for times in _BEYOND:
            factor = _above(distance * to_float(times))
            yield FailingPlant(samples.member(direction, factor), factor, mode, ())


def _above(x: float) -> Fraction:
    """A number with three significant digits, rounded up."""
    scale = Fraction(10) ** (_DIGITS - 1 - int(np.floor(np.log10(x))))
    return Fraction(-(-(Fraction(x) * scale) // 1)) / scale


@dataclass
class _Samples:
    """The loop of a sampled plant in floating point, as a function of [A, B; C, 0] of the plant.

    Attributes
    ----------
    loop : ClosedLoop
    """

    loop: ClosedLoop

    def __post_init__(self) -> None:
        sampled = self.loop.plant
        plant, box = sampled.plant, Box(sampled.plant)
        (how,) = sampled.subject
        self.h, self.n, self.late = to_float(Fraction(how["step"])), plant.n, bool(how["late"])
        self.nominal, self._exact_radii = box.nominal, box.radii
        self.entries = _joined(plant.A, list(plant.B), list(plant.C))
        self.radii = _joined(box.radii.A, list(box.radii.B), list(box.radii.C))
        parts, N = self.loop.disturbed, sampled.n
        self.M, self.G, self.U, self.K = (
            matrix_to_float(each) for each in (parts.M, parts.G, parts.U, parts.K)
        )
        self.to_plant, self.from_state = np.eye(len(self.M))[:, : self.n], np.eye(len(self.M))[:N]
        self.held = self._held(self.entries)

    def _held(self, entries: Floats) -> Floats:
        """[A_h, B_h] of [A, B; C, 0]."""
        from scipy.linalg import expm

        n, width = self.n, entries.shape[1]
        X = np.zeros((width, width))
        X[:n] = entries[:n]
        held: Floats = expm(self.h * X)[:n]
        return held

    def matrix(self, moved: Floats) -> Floats:
        """The loop of the plant with moved entries."""
        n, x = self.n, self.from_state[: self.n]
        held, dC = self._held(self.entries + moved) - self.held, moved[n:, :n]
        if self.late:
            acting = held @ self.from_state[: held.shape[1]]
        else:
            acting = held[:, :n] @ x + held[:, n:] @ (self.U + self.K @ dC @ x)
        M: Floats = self.M + self.G @ dC @ x + self.to_plant @ acting
        return M

    def outermost(self, moved: Floats) -> complex:
        """The eigenvalue of the largest modulus."""
        values = np.linalg.eigvals(self.matrix(moved))
        return complex(max(values, key=abs, default=0))

    def directions(self, moved: Floats, *, outermost: bool = False) -> list[Floats]:
        """Signs of changes of all entries that move an eigenvalue outward fastest.

        The eigenvalues that seem to reach the border first come first, or the outermost alone.
        """
        from scipy.linalg import eig, expm_frechet

        n, M, dC = self.n, self.matrix(moved), moved[self.n :, : self.n]
        width, x = self.entries.shape[1], self.from_state[:n]
        X = np.zeros((width, width))
        X[:n] = (self.entries + moved)[:n]
        used = self.U + self.K @ dC @ x
        entering = self.G
        if not self.late:
            more = (self._held(self.entries + moved) - self.held)[:, n:]
            entering = entering + self.to_plant @ more @ self.K
        spectrum: Any = eig(M, left=True)
        values, left, right = spectrum
        order = [k for k in np.argsort(-np.abs(values)) if values[k].imag >= 0]
        ranked = list[tuple[float, Floats]]()
        for k in order[:1] if outermost else order:
            size, w, v = abs(values[k]), left[:, k].conj(), right[:, k]
            scale = w @ v
            if not size or abs(scale) < 1e-12:
                continue
            turn = values[k].conj() / size / scale
            acted = self.from_state[:width] @ v if self.late else np.r_[x @ v, used @ v]
            W = np.zeros((width, width))
            W[:n] = (turn * np.outer(w[:n], acted)).real
            slope = np.zeros_like(self.entries)
            derivative: Any = expm_frechet(self.h * X.T, W, compute_expm=False)
            slope[:n] = self.h * derivative[:n]
            slope[n:, :n] = (turn * np.outer(w @ entering, x @ v)).real
            growth = float(np.sum(np.abs(slope) * self.radii))
            if growth > 0 and isfinite(growth):
                ranked.append(((1 - size) / growth, np.sign(slope)))
        ranked.sort(key=lambda each: each[0])
        return [signs for _, signs in ranked] or [np.zeros_like(self.entries)]

    def border(self, direction: Floats, limit: float) -> float | None:
        """How far along a direction the loop seems to leave the region first; None if nowhere."""
        step = direction * self.radii
        if not np.any(step):
            return None

        def outside(t: float) -> bool:
            M = self.matrix(t * step)
            return not np.all(np.isfinite(M)) or abs(np.linalg.eigvals(M)).max() >= limit

        low, high = 0.0, _FARTHEST * 2.0**-_DOUBLINGS
        while not outside(high):
            low, high = high, 2 * high
            if high > _FARTHEST:
                return None
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            low, high = (low, middle) if outside(middle) else (middle, high)
        return high

    def member(self, direction: Floats, factor: Fraction) -> MultiChannelSystem:
        """The corner of a multiple of the box in a direction."""
        plant, radii, n = self.nominal, self._exact_radii, self.n

        def part(rows: int, cols: int, D: Matrix) -> Matrix:
            signs = direction[rows : rows + D.nrows, cols : cols + D.ncols]
            entries = ((i, j, D[i, j] * int(signs[i, j]) * factor) for i, j, _ in D.nonzero())
            return Matrix.from_entries(D.shape, entries)

        columns = np.cumsum([n, *(plant.p(i) for i in range(plant.m))])
        rows = np.cumsum([n, *(plant.q(i) for i in range(plant.m))])
        return MultiChannelSystem(
            plant.A + part(0, 0, radii.A),
            [B + part(0, int(columns[i]), radii.B[i]) for i, B in enumerate(plant.B)],
            [C + part(int(rows[i]), 0, radii.C[i]) for i, C in enumerate(plant.C)],
            time=plant.time,
            names=plant.names,
            neighbors=plant.neighbors,
        )


def _joined(A: Matrix, B: list[Matrix], C: list[Matrix]) -> Floats:
    """[A, B; C, 0] in floating point."""
    top = matrix_to_float(hstack([A, *B]))
    below = matrix_to_float(vstack(C, ncols=A.ncols))
    return np.vstack([top, np.hstack([below, np.zeros((len(below), top.shape[1] - A.ncols))])])
