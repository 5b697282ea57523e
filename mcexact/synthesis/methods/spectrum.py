"""Prescribed spectra as monic polynomials over Q, from coefficients or from roots and pairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.location import StabilityRegion
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction


def spectrum_polynomial(spectrum: Any, degree: int, *, where: str = "spectrum") -> Polynomial:
    """Return the monic polynomial whose roots are a prescribed symmetric set of numbers.

    Parameters
    ----------
    spectrum : Polynomial, or sequence
        The coefficients of a monic polynomial, constant term first; or its roots, each a rational
        number, or ``{"re": a, "im": b}`` with b ≠ 0 for the pair a ± b i.
    degree : int
        The number of prescribed numbers, which distinguishes degree + 1 coefficients from degree
        roots.
    where : str
        The place to name in an error.

    Returns
    -------
    Polynomial
        Monic, of the given degree.

    Raises
    ------
    InputError
        If the length is wrong (the message states the right one), the polynomial is not monic, or
        an entry is not a rational number.

    Examples
    --------
    >>> str(spectrum_polynomial(["-1", {"re": "-1", "im": "2"}], 3))
    'x^3 + 3*x^2 + 7*x + 5'
    >>> spectrum_polynomial([5, 2, 1], 2) == spectrum_polynomial([{"re": -1, "im": 2}], 2)
    True
    >>> spectrum_polynomial([-1, -2], 3)
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: spectrum: expected 3 numbers (or 4 coefficients of a monic \
polynomial, constant term first), found a list of 2
    """
    if isinstance(spectrum, Polynomial):
        entries: Sequence[Any] = spectrum.coefficients
    elif isinstance(spectrum, Sequence) and not isinstance(spectrum, (str, bytes)):
        entries = spectrum
    else:
        raise InputError(
            f"expected a list of coefficients, or of roots and pairs, found "
            f"{type(spectrum).__name__}",
            where=where,
        )
    if any(isinstance(entry, Mapping) for entry in entries):
        return _from_roots(entries, degree, where)
    if len(entries) == degree + 1:
        values = [as_fraction(e, where=f"{where}[{k}]") for k, e in enumerate(entries)]
        if values[-1] != 1:
            raise InputError(
                f"expected a monic polynomial of degree {degree} (last coefficient 1) or "
                f"{degree} roots, found {degree + 1} numbers of which the last is {values[-1]}",
                where=where,
            )
        return Polynomial(tuple(values))
    if isinstance(spectrum, Polynomial):
        raise InputError(
            f"expected a polynomial of degree {degree}, found degree {spectrum.degree}", where=where
        )
    return _from_roots(entries, degree, where)


def _from_roots(entries: Sequence[Any], degree: int, where: str) -> Polynomial:
    """The product of the factors of the roots and pairs."""
    result, count = Polynomial((Fraction(1),)), 0
    for k, entry in enumerate(entries):
        factor = _factor(entry, f"{where}[{k}]")
        result, count = result * factor, count + factor.degree
    if count != degree:
        found = f"a list of {len(entries)}"
        if count != len(entries):
            found += f" with {count} numbers (a pair counts twice)"
        raise InputError(
            f"expected {degree} numbers (or {degree + 1} coefficients of a monic polynomial, "
            f"constant term first), found {found}",
            where=where,
        )
    return result


def _factor(entry: Any, place: str) -> Polynomial:
    """The factor of one root or of one pair."""
    if not isinstance(entry, Mapping):
        return Polynomial((-as_fraction(entry, where=place), Fraction(1)))
    if set(entry) != {"re", "im"}:
        raise InputError(
            'expected a pair as {"re": a, "im": b}, its conjugate is implied', where=place
        )
    re = as_fraction(entry["re"], where=f"{place}.re")
    im = as_fraction(entry["im"], where=f"{place}.im")
    if im == 0:
        raise InputError(
            "expected an imaginary part that is not 0; write a real root as one number",
            where=place,
        )
    return Polynomial((re * re + im * im, -2 * re, Fraction(1)))


def require_numbers(spectrum: Any, where: str = "spectrum") -> None:
    """Raise an error for a prescribed spectrum with an entry that is not a number.

    The required number of entries is known only when the order of the controller is.

    Parameters
    ----------
    spectrum : list of numbers and pairs, or mapping to such
    where : str

    Raises
    ------
    InputError
        If an entry is neither a rational number nor a pair.

    Examples
    --------
    >>> require_numbers({"closed_loop": ["-1", {"re": "-1", "im": "2"}]})
    >>> require_numbers({"closed_loop": ["-1", "foo"]})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: spectrum.closed_loop[1]: expected an integer, a decimal such as \
"-0.25" or "1e-3", or a quotient such as "1/3", found 'foo'
    """
    if isinstance(spectrum, Mapping):
        for key, numbers in spectrum.items():
            require_numbers(numbers, f"{where}.{key}")
    elif isinstance(spectrum, Sequence) and not isinstance(spectrum, (str, bytes)):
        for k, entry in enumerate(spectrum):
            _factor(entry, f"{where}[{k}]")


def default_polynomial(region: StabilityRegion, degree: int) -> Polynomial:
    """Return a polynomial with short numbers and every root in a region.

    Parameters
    ----------
    region : StabilityRegion
    degree : int

    Returns
    -------
    Polynomial
        Continuous time: the roots −c, −c−1, −c−2, −c, … with c the least integer above the rate.
        Discrete time: x^degree (deadbeat), which meets every radius and has the shortest numbers.

    Examples
    --------
    >>> str(default_polynomial(StabilityRegion.of("continuous", rate="1/2"), 2))
    'x^2 + 3*x + 2'
    """
    if region.discrete:
        return Polynomial((Fraction(0),) * degree + (Fraction(1),))
    least = region.edge.numerator // region.edge.denominator + 1
    result = Polynomial((Fraction(1),))
    for k in range(degree):
        result = result * Polynomial((Fraction(least + k % 3), Fraction(1)))
    return result
