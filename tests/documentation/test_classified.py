"""The table of the gallery's fixed modes says of each why it is fixed, and what would move it."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mcexact.model import gallery

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture
def pages(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    monkeypatch.syspath_prepend(str(DOCS))
    yield importlib.import_module("generated_pages")
    sys.modules.pop("generated_pages")


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("compleib-ac1", []),
        (
            "relative-positions-4",
            [("no", "joint", "equalities", "does not move it", "none help")],
        ),
        (
            "compleib-tf1",
            [("yes", "decentralized", "zeros", "does not move it", "2 → 1")],
        ),
        (
            "movable-by-periodic-gains",
            [("no", "decentralized", "equalities", "moves it", "2 → 1")],
        ),
        (
            "extremal-star-4",
            [("no", "decentralized", "equalities", "moves it", "those it has")],
        ),
    ],
)
def test_what_is_known_of_a_plant_is_its_row(
    pages: Any, name: str, expected: list[tuple[str, ...]]
) -> None:
    assert [row[1:] for row in pages.fixed_modes_of(gallery.load(name))] == expected


def test_each_plant_of_the_table_has_a_fixed_mode_and_no_other_has_one(pages: Any) -> None:
    listed = {line.split("`")[1] for line in pages.classified() if line.startswith("| `")}
    plain = [name for name in gallery.names() if gallery.load(name).D is None]
    recorded = {name for name in plain if pages._expected(name).get("fixed_factors")}
    assert recorded <= listed and len(listed) >= 18
