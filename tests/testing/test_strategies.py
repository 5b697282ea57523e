"""The strategies shrink to small examples and draw everything that they promise."""

import pytest
from hypothesis import HealthCheck, Phase, find, given, settings
from hypothesis import strategies as st

from mcexact import fixed_spectrum, joint_controllability, joint_observability, testing
from mcexact.derived.drawn.systems import jointly_controllable_system

QUICK = settings(max_examples=300, database=None, suppress_health_check=list(HealthCheck))
# One system in eighty is of the rarest kind: a search that ends with the first find, and not before
# thousands of tries, misses none by chance.
PATIENT = settings(QUICK, max_examples=5000, phases=[Phase.generate])


def entries(system):
    matrices = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    return [abs(x) for M in matrices for row in M.rows() for x in row]


def test_planted_systems_shrink_to_one_state_and_two_channels():
    found = find(testing.systems_with_fixed_mode(), lambda drawn: True, settings=QUICK).system
    assert (found.n, found.m) == (1, 2) and max(entries(found)) <= 1


def test_minimal_systems_shrink_to_few_states_and_small_entries():
    found = find(
        testing.jointly_controllable_systems(), lambda drawn: drawn.system.n > 1, settings=QUICK
    ).system
    assert (found.n, found.m) == (2, 1) and max(entries(found)) <= 1


@pytest.mark.parametrize(
    "wanted",
    [
        lambda d: any(c.B.is_zero() and c.B.ncols for c in d.system.channels),
        lambda d: any(not c.B.ncols for c in d.system.channels),
        lambda d: any(not c.C.nrows for c in d.system.channels),
        lambda d: d.system.A.denominator > 1,
        lambda d: d.system.n == 0,
        lambda d: d.system.time == "discrete",
        lambda d: d.fixed_mode is not None and d.fixed_mode.degree == 3,
        lambda d: d.jointly_controllable is False,
        lambda d: d.jointly_observable is False,
    ],
)
def test_systems_of_every_kind_are_drawn(wanted):
    assert wanted(find(testing.systems(), wanted, settings=PATIENT))


@pytest.mark.parametrize(
    "wanted",
    [
        lambda d: d.system.D is None,
        lambda d: d.system.D is not None and d.system.time == "discrete",
        lambda d: d.system.D is not None and d.jointly_controllable is False,
        lambda d: d.system.D is not None and any(not c.B.ncols for c in d.system.channels),
    ],
)
def test_systems_with_feedthrough_are_drawn_among_others(wanted):
    assert wanted(find(testing.systems(feedthrough=True), wanted, settings=PATIENT))


@given(testing.systems(max_states=3, max_channels=3, feedthrough=True))
@settings(max_examples=20, deadline=None)
def test_what_is_known_of_systems_with_feedthrough_holds(drawn):
    for known, decided in (
        (drawn.jointly_controllable, joint_controllability),
        (drawn.jointly_observable, joint_observability),
    ):
        assert known is None or decided(drawn.system).controllable == known
    if drawn.system.D is not None:
        assert drawn.fixed_modes is drawn.fixed_mode is drawn.indices is None
        testing.assert_valid(fixed_spectrum(drawn.system))


@given(testing.systems_with_fixed_mode(degree=2, time="discrete"))
def test_degree_and_time_are_as_asked_for(drawn):
    assert drawn.fixed_mode.degree == 2 and drawn.system.time == "discrete"


@given(testing.systems_on_graphs(strongly_connected=False))
def test_systems_on_graphs_that_are_not_strongly_connected_have_several_agents(drawn):
    assert drawn.system.m > 1 and not drawn.system.neighbors.is_strongly_connected()


@given(testing.sparse_systems(max_states=2, max_channels=2))
def test_sizes_are_as_asked_for(drawn):
    assert drawn.system.n <= 2 and drawn.system.m <= 2


@given(st.data())
def test_any_draw_can_be_made_inside_a_test(data):
    drawn = jointly_controllable_system(testing.HypothesisChoices(data.draw), 3, 2)
    assert drawn.system.n == 3
