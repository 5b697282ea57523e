"""An irrigation canal: a gate fills a pond, and only the farm at its end sees the level.

The gate follows its command with a time constant of 2 minutes.  The pond has an area of 10 of the
units in which the flow of a minute is measured, and the farm's tank fills from the pond and is
emptied by a pump.  All states are deviations from where they should be; time is in minutes.
"""

from __future__ import annotations

from fractions import Fraction

from mcexact import (
    MultiChannelSystem,
    analyze,
    assess,
    check,
    design_extended,
    minimal_communication,
)

GATE_TIME = Fraction(2)
POND_AREA = Fraction(10)
INLET = Fraction("0.05")
TANK_RATE = Fraction("0.2")
PUMP = Fraction("0.1")


def plant() -> MultiChannelSystem:
    """States: flow through the gate, level of the pond, level of the tank."""
    return MultiChannelSystem(
        A=[[-1 / GATE_TIME, 0, 0], [1 / POND_AREA, 0, 0], [0, INLET, -TANK_RATE]],
        B=[[[1 / GATE_TIME], [0], [0]], [[0], [0], [PUMP]]],
        C=[[[1, 0, 0]], [[0, 1, 0], [0, 0, 1]]],
        names=["gate", "farm"],
        name="irrigation canal",
    )


def main() -> None:
    """Ask, repair, design."""
    canal = plant()
    for sentence in analyze(canal).sentences.at("answer"):
        print(sentence)
    added = minimal_communication(canal).added
    print("Links to add:", ", ".join(f"{start} → {end}" for start, end in added))
    linked = canal.with_neighbors({end: [start] for start, end in added})
    design = design_extended(linked, rate="1/10")
    print(f"Closed loop: {design.region} is {check(design.loop.proof).verdict}")
    print(assess(design).verdict)


if __name__ == "__main__":
    main()
