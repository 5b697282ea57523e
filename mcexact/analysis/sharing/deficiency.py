"""The largest rank that any pencil lacks: on (A, B_i, C_{N_i}) it is the bound of Theorem 2."""

from __future__ import annotations

from mcexact.analysis.engine import Obstruction, decide, evidence
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.answer.deficiency import ByBlocks, ByCompletion, Deficiency, RankLoss
from mcexact.answer.fixed_spectrum import ByBlocks as FixedByBlocks
from mcexact.derived.modular import closed_loop, generator, lifted, lifted_gains
from mcexact.exact.modular import random_matrix
from mcexact.model.system import MultiChannelSystem

# Up to this size one completed loop is the shorter evidence, and quick to check.
_SMALL = 128


def deficiency(system: MultiChannelSystem) -> Deficiency:
    """Compute the largest n − rank P_s(λ) over all s and all λ.

    Parameters
    ----------
    system : MultiChannelSystem

    Notes
    -----
    Exact.  ρ is the largest dimension of a kernel of λI − A_F for gains F that make each of them
    least.  From above: A_F + B_0 C_0 with ρ columns and rows has no eigenvalue of A.  From below: a
    shrunk subspace of deficiency ρ.  For large systems the fixed spectrum proves both where its
    evidence is by blocks.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> A, b = [[1, 0], [0, 1]], [[1], [0]]
    >>> deficiency(MultiChannelSystem(A, [b, b], [[[1, 0]], [[0, 1]]])).deficiency
    1
    """
    if system.n > _SMALL:
        found = _by_blocks(system)
        if found is not None:
            return found
    rng = generator(system, "deficiency")
    decision = decide(system, rng)
    worst: Obstruction | None = max(
        decision.obstructions, key=lambda o: o.subspace.deficiency, default=None
    )
    rho = worst.subspace.deficiency if worst else 0
    modular = decision.modular
    n, ell = system.n, modular.modulus
    modes = modular.A.characteristic_polynomial()
    closed = closed_loop(modular, decision.gains)
    while True:
        B0, C0 = random_matrix(n, rho, ell, rng), random_matrix(rho, n, ell, rng)
        if (closed + B0 @ C0).characteristic_polynomial().gcd(modes).degree == 0:
            break
    return Deficiency(
        system,
        deficiency=rho,
        evidence=ByCompletion(
            modulus=ell,
            gains=lifted_gains(modular, decision.gains),
            B0=lifted(B0),
            C0=lifted(C0),
            polynomial=worst.polynomial if worst else None,
            subspace=evidence(system, worst.subspace) if worst else None,
        ),
    )


def _by_blocks(system: MultiChannelSystem) -> Deficiency | None:
    """The deficiency that the fixed spectrum proves, if its evidence is by blocks."""
    spectrum = fixed_spectrum(system)
    proof = spectrum.evidence
    if not isinstance(proof, FixedByBlocks):
        return None
    losses = tuple(
        RankLoss(factor.polynomial, system.n - factor.rank, space)
        for factor, space in zip(spectrum.factors, proof.subspaces, strict=True)
    )
    return Deficiency(
        system,
        deficiency=max((loss.deficiency for loss in losses), default=0),
        evidence=ByBlocks(proof.blocks, proof.modulus, losses),
    )
