"""Drawn systems that are jointly controllable or not, with fixed modes or without."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mcexact.derived.drawn.choices import Choices, shuffled
from mcexact.derived.drawn.parts import (
    as_polynomial,
    draw_chains,
    draw_ports,
    finished,
    irreducible,
    live,
)
from mcexact.derived.drawn.primary_form import Chain, Coefficients, lay_out
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class Drawn:
    """A drawn system with its properties by construction; None means that a property is unknown.

    Attributes
    ----------
    system : MultiChannelSystem
    jointly_controllable, jointly_observable : bool or None
    fixed_modes : bool or None
        Whether there are fixed modes at all.
    fixed_mode : Polynomial or None
        A monic irreducible polynomial whose roots are fixed modes (there may be others).
    multiplicity : int or None
        A number of times that it divides the characteristic polynomial of every closed loop.
    subset : tuple of int or None
        A subset s with rank P_s < n at the roots of ``fixed_mode``.
    indices : tuple of int or None
        The controllability (Brunovsky) indices of (A, [B_1 … B_m]), largest first.
    remnant : Polynomial or None
        The remnant polynomial of the complementary subsystem of ``subset``.
    complete : bool or None
    deficiency : int or None
        The bound of Theorem 2 on shared dimensions (or of Remark 2) over the neighbor graph.
    """

    system: MultiChannelSystem
    jointly_controllable: bool | None = None
    jointly_observable: bool | None = None
    fixed_modes: bool | None = None
    fixed_mode: Polynomial | None = None
    multiplicity: int | None = None
    subset: tuple[int, ...] | None = None
    indices: tuple[int, ...] | None = None
    remnant: Polynomial | None = None
    complete: bool | None = None
    deficiency: int | None = None


def jointly_controllable_system(
    choices: Choices,
    states: int,
    channels: int,
    *,
    time: str = "continuous",
    inactive_channels: bool = False,
    denominators: bool = False,
) -> Drawn:
    """Draw a jointly controllable and jointly observable system, by construction.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        n ≥ 0 and m ≥ 1.
    time : {"continuous", "discrete"}
    inactive_channels : bool
        Whether some channels may have B_i = 0 or C_i = 0.
    denominators : bool
        Whether entries may be fractions.

    Returns
    -------
    Drawn
        Eigenvalues repeat, Jordan chains are long, and entries are sparse before the change of
        basis, so that fixed modes are frequent.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> drawn = jointly_controllable_system(SeededChoices(1), states=4, channels=2)
    >>> drawn.system.n, drawn.jointly_controllable
    (4, True)
    """
    _require_sizes(states, channels)
    inputs, outputs = draw_ports(choices, channels, inactive_channels=inactive_channels)
    limit = min(live(inputs, range(channels)), live(outputs, range(channels)))
    chains = draw_chains(choices, states, limit)
    draft = lay_out(choices, chains, inputs, outputs)
    system = finished(choices, draft, inputs.owners, outputs.owners, channels, time, denominators)
    return Drawn(system, jointly_controllable=True, jointly_observable=True)


def system_with_fixed_mode(
    choices: Choices,
    states: int,
    channels: int,
    degree: int = 1,
    *,
    time: str = "continuous",
    denominators: bool = False,
) -> Drawn:
    """Draw a jointly controllable and observable system with a fixed mode that is hard to see.

    Parameters
    ----------
    choices : Choices
    states : int
        n, at least the degree.
    channels : int
        m ≥ 2: one channel that controls and observes everything has no fixed mode.
    degree : int
        The degree of the irreducible polynomial of the fixed mode.
    time : {"continuous", "discrete"}
    denominators : bool

    Returns
    -------
    Drawn
        With ``fixed_mode``, ``multiplicity``, ``subset`` and ``complete=False``.

    Notes
    -----
    The system is made in the normal form of Anderson and Clements and then changed by unimodular
    steps: channels outside the subset act only on a part of the state that the channels in it do
    not measure.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> drawn = system_with_fixed_mode(SeededChoices(2), states=5, channels=3, degree=2)
    >>> drawn.fixed_mode.degree, drawn.complete
    (2, False)
    """
    _require_sizes(states, channels)
    if channels < 2:
        raise UsageError("a planted fixed mode needs at least 2 channels")
    if states < degree:
        raise UsageError(f"a fixed mode of degree {degree} needs at least {degree} states")
    order = shuffled(choices, range(channels))
    reach = frozenset(order[: choices.integer(1, channels - 1)])
    subset = frozenset(range(channels)) - reach
    inputs, outputs = draw_ports(choices, channels, reach=reach, subset=subset)
    planted = _planted(choices, irreducible(choices, degree), states // degree)
    limit = min(live(inputs, subset), live(outputs, reach))
    chains = draw_chains(choices, states, limit, [planted])
    draft = lay_out(choices, chains, inputs, outputs)
    return Drawn(
        finished(choices, draft, inputs.owners, outputs.owners, channels, time, denominators),
        jointly_controllable=True,
        jointly_observable=True,
        fixed_modes=True,
        fixed_mode=as_polynomial(planted.polynomial),
        multiplicity=planted.zones.count(2),
        subset=tuple(sorted(subset)),
        complete=False,
    )


def uncontrollable_system(
    choices: Choices,
    states: int,
    channels: int,
    *,
    observable_side: bool = False,
    time: str = "continuous",
) -> Drawn:
    """Draw a system with a mode that no channel controls, or that no channel observes.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        n ≥ 1 and m ≥ 1.
    observable_side : bool
        False: not jointly controllable; True: not jointly observable.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        The other of the two properties holds.  ``subset`` is empty if no channel controls the mode,
        and the set of all channels if no channel observes it.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> uncontrollable_system(SeededChoices(3), states=3, channels=2).jointly_controllable
    False
    """
    _require_sizes(states, channels)
    if not states:
        raise UsageError("a system without states is controllable and observable")
    inputs, outputs = draw_ports(choices, channels)
    limit = min(live(inputs, range(channels)), live(outputs, range(channels)))
    chains = draw_chains(choices, states, limit)
    k = choices.integer(0, len(chains) - 1)
    nobody: frozenset[int] = frozenset()
    lost = chains[k]
    if observable_side:
        chains[k] = replace(lost, seen_by=nobody)
    else:
        chains[k] = replace(lost, reached_by=nobody)
    draft = lay_out(choices, chains, inputs, outputs)
    return Drawn(
        finished(choices, draft, inputs.owners, outputs.owners, channels, time, False),
        jointly_controllable=observable_side,
        jointly_observable=not observable_side,
        fixed_modes=True,
        fixed_mode=as_polynomial(lost.polynomial),
        multiplicity=1,
        subset=tuple(range(channels)) if observable_side else (),
        complete=False,
    )


def sparse_system(
    choices: Choices, states: int, channels: int, *, time: str = "continuous"
) -> Drawn:
    """Draw a system with sparse small entries, about which nothing is known.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        n ≥ 0 and m ≥ 1.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        Many of them have fixed modes, inactive channels, or channels without inputs or outputs, or
        are not jointly controllable or observable.
    """
    _require_sizes(states, channels)
    palette = (0, 0, 0, 0, 1, -1, 2)

    def matrix(rows: int, columns: int) -> Matrix:
        entries = [[choices.option(palette) for _ in range(columns)] for _ in range(rows)]
        return Matrix.from_integers(entries, ncols=columns)

    widths = [
        (choices.option((1, 1, 1, 2, 0)), choices.option((1, 1, 1, 2, 0))) for _ in range(channels)
    ]
    return Drawn(
        MultiChannelSystem(
            matrix(states, states),
            [matrix(states, p) for p, _ in widths],
            [matrix(q, states) for _, q in widths],
            time=time,
        )
    )


def any_system(choices: Choices, states: int, channels: int, *, time: str = "continuous") -> Drawn:
    """Draw a system of any of the kinds in this module.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> any_system(SeededChoices(4), states=3, channels=2).system.m
    2
    """
    kind = choices.option(
        ("sparse", "minimal", "inactive", "fixed", "uncontrollable", "unobservable")
    )
    if kind == "minimal":
        return jointly_controllable_system(choices, states, channels, time=time)
    if kind == "inactive":
        return jointly_controllable_system(
            choices, states, channels, time=time, inactive_channels=True, denominators=True
        )
    if kind == "fixed" and channels > 1 and states:
        degree = choices.integer(1, min(3, states))
        return system_with_fixed_mode(choices, states, channels, degree, time=time)
    if kind in ("uncontrollable", "unobservable") and states:
        seen = kind == "unobservable"
        return uncontrollable_system(choices, states, channels, observable_side=seen, time=time)
    return sparse_system(choices, states, channels, time=time)


def _require_sizes(states: int, channels: int) -> None:
    if states < 0 or channels < 1:
        raise UsageError(f"expected at least 0 states and 1 channel, found {states} and {channels}")


def _planted(choices: Choices, polynomial: Coefficients, longest: int) -> Chain:
    """A chain with one or more blocks in zone 2, which may begin in zone 1 and end in zone 3."""
    middle = choices.integer(1, min(longest, 2))
    before = choices.integer(0, min(longest - middle, 2))
    after = choices.integer(0, min(longest - middle - before, 2))
    return Chain(polynomial, (1,) * before + (2,) * middle + (3,) * after)
