"""Two power areas joined by a line, sampled every tenth of a second, with messages a step late.

In each area the frequency deviation w follows M w' = -D w - T (angle difference) + u.  Area 1
measures its frequency, area 2 its frequency and the angle difference.  The plant is sampled
with inputs held; its ``source`` states how far the entries are rounded.
"""

from __future__ import annotations

from fractions import Fraction

from mcexact import (
    MultiChannelSystem,
    NeighborGraph,
    assess,
    check,
    design_extended,
    fixed_spectrum,
)
from mcexact.constructions import c2d, lifted_system

INERTIA = (Fraction(4), Fraction(6))
DAMPING = Fraction("0.4")
LINE = Fraction(2)
STEP = Fraction("0.1")


def plant() -> MultiChannelSystem:
    """States: frequency of area 1, frequency of area 2, angle difference."""
    M1, M2 = INERTIA
    return MultiChannelSystem(
        A=[
            [-DAMPING / M1, 0, -LINE / M1],
            [0, -DAMPING / M2, LINE / M2],
            [1, -1, 0],
        ],
        B=[[[1 / M1], [0], [0]], [[0], [1 / M2], [0]]],
        C=[[[1, 0, 0]], [[0, 1, 0], [0, 0, 1]]],
        names=["north", "south"],
        name="two areas",
    )


def main() -> None:
    """Sample, ask what the delay fixes, design."""
    sampled = c2d(plant(), STEP)
    late = NeighborGraph(sampled.names, [(1,), (0,)], delays=[(0, 1, 1), (1, 0, 1)])
    areas = sampled.with_neighbors(late)
    under_way = fixed_spectrum(lifted_system(areas, [0, 0]))
    print("Fixed with the messages under way as states: the roots of", under_way.polynomial)
    design = design_extended(areas, radius="19/20")
    print(f"Closed loop: {design.region} is {check(design.loop.proof).verdict}")
    print(assess(design).verdict)


if __name__ == "__main__":
    main()
