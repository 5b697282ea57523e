"""Designing an observer and running it, as a user does."""

import csv
import json
import shutil
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from mcexact import checker
from mcexact.model.controller import AgentProgram, Controller, load_controller, save_controller
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from tests.end_to_end.command_line import run
from tests.synthesis.three_channels import three_channels
from tests.wording import says


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Both plants, a designed controller for each, and the certificates."""
    place = tmp_path_factory.mktemp("observer")
    for time, bound in (("continuous", "--rate=1"), ("discrete", "--radius=1/2")):
        save_system(three_channels(time), place / f"{time}.json")
        done = run(
            "design",
            "observer",
            str(place / f"{time}.json"),
            bound,
            "-o",
            str(place / f"{time}-controller.json"),
            "--certificates",
            str(place / time),
        )
        assert done.status == 0, done.stderr
        assert "closed loop certified" in done.stdout
    return place


def test_the_copied_out_checker_accepts_what_was_written(folder, tmp_path):
    shutil.copytree(Path(checker.__file__).parent, tmp_path / "checker")
    for time in ("continuous", "discrete"):
        done = subprocess.run(
            [
                sys.executable,
                *("-S", "-E", "-m", "checker"),
                str(folder / time / "distributed_observer.json"),
                *("--system", str(folder / f"{time}.json")),
            ],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        assert done.stdout.startswith("VALID")


def test_a_spectrum_comes_from_a_file(folder, tmp_path):
    spectrum = tmp_path / "spectrum.json"
    roots = ["-3/2", {"re": "-1", "im": "2"}]
    spectrum.write_text(json.dumps({"feedback": roots, "error": [-1] * 11}))
    done = run(
        "design", "observer", str(folder / "continuous.json"), "--spectrum", str(spectrum), "--json"
    )
    assert done.status == 0, done.stderr
    answer = json.loads(done.stdout)
    assert answer["feedback_polynomial"] == ["15/2", 8, "7/2", 1]
    assert answer["agent"] == "1" and len(answer["error_polynomial"]) == 12


def test_a_wrong_length_is_malformed_input(folder, tmp_path):
    spectrum = tmp_path / "spectrum.json"
    spectrum.write_text('{"feedback": [-1, -1, -1], "error": [-1]}')
    done = run("design", "observer", str(folder / "continuous.json"), "--spectrum", str(spectrum))
    assert done.status == 3
    assert "expected 11 numbers" in done.stderr and str(spectrum) in done.stderr


def test_the_wrong_bound_is_wrong_usage(folder):
    done = run("design", "observer", str(folder / "continuous.json"), "--radius", "1/2")
    assert done.status == 2 and says(done.stderr, "radius discrete")


def test_impossible_is_status_1_and_leaves_the_certificate(folder, tmp_path):
    plant = json.loads((folder / "continuous.json").read_text())
    for channel in plant["channels"]:
        channel["C"] = [[1, 0, 0]]
    file = tmp_path / "blind.json"
    file.write_text(json.dumps(plant))
    out, proofs = tmp_path / "controller.json", tmp_path / "proofs"
    arguments = ("--rate", "1", "-o", str(out), "--certificates", str(proofs))
    done = run("design", "observer", str(file), *arguments)
    assert done.status == 1 and "do not observe" in done.stderr
    assert not out.exists()
    assert len(list(proofs.iterdir())) == 2
    assert (
        run("check", "--statements", *map(str, proofs.iterdir()), "--system", str(file)).status == 0
    )


def test_without_an_output_the_controller_is_printed(folder, tmp_path):
    done = run("design", "observer", str(folder / "discrete.json"), "--radius", "1/2")
    file = tmp_path / "printed.json"
    file.write_text(done.stdout)
    assert load_controller(file) == load_controller(folder / "discrete-controller.json")


def test_a_discrete_run_is_exact_down_to_zero(folder, tmp_path):
    out = tmp_path / "run.csv"
    plant, controller = folder / "discrete.json", folder / "discrete-controller.json"
    done = run("simulate", str(plant), str(controller), "--initial=1,-1/2,3", "-o", str(out))
    assert done.status == 0, done.stderr
    assert "exact arithmetic" in done.stdout and "stable" in done.stdout
    with out.open(newline="") as stream:
        rows = list(csv.reader(stream))
    assert rows[0][:5] == ["t", "x[1]", "x[2]", "x[3]", "shared 1[1]"]
    assert [Fraction(entry) for entry in rows[1][1:4]] == [1, Fraction(-1, 2), 3]
    assert all(Fraction(entry) == 0 for entry in rows[-1][1:])


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize(("suffix", "magic"), [("png", b"\x89PNG"), ("html", b"<!doctype html>")])
def test_a_picture_and_a_page_are_written(folder, tmp_path, time, suffix, magic):
    out = tmp_path / f"run.{suffix}"
    done = run(
        "simulate",
        str(folder / f"{time}.json"),
        str(folder / f"{time}-controller.json"),
        "--horizon=5",
        *("-o", str(out)),
        "--json",
    )
    assert done.status == 0, done.stderr
    assert out.read_bytes().startswith(magic)
    answer = json.loads(done.stdout)
    assert answer["stable"] is True and answer["time"] == time
    assert [each["name"] for each in answer["agents"]] == ["1", "2", "3"]
    assert len(answer["error_norms"]) == 3 and len(answer["state"]) == len(answer["times"])


def test_an_unstable_loop_is_simulated_and_nothing_is_proved(folder, tmp_path):
    plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    save_system(plant, tmp_path / "plant.json")
    idle = Controller("discrete", "", (AgentProgram("1", 0, 0),))
    save_controller(idle, tmp_path / "idle.json")
    files, page = (str(tmp_path / "plant.json"), str(tmp_path / "idle.json")), tmp_path / "run.html"
    done = run("simulate", *files, "-o", str(page))
    assert done.status == 0, done.stderr
    assert "not stable" in " ".join(done.stdout.split()) and "roved" not in done.stdout
    assert "VALID" not in done.stdout and "not stable" in page.read_text(encoding="utf-8")


def test_an_arc_that_is_missing_in_the_plant_stops_the_run(folder, tmp_path):
    plant = json.loads((folder / "discrete.json").read_text())
    plant["neighbors"]["2"] = []
    file = tmp_path / "cut.json"
    file.write_text(json.dumps(plant))
    done = run("simulate", str(file), str(folder / "discrete-controller.json"))
    assert done.status == 3 and "does not receive" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (("--initial=1,2",), 3, "expected 3 numbers, found 2"),
        (("--initial=1,x,2",), 2, "expected an integer"),
        (("--reference=1",), 3, "expected 4 numbers, found 1"),
        (("--steps=1,2,3,4@-1",), 3, "steps[0]: expected a time of at least 0"),
        (("--ramps=1@x",), 2, "expected an integer"),
        (("--disturbances=1",), 3, "disturbances[0]: expected 3 numbers"),
        (("--horizon=1/2",), 2, "expected a number of steps"),
        (("-o", "run.txt"), 2, ".csv, .png or .html"),
        (("--arithmetic=decimal",), 2, "is not one of"),
    ],
)
def test_what_does_not_fit_is_said_in_one_message(folder, arguments, status, message):
    plant, controller = folder / "discrete.json", folder / "discrete-controller.json"
    done = run("simulate", str(plant), str(controller), *arguments)
    assert done.status == status and message in done.stderr
    assert len(done.messages) == 1


def test_a_controller_for_another_time_domain_is_wrong_usage(folder):
    done = run(
        "simulate", str(folder / "continuous.json"), str(folder / "discrete-controller.json")
    )
    assert done.status == 2 and "discrete time" in done.stderr
