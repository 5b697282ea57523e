"""Whether a closed loop is stable or fast enough, decided exactly, both answers certified."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import accumulate, pairwise
from typing import Any, Literal, get_args

from mcexact.analysis.engine import QuadraticForm, quadratic_form, separated_instability
from mcexact.answer.stability import (
    InstabilityMethod,
    LyapunovBlock,
    LyapunovForm,
    LyapunovMethod,
    PolynomialMethod,
    StabilityVerdict,
    Transformation,
)
from mcexact.derived.modular import generator
from mcexact.errors import InputError, UsageError, one_of
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import Entry, as_fraction
from mcexact.exact.roots import StabilityRegion, lifted
from mcexact.model.entries import as_matrix
from mcexact.model.system import MultiChannelSystem

Method = Literal["polynomial", "lyapunov"]

POLYNOMIAL_LIMIT = 40
"""The number of states up to which the characteristic polynomial comes first; it costs O(n⁵)."""


@dataclass(frozen=True)
class Separation:
    """A change of coordinates that makes a loop block upper triangular.

    Attributes
    ----------
    T : Matrix
        N × N, nonsingular: M T = T Δ.
    Delta : Matrix
        N × N, block upper triangular.
    sizes : tuple of int
        The sizes of its diagonal blocks.
    inverse : Matrix or None
        T⁻¹, if it is known; with it, instability is also proved block by block.
    """

    T: Matrix
    Delta: Matrix
    sizes: tuple[int, ...]
    inverse: Matrix | None = None

    def blocks(self) -> tuple[Matrix, ...]:
        """The diagonal blocks of Δ."""
        ends = [0, *accumulate(self.sizes)]
        ranges = [range(a, b) for a, b in pairwise(ends)]
        return tuple(self.Delta.take(rows=r, cols=r) for r in ranges)


def matrix_system(M: Any, time: str = "continuous") -> MultiChannelSystem:
    """Make a closed loop from its matrix: a plant whose one channel has no input and no output.

    Parameters
    ----------
    M : matrix, N × N
        A list of rows, or another form that `MultiChannelSystem` accepts for A.
    time : {"continuous", "discrete"}
    """
    exact = as_matrix(M, "M")
    N = exact.nrows
    return MultiChannelSystem(
        exact, [Matrix.zeros(N, 0)], [Matrix.zeros(0, N)], time=time, names=["loop"]
    )


def certify_stability(
    loop: MultiChannelSystem,
    region: StabilityRegion | None = None,
    *,
    rate: Entry | None = None,
    radius: Entry | None = None,
    damping: Entry | None = None,
    largest_modulus: Entry | None = None,
    method: Method | None = None,
    separation: Separation | None = None,
    polynomial: Polynomial | None = None,
) -> StabilityVerdict:
    """Decide whether every eigenvalue of a closed loop is fast enough.

    Parameters
    ----------
    loop : MultiChannelSystem
        A closed loop (`closed_loop`, `loop_from_statespace`), or `matrix_system` of a matrix; only
        A is used.
    region : StabilityRegion, optional
        The region in which every eigenvalue should lie.
    rate, radius : rational, optional
        A number instead of the region: real parts below −rate (continuous time), or moduli below
        the radius (discrete time).  By default only stability is decided.
    damping, largest_modulus : rational, optional
        In continuous time, besides a rate: −Re λ > damping·|λ|, and |λ| < largest_modulus.
    method : {"polynomial", "lyapunov"}, optional
        By default the characteristic polynomial for small loops, Lyapunov matrices for large ones,
        and the polynomial again if these are inconclusive.
    separation : Separation, optional
        Coordinates in which the loop is certified block by block.
    polynomial : Polynomial, optional
        The characteristic polynomial of the loop, if it is known.

    Raises
    ------
    UsageError
        If the rate or radius is out of range, the method is unknown, the separation does not fit
        the loop, or the Lyapunov method was inconclusive.

    Notes
    -----
    Both answers are exact.  Near the boundary only the polynomial decides.

    Examples
    --------
    >>> M = Matrix.from_rows([[0, 1], [-2, -3]])
    >>> certify_stability(matrix_system(M)).stable
    True
    >>> certify_stability(matrix_system(M), rate=1).stable
    False
    >>> certify_stability(matrix_system(M), damping="1/2", largest_modulus=3).stable
    True
    """
    InputError.require(loop, MultiChannelSystem, "loop")
    region = StabilityRegion.asked(loop.time, region, rate, radius) or StabilityRegion(loop.time)
    if damping is not None or largest_modulus is not None:
        region = region.limited(damping, largest_modulus)
    if polynomial is not None:
        InputError.require(polynomial, Polynomial, "polynomial")
    one_of(method, (None, *get_args(Method)), "method")
    if separation is not None:
        _require_separation(loop.A, separation)
    tried = (method,) if method is not None else _order(loop.n, separation)
    for each in tried:
        found: PolynomialMethod | LyapunovMethod | InstabilityMethod | None
        if each == "polynomial":
            polynomial = polynomial or characteristic_polynomial(loop.A)
            stable = region.contains_roots_of(polynomial)
            found = PolynomialMethod()
        else:
            found = _lyapunov(loop, region, separation)
            stable = isinstance(found, LyapunovMethod)
        if found is not None:
            return StabilityVerdict(
                loop, bound=region.bound, stable=stable, **region.limits, evidence=found
            )
    raise UsageError("the Lyapunov method was inconclusive: leave out `method`", where="method")


def _order(n: int, separation: Separation | None) -> tuple[Method, ...]:
    if n <= POLYNOMIAL_LIMIT and separation is None:
        return ("polynomial",)
    return ("lyapunov", "polynomial")


def _require_separation(M: Matrix, separation: Separation) -> None:
    InputError.require(separation, Separation, "separation")
    N, T, Delta = M.nrows, separation.T, separation.Delta
    if T.shape != (N, N) or Delta.shape != (N, N) or sum(separation.sizes) != N:
        raise UsageError(f"expected T, Δ and blocks of {N} states", where="separation")
    start = 0
    for size in separation.sizes:
        below = Delta.take(rows=range(start + size, N), cols=range(start, start + size))
        if not below.is_zero():
            raise UsageError("Δ is not block upper triangular", where="separation")
        start += size
    if separation.inverse is not None and T @ separation.inverse != Matrix.identity(N):
        raise UsageError("what is given as the inverse of T is not", where="separation")
    if T @ Delta != M @ T:
        raise UsageError("M T differs from T Δ", where="separation")


def _lyapunov(
    loop: MultiChannelSystem, region: StabilityRegion, separation: Separation | None
) -> LyapunovMethod | InstabilityMethod | None:
    """Find quadratic forms of the blocks, or of the whole loop if unstable; None if undecided."""
    parts: Sequence[Matrix] = (loop.A,) if separation is None else separation.blocks()
    found: dict[str, list[LyapunovForm]] = {}
    for side in ("bound", *region.limits):
        forms = []
        for D in parts:
            form = quadratic_form(*_of_side(side, D, region))
            if form is None:
                return None
            forms.append(form)
        if any(form.R is None for form in forms):
            return _instability(loop, region, side, separation, forms)
        found[side] = [LyapunovForm(f.P, f.R, f.R2) for f in forms if f.R is not None]
    blocks = []
    for k, first in enumerate(found.pop("bound")):
        block = LyapunovBlock(first.P.nrows, first.P, first.R, first.R2)
        limits: dict[str, Any] = {side: made[k] for side, made in found.items()}
        blocks.append(replace(block, **limits))
    transformation = None
    if separation is not None:
        modulus = _nonsingular_modulus(loop, separation.T)
        transformation = Transformation(separation.T, separation.Delta, modulus)
    return LyapunovMethod(transformation, tuple(blocks))


def _of_side(side: str, D: Matrix, region: StabilityRegion) -> tuple[Matrix, StabilityRegion]:
    """A matrix that has all its eigenvalues in a region, iff D meets this side of the given one."""
    if side == "damping" and region.damping is not None:
        return lifted(D, region.damping), StabilityRegion(region.time)
    if side == "largest_modulus" and region.largest_modulus is not None:
        return D * (1 / region.largest_modulus), StabilityRegion("discrete")
    return D, StabilityRegion(region.time, region.bound)


def _instability(
    loop: MultiChannelSystem,
    region: StabilityRegion,
    side: str,
    separation: Separation | None,
    forms: Sequence[QuadraticForm],
) -> InstabilityMethod | None:
    """A form for the whole loop: its only block's, that made of the blocks', or a new one."""
    named = side if region.limits else None
    if separation is None:
        [form] = forms
    elif separation.inverse is not None and side == "bound":
        T, inverse = separation.T, separation.inverse
        found = separated_instability(loop.A, T, inverse, forms, region)
        return None if found is None else replace(found, side=named)
    else:
        whole = quadratic_form(*_of_side(side, loop.A, region))
        if whole is None:
            return None
        form = whole
    return None if form.v is None else InstabilityMethod(form.P, form.R2, form.v, side=named)


def _nonsingular_modulus(loop: MultiChannelSystem, T: Matrix) -> int:
    """A prime modulo which T stays nonsingular.

    Raises
    ------
    UsageError
        If T is singular modulo every prime tried, and hence probably singular.
    """
    rng = generator(loop, StabilityVerdict.kind)
    for attempt, ell in enumerate(primes(rng.getrandbits(64))):
        if T.denominator % ell and residues(T, ell).rank() == T.nrows:
            return ell
        if attempt == 20:
            break
    raise UsageError("T is singular", where="separation")


def fastest_region(
    loop: MultiChannelSystem, *, accuracy: Entry = Fraction(1, 10**6)
) -> StabilityRegion | None:
    """The region of the largest rate on a grid (least radius, in discrete time) that a loop meets.

    Parameters
    ----------
    loop : MultiChannelSystem
    accuracy : rational > 0
        Width of the last interval of the bisection.

    Returns
    -------
    StabilityRegion or None
        The region of a rate R that the loop meets while it does not meet R + accuracy (or of a
        radius R, while it does not meet R − accuracy).  None if the loop is not stable, or in
        continuous time not faster than ``accuracy``.

    Notes
    -----
    Exact: one characteristic polynomial over Q, and a Routh or Schur–Cohn test for each step.

    Examples
    --------
    >>> M = Matrix.from_rows([[0, 1], [-2, -3]])
    >>> str(fastest_region(matrix_system(M), accuracy="1/8"))
    'Re λ < -7/8'
    """
    width = as_fraction(accuracy)
    if width <= 0:
        raise UsageError("expected a positive number", where="accuracy")
    chi, whole = characteristic_polynomial(loop.A), StabilityRegion(loop.time)
    if not whole.contains_roots_of(chi) or chi.degree == 0:
        return None

    def meets(bound: Fraction) -> bool:
        return StabilityRegion(loop.time, bound).contains_roots_of(chi)

    holds, fails = whole.edge, Fraction(0)
    if not whole.discrete:
        fails = Fraction(1)
        while meets(fails):
            holds, fails = fails, 2 * fails
    while abs(fails - holds) > width:
        middle = (holds + fails) / 2
        holds, fails = (middle, fails) if meets(middle) else (holds, middle)
    return StabilityRegion(loop.time, holds) if holds else None
