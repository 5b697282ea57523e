"""Every sentence about drawn plants and designs, judged by an oracle of its own.

Run as ``python -m tests.assurance.campaigns.sentences [COUNT [FIRST [FILE]]]``.  What is drawn goes
by its number: an analysis, an allocation, a design of each kind, a plant with one parameter or
several, a box, a loop.  Cases in the file (by default ``build/sentences.jsonl``) are not judged
again.  Ends with 1 if a sentence is false, and names the rules whose sentences were never met.
"""

from __future__ import annotations

import itertools
import json
import random
import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from mcexact.analysis.analyze import account_of_dimensions, account_of_links, analyze
from mcexact.analysis.boxes.largest import largest_loop_ranges
from mcexact.analysis.boxes.loops import box_stability
from mcexact.analysis.performance import sectors_of
from mcexact.analysis.questions import asked_by
from mcexact.analysis.saturation import gains_for, gains_none, saturation_of
from mcexact.answer import protocol
from mcexact.answer.account import Account
from mcexact.answer.listing import everything
from mcexact.answer.loops import EVERY_LOOP_RULES
from mcexact.answer.performance import RULES as PERFORMANCE
from mcexact.answer.saturation import RULES as SATURATION
from mcexact.answer.sentence import Context
from mcexact.answer.templates import Sentence
from mcexact.errors import Impossible, InputError, LimitReached, UsageError
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.box import Box
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.parametric import ParametricSystem
from mcexact.model.periodic import PeriodicController
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.certify import account_of_verdict, certify_controller
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.performance import performance_of
from mcexact.synthesis.periodic import account_of_period, certify_periodic, design_periodic
from mcexact.synthesis.setpoint import design_setpoint
from tests.assurance.campaigns.resumed import main
from tests.oracle.certificates.reading import Unspecified
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import PlainSystem
from tests.oracle.parametric_draws import drawn_parametric
from tests.oracle.periodic import planted
from tests.oracle.sentences import JUDGES, Case, Said, plant_of, said, verdict
from tests.oracle.sentences.cases import plain
from tests.oracle.sentences.designs import document_of
from tests.oracle.sentences.falsified import falsified, unsaid
from tests.oracle.sentences.parameters import family_of

FILE = Path("build") / "sentences.jsonl"
Judged = tuple[Said, Case]
SMALL = (
    "liu2020-3ch-no-communication", "hidden-triple-mode", "liu2020-unimodular",
    "lexalutyi-two-double-integrators", "lexalutyi-single-channel", "lexalutyi-similarity-3x3",
    "siljak-two-subsystems-farina", "movable-by-periodic-gains",
)  # fmt: skip
CHANGES = 40
"""How many changes of one sentence are tried, of which one has to make it false."""
NONSENSE = (
    ArithmeticError,
    AttributeError,
    KeyError,
    LookupError,
    TypeError,
    Unspecified,
    ValueError,
)
"""What a judge may end with where values do not fit together, as those of no sentence do."""
FIELDS = {template.key: template.fields for template in everything()}


def drawn_plant(rng: random.Random, states: int = 4, channels: int = 3) -> MultiChannelSystem:
    """A small plant: sparse, published, with modes out of reach, or whose agents need others."""
    kind = rng.random()
    time = rng.choice(["continuous", "discrete"])
    if kind > 0.75:
        return exact(_needy(rng, states, channels), time)
    if kind < 0.1:
        published = gallery.load(rng.choice(SMALL))
        if published.n <= states + 1:
            return published
    system = sparse_system(rng, states, channels)
    if kind < 0.45:
        _plant_modes(rng, system)
    return exact(system, time)


def _needy(rng: random.Random, states: int, channels: int) -> PlainSystem:
    """Equal eigenvalues, each input and each output at some channel: often agents need others.

    The inputs, and the outputs, of all channels together are all states.
    """
    n, m = rng.randint(2, max(2, states)), rng.randint(min(2, channels), channels)
    mode = rng.choice([Fraction(v) for v in ("-2", "-1/2", "0", "1", "1/2")])
    A = [[mode * (i == j) for j in range(n)] for i in range(n)]
    if rng.random() < 0.4:
        A[0][n - 1] += 1
    if rng.random() < 0.3 and n == 4:
        turn = [[0, -1], [1, 0]]
        A = [
            [Fraction(turn[i % 2][j % 2] * (i // 2 == j // 2)) for j in range(n)] for i in range(n)
        ]
    unit = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    acting, seen = ([rng.randrange(m) for _ in range(n)] for _ in range(2))
    if rng.random() < 0.3:
        acting[0] = seen[rng.randrange(n)] = -1  # an input or an output less
    B = [
        [[x for x, k in zip(row, acting, strict=True) if k == i] for row in unit] for i in range(m)
    ]
    C = [[row for row, k in zip(unit, seen, strict=True) if k == i] for i in range(m)]
    return PlainSystem(A, B, C)


def _single(rng: random.Random, time: str) -> MultiChannelSystem:
    """One input and one output at each of one or two channels, which can be held as a rule."""
    m = rng.randint(1, 2)
    n = rng.randint(m, 3)
    values = [Fraction(rng.choice([0, 0, 1, -1, 2])) for _ in range(n * n)]
    A = [values[n * i : n * i + n] for i in range(n)]
    B = [[[Fraction(int(i == k))] for i in range(n)] for k in range(m)]
    C = [[[Fraction(int(j == k) or rng.choice([0, 0, 1])) for j in range(n)]] for k in range(m)]
    system = PlainSystem(A, B, C)
    if n > m and rng.random() < 0.6:
        _plant_modes(rng, system)
    return exact(system, time)


def _plant_modes(rng: random.Random, system: Any) -> None:
    """A last state that inputs do not act on, or that outputs do not show, with a drawn mode."""
    n = system.n
    row = rng.random() < 0.5
    for k in range(n - 1):
        i, j = (n - 1, k) if row else (k, n - 1)
        system.A[i][j] = Fraction(0)
    system.A[n - 1][n - 1] = rng.choice([Fraction(v) for v in ("-3", "-1/2", "0", "1", "1/3", "2")])
    keep = rng.randrange(system.m) if rng.random() < 0.5 else None
    for i in range(system.m):
        if i == keep:
            continue
        if row:
            system.B[i][n - 1] = [Fraction(0)] * len(system.B[i][n - 1])
        else:
            for line in system.C[i]:
                line[n - 1] = Fraction(0)


def with_graph(
    rng: random.Random, plant: MultiChannelSystem, *, delays: bool = False
) -> MultiChannelSystem:
    """The plant over a drawn neighbor graph, or a ring, some with delays in discrete time."""
    names = plant.names
    heard = {name: [names[k - 1]] if len(names) > 1 else [] for k, name in enumerate(names)}
    if rng.random() < 0.5:
        often = rng.choice([0, 0.5, 0.5])
        heard = {i: [j for j in names if j != i and rng.random() < often] for i in names}
    late: dict[str, dict[str, int]] = {}
    if delays and plant.time == "discrete":
        drawn_late = {i: {j: rng.randint(0, 2) for j in js} for i, js in heard.items()}
        late = {i: {j: d for j, d in row.items() if d} for i, row in drawn_late.items()}
    graph = NeighborGraph.from_names(names, heard, {i: row for i, row in late.items() if row})
    return plant.with_neighbors(graph)


def rows_of(sentences: Iterable[Sentence]) -> list[Said]:
    """The sentences as plain data."""
    return [said(each) for each in sentences]


def _cases(rows: list[Said], case: Case) -> Iterator[Judged]:
    whole = Case(case.plant, case.asked, case.controller, rows, case.parametric)
    for row in rows:
        yield row, whole


# What is asked.


def analysis(rng: random.Random) -> Iterator[Judged]:
    """Everything that `analyze` says of a plant."""
    plant = drawn_plant(rng)
    asked: dict[str, Any] = {}
    if rng.random() < 0.2:
        plant = _single(rng, plant.time)
    options = ["links", "failures", "fewest-failures"] * (plant.m <= 3)
    if rng.random() < 0.7:
        plant = with_graph(rng, plant, delays=rng.random() < 0.4)
        options.append("minimal")
        if rng.random() < 0.5:
            asked["information"] = rng.choice(["own", "outputs"])
        if plant.time == "discrete" and plant.n <= 3:
            options.append("delayed")
    if rng.random() < 0.6:
        asked["subset"] = [name for name in plant.names if rng.random() < 0.5]
    if rng.random() < 0.6:
        asked["channel"] = rng.choice(plant.names)
    if rng.random() < 0.5:
        options.append("every-channel")
    if plant.n and rng.random() < 0.3:
        plant = mixed(rng, plant)
        plant = plant if rng.random() < 0.3 else disturbed(rng, plant)
    found = analyze(plant, also=asked_by(*options), **asked)
    rows = rows_of(found.account.sentences)
    if not found.nearby_left_out:
        asked["nearby"] = {each.lost: plant_of(each.plant) for each in found.nearby.plants}
    yield from _cases(rows, Case(plant_of(plant), asked))


def mixed(rng: random.Random, plant: MultiChannelSystem) -> MultiChannelSystem:
    """The plant in other coordinates, in which what its zeros made fixed rests on equalities."""
    n = plant.n
    T = Matrix.identity(n)
    for _ in range(2 * n):
        i, j = rng.randrange(n), rng.randrange(n)
        if i != j:
            unit = Matrix.from_entries((n, n), [(i, j, rng.choice([1, -1, 2]))])
            T = T @ (Matrix.identity(n) + unit)
    back = inverse(T)
    if back is None:
        raise ArithmeticError("elementary matrices are invertible")
    return MultiChannelSystem(
        T @ plant.A @ back,
        [T @ M for M in plant.B],
        [M @ back for M in plant.C],
        time=plant.time,
        names=plant.names,
        neighbors=plant.neighbors,
    )


def disturbed(rng: random.Random, plant: MultiChannelSystem) -> MultiChannelSystem:
    """The plant with errors of its entries: of floats, larger ones, or of typing a few digits."""
    part = rng.choice([1e-16, 1e-15, 1e-11, 1e-8, 1e-7, 0.0])
    digits = rng.choice([3, 4, 5])
    factor = rng.choice([Fraction(1), Fraction(10, 7), Fraction(1, 3)])

    def moved(x: Fraction) -> Fraction:
        if not part:
            return Fraction(f"{float(x * factor):.{digits - 1}e}")
        return Fraction(repr(float(x * factor) * (1 + part * rng.uniform(-1, 1))))

    def table(M: Matrix) -> Matrix:
        return Matrix.from_entries(M.shape, ((i, j, moved(M[i, j])) for i, j, _ in M.nonzero()))

    return MultiChannelSystem(
        table(plant.A),
        [table(M) for M in plant.B],
        [table(M) for M in plant.C],
        time=plant.time,
        names=plant.names,
        neighbors=plant.neighbors,
    )


def allocation(rng: random.Random) -> Iterator[Judged]:
    """What `allocate` says about dimensions, and about links."""
    plant = with_graph(rng, drawn_plant(rng, 3, 3))
    bound = rng.choice([None, None, Fraction(1, 2)])
    region = None if bound is None else StabilityRegion(plant.time, bound)
    share = rng.choice(["outputs+states", "states"])
    asked: dict[str, Any] = {
        "share": share, "region": region, "free_assignability": rng.random() < 0.3,
    }  # fmt: skip
    if rng.random() < 0.4:
        asked["costs"] = [rng.randint(1, 3) for _ in plant.names]
    if rng.random() < 0.3:
        asked["upper"] = [rng.choice([None, 0, 1, 2]) for _ in plant.names]
    account = account_of_dimensions(plant, **asked)
    case = Case(plant_of(plant), {**asked, "bound": bound})
    yield from _cases(rows_of(account.sentences), case)
    links: dict[str, Any] = {"dimensions": None, "region": region}
    if rng.random() < 0.5:
        links |= {"dimensions": [rng.randint(0, 1) for _ in plant.names], "share": share}
    account = account_of_links(plant, **links)
    case = Case(
        plant_of(plant),
        {"bound": bound, "dimensions": links["dimensions"], "link_share": links.get("share")},
    )
    if links.get("share") is None:
        case = Case(case.plant, {"bound": bound})
    yield from _cases(rows_of(account.sentences), case)


Make = Callable[..., Any]
MAKERS: tuple[Make, ...] = (design_observer, design_decentralized, design_extended, design_setpoint)


def design(rng: random.Random) -> Iterator[Judged]:
    """What a design, or its refusal, says; and then `certify` of the same controller."""
    make = rng.choice(MAKERS)
    plant = drawn_plant(rng, 2 if make is design_observer else 3, 2)
    if rng.random() < (0.7 if make is design_setpoint else 0.3):
        plant = _single(rng, plant.time)
    if make is not design_decentralized and (make is not design_setpoint or rng.random() < 0.6):
        late = make is design_extended and rng.random() < 0.5
        plant = with_graph(rng, plant, delays=late)
    options: dict[str, Any] = {"arithmetic": rng.choice(["float", "exact"])}
    named = {"continuous": ("rate", ["1/10", "1"]), "discrete": ("radius", ["9/10", "1/2"])}
    key, values = named[plant.time]
    if rng.random() < 0.8:
        options[key] = rng.choice(values)
    if make is design_extended:
        options["free_assignability"] = rng.random() < 0.3
        if rng.random() < 0.4:
            options["dimensions"] = [rng.randint(0, 1) for _ in plant.names]
    if make is design_observer and rng.random() < 0.3 and options["arithmetic"] == "exact":
        options.pop(key, None)
        count = plant.n * plant.m + plant.m - 1
        roots = ["-1", "-2", "-3", "-4"] if key == "rate" else ["0", "1/4", "-1/4", "1/2"]
        options["spectrum"] = {"feedback": roots[: plant.n], "error": (roots * count)[:count]}
    elif make is design_observer and rng.random() < 0.4:
        options["gains"] = [
            [[rng.choice([0, 0, -1]) for _ in range(plant.n)] for _ in range(plant.p(i))]
            for i in range(plant.m)
        ]
    if make is design_setpoint and rng.random() < 0.4:
        known = {"continuous": ("ramp", "sine:1", "step,poly:s^2+2"),
                 "discrete": ("ramp", "cosine:1/2", "poly:z+1")}  # fmt: skip
        options["signals"] = rng.choice(known[plant.time])
    if make in (design_decentralized, design_extended) and rng.random() < 0.4:
        options["agent"] = rng.choice(plant.names)
    yield from judged_design(plant, make, options)


def judged_design(
    plant: MultiChannelSystem, make: Make, options: dict[str, Any]
) -> Iterator[Judged]:
    """The sentences of one design or refusal, and those of `certify`."""
    limits = {name: options[name] for name in ("rate", "radius") if name in options}
    try:
        made = make(plant, **options)
    except (InputError, LimitReached, UsageError):  # such as a spectrum that violates the region
        return
    except Impossible as refused:
        region = StabilityRegion.of(plant.time, **limits)
        if isinstance(refused.message, Sentence):
            steps = json.loads(protocol.encode(refused.certificate))["subject"]
            asked = {"steps": steps, "region": plain(region)}
            yield from _cases([said(refused.message)], Case(plant_of(plant), asked))
        return
    asked = {
        "arithmetic": options["arithmetic"], "region": plain(made.region),
        "network": made.parts.get("network", "decentralized"), "steps": [],
    }  # fmt: skip
    document = document_of(json.loads(json.dumps(made.controller.document(), default=str)))
    case = Case(plant_of(plant), asked, document)
    try:
        around = made.every_loop(0.2)
    except LimitReached:
        around = None
    account = made.account_with(around, performance_of(made.loop.closed))
    if "failing_loop" in account.answers:
        failing = plant_of(account.answers["failing_loop"].about.plant)
        asked["failing_plant"] = replace(failing, radii=None)
    yield from _cases(rows_of(account.sentences), case)
    yield from certified(plant, made.controller, case)


def certified(plant: MultiChannelSystem, controller: Any, case: Case) -> Iterator[Judged]:
    """What `certify` says of a loop with a region, and of the largest rate."""
    key, value = ("radius", "1/2") if plant.time == "discrete" else ("rate", "1/2")
    for options in ({}, {key: value}, {"largest": True}):
        try:
            found = certify_controller(plant, controller, **options)
        except LimitReached:
            continue
        account = account_of_verdict(found, largest="largest" in options)
        yield from _cases(rows_of(account.sentences), case)
    inputs = sum(map(plant.p, range(plant.m)))
    sectors = sectors_of(
        closed_loop(plant, controller), [(Fraction(1, 2), Fraction(3, 2))] * inputs
    )
    if sectors is not None:
        given = Context(plant)
        yield from _cases(rows_of(PERFORMANCE.sentences({"sector": sectors}, given)), case)
    one = (Fraction(-1), Fraction(1))
    limits = tuple((one,) * plant.p(i) for i in range(plant.m))
    loop = closed_loop(plant, controller)
    for saturated in (saturation_of(loop, limits, gains_none(loop)), gains_for(loop, limits)[1]):
        if saturated is not None:
            rows = rows_of(SATURATION.sentences({"saturation": saturated}, Context(plant)))
            yield from _cases(rows, case)


def parameter(rng: random.Random) -> Iterator[Judged]:
    """What `analyze` says of a plant with one parameter, or now and then with two."""
    if rng.random() < 0.25:
        yield from several(rng)
        return
    plant = drawn_parametric(rng)
    if rng.random() < 0.25:
        entry = rng.choice(["t", "t - 1", "t^2 - 2", "t^2 + 1", "1", "2"])
        A = [[rng.choice([0, 1, "t"]), 1], [rng.choice([0, entry]), rng.choice([-1, "t", 2])]]
        B = [[[rng.choice([0, entry])], [1]]]
        plant = ParametricSystem(A, B, [[[1, 0]]], parameters=["t"], time=plant.time)
    yield from _of_values(plant, rng)


def several(rng: random.Random) -> Iterator[Judged]:
    """What `analyze` says of a plant with two parameters, with ranges of both or without."""
    n, m = rng.randint(1, 2), rng.randint(1, 2)
    letters = ["a", "b", "a - b", "a + 1", "b - 2", "a*b"]

    def rows(nrows: int, ncols: int) -> list[list[Any]]:
        return [
            [rng.choice([0, 1, -1, 2, *letters][: rng.choice([3, 4, 10])]) for _ in range(ncols)]
            for _ in range(nrows)
        ]

    A, B, C = rows(n, n), [rows(n, 1) for _ in range(m)], [rows(1, n) for _ in range(m)]
    A[0][0], B[0][0][0] = "a", rng.choice(["b", 1])
    assume = {"a": (1, 2), "b": (Fraction(1, 2), 1)} if rng.random() < 0.6 else {}
    plant = ParametricSystem(A, B, C, parameters=["a", "b"], assume=assume)
    yield from _of_values(plant, rng)


def _of_values(plant: ParametricSystem, rng: random.Random) -> Iterator[Judged]:
    channel = rng.choice(plant.names) if rng.random() < 0.5 else None
    also = [name for name in ("box_controllability", "box_observability") if None not in
            [end for ends in plant.ranges for end in ends]]  # fmt: skip
    account = analyze(plant, also=also, channel=channel).account
    case = Case(_nothing(), {"channel": channel}, parametric=family_of(plant))
    yield from _cases(rows_of(account.sentences), case)


def _nothing() -> Any:
    """In the place of a plant whose entries are numbers."""
    return plant_of(MultiChannelSystem([[0]], [[[0]]], [[[0]]]))


def box(rng: random.Random) -> Iterator[Judged]:
    """What `analyze` says of a plant with radii."""
    nominal = drawn_plant(rng, 3, 2)
    if rng.random() < 0.6:
        full = [[Fraction(rng.choice([1, 2, -1, 3])) for _ in range(2)] for _ in range(2)]
        ports = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
        nominal = MultiChannelSystem(full, *ports, time=rng.choice(["continuous", "discrete"]))
    plant = Box.relative(nominal, rng.choice(["1/100", "1/10"])).system
    account = analyze(plant).account
    yield from _cases(rows_of(account.sentences), Case(plant_of(plant), {}))


def loop(rng: random.Random) -> Iterator[Judged]:
    """What is said of all loops in a box, and at all values of parameters."""
    discrete = rng.random() < 0.5
    time = "discrete" if discrete else "continuous"
    a, b = (Fraction(rng.randint(1, 4), 8) for _ in range(2))
    own = Fraction(1, 4) if discrete else Fraction(-rng.randint(1, 3))
    ports = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    nominal = MultiChannelSystem([[own, a], [b, own]], *ports, time=time)
    gain = Fraction(0) if discrete else Fraction(-1)
    controller = local_controllers(nominal, [[[gain]], [[gain / 2]]])
    document = document_of(json.loads(json.dumps(controller.document(), default=str)))
    key, value = ("radius", "9/10") if discrete else ("rate", "1/8")
    options: Any = rng.choice([{}, {key: value}])
    gains = rng.choice([None, Fraction(1, 100)])
    plant = Box.relative(nominal, rng.choice(["1/20", "1/5"])).system
    if rng.random() < 0.5:
        none = [[0], [0]], [[0], [0]]
        plant = Box.absolute(
            nominal, [["1/50", 0], ["1/100", "1/50"]], none, ([[0, 0]], [[0, 0]])
        ).system
    case = Case(plant_of(plant), {}, document)
    try:
        found = certify_controller(plant, controller, **options)
        every = box_stability(plant, controller, gains=gains, **options)
    except LimitReached:
        pass
    else:
        account = account_of_verdict(found, every_loop=every, gains=gains)
        yield from _cases(rows_of(account.sentences), case)
    family = ParametricSystem([[own, "a"], ["b", own]], *ports, parameters=["a", "b"], time=time,
                             assume={"a": (0, a), "b": (b / 2, b)})  # fmt: skip
    try:
        wide = largest_loop_ranges(family, controller, gains=gains, effort=2, **options)
    except LimitReached:
        return
    if wide.proof is not None and wide.lower == 1:
        given = Context(
            family, {"parameters": ", ".join(family.parameters_in_words), "part_of_gains": gains}
        )
        answers = {"box_stability": wide.proof}
        account = Account(answers, given, EVERY_LOOP_RULES.sentences(answers, given))
        case = Case(plant_of(family.at({"a": 0, "b": b})), {}, document, (), family_of(family))
        yield from _cases(rows_of(account.sentences), case)


def periodic(rng: random.Random) -> Iterator[Judged]:
    """What is said of a loop with gains of a period, drawn or designed."""
    plant, _ = planted(rng.randrange(1000))
    controller = None
    if rng.random() < 0.5:
        with suppress(LimitReached):
            controller = design_periodic(plant, longest=2).controller
    if controller is None:
        drawn_gains = [[[[rng.randint(-2, 2)]] for _ in range(plant.m)] for _ in range(2)]
        controller = PeriodicController(tuple(local_controllers(plant, g) for g in drawn_gains))
    radius = rng.choice([None, Fraction(9, 10), Fraction(1, 2)])
    region = StabilityRegion("discrete", radius)
    account = account_of_period(
        certify_periodic(plant, controller, radius=radius), controller, region
    )
    phases = json.loads(json.dumps(controller.document(), default=str))
    case = Case(plant_of(plant), {}, {"phases": [document_of(phase) for phase in phases]})
    yield from _cases(rows_of(account.sentences), case)


KINDS: tuple[Callable[[random.Random], Iterator[Judged]], ...] = (
    analysis, design, analysis, parameter, design, allocation, periodic, parameter, box, loop,
)  # fmt: skip


def drawn(number: int) -> Iterator[Judged]:
    """The sentences of the case of a number, each with what it is about."""
    return KINDS[number % len(KINDS)](random.Random(number))


def examined(number: int) -> tuple[list[str], Counter[str]]:
    """The false sentences of a case, and how many of each rule were judged."""
    wrong, seen = [], Counter[str]()
    for sentence, case in drawn(number):
        if sentence.rule not in JUDGES:
            continue
        told = verdict(sentence, case)
        outcome = {True: "true", False: "FALSE", None: "not judged"}[told]
        seen[f"{sentence.rule} {outcome}"] += 1
        if told is False:
            wrong.append(f"{sentence.rule}: {sentence.text} {dict(sentence.values)}")
    return wrong, seen


def caught(number: int, wanted: Collection[str] = tuple(JUDGES)) -> set[str]:
    """The rules of which a sentence that was made false about a case is judged false."""
    found: set[str] = set()
    judged = [pair for pair in drawn(number) if pair[0].rule in JUDGES]
    for sentence, case in judged:
        if sentence.rule in wanted and sentence.rule not in found:
            changed = itertools.islice(falsified(sentence, case), CHANGES)
            if any(_denied(*pair) for pair in changed):
                found.add(sentence.rule)
    for case in {id(case): case for _, case in judged}.values():
        fields = {rule: names for rule, names in FIELDS.items() if rule in {*wanted} - found}
        found |= {each.rule for each in unsaid(fields, case) if _denied(each, case)}
    return found


def _denied(sentence: Said, case: Case) -> bool:
    """Whether a sentence is judged false; one that makes no sense is none."""
    try:
        return verdict(sentence, case) is False
    except NONSENSE:
        return False


def never_met(path: Path) -> list[str]:
    """The rules with a judge of which no sentence is in a file of rows."""
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    met = {each.rpartition(" ")[0].removesuffix(" not") for row in rows for each in row["seen"]}
    return [rule for rule in JUDGES if rule not in met]


if __name__ == "__main__":
    status = main(sys.argv[1:], 500, FILE, examined, "false sentences")
    print("never met:", *never_met(Path(sys.argv[3]) if len(sys.argv) > 3 else FILE))
    sys.exit(status)
