"""All public names of the package, at the top and in its public modules."""

from __future__ import annotations

import importlib
import inspect
import re
from types import ModuleType
from typing import Any

import mcexact

SAID = inspect.getdoc(mcexact) or ""
TOP = {
    name: value
    for name in dir(mcexact)
    if not isinstance(value := getattr(mcexact, name), ModuleType)
}
MODULES = {
    name: importlib.import_module(f"mcexact.{name}")
    for name in re.findall(r"^`(\w+)`  ", SAID, re.M)
}


def _names(module: ModuleType) -> dict[str, Any]:
    named = {name: getattr(module, name) for name in getattr(module, "__all__", dir(module))}
    return {
        name: value
        for name, value in named.items()
        if name[0] != "_" and getattr(value, "__module__", "").startswith("mcexact.")
    }


PLACES = {"mcexact": TOP, **{f"mcexact.{name}": _names(each) for name, each in MODULES.items()}}
PUBLIC = {name: value for names in PLACES.values() for name, value in names.items()}
