"""Shrunk subspaces and zero transfers, beside the certificates that use them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.evidence import (
    Losses,
    require_pencil_kernel,
    shrunk_subspace,
    zero_transfer,
)
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import read_plant
from tests.checker.handmade import CHAIN, OSCILLATOR, PAIR, layers, matrix, plant

LOST = {"channels_T": [], "U": layers([[0], [1]]), "V": layers([]), "pivots": [1]}
"""x_2' = 2 x_2, which no channel sees."""
REPEATED = {**LOST, "U": layers([[0, 0], [1, 1]]), "V": layers([]), "pivots": [0, 1]}
DRIVEN = {
    "channels_T": ["1"],
    "U": layers([[1, 0], [0, 1]]),
    "V": layers([[1, 0]]),
    "pivots": [0, 1],
}
"""The same with the channel: (2 − A) e_1 = e_1 is an input, and 2 − 1 dimensions are lost."""
TURNING = {
    "channels_T": ["1"],
    "U": layers([[1], [0]], [[0], [1]]),
    "V": layers([[0]]),
    "pivots": [0],
}
"""(1, x) is an eigenvector of [0 1; −1 0] modulo x² + 1."""
PAIRED = plant([[3, 0], [0, 3]], ([[1, 1], [0, 0]], [[1, 0]]), ([[0], [1]], [[0, 1]]))
TWO_INPUTS = {
    "channels_T": ["1"],
    "U": layers([[1], [0]]),
    "V": layers([[0], [0]]),
    "pivots": [0],
}
"""Two inputs of one direction count once; x_1 is not seen by channel 2."""


TWICE = plant([[2, 0], [0, 2]], ([[1], [0]], [[0, 0]]))
BLIND = {**DRIVEN, "channels_T": [], "V": layers([])}
"""A mode twice, of which the channel sees nothing."""
SEEN = {**TURNING, "channels_T": [], "V": layers([], [])}


def exact(*coefficients: int) -> list[Fraction]:
    return [Fraction(c) for c in coefficients]


TWO, CIRCLE, THREE = exact(-2, 1), exact(1, 0, 1), exact(-3, 1)
TALL = {**DRIVEN, "U": layers([[1], [0]]), "V": layers([[1]]), "pivots": [0]}

SHRUNK: list[tuple[str, Any, Any, list[Fraction], int, str]] = [
    ("a mode that is not seen", PAIR, LOST, TWO, 1, "VALID"),
    ("a mode behind an input", PAIR, DRIVEN, TWO, 1, "VALID"),
    ("a pair of modes", OSCILLATOR, TURNING, CIRCLE, 1, "VALID"),
    ("two losses", TWICE, BLIND, TWO, 2, "VALID"),
    ("one loss of two", TWICE, BLIND, TWO, 1, "VALID"),
    ("more than is lost", PAIR, LOST, TWO, 2, "INVALID"),
    ("no loss", PAIR, LOST, TWO, 0, "INVALID"),
    ("as many inputs as directions", PAIR, TALL, TWO, 1, "INVALID"),
    ("nothing lost, and nothing said", PAIR, TALL, TWO, 0, "INVALID"),
    ("inputs of one direction", PAIRED, TWO_INPUTS, THREE, 1, "INVALID"),
    ("another polynomial", PAIR, LOST, exact(-1, 1), 1, "INVALID"),
    (
        "seen by the channel",
        PAIR,
        {**LOST, "U": layers([[1], [0]]), "pivots": [0]},
        exact(-1, 1),
        1,
        "INVALID",
    ),
    ("another input", PAIR, {**DRIVEN, "V": layers([[2, 0]])}, TWO, 1, "INVALID"),
    ("one direction twice", PAIR, REPEATED, TWO, 2, "INVALID"),
    ("one direction twice, for one loss", PAIR, REPEATED, TWO, 1, "INVALID"),
    ("a direction that moves", PAIR, {**LOST, "U": layers([[1], [1]])}, TWO, 1, "INVALID"),
    ("dependent directions", PAIR, {**DRIVEN, "U": layers([[1, 1], [1, 1]])}, TWO, 1, "INVALID"),
    (
        "another turn",
        OSCILLATOR,
        {**TURNING, "U": layers([[1], [0]], [[0], [-1]])},
        CIRCLE,
        1,
        "INVALID",
    ),
    ("no layers", OSCILLATOR, {**TURNING, "U": layers()}, CIRCLE, 1, "MALFORMED"),
    (
        "layers beyond the degree",
        PAIR,
        {**LOST, "U": layers([[0], [1]], [[0], [0]])},
        TWO,
        1,
        "MALFORMED",
    ),
    ("a pivot beyond the states", PAIR, {**LOST, "pivots": [2]}, TWO, 1, "MALFORMED"),
    ("seen, but not in every layer", OSCILLATOR, SEEN, CIRCLE, 1, "INVALID"),
]


@pytest.mark.parametrize(("reason", "system", "value", "p", "deficiency", "verdict"), SHRUNK)
def test_a_subspace_is_shrunk_or_not(
    reason: str, system: Any, value: Any, p: list[Fraction], deficiency: int, verdict: str
) -> None:
    read = read_plant(system)
    if verdict == "VALID":
        T = shrunk_subspace(value, "subspace", read, p, deficiency)
        assert [read.names[i] for i in T] == value["channels_T"]
    else:
        with pytest.raises(Refused) as found:
            shrunk_subspace(value, "subspace", read, p, deficiency)
        assert found.value.verdict == verdict


UNDRIVEN = plant([[2, 0, 1], [0, 3, 4], [0, 0, 5]], ([[1, 0], [0, 1], [0, 0]], [[1, 1, 1]]))
"""No input drives x_3, and the row (0, 0, 1) is an eigenvector at 5."""
ANOTHER = plant([[2, 0], [1, 1]], ([[1], [0]], [[1, 0]]))
LAST: dict[str, Any] = {
    "channels_T": ["1"],
    "dual": {"channels_T": [], "U": layers([[0], [0], [1]]), "V": layers([]), "pivots": [2]},
}
BEHIND: dict[str, Any] = {"channels_T": [], "dual": DRIVEN}
# Channel 1 drives and measures x_1; channel 2 drives x_2, which drives x_1, and measures x_2.
STACKED = plant(
    [[2, 1], [0, 2]],
    ([[1], [0]], [[1, 0]]),
    ([[0], [1]], [[0, 1]]),
)
TURNED: dict[str, Any] = {
    "channels_T": ["1"],
    "dual": {"channels_T": ["2"], "U": layers([[0], [1]]), "V": layers([[0]]), "pivots": [1]},
}

DUAL: list[tuple[str, Any, dict[str, Any], list[Fraction], int, str]] = [
    ("a mode that nothing drives", UNDRIVEN, LAST, exact(-5, 1), 1, "VALID"),
    ("another mode", UNDRIVEN, LAST, exact(-2, 1), 1, "INVALID"),
    ("a row that inputs drive", UNDRIVEN, {**LAST, "channels_T": []}, exact(-5, 1), 1, "INVALID"),
    (
        "the other channels, and rows that inputs drive",
        UNDRIVEN,
        {"channels_T": [], "dual": {**LAST["dual"], "channels_T": ["1"], "V": layers([[0]])}},
        exact(-5, 1),
        1,
        "INVALID",
    ),
    ("more than is lost", UNDRIVEN, LAST, exact(-5, 1), 2, "INVALID"),
    ("nothing lost", UNDRIVEN, LAST, exact(-5, 1), 0, "INVALID"),
    (
        "a row that the first input drives",
        UNDRIVEN,
        {**LAST, "dual": {**LAST["dual"], "U": layers([[1], [0], [0]]), "pivots": [0]}},
        exact(-2, 1),
        1,
        "INVALID",
    ),
    ("a mode behind an output", PAIR, BEHIND, TWO, 1, "VALID"),
    ("the dual of another system", ANOTHER, BEHIND, TWO, 1, "INVALID"),
    ("one output and one row", STACKED, TURNED, TWO, 1, "INVALID"),
    ("a dual of a dual", PAIR, {"channels_T": [], "dual": LAST}, TWO, 1, "MALFORMED"),
    ("more keys", UNDRIVEN, {**LAST, "states": [0]}, exact(-5, 1), 1, "MALFORMED"),
]


@pytest.mark.parametrize(("reason", "system", "value", "p", "deficiency", "verdict"), DUAL)
def test_a_subspace_of_the_dual_is_shrunk_or_not(
    reason: str, system: Any, value: Any, p: list[Fraction], deficiency: int, verdict: str
) -> None:
    read = read_plant(system)
    if verdict == "VALID":
        T = Losses(read).checked(value, "subspace", p, deficiency)
        assert [read.names[i] for i in T] == value["channels_T"], reason
    else:
        with pytest.raises(Refused) as found:
            Losses(read).checked(value, "subspace", p, deficiency)
        assert found.value.verdict == verdict, reason


def test_the_kernel_is_reduced_from_the_top() -> None:
    # U = u_0 + u_1 x + u_2 x² with (x − A) U = 0 modulo (x − 1)(x − 2)(x − 3), A the companion
    A = Matrix([[0, 0, 6], [1, 0, -11], [0, 1, 6]], 3)
    p, none = exact(-6, 11, -6, 1), Matrix([[], [], []], 0)
    U = [Matrix([[11], [-6], [1]], 1), Matrix([[-6], [1], [0]], 1), Matrix([[1], [0], [0]], 1)]
    V = [Matrix([], 1)] * 3
    require_pencil_kernel(A, none, U, V, p, "kernel")
    for k in range(3):
        changed = [part.times(Fraction(2)) if i == k else part for i, part in enumerate(U)]
        with pytest.raises(Refused) as found:
            require_pencil_kernel(A, none, changed, V, p, "kernel")
        assert found.value.verdict == "INVALID"


SECOND = {"from": ["2"], "X": matrix([0], [1]), "pivots": [1]}
BOTH = {"from": ["1", "2"], "X": matrix([1, 0], [0, 1]), "pivots": [0, 1]}


@pytest.mark.parametrize(
    ("reason", "value", "verdict"),
    [
        ("the second state, which drives nothing", SECOND, "VALID"),
        ("over a denominator", {**SECOND, "X": matrix([0], [5], denominator=5)}, "VALID"),
        ("everything", BOTH, "VALID"),
        ("no inputs, in any space", {**SECOND, "from": []}, "VALID"),
        ("inputs outside", {**SECOND, "from": ["1", "2"]}, "INVALID"),
        ("other inputs", {**SECOND, "from": ["1"]}, "INVALID"),
        ("not invariant", {"from": [], "X": matrix([1], [0]), "pivots": [0]}, "INVALID"),
        ("nothing", {"from": ["2"], "X": matrix([], []), "pivots": []}, "INVALID"),
        ("a multiple of the identity", {**SECOND, "X": matrix([0], [5])}, "INVALID"),
        (
            "a multiple of it, and no inputs",
            {"from": [], "X": matrix([0], [5]), "pivots": [1]},
            "INVALID",
        ),
        ("dependent directions", {**BOTH, "X": matrix([1, 1], [1, 1])}, "INVALID"),
        ("a direction too many", {**SECOND, "X": matrix([0, 0], [1, 1])}, "MALFORMED"),
        ("an unknown channel", {**SECOND, "from": ["3"]}, "MALFORMED"),
    ],
)
def test_a_space_holds_what_inputs_reach(reason: str, value: Any, verdict: str) -> None:
    read = read_plant(CHAIN)
    if verdict == "VALID":
        sources, X = zero_transfer(value, "zero", read)
        assert [read.names[i] for i in sources] == value["from"]
        assert X.ncols == len(value["pivots"])
    else:
        with pytest.raises(Refused) as found:
            zero_transfer(value, "zero", read)
        assert found.value.verdict == verdict
