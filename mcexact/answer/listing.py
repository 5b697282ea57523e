"""The rules of all commands by topic, and the list of all sentences, `SENTENCES.md`."""

from __future__ import annotations

import json
import string
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from mcexact import checker
from mcexact.answer import (
    analysis,
    boxes,
    failures,
    loops,
    modulo,
    nearby,
    parameters,
    patterns,
    performance,
    saturation,
    several_parameters,
    sharing,
    sharing_gap,
    time_varying,
)
from mcexact.answer.rulebook import ALLOCATION, ANALYSIS, LINKS, OWN, own_rules
from mcexact.answer.sentence import Rulebook
from mcexact.answer.templates import (
    BANDWIDTH,
    GAINS,
    WEIGHTS,
    Template,
    agrees,
    phrases_of,
    templates,
)

PARAMETERS = Rulebook([*parameters.RULES, *several_parameters.RULES])
_OF_LOOPS = (*performance.RULES, *saturation.RULES, *modulo.LOOP_PART_RULES)
DESIGN = Rulebook([*loops.DESIGN, *_OF_LOOPS])
VERDICT = Rulebook([*loops.VERDICT, *_OF_LOOPS])
REFUSALS = loops.REFUSAL_RULES

TOPICS: dict[str, tuple[Rulebook, tuple[ModuleType, ...]]] = {
    "analyze": (
        Rulebook([*ANALYSIS, *(rule for kind in OWN for rule in own_rules(kind))]),
        (nearby, modulo, time_varying, failures, patterns, analysis, boxes, sharing, sharing_gap),
    ),
    "analyze, with parameters": (PARAMETERS, (parameters,)),
    "allocate": (ALLOCATION, (sharing, sharing_gap)),
    "allocate --links": (LINKS, (sharing,)),
    "design, certify": (Rulebook([*DESIGN, *VERDICT]), (loops, performance, saturation)),
    "design, if there is none": (REFUSALS, (loops,)),
    "design, certify, periodic": (time_varying.PERIODIC_RULES, (time_varying,)),
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
    text = template.in_line(template.text.split(" | "))
    premises = ", ".join(f"`{premise}`" for premise in premises_of(template, rulebook))
    premises = premises if template.claims else "*remark*"
    cells = (template.key, f"`{text}`", premises, template.theorem)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


# The templates as the checker reads them.

WORDINGS = Path(checker.__path__[0]) / "wordings.json"
_ROUNDED = {
    "digits_below": "below",
    "digits_above": "above",
    "percent": "percent below",
    "percent_above": "percent above",
    "part": "part above",
    "step": "near",
    "frequency": "near",
}


def wordings() -> str:
    """The text of the checker's ``wordings.json``: of each rule the words and fields in order."""
    parts = {each.key: json.dumps(_wording(each), ensure_ascii=False) for each in everything()}
    return "{\n" + ",\n".join(f'"{key}": {parts[key]}' for key in sorted(parts)) + "\n}\n"


def _wording(template: Template) -> list[Any]:
    return _parts(template.in_line(template.text.split(" | ")))


def _parts(text: str) -> list[Any]:
    """The words and fields of a text."""
    parts: list[Any] = []
    for words, name, spec, _ in string.Formatter().parse(text):
        parts += [words] if words else []
        if spec == "weights":
            parts += [*_parts(WEIGHTS), ["if", "bandwidth", *_parts(BANDWIDTH)]]
        elif name:
            parts.append(_field(name, spec or ""))
    return parts


def _field(name: str, spec: str) -> list[Any]:
    """A field: a rounded number, a region, a whole number, one of some phrases, or anything."""
    if spec in _ROUNDED:
        return [_ROUNDED[spec], name]
    if spec.startswith("count "):
        return ["count", name, spec.removeprefix("count ")]
    if spec == "gains":
        return ["maybe", *_parts(GAINS)]
    if spec in {"diagonal", "int", "yes"}:
        return [spec, name]
    if spec == "region":
        return [spec]
    phrases = phrases_of(spec)
    if not phrases:
        return ["any"]
    return ["agree" if agrees(spec) else "of", *phrases]


if __name__ == "__main__":
    FILE.write_text(listing(), encoding="utf-8")
    WORDINGS.write_text(wordings(), encoding="utf-8")
