"""The real loop: a controller as it runs, beside the loop that is certified.

What is certified is a linear loop: exact numbers, inputs without limits, outputs without steps.
`simulate_real` runs what is installed: the plant at the samples, inputs that are held and applied
some steps late, limits of inputs, converters with finite steps, and the code of the agents with its
own arithmetic.  In each step k,

    y = C x(k),  what is measured: y in steps of the converters,
    v = what the code gives,  u = v within the limits, in steps of the converters,
    x(k+1) = A_h x(k) + B_h (u(k − d) + w),

A_h and B_h the nearest doubles to the exact samples, the sums from the left to the right.  Beside
it runs the ideal loop: of a controller in discrete time the same plant at the samples, as late, in
doubles; of one in continuous time the loop in continuous time.  `RealRun` compares both: distances,
settling times and control effort.  All of this is computed for one start, and proves nothing.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice
from typing import Any, Literal, Protocol

from mcexact.derived.sampling import DECIMALS, sampled_system, tustin
from mcexact.errors import InputError, LimitReached, UsageError, one_of, several, shown_value
from mcexact.exact.matrix import Matrix, Rounding, as_requested, to_float
from mcexact.exact.rational import as_fraction, rational_text
from mcexact.exact.roots import is_discrete
from mcexact.export.code import in_code
from mcexact.export.compiled import compiled_agents
from mcexact.export.equations import AgentRun, AgentStep, Kind, steps_of
from mcexact.export.fixed import FixedAgent, FixedPoint
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem, with_links
from mcexact.plot.responses import real_responses
from mcexact.shown import Shown
from mcexact.simulation.envelope import LARGEST, state_at_rest
from mcexact.simulation.network import (
    Drive,
    InitialState,
    Signal,
    Snapshot,
    initial_state,
    numbers_of,
    signal_of,
)
from mcexact.simulation.trajectory import Trajectory, chosen_grid, simulate
from mcexact.synthesis.optimum.diagnosis import rounded_controller

MOST_STEPS = 1_000_000
"""The most steps of a run."""
MOST_CHOSEN = 5000
"""The most steps that are chosen for a plant at its samples."""
LONGER = 2
"""How many times longer the run is than one of the ideal loop, as limits make it slower."""
PRECISE = 30
"""The decimals to which the plant is sampled before its entries become doubles."""
BAND = 0.02
"""An output has settled within this part of its largest distance from rest in the ideal loop."""


# What is real: limits, converters, code.


@dataclass(frozen=True)
class Quantizer:
    """A converter: values base + k·step, the nearest one, within its range if it has one.

    Attributes
    ----------
    step : Fraction
        The distance of its values, above 0.
    low, high : Fraction or None
        The least and the largest value; without them all multiples of the step.

    Examples
    --------
    >>> tenths = Quantizer(Fraction(1, 10))
    >>> tenths(0.26)
    0.30000000000000004
    >>> converter = Quantizer.of_bits(8, -1, 1)
    >>> converter(0.3), converter(5.0), converter.step
    (0.296875, 0.9921875, Fraction(1, 128))
    """

    step: Fraction
    low: Fraction | None = None
    high: Fraction | None = None

    def __post_init__(self) -> None:
        if self.step <= 0:
            raise UsageError(f"expected a step above 0, found {rational_text(self.step)}")

    @classmethod
    def of_bits(cls, bits: int, low: Any, high: Any) -> Quantizer:
        """Return a converter with 2**bits values, the least one low, and high one step too far.

        Raises
        ------
        UsageError
            If there are no bits, more than 52, or low is not below high.
        """
        if isinstance(bits, bool) or not isinstance(bits, int) or not 1 <= bits <= 52:
            raise UsageError(f"expected 1 to 52 bits, found {shown_value(bits)}")
        ends = [as_fraction(each, where="range") for each in (low, high)]
        if not ends[0] < ends[1]:
            raise UsageError("expected a range from a number to a larger one")
        step = (ends[1] - ends[0]) / 2**bits
        return cls(step, ends[0], ends[1] - step)

    def __call__(self, value: float) -> float:
        """Return the nearest value of the converter; halfway the larger one."""
        base, step = to_float(self.low or Fraction(0)), to_float(self.step)
        steps = (value - base) / step
        if not math.isfinite(steps):
            raise _too_large()
        nearest = base + math.floor(steps + 0.5) * step
        if self.low is None or self.high is None:
            return nearest
        return min(max(nearest, base), to_float(self.high))

    def __str__(self) -> str:
        within = ""
        if self.low is not None and self.high is not None:
            within = f" from {to_float(self.low):.6g} to {to_float(self.high):.6g}"
        return f"{to_float(self.step):.3g}{within}"


Limit = tuple[Fraction | None, Fraction | None]
"""The least and the largest value of an input; None where there is no limit."""
Code = Literal["interpreted", "compiled"]


class AgentCode(Protocol):
    """The code of an agent, with the signals of its step as doubles."""

    @property
    def step(self) -> AgentStep: ...
    def sent_to(self, follower: int) -> list[float]: ...
    def __call__(self, y: Sequence[float], r: Sequence[float], received: Any) -> list[float]: ...


@dataclass(frozen=True)
class Realization:
    """What distinguishes the real loop from the ideal one.

    Attributes
    ----------
    step : Fraction or None
        The time between samples; None for a plant in discrete time without one.
    late : int
        By how many steps inputs are applied late.
    limits : tuple of (Fraction or None, Fraction or None)
        Those of every input, in the order of the channels: the tighter ends of those at which the
        code cuts off and those of the actuators.
    outputs, inputs : tuple of Quantizer or None
        The converters of every output and every input.
    code : str
        The arithmetic of the agents, in words.
    """

    step: Fraction | None
    late: int
    limits: tuple[Limit, ...]
    outputs: tuple[Quantizer | None, ...]
    inputs: tuple[Quantizer | None, ...]
    code: str

    def facts(self) -> list[str]:
        """Say what is real about the loop."""
        lines = []
        if self.step is not None:
            late = f", inputs {self.late} step{'s' * (self.late > 1)} late" if self.late else ""
            lines.append(f"sampled every {rational_text(self.step)}{late}")
        lines.append(f"code: {self.code}")
        limited = [each for each in self.limits if each != (None, None)]
        if limited:
            lines.append(f"limits of inputs: {', '.join(map(_limit_text, dict.fromkeys(limited)))}")
        for what, used in (("outputs", self.outputs), ("inputs", self.inputs)):
            known = [str(each) for each in used if each is not None]
            if known:
                lines.append(f"{what} in steps of {', '.join(dict.fromkeys(known))}")
        return lines

    def to_dict(self) -> dict[str, Any]:
        """Return plain data; numbers as floats."""

        def number(value: Fraction | None) -> float | None:
            return None if value is None else to_float(value)

        def converter(each: Quantizer | None) -> Any:
            if each is None:
                return None
            return {key: number(getattr(each, key)) for key in ("step", "low", "high")}

        return {
            "step": number(self.step),
            "late": self.late,
            "code": self.code,
            "limits": [list(map(number, each)) for each in self.limits],
            "quantized_outputs": list(map(converter, self.outputs)),
            "quantized_inputs": list(map(converter, self.inputs)),
        }


def _limit_text(limit: Limit) -> str:
    low, high = limit
    if high is None:
        return "none" if low is None else f"from {to_float(low):g} on"
    return (
        f"up to {to_float(high):g}" if low is None else f"{to_float(low):g} to {to_float(high):g}"
    )


# What is compared.


@dataclass(frozen=True)
class OutputFigures:
    """How an output behaves in both loops.

    Attributes
    ----------
    name : str
    rest : float
        Where it comes to rest in the ideal loop, or its last value there.
    settled : tuple of (Fraction or None, Fraction or None)
        Ideal and real: the time from the last change of a signal until it stays within 2 % of its
        largest distance from rest in the ideal loop; None if it does not within the run.
    peak : tuple of (float, float)
        Ideal and real: its largest distance from rest after the last change.
    apart : float
        The largest distance of the real output from the ideal one.
    """

    name: str
    rest: float
    settled: tuple[Fraction | None, Fraction | None]
    peak: tuple[float, float]
    apart: float


@dataclass(frozen=True)
class InputFigures:
    """How an input behaves in both loops.

    Attributes
    ----------
    name : str
    peak : tuple of (float, float)
        Ideal and real: its largest modulus.
    effort : tuple of (float, float)
        Ideal and real: the sum of u² times the time between samples.
    at_limit : int
        The number of steps in which the real input is at a limit.
    """

    name: str
    peak: tuple[float, float]
    effort: tuple[float, float]
    at_limit: int


@dataclass(frozen=True, repr=False)
class RealRun(Shown):
    """The real loop beside the ideal one.

    Attributes
    ----------
    times : tuple of Fraction
        The samples in the plant's units of time, or steps if these are not known.
    ideal, real : Trajectory
        At the same times, which each of them counts in steps, or in time if the controller is in
        continuous time.  The inputs are those that are set, before they are applied late.
    measured, computed : tuple of lists of float
        For each time all outputs as the agents measured them, and all inputs as the code gave
        them: cut off at the limits of the controller if it has any, but not yet at those of the
        actuators, and not converted.
    realization : Realization
    outputs : tuple of OutputFigures
    inputs : tuple of InputFigures
    """

    times: tuple[Fraction, ...]
    ideal: Trajectory
    real: Trajectory
    measured: tuple[list[float], ...]
    computed: tuple[list[float], ...]
    realization: Realization
    outputs: tuple[OutputFigures, ...]
    inputs: tuple[InputFigures, ...]

    def __repr__(self) -> str:
        facts = "; ".join(self.realization.facts())
        return f"RealRun({len(self.times)} samples to {to_float(self.times[-1]):g}; {facts})"

    def explain(self) -> str:
        """Say in plain words what was run, and how both loops settle."""
        lines = [f"{'; '.join(self.realization.facts())}."]
        for label, ideal, real in self.compared():
            lines.append(f"{label}: {ideal} in the ideal loop, {real} in the real one.")
        return "\n".join(lines)

    def _labeled(self) -> Iterator[tuple[str, str]]:
        for label, ideal, real in self.compared():
            yield label, f"{ideal} → {real}"

    @property
    def unit(self) -> str:
        """What the times count: "time", or "step" where the time between samples is not known."""
        return "step" if self.realization.step is None else "time"

    def compared(self) -> list[tuple[str, str, str]]:
        """Return rows of a label and of texts for the ideal and for the real loop."""
        rows = list[tuple[str, str, str]]()
        for out in self.outputs:
            label = f"{out.name} settles after"
            rows.append((label, _time_text(out.settled[0]), _time_text(out.settled[1])))
        for out in self.outputs:
            rows.append((f"{out.name}: largest distance from rest", *_in_digits(out.peak)))
        for put in self.inputs:
            rows.append((f"{put.name}: largest modulus", *_in_digits(put.peak)))
        for put in self.inputs:
            rows.append((f"{put.name}: effort", *_in_digits(put.effort)))
        for put in self.inputs:
            if put.at_limit:
                rows.append((f"{put.name}: steps at a limit", "", str(put.at_limit)))
        return rows

    def signals(self) -> dict[str, list[float]]:
        """Return all signals of both loops by name, each at all times.

        ``measured`` and ``computed`` are what the code of the agents takes and gives, bit by bit.
        """
        columns: dict[str, list[float]] = {"t": list(map(to_float, self.times))}
        states = zip(*(each.plant for each in self.real.snapshots), strict=True)
        columns |= {f"x[{k + 1}]": list(values) for k, values in enumerate(states)}
        for kind, name, rows in (
            ("outputs", "measured", self.measured),
            ("inputs", "computed", self.computed),
        ):
            columns |= self.real.values(kind)
            names = [f"{name} {each}" for each in self.real.names(kind)]
            columns |= dict(zip(names, map(list, zip(*rows, strict=True)), strict=False))
        columns |= self.real.values("reference")
        for kind in ("outputs", "inputs"):
            columns |= {f"ideal {name}": values for name, values in self.ideal.values(kind).items()}
        return columns

    def plot(self, ax: Any = None) -> Any:
        """Draw outputs and inputs of both loops; see `mcexact.plot.responses.real_responses`.

        Parameters
        ----------
        ax : two axes of matplotlib, optional

        Returns
        -------
        matplotlib.figure.Figure
        """
        return real_responses(self, ax)


def _in_digits(both: tuple[float, float]) -> tuple[str, str]:
    return f"{both[0]:.4g}", f"{both[1]:.4g}"


def _time_text(value: Fraction | None) -> str:
    return "not within the run" if value is None else f"{to_float(value):.4g}"


# The run.


def simulate_real(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    step: Any = None,
    late: int = 0,
    limits: Sequence[Any] | None = None,
    quantized_outputs: Any = None,
    quantized_inputs: Any = None,
    fixed: FixedPoint | None = None,
    code: Code = "interpreted",
    initial: Sequence[Any] | None = None,
    horizon: Any = None,
    reference: Sequence[Any] | None = None,
    steps: Sequence[tuple[Any, Sequence[Any]]] = (),
    ramps: Sequence[tuple[Any, Sequence[Any]]] = (),
    disturbances: Sequence[tuple[Any, Sequence[Any]]] = (),
    rounding: Rounding | None = "dyadic",
) -> RealRun:
    """Run a controller as it is installed, beside the ideal loop.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant, in continuous time with a step, or in discrete time.
    controller : Controller
        For the samples, or in continuous time; then Tustin's rule takes it to the samples, and its
        entries are rounded to 12 digits.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    step : rational or float, optional
        The time h between samples of a plant in continuous time.
    late : int
        By how many steps its inputs are applied late.
    limits : sequence of (low, high), optional
        Those of the actuators for every input, in the order of the channels, None where there is
        none; by default those of the plant if the controller has no limits.  The code of a
        controller with limits cuts off at these first, whatever is given here.
    quantized_outputs, quantized_inputs : optional
        A `Quantizer` or a step for all outputs or inputs, or a list with one for each, None for a
        converter that is exact.
    fixed : FixedPoint, optional
        The arithmetic of the agents in integers; by default doubles.
    code : {"interpreted", "compiled"}
        Whether the sums of the exported code are computed here, in its order, or the exported C is
        compiled and called; both give the same bits.
    initial : sequence of numbers, optional
        x(0), by default all ones; agents start at 0, as their code does.
    horizon : rational, optional
        The time that is run, in steps for a plant in discrete time; by default twice what is chosen
        from the slowest mode of the ideal loop.
    reference, steps, ramps, disturbances
        As in `simulate`, with times in the units of the plant.  Disturbances act on the inputs at
        the plant, from the first sample at or after their time on.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats among the numbers become exact.

    Returns
    -------
    RealRun

    Raises
    ------
    UsageError
        If the plant needs a step or must not have one, the run has more than a million steps, or
        code is to be compiled and there is no compiler.
    InputError
        If the controller does not fit, a number is malformed, or limits leave an input no room
        beside those of the controller.
    LimitReached
        If a number exceeds double precision.

    Notes
    -----
    Floating point; nothing is proved.  O(n² + number of terms of the programs) for each step.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> sampled = sampled_system(plant, "1/10")
    >>> controller = local_controllers(sampled, [[[-2]]])
    >>> run = simulate_real(plant, controller, step="1/10", limits=[("-3/4", "3/4")], horizon=5)
    >>> [figures.peak for figures in run.inputs], run.inputs[0].at_limit
    ([(2.0, 0.75)], 9)
    >>> ideal, real = run.outputs[0].settled
    >>> float(ideal), float(real)
    (1.8, 2.2)
    >>> simulate_real(plant, controller)
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: step: the plant is in continuous time: give the time between samples
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    one_of(code, ("interpreted", "compiled"), "code")
    clock = _Clock.of(system, step, late)
    held = system if clock.step is None else sampled_system(system, clock.step, late)
    program = controller
    if not is_discrete(controller.time) and clock.step is not None:
        program = rounded_controller(tustin(controller, held), DECIMALS)
    plant, links = with_links(held, graph)
    program.require_fits(plant, links)
    outputs, inputs = ([size(i) for i in range(plant.m)] for size in (plant.q, plant.p))
    realization = Realization(
        clock.step,
        late,
        _effective_limits(plant, in_code(program, fixed), limits, rounding),
        _converters(quantized_outputs, sum(outputs), "quantized_outputs", rounding),
        _converters(quantized_inputs, sum(inputs), "quantized_inputs", rounding),
        ("compiled C, " if code == "compiled" else "")
        + ("double precision" if fixed is None else str(fixed)),
    )
    agents = _agents(code, program, fixed)
    changes = reference, steps, ramps, rounding, ("reference", "steps", "ramps")
    pushed = None, disturbances, (), rounding, ("", "disturbances", "")
    drive = Drive(signal_of(outputs, *changes), signal_of(inputs, *pushed))
    start = initial_state(initial, system, controller, rounding)
    end = None if horizon is None else numbers_of([horizon], rounding, "horizon")[0]
    if is_discrete(controller.time):
        ideal = _ideal_at_samples(held, controller, graph, clock, drive, start, end)
    else:
        ideal = _ideal_in_time(system, controller, graph, clock, drive, start, end)
    times = tuple(clock.unit * k for k in range(len(ideal.times)))
    loop = _Loop(_Plant(system, clock, start), links, agents, realization)
    rounds = [loop.round(drive, time) for time in times]
    real = replace(
        ideal,
        arithmetic=realization.code,
        snapshots=tuple(each.snapshot for each in rounds),
        warning=None,
        note=None,
    )
    last = max((change.time for change in drive.changes), default=Fraction(0))
    after = next((k for k, time in enumerate(times) if time >= last), len(times) - 1)
    return RealRun(
        times,
        ideal,
        real,
        tuple(each.measured for each in rounds),
        tuple(each.computed for each in rounds),
        realization,
        tuple(_output_figures(ideal, real, times, after)),
        tuple(_input_figures(ideal, real, clock.unit, rounds)),
    )


@dataclass(frozen=True)
class _Clock:
    """The samples: the step of a plant in continuous time, and by how much inputs are late."""

    step: Fraction | None
    late: int

    @classmethod
    def of(cls, system: MultiChannelSystem, step: Any, late: int) -> _Clock:
        """Check the arguments."""
        if is_discrete(system.time):
            if step is not None or late:
                raise UsageError("the plant is in discrete time already", where="step")
            return cls(None, 0)
        if step is None:
            raise UsageError(
                "the plant is in continuous time: give the time between samples", where="step"
            )
        return cls(as_requested(step, where="step"), late)

    @property
    def unit(self) -> Fraction:
        """The time between samples, or 1 where steps are counted."""
        return Fraction(1) if self.step is None else self.step


def _effective_limits(
    plant: MultiChannelSystem,
    code: Controller,
    given: Sequence[Any] | None,
    rounding: Rounding | None,
) -> tuple[Limit, ...]:
    """The tighter ends of the limits of the code and of the actuators."""
    inputs = sum(plant.p(i) for i in range(plant.m))
    listed = code.limits_for(plant)
    own = limits_of(None if listed is None else [pair for each in listed for pair in each], inputs)
    if given is None:
        return own
    actuators = limits_of(given, inputs, rounding)
    if all(agent.limits is None for agent in code.agents):
        return actuators
    return tuple(
        _tighter(a, b, f"limits[{k}]") for k, (a, b) in enumerate(zip(own, actuators, strict=True))
    )


def _tighter(own: Limit, given: Limit, where: str) -> Limit:
    low = max((end for end in (own[0], given[0]) if end is not None), default=None)
    high = min((end for end in (own[1], given[1]) if end is not None), default=None)
    if low is not None and high is not None and low >= high:
        raise InputError("expected limits that meet those of the controller", where=where)
    return low, high


def limits_of(
    limits: Sequence[Any] | None, inputs: int, rounding: Rounding | None = None
) -> tuple[Limit, ...]:
    """Check limits of inputs, one pair (low, high) for each input.

    Parameters
    ----------
    limits : sequence of (low, high) or None
        None where there is no limit.
    inputs : int
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats become exact.

    Raises
    ------
    InputError
        If there are too few or too many, or a low limit is not below the high one.

    Examples
    --------
    >>> limits_of([(-1, "1/2"), None, (0, None)], 3)
    ((Fraction(-1, 1), Fraction(1, 2)), (None, None), (Fraction(0, 1), None))
    """
    if limits is None:
        return ((None, None),) * inputs
    listed = several(limits, "limits", "pairs (low, high)")
    if len(listed) != inputs:
        raise InputError(
            f"expected {inputs} pairs (low, high), found {len(listed)}", where="limits"
        )
    return tuple(_limit(pair, f"limits[{k}]", rounding) for k, pair in enumerate(listed))


def _limit(pair: Any, where: str, rounding: Rounding | None) -> Limit:
    if pair is None:
        return None, None
    if isinstance(pair, str) or not hasattr(pair, "__len__") or len(pair) != 2:
        raise InputError(f"expected a pair (low, high), found {shown_value(pair)}", where=where)
    low, high = (None if each is None else numbers_of([each], rounding, where)[0] for each in pair)
    if low is not None and high is not None and low >= high:
        raise InputError("expected a low limit below the high one", where=where)
    return low, high


def _converters(
    given: Any, count: int, where: str, rounding: Rounding | None
) -> tuple[Quantizer | None, ...]:
    """One converter for each signal."""
    if isinstance(given, (list, tuple)):
        if len(given) != count:
            raise InputError(f"expected {count} converters, found {len(given)}", where=where)
        return tuple(_converter(each, f"{where}[{k}]", rounding) for k, each in enumerate(given))
    return (_converter(given, where, rounding),) * count


def _converter(given: Any, where: str, rounding: Rounding | None) -> Quantizer | None:
    if given is None or isinstance(given, Quantizer):
        return given
    return Quantizer(numbers_of([given], rounding, where)[0])


def _agents(code: Code, program: Controller, fixed: FixedPoint | None) -> Sequence[AgentCode]:
    if code == "compiled":
        return compiled_agents(program, fixed)
    if fixed is not None:
        return [FixedAgent(step, fixed) for step in steps_of(program)]
    return [AgentRun(step) for step in steps_of(program)]


# The ideal loop.


def _changes(
    signal: Signal, unit: Fraction, earlier: int = 0
) -> tuple[list[tuple[Fraction, list[Fraction]]], list[tuple[Fraction, list[Fraction]]]]:
    """The steps and the ramps of a signal on a clock of another unit, some units earlier."""
    steps, ramps = [], []
    for change in signal.changes:
        numbers = [x for M in change.columns for (x,) in M.rows()]
        time = max(change.time / unit - earlier, Fraction(0))
        if change.ramp:
            ramps.append((time, [x * unit for x in numbers]))
        else:
            steps.append((time, numbers))
    return steps, ramps


def _ideal_at_samples(
    held: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None,
    clock: _Clock,
    drive: Drive,
    start: InitialState,
    end: Fraction | None,
) -> Trajectory:
    """The loop of the plant at the samples, in doubles; disturbances are as late as inputs.

    So they enter as much earlier, and those of the first steps are under way at the start.
    """
    last = max((change.time for change in drive.changes), default=Fraction(0)) / clock.unit
    count = MOST_CHOSEN
    if end is not None:
        count = math.ceil(end / clock.unit)
        if not 0 <= count <= MOST_STEPS:
            raise UsageError(
                f"expected a horizon of 0 to {MOST_STEPS} steps, found {count}", where="horizon"
            )
    else:
        times = chosen_grid(closed_loop(held, controller, graph), last, most=count).times
        count = LONGER * (len(times) - 1)
    under_way = [
        x
        for k in range(clock.late)
        for M in drive.disturbances.at(clock.unit * k)
        for (x,) in M.rows()
    ]
    steps, ramps = _changes(drive.references, clock.unit)
    pushed, _ = _changes(drive.disturbances, clock.unit, clock.late)
    return simulate(
        held,
        controller,
        graph,
        initial=replace(start, plant=(*start.plant, *under_way)),
        horizon=count,
        steps=steps,
        ramps=ramps,
        disturbances=pushed,
        arithmetic="float",
    )


def _ideal_in_time(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None,
    clock: _Clock,
    drive: Drive,
    start: InitialState,
    end: Fraction | None,
) -> Trajectory:
    """The loop in continuous time, at the samples."""
    last = max((change.time for change in drive.changes), default=Fraction(0))
    if end is None:
        end = LONGER * chosen_grid(closed_loop(system, controller, graph), last).times[-1]
    count = math.ceil(end / clock.unit)
    if not 1 <= count <= MOST_STEPS:
        raise UsageError(
            f"expected a horizon of 1 to {MOST_STEPS} steps, found {count}", where="horizon"
        )
    steps, ramps = _changes(drive.references, Fraction(1))
    pushed, _ = _changes(drive.disturbances, Fraction(1))
    return simulate(
        system,
        controller,
        graph,
        initial=start,
        horizon=clock.unit * count,
        points=count,
        steps=steps,
        ramps=ramps,
        disturbances=pushed,
    )


# The real loop, step by step.

Entries = list[list[tuple[int, float]]]
"""The entries of each row of a matrix that are not 0, with their columns."""


def _entries(M: Matrix) -> Entries:
    rows: Entries = [[] for _ in range(M.nrows)]
    for i, j, x in M.nonzero():
        rows[i].append((j, to_float(Fraction(x, M.denominator))))
    return rows


def _times(rows: Entries, column: Sequence[float]) -> list[float]:
    """The product with a column, the sums from the left to the right."""
    product = []
    for row in rows:
        total = 0.0
        for j, x in row:
            total += x * column[j]
        product.append(total)
    return product


class _Plant:
    """The plant at the samples, and the inputs that are under way to it."""

    def __init__(self, system: MultiChannelSystem, clock: _Clock, start: InitialState) -> None:
        held = system
        if clock.step is not None:
            held = sampled_system(system, clock.step, decimals=PRECISE)
        B = held.input_matrix()
        self._A, self._B, self._C = map(_entries, (held.A, B, held.output_matrix()))
        self.state = list(map(to_float, start.plant))
        self._under_way = deque([[0.0] * B.ncols] * clock.late)

    def outputs(self) -> list[float]:
        """All outputs."""
        return _times(self._C, self.state)

    def advance(self, inputs: list[float], disturbances: Sequence[float]) -> None:
        """Go on to the next sample.

        Raises
        ------
        LimitReached
            If a number exceeds double precision.
        """
        self._under_way.append(inputs)
        applied = [u + w for u, w in zip(self._under_way.popleft(), disturbances, strict=True)]
        moved = zip(_times(self._A, self.state), _times(self._B, applied), strict=True)
        self.state = [a + b for a, b in moved]
        if not all(map(math.isfinite, self.state)):
            raise _too_large()


def _too_large() -> LimitReached:
    return LimitReached(
        "the real loop has numbers beyond the range of double precision; use a shorter horizon"
    )


@dataclass(frozen=True)
class _Round:
    """What happened in a step."""

    snapshot: Snapshot
    measured: list[float]
    computed: list[float]
    at_limit: list[bool]


class _Loop:
    """Plant, converters, messages and the code of the agents."""

    def __init__(
        self,
        plant: _Plant,
        links: NeighborGraph,
        agents: Sequence[AgentCode],
        realization: Realization,
    ) -> None:
        self.plant, self.agents, self.realization = plant, agents, realization
        self._limits = [
            (-math.inf if a is None else to_float(a), math.inf if b is None else to_float(b))
            for a, b in realization.limits
        ]
        self._late: dict[tuple[int, int], deque[Any]] = {
            (j, i): deque([None] * links.delay(i, j)) for j, i in links.edges() if i != j
        }

    def round(self, drive: Drive, time: Fraction) -> _Round:
        """Measure, send, receive, compute, and set the inputs."""
        outputs, state = self.plant.outputs(), self.plant.state
        measured = _converted(self.realization.outputs, outputs)
        references = [_floats(M) for M in drive.references.at(time)]
        pushed = [_floats(M) for M in drive.disturbances.at(time)]
        parts = _split(measured, [len(r) for r in references])
        received = self._received(parts)
        inputs = []
        for agent, y, r, w, heard in zip(
            self.agents, parts, references, pushed, received, strict=True
        ):
            inputs.append(agent(y, r, heard) or [0.0] * len(w))
        computed = [v for part in inputs for v in part]
        limited = [
            min(max(v, low), high) for v, (low, high) in zip(computed, self._limits, strict=True)
        ]
        set_ = _converted(self.realization.inputs, limited)
        self.plant.advance(set_, [w for part in pushed for w in part])
        nothing: list[list[Any]] = [[] for _ in self.agents]
        return _Round(
            Snapshot(
                state,
                nothing,
                nothing,
                _split(outputs, [len(r) for r in references]),
                _split(set_, [len(part) for part in inputs]),
                references,
            ),
            measured,
            computed,
            [v in ends for v, ends in zip(limited, self._limits, strict=True)],
        )

    def _received(self, measured: Sequence[list[float]]) -> list[dict[tuple[Kind, int], Any]]:
        """Send all messages, and return what arrives at each agent."""
        received: list[dict[tuple[Kind, int], Any]] = [{} for _ in self.agents]
        for (j, i), under_way in self._late.items():
            sender = self.agents[j]
            x = sender.sent_to(i) if i in sender.step.sent else []
            under_way.append((measured[j], x))
            arrived = under_way.popleft() or ([0.0] * len(measured[j]), [0.0] * len(x))
            received[i]["y", j], received[i]["x", j] = arrived
        return received


def _floats(M: Matrix) -> list[float]:
    return [to_float(x) for (x,) in M.rows()]


def _split(values: Sequence[float], sizes: Sequence[int]) -> list[list[float]]:
    rest = iter(values)
    return [list(islice(rest, size)) for size in sizes]


def _converted(converters: Sequence[Quantizer | None], values: Sequence[float]) -> list[float]:
    return [
        value if each is None else each(value)
        for each, value in zip(converters, values, strict=True)
    ]


# The comparison.


def _output_figures(
    ideal: Trajectory, real: Trajectory, times: Sequence[Fraction], after: int
) -> Iterator[OutputFigures]:
    """Compare the outputs from the last change of a signal on."""
    rest = _outputs_at_rest(ideal)
    both = zip(ideal.values("outputs").items(), real.values("outputs").values(), strict=True)
    for k, ((name, wanted), found) in enumerate(both):
        level = wanted[-1] if rest is None else rest[k]
        away = [[abs(y - level) for y in values[after:]] for values in (wanted, found)]
        peak = max(away[0]), max(away[1])
        within = BAND * peak[0]
        settled = _settled(times[after:], away[0], within), _settled(times[after:], away[1], within)
        apart = max(abs(a - b) for a, b in zip(wanted, found, strict=True))
        yield OutputFigures(name, level, settled, peak, apart)


def _outputs_at_rest(ideal: Trajectory) -> list[float] | None:
    """The outputs at rest, if the loop is small and signals stay constant in the end."""
    drive, loop = ideal.drive, ideal.loop
    ramps = any(change.ramp for change in drive.changes)
    if ramps or not 0 < loop.dimension <= LARGEST:
        return None
    last = max((change.time for change in drive.changes), default=Fraction(0))
    rest = state_at_rest(loop, drive, last)
    if rest is None:
        return None
    return _floats(loop.plant.output_matrix() @ loop.pick("x") @ rest)


def _settled(times: Sequence[Fraction], away: Sequence[float], within: float) -> Fraction | None:
    """The time from the first one after which all distances are within a band."""
    outside = [k for k, distance in enumerate(away) if distance > within]
    if not outside:
        return Fraction(0)
    k = outside[-1] + 1
    return times[k] - times[0] if k < len(times) else None


def _input_figures(
    ideal: Trajectory, real: Trajectory, unit: Fraction, rounds: Sequence[_Round]
) -> Iterator[InputFigures]:
    """Compare the inputs."""
    h = to_float(unit)
    both = zip(ideal.values("inputs").items(), real.values("inputs").values(), strict=True)
    for k, ((name, wanted), found) in enumerate(both):
        peaks = [max(map(abs, values)) for values in (wanted, found)]
        effort = [h * sum(u * u for u in values) for values in (wanted, found)]
        beyond = sum(each.at_limit[k] for each in rounds)
        yield InputFigures(name, (peaks[0], peaks[1]), (effort[0], effort[1]), beyond)
