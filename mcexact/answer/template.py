"""Sentences about a user's system: each made by a template that names what it rests on."""

from __future__ import annotations

import re
import string
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from mcexact.answer.forms import form


class Sentence(str):
    """A text about a system, and the template that made it."""

    template: Template

    def __new__(cls, text: str, template: Template) -> Sentence:
        made = super().__new__(cls, text)
        made.template = template
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return (str, (str(self),))


@dataclass(frozen=True)
class Template:
    """A sentence with fields, and what it rests on.

    Parameters
    ----------
    key : str
        Its name in the list of all sentences.
    text : str
        Fields are ``{name:form}``, a form one of `FORMS`, or ``{name:count noun}``.
    premises : tuple of str
        The answers whose certified claims make it true, by the stems of their certificates' files;
        none where it repeats what the user gave.
    theorem : str
        Why the claims imply it, where it does not just repeat one of them: machine-checked theorems
        of ``proofs/``, or whose theorem it is.
    label : str
        What stands before it in a table of names and values.
    """

    key: str
    text: str
    premises: tuple[str, ...] = ()
    theorem: str = ""
    label: str = ""

    def __call__(self, **values: Any) -> Sentence:
        """The sentence with these values."""
        return Sentence(_Writer().vformat(self.text, (), values), self)

    def row(self, **values: Any) -> tuple[str, str]:
        """The sentence after its label, as a row of a table."""
        return (self.label, self(**values))

    def cells(self, **values: Any) -> tuple[str, ...]:
        """The cells of a row of a table with columns; the text separates them by ``" | "``."""
        writer = _Writer()
        return tuple(
            Sentence(writer.vformat(part, (), values), self) for part in self.text.split(" | ")
        )

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
