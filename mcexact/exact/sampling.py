"""The matrices of a plant with held inputs at the samples: rational numbers, and radii around them.

`held_exponential` takes M = [A, B] with radii of its entries and a step h, and encloses the first
rows [A_h, B_h] of exp(h[A, B; 0, 0]) for every member.  The certificate format prescribes every
number here (FORMAT.md, "Sampling"), since the checker calculates the same ones: integers over a
power of ten, rounded where the format says so.

The series is summed term by term, V_k = (hA)^(k−1) hM / k!, and a bound F_k of the error of each
entry follows beside it: what is exact and certain stays exact.  Scaling and squaring would take
fewer products, and multiply errors of entries that are 0; and the terms of a step that is short
enough for control are few.  Rates of very different size, with a step for the slowest, take about
2ν terms, ν the spectral radius of h|A|.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache

from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix, from_cells

_TURNS = 24
_SPARE, _FINE = 6, 3
MOST_TERMS = 5000
"""Of a step that is so long that more are needed the terms are too many digits long, too."""


def held_exponential(M: Matrix, D: Matrix, step: Fraction, decimals: int) -> tuple[Matrix, Matrix]:
    """Enclose [A_h, B_h] for all matrices within radii of M = [A, B].

    Parameters
    ----------
    M : Matrix, n × (n + p)
        [A, B].
    D : Matrix, n × (n + p)
        The radii of its entries, at least 0.
    step : Fraction
        h > 0.
    decimals : int
        The number of decimals of the result.

    Returns
    -------
    center : Matrix, n × (n + p)
        Of the given number of decimals; it does not depend on D.
    radii : Matrix, n × (n + p)
        Of three more decimals: [A_h, B_h] of every member is within these of the center.

    Raises
    ------
    LimitReached
        If the step is so long that more than 5,000 terms are needed.

    Examples
    --------
    A double integrator is exact:

    >>> M, zero = Matrix.from_rows([[0, 1, 0], [0, 0, 1]]), Matrix.zeros(2, 3)
    >>> center, radii = held_exponential(M, zero, Fraction(1, 10), 12)
    >>> center.rows()[0], radii.is_zero()
    ((Fraction(1, 1), Fraction(1, 10), Fraction(1, 200)), True)
    >>> M, zero = Matrix.from_rows([[-1]]), Matrix.zeros(1, 1)
    >>> center, radii = held_exponential(M, zero, Fraction(1), 3)
    >>> center[0, 0], radii[0, 0]  # exp(-1) = 0.367879…
    (Fraction(46, 125), Fraction(121, 1000000))
    """
    return _held(M, D, step, decimals)


@lru_cache(maxsize=8)
def _held(M: Matrix, D: Matrix, step: Fraction, decimals: int) -> tuple[Matrix, Matrix]:
    """As `held_exponential`; searches in boxes sample the same plant again and again."""
    n, m = M.shape
    first = range(n)
    w, nu = _weights(_moduli(M.take(cols=first) * step))
    if nu > MOST_TERMS // 2:
        raise LimitReached(
            f"the step is long for the fastest rates of the plant: about {int(2 * nu)} terms of "
            f"the exponential are needed, and at most {MOST_TERMS} are taken"
        )
    ratio = max(w, default=1) // min(w, default=1)
    digits = decimals + _SPARE + -(-nu // 2) + -(-ratio.bit_length() // 3)
    s = 10**digits
    V = _nearest(M * (step * s))
    F = _above(D * (step * s) + _moduli(M * (step * s) - V))
    A, E = V.take(cols=first), F.take(cols=first)
    P = _moduli(A) + E
    nu = _largest_ratio(P, w) / s
    total, errors, k = V, F, 1
    while not V.is_zero() or not (F.is_zero() or k + 1 >= 2 * nu):
        k += 1
        term, bound = A @ V, P @ F + E @ _moduli(V)
        V = _nearest(term * Fraction(1, k * s))
        F = _above((bound + _moduli(term - V * (k * s))) * Fraction(1, k * s))
        total, errors = total + V, errors + F
    errors = errors + _tail(F, P, w, nu / (k + 1 - nu))
    unit = Fraction(10**decimals, s)
    center = _nearest(total * unit)
    missed = errors * unit + _moduli(total * unit - center)
    radii = _above(missed * 10**_FINE) * Fraction(1, 10 ** (decimals + _FINE))
    ones = Matrix.from_entries((n, m), ((i, i, 1) for i in range(n)))
    return center * Fraction(1, 10**decimals) + ones, radii


def _weights(M: Matrix) -> tuple[list[int], Fraction]:
    """Integers w ≥ 1 with a small ν such that M w ≤ ν w, for M ≥ 0, and ν."""
    w = [1] * M.nrows
    for _ in range(_TURNS):
        grown = [-(-x // 1) for x in _times(M, w)]
        largest = max((Fraction(x, y) for x, y in zip(grown, w, strict=True)), default=Fraction(0))
        c = max(1, -(-largest // 1))
        w = [c * x + y for x, y in zip(w, grown, strict=True)]
    return w, _largest_ratio(M, w)


def _times(M: Matrix, w: list[int]) -> list[Fraction]:
    """M w."""
    column = M @ Matrix.from_integers([[x] for x in w], 1, 1)
    return [row[0] for row in column.rows()]


def _largest_ratio(M: Matrix, w: list[int]) -> Fraction:
    """The least ν with M w ≤ ν w."""
    return max((x / y for x, y in zip(_times(M, w), w, strict=True)), default=Fraction(0))


def _entrywise(M: Matrix, of: Callable[[int, int], int]) -> Matrix:
    """The integers that a function gives for the numerators and the denominator."""
    d, (r, c) = M.denominator, M.shape
    cells, values = [], []
    for i, j, x in M.nonzero():
        cells.append(i * c + j)
        values.append(of(x, d))
    return from_cells((r, c), cells, values, 1)


def _nearest(M: Matrix) -> Matrix:
    """The nearest integers, halves up."""
    return _entrywise(M, lambda x, d: (2 * x + d) // (2 * d))


def _above(M: Matrix) -> Matrix:
    """The least integers that are not below the entries."""
    return _entrywise(M, lambda x, d: -(-x // d))


def _moduli(M: Matrix) -> Matrix:
    """The moduli of all entries."""
    c, d = M.ncols, M.denominator
    entries = list(M.nonzero())
    return from_cells(M.shape, [i * c + j for i, j, _ in entries], [abs(x) for *_, x in entries], d)


def _tail(F: Matrix, P: Matrix, w: list[int], factor: Fraction) -> Matrix:
    """Bounds of all terms after the last one, whose own are F; 0 where no path leads from these.

    A column f of F is at most c w for the largest c of all f_i/w_i, and P^j f at most c ν^j w.
    """
    largest: dict[int, Fraction] = {}
    for i, j, x in F.nonzero():
        largest[j] = max(largest.get(j, Fraction(0)), Fraction(x, w[i]))
    entries = [
        (i, j, -(-w[i] * largest[j] * factor // 1))
        for i, columns in enumerate(_reached(F, P))
        for j in sorted(columns)
    ]
    return Matrix.from_entries(F.shape, entries)


def _reached(F: Matrix, P: Matrix) -> list[set[int]]:
    """The columns of each row to which paths in P lead from entries of F that are not 0."""
    columns: list[set[int]] = [set() for _ in range(F.nrows)]
    followers: list[list[int]] = [[] for _ in range(F.nrows)]
    for i, j, _ in F.nonzero():
        columns[i].add(j)
    for i, l, _ in P.nonzero():
        followers[l].append(i)
    left = [l for l, known in enumerate(columns) if known]
    while left:
        l = left.pop()
        for i in followers[l]:
            if not columns[l] <= columns[i]:
                columns[i] |= columns[l]
                left.append(i)
    return columns
