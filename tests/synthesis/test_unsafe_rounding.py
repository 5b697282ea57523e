"""A rounding that is said to fail rounds every entry up or down, and its loop is not stable."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from mcexact import MultiChannelSystem, check
from mcexact.analysis.boxes.loops import with_gains
from mcexact.designs import local_controllers
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.synthesis import certify as module
from mcexact.synthesis.certify import unsafe_rounding

WHOLE = StabilityRegion("continuous")
PLANT = MultiChannelSystem([[1]], [[[1]]], [[[1]]])


def test_rounding_to_the_nearest_may_hold_where_another_rounding_fails() -> None:
    loop = closed_loop(PLANT, local_controllers(PLANT, [[["-1.6"]]]))
    found = unsafe_rounding(loop, 1, WHOLE)
    assert found is not None
    rounded, verdict = found
    assert rounded.agents[0].input.outputs[0][0, 0] == -1
    assert not verdict.stable and check(verdict).valid
    assert unsafe_rounding(loop, 2, WHOLE) is None


def test_entries_are_rounded_to_different_sides() -> None:
    """u = 2.5 y of one channel and −4.5 y of the other: 1 + 3 − 4 = 0, and no other way fails."""
    plant = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[1]]])
    loop = closed_loop(plant, local_controllers(plant, [[["2.5"]], [["-4.5"]]]))
    found = unsafe_rounding(loop, 1, WHOLE)
    assert found is not None
    assert [agent.input.outputs[i][0, 0] for i, agent in enumerate(found[0].agents)] == [3, -4]


def swinging(time: str) -> ClosedLoop:
    """A loop with a state of the agent, and with messages under way in discrete time."""
    A = [["1/10", 1], [-1, "1/5"]] if time == "continuous" else [["1/2", "4/5"], ["-4/5", "1/2"]]
    plant = MultiChannelSystem(
        A, [[[0], [1]], [[1], [0]]], [[[1, 0]], [[0, 1]]], time=time, names=["a", "b"]
    )
    agents = (
        AgentProgram(
            "a",
            1,
            1,
            LinearMap({0: _of("-1/5")}, {0: _of("1/4")}),
            LinearMap({0: _of("1/3")}, private=_of("-1/2")),
            LinearMap({0: _of("-1/4")}, {0: _of("1/7")}, _of("1/9")),
        ),
        AgentProgram("b", 0, 0, input=LinearMap({1: _of("-2/5")}, {0: _of("1/8")})),
    )
    delays = {"b": {"a": 2}} if time == "discrete" else {}
    graph = NeighborGraph.from_names(plant.names, {"a": [], "b": ["a"]}, delays)
    return closed_loop(plant.with_neighbors(graph), Controller(time, "", agents))


def _of(x: str) -> Matrix:
    return Matrix.from_rows([[x]])


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_slopes_are_those_of_the_eigenvalues(time: str) -> None:
    loop = swinging(time)
    entries = [x for M in _values(loop.controller) for x in M]
    step = Fraction(1, 10**6)
    for k in range(2):
        slopes = module._slopes(loop, len(entries), k, time == "discrete")
        assert slopes is not None
        for i in range(len(entries)):
            sizes = []
            for sign in (-1, 1):
                moved = [x + sign * step * (j == i) for j, x in enumerate(entries)]
                sizes.append(_slowness(module._with_entries(loop.controller, moved), loop, k))
            found = (sizes[1] - sizes[0]) / float(2 * step)
            scale = 1.0 if time == "continuous" else _slowness(loop.controller, loop, k)
            assert slopes[i] / scale == pytest.approx(found, rel=1e-4, abs=1e-6)


def _values(controller: Controller) -> list[list[Fraction]]:
    """The entries in the order in which they are numbered."""
    found: list[list[Fraction]] = []

    def kept(M: Matrix) -> Matrix:
        found.append([Fraction(x, M.denominator) for _, _, x in M.nonzero()])
        return M

    with_gains(controller, kept)
    return found


def _slowness(controller: Controller, loop: ClosedLoop, k: int) -> float:
    """The k-th slowest eigenvalue's real part or modulus, of those that are not below the axis."""
    M = matrix_to_float(closed_loop(loop.plant, controller).matrix)
    values = [value for value in np.linalg.eigvals(M) if value.imag >= 0]
    discrete = loop.plant.time == "discrete"
    sizes = sorted((abs(v) if discrete else v.real for v in values), reverse=True)
    return float(sizes[k])
