"""Blocks of states whose fixed modes are those of the system, and the proof that each has no more.

A system splits into the strong components of the digraph with an arc b → a between two states if
A_ab ≠ 0, or if a row a of some B_i and a column b of C_i are not 0.  Every closed loop is block
triangular, and a channel acts within one block at most, so the blocks share no gain.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from mcexact.analysis.engine.obstructions import decide
from mcexact.analysis.engine.one_channel import best_sequences
from mcexact.answer.evidence import Block, CoprimePolynomials, KrylovSequence
from mcexact.derived.modular import generator, lifted_gains
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.model.system import MultiChannelSystem

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
    found = []
    for component in _components(*_arcs(system)):
        states = tuple(sorted(v for v in component if v < system.n))
        if states:
            acting = sorted(v - system.n for v in component if v >= system.n)
            found.append(StateBlock(states, _part(system, states, acting)))
    return tuple(found)


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


def _components(into: list[list[int]], out: list[list[int]]) -> list[list[int]]:
    """The strong components, by two depth-first searches; each is reached from later ones alone."""
    unseen, found = bytearray(b"\1" * len(into)), []
    order = _finished(into, range(len(into)), unseen)
    unseen = bytearray(b"\1" * len(into))
    for root in reversed(order):
        component = _finished(out, [root], unseen)
        if component:
            found.append(component)
    return found


def _finished(arcs: list[list[int]], roots: Iterable[int], unseen: bytearray) -> list[int]:
    """The unseen nodes that are reached, in the order in which the search leaves them."""
    order = []
    for root in roots:
        if not unseen[root]:
            continue
        unseen[root] = 0
        path = [(root, iter(arcs[root]))]
        while path:
            node, rest = path[-1]
            for other in rest:
                if unseen[other]:
                    unseen[other] = 0
                    path.append((other, iter(arcs[other])))
                    break
            else:
                order.append(node)
                path.pop()
    return order


def bounded_blocks(system: MultiChannelSystem, through: str | None = None) -> tuple[Block, ...]:
    """The blocks, each with the longest sequence that is found for it.

    Parameters
    ----------
    system : MultiChannelSystem
    through : str, optional
        The name of a channel: only this one is tried, in the block in which it acts.
    """
    return tuple(
        Block(block.states, _longest(block, system.denominator, through))
        for block in state_blocks(system)
    )


def _longest(block: StateBlock, denominator: int, through: str | None) -> KrylovSequence | None:
    if block.system is None or not (through is None or through in block.system.names):
        return None
    found = best_sequences(block.system, denominator, through)
    return max(found, key=lambda each: each.degree, default=None)


def modes_left(blocks: Sequence[Block]) -> int:
    """How many modes the evidence leaves, with their multiplicities, that may be fixed."""
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
    """Blocks with the proof that no mode of any is fixed; None if it is not found.

    Where the whole system is one block, it is not found by two polynomials.
    """
    blocks = bounded_blocks(system)
    if modes_left(blocks) and len(blocks) > 1:
        blocks = completed_blocks(system, blocks)
    return None if modes_left(blocks) else blocks
