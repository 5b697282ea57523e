"""Whether every plant in a box can hold its outputs at set-points by decentralized control."""

from __future__ import annotations

from mcexact.analysis.boxes.box_fixed import box_stabilizability
from mcexact.answer.box_fixed import BoxFixedModes
from mcexact.answer.setpoint import SetpointSolvability
from mcexact.derived.constructions import setpoint_system
from mcexact.errors import InputError, LimitReached
from mcexact.model.system import MultiChannelSystem


def box_setpoints(
    system: MultiChannelSystem, *, solvability: SetpointSolvability | None = None
) -> BoxFixedModes:
    """Prove that each plant in a box holds set-points by a decentralized controller of its own.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with radii, such as ``Box.relative(plant, "1/1000").system``.
    solvability : SetpointSolvability, optional
        Whether set-points of the nominal plant have equilibria, if it is known: where some have
        none no proof is searched.

    Returns
    -------
    BoxFixedModes
        About the plant with an integrator of every output: no member has a fixed mode in the
        closed right half-plane, or of modulus 1 or more.

    Raises
    ------
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    A decentralized linear time-invariant controller that stabilizes the plant with its integrators
    holds every output at its set-point: at rest each integrator has a constant value, so that what
    it integrates is 0.  One controller for all members is a matter of `box_stability`.

    Examples
    --------
    >>> from mcexact import Box
    >>> ports = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    >>> plant = MultiChannelSystem([[1, 0], [1, -2]], *ports)
    >>> proof = box_setpoints(Box.relative(plant, "1/20").system)
    >>> print(proof.explain())
    within the radii: for every plant some decentralized linear time-invariant controller of its \
own holds all outputs at any constant set-points
    >>> twice = MultiChannelSystem([[-1]], [[[1]]], [[[1], [2]]])
    >>> box_setpoints(Box.relative(twice, "1/20").system)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that no plant in the box has a fixed mode \
outside of the region
    """
    InputError.require(system, MultiChannelSystem, "system")
    known = SetpointSolvability.known(solvability, system, "solvability")
    if known is not None and not known.solvable:
        raise LimitReached("some set-points of the plant itself have no equilibrium")
    return box_stabilizability(setpoint_system(system))
