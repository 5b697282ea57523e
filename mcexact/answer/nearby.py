"""Sentences about plants nearby of which an answer is another one.

A certificate about a plant nearby is of the kind ``pencil_rank``: rank P_s < n at the roots of a
polynomial, so that these are fixed modes there.  Its name says what the plant lacks: it cannot be
stabilized, has a fixed mode, or has a mode that all channels together do not control or observe.
How far the plant is, and whether rounding errors or digits that were not typed explain that, is
``given``; the checker computes it from both plants.

What the data allow leads the answer.  Where that is a fixed mode, the same mode's row about all
channels together stands in the table, and so does what only lies within 10⁻⁶ of every entry.

``law_1``, … are ranks of pencils at modes of the given plant that equalities between entries fix,
and that all channels together do not observe or control: their null spaces name such equalities.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

from mcexact.answer.analysis import Said
from mcexact.answer.sentence import Claim, Context, Rulebook, Several
from mcexact.answer.templates import Template
from mcexact.exact.linear_algebra import PolynomialMatrix

Lost = Literal["unstable", "fixed", "uncontrollable", "unobservable"]
LOST: tuple[Lost, ...] = ("unstable", "fixed", "uncontrollable", "unobservable")
"""What a plant nearby can be, by the names of answers about it behind ``nearby_``: not
stabilizable, with a fixed mode, or not controllable or not observable by all channels together."""
LACKS: dict[Lost, str] = {
    "unstable": "has the fixed {mode} and cannot be stabilized",
    "fixed": "has the fixed {mode}",
    "uncontrollable": "has the {mode}, which all channels together do not control",
    "unobservable": "has the {mode}, which all channels together do not observe",
}
"""What is said of a plant that lacks something, with a place for its mode."""
_FIXED = "evidence.loop_rank_pencil, dynamic_controllers.fixed_dynamic"
_THEOREMS: dict[Lost, str] = {
    "unstable": _FIXED,
    "fixed": _FIXED,
    "uncontrollable": "joint_controllability.controllable_hautus",
    "unobservable": "joint_controllability.observable_hautus",
}
_WHAT: dict[str, tuple[str, str]] = {
    lost: (said.format(mode="{p:noun} {p:about}"), _THEOREMS[lost]) for lost, said in LACKS.items()
}
_ROUNDING = "This answer depends on rounding errors: a plant within {part:part} of every entry "
_DIGITS = (
    "This answer depends on digits that were not typed: a plant that agrees with all typed digits "
)
_PART = "a plant within {part:part} of every entry "
ROUNDING = {
    lost: Template(f"nearby-{lost}", f"{_ROUNDING}{what}.", theorem)
    for lost, (what, theorem) in _WHAT.items()
}
DIGITS = {
    lost: Template(f"nearby-{lost}-digits", f"{_DIGITS}{what}.", theorem)
    for lost, (what, theorem) in _WHAT.items()
}
PART = {
    lost: Template(f"nearby-{lost}-part", f"{_PART}{what}", theorem, "nearby")
    for lost, (what, theorem) in _WHAT.items()
}
_UNOBSERVED = (
    "{p:right} and C v = 0 for v = {vectors:vectors}",
    "joint_controllability.observable_hautus",
)
_UNCONTROLLED = (
    "{p:left} and w B = 0 for w = {vectors:vectors}",
    "joint_controllability.controllable_hautus",
)
LAWS = {
    "unobserved": Template("law-unobserved", *_UNOBSERVED, "law"),
    "uncontrolled": Template("law-uncontrolled", *_UNCONTROLLED, "law"),
}
NEARLY = {
    "unobserved": Template("nearby-law-unobserved", *_UNOBSERVED, "nearby law"),
    "uncontrolled": Template("nearby-law-uncontrolled", *_UNCONTROLLED, "nearby law"),
}

NEARBY_RULES, LAW_RULES = Rulebook(), Rulebook()


def _has(lost: str, own: Claim) -> bool:
    """Whether the given plant has what one nearby lacks."""
    if lost == "unstable":
        return bool(own.stabilizable)
    return own.polynomial.degree == 0 if lost == "fixed" else bool(own.controllable)


def _leads(lost: str, given: Context) -> bool:
    """Whether the data allow the plant, and no sentence about a fixed mode is before it."""
    nearby = given.nearby
    before = [nearby[each][1] for each in ("unstable", "fixed") if each in nearby]
    own = nearby[lost][1]
    return own is not None and (lost in ("unstable", "fixed") or not any(before))


def _rules(lost: str, question: str) -> None:
    """Make the rules about a plant that lacks something, in the answer and in the table."""
    premises = (f"nearby_{lost}", question)

    @NEARBY_RULES.rule("answer", ROUNDING[lost], DIGITS[lost], premises=premises)
    def _answer(near: Claim, own: Claim, given: Context) -> Said:
        if near.rank < given.n and _has(lost, own) and _leads(lost, given):
            part, within = given.nearby[lost]
            if within == "rounding":
                yield ROUNDING[lost](p=near.polynomial, part=part)
            else:
                yield DIGITS[lost](p=near.polynomial)

    @NEARBY_RULES.rule("table", PART[lost], premises=premises)
    def _row(near: Claim, own: Claim, given: Context) -> Said:
        if near.rank < given.n and _has(lost, own) and not _leads(lost, given):
            yield PART[lost](p=near.polynomial, part=given.nearby[lost][0])


for _lost, _question in zip(
    LOST,
    ("fixed_spectrum", "fixed_spectrum", "joint_controllability", "joint_observability"),
    strict=True,
):
    _rules(_lost, _question)


# Vectors that equalities leave unobserved or uncontrolled.


def _law(rank: Claim, templates: Mapping[str, Template], *, dual: bool) -> Said:
    """The vectors of a pencil of all channels, if they are short."""
    vectors = short_vectors(rank.proof.kernel)
    if vectors:
        template = templates["uncontrolled" if dual else "unobserved"]
        yield template(p=rank.polynomial, vectors=vectors)


@LAW_RULES.rule("table", *LAWS.values(), premises=("law",))
def _laws(laws: Several, given: Context) -> Said:
    for rank in laws.separately():
        yield from _law(rank, LAWS, dual=bool(rank.subject))


@LAW_RULES.rule("table", NEARLY["unobserved"], premises=("nearby_unobservable",))
def _nearly_unobserved(near: Claim, given: Context) -> Said:
    if near.polynomial.degree == 1 and not near.subject:
        yield from _law(near, NEARLY, dual=False)


@LAW_RULES.rule("table", NEARLY["uncontrolled"], premises=("nearby_uncontrollable",))
def _nearly_uncontrolled(near: Claim, given: Context) -> Said:
    if near.polynomial.degree == 1 and near.subject:
        yield from _law(near, NEARLY, dual=True)


_MOST_VECTORS, _LONGEST = 2, 1000


def short_vectors(null_space: PolynomialMatrix) -> tuple[tuple[int, ...], ...]:
    """The columns of a matrix, each times a number such that its entries are short integers.

    Empty if there are many columns, or one has no such multiple.

    Examples
    --------
    >>> from mcexact.exact.matrix import Matrix
    >>> short_vectors(PolynomialMatrix.from_matrices(Matrix.from_rows([["-1/2"], [1]])))
    ((1, -2),)
    """
    M = null_space.matrices[0]
    if len(null_space.matrices) > 1 or M.ncols > _MOST_VECTORS:
        return ()
    columns = []
    for k in range(M.ncols):
        column = [row[k] for row in M.rows()]
        scale = math.lcm(*(x.denominator for x in column))
        scale *= next((-1 if x < 0 else 1 for x in column if x), 1)
        columns.append(tuple(int(scale * x) for x in column))
    return tuple(columns) if all(abs(x) < _LONGEST for v in columns for x in v) else ()
