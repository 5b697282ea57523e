"""Every answer's certificate goes through the independent checker, whether it is kept or not."""

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
    """What the checker said of the certificates of one run.

    Attributes
    ----------
    verdicts : mapping from names of certificates to Verdict
        Those that are VALID.
    missing : LimitReached or None
        Why not all are: a limit on time or memory, or one of the checker's own.
    """

    verdicts: Mapping[str, Verdict]
    missing: LimitReached | None

    def view(self) -> dict[str, Any]:
        """For programs: whether all were re-checked, and how many were found VALID."""
        return {"complete": self.missing is None, "valid": len(self.verdicts)}

    def line(self) -> str:
        """For people."""
        from mcexact.answer.formats import count

        number = count(len(self.verdicts), "certificate")
        return f"{number} re-checked by the independent checker: VALID\n"

    def require_complete(self) -> None:
        """End with status 4 where something was not re-checked.

        Raises
        ------
        LimitReached
        """
        if self.missing is not None:
            raise self.missing


def rechecked(
    certificates: Mapping[str, str],
    system_digest: str,
    *,
    doing: str,
    deadline: Deadline,
    max_memory: int | None,
) -> Rechecked:
    """Let the independent checker decide on certificates, within what is left of the limits.

    Parameters
    ----------
    certificates : mapping from names to texts
    system_digest : str
        Of the plant that all of them must be about.
    doing : str
        For progress: what is being done.
    deadline : Deadline
    max_memory : int or None
        MiB.

    Raises
    ------
    InternalError
        If one is not accepted.
    """
    from mcexact.cli.supervision import supervised
    from mcexact.errors import LimitReached
    from mcexact.report.verdict import recheck

    try:
        found = supervised(
            recheck,
            dict(certificates),
            system_digest,
            doing=doing,
            timeout=deadline,
            max_memory=max_memory,
        )
    except LimitReached:
        limits = "--timeout or --max-memory allow more"
        return Rechecked({}, LimitReached(f"the answers were not re-checked: {limits}"))
    valid = {name: said for name, said in found.items() if said.verdict == "VALID"}
    open_ones = [f"{name} ({found[name].message})" for name in found if name not in valid]
    missing = None
    if open_ones:
        missing = LimitReached(f"not re-checked, a limit of the checker: {', '.join(open_ones)}")
    return Rechecked(valid, missing)
