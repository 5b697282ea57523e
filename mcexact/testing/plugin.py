"""Fixtures for pytest, which finds this file by the entry point of the package.

pytest loads it at every start, so it imports nothing of the package before a test asks for it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

_PLANT = "gallery_plant"


@pytest.fixture
def assert_valid() -> Callable[..., str]:
    """Return the function that asserts that the checker accepts a certificate."""
    from mcexact import testing

    return testing.assert_valid


@pytest.fixture
def gallery_plant(request: pytest.FixtureRequest) -> Any:
    """Return a published plant; a test with this fixture runs once for each of the gallery."""
    from mcexact.model import gallery

    return gallery.load(request.param)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that uses the fixture for every plant of the gallery."""
    if _PLANT in metafunc.fixturenames:
        from mcexact.model import gallery

        metafunc.parametrize(_PLANT, gallery.names(), indirect=True)
