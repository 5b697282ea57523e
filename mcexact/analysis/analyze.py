"""analyze: all questions about one system, each decided once within its limits.

`analyze` makes an `Analysis` of a plant, with parameters or without; with parameters the questions
are decided for all values.  The answer to a question is an attribute or an item, decided when it is
first used and kept.  The table of questions (`questions`) says which function decides each, about
which system, from which other answers, and whether it is asked by default; NP-hard and slow
questions are asked only by name.  A plant of numbers, a plant with one parameter and a plant with
several have a table each.

Three things can prevent an answer.  A limit on work leaves a question open, and the other questions
have answers.  With a timeout one child process decides the questions and sends each answer at once;
it is ended when the time is over, and the questions that are left are open.  A question that would
take very long on a system of this size is left out, with the reason, unless it is asked by name.

`account` has the answers with their sentences and certificates.  `account_of_dimensions` and
`account_of_links` make the same for `mcexact allocate`, without the other questions.
"""

from __future__ import annotations

import contextlib
import os
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, NoReturn

from mcexact.analysis.blocks import bounded_blocks, modes_left
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.nearby.allowances import counts_as_exact
from mcexact.analysis.nearby.plants import Nearby
from mcexact.analysis.questions import Question, questions_about
from mcexact.analysis.sharing import (
    common_dimension,
    minimal_communication,
    minimal_shared_dimensions,
    neighbor_graph,
    shared_dimension_bound,
)
from mcexact.analysis.sharing_gap import sharing_gap
from mcexact.answer.account import (
    Account,
    ShownByAccount,
    account_for_all_values,
    by_certificate,
)
from mcexact.answer.protocol import Answer
from mcexact.answer.rulebook import ALLOCATION, ANALYSIS, LINKS, with_own
from mcexact.answer.sentence import Context, Sentences
from mcexact.derived.constructions import Share
from mcexact.derived.feedthrough import FILTERS, without_feedthrough
from mcexact.derived.modulo import parts_of
from mcexact.errors import (
    InputError,
    InternalError,
    LimitReached,
    McexactError,
    UsageError,
    one_of,
    require_seconds,
    several,
    shown_value,
    telling,
)
from mcexact.exact.rational import written
from mcexact.model.parametric import ParametricSystem
from mcexact.model.properties import PROPERTIES
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.graphs import structure
from mcexact.processes import Child

if TYPE_CHECKING:
    from mcexact.analysis.patterns import WhyFixed

# Questions about one system, with their limits on time and work.


@dataclass(frozen=True)
class Effort:
    """The seconds that a question took, and why it is open or left out, if it is."""

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


def _decide_in_child(connection: Any, analysis: Analysis) -> None:
    """Decide questions as they are named, and send each outcome at once."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's
    analysis.watch(
        lambda name, step: connection.send(("begin", name, step)),
        lambda name, answer, seconds: connection.send(("keep", name, answer, seconds)),
    )
    with contextlib.suppress(EOFError, OSError):
        while True:
            try:
                analysis.without_limit(connection.recv())
            except McexactError as error:
                connection.send(("error", error))
            connection.send(("end",))


_LACKS = {"joint_controllability": "uncontrollable", "joint_observability": "unobservable"}
"""What a plant nearby lacks where the answer is yes."""
_NEARBY, _WHY = "nearby_plants", "why_fixed"
_AS_LONG = 3
"""To find the null spaces of modes takes up to about as many times as long as to decide which are
fixed."""
_MOST_STATES_NEARBY = 300
"""Plants nearby are searched for at most so many states by default: of more that takes seconds."""
_LINKED_CHANNELS, _LINKED_STATES = 8, 60
"""The fewest links are asked for by default up to so many channels and states."""
_MOST_STATES_READ = 100
"""Readers of floats warn of plants with at most so many states: they are to be quick."""
_MOST_STATES = 60
"""Plants within the radii that fail are searched for at most so many states: that takes seconds."""


class Analysis(ShownByAccount):
    """The answers about one system, by attribute or item, each decided when it is first used.

    Parameters
    ----------
    plant : MultiChannelSystem or ParametricSystem
        With parameters the questions are decided for all values.
    questions : iterable of str, optional
    information : {"own", "outputs"}
    subset : sequence of str, optional
    channel : str, optional
    nearby : bool
    timeout : float, optional
    progress : callable, optional
        As `analyze` takes them.

    Attributes
    ----------
    plant : MultiChannelSystem or ParametricSystem
    information : str
    nearby_seconds : float or None
        What the search for plants nearby may take, after the questions; None for no limit.

    Examples
    --------
    >>> plant = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])
    >>> analysis = Analysis(plant)
    >>> print(analysis.account.at("answer")[1])
    A mode is fixed where t = 0.
    >>> analysis.setpoint.words
    ('rank 3 for almost every t', 'rank 2 where t = 0')
    >>> Analysis(plant.at({"t": 0})).fixed_spectrum.empty
    False
    """

    plant: MultiChannelSystem | ParametricSystem

    def __init__(
        self,
        plant: MultiChannelSystem | ParametricSystem,
        questions: Iterable[str] | None = None,
        *,
        information: str = "own",
        subset: Sequence[str] | None = None,
        channel: str | None = None,
        nearby: bool = True,
        timeout: float | None = None,
        progress: Callable[[str], None] | None = None,
    ) -> None:
        if isinstance(plant, ParametricSystem):
            if subset is not None or information != "own":
                raise UsageError(
                    "these questions are about systems without parameters: "
                    "give values with .at({…})"
                )
        else:
            plant = without_feedthrough(plant)
        self.plant = plant
        # of one kind or the other, as what uses it knows
        self._own: Any = plant
        self.information = information
        self._arguments: dict[str, Any] = {
            "neighbors": plant.neighbors,
            "uncertainty": _uncertainty(plant),
            "subset": subset,
            "channel": channel,
            "channels": None if channel is None else [channel],
            "information": information,
        }
        named = () if subset is None else several(subset, "subset")
        plant.indices([*named, *([] if channel is None else [channel])])
        one_of(information, ("own", "outputs"), "information")
        if information == "outputs":
            self._require(
                "neighbors", "the information 'outputs' is about messages between neighbors"
            )
        if timeout is not None:
            require_seconds(timeout, "timeout")
        tell = telling(progress)
        self._timeout, self._left = timeout, timeout
        self._child: Child | None = None
        self._ended: set[str] = set()
        self.watch(lambda _, step: tell(step), lambda *_: None)
        self._answers: dict[str, Any] = {}
        self._seconds: dict[str, float] = {}
        self._refuted: dict[str, Answer | None] = {}
        self._tells_nearby = nearby
        self.nearby_seconds: float | None = None
        self._nearby: dict[tuple[str, ...], Nearby] = {}
        self._why_fixed: WhyFixed | None = None
        self._chosen = questions is not None
        if self._chosen:
            self.left_out = {}
        listed = self.by_default if questions is None else several(questions, "questions")
        for name in listed:
            self._require_known(name)
        self._asked = set(listed)

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the parameters of the plant; empty if it has none."""
        return _parameters(self.plant)

    @property
    def questions(self) -> Mapping[str, Question]:
        """The questions that can be asked of such a plant."""
        return questions_about(self.parameters)

    @cached_property
    def system(self) -> MultiChannelSystem:
        """Return the plant, or the plant with the outputs that the agents receive."""
        return self._own if self.information == "own" else self.linked

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
        """Set the answer to a question that was decided elsewhere, about the same system.

        Parameters
        ----------
        name : str
        answer : Answer or LimitReached
            A limit that prevented the answer leaves the question open.
        seconds : float
            The time that the decision took.

        Raises
        ------
        UsageError
            If there is no such question, or the system lacks something that it needs.
        """
        self._require_known(name)
        self._answers[name], self._seconds[name] = answer, seconds
        self._asked.add(name)

    def leave_open(self, reason: str, names: Iterable[str] | None = None) -> None:
        """Leave some questions open, by default all asked ones that are not decided yet.

        Parameters
        ----------
        reason : str
            The limit on time or memory, or the interrupt, that ended the work on them.
        names : iterable of str, optional
        """
        if names is None:
            names = self._asked - self._answers.keys()
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
    def by_default(self) -> tuple[str, ...]:
        """The questions that are asked by default: they apply to the plant, and are cheap."""
        return tuple(name for name in self._applicable() if name not in self.left_out)

    @cached_property
    def left_out(self) -> dict[str, str]:
        """The questions that are left out because they would take very long, and why."""
        reasons = {
            name: self.questions[name].reason_to_leave_out(self.system)
            for name in self._applicable()
        }
        return {name: reason for name, reason in reasons.items() if reason}

    def _applicable(self) -> Iterator[str]:
        for name, question in self.questions.items():
            there = not question.needs or self._arguments[question.needs] is not None
            if question.by_default and there and self._applies(name):
                yield name

    def _applies(self, name: str) -> bool:
        if self._has_filters and self.questions[name].needs == "channels":
            return False
        subset = self._arguments["subset"]
        return name != "complementary_subsystem" or 0 < len(set(subset)) < self.plant.m

    @property
    def _has_filters(self) -> bool:
        """Whether the inputs were made states: no channel alone controls those of others."""
        return any(step["construction"] == FILTERS for step in self.plant.subject)

    def _require_known(self, name: str) -> None:
        if not isinstance(name, str) or name not in self.questions:
            raise UsageError(
                f"there is no question {shown_value(name)}; expected {', '.join(self.questions)}"
            )
        self._require(self.questions[name].needs, f"the question {name!r} is about {{}}")
        if self._has_filters and self.questions[name].needs == "channels":
            raise UsageError(
                f"the question {name!r} is not asked where inputs are states, as those of "
                "other channels are; ask joint_controllability(plant, [name]) of the plant itself"
            )

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
            certain = (
                "a parameter has no range with two ends"
                if self.parameters
                else "every entry of this system is certain: add 'uncertainty' to the file"
            )
            raise UsageError(
                f"{asked.format('every plant within the radii of its entries')}, and {certain}"
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
        outcome = self._outcome(name)
        if isinstance(outcome, LimitReached):
            raise outcome
        return outcome

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self.questions:
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self
            )
        return self[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.questions})

    def _outcome(self, name: str) -> Any:
        """Return the answer, or the limit that prevented it.

        A question that cannot be decided of this system was not asked: the others have answers.
        """
        asked_before = name in self._asked
        self._asked.add(name)
        if name not in self._answers:
            try:
                if self._left is None:
                    self._decide_here(name)
                else:
                    self._decide_in_time([name])
            except McexactError:
                if not asked_before:
                    self._asked.discard(name)
                raise
        return self._answers[name]

    def _decide_here(self, name: str) -> None:
        began = time.perf_counter()
        try:
            subject, keywords = self._arguments_of(self.questions[name])
            began = time.perf_counter()
            self._begin(name, self._progress(name))
            outcome = self.questions[name].decide(subject, **keywords)
        except LimitReached as reached:
            outcome = reached
        self._answers[name], self._seconds[name] = outcome, time.perf_counter() - began
        self._keep(name, outcome, self._seconds[name])

    def without_limit(self, names: Iterable[str]) -> None:
        """Decide questions here, however long it takes."""
        self._left = None
        for name in names:
            self._outcome(name)

    def _progress(self, name: str) -> str:
        """A line that says how many questions are decided, and which is next."""
        done, asked = len(self._answers), len(self._asked | self._answers.keys())
        long = self.left_out.get(name, "")
        words = f", which takes long ({long})" if long else ""
        return f"{done} of {asked} questions decided, now the {name.replace('_', ' ')}{words}"

    def _decide_in_time(self, names: list[str]) -> None:
        """Decide questions in a child process, which is ended when the time is over.

        Questions that it has not decided by then are open.
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
        if undecided := [name for name in names if name not in self._answers]:
            self._left = 0.0
            self._end_child()
            self.leave_open(f"the time limit of {self._timeout:g} s was reached", undecided)

    def _end_child(self) -> None:
        child, self._child = self._child, None
        if child is not None:
            child.end()

    def _listen(self, child: Child, end: float) -> None:
        """Receive the answers of a child until it has decided all, or the time is over."""
        try:
            while child.connection.poll(max(0.0, end - time.monotonic())):
                event, *rest = child.connection.recv()
                if event == "begin":
                    self._begin(*rest)
                elif event == "keep":
                    self.know(*rest)
                    self._keep(*rest)
                elif event == "error":
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

    def _arguments_of(self, question: Question) -> tuple[Any, dict[str, Any]]:
        """Return what a question is asked about, and the keywords, also answers to others."""
        subject = getattr(self, question.about)
        keywords = {key: self[other] for key, other in question.reuses.items()}
        for key, other in question.shares.items():
            if other in self._asked and not isinstance(self._outcome(other), LimitReached):
                keywords[key] = self._outcome(other)
        if question.needs not in {"", "neighbors", "uncertainty"}:
            keywords[question.needs] = self._arguments[question.needs]
        return subject, keywords

    @cached_property
    def linked(self) -> MultiChannelSystem:
        """Return the plant with the outputs that the agents receive."""
        from mcexact.derived.constructions import augmented_outputs

        return augmented_outputs(self._own)

    @cached_property
    def shared(self) -> MultiChannelSystem:
        """Return the plant with the outputs of all agents from which a path leads to an agent."""
        from mcexact.derived.constructions import augmented_outputs, closure

        return augmented_outputs(closure(self._own))

    @cached_property
    def minimal(self) -> MultiChannelSystem:
        """Return a minimal realization of the system that is asked about."""
        from mcexact.analysis.modulo import modulo

        return modulo(self.system, "both")

    @cached_property
    def quotient(self) -> MultiChannelSystem:
        """Return the system with the channels of each strong component merged into one."""
        from mcexact.derived.constructions import merged

        return merged(self.system, self["transfer_graph"].components)

    @cached_property
    def lifted(self) -> MultiChannelSystem:
        """Return the plant with sub-states, as many as the bound, shared over links with delays."""
        from mcexact.derived.constructions import lifted_system

        return lifted_system(self._own, self._shared("outputs_states"))

    @cached_property
    def held(self) -> MultiChannelSystem:
        """Return the plant with sub-states that are shared alone, and held for the delays."""
        from mcexact.derived.constructions import held_system

        return held_system(self._own, self._shared("states"))

    def _shared(self, stem: str) -> tuple[int, ...]:
        bound: int = self[f"shared_dimension_bound_{stem}"].deficiency
        return (bound,) * int(self.plant.m)

    def open(self) -> dict[str, LimitReached]:
        """Return the questions that a limit on work left undecided."""
        return {
            name: outcome
            for name, outcome in self._outcomes().items()
            if isinstance(outcome, LimitReached)
        }

    def ended(self) -> dict[str, list[str]]:
        """Return the questions on which work was stopped, by the reason for it."""
        names: dict[str, list[str]] = {}
        for name in self.asked:
            if name in self._ended:
                names.setdefault(self._answers[name].message, []).append(name)
        return names

    def explain(self) -> str:
        """Say in plain words what is decided, and what a limit left open, one sentence a line."""
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
        return (*asked, *left, *self._effort_nearby())

    def _effort_nearby(self) -> Iterator[Effort]:
        """Why the search for plants nearby was left out, if it was."""
        if self.parameters or "fixed_spectrum" not in self._asked:
            return
        if reason := self.nearby_left_out:
            yield Effort(_NEARBY, "left out", 0.0, reason)
        elif reason := self.nearby.ended:
            yield Effort(_NEARBY, "open", self._seconds_of_search() or 0.0, reason)
        if not self.nearby_left_out and (reason := self.why_fixed_left_out):
            yield Effort(_WHY, "left out", 0.0, reason)

    def __repr__(self) -> str:
        plant = self._own
        if self.parameters:
            named = ", ".join(plant.parameters_in_words)
            return f"Analysis(n={plant.n}, m={plant.m}, parameters: {named})"
        decided = sum(name in self._answers for name in self._asked)
        factors = getattr(self._answers.get("fixed_spectrum"), "factors", None)
        known = "" if factors is None else "no mode is fixed; "
        if factors:
            known = f"roots of {', '.join(str(each.polynomial) for each in factors)} are fixed; "
        return (
            f"Analysis(n={plant.n}, m={plant.m}, {plant.time} time: {known}"
            f"{decided} of {len(self._asked)} questions decided)"
        )

    def __bool__(self) -> NoReturn:
        raise TypeError(
            "an analysis is neither true nor false: ask for one of its answers, such as "
            ".fixed_spectrum.empty or .completeness.complete"
        )

    def _outcomes(self) -> dict[str, Any]:
        """Decide all questions asked, and those that follow from what is fixed; their outcomes.

        Indices of many states take longest, and come last: a limit shall not discard others for
        them.
        """
        early = [name for name in self.asked if not self.questions[name].ports]
        self._decide(early)
        if not self._chosen:
            outcomes = {name: self._answers[name] for name in early}
            if self._links_may_move_modes(outcomes.get("fixed_spectrum")):
                self._asked.add("linked_fixed_spectrum")
            elif self._has_decentralized_modes(outcomes):
                self._asked.add("quotient_fixed_spectrum")
                if self._few_links_are_found_soon() and not self.plant.neighbors:
                    self._asked.add("minimal_communication")
            if self._some_agents_receive_too_little(outcomes.get("fixed_spectrum")):
                self._asked.add("shared_fixed_spectrum")
                if self._few_links_are_found_soon() and not self._has_joint_modes(outcomes):
                    self._asked.add("minimal_communication")
            if self._has_joint_modes(outcomes):
                self._asked.add("minimal_fixed_spectrum")
            if self._has_entries_to_blame(outcomes.get("fixed_spectrum")):
                self._asked.add("structural_fixed_modes")
        self._decide(sorted(self.asked, key=lambda name: bool(self.questions[name].ports)))
        self._end_child()
        return {name: self._answers[name] for name in self.asked}

    def _decide(self, names: Sequence[str]) -> None:
        """Decide questions, and what they need, in the time that is left."""
        if self._left is not None and (rest := [n for n in names if n not in self._answers]):
            self._decide_in_time(rest)
        for name in names:
            self._outcome(name)

    def _has_joint_modes(self, outcomes: Mapping[str, Any]) -> bool:
        """Whether all channels together are known not to control or not to observe a mode."""
        known = [outcomes.get(name) for name in _LACKS]
        lacks = [each for each in known if each is not None and not isinstance(each, LimitReached)]
        question = self.questions.get("minimal_fixed_spectrum")
        if question is None or question.reason_to_leave_out(self.system):
            return False
        return any(not each.controllable for each in lacks)

    def _has_decentralized_modes(self, outcomes: Mapping[str, Any]) -> bool:
        """Whether a fixed mode is known that some channels do not control, others not observe."""
        spectrum, graph = (outcomes.get(name) for name in ("fixed_spectrum", "transfer_graph"))
        if not isinstance(spectrum, Answer) or not isinstance(graph, Answer):
            return False
        question = self.questions.get("quotient_fixed_spectrum")
        if question is None or question.reason_to_leave_out(self.system):
            return False
        known: Any = spectrum
        own, m = self.information == "own", self.system.m
        return own and any(0 < len(factor.channels) < m for factor in known.factors)

    def _has_entries_to_blame(self, spectrum: Any) -> bool:
        """Whether modes of the plant itself are fixed, by its zeros or by equalities."""
        question, plant = self.questions.get("structural_fixed_modes"), self.plant
        if question is None or self.information != "own" or plant.subject or plant.D is not None:
            return False
        if not isinstance(spectrum, Answer) or question.reason_to_leave_out(plant):
            return False
        known: Any = spectrum
        return not known.empty

    def _few_links_are_found_soon(self) -> bool:
        """Whether the plant is so small that the fewest links are asked for without the option."""
        plant = self.plant
        if "minimal_communication" not in self.questions or plant.subject:
            return False
        return plant.m <= _LINKED_CHANNELS and plant.n <= _LINKED_STATES

    def _links_may_move_modes(self, spectrum: Any) -> bool:
        """Whether modes are fixed without the links of the plant, if this was decided."""
        graph = self.plant.neighbors
        linked = self.information == "own" and graph is not None and graph.edges()
        known = spectrum is not None and not isinstance(spectrum, LimitReached)
        return bool(linked and known and not spectrum.empty)

    def _some_agents_receive_too_little(self, spectrum: Any) -> bool:
        """Whether modes are fixed, and the links of the plant do not connect all agents."""
        graph, question = self.plant.neighbors, self.questions.get("shared_fixed_spectrum")
        if question is None or graph is None or not graph.edges() or graph.is_strongly_connected():
            return False

        def fixes(outcome: Any) -> bool:
            return isinstance(outcome, Answer) and not getattr(outcome, "empty", True)

        if not fixes(spectrum) or question.reason_to_leave_out(self.plant):
            return False
        return self.information != "own" or fixes(self._outcome("linked_fixed_spectrum"))

    @property
    def answers(self) -> dict[str, Any]:
        """The answers to all questions asked, without those that a limit left open."""
        return {
            name: outcome
            for name, outcome in self._outcomes().items()
            if not isinstance(outcome, LimitReached)
        }

    def decided(self) -> dict[str, Any]:
        """Return the answers to all questions asked, with several answers to one numbered.

        With several parameters these are the answers along lines, which prove the others.
        """
        return by_certificate(self.answers)

    @property
    def account(self) -> Account:
        """Decide all questions asked, and return the answers with their sentences."""
        if self.parameters:
            return account_for_all_values(self._own, self.answers)
        answers = self.decided()
        asked: dict[str, Any] = {"information": self.information}
        if "fixed_spectrum" in answers and not answers["fixed_spectrum"].empty:
            asked["fixed"] = True
        open_ = {*self.left_out, *self.open()} - answers.keys() - self._ended
        near: dict[str, Any] = {} if self.nearby_left_out else dict(self.nearby.answers)
        if near:
            asked["nearby"] = {each.lost: (each.part, each.within) for each in self.nearby.plants}
        told = self._told_why_fixed
        why: dict[str, Any] = {} if told is None else dict(told.answers)
        given, answers = Context(self.system, asked), answers | near | why
        sentences = with_own(ANALYSIS, answers).sentences(answers, given, open_)
        about, failing = self.plant.subject, self.failing()
        return Account(answers, given, sentences, about, sorted(open_), failing, [*near])

    @property
    def nearby_left_out(self) -> str:
        """Why no plants nearby are looked for by default; empty if they are."""
        if not self._tells_nearby:
            return "it was asked to be left out"
        if self.information != "own" or self.plant.subject:
            return "it is about plants alone, whose agents feed back their own outputs"
        if self.plant.n > _MOST_STATES_NEARBY:
            return f"more than {_MOST_STATES_NEARBY} states"
        return "the time limit was reached" if self._left == 0 else ""

    @property
    def nearby(self) -> Nearby:
        """What was found near the plant: plants of which an answer is another one.

        It is looked for what the given plant has according to the questions that were asked: that
        it can be stabilized and no mode is fixed, and that all channels control and observe it.

        Raises
        ------
        InputError
            If the plant has parameters or is a derived system.
        """
        InputError.require(self.plant, MultiChannelSystem, "system")
        answers, lost = self.answers, list[Any]()
        if "fixed_spectrum" in answers:
            spectrum = answers["fixed_spectrum"]
            lost += ["unstable"] * spectrum.stabilizable + ["fixed"] * spectrum.empty
        for name, lack in _LACKS.items():
            if name in answers and answers[name].controllable:
                lost.append(lack)
        if tuple(lost) not in self._nearby:
            self._nearby[tuple(lost)] = self._search_nearby(lost)
        return self._nearby[tuple(lost)]

    def _search_nearby(self, lost: list[Any]) -> Nearby:
        """Search the plants nearby, unless all entries are too short for any to be there."""
        if not self._own.subject and counts_as_exact(self._own):
            return Nearby(self._own, (), (), ())
        # It computes in floating point, and the other questions load no numpy.
        from mcexact.analysis.nearby.search import nearby_plants

        return nearby_plants(self._own, lost, seconds=self._seconds_of_search())

    def _seconds_of_search(self) -> float | None:
        """What the search may take: all that is left, and no more than was asked for."""
        limits = [each for each in (self._left, self.nearby_seconds) if each is not None]
        return min(limits) if limits else None

    @property
    def why_fixed_left_out(self) -> str:
        """Why no null spaces are named of what equalities fix: that takes long."""
        if self.nearby_left_out:
            return self.nearby_left_out
        spectrum = self.answers.get("fixed_spectrum")
        if spectrum is None or spectrum.empty:
            return ""
        seconds, known = self._seconds_of_search(), self._seconds["fixed_spectrum"]
        late = seconds is not None and _AS_LONG * known > seconds
        return f"the time limit of {seconds:.2g} s would be reached" if late else ""

    @property
    def why_fixed(self) -> WhyFixed:
        """Why modes of the plant are fixed, by equalities between its entries or by its zeros.

        Without the answer to `fixed_spectrum` nothing is known, nor if it is about another system
        than the plant: about one with outputs of neighbors, or without feedthrough.

        Raises
        ------
        InputError
            If the plant has parameters.
        """
        # Few plants have fixed modes.
        from mcexact.analysis.patterns import WhyFixed, why_fixed

        InputError.require(self.plant, MultiChannelSystem, "system")
        spectrum = self.answers.get("fixed_spectrum")
        if spectrum is None or spectrum.subject:
            return WhyFixed(self._own, known=False)
        if self._why_fixed is None:
            structural = self.answers.get("structural_fixed_modes")
            self._why_fixed = why_fixed(self._own, spectrum, structural)
        return self._why_fixed

    @property
    def _told_why_fixed(self) -> WhyFixed | None:
        """Why modes are fixed, if that is told with the answers: what is structural is asked."""
        structural = self.answers.get("structural_fixed_modes")
        if structural is None or self.why_fixed_left_out:
            return None
        return self.why_fixed

    def failing(self) -> dict[str, Answer]:
        """Return exact answers about plants within the radii that lack an unproved property.

        Such a plant is searched for each question of `PROPERTIES` that was asked and is open, if
        the system has at most 60 states and no parameters.  If the search fails, this proves
        nothing.  One plant often lacks several properties: what is not controllable has a fixed
        mode.
        """
        system, asked = self.system, PROPERTIES.keys() & (self.open().keys() - self._ended)
        if self.parameters or system.subject or system.n > _MOST_STATES or self._left == 0:
            return {}
        for name in reversed(PROPERTIES):  # what implies others comes last
            if name not in asked or name in self._refuted:
                continue
            # Few plants have radii, and this loads all that searches in boxes.
            from mcexact.analysis.boxes.largest import failing_member

            known = [each.about.plant for each in self._refuted.values() if each is not None]
            self._refuted[name] = failing_member(system, PROPERTIES[name], known=known)
        searched = {name: self._refuted[name] for name in sorted(asked)}
        return {name: answer for name, answer in searched.items() if answer is not None}

    def to_dict(self) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by the name of its question."""
        account, efforts = self.account, [each.view() for each in self.effort()]
        if self.parameters:
            return account.as_json(questions=efforts)
        open_ = {}
        for name, reached in self.open().items():
            bounds = {"lower": _written(reached.lower), "upper": _written(reached.upper)}
            open_[name] = {"decided": False, "computed_not_certified": bounds}
        failing = {name: each.about.plant.to_dict() for name, each in account.failing.items()}
        known = {"failing_within_radii": failing} if failing else {}
        if not self.nearby_left_out:
            known["nearby"] = self.nearby.to_dict()
        told = self._told_why_fixed
        if told is not None and (told.by_zeros or told.by_equalities):
            known["why_fixed"] = told.to_dict()
        return account.as_json(information=self.information, questions=efforts, **known, **open_)

    def to_rows(self) -> list[dict[str, Any]]:
        """Decide all questions asked, and return a flat row for each answer."""
        return [{"question": name, **each.to_row()} for name, each in self.decided().items()]

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the graphs of the plant, or what is fixed for which values of its parameters.

        Without parameters these are the neighbor graph and the transfer graph, with what makes a
        mode fixed in orange (`mcexact.plot.fixed_mode` draws the mode between its channels); with
        one the modes against it, with two hypersurfaces.

        Parameters
        ----------
        ax : axes of matplotlib, optional
            One for each graph.
        **options
            With parameters, as the answer's own ``plot`` takes them.

        Returns
        -------
        matplotlib.figure.Figure
        """
        if self.parameters:
            return self["fixed_spectrum"].plot(ax, **options)
        return structure(self.system, self["fixed_spectrum"], self["transfer_graph"], ax, **options)


def _parameters(plant: Any) -> tuple[str, ...]:
    return plant.parameters if isinstance(plant, ParametricSystem) else ()


def _uncertainty(plant: MultiChannelSystem | ParametricSystem) -> Any:
    """The radii of the entries, or the ranges of all parameters; None if something lacks these."""
    if isinstance(plant, ParametricSystem):
        ends = [end for bounds in plant.ranges for end in bounds]
        return None if None in ends else plant.ranges
    # a part of the nominal plant is none of every plant within its radii
    return None if parts_of(plant) else plant.plant.uncertainty


def _written(bound: Fraction | None) -> Any:
    return None if bound is None else written(bound)


def analyze(
    plant: MultiChannelSystem | ParametricSystem,
    questions: Iterable[str] | None = None,
    *,
    also: Iterable[str] = (),
    information: str = "own",
    subset: Sequence[str] | None = None,
    channel: str | None = None,
    nearby: bool = True,
    timeout: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> Analysis:
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
    nearby : bool
        Whether plants nearby are looked for of which an answer is another one (`Analysis.nearby`),
        with at most 300 states; what the data of the plant allow is said first.
    timeout : float, optional
        Seconds that all decisions together may take.  A child process decides, and is ended when
        they are over: answers that it has sent stay, and the other questions are open, with this
        limit as their reason in ``effort()``.
    progress : callable, optional
        It is called with a line of text before each question is decided, such as `print`.

    Returns
    -------
    Analysis
        The answers, each of which is decided when it is first used.

    Raises
    ------
    UsageError
        If a name is not a question, or the system lacks something that a question needs; if
        ``timeout`` is no number of seconds, or ``progress`` no function.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> analysis = analyze(gallery.load("liu2020-3ch-no-communication"))
    >>> analysis.fixed_spectrum.empty, analysis.completeness.complete
    (False, False)
    >>> sorted(analysis.minimal_communication.added)
    [('1', '2')]
    >>> analysis = analyze(analysis.plant, ["completeness"], progress=print)
    >>> analysis.completeness.complete
    0 of 2 questions decided, now the fixed spectrum
    1 of 2 questions decided, now the completeness
    False
    """
    analysis = Analysis(
        plant,
        questions,
        information=information,
        subset=subset,
        channel=channel,
        nearby=nearby,
        timeout=timeout,
        progress=progress,
    )
    analysis.also(also)
    return analysis


def rounding_doubts(system: MultiChannelSystem) -> tuple[str, ...]:
    """Return how answers about a plant that was read from floats depend on rounding errors.

    It is quick rather than complete: a plant with more than 100 states, or one of whose modes some
    may be fixed by themselves, is not looked at.

    Returns
    -------
    tuple of str
        One text for each plant nearby, as `Nearby.doubts`.
    """
    if system.rounding is None or system.n > _MOST_STATES_READ or counts_as_exact(system):
        return ()
    if modes_left(bounded_blocks(system)):
        return ()
    # It computes in floating point, and the other questions load no numpy.
    from mcexact.analysis.nearby.search import nearby_plants

    return nearby_plants(system).doubts


# The answers of `mcexact allocate` with their sentences.


def account_of_dimensions(
    system: MultiChannelSystem, *, share: Share = "outputs+states", **options: Any
) -> Account:
    """Compute the least dimensions that agents must share, and the bound of the paper.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with a neighbor graph.
    share : {"outputs+states", "states"}
    **options
        The other keywords of `minimal_shared_dimensions`.
    """
    least = minimal_shared_dimensions(system, share=share, **options)
    answers: dict[str, Answer] = {
        "minimal_shared_dimensions": least,
        "shared_dimension_bound": shared_dimension_bound(system, share=share),
        "neighbor_graph": neighbor_graph(system),
        "joint_controllability": joint_controllability(system),
        "joint_observability": joint_observability(system),
        "common_dimension": common_dimension(system, share=share),
        "sharing_gap": sharing_gap(system),
    }
    proof = {
        "cuts": len(least.cuts),
        "nodes": len(least.tree),
        "multiplicities": least.multiplicities,
    }
    given = Context(system, proof)
    return Account(answers, given, ALLOCATION.sentences(answers, given))


def account_of_links(system: MultiChannelSystem, **options: Any) -> Account:
    """Compute the cheapest links to add.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.
    **options
        The keywords of `minimal_communication`.
    """
    least = minimal_communication(system, **options)
    given = Context(system, {"cuts": len(least.cuts), "nodes": len(least.tree)})
    answers = {"minimal_communication": least}
    return Account(answers, given, LINKS.sentences(answers, given))
