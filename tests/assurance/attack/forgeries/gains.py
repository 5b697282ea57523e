"""Forgeries about gains for single channels, and exceptional gains."""

from __future__ import annotations

import random

from tests.oracle.certificates import algebra
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.reading import polynomial
from tests.oracle.drawn.plants import Document

from .modes import cut_off, other_discs
from .writing import PRIME, coefficients, drawn, drawn_gains, unit, zeros

Forged = Document | None


def no_gains(rng: random.Random, document: Document) -> Forged:
    """Gains exist, and are denied by a cut that cuts nothing off."""
    system, claim = subject_of(document), document["claim"]
    if not system.m:
        return None
    sides = ["controllable", "observable"] if claim["property"] == "both" else [claim["property"]]
    q = rng.choice(system.names)
    if rng.random() < 0.2:
        claim["channels"] = [name for name in system.names if name != q]
    chosen = [name for name in system.names if rng.random() < 0.6]
    sources = rng.choice((list(system.names), [q], [], chosen))
    claim |= {
        "exists": False,
        "cyclic": rng.random() < 0.1,
        "indices": rng.choice((None, None, [])),
    }
    document["witness"] = {
        "channel": q,
        "side": rng.choice(sides),
        "zero": cut_off(system.n, sources, whole=rng.random() < 0.5),
    }
    return document


def nothing_cut_off(rng: random.Random, document: Document) -> Forged:
    """Gains exist, and are denied by a cut around one channel through which everything leaks."""
    system, claim = subject_of(document), document["claim"]
    if not claim["exists"] or system.m < 2 or not claim["channels"]:
        return None
    q, side = rng.choice(claim["channels"]), claim["property"]
    side = rng.choice(("controllable", "observable")) if side == "both" else side
    claim |= {"exists": False, "cyclic": False, "indices": None}
    zero = cut_off(system.n, [q], whole=True)
    document["witness"] = {"channel": q, "side": side, "zero": zero}
    return document


def asked_elsewhere(rng: random.Random, document: Document) -> Forged:
    """What is out of reach of one channel, said of others."""
    system, claim = subject_of(document), document["claim"]
    if claim["exists"] or not system.m:
        return None
    claim["channels"] = [name for name in system.names if rng.random() < 0.5]
    if rng.random() < 0.3:
        document["witness"]["channel"] = rng.choice(system.names)
    if rng.random() < 0.2:
        claim["cyclic"] = True
    return document


def larger_index(rng: random.Random, document: Document) -> Forged:
    """An index more than there is, shown by a row of zeros or by any row."""
    claim, witness = document["claim"], document["witness"]
    if not claim["exists"] or not claim["indices"]:
        return None
    a = rng.randrange(len(claim["indices"]))
    b = rng.randrange(len(claim["indices"][a]))
    claim["indices"][a][b] += 1
    n = subject_of(document).n
    row = zeros(1, n) if rng.random() < 0.6 else drawn(rng, 1, n, 1)
    witness["annihilators"][a][b] = row
    return document


def not_cyclic(rng: random.Random, document: Document) -> Forged:
    """A_F said to be cyclic, with any generator or none."""
    claim, n = document["claim"], subject_of(document).n
    claim["cyclic"] = not claim["cyclic"]
    generator = rng.choice((None, drawn(rng, n, 1), zeros(n, 1)))
    if claim["exists"]:
        document["witness"]["generator"] = generator
    return document


def without_gains(rng: random.Random, document: Document) -> Forged:
    """Gains that reach nothing: zeros, with the indices that another certificate has."""
    system, claim = subject_of(document), document["claim"]
    if not claim["exists"]:
        n, sides = system.n, 2 if claim["property"] == "both" else 1
        claim |= {"exists": True, "indices": [[n] * sides for _ in claim["channels"]]}
        rows = [[unit(1) | {"entries": [[1] * n]} for _ in range(sides)] for _ in claim["channels"]]
        document["witness"] = {"gains": drawn_gains(rng, system), "modulus": PRIME}
        document["witness"] |= {"annihilators": rows, "generator": None}
        return document
    document["witness"]["gains"] = [
        zeros(B.ncols(), C.nrows()) for B, C in zip(system.B, system.C, strict=True)
    ]
    return document


def extra_root(rng: random.Random, document: Document) -> Forged:
    """A value of g where no rank is lost, with a row that annihilates nothing."""
    claim, witness = document["claim"], document["witness"]
    n = subject_of(document).n
    if not n:
        return None
    a = rng.randint(-3, 3)
    p = polynomial(claim["polynomial"]) * (algebra.X - a)
    claim["polynomial"] = coefficients(p)
    claim["roots"].append({"re": str(a), "im": "0", "radius": "0"})
    pivot = rng.randrange(n)
    row = [[int(j == pivot) for j in range(n)]]
    witness["factors"].append(
        {
            "polynomial": [-a, 1],
            "row": {"denominator": 1, "coefficients": [row]},
            "pivot": pivot,
        }
    )
    return document


def root_left_out(rng: random.Random, document: Document) -> Forged:
    """A value of g where rank is lost is left out of the claim, the witness, or both."""
    claim, witness = document["claim"], document["witness"]
    if not witness["factors"]:
        return None
    kept = [f for f in witness["factors"] if rng.random() < 0.5]
    product = algebra.ONE
    for f in kept:
        product *= polynomial(f["polynomial"])
    claim["polynomial"] = coefficients(product)
    claim["roots"] = claim["roots"][: product.degree()]
    if product == 1:
        claim["roots"] = []
    if rng.random() < 0.5:
        witness["factors"] = kept
    return document


def hidden_root(rng: random.Random, document: Document) -> Forged:
    """No root at all: the first determinant is 0, and ℓ makes the second one constant."""
    claim, witness = document["claim"], document["witness"]
    denominators = [
        int(polynomial(claim["polynomial"])[k].q) for k in range(len(claim["polynomial"]))
    ]
    primes = [ell for ell in (2, 3, 5, 7) if any(d % ell == 0 for d in denominators)]
    if primes:
        witness["modulus"] = rng.choice(primes)
    claim |= {"polynomial": [1], "roots": []}
    witness["factors"] = []
    rows = witness["compressions"][0]["entries"]
    witness["compressions"][0]["entries"] = [[0] * len(row) for row in rows]
    return document


def more_blocks(rng: random.Random, document: Document) -> Forged:
    """More or fewer blocks than the claim was about."""
    claim, system = document["claim"], subject_of(document)
    k = claim["blocks"] + rng.choice((-1, 1, 1))
    width = system.inputs().ncols()
    claim["blocks"] = k
    shapes = [drawn(rng, max(k, 0) * width, system.n, 5) for _ in range(2)]
    document["witness"]["compressions"] = shapes
    return document


def discs_elsewhere(rng: random.Random, document: Document) -> Forged:
    """Other discs for the exceptional gains."""
    other_discs(rng, document["claim"]["roots"])
    return document


SINGLE = (no_gains, nothing_cut_off, asked_elsewhere, larger_index, not_cyclic, without_gains)
EXCEPTIONAL = (extra_root, root_left_out, hidden_root, more_blocks, discs_elsewhere)
