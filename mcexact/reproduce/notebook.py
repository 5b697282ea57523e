"""The records of one examination: instances, checks, refutations, certificates and pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.answer import protocol
from mcexact.answer.check import checked
from mcexact.answer.protocol import Answer
from mcexact.model.system import MultiChannelSystem
from mcexact.report.html import EmbeddedPicture, Picture
from mcexact.reproduce.ledger import examination
from mcexact.reproduce.material import Instance
from mcexact.reproduce.properties import in_common


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
        What the next entries are about.
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
        Empty, or why the examination came to no end.
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
    in_common: str = ""

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
        for made in answers:
            text = protocol.encode(made)
            said = checked(text.encode("ascii"))
            number = len(self.certificates) + 1
            name = f"{self.key}-{number:02d}-{made.kind}.json"
            self.certificates.append(
                CheckedCertificate(name, made.kind, self.here, text, said.verdict, said.line())
            )

    def joint(self, system: MultiChannelSystem) -> None:
        """Decide whether all channels together control and observe a system, and write it down."""
        for found in (joint_controllability(system), joint_observability(system)):
            self.check("jointly controllable and observable", found.controllable)
            self.certify(found)

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
        for name, found in named:
            rows = [[str(entry) for entry in row] for row in found.rows()]
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
        for made in self.certificates:
            if made.verdict != "VALID":
                return f"{made.instance}: the certificate {made.name}: {made.theorem}"
        for attempt in self.refutations:
            if not attempt.refuted:
                return f"{attempt.instance}: this is not refuted: {attempt.statement}"
        refuted = {attempt.name for attempt in self.refutations}
        for name, false in examination(self.key).nearest_false.items():
            if name not in refuted:
                return f"no instance refutes: {false}"
        return "" if self.checks or self.certificates else "nothing was checked"

    @property
    def holds(self) -> bool:
        """Whether all checks hold, all certificates are VALID, and all false statements fall."""
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
        The function that fills the notebook it is given.
    """
    notebook = Notebook(key)
    try:
        procedure(notebook)
    except Exception as error:
        first = str(error).splitlines()[0] if str(error) else ""
        notebook.broken = f"{notebook.here}: {type(error).__name__}: {first}"
    notebook.in_common = in_common(notebook.instances, notebook.plants)
    return notebook
