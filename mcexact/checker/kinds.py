"""The table of certificate kinds, and the one function that gives the verdict VALID."""

import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import NoReturn, TypeVar

from . import (
    assignability,
    box_controllable,
    box_fixed,
    box_stable,
    closed_loop_spectrum,
    common_dimension,
    communication,
    complementary_subsystem,
    completeness,
    controllability,
    controllability_indices,
    deficiency,
    distributed_observer,
    exceptional_gains,
    fixed_spectrum,
    neighbor_graph,
    parametric_box_controllable,
    parametric_box_fixed,
    parametric_box_stable,
    parametric_fixed_spectrum,
    parametric_rank,
    pencil_rank,
    setpoint,
    shared_dimensions,
    single_channel_gains,
    stability,
    transfer_graph,
)
from .arithmetic import NotAUnit
from .budget import MORE, current, limited
from .expectation import Expectation
from .moved_entries import subject_of
from .parametric_system import FunctionSystem, digest, digest_of_values, plant_of
from .reading import Json, Limits, Refused, fields, incomplete, malformed, parse, shown, string
from .statement import described, digest_of

FORMAT = "mcexact-certificate/1"
T = TypeVar("T")


@dataclass(frozen=True)
class Rule:
    """The rule of one kind of certificates.

    Attributes
    ----------
    check : callable
        ``check(claim, witness, system)`` stops unless the witness proves the claim.
    statement : callable
        ``statement(claim, system)`` says the claim in words, from the claim and the subject alone.
    """

    check: Callable[..., None]
    statement: Callable[..., str]


KINDS = {
    "assignability": Rule(assignability.check, assignability.statement),
    "box_controllable": Rule(box_controllable.check, box_controllable.statement),
    "box_fixed": Rule(box_fixed.check, box_fixed.statement),
    "box_stable": Rule(box_stable.check, box_stable.statement),
    "closed_loop_spectrum": Rule(closed_loop_spectrum.check, closed_loop_spectrum.statement),
    "common_dimension": Rule(common_dimension.check, common_dimension.statement),
    "communication": Rule(communication.check, communication.statement),
    "complementary_subsystem": Rule(
        complementary_subsystem.check, complementary_subsystem.statement
    ),
    "completeness": Rule(completeness.check, completeness.statement),
    "controllability": Rule(controllability.check, controllability.statement),
    "controllability_indices": Rule(
        controllability_indices.check, controllability_indices.statement
    ),
    "deficiency": Rule(deficiency.check, deficiency.statement),
    "distributed_observer": Rule(distributed_observer.check, distributed_observer.statement),
    "exceptional_gains": Rule(exceptional_gains.check, exceptional_gains.statement),
    "fixed_spectrum": Rule(fixed_spectrum.check, fixed_spectrum.statement),
    "neighbor_graph": Rule(neighbor_graph.check, neighbor_graph.statement),
    "parametric_box_controllable": Rule(
        parametric_box_controllable.check, parametric_box_controllable.statement
    ),
    "parametric_box_fixed": Rule(parametric_box_fixed.check, parametric_box_fixed.statement),
    "parametric_box_stable": Rule(parametric_box_stable.check, parametric_box_stable.statement),
    "parametric_fixed_spectrum": Rule(
        parametric_fixed_spectrum.check, parametric_fixed_spectrum.statement
    ),
    "parametric_rank": Rule(parametric_rank.check, parametric_rank.statement),
    "pencil_rank": Rule(pencil_rank.check, pencil_rank.statement),
    "setpoint": Rule(setpoint.check, setpoint.statement),
    "shared_dimensions": Rule(shared_dimensions.check, shared_dimensions.statement),
    "single_channel_gains": Rule(single_channel_gains.check, single_channel_gains.statement),
    "stability": Rule(stability.check, stability.statement),
    "transfer_graph": Rule(transfer_graph.check, transfer_graph.statement),
}
"""The rule of each kind."""
STATUSES = dict.fromkeys(("VALID", "IMPLIED", "REMARK", "COUNTED"), 0)
STATUSES |= {"INVALID": 1, "MALFORMED": 3, "INCOMPLETE": 5}


@dataclass(frozen=True)
class Verdict:
    """The verdict on one certificate or one sentence.

    Attributes
    ----------
    verdict : str
        VALID (for a sentence IMPLIED, or REMARK if it claims nothing), INVALID, MALFORMED,
        INCOMPLETE, or ERROR for a bug in this checker; COUNTED for the numbers of these in a
        manifest.
    statement : str
        What was proved, in words, or counted; else empty.
    statement_digest : str
        The SHA-256 of the statement of a certificate.
    system_digest : str
        The SHA-256 of the certificate's plant; empty if it could not be read.
    controller_digest : str
        The SHA-256 of the controller of the closed loop that the certificate is about; empty if it
        is about none.
    code, place, message : str
        If it is not VALID, a word for the reason, the place in the document, and a sentence.
    spent : int
        The units of work that it took.
    """

    verdict: str
    statement: str = ""
    statement_digest: str = ""
    system_digest: str = ""
    controller_digest: str = ""
    code: str = ""
    place: str = ""
    message: str = ""
    spent: int = field(default=0, compare=False)

    def __bool__(self) -> NoReturn:
        raise TypeError("a verdict is neither true nor false: ask whether .verdict is VALID")

    @property
    def status(self) -> int:
        """The exit status that belongs to this verdict."""
        return STATUSES.get(self.verdict, 70)

    def inside(self, where: str) -> "Verdict":
        """The same, about a part of something, by its place there if it is not good."""
        return replace(self, place=f"{where} {self.place}" if self.status else "")

    def line(self, name: str = "") -> str:
        """The verdict as one line of text, with the name of what it is about behind it."""
        told = [self.verdict, name, self.statement_digest, self.statement]
        if self.status:
            told = [self.verdict, name, self.code, f"{self.place}: {self.message}"]
        return " ".join(part for part in told if part)


def check_document(
    data: bytes | Mapping[str, Json],
    expected: Expectation | None = None,
    limits: Limits | None = None,
) -> Verdict:
    """Check one certificate.

    Parameters
    ----------
    data : bytes or mapping
        The text of the file, or the document that it would parse to.
    expected : Expectation, optional
        What the certificate must be about, and what it must say.
    limits : Limits, optional

    Returns
    -------
    Verdict
        After anything unexpected, including an exception, the verdict is not VALID.
    """
    wanted, known, controller, allowed = expected or Expectation(), "", "", limits or Limits()

    def check() -> Verdict:
        nonlocal known, controller
        text = data if isinstance(data, bytes) else _text(data)
        with limited(budget, len(text)):
            kind, given, steps, claim, witness = _parts(parse(text, allowed))
            if type(given) is str:
                given = wanted.named(given)
                budget.grant(wanted.size)
            plant = plant_of(given)
            ranged = isinstance(plant, FunctionSystem)
            budget.times = MORE if ranged else budget.times
            known = digest(plant)
            wanted.require_plant(known, digest_of_values(plant, known), ranged)
            budget.builds = True
            system = subject_of(steps, replace(plant, words=f"the plant {known}"), kind)
            budget.builds = False
            controller = system.controller
            wanted.require_subject(steps, controller)
            KINDS[kind].check(claim, witness, system)
            statement = f"For {described(system)}: {KINDS[kind].statement(claim, system)}"
            wanted.require_said(kind, claim, statement)
            return Verdict("VALID", statement, digest_of(statement))

    budget = current(allowed.work)
    before = budget.spent
    verdict, spent = attempt(check), budget.spent - before
    return replace(verdict, spent=spent, system_digest=known, controller_digest=controller)


Found = tuple[dict[str, str], Verdict]
"""A verdict behind what it is about: a ``file``, or the ``text`` of a sentence."""


def refusal(verdict: str, code: str, place: str, message: str) -> Verdict:
    """A verdict that proves nothing, and why."""
    return Verdict(verdict, code=code, place=place, message=message)


def attempt(work: Callable[[], T]) -> T | Verdict:
    """Do some work, and turn an exception into a verdict."""
    digits = sys.get_int_max_str_digits()
    try:
        # The reader limits the number of digits; the interpreter's own limit would stop some
        # messages.
        sys.set_int_max_str_digits(0)
        return work()
    except Refused as found:
        return refusal(*found.args)
    except MemoryError:
        return refusal("INCOMPLETE", "memory", "checker", "more memory than there is")
    except NotAUnit:
        return refusal("INVALID", "unit", "witness.modulus", "a number is not invertible modulo l")
    except Exception as error:
        message = f"{type(error).__name__}: {error}".splitlines()[0][:200]
        return refusal("ERROR", "internal", "checker", ascii(message))
    finally:
        sys.set_int_max_str_digits(digits)


def _text(document: Json) -> bytes:
    """The text of a document in memory, which is then read as strictly as a file."""
    try:
        return json.dumps(dict(document)).encode("ascii")
    except (TypeError, ValueError, RecursionError) as error:
        malformed("file", f"expected a document of JSON: {ascii(str(error))[1:101]}")


def _parts(document: Json) -> list[Json]:
    """The five parts of a certificate of a known version and kind."""
    if not isinstance(document, Mapping):
        malformed("file", f"expected a certificate, found {shown(document)}")
    version = string(document.get("format"), "format")
    if version != FORMAT:
        if version.startswith(FORMAT.partition("/")[0] + "/"):
            incomplete("version", "format", f"{shown(version)} is not a version known here")
        malformed("format", f"expected {FORMAT!r}, found {shown(version)}")
    _, *parts = fields(document, "file", "format", "kind", "system", "subject", "claim", "witness")
    if string(parts[0], "kind") not in KINDS:
        incomplete("kind", "kind", f"{shown(parts[0])} is not a kind known here")
    return parts
