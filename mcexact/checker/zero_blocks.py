"""Zero blocks, which prove that modes of a system with a parameter are fixed."""

from collections.abc import Sequence
from fractions import Fraction

from . import layered, reading
from .arithmetic import Matrix, Polynomial
from .parametric_system import Layers, ParametricSystem
from .reading import Json, fields, items, names, positions, require
from .two_variables import Bivariate


def zero_block(
    value: Json, place: str, system: ParametricSystem, p: Bivariate, q: Polynomial | None = None
) -> list[int]:
    """Check W (xI − A) U = 0 modulo p and q, W B_T = 0 and C_i U = 0 outside T; return T.

    W has a rows and U has u columns, independent, and a + u > n: the rows ``row_pivots`` of U and
    the columns ``column_pivots`` of W are c(t) times an identity matrix, with c = 1 modulo q, or
    c ≠ 0 where there is no q.

    Theorems ``zero_blocks.zero_block_det``, ``zero_blocks.zero_block_pivots``,
    ``zero_blocks.zero_block_fixed``, ``zero_blocks.zero_block_pencil``.
    """
    keys = ("channels_T", "U", "W", "row_pivots", "column_pivots")
    chosen, given, listed, rows, columns = fields(value, place, *keys)
    T, n = names(chosen, f"{place}.channels_T", system.names), system.n
    above = positions(rows, f"{place}.row_pivots", n)
    beside = positions(columns, f"{place}.column_pivots", n)
    require(len(above) + len(beside) > n, "rank", place, "the zero block is too small")
    parts = items(given, f"{place}.U", len(p) - 1)
    U = [polynomial_layers(part, f"{place}.U", n, len(above), q) for part in parts]
    W = polynomial_layers(listed, f"{place}.W", len(beside), n, q)
    pivots = [[layer.take(above) for layer in part] for part in U]
    require_multiple(pivots[0], len(above), f"{place}.row_pivots", q)
    outside = all(layered.is_zero(part) for part in pivots[1:])
    require(outside, "pivots", place, "a pivot row depends on x")
    chosen_columns = [layer.T.take(beside) for layer in W]
    require_multiple(chosen_columns, len(beside), f"{place}.column_pivots", q)
    for i in T:
        unmoved = layered.is_zero(layered.product(W, system.B[i], q))
        require(unmoved, "identity", place, f"W B_i is not zero for channel number {i + 1}")
    for i in system.others(T):
        unseen = all(layered.is_zero(layered.product(system.C[i], part, q)) for part in U)
        require(unseen, "identity", place, f"C_i U is not zero for channel number {i + 1}")
    WA = layered.product(W, system.A, q)
    WU = [layered.product(W, part, q) for part in U]
    shifted: list[Layers] = [[Matrix.zeros(len(beside), len(above))], *WU[:-1]]
    for before, part, c in zip(shifted, U, p, strict=False):
        # x^(deg p) = −Σ c x^k modulo p
        folded = layered.product(WU[-1], _scalar(c, len(above)), q)
        left = layered.difference(before, layered.product(WA, part, q))
        vanishes = layered.is_zero(layered.difference(left, folded))
        require(vanishes, "identity", place, "W (xI - A) U is not zero modulo p")
    return T


def polynomial_layers(
    value: Json, place: str, nrows: int, ncols: int, q: Polynomial | None
) -> Layers:
    """A matrix of polynomials in t, reduced modulo q."""
    _, coefficients = fields(value, place, "denominator", "coefficients")
    most = len(items(coefficients, place)) if q is None else len(q) - 1
    return reading.polynomial_matrix(value, place, nrows, ncols, most)


def _scalar(c: Polynomial, size: int) -> Layers:
    """c(t) times an identity matrix."""
    identity = Matrix.unit_rows(size, 0, size)
    return [identity.times(entry) for entry in c] or [Matrix.zeros(size, size)]


def require_multiple(block: Sequence[Matrix], size: int, place: str, q: Polynomial | None) -> None:
    """Stop unless a block is c(t) times an identity matrix, c = 1 if q is given, else c ≠ 0."""
    identity = Matrix.unit_rows(size, 0, size)
    factors = [layer.times(0) if not size else identity.times(_corner(layer)) for layer in block]
    same = layered.is_zero(layered.difference(list(block), factors))
    corner = [_corner(layer) for layer in block] if size else [1]
    good = any(corner) if q is None else corner[0] == 1 and not any(corner[1:])
    require(same and good, "pivots", place, "expected a multiple of an identity matrix there")


def _corner(layer: Matrix) -> Fraction:
    """The first entry."""
    return Fraction(layer.rows[0][0], layer.denominator)
