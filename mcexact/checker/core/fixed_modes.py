"""The kinds ``fixed_spectrum`` and ``completeness``: all fixed modes, and whether there are any.

Each kind has a function ``check_…``, which stops unless the witness proves the claim, and a
function ``…_statement``, which says the claim in words.  The fixed modes are bounded from both
sides: a `shrunk_subspace` proves that modes are fixed, with the rank that they lose; coprime
polynomials or blocks prove that no more modes are fixed (`evidence`).
"""

from fractions import Fraction

from . import arithmetic, evidence, reading
from .arithmetic import Polynomial, characteristic_polynomial
from .evidence import Blocks, Loss, TwoPolynomials, by_blocks
from .reach import require_connected
from .reading import Json, boolean, fields, polynomial, require
from .roots import Disc, disc_set, in_stability_region, require_rate, root_discs
from .system import FIXED, PENCIL, System, channel_set, denied, polynomial_text

# Kind ``fixed_spectrum``: all fixed modes, and where they lie; ``proofs/fixed_spectrum.md``.

CLAIM = ("polynomial", "factors", "stabilizable", "best_rate")
COUNTS = ("multiplicity_in_A", "multiplicity_at_most", "rank")
FACTOR = ("polynomial", "channels", "stable", "roots", *COUNTS)
SLOWEST = {
    "continuous": "minus the largest real part of a fixed mode",
    "discrete": "the largest modulus of a fixed mode",
}
REGION = {"continuous": "Hurwitz", "discrete": "Schur"}


def check_fixed_spectrum(claim: Json, witness: Json, system: System) -> None:
    """Check a loss of rank for every factor, and that no more is fixed.

    Theorems ``fixed_spectrum.fixed_spectrum_rule``, ``wang_davison.region_attained``.
    """
    whole, entries, verdict, rate = fields(claim, "claim", *CLAIM)
    proof, spaces, completion = _proof(witness, system)
    reading.items(spaces, "witness.subspaces", len(reading.items(entries, "claim.factors")))
    n, product, losses = system.n, [1], evidence.Losses(system)
    psi: Polynomial = []
    unsaid: list[Loss] = []
    modes: list[tuple[Polynomial, int, bool, list[Disc]]] = []
    for k, entry in enumerate(entries):
        place, space = f"claim.factors[{k}]", f"witness.subspaces[{k}]"
        listed, names, flag, roots, times, *counts = fields(entry, place, *FACTOR)
        p = reading.polynomial(listed, f"{place}.polynomial", 1)
        s = reading.names(names, f"{place}.channels", system.names)
        at_most, r = map(reading.integer, counts, [place] * 2, (1, 0))
        T = losses.checked(spaces[k], space, p, n - r)
        require(s == evidence.complement(system, T), "claim", place, "T is not the complement of s")
        evidence.require_coprime(product, p, proof.ell, "two factors")
        product = arithmetic.poly_product(product, p)
        if times is not None:
            a, psi = arithmetic.exponent(p, psi or characteristic_polynomial(system.A))
            same = reading.integer(times, place, 1) == a
            require(same, "claim", place, f"the multiplicity in A is {a}")
        e = proof.multiplicity(p, n - r)
        require(at_most == e, "claim", place, f"the multiplicity is at most {e}")
        if times is None:
            unsaid.append((p, n - r))
        stable = in_stability_region(p, system.time)
        require(reading.boolean(flag, place) == stable, "claim", f"{place}.stable", "not implied")
        discs = root_discs(roots, f"{place}.roots", p)
        modes.append((p, n - r, stable, discs))
    lost = [(p, loss) for p, loss, *_ in modes]
    if isinstance(proof, Blocks):
        proof.require_no_more(lost)
    elif unsaid:
        same = len(unsaid) == len(modes)
        require(same, "claim", "claim.factors", "expected multiplicities in A, or none")
        proof.require_bounded(unsaid)
    else:
        proof.require_moved(psi)
    stabilizable = all(stable for _, _, stable, _ in modes)
    agrees = reading.polynomial(whole, "claim.polynomial") == product
    agrees = agrees and reading.boolean(verdict, "claim.stabilizable") == stabilizable
    require(agrees, "claim", "claim", "not the product of the factors, or not where they are")
    if not entries:
        require(rate is None and completion is None, "claim", "claim", "expected null for both")
    else:
        if isinstance(proof, TwoPolynomials):
            proof.require_ranks(completion, lost)
        centers = [disc for *_, discs in modes for disc in discs]
        require_rate(rate, "claim.best_rate", centers, system.time)


def _proof(witness: Json, system: System) -> tuple[Blocks | TwoPolynomials, Json, Json]:
    """Read the proof that no more is fixed, the subspaces, and the completion or None."""
    if by_blocks(witness):
        parts, number, spaces = fields(witness, "witness", "blocks", "modulus", "subspaces")
        return Blocks(parts, "witness", system, number), spaces, None
    keys = ("gains", "modulus", "subspaces", "completion")
    gains, number, spaces, completion = fields(witness, "witness", *keys)
    return TwoPolynomials(gains, number, "witness", system), spaces, completion


def fixed_spectrum_statement(claim: Json, system: System) -> str:
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
        f"{disc_set(factor['roots'])}, where the least rank of {PENCIL} over all sets "
        "of channels, C the outputs of the set and B the inputs of the others, is "
        f"{factor['rank']}, reached by {channel_set(factor['channels'])}"
    )


# Kind ``completeness``: a strongly connected transfer graph and no fixed mode, or not;
# ``proofs/completeness.md``.


def check_completeness(claim: Json, witness: Json, system: System) -> None:
    """Check `_require_complete` for yes; a fixed mode or a cut of the transfer graph for no.

    Theorems ``completeness.completeness_yes``, ``completeness.completeness_no_mode``,
    ``completeness.completeness_no_cut``, ``transfer_graph.closed_states_no_arc``.
    """
    (verdict,) = fields(claim, "claim", "complete")
    if boolean(verdict, "claim.complete"):
        _require_complete(witness, system)
    elif isinstance(witness, dict) and "zero" in witness:
        (zero,) = fields(witness, "witness", "zero")
        sources, X = evidence.zero_transfer(zero, "witness.zero", system)
        rest = evidence.complement(system, sources)
        proper = bool(sources and rest)
        require(proper, "cut", "witness.zero.from", "expected a nonempty proper set")
        for i in rest:
            message = f"C X is not zero for channel number {i + 1}"
            require((system.C[i] @ X).is_zero(), "identity", "witness.zero", message)
    elif isinstance(witness, dict) and "from" in witness:
        (sources,) = fields(witness, "witness", "from")
        evidence.require_cut(sources, "witness.from", system)
    else:
        coefficients, subspace = fields(witness, "witness", "polynomial", "subspace")
        p = polynomial(coefficients, "witness.polynomial", 1)
        evidence.Losses(system).checked(subspace, "witness.subspace", p, 1)


def completeness_statement(claim: Json, system: System) -> str:
    """The statement: whether the system is complete."""
    means = f"its transfer graph is strongly connected and no mode is {FIXED}"
    return f"it is {denied(claim['complete'])}complete, where complete means that {means}"


def _require_complete(witness: Json, system: System) -> None:
    """Stop unless no mode is fixed, and edges strongly connect the transfer graph.

    Theorem ``transfer_graph.strongly_connected_arcs``.
    """
    if by_blocks(witness):
        number, value, listed = fields(witness, "witness", "modulus", "blocks", "arcs")
        ell = evidence.modulus(number, "witness.modulus")
        Blocks(value, "witness", system).require_no_more([])
    else:
        number, gains, listed = fields(witness, "witness", "modulus", "gains", "arcs")
        proof = TwoPolynomials(gains, number, "witness", system)
        proof.require_moved([])
        ell = proof.ell
    require_connected(listed, "witness.arcs", system, ell)
