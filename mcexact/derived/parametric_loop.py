"""Closed loops of systems with parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import Construction, MultiChannelSystem

Construct = Callable[[MultiChannelSystem], MultiChannelSystem]


@dataclass(frozen=True)
class ParametricLoop:
    """The closed loop of a system with parameters and one controller.

    Attributes
    ----------
    given : ParametricSystem
    construct : callable
        Closes the loop of a system without parameters, perhaps after other constructions.
    subject : tuple of mapping
        The constructions that lead from the plant to the loop, in order.
    n : int
        The dimension of the loop's state.
    """

    given: ParametricSystem
    construct: Construct = field(compare=False, repr=False)
    subject: tuple[Construction, ...] = field(hash=False)
    n: int
    names: ClassVar[tuple[str, ...]] = ()
    m: ClassVar[int] = 0

    @property
    def plant(self) -> ParametricSystem:
        """The user's plant."""
        return self.given.plant

    @property
    def time(self) -> str:
        """The time domain of the plant."""
        return self.given.time

    @property
    def name(self) -> str | None:
        """The name of the plant."""
        return self.given.name

    def at(self, values: Any) -> MultiChannelSystem:
        """The loop at a value of every parameter, as `ParametricSystem.at` takes them."""
        return self.construct(self.given.at(values).with_neighbors({}))


def looped(system: ParametricSystem, construct: Construct) -> ParametricLoop:
    """Close the loop of a system with parameters.

    Parameters
    ----------
    system : ParametricSystem
        It has the neighbor graph without edges.
    construct : function of a MultiChannelSystem
        Applies constructions, the last of which closes the loop.

    Raises
    ------
    UsageError
        If the last construction is another one.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> plant = ParametricSystem([["k"]], [[[1]]], [[[1]]], parameters=["k"])
    >>> gain = local_controllers(plant.at({"k": 0}), [[[-3]]])
    >>> loop = looped(plant, lambda system: closed_loop(system, gain).system)
    >>> loop.n, loop.at({"k": 1}).A[0, 0]
    (1, Fraction(-2, 1))
    """
    n, sizes = system.n, system.sizes
    still = MultiChannelSystem(
        Matrix.zeros(n, n),
        [Matrix.zeros(n, p) for p, _ in sizes],
        [Matrix.zeros(q, n) for _, q in sizes],
        time=system.time,
        names=system.names,
        neighbors={},
    )
    made = construct(still)
    if made.subject[-1:] == () or made.subject[-1]["construction"] != "closed_loop":
        raise UsageError("expected a closed loop")
    return ParametricLoop(system, construct, (*system.subject, *made.subject), made.n)
