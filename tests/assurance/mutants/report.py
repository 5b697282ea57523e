"""The table of what came out, and the survivors."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from tests.assurance.mutants import explained, operators, session, topics

SCORE = 95
COLUMNS = (*session.OUTCOMES, "explained", "not tried")


def write(folder: Path, checker: Path, stems: list[str]) -> int:
    """Print the table and write the survivors that are not explained; return the exit status."""
    operators.register()
    known = explained.read()
    total: Counter[str] = Counter()
    open_: list[str] = []
    print(f"{'file':28}{'tried':>9}" + "".join(f"{word:>13}" for word in COLUMNS))
    sources = topics.sources(checker)
    for stem in stems:
        database = folder / f"{stem}.sqlite"
        if not database.exists():
            continue
        count: Counter[str] = Counter()
        if not session.is_current(sources[stem], database):
            print(f"{stem:28}has changed since")
            open_.append(f"{stem}: has changed since\n")
            continue
        for mutant in session.mutants(sources[stem], database):
            count[mutant.outcome] += 1
            if mutant.outcome != "killed":
                if known.holds(stem, mutant.before, mutant.after):
                    count["explained"] += 1
                else:
                    open_.append(
                        f"{stem}:{mutant.line}: {mutant.outcome}\n"
                        f"    {mutant.before}\n    {mutant.after}\n"
                    )
        count["not tried"] = session.untried(database)
        total += count
        print(_row(stem, count))
    print(_row("all", total))
    tried = sum(total[word] for word in session.OUTCOMES)
    score = 100 * total["killed"] / (tried or 1)
    print(f"score {score:.1f} %, {total['explained']} of the others explained, {len(open_)} not")
    target = folder / "survivors.txt"
    target.write_text("".join(open_), encoding="utf-8")
    return int(score < SCORE or bool(open_))


def _row(name: str, count: Counter[str]) -> str:
    tried = sum(count[word] for word in session.OUTCOMES)
    return f"{name:28}{tried:9}" + "".join(f"{count[word]:13}" for word in COLUMNS)
