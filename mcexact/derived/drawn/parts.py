"""The drawn parts of systems: polynomials, chains, inputs and outputs."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace
from fractions import Fraction

from mcexact.derived.drawn.choices import Choices, shuffled
from mcexact.derived.drawn.primary_form import Chain, Coefficients, Draft, Ports
from mcexact.errors import UsageError
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem


def irreducible(choices: Choices, degree: int) -> Coefficients:
    """Draw a monic irreducible polynomial over Q: x − a, or one of Eisenstein's for the prime 2.

    Parameters
    ----------
    choices : Choices
    degree : int
        At least 1.

    Returns
    -------
    tuple of int
        Constant first.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> len(irreducible(SeededChoices(0), 3)) - 1
    3
    """
    if degree < 1:
        raise UsageError(f"expected a degree >= 1, found {degree}")
    if degree == 1:
        return (-choices.option((0, 1, -1, 2, -2, 3)), 1)
    middle = [2 * choices.option((0, 1, -1)) for _ in range(degree - 1)]
    return (2 * choices.option((1, -1)), *middle, 1)


def draw_ports(
    choices: Choices,
    channels: int,
    *,
    reach: frozenset[int] = frozenset(),
    subset: frozenset[int] = frozenset(),
    inactive_channels: bool = False,
) -> tuple[Ports, Ports]:
    """Draw the numbers of inputs and outputs of the channels, and which channels are inactive."""
    inputs, outputs = [], []
    for i in range(channels):
        inputs += [i] * choices.option((1, 1, 1, 2))
        outputs += [i] * choices.option((1, 1, 1, 2))
    silent: frozenset[int] = frozenset()
    blind: frozenset[int] = frozenset()
    if inactive_channels:
        # At least one channel has inputs, and at least one has outputs.
        silent = frozenset(shuffled(choices, range(channels))[: choices.integer(0, channels - 1)])
        blind = frozenset(shuffled(choices, range(channels))[: choices.integer(0, channels - 1)])
    return (
        Ports(tuple(inputs), reach, 1, silent),
        Ports(tuple(outputs), subset, 3, blind),
    )


def live(ports: Ports, channels: Collection[int]) -> int:
    """The number of ports of those of the channels that are active."""
    return sum(owner in channels and owner not in ports.inactive for owner in ports.owners)


def draw_chains(
    choices: Choices,
    states: int,
    limit: int,
    planted: Sequence[Chain] = (),
    zones: Sequence[int] = (1, 3),
) -> list[Chain]:
    """Draw chains for the remaining states, at most ``limit`` of the same polynomial.

    Parameters
    ----------
    choices : Choices
    states : int
        The number of states of all chains.
    limit : int
        At least 1, and the number of planted chains of one polynomial.
    planted : sequence of Chain
        Prescribed chains, which come first.
    zones : sequence of int
        The zones in which the other chains may lie.
    """
    chains = list(planted)
    left = states - sum(chain.size for chain in chains)
    count = Counter(chain.polynomial for chain in chains)
    zone = choices.option(zones)
    pool = [irreducible(choices, 1) for _ in range(1 + states // 8)]
    while left:
        degree = choices.option((1, 1, 1, 1, 2, 3))
        polynomial = irreducible(choices, degree) if 1 < degree <= left else None
        if polynomial is None or count[polynomial] >= limit:
            free = [each for each in pool if count[each] < limit]
            longer = [k for k, c in enumerate(chains) if c.degree <= left and c not in planted]
            if not free and longer:
                # Lengthening a chain does not need further ports.
                k = choices.option(longer)
                chains[k] = replace(chains[k], zones=(*chains[k].zones, chains[k].zones[-1]))
                left -= chains[k].degree
                continue
            fresh = ((-a, 1) for a in itertools.count() if not count[-a, 1])
            polynomial = choices.option(free) if free else next(fresh)
        d = len(polynomial) - 1
        length = choices.integer(1, min(left // d, 1 + states // 4))
        chains.append(Chain(polynomial, (zone,) * length))
        count[polynomial] += 1
        left -= d * length
        # Changing the zone is the simpler choice, so that no zone stays empty.
        zone = choices.option([*(z for z in zones if z != zone), zone])
    return chains


def finished(
    choices: Choices,
    draft: Draft,
    inputs: Sequence[int],
    outputs: Sequence[int],
    channels: int,
    time: str,
    denominators: bool = False,
) -> MultiChannelSystem:
    """Hide the structure by a change of basis, and make the system."""
    # Small examples may keep a readable basis; large ones never do.
    least = 2 * draft.n if draft.n > 12 else 0
    draft.hide(choices, choices.integer(least, 4 * draft.n))
    if denominators:
        draft.scales = [Fraction(choices.option((1, 1, 2, 3))) for _ in range(draft.n)]
    A, B, C = draft.matrices(inputs, outputs, channels)
    return MultiChannelSystem(A, B, C, time=time)


def as_polynomial(coefficients: Coefficients) -> Polynomial:
    return Polynomial(tuple(Fraction(c) for c in coefficients))
