"""Tries by number: a batch draws its certificates from its number, and then changes them."""

from __future__ import annotations

import itertools
import json
import random
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import Any

from tests.oracle.certificates.judge import KINDS
from tests.oracle.certificates.reading import Unspecified
from tests.oracle.drawn.certificates import DECISIONS, certified, some_certificate
from tests.oracle.drawn.observers import drawn_observer
from tests.oracle.drawn.plants import Document, rows_of, table
from tests.oracle.drawn.subjects import CONSTRUCTIONS

from .forgeries import forged
from .mutators import (
    EDITS,
    LARGE_PRIMES,
    PARTS,
    at,
    change_node,
    change_number,
    change_token,
    copied,
    crossed,
    nodes,
    other_gains,
    other_modulus,
    permuted,
    renamed,
    respelled,
    splice,
)

SIZE = 64
"""Tries of one batch."""

FOCUS = (None, *CONSTRUCTIONS)
ORDER = sorted(KINDS)


@dataclass
class Batch:
    """A true certificate, certificates like it, and what was tried last."""

    kind: str
    focus: str | None
    rng: random.Random
    original: Document
    siblings: list[Document] = field(default_factory=list)
    strangers: list[Document] = field(default_factory=list)
    rejected: tuple[Document, str] | None = None


@dataclass(frozen=True)
class Try:
    """One document, or its text, and how it was made."""

    number: int
    kind: str
    focus: str | None
    mutator: str
    document: Any


def batch_numbers(count: int, kinds: Collection[str] = ORDER) -> list[int]:
    """The first batches about these kinds that have so many tries together."""
    turns = (number for number in itertools.count() if ORDER[number % len(ORDER)] in kinds)
    return list(itertools.islice(turns, -(-count // SIZE)))


def drawn_batch(number: int) -> Batch:
    """The batch of a number: kinds in turn, and under each kind the constructions in turn."""
    rng = random.Random(f"batch {number}")
    kind = ORDER[number % len(ORDER)]
    focus = FOCUS[number // len(ORDER) % len(FOCUS)]
    original = some_certificate(rng, kind, focus)
    batch = Batch(kind, focus, rng, original)
    for _ in range(3):
        sibling = _sibling(rng, original)
        if sibling is not None:
            batch.siblings.append(sibling)
    batch.strangers.append(some_certificate(rng, kind, rng.choice(FOCUS)))
    other = rng.choice(list(DECISIONS))
    found = certified(rng, other, original["system"], original["subject"])
    if found is not None:
        batch.strangers.append(copied(found))
    return batch


def _sibling(rng: random.Random, original: Document) -> Document | None:
    """What is true of a plant or a subject that differs in one or two places."""
    near = copied(original)
    if rng.random() < 0.4:
        _tried(perturbed, rng, near["system"])
    else:
        _changed(rng, near)
    try:
        if near["kind"] == "distributed_observer":
            found = drawn_observer(rng, near["system"])
        else:
            found = certified(rng, near["kind"], near["system"], near["subject"])
    except Exception:  # the package refuses or fails on what is no plant at all
        return None
    return None if found is None else copied(found)


def _changed(rng: random.Random, near: Document) -> None:
    """One or two places of the plant or the subject."""
    for _ in range(rng.choice((1, 1, 2))):
        part = "subject" if near["subject"] and rng.random() < 0.4 else "system"
        change = change_number if rng.random() < 0.75 else change_node
        change(rng, near, part)


def zeros(value: Any) -> Any:
    """A matrix of zeros of the shape of a matrix of a system that has rows."""
    rows = rows_of(value)
    return table([[0] * len(row) for row in rows], len(rows[0]))


def perturbed(rng: random.Random, plant: Document) -> None:
    """A matrix of a channel set to 0, another time, a link more or less."""
    what = rng.randrange(5)
    channel = rng.choice(plant["channels"])
    if what == 0:
        channel["B"] = zeros(channel["B"])
    elif what == 1:
        channel["C"] = zeros(channel["C"])
    elif what == 2:
        plant["time"] = "discrete" if plant["time"] == "continuous" else "continuous"
    elif what == 3:
        rows = rows_of(plant["A"])
        rows[rng.randrange(len(rows))] = [0] * len(rows)
        plant["A"] = table(rows, len(rows))
    else:
        names = [c["name"] for c in plant["channels"]]
        i, j = rng.sample(names, 2)
        plant["neighbors"][i] = sorted(set(plant["neighbors"][i]) ^ {j}, key=names.index)


def tries(number: int, batch: Batch) -> Iterator[Try]:
    """The tries of a batch, each made when the verdict on the one before is known."""
    for k in range(SIZE):
        if k == 0:
            made = "original", batch.original
        else:
            names = list(MUTATORS)
            name = batch.rng.choices(names, [MUTATORS[name][0] for name in names])[0]
            made = MUTATORS[name][1](batch)
        yield Try(number * SIZE + k, batch.kind, batch.focus, *made)


Made = tuple[str, Any]


def _edited(batch: Batch) -> Made:
    """One to three changes."""
    document = copied(batch.original)
    names = [batch.rng.choice(list(EDITS)) for _ in range(batch.rng.choice((1, 1, 1, 2, 3)))]
    for name in names:
        _tried(EDITS[name], batch.rng, document)
    return (names[0] if len(names) == 1 else "several changes"), document


def _tried(edit: Any, *arguments: Any) -> Any:
    """An edit that may meet a document that other edits have broken."""
    try:
        return edit(*arguments)
    except (
        KeyError,
        TypeError,
        IndexError,
        ValueError,
        AttributeError,
        ArithmeticError,
        Unspecified,
    ):
        return None


def _relatives(batch: Batch) -> list[Document]:
    return [*batch.siblings, *batch.siblings, *batch.strangers]


def _spliced(batch: Batch) -> Made:
    """Nodes of another certificate."""
    document = copied(batch.original)
    other = batch.rng.choice(_relatives(batch))
    for _ in range(batch.rng.choice((1, 1, 2))):
        _tried(splice, batch.rng, document, other, batch.rng.choice(PARTS))
    return "splice", document


def _crossed(batch: Batch) -> Made:
    """Whole parts of another certificate."""
    return "parts of two", crossed(batch.rng, batch.original, batch.rng.choice(_relatives(batch)))


def _kind_swapped(batch: Batch) -> Made:
    """The same document under another kind."""
    return "another kind", {**batch.original, "kind": batch.rng.choice(ORDER)}


def _kept(batch: Batch) -> Made:
    """Changes after which the claim is still proved, nearly always."""
    document = copied(batch.original)
    what = batch.rng.choice(("respelled", "denominators", "large prime", "other gains"))
    if what == "respelled":
        return what, respelled(batch.rng, document)
    if what == "denominators":
        _tried(EDITS[what], batch.rng, document)
    elif what == "large prime":
        _tried(other_modulus, batch.rng, document, LARGE_PRIMES)
    else:
        _tried(other_gains, batch.rng, document, 10**6)
    return f"kept: {what}", document


def _names(batch: Batch) -> list[str]:
    return [channel["name"] for channel in batch.original["system"]["channels"]]


def _key_twice(batch: Batch) -> Made:
    """A key of an object given twice, with another value the first or the second time."""
    document = copied(batch.original)
    found = [(p, v) for p, v in nodes(document) if isinstance(p[-1], str)]
    path, value = batch.rng.choice(found)
    parent = at(document, path[:-1])
    parent[f"{path[-1]}@@"] = batch.rng.choice((None, 0, [], value))
    return "key twice", json.dumps(document).replace("@@", "")


def _renamed(batch: Batch) -> Made:
    """New names, or the old ones in another order, in all parts or in some."""
    names = _names(batch)
    fresh = batch.rng.sample(["x", "y", "z", "ü", "1", "2", '"', "1+2", "\n"], len(names))
    new = batch.rng.choice((fresh, batch.rng.sample(names, len(names))))
    mapping = dict(zip(names, new, strict=True))
    if batch.rng.random() < 0.5:
        return "renamed everywhere", _tried(renamed, batch.original, mapping, PARTS)
    parts = tuple(part for part in PARTS if batch.rng.random() < 0.5)
    return "renamed in part", _tried(renamed, batch.original, mapping, parts)


def _permuted(batch: Batch) -> Made:
    """Channels in another order, in all parts or in some."""
    whole = batch.rng.random() < 0.5
    parts = PARTS if whole else tuple(p for p in PARTS if batch.rng.random() < 0.5)
    name = "permuted everywhere" if whole else "permuted in part"
    return name, _tried(permuted, batch.rng, batch.original, parts)


def _perturbed(batch: Batch) -> Made:
    """Another plant, which the subject may not even apply to."""
    document = copied(batch.original)
    _tried(perturbed, batch.rng, document["system"])
    return "another plant", document


def _forged(batch: Batch) -> Made:
    """A claim drawn at random, with a witness that is made to fit."""
    base = batch.rng.choice([batch.original, batch.original, *batch.siblings])
    made = _tried(forged, batch.rng, copied(base))
    return "forgery", base if made is None else made


def _repaired(batch: Batch) -> Made:
    """What was rejected last, changed at the place that the checker named."""
    if batch.rejected is None:
        return _edited(batch)
    document, place = copied(batch.rejected[0]), batch.rejected[1]
    part = place.partition(".")[0]
    if part not in ("claim", "witness"):
        part = "witness"
    change = batch.rng.choice((change_number, change_number, change_node, splice))
    if change is splice:
        _tried(splice, batch.rng, document, batch.rng.choice(_relatives(batch)), part)
    else:
        _tried(change, batch.rng, document, part)
    return "repair", document


MUTATORS = {
    "edited": (26, _edited),
    "token": (8, lambda batch: ("token", change_token(batch.rng, batch.original))),
    "spliced": (10, _spliced),
    "crossed": (10, _crossed),
    "another kind": (1, _kind_swapped),
    "kept": (10, _kept),
    "key twice": (1, _key_twice),
    "renamed": (4, _renamed),
    "permuted": (4, _permuted),
    "perturbed": (5, _perturbed),
    "forged": (17, _forged),
    "repaired": (10, _repaired),
}
