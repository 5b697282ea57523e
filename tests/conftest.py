"""Hypothesis profiles: `dev` at the desk, `ci` repeatable, `deep` for a long look; slow tests."""

import gc
import os
import sys
from collections.abc import Generator
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from mcexact import processes
from tests.durations import SLOW_FIXTURES, slow_tests
from tests.wording import (  # noqa: F401 - hooks
    pytest_addoption,
    pytest_runtest_call,
    pytest_sessionfinish,
    pytest_sessionstart,
)

_SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]

settings.register_profile("dev", max_examples=50, deadline=None, suppress_health_check=_SLOW)
settings.register_profile(
    "ci", max_examples=50, deadline=None, derandomize=True, suppress_health_check=_SLOW
)
settings.register_profile("deep", max_examples=2000, deadline=None, suppress_health_check=_SLOW)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "dev"))

# Pages have the same date on every day.
os.environ.setdefault("SOURCE_DATE_EPOCH", "1700000000")


@pytest.fixture(autouse=True)
def _children_are_forks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fork on Linux also where OpenBLAS has threads: children inherit what a test replaces."""
    monkeypatch.setattr(processes, "may_fork", lambda: sys.platform == "linux")


def pytest_configure(config: pytest.Config) -> None:
    """Import the package as it is, though its plugin marks it for the rewriting of assertions.

    Where a child process rewrote a module that it imports, Python 3.11 may end in a SystemError of
    the constructor of syntax trees when garbage is looked for at the same time.
    """
    hook: Any = config.pluginmanager.rewrite_hook
    marked = vars(hook).get("_must_rewrite", set())
    hook.mark_rewrite()  # forgets what is known of single modules
    marked -= {name for name in marked if name.partition(".")[0] == "mcexact"}


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests that have been measured to be slow."""
    slow = slow_tests()
    for item in items:
        if item.nodeid in slow or SLOW_FIXTURES & set(getattr(item, "fixturenames", ())):
            item.add_marker(pytest.mark.slow)


@pytest.hookimpl(hookwrapper=True)
def pytest_collection() -> Generator[None]:
    """Look for no garbage among what is collected, which stays to the end."""
    gc.disable()
    yield
    gc.freeze()
    gc.enable()
