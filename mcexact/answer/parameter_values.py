"""Values of a parameter in answers, the modes there, and their words."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.evidence import RootDisc
from mcexact.answer.mode_words import polynomial_in_x
from mcexact.answer.protocol import Part
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import rational_text, rounded
from mcexact.exact.roots import exact_decimal, root_discs
from mcexact.model.parametric import ParametricSystem, Range

ModePolynomial = tuple[Polynomial, ...]
"""A polynomial in x, monic, by its coefficients, constant first, which are polynomials in t."""


@dataclass(frozen=True)
class ParameterValue(Part):
    """Values of the parameter, the roots of an irreducible polynomial.

    Attributes
    ----------
    value : Polynomial
        q, monic and irreducible over Q.
    roots : tuple of RootDisc
        Disjoint discs with one root each, centered on the real axis exactly for real roots.
    """

    value: Polynomial
    roots: tuple[RootDisc, ...]

    def to_sympy(self) -> list[Any]:
        """All values exactly: rational numbers, or instances of ``CRootOf``.

        Examples
        --------
        >>> from mcexact import ParametricSystem, fixed_spectrum
        >>> plant = ParametricSystem([[1]], [[["t^3 - 2"]]], [[[1]]], parameters=["t"])
        >>> fixed_spectrum(plant).exceptional[0].to_sympy()[0]
        CRootOf(x**3 - 2, 0)
        """
        import sympy

        p = self.value.to_sympy()
        return [sympy.CRootOf(p, k, radicals=False) for k in range(self.value.degree)]

    @property
    def exact(self) -> Fraction | None:
        """The value, if it is rational."""
        return -self.value.coefficients[0] if self.value.degree == 1 else None

    @property
    def real(self) -> tuple[RootDisc, ...]:
        """The discs of the real roots."""
        return tuple(disc for disc in self.roots if exact_decimal(disc.im) == 0)

    def inside(self, bounds: Range) -> bool:
        """Whether a root is real and in a range, or within the radius of its disc of it."""
        low, high = bounds
        if self.exact is not None:
            return (low is None or low <= self.exact) and (high is None or self.exact <= high)
        return any(meets(disc, bounds) for disc in self.real)


@dataclass(frozen=True)
class OutsideValue(Part):
    """Values of the parameter without a real one in the range, of which nothing is claimed."""

    value: Polynomial
    roots: tuple[RootDisc, ...]


def in_parameter(p: Polynomial, t: str) -> str:
    """A polynomial in the parameter.

    Examples
    --------
    >>> in_parameter(Polynomial.of(-2, 0, 1), "t")
    't^2 - 2'
    """
    return str(p).replace("x", t)


def mode_text(p: ModePolynomial, t: str) -> str:
    """A polynomial in x whose coefficients depend on the parameter.

    Examples
    --------
    >>> mode_text((Polynomial.of(0, -1), Polynomial.of(2), Polynomial.of(1)), "t")
    'x^2 + 2*x - t'
    """
    return polynomial_in_x([in_parameter(c, t) for c in p])


def value_text(q: Polynomial, roots: Sequence[RootDisc], t: str) -> str:
    """Where a polynomial in the parameter is 0: its rational root, or all real ones about.

    Examples
    --------
    >>> value_text(Polynomial.of("-1/2", 1), [], "t")
    't = 1/2'
    >>> from mcexact.exact.roots import root_discs
    >>> q = Polynomial.of(-2, 0, 1)
    >>> value_text(q, [RootDisc(d.re, d.im, d.radius) for d in root_discs(q)], "t")
    't^2 - 2 = 0 (t about -1.41421, 1.41421)'
    """
    if q.degree == 1:
        return f"{t} = {rational_text(-q.coefficients[0] / q.leading)}"
    real = [disc.re for disc in roots if exact_decimal(disc.im) == 0]
    listed = ", ".join(rounded(exact_decimal(each)) for each in real)
    told = f"{t} about {listed}" if real else f"no real {t}"
    return f"{in_parameter(q, t)} = 0 ({told})"


Row = tuple[str, str, str]
"""Where, what holds there, and why."""


@dataclass(frozen=True)
class LeftOut:
    """The values of which answers say nothing.

    Attributes
    ----------
    outside : tuple of str
        Those out of the range, as conditions.
    assumed : str
        The parameter with its range.
    undefined : tuple of str
        Those at which an entry of the plant is undefined, as conditions.
    """

    outside: tuple[str, ...]
    assumed: str
    undefined: tuple[str, ...]


def rows_left_out(parts: Iterable[LeftOut]) -> tuple[Row, ...]:
    """The values of which some answers about one plant say nothing, each of them once."""
    parts = [*parts]
    outside = dict.fromkeys(at for each in parts for at in each.outside)
    undefined = dict.fromkeys(at for each in parts for at in each.undefined)
    rows = [(at, "undefined", "a denominator is 0") for at in undefined]
    if not outside:
        return tuple(rows)
    where = f"{', '.join(outside)} (out of range)"
    return (where, "not decided", f"{parts[0].assumed} is assumed"), *rows


def left_out(found: Any) -> LeftOut:
    """The values of which an answer about one parameter says nothing."""
    [t], [bounds] = found.about.parameters, found.about.ranges
    return LeftOut(
        outside=tuple(value_text(each.value, each.roots, t) for each in found.outside),
        assumed=found.about.parameters_in_words[0],
        undefined=tuple(
            value_text(each.value, each.roots, t) + within(each.inside(bounds), bounds)
            for each in poles_of(found.about)
        ),
    )


def rows_of_values(found: Any, told: Callable[[Any], Sequence[tuple[str, str]]]) -> tuple[Row, ...]:
    """The rows of an answer about exceptional values.

    Parameters
    ----------
    found : ParametricFixedSpectrum or ParametricRank
    told : callable
        What holds at an exceptional value, and why.
    """
    [t], [bounds] = found.about.parameters, found.about.ranges
    return tuple(
        (value_text(each.value, each.roots, t) + within(True, bounds), what, why)
        for each in found.exceptional
        for what, why in told(each)
    )


def within(inside: bool, bounds: Range) -> str:
    """Whether a value is in the range that is assumed, if one is.

    Examples
    --------
    >>> within(True, (0, None)), within(False, (None, None))
    (' (in range)', '')
    """
    if bounds == (None, None):
        return ""
    return " (in range)" if inside else " (out of range)"


def joined(parts: Iterable[tuple[str, Any]]) -> tuple[Row, ...]:
    """The rows of several answers about one plant, each behind its name, and what all leave out."""
    parts = [*parts]
    said = [
        (where, f"{name}: {what}", why) for name, each in parts for where, what, why in each.told
    ]
    return *said, *rows_left_out(each.left_out for _, each in parts)


def undefined_where(about: ParametricSystem) -> list[str]:
    """The values of one parameter, in its range if it has one, at which an entry is undefined."""
    [t], [bounds] = about.parameters, about.ranges
    inside = [each for each in poles_of(about) if bounds == (None, None) or each.inside(bounds)]
    return [value_text(each.value, each.roots, t) for each in inside]


def apart_from_poles(about: ParametricSystem) -> str:
    """That one parameter has none of these values, in words behind "every value of t".

    Examples
    --------
    >>> plant = ParametricSystem([["1/(t^3 - t^2)"]], [[[1]]], [[[1]]], parameters=["t"])
    >>> apart_from_poles(plant)
    ' with t ≠ 1 and t ≠ 0'
    """
    [t], [bounds] = about.parameters, about.ranges
    apart = [
        f"{in_parameter(each.value, t)} ≠ 0"
        if each.exact is None
        else f"{t} ≠ {rational_text(each.exact)}"
        for each in poles_of(about)
        if bounds == (None, None) or each.inside(bounds)
    ]
    return f" with {' and '.join(apart)}" if apart else ""


def poles_of(about: ParametricSystem) -> tuple[ParameterValue, ...]:
    """The values of one parameter at which an entry of the plant is undefined."""
    return tuple(
        ParameterValue(q, tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(q)))
        for q in about.poles
    )


def mode_in_sympy(p: ModePolynomial, parameter: Any = "t") -> Any:
    """A polynomial in x whose coefficients depend on the parameter, as a ``sympy.Poly`` in x.

    Examples
    --------
    >>> mode_in_sympy((Polynomial.of(0, -1), Polynomial.of(1)), "k")
    Poly(x - k, x, domain='QQ[k]')
    """
    import sympy

    t = sympy.Symbol(parameter) if isinstance(parameter, str) else parameter
    descending = [c.to_sympy(t).as_expr() for c in reversed(p)]
    return sympy.Poly(descending, sympy.Symbol("x"), domain=sympy.QQ[t])


def meets(disc: RootDisc, bounds: Range) -> bool:
    """Whether a disc meets a range of real numbers, as far as its center and radius tell."""
    re, im, radius = map(exact_decimal, (disc.re, disc.im, disc.radius))
    low, high = bounds
    below, above = low is not None and re + radius < low, high is not None and re - radius > high
    return not (below or above or abs(im) > radius)
