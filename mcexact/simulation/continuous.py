"""Trajectories in continuous time, integrated from the equations of the plant and of each agent."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from mcexact.errors import LimitReached
from mcexact.exact.matrix import to_float
from mcexact.simulation.arithmetic import Arithmetic, Native, representable
from mcexact.simulation.network import Network, Snapshot
from mcexact.simulation.signals import Columns, Drive

STIFF = 20_000.0
"""The largest product of the horizon and the fastest mode for an explicit method."""


def integrated(
    network: Network, times: Sequence[Fraction], drive: Drive, fastest: float = 0.0
) -> list[Snapshot]:
    """Integrate the derivatives that the plant and the agents compute, in double precision.

    Parameters
    ----------
    network : Network
        At its initial state.
    times : sequence of Fraction
        Ascending.
    drive : Drive
    fastest : float
        The modulus of the fastest mode; where it is large, the method is implicit.

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
    numbers = network.arithmetic

    def load(flat: Any) -> None:
        pieces = np.split(flat.reshape(-1, 1), ends)
        network.set_state(pieces[0], list(zip(pieces[1::2], pieces[2::2], strict=True)))

    def gathered(state: Any, parts: Any) -> Any:
        return np.concatenate([state, *(piece for part in parts for piece in part)])[:, 0]

    def floats(signal: Columns) -> list[Native]:
        return [numbers.convert(M) for M in signal]

    representable(np.array([to_float(t) for t in times]))
    flat = gathered(network.state, [(agent.shared, agent.private) for agent in network.agents])
    scale = max(1.0, float(np.abs(flat).max(initial=0.0)))
    stiff = fastest * to_float(times[-1] - times[0]) > STIFF
    accuracy: dict[str, Any] = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13 * scale}
    if stiff:
        accuracy = {"method": "Radau", "rtol": 1e-8, "atol": 1e-11 * scale}
    wanted, snapshots = set(times), list[Snapshot]()
    for piece in drive.pieces(times):
        level, slope = (
            [floats(each) for each in (kind.at(piece[0]), kind.slope(piece[0]))]
            for kind in (drive.references, drive.disturbances)
        )
        grid = representable(np.array([to_float(t) for t in piece]))

        def derivative(
            t: float, flat: Any, level: Any = level, slope: Any = slope, start: Any = grid[0]
        ) -> Any:
            load(flat)
            network.set_signals(
                *(
                    [r + s * (t - start) for r, s in zip(*kind, strict=True)]
                    for kind in (level, slope)
                )
            )
            return representable(gathered(*network.evolution()))

        with np.errstate(over="ignore", invalid="ignore"):
            solved = solve_ivp(derivative, (grid[0], grid[-1]), flat, t_eval=grid, **accuracy)
        if not solved.success:
            raise LimitReached(f"the integration stopped: {solved.message}")
        for time, column in zip(piece, solved.y.T, strict=True):
            # The next piece starts with the last time of this one, after the change.
            if time in wanted and (time != piece[-1] or time == times[-1]):
                load(column)
                drive.apply(network, time)
                snapshots.append(network.round()[0])
        flat = solved.y[:, -1]
    return snapshots


def taylor(
    network: Network, times: Sequence[Fraction], drive: Drive, digits: int
) -> list[Snapshot]:
    """Sum Taylor series in multiple precision until further terms change nothing.

    Parameters
    ----------
    network : Network
        At its initial state, with arithmetic in multiple precision; afterwards at the last time.
    times : sequence of Fraction
        Ascending; the first one belongs to the initial state.
    drive : Drive
    digits : int
        The decimal digits of the arithmetic.

    Returns
    -------
    list of Snapshot
        One for each time.  These numbers are not enclosed, and prove nothing.
    """
    wanted = set(times)

    def shown(time: Fraction) -> list[Snapshot]:
        drive.apply(network, time)
        return [network.round()[0]] if time in wanted else []

    snapshots = shown(times[0])
    for piece in drive.pieces(times):
        for before, after in pairwise(piece):
            step = after - before
            now = before
            while now < after:
                step = min(step, after - now)
                if _taylor_step(network, now, step, drive, digits):
                    now += step
                else:
                    step /= 2
            snapshots += shown(after)
    return snapshots


def _taylor_step(
    network: Network, time: Fraction, step: Fraction, drive: Drive, digits: int
) -> bool:
    """Take a step x(t + h) = Σ h^k x^(k) / k!; return False and change nothing if the terms grow.

    The network computes the derivatives: one round at x gives x'.  Since the programs are linear,
    one round at x^(k) with the k-th derivatives of all signals gives x^(k+1).
    """
    numbers = network.arithmetic
    parts = [(agent.shared, agent.private) for agent in network.agents]
    start = network.state, parts
    total = term = start
    limit = 0.0
    for k in range(1, 40 * digits):
        # The state is h^(k−1) x^(k−1) / (k−1)!, and the signals have the same factor.
        drive.apply_derivative(network, time, k - 1, step)
        term = _scaled(network.evolution(), numbers.scalar(step / k))
        network.set_state(*term)
        total = _added(total, term)
        size = _size(numbers, term)
        if k == 1:
            limit = 10.0 ** (digits // 4) * max(_size(numbers, start), size)
        if not size <= limit:
            break
        if k > 1 and size <= _size(numbers, total) * 10.0**-digits:
            network.set_state(*total)
            return True
    network.set_state(*start)
    return False


Parts = tuple[Native, list[tuple[Native, Native]]]


def _scaled(value: Parts, factor: Any) -> Parts:
    return value[0] * factor, [(x * factor, z * factor) for x, z in value[1]]


def _added(a: Parts, b: Parts) -> Parts:
    pairs = zip(a[1], b[1], strict=True)
    return a[0] + b[0], [(x + u, z + v) for (x, z), (u, v) in pairs]


def _size(numbers: Arithmetic, value: Parts) -> float:
    columns = [value[0], *(piece for part in value[1] for piece in part)]
    return max(numbers.largest(column) for column in columns)
