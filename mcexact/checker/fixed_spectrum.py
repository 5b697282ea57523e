"""Kind ``fixed_spectrum``: all fixed modes, and where they lie; ``proofs/fixed_spectrum.md``."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from . import evidence, reading
from .arithmetic import Matrix, characteristic_polynomial, exponent, poly_modulo, poly_product
from .arithmetic import characteristic_polynomial_modulo as polynomial_modulo
from .location import in_stability_region
from .reading import fields, require
from .system import System
from .words import channel_set, described, disc_text, polynomial_text

RATE = {"continuous": "best decay rate", "discrete": "best spectral radius"}
MULTIPLICITIES = ("multiplicity_in_A", "multiplicity_at_most")
FACTOR = ("polynomial", "channels", *MULTIPLICITIES, "rank", "stable", "roots")


def check(claim: Any, witness: Any, system: System) -> str:
    """Check a shrunk subspace for every factor, and that gains move everything else."""
    whole, entries, verdict, rate = fields(
        claim, "claim", "polynomial", "factors", "stabilizable", "best_rate"
    )
    gains, number, spaces, completion = fields(
        witness, "witness", "gains", "modulus", "subspaces", "completion"
    )
    ell = evidence.modulus(number, "witness.modulus")
    reading.items(spaces, "witness.subspaces", len(reading.items(entries, "claim.factors")))
    A_F = evidence.closed_loop(system, evidence.read_gains(gains, "witness.gains", system))
    chi_F = polynomial_modulo(A_F.modulo(ell), ell)
    psi = characteristic_polynomial(system.A) if entries else []
    product, losses, texts, stabilizable = [Fraction(1)], [], [], True
    discs: list[evidence.Disc] = []
    for k, entry in enumerate(entries):
        place = f"claim.factors[{k}]"
        coefficients, names, in_A, at_most, r, flag, roots = fields(entry, place, *FACTOR)
        p = reading.polynomial(coefficients, f"{place}.polynomial", 1)
        s = reading.names(names, f"{place}.channels", system.names)
        losses.append((p, system.n - reading.integer(r, f"{place}.rank")))
        T = evidence.shrunk_subspace(spaces[k], f"witness.subspaces[{k}]", system, *losses[-1])
        require(s == evidence.complement(system, T), "claim", place, "T is not what s leaves")
        evidence.require_coprime(product, p, ell, "two factors")
        (a, psi), product = exponent(p, psi), poly_product(product, p)
        e, _ = exponent(poly_modulo(p, ell), chi_F, ell)
        claimed = [reading.integer(count, place, 1) for count in (in_A, at_most)]
        require(claimed == [a, e], "claim", place, f"the multiplicities are {a} and {e}")
        stable = in_stability_region(p, system.time)
        require(reading.boolean(flag, place) == stable, "claim", f"{place}.stable", "it is not so")
        found = evidence.root_discs(roots, f"{place}.roots", p)
        stabilizable, discs = stabilizable and stable, discs + found
        texts.append(
            f"{polynomial_text(p)} (exponent {a} in det(xI - A), at most {e} in the gcd of all "
            f"det(xI - A_F); least pencil rank {r}, reached by the channels "
            f"{channel_set(system, s)}; {'stable' if stable else 'not stable'}; "
            f"roots {', '.join(map(disc_text, found))})"
        )
    psi = psi or polynomial_modulo(system.A.modulo(ell), ell)
    evidence.require_coprime(psi, chi_F, ell, "what is left of det(xI - A), and det(xI - A_F),")
    _require_ranks(completion, losses, A_F, ell)
    agrees = reading.polynomial(whole, "claim.polynomial") == product
    require(agrees, "claim", "claim.polynomial", "not the product of the factors")
    same = reading.boolean(verdict, "claim.stabilizable") == stabilizable
    require(same, "claim", "claim.stabilizable", f"it is {stabilizable}")
    if not entries:
        require(rate is None, "claim", "claim.best_rate", "expected null, nothing is fixed")
        return f"{described(system)} has no fixed modes; stabilizable by decentralized control"
    interval = evidence.rate_interval(rate, "claim.best_rate", discs, system.time)
    return (
        f"the fixed spectrum of {described(system)} is that of {polynomial_text(product)}: "
        f"{'; '.join(texts)}; {'' if stabilizable else 'not '}stabilizable by decentralized "
        f"control; {RATE[system.time]} {interval}"
    )


def _require_ranks(completion: Any, losses: list[Any], A_F: Matrix, ell: int) -> None:
    """Stop unless A_F + B_0 C_0, with d columns and rows, has no root of a p that loses d."""
    if not losses:
        require(completion is None, "claim", "witness.completion", "expected null")
        return
    left, right = fields(completion, "witness.completion", "B0", "C0")
    rho = max(loss for _, loss in losses)
    B0 = reading.matrix(left, "witness.completion.B0", A_F.nrows, rho)
    C0 = reading.matrix(right, "witness.completion.C0", rho, A_F.nrows)
    for d in {loss for _, loss in losses}:
        completed = A_F + B0.take(cols=range(d)) @ C0.take(range(d))
        chi = polynomial_modulo(completed.modulo(ell), ell)
        for p in (p for p, loss in losses if loss == d):
            evidence.require_coprime(p, chi, ell, "a factor, and det(xI - A_F - B0 C0),")
