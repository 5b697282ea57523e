"""Certificates of every kind for plants of the gallery, written as the command line writes them.

Run as ``python -m tests.answer.written FOLDER``; a subfolder for each plant and question.
"""

from __future__ import annotations

import sys
from pathlib import Path

from mcexact.analysis.boxes.loops import box_stability
from mcexact.analysis.boxes.margins import box_disk_margin
from mcexact.analysis.boxes.members import box_controllability, box_fixed_modes
from mcexact.analysis.controllability import exceptional_gains
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.patterns import structural_fixed_modes
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer.protocol import save_certificate
from mcexact.cli import main
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.box import Box
from mcexact.model.files import save_system
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem

PLANTS = ("liu2020-3ch-extended-n1", "lexalutyi-two-double-integrators")
DESIGNS = ("observer", "decentralized", "extended", "setpoint")


def questions(plant: str, channel: str, place: Path, whole: bool) -> dict[str, list[str]]:
    """What is asked on the command line, by the names of the subfolders; every design if whole."""
    observer = str(place / "observer-exact.controller")
    asked = {
        "analyze": [plant, "--minimal", "--subset", channel, "--channel", channel],
        "analyze-gains": [plant, "--every-channel"],
        "allocate": [plant, "--free"],
        "allocate-links": [plant, "--links"],
    }
    for design in DESIGNS if whole else ("observer",):
        for arithmetic in ("exact", "float"):
            name = f"{design}-{arithmetic}"
            # The gains of a search depend on the kernel, as do all gains in floating point.
            alone = ["--effort=0"] if arithmetic == "exact" and design != "observer" else []
            options = [
                *alone,
                "--rate=1",
                "--arithmetic",
                arithmetic,
                "-o",
                str(place / f"{name}.controller"),
            ]
            asked[f"design-{name}"] = [design, plant, *options]
    asked["certify"] = [plant, observer, "--rate=1"]
    asked["certify-lyapunov"] = [plant, observer, "--rate=1", "--method=lyapunov"]
    asked["certify-instability"] = [plant, observer, "--rate=50", "--method=lyapunov"]
    return asked


def write_all(folder: Path) -> None:
    """Write them."""
    for name in PLANTS:
        plant = with_graph(gallery.load(name))
        place = folder / name
        place.mkdir()
        save_system(plant, folder / f"{name}.json")
        asked = questions(
            str(folder / f"{name}.json"), plant.names[0], place, whole=name == PLANTS[0]
        )
        for question, arguments in asked.items():
            command = question.partition("-")[0]
            try:
                main([command, *arguments, "--certificates", str(place / question)])
            except SystemExit as ended:
                # A proved no has its certificates too.
                if ended.code not in (0, 1):
                    raise
        ones = Matrix.from_integers([[1] * plant.n for _ in range(plant.n)])
        found = exceptional_gains(ones, plant.A, plant.input_matrix())
        save_certificate(found.controllability_set, place / "exceptional_gains.json")
    free = ParametricSystem([["t", 1], [0, 2]], [[[1], ["t"]]], [[[1, 0]]], parameters=["t"])
    place = folder / "with-a-parameter"
    place.mkdir()
    save_certificate(fixed_spectrum(free), place / "parametric_fixed_spectrum.json")
    save_certificate(setpoint_solvability(free), place / "parametric_rank.json")
    unstable = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    save_certificate(structural_fixed_modes(unstable), place / "structural_fixed_modes.json")
    near = Box.relative(unstable, "1/10").system
    place = folder / "with-radii"
    place.mkdir()
    save_certificate(box_fixed_modes(near), place / "box_fixed.json")
    save_certificate(box_controllability(near), place / "box_controllable.json")
    kept = box_stability(near, local_controllers(unstable, [[[-3]]]))
    save_certificate(kept, place / "box_stable.json")
    margin = box_disk_margin(near, local_controllers(unstable, [[[-3]]]), margin="1/2")
    save_certificate(margin, place / "box_disk_margin.json")
    ranged = ParametricSystem(
        [["t", 1], [0, 2]], [[[1], ["t"]]], [[[1, 0]]], parameters=["t"], assume={"t": ("3/2", 2)}
    )
    save_certificate(box_fixed_modes(ranged), place / "parametric_box_fixed.json")
    save_certificate(box_controllability(ranged), place / "parametric_box_controllable.json")
    spring = ParametricSystem(
        [["k"]], [[["k"]]], [[[1]]], parameters=["k"], assume={"k": ("1/2", 2)}
    )
    kept_in_range = box_stability(spring, local_controllers(unstable, [[[-3]]]))
    save_certificate(kept_in_range, place / "parametric_box_stable.json")


def with_graph(plant: MultiChannelSystem) -> MultiChannelSystem:
    """The plant over its own graph, or over a ring."""
    if plant.neighbors is not None:
        return plant
    return plant.with_neighbors(NeighborGraph.ring(plant.names))


if __name__ == "__main__":
    write_all(Path(sys.argv[1]))
