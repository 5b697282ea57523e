"""Blocks that prove how much some channels control: what they control, feedback of them moves.

Modes that channels do not control are fixed, whatever the channels measure.  So the states that
they measure can be chosen, and one of them can measure everything.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import pairwise

from mcexact.analysis.engine.state_blocks import bounded_blocks
from mcexact.answer.evidence import Block, CoprimePolynomials, KrylovSequence
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem

Measured = tuple[tuple[int, ...], ...]
"""The states that each channel measures."""


def measured_system(
    system: MultiChannelSystem, T: Sequence[int]
) -> tuple[MultiChannelSystem, Measured]:
    """The system of some channels, at least one, that measure states; and these states.

    Notes
    -----
    The first channel with inputs measures all states.  Every other channel measures states that its
    own inputs and those of the channel before it drive, and a share of all states that is drawn: so
    what T reaches is one block, and generic gains mostly move all that T controls, observed and
    controlled through that first channel.
    """
    driven = [_driven(system.B(i)) for i in T]
    live = [k for k, states in enumerate(driven) if states]
    chosen: list[set[int]] = [set() for _ in T]
    states = list(range(system.n))
    random.Random(system.n).shuffle(states)
    for share, (before, k) in enumerate(pairwise(live)):
        chosen[k] = {*driven[k], driven[before][0], *states[share :: len(live) - 1]}
    if live:
        chosen[live[0]] = set(range(system.n))
    measured = tuple(tuple(sorted(states)) for states in chosen)
    part = MultiChannelSystem(
        system.A,
        [system.B(i) for i in T],
        [_picking(states, system.n) for states in measured],
        time=system.time,
        names=system.named(T),
    )
    return part, measured


def measured_blocks(part: MultiChannelSystem) -> tuple[Block, ...]:
    """Blocks of a system of `measured_system`, which leave n − d modes if enough is found."""
    names = [c.name for c in part.channels if not c.B.is_zero()]
    return bounded_blocks(part, (names or part.names)[0])


def _driven(B: Matrix) -> list[int]:
    """For each input the first state that it drives."""
    found: dict[int, int] = {}
    for a, j, _ in B.nonzero():
        found.setdefault(j, a)
    return sorted(set(found.values()))


def _picking(states: Sequence[int], n: int) -> Matrix:
    return Matrix.from_entries((len(states), n), [(k, a, 1) for k, a in enumerate(states)])


def transposed_blocks(blocks: Sequence[Block]) -> tuple[Block, ...]:
    """The same evidence about the dual system: c Mᵏ b = b' M'ᵏ c', and arcs turn round."""
    return tuple(Block(block.states, _transposed(block.evidence)) for block in reversed(blocks))


def _transposed(
    found: KrylovSequence | CoprimePolynomials | None,
) -> KrylovSequence | CoprimePolynomials | None:
    if found is None:
        return None
    gains = tuple(F.T for F in found.gains)
    if isinstance(found, CoprimePolynomials):
        return CoprimePolynomials(gains, found.modulus)
    return KrylovSequence(
        modulus=found.modulus,
        gains=gains,
        channel=found.channel,
        inputs=found.outputs,
        outputs=found.inputs,
        recurrence=found.recurrence,
        cofactors=found.cofactors,
    )
