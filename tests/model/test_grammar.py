"""The package and the checker read the same system files, with the same digests."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

import pytest

from mcexact.checker import controllers
from mcexact.checker.core import reading
from mcexact.checker.core import system as checker
from mcexact.exact import rational
from mcexact.model import entries, system_file
from tests.assurance.campaigns import controller_grammar
from tests.assurance.campaigns.grammar import Tally, run
from tests.assurance.campaigns.grammar_tokens import GOOD_NUMBERS, NAMES, NASTY, TEXTS


def test_both_readers_accept_the_same_files_with_the_same_digests() -> None:
    tally = run(3000)
    assert tally.failures == []
    assert tally.accepted > 600, tally.summary()
    # Not all files that are accepted are undamaged.
    assert sum(tally.kinds.values()) - tally.kinds["nothing"] > 60


def test_both_readers_accept_the_same_controller_files_and_mean_the_same_controllers() -> None:
    tally = controller_grammar.run(1500)
    assert tally.failures == []
    assert tally.accepted > 300, tally.summary()


def test_a_controller_file_with_zeros_is_the_one_that_certificates_hold() -> None:
    """Else a certificate would be about another controller than the file that it was made from."""
    agent = {"name": "1", "shared": 0, "private": 0, "shared_update": {}, "private_update": {}}
    document = {"format": "mcexact-controller/1", "system": "", "time": "discrete"}
    digests = {
        controllers.read_controller_file(
            json.dumps({**document, "agents": [{**agent, "input": used}]}).encode(),
            reading.Limits(),
        )
        for used in ({}, {"outputs": {"1": [[0, 0]]}}, {"outputs": {}, "reference": [[0]]})
    }
    assert len(digests) == 1


def test_the_tokens_have_no_repetitions() -> None:
    for tokens in (NAMES, NASTY, TEXTS):
        assert len(tokens) == len(set(tokens))
    assert set(GOOD_NUMBERS) < set(NASTY)


def lenient_fields(value: Any, place: str, *names: str, optional: tuple[str, ...] = ()) -> Any:
    """The checker's ``fields``, but a null is as good as a key left out."""
    if isinstance(value, Mapping):
        value = {key: part for key, part in value.items() if part is not None or key in names}
    return reading.fields(value, place, *names, optional=optional)


def hidden(value: Any, place: str, longest: int, allowed: str = "") -> str:
    """The checker's ``printable``, but any string will do."""
    return reading.string(value, place)


SIGNED = re.compile(rational._NUMBER.pattern.replace("-?", "[+-]?", 1), re.ASCII)
LOOSENED = [
    ("nulls are keys left out", checker, "fields", lenient_fields, 2),
    ("the rest of a file is ignored", checker, "_check_unused", lambda *_: None, 0),
    ("feedthrough is ignored", checker, "_feedthrough", lambda *_: None, 0),
    ("names may be hidden", checker, "printable", hidden, 0),
    ("a number may be as long as it likes", checker, "too_long", lambda *_: False, 3),
    ("names may be numbers", system_file, "expect_name", lambda value, where: value, 17),
    ("long numbers may be texts", system_file, "require_short_numbers", lambda *_: None, 0),
    ("sparse matrices may be longer", entries, "LONGEST_SIDE", 2**24, 1),
    ("feedthrough is ignored here", system_file, "_read_feedthrough", lambda *_: None, 0),
    ("a number may have a plus sign", rational, "_NUMBER", SIGNED, 5),
]
"""What is loosened, by what, and the seed of the first files that show it."""


@pytest.mark.parametrize(("what", "module", "name", "loose", "first"), LOOSENED)
def test_a_reader_that_is_loosened_is_found_out(
    what: str, module: Any, name: str, loose: Any, first: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, name, loose)
    found = Tally()
    for seed in (*range(first, 25), *range(first)):
        found = run(200, seed)
        if found.failures:
            return
    raise AssertionError(found.summary())
