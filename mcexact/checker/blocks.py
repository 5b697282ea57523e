"""Blocks of states, each decided by itself; ``proofs/krylov.md``, K8."""

from itertools import chain

from .budget import counted, spend, table
from .reading import Json, fields, items, positions, require
from .system import System


def split(value: Json, place: str, system: System) -> list[tuple[str, System, Json]]:
    """The systems of the blocks, each with the channels that act within it, and their evidence.

    Every state is in one block, and no closed loop leads from a block to a later one.

    Theorems ``blocks.block_bounded``, ``fixed_bound.bounded_channels``.
    """
    listed, states, n = [], [], system.n
    for k, entry in enumerate(items(value, place)):
        where = f"{place}[{k}]"
        chosen, proof = fields(entry, where, "states", "evidence")
        spend(20 * len(items(chosen, f"{where}.states")))
        states.append(positions(chosen, f"{where}.states", n))
        listed.append((f"{where}.evidence", proof))
    once = sorted(chain(*states)) == list(range(n))
    require(once, "partition", place, "expected every state in one block")
    at = {a: k for k, block in enumerate(states) for a in block}
    within = _channels(system, at, place, len(states))
    found: list[tuple[str, System, Json]] = []
    earlier: list[int] = []
    for block, acting, (where, proof) in zip(counted(states), within, listed, strict=True):
        spend(len(block) * (8 + len(earlier)))
        down = any(any(map(system.A.rows[a].__getitem__, earlier)) for a in block)
        require(not down, "order", where, "an earlier block acts on it")
        found.append((where, _part(system, block, acting), proof))
        earlier += block
    return found


def _channels(system: System, at: dict[int, int], place: str, count: int) -> list[list[int]]:
    """The channels that act within each block: that have inputs and outputs there."""
    found: list[list[int]] = [[] for _ in range(count)]
    for i, (B, C) in enumerate(zip(system.B, system.C, strict=True)):
        spend(table(B.nrows, B.ncols) + table(C.nrows, C.ncols))
        moved = [at[a] for a, row in enumerate(B.rows) if any(row)]
        seen = [at[b] for row in C.rows for b, entry in enumerate(row) if entry]
        if moved and seen:
            message = f"channel number {i + 1} leads to a later block"
            require(max(moved) <= min(seen), "order", place, message)
            if max(moved) == min(seen):
                found[min(seen)].append(i)
    return found


def _part(system: System, block: list[int], acting: list[int]) -> System:
    """The states of a block by themselves, with some channels."""
    cols = None if len(block) == system.n else block
    B = [system.B[i].take(block) for i in acting]
    C = [system.C[i].take(cols=cols) for i in acting]
    named = [system.names[i] for i in acting]
    return System(system.time, named, system.A.take(block, cols), B, C)
