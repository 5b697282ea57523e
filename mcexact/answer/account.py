"""Answers about a system with their sentences, rows and certificates.

An `Account` holds answers by name, the sentences that follow from them by rules, and the
certificates and the manifest from which the checker verifies these sentences.  If the plant has
radii, the answers about every plant within them come first (`leading`).

`account_for_all_values` makes the account of answers about a plant with parameters.  Such an answer
has rows: values of the parameters, and what holds there.  With one parameter every sentence follows
from certificates.  With several, certificates are about lines, and the account also has sentences
that are computed and not certified.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any

from mcexact.answer import protocol
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import MANIFEST, PLANT, Context, Sentences, manifest
from mcexact.answer.templates import count
from mcexact.exact.matrix import reading_in_words
from mcexact.model.box import radii_in_words
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, plain, write_text
from mcexact.shown import Shown, grid

if TYPE_CHECKING:
    from mcexact.answer.several_parameters import Line

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
"""The sentences where a plant within the radii is known that lacks what was asked."""


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
        The last one says that what follows is about the nominal values; empty if there is no answer
        about all plants.
    """
    known = [name for name in QUESTIONS if name in answers]
    if "box_fixed_modes" in known and "box_stabilizability" in known:
        # A plant without fixed modes is stabilizable.
        known.remove("box_stabilizability")
    sentences = [answers[name].explain() for name in known]
    sentences += [f"within the radii: {FAILS[name]}" for name in FAILS if name in failing]
    if left := _left(answers, {*open_} - {*failing}):
        sentences.append(f"within the radii: open, as no proof was found: {', '.join(left)}")
    if not sentences:
        return ()
    return (f"radii: {radii_in_words(system)}", *sentences, "At the nominal values:")


def _left(answers: Mapping[str, Any], open_: Collection[str]) -> list[str]:
    """The questions about every plant within the radii that are reported as open."""
    names = {*open_} - answers.keys()
    if "box_fixed_modes" in answers:
        names.discard("box_stabilizability")
    if "setpoint" in answers and not answers["setpoint"].solvable:
        # The nominal plant fails, of which its own sentence tells.
        names.discard("box_setpoints")
    return [name.removeprefix("box_").replace("_", " ") for name in QUESTIONS if name in names]


# Answers for all values of parameters: what their rows are about.

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
SHORT = 4096
"""The bytes up to which every certificate contains its plant, so that it can be read alone."""
_OPEN = (
    "That no mode is fixed for almost all values is proved by a point at which none is. All else "
    "about almost all values, and the conditions, is proved along drawn lines; between them it is "
    "computed and not certified. Where several conditions meet is not decided."
)
Row = tuple[str, str, str]

# Accounts.

FORMAT = "mcexact-analysis/1"
PARAMETRIC_FORMAT = "mcexact-parametric-analysis/1"
_ANSWER = ("answer", "answer.mode")


@dataclass(frozen=True, repr=False)
class Account(Shown):
    """Answers about one plant by name, with the sentences that follow from them.

    Attributes
    ----------
    answers : mapping
        The answers by name; the name with ``.json`` is that of the certificate's file.  With
        parameters an answer may be a tuple, or be proved by certificates along lines: `parts`.
    given : Context
    derived : Sentences
        The sentences that follow by the rules, each with its place and premises.
    subject : sequence of mapping
        The constructions that lead from the user's plant to the plant of this account.
    open : collection of str
        The questions that were asked and have no answer.
    failing : mapping
        For some of these the exact answer about a plant within the radii that lacks what was asked.
    nearby : collection of str
        The names that answers about another plant nearby have.
    computed : Sentences
        Sentences that no certificate implies alone: only with several parameters.
    for_all_values : bool
        Whether the answers are for all values of parameters, and have rows.
    """

    answers: Mapping[str, Any]
    given: Context
    derived: Sentences
    subject: Sequence[Mapping[str, Any]] = ()
    open: Collection[str] = ()
    failing: Mapping[str, Any] = field(default_factory=dict)
    nearby: Collection[str] = ()
    computed: Sentences = field(default_factory=Sentences)
    for_all_values: bool = False

    def __repr__(self) -> str:
        head = "ParametricAccount" if self.for_all_values else "Account"
        return f"{head}({len(self.answers)} answers, {len(self.sentences)} sentences)"

    @property
    def several(self) -> bool:
        """Whether the answers are for all values of several parameters: proofs are about lines."""
        return self.for_all_values and len(self.given.system.parameters) > 1

    # Sentences.

    @cached_property
    def sentences(self) -> Sentences:
        """All sentences, those that no certificate implies last."""
        return Sentences((*self.derived, *self.computed))

    def at(self, *places: str) -> list[str]:
        """The sentences of a place, with what is left open behind the answer."""
        note = [_OPEN] if self.several and "answer" in places else []
        return [*self.sentences.at(*places), *note]

    @cached_property
    def leading(self) -> tuple[str, ...]:
        """The sentences about every plant within the radii; empty without radii."""
        system = self.given.system
        if not isinstance(system, MultiChannelSystem):
            return ()
        return leading(system.plant, self.answers, self.open, self.failing)

    def explain(self) -> str:
        """Say in plain words what the answers are, one sentence a line."""
        title = [] if self.for_all_values else self.at("title")
        rows = [each.line for each in self.sentences.at("table")]
        reading = [f"floats: {self.reading}"] if self.reading else []
        return "\n".join([*self.leading, *title, *self.at(*_ANSWER), *rows, *reading])

    # Certificates.

    @cached_property
    def parts(self) -> dict[str, Answer]:
        """The certificates by name: of several for one question, or along lines, numbered."""
        return by_certificate(self.answers)

    @cached_property
    def certificates(self) -> dict[str, str]:
        """The text of every certificate, keyed by the name of its file."""
        return {f"{name}.json": protocol.encode(part) for name, part in self.parts.items()}

    def manifest(self) -> dict[str, Any]:
        """Return the sentences with their premises, and the digests of the certificates."""
        return self._manifest(self.certificates)

    def _manifest(self, texts: Mapping[str, str]) -> dict[str, Any]:
        near = [f"{name}.json" for name in sorted(self.nearby) if name in self.answers]
        return manifest(self.derived, texts, self.subject, near)

    def files(self, *, system_by_digest: bool = False) -> dict[str, str]:
        """Return the certificates and the manifest, keyed by the names of their files.

        Without certificates for all values there is no file.  A long plant that several
        certificates are about has a file of its own, and they name it by its digest.

        Parameters
        ----------
        system_by_digest : bool
            Whether that file is left out, and short plants are named by their digests, too; then
            the checker needs the system file.  A box around the plant, of which there is no system
            file, is not left out.
        """
        if self.for_all_values and not self.parts:
            return {}
        own = self.given.system.digest() if system_by_digest else ""
        beside = self._plants_beside(own)
        texts = {
            f"{name}.json": protocol.encode(
                part, system_by_digest=part.about.plant.digest() in {own, *beside}
            )
            for name, part in self.parts.items()
        }
        plants = {f"{digest}{PLANT}": text for digest, text in beside.items()}
        return texts | plants | {MANIFEST: canonical(self._manifest(texts)) + "\n"}

    def _plants_beside(self, own: str) -> dict[str, str]:
        """The plants that have files of their own, by their digests, without one of them."""
        plants = {name: part.about.plant for name, part in self.parts.items()}
        uses = Counter(plant.digest() for plant in plants.values())
        texts = {plant.digest(): plant.canonical_text() for plant in plants.values()}
        return {
            digest: text
            for digest, text in texts.items()
            if digest != own and uses[digest] > 1 and len(text) > SHORT
        }

    def save(self, folder: str | os.PathLike[str], *, system_by_digest: bool = False) -> None:
        """Write the certificates and the manifest into a folder, which is made if it is missing.

        Parameters
        ----------
        folder : path
        system_by_digest : bool
            Whether the file of the plant is left out, as in `files`.

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

    # Plain data.

    def as_json(self, **more: Any) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by its name."""
        system, everywhere = self.given.system, self.for_all_values
        table = [[*each.cells] for each in self.sentences.at("table")]
        return {
            "format": PARAMETRIC_FORMAT if everywhere else FORMAT,
            "system": {
                "name": system.name,
                "n": system.n,
                "m": system.m,
                "time": system.time,
                "channels": list(system.names),
                **({} if system.rounding is None else {"rounding": system.rounding}),
            },
            **({"parameters": system.document()["parameters"]} if everywhere else {}),
            **more,
            "answer": [str(each) for each in self.at(*_ANSWER)],
            **({"table": table} if everywhere else {}),
            "sentences": [
                {"text": each.line, "rule": each.template.key, "theorem": each.template.theorem}
                for each in self.derived
            ],
            **{name: self._view(name) for name in self.answers},
        }

    def _view(self, name: str) -> dict[str, Any]:
        """An answer as plain data, with the names of its certificates."""
        answer = self.answers[name]
        if not self.for_all_values:
            view: dict[str, Any] = answer.to_dict()
            first = plain(answer.about.subject[:1])
            if [step["construction"] for step in first] == ["failed"]:
                lost = {k: v for k, v in first[0].items() if v and k != "construction"}
                view = {"failed": lost} | view
            return view | {"certificate": f"{name}.json"}
        own = re.compile(rf"{name}(_\d+)?")
        view = {} if isinstance(answer, tuple) else answer.to_dict()
        view |= {
            "rows": [dict(zip(COLUMNS, row, strict=True)) for row in self.rows(name)],
            "certificates": [f"{each}.json" for each in self.parts if own.fullmatch(each)],
        }
        along = [{"certificate": file, "line": line} for file, line in self.along(name)]
        return view | ({"along": along} if along else {})

    # Rows: the values of the parameters, and what holds there.

    def rows(self, name: str) -> tuple[Row, ...]:
        """The rows of an answer for all values: the values, what holds there, and why."""
        # start-up: few plants have parameters
        from mcexact.answer.parameters import WITHIN_RANGES, joined

        answer = self.answers[name]
        if name in WITHIN_RANGES:
            return ((", ".join(self.given.system.parameters_in_words), WITHIN_RANGES[name], ""),)
        if isinstance(answer, tuple):
            return joined((count(k, "block"), each) for k, each in enumerate(answer, 1))
        rows: tuple[Row, ...] = answer.rows
        return rows

    def along(self, name: str) -> tuple[tuple[str, str], ...]:
        """With several parameters the certificates of a question, and the line of each."""
        lines = _lines(self.answers[name]) if self.several and name != "completeness" else []
        return tuple((f"{name}_{k}.json", str(line)) for k, line in enumerate(lines, 1))

    def proofs(self, names: Collection[str]) -> tuple[tuple[str, ...], ...]:
        """The rows of the sentences that repeat what certificates say of their lines."""
        # start-up: few plants have parameters
        from mcexact.answer.parameters import ON_LINE

        keys = {ON_LINE[name].key for name in names if name in ON_LINE}
        return tuple(each.cells for each in self.sentences.at("line") if each.template.key in keys)

    def table(self, name: str) -> tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]:
        """`rows` with the heads of their columns, without the column of reasons if it is empty."""
        rows = self.rows(name)
        used = len(COLUMNS) - (not any(why for *_, why in rows))
        return COLUMNS[:used], tuple(row[:used] for row in rows)

    def detailed(self, names: Collection[str] = MODES) -> list[str]:
        """The questions for all values of which a table says more than a sentence."""
        if not self.for_all_values:
            return []
        return [
            name
            for name, answer in self.answers.items()
            if name in names and self.rows(name) and not _says_all(name, answer)
        ]

    # Notebooks.

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the sentences of the answer, and the labels and texts of the table."""
        yield from (("", each) for each in self.leading)
        yield from (("", str(each)) for each in self.at(*_ANSWER))
        yield from ((each.cells[0], str(each)) for each in self.sentences.at("table"))
        if self.reading:
            yield "floats", self.reading

    @cached_property
    def reading(self) -> str:
        """How the floats of the plant were read; empty if it was made of exact numbers."""
        rounding = self.given.system.rounding
        return "" if rounding is None else reading_in_words(rounding)

    def _html(self) -> str:
        """Return the sentences and the tables in HTML."""
        return self._html_of_rows() if self.for_all_values else self._html_with_reasons()

    def _html_with_reasons(self) -> str:
        """The sentences and their table, each entry with its reason."""
        items = "".join(f"<li>{escape(each)}</li>" for each in self.leading)
        items += "".join(
            f'<li title="{escape(_reason(each))}">{escape(each)}</li>'
            for each in self.sentences.at(*_ANSWER)
        )
        rows = "".join(
            f'<tr title="{escape(_reason(each))}"><th>{escape(each.cells[0])}</th>'
            f"<td>{escape(each)}</td></tr>"
            for each in self.sentences.at("table")
        )
        if self.reading:
            rows += f"<tr><th>floats</th><td>{escape(self.reading)}</td></tr>"
        title = "".join(self.sentences.at("title"))
        over = f"<caption>{escape(title)}</caption>" if title else ""
        return (f'<ul class="said">{items}</ul>' if items else "") + f"<table>{over}{rows}</table>"

    def _html_of_rows(self) -> str:
        """The sentences, their table, and tables of the answers of which these say more."""
        items = "".join(f"<li>{escape(each)}</li>" for each in self.at("answer"))
        listed = [(each.cells[0], str(each)) for each in self.sentences.at("table")]
        grids = [grid(("", ""), listed, "".join(self.sentences.at("title")))]
        grids += [grid(*self.table(name), LABELS[name]) for name in self.detailed()]
        if proofs := self.proofs(MODES):
            grids.append(grid(PROOFS, proofs, PROVED))
        return f'<ul class="said">{items}</ul>' + "".join(grids)


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


# Accounts of answers for all values of parameters.


def account_for_all_values(plant: ParametricSystem, answers: Mapping[str, Any]) -> Account:
    """Return the answers about a plant with parameters, with the sentences that follow from them.

    Parameters
    ----------
    plant : ParametricSystem
    answers : mapping
        The answers by the names of their questions.
    """
    # start-up: few plants have parameters
    from mcexact.answer.parameters import RULES
    from mcexact.answer.several_parameters import RULES as SEVERAL
    from mcexact.answer.several_parameters import sentences_of_several

    several = len(plant.parameters) > 1
    given = Context(plant, repeated_of(plant, answers))
    derived = (SEVERAL if several else RULES).sentences(by_certificate(answers), given)
    computed = Sentences(sentences_of_several(answers, given) if several else ())
    return Account(answers, given, derived, computed=computed, for_all_values=True)


def repeated_of(plant: ParametricSystem, answers: Mapping[str, Any]) -> dict[str, Any]:
    """What the sentences repeat of the plant, besides its sizes."""
    # start-up: few plants have parameters
    from mcexact.answer.parameters import apart_from_poles

    several = len(plant.parameters) > 1
    constant = all(entry.denominator.is_constant() for row in plant.A.rows for entry in row)
    return {
        "parameter": ", ".join(plant.parameters),
        "parameters": ", ".join(plant.parameters_in_words),
        "outputs": sum(q for _, q in plant.sizes),
        "scale": None if several else plant.A.reduced[1],
        "undefined": _undefined(plant, answers),
        "divided": "" if constant else ", divided by the denominator of A",
        "apart": "" if several else apart_from_poles(plant),
    }


def _undefined(plant: ParametricSystem, answers: Mapping[str, Any]) -> list[str]:
    """The values within the ranges at which an entry is undefined, as conditions."""
    # start-up: few plants have parameters
    from mcexact.answer.parameters import undefined_where
    from mcexact.answer.several_parameters import Hypersurface, Hypersurfaces

    if len(plant.parameters) == 1:
        return undefined_where(plant)
    spectra = (each for each in answers.values() if isinstance(each, Hypersurfaces))
    surfaces = [Hypersurface(q) for each in spectra for q in each.undefined_at]
    return [*dict.fromkeys(str(h) for h in surfaces if h.meets(plant))]


def by_certificate(answers: Mapping[str, Any]) -> dict[str, Answer]:
    """Return the certificates of answers by name: of several for one question, numbered."""
    parts: dict[str, Answer] = {}
    for name, answer in answers.items():
        if isinstance(answer, Answer):
            parts[name] = answer
        elif name != "completeness":  # for all values it follows from other answers
            parts |= {f"{name}_{k}": each for k, each in enumerate(_proofs(answer), 1)}
    return parts


def _says_all(name: str, answer: Any) -> bool:
    """Whether a sentence says all of an answer about modes: none is lost for any value."""
    return name in MODES and not (answer.generic or answer.exceptional)


def _lines(answer: Any) -> list[Line[Any]]:
    """The lines of the certificates of an answer about several parameters, in their order."""
    # start-up: few plants have parameters
    from mcexact.answer.several_parameters import Hypersurfaces

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
    proofs = answer.certificates
    return [*proofs.values()] if isinstance(proofs, Mapping) else [*proofs]
