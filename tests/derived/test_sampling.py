"""Sampled plants have exact data, and say by how much these differ from the exponential."""

import json
from fractions import Fraction

import pytest

from mcexact import c2d
from mcexact.errors import UsageError
from mcexact.model.files import load_system, save_system
from mcexact.model.system import MultiChannelSystem
from tests.end_to_end.command_line import run


def plant(**more) -> MultiChannelSystem:
    return MultiChannelSystem(
        [[-1, 1], [0, -2]],
        [[[0], [1]], [[1], [0]]],
        [[[1, 0]], [[0, 1]]],
        names=["one", "two"],
        neighbors={"one": ["two"], "two": []},
        **more,
    )


def test_what_is_not_sampled_stays():
    found = c2d(plant(name="a plant", source="a book"), "1/2", decimals=30)
    assert found.time == "discrete" and found.sample_time == Fraction(1, 2)
    assert found.names == ("one", "two") and found.neighbors == plant().neighbors
    assert [found.C(i) for i in range(2)] == [plant().C(i) for i in range(2)]
    assert found.name == "a plant" and found.source.startswith("a book; sampled every 1/2")


def test_a_step_is_the_solution_of_the_differential_equation():
    """For a diagonal A, B_h is (e^{ah} − 1)/a."""
    single = MultiChannelSystem([[-2]], [[[3]]], [[[1]]])
    found = c2d(single, 1, decimals=20)
    a_h, b_h = found.A[0, 0], found.B(0)[0, 0]
    assert abs(b_h - 3 * (1 - a_h) / 2) < Fraction(1, 10**19)
    assert abs(a_h - Fraction("0.13533528323661269189")) < Fraction(1, 10**20)


@pytest.mark.parametrize("step", [0, "-1/2"])
def test_a_step_is_above_0(step):
    with pytest.raises(UsageError, match="expected a time above 0"):
        c2d(plant(), step)


def test_only_plants_in_continuous_time_are_sampled():
    with pytest.raises(UsageError, match="discrete time already"):
        c2d(c2d(plant(), 1), 1)
    with pytest.raises(UsageError, match="decimals"):
        c2d(plant(), 1, decimals=-1)


def test_the_command_writes_the_sampled_plant(tmp_path):
    file, out = tmp_path / "plant.json", tmp_path / "sampled.json"
    save_system(plant(), file)
    done = run("c2d", str(file), "--step", "1/10", "--decimals", "6", "-o", str(out))
    assert done.status == 0, done.stderr
    assert load_system(out) == c2d(plant(), "1/10", decimals=6)
    assert "0.51e-6" in json.loads(out.read_text("utf-8"))["source"]
    shown = run("c2d", str(file), "--step", "1/10", "--decimals", "6")
    assert shown.stdout == out.read_text("utf-8")
