"""Plants with models of signals: their matrices, their fixed modes, and the notation of signals."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction

import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.derived.constructions import internal_model, servo_system
from mcexact.errors import InputError
from mcexact.exact.polynomial import Polynomial
from mcexact.model.signals import constant_signals, signal_polynomial, signals_in_words
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.signals import examined
from tests.oracle.draws import exact, sparse_system

DIRECT = [[1, 0, 2], [0, 4, 0], [0, 0, 6]]
PLANT = MultiChannelSystem([[2]], [[[1]], [[3, 5]]], [[[7], [11]], [[13]]], D=DIRECT)


def test_a_model_is_a_companion_matrix_behind_each_output_that_is_followed() -> None:
    made = internal_model(PLANT, "poly:s^2+3*s+1/2", [[[1, 2]], []])
    half = Fraction(1, 2)
    assert made.A.rows() == ((2, 0, 0), (0, 0, 1), (29, -half, -3))
    assert [B.rows() for B in made.B] == [((1,), (0,), (1,)), ((3, 5), (0, 0), (8, 2))]
    assert made.C(0).rows() == ((0, 1, 0), (0, 0, 1), (7, 0, 0), (11, 0, 0))
    assert made.C(1).rows() == ((13, 0, 0),)
    assert made.D.rows() == ((0, 0, 0), (0, 0, 0), (1, 0, 2), (0, 4, 0), (0, 0, 6))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_for_constants_it_is_the_plant_with_integrators(seed: int, time: str) -> None:
    system = exact(sparse_system(random.Random(seed)), time)
    unit = [[[int(a == b) for b in range(system.q(i))] for a in range(system.q(i))]
            for i in range(system.m)]  # fmt: skip
    made, servo = internal_model(system, constant_signals(time)), servo_system(system, unit)
    assert (made.A, made.B, made.C) == (servo.A, servo.B, servo.C)
    assert made.subject != servo.subject


@pytest.mark.parametrize("seed", range(20))
def test_fixed_modes_that_are_no_roots_are_those_of_the_plant(seed: int) -> None:
    rng = random.Random(seed)
    system = exact(sparse_system(rng, states=3, channels=2), rng.choice(["continuous", "discrete"]))
    alpha = Polynomial.of(*rng.choice([(4, 0, 1), (-2, 1), (3, 0, 0, 1)]))

    def others(about: MultiChannelSystem) -> set[str]:
        factors = fixed_spectrum(about).factors
        return {str(each.polynomial) for each in factors if alpha.gcd(each.polynomial).degree == 0}

    assert others(internal_model(system, alpha)) == others(system)


def test_an_agent_may_measure_the_first_block_alone() -> None:
    """As the page of proofs says, the fixed modes are the same."""
    for seed in range(6):
        system = exact(sparse_system(random.Random(seed), states=3, channels=2))
        made = internal_model(system, "sine:1")
        fewer = [
            made.C(i).take(rows=[*range(q), *range(2 * q, 3 * q)])
            for i, q in ((i, system.q(i)) for i in range(system.m))
        ]
        alone = MultiChannelSystem(made.A, list(made.B), fewer)
        assert fixed_spectrum(alone).polynomial == fixed_spectrum(made).polynomial


def test_which_signals_are_fixed_is_what_ranks_of_the_plant_say() -> None:
    """A sample of the campaign about signals, with both answers in both ways to share."""
    seen = Counter[str]()
    for number in range(5):
        wrong, found = examined(number)
        assert wrong == []
        seen.update(found)
    for way in ("without messages", "shared"):
        assert seen[f"{way}: some root fixed"] and seen[f"{way}: none fixed"]


@pytest.mark.parametrize(
    ("signals", "time", "polynomial", "words"),
    [
        ("step", "continuous", (0, 1), "steps"),
        ("step", "discrete", (-1, 1), "steps"),
        ("ramp", "discrete", (1, -2, 1), "steps, ramps"),
        ("step,ramp", "continuous", (0, 0, 1), "steps, ramps"),
        (["sine:1/3", "sine:1/3"], "continuous", (Fraction(1, 9), 0, 1),
         "sinusoids of 1/3 rad per unit of time"),
        ("cosine:-0.5", "discrete", (1, 1, 1),
         "sinusoids whose angle per step has the cosine -1/2"),
        ("poly:s^3", "continuous", (0, 0, 0, 1),
         "steps, ramps, polynomials of degrees up to 2"),
        ("poly:2*s^2+4", "continuous", (2, 0, 1), "solutions of s^2 + 2"),
        ("poly:z", "discrete", (0, 1), "solutions of z"),
        ("poly:(s^2+1)^2", "continuous", (1, 0, 2, 0, 1), "solutions of s^4 + 2*s^2 + 1"),
    ],
)  # fmt: skip
def test_signals_are_solutions_of_the_least_polynomial(signals, time, polynomial, words) -> None:
    alpha = signal_polynomial(signals, time)
    assert alpha == Polynomial.of(*polynomial)
    assert signals_in_words(alpha, time) == words


@pytest.mark.parametrize(
    ("signals", "time", "said"),
    [
        ("sine:sqrt(2)", "continuous", "rational number"),
        ("sine:0", "continuous", "other than 0"),
        ("sine:1", "discrete", "in discrete time"),
        ("cosine:1/2", "continuous", "in continuous time"),
        ("cosine:1", "discrete", "between -1 and 1"),
        ("ramps", "continuous", "ramp"),
        ("step:1", "continuous", "expected step"),
        ("sine", "continuous", "OMEGA"),
        ("", "continuous", "expected step"),
        ([], "continuous", "at least one"),
        (3, "continuous", "found"),
        ("poly:3", "continuous", "roots"),
        ("poly:1/s", "continuous", "quotient"),
        ("poly:z-1", "continuous", "'z'"),
        ("poly:s^41", "continuous", "up to 40"),
        (Polynomial.of(1), "continuous", "roots"),
    ],
)
def test_what_is_no_signal_is_refused_in_one_line(signals, time, said) -> None:
    with pytest.raises(InputError) as refused:
        signal_polynomial(signals, time)
    assert said in str(refused.value) and "\n" not in str(refused.value)
