"""Small documents that ask for much work: one for each way that a document can do so."""

from __future__ import annotations

import json
from math import prod
from typing import Any

from tests.checker import heavy_parameters
from tests.checker.handmade import certificate, layers, matrix, plant

Ports = tuple[Any, Any]

LOCATE = {"method": "polynomial"}
STABLE = {"bound": None, "stable": True}


def zeros(nrows: int, ncols: int) -> list[list[int]]:
    """A zero matrix, entry by entry."""
    return [[0] * ncols for _ in range(nrows)]


def port(n: int) -> Ports:
    """One input and one output of n states, without effect."""
    return zeros(n, 1), zeros(1, n)


def empty(n: int) -> Ports:
    """No inputs and no outputs."""
    return zeros(n, 0), {"shape": [0, n], "entries": []} if n else []


def heard(m: int, **more: Any) -> dict[str, Any]:
    """The neighbors of m agents that hear nobody."""
    return {"neighbors": {str(i): [] for i in range(1, m + 1)}, **more}


def chain(n: int, last: int) -> list[list[int]]:
    """Ones below the diagonal, the last of them another number."""
    return [[(last if i == n - 1 else 1) * (i == j + 1) for j in range(n)] for i in range(n)]


def decaying(n: int) -> list[list[int]]:
    """A chain with the eigenvalue -1."""
    return [
        [-1 if i == j else entry for j, entry in enumerate(row)]
        for i, row in enumerate(chain(n, 1))
    ]


def stable(system: dict[str, Any], *subject: dict[str, Any], **claim: Any) -> dict[str, Any]:
    """The claim that every eigenvalue is stable, by the characteristic polynomial."""
    return certificate("stability", system, {**STABLE, **claim}, LOCATE, *subject)


def step(construction: str, **parameters: Any) -> dict[str, Any]:
    """A construction of a subject."""
    return {"construction": construction, **parameters}


def controlled(domain: str, **agent: Any) -> dict[str, Any]:
    """A closed loop with one agent."""
    maps = {"shared_update": {}, "private_update": {}, "input": {}}
    program = {"name": "1", "shared": 0, "private": 0, **maps, **agent}
    return step("closed_loop", controller={"time": domain, "agents": [program]})


def connected(system: dict[str, Any], *subject: dict[str, Any]) -> dict[str, Any]:
    """A claim that is quickly checked, so that the subject alone takes work."""
    return certificate("neighbor_graph", system, {"strongly_connected": True}, {}, *subject)


def gains_lost(n: int, blocks: int, **parts: Any) -> dict[str, Any]:
    """Exceptional gains, none, with two compressions."""
    claim = {"M": matrix(*zeros(n, n)), "blocks": blocks, "polynomial": [1], "roots": []}
    R = matrix(*([1] * n for _ in range(blocks)))
    witness = {"modulus": 7, "factors": [], "compressions": [R, R]}
    return certificate("exceptional_gains", plant(zeros(n, n), port(n)), claim | parts, witness)


def cut(p: list[Any], domain: str = "continuous") -> dict[str, Any]:
    """Least dimensions, of which one cut names this polynomial."""
    claim = {
        "share": "states",
        "bound": None if domain == "none" else 1,
        "free_assignability": False,
        "costs": [1],
        "upper": [None],
        "feasible": False,
        "dimensions": None,
        "cost": None,
    }
    entry = {"subset": [], "polynomial": p, "deficiency": 1, "subspace": {}}
    witness = {"absence": None, "cuts": [entry], "tree": []}
    system = plant([[0]], port(1), time=domain, **heard(1))
    return certificate("shared_dimensions", system, claim, witness)


def tree(nodes: list[Any], m: int, cost: Any) -> dict[str, Any]:
    """Least dimensions of m agents, refused by a tree."""
    none = {"feasible": False, "dimensions": None, "cost": None}
    claim = {"share": "states", "bound": None, "free_assignability": False, **none}
    claim |= {"costs": [cost] * m, "upper": [None] * m}
    witness = {"absence": None, "cuts": [], "tree": nodes}
    system = plant([], *[([], [])] * m, **heard(m))
    return certificate("shared_dimensions", system, claim, witness)


def spectrum(A: list[list[int]], moduli: list[int]) -> dict[str, Any]:
    """The claim that a nilpotent matrix has the characteristic polynomial xⁿ."""
    claim = {"polynomial": [0] * len(A) + [1]}
    return certificate("closed_loop_spectrum", plant(A, port(len(A))), claim, {"moduli": moduli})


def primes(number: int) -> list[int]:
    """The first primes."""
    return [p for p in range(2, 10**4) if all(p % d for d in range(2, int(p**0.5) + 1))][:number]


def strange(degree: int) -> list[Any]:
    """A polynomial whose coefficients have denominators without common factors."""
    return [*(f"1/{10**22 + 2 * k + 1}" for k in range(degree)), 1]


def disc(k: int, digits: int) -> dict[str, str]:
    """A disc around k, with so many digits."""
    return {"re": f"{k}." + "1" * digits, "im": "0." + "3" * digits, "radius": "1"}


def rank_modulo(n: int, degree: int) -> dict[str, Any]:
    """The full rank of a pencil modulo a polynomial of this degree."""
    p = [3, *[0] * (degree - 1), 1]
    claim = {"subset": [], "polynomial": p, "rank": n}
    witness = {"modulus": 10007, "kernel": layers([[]] * n), "pivots": []}
    ones = [[i * j + 1 for j in range(n)] for i in range(n)]
    return certificate("pencil_rank", plant(ones, empty(n)), claim, witness)


def indices(n: int, ell: int) -> dict[str, Any]:
    """A controllable chain whose Krylov rank is computed modulo ℓ."""
    claim = {
        "channels": ["1"],
        "dimension": n,
        "controllable": True,
        "uncontrollable_polynomial": [1],
    }
    witness = {"modulus": ell, "annihilator": matrix(), "pivots": []}
    ports = ([[int(i == 0)] for i in range(n)], zeros(1, n))
    return certificate("controllability", plant(chain(n, 1), ports), claim, witness)


NINES = 10**4200 - 1
RADIUS = f"{NINES}/{10**4200}"
HARD = prod(2**61 - 1 + 2 * k for k in range(200))
"""No unit modulo any of the first 200 moduli that are tried."""
WIDE = {"shape": [0, 2**20], "entries": []}
NOTHING = {"shape": [2**20, 2**20], "entries": []}
NO_INPUTS, NO_OUTPUTS = ({"shape": shape, "entries": []} for shape in ([2**20, 1], [1, 2**20]))
DELAYED = {"neighbors": {"1": ["2"], "2": []}, "delays": {"1": {"2": 10**8}}}
SHARED = {"share": "states", "dimensions": [0, 0]}
MESH = {str(i): [str(j) for j in range(1, 41) if j != i] for i in range(1, 41)}
ONE = {"denominator": 1, "entries": []}
TINY = [0] * 1500 + [f"1/{2**13900}", 1]
POINTS = [[i, 0, "1e-1000"] for i in range(300)]

HEAVY: dict[str, dict[str, Any]] = {
    "a damping ratio of many digits": stable(
        plant(decaying(30), port(30)), damping=f"1/{10**3000}"
    ),
    "an extension by 400 states": stable(
        plant([[0]], port(1), **heard(1)), step("extended", share="states", dimensions=[400])
    ),
    "a zero of 1400 rows in a controller": stable(
        plant([[0]], port(1)),
        controlled(
            "continuous",
            private=1400,
            private_update={"private": {"shape": [1400, 1400], "entries": []}},
        ),
    ),
    "a plant that doubles in turn": stable(
        plant([[0]], port(1)), *[step("full_output", channel="1"), step("integrators")] * 10
    ),
    "exceptional gains with 30 blocks": gains_lost(30, 30),
    "a radius of 4200 digits": stable(plant(chain(20, 1), port(20), time="discrete"), bound=RADIUS),
    "a rate of 4200 digits": stable(plant(chain(30, 1), port(30)), bound=NINES),
    "pivots that are no units": stable(plant(chain(40, HARD), port(40))),
    "60 channels of a million inputs": connected(
        plant([], *[(WIDE, [])] * 60, **heard(60)),
        step("extended", share="states", dimensions=[0] * 60),
    ),
    "the dual of a million inputs": connected(plant([], (WIDE, [])), step("dual")),
    "a delay of a hundred million steps": connected(
        plant([[0]], port(1), port(1), time="discrete", **DELAYED), step("lifted", **SHARED)
    ),
    "sub-states held for a hundred million steps": connected(
        plant([[0]], port(1), port(1), time="discrete", **DELAYED), step("held", dimensions=[0, 0])
    ),
    "an extension by more states than a number can count": connected(
        plant([[0]], port(1), **heard(1)), step("extended", share="states", dimensions=[10**4000])
    ),
    "estimation errors of 60 agents": connected(
        plant(zeros(30, 30), *[empty(30)] * 30, **heard(30)), step("error", gains=[ONE] * 30)
    ),
    "outputs that all agents share, again and again": connected(
        plant([[0]], *[port(1)] * 40, neighbors=MESH), *[step("augmented_outputs")] * 6
    ),
    "the dual, 200 times": connected(plant(zeros(30, 30), port(30)), *[step("dual")] * 200),
    "edges added, 25 times": connected(
        plant([], *[([], [])] * 40, neighbors=MESH), *[step("arcs", added=[])] * 25
    ),
    "a cut of degree 4000": cut([0] * 4000 + [1]),
    "a cut of degree 4000 in discrete time": cut([0] * 4000 + [1], "discrete"),
    "a coefficient that is tiny": cut(TINY),
    "a coefficient that is large": cut([NINES] + [0] * 500 + [1], "discrete"),
    "a polynomial of 330 denominators": cut(strange(330)),
    "a polynomial of 330 denominators in discrete time": cut(strange(330), "discrete"),
    "a tree of nodes with long numbers": tree(
        [{"agent": "1", "at_most": 10**1000 + k} for k in range(7)], 40, 1
    ),
    "a tree of many nodes": tree([{"agent": "1", "at_most": k} for k in range(200)], 60, "1/3"),
    "100 discs of many digits": gains_lost(
        1, 1, polynomial=[0] * 100 + [1], roots=[disc(3 * k, 20) for k in range(100)]
    ),
    "10 discs of very many digits": gains_lost(
        1, 1, polynomial=[0] * 10 + [1], roots=[disc(3 * k, 400) for k in range(10)]
    ),
    "a pencil modulo a polynomial of degree 2000": rank_modulo(12, 2000),
    "1000 moduli": spectrum(zeros(40, 40), primes(1000)),
    "a modulus of 4000 digits": spectrum(chain(40, 1), [10**4000 + 1]),
    "controllability modulo a number of 4000 digits": indices(40, 10**4000 + 1),
    "small numbers with large exponents": stable(
        plant([[0]], port(1)),
        controlled(
            "continuous",
            private=300,
            private_update={"private": {"shape": [300, 300], "entries": POINTS}},
        ),
    ),
    "a million states without entries": stable(plant(NOTHING, (NO_INPUTS, NO_OUTPUTS))),
    "the closed loop of a million states": connected(
        plant(NOTHING, (NO_INPUTS, NO_OUTPUTS), **heard(1)),
        step("feedback", gains=[{"denominator": 1, "entries": [[1]]}]),
    ),
    "a sequence of a million states": certificate(
        "fixed_spectrum",
        plant(NOTHING, (NO_INPUTS, NO_OUTPUTS)),
        {"polynomial": [1], "factors": [], "stabilizable": True, "best_rate": None},
        {"blocks": [{"states": [0], "evidence": None}], "modulus": None, "subspaces": []},
    ),
    "channels without anything": certificate(
        "transfer_graph",
        plant([], *[([], [])] * 200),
        {"arcs": [], "components": [], "strongly_connected": False},
        {"modulus": 7, "powers": [], "zeros": []},
    ),
    **heavy_parameters.HEAVY,
}
"""Certificates of at most 10,000 bytes, by what is heavy in them."""

EXPECTED = {
    "the dual, 200 times": ("INVALID", "subject"),
    "edges added, 25 times": ("VALID", ""),
    "a tree of nodes with long numbers": ("INVALID", "tree"),
    "a tree of many nodes": ("INVALID", "tree"),
    "a polynomial of 330 denominators": ("MALFORMED", "form"),
    "100 discs of many digits": ("INVALID", "disc"),
    "10 discs of very many digits": ("INVALID", "disc"),
    "channels without anything": ("INVALID", "claim"),
    "a sequence of a million states": ("INVALID", "partition"),
    **heavy_parameters.EXPECTED,
}
"""The verdicts and codes of those that the default decides; the others are INCOMPLETE."""

FINISHED: dict[str, dict[str, Any]] = {
    "a damping ratio of 40 digits": stable(plant(decaying(8), port(8)), damping=f"1/{10**40}"),
    "an extension by 30 states": stable(
        plant([[0]], port(1), **heard(1)), step("extended", share="states", dimensions=[30])
    ),
    "exceptional gains with 5 blocks": gains_lost(5, 5),
    "a cut of degree 40": cut([0] * 40 + [1]),
    "a rate of 40 digits": stable(plant(chain(10, 1), port(10)), bound=10**40),
    "30 moduli": spectrum(zeros(10, 10), primes(30)),
    "a pencil modulo a polynomial of degree 20": rank_modulo(5, 20),
    "controllability modulo a number of 400 digits": indices(10, 10**400 + 1),
}
"""The same with less in them, so that they can be decided."""


def text(name: str) -> bytes:
    """The bytes of one of them."""
    return json.dumps(HEAVY[name], separators=(",", ":")).encode()
