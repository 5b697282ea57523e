"""Krylov sequences and blocks of states, which prove that no more is fixed.

A shrunk subspace proves that a mode is fixed (`subspaces`); this module has the opposite proof.
For gains modulo a prime and one channel, the recurrence of the sequence c A_Fᵏ b has a degree d,
and at most n − d modes are fixed.  Generic gains reach n if no mode is fixed and the transfer graph
is strongly connected (`best_sequences`).

If it is not, one sequence may stay below n although no mode is fixed.  So `state_blocks` splits the
system into the strong components of the digraph with an arc b → a between two states if A_ab ≠ 0,
or if a row a of some B_i and a column b of C_i are not 0.  Every closed loop is block triangular,
and a channel acts within one block at most, so the blocks share no gain: the fixed modes of the
system are those of the blocks, and `bounded_blocks` has a sequence for each.  A block without fixed
modes whose sequence is too short can be proved by two coprime polynomials in its place
(`completed_blocks`).

Blocks that leave modes are decided one by one (`local_subspaces`).  A shrunk subspace of the system
of a block proves that its modes are fixed in the whole system: nothing acts on a block that it
drives.

The same blocks prove how much channels control.  Modes that channels do not control are fixed,
whatever the channels measure.  So the states that they measure can be chosen, and one of them can
measure everything (`measured_system`).
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mcexact.analysis.sparse import fixed_subspaces, is_large_and_sparse
from mcexact.analysis.subspaces import ExactSubspace, decide, evidence, shrunk_subspace
from mcexact.answer.evidence import (
    Block,
    CoprimePolynomials,
    KrylovSequence,
    LocalSubspace,
    Subspace,
)
from mcexact.derived.modular import (
    Gains,
    ModularSystem,
    channel_sequences,
    drawn_gains,
    generator,
    lifted_gains,
)
from mcexact.errors import LimitReached
from mcexact.exact.krylov import Start, cofactors, least_recurrence
from mcexact.exact.linear_algebra import PolynomialMatrix, characteristic_polynomial, nullspace_at
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.exact.modular import ModularPolynomial
from mcexact.exact.polynomial import Polynomial
from mcexact.model.graph import components_of
from mcexact.model.system import MultiChannelSystem

# One Krylov sequence of one channel, which bounds how many modes are fixed.

MODULI = (19, 31, 2**19 - 1)
"""Small moduli make certificates that are quick to check; structured plants need larger ones.

Of 700 dense drawn plants with 50 to 800 states the first sequence was too short for 31 % modulo 7,
15 % modulo 13, 12 % modulo 19 and 6 % modulo 31; an answer took 1.2, 1.04, 1.02 and 1 times as
long on average, and to check one of 1,000 states 1.6, 1.7, 1.8 and 2.0 s.
"""
LARGE = 2**12
"""From so many states on, a sequence that fails costs more than a small modulus saves.

Products with large sparse matrices are checked quickest modulo 31.
"""
STARTS = 3
"""How many channels are tried with the same gains: a second one takes a third of the time."""


def best_sequences(
    system: MultiChannelSystem, denominator: int = 1, through: str | None = None
) -> Iterator[KrylovSequence]:
    """Draw gains modulo one prime after the other, and yield the longest sequence for each.

    The last one has degree n, or two in a row have the same degree, or all primes are used up.

    Parameters
    ----------
    system : MultiChannelSystem
    denominator : int
        Moduli that divide it are passed over, as are those that divide one of the system.
    through : str, optional
        The name of the only channel that is tried.

    Notes
    -----
    If nothing is fixed and the transfer graph is strongly connected, generic gains make the system
    controllable and observable through each channel with inputs and outputs (Corfmat and Morse
    1976), and then generic x and y give a sequence of degree n.  Modulo ℓ, gains, x and y that are
    drawn do so with a probability near (1 − 1/ℓ)².  The draws depend on ℓ and on the sizes of the
    gains alone.
    """
    if not system.m:
        return
    denominator *= system.denominator
    before = -1
    quick = system.n < LARGE and not is_large_and_sparse(system)
    for ell in MODULI if quick else MODULI[1:]:
        if denominator % ell:
            best = longest_sequence(ModularSystem(system, ell), random.Random(ell), through)
            yield best
            if best.degree in (before, system.n):
                return
            before = best.degree


def longest_sequence(
    modular: ModularSystem, rng: random.Random, through: str | None
) -> KrylovSequence:
    """The longest sequence of a few channels for drawn gains."""
    gains = drawn_gains(modular, rng)
    if is_large_and_sparse(modular.system) and _drive_each_other(modular.system.A):
        none = tuple(tuple((0,) * len(row) for row in F) for F in gains)
        best = _longest(modular, none, random.Random(modular.modulus), through)
        if best.degree == modular.system.n:
            return best
    return _longest(modular, gains, rng, through)


def _longest(
    modular: ModularSystem, gains: Gains, rng: random.Random, through: str | None
) -> KrylovSequence:
    """The longest sequence of a few channels for these gains."""
    system, ell = modular.system, modular.modulus
    starts = _starts(system, ell, rng, through)
    sequences = []
    for start, numbers in zip(starts, channel_sequences(modular, gains, starts), strict=False):
        sequences.append((least_recurrence(numbers, ell), start, numbers))
        if sequences[-1][0].degree == system.n:
            break
    return _evidence(modular, gains, *max(sequences, key=lambda each: each[0].degree))


def _drive_each_other(A: Matrix) -> bool:
    """Whether the states drive each other without any feedback: then it may take no gains."""
    into: list[list[int]] = [[] for _ in range(A.nrows)]
    out: list[list[int]] = [[] for _ in range(A.nrows)]
    for a, b, _ in A.nonzero():
        into[a].append(b)
        out[b].append(a)
    return len(components_of(into, out)) == 1


def _starts(
    system: MultiChannelSystem, ell: int, rng: random.Random, through: str | None
) -> list[Start]:
    """Channels with inputs and outputs, with a combination of each; no two alike."""
    acting = (system.active if through is None else (system.index(through),)) or (0,)
    chosen = rng.sample(acting, min(STARTS, len(acting)))
    starts: list[Start] = []
    for k in range(STARTS):
        q = chosen[k % len(chosen)]
        start = q, _direction(system.p(q), ell, rng), _direction(system.q(q), ell, rng)
        if start not in starts:
            starts.append(start)
    return starts


def _direction(size: int, ell: int, rng: random.Random) -> tuple[int, ...]:
    """Residues that are not all 0, up to a common factor."""
    if size == 1:
        return (1,)
    drawn = [rng.randrange(ell) for _ in range(size)]
    return tuple(drawn) if any(drawn) else (1,) * size


def _evidence(
    modular: ModularSystem,
    gains: Gains,
    recurrence: ModularPolynomial,
    start: Start,
    numbers: Sequence[int],
) -> KrylovSequence:
    q, x, y = start
    a, e = cofactors(recurrence, numbers)
    return KrylovSequence(
        modulus=modular.modulus,
        gains=lifted_gains(modular, gains),
        channel=modular.system.channels[q].name,
        inputs=tuple(x),
        outputs=tuple(y),
        recurrence=recurrence.coefficients,
        cofactors=(a.coefficients, e.coefficients),
    )


# Blocks of states, each with its sequence.

# So many entries are compared with 0 by numpy: 0.1 ms at n = 200 in place of 2 ms.
_LARGE = 2**14


@dataclass(frozen=True)
class StateBlock:
    """Some states, and the system of these and of the channels that act within them.

    Attributes
    ----------
    states : tuple of int
        Increasing.
    system : MultiChannelSystem or None
        None if no channel acts within the block, so that all of its modes are fixed.
    """

    states: tuple[int, ...]
    system: MultiChannelSystem | None


def state_blocks(system: MultiChannelSystem) -> tuple[StateBlock, ...]:
    """Split a system into blocks, in an order in which no arc leads from a block to a later one.

    Examples
    --------
    >>> chain = MultiChannelSystem([[0, 0], [1, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    >>> [(block.states, block.system.names) for block in state_blocks(chain)]
    [((1,), ('2',)), ((0,), ('1',))]
    >>> block, = state_blocks(MultiChannelSystem([[0]], [[[0]]], [[[1]]]))
    >>> block.system is None
    True
    """
    if not system.A.is_sparse and _connected(_flags(system.A), system.n):
        states = tuple(range(system.n))
        return (StateBlock(states, _part(system, states, system.active)),)
    blocks = []
    for component in components_of(*_arcs(system)):
        states = tuple(sorted(v for v in component if v < system.n))
        if states:
            acting = sorted(v - system.n for v in component if v >= system.n)
            blocks.append(StateBlock(states, _part(system, states, acting)))
    return tuple(blocks)


def _part(
    system: MultiChannelSystem, states: Sequence[int], acting: Sequence[int]
) -> MultiChannelSystem | None:
    if not acting:
        return None
    if len(states) == system.n and len(acting) == system.m:
        return system
    at = {state: k for k, state in enumerate(states)}
    return MultiChannelSystem(
        _within(system.A, at, at),
        [_within(system.B(i), at, None) for i in acting],
        [_within(system.C(i), None, at) for i in acting],
        time=system.time,
        names=system.named(acting),
    )


def _within(M: Matrix, rows: dict[int, int] | None, cols: dict[int, int] | None) -> Matrix:
    """The rows and columns with new positions, which increase; None takes all."""
    if not M.is_sparse:
        return M.take(*(None if places is None else tuple(places) for places in (rows, cols)))
    shape = (M.nrows if rows is None else len(rows), M.ncols if cols is None else len(cols))
    cells, values = [], []
    for i, j, x in M.nonzero():
        if (rows is None or i in rows) and (cols is None or j in cols):
            a, b = i if rows is None else rows[i], j if cols is None else cols[j]
            cells.append(a * shape[1] + b)
            values.append(x)
    return from_cells(shape, cells, values, M.denominator)


def _connected(flags: bytes, n: int) -> bool:
    """Whether n ≥ 1 states drive each other by A alone; a dense A shows it by a few rows."""
    rows = (lambda a: flags[a * n : a * n + n]), (lambda b: flags[b::n])
    return n > 0 and all(_reaches_all(arcs, n) for arcs in rows)


def _reaches_all(arcs: Callable[[int], bytes], n: int) -> bool:
    reached, looked_at, every = 1, 0, _number(b"\1" * n)
    while reached != every:
        rest = reached & ~looked_at
        if not rest:
            return False
        bit = rest & -rest
        looked_at |= bit
        reached |= _number(arcs(bit.bit_length() // 8))
    return True


def _arcs(system: MultiChannelSystem) -> tuple[list[list[int]], list[list[int]]]:
    """For each state, then each channel, where arcs come from and lead to, in increasing order."""
    n = system.n
    into: list[list[int]] = [[] for _ in range(n + system.m)]
    out: list[list[int]] = [[] for _ in range(n + system.m)]
    for a, b, _ in system.A.nonzero():
        into[a].append(b)
        out[b].append(a)
    for i, channel in enumerate(system.channels, start=n):
        out[i] = sorted({a for a, _, _ in channel.B.nonzero()})
        into[i] = sorted({b for _, b, _ in channel.C.nonzero()})
        for a in out[i]:
            into[a].append(i)
        for b in into[i]:
            out[b].append(i)
    return into, out


def _flags(M: Matrix) -> bytes:
    """A byte for each entry, row by row: 1 if it is not 0."""
    words = M.words
    if words is None:
        return bytes(entry != 0 for row in M.numerators for entry in row)
    if len(words) < _LARGE:
        return bytes(map(bool, words))
    import numpy as np

    return bytes(np.frombuffer(words, dtype=np.int64) != 0)


def _number(flags: bytes) -> int:
    return int.from_bytes(flags, "little")


def bounded_blocks(system: MultiChannelSystem, through: str | None = None) -> tuple[Block, ...]:
    """The blocks, each with the longest sequence among those that are tried.

    Parameters
    ----------
    system : MultiChannelSystem
    through : str, optional
        The name of a channel: only this one is tried, in the block in which it acts.
    """
    return tuple(
        Block(block.states, _longest_of_block(block, system.denominator, through))
        for block in state_blocks(system)
    )


def _longest_of_block(
    block: StateBlock, denominator: int, through: str | None
) -> KrylovSequence | None:
    if block.system is None or not (through is None or through in block.system.names):
        return None
    sequences = best_sequences(block.system, denominator, through)
    return max(sequences, key=lambda each: each.degree, default=None)


def modes_left(blocks: Sequence[Block]) -> int:
    """How many modes may still be fixed, counted with multiplicity, by the evidence of blocks."""
    return sum(_left(block) for block in blocks)


def _left(block: Block) -> int:
    if isinstance(block.evidence, CoprimePolynomials):
        return 0
    return len(block.states) - (0 if block.evidence is None else block.evidence.degree)


def completed_blocks(system: MultiChannelSystem, blocks: Sequence[Block]) -> tuple[Block, ...]:
    """The same blocks with two polynomials where no mode is fixed and the sequence is too short."""
    return tuple(
        _completed(part, block, system.denominator) if _left(block) else block
        for part, block in zip(state_blocks(system), blocks, strict=True)
    )


def _completed(part: StateBlock, block: Block, denominator: int) -> Block:
    if part.system is None:
        return block
    decision = decide(part.system, generator(part.system, "fixed_spectrum"))
    ell = decision.modular.modulus
    if decision.obstructions or denominator % ell == 0:
        return block
    gains = lifted_gains(decision.modular, decision.gains)
    return Block(block.states, CoprimePolynomials(gains, ell))


def free_blocks(system: MultiChannelSystem) -> tuple[Block, ...] | None:
    """Blocks with a proof that no mode of any block is fixed; None if the search fails.

    If the whole system is one block, only its sequence is tried, not two polynomials.
    """
    blocks = bounded_blocks(system)
    if modes_left(blocks) and len(blocks) > 1:
        blocks = completed_blocks(system, blocks)
    return None if modes_left(blocks) else blocks


# Fixed modes of the blocks, each proved by a subspace of the states of its block.

LARGEST_DENSE = 500
"""Larger blocks are searched by sparse products, which find no Jordan chains."""

# If more modes may be fixed, sparse products, or χ_A of the block, are not tried.
_MOST_MODES = 64
_MOST_ALONE = 500

Fixed = tuple[Polynomial, int, Subspace]
"""An irreducible factor, the rank that pencils lose at its roots, and the proof."""


def local_subspaces(
    system: MultiChannelSystem, blocks: Sequence[Block]
) -> tuple[tuple[Block, ...], tuple[Fixed, ...]]:
    """Decide each block that leaves modes by itself.

    Parameters
    ----------
    system : MultiChannelSystem
    blocks : sequence of Block
        Of `bounded_blocks`.

    Returns
    -------
    blocks : tuple of Block
        The same, with two polynomials where no mode is fixed.
    fixed : tuple of (Polynomial, int, Subspace)
        Sorted by degree, then by coefficients.

    Raises
    ------
    LimitReached
        A factor divides χ_{A_F} more often than pencils lose rank at its roots: by a Jordan chain
        within a block, or in blocks of which one acts on the other through states outside of both.
        Then blocks do not prove the rank.  Or a block is too large for its search.

    Notes
    -----
    With Jordan chains of length e a factor p divides χ_{A_F} more often than pencils lose rank d.
    A shrunk subspace for pᵉ would prove that pᵉᵈ divides it.  But the claim also has the rank, and
    the degrees that blocks leave bound the loss by e·d alone.  That no pencil loses more than d
    would need blocks of the system with a further channel of d inputs and d outputs, which moves p;
    certificates have none.  Dense plants prove this rank by two polynomials (`Completion`).
    """
    parts, proved = state_blocks(system), list[Block]()
    found: dict[Polynomial, list[tuple[StateBlock, ExactSubspace]]] = {}
    for part, block in zip(parts, blocks, strict=True):
        spaces: Sequence[tuple[Polynomial, ExactSubspace]] = ()
        if _left(block):
            spaces = _subspaces_of_block(system, part, _left(block))
            if not spaces:
                block = _completed(part, block, system.denominator)
            elif _left(block) > sum(p.degree * each.deficiency for p, each in spaces):
                raise LimitReached("the modes of a block are fixed by Jordan chains")
        proved.append(block)
        for p, space in spaces:
            found.setdefault(p, []).append((part, space))
    arcs = _arcs(system)[1] if found else []
    fixed = [_in_whole(system, arcs, p, places) for p, places in found.items()]
    fixed.sort(key=lambda each: (each[0].degree, each[0].coefficients))
    return tuple(proved), tuple(fixed)


def _subspaces_of_block(
    system: MultiChannelSystem, part: StateBlock, left: int
) -> Sequence[tuple[Polynomial, ExactSubspace]]:
    """The fixed factors of a block, each with a shrunk subspace of its system."""
    size = len(part.states)
    products = part.system is not None and size > LARGEST_DENSE
    if left > (_MOST_MODES if products else _MOST_ALONE):
        raise LimitReached(f"{left} modes of a block of {size} states may be fixed")
    if part.system is not None and products:
        return fixed_subspaces(part.system)
    if part.system is not None:
        decision = decide(part.system, generator(part.system, "fixed_spectrum"))
        return [(o.polynomial, o.subspace) for o in decision.obstructions]
    A = _matrix_within(system, part.states)
    return [(p, _eigenvectors(A, p)) for p, _ in characteristic_polynomial(A).factor()]


def _matrix_within(system: MultiChannelSystem, states: Sequence[int]) -> Matrix:
    at = {state: k for k, state in enumerate(states)}
    return _within(system.A, at, at)


def _eigenvectors(A: Matrix, p: Polynomial) -> ExactSubspace:
    """The null space of xI − A modulo p, as a shrunk subspace of a system without channels."""
    U, pivots = nullspace_at(-A, Matrix.identity(A.nrows), p)
    V = PolynomialMatrix.from_matrices(Matrix.zeros(0, len(pivots)))
    return ExactSubspace((), U, V, pivots, len(pivots))


def _in_whole(
    system: MultiChannelSystem,
    arcs: list[list[int]],
    p: Polynomial,
    places: list[tuple[StateBlock, ExactSubspace]],
) -> Fixed:
    """One subspace for all blocks in which the roots of p are fixed."""
    part, space = places[0]
    if len(places) > 1:
        part, space = _joined(system, arcs, p, places)
    if part.system is system:
        return p, space.deficiency, evidence(system.names, space)
    seeing, acting = _seeing(system, arcs, part.states)
    named = () if part.system is None else part.system.names
    inner = evidence(named, space)
    kept = {*inner.channels_T, *system.named(seeing - acting)}
    T = tuple(name for name in system.names if name in kept)
    return p, space.deficiency, LocalSubspace(T, part.states, inner)


def _joined(
    system: MultiChannelSystem,
    arcs: list[list[int]],
    p: Polynomial,
    places: list[tuple[StateBlock, ExactSubspace]],
) -> tuple[StateBlock, ExactSubspace]:
    """The states of several blocks with their subspace, if it loses as much as all of them."""
    states = tuple(sorted(a for part, _ in places for a in part.states))
    if len(states) > LARGEST_DENSE:
        raise LimitReached(f"the modes of {p} are fixed in several large blocks")
    acting = sorted(_seeing(system, arcs, states)[1])
    part = StateBlock(states, _part(system, states, acting))
    space = (
        _eigenvectors(_matrix_within(system, states), p)
        if part.system is None
        else shrunk_subspace(part.system, p, generator(part.system, "fixed_spectrum"))
    )
    if space is None or space.deficiency < sum(each.deficiency for _, each in places):
        raise LimitReached(f"the modes of {p} are fixed in blocks that act on each other")
    return part, space


def _seeing(
    system: MultiChannelSystem, arcs: list[list[int]], states: Sequence[int]
) -> tuple[set[int], set[int]]:
    """The channels that see some states or what these drive, and those that act within them."""
    n, own = system.n, set(states)
    found, rest = set(own), [*states]
    while rest:
        new = set(arcs[rest.pop()]) - found
        found |= new
        rest += new
    within = {c for b in states for c in arcs[b] if c >= n and not own.isdisjoint(arcs[c])}
    if any(not own.isdisjoint(arcs[b]) for b in found - own - within):
        raise LimitReached("a factor is fixed in several blocks, with others between them")
    return {c - n for c in found if c >= n}, {c - n for c in within}


# Blocks of channels that measure states, which prove how much these channels control.

Measured = tuple[tuple[int, ...], ...]
"""The states that each channel measures."""


def measured_system(
    system: MultiChannelSystem, T: Sequence[int]
) -> tuple[MultiChannelSystem, Measured]:
    """The system of some channels, at least one, that measure states; and these states.

    Notes
    -----
    The first channel with inputs measures all states.  Every other channel measures states that its
    own inputs and those of the channel before it drive, and a share of all states that is drawn: so
    what T reaches is one block, and generic gains mostly move all that T controls, observed and
    controlled through that first channel.
    """
    driven = [_driven(system.B(i)) for i in T]
    acting = [k for k, states in enumerate(driven) if states]
    chosen: list[set[int]] = [set() for _ in T]
    states = list(range(system.n))
    random.Random(system.n).shuffle(states)
    for share, (before, k) in enumerate(pairwise(acting)):
        chosen[k] = {*driven[k], driven[before][0], *states[share :: len(acting) - 1]}
    if acting:
        chosen[acting[0]] = set(range(system.n))
    measured = tuple(tuple(sorted(states)) for states in chosen)
    part = MultiChannelSystem(
        system.A,
        [system.B(i) for i in T],
        [_picking(states, system.n) for states in measured],
        time=system.time,
        names=system.named(T),
    )
    return part, measured


def measured_blocks(part: MultiChannelSystem) -> tuple[Block, ...]:
    """Blocks of a system of `measured_system`; with long sequences they leave just n − d modes."""
    names = [c.name for c in part.channels if not c.B.is_zero()]
    return bounded_blocks(part, (names or part.names)[0])


def _driven(B: Matrix) -> list[int]:
    """For each input the first state that it drives."""
    first: dict[int, int] = {}
    for a, j, _ in B.nonzero():
        first.setdefault(j, a)
    return sorted(set(first.values()))


def _picking(states: Sequence[int], n: int) -> Matrix:
    return Matrix.from_entries((len(states), n), [(k, a, 1) for k, a in enumerate(states)])


def transposed_blocks(blocks: Sequence[Block]) -> tuple[Block, ...]:
    """The same evidence about the dual system: c Mᵏ b = b' M'ᵏ c', and arcs are reversed."""
    return tuple(Block(block.states, _transposed(block.evidence)) for block in reversed(blocks))


def _transposed(
    evidence: KrylovSequence | CoprimePolynomials | None,
) -> KrylovSequence | CoprimePolynomials | None:
    if evidence is None:
        return None
    gains = tuple(F.T for F in evidence.gains)
    if isinstance(evidence, CoprimePolynomials):
        return CoprimePolynomials(gains, evidence.modulus)
    return KrylovSequence(
        modulus=evidence.modulus,
        gains=gains,
        channel=evidence.channel,
        inputs=evidence.outputs,
        outputs=evidence.inputs,
        recurrence=evidence.recurrence,
        cofactors=evidence.cofactors,
    )
