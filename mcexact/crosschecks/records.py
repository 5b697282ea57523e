"""Recorded floating-point answers, with the libraries and the BLAS kernel that computed them.

A wrong answer often depends on the sign of a rounding error, which differs between processors.  The
records ship with the package; `recording` writes them.
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
    """The libraries that compute in floating point, and the BLAS kernel that multiplies matrices.

    Attributes
    ----------
    versions : tuple of (str, str)
        Names and versions; the last library contains the kernel.
    kernel : str or None
        The kernel that this library chose for the processor; None if it is unknown.

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
        """The libraries as plain data of a JSON document."""
        return {"versions": dict(self.versions), "kernel": self.kernel}


@dataclass(frozen=True)
class Record:
    """A floating-point answer and the libraries that computed it.

    Attributes
    ----------
    floating : str
        The answer, worded as in `CrossCheck`.
    libraries : Libraries
    """

    floating: str
    libraries: Libraries


def libraries_here() -> Libraries:
    """Return the libraries of this process.

    Examples
    --------
    >>> libraries_here().versions[0][0]
    'numpy'
    """
    import numpy as np
    from threadpoolctl import threadpool_info

    versions = [(name, version) for name in _LIBRARIES if (version := _version(name))]
    products = [each for each in threadpool_info() if each["user_api"] == "blas"]
    # scipy may contain a BLAS library of its own; numpy's computes most of the answers.
    products.sort(key=lambda each: np.__name__ not in each["filepath"])
    if not products:
        return Libraries(tuple(versions), None)
    name = products[0]["internal_api"].replace("openblas", "OpenBLAS")
    version = products[0]["version"]
    return Libraries(
        (*versions, *([(name, version)] if version else ())), products[0].get("architecture")
    )


def _version(distribution: str) -> str | None:
    """The installed version of a package."""
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return None


@cache
def recorded() -> Mapping[str, Any]:
    """Return the document of records, keyed by what was answered."""
    text = resources.files("mcexact.crosschecks").joinpath(RECORDS).read_text("utf-8")
    document: dict[str, Any] = json.loads(text)
    return document


def libraries_of(document: Mapping[str, Any]) -> Libraries:
    """Return the libraries that a record names."""
    return Libraries(tuple(document["versions"].items()), document["kernel"])
