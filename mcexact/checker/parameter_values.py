"""Values of a parameter in claims: where nothing is claimed, and their words."""

from functools import reduce

from . import reading, root_discs
from .arithmetic import Polynomial, poly_divide, poly_product
from .expressions import common_divisor
from .parametric_system import ParametricSystem, Range
from .reading import Json, fields, items, require
from .statement import polynomial_text

REAL = "real ones where the disc is centered on the real axis, and only there"


def listed_value(value: Json, discs: Json, place: str, system: ParametricSystem) -> Polynomial:
    """A polynomial q of degree at least 1, with discs that tell its real roots from the others.

    At its roots all entries of the plant are defined.
    """
    q = reading.polynomial(value, f"{place}.value", 1)
    defined = all(len(common_divisor(q, delta)) == 1 for delta in system.poles)
    require(defined, "pole", f"{place}.value", "an entry of the plant is undefined there")
    root_discs.require_real_or_not(root_discs.root_discs(discs, f"{place}.roots", q), place)
    return q


def values_left_out(outside: Json, poles: Json, system: ParametricSystem) -> list[Polynomial]:
    """The values of which nothing is claimed.

    Those of the claim have no root in the range that is assumed; where those of the witness vanish,
    an entry is undefined.

    Open: see ``proofs/OPEN.md``.
    """
    found = []
    low, high = system.range
    for k, entry in enumerate(items(outside, "claim.outside")):
        place = f"claim.outside[{k}]"
        value, listed = fields(entry, place, "value", "roots")
        found.append(reading.polynomial(value, f"{place}.value", 1))
        for re, im, radius in root_discs.root_discs(listed, f"{place}.roots", found[-1]):
            left = low is not None and re + radius < low
            right = high is not None and re - radius > high
            apart = left or right or abs(im) > radius
            require(apart, "range", place, "a root may be in the range")
    denominator = reduce(poly_product, system.poles)
    for k, entry in enumerate(items(poles, "witness.undefined")):
        place = f"witness.undefined[{k}]"
        found.append(reading.polynomial(entry, place, 1))
        gone = not poly_divide(denominator, found[-1])[1]
        require(gone, "pole", place, "it divides no denominator of the plant")
    return found


def where_text(claim: Json, system: ParametricSystem) -> str:
    """The values that a claim is about."""
    t = system.parameter
    where = f"for every complex value of the parameter {t} at which all entries of the plant are "
    where += "defined"
    if claim["outside"]:
        roots = ", ".join(roots_text(entry, t) for entry in claim["outside"])
        where += f", except at {roots}, none of which is real and between {ends_text(system)}"
    return where


def ends_text(system: ParametricSystem) -> str:
    """The least and the largest value of the parameter."""
    return ends_of(system.range)


def ends_of(bounds: Range) -> str:
    """The ends of a range."""
    low, high = bounds
    return f"{'-infinity' if low is None else low} and {'infinity' if high is None else high}"


def roots_text(entry: Json, t: str) -> str:
    """The roots of a value, and where they are."""
    value, discs = polynomial_text(entry["value"], t), root_discs.disc_set(entry["roots"])
    return f"the roots of {value}, one in each of the discs {discs}"
