"""Parts of a closed loop that single channels control and observe, and gains that enlarge them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from random import Random

from mcexact.analysis.fixed_modes.gains import drawn_integers
from mcexact.derived.modular_system import ModularSystem, generator, residue_systems
from mcexact.exact.blocks import block_diagonal
from mcexact.exact.invariant_subspace import controllable_subspace
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import ModularMatrix, hstack, random_matrix, residues, vstack
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class ChannelReach:
    """The dimension and an index of the part that one channel controls and observes.

    Attributes
    ----------
    channel : int
        q.
    degree : int
        The McMillan degree of C_q (sI − A_F)⁻¹ B_q: the dimension of the part of the loop that the
        channel controls and observes.
    index : int
        The smaller of the two indices of that part, at least 1.
    side : {"controllable", "observable"}
        The property to which the index belongs.
    cyclic : bool
        Whether this part is cyclic, so that one drawn row of C_q observes it.
    """

    channel: int
    degree: int
    index: int
    side: str
    cyclic: bool


@dataclass(frozen=True)
class DrawnGains:
    """Decentralized gains, with the channel chosen in every strong component.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i × q_i.
    reaches : tuple of ChannelReach
        One for each component of which a channel moves some modes.
    """

    gains: tuple[Matrix, ...]
    reaches: tuple[ChannelReach, ...]

    @property
    def degree(self) -> int:
        """The number of modes that the chosen channels move."""
        return sum(reach.degree for reach in self.reaches)

    @property
    def order(self) -> int:
        """The order of their controllers: index − 1 each."""
        return sum(reach.index - 1 for reach in self.reaches)

    @property
    def size(self) -> int:
        """The sum of the absolute values of the gains, which are integers."""
        return sum(abs(x) for F in self.gains for row in F.numerators for x in row)


@dataclass(frozen=True)
class ChannelPart:
    """The part of a loop that a channel controls and observes: a minimal triple.

    Attributes
    ----------
    A : Matrix, d × d
    B : Matrix, d × p_q
    C : Matrix, q_q × d
    """

    A: Matrix
    B: Matrix
    C: Matrix


def channel_part(A: Matrix, B: Matrix, C: Matrix, rng: Random) -> ChannelPart:
    """Compute the controllable and observable part of (A, B, C), exactly.

    Notes
    -----
    On X = ⟨A | B⟩ in echelon form A acts as (AX)[pivots]; then the same for the dual.  A
    controllable and observable triple is returned unchanged.
    """
    found = controllable_subspace(A, B, rng)
    A1, B1, C1 = (A @ found.X).take(found.pivots), B.take(found.pivots), C @ found.X
    seen = controllable_subspace(A1.T, C1.T, rng)
    return ChannelPart((A1.T @ seen.X).take(seen.pivots).T, seen.X.T @ B1, C1.T.take(seen.pivots).T)


def drawn_gains(
    system: MultiChannelSystem,
    components: Sequence[Sequence[int]],
    *,
    attempts: int,
    least: int = 0,
) -> list[DrawnGains]:
    """Draw small decentralized gains, and sort them by the number of modes that channels move.

    Parameters
    ----------
    system : MultiChannelSystem
    components : sequence of sequences of int
        For each strong component of the transfer graph, the channels to choose from.
    attempts : int
        The number of draws.
    least : int
        Draws with a smaller degree are dropped; the search ends early after many draws with this
        degree.

    Returns
    -------
    list of DrawnGains
        By degree, falling; then by the order that the controllers need, then by the size of the
        gains.

    Notes
    -----
    The search uses ranks modulo one word-size prime, which bound ranks over Q from below.  The
    caller verifies its proposals.
    """
    rng = generator(system, "drawn_gains")
    modular = next(iter(residue_systems(system, rng)))
    found = []
    for gains in _draws(system, rng, attempts):
        drawn = _measured(modular, gains, components, rng)
        if drawn.degree >= least:
            found.append(drawn)
    return sorted(found, key=lambda each: (-each.degree, each.order, each.size))


def _draws(system: MultiChannelSystem, rng: Random, attempts: int) -> Iterator[tuple[Matrix, ...]]:
    """Yield zero gains first, then sparse and full gains of growing range."""
    for trial in range(attempts):
        bound = 1 + trial // 24
        density = 0.0 if trial == 0 else (0.25, 0.5, 1.0)[trial % 3]
        yield tuple(
            drawn_integers(rng, system.p(i), system.q(i), bound, density) for i in range(system.m)
        )


def _measured(
    modular: ModularSystem,
    gains: tuple[Matrix, ...],
    components: Sequence[Sequence[int]],
    rng: Random,
) -> DrawnGains:
    """The best channel of every component, for these gains."""
    F = residues(block_diagonal(gains), modular.modulus)
    M = modular.A + modular.B @ F @ modular.C
    chosen = []
    for channels in components:
        reaches = [_reach(modular, M, q, rng) for q in channels]
        best = min(reaches, key=lambda r: (-r.degree, not r.cyclic, r.index), default=None)
        if best is not None and best.degree and best.cyclic:
            chosen.append(best)
    return DrawnGains(gains, tuple(chosen))


def _reach(modular: ModularSystem, M: ModularMatrix, q: int, rng: Random) -> ChannelReach:
    """Degree and indices of channel q, from ranks of parts of its Hankel matrix modulo ℓ."""
    n, ell = M.nrows, M.modulus
    B = modular.B.take(cols=list(modular.inputs[q]))
    C = modular.C.take(rows=list(modular.outputs[q]))
    if not n or not B.ncols or not C.nrows:
        return ChannelReach(q, 0, 1, "controllable", False)
    R, S = _blocks(M, B), _blocks(M.T, C.T)
    reached_by, seen_by = hstack(R), hstack(S).T
    degree = (seen_by @ reached_by).rank()
    if not degree:
        return ChannelReach(q, 0, 1, "controllable", False)
    reached = _first(degree, len(R), lambda k: (seen_by @ hstack(R[:k])).rank())
    seen = _first(degree, len(S), lambda k: (hstack(S[:k]).T @ reached_by).rank())
    row = random_matrix(1, C.nrows, ell, rng) @ C
    alone = vstack([block.T for block in _blocks(M.T, row.T)])
    cyclic = (alone @ reached_by).rank() == degree
    if reached <= seen:
        return ChannelReach(q, degree, reached, "controllable", cyclic)
    return ChannelReach(q, degree, seen, "observable", cyclic)


def _blocks(M: ModularMatrix, B: ModularMatrix) -> list[ModularMatrix]:
    """B, MB, …, M^{n−1}B."""
    blocks = [B]
    while len(blocks) < M.nrows:
        blocks.append(M @ blocks[-1])
    return blocks


def _first(degree: int, most: int, rank_of: Callable[[int], int]) -> int:
    """The least k with rank_of(k) = degree, by bisection; the ranks do not fall."""
    low, high = 1, most
    while low < high:
        middle = (low + high) // 2
        if rank_of(middle) == degree:
            high = middle
        else:
            low = middle + 1
    return low
