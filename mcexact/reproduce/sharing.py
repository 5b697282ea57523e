"""Examination of sections IV-C to IV-E and VI: extended systems and shared sub-states.

The construction of extended systems and its equivalence with distributed control; Theorem 2 and the
bound on the dimensions of shared sub-states, with plants for which it is tight and for which it is
not; and free assignment with the dimensions that a controller must have.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

from mcexact.analysis.analyze import analyze
from mcexact.analysis.controllability import (
    controllability_indices,
    joint_controllability,
    joint_observability,
    observability_indices,
)
from mcexact.analysis.fixed_modes import assignability, completeness, fixed_spectrum, pencil_rank
from mcexact.analysis.questions import SHARES
from mcexact.analysis.sharing import (
    base_system,
    common_dimension,
    minimal_shared_dimensions,
    neighbor_graph,
    shared_dimension_bound,
)
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.modes import FixedSpectrum, PencilRank
from mcexact.derived.constructions import (
    Share,
    augmented_outputs,
    closed_by,
    extended_system,
    feedback,
)
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import LEAST, dimensions_picture, spectrum_picture
from mcexact.reproduce.instances import (
    PAPER,
    PROPER_SUBSETS,
    SUBSETS_OF_THREE,
    Numbers,
    deficient_plants,
    drawn_plants,
    driven,
    four_agents,
    graph_of,
    messages_agree,
    needs_gains,
    outputs,
    plants,
    positions,
    split_spectrum,
    stacked,
    still_pair,
    three_channels,
    two_between,
    two_circles,
    union_of_graphs,
    unreached,
    uses_few_directions,
    with_dimensions,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.gate import Proposal, certify
from mcexact.synthesis.optimum.figures import THEOREM

# Section IV-C: extended systems.

SHARING: tuple[Share, ...] = ("outputs+states", "states")


def construction(note: Notebook) -> None:
    """(24) and (25)."""
    numbers = Numbers(14)
    for (name, plant), sizes in with_dimensions(plants(10, connected=None)):
        for share in SHARING:
            note.on(f"{name}, {share}", plant)
            system = extended_system(plant, sizes, share)
            note.counts(bool(graph_of(plant).edges()))
            note.check("there are n + Σ n_i states", system.n == plant.n + sum(sizes))
            note.check(
                "ẋ_i = v_i, and agents see what (25) says",
                messages_agree(plant, system, sizes, share, {}, numbers),
            )
            note.certify(fixed_spectrum(system))
    note.on(PAPER)
    plant, sizes = three_channels(), [1, 2, 1]
    system = extended_system(plant, sizes)
    backwards = plant.with_neighbors({"1": ["3"], "2": ["1"], "3": ["2"]})
    share = "outputs+states"
    note.refute("followers", not messages_agree(backwards, system, sizes, share, {}, numbers))
    note.refute("no-outputs", not messages_agree(plant, system, sizes, "states", {}, numbers))


def any_graph(note: Notebook) -> None:
    """Jointly controllable and observable for every graph."""
    both_kinds = (*plants(5, connected=None), *plants(1, connected=False))
    for name, plant in (*both_kinds, *deficient_plants(3)):
        for share in SHARING:
            note.on(f"{name}, {share}", plant)
            system = extended_system(plant, [1] * plant.m, share)
            note.counts(uses_few_directions(plant))
            note.joint(system)
    plant = note.at(unreached())
    joint = joint_controllability(extended_system(plant, [1, 1]))
    note.refute("any-plant", not joint.controllable)
    note.certify(joint)


EXTENDED: dict[str, Procedure] = {
    "equations-24-25": construction,
    "extended-joint": any_graph,
}


# Section IV-C: distributed control restated as decentralized control of extended systems.


@dataclass(frozen=True)
class ChannelLaw:
    """ū_i = F ȳ_i + G z_i and ż_i = P ȳ_i + Q z_i: a controller of one channel.

    Attributes
    ----------
    F, G, P, Q : Matrix
    """

    F: Matrix
    G: Matrix
    P: Matrix
    Q: Matrix


def drawn_laws(
    system: MultiChannelSystem, private: Sequence[int], numbers: Numbers
) -> list[ChannelLaw]:
    """Controllers of all channels of a system, with states of these dimensions."""
    return [
        ChannelLaw(
            numbers.matrix(system.p(i), system.q(i)),
            numbers.matrix(system.p(i), k),
            numbers.matrix(k, system.q(i)),
            numbers.matrix(k, k),
        )
        for i, k in enumerate(private)
    ]


def as_programs(
    plant: MultiChannelSystem, sizes: Sequence[int], laws: Sequence[ChannelLaw]
) -> Controller:
    """Cut the matrices of channel controllers of the extended system into agents' programs.

    ȳ_i has the y_j of all j ∈ N_i and then the x_j; ū_i has u_i and then v_i.
    """
    graph, agents = graph_of(plant), []
    for i, law in enumerate(laws):
        widths = [plant.q(j) for j in graph.neighborhood(i)]
        widths += [sizes[j] for j in graph.neighborhood(i)]
        rows = range(plant.p(i)), range(plant.p(i), plant.p(i) + sizes[i])
        input_, shared = (
            _cut(law.F.take(rows=part), widths, graph.neighborhood(i), law.G.take(rows=part))
            for part in rows
        )
        own = _cut(law.P, widths, graph.neighborhood(i), law.Q)
        agents.append(AgentProgram(plant.names[i], sizes[i], law.Q.nrows, shared, own, input_))
    return Controller(plant.time, "", tuple(agents))


def _cut(matrix: Matrix, widths: Sequence[int], heard: Sequence[int], private: Matrix) -> LinearMap:
    """A map of ȳ_i and z_i, as one of the y_j, of the x_j and of z_i."""
    starts = [sum(widths[:k]) for k in range(len(widths))]
    parts = [
        matrix.take(cols=range(start, start + width))
        for start, width in zip(starts, widths, strict=True)
    ]
    seen = dict(zip(heard, parts[: len(heard)], strict=True))
    shared = dict(zip(heard, parts[len(heard) :], strict=True))
    return LinearMap(seen, shared, private)


def loops_agree(
    plant: MultiChannelSystem,
    system: MultiChannelSystem,
    laws: Sequence[ChannelLaw],
    controller: Controller,
    numbers: Numbers,
) -> bool:
    """Whether the network of agents moves as the extended system under its channel controllers."""
    x_bar = numbers.column(system.n)
    z = [numbers.column(law.Q.nrows) for law in laws]
    y_bar = outputs(system, x_bar)
    ahead = driven(
        system,
        x_bar,
        [law.F @ y + law.G @ z_i for law, y, z_i in zip(laws, y_bar, z, strict=True)],
    )
    z_ahead = [law.P @ y + law.Q @ z_i for law, y, z_i in zip(laws, y_bar, z, strict=True)]
    loop = closed_loop(plant, controller).matrix

    def ordered(x_bar: Matrix, z: Sequence[Matrix]) -> Matrix:
        """x, and then x_i and z_i of one agent after another."""
        parts, at = [x_bar.take(rows=range(plant.n))], plant.n
        for agent, z_i in zip(controller.agents, z, strict=True):
            parts += [x_bar.take(rows=range(at, at + agent.shared)), z_i]
            at += agent.shared
        return stacked(parts)

    return loop @ ordered(x_bar, z) == ordered(ahead, z_ahead)


def equivalence(note: Notebook) -> None:
    """Every controller of the extended system's channels is a distributed one, and conversely."""
    numbers = Numbers(22)
    drawn = (*plants(6, connected=None), *plants(4, time="discrete"))
    for (name, plant), sizes in with_dimensions(drawn):
        note.on(f"{name}, {plant.time} time", plant)
        private = [(size + 1) % 3 for size in sizes]
        system = extended_system(plant, sizes)
        laws = drawn_laws(system, private, numbers)
        controller = as_programs(plant, sizes, laws)
        note.counts(bool(graph_of(plant).edges()))
        note.check(
            "the agents' loop is that of the extended system",
            loops_agree(plant, system, laws, controller, numbers),
        )
        entries = sum(part.nrows * part.ncols for law in laws for part in vars(law).values())
        note.check(
            "with as many free entries",
            entries == sum(M.nrows * M.ncols for M in controller.matrices()),
        )
    plant, sizes = three_channels(), [1, 2, 1]
    note.on(PAPER, plant)
    system = extended_system(plant, sizes)
    laws = drawn_laws(system, [1, 0, 2], numbers)
    controller = as_programs(plant, sizes, laws)
    for name, changed in _changed(controller):
        note.refute(name, not loops_agree(plant, system, laws, changed, numbers))


def _changed(controller: Controller) -> Iterator[tuple[str, Controller]]:
    """Agents that use the outputs of others alone, and agents without private states' updates."""

    def alone(each: LinearMap, i: int) -> LinearMap:
        return replace(each, shared={j: M for j, M in each.shared.items() if j == i})

    agents = controller.agents
    outputs_alone = tuple(
        replace(
            agent,
            shared_update=alone(agent.shared_update, i),
            private_update=alone(agent.private_update, i),
            input=alone(agent.input, i),
        )
        for i, agent in enumerate(agents)
    )
    still = tuple(replace(agent, private_update=LinearMap()) for agent in agents)
    yield "outputs-alone", replace(controller, agents=outputs_alone)
    yield "static", replace(controller, agents=still)


RESTATED: dict[str, Procedure] = {
    "equivalence": equivalence,
}


# Section IV-D: dimensions of shared sub-states that leave no fixed mode.


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
            note.counts(own.rank < system.n or heard > sum(n_i[j] for j in inside))
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
        spectrum = fixed_spectrum(extended_system(plant, [bound.deficiency] * plant.m))
        note.counts(bound.deficiency > 0)
        note.check(f"nothing is fixed with n_i = {bound.deficiency}", spectrum.empty)
        note.certify(neighbor_graph(plant), bound, spectrum)
    _less_than_the_bound(note, "outputs+states")
    plant = note.at(two_circles())
    bound = shared_dimension_bound(plant)
    spectrum = fixed_spectrum(extended_system(plant, [bound.deficiency] * plant.m))
    note.refute("any-graph", not spectrum.empty)
    note.certify(neighbor_graph(plant), bound, spectrum)


def _less_than_the_bound(note: Notebook, share: Share) -> None:
    """Plants with the bounds 1, 2 and 3: one less leaves a mode fixed where the bound is tight."""
    for plant in note.each(deficient_plants(7, share=share)):
        bound, least = (
            shared_dimension_bound(plant, share=share),
            common_dimension(plant, share=share),
        )
        enough = fixed_spectrum(extended_system(plant, [bound.deficiency] * plant.m, share))
        note.counts(bound.deficiency > 0)
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
        spectrum = fixed_spectrum(plant)
        if not spectrum.empty:
            continue
        note.on(name, plant)
        for share in SHARING:
            bound, printed = shared_dimension_bound(plant, share=share), printed_bound(plant, share)
            note.counts(printed == 0)
            note.check(f"no rank is below n ({share})", printed <= 0)
            note.check(f"no dimension is needed ({share})", bound.deficiency == 0)
            note.certify(bound)
        note.certify(spectrum)
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
        note.counts(plant.n - least >= 1)
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
        note.counts(bound >= 1)
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
    analysis = analyze(plant, also=LEAST.values())
    for share, total in zip(SHARING, (1, 2), strict=True):
        stem = SHARES[share]
        bound = analysis[f"shared_dimension_bound_{stem}"]
        least = analysis[f"minimal_shared_dimensions_{stem}"]
        note.counts(bound.deficiency > 0)
        note.check(f"{total} shared in all is the least ({share})", least.total == total)
        note.check("the bound asks for more", bound.total > total)
        common = analysis[f"common_dimension_{stem}"]
        note.check("as all share the same it is the least", common.dimension == bound.deficiency)
        note.certify(bound, least, common)
    note.show(dimensions_picture(analysis.account))
    for instance in (two_between(), four_agents()):
        plant = note.at(instance)
        bound, common = shared_dimension_bound(plant), common_dimension(plant)
        both = (bound.deficiency, common.dimension)
        note.counts(bound.deficiency > 0)
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
        system = extended_system(plant, [bound.deficiency] * plant.m, "states")
        spectrum, sight = fixed_spectrum(system), joint_observability(system)
        note.check("nothing is fixed at the bound of the remark", spectrum.empty)
        note.check("it is jointly observable", sight.controllable)
        weaker = shared_dimension_bound(plant)
        note.check("which is at least that of Theorem 2", bound.deficiency >= weaker.deficiency)
        note.certify(bound, weaker, spectrum, sight)
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
        answer = neighbor_graph(plant.with_neighbors(graph))
        note.counts(0 < sum(links) < len(links))
        note.check(
            "strongly connected just when every subset receives messages from outside",
            answer.strongly_connected == receives,
        )
        if receives not in both:
            both.add(receives)
            note.certify(answer)
    note.check("both are among them", both == {True, False})
    plant = note.at(two_circles())
    receiving = all(len(graph_of(plant).neighborhood(i)) > 1 for i in range(plant.m))
    note.refute("single-agents", receiving and not graph_of(plant).is_strongly_connected())
    note.certify(neighbor_graph(plant))


def sub_states_needed(note: Notebook) -> None:
    """Sub-states have to be shared if and only if sharing outputs leaves a mode fixed."""
    for plant in note.each(plants(8), drawn_plants(3, fixed=True, states=4, first=44)):
        alone, least = fixed_spectrum(augmented_outputs(plant)), minimal_shared_dimensions(plant)
        note.counts(not alone.empty)
        note.check("some dimensions suffice", least.feasible)
        note.check("none are needed just when nothing is fixed", (least.total == 0) == alone.empty)
        note.certify(alone, least)
        if least.total == 0:
            note.refute("always", alone.empty)
    for plant in note.each(deficient_plants(7)):
        alone, least = fixed_spectrum(augmented_outputs(plant)), minimal_shared_dimensions(plant)
        note.counts(not alone.empty)
        note.refute("never", not alone.empty and (least.total or 0) > 0)
        note.certify(alone, least)


BOUNDS: dict[str, Procedure] = {
    "equations-28-30": rank_identity,
    "theorem-2": theorem_2,
    "bound-zero": bound_zero,
    "bound-reached": bound_reached,
    "tight": tightness,
    "remark-2": remark_2,
    "every-subset": every_subset_receives,
    "necessary": sub_states_needed,
}


# Section IV-E: free assignment; section VI: which dimensions a controller must have.


def proposition_3(note: Notebook) -> None:
    """Proposition 3, and strong connectivity that follows."""
    for plant in note.each(plants(8), drawn_plants(2, connected=False)):
        before = transfer_graph(plant)
        after = transfer_graph(extended_system(plant, [1] * plant.m))
        union = set(union_of_graphs(plant, before).edges())
        note.counts(not union <= positions(plant, before))
        note.check("the extended transfer graph contains both", union <= positions(plant, after))
        note.certify(before, after)
        if graph_of(plant).is_strongly_connected():
            note.check(
                "and is strongly connected with the neighbor graph", after.strongly_connected
            )
            if union != positions(plant, after):
                note.refute("equality")
    plant = note.at(split_spectrum())
    before, after = transfer_graph(plant), transfer_graph(extended_system(plant, [0, 0, 0]))
    union = set(union_of_graphs(plant, before).edges())
    note.refute("n_i=0", not union <= positions(plant, after) and not after.strongly_connected)
    note.certify(before, after)


def corollary_1(note: Notebook) -> None:
    """Corollary 1, for n_i ≥ 1; with n_i = 0 the instance of the erratum splits."""
    for plant in note.each(plants(8)):
        size = max(1, shared_dimension_bound(plant).deficiency)
        whole = completeness(extended_system(plant, [size] * plant.m))
        note.counts(not completeness(plant).complete)
        note.check("the extended system is complete", whole.complete)
        note.certify(whole)
    note.on(PAPER)
    plant, wanted = three_channels(), [-1, -1, -2, -2]
    design = design_extended(plant, spectrum=wanted)
    note.check(
        "a spectrum without a partition is assigned",
        design.loop.polynomial == Polynomial.from_roots(wanted),
    )
    note.certify(*design.certificates.values())
    # Three numbers of the plant and one of the rest: no partition has these complex pairs.
    pairs = Polynomial.of(2, 2, 1) * Polynomial.of(5, 4, 1)
    complex_ = design_extended(plant, spectrum=pairs)
    note.check("two complex pairs are assigned", complex_.loop.polynomial == pairs)
    odd = [factor.degree for factor, _ in pairs.factor() if factor.degree % 2]
    note.refute("partition", plant.n % 2 == 1 and not odd)
    note.certify(*complex_.certificates.values())
    spectrum = closed_loop_spectrum(design.loop.matrix, plant.time)
    note.show(spectrum_picture(spectrum, plant.time, "One shared scalar, spectrum −1, −1, −2, −2"))
    plant = note.at(split_spectrum())
    note.print(plant)
    alone = extended_system(plant, [0, 0, 0])
    graph, whole = transfer_graph(alone), completeness(alone)
    note.check("nothing is fixed", fixed_spectrum(alone).empty)
    note.check("and the bound is 0", shared_dimension_bound(plant).deficiency == 0)
    note.refute("n_i=0", len(graph.components) == 2 and not whole.complete)
    note.certify(fixed_spectrum(alone), graph, whole)


def _chain(plant: MultiChannelSystem, own: dict[str, Polynomial]) -> Controller:
    """Give agents with ẋ = u a private state each, for loops with prescribed polynomials."""
    one = Matrix.identity(1)
    programs = []
    for i, name in enumerate(plant.names):
        if name not in own:
            programs.append(AgentProgram(name, 0, 0))
            continue
        constant, linear, _ = own[name].coefficients
        update = LinearMap({i: one * -constant}, private=one * -linear)
        programs.append(
            AgentProgram(name, 0, 1, private_update=update, input=LinearMap(private=one))
        )
    return Controller(plant.time, plant.digest(), tuple(programs))


def parity(note: Notebook) -> None:
    """Where the spectrum splits with n_i = 0, a symmetric set of four is still assignable.

    Agents 1 and 3 get a private state each, and with it two of the four numbers: two pairs of real
    numbers, or two complex pairs.  Two numbers in all, without private states, have to be real.
    """
    plant = note.at(split_spectrum())
    for first, second in (((2, 3, 1), (12, 7, 1)), ((2, 2, 1), (5, 4, 1)), ((2, 2, 1), (2, 3, 1))):
        wanted = (Polynomial.of(*first), Polynomial.of(*second))
        controller = _chain(plant, {"1": wanted[0], "3": wanted[1]})
        proposal = Proposal(controller, polynomials=(wanted[0] * wanted[1],))
        loop = certify(plant, proposal, StabilityRegion.of(plant.time))
        note.check("the loop has the prescribed spectrum", loop.polynomial == wanted[0] * wanted[1])
        note.certify(loop.proof)
    split = assignability(plant)
    note.counts(len(split.blocks) > 1)
    numbers = Numbers(17)
    loops = [characteristic_polynomial(closed_by(plant, numbers.gains(plant))) for _ in "1234"]
    real = all(factor.degree == 1 for loop in loops for factor, _ in loop.factor())
    note.refute("pair", real)
    note.certify(split, transfer_graph(plant))


def through_any_channel(note: Notebook) -> None:
    """(31): one choice of gains F̄ serves every channel of the extended system."""
    for plant in note.each(plants(5)):
        size = max(1, shared_dimension_bound(plant).deficiency)
        system = extended_system(plant, [size] * plant.m)
        gains = single_channel_gains(system)
        note.counts(needs_gains(system))
        note.check("controllable and observable through every channel", gains.exists)
        note.certify(gains)
    plant = note.at(split_spectrum())
    note.print(plant)
    gains = single_channel_gains(extended_system(plant, [0] * plant.m))
    note.refute("n_i=0", not gains.exists)
    note.certify(gains, shared_dimension_bound(plant))


def total_dimension(note: Notebook) -> None:
    """The total dimension is k_q + Σ n_i, beside nm + m − 1 of the observer."""
    for plant in note.each(plants(1, states=2, channels=2)):
        extended = design_extended(plant, rate=1, aims=THEOREM)
        orders = sum(each.order for each in extended.parts["blocks"])
        sizes = extended.parts["dimensions"]
        note.counts(extended.order > 0)
        note.check("the order is k_q + Σ n_i", extended.order == orders + sum(sizes.values()))
        note.check("less than the observer's", extended.order < extended.parts["observer_order"])
        note.certify(*extended.certificates.values())
        note.refute("observer", extended.order != extended.parts["observer_order"])
    plant = note.at((PAPER, three_channels()))
    design = design_extended(plant, rate=1, aims=THEOREM)
    sizes = design.parts["dimensions"]
    (block,) = design.parts["blocks"]
    loop = feedback(extended_system(plant, list(sizes.values())), list(design.parts["gains"]))
    reach = controllability_indices(loop, [block.agent])
    sight = observability_indices(loop, [block.agent])
    both = [each.index or 0 for each in (reach, sight)]
    note.counts(design.order > 0)
    note.check("the order k_q is the smaller index less 1", block.order == min(both) - 1)
    note.refute("larger-index", block.order != max(both) - 1)
    note.refute("private-state", block.order == 0)
    note.certify(reach, sight, *design.certificates.values())


def any_controller(note: Notebook) -> None:
    """VI: the dimensions of Theorem 2 suffice, and smaller ones can do."""
    note.on(PAPER)
    plant = three_channels()
    bound = shared_dimension_bound(plant)
    design = design_extended(plant, rate=1, aims=THEOREM)
    sizes = design.parts["dimensions"]
    note.counts(bound.deficiency > 0)
    note.check("one number is shared in all", sum(sizes.values()) == 1)
    note.check("the loop is certified", "stability" in design.certificates)
    note.refute("bound-needed", min(sizes.values()) < bound.deficiency)
    note.certify(bound, *design.certificates.values())


FREEDOM: dict[str, Procedure] = {
    "proposition-3": proposition_3,
    "corollary-1": corollary_1,
    "parity": parity,
    "equation-31": through_any_channel,
    "order": total_dimension,
    "any-controller": any_controller,
}
