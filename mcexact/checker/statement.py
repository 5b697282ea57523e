"""The words of statements: systems, sets, polynomials, and values as canonical JSON.

``FORMAT.md`` specifies them.  A name always stands in quotes, so that none can imitate words.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Protocol

from . import budget
from .arithmetic import Matrix, Polynomial
from .system import System, canonical
from .system_matrices import rows_of

FIXED = "fixed under linear time-invariant decentralized control"
PENCIL = "[xI - A, B; C, 0]"
SHORT = 80
"""The longest text of a matrix or a controller that is written out beside its digest."""


def canonical_json(value: Any) -> str:
    """A value as JSON: sorted keys, no blanks, ASCII; a matrix as its rows in lowest terms."""

    def plain(part: Any) -> Any:
        if isinstance(part, Matrix):
            return rows_of(part)
        return part.numerator if part.denominator == 1 else str(part)

    text = json.dumps(value, sort_keys=True, separators=(",", ":"), default=plain)
    budget.spend(len(text))
    return text


def digest_of(text: str) -> str:
    """The SHA-256 of an ASCII text, in lower-case hexadecimal."""
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def digest(system: System) -> str:
    """The SHA-256 of the canonical object of a plant."""
    return digest_of(canonical_json(canonical(system)))


def with_digest(text: str) -> str:
    """The digest of the JSON of matrices or of a controller, and this itself where it is short."""
    return f"SHA-256 {digest_of(text)}" + (f" = {text}" if len(text) <= SHORT else "")


def by_channel(system: System, values: Iterable[Any]) -> dict[str, Any]:
    """One value for each channel, by the names of the channels."""
    return dict(zip(system.names, values, strict=True))


def quoted(name: str) -> str:
    """A name, which can hold no more than its quotes."""
    budget.spend(100 + 6 * len(name))
    return json.dumps(name)


def channel_set(names: Iterable[str]) -> str:
    """A set of channels by name, such as {"1", "3"}."""
    return "{" + ", ".join(map(quoted, names)) + "}"


def edge_set(edges: Iterable[Any]) -> str:
    """A set of edges [from, to], perhaps with a cost, such as {"1" -> "2", "2" -> "1"}."""
    ends = [(f"{quoted(j)} -> {quoted(i)}", cost) for j, i, *cost in edges]
    return "{" + ", ".join(": ".join([edge, *map(str, cost)]) for edge, cost in ends) + "}"


def polynomial_text(p: Polynomial, x: str = "x") -> str:
    """A polynomial in x, highest power first, such as x^2 - 3/2*x + 1."""
    terms, p = [], [Fraction(c) for c in p]
    budget.spend(budget.fractions(len(p), budget.limbs_of(p)))
    for k, c in reversed(list(enumerate(p))):
        if c:
            power = "" if k == 0 else x if k == 1 else f"{x}^{k}"
            size = str(abs(c)) if abs(c) != 1 or not power else ""
            terms += ["-" if c < 0 else "+", size + ("*" if size and power else "") + power]
    sign = "-" if terms and terms[0] == "-" else ""
    return sign + " ".join(terms[1:]) if terms else "0"


def denied(holds: bool) -> str:
    """The word that denies what follows where it does not hold."""
    return "" if holds else "not "


def counted(number: int, noun: str) -> str:
    """A number of things, such as 1 state or 2 states."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


# Systems: the plant by its digest, and constructions before or behind what they are applied to.


def prefixed(
    words: str, system: System, blocks: tuple[int, ...] = (), ports: str = "", **parts: Any
) -> System:
    """The system with these parts that a construction makes, named before what it is made from."""
    named = f"{words} of: {system.words}"
    return replace(system, words=named, blocks=blocks, ports=ports, **parts)


def suffixed(system: System, words: str, **parts: Any) -> System:
    """The same, named behind what it is made from.

    What begins with a construction stands in parentheses, so that the text parses in one way only.
    """
    alone = system.words.startswith(("the plant", "("))
    before = system.words if alone else f"({system.words})"
    return replace(system, words=f"{before} {words}", blocks=(), ports="", **parts)


class Described(Protocol):
    """What a statement says of a system, of numbers or of functions."""

    @property
    def n(self) -> int: ...
    @property
    def m(self) -> int: ...
    @property
    def names(self) -> Sequence[str]: ...
    @property
    def time(self) -> str: ...
    @property
    def words(self) -> str: ...
    @property
    def ports(self) -> str: ...


def described(system: Described) -> str:
    """The system a claim is about: what it was made from, its states, its channels, its time."""
    channels = f"channels {channel_set(system.names)}" if system.m else "no channels"
    told = f"{counted(system.n, 'state')}, {system.ports or channels}, {system.time} time"
    return f"{system.words} ({told})"
