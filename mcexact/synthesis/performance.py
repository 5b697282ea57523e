"""How well a loop performs: certified cost, bound and disk margins, within limits.

`loop_performance` proves for any stable loop

- its cost, a lower bound on the cost of every linear time-invariant controller, and where the plant
  and the controller act along the edges of a graph alone, a bound for controllers of that graph;
- the disk margin of every single input and output, and those of all inputs and all outputs at once;
- where inputs have limits, that it is stable while they are cut off there, with the anti-windup
  gains of the controller, or with gains that are chosen if it has none;
- how large inputs and outputs become after a step at an input, or of a set-point.

One symmetric matrix of the size of the loop proves each of these, and for single margins one for
each port.  Together they may have two megabytes and take the checker about five seconds, unless all
of them are asked for: both are estimated from the sizes of the matrices before a proof is sought,
so that what is proved does not depend on the machine's load.  What is left out is computed in
floating point, and said to be.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from math import inf, isfinite, isnan, nan
from typing import Any

import numpy as np

from mcexact.analysis.in_units import in_file_units
from mcexact.analysis.performance import (
    PortResponse,
    Side,
    bound_of,
    computed_bound,
    computed_cost,
    computed_margins,
    cost_of,
    default_weights,
    influences,
    margin_of,
    response_of,
    weights_in,
)
from mcexact.analysis.saturation import gains_for, gains_of, saturation_of
from mcexact.analysis.steps import SECONDS, Steps, computed_steps, step_curves, steps_of
from mcexact.answer.performance import CostBound, CostWeights, DiskMargin, LoopCost, StepPeaks
from mcexact.answer.protocol import Answer, encode
from mcexact.answer.saturation import SaturationStability
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.matrix import Matrix, finite, matrix_from_float, to_float
from mcexact.exact.rational import three_digits, written
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.model.units import Units, loop_in
from mcexact.shown import Shown

MOST_BYTES, MOST_SECONDS = 2_000_000, 5.0
"""What the certificates of a loop may have, and may take the checker, unless all are asked for."""
_BYTES = 10.0
"""Of a proof, for each entry of its symmetric matrices."""
_COST, _BOUND, _MARGIN, _JOINT = 1.6e-7, 0.8e-7, 3.5e-7, 2e-6
"""The seconds of the checker for the cube of the size of an inequality, of large loops.

Those of the cost and of the bound have many zeros; `_JOINT` is for the joint margin of so many
states and ports that the checker stops at its limit on work.
"""
_MOST_JOINT = 130
"""The largest size of an inequality of several ports that the checker decides by default."""
MARGINS: Mapping[str, tuple[Side, bool]] = {
    "input_margin": ("inputs", False),
    "output_margin": ("outputs", False),
    "all_inputs_margin": ("inputs", True),
    "all_outputs_margin": ("outputs", True),
}
"""The names of answers about disk margins: of each port by itself, or of all together."""
SIDES: tuple[Side, ...] = ("inputs", "outputs")
STEPS: Mapping[str, Steps] = {"input_steps": "inputs", "setpoint_steps": "setpoints"}
"""The names of answers about peaks after steps."""
_WORK = 30_000_000, 4000
"""The units of work that the checker grants, and for each byte; the rest is for other steps."""
_LABELS = {
    "loop_cost": "cost",
    "cost_bound": "cost of the best controller",
    "graph_cost_bound": "bound for controllers of the graph",
    "input_margin": "disk margin of each input by itself",
    "output_margin": "disk margin of each output by itself",
    "all_inputs_margin": "disk margin of all inputs together",
    "all_outputs_margin": "disk margin of all outputs together",
    "saturation": "inputs at their limits",
    "input_steps": "peak of an input after a step there",
    "setpoint_steps": "peak of an output after a step of its set-point",
}


_BARS = {
    "input_margin": "each input",
    "output_margin": "each output",
    "all_inputs_margin": "all inputs",
    "all_outputs_margin": "all outputs",
}
_LABELS_OF_STEPS = {
    "input_steps": "an input after a step there",
    "setpoint_steps": "an output after a step of its set-point",
}
_MOST_CURVES = 4
"""The single loops whose curves are kept, and the responses to steps that are drawn."""
NO_TIME = "the time limit left no time for it"
"""Why a proof was not sought before a deadline."""


@dataclass(frozen=True)
class SingleLoop:
    """A loop opened at one input or output.

    Attributes
    ----------
    name : str
        The input or output, in words.
    curve : tuple of complex
        Its transfer function L at points of the upper border of stability, in order, with the usual
        sign of feedback: the loop is 1 + L = 0.  Computed in floating point.
    """

    name: str
    curve: tuple[complex, ...]


@dataclass(frozen=True)
class Step:
    """What an input or an output does after a step there.

    Attributes
    ----------
    name : str
        The input or output, in words.
    times, values : tuple of float
        The response, computed in floating point.
    peak : Fraction or None
        What its absolute value never exceeds, if that is proved.
    """

    name: str
    times: tuple[float, ...]
    values: tuple[float, ...]
    peak: Fraction | None


@dataclass(frozen=True, repr=False)
class Performance(Shown):
    """What is proved, and what is only computed, of the performance of a stable loop.

    Attributes
    ----------
    weights : CostWeights
        Of the cost and of the bounds.
    answers : mapping of str to answer
        By the names ``loop_cost``, ``cost_bound``, ``graph_cost_bound``, ``saturation`` and those
        of `MARGINS` and `STEPS`.
    computed : mapping of str to float
        The same figures in floating point, by the same names; they prove nothing.  Of peaks it is
        the largest one where the step is.
    left_out : mapping of str to str
        Why there is no proof, by the same names.
    weakest : str
        The single input or output with the least margin, in words.
    loops : tuple of SingleLoop
        Those of the least margins, at most four.
    closed : ClosedLoop or None
        The loop, whose responses are computed when they are drawn; None if it is not stable.
    """

    weights: CostWeights
    answers: Mapping[str, Answer] = field(default_factory=dict)
    computed: Mapping[str, float] = field(default_factory=dict)
    left_out: Mapping[str, str] = field(default_factory=dict)
    weakest: str = ""
    loops: tuple[SingleLoop, ...] = ()
    closed: ClosedLoop | None = None

    @property
    def ratio(self) -> Fraction | None:
        """The proved cost divided by the proved bound for every controller, if there are both."""
        cost, bound = self.answers.get("loop_cost"), self.answers.get("cost_bound")
        if isinstance(cost, LoopCost) and isinstance(bound, CostBound) and bound.cost:
            return cost.cost / bound.cost
        return None

    @property
    def margin(self) -> Fraction | None:
        """The least disk margin of a single input or output that is proved."""
        single = [self.answers.get(name) for name in ("input_margin", "output_margin")]
        proved = [each.margin for each in single if isinstance(each, DiskMargin)]
        return min(proved) if len(proved) == len(single) else None

    @property
    def times_the_bound(self) -> float:
        """The cost divided by the bound, proved or else computed; NaN if it is not known."""
        if self.ratio is not None:
            return to_float(self.ratio)
        cost, bound = (self._seen(name) for name in ("loop_cost", "cost_bound"))
        return cost / bound if bound > 0 else nan

    @property
    def least_margin(self) -> float:
        """The least disk margin of a single input or output, proved or else computed."""
        if self.margin is not None:
            return to_float(self.margin)
        single = [self._seen(name) for name in ("input_margin", "output_margin")]
        return nan if any(map(isnan, single)) else min(single)

    @property
    def joint_margin(self) -> float:
        """The smaller one of the disk margins of all inputs and of all outputs together."""
        known = [self._margin(name) for name in ("all_inputs_margin", "all_outputs_margin")]
        return min((each for each in known if not isnan(each)), default=nan)

    def _margin(self, name: str) -> float:
        proved = self.answers.get(name)
        if isinstance(proved, DiskMargin):
            return to_float(proved.margin)
        return self._seen(name)

    def _seen(self, name: str) -> float:
        return self.computed.get(name, nan)

    @property
    def bars(self) -> dict[str, tuple[float, bool]]:
        """Each disk margin that is known, by a label, and whether it is proved."""
        known = {name: self._margin(name) for name in MARGINS}
        return {
            _BARS[name]: (value, name in self.answers)
            for name, value in known.items()
            if isfinite(value)
        }

    @property
    def time(self) -> str:
        """The time domain of the loop; empty if it is not stable."""
        return "" if self.closed is None else self.closed.plant.time

    @cached_property
    def steps(self) -> dict[str, tuple[Step, ...]]:
        """The responses with the largest peaks, at most four, by where the step is."""
        shown = dict[str, tuple[Step, ...]]()
        for name, at in STEPS.items():
            if self.closed is None:
                continue
            proved, plant = self.answers.get(name), self.closed.plant
            inputs = at == "inputs"
            names = [*_names(plant, plant.p if inputs else plant.q)]
            peaks = list[Fraction | None]([None] * len(names))
            if isinstance(proved, StepPeaks):
                rows = proved.inputs if inputs else proved.outputs
                peaks = [row[k] for k, row in enumerate(rows)]
            side = "input" if inputs else "output"
            curves = step_curves(self.closed, at, _MOST_CURVES)
            found = [
                Step(f"{side}{names[each.port]}", each.times, each.values, peaks[each.port])
                for each in curves
                if any(each.values)
            ]
            if found:
                shown[_LABELS_OF_STEPS[name]] = tuple(found)
        return shown

    def plot_steps(self, ax: Any = None) -> Any:
        """Draw the responses to steps with their proved peaks; see `mcexact.plot.step_peaks`.

        Raises
        ------
        UsageError
            If the loop is not stable, or no step has a response.
        """
        from mcexact.plot.margins import step_peaks

        if not self.steps:
            raise UsageError("no step has a response to draw")
        return step_peaks(self, ax)

    def plot(self, ax: Any = None) -> Any:
        """Draw the disk margins and the Nyquist curves of single loops; see `mcexact.plot.margins`.

        Raises
        ------
        UsageError
            If the loop is not stable, so that it has no margins.
        """
        from mcexact.plot.margins import margins

        if not self.bars:
            raise UsageError("a loop that is not stable has no margins to draw")
        return margins(self, ax)

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield a label and a text for each figure that is computed and not proved."""
        for name, reason in self.left_out.items():
            value = self._seen(name)
            known = f"{value:.3g}; " if isfinite(value) else ""
            yield _LABELS[name], f"{known}not proved: {reason}"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield from self.answers.items()
        yield from self.rows()

    def explain(self) -> str:
        """Say what is proved, in plain words, and what is not."""
        lines = [each.explain() for each in self.answers.values()]
        return "\n".join([*lines, *(f"{label}: {text}" for label, text in self.rows())])

    def __repr__(self) -> str:
        parts = []
        if self.ratio is not None:
            parts.append(f"cost ≤ {three_digits(self.ratio, up=True)} × bound")
        if self.margin is not None:
            parts.append(f"disk margin ≥ {three_digits(self.margin)}")
        return f"Performance({', '.join(parts) or 'nothing proved'})"

    def to_dict(self) -> dict[str, Any]:
        """Return the figures as plain data, those that are proved and those that are not."""
        ratio, margin = self.ratio, self.margin
        return {
            "cost_over_bound": None if ratio is None else written(ratio),
            "least_single_margin": None if margin is None else written(margin),
            "weakest": self.weakest,
            "proved": list(self.answers),
            "computed": {name: finite(value) for name, value in self.computed.items()},
            "left_out": dict(self.left_out),
        }


def loop_performance(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    weights: CostWeights | None = None,
    prove_all: bool = False,
) -> Performance:
    """Prove the cost of a loop, a bound for every controller, disk margins, and peaks after steps.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    weights : CostWeights, optional
        By default `default_weights`.
    prove_all : bool
        Whether everything is to be proved, however large the proofs are.

    Returns
    -------
    Performance

    Raises
    ------
    InputError
        If the system is no `MultiChannelSystem` or the controller no `Controller`.

    Notes
    -----
    Proposed in floating point, verified exactly.  By default the certificates have at most some two
    megabytes; the others are left out, and their figures computed.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> performance = loop_performance(plant, local_controllers(plant, [[[-3]]]))
    >>> performance
    Performance(cost ≤ 2.33 × bound, disk margin ≥ 0.998)
    >>> loop_performance(plant, local_controllers(plant, [[[0]]]))
    Performance(nothing proved)
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    return performance_of(
        closed_loop(system, controller, graph), weights=weights, prove_all=prove_all
    )


def performance_of(
    loop: ClosedLoop,
    *,
    weights: CostWeights | Mapping[str, Any] | None = None,
    prove_all: bool = False,
    proofs: bool = True,
) -> Performance:
    """Prove the cost of a loop, a bound for every controller, disk margins, and peaks after steps.

    Parameters
    ----------
    loop : ClosedLoop
    weights : CostWeights, or mapping of {"Q", "R", "W", "V"} to matrix, optional
        As for `cost_weights`; with a matrix that is not diagonal costs are left out.
    prove_all : bool
        As for `loop_performance`.
    proofs : bool
        Whether anything is proved; otherwise all figures are computed alone.
    """
    search = PerformanceSearch(loop, weights)
    return search.proved(prove_all=prove_all) if proofs else search.computed


class PerformanceSearch:
    """The search for proofs of how well a loop performs, whose figures are computed first.

    Parameters
    ----------
    loop : ClosedLoop
    weights : CostWeights, or mapping, optional
        As for `performance_of`.

    Attributes
    ----------
    computed : Performance
        All figures, of which nothing is proved; no figures of a loop that is not stable.

    Notes
    -----
    All is calculated in units near the sizes of the plant; proofs are about the loop of the file.
    """

    def __init__(
        self, loop: ClosedLoop, weights: CostWeights | Mapping[str, Any] | None = None
    ) -> None:
        self._loop, self._left_out = loop, dict[str, str]()
        if not isinstance(weights, CostWeights):
            try:
                weights = cost_weights(loop.plant, weights)
            except UsageError as unproved:
                weights = default_weights(loop.plant)
                self._left_out = {"loop_cost": unproved.message}
        self._units = Units.of(loop.plant)
        inner, weighed = loop, weights
        if self._units is not None:
            inner, weighed = loop_in(self._units, loop), weights_in(self._units, weights)
        responses = {side: response_of(inner, side) for side in SIDES}
        self._asked: dict[str, _Proof] = {}
        if any(each.unstable for each in responses.values()):
            self.computed = Performance(weights)
            return
        margins = {side: computed_margins(each) for side, each in responses.items()}
        seen, self._asked = (
            _computed(inner, weighed, margins),
            _proofs(inner, weighed, responses),
        )
        if self._left_out:
            self._asked = {name: each for name, each in self._asked.items() if name in MARGINS}
            seen = {name: value for name, value in seen.items() if name in MARGINS}
        self.computed = Performance(
            weights,
            {},
            seen,
            dict.fromkeys(seen, "not tried"),
            _weakest(loop.plant, margins),
            _single_loops(loop.plant, margins, responses),
            loop,
        )

    def proved(self, *, prove_all: bool = False, deadline: float | None = None) -> Performance:
        """Prove what certificates of a limited size prove, the most important first.

        Parameters
        ----------
        prove_all : bool
            As for `loop_performance`.
        deadline : float, optional
            The time of `time.monotonic` after which no further proof is begun.
        """
        work, left_out = _Work(prove_all=prove_all), dict(self._left_out)
        answers, asked = dict[str, Answer](), self._asked
        if asked:
            asked = asked | _saturation_proofs(self._loop) | _step_proofs(self._loop, work)
        for name, each in asked.items():
            if deadline is not None and time.monotonic() >= deadline:
                left_out[name] = NO_TIME
                continue
            if not work.allows(each):
                left_out[name] = too_large(each.bytes, each.seconds)
                continue
            try:
                proof = each.prove()
                if self._units is not None and isinstance(proof, LoopCost | CostBound | DiskMargin):
                    proof = in_file_units(proof, self._loop, self._units)
            except (LimitReached, UsageError) as reached:
                left_out[name] = reached.message
                continue
            if proof is None:
                left_out[name] = "no proof was found"
            else:
                answers[name] = proof
                work.done(each, len(encode(proof)))
        more = _computed_steps(self._loop, [name for name in STEPS if name in left_out])
        computed = {**self.computed.computed, **more}
        return replace(self.computed, answers=answers, computed=computed, left_out=left_out)


Responses = Mapping[Side, PortResponse]
Margins = Mapping[Side, tuple[list[float], float]]


def _computed(loop: ClosedLoop, weights: CostWeights, margins: Margins) -> dict[str, float]:
    """The figures in floating point."""
    seen = {"cost_bound": computed_bound(loop.plant, weights)}
    with suppress(UsageError):
        seen["loop_cost"] = computed_cost(loop, weights)
    for side, (single, together) in margins.items():
        seen[f"{side.removesuffix('s')}_margin"] = min(single, default=2.0)
        seen[f"all_{side}_margin"] = together
    return seen


def _computed_steps(loop: ClosedLoop, names: Sequence[str]) -> dict[str, float]:
    """The largest peak where a step is, in floating point, of what is not proved."""
    seen = dict[str, float]()
    for name in names:
        peaks = computed_steps(loop, STEPS[name])
        if peaks is not None:
            rows = peaks.inputs if STEPS[name] == "inputs" else peaks.outputs
            seen[name] = float(np.max(np.diag(rows), initial=0.0))
    return seen


def _weakest(plant: MultiChannelSystem, margins: Margins) -> str:
    """The input or output with the least margin, in words."""
    return next((name for *_, name in _by_margin(plant, margins)), "input")


def _by_margin(plant: MultiChannelSystem, margins: Margins) -> list[tuple[float, Side, int, str]]:
    """All inputs and outputs, the least margin first: margin, side, place and name."""
    sizes = {"inputs": plant.p, "outputs": plant.q}
    return sorted(
        (margin, side, k, f"{side.removesuffix('s')}{name}")
        for side, (single, _) in margins.items()
        for k, (margin, name) in enumerate(zip(single, _names(plant, sizes[side]), strict=True))
    )


def _single_loops(
    plant: MultiChannelSystem, margins: Margins, responses: Responses
) -> tuple[SingleLoop, ...]:
    """The loops with the least margins."""
    return tuple(
        SingleLoop(name, tuple(responses[side].nyquist(k)))
        for _, side, k, name in _by_margin(plant, margins)[:_MOST_CURVES]
    )


def _names(plant: MultiChannelSystem, size: Callable[[int], int]) -> Iterator[str]:
    """The agents of all inputs, or outputs, with numbers where an agent has several."""
    for i, name in enumerate(plant.names):
        for k in range(size(i)):
            yield f" {k + 1} of agent {name}" if size(i) > 1 else f" of agent {name}"


Proved = LoopCost | CostBound | DiskMargin | SaturationStability | StepPeaks


@dataclass(frozen=True)
class _Proof:
    """How something is proved, with the bytes of its certificate and the seconds of the checker."""

    prove: Callable[[], Proved | None]
    bytes: float
    seconds: float

    @classmethod
    def of(cls, prove: Callable[[], Proved | None], sizes: list[int], seconds: float) -> _Proof:
        """Estimate the bytes from the sizes of the matrices."""
        return cls(prove, _BYTES * sum(size * (size + 1) / 2 for size in sizes), seconds)


def _proofs(loop: ClosedLoop, weights: CostWeights, responses: Responses) -> dict[str, _Proof]:
    """What is proved, in the order of importance."""
    plant, N, n = loop.plant, loop.dimension, loop.plant.n
    p, q = (sum(map(ports, range(plant.m))) for ports in (plant.p, plant.q))
    whole = N + (q if weights.bandwidth is not None else 0)
    of_plant = _BOUND * ((n + p) ** 3 + (n + q) ** 3)
    proofs = {
        "loop_cost": _Proof.of(lambda: cost_of(loop, weights), [whole], _COST * whole**3),
        "cost_bound": _Proof.of(lambda: bound_of(plant, weights), [n, n], of_plant),
    }

    def margin(side: Side, *, together: bool) -> Callable[[], Proved | None]:
        return lambda: margin_of(loop, side, together=together, response=responses[side])

    for name, (side, together) in MARGINS.items():
        ports = p if side == "inputs" else q
        count, size = (1 if together else ports), N + ports
        written, seconds = margin_size(N, count)
        if together and size > _MOST_JOINT:
            seconds = _JOINT * size**3
        proofs[name] = _Proof(margin(side, together=together), written, seconds)
    messages = bool(loop.controller.edges())
    # a derived system keeps its own graph
    linked = plant if plant.subject else plant.with_neighbors(loop.graph)
    graph = influences(linked, messages=messages)
    if graph is not None:
        groups = len({*graph.states}) + 1
        proofs["graph_cost_bound"] = _Proof.of(
            lambda: bound_of(plant, weights, graph), 2 * groups * [n], groups * of_plant
        )
    return proofs


def margin_size(states: int, inequalities: int) -> tuple[float, float]:
    """The bytes of a proof of disk margins by so many inequalities, and the checker's seconds."""
    entries = inequalities * states * (states + 1) / 2
    return _BYTES * entries, inequalities * _MARGIN * (states + 1) ** 3


def too_large(written: float, seconds: float) -> str:
    """The reason why a proof of so many bytes, and so many seconds of the checker, is left out."""
    size = f"about {written / 1e6:.1f} MB, and takes {seconds:.0f} s to check"
    return f"a proof has {size} (--prove-all)"


def _saturation_proofs(loop: ClosedLoop) -> dict[str, _Proof]:
    """That the loop is stable while inputs are cut off, if any have limits."""
    limits = loop.controller.limits_for(loop.plant)
    if limits is None:
        return {}
    size = loop.dimension + sum(pair is not None for own in limits for pair in own)

    def prove() -> Proved | None:
        if any(agent.back_calculation is not None for agent in loop.controller.agents):
            return saturation_of(loop, limits, gains_of(loop))
        return gains_for(loop, limits)[1]

    return {"saturation": _Proof.of(prove, [loop.dimension], _JOINT * size**3)}


def _step_proofs(loop: ClosedLoop, work: _Work) -> dict[str, _Proof]:
    """The peaks after steps, which take the checker what is left to it at most."""
    N, plant = loop.dimension, loop.plant
    p, q = (sum(map(ports, range(plant.m))) for ports in (plant.p, plant.q))
    rows = {"inputs": p, "setpoints": 0 if loop.reference.is_zero() else q}
    sides = {name: at for name, at in STEPS.items() if rows[at]}

    def proof(at: Steps) -> _Proof:
        size = _BYTES * (N * (N + 1) / 2 + rows[at] * (p + q))

        def prove() -> Proved | None:
            # how long it takes is known when the response is computed
            most = min(_WORK[0] + _WORK[1] * size, work.seconds / SECONDS / len(sides))
            return steps_of(loop, at, work=inf if work.all else most)

        return _Proof(prove, size, 0.0)

    return {name: proof(at) for name, at in sides.items()}


_FIELDS = {"Q": "states", "R": "inputs", "W": "disturbances", "V": "noise"}


def cost_weights(plant: MultiChannelSystem, chosen: Mapping[str, Any] | None = None) -> CostWeights:
    """Return the chosen weights, completed by those of `default_weights`.

    Parameters
    ----------
    plant : MultiChannelSystem
    chosen : mapping of {"Q", "R", "W", "V"} to matrix, optional
        As for `Weights.of`, which says what is wrong with them.

    Raises
    ------
    UsageError
        If a matrix is not diagonal: certificates have diagonal weights.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> cost_weights(plant, {"R": [["1/4"]]}).inputs
    (Fraction(1, 4),)
    """
    weights = default_weights(plant)
    for name, entries in (chosen or {}).items():
        if isinstance(entries, np.ndarray):
            M = matrix_from_float(entries, "dyadic", where=name)
        else:
            M = entries if isinstance(entries, Matrix) else Matrix.from_rows(entries)
        if any(i != j for i, j, _ in M.nonzero()):
            raise UsageError("costs are proved for diagonal weights alone", where=f"weights.{name}")
        diagonal: dict[str, Any] = {_FIELDS[name]: tuple(M[i, i] for i in range(M.nrows))}
        weights = replace(weights, **diagonal)
    return weights


class _Work:
    """What certificates may still have, and what they may still take the checker."""

    def __init__(self, *, prove_all: bool) -> None:
        self.all = prove_all
        self.bytes, self.seconds = float(MOST_BYTES), MOST_SECONDS

    def allows(self, proof: _Proof) -> bool:
        """Whether a proof is within what is left."""
        return self.all or (proof.bytes <= self.bytes and proof.seconds <= self.seconds)

    def done(self, proof: _Proof, written: int) -> None:
        """Take off what a proof has, and takes."""
        self.bytes -= written
        self.seconds -= proof.seconds
