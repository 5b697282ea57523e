"""What a search tries in which structures, what it finds, and how it ranks that."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from mcexact.synthesis.optimum.aims import SEEDS
from mcexact.synthesis.optimum.alike import tied
from mcexact.synthesis.optimum.effort import Effort
from mcexact.synthesis.optimum.figures import Figures
from mcexact.synthesis.optimum.polish import Target
from mcexact.synthesis.optimum.problem import FeedbackProblem, Sizes, Structure
from mcexact.synthesis.optimum.programs import NetworkController, rounded
from mcexact.synthesis.optimum.weights import Floats, Weights
from mcexact.synthesis.request import Progress

_LARGEST_ORDER = 3
_PRICE_OF_ORDER, _PRICED_ORDERS = 1.02, 20
_CONTENT, _FRAGILE, _NOT_CERTIFIED = 1.5, 1.25, 1e6
MOST_STATES = 100
"""Of plants for which the controller of the theorem is constructed where a search found none."""


@dataclass(frozen=True)
class Ladder:
    """What a search tries, and when it ends.

    Attributes
    ----------
    structure : callable
        The structure in which every agent has a state of some order, one for all or for each.
    theorem : callable
        The controller of the theorem, with its network; None if there is none.
    weights : Weights
    target : Target
    enough : float
        The cost at which the search ends, if margin and gains are as aimed at.
    effort : Effort
    sizes : Sizes or None
        Of the signals of the plant.
    seeds : int
        The number of drawn starts of each order.
    most_digits : int or None
        The largest number of digits of an entry.
    most_order : int or None
        The largest number of states of each agent; None without a limit, where starts are drawn
        for orders up to 3.
    tell : callable
    """

    structure: Callable[[int | Sequence[int]], Structure]
    theorem: Callable[[], NetworkController | None]
    weights: Weights
    target: Target
    enough: float
    effort: Effort
    sizes: Sizes | None = None
    seeds: int = SEEDS
    most_digits: int | None = None
    most_order: int | None = None
    tell: Progress = field(default=lambda _: None)

    @property
    def large(self) -> bool:
        """Whether the plant is so large that a search is content with a little more."""
        return len(self.weights.Q) > MOST_STATES

    def problem(self, structure: Structure) -> FeedbackProblem:
        """Return the problem of a structure.

        Of large plants whose agents send signals, those that look alike are tied.
        """
        made = FeedbackProblem.of(*structure, self.weights, self.sizes)
        sending = structure[0].graph is not None
        return tied(made, self.weights) if self.large and sending else made

    @property
    def orders(self) -> range:
        """The orders for which starts are drawn."""
        return range(1, (_LARGEST_ORDER if self.most_order is None else self.most_order) + 1)

    def allows(self, problem: FeedbackProblem) -> bool:
        """Whether no agent has more states than it may have."""
        sizes = zip(problem.orders, problem.network.dimensions, strict=True)
        return self.most_order is None or all(z + x <= self.most_order for z, x in sizes)

    def fine(self, found: Figures) -> bool:
        """Whether a controller is good enough to end the search."""
        return (
            found.cost <= self.enough
            and found.margin >= self.target.margin
            and self.target.shape.met(found.damping, found.fastest)
            and found.largest_gain <= 1.001 * self.target.largest_gain
        )

    def keeps(self, problem: FeedbackProblem, K: Floats) -> bool:
        """Whether a gain matrix stays in the region with the digits that it may have."""
        if self.most_digits is None:
            return True
        return self.target.keeps(problem, problem.entries(rounded(K, self.most_digits)))


@dataclass(frozen=True, eq=False)
class Candidate:
    """A controller inside the region, as a gain matrix.

    Attributes
    ----------
    step : str
        The step of the ladder that found it.
    problem : FeedbackProblem
    K : ndarray
        Balanced.
    figures : Figures
        Without the peak.
    """

    step: str
    problem: FeedbackProblem
    K: Floats
    figures: Figures


@dataclass(frozen=True, eq=False)
class Start:
    """A gain matrix from which a search starts, and the step of the ladder that it belongs to."""

    step: str
    problem: FeedbackProblem
    K: Floats


def ranked(ladder: Ladder, found: list[Candidate]) -> list[Candidate]:
    """Return the candidates by their prices, the lowest first."""
    return sorted(found, key=lambda each: _price(ladder, each))


def _price(ladder: Ladder, candidate: Candidate) -> float:
    """The cost; small margins, large gains and high orders make it higher.

    Of large plants only so many orders do, since each of many agents has one or two.
    """
    figures, target = candidate.figures, ladder.target
    lacking = _FRAGILE * target.margin / max(figures.margin, 1e-9)
    lacking = 1.0 if figures.margin >= target.margin else lacking
    large = max(figures.largest_gain / target.largest_gain, 1.0)
    if not target.shape.met(figures.damping, figures.fastest):
        lacking *= _NOT_CERTIFIED if target.region.limits else _FRAGILE
    priced = min(figures.order, _PRICED_ORDERS) if ladder.large else figures.order
    return figures.cost * lacking * large * _PRICE_OF_ORDER**priced


def contents(ladder: Ladder, found: list[Candidate]) -> bool:
    """Whether a large plant needs no further search: the best price is nearly low enough."""
    return ladder.large and best_price(ladder, found) <= _CONTENT * ladder.enough


def best_price(ladder: Ladder, found: list[Candidate]) -> float:
    """The lowest price; infinite without candidates."""
    return min((_price(ladder, each) for each in found), default=np.inf)
