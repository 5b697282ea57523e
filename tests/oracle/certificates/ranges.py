"""The kinds about ranges of parameters: where there is one parameter, every value is decided.

A mode λ is fixed at t where det(λI − A_F) vanishes for every F: where the polynomials for drawn F
have a root in common.  With several parameters each is ranged in turn, and the others have values.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial, reduce
from itertools import repeat
from typing import Any

from flint import acb, acb_poly, fmpq, fmpq_poly

from . import algebra, boxes
from .constructions import built
from .loops import bound_of
from .one_parameter import (
    RING,
    SEED,
    ParametricPlant,
    characteristic,
    common_roots,
    drawn_polynomials,
    in_lowest_terms,
    in_t,
    interpolated,
    line_through,
    meets,
    real_roots_within,
    split,
    univariate,
)
from .reading import listed, positions, record
from .rearranged import rearranged
from .roots import decided, inside
from .several_parameters import SeveralParameters, read_several
from .systems import System

InX = list[fmpq_poly]
"""A polynomial in x by its coefficients, which are polynomials in t, constant term first."""


def lines(document: Mapping[str, Any]) -> Iterator[ParametricPlant]:
    """The subjects with one parameter each, the others having values."""
    plant, steps = read_several(document["system"]), listed(document["subject"])
    for k, others in plant.lines():
        yield rearranged(line_through(plant, k, others), steps, built)


def fixed_in_ranges(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """At no values is a mode fixed outside of the region."""
    at_points = boxes.fixed_in_ranges(claim, document, system)
    return at_points and all(none_fixed(line, claim["bound"]) for line in lines(document))


def controllable_in_ranges(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """At no values do the channels leave an uncontrollable mode outside of the region.

    What they do not control is what no gains from the state to their inputs move.
    """
    if not boxes.controllable_in_ranges(claim, document, system):
        return False
    T = positions(record(claim, "channels", "bound")["channels"], system.names)
    return all(none_fixed(driven(line, T), claim["bound"]) for line in lines(document))


def stable_in_ranges(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """At no values has the loop an eigenvalue outside of the region, with some gains as well."""
    if not boxes.stable_in_ranges(claim, document, system):
        return False
    plant, steps, radii = read_several(document["system"]), document["subject"], claim["gain_radii"]
    bound = bound_of(claim["bound"], system.time)
    for k, others in plant.lines():
        line = line_through(plant, k, others)
        if any(meets(delta, line.range) for delta in line.denominators):
            return False
        for share in (0,) if radii is None else (0, 1, -1):
            made = partial(with_share, fmpq(share), steps, radii)
            loop = loop_along(plant, k, others, line, made)
            if not stays_inside(characteristic(loop, []), loop, bound):
                return False
    return True


def with_share(share: fmpq, steps: Sequence[Any], radii: Any, at: System) -> System:
    """The loop of a plant with all gains moved by the same part of their radii."""
    return boxes.with_gains(at, steps, radii, repeat(share))


def loop_along(
    plant: SeveralParameters,
    k: int,
    others: tuple[fmpq, ...],
    line: ParametricPlant,
    made: Callable[[System], System],
) -> ParametricPlant:
    """The matrix of a loop as a function of one parameter, from its values.

    It is a sum of products of at most one entry of A, or of one of B and one of C.
    """
    delta, tops = reduce(lambda p, q: p * q, line.denominators), line.tables
    degree = max((top.degree() for rows, _, _ in tops for row in rows for top, _ in row), default=0)
    points = [fmpq(t) for t in range(10**4) if delta(fmpq(t)) != 0][
        : 2 * max(degree, 0) + delta.degree() + 1
    ]
    loops = [made(plant.at((*others[:k], t, *others[k:]))).A for t in points]
    N = loops[0].nrows()
    rows = []
    for i in range(N):
        row = []
        for j in range(N):
            values = [delta(t) * M[i, j] for t, M in zip(points, loops, strict=True)]
            row.append(in_lowest_terms(interpolated(points, values), delta))
        rows.append(row)
    return replace(line, names=(), tables=((rows, N, N),))


def driven(plant: ParametricPlant, T: Sequence[int]) -> ParametricPlant:
    """One channel with the inputs of T, which measures the state."""
    n, ports = plant.n, [plant.tables[2 * i + 1] for i in T]
    B = [[entry for rows, _, _ in ports for entry in rows[i]] for i in range(n)]
    zero, one = fmpq_poly([]), fmpq_poly([1])
    C = [[(one if i == j else zero, one) for j in range(n)] for i in range(n)]
    tables = (plant.tables[0], (B, n, sum(width for _, _, width in ports)), (C, n, n))
    return replace(plant, names=plant.names[:1], tables=tables)


def none_fixed(plant: ParametricPlant, limit: Any) -> bool:
    """Whether at no value in the range a mode is fixed outside of the region."""
    if any(meets(delta, plant.range) for delta in plant.denominators):
        return False
    fixed, quotients = split(drawn_polynomials(plant, random.Random(SEED)))
    bound = bound_of(limit, plant.time)
    if limit is None:
        return not fixed and not meets(common_roots(quotients), plant.range)
    return all(stays_inside(p, plant, bound) for p in fixed) and all(
        _inside_at(q, [_modulo(p, q) for p in quotients], plant, bound)
        for q, _ in algebra.irreducible_factors(common_roots(quotients))
        if meets(q, plant.range)
    )


def stays_inside(p: Any, plant: ParametricPlant, bound: fmpq | None) -> bool:
    """Whether for all t the roots x of a polynomial, divided by δ(t), are in the region.

    Of two roots that are mirror images at its border one at least is not inside.  Without any they
    are on one side of the border for all t, as they are for one.
    """
    delta, edge = plant.denominators[0], fmpq(plant.time == "discrete") if bound is None else bound
    x, degree = RING.gens()[1], p.degrees()[1]
    if plant.time == "continuous":
        turned = p.compose(RING.gens()[0], -2 * edge * in_t(delta) - x)
    else:
        parts = enumerate(in_powers_of_x(p))
        turned = sum(
            (in_t(c * (edge * delta) ** (2 * k)) * x ** (degree - k) for k, c in parts),
            RING.constant(0),
        )
    both = univariate(p.resultant(turned, "x"))
    low = plant.range[0]
    at_low = fmpq_poly([c(low) for c in in_powers_of_x(p)])(delta(low) * algebra.X)
    return both != 0 and not meets(both, plant.range) and inside(at_low, plant.time, bound)


def in_powers_of_x(p: Any) -> InX:
    """The coefficients of 1, x, x², …"""
    found: list[dict[int, Any]] = [{} for _ in range(p.degrees()[1] + 1)]
    for (i, k), c in p.to_dict().items():
        found[k][i] = c
    return [fmpq_poly([part.get(i, 0) for i in range(max(part, default=-1) + 1)]) for part in found]


def _inside_at(
    q: fmpq_poly, quotients: list[InX], plant: ParametricPlant, bound: fmpq | None
) -> bool:
    """Whether what the polynomials have in common at the roots of q in the range is inside."""
    common = reduce(lambda f, g: _common(f, g, q), quotients)
    slope = _modulo_list([k * c for k, c in enumerate(common)][1:], q)
    simple = _divided(common, _common(common, slope, q), q)[0] if slope else common
    delta, edge = plant.denominators[0], fmpq(plant.time == "discrete") if bound is None else bound

    def question(sign: Callable[[Any], int]) -> bool:
        for t in real_roots_within(q, plant.range, sign):
            scale, *coefficients = (acb_poly(p)(acb(t)) for p in (delta, *simple))
            for x in acb_poly(coefficients).roots():
                z = x / scale
                if plant.time == "continuous":
                    held = sign(z.real + acb(edge).real) < 0
                else:
                    held = sign(z.real**2 + z.imag**2 - acb(edge * edge).real) < 0
                if not held:
                    return False
        return True

    return decided(question)


def _modulo(p: Any, q: fmpq_poly) -> InX:
    return _modulo_list(in_powers_of_x(p), q)


def _modulo_list(coefficients: Iterable[fmpq_poly], q: fmpq_poly) -> InX:
    """Over Q[t]/(q), without zeros at the end."""
    found = [c % q for c in coefficients]
    while found and found[-1] == 0:
        found.pop()
    return found


def _divided(f: InX, g: InX, q: fmpq_poly) -> tuple[InX, InX]:
    """Quotient and remainder over Q[t]/(q), q irreducible."""
    _, inverse, _ = g[-1].xgcd(q)
    quotient = [fmpq_poly([])] * max(len(f) - len(g) + 1, 0)
    rest = list(f)
    while len(rest) >= len(g):
        k, c = len(rest) - len(g), rest[-1] * inverse % q
        quotient[k] = c
        rest = [e - c * g[i - k] if i >= k else e for i, e in enumerate(rest)][:-1]
        rest = _modulo_list(rest, q)
    return quotient, rest


def _common(f: InX, g: InX, q: fmpq_poly) -> InX:
    """The greatest common divisor over Q[t]/(q)."""
    while g:
        f, g = g, _divided(f, g, q)[1]
    return f


JUDGES = {
    "parametric_box_controllable": controllable_in_ranges,
    "parametric_box_fixed": fixed_in_ranges,
    "parametric_box_stable": stable_in_ranges,
}
"""The judge of each kind."""
