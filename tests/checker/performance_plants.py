"""Certificates about costs, bounds, margins, sectors and steps, written by hand."""

from __future__ import annotations

from typing import Any

from tests.checker.handmade import Document, certificate, changed, matrix, plant


def form(*rows: list[int], exponent: int = 0) -> Document:
    """A symmetric matrix of integers times 4^exponent, by the rows of its lower half."""
    entries = [x for row in rows for x in row]
    return {"exponents": [exponent] * len(rows), "entries": entries}


def static(system: Document, *gains: int | str) -> Document:
    """The loop with constant gains, one for each agent."""
    agents: list[Any] = [
        {
            "name": channel["name"],
            "shared": 0,
            "private": 0,
            "shared_update": {},
            "private_update": {},
            "input": {"outputs": {channel["name"]: [[gain]]}} if gain else {},
        }
        for channel, gain in zip(system["channels"], gains, strict=True)
    ]
    return {
        "construction": "closed_loop",
        "controller": {"time": system["time"], "agents": agents},
    }


def weights(n: int, ports: int, **more: Any) -> Document:
    """All weights 1."""
    ones = {"states": [1] * n, "inputs": [1] * ports}
    return {**ones, "disturbances": [1] * n, "noise": [1] * ports, **more}


# x(t+1) = x + u, y = x, u = -y: the loop forgets its state at once.
STEP = plant([[1]], ([[1]], [[1]]), time="discrete")
DEADBEAT = static(STEP, -1)
# X = 2, and 2·2 + 1 for the noise that passes to u: 5; P = 3 proves 3 + 3 + 1.
COST = certificate(
    "loop_cost", STEP, {"weights": weights(1, 1), "cost": 7}, {"P": form([3])}, DEADBEAT
)
# x' = x + u, u = -3 (x + v), v' = -2 v + 2 n; P is large enough, and the cost is far below.
DRIVEN = plant([[1]], ([[1]], [[1]]))
FILTERED = certificate(
    "loop_cost",
    DRIVEN,
    {"weights": weights(1, 1, bandwidth=2), "cost": 1000},
    {"P": form([40], [-20, 60])},
    static(DRIVEN, -3),
)
# Nothing that the agent measures passes to its input: without a bandwidth, P = 1 proves 1.
FALLING = plant([[-1]], ([[1]], [[1]]))
IDLE = certificate(
    "loop_cost",
    FALLING,
    {"weights": weights(1, 1), "cost": 1},
    {"P": form([1])},
    static(FALLING, 0),
)
# A = 0: x is the last disturbance and the last input; P = 1/2 and F = 0 prove 1/2.
FORGETFUL = plant([[0]], ([[1]], [[1]]), time="discrete")
BOUND = certificate(
    "cost_bound",
    FORGETFUL,
    {"weights": weights(1, 1), "cost": "1/2"},
    {
        "groups": [
            {
                "agents": ["1"],
                "disturbances": [1],
                "noise": [1],
                "P": form([2], exponent=-1),
                "S": form([1], exponent=-1),
                "F": matrix([0]),
                "share": 0,
            }
        ]
    },
)
# The same of a plant whose input enters twice as much as its output shows.
ENTERING = plant([[0]], ([[2]], [[1]]), time="discrete")
ENTERED = certificate("cost_bound", ENTERING, BOUND["claim"], BOUND["witness"])
# x(t+1) = x + u: P = 3/2, S = 1/2 and F = -3/5 prove 3/2, and 9/25 · 1/4 · (1 + 3/2) · 1/2 more.
STEPPING = changed(
    certificate("cost_bound", STEP, BOUND["claim"], BOUND["witness"]),
    ("claim.cost", "129/80"),
    ("witness.groups.0.P", form([6], exponent=-1)),
    ("witness.groups.0.S", form([2], exponent=-1)),
    ("witness.groups.0.F", matrix([-3], denominator=5)),
    ("witness.groups.0.share", "1/4"),
)
# x' = x + u: the regulator has P = -F = 1 + √2, and S > 0 adds to the bound.
SHARED = changed(
    certificate("cost_bound", DRIVEN, BOUND["claim"], BOUND["witness"]),
    ("claim", {"weights": weights(1, 1), "cost": 3}),
    ("witness.groups.0.P", form([2])),
    ("witness.groups.0.S", form([2])),
    ("witness.groups.0.F", matrix([-2])),
    ("witness.groups.0.share", "1/4"),
)
# x(t+1) = x/2 + 2u, y = 3x, with weights and intensities that all differ.
UNLIKE = plant([["1/2"]], ([[2]], [[3]]), time="discrete")
UNLIKE_WEIGHTS = {"states": [2], "inputs": [3], "disturbances": [5], "noise": [7]}
# u = -y/12 forgets the state at once: P = 9/4 > 2 + 3/16 proves 45/4 + 7/16 + 7/48.
UNLIKE_COST = certificate(
    "loop_cost",
    UNLIKE,
    {"weights": UNLIKE_WEIGHTS, "cost": "71/6"},
    {"P": form([9], exponent=-1)},
    static(UNLIKE, "-1/12"),
)
# P = 2, S = 39/64 and F = -1/5 prove 10, and 1/25 · 1/4 · (3 + 8) · 39/64 more.
UNLIKE_BOUND = changed(
    STEPPING,
    ("system", UNLIKE),
    ("claim", {"weights": UNLIKE_WEIGHTS, "cost": "64429/6400"}),
    ("witness.groups.0.disturbances", [5]),
    ("witness.groups.0.noise", [7]),
    ("witness.groups.0.P", form([2])),
    ("witness.groups.0.S", form([39], exponent=-3)),
    ("witness.groups.0.F", matrix([-1], denominator=5)),
)
# u = -y/24: T = -1/4 / (x - 1/4) at both ports, whose |T + 1/2| is at most 7/10.
UNLIKE_MARGIN = certificate(
    "disk_margin",
    UNLIKE,
    {"at": "inputs", "together": False, "margin": 1},
    {"parts": [{"ports": [0], "scaling": [1], "P": form([1], exponent=-2)}]},
    static(UNLIKE, "-1/24"),
)
# x2(t+1) = u, x1(t+1) = x2, u = 0: T = 0.
SHIFTING = plant([[0, 1], [0, 0]], ([[0], [1]], [[1, 0]]), time="discrete")
SHIFTING_MARGIN = certificate(
    "disk_margin",
    SHIFTING,
    {"at": "inputs", "together": False, "margin": 1},
    {"parts": [{"ports": [0], "scaling": [1], "P": form([1], [0, 2], exponent=-1)}]},
    static(SHIFTING, 0),
)
# P and S are diagonal, and so large that another order of the states would be too much.
SHIFTING_BOUND = changed(
    STEPPING,
    ("system", SHIFTING),
    ("claim", {"weights": weights(2, 1), "cost": "9/4"}),
    ("witness.groups.0.disturbances", [1, 1]),
    ("witness.groups.0.P", form([3], [0, 6], exponent=-1)),
    ("witness.groups.0.S", form([9], [0, 8], exponent=-2)),
    ("witness.groups.0.F", matrix([0, 0])),
    ("witness.groups.0.share", 0),
)
PUSHED_BOUND = changed(
    SHIFTING_BOUND,
    ("system", plant([[0, 1], [0, 0]], ([[0], [1]], [[1, 0]]))),
    ("claim.cost", 1),
    ("witness.groups.0.P", form([1], [0, 3], exponent=-1)),
    ("witness.groups.0.S", form([3], [0, 1], exponent=-1)),
)
# Agent 1 drives agent 2 and hears nothing of it.
ONE_WAY = plant([[0, 0], [2, 0]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]), time="discrete")
HALVES = {
    "agents": ["1", "2"],
    "disturbances": [1, "1/2"],
    "noise": [1, "1/2"],
    "P": form([2], [0, 2], exponent=-1),
    "S": form([1], [0, 1], exponent=-2),
    "F": matrix([0, 0], [0, 0]),
    "share": 0,
}
LAST = {
    "agents": ["2"],
    "disturbances": ["1/2"],
    "noise": ["1/2"],
    "P": form([2], exponent=-1),
    "S": form([1], exponent=-2),
    "F": matrix([0]),
    "share": 0,
}
GROUPS = certificate(
    "cost_bound",
    ONE_WAY,
    {
        "weights": weights(2, 2),
        "cost": 1,
        "graph": {"states": ["1", "2"], "edges": [["1", "2"]]},
    },
    {"groups": [HALVES, LAST]},
)
# Agent 2 measures the state of agent 1, and the plant couples nothing.
MEASURED = changed(GROUPS, ("system.A", [[0, 0], [0, 0]]), ("system.channels.1.C", [[1, 1]]))
# T = -1/z: |T + 1/2| is at most 3/2.
MARGIN = certificate(
    "disk_margin",
    STEP,
    {"at": "inputs", "together": False, "margin": "1/2"},
    {"parts": [{"ports": [0], "scaling": [1], "P": form([2])}]},
    DEADBEAT,
)
# x(t+1) = 2x: without an output no part proves anything, and for P = -1 the form of a sector falls.
DOUBLING = plant([[2]], ([[1]], {"shape": [0, 1], "entries": []}), time="discrete")
UNSEEN = certificate(
    "disk_margin",
    DOUBLING,
    {"at": "outputs", "together": False, "margin": 1},
    {"parts": []},
    static(DOUBLING, 0),
)
DOUBLED = plant([[2]], ([[1]], [[1]]), time="discrete")
GROWING = certificate(
    "sector",
    DOUBLED,
    {"sectors": [[1, 1]]},
    {"scaling": [1], "P": form([-1])},
    static(DOUBLED, 0),
)
# P = -1 satisfies the inequality of the cost, too, since the loop grows.
UNBOUNDED = certificate(
    "loop_cost",
    DOUBLED,
    {"weights": weights(1, 1), "cost": 1},
    {"P": form([-1])},
    static(DOUBLED, 0),
)
# x(t+1) = f(t, 0): P of less than the scaling falls.
RESTING = certificate(
    "sector",
    FORGETFUL,
    {"sectors": [[1, 1]]},
    {"scaling": [1], "P": form([2], exponent=-1)},
    static(FORGETFUL, 0),
)
# Two of them beside each other.
PAIR = plant([[1, 0], [0, 1]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]), time="discrete")
BOTH = certificate(
    "disk_margin",
    PAIR,
    {"at": "outputs", "together": True, "margin": "1/2"},
    {"parts": [{"ports": [0, 1], "scaling": [1, 1], "P": form([2], [0, 2])}]},
    static(PAIR, -1, -1),
)
EACH = changed(
    BOTH,
    ("claim.together", False),
    (
        "witness.parts",
        [
            {"ports": [0], "scaling": [1], "P": form([2], [0, 1])},
            {"ports": [1], "scaling": [3], "P": form([3], [0, 6])},
        ],
    ),
)
SECTOR = certificate(
    "sector",
    STEP,
    {"sectors": [["1/2", "3/2"]]},
    {"scaling": [1], "P": form([2], exponent=-1)},
    DEADBEAT,
)
CONTINUOUS_SECTOR = certificate(
    "sector",
    DRIVEN,
    {"sectors": [["1/2", 2]]},
    {"scaling": [1], "P": form([3])},
    static(DRIVEN, -3),
)

# For x(t+1) = x + u both inequalities are strict up to the golden ratio.
STEP_BOUND = certificate(
    "cost_bound",
    STEP,
    {"weights": weights(1, 1), "cost": "3/2"},
    {
        "groups": [
            {
                "agents": ["1"],
                "disturbances": [1],
                "noise": [1],
                "P": form([6], exponent=-1),
                "S": form([2], exponent=-1),
                "F": matrix([0]),
                "share": 0,
            }
        ]
    },
)
OUTPUT_MARGIN = changed(MARGIN, ("claim.at", "outputs"))
# x_2 is twice what x_1 was: P = diag(7, 5/4).
ONE_WAY_COST = certificate(
    "loop_cost",
    ONE_WAY,
    {"weights": weights(2, 2), "cost": 9},
    {"P": form([28], [0, 5], exponent=-1)},
    static(ONE_WAY, 0, 0),
)

# x(t+1) = x + u, u = -x: after a step at the input x = 1 and u = -1 from the time 1 on.
STEPPED = certificate(
    "step_peaks",
    STEP,
    {"at": "inputs", "inputs": [["1001/1000"]], "outputs": [["1001/1000"]]},
    {"P": form([3]), "rate": "1/4", "sizes": [1, 1], "bits": 24, "unit": -18, "times": 1},
    DEADBEAT,
)
# An error of the sensor passes to the input at once.
SENSED = changed(STEPPED, ("claim.at", "outputs"))
# u = -x + r: x = 1 after one step, and u = 1 before.
FOLLOWING = changed(
    STEPPED,
    ("claim.at", "setpoints"),
    ("subject.0.controller.agents.0.input.reference", [[1]]),
)
# x' = -2x + 1, u = -3x: x tends to 1/2.
CONTINUOUS_STEP = certificate(
    "step_peaks",
    DRIVEN,
    {"at": "inputs", "inputs": [["1501/1000"]], "outputs": [["501/1000"]]},
    {
        "P": form([4]),
        "rate": 1,
        "sizes": [2, 1],
        "bits": 30,
        "unit": -24,
        "times": 6,
        "step": 1,
    },
    static(DRIVEN, -3),
)

ALL = {
    "a bound above 1": STEP_BOUND,
    "a cost of two agents": ONE_WAY_COST,
    "a cost in discrete time": COST,
    "a cost with filtered noise": FILTERED,
    "a cost without a bandwidth": IDLE,
    "a bound in discrete time": BOUND,
    "a bound with a part of the filter": SHARED,
    "a bound by groups": GROUPS,
    "a margin of one input": MARGIN,
    "a margin of two outputs together": BOTH,
    "a margin of each output by itself": EACH,
    "a sector in discrete time": SECTOR,
    "a sector in continuous time": CONTINUOUS_SECTOR,
    "a step at an input in discrete time": STEPPED,
    "an error of a sensor": SENSED,
    "a step of a set-point": FOLLOWING,
    "a step at an input in continuous time": CONTINUOUS_STEP,
}
"""Every one of them is VALID, and says something true."""
