"""The rule of ``step_peaks``."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused
from mcexact.checker.steps import Lanes, exponents_of, scaled, stays_within
from tests.checker.handmade import Document, changed, checked, without
from tests.checker.performance_plants import (
    CONTINUOUS_STEP,
    FOLLOWING,
    SENSED,
    STEP,
    STEPPED,
    form,
    static,
)
from tests.checker.tables import accepts, rejects
from tests.wording import says

TWO_OUTPUTS = changed(
    STEPPED,
    ("system.channels.0.C", [[1], [2]]),
    ("subject.0.controller.agents.0.input.outputs.1", [[-1, 0]]),
    ("claim.outputs", [["1001/1000", "2003/1000"]]),
    ("witness.sizes", [1, 1, 2]),
    ("witness.P", form([4])),
)

ACCEPTED = [
    ("a step at an input", STEPPED),
    ("an error of a sensor", SENSED),
    ("a step of a set-point", FOLLOWING),
    ("a step in continuous time", CONTINUOUS_STEP),
    ("more outputs than states", TWO_OUTPUTS),
    ("bounds that are larger", changed(STEPPED, ("claim.inputs", [[5]]))),
    ("no set-point is used", changed(STEPPED, ("claim", {
        "at": "setpoints", "inputs": [["1/1000"]], "outputs": [["1/1000"]],
    }))),
    ("more times", changed(STEPPED, ("witness.times", 20))),
    ("shorter steps", changed(CONTINUOUS_STEP, ("witness.step", "1/2"), ("witness.times", 12))),
    ("more bits", changed(CONTINUOUS_STEP, ("witness.bits", 90), ("witness.unit", -80))),
]  # fmt: skip

FAR = ("claim.inputs", [[1000]]), ("claim.outputs", [[1000]])
REJECTED = [
    ("an input above its bound", STEPPED, ("claim.inputs", [["999/1000"]]), "INVALID"),
    ("an output above its bound", STEPPED, ("claim.outputs", [["999/1000"]]), "INVALID"),
    ("what is at once above its bound", SENSED, ("claim.inputs", [["999/1000"]]), "INVALID"),
    ("a set-point above its bound", FOLLOWING, ("claim.outputs", [["999/1000"]]), "INVALID"),
    ("bounds without room for rounding", STEPPED, ("claim.inputs", [[1]]), "INVALID"),
    ("the limit above its bound", CONTINUOUS_STEP, ("claim.outputs", [["499/1000"]]), "INVALID"),
    ("bounds that are only reached later", CONTINUOUS_STEP, (
        ("witness.times", 0), ("claim.inputs", [["1/2"]]), ("claim.outputs", [["1/4"]])
    ), "INVALID"),
    ("an end too early", CONTINUOUS_STEP, ("witness.times", 1), "INVALID"),
    ("another side", STEPPED, (("claim.at", "disturbances"),), "MALFORMED"),
    ("a bound below 0", STEPPED, ("claim.inputs", [[-1]]), "MALFORMED"),
    ("a row too many", STEPPED, ("claim.inputs", [[5], [5]]), "MALFORMED"),
    ("an entry too many", STEPPED, ("claim.outputs", [[5, 5]]), "MALFORMED"),
    ("no row", STEPPED, ("claim.inputs", []), "MALFORMED"),
    ("a rate of 0", STEPPED, ("witness.rate", 0), "INVALID"),
    ("a negative rate", STEPPED, ("witness.rate", -1), "INVALID"),
    ("a rate that is too large", STEPPED, ("witness.rate", "1/2"), "INVALID"),
    ("a rate that the loop has not", CONTINUOUS_STEP, ("witness.rate", 2), "INVALID"),
    ("a size that is too small", STEPPED, ("witness.sizes", ["1/2", 1]), "INVALID"),
    ("a size of 0", STEPPED, ("witness.sizes", [0, 1]), "INVALID"),
    ("a size left out", STEPPED, ("witness.sizes", [1]), "MALFORMED"),
    ("an indefinite matrix", STEPPED, (("witness.P", form([-3])), *FAR), "INVALID"),
    ("a matrix below the signals", STEPPED, ("witness.P", form([1])), "INVALID"),
    ("a loop that grows", STEPPED, (("subject", [static(STEP, 1)]), *FAR), "INVALID"),
    ("a loop that does not move", STEPPED, (("subject", [static(STEP, 0)]), *FAR), "INVALID"),
    ("no loop", STEPPED, ("subject", []), "INVALID"),
    ("15 bits", STEPPED, (("witness.bits", 15), ("witness.unit", -8), *FAR), "MALFORMED"),
    ("1001 bits", STEPPED, ("witness.bits", 1001), "MALFORMED"),
    ("a step that is longer than its lane", STEPPED, ("witness.unit", -24), "INVALID"),
    ("a unit that is far away", STEPPED, ("witness.unit", -12001), "MALFORMED"),
    ("a unit that is far above", STEPPED, ("witness.unit", 12001), "MALFORMED"),
    ("a unit that hides everything", STEPPED, ("witness.unit", 10), "INVALID"),
    ("a number of times below 0", STEPPED, ("witness.times", -1), "MALFORMED"),
    ("a step in discrete time", STEPPED, ("witness.step", 1), "MALFORMED"),
    ("a step of 0", CONTINUOUS_STEP, ("witness.step", 0), "INVALID"),
    ("a negative step", CONTINUOUS_STEP, ("witness.step", -1), "INVALID"),
    ("numbers that become too large", CONTINUOUS_STEP, ("witness.step", 100), "INVALID"),
    ("a series that is too long", CONTINUOUS_STEP, (
        ("witness.step", 300), ("witness.bits", 1000), ("witness.unit", -24)
    ), "INVALID"),
]  # fmt: skip

test_these_are_valid = accepts(ACCEPTED)
test_these_are_not = rejects(REJECTED)


def test_the_words_name_the_step_and_its_bounds() -> None:
    assert says(checked(STEPPED).statement, "added input")
    assert says(checked(FOLLOWING).statement, "point output")
    assert checked(CONTINUOUS_STEP).statement.endswith("k = 1: (1501/1000) and (501/1000)")


def test_continuous_time_needs_a_step() -> None:
    verdict = checked(without(CONTINUOUS_STEP, "witness.step"))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "witness.step")


def test_a_polynomial_is_bounded_between_its_ends() -> None:
    # 4s(1 - s) reaches 1 in the middle, and both ends are 0
    assert stays_within([0, 400, -400], 101) and not stays_within([0, 400, -400], 99)
    assert not stays_within([0, -400, 400], 99)
    # -1 + 2s vanishes in the middle
    assert stays_within([-7, 14], 7) and not stays_within([-7, 14], 6)
    assert stays_within([3], 3) and not stays_within([-4], 3) and stays_within([0], 0)
    # s^3 is 1 at the end alone
    assert stays_within([0, 0, 0, 8], 8) and not stays_within([0, 0, 0, 8], 7)


@pytest.mark.parametrize("seed", range(20))
def test_no_drawn_polynomial_leaves_its_bound(seed: int) -> None:
    rng = random.Random(seed)
    c = [rng.randrange(-50, 51) for _ in range(rng.randrange(1, 8))]
    values = [
        abs(sum((x * Fraction(s, 64) ** j for j, x in enumerate(c)), Fraction(0)))
        for s in range(65)
    ]
    least = next(bound for bound in range(400) if stays_within(c, bound))
    assert max(values) <= least <= max(values) * Fraction(11, 10) + 1


def test_products_in_lanes_are_those_of_each_vector() -> None:
    rng = random.Random(1)
    rows = [([0, 2], [rng.randrange(-(2**20), 2**20) for _ in range(2)]), ([], []), ([1], [-1])]
    lanes = Lanes(5, 20, rows)
    vectors = [[rng.randrange(-(2**19), 2**19) for _ in range(5)] for _ in range(3)]
    got = lanes.products(rows, [lanes.packed(vector) for vector in vectors])
    for (places, entries), packed in zip(rows, got, strict=True):
        wanted = [
            sum(e * vectors[k][lane] for k, e in zip(places, entries, strict=True)) >> 20
            for lane in range(5)
        ]
        assert lanes.numbers(packed) == wanted


def test_a_product_that_would_pass_for_one_of_the_next_lane_is_refused() -> None:
    rows = [([0], [2**30]), ([1], [1])]
    lanes = Lanes(3, 20, rows)
    with pytest.raises(Refused):
        lanes.products(rows, [lanes.packed([2**18, 0, 0]), lanes.packed([0, 0, 0])])


# In units: x and u are 2^18 in size.  A step is rounded by 3 at most, the sum of a signal by 3, and
# at the rate 1/4 a change of 3 becomes 12 in all.
LEAST = [
    ("what follows one step", STEPPED, "inputs", 2**18 + 3 + 3 + 12),
    ("an error that passes to the input at once", SENSED, "inputs", 2**18 + 3),
    ("an output that follows one step", SENSED, "outputs", 2**18 + 3 + 3 + 12),
    ("no step, after which 2^19 is to come at the rate 1/4", changed(
        STEPPED, ("witness.times", 0), ("claim.outputs", [[40]])
    ), "inputs", 4 * (2**19 + 3) + 3),
    ("in continuous time, afterwards", CONTINUOUS_STEP, "outputs", 8390706),
    ("in continuous time, at the beginning", changed(
        CONTINUOUS_STEP, ("claim.at", "outputs"), ("claim.outputs", [[2]])
    ), "inputs", 50332270),
]  # fmt: skip


@pytest.mark.parametrize(("document", "key", "least"), [row[1:] for row in LEAST])
def test_a_bound_has_to_leave_room_for_rounding(document: Document, key: str, least: int) -> None:
    unit = Fraction(2) ** document["witness"]["unit"]
    for bound, verdict in ((least, "VALID"), (least - 1, "INVALID")):
        claimed = changed(document, (f"claim.{key}", [[str(bound * unit)]]))
        assert checked(claimed).verdict == verdict


@pytest.mark.parametrize("outside", [256, -257, 2**19, -(2**19)])
@pytest.mark.parametrize("lane", range(3))
def test_a_number_outside_of_its_range_is_seen_in_every_lane(outside: int, lane: int) -> None:
    lanes = Lanes(3, 20, [])
    inside = [[255, -256, 0], [-256, -256, -256], [255, 255, 255]]
    assert lanes.is_within([lanes.packed(vector) for vector in inside], 8)
    for vector in inside:
        numbers = [*vector]
        numbers[lane] = outside
        assert not lanes.is_within([0, lanes.packed(numbers)], 8)


def test_exponents_bound_the_norm_of_each_coordinate() -> None:
    P = Matrix([[4**5, 0, 0, 0], [0, 4**5 + 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 4**9]], 4, 4**3)
    assert exponents_of(P) == [2, 3, -3, 6]
    assert [scaled(Fraction(-7, 3), 1, 0), scaled(Fraction(7, 3), 0, 1)] == [-5, 1]
