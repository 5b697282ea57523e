"""Matrix entries: from Python, from JSON, and with parameters.

Matrices come from two sides.  From Python they are lists, arrays or sympy matrices (`as_matrix`,
and `as_functions` with parameters).  From files they are rows, or a shape with a list of entries
(`read_matrix`).  Both sides determine the shape first and convert entries later (`Table`,
`Entries`), so that all shapes of a system are compared before the cost of conversion.  Numbers in
files are exact as typed.  The writers `number_json`, `matrix_json` and `canonical_matrix_text`
are here, too; the last one writes the form that digests and certificates use.

Entries with parameters, such as "1/2 + 3*t^2", are texts in this grammar::

    sum     = ["-"] product {("+" | "-") product}
    product = power {("*" | "/") power}
    power   = atom ["^" digits]
    atom    = number | parameter | "(" sum ")"
    number  = digits ["." digits]

Blanks may stand between tokens.  A text that is a number as other system files have it, such as
"-1/3" or "1e-3", is that number.  The parser is here; no text is ever evaluated by Python or
sympy.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from typing import Any, Generic, NoReturn, Protocol, TypeVar

from mcexact.errors import FloatRefused, InputError, LimitReached
from mcexact.exact.matrix import (
    Matrix,
    common_width,
    entries_of,
    from_cells,
    is_sparse_array,
    rows_of,
)
from mcexact.exact.rational import (
    DEFAULT_LIMITS,
    PRINTABLE_BITS,
    TWO_WAYS_IN,
    Limits,
    as_fraction,
    digits_of,
    parse_rational,
    rational_text,
)
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.text import (
    REMEMBERED,
    expect_integer,
    expect_list,
    expect_object,
    kind_of,
    quoted,
    shown_integer,
)

# Conversion of matrices from Python callers: nested lists, numpy integers, sympy, strings.


class Shaped(Protocol):
    """An object with numbers of rows and columns."""

    @property
    def shape(self) -> tuple[int, int]: ...


S = TypeVar("S", bound=Shaped)
M_co = TypeVar("M_co", covariant=True)


@dataclass(frozen=True)
class Table(Generic[M_co]):
    """A matrix from a caller whose shape is known and whose entries are not converted yet.

    Attributes
    ----------
    shape : (int, int)
    matrix : function
        Reads the entries.
    """

    shape: tuple[int, int]
    matrix: Callable[[], M_co]


def as_matrix(value: Any, where: str, ncols: int | None = None) -> Matrix:
    """Convert a matrix-like value to an exact matrix.

    Parameters
    ----------
    value : Matrix, sequence of rows, numpy or scipy array of integers or objects, sympy matrix
        Entries as `as_fraction` takes them.
    where : str
        The place of the matrix, for messages.
    ncols : int, optional
        The number of columns of a value without rows.

    Raises
    ------
    FloatRefused
        If an entry is a float.
    InputError
        If the value is not a matrix, its rows have different lengths, or an entry is not rational.

    Examples
    --------
    >>> as_matrix([["1/3", 2]], "A").shape
    (1, 2)
    >>> as_matrix([[0.5]], "A")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    mcexact.errors.FloatRefused: A[0][0]: ...
    """
    return as_table(value, where, ncols).matrix()


def as_table(value: Any, where: str, ncols: int | None = None) -> Table[Matrix]:
    """Determine the shape of a matrix-like value, and leave its entries to be converted later.

    Raises
    ------
    FloatRefused
        If it is an array of floats.
    InputError
        If the value is not a matrix, or its rows have different lengths.
    """
    if isinstance(value, Matrix):
        return Table(value.shape, lambda: value)
    if is_sparse_array(value):
        entries, shape = entries_of(value, where), (int(value.shape[0]), int(value.shape[1]))
        return Table(shape, partial(Matrix.from_entries, shape, entries, where=where))
    rows, width = rows_and_width(value, where, ncols)
    return Table((len(rows), width), partial(Matrix.from_rows, rows, width, where=where))


def rows_and_width(
    value: Any, where: str, ncols: int | None = None
) -> tuple[list[tuple[Any, ...]], int]:
    """The rows of a matrix-like value, and their length, by its shape or `ncols` without rows.

    Raises
    ------
    FloatRefused
        If it is an array of floats.
    InputError
        If the value is not a matrix, or its rows have different lengths.
    """
    rows = rows_of(value, where)
    width = common_width(rows, where)
    return rows, int(getattr(value, "shape", (0, ncols or 0))[1]) if width is None else width


def require_shape(M: S, where: str, nrows: int | None, ncols: int | None) -> S:
    """Return the matrix if it has the expected numbers of rows and columns.

    Raises
    ------
    InputError
        If it does not, such as ``channels[2].B: expected 4 rows, found 3``.
    """
    for expected, found, what in (
        (nrows, M.shape[0], "row"),
        (ncols, M.shape[1], "column"),
    ):
        if expected is not None and found != expected:
            plural = "" if expected == 1 else "s"
            raise InputError(f"expected {expected} {what}{plural}, found {found}", where=where)
    return M


def require_square(M: S, where: str) -> S:
    """Return the matrix if it is square.

    Raises
    ------
    InputError
        If it is not.
    """
    if M.shape[0] != M.shape[1]:
        raise InputError(
            f"expected a square matrix, found {M.shape[0]} × {M.shape[1]}", where=where
        )
    return M


# Matrices in files: read strictly from dense rows or sparse entries, written in lowest terms.

M = TypeVar("M")

LONGEST_SIDE = 2**20
"""The most rows and columns of a sparse matrix; a few bytes must not fill the memory."""


_LETTERS = re.compile(r"[A-Za-z0-9_+*/^(). -]*[A-DF-Za-df-z][A-Za-z0-9_+*/^(). -]*")
"""A text with a letter other than that of an exponent."""


def read_number(value: Any, where: str, limits: Limits = DEFAULT_LIMITS) -> Fraction:
    """Read one exact number: an integer, a decimal as typed, or a string "p/q".

    Raises
    ------
    InputError
        If the value is not such a number, or is too long.
    """
    if type(value) is int:
        return Fraction(value)
    if not isinstance(value, str):
        raise InputError(f"expected a number, found {kind_of(value)}", where=where)
    try:
        number = parse_rational(str(value), limits, where=where)
    except InputError as error:
        if _LETTERS.fullmatch(value) and value.lower() not in ("nan", "inf", "infinity"):
            error.message += "; the key `parameters` of a system file makes letters parameters"
        raise
    # A decimal with an exponent can have more digits when it is written out.
    longest = max(abs(number.numerator), number.denominator)
    # Of the two conditions the first one is quick, and false for nearly all numbers.
    if longest.bit_length() > 3 * limits.digits and longest >= 10**limits.digits:
        raise InputError(
            f"expected at most {limits.digits} digits when written out (Limits.digits), "
            f"found {len(value)} characters that stand for more",
            where=where,
        )
    return number


def read_matrix(
    value: Any,
    where: str,
    nrows: int | None = None,
    ncols: int | None = None,
    limits: Limits = DEFAULT_LIMITS,
) -> Matrix:
    """Read a matrix of a known or unknown shape.

    Parameters
    ----------
    value : list of rows, or object
        A dense matrix is a list of rows.  A sparse matrix is ``{"shape": [r, c], "entries": [[i, j,
        value], …]}`` with positions from 0; other entries are 0.
    where : str
        Its place, for messages.
    nrows, ncols : int, optional
        The expected shape, if it is known.
    limits : Limits

    Raises
    ------
    InputError
        If the matrix is malformed or has another shape.

    Examples
    --------
    >>> read_matrix({"shape": [2, 3], "entries": [[1, 2, "1/2"]]}, "A")[1, 2]
    Fraction(1, 2)
    >>> read_matrix([[1], [2], [3]], "channels[2].B", nrows=4)
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels[2].B: expected 4 rows, found 3
    """
    return unread_matrix(value, where, nrows, ncols, partial(numbers, limits=limits)).matrix()


@dataclass(frozen=True)
class Entries:
    """The entries of a matrix in a file, which are not read yet.

    Attributes
    ----------
    where : str
        The place of the matrix, for messages.
    shape : (int, int)
    rows : list of lists, or None
        The entries row by row.
    triples : list
        Without rows, the triples [row, column, value] of the entries that are not 0.
    """

    where: str
    shape: tuple[int, int]
    rows: list[list[Any]] | None
    triples: list[Any]

    def listed(self) -> Iterator[tuple[int, int, int, Any]]:
        """Yield number, row, column and value of each triple.

        Raises
        ------
        InputError
            If it is no triple, or its position is outside the shape or occurs twice.
        """
        r, c = self.shape
        seen: set[int] = set()
        for k, entry in enumerate(self.triples):
            if type(entry) is not list or len(entry) != 3:
                length = len(expect_list(entry, self.place(k)))
                raise InputError(
                    f"expected [row, column, value], found {length} items", where=self.place(k)
                )
            i, j, value = entry
            if type(i) is not int or type(j) is not int or i < 0 or j < 0:
                i, j = (expect_integer(entry[axis], f"{self.place(k)}[{axis}]") for axis in (0, 1))
            if i >= r or j >= c:
                position = f"[{shown_integer(i)}, {shown_integer(j)}]"
                raise InputError(
                    f"expected a position inside {r} × {c}, found {position}", where=self.place(k)
                )
            if i * c + j in seen:
                raise InputError(f"the position [{i}, {j}] is listed twice", where=self.place(k))
            seen.add(i * c + j)
            yield k, i, j, value

    def place(self, k: int) -> str:
        """The place of a triple."""
        return f"{self.where}.entries[{k}]"


def unread_matrix(
    value: Any,
    where: str,
    nrows: int | None,
    ncols: int | None,
    read: Callable[[Entries], M],
) -> Table[M]:
    """Determine the shape of a matrix in a file, and leave its entries to be read later.

    Parameters
    ----------
    value : list of rows, or object
        As `read_matrix` takes it.
    where : str
    nrows, ncols : int or None
        The expected shape, if it is known.
    read : callable
        Makes the matrix from its `Entries`.

    Raises
    ------
    InputError
        If the value is not a matrix, its rows have different lengths, or it is too large.

    Examples
    --------
    >>> unread_matrix([[1, "no number"]], "A", None, None, numbers).shape
    (1, 2)
    """
    if isinstance(value, dict):
        expect_object(value, where, ("shape", "entries"))
        shape = _sparse_shape(value["shape"], where)
        rows = expect_list(value["entries"], f"{where}.entries")
        entries = Entries(where, shape, None, rows)
    else:
        rows = expect_list(value, where)
        for k, row in enumerate(rows):
            if not isinstance(row, list):
                raise InputError(
                    f"expected a row as a list, found {kind_of(row)}; "
                    "write a column as [[1], [2]] and a row as [[1, 2]]",
                    where=f"{where}[{k}]",
                )
        width = common_width(rows, where)
        width = ncols or 0 if width is None else width
        entries = Entries(where, (len(rows), width), rows, [])
    return require_shape(Table(entries.shape, partial(read, entries)), where, nrows, ncols)


def numbers(entries: Entries, limits: Limits = DEFAULT_LIMITS) -> Matrix:
    """Read the numbers of a matrix.

    Raises
    ------
    InputError
        If an entry is no number, or is too long.
    """
    if entries.rows is None:
        return _sparse(entries, limits)
    return _dense(entries.rows, entries.shape[1], entries.where, limits)


def _dense(rows: list[list[Any]], width: int, where: str, limits: Limits) -> Matrix:
    """Read the numbers of all rows; a text that occurs often, such as 0.0, is read once."""
    known: dict[str, Fraction] = {}

    def number(entry: Any, i: int, j: int) -> Fraction | int:
        if type(entry) is int:
            return entry
        if isinstance(entry, str) and entry in known:
            return known[entry]
        exact = read_number(entry, f"{where}[{i}][{j}]", limits)
        if isinstance(entry, str) and len(known) < REMEMBERED:
            known[entry] = exact
        return exact

    if not all(set(map(type, row)) <= {int} for row in rows):
        rows = [[number(entry, i, j) for j, entry in enumerate(row)] for i, row in enumerate(rows)]
    return Matrix.from_rows(rows, ncols=width)


def _sparse_shape(value: Any, where: str) -> tuple[int, int]:
    """Read the shape of a sparse matrix."""
    sizes = expect_list(value, f"{where}.shape")
    if len(sizes) != 2:
        raise InputError(
            f"expected [rows, columns], found {len(sizes)} numbers", where=f"{where}.shape"
        )
    r, c = (expect_integer(size, f"{where}.shape[{k}]") for k, size in enumerate(sizes))
    if max(r, c) > LONGEST_SIDE:
        raise InputError(
            f"expected at most {LONGEST_SIDE} rows and columns in a sparse matrix, "
            f"found {shown_integer(r)} × {shown_integer(c)}",
            where=where,
        )
    return r, c


def _sparse(entries: Entries, limits: Limits) -> Matrix:
    """Read the entries of a sparse matrix."""
    c = entries.shape[1]
    values: dict[int, Fraction | int] = {}
    for k, i, j, value in entries.listed():
        if type(value) is not int:
            value = read_number(value, f"{entries.place(k)}[2]", limits)
        values[i * c + j] = value
    denominator = math.lcm(*{number.denominator for number in values.values()})
    cells = sorted(values)
    numerators = (values[k].numerator * (denominator // values[k].denominator) for k in cells)
    return from_cells(entries.shape, cells, numerators, denominator)


def number_json(value: Fraction) -> int | str:
    """Write a rational as a JSON integer, or as a string "p/q" in lowest terms.

    An integer of thousands of digits, which exceeds the default limit of readers, becomes a string
    too.
    """
    if value.denominator == 1 and value.numerator.bit_length() < PRINTABLE_BITS:
        return value.numerator
    return rational_text(value)


def matrix_json(M: Matrix | FunctionMatrix) -> Any:
    """Write a matrix as a list of rows; one with columns but no rows says its shape.

    Raises
    ------
    LimitReached
        If the matrix is sparse, and too large for a list of rows.
    """
    r, c = M.shape
    if not r and c:
        return {"shape": [0, c], "entries": []}
    if isinstance(M, FunctionMatrix):
        return [[number_json(e.value) if e.is_constant else str(e) for e in row] for row in M.rows]
    d = M.denominator
    if d == 1 and M.words is not None:
        return [list(row) for row in M.numerators]
    return [[number_json(Fraction(entry, d)) for entry in row] for row in M.numerators]


def canonical_matrix_text(M: Matrix) -> str:
    """The canonical JSON text of a matrix in a certificate's system, in lowest terms.

    A matrix of at least 2**11 cells of which at most an eighth are not 0 is an object that has its
    shape and lists these entries row by row; any other one is a list of rows.

    Notes
    -----
    Integers of at most 64 bits are formatted row by row from machine words, in 40 ns each, which is
    half of what ``json`` takes without the rows as lists.

    Examples
    --------
    >>> print(canonical_matrix_text(Matrix.from_rows([["1/2", 3]])))
    [["1/2",3]]
    """
    r, c = M.shape
    M = M.suited()
    if M.is_sparse or (c and not r):
        return sparse_matrix_text(M)
    if not r:
        return "[]"
    words = M.words if M.denominator == 1 else None
    if words is None:
        rows = [",".join([_entry_text(x, M.denominator) for x in row]) for row in M.numerators]
    elif c == 1:
        return "[[" + _template(r, "],[") % tuple(words) + "]]"
    else:
        template = _template(c, ",")
        rows = [template % tuple(words[k * c : (k + 1) * c]) for k in range(r)]
    return "[[" + "],[".join(rows) + "]]"


def sparse_matrix_text(M: Matrix, between: str = ",") -> str:
    """The JSON text of a matrix by its shape and its entries that are not 0."""
    d = M.denominator
    if d == 1:
        triples = between.join([f"[{i},{j},{digits_of(x)}]" for i, j, x in M.nonzero()])
    else:
        triples = between.join([f"[{i},{j},{_entry_text(x, d)}]" for i, j, x in M.nonzero()])
    return f'{{"entries":[{triples}],"shape":[{M.nrows},{M.ncols}]}}'


@lru_cache(maxsize=16)
def _template(size: int, between: str) -> str:
    """The text into which this number of integers is formatted."""
    return between.join(["%d"] * size)


def _entry_text(numerator: int, denominator: int) -> str:
    """A quotient as JSON: an integer, or "p/q" in lowest terms."""
    common = math.gcd(numerator, denominator)
    text = digits_of(numerator // common)
    return text if common == denominator else f'"{text}/{digits_of(denominator // common)}"'


def json_text_of_number(value: int | str) -> str:
    """The JSON text of a number as `number_json` gives it."""
    return f'"{value}"' if isinstance(value, str) else str(value)


# The grammar in which entries with parameters are written, such as "1/2 + 3*t^2".

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
    except LimitReached as error:
        raise InputError(f"{error} in {quoted(text)}", where=where) from None
    except InputError as error:
        raise InputError(str(error), where=where) from None


class _Reader:
    """The tokens of a text, and the position reached."""

    def __init__(self, text: str, parameters: tuple[str, ...], limits: Limits) -> None:
        self.text, self.parameters, self.limits = text, parameters, limits
        self.tokens = self._tokens(text.rstrip(" "))
        self.position = self.depth = 0

    def _tokens(self, text: str) -> Sequence[str]:
        tokens, end = [], 0
        while end < len(text):
            match = _TOKEN.match(text, end)
            if match is None:
                raise self._refusal("a number, a parameter or an operator", text[end:].lstrip())
            tokens.append(match[0].lstrip(" "))
            end = match.end()
        return tokens

    def _refusal(self, expected: str, found: str, advice: str = "") -> InputError:
        shown = quoted(found) if found else "its end"
        return InputError(f"expected {expected} in {quoted(self.text)}, found {shown}{advice}")

    @property
    def next(self) -> str:
        """The next token; empty at the end."""
        return self.tokens[self.position] if self.position < len(self.tokens) else ""

    def take(self, *choices: str) -> str:
        """Take the next token if it is one of these; otherwise return an empty text."""
        token = self.next
        if token in choices:
            self.position += 1
            return token
        return ""

    def whole(self) -> RationalFunction:
        """Parse the whole text."""
        result = self.sum()
        if self.next:
            isolated = self.next[:1].isalpha() or self.next == "("
            raise self._refusal("an operator", self.next, "; products are written 2*t" * isolated)
        return result

    def sum(self) -> RationalFunction:
        """Parse a sum: products, added and subtracted."""
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
        """Parse a product: powers, multiplied and divided."""
        result = self.power()
        while sign := self.take("*", "/"):
            factor = self.power()
            result = result * factor if sign == "*" else result / factor
        return result

    def power(self) -> RationalFunction:
        """Parse an atom, perhaps with an exponent."""
        result = self.atom()
        if not self.take("^"):
            return result
        digits = self.next
        if not digits.isdigit() or len(digits) > 9:
            raise self._refusal("an exponent of at most 9 digits", digits)
        self.position += 1
        return result ** int(digits)

    def atom(self) -> RationalFunction:
        """Parse a number, a parameter, or a sum in parentheses."""
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


# Conversion of matrices with parameters from Python callers: numbers, texts, sympy.


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
        The number of columns of a value without rows.

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
