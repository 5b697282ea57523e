"""The schemas of what commands print with ``--json``.

Documents can get further keys within a version, and programs that read them ignore those that they
do not know.
"""

from __future__ import annotations

from mcexact.answer.parametric_account import LABELS
from mcexact.answer.schema import RATIONAL, Schema, kinds, view_schemas
from mcexact.answer.wording.parameters import WITHIN_RANGES
from mcexact.report.file_schemas import agents, sweep_record
from mcexact.report.schema_terms import (
    FLOAT,
    NUMBER,
    TEXT,
    TIME,
    WHOLE,
    YES,
    named,
    record,
    rows,
    some,
    table,
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


EVERY_LOOP = record(
    {"certified": YES, "region": TEXT},
    {
        "part": some(NUMBER),
        "gains": some(NUMBER),
        "fails_within": some(NUMBER),
        "failing": some({"type": "object"}),
        "reason": some(TEXT),
    },
    says="what is proved of all loops in a box around the plant, and a plant whose loop fails",
)


def design() -> Schema:
    """The JSON of `mcexact design`."""
    made = {
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
    }
    parts: Schema = {
        key: {}
        for key in (
            "agent", "network", "dimensions", "observer_order", "feedback_polynomial",
            "error_polynomial", "blocks", "kept",
        )
    }  # fmt: skip
    refused = {"possible": {"const": False}, "reason": TEXT}
    schema = _account({"design": TEXT}, made | parts | refused | {"every_loop": EVERY_LOOP})
    return schema | {
        "if": {"required": ["possible"]},
        "then": {"required": ["reason"]},
        "else": {"required": list(made)},
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
            "assessment": ASSESSMENT,
        },
        {
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


def analyze() -> Schema:
    """The JSON of `mcexact analyze`."""
    return _account(
        {"information": {"enum": ["own", "outputs"]}, "questions": rows(_QUESTION)},
        {"largest_uncertainty": _LARGEST, "failing_within_radii": table({"type": "object"})},
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
        "properties": named("mcexact-analysis/1") | {"system": _SYSTEM_IN_SHORT},
        "required": ["format", "time", "arithmetic", "times", "state", "agents"],
    }


def allocate() -> Schema:
    """The JSON of `mcexact allocate`."""
    sizes = record({"least": WHOLE, "bound": some(WHOLE)})
    said = "the least dimensions, and those of the theorem's bound where its hypotheses hold"
    return _account({}, {"shares": record({"by_agent": table(sizes), "total": sizes}, says=said)})


def check() -> Schema:
    """The JSON of `mcexact check`."""
    verdict = record(
        {
            "verdict": {
                "enum": [
                    *("VALID", "INVALID", "MALFORMED", "INCOMPLETE"),
                    *("IMPLIED", "REMARK", "COUNTED"),
                ]
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


def crosscheck() -> Schema:
    """The JSON of `mcexact crosscheck`."""
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


def error() -> Schema:
    """What a command prints that fails."""
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
