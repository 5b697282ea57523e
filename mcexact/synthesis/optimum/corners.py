"""Corners of a box of plants, in floating point: those at which a loop fails first.

The members of a box differ in each entry by at most its radius, and a corner is one in which all
entries differ by as much.  To the first order an eigenvalue moves most towards the border of
stability at the corner that the signs of its derivatives give; from where this corner fails the
signs are taken again.  Some rounds for the eigenvalues that seem to be nearest give corners at
which the loop fails at a small part of the box.  There may be nearer ones, and nothing is proved: a
search of controllers counts the costs of the plants at these corners (`Objective.members`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mcexact.exact.matrix import matrix_to_float
from mcexact.floating.margins import spectral_bound
from mcexact.model.box import Box
from mcexact.synthesis.optimum.figures import Eigenvalues
from mcexact.synthesis.optimum.problem import Effort, FeedbackProblem, Floats, Places

_MODES, _ROUNDS, _HALVINGS = 6, 3, 12
_FIRST = 1e-4


@dataclass(frozen=True, eq=False)
class Corner:
    """The signs with which the entries of a plant differ from those in the middle of a box.

    Attributes
    ----------
    A, B, C : ndarray, n × n, n × p and q × n
        −1, 0 or 1; the inputs and outputs are those of all channels, in their order.
    """

    A: Floats
    B: Floats
    C: Floats

    def same(self, other: Corner) -> bool:
        """Whether all signs are equal."""
        pairs = (self.A, other.A), (self.B, other.B), (self.C, other.C)
        return all(np.array_equal(*pair) for pair in pairs)


@dataclass(frozen=True, eq=False)
class Corners:
    """The corners of the box of a plant, for the loops of a problem.

    Attributes
    ----------
    problem : FeedbackProblem
        Without delays.
    A, B, C : ndarray
        The radii: those of the plant, or else the moduli of all entries.
    rows, outputs : ndarray of int
        The rows of the problem's C that are outputs of the plant, and the numbers of these.
    """

    problem: FeedbackProblem
    A: Floats
    B: Floats
    C: Floats
    rows: Places
    outputs: Places

    @classmethod
    def of(cls, problem: FeedbackProblem) -> Corners:
        """Read the box of the plant of a problem.

        Examples
        --------
        >>> from mcexact.model.system import MultiChannelSystem
        >>> from mcexact.synthesis.networks import decentralized_network
        >>> from mcexact.synthesis.optimum.problem import Weights
        >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
        >>> problem = FeedbackProblem.of(decentralized_network(plant), [0], Weights.unit(plant))
        >>> [(distance, corner)] = Corners.of(problem).failing(np.array([[-3.0]]), Effort(100))
        >>> round(distance, 2), corner.A, corner.B
        (0.33, array([[1.]]), array([[-1.]]))
        """
        plant = problem.network.plant
        own = plant.uncertainty is not None
        radii = Box(plant if own else Box.relative(plant, 1).system).radii
        starts = np.cumsum([0, *(plant.q(i) for i in range(plant.m))])
        numbers = {
            int(column): int(starts[signal[1]]) + k
            for agent in problem.agents
            for signal, columns in agent.signals.items()
            if signal[0] == "y"
            for k, column in enumerate(columns)
        }
        return cls(
            problem,
            matrix_to_float(radii.A),
            np.hstack([np.zeros((plant.n, 0)), *map(matrix_to_float, radii.B)]),
            np.vstack([np.zeros((0, plant.n)), *map(matrix_to_float, radii.C)]),
            np.array([*numbers], dtype=np.intp),
            np.array([*numbers.values()], dtype=np.intp),
        )

    def member(self, corner: Corner, size: float) -> FeedbackProblem:
        """The problem for the plant at a corner of the box whose radii are multiplied by a size."""
        problem, n, p = self.problem, self.problem.n, self.problem.p
        A, B, C = problem.A.copy(), problem.B.copy(), problem.C.copy()
        A[:n, :n] += size * corner.A * self.A
        B[:n, :p] += size * corner.B * self.B
        C[self.rows, :n] += (size * corner.C * self.C)[self.outputs]
        return replace(problem, A=A, B=B, C=C)

    def distance(self, K: Floats, corner: Corner) -> float:
        """The size of the box at which a loop fails at a corner; infinite above 1."""
        edge, time = (1.0 if self.problem.discrete else 0.0), self.problem.network.plant.time

        def holds(size: float) -> bool:
            return spectral_bound(self.member(corner, size).closed(K), time) < edge

        low, high = 0.0, _FIRST
        while holds(high):
            low, high = high, 2 * high
            if high > 1:
                return np.inf
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if holds(middle) else (low, middle)
        return high

    def failing(self, K: Floats, effort: Effort) -> list[tuple[float, Corner]]:
        """Search corners at which a stable loop fails, and the sizes of the box: the least first.

        Parameters
        ----------
        K : ndarray, P × L
        effort : Effort
            Of which the work is taken.
        """
        problem = self.problem
        seen = Eigenvalues.of(problem, problem.closed(K))
        upper = [k for k, value in enumerate(seen.values) if value.imag >= 0]
        moves = [self._towards_border(problem, seen, K, k) for k in upper]
        gaps = 1 - np.abs(seen.values) if problem.discrete else -seen.values.real
        order = sorted(range(len(upper)), key=lambda i: gaps[upper[i]] / max(moves[i][0], 1e-300))
        tried = [self._nearest(K, moves[i][1], effort) for i in order[:_MODES]]
        return sorted((each for each in tried if np.isfinite(each[0])), key=lambda each: each[0])

    def _nearest(self, K: Floats, corner: Corner, effort: Effort) -> tuple[float, Corner]:
        """Go on from a corner to those that the eigenvalue on the border gives."""
        best = np.inf, corner
        for _ in range(_ROUNDS):
            distance = self.distance(K, corner)
            effort.take(len(self.problem.A), 2 * _HALVINGS)
            if distance < best[0]:
                best = distance, corner
            if not np.isfinite(distance):
                break
            member = self.member(corner, distance)
            seen = Eigenvalues.of(member, member.closed(K))
            sizes = np.abs(seen.values) if member.discrete else seen.values.real
            _, other = self._towards_border(member, seen, K, int(np.argmax(sizes)))
            if other.same(corner):
                break
            corner = other
        return best

    def _towards_border(
        self, member: FeedbackProblem, seen: Eigenvalues, K: Floats, k: int
    ) -> tuple[float, Corner]:
        """How fast an eigenvalue moves towards the border of stability, and at which corner."""
        n, p, value = self.problem.n, self.problem.p, seen.values[k]
        w, v = seen.left[:, k].conj(), seen.right[:, k]
        paired = complex(w @ v) or 1e-13
        direction = (value.conjugate() / max(abs(value), 1e-300) if member.discrete else 1) / paired
        driven, leaving = (K @ (member.C @ v))[:p], (w @ member.B) @ K
        slopes = [np.real(direction * np.outer(w[:n], each)) for each in (v[:n], driven)]
        seen_by = np.zeros(len(self.C), dtype=np.complex128)
        np.add.at(seen_by, self.outputs, leaving[self.rows])
        slopes.append(np.real(direction * np.outer(seen_by, v[:n])))
        radii = self.A, self.B, self.C
        speed = sum(float(np.sum(np.abs(S) * D)) for S, D in zip(slopes, radii, strict=True))
        return speed, Corner(*map(np.sign, slopes))
