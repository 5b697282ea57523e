"""Forgeries about ranks for all values of a parameter."""

from __future__ import annotations

import random

from tests.oracle.drawn.plants import Document

from .parametric import congruent_value

Forged = Document | None


def value_left_out(rng: random.Random, document: Document) -> Forged:
    """A value at which the rank is less is left out, or called a pole, or out of range."""
    claim, witness = document["claim"], document["witness"]
    if not claim["exceptional"]:
        return None
    k = rng.randrange(len(claim["exceptional"]))
    entry = claim["exceptional"].pop(k)
    witness["exceptional"].pop(k)
    where = rng.randrange(3)
    if where == 1:
        witness["undefined"].append(entry["value"])
    elif where == 2:
        claim["outside"].append({"value": entry["value"], "roots": entry["roots"]})
    return document


def other_rank(rng: random.Random, document: Document) -> Forged:
    """The rank for almost all values, or that at one, is larger or smaller."""
    claim, witness = document["claim"], document["witness"]
    if claim["exceptional"] and rng.random() < 0.6:
        k = rng.randrange(len(claim["exceptional"]))
        entry, kernel = claim["exceptional"][k], witness["exceptional"][k]
        if rng.random() < 0.5 or not kernel["pivots"]:
            entry["rank"] = max(entry["rank"] + rng.choice((1, -1)), 0)
            return document
        entry["rank"] += 1
        kernel["pivots"].pop()
        kernel["columns"]["coefficients"] = [
            [row[:-1] for row in layer] for layer in kernel["columns"]["coefficients"]
        ]
        return document
    claim["rank"] = max(claim["rank"] + rng.choice((1, -1)), 0)
    if rng.random() < 0.5:
        for key in ("rows", "columns"):
            witness[key] = witness[key][: claim["rank"]]
        X, Y = witness["compressions"]
        X["entries"] = X["entries"][: claim["rank"]]
        Y["entries"] = [row[: claim["rank"]] for row in Y["entries"]]
    return document


def value_invented(rng: random.Random, document: Document) -> Forged:
    """The rank is said to be less where it is not, with the kernel of another value."""
    claim, witness = document["claim"], document["witness"]
    at = rng.choice((0, 1, 2, -1))
    entry = {
        "value": [-at, 1],
        "roots": [{"re": str(at), "im": "0", "radius": "0"}],
        "rank": max(claim["rank"] - 1, 0),
    }
    kernels = [k for k in [witness["kernel"], *witness["exceptional"]] if k is not None]
    if not kernels:
        return None
    claim["exceptional"].append(entry)
    witness["exceptional"].append(rng.choice(kernels))
    return document


def other_matrix(rng: random.Random, document: Document) -> Forged:
    """The same evidence about another matrix."""
    matrix = document["claim"]["matrix"]
    names = [channel["name"] for channel in document["system"]["channels"]]
    if matrix["name"] == "transfer":
        matrix[rng.choice(("from", "to"))] = rng.choice(names)
    elif matrix["name"] == "controllability":
        if rng.random() < 0.5:
            matrix["blocks"] = max(matrix["blocks"] + rng.choice((1, -1)), 1)
        else:
            matrix["channels"] = [name for name in names if rng.random() < 0.5]
    elif matrix["name"] == "signal":
        matrix["polynomial"][0] = rng.choice((0, 1, -1, 4))
    else:
        document["claim"]["matrix"] = {"name": "controllability", "channels": names, "blocks": 1}
    return document


def same_minors(rng: random.Random, document: Document) -> Forged:
    """The second minor is the first one, or zero, and a value is left out."""
    witness = document["witness"]
    X, Y = witness["compressions"]
    zero = rng.random() < 0.3
    for i, row in enumerate(witness["rows"]):
        X["entries"][i] = [int(k == row and not zero) for k in range(len(X["entries"][i]))]
    for i in range(len(Y["entries"])):
        Y["entries"][i] = [int(i == c) for c in witness["columns"]]
    return value_left_out(rng, document) or document


RANKS = (
    value_left_out,
    value_left_out,
    congruent_value,
    other_rank,
    other_rank,
    value_invented,
    other_matrix,
    same_minors,
)
