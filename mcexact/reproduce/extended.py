"""Section IV-C: extended systems."""

from __future__ import annotations

from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.derived.constructions import Share, extended_system
from mcexact.reproduce.equations import messages_agree
from mcexact.reproduce.material import (
    PAPER,
    Numbers,
    plants,
    three_channels,
    with_dimensions,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import unreached

SHARING: tuple[Share, ...] = ("outputs+states", "states")


def construction(note: Notebook) -> None:
    """(24) and (25)."""
    numbers = Numbers(14)
    for (name, plant), sizes in with_dimensions(plants(10, connected=None)):
        for share in SHARING:
            note.on(f"{name}, {share}", plant)
            made = extended_system(plant, sizes, share)
            note.check("there are n + Σ n_i states", made.n == plant.n + sum(sizes))
            note.check(
                "ẋ_i = v_i, and agents see what (25) says",
                messages_agree(plant, made, sizes, share, {}, numbers),
            )
            note.certify(fixed_spectrum(made))
    note.on(PAPER)
    plant, sizes = three_channels(), [1, 2, 1]
    made = extended_system(plant, sizes)
    backwards = plant.with_neighbors({"1": ["3"], "2": ["1"], "3": ["2"]})
    share = "outputs+states"
    note.refute("followers", not messages_agree(backwards, made, sizes, share, {}, numbers))
    note.refute("no-outputs", not messages_agree(plant, made, sizes, "states", {}, numbers))


def any_graph(note: Notebook) -> None:
    """Jointly controllable and observable for every graph."""
    for name, plant in (*plants(5, connected=None), *plants(1, connected=False)):
        for share in SHARING:
            note.on(f"{name}, {share}", plant)
            made = extended_system(plant, [1] * plant.m, share)
            note.joint(made)
    plant = note.at(unreached())
    found = joint_controllability(extended_system(plant, [1, 1]))
    note.refute("any-plant", not found.controllable)
    note.certify(found)


PROCEDURES: dict[str, Procedure] = {
    "equations-24-25": construction,
    "extended-joint": any_graph,
}
