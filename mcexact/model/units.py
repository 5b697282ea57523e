"""Units near the typical sizes of signals, in which searches and proofs calculate.

`Units` are powers of ten: decimals keep their digits, and a plant with sizes has the same matrices
in these units, in whatever units, a power of ten apart, its file is written.  Without sizes they
are those of the file.  Everything here is exact, and what is certified is about the plant of the
file.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain

from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.loop import ClosedLoop
from mcexact.model.radii import Radii
from mcexact.model.sizes import STANDARD_ERROR, PerChannel, TypicalSizes
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class Units:
    """A unit for each state, input and output of a plant, as a multiple of that of the file.

    Attributes
    ----------
    states : tuple of n Fraction
    inputs, outputs : tuple of m tuples of Fraction
    """

    states: tuple[Fraction, ...]
    inputs: PerChannel
    outputs: PerChannel

    @classmethod
    def of(cls, system: MultiChannelSystem) -> Units | None:
        """The powers of ten nearest to the sizes; None if they are those of the file.

        Examples
        --------
        >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
        >>> Units.of(plant) is None
        True
        >>> Units.of(plant.with_typical_sizes(TypicalSizes(states=[300], errors=[["1/1000"]])))
        Units(states=(Fraction(100, 1),), inputs=((Fraction(1, 1),),), \
outputs=((Fraction(1, 100),),))
        """
        sizes = system.typical_sizes
        if sizes is None or system.subject:
            return None
        p, q = ([size(i) for i in range(system.m)] for size in (system.p, system.q))
        units = cls(
            tuple(map(power_of_ten, sizes.of_states(system.n))),
            tuple(tuple(map(power_of_ten, each)) for each in sizes.of_inputs(p)),
            tuple(
                tuple(power_of_ten(e / STANDARD_ERROR) for e in each) for each in sizes.of_errors(q)
            ),
        )
        everything = chain(units.states, *units.inputs, *units.outputs)
        return None if all(unit == 1 for unit in everything) else units

    @property
    def of_inputs(self) -> tuple[Fraction, ...]:
        """The units of all inputs, in the order of the channels."""
        return tuple(chain(*self.inputs))

    @property
    def of_outputs(self) -> tuple[Fraction, ...]:
        """The units of all outputs, in the order of the channels."""
        return tuple(chain(*self.outputs))

    def inverse(self) -> Units:
        """The units of the file, in these units."""

        def inverted(channels: PerChannel) -> PerChannel:
            return tuple(tuple(1 / unit for unit in each) for each in channels)

        return Units(
            tuple(1 / unit for unit in self.states), inverted(self.inputs), inverted(self.outputs)
        )


def power_of_ten(x: Fraction) -> Fraction:
    """The power of ten that is nearest to a positive number, by their ratio.

    Examples
    --------
    >>> [str(power_of_ten(Fraction(x))) for x in ("3", "4", "0.03", "0.4")]
    ['1', '10', '1/100', '1']
    """
    power, square = Fraction(1), x * x
    while square >= 10 * power * power:
        power *= 10
    while square * 10 < power * power:
        power /= 10
    return power


def scaled(M: Matrix, rows: Sequence[Fraction], columns: Sequence[Fraction]) -> Matrix:
    """Multiply the rows and the columns of a matrix by numbers.

    Examples
    --------
    >>> scaled(Matrix.identity(1), [Fraction(2)], [Fraction(1, 3)])[0, 0]
    Fraction(2, 3)
    """
    if M.is_zero():
        return M
    cells = [(i, j, Fraction(x, M.denominator) * rows[i] * columns[j]) for i, j, x in M.nonzero()]
    return Matrix.from_entries(M.shape, cells)


def inverted(units: Sequence[Fraction]) -> list[Fraction]:
    """The inverse of each unit."""
    return [1 / unit for unit in units]


def system_in(units: Units, system: MultiChannelSystem) -> MultiChannelSystem:
    """The plant with its states, inputs and outputs measured in some units, with radii and sizes.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[200]]], [[[1]]])
    >>> plant = plant.with_typical_sizes(TypicalSizes(states=[100]))
    >>> system_in(Units.of(plant), plant).B(0)[0, 0]
    Fraction(2, 1)
    """
    x, less = units.states, inverted(units.states)

    def measured(
        A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix]
    ) -> tuple[Matrix, list[Matrix], list[Matrix]]:
        return (
            scaled(A, less, x),
            [scaled(M, less, u) for M, u in zip(B, units.inputs, strict=True)],
            [scaled(M, inverted(y), x) for M, y in zip(C, units.outputs, strict=True)],
        )

    channels = system.channels
    radii = system.uncertainty
    return MultiChannelSystem(
        *measured(system.A, [each.B for each in channels], [each.C for each in channels]),
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
        sample_time=system.sample_time,
        uncertainty=None if radii is None else Radii(*measured(radii.A, radii.B, radii.C)),
        typical_sizes=None
        if system.typical_sizes is None
        else _sizes_in(units, system.typical_sizes, system),
        name=system.name,
        source=system.source,
    )


def in_own_units(system: MultiChannelSystem) -> MultiChannelSystem:
    """The plant in units near its sizes."""
    units = Units.of(system)
    return system if units is None else system_in(units, system)


def _sizes_in(units: Units, sizes: TypicalSizes, system: MultiChannelSystem) -> TypicalSizes:
    p, q = ([size(i) for i in range(system.m)] for size in (system.p, system.q))

    def measured(numbers: PerChannel, by: PerChannel) -> list[list[Fraction]]:
        pairs = zip(numbers, by, strict=True)
        return [[x / unit for x, unit in zip(*each, strict=True)] for each in pairs]

    (states,) = measured((sizes.of_states(system.n),), (units.states,))
    inputs, errors = sizes.of_inputs(p), sizes.of_errors(q)
    return TypicalSizes(
        states, measured(inputs, units.inputs), measured(errors, units.outputs), sizes.disturbances
    )


def controller_in(
    units: Units,
    controller: Controller,
    system: str = "",
    integrators: Sequence[Sequence[Fraction]] | None = None,
) -> Controller:
    """The controller with its inputs and outputs measured in some units.

    Parameters
    ----------
    units : Units
    controller : Controller
    system : str
        The digest of the plant in these units.
    integrators : sequence of m sequences of Fraction, optional
        Units of the first private states of each agent; all other states keep theirs.
    """
    integrated = integrators or [()] * len(controller.agents)
    own = [
        [*first, *[Fraction(1)] * (agent.private - len(first))]
        for agent, first in zip(controller.agents, integrated, strict=True)
    ]

    def of(each: LinearMap, i: int, left: Sequence[Fraction]) -> LinearMap:
        def times(M: Matrix | None, columns: Sequence[Fraction]) -> Matrix | None:
            return None if M is None else scaled(M, left, columns)

        ones = [Fraction(1)] * max((agent.shared for agent in controller.agents), default=0)
        return LinearMap(
            {j: scaled(M, left, units.outputs[j]) for j, M in each.outputs.items()},
            {j: scaled(M, left, ones) for j, M in each.shared.items()},
            times(each.private, own[i]),
            times(each.reference, units.outputs[i]),
        )

    agents: list[AgentProgram] = []
    for i, agent in enumerate(controller.agents):
        left = [Fraction(1)] * agent.shared, inverted(own[i]), inverted(units.inputs[i])
        shared, private, used = (
            of(each, i, by) for each, by in zip(agent.maps(), left, strict=True)
        )
        agents.append(replace(agent, shared_update=shared, private_update=private, input=used))
    return replace(controller, system=system, agents=tuple(agents))


def loop_in(
    units: Units, loop: ClosedLoop, integrators: Sequence[Sequence[Fraction]] | None = None
) -> ClosedLoop:
    """The closed loop with all signals of the plant measured in some units; see `controller_in`."""
    plant = system_in(units, loop.plant)
    controller = controller_in(units, loop.controller, plant.digest_of_values(), integrators)
    return replace(loop, plant=plant, controller=controller)
