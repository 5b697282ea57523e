"""What every plant within the radii of entries may be, or have."""

from __future__ import annotations

from typing import Literal

Property = Literal["no fixed mode", "stabilizable", "controllable", "observable"]

PROPERTIES: dict[str, Property] = {
    "box_fixed_modes": "no fixed mode",
    "box_stabilizability": "stabilizable",
    "box_controllability": "controllable",
    "box_observability": "observable",
}
"""What every plant within the radii is, or has, where these questions are answered by yes."""


def question_about(wanted: Property) -> str:
    """The question whether every plant within the radii has a property.

    Examples
    --------
    >>> question_about("stabilizable")
    'box_stabilizability'
    """
    return next(question for question, each in PROPERTIES.items() if each == wanted)
