"""Certificates about boxes, small enough to be followed with a pencil."""

from __future__ import annotations

from typing import Any

from tests.checker.box_maker import controllable, fixed, stable
from tests.checker.handmade import Document, certificate, changed, listed, matrix, plant
from tests.checker.performance_plants import form

DUAL = {"construction": "dual"}


def uncertain(A: Any, B: Any = None, C: Any = None) -> Document:
    """The uncertainty of a plant: the radii of A, and those of some B_i and C_i, by rows."""
    parts = {"A": listed(A, len(A))} if A else {}
    for key, given in (("B", B), ("C", C)):
        if given:
            parts[key] = {name: listed(M, len(M[0])) for name, M in given.items()}
    return {"absolute": parts}


def gains(*pairs: tuple[int, int]) -> Document:
    """X and W of channels with one input and one output each."""
    return {"X": [matrix([x]) for x, _ in pairs], "W": [matrix([w]) for _, w in pairs]}


RADII = uncertain([["1/10", 0], [0, "1/20"]], {"1": [["1/20"], [0]]}, {"2": [[0, "1/20"]]})
PAIR = plant(
    [[1, "1/4"], ["1/4", -1]],
    ([[1], [0]], [[1, 0]]),
    ([[0], [1]], [[0, 1]]),
    uncertainty=RADII,
)
"""Two modes, about 1 and −1, each with a channel of its own."""
SAMPLED = plant(
    [["3/2", "1/4"], ["1/4", "1/2"]],
    ([[1], [0]], [[1, 0]]),
    ([[0], [1]], [[0, 1]]),
    time="discrete",
    uncertainty=RADII,
)
CALM = plant(
    [[-2, "1/4"], ["1/4", -1]],
    ([[1], [0]], [[1, 0]]),
    ([[0], [1]], [[0, 1]]),
    neighbors={"1": ["2"], "2": []},
    uncertainty=RADII,
)
DAMPED = plant(
    [["1/2", "1/8"], ["1/8", "-1/4"]],
    ([[1], [0]], [[1, 0]]),
    ([[0], [1]], [[0, 1]]),
    time="discrete",
    neighbors={"1": ["2"], "2": ["1"]},
    delays={"1": {"2": 2}},
    uncertainty=RADII,
)
TURNING = plant(
    [[0, -1], [1, 0]], ([[1], [0]], [[1, 0]]), uncertainty=uncertain([[0, "1/10"], [0, 0]])
)
"""Two modes about ±i: the exterior discs overlap, and the lower half is skipped."""
CERTAIN = plant([[1]], ([[1]], [[1]]))
NOTHING = plant([], ([], []))


def programs(time: str, first: Document, second: Document) -> Document:
    """A construction of two agents, the first one with a private state, the second one without."""
    agents = [
        {"name": "1", "shared": 0, "private": 1, **first},
        {
            "name": "2",
            "shared": 0,
            "private": 0,
            "shared_update": {},
            "private_update": {},
            **second,
        },
    ]
    return {"construction": "closed_loop", "controller": {"time": time, "agents": agents}}


def first(update: Any, state: Any, own: Any) -> Document:
    """z' = update y + state z, u = z / 2 + own y."""
    return {
        "shared_update": {},
        "private_update": {"outputs": {"1": [[update]]}, "private": [[state]]},
        "input": {"outputs": {"1": [[own]]}, "private": [["1/2"]]},
    }


def radii_of_first(update: Any, own: Any) -> Document:
    return {
        "shared_update": {},
        "private_update": {"outputs": {"1": [[update]]}},
        "input": {"outputs": {"1": [[own]]}},
    }


LOOP = programs("continuous", first(1, -2, -1), {"input": {"outputs": {"2": [[-1]]}}})
GAIN_RADII = programs("continuous", radii_of_first("1/50", "1/100"), {"input": {}})["controller"]
DELAYED = programs(
    "discrete",
    {
        "shared_update": {},
        "private_update": {"outputs": {"2": [["1/8"]]}, "private": [["1/4"]]},
        "input": {"private": [["1/4"]]},
    },
    {"input": {"outputs": {"1": [["1/8"]], "2": [["1/8"]]}}},
)
DELAYED_RADII = programs(
    "discrete",
    {"shared_update": {}, "private_update": {"outputs": {"2": [["1/100"]]}}, "input": {}},
    {"input": {"outputs": {"1": [["1/100"]]}}},
)["controller"]

FIXED = fixed(PAIR, [gains((3, 1), (3, 1))])
STABILIZABLE = fixed(PAIR, [gains((3, 1), (3, 1))], bound=0)
SAMPLED_FIXED = fixed(SAMPLED, [gains((3, 1), (3, 1))], bound="15/16")
OVERLAPPING = fixed(TURNING, [gains((3, 1)), gains((-3, 1))])
EXTENDED = fixed(
    {**CALM, "neighbors": {"1": ["2"], "2": ["1"]}},
    [{"X": [matrix([2, 0]), matrix([0, 2])], "W": [matrix([1]), matrix([1])]}],
    {"construction": "augmented_outputs"},
    bound="1/2",
)
ONE_PLANT = fixed(CERTAIN, [gains((2, 1))])
NO_STATES = fixed(NOTHING, [{"X": [matrix()], "W": [matrix()]}])
CONTROLLABLE = controllable(PAIR, ["1", "2"])
MOVED = plant(
    [[1, "1/4"], ["1/4", -1]],
    ([[2], [0]], [[1, 0]]),
    ([[0], [1]], [[0, 1]]),
    uncertainty=uncertain(
        [["1/10", 0], [0, "1/20"]], {"1": [["1/20"], [0]]}, {"1": [["1/20", 0]], "2": [[0, "1/20"]]}
    ),
)
DISJOINT = fixed(MOVED, [], under=(None, [[[-2]], [[3]]]))
"""The discs around 1 and −1 and those around −3 and 2 have no point in common."""
CUT = fixed(
    MOVED,
    [gains((-1, 4), (-1, 4))],
    under=([[["1/4"]], [["-1/4"]]], None, [[["-1/8"]], [[-3]]]),
)
OBSERVABLE = controllable(PAIR, ["1", "2"], DUAL)
STABILIZABLE_BY_1 = controllable(PAIR, ["1"], bound=0)
DETECTABLE = controllable(SAMPLED, ["1"], DUAL, bound="7/8")
FED_BACK = controllable(MOVED, ["1", "2"], under=(None, [[[-2, 0], [0, 4]]]))
STABLE = stable(CALM, [1, 2, 4], growth=[1, 1])
SAMPLED_STABLE = stable(DAMPED, ["1/4", "1/2", 1, 2, 4], bound="7/8")
LOOP_STABLE = stable(
    CALM,
    ["1/2", 1, "3/2", 2, 3, 4, 5, 6, 8],
    LOOP,
    growth=[2, 2, 2],
    gain_radii=GAIN_RADII,
    bound="1/8",
)
PART = plant(
    [[-1]],
    ([[2]], [["1/2"]]),
    uncertainty=uncertain([["1/8"]], {"1": [["1/5"]]}, {"1": [["1/10"]]}),
)
"""The entries have the radii 1/8, 1/10 and 1/5 of their moduli."""


def proportional(gain: Any) -> Document:
    """A controller u = gain y."""
    agent = {
        "name": "1",
        "shared": 0,
        "private": 0,
        "shared_update": {},
        "private_update": {},
        "input": {"outputs": {"1": [[gain]]}},
    }
    return {"time": "continuous", "agents": [agent]}


IN_PART = {"construction": "closed_loop", "controller": proportional(-1)}
WAYS = [1, 2, 3, 5]
PART_STABLE = stable(PART, WAYS, IN_PART, growth=[1], gain_radii=proportional("1/100"))
PART_CERTAIN = stable(PART, WAYS, IN_PART, growth=[1])
"""The same, with gains that are certain."""
AT_SAMPLES = {"construction": "sampled", "step": "1/2", "late": 1, "decimals": 6}
HELD: Document = {
    "construction": "closed_loop",
    "controller": {**proportional("-1/2"), "time": "discrete"},
}
TANK = plant([[-1]], ([[1]], [[1]]))
AROUND = {**TANK, "uncertainty": uncertain([["1/20"]], {"1": [["1/20"]]}, None)}
ARCS = ["1/4", "1/2", 1, 2, 4]
HELD_ALONE = stable(TANK, ARCS, AT_SAMPLES, HELD)
HELD_AROUND = stable(AROUND, ARCS, AT_SAMPLES, HELD)
"""The samples of a tank alone, and of all tanks nearby, one step late."""
HELD_LOOP = certificate(
    "stability",
    TANK,
    {"bound": None, "stable": True},
    {"method": "polynomial"},
    AT_SAMPLES,
    HELD,
)
# x(t+1) = 0.37 x + 0.63 v, v(t+1) = -x/2, and with other numbers; without delay 0.37 x - 0.32 x.
AGAIN = [
    certificate(
        "disk_margin",
        TANK,
        {"at": at, "together": False, "margin": "1/2"},
        {"parts": [{"ports": [0], "scaling": [1], "P": form([3], [1, 2])}]},
        {**AT_SAMPLES, "step": 1},
        HELD,
    )
    for at in ("inputs", "outputs")
]
AT_ITS_STEP = changed(AGAIN[0], ("subject.0.step", "1/2"))
PROMPT = [changed(each, ("subject.0.late", 0), ("witness.parts.0.P", form([2]))) for each in AGAIN]
ROUNDED = [changed(each, ("subject.0.decimals", 5)) for each in AGAIN]
WEAKER = [
    changed(each, ("subject.1.controller.agents.0.input.outputs.1", [["-1/4"]])) for each in AGAIN
]
"""The margins of the tank with another step, of the step of `HELD_LOOP`, and of other loops."""


def lagging(time: str, *numbers: str) -> Document:
    """A construction of an agent with z' = az + by, u = cz + dy."""
    a, b, c, d = ([[x]] for x in numbers)
    agent = {
        "name": "1",
        "shared": 0,
        "private": 1,
        "shared_update": {},
        "private_update": {"outputs": {"1": b}, "private": a},
        "input": {"outputs": {"1": d}, "private": c},
    }
    return {"construction": "closed_loop", "controller": {"time": time, "agents": [agent]}}


LAGGING = certificate(
    "stability",
    TANK,
    {"bound": None, "stable": True},
    {"method": "polynomial"},
    lagging("continuous", "-2", "1", "-1/2", "-1/2"),
)
# h = 1/2: X = 2/3, so that z(t+1) = z/3 + y/3, u = -z/3 - 7/12 y.
BY_TUSTIN = [
    certificate(
        "disk_margin",
        TANK,
        {"at": at, "together": False, "margin": "1/2"},
        {"parts": [{"ports": [0], "scaling": [1], "P": form([3], [0, 1])}]},
        {**AT_SAMPLES, "late": 0},
        lagging("discrete", "1/3", "1/3", "-1/3", "-7/12"),
    )
    for at in ("inputs", "outputs")
]
LATE = [
    changed(each, ("subject.0.late", 1), ("witness.parts.0.P", form([3], [0, 1], [-1, 1, 3])))
    for each in BY_TUSTIN
]
OF_AGENT = "subject.1.controller.agents.0"
TO_12_DIGITS = [
    changed(
        each,
        (f"{OF_AGENT}.input.private", [["-0.333333333333"]]),
        (f"{OF_AGENT}.input.outputs.1", [["-0.583333333333"]]),
    )
    for each in BY_TUSTIN
]
OTHERWISE = [
    [changed(each, change) for each in BY_TUSTIN]
    for change in (
        (f"{OF_AGENT}.input.private", [["-0.33333333333"]]),
        (f"{OF_AGENT}.input.outputs.1", [["-1/2"]]),
        (f"{OF_AGENT}.private_update.private", [["0.3679"]]),
        (f"{OF_AGENT}.private_update.outputs.1", [["-1/3"]]),
        ("subject.0.step", "11/20"),
    )
]
"""The margins of a tank with a dynamic agent at samples, by Tustin's rule, and with others."""
DELAYED_STABLE = stable(
    DAMPED,
    ["1/8", "1/4", "3/8", "1/2", "3/4", 1, "4/3", 2, "8/3", 4, 8],
    DELAYED,
    gain_radii=DELAYED_RADII,
)
TWICE = plant(
    [[1]], ([[1]], [[1]]), ([[2]], [[1]]), uncertainty=uncertain([["1/10"]], {"2": [["1/10"]]})
)
OF_ONE_PLANT = [
    fixed(TWICE, [gains((2, 1), (2, 1))]),
    fixed(TWICE, [gains((2, 1), (2, 1))], bound=0),
    controllable(TWICE, ["1", "2"]),
    controllable(TWICE, ["1", "2"], DUAL),
    controllable(TWICE, ["2"]),
    controllable(TWICE, ["1", "2"], DUAL, bound=0),
]
ALL = {
    "no fixed mode": FIXED,
    "stabilizable": STABILIZABLE,
    "stabilizable, sampled": SAMPLED_FIXED,
    "overlapping discs": OVERLAPPING,
    "outputs of neighbors": EXTENDED,
    "a plant that is certain": ONE_PLANT,
    "no states": NO_STATES,
    "controllable": CONTROLLABLE,
    "observable": OBSERVABLE,
    "stabilizable by one channel": STABILIZABLE_BY_1,
    "detectable": DETECTABLE,
    "disjoint discs of two matrices": DISJOINT,
    "discs of three matrices, which meet": CUT,
    "disjoint discs of two matrices with gains from the state": FED_BACK,
    "stable": STABLE,
    "stable, sampled": SAMPLED_STABLE,
    "stable loop": LOOP_STABLE,
    "stable loop with messages": DELAYED_STABLE,
    "stable samples of a plant": HELD_ALONE,
    "stable samples of all plants near one": HELD_AROUND,
}
