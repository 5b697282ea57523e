"""Section IV-B: sharing outputs, and the example of three channels."""

from __future__ import annotations

from mcexact.analysis.analyze import analyze
from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import fixed_spectrum, pencil_rank
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.answer.modes import FixedSpectrum
from mcexact.derived.constructions import augmented_outputs, closed_by, extended_system
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import TIMES
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import graph_pictures
from mcexact.reproduce.equations import outputs, stacked
from mcexact.reproduce.material import (
    PAPER,
    SUBSETS_OF_THREE,
    Numbers,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import designed, small
from mcexact.synthesis.decentralized import design_decentralized


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
    plant = note.at((PAPER, three_channels()))
    one = fixed_spectrum(extended_system(plant, [0, 0, 1]))
    note.refute("sharing-one", one.empty)
    note.certify(one)


def sharing_states(note: Notebook) -> None:
    """It is enough to share the estimates x_i: no output of another agent is used."""
    plant = note.at((PAPER, three_channels()))
    for each in note.each(small()):
        design = designed(note.here)
        for i, agent in enumerate(design.controller.agents):
            others = {j for law in agent.maps() for j in law.outputs} - {i}
            note.check(f"agent {agent.name} uses its own output alone", not others)
            note.check(f"agent {agent.name} sends an estimate of x", agent.shared == each.n)
        note.check("the loop is stable", closed_loop_spectrum(design.loop.matrix, each.time).stable)
        note.certify(design.loop.proof)
    note.on(PAPER)
    found = fixed_spectrum(extended_system(plant, [plant.n] * plant.m, "states"))
    note.check("with n_i = n and no outputs nothing is fixed", found.empty)
    note.certify(found)
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
    found = fixed_spectrum(system)
    note.check("the fixed polynomial is x − 1", found.polynomial == Polynomial.from_roots([1]))
    note.check(
        "no linear time-invariant distributed control with outputs alone stabilizes it",
        not found.stabilizable,
    )
    note.certify(rank, found)
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
    """Small changes of the example, after which it says something else."""
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
    plant = note.at((PAPER, three_channels()))
    made, x = augmented_outputs(plant), numbers.column(plant.n)
    y = outputs(plant, x)
    seen = made.C(1) @ x
    note.check("N_2 = {2, 3}", seen == stacked([y[1], y[2]]))
    note.refute("followers", seen != stacked([y[1], y[0]]))
    note.refute("without-own", seen != y[2])


PROCEDURES: dict[str, Procedure] = {
    "equation-23": shared_outputs,
    "example": example,
    "dynamic": dynamic,
    "sharing-states": sharing_states,
}
