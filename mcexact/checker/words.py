"""Statements in words: polynomials, sets of channels and systems as a theorem names them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from fractions import Fraction

from . import budget
from .arithmetic import Polynomial
from .budget import spend
from .system import System

SLOWEST = {
    "continuous": "minus the largest real part of a fixed mode",
    "discrete": "the largest modulus of a fixed mode",
}
STABILIZABLE = {
    True: "stabilizable by linear time-invariant decentralized control",
    False: "not stabilizable by linear time-invariant decentralized control",
}
PLAIN_NAME = re.compile(r"[\w.+-]{1,256}")


def channel(system: System, i: int) -> str:
    """The name of a channel; in quotes and escaped unless it is a plain word."""
    name = system.names[i]
    spend(100 + len(name))
    return name if PLAIN_NAME.fullmatch(name) and name.isprintable() else json.dumps(name)


def channel_set(system: System, channels: Iterable[int]) -> str:
    """A set of channels, such as {1, 3}."""
    return "{" + ", ".join(channel(system, i) for i in channels) + "}"


def polynomial_text(p: Polynomial) -> str:
    """A polynomial, highest power first, such as x^2 - 3/2*x + 1."""
    terms, p = [], [Fraction(c) for c in p]
    spend(budget.fractions(len(p), budget.limbs_of(p)))
    for k, c in reversed(list(enumerate(p))):
        if c:
            power = "" if k == 0 else "x" if k == 1 else f"x^{k}"
            size = str(abs(c)) if abs(c) != 1 or not power else ""
            terms += ["-" if c < 0 else "+", size + ("*" if size and power else "") + power]
    sign = "-" if terms and terms[0] == "-" else ""
    return sign + " ".join(terms[1:]) if terms else "0"


def described(system: System) -> str:
    """The system a claim is about: what it was made from, its size, its time."""
    sizes = f"{counted(system.n, 'state')}, {counted(system.m, 'channel')}"
    return f"{system.words} ({system.time} time, {sizes})"


def counted(number: int, noun: str) -> str:
    """A number of things, such as 1 state or 2 states."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
