"""The box of a plant: all systems whose entries are within their radii, and what is made of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from . import budget
from .arithmetic import Matrix
from .covers import Cell
from .reading import Json, incomplete
from .region import Bound
from .statement import digest
from .subject import read_subject
from .system import System
from .uncertainty import pairs_of, radii_in_words, read_radii

LOOP = "closed_loop"
NONE = System("", [], Matrix.zeros(0, 0), [], [])


@dataclass(frozen=True)
class Box(System):
    """All systems with |A − A_0| ≤ D_A, |B_i − B_i0| ≤ D_Bi, |C_i − C_i0| ≤ D_Ci in every entry.

    Its A, B_i and C_i are the values A_0, B_i0 and C_i0, ``radii`` has D_A, D_Bi and D_Ci.  Each of
    ``tied`` may be added to the values with a factor from −1 to 1.  For a closed loop ``plant`` is
    the box in the loop, and ``programs`` the controller.  ``members`` are the words with which a
    statement about all of them begins.
    """

    radii: System = NONE
    tied: tuple[System, ...] = ()
    plant: Box | None = None
    programs: Json = None
    members: str = ""

    def independent(self) -> Box:
        """A box without ties that contains all members."""
        radii = self.radii
        for each in self.tied:
            radii = _combined(radii, _sizes(each), 1)
        return replace(self, radii=radii, tied=())

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
    computed = steps[:-1] if looped else steps
    for k, step in enumerate(computed):
        if step["construction"] == LOOP:
            message = "a closed loop is the last construction, for the kind box_stable alone"
            incomplete("construction", f"subject[{k}]", message)
    radii, members = _radii(computed, plant), members_in_words(plant)
    if not looped:
        return Box(**vars(center), radii=radii, members=members)
    inside = Box(**vars(read_subject(computed, plant)), radii=radii)
    programs = steps[-1]["controller"]
    return Box(**vars(center), plant=inside, programs=programs, members=members)


def members_in_words(plant: System) -> str:
    """All plants within the radii, by the digest of the plant without radii and their size."""
    if plant.uncertainty is None:
        return "for this plant alone, as none of its entries has a radius"
    values = digest(replace(plant, uncertainty=None))
    nominal = [plant.A, *plant.B, *plant.C]
    pairs = pairs_of(nominal, read_radii(plant.uncertainty, plant.names, nominal))
    near = radii_in_words(pairs, f"the radii of {plant.words}")
    return f"for all plants whose entries differ from those of the plant {values} {near}"


def _radii(steps: Json, plant: System) -> System:
    """The radii of what is made: by how much larger absolute values make it larger.

    Each construction adds and multiplies; it is applied to absolute values, those of gains too,
    and to the same with the radii added.
    """
    radii = read_radii(plant.uncertainty, plant.names, [plant.A, *plant.B, *plant.C])
    A, *ports = radii
    D = replace(plant, A=A, B=ports[: plant.m], C=ports[plant.m :])
    if not steps:
        return D
    low, high = ends(plant, D)
    for step in steps:
        sizes = [_of_sizes(step)]
        low, high = (_sizes(read_subject(sizes, each)) for each in (low, high))
    return _combined(high, low, -1)


def ends(system: System, radii: System) -> tuple[System, System]:
    """The absolute values of all entries, and the largest that are within the radii."""
    low = _sizes(system)
    return low, _combined(low, radii, 1)


def _of_sizes(step: Json) -> Json:
    """A construction that was applied already, with the absolute values of its gains."""
    if "gains" not in step:
        return step
    sizes = [{**F, "entries": [[*map(abs, row)] for row in F["entries"]]} for F in step["gains"]]
    return {**step, "gains": sizes}


def _combined(first: System, second: System, factor: int) -> System:
    """The entries of the first system and so many times those of the second one."""
    parts = ((first.A, *first.B, *first.C), (second.A, *second.B, *second.C))
    return _of_parts(first, [M + N.times(factor) for M, N in zip(*parts, strict=True)])


def _sizes(system: System) -> System:
    """The absolute values of all entries."""
    return _of_parts(system, list(map(absolute, (system.A, *system.B, *system.C))))


def _of_parts(system: System, parts: list[Matrix]) -> System:
    """The system with these A, B_i and C_i, of which there may be fewer than channels."""
    A, *ports = parts
    return replace(system, A=A, B=ports[: len(system.B)], C=ports[len(system.B) :])


def absolute(M: Matrix) -> Matrix:
    """The absolute values of all entries."""
    budget.spend(budget.table(M.nrows, M.ncols, M.limbs))
    rows = [[abs(entry) for entry in row] for row in M.rows]
    return Matrix(rows, M.ncols, M.denominator)
