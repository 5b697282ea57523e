"""Verification of every answer's certificate by the independent checker."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.checker import Verdict
    from mcexact.cli.deadline import Deadline
    from mcexact.errors import LimitReached


@dataclass(frozen=True)
class Rechecked:
    """The checker's verdicts on the certificates of one run.

    Attributes
    ----------
    verdicts : mapping from names of certificates to Verdict
        The verdicts of the certificates that are VALID.
    open : tuple of str
        The names of the other certificates.
    missing : LimitReached or None
        The reason if not all are VALID: a limit on time or memory, or a limit of the checker.
    """

    verdicts: Mapping[str, Verdict]
    open: tuple[str, ...]
    missing: LimitReached | None

    def view(self) -> dict[str, Any]:
        """Return the number of VALID certificates and the names of the others, as plain data."""
        return {"valid": len(self.verdicts), "open": list(self.open)}

    def line(self) -> str:
        """Return a line of text that gives the number of VALID certificates."""
        from mcexact.answer.formats import count

        if not self.verdicts:
            return "no certificate, as nothing was decided exactly\n"
        number = count(len(self.verdicts), "certificate")
        return f"{number} re-checked by the independent checker: VALID\n"

    def require_complete(self) -> None:
        """Raise an error if a certificate was not re-checked.

        Raises
        ------
        LimitReached
        """
        if self.missing is not None:
            raise self.missing


def rechecked(
    files: Mapping[str, str],
    plant: str | Mapping[str, str],
    *,
    doing: str,
    deadline: Deadline,
    max_memory: int | None,
) -> Rechecked:
    """Let the independent checker verify certificates and sentences, within limits.

    Parameters
    ----------
    files : mapping from names to texts
        The certificates, and the manifest of the sentences, if there is one.
    plant : str or mapping
        The plant that all certificates must be about, as their object ``system``; or of each its
        own.
    doing : str
        A description of the work, for progress.
    deadline : Deadline
    max_memory : int or None
        The limit on memory in MiB.

    Raises
    ------
    InternalError
        If the checker rejects a certificate, or a sentence that the certificates do not imply.
    """
    from mcexact.answer.check import recheck
    from mcexact.answer.sentence import MANIFEST
    from mcexact.cli.supervision import supervised
    from mcexact.errors import LimitReached

    try:
        found = supervised(
            recheck,
            dict(files),
            plant,
            doing=doing,
            timeout=deadline,
            max_memory=max_memory,
        )
    except LimitReached as reached:
        told = reached.message.replace("nothing has been decided", "the answers are not re-checked")
        names = tuple(name for name in files if name != MANIFEST)
        return Rechecked({}, names, LimitReached(told))
    valid = {name: said for name, said in found.items() if said.verdict == "VALID"}
    reasons = [f"{name} ({found[name].message})" for name in found if name not in valid]
    missing = None
    if reasons:
        missing = LimitReached(f"not re-checked, a limit of the checker: {', '.join(reasons)}")
    return Rechecked(valid, tuple(name for name in found if name not in valid), missing)
