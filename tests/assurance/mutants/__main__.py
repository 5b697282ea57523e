"""Mutation testing of the checker with Cosmic Ray.

    python -m tests.assurance.mutants [OPTION…] [STEM…]

Tries every small change of the files of ``mcexact/checker`` (all, or those with these stems) in
copies of the tree below ``build/mutants``, and prints for each file how many changes made a test of
``tests/checker`` fail.  A change is tried with the tests that run its lines, those of this module
first (``tests.assurance.mutants.topics``) and then the shorter ones, up to S seconds of tests.

What was killed stays so while its file is the same; the rest is tried again in every run, since
tests may have been added.  Which tests run which lines is found anew only where a test or the
checker has changed.  What ``tests/checker/SURVIVORS.md`` explains counts as one that survives and
is not tried.  ``--only DeleteStatement`` tries the changes of one operator, ``--sample 100`` so
many of each file, drawn in the same way in every run.  After ``--minutes 15`` of a file no change
is begun.  ``--own`` runs the tests of these files, and those of documents, alone; what survives may
be noticed by others.  ``--fresh`` starts anew, ``--report`` tries nothing.  What was not tried is
counted.  The exit status is 1 if the score is below 95 %, or if a survivor is not explained.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from tests.assurance.mutants import topics

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / "build" / "mutants"
CHECKER = Path("mcexact/checker")
COPIED = ("mcexact", "tests", "proofs", "pyproject.toml", "README.md", "Makefile", "campaigns.mk")


def copy(tree: Path) -> None:
    """Make a copy of what the tests need."""
    shutil.rmtree(tree, ignore_errors=True)
    tree.mkdir(parents=True)
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(ROOT / name, tree / name)


def inside(tree: Path, *arguments: str) -> subprocess.Popen[bytes]:
    """Start Python in a copy, so that the copy is what it imports."""
    environment = os.environ | {
        "PYTHONPATH": str(tree),
        "HYPOTHESIS_PROFILE": "ci",
        "PYTHONHASHSEED": "0",
    }
    return subprocess.Popen([sys.executable, *arguments], cwd=tree, env=environment)


def finished(*processes: subprocess.Popen[bytes]) -> None:
    """Wait for processes, and stop if one failed."""
    statuses = [process.wait() for process in processes]
    if any(statuses):
        raise SystemExit("a run failed")


def main() -> int:
    """Try the mutants, and report."""
    parser = argparse.ArgumentParser(prog="tests.assurance.mutants", description=__doc__)
    parser.add_argument("stems", nargs="*", metavar="STEM")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--only", default="")
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--minutes", type=float, default=float("inf"))
    parser.add_argument("--own", action="store_true")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--report", action="store_true")
    options = parser.parse_args()
    stems = options.stems or sorted(topics.sources(ROOT / CHECKER))
    begun = time.monotonic()
    FOLDER.mkdir(parents=True, exist_ok=True)
    if options.fresh:
        for path in FOLDER.glob("*.*"):
            path.unlink()
    if not options.report:
        from tests.assurance.mutants import selection

        trees = [FOLDER / f"tree-{k}" for k in range(options.workers)]
        for tree in trees:
            copy(tree)
        chosen = FOLDER / "selection.json"
        worker = [
            "-m",
            "tests.assurance.mutants.worker",
            str(FOLDER),
            str(options.seconds),
            options.only,
            str(options.sample),
            str(options.minutes),
        ]
        tests = _own_tests(stems) if options.own else []
        if not selection.is_current(chosen, ROOT, tests):
            choose = "-m", "tests.assurance.mutants.selection", str(chosen)
            finished(inside(trees[0], *choose, *tests))
        finished(
            *(
                inside(tree, *worker, *part)
                for tree, part in zip(trees, _parts(stems, len(trees)), strict=True)
                if part
            )
        )
    from tests.assurance.mutants import report

    status = report.write(FOLDER, ROOT / CHECKER, stems)
    print(f"{(time.monotonic() - begun) / 3600:.2f} hours, {options.workers} workers")
    return status


def _own_tests(stems: list[str]) -> list[str]:
    """The files of tests of some files of the checker, and those of documents."""
    from tests.assurance.mutants import topics

    names = {name for stem in stems for name in topics.tests(stem)}
    return sorted({*topics.DOCUMENTS, *(f"tests/checker/{name}" for name in names)})


def _parts(stems: list[str], count: int) -> list[list[str]]:
    """Files for each worker, of about the same size in all."""
    parts: list[list[str]] = [[] for _ in range(count)]
    sizes = [0] * count
    known = {stem: path.stat().st_size for stem, path in topics.sources(ROOT / CHECKER).items()}
    for stem in sorted(stems, key=lambda stem: -known[stem]):
        least = sizes.index(min(sizes))
        parts[least].append(stem)
        sizes[least] += known[stem]
    return parts


if __name__ == "__main__":
    sys.exit(main())
