"""Sampled plants near one whose loop with a controller is not stable.

The entries of a plant in continuous time act on its samples through the exponential, so that the
small changes of `boxes.failure` do not apply.  `failing_samples` searches corners of boxes instead
(`corners.first_to_fail`): `SampledFamily` has the loops, and `Held` the samples and their
derivatives with respect to all entries, by one derivative of the exponential.

All of this is floating point, and finding none proves nothing.  Whether the loop of such a plant
fails is decided exactly afterwards, for its samples to the decimals of the given one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from mcexact.analysis.boxes.corners import Complexes, Floats, Signs, first_to_fail
from mcexact.analysis.boxes.failure import FailingPlant
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, to_float, vstack
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem

_DIGITS = 3
"""The digits of a distance."""
_FARTHEST = 1e3
"""How many times the radii a plant is from the given one at most."""
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
    samples = SampledFamily(loop, to_float(region.limit))
    for size, signs in first_to_fail(samples, tries):
        mode = complex(max(np.linalg.eigvals(samples.loop(signs, size)), key=abs))
        for times in _BEYOND:
            factor = _above(_FARTHEST * size * to_float(times))
            yield FailingPlant(samples.member(signs, factor), factor, mode, ())


def _above(x: float) -> Fraction:
    """A number with three significant digits, rounded up."""
    scale = Fraction(10) ** (_DIGITS - 1 - int(np.floor(np.log10(x))))
    return Fraction(-(-(Fraction(x) * scale) // 1)) / scale


@dataclass(frozen=True, eq=False)
class Held:
    """A plant in continuous time whose inputs are held between samples.

    Attributes
    ----------
    entries : ndarray, n × (n + p)
        [A, B].
    step : float
    late : bool
        Whether [A_h, B_h] acts on the state and a register, or on the state and the input.
    """

    entries: Floats
    step: float
    late: bool

    @classmethod
    def of(cls, sampled: MultiChannelSystem) -> Held:
        """The plant that was sampled, and how."""
        (how,), plant = sampled.subject, sampled.plant
        entries = matrix_to_float(hstack([plant.A, plant.input_matrix()]))
        return cls(entries, to_float(Fraction(how["step"])), bool(how["late"]))

    @property
    def n(self) -> int:
        """The number of states in continuous time."""
        return len(self.entries)

    def _exponent(self, moved: Floats) -> Floats:
        """[A, B; 0, 0] h with moved entries."""
        width = self.entries.shape[1]
        X = np.zeros((width, width))
        X[: self.n] = self.step * (self.entries + moved)
        return X

    def change(self, moved: Floats) -> Floats:
        """How [A_h, B_h] changes when [A, B] does."""
        difference: Floats = self._held(moved) - self._nominal
        return difference

    @cached_property
    def _nominal(self) -> Floats:
        """[A_h, B_h]."""
        return self._held(np.zeros(self.entries.shape))

    def _held(self, moved: Floats) -> Floats:
        """[A_h, B_h] with moved entries."""
        from scipy.linalg import expm

        held: Floats = expm(self._exponent(moved))[: self.n]
        return held

    def slopes(self, moved: Floats, W: Complexes) -> Complexes:
        """The derivatives of Σ W_ij [A_h, B_h]_ij in [A, B], where entries are moved."""
        from scipy.linalg import expm_frechet

        X, n = self._exponent(moved).T, self.n
        padded = np.vstack([W, np.zeros((len(X) - n, len(X)))])
        found = np.zeros(W.shape, dtype=np.complex128)
        for part, unit in ((padded.real, 1), (padded.imag, 1j)):
            derivative: Any = expm_frechet(X, part, compute_expm=False)
            found += unit * self.step * derivative[:n]
        return found


@dataclass
class SampledFamily:
    """The loops of a sampled plant in floating point, by the entries of [A, B; C, 0] of the plant.

    Attributes
    ----------
    of : ClosedLoop
    edge : float
    """

    of: ClosedLoop
    edge: float
    discrete = True

    def __post_init__(self) -> None:
        sampled = self.of.plant
        self.n, self.held, box = sampled.plant.n, Held.of(sampled), Box(sampled.plant)
        self.nominal, self._exact_radii = box.nominal, box.radii
        radii = _joined(box.radii.A, list(box.radii.B), list(box.radii.C))
        self.radii: tuple[Floats, ...] = (_FARTHEST * radii,)
        parts, N = self.of.disturbed, sampled.n
        self.M, self.G, self.U, self.K = (
            matrix_to_float(each) for each in (parts.M, parts.G, parts.U, parts.K)
        )
        self.to_plant, self.from_state = np.eye(len(self.M))[:, : self.n], np.eye(len(self.M))[:N]

    def loop(self, signs: Signs, size: float) -> Floats:
        """The loop of the plant with moved entries."""
        moved = size * signs[0] * self.radii[0]
        n, x = self.n, self.from_state[: self.n]
        held, dC = self.held.change(moved[:n]), moved[n:, :n]
        if self.held.late:
            acting = held @ self.from_state[: held.shape[1]]
        else:
            acting = held[:, :n] @ x + held[:, n:] @ (self.U + self.K @ dC @ x)
        M: Floats = self.M + self.G @ dC @ x + self.to_plant @ acting
        return M

    def slopes(
        self, signs: Signs, size: float, left: Complexes, right: Complexes
    ) -> tuple[Complexes, ...]:
        """The derivatives of wMv in all entries."""
        moved = size * signs[0] * self.radii[0]
        n, width, x = self.n, moved.shape[1], self.from_state[: self.n] @ right
        entering, acted = self.G, self.from_state[:width] @ right
        if not self.held.late:
            used = self.U @ right + self.K @ (moved[n:, :n] @ x)
            acted = np.concatenate([x, used])
            more = self.held.change(moved[:n])[:, n:]
            entering = entering + self.to_plant @ more @ self.K
        slope = np.zeros(moved.shape, dtype=np.complex128)
        slope[:n] = self.held.slopes(moved[:n], np.outer(left[:n], acted))
        slope[n:, :n] = np.outer(left @ entering, x)
        return (slope,)

    def member(self, corner: Signs, factor: Fraction) -> MultiChannelSystem:
        """The plant at a corner of a multiple of the box."""
        plant, radii, n = self.nominal, self._exact_radii, self.n

        def part(rows: int, cols: int, D: Matrix) -> Matrix:
            signs = corner[0][rows : rows + D.nrows, cols : cols + D.ncols]
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
