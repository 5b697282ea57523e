"""What is shown of a simulation: norms, values, pictures, pages."""

import csv
import io
from fractions import Fraction

import pytest

from mcexact.cli import main
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap, save_controller
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import simulation_pictures, simulation_png
from mcexact.report.simulation import SimulationReport, shown_times, trajectory_csv
from mcexact.simulation.envelope import LARGEST, simulated_loop
from mcexact.simulation.trajectory import simulate
from tests.report.strict_html import external_addresses
from tests.wording import worded


def halving(time="discrete", gain="-1/2"):
    """x(t+1) = x + u, u = −x/2, without estimates."""
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time=time)
    program = LinearMap({0: Matrix.from_rows([[gain]])})
    return plant, Controller(time, "", (AgentProgram("1", 0, 0, input=program),))


def test_exact_values_are_written_exactly():
    run = simulate(*halving(), horizon=2)
    rows = list(csv.reader(io.StringIO(trajectory_csv(run, fractions=True))))
    assert rows == [
        ["t", "x[1]", "y 1", "u 1", "r 1"],
        ["0", "1", "1", "-1/2", "0"],
        ["1", "1/2", "1/2", "-1/4", "0"],
        ["2", "1/4", "1/4", "-1/8", "0"],
    ]


def test_exact_values_are_decimals_unless_fractions_are_asked_for():
    run = simulate(*halving(gain="-1/3"), horizon=2)
    rows = list(csv.reader(io.StringIO(trajectory_csv(run))))
    assert [row[:2] for row in rows[1:]] == [
        ["0", "1"],
        ["1", "0.66666666666666667"],
        ["2", "0.44444444444444444"],
    ]


def test_numbers_of_any_length_are_written():
    run = simulate(*halving(gain=f"-1/3{'0' * 99}"), horizon=50)
    last = trajectory_csv(run, fractions=True).splitlines()[-1].split(",")[1]
    numerator, denominator = last.split("/")
    assert len(denominator) > 4300 and set(numerator) <= set("0123456789")


def test_floats_are_written_with_all_their_digits():
    run = simulate(*halving("continuous"), horizon=1, points=2)
    rows = list(csv.reader(io.StringIO(trajectory_csv(run))))
    assert [float(row[0]) for row in rows[1:]] == [0.0, 0.5, 1.0]
    assert float(rows[2][1]) == run.snapshots[1].plant[0]


@pytest.mark.parametrize("states", [LARGEST, LARGEST + 1])
def test_a_loop_too_large_for_proofs_is_called_so(states: int) -> None:
    A = [[Fraction(int(i == j), 2) for j in range(states)] for i in range(states)]
    plant = MultiChannelSystem(A, [[[1]] * states], [[[1] * states]], time="discrete")
    controller = Controller("discrete", "", (AgentProgram("1", 0, 0),))
    done = simulated_loop(plant, controller, horizon=1, arithmetic="float")
    said = f"the loop has {states} states: beyond {LARGEST} nothing is proved here"
    assert any(said in fact for fact in SimulationReport(done).facts()) == (states > LARGEST)
    assert (done.spectrum is None) == (done.envelope is None) == (states > LARGEST)


def test_norms_and_rows():
    run = simulate(*halving(), horizon=30)
    assert run.state_norms()[:3] == [1.0, 0.5, 0.25]
    assert run.error_norms() == {}
    assert shown_times(run, 5) == [0, 8, 15, 22, 30] and shown_times(run, 1) == [0]


def test_few_signals_have_a_column_each() -> None:
    run = simulated_loop(*halving(), horizon=4, reference=[1])
    [table, bounds] = SimulationReport(run).tables(lines=3)
    assert table.columns == ("t", "y 1", "u 1", "r 1", "|x|")
    assert [row[:3] for row in table.rows] == [
        ("0", "1", "-0.5"), ("2", "0.25", "-0.125"), ("4", "0.0625", "-0.03125")
    ]  # fmt: skip
    assert bounds.rows == (("y 1", "0", "1", "0"),) and "d(t) = 0.55^t" in bounds.note


def test_many_signals_are_summed_up_by_the_largest() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]] * 9, [[[k]] for k in range(-8, 1)], time="discrete")
    agents = tuple(AgentProgram(str(k + 1), 0, 0) for k in range(9))
    table, *_ = SimulationReport(
        simulated_loop(plant, Controller("discrete", "", agents), horizon=3)
    ).tables()
    assert table.columns == ("t", "|y|", "|u|", "|x|") and table.rows[0][1] == "8"


def test_numbers_of_the_document_are_numbers_unless_fractions_are_asked_for() -> None:
    done = simulated_loop(*halving(), horizon=2)
    shown, exact = (SimulationReport(done, fractions).as_json() for fractions in (False, True))
    assert shown["state"] == [[1.0], [0.5], [0.25]] and shown["times"] == [0.0, 1.0, 2.0]
    assert exact["state"] == [["1"], ["1/2"], ["1/4"]]
    [agent] = exact["agents"]
    assert (agent["outputs"][1], agent["inputs"][1]) == (["1/2"], ["-1/4"])
    assert shown["proved_bounds"]["outputs"][0]["size"] == pytest.approx(1)


def test_errors_are_those_of_agents_that_share_estimates():
    estimate = AgentProgram("1", 1, 0, LinearMap(shared={0: Matrix.identity(1)}))
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    run = simulate(plant, Controller("discrete", "", (estimate,)), horizon=1)
    assert run.error_norms() == {"1": [1.0, 1.0]}


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_a_picture_has_the_same_bytes_again(time):
    done = simulated_loop(*halving(time, "-3/2"), horizon=Fraction(4))
    first, second = (simulation_png(done) for _ in range(2))
    assert first == second and first.startswith(b"\x89PNG")


def test_a_run_that_stays_at_zero_can_be_drawn():
    report = SimulationReport(
        simulated_loop(*halving(), initial=[Fraction(0)], horizon=Fraction(3))
    )
    assert report.file(".png").startswith(b"\x89PNG")


def test_a_loop_beyond_floats_is_drawn_without_its_spectrum():
    plant = MultiChannelSystem([["1e400"]], [[[1]]], [[[1]]], time="discrete")
    controller = Controller("discrete", "", (AgentProgram("1", 0, 0),))
    report = SimulationReport(simulated_loop(plant, controller, horizon=Fraction(3)))
    assert report.file(".png").startswith(b"\x89PNG")


def test_an_unstable_loop_is_called_so():
    report = SimulationReport(simulated_loop(*halving(gain=1)))
    assert "not stable" in " ".join(report.facts())
    assert report.as_json()["stable"] is False


def test_the_default_horizon_follows_the_spectrum():
    slow = simulated_loop(*halving(gain="-1/10")).run
    fast = simulated_loop(*halving(gain="-9/10")).run
    assert len(slow.times) > len(fast.times)


def test_an_unstable_loop_has_no_certified_slope_and_no_gains_no_picture():
    titles = {}
    for gain in ("1", "-1/2", "0"):
        drawn = simulation_pictures(simulated_loop(*halving(gain=gain)))
        titles[gain] = [each.title for each in drawn]
        told = " ".join(each.alternative for each in drawn)
        assert ("dashed line" in told) == (gain == "-1/2")
    assert titles["1"] == titles["-1/2"] and worded(titles["1"][-1])
    assert titles["0"] == titles["1"][:-1]


def test_what_comes_from_outside_is_escaped():
    plant, controller = halving()
    named = MultiChannelSystem(
        plant.A, [plant.B(0)], [plant.C(0)], time=plant.time, name="<script> & $x^$"
    )
    text = SimulationReport(simulated_loop(named, controller, horizon=3)).page().rendered()
    assert "<script>" not in text and "&lt;script&gt; &amp; $x^$" in text
    assert external_addresses(text) == []


def test_the_page_has_the_proof_of_its_bounds(tmp_path):
    plant, controller = halving()
    save_system(plant, tmp_path / "plant.json")
    save_controller(controller, tmp_path / "gains.json")
    page = tmp_path / "page.html"
    with pytest.raises(SystemExit) as ended:
        main(["simulate", *(str(tmp_path / f"{name}.json") for name in ("plant", "gains")),
              "--horizon", "3", "-o", str(page)])  # fmt: skip
    assert ended.value.code == 0
    text = page.read_text(encoding="utf-8")
    assert "Proved bounds" in text and ': <span class="yes">VALID' in text
