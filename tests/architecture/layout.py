"""The modules of the package, as ``layout.toml`` lists them, held against its files.

    python -m tests.architecture.layout

A module is what one person changes at once: a topic with 80 to 1,000 lines of code.  What is
judged: that the list and the files agree, the sizes, that imports make no circle (those inside
functions and those of types count), that folders import only folders before them in ``order``, and
what the command line loads when it starts.  Prints the figures, then what is wrong; with ``--tree``
it prints the list as ARCHITECTURE.md has it.
"""

from __future__ import annotations

import ast
import io
import sys
import tokenize
import tomllib
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import networkx as nx

ROOT = Path(__file__).parents[2]
PACKAGE = "mcexact"
PLAN = Path(__file__).with_name("layout.toml")
CORE = f"{PACKAGE}.checker.core"
"""What imports nothing else, not even of its own folder."""
LEAST, MOST = 80, 1000
"""The lines of code of a module."""
TOP, INSIDE, TYPES = "top", "inside", "types"
"""Where an import stands: in the module, in a function, or for the type checker alone."""
HEAVY = {
    "control",
    "flint",
    "hypothesis",
    "jinja2",
    "matplotlib",
    "networkx",
    "numpy",
    "scipy",
    "sympy",
}
"""Libraries that no program loads only to say what it is able to do."""
THREADED = {"control", "matplotlib", "numpy", "scipy"}
"""Libraries that start threads.  A process with threads cannot be forked: what waits for a child
process and loads one of them pays for a new interpreter, and for all imports once more."""
STARTS = {
    f"{PACKAGE}.cli": HEAVY,  # the list of commands, and every error of usage before a command
    f"{PACKAGE}.testing.plugin": HEAVY,
    f"{PACKAGE}.cli.check": HEAVY,  # the checker needs the standard library alone
    **{
        f"{PACKAGE}.cli.{name}": THREADED
        for name in ("allocate", "analyze", "certify", "convert", "design", "reproduce", "simulate")
    },
    f"{PACKAGE}.cli.decisions": THREADED,  # numpy takes as long as the analysis of a small system
}
"""What no module may load before it is asked for, by the module that is loaded."""
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
BLANK = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}


@dataclass(frozen=True)
class Import:
    """A name that a module takes from another; ``name`` is None if it takes the module itself."""

    importer: str
    home: str
    name: str | None
    local: str
    where: str


def docstring_lines(tree: ast.Module) -> set[int]:
    """The lines on which the docstrings of a module stand."""
    first = [n.body[0] for n in ast.walk(tree) if isinstance(n, DOCUMENTED) and n.body]
    return {
        line
        for node in first
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
        for line in range(node.lineno, (node.end_lineno or 0) + 1)
    }


def code_lines(text: str, tree: ast.Module) -> int:
    """How many lines of a module are neither blank nor comment nor docstring."""
    lines: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in BLANK:
            lines.update(range(token.start[0], token.end[0] + 1))
    return len(lines - docstring_lines(tree))


def statements_by_place(node: ast.AST, where: str = TOP) -> Iterator[tuple[ast.stmt, str]]:
    """The import statements below a node, each with where it stands."""
    for child in ast.iter_child_nodes(node):
        now = where
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            now = TYPES if child in node.body else where
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)) and where == TOP:
            now = INSIDE
        if isinstance(child, (ast.Import, ast.ImportFrom)):
            yield child, now
        else:
            yield from statements_by_place(child, now)


@dataclass(frozen=True)
class Module:
    """A file of the package."""

    name: str
    path: Path

    @cached_property
    def text(self) -> str:
        return self.path.read_text(encoding="utf-8")

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.text)

    @cached_property
    def size(self) -> int:
        return code_lines(self.text, self.tree)

    @property
    def is_package(self) -> bool:
        return self.path.stem == "__init__"

    def taken(self) -> Iterator[tuple[str, str | None, str, str]]:
        """All that it imports: the module, the name in it, the local name, and where."""
        package = self.name if self.is_package else self.name.rpartition(".")[0]
        for node, where in statements_by_place(self.tree):
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield alias.name, None, alias.asname or alias.name, where
            elif isinstance(node, ast.ImportFrom):
                upper = package.split(".")
                upper = upper[: len(upper) - node.level + 1] if node.level else []
                home = ".".join([*upper, *([node.module] if node.module else [])])
                for alias in node.names:
                    yield home, alias.name, alias.asname or alias.name, where


class Package:
    """All files of the package, with their imports."""

    def __init__(self, root: Path = ROOT) -> None:
        self.modules: dict[str, Module] = {}
        for path in sorted((root / PACKAGE).rglob("*.py")):
            name = ".".join(path.relative_to(root).with_suffix("").parts)
            name = name.removesuffix(".__init__")
            self.modules[name] = Module(name, path)
        self.outside: dict[str, set[str]] = defaultdict(set)  # libraries, at the top
        self.imports = [each for module in self.modules.values() for each in self._imports(module)]
        self._handed_on = {
            (each.importer, each.local): (each.home, each.name)
            for each in self.imports
            if self.modules[each.importer].is_package and each.where != INSIDE
        }

    def _imports(self, module: Module) -> Iterator[Import]:
        for home, name, local, where in module.taken():
            if f"{home}.{name}" in self.modules and not self._defines(home, name):
                yield Import(module.name, f"{home}.{name}", None, local, where)
            elif home in self.modules:
                yield Import(module.name, home, name, local, where)
            elif where == TOP:
                self.outside[module.name].add(home.split(".")[0])

    def _defines(self, home: str, name: str | None) -> bool:
        """Whether a package hands on a name that one of its modules has, too."""
        return any(
            local == name and f"{source}.{found}" not in self.modules
            for source, found, local, where in self.modules[home].taken()
            if where == TOP
        )

    def origin(self, each: Import) -> str:
        """The module that defines what is imported, perhaps through packages that hand it on."""
        home, name = each.home, each.name
        while name is not None and (home, name) in self._handed_on:
            home, name = self._handed_on[home, name]
        return home


class Layout:
    """The modules that the list has."""

    def __init__(self, package: Package, path: Path = PLAN) -> None:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
        self.package = package
        self.order: list[str] = data["order"]
        self.exceptions: dict[str, str] = data["exceptions"]
        self.purposes: dict[str, str] = data["modules"]
        listed = {f"{PACKAGE}.{name}" for name in self.purposes}
        files = {name for name in package.modules if not self._has_no_topic(name)}
        self.problems = [f"{name} is not in {PLAN.name}" for name in sorted(files - listed)]
        self.problems += [f"there is no {name}" for name in sorted(listed - package.modules.keys())]
        self.problems += [
            f"{name}: its purpose is longer than a line"
            for name, purpose in self.purposes.items()
            if len(purpose) > 92
        ]

    def _has_no_topic(self, name: str) -> bool:
        """Whether a file only starts something, or hands names on."""
        begins = name.endswith("__main__") or self.package.modules[name].is_package
        return begins and name.removeprefix(f"{PACKAGE}.") not in self.purposes

    def graph(self, *places: str) -> nx.DiGraph:
        """The files, with an edge for imports that stand at these places."""
        graph = nx.DiGraph()
        for each in self.package.imports:
            home = self.package.origin(each)
            if each.where in places and home != each.importer:
                graph.add_edge(each.importer, home)
        return graph

    @cached_property
    def sizes(self) -> dict[str, int]:
        """The lines of code of each module."""
        known = self.package.modules
        return {
            name: known[f"{PACKAGE}.{name}"].size
            for name in self.purposes
            if f"{PACKAGE}.{name}" in known
        }

    def circles(self) -> list[list[str]]:
        """The modules that import each other, directly or not."""
        parts = nx.strongly_connected_components(self.graph(TOP, INSIDE, TYPES))
        return [sorted(part) for part in parts if len(part) > 1]

    def backwards(self) -> list[tuple[str, str]]:
        """Imports against the order of the folders."""
        place = {name: k for k, name in enumerate(self.order)}
        return [
            (one, other)
            for one, other in sorted(self.graph(TOP, INSIDE, TYPES).edges)
            if not self._may(folder_of(one), folder_of(other), place)
            or (one.startswith(CORE) and not other.startswith(CORE))
        ]

    @staticmethod
    def _may(one: str, other: str, place: dict[str, int]) -> bool:
        if one in {"", "__main__", other} or other == "":
            return True
        if one == "checker" or (other == "checker" and one not in {"answer", "cli"}):
            return False
        return place.get(other, len(place)) < place.get(one, -1)

    def loaded(self, start: str) -> set[str]:
        """The libraries that a module loads, with those of the packages that it stands in."""
        graph = self.graph(TOP)
        parts = start.split(".")
        first = {".".join(parts[: k + 1]) for k in range(len(parts))} & self.package.modules.keys()
        files = first.union(*(nx.descendants(graph, one) for one in first & graph.nodes))
        return {library for file in files for library in self.package.outside[file]}

    def wrong(self) -> list[str]:
        """What is not as the list and the rule have it."""
        problems = list(self.problems)
        for name, size in self.sizes.items():
            if not LEAST <= size <= MOST and name not in self.exceptions:
                problems.append(f"{PACKAGE}.{name} has {size} lines of code")
        problems += [f"these import each other: {', '.join(part)}" for part in self.circles()]
        problems += [f"{one} imports {other}, against the order" for one, other in self.backwards()]
        for start, forbidden in STARTS.items():
            if libraries := self.loaded(start) & forbidden:
                problems.append(f"the start of {start} loads {', '.join(sorted(libraries))}")
        return problems

    def figures(self) -> Iterator[str]:
        """How many modules there are, how large, and how many names cross their borders."""
        names = {
            (each.importer, self.package.origin(each), each.name)
            for each in self.package.imports
            if self.package.origin(each) != each.importer
        }
        sizes = sorted(self.sizes.values())
        inside = sum(each.where == INSIDE for each in self.package.imports)
        edges = self.graph(TOP, INSIDE, TYPES).number_of_edges()
        median = sizes[len(sizes) // 2]
        yield f"modules: {len(sizes)}, with {edges} imports"
        yield f"circles between files: {len(self.circles())}"
        yield f"names that cross a border: {len(names)}"
        yield f"imports of the package inside functions: {inside}"
        yield f"lines of code of a module: {sizes[0]} to {sizes[-1]}, median {median}"

    def tree(self) -> str:
        """The list, folder by folder."""
        lines, last = [], ""
        for name, purpose in self.purposes.items():
            folder = name.split(".")[0] if "." in name else ""
            if folder != last:
                lines.append(f"    {folder}/")
            rest = name.removeprefix(f"{folder}.").replace(".", "/") if folder else name
            lines.append(f"      {rest:<24} {purpose}" if folder else f"    {rest:<26} {purpose}")
            last = folder
        return "\n".join(lines)


def folder_of(module: str) -> str:
    """The folder or file directly below the package; nothing for the package itself."""
    return [*module.split("."), ""][1]


def main() -> None:
    layout = Layout(Package())
    if "--tree" in sys.argv:
        sys.exit(print(layout.tree()))
    print(*layout.figures(), sep="\n")
    wrong = layout.wrong()
    print(*(f"WRONG {each}" for each in wrong), sep="\n")
    sys.exit(f"{len(wrong)} things are wrong" if wrong else None)


if __name__ == "__main__":
    main()
