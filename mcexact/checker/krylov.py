"""How much can be fixed, by one Krylov sequence of one channel; ``proofs/krylov.md``."""

from collections.abc import Callable, Sequence
from itertools import zip_longest

from . import budget, evidence, sparse
from .arithmetic import Matrix, Rows, stripped
from .budget import counted, spend
from .packed_rows import Combination, PackedRows, convolution
from .reading import Json, fields, integer, items, require
from .sparse_step import SparseStep, loop_entries
from .system import System

Row = Sequence[int]

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
    q = system.place_of(name, f"{place}.channel")
    x, y, d = (_residues(entry, place, ell) for entry in lists)
    a, e = (_residues(entry, place, ell) for entry in items(pair, f"{place}.cofactors", 2))
    items(x, f"{place}.inputs", system.B[q].ncols)
    items(y, f"{place}.outputs", system.C[q].nrows)
    require(d[-1:] == [1], "monic", f"{place}.recurrence", "expected a monic polynomial")
    L, n = len(d) - 1, system.n
    b, c = [0] * n, [0] * n
    for i, j, entry in sparse.residues(system.B[q], ell):
        b[i] = (b[i] + entry * x[j]) % ell
    for i, j, entry in sparse.residues(system.C[q], ell):
        c[j] = (c[j] + y[i] * entry) % ell
    s = _numbers(system, F, ell, b, c, d)
    if s[L:]:
        holds = not any(convolution(d, s[::-1], ell)[L : 2 * L - 1])
        require(holds, "recurrence", f"{place}.recurrence", "the sequence does not satisfy it")
    num = convolution(d, s[:L][::-1], ell)[L:]
    sums = zip_longest(convolution(a, num, ell), convolution(e, d, ell), fillvalue=0)
    one = stripped([(f + g) % ell for f, g in sums]) == [1]
    require(one, "common_factor", f"{place}.cofactors", "a num + e d is not 1 modulo l")
    return n - L


def _numbers(
    system: System, gains: Sequence[Matrix], ell: int, b: Row, c: Row, d: Row
) -> list[int]:
    """s_k for k < L, if Σ_k d_k c A_F^k = 0: then the recurrence holds; otherwise for k < 2L − 1.

    Theorem ``krylov_sequence.annihilated_recurrence``.
    """
    L, s, total = len(d) - 1, [], Combination(system.n, ell)
    advance, u, units = _steps(system, gains, ell, b, c)
    spend(L * units)
    for k in counted(range(L)):
        total.add(d[k], u)
        u, number = advance(u)
        s.append(number)
    total.add(1, u)
    if not total.is_zero():
        spend(L * units)
        for _ in counted(range(L - 1)):
            u, number = advance(u)
            s.append(number)
    return s


def _steps(
    system: System, gains: Sequence[Matrix], ell: int, b: Row, c: Row
) -> tuple[Callable[[Row], tuple[Row, int]], Row, int]:
    """A function from u to u A_F and ub modulo ℓ, the u with ub = cb, and units not yet charged."""
    n, entries = system.n, loop_entries(system, gains, ell)
    if entries is None:
        pairs = zip(closed_loop(system, gains, ell), b, strict=True)
        rows = PackedRows([[*row, entry] for row, entry in pairs], n + 1, ell)

        def dense(u: Row) -> tuple[Row, int]:
            *product, last = rows.combined(u)
            return product, last

        return dense, c, 0
    step = SparseStep(entries, n, ell)
    seen = [(k, b[j]) for k, j in enumerate(step.order) if b[j]]

    def gathered(u: Row) -> tuple[Row, int]:
        return step(u), sum(u[k] * f for k, f in seen) % ell

    return gathered, step.start(c), step.units + 2 * len(seen)


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
    moved, B = PackedRows(fed, n, ell), evidence.inputs(system, range(system.m)).modulo(ell)
    spend(budget.products(n * n, budget.limbs([ell]), 1))
    return [
        [(left + right) % ell for left, right in zip(row, moved.combined(u), strict=True)]
        for row, u in zip(system.A.modulo(ell), B, strict=True)
    ]
