"""The sector of a damping ratio ζ, −Re λ > ζ|λ|, as the stability of other roots and matrices."""

from __future__ import annotations

from fractions import Fraction

from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


def turned(p: Polynomial, zeta: Fraction) -> Polynomial:
    """Return a multiple of Π (x − wλ)(x − w̄λ) over the roots λ of p.

    Parameters
    ----------
    p : Polynomial
    zeta : Fraction
        Between 0 and 1.

    Notes
    -----
    w = 1 + i√c, c = ζ²/(1 − ζ²), so that wλ and w̄λ have negative real parts iff λ is in the sector.
    Σ p_k w^(d−k) x^k = U + i√c V, and the result is U² + c V².

    Examples
    --------
    >>> from mcexact.exact.location import is_hurwitz
    >>> p = Polynomial.of(25, 6, 1)  # -3 + 4i, -3 - 4i: the damping ratio 3/5
    >>> [is_hurwitz(turned(p, Fraction(ratio))) for ratio in ("1/2", "3/5", "7/10")]
    [True, False, False]
    """
    c = zeta**2 / (1 - zeta**2)
    real, other = list[Fraction](), list[Fraction]()
    u, v = Fraction(1), Fraction(0)
    for coefficient in reversed(p.coefficients):
        real.append(coefficient * u)
        other.append(coefficient * v)
        u, v = u - c * v, u + v
    U, V = (Polynomial.of(*reversed(part)) for part in (real, other))
    return U * U + V * V * c


def lifted(M: Matrix, zeta: Fraction) -> Matrix:
    """Return a matrix whose eigenvalues are (1 ± i√c) λ, c = ζ²/(1 − ζ²), for those λ of M.

    ::

        [M  −cM]
        [M    M]

    Parameters
    ----------
    M : Matrix, n × n
    zeta : Fraction
        Between 0 and 1.

    Returns
    -------
    Matrix, 2n × 2n

    Examples
    --------
    >>> lifted(Matrix.from_rows([[-2]]), Fraction(3, 5)).rows()
    ((Fraction(-2, 1), Fraction(9, 8)), (Fraction(-2, 1), Fraction(-2, 1)))
    """
    c = zeta**2 / (1 - zeta**2)
    return vstack([hstack([M, M * -c]), hstack([M, M])])
