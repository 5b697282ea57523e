"""Weaken one hypothesis of each rule and show that its proof then fails, and where.

`weakened.txt` has one line for each: file, rule, what is weakened, text, replacement, in which ⏎
stands for the end of a line.  Only the first occurrence is replaced, in a copy of the file.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
NAMED = re.compile(r"^\s*(?:Theorem|Lemma|Fact|Definition|Fixpoint|Let|Record|Canonical)\s+(\w+)")


def failing(source: str, name: str, flags: list[str]) -> str | None:
    """The statement at which a changed file stops compiling, or None if it compiles."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.v"
        path.write_text(source)
        command = ["coqc", *flags, str(path)]
        run = subprocess.run(command, cwd=HERE, capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return None
    lines = [
        int(n)
        for n in re.findall(r"line (\d+), characters [^\n]*\n(?:Error|In nested)", run.stderr)
    ]
    found = "?"
    for line in source.splitlines()[: lines[-1] if lines else 0]:
        if match := NAMED.match(line):
            found = match[1]
    return found


def main(flags: list[str]) -> int:
    """Print the table of rule, hypothesis and first failing lemma."""
    bad = 0
    for entry in (HERE / "weakened.txt").read_text().splitlines():
        if not entry.strip() or entry.startswith("#"):
            continue
        name, rule, what, text, replacement = (part.strip() for part in entry.split(" ;; "))
        old, new = text.replace("⏎", "\n"), replacement.replace("⏎", "\n")
        source = (HERE / f"{name}.v").read_text()
        if old not in source:
            answer, bad = "TEXT NOT FOUND", bad + 1
        else:
            lemma = failing(source.replace(old, new, 1), name, flags)
            answer, bad = (f"fails at {lemma}", bad) if lemma else ("STILL PROVED", bad + 1)
        print(f"{name}: {rule}: {what}: {answer}", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
