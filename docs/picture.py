"""Draws the picture of README.md: the canal of the tutorial without and with its one link.

python docs/picture.py
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch
from scipy.linalg import expm

from mcexact import MultiChannelSystem, design_extended
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import local_controllers

RED, BLUE, GRAY = "#c44e1c", "#2a6fb0", "#777777"
PLACES = {"gate": (-1.0, 0.0), "farm": (1.0, 0.0)}


def canal() -> MultiChannelSystem:
    """The plant of the tutorial."""
    return MultiChannelSystem(
        A=[["-1/2", 0, 0], ["1/10", 0, 0], [0, "1/20", "-1/5"]],
        B=[[["1/2"], [0], [0]], [[0], [0], ["1/10"]]],
        C=[[[1, 0, 0]], [[0, 1, 0], [0, 0, 1]]],
        names=["gate", "farm"],
    )


def arrow(axis: Axes, start: str, end: str, bend: float, **style: Any) -> None:
    """Draw a bent arrow between two agents."""
    axis.add_patch(
        FancyArrowPatch(
            PLACES[start],
            PLACES[end],
            connectionstyle=f"arc3,rad={bend}",
            arrowstyle="-|>",
            mutation_scale=15,
            shrinkA=34,
            shrinkB=34,
            linewidth=1.6,
            **style,
        )
    )


def draw_agents(axis: Axes) -> None:
    """Who influences whom, and the link that is added."""
    arrow(axis, "gate", "farm", -0.35, color=GRAY)
    arrow(axis, "farm", "gate", -0.35, color=BLUE, linestyle=(0, (4, 2)))
    for name, place in PLACES.items():
        axis.add_patch(Circle(place, 0.42, facecolor="white", edgecolor="black", zorder=3))
        axis.text(*place, name, ha="center", va="center", zorder=4)
    axis.text(0, 0.62, "moves the pond", ha="center", color=GRAY)
    axis.text(0, -0.76, "one radio link", ha="center", color=BLUE)
    axis.text(0, 1.12, "The level of the pond is a fixed mode:", ha="center", color=RED)
    axis.text(0, 0.92, "farm sees it, gate moves it", ha="center", color=RED)
    axis.set(xlim=(-1.6, 1.6), ylim=(-1.0, 1.3), aspect="equal")
    axis.set_axis_off()


def draw_pond(axis: Axes) -> None:
    """The level of the pond, too high by 1, without the link and with it."""
    plant = canal()
    alone = local_controllers(plant, [[["-1/2"]], [["-1/20", "-1/4"]]])
    linked = plant.with_neighbors({"gate": ["farm"]})
    times = np.linspace(0, 60, 400)
    for controller, color, name in (
        (alone, RED, "without the link, under any gains"),
        (design_extended(linked, rate="1/10").controller, BLUE, "with it, certified: Re λ < −1/10"),
    ):
        M = np.array(closed_loop(linked, controller).matrix, dtype=float)
        start = np.zeros(len(M))
        start[1] = 1.0
        level = [(expm(M * t) @ start)[1] for t in times]
        axis.plot(times, level, color=color, linewidth=1.8)
        axis.text(59, level[-1] + 0.07, name, color=color, ha="right")
    axis.set(xlabel="time in minutes", ylabel="level of the pond", ylim=(-0.25, 1.25))
    axis.spines[["top", "right"]].set_visible(False)


def main() -> None:
    """Write the picture."""
    figure = Figure(figsize=(9.0, 3.0), layout="constrained", facecolor="white")
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.25))
    draw_agents(left)
    draw_pond(right)
    with matplotlib.rc_context({"svg.hashsalt": "mcexact", "svg.fonttype": "path"}):
        figure.savefig(
            Path(__file__).parent / "_static" / "canal.svg",
            metadata={"Date": None, "Creator": None},
        )


if __name__ == "__main__":
    main()
