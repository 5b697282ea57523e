"""Ways to prove a false claim about all values of a parameter, each by a plant of its own.

Every document would be accepted by a checker that left out one condition, or that took one of the
short-cuts that look as good as what ``FORMAT.md`` demands.
"""

from __future__ import annotations

import random
from typing import Any

from tests.oracle.drawn.plants import Document

from ..mutators import copied

LARGE = 2**61 - 1
AT_ONE = [{"re": "1", "im": "0", "radius": "0"}]
AT_ZERO = [{"re": "0", "im": "0", "radius": "0"}]
X: list[list[Any]] = [[], [1]]
"""The polynomial x."""


def constant(*rows: list[int]) -> Document:
    """A matrix of integers."""
    return {"denominator": 1, "entries": list(rows)}


def layers(*coefficients: list[list[int]]) -> Document:
    """A polynomial matrix with integer coefficients."""
    return {"denominator": 1, "coefficients": list(coefficients)}


def block(
    T: list[str], U: list[Document], W: Document, rows: list[int], columns: list[int]
) -> Document:
    """A zero block."""
    return {"channels_T": T, "U": U, "W": W, "row_pivots": rows, "column_pivots": columns}


def plant(A: Any, *ports: Any, parameter: str = "t", told: Any = None) -> Document:
    """A plant whose channels, pairs of B and C, are named 1, 2, …, and what is told of its t."""
    channels = [{"name": str(k), "B": B, "C": C} for k, (B, C) in enumerate(ports, start=1)]
    return {
        "time": "continuous",
        "parameters": {parameter: told or {}},
        "A": A,
        "channels": channels,
    }


def spectrum(
    system: Document,
    gains: tuple[int, int] = (1, 2),
    modulus: int = 101,
    moduli: tuple[int, ...] = (LARGE,),
    generic: tuple[Any, ...] = (),
    exceptional: tuple[Any, ...] = (),
    settled: tuple[Any, ...] = (),
    common: tuple[Any, ...] = (),
) -> Document:
    """A claim about fixed modes; each mode with its proof, each value with those of its modes.

    The first gains are 0, and the resultant is exact unless there are no moduli.
    """
    m = len(system["channels"])
    claim = {
        "generic": [p for p, _ in generic],
        "exceptional": [entry for entry, _ in exceptional],
        "outside": [],
    }
    witness = {
        "gains": [[constant([gain])] * m for gain in (0, *gains)],
        "modulus": modulus,
        "moduli": list(moduli),
        "common": [{"value": value, "divisor": divisor} for value, divisor in common],
        "generic": [proof for _, proof in generic],
        "exceptional": [proof for _, proof in exceptional],
        "settled": list(settled),
        "undefined": [],
    }
    return _certificate("parametric_fixed_spectrum", system, claim, witness)


def saying(document: Document, part: str, **values: Any) -> Document:
    """The same with other values of some keys of the claim or of the witness."""
    document[part] |= values
    return document


def with_gains(document: Document, *gains: list[int]) -> Document:
    """The same with gains of one channel, from one output to several inputs."""
    document["witness"]["gains"] = [[constant(*[[f] for f in F])] for F in gains]
    return document


def rank(
    system: Document,
    size: int,
    minor: tuple[list[int], list[int]],
    compressions: tuple[Document, Document],
    modulus: int = 101,
    exceptional: tuple[Any, ...] = (),
) -> Document:
    """A claim about the rank of the inputs of channel 1."""
    claim = {
        "matrix": {"name": "controllability", "channels": ["1"], "blocks": 1},
        "rank": size,
        "exceptional": [entry for entry, _ in exceptional],
        "outside": [],
    }
    witness = {
        "kernel": None,
        "rows": minor[0],
        "columns": minor[1],
        "modulus": modulus,
        "compressions": list(compressions),
        "exceptional": [proof for _, proof in exceptional],
        "undefined": [],
    }
    return _certificate("parametric_rank", system, claim, witness)


def _certificate(kind: str, system: Document, claim: Document, witness: Document) -> Document:
    made = {
        "format": "mcexact-certificate/1",
        "kind": kind,
        "system": system,
        "subject": [],
        "claim": claim,
        "witness": witness,
    }
    return copied(made)


def scalar(gain: str, A: Any = 0, parameter: str = "t") -> Document:
    """x' = A x + b(t) u, y = x: where b vanishes, A is fixed, and nowhere else anything."""
    return plant([[A]], ([[gain]], [[1]]), parameter=parameter)


ONE_ROW = block(["1"], [layers([[1]])], layers([[1]]), [0], [0])
"""W = 1 and U = 1: channel 1 does not control the one state."""
FIXED_AT_ONE = (
    {"value": [-1, 1], "roots": AT_ONE, "modes": [{"polynomial": X, "channels": []}]},
    {"modes": [ONE_ROW], "divisors": []},
)
FIXED_AT_ZERO = (
    {"value": [0, 1], "roots": AT_ZERO, "modes": [{"polynomial": X, "channels": []}]},
    {"modes": [ONE_ROW], "divisors": []},
)
UNMOVED = (X, ONE_ROW)
"""0 is fixed for every t, where nothing is controlled."""
FREE = plant([["t"]], ([[1]], [[1]]))
"""Nothing is fixed for any t."""
FIVE: list[list[Any]] = [[-5], [1]]
"""The polynomial x − 5."""
ZERO = "t^2 + t - 2"
THROUGH_A_ZERO = plant(
    [["t", 0, 0], [0, ZERO, 1], [0, 1, ZERO]],
    ([[0], [1], [0]], [[1, 0, 0]]),
    ([[1], [0], [0]], [[0, 1, 0]]),
)
"""Channel 1 sees the mode t, and 2 controls it; from 1 to 2 leads z/(z² − 1), z = x − t² − t + 2.

So t is fixed where t² = 2.  With each root as a copy of the plant, which gains may connect, the
other copy brings a signal from channel 1 to channel 2.
"""

SPECTRA: dict[str, Document] = {
    # short-cuts
    "a value is divided out modulo ℓ, with one that is congruent to it": spectrum(
        scalar("t^2 - 9*t + 8"), modulus=7, exceptional=(FIXED_AT_ONE,)
    ),
    "ℓ divides the denominator of a value": spectrum(scalar("7*t - 1"), modulus=7),
    "powers of a generic polynomial are divided out modulo ℓ": spectrum(
        plant([[0, 0], [0, 7]], ([[0], ["t"]], [[1, 1]])),
        gains=(1, 7),
        modulus=7,
        generic=((X, block(["1"], [layers([[1, 0], [0, 1]])], layers([[1, 0]]), [0, 1], [0])),),
    ),
    "scalars are restricted to a companion matrix": spectrum(
        THROUGH_A_ZERO, settled=({"value": [-2, 0, 1], "divisors": []},)
    ),
    "a value is divided out modulo ℓ alone, with one that is congruent to it": spectrum(
        scalar("t^2 - 9*t + 8"),
        modulus=7,
        moduli=(),
        exceptional=(FIXED_AT_ONE,),
        common=(([-1, 1], X),),
    ),
    "ℓ alone divides the denominator of a value": spectrum(scalar("7*t - 1"), modulus=7, moduli=()),
    "the leading coefficient of a resultant is no unit": with_gains(
        spectrum(plant([[0]], ([["7*t + 1", "49*t^2 - 1"]], [[1]])), modulus=49, moduli=()),
        [0, 0],
        [1, 0],
        [0, -1],
    ),
    # conditions
    "a value is divided out once for each time that it is named": spectrum(
        scalar("t^2 - 9*t + 8"),
        modulus=7,
        moduli=(),
        exceptional=(FIXED_AT_ONE,),
        common=(([-1, 1], X), ([-1, 1], X)),
    ),
    "a value is divided out as often as the degree of what divides nothing": spectrum(
        scalar("t^2 - 9*t + 8"),
        modulus=7,
        moduli=(),
        exceptional=(FIXED_AT_ONE,),
        common=(([-1, 1], [[], [], [1]]),),
    ),
    "a value is divided out that is not named": spectrum(
        scalar("t^2 - t"),
        moduli=(),
        exceptional=(FIXED_AT_ONE,),
        common=(([-1, 1], X), ([0, 1], X)),
    ),
    "a value where nothing is fixed": spectrum(
        scalar("t"),
        exceptional=(
            FIXED_AT_ZERO,
            (
                {"value": [-1, 1], "roots": AT_ONE, "modes": []},
                {"modes": [], "divisors": []},
            ),
        ),
    ),
    "a real value in a disc beside the axis": spectrum(
        scalar("t"),
        exceptional=(
            (
                {**FIXED_AT_ZERO[0], "roots": [{"re": "0", "im": "0.1", "radius": "1"}]},
                FIXED_AT_ZERO[1],
            ),
        ),
    ),
    "the resultant is known modulo too small a number": spectrum(
        scalar("5*t + 1"), modulus=7, moduli=(5,)
    ),
    "the first resultant vanishes, and the second one modulo ℓ nowhere": spectrum(
        scalar("7*t + 1"), gains=(0, 1), modulus=7
    ),
    "channels at whose pencil no rank is lost": spectrum(
        scalar("t"),
        exceptional=(
            (
                {**FIXED_AT_ZERO[0], "modes": [{"polynomial": X, "channels": ["1"]}]},
                FIXED_AT_ZERO[1],
            ),
        ),
    ),
    "an entry that is not written canonically": spectrum(
        scalar("1*t"), exceptional=(FIXED_AT_ZERO,)
    ),
    "a divisor of no polynomial of fixed modes": spectrum(
        scalar("t"), settled=({"value": [0, 1], "divisors": [X]},)
    ),
    "a polynomial that is not monic": spectrum(
        plant([[0]], ([[0]], [["t"]])), generic=(([[], [2]], ONE_ROW),)
    ),
    "a real value beyond no range": saying(
        spectrum(scalar("t")), "claim", outside=[{"value": [0, 1], "roots": AT_ZERO}]
    ),
    "a pole of no entry": saying(spectrum(scalar("t")), "witness", undefined=[[0, 1]]),
    "a value at which an entry is undefined": spectrum(
        plant([[0]], ([["t"]], [["(1)/(t)"]])), exceptional=(FIXED_AT_ZERO,)
    ),
    "a zero block of another mode": spectrum(
        plant([[0]], ([[0]], [["t"]])), generic=(UNMOVED, (FIVE, ONE_ROW))
    ),
    "a zero block beside inputs that act": spectrum(
        plant([[0]], ([[1]], [["t"]])), generic=(UNMOVED,)
    ),
    "a zero block beside outputs that see": spectrum(
        plant([[0]], ([["t"]], [[1]])), generic=((X, {**ONE_ROW, "channels_T": []}),)
    ),
    "a zero block without rows": spectrum(
        FREE, generic=((FIVE, block([], [layers([[]])], layers([]), [], [])),)
    ),
    "a zero block that vanishes at a root of p": spectrum(
        plant([[0]], ([[0]], [["t"]])),
        generic=(
            UNMOVED,
            ([[], [1], [1]], {**ONE_ROW, "U": [layers([[1]]), layers([[1]])]}),
        ),
    ),
    "one row of W twice": spectrum(
        plant([[0, "t"], [1, 0]], ([[1], [0]], [[0, 1]])),
        generic=((FIVE, block([], [layers([[1], [0]])], layers([[1, 5], [1, 5]]), [0], [0, 1])),),
    ),
    "a zero block that is zero": spectrum(
        FREE, generic=((FIVE, block([], [layers([[0]])], layers([[1]]), [0], [0])),)
    ),
    "a zero at the end of a coefficient": spectrum(
        plant([[0]], ([[0]], [["t"]])), generic=(([[0], [1]], ONE_ROW),)
    ),
    "a parameter that is called x": spectrum(
        scalar("x", parameter="x"), exceptional=(FIXED_AT_ZERO,)
    ),
}


def kernel(size: int) -> Document:
    """A kernel that is everything."""
    identity = [[int(i == j) for j in range(size)] for i in range(size)]
    return {"columns": layers(identity), "pivots": [*range(size)]}


def at_one(least: int, pivots: list[int]) -> tuple[Document, Document]:
    """A rank at t = 1, and a kernel of a matrix of one column."""
    proof = {"columns": layers([[1] * len(pivots)]), "pivots": pivots}
    return {"value": [-1, 1], "roots": AT_ONE, "rank": least}, proof


NOTHING_AT_ZERO = {"value": [0, 1], "roots": AT_ZERO, "rank": 0}, kernel(1)
ONE_BY_ONE = constant([1]), constant([1])
TWO_BY_TWO = constant([1, 0], [0, 1]), constant([1, 0], [0, 1])
RANKS: dict[str, Document] = {
    "a value is divided out of a minor modulo ℓ": rank(
        scalar("t^2 - 9*t + 8"),
        1,
        ([0], [0]),
        ONE_BY_ONE,
        modulus=7,
        exceptional=(
            (
                {"value": [-1, 1], "roots": AT_ONE, "rank": 0},
                {"columns": layers([[1]]), "pivots": [0]},
            ),
        ),
    ),
    "ℓ divides the denominator of a root of a minor": rank(
        scalar("7*t - 1"), 1, ([0], [0]), ONE_BY_ONE, modulus=7
    ),
    "a minor of no rows and no columns": rank(scalar("t"), 1, ([], []), ONE_BY_ONE),
    "a minor that is zero beside one that is 1 modulo ℓ": rank(
        plant([[0, 0], [0, 0]], ([[0], ["7*t + 1"]], [[1, 0]])),
        1,
        ([0], [0]),
        (constant([0, 1]), constant([1])),
        modulus=7,
    ),
    "a part of the kernel at a value": rank(
        plant([[0, 0], [0, 0]], ([["t", 0], [0, "t"]], [[1, 0]])),
        2,
        ([0, 1], [0, 1]),
        TWO_BY_TWO,
        exceptional=(
            (
                {"value": [0, 1], "roots": AT_ZERO, "rank": 1},
                {"columns": layers([[1], [0]]), "pivots": [0]},
            ),
        ),
    ),
    "a value at which the rank is not less": rank(
        scalar("t"), 1, ([0], [0]), ONE_BY_ONE, exceptional=(NOTHING_AT_ZERO, at_one(1, []))
    ),
    "a kernel without columns": rank(
        scalar("t"), 1, ([0], [0]), ONE_BY_ONE, exceptional=(NOTHING_AT_ZERO, at_one(0, []))
    ),
    "a kernel that is not annihilated": rank(
        scalar("t"), 1, ([0], [0]), ONE_BY_ONE, exceptional=(NOTHING_AT_ZERO, at_one(0, [0]))
    ),
    "more blocks than states": saying(
        rank(
            scalar("t"),
            1,
            ([0], [0]),
            (constant([1]), constant([1], [0])),
            exceptional=((NOTHING_AT_ZERO[0], kernel(2)),),
        ),
        "claim",
        matrix={"name": "controllability", "channels": ["1"], "blocks": 2},
    ),
    "outputs of another number of states": rank(
        plant([[0]], ([[1]], [["t"]]), ([[1]], [[1, 1]])), 1, ([0], [0]), ONE_BY_ONE
    ),
    "a range upside down": rank(
        plant([[0]], ([[1]], [["t"]]), told={"range": [1, 0]}), 1, ([0], [0]), ONE_BY_ONE
    ),
    "inputs of another number of states": rank(
        plant([[0]], ([[1]], [["t"]]), ([[1], [1]], [[1]])), 1, ([0], [0]), ONE_BY_ONE
    ),
    "an entry of too high a degree": rank(
        plant([[0]], ([[1]], [["t^1001"]])), 1, ([0], [0]), ONE_BY_ONE
    ),
    "an entry that is too long": rank(
        plant([[0]], ([[1]], [[" + ".join(f"{10**3990}*t^{k}" for k in range(27, 1, -1))]])),
        1,
        ([0], [0]),
        ONE_BY_ONE,
    ),
}


def trap_about_modes(rng: random.Random, document: Document) -> Document:
    """One of the documents about fixed modes."""
    return copied(rng.choice(list(SPECTRA.values())))


def trap_about_ranks(rng: random.Random, document: Document) -> Document:
    """One of the documents about ranks."""
    return copied(rng.choice(list(RANKS.values())))
