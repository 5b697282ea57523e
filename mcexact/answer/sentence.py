"""Sentences bound to claims: rules read certificates alone, and the values read are recorded.

A `Rule` is a generator that takes the answers that it names as premises, and yields sentences.  It
sees an answer only as a `Claim`, which records the place and the value of all that is read.  So
each sentence knows the values that it depends on, and `manifest` writes them beside it; the checker
verifies the sentence by rules of its own.  What a rule may repeat without a premise, such as names
and sizes, is in `Context`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any, TypeVar

from mcexact.answer.protocol import Answer
from mcexact.answer.templates import Sentence, Template
from mcexact.model.text import plain, sha256
from mcexact.shown import framed

FORMAT = "mcexact-manifest/1"
MANIFEST = "manifest.json"
"""The name of the manifest's file, in the folder of the certificates."""
PLANT = ".plant"
"""The end of the name of a plant's file there, behind its digest."""
LOOP = ("closed_loop_spectrum", "stability", "distributed_observer")
"""The kinds about a closed loop; rules refer to the first one that is available as ``loop``."""
_ALIASES = {"loop": LOOP, "bounded_loop": LOOP[1:]}

Read = dict[tuple[str, str], Any]
F = TypeVar("F", bound=Callable[..., Iterator[Sentence]])


@dataclass(frozen=True)
class Context:
    """The context of sentences: the user's input, which they may repeat without a premise.

    Attributes
    ----------
    system : MultiChannelSystem or ParametricSystem
        The system, used for its sizes, names, time domain and neighbor graph, not for its matrices.
    asked : mapping
        The user's requests, and how a proof was found.
    """

    system: Any
    asked: Mapping[str, Any] = field(default_factory=dict)

    def __getattr__(self, name: str) -> Any:
        if name in {"n", "m", "name", "names", "time", "neighbors"}:
            return getattr(self.system, name)
        if name.startswith("_") or name not in self.asked:
            raise AttributeError(name)
        return self.asked[name]

    def has(self, name: str) -> bool:
        """Whether this was asked for."""
        return name in self.asked

    @property
    def delays(self) -> str:
        """``"delays"`` if links have delays, which an answer may ignore, or ``"none"``."""
        graph = self.system.plant.neighbors
        return "delays" if graph is not None and graph.delays else "none"

    @property
    def signals(self) -> tuple[int, int]:
        """The numbers of inputs and of outputs of the plant, those of all channels together."""
        channels = self.system.plant.channels
        return sum(c.B.ncols for c in channels), sum(c.C.nrows for c in channels)

    @property
    def inactive(self) -> list[str]:
        """The channels with B_i = 0 or C_i = 0."""
        return [c.name for c in self.system.channels if c.B.is_zero() or c.C.is_zero()]

    def senders(self, subset: Sequence[str]) -> list[str]:
        """The names of N_s∖s: the agents outside a set from which agents of the set receive."""
        graph, inside = self.system.neighbors, set(subset)
        if graph is None:
            return []
        heard = self.system.named(graph.union(self.system.indices(subset)))
        return [name for name in heard if name not in inside]

    @property
    def sources(self) -> list[tuple[str, ...]]:
        """The strong components of the neighbor graph into which no link leads from others."""
        plant = self.system.plant
        return [plant.named(part) for part in plant.neighbors.source_components()]

    def receiving(self, subset: Sequence[str]) -> list[str]:
        """The names of a set of agents and of all others from which a path leads into the set."""
        graph = self.system.plant.neighbors.closure()
        return list(self.system.named(graph.union(self.system.indices(subset))))


class Claim:
    """A part of a certificate as rules read it, by attribute, item or iteration.

    An object or a list of objects is again such a part; any other value is returned, and recorded
    with its place.  A rule with a sentence about each member of a list, or about the first that has
    a property, takes the members by `separately`.
    """

    def __init__(self, value: Any, file: str, pointer: str, read: Read) -> None:
        self._value, self._file, self._pointer, self._read = value, file, pointer, read

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_") or key not in self._value:
            raise AttributeError(f"{self._file} does not say {key!r} at {self._pointer or '/'}")
        return self._part(key)

    def __getitem__(self, key: int) -> Any:
        return self._part(key)

    def __iter__(self) -> Iterator[Any]:
        return (self._part(k) for k in range(len(self._value)))

    def has(self, key: str) -> bool:
        """Whether the part has a key."""
        return key in self._value

    def separately(self, by: str = "") -> Iterator[Any]:
        """Yield the members such that a sentence about one has no other as its premise.

        When the next member is taken, the values read of the one before are dropped from the
        record; at the end of the list all are premises.

        Parameters
        ----------
        by : str
            The key of a value, which is no premise, in whose order the members are.
        """
        places: Iterable[int] = range(len(self._value))
        if by:
            places = sorted(places, key=lambda k: _keys(self._value[k])[by])
        return _separately(self._read, [self._part(k) for k in places])

    def _part(self, key: str | int) -> Any:
        value, pointer = self._value[key], f"{self._pointer}/{key}"
        if isinstance(value, Sequence) and value and _is_object(value[0]):
            return Claim(value, self._file, pointer, self._read)
        if _is_object(value):
            return Claim(_keys(value), self._file, pointer, self._read)
        self._read[self._file, pointer] = value
        return _Nothing() if value == () else value


class _Nothing(tuple[Any, ...]):
    """A list without members."""

    def separately(self, by: str = "") -> Iterator[Any]:
        return iter(())


def _is_object(value: Any) -> bool:
    return isinstance(value, Mapping) or hasattr(value, "document")


def _keys(value: Any) -> Mapping[str, Any]:
    document: Mapping[str, Any] = value if isinstance(value, Mapping) else value.document()
    return document


def _separately(read: Read, parts: Iterable[Any]) -> Iterator[Any]:
    """Yield the parts; the values read of a part are dropped at the next one."""
    before, seen = dict(read), dict(read)
    for part in parts:
        read.clear()
        read.update(before)
        yield part
        seen |= read
    read.update(seen)


class Certified(Claim):
    """The claims of an answer, by name, with the other data that a rule may read."""

    def __init__(self, answer: Answer, file: str, read: Read) -> None:
        self._answer = answer
        super().__init__(answer.claim(), file, "/claim", read)

    @property
    def subject(self) -> Sequence[Mapping[str, Any]]:
        """The constructions that lead from the plant to the system of the answer."""
        self._read[self._file, "/subject"] = self._answer.subject
        return tuple(self._answer.subject)

    def made_by(self, k: int) -> Claim:
        """The construction at a place of the subject."""
        return Claim(self._answer.subject[k], self._file, f"/subject/{k}", self._read)

    def made_by_name(self, construction: str, start: int = 0) -> Iterator[Claim]:
        """Yield the constructions of this name in the subject, from a place on."""
        for k, each in enumerate(self._answer.subject):
            if k >= start and each["construction"] == construction:
                yield self.made_by(k)

    @property
    def proof(self) -> Claim:
        """The part of the witness that the checker verifies independently, such as cuts."""
        return Claim(self._answer.witness(), self._file, "/witness", self._read)


@dataclass(frozen=True)
class Rule:
    """A rule by which sentences follow from answers.

    Attributes
    ----------
    place : str
        The place of its sentences, such as ``"answer"`` or ``"table"``.
    templates : tuple of Template
        The templates that it may use.
    says : callable
        A function that yields sentences; it takes the claims of the premises, and the `Context`.
    premises : tuple of str
        The questions whose answers it reads, in the order of its arguments.
    missing : str
        For a rule about an undecided question, the name of the question.
    """

    place: str
    templates: tuple[Template, ...]
    says: Callable[..., Iterator[Sentence]]
    premises: tuple[str, ...]
    missing: str

    def apply(
        self, answers: Mapping[str, Answer], context: Context, missing: Collection[str]
    ) -> Iterator[Sentence]:
        """Return the sentences that follow, each with its premises."""
        if self.missing and self.missing not in missing:
            return
        read: Read = {}
        claims = [_claims(question, answers, read) for question in self.premises]
        if any(claim is None for claim in claims):
            return
        for sentence in self.says(*claims, context):
            because = tuple((*at, plain(value)) for at, value in read.items())
            yield sentence.bound(self.place, because)


def _claims(name: str, answers: Mapping[str, Answer], read: Read) -> Any:
    """Return the answer of a name for rules, or the numbered ones; None if there is none."""
    for each in _ALIASES.get(name, (name,)):
        if each in answers:
            return Certified(answers[each], f"{each}.json", read)
    several: list[Certified] = []
    while (each := f"{name}_{len(several) + 1}") in answers:
        several.append(Certified(answers[each], f"{each}.json", read))
    return Several(several, read) if several else None


class Several(tuple[Certified, ...]):
    """Several answers to one question, numbered."""

    _read: Read

    def __new__(cls, answers: Iterable[Certified], read: Read) -> Several:
        several = super().__new__(cls, answers)
        several._read = read
        return several

    def separately(self) -> Iterator[Certified]:
        """Yield the answers such that a sentence about one has no other as its premise."""
        return _separately(self._read, self)

    def grouped(self, by: str | Callable[[Answer], Any]) -> Iterator[tuple[Certified, ...]]:
        """Yield the answers in groups, as `separately` yields single ones.

        Parameters
        ----------
        by : str or callable
            The claim that is the same in all answers of a group, or a function of the answer; it is
            no premise by that.
        """
        groups: dict[Any, list[Certified]] = {}
        for each in self:
            key = getattr(each._answer, by) if isinstance(by, str) else by(each._answer)
            groups.setdefault(key, []).append(each)
        return _separately(self._read, [tuple(group) for group in groups.values()])


class Rulebook(list[Rule]):
    """Rules, in the order of their sentences."""

    def rule(
        self,
        place: str,
        *templates: Template,
        premises: tuple[str, ...] = (),
        missing: str = "",
    ) -> Callable[[F], F]:
        """Make a rule of a function that yields sentences."""

        def enter(says: F) -> F:
            self.append(Rule(place, templates, says, premises, missing))
            return says

        return enter

    def sentences(
        self, answers: Mapping[str, Answer], context: Context, missing: Collection[str] = ()
    ) -> Sentences:
        """Return all sentences that follow from answers, keyed by questions."""
        return Sentences(
            sentence for rule in self for sentence in rule.apply(answers, context, missing)
        )


class Sentences(tuple[Sentence, ...]):
    """Sentences, each with its place; `print` writes one a line."""

    def __repr__(self) -> str:
        return f"Sentences({len(self)} sentences; print them, or ask for .at(place))"

    def __str__(self) -> str:
        return "\n".join(each.line for each in self)

    def _repr_html_(self) -> str:
        items = "".join(f"<li>{escape(each.line)}</li>" for each in self)
        return framed(f'<ul class="said">{items}</ul>')

    def at(self, *places: str) -> list[Sentence]:
        """Return the sentences of a place."""
        return [sentence for sentence in self if sentence.place in places]


def manifest(
    sentences: Iterable[Sentence],
    certificates: Mapping[str, str],
    subject: Sequence[Mapping[str, Any]] = (),
    nearby: Sequence[str] = (),
) -> dict[str, Any]:
    """Make the manifest, from which the checker verifies the sentences.

    Parameters
    ----------
    sentences : iterable of Sentence
    certificates : mapping from names of files to texts
    subject : sequence of mapping
        The constructions that lead from the plant to the system of the sentences.
    nearby : sequence of str
        The names of the files that are about another plant.
    """
    digests = {name: sha256(text) for name, text in certificates.items()}
    return {
        "format": FORMAT,
        **({"subject": plain(subject)} if subject else {}),
        **({"nearby": [*nearby]} if nearby else {}),
        "certificates": digests,
        "sentences": [
            {
                "text": sentence.line,
                "rule": sentence.template.key,
                "theorem": sentence.template.theorem,
                "because": [list(premise) for premise in sentence.because],
            }
            for sentence in sentences
        ],
    }
