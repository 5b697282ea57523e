"""Whether a closed loop is as fast as asked, decided exactly, and certified either way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate, pairwise
from typing import Any, Literal

from mcexact.analysis.lyapunov import QuadraticForm, quadratic_form
from mcexact.analysis.modular_system import generator
from mcexact.analysis.separated_instability import separated_instability
from mcexact.certificate.stability import (
    InstabilityMethod,
    LyapunovBlock,
    LyapunovMethod,
    PolynomialMethod,
    StabilityCertificate,
    Transformation,
)
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion, bounded_region
from mcexact.exact.location import region as named_region
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import Entry, as_fraction
from mcexact.model.matrix_entry import as_matrix
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import canonical_document

Method = Literal["polynomial", "lyapunov"]

POLYNOMIAL_LIMIT = 40
"""States up to which the characteristic polynomial is tried first: its cost grows with n⁵ here."""


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
        T⁻¹, where it is at hand: with it a "no" goes block by block as well.
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


@dataclass(frozen=True)
class StabilityVerdict:
    """Whether every eigenvalue meets the bound.

    Attributes
    ----------
    stable : bool
    region : StabilityRegion
        Where the eigenvalues were asked to lie.
    method : str
        ``"polynomial"``, ``"lyapunov"`` or ``"instability"``: the road that decided.
    certificate : StabilityCertificate
    """

    stable: bool
    region: StabilityRegion
    method: str
    certificate: StabilityCertificate


def matrix_system(M: Any, time: str = "continuous") -> MultiChannelSystem:
    """A closed loop given as a matrix alone: a plant whose one channel has no input and no output.

    Parameters
    ----------
    M : matrix, N × N
        A list of rows or whatever else `MultiChannelSystem` takes for A.
    time : {"continuous", "discrete"}
    """
    exact = as_matrix(M, "M")
    N = exact.nrows
    return MultiChannelSystem(
        exact, [Matrix.zeros(N, 0)], [Matrix.zeros(0, N)], time=time, names=["loop"]
    )


def certify_stability(
    loop: MultiChannelSystem,
    bound: Entry | None = None,
    *,
    rate: Entry | None = None,
    radius: Entry | None = None,
    method: Method | None = None,
    separation: Separation | None = None,
) -> StabilityVerdict:
    """Decide whether every eigenvalue of a closed loop is fast enough.

    Parameters
    ----------
    loop : MultiChannelSystem
        A closed loop (`closed_loop`, `loop_from_statespace`), or `matrix_system` of a matrix; what
        counts is its A.
    bound : rational, optional
        A rate R (continuous time: real parts below −R) or a radius R (discrete time: moduli below
        R); by default the stability region.
    rate, radius : rational, optional
        The same by name; the one of the other time domain is refused.
    method : {"polynomial", "lyapunov"}, optional
        By default the characteristic polynomial for small loops, Lyapunov matrices for large
        ones, and the polynomial again where these do not decide.
    separation : Separation, optional
        Certify diagonal block by diagonal block.

    Raises
    ------
    UsageError
        The bound is out of range, the separation does not fit the loop, or Lyapunov matrices were
        asked for and do not decide.

    Notes
    -----
    Exact, both ways.  Near the boundary the polynomial is the only road.

    Examples
    --------
    >>> M = Matrix.from_rows([[0, 1], [-2, -3]])
    >>> certify_stability(matrix_system(M)).stable
    True
    >>> certify_stability(matrix_system(M), rate=1).stable
    False
    """
    region = _asked_region(loop.time, bound, rate, radius)
    if separation is not None:
        _require_separation(loop.A, separation)
    tried = (method,) if method is not None else _order(loop.n, separation)
    for each in tried:
        found: PolynomialMethod | LyapunovMethod | InstabilityMethod | None
        if each == "polynomial":
            stable = region.contains_roots_of(characteristic_polynomial(loop.A))
            found = PolynomialMethod()
        else:
            found = _lyapunov(loop, region, separation)
            stable = isinstance(found, LyapunovMethod)
        if found is not None:
            certificate = StabilityCertificate(
                system=canonical_document(loop.plant),
                subject=loop.subject,
                bound=region.bound,
                stable=stable,
                evidence=found,
            )
            return StabilityVerdict(stable, region, found.document()["method"], certificate)
    raise UsageError("Lyapunov matrices do not decide here: leave the method open", where="method")


def _asked_region(
    time: str, bound: Entry | None, rate: Entry | None, radius: Entry | None
) -> StabilityRegion:
    """The region that the arguments name, one of them at most."""
    if bound is not None and (rate is not None or radius is not None):
        raise UsageError("give a bound, or a rate or a radius, not both")
    if bound is not None:
        return bounded_region(time, as_fraction(bound, where="bound"))
    return named_region(
        time,
        None if rate is None else as_fraction(rate, where="rate"),
        None if radius is None else as_fraction(radius, where="radius"),
    )


def _order(n: int, separation: Separation | None) -> tuple[Method, ...]:
    if n <= POLYNOMIAL_LIMIT and separation is None:
        return ("polynomial",)
    return ("lyapunov", "polynomial")


def _require_separation(M: Matrix, separation: Separation) -> None:
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
    """Quadratic forms of the blocks, or of the whole loop if unstable; None if undecided."""
    bound = region.bound if region.bound is not None else Fraction(loop.time == "discrete")
    parts: Sequence[Matrix] = (loop.A,) if separation is None else separation.blocks()
    forms = []
    for D in parts:
        form = quadratic_form(D, loop.time, bound)
        if form is None:
            return None
        forms.append(form)
    if any(form.R is None for form in forms):
        return _instability(loop, bound, separation, forms)
    blocks = [LyapunovBlock(f.P, f.R, f.R2) for f in forms if f.R is not None]
    transformation = None
    if separation is not None:
        modulus = _nonsingular_modulus(loop, separation.T)
        transformation = Transformation(separation.T, separation.Delta, modulus)
    return LyapunovMethod(transformation, tuple(blocks))


def _instability(
    loop: MultiChannelSystem,
    bound: Fraction,
    separation: Separation | None,
    forms: Sequence[QuadraticForm],
) -> InstabilityMethod | None:
    """A form for the whole loop: its only block's, that made of the blocks', or a new one."""
    if separation is None:
        [form] = forms
    elif separation.inverse is not None:
        return separated_instability(
            loop.A, separation.T, separation.inverse, forms, loop.time, bound
        )
    else:
        whole = quadratic_form(loop.A, loop.time, bound)
        if whole is None:
            return None
        form = whole
    return None if form.v is None else InstabilityMethod(form.P, form.R2, form.v)


def _nonsingular_modulus(loop: MultiChannelSystem, T: Matrix) -> int:
    """A prime modulo which T stays nonsingular.

    Raises
    ------
    UsageError
        If no prime tried does: T is singular, as far as can be told.
    """
    rng = generator(loop, StabilityCertificate.kind)
    for attempt, ell in enumerate(primes(rng.getrandbits(64))):
        if T.denominator % ell and residues(T, ell).rank() == T.nrows:
            return ell
        if attempt == 20:
            break
    raise UsageError("T is singular", where="separation")


def largest_certified_rate(
    loop: MultiChannelSystem, *, accuracy: Entry = Fraction(1, 10**6)
) -> Fraction | None:
    """The largest rate on a grid (least radius, in discrete time) that a loop certainly has.

    Parameters
    ----------
    loop : MultiChannelSystem
    accuracy : rational > 0
        Width of the last interval of the bisection.

    Returns
    -------
    Fraction or None
        R such that every eigenvalue has real part below −R and R + accuracy fails (or it has
        modulus below R and R − accuracy fails); None if the loop is not even stable, or in
        continuous time not faster than ``accuracy``.

    Notes
    -----
    Exact: one characteristic polynomial over Q, and a Routh or Schur–Cohn test for each step.

    Examples
    --------
    >>> M = Matrix.from_rows([[0, 1], [-2, -3]])
    >>> largest_certified_rate(matrix_system(M), accuracy="1/8")
    Fraction(7, 8)
    """
    width = as_fraction(accuracy)
    if width <= 0:
        raise UsageError("expected a positive number", where="accuracy")
    chi = characteristic_polynomial(loop.A)
    if not StabilityRegion(loop.time).contains_roots_of(chi) or chi.degree == 0:
        return None
    if loop.time == "discrete":
        return _bisected(chi, loop.time, Fraction(1), Fraction(0), width)
    slow, fast = Fraction(0), Fraction(1)
    while StabilityRegion(loop.time, fast).contains_roots_of(chi):
        slow, fast = fast, 2 * fast
    return _bisected(chi, loop.time, slow, fast, width) or None


def _bisected(
    chi: Polynomial, time: str, holds: Fraction, fails: Fraction, width: Fraction
) -> Fraction:
    """Halve the interval between a bound that holds and one that fails."""
    while abs(fails - holds) > width:
        middle = (holds + fails) / 2
        if StabilityRegion(time, middle).contains_roots_of(chi):
            holds = middle
        else:
            fails = middle
    return holds
