"""Judges of sentences about costs, bounds for every controller, disk margins, sectors and steps.

The cost of a loop is an exact solution of a Lyapunov equation, and a bound for every controller is
compared with the cost of the best one.  A margin of one input is decided by the eigenvalues of a
Hamiltonian matrix.  What is said of all inputs together, of sectors, or of the controllers within a
graph can only be refuted: at drawn multipliers, and by the loop at hand.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from flint import fmpq, fmpq_mat

from tests.oracle.certificates.controllers import Agent, read_agents
from tests.oracle.certificates.performance import (
    Disturbed,
    cost_of,
    disturbed_loop,
    has_margin,
    least_cost,
)
from tests.oracle.certificates.roots import inside
from tests.oracle.certificates.steps import seen_peaks, signals
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import Case, Region, Said, UnjudgedError, number
from tests.oracle.sentences.designs import floats
from tests.oracle.sentences.members import at_samples, loop_of, members, shares

DRAWS = 400
"""How many multipliers of inputs or outputs are drawn."""
NEAR = 1 + 1e-6
"""Costs of best controllers are computed in floating point."""
Diagonals = list[list[fmpq]]


def _loop(case: Case) -> Disturbed:
    return disturbed_loop(case.plant, case.loop.agents)


def _weights(value: Sequence[Any]) -> tuple[Diagonals, fmpq | None]:
    """The diagonals of Q, R, W and V, and ω."""
    *diagonals, omega = value
    read = [[number(x) for x in diagonal] for diagonal in diagonals]
    if any(x < 0 for diagonal in read for x in diagonal) or not all(read[1]):
        raise UnjudgedError("weights below 0, or of an input that costs nothing")
    return read, None if omega is None else number(omega)


def _told(said: Said, case: Case) -> tuple[Diagonals, fmpq | None]:
    """The weights of a sentence, or those that another one named beside it."""
    if "weights" in said.values:
        return _weights(said.values["weights"])
    return _weights(case.others("performance-cost")[0].values["weights"])


def _best(case: Case, diagonals: Diagonals, omega: fmpq | None) -> float:
    """The cost of the best of all controllers."""
    plant = case.plant
    matrices = (plant.A, plant.inputs(), plant.outputs())
    return least_cost(matrices, diagonals, omega, plant.time)


def _own(case: Case, diagonals: Diagonals, omega: fmpq | None) -> fmpq | None:
    """The cost of the loop at hand; None if it is infinite."""
    loop = _loop(case)
    at_once = case.plant.time == "continuous" and omega is None and any(loop.K.entries())
    return None if at_once else cost_of(loop, diagonals, omega, case.plant.time)


def _float(x: fmpq) -> float:
    return int(x.p) / int(x.q)


def _kind(said: Said, case: Case, omega: fmpq | None) -> bool:
    """Whether only controllers that pass nothing on at once are meant, where that is needed."""
    return bool(said.values["proper"] or case.plant.time == "discrete" or omega is not None)


@judge("performance-cost")
def _cost(said: Said, case: Case) -> bool:
    cost = _own(case, *_told(said, case))
    return cost is not None and bool(cost <= number(said.values["cost"]))


@judge("performance-bound")
def _bound(said: Said, case: Case) -> bool:
    diagonals, omega = _told(said, case)
    best = _best(case, diagonals, omega)
    least = _float(number(said.values["cost"]))
    return _kind(said, case, omega) and least <= best * NEAR + 1e-12


@judge("performance-ratio", "first-cost")
def _ratio(said: Said, case: Case) -> bool:
    """Whether the cost of the loop is at most so many times that of the best controller."""
    diagonals, omega = _told(said, case)
    cost = _own(case, diagonals, omega)
    if cost is None or not _kind(said, case, omega):
        return False
    most = _float(number(said.values["ratio"])) * _best(case, diagonals, omega)
    return _float(cost) <= most * NEAR + 1e-12


def _is_within(said: Said, case: Case) -> bool:
    """Whether no agent of the loop at hand uses signals of others but along these edges."""
    edges = [[case.plant.names.index(name) for name in pair] for pair in said.values["edges"]]
    used = {
        (j, i)
        for i, agent in enumerate(case.loop.agents)
        for parts in agent.maps.values()
        for _, j in parts
        if j != i
    }
    return all([j, i] in edges for j, i in used)


@judge("performance-bound-graph", "performance-ratio-graph")
def _group_bound(said: Said, case: Case) -> bool:
    """The loop at hand does not cost less, if it is one of those that are meant."""
    diagonals, omega = _told(said, case)
    if not _is_within(said, case):
        raise UnjudgedError("the loop is none of those that the bound is about")
    cost = _own(case, diagonals, omega)
    if "ratio" in said.values:
        return cost is not None and bool(number(said.values["ratio"]) >= 1)
    return cost is None or bool(number(said.values["cost"]) <= cost)


def _sizes(case: Case, at: str) -> int:
    loop = _loop(case)
    return int((loop.U if at == "inputs" else loop.Y).nrows())


def _single(case: Case, at: str, margin: fmpq) -> bool:
    """Whether every port by itself has a margin."""
    loop = _loop(case)
    return margin > 0 and all(
        has_margin(loop, at, [k], [fmpq(1)], margin) for k in range(_sizes(case, at))
    )


@judge("performance-input-margin", "performance-output-margin")
def _margin(said: Said, case: Case) -> bool:
    at = "inputs" if said.rule == "performance-input-margin" else "outputs"
    return _single(case, at, number(said.values["margin"]))


@judge("performance-another-step")
def _margin_with_another_step(said: Said, case: Case) -> bool:
    """Every port of the loop of samples with another step has a margin."""
    how, margin = case.asked.get("sampling"), number(said.values["margin"])
    if how is None or case.controller is None or margin <= 0:
        return False
    step = Fraction(said.values["step"])
    written = step.numerator if step.denominator == 1 else str(step)
    held = case.made({**how, "construction": "sampled", "step": written})
    loop = disturbed_loop(held, read_agents(held, case.controller))
    ports = {"inputs": loop.U.nrows(), "outputs": loop.Y.nrows()}
    return all(
        has_margin(loop, at, [k], [fmpq(1)], margin) for at in ports for k in range(ports[at])
    )


@judge("performance-at-samples")
def _margin_at_samples(said: Said, case: Case) -> bool:
    """Every port of the loop of samples has a margin, with the controller by Tustin's rule."""
    margin, h = number(said.values["margin"]), Fraction(said.values["step"])
    if case.controller is None or case.controller["time"] != "continuous" or margin <= 0:
        return False
    agents = [
        _by_tustin(*each, h / 2) for each in enumerate(read_agents(case.plant, case.controller))
    ]
    step = h.numerator if h.denominator == 1 else str(h)
    held = case.made({"construction": "sampled", "step": step, "late": 0, "decimals": 12})
    loop = disturbed_loop(held, agents)
    ports = {"inputs": loop.U.nrows(), "outputs": loop.Y.nrows()}
    return all(
        has_margin(loop, at, [k], [fmpq(1)], margin) for at in ports for k in range(ports[at])
    )


def _by_tustin(i: int, agent: Agent, half: Fraction) -> Agent:
    """Agent i at samples; its numbers are not rounded."""
    own, k, h = ("private", i), agent.private, fmpq(half.numerator, half.denominator)
    one = fmpq_mat(k, k, [int(a == b) for a in range(k) for b in range(k)])
    update, control = (dict(agent.maps[label]) for label in ("private_update", "input"))
    A = update.pop(own, one * 0)
    X = (one - A * h).inv() if k else one
    C = control.pop(own, None)
    fed = {signal: X * M for signal, M in update.items()}
    again = Agent(0, k)
    again.maps["shared_update"] = {}
    again.maps["private_update"] = {own: X * (one + A * h)}
    again.maps["private_update"] |= {signal: M * (2 * h) for signal, M in fed.items()}
    again.maps["input"] = control
    if C is not None:
        again.maps["input"] = control | {
            signal: C * M * h + control[signal] if signal in control else C * M * h
            for signal, M in fed.items()
        }
        again.maps["input"][own] = C * X
    return again


@judge(
    "members-input-margin",
    "members-output-margin",
    "members-input-margin-part",
    "members-output-margin-part",
)
def _margin_of_members(said: Said, case: Case) -> bool:
    """The margin of each input, or output, of drawn plants of the box, each decided exactly."""
    at = "inputs" if said.rule.startswith("members-input") else "outputs"
    part = number(Fraction(said.values["part"])) if "part" in said.values else None
    margin = number(said.values["margin"])
    if part is None and case.plant.radii is None:
        return False
    for plant in members(case.plant, part):
        loop = disturbed_loop(plant, read_agents(plant, case.controller))
        ports = (loop.U if at == "inputs" else loop.Y).nrows()
        if not all(has_margin(loop, at, [k], [fmpq(1)], margin) for k in range(ports)):
            return False
    return True


@judge("first-margin")
def _every_margin(said: Said, case: Case) -> bool:
    margin = number(said.values["margin"])
    return all(_single(case, at, margin) for at in ("inputs", "outputs"))


def _is_stable(M: np.ndarray, time: str) -> bool:
    values = np.linalg.eigvals(M) if len(M) else np.zeros(0)
    if time == "discrete":
        return bool(np.max(np.abs(values), initial=0.0) < 1 + 1e-9)
    return bool(np.max(values.real, initial=-1.0) < 1e-9 * (1 + np.abs(values).max(initial=0)))


@judge("performance-all-inputs-margin", "performance-all-outputs-margin")
def _together(said: Said, case: Case) -> bool:
    """The loop under drawn multipliers of all inputs, or of all outputs."""
    loop, rng = _loop(case), np.random.default_rng(1)
    inputs = said.rule == "performance-all-inputs-margin"
    M, enter, leave = (
        floats(each) for each in ((loop.M, loop.E, loop.U) if inputs else (loop.M, loop.G, loop.Y))
    )
    alpha, count = _float(number(said.values["margin"])), leave.shape[0]
    if alpha <= 0 or not _is_stable(M, case.plant.time):
        return False
    for k in range(DRAWS):
        d = alpha * np.exp(2j * np.pi * (rng.random(count) if k % 2 else rng.random()))
        d = d * np.ones(count) * (1 if k % 3 else rng.random(count))
        # the plant receives u + (f − 1)u, f = (1 + d/2)/(1 − d/2)
        more = d / (1 - d / 2)
        if not _is_stable(M + (enter * more) @ leave, case.plant.time):
            return False
    return True


@judge("performance-sectors")
def _sectors(said: Said, case: Case) -> bool:
    """The loop under drawn gains within the sectors, ends included."""
    loop, rng = _loop(case), random.Random(1)
    M, E, U = (floats(each) for each in (loop.M, loop.E, loop.U))
    ends = [[_float(number(end)) for end in pair] for pair in said.values["sectors"]]
    if len(ends) != U.shape[0] or any(len(pair) != 2 or pair[0] > pair[1] for pair in ends):
        return False
    for k in range(DRAWS):
        drawn = [rng.choice(pair) if k % 2 else rng.uniform(*pair) for pair in ends]
        more = np.array([gain - 1 for gain in drawn])
        if not _is_stable(M + (E * more) @ U, case.plant.time):
            return False
    return True


@judge("performance-input-steps", "performance-output-steps", "performance-setpoint-steps")
def _steps(said: Said, case: Case) -> bool:
    """The peaks that are seen at very many times."""
    loop, at = _loop(case), f"{said.rule.split('-')[1]}s"
    if not inside(loop.M.charpoly(), case.plant.time, None):
        return False
    peaks = seen_peaks(*signals(loop, case.loop, at), case.plant.time) * (1 - 1e-9)
    p, told = loop.U.nrows(), _float(number(said.values["peak"]))
    own = np.diag(peaks[:p] if at == "inputs" else peaks[p:])
    return len(own) > 0 and bool(np.max(own) <= told + 1e-12)


@judge("first-box", "first-radii")
def _box(said: Said, case: Case) -> bool:
    """The loops of drawn plants in the box."""
    if case.controller is None or (case.plant.radii is None and said.rule == "first-radii"):
        return False
    part = number(Fraction(said.values["part"])) if "part" in said.values else None
    if "sampling" in case.asked:
        return at_samples(said, case, members(case.plant, part))
    rng = random.Random(1)
    for k, plant in enumerate(members(case.plant, part)):
        matrix = loop_of(plant, case.controller, None, shares(rng, k % 2 == 0))
        if not Region(case.plant.time).contains(matrix.charpoly()):
            return False
    return True
