"""The checker samples as FORMAT.md says, and encloses the exact samples of every member."""

from __future__ import annotations

import random
from fractions import Fraction
from math import lcm
from typing import Any

import pytest
from flint import fmpq

from mcexact.checker.constructions import read_subject
from mcexact.checker.core import budget
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.budget import Refused
from mcexact.checker.core.system import read_plant
from mcexact.checker.kinds import check_document
from mcexact.checker.sampling import enclosure, weights
from tests.checker.box_maker import fractions, subject_of
from tests.checker.handmade import certificate, plant
from tests.oracle.certificates.sampling import enclosed
from tests.oracle.sampling import Rows, drawn_plant, drawn_radii, exponential, member
from tests.wording import says

TANK = plant([[-1]], ([[1]], [[1]]))
STEP = {"construction": "sampled", "step": 1, "late": 0, "decimals": 3}
ERROR = Fraction(1, 10**99)


def of_rows(rows: Rows) -> Matrix:
    d = lcm(*(x.denominator for row in rows for x in row))
    return Matrix([[int(x * d) for x in row] for row in rows], len(rows[0]), d)


def rational(rows: Rows) -> list[list[fmpq]]:
    return [[fmpq(x.numerator, x.denominator) for x in row] for row in rows]


def as_fractions(rows: Any) -> Rows:
    return [[Fraction(int(x.p), int(x.q)) for x in row] for row in rows]


def drawn(seed: int) -> tuple[random.Random, Rows, Rows, Fraction]:
    rng = random.Random(seed)
    A, B, h = drawn_plant(rng, 3)
    M = [[*a, *b] for a, b in zip(A, B, strict=True)]
    return rng, M, drawn_radii(rng, M), h


@pytest.mark.parametrize("seed", range(25))
def test_every_number_is_the_one_that_the_format_prescribes(seed: int) -> None:
    _, M, D, h = drawn(seed)
    for radii in (D, [[Fraction(0)] * len(row) for row in M]):
        values, spread = enclosure(of_rows(M), of_rows(radii), h, seed % 15)
        step = fmpq(h.numerator, h.denominator)
        expected = enclosed(rational(M), rational(radii), step, seed % 15)
        assert [[*row] for row in fractions(values)] == as_fractions(expected[0])
        assert [[*row] for row in fractions(spread)] == as_fractions(expected[1])


@pytest.mark.parametrize("seed", range(25))
def test_the_exact_samples_of_every_member_are_within_the_radii(seed: int) -> None:
    rng, M, D, h = drawn(seed)
    values, spread = (fractions(each) for each in enclosure(of_rows(M), of_rows(D), h, 12))
    for _ in range(3):
        near, n = member(rng, M, D), len(M)
        exact = exponential([row[:n] for row in near], [row[n:] for row in near], h)
        for rows in zip(values, spread, exact, strict=True):
            assert all(abs(x - y) <= r + ERROR for x, r, y in zip(*rows, strict=True))


def test_weights_make_row_sums_small_and_are_weights_whatever_they_are() -> None:
    M = Matrix([[0, 10**8], [1, 0]], 2, 1)
    w, nu = weights(M)
    assert all(row[0] >= 1 for row in w.rows)
    assert all(x[0] <= nu * y[0] for x, y in zip((M @ w).rows, w.rows, strict=True))
    assert nu < 2 * 10**4
    assert weights(Matrix.zeros(0, 0)) == (Matrix([], 1), 0)


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({"step": 0}, "INVALID"),
        ({"step": "-1/2"}, "INVALID"),
        ({"step": "2/4"}, "MALFORMED"),
        ({"step": "0.5"}, "MALFORMED"),
        ({"late": -1}, "MALFORMED"),
        ({"late": "1"}, "MALFORMED"),
        ({"decimals": 1001}, "INVALID"),
        ({"decimals": True}, "MALFORMED"),
        ({"more": 1}, "MALFORMED"),
    ],
)
def test_steps_that_are_none_are_refused(changes: dict[str, Any], verdict: str) -> None:
    with pytest.raises(Refused) as found:
        read_subject([{**STEP, **changes}], read_plant(TANK))
    assert found.value.args[0] == verdict


def test_a_plant_in_discrete_time_is_not_sampled() -> None:
    with pytest.raises(Refused, match="continuous time"):
        read_subject([STEP, STEP], read_plant(TANK))


@pytest.mark.parametrize("changes", [{"step": 10**9}, {"late": 10**6}])
def test_a_step_of_endless_work_ends_the_check(changes: dict[str, Any]) -> None:
    with budget.limited(budget.Budget()), pytest.raises(Refused) as found:
        read_subject([{**STEP, **changes}], read_plant(TANK))
    assert found.value.args[:2] == ("INCOMPLETE", "work")


def test_registers_delay_inputs_in_their_order() -> None:
    two = plant([[0, 0], [0, 0]], ([[1], [0]], [[1, 0]]), ([[0], [2]], [[0, 1]]))
    late = read_subject([{**STEP, "late": 2}], read_plant(two))
    assert late.A.nrows == 6 and late.time == "discrete"
    assert fractions(late.A) == [
        [1, 0, 1, 0, 0, 0],
        [0, 1, 0, 2, 0, 0],
        [0, 0, 0, 0, 1, 0],
        [0, 0, 0, 0, 0, 1],
        [0] * 6,
        [0] * 6,
    ]
    assert [fractions(B) for B in late.B] == [
        [[0], [0], [0], [0], [1], [0]],
        [[0], [0], [0], [0], [0], [1]],
    ]
    assert [fractions(C) for C in late.C] == [[[1, 0, 0, 0, 0, 0]], [[0, 1, 0, 0, 0, 0]]]


def test_registers_are_certain_and_outputs_keep_their_radii() -> None:
    uncertain = {
        **TANK,
        "uncertainty": {
            "absolute": {
                "A": {"shape": [1, 1], "entries": [[0, 0, "1/10"]]},
                "C": {"1": {"shape": [1, 1], "entries": [[0, 0, "1/5"]]}},
            }
        },
    }
    box = subject_of(uncertain, "box_fixed", ({**STEP, "late": 1},))
    radii = fractions(box.radii.A)
    assert radii[0][0] > Fraction(3, 100) and radii[0][1] > 0 and radii[1] == [0, 0]
    assert fractions(box.radii.B[0]) == [[0], [0]]
    assert fractions(box.radii.C[0]) == [[Fraction(1, 5), 0]]
    assert box.members.endswith(", sampled without rounding")


def test_after_sampling_further_constructions_carry_the_radii_on() -> None:
    box = subject_of(TANK, "box_fixed", (STEP, {"construction": "dual"}))
    assert fractions(box.radii.A) == [[Fraction(121, 1000000)]]
    before = subject_of(TANK, "box_fixed", ({"construction": "dual"}, STEP))
    assert fractions(before.radii.A) == [[Fraction(121, 1000000)]]


def test_a_claim_about_rounded_values_says_so_and_one_about_a_box_denies_it() -> None:
    graph = certificate("neighbor_graph", {**TANK, "neighbors": {"1": []}}, {}, {}, STEP)
    graph["claim"] = {"strongly_connected": True}
    verdict = check_document(graph)
    assert verdict.verdict == "VALID"
    assert says(verdict.statement, "held decimals")
