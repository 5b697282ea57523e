"""The least dimensions that agents must share for every value of a parameter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from mcexact.analysis.engine.parametric_modes import parametric_fixed_spectrum
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.derived.constructions import Share, extended_system
from mcexact.errors import LimitReached
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem

_MOST = 10_000
"""The most dimensions that are tried with one sum."""


@dataclass(frozen=True)
class ParametricSharing:
    """The least dimensions of shared sub-states with which no mode is fixed for any value.

    Attributes
    ----------
    dimensions : tuple of int or None
        n_1 … n_m with the least sum, the lexicographically least of these; None if none suffice.
    spectrum : ParametricFixedSpectrum
        The answer about the extended system with these dimensions, or if none suffice with n for
        each agent.
    refused : tuple of ParametricFixedSpectrum
        The answers for all dimensions whose sum is one less, with each of which a mode is fixed for
        almost every value or at some; fewer dimensions leave no less.
    """

    dimensions: tuple[int, ...] | None
    spectrum: ParametricFixedSpectrum
    refused: tuple[ParametricFixedSpectrum, ...]

    @property
    def certificates(self) -> tuple[ParametricFixedSpectrum, ...]:
        """The answers that prove it."""
        return self.spectrum, *self.refused


def shared_dimensions_for_every_value(
    system: ParametricSystem, graph: NeighborGraph, share: Share = "outputs+states"
) -> ParametricSharing:
    """Compute the least dimensions that suffice for every complex value of a parameter.

    Parameters
    ----------
    system : ParametricSystem
        With one parameter.
    graph : NeighborGraph
        Who receives whose messages, without delay.
    share : {"outputs+states", "states"}

    Raises
    ------
    LimitReached
        If too many dimensions would have to be tried.

    Notes
    -----
    Exact.  All dimensions are tried, sum after sum, and one sum is excluded by what is fixed with
    each; of these the last are kept.  A range that is assumed counts: values beyond it do not.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [[1, 0, 0], ["t", 1, 0], [0, 1, 1]],
    ...     [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
    ...     [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
    ...     parameters=["t"],
    ... )
    >>> found = shared_dimensions_for_every_value(plant, NeighborGraph.ring(plant.names))
    >>> found.dimensions, len(found.refused)
    ((0, 0, 1), 1)
    >>> alone = shared_dimensions_for_every_value(plant, NeighborGraph.empty(plant.names))
    >>> alone.dimensions, [str(each.value) for each in alone.spectrum.exceptional]
    (None, ['x'])
    """

    def asked(sizes: tuple[int, ...]) -> ParametricFixedSpectrum:
        return parametric_fixed_spectrum(extended_system(system, sizes, share, graph))

    enough = asked((system.n,) * system.m)
    if _fixes(enough):
        return ParametricSharing(None, enough, ())
    refused: list[ParametricFixedSpectrum] = []
    for total in range(system.n * system.m):
        tried: list[ParametricFixedSpectrum] = []
        for sizes in _with_sum(total, system.m):
            if len(tried) >= _MOST:
                raise LimitReached(f"more than {_MOST} dimensions have the sum {total}")
            tried.append(asked(sizes))
            if not _fixes(tried[-1]):
                return ParametricSharing(sizes, tried[-1], tuple(refused))
        refused = tried
    return ParametricSharing((system.n,) * system.m, enough, tuple(refused))


def _fixes(found: ParametricFixedSpectrum) -> bool:
    """Whether a mode is fixed for almost every value, or at some."""
    return bool(found.generic or found.exceptional)


def _with_sum(total: int, m: int) -> Iterator[tuple[int, ...]]:
    """All dimensions of m agents with this sum, in lexicographic order."""
    if m == 1:
        yield (total,)
        return
    for first in range(total + 1):
        for rest in _with_sum(total - first, m - 1):
            yield (first, *rest)
