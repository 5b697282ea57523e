"""Gains that make single channels reach everything, and gains that are exceptional."""

from __future__ import annotations

import itertools
import json
import random
from fractions import Fraction
from typing import Any

import mpmath
from sympy import Matrix as SymbolicMatrix
from sympy import Poly, Rational, Symbol, gcd_list

from mcexact.analysis.fixed_modes.single_channel_gains import single_channel_gains
from mcexact.analysis.structure.exceptional_gains import exceptional_gains
from mcexact.answer import codec
from mcexact.errors import Impossible
from tests.checker.mutations import Document, Registration
from tests.checker.oracles.spine import SLACK, _number, _roots, drawn_system
from tests.checker.oracles.subjects import coefficients_of, matrix_of, subject_of
from tests.oracle import enumeration

G = Symbol("g")


def draw_single(seed: int) -> Document | None:
    """One channel or all, one property or both, of a drawn system."""
    rng = random.Random(seed)
    system = drawn_system(seed)
    q = rng.choice([None, system.names[0]])
    want = rng.choice(["both", "controllable", "observable"])
    found = single_channel_gains(system, q, want=want, cyclic=want == "both" and seed % 3 == 0)
    document: Document = json.loads(codec.encode(found))
    return document if document["kind"] == "single_channel_gains" else None


def _index(A: enumeration.Rows, B: enumeration.Rows) -> int | None:
    """The controllability index, or None."""
    n = len(A)
    rows: enumeration.Rows = [[] for _ in range(n)]
    block = B
    for k in range(n + 1):
        if enumeration.rank(rows) == n:
            return k
        rows = [a + b for a, b in zip(rows, block, strict=True)]
        block = enumeration.product(A, block) if block and block[0] else block
    return n if enumeration.rank(rows) == n else None


def _indices(
    small: enumeration.PlainSystem, A: enumeration.Rows, q: int, sides: list[str]
) -> list[int | None]:
    turned = enumeration.PlainSystem(A, small.B, small.C).dual
    pairs = {"controllable": (A, small.B[q]), "observable": (turned.A, turned.B[q])}
    return [_index(*pairs[side]) for side in sides]


def confirms_single(document: Document) -> bool:
    """The indices of the gains given; or three large drawn gains that all fail."""
    claim, small = document["claim"], enumeration.plain(subject_of(document))
    names = [channel["name"] for channel in document["system"]["channels"]]
    Q = [names.index(name) for name in claim["channels"]]
    both = ["controllable", "observable"]
    sides = both if claim["property"] == "both" else [claim["property"]]
    if not claim["exists"]:
        rng = random.Random(1)
        for _ in range(3):
            A_F = enumeration.drawn_closed_loop(small, rng)
            if all(None not in _indices(small, A_F, q, sides) for q in Q):
                return False
        return claim["indices"] is None and not claim["cyclic"]
    A_F = [list(row) for row in small.A]
    for i, gain in enumerate(document["witness"]["gains"]):
        F = [list(row) for row in matrix_of(gain, len(small.C[i])).rows()]
        if small.n and small.B[i][0] and small.C[i]:
            loop = enumeration.product(enumeration.product(small.B[i], F), small.C[i])
            A_F = [
                [a + b for a, b in zip(r, s, strict=True)] for r, s in zip(A_F, loop, strict=True)
            ]
    found = [_indices(small, A_F, q, sides) for q in Q]
    return found == claim["indices"] and (not claim["cyclic"] or _is_cyclic(A_F))


def _is_cyclic(A: enumeration.Rows) -> bool:
    """Whether I, A, …, A^{n−1} are independent."""
    n = len(A)
    power = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    rows = []
    for _ in range(n):
        rows.append([value for row in power for value in row])
        power = enumeration.product(power, A)
    return enumeration.rank(rows) == n


def draw_exceptional(seed: int) -> Document | None:
    """Lemma 3 for a pair of two or three states."""
    rng = random.Random(seed)
    n = rng.randint(1, 3)
    A, M = ([[rng.randint(-1, 1) for _ in range(n)] for _ in range(n)] for _ in "AM")
    B = [[rng.choice([0, 1])] for _ in range(n)]
    try:
        found = exceptional_gains(M, A, B)
    except Impossible:
        return None
    chosen = found.index_set if seed % 2 else found.controllability_set
    document: Document = json.loads(codec.encode(chosen))
    return document


def confirms_exceptional(document: Document) -> bool:
    """The greatest common divisor of all n×n minors, by sympy; roots to fifty digits."""
    claim, system = document["claim"], subject_of(document)
    A, M = (
        SymbolicMatrix(system.n, system.n, [Rational(str(v)) for row in X.rows() for v in row])
        for X in (system.A, matrix_of(claim["M"], system.n))
    )
    B = system.input_matrix()
    block = SymbolicMatrix(B.nrows, B.ncols, [Rational(str(v)) for row in B.rows() for v in row])
    blocks = [block]
    for _ in range(claim["blocks"] - 1):
        blocks.append((M + G * A) * blocks[-1])
    K = SymbolicMatrix.hstack(*blocks)
    minors = [
        K[:, list(columns)].det() for columns in itertools.combinations(range(K.cols), system.n)
    ]
    divisor: Any = Poly(gcd_list([minor.expand() for minor in minors] or [0]), G)
    if divisor.is_zero:
        return False
    _, factors = divisor.factor_list()
    product = Poly(1, G)
    for factor, _ in factors:
        product *= factor.monic()
    expected = tuple(Fraction(int(c.p), int(c.q)) for c in reversed(product.all_coeffs()))
    p = coefficients_of(claim["polynomial"])
    return p == expected and _discs_fit(claim["roots"], _roots(p) if len(p) > 1 else [])


def _discs_fit(discs: list[Document], roots: list[Any]) -> bool:
    """One root in each disc; a disc is centered on the real axis iff its root is real."""
    with mpmath.workdps(60):
        inside = []
        for disc in discs:
            center = mpmath.mpc(_number(disc["re"]), _number(disc["im"]))
            radius = _number(disc["radius"]) + SLACK
            held = [k for k, root in enumerate(roots) if abs(root - center) <= radius]
            inside.append(held)
            if any((abs(roots[k].imag) < SLACK) != (center.imag == 0) for k in held):
                return False
    return sorted(inside) == [[k] for k in range(len(roots))]


KINDS = {
    "exceptional_gains": Registration(draw_exceptional, confirms_exceptional),
    "single_channel_gains": Registration(draw_single, confirms_single),
}
