"""Periodic decentralized controllers, their files, and their loops over one period.

A `PeriodicController` has a decentralized `Controller` for each step t = 0, …, N − 1 of its period,
with states of the same sizes in all of them.  With

    z_i(t+1) = F_i,t z_i(t) + G_i,t y_i(t),   u_i(t) = H_i,t z_i(t) + K_i,t y_i(t),

the index t of the matrices taken modulo N, agent i uses its own output alone.  `periodic_loop`
makes the *monodromy matrix*, which takes the state (x, z_1, …, z_m) of the loop from the beginning
of one period to that of the next: the product of the matrices of the N loops, the last one left.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.errors import InputError, place_of
from mcexact.exact.matrix import Matrix, bit_length
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.exact.roots import is_discrete, require_time
from mcexact.model.controller import (
    PERIODIC_FORMAT,
    AgentProgram,
    Controller,
    Equations,
    controller_document,
    document_text,
    read_programs,
)
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import (
    expect_format,
    expect_list,
    expect_object,
    expect_string,
    parse,
    quoted,
    read_bytes,
    require_short_numbers,
    write_bytes,
)
from mcexact.shown import Shown

MOST_STEPS = 1000
"""The longest period of a file."""


@dataclass(frozen=True, repr=False)
class PeriodicController(Shown):
    """A decentralized controller whose matrices depend on the step, with the period N.

    Attributes
    ----------
    phases : tuple of N Controller
        The programs of all agents in each step of the period, in discrete time.  No agent has a
        shared state, receives anything, has a set-point, or limits of its inputs.

    Raises
    ------
    InputError
        If there is no phase, or the phases differ in their agents or in the numbers of states, or
        a program is not as above.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    >>> even, odd = (local_controllers(plant, [[[gain]]]) for gain in (-2, 0))
    >>> controller = PeriodicController((even, odd))
    >>> controller
    PeriodicController(period 2, 1 agents, order 0)
    >>> periodic_loop(plant, controller).A.numerators
    ((0,),)
    """

    phases: tuple[Controller, ...]

    def __post_init__(self) -> None:
        if not self.phases:
            raise InputError("expected at least one phase, found none", where="phases")
        sizes = [(agent.name, agent.private) for agent in self.phases[0].agents]
        for t, phase in enumerate(self.phases):
            where = f"phases[{t}]"
            InputError.require(phase, Controller, where)
            if not is_discrete(phase.time):
                raise InputError("periodic controllers are in discrete time", where=where)
            if [(agent.name, agent.private) for agent in phase.agents] != sizes:
                raise InputError(
                    "expected the agents of the first phase, with as many states", where=where
                )
            for i, agent in enumerate(phase.agents):
                _require_decentralized(agent, i, f"{where}.agents[{i}]")

    @property
    def period(self) -> int:
        """N, the number of steps after which the matrices repeat."""
        return len(self.phases)

    @property
    def system(self) -> str:
        """The digest of the plant that the controller was made for; empty if it is unknown."""
        return self.phases[0].system

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the agents."""
        return tuple(agent.name for agent in self.phases[0].agents)

    @property
    def order(self) -> int:
        """The sum of the dimensions of all agents' states."""
        return self.phases[0].order

    def bit_length(self) -> int:
        """The number of bits of the longest numerator or denominator of an entry."""
        return bit_length(M for phase in self.phases for M in phase.matrices())

    def warnings_for(self, system: MultiChannelSystem) -> tuple[str, ...]:
        """Return a warning if the controller was made for another plant."""
        return self.phases[0].warnings_for(system)

    def loops_with(self, system: MultiChannelSystem) -> list[Matrix]:
        """Return the matrix of the loop in each step, with the state (x, z_1, …, z_m).

        Raises
        ------
        UsageError, InputError
            As in `Controller.require_fits`, for the first phase that does not fit.
        """
        loops = list[Matrix]()
        for t, phase in enumerate(self.phases):
            with InputError.inside(f"phases[{t}]"):
                loops.append(closed_loop(system, phase).matrix)
        return loops

    def explain(self) -> str:
        """Say in plain words what the agents keep and use."""
        agents = "\n".join(agent.told(self.names) for agent in self.phases[0].agents)
        return f"The programs repeat after {self.period} steps.\n{agents}"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the equations of each agent in each phase."""
        for t, phase in enumerate(self.phases):
            for agent in phase.agents:
                yield f"step {t}, agent {agent.name}", Equations(agent, self.names)

    def document(self) -> list[dict[str, Any]]:
        """The programs of all phases as plain data, as certificates have them."""
        return [phase.document() for phase in self.phases]

    def to_dict(self) -> dict[str, Any]:
        """Return the object of a file of a periodic controller, with quotients as strings."""
        phases = [{"agents": controller_document(phase)["agents"]} for phase in self.phases]
        head = {"format": PERIODIC_FORMAT, "system": self.system, "time": "discrete"}
        return {**head, "phases": phases}

    def __repr__(self) -> str:
        agents = len(self.phases[0].agents)
        return f"PeriodicController(period {self.period}, {agents} agents, order {self.order})"


def _require_decentralized(agent: AgentProgram, i: int, where: str) -> None:
    """Stop unless an agent uses its own output and its own state alone, without set-points."""
    if agent.shared or agent.hold:
        raise InputError("agents of periodic controllers share no states", where=where)
    if agent.limits is not None or agent.back_calculation is not None:
        raise InputError("inputs of periodic controllers have no limits", where=where)
    for each in agent.maps():
        if set(each.outputs) - {i}:
            raise InputError(
                f"agent {quoted(agent.name)} of a periodic controller uses its own output alone",
                where=where,
            )
        if each.reference is not None:
            raise InputError("periodic controllers have no set-points", where=where)


# Files of periodic controllers.


def read_periodic_controller(
    text: bytes | str, limits: Limits = DEFAULT_LIMITS
) -> PeriodicController:
    """Read the contents of a file of a periodic controller.

    Raises
    ------
    InputError
        If it is malformed; the message says where, what was expected and what was found.
    """
    document = expect_format(parse(text, limits), PERIODIC_FORMAT)
    expect_object(document, None, ("format", "system", "time", "phases"))
    if not is_discrete(document["time"]):
        raise InputError("expected 'discrete': nothing else can be periodic", where="time")
    expect_string(document["system"], "system", "the digest of a system, a string")
    phases = expect_list(document["phases"], "phases")
    if len(phases) > MOST_STEPS:
        raise InputError(
            f"expected at most {MOST_STEPS} phases, found {len(phases)}", where="phases"
        )
    require_short_numbers(text, limits)
    return phases_of(phases, document["system"], limits)


def phases_of(
    phases: Sequence[Any], system: str = "", limits: Limits = DEFAULT_LIMITS
) -> PeriodicController:
    """Make a periodic controller of the plain data of its phases, each an object with agents."""
    read = list[Controller]()
    for t, phase in enumerate(phases):
        expect_object(phase, f"phases[{t}]", ("agents",), ("time",))
        with InputError.inside(f"phases[{t}]"):
            time = phase.get("time", "discrete")
            require_time(time)
            read.append(Controller(time, system, read_programs(phase["agents"], limits)))
    return PeriodicController(tuple(read))


def load_periodic_controller(
    path: str | os.PathLike[str], limits: Limits = DEFAULT_LIMITS
) -> PeriodicController:
    """Read a periodic controller from a file, or from standard input for ``-``.

    Raises
    ------
    InputError
        If it is missing, unreadable or malformed; the message says where.
    """
    with InputError.inside(place_of(path)):
        return read_periodic_controller(read_bytes(path, limits), limits)


def save_periodic_controller(controller: PeriodicController, path: str | os.PathLike[str]) -> None:
    """Write a file of a periodic controller, completely or not at all.

    Raises
    ------
    NotWritten
        If the file cannot be written.
    """
    InputError.require(controller, PeriodicController, "controller")
    write_bytes(path, periodic_text(controller).encode("ascii"))


def periodic_text(controller: PeriodicController) -> str:
    """The text of a file of a periodic controller: a row of a matrix on one line."""
    return document_text(controller.to_dict())


# The loop over one period.


def periodic_loop(system: MultiChannelSystem, controller: PeriodicController) -> MultiChannelSystem:
    """Make the loop of a periodic controller over one period.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant in discrete time without feedthrough, or a system derived from one.
    controller : PeriodicController

    Returns
    -------
    MultiChannelSystem
        Without channels.  Its matrix is the monodromy matrix: with the matrices M_t of the loops of
        the N phases, each with the state (x, z_1, …, z_m), it is M_{N−1} ⋯ M_1 M_0.

    Raises
    ------
    UsageError, InputError
        If the controller does not fit, or the plant has feedthrough.
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, PeriodicController, "controller")
    steps = controller.loops_with(system)
    monodromy = Matrix.identity(steps[0].nrows)
    for step in steps:
        monodromy = step @ monodromy
    construction = {"construction": "periodic_loop", "phases": controller.document()}
    return system.derived(monodromy, (), (), construction)
