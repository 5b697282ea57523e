"""Forgeries of blocks and of one sequence: one condition stands against a degree too high."""

from __future__ import annotations

import math
import random
from typing import Any

from flint import fmpq_mat, nmod_mat, nmod_poly

from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.systems import System
from tests.oracle.drawn.plants import Document

from .writing import PRIME, drawn, drawn_gains, zeros

Forged = Document | None
Vector = list[int]


def _residue(rng: random.Random, value: Any, ell: int) -> int:
    """A rational modulo ℓ; any residue where its denominator is no unit."""
    p, q = int(value.p), int(value.q)
    return p * pow(q, -1, ell) % ell if math.gcd(q, ell) == 1 else rng.randrange(ell)


def _table(rng: random.Random, M: Any, ell: int) -> list[Vector]:
    return [[_residue(rng, value, ell) for value in row] for row in M.tolist()]


class Numbers:
    """Gains, a channel, x and y that are drawn, and s_k = y C_q A_F^k B_q x modulo ℓ."""

    def __init__(self, rng: random.Random, system: System, ell: int) -> None:
        self.ell, n, q = ell, system.n, rng.randrange(system.m)
        self.rng, self.n = rng, n
        gains = drawn_gains(rng, system)
        if rng.random() < 0.5:
            gains = [zeros(B.ncols(), C.nrows()) for B, C in zip(system.B, system.C, strict=True)]
        A = _table(rng, system.A, ell)
        for B, F, C in zip(system.B, gains, system.C, strict=True):
            b, c = _table(rng, B, ell), _table(rng, C, ell)
            for i in range(n):
                for k in range(n):
                    A[i][k] += sum(
                        b[i][g] * value * c[h][k]
                        for g, row in enumerate(F["entries"])
                        for h, value in enumerate(row)
                    )
        b, c = _table(rng, system.B[q], ell), _table(rng, system.C[q], ell)
        x = [rng.randrange(ell) for _ in range(system.B[q].ncols())]
        y = [rng.randrange(ell) for _ in range(system.C[q].nrows())]
        column = [sum(f * v for f, v in zip(row, x, strict=True)) for row in b]
        u = [sum(f * row[k] for f, row in zip(y, c, strict=True)) for k in range(n)]
        self.s = []
        for _ in range(2 * n + 2):
            self.s.append(sum(f * v for f, v in zip(u, column, strict=True)) % ell)
            u = [sum(u[i] * A[i][k] for i in range(n)) % ell for k in range(n)]
        self.start: dict[str, Any] = {
            "modulus": ell,
            "gains": gains,
            "channel": system.names[q],
            "inputs": x,
            "outputs": y,
        }

    def with_recurrence(self, d: Vector, cofactors: list[Vector] | None = None) -> Document:
        """The sequence with d, and with the cofactors that Euclid's algorithm finds."""
        if cofactors is None:
            L = len(d) - 1
            num = [sum(d[j] * self.s[j - i - 1] for j in range(i + 1, L + 1)) for i in range(L)]
            try:
                f, g = nmod_poly(num, self.ell), nmod_poly(d, self.ell)
                _, a, e = f.xgcd(g)
                cofactors = [[int(c) for c in a.coeffs()], [int(c) for c in e.coeffs()]]
            except (ZeroDivisionError, ValueError, ArithmeticError):
                cofactors = [[1], []]
        return {**self.start, "recurrence": d, "cofactors": cofactors}

    def satisfying(self, L: int, equations: int) -> Vector | None:
        """A monic d of degree L with Σ_j d_j s_{k+j} = 0 for so many k, modulo a prime."""
        s, ell, size = self.s, self.ell, max(equations, 0)
        rows = [[s[k + j] for j in range(L)] + [-s[k + L]] for k in range(size)]
        table = nmod_mat(size, L + 1, [v for row in rows for v in row], ell)
        reduced, rank = table.rref()
        d = [self.rng.randrange(ell) for _ in range(L)] + [1]
        leading = []
        for i in range(rank):
            leading.append(next(j for j in range(L + 1) if int(reduced[i, j])))
        if L in leading:
            return None
        for i, j in enumerate(leading):
            others = (k for k in range(L) if k not in leading)
            total = int(reduced[i, L]) - sum(int(reduced[i, k]) * d[k] for k in others)
            d[j] = total % ell
        return d


def sequence(rng: random.Random, system: System) -> Document | None:
    """The claim that one channel moves all n modes, as far as it can be made to look so."""
    n, what = system.n, rng.randrange(6)
    if not system.m:
        return None
    if what == 0:  # not monic: (1 + 2 x^L)² = 1 modulo 4
        numbers = Numbers(rng, system, 4)
        numbers.start["inputs"] = [0 for _ in numbers.start["inputs"]]
        d = [1] + [0] * (n - 1) + [2] if n else [1]
        return numbers.with_recurrence(d, [[], d])
    if what == 1:  # zero divisors, or denominators that are none modulo ℓ
        numbers = Numbers(rng, system, rng.choice((4, 6, 6, 9, 12)))
        d = [rng.randrange(numbers.ell) for _ in range(n)] + [1]
        return numbers.with_recurrence(d, [[rng.choice((1, 5, numbers.ell - 1))], []])
    numbers = Numbers(rng, system, rng.choice((2, 3, 5, 7, 101)))
    left_out = rng.choice((1, 1, 1, n))
    if what == 2:  # all but the last equations
        d = numbers.satisfying(n, n - 1 - left_out)
    elif what == 3:  # d times another polynomial: not coprime to its numerator
        d = numbers.satisfying(n, n + 1)
    elif what == 4:  # a degree that is short of n
        L = rng.randrange(n + 1)
        d = numbers.satisfying(L, 2 * n + 1 - L)
    else:
        d = numbers.satisfying(n, n - 1)
    return None if d is None else numbers.with_recurrence(d)


def blocks(rng: random.Random, system: System) -> list[Document] | None:
    """The states in parts, with what would prove that no mode of any part is fixed."""
    states, what = list(range(system.n)), rng.randrange(8)
    if what < 4:
        parts = [states] if states or rng.random() < 0.5 else []
    else:  # in an order that may be the wrong one
        count = rng.randint(2, 3)
        at = [rng.randrange(count) for _ in states]
        parts = [[a for a in states if at[a] == k] for k in range(count)]
    if what == 5 and any(parts):  # a state left out, or in two blocks
        chosen = rng.choice([part for part in parts if part])
        chosen.pop(rng.randrange(len(chosen)))
    elif what == 6 and states:
        rng.choice(parts).append(rng.choice(states))
    parts = [part for part in parts if part or rng.random() < 0.1]
    made = []
    for part in parts:
        acting = [i for i in range(system.m) if _acts(system, i, part)]
        block = _restricted(system, sorted(part), acting)
        proof = sequence(rng, block)
        if proof is None or rng.random() < 0.2:
            proof = {"modulus": PRIME, "gains": drawn_gains(rng, block)}
        made.append({"states": sorted(part), "evidence": proof if rng.random() < 0.9 else None})
    return made


def _acts(system: System, i: int, part: list[int]) -> bool:
    """Whether a channel has inputs and outputs of these states."""
    moved = any(v != 0 for a in part for v in system.B[i].tolist()[a])
    return moved and any(row[a] != 0 for a in part for row in system.C[i].tolist())


def _restricted(system: System, part: list[int], acting: list[int]) -> System:
    """Some states and channels by themselves."""
    return System(
        system.time,
        picked(system.A, part, part),
        tuple(system.names[i] for i in acting),
        tuple(picked(system.B[i], part, None) for i in acting),
        tuple(picked(system.C[i], None, part) for i in acting),
    )


def picked(M: Any, rows: list[int] | None, cols: list[int] | None) -> fmpq_mat:
    """Some rows and columns of a matrix; None for all."""
    rows = list(range(M.nrows())) if rows is None else rows
    cols = list(range(M.ncols())) if cols is None else cols
    return fmpq_mat(len(rows), len(cols), [M[i, j] for i in rows for j in cols])


def nothing_fixed(rng: random.Random, document: Document) -> Forged:
    """Fixed modes denied by blocks."""
    made = blocks(rng, subject_of(document))
    if made is None:
        return None
    document["claim"] = {"polynomial": [1], "factors": [], "stabilizable": True, "best_rate": None}
    document["witness"] = {"blocks": made, "modulus": None, "subspaces": []}
    return document


def coupled(rng: random.Random, document: Document) -> Forged:
    """Two double integrators whose positions have a constant sum, decided as if they were apart."""
    a = rng.choice((1, -1, 2, 3))
    rows = [[0, a, 0, -a], [0, 0, 0, 0], [0, -a, 0, a], [0, 0, 0, 0]]
    channels, parts = [], []
    for k in (0, 2):
        column = [[int(i == k + 1)] for i in range(4)]
        channels.append({"name": str(k), "B": column, "C": [[int(i == k) for i in range(4)]]})
        proof = {"modulus": PRIME, "gains": [drawn(rng, 1, 1)]}
        parts.append({"states": [k, k + 1], "evidence": proof})
    document["system"] = {"time": document["system"]["time"], "A": rows, "channels": channels}
    document["subject"] = []
    document["claim"] = {"polynomial": [1], "factors": [], "stabilizable": True, "best_rate": None}
    document["witness"] = {"blocks": parts, "modulus": None, "subspaces": []}
    return document


def other_blocks(rng: random.Random, document: Document) -> Forged:
    """The same factors, said to be all by other blocks."""
    made = blocks(rng, subject_of(document))
    if made is None:
        return None
    spaces = document["witness"]["subspaces"]
    ell = rng.choice((2, 7, 101)) if spaces else None
    document["witness"] = {"blocks": made, "modulus": ell, "subspaces": spaces}
    return document


def multiplicities(rng: random.Random, document: Document) -> Forged:
    """A multiplicity that is not the rank that is lost."""
    claim = document["claim"]
    if "blocks" not in document["witness"] or not claim["factors"]:
        return None
    factor = rng.choice(claim["factors"])
    if rng.random() < 0.5:
        factor["multiplicity_in_A"] = None
    factor["multiplicity_at_most"] = max(factor["multiplicity_at_most"] + rng.choice((-1, 1)), 1)
    return document


SPECTRUM = (nothing_fixed, nothing_fixed, coupled, other_blocks, multiplicities)
