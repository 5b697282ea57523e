"""Lyapunov equations to any precision, by Smith's doubling in fixed-point integers."""

from __future__ import annotations

from fractions import Fraction

from mcexact.exact.matrix import Matrix, matrix_from_float, matrix_to_float
from mcexact.exact.roots import StabilityRegion

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
    The result is a proposal for D far from normal, with 320 bits after the point.  P =
    Σ (Nᵀ)ʲ Q Nʲ by squaring N: N = D/r and Q = I/r², or by Cayley's transformation with W = (pI − D
    − bI)⁻¹, N = (pI + D + bI) W and Q = 2p WᵀW.  Each step is a few products of k × k matrices.

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
