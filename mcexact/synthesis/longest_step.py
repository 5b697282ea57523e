"""The longest time between samples with which a controller keeps its margins.

A controller for a sampled plant is a program that somebody runs, perhaps less often than it was
designed for.  `longest_step` looks among a few longer steps for the longest one with which the same
program still has a stable loop with a disk margin at every single input and output.  The search
computes margins in floating point, and assumes that they fall as steps grow; the step that it finds
is proved, by certificates about the plant with that step, unless these are too large.  That no
longer step has the margins is never proved.

A controller in continuous time is held at samples as `c2d` does it, by Tustin's rule and rounded to
12 digits; its steps are numbers such as 0.25, and begin at the inverse of the fastest eigenvalue.
Of loops that are large the step is not sought, unless all is to be proved.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import floor, log10
from typing import Any

import numpy as np

from mcexact.analysis.performance import computed_margins, margin_of, response_of
from mcexact.answer.performance import DiskMargin
from mcexact.derived.sampling import DECIMALS, is_sampled, sampled_system, tustin
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.matrix import matrix_to_float
from mcexact.exact.rational import Entry, approximated, as_fraction, written
from mcexact.exact.roots import is_discrete
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown
from mcexact.synthesis.optimum.diagnosis import rounded_controller
from mcexact.synthesis.performance import (
    MOST_BYTES,
    MOST_SECONDS,
    NO_TIME,
    SIDES,
    margin_size,
    too_large,
)

FACTORS = tuple(map(Fraction, ("1", "11/10", "5/4", "3/2", "7/4", "2", "5/2", "3", "4", "6", "8")))
"""The steps that are tried, as multiples of the one of the plant."""
ROUND = tuple(map(Fraction, ("1", "5/4", "3/2", "2", "5/2", "3", "4", "5", "6", "8")))
"""The steps of a controller in continuous time, times powers of ten."""
_DECADES = 3
"""Steps are tried in so many decades below the inverse of the fastest eigenvalue, and one above."""
_MOST_SIGNALS, _MOST_TRIED, _MOST_PROVED = 70, 14, 3
"""Loops with more states, inputs and outputs are left out; so many steps are tried at most, and of
so many a proof."""
STANDARD_MARGIN = Fraction(2, 5)


@dataclass(frozen=True, repr=False)
class LongestStep(Shown):
    """The longest step that was found, with its certificates.

    Attributes
    ----------
    step : Fraction or None
        None where the margins were not found even for the step of the plant, or no time was left.
    margin : Fraction
        The disk margin at every single input and output.
    longer : Fraction or None
        The next longer step that was tried, for which they were not found; None if there is none.
    answers : mapping of str to DiskMargin
        ``input_margin`` and ``output_margin``, about the loop with this step.
    unproved : str
        Why the margins with this step are computed and not proved; empty if they are proved.
    left_out : str
        Why no step was sought; empty if one was.
    held : bool
        Whether the controller is one in continuous time, held at samples.
    """

    step: Fraction | None
    margin: Fraction
    longer: Fraction | None
    answers: Mapping[str, DiskMargin]
    unproved: str = ""
    left_out: str = ""
    held: bool = False

    def explain(self) -> str:
        """Say what was found, in one line."""
        kept = f"a disk margin of {approximated(self.margin)} at every single input and output"
        if self.step is None and self.longer is None:
            return f"not sought: {self.left_out or 'no time was left'}"
        if self.step is None:
            tried = f"{approximated(self.longer or Fraction(0))} or longer"
            which = tried if self.held else "the step of the plant"
            return f"no proof was found for {which}, with {kept}"
        computed = f", computed and not proved: {self.unproved}" if self.unproved else ""
        end = "" if self.longer is None else f"; not found for {approximated(self.longer)}"
        return f"{approximated(self.step)}, with {kept}, the longest one of a search{computed}{end}"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield "longest step", self.explain()

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "step": None if self.step is None else written(self.step),
            "margin": written(self.margin),
            "proved": bool(self.answers),
            "not_found": None if self.longer is None else written(self.longer),
            **({"left_out": self.left_out} if self.left_out else {}),
        }

    def __repr__(self) -> str:
        return f"LongestStep({self.explain()})"


def longest_step(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    margin: Entry = STANDARD_MARGIN,
    prove_all: bool = False,
    deadline: float | None = None,
) -> LongestStep:
    """Search for the longest time between samples with which a controller keeps its margins.

    Parameters
    ----------
    system : MultiChannelSystem
        A sampled plant, as `sampled_system` makes it, or a plant in continuous time.
    controller : Controller
        In discrete time its numbers stay as they are.  In continuous time it is held at samples by
        `tustin`, rounded to 12 digits, and its inputs are set at once.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    margin : rational
        The disk margin that every single input and every single output keeps.
    prove_all : bool
        Whether the margins are proved however large the certificates are; by default they have at
        most two megabytes, and take the checker at most five seconds.
    deadline : float, optional
        The time of `time.monotonic` after which no further step is tried.

    Returns
    -------
    LongestStep

    Raises
    ------
    UsageError
        If the system is in discrete time and no sampled plant, or the margin is not above 0.

    Notes
    -----
    Bisection on a short list of steps, up to eight times that of the plant, with computed margins.
    In continuous time the list has ten steps in each decade.  Not sought are steps for derived
    systems, for agents that share states, for loops with more than 70 states, inputs and outputs
    (unless ``prove_all``), and for loops that have not the margin in continuous time.
    A proof is about A and B rounded to the decimals of the sampled plant, as that of each margin.

    Examples
    --------
    >>> from mcexact.derived.sampling import sampled_system
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> sampled = sampled_system(plant, "1/10")
    >>> found = longest_step(sampled, local_controllers(sampled, [[[-2]]]))
    >>> str(found.step), str(found.longer)
    ('3/5', '4/5')
    >>> longest_step(sampled, local_controllers(sampled, [[[2]]])).step is None
    True
    >>> longest_step(plant, local_controllers(plant, [[[-2]]])).explain()
    '0.6, with a disk margin of 0.4 at every single input and output, the longest one of a search; \
not found for 0.8'
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    alpha = as_fraction(margin, where="margin")
    if is_discrete(system.time) and not is_sampled(system):
        raise UsageError("expected a sampled plant, as sampled_system makes it", where="system")
    if alpha <= 0:
        raise UsageError("expected a margin above 0", where="margin")
    if not is_discrete(system.time):
        return _held(system, controller, graph, alpha, deadline, prove_all=prove_all)
    own = system.sample_time or Fraction(1)
    search = _Search(system, controller, graph, alpha, [own * each for each in FACTORS], deadline)
    return search.proved(*search.bisected(), prove_all=prove_all)


def _held(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None,
    margin: Fraction,
    deadline: float | None,
    *,
    prove_all: bool,
) -> LongestStep:
    """The longest step with which a controller in continuous time keeps the margin at samples."""
    ports = sum(system.p(i) + system.q(i) for i in range(system.m))
    loop = closed_loop(system, controller, graph)
    signals = loop.dimension + ports

    def left_out(why: str) -> LongestStep:
        return LongestStep(None, margin, None, {}, left_out=why, held=True)

    if system.subject or system.D is not None:
        return left_out("the system is no plant in continuous time without feedthrough")
    if any(each.shared for agent in controller.agents for each in agent.maps()):
        return left_out("agents share states, which Tustin's rule cannot hold")
    if signals > _MOST_SIGNALS and not prove_all:
        return left_out(f"the loop has {signals} states, inputs and outputs (--prove-all)")
    if deadline is not None and time.monotonic() >= deadline:
        return left_out("no time was left")
    if not _has_margin(loop, margin):
        return left_out(
            f"not every single input and output has a disk margin of {approximated(margin)} in "
            "continuous time"
        )
    fastest = max(abs(np.linalg.eigvals(matrix_to_float(loop.matrix))), default=0.0)
    begin = -floor(log10(fastest)) if fastest > 0 else 0
    decades = range(begin - _DECADES, begin + 1)
    steps = [each * Fraction(10) ** k for k in decades for each in ROUND]
    search = _Search(system, controller, graph, margin, steps, deadline, held=True)
    try:
        return search.proved(*search.bisected(), prove_all=prove_all)
    except UsageError as refused:  # an agent has the mode 2/h
        return left_out(refused.message)


def _has_margin(loop: ClosedLoop, margin: Fraction) -> bool:
    """Whether every single input and output has a margin, by computation."""
    known = (computed_margins(response_of(loop, side))[0] for side in SIDES)
    return all(each >= margin for margins in known for each in margins)


@dataclass(frozen=True)
class _Search:
    """The search among steps for a controller that is to keep a disk margin."""

    system: MultiChannelSystem
    controller: Controller
    graph: NeighborGraph | None
    margin: Fraction
    steps: Sequence[Fraction]
    deadline: float | None
    held: bool = False

    @property
    def ended(self) -> bool:
        """Whether no time is left."""
        return self.deadline is not None and time.monotonic() >= self.deadline

    def loop(self, k: int) -> ClosedLoop:
        """The loop of the plant with another step, whose inputs are as many steps late."""
        if self.held:
            samples = sampled_system(self.system, self.steps[k])
            program = rounded_controller(tustin(self.controller, samples), DECIMALS)
            return closed_loop(samples, program, self.graph)
        (how,) = self.system.subject
        again = sampled_system(
            self.system.plant, self.steps[k], how["late"], decimals=how["decimals"]
        )
        return closed_loop(again, self.controller, self.graph)

    def bisected(self) -> tuple[int, int]:
        """The places of the longest step with the margins, and of one without, by computation.

        The former is -1, or the latter beyond the last step, if there is none.
        """
        low, high, tried = -1, len(self.steps), 0
        first = len(self.steps) // 2 if self.held else 0
        while low + 1 < high and tried < _MOST_TRIED and not self.ended:
            if low < 0:
                k = first if high == len(self.steps) else high // 2
            else:
                k = (low + high) // 2
            enough, tried = self._enough(k), tried + 1
            low, high = (k, high) if enough else (low, k)
        return low, high

    def _enough(self, k: int) -> bool:
        """Whether the loop with a step seems to have the margin."""
        try:
            return _has_margin(self.loop(k), self.margin)
        except LimitReached:  # the step is too long for the fastest rates of the plant
            return False

    def proved(self, low: int, high: int, *, prove_all: bool) -> LongestStep:
        """The longest step up to a place whose margins are proved, or are too large to be."""

        def found(answers: Mapping[str, DiskMargin], unproved: str = "") -> LongestStep:
            longer = self.steps[high] if high < len(self.steps) else None
            step = self.steps[low] if low >= 0 else None
            return LongestStep(step, self.margin, longer, answers, unproved, held=self.held)

        for _ in range(_MOST_PROVED if self.held else len(self.steps)):
            if low < 0:
                break
            loop, plant = self.loop(low), self.system
            ports = sum(plant.p(i) + plant.q(i) for i in range(plant.m))
            size = margin_size(loop.dimension, ports)
            if not prove_all and (size[0] > MOST_BYTES or size[1] > MOST_SECONDS):
                return found({}, too_large(*size))
            if self.ended:
                return found({}, NO_TIME)
            proofs = {
                f"{side.removesuffix('s')}_margin": margin_of(loop, side, margin=self.margin)
                for side in SIDES
            }
            answers = {name: each for name, each in proofs.items() if each is not None}
            if len(answers) == len(proofs):
                return found(answers)
            low, high = low - 1, low
        low = -1
        return found({})
