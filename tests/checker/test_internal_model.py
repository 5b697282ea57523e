"""The construction ``internal_model``: plants with models of signals that outputs follow."""

from __future__ import annotations

from typing import Any

from mcexact import MultiChannelSystem, fixed_spectrum, joint_controllability
from mcexact.answer.protocol import document
from mcexact.derived.constructions import extended_system, internal_model, servo_system
from tests.checker.handmade import Document, changed, checked, matrix
from tests.checker.tables import accepts, rejects

NOTCH = MultiChannelSystem([[0, 1], [-1, -2]], [[[0], [1]]], [[[3, -2]]], D=[[1]])
"""(s² + 4)/(s + 1)²: no sinusoid of 2 rad per unit of time reaches the output."""
LAG = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
APART = MultiChannelSystem([[-1, 0], [0, -1]], [[[1], [0]], [[0], [1]]], [[[1, 0], [0, 1]], []])
"""Agent 1 measures both states, each of which one agent moves."""
TALKING = APART.with_neighbors({"1": ["2"], "2": ["1"]})
LATE = MultiChannelSystem([[0]], [[[1]]], [[[1]]], time="discrete")


def about(plant: MultiChannelSystem, signals: str, *selection: Any) -> Document:
    """The fixed modes of a plant with models of signals."""
    return document(fixed_spectrum(internal_model(plant, signals, *selection)))


SHARED = document(
    fixed_spectrum(extended_system(internal_model(TALKING, "step"), [1, 1], "states"))
)
SINE, FREE = about(NOTCH, "ramp,sine:2"), about(LAG, "sine:2")
REACHED = document(joint_controllability(internal_model(LAG, "ramp")))
FIRST = about(APART, "ramp", [[[1, 0]], []])
ACCEPTED = [
    ("a zero of the plant is a root of the signals", SINE),
    ("nothing is fixed where the plant has no such zero", FREE),
    ("an agent with more outputs than inputs fixes the signals", about(APART, "ramp")),
    ("one output for each input", FIRST),
    ("agents that share states over a strongly connected graph", SHARED),
    ("all inputs together reach the ramp", REACHED),
    ("signals that are 0 after a step in discrete time", about(LATE, "poly:z")),
    ("constants, as with integrators", about(LAG, "step")),
]
STEP = "subject.0"
REJECTED = [
    ("other sinusoids, which reach the output", SINE, (f"{STEP}.polynomial", [0, 0, 3, 0, 1])),
    ("a ramp at which nothing is fixed", SINE, (f"{STEP}.polynomial", [0, 0, 1])),
    ("another number of states", REACHED, (f"{STEP}.polynomial", [0, 1])),
    ("no signals of the first agent", FIRST, (f"{STEP}.gains.0.entries", [])),
    ("both outputs are followed", FIRST, (f"{STEP}.gains.0.entries", [[1, 0], [0, 1]])),
    ("a constant polynomial", FREE, (f"{STEP}.polynomial", [1]), "MALFORMED"),
    ("a polynomial that is not monic", FREE, (f"{STEP}.polynomial", [4, 0, 2]), "MALFORMED"),
    ("no polynomial", FREE, (f"{STEP}.polynomial", None), "MALFORMED"),
    ("a decimal number", FREE, (f"{STEP}.polynomial", [4.0, 0, 1]), "MALFORMED"),
    ("a selection for one agent more", FREE, (f"{STEP}.gains", [matrix([1])] * 2), "MALFORMED"),
    ("outputs that are not there", FREE, (f"{STEP}.gains.0.entries", [[1, 1]]), "MALFORMED"),
    ("a key that nobody knows", FREE, (f"{STEP}.blocks", 1), "MALFORMED"),
]

test_a_true_claim_about_signals_is_accepted = accepts(ACCEPTED)
test_anything_else_is_rejected = rejects(REJECTED)


def test_a_statement_names_the_signals() -> None:
    words = "with models of the signals of x^2 + 4 for the combinations S of its outputs with"
    assert words in checked(FREE).statement


def test_constants_are_the_signals_of_integrators() -> None:
    """The claim about the one is a claim about the other."""
    servo = document(fixed_spectrum(servo_system(LAG, [[[1]]])))
    other = {
        "construction": "internal_model",
        "polynomial": [0, 1],
        "gains": servo["subject"][0]["gains"],
    }
    assert checked(changed(servo, (STEP, other))).verdict == "VALID"
