"""The forms of the fields of sentences: numbers, modes, channels, rates, shared dimensions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from mcexact.answer.formats import (
    channels,
    count,
    cut,
    edges,
    listed,
    modes,
    name_set,
    name_text,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import (
    decimal_number,
    number,
    percent,
    polynomial,
    rounded,
    three_digits,
)
from mcexact.exact.roots import TIMES, StabilityRegion, exact_decimal, is_discrete
from mcexact.shown import escaped

Write = Callable[[Any], str]


def choice(**words: str) -> Write:
    """A form with a few phrases, each of which has a keyword."""
    return words.__getitem__


def _agreeing(one: str, more: str) -> Write:
    """A form that agrees with the number of the roots of a polynomial, or of names."""

    def write(value: Any) -> str:
        size = value.degree if isinstance(value, Polynomial) else len(value)
        return one if size == 1 else more

    return write


_TIMES = {1: "once", 2: "twice", 3: "three times"}


def _often(multiplicities: tuple[int | None, int]) -> str:
    """Write the multiplicity of a mode in A, and how many of its eigenvalues are fixed at most."""
    times, stuck = multiplicities
    often = "at least once in A"
    if times is not None:
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


def _reached(found: Sequence[Sequence[int]]) -> str:
    """Write the least lengths k with which each channel reaches all states."""
    single = len(found) == 1 and len(found[0]) == 1
    listed_pairs = cut([" and ".join(map(str, k)) for k in found], 8)
    return f"{'index' if single else 'indices'} {', '.join(listed_pairs)}"


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


def _sides(sides: tuple[Sequence[str], Sequence[str]]) -> str:
    """Write which channels do not control some modes, and which others do not observe them."""
    verbs = [verb for verb, names in zip(("control", "observe"), sides, strict=True) if names]
    if len(verbs) == 1:
        return f"all channels together do not {verbs[0]}"
    do = _agreeing("does", "do")
    told = [
        f"{channels(names)} {do(names)} not {verb}"
        for names, verb in zip(sides, verbs, strict=True)
    ]
    return " and ".join(told)


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
    return listed([f"{compared} {number(limit)}" for compared, limit in region.bounds()])


def _combinations(rows: Sequence[Sequence[Fraction]]) -> str:
    """Write combinations of set-points that no equilibrium has."""
    told = ["(" + ", ".join(number(Fraction(x)) for x in row) + ") r ≠ 0" for row in rows]
    return " or ".join(told)


def _gains(part: Fraction | None) -> str:
    """Write by how much gains may differ, and to how many digits they may be rounded then."""
    if part is None:
        return ""
    digits = 1
    while Fraction(10) ** (1 - digits) > part:
        digits += 1
    rounding = f"{count(digits, 'digit')}, however rounded"
    return f", with all gains within {percent(part)} of their values ({rounding})"


def _arrows(edges: Sequence[tuple[str, str]]) -> str:
    """Write every edge of a graph, as text that replaces a picture."""
    told = [f"{name_text(start)} → {name_text(end)}" for start, end in edges]
    return ", ".join(cut(told, 40)) or "none"


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _lost(edges: Sequence[tuple[tuple[str, str], Sequence[str]]]) -> str:
    """Write at which values which edges vanish."""
    told = [
        f"{name_text(start)} -> {name_text(end)} vanishes where {_values(where)}"
        for (start, end), where in edges
    ]
    return "; ".join(cut(told, 12))


def _values(where: Sequence[str]) -> str:
    """Write conditions on parameters."""
    return " or ".join(cut(where, 8))


FORMS: dict[str, Write] = {
    "int": str,
    "int or open": lambda value: "open" if value is None else str(value),
    "name": name_text,
    "number": number,
    "decimal": decimal_number,
    "polynomial": polynomial,
    "modes": modes,
    "channels": channels,
    "set": name_set,
    "edges": edges,
    "yes": lambda value: "yes" if value else "no",
    "time": choice(**{time: time for time in TIMES}),
    "control": choice(
        own="linear time-invariant decentralized control",
        alone="linear time-invariant decentralized control without communication",
        outputs="linear time-invariant control by the outputs of all neighbors",
        instant="linear time-invariant control by the outputs of all neighbors without delay",
    ),
    "information": choice(
        own="each agent feeds back its own output",
        outputs="each agent feeds back the outputs of all its neighbors",
        instant="each agent feeds back the outputs of all its neighbors, received without delay",
    ),
    "often": _often,
    "behavior": _behavior,
    "Modes": lambda p: _capital(modes(p, 60)),
    "are": _agreeing("is", "are"),
    "them": _agreeing("it", "them"),
    "escape": _agreeing("which does not satisfy", "which do not all satisfy"),
    "need": _agreeing("needs", "need"),
    "unstable": _agreeing("it is not stable", "not all of them are stable"),
    "price": choice(least="least", cheapest="cheapest"),
    "links": choice(least="the fewest links", cheapest="the cheapest links"),
    "limits": choice(none="", upper=", within the upper limits"),
    "instant": choice(none="", delays=", if messages took no time"),
    "slow": _agreeing("it is not fast enough", "not all of them are fast enough"),
    "do": _agreeing("does", "do"),
    "sides": _sides,
    "roots": _roots,
    "blocks": _blocks,
    "components": _components,
    "indices": _indices,
    "factors": lambda found: ", ".join(cut([polynomial(p, 30) for p in found], 6)),
    "side": choice(controllable="controllable", observable="observable"),
    "reached": _reached,
    "arrows": _arrows,
    "list": lambda sizes: listed([str(size) for size in sizes]),
    "names": lambda names: ", ".join(cut([name_text(name) for name in names], 8)) or "nobody",
    "agents": _agents,
    "dimensions": _dimensions,
    "region": _region,
    "combinations": _combinations,
    "network": choice(
        decentralized="decentralized controller",
        extended="distributed controller with shared states",
        lifted="distributed controller with shared states, sent with delays",
        held="distributed controller with shared states, held for the delays",
    ),
    "method": choice(
        decentralized="without communication",
        observer="by an observer",
        extended="through shared states",
    ),
    "decided": choice(
        polynomial="by the characteristic polynomial",
        lyapunov="by Lyapunov matrices",
        instability="by a quadratic form that decreases and is not positive",
    ),
    "latex": Polynomial.latex,
    "latex_names": lambda names: ", ".join(map(escaped, names)),
    "share": choice(**{"outputs+states": "in addition to outputs", "states": "without outputs"}),
    "carried": _carried,
    "scope": _scope,
    "words": str,
    "values": _values,
    "lost": _lost,
    "undefined": lambda where: f"; undefined where {_values(where)}" if where else "",
    "another": lambda more: "Another" if more else "A",
    "shared": _shared,
    "percent": percent,
    "percent_above": lambda part: percent(part, up=True),
    "digits_above": lambda number: three_digits(number, up=True),
    "gains": _gains,
}


def form(spec: str) -> Write:
    """Return the form that a field names: one of `FORMS`, or ``count noun``."""
    if spec.startswith("count "):
        noun = spec.removeprefix("count ")
        return lambda size: count(size, noun)
    return FORMS[spec]
