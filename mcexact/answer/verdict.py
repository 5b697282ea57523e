"""The verdict of the independent checker, as Python shows it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from mcexact import checker
from mcexact.shown import LINE, Shown, fitting


@dataclass(frozen=True, repr=False)
class Verdict(Shown, checker.Verdict):
    """The verdict on one certificate: VALID, or why not.

    Attributes
    ----------
    verdict : str
        VALID, INVALID, MALFORMED, INCOMPLETE, or ERROR for a bug in the checker.
    statement : str
        The theorem that was proved, in words; else empty.
    statement_digest, system_digest, controller_digest : str
        The SHA-256 of the statement, of the plant, and of the controller if there is one.
    code, place, message : str
        If it is not VALID, a word for the reason, the place in the document, and a sentence.
    spent : int
        The units of work that it took.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem, check, fixed_spectrum
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> check(fixed_spectrum(plant)).valid
    True
    >>> other = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> print(check(fixed_spectrum(plant), other).explain())  # doctest: +ELLIPSIS
    INVALID system system: about another system, ...
    """

    @classmethod
    def of(cls, found: checker.Verdict) -> Verdict:
        """Return the verdict that the checker found."""
        return cls(**vars(found))

    @property
    def valid(self) -> bool:
        """Whether the certificate is VALID, so that its statement is proved."""
        return self.verdict == "VALID"

    def explain(self) -> str:
        """Say what was proved, or why the certificate is not valid."""
        return self.statement if self.valid else self.line()

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the verdict with what it says."""
        yield "verdict", self.verdict
        for name in ("statement", "code", "place", "message"):
            if getattr(self, name):
                yield name, getattr(self, name)

    def to_dict(self) -> dict[str, Any]:
        """Return the verdict as plain data."""
        return dict(vars(self))

    def __repr__(self) -> str:
        told = f"VALID: {self.statement}" if self.valid else self.line()
        return fitting(f"Verdict({told}", LINE - 1) + ")"
