"""The table of certificate kinds, and the one function that gives the verdict VALID."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import Any

from .arithmetic import NotAUnit
from .budget import current, limited
from .reading import Limits, Refused, fields, incomplete, malformed, parse, require, shown, string
from .subject import read_subject
from .system import System, digest, read_plant

FORMAT = "mcexact-certificate/1"

Rule = Callable[[Any, Any, System], str]

# fmt: off
STEMS = (
    "assignability", "closed_loop_spectrum", "common_dimension", "communication",
    "complementary_subsystem", "completeness", "controllability", "controllability_indices",
    "deficiency", "distributed_observer", "exceptional_gains", "fixed_spectrum", "neighbor_graph",
    "pencil_rank", "setpoint", "shared_dimensions", "single_channel_gains", "stability",
    "transfer_graph",
)
# fmt: on
KINDS: dict[str, Rule] = {stem: import_module(f".{stem}", __package__).check for stem in STEMS}
"""The rule of each kind, from the file of the same name."""


@dataclass(frozen=True)
class Verdict:
    """The verdict on one certificate or one sentence.

    Attributes
    ----------
    verdict : str
        VALID (for a sentence IMPLIED), INVALID, MALFORMED, INCOMPLETE, or ERROR for a bug in this
        checker.
    theorem : str
        The statement that was checked, in words; empty unless VALID or IMPLIED.
    digest : str
        The SHA-256 of the certificate's plant; empty if it could not be read.
    code, place, message : str
        If it is not VALID, a word for the reason, the place in the document, and a sentence.
    spent : int
        The units of work that it took.
    """

    verdict: str
    theorem: str = ""
    digest: str = ""
    code: str = ""
    place: str = ""
    message: str = ""
    spent: int = field(default=0, compare=False)

    @property
    def status(self) -> int:
        """The exit status that belongs to this verdict."""
        statuses = {"VALID": 0, "IMPLIED": 0, "INVALID": 1, "MALFORMED": 3, "INCOMPLETE": 5}
        return statuses.get(self.verdict, 70)

    def line(self) -> str:
        """The verdict as one line of text."""
        if not self.status:
            return f"{self.verdict} {self.theorem} {self.digest}".rstrip()
        return f"{self.verdict} {self.code} {self.place}: {self.message}"


def check_document(
    data: bytes | Mapping[str, Any], system_digest: str | None = None, limits: Limits | None = None
) -> Verdict:
    """Check one certificate.

    Parameters
    ----------
    data : bytes or mapping
        The text of the file, or the document that it would parse to.
    system_digest : str, optional
        The digest of the system that the certificate must be about.
    limits : Limits, optional

    Returns
    -------
    Verdict
        After anything unexpected, including an exception, the verdict is not VALID.
    """
    known, allowed = "", limits or Limits()

    def check() -> Verdict:
        nonlocal known
        document = parse(data, allowed) if isinstance(data, bytes) else data
        kind, plant, steps, claim, witness = _parts(document)
        system = read_plant(plant)
        known = digest(system)
        if system_digest is not None:
            same = known == system_digest
            require(same, "system", "system", f"about another system, of digest {known}")
        return Verdict("VALID", KINDS[kind](claim, witness, read_subject(steps, system)))

    def check_within() -> Verdict:
        text = data if isinstance(data, bytes) else json.dumps(data, skipkeys=True, default=repr)
        with limited(budget, len(text)):
            return check()

    budget = current(allowed.work)
    before = budget.spent
    verdict = answer(check_within)
    return replace(verdict, digest=known, spent=budget.spent - before)


def answer(check: Callable[[], Verdict]) -> Verdict:
    """Run a check, and turn an exception into a verdict."""
    digits = sys.get_int_max_str_digits()
    try:
        # The reader limits the number of digits; the interpreter's own limit would stop some
        # messages.
        sys.set_int_max_str_digits(0)
        return check()
    except Refused as found:
        return Verdict(found.verdict, "", "", found.code, found.place, found.message)
    except MemoryError:
        return Verdict("INCOMPLETE", "", "", "memory", "checker", "more memory than there is")
    except NotAUnit:
        message = "a number that has to be inverted is not a unit modulo l"
        return Verdict("INVALID", "", "", "unit", "witness.modulus", message)
    except Exception as error:
        message = f"{type(error).__name__}: {error}".splitlines()[0][:200]
        return Verdict("ERROR", "", "", "internal", "checker", ascii(message))
    finally:
        sys.set_int_max_str_digits(digits)


def _parts(document: Any) -> list[Any]:
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
