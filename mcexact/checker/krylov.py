"""How much can be fixed, by one Krylov sequence of one channel; ``proofs/krylov.md``."""

from collections.abc import Sequence
from itertools import zip_longest
from operator import mul

from . import budget, evidence
from .arithmetic import Matrix, Rows, stripped
from .budget import counted, spend
from .packed_rows import PackedRows, convolution
from .reading import Json, fields, integer, items, require
from .system import System

KEYS = ("modulus", "gains", "channel", "inputs", "outputs", "recurrence", "cofactors")


def unmoved_degree(value: Json, place: str, system: System) -> int:
    """n − L, the most degrees of a common divisor of det(xI − A_F) for all F.

    With b = B_q x, c = y C_q and s_k = c A_F^k b, the monic d of degree L modulo ℓ satisfies
    Σ_j d_j s_{k+j} = 0 for k < L − 1, and a·num + e·d = 1, num the polynomial part of
    d·Σ s_k x^{−k−1}.

    Theorem ``krylov.krylov_bounded``.
    """
    number, gains, name, *lists, pair = fields(value, place, *KEYS)
    ell = evidence.modulus(number, f"{place}.modulus")
    F = evidence.read_gains(gains, f"{place}.gains", system)
    q, n = system.place_of(name, f"{place}.channel"), system.n
    x, y, d = (_residues(entry, place, ell) for entry in lists)
    a, e = (_residues(entry, place, ell) for entry in items(pair, f"{place}.cofactors", 2))
    B, C = system.B[q].modulo(ell), system.C[q].modulo(ell)
    items(x, f"{place}.inputs", system.B[q].ncols)
    items(y, f"{place}.outputs", len(C))
    require(d[-1:] == [1], "monic", f"{place}.recurrence", "expected a monic polynomial")
    L, u = len(d) - 1, PackedRows(C, n, ell).combined(y)
    spend(budget.products(n * len(x), budget.limbs([ell]), budget.limbs([ell])))
    b = [sum(map(mul, row, x)) % ell for row in B]
    pairs = zip(closed_loop(system, F, ell), b, strict=True)
    step, s = PackedRows([[*row, entry] for row, entry in pairs], n + 1, ell), []
    for _ in counted(range(2 * L - 1)):
        *u, last = step.combined(u)
        s.append(last)
    terms = convolution(d, s[::-1], ell)
    holds = not any(terms[L : 2 * L - 1])
    require(holds, "recurrence", f"{place}.recurrence", "the sequence does not satisfy it")
    num = terms[2 * L - 1 :]
    sums = zip_longest(convolution(a, num, ell), convolution(e, d, ell), fillvalue=0)
    one = stripped([(f + g) % ell for f, g in sums]) == [1]
    require(one, "common_factor", f"{place}.cofactors", "a num + e d is not 1 modulo l")
    return n - L


def _residues(value: Json, place: str, ell: int) -> list[int]:
    """A list of integers from 0 on, modulo ℓ."""
    numbers = [integer(entry, place) for entry in items(value, place)]
    spend(budget.reductions(len(numbers), budget.limbs(numbers), budget.limbs([ell])))
    return [number % ell for number in numbers]


def closed_loop(system: System, gains: Sequence[Matrix], ell: int) -> Rows:
    """A + Σ B_i F_i C_i modulo ℓ, which is coprime to every denominator."""
    n, fed = system.n, []
    for F, C in zip(gains, system.C, strict=True):
        outputs = PackedRows(C.modulo(ell), n, ell)
        fed += [outputs.combined(row) for row in F.modulo(ell)]
    moved, inputs = PackedRows(fed, n, ell), evidence.inputs(system, range(system.m)).modulo(ell)
    spend(budget.products(n * n, budget.limbs([ell]), 1))
    return [
        [(left + right) % ell for left, right in zip(row, moved.combined(u), strict=True)]
        for row, u in zip(system.A.modulo(ell), inputs, strict=True)
    ]
