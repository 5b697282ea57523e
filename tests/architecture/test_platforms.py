"""No module needs what macOS or Windows lacks in order to be imported, nor to analyze and check.

Neither system runs here: what they lack is taken away from Linux.  `docs/install.md` lists what is
known of them.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
MODULES = sorted((ROOT / "mcexact").rglob("*.py"))
# Modules of the standard library, and names of `os` and `signal`, that Windows has not.
MISSING = {"fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty"}
NAMES = {
    "os": ("fork", "setsid", "killpg", "getuid", "mkfifo", "O_NONBLOCK", "sched_getaffinity"),
    "signal": ("setitimer", "ITIMER_REAL", "SIGALRM", "SIGKILL", "SIGPIPE", "SIGBUS", "SIGTRAP"),
}


def outside_functions(tree: ast.AST) -> list[Any]:
    """The nodes that run when a module is imported."""
    found, waiting = [], [tree]
    while waiting:
        node = waiting.pop()
        found.append(node)
        inside = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
        waiting += [each for each in ast.iter_child_nodes(node) if not isinstance(each, inside)]
    return found


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_imports_nothing_that_a_platform_lacks(path: Path) -> None:
    for node in outside_functions(ast.parse(path.read_text(encoding="utf-8"))):
        named = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        named += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        assert not MISSING & {name.partition(".")[0] for name in named}, node.lineno
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert node.attr not in NAMES.get(node.value.id, ()), node.lineno


WITHOUT = f"""
import importlib, importlib.abc, multiprocessing, os, pkgutil, signal, subprocess, sys
import asyncio, ctypes, socket, tempfile
import click, flint, hypothesis, jinja2, lazy_loader, networkx, numpy, scipy, sympy, threadpoolctl
import scipy.sparse.csgraph, scipy.sparse.linalg, scipy.optimize, scipy.signal, pytest

class Missing(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {MISSING!r}:
            raise ModuleNotFoundError(name, name=name)

sys.meta_path.insert(0, Missing())
for name in {MISSING!r}:
    sys.modules.pop(name, None)
for module, names in {NAMES!r}.items():
    for name in {{*names}} - {{"SIGKILL"}}:  # with which the library for Linux ends processes
        if hasattr(sys.modules[module], name):
            delattr(sys.modules[module], name)
"""
EVERYTHING = """
import mcexact
for each in pkgutil.walk_packages(mcexact.__path__, "mcexact."):
    if not each.name.endswith("__main__"):
        importlib.import_module(each.name)
"""
USE = """
from mcexact import processes
from mcexact.cli import main
from mcexact.cli.running import MemoryLimit
from mcexact.errors import UsageError
processes.may_fork = lambda: False

def called(*arguments):
    try:
        main(list(arguments))
    except SystemExit as ended:
        return ended.code

plant = "gallery:liu2020-3ch-no-communication"
assert called("analyze", plant, "--certificates", "evidence", "--timeout", "100") == 0
assert called("check", "evidence") == 0
assert called("check", "evidence", "--timeout", "9") == 2
try:
    MemoryLimit(500, [])
except UsageError as refused:
    print(refused)
assert called("sweep", "--draws", "2", "--states", "3", "-o", "answers.jsonl") == 0
"""


def outcome(code: str, folder: Path) -> str:
    """What a new interpreter says of some code, which has to end without an error."""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


@pytest.mark.slow
def test_every_module_can_be_imported_without_them(tmp_path: Path) -> None:
    outcome(WITHOUT + EVERYTHING, tmp_path)


@pytest.mark.slow
def test_plants_are_analyzed_checked_and_swept_without_them(tmp_path: Path) -> None:
    """Limits that need them are refused in words, and the rest works."""
    said = outcome(WITHOUT + USE, tmp_path)
    assert "leave out --max-memory" in said and "no limits on time and memory" in said


def test_what_a_platform_lacks_is_found_where_a_module_needs_it() -> None:
    nodes = outside_functions(ast.parse("import fcntl\ndef f():\n    import resource\n"))
    assert [node.names[0].name for node in nodes if isinstance(node, ast.Import)] == ["fcntl"]
