"""No plant passes for another one where a certificate names its plant by a digest."""

from __future__ import annotations

import json
import random
from collections.abc import Mapping
from typing import Any

import pytest

from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation, Verdict, check_document
from tests.assurance.attack.tries import drawn_batch
from tests.oracle.certificates.judge import FALSE, TRUE, judge
from tests.oracle.certificates.reading import Unspecified
from tests.oracle.certificates.statement import plant_digest, statement

BATCHES = range(0, 200, 20)


def checked(document: Mapping[str, Any], plant: Mapping[str, Any]) -> Verdict:
    """The verdict where a system file holds this plant."""
    file = json.dumps({"format": "mcexact-system/1", **plant}).encode()
    return check_document(document, Expectation().about(file, Limits()))


def has_digest(document: Mapping[str, Any]) -> bool:
    """Whether the plant is in canonical form; that of a changed certificate may not be."""
    try:
        return bool(plant_digest(document))
    except Unspecified:
        return False


def forgeries(rng: random.Random, document: Mapping[str, Any], others: list[Any]) -> list[Any]:
    """Digests in place of the plant, each with a plant beside it."""
    own, plant = plant_digest(document), document["system"]
    k = rng.randrange(len(own))
    spoiled = own[:k] + rng.choice("0123456789abcdef") + own[k + 1 :]
    made = [(own, plant), (spoiled, plant), (own.upper(), plant), (own[:k], plant), ("", plant)]
    for other in others:
        made += [(own, other["system"]), (plant_digest(other), plant)]
        made.append((plant_digest(other), other["system"]))
    return [({**document, "system": name}, beside) for name, beside in made]


@pytest.mark.parametrize("number", BATCHES)
def test_what_is_accepted_is_true_of_the_plant_with_this_digest(number: int) -> None:
    batch = drawn_batch(number)
    rng = random.Random(f"plants by digest {number}")
    others = [*filter(has_digest, [*batch.siblings, *batch.strangers])]
    accepted = 0
    for document, plant in forgeries(rng, batch.original, others):
        verdict = checked(document, plant)
        whole = {**document, "system": plant}
        meant = plant_digest(whole) == document["system"]
        if verdict.verdict == "VALID":
            accepted += 1
            assert meant
            assert judge(whole)[0] != FALSE
            assert verdict.statement == statement(whole)
        assert check_document(document).verdict in ("INCOMPLETE", "MALFORMED")
        assert (verdict.verdict == "VALID") == (meant and check_document(whole).verdict == "VALID")
    assert accepted >= 1 or judge(batch.original)[0] != TRUE
