"""Links that may be added, and the signals that they carry; ``proofs/communication.md``."""

from fractions import Fraction

from .arithmetic import Matrix, diagonal
from .budget import spend
from .information_structure import neighbors_of
from .reading import Json, items, malformed, names, rational, require
from .system import System


def link(value: Json, place: str, system: System) -> tuple[int, int]:
    """A link [from, to], as positions of channels."""
    j, i = (names([end], place, system.names)[0] for end in items(value, place, 2))
    return j, i


def candidates(value: Json, system: System) -> list[tuple[int, int, Fraction]]:
    """The candidate links, which the graph lacks, with their costs."""
    place, N, found = "claim.candidates", neighbors_of(system, "claim"), []
    for *ends, price in (items(entry, place, 3) for entry in items(value, place)):
        found.append((*link(ends, place, system), rational(price, place)))
    keys = [(j, i) for j, i, _ in found]
    spend(len(keys) * (100 + system.m))
    if keys != sorted(set(keys)) or any(j in N[i] for j, i in keys):
        malformed(place, "expected links that the graph lacks, sorted, none twice")
    require(all(c > 0 for *_, c in found), "claim", place, "expected positive costs")
    return found


def carried(system: System, share: str, sizes: Json, j: int) -> Matrix:
    """S_j: C_j, diag(C_j, E_j') or [0, E_j'], the rows that a link from j adds to the outputs.

    Theorem ``allocation.communication_cut``.
    """
    C = Matrix.zeros(0, system.n) if share == "states" else system.C[j]
    if sizes is None:
        return C
    return diagonal(C, Matrix.unit_rows(sum(sizes), sum(sizes[:j]), sizes[j]))
