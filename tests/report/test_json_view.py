"""The JSON of `analyze` has the keys that programs rely on, and plain exact values."""

import json
from fractions import Fraction
from typing import Any

import pytest

from mcexact import MultiChannelSystem, NeighborGraph
from mcexact.errors import LimitReached, UsageError
from mcexact.report.assessment import assess
from mcexact.report.json_view import assessment_view, shared_dimensions_view
from tests.report.test_assessment_tables import EXAMPLE

ALWAYS = {
    "system",
    "jointly_controllable",
    "jointly_observable",
    "transfer_graph",
    "fixed_spectrum",
    "stabilizable",
    "best_rate",
    "complete",
    "controllability_indices",
    "observability_indices",
    "assignability",
    "setpoint",
}


def view_of(system: MultiChannelSystem, **question: Any) -> dict[str, Any]:
    view = assessment_view(assess(system, **question), with_certificates=True)
    assert json.loads(json.dumps(view)) == view
    return view


def test_every_answer_is_there_and_names_its_certificate() -> None:
    view = view_of(MultiChannelSystem(**EXAMPLE))
    assert view.keys() >= ALWAYS | {"answer"}
    assert view["system"].items() >= {"n": 3, "m": 3, "time": "continuous"}.items()
    assert view["certificate"].keys() == ALWAYS - {"system"}
    assert view["fixed_spectrum"]["certificate"] == "fixed_spectrum.json"
    assert "neighbor_graph" not in view


def test_polynomials_are_lists_of_strings_and_channels_are_names() -> None:
    plant = MultiChannelSystem(
        [["1/3", 0], [0, 2]], [[[1], [0]]] * 2, [[[1, 0]]] * 2, names=["left", "right"]
    )
    spectrum = view_of(plant)["fixed_spectrum"]
    assert spectrum["polynomial"] == ["-2", "1"]
    (factor,) = spectrum["factors"]
    assert factor["channels"] == ["left", "right"]
    assert factor["roots"] == [{"re": "2", "im": "0", "radius": "0"}]
    assert view_of(plant)["transfer_graph"]["arcs"][1] == ["left", "right"]


def test_with_neighbors_sharing_is_answered_and_least_sharing_only_when_asked() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    heard = plant.with_neighbors(NeighborGraph.ring(plant.names))
    view = view_of(heard)
    assert view["neighbor_graph"]["strongly_connected"] is True
    assert (
        view["shared_dimension_bound"]["outputs+states"].items()
        >= {
            "per_agent": 1,
            "total": 3,
        }.items()
    )
    assert view["minimal_shared_dimensions"] is None
    least = view_of(heard, minimal=True)["minimal_shared_dimensions"]
    assert least["outputs+states"]["dimensions"] == {"1": 0, "2": 0, "3": 1}
    assert least["states"]["total"] == 2
    assert least["states"]["certificate"] == "minimal_shared_dimensions_states.json"


def test_the_bounds_that_a_limit_leaves_are_numbers_of_json() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    reached = LimitReached("a limit", lower=Fraction(2), upper=Fraction(7, 2))
    view = shared_dimensions_view(plant, reached)
    bounds = '{"decided": false, "computed_not_certified": {"lower": 2, "upper": "7/2"}}'
    assert json.dumps(view) == bounds
    nothing = shared_dimensions_view(plant, LimitReached("a limit"))
    assert nothing["computed_not_certified"] == {"lower": None, "upper": None}


@pytest.mark.parametrize("question", [{"information": "outputs"}, {"minimal": True}])
def test_a_question_about_neighbors_needs_neighbors(question: dict[str, Any]) -> None:
    with pytest.raises(UsageError, match="add 'neighbors' to the file"):
        assess(MultiChannelSystem(**EXAMPLE), **question)


def test_a_subset_and_a_channel_are_answered_when_they_are_asked_about() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    view = view_of(plant, subset=["2", "3"], channel="1", every_channel=True)
    subsystem = view["complementary_subsystem"]
    assert subsystem["normal_rank"] == 3
    assert subsystem["remnant"] == ["-1", "1"]
    assert subsystem["certificate"] == "complementary_subsystem.json"
    assert view["channel"]["observable"] is True
    assert view["channel"]["with_gains"]["observable"]["indices"] == {"1": [2]}
    assert view["channel"]["with_gains"]["both"]["exists"] is False
    assert view["every_channel"]["reason"].endswith("at the mode 1")
    assert "complementary_subsystem" not in view_of(plant, subset=[])


def test_the_spectrum_is_split_over_the_components_and_dead_channels_are_named() -> None:
    dead = MultiChannelSystem([[0]], [[[1]], [[0]]], [[[1]], [[1]]])
    view = view_of(dead)
    assert view["transfer_graph"]["dead_channels"] == ["2"]
    assert view["assignability"]["free"] is True
    assert view["assignability"]["blocks"][1] == {"channels": ["2"], "dimension": 0}
    assert view["complete"] is False
