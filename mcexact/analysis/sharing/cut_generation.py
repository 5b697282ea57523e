"""Cut generation: the cheapest point of a covering program whose cuts an oracle finds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from mcexact.analysis.engine import CoveringCut, CoveringProgram, Node, Tree, branch_tree, minimize
from mcexact.analysis.sharing.separation import absence
from mcexact.answer.covering import Absence, BlocksAbsence
from mcexact.derived.modular import generator
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class CoveringProblem:
    """A covering problem whose cuts are found by an oracle.

    Attributes
    ----------
    kind : str
        The kind of the certificate, which seeds the random draws.
    program : CoveringProgram
        Prices and upper limits of the variables, without cuts.
    system : callable
        A function that makes the system for a point.
    violated : callable
        A function of a point and its system that returns necessary cuts which this point violates;
        none iff the system has the required properties.
    region : StabilityRegion or None
        The region in which modes may be fixed; None if no mode may be.
    connected : bool
        Whether the transfer graph has to be strongly connected as well.
    """

    kind: str
    program: CoveringProgram
    system: Callable[[Sequence[int]], MultiChannelSystem]
    violated: Callable[[Sequence[int], MultiChannelSystem], list[CoveringCut]]
    region: StabilityRegion | None = None
    connected: bool = False


@dataclass(frozen=True)
class CoveringOptimum:
    """A cheapest point, or None, with the evidence that no point is cheaper.

    Attributes
    ----------
    values : tuple of int, or None
        The point; None if no point satisfies all cuts.
    cost : Fraction or None
    absence : BlocksAbsence, Absence or None
        The evidence that the system has the required properties at ``values``.
    cuts : tuple of CoveringCut
    nodes : Tree
        The branch tree, in which cuts are positions in ``cuts``.
    """

    values: tuple[int, ...] | None
    cost: Fraction | None
    absence: BlocksAbsence | Absence | None
    cuts: tuple[CoveringCut, ...]
    nodes: Tree

    def with_cuts_of_leaves(self) -> CoveringOptimum:
        """The same proof without the cuts that no leaf names."""
        named = {node["violated"] for node in self.nodes if "violated" in node}
        named |= {k for node in self.nodes for k, _ in node.get("multipliers", ())}
        used = sorted(named)
        place = {k: new for new, k in enumerate(used)}

        def renumbered(node: Node) -> Node:
            if "violated" in node:
                return {"violated": place[node["violated"]]}
            if "multipliers" in node:
                return {"multipliers": [[place[k], y] for k, y in node["multipliers"]]}
            return node

        cuts = tuple(self.cuts[k] for k in used)
        return replace(self, cuts=cuts, nodes=tuple(map(renumbered, self.nodes)))

    def tree(self, key: str, labels: Sequence[Any]) -> Tree:
        """The nodes as a certificate has them: variables by their labels under ``key``."""
        return tuple(
            {key: labels[node["variable"]], "at_most": node["at_most"]}
            if "variable" in node
            else node
            for node in self.nodes
        )


def covering_optimum(problem: CoveringProblem, node_limit: int) -> CoveringOptimum:
    """Find the cheapest point that violates nothing, and prove that nothing is cheaper.

    Parameters
    ----------
    problem : CoveringProblem
    node_limit : int
        Nodes of the branch tree after which to give up, at least 1.

    Raises
    ------
    UsageError
        If the node limit is not an integer of at least 1.
    LimitReached
        At the node limit, where its ``lower`` and ``upper`` bound the least cost; or if the prices
        are too far apart.

    Notes
    -----
    A covering program proposes a point; the oracle ``problem.violated`` confirms it, or gives cuts
    that the point violates and every point that suffices satisfies.  Among the cheapest points the
    lexicographically least is taken, once one of them is confirmed.
    """
    if type(node_limit) is not int or node_limit < 1:
        expected = f"expected an integer of at least 1, found {node_limit!r}"
        raise UsageError(expected, where="node_limit")
    program, canonical = problem.program, False
    while True:
        values = minimize(program, canonical=canonical)
        if values is None:
            return CoveringOptimum(None, None, None, *_proof(program, None, node_limit))
        system = problem.system(values)
        cuts = problem.violated(values, system)
        if canonical and not cuts:
            break
        canonical = canonical or not cuts
        program = replace(program, cuts=(*program.cuts, *cuts))
    cost = program.cost(values)
    proof = _proof(program, cost, node_limit)
    rng = generator(system, problem.kind)
    evidence = absence(system, problem.region, rng, connected=problem.connected)
    return CoveringOptimum(values, cost, evidence, *proof)


def _proof(
    program: CoveringProgram, cost: Fraction | None, node_limit: int
) -> tuple[tuple[CoveringCut, ...], Tree]:
    """The cuts and the branch tree that nothing is cheaper."""
    try:
        return program.cuts, branch_tree(program, cost, node_limit=node_limit)
    except LimitReached as error:
        if error.lower is None:
            raise
        message = f"{error.message}; the least cost is between {error.lower} and {cost}"
        raise LimitReached(message, lower=error.lower, upper=cost) from None
