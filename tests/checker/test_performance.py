"""The rules of ``loop_cost``, ``cost_bound``, ``disk_margin`` and ``sector``."""

from __future__ import annotations

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused
from mcexact.checker.performance import require_positive, symmetric
from tests.checker.handmade import Document, certificate, changed, checked, matrix, plant, without
from tests.checker.performance_plants import (
    ALL,
    BOTH,
    BOUND,
    CONTINUOUS_SECTOR,
    COST,
    EACH,
    ENTERED,
    FILTERED,
    GROUPS,
    GROWING,
    MARGIN,
    MEASURED,
    PUSHED_BOUND,
    RESTING,
    SECTOR,
    SHARED,
    SHIFTING_BOUND,
    SHIFTING_MARGIN,
    STEP,
    STEPPING,
    UNBOUNDED,
    UNLIKE_BOUND,
    UNLIKE_COST,
    UNLIKE_MARGIN,
    UNSEEN,
    form,
    static,
    weights,
)
from tests.checker.tables import accepts, rejects
from tests.wording import says

LAG = plant([[-1]], ([[1]], [[1]]))
LAGGING = certificate(
    "disk_margin",
    LAG,
    {"at": "inputs", "together": False, "margin": 1},
    {"parts": [{"ports": [0], "scaling": [1], "P": form([1])}]},
    static(LAG, -2),
)
"""T is -2/(x + 3): T + 1/2 is below 1, which T - 1/2 is not."""

ACCEPTED = [
    *ALL.items(),
    ("a bound with a bandwidth", changed(SHARED, ("claim.weights.bandwidth", 100))),
    ("a margin of its output", changed(MARGIN, ("claim.at", "outputs"))),
    ("one input is all inputs", changed(MARGIN, ("claim.together", True))),
    ("together, and so each by itself", changed(BOTH, ("claim.together", False))),
    ("a bound with a small bandwidth", changed(SHARED, ("claim.weights.bandwidth", 20))),
    ("nearly the largest margin of this matrix", changed(MARGIN, ("claim.margin", "31/50"))),
    ("a bound in discrete time of inputs that enter otherwise than outputs show", ENTERED),
    ("a bound in discrete time with a share", STEPPING),
    ("a cost with weights that differ", UNLIKE_COST),
    ("a bound with weights that differ", UNLIKE_BOUND),
    ("a margin of an input that enters otherwise", UNLIKE_MARGIN),
    ("a margin of an output that shows otherwise", changed(
        UNLIKE_MARGIN, ("claim.at", "outputs"), ("witness.parts.0.P", form([9], exponent=1))
    )),
    ("a margin of a chain", SHIFTING_MARGIN),
    ("a margin where T is below 0", LAGGING),
    ("a bound of a chain", SHIFTING_BOUND),
    ("a bound of a mass", PUSHED_BOUND),
    ("a sector with a scaling in continuous time", changed(
        CONTINUOUS_SECTOR, ("witness.scaling", [4]), ("witness.P", form([3], exponent=1))
    )),
    ("a sector with a scaling", changed(
        SECTOR, ("witness.scaling", [4]), ("witness.P", form([2]))
    )),
    ("a sector of one line", changed(SECTOR, ("claim.sectors", [[1, 1]]))),
]  # fmt: skip

P, GROUP = "witness.P", "witness.groups.0"
REJECTED = [
    ("a margin of -T, where T is above 0", LAGGING, (
        ("subject", [static(LAG, "1/2")]), ("witness.parts.0.P", form([2], exponent=-1))
    ), "INVALID"),
    ("a cost below what is proved", COST, ("claim.cost", 6)),
    ("an indefinite matrix", COST, (P, form([-3])), "INVALID"),
    ("a matrix that is too small", COST, ((P, form([2])), ("claim.cost", 100)), "INVALID"),
    ("a loop that grows", COST, (("subject", [static(STEP, 1)]), ("claim.cost", 10**6)), "INVALID"),
    ("a static gain without a bandwidth", FILTERED, ("claim.weights", weights(1, 1)), "INVALID"),
    ("another bandwidth", FILTERED, ("claim.weights.bandwidth", 2000), "INVALID"),
    ("a bandwidth in discrete time", COST, ("claim.weights.bandwidth", 2), "MALFORMED"),
    ("a bandwidth below 0", FILTERED, ("claim.weights.bandwidth", -2), "MALFORMED"),
    ("a bandwidth of 0", FILTERED, ("claim.weights.bandwidth", 0), "MALFORMED"),
    ("a reward for large inputs", COST, ("claim.weights.inputs", [-1]), "MALFORMED"),
    ("inputs that cost nothing", COST, ("claim.weights.inputs", [0]), "MALFORMED"),
    ("a weight below 0", COST, ("claim.weights.states", [-1]), "MALFORMED"),
    ("a weight too many", COST, ("claim.weights.noise", [1, 1]), "MALFORMED"),
    ("no loop", COST, ("subject", []), "INVALID"),
    ("half of a matrix", COST, (P, {"exponents": [0], "entries": []}), "MALFORMED"),
    ("a huge exponent", COST, (P, form([3], exponent=4001)), "MALFORMED"),
    ("a bound above what is proved", BOUND, ("claim.cost", "3/4")),
    ("a first inequality that fails", BOUND, (
        (f"{GROUP}.P", form([4], exponent=-1)), ("claim.cost", 1)
    ), "INVALID"),
    ("a second inequality that fails", SHARED, (f"{GROUP}.S", form([9])), "INVALID"),
    ("too large an S in discrete time", BOUND, (f"{GROUP}.S", form([3], exponent=-1)), "INVALID"),
    ("noise below what passes the filter", SHARED, ("claim.weights.bandwidth", 2), "INVALID"),
    ("a gain that no regulator has", SHARED, (f"{GROUP}.F", matrix([9])), "INVALID"),
    ("a share of 1", SHARED, (f"{GROUP}.share", 1), "INVALID"),
    ("a negative share", SHARED, (f"{GROUP}.share", -1), "INVALID"),
    ("more than a share adds in discrete time", STEPPING, ("claim.cost", "130/80")),
    ("a cost just below with weights that differ", UNLIKE_COST, ("claim.cost", "11833/1000")),
    ("too small a P for what inputs cost", UNLIKE_COST, (
        (P, form([138], exponent=-3)), ("claim.cost", 100)
    ), "INVALID"),
    ("a bound just above with weights that differ", UNLIKE_BOUND, ("claim.cost", "1007/100")),
    ("more than the margin of this input", UNLIKE_MARGIN, ("claim.margin", "8/5"), "INVALID"),
    ("noise below twice what passes", SHARED, ("claim.weights.bandwidth", "19/5"), "INVALID"),
    ("a negative share alone, as for inputs that cost twice as much", SHARED, (
        (f"{GROUP}.P", form([1], exponent=1)), (f"{GROUP}.S", form([1], exponent=-1)),
        (f"{GROUP}.F", matrix([0])), (f"{GROUP}.share", -1), ("claim.cost", 4),
    ), "INVALID"),
    ("a group twice", BOUND, (
        ("witness.groups", BOUND["witness"]["groups"] * 2), ("claim.cost", 1)
    ), "INVALID"),
    ("more disturbance than there is", BOUND, (f"{GROUP}.disturbances", [2]), "INVALID"),
    ("no group", BOUND, ("witness.groups", []), "INVALID"),
    ("a group of those who are heard", GROUPS, (("witness.groups.1.agents", ["1"]),), "INVALID"),
    ("the same without a graph", GROUPS, (
        ("claim", {"weights": weights(2, 2), "cost": 1}),
    ), "INVALID"),
    ("an edge of the plant left out", GROUPS, ("claim.graph.edges", []), "INVALID"),
    ("a state of another agent", GROUPS, ("claim.graph.states", ["1", "1"])),
    ("an edge twice", GROUPS, ("claim.graph.edges", [["1", "2"], ["1", "2"]]), "MALFORMED"),
    ("an edge to itself", GROUPS, ("claim.graph.edges", [["1", "1"], ["1", "2"]]), "MALFORMED"),
    ("edges in another order", GROUPS, (
        "claim.graph.edges", [["2", "1"], ["1", "2"]]
    ), "MALFORMED"),
    ("a margin just too large", MARGIN, ("claim.margin", "16/25"), "INVALID"),
    ("a margin that is too large", MARGIN, ("claim.margin", "7/10"), "INVALID"),
    ("a margin of 0", MARGIN, ("claim.margin", 0), "INVALID"),
    ("single margins told of all at once", EACH, ("claim.together", True), "INVALID"),
    ("an output left out", EACH, ("witness.parts", EACH["witness"]["parts"][:1]), "INVALID"),
    ("nothing proved", EACH, ("witness.parts", []), "INVALID"),
    ("a scaling of 0", BOTH, ("witness.parts.0.scaling", [1, 0]), "INVALID"),
    ("an indefinite matrix of a margin", MARGIN, ("witness.parts.0.P", form([-2])), "INVALID"),
    ("a matrix that is too large", MARGIN, ("witness.parts.0.P", form([4])), "INVALID"),
    ("the sign of the loop", MARGIN, ("subject", [static(STEP, 1)]), "INVALID"),
    ("a margin of an unstable loop", MARGIN, ("subject", [static(STEP, 0)]), "INVALID"),
    ("a sector that is too wide", SECTOR, ("claim.sectors", [[0, 2]]), "INVALID"),
    ("ends in the wrong order", SECTOR, ("claim.sectors", [["3/2", "1/2"]]), "INVALID"),
    ("a sector too many", SECTOR, ("claim.sectors", [[1, 1], [1, 1]]), "MALFORMED"),
    ("a negative scaling", SECTOR, ("witness.scaling", [-1]), "MALFORMED"),
    ("a scaling of zeros", SECTOR, ("witness.scaling", [0]), "INVALID"),
    ("an indefinite matrix of a sector", SECTOR, (P, form([-2], exponent=-1)), "INVALID"),
    ("a matrix too large for a sector", RESTING, (P, form([2])), "INVALID"),
    ("an agent that measures another's state", MEASURED, ("claim.graph.edges", []), "INVALID"),
    ("another loop of a sector", SECTOR, ("subject", [static(STEP, 1)]), "INVALID"),
]  # fmt: skip

test_these_are_valid = accepts(ACCEPTED)
test_these_are_not = rejects(REJECTED)


@pytest.mark.parametrize("grows", [UNSEEN, GROWING, UNBOUNDED])
def test_nothing_is_valid_of_a_loop_that_grows(grows: Document) -> None:
    """Without a part, and with P < 0, for which alone the inequalities hold."""
    assert checked(grows).verdict == "INVALID"


def test_a_matrix_is_read_with_its_exponents() -> None:
    read = symmetric({"exponents": [1, -1], "entries": [3, 5, 7]}, "", 2)
    assert read.equals(Matrix([[48, 20], [20, 7]], 2, 4))


@pytest.mark.parametrize(
    "rows",
    [
        [[1, 2], [2, 4]],
        [[1, 2], [3, 9]],
        [[0]],
        [[2, 1, 1], [1, 2, -2], [1, -2, 2]],
        [[1, 2**3000], [2**3000, 1]],  # beyond floats, also when scaled by the diagonal
    ],
)
def test_what_is_singular_or_indefinite_is_not_shown_to_be_positive(rows: list[list[int]]) -> None:
    with pytest.raises(Refused):
        require_positive(Matrix(rows, len(rows)), "", "")


@pytest.mark.parametrize(
    "rows",
    [
        [],
        [[1]],
        [[10**300, 1], [1, 10**-0]],
        [[10**400, 10**200 - 1], [10**200 - 1, 2]],
        [[4, -3, 2], [-3, 5, -3], [2, -3, 4]],
        [[15, 16], [16, 18]],
    ],
)
def test_what_is_positive_definite_is_shown_to_be(rows: list[list[int]]) -> None:
    require_positive(Matrix(rows, len(rows)), "", "")


def test_the_words_name_the_controllers() -> None:
    assert "every linear time-invariant controller that" in checked(BOUND).statement
    assert says(checked(SHARED).statement, "depend once")
    assert 'along the edges {"1" -> "2"} alone' in checked(GROUPS).statement
    filtered = changed(SHARED, ("claim.weights.bandwidth", 100))
    assert "at once" not in checked(filtered).statement
    assert without(filtered, "claim.weights.bandwidth") == SHARED
