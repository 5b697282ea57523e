"""Validation of files and of the JSON of commands against the shipped schemas."""

import json
from functools import cache
from typing import Any

from jsonschema import Draft202012Validator

from mcexact.report.schema import schema_text


@cache
def validator(name: str) -> Draft202012Validator:
    """The validator of a schema."""
    return Draft202012Validator(json.loads(schema_text(name)))


def faults(name: str, document: Any) -> list[str]:
    """What a document has that its schema does not allow, with the places."""
    return [
        f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message[:300]}"
        for error in validator(name).iter_errors(document)
    ]
