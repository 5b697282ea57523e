"""Templates of sentences, the forms of their fields, and words for modes.

A `Template` has the wording of a sentence, with fields ``{name:form}``, its key in the list of all
sentences, and the theorem that implies it.  A form, one of ``FORMS``, writes a value as text:
modes, channels, rates, regions, shared dimensions.  Lists are shortened where they are long.  A
filled template is a `Sentence`.
"""

from __future__ import annotations

import string
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from typing import Any

from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import (
    approximated,
    decimal_number,
    digits_outward,
    number,
    percent,
    polynomial,
    rounded,
    three_digits,
)
from mcexact.exact.roots import TIMES, StabilityRegion, exact_decimal, is_discrete
from mcexact.model.regulated import selection_in_words
from mcexact.shown import escaped

# Modes, channels and names as text, shortened where they are many.


def modes(p: Polynomial, limit: int = 30) -> str:
    """Name the roots of a polynomial as modes; a rational mode by its value.

    Examples
    --------
    >>> modes(Polynomial.of("-1/2", 1)), modes(Polynomial.of(1, 0, 1))
    ('the mode 1/2', 'the 2 roots of x^2 + 1')
    """
    if p.degree == 1:
        return f"the mode {number(-p.coefficients[0] / p.coefficients[1])}"
    return f"the {p.degree} roots of {polynomial(p, limit)}"


def about_mode(p: Polynomial) -> str:
    """The root of a polynomial of degree 1, or the pair of roots of one of degree 2, in six digits.

    Examples
    --------
    >>> about_mode(Polynomial.of(0, 1)), about_mode(Polynomial.of("-1/3", 1))
    ('0', '0.333333')
    >>> about_mode(Polynomial.of(5, 2, 1)), about_mode(Polynomial.of(6, -5, 1))
    ('-1 ± 2i', '2 and 3')
    """
    if p.degree == 1:
        return rounded(-p.coefficients[0] / p.coefficients[1])
    q, minus, lead = p.coefficients
    middle, square = -minus / lead / 2, minus * minus / lead / lead / 4 - q / lead
    with localcontext(prec=30, Emax=MAX_EMAX, Emin=MIN_EMIN):
        apart = Fraction((Decimal(abs(square.numerator)) / Decimal(square.denominator)).sqrt())
    if square < 0:
        return f"{rounded(middle)} ± {rounded(apart)}i"
    return f"{rounded(middle - apart)} and {rounded(middle + apart)}"


def allowed(region: object | None) -> str:
    """Say where members of a box may have modes of some kind, such as fixed ones; None is nowhere.

    Examples
    --------
    >>> allowed(None), allowed("Re λ < 0")
    ('none', 'only with Re λ < 0')
    """
    return "none" if region is None else f"only with {region}"


def count(size: int, noun: str) -> str:
    """Format a number with its noun, such as 2 nodes.

    Examples
    --------
    >>> count(1, "node"), count(2, "node")
    ('1 node', '2 nodes')
    """
    return f"{size} {noun}" if size == 1 else f"{size} {noun}s"


def listed(words: Sequence[str]) -> str:
    """Join words with commas and "and".

    Examples
    --------
    >>> listed(["1"]), listed(["1", "2", "3"])
    ('1', '1, 2 and 3')
    """
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def channels(names: Iterable[str], limit: int = 8) -> str:
    """Name channels as a phrase.

    Examples
    --------
    >>> channels(["1"]), channels(["1", "2", "3"])
    ('channel 1', 'channels 1, 2 and 3')
    """
    shown = [name_text(name) for name in names]
    if len(shown) == 1:
        return f"channel {shown[0]}"
    return "channels " + listed(cut(shown, limit))


def name_set(names: Iterable[str], limit: int = 12) -> str:
    """Name channels in braces; of many channels the first few and the number of the others.

    Examples
    --------
    >>> name_set(["1", "2"]), name_set(map(str, range(20)), 2)
    ('{1, 2}', '{0, 1, 18 more}')
    """
    return "{" + ", ".join(cut([name_text(name) for name in names], limit)) + "}"


def cut(words: Sequence[str], limit: int, more: str = "{} more") -> list[str]:
    """Keep the first few words, and add the number of the others.

    Examples
    --------
    >>> cut(["a", "b", "c"], 2)
    ['a', 'b', '1 more']
    """
    return list(words) if len(words) <= limit else [*words[:limit], more.format(len(words) - limit)]


def name_text(name: str, limit: int = 40) -> str:
    """Format a name given by the user, shortened at its end."""
    return name if len(name) <= limit else name[: limit - 1] + "…"


def edges(edges: Sequence[tuple[str, str]], limit: int = 12) -> str:
    """Format edges of a graph as ``1 -> 2``; of many edges only the number.

    Examples
    --------
    >>> edges([("1", "2")]), edges([]), edges([("1", "1")] * 30)
    ('1 -> 2', 'no edges', '30 edges')
    """
    if not edges:
        return "no edges"
    if len(edges) > limit:
        return count(len(edges), "edge")
    return ", ".join(f"{name_text(start)} -> {name_text(end)}" for start, end in edges)


# The forms of the fields of sentences: numbers, modes, channels, rates, shared dimensions.

Write = Callable[[Any], str]


def choice(**words: str) -> Write:
    """A form with a few phrases, each of which has a keyword."""
    return words.__getitem__


@dataclass(frozen=True)
class _Agreeing:
    """A form that agrees with the number of the roots of a polynomial, or of names."""

    one: str
    more: str

    def __call__(self, value: Any) -> str:
        size = value.degree if isinstance(value, Polynomial) else len(value)
        return self.one if size == 1 else self.more


@dataclass(frozen=True)
class _Only:
    """A form that has words if its value is true."""

    words: str

    def __call__(self, value: Any) -> str:
        return self.words if value else ""


_TIMES = {1: "once", 2: "twice", 3: "three times"}


def _times(most: int) -> str:
    """Write how often a fixed mode is fixed, of which a bound from above is known."""
    return "once" if most == 1 else f"at most {_TIMES.get(most, f'{most} times')}"


def _of_pattern(modes: tuple[Sequence[int], int]) -> str:
    """Write the modes that are fixed for all numbers: of which states, and how often 0 is."""
    apart, zeros = modes
    names = listed(cut([str(k) for k in apart], 8))
    own = f"those of {'state' if len(apart) == 1 else 'states'} {names} without feedback"
    often = _TIMES.get(zeros, f"{zeros} times")
    if not zeros:
        return own
    return f"{own}, and 0 {often} more" if apart else f"0, {often}"


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
    roots = [
        rounded(re) if not im else f"{rounded(re)} ± {rounded(im)}i"
        for re, im in centers
        if im >= 0
    ]
    return ", ".join(cut(roots, 6))


def _blocks(blocks: Sequence[tuple[int, Sequence[str]]]) -> str:
    """Write the degrees of the parts, without those of degree 0; of many the first few."""
    return ", ".join(cut([f"{size} by {name_set(names, 6)}" for size, names in blocks if size], 8))


def _components(components: Sequence[Sequence[str]]) -> str:
    """Write sets of channels, those with more than one first; of many the first few."""
    ordered = sorted(components, key=len, reverse=True)
    return " ".join(cut([name_set(names, 6) for names in ordered], 8))


def _indices(numbers: Sequence[int]) -> str:
    return ", ".join(cut([str(k) for k in numbers], 15)) or "none"


def _reached(lengths: Sequence[Sequence[int]]) -> str:
    """Write the least lengths k with which each channel reaches all states."""
    single = len(lengths) == 1 and len(lengths[0]) == 1
    listed_pairs = cut([" and ".join(map(str, k)) for k in lengths], 8)
    return f"{'index' if single else 'indices'} {', '.join(listed_pairs)}"


def _shared(sizes: Sequence[tuple[str, int]]) -> str:
    """Write the number of states that each agent shares, without agents that share none."""
    parts = [f"{count(size, 'state')} by agent {name_text(name)}" for name, size in sizes if size]
    return ", ".join(cut(parts, 11, "by {} more agents"))


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
    do = _Agreeing("does", "do")
    clauses = [
        f"{channels(names)} {do(names)} not {verb}"
        for names, verb in zip(sides, verbs, strict=True)
    ]
    return " and ".join(clauses)


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
    inequalities = ["(" + ", ".join(number(Fraction(x)) for x in row) + ") r ≠ 0" for row in rows]
    return " or ".join(inequalities)


def _regulated(held: Sequence[tuple[str, Sequence[Sequence[Fraction]]]]) -> str:
    """Write which outputs of which agents are held at set-points."""
    selection = tuple(Matrix.from_rows([list(row) for row in rows]) for _, rows in held)
    return selection_in_words(selection, [name for name, _ in held])


GAINS = (
    ", with all gains within {gains:percent} of their values "
    "({digits:count digit}, however rounded)"
)
"""What is said of gains that may differ; nothing is, where they may not."""


def _gains(part: Fraction | None) -> str:
    """Write by how much gains may differ, and to how many digits they may be rounded then."""
    if part is None:
        return ""
    digits = 1
    while Fraction(10) ** (1 - digits) > part:
        digits += 1
    return _Writer().vformat(GAINS, (), {"gains": part, "digits": digits})


def _arrows(edges: Sequence[tuple[str, str]]) -> str:
    """Write every edge of a graph, as text that replaces a picture."""
    arrows = [f"{name_text(start)} → {name_text(end)}" for start, end in edges]
    return ", ".join(cut(arrows, 40)) or "none"


def failures_in_words(failures: Iterable[tuple[str, str, Any]], last_by: str = "or") -> str:
    """Name failed agents, actuators, sensors and links.

    Parameters
    ----------
    failures : iterable
        Each with its part, the agent, and the number or the receiver.
    last_by : {"or", "and"}
        The word before the last one.

    Examples
    --------
    >>> failures_in_words([("agents", "2", None), ("sensors", "2", 1), ("links", "1", "2")])
    'agent 2, its sensor 1 or link 1 -> 2'
    """
    listed = [*failures]
    whole = [agent for part, agent, _ in listed if part == "agents"]

    def place(failure: tuple[str, str, Any]) -> tuple[bool, int]:
        part, agent, _ = failure
        return (part == "links", whole.index(agent) if agent in whole else len(whole))

    words = []
    for part, agent, which in sorted(listed, key=place):
        name = name_text(agent)
        if part == "agents":
            words.append(f"agent {name}")
        elif part == "links":
            words.append(f"link {name} -> {name_text(which)}")
        elif agent in whole:
            words.append(f"its {part.removesuffix('s')} {which}")
        else:
            words.append(f"{part.removesuffix('s')} {which} of agent {name}")
    *first, last = cut(words, 12)
    return f" {last_by} ".join(filter(None, [", ".join(first), last]))


def _so_many(part: str, least: int, most: int) -> str:
    """Write how many agents, actuators, sensors or links."""
    numbers = str(most) if least == most else f"{least} to {most}"
    return f"{numbers} {part.removesuffix('s') if most == 1 else part}"


def _spared(then: str) -> Write:
    """Write what still holds after any k failures of a part, if k is not 0."""

    def write(value: tuple[str, int]) -> str:
        part, k = value
        return f"; after any {_so_many(part, k, k)} {then}" if k else ""

    return write


def several_modes(factors: Sequence[Polynomial]) -> str:
    """Name the roots of several polynomials as modes, rational ones first.

    Examples
    --------
    >>> several_modes([Polynomial.of("-1/2", 1), Polynomial.of(1, 0, 1), Polynomial.of(0, 1)])
    'the modes 1/2 and 0, the 2 roots of x^2 + 1'
    >>> several_modes([Polynomial.of(0, 1)])
    'the mode 0'
    """
    linear = [modes(p) for p in factors if p.degree == 1]
    numbers = listed(cut([each.removeprefix("the mode ") for each in linear], 6))
    named = [f"the mode{'s' * (len(linear) > 1)} {numbers}"] if linear else []
    return ", ".join([*named, *cut([modes(p) for p in factors if p.degree > 1], 4)])


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _lost(edges: Sequence[tuple[tuple[str, str], Sequence[str]]]) -> str:
    """Write at which values which edges vanish."""
    clauses = [
        f"{name_text(start)} -> {name_text(end)} vanishes where {_values(where)}"
        for (start, end), where in edges
    ]
    return "; ".join(cut(clauses, 12))


def _eigenvector(p: Polynomial, before: str, after: str) -> str:
    """Write that A times a vector is a multiple of it, which may be 0."""
    mode = -p.coefficients[0] / p.coefficients[1]
    if not mode:
        return f"{before}A{after} = 0"
    vector = (before + after).strip()
    times = "" if mode == 1 else "-" if mode == -1 else f"{number(mode)} "
    return f"{before}A{after} = {times}{vector}"


def _vectors(vectors: Sequence[Sequence[int]]) -> str:
    """Write vectors of integers; of a long one its entries that are not 0.

    Examples
    --------
    >>> _vectors([(1, 0), (0, 1)]), _vectors([(0, 2) + 12 * (0,)])
    ('(1, 0) and (0, 1)', '(entry 2 = 2, else 0)')
    """
    texts = []
    for vector in vectors:
        if len(vector) <= 12:
            texts.append("(" + ", ".join(map(str, vector)) + ")")
        else:
            entries = [f"entry {k} = {x}" for k, x in enumerate(vector, 1) if x]
            texts.append("(" + ", ".join([*cut(entries, 8), "else 0"]) + ")")
    return listed(texts)


def _values(where: Sequence[str]) -> str:
    """Write conditions on parameters."""
    return " or ".join(cut(where, 8))


def _diagonal(entries: Sequence[Fraction]) -> str:
    """Write a diagonal matrix, as a multiple of I where its entries are equal."""
    if len(set(entries)) == 1:
        return "I" if entries[0] == 1 else f"{number(entries[0])} I"
    return f"diag({', '.join(cut([number(x) for x in entries], 6))})"


WEIGHTS = (
    "the mean of x'Qx + u'Ru with Q = {states:diagonal}, R = {inputs:diagonal} under white "
    "disturbances of intensity {disturbances:diagonal} and white noise of the outputs of intensity "
    "{noise:diagonal}"
)
BANDWIDTH = " behind v' = -ωv + ωn with ω = {bandwidth:frequency}"
"""The cost, the disturbances and the noise, and the filter that the noise passes, if any."""


def _weights(weights: Sequence[Any]) -> str:
    """Write the cost, the disturbances and the noise, from Q, R, W, V and the bandwidth."""
    names = ("states", "inputs", "disturbances", "noise", "bandwidth")
    text = WEIGHTS if weights[-1] is None else WEIGHTS + BANDWIDTH
    return _Writer().vformat(text, (), dict(zip(names, weights, strict=True)))


def _sectors(sectors: Sequence[tuple[Fraction, Fraction]]) -> str:
    """Write the ends of sectors, once if all are the same."""
    pairs = [f"[{number(a)}, {number(b)}]" for a, b in sectors]
    return pairs[0] if len(set(pairs)) == 1 else ", ".join(cut(pairs, 6))


def _limits(by_channel: Sequence[tuple[str, Sequence[Any]]]) -> str:
    """Write the limits of inputs, once if all inputs have the same."""
    parts = []
    for name, own in by_channel:
        inputs = [name] if len(own) == 1 else [f"{name}[{k + 1}]" for k in range(len(own))]
        parts += [(label, pair) for label, pair in zip(inputs, own, strict=True)]
    pairs = {pair for _, pair in parts}
    if len(pairs) == 1 and (only := pairs.pop()) is not None:
        return f"{number(only[0])} to {number(only[1])}"
    limited = ((label, pair) for label, pair in parts if pair is not None)
    texts = [f"{label} {number(low)} to {number(high)}" for label, (low, high) in limited]
    return ", ".join(cut(texts, 6))


_SAMPLES = {
    None: "",
    "exact": "; also for the samples without rounding",
    "rounded": "; proved for the samples rounded to decimals, and not for the exact ones",
}

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
    "inputs": choice(continuous="set by their derivatives", discrete="set one step late"),
    "control": choice(
        own="linear time-invariant decentralized control",
        alone="linear time-invariant decentralized control without communication",
        outputs="linear time-invariant control by the outputs of all neighbors",
        instant="linear time-invariant control by the outputs of all neighbors without delay",
    ),
    "causal": choice(
        own="decentralized control",
        alone="decentralized control without communication",
    ),
    "information": choice(
        own="each agent feeds back its own output",
        outputs="each agent feeds back the outputs of all its neighbors",
        instant="each agent feeds back the outputs of all its neighbors, received without delay",
    ),
    "often": _often,
    "of pattern": _of_pattern,
    "behavior": _behavior,
    "Modes": lambda p: _capital(modes(p, 60)),
    "about": about_mode,
    "noun": _Agreeing("mode", "modes"),
    "are": _Agreeing("is", "are"),
    "them": _Agreeing("it", "them"),
    "stay": _Agreeing("stays", "stay"),
    "times": _times,
    "escape": _Agreeing("which does not satisfy", "which do not all satisfy"),
    "need": _Agreeing("needs", "need"),
    "receive": _Agreeing("receives", "receive"),
    "unstable": _Agreeing("it is not stable", "not all of them are stable"),
    "price": choice(least="least", cheapest="cheapest"),
    "links": choice(least="the fewest links", cheapest="the cheapest links"),
    "limits": choice(none="", upper=", within the upper limits"),
    "fed": choice(own="", outputs=", where outputs of neighbors are fed back"),
    "instant": choice(none="", delays=", if messages took no time"),
    "slow": _Agreeing("it is not fast enough", "not all of them are fast enough"),
    "do": _Agreeing("does", "do"),
    "sides": _sides,
    "roots": _roots,
    "blocks": _blocks,
    "components": _components,
    "indices": _indices,
    "factors": lambda factors: ", ".join(cut([polynomial(p, 30) for p in factors], 6)),
    "side": choice(controllable="controllable", observable="observable"),
    "reached": _reached,
    "arrows": _arrows,
    "list": lambda sizes: listed([str(size) for size in sizes]),
    "names": lambda names: ", ".join(cut([name_text(name) for name in names], 8)) or "nobody",
    "agents": _agents,
    "dimensions": _dimensions,
    "region": _region,
    "combinations": _combinations,
    "regulated": _regulated,
    "network": choice(
        decentralized="decentralized controller",
        without="distributed controller",
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
    "right": lambda p: _eigenvector(p, "", " v"),
    "left": lambda p: _eigenvector(p, "w ", ""),
    "vectors": _vectors,
    "undefined": lambda where: f"; undefined where {_values(where)}" if where else "",
    "another": lambda more: "Another" if more else "A",
    "shared": _shared,
    "percent": percent,
    "part": lambda part: digits_outward(part, up=True, digits=2),
    "percent_above": lambda part: percent(part, up=True),
    "digits_above": lambda number: three_digits(number, up=True),
    "digits_below": three_digits,
    "weights": _weights,
    "diagonal": _diagonal,
    "frequency": number,
    "proper": _Only(" whose inputs do not depend on the outputs at once"),
    "sectors": _sectors,
    "input limits": _limits,
    "in sizes": _Only(", each state divided by its size,"),
    "rounded samples": _SAMPLES.__getitem__,
    "several modes": several_modes,
    "failures": failures_in_words,
    "failures together": lambda failures: failures_in_words(failures, "and"),
    "still stabilizable": _spared("it is"),
    "nothing further": _spared("nothing further"),
    "not decided": lambda sizes: f"; of {_so_many(*sizes)} it is not known" if sizes else "",
    "parts": choice(own="agent, actuator or sensor", outputs="agent, actuator, sensor or link"),
    "windup": _Only(" and with the anti-windup gains of the controller"),
    "step": approximated,
    "late": lambda steps: f" and applied {count(steps, 'step')} late" if steps else "",
    "short late": lambda steps: f", {count(steps, 'step')} late" if steps else "",
    "gains": _gains,
}


def form(spec: str) -> Write:
    """Return the form that a field names: one of `FORMS`, or ``count noun``."""
    if spec.startswith("count "):
        noun = spec.removeprefix("count ")
        return lambda size: count(size, noun)
    return FORMS[spec]


def phrases_of(spec: str) -> tuple[str, ...]:
    """The phrases of a form that has only a few; none of any other form.

    Examples
    --------
    >>> phrases_of("yes"), phrases_of("are"), phrases_of("modes")
    (('yes', 'no'), ('is', 'are'), ())
    """
    write = FORMS.get(spec)
    if spec == "yes":
        return "yes", "no"
    if isinstance(write, _Agreeing):
        return write.one, write.more
    if isinstance(write, _Only):
        return "", write.words
    words = getattr(write, "__self__", None)
    return tuple(words.values()) if isinstance(words, dict) else ()


def agrees(spec: str) -> bool:
    """Whether the phrases of a form say the same of one and of several.

    Examples
    --------
    >>> agrees("are"), agrees("yes")
    (True, False)
    """
    return isinstance(FORMS.get(spec), _Agreeing)


# Sentences about a user's system, and their templates with fields for values.

Premise = tuple[str, str, Any]
"""The file of a certificate, a JSON pointer into it, and the value there."""


class Sentence(str):
    """A text about a system, with its template and its premises.

    Attributes
    ----------
    template : Template
    cells : tuple of str
        The text as a row of a table, after its label or in the columns of the template.
    place : str
        The place given by a rule.
    because : tuple of Premise
        The premises: the claims that the rule has read.
    values : mapping
        The values that fill the fields of the template, by their names.
    """

    template: Template
    cells: tuple[str, ...]
    place: str = ""
    because: tuple[Premise, ...] = ()
    values: Mapping[str, Any]

    def __new__(
        cls, text: str, template: Template, cells: tuple[str, ...], values: Mapping[str, Any]
    ) -> Sentence:
        self = super().__new__(cls, text)
        self.template, self.cells, self.values = template, cells, values
        return self

    def bound(self, place: str, because: tuple[Premise, ...]) -> Sentence:
        """Return the sentence with its place and premises."""
        sentence = Sentence(str(self), self.template, self.cells, self.values)
        sentence.place, sentence.because = place, because
        return sentence

    @property
    def line(self) -> str:
        """The text, after the label if there is one; in a row each cell after its column."""
        return self.template.in_line(self.split(" | ") if self.template.columns else [self])

    def __reduce__(self) -> tuple[Any, ...]:
        return (str, (str(self),))


@dataclass(frozen=True)
class Template:
    """A template of sentences, with fields.

    Parameters
    ----------
    key : str
        Its key in the list of all sentences.
    text : str
        Text with fields ``{name:form}``, where the form is one of `FORMS`, or ``{name:count
        noun}``.  In a row of a table ``" | "`` separates the columns.
    theorem : str
        The theorem by which the premises imply the sentence, if it does not only repeat a claim:
        machine-checked theorems of ``proofs/``, or the authors of a published theorem.
    label : str
        Its label in a table of names and values.
    claims : bool
        Whether its sentences claim something.  A title, and what is not decided or not proved, is a
        remark, which the checker does not count as implied.
    columns : tuple of str
        The heads of the columns, without which a row could not be read by itself.
    """

    key: str
    text: str
    theorem: str = ""
    label: str = ""
    claims: bool = True
    columns: tuple[str, ...] = ()

    def in_line(self, parts: Sequence[str]) -> str:
        """The parts of a text in one line, after the label or the heads of their columns."""
        if self.columns:
            named = zip(self.columns, parts, strict=True)
            return "; ".join(f"{column}: {part}" for column, part in named)
        text = " | ".join(parts)
        return f"{self.label}: {text}" if self.label else text

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of its fields, each once."""
        named = (name for _, name, _, _ in string.Formatter().parse(self.text) if name)
        return tuple(dict.fromkeys(named))

    def __call__(self, **values: Any) -> Sentence:
        """Make the sentence with some values."""
        cells = tuple(_Writer().vformat(part, (), values) for part in self.text.split(" | "))
        labeled = (self.label, *cells) if self.label else cells
        used = {name: values[name] for name in self.fields}
        return Sentence(" | ".join(cells), self, labeled, used)


class _Writer(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        return form(format_spec)(value)


def templates(*modules: Any) -> Iterator[Template]:
    """Return the templates that modules define, in order, also those in tuples and mappings."""
    for module in modules:
        for name, value in vars(module).items():
            if not name.startswith("__"):
                yield from _inside(value)


def _inside(value: Any) -> Iterator[Template]:
    if isinstance(value, Template):
        yield value
    elif isinstance(value, tuple | dict):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _inside(each)


# Modes that depend on parameters, and which channels cause that they are fixed, in words.


def blame(s: Sequence[str], names: Sequence[str]) -> str:
    """Say what it means that the pencil [xI − A, B_{m−s}; C_s, 0] of a set s loses rank.

    Examples
    --------
    >>> blame(["2", "3"], ["1", "2", "3"])
    'channel 1 does not control it, channels 2, 3 do not observe it'
    >>> blame([], ["1", "2"]), blame(["1"], ["1"])
    ('no channel controls it', 'no channel observes it')
    """
    others = [name for name in names if name not in s]
    if not s:
        return "no channel controls it"
    if not others:
        return "no channel observes it"
    return f"{_subject(others)} not control it, {_subject(s)} not observe it"


def _subject(names: Sequence[str]) -> str:
    several = len(names) > 1
    return f"channel{'s' if several else ''} {', '.join(names)} do{'' if several else 'es'}"


def polynomial_in_x(coefficients: Sequence[str]) -> str:
    """A polynomial in x by the texts of its coefficients, constant first.

    Examples
    --------
    >>> polynomial_in_x(["-t", "2", "1"]), polynomial_in_x(["t^2 - 2", "0", "1"])
    ('x^2 + 2*x - t', 'x^2 + (t^2 - 2)')
    """
    text = ""
    for k, each in reversed(list(enumerate(coefficients))):
        if each == "0":
            continue
        power = "" if k == 0 else "x" if k == 1 else f"x^{k}"
        negative = each.startswith("-") and " " not in each
        body = f"({each})" if " " in each else each.removeprefix("-")
        term = power if power and body == "1" else "*".join(filter(None, (body, power)))
        text += f" {'-' if negative else '+'} " if text else "-" if negative else ""
        text += term
    return text or "0"
