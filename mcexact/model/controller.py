"""Controllers of agents, and their files.

A `Controller` has one `AgentProgram` for each agent: linear equations for its shared sub-state x_i,
its private state z_i and its input u_i.  Each right side is a `LinearMap` of measured outputs,
shared sub-states, the private state and the reference.  So the data say whose signals a program
uses, and `require_fits` compares this with the neighbor graph.  The controller file holds these
maps by the names of the agents, with exact numbers.  Files of MATLAB and archives of numpy hold
each matrix under the name of what it computes from what, such as ``u_1_y_2``.
"""

from __future__ import annotations

import json
import os
import re
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, ClassVar, cast, get_args

from mcexact.errors import InputError, RoundingWarning, UsageError, one_of, place_of
from mcexact.exact.matrix import (
    BINARY,
    Matrix,
    Rounding,
    bit_length,
    has_rounded,
    largest_entry,
)
from mcexact.exact.rational import DEFAULT_LIMITS, Limits, decimal_or_quotient
from mcexact.exact.roots import is_discrete, require_time
from mcexact.model import arrays
from mcexact.model.entries import matrix_json, read_matrix
from mcexact.model.files import members
from mcexact.model.graph import NeighborGraph
from mcexact.model.limits import (
    InputLimits,
    Range,
    limits_in_words,
    pairs_document,
    read_input_limits,
)
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import (
    checked_names,
    expect_format,
    expect_integer,
    expect_list,
    expect_name,
    expect_object,
    expect_string,
    nearest,
    parse,
    quoted,
    read_bytes,
    require_short_numbers,
    require_start,
    write_bytes,
)
from mcexact.shown import Shown, fitting, grid

# Controllers: one linear time-invariant program for each agent, of the signals it receives.

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
    limits : tuple of pairs of Fraction, or None
        The least and the largest value of each input, None for an input without limits: the agent
        computes v and sets its input to v cut off at the limits.  None where no input has any.
    back_calculation : Matrix or None
        The anti-windup gains L, of (x_i, z_i) × inputs: while inputs are cut off, the agent adds
        L (u − v) to its next states (in continuous time to their derivatives).

    Notes
    -----
    ``limits`` and ``back_calculation`` are no part of the linear program: certificates about linear
    loops leave them out, and those about inputs that are cut off name them as claims.
    """

    name: str
    shared: int
    private: int
    shared_update: LinearMap = field(default_factory=LinearMap)
    private_update: LinearMap = field(default_factory=LinearMap)
    input: LinearMap = field(default_factory=LinearMap)
    hold: Mapping[int, int] = field(default_factory=dict)
    limits: tuple[Range | None, ...] | None = None
    back_calculation: Matrix | None = None

    def __repr__(self) -> str:
        return f"AgentProgram({quoted(self.name)}, {self.shared} shared, {self.private} private)"

    def told(self, names: Sequence[str] | None = None) -> str:
        """Say in plain words what the agent keeps, and whose signals it uses."""
        used = ", ".join(str(j) if names is None else names[j] for j in self.sources())
        return (
            f"Agent {self.name} keeps {self.shared} shared and {self.private} private states, and "
            f"uses {f'signals of {used}' if used else 'no signals'}."
            f"{'' if self.limits is None else f' {self._saturation()}'}"
        )

    def _saturation(self) -> str:
        """Say at which limits inputs are cut off."""
        corrected = "" if self.back_calculation is None else ", and corrects its states by the rest"
        return f"It cuts off {limits_in_words((self.limits or (),), ('u',))}{corrected}."

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
        if self._agent.limits is not None:
            yield "u at most", limits_in_words((self._agent.limits,), ("u",))
        if self._agent.back_calculation is not None:
            yield "(x, z) from what is cut off", self._agent.back_calculation

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
        digest = system.digest_of_values()
        if self.system in ("", digest):
            return ()
        return (
            f"the controller was made for another plant, of digest {self.system[:12]}…, "
            f"not for this one, of digest {digest[:12]}…",
        )

    def limits_for(self, system: MultiChannelSystem) -> InputLimits | None:
        """The limits of the agents, or else those of the system; None without any."""
        if any(agent.limits is not None for agent in self.agents):
            return tuple(
                agent.limits or (None,) * system.p(i) for i, agent in enumerate(self.agents)
            )
        return system.limits

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
        if agent.limits is not None and len(agent.limits) != system.p(i):
            message = f"expected {system.p(i)} pairs, found {len(agent.limits)}"
            raise InputError(message, where=f"agents[{i}].limits")
        if agent.back_calculation is not None:
            where = f"agents[{i}].back_calculation"
            _require(agent.back_calculation, agent.shared + agent.private, system.p(i), where)

    def plot(self, ax: Any = None) -> Any:
        """Draw the gains as a colored matrix; see `mcexact.plot.graphs`."""
        from mcexact.plot.graphs import gains

        return gains(self, ax)

    def document(self) -> dict[str, Any]:
        """The linear programs as plain data, as certificates have them."""
        names = [agent.name for agent in self.agents]
        return {"time": self.time, "agents": [_agent_json(a, names) for a in self.agents]}

    def with_saturation(
        self, limits: InputLimits | None, gains: Sequence[Matrix | None] = ()
    ) -> Controller:
        """Return the same controller with limits of its inputs, and with anti-windup gains.

        Parameters
        ----------
        limits : InputLimits or None
            For each agent the limits of its inputs.
        gains : sequence of m Matrix or None
            L_i, (x_i, z_i) × inputs.
        """
        own = [None] * len(self.agents) if limits is None else limits
        agents = tuple(
            replace(
                agent,
                limits=None if each is None or not any(each) else each,
                back_calculation=None if L is None or L.is_zero() else L,
            )
            for agent, each, L in zip(
                self.agents, own, gains or [None] * len(self.agents), strict=True
            )
        )
        return replace(self, agents=agents)


def _require(M: Matrix, nrows: int, ncols: int, where: str) -> None:
    if M.shape != (nrows, ncols):
        raise InputError(
            f"expected a {nrows} × {ncols} matrix, found {M.nrows} × {M.ncols}", where=where
        )


def with_matrices(controller: Controller, change: Callable[[Matrix], Matrix]) -> Controller:
    """Apply a function to all matrices, those of set-points and anti-windup gains included.

    The limits of inputs stay as they are; see `with_limits`.
    """

    def of(each: LinearMap) -> LinearMap:
        return LinearMap(
            {j: change(M) for j, M in each.outputs.items()},
            {j: change(M) for j, M in each.shared.items()},
            None if each.private is None else change(each.private),
            None if each.reference is None else change(each.reference),
        )

    agents = tuple(
        replace(
            agent,
            shared_update=of(agent.shared_update),
            private_update=of(agent.private_update),
            input=of(agent.input),
            back_calculation=None
            if agent.back_calculation is None
            else change(agent.back_calculation),
        )
        for agent in controller.agents
    )
    return replace(controller, agents=agents)


def with_limits(controller: Controller, change: Callable[[Range], Range]) -> Controller:
    """Apply a function to the limits of all inputs that have any.

    Raises
    ------
    InputError
        If nothing is left between the limits of an input.
    """

    def of(agent: AgentProgram) -> AgentProgram:
        if agent.limits is None:
            return agent
        pairs = tuple(None if pair is None else change(pair) for pair in agent.limits)
        for k, pair in enumerate(pairs):
            if pair is not None and pair[0] >= pair[1]:
                raise InputError(
                    f"the limits of input {k + 1} of agent {quoted(agent.name)} are so near to 0 "
                    "that no value of the code lies between them"
                )
        return replace(agent, limits=pairs)

    return replace(controller, agents=tuple(map(of, controller.agents)))


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


# Controller files: one program for each agent, read strictly, written completely or not at all.

FORMAT = "mcexact-controller/1"
PERIODIC_FORMAT = "mcexact-periodic-controller/1"
_OTHERS = (
    "a controller file is JSON, .mat or .npz; in Python, local_controllers makes a controller of "
    "matrices, or of systems of python-control"
)


def load_controller(
    path: str | os.PathLike[str],
    limits: Limits = DEFAULT_LIMITS,
    *,
    rounding: Rounding | None = None,
) -> Controller:
    """Read a controller from a file, or from standard input for ``-``.

    Parameters
    ----------
    path : path
        JSON, a file of MATLAB, or an archive of numpy; ``-`` is the standard input.
    limits : Limits, optional
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats become exact; by default as the file says, or else "simplest".

    Raises
    ------
    InputError
        If it is missing, unreadable or malformed; the message says where.

    Warns
    -----
    RoundingWarning
        If numbers were read from floats, and neither the caller nor the file says by which
        rounding.
    """
    with InputError.inside(place_of(path)):
        data = read_bytes(path, limits)
        controller = read_controller(data, limits, rounding)
    for text in [] if rounding else doubts_about_floats(data, limits):
        warnings.warn(text, RoundingWarning, stacklevel=2)
    return controller


def read_controller(
    text: bytes | str, limits: Limits = DEFAULT_LIMITS, rounding: Rounding | None = None
) -> Controller:
    """Read the contents of a controller file: JSON, a file of MATLAB or an archive of numpy.

    Raises
    ------
    InputError
        If it is malformed; the message says where, what was expected and what was found.
    """
    if isinstance(text, bytes) and is_of_arrays(text):
        return controller_of(_parts(text, limits), limits, rounding)
    require_start(text, _OTHERS)
    document = parse(text, limits)
    if isinstance(document, dict) and document.get("format") == PERIODIC_FORMAT:
        raise InputError(
            "this controller is periodic: only certify, simulate and check take such controllers, "
            "without options that need one loop for all steps",
            where="format",
        )
    expect_format(document, FORMAT)
    expect_object(document, None, ("format", "time", "system", "agents"))
    require_time(document["time"])
    expect_string(document["system"], "system", "the digest of a system, a string")
    programs = read_programs(document["agents"], limits)
    require_short_numbers(text, limits)
    return Controller(document["time"], document["system"], programs)


def read_programs(document: Any, limits: Limits = DEFAULT_LIMITS) -> tuple[AgentProgram, ...]:
    """Read the programs of all agents from the list in a controller's file.

    Raises
    ------
    InputError
        If it is malformed; the message says where, what was expected and what was found.
    """
    agents = expect_list(document, "agents")
    if not agents:
        raise InputError("expected at least one agent, found none", where="agents")
    keys = ("name", "shared", "private", *MAPS)
    for k, agent in enumerate(agents):
        expect_object(agent, f"agents[{k}]", keys, ("hold", "limits", "back_calculation"))
    places = [f"agents[{k}].name" for k in range(len(agents))]
    labels = [
        expect_name(agent["name"], place) for agent, place in zip(agents, places, strict=True)
    ]
    names = checked_names(labels, places)
    sizes = [expect_integer(a["shared"], f"agents[{k}].shared") for k, a in enumerate(agents)]
    return tuple(
        _read_agent(agent, f"agents[{k}]", names, sizes, limits) for k, agent in enumerate(agents)
    )


def _read_agent(
    agent: dict[str, Any], where: str, names: tuple[str, ...], sizes: list[int], limits: Limits
) -> AgentProgram:
    """Read one program; ``sizes`` are the dimensions of all shared sub-states."""
    shared = sizes[names.index(agent["name"])]
    private = expect_integer(agent["private"], f"{where}.private")
    shared_update, private_update, input_map = (
        _read_map(agent[label], f"{where}.{label}", size, names, (sizes, private), limits)
        for label, size in zip(MAPS, (shared, private, None), strict=True)
    )
    hold = {}
    for name, steps in _by_agent(agent.get("hold", {}), f"{where}.hold", names).items():
        hold[name] = expect_integer(steps, f"{where}.hold[{quoted(names[name])}]")
    inputs = max((M.nrows for M in input_map.matrices()), default=None)
    pairs, gains = None, None
    if "limits" in agent:
        place, name = f"{where}.limits", agent["name"]
        count = len(expect_list(agent["limits"], place))
        if inputs not in (None, count):
            raise InputError(f"expected {inputs} pairs, found {count}", where=place)
        read = read_input_limits({name: agent["limits"]}, [name], [count], place, limits)
        pairs, inputs = None if read is None else read[0], count
    if "back_calculation" in agent:
        place = f"{where}.back_calculation"
        gains = read_matrix(agent["back_calculation"], place, shared + private, inputs, limits)
    return AgentProgram(
        agent["name"],
        shared,
        private,
        shared_update,
        private_update,
        input_map,
        hold,
        pairs,
        None if gains is None or gains.is_zero() else gains,
    )


def _read_map(
    value: Any,
    where: str,
    nrows: int | None,
    names: tuple[str, ...],
    widths: tuple[list[int], int],
    limits: Limits,
) -> LinearMap:
    """Read one linear map; ``widths`` are the dimensions of all x_j, and that of z_i."""
    expect_object(value, where, (), ("outputs", "shared", "private", "reference"))

    def matrix(entry: Any, place: str, ncols: int | None = None) -> Matrix:
        return read_matrix(entry, place, nrows, ncols, limits)

    def by_agent(key: str, sizes: list[int] | None) -> dict[int, Matrix]:
        entries = _by_agent(value.get(key, {}), f"{where}.{key}", names)
        return {
            j: matrix(M, f"{where}.{key}[{quoted(names[j])}]", sizes[j] if sizes else None)
            for j, M in entries.items()
        }

    linear_map = LinearMap(
        by_agent("outputs", None),
        by_agent("shared", widths[0]),
        matrix(value["private"], f"{where}.private", widths[1]) if "private" in value else None,
        matrix(value["reference"], f"{where}.reference") if "reference" in value else None,
    )
    heights = sorted({M.nrows for M in linear_map.matrices()})
    if len(heights) > 1:
        raise InputError(
            f"expected matrices of one number of rows, found {heights[0]} and {heights[1]}",
            where=where,
        )
    return linear_map


def _by_agent(value: Any, where: str, names: tuple[str, ...]) -> dict[int, Any]:
    """Read an object keyed by agents' names, and return it keyed by positions, ascending."""
    if not isinstance(value, dict):
        raise InputError("expected an object keyed by agents", where=where)
    for name in value:
        if name not in names:
            raise InputError(f"there is no agent {quoted(name)}{nearest(name, names)}", where=where)
    return {j: value[name] for j, name in enumerate(names) if name in value}


def controller_document(controller: Controller) -> dict[str, Any]:
    """The object of a controller file as plain data, with quotients as strings."""
    document = {"format": FORMAT, "system": controller.system, **controller.document()}
    for agent, own in zip(controller.agents, document["agents"], strict=True):
        if agent.limits is not None:
            own["limits"] = pairs_document(agent.limits)
        if agent.back_calculation is not None:
            own["back_calculation"] = matrix_json(agent.back_calculation)
    return document


def controller_text(controller: Controller) -> str:
    """The text of a controller file: decimals where they are exact and short, a row on one line."""
    return document_text(controller_document(controller))


def document_text(document: dict[str, Any]) -> str:
    """The text of the object of a controller file."""
    text = json.dumps(_readable(document), indent=1, ensure_ascii=True)
    return _LIST_OF_NUMBERS.sub(lambda match: f"[{' '.join(match[0][1:-1].split())}]", text) + "\n"


_LONG = 40
_LIST_OF_NUMBERS = re.compile(r"\[\s[^\[\]{}]*\]")


def _readable(value: Any, *, listed: bool = False) -> Any:
    """Write short quotients in lists as decimals; other strings are names."""
    if isinstance(value, dict):
        return {key: _readable(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_readable(each, listed=True) for each in value]
    if listed and isinstance(value, str) and len(value) <= _LONG:
        return decimal_or_quotient(Fraction(value))
    return value


def save_controller(
    controller: Controller,
    path: str | os.PathLike[str],
    *,
    rounding: Rounding | None = None,
    nearest: bool = False,
) -> None:
    """Write a controller file, completely or not at all.

    Parameters
    ----------
    controller : Controller
    path : path
        Its end says the kind: .mat, .npz, or JSON.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        For .mat and .npz: numbers are written as floats from which this rounding makes them again.
        The file names it.
    nearest : bool
        For .mat and .npz: whether other numbers are written as the nearest floats, which are
        another controller.

    Raises
    ------
    NotWritten
        If the file cannot be written.
    InputError
        If it would not hold the numbers of the controller.
    """
    contents = controller_bytes(controller, path, rounding=rounding, nearest=nearest)
    write_bytes(path, contents)


def controller_bytes(
    controller: Controller,
    path: str | os.PathLike[str],
    *,
    rounding: Rounding | None = None,
    nearest: bool = False,
) -> bytes:
    """The contents of the file that `save_controller` writes."""
    InputError.require(controller, Controller, "controller")
    suffix = os.path.splitext(place_of(path))[1].lower()
    if suffix == ".mat":
        parts = parts_of_controller(controller)
        return arrays.mat_bytes(parts, rounding, nearest=nearest, vocabulary=CONTROLLER)
    if suffix == ".npz":
        return arrays.npz_bytes(parts_of_controller(controller), rounding, nearest=nearest)
    if rounding is not None or nearest:
        raise InputError("floats are for .mat and .npz files: leave out the rounding")
    return controller_text(controller).encode("ascii")


# Controllers as arrays: each matrix by the name of what it computes from what.

_OF = re.compile(r"([xzu])_([1-9][0-9]{0,5})_(?:([yx])_([1-9][0-9]{0,5})|([zr]))")
_SIZES = ("shared", "private", "hold")
_TEXTS = ("format", "time", "system", arrays.ROUNDING)
CONTROLLER = arrays.Vocabulary(
    (*_TEXTS, *_SIZES, "names"),
    _TEXTS,
    _OF,
    (),
    "; known are x_1_y_1, x_1_x_2, z_1_z, u_1_r and so on, shared, private, hold and names; in "
    "Python, local_controllers makes a controller of matrices",
)


def is_of_arrays(data: bytes) -> bool:
    """Whether a file is one of MATLAB or an archive."""
    return data.startswith((arrays.MAGIC, b"PK"))


def _parts(data: bytes, limits: Limits) -> arrays.Parts:
    if data.startswith(arrays.MAGIC):
        return arrays.read_mat(data, limits, CONTROLLER)
    return arrays.read_npz(members(data, limits), limits, CONTROLLER)


def parts_of_controller(controller: Controller) -> arrays.Parts:
    """The arrays of a controller.

    ``u_1_y_2`` has the coefficients of y_2 in u_1: in the place of u stands what is computed, x for
    the next x_1 (in continuous time its derivative) and z for the next z_1; in the place of y_2
    what it is computed from, y_j, x_j, or the agent's own z and r.  What is not there is 0.

    Raises
    ------
    InputError
        If inputs have limits or anti-windup gains, for which there are no arrays.
    """
    if any(
        agent.limits is not None or agent.back_calculation is not None
        for agent in controller.agents
    ):
        raise InputError("only .json files keep limits of inputs and anti-windup gains")
    tables: dict[str, Matrix] = {}
    m = len(controller.agents)
    for i, agent in enumerate(controller.agents, start=1):
        for letter, each in zip("xzu", agent.maps(), strict=True):
            used = each.without_zeros()
            tables |= {f"{letter}_{i}_y_{j + 1}": M for j, M in used.outputs.items()}
            tables |= {f"{letter}_{i}_x_{j + 1}": M for j, M in used.shared.items()}
            own = {"z": used.private, "r": used.reference}
            tables |= {f"{letter}_{i}_{kind}": M for kind, M in own.items() if M is not None}
    for name in ("shared", "private"):
        sizes = [getattr(agent, name) for agent in controller.agents]
        tables[name] = Matrix.from_integers([sizes])
    held = [(i, j, d) for i, a in enumerate(controller.agents) for j, d in a.hold.items() if d]
    if held:
        tables["hold"] = Matrix.from_entries((m, m), held)
    texts = {"format": FORMAT, "time": controller.time, "system": controller.system}
    return arrays.Parts(tables, texts, [agent.name for agent in controller.agents])


def doubts_about_floats(data: bytes, limits: Limits = DEFAULT_LIMITS) -> list[str]:
    """Say that the numbers of a file were read from floats, if it does not say how to read them."""
    if not is_of_arrays(data):
        return []
    parts = _parts(data, limits)
    if arrays.ROUNDING in parts.texts or not any(map(has_rounded, parts.tables.values())):
        return []
    return [
        f"numbers of this controller were read from floats by the rounding '{BINARY}': certify the "
        "controller that was read"
    ]


def is_controller(data: bytes, limits: Limits = DEFAULT_LIMITS) -> bool:
    """Whether a file is one of a controller, whatever else is wrong with it."""
    with suppress(InputError):
        if is_of_arrays(data):
            return "format" in _parts(data, limits).texts
        return _format_of(data, limits) in (FORMAT, PERIODIC_FORMAT)
    return False


def is_periodic(data: bytes, limits: Limits = DEFAULT_LIMITS) -> bool:
    """Whether a file is one of a periodic controller, whatever else is wrong with it."""
    with suppress(InputError):
        return not is_of_arrays(data) and _format_of(data, limits) == PERIODIC_FORMAT
    return False


def _format_of(data: bytes, limits: Limits) -> Any:
    """The format that a file of a controller names; None if it names none of them."""
    named = any(name.encode() in data for name in (FORMAT, PERIODIC_FORMAT))
    if not named and b"\\" not in data:  # letters can be written as \u006d
        return None
    document = parse(data, limits)
    return document.get("format") if isinstance(document, dict) else None


def controller_of(
    parts: arrays.Parts, limits: Limits = DEFAULT_LIMITS, rounding: Rounding | None = None
) -> Controller:
    """Make the controller of arrays; floats become exact by a rounding.

    It is that of the caller, or that which the file names, or else "simplest": the numbers that a
    person typed, as far as these can be told from floats.

    Raises
    ------
    InputError
        If something is missing, or is not as expected.
    """
    for name in ("format", "time"):
        if name not in parts.texts:
            raise InputError(f"the text '{name}' is missing", where=name)
    if parts.texts["format"] != FORMAT:
        raise InputError(f"expected {FORMAT!r}, found {parts.texts['format']!r}", where="format")
    require_time(parts.texts["time"])
    written = parts.texts.get(arrays.ROUNDING, BINARY)
    one_of(written, get_args(Rounding), arrays.ROUNDING, InputError)
    arrays.require_entries(parts.tables.values(), limits)
    reading = arrays.Reading(limits, rounding or cast(Rounding, written))
    labels = list(parts.names or ())
    if not labels:
        raise InputError("expected the names of the agents", where="names")
    names = checked_names(labels, [f"names[{k}]" for k in range(len(labels))])
    exact = {
        name: arrays.exact_matrix(table, name, reading) for name, table in parts.tables.items()
    }
    sizes = {name: _row_of(exact, name, len(names)) for name in ("shared", "private")}
    agents: list[dict[str, Any]] = [
        {
            "name": name,
            "shared": sizes["shared"][i],
            "private": sizes["private"][i],
            **{label: {} for label in MAPS},
        }
        for i, name in enumerate(names)
    ]
    document = {
        "format": FORMAT,
        "system": parts.texts.get("system", ""),
        "time": parts.texts["time"],
        "agents": agents,
    }
    for name, M in exact.items():
        match = _OF.fullmatch(name)
        if match is None:
            continue
        letter, i, kind, j, own = match.groups()
        for number in filter(None, (i, j)):
            if int(number) > len(names):
                raise InputError(f"there is no agent {number}", where=name)
        place = agents[int(i) - 1][MAPS["xzu".index(letter)]]
        if own is not None:
            place[{"z": "private", "r": "reference"}[own]] = matrix_json(M)
        else:
            of = place.setdefault({"y": "outputs", "x": "shared"}[kind], {})
            of[names[int(j) - 1]] = matrix_json(M)
    hold = exact.get("hold", Matrix.zeros(len(names), len(names)))
    if hold.shape != (len(names),) * 2 or hold.denominator != 1:
        raise InputError(f"expected {len(names)} × {len(names)} integers", where="hold")
    for i, j, d in hold.nonzero():
        agents[i].setdefault("hold", {})[names[j]] = d
    return read_controller(json.dumps(document), limits)


def _row_of(exact: Mapping[str, Matrix], name: str, count: int) -> list[int]:
    """A row or a column of sizes."""
    if name not in exact:
        raise InputError(f"the sizes '{name}' are missing", where=name)
    entries = [x for row in exact[name].rows() for x in row]
    if len(entries) != count or any(x.denominator != 1 for x in entries):
        raise InputError(f"expected {count} integers", where=name)
    return [int(x) for x in entries]
