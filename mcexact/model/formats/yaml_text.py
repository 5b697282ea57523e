"""System files in YAML: the keys of the JSON format, and numbers as typed."""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass
from typing import Any

from mcexact.errors import InputError, MissingExtra
from mcexact.exact.rational import Limits
from mcexact.model.json_text import JsonObject, NumberText, parse

_NUMBER = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?", re.ASCII)
_SHORT = re.compile(r"-?[0-9]{1,17}", re.ASCII)
_LEADING_ZERO = re.compile(r"[-+]?0[0-9_]+([.eE].*)?", re.ASCII)
_CONSTANTS = {"null": None, "true": True, "false": False}


def read_yaml(data: bytes, limits: Limits) -> Any:
    """Parse one YAML document as that of JSON is parsed.

    A plain scalar that is a value of JSON is this value, a number as typed; every other scalar is a
    text, also ``yes`` and ``1e3_0``.  Anchors, tags and numbers such as ``010`` are refused: that
    is 8 in YAML 1.1, and 10 in YAML 1.2.  A file that is JSON is read as JSON, which YAML 1.2 is.

    Raises
    ------
    InputError
        If it is malformed, repeats a key, or is nested too deeply.
    MissingExtra
        If PyYAML is not installed.
    """
    with MissingExtra.named("yaml"):
        import yaml
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text: byte {error.start}") from None
    if text.lstrip()[:1] == "{":
        with contextlib.suppress(InputError):
            return parse(text, limits)
    try:
        return _document(yaml, text, limits)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f" at line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        said = getattr(error, "problem", None) or str(error).partition("\n")[0]
        raise InputError(f"not YAML: {said}{place}") from None


def _document(yaml: Any, text: str, limits: Limits) -> Any:
    """The plain data of the only document, made in one pass over the events of the parser.

    Anchors, which can stand for more than fits into memory, and depth are refused where they begin.
    The parser in C is ten times as fast, and not everywhere.
    """
    open_: list[_Open] = [_Open([])]
    for event in yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
        line = event.start_mark.line + 1
        if isinstance(event, yaml.ScalarEvent):
            _require_plain(event, line)
            open_[-1].add(event.value, event.implicit[0], line)
        elif isinstance(event, yaml.CollectionStartEvent):
            _require_plain(event, line)
            open_[-1].require_value(line)
            if len(open_) > limits.depth:
                raise InputError(f"expected at most {limits.depth} nested levels (Limits.depth)")
            open_.append(_Open([] if isinstance(event, yaml.SequenceStartEvent) else JsonObject()))
        elif isinstance(event, yaml.CollectionEndEvent):
            made = open_.pop().made
            open_[-1].put(made)
        elif isinstance(event, yaml.AliasEvent):
            raise _anchored(line)
        elif isinstance(event, yaml.DocumentStartEvent) and open_[0].made:
            raise InputError(f"not YAML: expected a single document, found another at line {line}")
    if not open_[0].made:
        raise InputError("expected an object, found an empty file")
    return open_[0].made[0]


def _require_plain(event: Any, line: int) -> None:
    """Refuse an anchor and a tag."""
    if event.anchor is not None:
        raise _anchored(line)
    if event.tag is not None:
        raise InputError(f"tags are not read, found one at line {line}")


def _anchored(line: int) -> InputError:
    return InputError(f"anchors are not read: write the value out at line {line}")


@dataclass
class _Open:
    """A list or an object that is being read, and the key whose value comes next."""

    made: Any
    key: str | None = None

    def add(self, text: str, plain: bool, line: int) -> None:
        """Take a scalar as a key or as a value."""
        if isinstance(self.made, dict) and self.key is None:
            if text in self.made:
                raise InputError(f"the key {text[:40]!a} is given twice")
            self.key = text
        else:
            self.put(_value(text, line) if plain else text)

    def require_value(self, line: int) -> None:
        """Refuse a list or an object as a key."""
        if isinstance(self.made, dict) and self.key is None:
            raise InputError(f"expected a text as key at line {line}")

    def put(self, value: Any) -> None:
        """Take a value."""
        if self.key is None:
            self.made.append(value)
        else:
            self.made[self.key], self.key = value, None


def _value(text: str, line: int) -> Any:
    """What a plain scalar stands for."""
    if _NUMBER.fullmatch(text):
        return int(text) if _SHORT.fullmatch(text) else NumberText(text)
    if _LEADING_ZERO.fullmatch(text):
        raise InputError(
            f"found the number {text[:40]} at line {line}, which some programs read with the base "
            "8: write it without zeros in front"
        )
    return _CONSTANTS.get(text, text)
