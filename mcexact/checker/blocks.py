"""Blocks of states, each decided by itself; ``proofs/krylov.md``, K8."""

from itertools import chain

from . import sparse
from .budget import counted, spend
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
    entered = set() if len(states) < 2 else _entered(system, at)
    found: list[tuple[str, System, Json]] = []
    turns = zip(counted(states), within, listed, strict=True)
    for k, (block, acting, (where, proof)) in enumerate(turns):
        require(k not in entered, "order", where, "an earlier block acts on it")
        found.append((where, _part(system, block, acting), proof))
    return found


def _entered(system: System, at: dict[int, int]) -> set[int]:
    """The blocks on which an earlier one acts."""
    entries = sparse.entries_of(system.A)
    spend(8 * len(entries))
    return {at[a] for a, b, _ in entries if at[b] < at[a]}


def _channels(system: System, at: dict[int, int], place: str, count: int) -> list[list[int]]:
    """The channels that act within each block: that have inputs and outputs there."""
    ports = list(enumerate(zip(system.B, system.C, strict=True)))
    if count == 1:
        return [[i for i, (B, C) in ports if not (B.is_zero() or C.is_zero())]]
    found: list[list[int]] = [[] for _ in range(count)]
    for i, (B, C) in ports:
        moved = [at[a] for a, _, _ in sparse.entries_of(B)]
        seen = [at[b] for _, b, _ in sparse.entries_of(C)]
        spend(8 * (len(moved) + len(seen)))
        if moved and seen:
            message = f"channel number {i + 1} leads to a later block"
            require(max(moved) <= min(seen), "order", place, message)
            if max(moved) == min(seen):
                found[min(seen)].append(i)
    return found


def _part(system: System, block: list[int], acting: list[int]) -> System:
    """The states of a block by themselves, with some channels."""
    spend(40 * len(block))
    places = None if len(block) == system.n else {a: k for k, a in enumerate(block)}
    B = [sparse.within(system.B[i], places, None) for i in acting]
    C = [sparse.within(system.C[i], None, places) for i in acting]
    named = [system.names[i] for i in acting]
    return System(system.time, named, sparse.within(system.A, places, places), B, C)
