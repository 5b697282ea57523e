"""Blocks of states, each decided by itself: which partitions are in order, and what acts within."""

from __future__ import annotations

import random
from itertools import pairwise

import pytest

from mcexact.checker.core.arithmetic import Matrix as Exact
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.core.evidence import split
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System
from tests.checker.handmade import (
    CHAIN,
    FREE,
    PAIR,
    Document,
    certificate,
    changed,
    checked,
    layers,
    listed,
    matrix,
    plant,
)
from tests.checker.tables import accepts, rejects


def block(states: list[int], evidence: Document | None) -> Document:
    return {"states": states, "evidence": evidence}


def one_state(channel: str, modulus: int = 7) -> Document:
    """The sequence s_0 = 1 of a state that a channel drives and measures."""
    return {
        "modulus": modulus,
        "gains": [matrix([0])],
        "channel": channel,
        "inputs": [1],
        "outputs": [1],
        "recurrence": [0, 1],
        "cofactors": [[1], []],
    }


TWO = {"gains": [matrix([1])], "modulus": 7}
"""det(xI − A) and det(xI − A − 1) of a state."""


def spectrum(system: Document, *blocks: Document) -> Document:
    """The claim that no mode is fixed."""
    witness = {"blocks": list(blocks), "modulus": None, "subspaces": []}
    return certificate("fixed_spectrum", system, FREE["claim"], witness)


BOTH = spectrum(CHAIN, block([1], one_state("2")), block([0], one_state("1")))
ONE_WAY = plant([[0, 0], [0, 0]], ([[1], [0]], [[0, 1]]), ([[1], [0]], [[1, 0]]),
                ([[0], [1]], [[0, 1]]))  # fmt: skip
"""Two integrators with a channel each, and channel 1 from the second to the first."""
LEFT = spectrum(ONE_WAY, block([0], one_state("2")), block([1], one_state("3")))
APART = plant([[0, 0], [0, "1/2"]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]))
HALF = spectrum(APART, block([0], one_state("1")), block([1], one_state("2")))
STAYS = certificate(
    "fixed_spectrum",
    PAIR,
    {
        "polynomial": [-2, 1],
        "factors": [
            {
                "polynomial": [-2, 1],
                "multiplicity_in_A": 1,
                "multiplicity_at_most": 1,
                "channels": ["1"],
                "rank": 1,
                "stable": False,
                "roots": [{"re": "2", "im": "0", "radius": "0"}],
            }
        ],
        "stabilizable": False,
        "best_rate": {"lower": "-2", "upper": "-2"},
    },
    {
        "blocks": [block([1], None), block([0], one_state("1"))],
        "modulus": 7,
        "subspaces": [{"channels_T": [], "U": layers([[0], [1]]), "V": layers([]), "pivots": [1]}],
    },
)
AT_ZERO = changed(
    STAYS,
    ("system.A.1.1", 0),
    ("claim.polynomial", [0, 1]),
    ("claim.factors.0.polynomial", [0, 1]),
    ("claim.factors.0.roots.0.re", "0"),
    ("claim.best_rate", {"lower": "0", "upper": "0"}),
)
B, E = "witness.blocks", "witness.blocks.0.evidence"

ACCEPTED = [
    ("two blocks of a chain, the one that is driven first", BOTH),
    ("two polynomials for one of them", changed(BOTH, (E, TWO))),
    ("the second measures the first as well", changed(BOTH, ("system.channels.1.C", [[1, 1]]))),
    ("two polynomials for both", changed(BOTH, (E, TWO), (f"{B}.1.evidence", TWO))),
    ("a channel from a block to an earlier one", LEFT),
    ("blocks that are apart", HALF),
    ("in the other order", changed(HALF, (B, HALF["witness"]["blocks"][::-1]))),
    ("one more block, without states", changed(BOTH, (B, [
        block([], None), *BOTH["witness"]["blocks"],
    ]))),
    ("a block in which no channel acts", STAYS),
    ("the fixed mode 0", AT_ZERO),
    ("in the other order as well", changed(STAYS, (B, STAYS["witness"]["blocks"][::-1]))),
]  # fmt: skip
REJECTED = [
    ("an earlier block that drives a later one", BOTH, (B, BOTH["witness"]["blocks"][::-1])),
    ("a channel from a block to a later one", LEFT, (B, LEFT["witness"]["blocks"][::-1])),
    ("a state left out", BOTH, (B, BOTH["witness"]["blocks"][:1]), "INVALID"),
    ("a state in two blocks", HALF, (f"{B}.0.states", [0, 1]), "INVALID"),
    ("no blocks at all", BOTH, (B, []), "INVALID"),
    ("a state that is not there", BOTH, (f"{B}.0.states", [2]), "MALFORMED"),
    ("a negative state", BOTH, (f"{B}.0.states", [-1]), "MALFORMED"),
    ("a state twice in a block", BOTH, (f"{B}.0.states", [1, 1]), "MALFORMED"),
    ("states that are no list", BOTH, (f"{B}.0.states", 1), "MALFORMED"),
    ("blocks that are no list", BOTH, (B, {"states": [0, 1]}), "MALFORMED"),
    ("a block without evidence", BOTH, (E, None), "INVALID"),
    ("a channel that acts elsewhere", BOTH, (f"{E}.channel", "1"), "MALFORMED"),
    ("gains of all channels", BOTH, (f"{E}.gains", [matrix([0])] * 2), "MALFORMED"),
    ("gains that move nothing", BOTH, (E, {**TWO, "gains": [matrix([0])]}), "INVALID"),
    ("gains of all channels, by polynomials", BOTH, (E, {**TWO, "gains": [matrix([1])] * 2}),
     "MALFORMED"),
    ("a modulus of 1, by polynomials", BOTH, (E, {**TWO, "modulus": 1}), "INVALID"),
    ("a completion for a block", BOTH, (E, {**TWO, "completion": None}), "MALFORMED"),
    ("a modulus that divides a denominator elsewhere", HALF, (f"{E}.modulus", 2), "INVALID"),
    ("the block of the fixed mode by a sequence", STAYS, (E, one_state("1")), "MALFORMED"),
    ("a mode more", STAYS, (f"{B}.1.evidence", None), "INVALID"),
    ("another plant: the second integrator drives the first", BOTH, ("system.A.0.1", 1)),
    ("another plant: channel 1 measures the second as well", BOTH,
     ("system.channels.0.C", [[1, 1]])),
]  # fmt: skip

test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


@pytest.mark.parametrize(
    ("reason", "system"),
    [
        (
            "two channels lead from each integrator to the other",
            plant([[0, 0], [0, 0]], ([[1], [0]], [[0, 1]]), ([[0], [1]], [[1, 0]])),
        ),
        (
            "gains of a channel couple what B C does not",
            plant([[0, 0], [0, 0]], ([[1, 0], [0, 1]], [[1, 0], [0, 1]])),
        ),
        ("states that drive each other", plant([[0, 1], [1, 0]], ([[1], [0]], [[1, 0]]))),
    ],
)
@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_what_is_strongly_connected_is_not_split(
    reason: str, system: Document, order: list[int]
) -> None:
    verdict = checked(spectrum(system, *(block([a], None) for a in order)))
    assert (verdict.verdict, verdict.code) == ("INVALID", "order")


def _drawn(rng: random.Random, n: int, m: int) -> System:
    def table(rows: int, cols: int) -> Exact:
        few = (0, 0, 0, rng.choice((0, 1)), 2)
        return Exact([[rng.choice(few) for _ in range(cols)] for _ in range(rows)], cols)

    widths = [(rng.randint(0, 2), rng.randint(0, 2)) for _ in range(m)]
    B, C = [table(n, p) for p, _ in widths], [table(q, n) for _, q in widths]
    return System("discrete", [str(i) for i in range(m)], table(n, n), B, C)


def test_drawn_partitions_are_in_order_iff_every_loop_is_block_triangular() -> None:
    rng, seen = random.Random(1), set()
    for _ in range(600):
        n, count = rng.randint(1, 4), rng.randint(1, 3)
        system = _drawn(rng, n, rng.randint(0, 2))
        at = [rng.randrange(count) for _ in range(n)]
        parts = [[a for a in range(n) if at[a] == k] for k in range(count)]
        rows = [[bool(entry) for entry in row] for row in system.A.rows]
        for B, C in zip(system.B, system.C, strict=True):
            for a in range(n):
                for b in range(n):
                    rows[a][b] |= any(B.rows[a]) and any(row[b] for row in C.rows)
        triangular = not any(rows[a][b] and at[b] < at[a] for a in range(n) for b in range(n))
        seen.add((triangular, count))
        try:
            found = split([block(part, None) for part in parts], "witness", system)
        except Refused as refused:
            assert refused.code == "order" and not triangular
            continue
        assert triangular
        for part, (_, alone, proof) in zip(parts, found, strict=True):
            assert proof is None and alone.time == "discrete"
            assert alone.A.rows == [[system.A.rows[a][b] for b in part] for a in part]
            acting = []
            for name, B, C in zip(system.names, system.B, system.C, strict=True):
                inside = any(any(B.rows[a]) for a in part)
                if inside and any(row[b] for row in C.rows for b in part):
                    acting.append((name, B.take(part).rows, [[r[b] for b in part] for r in C.rows]))
            ports = zip(alone.names, alone.B, alone.C, strict=True)
            assert [(name, B.rows, C.rows) for name, B, C in ports] == acting
    assert len(seen) == 5


def _split_units(n: int, size: int) -> int:
    """What it takes to split n states without arcs into blocks of a size."""
    system = System(
        "continuous", ["1"], Exact.zeros(n, n), [Exact.zeros(n, 1)], [Exact.zeros(1, n)]
    )
    parts = [block(list(range(k, k + size)), None) for k in range(0, n, size)]
    budget = Budget(10**12, 0)
    with limited(budget):
        split(parts, "witness", system)
    return budget.spent


def test_the_work_of_splitting_grows_with_the_entries_that_are_looked_at() -> None:
    units = [_split_units(n, 1) for n in (100, 200, 400, 800)]
    assert all(1.5 < after / before < 3 for before, after in pairwise(units))
    halves = [_split_units(n, n // 2) for n in (100, 200, 400, 800)]
    assert all(3 < after / before < 5 for before, after in pairwise(halves[1:]))
    assert _split_units(800, 800) < halves[-1] / 2
    with limited(Budget(10**4, 0)), pytest.raises(Refused, match="work"):
        split([block([a], None) for a in range(200)], "witness", _drawn(random.Random(1), 200, 0))


def test_many_blocks_are_within_what_is_granted() -> None:
    n = 60
    unit = [[int(i == j) for j in range(n)] for i in range(n)]
    system = plant(listed(unit, n), *(([[v] for v in unit[i]], [unit[i]]) for i in range(n)))
    verdict = checked(spectrum(system, *(block([i], one_state(str(i + 1))) for i in range(n))))
    assert verdict.verdict == "VALID", verdict.line()
