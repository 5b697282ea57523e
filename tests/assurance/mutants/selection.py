"""Which tests run which line of the checker, and how long each takes.

    python -m tests.assurance.mutants.selection FILE [TEST…]

runs ``tests/checker``, or these files of it, in the current folder and writes the answer to a JSON
file.  What was found holds as long as the checker and these tests are the same.
"""

from __future__ import annotations

import hashlib
import json
import random
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import coverage
import pytest

SKIPPED = ("test_size.py", "test_proofs.py")
"""Tests of the text of the checker; each change of the code could make them fail for nothing."""


class Watch:
    """A plugin for pytest that names the test that runs, and takes the time of the processor."""

    def __init__(self, measured: coverage.Coverage) -> None:
        self.measured = measured
        self.seconds: dict[str, float] = {}

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Iterator[None]:
        begun = time.process_time()
        self.measured.switch_context(item.nodeid)
        result = yield
        self.measured.switch_context("")
        self.seconds[item.nodeid] = time.process_time() - begun
        return result


def drawn(stem: str, changes: Iterable[tuple[str, int]], count: int = 0) -> set[tuple[str, int]]:
    """So many changes of a file, each an operator and its occurrence; the same ones in every run.

    All of them if ``count`` is 0, or if they are no more.
    """
    known = sorted(changes)
    if not 0 < count < len(known):
        return {*known}
    return {*random.Random(f"mutants of {stem}").sample(known, count)}


def files() -> list[str]:
    """The files of tests that are run."""
    found = sorted(Path("tests/checker").glob("test_*.py"))
    return [str(path) for path in found if path.name not in SKIPPED]


def digest(root: Path) -> str:
    """A digest of the checker and of its tests in a tree, without what is written about them."""
    found = hashlib.sha256()
    for folder in ("mcexact/checker", "tests/checker"):
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and path.suffix not in (".md", ".pyc"):
                found.update(f"{path.relative_to(root)}\n{path.stat().st_size}\n".encode())
                found.update(path.read_bytes())
    return found.hexdigest()


def is_current(target: Path, root: Path, tests: Sequence[str] = ()) -> bool:
    """Whether a file has the answer for the checker and all tests of a tree, or for some files."""
    if not target.exists():
        return False
    known = json.loads(target.read_text(encoding="utf-8"))
    return bool(known.get("of") == digest(root) and known.get("tests") == [*tests])


def main(target: str, *tests: str) -> int:
    """Run the tests, and write down which lines each of them runs."""
    measured = coverage.Coverage(data_file=None, source=["mcexact/checker"], config_file=False)
    watch = Watch(measured)
    measured.start()
    status = pytest.main(["-q", "-p", "no:cacheprovider", *(tests or files())], plugins=[watch])
    measured.stop()
    numbers = {name: k for k, name in enumerate(watch.seconds)}
    data, lines = measured.get_data(), {}
    for path in data.measured_files():
        found = data.contexts_by_lineno(path)
        lines[Path(path).stem] = {
            line: sorted(-1 if not name else numbers[name] for name in names)
            for line, names in found.items()
        }
    seconds = list(watch.seconds.items())
    about = {"of": digest(Path()), "tests": tests}
    text = json.dumps(about | {"seconds": seconds, "lines": lines})
    Path(target).write_text(text, encoding="utf-8")
    return int(status)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
