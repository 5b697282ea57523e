"""What the work of a command returns to the process that shows it.

A child process decides and formats (`mcexact.cli.decisions`, `mcexact.cli.loops`,
`mcexact.cli.designs`).  Its result is one of these types: the certificates with what the checker
needs to verify them (`Evidence`), the document that ``--json`` prints, and what the command prints
and writes otherwise.  Reading a result back loads the module of its type, so that this module loads
no library that starts threads: the process that reads forks once more, for the checker.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.questions import asked_by
from mcexact.answer import protocol
from mcexact.answer.account import Account
from mcexact.answer.evidence import RootDisc
from mcexact.answer.loops import StabilityVerdict
from mcexact.answer.protocol import Answer
from mcexact.model.properties import Property
from mcexact.report.html import AnswerPage
from mcexact.report.text import Table, tables

PART_OF_SEARCH = 4
"""The search for plants nearby has this part of the time that a command leaves to one system."""
DESIGNED = "the design"
"""The name of a design that a child process hands over, again whenever more is proved of it."""


@dataclass(frozen=True)
class Evidence:
    """Certificates of answers, and the plants that they are about.

    Attributes
    ----------
    certificates : mapping from names of files to texts
        The certificates, as a page has them.
    files : mapping from names of files to texts
        The same as they are verified and written, perhaps with the plant named by its digest, and
        the manifest of the sentences if there are any.
    plants : str or mapping from names of files to str
        The plant that all certificates must be about, as the text of its canonical JSON; or that of
        each certificate.
    """

    certificates: Mapping[str, str]
    files: Mapping[str, str]
    plants: str | Mapping[str, str]

    @classmethod
    def of(cls, account: Account, system_by_digest: bool) -> Evidence:
        """Return the evidence of an account, with the plants nearby that refute what was asked.

        Parameters
        ----------
        account : Account
        system_by_digest : bool
            Whether the files name the plant by its digest.
        """
        files = account.files(system_by_digest=system_by_digest)
        refuted = {f"{name}_refuted.json": answer for name, answer in account.failing.items()}
        texts = _certificates(refuted)
        plants = dict.fromkeys(files, account.given.system.canonical_text())
        return cls(account.certificates | texts, files | texts, plants | _plants(refuted))

    @classmethod
    def about_own_plants(cls, answers: Mapping[str, Answer]) -> Evidence:
        """Return the certificates of answers by name, each about the plant that it states."""
        texts = _certificates(answers)
        return cls(texts, texts, _plants(answers))

    def with_others(self, other: Evidence) -> Evidence:
        """Return this evidence with other certificates, about plants of their own."""

        def named(each: Evidence) -> dict[str, str]:
            plants = each.plants
            return dict.fromkeys(each.files, plants) if isinstance(plants, str) else dict(plants)

        certificates = {**self.certificates, **other.certificates}
        files = {**self.files, **other.files}
        return Evidence(certificates, files, named(self) | named(other))


def _certificates(answers: Mapping[str, Answer]) -> dict[str, str]:
    """Return the texts of certificates."""
    return {name: protocol.encode(answer) for name, answer in answers.items()}


def _plants(answers: Mapping[str, Answer]) -> dict[str, str]:
    """Return the plants that answers are about, as the texts of their canonical JSON."""
    return {name: answer.about.plant.canonical_text() for name, answer in answers.items()}


@dataclass(frozen=True)
class Result:
    """An answer: its evidence, and the document that ``--json`` prints.

    Attributes
    ----------
    evidence : Evidence
    document : mapping
    """

    evidence: Evidence
    document: Mapping[str, Any]


@dataclass(frozen=True)
class Shown(Result):
    """An answer that is shown as tables, and as a page if one is asked for.

    Attributes
    ----------
    tables : sequence of Table
    page : AnswerPage or None
    """

    tables: Sequence[Table]
    page: AnswerPage | None


@dataclass(frozen=True)
class Asked:
    """What `mcexact analyze` is asked about a plant.

    Attributes
    ----------
    options : sequence of str
        The options of the command that add questions.
    named : sequence of str
        Further questions, by name.
    information : str
        The outputs that agents feed back: "own" or "outputs".
    subset : sequence of str or None
        The channels whose pencil is asked about.
    channel : str or None
        The channel that is asked about.
    radii : Fraction or None
        The radii of the entries, as a part of their moduli.
    effort : float or None
        The seconds for the search of the largest radii; None without it.
    wanted : str
        The property that the search is about, in words.
    at : mapping
        Values of parameters.
    nearby : bool
        Whether plants nearby are looked for.
    seconds : float or None
        What is left of the time limit at the beginning; None without a limit.
    pattern : bool
        Whether only that is asked which does not depend on the numbers of the plant.
    part : str, or tuple of str and bytes, or None
        The part of the state that is left out, or a file with a subspace.
    """

    options: Sequence[str]
    named: Sequence[str]
    information: str
    subset: Sequence[str] | None
    channel: str | None
    radii: Fraction | None
    effort: float | None
    wanted: Property
    at: Mapping[str, Fraction]
    nearby: bool = True
    seconds: float | None = None
    pattern: bool = False
    part: str | tuple[str, bytes] | None = None

    @property
    def questions(self) -> list[str]:
        """The names of the questions that are added."""
        return [*asked_by(*self.options), *self.named]


@dataclass(frozen=True)
class Analyzed(Shown):
    """What `mcexact analyze` decided.

    Attributes
    ----------
    words : str
        The sentences before the tables.
    latex : str
        The results in LaTeX, if they are asked for.
    undecided : mapping from str to sequence of str
        The questions without an answer, by the reason.
    nearby : str
        The system file of the first plant nearby; empty if there is none.
    """

    words: str
    latex: str
    undecided: Mapping[str, Sequence[str]]
    nearby: str = ""


@dataclass(frozen=True)
class Allocated(Shown):
    """What agents must share.

    Attributes
    ----------
    feasible : bool
        Whether any dimensions or links suffice.
    within : bool
        Whether the cost is not proved to be the least, and only bounded from below.
    """

    feasible: bool
    within: bool


@dataclass(frozen=True)
class Loop(Shown):
    """A controller with the verdict on its loop.

    Attributes
    ----------
    verdict : sequence of str
        The lines before the tables, the first of which says whether to install the controller.
    controller : str
        The controller's file; empty if the command writes none.
    """

    verdict: Sequence[str]
    controller: str

    @classmethod
    def without_figures(
        cls,
        account: Account,
        document: Mapping[str, Any],
        lines: Sequence[str],
        system_by_digest: bool,
    ) -> Loop:
        """Return the verdict of a loop whose costs, margins and peaks are not computed.

        Parameters
        ----------
        account : Account
        document : mapping
            What the JSON says besides the sentences and the first line.
        lines : sequence of str
            The lines before the tables.
        system_by_digest : bool
            Whether the files name the plant by its digest.
        """
        return cls(
            Evidence.of(account, system_by_digest),
            account.as_json(**document, first_line=lines[0]),
            tables(account.sentences, note=account.reading),
            None,
            lines,
            "",
        )


def loop_document(
    verdict: StabilityVerdict,
    warnings: Sequence[str],
    largest: bool = False,
    digits: int | None = None,
    outside: RootDisc | None = None,
) -> dict[str, Any]:
    """Return what the JSON of a verdict says of the loop itself.

    Parameters
    ----------
    verdict : StabilityVerdict
    warnings : sequence of str
    largest : bool
        Whether the bound of the region is the largest that was found.
    digits : int, optional
        The digits to which the controller was rounded.
    outside : RootDisc, optional
        A disc around an eigenvalue outside the region.
    """
    bound = None if verdict.bound is None else str(verdict.bound)
    return {
        "certified": verdict.stable,
        "region": str(verdict.region),
        "bound": bound,
        "method": verdict.method,
        "states": verdict.about.n,
        "blocks": list(verdict.blocks),
        "largest": bound if largest else None,
        "warnings": list(warnings),
        "rounded_to_digits": digits,
        "eigenvalue_outside": None if outside is None else outside.to_dict(),
    }


@dataclass(frozen=True)
class Exported:
    """The files of a controller's code, and the verdict on the controller that the code is."""

    files: Mapping[str, str]
    loop: Loop | None


@dataclass(frozen=True)
class Refused(Result):
    """A proof that no controller of the kind that was asked for exists.

    Attributes
    ----------
    reason : str
    advice : str
        What to try instead, as the end of a sentence; may be empty.
    """

    reason: str
    advice: str


@dataclass(frozen=True)
class Simulated(Shown):
    """A simulation; ``file`` is the content of a .csv or .png file, if one is asked for."""

    warnings: Sequence[str]
    file: bytes


@dataclass(frozen=True)
class Compared:
    """Floating-point verdicts beside exact ones; ``page`` is empty if none is shown.

    Attributes
    ----------
    document : mapping
        What ``--json`` prints.
    tables : sequence of Table
    page : str
    """

    document: Mapping[str, Any]
    tables: Sequence[Table]
    page: str = ""


@dataclass(frozen=True)
class Converted:
    """A system in another file.

    Attributes
    ----------
    content : bytes or mapping from names of files to texts
        The file, or the files of a folder.
    warnings : sequence of str
        What rounding errors in the file that was read may have changed.
    """

    content: bytes | dict[str, str]
    warnings: Sequence[str]
