"""Write the corpus of certificates, and what each rule for sentences makes of them.

    python -m tests.checker.corpus_sentences

The certificates come from the package's decisions and exact designs, and some are written by hand;
all of them are VALID.  The plants are chosen so that every kind occurs with every outcome of its
claim.  The answers are those of the checker as it is: read what has changed in ``rules.txt`` before
it is committed, since a false sentence would be recorded as well.
"""

from __future__ import annotations

import itertools
import json
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Any

from mcexact.checker.kinds import check_document
from tests.checker.corpus_plants import based, pool
from tests.checker.handmade import Document
from tests.checker.recorded import (
    CORPUS,
    MISSING,
    NUMBER,
    REFUSED,
    TABLE,
    World,
    recorded_rules,
    statement_mark,
)

LONGEST = 4000
"""The bytes of a certificate that is taken."""
WORDS = ("outputs", "states", "outputs+states", "controllable", "observable", "both")
MANY = 8
"""How many texts of one rule are looked for, which differ in more than names and numbers."""
NEARBY = "nearby_"
"""How a plant begins that has certificates about plants nearby, too; the first is about itself."""
WHOLE = ("design_", "tracking_", "performance_", NEARBY)
"""How plants begin of which every certificate is kept."""
CORE = ("fixed_spectrum", "assignability")
"""Kinds of which every plant has a certificate."""
FIRST = {
    "neighbor-graph-connected": "sharing",
    "nearby-fixed": "nearby",
    "design-carrier": "design",
    "members-nothing-fixed": "boxes",
    "performance-cost": "performance",
}
"""The first rules of topics, in the order of the checker's table; the first is the analysis."""


def world(name: str, documents: Iterable[Document], base: list[Any] | None = None) -> World:
    """A plant with certificates that differ, are not long, and are VALID."""
    taken: dict[str, Document] = {}
    for found in documents:
        found = json.loads(json.dumps(found))
        keys = ("kind", "subject", "claim", *["system"] * name.startswith(NEARBY))
        about = json.dumps([found[key] for key in keys], sort_keys=True)
        if len(json.dumps(found)) <= LONGEST and check_document(found).verdict == "VALID":
            taken.setdefault(about, found)
    system = next(iter(taken.values()))["system"]
    same = [found for found in taken.values() if found["system"] == system]
    listed = sorted(same, key=lambda found: found["kind"])
    if name.startswith(NEARBY):
        listed += [found for found in taken.values() if found["system"] != system]
    # Only what is about another plant names its own.
    own = [{k: v for k, v in each.items() if k != "system" or v != system} for each in listed]
    return World(name, system, base or [], own)


def text(made: World) -> str:
    """A plant as it is written: a line for itself, and one for each certificate."""
    rows: list[Any] = [[made.system, made.base]]
    for each, premise in zip(made.certificates, made.premises, strict=True):
        parts = [each[key] for key in ("kind", "subject", "claim", "witness")]
        nearby = [each["system"]] if "system" in each else []
        rows.append([*parts, premise.path, statement_mark(premise), *nearby])
    return "".join(json.dumps(row, separators=(",", ":")) + "\n" for row in rows)


Answers = dict[str, dict[str, list[str]]]


def answers(made: World) -> Answers:
    """What each rule makes of certificates, by the answer."""
    found: Answers = {}
    for key, rule in recorded_rules().items():
        roles = [list(role.kinds) for role in rule.roles]
        usual = made.casts(roles)
        for cast in [*usual, *(each for each in made.casts(roles, 400) if each not in set(usual))]:
            told = made.answer(key, cast)
            if told.startswith("ERROR"):
                raise ArithmeticError(f"{key}, {made.name}, {cast}: {told}")
            known = found.get(key, {}).get(told, [])
            if told != MISSING and (cast in usual or not known):
                found.setdefault(key, {}).setdefault(told, []).append(cast or "-")
    return found


def shape(value: Any) -> Any:
    """The form of a claim: how many of something there are, and whether a number is 0 or 1."""
    if isinstance(value, bool | None) or value in WORDS:
        return value
    if isinstance(value, str | int):
        number = re.fullmatch(r"(-?[0-9]+)(?:/([0-9]+))?", str(value))
        if number is None:
            return "name"
        exact = Fraction(int(number[1]), int(number[2] or 1))
        return str(exact) if exact in (0, 1) else "small" if exact < 1 else "large"
    if isinstance(value, dict):
        return [[key, shape(value[key])] for key in sorted(value)]
    return [min(len(value), 2), *sorted({str(shape(each)) for each in value})]


def marks(
    made: World, found: Answers, texts: dict[str, set[str]]
) -> Iterator[tuple[str, int, list[int]]]:
    """What a plant has to show: a mark, how often that is wanted, and certificates that show it."""
    time = made.system.get("time", "")
    for k, each in enumerate(made.certificates):
        claim = str(
            shape({**each["claim"], "": [step["construction"] for step in each["subject"]]})
        )
        yield f"{each['kind']} {claim}", 1, [k]
        if [step["construction"] for step in each["subject"]][-2:] == ["integrators", "extended"]:
            sizes = each["subject"][-1]["dimensions"]
            yield f"{each['kind']} {made.name} {sizes}", 1, [k]
        if each["kind"] in CORE and not each["subject"]:
            yield f"{each['kind']} {made.name}", 1, [k]
    for key, answered in found.items():
        for told, casts in answered.items():
            words = re.sub(r"#[#^*/+, -]*#", "#", re.sub(r'"[^"]*"|x|[0-9]+', "#", told))
            for cast in casts:
                numbers = [int(number) for number in NUMBER.findall(cast)]
                if told.startswith(("INVALID", REFUSED)):
                    yield f"{key} {told}", 2, numbers
                else:
                    yield f"{key} implied {time}", 1, numbers
                    if len(texts[key]) < MANY:
                        yield f"{key} implied {words}", 1, numbers
                    texts[key].add(words)


def choose(plants: Iterable[tuple[str, list[Document], list[Any]]]) -> list[tuple[World, Answers]]:
    """As few certificates as show everything that is to be seen."""
    counts: Counter[str] = Counter()
    texts: dict[str, set[str]] = defaultdict(set)
    chosen = []
    for name, documents, base in plants:
        whole = world(name, documents, base)
        needed: set[int] = set()
        for mark, wanted, numbers in marks(whole, answers(whole), texts):
            if counts[mark] < wanted:
                counts[mark] += 1
                needed.update(numbers)
        if name.startswith(WHOLE):
            needed = set(range(len(whole.certificates)))
        if needed:
            kept = [whole.certificates[k] for k in sorted(needed)]
            made = World(name, whole.system, whole.base, kept)
            chosen.append((made, answers(made)))
    return chosen


def write(chosen: list[tuple[World, Answers]]) -> None:
    """Write the corpus."""
    CORPUS.mkdir(parents=True, exist_ok=True)
    for path in CORPUS.glob("*.jsonl"):
        path.unlink()
    chosen = sorted(chosen, key=lambda pair: pair[0].name)
    for made, _ in chosen:
        (CORPUS / f"{made.name}.jsonl").write_text(text(made), encoding="ascii")
    lines, topic = [], "analysis"
    for key, rule in recorded_rules().items():
        topic = FIRST.get(key, topic)
        lines.append(" ".join(["#", topic, key, *("+".join(role.kinds) for role in rule.roles)]))
        lines.append(f"theorem: {rule.theorem}")
        for made, found in chosen:
            if key in found:
                lines.append(made.name)
                lines += [f"  {' '.join(casts)}: {told}" for told, casts in found[key].items()]
    TABLE.write_text("\n".join(lines) + "\n", encoding="ascii")


if __name__ == "__main__":
    plain_plants = ((name, documents, []) for name, documents in pool())
    write(choose(itertools.chain(based(), plain_plants)))
