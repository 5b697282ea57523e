"""Judges of the sentences about control that varies in time or is nonlinear.

Nothing is merged: a mode is one that no causal control moves iff the pencil of some set of channels
on whose outputs no other channel acts has too low a rank there.  The loop of a periodic controller
is multiplied step by step, and iterated.
"""

from __future__ import annotations

import itertools
from fractions import Fraction

from flint import fmpq, fmpq_mat, fmpq_poly

from tests.oracle.certificates.controllers import Loop, read_agents
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import Case, Facts, Region, Said, same_roots


def unaffected(facts: Facts) -> list[tuple[int, ...]]:
    """The sets of channels on whose outputs no channel outside acts."""
    subsets = [s for k in range(facts.m + 1) for s in itertools.combinations(range(facts.m), k)]
    return [s for s in subsets if not any(i in s and j not in s for j, i in facts.arcs)]


def unmoved(facts: Facts) -> list[fmpq_poly]:
    """The irreducible factors of det(xI − A) whose roots no causal decentralized control moves."""
    sets = unaffected(facts)
    return [p for p, _ in facts.modes if any(facts.rank(s, p) < facts.n for s in sets)]


def _all_stable(case: Case) -> bool:
    region = Region(case.subject.system.time)
    return all(region.contains(p) for p in unmoved(case.subject))


@judge("quotient-fixed-none")
def _none(said: Said, case: Case) -> bool:
    return not unmoved(case.subject)


@judge("quotient-fixed")
def _some(said: Said, case: Case) -> bool:
    return same_roots(said.values["p"], unmoved(case.subject))


@judge("time-varying-stabilizes")
def _stabilizes(said: Said, case: Case) -> bool:
    return _all_stable(case)


@judge("no-causal-control")
def _never(said: Said, case: Case) -> bool:
    return not _all_stable(case)


def period(case: Case) -> fmpq_mat:
    """What the steps of a period do with the state of the loop, one after the other."""
    phases = [] if case.controller is None else case.controller["phases"]
    made = [Loop(case.plant, read_agents(case.plant, phase)).matrix() for phase in phases]
    state = fmpq_mat(made[0].nrows(), made[0].nrows(), identity_entries(made[0].nrows()))
    for step in made:
        state = step * state
    return state


def identity_entries(n: int) -> list[int]:
    """The entries of the identity."""
    return [int(i == j) for i in range(n) for j in range(n)]


def _within(case: Case, radius: Fraction) -> bool:
    """Whether all eigenvalues of a period have modulus below a radius."""
    region = Region("discrete", fmpq(radius.numerator, radius.denominator))
    return region.contains(period(case).charpoly())


@judge("periodic-stabilizes", "periodic-unstable")
def _periodic(said: Said, case: Case) -> bool:
    right = said.values["period"] == len((case.controller or {})["phases"])
    return right and _within(case, Fraction(1)) == (said.rule == "periodic-stabilizes")


@judge("periodic-radius", "periodic-slow")
def _decay(said: Said, case: Case) -> bool:
    steps = len((case.controller or {})["phases"])
    inside = _within(case, Fraction(said.values["radius"]) ** steps)
    return said.values["steps"] == steps and inside == (said.rule == "periodic-radius")


@judge("periodic-states")
def _states(said: Said, case: Case) -> bool:
    return bool(said.values["n"] == period(case).nrows())


@judge("periodic-order")
def _order(said: Said, case: Case) -> bool:
    return bool(said.values["order"] == period(case).nrows() - case.plant.n)
