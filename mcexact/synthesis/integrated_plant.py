"""The plant with integrators of its outputs, as a search for set-point controllers sees it."""

from __future__ import annotations

from mcexact.derived.integrators import setpoint_system
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem


def integrated_plant(system: MultiChannelSystem) -> MultiChannelSystem:
    """Return the plant with its integrators, of which agent i measures w_i, and y_i, too.

    Parameters
    ----------
    system : MultiChannelSystem
        n states and the outputs y_i = C_i x.

    Returns
    -------
    MultiChannelSystem
        A plant with the matrices of `setpoint_system`, except for its outputs::

                ⎡  0   e_i' ⎤
            C̃_i = ⎣ C_i   0  ⎦

    Notes
    -----
    With w_i alone an agent has to differentiate to act on y_i in proportion.  No other modes are
    fixed: the rows of the integrators in the pencils of complementary subsystems are C_i, beside
    −λ w_i.

    Examples
    --------
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[3]]])
    >>> integrated_plant(plant).C(0).numerators
    ((0, 1), (3, 0))
    """
    whole = setpoint_system(system)
    none = [Matrix.zeros(system.q(i), whole.n - system.n) for i in range(system.m)]
    return MultiChannelSystem(
        whole.A,
        [whole.B(i) for i in range(system.m)],
        [vstack([whole.C(i), hstack([system.C(i), none[i]])]) for i in range(system.m)],
        time=system.time,
        names=list(system.names),
        neighbors=system.neighbors,
    )
