"""Exceptional hypersurfaces of several parameters, against enumeration on other lines.

Run as ``python -m tests.assurance.campaigns.hypersurfaces [COUNT [FIRST [FILE]]]``; systems in the
file (by default ``build/hypersurfaces.jsonl``) are not examined again.  On lines that the answer
has not seen, every point modulo a prime is decided by enumeration: there is more where a
hypersurface is met, and nowhere else.  Every certificate is checked as well.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mcexact import ParametricSystem, check
from mcexact.answer.protocol import document
from mcexact.exact.rational_functions import RationalFunction
from mcexact.parameters import exceptional_hypersurfaces
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle.parametric import _polynomial, fixed_radical, values
from tests.oracle.parametric_ranks import rank_of

FILE = Path("build") / "hypersurfaces.jsonl"
LINES, FIELDS = 2, (101, 103)
MODES = ("fixed_spectrum", "joint_controllability", "joint_observability")
QUESTIONS = (*MODES, "setpoint", "controllability_indices", "transfer_graph", "completeness")
POLYNOMIALS = ("a", "b", "a + b", "a - b", "a*b", "2*a - 1", "b^2 - a", "a - 3*b + 1", "a^2 + b^2")
QUOTIENTS = ("1/(a + b)", "a/b", "1/(a*b)", "(a - b)/(a + b)", "1/(a - 2)")


def drawn(rng: random.Random) -> ParametricSystem:
    """A plant of two or three parameters, most of whose entries are numbers."""
    quotients, third = rng.random() < 0.4, rng.random() < 0.2
    pool = [*POLYNOMIALS, *(QUOTIENTS if quotients else ()), *(["c", "a + c"] if third else ())]

    def entry() -> Any:
        kind = rng.random()
        return 0 if kind < 0.35 else rng.randint(-2, 2) if kind < 0.6 else rng.choice(pool)

    n, m = rng.randint(1, 3), rng.randint(1, 2)
    return ParametricSystem(
        [[entry() for _ in range(n)] for _ in range(n)],
        [[[entry()] for _ in range(n)] for _ in range(m)],
        [[[entry() for _ in range(n)]] for _ in range(m)],
        parameters=["a", "b", "c"] if third else ["a", "b"],
        time=rng.choice(["continuous", "discrete"]),
    )


def examined(number: int) -> Examined:
    """What is wrong about a drawn system, and what was found."""
    rng, wrong, seen = random.Random(number), list[str](), Counter[str](systems=1)
    plant = drawn(rng)
    for question in QUESTIONS:
        found: Any = exceptional_hypersurfaces(plant, question)  # type: ignore[call-overload]
        if question in ("transfer_graph", "completeness"):
            continue
        for each in found if isinstance(found, tuple) else (found,):
            seen["hypersurfaces"] += len(each.hypersurfaces)
            for line in each.lines:
                verdict = check(line.answer, plant)
                wrong += [] if verdict.verdict == "VALID" else [verdict.line()]
                seen["certificates"] += 1
            if question == "fixed_spectrum":
                wrong += differing(plant, each, rng, more_fixed(each))
            elif question in ("setpoint", "controllability_indices"):
                wrong += differing(plant, each, rng, less_rank(plant, each))
    return wrong, seen


Differs = Callable[[Any, dict[str, RationalFunction], int, int], bool]
"""Whether something else holds at a point of a line modulo a prime than for almost all values."""


def differing(
    plant: ParametricSystem, found: Any, rng: random.Random, differs: Differs
) -> list[str]:
    """The lines on which more is exceptional than a hypersurface that is met, or less."""
    bad = []
    for _ in range(LINES):
        s = RationalFunction.parameter("s", ("s",))
        at = {name: rng.randint(1, 50) * s + rng.randint(-50, 50) for name in plant.parameters}
        line = plant.along(at)
        for ell in FIELDS:
            met = {t for t in range(ell) if any(zero(h, at, t, ell) for h in found.exceptional_at)}
            points = {t: values(line, t, ell) for t in range(ell)}
            kept = [
                t for t, plain in points.items() if plain is not None and defined(found, at, t, ell)
            ]
            lost = {t for t in kept if differs(points[t], at, t, ell)}
            if lost != met & {*kept}:
                bad.append(f"{type(found).__name__} modulo {ell}: {sorted(lost ^ (met & {*kept}))}")
    # One point of one field may be unlucky, a hypersurface is met on most lines in most fields.
    return bad if len(bad) > 1 else []


def zero(h: RationalFunction, at: dict[str, RationalFunction], t: int, ell: int) -> bool:
    """Whether a polynomial in the parameters is 0 at a point of a line."""
    return residue(h, at, t, ell) == 0


def defined(found: Any, at: dict[str, RationalFunction], t: int, ell: int) -> bool:
    """Whether no denominator is 0 there, not even one that is left out along this line."""
    return not any(zero(q, at, t, ell) for q in found.undefined_at)


def residue(h: RationalFunction, at: dict[str, RationalFunction], t: int, ell: int) -> int:
    """The value of a polynomial at a point of a line."""
    over = h.substituted([at[name] for name in h.parameters], RationalFunction.constant(0, ("s",)))
    p, _ = over.polynomials()
    return (
        sum(c.numerator * pow(c.denominator, -1, ell) * t**k for k, c in enumerate(p.coefficients))
        % ell
    )


def more_fixed(found: Any) -> Differs:
    """Whether more modes are fixed than the roots of the generic polynomials."""

    def differs(plain: Any, at: dict[str, RationalFunction], t: int, ell: int) -> bool:
        generic = _polynomial([1], ell)
        for p in found.generic:
            generic = generic * _polynomial([residue(c, at, t, ell) for c in p], ell)
        distinct = generic // generic.gcd(generic.derivative()) if generic.degree() else generic
        return int(fixed_radical(plain, ell).degree()) != int(distinct.degree())

    return differs


def less_rank(plant: ParametricSystem, found: Any) -> Differs:
    """Whether a rank is not the generic one."""

    def differs(plain: Any, at: dict[str, RationalFunction], t: int, ell: int) -> bool:
        named = document(found.lines[0].answer)["claim"]["matrix"]
        return rank_of(named, plain, plant.names, ell, plant.time) != found.rank

    return differs


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 300, FILE, examined, "disagreements"))
