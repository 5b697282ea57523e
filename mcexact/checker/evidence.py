"""Rules for evidence of several kinds; ``proofs/evidence.md`` proves each of them."""

import math
from collections.abc import Iterable, Sequence

from .arithmetic import Matrix, Polynomial, beside, coprime, poly_modulo, stack
from .reading import Json, integer, matrices, require, shown
from .system import System


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

    The columns are then independent for every x.
    """
    parts = [layer.take(pivots) for layer in layers]
    first = parts[0].equals(Matrix.unit_rows(len(pivots), 0, len(pivots)))
    good = first and all(M.is_zero() for M in parts[1:])
    require(good, "pivots", place, "expected an identity matrix there")


def closed_loop(system: System, gains: Sequence[Matrix]) -> Matrix:
    """A_F = A + Σ B_i F_i C_i."""
    left = beside([B @ F for B, F in zip(system.B, gains, strict=True)], system.n)
    return system.A + left @ outputs(system, range(system.m))


def read_gains(value: Json, place: str, system: System) -> list[Matrix]:
    """One F_i, p_i × q_i, for each channel."""
    shapes = [(B.ncols, C.nrows) for B, C in zip(system.B, system.C, strict=True)]
    return matrices(value, place, shapes)


def modulus(value: Json, place: str) -> int:
    """A modulus ℓ ≥ 2; the code that uses it stops if it divides a denominator."""
    ell = integer(value, place, -math.inf)
    require(ell >= 2, "modulus", place, f"expected an integer from 2 on, found {shown(ell)}")
    return ell


def require_coprime(a: Polynomial, b: Polynomial, ell: int, what: str) -> None:
    """Stop unless two monic polynomials are coprime modulo ℓ, and therefore over Q.

    Theorems ``arithmetic.coprime_modulo``, ``arithmetic.no_common_root``.
    """
    parts = poly_modulo(a, ell), poly_modulo(b, ell)
    require(coprime(*parts, ell), "common_factor", "witness", f"{what} are not coprime modulo l")
