"""Judges of the sentences why modes are fixed: what stays fixed with drawn numbers."""

from __future__ import annotations

import random

from flint import fmpq_poly

from tests.oracle.certificates.patterns import common, part, redrawn, without_feedback
from tests.oracle.certificates.systems import System
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import Case, Said, divides, irreducible


def _structural(plant: System, information: str = "own") -> fmpq_poly:
    """What is fixed with drawn numbers at the same places, with the own ones in A_UU."""
    rng, used = random.Random(1), [[i] for i in range(plant.m)]
    if information == "outputs":
        used = [list(N) for N in plant.graph()]
    U, other = without_feedback(plant, used), redrawn(rng, plant)
    return common(rng, other, used) / part(other.A, U) * part(plant.A, U)


def _named(said: Said, case: Case) -> list[fmpq_poly]:
    """The modes of the sentence; none if one of these is not fixed."""
    named, fixed = irreducible(said.values["p"]), [str(p) for p in case.own.fixed]
    return [p for p, _ in named] if all(str(p) in fixed for p, _ in named) else []


@judge("structural-none", "structural-modes")
def _pattern(said: Said, case: Case) -> bool:
    information = said.values["information"]
    if information != "own" and (information != "outputs" or case.plant.neighborhoods is None):
        return False
    used = [list(N) for N in case.plant.graph()] if information == "outputs" else None
    U = without_feedback(case.plant, used or [[i] for i in range(case.plant.m)])
    zeros = _structural(case.plant, information).degree() - len(U)
    apart, often = ((), 0) if said.rule == "structural-none" else said.values["modes"]
    return ([*apart], often) == ([k + 1 for k in sorted(U)], zeros)


@judge("fixed-by-zeros", "fixed-by-equalities")
def _why(said: Said, case: Case) -> bool:
    named, structural = _named(said, case), _structural(case.plant)
    zeros = said.rule == "fixed-by-zeros"
    return bool(named) and all(divides(p, structural) == zeros for p in named)
