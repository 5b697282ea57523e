"""Kind ``neighbor_graph``: whether it is strongly connected; ``proofs/neighbor_graph.md``."""

from __future__ import annotations

from typing import Any

from .evidence import components
from .exchange import neighbors_of
from .reading import boolean, fields, require
from .system import System
from .words import described


def check(claim: Any, witness: Any, system: System) -> str:
    """Recompute the answer from the sets of neighbors."""
    (verdict,) = fields(claim, "claim", "strongly_connected")
    fields(witness, "witness")
    arcs = [(j, i) for i, N_i in enumerate(neighbors_of(system, "subject")) for j in N_i]
    connected = len(components(system.m, arcs)) <= 1
    answer = "strongly connected" if connected else "not strongly connected"
    same = boolean(verdict, "claim.strongly_connected") == connected
    require(same, "claim", "claim.strongly_connected", f"the graph is {answer}")
    return f"the neighbor graph of {described(system)} is {answer}"
