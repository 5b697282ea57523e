"""Judges of the sentences about single failures: each is tried, by the rank of every pencil."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
