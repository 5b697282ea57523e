"""Brasch–Pearson controllers of low order, which assign the whole spectrum through one channel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random

from mcexact.analysis.fixed_modes.gains import reach_index
from mcexact.errors import InputError, InternalError, LimitReached
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.linear_algebra import characteristic_polynomial, solve
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.size import bit_length, largest_entry

_ROWS_TRIED = 200


@dataclass(frozen=True)
class ChannelController:
    """A controller of one channel: ż = A z + B y, u = C z + D y.

    Attributes
    ----------
    A : Matrix, k×k
        The companion matrix of the controller's own polynomial p_c, or its transpose.
    B : Matrix, k×q
    C : Matrix, p×k
    D : Matrix, p×q
    polynomial : Polynomial or None
        The prescribed closed-loop polynomial, of degree n + k; None if the controller was designed
        for a rate or a radius.
    """

    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix
    polynomial: Polynomial | None

    @property
    def order(self) -> int:
        """k, the dimension of z."""
        return self.A.nrows

    @property
    def matrices(self) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """A, B, C, D."""
        return self.A, self.B, self.C, self.D

    @property
    def bit_length(self) -> int:
        """The number of bits of the longest numerator or denominator."""
        return bit_length(self.matrices)

    @property
    def largest(self) -> Fraction:
        """The largest absolute value of an entry."""
        return largest_entry(self.matrices)


def channel_controller(
    A: Matrix,
    B: Matrix,
    C: Matrix,
    polynomial: Polynomial,
    *,
    index: int,
    row: Sequence[int] | None = None,
    seed: int = 0,
) -> ChannelController:
    """Assign the spectrum of the loop around a controllable, observable and cyclic (A, B, C).

    Parameters
    ----------
    A : Matrix, n×n
        Its minimal polynomial has degree n (A is cyclic).
    B : Matrix, n×p
        (A, B) controllable.
    C : Matrix, q×n
        (C, A) observable.
    polynomial : Polynomial
        Monic, of degree n + index − 1: the prescribed closed-loop polynomial.
    index : int
        ν, at least the controllability index of (A, B), and at least 1.  The controller gets order
        ν − 1.  For the observability index, design for (A', C', B') and call `transposed`.
    row : sequence of int, optional
        h, 1×q, with (hC, A) observable; drawn if not given.
    seed : int
        The seed for the draws of h.

    Returns
    -------
    ChannelController

    Raises
    ------
    LimitReached
        If no h was found: A is not cyclic, or (C, A) is not observable.
    InputError
        If the degree of the polynomial is not n + index − 1.

    Notes
    -----
    Exact.  With d = χ_A and N(s) = h C adj(sI − A) B, u = (n_c / p_c) h y has the closed-loop
    polynomial d p_c − N n_c.  The monic p_c of degree ν−1 and the column n_c of degree ≤ ν−1 are a
    solution of a linear system with ν−1+pν unknowns and n+ν−1 equations, which is onto; unknowns
    beyond a set of pivot columns modulo a prime are 0.  O((n+ν)³) operations on integers whose
    length grows with n + ν.  (Brasch and Pearson 1970; paper, sections II-B and II-D.)

    Examples
    --------
    A double integrator, position measured; ν = 2, so the controller has order 1:

    >>> A, B = Matrix.from_rows([[0, 1], [0, 0]]), Matrix.from_rows([[0], [1]])
    >>> C = Matrix.from_rows([[1, 0]])
    >>> wanted = Polynomial((Fraction(1), Fraction(3), Fraction(3), Fraction(1)))
    >>> controller = channel_controller(A, B, C, wanted, index=2)  # s² (s + 3) + 3 (s + 3) − 8
    >>> controller.A.numerators, controller.B.numerators  # u = (8 / (s + 3) − 3) y
    (((-3,),), ((1,),))
    >>> controller.C.numerators, controller.D.numerators
    (((8,),), ((-3,),))
    """
    n, order = A.nrows, index - 1
    if polynomial.degree != n + order or polynomial.leading != 1:
        raise InputError(
            f"expected a monic polynomial of degree {n + order}, found degree {polynomial.degree}"
        )
    if row is None:
        row = next(observing_rows(A, C, Random(seed)), None)
        if row is None:
            raise LimitReached(
                f"no row h with (hC, A) observable among {_ROWS_TRIED} drawn ones: "
                "the pair is not observable, or A is not cyclic"
            )
    h = Matrix.from_rows([list(row)], ncols=C.nrows)
    d = characteristic_polynomial(A)
    numerators = _numerators(A, B, h @ C, d)
    own, n_c = _assigned(d, numerators, polynomial, order)
    return _realized(own, n_c, h, polynomial)


def assigning_controllers(
    A: Matrix, B: Matrix, C: Matrix, polynomial: Polynomial, *, index: int, side: str, rng: Random
) -> Iterator[ChannelController]:
    """Yield the controllers of `channel_controller` for drawn rows h.

    Parameters
    ----------
    A, B, C, polynomial, index
        As there.
    side : {"controllable", "observable"}
        The property to which the index belongs; for "observable" the transposed loop is designed.
    rng : Random
    """
    if side == "observable":
        turned = assigning_controllers(
            A.T, C.T, B.T, polynomial, index=index, side="controllable", rng=rng
        )
        yield from map(transposed, turned)
        return
    for h in observing_rows(A, C, rng):
        yield channel_controller(A, B, C, polynomial, index=index, row=h)


def transposed(controller: ChannelController) -> ChannelController:
    """Transpose a controller for (A', C', B') into a controller for (A, B, C).

    The two loops are transposes of each other, so they have the same characteristic polynomial.
    """
    return ChannelController(
        controller.A.T, controller.C.T, controller.B.T, controller.D.T, controller.polynomial
    )


def observing_rows(A: Matrix, C: Matrix, rng: Random) -> Iterator[tuple[int, ...]]:
    """Small integer rows h with (hC, A) observable, proved by a rank modulo a prime.

    Rows with one entry come first, then drawn ones of growing range; at most `_ROWS_TRIED` in all.
    """
    n, q = A.nrows, C.nrows
    ell = next(p for p in primes(rng.getrandbits(64)) if A.denominator % p and C.denominator % p)
    for trial in range(_ROWS_TRIED):
        if trial < q:
            h = tuple(int(k == trial) for k in range(q))
        else:
            bound = 1 + trial // (2 * q + 8)
            h = tuple(rng.randint(-bound, bound) for _ in range(q))
        row = residues(Matrix.from_rows([h], ncols=q), ell) @ residues(C, ell)
        if reach_index(residues(A, ell).T, row.T, n) is not None:
            yield h


def _numerators(A: Matrix, B: Matrix, c: Matrix, d: Polynomial) -> Matrix:
    """The polynomials of c adj(sI − A) B: for each column of B a row of n coefficients.

    adj(sI − A) = Σ_k s^k Σ_{l>k} d_l A^{l−k−1}.
    """
    n = A.nrows
    markov, vector = [], c
    for _ in range(n):
        markov.append((vector @ B).rows()[0])
        vector = vector @ A
    weights = Matrix.from_rows(
        [[d.coefficients[k + 1 + i] if k + 1 + i <= n else 0 for i in range(n)] for k in range(n)],
        ncols=n,
    )
    return (weights @ Matrix.from_rows(markov, ncols=B.ncols)).T


def _assigned(
    d: Polynomial, numerators: Matrix, wanted: Polynomial, order: int
) -> tuple[Matrix, Matrix]:
    """Solve d p_c − Σ_j N_j n_j = wanted, deg p_c = k.

    Returns
    -------
    own : Matrix, 1×k
        p_c without its leading coefficient.
    n_c : Matrix, p×(k+1)
        All n_j.
    """
    n = d.degree
    size = n + order
    shifts = [[Fraction(0)] * k + list(d.coefficients) for k in range(order)]
    for row in (-numerators).rows():
        negative = list(row)
        shifts += [[Fraction(0)] * k + negative for k in range(order + 1)]
    padded = [shift + [Fraction(0)] * (size - len(shift)) for shift in shifts]
    leading = [Fraction(0)] * order + list(d.coefficients)
    rest = [wanted.coefficients[k] - leading[k] for k in range(size)]
    S = Matrix.from_rows(padded, ncols=size).T
    pivots = _pivot_columns(S)
    solution = solve(S.take(cols=pivots), Matrix.column(rest))
    if solution is None:
        raise InternalError("the equations of the channel controller have no solution")
    values = [0] * len(shifts)
    for pivot, (numerator,) in zip(pivots, solution.numerators, strict=True):
        values[pivot] = numerator
    starts = range(order, len(values), order + 1)
    table = [values[start : start + order + 1] for start in starts]
    return (
        Matrix.from_integers([values[:order]], solution.denominator),
        Matrix.from_integers(table, solution.denominator, ncols=order + 1),
    )


def _pivot_columns(S: Matrix) -> list[int]:
    """Columns that form a square nonsingular matrix, found modulo primes; all if S is square."""
    if S.nrows == S.ncols:
        return list(range(S.ncols))
    for trial, ell in enumerate(primes(S.ncols)):
        if S.denominator % ell == 0:
            continue
        _, pivots = residues(S, ell).rref()
        if len(pivots) == S.nrows:
            return list(pivots)
        if trial > 3:
            break
    raise InputError(
        "the spectrum cannot be assigned at this order: the index given is below the "
        "controllability index, or the pair is not controllable"
    )


def _realized(own: Matrix, n_c: Matrix, h: Matrix, polynomial: Polynomial) -> ChannelController:
    """u = (n_c / p_c) h y in controllable canonical form, with n_c of degree ≤ deg p_c = k:

    A = [0 1; ⋱ ; −p_0 … −p_{k−1}],  B = e_k h,  C = [n_c − D_0 p_c],  D = D_0 h.
    """
    k = own.ncols
    direct = n_c.take(cols=[k])
    C = n_c.take(cols=range(k)) - direct @ own
    if k == 0:
        A, input_row = Matrix.zeros(0, 0), Matrix.zeros(0, 1)
    else:
        upper = hstack([Matrix.zeros(k - 1, 1), Matrix.identity(k - 1)])
        A = vstack([upper, -own])
        input_row = Matrix.column([0] * (k - 1) + [1])
    return ChannelController(A, input_row @ h, C, direct @ h, polynomial)
