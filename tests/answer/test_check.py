"""Checking from Python is the same as checking files."""

import os
import time
from pathlib import Path
from typing import Any

import pytest

from mcexact import (
    MultiChannelSystem,
    certify_controller,
    check,
    design_decentralized,
    fixed_spectrum,
    save_controller,
)
from mcexact.answer import protocol
from mcexact.constructions import dual
from mcexact.derived.constructions import feedback
from mcexact.designs import Aims
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from tests.wording import refusal

PLANT = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])


def test_a_certificate_and_its_file_get_the_same_verdict(tmp_path: Path) -> None:
    certificate = fixed_spectrum(PLANT)
    file = tmp_path / "fixed_spectrum.json"
    protocol.save_certificate(certificate, file)
    assert check(certificate) == check(file) == check(str(file), PLANT)
    assert check(file).verdict == "VALID"
    assert "x - 2" in check(file).statement


def test_a_certificate_about_a_derived_system_is_about_its_plant() -> None:
    certificate = fixed_spectrum(dual(PLANT))
    assert check(certificate, PLANT).verdict == "VALID"
    assert check(certificate, dual(PLANT)).verdict == "VALID"
    for other in (fixed_spectrum(PLANT), fixed_spectrum(dual(dual(PLANT)))):
        assert check(other, dual(PLANT)).place == "subject"


def test_a_controller_and_a_derived_system_are_about_the_loop_of_both() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    changed = feedback(plant, [Matrix.from_integers([[-5]])])
    controller = design_decentralized(changed, rate=1).controller
    loop = certify_controller(changed, controller, rate=1)
    claim = {"kind": "stability", "claim": protocol.document(loop)["claim"]}
    assert check(loop, changed, controller).verdict == "VALID"
    assert check(loop, changed, controller, claim).verdict == "VALID"
    for system in (plant, None, feedback(changed, [Matrix.from_integers([[1]])])):
        found = check(loop, system, controller, claim)
        assert (found.verdict, found.place) == ("NOT ABOUT", "subject")


def test_what_is_no_certificate_is_not_valid(tmp_path: Path) -> None:
    file = tmp_path / "empty.json"
    file.write_bytes(b"")
    assert check(file).verdict == "MALFORMED"
    with refusal(InputError):
        check(tmp_path / "missing.json")


@pytest.mark.parametrize("value", [{}, None, 3, b"{}", [], PLANT])
def test_what_is_neither_a_certificate_nor_a_file_is_refused(value: Any) -> None:
    kind = type(value).__name__
    expected = f"certificate: expected an answer, such as .*, found {kind}"
    with pytest.raises(InputError, match=expected):
        check(value)


def test_what_is_no_system_is_refused() -> None:
    with pytest.raises(InputError, match="system: expected a MultiChannelSystem, found dict"):
        check(fixed_spectrum(PLANT), {})  # type: ignore[arg-type]


def test_the_controller_can_be_an_object_or_a_file(tmp_path: Path) -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    design, other = (design_decentralized(plant, rate=rate, aims=Aims(effort=0)) for rate in (1, 3))
    save_controller(design.controller, tmp_path / "controller.json")
    for controller in (design.controller, tmp_path / "controller.json"):
        for certificate in map(design.certificates.get, ("stability", "closed_loop_spectrum")):
            assert check(certificate, plant, controller).verdict == "VALID"
        refused = check(other.certificates["stability"], controller=controller)
        assert (refused.verdict, refused.code) == ("NOT ABOUT", "controller")


def test_the_statement_or_the_claim_can_be_expected() -> None:
    certificate, claim = fixed_spectrum(PLANT), protocol.document(fixed_spectrum(PLANT))["claim"]
    found, kind = check(certificate), "fixed_spectrum"
    for expected in (found.statement, found.statement_digest, {"kind": kind, "claim": claim}):
        assert check(certificate, PLANT, expect=expected).verdict == "VALID"
    assert check(certificate, expect="0" * 64).code == "expected"
    other = {"kind": kind, "claim": {**claim, "stabilizable": True}}
    assert check(certificate, expect=other).code == "expected"


def test_what_cannot_be_asked_is_refused(tmp_path: Path) -> None:
    certificate = fixed_spectrum(PLANT)
    with pytest.raises(InputError, match="controller: expected a Controller, found int"):
        check(certificate, controller=3)  # type: ignore[arg-type]
    with refusal(InputError):
        check(certificate, controller=tmp_path / "controller.json")
    with pytest.raises(InputError, match="expect: expected a str, found list"):
        check(certificate, expect=[])  # type: ignore[arg-type]
    with pytest.raises(InputError, match="expect: file: expected a statement, its SHA-256, or"):
        check(certificate, expect="it is stable")
    with pytest.raises(InputError, match="expect: file: expected a statement, its SHA-256, or"):
        check(certificate, expect="For \ud800")
    with pytest.raises(InputError, match=r'expect: file: .* found no "claim"'):
        check(certificate, expect={"complete": True})
    circular: dict[str, Any] = {"kind": "completeness"}
    circular["claim"] = circular
    for wrong in (circular, {"kind": "completeness", "claim": {"rate": PLANT}}):
        with pytest.raises(InputError, match="expect: expected JSON: "):
            check(certificate, expect=wrong)
    (tmp_path / "controller.json").write_text("{}", encoding="ascii")
    with pytest.raises(InputError, match=r"controller: controller: the key .* is missing"):
        check(certificate, controller=tmp_path / "controller.json")


def test_a_check_that_takes_too_long_is_incomplete_and_says_what_it_does(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    found, lines = fixed_spectrum(plant), list[str]()
    assert check(found, plant, timeout=100, progress=lines.append).valid
    assert [line.split()[0] for line in lines] == ["reading", "checking"]
    monkeypatch.setattr("mcexact.answer.check.check_document", lambda *_: time.sleep(1000))
    verdict = check(found, plant, timeout=0.2)
    assert (verdict.verdict, verdict.code) == ("INCOMPLETE", "time")
    monkeypatch.setattr("mcexact.answer.check.check_document", lambda *_: os._exit(9))
    assert check(found, plant, timeout=100).code == "memory"
    for wrong in ({"timeout": "long"}, {"progress": True}):
        with pytest.raises(UsageError):
            check(found, plant, **wrong)  # type: ignore[arg-type]
