"""Rules that say when a sentence holds; they read checked certificates and nothing else."""

from collections.abc import Mapping
from typing import Any

from mcexact.answer import box_controllable, box_fixed, common_dimension
from mcexact.answer.rules import (
    allocation,
    analysis,
    design,
    details,
    links,
    parameters,
    refusals,
    several_parameters,
    sharing,
)
from mcexact.answer.sentence import Rulebook

ANALYSIS = Rulebook([*analysis.RULES, *sharing.RULES, *details.RULES])
ALLOCATION = allocation.RULES
PARAMETERS = Rulebook([*parameters.RULES, *several_parameters.RULES])
LINKS = links.RULES
DESIGN, VERDICT = design.DESIGN, design.VERDICT
REFUSALS = refusals.RULES
OWN: Mapping[str, Rulebook] = {
    "box_controllable": box_controllable.RULES,
    "box_fixed": box_fixed.RULES,
    "common_dimension": common_dimension.RULES,
}
"""Rules about answers of one kind alone."""


def with_own(rules: Rulebook, answers: Mapping[str, Any]) -> Rulebook:
    """Join these rules and those about the kinds of answers."""
    kinds = dict.fromkeys(answer.kind for answer in answers.values())
    return Rulebook([*rules, *(rule for kind in kinds for rule in OWN.get(kind, ()))])
