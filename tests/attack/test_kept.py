"""What the checker accepts among the documents that its tests keep is true."""

from __future__ import annotations

import pytest

from tests.attack.campaign import judged, parsed
from tests.attack.oracle.judge import TRUE, UNDECIDED
from tests.attack.oracle.statement import statement
from tests.attack.oracle.words import sha256
from tests.checker.kept import by_group

ACCEPTED = {
    name: found
    for name, cases in by_group().items()
    if (found := [case for case in cases if case["answer"].startswith("VALID ")])
}


@pytest.mark.parametrize("group", sorted(ACCEPTED))
def test_what_is_accepted_is_true_and_is_what_is_stated(group: str) -> None:
    for case in ACCEPTED[group]:
        document = parsed(case["document"])
        verdict, why = judged(document)
        assert verdict in (TRUE, UNDECIDED), why
        assert case["answer"] == f"VALID {sha256(statement(document))}"
