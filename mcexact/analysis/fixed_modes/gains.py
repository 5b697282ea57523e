"""A search for decentralized gains with which single channels control and observe a system.

The search draws small gains and tests ranks modulo a prime.  A rank over Q is at least the rank
modulo a prime: accepted gains are proved; finding none proves nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random

from mcexact.derived.modular import ModularSystem, generator, residue_systems
from mcexact.exact.matrix import Matrix, block_diagonal, hstack
from mcexact.exact.modular import ModularMatrix, residues
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

Draw = Callable[[int, Random], tuple[Matrix, ...]]
"""A function that makes the gains F_i of a trial from its number and a source of choices."""


@dataclass(frozen=True)
class ReachingGains:
    """Gains F_i with which every channel of a set controls and observes the system.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i×q_i.
    matrix : Matrix
        A_F = A + Σ B_i F_i C_i, cyclic: its minimal polynomial has degree n.
    controllability_indices : tuple of int
        The index of (A_F, B_q) for each channel q of the set.
    observability_indices : tuple of int
        The index of (C_q, A_F).
    """

    gains: tuple[Matrix, ...]
    matrix: Matrix
    controllability_indices: tuple[int, ...]
    observability_indices: tuple[int, ...]

    @property
    def largest(self) -> int:
        """The largest absolute numerator or denominator in the gains."""
        entries = [entry for F in self.gains for row in F.rows() for entry in row]
        return max((max(abs(e.numerator), e.denominator) for e in entries), default=0)


def reaching_gains(
    system: MultiChannelSystem,
    channels: Sequence[int],
    draw: Draw,
    *,
    index: int | None = None,
    attempts: int = 200,
) -> Iterator[ReachingGains]:
    """Draw gains, and yield those with which every named channel controls and observes the system.

    Parameters
    ----------
    system : MultiChannelSystem
    channels : sequence of int
        The channels q, which must all control and observe the system with the same gains.
    draw : callable
        The function that makes the gains of a trial.
    index : int, optional
        The largest accepted controllability index.
    attempts : int
        The number of draws.

    Notes
    -----
    A_F is also cyclic: some drawn vector generates the whole space.  Each test is a rank modulo
    a word-size prime, O(n³) word operations for each channel.
    """
    rng = generator(system, "reaching_gains")
    modular = next(iter(residue_systems(system, rng)))
    B, C = system.input_matrix(), system.output_matrix()
    bound = system.n if index is None else min(index, system.n)
    for trial in range(attempts):
        gains = draw(trial, rng)
        if any(F.denominator % modular.modulus == 0 for F in gains):
            continue
        F = block_diagonal(gains)
        M = modular.A + modular.B @ residues(F, modular.modulus) @ modular.C
        found = _indices(modular, M, channels, bound)
        if found is not None and _is_cyclic(M, rng):
            yield ReachingGains(gains, system.A + B @ F @ C, *found)


def _indices(
    modular: ModularSystem, M: ModularMatrix, channels: Sequence[int], bound: int
) -> tuple[tuple[int, ...], tuple[int, ...]] | None:
    """Controllability and observability indices modulo ℓ, or None if one does not exist."""
    controllable, observable = [], []
    for q in channels:
        reached = reach_index(M, modular.B.take(cols=list(modular.inputs[q])), bound)
        if reached is None:
            return None
        seen = reach_index(M.T, modular.C.take(rows=list(modular.outputs[q])).T, M.nrows)
        if seen is None:
            return None
        controllable.append(reached)
        observable.append(seen)
    return tuple(controllable), tuple(observable)


def reach_index(M: ModularMatrix, B: ModularMatrix, bound: int) -> int | None:
    """The least ν ≤ bound with rank [B, MB, …, M^{ν−1}B] = n modulo ℓ, at least 1, or None.

    Parameters
    ----------
    M : ModularMatrix, n × n
    B : ModularMatrix, n × p
    bound : int
        The largest ν to try; n or more decides whether the pair is controllable modulo ℓ.

    Examples
    --------
    >>> M = ModularMatrix.from_rows([[0, 0], [1, 0]], 7)
    >>> b = ModularMatrix.from_rows([[1], [0]], 7)
    >>> reach_index(M, b, 2), reach_index(M, b, 1), reach_index(M.T, b, 2)
    (2, None, None)
    """
    n, rows = M.nrows, []
    if n == 0:
        return 1
    block = B
    for index in range(1, bound + 1):
        rows += [list(row) for row in block.T.rows()]
        if len(rows) >= n and ModularMatrix.from_rows(rows, M.modulus, ncols=n).rank() == n:
            return index
        block = M @ block
    return None


def _is_cyclic(M: ModularMatrix, rng: Random) -> bool:
    """Whether a drawn vector generates the whole space modulo ℓ."""
    n, ell = M.nrows, M.modulus
    vector = ModularMatrix.from_rows([[rng.randrange(ell)] for _ in range(n)], ell, ncols=1)
    return n == 0 or reach_index(M, vector, n) is not None


def error_gain_draws(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    feedback: Sequence[Matrix],
    center: Fraction = Fraction(0),
) -> Draw:
    """Draw small gains [K_i, H_ij …] for the error system, in four shapes by turns.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant, n states.
    graph : NeighborGraph
    feedback : sequence of Matrix
        F_i, p_i×n.
    center : Fraction
        An approximate location for the eigenvalues of the error matrix: the mean of the spectrum
        that a channel controller has to assign.

    Notes
    -----
    With H_ij = −B_jF_j − S the block E_ij of the error matrix is S, and E_ii = A + K_iC_i − Σ E_ij.
    S is a signed permutation or sparse, and for one j the shift −c I is added, c an integer near
    ``center``: then E_ii is near c I, and the channel controller has to move the eigenvalues
    little.  On the paper's example with the spectrum −1, …, −11 this brings the largest gain from
    10¹⁷ to below 10³.  Dense draws of growing range come last.
    """
    n = system.n
    coupling = [system.B(j) @ feedback[j] for j in range(system.m)]
    unit = Matrix.identity(n)

    def block_of(trial: int, rng: Random) -> Matrix:
        if trial % 2:
            return _signed_permutation(rng, n)
        if trial % 8 == 6:
            return drawn_integers(rng, n, n, 1 + trial // 80, 0.8)
        return drawn_integers(rng, n, n, 1, 0.3)

    def draw(trial: int, rng: Random) -> tuple[Matrix, ...]:
        shift = unit * (round(center) + (0, 1, -1, 0)[trial // 2 % 4])
        gains = []
        for i in range(system.m):
            others = [j for j in graph.neighborhood(i) if j != i]
            chosen = rng.choice(others) if others else i
            blocks = [drawn_integers(rng, n, system.q(i), 2, 0.4)]
            for j in others:
                S = block_of(trial, rng) - (shift if j == chosen else Matrix.zeros(n, n))
                blocks.append(-coupling[j] - S)
            gains.append(hstack(blocks, nrows=n))
        return tuple(gains)

    return draw


def drawn_integers(rng: Random, nrows: int, ncols: int, bound: int, density: float) -> Matrix:
    """Draw a matrix of integers in −bound … bound, most of them 0 where the density is low.

    Parameters
    ----------
    rng : Random
    nrows, ncols : int
    bound : int
    density : float
        From 0 to 1: the probability that an entry is drawn; others are 0.
    """

    def entry() -> int:
        return rng.randint(-bound, bound) if rng.random() < density else 0

    return Matrix.from_integers(
        [[entry() for _ in range(ncols)] for _ in range(nrows)], ncols=ncols
    )


def _signed_permutation(rng: Random, n: int) -> Matrix:
    """A permutation matrix with signs."""
    places = list(range(n))
    rng.shuffle(places)
    rows = [[0] * n for _ in range(n)]
    for i, j in enumerate(places):
        rows[i][j] = rng.choice((1, -1))
    return Matrix.from_integers(rows, ncols=n)
