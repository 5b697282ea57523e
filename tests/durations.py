"""Which tests take long: measured in seconds of the processor, and kept in a list.

    python -m tests.durations [PATH…]

Runs the tests in these files and folders, by default all, one after another, and writes those that
take more than `LIMIT` seconds into ``slow.txt``; what the list says of other files stays.  Tests on
the list are marked ``slow``: `make tests` leaves them out, and `make slow-tests` runs them.  The
first test that needs a large library also pays for its import.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Generator, Iterable
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.prepared import Prepared

ROOT = Path(__file__).parents[1]
LIST = Path(__file__).with_name("slow.txt")
MEASURED = ROOT / "build" / "durations.tsv"
LIMIT = 0.25
SLOW_FIXTURES = frozenset({"whole", "written"})
"""Fixtures of a module that take seconds; the tests that use one are slow."""
NEVER_SLOW = (
    "tests/analysis/fixed_modes/test_fixed_spectrum.py::test_drawn_systems_agree",
    "tests/answer/test_golden.py::",
    "tests/architecture/",
    "tests/documentation/test_pages.py::test_a_page_says_what_happens[README.md]",
    "tests/documentation/test_pages.py::test_a_page_says_what_happens[docs/tutorial.md]",
)
"""Beginnings of the names of tests that run before each change, however long they take.

They are what the first pages promise, the bytes of certificates, and the comparison of fixed modes
with enumeration.
"""


def slow_tests() -> frozenset[str]:
    """The tests on the list, as pytest names them."""
    return frozenset(LIST.read_text(encoding="utf-8").splitlines())


def spent() -> float:
    """The seconds of the processor that this process and those it has ended took so far."""
    return sum(os.times()[:4]) + Prepared.seconds


class Shared:
    """The seconds that went into fixtures which several tests use."""

    seconds = 0.0


@pytest.hookimpl(hookwrapper=True)
def pytest_fixture_setup(fixturedef: pytest.FixtureDef[Any]) -> Generator[None]:
    """Keep what a module prepares apart from the test that happens to be its first."""
    begun = spent()
    yield
    if fixturedef.scope != "function":
        Shared.seconds += spent() - begun


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None]:
    """Write down the seconds of each test, its own preparation included."""
    begun = spent() - Shared.seconds
    yield
    with MEASURED.open("a", encoding="utf-8") as stream:
        stream.write(f"{spent() - Shared.seconds - begun:.2f}\t{item.nodeid}\n")


def updated(listed: Iterable[str], measured: dict[str, float]) -> list[str]:
    """The list after a measurement: what was measured counts, and other files stay."""
    files = {name.partition("::")[0] for name in measured}
    stay = {name for name in listed if name.partition("::")[0] not in files}
    slow = {name for name, seconds in measured.items() if seconds > LIMIT}
    return sorted(stay | {name for name in slow if not name.startswith(NEVER_SLOW)})


def measurements(text: str) -> dict[str, float]:
    """The seconds of each test, from the lines that were written."""
    pairs = (line.split("\t", 1) for line in text.splitlines())
    return {name: float(seconds) for seconds, name in pairs}


def main(paths: list[str]) -> int:
    """Measure, and write the list.

    Returns
    -------
    int
        The status of pytest.
    """
    MEASURED.parent.mkdir(exist_ok=True)
    MEASURED.unlink(missing_ok=True)
    command = [sys.executable, "-m", "pytest", "--quiet", "--numprocesses=0", "-p", __spec__.name]
    environment = {**os.environ, "HYPOTHESIS_PROFILE": "ci"}
    status = subprocess.run([*command, *paths], cwd=ROOT, env=environment).returncode
    found = measurements(MEASURED.read_text(encoding="utf-8"))
    lines = updated(slow_tests(), found)
    LIST.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    left = sum(seconds for name, seconds in found.items() if name not in lines)
    print(f"{len(found)} tests took {sum(found.values()):.0f} s; without slow ones {left:.0f} s")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
