"""Proved bounds hold for the trajectory, and are left out where nothing is proved."""

from __future__ import annotations

from decimal import Decimal, localcontext
from fractions import Fraction

import pytest

from mcexact.answer.loops import LyapunovMethod, StabilityVerdict
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.system import MultiChannelSystem
from mcexact.report.simulation import SimulationReport
from mcexact.simulation.envelope import Envelope, SimulatedLoop, proved_envelope, simulated_loop
from mcexact.simulation.trajectory import Trajectory, simulate


def moved(time: str, **options: object) -> Trajectory:
    """Two coupled states, which a controller with a state and a set-point slows down."""
    A = [[0, 1], [-2, -1]] if time == "continuous" else [["1/2", "1/2"], [0, "1/3"]]
    plant = MultiChannelSystem(A, [[[0], [1]]], [[[1, 0]]], time=time)
    keep = LinearMap({0: Matrix.from_rows([["1/8"]])}, private=Matrix.from_rows([["-1/2"]]))
    send = LinearMap(private=Matrix.from_rows([["1/8"]]), reference=Matrix.identity(1))
    agent = AgentProgram("1", 0, 1, private_update=keep, input=send)
    options = {"initial": [3, -1], **options}
    return simulate(plant, Controller(time, "", (agent,)), **options)  # type: ignore[arg-type]


def envelope_of(run: Trajectory) -> Envelope:
    found = proved_envelope(run)
    assert found is not None
    return found


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("reference", [0, 2])
def test_every_output_and_state_stays_inside(time: str, reference: int) -> None:
    run = moved(time, reference=[reference], disturbances=[(0, [1])])
    found = envelope_of(run)
    assert found.proof.stable and found.proof.region.edge == found.bound
    decay = found.decay(run.times)
    for k, snapshot in enumerate(run.snapshots):
        pairs = [*zip(snapshot.outputs[0], found.outputs, strict=True)]
        pairs += zip(snapshot.plant, found.state, strict=True)
        for value, (rest, size) in pairs:
            assert abs(float(value) - float(rest)) <= size * decay[k] * (1 + 1e-9) + 1e-9


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_value_at_rest_is_where_the_trajectory_ends(time: str) -> None:
    run = moved(time, reference=[2], horizon=60)
    [(rest, _)] = envelope_of(run).outputs
    assert float(run.snapshots[-1].outputs[0][0]) == pytest.approx(float(rest), abs=1e-2) and rest


SCALES = [
    "0", "1e-400", "1e-324", "1e-320", "1e-310", "1e-200", "1e-163", "1e-161", "1e-17", "1/3", "7",
    "1e16", "123456789/1000", "1e154", "1e155", "1e300", "1e309", f"1/{3**700}", f"{7**500}/3",
]  # fmt: skip


def solved(M: list[list[Fraction]], right: list[Fraction]) -> list[Fraction]:
    """M⁻¹ right for a nonsingular M, by elimination in plain lists."""
    rows = [[*row, value] for row, value in zip(M, right, strict=True)]
    for k in range(len(rows)):
        pivot = next(i for i in range(k, len(rows)) if rows[i][k])
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(len(rows)):
            if i != k:
                factor = rows[i][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return [row[-1] for row in rows]


def expected(
    time: str, proof: StabilityVerdict, start: list[Fraction], r: Fraction
) -> list[Fraction]:
    """The value at rest of the output of `moved`, and the square of its size."""
    half, zero, one = Fraction(1, 2), Fraction(0), Fraction(1)
    M = {
        "continuous": [[zero, one, zero], [-2 * one, -one, one / 8], [one / 8, zero, -half]],
        "discrete": [[half, half, zero], [zero, one / 3, one / 8], [one / 8, zero, -half]],
    }[time]
    steady = one if time == "discrete" else zero
    away = [[steady * (i == j) - M[i][j] for j in range(3)] for i in range(3)]
    rest = solved(away, [zero, r, zero])
    evidence = proof.evidence
    assert isinstance(evidence, LyapunovMethod)
    P = [list(row) for row in evidence.blocks[0].P.rows()]
    off = [x - y for x, y in zip([*start, zero], rest, strict=True)]
    V = sum((off[i] * P[i][j] * off[j] for i in range(3) for j in range(3)), zero)
    return [rest[0], solved(P, [one, zero, zero])[0] * V]


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("scale", SCALES)
def test_no_bound_is_too_small_at_any_scale(time: str, scale: str) -> None:
    given: dict[str, object] = {"arithmetic": "exact"}
    if time == "continuous":
        given = {"arithmetic": "multiprecision", "points": 1, "digits": 20}
    for reference in ("0", SCALES[-1 - SCALES.index(scale)]):
        start = [Fraction(scale), -Fraction(scale) / 3]
        run = moved(time, initial=start, reference=[Fraction(reference)], horizon=1, **given)
        found = envelope_of(run)
        rest, square = expected(time, found.proof, start, Fraction(reference))
        [(at_rest, size)] = found.outputs
        assert at_rest == rest
        assert square <= size**2 <= square * (1 + Fraction(1, 2**60))
        report = SimulationReport(SimulatedLoop("", run, None, found, ()))
        printed = report.tables()[1].rows[0]
        assert Fraction(printed[2]) ** 2 >= square
        assert abs(Fraction(printed[1]) - rest) <= Fraction(printed[3])
        [shown] = report.as_json()["proved_bounds"]["outputs"]
        if shown["size"] is not None:
            assert min(Fraction(shown["size"]), Fraction(repr(shown["size"]))) ** 2 >= square
        if shown["rest"] is not None:
            off = [abs(Fraction(each) - rest) for each in (shown["rest"], repr(shown["rest"]))]
            assert max(off) <= Fraction(repr(shown["rounding"]))


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_decay_is_rounded_up_from_the_first_time_to_the_least_float(time: str) -> None:
    found = envelope_of(moved(time, horizon=2))
    times = [Fraction(t) for t in (0, 1, 2, 3, 7, 100, 1000, 3000, 10**5)]
    for t, shown in zip(times, found.decay(times), strict=True):
        with localcontext(prec=60):
            bound = Decimal(found.bound.numerator) / Decimal(found.bound.denominator)
            exact = bound ** int(t) if time == "discrete" else (-bound * int(t)).exp()
        assert Decimal(shown) >= exact * (1 - Decimal("1e-50"))
        assert shown <= float(exact) * (1 + 1e-15) + 1e-323


@pytest.mark.parametrize("radius", ["1/3", "0.99999", "0.9999999999"])
def test_the_printed_decay_is_not_faster_than_the_proved_one(radius: str) -> None:
    plant = MultiChannelSystem([[radius]], [[[1]]], [[[1]]], time="discrete")
    idle = Controller("discrete", "", (AgentProgram("1", 0, 0),))
    report = SimulationReport(simulated_loop(plant, idle, horizon=2))
    assert report.done.envelope is not None
    note = report.tables()[1].note
    shown = Fraction(note.removeprefix("d(t) = ").partition("^t")[0])
    assert report.done.envelope.bound <= shown < 1


def test_nothing_is_proved_where_a_signal_changes() -> None:
    assert proved_envelope(moved("continuous", steps=[(1, [1])])) is None
    assert proved_envelope(moved("continuous", ramps=[(0, [1])])) is None


def test_nothing_is_proved_of_an_unstable_loop() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    idle = Controller("continuous", "", (AgentProgram("1", 0, 0),))
    assert proved_envelope(simulate(plant, idle, horizon=1)) is None
