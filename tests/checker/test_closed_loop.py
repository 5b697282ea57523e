"""The construction ``closed_loop``: which states belong to the plant and to each agent."""

from __future__ import annotations

from tests.checker.handmade import Document, certificate, plant
from tests.checker.tables import accepts


def copy_of_the_plant(name: str, private: int, private_update: Document) -> Document:
    """An agent with x_i' = −x_i, as the plant has it."""
    return {
        "name": name,
        "shared": 1,
        "private": private,
        "shared_update": {"shared": {name: [[-1]]}},
        "private_update": private_update,
        "input": {},
    }


PORT = ([[1]], [[1]])
THREE = certificate(
    "distributed_observer",
    plant([[-1]], PORT, PORT, PORT, neighbors={"1": [], "2": [], "3": []}),
    {"feedback": [1, 1], "error": [2, 7, 9, 5, 1], "bound": None},
    {"moduli": [101]},
    {
        "construction": "closed_loop",
        "controller": {
            "time": "continuous",
            "agents": [
                copy_of_the_plant("1", 0, {}),
                copy_of_the_plant("2", 0, {}),
                copy_of_the_plant("3", 1, {"private": [[-2]]}),
            ],
        },
    },
)
"""ė_i = −e_i and ż_3 = −2 z_3: (x + 1)³ (x + 2)."""


test_every_state_belongs_to_the_plant_or_an_agent = accepts(
    [("the last of three agents has a state that it does not share", THREE)]
)
