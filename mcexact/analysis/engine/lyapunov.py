"""Lyapunov matrices, proposed in floating point, and refined and verified exactly.

For a square rational D and a rate b the derivative of xᵀPx along x' = (D + b)x is −xᵀSx with

    S = −(DᵀP + PD + 2bP),          in discrete time, radius r:   S = r²P − DᵀPD.

A symmetric matrix is positive definite if RᵀPR is strictly diagonally dominant with a positive
diagonal for some square R.  All computations use coordinates that are balanced by powers of 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from mcexact.analysis.engine.smith_doubling import doubled_lyapunov
from mcexact.exact.matrix import Matrix, dyadic_matrix, matrix_to_float, to_float
from mcexact.exact.roots import StabilityRegion

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]

_FACTOR_BITS = (26, 52)
_REFINEMENTS = 4
_DOUBLING_LIMIT = 150
_FACTORS = 4
_SHIFT = 2.0**-44


@dataclass(frozen=True)
class QuadraticForm:
    """P, with R and R2 that show P and S to be positive definite; R is None if P is not.

    Attributes
    ----------
    P, R2 : Matrix
        k × k; P is symmetric.
    R : Matrix or None
    v : Matrix or None
        A column with vᵀPv ≤ 0, if R is None.
    """

    P: Matrix
    R: Matrix | None
    R2: Matrix
    v: Matrix | None


def decrease(D: Matrix, P: Matrix, region: StabilityRegion) -> Matrix:
    """Compute S, k × k and symmetric, which is positive definite iff xᵀPx decreases fast enough.

    Parameters
    ----------
    D, P : Matrix
        k × k; P is symmetric.
    region : StabilityRegion
        S = −(DᵀP + PD + 2bP) for a rate b, S = r²P − DᵀPD for a radius r.

    Examples
    --------
    >>> D, P = Matrix.from_rows([[-2]]), Matrix.identity(1)
    >>> decrease(D, P, StabilityRegion("continuous", 1)).numerators
    ((2,),)
    """
    if region.discrete:
        return P * region.edge**2 - D.T @ (P @ D)
    half = D.T @ P
    return -(half + half.T + P * (2 * region.edge))


def is_dominant(S: Matrix) -> bool:
    """Whether every diagonal entry exceeds the sum of the absolute values of its row's rest.

    A symmetric matrix with this property is positive definite; many positive definite ones lack it.

    Examples
    --------
    >>> is_dominant(Matrix.from_rows([[2, -1], [-1, 2]]))
    True
    >>> is_dominant(Matrix.from_rows([[5, 2], [2, 1]]))
    False
    """
    return all(row[i] > sum(map(abs, row)) - abs(row[i]) for i, row in enumerate(S.numerators))


def quadratic_form(D: Matrix, region: StabilityRegion) -> QuadraticForm | None:
    """Search for a quadratic form that decides where the eigenvalues of D lie.

    Parameters
    ----------
    D : Matrix
        k × k.
    region : StabilityRegion

    Returns
    -------
    QuadraticForm or None
        With R, every eigenvalue lies inside; with v, some eigenvalue does not.  None if floating
        point is not accurate enough, for example for eigenvalues very near the boundary.

    Notes
    -----
    Floating point proposes P with S near the identity; as long as S is not dominant, the exact
    residual is solved for a correction.  O(k³) operations on floats and on short integers.  What is
    proposed depends on the processor and on the versions of numpy and scipy.
    """
    k = D.nrows
    if k == 0:
        empty = Matrix.zeros(0, 0)
        return QuadraticForm(empty, empty, empty, None)
    scales = _balancing(D)
    balanced = scaled(D, [1 / s for s in scales], scales)
    P = _approximate(balanced, region) or _precise(balanced, region)
    if P is None:
        return None
    R2 = _diagonal(scales)
    inner = [1 / s for s in scales]
    R = _dominating_factor(P)
    outer = scaled(P, inner, inner)
    if R is not None:
        return QuadraticForm(outer, scaled(R, scales, [Fraction(1)] * k), R2, None)
    v = _negative_direction(P)
    if v is None:
        return None
    return QuadraticForm(outer, None, R2, scaled(v, scales, [Fraction(1)]))


def scaled(M: Matrix, left: list[Fraction], right: list[Fraction]) -> Matrix:
    """diag(left) M diag(right)."""
    return _diagonal(left) @ (M @ _diagonal(right))


def _diagonal(entries: list[Fraction]) -> Matrix:
    size = len(entries)
    return Matrix.from_rows(
        [[entries[i] if i == j else 0 for j in range(size)] for i in range(size)], ncols=size
    )


def _balancing(D: Matrix) -> list[Fraction]:
    """Powers of 2 that bring the rows and columns of D to like size."""
    import warnings

    import numpy as np
    from scipy.linalg import matrix_balance

    floats = matrix_to_float(D)
    if not np.all(np.isfinite(floats)):
        return [Fraction(1)] * D.nrows
    with warnings.catch_warnings():
        # It converts the factors to positions for permutations, which are not used here.
        warnings.simplefilter("ignore")
        _, (factors, _) = matrix_balance(floats, permute=False, separate=True)
    if not np.all(np.isfinite(factors)):
        return [Fraction(1)] * D.nrows
    return [Fraction(float(factor)) for factor in factors]


def _approximate(D: Matrix, region: StabilityRegion) -> Matrix | None:
    """A symmetric P with S dominant, found by floating-point solutions of exact residuals."""
    import numpy as np

    k = D.nrows
    identity = Matrix.identity(k)
    D_float = matrix_to_float(D)
    if not np.all(np.isfinite(D_float)):
        return None
    P, residual = Matrix.zeros(k, k), identity
    for _ in range(_REFINEMENTS):
        step = _solve(D_float, matrix_to_float(residual), region)
        if step is None:
            return None
        P = P + dyadic_matrix(step)
        S = decrease(D, P, region)
        if is_dominant(S):
            return P
        residual = identity - S
    return None


def _precise(D: Matrix, region: StabilityRegion) -> Matrix | None:
    """A P with S dominant from Smith's doubling: for blocks that are far from normal."""
    import numpy as np

    if D.nrows > _DOUBLING_LIMIT or not np.all(np.isfinite(matrix_to_float(D))):
        return None
    P = doubled_lyapunov(D, region)
    return P if P is not None and is_dominant(decrease(D, P, region)) else None


def _solve(D: Floats, Q: Floats, region: StabilityRegion) -> Floats | None:
    """The symmetric solution of DᵀP + PD + 2bP = −Q, or of r²P − DᵀPD = Q, in floating point."""
    import warnings

    import numpy as np
    from scipy.linalg import LinAlgError, solve_continuous_lyapunov, solve_discrete_lyapunov

    bound = to_float(region.edge)
    with warnings.catch_warnings():
        # An ill-conditioned equation may still give a P that passes the exact test.
        warnings.simplefilter("ignore")
        try:
            if region.discrete:
                P = solve_discrete_lyapunov(D.T / bound, Q / bound**2)
            else:
                P = solve_continuous_lyapunov((D + bound * np.eye(len(D))).T, -Q)
        except (LinAlgError, ValueError):
            return None
    if not np.all(np.isfinite(P)):
        return None
    return np.asarray((P + P.T) / 2, dtype=np.float64)


def _dominating_factor(P: Matrix) -> Matrix | None:
    """R with RᵀPR dominant: a factor of few bits, or a product if P is nearly singular.

    A factor of a nearly singular P, shifted a little, leaves RᵀPR much better conditioned, and so
    on (Rump's preconditioning by approximate inverses).
    """
    few, many = _FACTOR_BITS
    R = _cholesky_factor(matrix_to_float(P), few)
    if R is not None and is_dominant(R.T @ (P @ R)):
        return R
    product, near = Matrix.identity(P.nrows), P
    for _ in range(_FACTORS):
        R = _cholesky_factor(matrix_to_float(near), many)
        if R is None:
            return None
        product = product @ R
        near = product.T @ (P @ product)
        if is_dominant(near):
            return product
    return None


def _cholesky_factor(P: Floats, bits: int) -> Matrix | None:
    """An upper triangular R, RᵀPR near a diagonal matrix; None if P is not definite at all."""
    import numpy as np
    from scipy.linalg import solve_triangular

    diagonal = np.diag(P)
    if not np.all(diagonal > 0):
        return None
    units = np.exp2(-np.round(np.log2(diagonal) / 2))
    even = P * np.outer(units, units)
    for shift in (0.0, _SHIFT):
        try:
            L = np.linalg.cholesky(even + shift * np.eye(len(P)))
        except np.linalg.LinAlgError:
            continue
        R = solve_triangular(L, np.eye(len(P)), lower=True).T
        columns = np.exp2(np.round(np.log2(np.max(np.abs(R), axis=0))))
        return _diagonal([Fraction(unit) for unit in units.tolist()]) @ dyadic_matrix(
            R / columns, bits
        )
    return None


def _negative_direction(P: Matrix) -> Matrix | None:
    """A column v ≠ 0 with vᵀPv ≤ 0, exactly."""
    import numpy as np

    values, vectors = np.linalg.eigh(matrix_to_float(P))
    if values[0] >= 0:
        return None
    v = dyadic_matrix(vectors[:, :1], _FACTOR_BITS[0])
    return v if (v.T @ (P @ v))[0, 0] <= 0 else None
