"""The checker builds every subject as the finder does, although they share no code."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.checker.constructions import CONSTRUCTIONS, LINE, read_subject
from mcexact.checker.core import arithmetic
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System, digest, read_plant
from mcexact.derived.constructions import (
    add_links,
    augmented_outputs,
    dual,
    error_system,
    extended_system,
    failed,
    feedback,
    full_output,
    held_system,
    internal_model,
    lifted_system,
    merged,
    regulated_outputs,
    restricted,
    servo_system,
    setpoint_system,
    slow_system,
)
from mcexact.derived.feedthrough import input_filters
from mcexact.derived.modulo import PARTS, without_part
from mcexact.derived.sampling import sampled_system
from mcexact.exact.matrix import Matrix, block
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.periodic import PeriodicController, periodic_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import plain
from tests import effort
from tests.checker.handmade import FREE, changed, checked
from tests.derived.test_failed import drawn_failures

ENTRIES = (0, 0, 1, -1, 2, Fraction(1, 2), Fraction(-2, 3))


def drawn(rng: random.Random, nrows: int, ncols: int) -> Matrix:
    rows = [[rng.choice(ENTRIES) for _ in range(ncols)] for _ in range(nrows)]
    return Matrix.from_rows(rows, ncols=ncols)


def drawn_plant(rng: random.Random, time: str) -> MultiChannelSystem:
    """A plant with a neighbor graph and delays; no states, inputs or outputs are possible."""
    n, m = rng.randint(0, 3), rng.randint(1, 3)
    names = [f"agent {i}" for i in range(m)]
    heard = [[j for j in range(m) if rng.random() < 0.5] for _ in range(m)]
    waits = [(i, j, rng.randint(0, 2)) for i in range(m) for j in heard[i] if i != j]
    B = [drawn(rng, n, rng.randint(0, 2)) for _ in range(m)]
    C = [drawn(rng, rng.randint(0, 2), n) for _ in range(m)]
    graph = NeighborGraph(names, heard, waits if time == "discrete" else [])
    return MultiChannelSystem(drawn(rng, n, n), B, C, time=time, names=names, neighbors=graph)


def sizes(rng: random.Random, system: MultiChannelSystem) -> list[int]:
    return [rng.randint(0, 2) for _ in range(system.m)]


def drawn_parts(rng: random.Random, system: MultiChannelSystem) -> list[list[str]]:
    found: dict[int, list[str]] = {}
    for name in rng.sample(system.names, system.m):
        found.setdefault(rng.randrange(system.m), []).append(name)
    return list(found.values())


def without_drawn_part(rng: random.Random, system: MultiChannelSystem) -> MultiChannelSystem:
    """All that no output shows or no input moves, or without dynamics some of it.

    Where there is no such part, the plant gets a state that no output shows.
    """
    part = rng.choice(PARTS)
    decide = joint_observability if part == "unobservable" else joint_controllability
    W = decide(system).evidence.annihilator
    if not W.nrows:
        n = system.n
        plant = MultiChannelSystem(
            block([[system.A, Matrix.zeros(n, 1)], [drawn(rng, 1, n), drawn(rng, 1, 1)]]),
            [block([[c.B], [drawn(rng, 1, c.B.ncols)]]) for c in system.channels],
            [block([[c.C, Matrix.zeros(c.C.nrows, 1)]]) for c in system.channels],
            time=system.time,
            names=system.names,
            neighbors=system.neighbors,
        )
        return without_part(plant, "unobservable", [[0] * n + [1]])
    if system.A.is_zero():
        W = W.take(rows=sorted(rng.sample(range(W.nrows), rng.randint(1, W.nrows))))
    return without_part(system, part, W)


def missing_arcs(system: MultiChannelSystem) -> list[tuple[int, int]]:
    pairs = [(j, i) for j in range(system.m) for i in range(system.m) if i != j]
    return [arc for arc in pairs if arc not in system.neighbors.edges()][:2]


def controller(rng: random.Random, system: MultiChannelSystem) -> Controller:
    """A controller that uses something of everything an agent hears, and holds some of it."""
    graph, m = system.neighbors, system.m
    shared, private = sizes(rng, system), sizes(rng, system)

    def drawn_map(i: int, nrows: int) -> LinearMap:
        heard = graph.neighborhood(i)
        return LinearMap(
            {j: drawn(rng, nrows, system.q(j)) for j in heard if rng.random() < 0.7},
            {j: drawn(rng, nrows, shared[j]) for j in heard if rng.random() < 0.7},
            drawn(rng, nrows, private[i]) if rng.random() < 0.7 else None,
            drawn(rng, nrows, system.q(i)) if rng.random() < 0.3 else None,
        ).without_zeros()

    agents = []
    for i in range(m):
        followers = graph.followers(i) if system.time == "discrete" else ()
        hold = {j: rng.randint(0, 2) for j in followers if rng.random() < 0.5}
        first, second, third = (drawn_map(i, size) for size in (shared[i], private[i], system.p(i)))
        agents.append(
            AgentProgram(system.names[i], shared[i], private[i], first, second, third, hold)
        )
    return Controller(system.time, "", tuple(agents))


def periodic(rng: random.Random, system: MultiChannelSystem) -> PeriodicController:
    """A controller of period 1, 2 or 3, each agent of which uses its own output and state."""
    private = sizes(rng, system)

    def drawn_agent(i: int) -> AgentProgram:
        maps = [
            LinearMap({i: drawn(rng, nrows, system.q(i))}, {}, drawn(rng, nrows, private[i]))
            for nrows in (private[i], system.p(i))
        ]
        update, control = (each.without_zeros() for each in maps)
        return AgentProgram(system.names[i], 0, private[i], LinearMap(), update, control)

    agents = range(system.m)
    phases = (tuple(map(drawn_agent, agents)) for _ in range(rng.randint(1, 3)))
    return PeriodicController(tuple(Controller("discrete", "", phase) for phase in phases))


def selection(rng: random.Random, s: MultiChannelSystem) -> list[Matrix]:
    """Combinations of the outputs of each channel, perhaps none."""
    return [drawn(rng, rng.randint(0, 2), s.q(i)) for i in range(s.m)]


DISCRETE = "held", "lifted", "periodic_loop", "slow"
TIMES = dict.fromkeys(DISCRETE, "discrete") | {"sampled": "continuous"}
"""The constructions of plants in one time domain alone."""
Build = Callable[[random.Random, MultiChannelSystem], MultiChannelSystem]

BUILDS: dict[str, list[Build]] = {
    "arcs": [lambda rng, s: add_links(s, missing_arcs(s))],
    "augmented_outputs": [lambda rng, s: augmented_outputs(s)],
    "closed_loop": [lambda rng, s: closed_loop(s, controller(rng, s)).system],
    "dual": [lambda rng, s: dual(s)],
    "error": [lambda rng, s: error_system(s, [drawn(rng, s.p(i), s.n) for i in range(s.m)])],
    "extended": [
        lambda rng, s: extended_system(s, sizes(rng, s)),
        lambda rng, s: extended_system(s, sizes(rng, s), share="states"),
    ],
    "failed": [lambda rng, s: failed(s, **drawn_failures(rng, s))],
    "feedback": [lambda rng, s: feedback(s, [drawn(rng, s.p(i), s.q(i)) for i in range(s.m)])],
    "full_output": [lambda rng, s: full_output(s, rng.randrange(s.m))],
    "held": [lambda rng, s: held_system(s, sizes(rng, s))],
    "input_filters": [lambda rng, s: input_filters(s)],
    "integrators": [lambda rng, s: setpoint_system(s)],
    "internal_model": [
        lambda rng, s: internal_model(
            s,
            "poly:"
            + rng.choice(("x^2", "x^2+1/4", "x^3-x/2", "x+1")).replace(
                "x", "sz"[s.time == "discrete"]
            ),
            selection(rng, s),
        ),
    ],
    "lifted": [
        lambda rng, s: lifted_system(s, sizes(rng, s)),
        lambda rng, s: lifted_system(s, sizes(rng, s), share="states"),
    ],
    "regulated": [lambda rng, s: regulated_outputs(s, selection(rng, s))],
    "servo": [lambda rng, s: servo_system(s, selection(rng, s))],
    "sampled": [
        lambda rng, s: sampled_system(s, Fraction(1, rng.choice((1, 3, 10))), rng.randint(0, 2)),
        lambda rng, s: sampled_system(s, Fraction(1, 2), decimals=rng.choice((0, 1, 30))),
    ],
    "merged": [lambda rng, s: merged(s, drawn_parts(rng, s))],
    "periodic_loop": [lambda rng, s: periodic_loop(s, periodic(rng, s))],
    "modulo": [without_drawn_part],
    "slow": [lambda rng, s: slow_system(s, max(2 * s.n, 1) + rng.randint(0, 2))],
    "restricted": [lambda rng, s: restricted(s, rng.sample(s.names, rng.randint(1, s.m)))],
}


def equal(ours: arithmetic.Matrix, theirs: Matrix) -> bool:
    rows = [[Fraction(entry, ours.denominator) for entry in row] for row in ours.rows]
    shape = (ours.nrows, ours.ncols) == theirs.shape
    return shape and rows == [list(row) for row in theirs.rows()]


def assert_same(ours: System, theirs: MultiChannelSystem) -> None:
    assert equal(ours.A, theirs.A)
    assert tuple(ours.names) == theirs.names
    assert ours.time == theirs.time
    graph, hears = theirs.neighbors, range(theirs.m)
    assert ours.neighbors == (graph and [sorted(graph.neighborhood(i)) for i in hears])
    assert (ours.D is None) == (theirs.D is None)
    assert ours.D is None or theirs.D is None or equal(ours.D, theirs.D)
    for i in range(theirs.m):
        assert equal(ours.B[i], theirs.B(i))
        assert equal(ours.C[i], theirs.C(i))


def test_a_plant_without_parameters_has_no_line() -> None:
    step = {"construction": LINE, "parameter": "s", "point": {}, "direction": {}}
    with pytest.raises(Refused) as found:
        read_subject([step], read_plant(FREE["system"]))
    assert found.value.args[:3] == ("INVALID", "subject", "subject[0]")


@pytest.mark.parametrize("name", sorted(CONSTRUCTIONS))
def test_every_construction_is_built_as_the_finder_builds_it(name: str) -> None:
    rng = random.Random(name)
    for _ in range(25):
        for build in BUILDS[name]:
            domain = TIMES.get(name, rng.choice(["continuous", "discrete"]))
            derived = build(rng, drawn_plant(rng, domain))
            document = derived.canonical_document()
            assert_same(read_subject(plain(derived.subject), read_plant(document)), derived)


@pytest.mark.parametrize("name", sorted(CONSTRUCTIONS))
def test_a_construction_has_its_own_arguments_and_no_others(name: str) -> None:
    for build in BUILDS[name]:
        plant = drawn_plant(random.Random(name), TIMES.get(name, "discrete"))
        derived = build(random.Random(name), plant)
        document = derived.canonical_document()
        (step,) = plain(derived.subject)
        read_subject([step], read_plant(document))
        fewer = [{key: step[key] for key in step if key != left_out} for left_out in step]
        for wrong in ({**step, "more": None}, *fewer):
            with pytest.raises(Refused) as found:
                read_subject([wrong], read_plant(document))
            assert found.value.verdict == "MALFORMED"


def test_an_edge_is_added_once() -> None:
    graph = {"1": ["2"], "2": ["1"], "3": []}
    plant = {**FREE["system"], "neighbors": graph}
    plant["channels"] = [{**FREE["system"]["channels"][0], "name": name} for name in "123"]
    ours = read_subject([{"construction": "arcs", "added": [["3", "1"]]}], read_plant(plant))
    assert ours.neighbors == [[0, 1, 2], [0, 1], [2]]
    for added in ([["2", "1"]], [["3", "1"], ["3", "1"]], [["1", "1"]]):
        with pytest.raises(Refused) as found:
            read_subject([{"construction": "arcs", "added": added}], read_plant(plant))
        assert found.value.verdict == "INVALID"


def test_constructions_are_applied_in_order() -> None:
    rng = random.Random(1)
    for _ in range(20):
        derived = drawn_plant(rng, "discrete")
        for name in rng.sample(["augmented_outputs", "extended", "integrators", "feedback"], 3):
            derived = BUILDS[name][0](rng, derived)
        derived = dual(derived)
        document = derived.canonical_document()
        ours = read_subject(plain(derived.subject), read_plant(document))
        assert_same(ours, derived)
        assert ours.words.startswith("the dual of: ")


def test_the_digest_is_recomputed_independently() -> None:
    rng = random.Random(2)
    for _ in range(50):
        system = drawn_plant(rng, rng.choice(["continuous", "discrete"]))
        document = system.canonical_document()
        assert digest(read_plant(document)) == system.digest()


@pytest.mark.parametrize(
    ("step", "verdict"),
    [
        ({"construction": "augmented_outputs"}, "INVALID"),
        ({"construction": "dual", "of": "A"}, "MALFORMED"),
        ({"construction": "extended", "share": "states", "dimensions": [1]}, "INVALID"),
        ({"construction": "full_output", "channel": "2"}, "MALFORMED"),
        ({"construction": "feedback", "gains": []}, "MALFORMED"),
        ({"construction": "closed_loop", "controller": {}}, "MALFORMED"),
        ({"construction": ["dual"]}, "MALFORMED"),
        ({"construction": "transposed"}, "INCOMPLETE"),
        ({}, "MALFORMED"),
        ("dual", "MALFORMED"),
        (None, "MALFORMED"),
    ],
    ids=str,
)
def test_a_construction_that_cannot_be_applied_proves_nothing(step: Any, verdict: str) -> None:
    assert checked(changed(FREE, ("subject", [step]))).verdict == verdict


@pytest.mark.parametrize("huge", [10**5, 10**9, 10**30])
def test_a_subject_that_a_number_makes_huge_is_incomplete(huge: int) -> None:
    graphed = changed(
        FREE,
        ("system.time", "discrete"),
        ("system.channels", [{**FREE["system"]["channels"][0], "name": name} for name in "ab"]),
        ("system.neighbors", {"a": ["b"], "b": ["a"]}),
    )
    late = changed(graphed, ("system.delays", {"a": {"b": huge}}))
    shared = {"construction": "extended", "share": "states", "dimensions": [huge, 0]}
    program = {
        "private": 0,
        "shared": 1,
        "shared_update": {},
        "private_update": {},
        "input": {"outputs": {"b": [[1]]}},
    }
    agents = [{"name": "a", **program}, {"name": "b", **program, "input": {}}]
    loop = {"construction": "closed_loop", "controller": {"time": "discrete", "agents": agents}}
    for document, step in (
        (graphed, shared),
        (graphed, {**shared, "construction": "lifted"}),
        (graphed, {"construction": "held", "dimensions": [0, huge]}),
        (late, {"construction": "held", "dimensions": [0, 0]}),
        (late, {**shared, "construction": "lifted", "dimensions": [0, 0]}),
        (late, loop),
    ):
        with effort.at_most(10_000):  # nothing is built: each state would be a line at least
            verdict = checked(changed(document, ("subject", [step])))
        assert verdict.verdict == "INCOMPLETE", (step, verdict.line())


def test_delays_need_discrete_time() -> None:
    plant = read_plant(drawn_plant(random.Random(3), "continuous").canonical_document())
    with pytest.raises(Refused, match="discrete"):
        read_subject([{"construction": "held", "dimensions": [1] * plant.m}], plant)
