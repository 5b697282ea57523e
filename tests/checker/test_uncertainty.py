"""How far entries may be from their values: in certificates, and in system files."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mcexact import MultiChannelSystem
from mcexact.boxes import Box
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import canonical, digest, read_plant, read_radii, read_system_file
from mcexact.checker.parametric_system import plant_of_file
from mcexact.model import system_file
from tests.checker.box_plants import PAIR
from tests.checker.handmade import INTEGRATOR, VALID, changed, checked, plant
from tests.wording import says

REST = '"time": "continuous", "channels": [{"name": "1", "B": [["-1/2"], [0]], "C": [[1, 2.50]]}]'
FORM = (
    '{{"format": "mcexact-system/1", {}, "A": [[0.10, "2.5e-3"], [0.00, -1e1]], "uncertainty": {}}}'
)


def file_of(uncertainty: str) -> bytes:
    """A system file."""
    return FORM.format(REST, uncertainty).encode()


def radii_of(uncertainty: str) -> Any:
    """The radii of a system file, by the checker."""
    return canonical(read_system_file(file_of(uncertainty), Limits())).get("uncertainty")


def listed(nrows: int, ncols: int, *entries: list[Any]) -> dict[str, Any]:
    """Radii by their positions."""
    return {"shape": [nrows, ncols], "entries": list(entries)}


READ = [
    (
        '{"digits": "as typed"}',
        {
            "A": listed(2, 2, [0, 0, "1/200"], [0, 1, "1/20000"], [1, 1, 5]),
            "C": {"1": listed(1, 2, [0, 1, "1/200"])},
        },
    ),
    (
        '{"relative": "1/10"}',
        {
            "A": listed(2, 2, [0, 0, "1/100"], [0, 1, "1/4000"], [1, 1, 1]),
            "B": {"1": listed(2, 1, [0, 0, "1/20"])},
            "C": {"1": listed(1, 2, [0, 0, "1/10"], [0, 1, "1/4"])},
        },
    ),
    (
        '{"absolute": {"A": [[0, 0.5], [0, 0]], '
        '"C": {"1": {"shape": [1, 2], "entries": [[0, 1, 1]]}}}}',
        {"A": listed(2, 2, [0, 1, "1/2"]), "C": {"1": listed(1, 2, [0, 1, 1])}},
    ),
    ('{"relative": 0}', None),
    ('{"absolute": {}}', None),
    ('{"absolute": {"B": {}, "A": [[0, 0], [0, 0]]}}', None),
]


@pytest.mark.parametrize(("given", "radii"), READ)
def test_a_file_gives_radii_in_three_ways(given: str, radii: Any) -> None:
    assert radii_of(given) == (None if radii is None else {"absolute": radii})
    known = plant_of_file(file_of(given), Limits())
    assert digest(read_plant(known)) == system_file.read_system(file_of(given).decode()).digest()


@pytest.mark.parametrize(
    "given",
    [
        "null",
        "[]",
        "{}",
        '{"relative": 1, "digits": "as typed"}',
        '{"relative": null}',
        '{"relative": "-1/10"}',
        '{"relative": true}',
        '{"digits": "as written"}',
        '{"digits": null}',
        '{"absolute": null}',
        '{"absolute": {"A": [[0, "-1"], [0, 0]]}}',
        '{"absolute": {"A": [[1]]}}',
        '{"absolute": {"A": null}}',
        '{"absolute": {"B": {"2": [[0], [0]]}}}',
        '{"absolute": {"B": [[[0], [0]]]}}',
        '{"absolute": {"D": [[0]]}}',
        '{"other": 1}',
    ],
)
def test_a_file_with_other_radii_is_refused(given: str) -> None:
    with pytest.raises(Refused) as refused:
        read_system_file(file_of(given), Limits())
    assert refused.value.verdict == "MALFORMED"


@pytest.mark.parametrize(
    "uncertainty",
    [
        {},
        {"relative": "1/10"},
        {"digits": "as typed"},
        {"absolute": {}},
        {"absolute": {"A": [["1/10", 0], [0, "1/20"]]}},
        {"absolute": {"A": listed(2, 2, [0, 0, "-1/10"])}},
        {"absolute": {"A": listed(2, 2, [1, 1, 1], [0, 0, 1])}},
        {"absolute": {"A": listed(2, 2, [0, 0, 0])}},
        {"absolute": {"A": listed(2, 2, [0, 0, "2/4"])}},
        {"absolute": {"A": listed(2, 2, [False, 0, 1])}},
        {"absolute": {"B": {}, "A": listed(2, 2, [0, 0, 1])}},
        {"absolute": {"A": listed(3, 3, [0, 0, 1])}},
        None,
    ],
)
def test_a_certificate_has_the_radii_in_canonical_form_alone(uncertainty: Any) -> None:
    with pytest.raises(Refused) as refused:
        read_plant({**PAIR, "uncertainty": uncertainty})
    assert refused.value.verdict == "MALFORMED"


def test_without_uncertainty_all_radii_are_0() -> None:
    shapes = [(2, 2), (2, 1), (1, 2)]
    found = read_radii(None, ["1"], [Matrix([[1] * q] * p, q) for p, q in shapes])
    assert [(D.nrows, D.ncols) for D in found] == shapes
    assert not any(entry for D in found for row in D.rows for entry in row)


def test_entries_that_are_listed_are_typed_as_well() -> None:
    text = file_of('{"digits": "as typed"}').replace(
        b'"A": [[0.10, "2.5e-3"], [0.00, -1e1]]',
        b'"A": {"shape": [2, 2], "entries": [[1, 1, -1E1], [0, 0, 0.10]]}',
    )
    found = canonical(read_system_file(text, Limits()))["uncertainty"]["absolute"]["A"]
    assert found == listed(2, 2, [0, 0, "1/200"], [1, 1, 5])


def test_radii_with_more_digits_than_numbers_may_have_are_left_open() -> None:
    """1/400, times the part, has fourteen digits."""
    given = file_of('{"relative": "1/99999999977"}')
    assert read_system_file(given, Limits(digits=14)).uncertainty is not None
    with pytest.raises(Refused) as refused:
        read_system_file(given, Limits(digits=13))
    assert (refused.value.verdict, refused.value.place) == ("INCOMPLETE", "uncertainty")
    assert read_system_file(file_of('{"absolute": {}}'), Limits(digits=14)).uncertainty is None


def test_other_kinds_are_about_the_nominal_values_and_say_so() -> None:
    document = changed(VALID["fixed"] if "fixed" in VALID else next(iter(VALID.values())))
    n = len(document["system"]["A"])
    box = {**document["system"], "uncertainty": {"absolute": {"A": listed(n, n, [0, 0, 1])}}}
    said, plain = checked({**document, "system": box}), checked(document)
    assert said.verdict == plain.verdict == "VALID"
    assert says(said.statement, "nominal values") and said.system_digest in said.statement
    assert said.system_digest != plain.system_digest
    assert "nominal" not in plain.statement


def test_the_package_and_the_checker_agree_on_the_digest_of_a_box() -> None:
    system = MultiChannelSystem([["1/2", 0], [1, 2]], [[[1], [0]]], [[[0, 3]]])
    made = Box.relative(system, "1/100").system
    document = json.loads(made.canonical_text())
    assert digest(read_plant(document)) == made.digest()
    assert plant([[0]], ([[1]], [[1]])) == INTEGRATOR
