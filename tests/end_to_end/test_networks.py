"""Designing without an observer, and running it, as a user does."""

import json
import re
from fractions import Fraction

import pytest

from mcexact.model.controller import load_controller
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from tests.end_to_end.command_line import run
from tests.synthesis.test_extended import late
from tests.synthesis.three_channels import three_channels
from tests.wording import says


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The paper's example with and without delays, and two tanks."""
    place = tmp_path_factory.mktemp("networks")
    save_system(three_channels(), place / "example.json")
    save_system(late(), place / "late.json")
    tanks = MultiChannelSystem(
        [[-2, 1], [1, -2]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        time="discrete",
        neighbors={"1": ["2"], "2": ["1"]},
    )
    save_system(tanks, place / "tanks.json")
    return place


def designed(folder, *arguments, status=0):
    done = run("design", *arguments)
    assert done.status == status, done.stderr
    return done


def test_both_orders_are_in_the_output(folder, tmp_path):
    spectrum = tmp_path / "spectrum.json"
    spectrum.write_text(json.dumps({"closed_loop": ["-1", "-2", {"re": "-1", "im": "3"}]}))
    plant = str(folder / "example.json")
    told = designed(
        folder, "extended", plant, "--spectrum", str(spectrum), "-o", str(tmp_path / "c.json")
    ).stdout
    assert re.search(r"an observer instead +11\n", told)
    answer = json.loads(
        designed(folder, "extended", plant, "--spectrum", str(spectrum), "--json").stdout
    )
    assert (answer["order"], answer["observer_order"]) == (1, 11)
    assert answer["dimensions"] == {"1": 0, "2": 0, "3": 1}
    assert answer["closed_loop_polynomial"] == [20, 34, 18, 5, 1]


@pytest.mark.parametrize("network", ["lifted", "held"])
@pytest.mark.parametrize("effort", ["0", "5"])
def test_delayed_networks_run_from_their_files(folder, tmp_path, network, effort):
    plant, controller = str(folder / "late.json"), tmp_path / "controller.json"
    proofs = tmp_path / "proofs"
    designed(
        folder,
        *("extended", plant, "--radius", "1/2", "--network", network),
        *("--effort", effort, "-o", str(controller), "--certificates", str(proofs)),
    )
    # A small search may prove a box around a loop, and a plant near this one whose loop fails; and
    # of a loop its cost, its margins and its peaks, whose matrices are proposed in floating point.
    kept = {path.stem for path in proofs.iterdir()} - {"box_stability", "failing_loop"}
    kept -= {
        "loop_cost",
        *(stem for stem in kept if stem.endswith(("_margin", "_bound", "_steps"))),
    }
    expected = {"fixed_spectrum", "manifest", "shared_dimensions", "stability"}
    if effort == "0":
        # The controller of the theorem has a spectrum, and gains for a single channel.
        expected |= {"closed_loop_spectrum"}
        expected |= {"single_channel_gains"} if network == "held" else set()
    assert kept == expected
    checked = run("check", "--statements", *map(str, sorted(proofs.iterdir())), "--system", plant)
    assert checked.status == 0, checked.stdout
    held = any(agent.hold for agent in load_controller(controller).agents)
    assert held == (network == "held")
    told = run("simulate", plant, str(controller))
    assert told.status == 0, told.stderr
    assert says(" ".join(told.stdout.split()), "closed stable")


def test_a_fixed_mode_is_status_1_and_leaves_the_certificate(folder, tmp_path):
    plant, proofs = str(folder / "example.json"), tmp_path / "proofs"
    out = tmp_path / "controller.json"
    arguments = ("--rate", "1", "-o", str(out), "--certificates", str(proofs))
    done = designed(folder, "decentralized", plant, *arguments, status=1)
    assert "moves the mode 1," in done.stderr
    assert not out.exists()
    assert {path.name for path in proofs.iterdir()} == {"fixed_spectrum.json", "manifest.json"}
    checked = run("check", "--statements", str(proofs / "fixed_spectrum.json"), "--system", plant)
    assert checked.status == 0
    assert "x - 1" in checked.stdout


@pytest.mark.parametrize("name", ["decentralized", "observer"])
def test_what_is_impossible_is_an_answer_in_json_too(folder, tmp_path, name):
    plant = tmp_path / "plant.json"
    document = json.loads((folder / "example.json").read_text(encoding="utf-8"))
    document["neighbors"] = {"1": [], "2": [], "3": []}
    plant.write_text(json.dumps(document), encoding="utf-8")
    done = designed(folder, name, str(plant), "--rate", "1", "--json", status=1)
    told = json.loads(done.stdout)
    assert (told["design"], told["possible"]) == (name, False)
    assert told["reason"] in done.stderr


def test_set_points_are_reached(folder, tmp_path):
    plant, controller = str(folder / "tanks.json"), tmp_path / "controller.json"
    proofs, run_file = tmp_path / "proofs", tmp_path / "run.csv"
    designed(
        folder,
        *("setpoint", plant, "--radius", "1/2", "--method", "observer", "-o", str(controller)),
        *("--certificates", str(proofs)),
    )
    assert (
        run("check", "--statements", str(proofs / "manifest.json"), "--system", plant).status == 0
    )
    done = run(
        *("simulate", plant, str(controller), "--reference=3,-1/2", "--horizon", "40"),
        *("-o", str(run_file)),
    )
    assert done.status == 0, done.stderr
    last = run_file.read_text().splitlines()[-1].split(",")
    assert [Fraction(entry) for entry in last[1:3]] == [3, Fraction(-1, 2)]


def test_analyze_says_what_is_fixed_with_delays_and_what_can_be_held(folder, tmp_path):
    done = run("analyze", str(folder / "late.json"), "--delayed", "--json")
    answer = json.loads(done.stdout)
    assert answer["lifted_fixed_spectrum"]["polynomial"] == [0, 1]
    assert answer["held_fixed_spectrum"]["polynomial"] == [1]
    assert answer["setpoint"]["solvable"] is False
    tanks = json.loads(run("analyze", str(folder / "tanks.json"), "--json").stdout)
    assert tanks["setpoint"]["solvable"] is True


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("extended", "--dimensions", "1,x,0", "--rate", "1"), "integers >= 0 such as 0,0,1"),
        (("extended", "--dimensions", "1,0", "--rate", "1"), "expected 3 dimensions"),
        (("extended", "--network", "held", "--rate", "1"), "discrete time"),
        (("decentralized", "--margin", "2"), "margin: expected a number above 0 and below 1"),
        (("decentralized", "--radius", "1/2"), "radius is for discrete time"),
        (("decentralized", "--rate", "1", "--agent", "9"), "9"),
    ],
)
def test_wrong_usage_is_told_in_one_line(folder, arguments, message):
    name, *rest = arguments
    done = run("design", name, str(folder / "example.json"), *rest)
    assert done.status in (2, 3)
    assert message in done.stderr
    assert len(done.messages) == 1
