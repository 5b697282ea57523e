"""Both checkers on mutants and forgeries of their common kinds: what only one of them accepts.

Every try of the attack campaign for these kinds, about a plant, its dual or a loop, is judged by
the checker in Python and by the program mcexact-verified (`make verified`).  Counted are pairs of
verdicts of each kind; where both accept, the statements and their digests have to be equal.
Nothing that is INVALID or MALFORMED may be CONFIRMED.  Every other difference is listed with its
reason, but for certificates that the program does not read.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Collection, Iterator
from itertools import islice
from pathlib import Path

from mcexact.checker.kinds import check_document
from mcexact.cli import verified
from tests.assurance.attack.tries import batch_numbers, drawn_batch, tries

LOOPS = ("closed_loop_spectrum", "stability")
KINDS = (
    *("completeness", "controllability", "fixed_spectrum", "setpoint", "transfer_graph"),
    *LOOPS,
)
AT_ONCE = 256
"""Files that the program is given in one call."""


def documents(count: int, kinds: Collection[str]) -> Iterator[tuple[str, bytes]]:
    """The original of each batch about a plant, its dual or a loop, and the texts of its tries."""
    for number in batch_numbers(50 * count, kinds):
        batch = drawn_batch(number)
        if [step["construction"] for step in batch.original["subject"]] not in (
            *([], ["dual"]),
            *([["closed_loop"]] if batch.kind in LOOPS else []),
        ):
            continue
        yield batch.kind, json.dumps(batch.original).encode("ascii")
        for each in tries(number, batch):
            made = each.document
            text = made if isinstance(made, (str, bytes)) else json.dumps(made)
            data = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text
            yield batch.kind, data


def answers(program: str, texts: list[bytes], folder: Path) -> list[str]:
    """The lines of the program about some texts."""
    paths = [folder / f"{k}.json" for k in range(len(texts))]
    for path, text in zip(paths, texts, strict=True):
        path.write_bytes(text)
    run = subprocess.run([program, *map(str, paths)], capture_output=True, check=False)
    return run.stdout.decode("ascii", "replace").splitlines()


def main(count: int, kinds: Collection[str]) -> int:
    """Compare both on this many tries."""
    program = verified.program()
    if program is None:
        print("needs the program mcexact-verified: make verified")
        return 2
    pairs, reasons, wrong = Counter[tuple[str, str, str]](), Counter[str](), list[str]()
    drawn = islice(documents(count, kinds), count)
    with tempfile.TemporaryDirectory() as folder:
        while texts := list(islice(drawn, AT_ONCE)):
            lines = answers(program, [text for _, text in texts], Path(folder))
            for (kind, text), line in zip(texts, lines, strict=True):
                verdict = check_document(text)
                word, _, rest = line.partition(" ")
                pairs[kind, verdict.verdict, word] += 1
                if word == "CONFIRMED":
                    stated = f"{verdict.statement_digest} {verdict.statement}"
                    if verdict.verdict != "VALID" or rest != stated:
                        wrong.append(f"{verdict.line()[:160]} | {line[:160]} | {text[:2000]!r}")
                elif verdict.verdict != word and (word != "INCOMPLETE" or verdict.status == 0):
                    said = f"{verdict.verdict} {verdict.code}".strip()
                    reasons[f"{kind}: {said}, but {line[:100]}"] += 1
    for (kind, ours, theirs), many in sorted(pairs.items()):
        print(f"{kind:18} {ours:12} {theirs:12} {many}")
    for reason, many in reasons.most_common():
        print(f"{reason}: {many}")
    print(f"{len(wrong)} accepted by the program alone")
    print("\n".join(wrong[:5]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if sys.argv[1:] else 10_000, sys.argv[2:] or KINDS))
