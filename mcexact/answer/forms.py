"""The forms of the fields of sentences: numbers, modes, channels, rates, shared dimensions."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.formats import (
    channels,
    count,
    cut,
    decimal_number,
    edges,
    listed,
    modes,
    name_set,
    name_text,
    number,
    polynomial,
    rounded,
)
from mcexact.answer.latex import escaped
from mcexact.exact.enclosures import exact_decimal
from mcexact.exact.location import TIMES, StabilityRegion, is_discrete
from mcexact.exact.polynomial import Polynomial

_INTEGER = r"\d+"
_DECIMAL = r"(?:-?\d+(?:\.\d+)?|about -?\d(?:\.\d+)?e[+-]\d+|about -?\d+(?:\.\d+)?)"
_NUMBER = rf"(?:-?\d+/\d+|{_DECIMAL})"
_COEFFICIENT = rf"(?:\({_NUMBER}\)|{_NUMBER})"
_POWER = r"x(?:\^\d+)?"
_TERM = rf"(?:{_COEFFICIENT}(?:\*{_POWER})?|{_POWER}|…)"
_POLYNOMIAL = rf"-?{_TERM}(?: [+-] {_TERM})*(?: \(degree \d+\))?"
_NAME = r"[^,{}|\n]+?"
_NAMES = rf"{_NAME}(?:, {_NAME})*"
_MODES = rf"(?:the mode {_NUMBER}|the \d+ roots of {_POLYNOMIAL})"
_SET = rf"\{{(?:{_NAMES})?\}}"
_MORE = r"(?:, \d+ more)?"
_REAL = r"-?\d+(?:\.\d+)?(?:e[+-]\d+)?"
_ROOT = rf"{_REAL}(?: ± {_REAL}i)?"
_ROW = rf"\({_NUMBER}(?:, {_NUMBER})*\)"
_ARROW = rf"{_NAME} → {_NAME}"
_SHARE = rf"\d+ states? by agent {_NAME}"


@dataclass(frozen=True)
class Form:
    """A form of template fields: a function that writes values, and a pattern of its results."""

    write: Callable[[Any], str]
    pattern: str


def choice(**words: str) -> Form:
    """A form with a few phrases, each of which has a keyword."""
    return Form(words.__getitem__, "(?:" + "|".join(map(re.escape, words.values())) + ")")


_TIMES = {1: "once", 2: "twice", 3: "three times"}


def _often(multiplicities: tuple[int, int]) -> str:
    """Write the multiplicity of a mode in A, and how many of its eigenvalues are fixed at most."""
    times, stuck = multiplicities
    often = f"{_TIMES.get(times, f'{times} times')} in A"
    if stuck == times:
        return often
    return often + (", of which one stays" if stuck == 1 else f", of which at most {stuck} stay")


def _behavior(slowest: tuple[str, str, str, bool]) -> str:
    """Write the behavior of the slowest fixed mode, from time domain, rate enclosure and stability.

    The enclosure may contain the boundary although the mode does not lie on it.
    """
    time, low, high, stable = slowest
    lower, upper = exact_decimal(low), exact_decimal(high)
    limit = 24 if low == high else 0  # an end of an enclosure is rounded, and the text says "about"
    if is_discrete(time):
        if upper < 1 or lower > 1:
            end = high if upper < 1 else low
            return f"becomes {decimal_number(end, limit)} times as large in each step"
    elif lower > 0:
        return f"decays at the rate {decimal_number(low, limit)}"
    elif upper < 0:
        return f"grows at the rate {decimal_number(high.removeprefix('-'), limit)}"
    return "decays very slowly" if stable else "does not decay"


def _roots(centers: Sequence[tuple[Fraction, Fraction]]) -> str:
    """Write centers of root discs with six digits, conjugate pairs as one; of many the first."""
    told = [
        rounded(re) if not im else f"{rounded(re)} ± {rounded(im)}i"
        for re, im in centers
        if im >= 0
    ]
    return ", ".join(cut(told, 6))


def _blocks(blocks: Sequence[tuple[int, Sequence[str]]]) -> str:
    """Write the degrees of the parts, without those of degree 0; of many the first few."""
    return ", ".join(cut([f"{size} by {name_set(names, 6)}" for size, names in blocks if size], 8))


def _components(components: Sequence[Sequence[str]]) -> str:
    """Write sets of channels, those with more than one first; of many the first few."""
    ordered = sorted(components, key=len, reverse=True)
    return " ".join(cut([name_set(names, 6) for names in ordered], 8))


def _indices(numbers: Sequence[int]) -> str:
    return ", ".join(cut([str(k) for k in numbers], 15)) or "none"


def _shared(sizes: Sequence[tuple[str, int]]) -> str:
    """Write the number of states that each agent shares, without agents that share none."""
    told = [f"{count(size, 'state')} by agent {name_text(name)}" for name, size in sizes if size]
    return ", ".join(cut(told, 11, "by {} more agents"))


def _scope(counted: tuple[str, Fraction | None, bool]) -> str:
    """Write which modes are not fixed, from the time domain, the region, and assignability."""
    time, bound, free = counted
    which = "no mode"
    if bound is not None:
        region = StabilityRegion.of(time, bound=bound)
        which += f" with {region.measure} ≥ {number(region.limit)}"
    return f"{which} is fixed" + (" and the whole spectrum can be assigned" if free else "")


def _carried(sent: tuple[str, Sequence[int] | None]) -> str:
    """Write which signals a link carries, with the dimensions of shared states."""
    share, sizes = sent
    if sizes is None:
        return "outputs"
    states = f"states (dimensions {listed([str(size) for size in sizes])})"
    return f"outputs and {states}" if share == "outputs+states" else states


def _agents(names: Sequence[str]) -> str:
    """Name agents as a phrase."""
    return channels(names).replace("channel", "agent", 1) if names else "no agents"


def _dimensions(sizes: Sequence[tuple[str, int]]) -> str:
    """Write the number of states that each agent shares, including agents that share none."""
    return ", ".join(cut([f"{name_text(name)}: {size}" for name, size in sizes], 12))


def _region(region: StabilityRegion) -> str:
    """Write the region of eigenvalues, such as Re λ < -1."""
    return f"{region.measure} < {number(region.limit)}"


def _combinations(rows: Sequence[Sequence[Fraction]]) -> str:
    """Write combinations of set-points that no equilibrium has."""
    told = ["(" + ", ".join(number(Fraction(x)) for x in row) + ") r ≠ 0" for row in rows]
    return " or ".join(told)


def _arrows(edges: Sequence[tuple[str, str]]) -> str:
    """Write every edge of a graph, as text that replaces a picture."""
    told = [f"{name_text(start)} → {name_text(end)}" for start, end in edges]
    return ", ".join(cut(told, 40)) or "none"


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


FORMS: dict[str, Form] = {
    "int": Form(str, _INTEGER),
    "name": Form(name_text, _NAME),
    "number": Form(number, _NUMBER),
    "decimal": Form(decimal_number, _DECIMAL),
    "polynomial": Form(polynomial, _POLYNOMIAL),
    "modes": Form(modes, _MODES),
    "channels": Form(channels, rf"(?:channel {_NAME}|channels (?:{_NAMES} and )?{_NAME})"),
    "set": Form(name_set, _SET),
    "edges": Form(edges, rf"(?:no edges|\d+ edges|{_NAME} -> {_NAME}(?:, {_NAME} -> {_NAME})*)"),
    "yes": Form(lambda value: "yes" if value else "no", "(?:yes|no)"),
    "time": choice(**{time: time for time in TIMES}),
    "control": choice(
        own="linear time-invariant decentralized control",
        outputs="linear time-invariant control by the outputs of all neighbors",
        instant="linear time-invariant control by the outputs of all neighbors without delay",
    ),
    "information": choice(
        own="each agent feeds back its own output",
        outputs="each agent feeds back the outputs of all its neighbors",
        instant="each agent feeds back the outputs of all its neighbors, received without delay",
    ),
    "often": Form(
        _often,
        r"(?:once|twice|three times|\d+ times) in A(?:, of which (?:one stays|at most \d+ stay))?",
    ),
    "behavior": Form(
        _behavior,
        rf"(?:(?:decays|grows) at the rate {_DECIMAL}"
        rf"|becomes {_DECIMAL} times as large in each step|decays very slowly|does not decay)",
    ),
    "Modes": Form(lambda p: _capital(modes(p, 60)), _MODES.replace("the", "The")),
    "are": Form(lambda p: "is" if _single(p) else "are", "(?:is|are)"),
    "them": Form(lambda p: "it" if _single(p) else "them", "(?:it|them)"),
    "escape": Form(
        lambda p: "which does not satisfy" if _single(p) else "which do not all satisfy",
        "which (?:does not|do not all) satisfy",
    ),
    "lack": Form(lambda names: "lacks" if len(names) == 1 else "lack", "lacks?"),
    "unstable": Form(
        lambda p: "it is not stable" if _single(p) else "not all of them are stable",
        "(?:it is not|not all of them are) stable",
    ),
    "price": choice(least="least", cheapest="cheapest"),
    "links": choice(least="the fewest links", cheapest="the cheapest links"),
    "limits": choice(none="", upper=", within the upper limits"),
    "instant": choice(none="", delays=", if messages took no time"),
    "slow": Form(
        lambda p: "it is not fast enough" if _single(p) else "not all of them are fast enough",
        "(?:it is not|not all of them are) fast enough",
    ),
    "do": Form(lambda names: "does" if len(names) == 1 else "do", "(?:does|do)"),
    "roots": Form(_roots, rf"{_ROOT}(?:, {_ROOT})*{_MORE}"),
    "blocks": Form(_blocks, rf"\d+ by {_SET}(?:, \d+ by {_SET})*{_MORE}"),
    "components": Form(_components, rf"{_SET}(?: {_SET})*(?: \d+ more)?"),
    "indices": Form(_indices, rf"(?:none|\d+(?:, \d+)*){_MORE}"),
    "factors": Form(
        lambda found: ", ".join(cut([polynomial(p, 30) for p in found], 6)),
        rf"{_POLYNOMIAL}(?:, {_POLYNOMIAL})*{_MORE}",
    ),
    "side": choice(controllable="controllable", observable="observable"),
    "reached": Form(
        lambda indices: ", ".join(cut([" and ".join(map(str, pair)) for pair in indices], 8)),
        rf"\d+(?: and \d+)?(?:, \d+(?: and \d+)?)*{_MORE}",
    ),
    "arrows": Form(_arrows, rf"(?:none|{_ARROW}(?:, {_ARROW})*{_MORE})"),
    "receive": Form(lambda names: "receives" if len(names) == 1 else "receive", "receives?"),
    "list": Form(
        lambda sizes: listed([str(size) for size in sizes]), r"\d+(?:, \d+)*(?: and \d+)?"
    ),
    "names": Form(
        lambda names: ", ".join(cut([name_text(name) for name in names], 8)) or "nobody",
        rf"{_NAME}(?:, {_NAME})*{_MORE}",
    ),
    "agents": Form(
        _agents,
        rf"(?:no agents|agent {_NAME}|agents (?:{_NAME}(?:, {_NAME})* and )?{_NAME})",
    ),
    "dimensions": Form(_dimensions, rf"{_NAME}: \d+(?:, {_NAME}: \d+)*{_MORE}"),
    "region": Form(_region, rf"(?:Re λ < {_NUMBER}|\|λ\| < {_NUMBER})"),
    "combinations": Form(_combinations, rf"{_ROW} r ≠ 0(?: or {_ROW} r ≠ 0)*"),
    "network": choice(
        decentralized="decentralized",
        extended="distributed, through shared states,",
        lifted="distributed, through shared states with delays,",
        held="distributed, through shared states held for the delays,",
    ),
    "method": choice(observer="by an observer", extended="through shared states"),
    "decided": choice(
        polynomial="by the characteristic polynomial",
        lyapunov="by Lyapunov matrices",
        instability="by a quadratic form that decreases and is not positive",
    ),
    "latex": Form(Polynomial.latex, r"[-+ x0-9^{}a-z\\]+"),
    "latex_names": Form(lambda names: ", ".join(map(escaped, names)), r"[^\n]*"),
    "share": choice(**{"outputs+states": "beside outputs", "states": "without outputs"}),
    "carried": Form(
        _carried, r"(?:outputs|(?:outputs and )?states \(dimensions \d+(?:, \d+)*(?: and \d+)?\))"
    ),
    "scope": Form(
        _scope,
        rf"no mode(?: with (?:Re λ|\|λ\|) ≥ {_NUMBER})? is fixed"
        r"(?: and the whole spectrum can be assigned)?",
    ),
    "shared": Form(_shared, rf"{_SHARE}(?:, {_SHARE})*(?:, by \d+ more agents)?"),
}


def _single(p: Polynomial) -> bool:
    return p.degree == 1


def form(spec: str) -> Form:
    """Return the form that a field names: one of `FORMS`, or ``count noun``."""
    if spec.startswith("count "):
        noun = spec.removeprefix("count ")
        return Form(lambda size: count(size, noun), rf"(?:1 {noun}|\d+ {noun}s)")
    return FORMS[spec]
