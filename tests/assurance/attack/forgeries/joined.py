"""Fixed modes as one factor whose polynomial is reducible: a claim that is true, and odd."""

from __future__ import annotations

import itertools
import math
import random
from typing import Any

from flint import fmpq_poly

from tests.oracle.certificates.reading import polynomial
from tests.oracle.drawn.plants import Document

from .writing import coefficients

SAME = ("channels", "rank", "multiplicity_in_A")


def factors_joined(rng: random.Random, document: Document) -> Document | None:
    """Two factors that lose the same rank to the same channels, by one subspace for both."""
    claim, spaces = document["claim"], document["witness"]["subspaces"]
    factors = claim["factors"]
    able = [
        (j, k)
        for j, k in itertools.combinations(range(len(factors)), 2)
        if all(factors[j][key] == factors[k][key] for key in SAME)
        and ("dual" in spaces[j]) == ("dual" in spaces[k])
        and "pivots" in _shrunk(spaces[j])
        and _shrunk(spaces[j])["pivots"] == _shrunk(spaces[k]).get("pivots")
    ]
    if not able:
        return None
    j, k = rng.choice(able)
    first, second = factors[j], factors[k]
    p, q = polynomial(first["polynomial"]), polynomial(second["polynomial"])
    _, s, t = p.xgcd(q)  # t q is 1 modulo p and 0 modulo q
    factors[j] = first | {
        "polynomial": coefficients(p * q),
        "multiplicity_at_most": min(each["multiplicity_at_most"] for each in (first, second)),
        "stable": first["stable"] and second["stable"],
        "roots": [*first["roots"], *second["roots"]],
    }
    for key in ("U", "V"):
        pair = zip(*(_rows(_shrunk(spaces[each])[key]) for each in (j, k)), strict=True)
        joined = [
            [(a * t * q + b * s * p) % (p * q) for a, b in zip(*rows, strict=True)] for rows in pair
        ]
        _shrunk(spaces[j])[key] = _written(joined)
    del factors[k], spaces[k]
    return document


def _shrunk(space: Document) -> Document:
    """The shrunk subspace of a loss of rank, perhaps that of the dual system."""
    found: Document = space.get("dual", space)
    return found


def _rows(value: Document) -> list[list[fmpq_poly]]:
    """The entries of a polynomial matrix."""
    layers, d = value["coefficients"], value["denominator"]
    rows = zip(*layers, strict=True)
    return [[fmpq_poly(list(entry)) / d for entry in zip(*row, strict=True)] for row in rows]


def _written(rows: list[list[fmpq_poly]]) -> Document:
    """A polynomial matrix over its least denominator."""
    entries = [p for row in rows for p in row]
    d = math.lcm(1, *(int(p.denom()) for p in entries))
    length = max(1, *(p.degree() + 1 for p in entries)) if entries else 1
    layers: Any = [[[int((p * d)[k]) for p in row] for row in rows] for k in range(length)]
    return {"denominator": d, "coefficients": layers}
