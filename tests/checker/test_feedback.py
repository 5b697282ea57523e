"""The constructions ``dual`` and ``integrators``, which take nothing but the system."""

from __future__ import annotations

import pytest

from tests.checker.handmade import FREE, changed, checked


@pytest.mark.parametrize("construction", ["dual", "integrators"])
def test_a_construction_has_no_keys_that_it_does_not_read(construction: str) -> None:
    step = {"construction": construction}
    for name, value in (("gains", []), ("channel", "1"), ("note", None)):
        verdict = checked(changed(FREE, ("subject", [{**step, name: value}])))
        assert verdict.verdict == "MALFORMED", verdict.line()
