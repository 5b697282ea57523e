"""Judges of the sentences about control that varies in time or is nonlinear.

Nothing is merged: a mode is one that no causal control moves iff the pencil of some set of channels
on whose outputs no other channel acts has too low a rank there.
"""

from __future__ import annotations

import itertools

from flint import fmpq_poly

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
