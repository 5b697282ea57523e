"""Questions asked of one system: each is decided once, when it is first used, within its limits."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NoReturn

from mcexact.analysis.questions import QUESTIONS, Question
from mcexact.answer.account import ShownByAccount
from mcexact.answer.sentence import Sentences
from mcexact.arguments import several, told
from mcexact.errors import LimitReached, UsageError


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

    def _ask(self, questions: Iterable[str] | None) -> None:
        """Note which questions are asked, by default those that apply and are cheap."""
        self._found: dict[str, Any] = {}
        self._seconds: dict[str, float] = {}
        if questions is not None:
            self.left_out = {}
        listed = self.unbidden if questions is None else several(questions, "questions")
        for name in listed:
            self._require_known(name)
        self._asked = set(listed)

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
        """Return the answer, or the limit that prevented it."""
        if name not in self._found:
            began = time.perf_counter()
            try:
                arguments, reused = self._given(name)
                began = time.perf_counter()
                self._found[name] = self._decide(name, arguments, reused)
            except LimitReached as reached:
                self._found[name] = reached
            self._seconds[name] = time.perf_counter() - began
        self._asked.add(name)
        return self._found[name]

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
        for name in self.asked:
            self._answer(name)
        return {name: self._found[name] for name in self.asked}
