"""Judges of the sentences about a part of the state that was left out, joint modes, and inputs.

The parts are computed from kernels: of [C; CA; …], and of the transpose of [B, AB, …].
"""

from __future__ import annotations

import random

from flint import fmpq, fmpq_mat, fmpq_poly, fmpz_mat

from tests.oracle.certificates.algebra import krylov
from tests.oracle.certificates.systems import System
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import Case, Facts, Said, divides, irreducible, monic


def on_kernel(A: fmpq_mat, reached: fmpq_mat) -> fmpq_poly:
    """The characteristic polynomial of A' on the rows w with w M = 0."""
    n = A.nrows()
    X, nullity = fmpz_mat(reached.transpose().numer_denom()[0]).nullspace()
    if not nullity:
        return fmpq_poly([1])
    V = fmpq_mat(n, nullity, [X[i, j] for i in range(n) for j in range(nullity)])
    # A'V = VZ, by the normal equations of independent columns
    Z = (V.transpose() * V).inv() * (V.transpose() * (A.transpose() * V))
    return monic(Z.charpoly())


def unobserved_part(system: System) -> fmpq_poly:
    """det(xI − A) on what no output shows."""
    A = system.A.transpose()
    return on_kernel(A, krylov(A, system.outputs().transpose(), max(system.n, 1)))


def uncontrolled_part(system: System) -> fmpq_poly:
    """det(xI − A) modulo what inputs move."""
    return on_kernel(system.A, krylov(system.A, system.inputs(), max(system.n, 1)))


def minimal_order(facts: Facts) -> int:
    """The rank of the Hankel matrix of all Markov parameters."""
    system, n = facts.system, max(facts.n, 1)
    O = krylov(system.A.transpose(), system.outputs().transpose(), n).transpose()
    return int((O * krylov(system.A, system.inputs(), n)).rank())


@judge("modulo-unobservable")
def _unobservable(said: Said, case: Case) -> bool:
    return _stays(said, case, unobserved_part(case.own.system))


@judge("modulo-uncontrollable")
def _uncontrollable(said: Said, case: Case) -> bool:
    return _stays(said, case, uncontrolled_part(case.own.system))


def _stays(said: Said, case: Case, part: fmpq_poly) -> bool:
    """It belongs to the part, and divides every loop that is drawn."""
    p = said.values["p"]
    whole = p.degree() == said.values["k"] and divides(p, part)
    return whole and divides(p, case.own.fixed_polynomial)


@judge("feedthrough")
def _feedthrough(said: Said, case: Case) -> bool:
    """It has the form (x, u), and what is fixed of it divides the loops of A, B, C and D."""
    system = case.own.system
    p = sum(B.ncols() for B in system.B)
    n = system.n - p
    inputs = system.inputs().tolist()
    form = [[fmpq(int(i == n + j)) for j in range(p)] for i in range(system.n)]
    if inputs != form or any(x != 0 for row in system.A.tolist()[n:] for x in row):
        return False
    rng, common = random.Random(1), case.own.chi * 0
    for _ in range(8):
        common = common.gcd(_static_loop(system, n, p, rng))
    return monic(common) == case.own.fixed_polynomial


def _static_loop(system: System, n: int, p: int, rng: random.Random) -> fmpq_poly:
    """det(xI − A − B (I − FD)⁻¹ FC) for drawn gains, read from the blocks of (x, u)."""
    rows, gains, k = [], [], 0
    for B, C in zip(system.B, system.C, strict=True):
        own = C.tolist()[: C.nrows() - B.ncols()]
        rows += own
        for _ in range(B.ncols()):
            gains.append((k, [fmpq(rng.randint(-9, 9)) for _ in own]))
        k += len(own)
    q = len(rows)
    F = fmpq_mat(
        p, q, [row[j - s] if s <= j < s + len(row) else 0 for s, row in gains for j in range(q)]
    )
    C, D = (
        fmpq_mat(q, b - a, [x for row in rows for x in row[a:b]]) for a, b in ((0, n), (n, n + p))
    )
    A, B = (
        fmpq_mat(n, b - a, [x for row in system.A.tolist()[:n] for x in row[a:b]])
        for a, b in ((0, n), (n, n + p))
    )
    inner = -(F * D)
    for i in range(p):
        inner[i, i] = inner[i, i] + 1
    return (A + B * inner.inv() * F * C).charpoly() if inner.det() != 0 else fmpq_poly([0])


@judge("joint-fixed")
def _joint(said: Said, case: Case) -> bool:
    """As many as a minimal realization lacks; in every loop; and among those of the two parts."""
    p, facts = said.values["p"], case.subject
    both = unobserved_part(facts.system) * uncontrolled_part(facts.system)
    lacking = p.degree() == facts.n - minimal_order(facts)
    return lacking and divides(p, facts.fixed_polynomial) and divides(p, both)


def _others(case: Case) -> fmpq_poly:
    """The fixed polynomial without the joint modes that are said beside it."""
    (joint,) = [each.values["p"] for each in case.others("joint-fixed")]
    quotient, rest = divmod(case.subject.fixed_polynomial, joint)
    return quotient if rest == 0 else fmpq_poly([0])


@judge("decentralized-none")
def _none(said: Said, case: Case) -> bool:
    return bool(_others(case).degree() == 0)


@judge("fixed-besides")
def _besides(said: Said, case: Case) -> bool:
    """So many times at most, and at least once."""
    p, others = said.values["p"], _others(case)
    times = {str(q): e for q, e in irreducible(others)}.get(str(p), 0)
    return 1 <= times <= said.values["k"]


@judge("decentralized-fixed")
def _decentralized(said: Said, case: Case) -> bool:
    p, facts = said.values["p"], case.subject
    moved = p not in facts.unobserved() and p not in facts.uncontrolled()
    return moved and _besides(said, case)
