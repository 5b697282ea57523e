"""What the demonstration claims is true by slow oracles, and its record misses it."""

from fractions import Fraction

from mcexact.crosschecks.demonstration import STATES, demonstration
from mcexact.crosschecks.gallery import exhibit
from mcexact.model import gallery
from tests.oracle.enumeration import (
    controllable_dimension,
    fixed_factors,
    least_multiplicity,
    plain,
)


def test_the_exact_answers_are_those_of_slow_oracles():
    found = demonstration()
    assert (
        found.rank == STATES == controllable_dimension(plain(exhibit("integers-to-twenty").make()))
    )
    small = plain(gallery.load("hidden-triple-mode"))
    mode = (Fraction(-1), Fraction(1))
    assert list(fixed_factors(small)) == [mode]
    assert found.fixed == (("x - 1", least_multiplicity(small, mode)),)


def test_the_record_is_wrong_and_says_where_it_was_made():
    recorded = demonstration().recorded
    assert recorded.misleading
    assert recorded.libraries.kernel


def test_floating_point_finds_no_full_rank_on_any_machine():
    assert demonstration().here.rank < STATES
