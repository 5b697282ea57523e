"""Figures of loops whose eigenvalues coincide: exact where they can be, and alike everywhere."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import comb, factorial

import numpy as np
import pytest

from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import assessed_loop
from mcexact.synthesis.optimum.diagnosis import curves_of, figures_of_loop, sure_figures
from mcexact.synthesis.optimum.problem import Weights
from tests.wording import says


def pascal(n: int, sign: int = 1) -> Matrix:
    """The lower triangular Pascal matrix; with sign −1 its inverse."""
    return Matrix.from_rows([[sign ** (i + j) * comb(i, j) for j in range(n)] for i in range(n)])


def defective(n: int, eigenvalue: str, time: str = "continuous") -> ClosedLoop:
    """A loop with one Jordan block of size n, in other coordinates than those of the block."""
    block = Matrix.from_rows([[Fraction(eigenvalue) * (i == j) + (j == i + 1) for j in range(n)]
                              for i in range(n)])  # fmt: skip
    T = pascal(n) @ pascal(n).T
    A = T @ block @ (pascal(n, -1).T @ pascal(n, -1))
    last = [[int(i == n - 1)] for i in range(n)]
    plant = MultiChannelSystem(A, [last], [[[int(j == 0) for j in range(n)]]], time=time)
    return closed_loop(plant, local_controllers(plant, [[[0]]]))


def norm_at(n: int, t: Fraction) -> float:
    """‖exp(At)‖ of `defective` with -1, from the closed form of a Jordan block."""
    block = Matrix.from_rows([[t ** (j - i) / factorial(j - i) if j >= i else 0 for j in range(n)]
                              for i in range(n)])  # fmt: skip
    T = pascal(n) @ pascal(n).T
    moved = T @ block @ (pascal(n, -1).T @ pascal(n, -1))
    floats = np.array([[float(x) for x in row] for row in moved.rows()])
    return math.exp(-t) * float(np.linalg.norm(floats, 2))


@pytest.mark.parametrize("n", [4, 8, 12])
def test_eigenvalues_of_defective_loops_are_exact(n: int) -> None:
    loop = defective(n, "-1")
    found = sure_figures(loop, Weights.unit(loop.plant))
    assert (found.bound, found.damping, found.fastest) == (-1.0, 1.0, 1.0)
    quick = figures_of_loop(loop, Weights.unit(loop.plant))
    assert n == 4 or abs(quick.bound + 1) > 1e-3
    steps = defective(n, "1/2", "discrete")
    assert sure_figures(steps, Weights.unit(steps.plant)).bound == 0.5


@pytest.mark.parametrize("n", [4, 8, 12])
def test_the_peak_is_that_of_the_closed_form(n: int) -> None:
    loop = defective(n, "-1")
    found = sure_figures(loop, Weights.unit(loop.plant)).peak
    true = max(norm_at(n, Fraction(k, 2)) for k in range(1, 60))
    assert 0.97 * true <= found <= 1.05 * true


def test_the_curves_of_a_defective_loop_are_those_of_the_closed_form() -> None:
    curves = curves_of(defective(4, "-1"), StabilityRegion("continuous"))
    assert curves is not None and curves.eigenvalues == [-1.0]
    for t, size in zip(curves.times[::40], curves.growth[::40], strict=True):
        assert size == pytest.approx(norm_at(4, Fraction(t)), rel=1e-9)


def test_what_is_not_known_is_said_and_is_no_danger() -> None:
    loop = defective(2, "-1")
    found = assessed_loop(loop, StabilityRegion("continuous"), certified=True)
    figures = replace(found.figures, margin=math.nan, cost=math.nan)
    unknown = replace(found, figures=figures, performance=None)
    assert unknown.install == "with care"
    assert says(unknown.warnings, "margin known")
    assert dict(unknown.rows())["margin at the plant's inputs"].startswith("not known")
    assert unknown.to_dict()["margin"] is None


def test_a_loop_that_rounding_destabilizes_has_no_margin_on_any_processor() -> None:
    # The determinant is 2^-60; with 1/10 rounded up it is below 0.
    near = Fraction(1) + Fraction(1, 2**60)
    plant = MultiChannelSystem([[-1, "1/10"], [10, -near]], [[[0], [1]]], [[[1, 0]]])
    loop = closed_loop(plant, local_controllers(plant, [[[0]]]))
    found = sure_figures(loop, Weights.unit(plant))
    assert -1e-17 < found.bound < 0 and found.margin == 0
    assessed = assessed_loop(loop, StabilityRegion("continuous"), certified=True)
    assert assessed.install == "no"


_SHOWN = """
from mcexact.synthesis.assessment import shown
from mcexact.synthesis.optimum.diagnosis import sure_figures
from mcexact.synthesis.optimum.problem import Weights
from tests.synthesis.optimum.test_loop_figures import defective
for n, eigenvalue, time in (
    (6, "-1", "continuous"), (9, "-1", "continuous"), (6, "1/2", "discrete")
):
    loop = defective(n, eigenvalue, time)
    found = vars(sure_figures(loop, Weights.unit(loop.plant)))
    print({name: shown(value) for name, value in found.items()})
"""


def test_printed_figures_are_alike_on_different_processors() -> None:
    shown = []
    for core in ("Prescott", "Haswell", "SkylakeX"):
        environment = {**os.environ, "OPENBLAS_CORETYPE": core}
        command = [sys.executable, "-c", _SHOWN.strip()]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        shown.append(done.stdout)
    assert all(one == other for one, other in pairwise(shown)) and "'bound': '-1'" in shown[0]


def test_the_peak_of_a_large_loop_is_known_in_whatever_units_its_states_are() -> None:
    """With more than 40 states it is compared with that of balanced coordinates."""
    n = 44
    sizes = [Fraction(10) ** (k % 5 - 2) for k in range(n)]
    rows = [
        [Fraction(-1 if i == j else (i == j + 1)) * sizes[i] / sizes[j] for j in range(n)]
        for i in range(n)
    ]
    plant = MultiChannelSystem(rows, [[[1]] * n], [[[1] * n]])
    loop = closed_loop(plant, local_controllers(plant, [[[0]]]))
    seen, plain = (make(loop, Weights.unit(plant)) for make in (sure_figures, figures_of_loop))
    assert seen.peak == pytest.approx(plain.peak, rel=5e-3) and seen.peak > 10
