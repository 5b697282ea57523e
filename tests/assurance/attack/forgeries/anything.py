"""Forgeries from scratch: claims drawn at random, witnesses drawn, stolen or made to fit."""

from __future__ import annotations

import random
from typing import Any

from tests.oracle.drawn.plants import Document

from ..mutators import SMALL_MODULI, at, change_node, change_number, nodes, other_modulus, put


def altered(rng: random.Random, document: Document) -> Document:
    """A false or at least another claim, and a witness that may go with it."""
    for _ in range(rng.choice((1, 1, 2))):
        (change_number if rng.random() < 0.6 else change_node)(rng, document, "claim")
    what = rng.randrange(5)
    if what == 0:
        emptied(rng, document)
    elif what == 1:
        other_modulus(rng, document, SMALL_MODULI)
    elif what == 2:
        resized(rng, document)
    elif what == 3:
        change_number(rng, document, "witness")
    return document


def emptied(rng: random.Random, document: Document) -> None:
    """A list of the witness without entries, or null for an object."""
    found = [p for p, v in nodes(document["witness"], ("witness",)) if isinstance(v, list | dict)]
    if found:
        path = rng.choice(found)
        put(document, path, [] if isinstance(at(document, path), list) else None)


def resized(rng: random.Random, document: Document) -> None:
    """A matrix of the witness with a row or a column more or less."""
    found = [
        p
        for p, v in nodes(document["witness"], ("witness",))
        if isinstance(v, dict) and isinstance(v.get("entries"), list)
    ]
    if not found:
        return
    rows: list[list[Any]] = at(document, rng.choice(found))["entries"]
    width = len(rows[0]) if rows else rng.randint(0, 3)
    what = rng.randrange(4)
    if what == 0 and rows:
        del rows[rng.randrange(len(rows))]
    elif what == 1:
        rows.insert(rng.randint(0, len(rows)), [rng.choice((0, 0, 1)) for _ in range(width)])
    elif what == 2 and width:
        k = rng.randrange(width)
        for row in rows:
            del row[k]
    else:
        for row in rows:
            row.insert(rng.randint(0, width), rng.choice((0, 0, 1)))
