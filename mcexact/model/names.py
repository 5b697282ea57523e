"""The names of channels: which texts are valid, and how messages quote them."""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Collection, Sequence

from mcexact.errors import InputError

LONGEST_NAME = 256
# Control characters, invisible format characters (among them every reordering of text), lone
# surrogates, and line and paragraph separators.
_REFUSED_CATEGORIES = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})


def quoted(text: object, width: int = 40) -> str:
    """Quote a text of the user in ASCII, shortened.

    Examples
    --------
    >>> quoted("u\\u202e1")
    "'u\\\\u202e1'"
    """
    if not isinstance(text, str):
        return f"a value of type {type(text).__name__}"
    return ascii(text) if len(text) <= width else ascii(text[:width]) + "…"


def nearest(name: str, known: Collection[str]) -> str:
    """Return the end of a message that suggests the nearest known name, or an empty text.

    Examples
    --------
    >>> nearest("stabilty", ["stability", "setpoint"]), nearest("xyz", ["stability"])
    (" (did you mean 'stability'?)", '')
    """
    close = difflib.get_close_matches(name[:LONGEST_NAME], list(known), n=1)
    return f" (did you mean {quoted(close[0])}?)" if close else ""


def checked_text(text: object, where: str, *, longest: int = 10_000) -> str:
    """Check and return a text such as a system's name or source.

    Raises
    ------
    InputError
        If the value is not a string, is too long, or contains characters that do not print.
    """
    if not isinstance(text, str):
        raise InputError(f"expected a string, found {quoted(text)}", where=where)
    if len(text) > longest:
        raise InputError(f"expected at most {longest} characters, found {len(text)}", where=where)
    _require_printable(text, where, "", allowed="\n\t")
    return text


def _require_printable(text: str, where: str, place: str, allowed: str = "") -> None:
    """Refuse a character that does not print, with the place that it is to be removed from."""
    for character in text:
        if unicodedata.category(character) in _REFUSED_CATEGORIES and character not in allowed:
            raise InputError(
                f"remove the character U+{ord(character):04X}{place}: it does not print",
                where=where,
            )


def checked_name(name: object, where: str) -> str:
    """Check and return the name of a channel or agent.

    Raises
    ------
    InputError
        If the value is not a string, is empty or longer than 256 characters, or contains control or
        invisible characters.  (Characters that reorder text would show the name of another
        channel.)
    """
    if not isinstance(name, str):
        raise InputError(
            f'expected a name as a string, such as "1", found {quoted(name)}', where=where
        )
    if not name:
        raise InputError("expected a name, found the empty string", where=where)
    if len(name) > LONGEST_NAME:
        raise InputError(
            f"expected a name of at most {LONGEST_NAME} characters, found {len(name)}", where=where
        )
    _require_printable(name, where, f" from the name {quoted(name)}")
    return name


def checked_names(names: Sequence[object], places: Sequence[str]) -> tuple[str, ...]:
    """Check and return the names of all channels, in order.

    Parameters
    ----------
    names : sequence
        One name for each channel.
    places : sequence of str
        The place of each name, for messages.

    Raises
    ------
    InputError
        If a name is invalid, or two channels have names that look the same.
    """
    seen: dict[str, str] = {}
    checked = []
    for name, where in zip(names, places, strict=True):
        good = checked_name(name, where)
        form = unicodedata.normalize("NFC", good)
        if form in seen:
            raise InputError(
                f"expected a name of its own, found {quoted(good)}, which is also {seen[form]}",
                where=where,
            )
        seen[form] = where
        checked.append(good)
    return tuple(checked)
