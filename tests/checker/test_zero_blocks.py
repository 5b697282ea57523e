"""Zero blocks of plants with a parameter, with and without a value of it."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused
from mcexact.checker.parameters import polynomial_layers, require_multiple, zero_block
from mcexact.checker.parametric_system import one_parameter, read_parametric
from tests.assurance.attack.forgeries.parametric_traps import block, layers, plant
from tests.checker.handmade import changed

Q = [Fraction(-2), Fraction(0), Fraction(1)]
"""t² − 2."""


def polynomial(*coefficients: list[Any]) -> list[list[Fraction]]:
    """A polynomial in x and t."""
    return [[Fraction(c) for c in part] for part in coefficients]


def refusal(value: Any, system: Any, p: Any, q: Any = None) -> tuple[str, str]:
    """The code and the place where a zero block is refused; nothing if it is one."""
    try:
        assert zero_block(value, "b", one_parameter(read_parametric(system)), p, q) == [
            int(name) - 1 for name in value["channels_T"]
        ]
    except Refused as found:
        return found.code, found.place
    return "", ""


HIDDEN = plant(
    [[0, 1, 0], ["t", 0, 0], [0, 0, 5]],
    ([[1], [0], [0]], [[0, 0, 0]]),
    ([[0], [0], [0]], [[0, 0, 1]]),
    ([[0], [0], [1]], [[0, 0, "t^2 - 2"]]),
)
"""x² − t for every t: the channels 1 and 2 do not move it together, and 3 does not see it."""
X2_T = polynomial([0, -1], [], [1])
SEEN = block(["2"], [layers([[0], [1], [0]]), layers([[1], [0], [0]])], layers(
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]]), [1], [0, 1, 2])  # fmt: skip
"""(xI − A) u = 0 modulo x² − t for u = (x... t, 0): here u = (1, 0, 0) x + (0, t, 0)."""


def with_t(value: Any) -> Any:
    """The pivot row of U is t·I."""
    return changed(value, ("U.0", layers([[0], [0], [0]], [[0], [1], [0]])))


def test_a_block_of_powers_of_x_and_of_t() -> None:
    unseen = changed(with_t(SEEN), ("row_pivots", [1]))
    assert refusal(unseen, HIDDEN, X2_T) == ("", "")
    # W of three rows controls everything; with T = {1}, B_1 is not annihilated
    first = changed(unseen, ("channels_T", ["1"]))
    assert refusal(first, HIDDEN, X2_T) == ("identity", "b")
    seen = changed(HIDDEN, ("channels.0.C", [[1, 0, 0]]))
    assert refusal(unseen, seen, X2_T) == ("identity", "b")
    late = changed(HIDDEN, ("channels.2.C", [["t", 0, 0]]))
    assert refusal(unseen, late, X2_T) == ("identity", "b")
    assert refusal(unseen, HIDDEN, polynomial([0, 1], [], [1])) == ("identity", "b")
    assert refusal(unseen, HIDDEN, polynomial([0, -1], [1], [1])) == ("identity", "b")
    assert refusal(unseen, HIDDEN, polynomial([1, -1], [], [1])) == ("identity", "b")


ALL = layers([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
LAST = block(["1", "2"], [ALL], layers([[0, 0, 1]]), [0, 1, 2], [2])
FIVE = polynomial([-5], [1])


def test_a_block_at_a_value() -> None:
    assert refusal(LAST, HIDDEN, FIVE, Q) == ("", "")
    assert refusal(LAST, HIDDEN, FIVE) == ("identity", "b")  # channel 3 sees it but for t² = 2
    assert refusal(LAST, changed(HIDDEN, ("channels.2.C", [[0, 0, 0]])), FIVE, Q) == ("", "")
    narrow = changed(
        LAST,
        ("channels_T", []),
        ("U", [layers([[0], [0], [1]])]),
        ("W", ALL),
        ("row_pivots", [2]),
        ("column_pivots", [0, 1, 2]),
    )
    assert refusal(narrow, HIDDEN, FIVE, Q) == ("identity", "b")  # channel 2 sees it
    dark = changed(HIDDEN, ("channels.1.C", [[0, 0, 0]]))
    assert refusal(narrow, dark, FIVE, Q) == ("", "")
    assert refusal(narrow, dark, FIVE) == ("identity", "b")  # channel 3 sees it but for t² = 2
    assert refusal(narrow, dark, FIVE, [Fraction(-3), Fraction(0), Fraction(1)])[0] == "identity"
    weak = plant([[0]], ([["t^2 - 2"]], [[1]]))
    one = block(["1"], [layers([[1]])], layers([[1]]), [0], [0])
    zero = polynomial([], [1])
    assert refusal(one, weak, zero, Q) == ("", "")
    assert refusal(one, weak, zero) == ("identity", "b")
    moving = plant([["t^3"]], ([[0]], [[1]]))
    assert refusal(one, moving, polynomial([0, -2], [1]), Q) == ("", "")
    assert refusal(one, moving, polynomial([0, 0, 0, -1], [1])) == ("", "")
    assert refusal(one, moving, polynomial([0, -2], [1])) == ("identity", "b")


def test_the_identity_holds_in_every_power_of_x() -> None:
    """x³ = t: e_1 = (1, x, x²) in the companion matrix, and every entry of it counts."""
    companion = plant([[0, 1, 0], [0, 0, 1], ["t", 0, 0]], ([[0], [0], [0]], [[1, 0, 0]]))
    third = polynomial([0, -1], [], [], [1])
    value = block(
        ["1"],
        [layers([[1], [0], [0]]), layers([[0], [1], [0]]), layers([[0], [0], [1]])],
        ALL,
        [0],
        [0, 1, 2],
    )
    assert refusal(value, companion, third) == ("", "")
    for k in range(3):
        for i in range(1, 3):
            entry = value["U"][k]["coefficients"][0][i][0]
            other = changed(value, (f"U.{k}.coefficients.0.{i}.0", entry + 1))
            assert refusal(other, companion, third) == ("identity", "b")
    for p in ([[0, -1], [1], [], [1]], [[0, -1], [], [1], [1]], [[0, 1], [], [], [1]]):
        assert refusal(value, companion, polynomial(*p)) == ("identity", "b")
    for i, j in ((0, 0), (1, 0), (2, 0), (2, 1), (0, 2)):
        entry = companion["A"][i][j]
        other = changed(companion, (f"A.{i}.{j}", 3 if entry in (0, 1) else "t + 1"))
        assert refusal(value, other, third) == ("identity", "b")


STILL = plant([[0, 0], [0, 0]], ([[0], [0]], [[1, "t"]]))
WIDE = block(["1"], [layers([[1, 0], [0, 1]])], layers([[1, 0]]), [0, 1], [0])
ZERO = polynomial([], [1])


@pytest.mark.parametrize(
    ("edits", "expected"),
    [
        ((), ("", "")),
        ((("column_pivots", [1]),), ("pivots", "b.column_pivots")),
        ((("W", layers([[2, 0]])),), ("pivots", "b.column_pivots")),
        ((("W", layers([[0, 0]])),), ("pivots", "b.column_pivots")),
        ((("W", layers([[1, 0]], [[0, 1]])),), ("", "")),
        ((("W", layers([[1, 0]], [[1, 0]])),), ("pivots", "b.column_pivots")),
        ((("U.0", layers([[1, 0], [1, 1]])),), ("pivots", "b.row_pivots")),
        ((("U.0", layers([[1, 1], [0, 1]])),), ("pivots", "b.row_pivots")),
        ((("U.0", layers([[1, 0], [0, 2]])),), ("pivots", "b.row_pivots")),
        ((("U.0", layers([[-1, 0], [0, -1]])),), ("pivots", "b.row_pivots")),
        ((("row_pivots", [0]),), ("rank", "b")),
        ((("row_pivots", []), ("U.0", layers([[], []]))), ("rank", "b")),
        ((("row_pivots", [0]), ("U.0", layers([[1], [0]]))), ("rank", "b")),
        ((("row_pivots", [1, 0]),), ("form", "b.row_pivots")),
        ((("row_pivots", [0, 2]),), ("form", "b.row_pivots")),
        ((("column_pivots", [2]),), ("form", "b.column_pivots")),
        ((("channels_T", ["2"]),), ("form", "b.channels_T")),
        ((("channels_T", []),), ("identity", "b")),
        ((("U", []),), ("form", "b.U")),
        ((("W", layers([[1, 0, 0]])),), ("form", "b.W")),
        ((("W", layers([[1, 0]], [[0, 0]], [[0, 1]])),), ("form", "b.W")),
        ((("U.0", layers([[1, 0], [0, 1]], [[0, 0], [0, 0]], [[0, 0], [0, 0]])),), ("form", "b.U")),
    ],
)
def test_pivots_and_shapes_at_a_value(edits: Any, expected: tuple[str, str]) -> None:
    code, place = refusal(changed(WIDE, *edits), STILL, ZERO, Q)
    assert code == expected[0]
    assert place.startswith(expected[1])


@pytest.mark.parametrize(
    ("edits", "code"),
    [
        ((("W", layers([[2, 0]])),), ""),
        ((("W", layers([[0, 0]])),), "pivots"),
        ((("W", layers([[0, 0]], [[-3, 0]])),), ""),
        ((("W", layers([[1, 0]], [[0, 1]], [[0, 1]])),), ""),
        ((("U.0", layers([[1, 0], [0, 1]], [[2, 0], [0, 2]])),), ""),
        ((("U.0", layers([[1, 0], [0, 1]], [[2, 0], [0, 1]])),), "pivots"),
        ((("U.0", layers([[0, 0], [0, 0]])),), "pivots"),
    ],
)
def test_without_a_value_pivots_are_multiples_of_the_identity(edits: Any, code: str) -> None:
    assert refusal(changed(WIDE, *edits), STILL, ZERO)[0] == code


def test_pivots_do_not_depend_on_x() -> None:
    two = polynomial([], [], [1])
    double = changed(WIDE, ("U", [WIDE["U"][0], layers([[0, 0], [0, 0]])]))
    still = changed(STILL, ("A", [[0, 0], [0, 0]]))
    assert refusal(double, still, two, Q) == ("identity", "b")  # x U is not 0 modulo x²
    empty = changed(double, ("W", layers([[1, 0], [0, 1]])), ("column_pivots", [0, 1]))
    nilpotent = plant([[0, 1], [0, 0]], ([[0], [0]], [[1, "t"]]))
    value = changed(empty, ("U", [layers([[1], [0]]), layers([[0], [1]])]), ("row_pivots", [0]))
    assert refusal(value, nilpotent, two, Q) == ("", "")
    moved = changed(value, ("U.1", layers([[1], [1]])))
    assert refusal(moved, nilpotent, two, Q) == ("pivots", "b")


def test_blocks_of_multiples_of_the_identity() -> None:
    def refused(parts: list[Any], size: int, q: Any = None) -> bool:
        block = [Matrix(rows, size, 2) for rows in parts]
        try:
            require_multiple(block, size, "b", q)
        except Refused as found:
            assert (found.code, found.place) == ("pivots", "b")
            return True
        return False

    identity, zero, twice = [[2, 0], [0, 2]], [[0, 0], [0, 0]], [[4, 0], [0, 4]]
    assert not refused([identity], 2) and not refused([identity], 2, Q)
    assert not refused([zero, identity], 2) and refused([zero, identity], 2, Q)
    assert not refused([identity, zero], 2, Q) and refused([identity, twice], 2, Q)
    assert not refused([twice], 2) and refused([twice], 2, Q)
    assert refused([zero], 2) and refused([zero, zero], 2)
    assert refused([[[2, 1], [0, 2]]], 2) and refused([identity, [[1, 0], [0, 2]]], 2)
    assert refused([[[0, 0], [0, 2]]], 2) and refused([identity, [[0, 0], [0, 1]]], 2, Q)
    assert not refused([[]], 0) and not refused([[]], 0, Q)


def test_layers_are_reduced_at_a_value_alone() -> None:
    value = layers([[1]], [[0]], [[3]])
    assert len(polynomial_layers(value, "b", 1, 1, None)) == 3
    assert len(polynomial_layers(value, "b", 1, 1, [*Q, Fraction(1)])) == 3
    with pytest.raises(Refused):
        polynomial_layers(value, "b", 1, 1, Q)
    for other in ({"denominator": 1}, layers(), {**value, "pivots": []}, layers([[1, 2]])):
        with pytest.raises(Refused):
            polynomial_layers(other, "b", 1, 1, None)
