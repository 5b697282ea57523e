"""A mutation engine: one place of a certificate is changed, and a slow oracle judges what is VALID.

    python -m tests.checker.mutations 200

Every number, name, key and list position is changed, one at a time, on its own.  A mutant must
never end in an error of the checker, and never make it work much longer than an original does.
One whose claim, subject, system or kind differs from the original's may be VALID only if the
oracle of its kind, run on the mutant's own system, confirms the claim.  Kinds join by registering
a :class:`Registration` in a module of ``tests/checker/oracles``, or as the ``ORACLE`` of the file
that tests their rule.
"""

from __future__ import annotations

import copy
import hashlib
import importlib
import json
import pkgutil
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from mcexact.checker import Verdict, check_document
from mcexact.checker.kinds import KINDS
from tests import effort
from tests.checker import oracles

Document = dict[str, Any]
Path = tuple[str | int, ...]

STATEMENT = ("kind", "system", "subject", "claim")
MOST_STEPS = 100_000
"""Of the checker on a mutant: some ten times as many as the largest original takes."""


@dataclass(frozen=True)
class Registration:
    """What the engine needs to know about a kind.

    Attributes
    ----------
    draw : callable
        A valid certificate from a seed, or None where the seed gives none.
    confirms : callable
        Whether the claim of a document is true of its own system and subject, found by a slow
        method that shares nothing with the checker.
    """

    draw: Callable[[int], Document | None]
    confirms: Callable[[Document], bool]


def registrations() -> dict[str, Registration]:
    """All kinds: the ``KINDS`` of the modules in ``oracles``, else ``ORACLE`` beside the tests."""
    found: dict[str, Registration] = {}
    for module in sorted(info.name for info in pkgutil.iter_modules(oracles.__path__)):
        found |= getattr(importlib.import_module(f"{oracles.__name__}.{module}"), "KINDS", {})
    for kind in KINDS.keys() - found.keys():
        found[kind] = importlib.import_module(f"tests.checker.test_{kind}").ORACLE
    return found


def places(node: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Every node of a document with its path, the root first."""
    yield path, node
    children = (
        node.items()
        if isinstance(node, dict)
        else enumerate(node)
        if isinstance(node, list)
        else ()
    )
    for key, child in children:
        yield from places(child, (*path, key))


def replaced(document: Document, path: Path, value: Any) -> Document:
    """A copy in which one node is another one."""
    result = copy.deepcopy(document)
    node: Any = result
    for key in path[:-1]:
        node = node[key]
    node[path[-1]] = value
    return result


def other_values(value: Any, document: Document, path: Path) -> list[Any]:
    """What to put in the place of a number, a name, a truth value or null.

    Which of the attacks on a number is tried is drawn from its place: all are, somewhere.
    """
    names = [channel["name"] for channel in document["system"]["channels"]]
    choice = hashlib.sha256(repr(path).encode()).digest()[0]
    if isinstance(value, bool):
        return [not value]
    if value is None:
        return [0, []][choice % 2 :][:1]
    if isinstance(value, int):
        ell = document["witness"].get("modulus")
        congruent = value + ell if isinstance(ell, int) else value + 2
        attacks = [-value, 0, 2 * value, value - 1, congruent, 10**9, 10**40]
        return [v for v in (value + 1, attacks[choice % len(attacks)]) if v != value]
    if value in names:
        return [names[(names.index(value) + 1) % len(names)], value + "'"][: 1 + (choice % 2)]
    try:
        number = Fraction(value)
    except ValueError:
        return [value + "x"]
    step = 1 if "/" in value else Fraction(1, 10 ** len(value.partition(".")[2]))
    moved = number + step
    decimal = f"{float(moved):.{len(value.partition('.')[2])}f}"
    return [str(moved) if "/" in value and moved.denominator > 1 else decimal]


def mutants(document: Document) -> Iterator[tuple[str, Document]]:
    """Every document with one place changed, and what was done to it."""
    for path, node in places(document):
        where = ".".join(map(str, path))
        if isinstance(node, dict):
            for key in node:
                yield f"{where}: {key} removed", _edited(document, path, lambda d, k=key: d.pop(k))
                yield (
                    f"{where}: {key} renamed",
                    _edited(document, path, lambda d, k=key: _rename(d, k)),
                )
        elif isinstance(node, list):
            for k in range(len(node)):
                yield f"{where}: {k} removed", _edited(document, path, lambda d, k=k: d.pop(k))
                yield (
                    f"{where}: {k} repeated",
                    _edited(document, path, lambda d, k=k: d.insert(k, d[k])),
                )
                if k + 1 < len(node) and node[k] != node[k + 1]:
                    yield (
                        f"{where}: {k} swapped",
                        _edited(document, path, lambda d, k=k: _swap(d, k)),
                    )
        else:
            for value in other_values(node, document, path):
                yield f"{where}: {node!r} -> {value!r}", replaced(document, path, value)


def _edited(document: Document, path: Path, edit: Callable[[Any], Any]) -> Document:
    result = copy.deepcopy(document)
    node: Any = result
    for key in path:
        node = node[key]
    edit(node)
    return result


def _rename(node: Document, key: str) -> None:
    node[key + "_"] = node.pop(key)


def _swap(node: list[Any], k: int) -> None:
    node[k], node[k + 1] = node[k + 1], node[k]


@dataclass
class Tally:
    """What became of the mutants."""

    certificates: Counter[str] = field(default_factory=Counter)
    rejected: Counter[str] = field(default_factory=Counter)
    same_statement: int = 0
    new_statement: int = 0
    failures: list[str] = field(default_factory=list)

    @property
    def mutants(self) -> int:
        """How many there were."""
        return sum(self.rejected.values()) + self.same_statement + self.new_statement

    def summary(self) -> str:
        """The numbers in words."""
        by = ", ".join(f"{count} {name}" for name, count in sorted(self.rejected.items()))
        return (
            f"{sum(self.certificates.values())} certificates of {len(self.certificates)} kinds, "
            f"{self.mutants} mutants: {sum(self.rejected.values())} rejected ({by}), "
            f"{self.same_statement} accepted with the old claim, {self.new_statement} with a new "
            f"one, {len(self.failures)} failures"
        )


def attack(document: Document, registered: Registration, tally: Tally) -> None:
    """Change every place of a valid certificate, and judge what is accepted."""
    tally.certificates[document["kind"]] += 1
    original = {key: document[key] for key in STATEMENT}
    for what, mutant in mutants(document):
        data = json.dumps(mutant).encode()
        try:
            with effort.at_most(MOST_STEPS):
                verdict = check_document(data)
            problem = _judge(mutant, original, verdict, registered, tally)
        except effort.TooMuchWork as error:
            problem = str(error)
        if problem:
            tally.failures.append(f"{document['kind']}: {what}: {problem}: {json.dumps(mutant)}")


def _judge(
    mutant: Document, original: Document, verdict: Verdict, registered: Registration, tally: Tally
) -> str:
    """Count one mutant; say what is wrong, if anything is."""
    if verdict.verdict == "ERROR":
        return verdict.line()
    if verdict.verdict != "VALID":
        tally.rejected[verdict.verdict] += 1
        return ""
    if {key: mutant.get(key) for key in STATEMENT} == original and _types_agree(mutant, original):
        tally.same_statement += 1
        return ""
    tally.new_statement += 1
    return "" if registered.confirms(mutant) else "VALID, but the oracle denies the claim"


def _types_agree(mutant: Document, original: Document) -> bool:
    """Whether the statements are the same text as well: True is not 1."""
    return json.dumps({key: mutant[key] for key in STATEMENT}) == json.dumps(original)


def draws(count: int, kinds: dict[str, Registration]) -> Iterator[Document]:
    """So many certificates, every kind in turn."""
    seed = found = 0
    while found < count:
        for kind in sorted(kinds):
            document = kinds[kind].draw(seed)
            if document is not None and found < count:
                found += 1
                yield document
        seed += 1


def run(count: int) -> Tally:
    """Attack so many certificates."""
    kinds, tally = registrations(), Tally()
    for document in draws(count, kinds):
        verdict = check_document(json.dumps(document).encode())
        if verdict.verdict != "VALID":
            tally.failures.append(f"{document['kind']}: the original: {verdict.line()}")
        attack(document, kinds[document["kind"]], tally)
    return tally


def main(count: int) -> int:
    """Print the numbers and every failure."""
    tally = run(count)
    print(tally.summary())
    for kind, number in sorted(tally.certificates.items()):
        print(f"  {number} {kind}")
    for failure in tally.failures:
        print(failure)
    return 1 if tally.failures else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1])))
