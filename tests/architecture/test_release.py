"""What is released has the files that it has to have, and names what it runs on."""

from __future__ import annotations

import tomllib
import zipfile
from pathlib import Path

import pytest

import mcexact
from tests.assurance.release import Failed, require_contents, run

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
VERSION = mcexact.__version__


def built(folder: Path, *names: str) -> dict[str, Path]:
    """A wheel with empty files, and a source distribution of nothing."""
    wheel = folder / f"mcexact-{VERSION}-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w") as packed:
        for name in names:
            packed.writestr(name, "")
    source = folder / f"mcexact-{VERSION}.tar.gz"
    source.write_bytes(b"")
    return {wheel.name: wheel, source.name: source}


def test_the_package_has_one_version() -> None:
    assert PROJECT["version"] == VERSION


def test_a_wheel_with_anything_but_the_package_is_refused(tmp_path: Path) -> None:
    files = built(tmp_path, "mcexact/a.py", f"mcexact-{VERSION}.dist-info/METADATA", "tests/a.py")
    with pytest.raises(Failed, match="tests"):
        require_contents(files, VERSION)


def test_a_release_without_its_source_or_of_another_version_is_refused(tmp_path: Path) -> None:
    files = built(tmp_path, "mcexact/a.py")
    with pytest.raises(Failed):
        require_contents(dict([files.popitem()]), VERSION)
    with pytest.raises(Failed):
        require_contents(built(tmp_path, "mcexact/a.py"), VERSION + ".1")


def test_a_step_that_fails_says_what_was_printed() -> None:
    with pytest.raises(Failed, match="No module"):
        run("python3", "-m", "no_module_of_this_name")


def test_the_minor_versions_of_python_are_those_that_are_tested() -> None:
    named = {each.rpartition(" ")[2] for each in PROJECT["classifiers"] if " :: 3." in each}
    service = (ROOT / ".github" / "workflows" / "tests.yml").read_text(encoding="utf-8")
    assert named and all(f'"{each}"' in service for each in named)
    assert PROJECT["requires-python"] == f">={min(named)}"
