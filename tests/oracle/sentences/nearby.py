"""Judges of sentences about plants nearby: by enumeration there, and entry by entry of both plants.

The plants are those that the analysis has, by what they lack; that they exist is what is judged.
"""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal, localcontext
from fractions import Fraction

from flint import fmpq_mat

from tests.oracle.certificates.systems import System
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import Case, Facts, Region, Said, irreducible

LOST = ("unstable", "fixed", "uncontrollable", "unobservable")
EXACT = Fraction(1, 10**12)


def _pairs(own: System, near: System) -> Iterator[tuple[Fraction, Fraction]]:
    """The entries of a plant, each with that of the other one."""
    for M, N in zip((own.A, *own.B, *own.C), (near.A, *near.B, *near.C), strict=True):
        for x, y in zip(M.entries(), N.entries(), strict=True):
            yield Fraction(int(x.p), int(x.q)), Fraction(int(y.p), int(y.q))


def _same_digits(x: Fraction, y: Fraction) -> bool:
    """Whether numbers have the same 3 to 12 digits, or differ by 10^-12 of the first at most."""
    with localcontext(prec=30):
        written = (Decimal(x.numerator) / Decimal(x.denominator)).normalize()
    digits, exponent = written.as_tuple().digits, int(written.as_tuple().exponent)
    if Fraction(written) == x and exponent < 0 and 3 <= len(digits) <= 12:
        return abs(x - y) <= Fraction(10) ** exponent / 2
    return abs(x - y) <= abs(x) * EXACT


def _lacks(lost: str, own: Facts, near: Facts, said: Said) -> bool:
    """Whether the modes are fixed there, and the own plant does not lack what that one lacks."""
    every = range(own.m)
    modes = [p for p, _ in irreducible(said.values["p"])]
    if lost == "uncontrollable":
        ours = all(own.controls(every, p) for p, _ in own.modes)
        return ours and not any(near.controls(every, p) for p in modes)
    if lost == "unobservable":
        ours = all(own.observes(every, p) for p, _ in own.modes)
        return ours and not any(near.observes(every, p) for p in modes)
    region, fixed = Region(own.system.time), [str(p) for p in near.fixed]
    stable = all(region.contains(p) for p in own.fixed)
    unstable = not any(region.contains(p) for p in modes)
    return all(str(p) in fixed for p in modes) and (
        (stable and unstable) if lost == "unstable" else own.fixed == []
    )


@judge(*[f"nearby-{lost}{tier}" for lost in LOST for tier in ("", "-digits", "-part")])
def _nearby(said: Said, case: Case) -> bool:
    _, lost, *tier = said.rule.split("-")
    near: System = case.asked["nearby"][lost]
    pairs = [*_pairs(case.plant, near)]
    if tier == ["digits"]:
        close = all(_same_digits(x, y) for x, y in pairs)
    else:
        part = Fraction(said.values["part"])
        part = part if tier else min(part, EXACT)
        close = all(abs(x - y) <= part * abs(x) for x, y in pairs)
    return close and _lacks(lost, case.own, Facts(near), said)


def _satisfied(said: Said, plant: System, *, left: bool) -> bool:
    """Whether A maps each vector to its multiple, and the ports map it to 0."""
    A, ports = plant.A, [*plant.B] if left else [*plant.C]
    if left:
        A, ports = A.transpose(), [M.transpose() for M in ports]
    minus, one = (said.values["p"][k] for k in (0, 1))
    vectors = [fmpq_mat(len(v), 1, list(v)) for v in said.values["vectors"]]
    return all(
        any(v.entries())
        and A * v == v * (-minus / one)
        and not any(x for M in ports for x in (M * v).entries())
        for v in vectors
    )


@judge("law-unobserved", "law-uncontrolled")
def _law(said: Said, case: Case) -> bool:
    return _satisfied(said, case.plant, left=said.rule.endswith("uncontrolled"))


@judge("nearby-law-unobserved", "nearby-law-uncontrolled")
def _law_nearby(said: Said, case: Case) -> bool:
    left = said.rule.endswith("uncontrolled")
    lost = "uncontrollable" if left else "unobservable"
    return _satisfied(said, case.asked["nearby"][lost], left=left)
