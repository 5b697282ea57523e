"""The plant with an integrator of every output, for set-point control."""

from __future__ import annotations

from itertools import accumulate

from mcexact.derived.extended import selector
from mcexact.errors import InputError
from mcexact.exact.blocks import block, vstack
from mcexact.exact.location import steady_point
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem


def setpoint_system(system: MultiChannelSystem) -> MultiChannelSystem:
    """Append w with ẇ_i = y_i − r_i, in discrete time w_i(t+1) = w_i + y_i − r_i.

    Parameters
    ----------
    system : MultiChannelSystem

    Returns
    -------
    MultiChannelSystem
        n + Σ q_i states.  Agent i measures w_i.  A linear time-invariant controller that
        stabilizes it holds every y_i at r_i.

    Notes
    -----
    Paper, section III, equation `b1`.  In block form, C all C_i below each other::

            ⎡ A  0 ⎤            ⎡ B_i ⎤
        Ã = ⎣ C  W ⎦ ,    B̃_i = ⎣  0  ⎦ ,    C̃_i = [ 0  e_i' ]

    W = 0 in continuous and W = I in discrete time, and e_i' are the rows of the identity that
    belong to y_i. The references enter as −r in the lower rows.

    Examples
    --------
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[3]]], time="discrete")
    >>> setpoint_system(plant).A.numerators
    ((2, 0), (3, 1))
    """
    InputError.require(system, MultiChannelSystem, "system")
    n, m = system.n, system.m
    counts = [system.q(i) for i in range(m)]
    total = sum(counts)
    starts = [0, *accumulate(counts)]
    W = Matrix.identity(total) * steady_point(system.time)
    return system.derived(
        block([[system.A, Matrix.zeros(n, total)], [system.output_matrix(), W]]),
        [vstack([system.B(i), Matrix.zeros(total, system.p(i))]) for i in range(m)],
        [selector(n + starts[i], counts[i], n + total).T for i in range(m)],
        {"construction": "integrators"},
        neighbors=system.neighbors,
    )
