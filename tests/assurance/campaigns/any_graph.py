"""Fixed modes over any directed graph, beside ranks for closed sets of agents and drawn gains.

Run as ``python -m tests.assurance.campaigns.any_graph [COUNT [FIRST [FILE]]]``.  Of each drawn
plant over a drawn directed graph, strongly connected or not, it is compared

- which modes of the plant stay fixed modes of the errors of a distributed observer with drawn
  gains F, as `design_observer` decides it, with rank P_s(λ) < n for some closed set s of agents,
  that is N_s = s (no agent of s receives from others); eigenvalues of A + Σ B_j F_j are left out;
- which modes stay where agents may use the outputs of those that they receive from, with ranks for
  all sets, and with the multiplicities that drawn gains of this pattern leave;
- which modes stay however much is shared (`closure`), with ranks for closed sets;
- whether `design_observer` designs for a rate or a radius, or refuses, with what these ranks say of
  the modes that are not fast enough.

The checker has to accept each certificate.  Systems in the file (by default
``build/any_graph.jsonl``) are not examined again.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path
from typing import Any

from flint import fmpq, fmpq_poly

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import augmented_outputs, closure, error_system
from mcexact.errors import Impossible, LimitReached
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.distributed_observer import design_observer
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import (
    Coefficients,
    PlainSystem,
    Rows,
    characteristic_polynomial,
    irreducible_factors,
    least_multiplicity,
    pencil_rank,
    product,
    subsets,
)
from tests.oracle.sentences.cases import Region

FILE = Path("build") / "any_graph.jsonl"


def decided(system: MultiChannelSystem) -> tuple[set[Coefficients], bool]:
    """The fixed factors that the package finds, and whether the checker agrees."""
    answer = fixed_spectrum(system)
    verdict = check_document(protocol.encode(answer).encode("ascii"))
    found = {tuple(factor.polynomial.coefficients) for factor in answer.factors}
    return found, verdict.verdict == "VALID"


def closed_sets(heard: list[list[int]]) -> list[tuple[int, ...]]:
    """The sets of agents that receive from nobody outside."""
    return [s for s in subsets(len(heard)) if all({*heard[i]} <= {*s} for i in s)]


def fed_back(system: PlainSystem, gains: list[Rows]) -> Rows:
    """A + Σ B_j F_j."""
    closed = [list(row) for row in system.A]
    for B, F in zip(system.B, gains, strict=True):
        moved = product(B, F) if F else []
        closed = [[a + b for a, b in zip(*rows, strict=True)]
                  for rows in zip(closed, moved, strict=True)] if moved else closed  # fmt: skip
    return closed


def observed(system: MultiChannelSystem, stays: set[Coefficients], seen: Counter[str]) -> list[str]:
    """What is wrong with a design of an observer, or with its refusal."""
    discrete = system.time == "discrete"
    bound = Fraction(9, 10) if discrete else Fraction(1, 10)
    region = Region(system.time, fmpq(bound.numerator, bound.denominator))
    slow = [p for p in stays if not region.contains(fmpq_poly([fmpq_of(c) for c in p]))]
    try:
        wanted: dict[str, Any] = {"radius": bound} if discrete else {"rate": bound}
        design = design_observer(system, **wanted)
    except Impossible as refused:
        certificates, made = [refused.certificate], False
    except LimitReached as limit:
        return [f"no observer, but no reason: {limit}"]
    else:
        certificates, made = [*design.certificates.values()], design.stable
    seen["observers designed" if made else "observers refused"] += 1
    seen["certificates"] += len(certificates)
    wrong = [f"an observer is {'' if made else 'not '}designed, where {slow} stay"]
    wrong = wrong if made == bool(slow) else []
    for each in certificates:
        if check_document(protocol.encode(each).encode("ascii")).verdict != "VALID":
            wrong.append(f"the checker does not accept a certificate of the kind {each.kind}")
    return wrong


def fmpq_of(value: Fraction | int) -> fmpq:
    """The same number."""
    exact_value = Fraction(value)
    return fmpq(exact_value.numerator, exact_value.denominator)


def examined(number: int) -> Examined:
    """What differs for the plant with a number."""
    rng = random.Random(f"any graph {number}")
    lists = sparse_system(rng, states=3, channels=4)
    n, m = lists.n, lists.m
    share = rng.choice([0, 0.15, 0.3, 0.6])
    heard = [[j for j in range(m) if j == i or rng.random() < share] for i in range(m)]
    time = rng.choice(["continuous", "discrete"])
    plant = exact(lists, time)
    others = [[j for j in N if j != i] for i, N in enumerate(heard)]
    graph = NeighborGraph(plant.names, others)
    system = plant.with_neighbors(graph)
    modes = irreducible_factors(characteristic_polynomial(lists.A))
    seen, wrong = Counter[str](), list[str]()

    def compare(about: MultiChannelSystem, expected: set[Coefficients], skip: set[Coefficients],
                what: str) -> None:  # fmt: skip
        found, valid = decided(about)
        found = {p for p in found if p in modes} - skip
        seen["certificates"] += 1
        seen[f"{what}: some mode stays" if expected - skip else f"{what}: none stays"] += 1
        if found != expected - skip:
            wrong.append(f"{what}: {sorted(found)} decided, {sorted(expected - skip)} by ranks")
        if not valid:
            wrong.append(f"{what}: the checker does not accept the certificate")

    gains = [
        [[Fraction(rng.randint(-99, 99)) for _ in range(n)] for _ in range(plant.p(i))]
        for i in range(m)
    ]
    closed = closed_sets(heard)
    stays = {p for p in modes if any(pencil_rank(lists, s, p) < n for s in closed)}
    moved = set(irreducible_factors(characteristic_polynomial(fed_back(lists, gains))))
    compare(error_system(system, gains), stays, moved & {*modes}, "observer")

    used = PlainSystem(lists.A, lists.B, [[row for j in N for row in lists.C[j]] for N in heard])
    compare(augmented_outputs(closure(system)), stays, set(), "any sharing")
    fixed = {p for p in modes if any(pencil_rank(used, s, p) < n for s in subsets(m))}
    compare(augmented_outputs(system), fixed, set(), "outputs of neighbors")
    if fixed != {p for p in modes if least_multiplicity(used, p, number)}:
        wrong.append("outputs of neighbors: drawn gains move what ranks say is fixed, or do not")
    wrong += observed(system, stays, seen)
    seen["systems"] += 1
    seen["strongly connected graphs"] += graph.is_strongly_connected()
    seen["where closed sets matter"] += stays != {
        p for p in modes if any(pencil_rank(lists, s, p) < n for s in ((), tuple(range(m))))
    }
    return wrong, seen


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 600, FILE, examined, "different answers"))
