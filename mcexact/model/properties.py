"""The properties that can be proved of every plant within the radii of its entries."""

from __future__ import annotations

from typing import Literal

Property = Literal["no fixed mode", "stabilizable", "controllable", "observable"]

PROPERTIES: dict[str, Property] = {
    "box_fixed_modes": "no fixed mode",
    "box_stabilizability": "stabilizable",
    "box_controllability": "controllable",
    "box_observability": "observable",
}
"""For each question about a box, the property of every plant that the answer yes proves."""


def question_about(wanted: Property) -> str:
    """The question whether every plant within the radii has a property.

    Examples
    --------
    >>> question_about("stabilizable")
    'box_stabilizability'
    """
    return next(question for question, each in PROPERTIES.items() if each == wanted)
