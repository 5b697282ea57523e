"""The rule of ``closed_loop_spectrum``: enough moduli make a polynomial the characteristic one."""

from __future__ import annotations

import copy

import pytest

from tests.checker.handmade import Document, certificate, changed, checked, plant
from tests.checker.tables import accepts, rejects

SCALAR = plant([[1]], ([[1]], [[1]]), neighbors={"1": []})
"""ẋ = x + u, y = x."""

CONTROLLER: Document = {
    "time": "continuous",
    "agents": [
        {
            "name": "1",
            "shared": 1,
            "private": 0,
            "shared_update": {"outputs": {"1": [[5]]}, "shared": {"1": [[-7]]}},
            "private_update": {},
            "input": {"shared": {"1": [[-3]]}},
        }
    ],
}
"""ẋ_1 = −7 x_1 + 5 y, u = −3 x_1: an observer with F = −3, K = −5."""

STEP: Document = {"construction": "closed_loop", "controller": CONTROLLER}

LOOP = certificate(
    "closed_loop_spectrum", SCALAR, {"polynomial": [8, 6, 1]}, {"moduli": [101, 103]}, STEP
)
"""[1, −3; 5, −7] has the characteristic polynomial (x + 2)(x + 4); β = (1 + 4)(1 + 12) = 65."""

HALF = "subject.0.controller.agents.0.input.shared.1"
FRACTION = changed(LOOP, (HALF, [["-3/2"]]), ("claim.polynomial", ["1/2", 6, 1]))
"""[1, −3/2; 5, −7]: denominators 2 and 1."""

OPEN = certificate("closed_loop_spectrum", SCALAR, {"polynomial": [-1, 1]}, {"moduli": [7]})

ACCEPTED = [
    ("two primes", LOOP),
    ("one composite modulus that is large enough", changed(LOOP, ("witness.moduli", [10403]))),
    ("more moduli than needed", changed(LOOP, ("witness.moduli", [101, 103, 107, 109]))),
    ("an entry that is no integer", FRACTION),
    ("a plant without a controller", OPEN),
    ("another loop", changed(LOOP, (HALF, [[-2]]), ("claim.polynomial", [3, 6, 1]))),
]

REJECTED = [
    ("a controller for the other time domain", LOOP, ("subject.0.controller.time", "discrete")),
    ("a plant in the other time domain", LOOP, ("system.time", "discrete")),
    ("another polynomial", LOOP, ("claim.polynomial", [9, 6, 1])),
    ("equal modulo ℓ only", LOOP, ("claim.polynomial", [8 + 101 * 103, 6, 1])),
    ("too few moduli", LOOP, ("witness.moduli", [101])),
    ("no moduli", LOOP, ("witness.moduli", [])),
    ("the same modulus twice", LOOP, ("witness.moduli", [101, 101])),
    ("moduli with a common factor", LOOP, ("witness.moduli", [101, 202])),
    ("modulus 1", LOOP, ("witness.moduli", [101, 103, 1])),
    ("modulus 0", LOOP, ("witness.moduli", [101, 103, 0])),
    ("a negative modulus", LOOP, ("witness.moduli", [-101, -103])),
    ("a modulus that divides a denominator", FRACTION, ("witness.moduli", [2, 101, 103])),
    ("degree 1 for a loop of 2 states", LOOP, ("claim.polynomial", [6, 1])),
    ("degree 3, a factor x more", LOOP, ("claim.polynomial", [0, 8, 6, 1])),
    ("degree 0", LOOP, ("claim.polynomial", [1])),
    ("not monic", LOOP, ("claim.polynomial", [16, 12, 2])),
    ("a fraction that no such loop has", LOOP, ("claim.polynomial", ["8/3", 6, 1])),
    ("a program of another loop", LOOP, (HALF, [[-2]])),
    ("the plant alone", LOOP, ("subject", [])),
    ("an agent that nobody has heard of", LOOP, ("subject.0.controller.agents.0.name", "2")),
]  # fmt: skip


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_the_theorem_states_the_polynomial() -> None:
    assert "x^2 + 6*x + 8" in checked(copy.deepcopy(LOOP)).statement


@pytest.mark.parametrize(
    ("document", "edit", "code"),
    [
        (LOOP, ("claim.polynomial", [6, 1]), "degree"),
        (LOOP, ("claim.polynomial", [0, 8, 6, 1]), "degree"),
        (LOOP, ("claim.polynomial", [66, 6, 1]), "bound"),
        (LOOP, ("claim.polynomial", ["1/2", 6, 1]), "bound"),
        (LOOP, ("witness.moduli", [131]), "VALID"),
        (LOOP, ("witness.moduli", [130]), "moduli"),
        (LOOP, ("claim.polynomial", [9, 6, 1]), "spectrum"),
        (FRACTION, ("witness.moduli", [2, 101, 103]), "modulus"),
    ],
)
def test_each_condition_refuses_by_itself(
    document: Document, edit: tuple[str, object], code: str
) -> None:
    verdict = checked(changed(document, edit))
    assert (verdict.code or verdict.verdict) == code, verdict.line()
