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

from mcexact.answer.schema import RATIONAL, Schema, claim_schema, kinds, view_schema, witness_schema
from mcexact.errors import UsageError
from mcexact.model.names import nearest, quoted

FOLDER = Path(__file__).with_name("schemas")
_DIALECT = "https://json-schema.org/draft/2020-12/schema"

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


def _matrix(entry: Schema, says: str) -> Schema:
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
MATRIX = _matrix(NUMBER, _MATRIX)
NEIGHBORS = table(rows(NAME)) | {
    "description": "for each agent those whose messages it receives; others receive nothing"
}
DELAYS = table(table(WHOLE)) | {"description": "the steps that messages take, receiver by receiver"}


def _uncertainty() -> Schema:
    """How far the entries of a system may be from their values, in one of three ways."""
    by_channel = table(MATRIX)
    radii = record(
        {},
        {
            "relative": NUMBER | {"description": "each radius is this part of the entry's modulus"},
            "digits": {"const": "as typed"},
            "absolute": record({}, {"A": MATRIX, "B": by_channel, "C": by_channel}, closed=True),
        },
        closed=True,
        says="how far entries may be from their values; an entry without a radius is certain",
    )
    return radii | {"minProperties": 1, "maxProperties": 1}


def _system() -> Schema:
    channel = {"name": NAME | {"description": "by default the number of the channel"}}
    exact = record(
        named("mcexact-system/1")
        | {
            "time": TIME,
            "A": MATRIX,
            "channels": rows(
                record({"B": MATRIX, "C": MATRIX}, channel | {"D": MATRIX}, closed=True),
                minItems=1,
            ),
        },
        {
            "name": TEXT | {"maxLength": 10_000},
            "source": TEXT | {"maxLength": 10_000},
            "sample_time": NUMBER,
            "neighbors": NEIGHBORS,
            "delays": DELAYS,
            "D": MATRIX,
            "uncertainty": _uncertainty(),
        },
        closed=True,
        says="a plant x' = A x + B_1 u_1 + …, y_i = C_i x (discrete time: x(t+1))",
    )
    entry = {"anyOf": [{"type": "number"}, {"type": "string", "minLength": 1}]}
    functions = _matrix(entry, 'a matrix of numbers and expressions such as "1/2 + 3*t^2"')
    ends = rows(some(NUMBER), minItems=2, maxItems=2)
    parametric = record(
        named("mcexact-system/1")
        | {
            "time": TIME,
            "parameters": table(record({}, {"range": ends}, closed=True)) | {"minProperties": 1},
            "A": functions,
            "channels": rows(
                record({"B": functions, "C": functions}, channel, closed=True), minItems=1
            ),
        },
        {"name": TEXT | {"maxLength": 10_000}, "source": TEXT | {"maxLength": 10_000}},
        closed=True,
        says="a plant whose entries are rational functions of parameters",
    )
    return {
        "type": "object",
        "if": {"required": ["parameters"]},
        "then": parametric,
        "else": exact,
    }


def _agents() -> Schema:
    linear = record(
        {},
        {
            "outputs": table(MATRIX) | {"description": "the coefficients of y_j, by the agent j"},
            "shared": table(MATRIX) | {"description": "the coefficients of x_j, by the agent j"},
            "private": MATRIX | {"description": "the coefficients of z_i"},
            "reference": MATRIX | {"description": "the coefficients of the set-points r_i"},
        },
        closed=True,
    )
    agent = record(
        {
            "name": NAME,
            "shared": WHOLE | {"description": "the dimension of x_i, which followers receive"},
            "private": WHOLE | {"description": "the dimension of z_i, which nobody receives"},
            "shared_update": linear,
            "private_update": linear,
            "input": linear,
        },
        {"hold": table(WHOLE)},
        closed=True,
    )
    return {"time": TIME, "agents": rows(agent, minItems=1)}


def _controller() -> Schema:
    system = {"system": TEXT | {"description": "the digest of the plant, or an empty text"}}
    return record(named("mcexact-controller/1") | system | _agents(), closed=True)


def _certificate() -> Schema:
    """A certificate of any kind; claim and witness are those of its kind."""
    head = record(
        named("mcexact-certificate/1")
        | {
            "kind": {"enum": list(kinds())},
            "system": {"anyOf": [{"type": "object"}, DIGEST]},
            "subject": rows(record({"construction": TEXT})),
            "claim": {"type": "object"},
            "witness": {"type": "object"},
        },
        closed=True,
    )
    cases = [
        {
            "if": {"properties": {"kind": {"const": name}}},
            "then": {"properties": {"claim": claim_schema(kind), "witness": witness_schema(kind)}},
        }
        for name, kind in kinds().items()
    ]
    return head | {"allOf": cases}


def _manifest() -> Schema:
    because = {"type": "array", "prefixItems": [TEXT, TEXT, {}], "items": False, "minItems": 3}
    sentence = record(
        {"text": TEXT, "rule": TEXT, "theorem": TEXT, "because": rows(because)}, closed=True
    )
    return record(
        named("mcexact-manifest/1")
        | {"certificates": table(DIGEST), "sentences": rows(sentence, minItems=1)},
        {"subject": rows(record({"construction": TEXT}))},
        closed=True,
    )


SENTENCES: Schema = {
    "answer": rows(TEXT) | {"description": "the sentences that answer the question"},
    "sentences": rows(record({"text": TEXT, "rule": TEXT, "theorem": TEXT})),
    "re_checked": record(
        {"valid": WHOLE, "open": rows({})},
        says="how many certificates the independent checker accepted, and which it left open",
    ),
}
_SYSTEM_IN_SHORT = record(
    {"name": some(TEXT), "n": WHOLE, "m": WHOLE, "time": TIME, "channels": rows(TEXT)}
)


def _account(required: Schema, optional: Schema | None = None) -> Schema:
    """The JSON of a command whose answers have certificates."""
    known = named("mcexact-analysis/1") | {"system": _SYSTEM_IN_SHORT} | SENTENCES
    views = [view_schema(kind) for kind in kinds().values()]
    return record(known | required, optional) | {
        "additionalProperties": {
            "description": "an answer, by its name; its certificate is the file of this name",
            "if": {"type": "object", "required": ["certificate"]},
            "then": {"anyOf": views},
        }
    }


_FIGURES = table({"type": ["number", "null", "integer"]})
ASSESSMENT = record(
    {"basis": TEXT, "install": TEXT, "verdict": TEXT, "warnings": rows(TEXT), "notes": rows(TEXT)},
    {
        "states_of_each_agent": table(WHOLE),
        "order": FLOAT,
        "largest_gain": some(FLOAT),
        "bound": some(FLOAT),
        "margin": some(FLOAT),
        "peak": some(FLOAT),
        "cost": some(FLOAT),
        "relative_cost": some(FLOAT),
        "digits_that_suffice": some(WHOLE),
        "without_a_controller": some(_FIGURES),
        "links": rows(record({"sender": TEXT, "receiver": TEXT, "numbers": WHOLE})),
    },
    says="figures of the loop, computed in floating point and not certified",
)


def _design() -> Schema:
    made = {
        "method": TEXT,
        "arithmetic": TEXT,
        "order": WHOLE,
        "certified_bound": some(TEXT),
        "closed_loop_polynomial": some(rows(TEXT)),
        "bits_of_longest_number": WHOLE,
        "floating_point": _FIGURES,
        "controller": record(_agents(), closed=True),
        "assessment": ASSESSMENT,
    }
    parts: Schema = {
        key: {}
        for key in (
            "agent", "network", "dimensions", "observer_order", "feedback_polynomial",
            "error_polynomial", "blocks", "kept",
        )
    }  # fmt: skip
    refused = {"possible": {"const": False}, "reason": TEXT}
    schema = _account({"design": TEXT}, made | parts | refused)
    return schema | {
        "if": {"required": ["possible"]},
        "then": {"required": ["reason"]},
        "else": {"required": list(made)},
    }


def _certify() -> Schema:
    return _account(
        {
            "certified": YES,
            "region": TEXT,
            "bound": some(TEXT),
            "method": TEXT,
            "states": WHOLE,
            "blocks": rows(WHOLE),
            "largest": some(TEXT),
            "warnings": rows(TEXT),
            "rounded_to_digits": some(WHOLE),
            "assessment": ASSESSMENT,
        }
    )


def _analyze() -> Schema:
    question = record({"question": TEXT, "outcome": TEXT, "seconds": some(FLOAT)}, {"reason": TEXT})
    return _account({"information": {"enum": ["own", "outputs"]}, "questions": rows(question)})


def _simulate() -> Schema:
    return {
        "description": "a run of the loop: times, and the signals of the plant and of each agent",
        "type": "object",
        "properties": named("mcexact-analysis/1") | {"system": _SYSTEM_IN_SHORT},
        "required": ["format", "time", "arithmetic", "times", "state", "agents"],
    }


def _allocate() -> Schema:
    return _account({})


def _check() -> Schema:
    verdict = record(
        {
            "verdict": {
                "enum": ["VALID", "INVALID", "MALFORMED", "INCOMPLETE", "IMPLIED", "COUNTED"]
            },
            "statement": TEXT,
            "statement_digest": TEXT,
            "system_digest": TEXT,
            "controller_digest": TEXT,
            "code": TEXT,
            "place": TEXT,
            "message": TEXT,
            "spent": WHOLE,
        }
    )
    return record(named("mcexact-verdicts/1") | {"verdicts": rows(verdict)})


def _crosscheck() -> Schema:
    row = record(
        {"question": TEXT, "call": TEXT, "floating": TEXT, "exact": TEXT, "agree": some(YES)}
    )
    libraries = record({"versions": table(TEXT), "kernel": TEXT})
    return record(
        named("mcexact-crosscheck/1"),
        {
            "libraries": libraries,
            "system": record({"n": WHOLE, "m": WHOLE, "time": TIME}),
            "rows": rows(row),
            "disagreements": rows({}),
            "exhibits": rows({}),
            "floating_point": {"type": "object"},
        },
    )


def _demo() -> Schema:
    return record(
        named("mcexact-demo/1")
        | {
            "controllability": {"type": "object"},
            "fixed_modes": {"type": "object"},
            "numpy": record({"runs": WHOLE, "recorded": {"type": "object"}, "here": {}}),
        }
    )


def _error() -> Schema:
    return record(
        named("mcexact-error/1")
        | {
            "status": {"type": "integer", "description": "the exit status, as in mcexact --help"},
            "message": TEXT,
        },
        closed=True,
        says="what a command with --json prints in place of its document when it fails",
    )


def _gallery() -> Schema:
    plant = {"name": TEXT, "n": WHOLE, "m": WHOLE, "parameters": rows(TEXT), "time": TIME}
    plant |= {"source": TEXT, "shows": TEXT}
    return record(named("mcexact-gallery/1") | {"plants": rows(record(plant))})


def _sweep_record() -> Schema:
    claims = [claim_schema(kind) for kind in kinds().values()]
    answer = record({"claim": {"anyOf": claims}, "statement": TEXT}, closed=True)
    decided = {
        "system": record({"n": WHOLE, "m": WHOLE, "time": TIME}),
        "digest": DIGEST,
        "answers": table(answer),
        "seconds": FLOAT,
    }
    failed = {
        "error": record({"status": WHOLE, "message": TEXT}, {"other_format": YES}, closed=True)
    }
    return record(
        named("mcexact-sweep/1") | {"number": WHOLE, "name": TEXT, "key": TEXT},
        decided | failed,
        closed=True,
        says="a line of the file of a sweep: the answers about one system, or its error",
    ) | {
        "if": {"required": ["error"]},
        "else": {"required": list(decided)},
    }


def _sweep() -> Schema:
    skipped = record({"name": TEXT, "reason": TEXT}, closed=True)
    return record(
        named("mcexact-sweep-summary/1")
        | {"counts": table(WHOLE), "records": rows(_sweep_record()), "skipped": rows(skipped)}
    )


def _reproduce() -> Schema:
    statement = record(
        {"number": WHOLE, "section": TEXT, "says": TEXT, "status": TEXT, "holds": YES}
    )
    examination = record(
        {"key": TEXT, "title": TEXT, "section": TEXT, "holds": YES, "status": TEXT}
    )
    return record(
        named("mcexact-reproduction/1")
        | {
            "holds": YES,
            "counts": table(WHOLE),
            "statements": rows(statement),
            "examinations": rows(examination),
        }
    )


DOCUMENTS = {
    "system": (_system, "system files: the plants that users write"),
    "controller": (_controller, "controller files: a program for each agent"),
    "certificate": (_certificate, "certificates: a claim about a plant with its proof"),
    "manifest": (_manifest, "manifests: sentences with the certificates that imply them"),
    "sweep-record": (_sweep_record, "the lines of the file that a sweep writes"),
    "analyze": (_analyze, "mcexact analyze --json"),
    "allocate": (_allocate, "mcexact allocate --json"),
    "design": (_design, "mcexact design … --json, also where no controller exists"),
    "certify": (_certify, "mcexact certify --json"),
    "simulate": (_simulate, "mcexact simulate --json"),
    "check": (_check, "mcexact check --json"),
    "crosscheck": (_crosscheck, "mcexact crosscheck --json"),
    "sweep": (_sweep, "mcexact sweep --json"),
    "reproduce": (_reproduce, "mcexact reproduce --json"),
    "demo": (_demo, "mcexact demo --json"),
    "gallery": (_gallery, "mcexact gallery --json"),
    "error": (_error, "every command with --json that fails"),
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
