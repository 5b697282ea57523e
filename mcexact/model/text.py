"""Strict JSON, its canonical form and digest, names of channels, atomic writing.

- Names of channels: printable texts, no two of which look the same.
- Reading: `parse` limits size and depth, refuses repeated keys, and keeps decimals as typed, so
  that 0.1 is read as 1/10.  The functions ``expect_…`` check what stands at a place, and name the
  place.
- Writing: `canonical` gives equal text for equal data, and `sha256` its digest, by which
  certificates refer to plants.
- Files: `write_text` and `write_bytes` write a file completely or not at all.
"""

from __future__ import annotations

import difflib
import hashlib
import json
import os
import re
import stat
import sys
import tempfile
import time
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from mcexact.errors import InputError, NotWritten, OtherFormat, place_of
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import DEFAULT_LIMITS, Limits, written

# The names of channels: which texts are valid, and how messages quote them.

LONGEST_NAME = 256
# Control characters, invisible format characters (among them every reordering of text), lone
# surrogates, and line and paragraph separators.
_REFUSED_CATEGORIES = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})


def quoted(text: object, width: int = 40) -> str:
    """Quote a text of the user in ASCII, shortened.

    Examples
    --------
    >>> quoted("u\\u202e1")
    "'u\\\\u202e1'"
    """
    if not isinstance(text, str):
        return f"a value of type {type(text).__name__}"
    return ascii(text) if len(text) <= width else ascii(text[:width]) + "…"


def nearest(name: str, known: Collection[str]) -> str:
    """Return the end of a message that suggests the nearest known name, or an empty text.

    Examples
    --------
    >>> nearest("stabilty", ["stability", "setpoint"]), nearest("xyz", ["stability"])
    (" (did you mean 'stability'?)", '')
    """
    close = difflib.get_close_matches(name[:LONGEST_NAME], list(known), n=1)
    return f" (did you mean {quoted(close[0])}?)" if close else ""


LONGEST_TEXT = 10_000
"""The most characters of a name or a source."""


def checked_text(text: object, where: str, *, longest: int = LONGEST_TEXT) -> str:
    """Check and return a text such as a system's name or source.

    Raises
    ------
    InputError
        If the value is not a string, is too long, or contains characters that do not print.
    """
    if not isinstance(text, str):
        raise InputError(f"expected a string, found {quoted(text)}", where=where)
    if len(text) > longest:
        raise InputError(f"expected at most {longest} characters, found {len(text)}", where=where)
    _require_printable(text, where, "", allowed="\n\t")
    return text


def _require_printable(text: str, where: str, place: str, allowed: str = "") -> None:
    """Refuse a character that does not print, with the place that it is to be removed from."""
    for character in text:
        if unicodedata.category(character) in _REFUSED_CATEGORIES and character not in allowed:
            raise InputError(
                f"remove the character U+{ord(character):04X}{place}: it does not print",
                where=where,
            )


def checked_name(name: object, where: str) -> str:
    """Check and return the name of a channel or agent.

    Raises
    ------
    InputError
        If the value is not a string, is empty or longer than 256 characters, or contains control or
        invisible characters.  (Characters that reorder text would show the name of another
        channel.)
    """
    if not isinstance(name, str):
        raise InputError(
            f'expected a name as a string, such as "1", found {quoted(name)}', where=where
        )
    if not name:
        raise InputError("expected a name, found the empty string", where=where)
    if len(name) > LONGEST_NAME:
        raise InputError(
            f"expected a name of at most {LONGEST_NAME} characters, found {len(name)}", where=where
        )
    _require_printable(name, where, f" from the name {quoted(name)}")
    return name


def checked_names(names: Sequence[object], places: Sequence[str]) -> tuple[str, ...]:
    """Check and return the names of all channels, in order.

    Parameters
    ----------
    names : sequence
        One name for each channel.
    places : sequence of str
        The place of each name, for messages.

    Raises
    ------
    InputError
        If a name is invalid, or two channels have names that look the same.
    """
    seen: dict[str, str] = {}
    checked = []
    for name, where in zip(names, places, strict=True):
        good = checked_name(name, where)
        form = unicodedata.normalize("NFC", good)
        if form in seen:
            raise InputError(
                f"expected a name of its own, found {quoted(good)}, which is also {seen[form]}",
                where=where,
            )
        seen[form] = where
        checked.append(good)
    return tuple(checked)


# A strict JSON reader: limits on size and depth, no repeated keys, numbers kept as typed.

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
# Integers of up to this many characters are converted here, longer numbers by the number grammar.
_SHORT = 18
WAIT_FOR_WRITER = 5.0
"""The seconds after which a pipe that no program writes to is refused."""
_BLOCK = 2**20
REMEMBERED = 10_000
"""The number of different numbers that are kept to be recognized when they occur again."""
_MANY = 20
"""From so many known keys on, a message about an unknown one does not list them."""
_LONG = re.compile(rf"[0-9]{{{_SHORT + 1}}}")
_DIGITS = re.compile(r"[0-9]+", re.ASCII)
_ESCAPED_DIGIT = re.compile(r"\\u003([0-9])")


class NumberText(str):
    """The text of a JSON number as it was typed."""

    __slots__ = ()


class _NumberTexts(dict[str, NumberText]):
    """The number texts of one document; a text that occurs again, such as 0.0, is stored once."""

    def __missing__(self, text: str) -> NumberText:
        number = NumberText(text)
        if len(self) < REMEMBERED:
            self[text] = number
        return number


class JsonObject(dict[str, Any]):
    """A JSON object that records the first repeated key."""

    repeated: str | None = None


def read_bytes(path: str | os.PathLike[str], limits: Limits = DEFAULT_LIMITS) -> bytes:
    """Read a file, or standard input for ``-``, up to one byte more than the limit.

    Raises
    ------
    InputError
        If it is missing, unreadable, a folder, too large, or a pipe that no program writes to.
    """
    try:
        if os.fspath(path) == "-":
            if sys.stdin is None:
                raise InputError("cannot be read: standard input is closed")
            data = sys.stdin.buffer.read(limits.bytes + 1)
        elif hasattr(os, "mkfifo") and stat.S_ISFIFO(os.stat(path).st_mode):
            data = _from_pipe(path, limits)
        else:
            with open(path, "rb") as stream:
                status = os.fstat(stream.fileno())
                if stat.S_ISREG(status.st_mode) and status.st_size > limits.bytes:
                    raise _too_large(limits)
                data = stream.read(limits.bytes + 1)
    except FileNotFoundError as error:
        raise InputError("there is no such file") from error
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"is not a file name: {error}") from error
    if len(data) > limits.bytes:
        raise _too_large(limits)
    return data


def _from_pipe(path: str | os.PathLike[str], limits: Limits) -> bytes:
    """Read a named pipe; if no program writes to it, reading would wait forever.

    Raises
    ------
    InputError
        If no program has opened it for writing after some seconds.
    """
    pipe = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    with open(pipe, "rb", buffering=0) as stream:
        end, first = time.monotonic() + WAIT_FOR_WRITER, b""
        # A read returns no bytes while no program has opened the pipe to write, and None until it
        # writes.
        while first is not None and not (first := stream.read(_BLOCK)):
            if time.monotonic() > end:
                raise InputError(
                    f"no program has written to this pipe within {WAIT_FOR_WRITER:g} s: start the "
                    "program that writes to it first, or name a file"
                )
            time.sleep(0.01)
        os.set_blocking(pipe, True)
        blocks = [first or b""]
        while sum(map(len, blocks)) <= limits.bytes and (block := stream.read(_BLOCK)):
            blocks.append(block)
    return b"".join(blocks)


def _advice(text: str, error: json.JSONDecodeError) -> str:
    """Advice about syntax that JSON does not have, recognized by the text where a parser stops."""
    position = error.pos
    if text[position : position + 1] == "/":
        return '; a quotient is a text, "1/3", and there are no comments'
    trailing = text[:position].rstrip()[-1:] == "," and text[position : position + 1] in ("]", "}")
    if trailing or error.msg.startswith("Illegal trailing comma"):  # since Python 3.13
        return "; leave out the comma before the closing bracket"
    return ""


def _too_large(limits: Limits) -> InputError:
    return InputError(f"expected at most {limits.bytes} bytes (Limits.bytes), found more")


def require_start(data: bytes | str, hint: str) -> None:
    """Refuse a text that does not begin as JSON; the hint is about files of other programs.

    Raises
    ------
    InputError
        If the first character that is not blank begins no JSON; an empty file is left to `parse`.
    """
    text = data.encode() if isinstance(data, str) else data
    start = text.lstrip(b" \t\r\n")[:1]
    if start not in (b"", b"{", b"[", _BYTE_ORDER_MARK[:1]) and not _is_scalar(text):
        shown = ascii(start.decode("ascii")) if start.isascii() else f"the byte 0x{start.hex()}"
        raise InputError(f"not JSON: found {shown} at the beginning; {hint}")


def _is_scalar(text: bytes) -> bool:
    """Whether a text is a scalar of JSON, such as null: it is no system, but it is JSON."""
    try:
        json.loads(text.decode("utf-8"), parse_int=str, parse_float=str)
    except (ValueError, RecursionError):
        return False
    return True


def parse(data: bytes | str, limits: Limits = DEFAULT_LIMITS) -> Any:
    """Parse one JSON document.

    Parameters
    ----------
    data : bytes or str
        UTF-8, with or without a byte order mark.
    limits : Limits

    Returns
    -------
    object
        Made of `JsonObject`, list, str, int, `NumberText`, bool and None.  `NumberText` stands for
        every number that is not a short integer, and for NaN and Infinity, which the number grammar
        refuses.

    Raises
    ------
    InputError
        If it is malformed; the message names the line and column, the byte, or the repeated key.
    """
    text = _decoded(data, limits) if isinstance(data, bytes) else data
    if not text.strip(" \t\r\n"):
        raise InputError("expected a JSON object, found an empty file")
    try:
        document = json.loads(
            text,
            # Without long numbers the parser's own conversion is used, which is faster.
            parse_int=_integer if _LONG.search(text) else None,
            parse_float=_NumberTexts().__getitem__,
            parse_constant=NumberText,
            object_pairs_hook=_object,
        )
    except RecursionError:
        raise _too_deep(limits) from None
    except json.JSONDecodeError as error:
        problem = "expected a value" if error.msg == "Expecting value" else error.msg
        place = f"line {error.lineno}, column {error.colno}"
        raise InputError(f"not JSON: {problem} at {place}{_advice(text, error)}") from None
    for depth, level in enumerate(_levels(document), start=1):
        if depth > limits.depth:
            raise _too_deep(limits)
        for container in level:
            if isinstance(container, JsonObject) and container.repeated is not None:
                raise InputError(
                    f"the key {quoted(container.repeated)} is given twice; "
                    "programs would read different values; keep one of them"
                )
    return document


def require_short_numbers(data: bytes | str, limits: Limits = DEFAULT_LIMITS) -> None:
    """Refuse a document with too many digits in a row, in numbers, texts and escapes alike.

    Raises
    ------
    InputError
        If there are more than ``limits.digits``.
    """
    text = data.decode("utf-8") if isinstance(data, bytes) else data
    plain = _ESCAPED_DIGIT.sub(r"\1", text)
    if limits.digits > _SHORT and not _LONG.search(plain):
        return
    if any(len(digits[0]) > limits.digits for digits in _DIGITS.finditer(plain)):
        raise InputError(f"expected at most {limits.digits} digits in a row (Limits.digits)")


def _decoded(data: bytes, limits: Limits) -> str:
    """Decode UTF-8."""
    if len(data) > limits.bytes:
        raise _too_large(limits)
    try:
        return data.removeprefix(_BYTE_ORDER_MARK).decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(
            f"not UTF-8 text: byte {error.start} is 0x{data[error.start]:02x}"
        ) from None


def _integer(text: str) -> int | NumberText:
    return int(text) if len(text) <= _SHORT else NumberText(text)


def _object(pairs: list[tuple[str, Any]]) -> JsonObject:
    result = JsonObject(pairs)
    if len(result) != len(pairs):
        seen: set[str] = set()
        for key, _ in pairs:
            if key in seen:
                result.repeated = key
                break
            seen.add(key)
    return result


def _too_deep(limits: Limits) -> InputError:
    return InputError(f"expected at most {limits.depth} nested levels (Limits.depth), found more")


def _levels(document: Any) -> Iterator[list[Any]]:
    """Yield the containers of each depth, outermost first, without recursion."""
    level = [document] if isinstance(document, (list, dict)) else []
    while level:
        yield level
        level = [
            child
            for container in level
            for child in _children(container)
            if type(child) is list or type(child) is JsonObject
        ]


def _children(container: Any) -> Iterable[Any]:
    """The items of a container, or none if no item is a container."""
    if isinstance(container, dict):
        return container.values()
    return () if {list, JsonObject}.isdisjoint(map(type, container)) else container


def expect_object(
    value: Any, where: str | None, required: Collection[str], optional: Collection[str] = ()
) -> dict[str, Any]:
    """Return a JSON object that has all required keys and no unknown one.

    Raises
    ------
    InputError
        If a key is missing or unknown; the message names it, and the nearest known key.
    """
    if not isinstance(value, dict):
        raise InputError(f"expected a JSON object, found {kind_of(value)}", where=where)
    known = [*required, *optional]
    for key in value:
        if key not in known:
            listed = f"; known are {', '.join(map(quoted, known))}" if len(known) < _MANY else ""
            hint = nearest(key, known) or listed
            raise InputError(f"unknown key {quoted(key)}{hint}", where=where)
    for key in required:
        if key not in value:
            raise InputError(f"the key {quoted(key)} is missing", where=where)
    return value


def expect_list(value: Any, where: str) -> list[Any]:
    """Return a JSON list.

    Raises
    ------
    InputError
        If the value is anything else; the error names the place and what was found there.
    """
    if not isinstance(value, list):
        raise InputError(f"expected a list, found {kind_of(value)}", where=where)
    return value


def expect_integer(value: Any, where: str) -> int:
    """Return a nonnegative integer.

    Raises
    ------
    InputError
        If the value is negative, or is no integer; true and false are not integers here, although
        Python's Booleans are.
    """
    if isinstance(value, NumberText) and _DIGITS.fullmatch(value):
        return int(Decimal(value))  # however long it is
    if type(value) is not int or value < 0:
        shown = str(value)[:40] if isinstance(value, (int, NumberText)) else kind_of(value)
        raise InputError(f"expected an integer >= 0, found {shown}", where=where)
    return value


def shown_integer(value: int) -> str:
    """An integer as a message shows it.

    Examples
    --------
    >>> shown_integer(12), shown_integer(10**40)
    ('12', 'a large integer')
    """
    return str(value) if value.bit_length() < 100 else "a large integer"


def expect_string(value: Any, where: str, what: str = "a string") -> str:
    """Return a JSON string.

    Raises
    ------
    InputError
        If the value is anything else; a number is no string, although its text is kept as typed.
    """
    if not isinstance(value, str) or isinstance(value, NumberText):
        raise InputError(f"expected {what}, found {kind_of(value)}", where=where)
    return value


def expect_name(value: Any, where: str) -> str:
    """Return a JSON string that should be the name of a channel or agent.

    Raises
    ------
    InputError
        If the value is no string.
    """
    return expect_string(value, where, 'a name as a string, such as "1"')


def expect_format(document: Any, expected: str) -> dict[str, Any]:
    """Return a document whose key ``format`` is the expected one.

    Raises
    ------
    OtherFormat
        If the file has another format, which the message names.
    InputError
        If the key is missing, or the version is unknown.
    """
    if not isinstance(document, dict):
        raise OtherFormat(
            f'expected a JSON object with "format": "{expected}", found {kind_of(document)}'
        )
    actual = document.get("format")
    if actual == expected:
        return document
    if actual is None:
        raise OtherFormat(f'the key \'format\' is missing; expected "format": "{expected}"')
    wanted = _KINDS.get(expected.partition("/")[0], "another file")
    if isinstance(actual, str):
        stem = actual.partition("/")[0]
        if stem == expected.partition("/")[0]:
            raise InputError(
                f'expected "{expected}", found version {quoted(actual)}, '
                "which this program does not know",
                where="format",
            )
        if stem in _KINDS:
            raise OtherFormat(f"expected {wanted}, found {_KINDS[stem]}", where="format")
    raise OtherFormat(f'expected "{expected}", found {quoted(actual)}', where="format")


_KINDS = {
    "mcexact-system": "a system file",
    "mcexact-controller": "a controller file",
    "mcexact-certificate": "a certificate",
}


def kind_of(value: Any) -> str:
    """Name the type of a JSON value, for a message.

    Examples
    --------
    >>> kind_of([1]), kind_of("a"), kind_of(None)
    ('a list', "the string 'a'", 'null')
    """
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, NumberText)):
        return "a number"
    if isinstance(value, str):
        return f"the string {quoted(value)}"
    return "a list" if isinstance(value, list) else "an object"


# Exact objects as plain JSON data, the canonical JSON text of plain data, and its digest.

Document = Mapping[str, Any]
"""A JSON object made of plain data."""


def plain(value: Any) -> Any:
    """Turn exact objects into the plain data of a JSON document.

    Parameters
    ----------
    value : object
        None, a bool, an int, a string, a Fraction, a matrix, a polynomial matrix, a polynomial,
        something with a ``document()``, or a mapping or sequence of such.

    Returns
    -------
    object
        Made of dict, list, str, int, bool and None.

    Raises
    ------
    TypeError
        If the value has no exact form, as a float has none.

    Examples
    --------
    >>> plain({"half": Fraction(1, 2), "channels": ("1", "2")})
    {'half': '1/2', 'channels': ['1', '2']}
    >>> plain(0.5)
    Traceback (most recent call last):
        ...
    TypeError: a certificate holds exact data only, found float
    """
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, Fraction):
        return written(value)
    if isinstance(value, Polynomial):
        return value.as_json()
    if isinstance(value, Matrix):
        return {"denominator": value.denominator, "entries": _integers(value.numerators)}
    if isinstance(value, PolynomialMatrix):
        layers = [_integers(layer) for layer in value.coefficients]
        return {"denominator": value.denominator, "coefficients": layers}
    if hasattr(value, "document"):
        return plain(value.document())
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return [plain(item) for item in value]
    raise TypeError(f"a certificate holds exact data only, found {type(value).__name__}")


def _integers(rows: Sequence[Sequence[int]]) -> list[list[int]]:
    """Copy rows of integers as lists."""
    return [list(map(int, row)) for row in rows]


@contextmanager
def numbers_of_any_length() -> Iterator[None]:
    """Let the interpreter convert longer integers than it does by default."""
    digits = sys.get_int_max_str_digits()
    try:
        sys.set_int_max_str_digits(0)
        yield
    finally:
        sys.set_int_max_str_digits(digits)


def canonical(value: Any) -> str:
    """Return the canonical JSON text: sorted keys, no blanks, non-ASCII characters escaped.

    Examples
    --------
    >>> print(canonical({"b": [1, 2], "a": "é"}))
    {"a":"\\u00e9","b":[1,2]}
    """
    with numbers_of_any_length():
        return json.dumps(
            value, sort_keys=True, separators=(",", ":"), ensure_ascii=True, check_circular=False
        )


def text_of(value: Any) -> str:
    """Return the canonical JSON text of exact objects."""
    return canonical(plain(value))


def sha256(text: str | bytes) -> str:
    """Return the SHA-256 of ASCII text, or of bytes, in lower-case hexadecimal."""
    return hashlib.sha256(text.encode("ascii") if isinstance(text, str) else text).hexdigest()


# Write a file completely or not at all.


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text to a file under a temporary name that is then renamed.

    Parameters
    ----------
    path : path
        If this is a symbolic link, the file that it points to is replaced.  A path that is not a
        regular file, such as ``/dev/stdout``, is opened and written to.
    text : str

    Raises
    ------
    NotWritten
        If the folder is missing or cannot be written.
    InputError
        If the path is no name of a file.
    """
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | os.PathLike[str], data: bytes) -> None:
    """Write bytes to a file as `write_text` writes a text.

    Raises
    ------
    NotWritten
        If the folder is missing or cannot be written.
    InputError
        If the path is no name of a file.
    """
    place = place_of(path)
    try:
        target = Path(os.path.realpath(path))
        # For a stream, the target of the link is not a name that can be opened.
        if os.path.exists(path) and not os.path.isfile(path):
            with open(path, "wb") as stream:
                stream.write(data)
            return
        _replace(target, data)
    except OSError as error:
        raise NotWritten(f"cannot write: {error.strerror or error}", where=place) from error
    except ValueError as error:
        raise InputError(f"is not a file name: {error}", where=repr(path)) from error


def _replace(target: Path, data: bytes) -> None:
    """Write a temporary file beside the target, then rename it."""
    handle, temporary = tempfile.mkstemp(prefix=".mcexact-", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
        if target.exists():
            mode = target.stat().st_mode & 0o777
        else:
            # mkstemp makes files private; this file should be as readable as other new files.
            mask = os.umask(0)
            os.umask(mask)
            mode = 0o666 & ~mask
        os.chmod(temporary, mode)
        os.replace(temporary, target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
