"""System files in YAML: the keys of the JSON format, and numbers as typed."""

from __future__ import annotations

import re
from typing import Any

from mcexact.errors import InputError, MissingExtra
from mcexact.exact.rational import Limits
from mcexact.model.json_text import JsonObject, NumberText

_NUMBER = re.compile(r"-?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?", re.ASCII)
_SHORT = re.compile(r"-?[0-9]{1,17}", re.ASCII)


def read_yaml(data: bytes, limits: Limits) -> Any:
    """Parse one YAML document as that of JSON is parsed.

    A plain scalar that is a number of JSON is one, as typed; every other scalar is a text, also
    ``yes`` and ``1e3_0``.  Anchors and tags are refused.

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
        _require_plain(yaml, text, limits)
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text: byte {error.start}") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f" at line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        said = getattr(error, "problem", None) or str(error).partition("\n")[0]
        raise InputError(f"not YAML: {said}{place}") from None
    if node is None:
        raise InputError("expected an object, found an empty file")
    return _document(yaml, node)


def _require_plain(yaml: Any, text: str, limits: Limits) -> None:
    """Refuse anchors, which can stand for more than fits into memory, and depth."""
    depth = 0
    for event in yaml.parse(text, Loader=yaml.SafeLoader):
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None) is not None:
            raise InputError(
                f"anchors are not read: write the value out at line {event.start_mark.line + 1}"
            )
        if getattr(event, "tag", None) is not None:
            raise InputError(f"tags are not read, found one at line {event.start_mark.line + 1}")
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        if depth > limits.depth:
            raise InputError(f"expected at most {limits.depth} nested levels (Limits.depth)")


def _document(yaml: Any, node: Any) -> Any:
    """The plain data of a node."""
    if isinstance(node, yaml.SequenceNode):
        return [_document(yaml, each) for each in node.value]
    if isinstance(node, yaml.MappingNode):
        found = JsonObject()
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise InputError(f"expected a text as key at line {key.start_mark.line + 1}")
            if key.value in found:
                raise InputError(f"the key {key.value!a} is given twice")
            found[key.value] = _document(yaml, value)
        return found
    text = str(node.value)
    if node.style is None and _NUMBER.fullmatch(text):
        return int(text) if _SHORT.fullmatch(text) else NumberText(text)
    return text
