"""Documents made by hand about failures, models, periodic loops and large moduli, each false."""

from __future__ import annotations

from typing import Any

from tests.checker.handmade import FREE, certificate, changed, layers, matrix, plant
from tests.oracle.drawn.plants import Document

# Two channels that see x and drive it; the second one receives messages of the first one.
HEARD = plant([[2]], ([[1]], [[1]]), ([[1]], [[1]]), neighbors={"1": [], "2": ["1"]})
NOTHING: Document = {
    "construction": "failed",
    "agents": [],
    "actuators": [],
    "sensors": [],
    "links": [],
}
MOVED = certificate(
    "fixed_spectrum",
    HEARD,
    FREE["claim"],
    {
        "gains": [matrix([1]), matrix([0])],
        "modulus": 7,
        "subspaces": [],
        "completion": None,
    },
)
"""Nothing is fixed, as the first channel shows alone."""


def after(**lost: Any) -> Document:
    """The same after failures."""
    return changed(MOVED, ("subject", [{**NOTHING, **lost}]))


# x(t+1) = 2x + u_1 + u_2 with u_1 = -2x in one of two phases.
DISCRETE = {**HEARD, "time": "discrete"}


def agent(name: str, gain: int = 0, **more: Any) -> Document:
    """An agent without states, with a gain from its own output."""
    program = {"outputs": {name: [[gain]]}} if gain else {}
    own = {"shared": 0, "private": 0, "shared_update": {}, "private_update": {}}
    return {"name": name, **own, "input": program, **more}


def over(*phases: list[Document], time: str = "discrete") -> Document:
    """That these two phases stabilize, or in continuous time that they do not."""
    listed = [{"time": time, "agents": agents} for agents in phases]
    return certificate(
        "stability",
        {**DISCRETE, "time": time},
        {"bound": None, "stable": time == "discrete"},
        {"method": "polynomial"},
        {"construction": "periodic_loop", "phases": listed},
    )


ACTS, RESTS = [agent("1", -2), agent("2")], [agent("1"), agent("2")]
PERIODIC = over(ACTS, RESTS)
HEARS = {"outputs": {"1": [[-2]]}}


def following(*gains: int) -> Document:
    """Nothing is fixed where both agents follow steps of x."""
    model = {"construction": "internal_model", "polynomial": [0, 1]}
    model["gains"] = [matrix([1]), matrix([1])]
    widened = [matrix([gain, 1]) for gain in gains]
    return changed(MOVED, ("subject", [model]), ("witness.gains", widened))


TRAPS: dict[str, Document] = {
    "two agents that follow different steps by one state": following(1, 2),
    "after no failure": after(),
    "an input that fails and is not there": after(actuators=[["2", 1], ["2", 2]]),
    "an output that fails twice": after(sensors=[["2", 1], ["2", 1]]),
    "a link that fails twice": after(links=[["1", "2"], ["1", "2"]]),
    "a link that fails and is not there": after(links=[["2", "1"]]),
    "a link of an agent to itself that fails": after(links=[["1", "1"]]),
    "a periodic loop in continuous time": over(ACTS, RESTS, time="continuous"),
    "a phase in the other time": changed(PERIODIC, ("subject.0.phases.1.time", "continuous")),
    "agents of a phase in another order": over(ACTS, RESTS[::-1]),
    "a state that another agent has in the next phase": over(
        [agent("1", -2, private=1), agent("2")], [agent("1"), agent("2", private=1)]
    ),
    "a message in a periodic loop": over([agent("1"), agent("2", input=HEARS)], RESTS),
    # 0 and 7 are both fixed, and modulo 7 they are one root of multiplicity two
    "another fixed mode that is the same one modulo 7": certificate(
        "fixed_spectrum",
        plant([[0, 1], [0, 7]], ([[0], [0]], [[1, 0]])),
        {
            "polynomial": [0, 1],
            "factors": [
                {
                    "polynomial": [0, 1],
                    "multiplicity_in_A": None,
                    "multiplicity_at_most": 2,
                    "channels": [],
                    "rank": 1,
                    "stable": False,
                    "roots": [{"re": "0", "im": "0", "radius": "0"}],
                }
            ],
            "stabilizable": False,
            "best_rate": {"lower": "0", "upper": "0"},
        },
        {
            "gains": [matrix([1])],
            "modulus": 7,
            "subspaces": [
                {
                    "channels_T": ["1"],
                    "U": layers([[1], [0]]),
                    "V": layers([[0]]),
                    "pivots": [0],
                }
            ],
            "completion": {"B0": matrix([0], [1]), "C0": matrix([1, 0])},
        },
    ),
}
