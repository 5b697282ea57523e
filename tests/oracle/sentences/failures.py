"""Judges of the sentences about failures: each is tried, by the rank of every pencil."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations
from typing import Any

from tests.oracle.certificates.constructions import built
from tests.oracle.certificates.systems import System
from tests.oracle.sentences.analysis import control, judge, slowest_of, stable
from tests.oracle.sentences.cases import Case, Facts, Said, irreducible

Failure = tuple[str, Any, Any]


def every_failure(plant: System, *, heard: bool) -> Iterator[tuple[Failure, dict[str, Any]]]:
    """All single failures, as sentences have them, each with its construction."""

    def step(part: str, one: Any) -> dict[str, Any]:
        lost = {key: [] for key in ("agents", "actuators", "sensors", "links")}
        return {"construction": "failed", **lost, part: [one]}

    for i, name in enumerate(plant.names):
        yield ("agents", name, None), step("agents", name)
        for part, size in (("actuators", plant.B[i].ncols()), ("sensors", plant.C[i].nrows())):
            for k in range(1, size + 1):
                yield (part, name, k), step(part, [name, k])
    for i, N in enumerate(plant.graph() if heard else ()):
        for j in N:
            if j != i:
                ends = plant.names[j], plant.names[i]
                yield ("links", *ends), step("links", [*ends])


def fixed_after(case: Case) -> dict[Failure, Facts]:
    """What is known of the plant after each single failure."""
    heard = case.asked.get("information") == "outputs"
    then = [{"construction": "augmented_outputs"}] * heard
    several = every_failure(case.plant, heard=heard)
    return {one: Facts(built(case.plant, [step, *then])) for one, step in several}


def named(rows: Sequence[Said]) -> list[Failure]:
    """The failures that some sentences name."""
    return [(part, agent, which) for row in rows for part, agent, which in row.values["failures"]]


def right_parts(said: Said, case: Case) -> bool:
    """Whether links are among what can fail iff agents receive the outputs of others."""
    return bool(said.values["parts"] == case.asked.get("information", "own"))


def unstable(case: Case) -> list[Failure]:
    """The failures after which a fixed mode is not stable."""
    return [one for one, facts in fixed_after(case).items() if not stable(facts)]


def further(case: Case) -> list[Failure]:
    """The failures after which a further mode is fixed."""
    known = len(case.subject.fixed)
    return [one for one, facts in fixed_after(case).items() if len(facts.fixed) > known]


@judge("failures-unstable-row")
def _unstable(said: Said, case: Case) -> bool:
    return {*named([said])} == {*unstable(case)} != set()


@judge("failures-unstable")
def _so_many(said: Said, case: Case) -> bool:
    bad, all_of_them = len(unstable(case)), len(fixed_after(case))
    right = (said.values["k"], said.values["all"]) == (bad, all_of_them) and bad > 0
    return right and right_parts(said, case) and control(said, case)


@judge("failures-stabilizable")
def _stabilizable(said: Said, case: Case) -> bool:
    return not unstable(case) and right_parts(said, case) and control(said, case)


@judge("failures-fixed")
def _further(said: Said, case: Case) -> bool:
    """After each of them these modes are fixed, besides those that are fixed anyway."""
    after, modes = fixed_after(case), said.values["modes"]
    known = [*map(str, case.subject.fixed)]
    for one in named([said]):
        facts = after[one]
        more = [q for q in facts.fixed if str(q) not in known]
        named_ones = sorted(str(q) for p in modes for q, _ in irreducible(p))
        if not more or named_ones != sorted(map(str, more)) or not slowest_of(facts, said, case):
            return False
    return bool(named([said]))


@judge("failures-fixed-none")
def _none(said: Said, case: Case) -> bool:
    return not further(case) and right_parts(said, case)


@judge("failures-fixed-others")
def _none_of_the_others(said: Said, case: Case) -> bool:
    bad = named(case.others("failures-fixed"))
    return bool(bad) and not {*further(case)} - {*bad} and right_parts(said, case)


def after_several(case: Case, lost: Sequence[Failure]) -> Facts:
    """What is known of the plant after several failures of one part."""
    if not lost:
        return case.subject
    [part] = {part for part, _, _ in lost}
    heard = case.asked.get("information") == "outputs"
    place = case.plant.names.index
    if part == "links":
        lost = sorted(lost, key=lambda one: (place(one[1]), place(one[2])))
    ones = [agent if part == "agents" else [agent, which] for part, agent, which in lost]
    empty = {key: [] for key in ("agents", "actuators", "sensors", "links")}
    step = {"construction": "failed", **empty, part: ones}
    then = [{"construction": "augmented_outputs"}] * heard
    return Facts(built(case.plant, [step, *then]))


def fewest(case: Case, part: str, matters: Callable[[Facts], bool]) -> int | None:
    """The least number of failures of a part that matter, by enumeration; None if there is none."""
    heard = case.asked.get("information") == "outputs"
    every = [one for one, _ in every_failure(case.plant, heard=heard) if one[0] == part]
    for number in range(len(every) + 1):
        if any(matters(after_several(case, lost)) for lost in combinations(every, number)):
            return number
    return None


def more_fixed(case: Case) -> Callable[[Facts], bool]:
    """Whether more is fixed than without failures."""
    known = len(case.subject.fixed)
    return lambda facts: len(facts.fixed) > known


def _right_number(said: Said, case: Case, matters: Callable[[Facts], bool]) -> bool:
    """Whether the failures that are named matter, and no fewer than is said do."""
    lost = [tuple(one) for one in said.values["failures"]]
    part, spared = said.values["spared"]
    least = fewest(case, part, matters)
    between = said.values["between"]
    numbers = (spared + 1, len(lost) - 1) if between is None else tuple(between[1:])
    if least is None or not spared < least <= len(lost) or not matters(after_several(case, lost)):
        return False
    decided = between is None and least == len(lost) == spared + 1
    return decided or numbers == (spared + 1, len(lost) - 1)


@judge("failures-fewest-unstable")
def _fewest_unstable(said: Said, case: Case) -> bool:
    return stable(case.subject) and _right_number(said, case, lambda facts: not stable(facts))


@judge("failures-fewest-fixed")
def _fewest_fixed(said: Said, case: Case) -> bool:
    if not _right_number(said, case, more_fixed(case)):
        return False
    facts = after_several(case, [tuple(one) for one in said.values["failures"]])
    known = [*map(str, case.subject.fixed)]
    more = sorted(str(q) for q in facts.fixed if str(q) not in known)
    return more == sorted(str(q) for p in said.values["modes"] for q, _ in irreducible(p))


@judge("failures-all-stabilizable")
def _all_stable(said: Said, case: Case) -> bool:
    return fewest(case, said.values["part"], lambda facts: not stable(facts)) is None


@judge("failures-all-none")
def _all_none(said: Said, case: Case) -> bool:
    return fewest(case, said.values["part"], more_fixed(case)) is None
