"""Documents made by hand about what must be shared and about neighbor graphs, each false."""

from __future__ import annotations

import random
from typing import Any

from tests.checker.handmade import certificate, layers, plant
from tests.oracle.certificates.constructions import extended, subject_of
from tests.oracle.drawn.plants import Document

from .plain_traps import dimensions
from .sharing import absence

TWO_MODES = plant(
    [[1, 0], [0, 1]],
    ([[1, 0], [0, 1]], [[0, 0]]),
    ([[0], [0]], [[1, 0]]),
    ([[0], [0]], [[1, 0], [0, 1]]),
    neighbors={"1": ["3"], "2": ["3"], "3": []},
)
"""What agent 3 measures has to reach agent 1, in two dimensions."""


def shared_by_the_last(size: int | None, tree: Document, upper: int | None = None) -> Document:
    """That agent 3 has to share so many dimensions, or that no number of them suffices."""
    sizes = None if size is None else [0, 0, size]
    witness: dict[str, Any] = {
        "absence": None,
        "cuts": [
            {
                "subset": ["1"],
                "polynomial": [-1, 1],
                "deficiency": 2,
                "subspace": {
                    "channels_T": ["2", "3"],
                    "U": layers([[1, 0], [0, 1]]),
                    "V": layers([[0, 0], [0, 0]]),
                    "pivots": [0, 1],
                },
            },
            {
                "subset": ["1", "2"],
                "polynomial": [-1, 1],
                "deficiency": 1,
                "subspace": {
                    "channels_T": ["3"],
                    "U": layers([[0], [1]]),
                    "V": layers([[0]]),
                    "pivots": [1],
                },
            },
        ],
        "tree": [tree],
    }
    made = dimensions(TWO_MODES, sizes, size or 0, witness, upper=[None, None, upper])
    if sizes is not None:
        rng = random.Random(0)
        made["witness"]["absence"] = absence(
            rng, extended(subject_of(made), {"share": "states", "dimensions": sizes})
        )
    return made


NAMES = ["1", "2", "3", "4", "5"]
IN_A_ROW = plant(
    [[0]],
    *[([[1]], [[1]])] * 5,
    neighbors={"1": ["2"], "2": ["3"], "3": ["4"], "4": ["5"], "5": []},
)
"""Each agent receives from the next one."""
NOT_APART = certificate(
    "sharing_gap",
    IN_A_ROW,
    {"relays": 2, "relays_at_most": 2, "boundary": 2, "boundary_at_most": 2},
    {
        "receivers": ["1"],
        "senders": ["2", "3"],
        "dominating": ["1", "3", "5"],
        "tree": [{"multipliers": [[0, 1], [2, 1], [4, 1]]}],
    },
)

TRAPS: dict[str, Document] = {
    "a multiplier below 0": shared_by_the_last(3, {"nested": [[0, 2], [1, -1]]}),
    "multipliers above the cost of an agent": shared_by_the_last(4, {"nested": [[0, 2]]}),
    "multipliers that prove less": shared_by_the_last(3, {"nested": [[0, 1]]}),
    "nested sets for what is not possible": shared_by_the_last(None, {"nested": []}),
    "upper bounds that a cut does not violate": shared_by_the_last(None, {"violated": 0}, upper=2),
    "a receiver that hears a sender": NOT_APART,
}
