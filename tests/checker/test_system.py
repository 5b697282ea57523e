"""System files, read by the checker itself so that a digest can be compared."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mcexact.checker.core import system
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import digest, read_matrix, read_plant, read_system_file, too_long
from mcexact.model import gallery, system_file
from tests.checker.handmade import PAPER

NO_ROWS = (None, 0, "", False)
NO_DELAYS = (None, "", False, 1.0, -1)
BASE = {"format": "mcexact-system/1", **PAPER}


def digest_of(text: str) -> str:
    return digest(read_system_file(text.encode(), Limits()))


def test_the_gallery_has_the_digests_that_the_finder_gives() -> None:
    for name in gallery.names():
        plant = gallery.load(name)
        assert digest_of(system_file.system_text(plant)) == plant.digest()


@pytest.mark.parametrize(
    ("reason", "A"),
    [
        ("decimals as typed", "[[0.5, 0], [0, 0.10]]"),
        ("exponents", "[[5e-1, 0], [0, 1E-1]]"),
        ("quotients", '[["1/2", 0], [0, "1/10"]]'),
        ("quotients that can be reduced", '[["2/4", "0/7"], [0, "01/10"]]'),
        ("strings", '[["0.5", "0"], ["-0", "100e-3"]]'),
        ("sparse", '{"shape": [2, 2], "entries": [[1, 1, 0.1], [0, 0, "1/2"]]}'),
    ],
)
def test_one_matrix_may_be_written_in_many_ways(reason: str, A: str) -> None:
    rest = '"time": "continuous", "channels": [{"B": [[1], [0]], "C": [], "D": []}]'
    text = f'{{"format": "mcexact-system/1", "name": "x", "source": "y", "A": {A}, {rest}}}'
    plant = {
        "time": "continuous",
        "A": [["1/2", 0], [0, "1/10"]],
        "channels": [{"name": "1", "B": [[1], [0]], "C": {"shape": [0, 2], "entries": []}}],
    }
    assert digest_of(text) == digest(read_plant(plant)) == system_file.read_system(text).digest()


def test_neighbors_may_be_listed_in_any_order_and_with_the_agent_itself() -> None:
    listed = {
        **BASE,
        "neighbors": {"3": ["1", "3"], "1": ["2"], "2": ["3"]},
        "delays": {"1": {"2": 0}},
    }
    assert digest_of(json.dumps(listed)) == digest(read_plant(PAPER))


def test_delays_without_links_are_refused() -> None:
    plain = {key: value for key, value in BASE.items() if key != "neighbors"}
    assert digest_of(json.dumps(plain))
    with pytest.raises(Refused):
        digest_of(json.dumps({**plain, "delays": {}}))


def test_one_byte_order_mark_says_nothing() -> None:
    text = json.dumps(BASE)
    assert digest_of("\ufeff" + text) == digest_of(text)
    with pytest.raises(Refused):
        digest_of("\ufeff\ufeff" + text)


def test_what_no_claim_depends_on_is_not_in_the_digest() -> None:
    sampled = {
        **BASE,
        "time": "discrete",
        "name": "a",
        "source": "b\n",
        "sample_time": 0.5,
        "D": [],
    }
    plain = {**BASE, "time": "discrete"}
    assert digest_of(json.dumps(sampled)) == digest_of(json.dumps(plain))


@pytest.mark.parametrize(
    ("reason", "edit"),
    [
        ("a certificate", {"format": "mcexact-certificate/1"}),
        ("another version", {"format": "mcexact-system/2"}),
        ("an unknown key", {"channel": []}),
        ("feedthrough of the whole system", {"D": [[0, "1/2"]]}),
        ("feedthrough that is no matrix", {"D": 0}),
        ("a sample time in continuous time", {"sample_time": 1}),
        ("a sample time below 0", {"time": "discrete", "sample_time": -1}),
        ("a sample time of 0", {"time": "discrete", "sample_time": 0}),
        ("a name that is a number", {"name": 1.5}),
        ("a source with characters that do not print", {"source": "a\u202eb"}),
        ("a source that is null", {"source": None}),
        ("a neighbor twice", {"neighbors": {"1": ["2", "2"]}}),
        ("neighbors that are null", {"neighbors": None}),
        *(
            (f"neighbors of an agent that are {row!r}", {"neighbors": {"1": row}})
            for row in NO_ROWS
        ),
        *((f"delays that are {row!r}", {"delays": {"1": row}}) for row in (*NO_ROWS, [])),
        *((f"a delay that is {row!r}", {"delays": {"1": {"2": row}}}) for row in NO_DELAYS),
        ("no delay where there is no link", {"delays": {"1": {"3": 0}}}),
        ("a D that is null", {"channels": [{"B": [[1]] * 3, "C": [[1, 0, 0]], "D": None}]}),
        ("a name that is null", {"channels": [{"B": [[1]] * 3, "C": [[1, 0, 0]], "name": None}]}),
        ("digits beyond the limit", {"A": [["1e4301"] * 3] * 3}),
        ("digits that an exponent hides", {"A": [["9" * 4300 + "e9"] * 3] * 3}),
        ("feedthrough", {"channels": [{"B": [[1], [0], [0]], "C": [[1, 0, 0]], "D": [[1]]}]}),
        ("a zero denominator", {"A": [["1/0"] * 3] * 3}),
        ("a huge exponent", {"A": [["1e1001"] * 3] * 3}),
        ("a float that is no number", {"A": [["nan"] * 3] * 3}),
        ("a huge shape", {"A": {"shape": [10**6, 10**6], "entries": []}}),
        ("an entry twice", {"A": {"shape": [3, 3], "entries": [[0, 0, 1], [0, 0, 1]]}}),
        ("an entry outside", {"A": {"shape": [3, 3], "entries": [[3, 0, 1]]}}),
        ("an entry far below", {"A": {"shape": [3, 3], "entries": [[4, 0, 1]]}}),
        ("an entry at the right", {"A": {"shape": [3, 3], "entries": [[0, 3, 1]]}}),
        ("an entry far at the right", {"A": {"shape": [3, 3], "entries": [[0, 4, 1]]}}),
        ("an entry from the end", {"A": {"shape": [3, 3], "entries": [[-1, 0, 1]]}}),
        ("no channels", {"channels": []}),
    ],
)
def test_a_wrong_system_file_is_refused(reason: str, edit: dict[str, object]) -> None:
    with pytest.raises(Refused):
        digest_of(json.dumps({**BASE, **edit}))


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [
        (0, 0, False),
        (1, 0, True),
        (0, 1, False),
        (9, 1, False),
        (10, 1, True),
        (10**20 - 1, 20, False),
        (10**20, 20, True),
        (10**21, 20, True),
    ],
)
def test_a_number_has_as_many_digits_as_it_is_written_with(
    value: int, digits: int, expected: bool
) -> None:
    assert too_long(value, digits) == expected


@pytest.mark.parametrize("digits", range(4))
@pytest.mark.parametrize("number", [0, 7, "7/8", "0.7", 12, "12/5", "-123"])
def test_a_number_needs_the_digits_of_its_longer_part(number: object, digits: int) -> None:
    needed = {0: 1, 7: 1, "7/8": 1, "0.7": 2, 12: 2, "12/5": 2, "-123": 3}[number]
    limits = Limits(digits=digits)
    if digits >= needed:
        assert system.number(number, "A", limits) is not None
    else:
        with pytest.raises(Refused) as found:
            system.number(number, "A", limits)
        assert (found.value.verdict, found.value.code) == ("INCOMPLETE", "size")


@pytest.mark.parametrize(
    ("nrows", "ncols", "good"),
    [
        (0, 0, True),
        (12, 12, True),
        *((size, other, size == 12) for size in (12, 13) for other in (0, 1, 12)),
        *((other, size, size == 12) for size in (12, 13) for other in (0, 1, 12)),
    ],
)
def test_a_sparse_matrix_has_so_many_rows_and_columns_at_most(
    nrows: int, ncols: int, good: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert system.LONGEST == 1_048_576
    monkeypatch.setattr(system, "LONGEST", 12)
    sparse = {"shape": [nrows, ncols], "entries": []}
    if good:
        assert read_matrix(sparse, "A", None, None).nrows == nrows
    else:
        with pytest.raises(Refused) as found:
            read_matrix(sparse, "A", None, None)
        assert (found.value.verdict, found.value.code) == ("INCOMPLETE", "size")


@pytest.mark.parametrize(
    "A", [[["2/2", 0, 0], [0, 1, 0], [0, 1, 1]], {"shape": [3, 3], "entries": []}]
)
def test_the_plant_of_a_certificate_has_one_form(A: object) -> None:
    assert digest(read_plant(PAPER)) == digest_of(json.dumps(BASE))
    assert digest_of(json.dumps({**BASE, "A": A}))
    with pytest.raises(Refused) as found:
        read_plant({**PAPER, "A": A})
    assert (found.value.verdict, found.value.place) == ("MALFORMED", "system")


@pytest.mark.parametrize("key", ["name", "source"])
def test_a_text_about_a_system_has_at_most_10000_characters(key: str) -> None:
    assert digest_of(json.dumps({**BASE, key: "x" * 10_000})) == digest_of(json.dumps(BASE))
    with pytest.raises(Refused):
        digest_of(json.dumps({**BASE, key: "x" * 10_001}))


@pytest.mark.parametrize(
    ("reason", "rows"),
    [
        ("the first row is no list", [1, [2]]),
        ("another row is no list", [[1], {"1": 2}]),
        ("a text is no row", [[1], "2"]),
        ("a row is too long", [[1], [2, 3]]),
        ("a row is too short", [[1], []]),
        ("true is no number", [[1], [True]]),
        ("a list is no number", [[1], [[2]]]),
        ("nothing is no number", [[1], [None]]),
    ],
)
def test_rows_that_are_not_all_alike_are_refused_in_a_certificate(reason: str, rows: Any) -> None:
    with pytest.raises(Refused, match="expected"):
        read_matrix(rows, "A", None, None)


def test_integers_are_read_as_they_are_and_others_beside_them_as_numbers() -> None:
    assert read_matrix([[1, -(10**30)], [0, 2]], "A", 2, 2).rows == [[1, -(10**30)], [0, 2]]
    mixed = read_matrix([[1, 2], ["1/2", 3]], "A", 2, 2)
    assert (mixed.rows, mixed.denominator) == ([[2, 4], [1, 6]], 2)
    assert read_matrix([[], []], "B", 2, None).ncols == 0
    assert read_matrix([], "C", None, 3).ncols == 3


def test_integers_of_a_file_have_a_limit_and_those_of_a_certificate_had_it() -> None:
    assert read_matrix([[10**5]], "A", 1, 1).rows == [[10**5]]
    with pytest.raises(Refused, match="more than 5 digits"):
        read_matrix([[10**5]], "A", 1, 1, Limits(digits=5))
