"""Curves that show how robust a loop is, and how it returns to rest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from mcexact.analysis.stability.stability import POLYNOMIAL_LIMIT
from mcexact.exact.balls import even_powers
from mcexact.exact.floats import matrix_to_float
from mcexact.exact.location import StabilityRegion
from mcexact.model.loop import ClosedLoop
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.loop_figures import (
    boundary_points,
    input_response,
    input_rows,
    integrators_of,
    loop_eigenvalues,
)
from mcexact.synthesis.optimum.sensitivity import norm
from mcexact.synthesis.optimum.spectrum import SchurForm
from mcexact.synthesis.optimum.weights import Floats

_POINTS, _CONSTANTS, _STEPS = 300, 6.0, 400


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves of a stable loop, computed in floating point and not proved.

    Attributes
    ----------
    region : StabilityRegion
        Where eigenvalues should lie.
    eigenvalues : list of complex
    frequencies, sensitivity : list of float
        The largest singular value of the complementary sensitivity at the inputs of the plant, over
        the frequency.
    times, growth, effort : list of float
        The largest ‖x(t)‖ and ‖u(t)‖ from a unit state of the plant, the agents' states being 0.
    steps : list of (str, list of float)
        For a controller that holds set-points: each output after a unit step of its own set-point,
        with its name.
    """

    region: StabilityRegion
    eigenvalues: list[complex]
    frequencies: list[float]
    sensitivity: list[float]
    times: list[float]
    growth: list[float]
    effort: list[float]
    steps: list[tuple[str, list[float]]]

    def keeps(self, eigenvalue: complex) -> bool:
        """Whether an eigenvalue lies where it should."""
        region, size = self.region, abs(eigenvalue)
        if region.discrete:
            return size < region.edge
        damping, most = region.damping, region.largest_modulus
        damped = damping is None or -eigenvalue.real > damping * size
        return eigenvalue.real < -region.edge and damped and (most is None or size < most)


def curves_of(loop: ClosedLoop, region: StabilityRegion) -> Curves | None:
    """Compute the curves of a loop; None if it is not stable.

    Parameters
    ----------
    loop : ClosedLoop
    region : StabilityRegion
        What was asked for.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant, region = MultiChannelSystem([[1]], [[[1]]], [[[1]]]), StabilityRegion("continuous")
    >>> found = curves_of(closed_loop(plant, local_controllers(plant, [[[-3]]])), region)
    >>> round(max(found.sensitivity), 3), found.growth[0], found.growth[-1] < 0.01
    (1.5, 1.0, True)
    >>> found.effort[0], found.eigenvalues
    (3.0, [(-2+0j)])
    >>> curves_of(closed_loop(plant, local_controllers(plant, [[[0]]])), region)
    """
    M, n = matrix_to_float(loop.matrix), loop.given.n
    with quiet_floats():
        form = SchurForm.of(M, discrete=region.discrete)
        if form is None or not form.bound < (1.0 if region.discrete else 0.0):
            return None
        response, U = input_response(loop), input_rows(loop)
        values = loop_eigenvalues(loop.matrix, discrete=region.discrete)
        values = form.eigenvalues if values is None else values
        points = boundary_points(values, discrete=region.discrete)
        places = np.abs(np.angle(points)) if region.discrete else points.imag
        order = np.argsort(places)
        times, step = _times(M, form)
        interval = 0.0 if region.discrete else float(times[1])
        powers = None
        if len(M) <= POLYNOMIAL_LIMIT:
            powers = even_powers(loop.matrix, n, interval, len(times))
        if powers is None:
            powers = [power[:, :n] for power in _powers(step, len(times))]
        return Curves(
            region,
            values.tolist(),
            places[order].tolist(),
            response.sizes(points[order]).tolist(),
            times.tolist(),
            [norm(power[:n]) for power in powers],
            [norm(U @ power) for power in powers],
            _steps(loop, M, step, len(times), discrete=region.discrete),
        )


def _times(M: Floats, form: SchurForm) -> tuple[Floats, Floats]:
    """Times over some time constants of the slowest mode, and the matrix of one step."""
    if form.discrete:
        constants = _CONSTANTS / max(-np.log(max(form.bound, 1e-3)), 1e-3)
        count = int(min(max(constants, 10), _STEPS))
        return np.arange(count + 1, dtype=np.float64), M
    times = np.linspace(0.0, _CONSTANTS / -form.bound, _POINTS)
    return times, np.asarray(expm(M * times[1]), dtype=np.float64)


def _powers(step: Floats, count: int) -> Iterator[Floats]:
    """Yield the identity, and powers of a matrix."""
    power = np.eye(len(step))
    for _ in range(count):
        yield power
        power = step @ power


def _steps(
    loop: ClosedLoop, M: Floats, step: Floats, count: int, *, discrete: bool
) -> list[tuple[str, list[float]]]:
    """Each output after a unit step of its own set-point; () without integrators."""
    if not integrators_of(loop):
        return []
    n, given = loop.given.n, loop.given
    C, R = matrix_to_float(given.output_matrix()), matrix_to_float(loop.reference)
    at_rest = np.linalg.solve((np.eye(len(M)) if discrete else 0.0) - M, R)
    names = [
        name if given.q(i) == 1 else f"{name}, {k + 1}"
        for i, name in enumerate(given.names)
        for k in range(given.q(i))
    ]
    state, found = -at_rest, [list[float]() for _ in names]
    for _ in range(count):
        reached = C @ (at_rest + state)[:n]
        for each, output in zip(found, np.diag(reached).tolist(), strict=True):
            each.append(output)
        state = step @ state
    return list(zip(names, found, strict=True))
