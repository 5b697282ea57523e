"""The rule of ``box_controllable``: channels control every member of a box."""

from __future__ import annotations

import pytest

from tests.checker.box_plants import (
    ALL,
    CONTROLLABLE,
    DETECTABLE,
    FED_BACK,
    OBSERVABLE,
    STABILIZABLE_BY_1,
)
from tests.checker.handmade import checked, matrix, without
from tests.checker.tables import accepts, rejects
from tests.wording import says

KIND = "box_controllable"
OF_THIS_KIND = [(name, each) for name, each in ALL.items() if each["kind"] == KIND]

test_what_is_made_is_proved = accepts(OF_THIS_KIND)

FRAME = "witness.frames.0"
test_what_proves_less_is_refused = rejects(
    [
        ("a channel fewer", CONTROLLABLE, ("claim.channels", ["1"]), "MALFORMED"),
        ("the channels in another order", CONTROLLABLE, ("claim.channels", ["2", "1"])),
        ("an unknown channel", CONTROLLABLE, ("claim.channels", ["3"]), "MALFORMED"),
        ("R is 0", CONTROLLABLE, (f"{FRAME}.R.re", [[0, 0]] * 4), "INVALID"),
        ("R has a row less", CONTROLLABLE, (f"{FRAME}.R.re", [[0, 0]] * 3), "MALFORMED"),
        ("a weight is 0", CONTROLLABLE, (f"{FRAME}.w", [1, 0]), "MALFORMED"),
        ("as many weights as rows of R", CONTROLLABLE, (f"{FRAME}.w", [1] * 4), "MALFORMED"),
        (
            "the radii of A are larger",
            CONTROLLABLE,
            ("system.uncertainty.absolute.A.entries", [[0, 0, 1], [1, 1, 1]]),
            "INVALID",
        ),
        (
            "the radii of B are larger",
            CONTROLLABLE,
            ("system.uncertainty.absolute.B.1.entries", [[0, 0, 2]]),
            "INVALID",
        ),
        (
            "the radii of C are larger, about the dual",
            OBSERVABLE,
            ("system.uncertainty.absolute.C.2.entries", [[0, 1, 2]]),
            "INVALID",
        ),
        ("there is no bound", STABILIZABLE_BY_1, ("claim.bound", None), "INVALID"),
        ("the bound is larger", STABILIZABLE_BY_1, ("claim.bound", 2), "INVALID"),
        ("the radius is smaller", DETECTABLE, ("claim.bound", "1/2"), "INVALID"),
        ("a node is true", CONTROLLABLE, ("witness.cover.0.0", True), "MALFORMED"),
        ("a disc is not covered", CONTROLLABLE, ("witness.cover.0", []), "INVALID"),
        ("there are no discs", FED_BACK, ("witness.exterior", []), "MALFORMED"),
        ("discs of one matrix", FED_BACK, ("witness.exterior.1.F", None), "INVALID"),
        ("gains from the outputs", FED_BACK, ("witness.exterior.1.F.0", matrix([-2], [4]))),
        ("other gains", FED_BACK, ("witness.exterior.1.F.0", matrix([-1, 0], [0, 4])), "INVALID"),
        ("gains of channels", FED_BACK, ("witness.exterior.1.F", [matrix([-2, 0])] * 2)),
        ("channels fewer", FED_BACK, ("claim.channels", ["1"]), "MALFORMED"),
        (
            "the radii of B are larger under gains",
            FED_BACK,
            ("system.uncertainty.absolute.B.1.entries.0.2", "1/10"),
            "INVALID",
        ),
        ("a disc shrinks", CONTROLLABLE, ("witness.exterior.0.discs.0.radius", "0.2"), "INVALID"),
    ]
)


def test_the_radii_of_what_is_not_used_do_not_matter() -> None:
    """About the plant those of C, and about its dual those of B."""
    for document, key in ((CONTROLLABLE, "C"), (OBSERVABLE, "B"), (FED_BACK, "C")):
        parts = document["system"]["uncertainty"]["absolute"]
        kept = {name: part for name, part in parts.items() if name != key}
        system = {**document["system"], "uncertainty": {"absolute": kept}}
        assert checked({**document, "system": system}).verdict == "VALID"


def test_the_statement_says_which_modes_are_controlled() -> None:
    for document, said in (
        (CONTROLLABLE, '{"1", "2"} together control every mode'),
        (STABILIZABLE_BY_1, '{"1"} together control every mode of real part at least 0'),
        (DETECTABLE, '{"1"} together control every mode of modulus at least 7/8'),
    ):
        told = checked(document).statement.partition(" time): for all plants whose entries ")[2]
        assert told.endswith(f", the channels {said}")
    assert says(checked(OBSERVABLE).statement, "dual plant")


@pytest.mark.parametrize("part", ["exterior", "frames", "cover"])
def test_every_part_of_the_witness_is_needed(part: str) -> None:
    assert checked(without(CONTROLLABLE, f"witness.{part}")).verdict == "MALFORMED"
