"""Evidence that several kinds share: channels, identity matrices, gains, moduli."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core import evidence
from mcexact.checker.core.arithmetic import Matrix, NotAUnit
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import read_plant
from tests.checker.handmade import matrix, plant

SYSTEM = read_plant(
    plant(
        [[1, 2], [3, 4]],
        ([[1, 5], [0, 6]], [[1, 0]]),
        ([[2], [7]], [[0, 1], [1, 1]]),
        ([[], []], {"shape": [0, 2], "entries": []}),
    )
)
GAINS = [matrix([1], [2]), matrix([3, -1]), matrix()]


def test_inputs_stand_side_by_side_and_outputs_one_above_the_other() -> None:
    assert evidence.inputs(SYSTEM, [0, 1]).rows == [[1, 5, 2], [0, 6, 7]]
    assert evidence.inputs(SYSTEM, [1, 0]).rows == [[2, 1, 5], [7, 0, 6]]
    assert evidence.inputs(SYSTEM, []) == Matrix([[], []], 0)
    assert evidence.outputs(SYSTEM, [0, 1]).rows == [[1, 0], [0, 1], [1, 1]]
    assert evidence.outputs(SYSTEM, [2, 1]).rows == [[0, 1], [1, 1]]
    assert evidence.outputs(SYSTEM, []) == Matrix([], 2)


def test_the_other_channels_are_in_order() -> None:
    assert evidence.complement(SYSTEM, []) == [0, 1, 2]
    assert evidence.complement(SYSTEM, [1]) == [0, 2]
    assert evidence.complement(SYSTEM, [2, 0, 1]) == []


def test_gains_close_the_loop_by_addition() -> None:
    F = evidence.read_gains(GAINS, "gains", SYSTEM)
    # B_1 F_1 C_1 = [11 0; 12 0] and B_2 F_2 C_2 = [-2 4; -7 14]
    assert evidence.closed_loop(SYSTEM, F).rows == [[1 + 11 - 2, 2 + 4], [3 + 12 - 7, 4 + 14]]


@pytest.mark.parametrize(
    "gains",
    [GAINS[:2], [*GAINS, matrix()], GAINS[::-1], [matrix([1, 2]), *GAINS[1:]], None],
    ids=str,
)
def test_gains_fit_their_channels(gains: Any) -> None:
    with pytest.raises(Refused) as found:
        evidence.read_gains(gains, "gains", SYSTEM)
    assert found.value.verdict == "MALFORMED"


def layers(*parts: list[list[int]]) -> list[Matrix]:
    return [Matrix(rows, len(rows[0])) for rows in parts]


NOTHING = [[0, 0], [0, 0], [0, 0]]


@pytest.mark.parametrize(
    ("parts", "pivots", "good"),
    [
        (layers([[1, 0], [9, 9], [0, 1]]), [0, 2], True),
        (layers([[1, 0], [9, 9], [0, 1]], [[0, 0], [8, 7], [0, 0]]), [0, 2], True),
        (layers([[9], [1], [9]]), [1], True),
        ([Matrix([[], []], 0)], [], True),
        (layers([[1, 0], [9, 9], [0, 1]]), [0, 1], False),
        (layers([[1, 0], [9, 9], [0, 2]]), [0, 2], False),
        (layers([[1, 0], [9, 9], [1, 1]]), [0, 2], False),
        (layers([[1, 0], [9, 9], [0, 1]], [[0, 0], [8, 7], [0, 1]]), [0, 2], False),
        (layers([[1, 0], [9, 9], [0, 1]], NOTHING, [[1, 0], [0, 0], [0, 0]]), [0, 2], False),
        (layers(NOTHING, [[1, 0], [9, 9], [0, 1]]), [0, 2], False),
    ],
)
def test_pivots_hold_an_identity_matrix_for_every_x(
    parts: list[Matrix], pivots: list[int], good: bool
) -> None:
    if good:
        evidence.require_identity(parts, pivots, "pivots")
    else:
        with pytest.raises(Refused) as found:
            evidence.require_identity(parts, pivots, "pivots")
        assert found.value.verdict == "INVALID"


@pytest.mark.parametrize("ell", [2, 3, 4, 10**30])
def test_moduli_start_with_2(ell: int) -> None:
    assert evidence.modulus(ell, "modulus") == ell


@pytest.mark.parametrize(
    ("ell", "verdict"),
    [(1, "INVALID"), (0, "INVALID"), (-7, "INVALID"), ("7", "MALFORMED"), (True, "MALFORMED")],
)
def test_anything_else_is_no_modulus(ell: Any, verdict: str) -> None:
    with pytest.raises(Refused) as found:
        evidence.modulus(ell, "modulus")
    assert found.value.verdict == verdict


def fractions(*numbers: Any) -> list[Fraction]:
    return [Fraction(number) for number in numbers]


def test_polynomials_are_coprime_modulo_l_or_not() -> None:
    evidence.require_coprime(fractions(0, 1), fractions(1, 1), 7, "x and x + 1")
    evidence.require_coprime(fractions("1/2", 1), fractions(0, 1), 7, "x + 1/2 and x")
    for a, b in ((fractions(0, 1), fractions(7, 1)), (fractions(-1, 0, 1), fractions(1, 1))):
        with pytest.raises(Refused) as found:
            evidence.require_coprime(a, b, 7, "they")
        assert found.value.verdict == "INVALID"
    with pytest.raises(NotAUnit):
        evidence.require_coprime(fractions("1/7", 1), fractions(0, 1), 7, "they")
