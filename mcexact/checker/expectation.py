"""What is asked of a certificate: the plant, the controller, and the statement or the claim."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from .controller import read_controller_file
from .reading import Json, Limits, malformed, parse, require
from .statement import digest_of
from .system import digest, read_system_file

DIGEST = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True)
class Expectation:
    """The system, the controller and the statement that a certificate must have.

    Attributes
    ----------
    system : str
        The digest of the plant; empty for any.
    controller : str
        The digest of the controller of the loop; empty for any, or for none.
    made_for : str
        The digest of the plant that the file of the controller names; empty for any.
    statement : str
        The digest of the statement; empty for any.
    claim : object
        The claim as in a certificate; None for any.
    """

    system: str = ""
    controller: str = ""
    made_for: str = ""
    statement: str = ""
    claim: Json = None

    def about(self, data: bytes, limits: Limits) -> Expectation:
        """The same, about the plant in a system file."""
        return replace(self, system=digest(read_system_file(data, limits)))

    def controlled(self, data: bytes, limits: Limits) -> Expectation:
        """The same, about a loop with the controller in a controller file."""
        controller, made_for = read_controller_file(data, limits)
        return replace(self, controller=controller, made_for=made_for)

    def saying(self, data: bytes, limits: Limits) -> Expectation:
        """The same, with a statement, its digest, or a claim.

        Raises
        ------
        Refused
            If the text is neither.
        """
        if data.lstrip()[:1] == b"{":
            return replace(self, claim=parse(data, limits))
        text = data.decode("ascii", "replace").strip()
        if DIGEST.fullmatch(text):
            return replace(self, statement=text)
        if not text.isascii() or not text.startswith("For ") or len(text.splitlines()) != 1:
            malformed("file", "expected a statement, its SHA-256, or a claim as a JSON object")
        return replace(self, statement=digest_of(text))

    def require_plant(self, found: str) -> None:
        """Stop unless the certificate is about the plant."""
        right = self.system in ("", found)
        message = f"about another system, of digest {found}, not {self.system}"
        require(right, "system", "system", message)
        fits = self.made_for in ("", found)
        message = f"about the system of digest {found}, the controller is for {self.made_for}"
        require(fits, "controller", "system", message)

    def require_controller(self, found: str) -> None:
        """Stop unless the certificate is about a closed loop with the controller."""
        if self.controller:
            require(bool(found), "controller", "subject", "about no closed loop")
            message = f"about another controller, of digest {found}, not {self.controller}"
            require(found == self.controller, "controller", "subject", message)

    def require_said(self, claim: Json, statement: str) -> None:
        """Stop unless the certificate makes the statement, or the claim."""
        right = self.statement in ("", digest_of(statement))
        require(right, "expected", "claim", f"it states something else: {statement}")
        right = self.claim is None or same(claim, self.claim)
        require(right, "expected", "claim", f"another claim, which states: {statement}")


def same(a: Json, b: Json) -> bool:
    """Whether two values are equal as JSON: true differs from 1, and keys have no order."""
    if type(a) is not type(b):
        return False
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return bool(a == b)
