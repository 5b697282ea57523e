"""Proposition 1: gains with which each agent alone controls and observes the estimation errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.fixed_modes.gains import error_gain_draws
from mcexact.analysis.fixed_modes.single_channel_gains import single_channel_gains
from mcexact.answer.single_channel_gains import SingleChannelGains
from mcexact.derived.constructions import checked_gains, error_system
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph


@dataclass(frozen=True)
class ErrorGains:
    """The answer whether some K_i, H_ij make every agent control and observe the error system.

    Attributes
    ----------
    found : SingleChannelGains
        The answer for the error system, whose matrix the gains make cyclic.
    """

    found: SingleChannelGains

    @property
    def exists(self) -> bool:
        """Whether such gains exist."""
        return self.found.exists

    @property
    def error(self) -> MultiChannelSystem:
        """The open-loop error system, nm states."""
        return self.found.about

    @property
    def indices(self) -> tuple[tuple[int, ...], ...] | None:
        """The controllability and observability indices for each agent."""
        return self.found.indices

    @property
    def gains(self) -> tuple[tuple[Matrix, ...], ...] | None:
        """The gains of each agent i: K_i, n × q_i, then H_ij, n × n, for j ∈ N_i∖{i}, in order."""
        plant, found = self.error.plant, self.found.gains
        if found is None:
            return None
        return tuple(_split(gain, plant.q(i), plant.n) for i, gain in enumerate(found))


def error_gains(
    system: MultiChannelSystem,
    feedback: Sequence[Any],
    graph: NeighborGraph | Mapping[str, Sequence[str]] | None = None,
) -> ErrorGains:
    """Decide for given F_i whether the gains K_i, H_ij of Proposition 1 exist.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant, m channels, n states.
    feedback : sequence of m matrices
        F_i, p_i × n.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If a gain has the wrong shape.

    Notes
    -----
    Paper, Proposition 1: for a jointly observable plant and a strongly connected graph they exist,
    with controllability index m.  Strong connectivity is sufficient, not necessary: the terms B_j
    F_j (e_i − e_j) couple the agents through the plant, so the question is decided on the error
    system itself, and the answer no has an obstruction.  Exact.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> alone = MultiChannelSystem([[0]], [[[1]]] * 2, [[[1]]] * 2, neighbors={"1": [], "2": []})
    >>> error_gains(alone, [[[-1]], [[-1]]]).indices
    ((2, 2), (2, 2))
    >>> error_gains(alone, [[[0]], [[0]]]).exists
    False
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    exact = checked_gains(system, feedback, [system.n] * system.m)
    error = error_system(system, exact)
    draw = error_gain_draws(system, graph, exact, Fraction(0))
    found = single_channel_gains(error, cyclic=True, index=system.m, draw=draw)
    return ErrorGains(found)


def _split(gain: Matrix, q: int, n: int) -> tuple[Matrix, ...]:
    """K_i and the H_ij, side by side in one gain."""
    starts = range(q, gain.ncols, n) if n else range(0)
    blocks = [gain.take(cols=range(start, start + n)) for start in starts]
    return (gain.take(cols=range(q)), *blocks)
