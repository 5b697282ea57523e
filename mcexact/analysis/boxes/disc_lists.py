"""Exterior discs of A and of A_F for some gains F: what is fixed is in a disc of each list.

Where the lists have few points in common, little is left for a cover, each leaf of which costs the
inverse of a pencil.  Without gains a list is that of A.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from mcexact.analysis.boxes.cover import Outside
from mcexact.analysis.boxes.exterior import Coordinates, Exterior, coordinates, exterior
from mcexact.analysis.boxes.float_pencils import Complex, FloatBox
from mcexact.answer.evidence import ExteriorDiscs
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, vstack
from mcexact.model.radii import Radii, moduli

MANY = 30
"""From so many states on, gains are drawn; frames are cheap below, and allow for larger radii."""
_FIRST_DRAWS, _DRAWS = 6, 32
_FEW_LISTS, _MOST_LISTS = 3, 10
_BITS = 8
_PARTS = (0.0, 0.6, 0.95)
_TURNS = np.exp(2j * np.pi * np.arange(8) / 8)


@dataclass(frozen=True, eq=False)
class GainBox:
    """A, B_i and C_i with their radii, exactly and in floating point.

    Attributes
    ----------
    A : Matrix, n × n
    B, C : tuples of Matrix
    radii : Radii
        Those of A, B_i and C_i.
    near : FloatBox
    moved : tuple of Matrix
        The radii of entries of A that are independent, and what may be added to A with a factor
        from −1 to 1, if entries are not independent; the radii above are those of a box of
        independent entries that contains all.
    """

    A: Matrix
    B: tuple[Matrix, ...]
    C: tuple[Matrix, ...]
    radii: Radii
    near: FloatBox
    moved: tuple[Matrix, ...] = ()

    def of_gains(self, F: Sequence[Matrix], growth: Fraction) -> tuple[Matrix, Matrix]:
        """A_F = A + Σ B_i F_i C_i, and its radii where those of the box grow."""
        n, radii = self.A.nrows, self.radii
        B, D_B = hstack(self.B, nrows=n), hstack([M * growth for M in radii.B], nrows=n)
        FC = vstack([F_i @ C for F_i, C in zip(F, self.C, strict=True)], ncols=n)
        sizes = [moduli(F_i) for F_i in F]
        around = vstack([f @ (D * growth) for f, D in zip(sizes, radii.C, strict=True)], ncols=n)
        outer = vstack([f @ moduli(C) for f, C in zip(sizes, self.C, strict=True)], ncols=n)
        D = radii.A * growth + (moduli(B) + D_B) @ around + D_B @ outer
        return self.A + B @ FC, D

    def near_gains(self, A_F: Matrix, D_F: Matrix) -> FloatBox:
        """A_F and its radii in balanced coordinates."""
        s = self.near.scale
        turned = s[None, :] / s[:, None]
        D = matrix_to_float(D_F) * turned
        return replace(self.near, A=matrix_to_float(A_F) * turned, DA=D, rest_A=D, tied_A=())


@dataclass(frozen=True, eq=False)
class _Proposal:
    """The discs of A_F in floating point; F is None for A."""

    F: tuple[Matrix, ...] | None
    M: Matrix
    D: Matrix
    coordinates: Coordinates

    def around(self, points: Complex) -> Complex:
        """Those points that are in a disc, or near one."""
        far = np.abs(points[:, None] - self.coordinates.centers[None, :])
        found: Complex = points[np.any(far <= 1.001 * self.coordinates.radii[None, :], axis=1)]
        return found

    def points(self, outside: Outside) -> Complex:
        """Points in all discs of the upper half-plane that are not outside."""
        found = []
        for c, r in zip(self.coordinates.centers, self.coordinates.radii, strict=True):
            disc = (Fraction(float(c.real)), Fraction(float(c.imag))), Fraction(float(r))
            if not outside.disc(*disc):
                found += [c + r * part * turn for part in _PARTS for turn in _TURNS]
        return np.array([p for p in found if p.imag >= 0], dtype=np.complex128)


def disc_lists(
    box: GainBox,
    rng: np.random.Generator,
    growth: Fraction,
    outside: Outside,
    *,
    several: bool,
) -> tuple[ExteriorDiscs, ...] | None:
    """Compute lists of discs, the first of which is to be covered; None if there are none.

    Parameters
    ----------
    box : GainBox
    rng : numpy.random.Generator
    growth : Fraction
        The factor of all radii.
    outside : Outside
        What need not be covered.
    several : bool
        Whether to draw gains; otherwise there is one list, that of A.

    Notes
    -----
    Gains are drawn.  Of those whose discs are small, more are taken as long as they leave fewer of
    some points that are in discs of all lists so far.
    """
    found: list[ExteriorDiscs] = []
    if several:
        for each in _drawn_and_chosen(box, rng, growth, outside):
            made = each.coordinates.exact(box.near.scale, each.M, each.D)
            found += [] if made is None else [_evidence(each.F, made)]
    if not found:
        D, *tied = box.moved or (box.radii.A,)
        own = exterior(box.near, box.A, D, rng, growth, tied)
        found = [] if own is None else [_evidence(None, own)]
    return tuple(found) or None


def _evidence(F: tuple[Matrix, ...] | None, found: Exterior) -> ExteriorDiscs:
    return ExteriorDiscs(F, found.Y.evidence(), found.T.evidence(), found.discs)


def _drawn_and_chosen(
    box: GainBox, rng: np.random.Generator, growth: Fraction, outside: Outside
) -> list[_Proposal]:
    """The discs of A and of A_F for drawn gains, as many as leave few points in all of them."""
    proposals: list[_Proposal] = []
    chosen: list[_Proposal] = []
    for k in range(_DRAWS + 1):
        F = _drawn(box.near, rng) if k else None
        M, D = (box.A, box.radii.A * growth) if F is None else box.of_gains(F, growth)
        proposed = coordinates(box.near_gains(M, D), rng)
        if proposed:
            proposals.append(_Proposal(F, M, D, min(proposed, key=_area)))
        if k in (_FIRST_DRAWS, _DRAWS) and proposals:
            chosen, left = _chosen(proposals, outside)
            if not len(left) and len(chosen) <= _FEW_LISTS:
                break
    return chosen


def _chosen(proposals: list[_Proposal], outside: Outside) -> tuple[list[_Proposal], Complex]:
    """The proposal with the smallest discs, others that leave few of its points, and these."""
    ranked = sorted(proposals, key=lambda each: _area(each.coordinates))
    chosen, left = ranked[:1], ranked[0].points(outside)
    while len(left) and len(chosen) < _MOST_LISTS:
        counts = [len(each.around(left)) for each in ranked]
        best = int(np.argmin(counts))
        if counts[best] == len(left):
            break
        chosen.append(ranked[best])
        left = ranked[best].around(left)
    return chosen, left


def _area(discs: Coordinates) -> float:
    """The squares of the radii."""
    return float((discs.radii**2).sum())


def _drawn(box: FloatBox, rng: np.random.Generator) -> tuple[Matrix, ...]:
    """Draw gains of a drawn size, with a few bits each."""
    size = 10 ** rng.uniform(-1, 0.5) * max(float(np.linalg.norm(box.A)), 1e-12)
    found = []
    for B, C in zip(box.B, box.C, strict=True):
        p, q = B.shape[1], C.shape[0]
        around = max(float(np.linalg.norm(B)) * float(np.linalg.norm(C)), 1e-300)
        parts = rng.choice([-1, 1], size=(p, q)) * rng.uniform(0.3, 1, size=(p, q))
        drawn = parts * size / around / np.sqrt(len(box.B))
        unit = Fraction(2) ** (int(np.floor(np.log2(np.abs(drawn).max(initial=1e-290)))) - _BITS)
        rows = [[round(x / float(unit)) for x in row] for row in drawn.tolist()]
        found.append(Matrix.from_integers(rows, 1, q) * unit)
    return tuple(found)
