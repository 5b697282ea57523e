"""Hypothesis strategies and assertions."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from fractions import Fraction
from typing import Any, TypeVar

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from mcexact.answer.check import check
from mcexact.answer.protocol import Answer
from mcexact.derived.drawn import systems as drawn
from mcexact.derived.drawn import systems as structure
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.systems import Drawn as Drawn
from mcexact.derived.drawn.systems import system_with_deficiency
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import written
from mcexact.exact.roots import TIMES, is_discrete
from mcexact.model.box import Box
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

# Printing: Hypothesis shows a drawn system as code that can be pasted.


def printed(draw: DrawFn, drawn: Drawn) -> Drawn:
    """Return an equal drawn system, which Hypothesis prints as calls of constructors.

    Hypothesis prints a value of ``st.builds`` as the call that makes it, so this function builds
    the values once more, from their arguments.
    """
    known = {
        each.name: value
        for each in fields(drawn)
        if each.name != "system" and (value := getattr(drawn, each.name)) is not None
    }
    equal: Drawn = _built(draw, Drawn, system=_system(draw, drawn.system), **known)
    return equal


def printed_graph(draw: DrawFn, graph: NeighborGraph) -> NeighborGraph:
    """Return an equal graph, which Hypothesis prints as a call of its constructor."""
    delays = {"delays": graph.delays} if graph.delays else {}
    arguments = {"names": graph.names, "neighbors": graph.neighbors, **delays}
    equal: NeighborGraph = _built(draw, NeighborGraph, **arguments)
    return equal


def _built(draw: DrawFn, target: Any, **arguments: Any) -> Any:
    return draw(st.builds(target, **{name: st.just(value) for name, value in arguments.items()}))


def _system(draw: DrawFn, system: MultiChannelSystem) -> MultiChannelSystem:
    arguments: dict[str, Any] = {
        "A": _rows(system.A),
        "B": [_rows(channel.B) for channel in system.channels],
        "C": [_rows(channel.C) for channel in system.channels],
    }
    if is_discrete(system.time):
        arguments["time"] = system.time
    if system.names != tuple(str(i + 1) for i in range(system.m)):
        arguments["names"] = system.names
    if system.D is not None:
        arguments["D"] = _rows(system.D)
    if system.neighbors is not None:
        arguments["neighbors"] = printed_graph(draw, system.neighbors)
    equal: MultiChannelSystem = _built(draw, MultiChannelSystem, **arguments)
    return equal


def _rows(M: Matrix) -> Any:
    """The rows as lists; a matrix without entries as it is, since a list would lose its shape."""
    return [[written(x) for x in row] for row in M] if M.nrows and M.ncols else M


# Systems with known structure, and neighbor graphs.

T = TypeVar("T")


class HypothesisChoices:
    """A source of choices for `mcexact.derived.drawn` that lets Hypothesis draw and shrink them.

    Parameters
    ----------
    draw : callable
        The argument of a composite strategy, or the ``draw`` of ``st.data()``.

    Examples
    --------
    A test can call any function of `mcexact.derived.drawn`::

        @given(st.data())
        def test_something(data):
            drawn = jointly_controllable_system(HypothesisChoices(data.draw), 4, 2)
    """

    def __init__(self, draw: DrawFn) -> None:
        self._draw = draw

    def integer(self, low: int, high: int) -> int:
        """Draw an integer from ``low`` to ``high``; it shrinks towards 0 where possible."""
        return self._draw(st.integers(low, high))

    def option(self, options: Sequence[T]) -> T:
        """Draw one of the options; it shrinks towards the first."""
        return options[self._draw(st.integers(0, len(options) - 1))]


def _time(choices: HypothesisChoices, time: str | None) -> str:
    return choices.option(TIMES) if time is None else time


@st.composite
def _systems(
    draw: DrawFn,
    min_states: int,
    max_states: int,
    max_channels: int,
    time: str | None,
    feedthrough: bool,
) -> Drawn:
    choices = HypothesisChoices(draw)
    n, m = choices.integer(min_states, max_states), choices.integer(1, max_channels)
    found = drawn.any_system(choices, n, m, time=_time(choices, time))
    if feedthrough and choices.option((True, False)):
        found = drawn.with_feedthrough(choices, found)
    return printed(draw, found)


def systems(
    max_states: int = 5,
    max_channels: int = 4,
    *,
    min_states: int = 0,
    time: str | None = None,
    feedthrough: bool = False,
) -> SearchStrategy[Drawn]:
    """Draw systems of all kinds: sparse, minimal, inactive channels, fixed modes, uncontrollable.

    Parameters
    ----------
    max_states, max_channels, min_states : int
    time : {"continuous", "discrete"}, optional
        Both are drawn by default.
    feedthrough : bool
        Whether about half of those with inputs and outputs have a D ≠ 0, of which no fixed modes
        are known.

    Returns
    -------
    SearchStrategy of Drawn
        An attribute that the construction does not determine is None.
    """
    return _systems(min_states, max_states, max_channels, time, feedthrough)


@st.composite
def _minimal(
    draw: DrawFn,
    min_states: int,
    max_states: int,
    max_channels: int,
    inactive_channels: bool,
    denominators: bool,
    time: str | None,
) -> Drawn:
    choices = HypothesisChoices(draw)
    n, m = choices.integer(min_states, max_states), choices.integer(1, max_channels)
    return printed(
        draw,
        drawn.jointly_controllable_system(
            choices,
            n,
            m,
            time=_time(choices, time),
            inactive_channels=inactive_channels,
            denominators=denominators,
        ),
    )


def jointly_controllable_systems(
    max_states: int = 5,
    max_channels: int = 4,
    *,
    min_states: int = 0,
    inactive_channels: bool = False,
    denominators: bool = False,
    time: str | None = None,
) -> SearchStrategy[Drawn]:
    """Jointly controllable and jointly observable systems, by construction.

    Parameters
    ----------
    max_states, max_channels, min_states : int
    inactive_channels : bool
        Whether some channels may have B_i = 0 or C_i = 0.
    denominators : bool
        Whether entries may be fractions.
    time : {"continuous", "discrete"}, optional

    Returns
    -------
    SearchStrategy of Drawn
        Repeated eigenvalues, long Jordan chains and irrational modes included.
    """
    return _minimal(min_states, max_states, max_channels, inactive_channels, denominators, time)


@st.composite
def _with_fixed_mode(
    draw: DrawFn, degree: int | None, max_states: int, max_channels: int, time: str | None
) -> Drawn:
    choices = HypothesisChoices(draw)
    chosen = choices.integer(1, min(3, max_states)) if degree is None else degree
    n, m = choices.integer(chosen, max_states), choices.integer(2, max_channels)
    return printed(
        draw, drawn.system_with_fixed_mode(choices, n, m, chosen, time=_time(choices, time))
    )


def systems_with_fixed_mode(
    max_states: int = 5,
    max_channels: int = 4,
    *,
    degree: int | None = None,
    time: str | None = None,
) -> SearchStrategy[Drawn]:
    """Jointly controllable and observable systems with a planted fixed mode.

    Parameters
    ----------
    max_states : int
        At least the degree.
    max_channels : int
        At least 2.
    degree : int, optional
        Of the fixed mode's irreducible polynomial; 1 to 3 by default.
    time : {"continuous", "discrete"}, optional

    Returns
    -------
    SearchStrategy of Drawn
        With ``fixed_mode``, ``multiplicity`` and ``subset``.
    """
    return _with_fixed_mode(degree, max_states, max_channels, time)


@st.composite
def _uncontrollable(
    draw: DrawFn, max_states: int, max_channels: int, observable_side: bool, time: str | None
) -> Drawn:
    choices = HypothesisChoices(draw)
    n, m = choices.integer(1, max_states), choices.integer(1, max_channels)
    return printed(
        draw,
        drawn.uncontrollable_system(
            choices, n, m, observable_side=observable_side, time=_time(choices, time)
        ),
    )


def uncontrollable_systems(
    max_states: int = 5,
    max_channels: int = 4,
    *,
    observable_side: bool = False,
    time: str | None = None,
) -> SearchStrategy[Drawn]:
    """Systems with a mode that no channel reaches (or, on the other side, sees)."""
    return _uncontrollable(max_states, max_channels, observable_side, time)


@st.composite
def _with_joint_modes(draw: DrawFn, max_states: int, max_channels: int, time: str | None) -> Drawn:
    choices = HypothesisChoices(draw)
    n, m = choices.integer(1, max_states), choices.integer(1, max_channels)
    return printed(draw, drawn.system_with_joint_modes(choices, n, m, time=_time(choices, time)))


def systems_with_joint_modes(
    max_states: int = 5, max_channels: int = 4, *, time: str | None = None
) -> SearchStrategy[Drawn]:
    """Systems with states that all channels together do not control, or do not observe.

    Parameters
    ----------
    max_states, max_channels : int
    time : {"continuous", "discrete"}, optional

    Returns
    -------
    SearchStrategy of Drawn
        With the ``order`` of a minimal realization, and the polynomial ``left_out`` of the rest.
    """
    return _with_joint_modes(max_states, max_channels, time)


@st.composite
def _sparse(draw: DrawFn, max_states: int, max_channels: int, time: str | None) -> Drawn:
    choices = HypothesisChoices(draw)
    n, m = choices.integer(0, max_states), choices.integer(1, max_channels)
    return printed(draw, drawn.sparse_system(choices, n, m, time=_time(choices, time)))


def sparse_systems(
    max_states: int = 5, max_channels: int = 4, *, time: str | None = None
) -> SearchStrategy[Drawn]:
    """Systems with sparse small entries about which nothing is known; anything may happen."""
    return _sparse(max_states, max_channels, time)


@st.composite
def _graphs(
    draw: DrawFn, names: Sequence[str], strongly_connected: bool | None, longest_delay: int
) -> NeighborGraph:
    return printed_graph(
        draw, drawn_graph(HypothesisChoices(draw), names, strongly_connected, longest_delay)
    )


def neighbor_graphs(
    names: Sequence[str], *, strongly_connected: bool | None = None, longest_delay: int = 0
) -> SearchStrategy[NeighborGraph]:
    """Neighbor graphs on given agents.

    Parameters
    ----------
    names : sequence of str
    strongly_connected : bool, optional
        Any graph by default.
    longest_delay : int
        Every edge has a delay from 0 to this.
    """
    return _graphs(tuple(names), strongly_connected, longest_delay)


@st.composite
def _on_graphs(
    draw: DrawFn,
    base: SearchStrategy[Drawn],
    strongly_connected: bool | None,
    longest_delay: int,
) -> Drawn:
    if strongly_connected is False:  # one agent alone is strongly connected
        base = base.filter(lambda each: each.system.m > 1)
    drawn = draw(base)
    graph = draw(_graphs(drawn.system.names, strongly_connected, longest_delay))
    return printed(draw, replace(drawn, system=drawn.system.with_neighbors(graph)))


def systems_on_graphs(
    base: SearchStrategy[Drawn] | None = None,
    *,
    strongly_connected: bool | None = None,
    longest_delay: int = 0,
) -> SearchStrategy[Drawn]:
    """Systems that carry a neighbor graph, with delays on its edges if wanted.

    Parameters
    ----------
    base : SearchStrategy of Drawn, optional
        A strategy for the systems; `jointly_controllable_systems` by default, in discrete time if
        there are delays.
    strongly_connected : bool, optional
        Any graph by default.  False leaves out systems of one channel.
    longest_delay : int
    """
    if base is None:
        base = jointly_controllable_systems(time="discrete" if longest_delay else None)
    return _on_graphs(base, strongly_connected, longest_delay)


@st.composite
def _with_deficiency(
    draw: DrawFn, most: int, share: str | None, time: str | None, delay: int, digits: int
) -> Drawn:
    choices = HypothesisChoices(draw)
    way = choices.option(("outputs+states", "states")) if share is None else share
    boundary = 1 if way == "states" else choices.option((1, 1, 2))
    return printed(
        draw,
        system_with_deficiency(
            choices,
            choices.integer(1, most),
            choices.integer(2 if way == "states" else boundary + 2, 4),
            share=way,
            degree=choices.option((1, 1, 2)),
            length=choices.option((1, 1, 2)),
            boundary=boundary,
            transfer=choices.option((True, False)),
            stable=choices.option((False, True)),
            digits=digits and choices.integer(0, digits),
            delay=delay,
            time="discrete" if delay else _time(choices, time),
        ),
    )


def systems_with_deficiency(
    most: int = 3,
    *,
    share: str | None = None,
    time: str | None = None,
    longest_delay: int = 0,
    digits: int = 0,
) -> SearchStrategy[Drawn]:
    """Systems over strongly connected graphs whose bound on shared dimensions is known.

    Parameters
    ----------
    most : int
        The largest bound, at least 1.
    share : {"outputs+states", "states"}, optional
        Whether ``deficiency`` is the bound of Theorem 2 or of Remark 2; either by default.
    time : {"continuous", "discrete"}, optional
    longest_delay : int
        Every edge has a delay from 0 to this; the time is discrete then.
    digits : int
        The most digits of numerators and denominators by which states are scaled.

    Returns
    -------
    SearchStrategy of Drawn
        With ``deficiency``, ``fixed_mode``, ``multiplicity`` and ``subset``.  Modes are repeated,
        complex, in Jordan chains, and stable or not; the fixed one may carry a transfer matrix
        other than 0.
    """
    return _with_deficiency(most, share, time, longest_delay, digits)


@st.composite
def _with_indices(draw: DrawFn, max_states: int, max_channels: int, time: str | None) -> Drawn:
    choices = HypothesisChoices(draw)
    left, m = choices.integer(1, max_states), choices.integer(1, max_channels)
    indices = []
    while left:
        indices.append(choices.integer(1, left))
        left -= indices[-1]
    return printed(
        draw, structure.system_with_indices(choices, indices, m, time=_time(choices, time))
    )


def systems_with_indices(
    max_states: int = 5, max_channels: int = 4, *, time: str | None = None
) -> SearchStrategy[Drawn]:
    """Systems whose controllability (Brunovsky) ``indices`` are known."""
    return _with_indices(max_states, max_channels, time)


@st.composite
def _with_remnant(draw: DrawFn, max_states: int, max_channels: int, time: str | None) -> Drawn:
    choices = HypothesisChoices(draw)
    n, m = choices.integer(3, max_states), choices.integer(2, max_channels)
    return printed(
        draw,
        structure.system_with_remnant(
            choices, n, m, nonzero_transfer=choices.option((False, True)), time=_time(choices, time)
        ),
    )


def systems_with_remnant(
    max_states: int = 5, max_channels: int = 4, *, time: str | None = None
) -> SearchStrategy[Drawn]:
    """Systems with a ``subset`` whose complementary subsystem has a known ``remnant``."""
    return _with_remnant(max_states, max_channels, time)


@st.composite
def _incomplete(
    draw: DrawFn, reason: str | None, max_states: int, max_channels: int, time: str | None
) -> Drawn:
    choices = HypothesisChoices(draw)
    why = choices.option(("transfer graph", "fixed mode")) if reason is None else reason
    n, m = choices.integer(2, max_states), choices.integer(2, max_channels)
    return printed(draw, structure.incomplete_system(choices, n, m, why, time=_time(choices, time)))


def incomplete_systems(
    max_states: int = 5,
    max_channels: int = 4,
    *,
    reason: str | None = None,
    time: str | None = None,
) -> SearchStrategy[Drawn]:
    """Jointly controllable and observable systems that are not complete.

    Parameters
    ----------
    max_states, max_channels : int
        At least 2.
    reason : {"fixed mode", "transfer graph"}, optional
        Both are drawn by default.
    time : {"continuous", "discrete"}, optional
    """
    return _incomplete(reason, max_states, max_channels, time)


# Members of boxes of plants.

_STEPS = 2**10


@st.composite
def _members(draw: DrawFn, box: Box, vertices: bool) -> MultiChannelSystem:
    part = st.sampled_from([1, -1]) if vertices else st.integers(-_STEPS, _STEPS)
    steps = 1 if vertices else _STEPS
    return box.moved(lambda: Fraction(draw(part), steps))


def members(box: Box, *, vertices: bool = False) -> SearchStrategy[MultiChannelSystem]:
    """Draw plants in a box, each uncertain entry anywhere in its interval.

    Parameters
    ----------
    box : Box
    vertices : bool
        Whether every uncertain entry is at one of the two ends of its interval.

    Returns
    -------
    SearchStrategy of MultiChannelSystem
        Plants of exact numbers; they shrink towards the nominal plant, or the upper ends.
    """
    return _members(box, vertices)


# Systems with parameters.

_ONES = ("0", "1", "-1", "2")
_SHAPES = ("{t}", "-{t}", "{t} + 1", "2*{t} - 1", "{t}^2 - 2", "{t}^2 + {t} + 1")
_QUOTIENTS = ("1/({t} - 3)", "{t}/({t}^2 + 1)")
_RANGES = (None, (0, 1), ("1/2", None), (None, -1))


@st.composite
def _parametric(
    draw: DrawFn,
    max_states: int,
    max_channels: int,
    parameters: tuple[str, ...],
    denominators: bool,
    ranges: bool,
    time: str | None,
) -> ParametricSystem:
    shapes = _SHAPES + (_QUOTIENTS if denominators else ())
    depending = [shape.format(t=name) for shape in shapes for name in parameters]
    entry = st.one_of(st.sampled_from(_ONES), st.sampled_from(depending))

    def matrix(r: int, c: int) -> list[list[str]]:
        return [[draw(entry) for _ in range(c)] for _ in range(r)]

    n, m = draw(st.integers(1, max_states)), draw(st.integers(1, max_channels))
    # No input reaches the states after these, which gives fixed modes of every degree.
    reached = draw(st.one_of(st.just(n), st.integers(0, n)))
    A, unreached = matrix(n, n), [["0"]] * (n - reached)
    arguments = {
        "A": A[:reached] + [["0"] * reached + row[reached:] for row in A[reached:]],
        "B": [matrix(reached, 1) + unreached for _ in range(m)],
        "C": [matrix(1, n) for _ in range(m)],
        "parameters": list(parameters),
        "time": draw(st.sampled_from(TIMES)) if time is None else time,
    }
    if ranges:
        drawn = {name: draw(st.sampled_from(_RANGES)) for name in parameters}
        arguments["assume"] = {name: bounds for name, bounds in drawn.items() if bounds}
    # Hypothesis prints the system as this call.
    system: ParametricSystem = draw(
        st.builds(ParametricSystem, **{name: st.just(value) for name, value in arguments.items()})
    )
    return system


def parametric_systems(
    max_states: int = 3,
    max_channels: int = 2,
    *,
    parameters: Sequence[str] = ("t",),
    denominators: bool = False,
    ranges: bool = False,
    time: str | None = None,
) -> SearchStrategy[ParametricSystem]:
    """Draw systems whose entries are small polynomials in parameters, of one input and output each.

    In some of them no input reaches some states, whose modes are fixed for every value.

    Parameters
    ----------
    max_states, max_channels : int
    parameters : sequence of str
    denominators : bool
        Whether entries may be quotients of polynomials.
    ranges : bool
        Whether parameters may be assumed to be in ranges.
    time : {"continuous", "discrete"}, optional
        Both are drawn by default.

    Returns
    -------
    SearchStrategy of ParametricSystem
        They shrink towards one state and entries that are 0.
    """
    return _parametric(max_states, max_channels, tuple(parameters), denominators, ranges, time)


# An assertion for tests that make or keep certificates.


def assert_valid(
    certificate: Answer | str | os.PathLike[str],
    system: MultiChannelSystem | None = None,
    controller: Controller | str | os.PathLike[str] | None = None,
    expect: str | Mapping[str, Any] | None = None,
) -> str:
    """Assert that the independent checker accepts a certificate.

    Parameters
    ----------
    certificate : Answer or path
    system : MultiChannelSystem, optional
    controller : Controller or path, optional
    expect : str or mapping, optional
        What the certificate must be about, and what it must say, as in `check`.

    Returns
    -------
    str
        The verified statement.

    Raises
    ------
    AssertionError
        If the verdict is not VALID; the message says why.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem, fixed_spectrum
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> assert_valid(fixed_spectrum(plant), plant).startswith("For the plant ")
    True
    >>> other = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> assert_valid(fixed_spectrum(plant), other)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    AssertionError: NOT ABOUT system system: about another system, of digest ...
    """
    __tracebackhide__ = True
    verdict = check(certificate, system, controller, expect)
    if not verdict.valid:
        raise AssertionError(verdict.explain())
    return verdict.statement


# `st.from_type`, and so `st.builds` and `@given(infer)`, for functions with annotated arguments.

st.register_type_strategy(MultiChannelSystem, systems().map(lambda drawn: drawn.system))
st.register_type_strategy(
    NeighborGraph,
    st.integers(1, 4).flatmap(lambda m: neighbor_graphs([str(i + 1) for i in range(m)])),
)
st.register_type_strategy(ParametricSystem, parametric_systems())
