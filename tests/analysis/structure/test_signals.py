"""Signals that all outputs can track: the rank at every root of a polynomial, for all values."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact import MultiChannelSystem, ParametricSystem, check, setpoint_solvability
from mcexact.answer.parameters import ParametricRank
from mcexact.answer.several_parameters import RankHypersurfaces
from mcexact.errors import InputError
from mcexact.exact.polynomial import Polynomial
from mcexact.parameters import load_parametric_system, signal_solvability

CHAIN = [[0, 1, 0], [0, 0, 1], [-1, -3, -3]]
OSCILLATION = Polynomial.of(4, 0, 1)
"""Sinusoids of the angular frequency 2."""


def decided(plant: ParametricSystem, signal: Polynomial) -> ParametricRank:
    """The answer for one parameter, whose certificate is VALID."""
    found = signal_solvability(plant, signal)
    assert isinstance(found, ParametricRank) and check(found, plant).valid
    return found


def test_a_zero_at_the_frequency_of_a_sinusoid_is_found() -> None:
    plant = ParametricSystem(CHAIN, [[[0], [0], [1]]], [[["t", 0, 1]]], parameters=["t"])
    found = decided(plant, OSCILLATION)
    assert (found.rank, [(e.exact, e.rank) for e in found.exceptional]) == (8, [(4, 6)])
    assert decided(plant, OSCILLATION * 3) == found


@pytest.mark.parametrize(("time", "steady"), [("continuous", 0), ("discrete", 1)])
def test_set_points_are_the_signals_of_one_mode(time: str, steady: int) -> None:
    plant = ParametricSystem(
        CHAIN, [[["t"], [0], [1]]], [[["t", 1, 1]]], parameters=["t"], time=time
    )
    found = decided(plant, Polynomial.of(-steady, 1))
    wanted = setpoint_solvability(plant)
    assert (found.rank, found.exceptional) == (wanted.rank, wanted.exceptional)


def test_a_ramp_is_tracked_where_a_step_is() -> None:
    plant = ParametricSystem(CHAIN, [[[0], [0], [1]]], [[["t", 1, 0]]], parameters=["t"])
    step, ramp = decided(plant, Polynomial.of(0, 1)), decided(plant, Polynomial.of(0, 0, 1))
    assert (step.rank, ramp.rank) == (4, 8)
    assert step.exceptional_at == ramp.exceptional_at == (Polynomial.of(0, 1),)


def test_two_letters_have_hypersurfaces() -> None:
    tanks = load_parametric_system("gallery:quadruple-tank-parametric")
    found = signal_solvability(tanks, Polynomial.of(0, 1))
    assert isinstance(found, RankHypersurfaces)
    assert [str(h) for h in found.hypersurfaces] == ["gamma1 + gamma2 - 1 = 0"]


def test_ranks_are_the_sums_of_those_at_the_roots() -> None:
    """Of drawn plants, at drawn and at exceptional values, for a polynomial with rational roots."""
    rng, met = random.Random(5), 0
    roots = [Fraction(1), Fraction(-2), Fraction(1, 2)]
    signal = Polynomial.of(-1, 1) * Polynomial.of(2, 1) * Polynomial.of("-1/2", 1)
    for _ in range(4):
        plant = drawn(rng)
        found = decided(plant, signal)
        values = [e.exact for e in found.exceptional if e.exact is not None]
        met += len(values)
        for t in (*values, Fraction(rng.randint(-99, 99), 7)):
            said = next((e.rank for e in found.exceptional if e.value(t) == 0), found.rank)
            assert said == sum(rank_at(plant.at(t), root) for root in roots)
    assert met


def drawn(rng: random.Random) -> ParametricSystem:
    """A plant of two states and two channels."""

    def table(r: int, c: int) -> list[list[Any]]:
        return [[rng.choice([0, 0, 1, 1, -2, "t", "t - 1"]) for _ in range(c)] for _ in range(r)]

    B, C = [table(2, 1), table(2, 1)], [table(1, 2), table(1, 2)]
    return ParametricSystem(table(2, 2), B, C, parameters=["t"])


def rank_at(plant: MultiChannelSystem, root: Fraction) -> int:
    """The rank of [A − λI, B; C, 0] by elimination in sympy."""
    from sympy import Matrix, Rational, eye, zeros

    def exact(M: Any) -> Any:
        return Matrix(
            M.nrows,
            M.ncols,
            [Rational(str(M[i, j])) for i in range(M.nrows) for j in range(M.ncols)],
        )

    A, B, C = exact(plant.A), exact(plant.input_matrix()), exact(plant.output_matrix())
    top = (A - Rational(str(root)) * eye(plant.n)).row_join(B)
    return int(top.col_join(C.row_join(zeros(C.rows, B.cols))).rank())


def test_a_signal_without_modes_is_refused() -> None:
    plant = ParametricSystem([["t"]], [[[1]]], [[[1]]], parameters=["t"])
    with pytest.raises(InputError, match="a polynomial with roots"):
        signal_solvability(plant, Polynomial.of(3))
    with pytest.raises(InputError, match="ParametricSystem"):
        signal_solvability(plant.at(1), OSCILLATION)  # type: ignore[arg-type]


def test_two_letters_have_hypersurfaces_for_fractions() -> None:
    plant = ParametricSystem(CHAIN, [[[0], [0], [1]]], [[["a", 0, "b"]]], parameters=["a", "b"])
    found = signal_solvability(plant, Polynomial.of("1/4", 0, 1))
    assert isinstance(found, RankHypersurfaces)
    assert [(str(h), h.rank) for h in found.hypersurfaces] == [("4*a - b = 0", 6)]
