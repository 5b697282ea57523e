"""The terms of which schemas are made: texts, numbers, matrices, tables and records."""

from __future__ import annotations

from typing import Any

from mcexact.answer.schema import Schema

TEXT: Schema = {"type": "string"}
WHOLE: Schema = {"type": "integer", "minimum": 0}
YES: Schema = {"type": "boolean"}
FLOAT: Schema = {"type": "number"}
DIGEST: Schema = {"type": "string", "pattern": "^[0-9a-f]{64}$"}
TIME: Schema = {"enum": ["continuous", "discrete"]}
NAME: Schema = {"type": "string", "minLength": 1, "maxLength": 256}
NUMBER: Schema = {
    "description": 'an exact number as typed: 2, -0.5, 1e-3, "0.1" or "1/3"',
    "anyOf": [
        {"type": "number"},
        {"type": "string", "pattern": r"^-?([0-9]+/[0-9]+|[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?)$"},
    ],
}


def some(schema: Schema) -> Schema:
    """A value or null."""
    return {"anyOf": [schema, {"type": "null"}]}


def rows(schema: Schema, **more: Any) -> Schema:
    """A list."""
    return {"type": "array", "items": schema, **more}


def table(schema: Schema) -> Schema:
    """An object with any keys."""
    return {"type": "object", "additionalProperties": schema}


def record(
    required: Schema, optional: Schema | None = None, *, closed: bool = False, says: str = ""
) -> Schema:
    """An object with some keys, and others unless it is closed."""
    made: Schema = {"description": says} if says else {}
    made |= {
        "type": "object",
        "properties": required | (optional or {}),
        "required": list(required),
    }
    return made | ({"additionalProperties": False} if closed else {})


def named(format_name: str) -> Schema:
    """The key ``format`` with its value."""
    return {"format": {"const": format_name}}


def matrix(entry: Schema, says: str) -> Schema:
    """A matrix in either of its two forms."""
    return {
        "description": says,
        "anyOf": [
            rows(rows(entry)),
            record(
                {
                    "shape": rows(WHOLE, minItems=2, maxItems=2),
                    "entries": rows(
                        {"type": "array", "prefixItems": [WHOLE, WHOLE, entry], "items": False,
                         "minItems": 3}
                    ),
                },
                closed=True,
            ),
        ],
    }  # fmt: skip


_MATRIX = "rows of numbers, or the shape and the entries [row, column, value] that are not 0"
MATRIX = matrix(NUMBER, _MATRIX)
