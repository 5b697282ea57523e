"""The matrix of a whole loop: plant, agents' states, and messages under way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from mcexact.errors import UsageError
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import Controller, LinearMap
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, require_discrete, with_links


@dataclass(frozen=True)
class LoopLayout:
    """Where everything stands in the state of a closed loop.

    The state is (x, x_1, z_1, x_2, z_2, …, x_m, z_m), then for each agent j in order
    x_j(t−1), …, x_j(t−b_j), y_j(t−1), …, y_j(t−a_j), with b_j and a_j the longest delays with which
    any program uses x_j and y_j, holding included.

    Attributes
    ----------
    system : MultiChannelSystem
    controller : Controller
    graph : NeighborGraph
    """

    system: MultiChannelSystem
    controller: Controller
    graph: NeighborGraph

    def waits(self, j: int, i: int) -> tuple[int, int]:
        """How old x_j and y_j are when agent i uses them."""
        link = self.graph.delay(i, j) if i != j else 0
        return link + self.controller.agents[j].hold.get(i, 0), link

    @cached_property
    def oldest(self) -> tuple[tuple[int, int], ...]:
        """(b_j, a_j) for each agent j."""
        longest = [[0, 0] for _ in self.controller.agents]
        for i, agent in enumerate(self.controller.agents):
            for each in agent.maps():
                # What is multiplied by zeros is not used, and is not written to files either.
                used_for = each.without_zeros()
                for kind, used in enumerate((used_for.shared, used_for.outputs)):
                    for j in used:
                        longest[j][kind] = max(longest[j][kind], self.waits(j, i)[kind])
        return tuple((b, a) for b, a in longest)

    @cached_property
    def blocks(self) -> Mapping[tuple[str, int, int], tuple[int, int]]:
        """First position and size of ("x", 0, 0), ("x_", j, δ), ("z_", j, 0) and ("y_", j, δ)."""
        found: dict[tuple[str, int, int], tuple[int, int]] = {("x", 0, 0): (0, self.system.n)}
        position = self.system.n
        order: list[tuple[str, int, int, int]] = []
        for j, agent in enumerate(self.controller.agents):
            order += [("x_", j, 0, agent.shared), ("z_", j, 0, agent.private)]
        for j, agent in enumerate(self.controller.agents):
            b, a = self.oldest[j]
            order += [("x_", j, delta, agent.shared) for delta in range(1, b + 1)]
            order += [("y_", j, delta, self.system.q(j)) for delta in range(1, a + 1)]
        for kind, j, delta, size in order:
            found[kind, j, delta] = (position, size)
            position += size
        return found

    @property
    def dimension(self) -> int:
        """The dimension of the whole state."""
        return sum(size for _, size in self.blocks.values())

    def pick(self, kind: str, j: int = 0, delta: int = 0) -> Matrix:
        """The rows that read a block from the state; y_j at delay 0 is C_j x."""
        if kind == "y_" and not delta:
            return self.system.C(j) @ self.pick("x")
        start, size = self.blocks[kind, j, delta]
        before, after = Matrix.zeros(size, start), self.dimension - start - size
        return hstack([before, Matrix.identity(size), Matrix.zeros(size, after)])

    def rows(self, each: LinearMap, i: int, nrows: int) -> Matrix:
        """What a map of agent i computes, nrows rows over the whole state, without set-points."""
        result = Matrix.zeros(nrows, self.dimension)
        used = each.without_zeros()
        for j, M in used.shared.items():
            result = result + M @ self.pick("x_", j, self.waits(j, i)[0])
        for j, M in used.outputs.items():
            result = result + M @ self.pick("y_", j, self.waits(j, i)[1])
        if each.private is not None:
            result = result + each.private @ self.pick("z_", i)
        return result


def loop_layout(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None = None
) -> LoopLayout:
    """Check that the controller fits, and lay out the state of the loop.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``; without either nobody hears anybody.

    Raises
    ------
    UsageError, InputError
        If the controller does not fit.
    """
    system, found = with_links(system, graph)
    if found.delays:
        require_discrete(system)
    controller.require_fits(system, found)
    return LoopLayout(system, controller, found)


def closed_loop_matrix(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None = None
) -> Matrix:
    """Assemble the matrix of the whole loop from the agents' own programs.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    Matrix
        N×N, state as in `LoopLayout`.

    Examples
    --------
    >>> from mcexact.model.controller import AgentProgram
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> agent = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.from_rows([[-3]])}))
    >>> closed_loop_matrix(plant, Controller("continuous", "", (agent,))).numerators
    ((-2,),)
    """
    return _assembled(loop_layout(system, controller, graph))


def _assembled(layout: LoopLayout) -> Matrix:
    """The rows of every block, in the order of the state."""
    system, agents = layout.system, layout.controller.agents
    plant = system.A @ layout.pick("x")
    for i, agent in enumerate(agents):
        plant = plant + system.B(i) @ layout.rows(agent.input, i, system.p(i))
    rows = [plant]
    for i, agent in enumerate(agents):
        rows.append(layout.rows(agent.shared_update, i, agent.shared))
        rows.append(layout.rows(agent.private_update, i, agent.private))
    for j in range(system.m):
        b, a = layout.oldest[j]
        rows += [layout.pick("x_", j, delta) for delta in range(b)]
        rows += [layout.pick("y_", j, delta) for delta in range(a)]
    return vstack(rows, ncols=layout.dimension)


def reference_matrix(layout: LoopLayout) -> Matrix:
    """What the set-points (r_1, …, r_m) add to the loop, N×Σ q_i."""
    system, agents = layout.system, layout.controller.agents
    total = sum(system.q(i) for i in range(system.m))

    def spread(each: LinearMap, i: int, nrows: int) -> Matrix:
        if each.reference is None:
            return Matrix.zeros(nrows, total)
        left = sum(system.q(k) for k in range(i))
        right = total - left - system.q(i)
        return hstack([Matrix.zeros(nrows, left), each.reference, Matrix.zeros(nrows, right)])

    plant = Matrix.zeros(system.n, total)
    for i, agent in enumerate(agents):
        plant = plant + system.B(i) @ spread(agent.input, i, system.p(i))
    rows = [plant]
    for i, agent in enumerate(agents):
        rows.append(spread(agent.shared_update, i, agent.shared))
        rows.append(spread(agent.private_update, i, agent.private))
    known = sum(M.nrows for M in rows)
    rows.append(Matrix.zeros(layout.dimension - known, total))
    return vstack(rows, ncols=total)


def closed_loop(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """The whole loop as a system without channels, which remembers the plant and the controller.

    Raises
    ------
    UsageError
        If the system is not a plant: a controller runs on the plant itself.
    """
    layout = loop_layout(system, controller, graph)
    if layout.system.subject:
        raise UsageError("a controller closes the loop around a plant, not a derived system")
    construction = {"construction": "closed_loop", "controller": controller.document()}
    return layout.system.derived(_assembled(layout), (), (), construction)
