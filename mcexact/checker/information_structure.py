"""Constructions ``augmented_outputs``, ``arcs`` and ``extended``, which share information."""

from dataclasses import replace

from . import reading
from .arithmetic import Matrix, diagonal, stack
from .budget import spend
from .evidence import outputs
from .statement import by_channel, canonical_json, edge_set, prefixed, suffixed
from .system import System

SHARED = {"outputs+states": "outputs and sub-states", "states": "sub-states"}


def neighbors_of(system: System, place: str) -> list[list[int]]:
    """The sets N_i; the system must have a neighbor graph."""
    found = system.neighbors is not None
    reading.require(found, "subject", place, "the system has no neighbor graph")
    return system.neighbors or []


def augmented_outputs(system: System, step: dict[str, reading.Json], place: str) -> System:
    """C_i becomes C_{N_i}.

    Open: see ``proofs/OPEN.md``.
    """
    reading.fields(step, place)
    N = neighbors_of(system, place)
    C = [outputs(system, N_i) for N_i in N]
    words = suffixed(system, "with the outputs of neighbors measured by each agent")
    return replace(system, C=C, words=words)


def arcs(system: System, step: dict[str, reading.Json], place: str) -> System:
    """j joins N_i for each added edge [j, i].

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = reading.fields(step, place, "added")
    spend(40 * sum(map(len, neighbors_of(system, place))) + 100 * system.m)
    sets, added = [set(N_i) for N_i in neighbors_of(system, place)], []
    for arc in reading.items(listed, place):
        j, i = (system.place_of(end, place) for end in reading.items(arc, place, 2))
        reading.require(j not in sets[i], "subject", place, "the edge is there already")
        sets[i].add(j)
        added.append((j, i))
    named = edge_set((system.names[j], system.names[i]) for j, i in sorted(added))
    words = suffixed(system, f"with the links {named} added to its neighbor graph")
    return replace(system, neighbors=[sorted(N_i) for N_i in sets], words=words)


def read_shares(system: System, step: dict[str, reading.Json], place: str) -> tuple[str, list[int]]:
    """Read which signals are shared, and the dimensions n_i of the sub-states."""
    share, listed = reading.fields(step, place, "share", "dimensions")
    return reading.string(share, place, *SHARED), read_dimensions(system, listed, place)


def read_dimensions(system: System, value: reading.Json, place: str) -> list[int]:
    """The dimensions n_i, one for each agent."""
    return [reading.integer(size, place) for size in reading.items(value, place, system.m)]


def shared(system: System, share: str, sizes: list[int]) -> str:
    """What agents share, and in how many dimensions."""
    return f"{SHARED[share]} of dimensions {canonical_json(by_channel(system, sizes))}"


def extended(system: System, step: dict[str, reading.Json], place: str) -> System:
    """Paper, section IV-C: state (x, x_1, …, x_m); x_i' or x_i(t+1) is an input of agent i.

    Open: see ``proofs/OPEN.md``.
    """
    (share, sizes), N = read_shares(system, step, place), neighbors_of(system, place)
    total = sum(sizes)
    E = [Matrix.unit_rows(total, sum(sizes[:i]), size) for i, size in enumerate(sizes)]
    B = [diagonal(B_i, E_i.T) for B_i, E_i in zip(system.B, E, strict=True)]
    own = [outputs(system, N_i if share == "outputs+states" else [i]) for i, N_i in enumerate(N)]
    heard = [stack([E[j] for j in N_i], total) for N_i in N]
    C = [diagonal(C_i, E_N) for C_i, E_N in zip(own, heard, strict=True)]
    A = diagonal(system.A, Matrix.zeros(total, total))
    given = shared(system, share, sizes)
    words = prefixed(f"the extended system without delays sharing {given}", system)
    return replace(system, A=A, B=B, C=C, words=words)
