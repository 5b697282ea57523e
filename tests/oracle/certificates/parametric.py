"""What is fixed at all values of a parameter, decided by drawn gains and drawn primes.

What is fixed at a point modulo a drawn prime is the greatest common divisor of det(xI − A_F) for
drawn F, and a value at which more is fixed is a root of the resultants of what it leaves.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

from flint import fmpq, fmpq_poly, fmpz, nmod_mat, nmod_poly

from . import algebra
from .one_parameter import (
    RING,
    SEED,
    ParametricPlant,
    Rows,
    common_denominator,
    common_roots,
    drawn_polynomials,
    factors_in_x,
    meets,
    split,
)
from .reading import Unspecified, demand, listed, positions, rational, record
from .roots import discs_hold
from .words import channels, discs, number, polynomial_text


def spectrum(claim: Any, witness: Any, plant: ParametricPlant) -> bool:
    """What is fixed for every value, and at which values what else."""
    found = record(claim, "generic", "exceptional", "outside")
    if not isinstance(plant, ParametricPlant):
        raise Unspecified("expected a plant with a parameter")
    rng = random.Random(SEED)
    chis = drawn_polynomials(plant, rng)
    generic = [_bivariate(p) for p in listed(found["generic"])]
    fixed, quotients = split(chis)
    if {str(p) for p in fixed} != {str(p) for g in generic for p in factors_in_x(g)}:
        return False
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
    if not all(
        discs_hold(entry["roots"], q, real=True) and is_defined(q, plant) for q, entry in values
    ):
        return False
    silent = [*plant.poles, *(q for q, _ in outside)]
    points = [common_roots(quotients), *(q for q, _ in values)]
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


def _bivariate(value: Any, below: int | None = None) -> Any:
    """A polynomial in x and t, monic in x of degree ≥ 1, of a degree in t below some number."""
    parts = [[rational(c) for c in listed(part)] for part in listed(value)]
    demand(below is None or all(len(part) <= below for part in parts), "expected smaller degrees")
    demand(all(not part or part[-1] != 0 for part in parts), "expected no zeros at the end")
    demand(len(parts) > 1 and parts[-1] == [1], "expected a polynomial that is monic in x")
    return RING.from_dict(
        {(i, k): c for k, part in enumerate(parts) for i, c in enumerate(part) if c != 0}
    )


def monic(value: Any) -> fmpq_poly:
    p = fmpq_poly([rational(c) for c in listed(value)])
    demand(len(listed(value)) == p.degree() + 1 > 1, "expected a polynomial of degree at least 1")
    demand(p.leading_coefficient() == 1, "expected a monic polynomial")
    return p


def is_outside(q: fmpq_poly, discs: Any, ends: tuple[Any, Any]) -> bool:
    """Whether the discs hold the roots, and no real root is in the range."""
    return discs_hold(discs, q) and not meets(q, ends)


def is_defined(q: fmpq_poly, plant: ParametricPlant) -> bool:
    """Whether all entries of the plant are defined at the roots of a polynomial."""
    return all(q.gcd(pole).degree() == 0 for pole in plant.poles)


# The statement


def parametric_sentence(claim: Any, plant: ParametricPlant) -> str:
    """The sentence of the kind."""
    t = plant.parameter
    delta = polynomial_text(plant.denominators[0], t)
    start = where_text(claim, plant)
    scaled = "" if delta == "1" else f", multiplied by {delta},"
    never = "fixed under linear time-invariant decentralized control"
    fixed = f"the modes that are {never}{scaled} are the roots x of "
    if claim["generic"]:
        said = f"{start}, {fixed}{', '.join(_mode_text(p, t) for p in claim['generic'])}"
        before, leading, end = "", "and there also those of ", ["no others"]
    else:
        said, before, leading, end = f"{start}, no mode is {never}", "but ", fixed, []
    told = [before + _value_text(entry, t, leading) for entry in claim["exceptional"]]
    return "; ".join([said, *told, *end])


def where_text(claim: Any, plant: ParametricPlant) -> str:
    """The values that a claim is about."""
    t = plant.parameter
    start = f"for every complex value of the parameter {t} at which all entries of the plant are "
    start += "defined"
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


def _value_text(entry: Any, t: str, leading: str) -> str:
    modes = " and ".join(
        f"{_mode_text(mode['polynomial'], t)}, where [xI - A, B; C, 0] with the matrix A, the "
        f"matrix C of the outputs of {channels(mode['channels'])} and the matrix B of the inputs "
        "of the others loses rank"
        for mode in entry["modes"]
    )
    return (
        f"at {roots_text(entry, t)}, real ones where the disc is centered on the real axis, and "
        f"only there, {leading}{modes}"
    )


JUDGES = {
    "parametric_fixed_spectrum": spectrum,
}
"""The judge of each kind."""
