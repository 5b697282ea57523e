"""The protocol of answers: a claim about a system with a witness that proves it, declared once.

A kind of answer is a frozen dataclass in the module of its topic.  Each field is a claim or a part
of the witness, and everything else is a property of these.  The certificate, reading it back, the
JSON view and all forms of display are derived from the fields.
"""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar, NoReturn, Self, TypeVar, dataclass_transform

from mcexact.answer import showing
from mcexact.errors import InputError, UsageError
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import Document, text_of
from mcexact.shown import Shown

KINDS: dict[str, type[Answer]] = {}
"""The kinds of answers whose modules have been imported, by name."""
HOMES = {
    "assignability": "mcexact.answer.assignability",
    "box_controllable": "mcexact.answer.box_controllable",
    "box_fixed": "mcexact.answer.box_fixed",
    "box_stable": "mcexact.answer.box_stable",
    "closed_loop_spectrum": "mcexact.answer.closed_loop_spectrum",
    "common_dimension": "mcexact.answer.common_dimension",
    "communication": "mcexact.answer.communication",
    "complementary_subsystem": "mcexact.answer.complementary_subsystem",
    "completeness": "mcexact.answer.completeness",
    "controllability": "mcexact.answer.controllability",
    "controllability_indices": "mcexact.answer.controllability_indices",
    "deficiency": "mcexact.answer.deficiency",
    "distributed_observer": "mcexact.answer.distributed_observer",
    "exceptional_gains": "mcexact.answer.exceptional_gains",
    "fixed_spectrum": "mcexact.answer.fixed_spectrum",
    "neighbor_graph": "mcexact.answer.neighbor_graph",
    "parametric_box_controllable": "mcexact.answer.parametric_box_controllable",
    "parametric_box_fixed": "mcexact.answer.parametric_box_fixed",
    "parametric_box_stable": "mcexact.answer.parametric_box_stable",
    "parametric_fixed_spectrum": "mcexact.answer.parametric_fixed_spectrum",
    "parametric_rank": "mcexact.answer.parametric_rank",
    "pencil_rank": "mcexact.answer.pencil_rank",
    "setpoint": "mcexact.answer.setpoint",
    "shared_dimensions": "mcexact.answer.shared_dimensions",
    "single_channel_gains": "mcexact.answer.single_channel_gains",
    "stability": "mcexact.answer.stability",
    "transfer_graph": "mcexact.answer.transfer_graph",
}
"""The module of each kind of answer."""
_EXPLAINED = "mcexact.answer.explaining", "explained"
"""What says an answer in words, which knows the rules of all kinds."""

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
        By default it is None, and then the certificate leaves it out.
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
        return _given(self, dataclasses.fields(self))

    def to_dict(self) -> dict[str, Any]:
        """Return the same as plain data."""
        return {key: showing.plain_view(value) for key, value in self.document().items()}

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the labels and values that notebooks show."""
        for key, value in self.document().items():
            yield _in_words(key), showing.displayed(value)

    def __init_subclass__(cls) -> None:
        # dataclasses write a representation of any length where a class has none of its own.
        cls.__repr__ = Part.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        return showing.call(type(self).__name__, self.document())


def _values(system: Any) -> tuple[Any, ...]:
    """What decisions about a system at its nominal values depend on."""
    return type(system).__name__, system.time, system.A, system.channels


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

    about: MultiChannelSystem

    @classmethod
    def known(cls, found: Any, system: Any, where: str) -> Self | None:
        """An argument that is this answer about a system, if it is known; None if it is not.

        Radii are of no account: answers about a box are searched beside that about its center.

        Raises
        ------
        InputError
            If it is another answer.
        UsageError
            If it is about another system.
        """
        if found is None:
            return None
        InputError.require(found, cls, where)
        answer: Self = found
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
        return _given(self, fields_of(type(self), "claim"))

    def witness(self) -> dict[str, Any]:
        """Return the evidence, with the keys of the kind's ``witness``."""
        found: dict[str, Any] = {}
        for each in fields_of(type(self), "witness"):
            value = getattr(self, each.name)
            found |= value.document() if each.metadata["whole"] else {each.name: value}
        return found

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
        return {key: showing.plain_view(value) for key, _, value in self.entries()}

    def to_row(self) -> dict[str, Any]:
        """Return one flat row for a table: of long claims, such as factors, their number.

        Examples
        --------
        >>> from mcexact import MultiChannelSystem, fixed_spectrum
        >>> found = fixed_spectrum(MultiChannelSystem([[1]], [[[0]]], [[[1]]]))
        >>> found.to_row()["polynomial"], found.to_row()["factors"], found.to_row()["stabilizable"]
        ('x - 1', 1, False)
        """
        row = {key: showing.flat(value) for key, _, value in self.entries()}
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
        return showing.line(self)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the labels and values that notebooks show."""
        for _, label, value in self.entries():
            yield label, showing.displayed(value)

    def explain(self) -> str:
        """Say in plain words what is decided, in the sentences of `analyze`.

        An answer about which these have no sentence is stated as a theorem, in the words of the
        independent checker, which verifies it for this.
        """
        module, name = _EXPLAINED
        said: str = getattr(importlib.import_module(module), name)(self)
        return said


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

    def made(cls: type[AnyAnswer]) -> type[AnyAnswer]:
        cls.kind = kind
        KINDS[kind] = dataclass(frozen=True, repr=False, eq=False)(cls)
        return cls

    return made


def kind_named(name: str) -> type[Answer]:
    """Return the class of a kind of answer, whose module is imported.

    Raises
    ------
    KeyError
        If there is no such kind.
    """
    importlib.import_module(HOMES[name])
    return KINDS[name]


def fields_of(kind: type[Answer], role: str) -> list[dataclasses.Field[Any]]:
    """Return the claims of a kind, or the fields of its witness."""
    return [each for each in dataclasses.fields(kind) if each.metadata.get("role") == role]


def shown_of(kind: type[Answer]) -> dict[str, str]:
    """Return the marked properties with their labels."""
    found = {}
    for name, each in vars(kind).items():
        get = each.func if isinstance(each, cached_property) else getattr(each, "fget", None)
        if "label" in getattr(get, "__dict__", {}):
            found[name] = get.__dict__["label"]
    return found


def key_of(each: dataclasses.Field[Any]) -> str:
    """Return the key of a field in the certificate."""
    return each.metadata.get("key") or each.name


def is_optional(each: dataclasses.Field[Any]) -> bool:
    """Return whether a field that is None is left out of the certificate."""
    return bool(each.metadata.get("optional"))


def _given(found: Any, fields: Iterable[dataclasses.Field[Any]]) -> dict[str, Any]:
    """Return the keys and values of the fields that are not left out."""
    values = {each: getattr(found, each.name) for each in fields}
    return {key_of(f): v for f, v in values.items() if v is not None or not is_optional(f)}


def _in_words(key: str) -> str:
    """Return a key in words, as a label."""
    return key.replace("_", " ")
