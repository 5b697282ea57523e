"""Verification of every answer's certificate by the independent checker."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.checker import Verdict
    from mcexact.cli.deadline import Deadline
    from mcexact.cli.supervision import Reporting
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
        from mcexact.answer.templates import count

        if not self.verdicts:
            return "no certificate, as nothing was decided exactly\n"
        number = count(len(self.verdicts), "certificate")
        rest = f"not re-checked: {', '.join(self.open)}\n" if self.open else ""
        return f"{number} re-checked by the independent checker: VALID\n{rest}"

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
    from mcexact.answer.sentence import MANIFEST
    from mcexact.cli.supervision import Kept, supervised
    from mcexact.errors import LimitReached

    names, kept, missing = [name for name in files if name != MANIFEST], Kept(), None
    try:
        found = supervised(
            _recheck,
            dict(files),
            plant,
            len(names),
            doing=doing,
            timeout=deadline,
            max_memory=max_memory,
            kept=kept,
        )
    except LimitReached as reached:
        found = {name: said for name, said in kept.parts.items() if name != MANIFEST}
        valid = {name: said for name, said in found.items() if said.verdict == "VALID"}
        what = f"{len(valid)} of {len(names)} certificates" if valid else "the answers"
        what += " are re-checked, and the sentences are not" if valid else " are not re-checked"
        missing = LimitReached(reached.message.replace("nothing has been decided", what))
        return Rechecked(valid, tuple(name for name in names if name not in valid), missing)
    valid = {name: said for name, said in found.items() if said.verdict == "VALID"}
    reasons = [f"{name} ({found[name].message})" for name in found if name not in valid]
    if reasons:
        missing = LimitReached(f"not re-checked, a limit of the checker: {', '.join(reasons)}")
    return Rechecked(valid, tuple(name for name in found if name not in valid), missing)


def _recheck(
    files: Mapping[str, str],
    plant: str | Mapping[str, str],
    number: int,
    *,
    report: Reporting,
) -> dict[str, Verdict]:
    """Verify files, and hand over each verdict, in the child process."""
    from mcexact.answer.check import recheck

    done: list[str] = []

    def keep(name: str, verdict: Verdict) -> None:
        done.append(name)
        report.keep(name, verdict)
        report.step(f"{len(done)} of {number} certificates")

    report.step(f"0 of {number} certificates")
    return recheck(files, plant, keep)
