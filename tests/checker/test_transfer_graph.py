"""The rule of ``transfer_graph``."""

from __future__ import annotations

import pytest

from mcexact.checker.core.reach import read_arcs, require_arcs, require_connected
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import read_plant
from tests.checker.handmade import GRAPH, certificate, changed, checked, matrix, plant
from tests.checker.tables import accepts, rejects

WHOLE = {"from": ["1", "2"], "X": matrix([1, 0], [0, 1]), "pivots": [0, 1]}
ZEROS = GRAPH["witness"]["zeros"]
THIRDS = matrix([0], [3], denominator=3)
TOO_MANY = [["1", "1"], ["1", "2"], ["2", "1"], ["2", "2"]]
DEAD = changed(
    GRAPH,
    ("system.channels.1.C", [[0, 0]]),
    ("claim.arcs", [["1", "1"]]),
    ("witness.powers", [0]),
    ("witness.zeros", [WHOLE, *ZEROS]),
)

GROWING = certificate(
    "transfer_graph",
    plant([[2]], ([[1]], [[1]])),
    {"arcs": [["1", "1"]], "components": [["1"]], "strongly_connected": True},
    {"modulus": 7, "powers": [0], "zeros": []},
)
"""C A^k B = 2^k for every k."""

CANCELS = certificate(
    "transfer_graph",
    plant([[0, 0], [0, 0]], ([[1], [-1]], [[1, 1]])),
    {"arcs": [], "components": [["1"]], "strongly_connected": True},
    {
        "modulus": 7,
        "powers": [],
        "zeros": [{"from": ["1"], "X": matrix([1], [-1]), "pivots": [0]}],
    },
)
"""The output is the sum of two states that the input drives in opposite directions."""
ROUND = certificate(
    "transfer_graph",
    plant(
        [[0, 0, 0], [0, 0, 1], [1, 0, 0]],
        ([[1], [0], [0]], [[0, 1, 0]]),
        ([[0], [0], [0]], [[0, 0, 1]]),
        ([[0], [2], [0]], [[1, 0, 0], [0, 0, 0]]),
    ),
    {
        "arcs": [["1", "1"], ["1", "2"], ["1", "3"], ["3", "1"]],
        "components": [["1", "3"], ["2"]],
        "strongly_connected": False,
    },
    {"modulus": 7, "powers": [2, 1, 0, 0], "zeros": []},
)
"""x_1 drives x_3, which drives x_2; no path leads to the other outputs."""

ACCEPTED = [
    ("terms that cancel on a path", CANCELS),
    ("paths against the order of the states", ROUND),
    ("the same modulo a prime of many bits", changed(ROUND, ("witness.modulus", 2**31 - 1))),
    ("the same modulo 64", changed(ROUND, ("witness.modulus", 64))),
    ("the same modulo 65", changed(ROUND, ("witness.modulus", 65))),
    ("no path, and no zero transfer", changed(GRAPH, ("witness.zeros", []))),
    ("one state", GROWING),
    ("a chain of two channels", GRAPH),
    ("a channel whose outputs see nothing", DEAD),
    ("a zero transfer that is not needed", changed(GRAPH, ("witness.zeros", [*ZEROS, WHOLE]))),
    ("another modulus", changed(GRAPH, ("witness.modulus", 2))),
    ("a column over a denominator", changed(GRAPH, ("witness.zeros.0.X", THIRDS))),
]  # fmt: skip

REJECTED = [
    ("an arc left out", ("claim.arcs", [["1", "1"], ["1", "2"]]), ("witness.powers", [0, 1])),
    ("an arc that is not there", ("claim.arcs", TOO_MANY), ("witness.powers", [0, 1, 0, 0])),
    ("arcs out of order", ("claim.arcs", [["1", "2"], ["1", "1"], ["2", "2"]])),
    ("an arc twice", ("claim.arcs", [["1", "1"], ["1", "1"], ["2", "2"]])),
    ("an arc to nowhere", ("claim.arcs.1", ["1", "3"])),
    ("an arc of three", ("claim.arcs.1", ["1", "2", "2"])),
    ("a power that gives 0", ("witness.powers.1", 0)),
    ("a power of n", ("witness.powers.1", 2)),
    ("a negative power", ("witness.powers.1", -1)),
    ("a power missing", ("witness.powers", [0, 1])),
    ("a zero transfer from the wrong channel", ("witness.zeros.0.from", ["1"])),
    ("X empty", ("witness.zeros.0.X", matrix([], [])), ("witness.zeros.0.pivots", [])),
    ("X not invariant", ("witness.zeros.0.X", matrix([1], [0])), ("witness.zeros.0.pivots", [0])),
    ("components merged", ("claim.components", [["1", "2"]])),
    ("components in another order", ("claim.components", [["2"], ["1"]])),
    ("a component left out", ("claim.components", [["1"]])),
    ("called strongly connected", ("claim.strongly_connected", True)),
    ("modulus 1", ("witness.modulus", 1)),
    ("a transfer that vanishes modulo ℓ", ("system.A.1.0", 7)),
    ("a plant with a transfer back", ("system.A.0.1", 1)),
]  # fmt: skip


PATHS = [
    ("a path, and no zero transfer", CANCELS, ("witness.zeros", [])),
    ("a path, and X that C sees", CANCELS, ("witness.zeros.0.X", matrix([1], [1]))),
    ("a path, and a zero transfer from nobody", CANCELS, ("witness.zeros.0.from", [])),
    (
        "an arc left out at the end of a path",
        ROUND,
        (("claim.arcs.1", ["1", "3"]), ("claim.arcs.2", ["3", "1"]), ("claim.arcs.3", ["3", "3"])),
    ),
    ("a power too low on a path", ROUND, ("witness.powers.0", 1)),
    ("a power too high on a path", ROUND, ("witness.powers.3", 1)),
    ("another output", ROUND, ("system.channels.1.C", [[1, 0, 0]])),
    ("another input", ROUND, ("system.channels.1.B", [[1], [0], [0]])),
    ("another path", ROUND, ("system.A.0.1", 1)),
    ("ℓ divides the input", ROUND, ("witness.modulus", 2)),
    ("ℓ divides a denominator", changed(ROUND, ("system.A.1.2", "1/3")), ("witness.modulus", 3)),
]
test_what_a_path_connects_needs_a_power_or_a_zero_transfer = rejects(PATHS)


@pytest.mark.parametrize("power", [1, 2, 10**9])
def test_no_power_beyond_the_number_of_states_is_computed(power: int) -> None:
    verdict = checked(changed(GROWING, ("witness.powers", [power])))
    assert (verdict.verdict, verdict.code) == ("INVALID", "arc"), verdict.line()


@pytest.mark.parametrize(
    ("arcs", "good"),
    [
        ([["1", "1", 0], ["1", "2", 1], ["2", "2", 0]], True),
        ([["1", "2", 1], ["1", "1", 0], ["2", "2", 0]], False),
        ([["2", "2", 0], ["1", "1", 0]], False),
        ([["1", "1", 0], ["1", "1", 0]], False),
        ([["1", "1", 0], ["1", "1", 1]], False),
        ([["1", "1", 0], ["1", "1", 0], ["2", "2", 0]], False),
        ([["1", "1", -1]], False),
        ([["1", "1"]], False),
    ],
)
def test_edges_are_sorted_and_none_is_given_twice(arcs: list[list[object]], good: bool) -> None:
    system = read_plant(GRAPH["system"])
    if good:
        assert read_arcs(arcs, "arcs", system) == [(0, 0, 0), (0, 1, 1), (1, 1, 0)]
    else:
        with pytest.raises(Refused) as found:
            read_arcs(arcs, "arcs", system)
        assert found.value.verdict == "MALFORMED"


test_sound_evidence_is_accepted = accepts(ACCEPTED)


@pytest.mark.parametrize("edits", REJECTED, ids=lambda row: str(row[0]))
def test_a_change_is_rejected(edits: tuple[object, ...]) -> None:
    verdict = checked(changed(GRAPH, *edits[1:]))  # type: ignore[arg-type]
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()


def test_a_transfer_that_vanishes_is_named_by_the_numbers_of_its_channels() -> None:
    system = read_plant(GRAPH["system"])
    require_arcs(system, [(0, 1, 1), (1, 1, 0)], 7)
    for ends, text in (((0, 1), "1 to 2"), ((1, 0), "2 to 1")):
        with pytest.raises(Refused) as found:
            require_arcs(system, [(*ends, 0)], 7)
        assert found.value.message == f"C A^0 B is 0 modulo l from channel number {text}"


RING = read_plant(
    plant(
        [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        *[([[int(i == k)] for i in range(3)], [[int(i == k) for i in range(3)]]) for k in range(3)],
    )
)
"""Channel 1 drives the state of channel 2, this one that of channel 3, and this one the first."""


@pytest.mark.parametrize(
    ("arcs", "good"),
    [
        ([["1", "2", 1], ["2", "3", 1], ["3", "1", 1]], True),
        ([["1", "2", 1], ["1", "3", 2], ["2", "1", 2], ["3", "1", 1]], True),
        ([["1", "2", 1], ["2", "1", 2]], False),
        ([["1", "2", 1], ["2", "3", 1]], False),
        ([["1", "2", 1], ["2", "3", 1], ["3", "1", 0]], False),
        ([], False),
    ],
)
def test_edges_connect_all_channels_or_prove_nothing(arcs: list[list[object]], good: bool) -> None:
    if good:
        require_connected(arcs, "arcs", RING, 7)
    else:
        with pytest.raises(Refused) as found:
            require_connected(arcs, "arcs", RING, 7)
        assert (found.value.verdict, found.value.code) == ("INVALID", "arc")
