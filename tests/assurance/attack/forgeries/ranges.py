"""Forgeries about all values within ranges of parameters."""

from __future__ import annotations

import contextlib
import random
from collections.abc import Callable
from fractions import Fraction

from mcexact.checker.discs import Box
from tests.checker.box_maker import in_cells
from tests.oracle.drawn.boxes import beside_crossing, beside_failure, proof_in_cells, vanishing
from tests.oracle.drawn.plants import Document, number

from . import boxes

Forged = Document | None
Forger = Callable[[random.Random, Document], Forged]
QUARTERS = (0, 0, None, None, 0, None, None)
"""The cuts of a cell into four."""


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
    """Inputs or outputs vanish at one value: in a range, maybe irrational, or at or by its end."""
    name = rng.choice(sorted(document["system"]["parameters"]))
    power = rng.choice((1, 1, 2))
    low, high = (Fraction(end) ** power for end in document["system"]["parameters"][name]["range"])
    near = rng.choice((-1, 0, 1)) * Fraction(1, 10**6)
    drawn = low + (high - low) * Fraction(rng.randint(0, 97), 97)
    vanishes = vanishing(name, rng.choice((low, high, drawn)) + near, power)
    channels = document["system"]["channels"]
    for channel in rng.choice((channels, [rng.choice(channels)])):
        for row in channel[rng.choice("BC")]:
            row[:] = [vanishes if entry else 0 for entry in row]
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


def failing_once(rng: random.Random, document: Document) -> Forged:
    """Channel 1 fails at one value, and the cells around it have the evidence of others."""
    kind = document["kind"]
    system, cuts = beside_failure(rng)
    last, power = Fraction(1), rng.choice((1, 2))
    if rng.random() < 0.5:
        cuts = rng.choice(([0, *QUARTERS, *QUARTERS], [0, *QUARTERS, None], [0, None, *QUARTERS]))
        last = Fraction(rng.randint(75, 100), 100)
    near = rng.choice((-1, 0, 0, 1)) * Fraction(1, 10**6)
    claim, made, steps = proof_in_cells(rng, kind, system["time"])
    fails = vanishing("t", last**power + near, power)
    system["channels"][0] |= {"C": [[fails, 0]]} if steps else {"B": [[fails], [0]]}
    found: list[Document] = []

    def made_or_taken(box: Box) -> Document:
        with contextlib.suppress(ArithmeticError):
            found.append(made(box))
        return rng.choice(found[-1:] or document["witness"]["parts"])

    return in_cells(system, kind, claim, cuts, made_or_taken, *steps)


def entry_crossing(rng: random.Random, document: Document) -> Forged:
    """A state decays at the middle of a range, and grows at one of its ends."""
    name = rng.choice(sorted(document["system"]["parameters"]))
    low, high = map(Fraction, document["system"]["parameters"][name]["range"])
    A = document["system"]["A"]
    k = rng.randrange(len(A))
    decay, steep = rng.choice((1, 2)), rng.choice((-40, 12, 40))
    last = -decay - steep * (low + high) / 2
    A[k][k] = (
        f"{steep}*{name} {'-' if last < 0 else '+'} {abs(last)}" if last else f"{steep}*{name}"
    )
    return document


def growing_once(rng: random.Random, document: Document) -> Forged:
    """A state decays but at one value, near which it may grow a little."""
    name = rng.choice(sorted(document["system"]["parameters"]))
    low, high = map(Fraction, document["system"]["parameters"][name]["range"])
    where = low + (high - low) * Fraction(rng.randint(1, 99), 100)
    steep, most = rng.choice((1, 4, 40)), rng.choice((0, Fraction(1, 10**6)))
    last = most - steep * where**2
    A = document["system"]["A"]
    k = rng.randrange(len(A))
    square = f"-{steep}*{name}^2" if steep > 1 else f"-{name}^2"
    A[k] = [0] * len(A)
    A[k][k] = f"{square} + {2 * steep * where}*{name} {'-' if last < 0 else '+'} {abs(last)}"
    return document


def crossing_once(rng: random.Random, document: Document) -> Forged:
    """An eigenvalue reaches the border at one value, or by a millionth not."""
    last = rng.choice((Fraction(1), Fraction(rng.randint(75, 100), 100)))
    return beside_crossing(rng, last + rng.choice((-1, 0, 0, 1)) * Fraction(1, 10**6))


def of_a_part(forger: Forger) -> Forger:
    """A forgery of the evidence about one cell, as of a box."""

    def forged(rng: random.Random, document: Document) -> Forged:
        part = rng.choice(document["witness"]["parts"])
        return document if forger(rng, {**document, "witness": part}) else None

    return forged


ANY = (range_grown, entry_steeper, cells_left_out, bound_moved)
RANGED = (failing_once, *ANY, cell_weakened)
STABLE = (
    *ANY,
    entry_crossing,
    crossing_once,
    growing_once,
    boxes.gain_radii_grown,
    *map(
        of_a_part,
        (
            boxes.matrix_cleared,
            boxes.weights_changed,
            boxes.weights_scaled,
            boxes.leaves_exchanged,
            boxes.border_cut_off,
            boxes.gap_between_points,
        ),
    ),
)
