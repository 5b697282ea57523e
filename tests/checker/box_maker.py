"""Certificates about boxes of tiny plants, made slowly with rational numbers alone.

Every cell that has to be proved gets a frame of its own, from the exact inverse at its center.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from operator import mul
from typing import Any

from mcexact.checker.boxes import augmented, segments_of
from mcexact.checker.cells import cells_of, members_of_cell
from mcexact.checker.cells import subject_of as read_subject
from mcexact.checker.core.arithmetic import Matrix, absolute, beside
from mcexact.checker.core.evidence import inputs
from mcexact.checker.core.system import read_plant
from mcexact.checker.discs import (
    ROOT_2,
    Box,
    Cell,
    Pencil,
    Regular,
    left_inverse,
    loop_pencil,
    right_inverse,
    system_of,
)
from mcexact.checker.parametric_system import plant_of
from tests.checker.handmade import Document, certificate, matrix

Rows = list[list[Fraction]]
Node = int | None
Frames = Iterator[tuple[Document, Regular]]
DENOMINATOR = 2**16
DEEPEST = 5


def fractions(M: Any) -> Rows:
    """The rows of a matrix of the checker."""
    return [[Fraction(entry, M.denominator) for entry in row] for row in M.rows]


def solved(M: Rows, R: Rows) -> Rows:
    """The X with M X = R, M square and not singular."""
    n = len(M)
    rows = [[*m, *r] for m, r in zip(M, R, strict=True)]
    for k in range(n):
        pivot = next((i for i in range(k, n) if rows[i][k]), None)
        if pivot is None:
            raise ArithmeticError("a singular matrix")
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [entry / rows[k][k] for entry in rows[k]]
        for i in range(n):
            if i != k and rows[i][k]:
                rows[i] = [a - rows[i][k] * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [row[n:] for row in rows]


def in_reals(re: Rows, im: Rows) -> Rows:
    """[re, −im; im, re]."""
    above = [[*x, *(-v for v in y)] for x, y in zip(re, im, strict=True)]
    return above + [[*y, *x] for x, y in zip(re, im, strict=True)]


def rounded(M: Rows, nrows: int, ncols: int) -> Document:
    """The complex matrix of the first columns of [re, …; im, …]."""
    whole = [[round(entry * DENOMINATOR) for entry in row[:ncols]] for row in M]
    return {"denominator": DENOMINATOR, "re": whole[:nrows], "im": whole[nrows:]}


def unit(size: int) -> Rows:
    """The identity matrix."""
    return [[Fraction(i == j) for j in range(size)] for i in range(size)]


def shifted(pencil: Pencil, re: Fraction, im: Fraction) -> Rows:
    """cE − Z in reals."""
    Z, n = fractions(pencil.Z), pencil.dynamic
    real = [[(re if i == j < n else 0) - z for j, z in enumerate(row)] for i, row in enumerate(Z)]
    imaginary = [
        [im if i == j < n else Fraction(0) for j in range(len(row))] for i, row in enumerate(Z)
    ]
    return in_reals(real, imaginary)


def inverse_at(pencil: Pencil, re: Fraction, im: Fraction) -> Document:
    """V, about the inverse of cE − Z."""
    M = shifted(pencil, re, im)
    return rounded(solved(M, unit(len(M))), len(M) // 2, len(M) // 2)


def right_inverse_at(pencil: Pencil, re: Fraction, im: Fraction) -> Document:
    """R, about the right inverse of least squares of cE − Z."""
    M = shifted(pencil, re, im)
    turned = [list(column) for column in zip(*M, strict=True)]
    gram = [[sum(map(mul, x, y)) for y in M] for x in M]
    back = solved(gram, unit(len(M)))
    R = [[sum(map(mul, x, y)) for y in zip(*back, strict=True)] for x in turned]
    return rounded(R, pencil.Z.ncols, pencil.dynamic)


def times(M: Rows, N: Rows) -> Rows:
    """The product."""
    return [[sum(map(mul, x, y)) for y in zip(*N, strict=True)] for x in M]


def gershgorin(box: Box, F: list[list[list[Any]]] | None = None) -> Document:
    """The discs of the rows of A, or of A_F for some F_i, by Y = T = I."""
    n = box.n
    A, D, one = fractions(box.A), fractions(box.radii.A), unit(n)
    for i, F_i in enumerate(F or []):
        gain = [[Fraction(entry) for entry in row] for row in F_i]
        B, C, D_B, D_C = (
            fractions(M) for M in (box.B[i], box.C[i], box.radii.B[i], box.radii.C[i])
        )
        # the farthest of |B| + D_B, |F| and |C| + D_C, less what is there without radii
        most, size = (
            times([[abs(x) + d for x, d in zip(*pair, strict=True)] for pair in left], right)
            for left, right in (
                (zip(B, D_B, strict=True), sizes(gain)),
                (zip(C, D_C, strict=True), unit(n)),
            )
        )
        around = times(times(sizes(B), sizes(gain)), sizes(C))
        moved, far = times(times(B, gain), C), times(most, size)
        A = [[x + y for x, y in zip(*pair, strict=True)] for pair in zip(A, moved, strict=True)]
        D = [
            [d + x - y for d, x, y in zip(*rows, strict=True)]
            for rows in zip(D, far, around, strict=True)
        ]
    identity = {"denominator": 1, "re": [list(map(int, row)) for row in one], "im": [[0] * n] * n}
    discs = []
    every = [D, *(fractions(absolute(each.A)) for each in box.tied)]
    for i in range(n):
        own = sum((sum(M[i], Fraction(0)) for M in every), Fraction(0))
        center = Fraction(round(A[i][i] * 1000), 1000)
        spread = sum((abs(A[i][j]) for j in range(n) if j != i), own + abs(A[i][i] - center))
        radius = (int(spread * 10**4) + 1) / 10**4
        discs.append({"re": decimal(center), "im": "0", "radius": decimal(Fraction(str(radius)))})
    written = None if F is None else [eighths(F_i) for F_i in F]
    return {"F": written, "Y": identity, "T": identity, "discs": discs}


def eighths(F: list[list[Any]]) -> Document:
    """A matrix of gains."""
    return matrix(*([int(8 * Fraction(entry)) for entry in row] for row in F), denominator=8)


def sizes(M: Rows) -> Rows:
    """The absolute values of all entries."""
    return [[abs(entry) for entry in row] for row in M]


def apart(cell: Cell, disc: Document) -> bool:
    """Whether a cell has no point in common with a disc."""
    re, im, radius = (Fraction(disc[key]) for key in ("re", "im", "radius"))
    if not cell.square:
        return (re - cell.re) ** 2 + (im - cell.im) ** 2 > (radius + cell.size) ** 2
    x = min(max(re, cell.re - cell.size), cell.re + cell.size)
    y = min(max(im, cell.im - cell.size), cell.im + cell.size)
    return (re - x) ** 2 + (im - y) ** 2 > radius**2


def decimal(value: Fraction) -> str:
    """A decimal of at most six digits behind its point."""
    sign, scaled = "-" if value < 0 else "", abs(value) * 10**6
    assert scaled.denominator == 1
    return f"{sign}{int(scaled) // 10**6}.{int(scaled) % 10**6:06d}"


def covered(
    exterior: list[Document],
    outside: Callable[[Cell], bool],
    frames_at: Callable[[Fraction, Fraction], Frames],
) -> tuple[list[Document], list[list[Node]]]:
    """Frames, and the nodes of every disc: a cell is cut where its own frame does not do.

    ``frames_at`` gives frames about a center, each with what decides by it.
    """
    frames: list[Document] = []
    cover = []
    for disc in exterior[0]["discs"]:
        re, im, radius = (Fraction(disc[key]) for key in ("re", "im", "radius"))
        cells = [(Cell(re, im, radius, False), 0)]
        nodes: list[Node] = []
        while cells:
            cell, depth = cells.pop()
            others = (each["discs"] for each in exterior[1:])
            if outside(cell) or any(all(apart(cell, d) for d in discs) for discs in others):
                continue
            for frame, regular in _all_of(frames_at, cell):
                if regular(cell.re, cell.im, cell.size * (ROOT_2 if cell.square else 1)):
                    nodes.append(len(frames))
                    frames.append(frame)
                    break
            else:
                if depth == DEEPEST:
                    raise ArithmeticError("no cover found")
                nodes.append(None)
                cells += [(part, depth + 1) for part in cell.parts()]
        cover.append(nodes)
    return frames, cover


def _all_of(frames_at: Callable[[Fraction, Fraction], Frames], cell: Cell) -> Frames:
    """The frames about the center of a cell, up to one whose pencil is singular there."""
    with contextlib.suppress(ArithmeticError):
        yield from frames_at(cell.re, cell.im)


def subject_of(plant: Document, kind: str, steps: tuple[Document, ...]) -> Any:
    """The box that a certificate is about."""
    return system_of(list(steps), read_plant(plant), kind)


def fixed(
    plant: Document,
    gains: list[Document],
    *steps: Document,
    bound: Any = None,
    under: tuple[Any, ...] = (None,),
) -> Document:
    """A certificate that no member has a fixed mode, each cell with the first gains that do.

    After the gains, no gains are tried: then the cell holds no eigenvalue.  ``under`` are the F_i
    of the exterior discs.
    """
    witness = fixed_witness(subject_of(plant, "box_fixed", steps), gains, bound, under)
    return certificate("box_fixed", plant, {"bound": bound}, witness, *steps)


def fixed_witness(
    box: Box, gains: list[Document], bound: Any, under: tuple[Any, ...] = (None,)
) -> Document:
    """The evidence about one box."""
    exterior = [gershgorin(box, F) for F in under]
    pencils = [augmented(each, "", box) for each in gains]
    pencils.append(Pencil(box.A, box.radii.A, box.n, [each.A for each in box.tied]))

    def frames_at(re: Fraction, im: Fraction) -> Frames:
        for k, pencil in enumerate(pencils):
            V, w = inverse_at(pencil, re, im), [1] * pencil.Z.nrows
            number = k if k < len(gains) else None
            yield {"gains": number, "V": V, "w": w}, left_inverse(V, w, "", pencil)

    limit = None if bound is None else Fraction(bound)
    frames, cover = covered(exterior, box.outside(limit), frames_at)
    return {"exterior": exterior, "gains": gains, "frames": frames, "cover": cover}


def controllable(
    plant: Document,
    channels: list[str],
    *steps: Document,
    bound: Any = None,
    under: tuple[Any, ...] = (None,),
) -> Document:
    """A certificate that channels control every mode of every member."""
    box = subject_of(plant, "box_controllable", steps)
    witness = control_witness(box, channels, bound, under)
    claim = {"channels": channels, "bound": bound}
    return certificate("box_controllable", plant, claim, witness, *steps)


def control_witness(
    box: Box, channels: list[str], bound: Any, under: tuple[Any, ...] = (None,)
) -> Document:
    """The evidence about one box."""
    T = [box.names.index(name) for name in channels]
    every = (box, box.radii, *box.tied)
    Z, D, *tied = (beside([each.A, inputs(each, T)], box.n) for each in every)
    pencil, w, no = Pencil(Z, D, box.n, tied), [1] * box.n, Matrix.zeros(box.n, box.n)
    inner, doubt = (inputs(each, T) for each in (box, box.radii))
    whole = replace(
        box,
        B=[inner],
        C=[Matrix.unit_rows(box.n, 0, box.n)],
        radii=replace(box.radii, B=[doubt], C=[no]),
    )
    exterior = [gershgorin(whole, F) for F in under]

    def frames_at(re: Fraction, im: Fraction) -> Frames:
        R = right_inverse_at(pencil, re, im)
        yield {"R": R, "w": w}, right_inverse(R, w, "", pencil)

    limit = None if bound is None else Fraction(bound)
    frames, cover = covered(exterior, box.outside(limit), frames_at)
    return {"exterior": exterior, "frames": frames, "cover": cover}


def in_cells(
    plant: Document,
    kind: str,
    claim: Document,
    cuts: list[Node],
    made: Callable[[Box], Document],
    *steps: Document,
) -> Document:
    """A certificate about all values of parameters, with the evidence about each cell."""
    subject: Any = read_subject(list(steps), plant_of(plant), kind)
    parts = [made(members_of_cell(subject, cell)) for cell in cells_of(cuts, "cuts", subject)]
    return certificate(kind, plant, claim, {"cuts": cuts, "parts": parts}, *steps)


def stable(
    plant: Document,
    points: list[Any],
    *steps: Document,
    bound: Any = None,
    gain_radii: Any = None,
    growth: list[int] | None = None,
) -> Document:
    """A certificate that every member is stable."""
    box = subject_of(plant, "box_stable", steps)
    witness = stable_witness(box, points, bound, gain_radii, growth)
    claim = {"bound": bound, "gain_radii": gain_radii}
    return certificate("box_stable", plant, claim, witness, *steps)


def stable_witness(
    box: Box, points: list[Any], bound: Any, gain_radii: Any, growth: list[int] | None
) -> Document:
    """The evidence about one box, with a frame for each segment."""
    pencil = loop_pencil(box, gain_radii)
    limit = Fraction(box.time == "discrete") if bound is None else Fraction(bound)
    frames = []
    for re, im, _ in segments_of(box.time, limit, [Fraction(point) for point in points]):
        frames.append({"V": inverse_at(pencil, re, im), "w": [1] * pencil.Z.nrows})
    return {
        "nominal": {"method": "polynomial"},
        "points": points,
        "growth": growth,
        "segments": list(range(len(frames))),
        "frames": frames,
    }
