"""Boxes, discs on which a pencil is regular, and covers.

A box is all systems whose entries are within radii of given values.  That a pencil λE − Z is
regular for every member at every λ that matters is proved in three steps:

- `exterior_discs`: a matrix Y(λI − A)T is strictly diagonally dominant for every member unless λ
  is in one of n discs.  All eigenvalues of all members therefore lie in these discs.
- `left_inverse`, `right_inverse`: V about (cE − Z)⁻¹ and weights prove that the pencil is regular
  for every member on a whole disc of λ around c.
- `require_covered`: each disc of the first step is cut into squares, each into four again, until
  every one is regular by some V, or lies where nothing is claimed.

V need not be an exact inverse: only inequalities are checked, by integers, and absolute values of
complex numbers are rounded up.  `box_of` applies constructions to boxes, and `loop_pencil` writes a
closed loop as a pencil of the matrices of plant and controller, without products of these.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

from .constructions import (
    Signal,
    Terms,
    mapped,
    programs_of,
    read_subject,
    rows_of_states,
    rows_that_read,
    sampled_within,
    signals_of,
)
from .controllers import MAPS, read_controller
from .core import budget, reading
from .core.arithmetic import Matrix, absolute, entries_of, stack
from .core.evidence import closed_loop, read_gains
from .core.reading import Json, decimal, fields, incomplete, integer, items, malformed, require
from .core.roots import Disc
from .core.system import System, digest, read_radii
from .modes import RateOrRadius

# Complex matrices, of pairs of integers over one denominator, and their absolute values.


def magnitude(re: int, im: int) -> int:
    """The least integer that is not below |re + i·im|."""
    if not im:
        return abs(re)
    square = re * re + im * im
    return math.isqrt(square - 1) + 1


def extractions(number: int, a: int) -> int:
    """The units of ``number`` absolute values of complex numbers of a limbs."""
    return budget.reductions(4 * number, 2 * a)


@dataclass(frozen=True)
class ComplexMatrix:
    """re + i·im; both have the same shape and the same denominator."""

    re: Matrix
    im: Matrix

    @property
    def limbs(self) -> int:
        """The limbs of the longest entry, or of the denominator."""
        return max(self.re.limbs, self.im.limbs)

    def __matmul__(self, other: ComplexMatrix) -> ComplexMatrix:
        re = self.re @ other.re - self.im @ other.im
        return ComplexMatrix(re, self.re @ other.im + self.im @ other.re)

    def after(self, M: Matrix) -> ComplexMatrix:
        """The product M (re + i·im), M real."""
        return ComplexMatrix(M @ self.re, M @ self.im)

    def before(self, M: Matrix) -> ComplexMatrix:
        """The product (re + i·im) M, M real."""
        return ComplexMatrix(self.re @ M, self.im @ M)

    def magnitudes(self) -> Matrix:
        """The absolute values of all entries, rounded up to integers over the denominator."""
        nrows, ncols, a = self.re.nrows, self.re.ncols, self.limbs
        budget.spend(budget.table(nrows, ncols, a) + extractions(nrows * ncols, a))
        pairs = zip(self.re.rows, self.im.rows, strict=True)
        return Matrix([list(map(magnitude, *pair)) for pair in pairs], ncols, self.re.denominator)


def complex_matrix(value: Json, place: str, nrows: int, ncols: int) -> ComplexMatrix:
    """Read a complex matrix of the prescribed shape."""
    denominator, *parts = fields(value, place, "denominator", "re", "im")
    re, im = (
        reading.matrix({"denominator": denominator, "entries": part}, place, nrows, ncols)
        for part in parts
    )
    return ComplexMatrix(re, im)


# Discs of λ on which a pencil is regular for every member of a box; ``proofs/boxes.md``.

Regular = Callable[[Fraction, Fraction, Fraction], bool]
"""Whether a pencil is regular on the disc of this center, re + i·im, and this radius."""


@dataclass(frozen=True)
class Pencil:
    """λE − Z, whose entries of Z have the radii D; E has ``dynamic`` ones, and then zeros.

    Each of ``tied`` is added to Z with a factor from −1 to 1 of its own.
    """

    Z: Matrix
    D: Matrix
    dynamic: int
    tied: Sequence[Matrix] = ()


def read_weights(value: Json, place: str, size: int) -> Matrix:
    """A column of positive integers."""
    weights = [[integer(entry, place, 1)] for entry in items(value, place, size)]
    return Matrix(weights, 1)


def left_inverse(value: Json, weights: Json, place: str, pencil: Pencil) -> Regular:
    """V about (cE − Z)⁻¹: I − V(λE − Z) is I − (λP − Q), P = VE and Q = VZ.

    Theorems ``boxes.regular_disc_left``, ``boxes.regular_disc_left_tied``.
    """
    size = pencil.Z.nrows
    V = complex_matrix(value, place, size, size)
    return regular_by(V, read_weights(weights, place, size), pencil)


def regular_by(V: ComplexMatrix, w: Matrix, pencil: Pencil) -> Regular:
    """The discs on which V and the weights w prove that a pencil is regular."""
    dynamic = range(pencil.dynamic)
    P = ComplexMatrix(V.re.take(None, dynamic), V.im.take(None, dynamic))
    spread = V.magnitudes() @ (pencil.D @ w)
    for M in pencil.tied:
        spread = spread + V.before(M).magnitudes() @ w
    return near_identity(P, V.before(pencil.Z), spread, w)


def right_inverse(value: Json, weights: Json, place: str, pencil: Pencil) -> Regular:
    """R about a right inverse of cE − Z, E = [I, 0]: I − (λP − Q), P = ER and Q = ZR.

    Theorems ``boxes.regular_disc_right``, ``boxes.regular_disc_right_tied``.
    """
    size = pencil.dynamic
    R = complex_matrix(value, place, pencil.Z.ncols, size)
    w, dynamic = read_weights(weights, place, size), range(size)
    P = ComplexMatrix(R.re.take(dynamic), R.im.take(dynamic))
    spread = pencil.D @ (R.magnitudes() @ w)
    for M in pencil.tied:
        spread = spread + R.after(M).magnitudes() @ w
    return near_identity(P, R.after(pencil.Z), spread, w)


def near_identity(P: ComplexMatrix, Q: ComplexMatrix, spread: Matrix, w: Matrix) -> Regular:
    """Whether Σ_j |I − (cP − Q)|_ij w_j + spread_i + ρ (|P| w)_i < w_i in every row i.

    P has the first columns; in the others it is 0.
    """
    size, width = Q.re.nrows, P.re.ncols
    d = math.lcm(P.re.denominator, Q.re.denominator)
    f, g = d // P.re.denominator, d // Q.re.denominator
    a, b = P.limbs + budget.limbs([f]), Q.limbs + budget.limbs([g])
    budget.build(2 * size, 2 * size, a, b)
    rest = [0] * (size - width)
    xs = [[f * entry for entry in row] + rest for row in P.re.rows]
    ys = [[f * entry for entry in row] + rest for row in P.im.rows]
    us = [[g * entry for entry in row] for row in Q.re.rows]
    vs = [[g * entry for entry in row] for row in Q.im.rows]
    weights = [row[0] for row in w.rows]
    for i in range(size):
        us[i][i] += d
    grown = P.magnitudes() @ Matrix(w.rows[:width], 1)
    slacks = [
        w_i - Fraction(e[0], spread.denominator)
        for w_i, e in zip(weights, spread.rows, strict=True)
    ]
    slopes = [Fraction(e[0], grown.denominator) for e in grown.rows]

    def regular(re: Fraction, im: Fraction, rho: Fraction) -> bool:
        z = math.lcm(re.denominator, im.denominator)
        p, q = int(re * z), int(im * z)
        c = budget.limbs([p, q, z])
        longest = max(a, b) + c + 1
        budget.spend(
            budget.products(8 * size * size, max(a, b), c) + extractions(size * size, longest)
        )
        budget.spend(budget.fractions(4 * size, longest + spread.limbs + budget.limbs_of([rho])))
        for x, y, u, v, slack, slope in zip(xs, ys, us, vs, slacks, slopes, strict=True):
            total = sum(
                magnitude(x_j * p - y_j * q - z * u_j, x_j * q + y_j * p - z * v_j) * w_j
                for x_j, y_j, u_j, v_j, w_j in zip(x, y, u, v, weights, strict=True)
            )
            if not Fraction(total, d * z) + rho * slope < slack:
                return False
        return True

    return regular


# Covers of discs by discs and squares, each of which is proved; ``proofs/boxes.md``.

ROOT_2 = Fraction(1414214, 1000000)
"""More than the square root of 2."""


ZERO = Fraction(0)


class Cell(NamedTuple):
    """A disc around re + i·im with radius ``size``, or a square with half side ``size``."""

    re: Fraction
    im: Fraction
    size: Fraction
    square: bool

    def outside(self, time: str, bound: RateOrRadius) -> bool:
        """Whether it lies below the real axis, or inside the region where modes are allowed.

        Theorems ``cells.conjugate_fixed``, ``cells.conjugate_rank``.
        """
        re, im, size, square = self
        if im + size < 0:
            return True
        if bound is None:
            return False
        if time == "continuous":
            return re + size < -bound
        if square:
            return (abs(re) + size) ** 2 + (abs(im) + size) ** 2 < bound**2
        return bound > size and re**2 + im**2 < (bound - size) ** 2

    def meets(self, disc: Disc) -> bool:
        """Whether the cell and a disc have a common point."""
        re, im, radius = disc
        x, y, reach = abs(re - self.re), abs(im - self.im), radius + self.size
        if max(x, y) > reach:
            return False
        if self.square:
            x, y, reach = max(x - self.size, ZERO), max(y - self.size, ZERO), radius
        return x**2 + y**2 <= reach**2

    def parts(self) -> list[Cell]:
        """Four squares that cover it, in the order in which they are taken from the end.

        Theorems ``cells.disc_in_square``, ``cells.four_parts``.
        """
        re, im, size, _ = self
        h = size / 2
        return [Cell(re + x, im + y, h, True) for x in (h, -h) for y in (h, -h)]

    def regular(self, on_disc: Regular) -> bool:
        """Whether a pencil is regular on a disc that contains the cell."""
        return on_disc(self.re, self.im, self.size * ROOT_2 if self.square else self.size)


def require_covered(
    value: Json,
    place: str,
    exterior: list[list[Disc]],
    outside: Callable[[Cell], bool],
    frames: Sequence[Regular],
) -> None:
    """Stop unless all points in a disc of each list are in cells that are regular by one frame.

    The discs of the first list are cut into cells; those that are outside, or that meet no disc of
    another list, are left out.

    Theorems ``boxes.square_in_disc``, ``cells.cover_disc``.
    """
    first, *others = exterior
    longest = max((budget.limbs_of(disc) for discs in others for disc in discs), default=0)
    for k, nodes in enumerate(items(value, place, len(first))):
        where, used = f"{place}[{k}]", 0
        left = [(Cell(*first[k], False), others)]
        while left:
            cell, near = left.pop()
            turns = 12 + 3 * sum(map(len, near))
            budget.spend(budget.fractions(turns, 2 * budget.limbs_of(cell[:3]) + longest))
            if outside(cell):
                continue
            near = [[disc for disc in discs if cell.meets(disc)] for discs in near]
            if not all(near):
                continue
            require(used < len(items(nodes, where)), "cover", where, "a cell is not covered")
            node, used = nodes[used], used + 1
            if node is None:
                left += [(part, near) for part in cell.parts()]
                continue
            if integer(node, where) >= len(frames):
                malformed(where, f"expected null or a position below {len(frames)}")
            regular = cell.regular(frames[node])
            require(regular, "cell", f"{where}[{used - 1}]", "not regular by this frame")
        if used < len(items(nodes, where)):
            malformed(where, f"expected {used} cells, found {len(nodes)}")


# Boxes of plants, and constructions applied to them.

LOOP, PART, SAMPLED = "closed_loop", "modulo", "sampled"
LOOPS = LOOP, "periodic_loop"
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
        """A box with independent entries that contains all members."""
        radii = self.radii
        for each in self.tied:
            radii = _combined(radii, _sizes(each), 1)
        return replace(self, radii=radii, tied=())

    def outside(self, bound: RateOrRadius) -> Callable[[Cell], bool]:
        """The test of a cell that needs no proof: it is allowed, or below the real axis."""
        return lambda cell: cell.outside(self.time, bound)


def at_values(plant: System) -> System:
    """The plant without its radii; if it has some, its words say that its values are nominal."""
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
        if step["construction"] in LOOPS:
            message = "a closed loop is the last construction, for the kind box_stable alone"
            incomplete("construction", f"subject[{k}]", message)
        if step["construction"] == PART:
            message = "a part of the nominal plant is none of every plant in a box"
            incomplete("construction", f"subject[{k}]", message)
    radii, members = _radii(computed, plant), members_in_words(plant)
    if any(step["construction"] == SAMPLED for step in steps):
        members += ", sampled without rounding"
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
    """The radii after constructions: how much larger absolute values can make the results.

    Each construction adds and multiplies; it is applied to absolute values, those of gains too,
    and to the same with the radii added.  What is sampled has radii by a rule of its own.

    Theorem ``servo.selected_within``.
    """
    radii = read_radii(plant.uncertainty, plant.names, [plant.A, *plant.B, *plant.C])
    A, *ports = radii
    D = replace(plant, A=A, B=ports[: plant.m], C=ports[plant.m :])
    if not steps:
        return D
    low, high = ends(plant, D)
    for k, step in enumerate(steps):
        if step["construction"] == SAMPLED:
            held, parameters = read_subject(steps[:k], plant), {**step}
            del parameters["construction"]
            spread = _combined(high, low, -1)
            low, high = ends(*sampled_within(held, spread, parameters, f"subject[{k}]"))
        else:
            sizes = [_of_sizes(step)]
            low, high = (_sizes(read_subject(sizes, each)) for each in (low, high))
    return _combined(high, low, -1)


def ends(system: System, radii: System) -> tuple[System, System]:
    """The absolute values of all entries, and the largest absolute values in the box."""
    low = _sizes(system)
    return low, _combined(low, radii, 1)


def _of_sizes(step: Json) -> Json:
    """The same construction, with the absolute values of its gains."""
    if "gains" not in step:
        return step
    sizes = [{**F, "entries": [[*map(abs, row)] for row in F["entries"]]} for F in step["gains"]]
    return {**step, "gains": sizes}


def _combined(first: System, second: System, factor: int) -> System:
    """The first system, with ``factor`` times the entries of the second one added."""
    parts = ((first.A, *first.B, *first.C), (second.A, *second.B, *second.C))
    return _of_parts(first, [M + N.times(factor) for M, N in zip(*parts, strict=True)])


def _sizes(system: System) -> System:
    """The absolute values of all entries."""
    return _of_parts(system, list(map(absolute, (system.A, *system.B, *system.C))))


def _of_parts(system: System, parts: list[Matrix]) -> System:
    """The system with these matrices A, B_1, …, C_1, … in place of its own."""
    A, *ports = parts
    return replace(system, A=A, B=ports[: len(system.B)], C=ports[len(system.B) :])


# Discs that contain the spectrum of every member of a box, with gains; ``proofs/boxes.md``.


def discs_of_gains(value: Json, place: str, box: Box) -> list[list[Disc]]:
    """Lists of discs, each of which contains what is fixed for any member.

    Theorem ``boxes.fixed_in_exterior``.
    """
    lists = []
    for k, entry in enumerate(items(value, place)):
        where = f"{place}[{k}]"
        F, Y, T, listed = fields(entry, where, "F", "Y", "T", "discs")
        A, D, tied = box.A, box.radii.A, [each.A for each in box.tied]
        if F is not None:
            (A, D), tied = with_gains(F, f"{where}.F", box.independent()), []
        lists.append(exterior_discs(Y, T, listed, where, A, D, tied))
    if not lists:
        malformed(place, "expected the discs of one matrix or more")
    return lists


def with_gains(value: Json, place: str, box: Box) -> tuple[Matrix, Matrix]:
    """A_F = A + Σ B_i F_i C_i, and how far it is from that of any member.

    Theorem ``boxes.gains_within``.
    """
    F = read_gains(value, place, box)
    low, high = (closed_loop(each, list(map(absolute, F))) for each in ends(box, box.radii))
    return closed_loop(box, F), high - low


def exterior_discs(
    Y_given: Json,
    T_given: Json,
    listed: Json,
    place: str,
    A: Matrix,
    D: Matrix,
    tied: Sequence[Matrix] = (),
) -> list[Disc]:
    """Discs outside of which Y(λI − A)T is strictly diagonally dominant for every member.

    Each of ``tied`` is added to A with a factor from −1 to 1 of its own.

    Theorems ``boxes.exterior``, ``boxes.exterior_tied``.
    """
    n = A.nrows
    Y = complex_matrix(Y_given, f"{place}.Y", n, n)
    T = complex_matrix(T_given, f"{place}.T", n, n)
    G, H = Y @ T, Y @ T.after(A)
    ones = Matrix([[1]] * n, 1)
    e = Y.magnitudes() @ (D @ (T.magnitudes() @ ones))
    for M in tied:
        e = e + (Y @ T.after(M)).magnitudes() @ ones
    sizes, g, h = G.magnitudes().rows, G.re.denominator, H.re.denominator
    discs: list[Disc] = []
    for i, entry in enumerate(items(listed, f"{place}.discs", n)):
        where = f"{place}.discs[{i}]"
        re, im, radius = (
            decimal(part, where) for part in fields(entry, where, "re", "im", "radius")
        )
        z = re.denominator * im.denominator
        p, q, f = int(re * z) * (h // g), int(im * z) * (h // g), z
        longest = H.limbs + budget.limbs([p, q, f]) + 1
        budget.spend(budget.products(6 * n, H.limbs, longest) + extractions(n, longest))
        budget.spend(budget.fractions(8, longest + e.limbs + budget.limbs_of([radius])))
        numbers = zip(G.re.rows[i], G.im.rows[i], H.re.rows[i], H.im.rows[i], strict=True)
        total = sum(
            magnitude(p * x - q * y - f * u, p * y + q * x - f * v) for x, y, u, v in numbers
        )
        # |G_ii| is rounded down, the others up
        own = math.isqrt(G.re.rows[i][i] ** 2 + G.im.rows[i][i] ** 2)
        slack = Fraction(own + sizes[i][i] - sum(sizes[i]), g)
        require(slack > 0, "dominance", where, "Y T is not diagonally dominant in this row")
        needed = Fraction(total, h * z) + Fraction(e.rows[i][0], e.denominator)
        require(radius * slack > needed, "disc", where, "too small for this row")
        discs.append((re, im, radius))
    return discs


# The pencil of a closed loop with its outputs and inputs as signals, for all members of a box.

PLACE = "claim.gain_radii"


def loop_pencil(box: Box, gain_radii: Json) -> Pencil:
    """λE − Z in the order of the loop's state, then of all y_i, then of all u_i.

    Z is [A, 0, 0, B; 0, L_z, L_y, 0; C, 0, −I, 0; 0, K_z, K_y, −I]: the last two blocks of columns
    are unit lower triangular in the last rows, up to the sign, for every member.

    Open: see ``proofs/OPEN.md``.
    """
    if box.plant is None:
        require(gain_radii is None, "claim", PLACE, "expected null without a controller")
        return Pencil(box.A, box.radii.A, box.n, [each.A for each in box.tied])
    plant, radii = box.plant, box.plant.radii
    agents = read_controller(box.programs, "subject", plant)["agents"]
    programs = programs_of(plant, agents, "subject")
    order = signals_of(plant, agents, programs)
    still: list[list[Terms]] = [[[] for _ in MAPS] for _ in agents]
    uncertain = still if gain_radii is None else _read_radii(gain_radii, plant, agents)
    Z, D = _pencil(plant, order, programs, 1), _pencil(radii, order, uncertain, 0)
    return Pencil(Z, D, box.n, [_pencil(each, order, still, 0) for each in plant.tied])


def _read_radii(value: Json, plant: System, agents: list[Json]) -> list[list[Terms]]:
    """The radii of the programs' matrices, for signals that are in the loop."""
    controller = read_controller(value, PLACE, plant)
    known = [{**agent, **dict.fromkeys(MAPS)} for agent in agents]
    fits = controller["time"] == plant.time
    fits &= [{**agent, **dict.fromkeys(MAPS)} for agent in controller["agents"]] == known
    require(fits, "claim", PLACE, "expected agents of the same sizes, which hold as long")
    programs = programs_of(plant, controller["agents"], PLACE)
    for M in (M for maps in programs for terms in maps for _, M in terms):
        if any(entry < 0 for _, _, entry in entries_of(M)):
            malformed(PLACE, "expected radii from 0 on")
    return programs


def _pencil(
    system: System, order: list[tuple[Signal, int]], programs: list[list[Terms]], one: int
) -> Matrix:
    """The matrix Z of the loop's pencil, where identity matrices are times ``one``."""
    outputs = [(("y", j, 0), C_j.nrows) for j, C_j in enumerate(system.C)]
    inputs = [(("u", j, 0), B_j.ncols) for j, B_j in enumerate(system.B)]
    reads = rows_that_read([*order, *outputs, *inputs])
    x, m = reads["X", 0, 0], range(system.m)
    used = {signal for maps in programs for terms in maps for signal, _ in terms}
    require(used <= reads.keys(), "claim", PLACE, "expected radii for signals of the loop alone")
    rows = rows_of_states(system, programs, order, reads, [reads["u", j, 0] for j in m], one)
    rows += [system.C[j] @ x - reads["y", j, 0].times(one) for j in m]
    for j, (signal, width) in enumerate(inputs):
        rows.append(mapped(programs[j][2], reads, width, x.ncols) - reads[signal].times(one))
    return stack(rows, x.ncols)


# The pencil of a loop in which one output or input, a signal, is multiplied by a complex number.


def multiplied(pencil: Pencil, k: int, alpha: Fraction) -> Pencil:
    """The pencil in which everybody who reads signal k reads it times f = (1 + δ/2)/(1 − δ/2).

    δ is a complex number with |δ| ≤ α < 2.  Two signals stand behind the others, w = δv and
    v + w/2, which is what is read; signal k itself is v, what it was computed from plus w/2.

    Theorem ``box_disk.disk_loop``.
    """
    size = pencil.Z.nrows
    fixed, radius = ([[0] * (size + 2) for _ in range(size + 2)] for _ in range(2))
    fixed[k][size] = 1
    fixed[size][size] = -2
    fixed[size + 1][k], fixed[size + 1][size : size + 2] = 2, [1, -2]
    radius[size][k] = alpha.numerator
    Z = _read_last(pencil.Z, k) + Matrix(fixed, size + 2, 2)
    D = _read_last(pencil.D, k) + Matrix(radius, size + 2, alpha.denominator)
    return Pencil(Z, D, pencil.dynamic, [_read_last(M, k) for M in pencil.tied])


def _read_last(M: Matrix, k: int) -> Matrix:
    """The matrix with two more signals, the last of which all other rows read in place of k."""
    size = M.nrows + 2
    budget.spend(budget.table(size, size, M.limbs))
    rows = [[*row[:k], 0, *row[k + 1 :], 0, row[k]] for row in M.rows]
    rows[k] = [*M.rows[k], 0, 0]
    return Matrix([*rows, [0] * size, [0] * size], size, M.denominator)


def inverse_multiplied(V: ComplexMatrix, k: int) -> ComplexMatrix:
    """[V, Ve − e/2, Ve − e; 0, 1, 0; e'V, e'Ve, e'Ve], e the unit vector of the signal k.

    It is the inverse of the nominal pencil of `multiplied` if V is that of the pencil.
    """
    size = V.re.nrows
    budget.spend(2 * budget.table(size + 2, size + 2, V.limbs))
    parts = []
    for M in (V.re, V.im):
        rows = [[*row, row[k], row[k]] for row in M.rows]
        parts.append(Matrix([*rows, [0] * (size + 2), rows[k]], size + 2, M.denominator))
    re, im = parts
    fixed = [[0] * (size + 2) for _ in range(size + 2)]
    fixed[k][size : size + 2] = [-1, -2]
    fixed[size][size] = 2
    re = re + Matrix(fixed, size + 2, 2)
    d = math.lcm(re.denominator, im.denominator)
    return ComplexMatrix(*(_over(M, d) for M in (re, im)))


def _over(M: Matrix, d: int) -> Matrix:
    """The matrix over a multiple of its denominator."""
    f = d // M.denominator
    budget.spend(budget.table(M.nrows, M.ncols, M.limbs))
    return Matrix([[f * entry for entry in row] for row in M.rows], M.ncols, d)


Pair = tuple[Fraction, Fraction]
"""A radius, and the absolute value of the entry that it is of."""


def pairs_of(nominal: list[Matrix], radii: list[Matrix]) -> list[Pair]:
    """The radius of each entry that is uncertain or not 0."""
    pairs = list[Pair]()
    for M, D in zip(nominal, radii, strict=True):
        values = {(i, j): abs(x) for i, j, x in entries_of(M)}
        spread = {(i, j): radius for i, j, radius in entries_of(D)}
        places, longest = {**values, **spread}, max(M.limbs, D.limbs)
        budget.spend(100 + 200 * len(places) + 4 * budget.fractions(len(places), longest))
        for place in places:
            radius = Fraction(spread.get(place, 0), D.denominator)
            pairs.append((radius, Fraction(values.get(place, 0), M.denominator)))
    return pairs


def radii_in_words(pairs: list[Pair], whose: str) -> str:
    """How far entries may be from "the latter", whose radii are ``whose`` in words.

    Where all radii are one part of the absolute values, this part says all; otherwise how many
    radii there are, the largest one, and the largest part, unless an entry that is 0 is uncertain.
    """
    wide = [pair for pair in pairs if pair[0]]
    longest = budget.limbs_of([number for pair in pairs for number in pair])
    budget.spend(budget.fractions(4 * len(pairs) + 4, 2 * longest))
    if not wide:
        return f"by at most {whose} (no entry has one)"
    parts = [radius / value for radius, value in wide if value]
    largest = f"none above {max(radius for radius, _ in wide)}"
    if len(parts) == len(wide):
        most = f"{max(parts)} of the absolute value"
        if len(pairs) == len(wide) and len(set(parts)) == 1:
            return f"by at most {most}s of the latter"
        largest += f" and none above {most} of its entry"
    have = "1 entry has one" if len(wide) == 1 else f"{len(wide)} entries have one"
    return f"by at most {whose} ({have}, {largest})"
