"""Examination of section V: transmission delays, and holding.

The lifted system for links with delays (Theorem 3, in which only the mode 0 can be fixed), and the
held system, which makes the whole spectrum assignable again (Theorem 4).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial, reduce

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.sharing import common_dimension, shared_dimension_bound
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.derived.constructions import Share, closed_by, held_system, lifted_system, shift
from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix, to_float, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.canvas import empty_figure
from mcexact.report.html import Picture
from mcexact.reproduce.instances import (
    Instance,
    Numbers,
    apart,
    deficient_plants,
    drawn_plants,
    graph_of,
    is_late,
    late_example,
    messages_agree,
    plants,
    positions,
    split_spectrum,
    three_channels,
    union_of_graphs,
    unreached,
    with_dimensions,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.simulation.trajectory import Trajectory, simulate
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.optimum.figures import THEOREM

# A picture of the effect of delays.


def delays_picture(runs: Sequence[tuple[int, Trajectory]]) -> Picture:
    """Draw the state of the plant for several delays on the links.

    Parameters
    ----------
    runs : sequence of (delay, trajectory)
    """
    figure = empty_figure(6.0, 3.7)
    axis = figure.subplots()
    words = []
    for delay, run in runs:
        norms = run.state_norms()
        axis.plot([to_float(t) for t in run.times], norms, marker=".", label=f"delay {delay}")
        rest = next((k for k, value in enumerate(norms) if value == 0), None)
        ends = f"exactly 0 from step {rest}" if rest is not None else f"ends at {norms[-1]:.1e}"
        words.append(f"delay {delay}: largest {max(norms):.1e}, {ends}")
    least = min(v for _, run in runs for v in run.state_norms() if v > 0)
    # Linear around 0, so that a state that has come to rest is seen.
    axis.set_yscale("symlog", linthresh=least, linscale=0.4)
    axis.set_ylim(bottom=0)
    axis.set_xlabel("step")
    axis.set_title("largest entry of the state", fontsize="medium")
    axis.legend(fontsize="small")
    return Picture(figure, "The effect of delays", "; ".join(words) + ".")


# Section V: transmission delays.

X, ONE = Polynomial.x(), Polynomial.of(1)
late = partial(plants, time="discrete", longest_delay=2)
late_drawn = partial(drawn_plants, time="discrete", longest_delay=2)
drawn_links = partial(plants, 14, time="discrete", longest_delay=3, connected=None)


def shifts(note: Notebook) -> None:
    """(32) and (33): S_d shifts the blocks by one place and drops the last."""
    for d in range(1, 6):
        note.on(f"d = {d}")
        values = Matrix.column(range(1, d + 1))
        shifted = Matrix.column([0, *range(1, d)])
        note.counts(d > 1)
        note.check("S_d (a_1, …, a_d) is (0, a_1, …, a_{d−1})", shift(d) @ values == shifted)
        note.check("after d steps nothing is left", shift(d).power(d).is_zero())
        if d > 1:
            note.refute("backwards", shift(d).T @ values != shifted)
            note.refute("d-1", not shift(d).power(d - 1).is_zero())


def lifted(note: Notebook) -> None:
    """(34): the lifted system gives the signals that arrive over links with delays."""
    numbers = Numbers(15)
    for instance, sizes in with_dimensions(drawn_links()):
        plant = note.at(instance)
        system = lifted_system(plant, sizes)
        graph = graph_of(plant)
        d = [graph.longest_delay(i) for i in range(plant.m)]
        delays = {(i, j): d_ij for i, j, d_ij in graph.delays}
        size = plant.n + sum(sizes[i] + d[i] * (sizes[i] + plant.q(i)) for i in range(plant.m))
        note.counts(is_late(plant))
        note.check("it has ñ = n + Σ (n_i + d_i n_i + d_i q_i) states", system.n == size)
        note.check(
            "agents see what comes late, step by step",
            messages_agree(plant, system, sizes, "outputs+states", delays, numbers),
        )
        note.certify(fixed_spectrum(system))
    name, plant = three_delays()
    note.on(name, plant)
    graph, sizes, share = graph_of(plant), [1, 1, 1], "outputs+states"
    system = lifted_system(plant, sizes)
    right = {(i, j): d for i, j, d in graph.delays}
    note.counts(is_late(plant))
    note.check("delays as they are", messages_agree(plant, system, sizes, share, right, numbers))
    # As printed: the second entry of ỹ_1 arrives with the delay of the first, d_11 = 0.
    printed = {**right, (0, 1): 0}
    note.refute("as-printed", not messages_agree(plant, system, sizes, share, printed, numbers))
    reversed_ = {(i, j): right.get((j, i), 0) for i, j in right}
    note.refute("d_ji", not messages_agree(plant, system, sizes, share, reversed_, numbers))


def three_delays() -> Instance:
    """The example over the complete graph, every link with a delay of its own."""
    plant = three_channels("discrete")
    links = [(0, 1, 1), (0, 2, 2), (1, 0, 2), (1, 2, 1), (2, 0, 3), (2, 1, 2)]
    graph = NeighborGraph(plant.names, [range(3)] * 3, links)
    return "the example over the complete graph, delays 1 to 3", plant.with_neighbors(graph)


def transfer_of_the_lift(note: Notebook) -> None:
    """n_i > 0: both graphs lie in the transfer graph of the lifted system."""
    for plant in note.each(late(8)):
        before, after = transfer_graph(plant), transfer_graph(lifted_system(plant, [1] * plant.m))
        union = union_of_graphs(plant, before)
        note.counts(not set(union.edges()) <= positions(plant, before))
        note.check("the union is a subgraph", set(union.edges()) <= positions(plant, after))
        note.certify(before, after)
        if set(union.edges()) != positions(plant, after):
            note.refute("equality")
    plant = note.at(split_spectrum("discrete", 1))
    before, after = transfer_graph(plant), transfer_graph(lifted_system(plant, [0] * plant.m))
    union = union_of_graphs(plant, before)
    note.refute("n_i=0", not set(union.edges()) <= positions(plant, after))
    note.certify(before, after)


def block_ranks(note: Notebook) -> None:
    """(36): [M_k; e_i'] is nonsingular for λ ≠ 0."""
    for value in (Fraction(1), Fraction(-2), Fraction(1, 3)):
        note.on(f"λ = {value}".replace("-", "−"))
        note.counts(value != 0)
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
    note.on("λ = 0")
    for k in range(1, 6):
        M = Matrix.from_rows([[-int(c == r) for c in range(k + 1)] for r in range(k)])
        unit = Matrix.identity(k + 1)
        note.refute("zero", rank(vstack([M, unit.take(rows=[0])])) == k)
        note.refute("k", rank(vstack([M, unit.take(rows=[k])])) == k + 1)


def only_zero_is_lost(note: Notebook) -> None:
    """The lifted system is jointly observable, and its uncontrollable modes are at 0."""
    for plant in note.each(late(10)):
        system = lifted_system(plant, [1] * plant.m)
        sight, reach = joint_observability(system), joint_controllability(system)
        note.counts(is_late(plant))
        note.check("jointly observable", sight.controllable)
        note.check(
            "uncontrollable modes are at 0",
            not any(reach.uncontrollable_polynomial.coefficients[:-1]),
        )
        note.certify(sight, reach)
        if not reach.controllable:
            note.refute("jointly-controllable")
    plant = note.at(unreached("discrete"))
    lost = joint_controllability(lifted_system(plant, [1, 1]))
    note.refute("any-plant", any(lost.uncontrollable_polynomial.coefficients[:-1]))
    note.certify(lost)


def theorem_3(note: Notebook) -> None:
    """Theorem 3: with dimensions at Theorem 2's bound, no mode except 0 is fixed."""
    for plant in note.each(
        late(8),
        late_drawn(5, fixed=True, first=71),
    ):
        bound = shared_dimension_bound(plant)
        spectrum = fixed_spectrum(lifted_system(plant, [bound.deficiency] * plant.m))
        note.counts(bound.deficiency > 0)
        note.check("nothing but 0 is fixed", spectrum.polynomial in (ONE, X))
        note.certify(bound, spectrum)
        if spectrum.polynomial == X:
            note.refute("also-0")
    less_than_the_bound(note, "outputs+states", lifted_system, "outputs+states")


def _rest_assigned(note: Notebook, delay: int) -> None:
    """Give all eigenvalues of the example's loop but the fixed 0 prescribed values."""
    plant = note.at(late_example(delay))
    sizes = [1] * plant.m
    least = design_extended(plant, network="lifted", dimensions=sizes, radius="1/2", aims=THEOREM)
    (block,) = least.parts["blocks"]
    free, fixed = block.polynomial.degree, least.loop.matrix.nrows - block.polynomial.degree
    # As many complex pairs with the sum 1 and the product 1/2 as there is room for.
    wanted = Polynomial.of("1/2", -1, 1) ** (free // 2) * Polynomial.of("-1/3", 1) ** (free % 2)
    design = design_extended(plant, network="lifted", dimensions=sizes, spectrum=wanted)
    assigned = characteristic_polynomial(design.loop.matrix)
    note.counts(fixed > 0)
    note.check("all but the fixed 0 are assigned, complex pairs too", assigned == wanted * X**fixed)
    system, numbers = lifted_system(plant, sizes), Numbers(26)
    spectrum = fixed_spectrum(system)
    loops = [characteristic_polynomial(closed_by(system, numbers.gains(system))) for _ in "1234"]
    shared = reduce(Polynomial.gcd, loops)
    note.check("the rest is what four drawn loops have in common", shared == X**fixed)
    note.refute("whole", spectrum.polynomial == X)
    note.certify(spectrum, *design.certificates.values())


def free_of_the_lift(note: Notebook) -> None:
    """With n_i ≥ 1 all but the fixed 0 is assigned freely; with n_i = 0 the spectrum can split."""
    for delay in (1, 2):
        _rest_assigned(note, delay)
    for plant in note.each(late(5)):
        size = max(1, shared_dimension_bound(plant).deficiency)
        system = lifted_system(plant, [size] * plant.m)
        spectrum, graph = fixed_spectrum(system), transfer_graph(system)
        note.counts(is_late(plant))
        note.check("the transfer graph is strongly connected", graph.strongly_connected)
        note.check("nothing but 0 is fixed", spectrum.polynomial.squarefree_part() in (ONE, X))
        note.certify(spectrum, graph)
    plant = note.at(split_spectrum("discrete", 1))
    note.print(plant)
    bound, alone = shared_dimension_bound(plant), lifted_system(plant, [0] * plant.m)
    graph, whole = transfer_graph(alone), completeness(alone)
    note.check("n_i = 0 meets the hypotheses of Theorem 3", bound.deficiency == 0)
    note.refute("n_i=0", len(graph.components) > 1 and not whole.complete)
    note.certify(bound, graph, whole)


def theorem_3_states(note: Notebook) -> None:
    """Theorem 3 for sub-states alone, with the bound of Remark 2."""
    for plant in note.each(late(8), late_drawn(5, fixed=True, first=71)):
        bound = shared_dimension_bound(plant, share="states")
        system = lifted_system(plant, [bound.deficiency] * plant.m, "states")
        spectrum = fixed_spectrum(system)
        note.counts(bound.deficiency > 0)
        note.check("nothing but 0 is fixed", spectrum.polynomial in (ONE, X))
        note.certify(bound, spectrum)
        weaker = shared_dimension_bound(plant).deficiency
        if weaker < bound.deficiency:
            short = fixed_spectrum(lifted_system(plant, [weaker] * plant.m, "states"))
            if not short.empty:
                note.refute("(26)", short.polynomial.squarefree_part() not in (ONE, X))
            note.certify(short)
    less_than_the_bound(note, "states", lifted_system, "states")


def less_than_the_bound(
    note: Notebook,
    share: Share,
    construct: Callable[..., MultiChannelSystem],
    *options: str,
) -> None:
    """Plants with bounds 1 and 2: one less leaves a nonzero mode fixed where the bound is tight."""
    for plant in note.each(
        deficient_plants(4, share=share, time="discrete", longest_delay=1, first=11)
    ):
        bound, least = (
            shared_dimension_bound(plant, share=share),
            common_dimension(plant, share=share),
        )
        note.counts(bound.deficiency > 0)
        sizes = {0, bound.deficiency - 1, bound.deficiency}
        for size in sorted(sizes):
            spectrum = fixed_spectrum(construct(plant, [size] * plant.m, *options))
            nonzero = spectrum.polynomial.squarefree_part() not in (ONE, X)
            if size == bound.deficiency:
                note.check("nothing but 0 is fixed at the bound", not nonzero)
            elif size == 0:
                note.refute("n_i=0", nonzero)
            if size == bound.deficiency - 1 and least.dimension == bound.deficiency:
                note.refute("bound-1", nonzero)
            note.certify(spectrum)
        note.certify(bound)


def corollary_2(note: Notebook) -> None:
    """Corollary 2: a controller achieves any radius over links with delays."""
    runs = []
    for delay in (0, 1, 2):
        plant = note.at(late_example(delay))
        for radius in ("1/2", "1/10"):
            least = design_extended(plant, radius=radius, aims=THEOREM)
            (block,) = least.parts["blocks"]
            half = [Fraction(radius) / 2] * block.polynomial.degree
            design = design_extended(plant, spectrum=half, radius=radius)
            inside = StabilityRegion.of("discrete", radius=radius)
            reached = inside.contains_roots_of(characteristic_polynomial(design.loop.matrix))
            note.counts(not inside.contains_roots_of(characteristic_polynomial(plant.A)))
            note.check(f"every eigenvalue is below the radius {radius}", reached)
            note.check("which is certified", "stability" in design.certificates)
            note.certify(*design.certificates.values())
            if radius != "1/2":
                note.refute("one-radius", reached and Fraction(radius) < Fraction(1, 2))
        if delay:
            # The controller for links without delay, over links with delay.
            prompt = design_extended(three_channels("discrete", 0), radius="1/10", aims=THEOREM)
            late_loop = closed_loop(plant, replace(prompt.controller, system="")).matrix
            met = inside.contains_roots_of(characteristic_polynomial(late_loop))
            note.refute("any-controller", not met)
        run = simulate(plant, design.controller, horizon=12 + 4 * delay)
        spectrum = closed_loop_spectrum(design.loop.matrix, "discrete")
        note.check("the loop is stable", spectrum.stable)
        runs.append((delay, run))
    note.show(delays_picture(runs))


DELAYS: dict[str, Procedure] = {
    "equations-32-33": shifts,
    "equations-34-35": lifted,
    "delayed-graph": transfer_of_the_lift,
    "equation-36": block_ranks,
    "delayed-joint": only_zero_is_lost,
    "theorem-3": theorem_3,
    "delayed-free": free_of_the_lift,
    "theorem-3-states": theorem_3_states,
    "corollary-2": corollary_2,
}


# Section V-B: spectrum assignment under delays, with holding.


def held(note: Notebook) -> None:
    """(37): all followers of i receive x_i(t − d_i) at the same time."""
    numbers = Numbers(16)
    for instance, sizes in with_dimensions(drawn_links()):
        plant = note.at(instance)
        system = held_system(plant, sizes)
        graph = graph_of(plant)
        d = [graph.longest_delay(i) for i in range(plant.m)]
        delays = {(i, j): d[j] for i in range(plant.m) for j in graph.neighborhood(i)}
        size = plant.n + sum((1 + d[i]) * sizes[i] for i in range(plant.m))
        note.counts(any(d))
        note.check("it has n̂ = n + Σ (n_i + d_i n_i) states", system.n == size)
        note.check(
            "agents see what is released, step by step",
            messages_agree(plant, system, sizes, "states", delays, numbers),
        )
        note.certify(fixed_spectrum(system))
    name, plant = three_delays()
    note.on(name, plant)
    graph, sizes = graph_of(plant), [1, 1, 1]
    system, d = held_system(plant, sizes), [graph.longest_delay(i) for i in range(plant.m)]
    pairs = [(i, j) for i in range(plant.m) for j in graph.neighborhood(i)]
    links = {(i, j): graph.delay(i, j) for i, j in pairs}
    composed = {(i, j): (d[j] - links[i, j]) + links[i, j] for i, j in pairs}
    for i, j in pairs:
        # Agent j holds x_j for d_j − d_ij steps, and the link takes d_ij more.
        queue, arrived = _sent_and_held(links[i, j], d[j] - links[i, j], numbers)
        note.check(
            f"x of agent {j + 1} reaches agent {i + 1} after d_{j + 1} steps",
            arrived[d[j] :] == queue[: len(queue) - d[j]],
        )
    note.counts(any(d))
    note.check(
        "which are the messages", messages_agree(plant, system, sizes, "states", composed, numbers)
    )
    note.refute("not-held", not messages_agree(plant, system, sizes, "states", links, numbers))
    own = {(i, j): 0 if i == j else d[j] for i, j in pairs}
    note.refute("own-state", not messages_agree(plant, system, sizes, "states", own, numbers))


def _sent_and_held(
    link: int, hold: int, numbers: Numbers, steps: int = 9
) -> tuple[list[Matrix], list[Matrix]]:
    """Send drawn numbers through a queue of held ones and through a link; also what arrives."""
    nothing = Matrix.zeros(1, 1)
    kept, under_way = [nothing] * hold, [nothing] * link
    sent, arrived = [], []
    for _ in range(steps):
        sent.append(numbers.matrix(1, 1))
        kept.append(sent[-1])
        under_way.append(kept.pop(0))
        arrived.append(under_way.pop(0))
    return sent, arrived


def held_joint(note: Notebook) -> None:
    """The held system is jointly controllable and observable."""
    for plant in note.each(late(10)):
        system = held_system(plant, [1] * plant.m)
        note.counts(is_late(plant))
        note.joint(system)
    plant = note.at(late_example(1))
    joint = joint_controllability(lifted_system(plant, [1, 1, 1]))
    note.refute("without-holding", not joint.controllable)
    note.certify(joint)


def outputs_lose_controllability(note: Notebook) -> None:
    """Sending y_i with delays can make 0 fixed; holding and sending x_i alone does not."""
    plant = note.at(late_example(1))
    sent = joint_controllability(lifted_system(plant, [1, 1, 1]))
    note.counts(not sent.controllable)
    note.check("with outputs on the links 0 is out of reach", not sent.controllable)
    kept = fixed_spectrum(held_system(plant, [1, 1, 1]))
    note.check("with holding nothing is fixed", kept.empty)
    note.certify(sent, kept)
    zero = fixed_spectrum(lifted_system(plant, [1, 1, 1]))
    note.check("0 is fixed", zero.polynomial == X)
    note.refute("other-modes", zero.polynomial(1) != 0)
    prompt = note.at(late_example(0))
    whole = joint_controllability(lifted_system(prompt, [1, 1, 1]))
    note.refute("always", whole.controllable)
    note.certify(zero, whole)


def theorem_4(note: Notebook) -> None:
    """Theorem 4: with dimensions at Remark 2's bound, the held system has no fixed mode."""
    for plant in note.each(
        late(8),
        late_drawn(5, fixed=True, first=71),
    ):
        bound = shared_dimension_bound(plant, share="states")
        spectrum = fixed_spectrum(held_system(plant, [bound.deficiency] * plant.m))
        note.counts(bound.deficiency > 0)
        note.check("nothing is fixed", spectrum.empty)
        note.certify(bound, spectrum)
        weaker = shared_dimension_bound(plant)
        if weaker.deficiency < bound.deficiency:
            short = fixed_spectrum(held_system(plant, [weaker.deficiency] * plant.m))
            if not short.empty:
                note.refute("(26)")
            note.certify(short)
    less_than_the_bound(note, "states", held_system)


def transfer_of_the_held(note: Notebook) -> None:
    """n_i > 0: strongly connected iff the union of neighbor and transfer graphs is."""
    for plant in note.each(
        late(5),
        late_drawn(8, connected=False),
    ):
        before, after = transfer_graph(plant), transfer_graph(held_system(plant, [1] * plant.m))
        union = union_of_graphs(plant, before)
        note.counts(is_late(plant))
        note.check(
            "strongly connected just when the union is",
            after.strongly_connected == union.is_strongly_connected(),
        )
        note.certify(before, after)
        if after.strongly_connected and not graph_of(plant).is_strongly_connected():
            note.refute("neighbor-graph")
    plant = note.at(apart())
    before, after = transfer_graph(plant), transfer_graph(held_system(plant, [0] * plant.m))
    union = union_of_graphs(plant, before)
    note.refute("n_i=0", union.is_strongly_connected() and not after.strongly_connected)
    note.certify(before, after)


def free_assignment(note: Notebook) -> None:
    """With holding, the whole spectrum is freely assignable despite delays."""
    plant = note.at(late_example(1))
    sizes = (1, 1, 1)
    note.certify(completeness(held_system(plant, sizes)))
    note.counts(is_late(plant))
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
    note.print(plant)
    bound = shared_dimension_bound(plant, share="states")
    graph = transfer_graph(held_system(plant, [0] * plant.m))
    whole = completeness(held_system(plant, [0] * plant.m))
    note.check("n_i = 0 meets the hypotheses of Theorem 4", bound.deficiency == 0)
    note.refute("n_i=0", not graph.strongly_connected and not whole.complete)
    note.certify(bound, graph, whole)


HOLDING: dict[str, Procedure] = {
    "not-controllable": outputs_lose_controllability,
    "equations-37-38": held,
    "held-joint": held_joint,
    "theorem-4": theorem_4,
    "held-graph": transfer_of_the_held,
    "held-free": free_assignment,
}
