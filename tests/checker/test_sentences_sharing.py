"""The checker's rules about what agents have to share, as they were recorded."""

from __future__ import annotations

import pytest

from tests.checker.recorded import compare, keys


@pytest.mark.parametrize("key", keys("sharing"))
def test_a_rule_answers_as_it_did(key: str) -> None:
    compare(key)
