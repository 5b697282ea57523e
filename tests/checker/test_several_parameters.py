"""Entries with several parameters, read and written in one canonical form."""

from __future__ import annotations

import random
from typing import Any

import pytest

from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.parametric_system import read_parametric
from mcexact.errors import InputError
from mcexact.model.system_file import read_parametric_document
from tests.checker.handmade import ranged

TEXTS: dict[str, Any] = {
    "b*a": "a*b",
    "1/a": "(1)/(a)",
    "2/(4*a*b^2)": "(1/2)/(a*b^2)",
    "a/a": 1,
    "(a^2*b - a)/(a*b)": "(a*b - 1)/(b)",
    "1/a + 1/b": "(a + b)/(a*b)",
    "1/a - 1/a": 0,
    "0*a": 0,
    "(a + b)^2": "a^2 + 2*a*b + b^2",
    "-a*b^2 + a": "-a*b^2 + a",
    "3/2 - b": "-b + 3/2",
    "a - (b - 1)": "a - b + 1",
    "-(a - 1/2)": "-a + 1/2",
    "a/2 - b/3": "1/2*a - 1/3*b",
    "0.25": "1/4",
    "4": 4,
    "a^1000": "a^1000",
    "a^500*b^500": "a^500*b^500",
    "a^500*b^501": None,
    "(a*b)^501": None,
    "(a^2 + 1)^501": None,
    "0*a^1000": 0,
    "1/(a*b)^500*(1/a)": None,
    "1/(a + b)": "(1)/(a + b)",
    "1/(1/a + 1/b)": "(a*b)/(a + b)",
    "(a^2 - b^2)/(2*a + 2*b)": "1/2*a - 1/2*b",
    "(a*b + b)/(3*a^2*b + 3*a*b)": "(1/3)/(a)",
    "1/(a - 1) - 1/(a - 1)": 0,
    "(a - b)^2/(b - a)": "-a + b",
    "c": None,
    "a b": None,
    "a/0": None,
    "a/(b - b)": None,
    "(a": None,
}


@pytest.mark.parametrize("text", TEXTS)
def test_entries_of_several_parameters_have_one_canonical_form(text: str) -> None:
    document = {
        "format": "mcexact-system/1",
        **ranged([[text]], ([[1]], [[1]]), a=(1, 2), b=(1, 2)),
    }
    try:
        found = read_parametric(document, Limits()).document["A"][0][0]
    except Refused as refused:
        assert refused.verdict == "MALFORMED"
        found = None
    assert found == TEXTS[text]
    if found is not None:
        package = read_parametric_document(document).document()
        assert package["A"][0][0] == found
        again = read_parametric({**package})
        assert again.document == package


def drawn_expression(rng: random.Random, depth: int) -> str:
    """An expression in a, b and c, often with a factor above and below."""
    if depth == 0 or rng.random() < 0.15:
        return rng.choice(["a", "b", "c", str(rng.randint(1, 4))])
    first, second = (drawn_expression(rng, depth - 1) for _ in range(2))
    return f"({first}{rng.choice('+-**/')}{second})"


@pytest.mark.parametrize("factor", ["1", "(a + b - 1)", "(a*b - c^2)*(a - 2)"])
def test_drawn_quotients_have_the_lowest_terms_of_the_package(factor: str) -> None:
    rng, compared = random.Random(factor), 0
    for _ in range(40):
        below = rng.choice(["a^2 - b", "a*b + 1", "c - b", "a*b*c", "3"])
        text = f"({drawn_expression(rng, 3)}*{factor})/(({below})*{factor})"
        ranges: Any = dict.fromkeys("abc", (1, 2))
        document = {
            "format": "mcexact-system/1",
            **ranged([[text]], ([[1]], [[1]]), **ranges),
        }
        try:
            package = read_parametric_document(document).document()
        except InputError:
            with pytest.raises(Refused, match="division by 0"):
                read_parametric(document, Limits())
            continue
        compared += 1
        assert read_parametric(document, Limits()).document == package
    assert compared > 20


def test_a_file_with_several_parameters_has_the_digest_of_the_package() -> None:
    for system in (
        ranged([["a*b"]], ([[1]], [[1]]), a=(0, 4), b=(-1, 1)),
        ranged(
            [["a*b", "1/16*a"], ["1/16*a", "-a*b"]],
            ([["a"], [0]], [[1, 0]]),
            ([[0], [1]], [[0, "(1)/(b)"]]),
            time="discrete",
            a=("19/20", "21/20"),
            b=("39/40", "41/40"),
        ),
    ):
        document = {"format": "mcexact-system/1", **system}
        package = read_parametric_document(document).document()
        assert read_parametric(document, Limits()).document == package
