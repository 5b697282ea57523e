"""Plants with feedthrough, y_i = C_i x + Σ D_ij u_j, as systems without one.

`input_filters` makes every input a state of the system, which its own agent sets by its derivative
and measures.  Nothing acts on an output at once any more, and the pencils of complementary
subsystems are equivalent to those of the plant with its D (``proofs/feedthrough.v``): the result
has the fixed modes of the plant, with their multiplicities, its transfer graph, and what all
channels together control and observe.  So every decision about systems without feedthrough answers
for the plant, and a controller of the result is a strictly proper one of the plant, which
`plant_controller` makes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import accumulate

from mcexact.derived.constructions import regulated_outputs
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix, block, hstack, vstack
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, any_system

FILTERS = "input_filters"
"""The name of the construction."""


def input_filters(system: MultiChannelSystem) -> MultiChannelSystem:
    """Make the inputs states: u̇_i = v_i, in discrete time u_i(t+1) = v_i, and agent i measures u_i.

    Parameters
    ----------
    system : MultiChannelSystem
        With feedthrough or without.

    Returns
    -------
    MultiChannelSystem
        n + Σ p_i states (x, u), the inputs v_i, the outputs (y_i, u_i), no feedthrough, and the
        same neighbor graph.

    Notes
    -----
    Exact.  In block form, with D_i for the rows of D that belong to y_i, and E_i for the columns of
    the identity of size Σ p_i that belong to u_i::

            ⎡ A  B ⎤            ⎡  0  ⎤           ⎡ C_i  D_i  ⎤
        Ã = ⎣ 0  0 ⎦ ,    B̃_i = ⎣ E_i ⎦ ,    C̃_i = ⎣  0   E_i' ⎦

    For all sets s of channels, with T for the others, and every λ::

        rank [λI − Ã, B̃_T; C̃_s, 0] = rank [λI − A, −B_T; C_s, D_{s,T}] + Σ p_i

    so λ is a fixed mode of the result iff it is one of the plant.  Mind the sign of B_T: with D it
    matters.  A controller of the result, v_i' = …, with its state u_i is one of the plant that is
    strictly proper, so that its loop is well posed.  The agent may feed back u_i with any gain, and
    so a pole a in u̇_i = a u_i + v_i makes no other system than a = 0.

    Examples
    --------
    >>> from mcexact import fixed_spectrum
    >>> filtered = input_filters(MultiChannelSystem([[3]], [[[1]]], [[[2]]], D=[[5]]))
    >>> filtered.A.numerators, filtered.B(0).numerators, filtered.C(0).numerators
    (((3, 1), (0, 0)), ((0,), (1,)), ((2, 5), (0, 1)))

    The sign of D can decide whether a mode is fixed:

    >>> A, B, C = [[-1, -1], [-1, -1]], [[[-1], [-1]], [[1], [0]]], [[[1, 0]], [[1, 1]]]
    >>> for sign in (1, -1):
    ...     plant = MultiChannelSystem(A, B, C, D=[[0, 0], [sign, 0]])
    ...     print(fixed_spectrum(input_filters(plant)).polynomial)
    x
    1
    """
    any_system(system)
    n, p = system.n, sum(width for width, _ in system.sizes)
    identity = Matrix.identity(p)
    B, C = [], []
    for i, own in enumerate(_consecutive([width for width, _ in system.sizes])):
        B.append(vstack([Matrix.zeros(n, len(own)), identity.take(cols=own)], ncols=len(own)))
        measured = hstack([system.C(i), system.feedthrough_matrix([i])], nrows=system.q(i))
        known = hstack([Matrix.zeros(len(own), n), identity.take(rows=own)], nrows=len(own))
        C.append(vstack([measured, known], ncols=n + p))
    return system.derived(
        block([[system.A, system.input_matrix()], [Matrix.zeros(p, n), Matrix.zeros(p, p)]]),
        B,
        C,
        {"construction": FILTERS},
        D=None,
        neighbors=system.neighbors,
    )


def _consecutive(sizes: Sequence[int]) -> list[range]:
    """Consecutive ranges of these sizes, from 0 on."""
    return [range(end - size, end) for end, size in zip(accumulate(sizes), sizes, strict=True)]


def without_feedthrough(system: MultiChannelSystem) -> MultiChannelSystem:
    """Return the system itself, or with its inputs as states if it has feedthrough."""
    return system if any_system(system).D is None else input_filters(system)


def measured_inputs(system: MultiChannelSystem) -> list[int]:
    """Return how many of the last outputs of each agent `input_filters` has just added."""
    added = [step["construction"] for step in system.subject[-1:]] == [FILTERS]
    return [p if added else 0 for p, _ in system.sizes]


def on_own_outputs(
    system: MultiChannelSystem, selection: Sequence[Matrix] | None = None
) -> tuple[Matrix, ...]:
    """Return [S_i 0], by which S_i selects among the y_i, without the inputs that are measured.

    Parameters
    ----------
    system : MultiChannelSystem
    selection : sequence of m Matrix, optional
        By default the identities.
    """
    wide = []
    for i, (p, (_, q)) in enumerate(zip(measured_inputs(system), system.sizes, strict=True)):
        S = Matrix.identity(q - p) if selection is None else selection[i]
        wide.append(hstack([S, Matrix.zeros(S.nrows, p)], nrows=S.nrows))
    return tuple(wide)


def own_outputs(system: MultiChannelSystem) -> MultiChannelSystem:
    """Return the system without the measured inputs that `input_filters` has just added.

    What a controller holds at set-points are the y_i, and not the inputs.  Another system is
    returned as it is.
    """
    added = any(measured_inputs(system))
    return regulated_outputs(system, on_own_outputs(system)) if added else system


# A controller of the result is one of the plant.


def plant_controller(controller: Controller, plant: MultiChannelSystem) -> Controller:
    """Make a controller of a plant, from one of the plant with its inputs as states.

    Parameters
    ----------
    controller : Controller
        For ``input_filters(plant)``: agent i sets v_i and uses (y_j, u_j) where it uses outputs.
    plant : MultiChannelSystem

    Returns
    -------
    Controller
        Agent i has the state u_i besides its own states, private, or shared where others use it:
        u̇_i = v_i, in discrete time u_i(t+1) = v_i.  It is strictly proper, and its loop with the
        plant has the matrix of the other loop, in another order of its states.

    Raises
    ------
    InputError
        If the plant has a feedthrough of another shape than the controller is for.
    UsageError
        If set-points of the inputs are used, an input has limits, or an agent holds messages that
        contain its input.

    Examples
    --------
    >>> from mcexact import certify_controller
    >>> from mcexact.designs import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], D=[[1]])
    >>> gains = local_controllers(input_filters(plant), [[["-6", 1]]])
    >>> controller = plant_controller(gains, plant)
    >>> controller.agents[0].private, certify_controller(plant, controller).stable
    (1, True)
    """
    any_system(plant)
    controller.require_fits(
        input_filters(plant), plant.neighbors or NeighborGraph.empty(plant.names)
    )
    sent = {
        j
        for i, agent in enumerate(controller.agents)
        for each in agent.maps()
        for j, M in each.outputs.items()
        if j != i and not M.take(cols=range(plant.q(j), M.ncols)).is_zero()
    }
    agents = tuple(
        _with_input(agent, i, plant, sent, controller) for i, agent in enumerate(controller.agents)
    )
    return Controller(controller.time, plant.digest_of_values(), agents)


def _with_input(
    agent: AgentProgram, i: int, plant: MultiChannelSystem, sent: set[int], of: Controller
) -> AgentProgram:
    """The program of agent i with its input as its last state, shared or private."""
    p = plant.p(i)
    if agent.limits is not None or agent.back_calculation is not None:
        raise UsageError("a controller with limits of its inputs is not one of the plant")
    if i in sent and any(agent.hold.values()):
        raise UsageError(f"agent {agent.name} holds messages that contain its input")
    sizes = {j: of.agents[j].shared for j in range(plant.m)}
    heights = agent.shared, agent.private, p
    shared, private, control = (
        _of_plant(each, i, k, plant, sent, sizes, agent.private)
        for each, k in zip(agent.maps(), heights, strict=True)
    )
    own = Matrix.identity(p)
    if i in sent:
        shared = _below(shared, control, agent.shared, p)
        chosen = LinearMap(shared={i: hstack([Matrix.zeros(p, agent.shared), own])})
    else:
        private = _below(private, control, agent.private, p)
        chosen = LinearMap(private=hstack([Matrix.zeros(p, agent.private), own]))
    more = (p, 0) if i in sent else (0, p)
    return AgentProgram(
        agent.name,
        agent.shared + more[0],
        agent.private + more[1],
        shared.without_zeros(),
        private.without_zeros(),
        chosen.without_zeros(),
        agent.hold,
    )


def _of_plant(
    each: LinearMap,
    i: int,
    height: int,
    plant: MultiChannelSystem,
    sent: set[int],
    sizes: Mapping[int, int],
    private: int,
) -> LinearMap:
    """A map of agent i, of height rows, whose u_j are parts of states."""
    outputs, inputs = dict[int, Matrix](), dict[int, Matrix]()
    for j, M in each.outputs.items():
        outputs[j] = M.take(cols=range(plant.q(j)))
        inputs[j] = M.take(cols=range(plant.q(j), M.ncols))
    wide = {}
    for j in {*each.shared, *inputs}:
        x = each.shared.get(j, Matrix.zeros(height, sizes[j]))
        if j in sent:
            x = hstack([x, inputs.get(j, Matrix.zeros(height, plant.p(j)))])
        wide[j] = x
    z = Matrix.zeros(height, private) if each.private is None else each.private
    if i not in sent:
        z = hstack([z, inputs.get(i, Matrix.zeros(height, plant.p(i)))])
    r = each.reference
    if r is not None:
        if not r.take(cols=range(plant.q(i), r.ncols)).is_zero():
            raise UsageError("a controller that uses set-points of inputs is not one of the plant")
        r = r.take(cols=range(plant.q(i)))
    return LinearMap(outputs, wide, z, r)


def _below(first: LinearMap, second: LinearMap, height: int, more: int) -> LinearMap:
    """Two maps below each other, of so many rows."""

    def both(a: Matrix | None, b: Matrix | None) -> Matrix | None:
        if a is None or b is None:
            known = b if a is None else a
            if known is None:
                return None
            zeros = Matrix.zeros(height if a is None else more, known.ncols)
            return vstack([zeros, known] if a is None else [known, zeros])
        return vstack([a, b])

    def all_of(a: Mapping[int, Matrix], b: Mapping[int, Matrix]) -> dict[int, Matrix]:
        joined = {j: both(a.get(j), b.get(j)) for j in sorted({*a, *b})}
        return {j: M for j, M in joined.items() if M is not None}

    return LinearMap(
        all_of(first.outputs, second.outputs),
        all_of(first.shared, second.shared),
        both(first.private, second.private),
        both(first.reference, second.reference),
    )
