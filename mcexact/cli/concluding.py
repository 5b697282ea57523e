"""The last steps of every answer: show it, let the checker decide on it, and write the files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcexact.cli.rechecking import Rechecked, rechecked

if TYPE_CHECKING:
    from mcexact.answer.account import Account
    from mcexact.cli.deadline import Deadline


def told(account: Account) -> dict[str, Any]:
    """What a child process hands back of an account."""
    from mcexact.model.system_file import digest

    return {
        "certificates": account.certificates,
        "files": account.files(),
        "digest": digest(account.given.system.plant),
    }


def concluded(
    answer: Mapping[str, Any],
    show: Callable[[], bool],
    *,
    doing: str,
    certificates: Path | None,
    as_json: bool,
    deadline: Deadline,
    max_memory: int | None,
    write: Callable[[Rechecked], None] | None = None,
) -> Rechecked:
    """Show an answer, let the independent checker decide on its certificates, write the files.

    Parameters
    ----------
    answer : mapping
        ``certificates`` and all ``files`` by names, the ``digest`` of the plant, ``json``.
    show : callable
        Prints the answer for people; whether a line about the checker may follow.
    doing : str
        For progress.
    certificates : Path or None
        The folder where certificates and files go.
    as_json : bool
        Print JSON instead, when all is done.
    deadline : Deadline
    max_memory : int or None
        MiB.
    write : callable, optional
        Writes what else there is to be written.

    Raises
    ------
    InternalError
        If a certificate is not accepted, or does not imply a sentence; then nothing is written.
    """
    from mcexact.cli.files import directory
    from mcexact.cli.output import emit, emit_json
    from mcexact.model.atomic import write_text

    line_follows = not as_json and show()
    checked = rechecked(
        answer.get("files", answer["certificates"]),
        answer["digest"],
        doing=doing,
        deadline=deadline,
        max_memory=max_memory,
    )
    if certificates is not None and answer["certificates"]:
        folder = directory(certificates)
        for name, text in answer["files"].items():
            write_text(folder / name, text)
    if write is not None:
        write(checked)
    if as_json:
        emit_json({**answer["json"], "re_checked": checked.view()})
    elif line_follows and checked.missing is None:
        emit("\n" + checked.line())
    return checked
