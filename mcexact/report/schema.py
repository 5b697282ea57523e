"""JSON Schemas of files and of what commands print.

Every file format and every ``--json`` output has a JSON Schema (2020-12), declared by a function
(`DOCUMENTS`), so that the schemas share their terms.  `main` writes them into the folder from which
they ship.

Files (systems, controllers, certificates, manifests, records of sweeps) have exactly the keys that
are named.  What commands print can get further keys within a version, and programs that read it
ignore the keys that they do not know.
"""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, get_args

from mcexact.answer.account import LABELS
from mcexact.answer.nearby import LOST
from mcexact.answer.parameters import WITHIN_RANGES
from mcexact.answer.schema import (
    RATIONAL,
    Schema,
    claim_schema,
    kinds,
    view_schemas,
    witness_schema,
)
from mcexact.errors import UsageError
from mcexact.exact.matrix import Rounding
from mcexact.model.text import nearest, quoted

# Terms that the schemas share.

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
    schema: Schema = {"description": says} if says else {}
    schema |= {
        "type": "object",
        "properties": required | (optional or {}),
        "required": list(required),
    }
    return schema | ({"additionalProperties": False} if closed else {})


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


LIMITS = rows(some(rows(NUMBER, minItems=2, maxItems=2)))
"""Limits of the inputs of an agent; null for an input without limits."""

# The schemas of files: systems, controllers, certificates, manifests and records of sweeps.

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


def _typical_sizes() -> Schema:
    """How large the signals of a system typically are."""
    numbers = rows(NUMBER)
    by_channel = table(numbers)
    return record(
        {},
        {
            "states": numbers | {"description": "of each state; by default 1"},
            "inputs": by_channel | {"description": "of the inputs of each channel; by default 1"},
            "errors": by_channel
            | {"description": "of the sensors of each channel; by default 1/10"},
            "disturbances": NUMBER | {"description": "r; by default 1"},
        },
        closed=True,
        says="typical sizes x and u and errors e, from which costs have the weights Q = 1/x^2, "
        "R = 1/u^2, W = r x^2 and V = e^2",
    )


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
            "regulated": table(
                {"anyOf": [rows({"type": "integer", "minimum": 1}, minItems=1), MATRIX]}
            ),
            "limits": table(LIMITS)
            | {"description": "the least and the largest value of each input of a channel"},
            "sizes": _typical_sizes(),
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


def periodic_controller() -> Schema:
    """Files of periodic controllers."""
    system = {"system": TEXT | {"description": "the digest of the plant, or an empty text"}}
    phase = record({"agents": agents()["agents"]}, closed=True)
    phases = {"time": {"const": "discrete"}, "phases": rows(phase, minItems=1)}
    return record(named("mcexact-periodic-controller/1") | system | phases, closed=True)


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
    beside = record(
        {
            "lost": {"enum": [*LOST]},
            "part": NUMBER,
            "within": {"enum": ["rounding", "digits"]},
            "text": TEXT,
            "statement": TEXT,
        },
        closed=True,
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
        decided | failed | {"nearby": rows(beside)},
        closed=True,
        says="a line of the file of a sweep: the answers about one system, or its error",
    ) | {
        "if": {"required": ["error"]},
        "else": {"required": list(decided)},
    }


# The schemas of what commands print with ``--json``.

SENTENCES: Schema = {
    "answer": rows(TEXT) | {"description": "the sentences that answer the question"},
    "sentences": rows(record({"text": TEXT, "rule": TEXT, "theorem": TEXT})),
    "re_checked": record(
        {"valid": WHOLE, "open": rows({})},
        says="how many certificates the independent checker accepted, and which it left open",
    ),
}
_READ = "how the floats of the file were read, if it has floats that are no integers"
_SYSTEM_IN_SHORT = record(
    {"name": some(TEXT), "n": WHOLE, "m": WHOLE, "time": TIME, "channels": rows(TEXT)},
    {"rounding": {"enum": list(get_args(Rounding))} | {"description": _READ}},
)


_RANGES = table(record({}, {"range": rows(some(NUMBER), minItems=2, maxItems=2)}, closed=True))
"""Parameters with their ranges."""


def _account(required: Schema, optional: Schema | None = None) -> Schema:
    """The JSON of a command whose answers have certificates."""
    known = named("mcexact-analysis/1") | {"system": _SYSTEM_IN_SHORT} | SENTENCES
    views = [view for kind in kinds().values() for view in view_schemas(kind)]
    return record(known | required, optional) | {
        "additionalProperties": {
            "description": "an answer, by its name; its certificate is the file of this name",
            "if": {"type": "object", "required": ["certificate"]},
            "then": {"anyOf": views},
        }
    }


_FIGURES = table({"type": ["number", "null", "integer"]})
PERFORMANCE = record(
    {
        "cost_over_bound": some(NUMBER),
        "least_single_margin": some(NUMBER),
        "weakest": TEXT,
        "proved": rows(TEXT),
        "computed": table(some(FLOAT)),
        "left_out": table(TEXT),
    },
    closed=True,
    says="the proved cost beside a bound for every controller, and the least disk margin of a "
    "single input or output; figures in floating point, and why some are not proved",
)
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
        "performance": some(PERFORMANCE),
        "digits_that_suffice": some(WHOLE),
        "weights_of_the_cost": TEXT,
        "without_a_controller": some(_FIGURES),
        "links": rows(record({"sender": TEXT, "receiver": TEXT, "numbers": WHOLE})),
    },
    says="figures of the loop, computed in floating point and not certified",
)


LONGEST_STEP = record(
    {"step": some(NUMBER), "margin": NUMBER, "proved": YES, "not_found": some(NUMBER)},
    {"left_out": TEXT},
    closed=True,
    says="the longest step, of those that were tried, with which the same controller has a disk "
    "margin at every single input and output",
)
EVERY_LOOP = record(
    {"certified": YES, "region": TEXT},
    {
        "part": some(NUMBER),
        "gains": some(NUMBER),
        "fails_within": some(NUMBER),
        "failing": some({"type": "object"}),
        "margins": some(
            record(
                {"part": some(NUMBER), "inputs": some(NUMBER), "outputs": some(NUMBER)},
                says="disk margins of single inputs and outputs for every plant in a box",
            )
        ),
        "reason": some(TEXT),
    },
    says="what is proved of all loops in a box around the plant, and a plant whose loop fails",
)


def design() -> Schema:
    """The JSON of `mcexact design`."""
    designed = {
        "method": TEXT,
        "arithmetic": TEXT,
        "order": WHOLE,
        "certified_bound": some(TEXT),
        "region": TEXT,
        "closed_loop_polynomial": some(rows(RATIONAL)),
        "bits_of_longest_number": WHOLE,
        "floating_point": _FIGURES,
        "controller": record(agents(), closed=True),
        "assessment": ASSESSMENT,
        "first_line": TEXT,
    }
    parts: Schema = {
        key: {}
        for key in (
            "agent", "network", "dimensions", "observer_order", "feedback_polynomial",
            "error_polynomial", "blocks", "kept", "followed",
        )
    }  # fmt: skip
    refused = {"possible": {"const": False}, "reason": TEXT}
    periodic = {
        **{key: designed[key] for key in ("order", "region", "first_line")},
        "period": WHOLE,
        "periodic_controller": periodic_controller(),
        "notes": rows(TEXT),
    }
    more = {"every_loop": EVERY_LOOP, "longest_step": LONGEST_STEP}
    schema = _account({"design": TEXT}, designed | parts | refused | periodic | more)
    return schema | {
        "if": {"required": ["possible"]},
        "then": {"required": ["reason"]},
        "else": {
            "if": {"properties": {"design": {"const": "periodic"}}},
            "then": {"required": list(periodic)},
            "else": {"required": list(designed)},
        },
    }


_LARGEST = record(
    {
        "property": TEXT,
        "relative": YES,
        "lower": NUMBER,
        "upper": some(TEXT),
        "failing": some({"type": "object"}),
        "channels": some(rows(TEXT)),
    }
)


def certify() -> Schema:
    """The JSON of `mcexact certify`."""
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
            "eigenvalue_outside": some(record({"re": TEXT, "im": TEXT, "radius": TEXT})),
            "first_line": TEXT,
        },
        {
            "period": WHOLE,
            "assessment": ASSESSMENT,
            "every_loop": EVERY_LOOP,
            "largest_uncertainty": _LARGEST,
            "safe_digits": record({"safe": some(WHOLE), "too_few": some(WHOLE)}),
        },
    )


def certify_parameters() -> Schema:
    """The JSON of `mcexact certify` about a system with parameters."""
    largest = record(
        {
            "property": TEXT,
            "lower": NUMBER,
            "ranges": some(_RANGES),
            "upper": some(NUMBER),
            "failing": some(table(NUMBER)),
        },
        says="a part of the ranges that is proved, and values at which the loop fails",
    )
    return _account(
        {
            "certified": YES,
            "refuted": YES,
            "region": TEXT,
            "bound": some(TEXT),
            "parameters": _RANGES,
            "largest_ranges": largest,
            "warnings": rows(TEXT),
        }
    )


_QUESTION = record({"question": TEXT, "outcome": TEXT, "seconds": some(FLOAT)}, {"reason": TEXT})


_FACTOR = rows(NUMBER)
_WHY_FIXED = record(
    {
        "by_zeros": rows(_FACTOR),
        "by_equalities": rows(_FACTOR),
        "laws": rows(record({"mode": _FACTOR, "certificate": TEXT}, closed=True)),
    },
    closed=True,
)
_LOST = {"enum": [*LOST]}
_NEARBY = record(
    {
        "searched": rows(_LOST),
        "plants": rows(
            record(
                {
                    "lost": _LOST,
                    "part": NUMBER,
                    "within": {"enum": ["rounding", "digits", None]},
                    "mode": rows(NUMBER),
                    "mode_about": TEXT,
                    "channels": rows(TEXT),
                    "certificate": TEXT,
                    "plant": {"type": "object"},
                },
                closed=True,
            )
        ),
        "computed_not_certified": rows(
            record(
                {"lost": _LOST, "mode": rows(FLOAT), "channels": rows(TEXT), "part": FLOAT},
                closed=True,
            )
        ),
    },
    closed=True,
    says="plants with the same zeros of which an answer is another one: what they lack, how far "
    "each entry is at most, and whether rounding errors or digits that were not typed explain that",
)


def analyze() -> Schema:
    """The JSON of `mcexact analyze`."""
    return _account(
        {"information": {"enum": ["own", "outputs"]}, "questions": rows(_QUESTION)},
        {
            "largest_uncertainty": _LARGEST,
            "failing_within_radii": table({"type": "object"}),
            "nearby": _NEARBY,
            "why_fixed": _WHY_FIXED,
        },
    )


def analyze_parameters() -> Schema:
    """Answers about a system with parameters, for all values."""
    row = record({"where": TEXT, "what": TEXT, "because": TEXT}, closed=True)
    line = record({"certificate": TEXT, "line": TEXT}, closed=True)
    answer = record({"rows": rows(row), "certificates": rows(TEXT)}, {"along": rows(line)})
    return record(
        named("mcexact-parametric-analysis/1")
        | {
            "system": _SYSTEM_IN_SHORT,
            "parameters": _RANGES,
            "questions": rows(_QUESTION),
            "table": rows(rows(TEXT)) | {"description": "labels, and what holds"},
            **SENTENCES,
        },
        dict.fromkeys((*LABELS, *WITHIN_RANGES), answer),
        closed=True,
        says="what holds for all values of parameters, and where something else",
    )


def simulate() -> Schema:
    """The JSON of `mcexact simulate`."""
    return {
        "description": "a run of the loop: times, and the signals of the plant and of each agent",
        "type": "object",
        "properties": named("mcexact-analysis/1")
        | {"system": _SYSTEM_IN_SHORT, "real": _real_loop()},
        "required": ["format", "time", "arithmetic", "times", "state", "agents"],
    }


def _real_loop() -> Schema:
    """The real loop beside the ideal one."""
    column = rows(FLOAT)
    converters = rows(some(record({"step": FLOAT, "low": some(FLOAT), "high": some(FLOAT)})))
    both = record({"ideal": some(FLOAT), "real": some(FLOAT)})
    agent = record(
        {"name": TEXT}
        | {
            name: rows(column)
            for name in ("outputs", "measured", "computed", "inputs", "reference")
        }
    )
    output = {"name": TEXT, "rest": some(FLOAT), "settled": both, "largest_distance": both}
    put = {"name": TEXT, "largest_modulus": both, "effort": both, "steps_at_a_limit": WHOLE}
    return record(
        {
            "step": some(FLOAT),
            "late": WHOLE,
            "code": TEXT,
            "limits": rows(rows(some(FLOAT), minItems=2, maxItems=2)),
            "quantized_outputs": converters,
            "quantized_inputs": converters,
            "times": column,
            "state": rows(column),
            "agents": rows(agent),
            "outputs": rows(record(output | {"apart": some(FLOAT)})),
            "inputs": rows(record(put)),
        },
        says="the loop as it is installed: at the samples, with limits, converters and code",
    )


def allocate() -> Schema:
    """The JSON of `mcexact allocate`."""
    sizes = record({"least": WHOLE, "bound": some(WHOLE)})
    meaning = "the least dimensions, and those of the theorem's bound where its hypotheses hold"
    return _account(
        {}, {"shares": record({"by_agent": table(sizes), "total": sizes}, says=meaning)}
    )


def check() -> Schema:
    """The JSON of `mcexact check`."""
    verdict = record(
        {
            "verdict": {
                "enum": [
                    *("VALID", "INVALID", "NOT ABOUT", "MALFORMED", "INCOMPLETE"),
                    *("IMPLIED", "REMARK", "COUNTED"),
                ]
            },
            "statement": TEXT,
            "statement_digest": TEXT,
            "summary": TEXT,
            "left_open": rows(rows(WHOLE)),
            "system_digest": TEXT,
            "controller_digest": TEXT,
            "code": TEXT,
            "place": TEXT,
            "message": TEXT,
            "spent": WHOLE,
        },
        {"verified": TEXT},
    )
    return record(named("mcexact-verdicts/1") | {"verdicts": rows(verdict)})


def crosscheck() -> Schema:
    """The JSON of `mcexact crosscheck`."""
    row = record(
        {
            "question": TEXT,
            "call": TEXT,
            "floating": TEXT,
            "exact": TEXT,
            "agree": some(YES),
            "within_data": YES,
        }
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
            "fixed_mode_nearby": some(
                record({"within": NUMBER, "channels": rows(TEXT), "plant": {"type": "object"}})
            ),
        },
    )


def demo() -> Schema:
    """The JSON of `mcexact demo`."""
    return record(
        named("mcexact-demo/1")
        | {
            "controllability": {"type": "object"},
            "fixed_modes": {"type": "object"},
            "numpy": record({"runs": WHOLE, "recorded": {"type": "object"}, "here": {}}),
        }
    )


def export() -> Schema:
    """The JSON of `mcexact export`: the sums of all agents."""
    term = {"type": "array", "prefixItems": [TEXT, FLOAT, TEXT], "minItems": 3, "maxItems": 3}
    sums = rows(rows(term))
    heard = record({"signal": {"enum": ["y", "x"]}, "of": NAME, "entries": WHOLE}, closed=True)
    agent = {"name": NAME, "outputs": WHOLE, "references": WHOLE, "receives": rows(heard)}
    agent |= {
        "sends x to": table(record({"held": WHOLE}, closed=True)),
        "uses its x held for": WHOLE,
        "u": sums,
        "next x": sums,
        "next z": sums,
        "limits": LIMITS,
        "start": some(sums) | {"description": "x, then z, for a start without a bump"},
    }
    return record(
        named("mcexact-code/1")
        | {"arithmetic": TEXT, "order": TEXT, "system": TEXT}
        | {"agents": rows(record(agent, closed=True))},
        {"fixed point": _fixed_point()},
        closed=True,
        says="what each agent computes in a step: [number, double, signal], added in this order",
    )


def _fixed_point() -> Schema:
    """The arithmetic of code in integers."""
    bits = {kind: {"type": "integer"} for kind in ("y", "r", "u", "x", "z")}
    return record(
        {
            "fractional bits of numbers": WHOLE,
            "fractional bits of signals": record(bits, closed=True),
        },
        closed=True,
    )


def error() -> Schema:
    """The JSON that a failing command prints."""
    return record(
        named("mcexact-error/1")
        | {
            "status": {"type": "integer", "description": "the exit status, as in mcexact --help"},
            "message": TEXT,
        },
        closed=True,
        says="what a command with --json prints in place of its document when it fails",
    )


def gallery() -> Schema:
    """The JSON of `mcexact gallery`."""
    plant = {"name": TEXT, "n": WHOLE, "m": WHOLE, "parameters": rows(TEXT), "time": TIME}
    plant |= {"source": TEXT, "shows": TEXT}
    return record(named("mcexact-gallery/1") | {"plants": rows(record(plant))})


def sweep() -> Schema:
    """The JSON of `mcexact sweep`."""
    skipped = record({"name": TEXT, "reason": TEXT}, closed=True)
    numbers = {"plants": WHOLE, "proved": WHOLE, "failing": WHOLE}
    tolerance = record({"question": TEXT, "part": NUMBER} | numbers, closed=True)
    return record(
        named("mcexact-sweep-summary/1")
        | {
            "counts": table(WHOLE),
            "tolerances": rows(tolerance),
            "records": rows(sweep_record()),
            "skipped": rows(skipped),
        }
    )


def reproduce() -> Schema:
    """The JSON of `mcexact reproduce`."""
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


# The table of all documents, and the files into which their schemas are written.

FOLDER = Path(__file__).with_name("schemas")
_DIALECT = "https://json-schema.org/draft/2020-12/schema"

DOCUMENTS = {
    "system": (system, "system files: the plants that users write"),
    "controller": (controller, "controller files: a program for each agent"),
    "periodic-controller": (
        periodic_controller,
        "files of periodic controllers: a program for each agent in each step of a period",
    ),
    "certificate": (certificate, "certificates: a claim about a plant with its proof"),
    "manifest": (manifest, "manifests: sentences with the certificates that imply them"),
    "sweep-record": (sweep_record, "the lines of the file that a sweep writes"),
    "analyze": (analyze, "mcexact analyze --json"),
    "analyze-parameters": (
        analyze_parameters,
        "mcexact analyze --json about a system with parameters",
    ),
    "allocate": (allocate, "mcexact allocate --json"),
    "design": (design, "mcexact design … --json, also where no controller exists"),
    "certify": (certify, "mcexact certify --json"),
    "certify-parameters": (
        certify_parameters,
        "mcexact certify --json about a system with parameters",
    ),
    "simulate": (simulate, "mcexact simulate --json"),
    "check": (check, "mcexact check --json"),
    "crosscheck": (crosscheck, "mcexact crosscheck --json"),
    "sweep": (sweep, "mcexact sweep --json"),
    "reproduce": (reproduce, "mcexact reproduce --json"),
    "demo": (demo, "mcexact demo --json"),
    "export": (export, "mcexact export --json, and equations.json"),
    "gallery": (gallery, "mcexact gallery --json"),
    "error": (error, "every command with --json that fails"),
}
"""The documents with their makers, and what each describes.  `sample`, `convert` and `c2d` print
system files."""


@cache
def schema_file(name: str) -> str:
    """The text of the file of a schema, written from its declaration."""
    maker, title = DOCUMENTS[name]
    head = {"$schema": _DIALECT, "title": f"mcexact {name}: {title}"}
    return json.dumps(_shared(head | maker()), indent=1, ensure_ascii=True) + "\n"


_SHARED = {"rational": RATIONAL, "number": NUMBER, "matrix": MATRIX}


def _shared(schema: Schema) -> Schema:
    """The schema with each shared part written once, as a definition."""
    shared = {name: each for name, each in _SHARED.items() if _occurs(each, schema)}
    if not shared:
        return schema
    definitions = {
        name: {key: _replaced(value, shared) for key, value in each.items()}
        for name, each in shared.items()
    }
    replaced: Schema = _replaced(schema, shared)
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
        (FOLDER / f"{name}.json").write_text(schema_file(name), encoding="utf-8")


if __name__ == "__main__":
    main()
