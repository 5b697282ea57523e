"""The sampled plant: the matrix exponential, to some decimals, with the radii of what is left out.

A plant in continuous time whose inputs are held between samples is at the samples a plant in
discrete time, with the matrices [A_h, B_h] of the exponential of h[A, B; 0, 0].  `enclosure` gives
rational matrices near them, and radii within which they are, for every member of a box.

The terms V_k = (hA)^(k−1) h[A, B] / k! of the series are integers over a power of ten, each rounded
to the nearest one.  F_k bounds, entry by entry, how far V_k is from that of any member: what is
exact and certain has 0.  What follows after the last term is bounded by the last one and by weights
w > 0 with |hA| w ≤ ν w, since entries of hA may differ in size by the units of the states.

`is_held` says whether a controller is that in continuous time which runs at the samples by Tustin's
rule, rounded.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from .core import budget
from .core.arithmetic import Matrix, Rows, absolute, beside
from .core.budget import spend
from .core.system import System

TURNS = 24
"""How often the weights are improved."""
SPARE, FINE = 6, 3
"""The digits of a term, and those of a radius, behind the decimals."""


def enclosure(M: Matrix, D: Matrix, h: Fraction, decimals: int) -> tuple[Matrix, Matrix]:
    """Rational matrices near [A_h, B_h], and radii for all members, M = [A, B] with the radii D.

    The former do not depend on D.

    Theorems ``sampling.term_within``, ``sampling.sampled_within``, ``sampling.sampled_limit``.
    """
    n, ncols = M.nrows, M.ncols
    X = M.times(h)
    w, nu = weights(absolute(X.take(None, range(n))))
    sizes = [row[0] for row in w.rows] or [1]
    ratio = max(sizes) // min(sizes)
    digits = decimals + SPARE + -(-nu // 2) + -(-ratio.bit_length() // 3)
    spend(budget.products(1, digits // 9 + 1, digits // 9 + 1))
    s = 10**digits
    V, F = _first(X, D.times(h), s)
    A, E = V.take(None, range(n)), F.take(None, range(n))
    P = absolute(A) + E
    nu = _largest_ratio(P @ w, w) / s
    total, errors, k = V, F, 1
    while not (F.is_zero() and V.is_zero()) and not (V.is_zero() and k + 1 >= 2 * nu):
        k += 1
        term, bound = A @ V, P @ F + E @ absolute(V)
        V = _divided(term, k * s)
        left = absolute(term - V.times(k * s))
        F = _divided_up(bound + left, k * s)
        total, errors = total + V, errors + F
    errors = errors + _tail(F, P, w, nu / (k + 1 - nu))
    one = 10**decimals
    center = _divided(total, s // one)
    missed = absolute(total - center.times(s // one))
    radii = _divided_up(errors + missed, s // (one * 10**FINE))
    unit = Matrix([[one * int(i == j) for j in range(ncols)] for i in range(n)], ncols)
    rows = (center + unit).rows
    return Matrix(rows, ncols, one), Matrix(radii.rows, ncols, one * 10**FINE)


def weights(M: Matrix) -> tuple[Matrix, Fraction]:
    """Integers w ≥ 1, and the least ν with M w ≤ ν w, for a matrix M ≥ 0; 0 if it has no rows.

    Any w are weights; these make ν small.
    """
    w = Matrix([[1] for _ in range(M.nrows)], 1)
    for _ in range(TURNS):
        grown = _divided_up(M @ w, 1)
        c = max(1, -(-_largest_ratio(grown, w) // 1))
        w = w.times(c) + grown
    return w, _largest_ratio(M @ w, w)


def _largest_ratio(column: Matrix, w: Matrix) -> Fraction:
    """The largest quotient of two entries."""
    spend(budget.fractions(column.nrows, column.limbs + w.limbs))
    pairs = zip(column.rows, w.rows, strict=True)
    ratios = [Fraction(x[0], column.denominator * y[0]) for x, y in pairs]
    return max(ratios, default=Fraction(0))


def _first(X: Matrix, D: Matrix, s: int) -> tuple[Matrix, Matrix]:
    """The first term times s, rounded, and bounds of its errors."""
    V = _divided(X.times(s), 1)
    return V, _divided_up(D.times(s) + absolute(X.times(s) - V), 1)


def _divided(M: Matrix, d: int) -> Matrix:
    """The integers nearest to the entries of M/d, halves up."""
    d *= M.denominator
    _charge(M, d)
    rows = [[(2 * entry + d) // (2 * d) for entry in row] for row in M.rows]
    return Matrix(rows, M.ncols)


def _divided_up(M: Matrix, d: int) -> Matrix:
    """The least integers that are not below the entries of M/d."""
    d *= M.denominator
    _charge(M, d)
    return Matrix([[-(-entry // d) for entry in row] for row in M.rows], M.ncols)


def _charge(M: Matrix, d: int) -> None:
    """Charge a quotient for every entry."""
    a, b = M.limbs, budget.limbs([d])
    spend(budget.table(M.nrows, M.ncols, a) + budget.reductions(M.nrows * M.ncols, a, b))


def _tail(F: Matrix, P: Matrix, w: Matrix, factor: Fraction) -> Matrix:
    """Bounds of all further terms, rounded up; 0 where no path in P leads to an entry of F.

    A column f of F has f ≤ c w for the largest c of all f_i/w_i, and P^j f ≤ c ν^j w.

    Theorem ``sampling.tail_within``.
    """
    reached = _reached(F, P)
    sizes = [row[0] for row in w.rows]
    longest = F.limbs + 2 * w.limbs + budget.limbs_of([factor])
    spend(budget.fractions(2 * F.nrows * F.ncols, longest))
    largest = [
        max(Fraction(row[j], w_i) for row, w_i in zip(F.rows, sizes, strict=True)) * factor
        for j in range(F.ncols if sizes else 0)
    ]
    rows: Rows = [
        [-(-w_i * c // 1) if mask >> j & 1 else 0 for j, c in enumerate(largest)]
        for w_i, mask in zip(sizes, reached, strict=True)
    ]
    return Matrix(rows, F.ncols)


def _reached(F: Matrix, P: Matrix) -> list[int]:
    """The positions of each row, as bits, to which paths in P lead from entries of F other than 0.

    A path goes from l to i where P_il is not 0.
    """
    n = F.nrows
    spend(budget.table(n, F.ncols) + budget.table(n, n))
    masks = [sum(1 << j for j, entry in enumerate(row) if entry) for row in F.rows]
    sources = [[j for j, entry in enumerate(row) if entry] for row in P.rows]
    moved = True
    while moved:
        spend(sum(map(len, sources)) * (4 + F.ncols // 8) + budget.STEP)
        before = list(masks)
        for i, each in enumerate(sources):
            for j in each:
                masks[i] |= masks[j]
        moved = masks != before
    return masks


# Controllers in continuous time, at the samples.

ROUNDED = Fraction(1, 2 * 10**11)
"""The part by which a number changes at most that is rounded to 12 significant digits."""
Program = dict[str, Any]


def is_held(own: Program, held: Program, system: System, h: Fraction) -> bool:
    """Whether one controller is the other at samples, by Tustin's rule to 12 digits.

    With X = (I − (h/2)A)⁻¹ an agent z' = Az + By, u = Cz + Dy becomes

        z(t+1) = X(I + (h/2)A) z + hXB y,   u = CX z + (D + (h/2)CXB) y,

    set-points as outputs.  An agent that shares states is not at samples that of anyone.  Both are
    as `read_controller` returns them, for the agents of the system.
    """
    pairs = zip(own["agents"], held["agents"], strict=True)
    times = own["time"] == "continuous" and held["time"] == "discrete"
    return times and all(
        _is_held(first, second, system, i, h / 2) for i, (first, second) in enumerate(pairs)
    )


def _is_held(own: Program, held: Program, system: System, i: int, half: Fraction) -> bool:
    """The same of agent i; ``half`` is half the step."""
    k, p = own["private"], system.B[i].ncols
    widths = {name: C_j.nrows for name, C_j in zip(system.names, system.C, strict=True)}

    def read(agent: Program, label: str, nrows: int) -> tuple[Matrix, Matrix]:
        """What a map reads of the private state, and of all outputs and the own set-points."""
        used = agent.get(label, {})
        outputs = used.get("outputs", {})
        seen = [outputs.get(j, Matrix.zeros(nrows, width)) for j, width in widths.items()]
        wanted = used.get("reference", Matrix.zeros(nrows, system.C[i].nrows))
        return used.get("private", Matrix.zeros(nrows, k)), beside([*seen, wanted], nrows)

    if any(each["shared"] or "hold" in each for each in (own, held)) or held["private"] != k:
        return False
    (A, B), (C, D) = read(own, "private_update", k), read(own, "input", p)
    identity = Matrix.unit_rows(k, 0, k)
    solved = divided(identity - A.times(half), beside([identity + A.times(half), B], k))
    if solved is None:
        return False
    update, fed = solved.across(range(k)), solved.across(range(k, k + B.ncols)).times(half)
    meant = (update, fed.times(2)), ((C @ (update + identity)).times(Fraction(1, 2)), D + C @ fed)
    found = read(held, "private_update", k), read(held, "input", p)
    pairs = zip([*meant[0], *meant[1]], [*found[0], *found[1]], strict=True)
    return all(_is_rounded(exact, rounded) for exact, rounded in pairs)


def _is_rounded(exact: Matrix, rounded: Matrix) -> bool:
    """Whether every entry is that of another matrix, rounded to 12 significant digits or better."""
    missed, most = absolute(rounded - exact), absolute(exact).times(ROUNDED)
    spend(budget.fractions(exact.nrows * exact.ncols, missed.limbs + most.limbs))
    d, e = missed.denominator, most.denominator
    return all(
        x * e <= y * d
        for first, second in zip(missed.rows, most.rows, strict=True)
        for x, y in zip(first, second, strict=True)
    )


def divided(M: Matrix, R: Matrix) -> Matrix | None:
    """M⁻¹R for a square M, by elimination over Q; None if M is singular."""
    n, width = M.nrows, M.nrows + R.ncols
    budget.spend(1000 + budget.fractions(n * n * width, (n + 1) * (M.limbs + R.limbs)))
    rows = [
        [Fraction(x, M.denominator) for x in first] + [Fraction(x, R.denominator) for x in second]
        for first, second in zip(M.rows, R.rows, strict=True)
    ]
    for k in range(n):
        pivot = next((i for i in range(k, n) if rows[i][k]), None)
        if pivot is None:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(n):
            if i != k and rows[i][k]:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k], strict=True)]
    d = math.lcm(*(x.denominator for row in rows for x in row[n:]))
    return Matrix([[int(x * d) for x in row[n:]] for row in rows], R.ncols, d)
