"""Forgeries about loops whose inputs are cut off at their limits."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

from tests.checker.handmade import certificate, changed, matrix, plant
from tests.checker.performance_plants import form, static
from tests.checker.saturation_plants import (
    CUT,
    DOUBLED,
    EXACT,
    EXACT_NEAR,
    NEAR,
    RISEN,
    SIZED,
    UNMOVED,
    held,
)
from tests.oracle.drawn.plants import Document, number

from .performance import other_form, other_gain

Forged = Document | None


def everywhere(rng: random.Random, document: Document) -> Forged:
    """A region left out, with the form of the region as witness, perhaps with sectors from 0 on."""
    region = document["claim"].pop("region", None)
    if region is None:
        return None
    witness = document["witness"]
    witness["P"] = region["P"]
    if rng.random() < 0.7:
        witness["sectors"] = [0] * len(witness["sectors"])
    return document


def other_limits(rng: random.Random, document: Document) -> Forged:
    """Limits that do not contain 0, are narrower, or are those of another input, or none."""
    limits = document["claim"]["limits"]
    own = [each for each in limits if each]
    if not own:
        return None
    pairs, what = rng.choice(own), rng.randrange(4)
    k = rng.randrange(len(pairs))
    if what == 0:
        pairs[k] = rng.choice(([1, 2], [-2, -1], [1, -1], [0, 0], [-1], [-1, 0, 1]))
    elif what == 1 and pairs[k] is not None:
        by = Fraction(rng.choice(("1/2", "9/10", "1/100")))
        pairs[k] = [number(Fraction(x) * by) for x in pairs[k]]
    elif what == 2:
        pairs[k] = None if pairs[k] is not None else [-1, 1]
    else:
        rng.shuffle(limits)
    return document


def other_windup(rng: random.Random, document: Document) -> Forged:
    """Other anti-windup gains: negated, none, much larger, or of the shape of another agent."""
    gains = document["claim"]["back_calculation"]
    used = [L for L in gains if any(map(any, L["entries"]))]
    what = rng.randrange(4)
    if what == 3:
        rng.shuffle(gains)
        return document
    wide = [L for L in gains if any(L["entries"])]
    if not wide:
        return None
    L = rng.choice(used or wide)
    by = (-1, 0, 20)[what]
    L["entries"] = [[by * x if x else by for x in row] for row in L["entries"]]
    return document


def other_region(rng: random.Random, document: Document) -> Forged:
    """A larger ellipsoid or ball, or sectors that the inputs leave or that end elsewhere."""
    region: Any = document["claim"].get("region")
    witness, what = document["witness"], rng.randrange(5)
    if what == 0:
        witness["sectors"] = [rng.choice((0, "1/2", 1, -1, 2)) for _ in witness["sectors"]]
        return document
    if region is None:
        if "P" not in witness:
            return None
        document["claim"]["region"] = {"P": witness["P"], "radius": rng.choice((1, "1/1000"))}
        if rng.random() < 0.7:
            del witness["P"]
        return document
    if what == 1:
        region["radius"] = number(Fraction(region["radius"]) * rng.choice((2, 10, -1)))
    elif what == 2:
        region["P"]["exponents"] = [e - rng.choice((1, 4)) for e in region["P"]["exponents"]]
        by = rng.choice((Fraction(1, 4), Fraction(1, 256), Fraction(1)))
        witness["scaling"] = [number(Fraction(x) * by) for x in witness["scaling"]]
    elif what == 3:
        region["P"]["entries"] = [-x for x in region["P"]["entries"]]
    else:
        witness["P"] = region["P"]
    return document


def other_scaling(rng: random.Random, document: Document) -> Forged:
    """A scaling that hides an input, or is missing for one."""
    witness = document["witness"]
    if rng.random() < 0.3 and witness["scaling"]:
        k = rng.randrange(len(witness["scaling"]))
        del witness["scaling"][k], witness["sectors"][k]
        return document
    witness["scaling"] = [rng.choice((0, -1, 1, "1/64")) for _ in witness["scaling"]]
    return document


def behind_samples(rng: random.Random, _: Document) -> Forged:
    """Exact samples, to fewer decimals, in another time, or behind other constructions."""
    document = changed(rng.choice((EXACT, EXACT_NEAR)))
    steps, what = document["subject"], rng.randrange(4)
    if what == 0:
        steps[0]["decimals"] = rng.randrange(3)
    elif what == 1:
        steps[0]["step"] = rng.choice(("1/4", 1, 2))
    else:
        place = rng.choice((0, 1, 1, 1))
        between: list[list[Document]] = [
            [{"construction": "dual"}] * 2,
            [{"construction": "restricted", "channels": ["1"]}],
            [{"construction": "feedback", "gains": [matrix([rng.choice((0, 0, 1, -1))])]}],
        ]
        steps[place:place] = rng.choice(between)
    return document


SATURATED = (
    behind_samples,
    everywhere,
    other_limits,
    other_windup,
    other_region,
    other_scaling,
    other_form,
    other_gain,
)

# x' = u with u = -x: with u cut off, what is far away does not fall exponentially.
DRIFTING = plant([[0]], ([[1]], [[1]]))
# x' = x + u/10, sampled every 1/2: 1.6 x + 0.1 u to one decimal, where 1.649 x + 0.065 u is exact.
# With u = -9x besides, 0.7 x falls, and exactly 1.065 x rises.
WEAK = plant([[1]], ([["1/10"]], [[1]]))
SAMPLES, IDLE = held(WEAK, 1, 0)
TRAPS: dict[str, Document] = {
    "an unstable plant that is held from everywhere": certificate(
        "saturation",
        UNMOVED,
        {"limits": [[[-1, 1]]], "back_calculation": [matrix()]},
        {"scaling": [1], "sectors": [0], "P": form([-1])},
        static(UNMOVED, 0),
    ),
    "limits that do not contain 0": changed(CUT, ("claim.limits", [[[1, 2]]])),
    "a region in which an input leaves its sector": changed(
        NEAR, ("claim.limits", [[["-1/2", 1]]])
    ),
    "a region in which an input leaves its sector below": changed(
        RISEN, ("claim.limits", [[["-1/2", 5]]])
    ),
    "states that are not in the region": changed(NEAR, ("claim.region.radius", 1)),
    "a sector from 3/4 on without a region": certificate(
        "saturation",
        DOUBLED,
        {"limits": [[[-1, 1]]], "back_calculation": [matrix()]},
        {"scaling": ["24/5"], "sectors": ["3/4"], "P": form([4])},
        static(DOUBLED, -2),
    ),
    "an integrator that is cut off": certificate(
        "saturation",
        DRIFTING,
        {"limits": [[[-1, 1]]], "back_calculation": [matrix()]},
        {"scaling": [2], "sectors": [0], "P": form([1])},
        static(DRIFTING, -1),
    ),
    "exact samples behind a feedback that their rounding is multiplied by": certificate(
        "saturation",
        WEAK,
        {"limits": [[[-1, 1]]], "back_calculation": [matrix()], "exact": True},
        {"scaling": ["1/4"], "sectors": [0], "P": form([1])},
        SAMPLES,
        {"construction": "feedback", "gains": [matrix([-9])]},
        IDLE,
    ),
    "exact samples, said with 1": changed(EXACT, ("claim.exact", 1)),
    "a size below 0": changed(SIZED, ("claim.region.sizes", ["-1/2"])),
}
