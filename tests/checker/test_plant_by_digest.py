"""A certificate may name its plant by its digest; then the plant has to stand beside it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.command import main
from mcexact.checker.kinds import Expectation
from mcexact.checker.reading import Limits, Refused
from mcexact.checker.system import digest, read_plant
from tests.checker.handmade import FREE, PAPER, VALID, Document, changed, checked
from tests.checker.manifests import EVIDENCE, SENTENCES, said, text_of, write
from tests.checker.test_closed_loop_spectrum import LOOP, SCALAR


def alone(document: Document) -> Document:
    """The certificate with the digest of its plant in place of the plant."""
    return {**document, "system": digest(read_plant(document["system"]))}


def beside(plant: Document) -> Expectation:
    """What the file of a plant asks for."""
    file = json.dumps({"format": "mcexact-system/1", "name": "beside", **plant})
    return Expectation().about(file.encode(), Limits())


@pytest.mark.parametrize("document", [*VALID.values(), LOOP], ids=[*VALID, "a loop"])
def test_the_same_is_proved_of_a_plant_that_stands_beside(document: Document) -> None:
    whole = checked(document)
    assert whole.verdict == "VALID"
    assert checked(alone(document), expected=beside(document["system"])) == whole


@pytest.mark.parametrize("known", [Expectation(), Expectation(system=alone(FREE)["system"])])
def test_nothing_is_proved_without_the_plant(known: Expectation) -> None:
    verdict = checked(alone(FREE), expected=known)
    assert (verdict.verdict, verdict.code, verdict.place) == ("INCOMPLETE", "system", "system")
    assert alone(FREE)["system"] in verdict.message
    assert verdict.statement == verdict.system_digest == ""


def test_another_plant_is_invalid_and_both_digests_are_named() -> None:
    verdict = checked(alone(FREE), expected=beside(PAPER))
    assert (verdict.verdict, verdict.code, verdict.place) == ("INVALID", "system", "system")
    assert alone(FREE)["system"] in verdict.message
    assert digest(read_plant(PAPER)) in verdict.message


def test_a_controller_for_another_plant_is_invalid() -> None:
    known = replace(beside(SCALAR), made_for="0" * 64)
    verdict = checked(alone(LOOP), expected=known)
    assert (verdict.verdict, verdict.code) == ("INVALID", "controller")


def test_what_is_false_of_the_plant_stays_invalid() -> None:
    false = changed(alone(FREE), ("claim.stabilizable", False))
    assert checked(false, expected=beside(FREE["system"])).verdict == "INVALID"


ABOUT = alone(FREE)["system"]


@pytest.mark.parametrize(
    "value",
    [
        ABOUT.upper(),
        ABOUT[:-1],
        ABOUT + "0",
        ABOUT + "\n",
        " " + ABOUT,
        "system.json",
        "",
        [ABOUT],
        7,
        None,
        {"digest": ABOUT},
    ],
)
def test_what_is_no_digest_is_malformed(value: Any) -> None:
    for known in (Expectation(), beside(FREE["system"])):
        verdict = checked({**FREE, "system": value}, expected=known)
        assert (verdict.verdict, verdict.place.partition(".")[0]) == ("MALFORMED", "system")


def test_the_plant_is_granted_work_as_if_it_stood_in_the_certificate() -> None:
    known = beside(FREE["system"])
    text = json.dumps(FREE["system"], sort_keys=True, separators=(",", ":"))
    assert known.size == len(text)
    document = alone(FREE)
    size = len(json.dumps(document))
    verdict = checked(document, expected=replace(known, size=-10_000 - size))
    assert (verdict.verdict, verdict.code) == ("INCOMPLETE", "work")
    verdict = checked(FREE, expected=replace(known, size=-10_000 - size))
    assert verdict.verdict == "VALID"


def test_the_file_of_the_plant_is_read_within_the_limits() -> None:
    with pytest.raises(Refused, match="work"):
        Expectation().about(
            json.dumps({"format": "mcexact-system/1", **PAPER}).encode(), Limits(work=10)
        )


NAMED = {name: alone(document) for name, document in EVIDENCE.items()}


def test_a_manifest_implies_the_same_sentences(tmp_path: Path) -> None:
    for folder in ("whole", "named"):
        (tmp_path / folder).mkdir()
    expected = said(write(tmp_path / "whole"))
    assert [verdict.verdict for verdict in expected] == ["IMPLIED"] * len(SENTENCES)
    assert said(write(tmp_path / "named", NAMED), beside(PAPER)) == expected


@pytest.mark.parametrize("first", [{}, {"completeness": EVIDENCE["completeness"]}])
def test_a_manifest_without_the_plant_implies_nothing_of_it(
    tmp_path: Path, first: dict[str, Document]
) -> None:
    found = said(write(tmp_path, {**NAMED, **first}))
    certificates = found[: len(NAMED) - len(first)]
    assert {(each.verdict, each.code) for each in certificates} == {("INCOMPLETE", "system")}
    sentences = found[len(certificates) :]
    assert [each.verdict for each in sentences].count("IMPLIED") == 2 * len(first)


def test_the_command_takes_the_plant_from_the_file_of_the_system(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("free.json").write_bytes(text_of(alone(FREE)))
    Path("loop.json").write_bytes(text_of(alone(LOOP)))
    Path("plant.json").write_bytes(text_of({"format": "mcexact-system/1", **FREE["system"]}))
    assert main(["free.json"]) == 5
    assert main(["free.json", "--system", "plant.json"]) == 0
    assert main(["free.json", "loop.json", "--system", "plant.json"]) == 1
    told = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert told == ["INCOMPLETE", "VALID", "VALID", "INVALID"]
