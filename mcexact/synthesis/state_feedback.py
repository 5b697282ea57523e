"""State feedback u_i = F_i x, exact: a prescribed characteristic polynomial, or a rate."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from random import Random

from mcexact.analysis.controllability import joint_controllability
from mcexact.errors import Impossible, LimitReached
from mcexact.exact.linear_algebra import characteristic_polynomial, solve
from mcexact.exact.matrix import Matrix, hstack
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.channel_controller import height

_CANDIDATES = 24
_DRAWS = 2000


@dataclass(frozen=True)
class StateFeedback:
    """Gains F_i (p_i×n) with the characteristic polynomial of A + Σ B_i F_i.

    Attributes
    ----------
    gains : tuple of Matrix
    polynomial : Polynomial
    height : int
        Bits of the longest numerator or denominator in the gains.
    """

    gains: tuple[Matrix, ...]
    polynomial: Polynomial
    height: int


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
    one row by Ackermann's formula; of several candidates the one of least height.  Continuous and
    discrete time are the same.  (Paper, beginning of section II-C.)

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> found = state_feedback(system, Polynomial((Fraction(2), Fraction(3), Fraction(1))))
    >>> found.gains[0].numerators
    ((-2, -3),)
    """
    controllable = joint_controllability(system)
    if not controllable.controllable:
        raise Impossible(
            "no state feedback can move the modes that are the roots of "
            f"{controllable.uncontrollable_polynomial}: the system is not jointly controllable",
            controllable.certificate,
        )
    B = system.input_matrix()
    F = assigning_feedback(system.A, B, polynomial)
    return given_feedback(system, _split(system, F))


def given_feedback(system: MultiChannelSystem, gains: tuple[Matrix, ...]) -> StateFeedback:
    """Gains from outside, with the characteristic polynomial that they lead to."""
    return StateFeedback(
        gains, characteristic_polynomial(loop_matrix(system, gains)), height(*gains)
    )


def loop_matrix(system: MultiChannelSystem, gains: tuple[Matrix, ...]) -> Matrix:
    """A + Σ B_i F_i, n×n."""
    result = system.A
    for i, F in enumerate(gains):
        result = result + system.B(i) @ F
    return result


def assigning_feedback(A: Matrix, B: Matrix, polynomial: Polynomial, *, seed: int = 0) -> Matrix:
    """One F (p×n) of small height with the given characteristic polynomial of A + B F.

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
        If no suitable direction was found, which for a controllable pair does not happen.
    """
    n, p = B.shape
    if n == 0:
        return Matrix.zeros(p, 0)
    rng = Random(seed)
    ell = next(p for p in primes(seed) if A.denominator % p and B.denominator % p)
    best: Matrix | None = None
    found = 0
    for draw in range(_DRAWS):
        bound = draw // 40 + 1
        F0 = _drawn(rng, p, n, 0 if draw < 2 * p else bound, sparse=draw % 2 == 0)
        g = Matrix.column([int(k == draw % p) for k in range(p)])
        if draw >= p:
            g = _drawn(rng, p, 1, bound)
        M, b = A + B @ F0, B @ g
        if not _controllable_modulo(M, b, ell):
            continue
        F = F0 + g @ _ackermann(M, b, polynomial)
        if best is None or height(F) < height(best):
            best = F
        found += 1
        if found >= _CANDIDATES:
            break
    if best is None:
        raise LimitReached("no input direction was found that controls the system by itself")
    return best


def _split(system: MultiChannelSystem, F: Matrix) -> tuple[Matrix, ...]:
    """The rows of F that belong to each channel."""
    gains, start = [], 0
    for i in range(system.m):
        stop = start + system.p(i)
        gains.append(F.take(rows=range(start, stop)))
        start = stop
    return tuple(gains)


def _drawn(rng: Random, nrows: int, ncols: int, bound: int, sparse: bool = False) -> Matrix:
    """A matrix of integers in −bound … bound; three quarters of them 0 if sparse."""

    def entry() -> int:
        return 0 if sparse and rng.random() < 0.75 else rng.randint(-bound, bound)

    return Matrix.from_integers(
        [[entry() for _ in range(ncols)] for _ in range(nrows)], ncols=ncols
    )


def _controllable_modulo(A: Matrix, b: Matrix, ell: int) -> bool:
    """Whether [b, Ab, …] has rank n modulo a prime; then it has over Q."""
    A_, v = residues(A, ell), residues(b, ell)
    columns = []
    for _ in range(A.nrows):
        columns.append([row[0] for row in v.rows()])
        v = A_ @ v
    return type(v).from_rows(columns, ell, ncols=A.nrows).rank() == A.nrows


def _ackermann(A: Matrix, b: Matrix, polynomial: Polynomial) -> Matrix:
    """The row k with χ_{A + bk} = p: k = −w p(A), w the last row of [b, Ab, …]⁻¹."""
    n = A.nrows
    columns = [b]
    for _ in range(n - 1):
        columns.append(A @ columns[-1])
    last = Matrix.column([int(k == n - 1) for k in range(n)])
    w = solve(hstack(columns).T, last)
    if w is None:
        raise LimitReached("the direction lost controllability over Q")
    row, result = w.T, Matrix.zeros(1, n)
    for coefficient in polynomial.coefficients:
        result = result + row * Fraction(coefficient)
        row = row @ A
    return -result
