"""JSON Schemas of answers, from the types of the fields that declare them.

A certificate has the claims and the witness of its kind.  The view of an answer in ``--json`` has
the claims and what is shown besides.
"""

from __future__ import annotations

import dataclasses
import types
import typing
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache, cached_property
from typing import Any, Literal, Union, get_args, get_origin

from mcexact.answer.protocol import (
    Answer,
    Part,
    all_kinds,
    fields_of,
    is_optional,
    key_of,
    shown_of,
)
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial

Schema = dict[str, Any]
Form = Literal["certificate", "view"]

RATIONAL: Schema = {
    "description": "an exact number: an integer, or a quotient in lowest terms as a text",
    "anyOf": [{"type": "integer"}, {"type": "string", "pattern": r"^-?[0-9]+(/[0-9]+)?$"}],
}
_INTEGERS = {"type": "array", "items": {"type": "array", "items": {"type": "integer"}}}
_RATIONALS: Schema = {"type": "array", "items": RATIONAL}
_EXACT: dict[tuple[type, Form], Schema] = {
    (Polynomial, "certificate"): _RATIONALS,
    (Polynomial, "view"): _RATIONALS,
    (Matrix, "certificate"): {
        "type": "object",
        "properties": {"denominator": {"type": "integer", "minimum": 1}, "entries": _INTEGERS},
        "required": ["denominator", "entries"],
        "additionalProperties": False,
    },
    (Matrix, "view"): {"type": "array", "items": _RATIONALS},
    (PolynomialMatrix, "certificate"): {
        "type": "object",
        "properties": {
            "denominator": {"type": "integer", "minimum": 1},
            "coefficients": {"type": "array", "items": _INTEGERS},
        },
        "required": ["denominator", "coefficients"],
        "additionalProperties": False,
    },
}
_PLAIN: dict[Any, Schema] = {
    bool: {"type": "boolean"},
    int: {"type": "integer"},
    str: {"type": "string"},
    Fraction: RATIONAL,
    type(None): {"type": "null"},
    Any: {},
}


@cache
def kinds() -> dict[str, type[Answer]]:
    """Every kind of answer, by name."""
    return all_kinds()


def claim_schema(kind: type[Answer]) -> Schema:
    """The schema of the ``claim`` of a kind's certificates."""
    return _of_fields(kind, fields_of(kind, "claim"), "certificate")


def witness_schema(kind: type[Answer]) -> Schema:
    """The schema of the ``witness`` of a kind's certificates."""
    fields = fields_of(kind, "witness")
    whole = [each for each in fields if each.metadata["whole"]]
    if whole:
        return of_type(typing.get_type_hints(kind)[whole[0].name], "certificate")
    return _of_fields(kind, fields, "certificate")


def view_schema(kind: type[Answer]) -> Schema:
    """The schema of the view of a kind in ``--json``; ``certificate`` names its file."""
    typed = _typed(kind, fields_of(kind, "claim"))
    for name in shown_of(kind):
        shown = vars(kind)[name]
        get = shown.func if isinstance(shown, cached_property) else shown.fget
        typed[name] = typing.get_type_hints(get)["return"]
    schema = _object(typed | {"certificate": str}, "view")
    return _without_optional(schema, fields_of(kind, "claim"))


def view_schemas(kind: type[Answer]) -> list[Schema]:
    """The schema of the view, and that of an answer about a dual system, if it has other keys."""
    schema = view_schema(kind)
    if not kind.dual_keys:
        return [schema]
    named = {kind.dual_keys.get(key, key): each for key, each in schema["properties"].items()}
    required = [kind.dual_keys.get(key, key) for key in schema["required"]]
    return [schema, schema | {"properties": named, "required": required}]


def _typed(kind: type[Any], fields: Sequence[dataclasses.Field[Any]]) -> dict[str, Any]:
    """The keys of some fields with the types of their values."""
    hints = typing.get_type_hints(kind)
    return {key_of(each): hints[each.name] for each in fields}


def _of_fields(kind: type[Any], fields: Sequence[dataclasses.Field[Any]], form: Form) -> Schema:
    """The schema of an object with the keys of these fields."""
    return _without_optional(_object(_typed(kind, fields), form), fields)


def _without_optional(schema: Schema, fields: Sequence[dataclasses.Field[Any]]) -> Schema:
    """Make the keys of optional fields optional, and never null."""
    for key in (key_of(each) for each in fields if is_optional(each)):
        schema["required"].remove(key)
        [schema["properties"][key]] = [
            each for each in schema["properties"][key]["anyOf"] if each != _PLAIN[type(None)]
        ]
    return schema


def _object(typed: Mapping[str, Any], form: Form) -> Schema:
    """The schema of an object that has exactly these keys."""
    return {
        "type": "object",
        "properties": {key: of_type(hint, form) for key, hint in typed.items()},
        "required": list(typed),
        "additionalProperties": False,
    }


def of_type(hint: Any, form: Form) -> Schema:
    """The schema of the values of a type, as certificates or views have them.

    Raises
    ------
    TypeError
        If no value of this type is in an answer.

    Examples
    --------
    >>> of_type(tuple[int, ...], "view")
    {'type': 'array', 'items': {'type': 'integer'}}
    """
    if hint in _PLAIN:
        return _PLAIN[hint]
    if (hint, form) in _EXACT:
        return _EXACT[hint, form]
    origin, parts = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return {"anyOf": [of_type(each, form) for each in parts]}
    if origin is Literal:
        return {"enum": list(parts)}
    if origin is tuple and parts[-1] is not Ellipsis:
        items = [of_type(each, form) for each in parts]
        return {"type": "array", "prefixItems": items, "items": False, "minItems": len(items)}
    if origin in (tuple, list, Sequence):
        return {"type": "array", "items": of_type(parts[0], form)}
    if origin in (dict, Mapping):
        return {"type": "object", "additionalProperties": of_type(parts[1], form)}
    if isinstance(hint, type) and issubclass(hint, Part):
        return _of_fields(hint, dataclasses.fields(hint), form)
    if isinstance(hint, type) and issubclass(hint, Answer):  # a part of another answer
        return {
            "type": "object",
            "properties": {"claim": claim_schema(hint), "witness": witness_schema(hint)},
            "required": ["claim", "witness"],
            "additionalProperties": False,
        }
    raise TypeError(f"no schema is known for values of the type {hint}")
