"""The schemas of files: systems, controllers, certificates, manifests and records of sweeps.

They have exactly the keys that are named.
"""

from __future__ import annotations

from mcexact.answer.schema import Schema, claim_schema, kinds, witness_schema
from mcexact.report.schema_terms import (
    DIGEST,
    FLOAT,
    MATRIX,
    NAME,
    NUMBER,
    TEXT,
    TIME,
    WHOLE,
    YES,
    matrix,
    named,
    record,
    rows,
    some,
    table,
)

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


def system() -> Schema:
    """System files."""
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
    functions = matrix(entry, 'a matrix of numbers and expressions such as "1/2 + 3*t^2"')
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


def agents() -> Schema:
    """The time domain and the agents of a controller."""
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


def controller() -> Schema:
    """Controller files."""
    system = {"system": TEXT | {"description": "the digest of the plant, or an empty text"}}
    return record(named("mcexact-controller/1") | system | agents(), closed=True)


def certificate() -> Schema:
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


def manifest() -> Schema:
    """Manifests."""
    because = {"type": "array", "prefixItems": [TEXT, TEXT, {}], "items": False, "minItems": 3}
    sentence = record(
        {"text": TEXT, "rule": TEXT, "theorem": TEXT, "because": rows(because)}, closed=True
    )
    return record(
        named("mcexact-manifest/1")
        | {"certificates": table(DIGEST), "sentences": rows(sentence, minItems=1)},
        {"subject": rows(record({"construction": TEXT})), "nearby": rows(TEXT)},
        closed=True,
    )


def sweep_record() -> Schema:
    """A line of the file that a sweep writes."""
    claims = [claim_schema(kind) for kind in kinds().values()]
    answer = record(
        {"claim": {"anyOf": claims}, "statement": TEXT}, {"member": {"type": "object"}}, closed=True
    )
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
