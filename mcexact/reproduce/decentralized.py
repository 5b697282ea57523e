"""Section IV-A and IV-B: fixed spectra, transfer graphs, and the example of three channels."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce

from mcexact.analysis.fixed_modes import assignability, completeness, fixed_spectrum, pencil_rank
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.structure import transfer_graph
from mcexact.derived.constructions import augmented_outputs, closed_by
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import system_with_deficiency
from mcexact.errors import Impossible, InputError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import (
    PAPER,
    SUBSETS_OF_THREE,
    Instance,
    Numbers,
    deficient_plants,
    drawn_plants,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import fixed_zero, split_spectrum
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.optimum.figures import THEOREM


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
        own = characteristic_polynomial(plant.A).squarefree_part()
        if not found.empty:
            note.refute("empty", found.polynomial.degree > 0)
            moved = own // own.gcd(found.polynomial)
            if moved.degree:
                note.refute("spectrum-of-A", not moved.divides(found.polynomial))


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
        note.on(name, system)
        ranks = [pencil_rank(system, s, 1) for s in SUBSETS_OF_THREE]
        found = fixed_spectrum(system)
        note.check(
            "1 is fixed just when one of the six pencils has rank below 3",
            any(each.rank < 3 for each in ranks) != found.empty,
        )
        note.certify(found, *ranks)
    name, plant = split_spectrum()
    note.on(f"{name} but outputs")
    shared = augmented_outputs(plant)
    ranks, found = [pencil_rank(shared, s, 0) for s in SUBSETS_OF_THREE], fixed_spectrum(shared)
    note.refute("at-most-n", found.empty and min(each.rank for each in ranks) == shared.n)
    note.certify(found, *ranks)
    # The subset has two channels, and every single one has full rank.
    for plant in note.each(_two_of_three()):
        found = fixed_spectrum(plant)
        mode = found.factors[0].polynomial
        single = [pencil_rank(plant, [name], mode) for name in plant.names]
        note.refute("single-channels", all(each.rank >= plant.n for each in single))
        note.certify(found, *single)


def _two_of_three() -> Iterator[Instance]:
    """Plants with a fixed mode, whose subset has two of three channels."""
    for seed in (1, 2, 3, 4):
        drawn = system_with_deficiency(SeededChoices(seed), 1, share="states", degree=1 + seed % 2)
        if len(drawn.subset or ()) == 2:
            yield (
                f"drawn, a fixed mode by two channels, seed {seed}: n={drawn.system.n}",
                drawn.system,
            )


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
    plant = note.at((f"{PAPER}, sharing outputs", augmented_outputs(three_channels())))
    rank = pencil_rank(plant, ["2"], 1)
    note.refute("other-subsets", rank.rank < plant.n)
    note.certify(rank)


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
    note.on(PAPER)
    plant = three_channels()
    found = transfer_graph(plant)
    backwards = {(i, j) for j, i in found.arcs}
    note.refute("backwards", set(found.arcs) != backwards)
    direct = {
        (plant.names[j], plant.names[i])
        for j in range(plant.m)
        for i in range(plant.m)
        if not (plant.C(i) @ plant.B(j)).is_zero()
    }
    note.refute("direct", set(found.arcs) - {(c, c) for c in plant.names} != direct)


def corfmat_morse(note: Notebook) -> None:
    """Without fixed modes and strongly connected: some F serves each single channel."""
    for plant in note.each(plants(14)):
        whole = completeness(plant)
        found = single_channel_gains(plant)
        note.check(
            "gains for every channel exist just when it is complete", found.exists == whole.complete
        )
        note.certify(whole, found)
    for name, plant in (_in_series(), *deficient_plants(2, share="states")):
        note.on(name, plant)
        found, fixed, graph = (
            single_channel_gains(plant),
            fixed_spectrum(plant),
            transfer_graph(plant),
        )
        if fixed.empty:
            note.refute("any-transfer-graph", not graph.strongly_connected and not found.exists)
        else:
            note.refute("fixed-modes", graph.strongly_connected and not found.exists)
        note.certify(found, fixed, graph)


def free_assignment(note: Notebook) -> None:
    """For a complete system, one channel controller assigns any symmetric spectrum."""
    for name, plant in plants(6, states=2, channels=2):
        if not completeness(plant).complete:
            continue
        note.on(name, plant)
        order = design_decentralized(plant, rate=1, aims=THEOREM).order
        wanted = [-3 - k for k in range(plant.n + order)]
        design = design_decentralized(plant, spectrum=wanted)
        note.check(
            "the loop has the prescribed spectrum",
            design.loop.polynomial == Polynomial.from_roots(wanted),
        )
        note.certify(design.loop.proof)
    for name, plant in (_in_series(), *deficient_plants(1, share="states")):
        note.on(name, plant)
        order = plant.n
        try:
            design_decentralized(plant, spectrum=[-3 - k for k in range(plant.n + order)])
        except Impossible as refused:
            note.refute("fixed-modes", not fixed_spectrum(plant).empty)
            note.certify(refused.certificate)
        except InputError as refused:
            note.refute("any-transfer-graph", "the spectrum splits" in str(refused))


def _in_series() -> Instance:
    """A double integrator that drives a plant of one state; nothing leads back."""
    A = [[0, 1, 0], [0, 0, 0], [1, 0, 2]]
    B = [[[0], [1], [0]], [[0], [0], [1]]]
    C = [[[1, 0, 0]], [[0, 0, 1]]]
    return "two subsystems in series, n=3, m=2", MultiChannelSystem(A, B, C)


def partition(note: Notebook) -> None:
    """Not strongly connected: the spectrum is one symmetric set for each strong component."""
    plant = note.at(_in_series())
    found = transfer_graph(plant)
    note.check("there are two strong components", len(found.components) == 2)
    note.check("nothing is fixed", fixed_spectrum(plant).empty)
    design = design_decentralized(plant, rate=2, aims=THEOREM)
    note.check("one set for each component", len(design.parts["blocks"]) == 2)
    sizes = [each.polynomial.degree - each.order for each in design.parts["blocks"]]
    note.check("of the dimensions of the components, 2 and 1", sorted(sizes) == [1, 2])
    numbers = Numbers(27)
    loops = [characteristic_polynomial(closed_by(plant, numbers.gains(plant))) for _ in range(8)]
    parted = [sorted(factor.degree for factor, _ in loop.factor()) for loop in loops]
    note.check(
        "every drawn loop has a rational eigenvalue, the set of one", all(1 in p for p in parted)
    )
    split = assignability(plant)
    note.refute("one-set", len(split.blocks) == 2)
    parts = {part.channels: part.dimension for part in split.blocks}
    note.refute("equal-sizes", sorted(parts.values()) == [1, 2])
    note.certify(split)
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
            note.refute("always", not found.empty)
            note.certify(refused.certificate)
        else:
            note.check("a rate of 1000 is reached because nothing is fixed", found.empty)
            note.certify(design.loop.proof)


def wang_davison_discrete(note: Notebook) -> None:
    """In discrete time the fixed modes that hinder a rate are those other than 0."""
    plant = note.at(fixed_zero())
    note.print(plant)
    found = fixed_spectrum(plant)
    note.check("0 is the only fixed mode", found.polynomial == Polynomial.x())
    design = design_decentralized(plant, radius="1/100", aims=THEOREM)
    inside = StabilityRegion.of("discrete", radius="1/100")
    reached = inside.contains_roots_of(design.loop.polynomial or Polynomial.of(0))
    note.check("every eigenvalue of the loop is below 1/100", reached)
    note.refute("zero-hinders", reached and not found.empty)
    note.certify(found, design.loop.proof)
    for plant in note.each(deficient_plants(2, share="states", time="discrete")):
        found = fixed_spectrum(plant)
        if found.polynomial.squarefree_part() not in (Polynomial.of(1), Polynomial.x()):
            note.refute("nothing-hinders")
        note.certify(found)
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


PROCEDURES: dict[str, Procedure] = {
    "fixed-spectrum": definition,
    "proposition-2": proposition_2,
    "footnote": empty_and_all,
    "transfer-graph": transfer,
    "corfmat-morse": corfmat_morse,
    "free-assignment": free_assignment,
    "partition": partition,
    "wang-davison": wang_davison,
    "wang-davison-discrete": wang_davison_discrete,
}
