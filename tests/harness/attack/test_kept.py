"""What the checker accepts among the documents that its tests keep is true."""

from __future__ import annotations

import pytest

from tests.assurance.attack.campaign import judged, parsed
from tests.checker.kept import by_group
from tests.oracle.certificates.judge import TRUE, UNDECIDED
from tests.oracle.certificates.statement import statement
from tests.oracle.certificates.words import sha256

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
