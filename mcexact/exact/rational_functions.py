"""Rational functions of parameters, and matrices of them.

A `RationalFunction` is N/D in named parameters, in lowest terms, with the leading coefficient of
D equal to 1, so that equal functions compare equal.  A `FunctionMatrix` has these as entries.

For decisions, `cleared` multiplies a matrix by the least common denominator of its entries, which
gives rows of polynomials over Q in the parameters, in one ring of flint.  The functions after it
compute with such rows as plain data, in the ring that has x as its last variable, since
`exact.parametric_polynomials` goes on in it.  Determinants are computed by elimination without
fractions (Bareiss).  For one parameter, `polynomial_matrix` and `FunctionMatrix.reduced` lead to
`PolynomialMatrix`, whose products are faster.
"""

from __future__ import annotations

import copyreg
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import Any

import flint

from mcexact.errors import InputError, LimitReached
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix, MatrixDisplay, to_float
from mcexact.exact.polynomial import Polynomial, from_fmpq, to_fmpq
from mcexact.exact.rational import rational_latex, rational_text
from mcexact.shown import LINE, escaped

# Rational functions of named parameters over the rational numbers, in lowest terms.

_GREEK = re.compile(
    "alpha|beta|gamma|delta|epsilon|zeta|eta|theta|kappa|lambda|mu|nu|xi|pi|rho|sigma|tau|phi|chi|"
    "psi|omega",
    re.IGNORECASE,
)
MOST_DEGREE = 1000
"""The largest total degree of a numerator or a denominator."""


VARIABLE = "x"


@cache
def ring(parameters: tuple[str, ...]) -> Any:
    """The ring of polynomials in the parameters and x, which is the last variable.

    Functions alone, which no plant has, may have a parameter x.
    """
    last = VARIABLE if VARIABLE not in parameters else "_"
    return flint.fmpq_mpoly_ctx.get((*parameters, last), flint.Ordering.lex)


def _polynomial(names: tuple[str, ...], terms: dict[tuple[int, ...], tuple[int, int]]) -> Any:
    """The polynomial with these terms, in another process."""
    ring = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.lex)
    return ring.from_dict({degrees: flint.fmpq(*quotient) for degrees, quotient in terms.items()})


def _reduced(polynomial: Any) -> tuple[Any, ...]:
    """What `_polynomial` makes a polynomial from, since flint's cannot be pickled."""
    terms = polynomial.to_dict().items()
    plain = {degrees: (int(q.numerator), int(q.denominator)) for degrees, q in terms}
    return _polynomial, (polynomial.context().names(), plain)


copyreg.pickle(flint.fmpq_mpoly, _reduced)


@dataclass(frozen=True, eq=False)
class RationalFunction:
    """N/D in named parameters, without a common factor, the leading coefficient of D being 1.

    Made by `constant`, `parameter` and arithmetic; two are equal if they are the same function of
    the same parameters.

    Attributes
    ----------
    parameters : tuple of str
    numerator, denominator : flint.fmpq_mpoly
        In the ring of the parameters and x, which does not occur.  Never changed.

    Examples
    --------
    >>> t = RationalFunction.parameter("t", ("t",))
    >>> str((t * t - 1) / (t - 1)), str(Fraction(1, 2) / (2 * t + 1))
    ('t + 1', '(1/4)/(t + 1/2)')
    """

    parameters: tuple[str, ...]
    numerator: Any
    denominator: Any

    @classmethod
    def constant(cls, value: Fraction | int, parameters: tuple[str, ...]) -> RationalFunction:
        """A rational number."""
        inside = ring(parameters)
        return cls(parameters, inside.constant(to_fmpq(value)), inside.constant(1))

    @classmethod
    def parameter(cls, name: str, parameters: tuple[str, ...]) -> RationalFunction:
        """One of the parameters."""
        inside = ring(parameters)
        return cls(parameters, inside.gens()[parameters.index(name)], inside.constant(1))

    @classmethod
    def from_terms(
        cls, terms: Mapping[tuple[int, ...], Fraction], parameters: tuple[str, ...]
    ) -> RationalFunction:
        """The polynomial with these coefficients, by the exponents of the parameters."""
        inside = ring(parameters)
        coefficients = {(*exponents, 0): to_fmpq(c) for exponents, c in terms.items()}
        return _checked(parameters, inside.from_dict(coefficients), inside.constant(1))

    def terms(self) -> tuple[dict[tuple[int, ...], Fraction], dict[tuple[int, ...], Fraction]]:
        """Numerator and denominator: their coefficients by the exponents of the parameters.

        Examples
        --------
        >>> k = RationalFunction.parameter("k", ("k", "m"))
        >>> (1 / (2 * k)).terms()
        ({(0, 0): Fraction(1, 2)}, {(1, 0): Fraction(1, 1)})
        """
        width = len(self.parameters)
        top, bottom = (
            {
                tuple(map(int, exponents))[:width]: from_fmpq(c)
                for exponents, c in p.to_dict().items()
            }
            for p in (self.numerator, self.denominator)
        )
        return top, bottom

    @property
    def is_constant(self) -> bool:
        """Whether it is a rational number."""
        return bool(self.numerator.is_constant() and self.denominator.is_constant())

    @cached_property
    def occurring(self) -> tuple[str, ...]:
        """The parameters that occur in it."""
        degrees = zip(self.numerator.degrees(), self.denominator.degrees(), strict=True)
        pairs = zip(self.parameters, degrees, strict=False)
        return tuple(name for name, both in pairs if max(map(int, both)) > 0)

    @cached_property
    def value(self) -> Fraction:
        """The rational number that it is; 0 if it is none."""
        return _number(self.numerator) if self.is_constant else Fraction(0)

    def _coerced(self, other: Any) -> RationalFunction | None:
        if isinstance(other, (int, Fraction)) and not isinstance(other, bool):
            return RationalFunction.constant(other, self.parameters)
        if isinstance(other, RationalFunction) and other.parameters == self.parameters:
            return other
        return None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RationalFunction):
            return NotImplemented
        return str(self) == str(other) and self.parameters == other.parameters

    def __hash__(self) -> int:
        return hash((self.parameters, str(self)))

    def __bool__(self) -> bool:
        return bool(self.numerator != 0)

    def __add__(self, other: RationalFunction | int | Fraction) -> RationalFunction:
        addend = self._coerced(other)
        if addend is None:
            return NotImplemented
        a, b, c, d = self.numerator, self.denominator, addend.numerator, addend.denominator
        for degree in (_degree(a) + _degree(d), _degree(c) + _degree(b), _degree(b) + _degree(d)):
            _require_degree(degree)
        return self._over(a * d + c * b, b * d)

    __radd__ = __add__

    def __neg__(self) -> RationalFunction:
        return RationalFunction(self.parameters, -self.numerator, self.denominator)

    def __sub__(self, other: RationalFunction | int | Fraction) -> RationalFunction:
        addend = self._coerced(other)
        return NotImplemented if addend is None else self + -addend

    def __rsub__(self, other: int | Fraction) -> RationalFunction:
        return -self + other

    def __mul__(self, other: RationalFunction | int | Fraction) -> RationalFunction:
        factor = self._coerced(other)
        if factor is None:
            return NotImplemented
        _require_degree(_degree(self.numerator) + _degree(factor.numerator))
        _require_degree(_degree(self.denominator) + _degree(factor.denominator))
        return self._over(self.numerator * factor.numerator, self.denominator * factor.denominator)

    __rmul__ = __mul__

    def __truediv__(self, other: RationalFunction | int | Fraction) -> RationalFunction:
        divisor = self._coerced(other)
        if divisor is None:
            return NotImplemented
        if not divisor:
            raise ZeroDivisionError("division by the zero function")
        turned = self._over(divisor.denominator, divisor.numerator)
        return self * turned

    def __rtruediv__(self, other: int | Fraction) -> RationalFunction:
        return RationalFunction.constant(other, self.parameters) / self

    def __pow__(self, exponent: int) -> RationalFunction:
        degree = max(_degree(self.numerator), _degree(self.denominator))
        _require_degree(exponent * max(degree, 1))
        return RationalFunction(
            self.parameters, self.numerator**exponent, self.denominator**exponent
        )

    def _over(self, numerator: Any, denominator: Any) -> RationalFunction:
        """The quotient in lowest terms."""
        common = numerator.gcd(denominator)
        numerator, denominator = numerator / common, denominator / common
        lead = denominator.leading_coefficient()
        return _checked(self.parameters, numerator / lead, denominator / lead)

    def substituted(
        self, values: Sequence[RationalFunction | Fraction | int], zero: RationalFunction
    ) -> RationalFunction:
        """The function with one value for each parameter.

        Parameters
        ----------
        values : sequence of RationalFunction, Fraction or int
        zero : RationalFunction
            The constant 0, as a function of the parameters of the values.

        Raises
        ------
        InputError
            If the denominator becomes 0.
        """
        bottom = _evaluated(self.denominator, values, zero)
        if not bottom:
            raise InputError(f"{self} is undefined there: its denominator is 0")
        return _evaluated(self.numerator, values, zero) / bottom

    def values(self, places: Mapping[str, Any]) -> Any:
        """The values at floats, or at arrays of them, in floating point.

        Parameters
        ----------
        places : mapping
            For each parameter a float or an array.
        """
        at = [places[name] for name in self.parameters]
        return _in_floats(self.numerator, at) / _in_floats(self.denominator, at)

    def polynomials(self) -> tuple[Polynomial, Polynomial]:
        """Numerator and denominator as polynomials in the only parameter."""
        return _univariate(self.numerator), _univariate(self.denominator)

    def to_sympy(self) -> Any:
        """The function as an expression of sympy, N/D in the symbols of the parameters.

        Examples
        --------
        >>> t = RationalFunction.parameter("t", ("t",))
        >>> ((t * t + Fraction(1, 2)) / (t - 1)).to_sympy()
        (t**2 + 1/2)/(t - 1)
        """
        return _symbolic(self.numerator, self.parameters) / _symbolic(
            self.denominator, self.parameters
        )

    _sympy_ = to_sympy

    def latex(self) -> str:
        r"""LaTeX source.

        Examples
        --------
        >>> t = RationalFunction.parameter("gamma_1", ("gamma_1",))
        >>> print((t * t / (2 * t - 1)).latex())
        \frac{\tfrac{1}{2} \gamma_{1}^{2}}{\gamma_{1} - \tfrac{1}{2}}
        """
        top = _text(self.numerator, self.parameters, latex=True)
        if self.denominator == 1:
            return top
        return rf"\frac{{{top}}}{{{_text(self.denominator, self.parameters, latex=True)}}}"

    def _latex(self) -> str:
        return self.latex()

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.latex()}$"

    def __str__(self) -> str:
        top = _text(self.numerator, self.parameters)
        if self.denominator == 1:
            return top
        return f"({top})/({_text(self.denominator, self.parameters)})"

    def __repr__(self) -> str:
        return f"RationalFunction({str(self)!r})"


def _checked(parameters: tuple[str, ...], numerator: Any, denominator: Any) -> RationalFunction:
    _require_degree(max(_degree(numerator), _degree(denominator)))
    return RationalFunction(parameters, numerator, denominator)


def _require_degree(degree: int) -> None:
    if degree > MOST_DEGREE:
        raise LimitReached(f"a numerator or denominator of degree {degree} exceeds {MOST_DEGREE}")


def _degree(p: Any) -> int:
    return max(int(p.total_degree()), 0)


def _number(c: Any) -> Fraction:
    """The rational number that a constant polynomial is."""
    for value in c.to_dict().values():
        return from_fmpq(value)
    return Fraction(0)


def _univariate(p: Any) -> Polynomial:
    coefficients = {int(e[0]): from_fmpq(c) for e, c in p.to_dict().items()}
    degree = max(coefficients, default=-1)
    return Polynomial(tuple(coefficients.get(k, Fraction(0)) for k in range(degree + 1)))


def _evaluated(
    p: Any, values: Sequence[RationalFunction | Fraction | int], zero: RationalFunction
) -> RationalFunction:
    """Σ c_e v^e."""
    total = zero
    for exponents, c in p.to_dict().items():
        term = zero + from_fmpq(c)
        for value, exponent in zip(values, exponents, strict=False):
            if exponent:
                term = term * value ** int(exponent)
        total = total + term
    return total


def _in_floats(p: Any, at: Sequence[Any]) -> Any:
    """The value of a polynomial in floating point."""
    total: Any = 0.0
    for exponents, c in p.to_dict().items():
        term: Any = to_float(from_fmpq(c))
        for place, exponent in zip(at, exponents, strict=False):
            term = term * place ** int(exponent)
        total = total + term
    return total


def _symbolic(p: Any, parameters: tuple[str, ...]) -> Any:
    """A polynomial as an expression of sympy."""
    import sympy

    symbols = sympy.symbols(parameters)
    return sympy.Add(
        *(
            sympy.Rational(int(c.p), int(c.q))
            * sympy.prod([s ** int(e) for s, e in zip(symbols, exponents, strict=False)])
            for exponents, c in p.to_dict().items()
        )
    )


def _text(p: Any, parameters: tuple[str, ...], *, latex: bool = False) -> str:
    """The terms from the lexicographically highest power down, as `Polynomial` writes its own."""
    text = ""
    names = tuple(map(parameter_latex, parameters)) if latex else parameters
    for exponents, c in sorted(p.to_dict().items(), reverse=True):
        coefficient = from_fmpq(c)
        powers = [
            name if e == 1 else f"{name}^{{{e}}}" if latex else f"{name}^{e}"
            for name, e in zip(names, map(int, exponents), strict=False)
            if e
        ]
        size = abs(coefficient)
        number = rational_latex(size, "tfrac") if latex else rational_text(size)
        factors = ([number] if size != 1 or not powers else []) + powers
        sign = "-" if coefficient < 0 else "+"
        text += f" {sign} " if text else "-" if coefficient < 0 else ""
        text += (" " if latex else "*").join(factors)
    return text or "0"


def parameter_latex(name: str) -> str:
    r"""The name of a parameter in LaTeX: Greek letters, and what follows the letters below.

    Examples
    --------
    >>> print(parameter_latex("gamma1"), parameter_latex("k_2"), parameter_latex("mass"))
    \gamma_{1} k_{2} \mathrm{mass}
    """
    letters, _, below = name.partition("_")
    stem = letters.rstrip("0123456789")
    below = letters[len(stem) :] + (f",{below}" if below and stem != letters else below)
    if _GREEK.fullmatch(stem):
        shown = f"\\{stem}"
    else:
        shown = stem if len(stem) == 1 else rf"\mathrm{{{stem}}}"
    return f"{shown}_{{{escaped(below)}}}" if below else shown


# Matrices of rational functions of named parameters.


@dataclass(frozen=True, repr=False)
class FunctionMatrix(MatrixDisplay):
    """A matrix of rational functions of the same parameters.

    Attributes
    ----------
    rows : tuple of tuples of RationalFunction
    ncols : int
        The number of columns, also of a matrix without rows.
    """

    rows: tuple[tuple[RationalFunction, ...], ...]
    ncols: int

    @property
    def nrows(self) -> int:
        """Number of rows."""
        return len(self.rows)

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return len(self.rows), self.ncols

    def __getitem__(self, position: tuple[int, int]) -> RationalFunction:
        return self.rows[position[0]][position[1]]

    def is_zero(self) -> bool:
        """Whether every entry is the zero function."""
        return not any(map(any, self.rows))

    def take(self, rows: Sequence[int], cols: Sequence[int]) -> FunctionMatrix:
        """The submatrix of some rows and columns."""
        return FunctionMatrix(tuple(tuple(self.rows[i][j] for j in cols) for i in rows), len(cols))

    def tolist(self) -> list[list[RationalFunction]]:
        """The rows as lists of functions."""
        return [list(row) for row in self.rows]

    def to_sympy(self) -> Any:
        """The matrix as one of sympy, whose entries are equal expressions.

        Examples
        --------
        >>> t = RationalFunction.parameter("t", ("t",))
        >>> FunctionMatrix(((t, 1 / t),), 2).to_sympy()
        Matrix([[t, 1/t]])
        """
        import sympy

        return sympy.Matrix(*self.shape, [e.to_sympy() for row in self.rows for e in row])

    _sympy_ = to_sympy

    def __repr__(self) -> str:
        entries = ", ".join(f"[{', '.join(map(str, row))}]" for row in self.rows)
        text = f"FunctionMatrix([{entries}])"
        if len(text) <= LINE:
            return text
        return f"<{self.nrows} × {self.ncols} matrix of functions>"

    def mapped(self, function: Callable[[RationalFunction], RationalFunction]) -> FunctionMatrix:
        """The matrix of the values of a function at the entries."""
        return FunctionMatrix(tuple(tuple(map(function, row)) for row in self.rows), self.ncols)

    def constants(self) -> Matrix:
        """The matrix of numbers that this one is, if all its entries are constant."""
        return Matrix.from_rows([[e.value for e in row] for row in self.rows], ncols=self.ncols)

    @cached_property
    def reduced(self) -> tuple[PolynomialMatrix, Polynomial]:
        """M' and δ with M = M'/δ, δ the least common monic denominator, for one parameter.

        Examples
        --------
        >>> t = RationalFunction.parameter("t", ("t",))
        >>> M, delta = FunctionMatrix(((1 / (t - 1), t / (t * t - 1)),), 2).reduced
        >>> str(M.entry(0, 0)), str(M.entry(0, 1)), str(delta)
        ('x + 1', 'x', 'x^2 - 1')
        """
        parameters = next((e.parameters for row in self.rows for e in row), ("t",))
        rows, common = cleared(self, parameters)
        return polynomial_matrix(rows, self.ncols), _univariate(common)


# Matrices over Q[t_1, …, t_k], as rows of polynomials of flint.

Rows = list[list[Any]]
"""A matrix by its rows, whose entries are polynomials in the parameters."""


def cleared(M: FunctionMatrix, parameters: tuple[str, ...]) -> tuple[Rows, Any]:
    """M' and δ with M = M'/δ, δ the least common denominator of the entries."""
    entries = [[(e.numerator, e.denominator) for e in row] for row in M.rows]
    delta = ring(parameters).constant(1)
    for row in entries:
        for _, bottom in row:
            delta = delta * (bottom / delta.gcd(bottom))
    return [[top * (delta / bottom) for top, bottom in row] for row in entries], delta


def least_denominator(M: FunctionMatrix, parameters: tuple[str, ...]) -> RationalFunction:
    """The least common denominator of the entries."""
    return in_parameters(cleared(M, parameters)[1], parameters)


def polynomial_matrix(rows: Rows, ncols: int) -> PolynomialMatrix:
    """The matrix of polynomials in one parameter with these rows."""
    terms = [[e.to_dict() for e in row] for row in rows]
    length = 1 + max((int(t[0]) for row in terms for e in row for t in e), default=0)
    layers: list[list[list[Fraction]]] = [
        [[Fraction(0)] * ncols for _ in rows] for _ in range(length)
    ]
    for i, row in enumerate(terms):
        for j, entry in enumerate(row):
            for exponents, c in entry.items():
                layers[int(exponents[0])][i][j] = from_fmpq(c)
    return PolynomialMatrix.from_matrices(
        *(Matrix.from_rows(layer, ncols=ncols) for layer in layers)
    )


def product(M: Rows, N: Rows, zero: Any) -> Rows:
    """M N."""
    columns = [*zip(*N, strict=True)]
    return [
        [sum((a * b for a, b in zip(row, column, strict=True) if a and b), zero)
         for column in columns]
        for row in M
    ]  # fmt: skip


def total(M: Rows, N: Rows) -> Rows:
    """M + N."""
    return [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(M, N, strict=True)]


def value(f: Any, point: Sequence[Any]) -> Any:
    """The value of a polynomial without x at a point."""
    return f(*point, 0)


def determinant(M: Rows, parameters: tuple[str, ...]) -> Any:
    """The determinant up to its sign, by elimination without fractions (Bareiss).

    The shortest entry is the pivot, wherever it stands.

    Examples
    --------
    >>> a, b, _ = ring(("a", "b")).gens()
    >>> determinant([[a, b], [b, a]], ("a", "b")) in (a**2 - b**2, b**2 - a**2)
    True
    """
    rows = [list(row) for row in M]
    before = ring(parameters).constant(1)
    for _ in range(len(M) - 1):
        places = [(len(e), i, j) for i, row in enumerate(rows) for j, e in enumerate(row) if e]
        if not places:
            return ring(parameters).constant(0)
        _, i, j = min(places)
        top = rows.pop(i)
        pivot = top[j]
        rows = [
            [
                (pivot * entry - row[j] * above) / before
                for k, (entry, above) in enumerate(zip(row, top, strict=True))
                if k != j
            ]
            for row in rows
        ]
        before = pivot
    return rows[0][0] if rows else before


def irreducible_factors(h: Any, parameters: tuple[str, ...]) -> list[RationalFunction]:
    """The irreducible factors, other than constants, of a polynomial without x, in a fixed order.

    Their coefficients are coprime integers, the first one positive.
    """
    factors = (p for p, _ in h.factor()[1] if not p.is_constant())
    return [in_parameters(p, parameters) for p in sorted(factors, key=str)]


def in_parameters(h: Any, parameters: tuple[str, ...]) -> RationalFunction:
    """A polynomial of flint in which x does not occur, as a function of the parameters."""
    return RationalFunction(parameters, h, ring(parameters).constant(1))
