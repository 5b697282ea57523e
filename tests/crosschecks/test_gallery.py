"""Every exhibit: the truth by a slow oracle, and the record of a machine that missed it.

What this machine answers may be right or wrong where it hangs on rounding errors, so it is asserted
only where every kernel has to fail.
"""

import pytest

from mcexact.crosschecks.gallery import exhibit, exhibits, shown, shown_in
from mcexact.crosschecks.table import crosscheck, recorded
from mcexact.derived.constructions import dual
from mcexact.errors import UsageError
from mcexact.model.system import MultiChannelSystem
from tests.oracle.certificates.algebra import fraction_polynomial
from tests.oracle.certificates.roots import inside
from tests.oracle.enumeration import (
    characteristic_polynomial,
    controllable_dimension,
    fixed_factors,
    irreducible_factors,
    plain,
    transfer_arcs,
)
from tests.oracle.structure import index_ranks, partition

NAMES = [each.name for each in exhibits()]


def yes(answer):
    return "yes" if answer else "no"


def controllability(system):
    dimension = controllable_dimension(plain(system))
    return f"{yes(dimension == system.n)}, rank {dimension} of {system.n}"


def index(system):
    small = plain(system)
    inputs = [[entry for B in small.B for entry in B[row]] for row in range(system.n)]
    ranks = index_ranks(small.A, inputs)
    return str(max(partition(ranks))) if ranks[-1] == system.n else "none"


def fixed_modes(system):
    number = sum(len(p) - 1 for p in fixed_factors(plain(system)))
    return f"{number} distinct" if number else "none"


def stability(system):
    factors = irreducible_factors(characteristic_polynomial(plain(system).A))
    return yes(all(inside(fraction_polynomial(p), system.time, None) for p in factors))


ORACLES = {
    "joint controllability": controllability,
    "joint controllability, Hautus": lambda system: controllability(system).split(",")[0],
    "joint observability": lambda system: controllability(dual(system)),
    "controllability index": index,
    "fixed modes, 8 digits": fixed_modes,
    "any fixed mode, pencils": lambda system: yes(fixed_factors(plain(system))),
    "transfer graph": lambda system: f"{len(transfer_arcs(plain(system)))} edges",
    "stability of A": stability,
}


@pytest.mark.parametrize("name", NAMES)
def test_the_truth_is_that_of_a_slow_oracle_and_the_record_missed_it(name):
    found = shown(exhibit(name))
    assert found.here.question == found.exhibit.question
    assert found.here.exact == ORACLES[found.exhibit.question](found.exhibit.make())
    assert found.exhibit.record.floating != found.here.exact
    assert len(found.exhibit.why) > 40


@pytest.mark.parametrize("name", NAMES)
def test_a_record_names_the_libraries_and_the_kernel(name):
    libraries = exhibit(name).record.libraries
    assert {"numpy", "scipy", "control"} <= {library for library, _ in libraries.versions}
    assert libraries.kernel and libraries.kernel in str(libraries)


def test_no_record_is_left_of_what_is_no_exhibit():
    assert list(recorded()["exhibits"]) == NAMES


def test_an_input_far_below_every_tolerance_is_missed_on_every_machine():
    here = shown(exhibit("weak-input")).here
    assert here.floating == "no, rank 1 of 2" and here.agree is False


def test_the_cross_check_of_an_exhibit_finds_it_by_its_numbers():
    weak = exhibit("weak-input").make()
    again = MultiChannelSystem(
        weak.A, [weak.B(0)], [weak.C(0)], names=weak.names, name="under another name"
    )
    [found] = shown_in(crosscheck(again))
    assert found.exhibit.name == "weak-input"
    assert not shown_in(crosscheck(MultiChannelSystem([[1]], [[[1]]], [[[1]]])))


def test_names_are_distinct():
    assert NAMES and len(NAMES) == len(set(NAMES))


def test_an_unknown_exhibit_is_answered_with_the_nearest():
    with pytest.raises(UsageError, match="compleib-tg1"):
        exhibit("compleib-tg2")
