"""The kind about inputs that are cut off at their limits, with anti-windup gains.

An agent computes v, and the plant receives sat(v), v cut off at the limits of the input.  While it
is, the agent adds L (sat(v) − v) to its next states, in continuous time to their derivatives.  So
the loop z' = Mz + Ed with v = Uz, d added to the inputs, becomes

    z' = M₀ z + E₀ sat(v),   E₀ = E + L,   M₀ = M − E₀U     (inputs without limits: sat(v) = v),

L with the rows of the agents' states.  sat(v) lies between 0 and v, and between av and v where
a|v| is at most the nearer limit.  So the circle criterion of the kind ``sector`` applies, with the
sectors [a, 1]: with a = 0 everywhere, also to the difference of two solutions, and with a > 0 in an
ellipsoid {z'Pz ≤ 1} on which |v| is small enough.

The exact samples of a plant have other A and B, within radii of the rounded ones.  With |ΔG| ≤ R
for G = [M₀, E₀] the fall of z'Pz is another one by a form T with |T| ≤ R'|PG| + |PG|'R + R'|P|R.
So it stays positive where it is larger than the diagonal matrix of the sums of the rows of this
bound.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

from .constructions import Loop
from .controllers import Saturation
from .core import budget
from .core.arithmetic import Matrix, absolute, beside, diagonal, stack
from .core.reading import Json, fields, items, matrix, rational, require
from .core.system import System, read_limits
from .performance import (
    bordered,
    diagonal_of,
    loop_of,
    lyapunov,
    nonnegative,
    require_positive,
    symmetric,
)

Ranges = list[tuple[Fraction, Fraction] | None]


def check_saturation(claim: Json, witness: Json, system: System) -> None:
    """The circle criterion for the sectors [a, 1] of saturation, everywhere or in a region.

    Theorems ``saturation.global_continuous``, ``saturation.global_discrete``,
    ``saturation.region_continuous``, ``saturation.region_discrete``.  Exact
    samples are not machine-checked.  Open: see ``proofs/OPEN.md``.
    """
    listed, gains, region, exact = fields(
        claim, "claim", "limits", "back_calculation", optional=("region", "exact")
    )
    theta, ends, form = fields(witness, "witness", "scaling", "sectors", optional=("P",))
    plant, loop = loop_of(system)
    ranges = ranges_of(listed, plant)
    cut = [k for k, each in enumerate(ranges) if each is not None]
    # z' = M₀z + E₀ φ for the inputs φ that are cut off, which are v = Uz before; the corner of the
    # inequality is positive for scalings above 0 alone
    U = loop.U.at(cut)
    E = (loop.E + windup(gains, plant, system.loop)).take(cols=cut)
    apart = loop.M - E @ U
    scaling = nonnegative(theta, "witness.scaling", len(cut))
    lower = nonnegative(ends, "witness.sectors", len(cut))
    if region is None:
        require(not any(lower), "sector", "witness.sectors", "a sector from 0 on is global alone")
        P = symmetric(form, "witness.P", loop.M.nrows)
    else:
        require(form is None, "region", "witness.P", "the region is the form")
        P = check_region(region, U, (ranges, lower), plant.n)
    require_positive(P, "witness.P", "not shown to be positive definite")
    decrease = circle(P, (apart, E, U), scaling, lower, system.time)
    if exact is not None:
        require(exact is True, "exact", "claim.exact", "expected true, or no such key")
        decrease = decrease - diagonal_of(spread(P, (apart, E, loop.U), cut, plant))
    require_positive(decrease, "witness.P", "the form is not shown to decrease")


def spread(
    P: Matrix, signals: tuple[Matrix, Matrix, Matrix], cut: list[int], plant: System
) -> list[Fraction]:
    """By how much the fall can be smaller at the exact samples, in each square of (z, φ).

    An input without limits is v itself, row k of U, and stands in M₀.
    """
    message = "only samples of a plant, in no other construction, are rounded"
    require(plant.missed is not None, "exact", "claim.exact", message)
    M, E, U = signals
    N, n, width = M.nrows, plant.n, E.ncols
    A, B = plant.missed.A, beside(plant.missed.B, n)
    free = [k for k in range(B.ncols) if k not in cut]
    own = beside([A, Matrix.zeros(n, N - n)], n) + B.take(cols=free) @ absolute(U.at(free))
    above = beside([own, B.take(cols=cut)], n)
    R = stack([above, Matrix.zeros(N - n, N + width)], N + width)
    size = R.T @ absolute(P @ beside([M, E], N))
    size = size + size.T + R.T @ (absolute(P) @ R)
    budget.spend(budget.fractions(size.nrows * size.ncols, size.limbs))
    return [Fraction(sum(row), size.denominator) for row in size.rows]


def ranges_of(value: Json, plant: System) -> Ranges:
    """The limits of all inputs, in the order of the channels."""
    channels = zip(items(value, "claim.limits", plant.m), plant.B, strict=True)
    return [pair for own, B_i in channels for pair in read_limits(own, "claim.limits", B_i.ncols)]


def windup(value: Json, plant: System, loop: Loop) -> Matrix:
    """The anti-windup gains of all agents, with the rows of the states of the loop."""
    place, widths = "claim.back_calculation", [width for _, width in loop.order]
    listed = items(value, place, plant.m)
    gains = [
        matrix(L, place, widths[2 * i + 1] + widths[2 * i + 2], B_i.ncols)
        for i, (L, B_i) in enumerate(zip(listed, plant.B, strict=True))
    ]
    joined = reduce(diagonal, gains)
    rest = sum(widths[2 * plant.m + 1 :])
    above, below = (Matrix.zeros(rows, joined.ncols) for rows in (plant.n, rest))
    return stack([above, joined, below], joined.ncols)


def check_region(
    region: Json, U: Matrix, limits: tuple[Ranges, Sequence[Fraction]], n: int
) -> Matrix:
    """P, where a|v| is within the limits if z'Pz ≤ 1, as it is for small states of the plant.

    Theorem ``saturation.ellipsoid_stays``.
    """
    form, size, own_sizes = fields(region, "claim.region", "P", "radius", optional=("sizes",))
    place, radius = "claim.region.radius", rational(size, "claim.region.radius")
    sizes = [Fraction(1)] * n
    if own_sizes is not None:
        listed = items(own_sizes, "claim.region.sizes", n)
        sizes = [rational(x, "claim.region.sizes") for x in listed]
        positive = all(x > 0 for x in sizes)
        require(positive, "region", "claim.region.sizes", "expected sizes above 0")
    P = symmetric(form, "claim.region.P", U.ncols)
    ranges, lower = limits
    pairs = [each for each in ranges if each is not None]
    for k, ((low, high), a) in enumerate(zip(pairs, lower, strict=True)):
        if not a:
            continue
        nearer = min(-low, high)
        message = "an input leaves its sector in the region"
        require(nearer > 0, "region", "claim.region.P", message)
        v = U.at([k])
        require_positive(P - (v.T @ v).times((a / nearer) ** 2), "claim.region.P", message)
    require(radius > 0, "region", place, "expected a number above 0")
    budget.spend(budget.fractions(4 * n, 2 * budget.limbs_of([radius, *sizes])))
    ball = diagonal_of([1 / (radius * x) ** 2 for x in sizes])
    own = ball - P.take(range(n), range(n))
    require_positive(own, place, "not all of these states of the plant are in the region")
    return P


def circle(
    P: Matrix,
    signals: tuple[Matrix, Matrix, Matrix],
    scaling: Sequence[Fraction],
    lower: Sequence[Fraction],
    time: str,
) -> Matrix:
    """The fall of z'Pz along z' = M₀z + E₀φ, less Σ θ (φ − av)(v − φ), as a form of (z, φ)."""
    M, E, U = signals
    products = diagonal_of([t * a for t, a in zip(scaling, lower, strict=True)])
    means = diagonal_of([t * (1 + a) / 2 for t, a in zip(scaling, lower, strict=True)])
    corner = diagonal_of(scaling)
    if time == "discrete":
        corner = corner - E.T @ (P @ E)
    right = P @ E if time == "continuous" else M.T @ (P @ E)
    across = (right + U.T @ means).times(-1)
    return bordered(lyapunov(P, M, time) + U.T @ (products @ U), across, corner)


def agrees(claim: Json, known: Saturation) -> bool:
    """Whether a claim has the limits and the gains of a controller file, as far as it has any."""
    listed, gains = claim["limits"], claim["back_calculation"]
    if not len(listed) == len(gains) == len(known):
        return False
    for own, L, (pairs, file_gains) in zip(listed, gains, known, strict=True):
        if pairs is not None and read_limits(own, "claim.limits", len(own)) != pairs:
            return False
        rows = _entries(L)
        if file_gains is None:
            if any(map(any, rows)):
                return False
        elif rows != _entries({"entries": file_gains.rows, "denominator": file_gains.denominator}):
            return False
    return True


def saturation_statement(claim: Json, system: System) -> str:
    """The statement: which solutions tend to each other, or to 0, with which limits and gains."""
    limits = "; ".join(", ".join(map(_range, own)) or "none" for own in claim["limits"])
    gains = "; ".join(map(_rows, claim["back_calculation"]))
    cut = (
        "where the plant receives each input cut off at its limits, and each agent adds L (w - v) "
        "to its next states, in continuous time to their derivatives, v being the inputs that it "
        f"computes and w these cut off; limits of each agent in turn: {limits}; L in turn: {gains}"
    )
    exact = "; all of this holds as well for the plant sampled without rounding"
    exact = exact if "exact" in claim else ""
    if "region" not in claim:
        return (
            "any two solutions with the same set-points and disturbances approach each other "
            f"exponentially, {cut}{exact}"
        )
    region = claim["region"]
    divided = ""
    if "sizes" in region:
        listed = ", ".join(map(str, region["sizes"]))
        divided = f", each of its entries divided by one of ({listed}) in turn"
    e, s = region["P"]["exponents"], region["P"]["entries"]
    return (
        "every solution without set-points and disturbances that starts where z'Pz <= 1 stays "
        f"there and tends to 0 exponentially, z the state of the loop, {cut}; P_ij = s_ij "
        f"2^(e_i + e_j) with e = {e} and the lower triangle s = {s}, row by row; z'Pz <= 1 holds "
        "for every state of the system that is controlled, of norm at most "
        f"{region['radius']}{divided}, where all else is 0{exact}"
    )


def _range(pair: Json) -> str:
    return "no limits" if pair is None else " to ".join(map(str, pair))


def _entries(L: Json) -> list[list[Fraction]]:
    """The entries of a matrix that was read, by rows."""
    rows, d = L["entries"], L["denominator"]
    budget.spend(sum(budget.fractions(len(row), budget.limbs([*row, d])) for row in rows))
    return [[Fraction(x, d) for x in row] for row in rows]


def _rows(L: Json) -> str:
    rows = _entries(L)
    written = "; ".join(", ".join(map(str, row)) for row in rows)
    return f"[{written}]" if any(rows) else "none"
