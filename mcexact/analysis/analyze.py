"""`analyze` answers all questions about one system, each decided once and when it is first used."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, overload

from mcexact.analysis.asking import Asking
from mcexact.analysis.boxes.largest_box import failing_member
from mcexact.analysis.parametric_analysis import ParametricAnalysis
from mcexact.analysis.questions import Question
from mcexact.answer.account import Account
from mcexact.answer.protocol import Answer
from mcexact.answer.rules import ANALYSIS, with_own
from mcexact.answer.sentence import Given
from mcexact.errors import InputError, LimitReached, UsageError, one_of, several
from mcexact.exact.rational import written
from mcexact.model.parametric import ParametricSystem
from mcexact.model.properties import PROPERTIES
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.graphs import structure

_MOST_STATES = 60
"""Plants within the radii that fail are searched for at most so many states: that takes seconds."""


class Analysis(Asking):
    """The answers about one system, by attribute or item, each decided when it is first used.

    Parameters
    ----------
    plant : MultiChannelSystem
    questions : iterable of str, optional
    information : {"own", "outputs"}
    subset : sequence of str, optional
    channel : str, optional
    timeout : float, optional
    progress : callable, optional
        As `analyze` takes them.

    Attributes
    ----------
    plant : MultiChannelSystem
    information : str
    """

    plant: MultiChannelSystem

    def __init__(
        self,
        plant: MultiChannelSystem,
        questions: Iterable[str] | None = None,
        *,
        information: str = "own",
        subset: Sequence[str] | None = None,
        channel: str | None = None,
        timeout: float | None = None,
        progress: Callable[[str], None] | None = None,
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
        named = () if subset is None else several(subset, "subset")
        plant.indices([*named, *([] if channel is None else [channel])])
        one_of(information, ("own", "outputs"), "information")
        if information == "outputs":
            self._require(
                "neighbors", "the information 'outputs' is about messages between neighbors"
            )
        self._refuted: dict[str, Answer | None] = {}
        self._by_default = questions is None
        self._ask(questions, timeout, progress)

    def _too_long(self, question: Question) -> str:
        system = self.system
        ports = {
            "inputs": sum(map(system.p, range(system.m))),
            "outputs": sum(map(system.q, range(system.m))),
        }
        return question.reason_to_leave_out(system.n, ports)

    def _applies(self, name: str) -> bool:
        subset = self._arguments["subset"]
        return name != "complementary_subsystem" or 0 < len(set(subset)) < self.plant.m

    @cached_property
    def system(self) -> MultiChannelSystem:
        """Return the plant, or the plant with the outputs that the agents receive."""
        return self.plant if self.information == "own" else self.linked

    @cached_property
    def linked(self) -> MultiChannelSystem:
        """Return the plant with the outputs that the agents receive."""
        from mcexact.derived.constructions import augmented_outputs

        return augmented_outputs(self.plant)

    @cached_property
    def lifted(self) -> MultiChannelSystem:
        """Return the plant with sub-states, as many as the bound, shared over links with delays."""
        from mcexact.derived.constructions import lifted_system

        return lifted_system(self.plant, self._shared("outputs_states"))

    @cached_property
    def held(self) -> MultiChannelSystem:
        """Return the plant with sub-states that are shared alone, and held for the delays."""
        from mcexact.derived.constructions import held_system

        return held_system(self.plant, self._shared("states"))

    def _shared(self, stem: str) -> tuple[int, ...]:
        return (self[f"shared_dimension_bound_{stem}"].deficiency,) * self.plant.m

    def _given(self, name: str) -> tuple[list[Any], dict[str, Any]]:
        question = self.questions[name]
        arguments = [getattr(self, question.about)]
        if question.needs not in {"", "neighbors", "uncertainty"}:
            arguments.append(self._arguments[question.needs])
        reused = {key: self[other] for key, other in question.reuses.items()}
        for key, other in question.shares.items():
            if other in self._asked and not isinstance(self._answer(other), LimitReached):
                reused[key] = self._answer(other)
        return arguments, reused

    def _outcomes(self) -> dict[str, Any]:
        """The same, with what the links that are there change about modes that are fixed."""
        found, graph = super()._outcomes(), self.plant.neighbors
        spectrum = found.get("fixed_spectrum")
        linked = self.information == "own" and graph is not None and graph.edges()
        if not self._by_default or not linked or "linked_fixed_spectrum" in found:
            return found
        if spectrum is None or isinstance(spectrum, LimitReached) or spectrum.empty:
            return found
        self._asked.add("linked_fixed_spectrum")
        return super()._outcomes()

    def decided(self) -> dict[str, Any]:
        """Return the answers to all questions asked, with several answers to one numbered."""
        answers: dict[str, Any] = {}
        for name, found in self._outcomes().items():
            if isinstance(found, tuple):
                answers |= {f"{name}_{k}": each for k, each in enumerate(found, start=1)}
            elif not isinstance(found, LimitReached):
                answers[name] = found
        return answers

    @property
    def account(self) -> Account:
        """Decide all questions asked, and return the answers with their sentences."""
        answers = self.decided()
        open_ = {*self.left_out, *self.open()} - answers.keys() - self._ended
        given = Given(self.system, {"information": self.information})
        said = with_own(ANALYSIS, answers).sentences(answers, given, open_)
        return Account(answers, given, said, self.plant.subject, sorted(open_), self.failing())

    def failing(self) -> dict[str, Answer]:
        """Return exact answers about plants within the radii that lack what no proof was found for.

        Such a plant is searched for each question of `PROPERTIES` that was asked and is open, if
        the system has at most 60 states.  What is not found proves nothing.
        """
        system, asked = self.system, PROPERTIES.keys() & (self.open().keys() - self._ended)
        if system.subject or system.n > _MOST_STATES or self._left == 0:
            return {}
        for name in asked - self._refuted.keys():
            self._refuted[name] = failing_member(system, PROPERTIES[name])
        found = {name: self._refuted[name] for name in sorted(asked)}
        return {name: answer for name, answer in found.items() if answer is not None}

    def to_dict(self) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by the name of its question."""
        open_ = {}
        for name, reached in self.open().items():
            bounds = {"lower": _written(reached.lower), "upper": _written(reached.upper)}
            open_[name] = {"decided": False, "computed_not_certified": bounds}
        told, account = [each.view() for each in self.effort()], self.account
        failing = {name: each.about.plant.to_dict() for name, each in account.failing.items()}
        known = {"failing_within_radii": failing} if failing else {}
        return account.as_json(information=self.information, questions=told, **known, **open_)

    def to_rows(self) -> list[dict[str, Any]]:
        """Decide all questions asked, and return a flat row for each answer."""
        return [{"question": name, **each.to_row()} for name, each in self.decided().items()]

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
    timeout: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> Analysis: ...


@overload
def analyze(
    plant: ParametricSystem,
    questions: Iterable[str] | None = None,
    *,
    also: Iterable[str] = (),
    channel: str | None = None,
    timeout: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> ParametricAnalysis: ...


def analyze(
    plant: MultiChannelSystem | ParametricSystem,
    questions: Iterable[str] | None = None,
    *,
    also: Iterable[str] = (),
    information: str = "own",
    subset: Sequence[str] | None = None,
    channel: str | None = None,
    timeout: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> Analysis | ParametricAnalysis:
    """Answer questions about a system, by default all that apply and are cheap.

    Parameters
    ----------
    plant : MultiChannelSystem or ParametricSystem
        With parameters the questions are decided for all values, as many of them as can be; the
        others are asked about ``plant.at({…})``.
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
    timeout : float, optional
        Seconds that deciding may take in all.  Then a process of its own decides, which is ended
        when they are over: what it has decided stays, and the other questions are open, with this
        limit as their reason in ``effort()``.
    progress : callable, optional
        It is called with a line of text before each question is decided, such as `print`.

    Returns
    -------
    Analysis or ParametricAnalysis
        The answers, each of which is decided when it is first used.

    Raises
    ------
    UsageError
        If a name is not a question, or the system lacks something that a question needs; if
        ``timeout`` is no number of seconds, or ``progress`` no function.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> found = analyze(gallery.load("liu2020-3ch-no-communication"))
    >>> found.fixed_spectrum.empty, found.completeness.complete
    (False, False)
    >>> sorted(found.minimal_communication.added)
    [('1', '2')]
    >>> found = analyze(found.plant, ["completeness"], progress=print)
    >>> found.completeness.complete
    0 of 2 questions decided, now the fixed spectrum
    1 of 2 questions decided, now the completeness
    False
    """
    made: Analysis | ParametricAnalysis
    if isinstance(plant, ParametricSystem):
        if subset is not None or information != "own":
            raise UsageError(
                "these questions are about systems without parameters: give values with .at({…})"
            )
        made = ParametricAnalysis(
            plant, questions, channel=channel, timeout=timeout, progress=progress
        )
    else:
        made = Analysis(
            plant,
            questions,
            information=information,
            subset=subset,
            channel=channel,
            timeout=timeout,
            progress=progress,
        )
    made.also(also)
    return made
