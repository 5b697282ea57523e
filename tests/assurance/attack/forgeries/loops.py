"""Forgeries about spectra of loops and their stability."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from typing import Any

from flint import fmpq, fmpq_mat

from tests.oracle.certificates.algebra import identity
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.drawn.observers import drawn_observer, late_observer
from tests.oracle.drawn.plants import Document, number

from .regions import REGIONS
from .writing import PRIME, unit, written, zeros

Forged = Document | None


def _moved(value: Any, by: Any) -> Any:
    return number(Fraction(value) + by)


def congruent_coefficient(rng: random.Random, document: Document) -> Forged:
    """A coefficient that is another number, and the same modulo every modulus."""
    witness, claim = document["witness"], document["claim"]
    key = rng.choice([key for key in ("polynomial", "feedback", "error") if key in claim])
    p = claim[key]
    if len(p) < 2:
        return None
    k = rng.randrange(len(p) - 1)
    if rng.random() < 0.5:
        # a single small prime as often as the bound asks for
        ell = rng.choice((2, 3, 5, 7))
        witness["moduli"] = [ell] * rng.randint(1, 60)
        p[k] = _moved(p[k], rng.choice((-ell, ell)))
    elif rng.random() < 0.5:
        p[k] = _moved(p[k], math.prod(witness["moduli"]) * rng.choice((-1, 1)))
    else:
        witness["moduli"] = witness["moduli"][: rng.randint(0, len(witness["moduli"]) - 1)]
        p[k] = _moved(p[k], math.prod(witness["moduli"]) * rng.choice((-1, 1)))
    return document


def other_degree(rng: random.Random, document: Document) -> Forged:
    """A polynomial of another degree."""
    claim = document["claim"]
    key = rng.choice([key for key in ("polynomial", "feedback", "error") if key in claim])
    claim[key] = [0, *claim[key]] if rng.random() < 0.5 else claim[key][1:]
    return document


def _matrix(document: Document) -> fmpq_mat:
    return subject_of(document).A


def _bounds(document: Document) -> tuple[bool, fmpq]:
    """Whether time is continuous, and the bound."""
    continuous = document["system"]["time"] == "continuous"
    bound = document["claim"]["bound"]
    value = Fraction(int(not continuous) if bound is None else bound)
    return continuous, fmpq(value.numerator, value.denominator)


def _stable_block(document: Document, k: int) -> fmpq_mat:
    """A k×k matrix that is stable beyond doubt."""
    continuous, bound = _bounds(document)
    entry = -(bound + 1) if continuous else fmpq(0)
    return fmpq_mat(k, k, [entry if i == j else 0 for i in range(k) for j in range(k)])


def _simple(k: int) -> Document:
    return {"size": k, "P": unit(k), "R": unit(k), "R2": unit(k)}


def another_matrix(rng: random.Random, document: Document) -> Forged:
    """A stable matrix that is not similar to that of the loop, or is by a singular matrix."""
    n = _matrix(document).nrows()
    left = rng.choice((zeros(n, n), unit(n)))
    change = {"T": left, "Delta": written(_stable_block(document, n)), "modulus": PRIME}
    document["claim"]["stable"] = True
    document["witness"] = {"method": "lyapunov", "transformation": change, "blocks": [_simple(n)]}
    return document


def few_blocks(rng: random.Random, document: Document) -> Forged:
    """Blocks that leave states out, or are not those of a triangular matrix, or too many."""
    n = _matrix(document).nrows()
    sizes = rng.choice(([], [1] * n, [1] * rng.randint(0, n), [n], [1] * (n + 1), [0] * 2))
    document["claim"]["stable"] = True
    blocks = [_simple(k) for k in sizes]
    document["witness"] = {"method": "lyapunov", "transformation": None, "blocks": blocks}
    return document


def own_plant(rng: random.Random, document: Document) -> Forged:
    """The matrix of a plant of its own: coupled stable states, or an unstable rotation."""
    document["subject"] = []
    e = rng.choice(("1/2", 1, "1/3"))
    n = 2
    coupled = [[-1, rng.choice((2, 3))], [rng.choice((2, 3)), -1]]
    if document["system"]["time"] == "discrete":
        coupled = [[0, rng.choice((2, 3))], [rng.choice((2, 3)), 0]]
    rotation = [[e, -1], [1, e]]
    A = rng.choice((coupled, rotation, [[-1, 0], [0, -2]], [["1/2", 0], [0, 0]]))
    ports = {"B": [[] for _ in range(n)], "C": {"shape": [0, n], "entries": []}}
    time = document["system"]["time"]
    document["system"] = {"time": time, "A": A, "channels": [{"name": "1", **ports}]}
    document["claim"]["bound"] = None
    made = rng.choice((few_blocks, skew_form, skew_form, falling_form, wrong_verdict))
    return made(rng, document)


def skew_form(rng: random.Random, document: Document) -> Forged:
    """A matrix P that is not symmetric, whose form decreases along unstable trajectories."""
    M = _matrix(document)
    n = M.nrows()
    if not n or M.det() == 0:
        return None
    continuous, _ = _bounds(document)
    document["claim"]["stable"] = True
    K = [[0] * n for _ in range(n)]
    for i in range(n):
        for j in range(i):
            K[i][j] = rng.randint(1, 20)
            K[j][i] = -K[i][j]
    P = identity(n) + fmpq_mat(n, n, [v for row in K for v in row])
    if continuous:
        # P M is −I and a skew part, which is lost in P M + M'P'
        forms = [(sign * (P - identity(n)) - identity(n)) * M.inv() for sign in (1, -1)]
        P = max(forms, key=lambda form: min(form[i, i] for i in range(n)))
    block = {"size": n, "P": written(P), "R": unit(n), "R2": unit(n)}
    document["witness"] = {"method": "lyapunov", "transformation": None, "blocks": [block]}
    return document


def falling_form(rng: random.Random, document: Document) -> Forged:
    """A stable loop said to be unstable, with a form that is positive in the direction given."""
    n = _matrix(document).nrows()
    document["claim"]["stable"] = False
    column = [[rng.choice((0, 0, 1))] for _ in range(n)]
    P, R2 = unit(n), unit(n)
    blocks = document["witness"].get("blocks")
    if blocks and blocks[0]["size"] == n and document["witness"]["transformation"] is None:
        P, R2 = blocks[0]["P"], blocks[0]["R2"]
    v = {"denominator": 1, "entries": column}
    document["witness"] = {"method": "instability", "P": P, "R2": R2, "v": v}
    return document


def wrong_verdict(rng: random.Random, document: Document) -> Forged:
    """The opposite, by the same evidence or by the polynomial."""
    document["claim"]["stable"] = not document["claim"]["stable"]
    if rng.random() < 0.5:
        document["witness"] = {"method": "polynomial"}
    return document


def stricter_bound(rng: random.Random, document: Document) -> Forged:
    """A bound that the loop does not meet, or one that is none."""
    document["claim"]["bound"] = rng.choice((0, 1, "1/2", "1/100", 3, -1, 2, 1000))
    return document


def indefinite_form(rng: random.Random, document: Document) -> Forged:
    """A form that decreases and is not positive: what proves instability, for stability."""
    if document["witness"]["method"] != "instability":
        return None
    n = _matrix(document).nrows()
    witness = document["witness"]
    block = {"size": n, "P": witness["P"], "R": unit(n), "R2": witness["R2"]}
    document["claim"]["stable"] = True
    document["witness"] = {"method": "lyapunov", "transformation": None, "blocks": [block]}
    return document


def too_fast(rng: random.Random, document: Document) -> Forged:
    """A bound for the observer that a root does not meet, or one that is none."""
    system, claim = subject_of(document), document["claim"]
    continuous = system.time == "continuous"
    claim["bound"] = (
        rng.choice((0, 1, 2, -1, "1/2")) if continuous else rng.choice((1, 2, "1/2", 0))
    )
    return document


def larger_share(rng: random.Random, document: Document) -> Forged:
    """Agents that share more entries than the plant has states, or over links with delays."""
    if rng.random() < 0.3:
        return late_observer(rng)
    plant = document["system"]
    return drawn_observer(rng, plant, extra=rng.choice((0, 1)))


SPECTRUM = (congruent_coefficient, other_degree)
OBSERVER = (congruent_coefficient, other_degree, too_fast, larger_share)
STABILITY = (
    another_matrix, few_blocks, own_plant, own_plant, skew_form, falling_form, wrong_verdict,
    stricter_bound, indefinite_form, *REGIONS,
)  # fmt: skip
