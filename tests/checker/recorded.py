"""The recorded table of sentences: certificates, and what each rule makes of them.

``corpus/sentences`` holds for some small plants certificates, one in a line, and ``rules.txt``
what the checker answers where a sentence rests on some of them.  ``corpus_sentences`` writes both.
"""

from __future__ import annotations

import functools
import itertools
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from mcexact.checker.command import Evidence
from mcexact.checker.core.budget import Budget
from mcexact.checker.core.reading import Limits
from mcexact.checker.core.system import digest, digest_of, read_plant
from mcexact.checker.kinds import KINDS, Check, Expectation, Verdict, attempt, nothing_beside
from mcexact.checker.sentences import RULES, Premise

CORPUS = Path(__file__).parent / "corpus" / "sentences"
TABLE = CORPUS / "rules.txt"
FORMAT = "mcexact-certificate/1"
MISSING = "INVALID premise because"
"""The answer where premises do not fit the roles: the table leaves it out."""
REFUSED = "!"
"""What stands before the position of the premise whose claim does not imply the sentence."""
CASTS = 10
LISTS = {"fixed_spectrum": ("claim", "factors"), "shared_dimensions": ("witness", "cuts")}
"""The list in certificates of a kind to whose members a sentence can point."""
NUMBER = re.compile(r"(?:^|,)([0-9]+)")
BESIDE = ("claim.polynomial.0", "claim.costs.0", "witness.tree.0")
"""Members of other lists there."""
Cast = str
"""Numbers of certificates with commas, each perhaps with pointers behind it."""


def recorded_rules() -> dict[str, Any]:
    """The rules about plants without a parameter; ``test_sentences_parameters`` has the others."""
    return {key: rule for key, rule in RULES.items() if not key.startswith("parametric-")}


@dataclass(frozen=True)
class World:
    """A plant, what the sentences are about, and certificates, in a fixed order.

    A certificate that has a ``system`` of its own is about that plant nearby.
    """

    name: str
    system: dict[str, Any]
    base: list[Any]
    certificates: list[dict[str, Any]]

    @staticmethod
    def read(path: Path) -> World:
        """Read what ``text`` has written."""
        first, *lines = path.read_text(encoding="ascii").splitlines()
        system, base = json.loads(first)
        keys = ("kind", "subject", "claim", "witness", "path", "statement", "system")
        rows = [json.loads(line) for line in lines]
        listed = [dict(zip(keys[: max(len(row), 6)], row, strict=True)) for row in rows]
        return World(path.stem, system, base, listed)

    def document(self, k: int) -> dict[str, Any]:
        """A certificate as it stands in a file."""
        parts = {key: self.certificates[k][key] for key in ("kind", "subject", "claim", "witness")}
        plant = self.certificates[k].get("system", self.system)
        return {"format": FORMAT, "system": plant, **parts}

    def file(self, k: int) -> str:
        """Its name."""
        return f"{k:02}_{self.certificates[k]['kind']}.json"

    @functools.cached_property
    def evidence(self) -> Evidence:
        """The certificates as the checker has them once it has found them VALID."""
        expected = Expectation(system=digest(read_plant(self.system)))
        near = {self.file(k) for k, each in enumerate(self.certificates) if "system" in each}
        found = Evidence(lambda name: b"", self.base, Limits(), expected, Budget(10**15), near)
        for k in range(len(self.certificates)):
            name, document = self.file(k), self.document(k)
            found.verdicts[name] = Verdict("VALID")
            check = Check(Expectation(), Limits(), nothing_beside, document=document)
            check.read_plant()
            check.build_subject()
            check.words = KINDS[document["kind"]].statement(document["claim"], check.system)
            found.premises[name] = found._premise(name, check)
        found.make_subject()
        return found

    @functools.cached_property
    def premises(self) -> list[Premise]:
        """The premises in the order of their numbers."""
        return list(self.evidence.premises.values())

    def because(self, cast: Cast) -> list[Any]:
        """The entries of a manifest for some certificates."""
        found = []
        for part in cast.split(",") if cast else []:
            number, *pointers = part.split("/")
            document, name = self.document(int(number)), self.file(int(number))
            if not pointers:
                found.append([name, "/kind", document["kind"]])
            for pointer in pointers:
                (node,) = self._at(int(number), pointer)
                found.append([name, "/" + pointer.replace(".", "/"), node])
        return found

    def answer(self, key: str, cast: Cast) -> str:
        """What a rule makes of some certificates: words, or code and place.

        Of the words the statement of a premise, the beginning "For" with its subject, and the
        digest of the plant are not repeated.
        """
        because = self.because(cast)
        cited = [self.premises[k] for k in dict.fromkeys(map(int, NUMBER.findall(cast)))]
        pointers = [tuple(p for name, p, _ in because if name == each.file) for each in cited]
        given = [replace(each, pointers=p) for each, p in zip(cited, pointers, strict=True)]
        words = attempt(lambda: RULES[key].implied(given, self.premises))
        if isinstance(words, Verdict):
            names = {premise.file: k for k, premise in enumerate(cited)}
            if (words.verdict, words.code) == ("INVALID", "claim") and words.place in names:
                return f"{REFUSED}{names[words.place]}"
            return f"{words.verdict} {words.code} {words.place}"
        for k, premise in enumerate(cited):
            words = words.replace(premise.statement, f"<{k}>")
        for k, premise in enumerate(cited):
            words = words.replace(f"{premise.about}: ", f"<about {k}>: ")
        return words.replace(self.evidence.expected.system, "<digest>")

    def casts(self, roles: Sequence[Sequence[str]], most: int = CASTS) -> list[Cast]:
        """Which certificates a sentence is made to rest on, from the kinds that its roles take."""
        kinds = [each["kind"] for each in self.certificates]
        fitting = {kind for role in roles for kind in role}
        kept, seen = [], set()
        for k, each in enumerate(self.certificates):
            about = (kinds[k], str([step["construction"] for step in each["subject"]]))
            few = len(seen) < 4 or kinds[k] == "transfer_graph" or "closed_loop" in about[1]
            if kinds[k] in fitting or (about not in seen and (roles or few)):
                kept.append(str(k))
            seen.add(about)
        if not roles:
            pairs = zip(kept[:2], kept[-2:], strict=False)
            return ["", *kept, *(f"{a},{b}" for a, b in pairs if a != b)]
        found = [*kept, *self._pointers(roles, kinds)]
        if len(roles) > 1:
            able = [[k for k in kept if kinds[int(k)] in role] for role in roles]
            whole = list(itertools.product(*(self._whole(each) for each in able)))
            step = max(1, -(-len(whole) // most))
            chosen = [list(cast) for cast in whole[::step]]
            for cast in chosen[:2]:
                chosen = [*chosen, cast[::-1], cast[1:], cast[:-1], [*able[0][:2], *cast]]
            if "pencil_rank" in roles[-1]:
                chosen += [[a, *ranks] for a in able[0] for ranks in self._ranks(able[-1])]
            found += [",".join(dict.fromkeys(cast)) for cast in chosen]
        return list(dict.fromkeys(found))

    def _whole(self, able: list[str]) -> list[str]:
        """The certificates that are about all channels, and one that is not."""
        m, found = len(self.system["channels"]), []
        for k in able:
            channels = self.certificates[int(k)]["claim"].get("channels")
            found.append(channels is None or len(channels) == m)
        partly = [k for k, all_of in zip(able, found, strict=True) if not all_of]
        return [k for k, all_of in zip(able, found, strict=True) if all_of] + partly[:1]

    def _ranks(self, able: list[str]) -> Iterator[list[str]]:
        """The ranks of one pencil, of one after the other, and of all but one."""
        sets = [self.certificates[int(k)]["claim"]["subset"] for k in able]
        for each in [list(s) for s in dict.fromkeys(map(tuple, sets))]:
            ranks = [k for k, s in zip(able, sets, strict=True) if s == each]
            yield ranks
            yield ranks[::-1]
            yield ranks[1:]
            yield [*ranks, *(k for k in able if k not in ranks)][: len(ranks) + 1]

    def _at(self, k: int, pointer: str) -> list[Any]:
        """What is at a place of a certificate, if anything is."""
        node: Any = self.document(k)
        try:
            for key in pointer.split("."):
                node = node[int(key) if isinstance(node, list) else key]
        except (IndexError, KeyError):
            return []
        return [node]

    def _pointers(self, roles: Sequence[Sequence[str]], kinds: list[str]) -> Iterator[Cast]:
        """Certificates of which single members of a list are meant."""
        for k, kind in enumerate(kinds):
            if len(roles) == 1 and kind in roles[0] and kind in LISTS:
                part, key = LISTS[kind]
                members = self.document(k)[part][key]
                for i in range(min(len(members), 4)):
                    yield f"{k}/{part}.{key}.{i}"
                for other in BESIDE:
                    yield from (f"{k}/{other}" for _ in self._at(k, other))
                if len(members) > 1:
                    yield f"{k}/{part}.{key}.1.{next(iter(members[1]))}/{part}.{key}.0"
                    yield f"{k}/{part}.{key}"


@functools.cache
def worlds() -> dict[str, World]:
    """All plants of the corpus, by name."""
    return {path.stem: World.read(path) for path in sorted(CORPUS.glob("*.jsonl"))}


@dataclass(frozen=True)
class Row:
    """A rule: its theorem, the kinds of its roles, and the answers that are not ``MISSING``."""

    topic: str
    theorem: str
    roles: list[list[str]]
    answers: dict[tuple[str, Cast], str]


@functools.cache
def table() -> dict[str, Row]:
    """The table, by the key of the rule."""
    rows: dict[str, Row] = {}
    row, name = Row("", "", [], {}), ""
    if not TABLE.exists():
        return rows
    for line in TABLE.read_text(encoding="ascii").splitlines():
        if line.startswith("# "):
            topic, key, *roles = line[2:].split(" ")
            rows[key] = row = Row(topic, "", [role.split("+") for role in roles], {})
        elif line.startswith("theorem: "):
            rows[key] = row = Row(row.topic, line[9:], row.roles, row.answers)
        elif line.startswith("  "):
            casts, _, told = line[2:].partition(": ")
            row.answers.update({(name, cast): told for cast in casts.split(" ")})
        else:
            name = line
    return rows


def keys(topic: str) -> list[str]:
    """The rules of a topic."""
    return [key for key, row in table().items() if row.topic == topic]


def compare(key: str) -> None:
    """Every answer of a rule is the recorded one.

    Raises
    ------
    AssertionError
        With the rule, the plant, the certificates, and both answers.
    """
    row = table()[key]
    assert RULES[key].theorem == row.theorem, f"the rule {key} rests on {RULES[key].theorem!r}"
    for name, world in worlds().items():
        usual = world.casts(row.roles)
        more = [cast for place, cast in row.answers if place == name and cast not in {*usual, "-"}]
        for cast in [*usual, *more]:
            found = world.answer(key, cast)
            expected = row.answers.get((name, cast or "-"), MISSING)
            if found != expected:
                files = [entry[:2] for entry in world.because(cast)]
                told = f"rule {key}, plant {name}, certificates {files}"
                raise AssertionError(f"{told}\nexpected {expected}\nfound    {found}")


def statement_mark(premise: Premise) -> str:
    """The beginning of the digest of a premise's statement."""
    return digest_of(premise.statement)[:16]
