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
