"""The location of the eigenvalues of a loop, and its rate.

`certify_stability` decides exactly whether every eigenvalue lies in a region, by two methods:

- The characteristic polynomial, with a Routh or Schur–Cohn test: always conclusive, and the default
  for small loops.
- Lyapunov matrices (`lyapunov`): the default for large loops, and for loops with a known block
  triangular form (`Separation`), which are certified block by block.  Near the border of the region
  floating point may propose no matrix that holds; then the polynomial decides, unless the method
  was prescribed.

`fastest_region` bisects for the largest rate, or the least radius, that a loop meets.  `located`
and `best_rate` enclose the roots of polynomials in discs, and the best rate that these allow, to
ten significant digits; `closed_loop_spectrum`, `eigenvalue_outside` and `open_loop_spectrum` apply
this to a matrix.  They are meant for small loops.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import accumulate, pairwise
from math import isqrt, lcm, prod
from typing import Any, Literal, get_args

from mcexact.analysis.lyapunov import QuadraticForm, quadratic_form, separated_instability
from mcexact.answer.evidence import LoopSpectrum, RateInterval, RootDisc
from mcexact.answer.loops import (
    ClosedLoopSpectrum,
    InstabilityMethod,
    LyapunovBlock,
    LyapunovForm,
    LyapunovMethod,
    PolynomialMethod,
    StabilityVerdict,
    Transformation,
)
from mcexact.derived.modular import generator
from mcexact.errors import InputError, InternalError, UsageError, one_of
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import polynomial_residues, primes, residues, residues_modulo_each
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.rational import Entry, as_fraction, digits_of
from mcexact.exact.roots import (
    StabilityRegion,
    decimal,
    exact_decimal,
    is_discrete,
    is_hurwitz,
    lifted,
    root_discs,
)
from mcexact.model.entries import as_matrix
from mcexact.model.system import MultiChannelSystem

# Stability and rates, both answers certified.

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
        region = region.limited(damping=damping, largest_modulus=largest_modulus)
    if polynomial is not None:
        InputError.require(polynomial, Polynomial, "polynomial")
    one_of(method, (None, *get_args(Method)), "method")
    if separation is not None:
        _require_separation(loop.A, separation)
    tried = (method,) if method is not None else _order(loop.n, separation)
    for each in tried:
        proof: PolynomialMethod | LyapunovMethod | InstabilityMethod | None
        if each == "polynomial":
            polynomial = polynomial or characteristic_polynomial(loop.A)
            stable = region.contains_roots_of(polynomial)
            proof = PolynomialMethod()
        else:
            proof = _lyapunov(loop, region, separation)
            stable = isinstance(proof, LyapunovMethod)
        if proof is not None:
            return StabilityVerdict(
                loop, bound=region.bound, stable=stable, **region.limits, evidence=proof
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
    """Quadratic forms of the blocks, or of the whole loop if unstable; None if undecided."""
    parts: Sequence[Matrix] = (loop.A,) if separation is None else separation.blocks()
    forms_of: dict[str, list[LyapunovForm]] = {}
    for side in ("bound", *region.limits):
        forms = []
        for D in parts:
            form = quadratic_form(*_of_side(side, D, region))
            if form is None:
                return None
            forms.append(form)
        if any(form.R is None for form in forms):
            return _instability(loop, region, side, separation, forms)
        forms_of[side] = [LyapunovForm(f.P, f.R, f.R2) for f in forms if f.R is not None]
    blocks = []
    for k, first in enumerate(forms_of.pop("bound")):
        block = LyapunovBlock(first.P.nrows, first.P, first.R, first.R2)
        limits: dict[str, Any] = {side: others[k] for side, others in forms_of.items()}
        blocks.append(replace(block, **limits))
    transformation = None
    if separation is not None:
        modulus = _nonsingular_modulus(loop, separation.T)
        transformation = Transformation(separation.T, separation.Delta, modulus)
    return LyapunovMethod(transformation, tuple(blocks))


def _of_side(side: str, D: Matrix, region: StabilityRegion) -> tuple[Matrix, StabilityRegion]:
    """A matrix that has all its eigenvalues in a region, iff D meets one side of another region."""
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
    """A form for the whole loop: its only block's, one of the blocks' forms, or a new one."""
    named = side if region.limits else None
    if separation is None:
        [form] = forms
    elif separation.inverse is not None and side == "bound":
        T, inverse = separation.T, separation.inverse
        method = separated_instability(loop.A, T, inverse, forms, region)
        return None if method is None else replace(method, side=named)
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


# Enclosures of roots, and the best rate that they allow.

# The width of an enclosure relative to its ends is at most this.
_RELATIVE_WIDTH = Fraction(1, 10**10)
# The number of significant digits of a modulus that is not a decimal.
_MODULUS_DIGITS = 12


def located(
    time: str, polynomials: Sequence[Polynomial]
) -> tuple[list[tuple[RootDisc, ...]], RateInterval | None]:
    """Compute discs around all roots of some polynomials, and the best rate that these roots allow.

    Parameters
    ----------
    time : {"continuous", "discrete"}
    polynomials : sequence of Polynomial
        Squarefree, of degree at least 1, no two with a common root.

    Returns
    -------
    list of tuples of RootDisc
        For each polynomial, disjoint discs with one root each.
    RateInterval or None
        None if there is no polynomial.

    Notes
    -----
    The discs are made smaller until the interval is at most 10⁻¹⁰ of its ends wide.  If the largest
    real part is 0 and no root there is a decimal, the interval contains 0 in its interior.

    Examples
    --------
    >>> located("discrete", [Polynomial.of(2, -2, 1)])[1]
    RateInterval(lower='1.414213562373', upper='1.414213562374')
    >>> located("continuous", [Polynomial.of(2, 0, 1)])[1]
    RateInterval(lower='-0.000000000001', upper='0.000000000001')
    """
    decimals = 0
    while True:
        discs = [
            tuple(RootDisc(disc.re, disc.im, disc.radius) for disc in root_discs(p, decimals))
            for p in polynomials
        ]
        every = [disc for those in discs for disc in those]
        rate = best_rate(time, every)
        if rate is None or _is_narrow(rate):
            return discs, rate
        if not is_discrete(time) and _ends_on_axis(product(polynomials)):
            return discs, rate
        decimals = 2 * max(_decimals(disc) for disc in every)


def best_rate(time: str, discs: Sequence[RootDisc]) -> RateInterval | None:
    """Enclose minus the largest real part, or the largest modulus, of the roots in some discs.

    Parameters
    ----------
    time : {"continuous", "discrete"}
    discs : sequence of RootDisc
        One root in each.

    Returns
    -------
    RateInterval or None
        As narrow as the discs allow, except for the rounding of moduli; None if there is no disc.

    Examples
    --------
    >>> best_rate("continuous", [RootDisc("-1.5", "0", "0.25"), RootDisc("-3", "0", "0")])
    RateInterval(lower='1.25', upper='1.75')
    >>> best_rate("discrete", [RootDisc("0.3", "0.4", "0.1")])
    RateInterval(lower='0.4', upper='0.6')
    >>> best_rate("discrete", [RootDisc("0.9", "0.4", "0")])
    RateInterval(lower='0.9848857801796', upper='0.9848857801797')
    """
    if not discs:
        return None
    numbers = [(exact_decimal(d.re), exact_decimal(d.im), exact_decimal(d.radius)) for d in discs]
    digits = max(map(_decimals, discs))
    if is_discrete(time):
        digits = max(digits, _decimals_of_moduli(numbers))
        moduli = [(*_root(re, im, digits), radius) for re, im, radius in numbers]
        lower = max(Fraction(0), max(below - radius for below, _, radius in moduli))
        upper = max(above + radius for _, above, radius in moduli)
    else:
        lower = -max(re + radius for re, _, radius in numbers)
        upper = -max(re - radius for re, _, radius in numbers)
    return RateInterval(*(decimal(int(end * 10**digits), digits) for end in (lower, upper)))


def _is_narrow(rate: RateInterval) -> bool:
    """Whether the ends agree in their first digits."""
    lower, upper = exact_decimal(rate.lower), exact_decimal(rate.upper)
    return upper - lower <= _RELATIVE_WIDTH * min(abs(lower), abs(upper))


def _ends_on_axis(p: Polynomial) -> bool:
    """Whether the largest real part of the roots of a squarefree polynomial is 0, exactly.

    Notes ----- g = gcd(p(x), p(−x)) has the roots on the axis, and perhaps pairs ±r of others; g +
    g' is Hurwitz if and only if there is no such pair, because Re g'/g > 0 to the right of roots on
    the axis (Routh's array does the same with a row of zeros).
    """
    g = p.gcd(p.scale(-1))
    return g.degree > 0 and is_hurwitz(p // g) and is_hurwitz(g + g.derivative())


def _decimals(disc: RootDisc) -> int:
    """The number of digits behind the point."""
    return max(len(part.partition(".")[2]) for part in (disc.re, disc.im, disc.radius))


def _decimals_of_moduli(discs: Sequence[tuple[Fraction, Fraction, Fraction]]) -> int:
    """Decimals that show `_MODULUS_DIGITS` digits of the largest modulus."""
    size = max(max(abs(re), abs(im)) for re, im, _ in discs)
    zeros = len(digits_of(int(1 / size))) if 0 < size < 1 else 0
    return _MODULUS_DIGITS + zeros


def _root(re: Fraction, im: Fraction, digits: int) -> tuple[Fraction, Fraction]:
    """√(re² + im²), rounded down and up to decimals."""
    scale = 10**digits
    square = (re * re + im * im) * scale * scale
    below = isqrt(square.numerator // square.denominator)
    above = below if below * below == square else below + 1
    return Fraction(below, scale), Fraction(above, scale)


# Spectra of matrices.

_MODULUS_BITS = 61
_AT_ONCE = 16


def closed_loop_spectrum(M: Matrix, time: str) -> LoopSpectrum:
    """Enclose every eigenvalue of a rational matrix.

    Parameters
    ----------
    M : Matrix, N×N
    time : {"continuous", "discrete"}

    Notes
    -----
    Exact: the discs are those of `located` for the squarefree part of the characteristic
    polynomial.  Meant for small loops; the numbers in it grow with N².

    Examples
    --------
    >>> spectrum = closed_loop_spectrum(Matrix.from_rows([[-1, 5], [0, -2]]), "continuous")
    >>> spectrum.stable, spectrum.rate
    (True, RateInterval(lower='1', upper='1'))
    >>> closed_loop_spectrum(Matrix.from_rows([[1]]), "continuous").stable
    False
    """
    polynomial = characteristic_polynomial(M)
    distinct = polynomial.squarefree_part()
    discs, rate = located(time, [distinct] if distinct.degree > 0 else [])
    stable = StabilityRegion(time).contains_roots_of(polynomial)
    return LoopSpectrum(time, polynomial, discs[0] if discs else (), stable, rate)


def eigenvalue_outside(M: Matrix, region: StabilityRegion) -> RootDisc | None:
    """Enclose an eigenvalue that lies outside a region.

    Returns
    -------
    RootDisc or None
        A disc outside the region that holds an eigenvalue; None if there is no such eigenvalue, or
        only one on the border.

    Notes
    -----
    Exact, for small loops as `closed_loop_spectrum`.

    Examples
    --------
    >>> M = Matrix.from_rows([[-1, 3], [-3, -1]])
    >>> disc = eigenvalue_outside(M, StabilityRegion("continuous", damping="1/2"))
    >>> disc.re, abs(Fraction(disc.im))
    ('-1', Fraction(3, 1))
    >>> eigenvalue_outside(M, StabilityRegion("continuous", damping="1/4"))
    """
    for disc in closed_loop_spectrum(M, region.time).discs:
        if region.excludes(*(Fraction(part) for part in (disc.re, disc.im, disc.radius))):
            return disc
    return None


def open_loop_spectrum(system: MultiChannelSystem) -> ClosedLoopSpectrum:
    """Compute det(xI − A), with a certificate.

    Parameters
    ----------
    system : MultiChannelSystem

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]])
    >>> str(open_loop_spectrum(plant).polynomial)
    'x^2 + 3*x + 2'
    """
    InputError.require(system, MultiChannelSystem, "system")
    polynomial = characteristic_polynomial(system.A)
    seed = generator(system, ClosedLoopSpectrum.kind).getrandbits(64)
    moduli = agreeing_moduli([(system.A, polynomial)], seed)
    return ClosedLoopSpectrum(system, polynomial=polynomial, moduli=moduli)


def agreeing_moduli(claims: list[tuple[Matrix, Polynomial]], seed: int) -> tuple[int, ...]:
    """Find primes that prove χ_M = p for every pair (M, p).

    Raises
    ------
    InternalError
        If χ_M is not p.

    Notes
    -----
    With D = Π d_i over the row denominators, D·χ_M = det(diag(d)x − diag(d)M) is integral, with
    coefficients of absolute value at most β = Π (d_i + Σ_j |d_i M_ij|).
    """
    bounds = [coefficient_bound(M) for M, _ in claims]
    for (M, p), (D, beta) in zip(claims, bounds, strict=True):
        scaled = [c * D for c in p.coefficients]
        if p.degree != M.nrows or any(c.denominator != 1 or abs(c) > beta for c in scaled):
            raise InternalError("the closed loop does not have the spectrum it was designed for")
    largest = max(2 * beta for _, beta in bounds)
    denominators = prod(D for D, _ in bounds)
    chosen: dict[int, None] = {}
    product = 1
    for ell in primes(seed, _MODULUS_BITS):
        if product > largest:
            break
        if denominators % ell and ell not in chosen:
            chosen[ell] = None
            product *= ell
    moduli = tuple(chosen)
    for M, p in claims:
        for start in range(0, len(moduli), _AT_ONCE):
            for residue in residues_modulo_each(M, moduli[start : start + _AT_ONCE]):
                if residue.characteristic_polynomial() != polynomial_residues(p, residue.modulus):
                    raise InternalError(
                        "the closed loop does not have the spectrum it was designed for"
                    )
    return moduli


def coefficient_bound(M: Matrix) -> tuple[int, int]:
    """(D, β): the product of the row denominators, and the bound on the coefficients of D·χ_M.

    Notes
    -----
    D·χ_M = det(diag(d_i)(xI − M)) has integer coefficients of absolute value at most β, the product
    of the sums of absolute values in the rows.  An integer polynomial with the same bound equals it
    if the two agree modulo primes whose product exceeds 2β.

    Examples
    --------
    >>> coefficient_bound(Matrix.from_rows([["1/2", 0], [1, 1]]))
    (2, 9)
    """
    D = beta = 1
    for row in M.rows():
        d = lcm(*(entry.denominator for entry in row))
        D *= d
        beta *= d + sum(abs(entry.numerator) * (d // entry.denominator) for entry in row)
    return D, beta
