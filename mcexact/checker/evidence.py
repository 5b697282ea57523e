"""Evidence that several kinds share; each rule here is proved sound in ``proofs/evidence.md``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

from .arithmetic import Matrix, Polynomial, beside, coprime, poly_modulo, rank, stack
from .reading import (
    decimal,
    fields,
    integer,
    items,
    matrices,
    matrix,
    names,
    polynomial_matrix,
    positions,
    require,
    shown,
)
from .system import System

Disc = tuple[Fraction, Fraction, Fraction]
"""Real part, imaginary part, radius."""


def inputs(system: System, channels: Iterable[int]) -> Matrix:
    """B_T, the inputs of these channels side by side."""
    return beside([system.B[i] for i in channels], system.n)


def outputs(system: System, channels: Iterable[int]) -> Matrix:
    """C_s, the outputs of these channels one above the other."""
    return stack([system.C[i] for i in channels], system.n)


def complement(system: System, channels: Iterable[int]) -> list[int]:
    """The channels that are not among these."""
    return sorted(set(range(system.m)) - set(channels))


def require_identity(layers: Sequence[Matrix], pivots: list[int], place: str) -> None:
    """Stop unless the rows ``pivots`` of Σ x^k layers[k] are those of the identity matrix.

    The columns are then independent, whatever x is.
    """
    parts = [layer.take(pivots) for layer in layers]
    good = parts[0].equals(Matrix.unit_rows(len(pivots), 0, len(pivots))) and all(
        M.is_zero() for M in parts[1:]
    )
    require(good, "pivots", place, "expected an identity matrix there")


def require_pencil_kernel(
    A: Matrix, B: Matrix, U: list[Matrix], V: list[Matrix], p: Polynomial, place: str
) -> None:
    """Stop unless (xI − A) U = B V modulo p, U and V reduced modulo the monic p of degree ≥ 1."""
    top = U[-1]  # (xI − A)U − BV has degree ≤ deg p, so it must be p·top exactly
    for t, (U_t, V_t) in enumerate(zip(U, V, strict=True)):
        left = A @ U_t + B @ V_t + top.times(p[t])
        shifted = U[t - 1] if t else Matrix.zeros(U_t.nrows, U_t.ncols)
        require(shifted.equals(left), "identity", place, "(xI - A) U differs from B V modulo p")


def shrunk_subspace(
    value: Any, place: str, system: System, p: Polynomial, deficiency: int
) -> list[int]:
    """Check a shrunk subspace of at least this deficiency ≥ 1 for p, and return its T."""
    chosen, U_layers, V_layers, listed = fields(value, place, "channels_T", "U", "V", "pivots")
    T = names(chosen, f"{place}.channels_T", system.names)
    pivots = positions(listed, f"{place}.pivots", system.n)
    u, B_T = len(pivots), inputs(system, T)
    U = polynomial_matrix(U_layers, f"{place}.U", system.n, u, len(p) - 1)
    V = polynomial_matrix(V_layers, f"{place}.V", B_T.ncols, u, len(p) - 1)
    require_identity(U, pivots, f"{place}.pivots")
    require_pencil_kernel(system.A, B_T, U, V, p, place)
    for i in complement(system, T):
        unseen = all((system.C[i] @ layer).is_zero() for layer in U)
        require(unseen, "identity", place, f"C_i U is not zero for channel number {i + 1}")
    lost = u - rank(B_T)
    require(
        lost >= deficiency >= 1, "rank", place, f"proves deficiency {lost}, not {deficiency} >= 1"
    )
    return T


def zero_transfer(value: Any, place: str, system: System) -> tuple[list[int], Matrix]:
    """Check that im X is A-invariant and holds im B_j for the channels j, and return j's and X."""
    chosen, X_rows, listed = fields(value, place, "from", "X", "pivots")
    sources = names(chosen, f"{place}.from", system.names)
    pivots = positions(listed, f"{place}.pivots", system.n)
    X = matrix(X_rows, f"{place}.X", system.n, len(pivots))
    require_identity([X], pivots, f"{place}.pivots")
    for image, what in ((system.A @ X, "A X"), (inputs(system, sources), "B")):
        inside = image.equals(X @ image.take(pivots))
        require(inside, "identity", place, f"the columns of {what} leave the span of X")
    return sources, X


def closed_loop(system: System, gains: Sequence[Matrix]) -> Matrix:
    """A_F = A + Σ B_i F_i C_i."""
    left = beside([B @ F for B, F in zip(system.B, gains, strict=True)], system.n)
    return system.A + left @ outputs(system, range(system.m))


def read_gains(value: Any, place: str, system: System) -> list[Matrix]:
    """One F_i, p_i × q_i, for each channel."""
    shapes = [(B.ncols, C.nrows) for B, C in zip(system.B, system.C, strict=True)]
    return matrices(value, place, shapes)


def modulus(value: Any, place: str) -> int:
    """A modulus ℓ ≥ 2; whether it divides no denominator shows where it is used."""
    ell = integer(value, place, -math.inf)
    require(ell >= 2, "modulus", place, f"expected an integer from 2 on, found {shown(ell)}")
    return ell


def require_coprime(a: Polynomial, b: Polynomial, ell: int, what: str) -> None:
    """Stop unless two monic polynomials are coprime modulo ℓ, and therefore over Q."""
    parts = poly_modulo(a, ell), poly_modulo(b, ell)
    require(coprime(*parts, ell), "common_factor", "witness", f"{what} are not coprime modulo l")


def root_discs(value: Any, place: str, p: Polynomial) -> list[Disc]:
    """Check discs with exactly one root of p each, all roots together."""
    discs: list[Disc] = []
    for k, entry in enumerate(items(value, place, len(p) - 1)):
        where = f"{place}[{k}]"
        parts = fields(entry, where, "re", "im", "radius")
        re, im, radius = (decimal(part, where) for part in parts)
        value_at, slope = horner(p, re, im)
        enough = value_at * (len(p) - 1) ** 2 <= radius**2 * slope
        require(slope > 0 and radius >= 0 and enough, "disc", where, "may hold no root")
        for a, b, r in discs:
            apart = (a - re) ** 2 + (b - im) ** 2 > (r + radius) ** 2
            require(apart, "disc", where, "meets another disc")
        discs.append((re, im, radius))
    return discs


def rate_interval(value: Any, place: str, discs: list[Disc], time: str) -> str:
    """Check an interval for minus the largest real part, or the largest modulus, of the roots."""
    low, high = (decimal(end, place) for end in fields(value, place, "lower", "upper"))
    if time == "continuous":
        lower = all(low <= -(re + radius) for re, _, radius in discs)
        upper = any(high >= -(re - radius) for re, _, radius in discs)
    else:
        lower = any(low <= -r or (low + r) ** 2 <= re**2 + im**2 for re, im, r in discs)
        upper = all(high >= r and (high - r) ** 2 >= re**2 + im**2 for re, im, r in discs)
    require(lower and upper, "rate", place, "not wide enough for the root discs")
    return f"between {value['lower']} and {value['upper']}"


def horner(p: Polynomial, re: Fraction, im: Fraction) -> tuple[Fraction, Fraction]:
    """|p(c)|² and |p'(c)|² at c = re + i·im."""
    value, slope = (Fraction(0), Fraction(0)), (Fraction(0), Fraction(0))
    for c in reversed(p):
        slope = (slope[0] * re - slope[1] * im + value[0], slope[0] * im + slope[1] * re + value[1])
        value = (value[0] * re - value[1] * im + c, value[0] * im + value[1] * re)
    return value[0] ** 2 + value[1] ** 2, slope[0] ** 2 + slope[1] ** 2


def components(m: int, arcs: Iterable[tuple[int, int]]) -> list[list[int]]:
    """The strong components of the graph on m nodes with arcs j → i, sorted by first member."""
    reached = [{j} for j in range(m)]
    for j, i in arcs:
        reached[j].add(i)
    for k in range(m):
        for j in range(m):
            if k in reached[j]:
                reached[j] |= reached[k]
    parts = {tuple(i for i in range(m) if i in reached[j] and j in reached[i]) for j in range(m)}
    return sorted(map(list, parts))
