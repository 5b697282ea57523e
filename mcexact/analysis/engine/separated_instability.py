"""A quadratic form that proves instability, assembled from forms for diagonal blocks of a loop."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from mcexact.analysis.engine.lyapunov import QuadraticForm, decrease, is_dominant
from mcexact.answer.stability import InstabilityMethod
from mcexact.exact.matrix import Matrix, block_diagonal, vstack
from mcexact.exact.roots import StabilityRegion

_SCALES = (8, 24, 48, 96)


def separated_instability(
    M: Matrix,
    T: Matrix,
    inverse: Matrix,
    forms: Sequence[QuadraticForm],
    region: StabilityRegion,
) -> InstabilityMethod | None:
    """P, R2 and v for M = T Δ T⁻¹, Δ block upper triangular, from those of the diagonal blocks.

    Parameters
    ----------
    M, T, inverse : Matrix, N × N
    forms : sequence of QuadraticForm
        One for each diagonal block, at least one with a ``v``.
    region : StabilityRegion

    Returns
    -------
    InstabilityMethod or None
        None if no tried scale makes the off-diagonal blocks small enough.

    Notes
    -----
    With P = T⁻ᵀ diag(c_i P_i) T⁻¹ and R2 = T diag(R2_i / √c_i) the diagonal blocks of R2ᵀSR2 are
    those of the parts, and a block above the diagonal has the factor √(c_i/c_j), which is
    2^−k with c_j = 4^k c_i.  O(N³).
    """
    k = next(i for i, form in enumerate(forms) if form.v is not None)
    sizes = [form.P.nrows for form in forms]
    inner = forms[k].v
    if inner is None:
        return None
    before, after = sum(sizes[:k]), sum(sizes[k + 1 :])
    v = T @ vstack([Matrix.zeros(before, 1), inner, Matrix.zeros(after, 1)])
    for scale in _SCALES:
        roots = [Fraction(2) ** (scale * i) for i in range(len(forms))]
        weighted = block_diagonal(
            [form.P * root**2 for form, root in zip(forms, roots, strict=True)]
        )
        P = inverse.T @ (weighted @ inverse)
        R2 = T @ block_diagonal(
            [form.R2 * (1 / root) for form, root in zip(forms, roots, strict=True)]
        )
        if is_dominant(R2.T @ (decrease(M, P, region) @ R2)):
            return InstabilityMethod(P, R2, v)
    return None
