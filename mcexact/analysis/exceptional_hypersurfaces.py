"""What holds for almost all values of several parameters, and on which hypersurfaces more."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, Literal, overload

from mcexact.analysis.engine import (
    ParametricCompleteness,
    ParametricTransferGraph,
    controllability_hypersurfaces,
    mode_hypersurfaces,
    parametric_completeness,
    parametric_transfer_graph,
)
from mcexact.analysis.structure.parametric_ranks import indices_for_all_values, setpoint_rank
from mcexact.answer.exceptional_hypersurfaces import ExceptionalHypersurfaces, RankHypersurfaces
from mcexact.errors import InputError, UsageError, one_of
from mcexact.model.parametric import ParametricSystem

Modes = Literal[
    "fixed_spectrum",
    "joint_controllability",
    "joint_observability",
    "channel_controllability",
    "channel_observability",
]
Indices = Literal["controllability_indices", "observability_indices"]

_DECIDED: dict[str, Callable[..., Any]] = {
    "fixed_spectrum": mode_hypersurfaces,
    "joint_controllability": controllability_hypersurfaces,
    "joint_observability": partial(controllability_hypersurfaces, observed=True),
    "channel_controllability": controllability_hypersurfaces,
    "channel_observability": partial(controllability_hypersurfaces, observed=True),
    "controllability_indices": indices_for_all_values,
    "observability_indices": partial(indices_for_all_values, observed=True),
    "transfer_graph": parametric_transfer_graph,
    "completeness": parametric_completeness,
    "setpoint": setpoint_rank,
}
_OF_SOME = frozenset(name for name in _DECIDED if "ability" in name)


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem,
    question: Modes = "fixed_spectrum",
    *,
    channels: Iterable[str] | None = None,
) -> ExceptionalHypersurfaces: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Literal["setpoint"]
) -> RankHypersurfaces: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Indices, *, channels: Iterable[str] | None = None
) -> tuple[RankHypersurfaces, ...]: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Literal["transfer_graph"]
) -> ParametricTransferGraph: ...


@overload
def exceptional_hypersurfaces(
    system: ParametricSystem, question: Literal["completeness"]
) -> ParametricCompleteness: ...


def exceptional_hypersurfaces(
    system: ParametricSystem,
    question: str = "fixed_spectrum",
    *,
    channels: Iterable[str] | None = None,
) -> Any:
    """Decide a question for almost all values of several parameters, and where its answer differs.

    Parameters
    ----------
    system : ParametricSystem
    question : str
        By default which modes are fixed.  "joint_controllability" and "joint_observability" are
        about modes, too; "setpoint" is about the rank of [A, B; C, 0], and
        "controllability_indices" and "observability_indices" about those of the first k blocks
        [B, A B, …]; "transfer_graph" and "completeness" have the results of one parameter.
    channels : iterable of str, optional
        For controllability, observability and indices the channels in question, by default all.

    Raises
    ------
    LimitReached
        If a degree exceeds a limit.
    UsageError
        If the question is not one of these, or not about some channels.

    Notes
    -----
    Exact.  The irreducible factors that resultants for several drawn gains have in common, or those
    of one minor of full order, are the candidates; of these, the ones are kept at whose points the
    answer differs on drawn lines.  There everything is decided for every value and proved by a
    certificate.  Resultants and minors are polynomials in all parameters, which limits this to some
    ten states.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [[0, "a"], [0, 1]], [[[0], [1]]], [[["b - a", 1]]], parameters=["a", "b"]
    ... )
    >>> found = exceptional_hypersurfaces(plant)
    >>> [str(each) for each in found.hypersurfaces]
    ['a = 0', 'a - b = 0', 'a^2 - a*b - 1 = 0']
    >>> [str(each) for each in exceptional_hypersurfaces(plant, "setpoint").hypersurfaces]
    ['a = 0', 'a - b = 0']
    """
    InputError.require(system, ParametricSystem, "system")
    one_of(question, tuple(_DECIDED), "question")
    if channels is None:
        return _DECIDED[question](system)
    if question not in _OF_SOME:
        raise UsageError(f"{question} is about all channels: leave out channels")
    return _DECIDED[question](system, channels)
