"""The real loop beside the ideal one: samples, delays, limits, converters and the exported code."""

from __future__ import annotations

import math
import shutil
from fractions import Fraction
from typing import Any

import pytest

from mcexact.derived.sampling import sampled_system
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.export.fixed import FixedPoint
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.real import MOST_STEPS, Quantizer, RealRun, simulate_real
from tests.wording import refusal, worded

COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
STEP = Fraction(1, 5)


def tanks() -> MultiChannelSystem:
    """Two coupled tanks, each with an inflow and a measured level."""
    return MultiChannelSystem(
        [["-1/2", "1/4"], ["1/4", "-3/4"]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        names=["pump", "valve"],
        neighbors={"valve": ["pump"]},
    )


def lags(time: str) -> Controller:
    """Each agent a lag with a set-point."""
    [gain, pole, one] = [Matrix.from_rows([[Fraction(x)]]) for x in ("-1/3", "1/2", "1")]
    programs = [
        AgentProgram(
            name,
            0,
            1,
            private_update=LinearMap({i: gain}, private=pole, reference=one),
            input=LinearMap({i: gain}, private=gain, reference=one),
        )
        for i, name in enumerate(("pump", "valve"))
    ]
    return Controller(time, "", tuple(programs))


def largest(run: RealRun) -> float:
    """The largest distance of an output of the real loop from the ideal one."""
    return max(each.apart for each in run.outputs)


@pytest.mark.parametrize("late", [0, 1, 3])
def test_a_loop_in_which_nothing_is_real_but_the_code_follows_the_ideal_one(late: int) -> None:
    run = simulate_real(
        tanks(),
        lags("discrete"),
        step=STEP,
        late=late,
        initial=[1, "-1/2"],
        horizon=8,
        reference=[1, 2],
        steps=[("1/3", [0, -1])],
        ramps=[(2, ["1/7", 0])],
        disturbances=[(0, ["1/2", 0]), (STEP, [0, 1]), (3, [-1, 0])],
    )
    assert len(run.times) == 41 and run.times[-1] == 8
    assert largest(run) < 1e-11
    assert max(abs(y) for values in run.real.values("outputs").values() for y in values) > 0.5


def test_the_real_loop_is_that_of_its_equations() -> None:
    """Inputs are limited, then converted, then late; what is measured is converted first."""
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    controller = local_controllers(sampled_system(plant, "1/4", 2), [[["-5/4"]]])
    run = simulate_real(
        plant,
        controller,
        step="1/4",
        late=2,
        limits=[("-3/5", 1)],
        quantized_outputs="1/8",
        quantized_inputs=Quantizer(Fraction(1, 16)),
        initial=["7/3"],
        disturbances=[(1, ["1/10"])],
        horizon=10,
    )
    x, under_way = Fraction(7, 3), [Fraction(0)] * 2
    for k, (time, snapshot) in enumerate(zip(run.times, run.real.snapshots, strict=True)):
        assert time == Fraction(k, 4)
        measured = math.floor(x * 8 + Fraction(1, 2)) / Fraction(8)
        computed = -Fraction(5, 4) * measured
        limited = min(max(computed, -Fraction(3, 5)), Fraction(1))
        put = math.floor(limited * 16 + Fraction(1, 2)) / Fraction(16)
        assert run.measured[k] == [float(measured)] and run.computed[k] == [float(computed)]
        assert snapshot.inputs == [[float(put)]]
        assert snapshot.plant == pytest.approx([float(x)], abs=1e-12)
        under_way.append(put)
        x += (under_way.pop(0) + (Fraction(1, 10) if time >= 1 else 0)) / 4
    assert run.inputs[0].at_limit == sum(each.inputs == [[-0.625]] for each in run.real.snapshots)
    assert run.inputs[0].at_limit > 3


def test_messages_are_as_late_as_the_links() -> None:
    graph = NeighborGraph.from_names(("a", "b"), {"b": ["a"]}, {"b": {"a": 2}})
    plant = MultiChannelSystem(
        [["1/2", 0], [0, "1/3"]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        time="discrete",
        names=["a", "b"],
        neighbors=graph,
    )
    one = Matrix.from_rows([[1]])
    shared = AgentProgram("a", 1, 0, LinearMap({0: one}), hold={1: 1})
    told = AgentProgram("b", 0, 0, input=LinearMap({0: one}, {0: one * Fraction(1, 4)}))
    run = simulate_real(plant, Controller("discrete", "", (shared, told)), horizon=30)
    assert largest(run) < 1e-15
    inputs = run.real.values("inputs")["u b"]
    # y_a two steps late, and a quarter of x_a, which is y_a one step late, three steps late
    assert inputs[:5] == [0, 0, 1, 0.5, 0.5]


def test_a_controller_in_continuous_time_comes_near_its_loop_with_short_steps() -> None:
    apart = []
    for step in ("1/5", "1/20", "1/80"):
        run = simulate_real(
            tanks(), lags("continuous"), step=step, initial=[1, -1], reference=[1, 0], horizon=4
        )
        assert run.times == run.ideal.times
        apart.append(largest(run))
    assert apart[1] < apart[0] / 3 and apart[2] < apart[1] / 3


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
def test_compiled_code_computes_the_same_bits() -> None:
    def run(code: str) -> RealRun:
        return simulate_real(
            tanks(),
            lags("discrete"),
            step=STEP,
            late=1,
            limits=[(-1, 1), None],
            quantized_outputs="1/1000",
            reference=[1, "1/3"],
            horizon=20,
            code=code,  # type: ignore[arg-type]
        )

    assert run("interpreted").signals() == run("compiled").signals()
    assert "compiled" in repr(run("compiled"))


def test_compiled_code_needs_a_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "no-such-compiler")
    with refusal(UsageError):
        simulate_real(tanks(), lags("discrete"), step=STEP, code="compiled")


def test_settling_and_effort_are_those_of_the_signals() -> None:
    plant = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
    controller = local_controllers(plant, [[[0]]])
    run = simulate_real(plant, controller, initial=[8], horizon=9, disturbances=[(3, [2])])
    [out], [put] = run.outputs, run.inputs
    # from 1 at the time 3 to rest at 4: the distance is 3/2^k, and within 2 % after six steps
    assert (out.rest, out.peak, out.settled) == (4.0, (3.0, 3.0), (6, 6))
    assert put.peak == put.effort == (0.0, 0.0)
    short = simulate_real(plant, controller, initial=[8], horizon=8, disturbances=[(3, [2])])
    assert short.outputs[0].settled == (None, None)
    compared = {name: values for name, *values in short.compared()}
    assert worded(compared["y 1 settles after"])


def test_a_larger_input_has_more_effort() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    run = simulate_real(plant, local_controllers(plant, [[["-1/2"]]]), initial=[4], horizon=20)
    assert run.inputs[0].effort[0] == pytest.approx(16 / 3)
    tight = simulate_real(
        plant,
        local_controllers(plant, [[["-1/2"]]]),
        initial=[4],
        horizon=20,
        limits=[(-1, None)],
    )
    assert tight.inputs[0].peak == (2.0, 1.0)
    assert tight.inputs[0].at_limit == 3
    assert tight.realization.facts()[-1] == "limits of inputs: from -1 on"


def test_converters_have_the_nearest_value_within_their_range() -> None:
    converter = Quantizer.of_bits(3, -1, 1)
    assert [converter(x) for x in (-9, -1, -0.4, 0.1, 0.125, 0.74, 9)] == [
        *(-1.0, -1.0, -0.5, 0.0, 0.25, 0.75, 0.75)
    ]
    with pytest.raises(LimitReached):
        converter(math.inf)
    for bits, low, high in ((0, 0, 1), (53, 0, 1), (True, 0, 1), (8, 1, 1)):
        with pytest.raises(UsageError):
            Quantizer.of_bits(bits, low, high)
    with pytest.raises(UsageError, match="above 0"):
        Quantizer(Fraction(0))


def test_what_cannot_be_run_is_refused() -> None:
    discrete = sampled_system(tanks(), STEP)
    with refusal(UsageError):
        simulate_real(tanks(), lags("discrete"))
    with pytest.raises(UsageError, match="discrete time already"):
        simulate_real(discrete, lags("discrete"), step=1)
    with pytest.raises(UsageError, match="discrete time already"):
        simulate_real(discrete, lags("discrete"), late=1)
    with pytest.raises(UsageError, match=f"0 to {MOST_STEPS} steps"):
        simulate_real(discrete, lags("discrete"), horizon=MOST_STEPS + 1)
    with pytest.raises(UsageError, match=f"1 to {MOST_STEPS} steps"):
        simulate_real(tanks(), lags("continuous"), step="1/1000000", horizon=2)
    with pytest.raises(UsageError, match='expected "interpreted" or "compiled"'):
        simulate_real(discrete, lags("discrete"), code="assembler")  # type: ignore[arg-type]
    for limits in ([(0, 1)], [(0, 1), 3], [(0, 1), (2, 1)], [(0, 1), (1, 2, 3)]):
        with pytest.raises(InputError, match="limits"):
            simulate_real(discrete, lags("discrete"), limits=limits)
    with pytest.raises(InputError, match="expected 2 converters, found 1"):
        simulate_real(discrete, lags("discrete"), quantized_inputs=[1])


def test_numbers_beyond_doubles_are_told() -> None:
    plant = MultiChannelSystem([[10**9]], [[[1]]], [[[1]]], time="discrete")
    with pytest.raises(LimitReached, match="double precision"):
        simulate_real(plant, local_controllers(plant, [[[0]]]), horizon=100)


def test_a_real_loop_is_drawn_and_told() -> None:
    run = simulate_real(
        tanks(), lags("discrete"), step=STEP, limits=[(-1, 1), (None, 2)], horizon=4
    )
    outputs, inputs = run.plot().axes
    assert len(outputs.lines) == len(inputs.lines) == 4
    told = run.explain()
    assert "limits of inputs: -1 to 1, up to 2" in told and "y pump settles after" in told
    assert run.signals()["t"] == [float(t) for t in run.times]
    assert len({len(values) for values in run.signals().values()}) == 1


def test_limits_are_those_of_the_controller_or_else_of_the_plant() -> None:
    limited = tanks().with_limits({"pump": [["-1/2", "1/2"]]})
    run = simulate_real(limited, lags("discrete"), step=STEP, initial=[4, 4], horizon=4)
    assert run.inputs[0].at_limit > 0 and run.inputs[1].at_limit == 0
    assert run.inputs[0].peak[1] == 0.5 < run.inputs[0].peak[0]
    own = lags("discrete").with_saturation(((None,), ((Fraction(-1, 4), Fraction(1)),)))
    run = simulate_real(limited, own, step=STEP, initial=[4, 4], horizon=4)
    assert run.inputs[0].at_limit == 0 and run.inputs[1].peak[1] == 0.25


def test_limits_of_actuators_are_further_ones_where_the_controller_has_limits() -> None:
    half = Fraction(1, 2)
    own = lags("discrete").with_saturation((((-half, half),), ((-half, half),)))

    def run(limits: Any) -> RealRun:
        return simulate_real(tanks(), own, step=STEP, initial=[4, 4], horizon=4, limits=limits)

    wide, tight = run([(-1, 1), None]), run([("-1/4", None), None])
    assert wide.realization.limits == ((-half, half),) * 2
    assert "limits of inputs: -0.5 to 0.5" in wide.explain()
    assert [each.peak[1] for each in wide.inputs] == [0.5, 0.5]
    assert min(each.at_limit for each in wide.inputs) > 0
    assert tight.realization.limits == ((Fraction(-1, 4), half), (-half, half))
    assert tight.inputs[0].peak[1] == 0.25 and tight.inputs[0].at_limit > 0
    assert min(u for u, _ in tight.computed) == -0.5
    with refusal(InputError):
        run([(1, 2), None])


def test_steps_at_a_limit_are_counted_in_fixed_point() -> None:
    """The code in integers cuts off a little within limits that are no integers."""
    third = Fraction(1, 3)
    own = lags("discrete").with_saturation((((-third, third),), (None,)))
    counts = [
        simulate_real(tanks(), own, step=STEP, initial=[4, 4], horizon=4, fixed=fixed)
        .inputs[0]
        .at_limit
        for fixed in (None, FixedPoint(20, dict.fromkeys("yruxz", 16)))
    ]
    assert counts[0] == counts[1] > 3


def test_the_code_corrects_its_states_by_what_it_cuts_off() -> None:
    limits = (((Fraction(-1, 2), Fraction(1, 2)),),) * 2
    gains = [Matrix.from_rows([["1/3"]]), Matrix.from_rows([["-1/5"]])]
    runs = [
        simulate_real(
            tanks(),
            lags("discrete").with_saturation(limits, L),
            step=STEP,
            initial=[4, 4],
            horizon=4,
        )
        for L in ((), gains)
    ]
    for run in runs:
        assert max(figures.peak[1] for figures in run.inputs) == 0.5
    assert runs[0].measured != runs[1].measured
