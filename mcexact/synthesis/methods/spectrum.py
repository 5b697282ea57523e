"""Prescribed spectra as monic polynomials over Q, from coefficients or from roots and pairs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.floats import as_requested
from mcexact.exact.location import StabilityRegion
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction, rational_text
from mcexact.model.names import quoted


def spectrum_polynomial(spectrum: Any, degree: int, *, where: str = "spectrum") -> Polynomial:
    """Return the monic polynomial whose roots are a prescribed symmetric set of numbers.

    Parameters
    ----------
    spectrum : Polynomial, sequence or array
        The coefficients of a monic polynomial, constant term first; or its roots.  A root is a real
        number or complex: ``"-1+2i"``, ``-1+2j`` or ``{"re": -1, "im": 2}`` stands for the pair
        −1 ± 2i, and its conjugate may be listed as well, as in arrays of numpy.  Floats stand for
        the decimals that print them.
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
    >>> str(spectrum_polynomial(["-1", "-1+2i"], 3))
    'x^3 + 3*x^2 + 7*x + 5'
    >>> spectrum_polynomial([5, 2, 1], 2) == spectrum_polynomial([-1 - 2j, -1 + 2j], 2)
    True
    >>> spectrum_polynomial([-1, -2], 3)
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: spectrum: expected 3 numbers (or 4 coefficients of a monic \
polynomial, constant term first), found a list of 2
    """
    entries = _listed(spectrum, where)
    if any(map(_is_complex, entries)) or len(entries) != degree + 1:
        if isinstance(spectrum, Polynomial):
            raise InputError(
                f"expected a polynomial of degree {degree}, found degree {spectrum.degree}",
                where=where,
            )
        return _from_roots(entries, degree, where)
    values = [as_requested(e, where=f"{where}[{k}]") for k, e in enumerate(entries)]
    if values[-1] != 1:
        raise InputError(
            f"expected a monic polynomial of degree {degree} (last coefficient 1) or "
            f"{degree} roots, found {degree + 1} numbers of which the last is {values[-1]}",
            where=where,
        )
    return Polynomial(tuple(values))


def _listed(spectrum: Any, where: str) -> Sequence[Any]:
    """Return the coefficients or roots as a sequence."""
    if isinstance(spectrum, Polynomial):
        return spectrum.coefficients
    if getattr(spectrum, "ndim", 0) == 1 and hasattr(spectrum, "tolist"):
        # Items of single precision are read in their own precision, which `tolist` would lose.
        return list(spectrum)
    if isinstance(spectrum, Sequence) and not isinstance(spectrum, (str, bytes)):
        return spectrum
    raise InputError(
        f"expected a list of coefficients, or of roots and pairs, found {type(spectrum).__name__}",
        where=where,
    )


def _is_complex(entry: Any) -> bool:
    """Whether an entry can only be a root; a real number can also be a coefficient."""
    if isinstance(entry, str):
        return entry[-1:] in {"i", "j"}
    return isinstance(entry, (Mapping, complex)) or _kind_of(entry) == "c"


def _kind_of(entry: Any) -> str:
    return str(getattr(getattr(entry, "dtype", None), "kind", ""))


def _from_roots(entries: Sequence[Any], degree: int, where: str) -> Polynomial:
    """The product of the factors of the roots and pairs."""
    real, pairs = list[Fraction](), Counter[tuple[Fraction, Fraction]]()
    for k, entry in enumerate(entries):
        re, im = _root(entry, f"{where}[{k}]")
        if im:
            pairs[re, im] += 1
        else:
            real.append(re)
    result = Polynomial.from_roots(real)
    for re, im in dict.fromkeys((re, abs(im)) for re, im in pairs):
        above, below = pairs[re, im], pairs[re, -im]
        if above and below and above != below:
            raise InputError(
                f"expected as many of {_shown(re, im)} as of its conjugate, or one of the two for "
                f"each pair, found {above} and {below}",
                where=where,
            )
        factor = Polynomial((re * re + im * im, -2 * re, Fraction(1)))
        result = result * factor ** max(above, below)
    if result.degree != degree:
        found = f"a list of {len(entries)}"
        if result.degree != len(entries):
            found += f" with {result.degree} numbers (a pair counts twice)"
        raise InputError(
            f"expected {degree} numbers (or {degree + 1} coefficients of a monic polynomial, "
            f"constant term first), found {found}",
            where=where,
        )
    return result


def _shown(re: Fraction, im: Fraction) -> str:
    return f"{rational_text(re)}+{rational_text(im)}i"


def _root(entry: Any, place: str) -> tuple[Fraction, Fraction]:
    """The real and the imaginary part of a root, which is 0 for a real one."""
    if isinstance(entry, Mapping):
        return _pair(entry, place)
    if isinstance(entry, str) and _is_complex(entry):
        return _parsed(entry, place)
    if _is_complex(entry):
        return as_requested(entry.real, where=place), as_requested(entry.imag, where=place)
    return as_requested(entry, where=place), Fraction(0)


def _parsed(text: str, place: str) -> tuple[Fraction, Fraction]:
    """The parts of a complex number such as -1+2i, 3/2-i or 2i."""
    digits = text[:-1]
    # The imaginary part begins with the last sign that does not belong to an exponent.
    signs = (k for k in range(len(digits) - 1, 0, -1) if digits[k] in "+-")
    start = next((k for k in signs if digits[k - 1] not in "eE"), 0)
    im = digits[start:].removeprefix("+")
    try:
        return as_fraction(digits[:start] or 0), as_fraction(f"{im}1" if im in {"", "-"} else im)
    except InputError:
        raise InputError(
            f'expected a complex number such as "-1+2i" or "1/2-3i", found {quoted(text)}',
            where=place,
        ) from None


def _pair(entry: Mapping[str, Any], place: str) -> tuple[Fraction, Fraction]:
    """The parts of one root of a pair, whose conjugate is implied."""
    if set(entry) != {"re", "im"}:
        raise InputError(
            'expected a pair as {"re": a, "im": b}, its conjugate is implied', where=place
        )
    re = as_requested(entry["re"], where=f"{place}.re")
    im = as_requested(entry["im"], where=f"{place}.im")
    if im == 0:
        raise InputError(
            "expected an imaginary part that is not 0; write a real root as one number",
            where=place,
        )
    return re, im


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
    >>> require_numbers({"closed_loop": ["-1", {"re": "-1", "im": "2"}, "3/2-i"]})
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
            _root(entry, f"{where}[{k}]")


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
