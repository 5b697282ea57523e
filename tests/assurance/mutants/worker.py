"""Try the mutants of some files in the copy that is the current folder.

python -m tests.assurance.mutants.worker FOLDER SECONDS OPERATOR SAMPLE MINUTES STEM…
"""

from __future__ import annotations

import sys
from pathlib import Path

from tests.assurance.mutants import operators, selection, session, topics, warm


def main(folder: str, most: str, only: str, sample: str, minutes: str, *stems: str) -> int:
    """Try them, after a change that has to be noticed and one that must not."""
    operators.register()
    chosen = session.Selection.read(Path(folder) / "selection.json")
    warm.load(selection.files())
    _require_sound(chosen, float(most))
    limits = session.Limits(float(most), only, int(sample), float(minutes))
    for stem in stems:
        path, database = topics.sources()[stem], Path(folder, f"{stem}.sqlite")
        session.plan(path, database)
        session.forget(path, database, {"survived", "timeout", "not covered", "abnormal"}, only)
        session.work(stem, path, database, chosen, limits)
        print(f"{stem}: done", flush=True)
    return 0


def _require_sound(chosen: session.Selection, most: float) -> None:
    """Stop unless the tests pass without a change, and some fail after a gross one."""
    tests, _ = chosen.ordered("arithmetic", list(range(len(chosen.seconds))), most)
    if (outcome := warm.run(tests, 900)) != "survived":
        raise SystemExit(f"without a change the tests do not pass: {outcome}")
    path = Path("mcexact/checker/core/arithmetic.py")
    source = path.read_text(encoding="utf-8")
    try:
        path.write_text(source.replace("def is_zero(self)", "def is_nil(self)"), encoding="utf-8")
        outcome = warm.run(tests, 900)
    finally:
        path.write_text(source, encoding="utf-8")
    if outcome != "killed":
        raise SystemExit(f"a gross change is not noticed: {outcome}")


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
