"""Absence of fixed modes beyond a region; ``proofs/shared_dimensions.md``."""

from fractions import Fraction

from . import evidence
from .absence import Blocks, TwoPolynomials, by_blocks
from .arithmetic import Polynomial, exponent
from .characteristic_polynomial import characteristic_polynomial
from .location import in_region
from .parametric_system import FunctionSystem
from .reading import Json, boolean, fields, integer, items, polynomial, rational, require
from .statement import FIXED
from .system import System
from .transfer_graph import require_connected

Bound = Fraction | None
"""The rate or the radius that a claim is about, if any."""


def require_absence(value: Json, system: System, bound: Bound, connected: bool = False) -> None:
    """Stop unless every fixed mode lies in the region; and the graph is connected, if asked.

    Theorem ``transfer_graph.strongly_connected_arcs``.
    """
    place = "witness.absence"
    if by_blocks(value):
        parts, number, arcs = fields(value, place, "blocks", "modulus", "arcs")
        Blocks(parts, place, system).require_no_more([])
        alone = (number is None) == (arcs is None)
        require(alone, "claim", f"{place}.modulus", "expected for edges alone")
    else:
        keys = ("gains", "modulus", "allowed", "arcs")
        gains, number, listed, arcs = fields(value, place, *keys)
        proof = TwoPolynomials(gains, number, place, system)
        proof.require_moved(_without(listed, f"{place}.allowed", system, bound))
    require((arcs is not None) == connected, "claim", f"{place}.arcs", "expected iff claimed")
    if arcs is not None:
        ell = evidence.modulus(number, f"{place}.modulus")
        require_connected(arcs, f"{place}.arcs", system, ell)


def _without(value: Json, place: str, system: System, bound: Bound) -> Polynomial:
    """det(xI − A) without factors that lie in the region; [] if there is none."""
    allowed = items(value, place)
    rest = characteristic_polynomial(system.A) if allowed else []
    for k, entry in enumerate(allowed):
        where = f"{place}[{k}]"
        factor, power = items(entry, where, 2)
        p = polynomial(factor, where, 1)
        inside = in_region(p, system.time, bound)
        require(inside, "region", where, "has a root outside the region")
        times, rest = exponent(p, rest)
        require(times == integer(power, where, 1), "exponent", where, f"divides {times} times")
    return rest


def read_bound(value: Json, system: System) -> Bound:
    """A rate ≥ 0 in continuous time, a radius in (0, 1] in discrete time, or null."""
    if value is None:
        return None
    bound = rational(value, "claim.bound")
    fits = bound >= 0 if system.time == "continuous" else 0 < bound <= 1
    require(fits, "bound", "claim.bound", "expected a rate >= 0, or a radius in (0, 1]")
    return bound


def inside(bound: Json, system: System | FunctionSystem) -> str:
    """The region within a rate or a radius, in words."""
    limit = Fraction(bound)
    return f"modulus below {limit}" if system.time == "discrete" else f"real part below {-limit}"


def no_fixed_mode(bound: Json, system: System | FunctionSystem) -> str:
    """That no mode is fixed; with a rate or a radius, none that violates it."""
    if bound is None:
        return f"no mode that is {FIXED}"
    where = inside(bound, system).replace("below", "at least")
    return f"no mode of {where} that is {FIXED}"


def require_outside(p: Polynomial, system: System, bound: Bound, place: str) -> None:
    """Stop if every root of p lies inside the region, where fixed modes are allowed."""
    inside = in_region(p, system.time, bound)
    require(not inside, "region", place, "every root lies inside the region")


def claimed_cost(claim: dict[str, Json], answer: str, absence: Json) -> Fraction | None:
    """The cost of the claimed answer; None if it claims that nothing suffices."""
    if boolean(claim["feasible"], "claim.feasible"):
        return rational(claim["cost"], "claim.cost")
    nothing = claim[answer] is None and claim["cost"] is None and absence is None
    require(nothing, "claim", "claim", "expected null where nothing suffices")
    return None
