"""The package and the checker read drawn and damaged controller files.

    python -m tests.assurance.campaigns.controller_grammar [COUNT [SEED]]

Both have to accept the same files, and mean the same controller by each.
"""

from __future__ import annotations

import json
import random
import sys
from typing import Any

from mcexact.checker import controllers as checker
from mcexact.checker.core import reading
from mcexact.checker.core.system import canonical_json, digest_of
from mcexact.errors import InputError
from mcexact.exact.rational import Limits
from mcexact.model.controller import read_controller
from mcexact.model.text import canonical
from tests.assurance.campaigns.grammar import (
    Pairs,
    Tally,
    Token,
    any_integer,
    damaged_file,
    drawn_limits,
    drawn_matrix,
    quoted,
    verdict_of,
)
from tests.assurance.campaigns.grammar_tokens import NAMES

MAPS = ("shared_update", "private_update", "input")


def drawn_document(rng: random.Random) -> Pairs:
    """A controller file that both readers accept, written in one of many ways."""
    m = rng.choice([1, 1, 2, 2, 3])
    names = rng.sample(NAMES, m)
    shared, private, p, q = ([rng.randint(0, 2) for _ in names] for _ in range(4))
    agents = []
    for i in range(m):
        pairs: list[list[Any]] = [
            ['"name"', quoted(names[i], rng)],
            ['"shared"', Token(str(shared[i]))],
            ['"private"', Token(str(private[i]))],
        ]
        for label, nrows in zip(MAPS, (shared[i], private[i], p[i]), strict=True):
            parts = drawn_map(rng, names, nrows, (q, shared), (private[i], q[i]))
            pairs.append([f'"{label}"', parts])
        if rng.random() < 0.3:
            steps = [[quoted(name, rng), Token(rng.choice("0012"))] for name in names]
            pairs.append(['"hold"', Pairs(rng.sample(steps, rng.randint(0, m)))])
        rng.shuffle(pairs)
        agents.append(Pairs(pairs))
    time = rng.choice(["continuous", "discrete"])
    found: list[list[Any]] = [
        ['"format"', Token('"mcexact-controller/1"')],
        ['"time"', quoted(time, rng)],
    ]
    found += [['"system"', Token(rng.choice(['""', f'"{"0f" * 32}"']))], ['"agents"', agents]]
    rng.shuffle(found)
    return Pairs(found)


def drawn_map(
    rng: random.Random,
    names: list[str],
    nrows: int,
    others: tuple[list[int], list[int]],
    own: tuple[int, int],
) -> Pairs:
    """A linear map, with matrices of zeros among the others."""
    pairs: list[list[Any]] = []

    def matrix(ncols: int) -> Any:
        return drawn_matrix(rng, nrows, ncols, zero=rng.random() < 0.2)

    for key, widths in zip(("outputs", "shared"), others, strict=True):
        used = [j for j in range(len(names)) if rng.random() < 0.4]
        if used or rng.random() < 0.1:
            entries = [[quoted(names[j], rng), matrix(widths[j])] for j in used]
            pairs.append([f'"{key}"', Pairs(entries)])
    for key, width in zip(("private", "reference"), own, strict=True):
        if rng.random() < 0.2:
            pairs.append([f'"{key}"', matrix(width)])
    return Pairs(pairs)


def compare(data: bytes, limits: Limits, tally: Tally, what: str) -> None:
    """Let both readers read one file."""
    theirs = reading.Limits(limits.bytes, limits.depth, limits.digits, limits.exponent)
    ours, reason = verdict_of(lambda: read_controller(data, limits), InputError)
    with any_integer():
        found, other = verdict_of(
            lambda: checker.read_controller_file(data, theirs), reading.Refused
        )
        its = None if found is None else found[0]
        same = None if ours is None else in_a_certificate(json.loads(canonical(ours.document())))
    if same != its or (ours is not None and found is not None and ours.system != found[1]):
        tally.failures.append(f"{what}: {same} {reason} / {its} {other}: {limits}: {data!r}")
    elif ours is None:
        tally.refused += 1
    else:
        tally.accepted += 1
        tally.kinds[what] += 1


def in_a_certificate(document: Any) -> str:
    """The digest of a controller as the package writes it into certificates."""
    return digest_of(canonical_json(checker.read_controller(document, "controller")))


def run(count: int, seed: int = 0) -> Tally:
    """Compare the readers on so many files."""
    tally = Tally()
    for k in range(count):
        rng = random.Random(f"{seed} {k}")
        data, what = damaged_file(drawn_document(rng), rng)
        compare(data, drawn_limits(rng), tally, what)
    return tally


def main(count: int = 20_000, seed: int = 0) -> int:
    """Print the numbers and every difference."""
    tally = run(count, seed)
    print(tally.summary())
    for failure in tally.failures[:20]:
        print(failure[:2000])
    return 1 if tally.failures or tally.accepted < count / 5 else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
