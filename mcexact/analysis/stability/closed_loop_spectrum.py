"""The spectrum of a matrix, with every eigenvalue enclosed, and the resulting rate."""

from __future__ import annotations

from fractions import Fraction
from math import lcm, prod

from mcexact.analysis.engine import located
from mcexact.answer.closed_loop_spectrum import ClosedLoopSpectrum
from mcexact.answer.evidence import RootDisc
from mcexact.answer.loop_spectrum import LoopSpectrum
from mcexact.derived.modular import generator
from mcexact.errors import InputError, InternalError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import polynomial_residues, primes, residues_modulo_each
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem

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
    >>> found = closed_loop_spectrum(Matrix.from_rows([[-1, 5], [0, -2]]), "continuous")
    >>> found.stable, found.rate
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
    >>> found = eigenvalue_outside(M, StabilityRegion("continuous", damping="1/2"))
    >>> found.re, abs(Fraction(found.im))
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
