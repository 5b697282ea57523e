"""Results as tables of pandas."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from mcexact.errors import InputError, MissingExtra


def to_pandas(results: Any) -> Any:
    """Return results as a table of pandas, which the extra ``pandas`` installs.

    Parameters
    ----------
    results : Analysis, Trajectory, or iterable of answers or of the records of a sweep
        One row for each answer, time or system; exact numbers stay exact.

    Returns
    -------
    pandas.DataFrame

    Raises
    ------
    InputError
        If there is something else among them.
    MissingExtra
        If pandas is not installed.

    Examples
    --------
    >>> from mcexact import analyze
    >>> from mcexact.model import gallery
    >>> found = analyze(gallery.load("hidden-triple-mode"), ["fixed_spectrum", "completeness"])
    >>> to_pandas(found)[["question", "polynomial", "complete"]]
             question polynomial complete
    0  fixed_spectrum      x - 1      NaN
    1    completeness        NaN    False
    """
    with MissingExtra.named("pandas"):
        import pandas

    if hasattr(results, "to_rows"):
        return pandas.DataFrame(results.to_rows())
    several = isinstance(results, Iterable) and not isinstance(results, str)
    found = list(results) if several and not hasattr(results, "to_row") else [results]
    for each in found:
        if not hasattr(each, "to_row"):
            raise InputError(
                "expected an analysis, a trajectory, answers, or records of a sweep, "
                f"found {type(each).__name__}",
                where="results",
            )
    return pandas.DataFrame([each.to_row() for each in found])
