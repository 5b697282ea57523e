"""The performance of loops: answers about cost, margins and sectors.

Each answer is proved by a few symmetric matrices, one for each inequality (`Symmetric`), which are
proposed in floating point, rounded to few bits, and verified exactly.

- `LoopCost`: an upper bound on the stationary mean of x'Qx + u'Ru of one loop.
- `CostBound`: a lower bound on it for every linear time-invariant controller, or for those whose
  agents act on each other along the edges of a graph alone (`CostGraph`).
- `DiskMargin`: the loop is stable while its inputs or outputs are multiplied by complex numbers
  near 1.
- `SectorStability`: it is stable while its inputs pass through nonlinearities within sectors.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal

from mcexact.answer.protocol import LEFT_OUT, Answer, Part, answer, claim, witness
from mcexact.exact.matrix import Matrix


@dataclass(frozen=True)
class Symmetric(Part):
    """A symmetric matrix of few bits, with the entries s_ij 2^(e_i + e_j).

    Attributes
    ----------
    exponents : tuple of int
        e_1, …, e_n.
    entries : tuple of int
        The s_ij with j ≤ i, row by row.
    """

    exponents: tuple[int, ...]
    entries: tuple[int, ...]

    def matrix(self) -> Matrix:
        """Return the matrix, n × n."""
        n, e = len(self.exponents), self.exponents
        s = {(i, j): self.entries[i * (i + 1) // 2 + j] for i in range(n) for j in range(i + 1)}
        unit = Fraction(2)
        return Matrix.from_rows(
            [[s[max(i, j), min(i, j)] * unit ** (e[i] + e[j]) for j in range(n)] for i in range(n)],
            ncols=n,
        )


@dataclass(frozen=True)
class CostWeights(Part):
    """The weights of the stationary mean of x'Qx + u'Ru; Q, R, W and V are diagonal.

    Attributes
    ----------
    states : tuple of Fraction
        The diagonal of Q, from 0 on, one for each state.
    inputs : tuple of Fraction
        The diagonal of R, above 0, one for each input, in the order of the channels.
    disturbances : tuple of Fraction
        The intensities W of the white disturbances of the states, from 0 on.
    noise : tuple of Fraction
        The intensities V of the white noise of the outputs, from 0 on.
    bandwidth : Fraction or None
        In continuous time ω > 0: the noise v passes a filter, v' = −ωv + ωn with n white.  None
        means that v is white, which is for controllers alone that pass no output on at once.
    """

    states: tuple[Fraction, ...]
    inputs: tuple[Fraction, ...]
    disturbances: tuple[Fraction, ...]
    noise: tuple[Fraction, ...]
    bandwidth: Fraction | None = field(default=None, kw_only=True, metadata=LEFT_OUT)


@answer("loop_cost")
class LoopCost(Answer):
    """The loop is stable, and its stationary mean of x'Qx + u'Ru is at most ``cost``.

    Attributes
    ----------
    weights : CostWeights
        For the states of the plant, or of the system that the loop was closed around.
    cost : Fraction
    P : Symmetric
        Of the loop, in continuous time with the filters of the noise behind it.
    """

    weights: CostWeights = claim()
    cost: Fraction = claim()
    P: Symmetric = witness()


@dataclass(frozen=True)
class CostGraph(Part):
    """Who acts on whom: from j to i if something of agent j enters something of agent i.

    Attributes
    ----------
    states : tuple of str
        For each state of the plant the agent to whom it belongs.
    edges : tuple of tuple of str
        The pairs (j, i), j ≠ i, in the order of the channels.
    """

    states: tuple[str, ...]
    edges: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class CostGroup(Part):
    """The proof of a bound for the disturbances and the noise of a group of agents.

    Attributes
    ----------
    agents : tuple of str
        Nobody outside of the group receives anything from it.
    disturbances, noise : tuple of Fraction
        What the group takes of the intensities, for its states and outputs.
    P, S : Symmetric
        For the states of the group.
    F : Matrix
        Its inputs × its states.
    share : Fraction
        s, from 0 on and below 1.
    """

    agents: tuple[str, ...]
    disturbances: tuple[Fraction, ...]
    noise: tuple[Fraction, ...]
    P: Symmetric
    S: Symmetric
    F: Matrix
    share: Fraction


@answer("cost_bound")
class CostBound(Answer):
    """No linear time-invariant controller has a smaller stationary mean of x'Qx + u'Ru.

    Attributes
    ----------
    weights : CostWeights
    cost : Fraction
    graph : CostGraph or None
        If it is not None, only controllers are meant by which agents act on each other along the
        edges alone.
    groups : tuple of CostGroup
    """

    weights: CostWeights = claim()
    cost: Fraction = claim()
    graph: CostGraph | None = claim(optional=True)
    groups: tuple[CostGroup, ...] = witness()


@dataclass(frozen=True)
class MarginPart(Part):
    """The proof of a disk margin of some inputs, or of some outputs, all of them at once.

    Attributes
    ----------
    ports : tuple of int
        Their places, from 0, in the order of the channels.
    scaling : tuple of Fraction
        A number above 0 for each.
    P : Symmetric
    """

    ports: tuple[int, ...]
    scaling: tuple[Fraction, ...]
    P: Symmetric


@answer("disk_margin")
class DiskMargin(Answer):
    """The loop is stable while ports are multiplied by (1 + d/2)/(1 − d/2), abs(d) ≤ ``margin``.

    Attributes
    ----------
    at : {"inputs", "outputs"}
    together : bool
        Whether all of them are multiplied, with a complex number d for each; else any one of them.
    margin : Fraction
    parts : tuple of MarginPart
        Each proves the margin for its ports at once, and so for each of them.
    """

    at: Literal["inputs", "outputs"] = claim()
    together: bool = claim()
    margin: Fraction = claim()
    parts: tuple[MarginPart, ...] = witness()


@answer("sector")
class SectorStability(Answer):
    """The loop is stable where each input passes through a nonlinearity within its sector.

    Attributes
    ----------
    sectors : tuple of tuple of Fraction
        The ends (a, b) for each input: f(t, v) lies between av and bv.
    scaling : tuple of Fraction
        A number above 0 for each input.
    P : Symmetric
    """

    sectors: tuple[tuple[Fraction, Fraction], ...] = claim()
    scaling: tuple[Fraction, ...] = witness()
    P: Symmetric = witness()
