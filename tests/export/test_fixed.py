"""Controllers in fixed point: an exact model, compiled C and evaluated Structured Text agree."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import floor
from pathlib import Path
from typing import Any

import pytest

from mcexact import Controller, Matrix, MultiChannelSystem, certify_controller, check
from mcexact.designs import AgentProgram, LinearMap
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.export.code import export_controller, in_code
from mcexact.export.compiled import CompiledAgent
from mcexact.export.equations import AgentRun, AgentStep, Kind, Row, Signal, steps_of
from mcexact.export.fixed import LARGEST, FixedAgent, FixedPoint, least_fixed_point
from mcexact.model.controller import read_controller
from mcexact.model.statespace import local_controllers
from tests.export.test_code import COMPILER, MADE, SET_POINTS, STEPS, code, compiled, lag, run
from tests.wording import refusal, says

ARITHMETICS = {
    "usual ranges": FixedPoint(14),
    "ranges of each kind": FixedPoint(9, {"y": 50, "r": 4, "u": 300, "x": 7, "z": 4000}),
    "ranges that are reached": FixedPoint(12, {"y": 2, "u": 1, "z": 3, "x": 1}),
}


FINE = 80
"""All signals of the model are integers in units of 2^-80."""


class ModelAgent:
    """The definition of fixed point once more, in exact integers of one unit for all signals."""

    def __init__(self, step: AgentStep, fixed: FixedPoint) -> None:
        self.step = step
        self.units = {kind: 2 ** (FINE - fixed.fractional(kind)) for kind in "yruxz"}
        self.z = [0] * len(step.z)
        self.past = [[0] * len(step.x) for _ in range(step.remembered + 1)]
        self.bits = fixed.bits
        self.rows: dict[str, list[list[tuple[int, Signal]]]] = {
            kind: [[(self.number(c), s) for c, s in row] for row in rows]
            for kind, rows in (("u", step.u), ("x", step.x), ("z", step.z))
        }

    def nearest(self, kind: str, value: int, divided_by: int = 1) -> int:
        unit = self.units[kind]
        steps = (2 * value + unit * divided_by) // (2 * unit * divided_by)
        return min(max(steps, -LARGEST), LARGEST) * unit

    def number(self, c: Fraction) -> int:
        steps = floor(abs(c) * 2**self.bits + Fraction(1, 2))
        return steps if c > 0 else -steps

    def sent_to(self, follower: int) -> list[float]:
        return [v / 2**FINE for v in self.past[self.step.sent[follower]]]

    def __call__(
        self, y: Sequence[float], r: Sequence[float], received: Mapping[tuple[Kind, int], Any]
    ) -> list[float]:
        i = self.step.position
        given: dict[tuple[Kind, int], Any] = {("y", i): y, ("r", i): r, **received}
        known = {
            key: [self.nearest(key[0], int(v * 2.0**FINE)) for v in values]
            for key, values in given.items()
        }
        known |= {("x", i): self.past[self.step.held], ("z", i): self.z}

        def value(kind: str, row: Sequence[tuple[int, Signal]]) -> int:
            total = sum(m * known[s.kind, s.agent][s.entry] for m, s in row)
            return self.nearest(kind, total, 2**self.bits)

        u = [value("u", row) for row in self.rows["u"]]
        known["e", i] = [0] * len(u)
        for k, pair in enumerate(self.step.limits):
            if pair is not None:
                # the multiples of a unit nearest to the limits, within them
                unit = self.units["u"]
                low = -(int(-Fraction(float(pair[0])) * 2**FINE) // unit * unit)
                high = int(Fraction(float(pair[1])) * 2**FINE) // unit * unit
                limited = min(max(u[k], low), high)
                known["e", i][k], u[k] = limited - u[k], limited
        x, z = ([value(kind, row) for row in self.rows[kind]] for kind in "xz")
        self.past, self.z = [x, *self.past[:-1]], z
        return [v / 2**FINE for v in u]


class IntegerBlock:
    """Structured Text in integers, each statement translated, each value held to its type."""

    def __init__(self, text: str, steps: Sequence[AgentStep], position: int, fixed: FixedPoint):
        self.steps, self.step, self.fixed = steps, steps[position], fixed
        text = re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)
        self.functions: dict[str, Callable[[int, int], int]] = {}
        for name, body in re.findall(
            r"FUNCTION (\w+) : DINT\b.*END_VAR\n(.*?)END_FUNCTION\n", text, flags=re.DOTALL
        ):
            self.functions[name] = self._function(name, body)
        block = text[text.index("FUNCTION_BLOCK") :]
        head, _, body = block.rpartition("END_VAR")
        self.memory = {
            name: [0] * (int(k) + 1)
            for name, k in re.findall(r"(\w+) : ARRAY\[0\.\.(\d+)\] OF DINT;", head)
        }
        self.memory["start"] = False  # type: ignore[assignment]
        assert body.strip().endswith("END_FUNCTION_BLOCK")
        statements = body.replace("END_FUNCTION_BLOCK", "").split(";")[:-1]
        self.statements = [
            (target, int(k), compile(_expression(value), "st", "eval"))
            for target, k, value in re.findall(
                r"(\w+)\[(\d+)\] := ([^;]*);", ";".join(statements) + ";"
            )
        ]
        assert len(self.statements) == len(statements)

    @staticmethod
    def _function(name: str, body: str) -> Callable[[int, int], int]:
        condition = r"IF (.*?) THEN (\w+) := (.*?); END_IF"
        lines = []
        for line in filter(None, map(str.strip, body.splitlines())):
            if match := re.fullmatch(condition + ";", line):
                lines.append((match[2], _expression(match[3]), _expression(match[1])))
            else:
                target, _, value = line.removesuffix(";").partition(" := ")
                lines.append((target, _expression(value), "True"))

        def call(sum: int, unit: int) -> int:
            known: dict[str, Any] = {"sum": _long(sum), "unit": _long(unit)}
            for target, value, when in lines:
                if eval(when, dict(_LONG), known):
                    known[target] = _long(eval(value, dict(_LONG), known))
            result: int = known[name]
            assert abs(result) <= LARGEST
            return result

        return call

    def sent_to(self, follower: int) -> list[float]:
        name = f"sent_to_{self.steps[follower].identifier}"
        return self.fixed.doubles("x", self.memory[name])

    def __call__(self, y: Sequence[float], r: Sequence[float], received: Any) -> list[float]:
        step = self.step
        given: dict[str, tuple[str, Sequence[float]]]
        given = {"y": ("y", y[: step.outputs]), "r": ("r", r[: step.references])}
        for kind, j, _ in step.received:
            given[f"{kind}_{self.steps[j].identifier}"] = kind, received[kind, j]
        for name, (letter, values) in given.items():
            if values:
                self.memory[name] = self.fixed.integers(letter, values)
        for target, k, value in self.statements:
            self.memory[target][k] = eval(value, dict(_LONG) | self.functions, self.memory)
        return self.fixed.doubles("u", self.memory["u"]) if step.u else []


def _expression(text: str) -> str:
    """An expression of Structured Text in Python; `/` truncates."""
    text = re.sub(r"DINT_TO_LINT\((.*?\])\)", r"\1", " ".join(text.split()))
    text = re.sub(r"LINT_TO_DINT\((\w+)\)", r"\1", text)
    text = re.sub(r"LINT#(-?\d+)", r"(\1)", text)
    return re.sub(r"(\w+) / (\(\d+\)|\w+)", r"quotient(\1, \2)", text)


def _long(value: int) -> int:
    assert abs(value) < 2**63
    return value


_LONG = {
    "quotient": lambda a, b: abs(a) // b * (1 if a >= 0 else -1),
    "LIMIT": lambda low, value, high: min(max(low, value), high),
    "SEL": lambda which, no, yes: yes if which else no,
}


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
@pytest.mark.parametrize(
    ("arithmetic", "count"),
    [pytest.param(name, STEPS if name == "usual ranges" else 300, id=name) for name in ARITHMETICS],
)
@pytest.mark.parametrize("name", MADE)
def test_compiled_code_is_the_exact_model(
    name: str, arithmetic: str, count: int, tmp_path: Path
) -> None:
    system, controller = MADE[name]
    fixed, steps = ARITHMETICS[arithmetic], steps_of(controller)
    library = compiled(code(controller, "c", fixed), tmp_path)
    agents = [CompiledAgent(library, steps, i, fixed) for i in range(system.m)]
    ours = run(system, [ModelAgent(step, fixed) for step in steps], SET_POINTS, count)
    assert ours == run(system, agents, SET_POINTS, count)
    assert len({tuple(u) for u in ours}) > 10


@pytest.mark.parametrize("arithmetic", ARITHMETICS)
@pytest.mark.parametrize("name", MADE)
def test_the_run_in_integers_is_the_exact_model(name: str, arithmetic: str) -> None:
    system, controller = MADE[name]
    fixed, steps = ARITHMETICS[arithmetic], steps_of(controller)
    ours = run(system, [FixedAgent(step, fixed) for step in steps], SET_POINTS, 300)
    assert ours == run(system, [ModelAgent(step, fixed) for step in steps], SET_POINTS, 300)


@pytest.mark.parametrize("arithmetic", ARITHMETICS)
@pytest.mark.parametrize("name", MADE)
def test_structured_text_is_the_exact_model(name: str, arithmetic: str) -> None:
    system, controller = MADE[name]
    fixed, steps = ARITHMETICS[arithmetic], steps_of(controller)
    files = code(controller, "st", fixed)
    agents = [IntegerBlock(files[f"{s.identifier}.st"], steps, s.position, fixed) for s in steps]
    ours = run(system, [ModelAgent(step, fixed) for step in steps], SET_POINTS, 200)
    assert ours == run(system, agents, SET_POINTS, 200)


@pytest.mark.parametrize("name", MADE)
def test_many_bits_follow_the_run_in_doubles(name: str) -> None:
    system, controller = MADE[name]
    fixed, steps = FixedPoint(24, dict.fromkeys("yruxz", Fraction(60))), steps_of(controller)
    ours = run(system, [FixedAgent(step, fixed) for step in steps], SET_POINTS, 25)
    doubles = run(system, [AgentRun(step) for step in steps], SET_POINTS, 25)
    for found, wanted in zip(ours, doubles, strict=True):
        assert found == pytest.approx(wanted, abs=1e-4)


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
def test_signals_at_the_ends_of_their_ranges_overflow_nothing(tmp_path: Path) -> None:
    """Sums that nearly fill 64 bits, with every sign: partial sums stay within them, too."""
    controller = MADE["every signal"][1]
    fixed = FixedPoint(27, dict.fromkeys("yruxz", Fraction(1)))
    steps = steps_of(controller)
    for step in steps:
        for kind, rows in (("u", step.u), ("x", step.x), ("z", step.z)):
            for row in rows:
                whole = fixed.sum(row, kind)
                assert sum(abs(m) for m, _ in whole.terms) * 2**31 + whole.unit < 2**63
    library, rng = compiled(code(controller, "c", fixed), tmp_path), random.Random(1)
    for position, step in enumerate(steps):
        theirs, ours = CompiledAgent(library, steps, position, fixed), FixedAgent(step, fixed)
        for _ in range(200):

            def ends(size: int) -> list[float]:
                return [rng.choice((-9.0, 9.0)) for _ in range(size)]

            y, r = ends(step.outputs), ends(step.references)
            heard = {(kind, j): ends(size) for kind, j, size in step.received}
            assert theirs(y, r, heard) == ours(y, r, heard)


def test_sums_that_could_leave_64_bits_are_refused() -> None:
    row: Row = ((Fraction(1000), Signal("y", 0, 0)), (Fraction(-1000), Signal("z", 0, 0)))
    FixedPoint(20).sum(row, "u")
    with pytest.raises(InputError, match="take 5 fractional bits less"):
        FixedPoint(26).sum(row, "u")
    with pytest.raises(InputError, match="could leave 64 bits"):
        FixedPoint(20, {"y": 10**6, "z": Fraction(1, 1000)}).sum(row, "u")


def test_what_is_no_arithmetic_is_refused() -> None:
    for bits in (-1, 49, True, 1.5):
        with pytest.raises(UsageError, match="bits"):
            FixedPoint(bits)  # type: ignore[arg-type]
    for ranges in ({"w": 1}, {"y": 0}, {"y": 2**31}):
        with pytest.raises(UsageError):
            FixedPoint(8, ranges)


def test_numbers_are_rounded_alike_with_both_signs() -> None:
    fixed = FixedPoint(3)
    for eighths in ("1/16", "3/16", "1/3", "5/7"):
        assert fixed.number(-Fraction(eighths)) == -fixed.number(Fraction(eighths))
        assert abs(fixed.number(Fraction(eighths)) - Fraction(eighths)) <= Fraction(1, 16)


def test_the_range_of_a_signal_fits_into_32_bits() -> None:
    for text in ("1/1000", "1", "3/2", "1000", "1024", "2000000000"):
        bits = FixedPoint(0, {"y": Fraction(text)}).fractional("y")
        assert Fraction(text) * 2**bits <= LARGEST and bits <= 30
        assert bits == 30 or Fraction(text) * 2 ** (bits + 1) > LARGEST


@pytest.mark.parametrize("language", ["c", "st", "json"])
def test_the_controller_beside_the_code_is_what_the_code_is(language: Any) -> None:
    controller = MADE["set-points"][1]
    for fixed in (None, FixedPoint(7)):
        files = export_controller(controller, language, fixed)
        beside = read_controller(files["controller.json"])
        assert beside == in_code(controller, fixed) and beside.system == controller.system
        pairs = zip(beside.matrices(), controller.matrices(), strict=True)
        entries = [
            (a, b) for M, N in pairs for p, q in zip(M.rows(), N.rows(), strict=True)
            for a, b in zip(p, q, strict=True)
        ]  # fmt: skip
        assert any(a != b for a, b in entries)
        for a, b in entries:
            assert a == (Fraction(float(b)) if fixed is None else fixed.number(b))


@pytest.mark.parametrize("fixed", [None, FixedPoint(7), FixedPoint(12, {"u": 3})])
@pytest.mark.parametrize("name", MADE)
def test_controller_and_equations_have_the_numbers_and_the_limits_of_the_code(
    name: str, fixed: FixedPoint | None
) -> None:
    _, controller = MADE[name]
    files, steps = export_controller(controller, "c", fixed), steps_of(controller)
    beside = steps_of(read_controller(files["controller.json"]))
    document = json.loads(files["equations.json"])
    for own, step, told in zip(beside, steps, document["agents"], strict=True):
        # the ends at which the C cuts off, read in its text
        source = files[f"{step.identifier}.c"]
        found = {
            int(k): (Fraction(float(low)), Fraction(float(high)))
            for k, low, high in re.findall(r"u\[(\d+)\] < (\S+) .* > (\S+) \?", source)
        }
        scale = 1 if fixed is None else 2 ** fixed.fractional("u")
        ends = [
            None if k not in found else (found[k][0] / scale, found[k][1] / scale)
            for k in range(len(step.limits))
        ]
        assert list(own.limits) == ends
        assert [each and tuple(map(Fraction, each)) for each in told["limits"]] == ends
        for key, rows in (("u", own.u), ("next x", own.x), ("next z", own.z)):
            terms = [[Fraction(c) for c, _, _ in row if Fraction(c)] for row in told[key]]
            assert terms == [[c for c, _ in row] for row in rows]
        if "no code has" in name:
            assert all(pair not in ends for pair in step.limits)
            assert says(files[f"{step.identifier}.h"], "limits rounded")


def test_limits_between_which_no_value_of_the_code_lies_are_refused() -> None:
    near = MADE["limits that no code has"][1]
    with refusal(InputError):
        export_controller(near, "c", FixedPoint(4, {"u": 2**30}))
    nearer = near.with_saturation((((Fraction(0), Fraction(1, 10**400)),), (None,)))
    with refusal(InputError):
        export_controller(nearer, "c")


def two() -> MultiChannelSystem:
    """Unstable without a controller."""
    return MultiChannelSystem(
        [["11/10", "1/10"], ["1/10", "21/20"]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        time="discrete",
    )


def test_fewest_bits_are_proved_for_every_rounding() -> None:
    controller = local_controllers(two(), [[["-7/10"]], [["-3/5"]]])
    safe = least_fixed_point(two(), controller)
    assert check(safe.proof).verdict == "VALID"
    assert certify_controller(two(), safe.fixed.rounded(controller)).stable
    half, rng = Fraction(1, 2 ** (safe.fixed.bits + 1)), random.Random(3)
    for _ in range(20):
        gains = [c + half * rng.choice((-1, 1)) for c in (-Fraction(7, 10), -Fraction(3, 5))]
        near = local_controllers(two(), [[[c]] for c in gains])
        assert certify_controller(two(), near).stable
    # with a bit less a rounding fails, or no proof was found
    assert safe.fixed.bits > 0


def test_a_loop_that_is_not_stable_has_no_fewest_bits() -> None:
    with refusal(LimitReached):
        least_fixed_point(two(), local_controllers(two(), [[[0]], [[0]]]))


RANGES = {"y": 2, "r": 4, "u": 16, "x": 2, "z": 1}


def started(kind: str, fixed: FixedPoint, y: list[float], r: list[float], folder: Path) -> Any:
    """An agent in fixed point that starts at rest."""
    steps = fixed.steps(lag())
    if kind == "integers":
        agent: Any = FixedAgent(steps[0], fixed)
        agent.start(y, r)
    elif kind == "text":
        agent = IntegerBlock(code(lag(), "st", fixed)["left.st"], steps, 0, fixed)
        agent.memory["start"] = True
        agent(y, r, {})
        agent.memory["start"] = False
    else:
        if COMPILER is None:
            pytest.skip("there is no C compiler")
        agent = CompiledAgent(compiled(code(lag(), "c", fixed), folder), steps, 0, fixed)
        agent.start(y, r)
    return agent


@pytest.mark.parametrize("kind", ["integers", "text", "compiled"])
@pytest.mark.parametrize("bits", [6, 20])
def test_in_fixed_point_an_agent_without_an_integrator_starts_at_rest(
    kind: str, bits: int, tmp_path: Path
) -> None:
    fixed, y, r = FixedPoint(bits, RANGES), [0.3], [0.1]
    agent = started(kind, fixed, y, r, tmp_path)
    told = [agent(y, r, {})[0] for _ in range(40)]
    # 1/(1 - A) of the rounded controller is at most 4, and start has numbers of as many bits
    assert max(told) - min(told) < 16 * 2.0**-bits
    fresh = FixedAgent(fixed.steps(lag())[0], fixed)
    assert abs(fresh(y, r, {})[0] - told[0]) > 0.01
    again = started("integers", fixed, y, r, tmp_path)
    # the first period of a block was a step already
    first = kind == "text"
    assert told == [again(y, r, {})[0] for _ in range(40 + first)][first:]


def test_no_rest_whose_sums_could_leave_64_bits_is_in_the_code() -> None:
    fine, M = FixedPoint(20), Matrix.from_rows
    slow = AgentProgram(
        "left",
        0,
        1,
        private_update=LinearMap({0: M([["1"]])}, {}, M([["1048575/1048576"]])),
        input=LinearMap({}, {}, M([["1/2"]])),
    )
    controller = Controller("discrete", "", (slow,))
    assert steps_of(controller)[0].start is not None
    assert [step.start is None for step in fine.steps(controller)] == [True]
    assert "left_start" not in code(controller, "c", fine)["left.h"]
    assert says(code(controller, "c", fine)["left.h"], "states start")
