"""Certificates about small plants: every kind, with every outcome of its claim."""

from __future__ import annotations

import contextlib
import json
import random
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from typing import Any, get_args

from mcexact.analysis.analyze import analyze
from mcexact.analysis.boxes.margins import box_disk_margin
from mcexact.analysis.boxes.members import box_fixed_modes, box_setpoints
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.failures import failures, fewest_failures
from mcexact.analysis.fixed_modes import assignability, completeness, fixed_spectrum
from mcexact.analysis.patterns import structural_fixed_modes
from mcexact.analysis.questions import asked_by
from mcexact.analysis.sharing import (
    common_dimension,
    minimal_communication,
    minimal_shared_dimensions,
)
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer.protocol import document
from mcexact.answer.sharing import SharedDimensions
from mcexact.derived.constructions import (
    Share,
    dual,
    error_system,
    extended_system,
    internal_model,
    setpoint_system,
)
from mcexact.errors import InputError, McexactError
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.box import Box
from mcexact.model.graph import NeighborGraph
from mcexact.model.signals import constant_signals
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import plain
from mcexact.synthesis.certify import account_of_verdict, certify_controller
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.optimum.figures import THEOREM
from mcexact.synthesis.setpoint import design_setpoint
from tests.answer.test_sentences import drawn
from tests.checker import (
    test_complementary_subsystem,
    test_feedthrough,
    test_modulo,
    test_nearby,
    test_patterns,
    test_periodic,
    test_sentences_design,
    test_sentences_performance,
    test_setpoint,
    test_single_channel_gains,
)
from tests.checker.box_plants import (
    AGAIN,
    AT_ITS_STEP,
    AT_SAMPLES,
    BY_TUSTIN,
    HELD_ALONE,
    HELD_AROUND,
    HELD_LOOP,
    LAGGING,
    OF_ONE_PLANT,
    PROMPT,
    WEAKER,
)
from tests.checker.handmade import Document
from tests.checker.polynomials import generous
from tests.checker.test_fixed_spectrum import UNEVEN
from tests.oracle.drawn.certificates import certified
from tests.oracle.drawn.observers import drawn_observer
from tests.oracle.drawn.subjects import drawn_subject

Found = Iterator[Document]
Rows = list[list[Any]]


def told(*decisions: Callable[[], Any]) -> Found:
    """The certificates of decisions that apply."""
    for decide in decisions:
        with contextlib.suppress(McexactError, ValueError):
            yield document(decide())


def analyses(system: MultiChannelSystem, gains: bool = True) -> Found:
    """Everything that can be asked of a plant, of each channel, and of several sets."""
    asked = [
        name
        for name in asked_by("links", "every-channel", "failures")
        if gains or "gains" not in name
    ]
    if system.neighbors is not None:
        asked += asked_by("minimal")
        if system.time == "discrete":
            asked += asked_by("delayed")
    ways = ["own", "outputs"] if system.neighbors is not None else ["own"]
    for information in ways:
        sets = [[name] for name in system.names] + [list(system.names[1:]), []]
        for k, subset in enumerate(sets if information == "own" else sets[:1]):
            channel = subset[0] if len(subset) == 1 and gains else None
            options: Any = {"information": information, "subset": subset, "channel": channel}
            analysis = analyze(system, also=[] if k else asked, **options)
            yield from map(document, analysis.decided().values())


def _more(decide: Callable[[], SharedDimensions]) -> SharedDimensions:
    """More than the least, if anything suffices."""
    least = decide()
    if not least.feasible:
        raise InputError("nothing suffices")
    return generous(least)


def allocations(system: MultiChannelSystem) -> Found:
    """The least that agents have to share, at some prices and within some limits."""
    region = StabilityRegion(system.time, Fraction(1, 2))
    m, ways = system.m, get_args(Share)
    for way in ways:
        least = partial(minimal_shared_dimensions, system, None, way)
        yield from told(
            partial(common_dimension, system, None, way),
            least,
            partial(least, free_assignability=True),
            partial(least, region=region),
            partial(_more, least),
        )
    yield from told(
        lambda: minimal_shared_dimensions(system, costs=[*range(1, m + 1)]),
        lambda: minimal_shared_dimensions(system, costs=["1/2"] * m),
        lambda: minimal_shared_dimensions(system, upper=[0] * m),
        lambda: minimal_shared_dimensions(system, upper=[*[None] * (m - 1), 2]),
    )


def links(system: MultiChannelSystem) -> Found:
    """The links to add, at some prices, for some ways of sharing, within some region."""
    some = (system.names[0], system.names[-1])
    yield from told(
        lambda: minimal_communication(system),
        lambda: minimal_communication(system, costs={some: 2}),
        lambda: minimal_communication(system, costs={some: "1/2"}),
        lambda: minimal_communication(system, forbidden=[some]),
        lambda: minimal_communication(system, rate=1),
        lambda: minimal_communication(system, radius="1/2"),
        lambda: minimal_communication(system, dimensions=[1] * system.m, share="states"),
        lambda: minimal_communication(system, dimensions=[0] * system.m, share="outputs+states"),
    )


def designs(system: MultiChannelSystem) -> Found:
    """The certificates of exact designs, or of why there is none."""
    wanted: dict[str, Any] = {"rate": "1/10"}
    if system.time == "discrete":
        wanted = {"radius": "9/10"}
    for design in (design_observer, design_decentralized, design_extended, design_setpoint):
        # The gains of a search depend on the processor.
        alone: dict[str, Any] = {} if design is design_observer else {"aims": THEOREM}
        try:
            made: Any = design(system, arithmetic="exact", **wanted, **alone)
        except McexactError as refusal:
            proof = getattr(refusal, "certificate", None)
            if proof is not None:
                yield document(proof)
            continue
        yield from map(json.loads, made.account.certificates.values())
        verdict = certify_controller(system, made.controller, method="polynomial", **wanted)
        yield from map(json.loads, account_of_verdict(verdict).certificates.values())


def no_gains(system: MultiChannelSystem) -> list[Matrix]:
    """For each agent the gain 0 of the whole state."""
    return [Matrix.zeros(system.p(i), system.n) for i in range(system.m)]


def refusals(system: MultiChannelSystem) -> Found:
    """What stands in the way of a design: of the plant, with integrators, of the errors."""
    tracked, followed = (
        setpoint_system(system),
        internal_model(system, constant_signals(system.time) ** 2),
    )
    yield from told(
        lambda: joint_controllability(system),
        lambda: joint_observability(system),
        lambda: joint_controllability(tracked),
        lambda: joint_observability(tracked),
        lambda: joint_controllability(followed),
        lambda: joint_observability(followed),
        lambda: fixed_spectrum(followed),
        lambda: fixed_spectrum(extended_system(followed, [followed.n] * system.m, "states")),
        lambda: fixed_spectrum(extended_system(followed, [0] * system.m, "states")),
        lambda: fixed_spectrum(system),
        lambda: fixed_spectrum(tracked),
        lambda: completeness(error_system(system, no_gains(system))),
        lambda: fixed_spectrum(error_system(system, no_gains(system))),
        lambda: completeness(error_system(tracked, no_gains(tracked))),
        lambda: fixed_spectrum(extended_system(system, [0] * system.m, "states")),
        lambda: fixed_spectrum(extended_system(system, [1] * system.m, "outputs+states")),
        lambda: fixed_spectrum(extended_system(tracked, [tracked.n] * system.m, "states")),
        lambda: fixed_spectrum(extended_system(tracked, [tracked.n + 1] * system.m, "states")),
        lambda: fixed_spectrum(
            extended_system(tracked, [max(tracked.n - 1, 0)] * system.m, "states")
        ),
        lambda: minimal_shared_dimensions(tracked),
    )


def uneven() -> MultiChannelSystem:
    """A factor of which one root stays more often than another."""
    A = [[0, 1, 1, 0], [0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    return MultiChannelSystem(A, [[[0], [0], [0], [1]]], [[[0, 0, 0, 1]]])


def loops(system: MultiChannelSystem, seed: int) -> Found:
    """Loops with drawn controllers, and what can be said of their eigenvalues."""
    rng = random.Random(seed)
    plant = plain(document(joint_controllability(system))["system"])
    for _ in range(4):
        steps = drawn_subject(rng, plant, "closed_loop", more=0.0)
        if steps is not None:
            for kind in ("stability", "closed_loop_spectrum", "stability"):
                found = certified(rng, kind, plant, steps)
                if found is not None and found["witness"].get("method") != "lyapunov":
                    yield found
    for want in ("controllable", "observable", "both"):
        for channel in system.names:
            yield from told(partial(single_channel_gains, system, channel, want=want))


def everything(system: MultiChannelSystem, seed: int = 0) -> Found:
    """All of that about one plant."""
    yield from analyses(system)
    if system.neighbors is not None:
        yield from allocations(system)
    yield from links(system)
    yield from refusals(system)
    yield from loops(system, seed)


def alone(module: Any) -> Iterator[tuple[str, list[Document]]]:
    """The accepted certificates of a table of tests, those about one plant together."""
    plants: dict[str, list[Document]] = {}
    for _, found in module.ACCEPTED:
        plants.setdefault(json.dumps(found["system"], sort_keys=True), []).append(found)
    for k, listed in enumerate(plants.values()):
        yield f"{module.__name__.rpartition('.test_')[2]}_{k}", listed


def crafted() -> dict[str, MultiChannelSystem]:
    """Set-points beside a mode that is not controlled, or not observed, and stable or not."""
    found = {}
    A: Rows
    B: Any
    C: Any
    for time, places in (("continuous", (1, -2, 3)), ("discrete", (2, "1/2", 3))):
        for name, B, C, place in (
            ("stable_uncontrolled", [[1], [0]], [[1, 1]], 1),
            ("stable_unobserved", [[1], [1]], [[1, 0]], 1),
            ("unstable_uncontrolled", [[1], [0]], [[1, 1]], 2),
            ("unstable_unobserved", [[1], [1]], [[1, 0]], 2),
        ):
            A = [[places[0], 0], [0, places[place]]]
            found[f"{name}_{time}"] = MultiChannelSystem(A, [B], [C], time=time)
    first, second, nothing = [[1], [0]], [[0], [1]], [[0], [0]]
    rows = [[[1, 0]], [[0, 1]], [[0, 0]]]
    found["split"] = MultiChannelSystem([[1, 0], [0, 2]], [first, second], rows[:2])
    found["idle"] = MultiChannelSystem(
        [[0, 1], [1, 0]], [first, nothing, nothing], [rows[0], rows[2], rows[2]]
    )
    found["empty"] = MultiChannelSystem(
        Matrix.zeros(0, 0), [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)]
    )
    found["apart"] = MultiChannelSystem(
        [[1]], [[[1]], [[0]]], [[[1]], [[0]]], neighbors={"1": [], "2": []}
    )
    # the first mode is fixed, although both channels together move it, and none moves the second
    found["besides"] = MultiChannelSystem([[1, 0], [0, 2]], [first, nothing], [rows[2], rows[0]])
    # agent 1 sees the mode that agent 3 drives, and a path leads from 1 to 3, or from 3 to 1
    paths = {"towards": {"2": ["1"], "3": ["2"]}, "against": {"1": ["2"], "2": ["3"]}}
    for name, chain in paths.items():
        found[name] = MultiChannelSystem(
            [[1]], [[[0]], [[0]], [[1]]], [[[1]], [[0]], [[0]]], neighbors=chain
        )
    mutual = {"1": ["2"], "2": ["1"]}
    for time in ("continuous", "discrete"):
        B, C = [[[1], [1]], [[1], [0]]], [[[1, 1]], [[0, 1]]]
        found[f"mutual_{time}"] = MultiChannelSystem(
            [[1, 0], [0, 2]], B, C, neighbors=mutual, time=time
        )
    return found


def lacking() -> dict[str, list[Document]]:
    """All hypotheses of Theorem 2 but one: a mode is not controlled, or not observed."""
    found = {}
    for name, B, C in (
        ("unreached", [[[1], [0]]] * 2, [[[1, 1]]] * 2),
        ("unseen", [[[1], [1]]] * 2, [[[1, 0]]] * 2),
    ):
        graph = {"1": ["2"], "2": ["1"]}
        system = MultiChannelSystem([[1, 0], [0, 2]], B, C, neighbors=graph)
        kinds = ("neighbor_graph", "controllability", "deficiency")
        found[name] = [each for each in analyses(system) if each["kind"] in kinds]
    return found


def tracking() -> Iterator[tuple[str, list[Document]]]:
    """Stable loops in which agents integrate outputs less set-points, or nearly do."""
    A: Rows
    unit: Rows = [[1, 0], [0, 1]]
    half: Rows = [["1/2", 0], [0, "1/2"]]
    minus: Rows = [[-1, 0], [0, -1]]
    twice: Rows = [[-2, 0], [0, -2]]
    for time, A, kept in (("continuous", [[0, 0], [0, 0]], [0, 0]), ("discrete", unit, [1, 1])):
        port = {"name": "1", "B": unit, "C": unit}
        system: Document = {"time": time, "A": A, "channels": [port]}
        stay: Rows = [[kept[0], 0], [0, kept[1]]]
        leaks: Rows = [[f"{10 * kept[0] - 1}/10", 0], [0, kept[1]]]
        grows: Rows = [[kept[0], 0], ["1/10", kept[1]]]
        minds: Rows = [[kept[0], "-1/10"], [0, kept[1]]]
        maps: list[tuple[Rows, Rows, Rows]]
        maps = [(unit, minus, each) for each in (stay, leaks, grows, minds)]
        maps += [(unit, each, stay) for each in (twice, half, [["-1/2", 0], [0, "-1/2"]], unit)]
        own: Any
        for own in ([[1, 0], [-1, 1]], [[1, 1], [0, 1]], [["1/2", 0], [0, 1]], [[1, 0], [1, 0]]):
            maps.append(
                (
                    own,
                    [[f"-{v}" if str(v)[0] != "-" else str(v)[1:] for v in row] for row in own],
                    stay,
                )
            )
        agents = [
            {"outputs": {"1": own}, "reference": reference, "private": rest}
            for own, reference, rest in maps
        ]
        agents += [{**agents[0], "shared": {"1": [[v, 0], [0, 0]]}} for v in (0, "1/10")]
        found: list[Document] = []
        for update in agents:
            back = {"outputs": {"1": twice}, "private": minus}
            program = {"name": "1", "shared": 2 * ("shared" in update), "private": 2}
            program |= {"shared_update": {}, "private_update": update, "input": back}
            found += looped(system, [program])
        yield f"tracking_{time}", found
    ports = [
        {
            "name": str(i + 1),
            "B": [[int(i == k)] for k in range(3)],
            "C": [[int(i == k) for k in range(3)]],
        }
        for i in range(3)
    ]
    heard = {"1": [], "2": ["1", "3"], "3": []}
    system = {"time": "continuous", "A": [[0] * 3] * 3, "channels": ports}
    system["neighbors"] = heard
    found = []
    for others in ({}, {"1": [[0]], "3": [[0]]}, {"1": [["1/9"]]}, {"3": [["1/9"]]}):
        programs = []
        for name in "123":
            given = {name: [[1]], **(others if name == "2" else {})}
            update = {"outputs": given, "reference": [[-1]]}
            back = {"outputs": {name: [[-2]]}, "private": [[-1]]}
            program = {"name": name, "shared": 0, "private": 1, "shared_update": {}}
            programs.append(program | {"private_update": update, "input": back})
        found += looped(system, programs)
    yield "tracking_others", found
    for time in ("continuous", "discrete"):
        yield f"tracking_models_{time}", list(models(time))


def models(time: str) -> Found:
    """Loops of an integrator whose agent has a model of a ramp or a sinusoid, or nearly one."""
    zero = int(time == "discrete")
    port = {"name": "1", "B": [[1]], "C": [[1]]}
    system: Document = {"time": time, "A": [[zero]], "channels": [port]}
    # z_1' = z_2, z_2' = y - r + its last row, u = its first row of y, z_1 and z_2
    exact: list[tuple[Rows, Rows]] = [
        ([[0, 1], [0, 0]], [[-2, -1, -2]]),
        ([[0, 1], [-1, 0]], [[-2, 1, -1]]),
    ]
    if time == "discrete":
        exact = [([[0, 1], [-1, 1]], [[-2, 1, 0]]), ([[0, 1], [-1, 2]], [[-3, 1, -3]])]
    shape = {"name": "1", "shared": 0, "shared_update": {}}
    taken: Rows = [[0], [1]]
    ways: list[tuple[Rows, Rows, int]] = [(taken, [[0], [-1]], 1), (taken, [[0], [-2]], 1)]
    ways += [(taken, [[0], ["-1/2"]], 1), (taken, [[0], [1]], 1), (taken, [[0], [-1]], 2)]
    ways += [(taken, [["1/9"], [-1]], 1), ([["1/9"], [1]], [[0], [-1]], 1)]
    ways += [([["1/9"], [1]], [["-1/9"], [-1]], 1), ([[0], [2]], [[0], [-2]], 1)]
    for inner, gains in exact:
        back = {"outputs": {"1": [gains[0][:1]]}, "private": [gains[0][1:]]}
        for own, reference, factor in ways:
            first = [[factor * x for x in inner[0]], inner[1]]
            update = {"outputs": {"1": own}, "reference": reference, "private": first}
            program = {**shape, "private": 2, "private_update": update, "input": back}
            yield from looped(system, [program])
        # a state of its own, which drives the model or only watches it
        watched: Rows
        for watched in ([[*inner[0], 0], [*inner[1], "1/9"], [0, 0, "1/9"]],
                        [[*inner[0], 0], [*inner[1], 0], [1, 0, "-1/9"]],
                        [[*inner[0], 0], [*inner[1], 0], [1, 0, 0]]):  # fmt: skip
            update = {"outputs": {"1": [*taken, [0]]}, "reference": [[0], [-1], [0]]}
            more = {"outputs": back["outputs"], "private": [[*gains[0][1:], 0]]}
            program = {**shape, "private": 3, "private_update": {**update, "private": watched}}
            yield from looped(system, [{**program, "input": more}])


def looped(system: Document, agents: list[Document]) -> Found:
    """The spectrum and the stability of a loop."""
    steps = [
        {"construction": "closed_loop", "controller": {"time": system["time"], "agents": agents}}
    ]
    for kind in ("closed_loop_spectrum", "stability"):
        found = certified(random.Random(2), kind, system, steps)
        if found is not None:
            yield found


SAMPLES = [HELD_ALONE, HELD_LOOP, *AGAIN, AT_ITS_STEP, *WEAKER, *PROMPT]


def based() -> Iterator[tuple[str, list[Document], list[Any]]]:
    """Certificates for sentences about a system that is made from the plant."""
    rng = random.Random(5)
    ports = [[[1], [0]], [[1], [0]]], [[[1, 0]], [[1, 0]]]
    unseen = MultiChannelSystem([[1, 0], [0, 2]], *ports, neighbors={"1": ["2"], "2": []})
    for name, system in (("unseen", unseen), ("mutual", crafted()["mutual_discrete"])):
        plant = plain(document(joint_controllability(system))["system"])
        zero = {"denominator": 1, "entries": [[0]]}
        wide = {"denominator": 1, "entries": [[0, 0]]}
        base = [{"construction": "feedback", "gains": [zero] * system.m}]
        ways: list[list[Any]] = [
            [],
            [{"construction": "dual"}],
            [{"construction": "augmented_outputs"}],
        ]
        ways += [[*ways[2], *ways[1]], [{"construction": "error", "gains": [wide] * system.m}]]
        more = {"construction": "extended", "share": "states"}
        for sizes in ([1, 1], [4, 4], [5, 5], [5, 0]):
            ways.append([{"construction": "integrators"}, {**more, "dimensions": sizes}])
        ways += [[{"construction": "integrators"}], [{"construction": "integrators"}, *ways[1]]]
        loop = drawn_subject(rng, plant, "closed_loop", more=0.0) or []
        ways += [[*ways[1], *loop], [*loop, *ways[1]]]
        kinds = [
            "controllability",
            "fixed_spectrum",
            "completeness",
            "stability",
            "closed_loop_spectrum",
        ]
        found = []
        for steps in [*ways, loop]:
            for kind in kinds:
                for start in (base, []) if len(steps) == 1 else (base,):
                    made = certified(rng, kind, plant, [*start, *steps])
                    if made is not None:
                        found.append(made)
        yield f"based_{name}", found, base
    for name, listed in (("alone", SAMPLES), ("around", [HELD_AROUND])):
        yield f"based_samples_{name}", listed, [AT_SAMPLES]
    for name, rest in (("moved", test_modulo.MOVED), ("seen", test_modulo.DISTANCE)):
        yield f"based_{name}", [rest], rest["subject"]
    for name, asked in (("fixed", test_feedthrough.FIXED), ("free", test_feedthrough.NOTHING)):
        yield f"based_feedthrough_{name}", list(asked.values()), [test_feedthrough.FILTERS]


def margins_in_boxes() -> Iterator[Document]:
    """The disk margins of single inputs and of single outputs for every plant in a box."""
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    near = Box.relative(plant, "1/100").system
    controller = local_controllers(plant, [[[-1]]])
    for at in ("inputs", "outputs"):
        yield plain(document(box_disk_margin(near, controller, at=at, margin="1/2")))


def held_in_boxes() -> Iterator[Document]:
    """Of a plant and of all plants near it: with integrators, and without."""
    near = Box.relative(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), "1/10").system
    for proof in (box_setpoints(near), box_fixed_modes(near), setpoint_solvability(near)):
        yield plain(document(proof))


def nearby() -> Iterator[tuple[str, list[Document]]]:
    """Loops and answers of plants, and of plants nearby of which other things hold."""
    module = test_nearby
    others = [module.plant(3), module.plant(2), module.plant(3, 1)]
    for name, own in (("part", module.STABLE), ("radii", module.WIDE)):
        yield f"nearby_{name}", [module.loop(each) for each in (own, *others)]
    discrete = [module.plant(a, time="discrete") for a in (3, 4, 5, "7/2")]
    yield "nearby_discrete", [module.loop(each) for each in discrete]
    for name, own, near in (
        ("rounding", module.OWN, [module.THERE, module.HIDDEN]),
        ("shown", module.SHOWN, [module.HIDDEN, module.THERE]),
        ("stable", module.FAST, [module.STILL]),
        ("digits", module.SHORT, [module.LONG, module.WRONG]),
        ("lacking", module.THERE, [module.OWN]),
    ):
        answers = (module.spectrum, module.controls, module.observes)
        mode = -2 if name == "stable" else 0
        ranks = [module.ranked(each, mode, s) for each in near for s in ([], ["1"])]
        ranks += [module.ranked(dual(each), mode, s) for each in near for s in ([], ["1"])]
        yield f"nearby_{name}", [*(answer(own) for answer in answers), *ranks]
    for name, own in (("law", module.THERE), ("law_hidden", module.HIDDEN)):
        laws = [module.ranked(each, mode, ["1"]) for each in (own, dual(own)) for mode in (0, 1)]
        yield f"nearby_{name}", [module.spectrum(own), *laws]


def for_reasons() -> Iterator[tuple[str, list[Document]]]:
    """Plants whose modes are fixed by zeros, by equalities, by both or not at all."""
    system = test_patterns.EQUAL.with_neighbors({"1": ["2"], "2": []})
    free = test_patterns.FREE.with_neighbors({"1": []})
    for name, own in (("both", system), ("nothing", free), ("hidden", test_nearby.HIDDEN)):
        ways: list[Any] = ["own", "outputs"] if own.neighbors is not None else ["own"]
        found = [structural_fixed_modes(own, information) for information in ways]
        yield f"reasons_{name}", [document(fixed_spectrum(own)), *map(document, found)]


def failing() -> Iterator[tuple[str, list[Document]]]:
    """Plants of which two agents or links have to fail, or all of them may."""
    ways = [[[1], [0]]] * 2 + [[[0], [1]]], [[[1, 0]]] * 2 + [[[0, 1]]]
    for name, mode in (("failing", 1), ("failing_stable", -2)):
        plant = MultiChannelSystem([[mode, 0], [0, -3]], *ways)
        found = fewest_failures(plant, parts=["agents"])
        yield name, [document(found.before), *map(document, found)]
    linked = MultiChannelSystem(
        [[1]], [[[1]], [[0]], [[0]]], [[[0]], [[1]], [[1]]], neighbors={"1": ["2", "3"], "2": ["3"]}
    )
    found = fewest_failures(linked, "outputs", parts=["links"])
    yield "failing_links", [document(found.before), *map(document, found)]


def pool() -> Iterator[tuple[str, list[Document]]]:
    """Plants, each with certificates about it."""
    design, performance = test_sentences_design, test_sentences_performance
    for name, system in {"lost": design.LOST, "found": design.FOUND, "still": design.STILL}.items():
        yield name, [*everything(system), *designs(system)]
    for name, system in crafted().items():
        more = allocations(system) if system.neighbors is not None else iter(())
        none = told(partial(joint_controllability, system, []))
        yield name, [*analyses(system), *refusals(system), *more, *none]
    for name, listed in lacking().items():
        yield name, listed
    yield from tracking()
    within = gallery.load("movable-by-periodic-gains")
    yield "within", list(told(lambda: fixed_spectrum(within), lambda: assignability(within)))
    yield "periodic", [*test_periodic.SAID]
    portless = MultiChannelSystem([[1]], [Matrix.zeros(1, 0)], [Matrix.zeros(0, 1)])
    yield "portless", [document(each) for each in failures(portless)]
    yield from failing()
    yield "boxes", OF_ONE_PLANT
    yield "setpoints_in_boxes", list(held_in_boxes())
    yield "margins_in_boxes", list(margins_in_boxes())
    yield "held_at_samples", [LAGGING, *BY_TUSTIN]
    yield "uneven", [UNEVEN, *analyses(uneven())]
    of_loops: dict[str, list[Document]] = {}
    for _, listed in [*design.IMPLIED, *design.DENIED]:
        for found in listed:
            of_loops.setdefault(json.dumps(found["system"], sort_keys=True), []).append(found)
    for k, listed in enumerate(of_loops.values()):
        yield f"design_{k}", listed
    for module in (
        test_complementary_subsystem,
        test_modulo,
        test_setpoint,
        test_single_channel_gains,
    ):
        yield from alone(module)
    for seed in range(6):
        observer = drawn_observer(random.Random(seed))
        if observer is not None:
            yield f"observer_{seed}", [observer]
    paper = gallery.load("liu2020-3ch-no-communication")
    ring = paper.with_neighbors(NeighborGraph.ring(paper.names))
    yield "paper", list(analyses(paper)) + list(loops(paper, 1)) + list(links(paper))
    yield "ring", [*everything(ring), *designs(ring)]
    yield "silent", list(everything(paper.with_neighbors(NeighborGraph.empty(paper.names))))
    tanks = gallery.load("quadruple-tank-pminus")
    yield "tanks", list(analyses(tanks))
    for seed in range(10):
        system = drawn(seed)
        if system.n <= 4 and system.m <= 3:
            more = designs(system) if system.neighbors is not None and system.n <= 3 else iter(())
            yield f"drawn_{seed}", [*everything(system, seed), *more]
    yield from nearby()
    yield from for_reasons()
    of_plants: dict[str, list[Document]] = {}
    for _, listed in [*performance.IMPLIED, *performance.DENIED]:
        for found in listed:
            of_plants.setdefault(json.dumps(found["system"], sort_keys=True), []).append(found)
    for k, listed in enumerate(of_plants.values()):
        yield f"performance_{k}", listed
