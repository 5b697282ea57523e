"""The two readers of system files, of the package and of the checker, on drawn and damaged files.

    python -m tests.assurance.campaigns.grammar [COUNT [SEED]]

Both have to accept the same files, with the same digest.  What both accept has one canonical form,
which is the only one that the checker accepts in a certificate.  The tests run small counts.
"""

from __future__ import annotations

import json
import random
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from mcexact.checker.core import reading
from mcexact.checker.core.system import digest as checked_digest
from mcexact.checker.core.system import read_plant, read_system_file
from mcexact.errors import InputError
from mcexact.exact.rational import Limits
from mcexact.model import system, system_file
from mcexact.model.text import canonical
from tests.assurance.campaigns.grammar_tokens import (
    BYTES,
    ENCODINGS,
    GOOD_NUMBERS,
    KEYS,
    NAMES,
    NASTY,
    TEXTS,
)

STRINGS = [token for token in NASTY if token.startswith('"')]


class Token(str):
    """The text of a JSON value that is neither an object nor a list."""

    __slots__ = ()


@dataclass
class Pairs:
    """A JSON object, in which a key may occur twice."""

    pairs: list[list[Any]]


Node = Token | Pairs | list[Any]


def text_of(node: Any, rng: random.Random) -> str:
    """JSON text, with blanks here and there."""
    blank = rng.choice(["", "", "", " ", "\n", "\t\r\n "])
    if isinstance(node, Pairs):
        inside = ",".join(f"{key}:{blank}{text_of(value, rng)}" for key, value in node.pairs)
        return "{" + blank + inside + "}"
    if isinstance(node, list):
        return "[" + ("," + blank).join(text_of(item, rng) for item in node) + blank + "]"
    return str(node)


def quoted(text: str, rng: random.Random) -> Token:
    """A JSON string, perhaps with escapes that it does not need."""
    plain = json.dumps(text, ensure_ascii=rng.random() < 0.5 or not text.isprintable())
    if text.isalnum() and text.isascii() and rng.random() < 0.1:
        plain = '"' + "".join(f"\\u{ord(letter):04x}" for letter in text) + '"'
    return Token(plain)


def drawn_matrix(rng: random.Random, r: int, c: int, zero: bool = False) -> Node:
    """A matrix of this shape, dense or sparse."""
    zeros = ["0", "-0", "0.0", '"0/3"', "0e5"]
    values = zeros if zero else [*zeros, *GOOD_NUMBERS]

    def entry() -> Token:
        return Token(rng.choice(values if rng.random() < 0.4 else values[:9]))

    if (not r and c) or rng.random() < 0.2:
        cells = [(i, j) for i in range(r) for j in range(c) if rng.random() < 0.5]
        rng.shuffle(cells)
        entries = [[Token(str(i)), Token(str(j)), entry()] for i, j in cells]
        shape = [Token(str(r)), Token(str(c))]
        return Pairs([['"shape"', shape], ['"entries"', entries]])
    return [[entry() for _ in range(c)] for _ in range(r)]


def drawn_document(rng: random.Random) -> Pairs:
    """A system file that both readers accept, written in one of many ways."""
    n, m = rng.choice([0, 1, 1, 2, 2, 3]), rng.choice([1, 1, 2, 2, 3])
    names = rng.sample(NAMES, m)
    time = rng.choice(["continuous", "discrete"])
    channels, own = [], []
    for k in range(m):
        B = drawn_matrix(rng, n, rng.choice([0, 1, 1, 2]))
        C = drawn_matrix(rng, rng.choice([0, 1, 1, 2]), n)
        pairs: list[list[Any]] = [['"B"', B], ['"C"', C]]
        plain = rng.random() < 0.1 and str(k + 1) not in names
        own.append(str(k + 1) if plain else names[k])
        if not plain:
            pairs.append(['"name"', quoted(names[k], rng)])
        if rng.random() < 0.1:
            pairs.append(['"D"', drawn_matrix(rng, rng.randint(0, 2), 1, zero=True)])
        rng.shuffle(pairs)
        channels.append(Pairs(pairs))
    A = drawn_matrix(rng, n, n)
    found: list[list[Any]] = [['"format"', Token('"mcexact-system/1"')], ['"A"', A]]
    found += [['"time"', quoted(time, rng)], ['"channels"', channels]]
    for key in ("name", "source"):
        if rng.random() < 0.2:
            found.append([f'"{key}"', quoted(rng.choice(TEXTS), rng)])
    if time == "discrete" and rng.random() < 0.2:
        found.append(['"sample_time"', Token(rng.choice(["1", "0.1", '"1/30"', "1e-3"]))])
    if rng.random() < 0.1:
        found.append(['"D"', drawn_matrix(rng, 1, 2, zero=True)])
    if rng.random() < 0.6:
        found += drawn_graph(rng, own)
    rng.shuffle(found)
    return Pairs(found)


def drawn_graph(rng: random.Random, names: list[str]) -> list[list[Any]]:
    """The keys ``neighbors`` and perhaps ``delays``."""
    rows, waits = [], []
    for name in names:
        heard = [other for other in names if rng.random() < 0.6]
        rng.shuffle(heard)
        if heard or rng.random() < 0.7:
            rows.append([quoted(name, rng), [quoted(other, rng) for other in heard]])
        late = [[quoted(o, rng), Token(rng.choice("0012"))] for o in heard if o != name]
        if late and rng.random() < 0.7:
            waits.append([quoted(name, rng), Pairs(late)])
    found = [['"neighbors"', Pairs(rows)]]
    if rng.random() < 0.5:
        found.append(['"delays"', Pairs(waits)])
    return found


def containers(node: Any) -> list[Any]:
    """All objects and lists of a document."""
    found: list[Any] = []
    inside = [node]
    while inside:
        each = inside.pop()
        if isinstance(each, Token):
            continue
        found.append(each)
        inside += [value for _, value in each.pairs] if isinstance(each, Pairs) else each
    return found


def copied(node: Any) -> Any:
    """A copy that can be damaged on its own."""
    if isinstance(node, Pairs):
        return Pairs([[key, copied(value)] for key, value in node.pairs])
    return [copied(item) for item in node] if isinstance(node, list) else node


def damaged(document: Pairs, rng: random.Random) -> str:
    """Change one place of a document; the result names what was done."""
    all_of_them = containers(document)
    objects = [each for each in all_of_them if isinstance(each, Pairs)]
    full = [each for each in all_of_them if (each.pairs if isinstance(each, Pairs) else each)]
    what = rng.choice(
        ["value", "value", "null", "text", "number", "add", "remove", "rename", "double", "move"]
    )
    chosen = rng.choice(full)
    slots = chosen.pairs if isinstance(chosen, Pairs) else chosen
    k = rng.randrange(len(slots))

    def put(value: Any) -> None:
        if isinstance(chosen, Pairs):
            slots[k][1] = value
        else:
            slots[k] = value

    if what == "value":
        put(Token(rng.choice(NASTY)))
    elif what == "null":
        put(Token(rng.choice(["null", "0", '""', "false", "[]", "{}"])))
    elif what == "text":
        named = [pair for each in objects for pair in each.pairs if "name" in pair[0]]
        if named:
            rng.choice(named)[1] = Token(rng.choice(STRINGS))
    elif what == "number":
        rows = [each for each in all_of_them if isinstance(each, list) and each]
        numbers = [row for row in rows if all(isinstance(item, Token) for item in row)]
        if numbers:
            row = rng.choice(numbers)
            row[rng.randrange(len(row))] = Token(rng.choice([*GOOD_NUMBERS, *NASTY]))
    elif what == "add":
        value: Any = Token(rng.choice([*NASTY, "[]", "{}", "null"]))
        key = rng.choice([*KEYS, *(f'"{name}"' for name in NAMES[:5])])
        rng.choice(objects).pairs.append([key, value])
    elif what == "remove":
        del slots[k]
    elif what == "rename" and isinstance(chosen, Pairs):
        slots[k][0] = rng.choice(KEYS)
    elif what == "double":
        slots.insert(rng.randrange(len(slots) + 1), copied(slots[k]))
    else:
        source = rng.choice(full)
        held = [v for _, v in source.pairs] if isinstance(source, Pairs) else source
        put(copied(rng.choice(held)))
    return what


def damaged_bytes(data: bytes, rng: random.Random) -> bytes:
    """Change a few bytes, or the encoding."""
    if rng.random() < 0.2:
        encoding = rng.choice(ENCODINGS)
        return data.decode("utf-8").encode(encoding, "replace")
    a = rng.choice([0, len(data), rng.randrange(len(data) + 1)])
    b = min(len(data), a + rng.choice([0, 0, 1, 1, 5]))
    return data[:a] + rng.choice([b"", *BYTES]) + data[b:]


def damaged_file(document: Pairs, rng: random.Random) -> tuple[bytes, str]:
    """The file of a document, and how it was damaged."""
    done: list[str] = []
    for _ in range(rng.choice([0, 0, 1, 1, 1, 1, 2, 3])):
        done.append(damaged(document, rng))
    data = text_of(document, rng).encode("utf-8", "surrogatepass")
    if rng.random() < 0.1:
        data, done = damaged_bytes(data, rng), [*done, "bytes"]
    return data, "+".join(done) or "nothing"


def drawn_limits(rng: random.Random) -> Limits:
    """Usually the default limits."""
    if rng.random() < 0.9:
        return Limits()
    return Limits(
        bytes=rng.choice([Limits.bytes, 500, 2000]),
        depth=rng.choice([Limits.depth, 3, 4, 5]),
        digits=rng.choice([1, 2, 3, 18, 19, 20, 4299, 4300, 4301, 10**15]),
        exponent=rng.choice([0, 1, 3, 1000, 1001]),
    )


@dataclass
class Tally:
    """What the two readers said.

    Attributes
    ----------
    accepted, refused : int
        How many files both accepted or refused.
    kinds : Counter
        How many files both accepted, by how they were damaged.
    failures : list of str
        The files on which they differ.
    """

    accepted: int = 0
    refused: int = 0
    kinds: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)

    def summary(self) -> str:
        """The numbers in one line."""
        return (
            f"{self.accepted + self.refused + len(self.failures)} files: both readers accept "
            f"{self.accepted}, both refuse {self.refused}; they differ on {len(self.failures)}"
        )


@contextmanager
def any_integer() -> Iterator[None]:
    """Allow integers of any length, as the checker's command line does."""
    digits = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        yield
    finally:
        sys.set_int_max_str_digits(digits)


def verdict_of(read: Callable[[], Any], refusal: type[Exception]) -> tuple[Any, str]:
    """What a reader returns, or None; and its reason or its error."""
    try:
        return read(), ""
    except refusal as error:
        return None, str(error)


def compare(data: bytes, limits: Limits, tally: Tally, what: str) -> None:
    """Let both readers read one file."""
    theirs = reading.Limits(limits.bytes, limits.depth, limits.digits, limits.exponent)
    ours, reason = verdict_of(lambda: system_file.read_system(data, limits=limits), InputError)
    ours_digest = None if ours is None else ours.digest()
    with any_integer():
        checked, other = verdict_of(lambda: read_system_file(data, theirs), reading.Refused)
        its_digest = None if checked is None else checked_digest(checked)
    problem = "" if ours_digest == its_digest else f"{ours_digest} {reason} / {its_digest} {other}"
    problem = problem or in_a_certificate(data, limits, ours)
    if problem:
        tally.failures.append(f"{what}: {problem}: {limits}: {data!r}")
    elif ours is None:
        tally.refused += 1
    else:
        tally.accepted += 1
        tally.kinds[what] += 1


def in_a_certificate(data: bytes, limits: Limits, ours: Any) -> str:
    """Compare with the system object of a certificate, which has to be canonical."""
    try:
        document = reading.parse(data, reading.Limits())
    except reading.Refused:
        document = None
    if ours is not None:
        with any_integer():
            form = json.loads(canonical(ours.canonical_document()))
            found = checked_digest(read_plant(form))
        if found != ours.digest():
            return f"its canonical form has the digest {found}"
    if not isinstance(document, dict) or limits != Limits():
        return ""
    if document.pop("format", None) != system.FORMAT:
        return ""
    plant, reason = verdict_of(lambda: read_plant(document), reading.Refused)
    expected = ours is not None and canonical(document) == canonical(form)
    if (plant is not None) != expected:
        return f"as the system of a certificate: {reason or 'accepted'}"
    return ""


def run(count: int, seed: int = 0) -> Tally:
    """Compare the readers on so many files."""
    tally = Tally()
    for k in range(count):
        rng = random.Random(f"{seed} {k}")
        data, what = damaged_file(drawn_document(rng), rng)
        compare(data, drawn_limits(rng), tally, what)
    return tally


def main(count: int = 100_000, seed: int = 0) -> int:
    """Print the numbers and every difference."""
    tally = run(count, seed)
    print(tally.summary())
    for failure in tally.failures[:20]:
        print(failure[:2000])
    return 1 if tally.failures or tally.accepted < count / 5 else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
