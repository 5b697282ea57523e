"""Record wrong floating-point answers of this machine: `python -m mcexact.crosschecks.recording`.

Only wrong answers are recorded.  Where this machine answers correctly, the older record is kept,
with the machine that it names.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from mcexact.crosschecks.demonstration import floating_answers
from mcexact.crosschecks.gallery import exhibits
from mcexact.crosschecks.table import RECORDS, crosscheck, libraries_here
from mcexact.model.text import write_text

_PLACE = Path(__file__).with_name(RECORDS)


def record(known: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return the updated document of records, and the names of exhibits answered correctly here.

    Parameters
    ----------
    known : dict
        The document so far, which may be empty.
    """
    libraries = libraries_here().document()
    shown: dict[str, Any] = {}
    right = []
    for each in exhibits():
        rows = {row.question: row for row in crosscheck(each.make()).disagreements}
        if each.question in rows:
            shown[each.name] = {"floating": rows[each.question].floating, "libraries": libraries}
        else:
            right.append(each.name)
            if each.name in known.get("exhibits", {}):
                shown[each.name] = known["exhibits"][each.name]
    answers = floating_answers()
    if not answers.misleading:
        right.append("demonstration")
    demonstrated = answers.document() if answers.misleading else known["demonstration"]
    return {"demonstration": demonstrated, "exhibits": shown}, right


def main() -> None:
    """Write the records of this machine into the package's file."""
    known = json.loads(_PLACE.read_text("utf-8")) if _PLACE.exists() else {}
    document, right = record(known)
    write_text(_PLACE, json.dumps(document, indent=1) + "\n")
    for name in right:
        print(f"{name}: floating point answers correctly here, so nothing is recorded")


if __name__ == "__main__":
    main()
