"""Runs on the command line, and how they start."""

from __future__ import annotations

import csv
import json
from pathlib import Path

from mcexact import MultiChannelSystem, save_controller, save_system
from mcexact.constructions import sampled_system
from mcexact.designs import local_controllers
from tests.cli.calling import call
from tests.wording import says


def test_one_number_is_that_of_all_states(tmp_path: Path) -> None:
    plant = MultiChannelSystem([[-1, 0], [0, -2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    files = str(tmp_path / "plant.json"), str(tmp_path / "gains.json")
    save_system(plant, files[0])
    save_controller(local_controllers(plant, [[[-1]], [[-1]]]), files[1])
    starts = []
    for initial in ("3", "3,3", "0"):
        run = str(tmp_path / "run.csv")
        status, _, said = call("simulate", *files, "--initial", initial, "-o", run)
        assert status == 0, said
        with open(run, encoding="utf-8") as file:
            head, first, *_ = csv.reader(file)
        starts.append([float(x) for name, x in zip(head, first, strict=True) if name != "t"])
    assert starts[0] == starts[1] and 3.0 in starts[0]
    assert set(starts[2]) == {0.0}
    status, _, said = call("simulate", *files, "--initial", "1,2,3")
    assert status == 3 and "expected 2 numbers, found 3" in said


def tank(tmp_path: Path) -> tuple[str, str]:
    """Files of a plant in continuous time, and of gains for its samples at 1/4, one step late."""
    plant = MultiChannelSystem([["-1/4"]], [[[1]]], [[[1]]])
    files = str(tmp_path / "plant.json"), str(tmp_path / "gains.json")
    save_system(plant, files[0])
    save_controller(local_controllers(sampled_system(plant, "1/4", 1), [[[-1]]]), files[1])
    return files


REAL = ("--step", "1/4", "--late", "1", "--horizon", "20")


def test_the_real_loop_is_shown_beside_the_ideal_one(tmp_path: Path) -> None:
    files, csv_file = tank(tmp_path), tmp_path / "run.csv"
    options = ("--limits=-1/2,1/2", "--quantize-outputs", "8:-2,2", "--quantize-inputs", "1/64")
    status, told, said = call("simulate", *files, *REAL, *options, "-o", str(csv_file))
    assert status == 0 and "warning" not in said, said
    told = " ".join(told.split())
    assert "sampled every 1/4, inputs 1 step late; code: double precision" in told
    assert (
        says(told, "limits steps") and "-0.5 to 0.5" in told and "0.0156 from -2 to 1.98438" in told
    )
    assert "y 1 settles after" in told and "u 1: steps at a limit" in told
    assert says(told, "closed stable") and "VALID" in told
    with csv_file.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["t"]) for row in rows[:3]] == [0, 0.25, 0.5] and len(rows) == 81
    assert max(abs(float(row["u 1"])) for row in rows) == 0.5
    assert max(abs(float(row["ideal u 1"])) for row in rows) == 1.0
    assert all(float(row["measured y 1"]) * 64 % 1 == 0 for row in rows)
    assert all(float(row["computed u 1"]) == -float(row["measured y 1"]) for row in rows)


def test_the_document_of_a_real_loop_has_both(tmp_path: Path) -> None:
    files = tank(tmp_path)
    status, told, _ = call("simulate", *files, *REAL, "--limits=-1/2,1/2", "--json")
    document = json.loads(told)
    real = document["real"]
    assert status == 0 and (real["step"], real["late"], real["limits"]) == (0.25, 1, [[-0.5, 0.5]])
    assert len(real["times"]) == len(document["times"]) == 81
    [agent], [put], [out] = real["agents"], real["inputs"], real["outputs"]
    assert max(abs(u) for (u,) in agent["inputs"]) == put["largest_modulus"]["real"] == 0.5
    assert put["largest_modulus"]["ideal"] == 1.0 and put["steps_at_a_limit"] > 0
    assert 0 < out["settled"]["ideal"] and out["rest"] == 0.0


def test_pictures_and_pages_show_the_real_loop(tmp_path: Path) -> None:
    files = tank(tmp_path)
    for name in ("run.png", "run.html"):
        status, _, said = call(
            "simulate", *files, *REAL, "--limits=-1/2,1/2", "-o", str(tmp_path / name)
        )
        assert status == 0, said
    assert (tmp_path / "run.png").read_bytes()[:4] == b"\x89PNG"
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert says(page, "outputs real") and "Limits of inputs: -0.5 to 0.5." in page


def test_options_of_the_real_loop_are_checked(tmp_path: Path) -> None:
    files = tank(tmp_path)
    for options, told in (
        (("--late", "1"), "add --step"),
        ((*REAL, "--arithmetic", "exact"), "--arithmetic is not for the real loop"),
        ((*REAL, "--fractions"), "--fractions is not for the real loop"),
        ((*REAL, "--cosines", "1:2"), "--cosines is not for the real loop"),
        (("--cosines", "1"), "expected NUMBERS:OMEGA"),
        ((*REAL, "--limits", "3"), "expected two numbers, as in -1,1 or left:-1,1"),
        ((*REAL, "--quantize-inputs", "8:1"), "expected BITS:LOW,HIGH"),
        ((*REAL, "--quantize-inputs", "1/2:0,1"), "expected a number of bits, found 1/2"),
        ((*REAL, "--limits=0,1", "--limits=0,1"), "limits of every input are given twice"),
        ((*REAL, "--limits=,1"), "expected two numbers"),
        ((*REAL, "--limits=other:0,1"), "there is no channel 'other'"),
        ((*REAL, "--range", "3"), "add --fixed-point"),
        ((*REAL, "--fixed-point", "8", "--range", "w=3"), "expected one of y, r, u, x, z"),
        (("--code", "compiled"), "give the time between samples"),
    ):
        status, _, said = call("simulate", *files, *options)
        assert status in (2, 3) and told in said, said


def test_a_controller_for_another_step_is_warned_about(tmp_path: Path) -> None:
    status, _, said = call("simulate", *tank(tmp_path), "--step", "1/8", "--horizon", "3")
    assert status == 0 and says(said, "made another")


def test_the_help_names_every_option_that_makes_the_loop_real() -> None:
    told = " ".join(call("simulate", "--help")[1].split())
    listed = told.partition("the real loop is run")[0].rpartition("With ")[2]
    options = ("step", "limits", "quantize-outputs", "quantize-inputs", "fixed-point", "code")
    assert [name for name in options if f"--{name}" not in listed] == []


def test_design_certify_and_simulate_read_limits_in_the_same_way(tmp_path: Path) -> None:
    files, out = tank(tmp_path), []
    for limits in ("--limits=-1/2,1/2", "--limits=1:-1/2,1/2", "--limits=1[1]:-1/2,1/2"):
        status, told, _ = call("simulate", *files, *REAL, limits, "--json")
        assert status == 0
        out.append(json.loads(told)["real"]["limits"])
        status, _, said = call(
            "certify", *files, "--step", "1/4", "--late", "1", limits, "--no-box"
        )
        assert status == 0, said
    assert out == [[[-0.5, 0.5]]] * 3
    helps = [call(name, "--help")[1] for name in ("certify", "simulate")]
    helps.append(call("design", "decentralized", "--help")[1])
    assert all("--limits [AGENT:]LOW,HIGH" in each for each in helps)
