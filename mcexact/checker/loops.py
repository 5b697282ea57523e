"""Kinds about closed loops.

``stability`` says whether every eigenvalue of a matrix lies in a region (`Region`): beyond a rate,
or within a radius, perhaps with a least damping ratio and a largest modulus.  It has three kinds of
evidence.  The polynomial method recomputes the characteristic polynomial and locates its roots,
either way.  Quadratic forms, one for each diagonal block, prove stability without it, and a
quadratic form with a direction v, vᵀPv ≤ 0, proves the contrary.

``closed_loop_spectrum`` is the characteristic polynomial itself, compared modulo several numbers.
``distributed_observer`` is the separation of a loop with a distributed observer into two diagonal
blocks, and their polynomials.
"""

import math
from fractions import Fraction
from typing import NamedTuple

from .core import budget, evidence
from .core.arithmetic import (
    Echelon,
    Matrix,
    Polynomial,
    beside,
    characteristic_polynomial,
    cleared,
    poly_modulo,
    poly_product,
    scaled_bound,
    stack,
)
from .core.budget import products, spend
from .core.reading import (
    Json,
    boolean,
    fields,
    integer,
    items,
    matrix,
    polynomial,
    rational,
    require,
    string,
)
from .core.roots import in_region, is_hurwitz
from .core.system import System, denied, polynomial_text
from .modes import inside, read_rate_or_radius

# Quadratic forms that decrease along trajectories of a loop; ``proofs/stability.md``.


def transformed(value: Json, M: Matrix) -> Matrix:
    """Δ with M T = T Δ for a T that is nonsingular modulo ℓ.

    Theorem ``stability.stability_blocks``.
    """
    place, N = "witness.transformation", M.nrows
    left, right, number = fields(value, place, "T", "Delta", "modulus")
    T, Delta = matrix(left, f"{place}.T", N, N), matrix(right, f"{place}.Delta", N, N)
    basis = Echelon(evidence.modulus(number, f"{place}.modulus"))
    independent = all(basis.add(row) is not None for row in T.modulo(basis.ell))
    require(independent, "rank", f"{place}.T", "singular modulo l")
    require((M @ T).equals(T @ Delta), "identity", place, "M T differs from T Delta")
    return Delta


def decreasing(value: Json, place: str, D: Matrix, time: str, bound: Fraction) -> Matrix:
    """P, symmetric, with −(DᵀP + PD + 2·bound·P), or bound²P − DᵀPD, positive definite by R2.

    Theorems ``stability.stability_continuous``, ``stability.stability_discrete``.
    """
    k = D.nrows
    P, R2 = (matrix(value[key], f"{place}.{key}", k, k) for key in ("P", "R2"))
    require(P.equals(P.T), "symmetry", f"{place}.P", "not symmetric")
    half = P @ D
    if time == "continuous":
        S = (half + half.T + P.times(2 * bound)).times(Fraction(-1))
    else:
        S = P.times(bound**2) - D.T @ half
    require_dominant(R2.T @ (S @ R2), f"{place}.R2")
    return P


def require_dominant(S: Matrix, place: str) -> None:
    """Stop unless S is strictly diagonally dominant with positive diagonal.

    Theorem ``stability.dominant_congruence``.
    """
    spend(products(2 * S.nrows * (S.nrows + 4), S.limbs, 1))
    sizes = enumerate((row, sum(map(abs, row))) for row in S.rows)
    fits = all(2 * row[i] > row[i] + size - abs(row[i]) for i, (row, size) in sizes)
    require(fits, "dominance", place, "not strictly diagonally dominant")


# A rate, a disc and the sector of a damping ratio, each as stability; ``proofs/stability.md``.

LIMITS = ("damping", "largest_modulus")
"""The keys of a claim in continuous time that limit eigenvalues in addition to the rate."""


class Region(NamedTuple):
    """Re λ < −bound (discrete: |λ| < bound); −Re λ > ζ|λ| and |λ| < R unless these are None."""

    time: str
    bound: Fraction
    damping: Fraction | None
    largest: Fraction | None

    @property
    def limits(self) -> list[str]:
        """The keys of the limits that the claim has."""
        values = zip(LIMITS, (self.damping, self.largest), strict=True)
        return [key for key, limit in values if limit is not None]

    def contains(self, p: Polynomial) -> bool:
        """Whether all roots lie in the region.

        Theorems ``sector.damping_by_integers``, ``routh_integers.in_region_discrete``.
        """
        held = in_region(p, self.time, self.bound)
        if held and self.largest is not None:
            held = in_region(p, "discrete", self.largest)
        if held and self.damping is not None:
            held = is_hurwitz(turned(p, self.damping))
        return held

    def sides(self, M: Matrix) -> dict[str, tuple[Matrix, str, Fraction]]:
        """Matrices, each with the rate or the radius that it meets, iff M has the region.

        Theorem ``sector.damping_matrix``.
        """
        matrices = {"bound": (M, self.time, self.bound)}
        if self.damping is not None:
            matrices["damping"] = lifted(M, self.damping), "continuous", Fraction(0)
        if self.largest is not None:
            matrices["largest_modulus"] = M, "discrete", self.largest
        return matrices


def read_region(bound: Json, damping: Json, largest: Json, system: System) -> Region:
    """The region of a claim; the limits are for continuous time."""
    rate, discrete = read_rate_or_radius(bound, system), system.time == "discrete"
    zeta = None if damping is None else rational(damping, "claim.damping")
    R = None if largest is None else rational(largest, "claim.largest_modulus")
    fits = zeta is None or (not discrete and 0 < zeta < 1)
    require(fits, "bound", "claim.damping", "expected a ratio between 0 and 1, continuous time")
    fits = R is None or (not discrete and R > 0)
    require(fits, "bound", "claim.largest_modulus", "expected a number > 0, continuous time")
    return Region(system.time, Fraction(int(discrete)) if rate is None else rate, zeta, R)


def turned(p: Polynomial, zeta: Fraction) -> Polynomial:
    """A multiple of Π (x − wλ)(x − w̄λ) over the roots λ, w = h + r, r² = −a²h, h = b² − a².

    With ζ = a/b: all w λ have negative real part iff −Re λ > ζ|λ| for all λ, since they come in
    conjugate pairs.  Σ p_k w^(d−k) x^k = U + rV, and the product is U² + a²hV².

    Theorems ``sector.damping_rule``, ``sector.damping_by_integers``.
    """
    (numbers, _), a, b = cleared(p), zeta.numerator, zeta.denominator
    h, longest = b**2 - a**2, budget.limbs(numbers) + 2 * len(p) * budget.limbs([b])
    units = budget.products(4 * len(p), longest, longest)
    budget.spend(units + budget.table(6, len(p), longest))
    U, V, u, v = list[int](), list[int](), 1, 0
    for c in reversed(numbers):
        U.insert(0, c * u)
        V.insert(0, c * v)
        u, v = h * u - a**2 * h * v, u + h * v
    squares = zip(poly_product(U, U), poly_product(V, V), strict=True)
    return [x + a**2 * h * y for x, y in squares]


def lifted(M: Matrix, zeta: Fraction) -> Matrix:
    """[M, −cM; M, M], c = ζ²/(1 − ζ²), whose eigenvalues are (1 ± i√c) λ.

    Theorem ``sector.damping_matrix``.
    """
    n, c = M.nrows, zeta**2 / (1 - zeta**2)
    return stack([beside([M, M.times(-c)], n), beside([M, M], n)], 2 * n)


def within(claim: dict[str, Json], system: System) -> str:
    """The region of a claim, in words."""
    limit = claim["bound"]
    phrases = [inside(int(system.time == "discrete") if limit is None else limit, system)]
    words = zip(LIMITS, ("damping ratio above", "modulus below"), strict=True)
    phrases += [f"{word} {Fraction(claim[key])}" for key, word in words if key in claim]
    return " and ".join(phrases)


# Kind ``stability``: whether every eigenvalue lies in a region; ``proofs/stability.md``.


def check_stability(claim: Json, witness: Json, system: System) -> None:
    """Locate the roots of the characteristic polynomial, or check quadratic forms.

    Theorems ``instability.instability_continuous``, ``instability.instability_discrete``,
    ``stability.stability_continuous``, ``stability.stability_discrete``,
    ``stability.stability_blocks``.
    """
    bound, verdict, zeta, largest = fields(claim, "claim", "bound", "stable", optional=LIMITS)
    stable, region = boolean(verdict, "claim.stable"), read_region(bound, zeta, largest, system)
    method, M = witness.get("method") if isinstance(witness, dict) else None, system.A
    if string(method, "witness.method", "polynomial", "lyapunov", "instability") == "polynomial":
        fields(witness, "witness", "method")
        inside = region.contains(characteristic_polynomial(M))
        require(inside == stable, "claim", "claim.stable", "the characteristic polynomial differs")
    elif method == "lyapunov":
        require(stable, "claim", "claim.stable", "this evidence is for a stable loop")
        _, change, listed = fields(witness, "witness", "method", "transformation", "blocks")
        start, Delta = 0, M if change is None else transformed(change, M)
        for place, entry in ((f"witness.blocks[{k}]", e) for k, e in enumerate(items(listed, ""))):
            keys = ("size", "P", "R", "R2", *region.limits)
            size = integer(fields(entry, place, *keys)[0], f"{place}.size")
            block, rest = range(start, start + size), range(start + size, M.nrows)
            require(block.stop <= M.nrows, "size", place, f"expected {M.nrows} states in all")
            below = Delta.take(rest, block)
            require(below.is_zero(), "blocks", place, "not block upper triangular")
            for key, side in region.sides(Delta.take(block, block)).items():
                _require_inside(entry, place, key, side)
            start += size
        require(start == M.nrows, "size", "witness.blocks", f"expected {M.nrows} states in all")
    else:
        require(not stable, "claim", "claim.stable", "this evidence is for an unstable loop")
        side_key, sides = ("side",) * bool(region.limits), region.sides(M)
        *_, direction = fields(witness, "witness", *side_key, "method", "P", "R2", "v")
        side = sides[string(witness.get("side", "bound"), "witness.side", *sides)]
        P = decreasing(witness, "witness", *side)
        v = matrix(direction, "witness.v", P.nrows, 1)
        falls = not v.is_zero() and (v.T @ (P @ v)).rows[0][0] <= 0
        require(falls, "direction", "witness.v", "expected v not 0 with v'Pv <= 0")


def _require_inside(entry: Json, place: str, key: str, side: tuple[Matrix, str, Fraction]) -> None:
    """Stop unless a quadratic form shows that a block lies on one side of the region's border."""
    if key != "bound":
        entry, place = entry[key], f"{place}.{key}"
        fields(entry, place, "P", "R", "R2")
    P = decreasing(entry, place, *side)
    R = matrix(entry["R"], f"{place}.R", P.nrows, P.nrows)
    require_dominant(R.T @ (P @ R), f"{place}.R")


def stability_statement(claim: Json, system: System) -> str:
    """The statement: in which region all eigenvalues lie, or that they do not."""
    return f"{denied(claim['stable'])}every eigenvalue of A has {within(claim, system)}"


# Kind ``closed_loop_spectrum``: the whole spectrum; ``proofs/closed_loop_spectrum.md``.


def check_closed_loop_spectrum(claim: Json, witness: Json, system: System) -> None:
    """Compare with det(xI − A) modulo every ℓ; the moduli suffice to prove equality.

    Theorem ``closed_loop_spectrum.closed_loop_spectrum``.
    """
    (listed,) = fields(claim, "claim", "polynomial")
    (numbers,) = fields(witness, "witness", "moduli")
    p = polynomial(listed, "claim.polynomial")
    require_spectrum(system.A, p, "claim.polynomial", moduli(numbers, "witness.moduli"))


def closed_loop_spectrum_statement(claim: Json, system: System) -> str:
    """The statement: the characteristic polynomial of A."""
    return f"the characteristic polynomial of A is {polynomial_text(claim['polynomial'])}"


def moduli(value: Json, place: str) -> list[int]:
    """Read integers ≥ 2 that are pairwise coprime."""
    numbers, product = [], 1
    for k, entry in enumerate(items(value, place)):
        numbers.append(integer(entry, f"{place}[{k}]", 2))
        longest, more = budget.limbs([product]), budget.limbs(numbers[-1:])
        budget.spend(budget.reductions(longest, more) + budget.fractions(1, more))
        coprime = math.gcd(product, numbers[-1]) == 1
        require(coprime, "modulus", f"{place}[{k}]", "not coprime to those before it")
        product *= numbers[-1]
    return numbers


def require_spectrum(A: Matrix, p: Polynomial, place: str, ells: list[int]) -> None:
    """Stop unless det(xI − A) = p, which is compared modulo enough integers.

    Theorem ``closed_loop_spectrum.closed_loop_spectrum``.
    """
    beta, D = scaled_bound(A)
    require(len(p) == A.nrows + 1, "degree", place, f"expected degree {A.nrows}")
    longest = budget.limbs([beta]) + budget.limbs_of(p)
    budget.spend(budget.fractions(3 * len(p), longest))
    small = all(D % c.denominator == 0 and abs(D * c) <= beta for c in p)
    require(small, "bound", place, "a coefficient that no matrix with these rows has")
    require(math.prod(ells) > 2 * beta, "moduli", "witness.moduli", "too few for these entries")
    for ell in budget.counted(ells):
        a = budget.limbs([ell])
        budget.spend(budget.reductions(1, longest, a) + budget.fractions(1, a))
        require(math.gcd(D, ell) == 1, "modulus", "witness.moduli", "divides a denominator")
        residues = characteristic_polynomial(A, ell)
        require(residues == poly_modulo(p, ell), "spectrum", place, f"differs modulo {ell}")


# Kind ``distributed_observer``: separation, both spectra; ``proofs/distributed_observer.md``.


def check_distributed_observer(claim: Json, witness: Json, system: System) -> None:
    """Check that the errors evolve by themselves, and the polynomials of both diagonal blocks.

    Theorems ``distributed_observer.observer_rate``, ``distributed_observer.observer_radius``.
    """
    first, second, limit = fields(claim, "claim", "feedback", "error", "bound")
    (numbers,) = fields(witness, "witness", "moduli")
    M_F, M_E = separated(system)
    p, q = polynomial(first, "claim.feedback"), polynomial(second, "claim.error")
    ells = moduli(numbers, "witness.moduli")
    require_spectrum(M_F, p, "claim.feedback", ells)
    require_spectrum(M_E, q, "claim.error", ells)
    bound = read_rate_or_radius(limit, system)
    if bound is not None:
        met = all(in_region(factor, system.time, bound) for factor in (p, q))
        require(met, "bound", "claim.bound", "a root does not meet it")


def distributed_observer_statement(claim: Json, system: System) -> str:
    """The statement: the errors separate, and both characteristic polynomials."""
    feedback, error = (polynomial_text(claim[key]) for key in ("feedback", "error"))
    limit = claim["bound"]
    return (
        "in the coordinates (x, e_1, z_1, e_2, z_2, ...), e_i = x_i - x for the x_i that agent i "
        "shares, the matrix of the loop is [M_F, *; 0, M_E], where M_F has the characteristic "
        f"polynomial {feedback} and M_E has {error}"
        + ("" if limit is None else f"; every root of both has {inside(limit, system)}")
    )


def separated(system: System) -> tuple[Matrix, Matrix]:
    """The diagonal blocks in the coordinates (x, e_1, z_1, …), e_i = x_i − x.

    Theorem ``distributed_observer.separation``.
    """
    blocks = list(system.blocks)
    good = len(blocks) > 1 and sum(blocks) == system.n and set(blocks[1::2]) == {blocks[0]}
    require(good, "subject", "subject", "not a loop in which every agent estimates the state")
    budget.spend(2 * budget.table(system.n, system.n, system.A.limbs) + len(blocks) ** 2)
    n, rows = blocks[0], [list(row) for row in system.A.rows]
    starts = [sum(blocks[:k]) for k in range(1, len(blocks), 2)]
    for start in starts:
        for i in range(n):
            rows[start + i] = [a - b for a, b in zip(rows[start + i], rows[i], strict=True)]
    for row in rows:
        row[:n] = [row[i] + sum(row[start + i] for start in starts) for i in range(n)]
    M, x, rest = Matrix(rows, system.n, system.A.denominator), range(n), range(n, system.n)
    alone = M.take(rest, x).is_zero()
    require(alone, "separation", "subject", "the state of the plant drives the estimation errors")
    return M.take(x, x), M.take(rest, rest)
