"""Agents on a network: arithmetic, signals, messages and initial states.

A simulation runs the agents as programs that exchange messages, and never uses the matrix of the
closed loop.  An `Agent` knows its own program, its own output and its inbox; a `Link` delivers
messages after its delay; a `Network` runs rounds of measuring, sending, receiving and computing.  A
program that uses a signal that its agent does not receive raises `SignalNotReceived`.

The same code serves three arithmetics: rational numbers (exact), multiple precision (mpmath) and
double precision (numpy).  This is possible because vectors are columns that are only added, scaled
and multiplied by matrices from the left.

Set-points and disturbances enter as `Signal`: sums of steps and ramps, so that they are exact in
every arithmetic, and linear between their changes.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import factorial
from typing import Any, Protocol

from mcexact.errors import InputError, LimitReached, UsageError, several, shown_value
from mcexact.exact.matrix import Matrix, Rounding, from_float, matrix_to_float, to_float
from mcexact.exact.rational import as_fraction, is_inexact
from mcexact.exact.roots import cosine_near
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import quoted

# The three arithmetics.

Native = Any
"""A matrix or column of an arithmetic: `Matrix`, ``mpmath.matrix`` or ``numpy.ndarray``."""


class Arithmetic(Protocol):
    """The numbers of a simulation, into which exact matrices are converted."""

    @property
    def name(self) -> str:
        """The name that `simulate` takes for it."""
        ...

    def convert(self, M: Matrix) -> Native:
        """A matrix or column in native numbers."""
        ...

    def scalar(self, value: Fraction) -> Any:
        """A number by which native matrices can be multiplied."""
        ...

    def entries(self, column: Native) -> list[Any]:
        """The entries of a column as native numbers."""
        ...

    def largest(self, column: Native) -> float:
        """The largest absolute value, as a float for control and display."""
        ...


@dataclass(frozen=True)
class ExactArithmetic:
    """Rational numbers."""

    name: str = "exact"

    def convert(self, M: Matrix) -> Native:
        """The matrix itself."""
        return M

    def scalar(self, value: Fraction) -> Fraction:
        """The number itself."""
        return value

    def entries(self, column: Matrix) -> list[Any]:
        """Fractions."""
        return [Fraction(row[0], column.denominator) for row in column.numerators]

    def largest(self, column: Matrix) -> float:
        """The largest absolute value; infinity where it exceeds every float."""
        return to_float(max(map(abs, self.entries(column)), default=0))


class MultiprecisionArithmetic:
    """Floating point with a given number of decimal digits (mpmath).

    Parameters
    ----------
    digits : int
        The number of digits that the results should have; half as many more are computed.
    """

    name = "multiprecision"

    def __init__(self, digits: int) -> None:
        from mpmath import MPContext

        self.context = MPContext()
        # The terms of a Taylor series may exceed their sum by some digits, which these make up for.
        self.context.dps = digits + digits // 2 + 10

    def convert(self, M: Matrix) -> Native:
        """An ``mpmath.matrix``, every entry rounded once."""
        converted = self.context.matrix(M.nrows, M.ncols)
        for i, row in enumerate(M.numerators):
            for j, entry in enumerate(row):
                if entry:
                    converted[i, j] = self.context.mpf(entry) / M.denominator
        return converted

    def scalar(self, value: Fraction) -> Any:
        """A multiple-precision number."""
        return self.context.mpf(value.numerator) / value.denominator

    def entries(self, column: Native) -> list[Any]:
        """Multiple-precision numbers."""
        return [column[i, 0] for i in range(column.rows)]

    def largest(self, column: Native) -> float:
        """The largest absolute value."""
        return max((abs(float(entry)) for entry in self.entries(column)), default=0.0)


@dataclass(frozen=True)
class DoubleArithmetic:
    """Double precision (numpy)."""

    name: str = "float"

    def convert(self, M: Matrix) -> Native:
        """An array of floats, every entry rounded once.

        Raises
        ------
        LimitReached
            If an entry exceeds the range of floats.
        """
        return representable(matrix_to_float(M))

    def scalar(self, value: Fraction) -> float:
        """A float."""
        return to_float(value)

    def entries(self, column: Native) -> list[Any]:
        """Floats."""
        return [float(entry) for entry in column[:, 0]]

    def largest(self, column: Native) -> float:
        """The largest absolute value."""
        return float(abs(column).max()) if column.size else 0.0


def representable(numbers: Any) -> Any:
    """Return an array of floats, which has no infinity and no NaN.

    Raises
    ------
    LimitReached
        If it has one.
    """
    import numpy as np

    if not np.all(np.isfinite(numbers)):
        raise LimitReached(
            "the trajectory has numbers beyond the range of double precision; "
            "use multiprecision arithmetic or a shorter horizon"
        )
    return numbers


def arithmetic_named(name: str, digits: int = 60) -> Arithmetic:
    """Return the arithmetic with a name: "exact", "multiprecision" or "float".

    Raises
    ------
    UsageError
        If the name is none of these.
    """
    if name == "exact":
        return ExactArithmetic()
    if name == "multiprecision":
        return MultiprecisionArithmetic(digits)
    if name == "float":
        return DoubleArithmetic()
    raise UsageError(
        f"expected the arithmetic exact, multiprecision or float, found {name!r}",
        where="arithmetic",
    )


# Agents, links and the network.


class SignalNotReceived(InputError):
    """A program uses a signal that its agent does not receive."""


@dataclass(frozen=True)
class Message:
    """What an agent sends along an edge: its output y_j and its shared sub-state x_j."""

    output: Native
    shared: Native


@dataclass(frozen=True)
class Snapshot:
    """The state of the plant and of all agents at one time, and their signals, in native numbers.

    Attributes
    ----------
    plant : list
        x.
    shared, private : list of lists
        x_i and z_i of each agent.
    outputs, inputs, reference : list of lists
        y_i, u_i and r_i of each agent.
    """

    plant: list[Any]
    shared: list[list[Any]]
    private: list[list[Any]]
    outputs: list[list[Any]]
    inputs: list[list[Any]]
    reference: list[list[Any]]

    def flat(self) -> list[Any]:
        """The entries of (x, x_1, z_1, …, x_m, z_m), the order of the closed loop's state."""
        result = list(self.plant)
        for x_i, z_i in zip(self.shared, self.private, strict=True):
            result += [*x_i, *z_i]
        return result


class _Map:
    """A linear map of one agent in native numbers."""

    def __init__(self, each: LinearMap, zero: Native, arithmetic: Arithmetic) -> None:
        def by_agent(used: Mapping[int, Matrix]) -> dict[int, Native]:
            return {j: arithmetic.convert(M) for j, M in used.items()}

        self.zero = zero
        self.outputs = by_agent(each.outputs)
        self.shared = by_agent(each.shared)
        self.private = None if each.private is None else arithmetic.convert(each.private)
        self.reference = None if each.reference is None else arithmetic.convert(each.reference)


class Agent:
    """One agent: a program, its own state and an inbox, without access to anything else.

    Parameters
    ----------
    position : int
    program : AgentProgram
    inputs, outputs : int
        p_i and q_i.
    arithmetic : Arithmetic
    names : sequence of str
        Of all agents.
    """

    def __init__(
        self,
        position: int,
        program: AgentProgram,
        inputs: int,
        outputs: int,
        arithmetic: Arithmetic,
        names: Sequence[str],
    ) -> None:
        def zero(size: int) -> Native:
            return arithmetic.convert(Matrix.zeros(size, 1))

        self.position, self.name, self._names = position, program.name, names
        self._shared_update = _Map(program.shared_update, zero(program.shared), arithmetic)
        self._private_update = _Map(program.private_update, zero(program.private), arithmetic)
        self._input = _Map(program.input, zero(inputs), arithmetic)
        self._hold = dict(program.hold)
        self.shared, self.private = zero(program.shared), zero(program.private)
        self.reference = zero(outputs)
        self.output, self.disturbance = zero(outputs), zero(inputs)
        longest = max(self._hold.values(), default=0)
        self._past: deque[Native] = deque([zero(program.shared)] * (longest + 1), longest + 1)
        self._inbox: dict[int, Message] = {}

    def measure(self, output: Native) -> None:
        """Take the measurement y_i, and record x_i for messages that are held."""
        self.output = output
        self._past.appendleft(self.shared)
        self._inbox = {}

    def message_for(self, receiver: int) -> Message:
        """The message to a follower now: y_i, and x_i from as many steps ago as it is held."""
        return Message(self.output, self._past[self._hold.get(receiver, 0)])

    def receive(self, sender: int, message: Message) -> None:
        """Put a message that arrives into the inbox."""
        self._inbox[sender] = message

    def input(self) -> Native:
        """u_i."""
        return self._applied(self._input)

    def update(self) -> tuple[Native, Native]:
        """The next values of x_i and z_i, or in continuous time their derivatives."""
        return self._applied(self._shared_update), self._applied(self._private_update)

    def _heard(self, j: int) -> Message:
        """The latest message of agent j; an agent has its own signals without a link."""
        if j == self.position:
            return self.message_for(j)
        if j not in self._inbox:
            raise SignalNotReceived(
                f"agent {quoted(self.name)} uses a signal of agent {quoted(self._names[j])}, "
                "which it does not receive: the plant has no such link"
            )
        return self._inbox[j]

    def _applied(self, each: _Map) -> Native:
        """Compute Σ_j outputs[j] y_j + Σ_j shared[j] x_j + private z_i + reference r_i."""
        result = each.zero
        for j, M in each.outputs.items():
            result = result + M @ self._heard(j).output
        for j, M in each.shared.items():
            result = result + M @ self._heard(j).shared
        if each.private is not None:
            result = result + each.private @ self.private
        if each.reference is not None:
            result = result + each.reference @ self.reference
        return result


class Link:
    """A communication link from one agent to another, which delivers each message after its delay.

    Parameters
    ----------
    sender, receiver : int
    delay : int
        In steps.
    silence : Message
        The message delivered until the first one arrives: zeros.
    """

    def __init__(self, sender: int, receiver: int, delay: int, silence: Message) -> None:
        self.sender, self.receiver = sender, receiver
        self._under_way: deque[Message] = deque([silence] * delay)

    def carry(self, message: Message) -> Message:
        """Send a message, and return the one that arrives now."""
        self._under_way.append(message)
        return self._under_way.popleft()


def _from_own_states(agent: int, each: LinearMap) -> bool:
    """Whether a map of an agent uses its own states alone, and neither signals nor set-points."""
    used = each.without_zeros()
    return not used.outputs and not {*used.shared} - {agent} and used.reference is None


class Network:
    """A plant, m agents and the communication links between them.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant.
    controller : Controller
    graph : NeighborGraph
        Its edges are the communication links.
    arithmetic : Arithmetic

    Raises
    ------
    InputError, UsageError
        If the controller has the wrong shape for the plant; or if the plant has feedthrough, and
        an input depends on other signals than its agent's private states.

    Notes
    -----
    Whether each program uses only signals that its agent receives is not checked here.  An agent
    that uses another signal raises `SignalNotReceived` when it runs.
    """

    def __init__(
        self,
        system: MultiChannelSystem,
        controller: Controller,
        graph: NeighborGraph,
        arithmetic: Arithmetic,
    ) -> None:
        # This checks shapes only: over the complete graph every agent receives every signal.
        controller.require_fits(system, NeighborGraph.complete(system.names))
        self.arithmetic = arithmetic
        self._A = arithmetic.convert(system.A)
        self._B = [arithmetic.convert(channel.B) for channel in system.channels]
        self._C = [arithmetic.convert(channel.C) for channel in system.channels]
        self._D = [
            [arithmetic.convert(system.feedthrough(i, j)) for j in range(system.m)]
            for i in range(system.m)
            if system.D is not None
        ]
        own = (_from_own_states(i, agent.input) for i, agent in enumerate(controller.agents))
        if self._D and not all(own):
            raise UsageError(
                "of a plant with feedthrough only agents are run whose inputs depend on nothing "
                "but their own states: of others outputs and inputs depend on each other at once"
            )
        self.state = arithmetic.convert(Matrix.zeros(system.n, 1))
        self.agents = [
            Agent(i, program, system.p(i), system.q(i), arithmetic, system.names)
            for i, program in enumerate(controller.agents)
        ]
        self._links = []
        for j, i in graph.edges():
            if i != j:
                agent = self.agents[j]
                silence = Message(agent.output, agent.shared)
                self._links.append(Link(j, i, graph.delay(i, j), silence))

    def set_state(self, state: Native, parts: Sequence[tuple[Native, Native]]) -> None:
        """Set the state x of the plant and the states (x_i, z_i) of the agents."""
        self.state = state
        for agent, (shared, private) in zip(self.agents, parts, strict=True):
            agent.shared, agent.private = shared, private

    def set_signals(self, references: Sequence[Native], disturbances: Sequence[Native]) -> None:
        """Set the set-point r_i of each agent, and what is added to its input at the plant."""
        for agent, r, w in zip(self.agents, references, disturbances, strict=True):
            agent.reference, agent.disturbance = r, w

    def round(self) -> tuple[Snapshot, Native, list[tuple[Native, Native]]]:
        """Run one round of measuring, sending, receiving and computing.

        Returns
        -------
        snapshot : Snapshot
            The state and the signals of this round.
        state : column
            A x + Σ B_i (u_i + w_i), the plant's next state, or in continuous time its derivative.
        parts : list of (column, column)
            The same for x_i and z_i of each agent.
        """
        entries = self.arithmetic.entries
        inputs, state, parts = self._computed()
        snapshot = Snapshot(
            entries(self.state),
            [entries(agent.shared) for agent in self.agents],
            [entries(agent.private) for agent in self.agents],
            [entries(agent.output) for agent in self.agents],
            [entries(u) for u in inputs],
            [entries(agent.reference) for agent in self.agents],
        )
        return snapshot, state, parts

    def evolution(self) -> tuple[Native, list[tuple[Native, Native]]]:
        """Run one round, and return the evolution of the state alone; see `round`."""
        _, state, parts = self._computed()
        return state, parts

    def _outputs(self) -> Iterator[Native]:
        """Yield the outputs y_i = C_i x + Σ D_ij (u_j + w_j)."""
        acting = [agent.input() + agent.disturbance for agent in self.agents if self._D]
        for i, C in enumerate(self._C):
            y = C @ self.state
            for j, u in enumerate(acting):
                y = y + self._D[i][j] @ u
            yield y

    def _computed(self) -> tuple[list[Native], Native, list[tuple[Native, Native]]]:
        """Run one round, and return the inputs of the agents and the evolution."""
        for agent, y in zip(self.agents, self._outputs(), strict=True):
            agent.measure(y)
        for link in self._links:
            message = self.agents[link.sender].message_for(link.receiver)
            self.agents[link.receiver].receive(link.sender, link.carry(message))
        inputs = [agent.input() for agent in self.agents]
        state = self._A @ self.state
        for agent, B, u in zip(self.agents, self._B, inputs, strict=True):
            state = state + B @ (u + agent.disturbance)
        return inputs, state, [agent.update() for agent in self.agents]


# Set-points and disturbances: sums of steps, ramps and cosines.

Columns = list[Matrix]
"""One column for each channel."""


@dataclass(frozen=True)
class Cosine:
    """cos(ωt) in continuous time; in discrete time cos(tθ), exactly.

    Attributes
    ----------
    number : Fraction
        ω in rad per unit of time, or in discrete time cos θ, θ the angle per step.
    discrete : bool
    bits : int
        To which values in continuous time are rounded.
    """

    number: Fraction
    discrete: bool
    bits: int = 64

    def derivative(self, time: Fraction, order: int = 0) -> Fraction:
        """A derivative at a time; in discrete time the value.

        Examples
        --------
        >>> [str(Cosine(Fraction(3, 5), True).derivative(Fraction(t))) for t in range(4)]
        ['1', '3/5', '-7/25', '-117/125']
        >>> float(Cosine(Fraction(2), False).derivative(Fraction(0), 2))
        -4.0
        """
        if self.discrete:
            return _chebyshev(int(time), self.number)[0]
        value = cosine_near(self.number * time, self.bits, quarters=order)
        return value * self.number**order


def _chebyshev(k: int, c: Fraction) -> tuple[Fraction, Fraction]:
    """T_k(c) and T_{k+1}(c), by T_{2k} = 2 T_k² − 1 and T_{2k+1} = 2 T_k T_{k+1} − c."""
    if k == 0:
        return Fraction(1), c
    first, second = _chebyshev(k // 2, c)
    middle = 2 * first * second - c
    if k % 2:
        return middle, 2 * second**2 - 1
    return 2 * first**2 - 1, middle


@dataclass(frozen=True)
class Change:
    """Numbers that are added to a signal from a time on: a step, a ramp, or a cosine.

    Attributes
    ----------
    time : Fraction
    columns : list of Matrix
        For each channel the numbers, in a ramp the slopes, and of a cosine the amplitudes.
    ramp : bool
    cosine : Cosine, optional
    """

    time: Fraction
    columns: Columns
    ramp: bool = False
    cosine: Cosine | None = None

    def derivative(self, time: Fraction, order: int = 0) -> Fraction:
        """The factor of the columns at a time from its beginning on, or a derivative of it."""
        if self.cosine is not None:
            return self.cosine.derivative(time - self.time, order)
        if order == 0:
            return time - self.time if self.ramp else Fraction(1)
        return Fraction(int(self.ramp and order == 1))


@dataclass(frozen=True)
class Signal:
    """A signal of each channel, a sum of steps, ramps and cosines.

    Attributes
    ----------
    zeros : list of Matrix
    changes : tuple of Change
    """

    zeros: Columns
    changes: tuple[Change, ...] = ()

    @property
    def is_constant(self) -> bool:
        """Whether nothing changes after the start."""
        others = (change.time <= 0 and not change.ramp for change in self.changes)
        return not self.cosines and all(others)

    @property
    def cosines(self) -> tuple[Change, ...]:
        """The cosines among its changes."""
        return tuple(change for change in self.changes if change.cosine is not None)

    @property
    def linear(self) -> Signal:
        """The sum of all others, which is linear between changes."""
        return Signal(self.zeros, tuple(each for each in self.changes if each.cosine is None))

    def at(self, time: Fraction) -> Columns:
        """The values at a time; at the time of a step those after it."""
        return self.derivative(time, 0)

    def slope(self, time: Fraction) -> Columns:
        """The slopes after a time."""
        return self.derivative(time, 1)

    def derivative(self, time: Fraction, order: int) -> Columns:
        """The derivatives of an order after a time."""
        total = self.zeros
        for change in self.changes:
            factor = change.derivative(time, order) if change.time <= time else Fraction(0)
            if factor:
                total = [a + b * factor for a, b in zip(total, change.columns, strict=True)]
        return total


@dataclass(frozen=True)
class Drive:
    """What enters a network from outside during a run.

    Attributes
    ----------
    references, disturbances : Signal
        r_i, and what is added to u_i at the plant.
    """

    references: Signal
    disturbances: Signal

    @property
    def changes(self) -> tuple[Change, ...]:
        """All steps, ramps and cosines."""
        return (*self.references.changes, *self.disturbances.changes)

    @property
    def is_constant(self) -> bool:
        """Whether nothing changes after the start."""
        return self.references.is_constant and self.disturbances.is_constant

    def pieces(self, times: Sequence[Fraction]) -> Iterator[tuple[Fraction, ...]]:
        """Divide times at those where a signal changes.

        Every piece starts where the one before ended, and its last time starts the next one.
        """
        inside = {change.time for change in self.changes if times[0] < change.time < times[-1]}
        ends = [times[0], *sorted(inside), times[-1]]
        for start, end in pairwise(ends):
            yield start, *(t for t in times if start < t < end), end

    def apply(self, network: Network, time: Fraction) -> None:
        """Give a network the values at a time."""
        _give(network, self.references.at(time), self.disturbances.at(time))

    def apply_term(self, network: Network, time: Fraction, order: int, step: Fraction) -> None:
        """Give a network the terms of an order of Taylor series at a time, for a step."""
        factor = step**order / factorial(order)
        both = self.references.derivative(time, order), self.disturbances.derivative(time, order)
        _give(network, *([M * factor for M in each] for each in both))


def _give(network: Network, references: Columns, disturbances: Columns) -> None:
    convert = network.arithmetic.convert
    network.set_signals(list(map(convert, references)), list(map(convert, disturbances)))


def numbers_of(
    values: Sequence[Any], rounding: Rounding | None, where: str
) -> tuple[Fraction, ...]:
    """Convert numbers exactly; floats by a named rounding.

    Parameters
    ----------
    values : sequence
    rounding : {"decimal", "dyadic"} or None
        How floats become exact, as in `MultiChannelSystem.from_float`; None refuses them.
    where : str
        The name of the argument in errors.

    Raises
    ------
    FloatRefused
        If a number is a float and no rounding is given.
    InputError
        If something is not a number.

    Examples
    --------
    >>> numbers_of([1, 0.5, "1/3"], "dyadic", "initial")
    (Fraction(1, 1), Fraction(1, 2), Fraction(1, 3))
    """

    def exact(value: Any, place: str) -> Fraction:
        if rounding is not None and is_inexact(value):
            return from_float(value, rounding, where=place)
        return as_fraction(value, where=place)

    listed = several(values, where, "numbers")
    return tuple(exact(value, f"{where}[{k}]") for k, value in enumerate(listed))


def by_channel(
    values: Sequence[Any], sizes: Sequence[int], rounding: Rounding | None, where: str
) -> Columns:
    """Convert numbers to one column for each channel.

    Parameters
    ----------
    values : sequence of sequences of numbers, or sequence of numbers
        One sequence for each channel, or all numbers in the order of the channels.
    sizes : sequence of int
        How many numbers each channel has.
    rounding : {"decimal", "dyadic"} or None
        As in `numbers_of`.
    where : str

    Raises
    ------
    InputError
        If there are too few or too many numbers.

    Examples
    --------
    >>> [M.rows() for M in by_channel([1, 2, 3], [2, 1], None, "reference")]
    [((Fraction(1, 1),), (Fraction(2, 1),)), ((Fraction(3, 1),),)]
    """
    listed = list(several(values, where, "numbers"))
    if any(_is_listed(each) for each in listed):
        if len(listed) != len(sizes):
            raise InputError(f"expected {len(sizes)} channels, found {len(listed)}", where=where)
        parts = [list(each) if _is_listed(each) else [each] for each in listed]
        for i, (part, size) in enumerate(zip(parts, sizes, strict=True)):
            if len(part) != size:
                raise InputError(
                    f"expected {size} numbers, found {len(part)}", where=f"{where}[{i}]"
                )
        listed = [number for part in parts for number in part]
    if len(listed) != sum(sizes):
        raise InputError(f"expected {sum(sizes)} numbers, found {len(listed)}", where=where)
    exact, columns, start = numbers_of(listed, rounding, where), [], 0
    for size in sizes:
        columns.append(Matrix.column(exact[start : start + size]))
        start += size
    return columns


def _is_listed(value: Any) -> bool:
    return not isinstance(value, str) and hasattr(value, "__len__")


def signal_of(
    sizes: Sequence[int],
    level: Sequence[Any] | None,
    steps: Sequence[tuple[Any, Sequence[Any]]],
    ramps: Sequence[tuple[Any, Sequence[Any]]],
    rounding: Rounding | None,
    where: tuple[str, str, str],
    cosines: Sequence[tuple[Cosine, Sequence[Any]]] = (),
) -> Signal:
    """Make a signal of its parts.

    Parameters
    ----------
    sizes : sequence of int
    level : sequence, optional
        The values from the start on; 0 by default.
    steps, ramps : sequences of (time, numbers)
        The numbers that are added from a time on; in a ramp the slopes.
    rounding : {"decimal", "dyadic"} or None
    where : tuple of str
        The names of the three arguments in errors.
    cosines : sequence of (Cosine, numbers)
        The amplitudes of cosines from the start on.
    """
    changes = []
    if level is not None:
        changes.append(Change(Fraction(0), by_channel(level, sizes, rounding, where[0])))
    for name, pairs, ramp in ((where[1], steps, False), (where[2], ramps, True)):
        for k, change in enumerate(several(pairs, name, "pairs (time, numbers)")):
            place = f"{name}[{k}]"
            if not _is_listed(change) or len(change) != 2:
                raise InputError(
                    f"expected a pair (time, numbers), found {shown_value(change)}", where=place
                )
            time, values = change
            [start] = numbers_of([time], rounding, place)
            if start < 0:
                raise InputError(f"expected a time of at least 0, found {start}", where=place)
            changes.append(Change(start, by_channel(values, sizes, rounding, place), ramp))
    for k, (cosine, values) in enumerate(cosines):
        columns = by_channel(values, sizes, rounding, f"cosines[{k}]")
        changes.append(Change(Fraction(0), columns, cosine=cosine))
    return Signal([Matrix.zeros(size, 1) for size in sizes], tuple(changes))


@dataclass(frozen=True)
class InitialState:
    """The state in which a simulation starts.

    Attributes
    ----------
    plant : tuple of Fraction
        x(0).
    shared, private : tuple of tuples of Fraction
        x_i(0) and z_i(0) of each agent.
    """

    plant: tuple[Fraction, ...]
    shared: tuple[tuple[Fraction, ...], ...]
    private: tuple[tuple[Fraction, ...], ...]


def initial_state(
    initial: InitialState | Sequence[Any] | None,
    system: MultiChannelSystem,
    controller: Controller,
    rounding: Rounding | None,
) -> InitialState:
    """Return the initial state; by default x(0) = (1, …, 1), and all agents are at 0."""
    if isinstance(initial, InitialState):
        return initial
    zero, one = Fraction(0), Fraction(1)
    x = (one,) * system.n if initial is None else numbers_of(initial, rounding, "initial")
    if len(x) != system.n:
        raise InputError(f"expected {system.n} numbers, found {len(x)}", where="initial")
    return InitialState(
        x,
        tuple((zero,) * agent.shared for agent in controller.agents),
        tuple((zero,) * agent.private for agent in controller.agents),
    )


def set_initial(
    network: Network, start: InitialState, system: MultiChannelSystem, controller: Controller
) -> None:
    """Check the sizes of an initial state, convert it and set it."""
    if not len(start.shared) == len(start.private) == system.m:
        raise InputError(
            f"expected shared and private states of {system.m} agents, "
            f"found {len(start.shared)} and {len(start.private)}",
            where="initial",
        )
    expected = [
        (system.n, start.plant, "x"),
        *(
            (size, values, f"agent {agent.name!r}")
            for agent, x_i, z_i in zip(controller.agents, start.shared, start.private, strict=True)
            for size, values in ((agent.shared, x_i), (agent.private, z_i))
        ),
    ]
    for size, values, where in expected:
        if len(values) != size:
            raise InputError(f"expected {size} numbers, found {len(values)}", where=where)

    def column(values: Sequence[Fraction]) -> Native:
        return network.arithmetic.convert(Matrix.column(values))

    parts = [
        (column(x_i), column(z_i)) for x_i, z_i in zip(start.shared, start.private, strict=True)
    ]
    network.set_state(column(start.plant), parts)
