"""Examples of files for ``--spectrum``, one of each form that is accepted."""

from __future__ import annotations

import json
from typing import Any

ROOTS = [-1, "-1+2i"]
PAIRS: list[Any] = ["-1", {"re": -1, "im": "2"}]
COEFFICIENTS = [5, 7, 3, 1]
_HEAD = (
    "Examples of a file for --spectrum; the numbers are as many as the degree, a pair counts twice:"
)


def spectrum_examples(*keys: str, parts: bool = False) -> str:
    """Return the end of a help text, with an example of each form.

    Parameters
    ----------
    *keys : str
        The keys of the document: ``"closed_loop"``, or ``"feedback"`` and ``"error"``.
    parts : bool
        Whether a spectrum can be given for each strong component.

    Examples
    --------
    >>> print(spectrum_examples("closed_loop").removeprefix("\\b\\n"))
    Examples of a file for --spectrum; the numbers are as many as the degree, a pair counts twice:
      {"closed_loop": [-1, "-1+2i"]}
          the root -1 and the pair -1 ± 2i
      {"closed_loop": ["-1", {"re": -1, "im": "2"}]}
          the same; a fraction such as "-1/3" is a string
      {"closed_loop": [5, 7, 3, 1]}
          the same as coefficients, the constant term first: x^3 + 3x^2 + 7x + 5
    """
    shown: list[tuple[dict[str, Any], str]] = [
        (
            dict.fromkeys(keys, ROOTS),
            "the root -1 and the pair -1 ± 2i",
        ),
        (
            dict.fromkeys(keys, PAIRS),
            'the same; a fraction such as "-1/3" is a string',
        ),
        (
            dict.fromkeys(keys, COEFFICIENTS),
            "the same as coefficients, the constant term first: x^3 + 3x^2 + 7x + 5",
        ),
    ]
    if parts:
        each: Any = {"1": [-1, -2], "3": ["-1/2"]}
        shown.append(
            (
                dict.fromkeys(keys, each),
                "a list for each strong component of the transfer graph, by one of its agents",
            )
        )
    lines = ["\b", _HEAD]
    for document, told in shown:
        lines += [f"  {json.dumps(document)}", f"      {told}"]
    return "\n".join(lines)
