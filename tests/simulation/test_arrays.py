"""Trajectories as arrays, for plots and for python-control."""

from fractions import Fraction

import numpy as np
import pytest

import mcexact
from mcexact.designs import local_controllers

PLANT = mcexact.MultiChannelSystem(
    [["1/2", 1], [0, "1/3"]],
    [[[1, 0], [0, 1]], [[0], [1]]],
    [[[1, 0]], [[0, 1], [1, 1]]],
    time="discrete",
    sample_time="1/10",
)
CONTROLLER = local_controllers(PLANT, [[["-1/4"], [0]], [[0, "1/5"]]])


def test_arrays_have_a_row_for_each_time_and_the_numbers_of_the_snapshots() -> None:
    run = mcexact.simulate(PLANT, CONTROLLER, initial=[1, 2], horizon=4)
    assert [each.shape for each in (run.t, run.x, run.y, run.u)] == [(5,), (5, 2), (5, 3), (5, 3)]
    assert run.r.shape in {(5, 0), (5, 3)}
    state = [Fraction(1), Fraction(2)]
    for k, row in enumerate(run.x):
        assert row == pytest.approx([float(each) for each in state], abs=1e-15)
        y = [state[0], state[1], state[0] + state[1]]
        u = [-y[0] / 4, Fraction(0), y[2] / 5]
        assert run.y[k] == pytest.approx([float(each) for each in y], abs=1e-15)
        assert run.u[k] == pytest.approx([float(each) for each in u], abs=1e-15)
        state = [state[0] / 2 + state[1] + u[0], state[1] / 3 + u[1] + u[2]]


def test_the_response_of_python_control_has_the_same_numbers() -> None:
    pytest.importorskip("control")
    run = mcexact.simulate(PLANT, CONTROLLER, initial=[1, 2], horizon=4)
    response = run.to_control()
    assert np.array_equal(response.outputs, run.y.T)
    assert np.array_equal(response.states, run.x.T)
    assert np.array_equal(response.inputs, run.u.T)
    assert np.array_equal(response.time, run.t)
    assert response.output_labels == run.names("outputs")


def test_a_plant_has_the_names_of_python_control() -> None:
    assert (PLANT.nstates, PLANT.ninputs, PLANT.noutputs) == (2, 3, 3)
    assert PLANT.dt == 0.1
    assert sorted(PLANT.poles().real) == pytest.approx([1 / 3, 1 / 2])
    assert mcexact.MultiChannelSystem([[0]], [[[1]]], [[[1]]]).dt == 0
    assert mcexact.MultiChannelSystem([[0]], [[[1]]], [[[1]]], time="discrete").dt is True


def test_the_transfer_graph_is_a_graph_of_networkx_and_one_is_taken_as_neighbors() -> None:
    networkx = pytest.importorskip("networkx")
    arcs = mcexact.transfer_graph(PLANT).to_networkx()
    assert set(arcs.nodes) == {"1", "2"} and ("2", "1") in arcs.edges
    linked = PLANT.with_neighbors(networkx.DiGraph([("1", "2")]))
    assert linked.neighbors == mcexact.NeighborGraph.from_names(("1", "2"), {"2": ["1"]})


def test_roots_of_fixed_factors_are_numbers_of_sympy() -> None:
    sympy = pytest.importorskip("sympy")
    plant = mcexact.MultiChannelSystem([[0, 2], [1, 0]], [[[0], [0]]], [[[1, 0]]])
    (factor,) = mcexact.fixed_spectrum(plant).factors
    assert set(factor.sympy_roots()) == {sympy.sqrt(2), -sympy.sqrt(2)}
