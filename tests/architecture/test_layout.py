"""The modules are those of the plan: deep, without circles, in the order of the folders."""

from pathlib import Path

import pytest

from tests.architecture.layout import ROOT, Layout, Package

PLAN = """
order = ["exact", "model"]
exceptions = {"exact.second" = "small for the sake of the test"}
[modules]
"exact.first" = "One topic."
"exact.second" = "Another topic."
"model.third" = "A topic of a later folder."
"""
BODY = "".join(f"name_{k} = {k}\n" for k in range(90))
CLEAN = {
    "exact/first.py": BODY,
    "exact/second.py": "from mcexact.exact.first import name_1\n",
    "model/third.py": "from mcexact.exact.second import name_1\n" + BODY,
}


def wrong(folder: Path, files: dict[str, str], plan: str) -> str:
    """What is wrong with a package of these files."""
    for name, text in files.items():
        path = folder / "mcexact" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    path = folder / "layout.toml"
    path.write_text(plan, encoding="utf-8")
    return "\n".join(Layout(Package(folder), path).wrong())


def judged(folder: Path, changed: dict[str, str], plan: str = PLAN) -> str:
    """What is wrong with the package as planned, with some files in place of others."""
    packages = dict.fromkeys(("__init__.py", "exact/__init__.py", "model/__init__.py"), "")
    return wrong(folder, {**packages, **CLEAN, **changed}, plan)


def test_the_package_is_as_the_plan_has_it() -> None:
    assert Layout(Package()).wrong() == []


def test_a_package_as_planned_is_accepted(tmp_path: Path) -> None:
    assert judged(tmp_path, {}) == ""


@pytest.mark.parametrize(
    ("files", "said"),
    [
        ({"exact/new.py": BODY}, "mcexact.exact.new is not in layout.toml"),
        ({"exact/first.py": "name_1 = 1\n"}, "mcexact.exact.first has 1 lines of code"),
        (
            {"exact/first.py": BODY * 12},
            "mcexact.exact.first has 1080 lines of code",
        ),
        (
            {"exact/first.py": BODY + "def late():\n    from mcexact.exact import second\n"},
            "these import each other: mcexact.exact.first, mcexact.exact.second",
        ),
        (
            {
                "exact/first.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n"
                "    from .second import name_1\n" + BODY
            },
            "these import each other: mcexact.exact.first, mcexact.exact.second",
        ),
        (
            {"exact/first.py": BODY + "def late():\n    from ..model.third import name_2\n"},
            "mcexact.exact.first imports mcexact.model.third, against the order",
        ),
    ],
)
def test_what_the_plan_does_not_have_is_named(tmp_path: Path, files, said) -> None:
    assert said in judged(tmp_path, files)


def test_a_module_that_is_not_there_is_named(tmp_path: Path) -> None:
    plan = PLAN + '"model.fourth" = "A topic that nobody has written."\n'
    assert "there is no mcexact.model.fourth" in judged(tmp_path, {}, plan)


def test_a_heavy_library_at_the_start_of_the_command_line_is_named(tmp_path: Path) -> None:
    files = {"cli/__init__.py": "from ..exact.first import name_1\n"}
    plan = PLAN.replace('"model"]', '"model", "cli"]')
    assert judged(tmp_path, files, plan) == ""
    files["exact/first.py"] = "import numpy\n" + BODY
    assert "the start of mcexact.cli loads numpy" in judged(tmp_path, files, plan)


def test_the_page_on_the_architecture_has_the_list() -> None:
    page = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    assert Layout(Package()).tree() in page
