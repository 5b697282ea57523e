"""Set-points and other signals, by models of them in the agents and a distributed controller.

Agent i integrates y_i − r_i, and a controller stabilizes the plant with these integrators; at rest
every output then is at its set-point.  It exists only if every set-point has an equilibrium and the
integrators leave all slow modes controllable and observable, which is decided first.

The controller is that of `decentralized` or `distributed_observer` for the plant with integrators,
treated as a plant, and `with_integrators` moves the integrators into the agents' own states.  By
default a controller of low order is searched, without communication if no fixed mode forbids this;
a controller of a theorem comes next.

Ramps, sinusoids and other signals take the place of constant set-points with models of their
polynomial in place of the integrators, by the same steps (B. A. Francis and W. M. Wonham 1976).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Literal

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer import loops as say
from mcexact.answer.loops import refusal
from mcexact.answer.structure import SetpointSolvability
from mcexact.derived.constructions import (
    companion_matrix,
    internal_model,
    regulated_outputs,
    servo_system,
    setpoint_system,
)
from mcexact.derived.feedthrough import measured_inputs, on_own_outputs
from mcexact.errors import Impossible, InputError, InternalError, LimitReached, OutOfReach, one_of
from mcexact.exact.linear_algebra import row_echelon
from mcexact.exact.matrix import Matrix, block, block_diagonal, hstack, kronecker, vstack
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import StabilityRegion, steady_point
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.regulated import read_selection
from mcexact.model.signals import constant_signals, signal_polynomial, signals_in_words
from mcexact.model.system import MultiChannelSystem, as_plant, with_links
from mcexact.synthesis.design import Design, Method, designed
from mcexact.synthesis.distributed_observer import observers
from mcexact.synthesis.gate import Arithmetic, Progress, Proposal, Request
from mcexact.synthesis.network_design import network_proposals
from mcexact.synthesis.networks import (
    DerivedNetwork,
    Dimensions,
    decentralized_network,
    degree_of,
    every_output,
    integrated_plant,
    sharing_network,
)
from mcexact.synthesis.optimum.diagnosis import with_diagnosis
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.optimum.problem import Weights, integrated_problem
from mcexact.synthesis.optimum.proposals import Family, searched_proposals
from mcexact.synthesis.rate import at_a_reachable_rate, request_for

SetpointMethod = Literal["observer", "extended"]


def design_setpoint(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    agent: str | None = None,
    *,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    method: SetpointMethod | None = None,
    dimensions: Dimensions = "minimal",
    arithmetic: Arithmetic = "exact",
    regulate: Any = None,
    signals: Any = None,
    aims: Aims | None = None,
    progress: Progress | None = None,
) -> Design:
    """Design a distributed controller that holds outputs at set-points, or follows other signals.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.  Without either, agents receive nothing from each other.
    agent : str, optional
        The agent with the channel controller of a theorem, which is then constructed without a
        search.
    spectrum : optional
        For the plant with its integrators, of n + Σ q_i states: as in `design_observer`, or with
        the key ``"closed_loop"`` as in `design_extended`.
    rate, radius : rational, optional
        A rate or radius to be certified, instead of a spectrum or in addition to it.  Without a
        spectrum, the default is the least cost with margins, as in `design_decentralized`.
        For a controller of a theorem, in exact arithmetic and continuous time, the eigenvalues are
        placed beyond three times the rate, if no fixed mode prevents this.
    method : {"observer", "extended"}, optional
        A distributed observer of the plant with all integrators; or a controller of low order with
        shared sub-states, by a search as in `design_extended`.  By default such a controller, in
        which agents send nothing if no fixed mode makes this necessary, or an observer if none is
        found.  Agents send no outputs.
    dimensions : {"minimal", "bound"} or sequence of m int
        Dimensions of shared sub-states.
    arithmetic : {"exact", "float"}
        The arithmetic of controllers of a theorem.  Floating point takes no spectrum.
    regulate : mapping, optional
        What is held, for each agent that holds something: the positions of some of its outputs,
        from 1 on, or a matrix S_i of q_i columns, so that S_i y_i is held at S_i r_i.  By default
        what the plant names as `MultiChannelSystem.regulated`, else every output.
    signals : str, sequence of str, or Polynomial, optional
        The references and disturbances under which errors tend to 0, such as
        ``"step,ramp,sine:1/2"``, or their polynomial α of degree d; see `signal_polynomial`.  By
        default constants.  The plant with its models has n + d Σ q_i states.
    aims : Aims, optional
        What the search aims at.  The weights are those of the plant.
    progress : callable, optional

    Returns
    -------
    Design
        Agent i integrates y_i − r_i, or S_i (y_i − r_i), as the first entries of its private state;
        in a search, and if only some outputs are held, it also uses y_i itself.  Its ``parts`` are
        the ``solvability``, ``held``, the rows of S_i by agent where not every output is held, and
        ``designed``, the parts of the design for the plant with its integrators.  With other
        signals than constants agent i has models of them in place of the integrators, of d states
        for each row, and the parts have α as ``followed``, with ``held`` for every agent;
        ``solvability`` is there if constants are among the signals.

    Raises
    ------
    Impossible
        If no equilibrium holds some set-points (the certificate gives the combination), if a mode
        is not controllable or not observable, or if no linear time-invariant controller of this
        method exists.
    LimitReached
        As for `design_decentralized`.

    Notes
    -----
    Paper, section III.  The proposals are those of the method for `setpoint_system`, with its
    output w_i made a part of agent i's own state.  With a stable loop, constant r leads to an
    equilibrium, where ẇ_i = y_i − r_i = 0.  It is also verified that the gain at s = 0 is the
    identity, or that from r to S y is S.  Where only some outputs are held, the proposals are those
    for `servo_system`: what is held and what is measured are told apart, as by Davison (1976).

    A plant with feedthrough is refused: design for `input_filters` of it, whose measured inputs are
    not held, and make the controller of the plant by `plant_controller`, which follows the same
    signals.

    With other signals the proposals are those for `internal_model`.  Without communication one
    exists iff no root of α outside the stability region is fixed with models at each agent; see
    `internal_model` for the rank condition.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], neighbors={"1": []})
    >>> design = design_setpoint(plant, rate=1)
    >>> sorted(design.certificates), design.controller.agents[0].private
    (['setpoint', 'stability'], 1)
    >>> wash = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[0, 1]]],
    ...                           neighbors={"1": []})
    >>> design_setpoint(wash, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no equilibrium holds set-points r with (1) r ≠ 0: 0 is an \
invariant zero of the plant
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_links(system, graph)
    one_of(method, (None, "observer", "extended"), "method")
    selection = selected(system, regulate)
    others, held = _other_signals(system, signals), selection or every_output(system)
    parts: dict[str, Any] = {"held": None if selection is None else _by_agent(system, held)}
    if others is None or constant_signals(system.time).divides(others):
        parts["solvability"] = _required(system, selection)
    if others is not None:
        integrated = internal_model(system, others, held)
        parts |= {"held": _by_agent(system, held), "followed": others}
    elif selection is None:
        integrated = setpoint_system(system)
    else:
        integrated = servo_system(system, selection)
    arguments = system, agent, spectrum, rate, radius, arithmetic, progress
    least_cost = method != "observer"
    request = request_for(
        *arguments, aims=aims, selection=held, signals=others, least_cost=least_cost
    )
    _require_reachable(integrated, request.region)

    def attempt(asked: Request) -> Design:
        aimed = aims or Aims()
        task = _Task(system, held, others, integrated, graph, asked, method, dimensions, aimed)
        proposals = (_for_the_plant(system, held, others, each) for each in task.proposals())
        return designed("observer", asked, system, system.neighbors, proposals, stable=True)

    design = at_a_reachable_rate(request, attempt)
    if "solvability" in parts:
        gain, S = design.loop.closed.steady_gain, block_diagonal(held)
        if gain is None or S @ gain != S:
            raise InternalError("a stable loop with integrators does not attain its set-points")
    proved = {"setpoint": parts["solvability"]} if "solvability" in parts else {}
    methods: dict[str | None, Method] = {None: "observer", "decentralized": "decentralized"}
    return replace(
        design,
        method=methods.get(design.parts.get("network"), "extended"),
        certificates={**design.certificates, **proved},
        parts=parts | {"designed": design.parts},
    )


def _other_signals(system: MultiChannelSystem, signals: Any) -> Polynomial | None:
    """The polynomial of the signals, or None for constants alone.

    Raises
    ------
    InputError
        As for `signal_polynomial`, or if a signal tends to 0, so that nothing has to follow it.
    """
    if signals is None:
        return None
    alpha, region = signal_polynomial(signals, system.time), StabilityRegion(system.time)
    for p, _ in alpha.factor():
        if region.contains_roots_of(p):
            found = signals_in_words(p, system.time)
            raise InputError(
                f"expected signals that do not tend to 0, found {found}", where="signals"
            )
    return None if alpha == constant_signals(system.time) else alpha


@dataclass(frozen=True)
class _Task:
    """A set-point design, with the plant with its integrators."""

    system: MultiChannelSystem
    selection: Sequence[Matrix]
    signals: Polynomial | None
    integrated: MultiChannelSystem
    graph: NeighborGraph
    request: Request
    method: SetpointMethod | None
    dimensions: Dimensions
    aims: Aims

    @property
    def searches(self) -> bool:
        """Whether controllers of low order are searched before those of a theorem."""
        return self.method != "observer" and self.aims.searched_for(self.request)

    def proposals(self) -> Iterator[Proposal]:
        """Yield the proposals for the plant with its integrators."""
        limit: LimitReached | None = None
        if self.searches:
            try:
                yield from self._searched()
                return
            except Impossible:
                # The decision is repeated below, for a certificate about the plant itself.
                pass
            except OutOfReach:
                raise
            except LimitReached as reached:
                limit = reached
        try:
            yield from self._of_theorems()
        except LimitReached as reached:
            raise limit or with_diagnosis(reached, *self._weighed()) from None

    def _weighed(self) -> tuple[MultiChannelSystem, StabilityRegion, Weights]:
        """The plant with its integrators, in units near its sizes, the region, and the weights."""
        about = self.system, self.selection, self.aims.weights, self.signals
        plant, weights, _ = integrated_problem(*about)
        return plant, self.request.region, weights

    def _network(self, to: MultiChannelSystem, asked: Request) -> DerivedNetwork:
        """The network over which agents share sub-states."""
        kind: Literal["held", "extended"] = "held" if self.graph.delays else "extended"
        network, _ = sharing_network(
            to, self.graph, asked, dimensions=self.dimensions, share="states", network=kind
        )
        return network

    def _searched(self) -> Iterator[Proposal]:
        """Search without communication if that suffices, else with shared sub-states."""
        (*_, weights), asked = self._weighed(), self.request
        plant = integrated_plant(self.system, self.selection, self.signals)
        network = self._network(plant, asked)
        family = Family(network, "states")
        if self.method is None and not any(network.dimensions):
            family = Family(decentralized_network(plant))
        yield from searched_proposals(family, asked, self.aims, weights)

    def _of_theorems(self) -> Iterator[Proposal]:
        """Propose the observer, or the controller of the extended system."""
        spectrum = self.request.spectrum
        closed = isinstance(spectrum, Mapping) and "closed_loop" in spectrum
        closed = closed or bool(self.graph.delays) or not self.graph.edges()
        extended = self.method == "extended" or (self.method is None and closed)
        # Without links the system stays without a graph, and its certificates are about it.
        apart = self.system.neighbors is None

        def proposed(to: MultiChannelSystem, asked: Request) -> Iterator[Proposal]:
            if not extended:
                return observers(to, self.graph, asked)
            network = decentralized_network(to) if apart else self._network(to, asked)
            return network_proposals(network, asked)

        shared = extended and not apart and not self.graph.delays
        minimal = shared and self.dimensions == "minimal"
        yield from _proposals(proposed, self.integrated, self.request, minimal=minimal)


def selected(system: MultiChannelSystem, regulate: Any) -> tuple[Matrix, ...] | None:
    """Return the S_i of what is to be held; None for every output.

    Inputs that `input_filters` made states, and that agents measure, are not held.

    Parameters
    ----------
    system : MultiChannelSystem
    regulate : mapping or None
        As for `design_setpoint`.

    Raises
    ------
    InputError
        If an agent or an output does not exist, or a matrix has not q_i columns.
    """
    inputs = measured_inputs(system)
    selection = system.plant.regulated if any(inputs) else system.regulated
    if regulate is not None:
        counts = [system.q(i) - p for i, p in enumerate(inputs)]
        selection = read_selection(regulate, system.names, counts)
    if any(inputs):
        return on_own_outputs(system, selection)
    return None if selection is None or selection == every_output(system) else selection


def held_together(
    system: MultiChannelSystem, selection: Sequence[Matrix] | None = None
) -> tuple[Matrix, ...]:
    """Choose as many regulated outputs as have equilibria for all set-points together.

    Parameters
    ----------
    system : MultiChannelSystem
    selection : sequence of m Matrix, optional
        The S_i among whose rows to choose; by default all outputs.

    Returns
    -------
    tuple of m Matrix
        Rows of the S_i; there is no larger choice among them, but perhaps others of the same size.

    Notes
    -----
    Exact: the rows that are independent of [A, B] (discrete time: A − I) and of those before them,
    the first row of every agent before the second of any.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0], [0, 1]]])
    >>> [S.numerators for S in held_together(plant)]
    [((1, 0),)]
    """
    selection, n = selection or every_output(system), system.n
    B = system.input_matrix()
    steady = hstack([system.A - Matrix.identity(n) * steady_point(system.time), B])
    order = sorted((k, i) for i, S in enumerate(selection) for k in range(S.nrows))
    outputs = vstack([selection[i].take(rows=[k]) @ system.C(i) for k, i in order], ncols=n)
    rows = vstack([steady, hstack([outputs, Matrix.zeros(outputs.nrows, B.ncols)])])
    _, independent = row_echelon(rows.T)
    chosen = {order[place - n] for place in independent if place >= n}
    return tuple(
        S.take(rows=[k for k in range(S.nrows) if (k, i) in chosen])
        for i, S in enumerate(selection)
    )


def _by_agent(
    system: MultiChannelSystem, selection: Sequence[Matrix]
) -> tuple[tuple[str, tuple[tuple[Fraction, ...], ...]], ...]:
    """The rows of S_i by the names of agents that hold something."""
    each = zip(system.names, selection, strict=True)
    return tuple((name, tuple(map(tuple, S.rows()))) for name, S in each if S.nrows)


def _required(
    system: MultiChannelSystem, selection: Sequence[Matrix] | None
) -> SetpointSolvability:
    """Raise an error if some set-points have no equilibrium."""
    about = system if selection is None else regulated_outputs(system, selection)
    solvability = setpoint_solvability(about)
    if solvability.solvable:
        return solvability
    raise refusal("equilibrium", solvability, combinations=solvability.combinations.rows())


def _require_reachable(augmented: MultiChannelSystem, region: StabilityRegion) -> None:
    """Raise an error for modes that are too slow and not controllable or not observable."""
    unreached = say.MODELS_UNREACHED if _has_models(augmented) else say.INTEGRATORS_UNREACHED
    for decide, verb in ((joint_controllability, "control"), (joint_observability, "observe")):
        decision = decide(augmented)
        if not region.contains_roots_of(decision.uncontrollable_polynomial):
            raise refusal("unreached", decision, template=unreached[verb])


def _has_models(augmented: MultiChannelSystem) -> bool:
    """Whether models of other signals stand in place of integrators."""
    made: str = augmented.subject[-1]["construction"]
    return made == "internal_model"


def _proposals(
    proposed: Callable[[MultiChannelSystem, Request], Iterator[Proposal]],
    integrated: MultiChannelSystem,
    request: Request,
    *,
    minimal: bool,
) -> Iterator[Proposal]:
    """Yield the proposals of a method for the plant with its integrators, taken as a plant.

    If the spectrum is free, in continuous time, it is placed beyond the certified rate, since
    repeated eigenvalues with large gains decay slowly at first.
    """
    asked, region = [request], request.region
    if request.spectrum is None and request.arithmetic == "exact" and not region.discrete:
        asked = [replace(request, region=region.tightened(Fraction(2))), request]
    for each in asked:
        try:
            yield from proposed(as_plant(integrated), each)
            return
        except Impossible:
            continue
    try:
        # After a refusal the decision is repeated, for a certificate about the plant itself.
        yield from proposed(integrated, request)
    except Impossible as refused:
        certificate = refused.certificate
        if minimal and certificate.kind == "fixed_spectrum":
            fixed = say.MODELS_FIXED if _has_models(integrated) else say.INTEGRATORS_FIXED
            raise refusal("integrators", certificate, template=fixed) from None
        made = [step["construction"] for step in certificate.subject]
        if made[-1:] == ["internal_model"] and certificate.kind == "fixed_spectrum":
            raise refusal("models", certificate, region=request.region) from None
        raise


def _for_the_plant(
    system: MultiChannelSystem,
    selection: Sequence[Matrix],
    signals: Polynomial | None,
    proposal: Proposal,
) -> Proposal:
    """Convert a proposal for the plant with its integrators to one for the plant."""
    n, places = system.n, list(range(system.n))
    sizes = [degree_of(signals) * S.nrows for S in selection]
    w, start = n, n + sum(sizes)
    for size, agent in zip(sizes, proposal.controller.agents, strict=True):
        # (x_i, (w_i, z_i)), of (x, w, x_1, z_1, …).
        places += [*range(start, start + agent.shared), *range(w, w + size)]
        places += range(start + agent.shared, start + agent.shared + agent.private)
        w, start = w + size, start + agent.shared + agent.private
    return Proposal(
        with_integrators(system, proposal.controller, selection, signals),
        (product(proposal.polynomials),) if proposal.polynomials else (),
        ()
        if proposal.polynomials
        else tuple(each.of_states(tuple(places)) for each in proposal.coordinates),
        proposal.parts,
    )


def with_integrators(
    system: MultiChannelSystem,
    controller: Controller,
    selection: Sequence[Matrix] | None = None,
    signals: Polynomial | None = None,
) -> Controller:
    """Make w_i a part of agent i's own state, for a controller of the plant with integrators.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant.
    controller : Controller
        A controller for its `setpoint_system`, `servo_system`, `internal_model` or
        `integrated_plant`, in which agents use their own w_i and y_i alone.
    selection : sequence of m Matrix, optional
        S_i, of which S_i y_i is integrated; by default every y_i is.
    signals : Polynomial, optional
        Those of the models in place of the integrators.

    Returns
    -------
    Controller
        Agent i has the private state (w_i, z_i) and takes its reference r_i.

    Raises
    ------
    InputError
        If an agent uses the integrators of another agent, which are not sent.
    """
    programs, alpha = [], signals or constant_signals(system.time)
    for i, agent in enumerate(controller.agents):
        S, k = (selection or every_output(system))[i], agent.private
        model = kronecker(companion_matrix(alpha), Matrix.identity(S.nrows))
        q = model.nrows
        S = vstack([Matrix.zeros(q - S.nrows, S.ncols), S], ncols=S.ncols)
        for each in agent.maps():
            if any(j != i and not M.is_zero() for j, M in each.outputs.items()):
                raise InputError("an agent uses the integrators of another one")
        maps = [
            _on_own_state(each, i, size, q, k)
            for each, size in zip(agent.maps(), (agent.shared, k, system.p(i)), strict=True)
        ]
        own = maps[1].private or Matrix.zeros(k, q + k)
        private = LinearMap(
            {i: vstack([S, maps[1].outputs.get(i, Matrix.zeros(k, S.ncols))])},
            {j: vstack([Matrix.zeros(q, M.ncols), M]) for j, M in maps[1].shared.items()},
            block([[hstack([model, Matrix.zeros(q, k)])], [own]]),
            vstack([-S, Matrix.zeros(k, S.ncols)]),
        )
        programs.append(
            AgentProgram(
                agent.name,
                agent.shared,
                q + k,
                maps[0].without_zeros(),
                private.without_zeros(),
                maps[2].without_zeros(),
                agent.hold,
            )
        )
    return Controller(controller.time, system.digest_of_values(), tuple(programs))


def _on_own_state(each: LinearMap, i: int, nrows: int, q: int, k: int) -> LinearMap:
    """Convert a map so that it reads w_i from the private state (w_i, z_i), not from the output.

    The output of agent i is w_i, or (w_i, y_i).
    """
    measured = each.outputs.get(i, Matrix.zeros(nrows, q))
    own = measured.take(cols=range(q, measured.ncols))
    private = each.private or Matrix.zeros(nrows, k)
    integrals = measured.take(cols=range(q))
    outputs = {i: own} if own.ncols else {}
    return LinearMap(outputs, each.shared, hstack([integrals, private]))
