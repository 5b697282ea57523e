"""The rule of ``distributed_observer``: the errors evolve by themselves, with these spectra."""

from __future__ import annotations

from tests.checker.handmade import Document, certificate, changed, checked, plant
from tests.checker.tables import accepts, rejects
from tests.checker.test_closed_loop_spectrum import SCALAR, STEP

ONE = certificate(
    "distributed_observer",
    SCALAR,
    {"feedback": [2, 1], "error": [4, 1], "bound": 1},
    {"moduli": [101]},
    STEP,
)
"""e = x_1 − x: ẋ = −2x − 3e, ė = −4e."""


def agent(name: str, other: str, K: int, H: int, F: int) -> Document:
    """ẋ_i = (1 + K + H + ΣF) x_i − K y_i − H x_j with A = 1, B = C = 1, F_1 = −1, F_2 = −2."""
    own = 1 - 3 + K + H
    return {
        "name": name,
        "shared": 1,
        "private": 0,
        "shared_update": {"outputs": {name: [[-K]]}, "shared": {name: [[own]], other: [[-H]]}},
        "private_update": {},
        "input": {"shared": {name: [[F]]}},
    }


PAIR = certificate(
    "distributed_observer",
    plant([[1]], ([[1]], [[1]]), ([[1]], [[1]]), neighbors={"1": ["2"], "2": ["1"]}),
    {"feedback": [2, 1], "error": [20, 10, 1], "bound": None},
    {"moduli": [101, 103]},
    {
        "construction": "closed_loop",
        "controller": {
            "time": "continuous",
            "agents": [agent("1", "2", -3, -2, -1), agent("2", "1", -4, 0, -2)],
        },
    },
)
"""ė_1 = (1 + K_1 + H_1 + F_2) e_1 − (H_1 + F_2) e_2 = −6 e_1 + 4 e_2 and
ė_2 = −(H_2 + F_1) e_1 + (1 + K_2 + H_2 + F_1) e_2 = e_1 − 4 e_2: (x + 6)(x + 4) − 4."""

SAMPLED = changed(
    ONE,
    ("system.time", "discrete"),
    ("subject.0.controller.time", "discrete"),
    ("system.A", [["1/2"]]),
    ("subject.0.controller.agents.0.shared_update.outputs.1", [["1/4"]]),
    ("subject.0.controller.agents.0.shared_update.shared.1", [[0]]),
    ("subject.0.controller.agents.0.input.shared.1", [["-1/4"]]),
    ("claim", {"feedback": ["-1/4", 1], "error": ["-1/4", 1], "bound": "1/2"}),
)
"""x(t+1) = x/2 + u, K = −1/4, F = −1/4: both parts move with 1/4."""

ACCEPTED = [
    ("one agent", ONE),
    ("two agents", PAIR),
    ("no bound", changed(ONE, ("claim.bound", None))),
    ("stable and no more", changed(ONE, ("claim.bound", 0))),
    ("any bound that holds", changed(ONE, ("claim.bound", "3/2"))),
    ("discrete time", SAMPLED),
    ("the unit circle", changed(SAMPLED, ("claim.bound", 1))),
    ("a composite modulus", changed(ONE, ("witness.moduli", [15]))),
]

EXCHANGED = {"feedback": [4, 1], "error": [2, 1], "bound": None}
OUTPUT = "subject.0.controller.agents.0.shared_update.outputs.1"

REJECTED = [
    (
        "channels of the loop merged, though it has none",
        ONE,
        ("subject", [*ONE["subject"], {"construction": "merged", "parts": []}]),
    ),
    (
        "gains for no channel of the loop",
        ONE,
        ("subject", [*ONE["subject"], {"construction": "feedback", "gains": []}]),
    ),
    ("feedback and error exchanged", ONE, ("claim", EXCHANGED)),
    ("the wrong feedback polynomial", ONE, ("claim.feedback", [3, 1])),
    ("the wrong error polynomial", ONE, ("claim.error", [5, 1])),
    ("a factor of the error polynomial", ONE, ("claim.error", [1])),
    ("all in one polynomial", ONE, ("claim.error", [8, 6, 1])),
    ("a bound that a root sits on", ONE, ("claim.bound", 2)),
    ("a bound beyond a root", ONE, ("claim.bound", 3)),
    ("a negative rate", ONE, ("claim.bound", -1)),
    ("a radius that a root sits on", SAMPLED, ("claim.bound", "1/4")),
    ("a radius of 0", SAMPLED, ("claim.bound", 0)),
    ("a radius above 1", SAMPLED, ("claim.bound", 2)),
    ("a bound that is no number", ONE, ("claim.bound", "fast")),
    ("errors driven by the state", ONE, (OUTPUT, [[6]])),
    ("no loop at all", ONE, ("subject", [])),
    ("an estimate of another size", ONE, ("subject.0.controller.agents.0.shared", 2)),
    ("too few moduli", ONE, ("witness.moduli", [7])),
    ("a modulus twice", ONE, ("witness.moduli", [101, 101])),
    ("a modulus that divides a denominator", SAMPLED, ("witness.moduli", [2, 101])),
]  # fmt: skip


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_a_loop_with_messages_under_way_is_refused() -> None:
    late = changed(
        PAIR,
        ("system.time", "discrete"),
        ("subject.0.controller.time", "discrete"),
        ("system.delays", {"1": {"2": 1}}),
    )
    verdict = checked(late)
    assert (verdict.verdict, verdict.place) == ("INVALID", "subject"), verdict.line()


def test_a_plant_without_states_is_no_loop() -> None:
    claim = {"feedback": [1], "error": [1], "bound": None}
    nothing = certificate("distributed_observer", plant([], ([], [])), claim, {"moduli": [101]})
    verdict = checked(nothing)
    assert (verdict.verdict, verdict.code) == ("INVALID", "subject"), verdict.line()
