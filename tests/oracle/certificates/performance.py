"""Costs of loops, the cost of the best controller, margins and sectors, by other methods.

The loop with its disturbances is not formed as the checker forms it: the disturbances are states of
a larger plant.  Costs are exact solutions of Lyapunov equations.  Norms are compared with a number
by the eigenvalues of a Hamiltonian matrix, in discrete time after a bilinear transformation.  The
cost of the best controller is computed in floating point: bounds that exceed it by less than one
part in 10⁷ are taken for true.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from flint import fmpq, fmpq_mat, fmpq_poly
from scipy.linalg import solve_continuous_are, solve_discrete_are

from .algebra import below, beside, identity, selection
from .constructions import subject_of
from .controllers import Agent, Loop, read_agents
from .reading import Undecided, demand, listed, place, rational, record, text, truth
from .roots import inside
from .systems import System

DIAGONALS = ("states", "inputs", "disturbances", "noise")


@dataclass(frozen=True)
class Disturbed:
    """z' = M z + E d + G e, u = U z + K e, y = Y z."""

    plant: System
    M: fmpq_mat
    E: fmpq_mat
    G: fmpq_mat
    U: fmpq_mat
    K: fmpq_mat
    Y: fmpq_mat


def disturbed(document: Mapping[str, Any]) -> Disturbed:
    """The loop around the plant whose states are (x, d, e), d added to u and e to y."""
    steps = document["subject"]
    demand(bool(steps) and steps[-1].get("construction") == "closed_loop", "expected a loop")
    plant = subject_of(document, len(steps) - 1)
    return disturbed_loop(plant, read_agents(plant, steps[-1]["controller"]))


def disturbed_loop(plant: System, agents: Sequence[Agent]) -> Disturbed:
    """The loop with d and e, which are states of a larger plant."""
    B, C, n = plant.inputs(), plant.outputs(), plant.n
    p, q = B.ncols(), C.nrows()
    more = p + q
    top = beside([plant.A, B, fmpq_mat(n, q)], n)
    A = below([top, fmpq_mat(more, n + more)], n + more)
    starts = [sum(C_j.nrows() for C_j in plant.C[:j]) for j in range(plant.m)]
    larger = replace(
        plant,
        A=A,
        B=tuple(below([B_i, fmpq_mat(more, B_i.ncols())], B_i.ncols()) for B_i in plant.B),
        C=tuple(
            beside(
                [
                    C_j,
                    fmpq_mat(C_j.nrows(), p),
                    selection(q, range(start, start + C_j.nrows())),
                ],
                C_j.nrows(),
            )
            for C_j, start in zip(plant.C, starts, strict=True)
        ),
    )
    loop = Loop(larger, agents)
    whole, total = loop.matrix(), loop.total
    z = [k for k in range(total) if not n <= k < n + more]
    d, e = range(n, n + p), range(n + p, n + more)
    u = below([loop.computed(i, "input", plant.B[i].ncols()) for i in range(plant.m)], total)
    y = below([loop.signal(("outputs", j, 0)) for j in range(plant.m)], total)
    rows = selection(total, z) * whole
    M, E, G, U, K, Y = (
        part * selection(total, chosen).transpose()
        for part, chosen in ((rows, z), (rows, d), (rows, e), (u, z), (u, e), (y, z))
    )
    return Disturbed(plant, M, E, G, U, K, Y)


def diagonal(entries: Sequence[fmpq]) -> fmpq_mat:
    """The diagonal matrix."""
    n = len(entries)
    return fmpq_mat(n, n, [entries[i] if i == j else 0 for i in range(n) for j in range(n)])


def trace(S: fmpq_mat) -> fmpq:
    """The sum of the diagonal."""
    return sum((S[i, i] for i in range(S.nrows())), fmpq(0))


def weights_of(value: Any, plant: System) -> tuple[list[list[fmpq]], fmpq | None]:
    """The diagonals of Q, R, W and V, and ω."""
    found = record(value, *DIAGONALS, optional=("bandwidth",))
    sizes = plant.n, plant.inputs().ncols(), plant.n, plant.outputs().nrows()
    lists = [
        [rational(entry) for entry in listed(found[key], size)]
        for key, size in zip(DIAGONALS, sizes, strict=True)
    ]
    demand(all(entry >= 0 for entries in lists for entry in entries), "expected none below 0")
    demand(all(entry > 0 for entry in lists[1]), "expected weights of inputs above 0")
    if "bandwidth" not in found:
        return lists, None
    omega = rational(found["bandwidth"])
    demand(omega > 0 and plant.time == "continuous", "expected a bandwidth in continuous time")
    return lists, omega


def loop_cost(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The covariance of the loop with its noise, from its Lyapunov equation."""
    found = record(claim, "weights", "cost")
    loop = disturbed(document)
    cost = cost_of(loop, *weights_of(found["weights"], loop.plant), system.time)
    return cost is not None and bool(cost <= rational(found["cost"]))


def cost_of(
    loop: Disturbed, diagonals: Sequence[Sequence[fmpq]], omega: fmpq | None, time: str
) -> fmpq | None:
    """The cost of a loop from the covariance of its state; None if it is not stable."""
    q, r, w, v = diagonals
    M, U, G, K = loop.M, loop.U, loop.G, loop.K
    at_once = fmpq(0)
    if time == "continuous" and omega is not None:
        ports, N = G.ncols(), M.nrows()
        filters = diagonal([omega] * ports)
        M = below([beside([M, G], N), beside([fmpq_mat(ports, N), -1 * filters], ports)], N + ports)
        U = beside([U, K], U.nrows())
        G = below([fmpq_mat(N, ports), filters], ports)
    elif time == "continuous":
        demand(not any(K.entries()), "expected no noise that passes to the inputs at once")
    else:
        at_once = trace(K.transpose() * diagonal(r) * K * diagonal(v))
    if not inside(M.charpoly(), time, None):
        return None
    N = M.nrows()
    x = selection(N, range(loop.plant.n))
    noise = x.transpose() * diagonal(w) * x + G * diagonal(v) * G.transpose()
    X = stationary(M, noise, time)
    spent = x.transpose() * diagonal(q) * x + U.transpose() * diagonal(r) * U
    return trace(spent * X) + at_once


def stationary(M: fmpq_mat, noise: fmpq_mat, time: str) -> fmpq_mat:
    """X with MX + XM' + noise = 0, in discrete time X = MXM' + noise."""
    n = M.nrows()
    pairs = [(i, j) for i in range(n) for j in range(i + 1)]
    of = {pair: k for k, pair in enumerate(pairs)} | {(j, i): k for k, (i, j) in enumerate(pairs)}
    rows = fmpq_mat(len(pairs), len(pairs))
    for k, (i, j) in enumerate(pairs):
        if time == "continuous":
            for h in range(n):
                rows[k, of[h, j]] += M[i, h]
                rows[k, of[i, h]] += M[j, h]
        else:
            rows[k, k] += 1
            for g in range(n):
                for h in range(n):
                    if M[i, g] != 0 and M[j, h] != 0:
                        rows[k, of[g, h]] -= M[i, g] * M[j, h]
    sign = -1 if time == "continuous" else 1
    right = fmpq_mat(len(pairs), 1, [sign * noise[i, j] for i, j in pairs])
    flat = rows.solve(right)
    return fmpq_mat(n, n, [flat[of[i, j], 0] for i in range(n) for j in range(n)])


def cost_bound(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The cost of the best controller of each group, with the group's part of the disturbances."""
    found = record(claim, "weights", "cost", optional=("graph",))
    (q, r, w, v), omega = weights_of(found["weights"], system)
    groups = listed(record(document["witness"], "groups")["groups"])
    owners, after = _graph(found.get("graph"), system)
    total, remaining = 0.0, [list(w), list(v)]
    for entry in groups:
        keys = ("agents", "disturbances", "noise", "P", "S", "F", "share")
        group = record(entry, *keys)
        agents = [place(text(name), system.names) for name in listed(group["agents"])]
        demand(agents == sorted(set(agents)), "expected agents in order")
        demand(all(after[j] <= set(agents) for j in agents), "expected a closed group")
        inputs = [i for i, B in enumerate(system.B) for _ in range(B.ncols())]
        outputs = [i for i, C in enumerate(system.C) for _ in range(C.nrows())]
        whole = len(agents) == system.m
        states = [k for k, owner in enumerate(owners) if whole or owner in agents]
        ports = [[k for k, i in enumerate(p) if i in agents] for p in (inputs, outputs)]
        parts = []
        for key, where, rest in zip(
            ("disturbances", "noise"), (states, ports[1]), remaining, strict=True
        ):
            values = [rational(x) for x in listed(group[key], len(where))]
            demand(all(x >= 0 for x in values), "expected none below 0")
            for k, x in zip(where, values, strict=True):
                rest[k] -= x
            parts.append(values)
        matrices = (
            selection(system.n, states) * system.A * selection(system.n, states).transpose(),
            selection(system.n, states)
            * system.inputs()
            * selection(len(inputs), ports[0]).transpose(),
            selection(len(outputs), ports[1])
            * system.outputs()
            * selection(system.n, states).transpose(),
        )
        lists = [[q[k] for k in states], [r[k] for k in ports[0]], *parts]
        total += least_cost(matrices, lists, omega, system.time)
    demand(all(x >= 0 for rest in remaining for x in rest), "expected no more than there is")
    cost = rational(found["cost"])
    return float(int(cost.p) / int(cost.q)) <= total * (1 + 1e-7) + 1e-12


def _graph(value: Any, system: System) -> tuple[list[int], list[set[int]]]:
    """The owner of each state, and on whom each agent may act; the plant must keep to it."""
    m = system.m
    if value is None:
        return [0] * system.n, [set(range(m))] * m
    found = record(value, "states", "edges")
    owners = [place(text(name), system.names) for name in listed(found["states"], system.n)]
    edges = [
        (place(text(j), system.names), place(text(i), system.names))
        for j, i in (listed(edge, 2) for edge in listed(found["edges"]))
    ]
    demand(edges == sorted(set(edges)) and all(j != i for j, i in edges), "expected edges")
    acts = {
        (owners[c], owners[r]) for r in range(system.n) for c in range(system.n) if system.A[r, c]
    }
    for i in range(m):
        B, C = system.B[i], system.C[i]
        acts |= {(i, owners[r]) for r in range(system.n) for c in range(B.ncols()) if B[r, c]}
        acts |= {(owners[c], i) for r in range(C.nrows()) for c in range(system.n) if C[r, c]}
    demand(all(j == i or (j, i) in edges for j, i in acts), "expected the edges of the plant")
    return owners, [{i for j, i in edges if j == k} | {k} for k in range(m)]


def _floats(M: fmpq_mat) -> Any:
    values = [int(x.p) / int(x.q) for x in M.entries()]
    return np.array(values, dtype=float).reshape(M.nrows(), M.ncols())


def least_cost(
    matrices: Sequence[fmpq_mat],
    lists: Sequence[Sequence[fmpq]],
    omega: fmpq | None,
    time: str,
) -> float:
    """The least cost, with slightly larger weights where the equations have no solution.

    It is infinite where no controller makes the loop stable: every bound holds then.
    """
    A, B, C = map(_floats, matrices)
    if _stays(A, B, time) or _stays(A.T, C.T, time):
        return math.inf
    for more in (fmpq(0), fmpq(1, 10**9), fmpq(1, 10**7)):
        try:
            larger = [[x + more for x in each] for each in lists]
            return best_cost(matrices, larger, omega, time)
        except (np.linalg.LinAlgError, ValueError):
            continue
    raise Undecided("the Riccati equations have no solution that is found")


def _stays(A: Any, B: Any, time: str) -> bool:
    """Whether an eigenvalue of A that does not decay is out of the reach of B."""
    values = np.linalg.eigvals(A)
    sizes = np.abs(values) - 1 if time == "discrete" else values.real
    reach = [
        np.linalg.svd(np.hstack([value * np.eye(len(A)) - A, B]), compute_uv=False)[-1]
        for value in values[sizes > -1e-12]
    ]
    scale = max(1.0, np.abs(A).max(initial=0.0))
    if any(1e-12 * scale < each < 1e-8 * scale for each in reach):
        raise Undecided("an eigenvalue is nearly out of reach")
    return any(each <= 1e-12 * scale for each in reach)


def best_cost(
    matrices: Sequence[fmpq_mat],
    diagonals: Sequence[Sequence[fmpq]],
    omega: fmpq | None,
    time: str,
) -> float:
    """The least cost, with white noise of the measurements y + y'/ω where there is an ω.

    Intensities of 0 are replaced by small ones, which does not make the cost less.
    """
    A, B, C = map(_floats, matrices)
    Q, R = (np.diag([int(x.p) / int(x.q) for x in d]) for d in diagonals[:2])
    W, V = (np.diag([max(int(x.p) / int(x.q), 1e-9) for x in d]) for d in diagonals[2:])
    if not len(A):
        return 0.0
    if not B.shape[1]:  # an input that does nothing
        B, R = np.zeros((len(A), 1)), np.eye(1)
    if not len(C):
        C, V = np.zeros((1, len(A))), np.eye(1)
    if time == "discrete":
        P = solve_discrete_are(A, B, Q, R)
        spent = R + B.T @ P @ B
        F = np.linalg.solve(spent, B.T @ P @ A)
        S = solve_discrete_are(A.T, C.T, W, V)
        S = S - S @ C.T @ np.linalg.solve(C @ S @ C.T + V, C @ S)
        return float(np.trace(P @ W) + np.trace(F.T @ spent @ F @ S))
    P = solve_continuous_are(A, B, Q, R)
    F = np.linalg.solve(R, B.T @ P)
    if omega is None:
        S = solve_continuous_are(A.T, C.T, W, V)
    else:
        slow = int(omega.q) / int(omega.p)
        H = C + slow * C @ A
        S = solve_continuous_are(A.T, H.T, W, slow**2 * C @ W @ C.T + V, s=slow * W @ C.T)
    return float(np.trace(P @ W) + np.trace(F.T @ R @ F @ S))


def disk_margin(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The norm of T + I/2 below 1/α: of each port, or of all with the scaling of the witness."""
    found = record(claim, "at", "together", "margin")
    demand(found["at"] in ("inputs", "outputs"), "expected inputs or outputs")
    alpha, together = rational(found["margin"]), truth(found["together"])
    demand(alpha > 0, "expected a margin above 0")
    loop = disturbed(document)
    ports = (loop.U if found["at"] == "inputs" else loop.Y).nrows()
    groups = [([k], [fmpq(1)]) for k in range(ports)]
    if together:
        parts = [
            record(part, "ports", "scaling", "P")
            for part in listed(record(document["witness"], "parts")["parts"])
        ]
        whole = [part for part in parts if part["ports"] == list(range(ports))]
        demand(bool(whole), "expected a part with all ports")
        groups = [(list(range(ports)), [rational(x) for x in listed(p["scaling"])]) for p in whole]
    if not inside(loop.M.charpoly(), system.time, None):
        return False
    held = [has_margin(loop, found["at"], k, theta, alpha) for k, theta in groups]
    return any(held) if together else all(held)


def has_margin(
    loop: Disturbed, at: str, ports: Sequence[int], theta: Sequence[fmpq], alpha: fmpq
) -> bool:
    """Whether the loop is stable and ‖Θ^½(T + I/2)Θ^−½‖ < 1/α for T at some ports together."""
    X, Y = (loop.E, loop.U) if at == "inputs" else (loop.G, loop.Y)
    if not inside(loop.M.charpoly(), loop.plant.time, None):
        return False
    return is_below(
        (loop.M, X * selection(Y.nrows(), ports).transpose(), selection(Y.nrows(), ports) * Y),
        fmpq(1, 2) * identity(len(ports)),
        theta,
        1 / alpha,
        loop.plant.time,
    )


def sector(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The norm of the loop around the middle of the sectors, with the scaling of the witness."""
    loop = disturbed(document)
    p = loop.U.nrows()
    pairs = [
        tuple(rational(end) for end in listed(pair, 2))
        for pair in listed(record(claim, "sectors")["sectors"], p)
    ]
    demand(all(a <= b for a, b in pairs), "expected ends in order")
    theta = [rational(x) for x in listed(record(document["witness"], "scaling", "P")["scaling"], p)]
    demand(all(x > 0 for x in theta), "expected a scaling above 0")
    middle = diagonal([(a + b) / 2 - 1 for a, b in pairs])
    M = loop.M + loop.E * middle * loop.U
    if not inside(M.charpoly(), system.time, None):
        return False
    wide = [k for k, (a, b) in enumerate(pairs) if a < b]
    half = [(pairs[k][1] - pairs[k][0]) / 2 for k in wide]
    chosen = selection(p, wide)
    return is_below(
        (M, loop.E * chosen.transpose() * diagonal(half), chosen * loop.U),
        fmpq_mat(len(wide), len(wide)),
        [theta[k] * h * h for k, h in zip(wide, half, strict=True)],
        fmpq(1),
        system.time,
    )


def is_below(
    signals: Sequence[fmpq_mat], D: fmpq_mat, theta: Sequence[fmpq], gamma: fmpq, time: str
) -> bool:
    """Whether the norm of Θ^½(Y(xI − M)⁻¹X + D)Θ^−½ is below γ, for M with stable eigenvalues.

    The Hamiltonian matrix of the bounded real lemma has no eigenvalue on the imaginary axis, where
    the norm at infinity is below γ.
    """
    M, X, Y = signals
    n = M.nrows()
    if time == "discrete" and n:
        # x = (1 + s)/(1 − s); the eigenvalues of M are not −1
        inner = (M + identity(n)).inv()
        D = D - Y * inner * X
        M, X, Y = inner * (M - identity(n)), 2 * inner * X, Y * inner
    Theta = diagonal(theta)
    R = gamma * gamma * Theta - D.transpose() * Theta * D
    if not is_definite(R):
        return False
    if not n or not theta:
        return True
    inverse = R.inv()
    cross = D.transpose() * Theta * Y
    A = M + X * inverse * cross
    right = X * inverse * X.transpose()
    low = -1 * (Y.transpose() * Theta * Y + cross.transpose() * inverse * cross)
    H = below([beside([A, right], n), beside([low, -1 * A.transpose()], n)], 2 * n)
    even = H.charpoly().coeffs()
    # χ_H(x) = h(x²), and x is imaginary where x² ≤ 0
    h = fmpq_poly([c for k, c in enumerate(even) if k % 2 == 0])
    return not _has_root_from_0_down(h)


def is_definite(R: fmpq_mat) -> bool:
    """Whether all leading minors are positive."""
    sizes = range(1, R.nrows() + 1)
    return all(
        (selection(R.nrows(), range(k)) * R * selection(R.nrows(), range(k)).transpose()).det() > 0
        for k in sizes
    )


def _has_root_from_0_down(h: fmpq_poly) -> bool:
    """Whether a polynomial has a root that is real and at most 0, by Sturm's sequence."""
    if h[0] == 0:
        return True
    chain = [h, h.derivative()]
    while chain[-1] != 0:
        chain.append(-1 * (chain[-2] % chain[-1]))
    chain.pop()

    def changes(signs: Sequence[int]) -> int:
        kept = [s for s in signs if s]
        return sum(a != b for a, b in pairwise(kept))

    at_zero = [_sign(f[0]) for f in chain]
    far = [_sign(f.leading_coefficient()) * (-1) ** f.degree() for f in chain]
    return changes(far) > changes(at_zero)


def _sign(x: fmpq) -> int:
    return (x > 0) - (x < 0)


JUDGES: Mapping[str, Callable[[Any, Any, System], bool]] = {
    "cost_bound": cost_bound,
    "disk_margin": disk_margin,
    "loop_cost": loop_cost,
    "sector": sector,
}
