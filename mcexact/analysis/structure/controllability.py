"""Controllability and observability of all channels together, or of some."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import overload

from mcexact.analysis.engine import (
    annihilator,
    free_blocks,
    measured_blocks,
    measured_system,
    modes_left,
    parametric_controllability,
    transposed_blocks,
)
from mcexact.answer.controllability import ByBlocks, ByRank, JointControllability
from mcexact.answer.evidence import Block
from mcexact.answer.fixed_spectrum import ByBlocks as FixedByBlocks
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.derived.constructions import dual
from mcexact.derived.modular import generator
from mcexact.errors import InputError
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

# Up to this size a rank modulo a prime is the shorter evidence, and quick to check.
_SMALL = 128


@overload
def joint_controllability(
    system: MultiChannelSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability: ...


@overload
def joint_controllability(
    system: ParametricSystem, channels: Iterable[str] | None = None
) -> ParametricFixedSpectrum: ...


def joint_controllability(
    system: MultiChannelSystem | ParametricSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability | ParametricFixedSpectrum:
    """Decide whether (A, B_T) is controllable.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant with one parameter is decided for all values: the answer has the modes that T does
        not control, and the values at which they are more (`ParametricFixedSpectrum`).
    channels : iterable of str, optional
        T, names of channels, by default all.
    spectrum : FixedSpectrum, optional
        ``fixed_spectrum(system)`` of a plant without parameters, if it is known already.

    Notes
    -----
    Exact.  The certificate has a rational W, WA = ZW and WB_T = 0, that bounds the dimension from
    above.  From below it has a prime modulo which [B_T, AB_T, …] reaches the rank; or, for large
    systems, blocks of states that feedback of T moves.  These are those of the fixed spectrum if no
    mode is fixed, else they are of channels that measure states.  O(n³ log n) word operations, for
    each word of the entries of W; O(n³) with blocks.

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
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        return parametric_controllability(system, channels)
    InputError.require(system, MultiChannelSystem, "system")
    return _decided(system, channels, lambda: _own(system, spectrum))


def _decided(
    system: MultiChannelSystem,
    channels: Iterable[str] | None,
    own: Callable[[], tuple[Block, ...]],
) -> JointControllability:
    """Decide it with the blocks that all channels have with their own outputs, if they serve."""
    T = range(system.m) if channels is None else system.indices(channels)
    if system.n <= _SMALL:
        return _by_rank(system, T)
    if len(T) == system.m:
        blocks = own()
        if not modes_left(blocks):
            return _all_reached(system, T, ByBlocks(blocks, None, Matrix.zeros(0, system.n), ()))
    measuring = _by_measuring(system, T)
    return _by_rank(system, T) if measuring is None else measuring


def _by_measuring(system: MultiChannelSystem, T: Sequence[int]) -> JointControllability | None:
    """Decide it by blocks of T that measures states; None if their sequences are too short."""
    if not T:
        return None
    part, measured = measured_system(system, T)
    blocks = measured_blocks(part)
    left = modes_left(blocks)
    if not left:
        evidence = ByBlocks(blocks, measured, Matrix.zeros(0, system.n), ())
        return _all_reached(system, T, evidence)
    found = annihilator(part, left) if system.A.is_sparse else _annihilator(system, T)
    if found is None or len(found[1]) < left:
        return None
    W, pivots = found
    return JointControllability(
        system,
        channels=system.named(T),
        dimension=system.n - left,
        controllable=False,
        uncontrollable_polynomial=characteristic_polynomial((W @ system.A).take(cols=pivots)),
        evidence=ByBlocks(blocks, measured, W, pivots),
    )


def _annihilator(system: MultiChannelSystem, T: Sequence[int]) -> tuple[Matrix, tuple[int, ...]]:
    found = controllable_subspace(
        system.A, system.input_matrix(T), generator(system, "controllability")
    )
    return found.annihilator(), found.free


def _own(system: MultiChannelSystem, spectrum: FixedSpectrum | None) -> tuple[Block, ...]:
    """Blocks that leave no mode, if they are found; those of the fixed spectrum if it is known."""
    blocks = free_blocks(system) if spectrum is None else None
    if spectrum is not None and isinstance(spectrum.evidence, FixedByBlocks):
        blocks = spectrum.evidence.blocks
    return blocks or (Block(tuple(range(system.n)), None),)


def _all_reached(
    system: MultiChannelSystem, T: Sequence[int], evidence: ByBlocks
) -> JointControllability:
    return JointControllability(
        system,
        channels=system.named(T),
        dimension=system.n,
        controllable=True,
        uncontrollable_polynomial=Polynomial.from_coefficients([1]),
        evidence=evidence,
    )


def _by_rank(system: MultiChannelSystem, T: Sequence[int]) -> JointControllability:
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
        evidence=ByRank(found.modulus, W, found.free),
    )


@overload
def joint_observability(
    system: MultiChannelSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability: ...


@overload
def joint_observability(
    system: ParametricSystem, channels: Iterable[str] | None = None
) -> ParametricFixedSpectrum: ...


def joint_observability(
    system: MultiChannelSystem | ParametricSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability | ParametricFixedSpectrum:
    """Decide whether (C_T, A) is observable, by controllability of the dual system.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant with one parameter is decided for all values, as by `joint_controllability`.
    channels : iterable of str, optional
        T, names of channels, by default all.
    spectrum : FixedSpectrum, optional
        ``fixed_spectrum(system)`` of a plant without parameters, if it is known already.

    Returns
    -------
    JointControllability or ParametricFixedSpectrum
        The answer about ``dual(system)``: ``observable`` says whether (C_T, A) is, ``dimension`` is
        the rank of [C_T; C_T A; …], and ``uncontrollable_polynomial`` has the unobservable modes.
    """
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        return parametric_controllability(system, channels, observed=True)
    InputError.require(system, MultiChannelSystem, "system")
    return _decided(dual(system), channels, lambda: transposed_blocks(_own(system, spectrum)))
