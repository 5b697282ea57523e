"""Sentences about a user's system, and their templates with fields for values."""

from __future__ import annotations

import string
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from mcexact.answer.forms import form

Premise = tuple[str, str, Any]
"""The file of a certificate, a JSON pointer into it, and the value there."""


class Sentence(str):
    """A text about a system, with its template and its premises.

    Attributes
    ----------
    template : Template
    cells : tuple of str
        The text as a row of a table, after its label or in the columns of the template.
    place : str
        The place given by a rule.
    because : tuple of Premise
        The premises: the claims that the rule has read.
    values : mapping
        The values that fill the fields of the template, by their names.
    """

    template: Template
    cells: tuple[str, ...]
    place: str = ""
    because: tuple[Premise, ...] = ()
    values: Mapping[str, Any]

    def __new__(
        cls, text: str, template: Template, cells: tuple[str, ...], values: Mapping[str, Any]
    ) -> Sentence:
        made = super().__new__(cls, text)
        made.template, made.cells, made.values = template, cells, values
        return made

    def bound(self, place: str, because: tuple[Premise, ...]) -> Sentence:
        """Return the sentence with its place and premises."""
        made = Sentence(str(self), self.template, self.cells, self.values)
        made.place, made.because = place, because
        return made

    @property
    def line(self) -> str:
        """The text, after the label if there is one."""
        return f"{self.template.label}: {self}" if self.template.label else str(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return (str, (str(self),))


@dataclass(frozen=True)
class Template:
    """A template of sentences, with fields.

    Parameters
    ----------
    key : str
        Its key in the list of all sentences.
    text : str
        Text with fields ``{name:form}``, where the form is one of `FORMS`, or ``{name:count
        noun}``.  In a row of a table ``" | "`` separates the columns.
    theorem : str
        The theorem by which the premises imply the sentence, if it does not only repeat a claim:
        machine-checked theorems of ``proofs/``, or the authors of a published theorem.
    label : str
        Its label in a table of names and values.
    claims : bool
        Whether its sentences claim something.  A title, and what is not decided or not proved, is a
        remark, which the checker does not count as implied.
    """

    key: str
    text: str
    theorem: str = ""
    label: str = ""
    claims: bool = True

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of its fields, each once."""
        named = (name for _, name, _, _ in string.Formatter().parse(self.text) if name)
        return tuple(dict.fromkeys(named))

    def __call__(self, **values: Any) -> Sentence:
        """Make the sentence with some values."""
        cells = tuple(_Writer().vformat(part, (), values) for part in self.text.split(" | "))
        labeled = (self.label, *cells) if self.label else cells
        used = {name: values[name] for name in self.fields}
        return Sentence(" | ".join(cells), self, labeled, used)


class _Writer(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        return form(format_spec)(value)


def templates(*modules: Any) -> Iterator[Template]:
    """Return the templates that modules define, in order, also those in tuples and mappings."""
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
