"""What a multi-channel system accepts, refuses and remembers."""

import pickle
from decimal import Decimal
from fractions import Fraction
from typing import Any

import networkx
import numpy as np
import pytest
import scipy.sparse
import sympy
from hypothesis import given

from mcexact import testing
from mcexact.derived.constructions import augmented_outputs, dual, feedback
from mcexact.errors import FloatRefused, InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph
from tests.wording import refusal


def small(**options):
    """A plant of two states and two channels."""
    return MultiChannelSystem(
        [[0, 1], [2, 3]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], **options
    )


@pytest.mark.parametrize(
    "A",
    [
        [["1/2"]],
        [["0.5"]],
        [[Fraction(1, 2)]],
        [[Decimal("0.5")]],
        [[sympy.Rational(1, 2)]],
        sympy.Matrix([[sympy.Rational(1, 2)]]),
        np.array([[Fraction(1, 2)]], dtype=object),
        Matrix.from_rows([["1/2"]]),
        (("5e-1",),),
        ((x for x in ["1/2"]),),
    ],
)
def test_every_exact_way_of_writing_one_half_is_the_same(A):
    assert MultiChannelSystem(A, [[[1]]], [[[1]]]).A[0, 0] == Fraction(1, 2)


@pytest.mark.parametrize(
    "A",
    [np.array([[2]]), np.array([[2]], dtype=np.uint8), scipy.sparse.csr_array(np.array([[2]]))],
)
def test_arrays_of_integers_are_exact(A):
    assert MultiChannelSystem(A, [[[1]]], [[[1]]]).A[0, 0] == 2


@pytest.mark.parametrize(
    ("A", "where"),
    [
        ([[0.5]], "A[0][0]"),
        (np.array([[0.5]]), "A"),
        ([[np.float32(0.5)]], "A[0][0]"),
        (sympy.Matrix([[0.5]]), "A[0][0]"),
    ],
)
def test_floats_are_refused_with_the_two_ways_in(A, where):
    with pytest.raises(FloatRefused, match="from_float") as caught:
        MultiChannelSystem(A, [[[1]]], [[[1]]])
    assert caught.value.where == where


@pytest.mark.parametrize("entry", [1j, 0.5 + 0j, np.complex128(1j), np.complex64(2)])
def test_complex_numbers_are_called_so(entry):
    with refusal(InputError) as caught:
        MultiChannelSystem([[entry]], [[[1]]], [[[1]]])
    assert caught.value.where == "A[0][0]" and not isinstance(caught.value, FloatRefused)


class Lying(list[Any]):
    """A list whose length is not what it says."""

    def __len__(self):
        return 10**9


@pytest.mark.parametrize(
    ("A", "message"),
    [
        ("12;34", "A: expected a matrix as a list of rows, found a string"),
        ([1, 2], r"A\[0\]: expected a row as a list, found int"),
        (["12", "34"], r"A\[0\]: expected a row as a list, found str"),
        (7, "A: expected a matrix as a list of rows, found int"),
        ([[1, 2], [3]], r"A\[1\]: expected 2 entries as in row 0, found 1"),
        ([[1, 2]], "A: expected a square matrix, found 1 × 2"),
        ([[True]], r"A\[0\]\[0\]: expected a number, found the Boolean True"),
        ([[1 + 2j]], r"A\[0\]\[0\]: expected a real number, found the complex number"),
        (np.array([[True]]), "A: expected an array of integers or of exact objects, found bool"),
        (np.array([1]), "A: expected a two-dimensional array, found 1 dimensions"),
        (np.array([[1j]]), "A: expected an array of integers"),
        (sympy.Matrix([[sympy.Symbol("k")]]), r"A\[0\]\[0\]: expected a rational number"),
        ([["1 / 2"]], r"A\[0\]\[0\]: expected an integer, a decimal"),
        ([[None]], r"A\[0\]\[0\]: expected a rational number"),
        (Lying([[1, 2], [3]]), "expected 2 entries"),
    ],
)
def test_what_is_no_exact_matrix_is_refused(A, message):
    with pytest.raises(InputError, match=message):
        MultiChannelSystem(A, [[[1]]], [[[1]]])


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        (([[1]], [], []), {}, "B: expected at least one channel, found none"),
        (([[1]], [[[1]]], []), {}, "C: expected as many matrices as in B, 1, found 0"),
        (([[1]], [[[1], [2]]], [[[1]]]), {}, r"B\[0\]: expected 1 row, found 2"),
        (([[1]], [[[1]]], [[[1, 2]]]), {}, r"C\[0\]: expected 1 column, found 2"),
        (([[1]], "1", [[[1]]]), {}, "B: expected a list of matrices"),
        (([[1]], {"1": [[1]]}, [[[1]]]), {}, "B: expected a list of matrices"),
        (([[1]], [[[1]]], [[[1]]]), {"time": "sampled"}, 'time: expected "continuous"'),
        (([[1]], [[[1]]], [[[1]]]), {"names": "1"}, "names: expected a list of names"),
        (([[1]], [[[1]]], [[[1]]]), {"names": ["a", "b"]}, "names: expected 1 names, found 2"),
        (([[1]], [[[1]]], [[[1]]]), {"names": [1]}, r"names\[0\]: expected a name as a string"),
        (([[1]], [[[1]]], [[[1]]]), {"sample_time": 1}, "sample_time: only discrete time"),
        (
            ([[1]], [[[1]]], [[[1]]]),
            {"time": "discrete", "sample_time": 0},
            "sample_time: expected a number > 0",
        ),
        (
            ([[1]], [[[1]]], [[[1]]]),
            {"time": "discrete", "sample_time": 0.1},
            "sample_time: a float is not exact",
        ),
        (([[1]], [[[1]]], [[[1]]]), {"name": "a\x1b[31m"}, r"name: remove the character U\+001B"),
        (([[1]], [[[1]]], [[[1]]]), {"source": 3}, "source: expected a string"),
        (([[1]], [[[1]]], [[[1]]]), {"source": "a" * 10001}, "source: expected at most 10000"),
        (
            ([[1]], [[[1]]], [[[1]]]),
            {"neighbors": networkx.DiGraph()},
            "graph: expected the channels as nodes; no node for '1'",
        ),
    ],
)
def test_a_wrong_argument_is_named_with_what_was_expected_and_found(arguments, options, message):
    with pytest.raises(InputError, match=message):
        MultiChannelSystem(*arguments, **options)


def test_a_graph_on_other_agents_is_refused():
    with refusal(UsageError):
        small(neighbors=NeighborGraph.ring(("2", "1")))


def test_no_states_and_channels_without_inputs_or_outputs_are_legal():
    system = MultiChannelSystem([], [[]], [[]])
    assert (system.n, system.m, system.p(0), system.q(0)) == (0, 1, 0, 0)
    system = MultiChannelSystem([[1]], [[[]], [[1, 2]]], [[], [[1]]])
    assert (system.p(0), system.q(0), system.p(1)) == (0, 0, 2)
    assert system.input_matrix().shape == (1, 2)
    assert system.output_matrix([0]).shape == (0, 1)
    assert MultiChannelSystem(np.zeros((0, 0), int), [np.zeros((0, 2), int)], [[[]]]).p(0) == 2


def test_matrices_of_sets_of_channels_are_in_the_order_of_the_system():
    system = small()
    assert system.input_matrix([1, 0]) == system.input_matrix() == Matrix.identity(2)
    assert system.output_matrix([1]).numerators == ((0, 1),)
    assert system.indices(["2", "1"]) == (0, 1) and system.named([1]) == ("2",)


def test_an_unknown_channel_is_named_with_the_known_ones():
    with pytest.raises(UsageError, match=r"no channel 'u12' \(did you mean 'u1'\?\); the"):
        small(names=("u1", "x")).index("u12")


def test_a_name_is_not_read_as_a_list_of_the_names_of_its_letters():
    with pytest.raises(InputError, match=r"expected a list of names, found '12': write \['12'\]"):
        small().indices("12")


def test_decimal_and_dyadic_rounding_differ():
    arguments = ([[0.1]], [[[1.0]]], [[[1.0]]])
    decimal = MultiChannelSystem.from_float(*arguments, rounding="decimal")
    dyadic = MultiChannelSystem.from_float(*arguments, rounding="dyadic", time="discrete")
    assert decimal.A[0, 0] == Fraction(1, 10) and dyadic.A[0, 0] == Fraction(0.1)
    with pytest.raises(InputError, match=r"B\[0\]"):
        MultiChannelSystem.from_float([[1.0]], [[[float("nan")]]], [[[1.0]]], rounding="decimal")
    with pytest.raises(InputError, match="decimal"):
        MultiChannelSystem.from_float(*arguments, rounding="nearest")  # type: ignore[arg-type]


def test_a_derived_system_remembers_plant_and_constructions():
    plant = small()
    made = dual(feedback(plant, [[[1]], [[2]]]))
    assert made.plant is plant and plant.plant is plant and plant.subject == ()
    assert [c["construction"] for c in made.subject] == ["feedback", "dual"]
    assert "feedback, dual" in repr(made)


def test_a_graph_given_later_is_carried_by_the_plant():
    cyclic = NeighborGraph.ring(("1", "2"))
    made = augmented_outputs(feedback(small(), [[[1]], [[2]]]), cyclic)
    assert made.plant.neighbors == cyclic
    assert with_graph(made)[1] == cyclic


def test_a_graph_is_refused_where_it_would_change_what_was_made():
    cyclic, complete = NeighborGraph.ring(("1", "2")), NeighborGraph.empty(("1", "2"))
    made = augmented_outputs(small(), cyclic)
    with pytest.raises(UsageError, match="already made by 'augmented_outputs'"):
        made.with_neighbors(complete)
    with pytest.raises(UsageError, match="already made by 'dual'"):
        dual(small()).with_neighbors(cyclic)
    assert made.with_neighbors(cyclic) is made


def test_without_any_graph_the_message_says_where_to_put_one():
    with pytest.raises(UsageError, match="'neighbors'"):
        with_graph(small())


@given(testing.systems_on_graphs(longest_delay=2))
def test_systems_are_equal_hashable_and_survive_pickling(drawn):
    copy = pickle.loads(pickle.dumps(drawn.system))
    assert copy == drawn.system and hash(copy) == hash(drawn.system)


def test_a_system_cannot_be_changed():
    with pytest.raises(AttributeError):
        small().time = "discrete"
