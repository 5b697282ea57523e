"""Corners of a box of plants at which the loops of a problem fail first, in floating point.

`boxes.corners` searches them.  A search of controllers counts the costs of the plants at these
corners (`Objective.members`).  The box of a sampled plant is that of the plant in continuous time,
whose entries act on the samples through the exponential (`samples.Held`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from mcexact.analysis.boxes.corners import WORK, Signs, distance_of, first_to_fail
from mcexact.analysis.boxes.samples import Held
from mcexact.derived.sampling import is_sampled
from mcexact.exact.matrix import matrix_to_float
from mcexact.model.box import Box
from mcexact.synthesis.optimum.problem import Effort, FeedbackProblem, Floats, Places

Complexes = npt.NDArray[np.complex128]


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

    @property
    def signs(self) -> Signs:
        """The three matrices."""
        return self.A, self.B, self.C

    def same(self, other: Corner) -> bool:
        """Whether all signs are equal."""
        return all(map(np.array_equal, self.signs, other.signs))


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
    held : Held, optional
        For a sampled plant: the radii are those of the plant in continuous time.
    """

    problem: FeedbackProblem
    A: Floats
    B: Floats
    C: Floats
    rows: Places
    outputs: Places
    held: Held | None = None

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
        held, plant = (Held.of(plant), plant.plant) if is_sampled(plant) else (None, plant)
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
            held,
        )

    def moves(self, signs: Signs, size: float) -> Signs:
        """By what A, B and C differ at a corner of the box whose radii are multiplied by a size."""
        return tuple(size * S * D for S, D in zip(signs, (self.A, self.B, self.C), strict=True))

    def member(self, corner: Corner, size: float) -> FeedbackProblem:
        """The problem for the plant at a corner of the box whose radii are multiplied by a size."""
        problem, (n, p) = self.problem, self.B.shape
        A, B, C = problem.A.copy(), problem.B.copy(), problem.C.copy()
        dA, dB, dC = self.moves(corner.signs, size)
        if self.held is not None:
            change = self.held.change(np.hstack([dA, dB]))
            dA, dB = change[:, :n], change[:, n:]
        A[:n, :n] += dA
        if self.held is not None and self.held.late:
            A[:n, n : n + p] += dB
        else:
            B[:n, :p] += dB
        C[self.rows, :n] += dC[self.outputs]
        return replace(problem, A=A, B=B, C=C)

    def distance(self, K: Floats, corner: Corner) -> float:
        """The size of the box at which a loop fails at a corner; infinite from 1 on."""
        return distance_of(_Loops(self, K), corner.signs)

    def failing(self, K: Floats, effort: Effort) -> list[tuple[float, Corner]]:
        """Search corners at which a stable loop fails, and the sizes of the box: the least first.

        Parameters
        ----------
        K : ndarray, P × L
        effort : Effort
            Of which the work is taken.
        """
        found = first_to_fail(_Loops(self, K), spend=lambda: effort.take(len(self.problem.A), WORK))
        return [(distance, Corner(*signs)) for distance, signs in found]


@dataclass(frozen=True, eq=False)
class _Loops:
    """The loops of the members of a box with the gain K."""

    box: Corners
    K: Floats

    @property
    def discrete(self) -> bool:
        """Whether time is discrete."""
        return self.box.problem.discrete

    @property
    def edge(self) -> float:
        """The border of stability."""
        return 1.0 if self.discrete else 0.0

    @property
    def radii(self) -> Signs:
        """Those of A, B and C."""
        return self.box.A, self.box.B, self.box.C

    def loop(self, signs: Signs, size: float) -> Floats:
        """A + BKC of a member."""
        return self.box.member(Corner(*signs), size).closed(self.K)

    def slopes(
        self, signs: Signs, size: float, left: Complexes, right: Complexes
    ) -> tuple[Complexes, ...]:
        """The derivatives of w(A + BKC)v in the entries of A, B and C."""
        box, K, w, v = self.box, self.K, left, right
        (n, p), member = box.B.shape, box.member(Corner(*signs), size)
        driven, leaving = (K @ (member.C @ v))[:p], (w @ member.B) @ K
        seen_by = np.zeros(len(box.C), dtype=np.complex128)
        np.add.at(seen_by, box.outputs, leaving[box.rows])
        if box.held is not None and box.held.late:
            driven = v[n : n + p]
        W = np.outer(w[:n], np.concatenate([v[:n], driven]))
        if box.held is not None:
            dA, dB, _ = box.moves(signs, size)
            W = box.held.slopes(np.hstack([dA, dB]), W)
        return W[:, :n], W[:, n:], np.outer(seen_by, v[:n])
