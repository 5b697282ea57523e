"""How values are written in a statement, from the tables of ``FORMAT.md``."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly

from .reading import decimal, listed, polynomial, record

SHORT = 80
ESCAPES = {8: "\\b", 12: "\\f", 10: "\\n", 13: "\\r", 9: "\\t", 34: '\\"', 92: "\\\\"}


def sha256(text: str) -> str:
    """The digest of a text of ASCII."""
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def name(text: str) -> str:
    """A JSON string in which only printing ASCII stands for itself."""
    found = []
    for character in text:
        code = ord(character)
        if code in ESCAPES:
            found.append(ESCAPES[code])
        elif 0x20 <= code <= 0x7E:
            found.append(character)
        else:
            units = character.encode("utf-16-be", "surrogatepass").hex()
            found += [f"\\u{units[k : k + 4]}" for k in range(0, len(units), 4)]
    return f'"{"".join(found)}"'


def json_text(value: Any) -> str:
    """JSON with sorted keys, no blanks and escapes; a rational of python-flint is a number."""
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    if isinstance(value, str):
        return name(value)
    if isinstance(value, dict):
        return "{" + ",".join(f"{name(k)}:{json_text(value[k])}" for k in sorted(value)) + "}"
    if isinstance(value, list | tuple):
        return "[" + ",".join(map(json_text, value)) + "]"
    if isinstance(value, fmpq_mat):
        return json_text(value.tolist())
    return number(value) if isinstance(value, int) or value.q == 1 else f'"{number(value)}"'


def number(value: Any) -> str:
    """p, or p/q in lowest terms."""
    value = fmpq(value)
    return f"{value.p}" if value.q == 1 else f"{value.p}/{value.q}"


def by_channel(names: Sequence[str], values: Iterable[Any]) -> str:
    """A JSON object with a value for each channel."""
    return json_text(dict(zip(names, values, strict=True)))


def digested(value: Any) -> str:
    """The digest of a value, and the value itself where it is short."""
    text = json_text(value)
    shown = f" = {text}" if len(text) <= SHORT else ""
    return f"SHA-256 {sha256(text)}{shown}"


def channels(names: Iterable[str]) -> str:
    """A set of channels."""
    return "{" + ", ".join(map(name, names)) + "}"


def edges(pairs: Iterable[Sequence[Any]]) -> str:
    """A set of edges; those of three entries have a cost."""
    return (
        "{"
        + ", ".join(
            f"{name(j)} -> {name(i)}" + "".join(f": {number(c)}" for c in cost)
            for j, i, *cost in pairs
        )
        + "}"
    )


def polynomial_text(value: Any, variable: str = "x") -> str:
    """Powers descending."""
    p = value if isinstance(value, fmpq_poly) else polynomial(value)
    terms = []
    for k in reversed(range(len(p.coeffs()))):
        c = p[k]
        if c == 0:
            continue
        size = abs(c) if c >= 0 else -c
        power = "" if k == 0 else variable if k == 1 else f"{variable}^{k}"
        factor = number(size) if k == 0 or size != 1 else ""
        term = "*".join(part for part in (factor, power) if part)
        sign = ("-" if c < 0 else "") if not terms else (" - " if c < 0 else " + ")
        terms.append(sign + term)
    return "".join(terms) or "0"


def discs(value: Any) -> str:
    """Centers and radii, sorted."""
    parts = []
    for entry in listed(value):
        found = record(entry, "re", "im", "radius")
        parts.append(tuple(decimal(found[key]) for key in ("re", "im", "radius")))
    shown = []
    for re, im, radius in sorted(parts):
        turned = "" if im == 0 else f" {'-' if im < 0 else '+'} {number(-im if im < 0 else im)}i"
        shown.append(f"{number(re)}{turned} +- {number(radius)}")
    return "{" + ", ".join(shown) + "}"
