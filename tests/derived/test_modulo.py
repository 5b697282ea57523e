"""Systems without what no output shows, or no input moves: the matrices, and what is refused."""

import random

import pytest

from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.modulo import modulo
from mcexact.derived.constructions import dual
from mcexact.derived.modulo import parts_of, states_of_rest, without_part
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system
from tests.wording import refusal

AGREEING = MultiChannelSystem(
    [[0] * 3] * 3,
    [[[1], [0], [0]], [[0], [1], [0]], [[0], [0], [1]]],
    [[[1, -1, 0]], [[0, 1, -1]], [[-1, 0, 1]]],
    names=["a", "b", "c"],
    neighbors={"a": ["b"]},
    regulated={"a": [1]},
    typical_sizes=TypicalSizes([1, 2, 3], errors=[[1], [1], ["1/2"]]),
)


def test_positions_relative_to_the_first_agent_are_what_is_left_of_integrators():
    left = without_part(AGREEING, "unobservable", [[-2, -2, -2]])
    assert left.A == Matrix.zeros(2, 2)
    assert [B.numerators for B in left.B] == [((-1,), (-1,)), ((1,), (0,)), ((0,), (1,))]
    assert [C.numerators for C in left.C] == [((-1, 0),), ((1, -1),), ((0, 1),)]
    assert left.names == AGREEING.names and left.neighbors == AGREEING.neighbors
    assert left.regulated == AGREEING.regulated and left.plant == AGREEING
    assert left.typical_sizes.states == (2, 3)
    assert left.typical_sizes.errors == AGREEING.typical_sizes.errors
    [part] = parts_of(left)
    assert (part.part, part.dimension, str(part.polynomial)) == ("unobservable", 1, "x")


def test_other_pivots_give_other_coordinates():
    left = without_part(AGREEING, "unobservable", [[1, 1, 1]], [1])
    assert [B.numerators for B in left.B] == [((1,), (0,)), ((-1,), (-1,)), ((0,), (1,))]


def test_the_two_parts_are_dual_to_each_other():
    compared = 0
    for seed in range(100):
        system = exact(sparse_system(random.Random(seed)))
        W = joint_controllability(system).evidence.annihilator
        if not W.nrows:
            continue
        left = without_part(system, "uncontrollable", W)
        other = without_part(dual(system), "unobservable", W)
        compared += 1
        assert other.A == left.A.T
        assert [M.T for M in other.B] == list(left.C) and [M.T for M in other.C] == list(left.B)
    assert compared > 20


@pytest.mark.parametrize(
    ("part", "subspace", "pivots", "message"),
    [
        ("hidden", [[1, 1, 1]], None, "unobservable"),
        ("unobservable", [[1, 1]], None, "at least one row of 3 entries, found 1 of 2"),
        ("unobservable", [], None, "at least one row of 3 entries, found 0"),
        ("unobservable", [[0, 0, 0]], None, "a row that is not zero"),
        ("unobservable", [[1, 1, 0]], None, "a subspace that no output shows"),
        ("uncontrollable", [[1, 1, 1]], None, "a subspace that contains what every input moves"),
        ("unobservable", [[0.5, 1, 1]], None, "float"),
        ("unobservable", [[2, 2, 2]], [0], "the columns of the identity, in order"),
        ("unobservable", [[1, 1, 1]], [3], "the columns of the identity, in order"),
        ("unobservable", [[1, 1, 1], [0, 1, 0]], [1, 0], "the columns of the identity, in order"),
    ],
)
def test_what_is_no_such_part_is_refused(part, subspace, pivots, message):
    with pytest.raises((InputError, UsageError), match=message):
        without_part(AGREEING, part, subspace, pivots)


def test_a_subspace_that_A_leaves_is_refused():
    turning = MultiChannelSystem([[0, 1], [-1, 0]], [[[0], [0]]], [[[0, 0]]])
    for part in ("unobservable", "uncontrollable"):
        with pytest.raises(UsageError, match="subspace: expected a subspace that A maps"):
            without_part(turning, part, [[1, 0]])


def test_all_states_may_be_left_out():
    idle = MultiChannelSystem([[2, 1], [0, 3]], [[[0], [0]]], [[[1, 1]]])
    left = without_part(idle, "uncontrollable", [[1, 0], [0, 1]])
    assert left.n == 0 and str(parts_of(left)[0].polynomial) == "x^2 - 5*x + 6"


def test_states_of_the_rest_move_as_those_of_the_plant():
    compared = 0
    for seed in range(60):
        system = exact(sparse_system(random.Random(seed)))
        rest = modulo(system)
        if rest is system:
            continue
        x = Matrix.column([random.Random(seed + k).randint(-3, 3) for k in range(system.n)])
        moved = [row[0] for row in (system.A @ x).rows()]
        z = Matrix.column(states_of_rest(rest, [row[0] for row in x.rows()]))
        assert states_of_rest(rest, moved) == [row[0] for row in (rest.A @ z).rows()]
        assert rest.output_matrix() @ z == system.output_matrix() @ x
        compared += 1
    assert compared > 20


def test_a_start_that_inputs_do_not_reach_is_refused():
    still = MultiChannelSystem([[0, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])
    rest = without_part(still, "uncontrollable", [[0, 1]])
    assert states_of_rest(rest, [5, 0]) == [5]
    with refusal(InputError):
        states_of_rest(rest, [5, 1])
