"""Types are shipped: a user's program is checked with them, and does what they say."""

import tomllib
from pathlib import Path

import mcexact
from tests.architecture.typed_user import used

ROOT = Path(mcexact.__file__).parents[1]


def test_the_package_says_that_it_has_types() -> None:
    assert (ROOT / "mcexact" / "py.typed").exists()


def test_the_program_of_a_user_is_checked_as_strictly_as_the_package() -> None:
    configured = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    found = configured["tool"]["mypy"]
    assert found["strict"] and found["files"] == ["mcexact", "tests"]
    changed = {str(each.pop("module")): each for each in found["overrides"]}
    for option, relaxed in changed["tests.*"].items():
        if option != "disable_error_code":
            assert changed["tests.architecture.typed_user"][option] is not relaxed


def test_the_program_of_a_user_runs() -> None:
    assert "Re λ < -1/2" in used() and "3.0 Drawn systems" in used()
