"""Section II: the distributed observer and certainty equivalence."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.fixed_modes.single_channel_gains import single_channel_gains
from mcexact.analysis.stability.closed_loop_spectrum import closed_loop_spectrum
from mcexact.analysis.structure.controllability import joint_observability
from mcexact.analysis.structure.controllability_indices import controllability_indices
from mcexact.analysis.structure.exceptional_gains import exceptional_gains
from mcexact.derived.error_system import error_system
from mcexact.derived.feedback import feedback
from mcexact.exact.blocks import block, hstack, kronecker, vstack
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion, is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.equations import errors_agree
from mcexact.reproduce.figures import decay_picture, spectrum_picture
from mcexact.reproduce.material import (
    PAPER,
    Instance,
    Numbers,
    drawn_plants,
    graph_of,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import hidden_by_feedback
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.design import Design
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.methods import default_polynomial, state_feedback

WITHOUT_GRAPH = "Lemma 1 holds over every neighbor graph."
LITERAL_RECIPE = "With A + Σ B_i F_i in place of A the steps for a plant without feedback suffice."


def zeros(plant: MultiChannelSystem) -> list[Matrix]:
    """F_i = 0."""
    return [Matrix.zeros(plant.p(i), plant.n) for i in range(plant.m)]


@cache
def small() -> tuple[Instance, ...]:
    """The example, and plants that are small enough for quick exact designs."""
    return tuple(plants(2, states=2, channels=2))


@cache
def designed(name: str) -> Design:
    """Design an observer for a small plant: feedback spectrum −1, …, error spectrum −2, …."""
    plant = dict(small())[name]
    size = plant.n * plant.m + plant.m - 1
    wanted = {
        "feedback": [-1 - k % 2 for k in range(plant.n)],
        "error": [-2 - k % 2 for k in range(size)],
    }
    return design_observer(plant, spectrum=wanted)


def cancellation(note: Notebook) -> None:
    """II-A: with one agent the spectrum is that of A + BF and that of A + KC."""
    numbers = Numbers(4)
    for plant in note.each(plants(8)):
        B, C = plant.input_matrix(), plant.output_matrix()
        F, K = numbers.matrix(B.ncols, plant.n), numbers.matrix(plant.n, C.nrows)
        loop = block([[plant.A, B @ F], [-(K @ C), plant.A + K @ C + B @ F]])
        apart = characteristic_polynomial(plant.A + B @ F) * characteristic_polynomial(
            plant.A + K @ C
        )
        note.check("the loop's polynomial is the product", characteristic_polynomial(loop) == apart)


def errors_without_feedback(note: Notebook) -> None:
    """II-B: (3) and (4) give the error system with F = 0."""
    numbers = Numbers(5)
    for plant in note.each(plants(10)):
        made = error_system(plant, zeros(plant))
        note.check(
            "x_i − x obeys the error system without F",
            errors_agree(plant, made, zeros(plant), numbers),
        )


def almost_any_choice(note: Notebook) -> None:
    """II-B: some K̃_i, H̃_ij make (7) controllable and observable through channel q."""
    for plant in note.each(plants(5)):
        found = single_channel_gains(error_system(plant, zeros(plant)))
        note.check("one choice of gains serves every q", found.exists)
        note.certify(found)


def centralized_feedback(note: Notebook) -> None:
    """II-C: A + Σ B_i F_i gets any spectrum by one F split into the F_i."""
    for plant in note.each(plants(10)):
        wanted = default_polynomial(StabilityRegion.of("continuous", rate=1), plant.n)
        found = state_feedback(plant, wanted)
        B, F = plant.input_matrix(), vstack(list(found.gains), ncols=plant.n)
        parts = sum(
            (plant.B(i) @ found.gains[i] for i in range(plant.m)),
            Matrix.zeros(plant.n, plant.n),
        )
        note.check("BF = Σ B_i F_i", B @ F == parts)
        note.check(
            "A + BF has the prescribed polynomial",
            characteristic_polynomial(plant.A + parts) == wanted,
        )


def errors_with_feedback(note: Notebook) -> None:
    """(12), (14) to (16): the substitution rule makes the errors autonomous."""
    numbers = Numbers(6)
    for plant in note.each(plants(14)):
        F = numbers.feedbacks(plant)
        made = error_system(plant, F)
        note.check("x_i − x obeys the error system", errors_agree(plant, made, F, numbers))


def whole_loop(note: Notebook) -> None:
    """(9) to (11): the loop of the agents' programs splits as the paper says."""
    for name, _ in small():
        note.on(name)
        design = designed(name)
        note.check(
            "the loop's polynomial is that of A + Σ B_i F_i times that of the errors",
            characteristic_polynomial(design.loop.matrix) == design.loop.polynomial,
        )
        note.certify(design.loop.proof)


def proposition_1(note: Notebook) -> None:
    """Proposition 1, for drawn F_i."""
    numbers = Numbers(7)
    for plant in note.each(plants(8)):
        F = numbers.feedbacks(plant)
        found = single_channel_gains(error_system(plant, F), want="both", index=plant.m)
        note.check("one choice of gains serves every q", found.exists)
        note.check(
            "with controllability index m",
            found.indices is not None and all(each[0] == plant.m for each in found.indices),
        )
        note.certify(found)


def theorem_1(note: Notebook) -> None:
    """Theorem 1: every number of the error system is prescribed; any q."""
    for name, plant in small():
        note.on(name)
        design = designed(name)
        size = plant.n * plant.m + plant.m - 1
        wanted = Polynomial.from_roots([-2 - k % 2 for k in range(size)])
        made = design.parts["error_polynomial"]
        note.check("the error system has the prescribed polynomial", made == wanted)
        note.certify(design.loop.proof)
    plant = note.at(small()[1])
    other = plant.names[-1]
    design = design_observer(plant, agent=other, rate=1)
    note.check(f"channel {other} can carry the channel controller", design.parts["agent"] == other)
    note.certify(design.loop.proof)
    _show_example(note)


def _show_example(note: Notebook) -> None:
    """The spectrum and the decay of the example's loop."""
    note.on(PAPER)
    design, plant = designed(PAPER), three_channels()
    spectrum = closed_loop_spectrum(design.loop.matrix, plant.time)
    note.check("the loop is stable", spectrum.stable)
    note.show(
        spectrum_picture(spectrum, plant.time, "The closed loop with the distributed observer")
    )
    run = simulate(plant, design.controller, horizon=25)
    note.show(decay_picture(run, spectrum, "The example under its distributed observer"))


def remark_1(note: Notebook) -> None:
    """Remark 1: the design is central, and programs use only signals that their agents receive."""
    for name, plant in small():
        note.on(name)
        controller = designed(name).controller
        graph = graph_of(plant)
        note.check(
            "every signal that a program uses comes along an arc",
            set(controller.edges()) <= set(graph.edges()),
        )
        run = simulate(plant, controller, horizon=1, points=4)
        note.check("the agents run", len(run.snapshots) == 5)


def lemma_1(note: Notebook) -> None:
    """Lemma 1: the error system is jointly controllable and observable."""
    numbers = Numbers(8)
    for plant in note.each(plants(10)):
        made = error_system(plant, numbers.feedbacks(plant))
        note.check(
            "[B̃_1 … B̃_m] is the identity",
            hstack([made.B(i) for i in range(made.m)]) == Matrix.identity(made.n),
        )
        note.joint(made)
    plant = note.at((f"{PAPER}, without arcs", three_channels()))
    apart = error_system(plant.with_neighbors({name: [] for name in plant.names}), zeros(plant))
    found = joint_observability(apart)
    note.refute(WITHOUT_GRAPH, not found.controllable)
    note.certify(found)


def _graph_scalars(graph: NeighborGraph) -> MultiChannelSystem:
    """(0, b_i, c_ij): one state for each agent; φ_ij are its decentralized gains."""
    m = graph.m
    unit = Matrix.identity(m)
    C = []
    for i in range(m):
        others = [j for j in graph.neighborhood(i) if j != i]
        C.append(vstack([unit.take(rows=[i]) - unit.take(rows=[j]) for j in others], ncols=m))
    B = [unit.take(cols=[i]) for i in range(m)]
    return MultiChannelSystem(Matrix.zeros(m, m), B, C, names=graph.names)


def _lifted_scalars(plant: MultiChannelSystem) -> tuple[list[Matrix], list[Matrix], Matrix]:
    """Ĥ_i = φ_i ⊗ I_n beside a zero K_i, as gains of the error system; φ; D = Σ b_i φ_ij c_ij."""
    scalars = _graph_scalars(graph_of(plant))
    found = single_channel_gains(scalars, want="controllable")
    if found.gains is None:
        raise ValueError("the neighbor graph is not strongly connected")
    wide = [
        hstack(
            [
                Matrix.zeros(plant.n, plant.q(i)),
                kronecker(found.gains[i], Matrix.identity(plant.n)),
            ]
        )
        for i in range(plant.m)
    ]
    return wide, list(found.gains), feedback(scalars, found.gains).A


def lemma_2(note: Notebook) -> None:
    """Lemma 2: Σ B̃_i Ĥ_i C̃_i = D ⊗ I reaches everything from every B̃_q, with index m."""
    for plant in note.each(plants(10)):
        note.certify(single_channel_gains(_graph_scalars(graph_of(plant)), want="controllable"))
        wide, _, D = _lifted_scalars(plant)
        still = MultiChannelSystem(
            Matrix.zeros(plant.n, plant.n),
            [channel.B for channel in plant.channels],
            [channel.C for channel in plant.channels],
            names=plant.names,
            neighbors=graph_of(plant),
        )
        loop = feedback(error_system(still, zeros(still)), wide)
        note.check("Σ B̃_i Ĥ_i C̃_i is D ⊗ I", loop.A == kronecker(D, Matrix.identity(plant.n)))
        for q in plant.names:
            found = controllability_indices(loop, [q])
            note.check(f"channel {q} controls it with index m", found.index == plant.m)
            note.certify(found)


def lemma_3(note: Notebook) -> None:
    """Lemma 3: all exceptional values g are found, and there are finitely many."""
    numbers = Numbers(9)
    for seed, (n, r) in enumerate(((2, 1), (3, 1), (3, 2), (4, 2))):
        note.on(f"drawn pair, seed {seed}: n={n}, r={r}")
        A, B, M = numbers.matrix(n, n), numbers.matrix(n, r), numbers.matrix(n, n)
        found = exceptional_gains(M, A, B)
        note.check(
            "finitely many g lose the first m blocks",
            not found.index_set.polynomial.is_zero(),
        )
        note.certify(found.index_set, found.controllability_set, found.indices)
        g = next(g for g in range(1, 1000) if g not in found.index_set)
        pair = MultiChannelSystem(M + A * g, [B], [Matrix.zeros(0, n)])
        indices = controllability_indices(pair)
        within = indices.index is not None and indices.index <= found.index
        note.check("another g keeps the index within m", within)
        if found.index * r == n:
            note.check("if mr = n another g keeps the index m", indices.index == found.index)
        note.certify(indices)


def lemma_4(note: Notebook) -> None:
    """Lemma 4: for given K_i, H_i = g Ĥ_i with g outside finitely many values."""
    numbers = Numbers(10)
    for plant in note.each(plants(5)):
        made = error_system(plant, numbers.feedbacks(plant))
        wide, _, _ = _lifted_scalars(plant)
        given = [
            hstack(
                [
                    numbers.matrix(plant.n, plant.q(i)),
                    Matrix.zeros(plant.n, made.q(i) - plant.q(i)),
                ]
            )
            for i in range(plant.m)
        ]
        M = feedback(made, given).A
        D = feedback(made, wide).A - made.A
        sets = [exceptional_gains(M, D, made.B(i)).index_set for i in range(plant.m)]
        note.certify(*sets)
        g = next(g for g in range(1, 1000) if all(g not in each for each in sets))
        loop = feedback(made, [K + H * g for K, H in zip(given, wide, strict=True)])
        for q in plant.names:
            found = controllability_indices(loop, [q])
            note.check(f"g = {g}: channel {q} controls with index m", found.index == plant.m)
            note.certify(found)


def prescribed_rate(note: Notebook) -> None:
    """II, Construction: a design achieves any rate, and in discrete time any radius."""
    chosen = [*drawn_plants(1, states=2, channels=2)]
    chosen += [*drawn_plants(1, states=2, channels=2, time="discrete", first=4)]
    for name, plant in chosen:
        note.on(f"{name}, {plant.time} time")
        rate, radius = (None, "1/10") if is_discrete(plant.time) else (5, None)
        design = design_observer(plant, rate=rate, radius=radius)
        wanted = StabilityRegion.of(plant.time, rate, radius)
        spectrum = closed_loop_spectrum(design.loop.matrix, plant.time)
        note.check("the loop is stable", spectrum.stable)
        fast = wanted.contains_roots_of(characteristic_polynomial(design.loop.matrix))
        note.check("every eigenvalue meets the prescribed rate", fast)
        note.certify(design.loop.proof)
    _in_floating_point(note)


def _in_floating_point(note: Notebook) -> None:
    """A floating-point design meets its rate, certified exactly; discs enclose its spectrum."""
    plant = three_channels()
    note.on(f"{PAPER}, designed in floating point")
    design = design_observer(plant, rate=1, arithmetic="float")
    spectrum = closed_loop_spectrum(design.loop.matrix, plant.time)
    rate = spectrum.rate
    note.check("every eigenvalue meets the rate 1", rate is not None and Fraction(rate.lower) > 1)
    note.certify(design.loop.proof)
    title = "A design in floating point, with its eigenvalues in certified discs"
    note.show(spectrum_picture(spectrum, plant.time, title))


def recipe(note: Notebook) -> None:
    """II-D: the steps for a plant without feedback, with A + Σ B_i F_i in place of A, can fail.

    Where the outputs miss an eigenvector of A + Σ B_i F_i, all gains of this recipe leave its
    eigenvalue in the error system.  The system (16), which has the terms −B_j F_j e_j besides, has
    gains for every spectrum.
    """
    name, plant, entries = hidden_by_feedback()
    note.on(name)
    F = [Matrix.from_integers(rows) for rows in entries]
    fed_back = plant.A + sum(
        (plant.B(i) @ F[i] for i in range(plant.m)), Matrix.zeros(plant.n, plant.n)
    )
    literal = MultiChannelSystem(
        fed_back,
        [channel.B for channel in plant.channels],
        [channel.C for channel in plant.channels],
        neighbors=graph_of(plant),
    )
    lost, stuck = joint_observability(literal), fixed_spectrum(error_system(literal, zeros(plant)))
    note.check("the plant is jointly observable", joint_observability(plant).controllable)
    note.check("what is fed back is not", not lost.controllable)
    note.refute(LITERAL_RECIPE, stuck.polynomial == Polynomial.from_roots([-2]))
    found = single_channel_gains(error_system(plant, F), want="both", index=plant.m)
    note.check("(16) has gains, with index m", found.exists)
    wanted = [-3 - k for k in range(plant.n * plant.m + plant.m - 1)]
    design = design_observer(plant, spectrum={"error": wanted}, gains=F)
    note.check(
        "and its errors get a spectrum without −2",
        design.parts["error_polynomial"] == Polynomial.from_roots(wanted),
    )
    note.certify(lost, stuck, found, design.loop.proof)


PROCEDURES: dict[str, Procedure] = {
    "cancellation": cancellation,
    "xe1": errors_without_feedback,
    "ppe1": almost_any_choice,
    "candidate": centralized_feedback,
    "me1": whole_loop,
    "eme1": errors_with_feedback,
    "maint": proposition_1,
    "thm:obs-main": theorem_1,
    "rmk:central-design": remark_1,
    "lanal": lemma_1,
    "daniel": lemma_2,
    "g": lemma_3,
    "lem2": lemma_4,
    "construction": prescribed_rate,
    "recipe": recipe,
}
