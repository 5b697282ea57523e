"""The construction ``modulo``: a part of the state that no output shows, or that no input moves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.constructions import read_subject
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import read_plant
from tests.checker.handmade import (
    FREE,
    PAIR,
    UNCONTROLLABLE,
    Document,
    certificate,
    changed,
    checked,
    matrix,
    plant,
)
from tests.checker.manifests import manifest, one, said, sentence, write
from tests.checker.performance_plants import static
from tests.checker.tables import accepts, rejects
from tests.wording import says


def part(side: str, W: Document, pivots: Any, polynomial: Any) -> Document:
    """The construction with these parameters."""
    return {
        "construction": "modulo",
        "part": side,
        "annihilator": W,
        "pivots": pivots,
        "polynomial": polynomial,
    }


RELATIVE = plant([[0, 0], [0, 0]], ([[1], [0]], [[1, -1]]), ([[0], [1]], [[-1, 1]]))
"""Two integrators that measure their distance: no output shows (1, 1)."""
TOGETHER = part("unobservable", matrix([1, 1]), [0], [0, 1])
DISTANCE = certificate(
    "fixed_spectrum",
    RELATIVE,
    FREE["claim"],
    {**FREE["witness"], "gains": [matrix([1]), matrix([1])]},
    TOGETHER,
)
"""z = x_2 - x_1, z' = u_2 - u_1, y_1 = -z, y_2 = z."""
UNMOVED = part("uncontrollable", matrix([0, 1]), [1], [-2, 1])
"""Of diag(1, 2) the channel moves the first state alone."""
FIRST = changed(
    UNCONTROLLABLE,
    ("subject", [UNMOVED]),
    (
        "claim",
        {
            "channels": ["1"],
            "dimension": 1,
            "controllable": True,
            "uncontrollable_polynomial": [1],
        },
    ),
    ("witness", {"modulus": 7, "annihilator": {"denominator": 1, "entries": []}, "pivots": []}),
)
MOVED = certificate("fixed_spectrum", PAIR, FREE["claim"], FREE["witness"], UNMOVED)
SLANTED = plant([[1, 0], [1, 2]], ([[1], [-1]], [[1, 1]]))
"""x_1 + x_2 is multiplied by 2 and no input moves it."""
ALONG = certificate(
    "closed_loop_spectrum",
    SLANTED,
    {"polynomial": [-1, 1]},
    {"moduli": [7]},
    part("uncontrollable", matrix([1, 1]), [1], [-2, 1]),
)
"""On x_2 = -x_1 the state x_1 has the eigenvalue 1."""
ACROSS = certificate(
    "closed_loop_spectrum",
    plant([[1, 1], [0, 2]], ([[1], [1]], [[1, -1]])),
    {"polynomial": [-1, 1]},
    {"moduli": [7]},
    part("unobservable", matrix([1, 1]), [0], [-2, 1]),
)

ACCEPTED = [
    ("nothing is fixed modulo what two integrators have in common", DISTANCE),
    ("the same by the other state", changed(DISTANCE, ("subject.0.pivots", [1]))),
    ("the state that the channel moves is controlled", FIRST),
    ("nothing is fixed of the state that the channel moves", MOVED),
    ("A on a slanted subspace", ALONG),
    ("A modulo a slanted subspace", ACROSS),
    (
        "over a denominator",
        changed(DISTANCE, ("subject.0.annihilator", matrix([2, 2], denominator=2))),
    ),
]

W, PIVOTS, CHI = (f"subject.0.{key}" for key in ("annihilator", "pivots", "polynomial"))
REJECTED = [
    ("a subspace that an output shows", DISTANCE, (W, matrix([1, 0])), "INVALID"),
    ("nearly the subspace", DISTANCE, (W, matrix([1, 2])), "INVALID"),
    ("the other part", DISTANCE, ("subject.0.part", "uncontrollable"), "INVALID"),
    ("the part of the dual", ALONG, ("subject.0.part", "unobservable"), "INVALID"),
    ("a part that the input moves", FIRST, ((W, matrix([1, 0])), (PIVOTS, [0])), "INVALID"),
    ("a subspace that A leaves", ACROSS, ("system.A", [[1, 1], [1, 2]]), "INVALID"),
    ("the dual of a subspace that A leaves", ALONG, ("system.A", [[1, 1], [1, 2]]), "INVALID"),
    ("another eigenvalue of the part", ACROSS, (CHI, [-1, 1]), "INVALID"),
    ("the polynomial of the plant", ACROSS, (CHI, [2, -3, 1]), "INVALID"),
    ("the polynomial 1", ACROSS, (CHI, [1]), "MALFORMED"),
    ("a polynomial that is not monic", ACROSS, (CHI, [-4, 2]), "MALFORMED"),
    ("no identity at the pivots", DISTANCE, (W, matrix([2, 2])), "INVALID"),
    ("a pivot of zeros", FIRST, (PIVOTS, [0]), "INVALID"),
    ("a pivot beyond the states", DISTANCE, (PIVOTS, [2]), "MALFORMED"),
    ("a pivot below 0", DISTANCE, (PIVOTS, [-1]), "MALFORMED"),
    ("a truth value for a pivot", DISTANCE, (PIVOTS, [False]), "MALFORMED"),
    ("a pivot twice", DISTANCE, ((W, matrix([1, 1], [1, 1])), (PIVOTS, [0, 0])), "MALFORMED"),
    (
        "pivots in another order",
        FIRST,
        (("system.channels.0.B", [[0], [0]]), (W, matrix([0, 1], [1, 0])), (PIVOTS, [1, 0])),
        "MALFORMED",
    ),
    ("more pivots than rows", DISTANCE, (PIVOTS, [0, 1]), "MALFORMED"),
    (
        "no rows",
        DISTANCE,
        ((W, {"denominator": 1, "entries": []}), (PIVOTS, []), (CHI, [1])),
        "MALFORMED",
    ),
    ("a row too long", DISTANCE, (W, matrix([1, 1, 0])), "MALFORMED"),
    ("another word for the part", DISTANCE, ("subject.0.part", "hidden"), "MALFORMED"),
    ("a part that is no word", DISTANCE, ("subject.0.part", None), "MALFORMED"),
    ("something given besides", DISTANCE, ("subject.0.dimension", 1), "MALFORMED"),
    ("the whole plant", DISTANCE, ("subject", []), "INVALID"),
    ("the same part twice", DISTANCE, ("subject", [TOGETHER, TOGETHER]), "MALFORMED"),
]

test_a_true_claim_without_a_part_is_accepted = accepts(ACCEPTED)
test_anything_else_is_rejected = rejects(REJECTED)


def test_the_theorem_names_the_part_that_was_left_out() -> None:
    said = checked(DISTANCE).statement
    assert says(said, "unobservable characteristic")
    assert '= {"W":[[1,1]],"pivots":[0]} (1 state, channels {"1", "2"}' in said
    assert says(checked(FIRST).statement, "uncontrollable characteristic")


def test_the_graph_and_its_delays_stay() -> None:
    heard = {"neighbors": {"1": ["2"], "2": []}, "delays": {"1": {"2": 3}}}
    made = read_subject([TOGETHER], read_plant({**RELATIVE, "time": "discrete", **heard}))
    assert made.neighbors == [[0, 1], [1]] and made.delays == {(0, 1): 3}
    assert made.names == ["1", "2"] and made.n == 1


@pytest.mark.parametrize("side", ["unobservable", "uncontrollable"])
def test_all_states_may_go(side: str) -> None:
    idle = plant([[0, 1], [-1, 0]], ([[0], [0]], [[0, 0]]))
    whole = part(side, matrix([1, 0], [0, 1]), [0, 1], [1, 0, 1])
    assert read_subject([whole], read_plant(idle)).n == 0
    with pytest.raises(Refused) as found:
        read_subject([part(side, matrix([1, 0]), [0], [0, 1])], read_plant(idle))
    assert found.value.verdict == "INVALID"


def about_the_rest(folder: Path, *keys: str) -> list[Any]:
    """The verdicts on sentences about a plant modulo what no output shows."""
    evidence = {"fixed": DISTANCE}
    listed = {**manifest(evidence, [sentence(key, "fixed", evidence=evidence) for key in keys])}
    return said(write(folder, evidence, listed | {"subject": [TOGETHER]}))


def test_modes_of_the_part_stay_in_every_loop(tmp_path: Path) -> None:
    found = about_the_rest(tmp_path, "modulo-unobservable", "modulo-uncontrollable")
    assert [each.verdict for each in found] == ["IMPLIED", "INVALID"]
    assert says(found[0].statement, "roots eigenvalues")


def test_of_a_plant_without_a_part_nothing_stays(tmp_path: Path) -> None:
    evidence = {"fixed": FREE}
    what = sentence("modulo-unobservable", "fixed", evidence=evidence)
    assert one(tmp_path, what, evidence).verdict == "INVALID"


RESTRICTED: Document = {"construction": "restricted", "channels": ["1"]}
SAMPLED: Document = {"construction": "sampled", "step": 1, "late": 0, "decimals": 3}
APART = plant([[1, 0], [0, 2]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]))
STILL = plant([[0, 0], [0, 0]], ([[1], [0]], [[1, 0]]))
OF_OTHER_LOOPS = {
    "a mode that a channel left out moves": certificate(
        "fixed_spectrum", APART, FREE["claim"], FREE["witness"], RESTRICTED, UNMOVED
    ),
    "a mode of one loop": certificate(
        "closed_loop_spectrum",
        APART,
        {"polynomial": [-1, 1]},
        {"moduli": [7]},
        static(APART, 0, 0),
        UNMOVED,
    ),
    "a mode of the plant at its samples": certificate(
        "fixed_spectrum",
        STILL,
        FREE["claim"],
        FREE["witness"],
        SAMPLED,
        part("uncontrollable", matrix([0, 1]), [1], [-1, 1]),
    ),
}


@pytest.mark.parametrize("of_other_loops", OF_OTHER_LOOPS.values(), ids=list(OF_OTHER_LOOPS))
def test_modes_of_another_system_are_not_those_of_every_loop_of_the_plant(
    tmp_path: Path, of_other_loops: Document
) -> None:
    assert checked(of_other_loops).verdict == "VALID"
    evidence = {"fixed": of_other_loops}
    what = sentence("modulo-uncontrollable", "fixed", evidence=evidence)
    listed = manifest(evidence, [what]) | {"subject": of_other_loops["subject"]}
    [found] = said(write(tmp_path, evidence, listed))
    assert found.verdict == "INVALID"


def test_what_is_fixed_besides_is_about_what_the_agents_receive(tmp_path: Path) -> None:
    heard = plant(
        [[1, 0], [0, 2]],
        ([[1], [0]], [[0, 0]]),
        ([[0], [0]], [[1, 0]]),
        neighbors={"1": ["2"], "2": []},
    )
    steps = {"construction": "augmented_outputs"}, UNMOVED
    gains = {**FREE["witness"], "gains": [matrix([0, 1]), matrix([0])]}
    evidence = {"fixed": certificate("fixed_spectrum", heard, FREE["claim"], gains, *steps)}
    found = one(tmp_path, sentence("decentralized-none", "fixed", evidence=evidence), evidence)
    assert found.verdict == "IMPLIED"
    assert says(found.statement, "measuring receives")
