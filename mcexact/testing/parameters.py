"""Hypothesis strategies that draw systems with parameters."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from mcexact.exact.roots import TIMES
from mcexact.model.parametric import ParametricSystem

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
    # Beyond these states no input reaches, which makes fixed modes of every degree.
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
    # What is built is printed as the call that made it.
    made: ParametricSystem = draw(
        st.builds(ParametricSystem, **{name: st.just(value) for name, value in arguments.items()})
    )
    return made


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
