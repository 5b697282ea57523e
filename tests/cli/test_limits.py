"""Limits of inputs on the command line: proved, written into the controller, and compared."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mcexact import (
    Controller,
    Matrix,
    MultiChannelSystem,
    load_controller,
    save_controller,
    save_system,
)
from mcexact.designs import AgentProgram, LinearMap
from tests.end_to_end.command_line import run
from tests.wording import says

EVERYWHERE, REGION = "first-saturation", "first-saturation-region"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A stable plant with an integral controller, and an unstable one with a gain."""
    stable = MultiChannelSystem([[-1]], [[[1]]], [[[1]]], names=["heat"])
    save_system(stable, tmp_path / "stable.json")
    unstable = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], names=["heat"])
    save_system(unstable.with_limits({0: [[-1, 2]]}), tmp_path / "unstable.json")
    two = Matrix.from_rows([[-2]])
    one = Matrix.from_rows([[1]])
    integral = AgentProgram(
        "heat", 0, 1, private_update=LinearMap({0: two}), input=LinearMap({0: two}, private=one)
    )
    save_controller(
        Controller("continuous", stable.digest(), (integral,)), tmp_path / "integral.json"
    )
    gain = AgentProgram("heat", 0, 0, input=LinearMap({0: two}))
    save_controller(Controller("continuous", unstable.digest(), (gain,)), tmp_path / "gain.json")
    return tmp_path


def rules_of(folder: Path) -> set[str]:
    manifest = json.loads((folder / "manifest.json").read_text())
    return {sentence["rule"] for sentence in manifest["sentences"]}


def test_certify_chooses_gains_proves_the_loop_and_writes_the_controller(folder: Path) -> None:
    plant, out = str(folder / "stable.json"), str(folder / "saturated.json")
    done = run(
        *("certify", plant, str(folder / "integral.json"), "--limits=-1,1", "--no-box"),
        *("-o", out, "--certificates", str(folder / "evidence")),
    )
    assert done.status == 0, done.stderr
    assert says(done.stdout.splitlines()[0], "stable saturation")
    assert EVERYWHERE in rules_of(folder / "evidence")
    [agent] = load_controller(out).agents
    assert agent.limits == ((-1, 1),) and agent.back_calculation is not None
    manifest = ("check", "--manifest", str(folder / "evidence"), "--system", plant)
    assert run(*manifest, "--controller", out).status == 0
    # other gains are no part of the linear program, and are noticed all the same
    other = load_controller(out).with_saturation((agent.limits,), [Matrix.from_rows([[9]])])
    save_controller(other, folder / "other.json")
    refused = run(*manifest, "--controller", str(folder / "other.json"))
    assert refused.status != 0 and "anti-windup" in refused.stdout


def test_a_controller_is_certified_with_the_gains_that_it_has(folder: Path) -> None:
    wrong = load_controller(folder / "integral.json").with_saturation(
        (((-1, 1),),),  # type: ignore[arg-type]
        [Matrix.from_rows([["-1/1000"]])],
    )
    save_controller(wrong, folder / "wrong.json")
    done = run(
        *("certify", str(folder / "stable.json"), str(folder / "wrong.json"), "--no-box"),
        *("--certificates", str(folder / "evidence")),
    )
    assert done.status == 0, done.stderr
    assert EVERYWHERE not in rules_of(folder / "evidence")


def test_limits_of_the_file_are_proved_from_a_region_for_an_unstable_plant(folder: Path) -> None:
    done = run(
        *("certify", str(folder / "unstable.json"), str(folder / "gain.json"), "--no-box"),
        *("--certificates", str(folder / "evidence")),
    )
    assert done.status == 0, done.stderr
    assert says(done.stdout.splitlines()[0], "norm most")
    assert REGION in rules_of(folder / "evidence")


@pytest.mark.parametrize("text", ["1", "up:-1,1", "1,2", "-1,0,1"])
def test_limits_that_make_no_sense_are_refused(folder: Path, text: str) -> None:
    files = str(folder / "stable.json"), str(folder / "integral.json")
    done = run("certify", *files, f"--limits={text}")
    assert done.status == 3 and "--limits" in done.stderr


@pytest.mark.parametrize(
    ("given", "what"),
    [
        (("--limits=-1,1", "--limits=-2,2"), "limits of every input"),
        (("--limits=heat:-1,1", "--limits=heat:-1,1"), "limits of the channel 'heat'"),
    ],
)
def test_limits_that_are_given_twice_are_refused(
    folder: Path, given: tuple[str, ...], what: str
) -> None:
    done = run("certify", str(folder / "stable.json"), str(folder / "integral.json"), *given)
    assert done.status == 3 and f"{what} are given twice" in done.stderr, done.stderr


def test_limits_are_written_for_a_loop_that_is_not_stable(folder: Path) -> None:
    out = str(folder / "limited.json")
    loose = Controller(
        "continuous",
        load_controller(folder / "gain.json").system,
        (AgentProgram("heat", 0, 0, input=LinearMap({0: Matrix.from_rows([[1]])})),),
    )
    save_controller(loose, folder / "loose.json")
    files = str(folder / "unstable.json"), str(folder / "loose.json")
    assert run("certify", *files, "--limits=-1,1", "--no-box", "-o", out).status == 1
    (agent,) = load_controller(out).agents
    assert agent.limits == ((-1, 1),) and agent.back_calculation is None


@pytest.mark.slow
def test_a_design_at_samples_has_limits_gains_and_its_longest_step(folder: Path) -> None:
    out = str(folder / "made.json")
    done = run(
        *("design", "setpoint", str(folder / "stable.json"), "--limits", "heat:-1,2"),
        *("--step", "0.1", "--late", "1", "--effort", "1", "--no-box", "-o", out, "--json"),
    )
    assert done.status == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["longest_step"]["margin"] == "2/5"
    [agent] = load_controller(out).agents
    assert agent.limits == ((-1, 2),)
    code = run("export", out, "-o", str(folder / "code"))
    assert code.status == 0
    assert "? 2.0 :" in (folder / "code" / "heat.c").read_text()
