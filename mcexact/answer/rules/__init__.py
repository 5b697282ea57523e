"""Rules that say when a sentence holds; they read checked certificates and nothing else."""

import sys
from collections.abc import Mapping
from typing import Any

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


def with_own(rules: Rulebook, answers: Mapping[str, Any]) -> Rulebook:
    """Join these rules and the ``RULES`` of kinds of answers."""
    homes = dict.fromkeys(type(answer).__module__ for answer in answers.values())
    own = (getattr(sys.modules[home], "RULES", ()) for home in homes)
    return Rulebook([*rules, *(rule for brought in own for rule in brought)])
