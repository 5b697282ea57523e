"""The full tests in every environment in which they have to pass, and a table of what came out.

    python -m tests.matrix [PATTERN…]

Runs the cells whose names match one of the patterns, one after another, and goes on after failures.
Without patterns these are: every floating-point kernel that this processor can run, with one thread
and with four in turn; numpy without its own loops for this processor; every version of Python;
the oldest versions declared; and a busy machine.  The patterns ``*-1`` and ``*-4`` run all kernels
with one number of threads.

Interpreters are looked for on PATH and in the variable PYTHONS, which holds paths with blanks
between them.  Environments are made below ``build/matrix`` and used again; the output of each cell
stands there too.  The exit status is 1 if a cell failed, and 2 if no cell has such a name.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

from tests.kernels import environments, usable_kernels

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "build" / "matrix"
VERSIONS = ("3.11", "3.12", "3.13")
LOOPS = 16
SUITE = ("-m", "pytest", "--quiet", "-p", "no:cacheprovider", "--dist", "worksteal")

_BUSY = "import os\nparent = os.getppid()\nwhile os.getppid() == parent: pass"  # ends with this one
_VERSION = "import sys; print('{}.{}'.format(*sys.version_info))"


@dataclass(frozen=True)
class Cell:
    """One environment for the tests.

    Attributes
    ----------
    name : str
    environment : mapping
        Variables to set.
    version : str
        Of the Python for an environment of its own; without one, the Python at hand runs the tests.
    constraints : str
        The file that prescribes the versions of the libraries, if they are not the latest.
    loops : int
        How many processes are busy beside the tests.
    workers : int
        How many processes run tests.
    chosen : bool
        Whether it is run without being asked for.
    """

    name: str
    environment: Mapping[str, str] = field(default_factory=dict)
    version: str = ""
    constraints: str = ""
    loops: int = 0
    workers: int = 2
    chosen: bool = True


@dataclass(frozen=True)
class Outcome:
    """What became of a cell: "passed", "failed" or "skipped", why, and how long it took."""

    verdict: str
    said: str
    seconds: float = 0.0


def cells() -> Iterator[Cell]:
    """All cells, those that cannot be run here too."""
    for variables in environments():
        match variables:
            case {"OPENBLAS_CORETYPE": kernel, "OPENBLAS_NUM_THREADS": threads}:
                in_turn = ("1", "4")[usable_kernels().index(kernel) % 2]
                yield Cell(f"{kernel}-{threads}", variables, chosen=threads == in_turn)
            case _:
                yield Cell("plain-loops", variables)
    for version in VERSIONS:
        yield Cell(f"python{version}", version=version)
    yield Cell("oldest", version=VERSIONS[0], constraints="tests/oldest.txt")
    # With two workers beside so many loops the tests would take most of an hour.
    yield Cell("busy", loops=LOOPS, workers=8)


def interpreters() -> dict[str, str]:
    """The Python to use for each version: those of PYTHONS first, then those on PATH."""
    named = [f"python{version}" for version in VERSIONS]
    found: dict[str, str] = {}
    for name in [*os.environ.get("PYTHONS", "").split(), *named, sys.executable]:
        if path := shutil.which(name):
            asked = subprocess.run([path, "-c", _VERSION], capture_output=True, text=True)
            if asked.returncode == 0:  # else it only stands for a version that is not installed
                found.setdefault(asked.stdout.strip(), path)
    return found


def installed(cell: Cell, interpreter: str, log: Path) -> str:
    """The Python of a cell's own environment, made anew if what is declared has changed.

    Raises
    ------
    subprocess.CalledProcessError
        If it cannot be made.
    """
    folder = FOLDER / cell.name
    declared = [ROOT / "pyproject.toml", *([ROOT / cell.constraints] if cell.constraints else [])]
    texts = (interpreter, *(path.read_text(encoding="utf-8") for path in declared))
    wanted = hashlib.sha256("\0".join(texts).encode()).hexdigest()
    stamp, python = folder / "made-of", str(folder / "bin" / "python")
    if not stamp.exists() or stamp.read_text() != wanted:
        constraints = ["--constraint", cell.constraints] if cell.constraints else []
        pip = [python, "-m", "pip", "install", "--disable-pip-version-check", *constraints]
        with log.open("w") as output:
            for command in (
                [interpreter, "-m", "venv", "--clear", str(folder)],
                [*pip, "--editable", ".[test]"],
            ):
                subprocess.run(command, cwd=ROOT, stdout=output, stderr=output, check=True)
        stamp.write_text(wanted)
    return python


@contextmanager
def busy(count: int) -> Iterator[None]:
    """So many processes that never rest."""
    loops = [subprocess.Popen([sys.executable, "-c", _BUSY]) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def run(cell: Cell, found: Mapping[str, str]) -> Outcome:
    """Run the full tests in one cell."""
    if cell.version and cell.version not in found:
        return Outcome("skipped", f"Python {cell.version} is neither on PATH nor in PYTHONS")
    log, python = FOLDER / f"{cell.name}.log", sys.executable
    if cell.version:
        try:
            python = installed(cell, found[cell.version], log)
        except (subprocess.CalledProcessError, OSError) as error:
            return Outcome("failed", f"not installed: {error}; see {log.relative_to(ROOT)}")
    variables = {**os.environ, "HYPOTHESIS_PROFILE": "ci", **cell.environment}
    start = time.monotonic()
    with log.open("w", encoding="utf-8") as output, busy(cell.loops):
        done = subprocess.run(
            [python, *SUITE, "-n", str(cell.workers)],
            cwd=ROOT,
            env=variables,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    said = counts(log.read_text(encoding="utf-8", errors="replace"))
    verdict = "failed" if done.returncode else "passed"
    return Outcome(verdict, said, time.monotonic() - start)


def counts(output: str) -> str:
    """How many tests passed, failed and so on, in the words of pytest's last line."""
    found = re.findall(r"^(\d+ \w+(?:, \d+ \w+)*) in [\d.]+s", output, re.MULTILINE)
    return str(found[-1]) if found else "the tests did not end"


def main(patterns: Sequence[str]) -> int:
    """Run the chosen cells and print the table."""
    chosen = [
        cell
        for cell in cells()
        if (any(fnmatchcase(cell.name, each) for each in patterns) if patterns else cell.chosen)
    ]
    if not chosen:
        known = ", ".join(cell.name for cell in cells())
        print(f"matrix: there is no such cell; the cells are {known}", file=sys.stderr)
        return 2
    FOLDER.mkdir(parents=True, exist_ok=True)
    found, outcomes = interpreters(), {}
    for cell in chosen:
        print(f"{cell.name} … ", end="", flush=True)
        outcomes[cell.name] = run(cell, found)
        print(outcomes[cell.name].said, flush=True)
    print()
    for name, outcome in outcomes.items():
        print(f"{name:<16} {outcome.verdict:<8} {outcome.seconds:6.0f} s   {outcome.said}")
    return int(any(outcome.verdict == "failed" for outcome in outcomes.values()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
