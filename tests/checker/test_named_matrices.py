"""Matrices that are named in claims, made from a plant with a parameter."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.bivariate import named_matrix, named_text
from mcexact.checker.core.reading import Refused
from mcexact.checker.parametric_system import ParametricSystem, one_parameter, read_parametric
from tests.assurance.attack.forgeries.parametric_traps import plant
from tests.wording import worded

PLANT = plant(
    [["t", 1], [0, "(1)/(t + 1)"]],
    ([[1], ["t"]], [[1, 0]]),
    ([[0, 2], [3, 0]], [[0, "t^2"], [1, 1], ["t", 0]]),
    ([[], []], {"shape": [0, 2], "entries": []}),
)
"""With t = 2, and A times t + 1: [6, 3; 0, 1], B = [1; 2], [0, 2; 3, 0], C = [1, 0], …"""
SAMPLED = {**PLANT, "time": "discrete"}
EMPTY = plant([], ([], []))


def at_two(value: Any, system: Any = PLANT) -> list[list[Fraction]]:
    """A matrix at t = 2."""
    M = named_matrix(value, read(system))
    nrows, ncols = M[0].nrows, M[0].ncols
    assert all((layer.nrows, layer.ncols) == (nrows, ncols) for layer in M)
    return [
        [
            sum((Fraction(L.rows[i][j], L.denominator) * 2**k for k, L in enumerate(M)), Fraction())
            for j in range(ncols)
        ]
        for i in range(nrows)
    ]


def read(system: Any) -> ParametricSystem:
    return one_parameter(read_parametric(system))


def test_the_matrix_of_setpoints() -> None:
    C = [[1, 0, 0, 0, 0], [0, 4, 0, 0, 0], [1, 1, 0, 0, 0], [2, 0, 0, 0, 0]]
    named = {"name": "setpoint"}
    assert at_two(named) == [[6, 3, 1, 0, 2], [0, 1, 2, 3, 0], *C]
    assert at_two(named, SAMPLED) == [[3, 3, 1, 0, 2], [0, -2, 2, 3, 0], *C]
    assert at_two(named, EMPTY) == []


def test_a_companion_matrix_has_ones_beside_its_diagonal_alone() -> None:
    named = {"name": "signal", "polynomial": [5, 6, 7, 1]}
    rows = [
        [2, 0, 5, 1, 0, 0],
        [-1, 2, 6, 0, 1, 0],
        [0, -1, 9, 0, 0, 1],
        [1, 0, 0, 0, 0, 0],
        [0, 1, 0, 0, 0, 0],
        [0, 0, 1, 0, 0, 0],
    ]
    assert at_two(named, plant([["t"]], ([[1]], [[1]]))) == rows


def test_the_matrix_of_signals() -> None:
    named = {"name": "signal", "polynomial": ["-1/2", 4, 1]}
    half = Fraction(1, 2)
    states = [
        [6, 3, -3 * half, 0, 1, 0, 2, 0, 0, 0],
        [0, 1, 0, -3 * half, 2, 3, 0, 0, 0, 0],
        [-3, 0, 18, 3, 0, 0, 0, 1, 0, 2],
        [0, -3, 0, 13, 0, 0, 0, 2, 3, 0],
    ]
    C, zero = [[1, 0], [0, 4], [1, 1], [2, 0]], [0] * 6
    outputs = [[*row, 0, 0, *zero] for row in C] + [[0, 0, *row, *zero] for row in C]
    assert at_two(named) == at_two(named, SAMPLED) == states + outputs
    assert at_two({"name": "signal", "polynomial": [0, 1]}) == at_two({"name": "setpoint"})
    sampled = at_two({"name": "signal", "polynomial": [-1, 1]}, SAMPLED)
    assert sampled == at_two({"name": "setpoint"}, SAMPLED)
    assert at_two(named, EMPTY) == []


@pytest.mark.parametrize("polynomial", [[1], [], [1, 2], [1.0, 1], ["x", 1], 3])
def test_a_signal_has_a_monic_polynomial_with_roots(polynomial: Any) -> None:
    with pytest.raises(Refused) as found:
        named_matrix({"name": "signal", "polynomial": polynomial}, read(PLANT))
    assert found.value.verdict == "MALFORMED"
    assert found.value.place.startswith("claim.matrix.polynomial")


def controllability(channels: list[str], blocks: Any) -> Any:
    return {"name": "controllability", "channels": channels, "blocks": blocks}


def test_the_matrix_of_controllability() -> None:
    assert at_two(controllability(["1"], 1)) == [[1], [2]]
    assert at_two(controllability(["1"], 2)) == [[1, 12], [2, 2]]
    assert at_two(controllability(["1", "2"], 1)) == [[1, 0, 2], [2, 3, 0]]
    assert at_two(controllability(["2"], 2)) == [[0, 2, 9, 12], [3, 0, 3, 0]]
    assert at_two(controllability(["3"], 2)) == at_two(controllability([], 1)) == [[], []]
    assert at_two(controllability(["1"], 1), EMPTY) == []


def test_the_column_of_a_transfer() -> None:
    def column(start: str, end: str) -> Any:
        return [row[0] for row in at_two({"name": "transfer", "from": start, "to": end})]

    assert column("1", "1") == [1, 12]
    # C_1 B_2 = [0, 2], C_1 A B_2 = [9, 12]
    assert column("2", "1") == [0, 2, 9, 12]
    # C_2 B_1 = [8; 3; 2], C_2 A B_1 = [8; 14; 24]
    assert column("1", "2") == [8, 3, 2, 8, 14, 24]
    assert column("2", "2") == [12, 3, 0, 0, 2, 4, 12, 12, 18, 0, 12, 24]
    assert column("1", "3") == column("3", "1") == []


@pytest.mark.parametrize(
    ("value", "verdict"),
    [
        ({"name": "pencil"}, "MALFORMED"),
        ({"name": ["setpoint"]}, "MALFORMED"),
        ({}, "MALFORMED"),
        ("setpoint", "MALFORMED"),
        ({"name": "setpoint", "blocks": 1}, "MALFORMED"),
        ({"name": "signal"}, "MALFORMED"),
        (controllability(["2", "1"], 1), "MALFORMED"),
        (controllability(["1"], 0), "MALFORMED"),
        (controllability(["1"], 3), "INVALID"),
        ({"name": "transfer", "from": "1", "to": ["2"]}, "MALFORMED"),
        ({"name": "transfer", "from": "4", "to": "1"}, "MALFORMED"),
        ({"name": "transfer", "from": "1"}, "MALFORMED"),
    ],
)
def test_another_matrix_is_refused(value: Any, verdict: str) -> None:
    with pytest.raises(Refused) as found:
        named_matrix(value, read(PLANT))
    assert (found.value.verdict, found.value.place) == (verdict, "claim.matrix")


def test_one_block_is_allowed_without_states() -> None:
    with pytest.raises(Refused):
        named_matrix(controllability(["1"], 2), read(EMPTY))
    assert len(at_two(controllability(["1"], 2), PLANT)) == 2


def test_matrices_have_words() -> None:
    def said(value: Any, system: Any = PLANT) -> str:
        return named_text(value, read(system))

    assert said({"name": "setpoint"}) == "[A, B; C, 0] with the matrices A, B and C of all channels"
    sampled = "[A - I, B; C, 0] with the matrices A, B and C of all channels"
    assert said({"name": "setpoint"}, SAMPLED) == sampled
    assert worded(said({"name": "signal", "polynomial": [4, 0, 1]}))
    assert worded(said(controllability(["1", "3"], 2)))
    assert worded(said({"name": "transfer", "from": "1", "to": "2"}))
    with pytest.raises(Refused):
        said({"name": "pencil"})
