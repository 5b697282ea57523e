"""The kind about the pattern of a plant: the modes that are fixed whatever its numbers are.

The entries of x I − A, of B, C and of the gains K stand in one square matrix, whose determinant is
the characteristic polynomial of the loop:

    M = [xI − A, −B, 0; 0, I, −K; −C, 0, I],    det M = det(xI − A − BKC).

K has an entry where an agent feeds back an output.  A place of M at which an entry may differ from
0 is an edge of a digraph from its column to its row.  U are the states whose strong components have
no input and no output: their block of M is x I − A_UU for all gains, and a factor of det M.  Every
product of the expansion of the rest has a factor x for each state whose own place is taken and is
not an entry of A; potentials bound their number from below, and one permutation attains the bound.
"""

from itertools import accumulate

from .constructions import neighbors_of
from .core.arithmetic import (
    Polynomial,
    characteristic_polynomial,
    entries_of,
    poly_product,
    within,
)
from .core.budget import counted, spend
from .core.reach import components
from .core.reading import Json, fields, integer, items, malformed, polynomial, positions, require
from .core.system import System, polynomial_text

Places = dict[tuple[int, int], int]
"""The places of M that can differ from 0, and how many factors x stand there at least."""

INFORMATION = ("own", "outputs")
"""What each agent feeds back: its own outputs, or those of its neighbors."""

# Kind ``structural_fixed_modes``; ``proofs/structural_fixed_modes.md``.

CLAIM = ("information", "without_feedback", "at_zero", "polynomial")
WITNESS = ("rows", "columns", "matching")


def check_structural_fixed_modes(claim: Json, witness: Json, system: System) -> None:
    """Check the states without feedback, and bounds of the factors x from both sides.

    Theorems ``patterns.structural_modes``, ``patterns.structural_fixed``,
    ``patterns.structural_fixed_received``.
    """
    information, states, number, factor = fields(claim, "claim", *CLAIM)
    rows, columns, matching = fields(witness, "witness", *WITNESS)
    places, size = read_places(information, system)
    parts = components_without_feedback(places, system.n, size)
    apart = sorted(a for part in parts for a in part)
    same = positions(states, "claim.without_feedback", system.n) == apart
    require(same, "claim", "claim.without_feedback", f"these are {apart}")
    left = [k for k in range(size) if k not in set(apart)]
    z = integer(number, "claim.at_zero")
    require_factors(places, left, rows, columns, z)
    require_no_more_factors(places, left, matching, z)
    p = polynomial(factor, "claim.polynomial")
    same = p == structural_polynomial(system, parts, z)
    require(same, "claim", "claim.polynomial", "not det(xI - A) of these states, times a power")


def structural_fixed_modes_statement(claim: Json, system: System) -> str:
    """What is fixed whatever the numbers are, and that almost all numbers fix no more."""
    whose = {"own": "its own outputs", "outputs": "the outputs of its neighbors"}
    U, z = claim["without_feedback"], claim["at_zero"]
    listed = ", ".join(str(a + 1) for a in U) or "none"
    return (
        f"where each agent feeds back {whose[claim['information']]}, for all systems with zeros "
        "wherever it has zeros, and all constant gains F, det(xI - A_F) is a multiple of "
        f"x^{z} det(xI - A_UU), U the states {listed}; almost all such systems have no more that "
        "divides det(xI - A_F) for all F; with its own entries this is "
        f"{polynomial_text(claim['polynomial'])}"
    )


def read_places(information: Json, system: System) -> tuple[Places, int]:
    """The places of M that can differ from 0, with 1 for an x alone, and the size of M."""
    if type(information) is not str or information not in INFORMATION:
        malformed("claim.information", f"expected one of {', '.join(INFORMATION)}")
    N = [[i] for i in range(system.m)]
    if information == "outputs":
        N = neighbors_of(system, "subject")
    n, m = system.n, system.m
    sizes = [n, *(B.ncols for B in system.B), *(C.nrows for C in system.C)]
    *starts, size = accumulate(sizes)
    inputs, outputs = starts[:m], starts[m:]
    spend(100 * size)
    places = {(k, k): int(k < n) for k in range(size)}
    places |= {(a, b): 0 for a, b, _ in entries_of(system.A)}
    for B, C, u, y in zip(system.B, system.C, inputs, outputs, strict=True):
        places |= {(a, u + k): 0 for a, k, _ in entries_of(B)}
        places |= {(y + k, b): 0 for k, b, _ in entries_of(C)}
    for i, (B, u) in enumerate(zip(system.B, inputs, strict=True)):
        for j in N[i]:
            q = system.C[j].nrows
            spend(100 * B.ncols * q + 100)
            places |= {(u + k, outputs[j] + r): 0 for k in range(B.ncols) for r in range(q)}
    spend(100 * len(places))
    return places, size


def components_without_feedback(places: Places, n: int, size: int) -> list[list[int]]:
    """The strong components that have no input and no output; U has the states in these.

    Theorem ``strong_components.component_rule``.
    """
    parts = components(size, ((b, a) for a, b in places))
    return [part for part in parts if part[-1] < n]


def require_factors(places: Places, left: list[int], rows: Json, columns: Json, z: int) -> None:
    """Stop unless z factors x stand in every product of the expansion of the rest of M.

    π_i + κ_j is at most the number of factors x at the place (i, j), and these add up to z.

    Theorem ``patterns.potentials_bound``.
    """
    pi, kappa = (
        dict(zip(left, (_whole(x, name) for x in items(listed, name, len(left))), strict=True))
        for listed, name in ((rows, "witness.rows"), (columns, "witness.columns"))
    )
    spend(100 * len(places))
    below = all(pi[i] + kappa[j] <= x for (i, j), x in places.items() if i in pi and j in kappa)
    require(below, "potential", "witness.rows", "two potentials exceed the factors x at a place")
    total = sum(pi.values()) + sum(kappa.values())
    require(total == z, "claim", "claim.at_zero", f"the potentials add up to {total}")


def require_no_more_factors(places: Places, left: list[int], matching: Json, z: int) -> None:
    """Stop unless some product of the expansion has z factors x alone.

    Open: see ``proofs/OPEN.md``.
    """
    place = "witness.matching"
    chosen = [integer(k, place) for k in items(matching, place, len(left))]
    spend(100 * len(left))
    require(sorted(chosen) == left, "matching", place, "not a permutation of the rest")
    taken = [places.get(at) for at in zip(left, chosen, strict=True)]
    require(None not in taken, "matching", place, "an entry that is 0 is taken")
    number = sum(x or 0 for x in taken)
    require(number == z, "claim", "claim.at_zero", f"the permutation takes {number} of the x")


def structural_polynomial(system: System, parts: list[list[int]], z: int) -> Polynomial:
    """x^z det(xI − A_UU), by the strong components of which U consists.

    Theorem ``patterns.det_split``.
    """
    product: Polynomial = [0] * z + [1]
    for part in counted(parts):
        place = {a: k for k, a in enumerate(part)}
        chi = characteristic_polynomial(within(system.A, place, place))
        product = poly_product(product, chi)
    return product


def _whole(value: Json, place: str) -> int:
    """An integer that is short, of either sign."""
    number = integer(value, place, -(2**31))
    require(number < 2**31, "potential", place, "expected short integers")
    return number
