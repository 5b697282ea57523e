"""Every construction, built by the package and rebuilt by the checker, gives the same system."""

import json
import random
from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.checker.constructions import read_subject
from mcexact.checker.core.system import digest as checked_digest
from mcexact.checker.core.system import read_plant
from mcexact.derived.constructions import (
    Share,
    add_links,
    augmented_outputs,
    dual,
    error_system,
    extended_system,
    failed,
    feedback,
    full_output,
    held_system,
    internal_model,
    lifted_system,
    merged,
    restricted,
    setpoint_system,
    slow_system,
)
from mcexact.derived.feedthrough import input_filters
from mcexact.derived.sampling import sampled_system
from mcexact.exact.matrix import Matrix
from mcexact.model.loop import closed_loop
from mcexact.model.periodic import periodic_loop
from mcexact.model.text import text_of
from tests.checker.test_subject import periodic
from tests.derived.test_failed import drawn_failures
from tests.model.test_controller import drawn_controller

SHARES: tuple[Share, ...] = ("outputs+states", "states")


def rebuilt(system):
    """Let the checker build the subject from what a certificate would hold; compare everything."""
    plant = read_plant(json.loads(text_of(system.canonical_document())))
    assert checked_digest(plant) == system.digest()
    found = read_subject(json.loads(text_of(system.subject)), plant)
    assert plain(found.A) == system.A.rows()
    assert [plain(B) for B in found.B] == [channel.B.rows() for channel in system.channels]
    assert [plain(C) for C in found.C] == [channel.C.rows() for channel in system.channels]


def plain(M):
    return tuple(tuple(Fraction(x, M.denominator) for x in row) for row in M.rows)


def gains(rng, system, widths):
    return [
        Matrix.from_integers(
            [[rng.randint(-2, 2) for _ in range(w)] for _ in range(system.p(i))], 3, ncols=w
        )
        for i, w in enumerate(widths)
    ]


plants = testing.systems_on_graphs(
    testing.systems(max_states=3, max_channels=3, time="discrete"), longest_delay=3
)


@given(plants, st.integers(0, 10**6))
def test_checker_and_package_build_the_same_subjects(drawn, seed):
    rng, system = random.Random(seed), drawn.system
    m = system.m
    sizes = [rng.randint(0, 2) for _ in range(m)]
    outputs = [system.q(i) for i in range(m)]
    rebuilt(system)
    rebuilt(dual(augmented_outputs(system)))
    rebuilt(full_output(feedback(system, gains(rng, system, outputs)), rng.randrange(m)))
    rebuilt(dual(extended_system(system, sizes, rng.choice(SHARES))))
    more = add_links(system, [(rng.randrange(m), rng.randrange(m)) for _ in range(2)])
    rebuilt(augmented_outputs(more))
    rebuilt(extended_system(more, sizes, rng.choice(SHARES)))
    rebuilt(lifted_system(system, sizes, rng.choice(SHARES)))
    rebuilt(held_system(system, sizes))
    rebuilt(held_system(slow_system(system, max(2 * system.n, 1)), sizes))
    rebuilt(setpoint_system(system))
    rebuilt(dual(internal_model(system, "ramp,cosine:1/2")))
    rebuilt(input_filters(system))
    rebuilt(augmented_outputs(failed(more, **drawn_failures(rng, more))))
    rebuilt(restricted(dual(system), rng.sample(system.names, rng.randint(1, m))))
    rebuilt(dual(merged(system, [system.names[k::2] for k in range(min(m, 2))])))
    rebuilt(error_system(system, gains(rng, system, [system.n] * m)))
    augmented = setpoint_system(system)
    rebuilt(error_system(augmented, gains(rng, augmented, [augmented.n] * m)))


@given(testing.systems_on_graphs(testing.systems(max_states=3, max_channels=3, time="continuous")))
def test_they_agree_on_integrators_in_continuous_time_too(drawn):
    rebuilt(setpoint_system(drawn.system))


@given(
    testing.systems_on_graphs(testing.systems(max_states=3, max_channels=3, time="continuous")),
    st.integers(0, 2),
    st.sampled_from(["1/10", "1/3", "2"]),
)
def test_they_sample_the_same_plants(drawn, late, step):
    sampled = sampled_system(drawn.system, step, late)
    rebuilt(sampled)
    rebuilt(dual(setpoint_system(sampled)))


@given(plants, st.integers(0, 10**6), st.booleans())
def test_checker_and_package_close_the_same_loop(drawn, seed, holding):
    controller = drawn_controller(
        random.Random(seed), drawn.system, references=True, holding=holding
    )
    rebuilt(closed_loop(drawn.system, controller).system)


@given(plants, st.integers(0, 10**6))
def test_checker_and_package_multiply_the_same_phases(drawn, seed):
    rebuilt(periodic_loop(drawn.system, periodic(random.Random(seed), drawn.system)))
