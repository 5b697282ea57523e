"""Answers about a system with their sentences, rows and certificates.

`Account` is for one plant without parameters, and for the certified part of an analysis with them.
It holds answers by name, the sentences that follow from them by rules, and the certificates and the
manifest from which the checker verifies these sentences.  If the plant has radii, the answers about
every plant within them are said first (`leading`).

`ParametricAccount` is for a plant with parameters.  With one parameter every sentence follows from
certificates.  With several, certificates are about lines, and the account also has sentences that
are computed and not certified; its property ``proved`` has the certified ones alone.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from typing import Any

from mcexact.answer import protocol
from mcexact.answer.parameters import (
    ON_LINE,
    RULES,
    WITHIN_RANGES,
    apart_from_poles,
    joined,
    undefined_where,
)
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import MANIFEST, Given, Sentences, manifest
from mcexact.answer.several_parameters import RULES as SEVERAL
from mcexact.answer.several_parameters import (
    Hypersurface,
    Hypersurfaces,
    Line,
    sentences_of_several,
)
from mcexact.answer.templates import count
from mcexact.model.box import radii_in_words
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, write_text
from mcexact.shown import Shown, grid

# A plant with radii: the sentences about every plant within them, which come first.

QUESTIONS = (
    "box_fixed_modes",
    "box_stabilizability",
    "box_controllability",
    "box_observability",
    "box_setpoints",
)


FAILS = {
    "box_fixed_modes": "some plant has a fixed mode",
    "box_stabilizability": "some plant is not stabilizable by any such controller",
    "box_controllability": "some plant is not controllable by all channels together",
    "box_observability": "some plant is not observable by all channels together",
}
"""What is said where a plant within the radii is known that lacks what was asked."""


def leading(
    system: MultiChannelSystem,
    answers: Mapping[str, Any],
    open_: Collection[str],
    failing: Collection[str] = (),
) -> tuple[str, ...]:
    """How large the radii are, and the sentences about every plant within them.

    Parameters
    ----------
    system : MultiChannelSystem
    answers : mapping
        The answers about it by name.
    open_ : collection of str
        The questions that were asked and have no answer.
    failing : collection of str
        Those of them for which a plant within the radii is known that lacks what was asked.

    Returns
    -------
    tuple of str
        The last one says that what follows is about the nominal values; empty if nothing is said
        of all plants.
    """
    known = [name for name in QUESTIONS if name in answers]
    if "box_fixed_modes" in known and "box_stabilizability" in known:
        # A plant without fixed modes is stabilizable.
        known.remove("box_stabilizability")
    said = [answers[name].explain() for name in known]
    said += [f"within the radii: {FAILS[name]}" for name in FAILS if name in failing]
    if left := _left(answers, {*open_} - {*failing}):
        said.append(f"within the radii: open, as no proof was found: {', '.join(left)}")
    return (f"radii: {radii_in_words(system)}", *said, "At the nominal values:") if said else ()


def _left(answers: Mapping[str, Any], open_: Collection[str]) -> list[str]:
    """The questions about every plant within the radii that are reported as open."""
    told = {*open_} - answers.keys()
    if "box_fixed_modes" in answers:
        told.discard("box_stabilizability")
    if "setpoint" in answers and not answers["setpoint"].solvable:
        # The nominal plant fails, of which its own sentence tells.
        told.discard("box_setpoints")
    return [name.removeprefix("box_").replace("_", " ") for name in QUESTIONS if name in told]


# Accounts of plants without parameters.

FORMAT = "mcexact-analysis/1"
_ANSWER = ("answer", "answer.mode")
_PLAIN = ("title", *_ANSWER, "table")


@dataclass(frozen=True, repr=False)
class Account(Shown):
    """Answers about one plant by name, with the sentences that follow from them.

    Attributes
    ----------
    answers : mapping
        The answers by name; the name with ``.json`` is that of the certificate's file.
    given : Given
    sentences : Sentences
        The sentences that follow by the rules, each with its place and premises.
    subject : sequence of mapping
        The constructions that lead from the user's plant to the plant of this account.
    open : collection of str
        The questions that were asked and have no answer.
    failing : mapping
        For some of these the exact answer about a plant within the radii that lacks what was asked.
    nearby : collection of str
        The names that answers about another plant nearby have.
    """

    answers: Mapping[str, Any]
    given: Given
    sentences: Sentences
    subject: Sequence[Mapping[str, Any]] = ()
    open: Collection[str] = ()
    failing: Mapping[str, Any] = field(default_factory=dict)
    nearby: Collection[str] = ()

    def __repr__(self) -> str:
        return f"Account({len(self.answers)} answers, {len(self.sentences)} sentences)"

    @cached_property
    def certificates(self) -> dict[str, str]:
        """The text of every certificate, keyed by the name of its file."""
        return {f"{name}.json": protocol.encode(answer) for name, answer in self.answers.items()}

    def manifest(self) -> dict[str, Any]:
        """Return the sentences with their premises, and the digests of the certificates."""
        return self._manifest(self.certificates)

    def _manifest(self, texts: Mapping[str, str]) -> dict[str, Any]:
        near = [f"{name}.json" for name in sorted(self.nearby) if name in self.answers]
        return manifest(self.sentences, texts, self.subject, near)

    def files(self, *, system_by_digest: bool = False) -> dict[str, str]:
        """Return the certificates and the manifest, keyed by the names of their files.

        Parameters
        ----------
        system_by_digest : bool
            Whether certificates name the plant by its digest alone, as in `codec.encode`; those
            about a box around it, of which there is no file, contain it.
        """
        texts = self.certificates
        if system_by_digest:
            own = self.given.system.digest()
            texts = {
                f"{name}.json": protocol.encode(
                    answer, system_by_digest=answer.about.plant.digest() == own
                )
                for name, answer in self.answers.items()
            }
        return texts | {MANIFEST: canonical(self._manifest(texts)) + "\n"}

    def save(self, folder: str | os.PathLike[str], *, system_by_digest: bool = False) -> None:
        """Write the certificates and the manifest into a folder, which is made if it is missing.

        Parameters
        ----------
        folder : path
        system_by_digest : bool
            Whether certificates name the plant by its digest alone, as in `save_certificate`.

        Raises
        ------
        NotWritten
            If a file cannot be written.
        OSError
            If the folder cannot be made.
        """
        os.makedirs(folder, exist_ok=True)
        for name, text in self.files(system_by_digest=system_by_digest).items():
            write_text(os.path.join(folder, name), text)

    def as_json(self, **more: Any) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by its name."""
        system = self.given.system
        return {
            "format": FORMAT,
            "system": {
                "name": system.name,
                "n": system.n,
                "m": system.m,
                "time": system.time,
                "channels": list(system.names),
            },
            **more,
            "answer": [str(each) for each in self.sentences.at("answer", "answer.mode")],
            "sentences": [
                {"text": each.line, "rule": each.template.key, "theorem": each.template.theorem}
                for each in self.sentences
            ],
            **{
                name: answer.to_dict() | {"certificate": f"{name}.json"}
                for name, answer in self.answers.items()
            },
        }

    @cached_property
    def leading(self) -> tuple[str, ...]:
        """The sentences about every plant within the radii; empty without radii."""
        system = self.given.system
        if not isinstance(system, MultiChannelSystem):
            return ()
        return leading(system.plant, self.answers, self.open, self.failing)

    def explain(self) -> str:
        """Say in plain words what was found, one sentence a line."""
        return "\n".join([*self.leading, *(each.line for each in self.sentences.at(*_PLAIN))])

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the sentences of the answer, and the labels and texts of the table."""
        yield from (("", each) for each in self.leading)
        yield from (("", str(each)) for each in self.sentences.at(*_ANSWER))
        yield from ((each.cells[0], str(each)) for each in self.sentences.at("table"))

    def _html(self) -> str:
        """Return the sentences and the table in HTML, each entry with its reason."""
        said = "".join(f"<li>{escape(each)}</li>" for each in self.leading)
        said += "".join(
            f'<li title="{escape(_reason(each))}">{escape(each)}</li>'
            for each in self.sentences.at(*_ANSWER)
        )
        rows = "".join(
            f'<tr title="{escape(_reason(each))}"><th>{escape(each.cells[0])}</th>'
            f"<td>{escape(each)}</td></tr>"
            for each in self.sentences.at("table")
        )
        title = "".join(self.sentences.at("title"))
        over = f"<caption>{escape(title)}</caption>" if title else ""
        return (f'<ul class="said">{said}</ul>' if said else "") + f"<table>{over}{rows}</table>"


def _reason(sentence: Any) -> str:
    """The theorem and the premises of a sentence, without their values."""
    places = [f"{file}#{pointer}" for file, pointer, _ in sentence.because]
    return "; ".join(filter(None, [sentence.template.theorem, *places]))


class ShownByAccount(Shown):
    """A result that is shown as its account is: its sentences, or without these its table."""

    @property
    def account(self) -> Account:
        """The answers, with the sentences that follow from them."""
        raise NotImplementedError

    def explain(self) -> str:
        """Say the sentences of the account in plain words, one a line."""
        return self.account.explain()

    def _labeled(self) -> Iterable[tuple[str, Any]]:
        return self.account._labeled()

    def _html(self) -> str:
        return self.account._html()


# Accounts of plants with parameters.

PARAMETRIC_FORMAT = "mcexact-parametric-analysis/1"
LABELS = {
    "fixed_spectrum": "fixed modes",
    "completeness": "complete",
    "joint_controllability": "modes that no channel controls",
    "joint_observability": "modes that no channel observes",
    "controllability_indices": "ranks of [B, AB, …] by the number of blocks",
    "observability_indices": "ranks of [C; CA; …] by the number of blocks",
    "transfer_graph": "edges of the transfer graph",
    "setpoint": "rank of the matrix of equilibria",
    "channel_controllability": "modes that the channel does not control",
    "channel_observability": "modes that the channel does not observe",
}
"""The questions, with what their answers are about."""
COLUMNS = ("where", "what", "because")
PROVED = "proved for every point of lines"
PROOFS = ("about", "line", "what holds on it")
MODES = frozenset(name for name in LABELS if name.endswith(("ability", "spectrum")))
"""The questions about modes, of which a table says more than a sentence."""
_OPEN = (
    "That no mode is fixed for almost all values is proved by a point at which none is. All else "
    "about almost all values, and the conditions, is proved along drawn lines; between them it is "
    "computed and not certified. Where several conditions meet is not decided."
)
_PLACES = ("title", "answer", "table")
Row = tuple[str, str, str]


@dataclass(frozen=True, repr=False)
class ParametricAccount(Shown):
    """Answers about one system with parameters, for almost all values and at exceptional ones.

    Attributes
    ----------
    plant : ParametricSystem
    answers : mapping
        The answers by the names of their questions.
    """

    plant: ParametricSystem
    answers: Mapping[str, Any]

    @property
    def several(self) -> bool:
        """Whether the plant has several parameters: then proofs are about lines."""
        return len(self.plant.parameters) > 1

    @cached_property
    def parts(self) -> dict[str, Answer]:
        """The certificates by name: of several for one question, or along lines, numbered."""
        found: dict[str, Answer] = {}
        for name, answer in self.answers.items():
            if isinstance(answer, Answer):
                found[name] = answer
            elif name != "completeness":  # it follows from other answers
                found |= {f"{name}_{k}": each for k, each in enumerate(_proofs(answer), 1)}
        return found

    @cached_property
    def proved(self) -> Account:
        """The sentences that follow from certificates by rules."""
        rules = SEVERAL if self.several else RULES
        return Account(self.parts, self._given, rules.sentences(self.parts, self._given))

    @property
    def _given(self) -> Given:
        plant = self.plant
        bottoms = [entry.denominator for row in plant.A.rows for entry in row]
        whole = all(bottom.is_constant() for bottom in bottoms)
        divided = "" if whole else ", divided by the denominator of A"
        asked = {
            "parameter": ", ".join(plant.parameters),
            "parameters": ", ".join(plant.parameters_in_words),
            "outputs": sum(q for _, q in plant.sizes),
            "scale": None if self.several else plant.A.reduced[1],
            "undefined": self._undefined,
            "divided": divided,
            "apart": "" if self.several else apart_from_poles(plant),
        }
        return Given(plant, asked)

    @property
    def _undefined(self) -> list[str]:
        """The values within the ranges at which an entry is undefined, as conditions."""
        if not self.several:
            return undefined_where(self.plant)
        spectra = (each for each in self.answers.values() if isinstance(each, Hypersurfaces))
        surfaces = [Hypersurface(q) for each in spectra for q in each.undefined_at]
        return [*dict.fromkeys(str(h) for h in surfaces if h.meets(self.plant))]

    @cached_property
    def sentences(self) -> Sentences:
        """The sentences; with several parameters also those that no certificate implies alone."""
        if self.several:
            told = sentences_of_several(self.answers, self._given)
            return Sentences((*self.proved.sentences, *told))
        return self.proved.sentences

    def at(self, *places: str) -> list[str]:
        """The sentences of a place, with what is left open behind the answer."""
        told: list[str] = [*self.sentences.at(*places)]
        return [*told, _OPEN] if self.several and "answer" in places else told

    @property
    def certificates(self) -> dict[str, str]:
        """The text of every certificate, keyed by the name of its file."""
        return {f"{name}.json": protocol.encode(each) for name, each in self.parts.items()}

    def manifest(self) -> dict[str, Any]:
        """Return the sentences with their premises, and the digests of the certificates."""
        return self.proved.manifest()

    def files(self, *, system_by_digest: bool = False) -> dict[str, str]:
        """Return the certificates and the manifest, by the names of files; none without answers."""
        if not self.parts:
            return {}
        return self.proved.files(system_by_digest=system_by_digest)

    @property
    def about(self) -> str:
        """The plant of all certificates, as their object ``system``."""
        return self.plant.canonical_text()

    def rows(self, name: str) -> tuple[Row, ...]:
        """The rows of the answer to a question: the values, what holds there, and why."""
        answer = self.answers[name]
        if name in WITHIN_RANGES:
            return ((", ".join(self.plant.parameters_in_words), WITHIN_RANGES[name], ""),)
        if isinstance(answer, tuple):
            return joined((count(k, "block"), each) for k, each in enumerate(answer, 1))
        found: tuple[Row, ...] = answer.rows
        return found

    def along(self, name: str) -> tuple[tuple[str, str], ...]:
        """With several parameters the certificates of a question, and the line of each."""
        lines = _lines(self.answers[name]) if self.several and name != "completeness" else []
        return tuple((f"{name}_{k}.json", str(line)) for k, line in enumerate(lines, 1))

    def proofs(self, names: Collection[str]) -> tuple[tuple[str, ...], ...]:
        """The rows of the sentences that repeat what certificates say of their lines."""
        keys = {ON_LINE[name].key for name in names if name in ON_LINE}
        return tuple(each.cells for each in self.sentences.at("line") if each.template.key in keys)

    def table(self, name: str) -> tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]:
        """`rows` with the heads of their columns, without the column of reasons if it is empty."""
        rows = self.rows(name)
        used = len(COLUMNS) - (not any(why for *_, why in rows))
        return COLUMNS[:used], tuple(row[:used] for row in rows)

    def as_json(self, **more: Any) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by its name."""
        plant = self.plant
        return {
            "format": PARAMETRIC_FORMAT,
            "system": {
                "name": plant.name,
                "n": plant.n,
                "m": plant.m,
                "time": plant.time,
                "channels": list(plant.names),
            },
            "parameters": plant.document()["parameters"],
            **more,
            "answer": self.at("answer"),
            "table": [[*each.cells] for each in self.sentences.at("table")],
            "sentences": [
                {"text": each.line, "rule": each.template.key, "theorem": each.template.theorem}
                for each in self.proved.sentences
            ],
            **{name: self._view(name) for name in self.answers},
        }

    def _view(self, name: str) -> dict[str, Any]:
        """The answer to a question with the names of its certificates."""
        answer = self.answers[name]
        own = re.compile(rf"{name}(_\d+)?")
        files = [f"{each}.json" for each in self.parts if own.fullmatch(each)]
        rows = [dict(zip(COLUMNS, row, strict=True)) for row in self.rows(name)]
        view = {} if isinstance(answer, tuple) else answer.to_dict()
        found = view | {"rows": rows, "certificates": files}
        along = [{"certificate": file, "line": line} for file, line in self.along(name)]
        return found | ({"along": along} if along else {})

    def explain(self) -> str:
        """Say in plain words what was found, one sentence a line."""
        told = [each.line for each in self.sentences.at("table")]
        return "\n".join([*self.at("answer"), *told])

    def __repr__(self) -> str:
        return f"ParametricAccount({len(self.answers)} answers, {len(self.sentences)} sentences)"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield from (("", said) for said in self.at("answer"))
        yield from ((each.cells[0], str(each)) for each in self.sentences.at("table"))

    def _html(self) -> str:
        """Return the sentences and the tables in HTML."""
        said = "".join(f"<li>{escape(each)}</li>" for each in self.at("answer"))
        listed = [(each.cells[0], str(each)) for each in self.sentences.at("table")]
        made = [grid(("", ""), listed, "".join(self.sentences.at("title")))]
        made += [grid(*self.table(name), LABELS[name]) for name in self.detailed()]
        if proofs := self.proofs(MODES):
            made.append(grid(PROOFS, proofs, PROVED))
        return f'<ul class="said">{said}</ul>' + "".join(made)

    def detailed(self, names: Collection[str] = MODES) -> list[str]:
        """The questions of which a table says more than a sentence."""
        return [
            name
            for name, answer in self.answers.items()
            if name in names and self.rows(name) and not _says_all(name, answer)
        ]


def _says_all(name: str, answer: Any) -> bool:
    """Whether a sentence says all of an answer about modes: none is lost for any value."""
    return name in MODES and not (answer.generic or answer.exceptional)


def _lines(answer: Any) -> list[Line[Any]]:
    """The lines of the certificates of an answer about several parameters, in their order."""
    if isinstance(answer, Hypersurfaces):
        return [*answer.lines]
    parts = answer if isinstance(answer, tuple) else getattr(answer, "columns", {}).values()
    return [line for each in parts for line in _lines(each)]


def _proofs(answer: Any) -> list[Answer]:
    """The certificates of an answer that is none itself."""
    if isinstance(answer, tuple):
        return [proof for each in answer for proof in _proofs(each)]
    if isinstance(answer, Answer):
        return [answer]
    found = answer.certificates
    return [*found.values()] if isinstance(found, Mapping) else [*found]
