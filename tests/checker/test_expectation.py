"""What is asked of a certificate is insisted on: the system, the controller, what it states."""

from __future__ import annotations

import copy
import hashlib
import json
from typing import Any

import pytest

from mcexact.checker.constructions import read_subject
from mcexact.checker.controllers import FORMAT
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import canonical_json, digest, read_plant
from mcexact.checker.kinds import NOT_ABOUT, Expectation, Verdict, difference
from tests.checker.box_plants import (
    AGAIN,
    AT_SAMPLES,
    BY_TUSTIN,
    HELD,
    HELD_LOOP,
    LAGGING,
    OTHERWISE,
    PROMPT,
    ROUNDED,
    TANK,
    TO_12_DIGITS,
    WEAKER,
)
from tests.checker.handmade import (
    FIXED,
    FREE,
    PAPER,
    Document,
    certificate,
    changed,
    checked,
    listed,
)
from tests.checker.manifests import EVIDENCE, manifest, sentence, write
from tests.checker.manifests import said as manifest_said
from tests.checker.test_closed_loop_spectrum import CONTROLLER, HALF, LOOP, SCALAR
from tests.wording import says, worded

ABOUT = digest(read_plant(SCALAR))
FILE = {"format": FORMAT, "system": ABOUT, **CONTROLLER}
ANOTHER = changed(LOOP, (HALF, [[-2]]), ("claim.polynomial", [3, 6, 1]))
"""The same plant with another controller."""


def text(value: Any) -> bytes:
    return value.encode() if isinstance(value, str) else json.dumps(value).encode()


def controlled(value: Any = FILE) -> Expectation:
    """What a controller file asks for."""
    return Expectation().controlled(text(value), Limits())


def saying(value: Any) -> Expectation:
    """What the file of a statement or of a claim asks for."""
    return Expectation().saying(text(value), Limits())


def claimed(document: Document, asked: Expectation | None = None, **more: Any) -> Expectation:
    """What the claim of a certificate asks for, of its kind and about the plant or ``subject``."""
    value = {"kind": document["kind"], "claim": document["claim"], **more}
    return (asked or Expectation()).saying(text(value), Limits())


def answered(document: Document, expected: Expectation) -> Verdict:
    return checked(document, expected=expected)


def test_the_controller_can_be_insisted_on() -> None:
    verdict = answered(LOOP, controlled())
    assert verdict.verdict == "VALID"
    assert verdict.controller_digest == controlled().controller
    assert verdict.system_digest == ABOUT


def test_another_plant_is_not_asked_about_and_both_digests_are_named() -> None:
    file = text({"format": "mcexact-system/1", **PAPER})
    verdict = answered(LOOP, Expectation().about(file, Limits()))
    assert (verdict.verdict, verdict.code, verdict.place) == (NOT_ABOUT, "system", "system")
    assert ABOUT in verdict.message and digest(read_plant(PAPER)) in verdict.message


def test_the_plant_in_a_file_is_granted_work_and_no_other_is() -> None:
    assert Expectation().size == 0
    file = text({"format": "mcexact-system/1", **PAPER})
    found = Expectation().about(file, Limits())
    assert found.size == len(canonical_json(found.plant)) > 0


def test_another_controller_is_not_asked_about_and_both_digests_are_named() -> None:
    verdict = answered(ANOTHER, controlled())
    assert (verdict.verdict, verdict.code, verdict.place) == (NOT_ABOUT, "controller", "subject")
    other = checked(ANOTHER).controller_digest
    assert other in verdict.message and controlled().controller in verdict.message
    assert verdict.statement == verdict.statement_digest == ""


def test_neither_of_two_controllers_passes_for_the_other() -> None:
    """Whichever of the digests comes first in the alphabet."""
    other = changed(FILE, ("agents.0.input.shared.1", [[-2]]))
    assert answered(ANOTHER, controlled(other)).verdict == "VALID"
    for document, file in ((LOOP, other), (ANOTHER, FILE)):
        verdict = answered(document, controlled(file))
        assert (verdict.verdict, verdict.code) == (NOT_ABOUT, "controller")


@pytest.mark.parametrize("document", [FREE, certificate("closed_loop_spectrum", SCALAR, {}, {})])
def test_a_certificate_without_a_closed_loop_is_about_no_controller(document: Document) -> None:
    verdict = answered(document, Expectation(controller=controlled().controller))
    assert verdict.verdict == NOT_ABOUT and worded(verdict.message)


def test_a_controller_for_another_plant_is_not_about_this_one() -> None:
    verdict = answered(LOOP, controlled({**FILE, "system": digest(read_plant(PAPER))}))
    assert (verdict.verdict, verdict.code, verdict.place) == (NOT_ABOUT, "controller", "system")
    assert ABOUT in verdict.message
    assert answered(LOOP, controlled({**FILE, "system": ""})).verdict == "VALID"


BOX = changed(
    LOOP, ("system", {**SCALAR, "uncertainty": {"absolute": {"A": listed([["1/8"]], 1)}}})
)
WIDER = changed(BOX, ("system.uncertainty.absolute.A.entries", [[0, 0, "1/4"]]))
"""The same loop, at the nominal values of the box around the plant, and of a wider one."""


def about(plant: Document) -> Expectation:
    """What a system file asks for."""
    return Expectation().about(text({"format": "mcexact-system/1", **plant}), Limits())


def test_a_certificate_about_a_box_around_the_plant_is_about_the_plant() -> None:
    assert answered(BOX, about(SCALAR)).verdict == "VALID"
    assert answered(BOX, about(BOX["system"])).verdict == "VALID"
    for found, asked in ((LOOP, BOX), (WIDER, BOX), (changed(BOX, ("system.A", [[2]])), LOOP)):
        verdict = answered(found, about(asked["system"]))
        assert (verdict.code, verdict.place) == ("system", "system")
    named = {**BOX, "system": digest(read_plant(BOX["system"]))}
    assert answered(named, about(BOX["system"])).verdict == "VALID"
    assert answered(named, about(SCALAR)).code == "system"


def test_a_controller_is_for_the_values_and_not_for_a_box_around_them() -> None:
    for found in (LOOP, BOX, WIDER):
        assert answered(found, controlled()).verdict == "VALID"
    within = controlled({**FILE, "system": digest(read_plant(BOX["system"]))})
    verdict = answered(BOX, within)
    assert (verdict.code, verdict.place) == ("controller", "system")
    assert says(verdict.message, "about digest") and ABOUT in verdict.message
    both = about(BOX["system"]).controlled(text(FILE), Limits())
    assert answered(BOX, both).verdict == "VALID"
    named = {**BOX, "system": digest(read_plant(BOX["system"]))}
    assert answered(named, both).verdict == "VALID"


def test_a_loop_has_no_channels_to_close_again() -> None:
    nobody = {"construction": "closed_loop", "controller": {**CONTROLLER, "agents": []}}
    for step, verdict in ((nobody, "MALFORMED"), (LOOP["subject"][0], "INVALID")):
        assert checked({**LOOP, "subject": [*LOOP["subject"], step]}).verdict == verdict


FEEDBACK = {"construction": "feedback", "gains": [{"denominator": 1, "entries": [[-5]]}]}
CHANGED = {**LOOP, "subject": [FEEDBACK, *LOOP["subject"]], "claim": {"polynomial": [43, 11, 1]}}
"""The same controller, and another gain that no file contains: [−4, −3; 5, −7]."""
DUAL = {**LOOP, "subject": [*LOOP["subject"], {"construction": "dual"}]}


@pytest.mark.parametrize("document", [CHANGED, DUAL])
def test_a_controller_stands_for_its_loop_with_the_plant_and_nothing_else(
    document: Document,
) -> None:
    assert checked(document).verdict == "VALID"
    assert checked(document).controller_digest == controlled().controller
    for expected in (controlled(), claimed(document, controlled())):
        verdict = answered(document, expected)
        assert (verdict.verdict, verdict.code, verdict.place) == (NOT_ABOUT, "expected", "subject")
    steps = document["subject"]
    assert ", ".join(step["construction"] for step in steps) in verdict.message
    whole = claimed(document, controlled(), subject=steps)
    assert answered(document, whole).verdict == "VALID"
    said = controlled().saying(text(checked(document).statement), Limits())
    assert answered(document, said).verdict == "VALID"


def test_a_subject_and_a_controller_are_insisted_on_together() -> None:
    assert answered(LOOP, claimed(LOOP, controlled())).verdict == "VALID"
    before = claimed(CHANGED, controlled(), subject=[FEEDBACK])
    assert answered(CHANGED, before).verdict == "VALID"
    assert answered({**LOOP, "claim": CHANGED["claim"]}, before).place == "subject"
    assert answered(ANOTHER, claimed(ANOTHER, controlled())).code == "controller"
    for document in (LOOP, CHANGED):
        whole = claimed(document, controlled(), subject=document["subject"])
        assert answered(document, whole).verdict == "VALID"
    twice = claimed(DUAL, controlled(), subject=DUAL["subject"])
    assert answered(LOOP, twice).place == "subject"


ZEROS = changed(
    LOOP,
    ("subject.0.controller.agents.0.private_update", {"shared": {"1": []}, "private": []}),
    ("subject.0.controller.agents.0.input.outputs", {"1": [[0]]}),
    ("subject.0.controller.agents.0.input.reference", {"shape": [1, 1], "entries": []}),
)


def test_zeros_of_a_controller_say_nothing() -> None:
    assert answered(ZEROS, controlled()).line() == checked(LOOP).line()
    assert "VALID" in checked(LOOP).line()
    slow = changed(LOOP, ("system.time", "discrete"), ("subject.0.controller.time", "discrete"))
    slow = changed(slow, ("subject.0.controller.agents.0.hold", {"1": 2}))
    zero = ("subject.0.controller.agents.0.shared_update.shared.1", [[0]])
    sent = changed(slow, zero, (HALF, [[0]]), ("claim.polynomial", [0, -1, 1]))
    assert checked(sent).verdict == "VALID", "no message is under way"


WRITTEN = [
    ("decimals", ("agents.0.input.shared.1", [[-3.0]])),
    ("fractions that are not in lowest terms", ("agents.0.input.shared.1", [["-6/2"]])),
    ("sparse", ("agents.0.input.shared.1", {"shape": [1, 1], "entries": [[0, 0, -3]]})),
    ("a hold of no steps", ("agents.0.hold", {"1": 0})),
    ("nothing as an empty object", ("agents.0.private_update", {"shared": {}})),
    (
        "a matrix of zeros, which certificates leave out",
        ("agents.0.private_update", {"shared": {"1": []}}),
    ),
    ("another order of keys", ("agents.0", dict(reversed(CONTROLLER["agents"][0].items())))),
]


@pytest.mark.parametrize(("reason", "edit"), WRITTEN, ids=[row[0] for row in WRITTEN])
def test_one_controller_may_be_written_in_many_ways(reason: str, edit: tuple[str, Any]) -> None:
    assert answered(LOOP, controlled(changed(FILE, edit))).verdict == "VALID", reason


OTHERS = [
    ("another number", ("agents.0.input.shared.1", [["-3/2"]])),
    ("another signal", ("agents.0.input", {"outputs": {"1": [[-3]]}})),
    ("a set-point", ("agents.0.input.reference", [[1]])),
    ("a hold", ("agents.0.hold", {"1": 1})),
    ("another time", ("time", "discrete")),
    ("a private state", ("agents.0.private", 1)),
]


@pytest.mark.parametrize(("reason", "edit"), OTHERS, ids=[row[0] for row in OTHERS])
def test_another_controller_has_another_digest(reason: str, edit: tuple[str, Any]) -> None:
    document = changed(FILE, edit)
    if reason == "a private state":
        document = changed(document, ("agents.0.private_update", {"private": [[0]]}))
    assert controlled(document).controller != controlled().controller


MALFORMED: list[tuple[str, Any]] = [
    ("no JSON", "controller"),
    ("a system file", {"format": "mcexact-system/1", **SCALAR}),
    ("another version", {**FILE, "format": "mcexact-controller/2"}),
    ("a key more", {**FILE, "verified": True}),
    ("no agents", {key: part for key, part in FILE.items() if key != "agents"}),
    ("another agent", changed(FILE, ("agents.0.input.shared", {"2": [[1]]}))),
    ("two agents of one name", {**FILE, "agents": CONTROLLER["agents"] * 2}),
    ("no name", changed(FILE, ("agents.0.name", ""))),
    ("a time of its own", {**FILE, "time": "late"}),
    ("a matrix that does not fit", changed(FILE, ("agents.0.shared_update.shared.1", [[1, 2]]))),
    ("a size below 0", changed(FILE, ("agents.0.shared", -1))),
    ("a hold that is no number", changed(FILE, ("agents.0.hold", {"1": "1"}))),
    ("null for what is absent", changed(FILE, ("agents.0.input.private", None))),
    ("a digest that is no text", {**FILE, "system": 7}),
    ("no agent", {**FILE, "agents": []}),
    (
        "inputs of two sizes",
        changed(FILE, ("agents.0.input.outputs", {"1": [[1, 2], [3, 4]]})),
    ),
    ("a set-point for another size", changed(FILE, ("agents.0.input.reference", [[1], [0]]))),
]


@pytest.mark.parametrize(("reason", "value"), MALFORMED, ids=[row[0] for row in MALFORMED])
def test_a_controller_file_of_another_form_is_refused(reason: str, value: Any) -> None:
    with pytest.raises(Refused) as refused:
        controlled(value)
    assert refused.value.verdict == "MALFORMED", reason


def test_the_statement_the_digest_or_the_claim_can_be_insisted_on() -> None:
    statement = checked(FIXED).statement
    shuffled = {"claim": dict(reversed(FIXED["claim"].items())), "kind": "fixed_spectrum"}
    texts = statement, f"{statement}\n", sha(statement), f"{sha(statement)}\n"
    pasted = (
        sha(statement).upper(),
        checked(FIXED).line(),
        f"VALID 'a b.json' {texts[2]} {texts[0]}",
    )
    for expected in (*texts, *pasted, shuffled, {**shuffled, "subject": []}):
        assert answered(FIXED, saying(expected)).verdict == "VALID"
        other = answered(FREE, saying(expected))
        assert (other.verdict, other.code) == (NOT_ABOUT, "expected")
        assert checked(FREE).statement in other.message
        assert other.statement == ""


def sha(statement: str) -> str:
    return hashlib.sha256(statement.encode()).hexdigest()


def test_a_claim_is_compared_exactly() -> None:
    claim = FIXED["claim"]
    for key, other in (
        ("stabilizable", {**claim, "stabilizable": 0}),
        ("polynomial", {**claim, "polynomial": [-1, True]}),
        ("best_rate", {**claim, "best_rate": {"lower": "-1.0", "upper": "-1"}}),
        ("factors", {key: part for key, part in claim.items() if key != "factors"}),
        ("more", {**claim, "more": None}),
        ("best_rate", {}),
    ):
        verdict = answered(FIXED, saying({"kind": "fixed_spectrum", "claim": other}))
        assert verdict.code == "expected"
        assert f'"{key}"' in verdict.message.partition(" and states: ")[0]


def test_the_keys_in_which_claims_differ_are_named() -> None:
    one, other = {"same": 1, "value": 1, "left": 1}, {"same": 1, "value": True, "added": 1}
    assert difference(one, other) == difference(other, one) == '"added", "left", "value"'
    assert difference(one, one) == ""


def test_a_claim_is_of_a_kind_and_about_a_subject() -> None:
    for more in (
        {"kind": "completeness"},
        {"subject": [{"construction": "dual"}]},
        {"subject": [7]},
    ):
        verdict = answered(FIXED, claimed(FIXED, **more))
        assert (verdict.verdict, verdict.code) == (NOT_ABOUT, "expected")
        assert verdict.place == next(iter(more))
    dual = {**FREE, "subject": [{"construction": "dual"}]}
    assert checked(dual).verdict == "VALID"
    assert answered(dual, claimed(dual)).place == "subject"
    assert answered(dual, claimed(dual, subject=dual["subject"])).verdict == "VALID"


def test_what_is_invalid_stays_so_whatever_is_expected() -> None:
    false = changed(FREE, ("witness.gains.0.entries", [[0]]))
    assert answered(false, saying(checked(FREE).statement)).code == "common_factor"
    assert answered(false, claimed(FREE)).code == "common_factor"


@pytest.mark.parametrize(
    "value",
    [
        *("", "VALID", "for the plant", "For a\nFor b", "For \u00e9", "0" * 63, "[1]", '{"a": 1'),
        "For a\rFor b",
        *(f"VALID {'0' * 64} For a", f"VALID {'0' * 64}", "VALID For a", f"INVALID {'0' * 64}"),
        FIXED["claim"],
        FIXED,
        *({"claim": {}}, {"kind": 3, "claim": {}}, {"kind": "completeness", "claim": []}),
        {"kind": "completeness", "claim": {}, "subject": {}},
        {"kind": "completeness", "claim": {}, "subject": None},
    ],
    ids=str,
)
def test_what_is_no_statement_and_no_claim_is_refused(value: Any) -> None:
    with pytest.raises(Refused) as refused:
        saying(value)
    assert refused.value.verdict == "MALFORMED"


def test_a_claim_that_is_missing_is_asked_for() -> None:
    with pytest.raises(Refused) as refused:
        saying(FIXED["claim"])
    assert 'found no "claim"' in refused.value.message


# Manifests.


def judged(tmp_path: Any, evidence: Any, sentences: list[Document], expected: Expectation) -> Any:
    from mcexact.checker.command import manifest_verdicts

    write(tmp_path, evidence, manifest(evidence, sentences))
    found = manifest_verdicts(str(tmp_path), expected, Limits())
    return [each for each in found if each[1].verdict != "VALID"]


def test_every_loop_of_a_manifest_has_the_controller(tmp_path: Any) -> None:
    claim = copy.deepcopy(LOOP)
    evidence = {"loop": claim, "free": certificate_of_the_plant()}
    said = [sentence("design-assigned", "loop", evidence=evidence)]
    found = judged(tmp_path, evidence, said, controlled())
    assert [verdict.verdict for _, verdict in found] == ["IMPLIED"]
    evidence["loop"] = ANOTHER
    said = [sentence("design-assigned", "loop", evidence=evidence)]
    found = judged(tmp_path, evidence, said, controlled())
    assert [verdict.verdict for _, verdict in found] == [NOT_ABOUT, NOT_ABOUT, "INVALID"]
    evidence["loop"] = CHANGED
    said = [sentence("heading", evidence=evidence)]
    found = judged(tmp_path, evidence, said, controlled())
    assert next(verdict.place for _, verdict in found) == "loop.json subject"


def certificate_of_the_plant() -> Document:
    """A certificate about the plant of the loop itself."""
    return {**LOOP, "subject": [], "claim": {"polynomial": [-1, 1]}}


def test_a_manifest_without_a_loop_is_about_no_controller(tmp_path: Any) -> None:
    evidence = {"plant": certificate_of_the_plant()}
    found = judged(tmp_path, evidence, [sentence("heading")], controlled())
    assert [verdict.code for _, verdict in found] == ["controller", ""]


def test_no_one_statement_can_be_expected_of_a_manifest(tmp_path: Any) -> None:
    for expected in (saying(checked(FIXED).statement), claimed(FIXED)):
        ((_, verdict),) = judged(tmp_path, EVIDENCE, [sentence("heading")], expected)
        assert (verdict.verdict, verdict.code) == ("INVALID", "expected")


def test_a_manifest_is_about_one_plant_and_boxes_around_it(tmp_path: Any) -> None:
    evidence = {"a_box": BOX, "plant": LOOP, "wider": WIDER}
    said = [
        sentence("heading"),
        *(sentence("design-assigned", e, evidence=evidence) for e in evidence),
    ]
    for expected in (Expectation(), about(SCALAR), controlled()):
        found = [verdict for _, verdict in judged(tmp_path, evidence, said, expected)]
        assert [each.verdict for each in found] == ["IMPLIED"] * 4
        assert f"For the plant {ABOUT} (" in found[0].statement
    digests = {name: digest(read_plant(each["system"])) for name, each in evidence.items()}
    assert says(found[3].statement, "nominal values") and digests["wider"] in found[3].statement
    found = [verdict for _, verdict in judged(tmp_path, evidence, said, about(BOX["system"]))]
    assert [each.verdict for each in found].count("IMPLIED") == 2
    assert found[2].verdict == "IMPLIED" and says(found[2].statement, "nominal values 2")
    alone = {
        "a_box": BOX,
        "wider": changed(WIDER, ("system.A", [[2]]), ("claim.polynomial", [1, 5, 1])),
    }
    assert checked(alone["wider"]).verdict == "VALID"
    ((_, verdict), _) = judged(tmp_path, alone, [sentence("heading")], Expectation())
    assert (verdict.code, verdict.place) == ("system", "wider.json system")


def test_a_manifest_of_samples_has_the_controller_with_another_step_too(tmp_path: Any) -> None:
    """The file names the plant at the step of the manifest, and only the step may differ."""
    held = read_subject([AT_SAMPLES], read_plant(TANK))
    file = {"format": FORMAT, "system": digest(held), **HELD["controller"]}
    evidence: dict[str, Document] = {"loop": HELD_LOOP, "inputs": AGAIN[0], "outputs": AGAIN[1]}
    rule = "performance-another-step"

    def found(evidence: dict[str, Document]) -> list[str]:
        said = [sentence(rule, *evidence, evidence=evidence)]
        return [
            verdict.verdict for _, verdict in judged(tmp_path, evidence, said, controlled(file))
        ]

    assert found(evidence) == ["IMPLIED"]
    for others in (WEAKER, ROUNDED, PROMPT):
        assert found({**evidence, "outputs": others[1]}) == [NOT_ABOUT, "INVALID"]


def test_a_manifest_has_a_controller_at_samples_by_tustins_rule(tmp_path: Any) -> None:
    """A file of the controller in continuous time admits loops of samples that run it."""
    file = {
        "format": FORMAT,
        "system": digest(read_plant(TANK)),
        **LAGGING["subject"][0]["controller"],
    }
    rule = "performance-at-samples"

    def found(margins: list[Document], file: Document = file) -> list[tuple[str, str]]:
        evidence: dict[str, Document] = {"loop": LAGGING, "in": margins[0], "out": margins[1]}
        said = [sentence(rule, *evidence, evidence=evidence)]
        verdicts = judged(tmp_path, evidence, said, controlled(file))
        return [(verdict.verdict, verdict.code) for _, verdict in verdicts]

    for right in (BY_TUSTIN, TO_12_DIGITS):
        assert found(right) == [("IMPLIED", "")]
    for others in OTHERWISE:
        assert found(others) == [(NOT_ABOUT, "controller"), ("INVALID", "claim")]
    strange = {**file, **OTHERWISE[0][0]["subject"][1]["controller"]}
    assert (NOT_ABOUT, "controller") in found(OTHERWISE[0], strange)


def test_a_loop_of_samples_alone_is_none_of_a_controller_in_continuous_time(tmp_path: Any) -> None:
    file = {"format": FORMAT, "system": "", **LAGGING["subject"][0]["controller"]}
    verdict = answered(BY_TUSTIN[0], controlled(file))
    assert (verdict.verdict, verdict.code) == (NOT_ABOUT, "controller")
    evidence: dict[str, Document] = {"in": BY_TUSTIN[0]}
    found = judged(tmp_path, evidence, [sentence("heading")], controlled(file))
    assert (NOT_ABOUT, "controller") in [(each.verdict, each.code) for _, each in found]


def test_a_sentence_about_a_controller_is_about_the_step_of_the_manifest(tmp_path: Any) -> None:
    evidence: dict[str, Document] = {"again": AGAIN[0], "loop": HELD_LOOP}
    said = [sentence("design-order", evidence=evidence)]
    document = {**manifest(evidence, said), "subject": [AT_SAMPLES]}
    (verdict,) = manifest_said(write(tmp_path, evidence, document))
    assert verdict.verdict == "IMPLIED" and "sampled every 1/2 " in verdict.statement
    # alone, the certificate about another step shows no controller of the manifest's system
    alone = {"again": AGAIN[0]}
    document = {**manifest(alone, said), "subject": [AT_SAMPLES]}
    (verdict,) = manifest_said(write(tmp_path, alone, document))
    assert (verdict.verdict, verdict.code) == ("INVALID", "claim")
