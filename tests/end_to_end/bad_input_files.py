"""Making the files that the table of bad inputs describes."""

import base64
import copy
import json
from pathlib import Path
from typing import Any

Entry = dict[str, Any]
_NUMBER = "@number:"


def content(entry: Entry, documents: dict[str, Any]) -> bytes:
    """The bytes of an entry's input file.

    Parameters
    ----------
    entry : dict
    documents : dict
        The documents that entries edit: ``system``, ``certificate`` and others.
    """
    if "text" in entry:
        return bytes(entry["text"], "utf-8")
    if "base64" in entry:
        return base64.b64decode(entry["base64"])
    if "content" in entry:
        return bytes(entry["content"]["repeat"] * entry["content"]["times"], "utf-8")
    if "nested" in entry:
        return b"[" * entry["nested"] + b"]" * entry["nested"]
    document = copy.deepcopy(documents[entry.get("base", "system")])
    for edit in entry.get("patch", ()):
        _apply(document, edit)
    if "shift_by_modulus" in entry:
        _shift_by_modulus(document)
    data = _dumps(document)
    before, after = (base64.b64decode(entry.get(f"base64_{side}", "")) for side in _SIDES)
    return before + data[: entry.get("keep", len(data))] + after


_SIDES = ("before", "after")


def _apply(document: Any, edit: dict[str, Any]) -> None:
    """Apply one edit, in place: replace, add, remove, or swap two members of a list."""
    *way, last = edit["path"].strip("/").split("/")
    parent = document
    for step in way:
        parent = parent[int(step) if isinstance(parent, list) else step]
    key = int(last) if isinstance(parent, list) else last
    if edit["op"] == "remove":
        del parent[key]
    elif edit["op"] == "swap":
        i, j = edit["value"]
        parent[key][i], parent[key][j] = parent[key][j], parent[key][i]
    else:
        parent[key] = _value(edit["value"])


def _value(value: Any) -> Any:
    """A value as the table writes it: long ones by repetition, odd numbers by their text."""
    if isinstance(value, dict) and value.keys() == {"repeat", "times"}:
        return value["repeat"] * value["times"]
    if isinstance(value, dict) and value.keys() == {"row", "times"}:
        return [value["row"]] * value["times"]
    if isinstance(value, dict) and value.keys() == {"number"}:
        return _NUMBER + value["number"]
    return [_value(item) for item in value] if isinstance(value, list) else value


def _shift_by_modulus(certificate: Any) -> None:
    """Change an entry of a subspace by the modulus, so that the identity holds only modulo it."""
    witness = certificate["witness"]
    subspace = witness["subspaces"][0]
    rows = subspace["U"]["coefficients"][0]
    free = next(k for k in range(len(rows)) if k not in subspace["pivots"])
    rows[free][0] += witness["modulus"] * subspace["U"]["denominator"]


def _dumps(document: Any) -> bytes:
    """JSON text, in which the odd numbers stand bare."""
    parts = json.dumps(document).split(f'"{_NUMBER}')
    bare = parts[0]
    for part in parts[1:]:
        number, _, rest = part.partition('"')
        bare += number + rest
    return bytes(bare, "utf-8")


def arguments(entry: Entry, folder: Path, documents: dict[str, Any]) -> list[str]:
    """Write the files that an entry uses into a folder, and return its arguments."""
    swapped = copy.deepcopy(documents["system"])
    swapped["channels"].reverse()
    files = {
        "input": lambda: content(entry, documents),
        "system": lambda: _dumps(documents["system"]),
        "plant": lambda: _dumps(documents["plant"]),
        "certificate": lambda: _dumps(documents["certificate"]),
        "swapped": lambda: _dumps(swapped),
    }
    (folder / "link.json").symlink_to(folder / "system.json")
    found = []
    for argument in entry["argv"]:
        for name, make in files.items():
            if f"{{{name}}}" in argument:
                path = folder / f"{name}.json"
                path.write_bytes(make())
                argument = argument.replace(f"{{{name}}}", str(path))
        found.append(argument.replace("{folder}", str(folder)))
    return found
