"""The fixtures that pytest finds by the entry point, and the assertion behind one of them."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import mcexact
from mcexact import testing
from mcexact.model import gallery

HEAVY = ("numpy", "flint", "hypothesis", "sympy", "scipy", "networkx")
PLANT = gallery.load("hidden-triple-mode")

MODULE = """
from mcexact import fixed_spectrum

def test_accepted(assert_valid, gallery_plant):
    if gallery_plant.n < 4:
        assert assert_valid(fixed_spectrum(gallery_plant), gallery_plant)

def test_refused(assert_valid, gallery_plant):
    assert_valid(fixed_spectrum(gallery_plant), gallery_plant.with_neighbors({}))
"""


def test_the_entry_point_names_the_file_of_the_fixtures() -> None:
    text = (Path(mcexact.__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    assert tomllib.loads(text)["project"]["entry-points"]["pytest11"] == {
        "mcexact": "mcexact.testing.plugin"
    }


def test_a_start_of_pytest_loads_nothing_heavy() -> None:
    loaded = f"import sys; print([name for name in {HEAVY!r} if name in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", f"import mcexact.testing.plugin; {loaded}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == "[]\n"


def test_a_module_of_a_user_runs_with_the_fixtures(tmp_path: Path) -> None:
    (tmp_path / "test_mine.py").write_text(MODULE, encoding="utf-8")
    call = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:mcexact"]
    done = subprocess.run(
        [*call, "-p", "mcexact.testing.plugin", "-k", "unimodular", "test_mine.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert "test_refused[" in done.stdout and "NOT ABOUT system" in done.stdout, done.stdout
    assert "FAILED test_mine.py::test_accepted" not in done.stdout


def test_what_is_valid_gives_the_statement_and_all_else_fails() -> None:
    found = mcexact.fixed_spectrum(PLANT)
    assert testing.assert_valid(found, PLANT) == mcexact.check(found).statement
    with pytest.raises(AssertionError, match=r"^NOT ABOUT "):
        testing.assert_valid(found, expect={"kind": "completeness", "claim": {}})
