"""The recorded table of sentences is about VALID certificates, and about every rule."""

from __future__ import annotations

import json

import pytest

from mcexact.checker.kinds import KINDS, check_document
from tests.checker.recorded import REFUSED, World, recorded_rules, statement_mark, table, worlds

WORLDS = worlds()


@pytest.mark.parametrize("world", WORLDS.values(), ids=list(WORLDS))
def test_every_certificate_of_the_corpus_is_valid(world: World) -> None:
    for k in range(len(world.certificates)):
        verdict = check_document(json.loads(json.dumps(world.document(k))))
        assert verdict.verdict == "VALID", (world.file(k), verdict.line())


@pytest.mark.parametrize("world", WORLDS.values(), ids=list(WORLDS))
def test_the_premises_of_the_corpus_have_the_recorded_paths_and_statements(world: World) -> None:
    for each, premise in zip(world.certificates, world.premises, strict=True):
        path = None if each["path"] is None else tuple(each["path"])
        assert premise.path == path, premise.file
        assert statement_mark(premise) == each["statement"], premise.statement


def test_the_table_is_about_every_rule_and_the_corpus_has_every_kind() -> None:
    assert list(table()) == list(recorded_rules())
    kinds = {each["kind"] for world in WORLDS.values() for each in world.certificates}
    # of these no sentence speaks about plants without parameters
    others = {"exceptional_gains"}
    others |= {kind for kind in KINDS if kind.startswith("parametric_")}
    assert kinds | others == set(KINDS)


def test_every_rule_is_implied_somewhere() -> None:
    for key, row in table().items():
        told = set(row.answers.values())
        assert any(not each.startswith(("INVALID", REFUSED)) for each in told), key
