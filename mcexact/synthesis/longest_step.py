"""The longest time between samples with which a controller keeps its margins.

A controller for a sampled plant is a program that somebody runs, perhaps less often than it was
designed for.  `longest_step` looks among a few longer steps for the longest one with which the same
program still has a stable loop with a disk margin at every single input and output.  Each step that
is accepted is proved, by certificates about the plant with that step; that no longer one has them
is not: it is a search, which assumes that margins fall as steps grow.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.performance import margin_of
from mcexact.answer.performance import DiskMargin
from mcexact.derived.sampling import is_sampled, sampled_system
from mcexact.errors import InputError, UsageError
from mcexact.exact.rational import Entry, approximated, as_fraction, written
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown

FACTORS = tuple(map(Fraction, ("1", "11/10", "5/4", "3/2", "7/4", "2", "5/2", "3", "4", "6", "8")))
"""The steps that are tried, as multiples of the one of the plant."""
STANDARD_MARGIN = Fraction(2, 5)


@dataclass(frozen=True, repr=False)
class LongestStep(Shown):
    """The longest step that was proved, with its certificates.

    Attributes
    ----------
    step : Fraction or None
        None where not even for the step of the plant a proof was found, or no time was left.
    margin : Fraction
        The disk margin at every single input and output.
    longer : Fraction or None
        The next longer step that was tried, for which no proof was found; None if there is none.
    answers : mapping of str to DiskMargin
        ``input_margin`` and ``output_margin``, about the loop with this step.
    """

    step: Fraction | None
    margin: Fraction
    longer: Fraction | None
    answers: Mapping[str, DiskMargin]

    def explain(self) -> str:
        """Say what was found, in one line."""
        kept = f"a disk margin of {approximated(self.margin)} at every single input and output"
        if self.step is None and self.longer is None:
            return "not sought: no time was left"
        if self.step is None:
            return f"no proof was found for the step of the plant, with {kept}"
        end = "" if self.longer is None else f"; not proved for {approximated(self.longer)}"
        return f"{approximated(self.step)}, with {kept}, the longest one of a search{end}"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield "longest step", self.explain()

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "step": None if self.step is None else written(self.step),
            "margin": written(self.margin),
            "not_proved": None if self.longer is None else written(self.longer),
        }

    def __repr__(self) -> str:
        return f"LongestStep({self.explain()})"


def longest_step(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    margin: Entry = STANDARD_MARGIN,
    deadline: float | None = None,
) -> LongestStep:
    """Search for the longest time between samples with which a controller keeps its margins.

    Parameters
    ----------
    system : MultiChannelSystem
        A sampled plant, as `sampled_system` makes it.
    controller : Controller
        In discrete time; its numbers stay as they are.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    margin : rational
        The disk margin that every single input and every single output keeps.
    deadline : float, optional
        The time of `time.monotonic` after which no further step is tried.

    Returns
    -------
    LongestStep

    Raises
    ------
    UsageError
        If the system is no sampled plant, or the margin is not above 0.

    Notes
    -----
    Bisection on a short list of steps, up to eight times that of the plant: at most four are tried.
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
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    alpha = as_fraction(margin, where="margin")
    if not is_sampled(system):
        raise UsageError("expected a sampled plant, as sampled_system makes it", where="system")
    if alpha <= 0:
        raise UsageError("expected a margin above 0", where="margin")
    own = system.sample_time or Fraction(1)
    proofs: dict[Fraction, Mapping[str, DiskMargin]] = {}
    refused: list[Fraction] = []
    low, high = 0, len(FACTORS)
    k = 0
    while low < high:
        if deadline is not None and time.monotonic() >= deadline:
            break
        step = own * FACTORS[k]
        found = _margins(_every(system, step), controller, graph, alpha)
        if found is None:
            refused.append(step)
            high = k
        else:
            proofs[step] = found
            low = k + 1
        if k == 0 and found is None:
            break
        k = (low + high) // 2
    longest = max(proofs, default=None)
    answers = {} if longest is None else proofs[longest]
    return LongestStep(longest, alpha, min(refused, default=None), answers)


def _every(system: MultiChannelSystem, step: Fraction) -> MultiChannelSystem:
    """The plant of a sampled one with another step, as many steps late."""
    (how,) = system.subject
    return sampled_system(system.plant, step, how["late"], decimals=how["decimals"])


def _margins(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None, alpha: Fraction
) -> Mapping[str, DiskMargin] | None:
    """The margins at all single inputs and outputs, if both are proved."""
    loop, found = closed_loop(system, controller, graph), dict[str, DiskMargin]()
    for side in ("inputs", "outputs"):
        proof = margin_of(loop, "inputs" if side == "inputs" else "outputs", margin=alpha)
        if proof is None:
            return None
        found[f"{side.removesuffix('s')}_margin"] = proof
    return found
