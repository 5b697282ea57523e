"""The verdict on a document that a checker has accepted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from . import (
    fixed,
    loops,
    parametric,
    parametric_rank,
    patterns,
    performance,
    ranges,
    saturation,
    segments,
    sharing,
    steps,
    structure,
)
from .constructions import is_ranged, subject_of
from .one_parameter import ParametricPlant
from .reading import Undecided, Unspecified, demand, record

TRUE, FALSE, UNDECIDED = "true", "false", "undecided"

_TOPICS = (
    fixed,
    loops,
    parametric,
    parametric_rank,
    patterns,
    performance,
    ranges,
    saturation,
    segments,
    sharing,
    steps,
    structure,
)
KINDS: dict[str, Callable[[Any, Any, Any], bool]] = {
    kind: judge_of for topic in _TOPICS for kind, judge_of in topic.JUDGES.items()
}
"""The judge of each kind, which the module of its topic names."""
MOST_STATES = 30
ABOUT_THE_DOCUMENT = {
    "distributed_observer",
    *performance.JUDGES,
    *saturation.JUDGES,
    *steps.JUDGES,
}
"""The kinds, besides those about boxes, that are judged with the whole document."""


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
        whole = kind in ABOUT_THE_DOCUMENT or kind.startswith(("box_", "parametric_box_"))
        hint = document if whole else document["witness"]
        holds = KINDS[kind](document["claim"], hint, system)
    except Undecided as error:
        return UNDECIDED, str(error)
    except Unspecified as error:
        return FALSE, f"not as the format says: {error}"
    return (TRUE, "") if holds else (FALSE, "the claim is not true")
