"""Loops whose inputs are cut off, by other methods.

Without a region the norm of the loop around the middle of the sectors [0, 1] is compared with 1 by
the eigenvalues of a Hamiltonian matrix.  With one, forms are decided by their leading minors.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from flint import fmpq, fmpq_mat

from .algebra import below, beside, selection
from .controllers import read_agents
from .performance import diagonal, disturbed, is_below, is_definite
from .reading import demand, integer, listed, matrix, rational, record
from .roots import inside
from .systems import System

Pair = tuple[fmpq, fmpq] | None
FINE = 60
"""The decimals of samples that count as exact."""


def read_limits(value: Any, plant: System) -> list[Pair]:
    """The limits of all inputs."""
    pairs: list[Pair] = []
    for own, B_i in zip(listed(value, plant.m), plant.B, strict=True):
        for pair in listed(own, B_i.ncols()):
            if pair is None:
                pairs.append(None)
                continue
            low, high = (rational(end) for end in listed(pair, 2))
            demand(low <= 0 <= high and low < high, "expected limits around 0")
            pairs.append((low, high))
    return pairs


def windup(value: Any, plant: System, controller: Any, total: int) -> fmpq_mat:
    """The anti-windup gains, with a row for each state of the loop."""
    agents, blocks, row, column = read_agents(plant, controller), [], plant.n, 0
    p = [B_i.ncols() for B_i in plant.B]
    for agent, L, width in zip(agents, listed(value, plant.m), p, strict=True):
        size = agent.shared + agent.private
        parts = [fmpq_mat(size, column), matrix(L, size, width)]
        blocks.append(beside([*parts, fmpq_mat(size, sum(p) - column - width)], size))
        row, column = row + size, column + width
    rows = [fmpq_mat(plant.n, sum(p)), *blocks, fmpq_mat(total - row, sum(p))]
    return below(rows, sum(p))


def symmetric(value: Any, n: int) -> fmpq_mat:
    """A symmetric matrix s_ij 2^(e_i + e_j)."""
    found = record(value, "exponents", "entries")
    e = [integer(each) for each in listed(found["exponents"], n)]
    entries = iter(listed(found["entries"], n * (n + 1) // 2))
    demand(all(abs(each) <= 4000 for each in e), "expected smaller exponents")
    M = fmpq_mat(n, n)
    for i in range(n):
        for j in range(i + 1):
            M[i, j] = M[j, i] = integer(next(entries)) * fmpq(2) ** (e[i] + e[j])
    return M


def saturation(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The circle criterion of the witness, for the loop with its anti-windup gains."""
    loop = disturbed(document)
    found = record(claim, "limits", "back_calculation", optional=("region", "exact"))
    if "exact" in found:
        # more digits than any condition needs, in place of none that are missing
        demand(found["exact"] is True, "expected true")
        sampling, *rest = document["subject"]
        demand(sampling["construction"] == "sampled" and len(rest) == 1, "expected samples")
        fine = {**document, "subject": [{**sampling, "decimals": FINE}, *rest]}
        rounded = {key: part for key, part in found.items() if key != "exact"}
        both = (document, fine)
        return all(saturation(rounded, each, system) for each in both)
    proof = record(document["witness"], "scaling", "sectors", optional=("P",))
    pairs = read_limits(found["limits"], loop.plant)
    cut = [k for k, pair in enumerate(pairs) if pair is not None]
    chosen, N = selection(len(pairs), cut), loop.M.nrows()
    controller = document["subject"][-1]["controller"]
    L = windup(found["back_calculation"], loop.plant, controller, N)
    E, U = (loop.E + L) * chosen.transpose(), chosen * loop.U
    theta = [rational(x) for x in listed(proof["scaling"], len(cut))]
    ends = [rational(x) for x in listed(proof["sectors"], len(cut))]
    demand(all(x >= 0 for x in (*theta, *ends)), "expected none below 0")
    if "region" not in found:
        symmetric(proof["P"], N)
        demand(not any(ends), "expected sectors from 0 on")
        M, half = loop.M - E * U * fmpq(1, 2), fmpq(1, 2)
        if not inside(M.charpoly(), system.time, None):
            return False
        weights = [x * half * half for x in theta]
        none = fmpq_mat(len(cut), len(cut))
        return is_below((M, E * half, U), none, weights, fmpq(1), system.time)
    demand("P" not in proof, "expected no other form")
    region = record(found["region"], "P", "radius", optional=("sizes",))
    P, radius = symmetric(region["P"], N), rational(region["radius"])
    demand(radius > 0, "expected a radius above 0")
    known = [pair for pair in pairs if pair is not None]
    held = _holds(P, U, known, ends)
    own = selection(N, range(loop.plant.n))
    sizes = [rational(x) for x in listed(region.get("sizes", [1] * loop.plant.n), loop.plant.n)]
    demand(all(x > 0 for x in sizes), "expected sizes above 0")
    inner = diagonal([1 / (radius * x) ** 2 for x in sizes]) - own * P * own.transpose()
    if not held or not is_definite(inner) or not is_definite(P):
        return False
    return is_definite(fall((loop.M - E * U, E, U), P, theta, ends, system.time))


def _holds(P: fmpq_mat, U: fmpq_mat, known: list[tuple[fmpq, fmpq]], ends: list[fmpq]) -> bool:
    """Whether every input stays in its sector where z'Pz ≤ 1: a²UP⁻¹U' is at most the limit's."""
    if not is_definite(P):
        return False
    inverse = P.inv()
    for k, ((low, high), a) in enumerate(zip(known, ends, strict=True)):
        u, nearer = selection(len(known), [k]) * U, min(-low, high)
        if a and not a * a * (u * inverse * u.transpose())[0, 0] < nearer * nearer:
            return False
    return True


def fall(
    signals: tuple[fmpq_mat, fmpq_mat, fmpq_mat],
    P: fmpq_mat,
    theta: list[fmpq],
    ends: list[fmpq],
    time: str,
) -> fmpq_mat:
    """The form of (z, φ) that is −d(z'Pz) − Σ θ (φ − av)(v − φ), in blocks."""
    M, E, U = signals
    Theta, N = diagonal(theta), M.nrows()
    lower = diagonal(ends)
    product = U.transpose() * Theta * lower * U
    mean = fmpq(1, 2) * (Theta + Theta * lower)
    if time == "continuous":
        top, right, corner = -1 * (P * M + M.transpose() * P), P * E, Theta
    else:
        top, right = P - M.transpose() * P * M, M.transpose() * P * E
        corner = Theta - E.transpose() * P * E
    across = -1 * (right + U.transpose() * mean)
    k = len(theta)
    upper = beside([top + product, across], N)
    return below([upper, beside([across.transpose(), corner], k)], N + k)


JUDGES: Mapping[str, Callable[[Any, Any, System], bool]] = {"saturation": saturation}
