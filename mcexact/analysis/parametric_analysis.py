"""All questions that are decided for all values of parameters, of one plant."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import MappingProxyType
from typing import Any

from mcexact.analysis.asking import Asking
from mcexact.analysis.engine import parametric_completeness
from mcexact.analysis.exceptional_hypersurfaces import exceptional_hypersurfaces
from mcexact.analysis.questions import QUESTIONS, Question
from mcexact.answer.parametric_account import ParametricAccount
from mcexact.errors import LimitReached
from mcexact.exact.rational_functions import RationalFunction
from mcexact.model.parametric import ParametricSystem

_MOST = 10
"""The states of a plant with several parameters of which questions are asked by default."""
_CHANNELS = 20
_WITHIN_RANGES = ("box_fixed_modes", "box_stabilizability")
"""What is asked by default about all values within ranges of several parameters."""
_DEGREE = 60
"""The degree of minors up to which indices are asked by default: a minute on one processor."""


def _degree_of(entry: RationalFunction) -> int:
    return max(int(entry.numerator.total_degree()), int(entry.denominator.total_degree()), 0)


class ParametricAnalysis(Asking):
    """The answers about a system with parameters, each decided when it is first used.

    Parameters
    ----------
    plant : ParametricSystem
    questions : iterable of str, optional
    channel : str, optional
    timeout : float, optional
    progress : callable, optional
        As `analyze` takes them.

    Attributes
    ----------
    plant : ParametricSystem

    Examples
    --------
    >>> plant = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])
    >>> found = ParametricAnalysis(plant)
    >>> print(found.account.at("answer")[1])
    A mode is fixed where t = 0.
    >>> found.setpoint.words
    ('rank 3 for almost every t', 'rank 2 where t = 0')
    """

    plant: ParametricSystem
    _certain = "a parameter has no range with two ends"
    questions = MappingProxyType(
        {name: question for name, question in QUESTIONS.items() if question.for_all_values}
    )

    def __init__(
        self,
        plant: ParametricSystem,
        questions: Iterable[str] | None = None,
        *,
        channel: str | None = None,
        timeout: float | None = None,
        progress: Callable[[str], None] | None = None,
    ) -> None:
        self.plant = plant
        ends = [end for bounds in plant.ranges for end in bounds]
        self._arguments = {
            "channels": None if channel is None else [channel],
            "uncertainty": None if None in ends else plant.ranges,
        }
        plant.indices([] if channel is None else [channel])
        self._ask(questions, timeout, progress)

    def _too_long(self, question: Question) -> str:
        plant = self.plant
        if len(plant.parameters) > 1 and plant.n > _MOST:
            return f"more than {_MOST} states with several parameters"
        if "channels" in question.help and plant.m > _CHANNELS:
            return f"more than {_CHANNELS} channels, with a certificate for every two"
        if question.ports and (degree := self._degree(question)) > _DEGREE:
            return f"ranks of polynomials of degrees up to about {degree}"
        return ""

    def _applies(self, name: str) -> bool:
        # With one parameter the exact answers say what holds in the range.
        several = len(self.plant.parameters) > 1
        return not name.startswith("box_") or (several and name in _WITHIN_RANGES)

    def _degree(self, question: Question) -> int:
        """About the degree of minors of [B, A B, …]: blocks times rows or columns with letters."""
        plant = self.plant
        entries = [[_degree_of(entry) for entry in row] for row in plant.A.rows]
        lines = min(sum(map(any, entries)), sum(map(any, zip(*entries, strict=True))))
        width = sum(p if question.ports == "inputs" else q for p, q in plant.sizes)
        return lines * max(map(max, entries), default=0) * -(-plant.n // max(width, 1))

    def _given(self, name: str) -> tuple[list[Any], dict[str, Any]]:
        question = self.questions[name]
        if name == "completeness":
            return [self.plant, self["fixed_spectrum"], self["transfer_graph"]], {}
        if question.needs == "uncertainty":
            return [self.plant], {}
        reused = {question.needs: self._arguments[question.needs]} if question.needs else {}
        return [self.plant], reused

    def _decide(self, name: str, arguments: list[Any], reused: dict[str, Any]) -> Any:
        if name == "completeness":
            return parametric_completeness(*arguments)
        if len(self.plant.parameters) > 1 and self.questions[name].needs != "uncertainty":
            return exceptional_hypersurfaces(*arguments, name, **reused)  # type: ignore[call-overload]
        return super()._decide(name, arguments, reused)

    @property
    def answers(self) -> dict[str, Any]:
        """The answers to all questions asked, without those that a limit left open."""
        return {
            name: found
            for name, found in self._outcomes().items()
            if not isinstance(found, LimitReached)
        }

    @property
    def account(self) -> ParametricAccount:  # type: ignore[override]
        """Decide all questions asked, and return the answers with their sentences."""
        return ParametricAccount(self.plant, self.answers)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by the name of its question."""
        return self.account.as_json(questions=[each.view() for each in self.effort()])

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the modes against one parameter, or the hypersurfaces of two."""
        return self["fixed_spectrum"].plot(ax, **options)

    def __repr__(self) -> str:
        named = ", ".join(self.plant.parameters_in_words)
        return f"ParametricAnalysis(n={self.plant.n}, m={self.plant.m}, parameters: {named})"
