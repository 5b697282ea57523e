"""The checker's rules about modes, structure, one channel and set-points, as they were recorded."""

from __future__ import annotations

import pytest

from tests.checker.recorded import compare, keys


@pytest.mark.parametrize("key", keys("analysis"))
def test_a_rule_answers_as_it_did(key: str) -> None:
    compare(key)
