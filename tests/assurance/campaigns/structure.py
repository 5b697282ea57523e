"""Structural answers against brute force; prints the counts.

Run as ``python -m tests.assurance.campaigns.structure [PART [COUNT [SEED]]]`` with PART one of
``pencils``, ``systems``, ``exceptional``, ``observers``, ``time``; the tests call the parts with
small counts.
"""

from __future__ import annotations

import itertools
import random
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from typing import Any

from sympy import QQ, Poly, Symbol

from mcexact.analysis.controllability import (
    controllability_indices,
    exceptional_gains,
    observability_indices,
)
from mcexact.analysis.fixed_modes import assignability, completeness, fixed_spectrum, pencil_rank
from mcexact.analysis.single_channel import Want, error_gains, single_channel_gains
from mcexact.analysis.structure import complementary_subsystem, transfer_graph
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import jointly_controllable_system
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.oracle import enumeration, structure
from tests.oracle.draws import exact, sparse_system

Seen = Counter[str]

SIDES: tuple[Want, ...] = ("controllable", "observable")


def agree(what: str, given: Any, wanted: Any) -> None:
    """Stop at a disagreement.

    Raises
    ------
    AssertionError
    """
    if given != wanted:
        message = f"{what}: found {given}, brute force says {wanted}"
        raise AssertionError(message)


def require_valid(what: str, answers: Iterable[Any]) -> None:
    """Stop at a certificate that the checker does not call VALID.

    Raises
    ------
    AssertionError
    """
    for answer in answers:
        verdict = check_document(encode(answer).encode("ascii"))
        if verdict.verdict != "VALID":
            message = f"{what}: {verdict.line()}"
            raise AssertionError(message)


def compare_pencils(names: Iterable[str], largest: int = 5) -> Seen:
    """The rank of every pencil of the named cases of at most so many channels, at every factor."""
    seen = Seen()
    for name in names:
        system = gallery.load(name)
        if system.m > largest:
            continue
        small = enumeration.plain(system)
        seen["cases"] += 1
        for p, _ in characteristic_polynomial(system.A).factor():
            for s in enumeration.subsets(system.m):
                found = pencil_rank(system, system.named(s), p)
                wanted = enumeration.pencil_rank(small, s, p.coefficients)
                agree(f"{name}, {s}, {p}", found.rank, wanted)
                require_valid(f"{name}, {s}, {p}", [found])
                seen["ranks"] += 1
                seen["ranks below n"] += wanted < system.n
                seen["ranks at irrational modes"] += p.degree > 1
    return seen


def compare_systems(count: int, seed: int) -> Seen:
    """Indices, remnant polynomials, completeness, arcs and single channels of drawn systems."""
    seen = Seen()
    for number in range(seed, seed + count):
        rng = random.Random(number)
        small = sparse_system(rng)
        _compare(f"system {number}", small, exact(small), rng, seen)
        seen["systems"] += 1
    return seen


def _compare(
    what: str,
    small: enumeration.PlainSystem,
    system: MultiChannelSystem,
    rng: random.Random,
    seen: Seen,
) -> None:
    answers: list[Any] = [controllability_indices(system), observability_indices(system)]
    for answer, view in zip(answers, (small, small.dual), strict=True):
        B = [[v for t in range(view.m) for v in view.B[t][i]] for i in range(view.n)]
        ranks = structure.index_ranks(view.A, B)
        agree(f"{what}, ranks", list(answer.ranks), ranks)
        agree(f"{what}, indices", answer.indices, structure.partition(ranks))
    graph = transfer_graph(system)
    arcs = [(system.indices([j])[0], system.indices([i])[0]) for j, i in graph.arcs]
    agree(f"{what}, arcs", arcs, structure.rational_arcs(small))
    found = completeness(system)
    agree(f"{what}, complete", found.complete, enumeration.is_complete(small))
    seen["complete"] += found.complete
    q, side = rng.randrange(system.m), rng.choice(SIDES)
    alone = single_channel_gains(system, system.names[q], want=side)
    wanted = structure.single_channel(small if side == "controllable" else small.dual, q)
    agree(f"{what}, {side} through {q}", alone.exists, wanted)
    seen[f"{side} through one channel"] += alone.exists
    split = assignability(system)
    seen["spectrum in parts"] += len([b for b in split.blocks if b.dimension]) > 1
    answers += [graph, found, alone, split]
    if system.m > 1:
        proper = [s for s in enumeration.subsets(system.m) if 0 < len(s) < system.m]
        s = rng.choice(proper)
        part = complementary_subsystem(system, system.named(s))
        agree(f"{what}, remnant of {s}", part.remnant.coefficients, structure.remnant(small, s))
        transfer = any(j not in s and i in s for j, i in arcs)
        agree(f"{what}, {s} complete", part.complete, transfer and part.remnant.degree == 0)
        agree(f"{what}, {s} transfer", part.transfer_zero, not transfer)
        seen["remnant polynomials"] += 1
        seen["remnant polynomials above 1"] += part.remnant.degree > 0
        seen["subsystems incomplete by rank alone"] += transfer and not part.complete
        answers.append(part)
    require_valid(what, answers)


def compare_exceptional(count: int, seed: int, states: int = 5) -> Seen:
    """Both exceptional sets of so many controllable pairs."""
    rng, seen = random.Random(seed), Seen()
    while seen["triples"] < count:
        n, p = rng.randint(1, states), rng.randint(1, 2)
        M, A, B = (_table(rng, n, width) for width in (n, n, p))
        try:
            found = exceptional_gains(M, A, B)
        except Impossible as refused:
            require_valid("not controllable", [refused.certificate])
            continue
        seen["triples"] += 1
        what = f"triple {seen['triples']} of seed {seed}"
        M_rows, A_rows, B_rows = (
            [[Fraction(v) for v in row] for row in table] for table in (M, A, B)
        )
        agree(f"{what}, index", found.index, len(structure.index_ranks(A_rows, B_rows)))
        pairs = ((found.index_set, found.index), (found.controllability_set, n))
        for answer, blocks in pairs:
            wanted = structure.exceptional(M_rows, A_rows, B_rows, blocks)
            agree(what, answer.polynomial.coefficients, wanted)
            _compare_real_roots(what, answer)
            require_valid(what, [answer])
        require_valid(what, [found.indices])
        first, second = found.index_set, found.controllability_set
        seen["with a real root"] += bool(first.real_roots)
        seen["with an irrational real root"] += any(
            _real_roots(f.polynomial.coefficients) for f in first.factors if f.polynomial.degree > 1
        )
        seen["two different sets"] += first.real_roots != second.real_roots
    return seen


def _table(rng: random.Random, nrows: int, ncols: int) -> list[list[int]]:
    return [[rng.choice([0, 0, 1, -1, 2]) for _ in range(ncols)] for _ in range(nrows)]


def _real_roots(coefficients: enumeration.Coefficients) -> list[Any]:
    """Isolating intervals of the real roots, by sympy."""
    values = [QQ(c.numerator, c.denominator) for c in reversed(coefficients)]
    p = Poly(values, Symbol("x"), domain=QQ)
    return [] if p.degree() < 1 else [i for i, _ in p.intervals()]


def _compare_real_roots(what: str, answer: Any) -> None:
    """As many as sympy isolates, and each interval with a change of sign or a root at its ends."""
    p = answer.polynomial
    agree(f"{what}, real roots", len(answer.real_roots), len(_real_roots(p.coefficients)))
    for low, high in answer.real_roots:
        agree(f"{what}, sign change", p(low) * p(high) <= 0, True)


def graphs(m: int, *, connected: bool) -> Iterator[list[list[int]]]:
    """All graphs on m vertices that are strongly connected, or all that are not."""
    pairs = [(j, i) for j in range(m) for i in range(m) if i != j]
    for chosen in itertools.product([False, True], repeat=len(pairs)):
        arcs = [pair for pair, there in zip(pairs, chosen, strict=True) if there]
        if (len(enumeration.strong_components(m, arcs)) == 1) == connected:
            yield [[j for j, i in arcs if i == k] for k in range(m)]


def compare_observers(count: int, seed: int) -> Seen:
    """Proposition 1 over every graph on 2 and 3 vertices, and so many drawn ones on 4 and 5."""
    rng, seen = random.Random(seed), Seen()
    for m in (2, 3):
        for heard in graphs(m, connected=True):
            _observed(rng, heard, rng.randint(1, 3), seen)
    for _ in range(count):
        m = rng.choice([4, 5])
        order = rng.sample(range(m), m)
        cycle = zip(order, order[1:] + order[:1], strict=True)
        sets = [{j for j in range(m) if j != i and rng.random() < 0.2} for i in range(m)]
        for j, i in cycle:
            sets[i].add(j)
        _observed(rng, [sorted(each) for each in sets], rng.randint(1, 3), seen)
    for n in (1, 2):
        for heard in graphs(3, connected=False):
            system, F = _plant(rng, 3, n, heard)
            found = error_gains(system, F)
            wanted = enumeration.is_complete(enumeration.plain(found.error))
            agree(f"not connected, {heard}, n = {n}", found.exists, wanted)
            require_valid(f"not connected, {heard}", [found.answer])
            seen[f"not connected: {'yes' if wanted else 'no'}"] += 1
    return seen


def _plant(
    rng: random.Random, m: int, n: int, heard: list[list[int]]
) -> tuple[MultiChannelSystem, list[list[list[int]]]]:
    """A jointly controllable and observable plant over a graph, and feedback gains."""
    choices = SeededChoices(rng.randrange(10**9))
    system = jointly_controllable_system(choices, n, m).system
    system = system.with_neighbors(NeighborGraph(system.names, tuple(map(tuple, heard))))
    F = [[[rng.randint(-2, 2) for _ in range(n)] for _ in range(system.p(i))] for i in range(m)]
    return system, F


def _observed(rng: random.Random, heard: list[list[int]], n: int, seen: Seen) -> None:
    m = len(heard)
    system, F = _plant(rng, m, n, heard)
    found = error_gains(system, F)
    what = f"m = {m}, n = {n}, {heard}"
    agree(what, found.exists, True)
    agree(f"{what}, index", {pair[0] for pair in found.indices or ()}, {m})
    require_valid(what, [found.answer])
    seen[f"strongly connected on {m} vertices"] += 1


def timing(n: int = 100, m: int = 20, seed: int = 1, repeats: int = 5) -> tuple[float, float]:
    """Seconds for ``fixed_spectrum`` and for ``completeness`` of one complete system, the least."""
    rng = random.Random(seed)

    def sparse(nrows: int, ncols: int, density: float) -> list[list[int]]:
        return [
            [rng.choice([1, -1, 2]) if rng.random() < density else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]

    A = sparse(n, n, 0.1)
    system = MultiChannelSystem(
        A, [sparse(n, 1, 0.2) for _ in range(m)], [sparse(1, n, 0.2) for _ in range(m)]
    )
    seconds = []
    for decide in (fixed_spectrum, completeness):
        taken = []
        for _ in range(repeats):
            start = time.perf_counter()
            answer: Any = decide(system)
            encode(answer)
            taken.append(time.perf_counter() - start)
        seconds.append(min(taken))
    return seconds[0], seconds[1]


def main(arguments: list[str]) -> None:
    """Run one part, or all, and print the counts."""
    part = arguments[0] if arguments else "all"
    count = int(arguments[1]) if len(arguments) > 1 else None
    seed = int(arguments[2]) if len(arguments) > 2 else 1
    runs: dict[str, Callable[[], Seen]] = {
        "pencils": lambda: compare_pencils(gallery.names()),
        "systems": lambda: compare_systems(count or 2000, seed),
        "exceptional": lambda: compare_exceptional(count or 300, seed),
        "observers": lambda: compare_observers(count or 40, seed),
    }
    for name, run in runs.items():
        if part in ("all", name):
            start = time.perf_counter()
            seen = run()
            print(f"{name} ({time.perf_counter() - start:.0f} s)")
            for what, number in sorted(seen.items()):
                print(f"  {number:6d}  {what}", flush=True)
    if part in ("all", "time"):
        spectrum, complete = timing()
        print(f"n = 100, m = 20: fixed_spectrum {spectrum:.4f} s, completeness {complete:.4f} s")
        print(f"  {complete / spectrum:.2f} times as long")


if __name__ == "__main__":
    main(sys.argv[1:])
