"""One run of a command: its limits, its inputs, and the common end of all commands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.deadline import Deadline
from mcexact.cli.rechecking import Rechecked, rechecked

if TYPE_CHECKING:
    from mcexact.answer.account import Account

LIMITS = ("bytes", "depth", "digits", "exponent")


def told(account: Account, system_by_digest: bool) -> dict[str, Any]:
    """Return the parts of an account that a child process sends back.

    Parameters
    ----------
    account : Account
    system_by_digest : bool
        Whether the files name the plant by its digest.
    """
    from mcexact.answer import codec
    from mcexact.model.system_file import canonical_text

    files, own = account.files(system_by_digest=system_by_digest), account.given.system
    refuted = {f"{name}_refuted.json": answer for name, answer in account.failing.items()}
    others = {name: codec.encode(answer) for name, answer in refuted.items()}
    plants = {name: canonical_text(answer.about.plant) for name, answer in refuted.items()}
    return {
        "certificates": account.certificates | others,
        "files": files | others,
        "plant": dict.fromkeys(files, canonical_text(own)) | plants,
    }


class Run:
    """The common options of commands, removed from the options given to a command.

    Parameters
    ----------
    given : dict
        The values of `options.work_limits` and, if the command has them, of `options.file_limits`,
        `options.certificates` and `options.as_json`, which are removed.
    """

    def __init__(self, given: dict[str, Any]) -> None:
        self.deadline = Deadline(given.pop("timeout"))
        self.max_memory: int | None = given.pop("max_memory")
        self.limits = options.given({name: given.pop(name, None) for name in LIMITS})
        self.certificates = given.pop("certificates", None)
        self.system_by_digest = given.pop("system_by_digest", False)
        if self.system_by_digest and self.certificates is None:
            raise click.UsageError("--system-by-digest is about files: give --certificates, too")
        self.as_json = given.pop("as_json", False)

    def read(self, file: str) -> tuple[str, bytes]:
        """Return the name by which messages refer to a file, and its bytes."""
        from mcexact.cli.files import place_of, read

        return place_of(file), read(file, self.limits, self.deadline)

    def result(
        self, work: Callable[..., Any], *arguments: Any, doing: str, telling: bool = False
    ) -> Any:
        """Call a function in a child process, within the limits."""
        from mcexact.cli.supervision import supervised

        return supervised(
            work,
            *arguments,
            doing=doing,
            timeout=self.deadline,
            max_memory=self.max_memory,
            telling=telling,
        )

    def conclude(
        self,
        answer: Mapping[str, Any],
        show: Callable[[], bool],
        *,
        about: str,
        write: Callable[[Rechecked], None] = lambda _: None,
    ) -> Rechecked:
        """Show an answer, have its certificates and sentences verified, and write the files.

        Parameters
        ----------
        answer : mapping
            The parts that `told` returns, and ``json``.
        show : callable
            A function that prints the answer and returns whether a line about the checker may
            follow.
        about : str
            A description of the answer, for progress.
        write : callable, optional
            A function that writes the other files.

        Raises
        ------
        InternalError
            If the checker rejects a certificate or a sentence; no file is written then.
        """
        from mcexact.cli.files import directory
        from mcexact.cli.output import emit, emit_json
        from mcexact.model.atomic import write_text

        line_follows = not self.as_json and show()
        checked = rechecked(
            answer["files"],
            answer["plant"],
            doing=f"re-checking {about}",
            deadline=self.deadline,
            max_memory=self.max_memory,
        )
        if self.certificates is not None:
            folder = directory(self.certificates)
            for name, text in answer["files"].items():
                write_text(folder / name, text)
        write(checked)
        if self.as_json:
            emit_json({**answer["json"], "re_checked": checked.view()})
        elif line_follows and checked.missing is None:
            emit("\n" + checked.line())
        return checked


def show_tables(answer: Mapping[str, Any]) -> Callable[[], bool]:
    """Return a function that prints the tables of an answer; a line about the checker follows."""
    from mcexact.cli.output import emit_tables

    def show() -> bool:
        emit_tables(answer["tables"])
        return True

    return show
