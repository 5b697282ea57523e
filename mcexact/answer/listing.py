"""The list of all sentences, as `SENTENCES.md` holds it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mcexact.answer.template import Template, templates
from mcexact.answer.wording import allocation, analysis, design, details, links, refusals

TOPICS = {
    "analyze": (analysis, details),
    "allocate": (allocation,),
    "allocate --arcs": (links,),
    "design, certify": (design,),
    "design, where there is none": (refusals,),
}
FILE = Path(__file__).with_name("SENTENCES.md")

_INTRODUCTION = """\
# Every sentence about a system

What `mcexact analyze`, `allocate`, `design` and `certify` say about a user's system is made by the
templates below, in text, JSON, HTML and LaTeX. A premise is a certificate, by the stem of its file
(`loop` is the one about the closed loop); the sentence is printed only where the claims of its
premises make it true, and every certificate goes through the independent checker before the command
ends. Without a premise a sentence repeats what the user gave or how a proof was found. The theorem
says why the claims imply it where it does not just repeat them: a machine-checked one of `proofs/`,
or whose it is. This file is written by `make sentences`.
"""


def everything() -> Iterator[Template]:
    """All templates, in the order of the list."""
    for modules in TOPICS.values():
        yield from templates(*modules)


def listing() -> str:
    """The text of `SENTENCES.md`."""
    parts = [_INTRODUCTION]
    for topic, modules in TOPICS.items():
        parts.append(f"## {topic}\n")
        parts.append("| sentence | text | premises | theorem |\n|---|---|---|---|")
        parts += [_row(template) for template in templates(*modules)]
        parts.append("")
    return "\n".join(parts)


def _row(template: Template) -> str:
    text = f"{template.label}: {template.text}" if template.label else template.text
    premises = ", ".join(f"`{premise}`" for premise in template.premises)
    cells = (template.key, f"`{text}`", premises, template.theorem)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


if __name__ == "__main__":
    FILE.write_text(listing(), encoding="utf-8")
