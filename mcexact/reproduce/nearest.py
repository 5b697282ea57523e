"""Examination of the open question, and of false statements near those of sections IV and V.

Each procedure evaluates a formula on instances where it says something, and refutes what is nearly
the same and false: the outputs of s in place of those of N_s, ranks at 0 or where λ is no
eigenvalue, delays or holding left out, the two properties of almost any gains exchanged, a least
dimension rounded down, another factor in the answer to the open question.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from mcexact.analysis.controllability import controllability_indices
from mcexact.analysis.fixed_modes import fixed_spectrum, pencil_rank
from mcexact.analysis.sharing import common_dimension, neighbor_graph, shared_dimension_bound
from mcexact.analysis.sharing_gap import extremal_plant, sharing_gap
from mcexact.derived.constructions import (
    Share,
    augmented_outputs,
    closed_by,
    dual,
    extended_system,
    held_system,
    lifted_system,
)
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.instances import (
    PROPER_SUBSETS,
    SUBSETS_OF_THREE,
    Instance,
    Numbers,
    deficient_plants,
    graph_of,
    is_late,
    late_example,
    messages_agree,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.sharing import all_ranks, boundary, printed_bound
from mcexact.synthesis.decentralized import design_extended

OUTPUTS: Share = "outputs+states"
STATES: Share = "states"

# Section IV-D: the bound, the ranks behind it, and how far it is from the least.


def bound_by_ranks(note: Notebook) -> None:
    """(26) and (27) by all ranks, with the outputs of N_s and of s."""
    for plant in note.each(deficient_plants(5)):
        bound = shared_dimension_bound(plant)
        heard, own = printed_bound(plant), printed_bound(plant, STATES)
        note.counts(bound.deficiency > 0)
        note.check(
            "(26) is n less the least rank with the outputs of N_s", bound.deficiency == heard
        )
        alone = shared_dimension_bound(plant, share=STATES)
        note.check("(27) is the same with the outputs of s", alone.deficiency == own)
        note.check("(27) is not below (26)", own >= heard >= 1)
        if own != heard:
            note.refute("own-outputs", bound.deficiency != own)
        note.certify(bound, alone)
    plant = note.at(("the example over its ring", three_channels()))
    own, heard = printed_bound(plant, STATES), printed_bound(plant)
    note.counts(heard > 0)
    note.check("the example has the bounds 1 and 1", (heard, own) == (1, 1))
    ring = extremal_plant(sharing_gap(NeighborGraph.ring(4)), STATES, dimension=2)
    plant = note.at(("four agents around a ring, who need more without outputs", ring))
    bound, alone = shared_dimension_bound(plant), shared_dimension_bound(plant, share=STATES)
    note.counts(alone.deficiency > 0)
    note.check("with outputs 0, and 4 without", (bound.deficiency, alone.deficiency) == (0, 4))
    note.refute("own-outputs", bound.deficiency != printed_bound(plant, STATES))
    note.refute("the-same", alone.deficiency != printed_bound(plant))
    note.certify(bound, alone)


def ranks_elsewhere(note: Notebook) -> None:
    """(28) to (30) as corrected, at an eigenvalue, at 0, and where λ is no eigenvalue."""
    places = {"1": 1, "0": 0, "2": 2, "a root of x^2 + 1": Polynomial.of(1, 0, 1)}
    for name, plant in _over_two_graphs():
        note.on(name, plant)
        n_i = [1, 2, 1]
        extended, before = extended_system(plant, n_i), augmented_outputs(plant)
        for s in SUBSETS_OF_THREE:
            inside = plant.indices(s)
            outside = sum(n_i[i] for i in range(3) if i not in inside)
            heard = sum(n_i[j] for j in graph_of(plant).union(inside))
            for where, root in places.items():
                after, own = pencil_rank(extended, s, root), pencil_rank(before, s, root)
                note.counts(own.rank < plant.n)
                note.check(
                    f"s = {{{', '.join(s)}}}, λ = {where}: rank M̄ is rank M + {outside} + {heard}",
                    after.rank == own.rank + outside + heard,
                )
                if where == "0":
                    note.refute("0-without-neighbors", after.rank != own.rank + outside)
                    note.certify(after)
                if where == "2":
                    note.refute("full-elsewhere", after.rank > extended.n)
                    note.check("no rank is lost where λ is no eigenvalue", own.rank >= plant.n)
                if where == "1" and own.rank < plant.n:
                    note.refute("nothing-lost")
                    note.certify(own)


def rounded(note: Notebook) -> None:
    """The least common dimension is the largest δ_s(λ) / |N_s∖s|, rounded up."""
    instances: list[Instance] = [_between_two(size) for size in (1, 2, 3, 5)]
    for plant in note.each(instances, deficient_plants(3, first=31)):
        common, bound = common_dimension(plant), shared_dimension_bound(plant)
        note.counts(bound.deficiency > 0)
        quotients = [
            Fraction(plant.n - each.rank, len(boundary(plant, tuple(each.subset))))
            for each in all_ranks(plant)
        ]
        up, down = max(-(-q // 1) for q in quotients), max(q // 1 for q in quotients)
        note.check("it is the largest quotient, rounded up", common.dimension == up)
        enough = fixed_spectrum(extended_system(plant, [int(up)] * plant.m))
        note.check("which leaves nothing fixed", enough.empty)
        note.certify(common, enough)
        if down < up:
            short = fixed_spectrum(extended_system(plant, [int(down)] * plant.m))
            note.refute("rounded-down", not short.empty)
            note.certify(short)
        if up < bound.deficiency:
            note.refute("the-bound", common.dimension != bound.deficiency)


def factors_of_graphs(note: Notebook) -> None:
    """The open question: (26) and (27) exceed the least by the factors β and m − γ, and no more."""
    for graph, relays, outside in (
        (NeighborGraph.ring(6), 2, 3),
        (NeighborGraph.ring(3), 1, 1),
        (_diamond(5), 3, 3),
        (_star(4), 1, 3),
    ):
        gap = sharing_gap(graph)
        name = f"the graph N_i = {[[j + 1 for j in N] for N in graph.neighbors]}"
        note.on(name)
        note.check("the largest number of relays", gap.relays == gap.relays_at_most == relays)
        note.check("the largest boundary", gap.boundary == gap.boundary_at_most == outside)
        note.certify(gap)
        for share, factor in ((OUTPUTS, relays), (STATES, outside)):
            for time, c in (("continuous", 1), ("discrete", 2)):
                plant = extremal_plant(gap, share, dimension=c, eigenvalue="1/2", time=time)
                note.on(f"the plant for {share} over {name}, c = {c}", plant)
                bound = shared_dimension_bound(plant, share=share)
                common = common_dimension(plant, share=share)
                note.counts(bound.deficiency == factor * c)
                note.check("the least common dimension is c", common.dimension == c)
                note.check("the bound is the factor times c", bound.deficiency == factor * c)
                note.joint(plant)
                note.certify(bound, common)
                if factor > 1:
                    note.refute("tight", bound.deficiency > c)
                if factor > 2:
                    note.refute("twice", bound.deficiency > 2 * c)
                if share == STATES and factor > graph.m - 2:
                    note.refute("m-2", bound.deficiency > (graph.m - 2) * c)


def both_kinds(note: Notebook) -> None:
    """Strongly connected iff every nonempty proper s has N_s ≠ s, on graphs of both kinds."""
    seen = {True: 0, False: 0}
    for number, heard in enumerate(_graphs()):
        names = [str(i + 1) for i in range(len(heard))]
        graph = NeighborGraph(names, heard)
        plant = MultiChannelSystem(
            [[0]], [[[1]] for _ in names], [[[1]] for _ in names], neighbors=graph
        )
        note.on(f"graph {number + 1}, N_i = {[[j + 1 for j in N] for N in graph.neighbors]}")
        found = neighbor_graph(plant)
        m = len(names)
        proper = PROPER_SUBSETS[m]
        note.counts(bool(proper))
        receives = all(set(graph.union(s)) != set(s) for s in proper)
        note.check("strongly connected iff every s receives", found.strongly_connected == receives)
        note.certify(found)
        seen[found.strongly_connected] += 1
        each_alone = all(len(N) > 1 for N in graph.neighbors)
        if each_alone and not found.strongly_connected:
            note.refute("single-agents")
        sends = all(any(i in N and k != i for k, N in enumerate(graph.neighbors)) for i in range(m))
        if sends and each_alone and not found.strongly_connected:
            note.refute("both-ways")
    note.check("there are three of either kind", min(seen.values()) >= 3)


def almost_any_exchanged(note: Notebook) -> None:
    """Gains for which a channel controls the whole state, and gains for which it observes it."""
    numbers = Numbers(41, largest=9)
    for name, plant, controls, observes in _one_sided():
        note.on(name, plant)
        note.counts(controls != observes)
        for _ in range(4):
            F = numbers.gains(plant)
            closed = closed_by(plant, F)
            system = MultiChannelSystem(closed, [plant.B(0)], [plant.C(0)])
            reach = controllability_indices(system).index is not None
            view = controllability_indices(dual(system)).index is not None
            note.check("what almost any gains do", (reach, view) == (controls, observes))
            if reach != view:
                note.refute("controls-so-observes" if reach else "observes-so-controls")
        note.certify(controllability_indices(plant), controllability_indices(dual(plant)))


# Section V: what delays and holding are for.


def delays_left_out(note: Notebook) -> None:
    """Messages over late links are those of the lifted and of the held system, and no others."""
    numbers = Numbers(42)
    for delay in (1, 2):
        plant = note.at(late_example(delay))
        note.counts(is_late(plant))
        sizes = [1, 2, 1]
        lifted, held = lifted_system(plant, sizes), held_system(plant, sizes)
        graph = graph_of(plant)
        pairs = [(i, j) for i in range(plant.m) for j in graph.neighborhood(i)]
        late = {(i, j): graph.delay(i, j) for i, j in pairs}
        all_late = {(i, j): graph.longest_delay(j) for i, j in pairs}
        at_once = dict.fromkeys(pairs, 0)
        note.check("lifted", messages_agree(plant, lifted, sizes, OUTPUTS, late, numbers))
        note.refute("no-delay", not messages_agree(plant, lifted, sizes, OUTPUTS, at_once, numbers))
        note.check("held", messages_agree(plant, held, sizes, STATES, all_late, numbers))
        note.refute("no-holding", not messages_agree(plant, held, sizes, STATES, late, numbers))
        kept = plant.n + (1 + delay) * sum(sizes)
        outputs = delay * sum(plant.q(i) for i in range(plant.m))
        note.check("the held system keeps sub-states", held.n == kept)
        note.check("the lifted one also outputs", lifted.n == kept + outputs)
        note.certify(fixed_spectrum(held))


def spectra_without_zero(note: Notebook) -> None:
    """A spectrum none of which is 0 is assigned with holding, and impossible without it."""
    plant = note.at(late_example(1))
    note.counts(is_late(plant))
    sizes = (1, 1, 1)
    least = design_extended(
        plant, plant.neighbors, "1", network="held", dimensions=sizes, radius="1/2"
    )
    degree = least.loop.matrix.nrows
    roots = [Fraction(1 + k % 3, 5) for k in range(degree)]
    design = design_extended(plant, network="held", dimensions=sizes, spectrum=roots)
    polynomial = characteristic_polynomial(design.loop.matrix)
    note.check("the loop has the prescribed spectrum", polynomial == Polynomial.from_roots(roots))
    note.check("none of which is 0", polynomial(0) != 0)
    note.certify(*design.certificates.values())
    lifted = lifted_system(plant, sizes)
    spectrum = fixed_spectrum(lifted)
    note.check("without holding 0 is fixed", spectrum.polynomial == Polynomial.x())
    note.certify(spectrum)
    note.refute("without-holding", spectrum.polynomial(0) == 0)
    note.refute("always-0", polynomial(0) != 0)


# The instances.


def _between_two(size: int) -> Instance:
    """Four agents: 2 and 3 relay between 1, which drives everything, and 4, which measures it."""
    n = size + 2
    whole, one = Matrix.identity(n), Matrix.identity(n).take(cols=[0])
    graph = NeighborGraph(["1", "2", "3", "4"], [[1, 2], [3], [3], [0]])
    B, C = [whole, one, one, one], [one.T, one.T, one.T, whole]
    plant = MultiChannelSystem(whole, B, C, neighbors=graph)
    return f"two agents between two, {n} states", plant


def _over_two_graphs() -> Iterator[Instance]:
    plant = three_channels()
    yield "the example over its ring", plant
    complete = plant.with_neighbors(NeighborGraph.complete(plant.names))
    yield "the example over the complete graph", complete


def _diamond(m: int) -> NeighborGraph:
    middle = [[m - 1] for _ in range(m - 2)]
    return NeighborGraph([str(i + 1) for i in range(m)], [range(m - 1), *middle, [0]])


def _star(m: int) -> NeighborGraph:
    return NeighborGraph([str(i + 1) for i in range(m)], [range(m), *([[0]] * (m - 1))])


def _graphs() -> Iterator[list[list[int]]]:
    """Connected and not: rings, with and without a link, two circles, one way between two."""
    for m in (3, 4):
        yield [[(i + 1) % m] for i in range(m)]
        yield [[(i + 1) % m] if i else [] for i in range(m)]
    yield [[1, 2], [0], [0]]
    yield [[1], [0], [3], [2]]
    yield [[1], [0], [3, 0], [2]]
    yield [[1], [0, 2], [3], [2, 1]]


def _one_sided() -> Iterator[tuple[str, MultiChannelSystem, bool, bool]]:
    """One channel that controls or observes the whole state, both, or neither."""
    A, b, e = [[1, 0], [0, 2]], [[1], [1]], [[1], [0]]
    c, r = [[1, 1]], [[1, 0]]
    for B, controls in ((b, True), (e, False)):
        for C, observes in ((c, True), (r, False)):
            name = f"two modes, B = {B}, C = {C}"
            yield name, MultiChannelSystem(A, [B], [C]), controls, observes


NEAREST: dict[str, Procedure] = {
    "bound-by-ranks": bound_by_ranks,
    "ranks-elsewhere": ranks_elsewhere,
    "rounded": rounded,
    "factors": factors_of_graphs,
    "both-kinds": both_kinds,
    "almost-any-exchanged": almost_any_exchanged,
    "delays-left-out": delays_left_out,
    "spectra-without-zero": spectra_without_zero,
}
