"""How far entries may be from their values: the radii of a plant, and the words for any radii."""

import json
import re
from fractions import Fraction

from . import budget
from .arithmetic import Matrix
from .reading import Json, Limits, fields, incomplete, malformed, parse, shown, string
from .sparse import SparseMatrix, entries_of
from .system_matrices import in_json, number, read_matrix

WAYS = ("relative", "digits", "absolute")
Pair = tuple[Fraction, Fraction]
"""A radius, and the absolute value of the entry that it is of."""


def as_typed(data: bytes, document: Json, limits: Limits) -> Json:
    """The document with its numbers as texts, where radii follow from how they are typed."""
    doubt = document.get("uncertainty")
    wanted = isinstance(doubt, dict) and "digits" in doubt
    return parse(data, limits, str) if wanted else None


def radii_form(
    value: Json, names: list[str], nominal: list[Matrix], limits: Limits | None, typed: Json
) -> Json:
    """The canonical form of the radii that a document gives, None if all are 0.

    ``nominal`` are A, then all B_i, then all C_i.  A certificate gives the radii themselves, a
    system file also a part of every entry, or the digits with which it is typed.
    """
    ways = WAYS if limits else WAYS[2:]
    given = fields(value, "uncertainty", optional=ways)
    if len(value) != 1:
        expected = " or ".join(map(shown, ways))
        malformed("uncertainty", f"expected exactly one key, {expected}")
    if "absolute" in value:
        found = _absolute(value["absolute"], names, nominal, limits)
    elif "relative" in value:
        part = Fraction(number(given[0], "uncertainty.relative", limits))
        if part < 0:
            malformed("uncertainty.relative", "expected a number from 0 on")
        found = [_multiple(M, part) for M in nominal]
    else:
        string(given[1], "uncertainty.digits", "as typed")
        found = [_half_units(part) for part in _matrices_of(typed)]
    form = _form(found, names)
    if limits:
        _require_short(form, limits)
    return form


def _require_short(form: Json, limits: Limits) -> None:
    """Stop where a radius has more digits than numbers of a file may have."""
    text = json.dumps(form)
    budget.spend(len(text))
    if max(map(len, re.findall("[0-9]+", text)), default=0) > limits.digits:
        message = f"a radius has more than {limits.digits} digits (Limits.digits)"
        incomplete("size", "uncertainty", message)


def read_radii(form: Json, names: list[str], nominal: list[Matrix]) -> list[Matrix]:
    """The radii of A, of all B_i and of all C_i, from their canonical form."""
    if form is not None:
        return _absolute(form["absolute"], names, nominal, None)
    return [Matrix.zeros(M.nrows, M.ncols) for M in nominal]


def pairs_of(nominal: list[Matrix], radii: list[Matrix]) -> list[Pair]:
    """The radius of each entry that is uncertain or not 0."""
    found = list[Pair]()
    for M, D in zip(nominal, radii, strict=True):
        values = {(i, j): abs(x) for i, j, x in entries_of(M)}
        spread = {(i, j): radius for i, j, radius in entries_of(D)}
        places, longest = {**values, **spread}, max(M.limbs, D.limbs)
        budget.spend(100 + 200 * len(places) + 4 * budget.fractions(len(places), longest))
        for place in places:
            radius = Fraction(spread.get(place, 0), D.denominator)
            found.append((radius, Fraction(values.get(place, 0), M.denominator)))
    return found


def radii_in_words(pairs: list[Pair], whose: str) -> str:
    """How far entries may be from "the latter", whose radii are ``whose`` in words.

    Where all radii are one part of the absolute values, this part says all; otherwise how many
    radii there are, the largest one, and the largest part, unless an entry that is 0 is uncertain.
    """
    wide = [pair for pair in pairs if pair[0]]
    longest = budget.limbs_of([number for pair in pairs for number in pair])
    budget.spend(budget.fractions(4 * len(pairs) + 4, 2 * longest))
    if not wide:
        return f"by at most {whose} (no entry has one)"
    parts = [radius / value for radius, value in wide if value]
    largest = f"none above {max(radius for radius, _ in wide)}"
    if len(parts) == len(wide):
        most = f"{max(parts)} of the absolute value"
        if len(pairs) == len(wide) and len(set(parts)) == 1:
            return f"by at most {most}s of the latter"
        largest += f" and none above {most} of its entry"
    have = "1 entry has one" if len(wide) == 1 else f"{len(wide)} entries have one"
    return f"by at most {whose} ({have}, {largest})"


def _absolute(
    value: Json, names: list[str], nominal: list[Matrix], limits: Limits | None
) -> list[Matrix]:
    """The matrices of radii that are given, and zeros for those that are left out."""
    place = "uncertainty.absolute"
    A, *ports = fields(value, place, optional=("A", "B", "C"))
    given, places = [A], [f"{place}.A"]
    for key, port in zip("BC", ports, strict=True):
        where = f"{place}.{key}"
        given += fields({} if port is None else port, where, optional=tuple(names))
        places += [where] * len(names)
    return [
        Matrix.zeros(M.nrows, M.ncols)
        if part is None
        else _positive(read_matrix(part, where, M.nrows, M.ncols, limits), where)
        for part, where, M in zip(given, places, nominal, strict=True)
    ]


def _positive(M: Matrix, place: str) -> Matrix:
    """A matrix without negative entries."""
    if any(entry < 0 for _, _, entry in entries_of(M)):
        malformed(place, "expected radii from 0 on")
    return M


def _multiple(M: Matrix, part: Fraction) -> Matrix:
    """So many times the absolute value of every entry."""
    entries, p, q = entries_of(M), part.numerator, part.denominator
    a, b = M.limbs, budget.limbs_of([part])
    budget.spend(100 * len(entries) + budget.products(len(entries) + 1, a, b))
    return SparseMatrix(
        M.nrows, M.ncols, [(i, j, p * abs(x)) for i, j, x in entries if p], q * M.denominator
    )


def _matrices_of(document: Json) -> list[Json]:
    """A, all B_i and all C_i of a document."""
    channels = document["channels"]
    return [document["A"], *(each["B"] for each in channels), *(each["C"] for each in channels)]


def _half_units(value: Json) -> Matrix:
    """Half a unit of the last digit of every entry that is typed with a point or an exponent."""
    if isinstance(value, dict):
        halves = [[i, j, _half_unit(entry)] for i, j, entry in value["entries"]]
        return read_matrix({**value, "entries": halves}, "uncertainty", None, None)
    return read_matrix([[_half_unit(x) for x in row] for row in value], "uncertainty", None, None)


def _half_unit(text: Json) -> Fraction:
    """Half a unit of the last digit; 0 of an integer, of a quotient, and of 0."""
    mantissa, _, exponent = str(text).lower().partition("e")
    if "/" in mantissa or not ("." in mantissa or exponent) or not Fraction(mantissa):
        return Fraction(0)
    budget.spend(300 + (len(text) + abs(int(exponent or 0))) ** 2 // 500)
    return Fraction(10) ** (int(exponent or 0) - len(mantissa.partition(".")[2])) / 2


def _form(radii: list[Matrix], names: list[str]) -> Json:
    """The radii that are not 0, by their positions, in lowest terms."""
    forms = []
    for M in radii:
        entries = entries_of(M)
        budget.spend(budget.fractions(len(entries), M.limbs))
        listed = [[i, j, in_json(x, M.denominator)] for i, j, x in entries]
        forms.append({"shape": [M.nrows, M.ncols], "entries": listed} if listed else None)
    B, C = forms[1 : len(names) + 1], forms[len(names) + 1 :]
    parts: dict[str, Json] = {"A": forms[0]}
    for key, port in (("B", B), ("C", C)):
        parts[key] = {name: form for name, form in zip(names, port, strict=True) if form}
    found = {key: part for key, part in parts.items() if part}
    return {"absolute": found} if found else None
