"""Measure in parts, keep what was measured, and write the table ``SPEED.md``.

Run as ``python -m benchmarks [ROWS.jsonl] [PART …]``; by default all parts, whose names begin with
the words given.  ``quick`` stands for some of a minute.  Rows are kept in ``rows/speed.jsonl``, and
what that has is not measured again: the same command continues after an interruption, and a part
whose row is removed is measured anew.  ``SPEED.md`` has all rows that are kept; for other rows the
table stands beside them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from benchmarks import (
    bad_inputs,
    commands,
    every_question,
    fixed_spectrum,
    matrices,
    networks,
    parameters,
    start_up,
)
from benchmarks.fixed_spectrum import Row
from benchmarks.kept_rows import ROWS, chosen, kept, measured
from mcexact.analysis.stability import open_loop_spectrum
from mcexact.crosschecks.table import libraries_here

_TABLE = Path(__file__).with_name("SPEED.md")
_HEAD = """\
# How long things take

`make bench` measures these figures, each part in one run in which peers take turns; ratios are of
medians of 5. `make bench PARTS=quick` measures some, and `PARTS='absence checked'` the parts whose
names begin so. All seconds are those of the processor. A line whose limit is `reported` has none.
The load is the mean number of busy processes on the machine: where it is high, memory and caches
are shared, and seconds are longer. Seconds of two machines do not compare: with the same code
`analyze` of three states took 0.34 s on the EPYC under a load of 1 and 0.73 s on the Xeon under 5.

The peer in `absence` is what practice does: the eigenvalues of A and of one drawn closed loop, by
`numpy.linalg.eigvals`, which proves nothing. [TEN_MILLION.md](TEN_MILLION.md) says what these
figures mean for larger plants, and [LARGEST_COSTS.md](LARGEST_COSTS.md) what takes `analyze` most
of its time.
"""

without = fixed_spectrum.without_fixed_mode
SECOND = (
    ("no fixed mode", without, 0, "", (4, 60, 200, 500, 1000)),
    ("planted fixed mode", fixed_spectrum.planted, 0, " with a fixed mode", (4, 60)),
    ("planted fixed mode", fixed_spectrum.planted, 0, " with a fixed mode by gains", (200, 500)),
    ("chains with a fixed mode", every_question.chains, 2, " with a fixed mode", (200, 500, 1000)),
)
"""Plants of the second checker."""

PARTS: Mapping[str, Callable[[], Iterator[Row]]] = {
    **{
        f"absence {n} states {digits} digits": partial(fixed_spectrum.absence_rows, n, digits)
        for n in (200, 400, 800, 1600)
        for digits in (1, 6)
    },
    **{
        f"checked {n} states": partial(fixed_spectrum.checked_rows, n, limit)
        for n, limit in ((500, 0.5), (1000, 2), (2000, 15))
    },
    **{
        f"second checker {n} states{name}": partial(
            fixed_spectrum.second_rows, plant, partial(make, n + added)
        )
        for plant, make, added, name, sizes in SECOND
        for n in sizes
    },
    **{
        f"second checker {n} states spectrum": partial(
            fixed_spectrum.second_rows,
            "characteristic polynomial",
            partial(without, n),
            open_loop_spectrum,
        )
        for n in (60, 120)
    },
    **{
        f"questions dense {n} states {m} channels": partial(every_question.dense_rows, n, m)
        for n, m in every_question.DENSE
    },
    "questions building 10000 states 400 channels": partial(
        every_question.sparse_rows, 10_000, 400
    ),
    "questions chains 10000 states 400 channels": partial(
        every_question.chain_questions, 10_000, 400
    ),
    **{
        f"questions planted {n} states": partial(every_question.planted_rows, n)
        for n in every_question.PLANTED
    },
    **{
        f"whole analyze {n} states": partial(every_question.whole_rows, n)
        for n in every_question.WHOLE
    },
    "chains with fixed modes": every_question.chain_rows,
    "questions hidden decentralized": every_question.hidden_rows,
    "questions set-points of deficient rank": every_question.deficient_rows,
    "planted modes": fixed_spectrum.planted_rows,
    "planted modes in large plants": fixed_spectrum.large_rows,
    "planted modes of high degree": fixed_spectrum.high_degree_rows,
    "completeness": fixed_spectrum.completeness_rows,
    "network swing-grid 4000": partial(networks.network_rows, "swing-grid", 4000, 200, 10, 30),
    "network swing-speed 4000": partial(networks.network_rows, "swing-speed", 4000, 200, 30, 30),
    "network building 10000": partial(networks.network_rows, "building", 10_000, 1000, 10, 30),
    "network building 100000": partial(
        networks.absence_rows, "building", 100_000, 10_000, limit=300
    ),
    **{f"command {name}": partial(commands.command_rows, name) for name in commands.COMMANDS},
    **{
        f"parameters {kind} {n} states": partial(parameters.rows, kind, n)
        for kind, sizes in parameters.SIZES.items()
        for n in sizes
    },
    "matrices": matrices.rows,
    "start-up": start_up.rows,
    "refusals": bad_inputs.rows,
}
QUICK = (
    "absence 200 states 1 digits",
    "absence 400 states 1 digits",
    "checked 500 states",
    "planted modes of high degree",
    "network swing-grid 4000",
    "matrices",
    "start-up",
)


def main(arguments: list[str]) -> int:
    """Measure the parts; ends with 1 if a limit is exceeded."""
    path, words = chosen(arguments, "speed")
    names = [name for name in PARTS if _is_asked(name, words)]
    if not names:
        print(f"no part of this name; expected {', '.join(PARTS)}", file=sys.stderr)
        return 2
    known = kept(path)
    fell = False
    for name in names:
        part = measured(path, name, partial(_measured, PARTS[name]), known)
        known[name] = part
        for row in part["rows"]:
            fell = fell or not row["holds"]
            print(_line(row), flush=True)
    table = _TABLE if path == ROWS / "speed.jsonl" else path.with_suffix(".md")
    table.write_text(_table(known), encoding="utf-8")
    return int(fell)


def _is_asked(name: str, words: list[str]) -> bool:
    """Whether a part is named by all words, by one that begins its name, or by ``quick``."""
    quick = "quick" in words and name in QUICK
    return not words or quick or any(name.startswith(word) for word in words)


def _measured(part: Callable[[], Iterator[Row]]) -> dict[str, Any]:
    """The rows of a part, with the libraries and the threads."""
    load = os.getloadavg()[0]
    rows = [asdict(row) for row in part()]
    threads = os.environ["OPENBLAS_NUM_THREADS"]
    libraries = f"{libraries_here()}, {threads} thread of OpenBLAS"
    return {"rows": rows, "libraries": libraries, "load": round(load, 1)}


def _line(row: Mapping[str, Any]) -> str:
    """A row as text."""
    mark = "holds" if row["holds"] else "FALLS SHORT"
    value = f"{row['ratio']:10.2f} {row['unit']}"
    return f"{value:<20} {row['limit']:<10} {mark:<12} {row['question']}   [{row['detail']}]"


def _table(known: Mapping[str, Mapping[str, Any]]) -> str:
    """The page of all rows that are kept, part by part, with the machines they are from."""
    lines = [_HEAD]
    for machine in sorted({part["machine"] for part in known.values()}):
        libraries = sorted({p["libraries"] for p in known.values() if p["machine"] == machine})
        lines += [f"Measured on {machine}, with {'; '.join(libraries)}.", ""]
    for name, part in ((name, known[name]) for name in PARTS if name in known):
        lines += [f"## {name}", "", f"{part['machine'].split(',')[0]}, load {part['load']}.", ""]
        lines += ["| what | | limit | |", "|---|---|---|---|"]
        for row in part["rows"]:
            short = "" if row["holds"] else "**falls short**"
            value = f"{row['ratio']:.3g} {row['unit']}"
            detail = f"{row['detail']} {short}".strip().replace("|", "\\|")
            lines.append(f"| {row['question']} | {value} | {row['limit']} | {detail} |")
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
