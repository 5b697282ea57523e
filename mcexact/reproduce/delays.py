"""Section V: transmission delays."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from mcexact.analysis.allocation import shared_dimension_bound
from mcexact.analysis.closed_loop_spectrum import closed_loop_spectrum
from mcexact.analysis.completeness import completeness
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.transfer_graph import transfer_graph
from mcexact.derived.delayed import held_system, lifted_system
from mcexact.derived.extended import shift
from mcexact.exact.blocks import vstack
from mcexact.exact.linear_algebra import rank
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.report.loop_figures import delays_picture
from mcexact.reproduce.equations import delayed_agrees
from mcexact.reproduce.material import Numbers, drawn_plants, plants, three_channels
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import graph_of
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.extended import design_extended

X = Polynomial.x()


def shifts(note: Notebook) -> None:
    """`bunn` and `lift`: S_d moves everything by one place and forgets the last."""
    for d in range(1, 6):
        note.on(f"d = {d}")
        values = Matrix.column(range(1, d + 1))
        moved = Matrix.column([0, *range(1, d)])
        note.check("S_d (a_1, …, a_d) is (0, a_1, …, a_{d−1})", shift(d) @ values == moved)
        note.check("after d steps nothing is left", shift(d).power(d).is_zero())


def lifted(note: Notebook) -> None:
    """`emcsdd`: the lifted system is what links with delays bring."""
    numbers = Numbers(15)
    for name, plant in plants(14, time="discrete", longest_delay=3, connected=None):
        sizes = [k % 3 for k in range(1, plant.m + 1)]
        note.on(f"{name}, n_i = {sizes}")
        made = lifted_system(plant, sizes)
        graph = graph_of(plant)
        d = [graph.longest_delay(i) for i in range(plant.m)]
        size = plant.n + sum(sizes[i] + d[i] * (sizes[i] + plant.q(i)) for i in range(plant.m))
        note.check("it has ñ = n + Σ (n_i + d_i n_i + d_i q_i) states", made.n == size)
        note.check(
            "agents see what comes late, step by step",
            delayed_agrees(plant, made, sizes, False, numbers),
        )
        note.certify(fixed_spectrum(made))


def held(note: Notebook) -> None:
    """`emcsdd-hold`: everybody sees x_i(t − d_i) at the same time."""
    numbers = Numbers(16)
    for name, plant in plants(14, time="discrete", longest_delay=3, connected=None):
        sizes = [k % 3 for k in range(1, plant.m + 1)]
        note.on(f"{name}, n_i = {sizes}")
        made = held_system(plant, sizes)
        graph = graph_of(plant)
        size = plant.n + sum((1 + graph.longest_delay(i)) * sizes[i] for i in range(plant.m))
        note.check("it has n̂ = n + Σ (n_i + d_i n_i) states", made.n == size)
        note.check(
            "agents see what is released, step by step",
            delayed_agrees(plant, made, sizes, True, numbers),
        )
        note.certify(fixed_spectrum(made))


def _union(plant_edges: Sequence[tuple[str, str]], graph: NeighborGraph) -> set[tuple[str, str]]:
    """The edges of the neighbor graph and of the plant's transfer graph."""
    return set(plant_edges) | {(graph.names[j], graph.names[i]) for j, i in graph.edges()}


def transfer_of_the_lift(note: Notebook) -> None:
    """n_i > 0: both graphs lie in the transfer graph of the lifted system."""
    for name, plant in plants(8, time="discrete", longest_delay=2):
        note.on(name)
        before, after = transfer_graph(plant), transfer_graph(lifted_system(plant, [1] * plant.m))
        note.check(
            "the union is a subgraph", _union(before.arcs, graph_of(plant)) <= set(after.arcs)
        )
        note.certify(before, after)


def block_ranks(note: Notebook) -> None:
    """`eqn:blk-rank`: [M_k; e_i'] is nonsingular for λ ≠ 0."""
    for value in (Fraction(1), Fraction(-2), Fraction(1, 3)):
        note.on(f"λ = {value}")
        for k in range(1, 6):
            rows = [[0] * (k + 1) for _ in range(k)]
            M = Matrix.from_rows(
                [
                    [-1 if c == r else value if c == r + 1 else 0 for c in range(k + 1)]
                    for r in range(len(rows))
                ]
            )
            unit = Matrix.identity(k + 1)
            ranks = [rank(vstack([M, unit.take(rows=[i])])) for i in range(k + 1)]
            note.check(f"k = {k}: the rank is k + 1 for every i", ranks == [k + 1] * (k + 1))


def only_zero_is_lost(note: Notebook) -> None:
    """The lifted system is jointly observable; what is out of reach is at 0."""
    for name, plant in plants(10, time="discrete", longest_delay=2):
        note.on(name)
        made = lifted_system(plant, [1] * plant.m)
        sight, reach = joint_observability(made), joint_controllability(made)
        note.check("jointly observable", sight.controllable)
        note.check(
            "uncontrollable modes are at 0",
            not any(reach.uncontrollable_polynomial.coefficients[:-1]),
        )
        note.certify(sight, reach)


def theorem_3(note: Notebook) -> None:
    """Theorem 3: at Theorem 2's bound nothing but 0 is fixed."""
    for name, plant in (
        *plants(8, time="discrete", longest_delay=2),
        *drawn_plants(5, time="discrete", longest_delay=2, fixed=True, first=71),
    ):
        note.on(name)
        bound = shared_dimension_bound(plant)
        found = fixed_spectrum(lifted_system(plant, [bound.deficiency] * plant.m))
        note.check("nothing but 0 is fixed", found.polynomial in (Polynomial.of(1), X))
        note.certify(bound, found)


def theorem_3_states(note: Notebook) -> None:
    """The same for sub-states alone, with the bound of Remark 2."""
    for name, plant in plants(8, time="discrete", longest_delay=2):
        note.on(name)
        bound = shared_dimension_bound(plant, share="states")
        made = lifted_system(plant, [bound.deficiency] * plant.m, "states")
        found = fixed_spectrum(made)
        note.check("nothing but 0 is fixed", found.polynomial in (Polynomial.of(1), X))
        note.certify(bound, found)


def corollary_2(note: Notebook) -> None:
    """Corollary 2: a controller for late messages, of any radius, run on the links themselves."""
    runs = []
    for delay in (0, 1, 2):
        plant = three_channels("discrete", delay)
        note.on(f"the example of section IV-B, discrete time, delay {delay} on every link")
        design = design_extended(plant, radius="1/2")
        note.check("radius 1/2 is certified", design.design.stability is not None)
        note.certify(*design.certificates.values())
        run = simulate(plant, design.design.controller, horizon=12 + 4 * delay)
        spectrum = closed_loop_spectrum(design.design.loop.matrix, "discrete")
        note.check("the loop is stable", spectrum.stable)
        runs.append((delay, run))
    note.show(delays_picture(runs))


def held_joint(note: Notebook) -> None:
    """The held system is jointly controllable and observable."""
    for name, plant in plants(10, time="discrete", longest_delay=2):
        note.on(name)
        made = held_system(plant, [1] * plant.m)
        for found in (joint_controllability(made), joint_observability(made)):
            note.check("jointly controllable and observable", found.controllable)
            note.certify(found)


def outputs_lose_controllability(note: Notebook) -> None:
    """Sending y_i under delays can leave 0 fixed; sending x_i alone and holding does not."""
    plant = three_channels("discrete", 1)
    note.on("the example of section IV-B, discrete time, delay 1 on every link")
    sent = joint_controllability(lifted_system(plant, [1, 1, 1]))
    note.check("with outputs on the links 0 is out of reach", not sent.controllable)
    kept = fixed_spectrum(held_system(plant, [1, 1, 1]))
    note.check("with holding nothing is fixed", kept.empty)
    note.certify(sent, kept)


def theorem_4(note: Notebook) -> None:
    """Theorem 4: at Remark 2's bound nothing is fixed in the held system."""
    for name, plant in (
        *plants(8, time="discrete", longest_delay=2),
        *drawn_plants(5, time="discrete", longest_delay=2, fixed=True, first=71),
    ):
        note.on(name)
        bound = shared_dimension_bound(plant, share="states")
        found = fixed_spectrum(held_system(plant, [bound.deficiency] * plant.m))
        note.check("nothing is fixed", found.empty)
        note.certify(bound, found)


def transfer_of_the_held(note: Notebook) -> None:
    """n_i > 0: strongly connected iff the union of neighbor and transfer graphs is."""
    for name, plant in (
        *plants(5, time="discrete", longest_delay=2),
        *drawn_plants(8, time="discrete", longest_delay=2, connected=False),
    ):
        note.on(name)
        before, after = transfer_graph(plant), transfer_graph(held_system(plant, [1] * plant.m))
        places = {agent: i for i, agent in enumerate(plant.names)}
        heard: list[list[int]] = [[] for _ in plant.names]
        for j, i in _union(before.arcs, graph_of(plant)):
            if i != j:
                heard[places[i]].append(places[j])
        union = NeighborGraph(plant.names, heard)
        note.check(
            "strongly connected just when the union is",
            after.strongly_connected == union.is_strongly_connected(),
        )
        note.certify(before, after)


def free_assignment(note: Notebook) -> None:
    """With holding the spectrum is assigned freely in spite of delays."""
    plant = three_channels("discrete", 1)
    note.on("the example of section IV-B, discrete time, delay 1 on every link")
    sizes = (1, 1, 1)
    note.certify(completeness(held_system(plant, sizes)))
    least = design_extended(plant, network="held", dimensions=sizes, radius="1/2")
    degree = least.design.loop.matrix.nrows
    wanted = [Fraction(k % 3, 4) for k in range(degree)]
    design = design_extended(plant, network="held", dimensions=sizes, spectrum=wanted)
    note.check(
        "the loop has the prescribed spectrum",
        design.design.loop.polynomial == Polynomial.from_roots(wanted),
    )
    note.certify(*design.certificates.values())


PROCEDURES: dict[str, Procedure] = {
    "lift": shifts,
    "emcsdd": lifted,
    "emcsdd-graph": transfer_of_the_lift,
    "eqn:blk-rank": block_ranks,
    "emcsdd-joint": only_zero_is_lost,
    "thm:strg-graph-delay": theorem_3,
    "thm3-states": theorem_3_states,
    "cor:strg-graph-delay": corollary_2,
    "not-controllable": outputs_lose_controllability,
    "emcsdd-hold": held,
    "hold-joint": held_joint,
    "thm:strg-graph-delay-hold": theorem_4,
    "hold-graph": transfer_of_the_held,
    "hold-free": free_assignment,
}
