"""Answers in plain words: the sentences that follow from one alone, or its whole theorem."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from mcexact.answer.rules import ANALYSIS, with_own
from mcexact.answer.sentence import Given

if TYPE_CHECKING:
    from mcexact.answer.protocol import Answer
    from mcexact.answer.template import Sentence

_PLACES = ("answer", "answer.mode", "subsystem.title", "subsystem", "channel", "table")
_OUTPUTS = "augmented_outputs"


def question_of(answer: Answer) -> str:
    """Return the question that rules about an answer name; empty if it depends on the caller."""
    made = [each["construction"] for each in answer.subject]
    if (answer.kind, made) == ("box_fixed", ["integrators"]):
        return "box_setpoints"
    if made not in ([], ["dual"], [_OUTPUTS], [_OUTPUTS, "dual"]):
        return ""
    claim, dual = answer.claim(), made[-1:] == ["dual"]
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
    given = Given(answer.about.plant, {"information": own})
    rules = with_own(ANALYSIS, {name: answer})
    said = [
        each
        for rule in rules
        if name and rule.premises
        for each in rule.apply({name: answer}, given, ())
        if each.place in _PLACES
    ]
    if said:
        return in_words(said)
    from mcexact.answer.check import check

    found = check(answer)
    return found.statement or found.line()


def in_words(said: Iterable[Sentence]) -> str:
    """Return sentences, one a line, each after its label if it has one."""
    return "\n".join(each.line for each in said)
