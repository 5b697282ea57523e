"""Documents about boxes made by hand, each false, or written as no certificate is."""

from __future__ import annotations

from tests.checker.box_maker import stable
from tests.checker.box_plants import GAIN_RADII, LOOP_STABLE, STABLE, gains, uncertain
from tests.checker.handmade import certificate, changed, plant, ranged
from tests.checker.parameter_plants import fixed
from tests.checker.parameter_plants import stable as stable_in_ranges
from tests.checker.performance_plants import static
from tests.oracle.drawn.plants import Document

STILL = plant([[1, 0], [0, 2]], ([[0], [0]], [[1, 1]]))
"""Both modes are fixed: the input does nothing."""
TURNING = plant(
    [[-1, -8], [8, -1]], ([[1], [0]], [[1, 0]]), uncertainty=uncertain([[2, 0], [0, 2]])
)
"""Eigenvalues a ± 8i, a from −3 to 1."""
FADING = ranged([[1]], ([["t - 1"]], [[1]]), t=(0, "1/2"))
"""The mode 1 is fixed at t = 1."""
TURNED = ranged([[1]], ([["t^2 - 1/2"]], [[1]]), t=(0, "1/2"))
"""The mode 1 is fixed at the square root of 1/2, between 1/2 and 1."""
RECIPROCAL = ranged([[1]], ([["(t - 3)/(t)"]], [[1]]), t=(1, 1))
"""The mode 1 is fixed at t = 3."""

SPIRAL = ranged([["t - 1", -8], [8, "t - 1"]], ([[1], [0]], [[1, 0]]), t=(-2, 2))
"""Eigenvalues t − 1 ± 8i."""
CALM = ranged([["1/4*t - 2"]], ([[1]], [[1]]), t=(-1, 1))
"""An eigenvalue that stays near −2."""


def exact(rows: list[list[int]]) -> Document:
    """A complex matrix of integers."""
    return {"denominator": 1, "re": rows, "im": [[0] * len(row) for row in rows]}


UNSURE = plant([["1/2"]], ([[1]], [[1]]), time="discrete", uncertainty=uncertain([[1]]))
"""An eigenvalue from −1/2 to 3/2."""


EXCHANGED = {
    "F": None,
    "Y": exact([[0, 1], [1, 0]]),
    "T": exact([[1, 0], [0, 1]]),
    "discs": [{"re": "0", "im": "0", "radius": "-10"}] * 2,
}
TRAPS: dict[str, Document] = {
    "negative radii of rows that are not dominant": certificate(
        "box_fixed",
        STILL,
        {"bound": None},
        {"exterior": [EXCHANGED], "gains": [], "frames": [], "cover": [[], []]},
    ),
    "an eigenvalue that crosses at a segment": changed(
        STABLE, ("system.uncertainty.absolute.A.entries", [[1, 1, "3/2"]])
    ),
    "eigenvalues that cross beyond the last point": stable(TURNING, ["1/2"], growth=[1, 1]),
    "a negative radius of a gain": changed(
        LOOP_STABLE,
        ("claim.gain_radii.agents.0.input.outputs.1", [["-1/100"]]),
    ),
    "radii of gains in another time": changed(
        LOOP_STABLE, ("claim.gain_radii", {**GAIN_RADII, "time": "discrete"})
    ),
    "a margin below 0": certificate(
        "box_stable",
        UNSURE,
        {"bound": None, "gain_radii": None, "disk": {"at": "inputs", "margin": -1000}},
        {
            "nominal": {"method": "polynomial"},
            "points": [1],
            "growth": None,
            "segments": [0, 0],
            "frames": [{"V": exact([[1] * 3] * 3), "w": [[1] * 5]}],
        },
        static(UNSURE, "-1/4"),
    ),
    "a half that nothing is proved of": changed(
        fixed(FADING, [None], [gains((4, 1))]),
        ("system.parameters.t.range", [0, 1]),
        ("witness.cuts", [0, None]),
    ),
    "a half that nothing is proved of, with an irrational value": changed(
        fixed(TURNED, [None], [gains((4, 1))]),
        ("system.parameters.t.range", [0, 1]),
        ("witness.cuts", [0, None]),
    ),
    "a denominator that is 0 in the range": changed(
        fixed(RECIPROCAL, [None], [gains((4, 1))]), ("system.parameters.t.range", [-1, 3])
    ),
    "an eigenvalue that crosses at a value of a parameter": changed(
        stable_in_ranges(CALM, [None], ["1/2", 1, 2, 4, 8], growth=[1]),
        ("system.A.0.0", "4*t - 2"),
    ),
    "eigenvalues that cross beyond the last point at a value": stable_in_ranges(
        SPIRAL, [None], ["1/2"], growth=[1, 1]
    ),
}
