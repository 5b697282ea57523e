"""Answers for all values of a parameter, against enumeration at points and modulo primes.

Run as ``python -m tests.assurance.campaigns.parametric [COUNT [FIRST [FILE]]]``; every certificate
is checked as well.  Systems in the file (by default ``build/parametric.jsonl``) are not examined
again: after an interruption the same command goes on.
"""

from __future__ import annotations

import itertools
import random
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import networkx as nx

from mcexact import (
    NeighborGraph,
    ParametricSystem,
    check,
    controllability_indices,
    fixed_spectrum,
    joint_controllability,
    joint_observability,
    observability_indices,
    setpoint_solvability,
    transfer_graph,
)
from mcexact.analysis.parameters.hypersurfaces import parametric_completeness
from mcexact.constructions import extended_system
from mcexact.derived.constructions import Share
from mcexact.errors import InputError
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle import enumeration
from tests.oracle.parametric import (
    claimed_radical,
    disagreements,
    fixed_radical,
    says_nothing,
    values,
)
from tests.oracle.parametric_draws import drawn_parametric
from tests.oracle.parametric_ranks import rank_disagreements, rank_of

FILE = Path("build") / "parametric.jsonl"
POINTS = 40
FIELDS = (211, 241)
"""The primes at all points modulo which answers are compared as well."""


def points(rng: random.Random, count: int) -> list[Fraction]:
    """Small integers, then drawn fractions."""
    found = [Fraction(k) for k in range(-5, 6)]
    while len(found) < count:
        found.append(Fraction(rng.randint(-30, 30), rng.randint(2, 12)))
    return found[:count]


def examined(number: int, count: int = POINTS) -> tuple[list[str], dict[str, int]]:
    """What is wrong about a drawn system, and what was found."""
    rng = random.Random(number)
    system = drawn_parametric(rng)
    found = fixed_spectrum(system)
    verdict = check(found, system)
    wrong = [] if verdict.verdict == "VALID" else [verdict.line()]
    exact = [each.exact for each in found.exceptional if each.exact is not None]
    wrong += disagreements(system, found, [*points(rng, count), *exact], FIELDS)
    seen = {
        "systems": 1,
        "with generic fixed modes": bool(found.generic),
        "of degree 2 or 3": any(len(p) > 2 for p in found.generic),
        "rational values": len(exact),
        "irrational values": len(found.exceptional) - len(exact),
        "complex values": sum(not each.real for each in found.exceptional),
        "settled values": len(found.settled),
        "values out of range": len(found.outside),
        "with poles": bool(found.undefined_at),
    }
    return wrong, {key: int(value) for key, value in seen.items()}


def companions(number: int, count: int = POINTS) -> tuple[list[str], dict[str, int]]:
    """What is wrong about the other answers about a drawn system, and what was found."""
    rng = random.Random(number)
    system = drawn_parametric(rng)
    chosen = rng.sample(system.names, rng.randint(1, system.m))
    lost = joint_controllability(system, chosen), joint_observability(system, chosen)
    edges = transfer_graph(system)
    indices = rng.choice((controllability_indices, observability_indices))
    ranks = [
        setpoint_solvability(system),
        rng.choice(indices(system, chosen)),
        *rng.sample(list(edges.certificates), 1),
    ]
    graph = NeighborGraph(
        system.names,
        [[j for j in range(system.m) if rng.random() < 0.4] for _ in range(system.m)],
    )
    sizes = [rng.choice((0, 0, 1)) for _ in system.names]
    share: Share = rng.choice(("outputs+states", "states"))
    shared = fixed_spectrum(extended_system(system, sizes, share, graph))
    verdicts = [(check(each, system), each) for each in (*lost, *ranks, shared)]
    wrong = [v.line() for v, _ in verdicts if v.verdict != "VALID"]
    drawn = points(rng, count)
    for rank in ranks:
        exact = [each.exact for each in rank.exceptional if each.exact is not None]
        wrong += rank_disagreements(rank, [*drawn, *exact], FIELDS)
    for found, dual in zip(lost, (False, True), strict=True):
        exact = [each.exact for each in found.exceptional if each.exact is not None]
        wrong += _wrongly_lost(system, found, chosen, dual, [*drawn, *exact])
    exact = [each.exact for each in shared.exceptional if each.exact is not None]
    for t in [*drawn[::8], *exact]:
        try:
            there = extended_system(system.at({"t": t}), sizes, share, graph)
        except InputError:
            continue
        plain = enumeration.plain(there)
        want = fixed_radical((plain.A, plain.B, plain.C))
        if not says_nothing(shared, t) and want != claimed_radical(shared, t):
            wrong.append(f"sharing {sizes} of {share} at t = {t}: {want}")
    whole = parametric_completeness(system, graph=edges)
    wrong += _wrongly_complete(system, whole, drawn[::8])
    seen = {
        "complete for almost every value": whole.generic,
        "controllability or observability lost somewhere": sum(bool(f.exceptional) for f in lost),
        "ranks that drop somewhere": sum(bool(f.exceptional) for f in ranks),
        "shared dimensions that are not enough somewhere": bool(shared.exceptional),
        "and enough everywhere": not (shared.exceptional or shared.generic),
    }
    return wrong, {key: int(value) for key, value in seen.items()}


def _wrongly_complete(system: ParametricSystem, found: Any, where: list[Fraction]) -> list[str]:
    """Where enumeration and an answer on completeness differ, also where it is lost."""
    wrong = []
    exact = [-q.coefficients[0] for q in found.exceptional if q.degree == 1]
    for t in [*where, *exact]:
        plain = values(system, t)
        if plain is None or says_nothing(found.spectrum, t):
            continue
        graph = nx.DiGraph()
        graph.add_nodes_from(system.names)
        for j, i in itertools.product(system.names, repeat=2):
            matrix = {"name": "transfer", "from": j, "to": i}
            if rank_of(matrix, plain, system.names, 0, system.time):
                graph.add_edge(j, i)
        complete = fixed_radical(plain).degree() == 0 and nx.is_strongly_connected(graph)
        said = found.generic and all(q(t) != 0 for q in found.exceptional)
        if complete is not said:
            wrong.append(f"completeness at t = {t}: {complete}")
    return wrong


def _wrongly_lost(
    system: ParametricSystem, found: Any, chosen: list[str], dual: bool, where: list[Fraction]
) -> list[str]:
    """Where Kalman's rank and an answer on controllability or observability differ."""
    matrix = {"name": "controllability", "channels": chosen, "blocks": max(system.n, 1)}
    wrong = []
    for t in where:
        plain = values(system, t)
        if plain is None or says_nothing(found, t):
            continue
        if dual:
            A, B, C = plain
            turned = [[[row[k] for row in M] for k in range(system.n)] for M in C]
            plain = [list(column) for column in zip(*A, strict=True)], turned, B
        whole = rank_of(matrix, plain, system.names, 0, system.time) == system.n
        if whole is (claimed_radical(found, t).degree() > 0):
            wrong.append(f"{chosen} {'observe' if dual else 'control'} at t = {t}: {whole}")
    return wrong


def with_companions(number: int) -> Examined:
    """The same for the fixed modes of one drawn system, and for all else that is decided."""
    (wrong, seen), (more, also) = examined(number), companions(number)
    return wrong + more, seen | also


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 1000, FILE, with_companions, "disagreements"))
