"""Curves that show how robust a loop is, and how it returns to rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from mcexact.exact.floats import matrix_to_float
from mcexact.exact.location import is_discrete
from mcexact.model.loop import ClosedLoop
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.loop_figures import boundary_points, input_response
from mcexact.synthesis.optimum.sensitivity import norm
from mcexact.synthesis.optimum.spectrum import SchurForm
from mcexact.synthesis.optimum.weights import Floats

_POINTS, _CONSTANTS, _STEPS = 300, 6.0, 400


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves of a stable loop, computed in floating point and not proved.

    Attributes
    ----------
    discrete : bool
    frequencies, sensitivity : list of float
        The largest singular value of the complementary sensitivity at the inputs of the plant, over
        the frequency.
    times, growth : list of float
        The largest ‖x(t)‖ from a unit state of the plant, the agents' states being 0.
    """

    discrete: bool
    frequencies: list[float]
    sensitivity: list[float]
    times: list[float]
    growth: list[float]


def curves_of(loop: ClosedLoop) -> Curves | None:
    """Compute the curves of a loop; None if it is not stable.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> found = curves_of(closed_loop(plant, local_controllers(plant, [[[-3]]])))
    >>> round(max(found.sensitivity), 3), found.growth[0], found.growth[-1] < 0.01
    (1.5, 1.0, True)
    >>> curves_of(closed_loop(plant, local_controllers(plant, [[[0]]])))
    """
    M, discrete = matrix_to_float(loop.matrix), is_discrete(loop.given.time)
    with quiet_floats():
        form = SchurForm.of(M, discrete=discrete)
        if form is None or not form.bound < (1.0 if discrete else 0.0):
            return None
        response = input_response(loop)
        points = boundary_points(response, discrete=discrete)
        places = np.abs(np.angle(points)) if discrete else points.imag
        order = np.argsort(places)
        times, growth = _growth(M, loop.given.n, form)
        return Curves(
            discrete,
            places[order].tolist(),
            response.sizes(points[order]).tolist(),
            times.tolist(),
            growth.tolist(),
        )


def _growth(M: Floats, n: int, form: SchurForm) -> tuple[Floats, Floats]:
    """The norms of the block of the plant's state, over some time constants of the slowest mode."""
    if form.discrete:
        constants = _CONSTANTS / max(-np.log(max(form.bound, 1e-3)), 1e-3)
        count = int(min(max(constants, 10), _STEPS))
        step, times = M, np.arange(count + 1, dtype=np.float64)
    else:
        times = np.linspace(0.0, _CONSTANTS / -form.bound, _POINTS)
        step = np.asarray(expm(M * times[1]), dtype=np.float64)
    power, norms = np.eye(len(M)), []
    for _ in times:
        norms.append(norm(power[:n, :n]))
        power = step @ power
    return times, np.array(norms)
