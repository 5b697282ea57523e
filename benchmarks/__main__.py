"""Ask every question of this folder once and print a table of ratios; write them as JSON."""

from __future__ import annotations

import json
import platform
import sys
from dataclasses import asdict
from pathlib import Path

from benchmarks import bad_inputs, fixed_spectrum, matrices, start_up


def main(arguments: list[str]) -> int:
    """Run; the one argument is the JSON file to write.  Ends with 1 if a limit is exceeded."""
    found = []
    for module in (fixed_spectrum, matrices, start_up, bad_inputs):
        for row in module.rows():
            found.append(row)
            mark = "holds" if row.holds else "FALLS SHORT"
            value = f"{row.ratio:10.2f} {row.unit}"
            print(
                f"{value:<20} {row.limit:<10} {mark:<12} {row.question}   [{row.detail}]",
                flush=True,
            )
    if arguments:
        document = {
            "python": platform.python_version(),
            "machine": platform.machine(),
            "rows": [asdict(row) for row in found],
        }
        Path(arguments[0]).write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    return 0 if all(row.holds for row in found) else 1


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
