"""The protocol of answers: claims, witness, display, and the certificate's JSON.

A kind of answer is a frozen dataclass in the module of its topic, declared with `answer`.  Each
field is a `claim`, which the checker verifies, or a part of the `witness` that proves the claims;
everything else is a property computed from the fields.  The certificate, reading it back, the JSON
view, and display on one line, in HTML and in LaTeX are all derived from the fields, so a kind
writes none of them.  `kind_named` imports the modules in ``TOPICS`` one by one until a kind is
declared, and `all_kinds` imports all of them.

Certificates are JSON as ``FORMAT.md`` specifies it, and equal answers have equal bytes.  Exact
computations find the same evidence on every processor; Lyapunov matrices and controllers that were
designed in floating point differ.  ``FORMAT.md`` says which certificates are reproducible byte for
byte.
"""

from __future__ import annotations

import dataclasses
import importlib
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar, NoReturn, Self, TypeVar, dataclass_transform

from mcexact import shown as shown_module
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import polynomial, rational_text, written
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import Document, plain, text_of, write_text
from mcexact.shown import LINE, Shown

# Display of answers: one line, HTML, LaTeX and plain data; items that do not fit are left out.

_CELL = 300
_MOST = 20


def line(answer: Answer) -> str:
    """Return the claims on one line, in which no number and no name is cut."""
    values = answer.claim()
    if answer.subject:
        values["of"] = tuple(each["construction"] for each in answer.subject)
    return call(type(answer).__name__, values)


def call(head: str, values: Mapping[str, Any]) -> str:
    """Return values by their names on one line, in which no number and no name is cut.

    Notes
    -----
    Each value first gets the space of its shortest form; the remaining space goes to the values
    with the shortest complete forms.
    """
    texts = {key: fitted(value, 0) for key, value in values.items()}
    room = LINE - len(_call(head, texts))
    for _, key in sorted((len(fitted(value, LINE)), key) for key, value in values.items()):
        longer = fitted(values[key], len(texts[key]) + room)
        room += len(texts[key]) - len(longer)
        texts[key] = longer
    return _call(head, texts)


def _call(head: str, texts: dict[str, str]) -> str:
    return f"{head}({', '.join(f'{key}={text}' for key, text in texts.items())})"


def fitted(value: Any, room: int) -> str:
    """Return a value in a number of characters, or in its shortest form if it needs more.

    Examples
    --------
    >>> fitted(("1", "2", "3", "4"), 18), fitted(("1", "2"), 0)
    ("('1', … 3 more)", '(… 2 more)')
    >>> fitted(Polynomial.of(7, 0, -3, 1), 30), fitted(Polynomial.of(7, 0, -3, 1), 12)
    ('x^3 - 3*x^2 + 7', '… (degree 3)')
    """
    if isinstance(value, (tuple, list)):
        return _sequence(value, room)
    if isinstance(value, Polynomial):
        text = polynomial(value, room)
        return text if len(text) <= room else f"… (degree {value.degree})"
    if isinstance(value, Matrix):
        return f"{value.nrows}×{value.ncols} matrix"
    if dataclasses.is_dataclass(value):
        names = getattr(value, "brief", ()) or (dataclasses.fields(value)[0].name,)
        parts = tuple(getattr(value, name) for name in names)
        return fitted(parts[0] if len(parts) == 1 else parts, room)
    text = rational_text(value) if isinstance(value, Fraction) else repr(value)
    short = value is None or isinstance(value, bool)
    return text if short or len(text) <= room else "…"


def _sequence(values: Sequence[Any], room: int) -> str:
    """Return the first few items, each complete, and the number of the others."""
    kept: list[str] = []
    used = len("(,)")
    for place, value in enumerate(values):
        left = len(values) - place - 1
        more = len(f", … {left} more") if left else 0
        text = fitted(value, LINE)
        if used + len(text) + more > room:
            break
        kept.append(text)
        used += len(text) + len(", ")
    left = len(values) - len(kept)
    if left:
        kept.append(f"… {left} more")
    return f"({', '.join(kept)}{',' if len(kept) == 1 and not left else ''})"


def plain_view(value: Any) -> Any:
    """Return plain data, with polynomials and matrices as lists of exact numbers."""
    if isinstance(value, Polynomial):
        return [written(c) for c in value.coefficients]
    if isinstance(value, Matrix):
        return [[written(entry) for entry in row] for row in value.rows()]
    if hasattr(value, "document"):
        return {key: plain_view(item) for key, item in value.document().items()}
    if isinstance(value, (tuple, list)):
        return [plain_view(item) for item in value]
    return plain(value)


def flat(value: Any) -> Any:
    """Return a value for one cell of a table: texts and numbers, or the number of items."""
    if value is None or isinstance(value, (bool, int, str, Fraction)):
        return value
    if isinstance(value, Polynomial):
        return str(value)
    if isinstance(value, Matrix):
        return f"{value.nrows} × {value.ncols}"
    return len(value) if isinstance(value, (tuple, list)) else fitted(value, _CELL)


def displayed(value: Any) -> Any:
    """Return a value as notebooks show it: parts as a table, and long values shortened."""
    if isinstance(value, tuple) and value and len(value) <= _MOST and _is_part(value[0]):
        return Parts(value)
    if isinstance(value, (bool, Matrix, Polynomial)) or _is_part(value):
        return value
    if isinstance(value, tuple) and value and all(isinstance(each, str) for each in value):
        names = ", ".join(value)
        return names if len(names) <= _CELL else fitted(value, _CELL)
    if isinstance(value, str) and len(value) <= _CELL:
        return value
    return "none" if value is None or value == () else fitted(value, _CELL)


def _is_part(value: Any) -> bool:
    return hasattr(value, "document") and hasattr(value, "_labeled")


class Parts(Shown):
    """Several parts of one kind, one row for each."""

    def __init__(self, parts: Sequence[Any]) -> None:
        self._parts = parts

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield each part with its number."""
        yield from ((str(k), each) for k, each in enumerate(self._parts, start=1))

    def _rows(self) -> list[list[Any]]:
        return [[value for _, value in each._labeled()] for each in self._parts]

    def _html(self) -> str:
        """Return a table in HTML."""
        return shown_module.grid([label for label, _ in self._parts[0]._labeled()], self._rows())

    def _latex(self) -> str:
        """Return an array in LaTeX."""
        return r" \quad ".join(each._latex() for each in self._parts)


# Declaration of kinds of answers: claims, witnesses, and what follows from them.

KINDS: dict[str, type[Answer]] = {}
"""The kinds of answers whose modules have been imported, by name."""
TOPICS = (
    "structure",
    "patterns",
    "modes",
    "sharing",
    "sharing_gap",
    "loops",
    "performance",
    "saturation",
    "boxes",
    "parameters",
)
"""The modules of this folder that declare kinds."""
_EXPLAINED = "mcexact.answer.rulebook", "explained"
"""Module and name of the function that explains any answer; it knows the rules of all kinds."""

AnyAnswer = TypeVar("AnyAnswer", bound="Answer")
AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])


def claim(label: str = "", *, key: str = "", optional: bool = False) -> Any:
    """A field that the checker verifies.

    Parameters
    ----------
    label : str
        Its label in tables; by default the key in words.
    key : str
        Its key in the certificate, if that is not the name of the field.
    optional : bool
        Whether the field is None by default; the certificate then leaves it out.
    """
    metadata = {"role": "claim", "label": label, "key": key, "optional": optional}
    default: Any = None if optional else dataclasses.MISSING
    return dataclasses.field(default=default, kw_only=optional, metadata=metadata)


LEFT_OUT = {"optional": True}
"""The metadata of a field of a `Part` that the certificate leaves out where it is None."""


def witness(*, whole: bool = False) -> Any:
    """A field that proves the claims.

    Parameters
    ----------
    whole : bool
        The field is a `Part` whose keys are those of the witness.
    """
    return dataclasses.field(metadata={"role": "witness", "whole": whole})


def shown(label: str = "") -> Callable[[AnyFunction], AnyFunction]:
    """Mark a property that is displayed after the claims."""

    def marked(get: AnyFunction) -> AnyFunction:
        get.__dict__["label"] = label
        return get

    return marked


@dataclass(frozen=True)
class Part(Shown):
    """A piece of a claim or of a witness: a frozen dataclass whose keys are its fields.

    A key that is not a Python name is given by the metadata ``key`` of its field.
    """

    brief: ClassVar[tuple[str, ...]] = ()
    """The fields that represent it on one line; by default the first."""

    def document(self) -> dict[str, Any]:
        """Return the object of ``FORMAT.md``, with exact objects as values."""
        return _by_key(self, dataclasses.fields(self))

    def to_dict(self) -> dict[str, Any]:
        """Return the object as plain data."""
        return {key: plain_view(value) for key, value in self.document().items()}

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the labels and values that notebooks show."""
        for key, value in self.document().items():
            yield _in_words(key), displayed(value)

    def __init_subclass__(cls) -> None:
        # dataclasses write a representation of any length where a class has none of its own.
        cls.__repr__ = Part.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        return call(type(self).__name__, self.document())


def _values(system: Any) -> tuple[Any, ...]:
    """All data on which decisions about the nominal system depend, to compare two systems."""
    return type(system).__name__, system.time, system.A, system.channels, getattr(system, "D", None)


@dataclass(frozen=True, repr=False, eq=False)
class Answer(Shown):
    """A decision about a system, with its proof; two answers are equal if their certificates are.

    Attributes
    ----------
    about : MultiChannelSystem
        The plant or the derived system that the answer is about.
    """

    kind: ClassVar[str] = ""
    dual_keys: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """Other names of keys where the answer is displayed that is about a dual system."""

    with_feedthrough: ClassVar[bool] = False
    """Whether it may be about a system with feedthrough: then no claim depends on its D."""

    about: MultiChannelSystem

    def __post_init__(self) -> None:
        if getattr(self.about, "D", None) is not None and not self.with_feedthrough:
            InputError.require(self.about, MultiChannelSystem, "system")

    @classmethod
    def known(cls, argument: Any, system: Any, where: str) -> Self | None:
        """Return an argument that has to be None or an answer of this kind about a system.

        Radii are not compared: the search about a box takes the answer about its center.

        Raises
        ------
        InputError
            If it is an answer of another kind.
        UsageError
            If it is about another system.
        """
        if argument is None:
            return None
        InputError.require(argument, cls, where)
        answer: Self = argument
        if _values(answer.about) != _values(system):
            raise UsageError("expected it about this system, found it about another", where=where)
        return answer

    @property
    def system(self) -> Document:
        """The user's plant, as the canonical object of ``FORMAT.md``."""
        return self.about.plant.canonical_document()

    @property
    def subject(self) -> tuple[Document, ...]:
        """The constructions that lead from the plant to the system of the answer, in order."""
        return self.about.subject

    def claim(self) -> dict[str, Any]:
        """Return the statement, with the keys of the kind's ``claim``."""
        return _by_key(self, fields_of(type(self), "claim"))

    def witness(self) -> dict[str, Any]:
        """Return the evidence, with the keys of the kind's ``witness``."""
        evidence: dict[str, Any] = {}
        for each in fields_of(type(self), "witness"):
            value = getattr(self, each.name)
            evidence |= value.document() if each.metadata["whole"] else {each.name: value}
        return evidence

    def document(self) -> dict[str, Any]:
        """Return claim and witness, as a part of the certificate of another answer."""
        return {"claim": self.claim(), "witness": self.witness()}

    def entries(self) -> Iterator[tuple[str, str, Any]]:
        """Yield key, label and value of the claims and of the marked properties."""
        dual = self.dual_keys if is_about_dual(self.subject) else {}
        for each in fields_of(type(self), "claim"):
            key, value = dual.get(key_of(each), key_of(each)), getattr(self, each.name)
            if value is not None or not is_optional(each):
                yield key, each.metadata["label"] or _in_words(key), value
        for name, label in shown_of(type(self)).items():
            yield name, label or _in_words(name), getattr(self, name)

    def to_dict(self) -> dict[str, Any]:
        """Return everything displayed, as plain data."""
        return {key: plain_view(value) for key, _, value in self.entries()}

    def to_row(self) -> dict[str, Any]:
        """Return one flat row for a table; a long claim, such as factors, becomes their number.

        Examples
        --------
        >>> from mcexact import MultiChannelSystem, fixed_spectrum
        >>> spectrum = fixed_spectrum(MultiChannelSystem([[1]], [[[0]]], [[[1]]]))
        >>> row = spectrum.to_row()
        >>> row["polynomial"], row["factors"], row["stabilizable"]
        ('x - 1', 1, False)
        """
        row = {key: flat(value) for key, _, value in self.entries()}
        return {"kind": self.kind, "system": self.about.name, **row}

    def _text(self) -> str:
        return text_of([self.kind, self.about.plant.digest(), self.subject, self.document()])

    def __eq__(self, other: object) -> bool:
        return self._text() == other._text() if isinstance(other, Answer) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._text())

    def __bool__(self) -> NoReturn:
        claimed = [key for key, value in self.claim().items() if isinstance(value, bool)]
        known = [name for name in shown_of(type(self)) if isinstance(getattr(self, name), bool)]
        named = " or ".join(f".{name}" for name in known + claimed or self.claim())
        raise TypeError(f"an answer is neither true nor false: ask for {named}")

    def __repr__(self) -> str:
        return line(self)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the labels and values that notebooks show."""
        for _, label, value in self.entries():
            yield label, displayed(value)

    def explain(self) -> str:
        """Say in plain words what is decided, in the sentences of `analyze`.

        If there is no sentence about this answer, the text is the statement of the independent
        checker, which verifies the answer first.
        """
        module, name = _EXPLAINED
        words: str = getattr(importlib.import_module(module), name)(self)
        return words


def is_about_dual(subject: Sequence[Document]) -> bool:
    """Whether the last construction of a subject is the dual."""
    return bool(subject) and subject[-1]["construction"] == "dual"


@dataclass_transform(frozen_default=True, field_specifiers=(claim, witness))
def answer(kind: str) -> Callable[[type[AnyAnswer]], type[AnyAnswer]]:
    """Make a class a kind of answer: a frozen dataclass of claims and witnesses.

    Parameters
    ----------
    kind : str
        Its name in certificates, which the checker's rule also has.
    """

    def declare(cls: type[AnyAnswer]) -> type[AnyAnswer]:
        cls.kind = kind
        KINDS[kind] = dataclass(frozen=True, repr=False, eq=False)(cls)
        return cls

    return declare


def kind_named(name: str) -> type[Answer]:
    """Return the class of a kind of answer, and import topics until its own is there.

    Raises
    ------
    KeyError
        If there is no such kind.
    """
    for topic in TOPICS:
        if name in KINDS:
            break
        importlib.import_module(f"mcexact.answer.{topic}")
    return KINDS[name]


def all_kinds() -> dict[str, type[Answer]]:
    """Import all topics, and return the class of every kind by its name, sorted."""
    for topic in TOPICS:
        importlib.import_module(f"mcexact.answer.{topic}")
    return dict(sorted(KINDS.items()))


def fields_of(kind: type[Answer], role: str) -> list[dataclasses.Field[Any]]:
    """Return the claims of a kind, or the fields of its witness."""
    return [each for each in dataclasses.fields(kind) if each.metadata.get("role") == role]


def shown_of(kind: type[Answer]) -> dict[str, str]:
    """Return the marked properties with their labels."""
    labels = {}
    for name, each in vars(kind).items():
        get = each.func if isinstance(each, cached_property) else getattr(each, "fget", None)
        if "label" in getattr(get, "__dict__", {}):
            labels[name] = get.__dict__["label"]
    return labels


def key_of(each: dataclasses.Field[Any]) -> str:
    """Return the key of a field in the certificate."""
    return each.metadata.get("key") or each.name


def is_optional(each: dataclasses.Field[Any]) -> bool:
    """Return whether a field that is None is left out of the certificate."""
    return bool(each.metadata.get("optional"))


def _by_key(owner: Any, fields: Iterable[dataclasses.Field[Any]]) -> dict[str, Any]:
    """Return the keys and values of the fields that are not left out."""
    values = {each: getattr(owner, each.name) for each in fields}
    return {key_of(f): v for f, v in values.items() if v is not None or not is_optional(f)}


def _in_words(key: str) -> str:
    """Return a key in words, as a label."""
    return key.replace("_", " ")


# Answers written as certificates, in the JSON of ``FORMAT.md``.

FORMAT = "mcexact-certificate/1"


def document(answer: Answer) -> dict[str, Any]:
    """Return the certificate as a JSON object of plain data, with the six keys of ``FORMAT.md``."""
    return {
        "format": FORMAT,
        "kind": answer.kind,
        "system": answer.system,
        "subject": plain(answer.subject),
        "claim": plain(answer.claim()),
        "witness": plain(answer.witness()),
    }


def encode(answer: Answer, *, system_by_digest: bool = False) -> str:
    """Return the certificate as JSON text with a final line feed; equal answers give equal text.

    Parameters
    ----------
    answer : Answer
    system_by_digest : bool
        Whether it names the plant by its digest alone: the checker then needs the system file, too.

    Notes
    -----
    The same question gives the same certificate on every processor, unless floating point proposed
    the evidence: the quadratic forms of the kind ``stability``, and all answers about the loop of a
    controller designed in floating point.  Such certificates are only valid.
    """
    parts = {
        "claim": text_of(answer.claim()),
        "format": text_of(FORMAT),
        "kind": text_of(answer.kind),
        "subject": text_of(answer.subject),
        "system": text_of(answer.about.plant.digest())
        if system_by_digest
        else answer.about.plant.canonical_text(),
        "witness": text_of(answer.witness()),
    }
    return "{" + ",".join(f'"{key}":{text}' for key, text in parts.items()) + "}\n"


def save_certificate(
    answer: Answer, path: str | os.PathLike[str], *, system_by_digest: bool = False
) -> None:
    """Write an answer to a certificate file, completely or not at all.

    Parameters
    ----------
    answer : Answer
    path : path
    system_by_digest : bool
        Whether it names the plant by its digest alone, which is much shorter for a large plant: the
        checker and `load_certificate` then need the plant, too.

    Raises
    ------
    NotWritten
        If the file cannot be written.
    InputError
        If the answer is something else.
    """
    InputError.require(answer, Answer, "answer")
    write_text(path, encode(answer, system_by_digest=system_by_digest))
