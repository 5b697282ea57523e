"""The rule of ``box_fixed``: no member of a box has a fixed mode."""

from __future__ import annotations

import itertools
from fractions import Fraction

import pytest

from mcexact.checker.kinds import KINDS
from tests.checker.box_maker import decimal, fixed
from tests.checker.box_plants import (
    ALL,
    CUT,
    DISJOINT,
    EXTENDED,
    FIXED,
    NO_STATES,
    ONE_PLANT,
    OVERLAPPING,
    PAIR,
    SAMPLED_FIXED,
    STABILIZABLE,
    gains,
    uncertain,
)
from tests.checker.handmade import Document, certificate, changed, checked, matrix, plant, without
from tests.checker.tables import accepts, rejects
from tests.wording import says

KIND = "box_fixed"
OF_THIS_KIND = [(name, each) for name, each in ALL.items() if each["kind"] == KIND]

test_what_is_made_is_proved = accepts(OF_THIS_KIND)

NODE = "witness.cover.0"
EXTERIOR, SECOND = "witness.exterior.0", "witness.exterior.1"
DISC = f"{EXTERIOR}.discs.0"
FRAME = "witness.frames.0"
ZEROS = [[0, 0], [0, 0]]
SWAPPED = OVERLAPPING["witness"]["gains"][::-1]


def larger(document: Document, factor: int) -> tuple[str, Document]:
    """The same radii, all multiplied."""
    radii = {}
    for key, part in document["system"]["uncertainty"]["absolute"].items():
        listed = {"": part} if key == "A" else part
        grown = {
            name: {**M, "entries": [[i, j, str(Fraction(r) * factor)] for i, j, r in M["entries"]]}
            for name, M in listed.items()
        }
        radii[key] = grown[""] if key == "A" else grown
    return "system.uncertainty.absolute", radii


def first_alone(document: Document) -> tuple[str, list[Document]]:
    """The discs of the first matrix."""
    return "witness.exterior", document["witness"]["exterior"][:1]


def without_gains(document: Document) -> tuple[str, Document]:
    """The discs of the first matrix, which do not say of which."""
    first = document["witness"]["exterior"][0]
    return EXTERIOR, {key: part for key, part in first.items() if key != "F"}


def radius(key: str, value: str) -> tuple[str, str]:
    """Another radius of the first uncertain entry."""
    return f"system.uncertainty.absolute.{key}.entries.0.2", value


test_what_proves_less_is_refused = rejects(
    [
        ("the radii are larger", FIXED, larger(FIXED, 5), "INVALID"),
        (
            "an entry is uncertain that was certain",
            STABILIZABLE,
            (
                "system.uncertainty.absolute.A.entries",
                [[0, 0, "1/10"], [0, 1, 1], [1, 1, "1/20"]],
            ),
            "INVALID",
        ),
        ("a weight is 0", FIXED, (f"{FRAME}.w.0", 0), "MALFORMED"),
        ("weights are negative", FIXED, (f"{FRAME}.w", [-1] * 4), "MALFORMED"),
        ("a weight is true", FIXED, (f"{FRAME}.w.0", True), "MALFORMED"),
        ("a weight is missing", FIXED, (f"{FRAME}.w", [1] * 3), "MALFORMED"),
        ("a weight is much too large", FIXED, (f"{FRAME}.w.1", 1000), "INVALID"),
        (
            "V is 0",
            FIXED,
            ((f"{FRAME}.V.re", [[0] * 4] * 4), (f"{FRAME}.V.im", [[0] * 4] * 4)),
            "INVALID",
        ),
        ("V has another denominator", FIXED, (f"{FRAME}.V.denominator", 2**15), "INVALID"),
        ("V has the denominator 0", FIXED, (f"{FRAME}.V.denominator", 0), "MALFORMED"),
        ("V has other imaginary parts", FIXED, (f"{FRAME}.V.im.0", [2**15] * 4), "INVALID"),
        ("V has a row less", FIXED, (f"{FRAME}.V.im", [[0] * 4] * 3), "MALFORMED"),
        ("Y is 0", FIXED, ("witness.exterior.0.Y.re", ZEROS), "INVALID"),
        ("T is 0", FIXED, ("witness.exterior.0.T.re", ZEROS), "INVALID"),
        ("Y is singular", FIXED, ("witness.exterior.0.Y.re", [[1, 1], [1, 1]]), "INVALID"),
        ("Y mixes the rows", FIXED, ("witness.exterior.0.Y.re", [[0, 1], [1, 0]]), "INVALID"),
        ("a disc shrinks", FIXED, (f"{DISC}.radius", "0.1"), "INVALID"),
        ("a disc has no radius", ONE_PLANT, (f"{DISC}.radius", "0"), "INVALID"),
        ("a disc is of negative radius", FIXED, (f"{DISC}.radius", "-0.5"), "INVALID"),
        ("a disc is moved", FIXED, (f"{DISC}.re", "9"), "INVALID"),
        ("a disc is moved up", FIXED, (f"{DISC}.im", "9"), "INVALID"),
        ("a disc is moved below the axis", FIXED, ((f"{DISC}.im", "-9"), (NODE, [])), "INVALID"),
        ("a disc is missing", FIXED, ("witness.exterior.0.discs", []), "MALFORMED"),
        ("there are no discs", FIXED, ("witness.exterior", []), "MALFORMED"),
        ("discs have no gains", FIXED, without_gains(FIXED), "MALFORMED"),
        ("discs of one matrix prove nothing", DISJOINT, first_alone(DISJOINT), "INVALID"),
        ("discs are those of A twice", DISJOINT, (f"{SECOND}.F", None), "INVALID"),
        ("discs are those of other gains", DISJOINT, (f"{SECOND}.F.1", matrix([2])), "INVALID"),
        ("discs have the gains of one channel", DISJOINT, (f"{SECOND}.F", [matrix([3])])),
        ("gains are of all outputs", DISJOINT, (f"{SECOND}.F.0", matrix([3, 3])), "MALFORMED"),
        ("gains are 0 in the first place", CUT, (f"{EXTERIOR}.F.0", matrix([0])), "INVALID"),
        ("the radii of A are larger under gains", DISJOINT, radius("A", "1/5"), "INVALID"),
        ("the radii of B are larger under gains", DISJOINT, radius("B.1", "1/10"), "INVALID"),
        ("the radii of C are larger under gains", DISJOINT, radius("C.1", "1/10"), "INVALID"),
        ("a disc under gains is missing", DISJOINT, (f"{SECOND}.discs", []), "MALFORMED"),
        ("a disc under gains shrinks", DISJOINT, (f"{SECOND}.discs.0.radius", "0.4"), "INVALID"),
        ("a cell between discs has a node", CUT, ("witness.cover.1", [0]), "MALFORMED"),
        ("a cell that meets discs has no node", CUT, ("witness.cover.0", []), "INVALID"),
        ("nodes are missing", FIXED, ("witness.cover.1", []), "INVALID"),
        ("a node is missing", FIXED, ("witness.cover.1", FIXED["witness"]["cover"][1][:-1])),
        ("a list of nodes is missing", FIXED, ("witness.cover", [[0]]), "MALFORMED"),
        ("a list of nodes is null", FIXED, (NODE, None), "MALFORMED"),
        ("a node is too many", FIXED, (NODE, [0, 0]), "MALFORMED"),
        ("a node is false", FIXED, (f"{NODE}.0", False), "MALFORMED"),
        ("a node is negative", FIXED, (f"{NODE}.0", -1), "MALFORMED"),
        ("a node is no frame", FIXED, (f"{NODE}.0", 99), "MALFORMED"),
        ("a node is the first that is no frame", ONE_PLANT, (f"{NODE}.0", 1), "MALFORMED"),
        ("a node is another frame", FIXED, (f"{NODE}.0", 9), "INVALID"),
        ("a disc is not cut", FIXED, ("witness.cover.1", [1]), "INVALID"),
        (
            "a frame has no gains, where there is an eigenvalue",
            FIXED,
            (
                (f"{FRAME}.gains", None),
                (f"{FRAME}.w", [1, 1]),
                (f"{FRAME}.V", {"denominator": 1, "re": [[1, 0], [0, 1]], "im": ZEROS}),
            ),
            "INVALID",
        ),
        ("a frame has no gains, but their size", FIXED, (f"{FRAME}.gains", None), "MALFORMED"),
        ("frames have other gains", OVERLAPPING, ("witness.gains", SWAPPED), "INVALID"),
        ("gains are far beyond those given", OVERLAPPING, (f"{FRAME}.gains", 99), "MALFORMED"),
        ("gains are true", OVERLAPPING, (f"{FRAME}.gains", True), "MALFORMED"),
        ("gains are unknown", FIXED, (f"{FRAME}.gains", 1), "MALFORMED"),
        ("gains are 0", FIXED, ("witness.gains.0", gains((0, 1), (0, 1))), "INVALID"),
        (
            "X is wider than its channel",
            FIXED,
            ("witness.gains.0.X.0", matrix([3, 3])),
            "MALFORMED",
        ),
        ("W is of two channels", FIXED, ("witness.gains.0.W.0", matrix([1, 1])), "MALFORMED"),
        ("X is of one channel", FIXED, ("witness.gains.0.X", [matrix([3])]), "MALFORMED"),
        ("the bound is a rate below 0", STABILIZABLE, ("claim.bound", -1), "INVALID"),
        ("the bound is larger", STABILIZABLE, ("claim.bound", 2), "INVALID"),
        ("there is no bound", STABILIZABLE, ("claim.bound", None), "INVALID"),
        ("the radius is smaller", SAMPLED_FIXED, ("claim.bound", "3/4"), "INVALID"),
        ("the radius is 0", SAMPLED_FIXED, ("claim.bound", 0), "INVALID"),
        ("the subject has fewer outputs", EXTENDED, ("subject", []), "MALFORMED"),
    ]
)


def test_radii_are_part_of_the_statement_by_the_digest_of_the_plant() -> None:
    exact = {key: part for key, part in PAIR.items() if key != "uncertainty"}
    said, other = checked(FIXED), checked({**FIXED, "system": exact})
    assert said.verdict == other.verdict == "VALID"
    assert said.system_digest != other.system_digest
    values = other.system_digest
    assert says(said.statement, "plants differ") and values in said.statement
    assert says(other.statement, "alone radius")
    told = checked(STABILIZABLE).statement
    assert says(told, "part under")
    assert says(checked(SAMPLED_FIXED).statement, "modulus least")


def test_a_member_with_a_fixed_mode_is_never_overlooked() -> None:
    lost = plant([[1, 0], [0, 2]], ([["1/8"], [1]], [[1, 1]]))
    box = {**lost, "uncertainty": uncertain(None, {"1": [["1/8"], [0]]})}
    found = certificate(KIND, lost, *(ONE_PLANT[part] for part in ("claim", "witness")))
    for W, x in itertools.product([1, 5, -3], [8, -8, 100]):
        edits = ("witness.gains", [{"X": [matrix([x])], "W": [matrix([W])]}])
        assert checked(changed({**found, "system": box}, edits)).verdict != "VALID"


def test_what_is_fixed_is_in_a_disc_of_every_matrix() -> None:
    """−1 is fixed if the second channel measures nothing; its disc meets those of all matrices."""
    lost = changed(DISJOINT["system"], ("channels.1.C", [[0, 0]]), ("A", [[1, 0], [0, -1]]))
    for second in ([[-2]], [[3]]), ([[1]], [[100]]), ([[7]], [[-9]]):
        with pytest.raises(ArithmeticError, match="no cover"):
            fixed(lost, [gains((3, 1), (3, 1))], under=(None, second, ([[2]], [[2]])))


def test_a_disc_is_tested_as_it_is_and_a_square_by_the_disc_around_it() -> None:
    """x' = 0 with every radius 0 but that of the disc: V = 1/c."""
    document = changed(ONE_PLANT, ("system.A", [[0]]), (f"{DISC}.re", "0"))
    for radius, nodes, good in (
        ("0.9", [0], True),
        ("1.1", [0], False),
        ("1.1", [None, 0, 0, 0, 0], False),
    ):
        frame = {
            "gains": 0,
            "V": {"denominator": 1, "re": [[0, 1], [-1, 0]], "im": ZEROS},
            "w": [1, 1],
        }
        edits = [(f"{DISC}.radius", radius), (NODE, nodes), (FRAME, frame)]
        edits.append(("witness.gains", [gains((1, 0))]))
        assert (checked(changed(document, *edits)).verdict == "VALID") == good


@pytest.mark.parametrize("part", ["exterior", "gains", "frames", "cover"])
def test_every_part_of_the_witness_is_needed(part: str) -> None:
    assert checked(without(FIXED, f"witness.{part}")).verdict == "MALFORMED"


def test_a_plant_without_states_has_no_modes() -> None:
    assert checked(NO_STATES).verdict == "VALID"
    assert decimal(Fraction(-5, 4)) == "-1.250000"
    assert KINDS[KIND].check.__name__ == f"check_{KIND}"
