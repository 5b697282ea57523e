"""Agents on a network: each knows its own program, its own output, and the messages it receives."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import quoted
from mcexact.simulation.arithmetic import Arithmetic, Native


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
        If the controller has the wrong shape for the plant.

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

    def _computed(self) -> tuple[list[Native], Native, list[tuple[Native, Native]]]:
        """Run one round, and return the inputs of the agents and the evolution."""
        for agent, C in zip(self.agents, self._C, strict=True):
            agent.measure(C @ self.state)
        for link in self._links:
            message = self.agents[link.sender].message_for(link.receiver)
            self.agents[link.receiver].receive(link.sender, link.carry(message))
        inputs = [agent.input() for agent in self.agents]
        state = self._A @ self.state
        for agent, B, u in zip(self.agents, self._B, inputs, strict=True):
            state = state + B @ (u + agent.disturbance)
        return inputs, state, [agent.update() for agent in self.agents]
