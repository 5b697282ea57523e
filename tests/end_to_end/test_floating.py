"""Designing in floating point, certifying and cross-checking, as a user does."""

import json
from fractions import Fraction
from typing import Any

import pytest

from mcexact.answer.protocol import encode
from mcexact.crosschecks.gallery import exhibit, exhibits
from mcexact.model.controller import save_controller
from mcexact.model.files import save_system
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.floating import (
    both_methods,
    near_the_boundary,
    ring_plant,
    timed_design,
    valid_by_copied_checker,
)
from tests.end_to_end.command_line import run
from tests.synthesis.three_channels import three_channels
from tests.wording import says


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Both plants, a floating-point controller for each, and the certificates."""
    place = tmp_path_factory.mktemp("floating")
    for time, bound in (("continuous", "--rate=1"), ("discrete", "--radius=4/5")):
        save_system(three_channels(time), place / f"{time}.json")
        done = run(
            *("design", "observer", str(place / f"{time}.json"), bound, "--arithmetic=float"),
            *("-o", str(place / f"{time}-controller.json")),
            *("--certificates", str(place / time)),
        )
        assert done.status == 0, done.stderr
        assert "closed loop certified" in done.stdout
        assert "distance to instability" in done.stdout
    return place


def certified(folder, time, *options):
    """Certify the controller that was written."""
    return run(
        "certify", str(folder / f"{time}.json"), str(folder / f"{time}-controller.json"), *options
    )


@pytest.mark.parametrize(
    ("time", "bound"), [("continuous", "--rate=1"), ("discrete", "--radius=4/5")]
)
def test_the_written_controller_is_certified_again(folder, time, bound):
    done = certified(folder, time, bound, "--certificates", str(folder / "again"))
    assert done.status == 0 and "every one satisfies" in done.stdout
    for written in (folder / time / "stability.json", folder / "again" / "stability.json"):
        checked = run(
            "check", "--statements", str(written), "--system", str(folder / f"{time}.json")
        )
        assert checked.status == 0 and "): every eigenvalue of A has" in checked.stdout


@pytest.mark.parametrize("method", ["polynomial", "lyapunov"])
def test_a_no_ends_with_status_1_and_is_proved(folder, tmp_path, method):
    done = certified(
        *(folder, "continuous", "--rate=50", "--method", method, "--json"),
        *("--certificates", str(tmp_path)),
    )
    assert done.status == 1
    answer = json.loads(done.stdout)
    assert answer["certified"] is False and answer["bound"] == "50"
    checked = run("check", "--statements", str(tmp_path / answer["stability"]["certificate"]))
    assert checked.stdout.startswith("VALID ")
    assert says(checked.stdout, "eigenvalue")


def test_the_largest_rate_is_found(folder):
    answer = json.loads(certified(folder, "continuous", "--largest", "--json").stdout)
    assert answer["certified"] and Fraction(answer["largest"]) > 1


def test_the_design_as_json_tells_proof_from_measurement(folder):
    done = run(
        *("design", "observer", str(folder / "continuous.json"), "--rate=1"),
        *("--arithmetic=float", "--json"),
    )
    answer = json.loads(done.stdout)
    assert answer["certified_bound"] == "1" and answer["order"] == 9
    assert set(answer["floating_point"]) == {
        "largest_gain",
        "spectral",
        "numerical",
        "distance_to_instability",
    }


@pytest.mark.parametrize(
    ("options", "status", "message"),
    [
        (["--radius=1/2"], 2, "a radius is for discrete time"),
        (["--rate=0"], 2, "expected a rate above 0"),
        (["--rate=1", "--largest"], 2, "give either a rate (radius) or `largest`, not both"),
        (["--method=guess"], 2, "guess"),
    ],
)
def test_wrong_usage_of_certify_gets_one_message(folder, options, status, message):
    done = certified(folder, "continuous", *options)
    assert done.status == status and message in done.stderr
    assert len(done.messages) == 1


def test_a_controller_of_another_plant_is_malformed_input(folder, tmp_path):
    other = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    save_controller(local_controllers(other, [[[-3]]]), tmp_path / "other.json")
    done = run("certify", str(folder / "continuous.json"), str(tmp_path / "other.json"))
    assert done.status == 2 and "expected the agents" in done.stderr
    missing = run("certify", str(folder / "continuous.json"), str(tmp_path / "none.json"))
    assert missing.status == 3


def test_the_cross_check_names_the_disagreements_and_what_answered(tmp_path):
    save_system(exhibit("weak-input").make(), tmp_path / "plant.json")
    answer = json.loads(run("crosscheck", str(tmp_path / "plant.json"), "--json").stdout)
    assert "joint controllability" in answer["disagreements"]
    assert Fraction(answer["fixed_mode_nearby"]["within"]) < Fraction(1, 10**12)
    [recorded] = answer["exhibits"]
    assert recorded["exhibit"] == "weak-input"
    done = run("crosscheck", str(tmp_path / "plant.json"))
    assert done.status == 0
    assert says(done.stdout, "wrong floating")
    assert f"{len(answer['disagreements'])} wrong" in done.stdout
    assert "numpy.linalg.matrix_rank(control.ctrb(A, B))" in done.stdout
    assert "a plant nearby with a fixed mode, decided exactly" in done.stdout
    assert says(done.stdout, "recorded wrong")


def test_the_exhibits_are_listed_and_written_as_a_page(tmp_path):
    page = tmp_path / "exhibits.html"
    done = run("crosscheck", "--exhibits", "--html", str(page), "--json")
    assert done.status == 0
    shown = json.loads(done.stdout)["exhibits"]
    assert [each["exhibit"] for each in shown] == [each.name for each in exhibits()]
    assert all(each["recorded"]["floating"] != each["exact"] for each in shown)
    assert all(each["exhibit"] in page.read_text() for each in shown)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give either FILE or --exhibits"),
        (["plant.json", "--exhibits"], "give either FILE or --exhibits"),
        (["plant.json", "--html", "page.html"], "--html goes with --exhibits"),
    ],
)
def test_wrong_usage_of_crosscheck_gets_one_message(arguments, message):
    done = run("crosscheck", *arguments)
    assert done.status == 2 and message in done.stderr


def test_the_cross_check_of_nonsense_is_malformed_input():
    done = run("crosscheck", "-", stdin=b"{}")
    assert done.status == 3 and len(done.messages) == 1


def test_a_ring_is_certified_by_blocks_and_checked_by_a_copy():
    timed = timed_design(ring_plant(0, 5, 4))
    assert timed.design.loop.closed.dimension == 5 + 4 * 5
    proof: Any = timed.design.loop.proof
    assert proof.evidence.transformation is not None
    assert min(timed.ratios) > 0
    valid_by_copied_checker(encode(timed.design.loop.proof))


@pytest.mark.parametrize("n", [4, 8])
def test_loops_are_certified_by_both_methods(n):
    both_methods(n)


def test_an_abscissa_near_the_boundary_is_told_apart():
    near_the_boundary(20)
