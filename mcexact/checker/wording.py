"""Whether the text of a sentence is what its rule says, with the numbers that follow.

``wordings.json`` has the template of each rule: fixed words, and fields.  A number that was rounded
to its safe side, or that bounds eigenvalues, is compared with what follows from the certificates,
and so are the weights of a cost.  Yes or no, and a whole number, are compared with the value of the
same name that the sentence cites, if there is one.  Any other field is not compared, and its place
is told: one of a few phrases, modes, names or channels.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from .core.budget import spend
from .core.reading import Json
from .loops import LIMITS

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d{1,4}|/\d+)?", re.ASCII)
DIGEST = re.compile(r"\b[0-9a-f]{64}\b")
WHOLE = re.compile(r"-?\d+", re.ASCII)
BOUND = re.compile(r"(?:, | and )?([^0-9,]{1,40}?)(-?\d[0-9./e+-]*)", re.ASCII)
DIAGONAL = re.compile(r"(?:([^ ,()]{1,400}) )?I\b|diag\(([^()]*)\)", re.ASCII)
MORE = re.compile(r", (\d+) more$", re.ASCII)
ROUGHLY = chr(0x2248)
"""The sign before a number that is nearly another one."""
YES = {"yes": True, "no": False}
MOST_DIGITS = 400
"""A longer number of a text is not compared."""

Part = str | Sequence[Any]
Places = tuple[tuple[int, int], ...]
"""Where parts of a text begin and end."""
End = tuple[int, bool]
"""Where a part of a text ends, and whether it was compared."""


@dataclass(frozen=True)
class Known:
    """The numbers that follow from the certificates.

    Attributes
    ----------
    because : list
        The files, pointers and values that the sentence cites.
    following : list of Fraction
        The numbers of what follows, outside the statements of certificates and digests.
    """

    because: Json
    following: list[Fraction]

    def cited(self, *fields: str) -> list[Json]:
        """The values that were read, whose pointers end with one of some names."""
        endings = tuple(f"/{field}" for field in fields)
        return [x for _, pointer, x in self.because if pointer.endswith(endings)]

    def lists(self, field: str) -> list[list[Fraction]]:
        """The lists of numbers among the values of a name."""
        return [_rationals(x) for x in self.cited(field) if isinstance(x, list)]

    def named(self, *fields: str) -> list[Fraction]:
        """The numbers among the values of some names."""
        return _rationals(self.cited(*fields))

    def values(self, field: str, kind: type[int]) -> list[int]:
        """The values of a type among those of a name."""
        return [x for x in self.cited(field) if type(x) is kind]

    def of(self, field: str) -> list[Fraction]:
        """The numbers that a field may show.

        They are the values of its name: those of them that what follows has, but all of a step,
        since what follows may name another one.  Without a value they are the numbers of what
        follows, where how far gains may differ is said second, if at all.
        """
        if field == "gains":
            return self.following[1:]
        values = self.named(field)
        said = [] if field == "step" else [x for x in values if x in self.following]
        return said or values or self.following


def known_numbers(because: Json, words: str) -> Known:
    """The numbers that a sentence cites, and those of what follows, in words."""
    values = map(_value, NUMBER.findall(DIGEST.sub("", words)))
    return Known(because, [x for x in values if x is not None])


@cache
def wordings() -> dict[str, list[Part]]:
    """The template of each rule."""
    file = os.path.join(os.path.dirname(__file__), "wordings.json")
    # In an archive the file is read by what loads the modules.
    loader = __spec__.loader
    data: bytes = loader.get_data(file)  # type: ignore[union-attr]
    known: dict[str, list[Part]] = json.loads(data)
    return known


def left_open(text: str, template: Sequence[Part], known: Known) -> Places | None:
    """The places of a text that are not compared; None if no template and numbers make the text.

    Where a text can be read in several ways, the longest places that may be anything are told.
    """
    spend(100 + 4 * len(template) * len(text))
    return _reached(template, text, {0: ()}, known).get(len(text))


def _reached(
    template: Sequence[Part], text: str, places: dict[int, Places], known: Known
) -> dict[int, Places]:
    """Where the parts of a template end that begin at some places of a text, and what is open."""
    for part in template:
        if part == ["any"]:
            first = min(places, default=len(text) + 1)
            open_ = places.get(first, ())
            ends = ((end, (*open_, (first, end))) for end in range(first + 1, len(text) + 1))
            places = {first: open_, **dict(ends)} if places else {}
        elif part[0] == "maybe":
            places = _reached(part[1:], text, places, known) | places
        elif part[0] == "if":
            inside = _reached(part[2:], text, places, known)
            there = any(x is not None for x in known.cited(part[1]))
            places = inside if there else places
        else:
            places = {
                end: open_ if compared else (*open_, (place, end))
                for place, open_ in places.items()
                for end, compared in _ends(part, text, place, known)
            }
    return places


def _ends(part: Part, text: str, place: int, known: Known) -> Iterator[End]:
    """Where a part of a template ends that begins at a place of a text."""
    if isinstance(part, str):
        yield from _phrases([part], text, place, compared=True)
        return
    kind, words = part[0], part[1:]
    if kind in ("of", "agree"):
        yield from _phrases(words, text, place, compared=kind == "agree")
    elif kind == "yes":
        cited = known.values(words[0], bool)
        allowed = [word for word in YES if not cited or YES[word] in cited]
        yield from _phrases(allowed, text, place, compared=bool(cited))
    elif kind in ("int", "count"):
        yield from _whole(words, text, place, known.values(words[0], int))
    elif kind == "region":
        yield from _bounds(text, place, known)
    elif kind == "diagonal":
        yield from _diagonal(text, place, known.lists(words[0]))
    else:
        yield from _rounded(kind, text, place, known.of(words[0]))


def _whole(words: Sequence[str], text: str, place: int, cited: Sequence[int]) -> Iterator[End]:
    """Where a whole number ends, with its noun if it has one; it is one of those that are cited."""
    whole = WHOLE.match(text, place)
    if whole is None or (cited and whole[0] not in map(str, cited)):
        return
    noun = f" {words[1]}{'' if whole[0] == '1' else 's'}" if words[1:] else ""
    if text.startswith(noun, whole.end()):
        yield whole.end() + len(noun), bool(cited)


def _phrases(
    phrases: Iterable[str], text: str, place: int, *, compared: bool = False
) -> Iterator[End]:
    """Where a phrase ends that begins here."""
    for each in phrases:
        if text.startswith(each, place):
            yield place + len(each), compared or not each


def _bounds(text: str, place: int, known: Known) -> Iterator[End]:
    """Where bounds of eigenvalues end, such as ``Re λ < -1/10``, that a certificate has.

    Where the sentence cites none, the user asked for them, and they are not compared.
    """
    cited, free = known.named("bound", *LIMITS), not known.cited("bound")
    while bound := BOUND.match(text, place):
        value, rate = _value(bound[2]), "Re" in bound[1]
        limits = [Fraction(0), *(-x for x in cited)] if rate else [Fraction(1), *cited]
        if value is None or not (free or any(_near(value, each) for each in limits)):
            return
        place = bound.end()
        yield place, not free


def _rounded(kind: str, text: str, place: int, known: list[Fraction]) -> Iterator[End]:
    """Where a rounded number ends, if one that is known is rounded to it."""
    place += kind == "near" and text.startswith(ROUGHLY, place)
    shown = NUMBER.match(text, place)
    value = None if shown is None else _value(shown[0])
    if shown is None or value is None:
        return
    percent = kind.startswith("percent")
    value /= 100 if percent else 1
    if not known or any(ROUNDED[kind](value, each) for each in known):
        unit = " %" if percent else ""
        if text.startswith(unit, shown.end()):
            yield shown.end() + len(unit), bool(known)


def _diagonal(text: str, place: int, known: list[list[Fraction]]) -> Iterator[End]:
    """Where a diagonal matrix ends, such as ``1/100 I``, that a certificate has.

    Of a long one the first entries are shown.
    """
    shown = DIAGONAL.match(text, place)
    if shown is None:
        return
    multiple, listed = shown[1] or "1", shown[2]
    more = MORE.search(listed or "")
    texts = [multiple] if listed is None else MORE.sub("", listed).split(", ") if listed else []
    values = [_value(x.removeprefix(ROUGHLY)) for x in texts]
    for entries in known:
        first = values * len(entries) if listed is None else values
        number = len(first) + (int(more[1]) if more else 0)
        pairs = zip(first, entries, strict=False)
        if number == len(entries) and all(x is not None and _near(x, y) for x, y in pairs):
            yield shown.end(), True
            return


def _near(value: Fraction, x: Fraction) -> bool:
    """Whether two numbers are equal, or agree in their first digits."""
    return 10**5 * abs(value - x) <= abs(x)


def _within(digits: int) -> Callable[[Fraction, Fraction], bool]:
    """Whether a number is at most another one, and equal to it in its first digits."""
    return lambda low, high: 0 <= high - low <= max(abs(low), abs(high)) / 10 ** (digits - 1)


ROUNDED: dict[str, Callable[[Fraction, Fraction], bool]] = {
    "below": _within(3),
    "above": lambda value, x: _within(3)(x, value),
    "percent below": _within(3),
    "percent above": lambda value, x: _within(3)(x, value),
    "part above": lambda value, x: _within(2)(x, value),
    "near": _near,
}
"""The ways of rounding: of the number in the text, and of the one that follows."""


def _value(shown: str) -> Fraction | None:
    try:
        return Fraction(shown) if len(shown) <= MOST_DIGITS else None
    except (ValueError, ZeroDivisionError):
        return None


def _rationals(values: Iterable[Json]) -> list[Fraction]:
    """The numbers among some values."""
    return [x for x in map(_rational, values) if x is not None]


def _rational(value: Json) -> Fraction | None:
    whole = isinstance(value, int) and not isinstance(value, bool)
    return _value(str(value)) if whole or isinstance(value, str) else None
