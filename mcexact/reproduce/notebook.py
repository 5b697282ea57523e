"""Statements, the ledger of examinations, and the record of one.

Three things are kept apart.  A `Statement` is one statement of the paper, with the verdict on it,
its machine-checked theorems and its correction (``statements.toml``, their only source).  An
`Examination` says how one or several statements are examined: with which code and certificates, and
which nearest false statements its instances have to refute (``ledger.toml``).  A `Notebook` is the
evidence of one examination that was carried out.

An examination holds if all its checks hold, all its certificates are VALID and every false
statement of the ledger is refuted.  Checks on instances prove no general statement; that is what
the machine-checked theorems are for, and `Examination.status` tells the two apart.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from itertools import chain, groupby
from typing import Any

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.answer import protocol
from mcexact.answer.check import checked
from mcexact.answer.protocol import Answer
from mcexact.model.system import MultiChannelSystem
from mcexact.report.html import EmbeddedPicture, Picture
from mcexact.reproduce.instances import Instance, in_common

# All statements of the paper, each with what is known of it.

STATUSES = {
    "printed": "proved as printed",
    "corrected": "proved as corrected",
    "added": "proved under added hypotheses",
    "answered": "answered",
    "defined": "defined",
    "shown": "shown by an instance",
    "instances": "seen on instances",
    "weaker": "weaker than printed",
    "refuted": "refuted by an instance",
    "informal": "informal",
    "absent": "absent",
}
"""What can be known of a statement: the word in ``statements.toml``, and what the report says."""

PROVED = ("printed", "corrected", "added", "answered")
"""The statuses that machine-checked theorems stand behind."""
EXPLAINED = ("corrected", "added", "answered", "weaker", "refuted", "informal", "absent")
"""The statuses that need a note: what was wrong, added or missing, or why."""
OPEN = ("instances", "weaker", "absent")
"""The statuses of what is not proved, and not settled otherwise."""


@dataclass(frozen=True)
class Statement:
    """One statement of the paper.

    Attributes
    ----------
    number : int
        Its place in the paper, from 1.
    section : str
    says : str
        The statement in our words.
    status : str
        A key of `STATUSES`.
    equation : str
        The number printed beside it, or an empty text.
    examined : tuple of str
        The keys of the examinations with its instances.
    proofs : tuple of str
        Machine-checked theorems, as file.theorem in ``proofs/``.
    note : str
        What was corrected, added or is missing, or why it is absent.
    closes : str
        What would prove it in general, if it is open.
    erratum : str
        What the list of corrections says of it, in Markdown, or an empty text.
    """

    number: int
    section: str
    says: str
    status: str
    equation: str = ""
    examined: tuple[str, ...] = ()
    proofs: tuple[str, ...] = ()
    note: str = ""
    closes: str = ""
    erratum: str = ""


@cache
def statements() -> tuple[Statement, ...]:
    """All statements, in the order of the paper.

    Examples
    --------
    >>> len(statements())
    134
    >>> statements()[88].equation
    'Theorem 2, (26)'
    """
    text = resources.files("mcexact.reproduce").joinpath("statements.toml").read_text("utf-8")
    return tuple(
        Statement(
            number,
            row["section"],
            row["says"],
            row["status"],
            row.get("equation", ""),
            tuple(row.get("examined", ())),
            tuple(row.get("proofs", ())),
            row.get("note", ""),
            row.get("closes", ""),
            row.get("erratum", "").strip(),
        )
        for number, row in enumerate(tomllib.loads(text)["statement"], 1)
    )


def counted(chosen: Iterable[Statement]) -> dict[str, int]:
    """How many statements have each status; every status is named.

    Examples
    --------
    >>> sum(counted(statements()).values())
    134
    """
    counts = Counter(each.status for each in chosen)
    return {status: counts[status] for status in STATUSES}


def statement_table() -> str:
    """The statements as ``proofs/STATEMENTS.md`` lists them."""
    lines = ["| status | statements |", "|---|---|"]
    lines += [f"| {STATUSES[key]} | {size} |" for key, size in counted(statements()).items()]
    lines += [
        f"| all | {len(statements())} |",
        "",
        "| | section | equation | statement | status | examined by | theorems | note |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for each in statements():
        keys = ", ".join(f"`{key}`" for key in each.examined)
        proofs = ", ".join(f"`{name}`" for name in each.proofs)
        number = f'<a id="{each.number}"></a>{each.number}'
        cells = (number, each.section, each.equation, each.says, STATUSES[each.status])
        lines.append(f"| {' | '.join((*cells, keys, proofs, each.note))} |")
    return "\n".join(lines) + "\n"


NUMBERED = ("Theorem", "Proposition", "Lemma", "Corollary", "Remark")
"""How the numbered results of the paper are called."""


def numbered() -> tuple[Statement, ...]:
    """The statements of numbered results and of the paper's open question, in its order.

    Examples
    --------
    >>> [each.equation for each in numbered()][-3:]
    ['Theorem 3', 'Corollary 2', 'Theorem 4']
    """
    return tuple(
        each
        for each in statements()
        if each.equation.startswith(NUMBERED) or each.status == "answered"
    )


def front_table() -> str:
    """The verdicts on the numbered results as ``proofs/README.md`` begins with them.

    A result has one row.  Its name is a link to its theorems in ``proofs/THEOREMS.md``, and the
    theorems named beside it, one for each of its statements, to their lines.
    """
    lines = ["| result | verdict | in Coq | what it says |", "|---|---|---|---|"]
    for name, group in groupby(numbered(), key=_result):
        said = list(group)
        verdicts = "; ".join(dict.fromkeys(STATUSES[each.status] for each in said))
        proofs = [each.proofs[0] for each in said if each.proofs]
        label = f"[{name}](THEOREMS.md#{anchor(proofs[0])})" if proofs else name
        theorems = ", ".join(f"`{proof}`" for proof in proofs) or "by definition"
        says = " ".join(part for each in said for part in (each.says, _in_short(each)) if part)
        lines.append(f"| {label} | {verdicts} | {theorems} | {says} |")
    sizes = [f"{size} {STATUSES[key]}" for key, size in counted(statements()).items() if size]
    lines += ["", f"Of all {len(statements())} statements: {'; '.join(sizes)}."]
    return "\n".join(lines) + "\n"


def _in_short(statement: Statement) -> str:
    """The first sentence of the note on a statement that is not proved as printed."""
    if statement.status not in EXPLAINED:
        return ""
    return re.split(r"(?<=\.)\s", statement.note)[0]


def _result(statement: Statement) -> str:
    """The name of a numbered result without the numbers of its equations."""
    return statement.equation.partition(",")[0] or f"Open question ({statement.section})"


def anchor(theorem: str) -> str:
    """The anchor of a theorem in ``proofs/THEOREMS.md``.

    Examples
    --------
    >>> anchor("paper.theorem_2")
    'paper-theorem_2'
    """
    return theorem.replace(".", "-")


def open_table() -> str:
    """The statements that are not proved as ``proofs/OPEN.md`` lists them."""
    lines = [
        "| | section | statement | what is known | machine-checked so far | what would close it |",
        "|---|---|---|---|---|---|",
    ]
    for each in statements():
        if each.status in OPEN:
            where = f"{each.section} {each.equation}".strip()
            known = f"{STATUSES[each.status]}. {each.note}".strip().removesuffix(".")
            proofs = ", ".join(f"`{name}`" for name in each.proofs) or "nothing"
            cells = (str(each.number), where, each.says, f"{known}.", proofs, each.closes)
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def errata() -> str:
    """The corrections as ``proofs/ERRATA.md`` lists them, section by section."""
    lines: list[str] = []
    for each in statements():
        if each.erratum:
            section = each.section.partition("-")[0]
            if (heading := f"## Section {section}, {TITLES[section]}") not in lines:
                lines += [heading, ""]
            examined = ", ".join(f"`{key}`" for key in each.examined)
            where = f"{each.section}, statement {each.number}: {STATUSES[each.status]}"
            lines += [f"{each.erratum} *({where}; examined by {examined})*", ""]
    return "\n".join(lines)


TITLES = {
    "I": "introduction",
    "II": "the distributed observer",
    "III": "set-point control",
    "IV": "extended systems",
    "V": "delays",
    "VI": "concluding remarks",
}
"""What the sections of the paper are about."""


# The ledger lists the examinations of the paper, with their code.

KINDS = ("definition", "claim", "example", "numbered")


@dataclass(frozen=True)
class Examination:
    """One examination, of one or several statements of the paper.

    Attributes
    ----------
    key : str
        Its printed name or number in small letters, or a chosen word if it has none.
    title, section : str
    kind : {"definition", "claim", "example", "numbered"}
        An equation that defines something, a claim in the text, the example of IV-B, or a numbered
        theorem, proposition, lemma, corollary or remark.
    says : str
        A short version of what is examined.
    content : str
        What an instance needs for the statement to say something about it, in words.
    code : tuple of str
        The functions of this package that construct or decide it.
    equations : tuple of int
        The numbers of the paper's equations that it is about, as printed.
    labels : tuple of str
        Labels of the paper's LaTeX source, by which it can be named as well.
    certificates : tuple of str
        The kinds of certificates that are written for it.
    nearest_false : mapping of str to str
        The nearest false statements by short names; an instance of the examination refutes each.
    """

    key: str
    title: str
    section: str
    kind: str
    says: str
    content: str
    code: tuple[str, ...]
    equations: tuple[int, ...] = ()
    labels: tuple[str, ...] = ()
    certificates: tuple[str, ...] = ()
    nearest_false: Mapping[str, str] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """All names by which it can be asked for."""
        numbers = [f"({number})" for number in self.equations]
        return (self.key, self.title, *self.labels, *numbers)

    @property
    def about(self) -> tuple[Statement, ...]:
        """The statements that are examined here."""
        return tuple(each for each in statements() if self.key in each.examined)

    @property
    def proofs(self) -> tuple[str, ...]:
        """The machine-checked theorems of these statements, as file.theorem in ``proofs/``."""
        return tuple(dict.fromkeys(name for each in self.about for name in each.proofs))

    @property
    def erratum(self) -> str:
        """What has to be corrected in these statements, or an empty text."""
        wrong = (each for each in self.about if each.erratum)
        return " ".join(f"Statement {each.number}: {each.note}" for each in wrong)

    @property
    def verdicts(self) -> str:
        """What is known of these statements; one by one, if it is not the same for all."""
        told = [each for each in self.about if each.status not in ("defined", "informal")]
        kinds = dict.fromkeys(STATUSES[each.status] for each in told)
        if len(kinds) < 2:
            return next(iter(kinds), STATUSES["defined"])
        numbers = {
            kind: ", ".join(str(each.number) for each in told if STATUSES[each.status] == kind)
            for kind in kinds
        }
        return "; ".join(f"{numbers[kind]} {kind}" for kind in kinds)

    def status(self, instances: int, content: int) -> str:
        """What is known of its statements, and on how many instances it was checked.

        Parameters
        ----------
        instances : int
        content : int
            On how many of them the statement says something.

        Examples
        --------
        >>> examination("theorem-2").status(20, 9)
        'proved as printed, checked on 20 instances, 9 with content'
        >>> examination("partition").status(1, 1)
        'proved as printed, checked on 1 instance, with content'
        >>> examination("theorem-1").status(3, 3)
        'proved as printed, checked on 3 instances, all with content'
        """
        if self.kind == "example":
            return "computed exactly on the paper's data"
        many = "1 instance" if instances == 1 else f"{instances} instances"
        some = str(content) if content != instances else "all" if instances > 1 else ""
        return f"{self.verdicts}, checked on {many}, {some} with content".replace("  ", " ")


@cache
def examinations() -> tuple[Examination, ...]:
    """The ledger, in the order of the paper.

    Examples
    --------
    >>> [each.title for each in examinations() if each.kind == "numbered"][:3]
    ['Proposition 1', 'Theorem 1', 'Remark 1']
    """
    text = resources.files("mcexact.reproduce").joinpath("ledger.toml").read_text("utf-8")
    return tuple(_read(row) for row in tomllib.loads(text)["examination"])


def _read(row: dict[str, Any]) -> Examination:
    """Read one entry of the file."""
    fields: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in row.items()
    }
    return Examination(**fields)


def examination(key: str) -> Examination:
    """Return the examination with a key.

    Raises
    ------
    KeyError
        If there is none.
    """
    return {each.key: each for each in examinations()}[key]


def table() -> str:
    """The ledger as a table, which the documentation has."""
    lines = [
        "| examined | statements | verdict | section | an instance has content where "
        "| in the code | certificates | theorems, or instances |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for each in examinations():
        code = ", ".join(f"`{name.removeprefix('mcexact.')}`" for name in each.code)
        kinds = ", ".join(f"`{kind}`" for kind in each.certificates) or "named checks"
        numbers = ", ".join(str(one.number) for one in each.about)
        proof = ", ".join(f"`{name}`" for name in each.proofs) or "instances"
        where = each.content
        cells = (each.title, numbers, each.verdicts, each.section, where, code, kinds, proof)
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


# The records of one examination: instances, checks, refutations, certificates and pictures.


@dataclass(frozen=True)
class Check:
    """One named check.

    Attributes
    ----------
    text : str
        The compared property, in words.
    instance : str
        The instance that was checked.
    holds : bool
    """

    text: str
    instance: str
    holds: bool


@dataclass(frozen=True)
class Refutation:
    """A false statement near the one examined, and an instance that has to refute it.

    Attributes
    ----------
    name, statement : str
        The false statement, as the ledger has it, and its short name there.
    instance : str
    refuted : bool
    """

    name: str
    statement: str
    instance: str
    refuted: bool


@dataclass(frozen=True)
class CheckedCertificate:
    """A certificate that was encoded and verified by the independent checker.

    Attributes
    ----------
    name : str
        The name of its file, without the folder.
    kind, instance : str
    text : str
        The document.
    verdict, theorem : str
        The checker's verdict and the statement that it verified.
    """

    name: str
    kind: str
    instance: str
    text: str
    verdict: str
    theorem: str


@dataclass
class Notebook:
    """The evidence of one examination.

    Attributes
    ----------
    key : str
        The key of the examination in the ledger.
    here : str
        The name of the instance that the next entries are about.
    instances : list of str
    plants : dict of str to MultiChannelSystem
        Those instances that are plants.
    checks : list of Check
    refutations : list of Refutation
    certificates : list of CheckedCertificate
    pictures : list of EmbeddedPicture
    matrices : list of (str, str, rows)
        Instances with their neighbor sets, and their matrices by name, with the entries as texts.
    broken : str
        Empty, or the error with which the examination ended early.
    content : dict of str to bool
        Whether the statement says something about an instance: a bound of 0 allows everything.
        Instances that only refute a false statement are not among them.
    in_common : str
        What the instances have in common; set when the examination has ended.
    """

    key: str
    here: str = ""
    instances: list[str] = field(default_factory=list)
    plants: dict[str, MultiChannelSystem] = field(default_factory=dict)
    checks: list[Check] = field(default_factory=list)
    refutations: list[Refutation] = field(default_factory=list)
    certificates: list[CheckedCertificate] = field(default_factory=list)
    pictures: list[EmbeddedPicture] = field(default_factory=list)
    matrices: list[tuple[str, str, list[list[str]]]] = field(default_factory=list)
    broken: str = ""
    content: dict[str, bool] = field(default_factory=dict)
    in_common: str = ""

    def counts(self, holds: bool) -> None:
        """Say whether the statement has content for the present instance."""
        self.content[self.here] = self.content.get(self.here, False) or bool(holds)

    @property
    def with_content(self) -> int:
        """The number of instances about which the statement says something."""
        return sum(self.content.values())

    def on(self, instance: str, plant: MultiChannelSystem | None = None) -> None:
        """Name the instance of the next entries, and say which plant it is, if it is one."""
        self.here = instance
        if instance not in self.instances:
            self.instances.append(instance)
        if plant is not None:
            self.plants.setdefault(instance, plant)

    def at(self, instance: Instance) -> MultiChannelSystem:
        """The plant of an instance, which the next entries are about."""
        self.on(*instance)
        return instance[1]

    def each(self, *groups: Iterable[Instance]) -> Iterator[MultiChannelSystem]:
        """The plants of some instances, one after another."""
        return map(self.at, chain.from_iterable(groups))

    def check(self, text: str, holds: bool) -> None:
        """Record whether a property holds."""
        self.checks.append(Check(text, self.here, bool(holds)))

    def refute(self, name: str, refuted: bool = True) -> None:
        """Record that the present instance refutes a false statement, or that it fails to."""
        statement = examination(self.key).nearest_false[name]
        self.refutations.append(Refutation(name, statement, self.here, bool(refuted)))

    def certify(self, *answers: Answer) -> None:
        """Record answers as certificates, verified by the independent checker."""
        for answer in answers:
            text = protocol.encode(answer)
            report = checked(text.encode("ascii"))
            number = len(self.certificates) + 1
            name = f"{self.key}-{number:02d}-{answer.kind}.json"
            self.certificates.append(
                CheckedCertificate(
                    name, answer.kind, self.here, text, report.verdict, report.line()
                )
            )

    def joint(self, system: MultiChannelSystem) -> None:
        """Decide whether all channels together control and observe a system, and write it down."""
        for answer in (joint_controllability(system), joint_observability(system)):
            self.check("jointly controllable and observable", answer.controllable)
            self.certify(answer)

    def print(self, system: MultiChannelSystem) -> None:
        """Show A, all B_i, C_i and N_i of a system, which is the present instance."""
        named = [("A", system.A)]
        named += [
            (f"B_{name}", channel.B)
            for name, channel in zip(system.names, system.channels, strict=True)
        ]
        named += [
            (f"C_{name}", channel.C)
            for name, channel in zip(system.names, system.channels, strict=True)
        ]
        where = self.here
        if system.neighbors is not None:
            sets = [
                f"N_{name} = {{{', '.join(map(system.names.__getitem__, heard))}}}"
                for name, heard in zip(system.names, system.neighbors.neighbors, strict=True)
            ]
            where += f", with {', '.join(sets)}"
        for name, matrix in named:
            rows = [[str(entry) for entry in row] for row in matrix.rows()]
            self.matrices.append((where, name, rows))

    def show(self, picture: Picture) -> None:
        """Add a picture."""
        self.pictures.append(picture.embedded())

    def grouped_checks(self) -> list[tuple[str, str, bool]]:
        """Every check once, with all instances where it holds or fails."""
        return _grouped((each.text, each.instance, each.holds) for each in self.checks)

    def grouped_refutations(self) -> list[tuple[str, str, bool]]:
        """Every false statement once, with all instances that refute it or fail to."""
        return _grouped((each.statement, each.instance, each.refuted) for each in self.refutations)

    @property
    def failure(self) -> str:
        """Empty, or why the examination fails: the first thing that went wrong."""
        if self.broken:
            return self.broken
        for check in self.checks:
            if not check.holds:
                return f"{check.instance}: this check failed: {check.text}"
        for each in self.certificates:
            if each.verdict != "VALID":
                return f"{each.instance}: the certificate {each.name}: {each.theorem}"
        for attempt in self.refutations:
            if not attempt.refuted:
                return f"{attempt.instance}: this is not refuted: {attempt.statement}"
        refuted = {attempt.name for attempt in self.refutations}
        for name, false in examination(self.key).nearest_false.items():
            if name not in refuted:
                return f"no instance refutes: {false}"
        if not self.with_content:
            return f"no instance has content: {examination(self.key).content}"
        return "" if self.checks or self.certificates else "nothing was checked"

    @property
    def holds(self) -> bool:
        """Whether all checks hold, certificates are VALID and false statements are refuted."""
        return not self.failure


def _grouped(entries: Iterable[tuple[str, str, bool]]) -> list[tuple[str, str, bool]]:
    """Texts with the instances that they are about, by whether they hold there."""
    instances: dict[tuple[str, bool], dict[str, None]] = {}
    for text, instance, holds in entries:
        instances.setdefault((text, holds), {})[instance] = None
    return [(text, "; ".join(names), holds) for (text, holds), names in instances.items()]


Procedure = Callable[[Notebook], None]


def examined(key: str, procedure: Procedure) -> Notebook:
    """Run the procedure of one examination; after an error, the examination fails.

    Parameters
    ----------
    key : str
    procedure : callable
        The function that fills the notebook.
    """
    notebook = Notebook(key)
    try:
        procedure(notebook)
    except Exception as error:
        first = str(error).splitlines()[0] if str(error) else ""
        notebook.broken = f"{notebook.here}: {type(error).__name__}: {first}"
    notebook.in_common = in_common(notebook.instances, notebook.plants)
    return notebook
