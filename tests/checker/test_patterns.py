"""The rule of ``structural_fixed_modes``, and of the sentences that rest on it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.patterns import structural_fixed_modes
from mcexact.answer.protocol import document
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation
from mcexact.model.system import MultiChannelSystem
from tests.checker.handmade import STAR, Document, certificate, changed, checked, plant, without
from tests.checker.manifests import manifest, sentence, write

STUCK = certificate(
    "structural_fixed_modes",
    plant([[0, 0], [1, 0]], ([[0], [1]], [[0, 1]])),
    {"information": "own", "without_feedback": [0], "at_zero": 0, "polynomial": [0, 1]},
    {"rows": [0, 0, 0], "columns": [0, 0, 0], "matching": [2, 3, 1]},
)
"""An integrator that no input drives: its own number is 0."""
EMPTY = certificate(
    "structural_fixed_modes",
    plant([], ([], [])),
    {"information": "own", "without_feedback": [], "at_zero": 0, "polynomial": [1]},
    {"rows": [], "columns": [], "matching": []},
)
ACCEPTED = [
    ("a star", STAR),
    ("over a graph that changes nothing", changed(STAR, ("claim.information", "outputs"))),
    (
        "other potentials",
        changed(
            STAR,
            ("witness.rows", [5, 6, 6, 5, 5, 5, 5]),
            ("witness.columns", [-6, -5, -5, -5, -5, -5, -5]),
        ),
    ),
    (
        "a state that is left out, of two",
        changed(STAR, ("witness.matching", [4, 2, 1, 6, 5, 3, 7])),
    ),
    ("an integrator without input", STUCK),
    ("no states", EMPTY),
]
REJECTED = [
    ("other information", changed(STAR, ("claim.information", "all"))),
    ("information of no kind", changed(STAR, ("claim.information", ["own"]))),
    ("a state too few without feedback", changed(STAR, ("claim.without_feedback", []))),
    ("a state too many", changed(STAR, ("claim.without_feedback", [0, 1]))),
    ("a state that is not there", changed(STAR, ("claim.without_feedback", [4]))),
    ("more modes at 0", changed(STAR, ("claim.at_zero", 2), ("claim.polynomial", [0, 0, -7, 1]))),
    ("fewer modes at 0", changed(STAR, ("claim.at_zero", 0), ("claim.polynomial", [-7, 1]))),
    (
        "fewer, and so do the potentials say",
        changed(STAR, ("claim.at_zero", 0), ("claim.polynomial", [-7, 1]), ("witness.rows.0", -1)),
    ),
    (
        "more, and so do the potentials say",
        changed(
            STAR, ("claim.at_zero", 2), ("claim.polynomial", [0, 0, -7, 1]), ("witness.rows.0", 1)
        ),
    ),
    (
        "more, and so does the matching say",
        changed(
            STAR,
            ("claim.at_zero", 3),
            ("claim.polynomial", [0, 0, 0, -7, 1]),
            ("witness.matching", [1, 2, 3, 4, 5, 6, 7]),
        ),
    ),
    ("potentials above a place", changed(STAR, ("witness.rows.3", 1), ("witness.rows.4", -1))),
    ("a row twice", changed(STAR, ("witness.matching", [4, 1, 3, 6, 5, 2, 2]))),
    ("an entry that is 0", changed(STAR, ("witness.matching", [4, 1, 2, 6, 5, 3, 7]))),
    ("a row of the state without feedback", changed(STAR, ("witness.matching.0", 0))),
    ("other modes", changed(STAR, ("claim.polynomial", [0, 7, 1]))),
    ("a potential that is no integer", changed(STAR, ("witness.rows.0", "0"))),
    ("a potential too few", changed(STAR, ("witness.rows", [0, 1, 1, 0, 0, 0]))),
    (
        "potentials that are long",
        changed(STAR, ("witness.rows.3", -(2**40)), ("witness.columns.5", 2**40)),
    ),
    ("without a matching", without(STAR, "witness.matching")),
    ("a graph that is not there", changed(STUCK, ("claim.information", "outputs"))),
]


@pytest.mark.parametrize(("reason", "found"), ACCEPTED)
def test_a_true_answer_is_accepted(reason: str, found: Document) -> None:
    verdict = checked(found)
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize(("reason", "found"), REJECTED)
def test_anything_else_is_rejected(reason: str, found: Document) -> None:
    verdict = checked(found)
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()


EQUAL = MultiChannelSystem(
    [[1, 2, 0], [4, -1, 0], [0, 0, 5]], [[[1], [0], [0]], [[0], [0], [0]]], [[[1, -1, 0]], []]
)
"""The rows of the first block sum to 3, and the output is a difference; 5 is driven by no input."""
FREE = MultiChannelSystem([[1, 2], [4, -1]], [[[1], [0]]], [[[1, 0]]])
REASONS: list[tuple[str, MultiChannelSystem, str, list[int], str, str]] = [
    ("the zeros fix 5", EQUAL, "own", [0], "fixed-by-zeros", "IMPLIED"),
    ("equalities fix 3", EQUAL, "own", [1], "fixed-by-equalities", "IMPLIED"),
    ("the zeros do not fix 3", EQUAL, "own", [1], "fixed-by-zeros", "INVALID"),
    ("equalities do not fix 5", EQUAL, "own", [0], "fixed-by-equalities", "INVALID"),
    ("the zeros do not fix both", EQUAL, "own", [], "fixed-by-zeros", "INVALID"),
    ("equalities do not fix both", EQUAL, "own", [0, 1], "fixed-by-equalities", "INVALID"),
    ("nothing is fixed", FREE, "own", [], "fixed-by-equalities", "INVALID"),
    ("outputs of neighbors", EQUAL, "outputs", [0], "fixed-by-zeros", "INVALID"),
    ("5 is fixed for all numbers", EQUAL, "own", [], "structural-modes", "IMPLIED"),
    ("5 is fixed with outputs of neighbors", EQUAL, "outputs", [], "structural-modes", "IMPLIED"),
    ("something is fixed for all numbers", EQUAL, "own", [], "structural-none", "INVALID"),
    ("nothing is fixed for all numbers", FREE, "own", [], "structural-none", "IMPLIED"),
    ("nothing is there to name", FREE, "own", [], "structural-modes", "INVALID"),
]


@pytest.mark.parametrize(
    ("system", "information", "factors", "rule", "verdict"),
    [row[1:] for row in REASONS],
    ids=[row[0] for row in REASONS],
)
def test_what_fixes_a_mode_is_implied_by_the_pattern(
    tmp_path: Path, system: Any, information: Any, factors: list[int], rule: str, verdict: str
) -> None:
    system = system.with_neighbors({name: [] for name in system.names})
    evidence = {
        "given": document(fixed_spectrum(system)),
        "pattern": document(structural_fixed_modes(system, information)),
    }
    listed = evidence["given"]["claim"]["factors"]
    because: list[list[Any]] = [
        ["pattern.json", "/kind", "structural_fixed_modes"],
        ["given.json", "/kind", "fixed_spectrum"],
    ]
    because += [["given.json", f"/claim/factors/{k}", listed[k]] for k in factors]
    write(tmp_path, evidence, manifest(evidence, [{**sentence(rule), "because": because}]))
    verdicts = [each for _, each in manifest_verdicts(str(tmp_path), Expectation(), Limits())]
    assert [each.verdict for each in verdicts] == ["VALID", "VALID", verdict], verdicts[-1].line()
