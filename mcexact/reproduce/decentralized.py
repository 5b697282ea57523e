"""Section IV-A and IV-B: fixed spectra, transfer graphs, and the example of three channels."""

from __future__ import annotations

from functools import reduce

from mcexact.analysis.analyze import analyze
from mcexact.analysis.fixed_modes.completeness import completeness
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.fixed_modes.pencil import pencil_rank
from mcexact.analysis.fixed_modes.single_channel_gains import single_channel_gains
from mcexact.analysis.structure.transfer_graph import transfer_graph
from mcexact.derived.augmented_outputs import augmented_outputs
from mcexact.derived.extended import extended_system
from mcexact.derived.feedback import closed_by
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import TIMES, StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem
from mcexact.report.graph_figures import graph_picture
from mcexact.reproduce.equations import outputs, stacked
from mcexact.reproduce.material import (
    PAPER,
    SUBSETS_OF_THREE,
    Numbers,
    drawn_plants,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import fixed_zero
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.optimum.aims import THEOREM

ZERO_HINDERS = "In discrete time, too, a rate can be attained only if nothing is fixed."
OUTPUTS_ARE_ENOUGH = "Sharing outputs alone is enough."


def definition(note: Notebook) -> None:
    """No F moves Λ_fixed: its polynomial is the greatest common divisor over drawn loops."""
    numbers = Numbers(11)
    for plant in note.each(drawn_plants(8, states=4), drawn_plants(3, states=4, fixed=True)):
        found = fixed_spectrum(plant)
        loops = [characteristic_polynomial(closed_by(plant, numbers.gains(plant))) for _ in "1234"]
        note.check(
            "the fixed polynomial divides the polynomial of every loop",
            all(found.polynomial.divides(each) for each in loops),
        )
        shared = reduce(Polynomial.gcd, loops, characteristic_polynomial(plant.A))
        note.check(
            "four drawn loops share nothing else",
            shared.squarefree_part() == found.polynomial.squarefree_part(),
        )
        note.certify(found)


def proposition_2(note: Notebook) -> None:
    """Proposition 2: a fixed mode has a subset with a rank below n; the example has six subsets."""
    for plant in note.each(drawn_plants(10, states=4, fixed=True, first=11)):
        found = fixed_spectrum(plant)
        note.check("a planted fixed mode is found", not found.empty)
        for factor in found.factors:
            rank = pencil_rank(plant, factor.channels, factor.polynomial)
            note.check("its pencil has rank below n", rank.rank < plant.n)
            note.check("for a proper nonempty subset", 0 < len(factor.channels) < plant.m)
            note.certify(rank)
        note.certify(found)
    example = three_channels()
    for name, system in (
        (PAPER, example),
        (f"{PAPER}, sharing outputs", augmented_outputs(example)),
    ):
        note.on(name)
        ranks = [pencil_rank(system, s, 1) for s in SUBSETS_OF_THREE]
        found = fixed_spectrum(system)
        note.check(
            "1 is fixed just when one of the six pencils has rank below 3",
            any(each.rank < 3 for each in ranks) != found.empty,
        )
        note.certify(found, *ranks)


def empty_and_all(note: Notebook) -> None:
    """The footnote: rank n for s = ∅ and s = m, by joint controllability and observability."""
    for plant in note.each(plants(8)):
        for mode, _ in characteristic_polynomial(plant.A).factor():
            for s in ((), plant.names):
                found = pencil_rank(plant, s, mode)
                note.check(
                    "the pencil of ∅ or of all channels has rank at least n", found.rank >= plant.n
                )
                note.certify(found)


def transfer(note: Notebook) -> None:
    """The transfer graph: an edge j → i iff some C_i A^k B_j is not 0, k < n."""
    for plant in note.each(plants(14)):
        found = transfer_graph(plant)
        powers = [Matrix.identity(plant.n)]
        for _ in range(plant.n - 1):
            powers.append(powers[-1] @ plant.A)
        edges = {
            (plant.names[j], plant.names[i])
            for j in range(plant.m)
            for i in range(plant.m)
            if i != j and any(not (plant.C(i) @ P @ plant.B(j)).is_zero() for P in powers)
        }
        note.check(
            "its edges are the nonzero blocks",
            set(found.arcs) - {(c, c) for c in plant.names} == edges,
        )
        note.certify(found)


def corfmat_morse(note: Notebook) -> None:
    """Without fixed modes and strongly connected: some F serves each single channel."""
    for plant in note.each(plants(14)):
        whole = completeness(plant)
        found = single_channel_gains(plant)
        note.check(
            "gains for every channel exist just when it is complete", found.exists == whole.complete
        )
        note.certify(whole, found)


def free_assignment(note: Notebook) -> None:
    """For a complete system, one channel controller assigns any symmetric spectrum."""
    for name, plant in plants(6, states=2, channels=2):
        if not completeness(plant).complete:
            continue
        note.on(name)
        order = design_decentralized(plant, rate=1, aims=THEOREM).order
        wanted = [-3 - k for k in range(plant.n + order)]
        design = design_decentralized(plant, spectrum=wanted)
        note.check(
            "the loop has the prescribed spectrum",
            design.loop.polynomial == Polynomial.from_roots(wanted),
        )
        note.certify(design.loop.proof)


def partition(note: Notebook) -> None:
    """Not strongly connected: the spectrum is one symmetric set for each strong component."""
    A = [[0, 1, 0], [0, 0, 0], [1, 0, 2]]
    B = [[[0], [1], [0]], [[0], [0], [1]]]
    C = [[[1, 0, 0]], [[0, 0, 1]]]
    plant = MultiChannelSystem(A, B, C)
    note.on("two subsystems in series, n=3, m=2")
    found = transfer_graph(plant)
    note.check("there are two strong components", len(found.components) == 2)
    note.check("nothing is fixed", fixed_spectrum(plant).empty)
    design = design_decentralized(plant, rate=2, aims=THEOREM)
    note.check("one set for each component", len(design.parts["blocks"]) == 2)
    sizes = [each.polynomial.degree - each.order for each in design.parts["blocks"]]
    note.check("of the dimensions of the components, 2 and 1", sorted(sizes) == [1, 2])
    note.certify(found, fixed_spectrum(plant), design.loop.proof)


def wang_davison(note: Notebook) -> None:
    """Linear time-invariant control achieves any rate if and only if no mode is fixed."""
    for plant in note.each(
        drawn_plants(8, states=3, channels=2, first=21),
        drawn_plants(5, states=3, channels=2, fixed=True, first=21),
    ):
        found = fixed_spectrum(plant)
        note.certify(found)
        fast = 1000
        try:
            design = design_decentralized(plant, rate=fast, aims=THEOREM)
        except Impossible as refused:
            note.check("refused because something is fixed", not found.empty)
            note.certify(refused.certificate)
        else:
            note.check("a rate of 1000 is reached because nothing is fixed", found.empty)
            note.certify(design.loop.proof)


def wang_davison_discrete(note: Notebook) -> None:
    """In discrete time the fixed modes that hinder a rate are those other than 0."""
    plant = note.at(fixed_zero())
    found = fixed_spectrum(plant)
    note.check("0 is the only fixed mode", found.polynomial == Polynomial.x())
    design = design_decentralized(plant, radius="1/100", aims=THEOREM)
    inside = StabilityRegion.of("discrete", radius="1/100")
    reached = inside.contains_roots_of(design.loop.polynomial or Polynomial.of(0))
    note.check("every eigenvalue of the loop is below 1/100", reached)
    note.refute(ZERO_HINDERS, reached and not found.empty)
    note.certify(found, design.loop.proof)
    for plant in note.each(drawn_plants(6, states=3, channels=2, time="discrete", first=21)):
        found = fixed_spectrum(plant)
        nonzero = found.polynomial.squarefree_part() not in (Polynomial.of(1), Polynomial.x())
        try:
            made = design_decentralized(plant, radius="1/100", aims=THEOREM)
        except Impossible as refused:
            note.check("refused because a nonzero mode is fixed", nonzero)
            note.certify(refused.certificate)
        else:
            note.check("reached because no nonzero mode is fixed", not nonzero)
            note.certify(made.loop.proof)


def dynamic(note: Notebook) -> None:
    """No dynamic controller that shares outputs alone moves the mode 1 of the example."""
    numbers = Numbers(18)
    for time in TIMES:
        plant = note.at((f"{PAPER}, {time} time", three_channels(time)))
        shared = augmented_outputs(plant)
        found = fixed_spectrum(shared)
        note.check("1 is fixed when outputs are shared", found.polynomial(1) == 0)
        note.certify(found)
        # Private states are shared sub-states that nobody else receives.
        alone = dict.fromkeys(plant.names, ())
        base = MultiChannelSystem(
            shared.A,
            [channel.B for channel in shared.channels],
            [channel.C for channel in shared.channels],
            time=time,
            names=shared.names,
            neighbors=alone,
        )
        for orders in ([1, 0, 2], [2, 2, 2]):
            made = extended_system(base, orders, "states")
            loop = closed_by(made, numbers.gains(made))
            note.check(
                f"1 stays with private states of dimensions {orders}",
                characteristic_polynomial(loop)(1) == 0,
            )


def sharing_states(note: Notebook) -> None:
    """It is enough to share the estimates x_i: no output of another agent is used."""
    plant = note.at((PAPER, three_channels()))
    design = design_observer(plant, rate=1)
    for i, agent in enumerate(design.controller.agents):
        others = {j for each in agent.maps() for j in each.outputs} - {i}
        note.check(f"agent {agent.name} uses its own output alone", not others)
    note.check("every eigenvalue meets the rate", "distributed_observer" in design.certificates)
    note.certify(*design.certificates.values())
    found = fixed_spectrum(extended_system(plant, [plant.n] * plant.m, "states"))
    note.check("with n_i = n and no outputs nothing is fixed", found.empty)
    note.certify(found)
    nothing = fixed_spectrum(augmented_outputs(plant))
    note.refute(OUTPUTS_ARE_ENOUGH, not nothing.empty)
    note.certify(nothing)


def example(note: Notebook) -> None:
    """IV-B: the mode 1 stays fixed when agents share outputs alone."""
    plant = three_channels()
    system = augmented_outputs(plant)
    note.on(PAPER)
    note.joint(plant)
    rank = pencil_rank(system, ["2"], 1)
    note.check("rank [I − A, B_1, B_3; C_{N_2}, 0] is 2", rank.rank == 2)
    found = fixed_spectrum(system)
    note.check("the fixed polynomial is x − 1", found.polynomial == Polynomial.from_roots([1]))
    note.check(
        "no linear time-invariant distributed control with outputs alone stabilizes it",
        not found.stabilizable,
    )
    note.certify(rank, found)
    alone = MultiChannelSystem(
        system.A, [c.B for c in system.channels], [c.C for c in system.channels]
    )
    try:
        design_decentralized(alone, rate="1/100")
    except Impossible as refused:
        note.check("a design is refused, with the fixed mode as the reason", True)
        note.certify(refused.certificate)
    else:
        note.check("a design is refused", False)
    heard = analyze(plant, ["fixed_spectrum", "transfer_graph"], information="outputs")
    note.show(graph_picture(heard.account))


def shared_outputs(note: Notebook) -> None:
    """(23): agent i receives the outputs y_j of its neighbors."""
    numbers = Numbers(12)
    for plant in note.each(plants(10, connected=None)):
        made = augmented_outputs(plant)
        x = numbers.column(plant.n)
        y = outputs(plant, x)
        graph = plant.neighbors
        right = graph is not None and all(
            made.C(i) @ x == stacked([y[j] for j in graph.neighborhood(i)]) for i in range(plant.m)
        )
        note.check("ȳ_i is column{y_j, j ∈ N_i}", right)
        note.check("A and B_i are the plant's", made.A == plant.A)
        note.certify(fixed_spectrum(made))


PROCEDURES: dict[str, Procedure] = {
    "fixed-spectrum": definition,
    "prp:mtrx-pencil": proposition_2,
    "footnote": empty_and_all,
    "transfer-graph": transfer,
    "corfmat-morse": corfmat_morse,
    "free-assignment": free_assignment,
    "partition": partition,
    "wang-davison": wang_davison,
    "wang-davison-discrete": wang_davison_discrete,
    "mss": shared_outputs,
    "example": example,
    "dynamic": dynamic,
    "sharing-states": sharing_states,
}
