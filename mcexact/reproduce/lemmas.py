"""Section II-D: the lemmas behind Proposition 1, and the construction."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from mcexact.analysis.controllability import (
    controllability_indices,
    exceptional_gains,
    joint_observability,
)
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.answer.structure import ControllabilityIndices
from mcexact.derived.constructions import error_system, feedback
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix, hstack, kronecker, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import spectrum_picture
from mcexact.reproduce.material import (
    PAPER,
    Numbers,
    drawn_plants,
    graph_of,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import fed_back, without_arcs, zeros
from mcexact.reproduce.plants import hidden_by_feedback
from mcexact.synthesis.distributed_observer import design_observer

INDEX_THREE = "four states, two inputs, index 3"


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
    found = joint_observability(error_system(without_arcs(plant), zeros(plant)))
    note.refute("any-graph", not found.controllable)
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
            if note.here == PAPER:
                note.refute("smaller-index", found.index is not None and found.index > plant.m - 1)
    plant = note.at((PAPER, three_channels()))
    lost = single_channel_gains(_graph_scalars(graph_of(without_arcs(plant))), want="controllable")
    note.refute("any-graph", not lost.exists)
    note.certify(lost)


def lemma_3(note: Notebook) -> None:
    """Lemma 3: all exceptional values g are found, and there are finitely many."""
    for name, A, B, M in _pairs():
        note.on(name)
        n, r = B.shape
        found = exceptional_gains(M, A, B)
        note.check(
            "finitely many g lose the first m blocks",
            not found.index_set.polynomial.is_zero(),
        )
        note.certify(found.index_set, found.controllability_set, found.indices)
        g = next(g for g in range(1, 1000) if g not in found.index_set)
        indices = _indices(M + A * g, B)
        within = indices.index is not None and indices.index <= found.index
        note.check("another g keeps the index within m", within)
        if found.index * r == n:
            note.check("if mr = n another g keeps the index m", indices.index == found.index)
        note.certify(indices)
        if name == INDEX_THREE:
            after = [_indices(M + A * g, B) for g in (0, 1, 2, 3)]
            note.check("(A, B) has index 3", found.index == 3)
            note.refute("without-mr=n", all(each.index == 2 for each in after[1:]))
            note.refute("larger-index", all((each.index or 0) < 3 for each in after[1:]))
            note.refute("every-g", after[0].index is None)
            note.certify(*after)


def _indices(A: Matrix, B: Matrix) -> ControllabilityIndices:
    """The controllability indices of a pair."""
    return controllability_indices(MultiChannelSystem(A, [B], [Matrix.zeros(0, A.nrows)]))


def _pairs() -> Iterator[tuple[str, Matrix, Matrix, Matrix]]:
    """Drawn A, B and M; and a pair with index 3, of which M + gA has the index 2 for g ≠ 0."""
    numbers = Numbers(9)
    for seed, (n, r) in enumerate(((2, 1), (3, 1), (3, 2), (4, 2))):
        name = f"drawn pair, seed {seed}: n={n}, r={r}"
        yield name, numbers.matrix(n, n), numbers.matrix(n, r), numbers.matrix(n, n)
    A = [[0, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]]
    M = [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], [0, 1, 0, 0]]
    rows = (A, [[1, 0], [0, 1], [0, 0], [0, 0]], M)
    first, second, third = (Matrix.from_integers(each) for each in rows)
    yield INDEX_THREE, first, second, third


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
    plant = note.at((PAPER, three_channels()))
    still = error_system(plant, zeros(plant))
    without = controllability_indices(still, [plant.names[0]])
    note.refute("no-H", without.index is None)
    note.certify(without)


def prescribed_rate(note: Notebook) -> None:
    """II, Construction: a design achieves any rate, and in discrete time any radius."""
    chosen = [*drawn_plants(1, states=2, channels=2)]
    chosen += [*drawn_plants(1, states=2, channels=2, time="discrete", first=4)]
    for name, plant in chosen:
        note.on(f"{name}, {plant.time} time", plant)
        rate, radius = (None, "1/10") if is_discrete(plant.time) else (5, None)
        design = design_observer(plant, rate=rate, radius=radius)
        wanted = StabilityRegion.of(plant.time, rate, radius)
        spectrum = closed_loop_spectrum(design.loop.matrix, plant.time)
        note.check("the loop is stable", spectrum.stable)
        fast = wanted.contains_roots_of(characteristic_polynomial(design.loop.matrix))
        note.check("every eigenvalue meets the prescribed rate", fast)
        note.certify(design.loop.proof)
        if is_discrete(plant.time):
            count = plant.n * plant.m + plant.m - 1
            quarters = {"feedback": ["1/4"] * plant.n, "error": ["1/4"] * count}
            slower = design_observer(plant, spectrum=quarters, radius="1/2")
            inside = wanted.contains_roots_of(characteristic_polynomial(slower.loop.matrix))
            note.refute("any-radius", not inside)
            note.refute("one-radius", fast and Fraction(radius or 1) < Fraction(1, 2))
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
    note.on(name, plant)
    note.print(plant)
    F = [Matrix.from_integers(rows) for rows in entries]
    literal = fed_back(plant, F)
    lost, stuck = joint_observability(literal), fixed_spectrum(error_system(literal, zeros(plant)))
    note.check("the plant is jointly observable", joint_observability(plant).controllable)
    note.check("what is fed back is not", not lost.controllable)
    note.refute("literal", stuck.polynomial == Polynomial.from_roots([-2]))
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
    "lemma-1": lemma_1,
    "lemma-2": lemma_2,
    "lemma-3": lemma_3,
    "lemma-4": lemma_4,
    "construction": prescribed_rate,
    "recipe": recipe,
}
