"""All rules together, answers in plain words, and the list of sentences."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from mcexact.answer import (
    analysis,
    boxes,
    loops,
    modulo,
    nearby,
    parameters,
    performance,
    saturation,
    several_parameters,
    sharing,
    sharing_gap,
    time_varying,
)
from mcexact.answer.sentence import Context, Rulebook
from mcexact.answer.templates import Template, templates

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
        *modulo.OPTION_RULES,
        *analysis.MODE_RULES,
        *modulo.JOINT_RULES,
        *time_varying.TABLE_RULES,
        *nearby.WHY_RULES,
        *sharing.SHARING_RULES,
        *sharing_gap.GAP_RULES,
        *analysis.DETAIL_RULES,
    ]
)
ALLOCATION = Rulebook([*sharing.ALLOCATION_RULES, *sharing_gap.NOTE_RULES])
PARAMETERS = Rulebook([*parameters.RULES, *several_parameters.RULES])
LINKS = sharing.LINK_RULES
_OF_LOOPS = (*performance.RULES, *saturation.RULES, *modulo.LOOP_PART_RULES)
DESIGN = Rulebook([*loops.DESIGN, *_OF_LOOPS])
VERDICT = Rulebook([*loops.VERDICT, *_OF_LOOPS])
REFUSALS = loops.REFUSAL_RULES
OWN: Mapping[str, Rulebook] = {
    "box_controllable": boxes.BOX_CONTROLLABLE_RULES,
    "box_fixed": boxes.BOX_FIXED_RULES,
    "common_dimension": sharing.COMMON_DIMENSION_RULES,
}
"""Rules about answers of one kind alone."""


def with_own(rules: Rulebook, answers: Mapping[str, Any]) -> Rulebook:
    """Join these rules and those about the kinds of answers."""
    kinds = dict.fromkeys(answer.kind for answer in answers.values())
    return Rulebook([*rules, *(rule for kind in kinds for rule in OWN.get(kind, ()))])


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


# The list of all sentences, which is written to `SENTENCES.md`.

TOPICS: dict[str, tuple[Rulebook, tuple[ModuleType, ...]]] = {
    "analyze": (
        Rulebook([*ANALYSIS, *(rule for own in OWN.values() for rule in own)]),
        (nearby, modulo, time_varying, analysis, boxes, sharing, sharing_gap),
    ),
    "analyze, with parameters": (PARAMETERS, (parameters,)),
    "allocate": (ALLOCATION, (sharing, sharing_gap)),
    "allocate --links": (LINKS, (sharing,)),
    "design, certify": (Rulebook([*DESIGN, *VERDICT]), (loops, performance, saturation)),
    "design, if there is none": (REFUSALS, (loops,)),
}
"""The rules of each topic, and the modules that define their templates."""
FILE = Path(__file__).with_name("SENTENCES.md")

_INTRODUCTION = """\
# Every sentence about a system

The templates below make all sentences of `mcexact analyze`, `allocate`, `design` and `certify` on a
user's system, in text, JSON, HTML and LaTeX. A rule decides when a sentence holds. It
reads the claims of its premises and nothing else; the manifest records the values that it read, and
the independent checker verifies the manifest with its own rules. A premise is a certificate, given
by the stem of its file (`loop` is the one about the closed loop); the checker verifies every
certificate before the command ends. A sentence without premises repeats the user's input, or says
how a proof was found. A *remark* claims nothing: it is a title, or says that something is not
decided or not proved; the checker does not count it as implied. If a sentence does not only repeat
claims, it has a theorem: machine-checked theorems of `proofs/`, or the authors of a published one.
`make sentences` writes this file.
"""


def everything() -> Iterator[Template]:
    """Return all templates, in the order of the list."""
    for topic in TOPICS:
        yield from templates_of(topic)


def templates_of(topic: str) -> Iterator[Template]:
    """Return the templates that the rules of a topic fill, in the order of their definition."""
    rulebook, modules = TOPICS[topic]
    filled = {template for rule in rulebook for template in rule.templates}
    yield from (template for template in templates(*modules) if template in filled)


def premises_of(template: Template, rulebook: Rulebook) -> tuple[str, ...]:
    """Return the questions whose answers are premises of each template."""
    seen = (rule.premises for rule in rulebook if template in rule.templates)
    return tuple(dict.fromkeys(name for names in seen for name in names))


def listing() -> str:
    """Return the text of `SENTENCES.md`."""
    parts = [_INTRODUCTION]
    for topic, (rulebook, _) in TOPICS.items():
        parts.append(f"## {topic}\n")
        parts.append("| sentence | text | premises | theorem |\n|---|---|---|---|")
        parts += [_row(template, rulebook) for template in templates_of(topic)]
        parts.append("")
    return "\n".join(parts)


def _row(template: Template, rulebook: Rulebook) -> str:
    text = f"{template.label}: {template.text}" if template.label else template.text
    premises = ", ".join(f"`{premise}`" for premise in premises_of(template, rulebook))
    premises = premises if template.claims else "*remark*"
    cells = (template.key, f"`{text}`", premises, template.theorem)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


if __name__ == "__main__":
    FILE.write_text(listing(), encoding="utf-8")
