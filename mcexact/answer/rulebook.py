"""The rules about answers of `analyze` and `allocate`, and answers in plain words.

The rules about loops and about parameters are in `mcexact.answer.listing`, with the list of all
sentences: few plants need them, and they take longer to import than most questions.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

from mcexact.answer import (
    analysis,
    failures,
    modulo,
    nearby,
    patterns,
    sharing,
    sharing_gap,
    time_varying,
)
from mcexact.answer.sentence import Context, Rulebook

if TYPE_CHECKING:
    from mcexact.answer.protocol import Answer
    from mcexact.answer.templates import Sentence


# Rules that say when a sentence holds; they read checked certificates and nothing else.

ANALYSIS = Rulebook(
    [
        *nearby.NEARBY_RULES,
        *modulo.FILTER_RULES,
        *modulo.PART_RULES,
        *analysis.ANALYSIS_RULES,
        *time_varying.ANSWER_RULES,
        *failures.ANSWER_RULES,
        *modulo.OPTION_RULES,
        *analysis.MODE_RULES,
        *modulo.JOINT_RULES,
        *time_varying.TABLE_RULES,
        *failures.TABLE_RULES,
        *patterns.WHY_RULES,
        *nearby.LAW_RULES,
        *sharing.SHARING_RULES,
        *sharing_gap.GAP_RULES,
        *analysis.DETAIL_RULES,
    ]
)
ALLOCATION = Rulebook([*sharing.ALLOCATION_RULES, *sharing_gap.NOTE_RULES])
LINKS = sharing.LINK_RULES
OWN: Mapping[str, str] = {
    "box_controllable": "boxes:BOX_CONTROLLABLE_RULES",
    "box_fixed": "boxes:BOX_FIXED_RULES",
    "common_dimension": "sharing:COMMON_DIMENSION_RULES",
}
"""Rules about answers of one kind alone: the module that has them, and their name."""


def own_rules(kind: str) -> Rulebook:
    """The rules about answers of this kind alone."""
    module, _, name = OWN[kind].partition(":")
    rules: Rulebook = getattr(import_module(f"mcexact.answer.{module}"), name)
    return rules


def with_own(rules: Rulebook, answers: Mapping[str, Any]) -> Rulebook:
    """Join these rules and those about the kinds of answers."""
    kinds = dict.fromkeys(answer.kind for answer in answers.values())
    return Rulebook([*rules, *(rule for kind in kinds if kind in OWN for rule in own_rules(kind))])


# Answers in plain words: the sentences that follow from one alone, or its whole theorem.

_PLACES = ("answer", "answer.mode", "subsystem.title", "subsystem", "channel", "table")
_OUTPUTS = "augmented_outputs"


def question_of(answer: Answer) -> str:
    """Return the question that rules about an answer name; empty if it depends on the caller."""
    constructions = [each["construction"] for each in answer.subject]
    if (answer.kind, constructions) == ("box_fixed", ["integrators"]):
        return "box_setpoints"
    if constructions not in ([], ["dual"], [_OUTPUTS], [_OUTPUTS, "dual"]):
        return ""
    claim, dual = answer.claim(), constructions[-1:] == ["dual"]
    if answer.kind == "controllability":
        whose = "joint" if len(claim["channels"]) == answer.about.m else "channel"
        return f"{whose}_{'observability' if dual else 'controllability'}"
    if answer.kind == "box_fixed":
        return "box_fixed_modes" if claim["bound"] is None else "box_stabilizability"
    if answer.kind == "box_controllable":
        whole = claim["bound"] is None and len(claim["channels"]) == answer.about.m
        return f"box_{'observability' if dual else 'controllability'}" if whole else ""
    if answer.kind == "controllability_indices":
        return "observability_indices" if dual else "controllability_indices"
    if answer.kind in {"shared_dimensions", "common_dimension"}:
        name = answer.kind.replace("shared_", "minimal_shared_", 1)
        return f"{name}_{claim['share'].replace('+', '_')}"
    return {"communication": "minimal_communication"}.get(answer.kind, answer.kind)


def explained(answer: Answer) -> str:
    """Return the sentences about an answer, or else the statement that the checker verifies."""
    name = question_of(answer)
    own = "outputs" if any(each["construction"] == _OUTPUTS for each in answer.subject) else "own"
    context = Context(answer.about.plant, {"information": own})
    rules = with_own(ANALYSIS, {name: answer})
    sentences = [
        each
        for rule in rules
        if name and rule.premises
        for each in rule.apply({name: answer}, context, ())
        if each.place in _PLACES
    ]
    if sentences:
        return in_words(sentences)
    from mcexact.answer.check import check

    verdict = check(answer)
    return verdict.statement or verdict.line()


def in_words(sentences: Iterable[Sentence]) -> str:
    """Return sentences, one a line, each after its label if it has one."""
    return "\n".join(each.line for each in sentences)
