"""Forgeries about all values of a parameter."""

from __future__ import annotations

import random
from typing import Any

from tests.oracle.certificates import algebra
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.drawn.plants import Document

Forged = Document | None


def value_left_out(rng: random.Random, document: Document) -> Forged:
    """An exceptional value is left out, or said to be settled, with all that is fixed there."""
    claim, witness = document["claim"], document["witness"]
    if not claim["exceptional"]:
        return None
    k = rng.randrange(len(claim["exceptional"]))
    entry, proof = claim["exceptional"].pop(k), witness["exceptional"].pop(k)
    modes = [mode["polynomial"] for mode in entry["modes"]]
    if rng.random() < 0.7:
        divisors = rng.choice((modes + proof["divisors"], proof["divisors"], modes))
        witness["settled"].append({"value": entry["value"], "divisors": divisors})
    elif rng.random() < 0.5:
        witness["undefined"].append(entry["value"])
    else:
        claim["outside"].append({"value": entry["value"], "roots": entry["roots"]})
    return document


def congruent_value(rng: random.Random, document: Document) -> Forged:
    """The values are moved by a multiple of the modulus."""
    claim, ell = document["claim"], document["witness"]["modulus"]
    if not claim["exceptional"]:
        return None
    entry = rng.choice(claim["exceptional"])
    if isinstance(entry["value"][0], int):
        entry["value"][0] += rng.choice((ell, -ell))
        entry["roots"] = [
            {**disc, "re": f"{entry['value'][0] * -1}", "im": "0", "radius": "0"}
            for disc in entry["roots"]
        ]
    return document


def mode_left_out(rng: random.Random, document: Document) -> Forged:
    """A mode at a value is left out, or named among the divisors of generic polynomials."""
    claim, witness = document["claim"], document["witness"]
    if not claim["exceptional"]:
        return None
    k = rng.randrange(len(claim["exceptional"]))
    modes, proof = claim["exceptional"][k]["modes"], witness["exceptional"][k]
    j = rng.randrange(len(modes))
    gone = modes.pop(j)
    proof["modes"].pop(j)
    if rng.random() < 0.5:
        proof["divisors"].append(gone["polynomial"])
    return document


def generic_left_out(rng: random.Random, document: Document) -> Forged:
    """A generic polynomial is left out, with its zero block."""
    claim, witness = document["claim"], document["witness"]
    if not claim["generic"]:
        return None
    k = rng.randrange(len(claim["generic"]))
    claim["generic"].pop(k)
    witness["generic"].pop(k)
    return document


def generic_at_one_value(rng: random.Random, document: Document) -> Forged:
    """A mode at one value is said to be fixed for all."""
    claim, witness = document["claim"], document["witness"]
    if not claim["exceptional"]:
        return None
    k = rng.randrange(len(claim["exceptional"]))
    mode = rng.choice(claim["exceptional"][k]["modes"])
    claim["generic"].append(mode["polynomial"])
    witness["generic"].append(witness["exceptional"][k]["modes"][0])
    if rng.random() < 0.5:
        claim["exceptional"].pop(k)
        witness["exceptional"].pop(k)
    return document


def generic_that_agrees_somewhere(rng: random.Random, document: Document) -> Forged:
    """A generic polynomial is changed by what vanishes at some values."""
    claim = document["claim"]
    if not claim["generic"]:
        return None
    p = rng.choice(claim["generic"])
    degree = rng.choice((1, 2, 3))
    p[0] = [*p[0], *[0] * (degree - len(p[0])), rng.choice((1, -1, 2))]
    while p[0] and p[0][-1] == 0:
        p[0].pop()
    return document


def mode_everywhere(rng: random.Random, document: Document) -> Forged:
    """A generic mode is said to be exceptional at a value."""
    claim, witness = document["claim"], document["witness"]
    if not claim["generic"]:
        return None
    k = rng.randrange(len(claim["generic"]))
    p = claim["generic"][k]
    at = rng.choice((0, 1, 2, -1))
    mode = [[sum(c * at**i for i, c in enumerate(part))] for part in p if _whole(part)]
    if len(mode) < len(p):
        return None
    system = subject_of(document)
    T = witness["generic"][k]["channels_T"]
    names = [name for name in system.names if name not in T]
    roots = [{"re": str(at), "im": "0", "radius": "0"}]
    reduced = [[] if c == [0] else c for c in mode]
    claim["exceptional"].append(
        {
            "value": [-at, 1],
            "roots": roots,
            "modes": [{"polynomial": reduced, "channels": names}],
        }
    )
    witness["exceptional"].append(
        {"modes": [_at(witness["generic"][k], at)], "divisors": [reduced]}
    )
    return document


def _whole(part: Any) -> bool:
    return all(isinstance(c, int) for c in part)


def _at(block: Document, t: int) -> Document:
    """A zero block at a value of the parameter, its pivots scaled to 1 if they are integers."""

    def value(M: Document) -> Document:
        layers = M["coefficients"]
        rows = [
            [sum(layer[i][j] * t**k for k, layer in enumerate(layers)) for j in range(len(row))]
            for i, row in enumerate(layers[0])
        ]
        return {"denominator": M["denominator"], "coefficients": [rows]}

    return {**block, "U": [value(M) for M in block["U"]], "W": value(block["W"])}


def small_moduli(rng: random.Random, document: Document) -> Forged:
    """The exact resultant from too few moduli, or from one modulus twice."""
    witness = document["witness"]
    witness["common"] = []
    witness["moduli"] = rng.choice(
        ([], witness["moduli"][:-1], witness["moduli"] * 2, [7], [witness["modulus"]])
    )
    return value_left_out(rng, document) or document


def exact_resultant(rng: random.Random, document: Document) -> Forged:
    """An exact resultant for one modulo the modulus, and another forgery."""
    witness = document["witness"]
    if witness["moduli"]:
        return None
    witness["moduli"], witness["common"] = [2**521 - 1, 2**607 - 1, 2**1279 - 1], []
    other = rng.choice((value_left_out, congruent_value, mode_left_out, other_drawn_gains))
    return other(rng, document)


def divided_too_often(rng: random.Random, document: Document) -> Forged:
    """A value is left out, and what it leaves in the resultant is divided out all the same."""
    claim, witness = document["claim"], document["witness"]
    if not claim["exceptional"] or not witness["common"]:
        return None
    gone = rng.choice(claim["exceptional"])["value"]
    common = witness["common"]
    kept = [each for each in common if each["value"] != gone]
    spare = rng.choice(common)
    ell = witness["modulus"]
    moved = [*gone]
    if isinstance(moved[0], int):
        moved[0] += rng.choice((ell, -ell))
    k = next(k for k, each in enumerate(claim["exceptional"]) if each["value"] == gone)
    claim["exceptional"].pop(k)
    witness["exceptional"].pop(k)
    witness["common"] = rng.choice(
        (
            common,
            kept,
            [*kept, *kept],
            [*kept, {**spare, "value": moved}],
            [{**each, "divisor": spare["divisor"]} for each in common],
            [*kept, {"value": moved, "divisor": [[0, 1], [1]]}],
        )
    )
    if rng.random() < 0.5:
        witness["settled"].append({"value": rng.choice((gone, moved)), "divisors": []})
    return document


def small_prime(rng: random.Random, document: Document) -> Forged:
    """A small modulus, at which resultants lose their degrees and values meet."""
    document["witness"]["modulus"] = rng.choice((2, 3, 5, 7, 11, 101, 6, 15))
    return value_left_out(rng, document) or document


def other_drawn_gains(rng: random.Random, document: Document) -> Forged:
    """Both gains alike, or none, which may leave everything where it is."""
    witness = document["witness"]
    zero = [
        {"denominator": 1, "entries": [[0] * len(row) for row in F["entries"]]}
        for F in witness["gains"][0]
    ]
    witness["gains"] = [rng.choice((zero, *witness["gains"])) for _ in range(3)]
    return value_left_out(rng, document) or document


def pole_invented(rng: random.Random, document: Document) -> Forged:
    """An exceptional value is called a pole, of a power of which it is a factor, or of none."""
    claim, witness = document["claim"], document["witness"]
    system = subject_of(document)
    if not claim["exceptional"]:
        return None
    k = rng.randrange(len(claim["exceptional"]))
    q = claim["exceptional"].pop(k)["value"]
    witness["exceptional"].pop(k)
    poles = [p for p in system.denominators if p.degree() > 0]
    witness["undefined"].append(
        rng.choice([q, *([str(c) for c in algebra.monic(p).coeffs()] for p in poles)])
    )
    return document


PARAMETRIC = (
    value_left_out,
    value_left_out,
    congruent_value,
    mode_left_out,
    generic_left_out,
    generic_at_one_value,
    generic_that_agrees_somewhere,
    mode_everywhere,
    small_moduli,
    exact_resultant,
    divided_too_often,
    divided_too_often,
    small_prime,
    other_drawn_gains,
    pole_invented,
)
