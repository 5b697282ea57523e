"""Shrunk subspaces and zero transfers; ``proofs/evidence.md``."""

from .arithmetic import Matrix, Polynomial, rank
from .evidence import complement, inputs, require_identity
from .reading import Json, fields, matrix, names, polynomial_matrix, positions, require
from .system import System


def require_pencil_kernel(
    A: Matrix, B: Matrix, U: list[Matrix], V: list[Matrix], p: Polynomial, place: str
) -> None:
    """Stop unless (xI − A) U = B V modulo p, U and V reduced modulo the monic p of degree ≥ 1.

    Theorem ``deficiency.pencil_rank_upper``.
    """
    top = U[-1]  # (xI − A)U − BV has degree ≤ deg p, so it must be p·top exactly
    for t, (U_t, V_t) in enumerate(zip(U, V, strict=True)):
        left = A @ U_t + B @ V_t + top.times(p[t])
        shifted = U[t - 1] if t else Matrix.zeros(U_t.nrows, U_t.ncols)
        require(shifted.equals(left), "identity", place, "(xI - A) U differs from B V modulo p")


def shrunk_subspace(
    value: Json, place: str, system: System, p: Polynomial, deficiency: int
) -> list[int]:
    """Check a shrunk subspace of at least this deficiency ≥ 1 for p, and return its T.

    Theorems ``evidence.shrunk_subspace_fixed``, ``evidence.shrunk_subspace_fixed_dynamic``,
    ``evidence.shrunk_subspace_rank``, ``evidence.shrunk_subspace_dynamic``,
    ``evidence.shrunk_subspace_pencil``.
    """
    chosen, U_layers, V_layers, listed = fields(value, place, "channels_T", "U", "V", "pivots")
    T = names(chosen, f"{place}.channels_T", system.names)
    pivots = positions(listed, f"{place}.pivots", system.n)
    u, B_T = len(pivots), inputs(system, T)
    U = polynomial_matrix(U_layers, f"{place}.U", system.n, u, len(p) - 1)
    V = polynomial_matrix(V_layers, f"{place}.V", B_T.ncols, u, len(p) - 1)
    require_identity(U, pivots, f"{place}.pivots")
    require_pencil_kernel(system.A, B_T, U, V, p, place)
    for i in complement(system, T):
        unseen = all((system.C[i] @ layer).is_zero() for layer in U)
        require(unseen, "identity", place, f"C_i U is not zero for channel number {i + 1}")
    lost = u - rank(B_T)
    message = f"proves deficiency {lost}, not {deficiency} >= 1"
    require(lost >= deficiency >= 1, "rank", place, message)
    return T


def zero_transfer(value: Json, place: str, system: System) -> tuple[list[int], Matrix]:
    """Check that im X is A-invariant and holds im B_j for the channels j, and return j's and X.

    Theorems ``transfer_graph.zero_transfer_no_arc``, ``transfer_graph.zero_transfer_cut``.
    """
    chosen, X_rows, listed = fields(value, place, "from", "X", "pivots")
    sources = names(chosen, f"{place}.from", system.names)
    pivots = positions(listed, f"{place}.pivots", system.n)
    X = matrix(X_rows, f"{place}.X", system.n, len(pivots))
    require_identity([X], pivots, f"{place}.pivots")
    for image, what in ((system.A @ X, "A X"), (inputs(system, sources), "B")):
        inside = image.equals(X @ image.take(pivots))
        require(inside, "identity", place, f"the columns of {what} leave the span of X")
    return sources, X
