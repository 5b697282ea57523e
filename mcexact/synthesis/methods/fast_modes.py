"""Modes that are fast enough already, which designs for a rate do not move."""

from __future__ import annotations

from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.answer.rules.refusals import refusal
from mcexact.answer.wording import refusals as say
from mcexact.derived.modular_system import generator
from mcexact.errors import InternalError
from mcexact.exact.invariant_subspace import controllable_subspace
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.methods.spectrum import default_polynomial
from mcexact.synthesis.methods.state_feedback import (
    StateFeedback,
    assigning_feedback,
    given_feedback,
    split_by_channel,
)


def feedback_for_region(system: MultiChannelSystem, region: StabilityRegion) -> StateFeedback:
    """Find F with every eigenvalue of A + Σ B_i F_i in a region; uncontrollable modes in it stay.

    Parameters
    ----------
    system : MultiChannelSystem
    region : StabilityRegion
        A region with a rate or radius.

    Raises
    ------
    Impossible
        If an uncontrollable mode is outside the region; the certificate is that of the joint
        controllability.

    Notes
    -----
    Exact.  With X a basis of the controllable subspace, its rows ``pivots`` the identity,
    A X = X A_1, B = X B_1: F = F_1 L assigns A_1 + B_1 F_1, L the selection of these rows.

    Examples
    --------
    >>> system = MultiChannelSystem([[1, 0], [0, -9]], [[[1], [0]]], [[[1, 1]]])
    >>> str(feedback_for_region(system, StabilityRegion("continuous", 1)).polynomial)
    'x^2 + 11*x + 18'
    """
    if region.bound is None:
        raise InternalError("a design for a region needs its bound")
    decided = joint_controllability(system)
    B = system.input_matrix()
    if decided.controllable:
        polynomial = default_polynomial(region, system.n)
        gains = split_by_channel(system, assigning_feedback(system.A, B, polynomial))
        return given_feedback(system, gains)
    rest = decided.uncontrollable_polynomial
    if not region.contains_roots_of(rest):
        raise refusal("unreached", decided, told=say.NOT_CONTROLLABLE_IN, region=region)
    found = controllable_subspace(system.A, B, generator(system, "controllability"))
    pivots = list(found.pivots)
    A1 = (system.A @ found.X).take(rows=pivots)
    polynomial = default_polynomial(region, len(pivots))
    F1 = assigning_feedback(A1, B.take(rows=pivots), polynomial)
    selection = Matrix.identity(system.n).take(rows=pivots)
    return given_feedback(system, split_by_channel(system, F1 @ selection))


def observable_part(system: MultiChannelSystem) -> tuple[MultiChannelSystem, Matrix]:
    """The observable quotient of a plant, with respect to all channels together.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.

    Returns
    -------
    part : MultiChannelSystem
        (A_o, L B_i, C_{o,i}), jointly observable, with the same channels and graph.
    L : Matrix, d×n
        Of full row rank, with L A = A_o L and C_i = C_{o,i} L, so that L x is the state of the
        part.

    Examples
    --------
    >>> system = MultiChannelSystem([[1, 0], [0, -9]], [[[1], [1]]], [[[2, 0]]])
    >>> part, L = observable_part(system)
    >>> part.A.numerators, L.numerators
    (((1,),), ((1, 0),))
    """
    found = controllable_subspace(
        system.A.T, system.output_matrix().T, generator(system, "observability")
    )
    L, pivots = found.X.T, list(found.pivots)
    part = MultiChannelSystem(
        (L @ system.A).take(cols=pivots),
        [L @ channel.B for channel in system.channels],
        [channel.C.take(cols=pivots) for channel in system.channels],
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
        name=system.name,
    )
    return part, L
