"""Set-point control: integrators in the agents, and a distributed controller around them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Literal

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.setpoint import setpoint_solvability
from mcexact.analysis.stability import certify_stability
from mcexact.answer.reading import constructed
from mcexact.answer.setpoint import SetpointSolvability
from mcexact.answer.stability import StabilityVerdict
from mcexact.answer.wording import refusals as say
from mcexact.derived.extended import extended_system
from mcexact.derived.integrators import setpoint_system
from mcexact.errors import Impossible, InputError, InternalError, UsageError
from mcexact.exact.blocks import block, hstack, vstack
from mcexact.exact.linear_algebra import solve
from mcexact.exact.location import StabilityRegion, steady_point
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.canonical import plain
from mcexact.model.closed_loop import closed_loop_matrix, loop_layout, reference_matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph
from mcexact.model.system_file import digest
from mcexact.synthesis.extended import Dimensions, design_extended
from mcexact.synthesis.gate import CertifiedClosedLoop, certify_rate, certify_spectrum
from mcexact.synthesis.network_candidates import ArithmeticKind, Progress
from mcexact.synthesis.observer import design_observer
from mcexact.synthesis.spectrum import wanted_region

Road = Literal["observer", "extended"]


@dataclass(frozen=True, eq=False)
class SetpointDesign:
    """A certified controller that brings every output y_i to the set-point r_i of its agent.

    Attributes
    ----------
    controller : Controller
        Agent i integrates y_i − r_i as the first q_i entries of its private state.
    loop : CertifiedClosedLoop
        Proves the characteristic polynomial, or in floating point through an observer the rate.
    stability : StabilityVerdict
        Proves that the loop is stable, at the rate or radius asked for.  That makes the gain from r
        to y at s = 0 (discrete time: z = 1) the identity.
    solvability : SetpointSolvability
    road : {"observer", "extended"}
    arithmetic : {"exact", "float"}
    """

    controller: Controller
    loop: CertifiedClosedLoop
    stability: StabilityVerdict
    solvability: SetpointSolvability
    road: str
    arithmetic: str

    @property
    def certificate(self) -> Any:
        """The certificate of stability."""
        return self.stability.certificate

    @property
    def certificates(self) -> dict[str, Any]:
        """All that was proved, by the name of a file."""
        found = {
            "setpoint": self.solvability.certificate,
            "stability": self.stability.certificate,
        }
        return {self.loop.certificate.kind: self.loop.certificate} | found

    @property
    def order(self) -> int:
        """The dimension of all agents' states, integrators included."""
        return self.controller.order

    @property
    def height(self) -> int:
        """Bits of the longest numerator or denominator in the controller."""
        return self.controller.height()


def design_setpoint(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    q: str | None = None,
    *,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    road: Road = "observer",
    dimensions: Dimensions = "minimal",
    arithmetic: ArithmeticKind = "exact",
    progress: Progress | None = None,
) -> SetpointDesign:
    """Design a distributed controller that holds every output at its agent's set-point.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    q : str, optional
        The agent that carries the channel controller.
    spectrum : optional
        For the plant with its integrators, of n + Σ q_i states: as in `design_observer`, or as in
        `design_extended`.
    rate, radius : rational, optional
        Instead of a spectrum, or besides it, to be certified.  In exact arithmetic and continuous
        time the numbers are then placed beyond three times the rate, where no fixed mode forbids.
    road : {"observer", "extended"}
        A distributed observer of the plant and all integrators, or shared sub-states of the least
        dimension; agents send no outputs in either.
    dimensions : {"minimal", "bound"} or sequence of m int
        For the extended road.
    arithmetic : {"exact", "float"}
    progress : callable, optional

    Raises
    ------
    Impossible
        If no equilibrium holds some set-points (the certificate gives the combination), a mode
        cannot be controlled or observed, or no linear time-invariant feedback along this road can
        do it.

    Notes
    -----
    Paper, section III.  The design is for the system of `setpoint_system`; its output w_i then
    becomes a part of agent i's own state.  With a stable loop, constant r leads to an equilibrium,
    where ẇ_i = y_i − r_i = 0.  That the gain at s = 0 is the identity is verified besides.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], neighbors={"1": []})
    >>> design = design_setpoint(plant, rate=1)
    >>> design.stability.stable, design.controller.agents[0].private
    (True, 1)
    >>> wash = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[0, 1]]],
    ...                           neighbors={"1": []})
    >>> design_setpoint(wash, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no equilibrium holds set-points r with (1) r ≠ 0: 0 is an \
invariant zero of the plant
    """
    system, found = with_graph(system, graph)
    if system.subject:
        raise UsageError("a controller is designed for a plant, not for a derived system")
    if road not in ("observer", "extended"):
        raise UsageError(f'expected "observer" or "extended", found {road!r}', where="road")
    region = wanted_region(system.time, rate, radius, spectrum=spectrum)
    solvability = _required(system)
    augmented = setpoint_system(system)
    _require_reachable(augmented, region)
    alone = MultiChannelSystem(
        augmented.A,
        [channel.B for channel in augmented.channels],
        [channel.C for channel in augmented.channels],
        time=system.time,
        names=system.names,
        neighbors=found,
    )
    task = _Task(alone, q, spectrum, road, dimensions, arithmetic, progress)
    try:
        made, polynomial = task.designed(_aim(region, task))
    except Impossible:
        try:
            made, polynomial = task.designed(region)
        except Impossible as refused:
            raise _about_the_plant(refused, augmented) from None
    controller = with_integrators(system, made)
    return _certified(system, controller, polynomial, region, solvability, road, arithmetic)


@dataclass(frozen=True)
class _Task:
    """A design for the plant with its integrators, taken for a plant itself."""

    alone: MultiChannelSystem
    agent: str | None
    spectrum: Any
    road: Road
    dimensions: Dimensions
    arithmetic: ArithmeticKind
    progress: Progress | None

    def designed(self, region: StabilityRegion) -> tuple[Controller, Polynomial | None]:
        """A controller, and the polynomial of the loop where the design proves it."""
        alone = self.alone
        given: dict[str, Any] = {region.word: region.bound, "progress": self.progress}
        if self.road == "extended":
            found = design_extended(
                alone,
                None,
                self.agent,
                dimensions=self.dimensions,
                share="states",
                network="held" if alone.neighbors and alone.neighbors.delays else "extended",
                spectrum=self.spectrum,
                arithmetic=self.arithmetic,
                **given,
            )
            return found.controller, found.loop.polynomial
        if self.arithmetic == "exact":
            design = design_observer(alone, None, self.agent, spectrum=self.spectrum, **given)
            return design.controller, design.loop.polynomial
        if self.spectrum is not None:
            raise UsageError("in floating point give a rate or radius, not a spectrum")
        proposed = design_observer(alone, None, self.agent, arithmetic="float", **given)
        return proposed.controller, proposed.loop.polynomial


def _aim(region: StabilityRegion, task: _Task) -> StabilityRegion:
    """Where to place the numbers that nobody prescribed: beyond the rate that is certified.

    Roots that repeat, behind large gains, take many time constants to fade.
    """
    free = task.spectrum is None and task.arithmetic == "exact" and not region.discrete
    return region.tightened(Fraction(2)) if free else region


def _about_the_plant(refused: Impossible, augmented: MultiChannelSystem) -> Impossible:
    """The refusal, with evidence about the plant and its integrators, not one plant of both."""
    found = refused.certificate
    if found.kind == "shared_dimensions":
        # No dimensions are enough: then neither are as many as there are states.
        sizes = (augmented.n,) * augmented.m
        stuck = fixed_spectrum(extended_system(augmented, sizes, "states"))
        return Impossible(say.INTEGRATORS_FIXED(p=stuck.polynomial), stuck.certificate)
    about = constructed(augmented, plain(found.subject))
    return Impossible(refused.message, replace(found, about=about))


def _required(system: MultiChannelSystem) -> SetpointSolvability:
    """Refuse a plant some of whose set-points cannot be held."""
    found = setpoint_solvability(system)
    if found.solvable:
        return found
    told = say.NO_EQUILIBRIUM_ZERO if found.invariant_zero else say.NO_EQUILIBRIUM
    if not found.combinations.nrows:
        told = say.MODE_OF_THE_INTEGRATORS
    place = steady_point(system.time)
    raise Impossible(told(w=found.combinations.rows(), place=place), found.certificate)


def _require_reachable(augmented: MultiChannelSystem, region: StabilityRegion) -> None:
    """Refuse modes that nobody controls or observes and that are not fast enough."""
    for decide, verb in ((joint_controllability, "control"), (joint_observability, "observe")):
        decision = decide(augmented)
        if not region.contains_roots_of(decision.uncontrollable_polynomial):
            told = say.INTEGRATORS_UNREACHED[verb]
            raise Impossible(told(p=decision.uncontrollable_polynomial), decision.certificate)


def with_integrators(system: MultiChannelSystem, controller: Controller) -> Controller:
    """Make w_i a part of agent i's own state, for a controller of the plant with integrators.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant.
    controller : Controller
        For `setpoint_system` of it; agents use their own w_i alone.

    Returns
    -------
    Controller
        Agent i has the private state (w_i, z_i) and takes its reference r_i.

    Raises
    ------
    InputError
        If an agent uses the integrators of another one: nobody sends them.
    """
    programs = []
    for i, agent in enumerate(controller.agents):
        q, k = system.q(i), agent.private
        for each in agent.maps():
            if any(j != i and not M.is_zero() for j, M in each.outputs.items()):
                raise InputError("an agent uses the integrators of another one")
        stay = Matrix.identity(q) * steady_point(system.time)
        moved = [
            _on_own_state(each, i, size, q, k)
            for each, size in zip(agent.maps(), (agent.shared, k, system.p(i)), strict=True)
        ]
        own = moved[1].private or Matrix.zeros(k, q + k)
        private = LinearMap(
            {i: vstack([Matrix.identity(q), Matrix.zeros(k, q)])},
            {j: vstack([Matrix.zeros(q, M.ncols), M]) for j, M in moved[1].shared.items()},
            block([[hstack([stay, Matrix.zeros(q, k)])], [own]]),
            vstack([-Matrix.identity(q), Matrix.zeros(k, q)]),
        )
        programs.append(
            AgentProgram(
                agent.name,
                agent.shared,
                q + k,
                moved[0].without_zeros(),
                private.without_zeros(),
                moved[2].without_zeros(),
                agent.hold,
            )
        )
    return Controller(controller.time, digest(system), tuple(programs))


def _on_own_state(each: LinearMap, i: int, nrows: int, q: int, k: int) -> LinearMap:
    """A map with w_i read from the private state (w_i, z_i) instead of from the output."""
    measured = each.outputs.get(i, Matrix.zeros(nrows, q))
    private = each.private or Matrix.zeros(nrows, k)
    return LinearMap({}, each.shared, hstack([measured, private]))


def steady_gain(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None = None
) -> Matrix | None:
    """The gain from all set-points to all outputs at s = 0 (discrete time: z = 1), exactly.

    Returns
    -------
    Matrix or None
        Σ q_i × Σ q_i; None if the loop has that eigenvalue.
    """
    layout = loop_layout(system, controller, graph)
    M, R = closed_loop_matrix(system, controller, graph), reference_matrix(layout)
    place = steady_point(system.time)
    steady = solve(Matrix.identity(M.nrows) * place - M, R)
    if steady is None:
        return None
    return system.output_matrix() @ layout.pick("x") @ steady


def _certified(
    system: MultiChannelSystem,
    controller: Controller,
    polynomial: Polynomial | None,
    region: StabilityRegion,
    solvability: SetpointSolvability,
    road: str,
    arithmetic: str,
) -> SetpointDesign:
    """Prove the spectrum or the rate of the loop with the plant itself, and its steady gain."""
    if polynomial is not None:
        loop = certify_spectrum(system, controller, polynomial)
        stability = certify_stability(loop.loop, region)
    else:
        loop = certify_rate(system, controller, region=region)
        stability = certify_stability(loop.loop, region)
    if not stability.stable:
        raise InputError("the prescribed numbers do not make a stable loop", where="spectrum")
    gain = steady_gain(system, controller)
    if gain is None or gain != Matrix.identity(gain.nrows):
        raise InternalError("a stable loop with integrators does not reach its set-points")
    return SetpointDesign(controller, loop, stability, solvability, road, arithmetic)
