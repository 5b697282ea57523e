"""Evidence that several kinds share: channels, identity matrices, gains, moduli, powers of A."""

from __future__ import annotations

import itertools
import math
import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core import evidence
from mcexact.checker.core.arithmetic import Matrix, NotAUnit, product
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.core.evidence import unseen, without_path
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System, read_plant
from tests.checker.handmade import matrix, plant

SYSTEM = read_plant(
    plant(
        [[1, 2], [3, 4]],
        ([[1, 5], [0, 6]], [[1, 0]]),
        ([[2], [7]], [[0, 1], [1, 1]]),
        ([[], []], {"shape": [0, 2], "entries": []}),
    )
)
GAINS = [matrix([1], [2]), matrix([3, -1]), matrix()]


def test_inputs_stand_side_by_side_and_outputs_one_above_the_other() -> None:
    assert evidence.inputs(SYSTEM, [0, 1]).rows == [[1, 5, 2], [0, 6, 7]]
    assert evidence.inputs(SYSTEM, [1, 0]).rows == [[2, 1, 5], [7, 0, 6]]
    assert evidence.inputs(SYSTEM, []) == Matrix([[], []], 0)
    assert evidence.outputs(SYSTEM, [0, 1]).rows == [[1, 0], [0, 1], [1, 1]]
    assert evidence.outputs(SYSTEM, [2, 1]).rows == [[0, 1], [1, 1]]
    assert evidence.outputs(SYSTEM, []) == Matrix([], 2)


def test_the_other_channels_are_in_order() -> None:
    assert evidence.complement(SYSTEM, []) == [0, 1, 2]
    assert evidence.complement(SYSTEM, [1]) == [0, 2]
    assert evidence.complement(SYSTEM, [2, 0, 1]) == []


def test_gains_close_the_loop_by_addition() -> None:
    F = evidence.read_gains(GAINS, "gains", SYSTEM)
    # B_1 F_1 C_1 = [11 0; 12 0] and B_2 F_2 C_2 = [-2 4; -7 14]
    assert evidence.closed_loop(SYSTEM, F).rows == [[1 + 11 - 2, 2 + 4], [3 + 12 - 7, 4 + 14]]


@pytest.mark.parametrize(
    "gains",
    [GAINS[:2], [*GAINS, matrix()], GAINS[::-1], [matrix([1, 2]), *GAINS[1:]], None],
    ids=str,
)
def test_gains_fit_their_channels(gains: Any) -> None:
    with pytest.raises(Refused) as found:
        evidence.read_gains(gains, "gains", SYSTEM)
    assert found.value.verdict == "MALFORMED"


def layers(*parts: list[list[int]]) -> list[Matrix]:
    return [Matrix(rows, len(rows[0])) for rows in parts]


NOTHING = [[0, 0], [0, 0], [0, 0]]


@pytest.mark.parametrize(
    ("parts", "pivots", "good"),
    [
        (layers([[1, 0], [9, 9], [0, 1]]), [0, 2], True),
        (layers([[1, 0], [9, 9], [0, 1]], [[0, 0], [8, 7], [0, 0]]), [0, 2], True),
        (layers([[9], [1], [9]]), [1], True),
        ([Matrix([[], []], 0)], [], True),
        (layers([[1, 0], [9, 9], [0, 1]]), [0, 1], False),
        (layers([[1, 0], [9, 9], [0, 2]]), [0, 2], False),
        (layers([[1, 0], [9, 9], [1, 1]]), [0, 2], False),
        (layers([[1, 0], [9, 9], [0, 1]], [[0, 0], [8, 7], [0, 1]]), [0, 2], False),
        (layers([[1, 0], [9, 9], [0, 1]], NOTHING, [[1, 0], [0, 0], [0, 0]]), [0, 2], False),
        (layers(NOTHING, [[1, 0], [9, 9], [0, 1]]), [0, 2], False),
    ],
)
def test_pivots_hold_an_identity_matrix_for_every_x(
    parts: list[Matrix], pivots: list[int], good: bool
) -> None:
    if good:
        evidence.require_identity(parts, pivots, "pivots")
    else:
        with pytest.raises(Refused) as found:
            evidence.require_identity(parts, pivots, "pivots")
        assert found.value.verdict == "INVALID"


@pytest.mark.parametrize("ell", [2, 3, 4, 10**30])
def test_moduli_start_with_2(ell: int) -> None:
    assert evidence.modulus(ell, "modulus") == ell


@pytest.mark.parametrize(
    ("ell", "verdict"),
    [(1, "INVALID"), (0, "INVALID"), (-7, "INVALID"), ("7", "MALFORMED"), (True, "MALFORMED")],
)
def test_anything_else_is_no_modulus(ell: Any, verdict: str) -> None:
    with pytest.raises(Refused) as found:
        evidence.modulus(ell, "modulus")
    assert found.value.verdict == verdict


def fractions(*numbers: Any) -> list[Fraction]:
    return [Fraction(number) for number in numbers]


def test_polynomials_are_coprime_modulo_l_or_not() -> None:
    evidence.require_coprime(fractions(0, 1), fractions(1, 1), 7, "x and x + 1")
    evidence.require_coprime(fractions("1/2", 1), fractions(0, 1), 7, "x + 1/2 and x")
    for a, b in ((fractions(0, 1), fractions(7, 1)), (fractions(-1, 0, 1), fractions(1, 1))):
        with pytest.raises(Refused) as found:
            evidence.require_coprime(a, b, 7, "they")
        assert found.value.verdict == "INVALID"
    with pytest.raises(NotAUnit):
        evidence.require_coprime(fractions("1/7", 1), fractions(0, 1), 7, "they")


# Markov parameters of all channels at once, and paths.


@pytest.mark.parametrize("ell", [2, 7, 19, 31])
def test_long_rows_are_added_by_coefficient_to_the_same_powers(ell: int) -> None:
    rng, n = random.Random(ell), 3 * ell + 60

    def drawn(nrows: int, ncols: int, share: float) -> Matrix:
        rows = [
            [rng.randint(1, 99) if rng.random() < share else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]
        return Matrix(rows, ncols)

    shown = set()
    for share in (0.05, 0.9):
        B, C = [drawn(n, 2, 0.02), drawn(n, 1, 0.5)], [drawn(1, n, 0.02), drawn(2, n, 1.0)]
        system = System("continuous", ["a", "b"], drawn(n, n, share), B, C)
        for j, i, k in itertools.product(range(2), range(2), range(3)):
            power = B[j].modulo(ell)
            for _ in range(k):
                power = product(system.A.modulo(ell), power, B[j].ncols, ell)
            nonzero = any(map(any, product(C[i].modulo(ell), power, B[j].ncols, ell)))
            assert unseen(system, [(j, i, k)], ell) == (None if nonzero else (j, i, k))
            shown.add(nonzero)
    assert True in shown


@pytest.mark.parametrize("ell", [2, 3, 7, 31, 61, 64])
def test_powers_of_all_channels_at_once_are_those_of_each(ell: int) -> None:
    rng, shown = random.Random(ell), set()
    for _ in range(12):
        n, widths = rng.randint(1, 8), [rng.randint(0, 3) for _ in range(3)]

        def drawn(nrows: int, ncols: int) -> Matrix:
            rows = [
                [rng.choice((0, rng.randint(-99, 99))) for _ in range(ncols)] for _ in range(nrows)
            ]
            return Matrix(
                rows, ncols, rng.choice([d for d in (1, 5, 7, 11) if math.gcd(d, ell) == 1])
            )

        B, C = [drawn(n, p) for p in widths], [drawn(rng.randint(0, 2), n) for _ in widths]
        system = System("continuous", ["a", "b", "c"], drawn(n, n), B, C)
        A = system.A.modulo(ell)
        for j, i, k in itertools.product(range(3), range(3), range(n)):
            power = B[j].modulo(ell)
            for _ in range(k):
                power = product(A, power, widths[j], ell)
            nonzero = any(map(any, product(C[i].modulo(ell), power, widths[j], ell)))
            assert unseen(system, [(j, i, k)], ell) == (None if nonzero else (j, i, k))
            shown.add(nonzero)
    assert shown == {True, False}


def test_no_power_is_computed_where_no_edge_is_claimed() -> None:
    system = read_plant(plant([[1, 2], [3, 4]], ([[1], [1]], [[1, 0]])))

    def units(triples: list[tuple[int, int, int]]) -> int:
        budget = Budget(10**9, 0)
        with limited(budget):
            assert unseen(system, triples, 31) is None
        return budget.spent

    assert units([(0, 0, 1)]) - units([(0, 0, 0)]) >= 200
    assert units([(0, 0, 0)]) - units([]) > 200


@pytest.mark.parametrize("step", [1, -1])
def test_long_paths_are_found_in_a_few_turns_whatever_way_they_lead(step: int) -> None:
    n = 100
    order = list(range(n))[::step]
    arcs = sorted([b, a, 1] for a, b in itertools.pairwise(order))
    A = {"shape": [n, n], "entries": arcs}
    first, last = ([[int(a == state)] for a in range(n)] for state in (order[0], order[-1]))
    channels = [
        {"name": name, "B": B, "C": [[entry for (entry,) in C]]}
        for name, B, C in (("1", first, first), ("2", last, last))
    ]
    system = read_plant({"time": "continuous", "A": A, "channels": channels})
    budget = Budget(10**9, 0)
    with limited(budget):
        assert without_path(system, itertools.product(range(2), range(2))) == {(1, 0)}
    assert budget.spent < 10 * 40 * 2 * n


@pytest.mark.parametrize("way", [1, -1])
def test_rows_that_no_later_edge_needs_are_left_out(way: int) -> None:
    """Edges of different powers at once, along a ring with a chord, and one that is none."""
    n, ell = 24, 31
    rows = [[0] * n for _ in range(n)]
    for a in range(n):
        rows[a][(a - way) % n] = 1 + a % 3
    rows[5][17] = 2
    ports = [
        ([[int(a == 6 * c)] for a in range(n)], [[int(a == 6 * c + 1) for a in range(n)]])
        for c in range(4)
    ]
    system = read_plant(plant(rows, *ports))
    markov: dict[tuple[int, int, int], int] = {}
    for j, B in enumerate(system.B):
        state = [row[0] for row in B.rows]
        for k in range(2 * n):
            for i, C in enumerate(system.C):
                total = sum(x * y for x, y in zip(C.rows[0], state, strict=True))
                markov[j, i, k] = total % ell
            state = [sum(x * y for x, y in zip(row, state, strict=True)) % ell for row in rows]
    true = sorted(triple for triple, number in markov.items() if number)
    rng = random.Random(way)
    for _ in range(30):
        chosen = sorted(rng.sample(true, rng.randint(1, 12)))
        assert unseen(system, chosen, ell) is None
        j, i, k = rng.choice(sorted(markov.keys() - set(true)))
        assert unseen(system, sorted([*chosen, (j, i, k)]), ell) == (j, i, k)


def test_a_state_that_two_outputs_see_is_needed_for_the_longer_path() -> None:
    rows = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    seen = ([[0], [0], [0]], [[0, 0, 1]])
    system = read_plant(
        plant(rows, ([[1], [0], [0]], [[0, 0, 1]]), ([[0], [0], [1]], [[0, 0, 1]]), seen)
    )
    for triples in ([(0, 0, 2), (1, 1, 0)], [(0, 1, 2), (1, 0, 0)], [(0, 2, 2), (1, 0, 0)]):
        assert unseen(system, triples, 7) is None
    assert unseen(system, [(0, 0, 2), (1, 1, 1)], 7) == (1, 1, 1)
