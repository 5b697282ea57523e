"""The fixed modes of a system with several parameters: for almost all values, and on which others.

This is no kind of certificate: the answers for one parameter along lines are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.mode_words import blame, polynomial_in_x
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.exact.rational import rational_latex, rational_text
from mcexact.exact.rational_function import RationalFunction, parameter_latex
from mcexact.model.parametric import ParametricSystem
from mcexact.shown import LINE, Shown, escaped, fitting


@dataclass(frozen=True, repr=False)
class Line(Shown):
    """A line through the space of the parameters, and what is fixed along it.

    Attributes
    ----------
    at : mapping
        For each parameter its value, a function of s.
    answer : ParametricFixedSpectrum
        The answer for every value of s, which is a certificate.
    """

    at: Mapping[str, RationalFunction]
    answer: ParametricFixedSpectrum

    def __str__(self) -> str:
        return ", ".join(f"{name} = {value}" for name, value in self.at.items())

    def __repr__(self) -> str:
        return fitting(f"Line({self})")

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield "line", str(self)
        yield from ((label, value) for label, value in self.answer._labeled())


@dataclass(frozen=True, repr=False)
class Hypersurface(Shown):
    """Where a polynomial in the parameters is 0, a mode is fixed that is not for other values.

    Attributes
    ----------
    polynomial : RationalFunction
        Irreducible; its coefficients are coprime integers.
    channels : tuple of tuples of str
        Sets s of channels whose pencils lose rank where the lines meet the hypersurface.
    """

    polynomial: RationalFunction
    channels: tuple[tuple[str, ...], ...]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {"polynomial": str(self.polynomial), "channels": [[*s] for s in self.channels]}

    def to_sympy(self) -> Any:
        """The polynomial as a ``sympy.Poly`` in the parameters."""
        import sympy

        symbols = sympy.symbols(self.polynomial.parameters)
        return sympy.Poly(self.polynomial.to_sympy(), *symbols, domain="QQ")

    @property
    def value(self) -> tuple[str, Fraction] | None:
        """The parameter and its value, if the condition is that one has this value."""
        occurring = self.polynomial.occurring
        if len(occurring) != 1:
            return None
        [name] = occurring
        s = RationalFunction.parameter("s", ("s",))
        values = [s if name == each else s * 0 for each in self.polynomial.parameters]
        p = self.polynomial.substituted(values, s * 0).polynomials()[0]
        return None if p.degree > 1 else (name, -p.coefficients[0] / p.leading)

    def __str__(self) -> str:
        if self.value is None:
            return f"{self.polynomial} = 0"
        name, value = self.value
        return f"{name} = {rational_text(value)}"

    def __repr__(self) -> str:
        return fitting(f"Hypersurface({str(self)!r}, channels={self.channels})")

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield "where", str(self)
        yield "channels", str(self.channels)

    def _latex(self) -> str:
        if self.value is None:
            return f"{self.polynomial.latex()} = 0"
        name, value = self.value
        return f"{parameter_latex(name)} = {rational_latex(value)}"


@dataclass(frozen=True, repr=False)
class ExceptionalHypersurfaces(Shown):
    """What is fixed for almost all values of several parameters, and on which hypersurfaces more.

    Along each line all of this is proved by a certificate: what is fixed there for almost all
    values, and that the values at which more is fixed are those on the hypersurfaces.  If nothing
    is fixed at one point, then nothing is for almost all values.  That a hypersurface is
    exceptional between the lines, and generic modes beyond them, are computed and not certified.
    Of what only happens where two conditions meet, such as both of two entries being 0, nothing is
    said.

    Attributes
    ----------
    about : ParametricSystem
    generic : tuple of tuples of RationalFunction
        The irreducible polynomials in x whose roots are fixed for almost all values, each by its
        coefficients, constant first, which are polynomials in the parameters.  The modes are these
        roots divided by the denominator of A.
    hypersurfaces : tuple of Hypersurface
        The polynomials in the parameters where another mode is fixed.
    undefined_at : tuple of RationalFunction
        The polynomials at whose roots an entry is undefined.
    lines : tuple of Line
        Lines through drawn points, which meet all hypersurfaces.
    """

    about: ParametricSystem
    generic: tuple[tuple[RationalFunction, ...], ...]
    hypersurfaces: tuple[Hypersurface, ...]
    undefined_at: tuple[RationalFunction, ...]
    lines: tuple[Line, ...]

    @property
    def certificates(self) -> dict[str, ParametricFixedSpectrum]:
        """The certificates, each about the system along a line."""
        return {f"fixed_spectrum_line_{k}": each.answer for k, each in enumerate(self.lines, 1)}

    @property
    def words(self) -> tuple[str, ...]:
        """What is fixed for almost all values, on which hypersurfaces more, and what is proved."""
        named = ", ".join(self.about.parameters)
        told = [
            f"the roots of {mode_in_x(p)} for almost all values of {named}" for p in self.generic
        ] or [f"no mode for almost all values of {named}"]
        told += [f"another mode where {each}: {self.why(each)}" for each in self.hypersurfaces]
        told += [f"proved for every value of s: {each}" for each in self.lines]
        return (*told, "not decided: values at which several conditions meet")

    def why(self, each: Hypersurface) -> str:
        """Which channels cause that a mode is fixed there."""
        return ", or ".join(blame(s, self.about.names) for s in each.channels)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "parameters": list(self.about.parameters),
            "generic": [[str(c) for c in p] for p in self.generic],
            "hypersurfaces": [each.to_dict() for each in self.hypersurfaces],
            "undefined_at": [str(each) for each in self.undefined_at],
            "lines": [{name: str(value) for name, value in each.at.items()} for each in self.lines],
            "in_words": list(self.words),
        }

    def explain(self) -> str:
        """Say in plain words what is fixed where, one condition a line."""
        return "\n".join(self.words)

    def __repr__(self) -> str:
        shown = "; ".join(map(str, self.hypersurfaces)) or "none"
        text = f"ExceptionalHypersurfaces({len(self.generic)} generic, exceptional: {shown}"
        return f"{fitting(text, LINE - 1)})"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        generic = "; ".join(map(mode_in_x, self.generic)) or "no mode"
        yield "fixed for almost all values", generic
        for each in self.hypersurfaces:
            yield f"also where {each}", self.why(each)
        for entry in self.undefined_at:
            yield "undefined where", f"{entry} = 0"
        for each_line in self.lines:
            yield "proved along", str(each_line)

    def _latex(self) -> str:
        rows = r" \\ ".join(
            rf"{each._latex()} & \text{{{escaped(self.why(each))}}}" for each in self.hypersurfaces
        )
        return rf"\begin{{array}}{{ll}} {rows} \end{{array}}" if rows else r"\emptyset"

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the hypersurfaces of two parameters as curves; see `mcexact.plot.hypersurfaces`."""
        from mcexact.plot.parameters import hypersurfaces

        return hypersurfaces(self, ax, **options)


def mode_in_x(p: tuple[RationalFunction, ...]) -> str:
    """A polynomial in x whose coefficients depend on several parameters.

    Examples
    --------
    >>> a = RationalFunction.parameter("a", ("a", "b"))
    >>> mode_in_x((a * a - 2, a, RationalFunction.constant(1, ("a", "b"))))
    'x^2 + a*x + (a^2 - 2)'
    """
    return polynomial_in_x([str(c) for c in p])
