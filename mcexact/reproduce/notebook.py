"""What is written down while a statement is checked: instances, checks, certificates, pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.answer import codec
from mcexact.checker import check_document
from mcexact.model.system import MultiChannelSystem
from mcexact.report.picture import EmbeddedPicture, Picture
from mcexact.reproduce.material import Instance


@dataclass(frozen=True)
class Check:
    """One named check.

    Attributes
    ----------
    text : str
        What was compared, in words.
    instance : str
        On what.
    holds : bool
    """

    text: str
    instance: str
    holds: bool


@dataclass(frozen=True)
class CheckedCertificate:
    """A certificate that was written, encoded, and read again by the independent checker.

    Attributes
    ----------
    name : str
        Of its file, without the folder.
    kind, instance : str
    text : str
        The document.
    verdict, theorem : str
        What the checker said.
    """

    name: str
    kind: str
    instance: str
    text: str
    verdict: str
    theorem: str


@dataclass(frozen=True)
class Finding:
    """What came out for one statement.

    Attributes
    ----------
    key : str
        Of the statement in the ledger.
    holds : bool
        Every check holds, every certificate is VALID, and there is at least one of either.
    instances : tuple of str
    checks : tuple of Check
    certificates : tuple of CheckedCertificate
    pictures : tuple of EmbeddedPicture
    failure : str
        Empty, or why it does not hold: the first thing that went wrong.
    """

    key: str
    holds: bool
    instances: tuple[str, ...]
    checks: tuple[Check, ...]
    certificates: tuple[CheckedCertificate, ...]
    pictures: tuple[EmbeddedPicture, ...]
    failure: str


@dataclass
class Notebook:
    """Collects the evidence for one statement."""

    key: str
    here: str = ""
    instances: list[str] = field(default_factory=list)
    checks: list[Check] = field(default_factory=list)
    certificates: list[CheckedCertificate] = field(default_factory=list)
    pictures: list[EmbeddedPicture] = field(default_factory=list)

    def on(self, instance: str) -> None:
        """Say what the next entries are about."""
        self.here = instance
        if instance not in self.instances:
            self.instances.append(instance)

    def at(self, instance: Instance) -> MultiChannelSystem:
        """The plant of an instance, which the next entries are about."""
        name, plant = instance
        self.on(name)
        return plant

    def each(self, *groups: Iterable[Instance]) -> Iterator[MultiChannelSystem]:
        """The plants of some instances, one after another."""
        return map(self.at, chain.from_iterable(groups))

    def check(self, text: str, holds: bool) -> None:
        """Write down whether something holds."""
        self.checks.append(Check(text, self.here, bool(holds)))

    def certify(self, *results: Any) -> None:
        """Have the independent checker read the certificates of these results."""
        for result in results:
            made = getattr(result, "certificate", result)
            text = codec.encode(made)
            said = check_document(text.encode("ascii"))
            number = len(self.certificates) + 1
            name = f"{self.key.replace(':', '-')}-{number:02d}-{made.kind}.json"
            self.certificates.append(
                CheckedCertificate(name, made.kind, self.here, text, said.verdict, said.line())
            )

    def joint(self, system: MultiChannelSystem) -> None:
        """Decide whether all channels together control and observe a system, and write it down."""
        for found in (joint_controllability(system), joint_observability(system)):
            self.check("jointly controllable and observable", found.controllable)
            self.certify(found)

    def show(self, picture: Picture) -> None:
        """Add a picture."""
        self.pictures.append(picture.embedded())

    def failure(self) -> str:
        """The first thing that went wrong; empty if nothing did."""
        for check in self.checks:
            if not check.holds:
                return f"{check.instance}: it is not so that {check.text}"
        for made in self.certificates:
            if made.verdict != "VALID":
                return f"{made.instance}: the certificate {made.name}: {made.theorem}"
        return "" if self.checks or self.certificates else "nothing was checked"

    def finding(self, failure: str = "") -> Finding:
        """Close the notebook."""
        failure = failure or self.failure()
        return Finding(
            self.key,
            not failure,
            tuple(self.instances),
            tuple(self.checks),
            tuple(self.certificates),
            tuple(self.pictures),
            failure,
        )


Procedure = Callable[[Notebook], None]


def examined(key: str, procedure: Procedure) -> Finding:
    """Run the procedure of one statement; an error is a statement that does not hold.

    Parameters
    ----------
    key : str
    procedure : callable
        Writes into the notebook that it gets.
    """
    notebook = Notebook(key)
    try:
        procedure(notebook)
    except Exception as error:
        first = str(error).splitlines()[0] if str(error) else ""
        return notebook.finding(f"{notebook.here}: {type(error).__name__}: {first}")
    return notebook.finding()
