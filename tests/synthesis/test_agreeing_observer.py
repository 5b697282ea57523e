"""Observers whose agents are drawn to agree."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from mcexact import design_observer, design_setpoint
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis import distributed_observer
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.distributed_observer import agreed_weights, best_agreeing
from tests.wording import says

PENDULA = "slicot-ctdsx-2-5-pendula-s2"


def with_ring(name: str) -> MultiChannelSystem:
    plant = gallery.load(name)
    return plant.with_neighbors(NeighborGraph.ring(plant.names))


@pytest.mark.parametrize(
    ("name", "rate"),
    [
        ("lexalutyi-two-double-integrators", "1/2"),
        ("farina-string-of-vehicles-4", "1/10"),
        (PENDULA, 2),
    ],
)
def test_half_the_states_and_a_margin_suffice(name, rate):
    design = design_observer(with_ring(name), rate=rate, arithmetic="float")
    plant = design.loop.closed.plant
    assert check_document(encode(design.loop.proof).encode()).verdict == "VALID"
    assert design.order == plant.n * plant.m
    found = assess(design)
    assert found.figures.margin >= 0.3 and found.relative_cost < 4


def test_what_is_fragile_is_compared_with_observers_of_a_channel_controller():
    plant = with_ring(PENDULA)
    agreeing = best_agreeing(plant, plant.neighbors, StabilityRegion("continuous", Fraction(1, 2)))
    assert agreeing is not None and agreeing.is_fragile
    found = assess(design_observer(plant, rate="1/2", arithmetic="float"))
    assert found.figures.margin >= agreeing.figures.margin


def test_gains_have_few_digits():
    design = design_observer(with_ring(PENDULA), rate=2, arithmetic="float")
    for M in (*design.parts["feedback"], *design.parts["observer_gains"]):
        for row in M.rows():
            assert all(x == float(f"{float(x):.2e}") for x in map(float, row))


def sampled_vehicles(m: int = 3) -> MultiChannelSystem:
    """Vehicles in a row, sampled, that measure distances and hear the next ones."""
    step, names = 0.1, [str(i) for i in range(m)]
    A = np.eye(2 * m) + np.kron(np.eye(m), [[0.0, step], [0.0, 0.0]])
    B = [step * np.eye(2 * m)[:, [2 * i + 1]] for i in range(m)]
    C = [np.eye(2 * m)[[2 * i]] - (np.eye(2 * m)[[2 * i - 2]] if i else 0) for i in range(m)]
    plant = MultiChannelSystem.from_float(A, B, C, time="discrete", rounding="decimal", names=names)
    return plant.with_neighbors(NeighborGraph.ring(plant.names))


def test_in_discrete_time_slow_filters_agree_and_the_loop_is_about_as_slow_as_asked():
    plant = sampled_vehicles()
    design = design_observer(plant, radius="0.99", arithmetic="float")
    assert check_document(encode(design.loop.proof).encode()).verdict == "VALID"
    assert design.order == plant.n * plant.m
    found = assess(design)
    assert found.figures.margin >= 0.3 and found.relative_cost < 3
    assert 0.96 <= found.figures.bound < 0.99


def test_a_low_order_is_compared_with_the_observer() -> None:
    carts = MultiChannelSystem(
        [[0, 1, 0, 0], ["-1/2", 0, "1/2", 0], [0, 0, 0, 1], ["1/2", 0, "-1/2", 0]],
        [[[0], [1], [0], [0]], [[0], [0], [0], [1]]],
        [[[1, 0, 0, 0], [0, 1, 0, 0]], [[0, 0, 1, 0], [0, 0, 0, 1]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )
    asked: dict[str, Any] = {"rate": "1/4", "arithmetic": "float"}
    plain = design_observer(carts, **asked)
    low = design_observer(carts, order="low", **asked)
    assert plain.name == "observer" and plain.order == 8
    assert low.name == "extended" and low.order < plain.order and low.stable
    assert "was kept" in low.notes[-1] and "the observer: 8 states" in low.notes[-1]
    with pytest.raises(UsageError, match="a low order takes a rate or a radius"):
        design_observer(carts, agent="1", order="low", **asked)


def test_the_observer_is_kept_where_no_low_order_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: Any, **__: Any) -> None:
        raise LimitReached("none")

    plant = MultiChannelSystem(
        [[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors={"1": ["2"], "2": ["1"]}
    )
    monkeypatch.setattr(distributed_observer, "design_extended", none)
    found = design_observer(plant, rate=1, order="low", arithmetic="float")
    assert found.name == "observer" and says(found.notes[-1], "low order")
    monkeypatch.setattr(distributed_observer, "designed", none)
    with pytest.raises(LimitReached, match="none"):
        design_observer(plant, rate=1, order="low", arithmetic="float")


def test_in_discrete_time_the_fastest_loops_come_last():
    plant = sampled_vehicles()
    slow, any_rate = (
        best_agreeing(plant, plant.neighbors, StabilityRegion.of("discrete", radius=radius))
        for radius in ("0.99", 1)
    )
    assert slow is not None and any_rate is not None
    assert not slow.is_hasty and not slow.is_fragile
    assert not any_rate.is_hasty and not any_rate.is_fragile
    assert any_rate.figures.bound < slow.figures.bound
    assert any_rate.figures.cost < slow.figures.cost


def test_a_named_agent_carries_a_channel_controller():
    design = design_observer(with_ring(PENDULA), agent="2", rate=1, arithmetic="float")
    assert design.parts["agent"] == "2" and design.parts["channel_order"] > 0


def test_the_observer_of_a_plant_with_one_agent_is_that_of_luenberger():
    plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]], neighbors={"1": []})
    assert design_observer(plant, rate=1, arithmetic="float").order == 2


def test_given_gains_are_kept():
    plant = MultiChannelSystem(
        [[1]], [[[1]], [[1]]], [[[1]], [[2]]], neighbors={"1": ["2"], "2": ["1"]}
    )
    design = design_observer(plant, gains=[[[-4]], [[0]]], rate=2, arithmetic="float")
    assert [F.numerators for F in design.parts["feedback"]] == [((-4,),), ((0,),)]
    assert design.order == 2


def test_set_points_are_held_by_such_an_observer():
    plant = MultiChannelSystem(
        [[1, 1], [0, 2]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )
    design = design_setpoint(plant, rate=1, method="observer", arithmetic="float")
    assert design.order == 2 + 2 * 4
    assert assess(design).figures.margin > 0.1


@pytest.mark.parametrize(
    ("heard", "expected"),
    [
        ({"1": ["2"], "2": ["3"], "3": ["1"]}, [1 / 3, 1 / 3, 1 / 3]),
        ({"1": ["2"], "2": ["1", "3"], "3": ["1"]}, [1 / 2, 1 / 4, 1 / 4]),
        ({"1": ["2"], "2": ["3"], "3": []}, None),
    ],
)
def test_the_weights_belong_to_the_laplacian(heard, expected):
    graph = NeighborGraph.from_names(["1", "2", "3"], heard)
    found = agreed_weights(graph)
    if expected is None:
        assert found is None
        return
    assert np.allclose(found, expected)


@pytest.mark.parametrize(
    ("plant", "region"),
    [
        (
            with_ring(PENDULA).with_neighbors(
                NeighborGraph.from_names(["1", "2"], {"1": ["2"], "2": []})
            ),
            StabilityRegion("continuous", Fraction(1)),
        ),
        (
            MultiChannelSystem([[2]], [[[1]]], [[[0]]], time="discrete", neighbors={"1": []}),
            StabilityRegion("discrete"),
        ),
        (
            MultiChannelSystem([[2]], [[[1]]], [[[0]]], neighbors={"1": []}),
            StabilityRegion("continuous", Fraction(1)),
        ),
        (
            MultiChannelSystem([[2]], [[[0]]], [[[1]]], neighbors={"1": []}),
            StabilityRegion("continuous", Fraction(1)),
        ),
    ],
    ids=["not strongly connected", "not observed in steps", "not observed", "not controlled"],
)
def test_elsewhere_there_is_none(plant, region):
    assert best_agreeing(plant, plant.neighbors, region) is None
