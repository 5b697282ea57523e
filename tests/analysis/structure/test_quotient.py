"""Quotient fixed modes, against enumeration over the sets on which no other channel acts."""

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from mcexact.analysis.analyze import analyze
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.protocol import document
from mcexact.derived.constructions import merged
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.every_question import hidden
from tests.oracle.certificates.systems import read_plant
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import PlainSystem, Rows
from tests.oracle.sentences.cases import Facts, plain, same_roots
from tests.oracle.sentences.time_varying import unmoved

SEEDS = 300
"""The number of drawn systems of each sort that are compared with enumeration."""


def movable(rng: random.Random) -> PlainSystem:
    """Channel 1 acts on a mode that channel 2 sees; back the transfer is 0 there, or everywhere."""
    mode, a, b, c, d, u, v = (rng.randint(-2, 2) for _ in range(7))
    # adj(xI - A) B = (x - d) u + b v, c u + (x - a) v of the two other states
    zero = [-(c * u + (mode - a) * v), (mode - d) * u + b * v]
    system = PlainSystem(
        table([[mode, 0, 0], [0, a, b], [0, c, d]]),
        [table([[1], [0], [0]]), table([[0], [u], [v]])],
        [table([[0, *zero]]), table([[1, 0, 0]])],
    )
    return hidden(rng, system)


def table(rows: list[list[int]]) -> Rows:
    """Rows of rational numbers."""
    return [list(map(Fraction, row)) for row in rows]


@pytest.mark.parametrize("draw", [sparse_system, movable])
@pytest.mark.parametrize("first", range(0, SEEDS, 50))
def test_no_mode_differs_from_enumeration(
    draw: Callable[[random.Random], PlainSystem], first: int
) -> None:
    stay, moved = 0, 0
    for seed in range(first, first + 50):
        system = exact(draw(random.Random(seed)))
        own = fixed_spectrum(system)
        quotient = fixed_spectrum(merged(system, transfer_graph(system).components))
        factors = unmoved(Facts(read_plant(document(own)["system"])))
        assert same_roots(plain(quotient.polynomial), factors), seed
        stay += bool(factors)
        moved += quotient.polynomial.degree < own.polynomial.degree
    assert stay
    assert moved or draw is sparse_system


def rules(plant: MultiChannelSystem, **options: Any) -> set[str]:
    """The keys of the sentences about a plant."""
    return {each.template.key for each in analyze(plant, **options).account.sentences}


def test_what_is_said_of_control_that_varies_in_time() -> None:
    varies, never = {"time-varying-stabilizes"}, {"no-causal-control"}
    assert rules(gallery.load("movable-by-periodic-gains")) & (varies | never) == varies
    assert rules(gallery.load("hidden-triple-mode")) & (varies | never) == never
    # where all channels together do not move a mode, nothing is said of it
    joint = rules(gallery.load("relative-positions-4"))
    assert not {key for key in joint if key.startswith(("quotient", "time-v", "no-causal"))}
    asked = rules(gallery.load("relative-positions-4"), also=["quotient_fixed_spectrum"])
    assert asked >= {"quotient-fixed", "no-causal-control"}
