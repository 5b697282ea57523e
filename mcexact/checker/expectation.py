"""What is asked of a certificate: the plant, the controller, and the statement or the claim."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from . import reading
from .budget import current, limited
from .controller import read_controller_file
from .parametric_system import plant_of_file
from .reading import Json, Limits, fields, items, malformed, parse, require, shown, string
from .statement import canonical_json, digest_of

DIGEST = re.compile(r"[0-9a-f]{64}")
LINE = re.compile(r"(?:VALID (?:'[^']*' )?([0-9a-f]{64}) )?(For .*)")
"""A statement, alone or in the line of its verdict."""
CLAIM = 'a claim as a JSON object {"kind": ..., "subject": [...], "claim": {...}}'
LOOP = "closed_loop"


@dataclass(frozen=True)
class Expectation:
    """The system, the controller and the statement that a certificate must have.

    Attributes
    ----------
    system : str
        The digest of the plant; empty for any.  Where the plant has no radii, a certificate about
        a box around it is about it, too.
    plant : object
        The plant as in a certificate, which may then name it by its digest; None where only its
        digest is known, or any will do.
    size : int
        The bytes of the plant as JSON, which are granted work as if they stood in the certificate.
    controller : str
        The digest of the controller of the loop; empty for any, or for none.
    made_for : str
        The digest of the plant, without radii, that the file of the controller names; empty for
        any.
    statement : str
        The digest of the statement; empty for any.
    kind : str
        The kind of the claim; empty for any.
    subject : list
        The constructions of the subject; None for any, unless a controller is given without a
        statement: then the plant itself is in the loop.  With a controller, its closed loop follows
        on them where they do not end with one.
    claim : object
        The claim as in a certificate; None for any.
    """

    system: str = ""
    plant: Json = None
    size: int = 0
    controller: str = ""
    made_for: str = ""
    statement: str = ""
    kind: str = ""
    subject: Json = None
    claim: Json = None

    def about(self, data: bytes, limits: Limits) -> Expectation:
        """The same, about the plant in a system file."""
        plant = plant_of_file(data, limits)
        text = canonical_json(plant)
        return replace(self, system=digest_of(text), plant=plant, size=len(text))

    def controlled(self, data: bytes, limits: Limits) -> Expectation:
        """The same, about a loop with the controller in a controller file."""
        controller, made_for = read_controller_file(data, limits)
        return replace(self, controller=controller, made_for=made_for)

    def saying(self, data: bytes, limits: Limits) -> Expectation:
        """The same, with a statement, its digest, the line of a verdict, or a claim.

        Raises
        ------
        Refused
            If the text is neither.
        """
        if data.lstrip()[:1] == b"{":
            with limited(current(limits.work), len(data)):
                return self._claiming(parse(data, limits))
        text = data.decode("ascii", "replace").strip()
        if DIGEST.fullmatch(text.lower()):
            return replace(self, statement=text.lower())
        line = LINE.fullmatch(text)
        if not line or not text.isascii() or len(text.splitlines()) != 1:
            malformed("file", f"expected a statement, its SHA-256, or {CLAIM}")
        found = digest_of(line[2])
        if line[1] not in (None, found):
            malformed("file", f"the statement has not the digest before it, but {found}")
        return replace(self, statement=found)

    def _claiming(self, value: Json) -> Expectation:
        """The same, with the claim of a kind about a subject, by default what is there already."""
        if "claim" not in value:
            malformed("file", f'expected {CLAIM}, found no "claim"')
        kind, claim, steps = fields(value, "file", "kind", "claim", optional=("subject",))
        subject = self.subject or [] if steps is None else items(steps, "subject")
        if not isinstance(claim, dict):
            malformed("claim", f"expected an object, found {shown(claim)}")
        return replace(self, kind=string(kind, "kind"), subject=subject, claim=claim)

    def named(self, value: str) -> Json:
        """The plant that a certificate names by its digest."""
        if not DIGEST.fullmatch(value):
            malformed("system", f"expected a system or its SHA-256, found {shown(value)}")
        if self.plant is None:
            reading.incomplete("system", "system", f"give the system of digest {value} (--system)")
        self._require_system(value, "")
        return self.plant

    def require_plant(self, found: str, values: str, ranged: bool = False) -> None:
        """Stop unless the certificate is about the plant, or about a box around it.

        ``found`` is the digest of the certificate's plant, ``values`` that of it without radii,
        which is the one that controllers are made for; of a plant whose parameters are ``ranged``
        they are made for some values.
        """
        self._require_system(found, values)
        message = f"about the system of digest {values}, the controller is for {self.made_for}"
        fits = ranged or self.made_for in ("", values)
        require(fits, "controller", "system", message)

    def _require_system(self, found: str, values: str) -> None:
        message = f"about another system, of digest {found}, not {self.system}"
        require(self.system in ("", found, values), "system", "system", message)

    def require_subject(self, steps: Json, found: str) -> None:
        """Stop unless the certificate has the subject, and the controller where one is given."""
        expected = self.subject
        if self.controller:
            require(bool(found), "controller", "subject", "about no closed loop")
            message = f"about another controller, of digest {found}, not {self.controller}"
            require(found == self.controller, "controller", "subject", message)
            if expected is None and not self.statement:
                expected = []
            if expected is not None and made_by(expected)[-1:] != [LOOP]:
                expected = [*expected, *(step for step in steps[-1:] if made_by([step]) == [LOOP])]
        if expected is not None:
            told = ", ".join(made_by(steps)) or "none"
            message = f"another subject than asked for; its constructions are: {told}"
            require(same(steps, expected), "expected", "subject", message)

    def require_said(self, kind: str, claim: Json, statement: str) -> None:
        """Stop unless the certificate makes the statement, or the claim of its kind."""
        other = f"a claim of another kind, {kind}"
        require(self.kind in ("", kind), "expected", "kind", other)
        other = f"it states something else: {statement}"
        require(self.statement in ("", digest_of(statement)), "expected", "claim", other)
        right = self.claim is None or same(claim, self.claim)
        message = f"another claim, which differs in {difference(claim, self.claim)}"
        require(right, "expected", "claim", f"{message} and states: {statement}")


def difference(claim: Json, asked: Json) -> str:
    """The keys in which two claims differ, as a message shows them."""
    asked = asked or {}
    keys = {k for k in claim.keys() & asked.keys() if not same(claim[k], asked[k])}
    return ", ".join(map(shown, sorted(keys | claim.keys() ^ asked.keys())))


def made_by(steps: Json) -> list[Json]:
    """The names of constructions."""
    return [step.get("construction") if isinstance(step, dict) else None for step in steps]


def same(a: Json, b: Json) -> bool:
    """Whether two values are equal as JSON: true differs from 1, and keys have no order."""
    if type(a) is not type(b):
        return False
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return bool(a == b)
