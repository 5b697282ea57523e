"""The grammar in which entries with parameters are written, such as "1/2 + 3*t^2".

    sum     = ["-"] product {("+" | "-") product}
    product = power {("*" | "/") power}
    power   = atom ["^" digits]
    atom    = number | parameter | "(" sum ")"
    number  = digits ["." digits]

Blanks may stand between tokens.  A text that is a number as other system files have it, such as
"-1/3" or "1e-3", is that number.  A text is read by the functions below and never evaluated by
Python or sympy.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from mcexact.errors import InputError, LimitReached
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.exact.rational_function import RationalFunction
from mcexact.model.matrix_json import read_number
from mcexact.model.names import quoted

_TOKEN = re.compile(r" *(?:([0-9]+(?:\.[0-9]+)?)|([A-Za-z][A-Za-z0-9_]*)|([-+*/^()]))", re.ASCII)
_NUMBER = re.compile(r"-?[0-9]+(?:/[0-9]+|(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)", re.ASCII)
_PARAMETER = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
LONGEST_NAME = 64
VARIABLE = "x"
"""The variable of characteristic polynomials, which no parameter can have as its name."""
_LONGEST = 100_000
_DEEPEST = 50


def checked_parameter(name: object, where: str) -> str:
    """Return the name of a parameter: a letter, then letters, digits and underscores, in ASCII.

    Raises
    ------
    InputError
        If it is something else, or "x", the variable of characteristic polynomials.

    Examples
    --------
    >>> checked_parameter("k_1", "parameters")
    'k_1'
    >>> checked_parameter("x", "parameters")
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: parameters: expected another name than 'x', the variable of \
characteristic polynomials
    """
    text = str(name)
    if len(text) > LONGEST_NAME or not _PARAMETER.fullmatch(text):
        raise InputError(
            f"expected a parameter as a letter, then letters, digits and underscores (ASCII, at "
            f"most {LONGEST_NAME}), found {quoted(text)}",
            where=where,
        )
    if text == VARIABLE:
        raise InputError(
            f"expected another name than {VARIABLE!r}, the variable of characteristic polynomials",
            where=where,
        )
    return text


def parse_expression(
    text: str,
    parameters: tuple[str, ...],
    limits: Limits = DEFAULT_LIMITS,
    *,
    where: str | None = None,
) -> RationalFunction:
    """Parse an entry with parameters.

    Parameters
    ----------
    text : str
    parameters : tuple of str
    limits : Limits
    where : str, optional
        The place to name in an error.

    Raises
    ------
    InputError
        If the text is not in the grammar, names another parameter, divides by 0, or exceeds a
        limit.

    Examples
    --------
    >>> print(parse_expression("1/2 + 3*t^2", ("t",)))
    3*t^2 + 1/2
    >>> print(parse_expression("(t^2 - 1)/(2 - 2*t)", ("t",)))
    -1/2*t - 1/2
    >>> parse_expression("2 t", ("t",))
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: expected an operator in '2 t', found 't'; products are written 2*t
    """
    if _NUMBER.fullmatch(text):
        return RationalFunction.constant(read_number(text, where or "", limits), parameters)
    if len(text) > _LONGEST:
        raise InputError(f"the expression has more than {_LONGEST} characters", where=where)
    try:
        return _Reader(text, parameters, limits).whole()
    except ZeroDivisionError:
        raise InputError(f"division by 0 in {quoted(text)}", where=where) from None
    except LimitReached as found:
        raise InputError(f"{found} in {quoted(text)}", where=where) from None
    except InputError as found:
        raise InputError(str(found), where=where) from None


class _Reader:
    """The tokens of a text, and the position reached."""

    def __init__(self, text: str, parameters: tuple[str, ...], limits: Limits) -> None:
        self.text, self.parameters, self.limits = text, parameters, limits
        self.tokens = self._tokens(text.rstrip(" "))
        self.position = self.depth = 0

    def _tokens(self, text: str) -> Sequence[str]:
        found, end = [], 0
        while end < len(text):
            match = _TOKEN.match(text, end)
            if match is None:
                raise self._refusal("a number, a parameter or an operator", text[end:].lstrip())
            found.append(match[0].lstrip(" "))
            end = match.end()
        return found

    def _refusal(self, expected: str, found: str, advice: str = "") -> InputError:
        shown = quoted(found) if found else "its end"
        return InputError(f"expected {expected} in {quoted(self.text)}, found {shown}{advice}")

    @property
    def next(self) -> str:
        """The next token; empty at the end."""
        return self.tokens[self.position] if self.position < len(self.tokens) else ""

    def take(self, *choices: str) -> str:
        """The next token if it is one of these, which is then passed."""
        found = self.next
        if found in choices:
            self.position += 1
            return found
        return ""

    def whole(self) -> RationalFunction:
        """All of the text."""
        result = self.sum()
        if self.next:
            isolated = self.next[:1].isalpha() or self.next == "("
            raise self._refusal("an operator", self.next, "; products are written 2*t" * isolated)
        return result

    def sum(self) -> RationalFunction:
        """Products, added and subtracted."""
        self.depth += 1
        if self.depth > _DEEPEST:
            raise InputError(f"more than {_DEEPEST} parentheses inside each other")
        result = -self.product() if self.take("-") else self.product()
        while sign := self.take("+", "-"):
            term = self.product()
            result = result + term if sign == "+" else result - term
        self.depth -= 1
        return result

    def product(self) -> RationalFunction:
        """Powers, multiplied and divided."""
        result = self.power()
        while sign := self.take("*", "/"):
            factor = self.power()
            result = result * factor if sign == "*" else result / factor
        return result

    def power(self) -> RationalFunction:
        """An atom, perhaps with an exponent."""
        result = self.atom()
        if not self.take("^"):
            return result
        digits = self.next
        if not digits.isdigit() or len(digits) > 9:
            raise self._refusal("an exponent of at most 9 digits", digits)
        self.position += 1
        return result ** int(digits)

    def atom(self) -> RationalFunction:
        """A number, a parameter, or a sum in parentheses."""
        token = self.next
        if self.take("("):
            result = self.sum()
            if not self.take(")"):
                raise self._refusal("')'", self.next)
            return result
        if token[:1].isdigit():
            self.position += 1
            value = read_number(token, "", self.limits)
            return RationalFunction.constant(value, self.parameters)
        if token[:1].isalpha():
            self.position += 1
            if token not in self.parameters:
                known = ", ".join(map(repr, self.parameters)) or "none"
                raise InputError(
                    f"unknown parameter {quoted(token)} in {quoted(self.text)}; "
                    f"the parameters are: {known}"
                )
            return RationalFunction.parameter(token, self.parameters)
        twice = token == "*" and self.tokens[self.position - 1 : self.position] == ["*"]
        advice = "; powers are written t^2" * twice
        raise self._refusal("a number, a parameter or '('", token, advice)
