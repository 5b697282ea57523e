"""The work on parameters and cells is counted by its size, before it is done."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker import bivariate, boxes, cells
from mcexact.checker.core import budget, reading
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.discs import Pencil
from mcexact.checker.parametric_system import (
    ONE,
    Terms,
    cleared_tables,
    common_divisor,
    function,
    quotient,
    quotient_text,
    read_parametric,
)
from tests.checker import heavy_parameters as heavy

MANY = heavy.MANY
ELL = 2**61 - 1
LONG = 10**900 + 7
WIDE = read_parametric(heavy.within([[0]], parameters=MANY))
CELL = [(Fraction(0), Fraction(1))] * 100
CENTER = [Fraction(1, 2)] * 100
UNITS: list[tuple[int, ...]] = [tuple(int(i == k) for i in range(100)) for k in range(100)]
SUM: Terms = {unit: Fraction(1) for unit in UNITS}
CONSTANT: Terms = {(0,) * 100: Fraction(1)}
SHORT: Any = [[Fraction(1)]] * 100
HIGH: Any = [[Fraction(k) for k in range(1, 400)]]
GROWING = Pencil(Matrix([[-1, *[0] * 60], *[[1] * 61] * 60], 61, 3), Matrix.zeros(61, 61), 1)
THIRD = [Fraction(1, 3)] * 300


STEPS: dict[str, tuple[Callable[[], Any], int]] = {
    "looking how long rationals are": (lambda: budget.limbs_of(THIRD), 14_925),
    "a table without rows": (lambda: Matrix.zeros(0, 0), 398),
    "whether nothing is zero": (Matrix([], 0).is_zero, 398),
    "rows of nothing": (lambda: Matrix([], 0).at([]), 398),
    "many rows of nothing": (lambda: Matrix([[]], 0).at([0] * 1000), 8_358),
    "a product of 1000 layers without rows": (
        lambda: bivariate.product([Matrix([], 0)] * 1000, [Matrix([], 0)]),
        796_398,
    ),
    "matrices of functions": (
        lambda: cleared_tables([([[([Fraction(1)] * 500, ONE)] * 5] * 5, 5)]),
        3_907_022,
    ),
    "denominators as keys": (
        lambda: cleared_tables([([[([], [Fraction(1)] * 500)] * 50] * 50, 50)]),
        210_804_035,
    ),
    "different denominators": (
        lambda: cleared_tables([([[([Fraction(1, LONG + k)], ONE) for k in range(20)]], 20)]),
        7_441_699,
    ),
    "an entry that is a number": (lambda: function(1, "", "t", None), 208),
    "an entry that is a number, among parameters": (lambda: quotient(1, "", MANY, None), 1_194),
    "a monic divisor": (
        lambda: common_divisor([], [Fraction(k, 7) for k in range(1, 500)]),
        54_830,
    ),
    "a sum with a long first part": (
        lambda: function("t^900 + 1", "", "t", None),
        131_067_582,
    ),
    "a sum of 100 parameters": (lambda: quotient("+".join(MANY), "", MANY, None), 29_919_249),
    "a square of a sum of 100 parameters": (
        lambda: quotient(f"({'+'.join(MANY)})^2", "", MANY, None),
        39_369_514,
    ),
    "a text with 100 parameters": (
        lambda: quotient_text((SUM, CONSTANT), MANY),
        76_224,
    ),
    "cuts": (lambda: cells.cells_of([0, None, None], "", WIDE), 60_356),
    "exponents": (lambda: cells._units(100), 86_366),
    "a constant in a cell": (
        lambda: cells._form((CONSTANT, CONSTANT), CENTER, CENTER, UNITS, ""),
        49_859,
    ),
    "slopes in a cell": (
        lambda: cells._form((SUM, CONSTANT), CENTER, CENTER, UNITS, ""),
        11_465_484,
    ),
    "the largest values of terms": (
        lambda: cells._largest(SUM, CENTER),
        178_038,
    ),
    "a polynomial moved to a center": (
        lambda: cells._shifted({(50,): Fraction(1)}, CENTER[:1]),
        289_771,
    ),
    "terms that are not moved": (
        lambda: cells._shifted(SUM | CONSTANT, [Fraction(0)] * 100),
        11_034_749,
    ),
    "matrices of fractions": (
        lambda: cells._matrix([[Fraction(1, LONG + k) for k in range(9)]] * 9, 9),
        1_269_295,
    ),
    "a division of polynomials in x": (
        lambda: bivariate.divide([[]] * 1000 + SHORT, SHORT),
        1_188_784,
    ),
    "a difference of polynomials in t": (
        lambda: bivariate.difference(HIGH, [[Fraction(1)]]),
        43_912,
    ),
    "lengths of rows and columns": (
        lambda: bivariate._length([Matrix([[1] * 50] * 50, 50)] * 9, 0, True),
        1_970,
    ),
    "characteristic polynomials of one state": (
        lambda: bivariate._characteristic_values([Matrix([[1]], 1)] * 60, 0),
        555_511,
    ),
    "the same modulo a number": (
        lambda: bivariate._characteristic_values([Matrix([[1]], 1)] * 60, ELL),
        165_676,
    ),
    "values of polynomials": (lambda: bivariate._at_point([[1]] * 500, 3, LONG), 1_871_993),
    "a resultant of values": (lambda: bivariate._of_values([1], [1], LONG), 54_844),
    "remainders of values": (
        lambda: bivariate._of_values(
            [k**50 for k in range(1, 40)], [k**51 for k in range(2, 41)], ELL
        ),
        29_362,
    ),
    "a bound of a resultant": (
        lambda: bivariate.integer_resultant([[LONG], *[[1]] * 301], SHORT, [ELL, 2]),
        18_229_032,
    ),
    "a growth of signals": (
        lambda: boxes._require_growth([1], GROWING, Fraction(1)),
        833_367,
    ),
}
"""A step, and the units that it takes at least."""


@pytest.mark.parametrize("step", STEPS)
def test_a_step_is_charged_for_its_size(step: str) -> None:
    run, least = STEPS[step]
    given = Budget(10**15, 0)
    with limited(given):
        try:
            run()
        except reading.Refused as refused:
            assert refused.code != "work"
    assert given.spent >= least
