"""Plants with a parameter, and the kind about them, decided by drawn gains and drawn primes.

What is fixed at a point modulo a drawn prime is the greatest common divisor of det(xI − A_F) for
drawn F, and a value at which more is fixed is a root of the resultants of what it leaves.
"""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flint import (
    Ordering,
    acb,
    fmpq,
    fmpq_mpoly_ctx,
    fmpq_poly,
    fmpz,
    nmod_mat,
    nmod_poly,
)

from . import algebra
from .reading import (
    Unspecified,
    demand,
    listed,
    positions,
    rational,
    record,
    text,
)
from .roots import decided, discs_hold, roots_of
from .systems import require_names
from .words import channels, discs, number, polynomial_text

RING = fmpq_mpoly_ctx.get(("t", "x"), Ordering.lex)
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}", re.ASCII)
QUOTIENT = re.compile(r"\((.*)\)/\((.*)\)", re.DOTALL)
SEED = 20
Function = tuple[fmpq_poly, fmpq_poly]
Rows = list[list[Function]]


@dataclass(frozen=True)
class ParametricPlant:
    """A plant of rational functions of a parameter, each a numerator and a denominator."""

    time: str
    names: tuple[str, ...]
    parameter: str
    range: tuple[Any, Any]
    tables: tuple[tuple[Rows, int, int], ...]
    value: Mapping[str, Any]

    @property
    def n(self) -> int:
        """The number of states."""
        return self.tables[0][1]

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)

    @property
    def denominators(self) -> list[fmpq_poly]:
        """The least common denominators of A, B_1, C_1, …"""
        return [common_denominator(rows) for rows, _, _ in self.tables]


def read_parametric(value: Any) -> ParametricPlant:
    """The user's plant, in canonical form."""
    found = record(value, "time", "parameters", "A", "channels")
    demand(found["time"] in ("continuous", "discrete"), "expected a time domain")
    demand(isinstance(found["parameters"], Mapping), "expected parameters")
    demand(len(found["parameters"]) == 1, "expected one parameter")
    [(t, said)] = found["parameters"].items()
    demand(isinstance(t, str) and NAME.fullmatch(t) is not None and t != "x", "expected a name")
    ends = listed(record(said, optional=("range",)).get("range", [None, None]), 2)
    low, high = (None if end is None else rational(end) for end in ends)
    demand("range" not in said or low is not None or high is not None, "expected an end")
    demand(low is None or high is None or low <= high, "expected a range")
    A = _table(found["A"], t, None, None)
    demand(A[1] == A[2], "expected a square matrix")
    channels = [record(c, "name", "B", "C") for c in listed(found["channels"])]
    names = tuple(text(c["name"]) for c in channels)
    require_names(names)
    tables = [A]
    for c in channels:
        tables += [_table(c["B"], t, A[1], None), _table(c["C"], t, None, A[1])]
    return ParametricPlant(found["time"], names, t, (low, high), tuple(tables), value)


def _table(value: Any, t: str, nrows: int | None, ncols: int | None) -> tuple[Rows, int, int]:
    if isinstance(value, Mapping):
        shape, entries = (record(value, "shape", "entries")[key] for key in ("shape", "entries"))
        demand(entries == [] and shape[:1] == [0] and len(shape) == 2, "expected rows")
        demand(isinstance(shape[1], int) and shape[1] > 0, "expected columns")
        demand(nrows in (None, 0) and ncols in (None, shape[1]), "expected another shape")
        return [], 0, shape[1]
    rows = [[_function(entry, t) for entry in listed(row)] for row in listed(value, nrows)]
    width = len(rows[0]) if rows else 0
    demand(all(len(row) == width for row in rows), "expected rows of one length")
    demand(ncols in (None, width), "expected another number of columns")
    return rows, len(rows), width


def _function(value: Any, t: str) -> tuple[fmpq_poly, fmpq_poly]:
    """A rational, or the canonical text of a function that is not constant."""
    one = fmpq_poly([1])
    demand(not isinstance(value, str) or len(value) <= 100_000, "expected a shorter text")
    if not isinstance(value, str) or re.fullmatch(r"-?[0-9/]+", value):
        return fmpq_poly([rational(value)]), one
    quotient = QUOTIENT.fullmatch(value)
    top = _polynomial(quotient[1] if quotient else value, t)
    bottom = _polynomial(quotient[2], t) if quotient else one
    demand(bottom.degree() > 0 or not quotient, "expected a denominator")
    demand(bottom.leading_coefficient() == 1, "expected a monic denominator")
    demand(top.gcd(bottom).degree() == 0, "expected lowest terms")
    demand(max(top.degree(), bottom.degree()) > 0, "expected a number")
    return top, bottom


def _polynomial(value: str, t: str) -> fmpq_poly:
    """A polynomial as statements write it, and nothing else."""
    result = fmpq_poly([])
    spaced = value.replace(" - ", " + -")
    for term in spaced.split(" + "):
        match = re.fullmatch(rf"(-?)(?:([0-9]+(?:/[0-9]+)?)(?:\*|$))?(?:{t}(?:\^([0-9]+))?)?", term)
        demand(match is not None and term not in ("", "-"), "expected a term")
        sign, size, power = match.groups() if match else ("", "", "")
        degree = int(power) if power else int(term.endswith(t))
        demand(degree <= 1000, "expected a smaller power")
        whole, _, below = (size or "1").partition("/")
        demand(int(below or 1) > 0, "expected a denominator")
        c = fmpq(int(whole), int(below or 1))
        result += fmpq_poly([0] * degree + [-c if sign else c])
    demand(polynomial_text(result, t) == value, "expected the canonical text")
    return result


def common_denominator(rows: Rows) -> fmpq_poly:
    result = fmpq_poly([1])
    for row in rows:
        for _, bottom in row:
            result = result * (bottom // result.gcd(bottom))
    return algebra.monic(result)


# The kind


def spectrum(claim: Any, witness: Any, plant: ParametricPlant) -> bool:
    """What is fixed for every value, and at which values what else."""
    found = record(claim, "generic", "exceptional", "outside")
    if not isinstance(plant, ParametricPlant):
        raise Unspecified("expected a plant with a parameter")
    rng = random.Random(SEED)
    chis = [_chi(plant, _gains(plant, rng, bound)) for bound in (0, 10**4, 10**5, 10**6)]
    generic = [_bivariate(p) for p in listed(found["generic"])]
    common = chis[0]
    for chi in chis[1:]:
        common = common.gcd(chi)
    fixed = _factors(common)
    if {str(p) for p in fixed} != {str(p) for g in generic for p in _factors(g)}:
        return False
    left = []
    for chi in chis:
        for p in fixed:
            while (pair := divmod(chi, p))[1] == 0:
                chi = pair[0]
        left.append(chi)
    values = [
        (monic(entry["value"]), entry)
        for entry in (record(e, "value", "roots", "modes") for e in listed(found["exceptional"]))
    ]
    outside = [
        (monic(entry["value"]), entry)
        for entry in (record(e, "value", "roots") for e in listed(found["outside"]))
    ]
    if not all(is_outside(q, entry["roots"], plant.range) for q, entry in outside):
        return False
    if not all(discs_hold(entry["roots"], q, real=True) for q, entry in values):
        return False
    resultant = left[0].resultant(left[1], "x")
    for other in left[2:]:
        resultant = resultant.gcd(left[0].resultant(other, "x"))
    silent = [*plant.denominators, *(q for q, _ in outside)]
    points = [_univariate(resultant), *(q for q, _ in values)]
    different = {
        str(p): p for f in points if f.degree() > 0 for p, _ in algebra.irreducible_factors(f)
    }
    return all(
        any(f % q == 0 for f in silent) or _right_at(q, chis, generic, values, plant, rng)
        for q in different.values()
    ) and all(_modes(entry) for _, entry in values)


def _modes(entry: Any) -> bool:
    return bool(listed(entry["modes"]))


def _right_at(
    q: fmpq_poly,
    chis: list[Any],
    generic: list[Any],
    values: list[tuple[fmpq_poly, Any]],
    plant: ParametricPlant,
    rng: random.Random,
) -> bool:
    """Whether the claim says at the roots of q what is fixed there, and why."""
    ell, tau = root_modulo(q, rng)
    fixed = _at(chis[0], tau, ell)
    for chi in chis[1:]:
        fixed = fixed.gcd(_at(chi, tau, ell))
    claimed = nmod_poly([1], ell)
    for p in generic:
        claimed *= _at(p, tau, ell)
    known = _radical(claimed, ell)
    for value, entry in values:
        if value % q != 0:
            continue
        for mode in listed(entry["modes"]):
            told = record(mode, "polynomial", "channels")
            p = _at(_bivariate(told["polynomial"], value.degree()), tau, ell)
            s = positions(told["channels"], plant.names)
            lost = all(_rank(plant, s, f, tau, ell) < plant.n for f, _ in p.factor()[1])
            if p.gcd(known).degree() > 0 or not lost:
                return False
            claimed *= p
    return bool(_radical(fixed, ell) == _radical(claimed, ell))


def root_modulo(q: fmpq_poly, rng: random.Random) -> tuple[int, int]:
    """A drawn prime, and a root of q modulo it."""
    while True:
        ell = rng.getrandbits(61) | 1
        if not fmpz(ell).is_prime():
            continue
        roots = nmod_poly([residue_of(c, ell) for c in q.coeffs()], ell).roots()
        if roots:
            return ell, int(rng.choice(roots)[0])


def residue_of(c: fmpq, ell: int) -> int:
    return int(c.p) * pow(int(c.q), -1, ell) % ell


def _at(f: Any, tau: int, ell: int) -> nmod_poly:
    """A polynomial in t and x at t = τ modulo ℓ."""
    found: dict[int, int] = {}
    for (i, k), c in f.to_dict().items():
        found[int(k)] = found.get(int(k), 0) + residue_of(c, ell) * pow(tau, int(i), ell)
    return nmod_poly([found.get(k, 0) % ell for k in range(max(found, default=0) + 1)], ell)


def _radical(p: nmod_poly, ell: int) -> nmod_poly:
    result = nmod_poly([1], ell)
    for f, _ in p.factor()[1]:
        result *= f
    return result


def _rank(plant: ParametricPlant, s: Sequence[int], p: nmod_poly, tau: int, ell: int) -> int:
    """The rank of [xI − A, B; C, 0] at a root of p, with A times its denominator."""
    n, d = plant.n, p.degree()
    A, *ports = (_values(table, tau, ell) for table in plant.tables)
    rows = [[-v for v in row] for row in A]
    for k, B in enumerate(ports[0::2]):
        if k not in s:
            rows = [[*row, *more] for row, more in zip(rows, B, strict=True)]
    width = len(rows[0]) if rows else 0
    rows += [[*row, *[0] * (width - n)] for k in s for row in ports[1::2][k]]
    entries = []
    for i, row in enumerate(rows):
        for a in range(d):
            for j, v in enumerate(row):
                for b in range(d):
                    entry = v if a == b else 0
                    if i == j < n:
                        entry += int(a == b + 1) - (int(p[a]) if b == d - 1 else 0)
                    entries.append(entry % ell)
    return int(nmod_mat(len(rows) * d, width * d, entries, ell).rank()) // d


def _values(table: tuple[Rows, int, int], tau: int, ell: int) -> list[list[int]]:
    """The entries times their common denominator, modulo ℓ."""
    delta = common_denominator(table[0])
    return [
        [residue_at(top * (delta // bottom), tau, ell) for top, bottom in row] for row in table[0]
    ]


def residue_at(p: fmpq_poly, tau: int, ell: int) -> int:
    """A polynomial at τ modulo ℓ."""
    return int(nmod_poly([residue_of(c, ell) for c in p.coeffs()], ell)(tau))


def _gains(plant: ParametricPlant, rng: random.Random, bound: int) -> list[list[list[int]]]:
    return [
        [
            [rng.randint(-bound, bound) for _ in range(plant.tables[2 * i + 2][1])]
            for _ in range(plant.tables[2 * i + 1][2])
        ]
        for i in range(plant.m)
    ]


def _chi(plant: ParametricPlant, gains: list[list[list[int]]]) -> Any:
    """det(xI − A_F) of the matrices times their denominators, without division (Berkowitz)."""
    tables = [_expanded(table) for table in plant.tables]
    M, n = [list(row) for row in tables[0]], plant.n
    for B, F, C in zip(tables[1::2], gains, tables[2::2], strict=True):
        for i in range(n):
            for a, f_row in enumerate(F):
                for b, f in enumerate(f_row):
                    for j in range(n):
                        M[i][j] = M[i][j] + B[i][a] * C[b][j] * f
    vector = [RING.constant(1)]
    for r in range(n):
        column, v = [RING.constant(1), -M[r][r]], [M[i][r] for i in range(r)]
        for _ in range(r):
            column.append(-sum((M[r][i] * v[i] for i in range(r)), RING.constant(0)))
            v = [sum((M[i][j] * v[j] for j in range(r)), RING.constant(0)) for i in range(r)]
        vector = [
            sum(
                (column[i - j] * vector[j] for j in range(min(i, r) + 1) if i - j < len(column)),
                RING.constant(0),
            )
            for i in range(r + 2)
        ]
    x = RING.gens()[1]
    return sum((c * x**k for k, c in enumerate(reversed(vector))), RING.constant(0))


def _expanded(table: tuple[Rows, int, int]) -> list[list[Any]]:
    delta = common_denominator(table[0])
    return [[_in_t(top * (delta // bottom)) for top, bottom in row] for row in table[0]]


def _in_t(p: fmpq_poly) -> Any:
    return RING.from_dict({(i, 0): c for i, c in enumerate(p.coeffs()) if c != 0})


def _bivariate(value: Any, below: int | None = None) -> Any:
    """A polynomial in x and t, monic in x of degree ≥ 1, of a degree in t below some number."""
    parts = [[rational(c) for c in listed(part)] for part in listed(value)]
    demand(below is None or all(len(part) <= below for part in parts), "expected smaller degrees")
    demand(all(not part or part[-1] != 0 for part in parts), "expected no zeros at the end")
    demand(len(parts) > 1 and parts[-1] == [1], "expected a polynomial that is monic in x")
    return RING.from_dict(
        {(i, k): c for k, part in enumerate(parts) for i, c in enumerate(part) if c != 0}
    )


def _factors(f: Any) -> list[Any]:
    """The irreducible factors with x, monic in x."""
    found = []
    for p, _ in f.factor()[1]:
        degree = p.degrees()[1]
        if degree:
            [lead] = [c for (_, k), c in p.to_dict().items() if k == degree]
            found.append(p / lead)
    return found


def _univariate(f: Any) -> fmpq_poly:
    found = {int(i): c for (i, _), c in f.to_dict().items()}
    return fmpq_poly([found.get(i, 0) for i in range(max(found, default=-1) + 1)])


def monic(value: Any) -> fmpq_poly:
    p = fmpq_poly([rational(c) for c in listed(value)])
    demand(len(listed(value)) == p.degree() + 1 > 1, "expected a polynomial of degree at least 1")
    demand(p.leading_coefficient() == 1, "expected a monic polynomial")
    return p


def is_outside(q: fmpq_poly, discs: Any, ends: tuple[Any, Any]) -> bool:
    """Whether the discs hold the roots, and no real root is in the range."""
    low, high = ends

    def question(sign: Any) -> bool:
        for root in roots_of(q):
            if sign(root.imag) == 0:
                above = low is None or sign(root.real - acb(low).real) >= 0
                below = high is None or sign(acb(high).real - root.real) >= 0
                if above and below:
                    return False
        return True

    return discs_hold(discs, q) and decided(question)


# The statement


def parametric_sentence(claim: Any, plant: ParametricPlant) -> str:
    """The sentence of the kind."""
    t = plant.parameter
    delta = polynomial_text(plant.denominators[0], t)
    start = where_text(claim, plant)
    modes = ", ".join(_mode_text(p, t) for p in claim["generic"]) or "1"
    scaled = "" if delta == "1" else f", multiplied by {delta},"
    start += (
        f", the modes that are fixed under linear time-invariant decentralized control{scaled} are "
        f"the roots x of {modes}"
    )
    return "; ".join([start, *(_value_text(e, t) for e in claim["exceptional"]), "no others"])


def where_text(claim: Any, plant: ParametricPlant) -> str:
    """The values that a claim is about."""
    t = plant.parameter
    start = f"for every complex {t} at which all entries are defined"
    if claim["outside"]:
        missing = ("-infinity", "infinity")
        pairs = zip(plant.range, missing, strict=True)
        ends = [name if end is None else number(end) for end, name in pairs]
        where = ", ".join(roots_text(entry, t) for entry in claim["outside"])
        start += f", except at {where}, none of which is real and between {ends[0]} and {ends[1]}"
    return start


def roots_text(entry: Any, t: str) -> str:
    q = polynomial_text(monic(entry["value"]), t)
    return f"the roots of {q}, one in each of the discs {discs(entry['roots'])}"


def _mode_text(value: Any, t: str) -> str:
    parts = []
    for k, coefficients in reversed(list(enumerate(value))):
        c = fmpq_poly([rational(v) for v in coefficients])
        if c == 0:
            continue
        power = ["", "x"][k] if k < 2 else f"x^{k}"
        if c == 1 and power:
            parts.append(power)
        else:
            parts.append(f"({polynomial_text(c, t)})" + (f"*{power}" if power else ""))
    return " + ".join(parts)


def _value_text(entry: Any, t: str) -> str:
    modes = " and ".join(
        f"{_mode_text(mode['polynomial'], t)}, where [xI - A, B; C, 0], C the outputs of "
        f"{channels(mode['channels'])} and B the inputs of the others, loses rank"
        for mode in entry["modes"]
    )
    return (
        f"at {roots_text(entry, t)}, real ones where the disc is centered on the real axis, and "
        f"only there, and there besides those of {modes}"
    )
