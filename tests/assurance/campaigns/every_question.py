"""Every question about drawn plants, judged by exact elimination over Q.

Run as ``python -m tests.assurance.campaigns.every_question [COUNT [FIRST [FILE]]]``.  The checker
has to accept each certificate, and the oracle, which is written from ``FORMAT.md`` alone and
eliminates over Q, has to find each claim true.  Plants are drawn by their number: generic, with
modes out of reach, with prescribed indices, sparse, in several components; most of them in other
coordinates, so that no entry shows it.  Those in the file (by default
``build/every_question.jsonl``) are not examined again.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import mcexact
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle.certificates.judge import TRUE, judge
from tests.oracle.draws import exact
from tests.oracle.enumeration import PlainSystem

FILE = Path("build") / "every_question.jsonl"
Rows = list[list[Fraction]]

QUESTIONS: dict[str, Callable[[MultiChannelSystem], Any]] = {
    "controllability": mcexact.joint_controllability,
    "observability": mcexact.joint_observability,
    "controllability indices": mcexact.controllability_indices,
    "observability indices": mcexact.observability_indices,
    "fixed spectrum": mcexact.fixed_spectrum,
    "transfer graph": mcexact.transfer_graph,
    "completeness": mcexact.completeness,
    "assignability": mcexact.assignability,
    "set-points": setpoint_solvability,
}


def table(rng: random.Random, nrows: int, ncols: int, share: float, sizes: list[int]) -> Rows:
    """Entries of these sizes, about this share of them not 0."""
    return [
        [Fraction(rng.choice(sizes) if rng.random() < share else 0) for _ in range(ncols)]
        for _ in range(nrows)
    ]


def drawn(rng: random.Random, n: int, m: int, share: float) -> PlainSystem:
    """Entries that are drawn independently; some are fractions."""
    sizes = rng.choice([[1, -1], [1, 2, -1, -3], [1, 7, 13, -19, 31]])
    A = table(rng, n, n, share, sizes)
    B = [table(rng, n, rng.choice([1, 1, 2]), share, sizes) for _ in range(m)]
    C = [table(rng, rng.choice([1, 1, 2]), n, share, sizes) for _ in range(m)]
    if rng.random() < 0.3:
        d = rng.choice([2, 3, 7])
        for M in (A, *B, *C):
            for row in M:
                row[:] = [x / d if rng.random() < 0.3 else x for x in row]
    return PlainSystem(A, B, C)


def generic(rng: random.Random) -> PlainSystem:
    """Dense plants, nearly all of them without a rank below the generic one."""
    return hidden(rng, drawn(rng, rng.randint(1, 9), rng.randint(1, 4), 0.9))


def sparse(rng: random.Random) -> PlainSystem:
    """Plants with few entries, in the coordinates in which they are drawn."""
    return drawn(rng, rng.randint(1, 10), rng.randint(1, 4), rng.choice([0.15, 0.25, 0.4]))


def planted(rng: random.Random) -> PlainSystem:
    """Modes that inputs do not reach, that outputs do not show, or both."""
    system = drawn(rng, rng.randint(2, 9), rng.randint(1, 3), 0.8)
    n = system.n
    unreached = set(rng.sample(range(n), rng.randint(0, n - 1)))
    unseen = set(rng.sample(range(n), rng.randint(0, n - 1)))
    for i in range(n):
        for j in range(n):
            if (i in unreached and j not in unreached) or (j in unseen and i not in unseen):
                system.A[i][j] = Fraction(0)
    for B in system.B:
        for i in unreached:
            B[i] = [Fraction(0)] * len(B[i])
    for C in system.C:
        for row in C:
            row[:] = [Fraction(0) if j in unseen else x for j, x in enumerate(row)]
    return hidden(rng, system)


def chains(rng: random.Random) -> PlainSystem:
    """Chains of integrators of drawn lengths, with an input for each, some inputs combined."""
    lengths = [rng.randint(1, 5) for _ in range(rng.randint(1, 4))]
    n, starts = sum(lengths), [sum(lengths[:k]) for k in range(len(lengths))]
    A = [[Fraction(int(i == j + 1 and i not in starts)) for j in range(n)] for i in range(n)]
    inputs = [[Fraction(int(i == start)) for i in range(n)] for start in starts]
    for _ in range(rng.randint(0, 3)):
        left, right = rng.choice(inputs), rng.choice(inputs)
        inputs.append([x + rng.randint(-1, 1) * y for x, y in zip(left, right, strict=True)])
    rng.shuffle(inputs)
    m = rng.randint(1, 3)
    parts = [inputs[k::m] for k in range(m)]
    B = [[[column[i] for column in part] for i in range(n)] for part in parts]
    C = [table(rng, rng.choice([1, 2]), n, 0.4, [1, -1]) for _ in range(m)]
    return hidden(rng, PlainSystem(A, B, C))


def several(rng: random.Random) -> PlainSystem:
    """Plants one after the other, each of which acts on later ones alone, or on none."""
    parts = [
        drawn(rng, rng.randint(1, 4), rng.randint(1, 2), 0.7) for _ in range(rng.randint(2, 3))
    ]
    n, start = sum(part.n for part in parts), 0
    A, B, C = [[Fraction(0)] * n for _ in range(n)], list[Rows](), list[Rows]()
    coupled = rng.random() < 0.7
    for part in parts:
        places = range(start, start + part.n)
        for i, row in zip(places, part.A, strict=True):
            A[i][start : start + part.n] = row
            for j in range(start if coupled else 0):
                A[i][j] = Fraction(rng.choice([0, 0, 1, -1]))
        for M in part.B:
            empty = [Fraction(0)] * len(M[0])
            B.append([M[i - start] if i in places else list(empty) for i in range(n)])
        for M in part.C:
            C.append(
                [[row[j - start] if j in places else Fraction(0) for j in range(n)] for row in M]
            )
        start += part.n
    return hidden(rng, PlainSystem(A, B, C))


def hidden(rng: random.Random, system: PlainSystem) -> PlainSystem:
    """The same plant in other coordinates: T A T⁻¹, T B, C T⁻¹, T a product of shears."""
    n = system.n
    if n < 2 or rng.random() < 0.2:
        return system
    for _ in range(2 * n):
        i, j = rng.sample(range(n), 2)
        f = rng.choice([1, -1])
        for M in (system.A, *system.B):
            M[i] = [x + f * y for x, y in zip(M[i], M[j], strict=True)]
        for M in (system.A, *system.C):
            for row in M:
                row[j] -= f * row[i]
    return system


DRAWN = {
    "generic": generic,
    "planted": planted,
    "chains": chains,
    "sparse": sparse,
    "several components": several,
}


def answers(rng: random.Random, system: MultiChannelSystem) -> Iterator[tuple[str, Any]]:
    """All questions, and some of them about a part of the channels."""
    for name, question in QUESTIONS.items():
        yield name, question(system)
    chosen = [name for name in system.names if rng.random() < 0.5]
    yield "controllability", mcexact.joint_controllability(system, chosen)
    yield "controllability indices", mcexact.controllability_indices(system, chosen)
    yield "observability indices", mcexact.observability_indices(system, chosen)


def examined(number: int) -> Examined:
    """What is wrong with the answers about one plant, and what they were."""
    rng = random.Random(number)
    kind = list(DRAWN)[number % len(DRAWN)]
    system = exact(DRAWN[kind](rng), rng.choice(["continuous", "discrete"]))
    wrong, seen = list[str](), Counter({f"{kind} plants": 1})
    for name, answer in answers(rng, system):
        document = protocol.document(answer)
        verdict = check_document(protocol.encode(answer).encode("ascii"))
        if verdict.verdict != "VALID":
            wrong.append(f"{name}: {verdict.line()}")
        judged, why = judge(document)
        if judged != TRUE:
            wrong.append(f"{name}: the claim is {judged}: {why}")
        seen[name] += 1
        if document["witness"].get("inputs"):
            seen["indices with relations"] += 1
    return wrong, seen


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 3000, FILE, examined, "wrong", "plant"))
