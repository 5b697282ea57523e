"""`analyze` answers all questions about one system, each decided once and when it is first used."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, NoReturn, overload

from mcexact.analysis.parametric_analysis import parametric_analysis
from mcexact.analysis.questions import QUESTIONS, Question
from mcexact.answer.account import Account, ShownByAccount
from mcexact.answer.parametric_analysis import ParametricAnalysis
from mcexact.answer.protocol import Answer
from mcexact.answer.rules import ANALYSIS, with_own
from mcexact.answer.sentence import Given, Sentences
from mcexact.arguments import one_of, several, told
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.rational import written
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.graphs import structure


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


class Analysis(ShownByAccount):
    """The answers about one system, by attribute or item, each decided when it is first used.

    Parameters
    ----------
    plant : MultiChannelSystem
    questions : iterable of str, optional
    information : {"own", "outputs"}
    subset : sequence of str, optional
    channel : str, optional
        As `analyze` takes them.

    Attributes
    ----------
    plant : MultiChannelSystem
    information : str
    """

    def __init__(
        self,
        plant: MultiChannelSystem,
        questions: Iterable[str] | None = None,
        *,
        information: str = "own",
        subset: Sequence[str] | None = None,
        channel: str | None = None,
    ) -> None:
        InputError.require(plant, MultiChannelSystem, "system")
        self.plant = plant
        self.information = information
        self._arguments: dict[str, Any] = {
            "neighbors": plant.neighbors,
            "uncertainty": plant.plant.uncertainty,
            "subset": subset,
            "channel": channel,
            "channels": None if channel is None else [channel],
        }
        self._found: dict[str, Any] = {}
        self._seconds: dict[str, float] = {}
        named = () if subset is None else several(subset, "subset")
        plant.indices([*named, *([] if channel is None else [channel])])
        one_of(information, ("own", "outputs"), "information")
        if information == "outputs":
            self._require(
                "neighbors", "the information 'outputs' is about messages between neighbors"
            )
        if questions is not None:
            self.left_out = {}
        listed = self.unbidden if questions is None else several(questions, "questions")
        for name in listed:
            self._require_known(name)
        self._asked = set(listed)

    @property
    def asked(self) -> tuple[str, ...]:
        """The questions asked so far and those they depend on, in the order of the table."""
        return tuple(name for name in QUESTIONS if name in self._asked)

    @cached_property
    def unbidden(self) -> tuple[str, ...]:
        """The questions that are asked by default."""
        return tuple(name for name in self._applicable() if name not in self.left_out)

    @cached_property
    def left_out(self) -> dict[str, str]:
        """The questions that are left out because they would take very long, and why."""
        system = self.system
        ports = {
            "inputs": sum(map(system.p, range(system.m))),
            "outputs": sum(map(system.q, range(system.m))),
        }
        found = {
            name: QUESTIONS[name].reason_to_leave_out(system.n, ports)
            for name in self._applicable()
        }
        return {name: reason for name, reason in found.items() if reason}

    def _applicable(self) -> Iterator[str]:
        subset = self._arguments["subset"]
        for name, question in QUESTIONS.items():
            there = not question.needs or self._arguments[question.needs] is not None
            if name == "complementary_subsystem" and there:
                there = 0 < len(set(subset)) < self.plant.m
            if question.unbidden and there:
                yield name

    def _require_known(self, name: str) -> None:
        if not isinstance(name, str) or name not in QUESTIONS:
            raise UsageError(f"there is no question {told(name)}; expected {', '.join(QUESTIONS)}")
        self._require(QUESTIONS[name].needs, f"the question {name!r} is about {{}}")

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
                + ", and every entry of this system is certain: add 'uncertainty' to the file"
            )
        argument = needed.removesuffix("s")
        meant = {"subset": "a set of channels", "channel": "one channel"}[argument]
        raise UsageError(f"{asked.format(meant)}: give {argument}=")

    @cached_property
    def system(self) -> MultiChannelSystem:
        """Return the plant, or the plant with the outputs that the agents receive."""
        if self.information == "own":
            return self.plant
        from mcexact.derived.augmented_outputs import augmented_outputs

        return augmented_outputs(self.plant)

    @cached_property
    def lifted(self) -> MultiChannelSystem:
        """Return the plant with sub-states, as many as the bound, shared over links with delays."""
        from mcexact.derived.delayed import lifted_system

        return lifted_system(self.plant, self._shared("outputs_states"))

    @cached_property
    def held(self) -> MultiChannelSystem:
        """Return the plant with sub-states that are shared alone, and held for the delays."""
        from mcexact.derived.delayed import held_system

        return held_system(self.plant, self._shared("states"))

    def _shared(self, stem: str) -> tuple[int, ...]:
        return (self[f"shared_dimension_bound_{stem}"].deficiency,) * self.plant.m

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
        if name.startswith("_") or name not in QUESTIONS:
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self
            )
        return self[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *QUESTIONS})

    def _answer(self, name: str) -> Any:
        """Return the answer, or the limit that prevented it."""
        if name not in self._found:
            question, began = QUESTIONS[name], time.perf_counter()
            try:
                arguments, reused = self._given(question)
                began = time.perf_counter()
                self._found[name] = question.decide(*arguments, **reused)
            except LimitReached as reached:
                self._found[name] = reached
            self._seconds[name] = time.perf_counter() - began
        self._asked.add(name)
        return self._found[name]

    def _given(self, question: Question) -> tuple[list[Any], dict[str, Any]]:
        """Return what a question is asked about, and the answers to others that it uses."""
        arguments = [getattr(self, question.about)]
        if question.needs not in {"", "neighbors", "uncertainty"}:
            arguments.append(self._arguments[question.needs])
        reused = {key: self[other] for key, other in question.reuses.items()}
        for key, other in question.shares.items():
            if other in self._asked and not isinstance(self._answer(other), LimitReached):
                reused[key] = self._answer(other)
        return arguments, reused

    def know(self, name: str, answer: Answer) -> None:
        """Use an answer that was found elsewhere, about the same system, for a question.

        Raises
        ------
        UsageError
            If there is no such question, or the system lacks something that it needs.
        """
        self._require_known(name)
        self._found[name], self._seconds[name] = answer, 0.0
        self._asked.add(name)

    def decided(self) -> dict[str, Any]:
        """Return the answers to all questions asked, with several answers to one numbered."""
        answers: dict[str, Any] = {}
        for name, found in self._outcomes().items():
            if isinstance(found, tuple):
                answers |= {f"{name}_{k}": each for k, each in enumerate(found, start=1)}
            elif not isinstance(found, LimitReached):
                answers[name] = found
        return answers

    def open(self) -> dict[str, LimitReached]:
        """Return the questions that a limit on work left undecided."""
        return {
            name: found
            for name, found in self._outcomes().items()
            if isinstance(found, LimitReached)
        }

    @property
    def account(self) -> Account:
        """Decide all questions asked, and return the answers with their sentences."""
        answers = self.decided()
        open_ = {*self.left_out, *self.open()} - answers.keys()
        given = Given(self.system, {"information": self.information})
        said = with_own(ANALYSIS, answers).sentences(answers, given, open_)
        return Account(answers, given, said, self.plant.subject)

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

    def to_dict(self) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by the name of its question."""
        open_ = {}
        for name, reached in self.open().items():
            bounds = {"lower": _written(reached.lower), "upper": _written(reached.upper)}
            open_[name] = {"decided": False, "computed_not_certified": bounds}
        told = [each.view() for each in self.effort()]
        return self.account.as_json(information=self.information, questions=told, **open_)

    def to_rows(self) -> list[dict[str, Any]]:
        """Decide all questions asked, and return a flat row for each answer."""
        return [{"question": name, **each.to_row()} for name, each in self.decided().items()]

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

    def plot(self, ax: Any = None) -> Any:
        """Draw the neighbor graph and the transfer graph, with what makes a mode fixed in orange.

        Parameters
        ----------
        ax : axes of matplotlib, optional
            One for each graph.

        Returns
        -------
        matplotlib.figure.Figure
        """
        return structure(self.system, self["fixed_spectrum"], self["transfer_graph"], ax)

    def __repr__(self) -> str:
        plant = self.plant
        open_ = sum(name not in self._found for name in self._asked)
        return (
            f"Analysis(n={plant.n}, m={plant.m}, {plant.time} time: "
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


def _written(bound: Fraction | None) -> Any:
    return None if bound is None else written(bound)


@overload
def analyze(
    plant: MultiChannelSystem,
    questions: Iterable[str] | None = None,
    *,
    also: Iterable[str] = (),
    information: str = "own",
    subset: Sequence[str] | None = None,
    channel: str | None = None,
) -> Analysis: ...


@overload
def analyze(plant: ParametricSystem) -> ParametricAnalysis: ...


def analyze(
    plant: MultiChannelSystem | ParametricSystem,
    questions: Iterable[str] | None = None,
    *,
    also: Iterable[str] = (),
    information: str = "own",
    subset: Sequence[str] | None = None,
    channel: str | None = None,
) -> Analysis | ParametricAnalysis:
    """Answer questions about a system, by default all that apply and are cheap.

    Parameters
    ----------
    plant : MultiChannelSystem or ParametricSystem
        With parameters the fixed modes, joint controllability and joint observability are decided
        for all values, and other questions are asked about ``plant.at({…})``.
    questions : iterable of str, optional
        Names of questions, which `dir` of the result lists; an NP-hard question is asked only by
        name.
    also : iterable of str
        Further questions.
    information : {"own", "outputs"}
        The signals that agent i feeds back: y_i, or the y_j of all j ∈ N_i.
    subset : sequence of str, optional
        Names of channels, whose pencil at every mode and complementary subsystem are asked about as
        well.
    channel : str, optional
        The name of a channel, whose controllability and observability are asked about as well.

    Returns
    -------
    Analysis or ParametricAnalysis
        The answers, each of which is decided when it is first used, or with parameters at once.

    Raises
    ------
    UsageError
        If a name is not a question, or the system lacks something that a question needs.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> found = analyze(gallery.load("liu2020-3ch-no-communication"))
    >>> found.fixed_spectrum.empty, found.completeness.complete
    (False, False)
    >>> sorted(found.minimal_communication.added)
    [('1', '2')]
    """
    if isinstance(plant, ParametricSystem):
        if questions is not None or [*also] or subset is not None or channel is not None or (
            information != "own"
        ):  # fmt: skip
            raise UsageError(
                "these questions are about systems without parameters: give values with .at({…})"
            )
        return parametric_analysis(plant)
    made = Analysis(plant, questions, information=information, subset=subset, channel=channel)
    named = {*several(also, "also")}
    for name in sorted(named):
        made._require_known(name)
    made._asked |= named
    return made
