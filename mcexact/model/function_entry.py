"""Conversion of matrices with parameters from Python callers: numbers, texts, sympy."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NoReturn

from mcexact.errors import FloatRefused, InputError
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.rational import TWO_WAYS_IN, as_fraction
from mcexact.exact.rational_function import RationalFunction
from mcexact.model.expression import parse_expression
from mcexact.model.matrix_entry import Table, rows_and_width
from mcexact.model.names import quoted


def as_functions(
    value: Any, where: str, parameters: tuple[str, ...], ncols: int | None = None
) -> Table[FunctionMatrix]:
    """Determine the shape of a matrix-like value, whose entries become functions when it is read.

    Parameters
    ----------
    value : FunctionMatrix, sequence of rows, numpy array of objects, sympy matrix
    where : str
        The place of the matrix, for messages.
    parameters : tuple of str
    ncols : int, optional
        The number of columns when there are no rows to tell it.

    Raises
    ------
    FloatRefused
        If an entry is a float, or an expression holds one.
    InputError
        If the value is not a matrix, or an entry is no rational function of the parameters.

    Examples
    --------
    >>> str(as_functions([["t/2 + 1", 3]], "A", ("t",)).matrix()[0, 0])
    '1/2*t + 1'
    """
    if isinstance(value, FunctionMatrix):
        return Table(value.shape, lambda: value)
    rows, width = rows_and_width(value, where, ncols)

    def matrix() -> FunctionMatrix:
        return FunctionMatrix(
            tuple(
                tuple(
                    as_function(entry, f"{where}[{i}][{j}]", parameters)
                    for j, entry in enumerate(row)
                )
                for i, row in enumerate(rows)
            ),
            width,
        )

    return Table((len(rows), width), matrix)


def as_function(entry: Any, where: str, parameters: tuple[str, ...]) -> RationalFunction:
    """Convert an entry: a number, a text, or an expression of sympy.

    Raises
    ------
    FloatRefused
        If it is a float, or holds one.
    InputError
        If it is no rational function of the parameters.
    """
    if isinstance(entry, RationalFunction):
        return entry
    if isinstance(entry, str):
        return parse_expression(entry, parameters, where=where)
    if getattr(entry, "free_symbols", None) and hasattr(entry, "as_numer_denom"):
        return _from_sympy(entry, where, parameters)
    return RationalFunction.constant(as_fraction(entry, where=where), parameters)


def _from_sympy(entry: Any, where: str, parameters: tuple[str, ...]) -> RationalFunction:
    """Convert an expression of sympy, which is a rational function of the parameters."""
    import sympy

    def refused() -> NoReturn:
        raise InputError(
            f"expected a rational function of {', '.join(parameters)} with rational coefficients, "
            f"found {quoted(str(entry))}",
            where=where,
        )

    if entry.has(sympy.Float):
        raise FloatRefused(TWO_WAYS_IN, where=where)
    symbols = {str(symbol): symbol for symbol in entry.free_symbols}
    unknown = sorted(set(symbols) - set(parameters))
    if unknown:
        raise InputError(f"{unknown[0]!r} is not among the parameters", where=where)
    generators = [symbols.get(name, sympy.Symbol(name)) for name in parameters]
    try:
        both = [
            sympy.Poly(part, *generators, domain="QQ")
            for part in sympy.fraction(sympy.together(entry))
        ]
    except (sympy.PolynomialError, sympy.CoercionFailed):
        refused()
    top, bottom = (
        RationalFunction.from_terms(
            {tuple(map(int, e)): Fraction(int(c.p), int(c.q)) for e, c in part.terms()},
            parameters,
        )
        for part in both
    )
    return top / bottom
