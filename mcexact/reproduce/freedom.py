"""Section IV-E: free assignment; section VI: which dimensions a controller must have."""

from __future__ import annotations

from mcexact.analysis.controllability import controllability_indices, observability_indices
from mcexact.analysis.fixed_modes import assignability, completeness, fixed_spectrum
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.derived.constructions import closed_by, extended_system, feedback
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import spectrum_picture
from mcexact.reproduce.equations import positions, union_of_graphs
from mcexact.reproduce.material import (
    PAPER,
    Numbers,
    drawn_plants,
    graph_of,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import split_spectrum
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.gate import Proposal, certify
from mcexact.synthesis.optimum.figures import THEOREM


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
    graph, found = transfer_graph(alone), completeness(alone)
    note.check("nothing is fixed", fixed_spectrum(alone).empty)
    note.check("and the bound is 0", shared_dimension_bound(plant).deficiency == 0)
    note.refute("n_i=0", len(graph.components) == 2 and not found.complete)
    note.certify(fixed_spectrum(alone), graph, found)


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
    numbers = Numbers(17)
    loops = [characteristic_polynomial(closed_by(plant, numbers.gains(plant))) for _ in "1234"]
    real = all(factor.degree == 1 for loop in loops for factor, _ in loop.factor())
    note.refute("pair", real)
    note.certify(split, transfer_graph(plant))


def through_any_channel(note: Notebook) -> None:
    """(31): one choice of gains F̄ serves every channel of the extended system."""
    for plant in note.each(plants(5)):
        size = max(1, shared_dimension_bound(plant).deficiency)
        found = single_channel_gains(extended_system(plant, [size] * plant.m))
        note.check("controllable and observable through every channel", found.exists)
        note.certify(found)
    plant = note.at(split_spectrum())
    note.print(plant)
    found = single_channel_gains(extended_system(plant, [0] * plant.m))
    note.refute("n_i=0", not found.exists)
    note.certify(found, shared_dimension_bound(plant))


def total_dimension(note: Notebook) -> None:
    """The total dimension is k_q + Σ n_i, beside nm + m − 1 of the observer."""
    for plant in note.each(plants(1, states=2, channels=2)):
        found = design_extended(plant, rate=1, aims=THEOREM)
        orders = sum(each.order for each in found.parts["blocks"])
        sizes = found.parts["dimensions"]
        note.check("the order is k_q + Σ n_i", found.order == orders + sum(sizes.values()))
        note.check("less than the observer's", found.order < found.parts["observer_order"])
        note.certify(*found.certificates.values())
        note.refute("observer", found.order != found.parts["observer_order"])
    plant = note.at((PAPER, three_channels()))
    design = design_extended(plant, rate=1, aims=THEOREM)
    sizes = design.parts["dimensions"]
    (block,) = design.parts["blocks"]
    loop = feedback(extended_system(plant, list(sizes.values())), list(design.parts["gains"]))
    reach = controllability_indices(loop, [block.agent])
    sight = observability_indices(loop, [block.agent])
    both = [each.index or 0 for each in (reach, sight)]
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
    note.check("one number is shared in all", sum(sizes.values()) == 1)
    note.check("the loop is certified", "stability" in design.certificates)
    note.refute("bound-needed", min(sizes.values()) < bound.deficiency)
    note.certify(bound, *design.certificates.values())


PROCEDURES: dict[str, Procedure] = {
    "proposition-3": proposition_3,
    "corollary-1": corollary_1,
    "parity": parity,
    "equation-31": through_any_channel,
    "order": total_dimension,
    "any-controller": any_controller,
}
