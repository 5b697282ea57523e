"""Channels taken together as one: the matrices, the fixed modes, and what is refused."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.derived.constructions import augmented_outputs, merged
from mcexact.errors import InputError, UsageError
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from tests.oracle import enumeration
from tests.oracle.draws import exact, sparse_system
from tests.wording import refusal

THREE = MultiChannelSystem(
    [[0]], [[[1]], [[2]], [[3]]], [[[4]], [[5]], [[6]]], names=["a", "b", "c"]
)


@st.composite
def parted(draw):
    """A system, and a partition of its channels in any order."""
    system = draw(testing.systems(max_states=4, max_channels=4)).system
    parts = {}
    for name in draw(st.permutations(system.names)):
        parts.setdefault(draw(st.integers(0, system.m - 1)), []).append(name)
    return system, list(parts.values())


def fixed(system):
    return fixed_spectrum(system).polynomial


@given(parted())
def test_inputs_stand_side_by_side_and_outputs_below_each_other(drawn):
    system, parts = drawn
    numbers, made = enumeration.plain(system), merged(system, parts)
    places = sorted(sorted(map(system.index, part)) for part in parts)
    B = [[[b for i in T for b in numbers.B[i][k]] for k in range(system.n)] for T in places]
    C = [[row for i in T for row in numbers.C[i]] for T in places]
    assert enumeration.plain(made) == enumeration.PlainSystem(numbers.A, B, C)
    named = [[system.names[i] for i in T] for T in places]
    assert made.names == tuple("+".join(part) for part in named)
    assert made.subject == ({"construction": "merged", "parts": named},)
    assert made.plant == system and made.time == system.time


@given(parted())
def test_taking_channels_together_never_adds_fixed_modes(drawn):
    system, parts = drawn
    assert fixed(merged(system, parts)).divides(fixed(system))


@given(testing.systems(max_states=4, max_channels=4))
def test_all_channels_as_one_leave_what_they_do_not_control_or_observe(drawn):
    system = drawn.system
    asked = joint_controllability(system), joint_observability(system)
    one, other = (found.uncontrollable_polynomial for found in asked)
    together = fixed(merged(system, [system.names]))
    assert together.squarefree_part() == (one * other).squarefree_part()


@given(testing.systems_on_graphs(testing.systems(max_states=3, max_channels=3)))
def test_channels_by_themselves_are_those_of_the_plant_without_a_graph(drawn):
    system = drawn.system
    made = merged(system, [[name] for name in reversed(system.names)])
    assert (made.A, made.channels, made.neighbors) == (system.A, system.channels, None)


def test_the_mode_that_periodic_gains_move_is_not_fixed_once_its_channels_are_one():
    plant = gallery.load("movable-by-periodic-gains")
    components = transfer_graph(plant).components
    assert components == (("1", "2"),)
    assert str(fixed(plant)) == "x - 11/10"
    assert fixed(merged(plant, components)).degree == 0


def test_over_strong_components_a_mode_is_fixed_by_agents_that_others_do_not_reach():
    """Some s has rank P_s(λ) < n, and no input of another channel reaches an output in s."""
    lost = kept = 0
    for seed in range(130, 210):
        plain = sparse_system(random.Random(seed))
        system, arcs = exact(plain), enumeration.transfer_arcs(plain)
        unreached = [
            s
            for s in enumeration.subsets(plain.m)
            if not any(i in s and j not in s for j, i in arcs)
        ]
        all_fixed = enumeration.fixed_factors(plain)
        expected = {
            p
            for p in all_fixed
            if any(enumeration.pencil_rank(plain, s, p) < plain.n for s in unreached)
        }
        made = merged(system, transfer_graph(system).components)
        assert set(enumeration.irreducible_factors(fixed(made).coefficients)) == expected, seed
        lost, kept = lost + len(all_fixed) - len(expected), kept + len(expected)
    assert lost and kept


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ([["a", "b"]], "parts: expected every channel in exactly one part, found 'c' 0"),
        ([], "found 'a' 0 times"),
        ([["a", "b"], ["b", "c"]], "found 'b' 2 times"),
        ([["a", "a", "b"], ["c"]], "found 'a' 2 times"),
        ([["a", "b"], ["c"], []], "parts: expected at least one channel in every part, found none"),
        ([["a", "b"], ["c", "d"]], "there is no channel 'd'"),
        ([["a", "b"], [2]], "there is no channel 2;"),
        ([["a", "b"], "c"], "expected a list of names, found 'c'"),
        ("abc", "expected a list of lists of names, found 'abc'"),
    ],
)
def test_what_is_no_partition_of_the_channels_is_refused(parts, message):
    with pytest.raises((InputError, UsageError), match=message):
        merged(THREE, parts)


@pytest.mark.parametrize(
    ("names", "parts"),
    [
        (["a", "b", "a+b"], [["a", "b"], ["a+b"]]),
        (["a+b", "c", "a", "b+c"], [["a+b", "c"], ["a", "b+c"]]),
        (["e\u0301", "b", "\u00e9+b"], [["e\u0301", "b"], ["\u00e9+b"]]),
    ],
)
def test_two_channels_of_one_name_are_refused(names, parts):
    m = len(names)
    system = MultiChannelSystem([[0]], [[[1]]] * m, [[[1]]] * m, names=names)
    with refusal(UsageError, where="parts"):
        merged(system, parts)


def test_a_merged_plant_takes_no_graph():
    made = merged(THREE, [["a", "b"], ["c"]])
    with refusal(UsageError):
        augmented_outputs(made)
    with refusal(UsageError):
        made.with_neighbors({"c": ["a+b"]})
