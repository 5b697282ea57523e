"""Which roots of signals are fixed with models at the agents, beside the rank conditions.

Run as ``python -m tests.assurance.campaigns.signals [COUNT [FIRST [FILE]]]``.  The plants, in
continuous and discrete time, some with feedthrough and some with modes at roots of the signals, are
drawn by their number; agents may have fewer inputs than outputs that follow.  For each the package
decides the fixed modes of the plant with models, without messages and with states that are shared
over a ring, and the oracle the ranks of the plant alone for all sets of channels, in the fields of
the roots.  The checker has to accept each certificate.  Systems in the file (by default
``build/signals.jsonl``) are not examined again.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import extended_system, internal_model
from mcexact.derived.feedthrough import without_feedthrough
from mcexact.exact.polynomial import Polynomial
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle.enumeration import (
    Coefficients,
    PlainSystem,
    Rows,
    characteristic_polynomial,
    irreducible_factors,
    plain,
)
from tests.oracle.signals import fixed_signals

FILE = Path("build") / "signals.jsonl"
LARGEST = 16
"""The most states of a system with shared states that is decided."""
ALPHAS: dict[str, list[tuple[int | str, ...]]] = {
    "continuous": [
        *[(0, 1), (0, 0, 1), (-1, 1), (1, 0, 1), (2, 0, 1), (1, 0, 2, 0, 1)],
        (0, "1/4", 0, 1),
    ],
    "discrete": [(-1, 1), (1, -2, 1), (0, 1), (0, -1, 1), (1, -1, 1), (1, 1), (0, 1, 0, 1)],
}  # fmt: skip


def coefficients(alpha: tuple[int | str, ...]) -> Coefficients:
    """The coefficients as fractions."""
    return tuple(Fraction(str(c)) for c in alpha)


def table(rng: random.Random, nrows: int, ncols: int, share: float) -> Rows:
    """Small entries, about this share of them not 0."""
    values = [Fraction(1), Fraction(-1), Fraction(2), Fraction(1, 2)]
    return [
        [rng.choice(values) if rng.random() < share else Fraction(0) for _ in range(ncols)]
        for _ in range(nrows)
    ]


def drawn(rng: random.Random, alpha: Coefficients, time: str) -> MultiChannelSystem:
    """A plant, of whose modes some are roots of the signals in half of all cases."""
    n, m = rng.randint(1, 4), rng.randint(1, 3)
    share = rng.choice([0.5, 0.75, 1])
    A = table(rng, n, n, share)
    factor = next(iter(irreducible_factors(alpha)))
    d = len(factor) - 1
    if rng.random() < 0.5 and d <= n:
        for i in range(d):
            A[i] = [Fraction(int(j == i + 1 and j < d)) for j in range(n)]
        A[d - 1][:d] = [-c for c in factor[:d]]
    inputs = [rng.choice([0, 1, 1, 1, 2]) for _ in range(m)]
    enough = rng.random() < 0.6
    outputs = [rng.randint(0, p) if enough else rng.choice([0, 1, 1, 2]) for p in inputs]
    B = [table(rng, n, p, share) for p in inputs]
    C = [table(rng, q, n, share) for q in outputs]
    ports = sum(inputs), sum(outputs)
    D = table(rng, *ports[::-1], 0.5) if rng.random() < 0.4 and all(ports) else None
    if D is not None and d == 1 and rng.random() < 0.5:
        blocked(rng, -factor[0], A, B, C, D)
    return MultiChannelSystem(A, B, C, D=D, time=time)


def blocked(
    rng: random.Random, root: Fraction, A: Rows, B: list[Rows], C: list[Rows], D: Rows
) -> None:
    """Replace an output, so that no signal of the root reaches it: a row of v [λI − A, −B]."""
    n = len(A)
    i = rng.choice([i for i, rows in enumerate(C) if rows])
    place = sum(map(len, C[:i]))
    v = table(rng, 1, n, 0.8)[0]
    shifted = [[root * (a == b) - A[a][b] for b in range(n)] for a in range(n)]
    wide = [[-x for b in B for x in b[a]] for a in range(n)]
    C[i][0], D[place] = (
        [
            sum((x * row[k] for x, row in zip(v, rows, strict=True)), Fraction(0))
            for k in range(len(rows[0]))
        ]
        for rows in (shifted, wide)
    )


def ring(system: MultiChannelSystem) -> MultiChannelSystem:
    """The same plant whose agents receive messages of the agent before them."""
    m = system.m
    return system.with_neighbors(NeighborGraph(system.names, [[(i - 1) % m] for i in range(m)]))


def decided(system: MultiChannelSystem, alpha: Coefficients) -> tuple[set[Coefficients], bool]:
    """The factors of the signals that the package finds fixed, and whether the checker agrees."""
    answer = fixed_spectrum(system)
    verdict = check_document(protocol.encode(answer).encode("ascii"))
    roots = irreducible_factors(alpha)
    found = {tuple(factor.polynomial.coefficients) for factor in answer.factors}
    return {p for p in found if p in roots}, verdict.verdict == "VALID"


def examined(number: int) -> Examined:
    """What differs for the plant with a number."""
    rng = random.Random(f"signals {number}")
    time = rng.choice(["continuous", "discrete"])
    alpha = coefficients(rng.choice(ALPHAS[time]))
    system = drawn(rng, alpha, time)
    selection = None
    if rng.random() < 0.25:
        selection = [table(rng, rng.randint(0, q), q, 0.7) if q else [] for _, q in system.sizes]
    lists, D = plain(system), [list(row) for row in system.feedthrough_matrix().rows()]
    made = internal_model(ring(system), Polynomial.of(*alpha), selection)
    seen, wrong = Counter[str](), list[str]()
    alone = fixed_signals(lists, D, alpha, kept=selection)
    together = fixed_signals(lists, D, alpha, kept=selection, shared=True)

    def compare(about: MultiChannelSystem, expected: set[Coefficients], what: str) -> None:
        found, valid = decided(about, alpha)
        seen["certificates"] += 1
        seen[f"{what}: some root fixed" if expected else f"{what}: none fixed"] += 1
        if found != expected:
            wrong.append(f"{what}: {sorted(found)} decided, {sorted(expected)} by ranks")
        if not valid:
            wrong.append(f"{what}: the checker does not accept the certificate")

    compare(made, alone, "without messages")
    filtered = without_feedthrough(made)
    shares = shared_dimension_bound(filtered, share="states").deficiency
    if filtered.n + shares * system.m <= LARGEST:
        compare(extended_system(filtered, [shares] * system.m, "states"), together, "shared")
    seen["systems"] += 1
    seen[f"{time} time"] += 1
    seen["with feedthrough"] += system.D is not None
    seen["with regulated combinations"] += selection is not None
    seen["an agent with fewer inputs than outputs"] += any(p < q for p, q in system.sizes)
    seen["0 among the signals in discrete time"] += time == "discrete" and alpha[0] == 0
    seen["a mode of the plant among the signals"] += _meets(lists, alpha)
    seen["where messages matter"] += alone != together
    return wrong, seen


def _meets(system: PlainSystem, alpha: Coefficients) -> bool:
    """Whether the plant has a mode at a root of the signals."""
    modes = irreducible_factors(characteristic_polynomial(system.A))
    return any(p in modes for p in irreducible_factors(alpha))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 600, FILE, examined, "different answers"))
