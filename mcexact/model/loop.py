"""Closed loops: the states of plant and agents, and messages under way.  Only this file makes them.

`ClosedLoop` eliminates outputs and inputs and gives the matrix of the loop, also for a plant with
feedthrough if the loop is well posed.  `LoopPencil` keeps
y_j and u_j as signals, so that each entry of the plant and of the controller stands in one place
of its matrix by itself: that is what uncertain entries need.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

from mcexact.errors import InputError, UsageError
from mcexact.exact.linear_algebra import solve
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.roots import steady_point
from mcexact.model.controller import Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, require_discrete, with_links


@dataclass(frozen=True, eq=False)
class DisturbedLoop:
    """A loop with a signal d added to every input, and a signal e added to every output.

        z' = M z + E d + G e,   u = U z + K e,   y = Y z      (discrete time: z(t+1))

    The agents compute u, and the plant receives u + d; the plant measures y, and everybody who uses
    the outputs receives y + e.

    Attributes
    ----------
    M : Matrix, N × N
    E : Matrix, N × Σ p_i
    G : Matrix, N × Σ q_i
    U : Matrix, Σ p_i × N
    K : Matrix, Σ p_i × Σ q_i
    Y : Matrix, Σ q_i × N
    """

    M: Matrix
    E: Matrix
    G: Matrix
    U: Matrix
    K: Matrix
    Y: Matrix


@dataclass(frozen=True, eq=False)
class ClosedLoop:
    """A closed loop: the layout of its state, and its matrix.

    The state is (x, x_1, z_1, x_2, z_2, …, x_m, z_m), then for each agent j in order
    x_j(t−1), …, x_j(t−b_j), y_j(t−1), …, y_j(t−a_j), with b_j and a_j the longest delays with which
    any program uses x_j and y_j, holding included.  Make one with `closed_loop`.

    Attributes
    ----------
    plant : MultiChannelSystem
        The plant, or a system derived from one.
    controller : Controller
    graph : NeighborGraph
    """

    plant: MultiChannelSystem
    controller: Controller
    graph: NeighborGraph

    def waits(self, j: int, i: int) -> tuple[int, int]:
        """The ages of x_j and y_j when agent i uses them, in steps."""
        link = self.graph.delay(i, j) if i != j else 0
        return link + self.controller.agents[j].hold.get(i, 0), link

    @cached_property
    def oldest(self) -> tuple[tuple[int, int], ...]:
        """(b_j, a_j) for each agent j."""
        longest = [[0, 0] for _ in self.controller.agents]
        for i, agent in enumerate(self.controller.agents):
            for each in agent.maps():
                # A signal with zero coefficients is not used, and is not written to files either.
                used_for = each.without_zeros()
                for kind, used in enumerate((used_for.shared, used_for.outputs)):
                    for j in used:
                        longest[j][kind] = max(longest[j][kind], self.waits(j, i)[kind])
        return tuple((b, a) for b, a in longest)

    @cached_property
    def blocks(self) -> Mapping[tuple[str, int, int], tuple[int, int]]:
        """Position and size of the blocks ("x", 0, 0), ("x_", j, δ), ("z_", j, 0), ("y_", j, δ)."""
        places: dict[tuple[str, int, int], tuple[int, int]] = {("x", 0, 0): (0, self.plant.n)}
        position = self.plant.n
        order: list[tuple[str, int, int, int]] = []
        for j, agent in enumerate(self.controller.agents):
            order += [("x_", j, 0, agent.shared), ("z_", j, 0, agent.private)]
        for j, agent in enumerate(self.controller.agents):
            b, a = self.oldest[j]
            order += [("x_", j, delta, agent.shared) for delta in range(1, b + 1)]
            order += [("y_", j, delta, self.plant.q(j)) for delta in range(1, a + 1)]
        for kind, j, delta, size in order:
            places[kind, j, delta] = (position, size)
            position += size
        return places

    @cached_property
    def inputs(self) -> Matrix:
        """The inputs of all channels, as rows over the loop's state, Σ p_i × N.

        With feedthrough y = C x + D u and u = K y + …, so that (I − K D) u = K C x + ….

        Raises
        ------
        UsageError
            If I − K D is singular: the loop is not well posed.
        """
        plant, agents = self.plant, self.controller.agents
        rows = [
            self._rows(agent.input, i, plant.p(i), self._state_in) for i, agent in enumerate(agents)
        ]
        apart = vstack(rows, ncols=self.dimension)
        if plant.D is None:
            return apart
        K = [self._at_once(agent.input, i, plant.p(i)) for i, agent in enumerate(agents)]
        inner = Matrix.identity(apart.nrows) - vstack(K, ncols=plant.D.nrows) @ plant.D
        inputs = solve(inner, apart)
        if inputs is None:
            raise UsageError(
                "the loop is not well posed: I - K D is singular, K what the inputs do at once "
                "with the outputs"
            )
        return inputs

    def _at_once(self, each: LinearMap, i: int, nrows: int) -> Matrix:
        """What a map of agent i does in a step with the outputs that it receives in this step."""
        q = [self.plant.q(j) for j in range(self.plant.m)]
        used = {j: M for j, M in each.without_zeros().outputs.items() if not self.waits(j, i)[1]}
        parts = [used.get(j, Matrix.zeros(nrows, q[j])) for j in range(self.plant.m)]
        return hstack(parts, nrows=nrows)

    @cached_property
    def matrix(self) -> Matrix:
        """The matrix of the closed loop, N×N, assembled from the agents' programs."""
        state = self.plant.A @ self.pick("x")
        for i, agent in enumerate(self.controller.agents):
            state = state + self.plant.B(i) @ self.rows(agent.input, i, self.plant.p(i))
        rows = [state]
        for i, agent in enumerate(self.controller.agents):
            rows.append(self.rows(agent.shared_update, i, agent.shared))
            rows.append(self.rows(agent.private_update, i, agent.private))
        for j, (b, a) in enumerate(self.oldest):
            rows += [self.pick("x_", j, delta) for delta in range(b)]
            rows += [self.pick("y_", j, delta) for delta in range(a)]
        return vstack(rows, ncols=self.dimension)

    @cached_property
    def system(self) -> MultiChannelSystem:
        """The loop as a system without channels, which records the plant and the controller."""
        construction = {"construction": "closed_loop", "controller": self.controller.document()}
        return self.plant.derived(self.matrix, (), (), construction, D=None)

    @cached_property
    def reference(self) -> Matrix:
        """The matrix by which the set-points (r_1, …, r_m) act on the loop, N×Σ q_i."""
        InputError.require(self.plant, MultiChannelSystem, "plant")
        rows = [self.plant.input_matrix() @ self.reference_at_once]
        for i, agent in enumerate(self.controller.agents):
            rows.append(self._references(agent.shared_update, i, agent.shared))
            rows.append(self._references(agent.private_update, i, agent.private))
        known, count = sum(M.nrows for M in rows), rows[0].ncols
        rows.append(Matrix.zeros(self.dimension - known, count))
        return vstack(rows, ncols=count)

    @cached_property
    def reference_at_once(self) -> Matrix:
        """The matrix by which the set-points act on the inputs at once, Σ p_i × Σ q_i."""
        agents, m = self.controller.agents, self.plant.m
        rows = [self._references(agents[i].input, i, self.plant.p(i)) for i in range(m)]
        return vstack(rows, ncols=sum(self.plant.q(i) for i in range(m)))

    def _references(self, each: LinearMap, i: int, nrows: int) -> Matrix:
        """What a map of agent i does with all set-points."""
        parts = [Matrix.zeros(nrows, self.plant.q(j)) for j in range(self.plant.m)]
        if each.reference is not None:
            parts[i] = each.reference
        return hstack(parts, nrows=nrows)

    @cached_property
    def disturbed(self) -> DisturbedLoop:
        """The loop with a signal added to every input, and one to every output."""
        InputError.require(self.plant, MultiChannelSystem, "plant")
        plant, agents, at_once = self.plant, self.controller.agents, self._at_once
        q = [plant.q(j) for j in range(plant.m)]
        K = [at_once(agent.input, i, plant.p(i)) for i, agent in enumerate(agents)]
        rows = [sum((plant.B(i) @ K[i] for i in range(plant.m)), Matrix.zeros(plant.n, sum(q)))]
        for i, agent in enumerate(agents):
            rows.append(at_once(agent.shared_update, i, agent.shared))
            rows.append(at_once(agent.private_update, i, agent.private))
        starts = [sum(q[:j]) for j in range(plant.m)]
        for j, (b, a) in enumerate(self.oldest):
            rows.append(Matrix.zeros(b * agents[j].shared, sum(q)))
            if a:
                rows.append(Matrix.identity(sum(q)).take(rows=range(starts[j], starts[j] + q[j])))
                rows.append(Matrix.zeros((a - 1) * q[j], sum(q)))
        B = hstack([plant.B(i) for i in range(plant.m)], nrows=plant.n)
        inputs = [self.rows(agent.input, i, plant.p(i)) for i, agent in enumerate(agents)]
        return DisturbedLoop(
            M=self.matrix,
            E=vstack([B, Matrix.zeros(self.dimension - plant.n, B.ncols)], ncols=B.ncols),
            G=vstack(rows, ncols=sum(q)),
            U=vstack(inputs, ncols=self.dimension),
            K=vstack(K, ncols=sum(q)),
            Y=plant.output_matrix() @ self.pick("x"),
        )

    @cached_property
    def steady_gain(self) -> Matrix | None:
        """Compute the gain from all set-points to all outputs at s = 0 (discrete time: z = 1).

        The gain is Σ q_i × Σ q_i; it is None if the loop has this eigenvalue.
        """
        place = steady_point(self.plant.time)
        steady = solve(Matrix.identity(self.dimension) * place - self.matrix, self.reference)
        return None if steady is None else self.plant.output_matrix() @ self.pick("x") @ steady

    @property
    def dimension(self) -> int:
        """The dimension of the loop's state."""
        return sum(size for _, size in self.blocks.values())

    def pick(self, kind: str, j: int = 0, delta: int = 0) -> Matrix:
        """Return the rows that select a block of the state; y_j at delay 0 is C_j x + D_j u."""
        if kind == "y_" and not delta and self.plant.D is not None:
            return self._state_in(kind, j) + self.plant.feedthrough_matrix([j]) @ self.inputs
        return self._state_in(kind, j, delta)

    def _state_in(self, kind: str, j: int = 0, delta: int = 0) -> Matrix:
        """The same without feedthrough: y_j at delay 0 is C_j x."""
        if kind == "y_" and not delta:
            return self.plant.C(j) @ self._state_in("x")
        start, size = self.blocks[kind, j, delta]
        before, after = Matrix.zeros(size, start), self.dimension - start - size
        return hstack([before, Matrix.identity(size), Matrix.zeros(size, after)])

    def rows(self, each: LinearMap, i: int, nrows: int) -> Matrix:
        """Return a map of agent i without set-points, as nrows rows over the loop's state."""
        return self._rows(each, i, nrows, self.pick)

    def _rows(self, each: LinearMap, i: int, nrows: int, pick: Callable[..., Matrix]) -> Matrix:
        """Return a map of agent i, of signals that are picked."""
        result = Matrix.zeros(nrows, self.dimension)
        used = each.without_zeros()
        for j, M in used.shared.items():
            result = result + M @ pick("x_", j, self.waits(j, i)[0])
        for j, M in used.outputs.items():
            result = result + M @ pick("y_", j, self.waits(j, i)[1])
        if each.private is not None:
            result = result + each.private @ pick("z_", i)
        return result


class LoopPencil(ClosedLoop):
    """The matrix Z0 of the pencil λE − Z0 of a closed loop whose y_j and u_j are signals, too.

    In the order of the loop's state, then of all y_j, then of all u_j, and without delays,

        Z0 = [A, 0, 0, B; 0, L_z, L_y, 0; C, 0, −I, 0; 0, K_z, K_y, −I],   E = diag(I, I, 0, 0).

    Every entry of the plant and of the controller is in one place, and is multiplied by no other.
    """

    @cached_property
    def blocks(self) -> Mapping[tuple[str, int, int], tuple[int, int]]:
        """The blocks of the loop, then ("y_", j, 0) and ("u_", j, 0)."""
        places = dict(super().blocks)
        position = sum(size for _, size in places.values())
        signals = [("y_", j, self.plant.q(j)) for j in range(self.plant.m)]
        signals += [("u_", j, self.plant.p(j)) for j in range(self.plant.m)]
        for kind, j, size in signals:
            places[kind, j, 0] = (position, size)
            position += size
        return places

    @property
    def states(self) -> int:
        """The dimension of the loop's state."""
        m = self.plant.m
        return self.dimension - sum(self.plant.p(j) + self.plant.q(j) for j in range(m))

    def pick(self, kind: str, j: int = 0, delta: int = 0) -> Matrix:
        """Return the rows that select a block."""
        start, size = self.blocks[kind, j, delta]
        before, after = Matrix.zeros(size, start), self.dimension - start - size
        return hstack([before, Matrix.identity(size), Matrix.zeros(size, after)])

    @cached_property
    def matrix(self) -> Matrix:
        """The matrix Z0."""
        return self.with_entries(self.plant, self.controller, 1)

    def with_entries(self, plant: MultiChannelSystem, controller: Controller, one: int) -> Matrix:
        """Put the entries of another plant and controller of the same shapes into the places of Z0.

        Parameters
        ----------
        plant : MultiChannelSystem
        controller : Controller
        one : int
            The entry for each 1 of an identity: 0 when the entries are radii, since a 1 is certain.
        """
        agents, m = controller.agents, self.plant.m
        rows = [plant.A @ self.pick("x")]
        for j in range(m):
            rows[0] = rows[0] + plant.B(j) @ self.pick("u_", j)
        for i, agent in enumerate(agents):
            rows.append(self.rows(agent.shared_update, i, agent.shared))
            rows.append(self.rows(agent.private_update, i, agent.private))
        for j, (b, a) in enumerate(self.oldest):
            rows += [self.pick("x_", j, delta) * one for delta in range(b)]
            rows += [self.pick("y_", j, delta) * one for delta in range(a)]
        rows += [plant.C(j) @ self.pick("x") - self.pick("y_", j) * one for j in range(m)]
        for i, agent in enumerate(agents):
            rows.append(self.rows(agent.input, i, plant.p(i)) - self.pick("u_", i) * one)
        return vstack(rows, ncols=self.dimension)


def closed_loop(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None = None
) -> ClosedLoop:
    """Make the closed loop of a controller that fits the system.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``; by default there are no links.

    Raises
    ------
    UsageError, InputError
        If the controller does not fit.

    Examples
    --------
    >>> from mcexact.model.controller import AgentProgram
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> agent = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.from_rows([[-3]])}))
    >>> closed_loop(plant, Controller("continuous", "", (agent,))).matrix.numerators
    ((-2,),)
    """
    system, links = with_links(system, graph)
    if links.delays:
        require_discrete(system)
    controller.require_fits(system, links)
    return ClosedLoop(system, controller, links)
