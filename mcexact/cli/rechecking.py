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
    open : tuple of str
        The names of the others.
    missing : LimitReached or None
        Why not all are: a limit on time or memory, or one of the checker's own.
    """

    verdicts: Mapping[str, Verdict]
    open: tuple[str, ...]
    missing: LimitReached | None

    def view(self) -> dict[str, Any]:
        """For programs: how many were found VALID, and which were not re-checked."""
        return {"valid": len(self.verdicts), "open": list(self.open)}

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
    from mcexact.answer.check import recheck
    from mcexact.cli.supervision import supervised
    from mcexact.errors import LimitReached

    try:
        found = supervised(
            recheck,
            dict(certificates),
            system_digest,
            doing=doing,
            timeout=deadline,
            max_memory=max_memory,
        )
    except LimitReached as reached:
        told = reached.message.replace("nothing has been decided", "the answers are not re-checked")
        return Rechecked({}, tuple(certificates), LimitReached(told))
    valid = {name: said for name, said in found.items() if said.verdict == "VALID"}
    reasons = [f"{name} ({found[name].message})" for name in found if name not in valid]
    missing = None
    if reasons:
        missing = LimitReached(f"not re-checked, a limit of the checker: {', '.join(reasons)}")
    return Rechecked(valid, tuple(name for name in found if name not in valid), missing)
