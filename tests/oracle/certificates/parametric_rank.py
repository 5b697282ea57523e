"""The rank of a matrix for all values of a parameter, by its minors."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Mapping
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly, nmod_mat

from . import algebra
from .one_parameter import SEED, ParametricPlant, common_denominator
from .parametric import (
    is_defined,
    is_outside,
    monic,
    residue_at,
    root_modulo,
    roots_text,
    where_text,
)
from .reading import Unspecified, demand, integer, listed, place, positions, record
from .roots import discs_hold
from .words import channels, name, polynomial_text

Rows = list[list[fmpq_poly]]
MOST = 300
"""The most minors of full order that are tried one by one."""


def rank(claim: Any, witness: Any, plant: ParametricPlant) -> bool:
    """The rank, and all values at which it is less."""
    found = record(claim, "matrix", "rank", "exceptional", "outside")
    if not isinstance(plant, ParametricPlant):
        raise Unspecified("expected a plant with a parameter")
    rng = random.Random(SEED)
    M, ncols = _matrix(found["matrix"], plant)
    r = integer(found["rank"], 0)
    values = [
        (monic(e["value"]), integer(e["rank"], 0), e)
        for e in (record(e, "value", "roots", "rank") for e in listed(found["exceptional"]))
    ]
    outside = [
        (monic(e["value"]), e)
        for e in (record(e, "value", "roots") for e in listed(found["outside"]))
    ]
    if not all(is_outside(q, e["roots"], plant.range) for q, e in outside):
        return False
    right = (s < r and discs_hold(e["roots"], q, real=True) for q, s, e in values)
    if not all(right) or not all(is_defined(q, plant) for q, *_ in values):
        return False
    if _rank_at(M, ncols, fmpq(rng.getrandbits(60))) != r:
        return False
    silent = [*plant.poles, *(q for q, _ in outside)]
    common = fmpq_poly([])
    for minor in _minors(M, ncols, r, rng):
        common = common.gcd(minor) if common != 0 else minor
    points = [common, *(q for q, _, _ in values)]
    different = {
        str(p): p for f in points if f.degree() > 0 for p, _ in algebra.irreducible_factors(f)
    }
    for q in different.values():
        if any(f % q == 0 for f in silent):
            continue
        ell, tau = root_modulo(q, rng)
        entries = [residue_at(e, tau, ell) for row in M for e in row]
        there = nmod_mat(len(M), ncols, entries, ell).rank()
        told = {s for value, s, _ in values if value % q == 0}
        if told != ({there} if there < r else set()):
            return False
    return True


def _minors(M: Rows, ncols: int, r: int, rng: random.Random) -> list[fmpq_poly]:
    """All minors of order r, or many sums of them."""
    many = math.comb(len(M), r) * math.comb(ncols, r)
    if many <= MOST:
        return [
            _determinant([[M[i][j] for j in columns] for i in rows])
            for rows in itertools.combinations(range(len(M)), r)
            for columns in itertools.combinations(range(ncols), r)
        ]
    found = []
    for _ in range(4):
        X = [[rng.randint(-99, 99) for _ in M] for _ in range(r)]
        Y = [[rng.randint(-99, 99) for _ in range(r)] for _ in range(ncols)]
        left = [[_sum(c * M[k][j] for k, c in enumerate(x)) for j in range(ncols)] for x in X]
        found.append(
            _determinant(
                [[_sum(row[k] * Y[k][j] for k in range(ncols)) for j in range(r)] for row in left]
            )
        )
    return found


def _determinant(M: Rows) -> fmpq_poly:
    """By values at more integers than its degree, and Lagrange's formula."""
    degree = sum(max([0, *(e.degree() for e in row)]) for row in M)
    points = range(degree + 1)
    total = fmpq_poly([])
    for t in points:
        value = fmpq_mat(len(M), len(M), [e(fmpq(t)) for row in M for e in row]).det()
        basis = fmpq_poly([1])
        for u in points:
            if u != t:
                basis = basis * fmpq_poly([fmpq(-u, t - u), fmpq(1, t - u)])
        total += basis * value
    return total


def _rank_at(M: Rows, ncols: int, t: fmpq) -> int:
    return int(fmpq_mat(len(M), ncols, [e(t) for row in M for e in row]).rank())


def _sum(terms: Any) -> fmpq_poly:
    return sum(terms, fmpq_poly([]))


def _product(left: Rows, right: Rows, ncols: int) -> Rows:
    return [
        [_sum(c * right[k][j] for k, c in enumerate(row)) for j in range(ncols)] for row in left
    ]


def _matrix(value: Any, plant: ParametricPlant) -> tuple[Rows, int]:
    """The matrix made from A', B_i' and C_i', and its number of columns."""
    demand(isinstance(value, Mapping), "expected a matrix")
    (A, _, _), *ports = (
        (
            [[top * (common_denominator(rows) // bottom) for top, bottom in row] for row in rows],
            a,
            b,
        )
        for rows, a, b in plant.tables
    )
    B, C, n = ports[0::2], ports[1::2], plant.n
    delta = plant.denominators[0]
    if value.get("name") == "setpoint":
        record(value, "name")
        shift = delta if plant.time == "discrete" else fmpq_poly([])
        width = sum(b for _, _, b in B)
        rows = [
            [e - shift if i == j else e for j, e in enumerate(row)]
            + [e for M, _, _ in B for e in M[i]]
            for i, row in enumerate(A)
        ]
        rows += [[*row, *[fmpq_poly([])] * width] for M, _, _ in C for row in M]
        return rows, n + width
    if value.get("name") == "signal":
        record(value, "name", "polynomial")
        p = monic(value["polynomial"])
        d, width = p.degree(), sum(b for _, _, b in B)
        zero, unit = fmpq_poly([]), fmpq_poly([1])
        K = [[unit if j == i - 1 else zero for j in range(d)] for i in range(d)]
        for i in range(d):
            K[i][d - 1] = K[i][d - 1] - fmpq_poly([p[i]])
        I = [[unit if i == j else zero for j in range(d)] for i in range(d)]
        states = [
            [a - b for a, b in zip(*pair, strict=True)]
            for pair in zip(_kronecker(I, A), _kronecker(K, _scalar(n, delta)), strict=True)
        ]
        inputs = _kronecker(I, [[e for M, _, _ in B for e in M[i]] for i in range(n)])
        outputs = _kronecker(I, [row for M, _, _ in C for row in M])
        rows = [[*a, *b] for a, b in zip(states, inputs, strict=True)]
        return rows + [[*c, *[zero] * (d * width)] for c in outputs], d * (n + width)
    if value.get("name") == "controllability":
        record(value, "name", "channels", "blocks")
        T, k = positions(value["channels"], plant.names), integer(value["blocks"], 1)
        demand(k <= max(n, 1), "expected fewer blocks")
        width = sum(B[i][2] for i in T)
        power = [[e for i in T for e in B[i][0][row]] for row in range(n)]
        rows = [[] for _ in range(n)]
        for _ in range(k):
            rows = [row + more for row, more in zip(rows, power, strict=True)]
            power = _product(A, power, width)
        return rows, width * k
    demand(value.get("name") == "transfer", "expected a known matrix")
    record(value, "name", "from", "to")
    j, i = place(value["from"], plant.names), place(value["to"], plant.names)
    power, width, rows = B[j][0], B[j][2], []
    for _ in range(n):
        product = _product(C[i][0], power, width)
        rows += [[row[c]] for c in range(width) for row in product]
        power = _product(A, power, width)
    return rows, 1


def _scalar(n: int, value: fmpq_poly) -> Rows:
    return [[value if i == j else fmpq_poly([]) for j in range(n)] for i in range(n)]


def _kronecker(left: Rows, right: Rows) -> Rows:
    return [[a * b for a in row for b in other] for row in left for other in right]


def rank_sentence(claim: Any, plant: ParametricPlant) -> str:
    """The sentence of the kind."""
    matrix = claim["matrix"]
    if matrix["name"] == "setpoint":
        shift = " - I" if plant.time == "discrete" else ""
        named = f"[A{shift}, B; C, 0] with the matrices A, B and C of all channels"
    elif matrix["name"] == "signal":
        p = polynomial_text(matrix["polynomial"], "x")
        named = (
            "[kron(I, A) - kron(K, I), kron(I, B); kron(I, C), 0] with the matrices A, B and C of "
        )
        named += f"all channels, the companion matrix K of {p} and the Kronecker product kron"
    elif matrix["name"] == "controllability":
        inputs = f"the matrix B of the inputs of the channels {channels(matrix['channels'])}"
        named = f"the matrix of the first {matrix['blocks']} of the blocks B, A B, A^2 B, ... with "
        named += f"the matrix A and {inputs}"
    else:
        named = f"the column of all entries of the first {plant.n} of C B, C A B, C A^2 B, ... with"
        named += f" the matrix A, the matrix B of the inputs of channel {name(matrix['from'])} and "
        named += f"the matrix C of the outputs of channel {name(matrix['to'])}"
    said = f"{where_text(claim, plant)}, {named} has rank exactly {claim['rank']}"
    real = "real ones where the disc is centered on the real axis, and only there"
    for entry in claim["exceptional"]:
        roots = roots_text(entry, plant.parameter)
        said += f"; but rank exactly {entry['rank']} at {roots}, {real}"
    return said


JUDGES = {
    "parametric_rank": rank,
}
"""The judge of each kind."""
