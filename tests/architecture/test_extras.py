"""What an extra installs is imported where it is used, and a library that is missing is named."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.architecture.test_imports import MODULES, PACKAGE, ROOT, tree_of

EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
    "optional-dependencies"
]
FOR_USERS = ("plot", "control", "cluster", "pandas", "yaml")
MODULE_OF = {"pyyaml": "yaml"}
EXTRA_OF = {
    MODULE_OF.get(library, library): extra
    for extra in FOR_USERS
    for library in (re.split(r"[\[>]", each)[0] for each in EXTRAS[extra])
} | {"distributed": "cluster"}


def imported(node: ast.AST) -> list[str]:
    """The libraries that a statement imports."""
    if isinstance(node, ast.Import):
        return [alias.name.split(".")[0] for alias in node.names]
    if isinstance(node, ast.ImportFrom) and node.level == 0:
        return [(node.module or "").split(".")[0]]
    return []


def named(tree: ast.AST, extra: str = "") -> Iterator[tuple[str, str, int]]:
    """The imports of a module, with the extra that a block around them names, and the line."""
    for node in ast.iter_child_nodes(tree):
        inside = extra
        if isinstance(node, ast.With):
            found = re.search(r"MissingExtra\.named\('(\w+)'\)", ast.unparse(node.items[0]))
            inside = found[1] if found else extra
        yield from ((library, inside, getattr(node, "lineno", 0)) for library in imported(node))
        yield from named(node, inside)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_an_import_from_an_extra_names_it(path: Path) -> None:
    for library, extra, line in named(tree_of(path)):
        if library in EXTRA_OF and not drawn_before(path, library):
            assert extra == EXTRA_OF[library], f"{path}:{line}: {library}"


def drawn_before(path: Path, library: str) -> bool:
    """Whether a module draws on figures that canvas.py has made, or saves them."""
    place = str(path.relative_to(PACKAGE))
    drawing = place.startswith("plot/") and place != "plot/canvas.py"
    return library == "matplotlib" and (drawing or place == "report/html.py")


def test_the_page_of_installation_lists_every_extra_of_users() -> None:
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    assert {*FOR_USERS, "docs"} <= set(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE))
    assert EXTRAS.keys() - {*FOR_USERS, "docs"} == {"test", "dev", "mutants", "release"}


def test_the_first_screen_of_the_readme_needs_no_extra(tmp_path: Path) -> None:
    """Both commands and the Python of README.md, where no extra can be imported."""
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({sorted(EXTRA_OF)!r}))\n"
        "from pathlib import Path\n"
        "from tests.documentation.pages import run\n"
        f"assert run(Path({str(ROOT / 'README.md')!r}), Path({str(tmp_path)!r})) == 19\n"
        "from mcexact.crosschecks.demonstration import demonstration\n"
        "assert demonstration().rank == 20\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
