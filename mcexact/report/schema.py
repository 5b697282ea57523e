"""JSON Schemas (2020-12) of every file and of the JSON of every command.

What users write, and certificates, have exactly the keys that are named.  What commands print can
get further keys within a version, and programs that read it ignore those that they do not know.
"""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from mcexact.answer.schema import RATIONAL, Schema
from mcexact.errors import UsageError
from mcexact.model.text import nearest, quoted
from mcexact.report import command_schemas as commands
from mcexact.report import file_schemas as files
from mcexact.report.schema_terms import MATRIX, NUMBER

FOLDER = Path(__file__).with_name("schemas")
_DIALECT = "https://json-schema.org/draft/2020-12/schema"

DOCUMENTS = {
    "system": (files.system, "system files: the plants that users write"),
    "controller": (files.controller, "controller files: a program for each agent"),
    "certificate": (files.certificate, "certificates: a claim about a plant with its proof"),
    "manifest": (files.manifest, "manifests: sentences with the certificates that imply them"),
    "sweep-record": (files.sweep_record, "the lines of the file that a sweep writes"),
    "analyze": (commands.analyze, "mcexact analyze --json"),
    "analyze-parameters": (
        commands.analyze_parameters,
        "mcexact analyze --json about a system with parameters",
    ),
    "allocate": (commands.allocate, "mcexact allocate --json"),
    "design": (commands.design, "mcexact design … --json, also where no controller exists"),
    "certify": (commands.certify, "mcexact certify --json"),
    "certify-parameters": (
        commands.certify_parameters,
        "mcexact certify --json about a system with parameters",
    ),
    "simulate": (commands.simulate, "mcexact simulate --json"),
    "check": (commands.check, "mcexact check --json"),
    "crosscheck": (commands.crosscheck, "mcexact crosscheck --json"),
    "sweep": (commands.sweep, "mcexact sweep --json"),
    "reproduce": (commands.reproduce, "mcexact reproduce --json"),
    "demo": (commands.demo, "mcexact demo --json"),
    "gallery": (commands.gallery, "mcexact gallery --json"),
    "error": (commands.error, "every command with --json that fails"),
}
"""The documents with their makers, and what each describes.  `sample`, `convert` and `c2d` print
system files."""


@cache
def made(name: str) -> str:
    """The text of a schema, made from its declaration."""
    maker, title = DOCUMENTS[name]
    head = {"$schema": _DIALECT, "title": f"mcexact {name}: {title}"}
    return json.dumps(_shared(head | maker()), indent=1, ensure_ascii=True) + "\n"


_SHARED = {"rational": RATIONAL, "number": NUMBER, "matrix": MATRIX}


def _shared(schema: Schema) -> Schema:
    """The schema with what occurs often written once."""
    found = {name: each for name, each in _SHARED.items() if _occurs(each, schema)}
    if not found:
        return schema
    definitions = {
        name: {key: _replaced(value, found) for key, value in each.items()}
        for name, each in found.items()
    }
    replaced: Schema = _replaced(schema, found)
    return replaced | {"$defs": definitions}


def _occurs(part: Schema, value: Any) -> bool:
    if value == part:
        return True
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return any(_occurs(part, each) for each in inner)


def _replaced(value: Any, shared: dict[str, Schema]) -> Any:
    for name, each in shared.items():
        if value == each:
            return {"$ref": f"#/$defs/{name}"}
    if isinstance(value, dict):
        return {key: _replaced(each, shared) for key, each in value.items()}
    return [_replaced(each, shared) for each in value] if isinstance(value, list) else value


def schema_text(name: str) -> str:
    """The text of a shipped schema.

    Raises
    ------
    UsageError
        If there is none of this name.

    Examples
    --------
    >>> json.loads(schema_text("error"))["required"]
    ['format', 'status', 'message']
    """
    if name not in DOCUMENTS:
        hint = nearest(name, DOCUMENTS) or f"; known are {', '.join(DOCUMENTS)}"
        raise UsageError(f"there is no schema {quoted(name)}{hint}")
    return resources.files(__package__).joinpath("schemas", f"{name}.json").read_text("utf-8")


def main() -> None:
    """Write all schemas into their folder."""
    FOLDER.mkdir(exist_ok=True)
    for path in FOLDER.glob("*.json"):
        path.unlink()
    for name in DOCUMENTS:
        (FOLDER / f"{name}.json").write_text(made(name), encoding="utf-8")


if __name__ == "__main__":
    main()
