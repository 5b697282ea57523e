"""Costs of drawn controllers beside the bound that is proved for every linear controller.

Run as ``python -m benchmarks.costs``, which writes ``benchmarks/COSTS.md`` in some minutes.

200 plants are drawn, each with weights, and for each plant five controllers of some kind that
stabilize it.  Their costs are computed here alone, with numpy: a Lyapunov equation is solved as a
linear system of all entries, a Riccati equation by the eigenvectors of its Hamiltonian, and the
best controller is built from these and put into the loop like any other one.  Of the package only
two numbers are taken for each plant, the bound that it proposes in floating point and the one that
it certifies, which the checker checks again.

A cost below the certified bound would refute the theorem or the checker.  The proposed bound is to
be the cost of the best controller, to 10⁻⁶, and the certified one at most 3 % below.
"""

from __future__ import annotations

import math
import os
import random
import sys
import textwrap
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import islice
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import numpy.typing as npt

from mcexact import MultiChannelSystem, check
from mcexact.analysis.performance import computed_bound
from mcexact.performance import CostWeights, cost_bound

PAGE = Path(__file__).with_name("COSTS.md")
PLANTS, CONTROLLERS, SEED = 200, 5, 38
FAMILIES = (
    "continuous time, filtered noise, proper controllers",
    "continuous time, white noise, strictly proper controllers",
    "discrete time",
)
_TRIES = 60
_PRECISION = 1e-9
"""By how much a cost that is computed in floating point may be too small, as a part of it."""

Floats = npt.NDArray[np.float64]


# Plants, weights, and controllers ẋ_c = A_c x_c + B_c y, u = C_c x_c + D_c y.


@dataclass(frozen=True)
class Plant:
    """ẋ = Ax + Bu + w, y = Cx + v, or x(t+1), with the diagonals of Q, R, W and V, and ω."""

    A: Floats
    B: Floats
    C: Floats
    Q: Floats
    R: Floats
    W: Floats
    V: Floats
    discrete: bool
    bandwidth: float | None = None

    @property
    def n(self) -> int:
        return len(self.A)


Controller = tuple[Floats, Floats, Floats, Floats]
"""A_c, B_c, C_c and D_c."""
Drawn = tuple[MultiChannelSystem, CostWeights, Plant, list[tuple[int, int]]]
"""A plant for the package and for this module, and the inputs and outputs of each agent."""


def drawn(dice: random.Random, family: int) -> Drawn:
    """A plant of one to six states and one to three agents, with weights of few digits."""
    n, m = dice.randint(1, 6), dice.randint(1, 3)
    discrete = family == 2
    ports = [(dice.randint(1, 2), dice.randint(1, 2)) for _ in range(m)]

    def matrix(rows: int, columns: int, size: int) -> list[list[Fraction]]:
        return [
            [Fraction(dice.randint(-size, size), 10) for _ in range(columns)] for _ in range(rows)
        ]

    def some(count: int, choices: str) -> tuple[Fraction, ...]:
        return tuple(Fraction(dice.choice(choices.split())) for _ in range(count))

    system = MultiChannelSystem(
        matrix(n, n, 12 if discrete else 20),
        [matrix(n, p, 20) for p, _ in ports],
        [matrix(q, n, 20) for _, q in ports],
        time="discrete" if discrete else "continuous",
    )
    p, q = (sum(each) for each in zip(*ports, strict=True))
    weights = CostWeights(
        some(n, "1/10 1 1 3"),
        some(p, "1/10 1 1 5"),
        some(n, "1/10 1 1 4"),
        some(q, "1/1000 1/100 1/10 1"),
        bandwidth=Fraction(dice.choice([20, 100, 1000])) if family == 0 else None,
    )

    def floats(rows: Any) -> Floats:
        return np.array([[float(x) for x in row] for row in rows], dtype=np.float64)

    def diagonal(entries: Sequence[Fraction]) -> Floats:
        return np.diag([float(x) for x in entries])

    plant = Plant(
        floats(system.A.rows()),
        floats(system.input_matrix().rows()),
        floats(system.output_matrix().rows()),
        diagonal(weights.states),
        diagonal(weights.inputs),
        diagonal(weights.disturbances),
        diagonal(weights.noise),
        discrete,
        None if weights.bandwidth is None else float(weights.bandwidth),
    )
    return system, weights, plant, ports


# Costs and best controllers, by numpy alone.


def covariance(M: Floats, N: Floats, *, discrete: bool) -> Floats:
    """X with MX + XM' + N = 0, or X = MXM' + N, from the linear system of all its entries."""
    size = len(M)
    one = np.eye(size)
    if discrete:
        whole = np.eye(size * size) - np.kron(M, M)
    else:
        whole = -(np.kron(M, one) + np.kron(one, M))
    X = np.linalg.solve(whole, N.ravel()).reshape(size, size)
    return np.asarray((X + X.T) / 2)


def is_stable(M: Floats, *, discrete: bool) -> bool:
    """Whether all eigenvalues lie inside, away from the border."""
    values = np.linalg.eigvals(M)
    return bool(np.max(np.abs(values)) < 0.999 if discrete else np.max(values.real) < -1e-3)


def loop_of(plant: Plant, controller: Controller) -> Floats:
    """The matrix of the loop in (x, x_c)."""
    A_c, B_c, C_c, D_c = controller
    A, B, C = plant.A, plant.B, plant.C
    return np.block([[A + B @ D_c @ C, B @ C_c], [B_c @ C, A_c]])


def cost_of(plant: Plant, controller: Controller) -> float:
    """The stationary mean of x'Qx + u'Ru; NaN if the loop is not stable."""
    _, B_c, C_c, D_c = controller
    M, n, q = loop_of(plant, controller), plant.n, len(plant.C)
    if not is_stable(M, discrete=plant.discrete):
        return math.nan
    entering = np.vstack([plant.B @ D_c, B_c])
    U, K = np.hstack([D_c @ plant.C, C_c]), D_c
    noise = np.zeros(M.shape)
    noise[:n, :n] = plant.W
    at_once = 0.0
    if plant.bandwidth is None:
        noise = noise + entering @ plant.V @ entering.T
        at_once = float(np.trace(plant.R @ K @ plant.V @ K.T))
    else:
        w = plant.bandwidth
        M = np.block([[M, entering], [np.zeros((q, len(M))), -w * np.eye(q)]])
        noise = np.block(
            [[noise, np.zeros((len(noise), q))], [np.zeros((q, len(noise))), w * w * plant.V]]
        )
        U = np.hstack([U, K])
    X = covariance(M, noise, discrete=plant.discrete)
    return float(np.trace(plant.Q @ X[:n, :n]) + np.trace(plant.R @ U @ X @ U.T)) + at_once


def riccati(A: Floats, B: Floats, Q: Floats, R: Floats, N: Floats, *, discrete: bool) -> Floats:
    """The stabilizing solution for the cost x'Qx + 2x'Nu + u'Ru, by eigenvectors.

    In discrete time with N = 0 and a regular A.
    """
    n = len(A)
    if discrete:
        G, back = B @ np.linalg.solve(R, B.T), np.linalg.inv(A).T
        H = np.block([[A + G @ back @ Q, -G @ back], [-back @ Q, back]])
        values, vectors = np.linalg.eig(H)
        inside = np.argsort(np.abs(values))[:n]
    else:
        own = A - B @ np.linalg.solve(R, N.T)
        H = np.block(
            [[own, -B @ np.linalg.solve(R, B.T)], [-Q + N @ np.linalg.solve(R, N.T), -own.T]]
        )
        values, vectors = np.linalg.eig(H)
        inside = np.argsort(values.real)[:n]
    X = vectors[:, inside]
    P = np.real(X[n:] @ np.linalg.inv(X[:n]))
    return np.asarray((P + P.T) / 2)


def regulator(plant: Plant, Q: Floats, R: Floats) -> Floats:
    """F of u = Fx."""
    A, B = plant.A, plant.B
    P = riccati(A, B, Q, R, np.zeros(B.shape), discrete=plant.discrete)
    if plant.discrete:
        return np.asarray(-np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A))
    return np.asarray(-np.linalg.solve(R, B.T @ P))


def filter_gain(plant: Plant, W: Floats, V: Floats) -> Floats:
    """L of the estimate that `of_gains` uses."""
    A, C, w = plant.A, plant.C, plant.bandwidth
    none = np.zeros((plant.n, len(C)))
    if plant.discrete:
        S = riccati(A.T, C.T, W, V, none, discrete=True)
        return np.asarray(np.linalg.solve(C @ S @ C.T + V, C @ S).T)
    if w is None:
        return np.asarray(np.linalg.solve(V, C @ riccati(A.T, C.T, W, V, none, discrete=False)).T)
    # y' + ωy − CBu = (CA + ωC)x + Cw + ωn is measured in white noise, which w enters as well.
    seen, noise, across = C @ A + w * C, C @ W @ C.T + w * w * V, W @ C.T
    S = riccati(A.T, seen.T, W, noise, across, discrete=False)
    return np.asarray(np.linalg.solve(noise, (S @ seen.T + across).T).T)


def of_gains(plant: Plant, F: Floats, L: Floats) -> Controller:
    """The controller u = Fx̂, whose estimate x̂ uses the last output where it may."""
    A, B, C, w = plant.A, plant.B, plant.C, plant.bandwidth
    if plant.discrete:
        # x̂ = x_c + L(y − C x_c), and x_c(t+1) = (A + BF)x̂
        kept = np.eye(plant.n) - L @ C
        return (A + B @ F) @ kept, (A + B @ F) @ L, F @ kept, F @ L
    if w is None:
        return A + B @ F - L @ C, L, F, np.zeros((len(F), len(C)))
    # x̂ = x_c + Ly, so that the derivative of y is not needed
    drift = A + B @ F - L @ (C @ B @ F + C @ A + w * C)
    return drift, drift @ L + w * L, F, F @ L


def best(plant: Plant) -> Controller:
    """The best of all linear controllers."""
    F, L = regulator(plant, plant.Q, plant.R), filter_gain(plant, plant.W, plant.V)
    return of_gains(plant, F, L)


# Controllers of several kinds, which may fail to stabilize.


def _positive(dice: random.Random, size: int) -> Floats:
    return np.diag([10 ** dice.uniform(-1.5, 1.5) for _ in range(size)])


def _normal(dice: random.Random, rows: int, columns: int) -> Floats:
    return np.array([[dice.gauss(0, 1) for _ in range(columns)] for _ in range(rows)]).reshape(
        rows, columns
    )


def perturbed(dice: random.Random, plant: Plant, ports: list[tuple[int, int]]) -> Controller:
    """The best one with changed entries."""
    size = 10 ** dice.uniform(-5, -0.5)
    parts = [M * (1 + size * _normal(dice, *M.shape)) for M in best(plant)]
    return parts[0], parts[1], parts[2], parts[3]


def other_weights(dice: random.Random, plant: Plant, ports: list[tuple[int, int]]) -> Controller:
    """The best one for other weights."""
    p, q = plant.B.shape[1], len(plant.C)
    F = regulator(plant, _positive(dice, plant.n), _positive(dice, p))
    return of_gains(plant, F, filter_gain(plant, _positive(dice, plant.n), _positive(dice, q)))


def static(dice: random.Random, plant: Plant, ports: list[tuple[int, int]]) -> Controller:
    """Gains of all outputs."""
    p, q = plant.B.shape[1], len(plant.C)
    none = np.zeros((0, 0)), np.zeros((0, q)), np.zeros((p, 0))
    return *none, _normal(dice, p, q) * 10 ** dice.uniform(-2, 1)


def local(dice: random.Random, plant: Plant, ports: list[tuple[int, int]]) -> Controller:
    """Each agent uses its own outputs, with up to two states."""
    p, q = plant.B.shape[1], len(plant.C)
    orders = [dice.randint(0, 2) for _ in ports]
    N, size = sum(orders), 10 ** dice.uniform(-1, 0.7)
    A_c, B_c = np.zeros((N, N)), np.zeros((N, q))
    C_c, D_c = np.zeros((p, N)), np.zeros((p, q))
    z = i = j = 0
    for order, (inputs, outputs) in zip(orders, ports, strict=True):
        of_z, of_u, of_y = slice(z, z + order), slice(i, i + inputs), slice(j, j + outputs)
        own = _normal(dice, order, order)
        A_c[of_z, of_z] = 0.4 * own if plant.discrete else own - 2 * np.eye(order)
        B_c[of_z, of_y] = _normal(dice, order, outputs)
        C_c[of_u, of_z] = size * _normal(dice, inputs, order)
        D_c[of_u, of_y] = size * _normal(dice, inputs, outputs)
        z, i, j = z + order, i + inputs, j + outputs
    return A_c, B_c, C_c, D_c


def doubled(dice: random.Random, plant: Plant, ports: list[tuple[int, int]]) -> Controller:
    """The mean of two estimators, of twice the order."""
    first, second = (other_weights(dice, plant, ports) for _ in range(2))
    none = np.zeros((len(first[0]), len(second[0])))
    return (
        np.block([[first[0], none], [none.T, second[0]]]),
        np.vstack([first[1], second[1]]),
        np.hstack([first[2], second[2]]) / 2,
        (first[3] + second[3]) / 2,
    )


KINDS: dict[str, Callable[[random.Random, Plant, list[tuple[int, int]]], Controller]] = {
    "best with changed entries": perturbed,
    "best for other weights": other_weights,
    "static gains": static,
    "local, of low order": local,
    "of twice the order": doubled,
}


def stabilizing(
    dice: random.Random, plant: Plant, ports: list[tuple[int, int]]
) -> list[tuple[str, float]]:
    """Kinds and costs of controllers that stabilize a plant, of as many kinds as are found."""
    strictly = not plant.discrete and plant.bandwidth is None

    def cost(kind: str) -> float:
        A_c, B_c, C_c, D_c = KINDS[kind](dice, plant, ports)
        return cost_of(plant, (A_c, B_c, C_c, 0 * D_c if strictly else D_c))

    kinds, found = list(KINDS), list[tuple[str, float]]()
    for kind in kinds:
        tried = ((kind, cost(kind)) for _ in range(_TRIES))
        found += islice((each for each in tried if math.isfinite(each[1])), 1)
    for _ in range(_TRIES):
        if len(found) < CONTROLLERS:
            kind = dice.choice(kinds)
            more = kind, cost(kind)
            found += [more] if math.isfinite(more[1]) else []
    return found


# What was found, family by family.


@dataclass
class Found:
    """The figures of a family of plants."""

    plants: int = 0
    kinds: Counter[str] = field(default_factory=Counter)
    below: int = 0
    least: float = math.inf
    """The least cost over the certified bound."""
    proposed: float = 0.0
    """The largest difference of the proposed bound and the cost of the best controller."""
    certified: float = 0.0
    """The largest part by which the certified bound is below this cost."""
    unproved: int = 0
    left_out: int = 0
    """Plants for which no five controllers were found."""


def examine(dice: random.Random, family: int, found: Found) -> None:
    """Draw a plant and its controllers, and compare their costs with the bounds."""
    while True:
        system, weights, plant, ports = drawn(dice, family)
        if plant.discrete and np.linalg.cond(plant.A) > 1e6:
            continue
        costs = stabilizing(dice, plant, ports)
        optimal = cost_of(plant, best(plant))
        if len(costs) == CONTROLLERS and math.isfinite(optimal):
            break
        found.left_out += 1
    found.plants += 1
    proposed = computed_bound(system, weights)
    found.proposed = max(found.proposed, abs(proposed / optimal - 1))
    bound = cost_bound(system, weights)
    if check(bound, system).verdict != "VALID":
        found.unproved += 1
        return
    least = float(bound.cost)
    found.certified = max(found.certified, 1 - least / optimal)
    for kind, cost in [*costs, ("best", optimal)]:
        found.kinds[kind] += 1
        found.below += cost < least * (1 - _PRECISION)
        found.least = min(found.least, cost / least)


def examined(plants: int = PLANTS, seed: int = SEED) -> list[Found]:
    """Examine so many plants, in turn of each family."""
    families = [Found() for _ in FAMILIES]
    dice = random.Random(seed)
    for k in range(plants):
        family = k % len(FAMILIES)
        examine(dice, family, families[family])
    return families


def page(families: list[Found]) -> str:
    """The page of what was found."""
    drawn_plants = sum(each.plants for each in families)
    kinds = sum((each.kinds for each in families), Counter[str]())
    best_ones = kinds.pop("best")
    lines = [
        "# Costs of drawn controllers beside the certified bound",
        "",
        "Made by `make costs`.",
        "",
        textwrap.fill(
            f"{drawn_plants} plants of one to six states and one to three agents, each with drawn "
            f"weights and {CONTROLLERS} controllers that stabilize it. Costs, and the best "
            "controller of all, are computed by numpy alone (`benchmarks/costs.py`), in another "
            "way than by the package. A cost below the certified bound would be an error.",
            100,
        ),
        "",
        "| plants | number | costs below the certified bound | least cost / certified bound "
        "| proposed bound and best cost differ by at most "
        "| certified bound below best cost by at most |",
        "|---|---|---|---|---|---|",
    ]
    for name, each in zip(FAMILIES, families, strict=True):
        lines.append(
            f"| {name} | {each.plants} | {each.below} of {each.kinds.total()} | {each.least:.6f} "
            f"| {each.proposed:.1e} | {100 * each.certified:.3f} % |"
        )
    lines += [
        "",
        f"Certificates that the checker refuses: {sum(each.unproved for each in families)}.",
        textwrap.fill(
            f"Plants left out, since no {CONTROLLERS} controllers were found that keep all "
            f"eigenvalues away from the border: {sum(each.left_out for each in families)}. "
            "In discrete time A has a condition number up to 10⁶.",
            100,
        ),
        "",
        "The controllers:",
        "",
        *(f"- {kind}: {count}" for kind, count in sorted(kinds.items())),
        f"- the best one of each plant: {best_ones}",
        "",
    ]
    return "\n".join(lines)


def main() -> int:
    """Write the page; the status is 1 if a promise is broken."""
    began = time.process_time()
    families = examined()
    PAGE.write_text(page(families), encoding="utf-8")
    print(f"{PAGE.name}: {time.process_time() - began:.0f} s of the processor")
    kept = all(
        not each.below and not each.unproved and each.proposed < 1e-6 and each.certified < 0.03
        for each in families
    )
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
