"""Systems made from systems: dual, feedback, merged, extended, delayed, error system, loops.

Each construction takes a `MultiChannelSystem` and returns another one, which records its plant
and the construction in the words of the certificate format.  The checker repeats the construction
from the plant's matrices (`mcexact/checker/constructions.py`).  Block forms are in the
docstrings.

- `dual`: controllability becomes observability.
- `feedback`, `full_output`: static gains u_i = F_i y_i, and one channel that measures the state.
- `merged`, `restricted`: channels united, and channels left out.
- `failed`: agents, actuators, sensors and links that do nothing any more.
- `add_links`, `closure`, `augmented_outputs`: more communication, and neighbors' outputs as
  measurements.
- `extended_system`: agents also share sub-states (Paper, equation (25)).
- `lifted_system`: the same with delays, in discrete time; every message under way is a state.
- `held_system`: all agents, also the owner, use a sub-state equally late.
- `setpoint_system`: an integrator for every output.
- `regulated_outputs`, `servo_system`: combinations of the outputs, and an integrator for each.
- `internal_model`: the same with models of ramps, sinusoids and other signals.
- `error_system`: the estimation errors of the distributed observer.

For a system with parameters, `rearranged` applies those constructions whose entries are entries of
the plant, 0 or 1 (`REARRANGING`); `along_line` puts the parameters on a line; `looped` closes a
loop.
Delays in a file may be large, so systems with shared sub-states have at most 20,000 states.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import accumulate, count
from typing import Any, ClassVar, Literal, get_args, overload

from mcexact.errors import InputError, LimitReached, UsageError, one_of, several
from mcexact.exact.matrix import (
    Matrix,
    Rounding,
    block,
    block_diagonal,
    hstack,
    kronecker,
    matrix_from_float,
    vstack,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction, written
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.entries import as_matrix, require_shape
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem, values_by_name
from mcexact.model.signals import constant_signals, signal_polynomial
from mcexact.model.system import (
    Construction,
    MultiChannelSystem,
    any_system,
    require_discrete,
    with_graph,
)
from mcexact.model.text import quoted

# The dual system, in which controllability becomes observability.


def dual(system: MultiChannelSystem) -> MultiChannelSystem:
    """Return the system (A', C_i', B_i'), without a neighbor graph.

    Parameters
    ----------
    system : MultiChannelSystem

    Returns
    -------
    MultiChannelSystem
        The inputs of each channel correspond to its outputs in the given system, and conversely.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> dual(system).B(0).numerators
    ((1,), (0,))
    >>> dual(dual(system)).A == system.A
    True
    """
    any_system(system)
    return system.derived(
        system.A.T,
        [channel.C.T for channel in system.channels],
        [channel.B.T for channel in system.channels],
        {"construction": "dual"},
        D=system.feedthrough_matrix().T,
    )


# Static decentralized feedback, and a channel that measures the whole state.


def checked_gains(
    system: MultiChannelSystem,
    gains: Sequence[Any],
    widths: Sequence[int],
    *,
    rounding: Rounding | None = None,
) -> list[Matrix]:
    """Check and return gains F_i of p_i rows and ``widths[i]`` columns as exact matrices.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m matrices
    widths : sequence of m int
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats become exact; see `MultiChannelSystem.from_float`.

    Raises
    ------
    InputError
        If the number of gains is not m, a gain has the wrong shape, or there are floats and no
        rounding.
    """
    gains = several(gains, "gains", "matrices")
    if len(gains) != system.m:
        raise InputError(f"expected {system.m} gains, found {len(gains)}", where="gains")

    def exact(F: Any, i: int) -> Matrix:
        where = f"gains[{i}]"
        if rounding is not None and not isinstance(F, Matrix):
            return matrix_from_float(F, rounding, where=where)
        return as_matrix(F, where, ncols=widths[i])

    return [
        require_shape(exact(F, i), f"gains[{i}]", system.p(i), widths[i])
        for i, F in enumerate(gains)
    ]


def closed_by(system: MultiChannelSystem, gains: Sequence[Matrix]) -> Matrix:
    """Return A_F = A + Σ B_i F_i C_i, n×n, for gains whose shapes were checked.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m Matrix
        F_i, p_i×q_i; `checked_gains` converts a user's gains.
    """
    fed = [F @ channel.C for channel, F in zip(system.channels, gains, strict=True)]
    return system.A + system.input_matrix() @ vstack(fed, ncols=system.n)


def feedback(system: MultiChannelSystem, gains: Sequence[Any]) -> MultiChannelSystem:
    """Close the loop u_i = F_i y_i + v_i: A_F = A + Σ B_i F_i C_i in place of A.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m matrices
        F_i is p_i×q_i.

    Returns
    -------
    MultiChannelSystem
        (A_F, B_i, C_i).

    Raises
    ------
    InputError
        If a gain has the wrong shape.

    Examples
    --------
    >>> system = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[2]]])
    >>> feedback(system, [[[-3]], [[-4]]]).A.numerators
    ((-10,),)
    """
    exact = checked_gains(system, gains, [system.q(i) for i in range(system.m)])
    return system.derived(
        closed_by(system, exact),
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        {"construction": "feedback", "gains": tuple(exact)},
        neighbors=system.neighbors,
    )


def full_output(system: MultiChannelSystem, channel: int) -> MultiChannelSystem:
    """Let one channel measure the whole state: C_q becomes the n×n identity.

    Parameters
    ----------
    system : MultiChannelSystem
    channel : int
        q, counted from 0.

    Returns
    -------
    MultiChannelSystem
        It has no fixed mode, and every i with C_i ≠ 0 is reached from q, iff some F makes
        (A_F, B_q) controllable.

    Raises
    ------
    UsageError
        If there is no such channel.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> full_output(system, 0).C(0).numerators
    ((1, 0), (0, 1))
    """
    if not 0 <= channel < system.m:
        raise UsageError(f"expected a channel 0 … {system.m - 1}, found {channel}")
    C = [each.C for each in system.channels]
    C[channel] = Matrix.identity(system.n)
    return system.derived(
        system.A,
        [each.B for each in system.channels],
        C,
        {"construction": "full_output", "channel": system.names[channel]},
        neighbors=system.neighbors,
    )


# The plant with some of its channels merged.


def merged(system: MultiChannelSystem, parts: Sequence[Sequence[str]]) -> MultiChannelSystem:
    """Merge the channels of each part into one channel.

    Parameters
    ----------
    system : MultiChannelSystem
    parts : sequence of sequences of str
        The names of the channels of each part; every channel is in exactly one part.

    Returns
    -------
    MultiChannelSystem
        (A, B_T, C_T), one channel for each part T, in the order of first members, without a
        neighbor graph.  A channel of several members has their names, joined by "+".

    Raises
    ------
    UsageError
        If a part is empty, a name is unknown, the parts are not a partition of the channels, or two
        of the new channels would have the same name.

    Notes
    -----
    In block form, for a part T = {i, j, …} with i < j < …::

        B_T = [ B_i  B_j  … ]    n×(p_i + p_j + …)

              ⎡ C_i ⎤
        C_T = ⎢ C_j ⎥            (q_i + q_j + …)×n
              ⎣  ⋮  ⎦

    Gains of the plant are block diagonal gains of the result, so that merging adds no fixed mode.
    With all channels in one part, the fixed modes are the modes that all channels together do not
    control or do not observe.

    With the strong components of the plant's transfer graph as parts, the fixed modes of the
    result are those that no decentralized controller of the plant moves, not even one that varies
    with time or is nonlinear (``time_varying.no_causal_control_moves``); some such controller
    stabilizes the plant iff they are all stable (Anderson and Moore 1981; Gong and Aldeen 1997).
    The certificate of the result's fixed modes, with that of the transfer graph, implies the one
    and the other.

    Examples
    --------
    >>> from mcexact import fixed_spectrum, transfer_graph
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("movable-by-periodic-gains")
    >>> as_one = merged(plant, transfer_graph(plant).components)
    >>> as_one.names, as_one.B(0).numerators
    (('1+2',), ((1, 0), (0, 6), (0, -11)))
    >>> str(fixed_spectrum(plant).polynomial), str(fixed_spectrum(as_one).polynomial)
    ('x - 11/10', '1')
    >>> merged(plant, [["1"]])
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: parts: expected every channel in exactly one part, found '2' 0 times
    """
    any_system(system)
    parts = several(parts, "parts", "lists of names")
    groups = sorted(system.indices(part) for part in parts)
    if () in groups:
        raise UsageError("expected at least one channel in every part, found none", where="parts")
    mentioned = [name for part in parts for name in part]
    for name in system.names:
        if mentioned.count(name) != 1:
            raise UsageError(
                "expected every channel in exactly one part, "
                f"found {quoted(name)} {mentioned.count(name)} times",
                where="parts",
            )
    listed = [list(system.named(part)) for part in groups]
    names = ["+".join(part) for part in listed]
    forms = [unicodedata.normalize("NFC", name) for name in names]
    for name, form in zip(names, forms, strict=True):
        if forms.count(form) > 1:
            raise UsageError(f"two channels would have the name {quoted(name)}", where="parts")
    return system.derived(
        system.A,
        [system.input_matrix(part) for part in groups],
        [system.output_matrix(part) for part in groups],
        {"construction": "merged", "parts": listed},
        D=system.feedthrough_matrix(*[[i for part in groups for i in part]] * 2),
        names=names,
    )


# The plant restricted to some of its channels.


def restricted(system: MultiChannelSystem, channels: Sequence[str]) -> MultiChannelSystem:
    """Leave out all channels but these: nobody sets the other inputs or measures the other outputs.

    Parameters
    ----------
    system : MultiChannelSystem
    channels : sequence of str
        Names of channels, at least one.

    Returns
    -------
    MultiChannelSystem
        (A, B_i, C_i), i among the channels, in the order of the system, without a neighbor graph.

    Raises
    ------
    UsageError
        If there is no channel, or a name is unknown.

    Notes
    -----
    A controller of the result is one of the plant that does nothing at the other channels, so every
    fixed mode of the plant is one of the result.

    Examples
    --------
    >>> system = MultiChannelSystem([[0]], [[[1]], [[2]]], [[[3]], [[4]]], names=["left", "right"])
    >>> restricted(system, ["right"])
    MultiChannelSystem(n=1, m=1, continuous time, channels: 'right', restricted)
    >>> restricted(system, [])
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: channels: expected at least one channel, found none
    """
    any_system(system)
    chosen = system.indices(channels)
    if not chosen:
        raise UsageError("expected at least one channel, found none", where="channels")
    names = list(system.named(chosen))
    return system.derived(
        system.A,
        [system.B[i] for i in chosen],
        [system.C[i] for i in chosen],
        {"construction": "restricted", "channels": names},
        D=system.feedthrough_matrix(chosen, chosen),
        names=names,
    )


# The plant after failures.


def failed(
    system: MultiChannelSystem,
    *,
    agents: Iterable[str] = (),
    actuators: Iterable[tuple[str, int]] = (),
    sensors: Iterable[tuple[str, int]] = (),
    links: Iterable[tuple[str, str]] = (),
) -> MultiChannelSystem:
    """Let parts fail: actuators do nothing, sensors show nothing, links carry nothing.

    Parameters
    ----------
    system : MultiChannelSystem
        With feedthrough or without, with a neighbor graph or without.
    agents : iterable of str
        Agents without all their actuators, sensors and links.
    actuators, sensors : iterable of (str, int)
        An agent, and which of its inputs or outputs, counted from 1.
    links : iterable of (str, str)
        Agents j and i: i receives no message from j.

    Returns
    -------
    MultiChannelSystem
        The same channels, with zeros in the columns of B_i and the rows of C_i that belong to what
        failed, and in those of D; the neighbor graph has these links no more.

    Raises
    ------
    UsageError
        If nothing fails, or there is no such agent, input, output or link.

    Notes
    -----
    With diagonal matrices P_i and Q_i of ones, and zeros for what failed, the result has B_i P_i
    and Q_i C_i, and A + Σ B_i P_i F_i Q_i C_i is also a loop of the plant.  So every fixed mode of
    the plant is one of the result, and every mode that is fixed after some failures is fixed after
    more of them (``failures.fixed_after_more``).

    Examples
    --------
    >>> plant = MultiChannelSystem([[0]], [[[1, 2]], [[3]]], [[[4]], [[5]]], neighbors={"2": ["1"]})
    >>> broken = failed(plant, actuators=[("1", 2)], sensors=[("2", 1)], links=[("1", "2")])
    >>> broken.B(0).numerators, broken.C(1).numerators, broken.neighbors.edges()
    (((1, 0),), ((0,),), ())
    >>> failed(plant, agents=["2"]).B(1).numerators
    ((0,),)
    >>> failed(plant, actuators=[("2", 2)])
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: actuators: expected actuators of '2' from 1 to 1, found 2
    """
    any_system(system)
    lost = _Failures.of(system, agents, actuators, sensors, links)
    P = [lost.remaining("actuators", i, system.p(i)) for i in range(system.m)]
    Q = [lost.remaining("sensors", i, system.q(i)) for i in range(system.m)]
    return system.derived(
        system.A,
        [system.B(i) @ P_i for i, P_i in enumerate(P)],
        [Q_i @ system.C(i) for i, Q_i in enumerate(Q)],
        {"construction": "failed", **lost.named(system.names)},
        D=block_diagonal(Q) @ system.feedthrough_matrix() @ block_diagonal(P),
        neighbors=lost.graph(system.neighbors),
    )


@dataclass(frozen=True)
class _Failures:
    """What failed, by positions: agents, ports as (agent, number from 1), links as (j, i)."""

    agents: tuple[int, ...]
    ports: Mapping[str, tuple[tuple[int, int], ...]]
    links: tuple[tuple[int, int], ...]

    @classmethod
    def of(
        cls,
        system: MultiChannelSystem,
        agents: Iterable[str],
        actuators: Iterable[tuple[str, int]],
        sensors: Iterable[tuple[str, int]],
        links: Iterable[tuple[str, str]],
    ) -> _Failures:
        """Read failures by names."""
        sizes = {"actuators": system.p, "sensors": system.q}
        listed = {
            "actuators": several(actuators, "actuators"),
            "sensors": several(sensors, "sensors"),
        }
        ports = {}
        for what, size in sizes.items():
            known = [(system.index(name), k) for name, k in listed[what]]
            for i, k in known:
                if isinstance(k, bool) or not isinstance(k, int) or not 1 <= k <= size(i):
                    raise UsageError(
                        f"expected {what} of {quoted(system.names[i])} from 1 to {size(i)}, "
                        f"found {k!r}",
                        where=what,
                    )
            ports[what] = tuple(sorted({*known}))
        edges = () if system.neighbors is None else system.neighbors.edges()
        pairs = [(system.index(j), system.index(i)) for j, i in several(links, "links")]
        for j, i in pairs:
            if (j, i) not in edges:
                ends = f"{quoted(system.names[j])} to {quoted(system.names[i])}"
                raise UsageError(f"there is no link from {ends}", where="links")
        made = cls(system.indices(several(agents, "agents")), ports, tuple(sorted({*pairs})))
        if not (made.agents or any(ports.values()) or made.links):
            raise UsageError("expected at least one failure, found none")
        return made

    def named(self, names: Sequence[str]) -> dict[str, Any]:
        """The failures as a certificate has them."""
        return {
            "agents": [names[i] for i in self.agents],
            **{what: [[names[i], k] for i, k in listed] for what, listed in self.ports.items()},
            "links": [[names[j], names[i]] for j, i in self.links],
        }

    def remaining(self, what: str, i: int, size: int) -> Matrix:
        """The diagonal matrix of ones, and zeros for what failed of an agent."""
        gone = {k - 1 for agent, k in self.ports[what] if agent == i}
        kept = [i not in self.agents and k not in gone for k in range(size)]
        rows = [[int(k == j and kept[k]) for j in range(size)] for k in range(size)]
        return Matrix.from_integers(rows, ncols=size)

    def graph(self, graph: NeighborGraph | None) -> NeighborGraph | None:
        """The neighbor graph without the links that failed."""
        if graph is None:
            return None

        def works(j: int, i: int) -> bool:
            return (j, i) not in self.links and not {j, i} & {*self.agents}

        sets = [[j for j in N_i if j == i or works(j, i)] for i, N_i in enumerate(graph.neighbors)]
        delays = [(i, j, d) for i, j, d in graph.delays if works(j, i)]
        return NeighborGraph(graph.names, sets, delays)


# A plant with further communication links.


def add_links(
    system: MultiChannelSystem,
    added: Iterable[tuple[int, int]],
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem:
    """Add edges j → i to the neighbor graph: j joins N_i; A, B and C do not change.

    Parameters
    ----------
    system : MultiChannelSystem
    added : iterable of (j, i)
        Positions of channels; the new links have no delay.  An edge that exists already keeps its
        delay.
    graph : NeighborGraph, optional
        The graph that they are added to; overrides ``system.neighbors``.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If a position is out of range.

    Examples
    --------
    >>> system = MultiChannelSystem([[0]], [[[1]], [[1]]], [[[1]], [[1]]], neighbors={})
    >>> add_links(system, [(0, 1)]).neighbors.edges()
    ((0, 1),)
    """
    system, graph = with_graph(system, graph)
    added = list(added)
    joined = graph.with_edges(added)
    edges = sorted({(j, i) for j, i in added if j not in graph.neighborhood(i)})
    return system.derived(
        system.A,
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        {"construction": "arcs", "added": [[system.names[j], system.names[i]] for j, i in edges]},
        D=system.D,
        neighbors=joined,
    )


def closure(system: MultiChannelSystem, graph: NeighborGraph | None = None) -> MultiChannelSystem:
    """Add the links j → i of the transitive closure: those to i from all j with a path to i.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        The plant with these links.  What is fixed for `augmented_outputs` of it stays fixed under
        all linear time-invariant control over the graph, however many states the agents share, and
        nothing else does (``any_graph.any_sharing``).

    Raises
    ------
    UsageError
        If there is no neighbor graph.

    Examples
    --------
    >>> chain = {"2": ["1"], "3": ["2"]}
    >>> system = MultiChannelSystem([[0]], [[[1]]] * 3, [[[1]]] * 3, neighbors=chain)
    >>> closure(system).subject
    ({'construction': 'arcs', 'added': [['1', '3']]},)
    """
    any_system(system)
    system, graph = with_graph(system, graph)
    return add_links(system, graph.closure().edges())


# The system in which each agent also receives its neighbors' measured outputs.


def augmented_outputs(
    system: MultiChannelSystem, graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """Replace every C_i by C_{N_i}, the rows of C_j, j ∈ N_i, in the order of the channels.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        (A, B_i, C_{N_i}); a fixed mode of it cannot be moved by any linear time-invariant
        distributed controller whose agents send nothing but their measured outputs.  (Paper,
        section IV-B, equation `mss`.)

    Raises
    ------
    UsageError
        If there is no neighbor graph.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> cyclic = NeighborGraph.ring(plant.names)
    >>> augmented_outputs(plant, cyclic).C(1).numerators
    ((0, 1, 0), (0, 1, 0))
    >>> augmented_outputs(plant)
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: a neighbor graph is needed, and the system has none: add 'neighbors'
        to it
    """
    any_system(system)
    system, graph = with_graph(system, graph)
    received = [sorted(graph.neighborhood(i)) for i in range(system.m)]
    return system.derived(
        system.A,
        [channel.B for channel in system.channels],
        [system.output_matrix(senders) for senders in received],
        {"construction": "augmented_outputs"},
        D=system.feedthrough_matrix([j for senders in received for j in senders]),
        neighbors=graph,
    )


# Systems with parameters: constructions that only rearrange entries, and lines.

REARRANGING = frozenset(
    {
        "arcs",
        "augmented_outputs",
        "dual",
        "extended",
        "full_output",
        "integrators",
        "merged",
        "restricted",
    }
)
"""The constructions whose results have no entries but 0, 1 and those of the system."""
LINE = "line"
"""The construction that puts the parameters on a line, before those of `REARRANGING`."""


@dataclass(frozen=True, init=False, repr=False)
class DerivedParametricSystem(ParametricSystem):
    """A system with parameters that was constructed from another one."""

    origin: ParametricSystem
    steps: tuple[Construction, ...] = field(hash=False)

    @property
    def plant(self) -> ParametricSystem:
        """The system from which this one was constructed."""
        return self.origin

    @property
    def subject(self) -> tuple[Construction, ...]:
        """The constructions that lead from the plant to this system, in order."""
        return self.steps

    @cached_property
    def poles(self) -> tuple[Polynomial, ...]:
        """The irreducible polynomials at whose roots an entry of the plant is undefined."""
        if self.steps[0]["construction"] != LINE:
            return super().poles
        line = [*points_of(self).values()]
        zero = RationalFunction.constant(0, self.parameters)
        parts = [self.origin.A, *(M for c in self.origin.channels for M in (c.B, c.C))]
        entries = {entry for M in parts for row in M.rows for entry in row}
        below = {
            RationalFunction(e.parameters, e.denominator, e.denominator**0).substituted(line, zero)
            for e in entries
        }
        factors = {q.monic() for each in below for q, _ in each.polynomials()[0].factor()}
        return tuple(sorted(factors, key=lambda q: (q.degree, q.coefficients)))


def rearranged(
    system: ParametricSystem, construct: Callable[[MultiChannelSystem], MultiChannelSystem]
) -> ParametricSystem:
    """Apply constructions that only rearrange entries to a system with parameters.

    Parameters
    ----------
    system : ParametricSystem
        It has the neighbor graph without edges.
    construct : function of a MultiChannelSystem
        Applies constructions, all of `REARRANGING`.

    Returns
    -------
    ParametricSystem
        It records the plant and the constructions; at every value of the parameters it is what the
        constructions make from the plant there.

    Raises
    ------
    UsageError
        If a construction computes with entries.

    Notes
    -----
    The constructions are applied once, to a system of numbers: 0 in the place of each zero entry,
    and 2, 3, … in the places of the others.  In the result, each number is replaced by its entry.

    Examples
    --------
    >>> from mcexact.derived.constructions import dual
    >>> plant = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, "t^2"]]], parameters=["t"])
    >>> turned = rearranged(plant, dual)
    >>> print(turned.A[1, 0], "|", turned.channels[0].B[1, 0], "|", turned.subject)
    t | t^2 | ({'construction': 'dual'},)
    """
    zero, one = (RationalFunction.constant(k, system.parameters) for k in (0, 1))
    known, free = {0: zero, 1: one}, count(2)

    def numbered(M: FunctionMatrix) -> Matrix:
        rows = [[_number(entry, known, free) for entry in row] for row in M.rows]
        return Matrix.from_integers(rows, ncols=M.ncols)

    def entries(M: Matrix) -> FunctionMatrix:
        return FunctionMatrix(tuple(tuple(known[k] for k in row) for row in M.numerators), M.ncols)

    start = MultiChannelSystem(
        numbered(system.A),
        [numbered(channel.B) for channel in system.channels],
        [numbered(channel.C) for channel in system.channels],
        time=system.time,
        names=system.names,
        neighbors={},
    )
    image = construct(start)
    for step in image.subject:
        if step["construction"] not in REARRANGING:
            raise UsageError(f"{step['construction']} does not apply to systems with parameters")
    result = object.__new__(DerivedParametricSystem)
    ParametricSystem.__init__(
        result,
        entries(image.A),
        [entries(channel.B) for channel in image.channels],
        [entries(channel.C) for channel in image.channels],
        parameters=system.parameters,
        assume=dict(zip(system.parameters, system.ranges, strict=True)),
        time=image.time,
        names=image.names,
    )
    object.__setattr__(result, "origin", system.plant)
    object.__setattr__(result, "steps", (*system.subject, *image.subject))
    return result


def along_line(
    system: ParametricSystem,
    point: Mapping[Any, Any],
    direction: Mapping[Any, Any],
    parameter: str = "s",
) -> ParametricSystem:
    """The system on a line through the space of its parameters, each a + b s, for every s.

    Parameters
    ----------
    system : ParametricSystem
        With one parameter or several; their ranges are ignored on the line.
    point, direction : mapping
        For each parameter, by symbol or name, the exact numbers a and b; not every b is 0.
    parameter : str
        The letter s, which is none of the parameters.

    Returns
    -------
    ParametricSystem
        It records the plant and the line, before all other constructions, so that certificates
        about it name the plant: ``mcexact check --system`` accepts them with its file.

    Raises
    ------
    InputError
        If a number is missing, the direction is 0, or an entry is undefined on all of the line.
    UsageError
        If the parameter is one of the system, or the system is on a line already.

    Notes
    -----
    Exact.  Nothing is claimed where an entry of the plant is undefined, also where its numerator
    vanishes with the denominator on the line.

    Examples
    --------
    >>> plant = ParametricSystem([["a + b"]], [[["a"]]], [[["1/b"]]], parameters=["a", "b"])
    >>> line = along_line(plant, {"a": 1, "b": 0}, {"a": "1/2", "b": -1})
    >>> print(line.A[0, 0], "|", line.channels[0].C[0, 0], "|", *line.poles)
    -1/2*s + 1 | (-1)/(s) | x
    >>> along_line(plant, {"a": 1, "b": 0}, {"a": 1, "b": 0})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels[0].C: (1)/(b) is undefined there: its denominator is 0
    """
    InputError.require(system, ParametricSystem, "system")
    if parameter in system.parameters:
        raise UsageError(f"{parameter} is a parameter of the system: choose another letter")
    if any(step["construction"] == LINE for step in system.subject):
        raise UsageError("the system is on a line already: take one of the plant")
    start, slope = _numbers(system, point, "point"), _numbers(system, direction, "direction")
    if not any(slope.values()):
        raise InputError("expected a direction that is not 0", where="direction")
    line = _line(system, start, slope, parameter)
    restriction = system.along(line, [parameter])
    if system.subject:
        # also where an entry was left out that is undefined on the line
        system.plant.along(line, [parameter])
    result = object.__new__(DerivedParametricSystem)
    for key, value in vars(restriction).items():
        object.__setattr__(result, key, value)
    step = {
        "construction": LINE,
        "parameter": parameter,
        "point": {name: written(value) for name, value in start.items()},
        "direction": {name: written(value) for name, value in slope.items()},
    }
    object.__setattr__(result, "origin", system.plant)
    object.__setattr__(result, "steps", (step, *system.subject))
    return result


def points_of(line: ParametricSystem) -> dict[str, RationalFunction]:
    """The values of the parameters of the plant on the line that a system is on.

    Examples
    --------
    >>> plant = ParametricSystem([["a + b"]], [[[1]]], [[[1]]], parameters=["a", "b"])
    >>> [*map(str, points_of(along_line(plant, {"a": 1, "b": 0}, {"a": 2, "b": 1})).values())]
    ['2*s + 1', 's']
    """
    step = line.subject[0]
    point, direction = (
        {name: Fraction(value) for name, value in step[key].items()}
        for key in ("point", "direction")
    )
    return _line(line.plant, point, direction, step["parameter"])


def _numbers(system: ParametricSystem, value: Mapping[Any, Any], where: str) -> dict[str, Fraction]:
    """An exact number for each parameter."""
    known = values_by_name(value, system.parameters, where)
    missing = [name for name in system.parameters if name not in known]
    if missing:
        raise InputError(f"expected a number for the parameter {missing[0]!r}", where=where)
    return {name: as_fraction(known[name], where=f"{where}[{name}]") for name in system.parameters}


def _line(
    system: ParametricSystem,
    point: Mapping[str, Fraction],
    direction: Mapping[str, Fraction],
    parameter: str,
) -> dict[str, RationalFunction]:
    """For each parameter a + b s."""
    s = RationalFunction.parameter(parameter, (parameter,))
    return {name: direction[name] * s + point[name] for name in system.parameters}


def _number(
    entry: RationalFunction, known: dict[int, RationalFunction], free: Iterator[int]
) -> int:
    """Return 0 for 0, and for any other entry the number that represents it."""
    if entry.is_constant and entry.value == 0:
        return 0
    k = next(free)
    known[k] = entry
    return k


# The extended system, in which agents share sub-states in addition to their outputs.

Share = Literal["outputs+states", "states"]

LARGEST = 20_000
"""The largest number of states of a derived system, since delays in a file may be large."""


def checked_share(share: str) -> str:
    """Check and return the way of sharing.

    Raises
    ------
    InputError
        If it is neither ``"outputs+states"`` nor ``"states"``.
    """
    one_of(share, get_args(Share), "share", InputError)
    return share


def checked_dimensions(system: MultiChannelSystem, dimensions: Sequence[int]) -> tuple[int, ...]:
    """Check and return the dimensions n_1 … n_m of the shared sub-states.

    Raises
    ------
    InputError
        If their number is not m, or one is negative or not an integer.
    """
    sizes = several(dimensions, "dimensions", "integers")
    if len(sizes) != system.m:
        raise InputError(
            f"expected {system.m} dimensions, one for each agent, found {len(sizes)}",
            where="dimensions",
        )
    for i, size in enumerate(sizes):
        if isinstance(size, bool) or not isinstance(size, int) or size < 0:
            raise InputError(f"expected an integer >= 0, found {size!r}", where=f"dimensions[{i}]")
    return sizes


def selector(start: int, size: int, total: int) -> Matrix:
    """The ``total``×``size`` matrix with an identity at the rows from ``start``, else zeros.

    This is the paper's E_i, H_iδ, Q_iδ' and L_iδ.

    Examples
    --------
    >>> selector(1, 2, 3).numerators
    ((0, 0), (1, 0), (0, 1))
    """
    return Matrix.from_entries((total, size), [(start + k, k, 1) for k in range(size)])


def shift(d: int) -> Matrix:
    """S_d, the d×d shift matrix: ones just below the diagonal.

    Examples
    --------
    >>> shift(3).numerators
    ((0, 0, 0), (1, 0, 0), (0, 1, 0))
    """
    return Matrix.from_entries((d, d), [(j + 1, j, 1) for j in range(d - 1)])


def require_size(states: int) -> None:
    """Raise an error for a system with too many states.

    Raises
    ------
    LimitReached
        If there are more than `LARGEST` states.
    """
    if states > LARGEST:
        raise LimitReached(
            f"this would be a system of {states} states, more than {LARGEST}; share fewer states, "
            "or shorten the delays"
        )


@overload
def extended_system(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem: ...


@overload
def extended_system(
    system: ParametricSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> ParametricSystem: ...


def extended_system(
    system: MultiChannelSystem | ParametricSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem | ParametricSystem:
    """Append to every agent i a shared sub-state x_i of dimension n_i with ẋ_i = v_i.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
    dimensions : sequence of m int
        n_1 … n_m, each ≥ 0.
    share : {"outputs+states", "states"}
        Whether agents receive their neighbors' outputs in addition to their sub-states.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``; a system with parameters has none of its own.

    Returns
    -------
    MultiChannelSystem or ParametricSystem
        n̄ = n + Σ n_i states.  A distributed controller of the plant is a decentralized one of it.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If the dimensions or the way of sharing are not as expected.

    Notes
    -----
    Paper, section IV-C, equation (25), and Remark 2 for ``share="states"``.  In block form, with
    x̄ = (x, x_1, …, x_m), ū_i = (u_i, v_i) and ȳ_i = (y_j, j ∈ N_i, then x_j, j ∈ N_i), neighbors
    in the order of the channels::

            ⎡ A  0 ⎤            ⎡ B_i   0  ⎤            ⎡ C_{N_i}     0     ⎤
        Ā = ⎣ 0  0 ⎦ ,    B̄_i = ⎣  0   E_i ⎦ ,    C̄_i = ⎣    0     E'_{N_i} ⎦

    E_i, of Σ n_j rows and n_i columns, holds the identity at the rows of x_i, and E_{N_i} = [E_j],
    j ∈ N_i.  With ``share="states"`` C_i stands in place of C_{N_i}.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> cyclic = NeighborGraph.ring(plant.names)
    >>> extended = extended_system(plant, [0, 0, 1], graph=cyclic)
    >>> extended.n, extended.C(1).numerators
    (4, ((0, 1, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
    """
    if isinstance(system, ParametricSystem):
        links = () if graph is None else graph.edges()
        return rearranged(
            system,
            lambda bare: extended_system(
                add_links(bare, links) if links else bare, dimensions, share
            ),
        )
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    construction = {"construction": "extended", "share": share, "dimensions": dimensions}
    return with_shared_sub_states(system, graph, construction, lambda i, j: 0)


def with_shared_sub_states(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    construction: Mapping[str, Any],
    delay: Callable[[int, int], int],
) -> MultiChannelSystem:
    """Append shared sub-states and the messages under way, in the block form of `lifted_system`.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
    construction : mapping
        Its ``dimensions`` n_1 … n_m, and what agents ``share``; `held_system` does not have the
        latter, since its agents share sub-states alone.
    delay : function of i and j
        The number of steps after which agent i receives x_j, and y_j if outputs are shared.
    """
    sizes = checked_dimensions(system, construction["dimensions"])
    shares_outputs = checked_share(construction.get("share", "states")) == "outputs+states"
    n, m = system.n, system.m
    delays = [{j: delay(i, j) for j in graph.neighborhood(i)} for i in range(m)]  # d_ij, j in N_i
    longest = [max(steps.get(j, 0) for steps in delays) for j in range(m)]  # d_j
    widths = [system.q(j) if shares_outputs else 0 for j in range(m)]  # q_j; 0 without outputs
    blocks = [k + d * (k + q) for d, k, q in zip(longest, sizes, widths, strict=True)]
    starts = [0, *accumulate(blocks)]
    require_size(n + starts[m])

    def x(j: int, steps: int) -> Matrix:
        return selector(starts[j] + steps * sizes[j], sizes[j], starts[m])

    def y(j: int, steps: int) -> Matrix:
        behind = (longest[j] + 1) * sizes[j] + (steps - 1) * widths[j]
        return selector(starts[j] + behind, widths[j], starts[m])

    K, G, C = [], [], []
    for j, d in enumerate(longest):
        K += [kronecker(shift(d + 1), Matrix.identity(sizes[j]))]
        K += [kronecker(shift(d), Matrix.identity(widths[j]))]
        entering = system.C(j) if shares_outputs and d else Matrix.zeros(0, n)
        G += [Matrix.zeros((d + 1) * sizes[j], n), entering]
        G += [Matrix.zeros(d * widths[j] - entering.nrows, n)]
    for i, steps in enumerate(delays):
        at_once = [j for j in steps if not steps[j]] if shares_outputs else [i]
        under_way = [y(j, steps[j]) for j in steps if steps[j] and shares_outputs]
        states = [x(j, steps[j]) for j in steps]
        received = hstack([*under_way, *states], nrows=starts[m]).T
        C.append(block_diagonal([system.output_matrix(at_once), received]))
    return system.derived(
        block([[system.A, Matrix.zeros(n, starts[m])], [vstack(G), block_diagonal(K)]]),
        [block_diagonal([system.B(i), x(i, 0)]) for i in range(m)],
        C,
        {**construction, "dimensions": list(sizes)},
        neighbors=graph,
    )


# The plant with an integrator of every output, for set-point control.


def setpoint_system(system: MultiChannelSystem) -> MultiChannelSystem:
    """Append w with ẇ_i = y_i − r_i, in discrete time w_i(t+1) = w_i + y_i − r_i.

    Parameters
    ----------
    system : MultiChannelSystem

    Returns
    -------
    MultiChannelSystem
        n + Σ q_i states.  Agent i measures w_i.  A linear time-invariant controller that
        stabilizes it holds every y_i at r_i.

    Notes
    -----
    Paper, section III, equation `b1`.  In block form, C all C_i below each other::

            ⎡ A  0 ⎤            ⎡ B_i ⎤
        Ã = ⎣ C  W ⎦ ,    B̃_i = ⎣  0  ⎦ ,    C̃_i = [ 0  e_i' ]

    W = 0 in continuous and W = I in discrete time, and e_i' are the rows of the identity that
    belong to y_i. The references enter as −r in the lower rows.

    Examples
    --------
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[3]]], time="discrete")
    >>> setpoint_system(plant).A.numerators
    ((2, 0), (3, 1))
    """
    InputError.require(system, MultiChannelSystem, "system")
    A, B, measured = _modeled(system, list(system.C), constant_signals(system.time))
    return system.derived(
        A, B, measured, {"construction": "integrators"}, neighbors=system.neighbors
    )


def _modeled(
    system: MultiChannelSystem, rows: Sequence[Matrix], signals: Polynomial
) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    """Return Ã, the B̃_i without feedthrough, and the rows that select each agent's w_i.

    w_i = (w_i^1, …, w_i^d), d the degree of α = ``signals``: each block is the derivative of the
    block before it, or its next value, and α of this applied to the first block is ``rows[i]`` x.
    """
    n, d = system.n, signals.degree
    companion = companion_matrix(signals)
    W = block_diagonal([kronecker(companion, Matrix.identity(each.nrows)) for each in rows])
    driven = [vstack([Matrix.zeros((d - 1) * each.nrows, n), each], ncols=n) for each in rows]
    sizes = [d * each.nrows for each in rows]
    total, starts = sum(sizes), [0, *accumulate(sizes)]
    return (
        block([[system.A, Matrix.zeros(n, total)], [vstack(driven, ncols=n), W]]),
        [vstack([system.B(i), Matrix.zeros(total, system.p(i))]) for i in range(system.m)],
        [selector(n + start, k, n + total).T for start, k in zip(starts[:-1], sizes, strict=True)],
    )


def companion_matrix(p: Polynomial) -> Matrix:
    """Return the companion matrix of a monic p, with ones above the diagonal.

    Parameters
    ----------
    p : Polynomial
        Of degree d ≥ 1.

    Returns
    -------
    Matrix
        d×d; its last row has the coefficients of p with their signs changed, and v' = M v has the
        solutions (y, y', …, y^(d−1)) with p(d/dt) y = 0.

    Examples
    --------
    >>> companion_matrix(Polynomial.of(4, 0, 1)).numerators
    ((0, 1), (-4, 0))
    """
    d = p.degree
    last = Matrix.from_rows([[-c for c in p.coefficients[:d]]], ncols=d)
    return vstack([hstack([Matrix.zeros(d - 1, 1), Matrix.identity(d - 1)]), last], ncols=d)


# Regulated outputs: what is to be held at set-points, apart from what is measured.


def checked_selection(system: MultiChannelSystem, selection: Sequence[Any]) -> list[Matrix]:
    """Check and return S_i of any number of rows and q_i columns, one for each channel.

    Parameters
    ----------
    system : MultiChannelSystem
    selection : sequence of m matrices

    Raises
    ------
    InputError
        If the number of matrices is not m, or one has a wrong number of columns.
    """
    selection = several(selection, "selection", "matrices")
    if len(selection) != system.m:
        raise InputError(f"expected {system.m} matrices, found {len(selection)}", where="selection")
    exact = [as_matrix(S, f"selection[{i}]", ncols=system.q(i)) for i, S in enumerate(selection)]
    return [require_shape(S, f"selection[{i}]", S.nrows, system.q(i)) for i, S in enumerate(exact)]


def regulated_outputs(system: MultiChannelSystem, selection: Sequence[Any]) -> MultiChannelSystem:
    """Replace the outputs y_i by S_i y_i: the system (A, B_i, S_i C_i).

    Parameters
    ----------
    system : MultiChannelSystem
    selection : sequence of m matrices
        S_i, any number of rows and q_i columns.

    Returns
    -------
    MultiChannelSystem
        Its set-points are those of S_i y_i alone: `setpoint_solvability` decides whether all of
        them have an equilibrium.

    Raises
    ------
    InputError
        As for `checked_selection`.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0], [0, 1]]])
    >>> regulated_outputs(plant, [[[1, 0]]]).C(0).numerators
    ((1, 0),)
    """
    any_system(system)
    exact = checked_selection(system, selection)
    return system.derived(
        system.A,
        [channel.B for channel in system.channels],
        [S @ channel.C for S, channel in zip(exact, system.channels, strict=True)],
        {"construction": "regulated", "gains": tuple(exact)},
        D=block_diagonal(exact) @ system.feedthrough_matrix(),
        neighbors=system.neighbors,
    )


def servo_system(system: MultiChannelSystem, selection: Sequence[Any]) -> MultiChannelSystem:
    """Append σ with σ̇_i = S_i (y_i − r_i), in discrete time σ_i(t+1) = σ_i + S_i (y_i − r_i).

    Parameters
    ----------
    system : MultiChannelSystem
    selection : sequence of m matrices
        S_i, k_i rows and q_i columns.

    Returns
    -------
    MultiChannelSystem
        n + Σ k_i states.  Agent i measures (σ_i, y_i).  A linear time-invariant controller that
        stabilizes it holds every S_i y_i at S_i r_i.

    Raises
    ------
    InputError
        As for `checked_selection`.

    Notes
    -----
    In block form, with S = diag(S_i) and all C_i below each other in C::

            ⎡ A   0 ⎤            ⎡ B_i ⎤           ⎡  0   e_i' ⎤
        Ã = ⎣ SC  W ⎦ ,    B̃_i = ⎣  0  ⎦ ,    C̃_i = ⎣ C_i   0  ⎦

    W = 0 in continuous and W = I in discrete time, and e_i' are the rows of the identity that
    belong to σ_i. The references enter as −S r in the lower rows.

    With all S_i = I it has the fixed modes of `setpoint_system`: the rows of the integrators in the
    pencils of complementary subsystems are C_i, beside −λ σ_i.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0], [0, 1]]])
    >>> servo_system(plant, [[[1, 0]]]).C(0).numerators
    ((0, 0, 1), (1, 0, 0), (0, 1, 0))
    """
    InputError.require(system, MultiChannelSystem, "system")
    exact = checked_selection(system, selection)
    A, B, C = _with_models(system, exact, constant_signals(system.time))
    return system.derived(
        A,
        B,
        C,
        {"construction": "servo", "gains": tuple(exact)},
        neighbors=system.neighbors,
    )


def _with_models(
    system: MultiChannelSystem, selection: Sequence[Matrix], signals: Polynomial
) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    """Return Ã, the B̃_i without feedthrough, and the C̃_i, where agent i measures (w_i, y_i)."""
    held = [S @ channel.C for S, channel in zip(selection, system.channels, strict=True)]
    A, B, own = _modeled(system, held, signals)
    C = [
        vstack([rows, hstack([channel.C, Matrix.zeros(channel.C.nrows, A.nrows - system.n)])])
        for rows, channel in zip(own, system.channels, strict=True)
    ]
    return A, B, C


def internal_model(
    system: MultiChannelSystem, signals: Any, selection: Sequence[Any] | None = None
) -> MultiChannelSystem:
    """Append models of signals: α(d/dt) w_i^1 = S_i (y_i − r_i), in discrete time α of the shift.

    Parameters
    ----------
    system : MultiChannelSystem
        n states; it may have feedthrough.
    signals : str, sequence of str, or Polynomial
        The signals, or α, whose solutions they are, monic of degree d ≥ 1; see
        `signal_polynomial`.
    selection : sequence of m matrices, optional
        S_i, k_i rows and q_i columns; by default the identities, for all outputs.

    Returns
    -------
    MultiChannelSystem
        n + d Σ k_i states.  Agent i measures (w_i, y_i), w_i = (w_i^1, …, w_i^d).  With a linear
        time-invariant controller that stabilizes it, S_i (y_i − r_i) tends to 0 for all references
        and disturbances that are solutions of α.

    Raises
    ------
    InputError
        As for `checked_selection` and `signal_polynomial`.

    Notes
    -----
    In block form, with M_i = companion(α) ⊗ I, which has ones above the diagonal, and E_i the last
    k_i columns of the identity of d k_i rows::

            ⎡  A          0        ⎤          ⎡   B_j    ⎤          ⎡  0   e_i' ⎤
        Ã = ⎣ E_iS_iC_i  diag(M_i) ⎦ ,  B̃_j = ⎣ E_iS_iD_ij ⎦ ,  C̃_i = ⎣ C_i   0  ⎦

    and D̃_i = [0; D_i].  The references enter as −E_i S_i r_i.  For set-points, where α is s, or
    z − 1 in discrete time, these are the matrices of `servo_system`.

    With d > 1 agent i may as well measure w_i^1 alone: the fixed modes are the same.

    The fixed modes that are no roots of α are those of the plant.  If every S_i is the identity, a
    root λ of α is fixed iff the rank of [λI − A, −B_T; C, D_T] is below n + Σ_{i ∈ T} q_i for some
    set T of channels (``proofs/internal_model.md``).

    Examples
    --------
    >>> plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    >>> tracking = internal_model(plant, "sine:2")
    >>> tracking.A.numerators
    ((-1, 0, 0), (0, 0, 1), (1, -4, 0))
    >>> tracking.C(0).numerators
    ((0, 1, 0), (0, 0, 1), (1, 0, 0))

    The output u' + 4 u of this plant vanishes for sinusoids of 2 rad per unit of time:

    >>> from mcexact.analysis.fixed_modes import fixed_spectrum
    >>> notch = MultiChannelSystem([[0, 1], [-1, -2]], [[[0], [1]]], [[[3, -2]]], D=[[1]])
    >>> print(fixed_spectrum(internal_model(notch, "sine:2")).polynomial)
    x^2 + 4
    >>> print(fixed_spectrum(internal_model(notch, "ramp")).polynomial)
    1
    """
    any_system(system)
    alpha = signal_polynomial(signals, system.time)
    if selection is None:
        selection = [Matrix.identity(system.q(i)) for i in range(system.m)]
    exact = checked_selection(system, selection)
    A, B, C = _with_models(system, exact, alpha)
    D = None
    if system.D is not None:
        D = system.feedthrough_matrix()
        into, seen = list[Matrix](), list[Matrix]()
        for i, S in enumerate(exact):
            own, k = system.feedthrough_matrix([i]), alpha.degree * S.nrows
            into += [Matrix.zeros(k - S.nrows, D.ncols), S @ own]
            seen += [Matrix.zeros(k, D.ncols), own]
        driven = vstack([system.input_matrix(), *into], ncols=D.ncols)
        ends = list(accumulate(system.p(i) for i in range(system.m)))
        starts = [0, *ends[:-1]]
        B = [driven.take(cols=range(a, b)) for a, b in zip(starts, ends, strict=True)]
        D = vstack(seen, ncols=D.ncols)
    return system.derived(
        A,
        B,
        C,
        {
            "construction": "internal_model",
            "polynomial": alpha,
            "gains": tuple(exact),
        },
        D=D,
        neighbors=system.neighbors,
    )


# The extended systems with delays, in which every message under way is a state.


def lifted_system(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem:
    """Extend the plant by shared sub-states and by the messages that are under way.

    Agent i receives (y_j(t−d_ij), x_j(t−d_ij)), j ∈ N_i, or x_j(t−d_ij) and its own y_i alone when
    only sub-states are shared.

    Parameters
    ----------
    system : MultiChannelSystem
        In discrete time.
    dimensions : sequence of m int
        n_1 … n_m, each ≥ 0.
    share : {"outputs+states", "states"}
    graph : NeighborGraph, optional
        With the delays d_ij on its edges; overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        ñ = n + Σ (n_i + d_i n_i + d_i q_i) states, d_i the largest delay to a follower of i;
        without the d_i q_i when only sub-states are shared.

    Raises
    ------
    UsageError
        If there is no neighbor graph, or the system is in continuous time.
    InputError
        If the dimensions or the way of sharing are not as expected.
    LimitReached
        If there would be more than 20000 states.

    Notes
    -----
    Paper, section V-A, equations (34) and (35).  The state is
    (x, x_1, w_1, x_2, w_2, …), w_j = (x_j(t−1), …, x_j(t−d_j), y_j(t−1), …, y_j(t−d_j)), and w_j
    is empty when d_j = 0.  In block form::

            ⎡ A  0 ⎤            ⎡ B_i    0   ⎤            ⎡ C_{N⁰_i}     0     ⎤
        Ã = ⎣ G  K ⎦ ,    B̃_i = ⎣  0   H_{i0} ⎦ ,   C̃_i = ⎢    0      Q_{N⁺_i} ⎥
                                                          ⎣    0      H'_{N_i}  ⎦

        K = diag(S_{d_1+1} ⊗ I_{n_1},  S_{d_1} ⊗ I_{q_1},  S_{d_2+1} ⊗ I_{n_2},  …)
        G = (G_1; …; G_m),  G_j = (0_{(d_j+1)n_j×n}; C_j; 0_{(d_j−1)q_j×n})  for d_j ≥ 1
                            G_j = 0_{n_j×n}                                 for d_j = 0

    S_d is the d×d shift matrix, with ones just below the diagonal. N⁰_i are the neighbors with
    d_ij = 0 and N⁺_i those with d_ij > 0, so that i receives undelayed outputs first, then the
    delayed ones, then all sub-states; this is the order of (35), not that of the paper's ỹ_i, which
    has all outputs in the order of the neighbors. H_jδ picks x_j(t−δ) and Q_jδ picks y_j(t−δ);
    H_{N_i} = [H_{j d_ij}], Q_{N⁺_i} = (Q_{j d_ij}), in the order of the channels. The paper's G_j
    would have −1 block rows when d_j = 0. With ``share="states"`` (the unnumbered paragraph after
    the proof of Theorem 3) there are neither y_j(t−δ) nor G, and C̃_i = diag(C_i, H'_{N_i}).

    Examples
    --------
    >>> graph = NeighborGraph(("1", "2"), [[1], [0]], [(0, 1, 2)])
    >>> plant = MultiChannelSystem(
    ...     [[1]], [[[1]], [[1]]], [[[3]], [[5]]], time="discrete", neighbors=graph)
    >>> lifted = lifted_system(plant, [0, 1])
    >>> lifted.n  # x, x_2, x_2(t-1), x_2(t-2), y_2(t-1), y_2(t-2)
    6
    >>> lifted.A.numerators[4]  # y_2(t) becomes y_2(t-1)
    (5, 0, 0, 0, 0, 0)
    >>> lifted.C(0).numerators  # agent 1 sees y_1(t), y_2(t-2), x_2(t-2)
    ((3, 0, 0, 0, 0, 0), (0, 0, 0, 0, 0, 1), (0, 0, 0, 1, 0, 0))
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    require_discrete(system)
    construction = {"construction": "lifted", "share": share, "dimensions": dimensions}
    return with_shared_sub_states(system, graph, construction, graph.delay)


def held_system(
    system: MultiChannelSystem, dimensions: Sequence[int], graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """Extend the plant by shared sub-states that all agents, also their owner, use d_i steps late.

    Agent i sends its sub-state to follower k after holding it for d_i − d_ki steps, and keeps it
    from itself for d_i steps, so that all followers use x_i(t−d_i) at the same time.  Measured
    outputs are not sent.

    Parameters
    ----------
    system : MultiChannelSystem
        In discrete time.
    dimensions : sequence of m int
        n_1 … n_m, each ≥ 0.
    graph : NeighborGraph, optional
        With the delays d_ij on its edges; overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        n̂ = n + Σ (n_i + d_i n_i) states, d_i the largest delay to a follower of i.

    Raises
    ------
    UsageError
        If there is no neighbor graph, or the system is in continuous time.
    InputError
        If the dimensions are not as expected.
    LimitReached
        If there would be more than 20000 states.

    Notes
    -----
    Paper, section V-B, equations (37) and (38).  The state is
    (x, x_1(t), …, x_1(t−d_1), x_2(t), …, x_m(t−d_m)).  In block form::

        Â = diag(A, S_{d_1+1} ⊗ I_{n_1}, …, S_{d_m+1} ⊗ I_{n_m})

              ⎡ B_i    0   ⎤            ⎡ C_i              0               ⎤
        B̂_i = ⎣  0   L_{i0} ⎦ ,   Ĉ_i = ⎣  0   [L_{j d_j}, j ∈ N_i]'       ⎦

    S_d is the d×d shift matrix, with ones just below the diagonal, and L_jδ picks x_j(t−δ),
    0 ≤ δ ≤ d_j; with d_j = 0 the block is S_1 ⊗ I = 0, as in the extended system without delays.

    Examples
    --------
    >>> graph = NeighborGraph(("1", "2"), [[1], [0]], [(0, 1, 2)])
    >>> plant = MultiChannelSystem(
    ...     [[1]], [[[1]], [[1]]], [[[3]], [[5]]], time="discrete", neighbors=graph)
    >>> held = held_system(plant, [0, 1])
    >>> held.n  # x, x_2, x_2(t-1), x_2(t-2)
    4
    >>> held.C(1).numerators  # agent 2 sees y_2(t) and its own x_2(t-2)
    ((5, 0, 0, 0), (0, 0, 0, 1))
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    require_discrete(system)
    longest = [graph.longest_delay(j) for j in range(system.m)]
    construction = {"construction": "held", "dimensions": dimensions}
    return with_shared_sub_states(system, graph, construction, lambda i, j: longest[j])


# Neighbor graphs that vary with time, in discrete time: the plant in windows of several steps.
#
# Over a graph that varies, no single graph need be connected.  If every window of Q steps shows all
# links of one graph, agents can act as if they had that graph and a longer step, the window: they
# measure in its first n steps with all inputs 0, act in its last n steps, and send the same
# sub-state throughout, which every follower has received when the window ends, and uses in the next
# one.  That is the held system of section V-B, with the delay 1 on every link.


def union_graph(graphs: Sequence[NeighborGraph]) -> NeighborGraph:
    """Return the graph of all links that occur in some of these graphs, without delays.

    Parameters
    ----------
    graphs : sequence of NeighborGraph
        At least one, on the same agents in the same order, such as those of one period.

    Raises
    ------
    InputError
        If there is no graph, the agents differ, or a graph has delays.

    Examples
    --------
    >>> names = ("1", "2", "3")
    >>> graphs = [NeighborGraph(names, [[1], [], []]), NeighborGraph(names, [[], [2], []])]
    >>> union_graph(graphs).neighbors
    ((0, 1), (1, 2), (2,))
    """
    if not graphs:
        raise InputError("expected at least one graph, found none", where="graphs")
    first = graphs[0]
    for k, graph in enumerate(graphs):
        InputError.require(graph, NeighborGraph, f"graphs[{k}]")
        if graph.names != first.names:
            raise InputError("expected the agents of the first graph", where=f"graphs[{k}]")
        if graph.delays:
            raise InputError("expected a graph without delays", where=f"graphs[{k}]")
    heard = [{j for graph in graphs for j in graph.neighborhood(i)} for i in range(first.m)]
    return NeighborGraph(first.names, heard)


def slow_system(
    system: MultiChannelSystem,
    window: int,
    graphs: NeighborGraph | Sequence[NeighborGraph] | None = None,
) -> MultiChannelSystem:
    """Take Q steps of a plant as one: measurements in the first n of them, inputs in the last n.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant in discrete time, with n states.
    window : int
        Q ≥ 2n, such that every window of Q steps shows every link of the union of the graphs.  If
        the graphs repeat with a period, a window that is at least as long does.
    graphs : NeighborGraph, or sequence of them, optional
        The graphs of one period, or their union; overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        With n states, n p_i inputs and n q_i outputs of channel i, over the union of the graphs
        with the delay 1 on every link::

            A_Q = A^Q,   B_Q,i = [A^{n−1} B_i  …  A B_i  B_i],   C_Q,i = [C_i; …; C_i A^{n−1}]

    Raises
    ------
    UsageError
        If there is no neighbor graph, the system is in continuous time, or the window is shorter.
    LimitReached
        If there would be too many inputs or outputs.

    Notes
    -----
    Exact.  x(t + Q) = A^Q x(t) + Σ_i Σ_k A^{n−1−k} B_i u_i(t + Q − n + k), and y_i(t + k) =
    C_i A^k x(t) for k < n.  So a controller of `held_system` of the result, which reads all outputs
    of a window and then gives all inputs of it, is one over the graphs that vary.  With the bound
    (27) of the result as dimensions no mode is fixed; that this suffices is a sufficient condition.

    Examples
    --------
    >>> plant = MultiChannelSystem([[2]], [[[1]], [[0]]], [[[0]], [[1]]], time="discrete")
    >>> one, other = NeighborGraph(plant.names, [[1], []]), NeighborGraph(plant.names, [[], [0]])
    >>> slow = slow_system(plant, 2, [one, other])
    >>> slow.A.numerators, slow.neighbors.edges()
    (((4,),), ((0, 1), (1, 0)))
    >>> slow.neighbors.delay(0, 1)
    1
    """
    InputError.require(system, MultiChannelSystem, "system")
    if isinstance(graphs, NeighborGraph):
        graphs = [graphs]
    system, graph = with_graph(system, None if graphs is None else union_graph(graphs))
    require_discrete(system)
    n, m = system.n, system.m
    if type(window) is not int or window < max(2 * n, 1):
        expected = f"expected an integer of at least {max(2 * n, 1)}, found {window!r}"
        raise UsageError(expected, where="window")
    require_size(n * max((system.p(i) + system.q(i) for i in range(m)), default=0))
    powers = [Matrix.identity(n)]
    for _ in range(n - 1):
        powers.append(system.A @ powers[-1])
    late = [(i, j, 1) for j, i in graph.edges()]
    return system.derived(
        system.A.power(window),
        [hstack([P @ system.B(i) for P in reversed(powers[:n])], nrows=n) for i in range(m)],
        [vstack([system.C(i) @ P for P in powers[:n]], ncols=n) for i in range(m)],
        {"construction": "slow", "window": window},
        neighbors=NeighborGraph(graph.names, graph.neighbors, late),
    )


# The open-loop error system of the distributed observer.


def error_system(
    system: MultiChannelSystem, gains: Sequence[Any], graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """Build the m-channel system of the estimation errors e_i = x_i − x under substitution.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m matrices
        The state feedbacks F_i, p_i×n.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        nm states ε = (e_1, …, e_m), n inputs in every channel.  Decentralized static feedback of
        it by [K_i, H_ij, …] is the paper's error system without the channel controller.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If a gain has the wrong shape.

    Notes
    -----
    Paper, section II-D, equations `com.o` and `anal`.  In block form::

        Ã = I_m ⊗ (A + Σ_j B_j F_j) − Q,    Q_ij = B_j F_j,    B̃_i = b_i ⊗ I_n

        C̃_i ε = ( C_i e_i ;  e_i − e_j, j ∈ N_i∖{i}, in the order of the channels )

    b_i is the i-th unit vector of length m.  The block e_i − e_i = 0 that the paper carries along
    is left out.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[3]], [[5]]], neighbors={"1": ["2"]})
    >>> errors = error_system(plant, [[[-2]], [[-7]]])
    >>> errors.A.numerators  # 1 − 2 − 7 on the diagonal, less B_j F_j in column j
    ((-6, 7), (2, -1))
    >>> errors.C(0).numerators, errors.C(1).numerators
    (((3, 0), (1, -1)), ((0, 5),))
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    n, m = system.n, system.m
    exact = checked_gains(system, gains, [n] * m)
    driven = [system.B(j) @ exact[j] for j in range(m)]
    closed = sum(driven, system.A)
    A = block_diagonal([closed] * m) - block([driven] * m)
    pick = [selector(i * n, n, n * m).T for i in range(m)]
    C = []
    for i in range(m):
        others = [j for j in graph.neighborhood(i) if j != i]
        C.append(vstack([system.C(i) @ pick[i], *(pick[i] - pick[j] for j in others)]))
    return system.derived(
        A,
        [each.T for each in pick],
        C,
        {"construction": "error", "gains": tuple(exact)},
        neighbors=graph,
    )


# Systems with parameters: closed loops.

Construct = Callable[[MultiChannelSystem], MultiChannelSystem]


@dataclass(frozen=True)
class ParametricLoop:
    """The closed loop of a system with parameters and one controller.

    Attributes
    ----------
    given : ParametricSystem
    construct : callable
        Closes the loop of a system without parameters, perhaps after other constructions.
    subject : tuple of mapping
        The constructions that lead from the plant to the loop, in order.
    n : int
        The dimension of the loop's state.
    """

    given: ParametricSystem
    construct: Construct = field(compare=False, repr=False)
    subject: tuple[Construction, ...] = field(hash=False)
    n: int
    names: ClassVar[tuple[str, ...]] = ()
    m: ClassVar[int] = 0

    @property
    def plant(self) -> ParametricSystem:
        """The user's plant."""
        return self.given.plant

    @property
    def time(self) -> str:
        """The time domain of the plant."""
        return self.given.time

    @property
    def name(self) -> str | None:
        """The name of the plant."""
        return self.given.name

    def at(self, values: Any) -> MultiChannelSystem:
        """The loop at a value of every parameter, as `ParametricSystem.at` takes them."""
        return self.construct(self.given.at(values).with_neighbors({}))


def looped(system: ParametricSystem, construct: Construct) -> ParametricLoop:
    """Close the loop of a system with parameters.

    Parameters
    ----------
    system : ParametricSystem
        It has the neighbor graph without edges.
    construct : function of a MultiChannelSystem
        Applies constructions, the last of which closes the loop.

    Raises
    ------
    UsageError
        If the last construction is another one.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> plant = ParametricSystem([["k"]], [[[1]]], [[[1]]], parameters=["k"])
    >>> gain = local_controllers(plant.at({"k": 0}), [[[-3]]])
    >>> loop = looped(plant, lambda system: closed_loop(system, gain).system)
    >>> loop.n, loop.at({"k": 1}).A[0, 0]
    (1, Fraction(-2, 1))
    """
    n, sizes = system.n, system.sizes
    still = MultiChannelSystem(
        Matrix.zeros(n, n),
        [Matrix.zeros(n, p) for p, _ in sizes],
        [Matrix.zeros(q, n) for _, q in sizes],
        time=system.time,
        names=system.names,
        neighbors={},
    )
    loop = construct(still)
    if loop.subject[-1:] == () or loop.subject[-1]["construction"] != "closed_loop":
        raise UsageError("expected a closed loop")
    return ParametricLoop(system, construct, (*system.subject, *loop.subject), loop.n)
