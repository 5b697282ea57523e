"""The kinds about boxes on segments between two members, on which every plant is decided."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from itertools import count
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly

from . import boxes
from .loops import bound_of
from .one_parameter import ParametricPlant, Rows, characteristic, interpolated
from .ranges import driven, none_fixed, stays_inside
from .reading import listed, positions
from .systems import System, read_plant

ACROSS, EDGES = 1, 1
"""How many segments lead from a vertex to the opposite one, and how many to a neighbor."""
SAMPLES = 8
"""Into how many parts a segment is divided: entries of a smaller degree are found."""


def fixed(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """No member has a fixed mode outside of the region."""
    found = segments(document)
    return boxes.fixed(claim, document, system) and all(
        none_fixed(line, claim["bound"]) for line in found
    )


def controllable(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The channels leave no member an uncontrollable mode outside of the region."""
    if not boxes.controllable(claim, document, system):
        return False
    T = positions(claim["channels"], system.names)
    return all(none_fixed(driven(line, T), claim["bound"]) for line in segments(document))


def stable(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """Every eigenvalue of every member lies in the region."""
    if not boxes.stable(claim, document, system):
        return False
    bound = bound_of(claim["bound"], system.time)
    return all(
        stays_inside(characteristic(line, []), line, bound)
        for line in segments(document, claim["gain_radii"], ports=False)
    )


def segments(
    document: Mapping[str, Any], gain_radii: Any = None, *, ports: bool = True
) -> Iterator[ParametricPlant]:
    """The subjects of all members on some segments, by a parameter from 0 to 1.

    Parameters
    ----------
    ports : bool
        Whether B and C are asked for; they are left out of a loop.
    """
    plant, steps = read_plant(document["system"]), listed(document["subject"])

    def at(shares: Iterator[fmpq]) -> System:
        return boxes.with_gains(boxes.member(plant, shares), steps, gain_radii, shares)

    rng, places = random.Random(12), count()
    at(fmpq(0) for _ in places)
    size = next(places)
    for k in range((ACROSS + EDGES) * (size > 0)):
        first = [rng.choice((-1, 1)) for _ in range(size)]
        turned = range(size) if k < ACROSS else [rng.randrange(size)]
        moves = [-2 * share if i in turned else 0 for i, share in enumerate(first)]
        systems = [
            at(x + fmpq(t, SAMPLES) * move for x, move in zip(first, moves, strict=True))
            for t in range(SAMPLES + 1)
        ]
        found = along(systems, ports=ports)
        if found is not None:
            yield found


def along(systems: Sequence[System], *, ports: bool) -> ParametricPlant | None:
    """The plant by its entries, polynomials in t, from values at equal distances from 0 to 1.

    The last value is left for a test: polynomials of higher degree are given up.
    """
    A, *_ = systems
    points = [fmpq(t, len(systems) - 1) for t in range(len(systems))]
    tables: list[tuple[Rows, int, int]] = []
    for each in zip(*(matrices(system, ports=ports) for system in systems), strict=True):
        nrows, ncols = each[0].nrows(), each[0].ncols()
        rows: Rows = []
        for i in range(nrows):
            entries = [
                interpolated(points[:-1], [M[i, j] for M in each[:-1]]) for j in range(ncols)
            ]
            if any(p(points[-1]) != each[-1][i, j] for j, p in enumerate(entries)):
                return None
            rows.append([(p, fmpq_poly([1])) for p in entries])
        tables.append((rows, nrows, ncols))
    names = A.names if ports else ()
    return ParametricPlant(A.time, names, "t", (fmpq(0), fmpq(1)), tuple(tables))


def matrices(system: System, *, ports: bool) -> list[fmpq_mat]:
    """A, and B_1, C_1, … if they are asked for."""
    pairs = zip(system.B, system.C, strict=True) if ports else ()
    return [system.A, *(M for pair in pairs for M in pair)]


JUDGES = {
    "box_controllable": controllable,
    "box_fixed": fixed,
    "box_stable": stable,
}
"""The judge of each kind."""
