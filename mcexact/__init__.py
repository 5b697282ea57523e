"""Exact, certified analysis of multi-channel linear systems.

Names are loaded when they are first used, so that importing the package is quick and loads none of
the heavy libraries.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.model.system import MultiChannelSystem as MultiChannelSystem

_HOME = {
    "MultiChannelSystem": "mcexact.model.system",
}

__version__ = "0.1.0"
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(set(globals()) | set(_HOME))
