"""Forms of a rational polynomial: polynomials of sympy and numpy, text, HTML and LaTeX."""

from __future__ import annotations

import re
from typing import Any

from mcexact import shown
from mcexact.exact.rational import digits_of
from mcexact.exact.shortened import polynomial


class PolynomialForms:
    """The conversions and the display of `Polynomial`, which alone inherits them."""

    def to_sympy(self: Any, symbol: Any = "x") -> Any:
        """The polynomial as a ``sympy.Poly`` over the rational numbers, with equal coefficients.

        Parameters
        ----------
        symbol : sympy.Symbol or str

        Examples
        --------
        >>> from mcexact.exact.polynomial import Polynomial
        >>> Polynomial.of("1/3", 0, 1).to_sympy("s")
        Poly(s**2 + 1/3, s, domain='QQ')
        """
        import sympy

        variable = sympy.Symbol(symbol) if isinstance(symbol, str) else symbol
        descending = [sympy.Rational(c.numerator, c.denominator) for c in self.coefficients[::-1]]
        return sympy.Poly(descending or [0], variable, domain="QQ")

    def _sympy_(self) -> Any:
        return self.to_sympy().as_expr()

    def to_numpy(self: Any) -> Any:
        """The polynomial as a ``numpy.polynomial.Polynomial``, whose coefficients are rounded.

        Each coefficient becomes the float nearest to it, so that roots can be wrong.

        Examples
        --------
        >>> from mcexact.exact.polynomial import Polynomial
        >>> Polynomial.of(-4, 0, 1).to_numpy().roots()
        array([-2.,  2.])
        """
        from numpy.polynomial import Polynomial

        from mcexact.exact.floats import to_float

        return Polynomial([to_float(c) for c in self.coefficients] or [0.0])

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        printer.text(repr(self))

    def _html(self: Any) -> str:
        """The polynomial as a piece of HTML."""
        return _html(self)

    def _repr_html_(self) -> str:
        return shown.framed(self._html())

    def _latex(self: Any) -> str:
        """The polynomial as a piece of LaTeX; of a long one the first and last terms."""
        if len(str(self)) > 2 * shown.LINE:
            return shown.words(_short(self).replace("*", " "))
        return str(self.latex())

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self._latex()}$"


def pasted(p: Any) -> str:
    """Return an expression that makes the polynomial again, or of a long one a summary."""
    written = (repr(c) if isinstance(c, str) else digits_of(c) for c in p.as_json())
    text = f"Polynomial.of({', '.join(written)})"
    return text if len(text) <= shown.LINE else f"<polynomial {_short(p)}>"


def _short(p: Any) -> str:
    return polynomial(p, shown.LINE // 2)


def _html(p: Any) -> str:
    """Return the polynomial, of a long one the first and last terms, with raised exponents."""
    text = str(p)
    text = text if len(text) <= 2 * shown.LINE else _short(p)
    return re.sub(r"\^(\d+)", r"<sup>\1</sup>", text).replace("*", " ")
