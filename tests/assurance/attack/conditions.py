"""The checker with every condition as a gate that can be left open: a copy, made from its sources.

A condition is a ``require``, each part of one that joins several by ``and``, and each ``if`` that
does nothing but refuse.  The copy is the checker itself as long as :attr:`Gates.open` is None.
"""

from __future__ import annotations

import ast
import importlib
import importlib.abc
import importlib.machinery
import importlib.util
import sys
from dataclasses import dataclass, field
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

import mcexact

SOURCES = Path(mcexact.__file__).parent / "checker"
PACKAGE = "weakened_checker"
REQUIRING = {"require", "require_asked"}
"""The functions that stop unless their first argument holds."""
REFUSALS = ("malformed", "Refused", "NotAUnit")


@dataclass(frozen=True)
class Site:
    """A condition: its file, the function that it is in, and its text."""

    file: str
    function: str
    line: int
    text: str

    @property
    def key(self) -> str:
        """What it is called wherever it stands in the file."""
        return f"{self.file}: {self.function}: {self.text}"


@dataclass
class Gates:
    """Every condition, the one that is left out, and the one that refused last."""

    sites: list[Site] = field(default_factory=list)
    open: int | None = None
    last: int | None = None

    def passes(self, site: int, condition: Any) -> bool:
        """What a condition is, unless it is left out."""
        if condition or site == self.open:
            return True
        self.last = site
        return False

    def refuses(self, site: int, condition: Any) -> bool:
        """Whether an ``if`` refuses, unless it is left out."""
        if not condition or site == self.open:
            return False
        self.last = site
        return True


GATES = Gates()


class _Gated(ast.NodeTransformer):
    """Conditions become calls of the gates."""

    def __init__(self, file: str) -> None:
        self.file, self.function = file, ""
        self.named: set[str] = set()

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        """Remember in which function a condition is, and which names stand for conditions."""
        before = self.function, self.named
        self.function, self.named = node.name, _named_conditions(node)
        self.generic_visit(node)
        self.function, self.named = before
        return node

    def visit_Assign(self, node: ast.Assign) -> ast.AST:
        """``name = condition``, where ``require(name, …)`` follows."""
        self.generic_visit(node)
        target = node.targets[0]
        if isinstance(target, ast.Name) and target.id in self.named:
            node.value = self._gates(node.value)
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """``require(condition, …)``."""
        self.generic_visit(node)
        if _is_require(node):
            node.args[0] = self._gates(node.args[0])
        return node

    def visit_If(self, node: ast.If) -> ast.AST:
        """``if condition: malformed(…)``."""
        self.generic_visit(node)
        if self.function in REQUIRING:
            return node  # its callers are the conditions
        first = node.body[0]
        value = first.exc if isinstance(first, ast.Raise) else getattr(first, "value", None)
        if len(node.body) == 1 and isinstance(value, ast.Call | ast.Name):
            callee = value.func if isinstance(value, ast.Call) else value
            if getattr(callee, "attr", getattr(callee, "id", "")) in REFUSALS:
                node.test = self._gate("refuses", node.test, node.test)
        return node

    def _gates(self, node: ast.expr) -> ast.expr:
        """One gate, or one for each part of several conditions."""
        if isinstance(node, ast.Name) and node.id in self.named:
            return node  # its parts are gates already
        if isinstance(node, ast.BoolOp) and isinstance(node.op, ast.And):
            node.values = [self._gates(value) for value in node.values]
            return node
        return self._gate("passes", node, node)

    def _gate(self, method: str, node: ast.expr, shown: ast.expr) -> ast.expr:
        GATES.sites.append(Site(self.file, self.function, node.lineno, ast.unparse(shown)))
        call = ast.parse(f"GATES_.{method}({len(GATES.sites) - 1}, 0)", mode="eval").body
        assert isinstance(call, ast.Call)
        call.args[1] = node
        return ast.copy_location(call, node)


def _is_require(node: ast.AST) -> bool:
    if not isinstance(node, ast.Call) or not node.args:
        return False
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    return name in REQUIRING


def _named_conditions(node: ast.FunctionDef) -> set[str]:
    """Names that a function assigns conditions to, and then requires."""
    required = {
        call.args[0].id
        for call in ast.walk(node)
        if _is_require(call) and isinstance(call, ast.Call) and isinstance(call.args[0], ast.Name)
    }
    assigned = {
        statement.targets[0].id
        for statement in ast.walk(node)
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name)
    }
    return required & assigned


class _Loader(importlib.machinery.SourceFileLoader):
    """Source files, transformed; nothing is cached."""

    def get_code(self, fullname: str) -> CodeType:
        """Compile the transformed tree."""
        path = self.get_filename(fullname)
        tree = _Gated(Path(path).name).visit(ast.parse(self.get_data(path), path))
        return compile(ast.fix_missing_locations(tree), path, "exec")

    def exec_module(self, module: ModuleType) -> None:
        """Run it with the gates at hand."""
        module.__dict__["GATES_"] = GATES
        super().exec_module(module)


class _Finder(importlib.abc.MetaPathFinder):
    """Finds the copy's modules in the folder of the checker."""

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> Any:
        """The module of a file of the same name."""
        head, _, stem = fullname.partition(".")
        if head != PACKAGE:
            return None
        file = SOURCES.joinpath(*stem.split(".")).with_suffix(".py") if stem else SOURCES
        folder = file if file.is_dir() else file.with_suffix("")
        search = [str(folder)] if folder.is_dir() else None
        file = folder / "__init__.py" if search else file
        return importlib.util.spec_from_file_location(
            fullname, file, loader=_Loader(fullname, str(file)), submodule_search_locations=search
        )


def weakened_checker() -> ModuleType:
    """The copy's module of kinds, which imports every rule and every construction."""
    if PACKAGE not in sys.modules:
        sys.meta_path.insert(0, _Finder())
    return importlib.import_module(f"{PACKAGE}.kinds")


def require_one_gate(document: Any) -> None:
    """Assert that a document is refused by one condition alone: without this one it is VALID."""
    check = weakened_checker().check_document
    GATES.open = None
    assert check(document).verdict in ("INVALID", "MALFORMED")
    GATES.open = GATES.last
    found = check(document)
    GATES.open = None
    assert found.verdict == "VALID", found.line()
