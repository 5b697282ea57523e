"""Where the roots of a polynomial lie, by exact recursions on its coefficients."""

from __future__ import annotations

from fractions import Fraction

from .arithmetic import Polynomial, stripped


def in_stability_region(p: Polynomial, time: str) -> bool:
    """Whether all roots have negative real part (continuous) or modulus below 1 (discrete)."""
    return in_region(p, time, Fraction(int(time == "discrete")))


def in_region(p: Polynomial, time: str, bound: Fraction | None) -> bool:
    """Whether all roots have real part below −bound (continuous) or modulus below it (discrete).

    No bound: no root counts as inside, so that only a constant is.
    """
    if bound is None:
        return len(p) == 1
    if time == "continuous":
        moved: Polynomial = []  # p(x − bound), by Horner's rule
        for c in reversed(p):
            moved = [a - bound * b for a, b in zip([c, *moved], [*moved, 0], strict=True)]
        return is_hurwitz(moved)
    return is_schur([c * bound**k for k, c in enumerate(p)])


def is_hurwitz(p: Polynomial) -> bool:
    """Routh's recursion: p = x^d + a x^(d−1) + … is Hurwitz iff a > 0 and the next polynomial is.

    The next one takes x/a times every second term, from x^(d−1) down, away from p: it has degree
    d − 1, and with the same odd or even part the roots stay on their side of the axis.
    """
    while len(p) > 1:
        if p[-2] <= 0:
            return False
        f = p[-1] / p[-2]
        p = [c - f * p[k - 1] if k and (len(p) - k) % 2 else c for k, c in enumerate(p)][:-1]
    return True


def is_schur(p: Polynomial) -> bool:
    """Schur–Cohn's recursion: p is Schur iff |p_0| < |p_d| and (p_d p − p_0 p*)/x is Schur.

    p* has the coefficients of p in reverse: on the unit circle |p*| = |p|, so Rouché's theorem
    gives p_d p − p_0 p* as many roots inside as p.
    """
    while len(p) > 1:
        if abs(p[0]) >= abs(p[-1]):
            return False
        f = p[0] / p[-1]
        p = stripped([c - f * r for c, r in zip(p, reversed(p), strict=True)][1:])
    return True
