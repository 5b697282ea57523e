"""The list of all sentences, which is written to `SENTENCES.md`."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from mcexact import answer
from mcexact.answer import rules
from mcexact.answer.sentence import Rulebook
from mcexact.answer.template import Template, templates
from mcexact.answer.wording import (
    allocation,
    analysis,
    design,
    details,
    links,
    parameters,
    refusals,
)

_OWN = [
    module
    for info in pkgutil.iter_modules(answer.__path__)
    if info.name != "listing"
    and hasattr(module := importlib.import_module(f"mcexact.answer.{info.name}"), "RULES")
]
# These kinds of answers define their own sentences and rules.

TOPICS: dict[str, tuple[Rulebook, tuple[ModuleType, ...]]] = {
    "analyze": (
        Rulebook([*rules.ANALYSIS, *(rule for kind in _OWN for rule in kind.RULES)]),
        (analysis, details, *_OWN),
    ),
    "analyze, with parameters": (rules.PARAMETERS, (parameters,)),
    "allocate": (rules.ALLOCATION, (allocation,)),
    "allocate --links": (rules.LINKS, (links,)),
    "design, certify": (Rulebook([*rules.DESIGN, *rules.VERDICT]), (design,)),
    "design, if there is none": (rules.REFUSALS, (refusals,)),
}
FILE = Path(__file__).with_name("SENTENCES.md")

_INTRODUCTION = """\
# Every sentence about a system

The templates below make all sentences of `mcexact analyze`, `allocate`, `design` and `certify` on a
user's system, in text, JSON, HTML and LaTeX. A rule of `rules/` decides when a sentence holds. It
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
    for _, modules in TOPICS.values():
        yield from templates(*modules)


def premises_of(template: Template, rulebook: Rulebook) -> tuple[str, ...]:
    """Return the questions whose answers are premises of each template."""
    seen = (rule.premises.values() for rule in rulebook if template in rule.templates)
    return tuple(dict.fromkeys(name for names in seen for name in names))


def listing() -> str:
    """Return the text of `SENTENCES.md`."""
    parts = [_INTRODUCTION]
    for topic, (rulebook, modules) in TOPICS.items():
        parts.append(f"## {topic}\n")
        parts.append("| sentence | text | premises | theorem |\n|---|---|---|---|")
        parts += [_row(template, rulebook) for template in templates(*modules)]
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
