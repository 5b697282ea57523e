"""Section V: transmission delays."""

from __future__ import annotations

from fractions import Fraction
from functools import partial

from mcexact.analysis.fixed_modes.completeness import completeness
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.sharing.allocation import shared_dimension_bound
from mcexact.analysis.stability.closed_loop_spectrum import closed_loop_spectrum
from mcexact.analysis.structure.controllability import joint_controllability, joint_observability
from mcexact.analysis.structure.transfer_graph import transfer_graph
from mcexact.derived.delayed import held_system, lifted_system
from mcexact.derived.extended import shift
from mcexact.exact.blocks import vstack
from mcexact.exact.linear_algebra import rank
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.reproduce.equations import messages_agree, positions, union_of_graphs
from mcexact.reproduce.figures import delays_picture
from mcexact.reproduce.material import Numbers, drawn_plants, graph_of, plants, three_channels
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import apart, split_spectrum
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.extended import design_extended
from mcexact.synthesis.optimum.aims import THEOREM

X, ONE = Polynomial.x(), Polynomial.of(1)
WITHOUT_SHARING = "The same with n_i = 0."
late = partial(plants, time="discrete", longest_delay=2)
late_drawn = partial(drawn_plants, time="discrete", longest_delay=2)


def shifts(note: Notebook) -> None:
    """(32) and (33): S_d shifts the blocks by one place and drops the last."""
    for d in range(1, 6):
        note.on(f"d = {d}")
        values = Matrix.column(range(1, d + 1))
        moved = Matrix.column([0, *range(1, d)])
        note.check("S_d (a_1, …, a_d) is (0, a_1, …, a_{d−1})", shift(d) @ values == moved)
        note.check("after d steps nothing is left", shift(d).power(d).is_zero())


def lifted(note: Notebook) -> None:
    """(34): the lifted system gives the signals that arrive over links with delays."""
    numbers = Numbers(15)
    for name, plant in plants(14, time="discrete", longest_delay=3, connected=None):
        sizes = [k % 3 for k in range(1, plant.m + 1)]
        note.on(f"{name}, n_i = {sizes}")
        made = lifted_system(plant, sizes)
        graph = graph_of(plant)
        d = [graph.longest_delay(i) for i in range(plant.m)]
        delays = {(i, j): d_ij for i, j, d_ij in graph.delays}
        size = plant.n + sum(sizes[i] + d[i] * (sizes[i] + plant.q(i)) for i in range(plant.m))
        note.check("it has ñ = n + Σ (n_i + d_i n_i + d_i q_i) states", made.n == size)
        note.check(
            "agents see what comes late, step by step",
            messages_agree(plant, made, sizes, "outputs+states", delays, numbers),
        )
        note.certify(fixed_spectrum(made))


def held(note: Notebook) -> None:
    """(37): all followers of i receive x_i(t − d_i) at the same time."""
    numbers = Numbers(16)
    for name, plant in plants(14, time="discrete", longest_delay=3, connected=None):
        sizes = [k % 3 for k in range(1, plant.m + 1)]
        note.on(f"{name}, n_i = {sizes}")
        made = held_system(plant, sizes)
        graph = graph_of(plant)
        d = [graph.longest_delay(i) for i in range(plant.m)]
        delays = {(i, j): d[j] for i in range(plant.m) for j in graph.neighborhood(i)}
        size = plant.n + sum((1 + d[i]) * sizes[i] for i in range(plant.m))
        note.check("it has n̂ = n + Σ (n_i + d_i n_i) states", made.n == size)
        note.check(
            "agents see what is released, step by step",
            messages_agree(plant, made, sizes, "states", delays, numbers),
        )
        note.certify(fixed_spectrum(made))


def transfer_of_the_lift(note: Notebook) -> None:
    """n_i > 0: both graphs lie in the transfer graph of the lifted system."""
    for plant in note.each(late(8)):
        before, after = transfer_graph(plant), transfer_graph(lifted_system(plant, [1] * plant.m))
        union = union_of_graphs(plant, before)
        note.check("the union is a subgraph", set(union.edges()) <= positions(plant, after))
        note.certify(before, after)


def block_ranks(note: Notebook) -> None:
    """(36): [M_k; e_i'] is nonsingular for λ ≠ 0."""
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
    """The lifted system is jointly observable, and its uncontrollable modes are at 0."""
    for plant in note.each(late(10)):
        made = lifted_system(plant, [1] * plant.m)
        sight, reach = joint_observability(made), joint_controllability(made)
        note.check("jointly observable", sight.controllable)
        note.check(
            "uncontrollable modes are at 0",
            not any(reach.uncontrollable_polynomial.coefficients[:-1]),
        )
        note.certify(sight, reach)


def theorem_3(note: Notebook) -> None:
    """Theorem 3: with dimensions at Theorem 2's bound, no mode except 0 is fixed."""
    for plant in note.each(
        late(8),
        late_drawn(5, fixed=True, first=71),
    ):
        bound = shared_dimension_bound(plant)
        found = fixed_spectrum(lifted_system(plant, [bound.deficiency] * plant.m))
        note.check("nothing but 0 is fixed", found.polynomial in (ONE, X))
        note.certify(bound, found)


def free_of_the_lift(note: Notebook) -> None:
    """With n_i ≥ 1 the transfer graph is strongly connected; with n_i = 0 it need not be."""
    for plant in note.each(late(5)):
        size = max(1, shared_dimension_bound(plant).deficiency)
        made = lifted_system(plant, [size] * plant.m)
        found, graph = fixed_spectrum(made), transfer_graph(made)
        note.check("the transfer graph is strongly connected", graph.strongly_connected)
        note.check("nothing but 0 is fixed", found.polynomial.squarefree_part() in (ONE, X))
        note.certify(found, graph)
    plant = note.at(split_spectrum("discrete", 1))
    bound, alone = shared_dimension_bound(plant), lifted_system(plant, [0] * plant.m)
    graph, whole = transfer_graph(alone), completeness(alone)
    note.check("n_i = 0 meets the hypotheses of Theorem 3", bound.deficiency == 0)
    note.refute(WITHOUT_SHARING, len(graph.components) > 1 and not whole.complete)
    note.certify(bound, graph, whole)


def theorem_3_states(note: Notebook) -> None:
    """Theorem 3 for sub-states alone, with the bound of Remark 2."""
    for plant in note.each(late(8)):
        bound = shared_dimension_bound(plant, share="states")
        made = lifted_system(plant, [bound.deficiency] * plant.m, "states")
        found = fixed_spectrum(made)
        note.check("nothing but 0 is fixed", found.polynomial in (ONE, X))
        note.certify(bound, found)


def corollary_2(note: Notebook) -> None:
    """Corollary 2: a controller achieves any radius over links with delays."""
    runs = []
    for delay in (0, 1, 2):
        plant = three_channels("discrete", delay)
        note.on(f"the example of section IV-B, discrete time, delay {delay} on every link")
        design = design_extended(plant, radius="1/2", aims=THEOREM)
        note.check("radius 1/2 is certified", "stability" in design.certificates)
        note.certify(*design.certificates.values())
        run = simulate(plant, design.controller, horizon=12 + 4 * delay)
        spectrum = closed_loop_spectrum(design.loop.matrix, "discrete")
        note.check("the loop is stable", spectrum.stable)
        runs.append((delay, run))
    note.show(delays_picture(runs))


def held_joint(note: Notebook) -> None:
    """The held system is jointly controllable and observable."""
    for plant in note.each(late(10)):
        made = held_system(plant, [1] * plant.m)
        note.joint(made)


def outputs_lose_controllability(note: Notebook) -> None:
    """Sending y_i with delays can make 0 fixed; holding and sending x_i alone does not."""
    plant = three_channels("discrete", 1)
    note.on("the example of section IV-B, discrete time, delay 1 on every link")
    sent = joint_controllability(lifted_system(plant, [1, 1, 1]))
    note.check("with outputs on the links 0 is out of reach", not sent.controllable)
    kept = fixed_spectrum(held_system(plant, [1, 1, 1]))
    note.check("with holding nothing is fixed", kept.empty)
    note.certify(sent, kept)


def theorem_4(note: Notebook) -> None:
    """Theorem 4: with dimensions at Remark 2's bound, the held system has no fixed mode."""
    for plant in note.each(
        late(8),
        late_drawn(5, fixed=True, first=71),
    ):
        bound = shared_dimension_bound(plant, share="states")
        found = fixed_spectrum(held_system(plant, [bound.deficiency] * plant.m))
        note.check("nothing is fixed", found.empty)
        note.certify(bound, found)


def transfer_of_the_held(note: Notebook) -> None:
    """n_i > 0: strongly connected iff the union of neighbor and transfer graphs is."""
    for plant in note.each(
        late(5),
        late_drawn(8, connected=False),
    ):
        before, after = transfer_graph(plant), transfer_graph(held_system(plant, [1] * plant.m))
        union = union_of_graphs(plant, before)
        note.check(
            "strongly connected just when the union is",
            after.strongly_connected == union.is_strongly_connected(),
        )
        note.certify(before, after)


def free_assignment(note: Notebook) -> None:
    """With holding, the whole spectrum is freely assignable despite delays."""
    plant = three_channels("discrete", 1)
    note.on("the example of section IV-B, discrete time, delay 1 on every link")
    sizes = (1, 1, 1)
    note.certify(completeness(held_system(plant, sizes)))
    least = design_extended(plant, network="held", dimensions=sizes, radius="1/2", aims=THEOREM)
    degree = least.loop.matrix.nrows
    wanted = [Fraction(k % 3, 4) for k in range(degree)]
    design = design_extended(plant, network="held", dimensions=sizes, spectrum=wanted)
    note.check(
        "the loop has the prescribed spectrum",
        design.loop.polynomial == Polynomial.from_roots(wanted),
    )
    note.certify(*design.certificates.values())
    plant = note.at(apart())
    bound = shared_dimension_bound(plant, share="states")
    graph = transfer_graph(held_system(plant, [0] * plant.m))
    found = completeness(held_system(plant, [0] * plant.m))
    note.check("n_i = 0 meets the hypotheses of Theorem 4", bound.deficiency == 0)
    note.refute(WITHOUT_SHARING, not graph.strongly_connected and not found.complete)
    note.certify(bound, graph, found)


PROCEDURES: dict[str, Procedure] = {
    "lift": shifts,
    "emcsdd": lifted,
    "emcsdd-graph": transfer_of_the_lift,
    "eqn:blk-rank": block_ranks,
    "emcsdd-joint": only_zero_is_lost,
    "thm:strg-graph-delay": theorem_3,
    "lift-free": free_of_the_lift,
    "thm3-states": theorem_3_states,
    "cor:strg-graph-delay": corollary_2,
    "not-controllable": outputs_lose_controllability,
    "emcsdd-hold": held,
    "hold-joint": held_joint,
    "thm:strg-graph-delay-hold": theorem_4,
    "hold-graph": transfer_of_the_held,
    "hold-free": free_assignment,
}
