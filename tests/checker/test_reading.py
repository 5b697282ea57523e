"""Strict reading: what is no document of the format never reaches a rule."""

from __future__ import annotations

import io
import json
import re
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from mcexact.checker.core import reading
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import check_document
from tests import effort
from tests.checker.handmade import FIXED, FREE, PAPER, Document, changed, checked, without
from tests.wording import refusal, worded

TEXT = json.dumps(FREE)


def edited(old: str, new: str) -> bytes:
    assert old in TEXT
    return TEXT.replace(old, new, 1).encode()


ACCEPTED = [
    ("as written", TEXT.encode()),
    ("with blanks and line feeds", json.dumps(FREE, indent=3).encode() + b"\n\n"),
    ("keys in another order", json.dumps(FREE, sort_keys=True).encode()),
    ("a name in escapes", edited('"name": "1"', '"name": "\\u0031"')),
    ("minus zero is zero", edited('"A": [[0]]', '"A": [[-0]]')),
]

MALFORMED = [
    ("nothing", b""),
    ("a blank", b" "),
    ("no JSON", b"VALID"),
    ("half a document", TEXT[:-1].encode()),
    ("two documents", (TEXT + TEXT).encode()),
    ("a list", b"[]"),
    ("null", b"null"),
    ("a number", b"7"),
    ("a byte order mark", b"\xef\xbb\xbf" + TEXT.encode()),
    ("UTF-16", TEXT.encode("utf-16")),
    ("Latin 1", edited('"name": "1"', '"name": "\xe9"').decode().encode("latin-1")),
    ("a control character in a string", edited('"name": "1"', '"name": "\x01"')),
    ("a comma at the end", edited('"subject": []', '"subject": [],')),
    ("a comment", edited('"subject": []', '"subject": [] // none')),
    ("a key twice", edited('"subject": []', '"subject": [], "subject": []')),
    ("a key twice, deep down", edited('"entries": [[1]]', '"entries": [[0]], "entries": [[1]]')),
    ("an unknown key", edited('"subject": []', '"subject": [], "verified": true')),
    ("an unknown key, deep down", edited('"modulus": 7', '"modulus": 7, "comment": ""')),
    ("a float", edited('"modulus": 7', '"modulus": 7.0')),
    ("an exponent", edited('"modulus": 7', '"modulus": 7e0')),
    ("a huge exponent", edited('"modulus": 7', '"modulus": 1e999999999')),
    ("NaN", edited('"modulus": 7', '"modulus": NaN')),
    ("Infinity", edited('"modulus": 7', '"modulus": -Infinity')),
    ("a leading zero", edited('"modulus": 7', '"modulus": 07')),
    ("a plus sign", edited('"modulus": 7', '"modulus": +7')),
    ("true for a number", edited('"modulus": 7', '"modulus": true')),
    ("a string for a number", edited('"modulus": 7', '"modulus": "7"')),
    ("null for a number", edited('"modulus": 7', '"modulus": null')),
    ("a number for a truth value", edited('"stabilizable": true', '"stabilizable": 1')),
    ("an object for a list", edited('"subject": []', '"subject": {}')),
    ("a list for an object", edited('"claim": {', '"claim": [], "x": {')),
    ("depth 17", b"[" * 17 + b"]" * 17),
    ("depth 100000", b"[" * 100_000 + b"]" * 100_000),
    ("depth 100000, never closed", b'{"a":' * 100_000),
    ("another format", edited("mcexact-certificate/1", "mcexact-system/1")),
    ("no format", edited('"format": "mcexact-certificate/1", ', "")),
    ("a format that is no string", edited('"mcexact-certificate/1"', "1")),
    ("a quotient not in lowest terms", edited('"A": [[0]]', '"A": [["2/4"]]')),
    ("a quotient with denominator 1", edited('"A": [[0]]', '"A": [["2/1"]]')),
    ("a quotient with denominator 0", edited('"A": [[0]]', '"A": [["2/0"]]')),
    ("a quotient with a negative denominator", edited('"A": [[0]]', '"A": [["1/-2"]]')),
    ("a quotient with a plus sign", edited('"A": [[0]]', '"A": [["+1/2"]]')),
    ("a quotient with blanks", edited('"A": [[0]]', '"A": [["1 / 2"]]')),
    ("a quotient in other digits", edited('"A": [[0]]', '"A": [["\u0661/2"]]')),
    ("an underscore", edited('"A": [[0]]', '"A": [["1_0/3"]]')),
    ("a decimal in a certificate's system", edited('"A": [[0]]', '"A": [[0.5]]')),
    ("a decimal string in a certificate's system", edited('"A": [[0]]', '"A": [["0.5"]]')),
    ("an integer as a string", edited('"A": [[0]]', '"A": [["0"]]')),
    ("rows of different lengths", edited('"A": [[0]]', '"A": [[0, 0], [0]]')),
    ("a matrix that is not square", edited('"A": [[0]]', '"A": [[0, 0]]')),
    ("a B with more rows than A", edited('"B": [[1]]', '"B": [[1], [1]]')),
    ("a C with more columns than A", edited('"C": [[1]]', '"C": [[1, 1]]')),
    ("no channels", edited('"channels": [', '"channels": [], "x": [')),
    ("an empty name", edited('"name": "1"', '"name": ""')),
    ("a name that is a number", edited('"name": "1"', '"name": 1')),
    ("another time", edited('"continuous"', '"sampled"')),
    ("a sparse matrix", edited('"A": [[0]]', '"A": {"shape": [1, 1], "entries": []}')),
]  # fmt: skip


@pytest.mark.parametrize(("reason", "data"), ACCEPTED)
def test_the_same_document_may_be_written_in_many_ways(reason: str, data: bytes) -> None:
    assert check_document(data).verdict == "VALID"


@pytest.mark.parametrize(("reason", "data"), MALFORMED)
def test_what_has_the_wrong_form_is_malformed(reason: str, data: bytes) -> None:
    with effort.at_most(3000):  # a document that is accepted takes half of it
        verdict = check_document(data)
    assert verdict.verdict == "MALFORMED", verdict.line()
    assert verdict.line().isascii()
    assert len(verdict.line()) < 300
    assert "\n" not in verdict.line()


@pytest.mark.parametrize(
    ("reason", "document"),
    [
        ("a kind of the future", changed(FREE, ("kind", "is_nice"))),
        ("a version of the future", changed(FREE, ("format", "mcexact-certificate/99"))),
        ("a construction of the future", changed(FREE, ("subject", [{"construction": "blessed"}]))),
    ],
)
def test_what_this_checker_does_not_know_is_incomplete(reason: str, document: Document) -> None:
    verdict = checked(document)
    assert (verdict.verdict, verdict.status) == ("INCOMPLETE", 5)


@pytest.mark.parametrize(
    ("limits", "document"),
    [
        (Limits(bytes=100), FREE),
        (Limits(digits=1), changed(FREE, ("witness.modulus", 11))),
        (Limits(), changed(FREE, ("witness.modulus", 10**3000 * 10**1300))),
        (Limits(), changed(FREE, ("system.A.0.0", "1/" + "9" * 4301))),
    ],
)
def test_a_document_beyond_the_limits_is_incomplete(limits: Limits, document: Document) -> None:
    import sys

    before = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        verdict = check_document(json.dumps(document).encode(), limits=limits)
    finally:
        sys.set_int_max_str_digits(before)
    assert (verdict.verdict, verdict.code) == ("INCOMPLETE", "size")
    assert "(Limits." in verdict.message


def test_the_largest_numbers_within_the_limits_are_read() -> None:
    assert checked(changed(FREE, ("witness.modulus", 10**4299))).verdict == "VALID"
    narrow = check_document(json.dumps(FREE).encode(), limits=Limits(depth=3))
    assert narrow.verdict == "MALFORMED"
    assert "Limits.depth" in narrow.message


def test_a_long_string_is_one_step_however_long_it_is() -> None:
    with effort.at_most(3000):
        verdict = checked(changed(FREE, ("comment", "x" * (20 << 20))))
    assert (verdict.verdict, verdict.message) == ("MALFORMED", 'unknown key "comment"')
    escaped = TEXT.replace('"1"', '"' + '\\"' * (1 << 20), 1).encode()
    with effort.at_most(3000):
        assert check_document(escaped).verdict == "MALFORMED"


PATTERNS = [name for name, value in vars(reading).items() if isinstance(value, re.Pattern)]


@pytest.mark.parametrize("name", PATTERNS)
def test_a_scan_never_gives_back_what_it_took(name: str) -> None:
    """Else a document could make it look at one place over and over."""
    without_classes = re.sub(r"\\.|\[[^]]*\]", "x", getattr(reading, name).pattern)
    repetitions = re.findall(r"(?:[*+]|\{\d*,\d*\})\+?", without_classes)
    assert repetitions and all(len(found) > 1 and found.endswith("+") for found in repetitions)


def test_the_parts_of_a_document_are_all_needed() -> None:
    for key in FREE:
        assert checked(without(FREE, key)).verdict == "MALFORMED"
    for place in ("claim.factors", "witness.gains", "system.time", "system.channels.0.B"):
        assert checked(without(FREE, place)).verdict == "MALFORMED"


def test_a_document_may_be_handed_over_as_it_would_be_parsed() -> None:
    assert check_document(FIXED).verdict == "VALID"
    assert check_document(changed(FIXED, ("witness.modulus", 101.0))).verdict == "MALFORMED"


def test_channels_of_the_same_name_are_malformed() -> None:
    twice = changed(FIXED, ("system.channels.1.name", "1"))
    assert checked(twice).verdict == "MALFORMED"


@pytest.mark.parametrize(
    ("reason", "edit"),
    [
        ("a neighbor that is no agent", ("system.neighbors.1", ["4"])),
        ("a neighbor twice", ("system.neighbors.1", ["2", "2"])),
        ("itself, which is implied", ("system.neighbors.1", ["1", "2"])),
        ("neighbors out of order", ("system.neighbors.1", ["3", "2"])),
        ("an agent that is missing", ("system.neighbors", {"1": ["2"]})),
        ("an agent too many", ("system.neighbors.4", [])),
        ("a delay on no arc", ("system.delays", {"1": {"3": 1}})),
        ("a delay of 0, which is implied", ("system.delays", {"1": {"2": 0}})),
        ("a delay to itself", ("system.delays", {"1": {"1": 1}})),
        ("a negative delay", ("system.delays", {"1": {"2": -1}})),
        ("no delays, which is implied", ("system.delays", {})),
        ("a name of the system", ("system.name", "plant")),
    ],
)
def test_the_system_of_a_certificate_has_one_form(reason: str, edit: tuple[str, object]) -> None:
    assert checked(changed(FIXED, edit)).verdict == "MALFORMED"


def test_an_exception_inside_the_checker_is_never_valid(monkeypatch: pytest.MonkeyPatch) -> None:
    from mcexact.checker import kinds

    def broken(*_: object) -> None:
        raise RecursionError("on purpose\nwith two lines")

    rule = kinds.KINDS["fixed_spectrum"]
    for weakened in (replace(rule, check=broken), replace(rule, statement=broken)):
        monkeypatch.setitem(kinds.KINDS, "fixed_spectrum", weakened)
        verdict = checked(FREE)
        assert (verdict.verdict, verdict.status, verdict.statement) == ("ERROR", 70, "")
        assert "\n" not in verdict.line()


@pytest.mark.parametrize("name", ["x\u202ey", "tab\t", "VALID\n", "\u200b", "\ud800", "\u2028"])
def test_names_with_characters_that_do_not_print_are_refused(name: str) -> None:
    neighbors = {name: ["2"], "2": ["3"], "3": [name]}
    system = changed(FIXED, ("system", {**PAPER, "neighbors": neighbors}))
    verdict = checked(changed(system, ("system.channels.0.name", name)))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "channels[0].name")
    assert verdict.line().isascii() and len(verdict.line().splitlines()) == 1


def test_names_that_could_mislead_are_escaped_in_the_theorem() -> None:
    for name, shown in (
        ("a, b", '"a, b"'),
        ("motor", '"motor"'),
        ("\u00e9cluse", '"\\u00e9cluse"'),
    ):
        renamed = changed(
            FIXED,
            ("system", {**PAPER, "neighbors": {name: ["2"], "2": ["3"], "3": [name]}}),
            ("system.channels.0.name", name),
            ("witness.subspaces.0.channels_T", [name]),
        )
        verdict = checked(renamed)
        assert verdict.verdict == "VALID", verdict.line()
        graph = checked(
            {
                **renamed,
                "kind": "controllability",
                "claim": {
                    "channels": [name],
                    "dimension": 1,
                    "controllable": False,
                    "uncontrollable_polynomial": [1, -2, 1],
                },
                "witness": {
                    "modulus": 7,
                    "annihilator": {"denominator": 1, "entries": [[0, 1, 0], [0, 0, 1]]},
                    "pivots": [1, 2],
                },
            }
        )
        assert graph.verdict == "VALID", graph.line()
        assert f"the channels {{{shown}}} together" in graph.statement
        assert len(graph.line().splitlines()) == 1


def test_positions_are_below_the_length() -> None:
    assert reading.positions([0, 2], "p", 3) == [0, 2]
    for wrong in ([3], [4], [0, 7], [1, 0], [1, 1], [-1]):
        with pytest.raises(reading.Refused):
            reading.positions(wrong, "p", 3)


def test_names_have_at_most_256_characters() -> None:
    assert reading.own_names(["x" * 256], ["name"]) == ["x" * 256]
    with pytest.raises(reading.Refused):
        reading.own_names(["x" * 257], ["name"])


def test_documents_have_at_most_16_levels() -> None:
    levels = Limits().depth
    assert levels == 16
    assert reading.parse(b"[" * 16 + b"]" * 16, Limits()) is not None
    with pytest.raises(reading.Refused):
        reading.parse(b"[" * 17 + b"]" * 17, Limits())


def test_what_no_reader_can_nest_is_told() -> None:
    data = b"[" * 10**5 + b"]" * 10**5
    found = check_document(data, limits=Limits(depth=10**6, work=10**12))
    assert (found.verdict, found.code) == ("MALFORMED", "form")
    assert worded(found.message)


def test_a_polynomial_has_a_leading_coefficient_of_one() -> None:
    assert reading.polynomial([1], "here") == [1]
    for wrong in ([], [2], [1, 0]):
        with pytest.raises(reading.Refused) as refused:
            reading.polynomial(wrong, "here")
        assert worded(refused.value.args)


def test_a_string_that_is_missing_is_asked_for() -> None:
    with pytest.raises(reading.Refused, match="expected a string, found 3"):
        reading.string(3, "p")
    with pytest.raises(reading.Refused, match='expected "a" or "b", found "c"'):
        reading.string("c", "p", "a", "b")


def test_a_document_has_at_most_64_mebibytes() -> None:
    assert Limits().bytes == 67_108_864
    assert reading.parse(b"[1]", Limits(bytes=3)) == [1]
    with pytest.raises(reading.Refused) as found:
        reading.parse(b"[1]", Limits(bytes=2))
    assert (found.value.verdict, found.value.code) == ("INCOMPLETE", "size")


@pytest.mark.parametrize(("most", "parts"), [(2**22, [2**20] * 3), (10, [11, 6])])
def test_a_stream_is_read_in_parts(most: int, parts: list[int]) -> None:
    asked: list[int] = []

    class Stream(io.BytesIO):
        def read(self, size: int | None = -1) -> bytes:
            asked.append(size or 0)
            return super().read(min(size or 0, 5) if most < 2**20 else size)

    length = 2**21 if most > 2**20 else 5
    assert len(reading.read_bytes(Stream(bytes(length)), Limits(bytes=most))) == length
    assert asked == parts


def test_a_file_is_read_or_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b"[]")
    assert reading.read_file(str(path), Limits()) == b"[]"
    for wrong in (str(tmp_path), str(tmp_path / "b.json"), "a\0b"):
        with pytest.raises(reading.Refused) as found:
            reading.read_file(wrong, Limits())
        assert found.value.args[:3] == ("MALFORMED", "unreadable", "file")


def test_standard_input_is_read_or_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"[]")))
    assert reading.read_file("-", Limits()) == b"[]"
    monkeypatch.setattr(sys, "stdin", None)
    with refusal(reading.Refused):
        reading.read_file("-", Limits())


def test_the_place_of_a_wrong_number_is_its_first_24_characters() -> None:
    with pytest.raises(reading.Refused) as found:
        reading.parse(b"[1.23456789012345678901234567890]", Limits())
    assert found.value.place == "number 1.2345678901234567890123"
