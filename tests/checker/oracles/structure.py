"""Complementary subsystems, splitting spectra and set-points: minors, Hankel matrices, ranks."""

from __future__ import annotations

import itertools
import json
import random
from fractions import Fraction
from typing import Any

from sympy import Matrix as SymbolicMatrix
from sympy import Poly, Rational, Symbol, eye, gcd

from mcexact.analysis.fixed_modes.assignability import assignability
from mcexact.analysis.structure.complementary_subsystem import complementary_subsystem
from mcexact.analysis.structure.setpoint import setpoint_solvability
from mcexact.answer import codec
from mcexact.model.system import MultiChannelSystem
from tests.checker.mutations import Document, Registration
from tests.checker.oracles.spine import drawn_system
from tests.checker.oracles.subjects import coefficients_of, subject_of
from tests.oracle import enumeration
from tests.oracle.draws import exact, sparse_system

X = Symbol("x")


def _written(found: Any) -> Document:
    document: Document = json.loads(codec.encode(found))
    return document


def draw_complementary(seed: int) -> Document | None:
    """A subset of two or three channels."""
    rng = random.Random(seed)
    system = exact(sparse_system(rng, 3, 3))
    if system.m < 2:
        return None
    return _written(complementary_subsystem(system, system.names[: rng.randint(1, system.m - 1)]))


def confirms_complementary(document: Document) -> bool:
    """Greatest common divisors of all minors of every size, by sympy."""
    claim, system = document["claim"], subject_of(document)
    names = list(system.names)
    s = [names.index(name) for name in claim["subset"]]
    outside = [i for i in range(system.m) if i not in s]
    if not s or not outside:
        return False
    divisors = _determinantal_divisors(system, s, outside)
    factors = [Poly(b, X).quo(Poly(a, X)) for a, b in itertools.pairwise([1, *divisors])]
    nontrivial = [_monic(f) for f in factors if f.degree() > 0]
    remnant = _monic(Poly(divisors[system.n - 1], X)) if system.n else (Fraction(1),)
    small = enumeration.plain(system)
    arcs = enumeration.transfer_arcs(small) if small.n else []
    zero = not any((j, i) in arcs for j in outside for i in s)
    return claim == {
        **claim,
        "normal_rank": len(divisors),
        "transfer_zero": zero,
        "complete": not zero and len(remnant) == 1,
    } and (
        [coefficients_of(f) for f in claim["invariant_polynomials"]] == nontrivial
        and coefficients_of(claim["remnant"]) == remnant
    )


def _monic(f: Any) -> tuple[Fraction, ...]:
    return tuple(Fraction(int(c.p), int(c.q)) for c in reversed(f.monic().all_coeffs()))


def _determinantal_divisors(
    system: MultiChannelSystem, s: list[int], outside: list[int]
) -> list[Any]:
    """The gcd of the k×k minors for k = 1, 2, … as long as they are not all 0."""

    def symbolic(M: Any) -> Any:
        entries = [Rational(str(value)) for row in M.rows() for value in row]
        return SymbolicMatrix(M.nrows, M.ncols, entries)

    A, B = symbolic(system.A), symbolic(system.input_matrix(outside))
    C = symbolic(system.output_matrix(s))
    top = SymbolicMatrix.hstack(X * eye(system.n) - A, B)
    lower = SymbolicMatrix.hstack(C, SymbolicMatrix.zeros(C.rows, B.cols))
    P = SymbolicMatrix.vstack(top, lower)
    found: list[Any] = []
    for k in range(1, min(P.rows, P.cols) + 1):
        divisor: Any = 0
        for rows in itertools.combinations(range(P.rows), k):
            for columns in itertools.combinations(range(P.cols), k):
                divisor = gcd(divisor, P[list(rows), list(columns)].det().expand())
        if divisor == 0:
            break
        found.append(Poly(divisor, X).monic().as_expr())
    return found


def draw_assignability(seed: int) -> Document:
    """How the spectrum of a drawn system splits."""
    return _written(assignability(drawn_system(seed)))


def confirms_assignability(document: Document) -> bool:
    """McMillan degrees as ranks of observability times reachability matrices."""
    claim, small = document["claim"], enumeration.plain(subject_of(document))
    names = [channel["name"] for channel in document["system"]["channels"]]
    arcs = enumeration.transfer_arcs(small) if small.n else []
    blocks = []
    for component in enumeration.strong_components(small.m, arcs):
        reach: enumeration.Rows = [[] for _ in range(small.n)]
        block = [[v for t in component for v in small.B[t][i]] for i in range(small.n)]
        seen = [list(row) for t in component for row in small.C[t]]
        rows = list(seen)
        for _ in range(small.n):
            reach = [a + b for a, b in zip(reach, block, strict=True)]
            block = enumeration.product(small.A, block) if block and block[0] else block
            seen = enumeration.product(seen, small.A) if seen else seen
            rows += seen
        hankel = enumeration.product(rows, reach) if rows and reach and reach[0] else []
        dimension = enumeration.rank(hankel)
        blocks.append({"channels": [names[i] for i in component], "dimension": dimension})
    fixed = small.n - sum(block["dimension"] for block in blocks)
    return bool(claim == {"blocks": blocks, "fixed_degree": fixed})


def draw_setpoint(seed: int) -> Document:
    """Set-points of a drawn system."""
    rng = random.Random(seed)
    system = exact(sparse_system(rng, 3, 2), rng.choice(["continuous", "discrete"]))
    return _written(setpoint_solvability(system))


def confirms_setpoint(document: Document) -> bool:
    """The rank at 0 (or 1), and the largest rank at more points than it can drop at."""
    claim, system = document["claim"], subject_of(document)
    small = enumeration.plain(system)
    n, place = small.n, Fraction(int(system.time == "discrete"))
    B = [[value for inputs in small.B for value in inputs[i]] for i in range(n)]
    C = [row for rows in small.C for row in rows]

    def rank(x: Fraction) -> int:
        top = [
            [(x if i == j else 0) - a for j, a in enumerate(row)] + B[i]
            for i, row in enumerate(small.A)
        ]
        width = len(top[0]) if top else 0
        zeros = [Fraction(0)] * (width - n)
        return enumeration.rank(top + [list(row) + zeros for row in C])

    full, r = n + len(C), rank(place)
    if claim["rank"] != r or claim["solvable"] is not (r == full):
        return False
    if r == full:
        return claim["invariant_zero"] is None
    normal = max(rank(Fraction(k, 7)) for k in range(20, 20 + 2 * n + 2))
    return claim["invariant_zero"] is (normal == full)


KINDS = {
    "assignability": Registration(draw_assignability, confirms_assignability),
    "complementary_subsystem": Registration(draw_complementary, confirms_complementary),
    "setpoint": Registration(draw_setpoint, confirms_setpoint),
}
