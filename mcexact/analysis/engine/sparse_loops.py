"""Closed loops of sparse systems modulo primes, with their minimal polynomials."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass

from mcexact.derived.modular import ModularSystem, drawn_gains
from mcexact.exact.krylov import SparseLoop, SparsePowers, largest_prime
from mcexact.exact.modular import ModularPolynomial, primes
from mcexact.model.system import MultiChannelSystem

# Each column has n entries in the certificate, and takes n products with A_F.
MOST_COLUMNS = 256
# Each prime takes a sequence of its own.
MOST_PRIMES = 12


@dataclass(frozen=True)
class DrawnLoop:
    """The closed loop of drawn gains modulo ℓ, and the minimal polynomial of its matrix.

    Attributes
    ----------
    parts : SparseLoop
    powers : SparsePowers
        Of A_F.
    polynomial : ModularPolynomial
    """

    parts: SparseLoop
    powers: SparsePowers
    polynomial: ModularPolynomial


def exact_primes(system: MultiChannelSystem, rng: random.Random) -> Iterator[int]:
    """Primes modulo which products with closed loops are exact and no denominator is 0."""
    parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    denominators = {M.denominator for M in parts}
    rows = [0] * system.n
    for i, _, _ in system.A.nonzero():
        rows[i] += 1
    for channel in system.channels:
        seen = sum(1 for _ in channel.C.nonzero())
        for i in {i for i, _, _ in channel.B.nonzero()}:
            rows[i] += seen
    bits = largest_prime(system.n, max(rows, default=0)).bit_length() - 1
    for ell in primes(rng.getrandbits(64), bits):
        if all(d % ell for d in denominators):
            yield ell


def drawn_loop(system: MultiChannelSystem, ell: int, rng: random.Random) -> DrawnLoop:
    """Draw gains modulo a prime, and compute the minimal polynomial of the loop."""
    channels = system.channels
    parts = SparseLoop(system.A, [c.B for c in channels], [c.C for c in channels], ell)
    gains = drawn_gains(ModularSystem(system, ell), rng)
    powers = SparsePowers(parts.closed(gains), ell)
    return DrawnLoop(parts, powers, powers.minimal_polynomial(rng))
