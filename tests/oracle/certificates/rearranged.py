"""Constructions that only place entries, applied to plants with a parameter as affine functions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import fmpq_mat, fmpq_poly

from .one_parameter import Function, ParametricPlant, in_lowest_terms
from .reading import demand
from .systems import System

Built = Callable[[System, Sequence[Any]], System]
REARRANGING = (
    "arcs", "augmented_outputs", "dual", "extended", "full_output", "integrators", "merged",
    "restricted",
)  # fmt: skip


def rearranged(plant: ParametricPlant, steps: Sequence[Any], built: Built) -> ParametricPlant:
    """What constructions make: c + Σ e (c_e − c) for entries e, c_e made from 1 in its place."""
    for step in steps:
        demand(isinstance(step, Mapping), "expected a construction")
        demand(step.get("construction") in REARRANGING, "expected one that only places entries")
    if not steps:
        return plant

    def made(place: tuple[int, int, int] | None) -> System:
        tables = [fmpq_mat(nrows, ncols) for _, nrows, ncols in plant.tables]
        if place is not None:
            k, i, j = place
            tables[k][i, j] = 1
        A, *ports = tables
        alone = tuple((i,) for i in range(plant.m))
        start = System(
            plant.time, A, plant.names, tuple(ports[0::2]), tuple(ports[1::2]), neighborhoods=alone
        )
        return built(start, steps)

    def matrices(system: System) -> list[fmpq_mat]:
        ports = [M for pair in zip(system.B, system.C, strict=True) for M in pair]
        return [system.A, *ports]

    base = made(None)
    zero, one = fmpq_poly([]), fmpq_poly([1])
    found = [
        [[(fmpq_poly([M[i, j]]), one) for j in range(M.ncols())] for i in range(M.nrows())]
        for M in matrices(base)
    ]
    for k, (rows, _, _) in enumerate(plant.tables):
        for i, row in enumerate(rows):
            for j, (top, bottom) in enumerate(row):
                if top == zero:
                    continue
                others = zip(matrices(made((k, i, j))), matrices(base), found, strict=True)
                for M, N, table in others:
                    for a in range(M.nrows()):
                        for b in range(M.ncols()):
                            c = M[a, b] - N[a, b]
                            if c != 0:
                                table[a][b] = _sum(table[a][b], (top * c, bottom))
    shapes = [(M.nrows(), M.ncols()) for M in matrices(base)]
    tables = tuple((rows, *shape) for rows, shape in zip(found, shapes, strict=True))
    return replace(plant, names=base.names, tables=tables)


def _sum(first: Function, second: Function) -> Function:
    """The sum of two functions, in lowest terms with a monic denominator."""
    top = first[0] * second[1] + second[0] * first[1]
    bottom = first[1] * second[1]
    return in_lowest_terms(top, bottom)
