"""One run of a command: its limits, its inputs, and the common end of all commands."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.deadline import Deadline
from mcexact.cli.rechecking import Rechecked, rechecked

if TYPE_CHECKING:
    from mcexact.analysis.analyze import Asking
    from mcexact.answer.account import Account
    from mcexact.cli.supervision import Reporting
    from mcexact.errors import LimitReached

LIMITS = ("bytes", "depth", "digits", "exponent")


def told(account: Account, system_by_digest: bool) -> dict[str, Any]:
    """Return the parts of an account that a child process sends back.

    Parameters
    ----------
    account : Account
    system_by_digest : bool
        Whether the files name the plant by its digest.
    """
    from mcexact.answer import protocol

    files, own = account.files(system_by_digest=system_by_digest), account.given.system
    refuted = {f"{name}_refuted.json": answer for name, answer in account.failing.items()}
    others = {name: protocol.encode(answer) for name, answer in refuted.items()}
    plants = {name: answer.about.plant.canonical_text() for name, answer in refuted.items()}
    return {
        "certificates": account.certificates | others,
        "files": files | others,
        "plant": dict.fromkeys(files, own.canonical_text()) | plants,
    }


@dataclass
class Known:
    """What is known of the parts of an answer when the work on it begins, or begins again.

    Attributes
    ----------
    parts : dict
        What was decided, pickled, by name.
    lost : dict
        Why other parts were not decided: the memory that each needs.
    ended : str
        Why nothing more is to be decided; empty if it is.
    """

    parts: dict[str, bytes] = field(default_factory=dict)
    lost: dict[str, str] = field(default_factory=dict)
    ended: str = ""

    def resume(self, found: Asking, report: Reporting) -> None:
        """Give an analysis what is known, and have it hand over what it decides besides."""
        for name, data in self.parts.items():
            if name in found.questions:
                found.know(name, *pickle.loads(data))
        for name, reason in self.lost.items():
            found.leave_open(reason, [name])
        if self.ended:
            found.leave_open(self.ended)
        found.watch(report.begin, lambda name, *outcome: report.keep(name, pickle.dumps(outcome)))


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

    def result_in_parts(
        self, work: Callable[..., Any], *arguments: Any, doing: str
    ) -> tuple[Any, BaseException | None]:
        """Call a function in a child process, and once more for what a limit did not discard.

        Parameters
        ----------
        work : callable
            A function that takes these arguments, the keyword ``known`` and the keyword ``report``,
            by which it hands over pickled parts as they are decided.
        *arguments
        doing : str
            A description of the work.

        Returns
        -------
        result
        LimitReached or KeyboardInterrupt or None
            What ended the work before everything was decided.

        Raises
        ------
        LimitReached, KeyboardInterrupt
            If nothing was decided by then.
        """
        from mcexact.cli.supervision import Kept, supervised
        from mcexact.errors import LimitReached

        known, kept = Known(), Kept()
        ended: BaseException | None = None
        deadline = self.deadline
        while True:
            kept.running = ""
            try:
                result = supervised(
                    work,
                    *arguments,
                    known,
                    doing="showing what was decided" if known.ended else doing,
                    timeout=deadline,
                    max_memory=self.max_memory,
                    kept=kept,
                )
            except (LimitReached, KeyboardInterrupt) as error:
                known.parts = kept.parts
                if known.ended or not known.parts:
                    raise ended or error from None
                ended, deadline = error, self.deadline.with_grace()
                interrupted = isinstance(error, KeyboardInterrupt)
                if interrupted or self.deadline.left() == 0 or not kept.running:
                    known.ended = _reason(error)
                else:  # other questions may need less memory
                    known.lost[kept.running] = _reason(error)
                    deadline = self.deadline
                continue
            self.deadline = deadline if ended else self.deadline
            return result, ended

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
        from mcexact.cli.files import directory, say_written
        from mcexact.cli.output import emit, emit_json
        from mcexact.model.text import write_text

        line_follows = not self.as_json and show()
        checked = rechecked(
            answer["files"],
            answer["plant"],
            doing=f"re-checking {about}",
            deadline=self.deadline.with_grace(),
            max_memory=self.max_memory,
        )
        if self.certificates is not None:
            folder = directory(self.certificates)
            for name, text in answer["files"].items():
                write_text(folder / name, text)
            say_written(folder, len(answer["files"]))
        write(checked)
        if self.as_json:
            emit_json({**answer["json"], "re_checked": checked.view()})
        elif line_follows and (checked.missing is None or checked.verdicts):
            emit("\n" + checked.line())
        return checked


def undecided_error(
    ended: BaseException | None, open_: Mapping[str, Sequence[str]], doing: str
) -> LimitReached | None:
    """Return the error to raise if something ended the work, which names what is not decided.

    Parameters
    ----------
    ended : LimitReached or KeyboardInterrupt or None
    open_ : mapping
        The parts that were not decided, by the reason of that.
    doing : str
        A description of the work.
    """
    from mcexact.cli.failures import INTERRUPTED
    from mcexact.errors import LimitReached

    if ended is None:
        return None
    said = f"{_reason(ended)} while {doing}, after everything was decided"
    if open_:
        lists = {reason: ", ".join(names).replace("_", " ") for reason, names in open_.items()}
        said = "; ".join(
            f"{reason} while {doing}, not decided: {names}" for reason, names in lists.items()
        )
    if isinstance(ended, KeyboardInterrupt):
        error = LimitReached(said)
        error.exit_status = INTERRUPTED
        return error
    option = "--timeout" if "time limit" in said else "--max-memory"
    return LimitReached(f"{said} ({option} allows more)")


def _reason(error: BaseException) -> str:
    """Why a question was not decided, as a clause."""
    if isinstance(error, KeyboardInterrupt):
        return "the work was interrupted"
    return str(error).partition(" while ")[0]


def show_tables(answer: Mapping[str, Any]) -> Callable[[], bool]:
    """Return a function that prints the tables of an answer; a line about the checker follows."""
    from mcexact.cli.output import emit_tables

    def show() -> bool:
        emit_tables(answer["tables"])
        return True

    return show
