"""Questions asked of one system: each is decided once, when it is first used, within its limits."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any, NoReturn

from mcexact.analysis.questions import QUESTIONS, Question
from mcexact.answer.account import ShownByAccount
from mcexact.answer.sentence import Sentences
from mcexact.errors import (
    InternalError,
    LimitReached,
    McexactError,
    UsageError,
    require_seconds,
    several,
    telling,
    told,
)
from mcexact.processes import Child


@dataclass(frozen=True)
class Effort:
    """What became of a question: seconds that passed, and why it is open or left out."""

    question: str
    outcome: str
    seconds: float
    reason: str = ""

    def view(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "question": self.question,
            "outcome": self.outcome,
            "seconds": round(self.seconds, 3),
            **({"reason": self.reason} if self.reason else {}),
        }


Begin = Callable[[str, str], None]
Keep = Callable[[str, Any, float], None]


def _decide_in_child(connection: Any, asking: Asking) -> None:
    """Decide questions as they are named, and send each outcome at once."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's
    asking.watch(
        lambda name, step: connection.send(("begin", name, step)),
        lambda name, found, seconds: connection.send(("keep", name, found, seconds)),
    )
    with contextlib.suppress(EOFError, OSError):
        while True:
            try:
                asking.without_limit(connection.recv())
            except McexactError as error:
                connection.send(("error", error))
            connection.send(("end",))


class Asking(ShownByAccount):
    """The answers about one system, by attribute or item, each decided when it is first used.

    Attributes
    ----------
    plant : MultiChannelSystem or ParametricSystem
    """

    plant: Any
    information = "own"
    questions: Mapping[str, Question] = QUESTIONS
    """The questions that can be asked of such a plant."""
    _certain = "every entry of this system is certain: add 'uncertainty' to the file"
    """What an error says where nothing is uncertain."""
    _arguments: dict[str, Any]
    """What questions need besides the plant; None where it is not given."""

    def _ask(
        self,
        questions: Iterable[str] | None,
        timeout: float | None = None,
        progress: Callable[[str], None] | None = None,
    ) -> None:
        """Note which questions are asked, by default those that apply and are cheap."""
        if timeout is not None:
            require_seconds(timeout, "timeout")
        tell = telling(progress)
        self._timeout, self._left = timeout, timeout
        self._child: Child | None = None
        self._ended: set[str] = set()
        self.watch(lambda _, step: tell(step), lambda *_: None)
        self._found: dict[str, Any] = {}
        self._seconds: dict[str, float] = {}
        if questions is not None:
            self.left_out = {}
        listed = self.unbidden if questions is None else several(questions, "questions")
        for name in listed:
            self._require_known(name)
        self._asked = set(listed)

    def watch(self, begin: Begin, keep: Keep) -> None:
        """Call functions as questions are decided.

        Parameters
        ----------
        begin : callable
            It takes the name of a question that is decided next, and a line about the progress.
        keep : callable
            It takes the name of a question that is decided, the answer or the limit that prevented
            it, and the seconds that it took.
        """
        self._begin, self._keep = begin, keep

    def know(self, name: str, answer: Any, seconds: float = 0.0) -> None:
        """Use an answer that was found elsewhere, about the same system, for a question.

        Parameters
        ----------
        name : str
        answer : Answer or LimitReached
            The limit that prevented an answer leaves the question open.
        seconds : float
            What it took.

        Raises
        ------
        UsageError
            If there is no such question, or the system lacks something that it needs.
        """
        self._require_known(name)
        self._found[name], self._seconds[name] = answer, seconds
        self._asked.add(name)

    def leave_open(self, reason: str, names: Iterable[str] | None = None) -> None:
        """Decide these questions no more, by default none of those that are not decided yet.

        Parameters
        ----------
        reason : str
            The limit on time or memory, or the interrupt, that ended the work on them.
        names : iterable of str, optional
        """
        if names is None:
            names = self._asked - self._found.keys()
            self._timeout = self._left = 0.0
        for name in names:
            self.know(name, LimitReached(reason))
            self._ended.add(name)

    def also(self, names: Iterable[str]) -> None:
        """Ask further questions.

        Raises
        ------
        UsageError
            If there is no such question, or the system lacks something that it needs.
        """
        named = {*several(names, "also")}
        for name in sorted(named):
            self._require_known(name)
        self._asked |= named

    @property
    def asked(self) -> tuple[str, ...]:
        """The questions asked so far and those they depend on, in the order of the table."""
        return tuple(name for name in self.questions if name in self._asked)

    @cached_property
    def unbidden(self) -> tuple[str, ...]:
        """The questions that are asked by default."""
        return tuple(name for name in self._applicable() if name not in self.left_out)

    @cached_property
    def left_out(self) -> dict[str, str]:
        """The questions that are left out because they would take very long, and why."""
        found = {name: self._too_long(self.questions[name]) for name in self._applicable()}
        return {name: reason for name, reason in found.items() if reason}

    def _too_long(self, question: Question) -> str:
        """Why a question is not asked by default of this system; empty if it is."""
        raise NotImplementedError

    def _applicable(self) -> Iterator[str]:
        for name, question in self.questions.items():
            there = not question.needs or self._arguments[question.needs] is not None
            if question.unbidden and there and self._applies(name):
                yield name

    def _applies(self, name: str) -> bool:
        return True

    def _require_known(self, name: str) -> None:
        if not isinstance(name, str) or name not in self.questions:
            raise UsageError(
                f"there is no question {told(name)}; expected {', '.join(self.questions)}"
            )
        self._require(self.questions[name].needs, f"the question {name!r} is about {{}}")

    def _require(self, needed: str, asked: str) -> None:
        """Raise an error if a question lacks the graph, channels or channel that it needs."""
        if not needed or self._arguments[needed] is not None:
            return
        if needed == "neighbors":
            raise UsageError(
                asked.format("messages between neighbors")
                + ", and this system names no neighbors: add 'neighbors' to the file"
            )
        if needed == "uncertainty":
            raise UsageError(
                asked.format("every plant within the radii of its entries")
                + f", and {self._certain}"
            )
        argument = needed.removesuffix("s")
        meant = {"subset": "a set of channels", "channel": "one channel"}[argument]
        raise UsageError(f"{asked.format(meant)}: give {argument}=")

    def __getitem__(self, name: str) -> Any:
        """Return the answer to a question, which is decided if it is not known yet.

        Raises
        ------
        UsageError
            If there is no such question, or the system lacks something that it needs.
        LimitReached
            If a limit on work prevented the decision.
        """
        self._require_known(name)
        found = self._answer(name)
        if isinstance(found, LimitReached):
            raise found
        return found

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self.questions:
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self
            )
        return self[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.questions})

    def _answer(self, name: str) -> Any:
        """Return the answer, or the limit that prevented it.

        A question that cannot be decided of this system was not asked: the others have answers.
        """
        asked_before = name in self._asked
        self._asked.add(name)
        if name not in self._found:
            try:
                if self._left is None:
                    self._decide_here(name)
                else:
                    self._decide_in_time([name])
            except McexactError:
                if not asked_before:
                    self._asked.discard(name)
                raise
        return self._found[name]

    def _decide_here(self, name: str) -> None:
        began = time.perf_counter()
        try:
            arguments, reused = self._given(name)
            began = time.perf_counter()
            self._begin(name, self._progress(name))
            found = self._decide(name, arguments, reused)
        except LimitReached as reached:
            found = reached
        self._found[name], self._seconds[name] = found, time.perf_counter() - began
        self._keep(name, found, self._seconds[name])

    def without_limit(self, names: Iterable[str]) -> None:
        """Decide questions here, however long it takes."""
        self._left = None
        for name in names:
            self._answer(name)

    def _progress(self, name: str) -> str:
        """A line that says how many questions are decided, and which is next."""
        done, asked = len(self._found), len(self._asked | self._found.keys())
        return f"{done} of {asked} questions decided, now the {name.replace('_', ' ')}"

    def _decide_in_time(self, names: list[str]) -> None:
        """Decide questions in a child process, which is ended when the time is over.

        What it has decided by then is known, and what it had not is open.
        """
        began, left = time.monotonic(), self._left or 0.0
        if left > 0:
            try:
                if self._child is None:
                    self._child = Child(_decide_in_child, (self,))
                self._child.connection.send(names)
                self._listen(self._child, began + left)
            except BaseException:
                self._end_child()
                raise
        self._left = max(0.0, left - (time.monotonic() - began))
        if undecided := [name for name in names if name not in self._found]:
            self._left = 0.0
            self._end_child()
            self.leave_open(f"the time limit of {self._timeout:g} s was reached", undecided)

    def _end_child(self) -> None:
        child, self._child = self._child, None
        if child is not None:
            child.end()

    def _listen(self, child: Child, end: float) -> None:
        """Take what a child has decided, until it has all or the time is over."""
        try:
            while child.connection.poll(max(0.0, end - time.monotonic())):
                said, *rest = child.connection.recv()
                if said == "begin":
                    self._begin(*rest)
                elif said == "keep":
                    self.know(*rest)
                    self._keep(*rest)
                elif said == "error":
                    raise rest[0]
                else:
                    return
        except (EOFError, OSError):
            status = child.exit_status()
            if status == -getattr(signal, "SIGKILL", 9):
                raise LimitReached("the memory was exhausted while deciding") from None
            raise InternalError(f"the computation ended with status {status}") from None

    def __getstate__(self) -> dict[str, Any]:
        """Return what another process decides with: no functions of the caller."""
        left = ("_begin", "_keep", "_child")
        return {key: each for key, each in vars(self).items() if key not in left}

    def _given(self, name: str) -> tuple[list[Any], dict[str, Any]]:
        """Return what a question is asked about, and the answers to others that it uses."""
        raise NotImplementedError

    def _decide(self, name: str, arguments: list[Any], reused: dict[str, Any]) -> Any:
        return self.questions[name].decide(*arguments, **reused)

    def open(self) -> dict[str, LimitReached]:
        """Return the questions that a limit on work left undecided."""
        return {
            name: found
            for name, found in self._outcomes().items()
            if isinstance(found, LimitReached)
        }

    def ended(self) -> dict[str, list[str]]:
        """Return the questions on which the work was ended, by the reason of that."""
        found: dict[str, list[str]] = {}
        for name in self.asked:
            if name in self._ended:
                found.setdefault(self._found[name].message, []).append(name)
        return found

    def explain(self) -> str:
        """Say in plain words what was found, and what a limit left undecided, one a line."""
        return "\n".join([super().explain(), *self._undecided()])

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what the account is shown as, and what a limit left undecided."""
        yield from super()._labeled()
        yield from (("", line) for line in self._undecided())

    def _html(self) -> str:
        return super()._html() + "".join(f"<p>{escape(line)}</p>" for line in self._undecided())

    def _undecided(self) -> list[str]:
        return [
            f"not decided, as {reason}: {', '.join(name.replace('_', ' ') for name in names)}"
            for reason, names in self.ended().items()
        ]

    @property
    def sentences(self) -> Sentences:
        """The sentences that follow from the answers, each with its premises."""
        return self.account.sentences

    def manifest(self) -> dict[str, Any]:
        """Return the sentences with their premises, and the digests of the certificates."""
        return self.account.manifest()

    def save(self, folder: str | os.PathLike[str], *, system_by_digest: bool = False) -> None:
        """Write the certificates and a manifest of the sentences, which the checker can verify.

        Parameters
        ----------
        folder : path
            The folder, which is made if it is missing.
        system_by_digest : bool
            Whether certificates name the plant by its digest alone, as in `save_certificate`.
        """
        self.account.save(folder, system_by_digest=system_by_digest)

    def effort(self) -> tuple[Effort, ...]:
        """Decide all questions asked, and return how long each took, or why it was left out."""
        open_ = self.open()
        asked = [
            Effort(name, "open" if name in open_ else "decided", self._seconds[name], reason)
            for name in self.asked
            for reason in [open_[name].message if name in open_ else ""]
        ]
        left = [
            Effort(name, "left out", 0.0, reason)
            for name, reason in self.left_out.items()
            if name not in self._asked
        ]
        return (*asked, *left)

    def __repr__(self) -> str:
        plant = self.plant
        open_ = sum(name not in self._found for name in self._asked)
        return (
            f"{type(self).__name__}(n={plant.n}, m={plant.m}, {plant.time} time: "
            f"{len(self._found)} questions decided, {open_} asked and not yet)"
        )

    def __bool__(self) -> NoReturn:
        raise TypeError(
            "an analysis is neither true nor false: ask for one of its answers, such as "
            ".fixed_spectrum.empty or .completeness.complete"
        )

    def _outcomes(self) -> dict[str, Any]:
        """Return the names of all questions asked or needed, in the order of the table."""
        # The evidence of questions with ports is long: a limit shall not discard others for it.
        names = sorted(self.asked, key=lambda name: bool(self.questions[name].ports))
        if self._left is not None and (rest := [n for n in names if n not in self._found]):
            self._decide_in_time(rest)
            self._end_child()
        for name in names:
            self._answer(name)
        return {name: self._found[name] for name in self.asked}
