"""Trajectories in continuous time, integrated from the equations of the plant and of each agent."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from mcexact.errors import LimitReached
from mcexact.exact.floats import to_float
from mcexact.simulation.arithmetic import Arithmetic, Native
from mcexact.simulation.network import Network, Snapshot


def integrated(network: Network, times: Sequence[Fraction]) -> list[Snapshot]:
    """Integrate the derivatives that the plant and the agents compute, in double precision.

    Raises
    ------
    LimitReached
        If a number exceeds the range of double precision, or scipy's integration stops early.
    """
    import numpy as np
    from scipy.integrate import solve_ivp

    sizes = [len(network.state)]
    for agent in network.agents:
        sizes += [len(agent.shared), len(agent.private)]
    ends = np.cumsum(sizes)[:-1]

    def load(flat: Any) -> None:
        pieces = np.split(flat.reshape(-1, 1), ends)
        network.set_state(pieces[0], list(zip(pieces[1::2], pieces[2::2], strict=True)))

    def gathered(state: Any, parts: Any) -> Any:
        return np.concatenate([state, *(piece for part in parts for piece in part)])[:, 0]

    def derivative(_: float, flat: Any) -> Any:
        load(flat)
        return representable(gathered(*network.evolution()))

    def representable(numbers: Any) -> Any:
        if not np.all(np.isfinite(numbers)):
            raise LimitReached(
                "the trajectory has numbers beyond the range of double precision; "
                "use multiprecision arithmetic or a shorter horizon"
            )
        return numbers

    start = gathered(network.state, [(agent.shared, agent.private) for agent in network.agents])
    grid = representable(np.array([to_float(t) for t in times]))
    scale = max(1.0, float(np.abs(start).max(initial=0.0)))
    with np.errstate(over="ignore", invalid="ignore"):
        solved = solve_ivp(
            derivative,
            (grid[0], grid[-1]),
            start,
            method="DOP853",
            t_eval=grid,
            rtol=1e-11,
            atol=1e-13 * scale,
        )
    if not solved.success:
        raise LimitReached(f"the integration stopped: {solved.message}")
    snapshots = []
    for flat in solved.y.T:
        load(flat)
        snapshots.append(network.snapshot())
    return snapshots


def taylor(network: Network, times: Sequence[Fraction], digits: int) -> list[Snapshot]:
    """Sum Taylor series in multiple precision until further terms change nothing.

    Parameters
    ----------
    network : Network
        At its initial state, with arithmetic in multiple precision; afterwards at the last time.
    times : sequence of Fraction
        Ascending; the first one belongs to the initial state.
    digits : int
        The decimal digits of the arithmetic.

    Returns
    -------
    list of Snapshot
        One for each time.  These numbers are not enclosed, and prove nothing.
    """
    snapshots = [network.snapshot()]
    for before, after in pairwise(times):
        rest = after - before
        step = rest
        while rest > 0:
            step = min(step, rest)
            if _taylor_step(network, step, digits):
                rest -= step
            else:
                step /= 2
        snapshots.append(network.snapshot())
    return snapshots


def _taylor_step(network: Network, step: Fraction, digits: int) -> bool:
    """Take a step x(t + h) = Σ h^k x^(k) / k!; return False and change nothing if the terms grow.

    The network computes the derivatives: one round at x gives x'.  Since the programs are linear,
    one round at x^(k) with all set-points 0 gives x^(k+1).
    """
    numbers = network.arithmetic
    parts = [(agent.shared, agent.private) for agent in network.agents]
    start = network.state, parts
    references = [agent.reference for agent in network.agents]
    total = term = start
    limit = 10.0 ** (digits // 4) * max(_size(numbers, start), 1e-300)
    finished = False
    for k in range(1, 40 * digits):
        rate = network.evolution()
        if k == 1:
            for agent in network.agents:
                agent.reference = agent.reference * numbers.scalar(Fraction(0))
        term = _scaled(rate, numbers.scalar(step / k))
        network.set_state(*term)
        total = _added(total, term)
        size = _size(numbers, term)
        if not size <= limit:
            break
        if size <= _size(numbers, total) * 10.0**-digits:
            finished = True
            break
    for agent, reference in zip(network.agents, references, strict=True):
        agent.reference = reference
    network.set_state(*(total if finished else start))
    return finished


Parts = tuple[Native, list[tuple[Native, Native]]]


def _scaled(value: Parts, factor: Any) -> Parts:
    return value[0] * factor, [(x * factor, z * factor) for x, z in value[1]]


def _added(a: Parts, b: Parts) -> Parts:
    pairs = zip(a[1], b[1], strict=True)
    return a[0] + b[0], [(x + u, z + v) for (x, z), (u, v) in pairs]


def _size(numbers: Arithmetic, value: Parts) -> float:
    columns = [value[0], *(piece for part in value[1] for piece in part)]
    return max(numbers.largest(column) for column in columns)
