"""Kind ``neighbor_graph``: whether it is strongly connected; ``proofs/neighbor_graph.md``."""

from collections.abc import Iterable

from .budget import spend
from .information_structure import neighbors_of
from .reading import Json, boolean, fields, require
from .statement import denied
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Recompute the answer from the sets of neighbors.

    Theorem ``strong_components.strongly_connected_rule``.
    """
    (verdict,) = fields(claim, "claim", "strongly_connected")
    fields(witness, "witness")
    arcs = [(j, i) for i, N_i in enumerate(neighbors_of(system, "subject")) for j in N_i]
    connected = len(components(system.m, arcs)) <= 1
    place, answer = "claim.strongly_connected", f"{denied(connected)}strongly connected"
    require(boolean(verdict, place) == connected, "claim", place, f"the graph is {answer}")


def statement(claim: Json, system: System) -> str:
    """Whether the neighbor graph is strongly connected."""
    return f"its neighbor graph is {denied(claim['strongly_connected'])}strongly connected"


def components(m: int, arcs: Iterable[tuple[int, int]]) -> list[list[int]]:
    """The strong components of the graph on m nodes with edges j → i, sorted by first member.

    Theorems ``strong_components.closure_connect``, ``strong_components.component_rule``.
    """
    spend(m * m * (12 + m // 500) + 100)
    ahead, behind = ([1 << j for j in range(m)] for _ in range(2))  # sets of nodes, as bits
    for j, i in arcs:
        ahead[j] |= 1 << i
        behind[i] |= 1 << j
    for reached in (ahead, behind):
        for k in range(m):
            for j in range(m):
                if reached[j] >> k & 1:
                    reached[j] |= reached[k]
    parts = {a & b for a, b in zip(ahead, behind, strict=True)}
    return sorted([i for i in range(m) if part >> i & 1] for part in parts)
