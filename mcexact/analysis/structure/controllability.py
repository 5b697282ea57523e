"""Controllability and observability of all channels together, or of some."""

from __future__ import annotations

from collections.abc import Iterable

from mcexact.answer.controllability import JointControllability
from mcexact.derived.dual import dual
from mcexact.derived.modular_system import generator
from mcexact.exact.invariant_subspace import controllable_subspace
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.model.system import MultiChannelSystem


def joint_controllability(
    system: MultiChannelSystem, channels: Iterable[str] | None = None
) -> JointControllability:
    """Decide whether (A, B_T) is controllable.

    Parameters
    ----------
    system : MultiChannelSystem
    channels : iterable of str, optional
        T, names of channels, by default all.

    Notes
    -----
    Exact.  The certificate has a prime modulo which [B_T, AB_T, …] reaches the rank, and a rational
    W, WA = ZW and WB_T = 0, that bounds it from above.  O(n³ log n) word operations, for each word
    of the entries of W.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 1]]] * 2)
    >>> joint_controllability(system).controllable
    True
    >>> alone = joint_controllability(system, ["1"])
    >>> alone.controllable, str(alone.uncontrollable_polynomial)
    (False, 'x - 2')
    """
    T = range(system.m) if channels is None else system.indices(channels)
    found = controllable_subspace(
        system.A, system.input_matrix(T), generator(system, "controllability")
    )
    W = found.annihilator()
    return JointControllability(
        system,
        channels=system.named(T),
        dimension=found.dimension,
        controllable=found.dimension == system.n,
        uncontrollable_polynomial=characteristic_polynomial((W @ system.A).take(cols=found.free)),
        modulus=found.modulus,
        annihilator=W,
        pivots=found.free,
    )


def joint_observability(
    system: MultiChannelSystem, channels: Iterable[str] | None = None
) -> JointControllability:
    """Decide whether (C_T, A) is observable, by controllability of the dual system.

    Parameters
    ----------
    system : MultiChannelSystem
    channels : iterable of str, optional
        T, names of channels, by default all.

    Returns
    -------
    JointControllability
        The answer about ``dual(system)``: ``observable`` says whether (C_T, A) is, ``dimension`` is
        the rank of [C_T; C_T A; …], and ``uncontrollable_polynomial`` has the unobservable modes.
    """
    return joint_controllability(dual(system), channels)
