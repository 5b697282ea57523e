"""The checker's rules about costs, bounds, margins and sectors of loops."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mcexact.checker.sentences import RULES
from tests.checker.box_plants import (
    AGAIN,
    AT_ITS_STEP,
    BY_TUSTIN,
    HELD_ALONE,
    HELD_AROUND,
    HELD_LOOP,
    LAGGING,
    LATE,
    OTHERWISE,
    PART_CERTAIN,
    PART_STABLE,
    PROMPT,
    ROUNDED,
    TO_12_DIGITS,
    WEAKER,
)
from tests.checker.handmade import Document, changed
from tests.checker.performance_plants import (
    COST,
    FOLLOWING,
    GROUPS,
    MARGIN,
    ONE_WAY_COST,
    OUTPUT_MARGIN,
    SECTOR,
    SENSED,
    STEP_BOUND,
    STEPPED,
)
from tests.checker.recorded import compare, keys
from tests.checker.saturation_plants import CUT, INTEGRAL, NEAR, RISEN
from tests.checker.test_sentences_design import STABLE, judged, rows
from tests.wording import says

TOGETHER = ("claim.together", True)
ALL_INPUTS, ALL_OUTPUTS = changed(MARGIN, TOGETHER), changed(OUTPUT_MARGIN, TOGETHER)
GAIN = "subject.0.controller.agents.0.input.outputs.1"
OTHER_LOOP = changed(OUTPUT_MARGIN, (GAIN, [["-3/4"]]))
OTHER_WEIGHTS = changed(STEP_BOUND, ("claim.weights.noise", [2]), ("witness.groups.0.noise", [2]))
NOTHING = changed(STEP_BOUND, ("claim.cost", 0))
IMPLIED: list[tuple[str, list[Document]]] = [
    ("performance-cost", [COST]),
    ("performance-bound", [STEP_BOUND]),
    ("performance-bound-graph", [GROUPS]),
    ("performance-ratio first-cost", [COST, STEP_BOUND]),
    ("performance-ratio first-cost", [STEP_BOUND, COST]),
    ("performance-ratio-graph", [ONE_WAY_COST, GROUPS]),
    ("performance-input-margin", [MARGIN]),
    ("performance-output-margin", [OUTPUT_MARGIN]),
    ("performance-all-inputs-margin", [ALL_INPUTS]),
    ("performance-all-outputs-margin", [ALL_OUTPUTS]),
    ("first-margin", [MARGIN, OUTPUT_MARGIN]),
    ("first-margin", [ALL_OUTPUTS, MARGIN]),
    ("performance-another-step", [HELD_LOOP, *AGAIN]),
    ("performance-another-step", [HELD_LOOP, AGAIN[1], AGAIN[0], AT_ITS_STEP]),
    *(("performance-at-samples", [LAGGING, *each]) for each in (BY_TUSTIN, TO_12_DIGITS)),
    ("performance-sectors", [SECTOR]),
    *(("saturation-global first-saturation", [each]) for each in (CUT, INTEGRAL)),
    *(("saturation-region first-saturation-region", [each]) for each in (NEAR, RISEN)),
    ("performance-input-steps", [STEPPED]),
    ("performance-output-steps", [SENSED]),
    ("performance-setpoint-steps", [FOLLOWING]),
    *(("first-box first-radii", [each]) for each in (PART_STABLE, PART_CERTAIN, HELD_AROUND)),
    ("first-exact first-radii", [HELD_ALONE]),
    ("first-sampled", [HELD_LOOP]),
]
DENIED: list[tuple[str, list[Document]]] = [
    ("performance-cost performance-ratio first-cost", [STEP_BOUND]),
    ("performance-bound performance-bound-graph performance-ratio", [COST]),
    ("performance-bound", [GROUPS]),
    ("performance-bound-graph", [STEP_BOUND]),
    ("performance-ratio first-cost", [COST, OTHER_WEIGHTS]),
    ("performance-ratio first-cost", [COST, NOTHING]),
    ("performance-ratio first-cost", [COST, changed(STEP_BOUND, ("claim.cost", -1))]),
    ("performance-ratio first-cost", [ONE_WAY_COST, GROUPS]),
    ("performance-ratio-graph", [COST, STEP_BOUND]),
    ("performance-input-margin", [OUTPUT_MARGIN]),
    ("performance-output-margin", [MARGIN]),
    ("performance-input-margin performance-output-margin", [ALL_INPUTS]),
    ("performance-all-inputs-margin performance-all-outputs-margin", [MARGIN]),
    ("performance-all-outputs-margin", [ALL_INPUTS]),
    ("performance-all-inputs-margin", [ALL_OUTPUTS]),
    ("first-margin", [MARGIN]),
    ("first-margin", [OUTPUT_MARGIN, ALL_OUTPUTS]),
    ("first-margin", [MARGIN, OTHER_LOOP]),
    ("performance-another-step", AGAIN),
    ("performance-another-step", [HELD_LOOP, *AGAIN[:1]]),
    ("performance-another-step", [HELD_LOOP, AT_ITS_STEP, AGAIN[1]]),
    *(("performance-another-step", [HELD_LOOP, *each]) for each in (PROMPT, ROUNDED, WEAKER)),
    ("performance-another-step", [HELD_LOOP, AGAIN[0], WEAKER[1]]),
    ("performance-another-step", [MARGIN, OUTPUT_MARGIN]),
    *(("performance-at-samples", [LAGGING, *each]) for each in OTHERWISE),
    ("performance-at-samples", [LAGGING, BY_TUSTIN[0], TO_12_DIGITS[1]]),
    ("performance-at-samples", [LAGGING, BY_TUSTIN[0]]),
    ("performance-at-samples", BY_TUSTIN),
    ("performance-at-samples", [LAGGING, *LATE]),
    ("performance-at-samples", [HELD_LOOP, *AGAIN]),
    ("performance-another-step first-margin", [LAGGING, *BY_TUSTIN]),
    ("first-margin performance-input-margin", [HELD_LOOP, *AGAIN]),
    ("performance-sectors", [MARGIN]),
    ("saturation-global first-saturation", [NEAR]),
    ("saturation-region first-saturation-region", [CUT]),
    ("saturation-global first-saturation", [SECTOR]),
    ("performance-input-steps performance-setpoint-steps", [SENSED]),
    ("performance-output-steps", [STEPPED]),
    ("first-box first-radii", [STABLE]),
    *(("first-exact", [each]) for each in (PART_STABLE, HELD_AROUND, HELD_LOOP)),
    *(("first-sampled", [each]) for each in (STABLE, HELD_ALONE)),
]


@pytest.mark.parametrize(("key", "documents"), rows(IMPLIED))
def test_what_certificates_imply_of_performance(
    tmp_path: Path, key: str, documents: list[Document]
) -> None:
    verdict = judged(tmp_path, key, documents)
    assert verdict.verdict == "IMPLIED", verdict.line()


@pytest.mark.parametrize("margins", [("1/3", "1/2"), ("1/2", "1/3")])
def test_the_least_margin_is_that_of_inputs_or_of_outputs(
    tmp_path: Path, margins: tuple[str, str]
) -> None:
    both = zip((MARGIN, OUTPUT_MARGIN), margins, strict=True)
    documents = [changed(each, ("claim.margin", size)) for each, size in both]
    found = judged(tmp_path, "first-margin", documents)
    assert re.findall("[0-9]+/[0-9]+", found.statement)[-1] == "1/3"


@pytest.mark.parametrize(("key", "documents"), rows(DENIED))
def test_what_certificates_do_not_imply_of_performance(
    tmp_path: Path, key: str, documents: list[Document]
) -> None:
    assert judged(tmp_path, key, documents).verdict == "INVALID"


def test_every_rule_about_performance_is_in_both_tables() -> None:
    about = {key for key in RULES if key.startswith(("performance-", "saturation-", "first-"))}
    assert about == {key for key, _ in rows(IMPLIED)} == {key for key, _ in rows(DENIED)}


def test_the_ratio_of_a_cost_and_a_bound_is_that_of_the_claims(tmp_path: Path) -> None:
    said = judged(tmp_path, "first-cost", [COST, STEP_BOUND]).statement
    assert says(said, "former latter")
    assert says(said, "invariant makes")


def test_the_least_of_two_margins_is_said(tmp_path: Path) -> None:
    less = changed(OUTPUT_MARGIN, ("claim.margin", "1/3"))
    said = judged(tmp_path, "first-margin", [MARGIN, less]).statement
    assert says(said, "itself disk")


def test_the_largest_peak_where_a_step_is_is_said(tmp_path: Path) -> None:
    wide = changed(FOLLOWING, ("claim.inputs", [[2]]))
    said = judged(tmp_path, "performance-setpoint-steps", [wide]).statement
    assert says(said, "largest some")
    wide = changed(STEPPED, ("claim.inputs", [[2]]))
    said = judged(tmp_path, "performance-input-steps", [wide]).statement
    assert says(said, "largest some 2")


@pytest.mark.parametrize("key", keys("performance"))
def test_a_rule_answers_as_it_did(key: str) -> None:
    compare(key)
