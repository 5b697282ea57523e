"""A certificate may name its plant by its digest; then the plant has to stand beside it."""

from __future__ import annotations

import hashlib
import io
import json
import os
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.command import (
    main,
    manifest_verdicts,
    plants_beside,
    verdicts,
    verdicts_of,
)
from mcexact.checker.core.budget import GRANTED, PER_BYTE, Budget, limited
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import digest, read_plant
from mcexact.checker.kinds import NOT_ABOUT, Clock, Expectation, check_document
from tests.checker import test_blocks, test_completeness, test_transfer_graph
from tests.checker.handmade import FIXED, FREE, GRAPH, PAPER, VALID, Document, changed, checked
from tests.checker.manifests import (
    EVIDENCE,
    SENTENCES,
    manifest,
    said,
    sentence,
    text_of,
    write,
)
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
    assert (verdict.verdict, verdict.code, verdict.place) == (NOT_ABOUT, "system", "system")
    assert alone(FREE)["system"] in verdict.message
    assert digest(read_plant(PAPER)) in verdict.message


def test_a_controller_for_another_plant_is_invalid() -> None:
    known = replace(beside(SCALAR), made_for="0" * 64)
    verdict = checked(alone(LOOP), expected=known)
    assert (verdict.verdict, verdict.code) == (NOT_ABOUT, "controller")


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
    told = [re.match("NOT ABOUT|[A-Z]+", line)[0] for line in capsys.readouterr().out.splitlines()]
    assert told == ["INCOMPLETE", "VALID", "VALID", NOT_ABOUT]


# The plant in a file beside the certificate.


def canonical_bytes(plant: Document) -> bytes:
    """The bytes of a plant's file."""
    return json.dumps(plant, sort_keys=True, separators=(",", ":")).encode("ascii")


def write_beside(folder: Path, data: bytes, plant: Document = PAPER) -> Path:
    """Write some bytes as the file of a plant."""
    path = folder / f"{digest(read_plant(plant))}.plant"
    path.write_bytes(data)
    return path


def one_line(folder: Path, document: Document) -> tuple[str, ...]:
    """Verdict, code and place of a certificate in a folder."""
    (folder / "c.json").write_bytes(text_of(document))
    ((_, found),) = verdicts([str(folder / "c.json")], None, (None,) * 3, Limits(), Clock())
    return found.verdict, found.code, found.place


@pytest.mark.parametrize("document", [*VALID.values(), LOOP], ids=[*VALID, "a loop"])
def test_the_plant_is_read_from_its_file_beside_the_certificate(
    tmp_path: Path, document: Document
) -> None:
    plant = document["system"]
    assert one_line(tmp_path, alone(document)) == ("INCOMPLETE", "system", "system")
    path = write_beside(tmp_path, canonical_bytes(plant), plant)
    assert hashlib.sha256(path.read_bytes()).hexdigest() == path.stem
    assert one_line(tmp_path, alone(document)) == ("VALID", "", "")


@pytest.mark.parametrize("rest", [b"\n", b" ", b"{}"])
def test_what_is_added_to_the_file_of_a_plant_is_another_digest(
    tmp_path: Path, rest: bytes
) -> None:
    write_beside(tmp_path, canonical_bytes(PAPER) + rest)
    assert one_line(tmp_path, alone(FIXED)) == ("INVALID", "digest", "system")


def test_another_plant_under_the_digest_is_invalid(tmp_path: Path) -> None:
    """The digest of the file is compared, not that of what the certificate says."""
    other = changed(PAPER, ("A", [[-1, 0, 0], [0, -1, 0], [0, 1, -1]]))
    write_beside(tmp_path, canonical_bytes(other))
    assert one_line(tmp_path, alone(FIXED)) == ("INVALID", "digest", "system")
    # under its own digest it is a plant, of which the claims are false
    write_beside(tmp_path, canonical_bytes(other), other)
    found = one_line(tmp_path, {**alone(FIXED), "system": digest(read_plant(other))})
    assert found[0] == "INVALID" and found[1] != "digest"


PLANT = json.dumps(PAPER)
FILES: list[tuple[str, bytes]] = [
    ("with blanks", PLANT.encode()),
    ("with a line feed", canonical_bytes(PAPER) + b"\n"),
    ("with an unsorted key", PLANT.replace(" ", "").encode()),
    ("not in lowest terms", canonical_bytes(changed(PAPER, ("A.0.0", "2/2")))),
    ("a truth value for a number", canonical_bytes(changed(PAPER, ("A.0.0", True)))),
    ("a float", canonical_bytes(changed(PAPER, ("A.0.0", 1.0)))),
    ("a key of system files", canonical_bytes(PAPER | {"name": "paper"})),
    ("a list", b"[]"),
    ("a certificate", canonical_bytes(FIXED)),
    ("the digest of another one", canonical_bytes("0" * 64)),  # type: ignore[arg-type]
    ("nothing", b""),
    ("no text", b"\xff"),
    ("a mark of the encoding", b"\xef\xbb\xbf" + canonical_bytes(PAPER)),
]


@pytest.mark.parametrize("data", [row[1] for row in FILES], ids=[row[0] for row in FILES])
def test_a_file_under_its_own_digest_holds_the_canonical_text_of_a_plant(
    tmp_path: Path, data: bytes
) -> None:
    own = hashlib.sha256(data).hexdigest()
    (tmp_path / f"{own}.plant").write_bytes(data)
    found = one_line(tmp_path, {**FIXED, "system": own})
    assert found[0] == "MALFORMED", found


def test_no_name_of_a_plant_is_a_path(tmp_path: Path) -> None:
    """What is no digest is not looked for, so that no file elsewhere is read."""
    folder = tmp_path / "certificates"
    folder.mkdir()
    path = write_beside(tmp_path, canonical_bytes(PAPER))
    names = [f"../{path.stem}", str(path.with_suffix("")), f"./{path.stem}", path.name]
    names += [path.stem + "\x00", path.stem.upper(), "", f"{folder}/../{path.stem}"]
    for name in names:
        assert one_line(folder, {**FIXED, "system": name})[0] == "MALFORMED"
    assert one_line(folder, alone(FIXED)) == ("INCOMPLETE", "system", "system")


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="needs symbolic links")
def test_the_file_of_a_plant_is_a_regular_file_of_the_folder(tmp_path: Path) -> None:
    path = write_beside(tmp_path, canonical_bytes(PAPER))
    path.rename(tmp_path / "elsewhere")
    path.symlink_to(tmp_path / "elsewhere")
    assert one_line(tmp_path, alone(FIXED)) == ("INVALID", "file", "system")
    path.unlink()
    path.mkdir()
    assert one_line(tmp_path, alone(FIXED)) == ("INVALID", "file", "system")
    path.rmdir()
    path.symlink_to(tmp_path / "nowhere")
    assert one_line(tmp_path, alone(FIXED)) == ("INVALID", "file", "system")


def test_the_file_of_a_plant_is_read_up_to_the_limit(tmp_path: Path) -> None:
    path = write_beside(tmp_path, canonical_bytes(PAPER).ljust(20_000))
    find = plants_beside(str(tmp_path / "c.json"), Limits(bytes=15_000))
    found = check_document(text_of(alone(FIXED)), None, Limits(bytes=15_000), find)
    assert (found.verdict, found.code) == ("INCOMPLETE", "size")
    assert len(find(path.stem) or b"") == 15_001


def test_what_is_asked_for_is_compared_with_the_plant_beside(tmp_path: Path) -> None:
    write_beside(tmp_path, canonical_bytes(PAPER))
    find = plants_beside(str(tmp_path / "c.json"), Limits())
    text = text_of(alone(FIXED))
    assert check_document(text, beside(PAPER), beside=find).verdict == "VALID"
    found = check_document(text, beside(FREE["system"]), beside=find)
    assert (found.verdict, found.code, found.place) == (NOT_ABOUT, "system", "system")


def test_standard_input_is_in_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_beside(tmp_path, canonical_bytes(PAPER))
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text_of(alone(FIXED)))))
    ((_, found),) = verdicts(["-"], None, (None,) * 3, Limits(), Clock())
    assert (found.verdict, found.code) == ("INCOMPLETE", "system")


def test_the_plant_beside_is_granted_work_as_if_it_stood_in_the_certificate() -> None:
    data, budget = canonical_bytes(PAPER), Budget()
    with limited(budget):
        found = check_document(text_of(alone(FIXED)), beside=lambda _: data)
    assert found.verdict == "VALID"
    assert budget.usual == GRANTED + PER_BYTE * (len(text_of(alone(FIXED))) + len(data))


# A manifest, whose certificates share one reading of the plant.


def test_a_manifest_takes_the_plant_beside_it(tmp_path: Path) -> None:
    for folder in ("whole", "named"):
        (tmp_path / folder).mkdir()
    expected = said(write(tmp_path / "whole"))
    write_beside(tmp_path / "named", canonical_bytes(PAPER))
    assert said(write(tmp_path / "named", NAMED)) == expected
    assert said(tmp_path / "named", beside(PAPER)) == expected
    other = said(tmp_path / "named", beside(FREE["system"]))
    assert {(each.verdict, each.code) for each in other[: len(NAMED)]} == {(NOT_ABOUT, "system")}


def test_a_wrong_plant_beside_a_manifest_leaves_no_sentence(tmp_path: Path) -> None:
    write(tmp_path, NAMED)
    write_beside(tmp_path, canonical_bytes(changed(PAPER, ("A.0.0", 7))))
    found = said(tmp_path)
    assert {(each.verdict, each.code) for each in found[: len(NAMED)]} == {("INVALID", "digest")}
    assert {each.verdict for each in found[len(NAMED) :]} == {"INVALID"}


def test_a_manifest_reads_its_plant_once(tmp_path: Path) -> None:
    data, reads = canonical_bytes(PAPER), []
    write(tmp_path, NAMED)

    def find(value: str) -> bytes:
        reads.append(value)
        return data

    texts = {f"{name}.json": text_of(document) for name, document in NAMED.items()}
    texts[""] = (tmp_path / "manifest.json").read_bytes()
    found = list(verdicts_of(texts.__getitem__, Expectation(), Limits(), find))
    assert not any(verdict.status for _, verdict in found)
    assert reads == [alone(FIXED)["system"]]


def changes(row: tuple[Any, ...]) -> list[tuple[str, Any]]:
    """The changes of a row of a table, without the verdict that some have at the end."""
    return [part for part in row if isinstance(part, tuple)]


FALSE = [(f"blocks: {row[0]}", row[1], changes(row)) for row in test_blocks.REJECTED]
FALSE += [(f"edges: {row[0]}", GRAPH, changes(row)) for row in test_transfer_graph.REJECTED]
FALSE += [(f"complete: {row[0]}", row[1], changes(row)) for row in test_completeness.REJECTED]


@pytest.mark.parametrize(
    ("good", "change"), [row[1:] for row in FALSE], ids=[row[0] for row in FALSE]
)
def test_what_one_certificate_proved_is_no_evidence_of_another_one(
    tmp_path: Path, good: Document, change: list[tuple[str, Any]]
) -> None:
    """What was proved before is found again by the same evidence only."""
    bad = changed(good, *change)
    both = {"a": good, "b": bad, "c": good}
    found = manifest_verdicts(
        str(write(tmp_path, both, manifest(both, [sentence("heading")]))), Expectation(), Limits()
    )
    told = {about["file"]: verdict for about, verdict in found if "file" in about}
    alone, about_plant = checked(bad), bad["system"] == good["system"]
    assert told["a.json"].verdict == told["c.json"].verdict == "VALID"
    assert told["b.json"].verdict == alone.verdict if about_plant else told["b.json"].status
    assert alone.status


def test_a_truth_value_is_no_entry_of_a_plant_that_was_read_before(tmp_path: Path) -> None:
    """Python takes 1 and true for equal, and a plant that is known is not read again."""
    (entry,) = [i for i, row in enumerate(PAPER["A"]) if 1 in row][:1]
    place = f"A.{entry}.{PAPER['A'][entry].index(1)}"
    twice = {"a": FIXED, "b": {**FIXED, "system": changed(PAPER, (place, True))}}
    found = said(write(tmp_path, twice, manifest(twice, [sentence("heading")])))
    assert (found[0].verdict, found[0].place.split()[0]) == ("MALFORMED", "b.json")
