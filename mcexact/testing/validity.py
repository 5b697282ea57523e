"""An assertion for tests that make or keep certificates."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from mcexact.answer.check import check
from mcexact.answer.protocol import Answer
from mcexact.model.controller import Controller
from mcexact.model.system import MultiChannelSystem


def assert_valid(
    certificate: Answer | str | os.PathLike[str],
    system: MultiChannelSystem | None = None,
    controller: Controller | str | os.PathLike[str] | None = None,
    expect: str | Mapping[str, Any] | None = None,
) -> str:
    """Assert that the independent checker accepts a certificate.

    Parameters
    ----------
    certificate : Answer or path
    system : MultiChannelSystem, optional
    controller : Controller or path, optional
    expect : str or mapping, optional
        What the certificate must be about, and what it must say, as in `check`.

    Returns
    -------
    str
        The verified statement.

    Raises
    ------
    AssertionError
        If the verdict is not VALID; the message says why.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem, fixed_spectrum
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> assert_valid(fixed_spectrum(plant), plant).startswith("For the plant ")
    True
    >>> other = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> assert_valid(fixed_spectrum(plant), other)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    AssertionError: INVALID system system: about another system, of digest ...
    """
    __tracebackhide__ = True
    found = check(certificate, system, controller, expect)
    if not found.valid:
        raise AssertionError(found.explain())
    return found.statement
