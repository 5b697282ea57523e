"""Section V-B: spectrum assignment under delays, with holding."""

from __future__ import annotations

from fractions import Fraction

from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.analysis.structure import transfer_graph
from mcexact.derived.constructions import held_system, lifted_system
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.reproduce.delays import (
    X,
    drawn_links,
    late,
    late_drawn,
    less_than_the_bound,
    three_delays,
)
from mcexact.reproduce.equations import messages_agree, union_of_graphs
from mcexact.reproduce.material import (
    Numbers,
    graph_of,
    with_dimensions,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import apart, late_example
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.optimum.figures import THEOREM


def held(note: Notebook) -> None:
    """(37): all followers of i receive x_i(t − d_i) at the same time."""
    numbers = Numbers(16)
    for instance, sizes in with_dimensions(drawn_links()):
        plant = note.at(instance)
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
    name, plant = three_delays()
    note.on(name, plant)
    graph, sizes = graph_of(plant), [1, 1, 1]
    made, d = held_system(plant, sizes), [graph.longest_delay(i) for i in range(plant.m)]
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
    note.check(
        "which are the messages", messages_agree(plant, made, sizes, "states", composed, numbers)
    )
    note.refute("not-held", not messages_agree(plant, made, sizes, "states", links, numbers))
    own = {(i, j): 0 if i == j else d[j] for i, j in pairs}
    note.refute("own-state", not messages_agree(plant, made, sizes, "states", own, numbers))


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
        made = held_system(plant, [1] * plant.m)
        note.joint(made)
    plant = note.at(late_example(1))
    found = joint_controllability(lifted_system(plant, [1, 1, 1]))
    note.refute("without-holding", not found.controllable)
    note.certify(found)


def outputs_lose_controllability(note: Notebook) -> None:
    """Sending y_i with delays can make 0 fixed; holding and sending x_i alone does not."""
    plant = note.at(late_example(1))
    sent = joint_controllability(lifted_system(plant, [1, 1, 1]))
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
        found = fixed_spectrum(held_system(plant, [bound.deficiency] * plant.m))
        note.check("nothing is fixed", found.empty)
        note.certify(bound, found)
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
    found = completeness(held_system(plant, [0] * plant.m))
    note.check("n_i = 0 meets the hypotheses of Theorem 4", bound.deficiency == 0)
    note.refute("n_i=0", not graph.strongly_connected and not found.complete)
    note.certify(bound, graph, found)


PROCEDURES: dict[str, Procedure] = {
    "not-controllable": outputs_lose_controllability,
    "equations-37-38": held,
    "held-joint": held_joint,
    "theorem-4": theorem_4,
    "held-graph": transfer_of_the_held,
    "held-free": free_assignment,
}
