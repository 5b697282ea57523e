"""Set-points and controllability indices for all values of one parameter or several."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from mcexact.analysis.engine import parametric_rank, rank_for_all_values, rank_hypersurfaces
from mcexact.answer.exceptional_hypersurfaces import RankHypersurfaces
from mcexact.answer.parametric_rank import (
    ControllabilityMatrix,
    ParametricRank,
    SetpointMatrix,
    SignalMatrix,
)
from mcexact.derived.constructions import dual, moved
from mcexact.errors import InputError
from mcexact.exact.polynomial import Polynomial
from mcexact.model.parametric import ParametricSystem

R = TypeVar("R", ParametricRank, RankHypersurfaces)


def parametric_setpoints(system: ParametricSystem) -> ParametricRank:
    """The rank of [A, B; C, 0], or [A − I, B; C, 0], for all values of a parameter.

    Examples
    --------
    >>> plant = ParametricSystem([[-1]], [[["1 - t"]]], [[[1]]], parameters=["t"])
    >>> found = parametric_setpoints(plant)
    >>> found.words
    ('rank 2 for almost every t', 'rank 1 where t = 1')
    """
    return parametric_rank(system, SetpointMatrix())


def setpoint_rank(system: ParametricSystem) -> ParametricRank | RankHypersurfaces:
    """The same for one parameter or several."""
    return rank_for_all_values(system, SetpointMatrix())


def signal_solvability(
    system: ParametricSystem, signal: Polynomial
) -> ParametricRank | RankHypersurfaces:
    """Decide for which values of parameters all outputs can track the signals of a polynomial.

    Parameters
    ----------
    system : ParametricSystem
    signal : Polynomial
        Its roots are the modes of the signals: s for steps and ramps, s² + ω² for sinusoids of the
        angular frequency ω, in discrete time z − 1 for steps.  Multiplicities do not matter.

    Returns
    -------
    ParametricRank or RankHypersurfaces
        The rank of [I⊗A − K⊗I, I⊗B; I⊗C, 0], K the companion matrix of the polynomial, of degree d:
        where it is d (n + Σ q_i), and nowhere else, [A − λI, B; C, 0] has independent rows at every
        root λ, so that every reference and every disturbance of these signals has a steady state.

    Notes
    -----
    Exact.  With one parameter the certificate is about all values; with several there is one along
    each line.

    Examples
    --------
    >>> A = [[0, 1, 0], [0, 0, 1], [-1, -3, -3]]
    >>> plant = ParametricSystem(A, [[[0], [0], [1]]], [[["t", 0, 1]]], parameters=["t"])
    >>> signal_solvability(plant, Polynomial.of(4, 0, 1)).words
    ('rank 8 for almost every t', 'rank 6 where t = 4')
    >>> signal_solvability(plant, Polynomial.of(0, 1)).words
    ('rank 4 for almost every t', 'rank 3 where t = 0')
    """
    InputError.require(system, ParametricSystem, "system")
    InputError.require(signal, Polynomial, "signal")
    if signal.degree < 1:
        raise InputError(f"expected a polynomial with roots, found {signal}", where="signal")
    return rank_for_all_values(system, SignalMatrix(signal.monic()))


def parametric_indices(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, observed: bool = False
) -> tuple[ParametricRank, ...]:
    """The ranks of [B_T, A B_T, …, A^(k−1) B_T] for k = 1, 2, …, until none grows at any value.

    Parameters
    ----------
    system : ParametricSystem
    channels : iterable of str, optional
        T, by default all.
    observed : bool
        Whether they are those of the dual system.

    Returns
    -------
    tuple of ParametricRank
        One for each k; the last two say the same unless the last k is n, so that no rank grows
        further at any value.
    """
    about = moved(system, dual) if observed else system
    return _growing(about, channels, lambda matrix: parametric_rank(about, matrix))


def indices_for_all_values(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, observed: bool = False
) -> tuple[ParametricRank | RankHypersurfaces, ...]:
    """The same for one parameter or several."""
    if len(system.parameters) == 1:
        return parametric_indices(system, channels, observed=observed)
    return _growing(
        system, channels, lambda matrix: rank_hypersurfaces(system, matrix, observed=observed)
    )


def _growing(
    system: ParametricSystem,
    channels: Iterable[str] | None,
    decide: Callable[[ControllabilityMatrix], R],
) -> tuple[R, ...]:
    """The answers for more and more blocks, until two say the same."""
    chosen = system.names if channels is None else system.named(system.indices(channels))
    found: list[R] = []
    for k in range(1, max(system.n, 1) + 1):
        found.append(decide(ControllabilityMatrix(chosen, k)))
        if k > 1 and found[-1].said == found[-2].said:
            break
    return tuple(found)
