"""All answers about a plant with parameters speak about the same set of values."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact import ParametricSystem, analyze, check
from mcexact.answer.account import Account
from mcexact.errors import InputError

POLE = ParametricSystem([[1]], [[["1/t"]]], [[["t"]]], parameters=["t"])
OTHER_CHANNEL = ParametricSystem(
    [["t", 1], [0, 2]],
    [[[0], [1]], [["1/(t - 1)"], [0]]],
    [[["t - 1", 0]], [["t", "1/(t + 2)"]]],
    parameters=["t"],
)
"""Channel 1 has no pole, and is not controllable where channel 2 has one."""
ENTRIES = [0, 0, 1, 1, -1, "t", "t - 1", "1/t", "1/(t - 1)", "(t - 1)/(t + 1)", "1/(t^2 - 2)"]


def drawn(seed: int) -> ParametricSystem:
    """A plant of one or two states, with poles in some entries."""
    rng = random.Random(seed)
    n, m = rng.choice([1, 2]), rng.choice([1, 2])

    def table(r: int, c: int) -> list[list[Any]]:
        return [[rng.choice(ENTRIES) for _ in range(c)] for _ in range(r)]

    B, C = [table(n, 1) for _ in range(m)], [table(1, n) for _ in range(m)]
    return ParametricSystem(table(n, n), B, C, parameters=["t"])


PLANTS = [POLE, OTHER_CHANNEL, *map(drawn, range(6))]


def answers_about(plant: ParametricSystem) -> dict[str, Any]:
    """Every certificate about a plant, also those about one channel."""
    return {**analyze(plant, channel=plant.names[0]).account.parts}


@pytest.mark.parametrize("plant", PLANTS)
def test_no_answer_speaks_of_a_value_at_which_the_plant_is_undefined(
    plant: ParametricSystem,
) -> None:
    for name, found in answers_about(plant).items():
        assert found.about.poles == plant.poles, name
        for q in plant.poles:
            assert all(each.value.gcd(q).degree == 0 for each in found.exceptional), name
            if q.degree == 1:
                with pytest.raises(InputError, match="undefined"):
                    plant.at(-q.coefficients[0] / q.leading)
        assert check(found, plant).valid, name


@pytest.mark.parametrize("plant", PLANTS)
def test_the_same_values_are_undefined_in_every_table(plant: ParametricSystem) -> None:
    account: Account = analyze(plant).account
    undefined = {
        name: {where for where, what, _ in account.rows(name) if what.endswith("undefined")}
        for name in account.answers
    }
    assert len(set(map(frozenset, undefined.values()))) == 1, undefined
    assert len(undefined["setpoint"]) == len(plant.poles)


def test_observability_and_its_indices_agree_at_a_pole() -> None:
    found = analyze(POLE)
    assert found.joint_observability.exceptional == ()
    assert [each.exceptional for each in found.observability_indices] == [()]
    assert found.joint_observability.undefined_at == found.fixed_spectrum.undefined_at
    with pytest.raises(InputError, match="undefined"):
        found.joint_observability.at(0)
    assert found.joint_observability.at(Fraction(1, 2)) == ()
