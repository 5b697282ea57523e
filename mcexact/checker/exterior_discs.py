"""Discs that contain the spectrum of every member of a box; ``proofs/boxes.md``."""

import math
from fractions import Fraction

from . import budget
from .arithmetic import Matrix
from .complex_matrices import complex_matrix, magnitude, magnitudes
from .reading import Json, decimal, fields, items, require
from .root_discs import Disc


def exterior_discs(value: Json, place: str, A: Matrix, D: Matrix) -> list[Disc]:
    """Discs outside of which Y(λI − A)T is strictly diagonally dominant for every member.

    Theorem ``boxes.exterior``.
    """
    Y_given, T_given, listed = fields(value, place, "Y", "T", "discs")
    n = A.nrows
    Y = complex_matrix(Y_given, f"{place}.Y", n, n)
    T = complex_matrix(T_given, f"{place}.T", n, n)
    G, H = Y @ T, Y @ T.after(A)
    e = Y.magnitudes() @ (D @ (T.magnitudes() @ Matrix([[1]] * n, 1)))
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
        budget.spend(budget.products(6 * n, H.limbs, longest) + magnitudes(n, longest))
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
