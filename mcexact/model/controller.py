"""Controllers: one linear time-invariant program for each agent, of the signals it receives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, ClassVar

from mcexact.errors import InputError, UsageError
from mcexact.exact.location import is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.exact.size import bit_length, largest_entry
from mcexact.model.matrix_json import matrix_json
from mcexact.model.names import quoted
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown, fitting, grid

MAPS = ("shared_update", "private_update", "input")


@dataclass(frozen=True, repr=False)
class LinearMap(Shown):
    """A map Σ_j outputs[j] y_j + Σ_j shared[j] x_j + private z_i + reference r_i of agent i.

    Attributes
    ----------
    outputs : mapping of int to Matrix
        The coefficients of y_j, k×q_j, for each agent j whose output is used.
    shared : mapping of int to Matrix
        The coefficients of the shared sub-state x_j, k×n_j, for each agent j where it is used.
    private : Matrix or None
        The coefficients of z_i.
    reference : Matrix or None
        The coefficients of the set-point r_i of the agent's own outputs, k×q_i.
    """

    outputs: Mapping[int, Matrix] = field(default_factory=dict)
    shared: Mapping[int, Matrix] = field(default_factory=dict)
    private: Matrix | None = None
    reference: Matrix | None = None

    def without_zeros(self) -> LinearMap:
        """Return the same map without the matrices that are zero."""
        return LinearMap(
            {j: M for j, M in sorted(self.outputs.items()) if not M.is_zero()},
            {j: M for j, M in sorted(self.shared.items()) if not M.is_zero()},
            None if self.private is None or self.private.is_zero() else self.private,
            None if self.reference is None or self.reference.is_zero() else self.reference,
        )

    def __repr__(self) -> str:
        used = {name: value for name, value in vars(self).items() if value}
        return fitting(f"LinearMap({', '.join(f'{name}={value}' for name, value in used.items())})")

    def _labeled(self) -> Iterator[tuple[str, Matrix]]:
        """Yield the signals and their coefficients."""
        return self.terms()

    def terms(self, names: Sequence[str] | None = None) -> Iterator[tuple[str, Matrix]]:
        """Yield the signals, by the names of the agents or their positions, and coefficients."""
        for letter, used in (("y", self.outputs), ("x", self.shared)):
            for j, M in used.items():
                yield f"{letter} of {j if names is None else names[j]}", M
        if self.private is not None:
            yield "z", self.private
        if self.reference is not None:
            yield "r", self.reference

    def matrices(self) -> Iterator[Matrix]:
        """All matrices of the map."""
        yield from self.outputs.values()
        yield from self.shared.values()
        if self.private is not None:
            yield self.private
        if self.reference is not None:
            yield self.reference


@dataclass(frozen=True, repr=False)
class AgentProgram(Shown):
    """The equations of one agent for x_i, z_i and its input u_i.

    Attributes
    ----------
    name : str
    shared : int
        The dimension of x_i, which the agent sends to its followers.
    private : int
        The dimension of z_i, which the agent does not send.
    shared_update, private_update, input : LinearMap
        ẋ_i, ż_i (in discrete time x_i(t+1), z_i(t+1)) and u_i.
    hold : mapping of int to int
        The number of steps for which the agent holds x_i before it sends it to follower j; under
        the agent's own position, before it uses x_i itself.  Only in discrete time.
    """

    name: str
    shared: int
    private: int
    shared_update: LinearMap = field(default_factory=LinearMap)
    private_update: LinearMap = field(default_factory=LinearMap)
    input: LinearMap = field(default_factory=LinearMap)
    hold: Mapping[int, int] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"AgentProgram({quoted(self.name)}, {self.shared} shared, {self.private} private)"

    def told(self, names: Sequence[str] | None = None) -> str:
        """Say in plain words what the agent keeps, and whose signals it uses."""
        used = ", ".join(str(j) if names is None else names[j] for j in self.sources())
        return (
            f"Agent {self.name} keeps {self.shared} shared and {self.private} private states, and "
            f"uses {f'signals of {used}' if used else 'no signals'}."
        )

    def explain(self) -> str:
        """Say in plain words what the agent keeps, and whose signals it uses, by position."""
        return self.told()

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the left sides of the equations, and the coefficients on the right sides."""
        return Equations(self, None)._labeled()

    def maps(self) -> tuple[LinearMap, LinearMap, LinearMap]:
        """The three maps, in the order of `MAPS`."""
        return self.shared_update, self.private_update, self.input

    def sources(self) -> tuple[int, ...]:
        """Return the positions of the agents whose outputs or sub-states the program uses."""
        heard = {j for each in self.maps() for used in (each.outputs, each.shared) for j in used}
        return tuple(sorted(heard))


class Equations(Shown):
    """The equations of an agent, whose left sides are the next x and z of the agent, and u."""

    def __init__(self, agent: AgentProgram, names: Sequence[str] | None) -> None:
        self._agent, self._names = agent, names

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield each signal with the equation that uses it, and its coefficients."""
        used = False
        for left, each in zip(("x", "z", "u"), self._agent.maps(), strict=True):
            for signal, M in each.without_zeros().terms(self._names):
                used = True
                yield f"{left} from {signal}", M
        if not used:
            yield "u", "0"

    def _html(self) -> str:
        """Return the coefficients in HTML, one signal a row."""
        return grid(["equation", "coefficients"], self._labeled())


@dataclass(frozen=True, repr=False)
class Controller(Shown):
    """m agent programs for a system of m channels.

    Attributes
    ----------
    time : {"continuous", "discrete"}
    system : str
        The digest of the plant that the controller was made for; empty if it is unknown.
    agents : tuple of AgentProgram
        In the order of the channels.

    Notes
    -----
    Agents are addressed by position in the programs, by name in files.
    """

    _made_by: ClassVar[str] = (
        "local_controllers(system, parts) or load_controller(file); a design has it as .controller"
    )

    time: str
    system: str
    agents: tuple[AgentProgram, ...]

    def explain(self) -> str:
        """Say in plain words what the agents keep, use and send, one agent a line."""
        names = [agent.name for agent in self.agents]
        return "\n".join(agent.told(names) for agent in self.agents)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the equations of each agent."""
        names = [agent.name for agent in self.agents]
        for agent in self.agents:
            yield f"agent {agent.name}", Equations(agent, names)

    def to_dict(self) -> dict[str, Any]:
        """Return the object of a controller file as plain data, with quotients as strings."""
        from mcexact.model.controller_file import controller_document

        return controller_document(self)

    def __repr__(self) -> str:
        return f"Controller({len(self.agents)} agents, order {self.order}, {self.time} time)"

    @property
    def order(self) -> int:
        """The sum of the dimensions of all agents' states."""
        return sum(agent.shared + agent.private for agent in self.agents)

    def matrices(self) -> Iterator[Matrix]:
        """All matrices of all programs."""
        return (M for agent in self.agents for each in agent.maps() for M in each.matrices())

    def bit_length(self) -> int:
        """The number of bits of the longest numerator or denominator of an entry."""
        return bit_length(self.matrices())

    def largest_entry(self) -> Fraction:
        """The largest absolute value of an entry."""
        return largest_entry(self.matrices())

    def edges(self) -> tuple[tuple[int, int], ...]:
        """The edges (j, i), j ≠ i, for which agent i uses a signal of agent j."""
        return tuple(
            (j, i) for i, agent in enumerate(self.agents) for j in agent.sources() if j != i
        )

    def warnings_for(self, system: MultiChannelSystem) -> tuple[str, ...]:
        """Return a warning if the controller was made for another plant.

        A controller can run on every plant with the same shapes, but it was designed for one of
        them, and for its nominal values where these are uncertain.
        """
        found = system.digest_of_values()
        if self.system in ("", found):
            return ()
        return (
            f"the controller was made for another plant, of digest {self.system[:12]}…, "
            f"not for this one, of digest {found[:12]}…",
        )

    def require_fits(self, system: MultiChannelSystem, graph: NeighborGraph) -> None:
        """Check that this controller can run on a system over a graph.

        Raises
        ------
        UsageError
            If the time domain, the agents or their order differ.
        InputError
            If a matrix has the wrong shape, or an agent uses a signal that it does not receive.
        """
        if self.time != system.time:
            raise UsageError(
                f"the controller is for {self.time} time, the system is in {system.time} time"
            )
        names = tuple(agent.name for agent in self.agents)
        if names != system.names:
            raise UsageError(
                f"expected the agents {', '.join(map(quoted, system.names))} in this order, "
                f"found {', '.join(map(quoted, names))}",
                where="agents",
            )
        for i in range(system.m):
            self._require_agent_fits(system, graph, i)

    def _require_agent_fits(self, system: MultiChannelSystem, graph: NeighborGraph, i: int) -> None:
        """Check the program of one agent."""
        agent, names = self.agents[i], system.names
        heard = set(graph.neighborhood(i))
        for j in agent.hold:
            if i not in graph.neighborhood(j):
                raise InputError(
                    f"agent {quoted(names[j])} is not a follower", where=f"agents[{i}].hold"
                )
        if agent.hold and not is_discrete(self.time):
            raise InputError("signals can be held in discrete time only", where=f"agents[{i}].hold")
        sizes = (agent.shared, agent.private, system.p(i))
        for label, each, nrows in zip(MAPS, agent.maps(), sizes, strict=True):
            where = f"agents[{i}].{label}"
            for what, used in (("outputs", each.outputs), ("shared", each.shared)):
                for j, M in used.items():
                    if j not in heard:
                        raise InputError(
                            f"agent {quoted(names[i])} does not receive the signals of "
                            f"agent {quoted(names[j])}",
                            where=f"{where}.{what}",
                        )
                    width = system.q(j) if what == "outputs" else self.agents[j].shared
                    _require(M, nrows, width, f"{where}.{what}[{quoted(names[j])}]")
            if each.private is not None:
                _require(each.private, nrows, agent.private, f"{where}.private")
            if each.reference is not None:
                _require(each.reference, nrows, system.q(i), f"{where}.reference")

    def plot(self, ax: Any = None) -> Any:
        """Draw the gains as a colored matrix; see `mcexact.plot.gains`."""
        from mcexact.plot.gains import gains

        return gains(self, ax)

    def document(self) -> dict[str, Any]:
        """The object of a controller file without ``format`` and ``system``, as plain data."""
        names = [agent.name for agent in self.agents]
        return {"time": self.time, "agents": [_agent_json(a, names) for a in self.agents]}


def _require(M: Matrix, nrows: int, ncols: int, where: str) -> None:
    if M.shape != (nrows, ncols):
        raise InputError(
            f"expected a {nrows} × {ncols} matrix, found {M.nrows} × {M.ncols}", where=where
        )


def _agent_json(agent: AgentProgram, names: list[str]) -> dict[str, Any]:
    """One agent's program as plain data."""
    document: dict[str, Any] = {
        "name": agent.name,
        "shared": agent.shared,
        "private": agent.private,
    }
    for label, each in zip(MAPS, agent.maps(), strict=True):
        used = each.without_zeros()
        entry: dict[str, Any] = {}
        if used.outputs:
            entry["outputs"] = {names[j]: matrix_json(M) for j, M in used.outputs.items()}
        if used.shared:
            entry["shared"] = {names[j]: matrix_json(M) for j, M in used.shared.items()}
        if used.private is not None:
            entry["private"] = matrix_json(used.private)
        if used.reference is not None:
            entry["reference"] = matrix_json(used.reference)
        document[label] = entry
    if any(agent.hold.values()):
        document["hold"] = {names[j]: d for j, d in sorted(agent.hold.items()) if d}
    return document
