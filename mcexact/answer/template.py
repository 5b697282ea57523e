"""Sentences about a user's system: the words, with fields for what was decided."""

from __future__ import annotations

import re
import string
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from mcexact.answer.forms import form

Premise = tuple[str, str, Any]
"""File of a certificate, JSON pointer into it, and what stands there."""


class Sentence(str):
    """A text about a system, the template that made it, and what it rests on.

    Attributes
    ----------
    template : Template
    cells : tuple of str
        The text as a row of a table: after its label, or in the columns of the template.
    place : str
        Where it stands, once a rule has said it.
    because : tuple of Premise
        The claims that the rule has read.
    """

    template: Template
    cells: tuple[str, ...]
    place: str = ""
    because: tuple[Premise, ...] = ()

    def __new__(cls, text: str, template: Template, cells: tuple[str, ...]) -> Sentence:
        made = super().__new__(cls, text)
        made.template, made.cells = template, cells
        return made

    def bound(self, place: str, because: tuple[Premise, ...]) -> Sentence:
        """The sentence as a rule has said it."""
        made = Sentence(str(self), self.template, self.cells)
        made.place, made.because = place, because
        return made

    @property
    def line(self) -> str:
        """The text, after its label if it has one."""
        return f"{self.template.label}: {self}" if self.template.label else str(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return (str, (str(self),))


@dataclass(frozen=True)
class Template:
    """A sentence with fields.

    Parameters
    ----------
    key : str
        Its name in the list of all sentences.
    text : str
        Fields are ``{name:form}``, a form one of `FORMS`, or ``{name:count noun}``.  In a row of a
        table ``" | "`` separates the columns.
    theorem : str
        Why the claims that a rule reads imply it, where it does not just repeat one of them:
        machine-checked theorems of ``proofs/``, or whose theorem it is.
    label : str
        What stands before it in a table of names and values.
    """

    key: str
    text: str
    theorem: str = ""
    label: str = ""

    def __call__(self, **values: Any) -> Sentence:
        """The sentence with these values."""
        cells = tuple(_Writer().vformat(part, (), values) for part in self.text.split(" | "))
        labeled = (self.label, *cells) if self.label else cells
        return Sentence(" | ".join(cells), self, labeled)

    def row(self, **values: Any) -> tuple[str, ...]:
        """The sentence as a row of a table."""
        return self(**values).cells

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """What the sentence looks like, whatever the values; after its label, if it has one."""
        parts = [re.escape(self.label + " | ") if self.label else ""]
        for literal, name, spec, _ in string.Formatter().parse(self.text):
            parts.append(re.escape(literal))
            if name is not None:
                parts.append(form(spec or "").pattern)
        return re.compile("".join(parts))


class _Writer(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        return form(format_spec).write(value)


def templates(*modules: Any) -> Iterator[Template]:
    """The templates that modules define, in their order, those in tuples and mappings too."""
    for module in modules:
        for name, value in vars(module).items():
            if not name.startswith("__"):
                yield from _inside(value)


def _inside(value: Any) -> Iterator[Template]:
    if isinstance(value, Template):
        yield value
    elif isinstance(value, tuple | dict):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _inside(each)
