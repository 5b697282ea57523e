"""What floating point answered where it was recorded: the answers, the libraries, the kernel.

A wrong answer of floating point is often the sign of a rounding error, and other processors round
otherwise.  The records ship with the package; `recording` makes them.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import metadata, resources
from typing import Any

RECORDS = "records.json"
_LIBRARIES = ("numpy", "scipy", "control")


@dataclass(frozen=True)
class Libraries:
    """The libraries that answer in floating point, and the kernel that they multiply with.

    Attributes
    ----------
    versions : tuple of (str, str)
        Names and versions, the one that carries the kernel last.
    kernel : str or None
        What that library chose for the processor; None if it does not say.

    Examples
    --------
    >>> str(Libraries((("numpy", "2.4.6"), ("OpenBLAS", "0.3.31")), "Haswell"))
    'numpy 2.4.6, OpenBLAS 0.3.31 (kernel Haswell)'
    """

    versions: tuple[tuple[str, str], ...]
    kernel: str | None

    def __str__(self) -> str:
        listed = ", ".join(" ".join(each) for each in self.versions)
        return f"{listed} (kernel {self.kernel or 'unknown'})"

    def document(self) -> dict[str, Any]:
        """As plain data."""
        return {"versions": dict(self.versions), "kernel": self.kernel}


@dataclass(frozen=True)
class Record:
    """What floating point answered, and where.

    Attributes
    ----------
    floating : str
        The answer, in the words of `CrossCheck`.
    libraries : Libraries
    """

    floating: str
    libraries: Libraries


def libraries_here() -> Libraries:
    """The libraries of this process.

    Examples
    --------
    >>> libraries_here().versions[0][0]
    'numpy'
    """
    import numpy as np
    from threadpoolctl import threadpool_info

    versions = [(name, version) for name in _LIBRARIES if (version := _version(name))]
    products = [each for each in threadpool_info() if each["user_api"] == "blas"]
    # scipy may carry a library of its own; numpy's answers most of the questions.
    products.sort(key=lambda each: np.__name__ not in each["filepath"])
    if not products:
        return Libraries(tuple(versions), None)
    name = products[0]["internal_api"].replace("openblas", "OpenBLAS")
    version = products[0]["version"]
    return Libraries(
        (*versions, *([(name, version)] if version else ())), products[0].get("architecture")
    )


def _version(distribution: str) -> str | None:
    """The version that is installed."""
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return None


@cache
def recorded() -> Mapping[str, Any]:
    """The document of the records, by what was answered."""
    text = resources.files("mcexact.crosscheck").joinpath(RECORDS).read_text("utf-8")
    document: dict[str, Any] = json.loads(text)
    return document


def libraries_of(document: Mapping[str, Any]) -> Libraries:
    """The libraries that a record names."""
    return Libraries(tuple(document["versions"].items()), document["kernel"])
