"""The state in which a simulation starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, Rounding
from mcexact.model.controller import Controller
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.arithmetic import Native
from mcexact.simulation.network import Network
from mcexact.simulation.signals import numbers_of


@dataclass(frozen=True)
class InitialState:
    """The state in which a simulation starts.

    Attributes
    ----------
    plant : tuple of Fraction
        x(0).
    shared, private : tuple of tuples of Fraction
        x_i(0) and z_i(0) of each agent.
    """

    plant: tuple[Fraction, ...]
    shared: tuple[tuple[Fraction, ...], ...]
    private: tuple[tuple[Fraction, ...], ...]


def initial_state(
    initial: InitialState | Sequence[Any] | None,
    system: MultiChannelSystem,
    controller: Controller,
    rounding: Rounding | None,
) -> InitialState:
    """Return the initial state; by default x(0) = (1, …, 1), and all agents are at 0."""
    if isinstance(initial, InitialState):
        return initial
    zero, one = Fraction(0), Fraction(1)
    x = (one,) * system.n if initial is None else numbers_of(initial, rounding, "initial")
    if len(x) != system.n:
        raise InputError(f"expected {system.n} numbers, found {len(x)}", where="initial")
    return InitialState(
        x,
        tuple((zero,) * agent.shared for agent in controller.agents),
        tuple((zero,) * agent.private for agent in controller.agents),
    )


def set_initial(
    network: Network, start: InitialState, system: MultiChannelSystem, controller: Controller
) -> None:
    """Check the sizes of an initial state, convert it and set it."""
    if not len(start.shared) == len(start.private) == system.m:
        raise InputError(
            f"expected shared and private states of {system.m} agents, "
            f"found {len(start.shared)} and {len(start.private)}",
            where="initial",
        )
    expected = [
        (system.n, start.plant, "x"),
        *(
            (size, values, f"agent {agent.name!r}")
            for agent, x_i, z_i in zip(controller.agents, start.shared, start.private, strict=True)
            for size, values in ((agent.shared, x_i), (agent.private, z_i))
        ),
    ]
    for size, values, where in expected:
        if len(values) != size:
            raise InputError(f"expected {size} numbers, found {len(values)}", where=where)

    def column(values: Sequence[Fraction]) -> Native:
        return network.arithmetic.convert(Matrix.column(values))

    parts = [
        (column(x_i), column(z_i)) for x_i, z_i in zip(start.shared, start.private, strict=True)
    ]
    network.set_state(column(start.plant), parts)
