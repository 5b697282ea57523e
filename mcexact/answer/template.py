"""Sentences about a user's system: each made by a template that names what it rests on."""

from __future__ import annotations

import re
import string
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from mcexact.answer import formats

_INTEGER = r"\d+"
_DECIMAL = r"(?:-?\d+(?:\.\d+)?|about -?\d(?:\.\d+)?e[+-]\d+|about -?\d+(?:\.\d+)?)"
_NUMBER = rf"(?:-?\d+/\d+|{_DECIMAL})"
_COEFFICIENT = rf"(?:\({_NUMBER}\)|{_NUMBER})"
_POWER = r"x(?:\^\d+)?"
_TERM = rf"(?:{_COEFFICIENT}(?:\*{_POWER})?|{_POWER}|…)"
_POLYNOMIAL = rf"-?{_TERM}(?: [+-] {_TERM})*(?: \(degree \d+\))?"
_NAME = r"[^,{}|\n]+?"
_NAMES = rf"{_NAME}(?:, {_NAME})*"


@dataclass(frozen=True)
class Form:
    """How a field of a template is written, and what writings look like."""

    write: Callable[[Any], str]
    pattern: str


def choice(**words: str) -> Form:
    """A field that is one of a few phrases, each known by a keyword."""
    return Form(words.__getitem__, "(?:" + "|".join(map(re.escape, words.values())) + ")")


FORMS: dict[str, Form] = {
    "int": Form(str, _INTEGER),
    "name": Form(formats.name_text, _NAME),
    "number": Form(formats.number, _NUMBER),
    "decimal": Form(formats.decimal_number, _DECIMAL),
    "polynomial": Form(formats.polynomial, _POLYNOMIAL),
    "modes": Form(formats.modes, rf"(?:the mode {_NUMBER}|the \d+ roots of {_POLYNOMIAL})"),
    "channels": Form(formats.channels, rf"(?:channel {_NAME}|channels (?:{_NAMES} and )?{_NAME})"),
    "set": Form(formats.name_set, rf"\{{(?:{_NAMES})?\}}"),
    "edges": Form(
        formats.edges, rf"(?:no edges|\d+ edges|{_NAME} -> {_NAME}(?:, {_NAME} -> {_NAME})*)"
    ),
    "yes": Form(lambda value: "yes" if value else "no", "(?:yes|no)"),
    "time": choice(continuous="continuous", discrete="discrete"),
}
"""The forms of fields that every topic uses; topics add their own."""


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
    label: str = field(default="")

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
                parts.append(_form(spec or "").pattern)
        return re.compile("".join(parts))


class _Writer(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        return _form(format_spec).write(value)


def _form(spec: str) -> Form:
    """The form that a field names."""
    if spec.startswith("count "):
        noun = spec.removeprefix("count ")
        return Form(lambda size: formats.count(size, noun), rf"(?:1 {noun}|\d+ {noun}s)")
    return FORMS[spec]


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
