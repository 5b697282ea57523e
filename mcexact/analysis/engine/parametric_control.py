"""For which values of a parameter channels control or observe every mode."""

from __future__ import annotations

from collections.abc import Iterable

from mcexact.analysis.engine.parametric_modes import parametric_fixed_spectrum
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.derived.constructions import dual, full_output, merged, moved, restricted
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem


def parametric_controllability(
    system: ParametricSystem, channels: Iterable[str] | None = None, observed: bool = False
) -> ParametricFixedSpectrum:
    """Decide for which values of a parameter (A, B_T) is controllable.

    Parameters
    ----------
    system : ParametricSystem
    channels : iterable of str, optional
        T, names of channels, at least one; by default all.
    observed : bool
        Whether to ask for observability of (C_T, A), which is controllability of the dual system.

    Returns
    -------
    ParametricFixedSpectrum
        The answer about the system of one channel with the inputs of T that measures the whole
        state: what is fixed there is what T does not control.

    Examples
    --------
    >>> plant = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])
    >>> print(*parametric_controllability(plant).words)
    the roots of x - 1 where t = 0
    """
    chosen = system.names if channels is None else system.named(system.indices(channels))

    def alone(plain: MultiChannelSystem) -> MultiChannelSystem:
        made = dual(plain) if observed else plain
        if set(chosen) != set(made.names):
            made = restricted(made, chosen)
        if made.m > 1:
            made = merged(made, [made.names])
        return full_output(made, 0)

    return parametric_fixed_spectrum(moved(system, alone))
