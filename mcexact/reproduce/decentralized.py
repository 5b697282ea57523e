"""Examination of sections I, IV-A and IV-B: fixed spectra, transfer graphs, the example.

Each function examines one statement: on the example of three channels, on drawn plants, and on
plants next to the statement for which it is false.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce

from mcexact.analysis.analyze import analyze
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import assignability, completeness, fixed_spectrum, pencil_rank
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.modes import FixedSpectrum
from mcexact.derived.constructions import augmented_outputs, closed_by, extended_system, feedback
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import system_with_deficiency
from mcexact.errors import Impossible, InputError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import TIMES, StabilityRegion
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import graph_pictures
from mcexact.reproduce.instances import (
    PAPER,
    SUBSETS_OF_THREE,
    Instance,
    Numbers,
    deficient_plants,
    drawn_plants,
    driven,
    fixed_zero,
    graph_of,
    needs_gains,
    outputs,
    plants,
    split_spectrum,
    stacked,
    three_channels,
    uses_few_directions,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import designed, small
from mcexact.simulation.network import InitialState
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.optimum.figures import THEOREM

# Section I: multi-channel systems, neighbor graphs, and the paper's assumptions.


def continuous(note: Notebook) -> None:
    """Equation (1): u_i = F_i y_i gives the matrix A + Σ B_i F_i C_i."""
    numbers = Numbers(1)
    for plant in note.each(plants(10)):
        gains = numbers.gains(plant)
        x = numbers.column(plant.n)
        y = outputs(plant, x)
        u = [F @ y_i for F, y_i in zip(gains, y, strict=True)]
        closed = feedback(plant, gains)
        note.counts(closed.A @ x != plant.A @ x)
        note.check("A + Σ B_i F_i C_i is the closed loop", driven(plant, x, u) == closed.A @ x)
        opposite = feedback(plant, [F * -1 for F in gains])
        if note.here == PAPER:
            note.refute("sign", driven(plant, x, u) != opposite.A @ x)
            note.refute("late", driven(plant, x, u[1:] + u[:1]) != closed.A @ x)


def discrete(note: Notebook) -> None:
    """Equation (2): one agent for each channel gives the same closed loop."""
    numbers = Numbers(2)
    for plant in note.each(plants(10, time="discrete")):
        gains = numbers.gains(plant)
        agents = tuple(
            AgentProgram(agent, 0, 0, input=LinearMap({i: gains[i]}))
            for i, agent in enumerate(plant.names)
        )
        x = numbers.column(plant.n)
        start = tuple(row[0] for row in x.rows())
        empty: tuple[tuple[()], ...] = ((),) * plant.m
        run = simulate(
            plant,
            Controller("discrete", plant.digest(), agents),
            initial=InitialState(start, empty, empty),
            horizon=5,
        )
        last = Matrix.column(run.snapshots[-1].plant)
        note.counts(last != plant.A.power(5) @ x)
        note.check(
            "five steps of the agents are five powers of A + Σ B_i F_i C_i",
            last == feedback(plant, gains).A.power(5) @ x,
        )
        if note.here == PAPER:
            loop = feedback(plant, gains).A
            note.refute("late", last != loop.power(4) @ x)
            note.refute("continuous", last != (Matrix.identity(plant.n) + loop).power(5) @ x)


def assumptions(note: Notebook) -> None:
    """Joint controllability and observability; B_i ≠ 0 and C_i ≠ 0."""
    for plant in note.each(plants(10)):
        note.joint(plant)
        note.counts(needs_gains(plant))
        live = all(not c.B.is_zero() and not c.C.is_zero() for c in plant.channels)
        note.check("B_i and C_i are not zero", live)
    plant = note.at((PAPER, three_channels()))
    for i, name in enumerate(plant.names):
        single = MultiChannelSystem(plant.A, [plant.B(i)], [plant.C(i)], names=[name])
        reach, sight = joint_controllability(single), joint_observability(single)
        note.certify(reach, sight)
        note.refute("one-channel", not (reach.controllable and sight.controllable))


def neighbor_sets(note: Notebook) -> None:
    """Agent i receives messages of j if and only if j → i is an edge; N_i contains i."""
    for plant in note.each(plants(10, connected=None)):
        graph = graph_of(plant)
        own = all(i in graph.neighborhood(i) for i in range(plant.m))
        note.check("every agent is its own neighbor", own)
        edges = {(j, i) for i in range(plant.m) for j in graph.neighborhood(i) if j != i}
        note.counts(0 < len(edges) < plant.m * (plant.m - 1))
        note.check("the edges are the neighbors", set(graph.edges()) == edges)
        x = Numbers(3).column(plant.n)
        y = outputs(plant, x)
        for i in range(plant.m):
            heard = graph.neighborhood(i)
            note.check(
                f"C of the neighbors of {plant.names[i]} stacks their outputs",
                plant.output_matrix(heard) @ x == stacked([y[j] for j in heard]),
            )
    plant = note.at((PAPER, three_channels()))
    graph = graph_of(plant)
    followers = [{i for i in range(3) if j in graph.neighborhood(i)} for j in range(3)]
    sets = [set(graph.neighborhood(i)) for i in range(3)]
    note.check("N_1, N_2, N_3 are as printed", sets == [{0, 1}, {1, 2}, {0, 2}])
    note.refute("followers", sets != followers)
    note.refute("without-itself", all(i in N for i, N in enumerate(sets)))


PROBLEM: dict[str, Procedure] = {
    "equation-1": continuous,
    "equation-2": discrete,
    "jointly": assumptions,
    "neighbor-graph": neighbor_sets,
}


# Section IV-A and IV-B: fixed spectra, transfer graphs, and the example of three channels.


def definition(note: Notebook) -> None:
    """No F moves Λ_fixed: its polynomial is the greatest common divisor over drawn loops."""
    numbers = Numbers(11)
    for plant in note.each(drawn_plants(8, states=4), drawn_plants(3, states=4, fixed=True)):
        spectrum = fixed_spectrum(plant)
        note.counts(not spectrum.empty)
        loops = [characteristic_polynomial(closed_by(plant, numbers.gains(plant))) for _ in "1234"]
        note.check(
            "the fixed polynomial divides the polynomial of every loop",
            all(spectrum.polynomial.divides(each) for each in loops),
        )
        shared = reduce(Polynomial.gcd, loops, characteristic_polynomial(plant.A))
        note.check(
            "four drawn loops share nothing else",
            shared.squarefree_part() == spectrum.polynomial.squarefree_part(),
        )
        note.certify(spectrum)
        own = characteristic_polynomial(plant.A).squarefree_part()
        if not spectrum.empty:
            note.refute("empty", spectrum.polynomial.degree > 0)
            moved = own // own.gcd(spectrum.polynomial)
            if moved.degree:
                note.refute("spectrum-of-A", not moved.divides(spectrum.polynomial))


def proposition_2(note: Notebook) -> None:
    """Proposition 2: a fixed mode has a subset with a rank below n; the example has six subsets."""
    for plant in note.each(drawn_plants(10, states=4, fixed=True, first=11)):
        spectrum = fixed_spectrum(plant)
        note.counts(not spectrum.empty)
        note.check("a planted fixed mode is found", not spectrum.empty)
        for factor in spectrum.factors:
            rank = pencil_rank(plant, factor.channels, factor.polynomial)
            note.check("its pencil has rank below n", rank.rank < plant.n)
            note.check("for a proper nonempty subset", 0 < len(factor.channels) < plant.m)
            note.certify(rank)
        note.certify(spectrum)
    example = three_channels()
    for name, system in (
        (PAPER, example),
        (f"{PAPER}, sharing outputs", augmented_outputs(example)),
    ):
        note.on(name, system)
        ranks = [pencil_rank(system, s, 1) for s in SUBSETS_OF_THREE]
        spectrum = fixed_spectrum(system)
        note.counts(not spectrum.empty)
        note.check(
            "1 is fixed just when one of the six pencils has rank below 3",
            any(each.rank < 3 for each in ranks) != spectrum.empty,
        )
        note.certify(spectrum, *ranks)
    name, plant = split_spectrum()
    note.on(f"{name} but outputs")
    shared = augmented_outputs(plant)
    ranks, spectrum = [pencil_rank(shared, s, 0) for s in SUBSETS_OF_THREE], fixed_spectrum(shared)
    note.refute("at-most-n", spectrum.empty and min(each.rank for each in ranks) == shared.n)
    note.certify(spectrum, *ranks)
    # The subset has two channels, and every single one has full rank.
    for plant in note.each(_two_of_three()):
        spectrum = fixed_spectrum(plant)
        mode = spectrum.factors[0].polynomial
        single = [pencil_rank(plant, [name], mode) for name in plant.names]
        note.refute("single-channels", all(each.rank >= plant.n for each in single))
        note.certify(spectrum, *single)


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
    for plant in note.each(plants(8), deficient_plants(4)):
        note.counts(uses_few_directions(plant))
        for mode, _ in characteristic_polynomial(plant.A).factor():
            for s in ((), plant.names):
                answer = pencil_rank(plant, s, mode)
                note.check(
                    "the pencil of ∅ or of all channels has rank at least n", answer.rank >= plant.n
                )
                note.certify(answer)
    plant = note.at((f"{PAPER}, sharing outputs", augmented_outputs(three_channels())))
    rank = pencil_rank(plant, ["2"], 1)
    note.refute("other-subsets", rank.rank < plant.n)
    note.certify(rank)


def transfer(note: Notebook) -> None:
    """The transfer graph: an edge j → i iff some C_i A^k B_j is not 0, k < n."""
    for plant in note.each(plants(14)):
        graph = transfer_graph(plant)
        powers = [Matrix.identity(plant.n)]
        for _ in range(plant.n - 1):
            powers.append(powers[-1] @ plant.A)
        edges = {
            (plant.names[j], plant.names[i])
            for j in range(plant.m)
            for i in range(plant.m)
            if i != j and any(not (plant.C(i) @ P @ plant.B(j)).is_zero() for P in powers)
        }
        missing = len(edges) < plant.m * (plant.m - 1)
        note.counts(missing or _direct(plant) != edges)
        note.check(
            "its edges are the nonzero blocks",
            set(graph.arcs) - {(c, c) for c in plant.names} == edges,
        )
        note.certify(graph)
    note.on(PAPER)
    plant = three_channels()
    graph = transfer_graph(plant)
    backwards = {(i, j) for j, i in graph.arcs}
    note.refute("backwards", set(graph.arcs) != backwards)
    between = set(graph.arcs) - {(c, c) for c in plant.names}
    note.refute("direct", between != _direct(plant))


def _direct(plant: MultiChannelSystem) -> set[tuple[str, str]]:
    """The edges from one channel to another where C_i B_j is not 0."""
    return {
        (plant.names[j], plant.names[i])
        for j in range(plant.m)
        for i in range(plant.m)
        if i != j and not (plant.C(i) @ plant.B(j)).is_zero()
    }


def corfmat_morse(note: Notebook) -> None:
    """Without fixed modes and strongly connected: some F serves each single channel."""
    for plant in note.each(plants(14), _extended(4)):
        whole = completeness(plant)
        gains = single_channel_gains(plant)
        note.counts(whole.complete and needs_gains(plant))
        note.check(
            "gains for every channel exist just when it is complete", gains.exists == whole.complete
        )
        note.certify(whole, gains)
    for name, plant in (_in_series(), *deficient_plants(2, share="states")):
        note.on(name, plant)
        gains, fixed, graph = (
            single_channel_gains(plant),
            fixed_spectrum(plant),
            transfer_graph(plant),
        )
        if fixed.empty:
            note.refute("any-transfer-graph", not graph.strongly_connected and not gains.exists)
        else:
            note.refute("fixed-modes", graph.strongly_connected and not gains.exists)
        note.certify(gains, fixed, graph)


def _extended(count: int) -> Iterator[Instance]:
    """The extended systems of plants with a bound, with as many shared sub-states."""
    for name, plant in deficient_plants(count):
        bound = shared_dimension_bound(plant).deficiency
        yield f"{name}, extended", extended_system(plant, [bound] * plant.m)


def free_assignment(note: Notebook) -> None:
    """For a complete system, one channel controller assigns any symmetric spectrum."""
    for name, plant in plants(6, states=2, channels=2):
        if not completeness(plant).complete:
            continue
        note.on(name, plant)
        note.counts(needs_gains(plant))
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
    graph = transfer_graph(plant)
    note.counts(len(graph.components) > 1)
    note.check("there are two strong components", len(graph.components) == 2)
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
    note.certify(graph, fixed_spectrum(plant), design.loop.proof)


def wang_davison(note: Notebook) -> None:
    """Linear time-invariant control achieves any rate if and only if no mode is fixed."""
    for plant in note.each(
        drawn_plants(8, states=3, channels=2, first=21),
        drawn_plants(5, states=3, channels=2, fixed=True, first=21),
    ):
        spectrum = fixed_spectrum(plant)
        note.certify(spectrum)
        fast = 1000
        note.counts(not StabilityRegion.of("continuous", fast).contains_roots_of(_modes(plant)))
        try:
            design = design_decentralized(plant, rate=fast, aims=THEOREM)
        except Impossible as refused:
            note.check("refused because something is fixed", not spectrum.empty)
            note.refute("always", not spectrum.empty)
            note.certify(refused.certificate)
        else:
            note.check("a rate of 1000 is reached because nothing is fixed", spectrum.empty)
            note.certify(design.loop.proof)


def _modes(plant: MultiChannelSystem) -> Polynomial:
    """The characteristic polynomial of A."""
    return characteristic_polynomial(plant.A)


def wang_davison_discrete(note: Notebook) -> None:
    """In discrete time the fixed modes that hinder a rate are those other than 0."""
    plant = note.at(fixed_zero())
    note.print(plant)
    spectrum = fixed_spectrum(plant)
    note.check("0 is the only fixed mode", spectrum.polynomial == Polynomial.x())
    design = design_decentralized(plant, radius="1/100", aims=THEOREM)
    inside = StabilityRegion.of("discrete", radius="1/100")
    note.counts(not inside.contains_roots_of(_modes(plant)))
    reached = inside.contains_roots_of(design.loop.polynomial or Polynomial.of(0))
    note.check("every eigenvalue of the loop is below 1/100", reached)
    note.refute("zero-hinders", reached and not spectrum.empty)
    note.certify(spectrum, design.loop.proof)
    for plant in note.each(deficient_plants(2, share="states", time="discrete")):
        spectrum = fixed_spectrum(plant)
        hindered = spectrum.polynomial.squarefree_part() not in (Polynomial.of(1), Polynomial.x())
        note.counts(hindered)
        if hindered:
            note.refute("nothing-hinders")
        note.certify(spectrum)
    for plant in note.each(drawn_plants(6, states=3, channels=2, time="discrete", first=21)):
        spectrum = fixed_spectrum(plant)
        note.counts(not inside.contains_roots_of(_modes(plant)))
        nonzero = spectrum.polynomial.squarefree_part() not in (Polynomial.of(1), Polynomial.x())
        try:
            slow = design_decentralized(plant, radius="1/100", aims=THEOREM)
        except Impossible as refused:
            note.check("refused because a nonzero mode is fixed", nonzero)
            note.certify(refused.certificate)
        else:
            note.check("reached because no nonzero mode is fixed", not nonzero)
            note.certify(slow.loop.proof)


DECENTRALIZED: dict[str, Procedure] = {
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


# Section IV-B: sharing outputs, and the example of three channels.


def dynamic(note: Notebook) -> None:
    """No dynamic controller that shares outputs alone moves the mode 1 of the example."""
    numbers = Numbers(18)
    for time in TIMES:
        plant = note.at((f"{PAPER}, {time} time", three_channels(time)))
        shared = augmented_outputs(plant)
        spectrum = fixed_spectrum(shared)
        note.counts(not spectrum.empty)
        note.check("1 is fixed when outputs are shared", spectrum.polynomial(1) == 0)
        note.certify(spectrum)
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
            extended = extended_system(base, orders, "states")
            loop = closed_by(extended, numbers.gains(extended))
            note.check(
                f"1 stays with private states of dimensions {orders}",
                characteristic_polynomial(loop)(1) == 0,
            )
    plant = note.at((PAPER, three_channels()))
    one = fixed_spectrum(extended_system(plant, [0, 0, 1]))
    note.refute("sharing-one", one.empty)
    note.certify(one)


def sharing_states(note: Notebook) -> None:
    """It is enough to share the estimates x_i: no output of another agent is used."""
    plant = note.at((PAPER, three_channels()))
    for each in note.each(small()):
        design = designed(note.here)
        note.counts(not fixed_spectrum(each).empty)
        for i, agent in enumerate(design.controller.agents):
            others = {j for law in agent.maps() for j in law.outputs} - {i}
            note.check(f"agent {agent.name} uses its own output alone", not others)
            note.check(f"agent {agent.name} sends an estimate of x", agent.shared == each.n)
        note.check("the loop is stable", closed_loop_spectrum(design.loop.matrix, each.time).stable)
        note.certify(design.loop.proof)
    note.on(PAPER)
    spectrum = fixed_spectrum(extended_system(plant, [plant.n] * plant.m, "states"))
    note.check("with n_i = n and no outputs nothing is fixed", spectrum.empty)
    note.certify(spectrum)
    nothing = fixed_spectrum(augmented_outputs(plant))
    note.refute("outputs-alone", not nothing.empty)
    note.certify(nothing)


def example(note: Notebook) -> None:
    """IV-B: the mode 1 stays fixed when agents share outputs alone."""
    plant = three_channels()
    system = augmented_outputs(plant)
    note.on(PAPER, plant)
    note.joint(plant)
    note.print(plant)
    rank = pencil_rank(system, ["2"], 1)
    note.check("rank [I − A, B_1, B_3; C_{N_2}, 0, 0] is 2", rank.rank == 2)
    spectrum = fixed_spectrum(system)
    note.counts(not spectrum.empty)
    note.check("the fixed polynomial is x − 1", spectrum.polynomial == Polynomial.from_roots([1]))
    note.check(
        "no linear time-invariant distributed control with outputs alone stabilizes it",
        not spectrum.stabilizable,
    )
    note.certify(rank, spectrum)
    note.check("A, B_i and C_i are as printed", _as_printed(plant))
    others = [pencil_rank(system, s, 1) for s in SUBSETS_OF_THREE if s != ("2",)]
    note.refute("other-subsets", all(each.rank >= plant.n for each in others))
    note.certify(*others)
    _neighbors_of_the_example(note, plant)
    note.on(PAPER)
    alone = MultiChannelSystem(
        system.A, [c.B for c in system.channels], [c.C for c in system.channels]
    )
    try:
        design_decentralized(alone, rate="1/100")
    except Impossible as refused:
        reason = refused.certificate
        because = isinstance(reason, FixedSpectrum) and reason.polynomial(1) == 0
        note.check("a design is refused, with the fixed mode as the reason", because)
        note.certify(reason)
    else:
        note.check("a design is refused", False)
    heard = analyze(plant, ["fixed_spectrum", "transfer_graph"], information="outputs")
    for drawn in graph_pictures(heard.account):
        note.show(drawn)


def _as_printed(plant: MultiChannelSystem) -> bool:
    """Whether A, all B_i and all C_i of the example have the entries that the paper prints."""
    e1, e2 = [[1], [0], [0]], [[0], [1], [0]]
    printed = [
        [[1, 0, 0], [0, 1, 0], [0, 1, 1]],
        *(e1, e2, e1),
        *([[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]),
    ]
    matrices = [plant.A, *map(plant.B, range(3)), *map(plant.C, range(3))]
    return matrices == [Matrix.from_integers(rows) for rows in printed]


def _neighbors_of_the_example(note: Notebook, plant: MultiChannelSystem) -> None:
    """Small changes of the example that change its conclusion."""
    note.on(f"{PAPER}, with A_32 = 0")
    still = MultiChannelSystem(
        Matrix.identity(3),
        [channel.B for channel in plant.channels],
        [channel.C for channel in plant.channels],
    )
    lost = joint_controllability(still)
    note.refute("A_32", not lost.controllable)
    note.certify(lost)
    note.on(f"{PAPER}, over the complete graph")
    everyone = {name: [other for other in plant.names if other != name] for name in plant.names}
    complete = fixed_spectrum(augmented_outputs(plant.with_neighbors(everyone)))
    note.refute("any-graph", complete.empty)
    note.certify(complete)


def shared_outputs(note: Notebook) -> None:
    """(23): agent i receives the outputs y_j of its neighbors."""
    numbers = Numbers(12)
    for plant in note.each(plants(10, connected=None)):
        shared = augmented_outputs(plant)
        x = numbers.column(plant.n)
        y = outputs(plant, x)
        graph = graph_of(plant)
        right = all(
            shared.C(i) @ x == stacked([y[j] for j in graph.neighborhood(i)])
            for i in range(plant.m)
        )
        note.counts(bool(graph.edges()))
        note.check("ȳ_i is column{y_j, j ∈ N_i}", right)
        note.check("A and B_i are the plant's", shared.A == plant.A)
        note.certify(fixed_spectrum(shared))
    plant = note.at((PAPER, three_channels()))
    shared, x = augmented_outputs(plant), numbers.column(plant.n)
    y = outputs(plant, x)
    seen = shared.C(1) @ x
    note.check("N_2 = {2, 3}", seen == stacked([y[1], y[2]]))
    note.refute("followers", seen != stacked([y[1], y[0]]))
    note.refute("without-own", seen != y[2])


EXAMPLE: dict[str, Procedure] = {
    "equation-23": shared_outputs,
    "example": example,
    "dynamic": dynamic,
    "sharing-states": sharing_states,
}
