"""Exact objects as plain JSON data, the canonical JSON text of plain data, and its digest."""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.rational import written

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
