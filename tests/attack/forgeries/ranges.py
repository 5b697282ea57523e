"""Forgeries about all values within ranges of parameters."""

from __future__ import annotations

import random
from fractions import Fraction

from ..draws.plants import Document, number

Forged = Document | None


def range_grown(rng: random.Random, document: Document) -> Forged:
    """A range is many times as wide, or elsewhere."""
    name = rng.choice(sorted(document["system"]["parameters"]))
    said = document["system"]["parameters"][name]
    low, high = map(Fraction, said["range"])
    factor = rng.choice((3, 10, 40))
    said["range"] = [number(low - factor * (high - low)), number(high + factor * (high - low))]
    if rng.random() < 0.3:
        said["range"] = [number(low - 20), number(high - 20)]
    return document


def entry_steeper(rng: random.Random, document: Document) -> Forged:
    """An input or an output depends on a parameter, and vanishes within its range."""
    name = rng.choice(sorted(document["system"]["parameters"]))
    low, high = map(Fraction, document["system"]["parameters"][name]["range"])
    channel = rng.choice(document["system"]["channels"])
    where = low + (high - low) * Fraction(rng.choice((0, 3, 8)), 8)
    vanishing = name if not where else f"{name} {'-' if where > 0 else '+'} {abs(where)}"
    rows = channel[rng.choice("BC")]
    for row in rows:
        row[:] = [vanishing if entry else 0 for entry in row]
    return document


def cells_left_out(rng: random.Random, document: Document) -> Forged:
    """A cell, or the proof of one, is missing, or the cells are others."""
    witness = document["witness"]
    if rng.random() < 0.5 and len(witness["parts"]) > 1:
        del witness["parts"][rng.randrange(len(witness["parts"]))]
    witness["cuts"] = rng.choice(([None], [0], [0, None], [0, None, None], [], [9, None, None]))
    return document


def cell_weakened(rng: random.Random, document: Document) -> Forged:
    """A part has a smaller disc, no tree, or other weights."""
    part = rng.choice(document["witness"]["parts"])
    disc = rng.choice(rng.choice(part["exterior"])["discs"])
    disc["radius"] = rng.choice(("0", "0.01", "-1"))
    if rng.random() < 0.5 and part["frames"]:
        frame = rng.choice(part["frames"])
        frame["w"] = [rng.choice((0, -1, 10**6)) for _ in frame["w"]]
    if rng.random() < 0.5:
        part["cover"][rng.randrange(len(part["cover"]))] = []
    return document


def bound_moved(rng: random.Random, document: Document) -> Forged:
    """The region is another one, or there is none."""
    document["claim"]["bound"] = rng.choice((None, 3, "1/10", -1))
    return document


RANGED = (range_grown, entry_steeper, cells_left_out, cell_weakened, bound_moved)
