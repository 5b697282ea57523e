"""Forgeries about the damping ratio and the largest modulus of a loop."""

from __future__ import annotations

import random
from typing import Any

from tests.oracle.certificates.constructions import subject_of
from tests.oracle.drawn.plants import Document

from .writing import unit

Forged = Document | None
LIMITS = ("damping", "largest_modulus")


def _form(k: int) -> dict[str, Any]:
    return {"P": unit(k), "R": unit(k), "R2": unit(k)}


def stricter_limit(rng: random.Random, document: Document) -> Forged:
    """A limit that the loop does not keep, that is none, or that belongs to no such claim."""
    key = rng.choice(LIMITS)
    values = (0, 1, "1/2", "99/100", "1/1000", -1, None, 2, 1000, "3/5")
    document["claim"][key] = rng.choice(values)
    for block in document["witness"].get("blocks", []):
        if rng.random() < 0.8 and isinstance(block.get("size"), int):
            block.setdefault(key, _form(block["size"] * (2 if key == "damping" else 1)))
    return document


def limit_left_out(rng: random.Random, document: Document) -> Forged:
    """A claim with a limit whose evidence is missing, or evidence without its claim."""
    given = [key for key in LIMITS if key in document["claim"]]
    if not given:
        return None
    key, blocks = rng.choice(given), document["witness"].get("blocks", [])
    if rng.random() < 0.5:
        del document["claim"][key]
        for block in blocks if rng.random() < 0.5 else []:
            block.pop(key, None)
        return document
    for block in blocks:
        block.pop(key, None)
    return document


def another_side(rng: random.Random, document: Document) -> Forged:
    """Evidence about the matrix of one side of a region that is given for another side."""
    witness, given = document["witness"], [key for key in LIMITS if key in document["claim"]]
    if witness["method"] == "instability":
        witness["side"] = rng.choice(("bound", *LIMITS, "rate"))
        return document
    if not given or not witness.get("blocks"):
        return None
    block = rng.choice(witness["blocks"])
    rate = {key: block[key] for key in ("P", "R", "R2")}
    block[rng.choice(given)] = rng.choice((rate, _form(block["size"]), _form(2 * block["size"])))
    return document


def undamped_rotation(rng: random.Random, document: Document) -> Forged:
    """A loop of a small damping ratio, said to have a large one by the form of its rate alone."""
    if document["system"]["time"] == "discrete":
        return None
    document["subject"], w = [], rng.choice((1, 2, 10))
    ports = {"B": [[], []], "C": {"shape": [0, 2], "entries": []}}
    A = [[-1, w], [-w, -1]]
    document["system"] = {
        "time": "continuous",
        "A": A,
        "channels": [{"name": "1", **ports}],
    }
    key, limit = rng.choice((("damping", "3/4"), ("damping", "1/2"), ("largest_modulus", 2)))
    document["claim"] = {"bound": None, "stable": True, key: limit}
    size = rng.choice((2, 4))
    block = {"size": 2, **_form(2), key: _form(size)}
    witness = {"method": "lyapunov", "transformation": None, "blocks": [block]}
    document["witness"] = rng.choice((witness, {"method": "polynomial"}))
    return document if subject_of(document).n == 2 else None


REGIONS = (stricter_limit, limit_left_out, another_side, undamped_rotation)
