"""Gains with which the pencil of a box stays regular at a point for large radii.

Proposed in floating point: the logarithm of the spectral radius of |Z⁻¹| D is minimized over the
block-diagonal X and W by L-BFGS, from several starts.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from mcexact.analysis.boxes.float_pencils import FloatBox, Floats, perron
from mcexact.exact.matrix import Matrix

Gains = tuple[tuple[Floats, ...], tuple[Floats, ...]]

_ROUNDS = 60
_DRAWS = 8
_KNOWN = 2
_ENOUGH, _GOOD = 8.0, 4.0
"""A start is used as it is from the first multiple of the target on, a result from the second."""
_GAIN_BITS = 20


@dataclass(frozen=True)
class _Shape:
    """Sizes p_i and q_i, and where the entries of X_i and W_i are in a vector."""

    sizes: tuple[tuple[int, int], ...]

    def gains(self, t: Floats) -> Gains:
        X, W, k = [], [], 0
        for p, q in self.sizes:
            X.append(t[k : k + p * q].reshape(p, q))
            W.append(t[k + p * q : k + p * q + p * p].reshape(p, p))
            k += p * q + p * p
        return tuple(X), tuple(W)

    def vector(self, gains: Gains) -> Floats:
        return np.concatenate([M.ravel() for both in zip(*gains, strict=True) for M in both])


def best_gains(
    box: FloatBox,
    point: complex,
    rng: np.random.Generator,
    *,
    starts: int = 4,
    target: float = 1.0,
    known: Sequence[Gains] = (),
) -> tuple[float, Gains] | None:
    """Search gains for a point, and return how far the radii can then grow, and the gains.

    Parameters
    ----------
    box : FloatBox
    point : complex
    rng : numpy.random.Generator
    starts : int
        How many local searches there are at most.
    target : float
        The factor of the radii that is needed; the search ends early far above it.
    known : sequence of gains
        Local searches begin at the best two of these, too.

    Returns
    -------
    (float, gains) or None
        None without inputs.
    """
    from scipy.optimize import minimize

    shape = _Shape(tuple((B.shape[1], C.shape[0]) for B, C in zip(box.B, box.C, strict=True)))
    if not any(p for p, _ in shape.sizes):
        return None

    def value(t: Floats) -> tuple[float, Floats]:
        return _logarithm(box, shape, t, point)

    def ranked(vectors: Iterable[Floats]) -> list[tuple[float, Floats]]:
        return sorted(((value(t)[0], t) for t in vectors), key=lambda each: each[0])

    begun = ranked(shape.vector(each) for each in known)[:_KNOWN]
    begun += ranked(_start(box, shape, rng) for _ in range(_DRAWS * starts))[:starts]
    best, found = min(begun, key=lambda each: each[0])
    if np.exp(-best) > _ENOUGH * target:
        return float(np.exp(-best)), shape.gains(found)
    for _, t in begun:
        unit = np.maximum(np.abs(t), 1e-3 * np.abs(t).max())

        def scaled(z: Floats, unit: Floats = unit) -> tuple[float, Floats]:
            size, gradient = value(z * unit)
            return size, gradient * unit

        result = minimize(
            scaled, t / unit, jac=True, method="L-BFGS-B", options={"maxiter": _ROUNDS}
        )
        if result.fun < best:
            best, found = float(result.fun), result.x * unit
        if np.exp(-best) > _GOOD * target:
            break
    return float(np.exp(-best)), shape.gains(found)


def exact_gains(gains: Gains) -> tuple[tuple[Matrix, ...], tuple[Matrix, ...]]:
    """Round gains to dyadic numbers; each row of [X_i, W_i] is scaled to a largest entry near 1."""
    X_exact, W_exact = [], []
    for X, W in zip(*gains, strict=True):
        both = np.hstack([X, W])
        top = np.abs(both).max(axis=1, initial=0.0)
        both = both / np.exp2(np.floor(np.log2(np.maximum(top, 1e-290))))[:, None]
        exact = Matrix.from_rows([[_short(x) for x in row] for row in both.tolist()], both.shape[1])
        q = X.shape[1]
        X_exact.append(exact.take(cols=range(q)))
        W_exact.append(exact.take(cols=range(q, q + W.shape[1])))
    return tuple(X_exact), tuple(W_exact)


def _short(x: float) -> Fraction:
    """A number with some significant bits."""
    mantissa, exponent = np.frexp(x)
    return Fraction(round(float(mantissa) * 2**_GAIN_BITS)) * Fraction(2) ** (
        int(exponent) - _GAIN_BITS
    )


def _start(box: FloatBox, shape: _Shape, rng: np.random.Generator) -> Floats:
    """Draw gains of a drawn size, with W = I."""
    size = 10 ** rng.uniform(-2, 2) * max(float(np.linalg.norm(box.A)), 1e-12)
    parts: list[Floats] = []
    for B, C, (p, q) in zip(box.B, box.C, shape.sizes, strict=True):
        around = max(float(np.linalg.norm(B)) * float(np.linalg.norm(C)), 1e-300)
        signs = rng.choice([-1, 0, 1], p=[0.4, 0.2, 0.4], size=(p, q))
        X = signs * rng.uniform(0.3, 1, size=(p, q)) * size / around
        parts += [X.ravel(), np.eye(p).ravel()]
    return np.concatenate(parts)


def _logarithm(box: FloatBox, shape: _Shape, t: Floats, point: complex) -> tuple[float, Floats]:
    """The logarithm of the spectral radius of |Z⁻¹| D, and its gradient by the entries of X and W.

    With positive vectors l and r, lᵀr = 1, and Y = Z⁻¹: dρ = lᵀ d(|Y| D) r, dY = −Y dZ Y.
    """
    X, W = shape.gains(t)
    Z, D = _pencil(box, X, W, point)
    try:
        Y = np.linalg.inv(Z)
    except np.linalg.LinAlgError:
        return 1e6, np.zeros_like(t)
    size = np.abs(Y)
    value, right, left = perron(size @ D)
    if not (np.isfinite(value) and value > 0):
        return 1e6 if not np.isfinite(value) else -700.0, np.zeros_like(t)
    left = left / (left @ right)
    phase = np.conj(Y) / np.maximum(size, 1e-300)
    K = phase * np.outer(left, D @ right)
    by_Z = -np.real(Y @ K.T @ Y).T
    by_D = np.outer(size.T @ left, right)
    gradient, n, start = [], box.n, box.n
    for X_i, W_i, C_i, DC_i in zip(X, W, box.C, box.DC, strict=True):
        rows = slice(start, start + len(W_i))
        by_X = by_Z[rows, :n] @ C_i.T + np.sign(X_i) * (by_D[rows, :n] @ DC_i.T)
        gradient += [by_X.ravel(), by_Z[rows, rows].ravel()]
        start += len(W_i)
    found = np.concatenate(gradient) / value
    return float(np.log(value)), np.where(np.isfinite(found), found, 0.0)


def _pencil(
    box: FloatBox, X: Sequence[Floats], W: Sequence[Floats], point: complex
) -> tuple[npt.NDArray[np.complex128], Floats]:
    """[[λI − A, −B], [XC, W]] at a point, and the radii of its entries."""
    n, p = box.n, sum(map(len, W))
    Z = np.zeros((n + p, n + p), dtype=np.complex128)
    D = np.zeros((n + p, n + p))
    Z[:n, :n], D[:n, :n] = point * np.eye(n) - box.A, box.DA
    start = n
    for B, DB, C, DC, X_i, W_i in zip(box.B, box.DB, box.C, box.DC, X, W, strict=True):
        rows = slice(start, start + len(W_i))
        Z[:n, rows], D[:n, rows] = -B, DB
        Z[rows, :n], D[rows, :n] = X_i @ C, np.abs(X_i) @ DC
        Z[rows, rows] = W_i
        start += len(W_i)
    return Z, D
