"""Run tests on a change of one file, in a fork of a process that has loaded everything else.

Starting Python and loading the libraries takes seconds, and the tests that notice a change often
take milliseconds.  Here only the checker, and what refers to it, is loaded again.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import os
import resource
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

CHECKER = "mcexact.checker"
MEMORY = 6 * 2**30
SLACK = 20
"""How many times its limit a run may take by the clock: others use the processor, too."""


class Chosen:
    """A plugin for pytest that keeps some tests, in the order in which they are given."""

    def __init__(self, tests: Sequence[str]) -> None:
        self.place = {name: k for k, name in enumerate(tests)}

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        items[:] = sorted(
            (item for item in items if item.nodeid in self.place),
            key=lambda item: self.place[item.nodeid],
        )


def load(files: Sequence[str]) -> None:
    """Load the tests with all that they import, and forget what refers to the checker."""
    with _silence():
        status = pytest.main(["-q", "--collect-only", "-p", "no:cacheprovider", *files])
    if status:
        raise SystemExit(f"the tests cannot be collected: pytest ended with {int(status)}")
    for name in _dependents():
        del sys.modules[name]
    gc.collect()
    gc.freeze()


def _dependents() -> set[str]:
    """The modules that refer to the checker, or to others that do."""
    own = {
        name: module
        for name, module in sys.modules.items()
        if isinstance(module, ModuleType) and name.partition(".")[0] in ("mcexact", "tests")
    }
    found = {name for name in own if name.startswith((CHECKER, "tests.checker"))}
    while True:
        more = {name for name in own.keys() - found if _refers(own[name], found)}
        if not more:
            return found
        found |= more


def _refers(module: ModuleType, others: set[str]) -> bool:
    """Whether a module has one of others, or something that was defined there, by name."""
    for value in vars(module).values():
        if isinstance(value, ModuleType):
            if value.__name__ in others:
                return True
        else:
            with contextlib.suppress(Exception):
                if getattr(value, "__module__", None) in others:
                    return True
    return False


@contextlib.contextmanager
def _silence() -> Any:
    """Send to nowhere what is written."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept, nowhere = [os.dup(1), os.dup(2)], os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        for target, descriptor in enumerate(kept, start=1):
            os.dup2(descriptor, target)
            os.close(descriptor)
        os.close(nowhere)


def run(tests: Sequence[str], seconds: float) -> str:
    """Run some tests in a fork until one fails.

    Returns
    -------
    str
        "survived" if all pass, "killed" if one fails or cannot be loaded, "timeout" if they take
        more than so many seconds of the processor's time, "abnormal" if none was run or the process
        was ended by a signal.
    """
    child = os.fork()
    if not child:
        _run_and_exit(tests, seconds)
    deadline = time.monotonic() + SLACK * seconds
    pause = 0.002
    while True:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            break
        if time.monotonic() > deadline:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return "timeout"
        time.sleep(pause)
        pause = min(2 * pause, 0.05)
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(child, signal.SIGKILL)
    code = os.waitstatus_to_exitcode(status)
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return "timeout"
    return {0: "survived", 1: "killed", 2: "killed", 3: "killed"}.get(code, "abnormal")


def _run_and_exit(tests: Sequence[str], seconds: float) -> None:
    """Run some tests in this process, and end it."""
    code = 70
    try:
        os.setpgid(0, 0)
        limit = int(seconds) + 1
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        sys.dont_write_bytecode = True
        importlib.invalidate_caches()
        nowhere = os.open(os.devnull, os.O_RDWR)
        for target in range(3):
            os.dup2(nowhere, target)
        paths = list(dict.fromkeys(str(Path(name.partition("::")[0])) for name in tests))
        options = ["-x", "-q", "-p", "no:cacheprovider", "--tb=no", "-n", "0"]
        code = int(pytest.main([*options, *paths], plugins=[Chosen(tests)]))
    finally:
        os._exit(code)
