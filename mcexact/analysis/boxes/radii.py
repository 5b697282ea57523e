"""The radii of the entries of a plant, or of a system that constructions made from it."""

from __future__ import annotations

from mcexact.answer.reading import constructed
from mcexact.errors import UsageError
from mcexact.model.box import Box
from mcexact.model.system import MultiChannelSystem
from mcexact.model.uncertainty import Radii

COPYING = frozenset(
    {
        "arcs",
        "augmented_outputs",
        "dual",
        "extended",
        "full_output",
        "held",
        "integrators",
        "lifted",
        "merged",
    }
)
"""The constructions whose results have entries of the plant, each as it is, and constants."""


def radii_of(system: MultiChannelSystem) -> Radii:
    """Return the radii of all entries of a system; those of constants are 0.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, or a system made from one by constructions that copy entries.

    Raises
    ------
    UsageError
        If a construction computes with entries: radii do not determine those of its result.

    Notes
    -----
    A construction that copies entries is affine in them, so the radii of its result are the
    construction applied to the radii, less the construction applied to zeros.

    Examples
    --------
    >>> from mcexact import dual
    >>> plant = MultiChannelSystem([[1]], [[[2, 3]]], [[[4]]])
    >>> radii_of(dual(Box.relative(plant, "1/2").system)).C[0].numerators
    ((2,), (3,))
    """
    radii = Box(system.plant).radii
    if not system.subject:
        return radii
    for each in system.subject:
        if each["construction"] not in COPYING:
            raise UsageError(
                f"the construction {each['construction']!r} computes with uncertain entries"
            )
    zeros = radii * 0
    made, base = (_constructed(system, each) for each in (radii, zeros))
    return Radii(
        made.A - base.A,
        [M - N for M, N in zip(made.B, base.B, strict=True)],
        [M - N for M, N in zip(made.C, base.C, strict=True)],
    )


def _constructed(system: MultiChannelSystem, entries: Radii) -> MultiChannelSystem:
    """What the constructions of a system make of other matrices."""
    plant = system.plant
    given = MultiChannelSystem(
        entries.A,
        entries.B,
        entries.C,
        time=plant.time,
        names=plant.names,
        neighbors=plant.neighbors,
    )
    made: MultiChannelSystem = constructed(given, system.subject)
    return made
