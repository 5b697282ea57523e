"""What ``--spectrum`` takes: numbers, JSON or a file, with an example of each form for the help."""

from __future__ import annotations

import json
import os
import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.cli.running import Run

NUMBERS = "-1, -1+2i"
ROOTS = [-1, "-1+2i"]
PAIRS: list[Any] = ["-1", {"re": -1, "im": "2"}]
COEFFICIENTS = [5, 7, 3, 1]
_HEAD = (
    "Examples for --spectrum, as text or in a file; the numbers are as many as the\n"
    "degree, and a pair counts twice:"
)
_LIST = re.compile(r"[-+0-9./eEij,\s]*[0-9ij][-+0-9./eEij,\s]*", re.ASCII)


def spectrum_text(given: str) -> str | None:
    """Return the JSON of a spectrum that is given as text; None for the name of a file.

    Numbers are separated by commas, and may have blanks around signs.  A file of the name that is
    given is read whatever its name is.

    Examples
    --------
    >>> spectrum_text("-1 + 2i, -1 - 2i, -1/3")
    '["-1+2i", "-1-2i", "-1/3"]'
    >>> spectrum_text("[1, 2]"), spectrum_text("spectrum.json"), spectrum_text("-")
    ('[1, 2]', None, None)
    """
    if given.lstrip()[:1] in {"{", "["}:
        return given
    if not _LIST.fullmatch(given) or os.path.exists(given):
        return None
    return json.dumps([re.sub(r"\s*([-+])\s*", r"\1", each).strip() for each in given.split(",")])


def read_spectrum(given: str, run: Run) -> tuple[str, bytes]:
    """Return the name by which messages refer to a spectrum, and its JSON, from text or a file.

    Raises
    ------
    InputError
        If it is neither, or the file cannot be read.
    """
    from mcexact.errors import InputError

    text = spectrum_text(given)
    if text is None and given != "-" and not os.path.exists(given):
        raise InputError(
            f"expected numbers such as '-1+2i, -3', JSON, or the name of a file, found {given!a}",
            where="--spectrum",
        )
    return run.read(given) if text is None else ("--spectrum", text.encode())


def spectrum_examples(*keys: str, parts: bool = False) -> str:
    """Return the end of a help text, with an example of each form.

    Parameters
    ----------
    *keys : str
        The keys of the document: ``"closed_loop"``, which may be left out, or ``"feedback"`` and
        ``"error"``.
    parts : bool
        Whether a spectrum can be given for each strong component.

    Examples
    --------
    >>> print(spectrum_examples("closed_loop").removeprefix("\\b\\n"))
    Examples for --spectrum, as text or in a file; the numbers are as many as the
    degree, and a pair counts twice:
      '-1, -1+2i'
          the root -1 and the pair -1 ± 2i
      {"closed_loop": [-1, "-1+2i"]}
          the same as JSON
      {"closed_loop": ["-1", {"re": -1, "im": "2"}]}
          the same; a fraction such as "-1/3" is a string
      {"closed_loop": [5, 7, 3, 1]}
          the same as coefficients, the constant term first: x^3 + 3x^2 + 7x + 5
    """
    told = "the root -1 and the pair -1 ± 2i"
    shown: list[tuple[dict[str, Any], str]] = [
        (
            dict.fromkeys(keys, ROOTS),
            told if len(keys) > 1 else "the same as JSON",
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
    if len(keys) == 1:
        lines += [f"  '{NUMBERS}'", f"      {told}"]
    for document, meaning in shown:
        lines += [f"  {json.dumps(document)}", f"      {meaning}"]
    return "\n".join(lines)
