"""Statements in words: polynomials, sets of channels and systems as a theorem names them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from .arithmetic import Polynomial
from .system import System

RATE = {"continuous": "best decay rate", "discrete": "best spectral radius"}
STABILIZABLE = {
    True: "stabilizable by decentralized control",
    False: "not stabilizable by decentralized control",
}
PLAIN_NAME = re.compile(r"[\w.+-]{1,256}")


def channel(system: System, i: int) -> str:
    """The name of a channel; in quotes and escaped unless it is a plain word."""
    name = system.names[i]
    return name if PLAIN_NAME.fullmatch(name) and name.isprintable() else json.dumps(name)


def channel_set(system: System, channels: Iterable[int]) -> str:
    """A set of channels, such as {1, 3}."""
    return "{" + ", ".join(channel(system, i) for i in channels) + "}"


def polynomial_text(p: Polynomial) -> str:
    """A polynomial, highest power first, such as x^2 - 3/2*x + 1."""
    terms = []
    for k, c in reversed(list(enumerate(map(Fraction, p)))):
        if c:
            power = "" if k == 0 else "x" if k == 1 else f"x^{k}"
            size = str(abs(c)) if abs(c) != 1 or not power else ""
            terms += ["-" if c < 0 else "+", size + ("*" if size and power else "") + power]
    sign = "-" if terms and terms[0] == "-" else ""
    return sign + " ".join(terms[1:]) if terms else "0"


def factor_text(
    p: Polynomial, a: int, e: int, r: int, s: str, stable: bool, discs: list[Any]
) -> str:
    """What is proved of one factor of a fixed spectrum."""
    roots = []
    for real, im, radius in discs:
        imaginary = f" {'-' if im < 0 else '+'} {abs(im)}i" if im else ""
        roots.append(f"{real}{imaginary} +- {radius}")
    return (
        f"{polynomial_text(p)} (exponent {a} in det(xI - A), at most {e} in the gcd of all "
        f"det(xI - A_F); least pencil rank {r}, reached by the channels {s}; "
        f"{'stable' if stable else 'not stable'}; roots {', '.join(roots)})"
    )


def described(system: System) -> str:
    """The system a claim is about: what it was made from, its size, its time."""
    sizes = f"{counted(system.n, 'state')}, {counted(system.m, 'channel')}"
    return f"{system.words} ({system.time} time, {sizes})"


def counted(number: int, noun: str) -> str:
    """A number of things, such as 1 state or 2 states."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
