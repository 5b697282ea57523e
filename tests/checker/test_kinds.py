"""The verdict on a certificate, whatever happens on the way to it."""

from __future__ import annotations

import json
import sys
from types import MappingProxyType
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import NotAUnit
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.kinds import KINDS, Expectation, Verdict, attempt, check_document
from tests.checker.handmade import FIXED, FREE, changed, checked, without
from tests.wording import refusal

STATUSES = [
    ("VALID", 0),
    ("IMPLIED", 0),
    ("REMARK", 0),
    ("COUNTED", 0),
    ("INVALID", 1),
    ("NOT ABOUT", 1),
    ("MALFORMED", 3),
    ("INCOMPLETE", 5),
    ("ERROR", 70),
    ("READ", 70),
    ("", 70),
]


@pytest.mark.parametrize(("verdict", "status"), STATUSES)
def test_every_verdict_has_a_status_and_only_good_ones_have_none(verdict: str, status: int) -> None:
    assert Verdict(verdict).status == status


@pytest.mark.parametrize("verdict", ["VALID", "INVALID"])
def test_a_verdict_is_neither_true_nor_false_so_that_nobody_accepts_a_bad_one(verdict: str) -> None:
    with refusal(TypeError):
        bool(Verdict(verdict))


def test_a_refusal_is_told_with_its_reason() -> None:
    told = Verdict("INVALID", code="rank", place="claim.rank", message="it is 2").line()
    assert told == "INVALID rank claim.rank: it is 2"


def test_a_verdict_on_a_part_names_the_part_only_where_something_is_wrong() -> None:
    wrong = Verdict("INVALID", code="rank", place="claim.rank", message="it is 2")
    assert wrong.inside("a.json").place == "a.json claim.rank"
    assert Verdict("VALID", place="claim").inside("a.json").place == ""


def test_verdicts_are_equal_whatever_work_they_took() -> None:
    assert Verdict("VALID").spent == 0
    assert Verdict("VALID", "so", spent=1) == Verdict("VALID", "so", spent=2)
    assert Verdict("VALID", "so") != Verdict("VALID", "otherwise")


def test_the_work_of_a_document_does_not_count_what_was_done_before() -> None:
    budget = Budget()
    alone = checked(FREE).spent
    with limited(budget):
        assert [checked(FREE).spent for _ in range(3)] == [alone] * 3
    assert alone > 0 and budget.spent == 3 * alone


@pytest.mark.parametrize(
    ("error", "verdict", "code"),
    [
        (Refused("INVALID", "rank", "claim", "no"), "INVALID", "rank"),
        (Refused("MALFORMED", "form", "claim", "no"), "MALFORMED", "form"),
        (NotAUnit(), "INVALID", "unit"),
        (ZeroDivisionError("division by zero"), "ERROR", "internal"),
        (KeyError("a\nb"), "ERROR", "internal"),
        (ValueError("\u00e9" * 999), "ERROR", "internal"),
    ],
)
def test_an_exception_becomes_a_verdict(error: Exception, verdict: str, code: str) -> None:
    def check() -> Verdict:
        raise error

    found = attempt(check)
    assert (found.verdict, found.code) == (verdict, code)
    assert found.line().isascii() and len(found.line().splitlines()) == 1
    assert len(found.message) < 2000


def test_an_interruption_is_no_verdict() -> None:
    def check() -> Verdict:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        attempt(check)


def test_the_interpreter_s_limit_on_digits_is_as_before() -> None:
    before = sys.get_int_max_str_digits()
    during = []

    def check() -> Verdict:
        during.append(sys.get_int_max_str_digits())
        raise ZeroDivisionError

    try:
        for digits in (0, 5000):
            sys.set_int_max_str_digits(digits)
            attempt(check)
            assert sys.get_int_max_str_digits() == digits
    finally:
        sys.set_int_max_str_digits(before)
    assert during == [0, 0]


def test_a_document_is_checked_like_its_text() -> None:
    for document in (FIXED, FREE, changed(FREE, ("claim.stabilizable", False))):
        assert check_document(document) == check_document(json.dumps(document).encode())
        assert check_document(MappingProxyType(document)) == check_document(document)


def nested(levels: int) -> Any:
    """Lists in lists."""
    value: list[Any] = []
    for _ in range(levels):
        value = [value]
    return value


CIRCULAR: list[Any] = []
CIRCULAR.append(CIRCULAR)


@pytest.mark.parametrize(
    ("value", "limits", "verdict"),
    [
        (CIRCULAR, Limits(), "MALFORMED"),
        (nested(20), Limits(), "MALFORMED"),
        (nested(10**5), Limits(), "MALFORMED"),
        (object(), Limits(), "MALFORMED"),
        (float("nan"), Limits(), "MALFORMED"),
        (b"1", Limits(), "MALFORMED"),
        pytest.param(10**4301, Limits(), "INCOMPLETE", id="digits"),
        pytest.param(10**5000, Limits(digits=6000), "MALFORMED", id="more digits"),
        (0, Limits(bytes=100), "INCOMPLETE"),
    ],
)
def test_a_document_in_memory_has_the_limits_of_a_text(
    value: Any, limits: Limits, verdict: str
) -> None:
    found = check_document({**FREE, "format": value}, limits=limits)
    assert found.verdict == verdict, found.line()


@pytest.mark.parametrize(
    ("document", "verdict", "code"),
    [
        (FREE, "VALID", ""),
        ([FREE], "MALFORMED", "form"),
        ("certificate", "MALFORMED", "form"),
        (None, "MALFORMED", "form"),
        ({}, "MALFORMED", "form"),
        (without(FREE, "format"), "MALFORMED", "form"),
        (changed(FREE, ("format", "mcexact-certificate/2")), "INCOMPLETE", "version"),
        (changed(FREE, ("format", "mcexact-certificate")), "MALFORMED", "form"),
        (changed(FREE, ("format", "mcexact-manifest/1")), "MALFORMED", "form"),
        (changed(FREE, ("format", 1)), "MALFORMED", "form"),
        (changed(FREE, ("kind", "fixed_spectra")), "INCOMPLETE", "kind"),
        (changed(FREE, ("kind", ["fixed_spectrum"])), "MALFORMED", "form"),
        (changed(FREE, ("kind", "location")), "INCOMPLETE", "kind"),
        (without(FREE, "kind"), "MALFORMED", "form"),
        (without(FREE, "system"), "MALFORMED", "form"),
        (without(FREE, "subject"), "MALFORMED", "form"),
        (without(FREE, "claim"), "MALFORMED", "form"),
        (without(FREE, "witness"), "MALFORMED", "form"),
        (changed(FREE, ("verified", True)), "MALFORMED", "form"),
        (changed(FREE, ("system.A", [[1, 2]])), "MALFORMED", "form"),
        (changed(FREE, ("subject", None)), "MALFORMED", "form"),
    ],
)
def test_a_document_has_six_parts_of_one_version(document: Any, verdict: str, code: str) -> None:
    found = checked(document)
    assert (found.verdict, found.code) == (verdict, code), found.line()


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_no_other_kind_s_evidence_is_read(kind: str) -> None:
    if kind != FREE["kind"]:
        assert checked(changed(FREE, ("kind", kind))).verdict == "MALFORMED"


@pytest.mark.parametrize(
    ("expected", "code"),
    [
        (Expectation(), ""),
        (Expectation(kind="fixed_spectrum"), ""),
        (Expectation(system="0" * 64), "system"),
        (Expectation(controller="0" * 64), "controller"),
        (Expectation(statement="0" * 64), "expected"),
        (Expectation(kind="setpoint"), "expected"),
    ],
)
def test_what_is_expected_of_a_certificate_is_insisted_on(expected: Expectation, code: str) -> None:
    found = checked(FREE, expected=expected)
    assert (found.verdict, found.code) == ("NOT ABOUT" if code else "VALID", code), found.line()


def test_only_the_subject_is_what_others_follow(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[bool] = []
    spend = Budget.spend

    def watched(self: Budget, units: int, after: int = 0) -> None:
        seen.extend([self.builds] if seen[-1:] != [self.builds] else [])
        spend(self, units, after)

    monkeypatch.setattr(Budget, "spend", watched)
    document = changed(FREE, ("subject", [{"construction": "dual"}]))
    assert check_document(json.dumps(document).encode()).verdict != "MALFORMED"
    assert seen == [False, True, False]
