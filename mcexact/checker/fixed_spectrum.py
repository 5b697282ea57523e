"""Kind ``fixed_spectrum``: all fixed modes, and where they lie; ``proofs/fixed_spectrum.md``."""

from fractions import Fraction

from . import arithmetic, evidence, location, reading, root_discs, subspaces
from .absence import Blocks, TwoPolynomials, by_blocks
from .arithmetic import Polynomial
from .characteristic_polynomial import characteristic_polynomial
from .reading import Json, fields, require
from .statement import FIXED, PENCIL, channel_set, denied, polynomial_text
from .system import System

CLAIM = ("polynomial", "factors", "stabilizable", "best_rate")
COUNTS = ("multiplicity_in_A", "multiplicity_at_most", "rank")
FACTOR = ("polynomial", "channels", "stable", "roots", *COUNTS)
SLOWEST = {
    "continuous": "minus the largest real part of a fixed mode",
    "discrete": "the largest modulus of a fixed mode",
}
REGION = {"continuous": "Hurwitz", "discrete": "Schur"}


def check(claim: Json, witness: Json, system: System) -> None:
    """Check a shrunk subspace for every factor, and that no more is fixed.

    Theorems ``fixed_spectrum.fixed_spectrum_rule``, ``wang_davison.region_attained``.
    """
    whole, entries, verdict, rate = fields(claim, "claim", *CLAIM)
    proof, spaces, completion = _proof(witness, system)
    reading.items(spaces, "witness.subspaces", len(reading.items(entries, "claim.factors")))
    n, product = system.n, [1]
    psi: Polynomial = []
    found: list[tuple[Polynomial, int, bool, list[root_discs.Disc]]] = []
    for k, entry in enumerate(entries):
        place, space = f"claim.factors[{k}]", f"witness.subspaces[{k}]"
        listed, names, flag, roots, times, *counts = fields(entry, place, *FACTOR)
        p = reading.polynomial(listed, f"{place}.polynomial", 1)
        s = reading.names(names, f"{place}.channels", system.names)
        at_most, r = map(reading.integer, counts, [place] * 2, (1, 0))
        T = subspaces.shrunk_subspace(spaces[k], space, system, p, n - r)
        require(s == evidence.complement(system, T), "claim", place, "T is not the complement of s")
        evidence.require_coprime(product, p, proof.ell, "two factors")
        product = arithmetic.poly_product(product, p)
        if times is not None or isinstance(proof, TwoPolynomials):
            a, psi = arithmetic.exponent(p, psi or characteristic_polynomial(system.A))
            same = reading.integer(times, place, 1) == a
            require(same, "claim", place, f"the multiplicity in A is {a}")
        e = proof.multiplicity(p, n - r)
        require(at_most == e, "claim", place, f"the multiplicity is at most {e}")
        stable = location.in_stability_region(p, system.time)
        require(reading.boolean(flag, place) == stable, "claim", f"{place}.stable", "not implied")
        discs = root_discs.root_discs(roots, f"{place}.roots", p)
        found.append((p, n - r, stable, discs))
    losses = [(p, loss) for p, loss, *_ in found]
    if isinstance(proof, Blocks):
        proof.require_no_more(losses)
    else:
        proof.require_moved(psi)
    stabilizable = all(stable for _, _, stable, _ in found)
    agrees = reading.polynomial(whole, "claim.polynomial") == product
    agrees = agrees and reading.boolean(verdict, "claim.stabilizable") == stabilizable
    require(agrees, "claim", "claim", "not the product of the factors, or not where they are")
    if not entries:
        require(rate is None and completion is None, "claim", "claim", "expected null for both")
    else:
        if isinstance(proof, TwoPolynomials):
            proof.require_ranks(completion, losses)
        centers = [disc for *_, discs in found for disc in discs]
        root_discs.require_rate(rate, "claim.best_rate", centers, system.time)


def _proof(witness: Json, system: System) -> tuple[Blocks | TwoPolynomials, Json, Json]:
    """The proof that no more is fixed, with the subspaces, and the completion if it has one."""
    if by_blocks(witness):
        parts, number, spaces = fields(witness, "witness", "blocks", "modulus", "subspaces")
        return Blocks(parts, "witness", system, number), spaces, None
    keys = ("gains", "modulus", "subspaces", "completion")
    gains, number, spaces, completion = fields(witness, "witness", *keys)
    return TwoPolynomials(gains, number, "witness", system), spaces, completion


def statement(claim: Json, system: System) -> str:
    """All fixed modes, and whether they are stable."""
    rate, whole = claim["best_rate"], polynomial_text(claim["polynomial"])
    texts = sorted((len(f["polynomial"]), _factor_text(f, system)) for f in claim["factors"])
    start = f"the modes that are {FIXED} are the roots of {whole}"
    if whole == "1":
        start = f"no mode is {FIXED}"
    control = "linear time-invariant decentralized control"
    end = f"it is {denied(claim['stabilizable'])}stabilizable by {control}"
    if rate is not None:
        low, high = (Fraction(rate[key]) for key in ("lower", "upper"))
        end += f"; {SLOWEST[system.time]} is from {low} to {high}"
    return "; ".join([start, *(text for _, text in texts), end])


def _factor_text(factor: Json, system: System) -> str:
    """The proved properties of one factor."""
    p, region = polynomial_text(factor["polynomial"]), REGION[system.time]
    times = factor["multiplicity_in_A"]
    exponent = "some exponent" if times is None else f"the exponent {times}"
    return (
        f"{p} is {denied(factor['stable'])}{region}, has {exponent} in det(xI - A) and at most "
        f"{factor['multiplicity_at_most']} in the greatest common divisor of det(xI - A_F) over "
        f"all constant gains F, and one root in each of the discs "
        f"{root_discs.disc_set(factor['roots'])}, where the least rank of {PENCIL} over all sets "
        "of channels, C the outputs of the set and B the inputs of the others, is "
        f"{factor['rank']}, reached by {channel_set(factor['channels'])}"
    )
