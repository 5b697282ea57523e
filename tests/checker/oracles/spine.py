"""The kinds of the spine, by enumeration of all subsets of channels."""

from __future__ import annotations

import itertools
import json
import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath

from mcexact.analysis.fixed_modes.completeness import completeness
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.fixed_modes.pencil import pencil_rank
from mcexact.analysis.sharing.deficiency import deficiency
from mcexact.analysis.sharing.neighbor_graph import neighbor_graph
from mcexact.analysis.structure.controllability import joint_controllability, joint_observability
from mcexact.analysis.structure.controllability_indices import controllability_indices
from mcexact.analysis.structure.transfer_graph import transfer_graph
from mcexact.answer import codec
from mcexact.derived.augmented_outputs import augmented_outputs
from mcexact.exact.location import is_hurwitz, is_schur
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph
from tests.checker.mutations import Document, Registration
from tests.checker.oracles.subjects import coefficients_of, polynomial_of, subject_of
from tests.oracle import enumeration
from tests.oracle.draws import exact, sparse_system

SLACK = mpmath.mpf(10) ** -30


def drawn_system(seed: int) -> MultiChannelSystem:
    """A small system; every third one is an extended or augmented subject over a drawn graph."""
    rng = random.Random(seed)
    system = exact(sparse_system(rng, 4, 3), rng.choice(["continuous", "discrete"]))
    heard = [[j for j in range(system.m) if rng.random() < 0.4] for _ in range(system.m)]
    graphed, _ = with_graph(system, NeighborGraph(system.names, heard))
    return augmented_outputs(graphed) if seed % 3 == 2 else graphed


def _drawing(decide: Callable[[MultiChannelSystem], Any]) -> Callable[[int], Document | None]:
    """Certificates of a decision on drawn systems."""

    def draw(seed: int) -> Document | None:
        found = decide(drawn_system(seed))
        return None if found is None else json.loads(codec.encode(found))

    return draw


def _pencil(system: MultiChannelSystem) -> Any:
    """The pencil rank of a drawn subset at a factor of the characteristic polynomial."""
    small = enumeration.plain(system)
    factors = sorted(
        enumeration.irreducible_factors(enumeration.characteristic_polynomial(small.A))
    )
    if not factors:
        return None
    s = system.names[:: 1 + system.n % 2]
    return pencil_rank(system, s, polynomial_of(list(factors[0])))  # type: ignore[arg-type]


def _positions(document: Document, names: list[str]) -> list[int]:
    return [subject_of(document).index(name) for name in names]


def confirms_controllability(document: Document) -> bool:
    """The dimension by rank, the polynomial as χ_A over that of the controllable part."""
    claim, small = document["claim"], enumeration.plain(subject_of(document))
    T = _positions(document, claim["channels"])
    d = enumeration.controllable_dimension(small, T)
    outside = enumeration.characteristic_polynomial(_quotient(small, T, d))
    return (
        claim["dimension"] == d
        and claim["controllable"] is (d == small.n)
        and coefficients_of(claim["uncontrollable_polynomial"]) == outside
    )


def _quotient(small: enumeration.PlainSystem, T: list[int], d: int) -> enumeration.Rows:
    """A on the quotient by the controllable subspace, in a basis that extends one of it."""
    n = small.n
    block = [[value for t in T for value in small.B[t][i]] for i in range(n)]
    columns: list[list[Fraction]] = []
    for _ in range(n):
        columns += [list(column) for column in zip(*block, strict=True)]
        block = enumeration.product(small.A, block) if block and block[0] else block
    columns += [[Fraction(int(i == j)) for i in range(n)] for j in range(n)]
    basis: list[list[Fraction]] = []
    for column in columns:
        if enumeration.rank([*basis, column]) > len(basis):
            basis.append(column)
    T_rows = [list(row) for row in zip(*basis, strict=True)]
    inverse = _solved(T_rows)
    moved = enumeration.product(enumeration.product(inverse, small.A), T_rows)
    return [row[d:] for row in moved[d:]]


def _solved(rows: enumeration.Rows) -> enumeration.Rows:
    """The inverse, by Gauss and Jordan."""
    n = len(rows)
    work = [list(row) + [Fraction(int(i == j)) for j in range(n)] for i, row in enumerate(rows)]
    for k in range(n):
        pivot = next(i for i in range(k, n) if work[i][k])
        work[k], work[pivot] = work[pivot], work[k]
        work[k] = [value / work[k][k] for value in work[k]]
        for i in range(n):
            if i != k and work[i][k]:
                work[i] = [a - work[i][k] * b for a, b in zip(work[i], work[k], strict=True)]
    return [row[n:] for row in work]


def confirms_indices(document: Document) -> bool:
    """The ranks of [B … A^(k−1)B] one by one."""
    claim, small = document["claim"], enumeration.plain(subject_of(document))
    T = _positions(document, claim["channels"])
    block = [[value for t in T for value in small.B[t][i]] for i in range(small.n)]
    rows, ranks = [[] for _ in range(small.n)], [0]  # type: list[list[Fraction]], list[int]
    for _ in range(small.n + 1):
        rows = [a + b for a, b in zip(rows, block, strict=True)]
        ranks.append(enumeration.rank(rows))
        block = enumeration.product(small.A, block) if block and block[0] else block
    growing = [r for r, before in itertools.pairwise(reversed(ranks)) if r > before][::-1]
    steps = [b - a for a, b in itertools.pairwise([0, *growing])]
    indices = sorted(sum(s >= i for s in steps) for i in range(1, max(steps, default=0) + 1))
    reached = (growing or [0])[-1] == small.n
    return claim == {
        "channels": claim["channels"],
        "ranks": growing,
        "index": len(growing) if reached else None,
        "indices": indices[::-1],
    }


def confirms_graph(document: Document) -> bool:
    """Every Markov parameter of every pair."""
    claim, small = document["claim"], enumeration.plain(subject_of(document))
    arcs = [tuple(_positions(document, arc)) for arc in claim["arcs"]]
    parts = [_positions(document, part) for part in claim["components"]]
    found = enumeration.transfer_arcs(small) if small.n else []
    components = enumeration.strong_components(small.m, found)
    connected = len(components) <= 1
    return arcs == found and parts == components and claim["strongly_connected"] is connected


def confirms_fixed_spectrum(document: Document) -> bool:
    """Every subset of channels at every factor of χ_A; roots by high precision."""
    claim, system = document["claim"], subject_of(document)
    small = enumeration.plain(system)
    wanted = enumeration.fixed_factors(small)
    chi = enumeration.characteristic_polynomial(small.A)
    seen: list[Any] = []
    product = (Fraction(1),)
    roots: list[Any] = []
    for factor in claim["factors"]:
        p = coefficients_of(factor["polynomial"])
        parts = enumeration.irreducible_factors(p)
        seen += [q for q, count in parts.items() for _ in range(count)]
        product = _times(product, p)
        s = _positions(document, factor["channels"])
        least = max((wanted[q].rank for q in parts if q in wanted), default=-1)
        if not parts or any(q not in wanted or wanted[q].rank != least for q in parts):
            return False
        if any(enumeration.pencil_rank(small, s, q) != factor["rank"] for q in parts):
            return False
        if (
            factor["rank"] != least
            or enumeration.multiplicity(p, chi) != factor["multiplicity_in_A"]
        ):
            return False
        if enumeration.least_multiplicity(small, p) > factor["multiplicity_at_most"]:
            return False
        placed = is_hurwitz if system.time == "continuous" else is_schur
        if placed(polynomial_of(factor["polynomial"])) is not factor["stable"]:
            return False
        found = _roots(p)
        if not _discs_hold(factor["roots"], found):
            return False
        roots += found
    stable = all(factor["stable"] for factor in claim["factors"])
    return (
        sorted(seen) == sorted(wanted)
        and product == coefficients_of(claim["polynomial"])
        and claim["stabilizable"] is stable
        and _rate_holds(claim["best_rate"], roots, system.time)
    )


def _times(a: tuple[Fraction, ...], b: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    result = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, f in enumerate(a):
        for k, g in enumerate(b):
            result[i + k] += f * g
    return tuple(result)


def _roots(p: tuple[Fraction, ...]) -> list[Any]:
    with mpmath.workdps(60):
        exact_coefficients = [mpmath.mpf(c.numerator) / c.denominator for c in reversed(p)]
        return list(mpmath.polyroots(exact_coefficients, maxsteps=500, extraprec=400))


def _number(text: str) -> Any:
    value = Fraction(text)
    return mpmath.mpf(value.numerator) / value.denominator


def _discs_hold(discs: list[Document], roots: list[Any]) -> bool:
    """As many discs as roots, one root in each."""
    with mpmath.workdps(60):
        inside = [
            [
                k
                for k, root in enumerate(roots)
                if abs(root - mpmath.mpc(_number(disc["re"]), _number(disc["im"])))
                <= _number(disc["radius"]) + SLACK
            ]
            for disc in discs
        ]
    return sorted(inside) == [[k] for k in range(len(roots))]


def _rate_holds(interval: Document | None, roots: list[Any], time: str) -> bool:
    if not roots or interval is None:
        return not roots and interval is None
    with mpmath.workdps(60):
        continuous = time == "continuous"
        best = -max(r.real for r in roots) if continuous else max(abs(r) for r in roots)
        lower, upper = _number(interval["lower"]), _number(interval["upper"])
        return bool(lower - SLACK <= best <= upper + SLACK)


def confirms_completeness(document: Document) -> bool:
    """Connected, and no subset loses rank."""
    small = enumeration.plain(subject_of(document))
    arcs = enumeration.transfer_arcs(small) if small.n else []
    connected = len(enumeration.strong_components(small.m, arcs)) <= 1
    complete = connected and not enumeration.fixed_factors(small)
    return document["claim"]["complete"] is complete


def confirms_neighbor_graph(document: Document) -> bool:
    """Reachability by transitive closure."""
    graph = subject_of(document).neighbors
    if graph is None:
        return False
    connected = len(enumeration.strong_components(graph.m, graph.edges())) <= 1
    return document["claim"]["strongly_connected"] is connected


def confirms_pencil_rank(document: Document) -> bool:
    """The rank with a companion matrix in the place of every irreducible factor."""
    claim, small = document["claim"], enumeration.plain(subject_of(document))
    s = _positions(document, claim["subset"])
    parts = enumeration.irreducible_factors(coefficients_of(claim["polynomial"]))
    ranks = {enumeration.pencil_rank(small, s, q) for q in parts}
    return ranks == {claim["rank"]}


def confirms_deficiency(document: Document) -> bool:
    """The least rank over all subsets and factors."""
    small = enumeration.plain(subject_of(document))
    return bool(document["claim"]["deficiency"] == enumeration.deficiency(small))


def _observed(seed: int) -> Document | None:
    decide = joint_observability if seed % 2 else joint_controllability
    return _drawing(decide)(seed)


KINDS = {
    "completeness": Registration(_drawing(completeness), confirms_completeness),
    "controllability": Registration(_observed, confirms_controllability),
    "controllability_indices": Registration(_drawing(controllability_indices), confirms_indices),
    "deficiency": Registration(_drawing(deficiency), confirms_deficiency),
    "fixed_spectrum": Registration(_drawing(fixed_spectrum), confirms_fixed_spectrum),
    "neighbor_graph": Registration(_drawing(neighbor_graph), confirms_neighbor_graph),
    "pencil_rank": Registration(_drawing(_pencil), confirms_pencil_rank),
    "transfer_graph": Registration(_drawing(transfer_graph), confirms_graph),
}
