"""The proof that no more is fixed than what is known: one Krylov sequence of one channel."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence

from mcexact.answer.evidence import KrylovSequence
from mcexact.derived.modular import (
    Gains,
    ModularSystem,
    channel_sequences,
    drawn_gains,
    lifted_gains,
)
from mcexact.exact.krylov import Start, cofactors, least_recurrence
from mcexact.exact.modular import ModularPolynomial
from mcexact.model.system import MultiChannelSystem

MODULI = (19, 31, 2**19 - 1)
"""Small moduli make certificates that are quick to check; structured plants need larger ones.

Of 700 dense drawn plants with 50 to 800 states the first sequence was too short for 31 % modulo 7,
15 % modulo 13, 12 % modulo 19 and 6 % modulo 31; an answer took 1.2, 1.04, 1.02 and 1 times as
long on average, and to check one of 1,000 states 1.6, 1.7, 1.8 and 2.0 s.
"""
LARGE = 2**12
"""From so many states on, a sequence that fails costs more than a small modulus saves."""
STARTS = 3
"""How many channels are tried with the same gains: a second one takes a third of the time."""


def best_sequences(
    system: MultiChannelSystem, denominator: int = 1, through: str | None = None
) -> Iterator[KrylovSequence]:
    """Draw gains modulo one prime after the other, and yield the longest sequence for each.

    The last one has degree n, or two in a row have the same degree, or all primes are used up.

    Parameters
    ----------
    system : MultiChannelSystem
    denominator : int
        Moduli that divide it are passed over, as are those that divide one of the system.
    through : str, optional
        The name of the only channel that is tried.

    Notes
    -----
    If nothing is fixed and the transfer graph is strongly connected, generic gains make the system
    controllable and observable through each channel with inputs and outputs (Corfmat and Morse
    1976), and then generic x and y give a sequence of degree n.  Modulo ℓ, gains, x and y that are
    drawn do so with a probability near (1 − 1/ℓ)².  The draws depend on ℓ and on the sizes of the
    gains alone.
    """
    if not system.m:
        return
    denominator *= system.denominator
    before = -1
    for ell in MODULI if system.n < LARGE else MODULI[1:]:
        if denominator % ell:
            best = _longest(ModularSystem(system, ell), random.Random(ell), through)
            yield best
            if best.degree in (before, system.n):
                return
            before = best.degree


def _longest(modular: ModularSystem, rng: random.Random, through: str | None) -> KrylovSequence:
    """The longest sequence of a few channels for drawn gains."""
    system, ell = modular.system, modular.modulus
    gains, starts = drawn_gains(modular, rng), _starts(system, ell, rng, through)
    found = []
    for start, numbers in zip(starts, channel_sequences(modular, gains, starts), strict=False):
        found.append((least_recurrence(numbers, ell), start, numbers))
        if found[-1][0].degree == system.n:
            break
    return _evidence(modular, gains, *max(found, key=lambda each: each[0].degree))


def _starts(
    system: MultiChannelSystem, ell: int, rng: random.Random, through: str | None
) -> list[Start]:
    """Channels with inputs and outputs, with a combination of each; no two alike."""
    live = (system.active if through is None else (system.index(through),)) or (0,)
    chosen = rng.sample(live, min(STARTS, len(live)))
    found: list[Start] = []
    for k in range(STARTS):
        q = chosen[k % len(chosen)]
        start = q, _direction(system.p(q), ell, rng), _direction(system.q(q), ell, rng)
        if start not in found:
            found.append(start)
    return found


def _direction(size: int, ell: int, rng: random.Random) -> tuple[int, ...]:
    """Residues that are not all 0, up to a common factor."""
    if size == 1:
        return (1,)
    drawn = [rng.randrange(ell) for _ in range(size)]
    return tuple(drawn) if any(drawn) else (1,) * size


def _evidence(
    modular: ModularSystem,
    gains: Gains,
    recurrence: ModularPolynomial,
    start: Start,
    numbers: Sequence[int],
) -> KrylovSequence:
    q, x, y = start
    a, e = cofactors(recurrence, numbers)
    return KrylovSequence(
        modulus=modular.modulus,
        gains=lifted_gains(modular, gains),
        channel=modular.system.channels[q].name,
        inputs=tuple(x),
        outputs=tuple(y),
        recurrence=recurrence.coefficients,
        cofactors=(a.coefficients, e.coefficients),
    )
