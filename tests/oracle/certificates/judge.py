"""The verdict on a document that a checker has accepted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from . import fixed, loops, parametric, parametric_rank, ranges, segments, sharing, structure
from .constructions import is_ranged, subject_of
from .one_parameter import ParametricPlant
from .reading import Unspecified, demand, record

TRUE, FALSE, UNDECIDED = "true", "false", "undecided"

KINDS: Mapping[str, Callable[[Any, Any, Any], bool]] = {
    "assignability": structure.assignability,
    "box_controllable": segments.controllable,
    "box_fixed": segments.fixed,
    "box_stable": segments.stable,
    "closed_loop_spectrum": loops.closed_loop_spectrum,
    "common_dimension": sharing.common_dimension,
    "communication": sharing.communication,
    "complementary_subsystem": structure.complementary_subsystem,
    "completeness": fixed.completeness,
    "controllability": structure.controllability,
    "controllability_indices": structure.controllability_indices,
    "deficiency": fixed.deficiency,
    "distributed_observer": loops.distributed_observer,
    "exceptional_gains": fixed.exceptional_gains,
    "fixed_spectrum": fixed.fixed_spectrum,
    "neighbor_graph": structure.neighbor_graph,
    "parametric_box_controllable": ranges.controllable_in_ranges,
    "parametric_box_fixed": ranges.fixed_in_ranges,
    "parametric_box_stable": ranges.stable_in_ranges,
    "parametric_fixed_spectrum": parametric.spectrum,
    "parametric_rank": parametric_rank.rank,
    "pencil_rank": fixed.rank_of_pencil,
    "setpoint": structure.setpoint,
    "shared_dimensions": sharing.shared_dimensions,
    "sharing_gap": structure.sharing_gap,
    "single_channel_gains": fixed.single_channel_gains,
    "stability": loops.stability,
    "transfer_graph": structure.transfer_graph,
}
MOST_STATES = 30


def judge(document: Mapping[str, Any]) -> tuple[str, str]:
    """Whether the claim of a document is true, and why not."""
    try:
        record(document, "format", "kind", "system", "subject", "claim", "witness")
        demand(document["format"] == "mcexact-certificate/1", "expected a certificate")
        kind = document["kind"]
        demand(isinstance(kind, str) and kind in KINDS, "expected a known kind")
        system: Any = subject_of(document)
        with_parameter = is_ranged(document) or isinstance(system, ParametricPlant)
        demand(with_parameter == kind.startswith("parametric_"), "expected another sort of plant")
        if system.n > MOST_STATES or system.m > 6:
            return UNDECIDED, f"{system.n} states, {system.m} channels"
        whole = kind == "distributed_observer" or kind.startswith(("box_", "parametric_box_"))
        hint = document if whole else document["witness"]
        holds = KINDS[kind](document["claim"], hint, system)
    except Unspecified as error:
        return FALSE, f"not as the format says: {error}"
    return (TRUE, "") if holds else (FALSE, "the claim is not true")
