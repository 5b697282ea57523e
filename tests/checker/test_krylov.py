"""One Krylov sequence as evidence: what bounds how much is fixed, and what only seems to."""

from __future__ import annotations

import random
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import Matrix as Exact
from mcexact.checker.core.arithmetic import NotAUnit
from mcexact.checker.core.evidence import krylov_loop, unmoved_degree
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System, read_plant
from tests.checker.handmade import (
    CHAIN,
    COMPLETE,
    FIXED,
    FREE,
    INTEGRATOR,
    OSCILLATION,
    PAIR,
    Document,
    certificate,
    changed,
    checked,
    layers,
    matrix,
    plant,
    without,
)
from tests.checker.tables import accepts, rejects

DOUBLE = plant([[0, 1], [0, 0]], ([[0], [1]], [[1, 0]]))
"""x'' = u, y = x: the numbers c A^k b are 0, 1, 0, …."""


def sequence(d: list[int], a: list[int], e: list[int], **parts: Any) -> Document:
    """A sequence of channel 1, one input, one output and F = 0, modulo 7."""
    made = {"modulus": 7, "gains": [matrix([0])], "channel": "1", "inputs": [1], "outputs": [1]}
    return {**made, "recurrence": d, "cofactors": [a, e], **parts}


def block(states: list[int], evidence: Document | None) -> Document:
    """Some states, and the evidence of how many of their modes move."""
    return {"states": states, "evidence": evidence}


def spectrum(system: Document, found: Document, *subject: Document) -> Document:
    """The claim that no mode is fixed."""
    states = list(range(len(system["A"])))
    witness = {"blocks": [block(states, found)], "modulus": None, "subspaces": []}
    return certificate("fixed_spectrum", system, FREE["claim"], witness, *subject)


DOUBLE_FREE = spectrum(DOUBLE, sequence([0, 0, 1], [1], []))
# s = 2, 3, 5, …: 1 + 2^k; d = (x − 1)(x − 2) and num = 2x − 3, whose square is 1 + 4 d
POWERS = spectrum(plant([[1, 0], [0, 2]], ([[1], [1]], [[1, 1]])), sequence([2, 4, 1], [4, 2], [3]))
ONE = spectrum(INTEGRATOR, sequence([0, 1], [1], []))
# s = 2, 4, 1, 2, …: 2·4^k modulo 7, and one state that nothing moves
UNMOVED = certificate(
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
        "blocks": [block([0, 1], sequence([-4 + 7, 1], [4], [], gains=[matrix([3])], inputs=[2]))],
        "modulus": 7,
        "subspaces": [
            {
                "channels_T": [],
                "U": layers([[0], [1]]),
                "V": layers([]),
                "pivots": [1],
            }
        ],
    },
)
NOTHING_MOVES = changed(
    OSCILLATION,
    (
        "witness",
        {
            "blocks": [block([0, 1], None)],
            "modulus": 7,
            "subspaces": OSCILLATION["witness"]["subspaces"],
        },
    ),
)
NO_STATES = changed(
    spectrum(INTEGRATOR, sequence([1], [], [1])),
    ("system", plant([], ({"shape": [0, 1], "entries": []}, [[]]))),
    ("witness.blocks", []),
)
TWO_INPUTS = spectrum(
    plant([[3]], ([[0, 2]], [[0], [1]])),
    sequence([4, 1], [1], [], gains=[matrix([0, 0], [0, 0])], inputs=[5, 4], outputs=[6, 1]),
)
HALVES = spectrum(
    plant([["1/2"]], ([["1/3"]], [[1]])),
    sequence([2, 1], [3], [], modulus=5, gains=[matrix([0], denominator=7)]),
)
EDGES = changed(
    without(COMPLETE, "witness.gains"),
    ("witness.blocks", [block([0], sequence([0, 1], [1], []))]),
)

ACCEPTED = [
    ("two states, by a recurrence of two", DOUBLE_FREE),
    ("two modes, by numbers that grow", POWERS),
    ("one state", ONE),
    ("gains of one channel", changed(ONE, ("witness.blocks.0.evidence.gains.0", matrix([3])))),
    (
        "a gain that counts modulo 7",
        changed(ONE, ("witness.blocks.0.evidence.gains.0", matrix([70]))),
    ),
    ("d may be any where L = 1", changed(ONE, ("witness.blocks.0.evidence.recurrence", [5, 1]))),
    ("residues may be written larger", changed(ONE, ("witness.blocks.0.evidence.inputs", [8]))),
    (
        "zeros at the end of a cofactor",
        changed(ONE, ("witness.blocks.0.evidence.cofactors.0", [1, 0, 7])),
    ),
    ("a composite modulus", changed(DOUBLE_FREE, ("witness.blocks.0.evidence.modulus", 6))),
    ("the modulus 2", changed(DOUBLE_FREE, ("witness.blocks.0.evidence.modulus", 2))),
    ("a modulus of a byte", changed(DOUBLE_FREE, ("witness.blocks.0.evidence.modulus", 64))),
    ("a modulus beyond", changed(DOUBLE_FREE, ("witness.blocks.0.evidence.modulus", 65))),
    ("a long modulus", changed(DOUBLE_FREE, ("witness.blocks.0.evidence.modulus", 10**40))),
    ("combinations of inputs and of outputs", TWO_INPUTS),
    ("denominators that are units", HALVES),
    ("a mode that nothing moves, counted once", UNMOVED),
    ("nothing said of A", changed(UNMOVED, ("claim.factors.0.multiplicity_in_A", None))),
    ("all modes fixed, and no channel that acts", NOTHING_MOVES),
    ("no states at all", NO_STATES),
    ("a complete system", EDGES),
]

S = "witness.blocks.0.evidence"
NO_DEGREE = ((f"{S}.recurrence", [1]), (f"{S}.cofactors", [[], [1]]))
REJECTED = [
    ("d not monic", DOUBLE_FREE, (f"{S}.recurrence", [0, 0, 2])),
    ("no d", DOUBLE_FREE, (f"{S}.recurrence", [])),
    ("a recurrence that fails at k = 0 = L − 2", DOUBLE_FREE, (f"{S}.recurrence", [0, 1, 1])),
    ("a degree below n", DOUBLE_FREE, (f"{S}.recurrence", [0, 1])),
    ("no unit: a num + e d = 2", DOUBLE_FREE, (f"{S}.cofactors", [[2], []])),
    ("a num + e d = 1 + x", DOUBLE_FREE, (f"{S}.cofactors", [[1, 1], []])),
    ("e counts", DOUBLE_FREE, (f"{S}.cofactors", [[1], [1]])),
    ("a num + e d = 0", DOUBLE_FREE, (f"{S}.cofactors", [[], []])),
    ("no input of the channel in use", DOUBLE_FREE, (f"{S}.inputs", [0])),
    ("no output of the channel in use", DOUBLE_FREE, (f"{S}.outputs", [7])),
    ("modulus 1: everything is congruent", DOUBLE_FREE, (f"{S}.modulus", 1)),
    ("modulus 0", DOUBLE_FREE, (f"{S}.modulus", 0)),
    ("a negative modulus", DOUBLE_FREE, (f"{S}.modulus", -7)),
    ("x too long", DOUBLE_FREE, (f"{S}.inputs", [1, 0]), "MALFORMED"),
    ("y too short", DOUBLE_FREE, (f"{S}.outputs", []), "MALFORMED"),
    ("a residue below 0", DOUBLE_FREE, (f"{S}.inputs", [-6]), "MALFORMED"),
    ("a residue that is no integer", DOUBLE_FREE, (f"{S}.inputs", ["1/2"]), "MALFORMED"),
    ("true for 1", DOUBLE_FREE, (f"{S}.recurrence", [0, 0, True]), "MALFORMED"),
    ("one cofactor", DOUBLE_FREE, (f"{S}.cofactors", [[1]]), "MALFORMED"),
    ("three cofactors", DOUBLE_FREE, (f"{S}.cofactors", [[1], [], []]), "MALFORMED"),
    ("an unknown channel", DOUBLE_FREE, (f"{S}.channel", "2"), "MALFORMED"),
    ("gains of another shape", DOUBLE_FREE, (f"{S}.gains", [matrix([0, 0])]), "MALFORMED"),
    ("no gains", DOUBLE_FREE, (f"{S}.gains", []), "MALFORMED"),
    ("gains of the whole besides", DOUBLE_FREE, ("witness.gains", []), "MALFORMED"),
    ("a completion besides", DOUBLE_FREE, ("witness.completion", None), "MALFORMED"),
    ("no evidence for the block", DOUBLE_FREE, (S, None), "INVALID"),
    ("evidence of neither kind", DOUBLE_FREE, (S, {}), "MALFORMED"),
    ("evidence that is a list", DOUBLE_FREE, (S, []), "MALFORMED"),
    ("a modulus for factors where there are none", DOUBLE_FREE, ("witness.modulus", 7), "INVALID"),
    ("no modulus for factors", UNMOVED, ("witness.modulus", None), "MALFORMED"),
    ("modulus 1 for factors", UNMOVED, ("witness.modulus", 1), "INVALID"),
    ("another plant: nothing comes in", DOUBLE_FREE, ("system.channels.0.B", [[1], [0]])),
    ("another plant: nothing goes out", DOUBLE_FREE, ("system.channels.0.C", [[0, 1]])),
    ("ℓ divides a denominator of A", HALVES, (f"{S}.modulus", 2)),
    ("ℓ divides a denominator of B", HALVES, (f"{S}.modulus", 3)),
    ("ℓ divides a denominator of F", HALVES, (f"{S}.modulus", 7)),
    ("ℓ = 6, which divides neither 2 nor 3", HALVES, (f"{S}.modulus", 6)),
    ("a rate of nothing", ONE, ("claim.best_rate", {"lower": "0", "upper": "0"})),
    ("a multiplicity above the rank lost", UNMOVED, ("claim.factors.0.multiplicity_at_most", 2)),
    ("a multiplicity in A above", UNMOVED, ("claim.factors.0.multiplicity_in_A", 2)),
    (
        "nothing said of A, and a multiplicity above",
        changed(UNMOVED, ("claim.factors.0.multiplicity_in_A", None)),
        ("claim.factors.0.multiplicity_at_most", 2),
    ),
    ("a multiplicity in A of 0", UNMOVED, ("claim.factors.0.multiplicity_in_A", 0), "MALFORMED"),
    ("a rank too low", UNMOVED, ("claim.factors.0.rank", 0)),
    ("a degree that leaves two", UNMOVED, NO_DEGREE),
    ("edges that do not connect", EDGES, ("system", PAIR)),
    ("no edges", EDGES, ("witness.arcs", None), "MALFORMED"),
    ("gains besides", EDGES, ("witness.gains", [matrix([1])]), "MALFORMED"),
    ("no modulus for the edges", EDGES, ("witness.modulus", None), "MALFORMED"),
    ("modulus 1 for the edges", EDGES, ("witness.modulus", 1)),
    ("a sequence that leaves a mode", EDGES, NO_DEGREE),
]  # fmt: skip

test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


FALSE = [
    (
        "the recurrence for k < L − 2 alone: the mode 1 of the identity is fixed",
        plant([[1, 0], [0, 1]], ([[1], [0]], [[1, 0]])),
        sequence([0, 0, 1], [1, 6], [1]),
        "recurrence",
    ),
    (
        "the recurrence for k = L − 2 alone, and not for k = 0",
        plant(
            [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
            ([[1], [0], [0]], [[0, 0, 1]]),
        ),
        sequence([3, 0, 1, 1], [1], []),
        "recurrence",
    ),
    (
        "s = 0 and d = x²",
        plant([[1, 0], [0, 2]], ([[0], [0]], [[1, 0]])),
        sequence([0, 0, 1], [1], []),
        "common_factor",
    ),
    (
        "ℓ = 4, d = e = 2x + 1: (2x + 1)² = 1, and no channel reaches the mode",
        plant([[0]], ([[0]], [[1]])),
        sequence([1, 2], [], [1, 2], modulus=4),
        "monic",
    ),
    (
        "ℓ = 4, d = 1 + 2x with a last coefficient that is 0",
        plant([[0]], ([[0]], [[1]])),
        sequence([1, 2, 4], [], [1, 2], modulus=4),
        "monic",
    ),
    (
        "ℓ = 4, for which 1/2 is whatever one likes: cb = 0, and s = 2r − 1, 0, …",
        plant([[0, 0], [0, 0]], ([["1/2"], [1]], [[2, -1]])),
        sequence([0, 1], [1], [], modulus=4),
        "unit",
    ),
    (
        "ℓ = 6 with the denominators 2 and 3",
        plant([[0, 0], [0, 0]], ([["1/2"], ["1/3"]], [[2, -3]])),
        sequence([0, 1], [1], [], modulus=6),
        "unit",
    ),
    (
        "ℓ = 6 with zero divisors: num = 3x + 3 and d = x² + 4x + 1 satisfy all but the last",
        plant([[1, 0], [0, 1]], ([[3], [0]], [[1, 0]])),
        sequence([1, 4, 1], [1], [1], modulus=6),
        "common_factor",
    ),
    (
        "a channel without inputs",
        plant([[0]], ([[]], [[1]])),
        sequence([0, 1], [1], [], gains=[matrix()], inputs=[]),
        "common_factor",
    ),
    (
        "a channel without outputs",
        plant([[0]], ([[1]], {"shape": [0, 1], "entries": []})),
        sequence([0, 1], [1], [], gains=[matrix([])], outputs=[]),
        "common_factor",
    ),
    (
        "a chain of channels: one sequence sees the first state alone",
        CHAIN,
        sequence([0, 1], [1], [], gains=[matrix([0]), matrix([0])]),
        "degree",
    ),
]


@pytest.mark.parametrize(("reason", "system", "found", "code"), FALSE)
def test_what_would_be_false_is_not_proved(
    reason: str, system: Document, found: Document, code: str
) -> None:
    try:
        left = unmoved_degree(found, "witness", read_plant(system))
    except Refused as refused:
        assert (refused.verdict, refused.code) == ("INVALID", code)
    except NotAUnit:
        assert code == "unit"
    else:
        assert left and code == "degree"


def test_a_short_recurrence_need_not_divide_and_bounds_all_the_same() -> None:
    system = plant([[0, 1], [0, 0]], ([[1], [1]], [[1, 0]]))
    assert unmoved_degree(sequence([6, 1], [1], []), "witness", read_plant(system)) == 1


def test_a_factor_is_counted_once_although_it_loses_rank_twice() -> None:
    factors = UNMOVED["claim"]["factors"] * 2
    spaces = UNMOVED["witness"]["subspaces"] * 2
    twice = changed(
        UNMOVED,
        ("claim.factors", factors),
        ("witness.subspaces", spaces),
        (f"{S}.recurrence", [1]),
        (f"{S}.cofactors", [[], [1]]),
    )
    assert checked(twice).code == "common_factor"


def test_a_factor_with_a_double_root_modulo_l_does_not_show_its_rank() -> None:
    # x² + 1 = (x + 1)² modulo 2, with one root modulo 5 that is double in no field
    assert checked(changed(NOTHING_MOVES, ("witness.modulus", 5))).verdict == "VALID"
    assert checked(changed(NOTHING_MOVES, ("witness.modulus", 2))).code == "common_factor"


def test_a_part_of_the_modes_left_out_is_missed() -> None:
    assert checked(spectrum(PAIR, UNMOVED["witness"]["blocks"][0]["evidence"])).code == "degree"
    witness = {"blocks": {}, "modulus": None, "subspaces": []}
    assert checked(changed(FIXED, ("witness", witness))).verdict == "MALFORMED"


def _reference(system: System, found: Document, F: list[list[list[int]]], ell: int) -> bool:
    """The two conditions, written down as they are, with s_k from powers of A_F."""
    n, q = system.n, system.names.index(found["channel"])
    A = [[system.A.rows[i][j] for j in range(n)] for i in range(n)]
    for B, gain, C in zip(system.B, F, system.C, strict=True):
        for i in range(n):
            for j in range(n):
                A[i][j] += sum(
                    B.rows[i][a] * gain[a][b] * C.rows[b][j]
                    for a in range(B.ncols)
                    for b in range(C.nrows)
                )
    d, (a, e) = found["recurrence"], found["cofactors"]
    L = len(d) - 1
    v = [sum(r * x for r, x in zip(row, found["inputs"], strict=True)) for row in system.B[q].rows]
    c = [sum(y * row[j] for y, row in zip(found["outputs"], system.C[q].rows, strict=True))
         for j in range(n)]  # fmt: skip
    s = []
    for _ in range(max(2 * L - 1, 0)):
        s.append(sum(x * y for x, y in zip(c, v, strict=True)))
        v = [sum(x * y for x, y in zip(row, v, strict=True)) for row in A]
    if any(sum(d[j] * s[k + j] for j in range(L + 1)) % ell for k in range(L - 1)):
        return False
    num = [sum(d[j] * s[j - i - 1] for j in range(i + 1, L + 1)) for i in range(L)]
    total = [0] * (len(a) + len(num) + len(e) + len(d))
    for left_, right in ((a, num), (e, d)):
        for i, f in enumerate(left_):
            for k, g in enumerate(right):
                total[i + k] += f * g
    return d[-1] % ell == 1 % ell and [t % ell for t in total] == [1] + [0] * (len(total) - 1)


@pytest.mark.parametrize("ell", [2, 3, 4, 7, 61, 64, 65, 97, 10**9 + 7])
def test_drawn_sequences_are_judged_as_the_two_conditions_say(ell: int) -> None:
    rng, verdicts = random.Random(ell), set()

    def table(rows: int, cols: int) -> list[list[int]]:
        return [[rng.choice((0, 0, 1, -1, 2)) for _ in range(cols)] for _ in range(rows)]

    for _ in range(150):
        n, m = rng.randint(0, 3), rng.randint(1, 2)
        p, q = ([rng.randint(0, 2) for _ in range(m)] for _ in range(2))
        B, C = [table(n, k) for k in p], [table(k, n) for k in q]
        system = System(
            "continuous",
            [str(i) for i in range(m)],
            Exact(table(n, n), n),
            [Exact(M, k) for M, k in zip(B, p, strict=True)],
            [Exact(M, n) for M in C],
        )
        F, o, L = [table(a, b) for a, b in zip(p, q, strict=True)], rng.randrange(m), n
        L = rng.randint(0, min(n + 1, 2))

        def residues(size: int) -> list[int]:
            return [rng.randrange(ell) for _ in range(size)]

        found = {
            "modulus": ell,
            "gains": [matrix(*gain) for gain in F],
            "channel": str(o),
            "inputs": residues(p[o]),
            "outputs": residues(q[o]),
            "recurrence": [*residues(L), rng.choice((1, 1, 1, ell - 1))],
            "cofactors": [residues(rng.randint(0, 1)), rng.choice(([], [], [1], residues(1)))],
        }
        good = _reference(system, found, F, ell)
        verdicts.add(good)
        try:
            assert unmoved_degree(found, "witness", system) == n - L
            assert good
        except Refused:
            assert not good
    assert verdicts == {True, False}


def test_a_loop_is_closed_modulo_l() -> None:
    system = read_plant(DOUBLE)
    assert krylov_loop(system, [Exact([[3]], 1, 2)], 5) == [[0, 1], [4, 0]]
    with pytest.raises(NotAUnit):
        krylov_loop(system, [Exact([[3]], 1, 2)], 6)
    with pytest.raises(NotAUnit):
        krylov_loop(read_plant(HALVES["system"]), [Exact([[0]], 1)], 6)
