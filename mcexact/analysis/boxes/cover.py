"""Covers by discs, and exterior discs of all members.

To prove something for all eigenvalues of all members of a box, first discs are computed that
contain these eigenvalues, then the discs are covered by smaller ones, each of which passes an exact
test (`boxes.pencils`).

Exterior discs are Gershgorin's in coordinates T in which A is nearly diagonal or triangular, with
Y near T⁻¹.  For G = YT, H = Y A0 T and e = |Y| D_A |T| 1, no member has an eigenvalue λ with
|λ − a_i| > rad_i for every i if s_i = |G_ii| − Σ_{j≠i} |G_ij| > 0 and rad_i s_i >
Σ_j |a_i G_ij − H_ij| + e_i.  Floating point proposes Y, T and a_i from several bases and weights;
the radii are computed exactly from the rounded matrices, so Y need not be the exact inverse.

A fixed mode is an eigenvalue of A_F for every F, so it lies in an exterior disc of A, and in one of
A_F for each of some drawn gains F.  `disc_lists` chooses gains that leave little in common: that
pays for large plants, because each leaf of a cover costs the inverse of a pencil.  Without gains
there is one list, that of A.

`Cover` cuts a square around each disc of the first list into four, again and again, until each part
passes the test, meets no disc of another list, or lies outside of the claim.  It gives up after a
number of tests; then nothing is proved.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np

from mcexact.analysis.boxes.pencils import (
    Complex,
    ComplexRows,
    FloatBox,
    Floats,
    Members,
    Point,
    dyadic,
    modulus_above,
    perron,
)
from mcexact.answer.evidence import ExteriorDiscs, RootDisc
from mcexact.errors import InternalError
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, vstack
from mcexact.exact.roots import decimal, exact_decimal, is_discrete
from mcexact.model.radii import Radii, moduli

# Trees of squares that cover discs.

SQUARE = Fraction(1414214, 1000000)
"""A number above √2: a square of half side h is inside of the disc of radius √2 h."""
_MOST_CUTS = 24

Disc = tuple[Point, Fraction]
"""The center and the radius of a disc."""
Test = Callable[[Point, Fraction, int], int | None]
"""Of a center, a radius and a depth, the index of evidence for the disc."""


@dataclass(frozen=True)
class Outside:
    """The part of the plane that a proof may skip: Im λ < 0, by symmetry, and the allowed region.

    Attributes
    ----------
    time : str
    bound : Fraction or None
        A rate or a radius; None if the claim is about all complex numbers.
    """

    time: str
    bound: Fraction | None

    def has_point(self, mode: complex) -> bool:
        """Whether a number lies in that part, with some distance from its border."""
        c = Fraction(mode.real), Fraction(mode.imag)
        return self.bound is not None and self.has_disc(c, Fraction(abs(mode) / 1000))

    def has_disc(self, c: Point, r: Fraction) -> bool:
        """Whether a disc lies in that part."""
        re, im = c
        if im + r < 0:
            return True
        if self.bound is None:
            return False
        if not is_discrete(self.time):
            return re + r < -self.bound
        return self.bound > r and re**2 + im**2 < (self.bound - r) ** 2

    def has_square(self, c: Point, h: Fraction) -> bool:
        """Whether a square of half side h lies in that part."""
        re, im = c
        if im + h < 0:
            return True
        if self.bound is None:
            return False
        if not is_discrete(self.time):
            return re + h < -self.bound
        return (abs(re) + h) ** 2 + (abs(im) + h) ** 2 < self.bound**2


@dataclass
class Cover:
    """The trees over discs, and how many squares were tested.

    Attributes
    ----------
    test : function
    outside : Outside
    limit : int
        The most discs and squares that are tested.
    """

    test: Test
    outside: Outside
    limit: int
    tested: int = field(default=0)

    def of(self, *lists: Sequence[RootDisc]) -> tuple[tuple[int | None, ...], ...] | None:
        """The tree over each disc of the first list, in preorder; None without a cover.

        Squares that meet no disc of one of the other lists are skipped.
        """
        first, *others = ([_exact(disc) for disc in discs] for discs in lists)
        trees = []
        for c, radius in first:
            tree: list[int | None] = []
            near = [[each for each in discs if meets(c, radius, each)] for discs in others]
            skipped = self.outside.has_disc(c, radius) or not all(near)
            if not skipped and not (
                self._leaf(c, radius, 0, tree) or self._cut(c, radius, 0, tree, near)
            ):
                return None
            trees.append(tuple(tree))
        return tuple(trees)

    def _leaf(self, c: Point, rho: Fraction, depth: int, tree: list[int | None]) -> bool:
        self.tested += 1
        k = self.test(c, rho, depth)
        if k is not None:
            tree.append(k)
        return k is not None

    def _cut(
        self,
        c: Point,
        h: Fraction,
        depth: int,
        tree: list[int | None],
        near: list[list[Disc]],
    ) -> bool:
        """Cut a square of half side h into four, each of which is a leaf or is cut again."""
        if depth == _MOST_CUTS or self.tested >= self.limit:
            return False
        tree.append(None)
        q = h / 2
        for x in (-q, q):
            for y in (-q, q):
                part = c[0] + x, c[1] + y
                if self.outside.has_square(part, q):
                    continue
                left = [
                    [each for each in discs if meets(part, q, each, square=True)] for discs in near
                ]
                if not all(left):
                    continue
                if not (
                    self._leaf(part, q * SQUARE, depth + 1, tree)
                    or self._cut(part, q, depth + 1, tree, left)
                ):
                    return False
        return True


def trees_beyond(
    outside: Outside,
    trees: Sequence[Sequence[int | None]],
    *lists: Sequence[RootDisc],
) -> tuple[tuple[int | None, ...], ...]:
    """The trees of a cover of all complex numbers, without what a proof may skip.

    Parameters
    ----------
    outside : Outside
        What may be skipped.
    trees : sequence of sequences of int or None
        The trees that `Cover.of` made of these lists for a claim about all complex numbers.
    *lists : sequences of RootDisc
    """
    nodes = [node for tree in trees for node in tree]
    left, known = iter(nodes), dict[tuple[Point, Fraction], int]()

    def again(c: Point, rho: Fraction, _: int) -> int | None:
        k = next(left)
        if k is not None:
            known[c, rho] = k
        return k

    limit = len(nodes) + 1
    Cover(again, Outside(outside.time, None), limit).of(*lists)
    made = Cover(lambda c, rho, _: known.get((c, rho)), outside, limit).of(*lists)
    if made is None:
        raise InternalError("the trees of a cover are not those of its discs")
    return made


def meets(c: Point, size: Fraction, disc: Disc, *, square: bool = False) -> bool:
    """Whether a disc of this radius, or else a square of this half side, meets a disc."""
    (re, im), radius = disc
    x, y = abs(re - c[0]), abs(im - c[1])
    if max(x, y) > size + radius:
        return False
    if not square:
        return x**2 + y**2 <= (size + radius) ** 2
    x, y = max(x - size, Fraction(0)), max(y - size, Fraction(0))
    return x**2 + y**2 <= radius**2


def _exact(disc: RootDisc) -> Disc:
    return (exact_decimal(disc.re), exact_decimal(disc.im)), exact_decimal(disc.radius)


# Exterior discs of one matrix with radii.

_PERTURBATIONS = (0.0, 1e-11, 1e-8, 1e-6, 1e-4, 1e-2)
"""Eigenvectors of a matrix that is not diagonalizable are taken of one so close to it."""
_FINE, _FINEST = 2.0**10, 2.0**-26
_PARTS = (1e-1, 1e-2, 1e-3)
_VERY_WELL, _WELL = 1e2, 1e6
_MOST_DIGITS = 60
_SQUARINGS = 40


@dataclass(frozen=True)
class Exterior:
    """Y and T, and the disc of each row."""

    Y: ComplexRows
    T: ComplexRows
    discs: tuple[RootDisc, ...]


def exterior(
    box: FloatBox,
    A: Matrix,
    D: Matrix,
    rng: np.random.Generator,
    factor: Fraction = Fraction(1),
    generators: Sequence[Matrix] = (),
) -> Exterior | None:
    """Compute the discs for radii that are multiplied by a factor; None if no proposal holds.

    Parameters
    ----------
    box : FloatBox
        Its balanced coordinates are those in which eigenvectors are computed.
    A, D : Matrix, n × n
        The nominal matrix and its radii.
    rng : numpy.random.Generator
    factor : Fraction
        The factor of all radii.
    generators : sequence of Matrix
        Matrices that may be added to A, each with a factor from −1 to 1.
    """
    if not box.n:
        none = ComplexRows.of(Matrix.zeros(0, 0))
        return Exterior(none, none, ())
    scaled = [M * factor for M in generators]
    ranked = coordinates(box, rng, factor)
    proposed = (each.exact(box.scale, A, D * factor, scaled) for each in ranked)
    return next((discs for discs in proposed if discs is not None), None)


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Y, T and the discs in floating point, in balanced coordinates.

    Attributes
    ----------
    Y, T : ndarray of complex, n × n
    centers : ndarray of complex, n
    radii : ndarray of float, n
    size : ndarray of float, n × n
        |A|.
    """

    Y: Complex
    T: Complex
    centers: Complex
    radii: Floats
    size: Floats

    def exact(
        self, scale: Floats, A: Matrix, D: Matrix, generators: Sequence[Matrix] = ()
    ) -> Exterior | None:
        """Round Y and T, and compute the discs of a matrix exactly; None if there are none.

        Entries of Y and T are rounded as coarsely as enlarges the radii by a small part only.
        """
        n, Y, T = len(scale), np.abs(self.Y), np.abs(self.T)
        far, most = np.abs(self.centers)[:, None], np.maximum(self.radii, 1e-290)[:, None]
        after, before = self.size @ T.sum(axis=1), Y @ self.size
        heavy_Y = np.maximum((after + far * T.sum(axis=1)) / most, T.sum(axis=1))
        heavy_T = np.maximum((before + far * Y) / most, Y).max(axis=0)[:, None]
        unit_Y = np.maximum(_FINE / (n * heavy_Y), _FINEST * Y.max(axis=1)[:, None])
        unit_T = np.maximum(_FINE / (n * n * heavy_T), _FINEST * T.max(axis=0))
        exact_Y = dyadic(self.Y / scale[None, :], unit_Y / scale[None, :])
        exact_T = dyadic(self.T * scale[:, None], unit_T * scale[:, None])
        discs = _discs(exact_Y, exact_T, A, D, generators, self.centers)
        return None if discs is None else Exterior(exact_Y, exact_T, discs)


def coordinates(
    box: FloatBox, rng: np.random.Generator, factor: Fraction = Fraction(1)
) -> list[Coordinates]:
    """Y, T and the discs in balanced coordinates, those with the smallest radii first."""
    A, size = box.A, np.abs(box.A)
    proposals: list[Coordinates] = []
    for T in _candidates(A, box.DA, rng):
        try:
            Y = np.linalg.inv(T)
        except np.linalg.LinAlgError:
            continue
        H = Y @ A @ T
        centers = np.diag(H).copy()
        size_Y, size_T = np.abs(Y), np.abs(T)
        spread = np.abs(H - np.diag(centers)) + float(factor) * box.deviation(Y, T)
        spread += 1e-12 * (size_Y @ size @ size_T)
        if not np.all(np.isfinite(spread)):
            continue
        for weight in _weights(spread, np.abs(centers)):
            radii = (spread @ weight) / weight
            weighted: tuple[Any, Any] = Y / weight[:, None], T * weight[None, :]
            if np.all(np.isfinite(weighted[0])):
                proposals.append(Coordinates(*weighted, centers, radii, size))
    return sorted(proposals, key=lambda each: float(each.radii.sum()))


def _weights(spread: Floats, sizes: Floats) -> Iterator[Floats]:
    """Weights w > 0 for which the sums of spread_ij w_j / w_i, the radii, are small."""
    n = len(spread)
    yield np.ones(n)
    yield np.maximum(perron(spread, _SQUARINGS)[1], 1e-12)
    own, largest = np.diag(spread), float(sizes.max(initial=0.0)) or float(spread.max(initial=0.0))
    for part in _PARTS:
        # Where a solution is positive, each radius is below the disc's own part and this target.
        target = part * np.maximum(sizes, 1e-6 * max(largest, 1e-290))
        try:
            w = np.linalg.solve(np.diag(target) - (spread - np.diag(own)), target)
        except np.linalg.LinAlgError:
            continue
        if np.all(np.isfinite(w)) and np.all(w > 0):
            yield w / w.max()


def _candidates(A: Floats, D: Floats, rng: np.random.Generator) -> Iterator[Any]:
    """Bases in which A is nearly diagonal, or in which it is triangular.

    The bases of the single diagonal blocks keep a block triangular matrix block triangular: then
    weights can make the coupling of the blocks arbitrarily small.
    """
    from scipy.linalg import schur
    from scipy.sparse.csgraph import connected_components

    n, size = len(A), float(np.linalg.norm(A))
    yield np.eye(n)
    count, block = connected_components(np.abs(A) + D > 0, connection="strong")
    if count > 1:
        whole = np.zeros((n, n), dtype=complex)
        for k in range(count):
            own = np.ix_(block == k, block == k)
            whole[own] = np.linalg.eig(A[own])[1]
        yield whole
    T = np.linalg.eig(A)[1]
    if np.linalg.cond(T) < _VERY_WELL:
        yield T
        return
    yield schur(A, output="complex")[1]
    for part in _PERTURBATIONS:
        noise = part * rng.standard_normal((n, n))
        near = A * (1 + noise) + part * size / max(n, 1) * rng.standard_normal((n, n))
        T = np.linalg.eig(near)[1]
        yield T
        if part == 0 and np.linalg.cond(T) < _WELL:
            return


def _discs(
    Y: ComplexRows,
    T: ComplexRows,
    A: Matrix,
    D: Matrix,
    generators: Sequence[Matrix],
    centers: Complex,
) -> tuple[RootDisc, ...] | None:
    """The discs with radii as small as the exact matrices allow, rounded up to three digits."""
    G, H = Y @ T, Y @ T.after(A)
    ones = Matrix.from_integers([[1]] * len(centers), 1, 1)
    e = Y.moduli() @ (D @ (T.moduli() @ ones))
    for M in generators:
        e = e + (Y @ (ComplexRows.of(M) @ T)).moduli() @ ones
    d = math.lcm(G.denominator, H.denominator)
    (G_re, G_im), (H_re, H_im) = G.integers(d), H.integers(d)
    discs = []
    for i, a in enumerate(centers):
        others = sum(
            modulus_above(x, y)
            for j, (x, y) in enumerate(zip(G_re[i], G_im[i], strict=True))
            if j != i
        )
        slack = math.isqrt(G_re[i][i] ** 2 + G_im[i][i] ** 2) - others
        if slack <= 0:
            return None
        row = G_re[i], G_im[i], H_re[i], H_im[i]
        spread = e[i, 0] * d
        # The center is rounded to a small part of the radius, which is first taken at the float.
        first = (_distance(row, Fraction(float(a.real)), Fraction(float(a.imag))) + spread) / slack
        digits = _digits(first)
        re, im = (round(Fraction(float(x)) * 10**digits) for x in (a.real, a.imag))
        unit = Fraction(1, 10**digits)
        radius = (_distance(row, re * unit, im * unit) + spread) / slack
        above = math.ceil(radius * 10**digits * (1 + Fraction(1, 10**6))) + 1
        discs.append(RootDisc(decimal(re, digits), decimal(im, digits), decimal(above, digits)))
    return tuple(discs)


def _distance(
    row: tuple[list[int], list[int], list[int], list[int]], re: Fraction, im: Fraction
) -> Fraction:
    """An upper limit of Σ_j |a G_ij − H_ij|, in units of the common denominator."""
    d = math.lcm(re.denominator, im.denominator)
    a, b = int(re * d), int(im * d)
    total = sum(
        modulus_above(a * p - b * q - d * r, a * q + b * p - d * s)
        for p, q, r, s in zip(*row, strict=True)
    )
    return Fraction(total, d)


def _digits(radius: Fraction) -> int:
    """The decimal places with which a radius has about three digits."""
    if radius <= 0:
        return _MOST_DIGITS
    size = math.log10(radius.numerator) - math.log10(radius.denominator)
    return min(max(3 - math.floor(size), 0), _MOST_DIGITS)


# Lists of exterior discs of A and of A_F for some gains F.

MANY = 30
"""From so many states on, gains are drawn; frames are cheap below, and allow for larger radii."""
_FIRST_DRAWS, _DRAWS = 6, 32
_FEW_LISTS, _MOST_LISTS = 3, 10
_BITS = 8
_LIST_PARTS = (0.0, 0.6, 0.95)
_TURNS = np.exp(2j * np.pi * np.arange(8) / 8)


@dataclass(frozen=True, eq=False)
class GainBox:
    """A, B_i and C_i with their radii, exactly and in floating point.

    Attributes
    ----------
    A : Matrix, n × n
    B, C : tuples of Matrix
    radii : Radii
        Those of A, B_i and C_i in a box of independent entries that contains all members.
    near : FloatBox
    independent_A : Matrix, n × n, optional
        The radii of the independent changes of A, if there are generators as well.
    generators_A : tuple of Matrix
        Matrices that may be added to A, each with a factor from −1 to 1.
    """

    A: Matrix
    B: tuple[Matrix, ...]
    C: tuple[Matrix, ...]
    radii: Radii
    near: FloatBox
    independent_A: Matrix | None = None
    generators_A: tuple[Matrix, ...] = ()

    @classmethod
    def of(cls, members: Members, near: FloatBox) -> GainBox:
        """Make the box of all matrices of some members."""
        system = members.system
        return cls(
            system.A,
            system.B,
            system.C,
            members.independent,
            near,
            members.radii.A,
            tuple(each.A for each in members.generators),
        )

    def of_gains(self, F: Sequence[Matrix], factor: Fraction) -> tuple[Matrix, Matrix]:
        """A_F = A + Σ B_i F_i C_i, and its radii if those of the box are multiplied by a factor."""
        n, radii = self.A.nrows, self.radii
        B, D_B = hstack(self.B, nrows=n), hstack([M * factor for M in radii.B], nrows=n)
        FC = vstack([F_i @ C for F_i, C in zip(F, self.C, strict=True)], ncols=n)
        sizes = [moduli(F_i) for F_i in F]
        around = vstack([f @ (D * factor) for f, D in zip(sizes, radii.C, strict=True)], ncols=n)
        outer = vstack([f @ moduli(C) for f, C in zip(sizes, self.C, strict=True)], ncols=n)
        D = radii.A * factor + (moduli(B) + D_B) @ around + D_B @ outer
        return self.A + B @ FC, D

    def near_gains(self, A_F: Matrix, D_F: Matrix) -> FloatBox:
        """A_F and its radii in balanced coordinates."""
        s = self.near.scale
        ratios = s[None, :] / s[:, None]
        A, D = (matrix_to_float(M) * ratios for M in (A_F, D_F))
        return replace(self.near, A=A, DA=D, independent_A=D, generators_A=())


@dataclass(frozen=True, eq=False)
class _Proposal:
    """The discs of A_F in floating point; F is None for A."""

    F: tuple[Matrix, ...] | None
    M: Matrix
    D: Matrix
    coordinates: Coordinates

    def around(self, points: Complex) -> Complex:
        """The points that are in a disc, or near one."""
        far = np.abs(points[:, None] - self.coordinates.centers[None, :])
        near: Complex = points[np.any(far <= 1.001 * self.coordinates.radii[None, :], axis=1)]
        return near

    def points(self, outside: Outside) -> Complex:
        """Points of the discs in the upper half-plane that the claim is about."""
        points = []
        for c, r in zip(self.coordinates.centers, self.coordinates.radii, strict=True):
            disc = (Fraction(float(c.real)), Fraction(float(c.imag))), Fraction(float(r))
            if not outside.has_disc(*disc):
                points += [c + r * part * turn for part in _LIST_PARTS for turn in _TURNS]
        return np.array([p for p in points if p.imag >= 0], dtype=np.complex128)


def disc_lists(
    box: GainBox,
    rng: np.random.Generator,
    factor: Fraction,
    outside: Outside,
    *,
    several: bool,
) -> tuple[ExteriorDiscs, ...] | None:
    """Compute lists of discs, the first of which is to be covered; None if there are none.

    Parameters
    ----------
    box : GainBox
    rng : numpy.random.Generator
    factor : Fraction
        The factor of all radii.
    outside : Outside
        The part of the plane that need not be covered.
    several : bool
        Whether to draw gains; otherwise there is one list, that of A.

    Notes
    -----
    Gains are drawn at random.  A list is added as long as fewer of some sample points lie in discs
    of every list.
    """
    lists: list[ExteriorDiscs] = []
    if several:
        for each in _drawn_and_chosen(box, rng, factor, outside):
            discs = each.coordinates.exact(box.near.scale, each.M, each.D)
            lists += [] if discs is None else [_evidence(each.F, discs)]
    if not lists:
        D = box.radii.A if box.independent_A is None else box.independent_A
        own = exterior(box.near, box.A, D, rng, factor, box.generators_A)
        lists = [] if own is None else [_evidence(None, own)]
    return tuple(lists) or None


def _evidence(F: tuple[Matrix, ...] | None, each: Exterior) -> ExteriorDiscs:
    return ExteriorDiscs(F, each.Y.evidence(), each.T.evidence(), each.discs)


def _drawn_and_chosen(
    box: GainBox, rng: np.random.Generator, factor: Fraction, outside: Outside
) -> list[_Proposal]:
    """The discs of A and of A_F for drawn gains, chosen so that few points are in all lists."""
    proposals: list[_Proposal] = []
    chosen: list[_Proposal] = []
    for k in range(_DRAWS + 1):
        F = _drawn(box.near, rng) if k else None
        M, D = (box.A, box.radii.A * factor) if F is None else box.of_gains(F, factor)
        proposed = coordinates(box.near_gains(M, D), rng)
        if proposed:
            proposals.append(_Proposal(F, M, D, min(proposed, key=_area)))
        if k in (_FIRST_DRAWS, _DRAWS) and proposals:
            chosen, left = _chosen(proposals, outside)
            if not len(left) and len(chosen) <= _FEW_LISTS:
                break
    return chosen


def _chosen(proposals: list[_Proposal], outside: Outside) -> tuple[list[_Proposal], Complex]:
    """The proposal with the smallest discs, those that exclude most points, and what is left."""
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
    """The sum of the squares of the radii."""
    return float((discs.radii**2).sum())


def _drawn(box: FloatBox, rng: np.random.Generator) -> tuple[Matrix, ...]:
    """Draw gains, and their common size, with a few bits each."""
    size = 10 ** rng.uniform(-1, 0.5) * max(float(np.linalg.norm(box.A)), 1e-12)
    gains = []
    for B, C in zip(box.B, box.C, strict=True):
        p, q = B.shape[1], C.shape[0]
        around = max(float(np.linalg.norm(B)) * float(np.linalg.norm(C)), 1e-300)
        parts = rng.choice([-1, 1], size=(p, q)) * rng.uniform(0.3, 1, size=(p, q))
        drawn = parts * size / around / np.sqrt(len(box.B))
        unit = Fraction(2) ** (int(np.floor(np.log2(np.abs(drawn).max(initial=1e-290)))) - _BITS)
        rows = [[round(x / float(unit)) for x in row] for row in drawn.tolist()]
        gains.append(Matrix.from_integers(rows, 1, q) * unit)
    return tuple(gains)
