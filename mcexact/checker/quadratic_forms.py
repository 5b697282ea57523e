"""Quadratic forms that decrease along trajectories of a loop; ``proofs/stability.md``."""

from fractions import Fraction

from . import evidence
from .arithmetic import Echelon, Matrix
from .budget import products, spend
from .reading import Json, fields, matrix, require


def transformed(value: Json, M: Matrix) -> Matrix:
    """Δ with M T = T Δ for a T that is nonsingular modulo ℓ.

    Theorem ``stability.stability_blocks``.
    """
    place, N = "witness.transformation", M.nrows
    left, right, number = fields(value, place, "T", "Delta", "modulus")
    T, Delta = matrix(left, f"{place}.T", N, N), matrix(right, f"{place}.Delta", N, N)
    basis = Echelon(evidence.modulus(number, f"{place}.modulus"))
    independent = all(basis.add(row) is not None for row in T.modulo(basis.ell))
    require(independent, "rank", f"{place}.T", "singular modulo l")
    require((M @ T).equals(T @ Delta), "identity", place, "M T differs from T Delta")
    return Delta


def decreasing(value: Json, place: str, D: Matrix, time: str, bound: Fraction) -> Matrix:
    """P, symmetric, with −(DᵀP + PD + 2·bound·P), or bound²P − DᵀPD, positive definite by R2.

    Theorems ``stability.stability_continuous``, ``stability.stability_discrete``.
    """
    k = D.nrows
    P, R2 = (matrix(value[key], f"{place}.{key}", k, k) for key in ("P", "R2"))
    require(P.equals(P.T), "symmetry", f"{place}.P", "not symmetric")
    half = P @ D
    if time == "continuous":
        S = (half + half.T + P.times(2 * bound)).times(Fraction(-1))
    else:
        S = P.times(bound**2) - D.T @ half
    require_dominant(R2.T @ (S @ R2), f"{place}.R2")
    return P


def require_dominant(S: Matrix, place: str) -> None:
    """Stop unless S is strictly diagonally dominant with positive diagonal.

    Theorem ``stability.dominant_congruence``.
    """
    spend(products(2 * S.nrows * (S.nrows + 4), S.limbs, 1))
    sizes = enumerate((row, sum(map(abs, row))) for row in S.rows)
    fits = all(2 * row[i] > row[i] + size - abs(row[i]) for i, (row, size) in sizes)
    require(fits, "dominance", place, "not strictly diagonally dominant")
