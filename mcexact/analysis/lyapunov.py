"""Lyapunov matrices and quadratic forms, proposed in floating point, verified exactly.

For a square rational D and a rate b the derivative of xᵀPx along x' = (D + b)x is −xᵀSx with

    S = −(DᵀP + PD + 2bP),          in discrete time, radius r:   S = r²P − DᵀPD.

With P and S positive definite every eigenvalue of D lies in the region; with S positive definite
and a v ≠ 0 for which vᵀPv ≤ 0, some eigenvalue does not.  A symmetric matrix is proved to be
positive definite by a square R for which RᵀPR is strictly diagonally dominant with a positive
diagonal, which is quick to check.

`quadratic_form` searches P: floating point solves the equation for S near the identity, and the
exact residual is solved for corrections until S is dominant, with O(k³) operations on floats and
short integers.  For D far from normal, where that fails, `doubled_lyapunov` solves the equation by
Smith's doubling in fixed-point integers, to any precision.  All computations use coordinates that
are balanced by powers of 2.  None means that the search was inconclusive, as it is for eigenvalues
very near the border.

`separated_instability` assembles a form for a whole loop from forms of its diagonal blocks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from mcexact.answer.loops import InstabilityMethod
from mcexact.exact.matrix import (
    Matrix,
    block_diagonal,
    dyadic_matrix,
    matrix_from_float,
    matrix_to_float,
    to_float,
    vstack,
)
from mcexact.exact.roots import StabilityRegion

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]


# Smith's doubling in fixed-point integers.

_BITS = 320
_DOUBLINGS = 40
_NEWTON = 9


def doubled_lyapunov(D: Matrix, region: StabilityRegion) -> Matrix | None:
    """Propose P with −(DᵀP + PD + 2bP), or r²P − DᵀPD, near the identity.

    Parameters
    ----------
    D : Matrix, k × k
    region : StabilityRegion
        The region of the rate b or the radius r.

    Returns
    -------
    Matrix or None
        Symmetric and dyadic; None if the iteration does not converge, for example because an
        eigenvalue lies outside.

    Notes
    -----
    The result is a proposal for D far from normal, with 320 bits after the point.  The series
    P = Σ (Nᵀ)ʲ Q Nʲ is summed by squaring N.  In discrete time N = D/r and Q = I/r²; in continuous
    time Cayley's transformation gives W = (pI − D − bI)⁻¹, N = (pI + D + bI) W and Q = 2p WᵀW.
    Each step is a few products of k × k matrices.

    Examples
    --------
    >>> D = Matrix.from_rows([[-2, 10**9], [0, -3]])
    >>> P = doubled_lyapunov(D, StabilityRegion("continuous", 1))
    >>> S = -(D.T @ P + P @ D + P * 2)
    >>> all(abs(x) < Fraction(1, 10**40) for row in (S - Matrix.identity(2)).rows() for x in row)
    True
    """
    identity, bound = Matrix.identity(D.nrows), region.edge
    if region.discrete:
        N, Q = rounded(D * (1 / bound)), identity * (1 / bound**2)
    else:
        shifted = D + identity * bound
        p = _center(shifted)
        W = None if p is None else _inverse(identity * p - shifted)
        if p is None or W is None:
            return None
        N = rounded((identity * p + shifted) @ W)
        Q = W.T @ W * (2 * p)
    P = rounded(Q)
    for _ in range(_DOUBLINGS):
        step = rounded(N.T @ P @ N)
        P = P + step
        if _is_small(step, 64):
            return rounded((P + P.T) * Fraction(1, 2))
        N = rounded(N @ N)
        if not _is_small(N, -4 * _BITS):
            return None
    return None


def rounded(M: Matrix, bits: int = _BITS) -> Matrix:
    """M rounded down to multiples of 2^−bits.

    A matrix whose entries are such multiples is returned as it is.

    Examples
    --------
    >>> rounded(Matrix.from_rows([["1/3", "-1/3"]]), 2).rows()
    ((Fraction(1, 4), Fraction(-1, 2)),)
    """
    d = M.denominator
    if d & (d - 1) == 0 and d.bit_length() <= bits + 1:
        return M
    numerators = [[(x << bits) // d for x in row] for row in M.numerators]
    return Matrix.from_integers(numerators, 1 << bits, ncols=M.ncols)


def _is_small(M: Matrix, bits: int) -> bool:
    """Whether every entry is below 2^−bits."""
    largest = Fraction(max((abs(x) for row in M.numerators for x in row), default=0), M.denominator)
    return largest < Fraction(2) ** -bits


def _center(M: Matrix) -> Fraction | None:
    """A power of 2 near the geometric mean of the eigenvalues' moduli; None beyond floats."""
    import numpy as np

    floats = matrix_to_float(M)
    if not np.all(np.isfinite(floats)):
        return None
    sizes = np.abs(np.linalg.eigvals(floats))
    mean = float(np.mean(np.log2(np.maximum(sizes, 2.0**-30))))
    return Fraction(2) ** round(mean)


def _inverse(M: Matrix) -> Matrix | None:
    """The inverse by Newton's iteration from the floating-point one; None if that fails."""
    import numpy as np

    try:
        start = np.linalg.inv(matrix_to_float(M))
    except np.linalg.LinAlgError:
        return None
    if not np.all(np.isfinite(start)):
        return None
    X, identity = matrix_from_float(start, "dyadic"), Matrix.identity(M.nrows)
    for _ in range(_NEWTON):
        defect = identity - M @ X
        if _is_small(defect, _BITS // 2):
            return X
        if not _is_small(defect, 0):
            return None
        X = rounded(X + X @ defect)
    return X


# Floating-point proposals, refined and verified exactly.

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


def is_positive(S: Matrix) -> bool:
    """Whether a symmetric matrix is shown to be positive definite by a factor of few bits.

    Parameters
    ----------
    S : Matrix
        k × k.

    Returns
    -------
    bool
        With False nothing is known: S may be nearly singular.
    """
    if not S.nrows:
        return True
    R = _cholesky_factor(matrix_to_float(S), _FACTOR_BITS[0])
    return R is not None and is_dominant(R.T @ (S @ R))


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
    cells = [(i, i, entry) for i, entry in enumerate(entries)]
    return Matrix.from_entries((len(entries), len(entries)), cells)


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
    """A symmetric P with S dominant, from floating-point solutions of exact residuals."""
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


# Instability of a loop, from forms for its diagonal blocks.

_SCALES = (8, 24, 48, 96)


def separated_instability(
    M: Matrix,
    T: Matrix,
    inverse: Matrix,
    forms: Sequence[QuadraticForm],
    region: StabilityRegion,
) -> InstabilityMethod | None:
    """P, R2 and v for M = T Δ T⁻¹, Δ block upper triangular, from those of the diagonal blocks.

    Parameters
    ----------
    M, T, inverse : Matrix, N × N
    forms : sequence of QuadraticForm
        One for each diagonal block, at least one with a ``v``.
    region : StabilityRegion

    Returns
    -------
    InstabilityMethod or None
        None if no tried scale makes the off-diagonal blocks small enough.

    Notes
    -----
    With P = T⁻ᵀ diag(c_i P_i) T⁻¹ and R2 = T diag(R2_i / √c_i) the diagonal blocks of R2ᵀSR2 are
    those of the parts, and a block above the diagonal has the factor √(c_i/c_j), which is
    2^−k with c_j = 4^k c_i.  O(N³).
    """
    k = next(i for i, form in enumerate(forms) if form.v is not None)
    sizes = [form.P.nrows for form in forms]
    inner = forms[k].v
    if inner is None:
        return None
    before, after = sum(sizes[:k]), sum(sizes[k + 1 :])
    v = T @ vstack([Matrix.zeros(before, 1), inner, Matrix.zeros(after, 1)])
    for scale in _SCALES:
        roots = [Fraction(2) ** (scale * i) for i in range(len(forms))]
        weighted = block_diagonal(
            [form.P * root**2 for form, root in zip(forms, roots, strict=True)]
        )
        P = inverse.T @ (weighted @ inverse)
        R2 = T @ block_diagonal(
            [form.R2 * (1 / root) for form, root in zip(forms, roots, strict=True)]
        )
        if is_dominant(R2.T @ (decrease(M, P, region) @ R2)):
            return InstabilityMethod(P, R2, v)
    return None
