"""What is proved for all plants in a box, against exact decisions about members and segments.

Run as ``python -m tests.assurance.campaigns.boxes [COUNT [FIRST [FILE]]]``.  The radii of a drawn
system grow until no proof is found; vertices, edges and other members of the last box are decided.
Systems in the file (by default ``build/boxes.jsonl``) are not examined again.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

from flint import fmpq, fmpq_poly
from sympy import QQ, Poly
from sympy.polys.matrices import DomainMatrix

from mcexact import Matrix, MultiChannelSystem, check
from mcexact.boxes import Box, box_controllability, box_fixed_modes, box_stability
from mcexact.designs import local_controllers
from mcexact.errors import LimitReached
from tests.assurance.campaigns.resumed import main
from tests.oracle import enumeration
from tests.oracle.certificates.one_parameter import ParametricPlant, characteristic
from tests.oracle.certificates.ranges import driven, none_fixed, stays_inside
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import PlainSystem, Rows, X

FILE = Path("build") / "boxes.jsonl"
GROWTH = tuple(Fraction(k, 64) for k in (1, 8, 32, 128))
HALVINGS = 1
"""The factors of the radii, the smallest first, and how often what is between two is halved."""
Shares = Sequence[Fraction]
"""For each entry the part of its radius by which it is moved."""


@dataclass(frozen=True)
class Drawn:
    """A system, the largest radii of its entries, a time domain, and static gains."""

    center: PlainSystem
    radii: PlainSystem
    time: str
    gains: list[Rows]


def drawn_box(number: int) -> Drawn:
    """A system of at most three states, and gains that make it stable if some are found."""
    rng = random.Random(number)
    center, time = sparse_system(rng, 3, 2), rng.choice(("continuous", "discrete"))
    share = rng.choice((Fraction(1, 4), Fraction(1, 2)))

    def sizes(M: Rows) -> Rows:
        chances = [Fraction(0), Fraction(1, 4), Fraction(1)]
        return [[rng.choice(chances) * (abs(x) if x else share) for x in row] for row in M]

    radii = PlainSystem(sizes(center.A), [*map(sizes, center.B)], [*map(sizes, center.C)])
    gains: list[Rows] = []
    for size in (0, *[2] * 20):
        gains = [
            [
                [Fraction(rng.randint(-2 * size, 2 * size), 2) for _ in C]
                for _ in (B[0] if B else [])
            ]
            for B, C in zip(center.B, center.C, strict=True)
        ]
        if is_inside(enumeration.characteristic_polynomial(loop_of(center, gains)), time):
            break
    return Drawn(center, radii, time, gains)


def boxed(drawn: Drawn, growth: Fraction) -> MultiChannelSystem:
    """The box with so many times the radii."""
    nominal = exact(drawn.center, drawn.time)

    def times(M: Rows) -> Rows:
        return [[growth * x for x in row] for row in M]

    D = drawn.radii
    return Box.absolute(nominal, times(D.A), [*map(times, D.B)], [*map(times, D.C)]).system


def entries(system: PlainSystem) -> list[Fraction]:
    """Of A, of all B_i and of all C_i, row by row."""
    return [x for M in (system.A, *system.B, *system.C) for row in M for x in row]


def member(drawn: Drawn, growth: Fraction, shares: Sequence[Fraction]) -> PlainSystem:
    """The plant of the box whose entries are moved by these parts of their radii."""
    triples = zip(entries(drawn.center), entries(drawn.radii), shares, strict=True)
    moved = iter([x + growth * d * share for x, d, share in triples])

    def filled(M: Rows) -> Rows:
        return [[next(moved) for _ in row] for row in M]

    center = drawn.center
    return PlainSystem(filled(center.A), [*map(filled, center.B)], [*map(filled, center.C)])


def chosen(drawn: Drawn, rng: random.Random) -> tuple[list[Shares], list[tuple[Shares, Shares]]]:
    """Some members: the center, vertices, points on edges, others; edges, and lines across."""
    radii = entries(drawn.radii)
    moving = [k for k, d in enumerate(radii) if d]

    def vertex() -> Shares:
        return [Fraction(rng.choice((-1, 1))) for _ in radii]

    points: list[Shares] = [[Fraction(0)] * len(radii), *(vertex() for _ in range(4))]
    points += [[Fraction(rng.randint(-8, 8), 8) for _ in radii] for _ in range(2)]
    segments: list[tuple[Shares, Shares]] = []
    for _ in range(2):
        end = vertex()
        segments.append((end, [-share for share in end]))
        for k in rng.sample(moving, min(1, len(moving))):
            other = [-share if i == k else share for i, share in enumerate(end)]
            segments.append((end, other))
            inner = Fraction(rng.randint(-7, 7), 8)
            points.append([inner if i == k else share for i, share in enumerate(end)])
    return points, segments


def between(first: PlainSystem, last: PlainSystem, time: str) -> ParametricPlant:
    """All plants on a segment, by a parameter from 0 to 1."""

    def table(M: Rows, N: Rows, ncols: int) -> Any:
        rows = [
            [
                (fmpq_poly([_fmpq(x), _fmpq(y - x)]), fmpq_poly([1]))
                for x, y in zip(*pair, strict=True)
            ]
            for pair in zip(M, N, strict=True)
        ]
        return rows, len(rows), ncols

    n, tables = first.n, [table(first.A, last.A, first.n)]
    for B, B_last, C, C_last in zip(first.B, last.B, first.C, last.C, strict=True):
        tables += [table(B, B_last, len(B[0])), table(C, C_last, n)]
    names = tuple(map(str, range(first.m)))
    return ParametricPlant(time, names, "t", (fmpq(0), fmpq(1)), tuple(tables))


def _fmpq(x: Fraction) -> fmpq:
    return fmpq(x.numerator, x.denominator)


def loop_of(system: PlainSystem, gains: list[Rows]) -> Rows:
    """A + Σ B_i F_i C_i."""
    A = system.A
    for B, F, C in zip(system.B, gains, system.C, strict=True):
        if F and C:
            moved = enumeration.product(enumeration.product(B, F), C)
            A = [[x + y for x, y in zip(*rows, strict=True)] for rows in zip(A, moved, strict=True)]
    return A


def looped(plant: ParametricPlant, gains: list[Rows]) -> ParametricPlant:
    """The loops of all plants on a segment."""
    rows = [[top for top, _ in row] for row in plant.tables[0][0]]
    for (B, _, _), F, (C, _, _) in zip(plant.tables[1::2], gains, plant.tables[2::2], strict=True):
        for i, row in enumerate(rows):
            for a, F_a in enumerate(F):
                for b, gain in enumerate(F_a):
                    for j in range(plant.n):
                        row[j] += B[i][a][0] * _fmpq(gain) * C[b][j][0]
    A = [[(entry, fmpq_poly([1])) for entry in row] for row in rows]
    return replace(plant, names=(), tables=((A, plant.n, plant.n),))


def is_inside(p: Sequence[Fraction], time: str) -> bool:
    """Whether the roots have negative real parts, or moduli below 1, by determinants of Hurwitz."""
    n = len(p) - 1
    if time == "discrete":
        up, down = Poly(1 + X, X, domain=QQ), Poly(1 - X, X, domain=QQ)
        turned = sum(
            (up**k * down ** (n - k) * _QQ(c) for k, c in enumerate(p)), Poly(0, X, domain=QQ)
        )
        if turned.degree() < n:
            return False
        p = [Fraction(int(c.p), int(c.q)) for c in reversed(turned.all_coeffs())]
    a = [_QQ(c / p[-1]) for c in reversed(p)]
    H = [
        [a[2 * j - i + 1] if 0 <= 2 * j - i + 1 <= n else QQ(0) for j in range(n)] for i in range(n)
    ]
    return all(
        DomainMatrix([row[:k] for row in H[:k]], (k, k), QQ).charpoly()[-1] * (-1) ** k > 0
        for k in range(1, n + 1)
    )


def _QQ(c: Fraction) -> Any:
    return QQ(c.numerator, c.denominator)


def fixed_polynomials(system: PlainSystem) -> list[Sequence[Fraction]]:
    """Those of the fixed modes: all subsets are tried unless drawn gains move every mode."""
    rng, common = random.Random(1), Poly(0, X, domain=QQ)
    for bound in (0, 10**3, 10**6):
        chi = enumeration.characteristic_polynomial(
            enumeration.drawn_closed_loop(system, rng, bound)
        )
        common = common.gcd(Poly([_QQ(c) for c in reversed(chi)], X, domain=QQ))
    return [] if common.degree() == 0 else [*enumeration.fixed_factors(system)]


@dataclass(frozen=True)
class Question:
    """How it is proved for a box, and decided about a member and about a segment."""

    proved: Callable[[Drawn, MultiChannelSystem], Any]
    holds: Callable[[Drawn, PlainSystem], bool]
    along: Callable[[Drawn, ParametricPlant], bool]


def _controller(drawn: Drawn, system: MultiChannelSystem) -> Any:
    sizes = zip(drawn.gains, drawn.center.C, strict=True)
    return local_controllers(system, [Matrix.from_rows(F, ncols=len(C)) for F, C in sizes])


def _border(drawn: Drawn) -> int:
    return int(drawn.time == "discrete")


QUESTIONS = {
    "no fixed mode": Question(
        lambda drawn, box: box_fixed_modes(box, starts=1),
        lambda drawn, system: not fixed_polynomials(system),
        lambda drawn, line: none_fixed(line, None),
    ),
    "stabilizable": Question(
        lambda drawn, box: box_fixed_modes(box, bound=_border(drawn), starts=1),
        lambda drawn, system: all(is_inside(p, drawn.time) for p in fixed_polynomials(system)),
        lambda drawn, line: none_fixed(line, _border(drawn)),
    ),
    "controllable": Question(
        lambda drawn, box: box_controllability(box),
        lambda drawn, system: enumeration.controllable_dimension(system) == system.n,
        lambda drawn, line: none_fixed(driven(line, range(line.m)), None),
    ),
    "stable": Question(
        lambda drawn, box: box_stability(box, _controller(drawn, box)),
        lambda drawn, system: is_inside(
            enumeration.characteristic_polynomial(loop_of(system, drawn.gains)), drawn.time
        ),
        lambda drawn, line: _loop_stays(looped(line, drawn.gains)),
    ),
}


def _loop_stays(loop: ParametricPlant) -> bool:
    return stays_inside(characteristic(loop, []), loop, None)


def examined(number: int, larger: Fraction = Fraction(1)) -> tuple[list[str], Counter[str]]:
    """What is wrong about a drawn system, and what was found.

    Parameters
    ----------
    larger : Fraction
        By how much larger the boxes are whose members are decided: above 1 contradictions are to
        be found.
    """
    drawn, wrong, seen = drawn_box(number), list[str](), Counter({"systems": 1})
    for name in QUESTIONS:
        largest = largest_proved(partial(is_proved, name, drawn, wrong, seen))
        if largest is not None:
            seen[f"boxes: {name}"] += 1
            wrong += contradictions(name, drawn, largest * larger, seen)
    return wrong, seen


def is_proved(
    name: str, drawn: Drawn, wrong: list[str], seen: Counter[str], growth: Fraction
) -> bool:
    """Whether a proof is found; what the checker says against it is added to what is wrong."""
    box = boxed(drawn, growth)
    try:
        answer = QUESTIONS[name].proved(drawn, box)
    except LimitReached:
        return False
    except Exception as error:  # a plant without a proof is refused in no other way
        wrong.append(f"{name}, {growth}: {error!r}")
        return False
    verdict = check(answer, box)
    if verdict.verdict != "VALID":
        wrong.append(f"{name}, {growth}: {verdict.line()}")
    seen[f"proofs: {name}"] += 1
    return True


def largest_proved(proved: Callable[[Fraction], bool]) -> Fraction | None:
    """The largest factor up to the first one without a proof."""
    count = next((k for k, growth in enumerate(GROWTH) if not proved(growth)), len(GROWTH))
    if count in (0, len(GROWTH)):
        return GROWTH[-1] if count else None
    low, high = GROWTH[count - 1 : count + 1]
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if proved(middle) else (low, middle)
    return low


def contradictions(name: str, drawn: Drawn, growth: Fraction, seen: Counter[str]) -> list[str]:
    """Members and segments for which what is proved of the box does not hold."""
    points, segments = chosen(drawn, random.Random(3))
    question, wrong = QUESTIONS[name], []
    for shares in points:
        seen["members"] += 1
        if not question.holds(drawn, member(drawn, growth, shares)):
            wrong.append(f"{name}, {growth}: not at {[*map(str, shares)]}")
    for ends in segments:
        seen["segments"] += 1
        first, last = (member(drawn, growth, shares) for shares in ends)
        if not question.along(drawn, between(first, last, drawn.time)):
            wrong.append(f"{name}, {growth}: not between {[[*map(str, end)] for end in ends]}")
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 3000, FILE, examined, "contradictions"))
