"""Discs of λ on which a pencil is regular for every member of a box; ``proofs/boxes.md``."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from . import budget
from .arithmetic import Matrix
from .complex_matrices import ComplexMatrix, complex_matrix, extractions, magnitude
from .reading import Json, integer, items

Regular = Callable[[Fraction, Fraction, Fraction], bool]
"""Whether a pencil is regular on the disc of this center, re + i·im, and this radius."""


@dataclass(frozen=True)
class Pencil:
    """λE − Z, whose entries of Z have the radii D; E has ``dynamic`` ones, and then zeros.

    Each of ``tied`` is added to Z with a factor from −1 to 1 of its own.
    """

    Z: Matrix
    D: Matrix
    dynamic: int
    tied: Sequence[Matrix] = ()


def read_weights(value: Json, place: str, size: int) -> Matrix:
    """A column of positive integers."""
    weights = [[integer(entry, place, 1)] for entry in items(value, place, size)]
    return Matrix(weights, 1)


def left_inverse(value: Json, weights: Json, place: str, pencil: Pencil) -> Regular:
    """V about (cE − Z)⁻¹: I − V(λE − Z) is I − (λP − Q), P = VE and Q = VZ.

    Theorems ``boxes.regular_disc_left``, ``boxes.regular_disc_left_tied``.
    """
    size = pencil.Z.nrows
    V, w = complex_matrix(value, place, size, size), read_weights(weights, place, size)
    dynamic = range(pencil.dynamic)
    P = ComplexMatrix(V.re.take(None, dynamic), V.im.take(None, dynamic))
    moved = V.magnitudes() @ (pencil.D @ w)
    for M in pencil.tied:
        moved = moved + V.before(M).magnitudes() @ w
    return near_identity(P, V.before(pencil.Z), moved, w)


def right_inverse(value: Json, weights: Json, place: str, pencil: Pencil) -> Regular:
    """R about a right inverse of cE − Z, E = [I, 0]: I − (λP − Q), P = ER and Q = ZR.

    Theorems ``boxes.regular_disc_right``, ``boxes.regular_disc_right_tied``.
    """
    size = pencil.dynamic
    R = complex_matrix(value, place, pencil.Z.ncols, size)
    w, dynamic = read_weights(weights, place, size), range(size)
    P = ComplexMatrix(R.re.take(dynamic), R.im.take(dynamic))
    moved = pencil.D @ (R.magnitudes() @ w)
    for M in pencil.tied:
        moved = moved + R.after(M).magnitudes() @ w
    return near_identity(P, R.after(pencil.Z), moved, w)


def near_identity(P: ComplexMatrix, Q: ComplexMatrix, moved: Matrix, w: Matrix) -> Regular:
    """Whether Σ_j |I − (cP − Q)|_ij w_j + moved_i + ρ (|P| w)_i < w_i in every row i.

    P has the first columns; in the others it is 0.
    """
    size, width = Q.re.nrows, P.re.ncols
    d = math.lcm(P.re.denominator, Q.re.denominator)
    f, g = d // P.re.denominator, d // Q.re.denominator
    a, b = P.limbs + budget.limbs([f]), Q.limbs + budget.limbs([g])
    budget.build(2 * size, 2 * size, a, b)
    rest = [0] * (size - width)
    xs = [[f * entry for entry in row] + rest for row in P.re.rows]
    ys = [[f * entry for entry in row] + rest for row in P.im.rows]
    us = [[g * entry for entry in row] for row in Q.re.rows]
    vs = [[g * entry for entry in row] for row in Q.im.rows]
    weights = [row[0] for row in w.rows]
    for i in range(size):
        us[i][i] += d
    grown = P.magnitudes() @ Matrix(w.rows[:width], 1)
    slacks = [
        w_i - Fraction(e[0], moved.denominator) for w_i, e in zip(weights, moved.rows, strict=True)
    ]
    slopes = [Fraction(e[0], grown.denominator) for e in grown.rows]

    def regular(re: Fraction, im: Fraction, rho: Fraction) -> bool:
        z = math.lcm(re.denominator, im.denominator)
        p, q = int(re * z), int(im * z)
        c = budget.limbs([p, q, z])
        longest = max(a, b) + c + 1
        budget.spend(
            budget.products(8 * size * size, max(a, b), c) + extractions(size * size, longest)
        )
        budget.spend(budget.fractions(4 * size, longest + moved.limbs + budget.limbs_of([rho])))
        for x, y, u, v, slack, slope in zip(xs, ys, us, vs, slacks, slopes, strict=True):
            total = sum(
                magnitude(x_j * p - y_j * q - z * u_j, x_j * q + y_j * p - z * v_j) * w_j
                for x_j, y_j, u_j, v_j, w_j in zip(x, y, u, v, weights, strict=True)
            )
            if not Fraction(total, d * z) + rho * slope < slack:
                return False
        return True

    return regular
