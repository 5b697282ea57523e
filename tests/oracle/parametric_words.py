"""What is said of all values of parameters, in words, against what is decided at single values.

Sentences and rows are read as an engineer reads them: conditions are found in the text and put to
the point, modes and causes are looked up in ranks of pencils at the point.  Nothing of the answers
but their words is used.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any

from mcexact import MultiChannelSystem, ParametricSystem, analyze
from mcexact.errors import InputError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import RationalFunction
from mcexact.model.entries import as_function
from mcexact.questions import pencil_rank
from tests.oracle.parametric import subsets

Point = Mapping[str, Fraction]
CONDITION = re.compile(r"([^=]+?) = ([^ ,;()]+)(?: \([^)]*\))*(?: or |, |; |$)")
Sets = list[tuple[int, ...]]
LOST: dict[str, Callable[[int], Sets]] = {
    "fixed_spectrum": lambda m: list(subsets(m)),
    "joint_controllability": lambda m: [()],
    "joint_observability": lambda m: [tuple(range(m))],
}
"""The sets s of channels whose pencils matter for a question."""
LABELS = {
    "fixed_spectrum": "fixed modes",
    "joint_controllability": "jointly controllable",
    "joint_observability": "jointly observable",
}


def value_at(text: str, at: Point) -> Fraction:
    """A function of the parameters, in words, at a point."""
    names = tuple(sorted(at))
    zero = RationalFunction.constant(0, ())
    return as_function(text, "text", names).substituted([at[n] for n in names], zero).value


def holds(where: str, at: Point) -> bool:
    """Whether one of the conditions in a text holds at a point."""
    return any(
        value_at(left.strip(), at) == value_at(right, at)
        for left, right in CONDITION.findall(where)
    )


def pencil_modes(plant: MultiChannelSystem, sets: Iterable[tuple[int, ...]]) -> dict[Any, set[Any]]:
    """The irreducible polynomials of modes at which pencils lose rank, each with the sets s."""
    found: dict[Any, set[Any]] = {}
    modes = [p for p, _ in characteristic_polynomial(plant.A).factor()] if plant.n else []
    for s in sets:
        names = [plant.names[i] for i in s]
        for p in modes:
            if pencil_rank(plant, names, p.monic()).rank < plant.n:
                found.setdefault(p.monic(), set()).add(s)
    return found


def cause(because: str, names: tuple[str, ...]) -> Sets:
    """The sets s of which a text says that their pencils lose rank."""
    found: Sets = []
    for said in because.split(", or ") if because else []:
        if said == "no channel controls it":
            found.append(())
        elif said == "no channel observes it":
            found.append(tuple(range(len(names))))
        else:
            listed = re.search(r"channels? ([^ ]+(?:, [^ ]+)*) do(?:es)? not observe it", said)
            assert listed, said
            found.append(tuple(names.index(name) for name in listed[1].split(", ")))
    return found


def disagreements(plant: ParametricSystem, account: Any, at: Point) -> list[str]:
    """What is said of a point and is not so; account is of an analysis of the plant."""
    try:
        there = plant.at(dict(at))
    except InputError:
        return _undefined(account, at)
    wrong = []
    said = {each.template.label: str(each) for each in account.sentences.at("table")}
    for name, sets in LOST.items():
        modes = pencil_modes(there, sets(plant.m))
        wrong += _rows(name, account.rows(name), modes, plant.names, at)
        text = said[LABELS[name]]
        clean = text.startswith(("none", "every mode")) and not holds(_behind(text), at)
        if clean != (not modes) and not _beyond(account, name, at):
            wrong.append(f"{LABELS[name]}: {text}, at {dict(at)}: {list(map(str, modes))}")
    wrong += _structure(account, said, analyze(there), at)
    return wrong


def _behind(text: str) -> str:
    """The conditions of a sentence."""
    return re.split(r" unless | where ", text)[-1] if re.search(" unless | where ", text) else ""


def _undefined(account: Any, at: Point) -> list[str]:
    """Every question has a row that says that an entry is undefined there."""
    return [
        f"{name}: nothing is said to be undefined at {dict(at)}"
        for name in account.answers
        if not name.startswith("box_")
        and not any(
            what == "undefined" and holds(where, at) for where, what, _ in account.rows(name)
        )
    ]


def _beyond(account: Any, name: str, at: Point) -> bool:
    """Whether nothing is decided there."""
    rows = account.rows(name)
    return any(what == "not decided" and holds(where, at) for where, what, _ in rows)


def _rows(
    name: str, rows: Any, modes: Mapping[Any, set[Any]], names: tuple[str, ...], at: Point
) -> list[str]:
    """What rows about modes say that is not so at a point."""
    wrong = []
    for where, what, because in rows:
        always = where.startswith(("every ", "almost all"))
        if what == "undefined" and holds(where, at):
            wrong.append(f"{name}: {where} is undefined, at {dict(at)}")
        if what in ("undefined", "not decided") or not (always or holds(where, at)):
            continue
        polynomial, _, scale = what.partition(", divided by ")
        if "such as" in what or polynomial.startswith("a mode"):
            told = set(modes)
        else:
            told = _roots(polynomial.removeprefix("the roots of "), scale or "1", at)
        if not told or not told <= modes.keys():
            wrong.append(f"{name}: {what} where {where}, at {dict(at)}: {list(map(str, modes))}")
        for s in cause(because, names):
            if not any(s in modes.get(p, ()) for p in told):
                wrong.append(f"{name}: {because} where {where}, at {dict(at)}")
        wrong += _example(name, what, at, modes)
    return wrong


def _example(name: str, what: str, at: Point, modes: Mapping[Any, set[Any]]) -> list[str]:
    """That the modes of an example are lost, at its own point."""
    found = re.search(r"such as (.*) at (.*)", what)
    if not found:
        return []
    point = {key: Fraction(v) for key, v in (each.split(" = ") for each in found[2].split(", "))}
    if point != dict(at):
        return []
    told = {p for text in found[1].split(", ") for p in _roots(text, "1", at)}
    return [] if told <= modes.keys() else [f"{name}: {what}"]


def _roots(text: str, scale: str, at: Point) -> set[Polynomial]:
    """The irreducible factors of a polynomial in x whose coefficients depend on parameters."""
    import sympy

    x = sympy.Symbol("x")
    numbers = {name: sympy.Rational(v.numerator, v.denominator) for name, v in at.items()}
    p = sympy.Poly(sympy.sympify(text.replace("^", "**")).subs(numbers), x)
    listed = [Fraction(int(c.p), int(c.q)) for c in reversed(p.all_coeffs())]
    scaled = Polynomial.from_coefficients(listed).scale(value_at(scale, at))
    return {q.monic() for q, _ in scaled.factor()}


def _structure(account: Any, said: Mapping[str, str], there: Any, at: Point) -> list[str]:
    """What is said of completeness, set-points, indices and edges that is not so at a point."""
    wrong = []

    def compare(label: str, name: str, claimed: object, found: object, equal: bool = True) -> None:
        if (claimed == found) is not equal and not _beyond(account, name, at):
            wrong.append(f"{label}: {said[label]}, at {dict(at)}: {found}")

    text = said["complete"]
    yes = text.startswith("yes") and not holds(_behind(text), at)
    compare("complete", "completeness", yes, there.completeness.complete)
    text = said["set-points"]
    yes = text.startswith("every") and not holds(_behind(text), at)
    compare("set-points", "setpoint", yes, there.setpoint.solvable)
    for kind in ("controllability", "observability"):
        label, name = f"{kind} indices", f"{kind}_indices"
        told = re.match(r"(?:\d+(?:, )?)*", said[label])
        listed = [int(k) for k in re.findall(r"\d+", told[0])] if told else []
        found = [k for k in getattr(there, name).indices if k]
        compare(label, name, listed, found, not holds(_behind(said[label]), at))
    edges, *lost = said["transfer graph"].partition(", for ")[0].split("; ")
    kept = {(j, i) for j, i in re.findall(r"(\w+) -> (\w+)", edges)}
    for each in lost:
        (pair,) = re.findall(r"(\w+) -> (\w+) vanishes", each)
        if holds(_behind(each), at):
            kept.discard(pair)
    compare("transfer graph", "transfer_graph", kept, set(there.transfer_graph.arcs))
    return wrong
