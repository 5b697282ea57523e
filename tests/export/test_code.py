"""Exported code computes what the agents compute: C compiled and run, Structured Text evaluated."""

from __future__ import annotations

import ctypes
import json
import random
import re
import shutil
import subprocess
from collections import deque
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem
from mcexact.derived.sampling import sampled_system
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.export.code import export_controller
from mcexact.export.compiled import FLAGS, CompiledAgent, compiled_agents
from mcexact.export.equations import (
    CONTROLLER,
    EQUATIONS,
    AgentRun,
    AgentStep,
    Language,
    Signal,
    equations_document,
    steps_of,
)
from mcexact.export.fixed import FixedPoint
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.statespace import local_controllers
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.setpoint import design_setpoint
from tests.wording import says

COMPILER = shutil.which("gcc")
STEPS = 10_000


def plant(delays: dict[str, dict[str, int]] | None = None) -> MultiChannelSystem:
    """Three states in a row; the ends are driven and measured."""
    graph = NeighborGraph.from_names(
        ("left", "2nd pump"), {"left": ["2nd pump"], "2nd pump": ["left"]}, delays or {}
    )
    return MultiChannelSystem(
        [["11/10", "1/5", 0], ["1/10", "1/2", "1/7"], [0, "1/5", "9/10"]],
        [[[1], [0], [0]], [[0], [0], [1]]],
        [[[1, 0, 0], [0, "1/3", 0]], [[0, 0, 1]]],
        time="discrete",
        names=["left", "2nd pump"],
        neighbors=graph,
    )


def tanks() -> MultiChannelSystem:
    """Three tanks in a row in continuous time; the ends are driven and measured."""
    return MultiChannelSystem(
        [["-1/5", "1/5", 0], ["1/5", "-2/5", "1/5"], [0, "1/5", "-1/4"]],
        [[[1], [0], [0]], [[0], [0], [1]]],
        [[[1, 0, 0], [0, 1, 0]], [[0, 0, 1]]],
        names=["left", "2nd pump"],
    )


def drawn(seed: int, hold: dict[int, int]) -> Controller:
    """Programs that use every signal there is, with numbers that no double is."""
    rng = random.Random(seed)

    def M(rows: int, columns: int) -> Matrix:
        entries = [[Fraction(rng.randint(-9, 9), 97) for _ in range(columns)] for _ in range(rows)]
        return Matrix.from_rows(entries, ncols=columns)

    q, shared, private = (2, 1), (2, 1), (1, 2)

    def program(i: int, rows: int) -> LinearMap:
        return LinearMap(
            {j: M(rows, q[j]) for j in range(2)},
            {j: M(rows, shared[j]) for j in range(2)},
            M(rows, private[i]),
            M(rows, q[i]),
        )

    def agent(i: int) -> AgentProgram:
        maps = [program(i, rows) for rows in (shared[i], private[i], 1)]
        name = plant().names[i]
        return AgentProgram(
            name, shared[i], private[i], maps[0], maps[1], maps[2], {} if i else hold
        )

    return Controller("discrete", "", (agent(0), agent(1)))


def made() -> dict[str, tuple[MultiChannelSystem, Controller]]:
    """Controllers without states, with shared ones, with set-points, late, held and delayed."""
    network, delayed = plant(), plant({"left": {"2nd pump": 2}, "2nd pump": {"left": 1}})
    static = local_controllers(network, [[["-1/3", "1/7"]], [["-2/7"]]])
    tracking = design_setpoint(
        network, regulate={"left": [1], "2nd pump": [1]}, radius="99/100", aims=Aims(effort=1)
    )
    saturated = drawn(3, {}).with_saturation(
        (((Fraction(-1, 3), Fraction(1, 7)),), ((Fraction(-1, 100), Fraction(2)),)),
        [
            Matrix.from_rows([["1/9"], ["-2/7"], ["1/13"]]),
            Matrix.from_rows([[0], ["3/11"], ["-1/17"]]),
        ],
    )
    cut = static.with_saturation((((Fraction(0), Fraction(1, 3)),), (None,)))
    third = Fraction(1, 3)
    thirds = static.with_saturation((((-third, third),), ((Fraction(-1, 7), third),)))
    sharing = design_extended(network, dimensions=[1, 1], arithmetic="float", agent="left")
    late = sampled_system(tanks(), "1/2", 1)
    return {
        "static": (network, static),
        "set-points": (network, tracking.controller),
        "sampled and late": (late, design_decentralized(late, aims=Aims(effort=1)).controller),
        "shared states": (network, sharing.controller),
        "every signal": (network, drawn(1, {})),
        "limits and anti-windup": (network, saturated),
        "limits of one agent": (network, cut),
        "limits that no code has": (network, thirds),
        "held and delayed": (delayed, drawn(2, {0: 3, 1: 1})),
    }


MADE = made()


def code(
    controller: Controller, language: Language, fixed: FixedPoint | None = None
) -> dict[str, str]:
    """The files of all agents."""
    files = export_controller(controller, language, fixed)
    del files[EQUATIONS], files[CONTROLLER]
    return files


Signals = dict[Any, Sequence[float]]


FUNCTIONS = {
    "LIMIT": lambda low, value, high: low if value < low else high if value > high else value,
    "SEL": lambda chosen, first, second: second if chosen else first,
}
"""Functions of IEC 61131-3."""


class BlockAgent:
    """A function block of Structured Text, evaluated statement by statement."""

    ARRAY = re.compile(r"(\w+) : ARRAY\[0\.\.(\d+)\] OF LREAL;")
    STATEMENT = re.compile(r"(\w+)\[(\d+)\] := (.*)", re.DOTALL)

    def __init__(self, text: str, steps: Sequence[AgentStep], position: int) -> None:
        self.steps, self.step = steps, steps[position]
        text = re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)
        head, _, body = text.rpartition("END_VAR")
        assert head.split()[:2] == ["FUNCTION_BLOCK", self.step.identifier]
        self.memory: dict[str, Any] = {
            name: [0.0] * (int(k) + 1) for name, k in self.ARRAY.findall(head)
        }
        self.memory |= {"start": False} if "start : BOOL;" in head else {}
        *statements, end = body.split(";")
        assert end.strip() == "END_FUNCTION_BLOCK"
        found = [self.STATEMENT.fullmatch(each.strip()) for each in statements]
        self.code = [
            (m[1], int(m[2]), compile(" ".join(m[3].split()), "st", "eval")) for m in found if m
        ]
        assert len(self.code) == len(statements)

    def sent_to(self, follower: int) -> list[float]:
        return list(self.memory[f"sent_to_{self.steps[follower].identifier}"])

    def __call__(self, y: Sequence[float], r: Sequence[float], received: Signals) -> list[float]:
        step, given = self.step, {"y": y[: self.step.outputs], "r": r[: self.step.references]}
        for kind, j, _ in step.received:
            given[f"{kind}_{self.steps[j].identifier}"] = received[kind, j]
        self.memory |= {name: list(values) for name, values in given.items() if values}
        for name, k, code in self.code:
            self.memory[name][k] = eval(code, dict(FUNCTIONS), self.memory)
        return list(self.memory["u"]) if step.u else []


def run(
    system: MultiChannelSystem, agents: Sequence[Any], r: Sequence[Sequence[float]], count: int
) -> list[list[float]]:
    """The inputs in each step of a loop whose plant is in doubles, with its delayed links."""
    A, B, C = (
        [[float(x) for x in row] for row in M.rows()]
        for M in (system.A, system.input_matrix(), system.output_matrix())
    )
    graph, told = system.neighbors or NeighborGraph.complete(system.names), []
    x = [1.0, -1.0, 0.5, *[0.0] * (system.n - 3)]
    late: dict[Any, deque[Any]] = {
        (j, i): deque([None] * graph.delay(i, j)) for j, i in graph.edges() if i != j
    }
    for _ in range(count):
        flat, measured = [sum(c * v for c, v in zip(row, x, strict=True)) for row in C], []
        for i in range(system.m):
            measured.append(flat[: system.q(i)])
            flat = flat[system.q(i) :]
        received: list[Signals] = [{} for _ in agents]
        for (j, i), under_way in late.items():
            sent = agents[j].sent_to(i) if i in agents[j].step.sent else []
            under_way.append((measured[j], sent))
            arrived = under_way.popleft()
            zeros = [0.0] * system.q(j), [0.0] * len(sent)
            received[i]["y", j], received[i]["x", j] = zeros if arrived is None else arrived
        inputs = [a(y, s, got) for a, y, s, got in zip(agents, measured, r, received, strict=True)]
        told.append([value for u in inputs for value in u or [0.0]])
        whole = [u[k] if u else 0.0 for u, p in zip(inputs, (1, 1), strict=True) for k in range(p)]
        x = [
            sum(a * v for a, v in zip(A[k], x, strict=True))
            + sum(b * v for b, v in zip(B[k], whole, strict=True))
            for k in range(system.n)
        ]
        if max(map(abs, x)) > 1e6:  # an unstable loop starts again, with other numbers
            x = [value / 1e7 for value in x]
    return told


def compiled(files: dict[str, str], folder: Path) -> ctypes.CDLL:
    """Compile the files without a warning into a library."""
    for name, text in files.items():
        (folder / name).write_text(text)
    assert {"-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"} <= set(FLAGS)
    sources = sorted(name for name in files if name.endswith(".c"))
    command = [str(COMPILER), *FLAGS, "-shared", "-fPIC", *sources, "-o", "code.so"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return ctypes.CDLL(str(folder / "code.so"))


SET_POINTS = [[0.3, -2.0], [1.7]]


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
@pytest.mark.parametrize("name", MADE)
def test_the_compiled_code_computes_the_bits_of_the_run(name: str, tmp_path: Path) -> None:
    system, controller = MADE[name]
    steps, library = steps_of(controller), compiled(code(controller, "c"), tmp_path)
    ours = run(system, [AgentRun(step) for step in steps], SET_POINTS, STEPS)
    agents = [CompiledAgent(library, steps, i) for i in range(system.m)]
    theirs = run(system, agents, SET_POINTS, STEPS)
    assert ours == theirs
    assert len({tuple(u) for u in ours}) > 50


@pytest.mark.parametrize("name", MADE)
def test_structured_text_computes_the_bits_of_the_run(name: str) -> None:
    system, controller = MADE[name]
    steps, files = steps_of(controller), code(controller, "st")
    agents = [BlockAgent(files[f"{s.identifier}.st"], steps, s.position) for s in steps]
    ours = run(system, [AgentRun(step) for step in steps], SET_POINTS, 300)
    assert ours == run(system, agents, SET_POINTS, 300)


@pytest.mark.parametrize("name", [name for name in MADE if "limits" not in name])
def test_the_run_follows_the_exact_simulation(name: str) -> None:
    system, controller = MADE[name]
    ours = run(system, [AgentRun(step) for step in steps_of(controller)], SET_POINTS, 12)
    exact = simulate(
        system,
        controller,
        horizon=11,
        initial=[1, -1, "1/2", *[0] * (system.n - 3)],
        reference=[["3/10", -2], ["17/10"]],
        arithmetic="exact",
    )
    inputs = list(exact.values("inputs").values())
    for t, values in enumerate(ours):
        wanted = [float(each[t]) for each in inputs]
        assert values == pytest.approx(wanted, rel=1e-9, abs=1e-9)


def test_what_is_no_program_of_steps_is_refused() -> None:
    system = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    with pytest.raises(UsageError, match="discrete time"):
        steps_of(local_controllers(system, [[[-2]]]))
    sampled = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    with pytest.raises(InputError, match="beyond double precision"):
        steps_of(local_controllers(sampled, [[[10**400]]]))


def test_the_document_has_every_number_exactly_and_as_it_is_used() -> None:
    _, controller = MADE["every signal"]
    document = equations_document(steps_of(controller), controller.system)
    terms = [
        t
        for a in document["agents"]
        for key in ("u", "next x", "next z")
        for row in a[key]
        for t in row
    ]
    assert len(terms) == sum(len(row) for step in steps_of(controller) for row in step.rows())
    assert all(float(Fraction(exact)) == double for exact, double, _ in terms)
    assert {signal.split(" of ")[1] for *_, signal in terms} == {"left", "2nd pump"}


def test_the_code_says_how_many_numbers_were_rounded() -> None:
    text = code(MADE["static"][1], "c")["left.h"]
    assert says(text, "nearest double")
    halves = local_controllers(plant(), [[["-1/2", 0]], [["1/3"]]])
    texts = code(halves, "c")
    assert says(texts["left.h"], "only number")
    assert says(texts["agent_2nd_pump.h"], "nearest double 2")
    mixed = code(local_controllers(plant(), [[["-1/2", "1/3"]], [[0]]]), "c")
    assert says(mixed["left.h"], "nearest double 3")
    assert "number" not in mixed["agent_2nd_pump.h"]
    both = code(local_controllers(plant(), [[["-1/2", "1/4"]], [[0]]]), "c")
    assert says(both["left.h"], "numbers exactly")


def test_numbers_for_start_are_counted_where_there_is_code_for_it_alone() -> None:
    M = Matrix.from_rows
    halves = AgentProgram(
        "left",
        0,
        1,
        private_update=LinearMap({0: M([["1/2"]])}, {}, M([["-1/2"]])),
        input=LinearMap({}, {}, M([[1]])),
    )
    controller = Controller("discrete", "", (halves,))
    [step] = steps_of(controller)
    assert step.start == (((Fraction(1, 3), Signal("y", 0, 0)),),)
    assert sum(map(len, step.rows())) == 3
    for language, name in (("c", "left.h"), ("st", "left.st")):
        text = code(controller, language)[name]  # type: ignore[arg-type]
        assert says(text, "numbers exactly")
        assert says(text, "start nearest")
        integers = code(controller, language, FixedPoint(4))[name]  # type: ignore[arg-type]
        assert says(integers, "numbers exactly 2")
        assert says(integers, "fractional bits")
    document = json.loads(export_controller(controller, "json", FixedPoint(4))[EQUATIONS])
    [[[number, *_]]] = document["agents"][0]["start"]
    assert Fraction(number) == Fraction(5, 16)


def test_an_agent_starts_at_zero_where_its_rest_is_beyond_doubles() -> None:
    M = Matrix.from_rows
    near = AgentProgram(
        "left",
        0,
        1,
        private_update=LinearMap({0: M([[10**300]])}, {}, M([[1 - Fraction(1, 10**100)]])),
        input=LinearMap({}, {}, M([[1]])),
    )
    [step] = steps_of(Controller("discrete", "", (near,)))
    assert step.start is None
    large = lag().with_saturation((((Fraction(-1), Fraction(10**400)),),))
    with pytest.raises(InputError, match="beyond double precision"):
        steps_of(large)


def test_no_name_of_an_agent_ends_a_comment_or_is_a_word_of_the_language() -> None:
    names = ["*/ int x; /*", "*) END_VAR (*", "double", "Double", "x", "0"]
    system = MultiChannelSystem(
        [[0]], [[[1]]] * len(names), [[[1]]] * len(names), time="discrete", names=names
    )
    controller = local_controllers(system, [[["1/2"]]] * len(names))
    steps = steps_of(controller)
    assert len({step.identifier for step in steps}) == len(names)
    assert "*/ int x; /*" in export_controller(controller, "json")["equations.json"]
    for text in code(controller, "c").values():
        assert text.count("*/") == text.count("/*") <= 1
    for text in code(controller, "st").values():
        assert text.count("*)") == text.count("(*") == 1


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
def test_agents_of_any_name_compile(tmp_path: Path) -> None:
    names = ["*/ int x; /*", "double", "x", "pump_h"]
    system = MultiChannelSystem(
        [[0]], [[[1]]] * len(names), [[[1]]] * len(names), time="discrete", names=names
    )
    compiled(code(local_controllers(system, [[["1/2"]]] * len(names)), "c"), tmp_path)


def lag() -> Controller:
    """An agent without an integrator that uses its own output and set-point alone, with limits."""
    M = Matrix.from_rows
    agent = AgentProgram(
        "left",
        1,
        1,
        LinearMap({0: M([["1/3"]])}, {0: M([["1/2"]])}, M([["1/5"]])),
        LinearMap({0: M([["-1/7"]])}, {}, M([["1/4"]]), M([["2/3"]])),
        LinearMap({0: M([["-3"]])}, {}, M([["1/3"]]), M([["1"]])),
    )
    return Controller("discrete", "", (agent,)).with_saturation(
        (((Fraction(-1), Fraction(1, 2)),),), [M([["1/3"], ["1/9"]])]
    )


def started(kind: str, controller: Controller, y: list[float], r: list[float]) -> Any:
    """An agent that starts without a bump."""
    steps = steps_of(controller)
    if kind == "doubles":
        agent = AgentRun(steps[0])
        agent.start(y, r)
        return agent
    if kind == "text":
        block = BlockAgent(code(controller, "st")["left.st"], steps, 0)
        block.memory["start"] = True
        block(y, r, {})
        # the first period was a step already: what follows is the second one
        block.memory["start"] = False
        return block
    if COMPILER is None:
        pytest.skip("no C compiler")
    [compiled] = compiled_agents(controller)
    compiled.start(y, r)
    return compiled


@pytest.mark.parametrize("kind", ["doubles", "text", "compiled"])
def test_an_agent_that_starts_at_rest_computes_the_same_inputs_on_and_on(kind: str) -> None:
    controller, y, r = lag(), [0.3], [0.1]
    agent = started(kind, controller, y, r)
    told = [agent(y, r, {})[0] for _ in range(20)]
    # (I - A)^-1 (B y + R r) for A = [1/2, 1/5; 0, 1/4], B = (1/3, -1/7), R = (0, 2/3)
    z = (-1 / 7 * 0.3 + 2 / 3 * 0.1) / (1 - 1 / 4)
    assert told[0] == pytest.approx(-3 * 0.3 + z / 3 + 0.1, abs=1e-12)
    assert told == pytest.approx([told[0]] * 20, abs=1e-12)
    # from zeros it takes steps until it is there
    other = AgentRun(steps_of(controller)[0])
    assert abs(other(y, r, {})[0] - told[0]) > 1e-3


def test_an_agent_with_an_integrator_or_with_neighbors_starts_at_zero() -> None:
    M = Matrix.from_rows
    integral = AgentProgram(
        "left", 0, 1, private_update=LinearMap({0: M([[1]])}, {}, M([[1]])), input=LinearMap()
    )
    [step] = steps_of(Controller("discrete", "", (integral,)))
    assert step.start is None
    assert all(each.start is None for each in steps_of(drawn(1, {})))
    assert "_start" not in "".join(code(drawn(1, {}), "c").values())


def test_inputs_never_leave_their_limits_and_what_is_cut_off_corrects_the_states() -> None:
    controller = lag()
    agent = AgentRun(steps_of(controller)[0])
    free = AgentRun(steps_of(controller.with_saturation(None))[0])
    for k in range(5):
        y = [1.0 if k < 3 else -1.0]
        (u,), (v,) = agent(y, [0.0], {}), free(y, [0.0], {})
        assert u == min(max(v, -1.0), 0.5) if k == 0 else -1.0 <= u <= 0.5
    assert agent.z != free.z
