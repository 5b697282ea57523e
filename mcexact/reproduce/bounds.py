"""Section IV-D: dimensions of shared sub-states that leave no fixed mode."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from mcexact.analysis.analyze import analyze
from mcexact.analysis.controllability import joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum, pencil_rank
from mcexact.analysis.questions import SHARES
from mcexact.analysis.sharing import (
    base_system,
    common_dimension,
    minimal_shared_dimensions,
    neighbor_graph,
    shared_dimension_bound,
)
from mcexact.answer.modes import FixedSpectrum, PencilRank
from mcexact.derived.constructions import Share, augmented_outputs, extended_system
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import LEAST, dimensions_picture
from mcexact.reproduce.extended import SHARING
from mcexact.reproduce.material import (
    PAPER,
    PROPER_SUBSETS,
    SUBSETS_OF_THREE,
    deficient_plants,
    drawn_plants,
    graph_of,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import four_agents, still_pair, two_between, two_circles


def all_ranks(plant: MultiChannelSystem, share: str = "outputs+states") -> Iterator[PencilRank]:
    """The ranks in the bound of Theorem 2 (Remark 2): every nonempty proper s, every eigenvalue."""
    base = base_system(plant, share)
    factors = [factor for factor, _ in characteristic_polynomial(plant.A).factor()]
    for s in PROPER_SUBSETS[plant.m]:
        for factor in factors:
            yield pencil_rank(base, [plant.names[i] for i in s], factor)


def printed_bound(plant: MultiChannelSystem, share: str = "outputs+states") -> int:
    """n minus the least rank, as printed: below 0 if all ranks exceed n."""
    return plant.n - min(each.rank for each in all_ranks(plant, share))


def boundary(plant: MultiChannelSystem, s: tuple[str, ...]) -> set[str]:
    """N_s∖s, by names."""
    return {plant.names[j] for j in graph_of(plant).union(plant.indices(s))} - set(s)


def rank_identity(note: Notebook) -> None:
    """(28), (29), and (30) as corrected: a neighbor of several members counts once."""
    plant = three_channels()
    graph = graph_of(plant)
    sizes = [1, 2, 1]
    chosen: list[tuple[str, MultiChannelSystem, list[int]]] = [(PAPER, plant, sizes)]
    complete = plant.with_neighbors(NeighborGraph.complete(plant.names))
    chosen.append((f"{PAPER}, over the complete graph", complete, [1, 1, 1]))
    for name, system, n_i in chosen:
        note.on(name, system)
        graph = graph_of(system)
        extended = extended_system(system, n_i)
        before = augmented_outputs(system)
        for s in SUBSETS_OF_THREE:
            inside = system.indices(s)
            outside = sum(n_i[i] for i in range(3) if i not in inside)
            heard = sum(n_i[j] for j in graph.union(inside))
            after, own = pencil_rank(extended, s, 1), pencil_rank(before, s, 1)
            note.check(
                f"s = {{{', '.join(s)}}}: rank M̄ is rank M plus n_i outside s plus n_j over N_s",
                after.rank == own.rank + outside + heard,
            )
            note.certify(after, own)
            twice = sum(n_i[j] for i in inside for j in graph.neighborhood(i))
            if twice != heard:
                note.refute("as-printed", after.rank != own.rank + outside + twice)
            if heard != sum(n_i[j] for j in inside):
                own_only = sum(n_i[j] for j in inside)
                note.refute("s-alone", after.rank != own.rank + outside + own_only)


def theorem_2(note: Notebook) -> None:
    """Theorem 2, with every n_i at the bound."""
    for plant in note.each(plants(8), drawn_plants(3, fixed=True, states=4, first=41)):
        bound = shared_dimension_bound(plant)
        found = fixed_spectrum(extended_system(plant, [bound.deficiency] * plant.m))
        note.check(f"nothing is fixed with n_i = {bound.deficiency}", found.empty)
        note.certify(neighbor_graph(plant), bound, found)
    _less_than_the_bound(note, "outputs+states")
    plant = note.at(two_circles())
    bound = shared_dimension_bound(plant)
    found = fixed_spectrum(extended_system(plant, [bound.deficiency] * plant.m))
    note.refute("any-graph", not found.empty)
    note.certify(neighbor_graph(plant), bound, found)


def _less_than_the_bound(note: Notebook, share: Share) -> None:
    """Plants with the bounds 1, 2 and 3: one less leaves a mode fixed where the bound is tight."""
    for plant in note.each(deficient_plants(7, share=share)):
        bound, least = (
            shared_dimension_bound(plant, share=share),
            common_dimension(plant, share=share),
        )
        enough = fixed_spectrum(extended_system(plant, [bound.deficiency] * plant.m, share))
        note.check(f"nothing is fixed with n_i = {bound.deficiency}", enough.empty)
        nothing = fixed_spectrum(extended_system(plant, [0] * plant.m, share))
        note.refute("n_i=0", not nothing.empty)
        if least.dimension == bound.deficiency:
            less = fixed_spectrum(extended_system(plant, [bound.deficiency - 1] * plant.m, share))
            note.refute("bound-1", not less.empty)
            note.certify(less)
        note.certify(bound, enough, nothing)


def bound_zero(note: Notebook) -> None:
    """Without fixed modes the bound is at most 0, and no sub-state has to be shared."""
    for name, plant in (*drawn_plants(16, channels=2, first=51), still_pair()):
        found = fixed_spectrum(plant)
        if not found.empty:
            continue
        note.on(name, plant)
        for share in SHARING:
            bound, printed = shared_dimension_bound(plant, share=share), printed_bound(plant, share)
            note.check(f"no rank is below n ({share})", printed <= 0)
            note.check(f"no dimension is needed ({share})", bound.deficiency == 0)
            note.certify(bound)
        note.certify(found)
    plant = note.at(still_pair())
    note.print(plant)
    note.certify(*all_ranks(plant))
    note.refute("zero", printed_bound(plant) == -1)


def falls_short(plant: MultiChannelSystem, agent: int) -> FixedSpectrum:
    """The fixed spectrum where one agent shares one state less than the bound, all others meet it.

    A subset s violates that iff Σ n_i over N_s∖s is below its deficiency, which is at most ρ: iff
    N_s∖s holds no other agent and the deficiency is ρ.  So it is empty iff the bound, if it is at
    least 1, is not reached for this agent.
    """
    bound = shared_dimension_bound(plant).deficiency
    return fixed_spectrum(extended_system(plant, [bound - (i == agent) for i in range(plant.m)]))


def bound_reached(note: Notebook) -> None:
    """A bound of at least 1 is attained for agent i iff some s has N_s∖s = {i} and least rank."""
    for name, plant in ((PAPER, three_channels()), four_agents()):
        note.on(name, plant)
        ranks = list(all_ranks(plant))
        least = min(each.rank for each in ranks)
        note.check("the bound is at least 1", plant.n - least >= 1)
        for i, agent in enumerate(plant.names):
            alone = [each for each in ranks if boundary(plant, each.subset) == {agent}]
            short = falls_short(plant, i)
            note.check(
                f"agent {agent}: the criterion decides",
                any(each.rank == least for each in alone) != short.empty,
            )
            note.certify(short)
        note.certify(*(each for each in ranks if each.rank == least))
        if name == four_agents()[0]:
            among = [each for each in ranks if each.rank == least]
            some = any("2" in boundary(plant, each.subset) for each in among)
            note.refute("among-others", some and falls_short(plant, 1).empty)
    for plant in note.each(deficient_plants(3)):
        bound = shared_dimension_bound(plant).deficiency
        ranks = list(all_ranks(plant))
        note.check("the bound is the printed one", plant.n - min(r.rank for r in ranks) == bound)
        for i, agent in enumerate(plant.names):
            alone = [each for each in ranks if boundary(plant, each.subset) == {agent}]
            short = falls_short(plant, i)
            attained = any(plant.n - each.rank == bound for each in alone)
            note.check(f"agent {agent}: the criterion decides", attained != short.empty)
            note.certify(short)
    pair = note.at(still_pair())
    ranks = list(all_ranks(pair))
    note.certify(*ranks, shared_dimension_bound(pair))
    least = min(each.rank for each in ranks)
    met = [
        any(each.rank == least and boundary(pair, each.subset) == {name} for each in ranks)
        for name in pair.names
    ]
    # The criterion holds for both agents, and no dimension is −1.
    note.refute("below-1", all(met) and pair.n - least == -1)


def tightness(note: Notebook) -> None:
    """Whether the bound is tight, an open question of the paper: it is not.

    If all agents share equally many sub-states, a bound of 1 is least; a larger one need not be.
    """
    plant = three_channels()
    note.on(PAPER, plant)
    found = analyze(plant, also=LEAST.values())
    for share, total in zip(SHARING, (1, 2), strict=True):
        stem = SHARES[share]
        bound = found[f"shared_dimension_bound_{stem}"]
        least = found[f"minimal_shared_dimensions_{stem}"]
        note.check(f"{total} shared in all is the least ({share})", least.total == total)
        note.check("the bound asks for more", bound.total > total)
        common = found[f"common_dimension_{stem}"]
        note.check("as all share the same it is the least", common.dimension == bound.deficiency)
        note.certify(bound, least, common)
    note.show(dimensions_picture(found.account))
    for instance in (two_between(), four_agents()):
        plant = note.at(instance)
        bound, common = shared_dimension_bound(plant), common_dimension(plant)
        both = (bound.deficiency, common.dimension)
        note.check("the bound is 2, and n_i = 1 for all suffices", both == (2, 1))
        note.certify(bound, common)
        note.refute("tight", both == (2, 1))
    # The last plant meets all assumptions of the paper, B_i ≠ 0 and C_i ≠ 0 among them.
    note.print(plant)
    note.joint(plant)
    for sizes in ([1, 1, 1, 1], [0, 1, 1, 0]):
        freed = fixed_spectrum(extended_system(plant, sizes))
        note.check(f"n_i = {sizes} leaves nothing fixed", freed.empty)
        note.certify(freed)
    bound, common = (
        shared_dimension_bound(plant, share="states"),
        common_dimension(plant, share="states"),
    )
    note.check("with sub-states alone 2 is the least", bound.deficiency == common.dimension == 2)
    note.certify(bound, common)


def remark_2(note: Notebook) -> None:
    """Remark 2: sub-states alone, with its own bound."""
    for plant in note.each(plants(8), drawn_plants(2, fixed=True, states=4, first=41)):
        bound = shared_dimension_bound(plant, share="states")
        made = extended_system(plant, [bound.deficiency] * plant.m, "states")
        found, sight = fixed_spectrum(made), joint_observability(made)
        note.check("nothing is fixed at the bound of the remark", found.empty)
        note.check("it is jointly observable", sight.controllable)
        weaker = shared_dimension_bound(plant)
        note.check("which is at least that of Theorem 2", bound.deficiency >= weaker.deficiency)
        note.certify(bound, weaker, found, sight)
        if weaker.deficiency < bound.deficiency:
            short = fixed_spectrum(extended_system(plant, [weaker.deficiency] * plant.m, "states"))
            if not short.empty:
                note.refute("(26)")
            note.certify(short)
    _less_than_the_bound(note, "states")


def every_subset_receives(note: Notebook) -> None:
    """Strongly connected iff N_s∖s is never empty: all 64 graphs with three agents."""
    plant = three_channels()
    names, channels = plant.names, range(3)
    both = set()
    for links in product((False, True), repeat=6):
        heard = iter(links)
        neighbors = [[j for j in channels if j == i or next(heard)] for i in channels]
        graph = NeighborGraph(names, neighbors)
        edges = ", ".join(f"{names[j]} → {names[i]}" for j, i in graph.edges()) or "none"
        note.on(f"three agents, links: {edges}")
        receives = all(
            {names[j] for j in graph.union([names.index(i) for i in s])} - set(s)
            for s in SUBSETS_OF_THREE
        )
        found = neighbor_graph(plant.with_neighbors(graph))
        note.check(
            "strongly connected just when every subset receives messages from outside",
            found.strongly_connected == receives,
        )
        if receives not in both:
            both.add(receives)
            note.certify(found)
    note.check("both are among them", both == {True, False})
    plant = note.at(two_circles())
    hears = all(len(graph_of(plant).neighborhood(i)) > 1 for i in range(plant.m))
    note.refute("single-agents", hears and not graph_of(plant).is_strongly_connected())
    note.certify(neighbor_graph(plant))


def sub_states_needed(note: Notebook) -> None:
    """Sub-states have to be shared if and only if sharing outputs leaves a mode fixed."""
    for plant in note.each(plants(8), drawn_plants(3, fixed=True, states=4, first=44)):
        alone, least = fixed_spectrum(augmented_outputs(plant)), minimal_shared_dimensions(plant)
        note.check("some dimensions suffice", least.feasible)
        note.check("none are needed just when nothing is fixed", (least.total == 0) == alone.empty)
        note.certify(alone, least)
        if least.total == 0:
            note.refute("always", alone.empty)
    for plant in note.each(deficient_plants(7)):
        alone, least = fixed_spectrum(augmented_outputs(plant)), minimal_shared_dimensions(plant)
        note.refute("never", not alone.empty and (least.total or 0) > 0)
        note.certify(alone, least)


PROCEDURES: dict[str, Procedure] = {
    "equations-28-30": rank_identity,
    "theorem-2": theorem_2,
    "bound-zero": bound_zero,
    "bound-reached": bound_reached,
    "tight": tightness,
    "remark-2": remark_2,
    "every-subset": every_subset_receives,
    "necessary": sub_states_needed,
}
