"""Documents that are kept with the answers to them, in ``tests/checker/corpus``.

A line of a file holds what is read ("certificate", "system" or "controller"), the document or the
text, the limits if they are not the usual ones, and the answer.
"""

from __future__ import annotations

import importlib
import json
import sys
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "corpus"
KEPT = FOLDER / "kept.jsonl"

Case = Mapping[str, Any]


def answer(case: Case) -> str:
    """What the checker says, without the message for people.

    That is the verdict with the digest of the statement, or with the code and the place, or what
    a file is about.
    """
    # the modules are looked up when they are needed, since a changed checker may have been loaded
    reading = importlib.import_module("mcexact.checker.core.reading")
    limits = reading.Limits(**case.get("limits", {}))
    data: Any = case["document"]
    if isinstance(data, str):
        data = data.encode("utf-8", "surrogateescape")
    if case["read"] == "certificate":
        kinds = importlib.import_module("mcexact.checker.kinds")
        found = kinds.check_document(data, None, limits)
        parts = (found.verdict, found.statement_digest, found.code, found.place)
        return " ".join(part for part in parts if part)
    digits = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        module = importlib.import_module("mcexact.checker.core.system")
        if case["read"] == "system":
            return str(module.digest(module.read_system_file(data, limits)))
        module = importlib.import_module("mcexact.checker.controllers")
        return " ".join(module.read_controller_file(data, limits)[:2])
    except reading.Refused as refused:
        return " ".join(refused.args[:3])
    finally:
        sys.set_int_max_str_digits(digits)


def group(case: Case) -> str:
    """What a case is about: the kind that a certificate names, or what sort of file it is."""
    if case["read"] != "certificate":
        return str(case["read"])
    document = case["document"]
    named = document.get("kind") if isinstance(document, dict) else None
    return named if isinstance(named, str) else "no kind"


def by_group(path: Path = KEPT) -> dict[str, list[Case]]:
    """The cases of a file by what they are about."""
    found: dict[str, list[Case]] = defaultdict(list)
    for line in path.read_text(encoding="utf-8").splitlines():
        case = json.loads(line)
        found[group(case)].append(case)
    return dict(found)
