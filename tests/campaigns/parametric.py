"""Fixed modes for all values of a parameter, against enumeration at points and modulo primes.

Run as ``python -m tests.campaigns.parametric COUNT FIRST``; every certificate is checked as well.
"""

from __future__ import annotations

import collections
import random
import sys
from fractions import Fraction

from mcexact import check, fixed_spectrum
from tests.oracle.parametric import disagreements
from tests.oracle.parametric_draws import drawn_parametric

POINTS = 40


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
    wrong += disagreements(system, found, [*points(rng, count), *exact])
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


def main(count: int, first: int) -> int:
    """Examine so many drawn systems, and print what was found."""
    total: collections.Counter[str] = collections.Counter()
    for number in range(first, first + count):
        wrong, seen = examined(number)
        total.update(seen)
        for what in wrong:
            print(f"system {number}: {what}", flush=True)
        total["disagreements"] += len(wrong)
    print(", ".join(f"{value} {key}" for key, value in total.items()))
    return int(total["disagreements"] > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:3])))
