"""The rule of ``parametric_rank``: kernels, and two minors without other roots in common."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mcexact import ParametricSystem
from mcexact.analysis.parameters.ranks import Named, parametric_rank
from mcexact.answer.parameters import ControllabilityMatrix, SetpointMatrix, TransferColumn
from mcexact.answer.protocol import document
from tests.checker.handmade import changed, checked, without
from tests.wording import says


def certified(matrix: Named, A: Any, B: Any, C: Any, assume: Any = None, **options: Any) -> Any:
    """The certificate of a plant whose parameter is t."""
    ranges = {"t": assume} if assume else {}
    plant = ParametricSystem(A, B, C, parameters=["t"], assume=ranges, **options)
    return json.loads(json.dumps(document(parametric_rank(plant, matrix))))


SQUARE = certified(SetpointMatrix(), [[-1]], [[["t - 1"]]], [[[1]]])
"""[−1, t − 1; 1, 0] has rank 1 at t = 1."""
STEPS = certified(SetpointMatrix(), [["1/(t + 1)"]], [[[1]]], [[["t - 1"]]], time="discrete")
"""[−t, 1; t − 1, 0]; t = −1 is a pole, where [0, 1; −2, 0] has full rank."""
DROPS = certified(
    ControllabilityMatrix(("1", "2"), 1),
    [[0, 0, 0]] * 3,
    [[["t"], [0], [0]], [[0], ["t^2 - 2*t"], [0]]],
    [[], []],
)
"""[t, 0; 0, t² − 2t; 0, 0] has rank 0 at t = 0, and 1 at t = 2."""
REACHED = certified(
    ControllabilityMatrix(("2",), 2),
    [[0, "t^2 - 2"], [0, 0]],
    [[[1], [1]], [[0], [1]]],
    [[[1, 0]], [[0, 1]]],
)
"""[0, t² − 2; 1, 0] has rank 1 at two irrational values."""
THIN = certified(
    ControllabilityMatrix(("1",), 2), [[0, 0], [0, 0]], [[["t", 1], [1, "t"]]], [[[1, 0]]]
)
"""[t, 1, 0, 0; 1, t, 0, 0] has rank 1 at t = 1 and at t = −1."""
EDGE = certified(TransferColumn("1", "2"), [["t"]], [[["t"]], [[1]]], [[[1]], [["t^2 + 1"]]])
"""t³ + t vanishes at 0 and at ±i."""
NO_EDGE = certified(TransferColumn("2", "1"), [[1, "t"], [0, 2]], [[[0], [1]], [[1], [0]]],
                    [[[0, "t"]], [[1, 0]]])  # fmt: skip
"""The second state does not depend on the first."""
RANGED = certified(SetpointMatrix(), [["t^2 - 2"]], [[["t"]]], [[["t - 1", ]]], (0, 1))  # fmt: skip
"""[t² − 2, t; t − 1, 0] has rank 1 at 0 and 1."""
OUTSIDE = certified(SetpointMatrix(), [[0]], [[["t - 2"]]], [[["t"]]], (0, 1))
"""t = 2 is out of range."""
POLE = certified(SetpointMatrix(), [[1]], [[["t - 1"]]], [[["t/(t - 1)"]]])
"""At t = 1 the matrix [1, t − 1; t, 0] has rank 1, and C is undefined."""
CONSTANT = certified(ControllabilityMatrix(("1",), 1), [["t", 0], [0, 0]], [[[1, 1], [2, 2]]], [[]])
"""[1, 1; 2, 2] has rank 1 for every t."""
EMPTY = certified(SetpointMatrix(), [], [[]], [[[]]])
NO_STATES = certified(ControllabilityMatrix(("1",), 1), [], [[]], [[[]]])
NOTHING = certified(TransferColumn("1", "1"), [["t"]], [[[]]], [[[1]]])
"""No inputs: a column without rows."""
NO_CHANNELS = certified(ControllabilityMatrix((), 1), [["t"]], [[[1]]], [[[1]]])
ALL = {
    "square": SQUARE, "steps": STEPS, "drops": DROPS, "reached": REACHED, "thin": THIN,
    "constant": CONSTANT, "edge": EDGE, "no edge": NO_EDGE, "ranged": RANGED, "outside": OUTSIDE,
    "pole": POLE,
    "empty": EMPTY, "no states": NO_STATES, "nothing": NOTHING, "no channels": NO_CHANNELS,
}  # fmt: skip


@pytest.mark.parametrize("name", ALL)
def test_what_is_found_is_proved(name: str) -> None:
    found = checked(ALL[name])
    assert found.verdict == "VALID", found.line()


def ranks(found: Any) -> tuple[int, list[tuple[Any, int]]]:
    claim = found["claim"]
    return claim["rank"], [(e["value"], e["rank"]) for e in claim["exceptional"]]


def test_the_ranks_are_those_that_a_pencil_gives() -> None:
    assert ranks(SQUARE) == (2, [([-1, 1], 1)])
    assert ranks(STEPS) == (2, [([-1, 1], 1)])
    assert ranks(DROPS) == (2, [([-2, 1], 1), ([0, 1], 0)])
    assert ranks(REACHED) == (2, [([-2, 0, 1], 1)])
    assert ranks(THIN) == (2, [([-1, 1], 1), ([1, 1], 1)])
    assert ranks(EDGE) == (1, [([0, 1], 0), ([1, 0, 1], 0)])
    assert ranks(NO_EDGE) == (0, [])
    assert ranks(CONSTANT) == (1, [])
    assert ranks(OUTSIDE) == (2, [([0, 1], 1)])
    assert OUTSIDE["claim"]["outside"][0]["value"] == [-2, 1]
    assert POLE["witness"]["undefined"] == [[-1, 1]] and ranks(POLE) == (2, [([0, 1], 1)])
    for found in (EMPTY, NO_STATES, NOTHING, NO_CHANNELS):
        assert ranks(found) == (0, [])


def test_the_statements_name_the_matrix_and_the_values() -> None:
    said = checked(SQUARE).statement
    assert says(said, "complex defined")
    assert says(said, "matrices rank")
    assert says(said, "rank exactly")
    assert says(said, "disc centered")
    assert ", [A - I, B; C, 0] with" in checked(STEPS).statement
    assert says(checked(REACHED).statement, "rank exactly 2")
    assert says(checked(NO_EDGE).statement, "column rank")
    ranged = checked(OUTSIDE).statement
    assert says(ranged, "except roots") and "between 0 and 1, [A" in ranged


VALUE, PROOF = "claim.exceptional.0", "witness.exceptional.0"
ROOT = [{"re": "1", "im": "0", "radius": "0"}]
TWO = {"denominator": 1, "entries": [[1, 0], [0, 1]]}
LEFT_OUT = (("claim.exceptional", []), ("witness.exceptional", []))
MODULUS = SQUARE["witness"]["modulus"]


def columns(*layers: Any) -> Any:
    return {"denominator": 1, "coefficients": list(layers)}


FALSE: dict[str, tuple[Any, str]] = {
    "a value is left out": (changed(SQUARE, *LEFT_OUT), "common_factor"),
    "an irrational value is left out": (changed(REACHED, *LEFT_OUT), "common_factor"),
    "a value is called a pole": (
        changed(SQUARE, *LEFT_OUT, ("witness.undefined", [[-1, 1]])),
        "pole",
    ),
    "a value of a range is called out of it": (
        changed(
            OUTSIDE,
            *LEFT_OUT,
            (
                "claim.outside",
                [
                    *OUTSIDE["claim"]["outside"],
                    {"value": [0, 1], "roots": [{"re": "0", "im": "0", "radius": "0"}]},
                ],
            ),
        ),
        "range",
    ),
    "a value is moved by the modulus": (
        changed(
            SQUARE,
            (f"{VALUE}.value", [-1 - MODULUS, 1]),
            (f"{VALUE}.roots.0.re", str(1 + MODULUS)),
        ),
        "identity",
    ),
    "a value is moved": (
        changed(SQUARE, (f"{VALUE}.value", [-2, 1]), (f"{VALUE}.roots.0.re", "2")),
        "identity",
    ),
    "another root": (changed(SQUARE, (f"{VALUE}.roots.0.re", "2")), "disc"),
    "a disc that meets the axis beside its center": (
        changed(SQUARE, (f"{VALUE}.roots.0", {"re": "1", "im": "0.1", "radius": "1"})),
        "disc",
    ),
    "the rank at a value is that for almost all": (
        changed(SQUARE, (f"{VALUE}.rank", 2)),
        "claim",
    ),
    "the rank at a value is larger than elsewhere": (
        changed(SQUARE, (f"{VALUE}.rank", 3)),
        "claim",
    ),
    "the rank at a value is too small": (changed(SQUARE, (f"{VALUE}.rank", 0)), "rank"),
    "the rank at a value is too large": (
        changed(
            DROPS,
            ("claim.exceptional.1.rank", 1),
            ("witness.exceptional.1", {"columns": columns([[1], [0]]), "pivots": [0]}),
        ),
        "common_factor",
    ),
    "the rank is larger than the matrix": (changed(SQUARE, ("claim.rank", 3)), "rank"),
    "the rank is less and has no minor": (
        changed(
            SQUARE,
            ("claim.rank", 1),
            ("witness.kernel", {"columns": columns([[1], [0]]), "pivots": [0]}),
        ),
        "identity",
    ),
    "a kernel where the rank is full": (
        changed(SQUARE, ("witness.kernel", SQUARE["witness"]["exceptional"][0])),
        "claim",
    ),
    "a kernel at one value for all": (
        changed(
            SQUARE,
            ("claim.rank", 1),
            *LEFT_OUT,
            ("witness.kernel", SQUARE["witness"]["exceptional"][0]),
        ),
        "identity",
    ),
    "a minor less": (changed(SQUARE, ("witness.rows", [0])), "rank"),
    "a row more": (changed(DROPS, ("witness.rows", [0, 1, 2])), "rank"),
    "a column less": (changed(SQUARE, ("witness.columns", [0])), "rank"),
    "a minor of too many rows and columns": (
        changed(NO_EDGE, ("witness.rows", [0]), ("witness.columns", [0])),
        "rank",
    ),
    "a minor that is zero": (changed(DROPS, ("witness.rows", [0, 2])), "product"),
    "compressions that are zero": (
        changed(
            SQUARE,
            ("witness.compressions.0.entries", [[0, 0], [0, 0]]),
            (f"{VALUE}.value", [-1, 1]),
        ),
        "common_factor",
    ),
    "pivots that are no identity": (changed(SQUARE, (f"{PROOF}.pivots", [0])), "pivots"),
    "a kernel that is twice as long": (
        changed(SQUARE, (f"{PROOF}.columns", columns([[0], [2]]))),
        "pivots",
    ),
    "pivots that are zero": (
        changed(NO_EDGE, ("witness.kernel.columns", columns([[0]]))),
        "pivots",
    ),
    "a small modulus": (changed(SQUARE, ("witness.modulus", 1)), "modulus"),
    "another channel": (changed(NO_EDGE, ("claim.matrix.to", "2")), "identity"),
    "too many blocks": (changed(REACHED, ("claim.matrix.blocks", 3)), "claim"),
    "the kernels of two values exchanged": (
        changed(DROPS, ("witness.exceptional", DROPS["witness"]["exceptional"][::-1])),
        "rank",
    ),
}


@pytest.mark.parametrize("lie", FALSE)
def test_what_is_false_is_invalid(lie: str) -> None:
    given, code = FALSE[lie]
    found = checked(given)
    assert (found.verdict, found.code) == ("INVALID", code), found.line()


def test_a_rank_that_no_minor_can_have_is_refused_where_it_is_claimed() -> None:
    assert checked(changed(SQUARE, ("claim.rank", 3))).place == "claim.rank"
    assert checked(changed(THIN, ("claim.rank", 3))).place == "claim.rank"
    assert checked(changed(DROPS, ("claim.rank", 3))).place == "claim.rank"
    assert checked(changed(SQUARE, ("witness.rows", [0]))).place == "witness.rows"


MALFORMED: dict[str, Any] = {
    "an unknown matrix": changed(SQUARE, ("claim.matrix", {"name": "pencil"})),
    "a matrix without a name": changed(SQUARE, ("claim.matrix", {})),
    "a name that is a list": changed(SQUARE, ("claim.matrix", {"name": ["setpoint"]})),
    "a matrix that is a name": changed(SQUARE, ("claim.matrix", "setpoint")),
    "another key": changed(SQUARE, ("claim.matrix.blocks", 1)),
    "no blocks": changed(REACHED, ("claim.matrix.blocks", 0)),
    "an unknown channel": changed(EDGE, ("claim.matrix.to", "3")),
    "a set for a channel": changed(EDGE, ("claim.matrix.to", ["1"])),
    "channels in another order": changed(DROPS, ("claim.matrix.channels", ["2", "1"])),
    "a rank below 0": changed(SQUARE, (f"{VALUE}.rank", -1)),
    "a value without t": changed(SQUARE, (f"{VALUE}.value", [1])),
    "a pole without t": changed(SQUARE, ("witness.undefined", [[1]])),
    "a kernel less": changed(SQUARE, ("witness.exceptional", [])),
    "a kernel that is not reduced": changed(
        SQUARE, (f"{PROOF}.columns", columns([[0], [1]], [[0], [0]]))
    ),
    "no kernel": changed(NO_EDGE, ("witness.kernel", None)),
    "a row twice": changed(SQUARE, ("witness.rows", [0, 0])),
    "a column that is not there": changed(DROPS, ("witness.columns", [0, 2])),
    "a row that is not there": changed(THIN, ("witness.rows", [0, 2])),
    "a compression of another shape": changed(
        SQUARE, ("witness.compressions.0.entries", [[1, 0, 0], [0, 1, 0]])
    ),
    "one compression": changed(SQUARE, ("witness.compressions", [TWO])),
    "a key less": without(SQUARE, "witness.undefined"),
    "a claim less": without(SQUARE, "claim.outside"),
    "an unknown key": changed(SQUARE, (f"{VALUE}.real", True)),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_what_is_not_as_the_format_says_is_malformed(name: str) -> None:
    found = checked(MALFORMED[name])
    assert found.verdict == "MALFORMED", found.line()


KEPT: dict[str, Any] = {
    "the identity for compressions": changed(SQUARE, ("witness.compressions", [TWO, TWO])),
    "a pole where nothing happens": changed(POLE, ("witness.undefined", [[-1, 1], [-1, 1]])),
    "a kernel of longer columns": changed(
        NO_EDGE, ("witness.kernel.columns", columns([[0]], [[3]]))
    ),
    "a value that is no longer out of a range": changed(
        OUTSIDE,
        (
            "claim.outside",
            [
                *OUTSIDE["claim"]["outside"],
                {"value": [-3, 1], "roots": [{"re": "3", "im": "0", "radius": "0"}]},
            ],
        ),
    ),
}


@pytest.mark.parametrize("name", KEPT)
def test_what_is_superfluous_and_true_is_accepted(name: str) -> None:
    found = checked(KEPT[name])
    assert found.verdict == "VALID", found.line()
