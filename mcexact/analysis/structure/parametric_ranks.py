"""Set-points and controllability indices for all values of a parameter."""

from __future__ import annotations

from collections.abc import Iterable

from mcexact.analysis.engine import parametric_rank
from mcexact.answer.parametric_rank import ControllabilityMatrix, ParametricRank, SetpointMatrix
from mcexact.model.parametric import ParametricSystem


def parametric_setpoints(system: ParametricSystem) -> ParametricRank:
    """The rank of [A, B; C, 0], or [A − I, B; C, 0], for all values of a parameter.

    Examples
    --------
    >>> plant = ParametricSystem([[-1]], [[["1 - t"]]], [[[1]]], parameters=["t"])
    >>> found = parametric_setpoints(plant)
    >>> found.words
    ('rank 2 for almost every t', 'rank 1 where t - 1 = 0')
    """
    return parametric_rank(system, SetpointMatrix())


def parametric_indices(
    system: ParametricSystem, channels: Iterable[str] | None = None
) -> tuple[ParametricRank, ...]:
    """The ranks of [B_T, A B_T, …, A^(k−1) B_T] for k = 1, 2, …, until none grows at any value.

    Returns
    -------
    tuple of ParametricRank
        One for each k; the last two say the same unless the last k is n, so that no rank grows
        further at any value.
    """
    chosen = system.names if channels is None else system.named(system.indices(channels))
    found: list[ParametricRank] = []
    for k in range(1, max(system.n, 1) + 1):
        found.append(parametric_rank(system, ControllabilityMatrix(chosen, k)))
        if k > 1 and _said(found[-1]) == _said(found[-2]):
            break
    return tuple(found)


def _said(found: ParametricRank) -> tuple[object, ...]:
    return found.rank, {(each.value, each.rank) for each in found.exceptional}, found.outside
