"""Exact state feedback u_i = F_i x for a prescribed characteristic polynomial."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from random import Random

from mcexact.analysis.fixed_modes.gains import drawn_integers
from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.answer.rules.refusals import refusal
from mcexact.answer.wording import refusals as say
from mcexact.errors import InternalError, LimitReached
from mcexact.exact.blocks import hstack
from mcexact.exact.invariant_form import companion
from mcexact.exact.linear_algebra import (
    characteristic_polynomial,
    determinant,
    row_echelon,
    solve,
)
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.size import bit_length, largest_entry
from mcexact.model.system import MultiChannelSystem

_CANDIDATES = 24
_DRAWS = 4000
_DRAWS_IF_FOUND = 600


@dataclass(frozen=True)
class StateFeedback:
    """Gains F_i (p_i×n), with the characteristic polynomial of A + Σ B_i F_i.

    Attributes
    ----------
    gains : tuple of Matrix
    polynomial : Polynomial
    """

    gains: tuple[Matrix, ...]
    polynomial: Polynomial


def state_feedback(system: MultiChannelSystem, polynomial: Polynomial) -> StateFeedback:
    """Find F with the given characteristic polynomial of A + Σ B_i F_i.

    Parameters
    ----------
    system : MultiChannelSystem
        Jointly controllable.
    polynomial : Polynomial
        Monic, of degree n.

    Raises
    ------
    Impossible
        If the system is not jointly controllable; the certificate is that of the joint
        controllability.

    Notes
    -----
    Exact.  Heymann: a small F_0 and an input direction g with (A + B F_0, B g) controllable, then
    one row by Ackermann's formula; of several candidates the one with the shortest numbers.
    Continuous and discrete time are the same.  (Paper, beginning of section II-C.)

    Examples
    --------
    >>> from fractions import Fraction
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> found = state_feedback(system, Polynomial((Fraction(2), Fraction(3), Fraction(1))))
    >>> found.gains[0].numerators
    ((-2, -3),)
    """
    controllable = joint_controllability(system)
    if not controllable.controllable:
        raise refusal("unreached", controllable, told=say.NOT_CONTROLLABLE)
    B = system.input_matrix()
    F = assigning_feedback(system.A, B, polynomial)
    return given_feedback(system, split_by_channel(system, F))


def given_feedback(system: MultiChannelSystem, gains: tuple[Matrix, ...]) -> StateFeedback:
    """Return given gains with the characteristic polynomial of A + Σ B_i F_i, which may be any.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : tuple of m Matrix
        F_i, p_i × n.
    """
    return StateFeedback(gains, characteristic_polynomial(loop_matrix(system, gains)))


def loop_matrix(system: MultiChannelSystem, gains: tuple[Matrix, ...]) -> Matrix:
    """A + Σ B_i F_i, n×n, the loop in which every agent measures the whole state.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : tuple of m Matrix
        F_i, p_i × n.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> loop_matrix(system, (Matrix.from_rows([[-2, -3]]),)).numerators
    ((0, 1), (-2, -3))
    """
    result = system.A
    for i, F in enumerate(gains):
        result = result + system.B(i) @ F
    return result


def assigning_feedback(A: Matrix, B: Matrix, polynomial: Polynomial, *, seed: int = 0) -> Matrix:
    """Find F (p×n) with short numbers and the given characteristic polynomial of A + B F.

    Parameters
    ----------
    A : Matrix, n×n
    B : Matrix, n×p
        (A, B) controllable.
    polynomial : Polynomial
        Monic, of degree n.
    seed : int

    Raises
    ------
    LimitReached
        If no suitable direction was drawn, which does not happen for a controllable pair.

    Notes
    -----
    The denominators of F divide det X, X = [b, Mb, …, M^{n−1}b], with M = A + B F_0 and b = B g,
    where A, B, F_0 and g are integral; and F is close to F_0 where M has nearly the prescribed
    spectrum.  So many F_0 and g are drawn: some sparse, the others such that M comes close, as far
    as im B reaches, to a chain of companion blocks (of the prescribed polynomial, or of powers of
    x) in drawn coordinates, for which det X would be ±1.
    """
    n, p = B.shape
    if n == 0:
        return Matrix.zeros(p, 0)
    rng, reach = Random(seed), _left_inverse(B)
    targets = [companions(polynomial), [Matrix.zeros(1, 1)] * n]
    best: tuple[int, Matrix] | None = None
    least, found = Fraction(0), 0
    for draw in range(_DRAWS):
        if found >= _CANDIDATES and draw >= _DRAWS_IF_FOUND:
            break
        direction = _drawn_direction(A, B, reach, targets, rng, draw)
        size = abs(determinant(direction.X))
        if not size:
            continue
        least = size if not found else min(least, size)
        # A larger determinant leads to longer denominators of F, so the draw is dropped.
        if size > 4 * least and found >= _CANDIDATES:
            continue
        found += 1
        F = direction.feedback(polynomial)
        if best is None or _cost(F) < best[0]:
            best = _cost(F), F
    if best is None:
        raise LimitReached("no input direction was found that controls the system by itself")
    return best[1]


def _cost(F: Matrix) -> int:
    """A measure of the length of numbers in a design with F, dominated by denominators."""
    size = ceil(largest_entry([F])).bit_length()
    return 4 * F.denominator.bit_length() + bit_length([F]) + 3 * size


@dataclass(frozen=True)
class _Direction:
    """M = A + B F_0, an input direction g, and X = [b, Mb, …, M^{n−1}b] with b = B g."""

    F0: Matrix
    g: Matrix
    M: Matrix
    X: Matrix

    def feedback(self, polynomial: Polynomial) -> Matrix:
        """F = F_0 + g k with χ_{M + bk} = p: k = −w p(M), w the last row of X⁻¹ (Ackermann)."""
        n = self.M.nrows
        last = solve(self.X.T, Matrix.column([int(k == n - 1) for k in range(n)]))
        if last is None:
            raise InternalError("a direction lost its rank")
        row, result = last.T, Matrix.zeros(1, n)
        for coefficient in polynomial.coefficients:
            result = result + row * coefficient
            row = row @ self.M
        return self.F0 - self.g @ result


def _drawn_direction(
    A: Matrix,
    B: Matrix,
    reach: Matrix,
    targets: Sequence[Sequence[Matrix]],
    rng: Random,
    draw: int,
) -> _Direction:
    """Yield unit directions without feedback first, then sparse draws and targets by turns."""
    n, p = B.shape
    bound = 1 + draw // 1000
    if draw < p:
        F0, g = Matrix.zeros(p, n), Matrix.column([int(k == draw) for k in range(p)])
    elif draw % 3 == 2:
        F0, g = drawn_integers(rng, p, n, bound, 0.25), drawn_integers(rng, p, 1, bound, 0.5)
    else:
        target, first = _drawn_target(rng, targets[draw % 3])
        F0 = _rounded(reach @ (target - A))
        g = (
            _rounded(reach.take(cols=[first]))
            if draw % 4
            else drawn_integers(rng, p, 1, bound, 0.5)
        )
    M = A + B @ F0
    columns = [B @ g]
    for _ in range(n - 1):
        columns.append(M @ columns[-1])
    return _Direction(F0, g, M, hstack(columns))


def _left_inverse(B: Matrix) -> Matrix:
    """L (p×n) with B L the orthogonal projection onto im B; rows of dependent columns are 0."""
    _, independent = row_echelon(B)
    chosen = B.take(cols=independent)
    inner = solve(chosen.T @ chosen, chosen.T)
    if inner is None:
        raise InternalError("independent columns have a singular Gram matrix")
    rows = {j: inner.rows()[k] for k, j in enumerate(independent)}
    zero = (0,) * B.nrows
    return Matrix.from_rows([rows.get(j, zero) for j in range(B.ncols)], ncols=B.nrows)


def _rounded(M: Matrix) -> Matrix:
    """Round to the nearest integers."""
    return Matrix.from_integers([[round(x) for x in row] for row in M.rows()], ncols=M.ncols)


def _drawn_target(rng: Random, blocks: Sequence[Matrix]) -> tuple[Matrix, int]:
    """Chain the blocks in a drawn order of coordinates; return the matrix and the first state."""
    blocks = list(blocks)
    rng.shuffle(blocks)
    n = sum(block.nrows for block in blocks)
    order = list(range(n))
    rng.shuffle(order)
    rows: list[list[Fraction | int]] = [[0] * n for _ in range(n)]
    start = 0
    for block in blocks:
        size = block.nrows
        for i in range(size):
            for k in range(size):
                rows[order[start + i]][order[start + k]] = block[i, k]
        if start:
            rows[order[start]][order[start - 1]] = rng.choice((1, -1))
        start += size
    return Matrix.from_rows(rows, ncols=n), order[0] if n else 0


def companions(polynomial: Polynomial) -> list[Matrix]:
    """Companion matrices of the irreducible factors over Q, each as often as its multiplicity.

    Examples
    --------
    >>> p = Polynomial.of(-1, 1)**2 * Polynomial.of(-2, 0, 1)
    >>> [M.shape for M in companions(p)]
    [(1, 1), (1, 1), (2, 2)]
    """
    found = []
    for factor, times in polynomial.factor():
        found += [companion(factor)] * times
    return found


def split_by_channel(system: MultiChannelSystem, F: Matrix) -> tuple[Matrix, ...]:
    """Split F = [F_1; …; F_m], Σ p_i rows, into the gains F_i of the channels, p_i rows each.

    Examples
    --------
    >>> system = MultiChannelSystem([[0]], [[[1, 1]], [[1]]], [[[1]], [[1]]])
    >>> [F.numerators for F in split_by_channel(system, Matrix.column([4, 5, 6]))]
    [((4,), (5,)), ((6,),)]
    """
    gains, start = [], 0
    for i in range(system.m):
        stop = start + system.p(i)
        gains.append(F.take(rows=range(start, stop)))
        start = stop
    return tuple(gains)
