"""What verified claims say in one line: of every kind, short, and true of the claims."""

from __future__ import annotations

from pathlib import Path

import pytest

from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import KINDS, Expectation, Verdict
from mcexact.checker.summaries import LENGTH, SUMMARIES, cut
from tests.checker.handmade import FIXED, FREE, MODE, Document, changed, checked
from tests.checker.manifests import CONTROLLABLE, OBSERVABLE, manifest, sentence, write
from tests.checker.performance_plants import COST, MARGIN, OUTPUT_MARGIN, STEP_BOUND
from tests.checker.recorded import CORPUS, World
from tests.checker.test_statement import drawn
from tests.wording import worded

MORE = 200
"""The most characters of a line about a plant with at most four channels."""


def require_short(verdict: Verdict) -> None:
    line = verdict.line("'a_certificate.json'", short=True)
    assert verdict.verdict == "VALID", line
    assert 0 < len(verdict.summary) <= LENGTH and len(line) <= MORE, line
    assert len(line.splitlines()) == 1 and line.isascii(), line
    assert verdict.statement_digest not in line


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_every_kind_has_a_short_line(kind: str) -> None:
    for document in drawn(kind, 8):
        require_short(checked(document))


@pytest.mark.parametrize("path", sorted(CORPUS.glob("*.jsonl"))[::4], ids=lambda path: path.stem)
def test_certificates_of_answers_have_short_lines(path: Path) -> None:
    world = World.read(path)
    for k in range(0, len(world.certificates), 5):
        require_short(checked(world.document(k)))


SHORT: list[tuple[Document, str]] = [
    (FREE, "no mode is fixed; stabilizable by linear time-invariant decentralized control"),
    (FIXED, "the mode 1 is fixed; not stabilizable by linear time-invariant decentralized control"),
    (MODE, "it is not complete"),
    (CONTROLLABLE, 'the channels {"1", "2", "3"} together control every mode'),
    (OBSERVABLE, 'the channels {"1", "2", "3"} together observe every mode'),
    (COST, "closed loop: the loop is stable, at a cost of at most 7"),
    (STEP_BOUND, "every linear time-invariant controller has at least the cost 3/2"),
    (MARGIN, "closed loop: the loop is stable, and each input by itself has a disk margin of 1/2"),
    (
        changed(OUTPUT_MARGIN, ("claim.together", True)),
        "closed loop: the loop is stable, and all outputs together have a disk margin of 1/2",
    ),
]


@pytest.mark.parametrize(("document", "said"), SHORT, ids=[said for _, said in SHORT])
def test_the_line_says_what_one_wants_to_know(document: Document, said: str) -> None:
    assert checked(document).summary == said


def test_what_is_too_long_ends_with_dots() -> None:
    assert cut("x" * LENGTH) == "x" * LENGTH
    assert cut("x" * (LENGTH + 1)) == "x" * (LENGTH - 4) + " ..."


def test_nothing_is_said_of_what_is_not_valid() -> None:
    other = Expectation(system="0" * 64)
    false = changed(FREE, ("witness.gains.0.entries", [[0]]))
    for verdict in (checked(FREE, expected=other), checked(false)):
        assert verdict.summary == "" and verdict.code in verdict.line(short=True)
    assert {*SUMMARIES} <= {*KINDS}


def test_what_follows_names_statements_by_their_numbers(tmp_path: Path) -> None:
    evidence = {"cost": COST, "bound": STEP_BOUND}
    sentences = [
        sentence("performance-cost", "cost", evidence=evidence),
        sentence("performance-ratio", *evidence, evidence=evidence),
    ]
    write(tmp_path, evidence, manifest(evidence, sentences))
    *_, one, both = manifest_verdicts(str(tmp_path), Expectation(), Limits())
    assert [each.verdict for _, each in (one, both)] == ["IMPLIED"] * 2
    assert one[0]["premises"] == "2" and "at a cost of at most" in one[1].summary
    assert both[0]["premises"] == "2, 1"
    assert worded(both[1].summary)
