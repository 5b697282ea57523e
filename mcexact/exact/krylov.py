"""Characteristic polynomials modulo primes so small that sums of products are exact in float64.

A double holds every integer up to 2**53.  With n(ℓ/2)² below that, a product of n × n matrices of
symmetric residues is exact for every order of its additions, and the processor's fastest
routine for floats computes it.  The sequence uMᵏv of 2n terms, in steps of b and of one
(M^b by repeated squaring), and the algorithm of Berlekamp and Massey then give the least
recurrence; its polynomial divides the minimal polynomial of M, so where it has degree n it is the
characteristic polynomial.

At n = 200, 400 and 800 this takes 0.5, 0.27 and 0.1 times as long as flint's characteristic
polynomial, and an array is made of a matrix in a quarter of the time.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import flint

from mcexact.exact.matrix import Matrix
from mcexact.exact.modular_polynomial import ModularPolynomial

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Integers = npt.NDArray[np.int64]

_EXACT = 2**53


def exact_bits(terms: int) -> int:
    """The largest bit length of a modulus for which sums of this many products are exact.

    Notes
    -----
    `_reduced` leaves residues of at most ℓ/2 + 3, and takes off a multiple of ℓ.

    Examples
    --------
    >>> exact_bits(200), exact_bits(800)
    (23, 22)
    """
    bits = 26
    while terms * (2 ** (bits - 1) + 3) ** 2 + 2**bits > _EXACT:
        bits -= 1
    return bits


def loop_polynomials(
    A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix], gains: Sequence[Any], ell: int
) -> tuple[ModularPolynomial, ModularPolynomial]:
    """Compute χ_A and χ_{A + Σ B_i F_i C_i} modulo ℓ.

    Parameters
    ----------
    A : Matrix
        n × n.
    B, C : sequences of Matrix
        n × p_i and q_i × n.
    gains : sequence of p_i × q_i rows of integers
    ell : int
        A prime of at most ``exact_bits`` of the longest sum: n, Σ p_i, or a q_i.  It divides no
        denominator.
    """
    import numpy as np

    n = A.nrows
    open_loop = _residues(A, ell)
    inputs = _stacked([_residues(M, ell) for M in B], (n, 0), axis=1)
    heard = [
        _reduced(_reduced(np.array(F, dtype=np.float64).reshape(M.ncols, N.nrows), ell) @ c, ell)
        for F, M, N, c in zip(gains, B, C, (_residues(N, ell) for N in C), strict=True)
    ]
    added = _reduced(inputs @ _stacked(heard, (0, n), axis=0), ell)
    closed = _reduced(open_loop + added, ell)
    return characteristic_polynomial(open_loop, ell), characteristic_polynomial(closed, ell)


def characteristic_polynomial(M: Floats, ell: int) -> ModularPolynomial:
    """Compute det(xI − M) for an n × n array of symmetric residues modulo a prime ℓ.

    If the sequence has a shorter recurrence, flint computes the polynomial.  This is always so for
    a matrix whose minimal polynomial is not its characteristic polynomial.
    """
    import numpy as np

    n = len(M)
    recurrence = _least_recurrence(_krylov_sequence(M, ell), ell)
    if len(recurrence) == n + 1:
        return ModularPolynomial(ell, flint.nmod_poly(recurrence[::-1].tolist(), ell))
    entries = (M.astype(np.int64) % ell).ravel().tolist()
    return ModularPolynomial(ell, flint.nmod_mat(n, n, entries, ell).charpoly())


def _krylov_sequence(M: Floats, ell: int) -> Integers:
    """The numbers uMᵏv, k < 2n, of drawn u and v: (uM^{bj})(M^i v) for k = bj + i, i < b."""
    import numpy as np

    n = len(M)
    draw = random.Random(ell).randrange
    first, steps = _reduced(np.array([draw(ell) for _ in range(2 * n)], float), ell).reshape(
        2, n, 1
    )
    power = M
    # b near the root of n: at n = 800 five squarings, and 50 products with a vector.
    for _ in range(n.bit_length() // 2):
        steps = np.hstack([steps, _reduced(power @ steps, ell)])
        power = _reduced(power @ power, ell)
    rows = [first[:, 0]]
    while len(rows) * steps.shape[1] < 2 * n:
        rows.append(_reduced(rows[-1] @ power, ell))
    sequence = _reduced(np.array(rows) @ steps, ell).ravel()[: 2 * n]
    return sequence.astype(np.int64) % ell


def _least_recurrence(sequence: Integers, ell: int) -> Integers:
    """The c with c_0 = 1 and c_0 s_k + c_1 s_{k−1} + … + c_L s_{k−L} = 0 for L ≤ k, L least.

    Berlekamp and Massey (Massey, Shift-register synthesis and BCH decoding, 1969).
    """
    import numpy as np

    length = len(sequence)
    backward = sequence[::-1].copy()
    current, earlier = np.zeros((2, length + 1), dtype=np.int64)
    current[0] = earlier[0] = 1
    L, width, shift, divisor = 0, 1, 1, 1
    for k in range(length):
        # ℓ has at most 26 bits, and n(ℓ/2)² is below 2**53: int64 holds the sum.
        recent = backward[length - 1 - k : length + L - k]
        discrepancy = int(current[: L + 1] @ recent) % ell
        if discrepancy:
            before = current[: L + 1].copy() if 2 * L <= k else None
            factor = discrepancy * pow(divisor, -1, ell) % ell
            place = slice(shift, shift + width)
            current[place] = (current[place] - factor * earlier[:width]) % ell
            if before is not None:
                earlier[: L + 1] = before
                L, width, shift, divisor = k + 1 - L, L + 1, 0, discrepancy
        shift += 1
    return current[: L + 1]


def _residues(M: Matrix, ell: int) -> Floats:
    """The symmetric residues of a rational matrix."""
    import numpy as np

    try:
        table = np.array(M.numerators, dtype=np.int64)
    except OverflowError:
        table = np.array([[entry % ell for entry in row] for row in M.numerators], np.int64)
    residues = _reduced((table % ell).reshape(M.shape).astype(np.float64), ell)
    return residues if M.denominator == 1 else _reduced(residues * pow(M.denominator, -1, ell), ell)


def _stacked(tables: Sequence[Floats], empty: tuple[int, int], axis: int) -> Floats:
    """Arrays side by side or one below the other; an empty one of this shape if there is none."""
    import numpy as np

    return np.concatenate([np.zeros(empty), *tables], axis=axis)


def _reduced(table: Floats, ell: int) -> Floats:
    """Integers of at most 2**53 − ℓ in size, each less a multiple of ℓ: at most ℓ/2 + 3 is left.

    The quotient has an error of at most 2 units of 2**−53 relative to |x|/ℓ, so that what is left
    exceeds ℓ/2 by at most 2; the multiple and the difference are integers below 2**53.
    """
    import numpy as np

    quotient = np.rint(table * (1.0 / ell))
    quotient *= ell
    return np.subtract(table, quotient, out=quotient)
