"""The construction `sampled` once more, from "Sampling" in FORMAT.md alone, entry by entry."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import fmpq, fmpq_mat

from .reading import demand, integer, rational
from .systems import System

Rows = list[list[fmpq]]
MOST = 1000


def sampled(system: System, given: Mapping[str, Any]) -> System:
    """The values of A_h and B_h, and registers for the inputs of `late` steps."""
    demand(system.time == "continuous", "expected a plant in continuous time")
    h, late, k = rational(given["step"]), integer(given["late"], 0), integer(given["decimals"], 0)
    demand(h > 0, "expected a step above 0")
    demand(k <= MOST, "expected at most 1000 decimals")
    n = system.n
    M = [[*row] for row in system.A.tolist()]
    for B in system.B:
        M = [[*row, *more] for row, more in zip(M, B.tolist(), strict=True)]
    p = [B.ncols() for B in system.B]
    held, _ = enclosed(M, [[fmpq(0)] * (n + sum(p)) for _ in M], h, k)
    # the registers, as equations of signals: x, then v_1, …, then u
    size = n + late * sum(p)
    after = [[*row, *[fmpq(0)] * (size - n)] for row in held]
    for j in range(late * sum(p)):
        row = [fmpq(0)] * (size + sum(p))
        row[n + sum(p) + j] = fmpq(1)
        after.append(row)
    A = fmpq_mat(size, size, [x for row in after for x in row[:size]])
    inputs, start = [], size
    for width in p:
        entries = [x for row in after for x in row[start : start + width]]
        inputs.append(fmpq_mat(size, width, entries))
        start += width
    outputs = [
        fmpq_mat(
            C.nrows(), size, [x for row in C.tolist() for x in [*row, *[fmpq(0)] * (size - n)]]
        )
        for C in system.C
    ]
    return replace(system, time="discrete", A=A, B=tuple(inputs), C=tuple(outputs))


def sharpened(steps: Sequence[Any]) -> list[Any]:
    """The same constructions, with so many decimals of what is sampled that rounding is nothing."""

    def sharp(step: Any) -> Any:
        if not isinstance(step, Mapping) or step.get("construction") != "sampled":
            return step
        return {**step, "decimals": min(step["decimals"] + 40, MOST)}

    return [sharp(step) for step in steps]


def enclosed(M: Rows, D: Rows, h: fmpq, k: int) -> tuple[Rows, Rows]:
    """The values and the radii of [A_h, B_h], n rows."""
    n, width = len(M), len(M[0]) if M else 0
    every = [(i, c) for i in range(n) for c in range(width)]
    w, nu = [1] * n, fmpq(0)
    for _ in range(24):
        g = [ceil_of(x) for x in grown(M, h, w)]
        c = max([1, *(ceil_of(fmpq(x, y)) for x, y in zip(g, w, strict=True))])
        w = [c * x + y for x, y in zip(w, g, strict=True)]
    nu = max([fmpq(0), *(x / y for x, y in zip(grown(M, h, w), w, strict=True))])
    b = (max(w, default=1) // min(w, default=1)).bit_length()
    s = 10 ** (k + 6 + ceil_of(nu / 2) + ceil_of(fmpq(b, 3)))
    V = {(i, c): near(s * h * M[i][c]) for i, c in every}
    F = {(i, c): ceil_of(s * h * D[i][c] + abs(s * h * M[i][c] - V[i, c])) for i, c in every}
    X = {(i, l): V[i, l] for i in range(n) for l in range(n)}
    E = {(i, l): F[i, l] for i in range(n) for l in range(n)}
    P = {place: abs(X[place]) + E[place] for place in X}
    reach = [sum(P[i, l] * w[l] for l in range(n)) for i in range(n)]
    of_P = max([fmpq(0), *(fmpq(x, s * y) for x, y in zip(reach, w, strict=True))])
    total, errors, K = dict(V), dict(F), 1
    while any(V.values()) or (any(F.values()) and K + 1 < 2 * of_P):
        K += 1
        term = {(i, c): sum(X[i, l] * V[l, c] for l in range(n)) for i, c in every}
        bound = {
            (i, c): sum(P[i, l] * F[l, c] + E[i, l] * abs(V[l, c]) for l in range(n))
            for i, c in every
        }
        V = {place: near(fmpq(term[place], K * s)) for place in every}
        left = {place: abs(term[place] - K * s * V[place]) for place in every}
        F = {place: ceil_of(fmpq(bound[place] + left[place], K * s)) for place in every}
        total = {place: total[place] + V[place] for place in every}
        errors = {place: errors[place] + F[place] for place in every}
    values, radii = [[fmpq(0)] * width for _ in M], [[fmpq(0)] * width for _ in M]
    for i, c in every:
        if any(F[l, c] for l in sources(P, i, n)):
            largest = max(fmpq(F[l, c], w[l]) for l in range(n))
            errors[i, c] += ceil_of(w[i] * of_P / (K + 1 - of_P) * largest)
        exact = fmpq(10**k, s) * total[i, c]
        Q = near(exact)
        missed = fmpq(10**k, s) * errors[i, c] + abs(exact - Q)
        values[i][c] = fmpq(Q, 10**k) + (i == c)
        radii[i][c] = fmpq(ceil_of(1000 * missed), 10 ** (k + 3))
    return values, radii


def grown(M: Rows, h: fmpq, w: list[int]) -> list[fmpq]:
    """h|A|w."""
    return [sum((h * abs(x) * y for x, y in zip(row, w, strict=False)), fmpq(0)) for row in M]


def sources(P: Mapping[tuple[int, int], int], i: int, n: int) -> set[int]:
    """The places from which a path in P leads to i, and i itself."""
    found, left = {i}, [i]
    while left:
        a = left.pop()
        more = {l for l in range(n) if P[a, l]} - found
        found |= more
        left += more
    return found


def near(x: Any) -> int:
    """The nearest integer, halves up."""
    return int(fmpq(x + fmpq(1, 2)).floor())


def ceil_of(x: Any) -> int:
    """The least integer that is not below a number."""
    return int(fmpq(x).ceil())
