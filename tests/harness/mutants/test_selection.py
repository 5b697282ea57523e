"""Samples of changes are the same in every run."""

from __future__ import annotations

from pathlib import Path

from tests.assurance.mutants.selection import digest, drawn, is_current

CHANGES = [(operator, k) for operator in ("DeleteStatement", "AddNot") for k in range(20)]


def test_a_sample_depends_on_the_file_and_not_on_the_order_of_the_changes() -> None:
    some = drawn("steps", CHANGES, 7)
    assert len(some) == 7 and some <= {*CHANGES}
    assert drawn("steps", CHANGES[::-1], 7) == some != drawn("loops", CHANGES, 7)


def test_no_number_and_a_large_one_mean_all_changes() -> None:
    assert drawn("steps", CHANGES) == drawn("steps", CHANGES, 40) == {*CHANGES}


def test_what_some_tests_run_is_not_taken_for_what_all_run(tmp_path: Path) -> None:
    (tmp_path / "mcexact" / "checker").mkdir(parents=True)
    target = tmp_path / "selection.json"
    assert not is_current(target, tmp_path)
    target.write_text(f'{{"of": "{digest(tmp_path)}", "tests": ["test_steps.py"]}}')
    assert is_current(target, tmp_path, ["test_steps.py"])
    assert not is_current(target, tmp_path)
    (tmp_path / "mcexact" / "checker" / "steps.py").write_text("changed = True")
    assert not is_current(target, tmp_path, ["test_steps.py"])
