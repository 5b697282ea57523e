"""Strict reading: bytes to JSON, and JSON to numbers, polynomials, matrices, positions and names.

Whoever forges a certificate chooses its bytes, so this module accepts one form of every value and
refuses all others: a key twice in an object, an unknown key, ``true`` in place of 1, a fraction not
in lowest terms, and numbers longer than ``Limits`` allows, which are counted in the text before any
of them is converted.  Every value is read where a rule needs it, by a reader that takes the value
and its place in the document, for the message.

There are three ways to stop, all by the exception `Refused`:

- `malformed`: the document does not have the form that ``FORMAT.md`` prescribes.
- `incomplete`: it may have that form, but exceeds a limit of this checker.
- `require`: it has the form, and the evidence does not prove the claim; the verdict is INVALID.
"""

import errno
import json
import math
import re
import sys
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import IO, Any, NoReturn

from .arithmetic import Matrix, Polynomial
from .budget import Refused as Refused
from .budget import spend

# A string is one match, also without its end; possessive quantifiers make the scans linear.
TOKEN = re.compile(r'"(?:[^"\\]++|\\.)*+"?|[\[{]|[\]}]', re.DOTALL)
QUOTIENT = re.compile(r"-?(?:0|[1-9][0-9]*+)/[1-9][0-9]*+")
DECIMAL = re.compile(r"-?(?:0|[1-9][0-9]*+)(?:\.[0-9]++)?")
Json = Any
"""A value of a document, of which nothing is known before a reader has taken it."""
HIDDEN = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""The Unicode categories of characters that do not print."""


@dataclass(frozen=True)
class Limits:
    """The limits on a document: bytes, nesting, digits of a number, size of an exponent, work.

    The work is in units of ``budget``; None stands for what is granted to a document of its size.
    """

    bytes: int = 64 * 2**20
    depth: int = 16
    digits: int = 4300
    exponent: int = 1000
    work: int | None = None


def malformed(place: str, message: str) -> NoReturn:
    """Stop: the document does not have the form that the format prescribes."""
    raise Refused("MALFORMED", "form", place, message)


def incomplete(code: str, place: str, message: str) -> NoReturn:
    """Stop: the document may be well formed, but exceeds the limits of this checker."""
    raise Refused("INCOMPLETE", code, place, message)


def require(condition: bool, code: str, place: str, message: str) -> None:
    """Stop unless the condition holds: the evidence does not prove the claim."""
    if not condition:
        raise Refused("INVALID", code, place, message)


def parse(data: bytes, limits: Limits, decimal_of: Callable[[str], Json] | None = None) -> Json:
    """Parse JSON text: UTF-8, no key twice, no constants such as NaN, nothing beyond the limits.

    ``decimal_of`` reads a number with a point or an exponent; without it such a number is refused.
    """
    if len(data) > limits.bytes:
        incomplete("size", "file", f"more than {limits.bytes} bytes (Limits.bytes)")
    spend(40 * len(data))
    if decimal_of is not None:  # of files that users write, some editors mark the encoding
        data = data.removeprefix(b"\xef\xbb\xbf")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        malformed(f"byte {error.start}", "expected UTF-8 text")
    depth = 0
    for token in TOKEN.finditer(text):
        depth += (token[0] in "[{") - (token[0] in "]}")
        if depth > limits.depth:
            malformed("file", f"nested deeper than {limits.depth} levels (Limits.depth)")
    long_number = re.compile(f"[0-9]{{{min(20, limits.digits + 1)}}}[0-9]*+")
    plain = re.sub(r"\\u003([0-9])", r"\1", text)  # digits may be written as escapes
    for number in long_number.finditer(plain):
        digits = len(number[0])
        if digits > limits.digits:
            incomplete("size", "file", f"more than {limits.digits} digits in a row (Limits.digits)")
        spend(digits * digits // 500)  # Python converts them in quadratic time, and both ways

    def refuse(number: str) -> NoReturn:
        malformed(f"number {number[:24]}", 'expected an integer or a string "p/q"')

    def object_of(pairs: list[tuple[str, Json]]) -> dict[str, Json]:
        result: dict[str, Json] = {}
        for key, value in pairs:
            if key in result:
                malformed(f"key {shown(key)}", "given twice in one object")
            result[key] = value
        return result

    floats, pairs = decimal_of or refuse, object_of
    try:
        return json.loads(text, parse_float=floats, parse_constant=refuse, object_pairs_hook=pairs)
    except json.JSONDecodeError as error:
        message = error.msg.replace("Expecting", "expected")
        malformed(f"line {error.lineno} column {error.colno}", f"not JSON: {message}")
    except RecursionError:
        malformed("file", "nested deeper than any certificate")


def read_bytes(stream: IO[bytes], limits: Limits) -> bytes:
    """Read a stream in parts, until it ends or has one byte more than the limit."""
    data = bytearray()
    while part := stream.read(min(2**20, limits.bytes + 1 - len(data))):
        data += part
    return bytes(data)


def read_file(path: str, limits: Limits) -> bytes:
    """The bytes of a file, or of standard input for ``-``."""
    try:
        if path != "-":
            with open(path, "rb") as stream:
                return read_bytes(stream, limits)
        if sys.stdin is None:
            raise OSError(errno.EBADF, "standard input is closed")
        return read_bytes(sys.stdin.buffer, limits)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise Refused("MALFORMED", "unreadable", "file", f"cannot be read: {reason}") from error


def shown(value: Json) -> str:
    """A value of a document as a message shows it: ASCII, on one line, and short."""
    if isinstance(value, (Mapping, list, float)):
        return f"a value of type {type(value).__name__}"
    if type(value) is int and value.bit_length() > 99:
        return "a large integer"
    return json.dumps(value if type(value) is not str else value[:40], default=repr)


def fields(value: Json, place: str, *names: str, optional: tuple[str, ...] = ()) -> list[Json]:
    """The values of an object that has exactly these keys; None for an optional one left out."""
    if not isinstance(value, Mapping):
        malformed(place, f"expected an object, found {shown(value)}")
    spend(20 + 10 * (len(value) + len(names) + len(optional)))
    for name in names:
        if name not in value:
            malformed(place, f"the key {shown(name)} is missing")
    allowed = {*names, *optional}
    for key in value:
        if key not in allowed:
            malformed(place, f"unknown key {shown(key)}")
        if key in optional and value[key] is None:
            malformed(place, f"the key {shown(key)} is null; leave it out")
    return [value.get(name) for name in names + optional]


def by_name(value: Json, place: str, known: Sequence[str]) -> list[tuple[str, int, Json]]:
    """The entries of an object, perhaps left out, by some of these names, with their positions."""
    if value is None or value == {}:
        return []
    entries = fields(value, place, optional=tuple(known))
    return [(known[j], j, entry) for j, entry in enumerate(entries) if entry is not None]


def items(value: Json, place: str, length: int | None = None) -> list[Json]:
    """The members of a list, which has ``length`` members unless this is None."""
    if type(value) is not list:
        malformed(place, f"expected a list, found {shown(value)}")
    if length is not None and len(value) != length:
        malformed(place, f"expected {length} of them, found {len(value)}")
    return value


def integer(value: Json, place: str, least: float = 0) -> int:
    """An integer, not below ``least``."""
    if type(value) is not int or value < least:
        malformed(place, f"expected an integer from {least} on, found {shown(value)}")
    return value


def boolean(value: Json, place: str) -> bool:
    """True or false."""
    if type(value) is not bool:
        malformed(place, f"expected true or false, found {shown(value)}")
    return value


def string(value: Json, place: str, *choices: str) -> str:
    """A string, one of the choices if there are any."""
    if type(value) is not str or (choices and value not in choices):
        expected = " or ".join(map(shown, choices)) or "a string"
        malformed(place, f"expected {expected}, found {shown(value)}")
    return value


def printable(value: Json, place: str, longest: int, allowed: str = "") -> str:
    """A string of at most ``longest`` characters, all of which print or are allowed."""
    hidden = {c for c in string(value, place)[:longest] if unicodedata.category(c) in HIDDEN}
    if len(value) > longest or hidden - set(allowed):
        malformed(place, f"expected at most {longest} characters that print, found {shown(value)}")
    return str(value)


def own_names(values: list[Json], places: list[str]) -> list[str]:
    """Names of channels or agents: of 1 to 256 characters, no two equal in the normal form NFC."""
    names, forms = [], {""}
    for value, place in zip(values, places, strict=True):
        names.append(printable(value, place, 256))
        form = unicodedata.normalize("NFC", names[-1])
        if form in forms:
            malformed(place, f"expected a name of its own, found {shown(value)}")
        forms.add(form)
    return names


def rational(value: Json, place: str) -> Fraction:
    """A rational: an integer, or "p/q" in lowest terms with q ≥ 2."""
    if type(value) is int:
        return Fraction(value)
    if type(value) is str and QUOTIENT.fullmatch(value):
        numerator, denominator = map(int, value.split("/"))
        if denominator > 1 and math.gcd(numerator, denominator) == 1:
            return Fraction(numerator, denominator)
    malformed(place, f'expected an integer or "p/q" in lowest terms, found {shown(value)}')


def decimal(value: Json, place: str) -> Fraction:
    """A decimal: a string such as "-1.25", without exponent."""
    if type(value) is not str or not DECIMAL.fullmatch(value):
        malformed(place, f'expected a decimal such as "-1.25", found {shown(value)}')
    return Fraction(value)


def polynomial(value: Json, place: str, least_degree: int = 0) -> Polynomial:
    """A monic polynomial: its coefficients, constant term first, the last one 1."""
    spend(100 * len(items(value, place)))
    result = [rational(entry, f"{place}[{k}]") for k, entry in enumerate(items(value, place))]
    if len(result) <= least_degree or result[-1] != 1:
        malformed(place, f"expected a monic polynomial of degree at least {least_degree}")
    return result


def _integer_rows(value: Json, place: str, nrows: int, ncols: int) -> list[list[int]]:
    """Rows of integers, of the prescribed shape."""
    for i, row in enumerate(items(value, place, nrows)):
        if not all(type(entry) is int for entry in items(row, f"{place}[{i}]", ncols)):
            malformed(f"{place}[{i}]", "expected integers over the common denominator")
    return value  # type: ignore[no-any-return]


def matrix(value: Json, place: str, nrows: int, ncols: int) -> Matrix:
    """A matrix of the prescribed shape: integer entries over one denominator."""
    denominator, entries = fields(value, place, "denominator", "entries")
    rows = _integer_rows(entries, f"{place}.entries", nrows, ncols)
    return Matrix(rows, ncols, integer(denominator, f"{place}.denominator", 1))


def matrices(value: Json, place: str, shapes: list[tuple[int, int]]) -> list[Matrix]:
    """A list of matrices of the prescribed shapes."""
    entries = enumerate(items(value, place, len(shapes)))
    return [matrix(entry, f"{place}[{i}]", *shapes[i]) for i, entry in entries]


def polynomial_matrix(
    value: Json, place: str, nrows: int, ncols: int, degree: int | None = None
) -> list[Matrix]:
    """The coefficient matrices of a polynomial matrix, reduced modulo a p of this degree if any."""
    denominator, layers = fields(value, place, "denominator", "coefficients")
    d = integer(denominator, f"{place}.denominator", 1)
    found = len(items(layers, f"{place}.coefficients"))
    most = max(found, 1) if degree is None else degree
    if not 1 <= found <= most:
        malformed(f"{place}.coefficients", f"expected 1 to {most} matrices, found {found}")
    rows = [_integer_rows(layer, f"{place}.coefficients", nrows, ncols) for layer in layers]
    padding = [Matrix.zeros(nrows, ncols)] * (most - found)
    return [Matrix(layer, ncols, d) for layer in rows] + padding


def positions(value: Json, place: str, below: int) -> list[int]:
    """Strictly increasing positions from 0 to ``below`` − 1."""
    result = [integer(entry, place) for entry in items(value, place)]
    if result != sorted(set(result)) or any(entry >= below for entry in result):
        malformed(place, f"expected increasing positions below {below}, none of them twice")
    return result


def names(value: Json, place: str, known: list[str]) -> list[int]:
    """The positions of named channels, each known, in the order of the system, none twice."""
    spend(4 * (len(items(value, place)) + len(known)))
    place_of = {name: i for i, name in enumerate(known)}
    for entry in value:
        if type(entry) is not str or entry not in place_of:
            malformed(place, f"expected the name of a channel, found {shown(entry)}")
    return positions([place_of[entry] for entry in value], place, len(known))
