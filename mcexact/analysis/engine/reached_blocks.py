"""Blocks that prove how much some channels control: what they control, feedback of them moves.

Modes that channels do not control are fixed, whatever the channels measure.  So the states that
they measure can be chosen, and one of them can measure everything.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from mcexact.analysis.engine.state_blocks import bounded_blocks
from mcexact.answer.evidence import Block, CoprimePolynomials, KrylovSequence
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem

Measured = tuple[tuple[int, ...], ...]
"""The states that each channel measures."""


def measured_blocks(
    system: MultiChannelSystem, T: Sequence[int]
) -> tuple[tuple[Block, ...], Measured]:
    """Blocks of the system of some channels that measure states.

    Parameters
    ----------
    system : MultiChannelSystem
    T : sequence of int
        Channels.

    Returns
    -------
    blocks : tuple of Block
        If the longest sequence is found, they leave n − d modes, d = dim ⟨A | B_T⟩, since the
        first channel with inputs measures all states, and every other channel states that its own
        inputs and those of the channel before it drive.  So what T reaches is one block.
    measured : tuple of tuple of int
    """
    driven = [_driven(system.B(i)) for i in T]
    live = [k for k, states in enumerate(driven) if states]
    chosen: list[set[int]] = [set() for _ in T]
    for before, k in pairwise(live):
        chosen[k] = {*driven[k], driven[before][0]}
    if live:
        chosen[live[0]] = set(range(system.n))
    measured = tuple(tuple(sorted(states)) for states in chosen)
    if not T:
        return (Block(tuple(range(system.n)), None),), measured
    part = MultiChannelSystem(
        system.A,
        [system.B(i) for i in T],
        [_picking(states, system.n) for states in measured],
        time=system.time,
        names=system.named(T),
    )
    return bounded_blocks(part, part.names[live[0] if live else 0]), measured


def _driven(B: Matrix) -> list[int]:
    """For each input the first state that it drives."""
    found: dict[int, int] = {}
    for a, row in enumerate(B.numerators):
        for j, entry in enumerate(row):
            if entry:
                found.setdefault(j, a)
    return sorted(set(found.values()))


def _picking(states: Sequence[int], n: int) -> Matrix:
    rows = [[int(a == state) for a in range(n)] for state in states]
    return Matrix.from_integers(rows, ncols=n)


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
