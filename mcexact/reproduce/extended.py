"""Section IV-C to IV-E: extended systems, least sharing, free assignment."""

from __future__ import annotations

from mcexact.analysis.analyze import analyze
from mcexact.analysis.fixed_modes.completeness import completeness
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.fixed_modes.pencil import pencil_rank
from mcexact.analysis.fixed_modes.single_channel_gains import single_channel_gains
from mcexact.analysis.questions import SHARES
from mcexact.analysis.sharing.allocation import (
    minimal_shared_dimensions,
    shared_dimension_bound,
)
from mcexact.analysis.sharing.common_dimension import common_dimension
from mcexact.analysis.sharing.neighbor_graph import neighbor_graph
from mcexact.analysis.structure.controllability import joint_observability
from mcexact.analysis.structure.transfer_graph import transfer_graph
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.derived.augmented_outputs import augmented_outputs
from mcexact.derived.extended import Share, extended_system
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.graph_figures import LEAST, dimensions_picture
from mcexact.reproduce.equations import messages_agree, positions, union_of_graphs
from mcexact.reproduce.figures import spectrum_picture
from mcexact.reproduce.material import (
    PAPER,
    SUBSETS_OF_THREE,
    Instance,
    Numbers,
    drawn_plants,
    graph_of,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.synthesis.extended import design_extended
from mcexact.synthesis.optimum.aims import THEOREM

SHARING: tuple[Share, ...] = ("outputs+states", "states")


def _still_pair() -> Instance:
    """Two agents that exchange messages, with one state that each controls and observes."""
    one = [[1]]
    plant = MultiChannelSystem([[0]], [one] * 2, [one] * 2)
    return "A = 0, two equal agents", plant.with_neighbors(NeighborGraph.complete(plant.names))


def _two_between() -> Instance:
    """Agent 1 drives two integrators, 4 measures them, and 1 receives from 2 and 3 alone."""
    units: list[list[int]] = [[1, 0], [0, 1]]
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]],
        [units, *[[[], []]] * 3],
        [*[[]] * 3, units],
        neighbors={"1": ["2", "3"], "2": ["4"], "3": ["4"], "4": ["1"]},
    )
    return "A = 0, two agents between those who drive and measure", plant


def split_spectrum() -> Instance:
    """The instance of the erratum: no mode is fixed, and yet the spectrum splits."""
    e1, e2 = [[1], [0]], [[0], [1]]
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]],
        [e1, e2, e2],
        [[[1, 0]], [[1, 0]], [[0, 1]]],
        neighbors={"1": ["2"], "2": ["3"], "3": ["1"]},
    )
    return "A = 0 on a cycle, nothing shared", plant


def construction(note: Notebook) -> None:
    """`bun` and `emcs`."""
    numbers = Numbers(14)
    for name, plant in plants(10, connected=None):
        sizes = [k % 3 for k in range(1, plant.m + 1)]
        for share in SHARING:
            note.on(f"{name}, n_i = {sizes}, {share}")
            made = extended_system(plant, sizes, share)
            note.check("there are n + Σ n_i states", made.n == plant.n + sum(sizes))
            note.check(
                "ẋ_i = v_i, and agents see what `emcs` says",
                messages_agree(plant, made, sizes, share, {}, numbers),
            )
            note.certify(fixed_spectrum(made))


def any_graph(note: Notebook) -> None:
    """Jointly controllable and observable for every graph."""
    for name, plant in (*plants(5, connected=None), *plants(1, connected=False)):
        for share in SHARING:
            note.on(f"{name}, {share}")
            made = extended_system(plant, [1] * plant.m, share)
            note.joint(made)


def rank_identity(note: Notebook) -> None:
    """`funch`, `dear`, and `pppp` as corrected: a neighbor of several members counts once."""
    plant = three_channels()
    graph = graph_of(plant)
    sizes = [1, 2, 1]
    chosen: list[tuple[str, MultiChannelSystem, list[int]]] = [(PAPER, plant, sizes)]
    complete = plant.with_neighbors(NeighborGraph.complete(plant.names))
    chosen.append((f"{PAPER}, over the complete graph", complete, [1, 1, 1]))
    for name, system, n_i in chosen:
        note.on(name)
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


def theorem_2(note: Notebook) -> None:
    """Theorem 2, with every n_i at the bound."""
    for plant in note.each(plants(8), drawn_plants(3, fixed=True, states=4, first=41)):
        bound = shared_dimension_bound(plant)
        found = fixed_spectrum(extended_system(plant, [bound.deficiency] * plant.m))
        note.check(f"nothing is fixed with n_i = {bound.deficiency}", found.empty)
        note.certify(neighbor_graph(plant), bound, found)


def bound_zero(note: Notebook) -> None:
    """Without fixed modes the bound is 0."""
    for name, plant in (*drawn_plants(16, channels=2, first=51), _still_pair()):
        found = fixed_spectrum(plant)
        if not found.empty:
            continue
        note.on(name)
        for share in SHARING:
            bound = shared_dimension_bound(plant, share=share)
            note.check(f"nothing is fixed, and the bound is 0 ({share})", bound.deficiency == 0)
            note.certify(bound)
        note.certify(found)


def falls_short(plant: MultiChannelSystem, agent: int) -> FixedSpectrum:
    """The fixed spectrum where one agent shares one state less than the bound, all others meet it.

    A subset s violates that iff Σ n_i over N_s∖s is below its deficiency, which is at most ρ: iff
    N_s∖s holds no other agent and the deficiency is ρ.  So it is empty iff the bound, if it is at
    least 1, is not reached for this agent.
    """
    bound = shared_dimension_bound(plant).deficiency
    return fixed_spectrum(extended_system(plant, [bound - (i == agent) for i in range(plant.m)]))


def bound_reached(note: Notebook) -> None:
    """The bound is attained for agent i iff some s has N_s∖s = {i} and the least rank."""
    plant = three_channels()
    graph, before = graph_of(plant), augmented_outputs(plant)
    note.on(PAPER)
    ranks = {s: pencil_rank(before, s, 1) for s in SUBSETS_OF_THREE}
    least = min(each.rank for each in ranks.values())
    for i, agent in enumerate(plant.names):
        some = any(
            ranks[s].rank == least
            and set(graph.union(plant.indices(s))) - set(plant.indices(s)) == {i}
            for s in SUBSETS_OF_THREE
        )
        short = falls_short(plant, i)
        note.check(f"agent {agent}: the criterion decides", some != short.empty)
        note.certify(short)
    note.certify(*ranks.values())
    pair = note.at(_still_pair())
    bound = shared_dimension_bound(pair)
    note.check("a bound of 0 is reached, and no agent could share less", bound.deficiency == 0)
    note.certify(bound)


def tightness(note: Notebook) -> None:
    """Whether the bound is tight, an open question of the paper; on its example it is not.

    If all agents share equally many sub-states, a bound of 1 is least; a larger one need not be.
    """
    plant = three_channels()
    note.on(PAPER)
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
    name, plant = _two_between()
    note.on(name)
    bound, common = shared_dimension_bound(plant), common_dimension(plant)
    note.check(
        "a bound of 2 asks for twice the least", (bound.deficiency, common.dimension) == (2, 1)
    )
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


def every_subset_receives(note: Notebook) -> None:
    """Strongly connected iff N_s∖s is never empty."""
    chosen: list[NeighborGraph] = [graph_of(three_channels())]
    chosen += [graph_of(plant) for _, plant in drawn_plants(16, connected=None, first=60)]
    for number, graph in enumerate(chosen):
        if graph.m != 3:
            continue
        note.on("the cyclic graph" if not number else f"drawn graph, seed {59 + number}")
        names = graph.names
        receives = all(
            {names[j] for j in graph.union([names.index(i) for i in s])} - set(s)
            for s in (tuple(names[int(k) - 1] for k in each) for each in SUBSETS_OF_THREE)
        )
        note.check(
            "strongly connected just when every subset receives messages from outside",
            graph.is_strongly_connected() == receives,
        )
        plant = three_channels()
        found = neighbor_graph(plant.with_neighbors(NeighborGraph(plant.names, graph.neighbors)))
        note.certify(found)


def sub_states_needed(note: Notebook) -> None:
    """Sub-states have to be shared if and only if sharing outputs leaves a mode fixed."""
    for plant in note.each(plants(8), drawn_plants(3, fixed=True, states=4, first=44)):
        alone, least = fixed_spectrum(augmented_outputs(plant)), minimal_shared_dimensions(plant)
        note.check("some dimensions suffice", least.feasible)
        note.check("none are needed just when nothing is fixed", (least.total == 0) == alone.empty)
        note.certify(alone, least)


def proposition_3(note: Notebook) -> None:
    """Proposition 3, and strong connectivity that follows."""
    for plant in note.each(plants(8), drawn_plants(2, connected=False)):
        before = transfer_graph(plant)
        after = transfer_graph(extended_system(plant, [1] * plant.m))
        union = set(union_of_graphs(plant, before).edges())
        note.check("the extended transfer graph contains both", union <= positions(plant, after))
        note.certify(before, after)
        if graph_of(plant).is_strongly_connected():
            note.check(
                "and is strongly connected with the neighbor graph", after.strongly_connected
            )


def corollary_1(note: Notebook) -> None:
    """Corollary 1, for n_i ≥ 1; with n_i = 0 the instance of the erratum splits."""
    for plant in note.each(plants(8)):
        size = max(1, shared_dimension_bound(plant).deficiency)
        found = completeness(extended_system(plant, [size] * plant.m))
        note.check("the extended system is complete", found.complete)
        note.certify(found)
    note.on(PAPER)
    plant, wanted = three_channels(), [-1, -1, -2, -2]
    design = design_extended(plant, spectrum=wanted)
    note.check(
        "a spectrum without a partition is assigned",
        design.loop.polynomial == Polynomial.from_roots(wanted),
    )
    note.certify(*design.certificates.values())
    from mcexact.analysis.stability.closed_loop_spectrum import closed_loop_spectrum

    spectrum = closed_loop_spectrum(design.loop.matrix, plant.time)
    note.show(spectrum_picture(spectrum, plant.time, "One shared scalar, spectrum −1, −1, −2, −2"))
    plant = note.at(split_spectrum())
    alone = extended_system(plant, [0, 0, 0])
    graph = transfer_graph(alone)
    note.check("nothing is fixed", fixed_spectrum(alone).empty)
    note.check("but the spectrum splits in two", len(graph.components) == 2)
    note.certify(fixed_spectrum(alone), graph)


def through_any_channel(note: Notebook) -> None:
    """`sys:contr-obs-thru-q`: one choice of gains F̄ serves every channel of the extended system."""
    for plant in note.each(plants(5)):
        size = max(1, shared_dimension_bound(plant).deficiency)
        found = single_channel_gains(extended_system(plant, [size] * plant.m))
        note.check("controllable and observable through every channel", found.exists)
        note.certify(found)


def total_dimension(note: Notebook) -> None:
    """The total dimension is k_q + Σ n_i, beside nm + m − 1 of the observer."""
    for plant in note.each(plants(1, states=2, channels=2)):
        found = design_extended(plant, rate=1, aims=THEOREM)
        orders = sum(each.order for each in found.parts["blocks"])
        sizes = found.parts["dimensions"]
        note.check("the order is k_q + Σ n_i", found.order == orders + sum(sizes.values()))
        note.check("less than the observer's", found.order < found.parts["observer_order"])
        note.certify(*found.certificates.values())


PROCEDURES: dict[str, Procedure] = {
    "emcs": construction,
    "emcs-joint": any_graph,
    "funch": rank_identity,
    "thm:strg-graph": theorem_2,
    "bound-zero": bound_zero,
    "bound-reached": bound_reached,
    "tight": tightness,
    "rmk:no-yi": remark_2,
    "every-subset": every_subset_receives,
    "necessary": sub_states_needed,
    "prp:transfer-matrix-graph": proposition_3,
    "cor:free-assign": corollary_1,
    "sys:contr-obs-thru-q": through_any_channel,
    "order": total_dimension,
}
