"""The box of a plant: all systems whose entries are within their radii, and what is made of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from .arithmetic import Matrix
from .covers import Cell
from .reading import Json, incomplete
from .region import Bound
from .subject import read_subject
from .system import System
from .uncertainty import read_radii

# fmt: off
COPYING = {
    "arcs", "augmented_outputs", "dual", "extended", "full_output", "held", "integrators",
    "lifted", "merged", "restricted",
}
# fmt: on
"""The constructions that only copy entries beside zeros and ones."""
LOOP = "closed_loop"
ALL = "for all values within their radii"
"""The words with which a statement about a box begins."""
NONE = System("", [], Matrix.zeros(0, 0), [], [])


@dataclass(frozen=True)
class Box(System):
    """All systems with |A − A_0| ≤ D_A, |B_i − B_i0| ≤ D_Bi, |C_i − C_i0| ≤ D_Ci in every entry.

    Its A, B_i and C_i are the values A_0, B_i0 and C_i0, ``radii`` has D_A, D_Bi and D_Ci.  For a
    closed loop ``plant`` is the box in the loop, and ``programs`` the controller.
    """

    radii: System = NONE
    plant: Box | None = None
    programs: Json = None

    def outside(self, bound: Bound) -> Callable[[Cell], bool]:
        """Whether modes may be in a cell, or are those of another one by conjugation."""
        return lambda cell: cell.outside(self.time, bound)


def at_values(plant: System) -> System:
    """The plant itself, which is named so where its values are uncertain."""
    if plant.uncertainty is None:
        return plant
    return replace(plant, words=f"{plant.words} at its nominal values")


def system_of(steps: Json, plant: System, kind: str) -> System:
    """The subject of a claim about a plant without parameters: a box for the kinds about boxes."""
    if kind.startswith("box_"):
        return box_of(steps, plant, kind)
    return read_subject(steps, at_values(plant))


def box_of(steps: Json, plant: System, kind: str) -> Box:
    """What constructions make from all plants within the radii.

    Open: see ``proofs/OPEN.md``.
    """
    center = read_subject(steps, plant)
    looped = kind == "box_stable" and [step["construction"] for step in steps[-1:]] == [LOOP]
    copied = steps[:-1] if looped else steps
    for k, step in enumerate(copied):
        if step["construction"] not in COPYING:
            message = f"{step['construction']} does more than copy entries"
            incomplete("construction", f"subject[{k}]", message)
    radii = _radii(copied, plant)
    if not looped:
        return Box(**vars(center), radii=radii)
    inside = Box(**vars(read_subject(copied, plant)), radii=radii)
    return Box(**vars(center), plant=inside, programs=steps[-1]["controller"])


def _radii(steps: Json, plant: System) -> System:
    """The radii of what is made: that of the radii, without the ones that are made."""
    nominal = [plant.A, *plant.B, *plant.C]
    found = read_radii(plant.uncertainty, plant.names, nominal)
    made, empty = (
        read_subject(steps, replace(plant, A=A, B=rest[: plant.m], C=rest[plant.m :]))
        for A, *rest in (found, [M.times(0) for M in found])
    )
    B, C = (
        [M - M_0 for M, M_0 in zip(*pair, strict=True)]
        for pair in ((made.B, empty.B), (made.C, empty.C))
    )
    return replace(made, A=made.A - empty.A, B=B, C=C)


def absolute(M: Matrix) -> Matrix:
    """The absolute values of all entries."""
    rows = [[abs(entry) for entry in row] for row in M.rows]
    return Matrix(rows, M.ncols, M.denominator)
