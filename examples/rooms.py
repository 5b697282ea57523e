"""Three rooms in a row, each with a heater and a thermostat.

A room of heat capacity 360 kJ/K = 0.1 kWh/K loses heat to the outside, and exchanges heat with the
rooms next to it through the walls.  States are temperatures in K above the outside, inputs are
heating powers in kW, and time is in hours.
"""

from __future__ import annotations

from fractions import Fraction

from mcexact import MultiChannelSystem, check, design_setpoint, setpoint_solvability

CAPACITY = Fraction("0.1")  # kWh/K
OUTSIDE = Fraction("0.02")  # kW/K
WALL = Fraction("0.15")  # kW/K
ROOMS = ("west", "middle", "east")


def plant() -> MultiChannelSystem:
    """States: the temperatures of the rooms."""
    n = len(ROOMS)
    A = [[Fraction(0)] * n for _ in ROOMS]
    for i in range(n):
        walls = [j for j in (i - 1, i + 1) if 0 <= j < n]
        A[i][i] = -(OUTSIDE + WALL * len(walls)) / CAPACITY
        for j in walls:
            A[i][j] = WALL / CAPACITY
    unit = [[int(i == j) for j in range(n)] for i in range(n)]
    return MultiChannelSystem(
        A,
        B=[[[entry / CAPACITY] for entry in row] for row in unit],
        C=[[row] for row in unit],
        names=ROOMS,
        neighbors={"west": ["middle"], "middle": ["west", "east"], "east": ["middle"]},
        name="three rooms",
    )


def main() -> None:
    """Ask whether every set-point can be held, and design for it."""
    rooms = plant()
    print("Every set-point can be held:", setpoint_solvability(rooms).solvable)
    design = design_setpoint(rooms, rate="1/2")
    print(f"Closed loop: {design.region} is {check(design.loop.proof).verdict}")
    for agent in design.controller.agents:
        print(f"{agent.name}: {agent.shared + agent.private} states of its own")


if __name__ == "__main__":
    main()
