"""Both checkers on mutants and forgeries of their common kinds: what only one of them accepts.

Every try of the attack campaign for these kinds, about a plant, a loop, or a subject whose
constructions are in the kernel, is judged by the checker in Python and by the program
mcexact-verified (`make verified`).  Counted are pairs of verdicts of each kind; where both accept,
the statements and their digests have to be equal.  Nothing that is INVALID or MALFORMED may be
CONFIRMED.  Every other difference is listed with its reason, but for certificates that the program
does not read.

A run keeps what it has counted after every few batches: the same command again resumes it, with the
same program.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from mcexact.checker.kinds import check_document
from mcexact.cli import verified
from tests.assurance.attack.tries import batch_numbers, drawn_batch, tries

LOOPS = ("closed_loop_spectrum", "stability")
KINDS = (
    *("completeness", "controllability", "fixed_spectrum", "setpoint", "transfer_graph"),
    *LOOPS,
)
CONSTRUCTIONS = {
    *("augmented_outputs", "dual", "extended", "feedback", "full_output", "merged", "restricted")
}
"""The constructions that the program applies."""
AT_ONCE = 256
"""Files, or some more, that the program is given in one call."""


def documents(number: int) -> Iterator[tuple[str, bytes]]:
    """The original of a batch that the program reads, and the texts of its tries."""
    batch = drawn_batch(number)
    names = [step["construction"] for step in batch.original["subject"]]
    if not (CONSTRUCTIONS.issuperset(names) or (names == ["closed_loop"] and batch.kind in LOOPS)):
        return
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


@dataclass
class Counts:
    """What is counted of a run: batches and tries, pairs of verdicts, reasons, what is wrong."""

    run: list[str]
    batches: int = 0
    tries: int = 0
    pairs: Counter[str] = field(default_factory=Counter)
    reasons: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)

    def compare(self, kind: str, text: bytes, line: str) -> None:
        """Count a certificate and the line of the program about it."""
        verdict = check_document(text)
        word, _, rest = line.partition(" ")
        self.tries += 1
        self.pairs[f"{kind:20} {verdict.verdict:12} {word:12}"] += 1
        if word == "CONFIRMED":
            stated = f"{verdict.statement_digest} {verdict.statement}"
            if verdict.verdict != "VALID" or rest != stated:
                self.wrong.append(f"{verdict.line()[:160]} | {line[:160]} | {text[:2000]!r}")
        elif verdict.verdict != word and (word != "INCOMPLETE" or verdict.status == 0):
            said = f"{verdict.verdict} {verdict.code}".strip()
            self.reasons[f"{kind}: {said}, but {line[:100]}"] += 1

    def report(self) -> None:
        """Print everything."""
        for pair, many in sorted(self.pairs.items()):
            print(pair, many)
        for reason, many in self.reasons.most_common():
            print(f"{reason}: {many}")
        print(f"{self.tries} tries, {len(self.wrong)} accepted by the program alone")
        print("\n".join(self.wrong[:5]))


def kept(path: Path, run: list[str]) -> Counts:
    """The counts of this run if it was interrupted, or of a new one."""
    found = json.loads(path.read_text("utf-8")) if path.exists() else {}
    if found.get("run") != run:
        return Counts(run)
    counters = {key: Counter(found[key]) for key in ("pairs", "reasons")}
    return Counts(**{**found, **counters})


def main(count: int, kinds: Collection[str], path: Path) -> int:
    """Compare both on this many tries, those of an interrupted run included."""
    program = verified.program()
    if program is None:
        print("needs the program mcexact-verified: make verified")
        return 2
    digest = hashlib.sha256(Path(program).read_bytes()).hexdigest()
    counts = kept(path, [*kinds, digest])
    numbers = batch_numbers(50 * count, kinds)
    with tempfile.TemporaryDirectory() as folder:
        while counts.tries < count and counts.batches < len(numbers):
            texts: list[tuple[str, bytes]] = []
            while len(texts) < AT_ONCE and counts.batches < len(numbers):
                texts += documents(numbers[counts.batches])
                counts.batches += 1
            lines = answers(program, [text for _, text in texts], Path(folder))
            for (kind, text), line in zip(texts, lines, strict=True):
                counts.compare(kind, text, line)
            new = path.with_suffix(".new")
            new.write_text(json.dumps(vars(counts)), "utf-8")
            new.replace(path)
    counts.report()
    return 1 if counts.wrong else 0


if __name__ == "__main__":
    KEPT = Path("build", "verified-agreement.json")
    KEPT.parent.mkdir(exist_ok=True)
    sys.exit(main(int(sys.argv[1]) if sys.argv[1:] else 10_000, sys.argv[2:] or KINDS, KEPT))
