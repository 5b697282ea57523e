"""Blocks of states whose fixed modes are those of the system, and the proof that each has no more.

A system splits into the strong components of the digraph with an arc b → a between two states if
A_ab ≠ 0, or if a row a of some B_i and a column b of C_i are not 0.  Every closed loop is block
triangular, and a channel acts within one block at most, so the blocks share no gain.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import prod

from mcexact.analysis.engine.obstructions import decide
from mcexact.analysis.engine.one_channel import best_sequences
from mcexact.answer.evidence import Block, CoprimePolynomials, KrylovSequence
from mcexact.derived.modular_system import generator, lifted_gains
from mcexact.exact.matrix import Matrix
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
    n = system.n
    [flags] = _flags([system.A])
    if _connected(flags, n):
        acting = [i for i, c in enumerate(system.channels) if not (c.B.is_zero() or c.C.is_zero())]
        states = tuple(range(n))
        return (StateBlock(states, _part(system, states, acting)),)
    found = []
    for component in _components(*_arcs(system)):
        states = tuple(sorted(v for v in component if v < n))
        if states:
            acting = sorted(v - n for v in component if v >= n)
            found.append(StateBlock(states, _part(system, states, acting)))
    return tuple(found)


def _part(
    system: MultiChannelSystem, states: Sequence[int], acting: Sequence[int]
) -> MultiChannelSystem | None:
    if not acting:
        return None
    if len(states) == system.n and len(acting) == system.m:
        return system
    return MultiChannelSystem(
        system.A.take(states, states),
        [system.B(i).take(rows=states) for i in acting],
        [system.C(i).take(cols=states) for i in acting],
        time=system.time,
        names=system.named(acting),
    )


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


def _arcs(system: MultiChannelSystem) -> tuple[list[int], list[int]]:
    """For each state, then each channel, what arcs come from and lead to: a byte for each."""
    n, m, moved, seen = system.n, system.m, [], []
    parts = [M for channel in system.channels for M in (channel.B, channel.C)]
    A, *ports = _flags([system.A, *parts])
    for channel, B, C in zip(system.channels, ports[::2], ports[1::2], strict=True):
        p = channel.B.ncols
        moved.append(_either(B[u::p] for u in range(p)))
        seen.append(_either(C[v * n : v * n + n] for v in range(channel.C.nrows)))
    B, C = (b"".join(mask.to_bytes(n, "little") for mask in masks) for masks in (moved, seen))
    into = [_number(A[a * n : a * n + n] + B[a::n]) for a in range(n)]
    out = [_number(A[b::n] + C[b::n]) for b in range(n)]
    return into + seen, out + moved if n else [0] * m


def _flags(parts: Sequence[Matrix]) -> list[bytes]:
    """For each matrix a byte for each entry, row by row: 1 if it is not 0."""
    tables = [M.words for M in parts]
    words = [table for table in tables if table is not None]
    if sum(map(len, words)) < _LARGE or len(words) < len(parts):
        return [
            bytes(entry != 0 for row in M.numerators for entry in row)
            if table is None
            else bytes(map(bool, table))
            for M, table in zip(parts, tables, strict=True)
        ]
    import numpy as np

    together = bytes(np.frombuffer(b"".join(words), dtype=np.int64) != 0)
    found, start = [], 0
    for table in words:
        found.append(together[start : start + len(table)])
        start += len(table)
    return found


def _number(flags: bytes) -> int:
    return int.from_bytes(flags, "little")


def _either(parts: Iterable[bytes]) -> int:
    found = 0
    for part in parts:
        found |= _number(part)
    return found


def _components(into: list[int], out: list[int]) -> list[list[int]]:
    """The strong components, by two depth-first searches; each is reached from later ones alone."""
    found = []
    unseen = _number(b"\1" * len(into))
    order, _ = _finished(into, range(len(into)), unseen)
    for root in reversed(order):
        component, unseen = _finished(out, [root], unseen)
        if component:
            found.append(component)
    return found


def _finished(arcs: list[int], roots: Sequence[int], unseen: int) -> tuple[list[int], int]:
    """The nodes that are reached, in the order in which the search leaves them; and the others."""
    order = []
    for root in roots:
        if not unseen >> 8 * root & 1:
            continue
        unseen ^= 1 << 8 * root
        path = [root]
        while path:
            rest = arcs[path[-1]] & unseen
            if rest:
                bit = rest & -rest
                unseen ^= bit
                path.append(bit.bit_length() // 8)
            else:
                order.append(path.pop())
    return order, unseen


def bounded_blocks(system: MultiChannelSystem, through: str | None = None) -> tuple[Block, ...]:
    """The blocks, each with the longest sequence that is found for it.

    Parameters
    ----------
    system : MultiChannelSystem
    through : str, optional
        The name of a channel: only this one is tried, in the block in which it acts.
    """
    denominator = _denominator(system)
    return tuple(
        Block(block.states, _longest(block, denominator, through)) for block in state_blocks(system)
    )


def _denominator(system: MultiChannelSystem) -> int:
    parts = [M for channel in system.channels for M in (channel.B, channel.C)]
    return prod({M.denominator for M in (system.A, *parts)})


def _longest(block: StateBlock, denominator: int, through: str | None) -> KrylovSequence | None:
    if block.system is None or through not in {None, *block.system.names}:
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
    parts, denominator = state_blocks(system), _denominator(system)
    return tuple(
        _completed(part, block, denominator) if _left(block) else block
        for part, block in zip(parts, blocks, strict=True)
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
