"""Sentences about plants nearby of which an answer is another one.

A certificate about a plant nearby is of the kind ``pencil_rank``: rank P_s < n at the roots of a
polynomial, so that these are fixed modes there.  Its name says what the plant lacks: it cannot be
stabilized, has a fixed mode, or has a mode that all channels together do not control or observe.
How far the plant is, and whether rounding errors or digits that were not typed explain that, is
``given``; the checker computes it from both plants.

What the data allow leads the answer.  Where that is a fixed mode, the same mode's row about all
channels together stands in the table, and so does what only lies within 10⁻⁶ of every entry.
"""

from __future__ import annotations

from mcexact.answer.analysis import Said
from mcexact.answer.sentence import Claim, Context, Rulebook
from mcexact.answer.templates import Template

LOST = ("unstable", "fixed", "uncontrollable", "unobservable")
"""What a plant nearby lacks, by the names of answers about it behind ``nearby_``."""
_FIXED = "evidence.loop_rank_pencil, dynamic_controllers.fixed_dynamic"
_WHAT = {
    "unstable": ("has the fixed {p:noun} {p:about} and cannot be stabilized", _FIXED),
    "fixed": ("has the fixed {p:noun} {p:about}", _FIXED),
    "uncontrollable": (
        "has the {p:noun} {p:about}, which all channels together do not control",
        "joint_controllability.controllable_hautus",
    ),
    "unobservable": (
        "has the {p:noun} {p:about}, which all channels together do not observe",
        "joint_controllability.observable_hautus",
    ),
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

NEARBY_RULES = Rulebook()


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
