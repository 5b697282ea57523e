"""Each kind is checked in one module, and the tests of a module are found by what they import."""

from __future__ import annotations

from mcexact.checker.kinds import KINDS
from tests.assurance.mutants import topics

MODULES = sorted(topics.sources())


def test_each_kind_belongs_to_the_module_that_checks_it() -> None:
    found = {kind: stem for stem in MODULES for kind in topics.kinds(stem)}
    assert found == {k: rule.check.__module__.rpartition(".")[2] for k, rule in KINDS.items()}


def test_tests_belong_to_the_module_of_their_kind() -> None:
    assert {"test_box_fixed.py", "test_parametric_box_fixed.py"} <= topics.tests("boxes")
    assert "test_box_fixed.py" not in topics.tests("modes")


def test_tests_belong_to_the_module_from_which_they_import_most() -> None:
    assert "test_packed_rows.py" in topics.tests("arithmetic")
    assert "test_sparse_step.py" in topics.tests("evidence")
    assert "test_packed_rows.py" not in topics.tests("budget")
