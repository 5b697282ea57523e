"""Discs that contain the spectrum of every member of a box, with gains; ``proofs/boxes.md``."""

import math
from collections.abc import Sequence
from fractions import Fraction

from . import budget
from .arithmetic import Matrix
from .boxes import Box, absolute, ends
from .complex_matrices import complex_matrix, extractions, magnitude
from .evidence import closed_loop, read_gains
from .reading import Json, decimal, fields, items, malformed, require
from .root_discs import Disc


def discs_of_gains(value: Json, place: str, box: Box) -> list[list[Disc]]:
    """Lists of discs, each of which contains what is fixed for any member.

    Theorem ``boxes.fixed_in_exterior``.
    """
    found = []
    for k, entry in enumerate(items(value, place)):
        where = f"{place}[{k}]"
        F, Y, T, listed = fields(entry, where, "F", "Y", "T", "discs")
        A, D, tied = box.A, box.radii.A, [each.A for each in box.tied]
        if F is not None:
            (A, D), tied = with_gains(F, f"{where}.F", box.independent()), []
        found.append(exterior_discs(Y, T, listed, where, A, D, tied))
    if not found:
        malformed(place, "expected the discs of one matrix or more")
    return found


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
