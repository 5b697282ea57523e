"""Examination of sections II-A, II-D and IV-E: graphs, lemmas, and almost all gains.

The lemmas behind Proposition 1 and its construction; along lines of gains, that only finitely many
fail; and certainty equivalence with the graphs that respect it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product

from mcexact.analysis.controllability import (
    controllability_indices,
    exceptional_gains,
    joint_controllability,
    joint_observability,
)
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.answer.structure import ControllabilityIndices
from mcexact.derived.constructions import closed_by, error_system, extended_system, feedback
from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix, block, hstack, kronecker, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import spectrum_picture
from mcexact.reproduce.instances import (
    PAPER,
    Numbers,
    deficient_plants,
    dependent_inputs,
    drawn_plants,
    graph_of,
    hidden_by_feedback,
    needs_gains,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import fed_back, without_arcs, zeros
from mcexact.synthesis.distributed_observer import design_observer

# Section II-D: the lemmas behind Proposition 1, and the construction.

INDEX_THREE = "four states, two inputs, index 3"


def lemma_1(note: Notebook) -> None:
    """Lemma 1: the error system is jointly controllable and observable."""
    numbers = Numbers(8)
    for plant in note.each(plants(10), deficient_plants(4)):
        system = error_system(plant, numbers.feedbacks(plant))
        apart = error_system(without_arcs(plant), zeros(plant))
        note.counts(not joint_observability(apart).controllable)
        note.check(
            "[B̃_1 … B̃_m] is the identity",
            hstack([system.B(i) for i in range(system.m)]) == Matrix.identity(system.n),
        )
        note.joint(system)
    plant = note.at((f"{PAPER}, without arcs", three_channels()))
    observability = joint_observability(error_system(without_arcs(plant), zeros(plant)))
    note.refute("any-graph", not observability.controllable)
    note.certify(observability)


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
    answer = single_channel_gains(scalars, want="controllable")
    if answer.gains is None:
        raise ValueError("the neighbor graph is not strongly connected")
    wide = [
        hstack(
            [
                Matrix.zeros(plant.n, plant.q(i)),
                kronecker(answer.gains[i], Matrix.identity(plant.n)),
            ]
        )
        for i in range(plant.m)
    ]
    return wide, list(answer.gains), feedback(scalars, answer.gains).A


def lemma_2(note: Notebook) -> None:
    """Lemma 2: Σ B̃_i Ĥ_i C̃_i = D ⊗ I reaches everything from every B̃_q, with index m."""
    for plant in note.each(plants(10)):
        note.certify(single_channel_gains(_graph_scalars(graph_of(plant)), want="controllable"))
        wide, _, D = _lifted_scalars(plant)
        note.counts(needs_gains(_graph_scalars(graph_of(plant))))
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
            indices = controllability_indices(loop, [q])
            note.check(f"channel {q} controls it with index m", indices.index == plant.m)
            note.certify(indices)
            if note.here == PAPER:
                note.refute(
                    "smaller-index", indices.index is not None and indices.index > plant.m - 1
                )
    plant = note.at((PAPER, three_channels()))
    lost = single_channel_gains(_graph_scalars(graph_of(without_arcs(plant))), want="controllable")
    note.refute("any-graph", not lost.exists)
    note.certify(lost)


def lemma_3(note: Notebook) -> None:
    """Lemma 3: all exceptional values g are found, and there are finitely many."""
    for name, A, B, M in _pairs():
        note.on(name)
        n, r = B.shape
        exceptional = exceptional_gains(M, A, B)
        note.counts(exceptional.index > 1)
        note.check(
            "finitely many g lose the first m blocks",
            not exceptional.index_set.polynomial.is_zero(),
        )
        note.certify(exceptional.index_set, exceptional.controllability_set, exceptional.indices)
        g = next(g for g in range(1, 1000) if g not in exceptional.index_set)
        indices = _indices(M + A * g, B)
        within = indices.index is not None and indices.index <= exceptional.index
        note.check("another g keeps the index within m", within)
        if exceptional.index * r == n:
            note.check("if mr = n another g keeps the index m", indices.index == exceptional.index)
        note.certify(indices)
        if name == INDEX_THREE:
            after = [_indices(M + A * g, B) for g in (0, 1, 2, 3)]
            note.check("(A, B) has index 3", exceptional.index == 3)
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
        system = error_system(plant, numbers.feedbacks(plant))
        wide, _, _ = _lifted_scalars(plant)
        base = [
            hstack(
                [
                    numbers.matrix(plant.n, plant.q(i)),
                    Matrix.zeros(plant.n, system.q(i) - plant.q(i)),
                ]
            )
            for i in range(plant.m)
        ]
        M = feedback(system, base).A
        D = feedback(system, wide).A - system.A
        sets = [exceptional_gains(M, D, system.B(i)).index_set for i in range(plant.m)]
        note.certify(*sets)
        reached = [_indices(M, system.B(i)).index for i in range(plant.m)]
        note.counts(any(index != plant.m for index in reached))
        g = next(g for g in range(1, 1000) if all(g not in each for each in sets))
        loop = feedback(system, [K + H * g for K, H in zip(base, wide, strict=True)])
        for q in plant.names:
            answer = controllability_indices(loop, [q])
            note.check(f"g = {g}: channel {q} controls with index m", answer.index == plant.m)
            note.certify(answer)
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
        note.counts(not wanted.contains_roots_of(characteristic_polynomial(plant.A)))
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
    open_loop = characteristic_polynomial(plant.A)
    note.counts(not StabilityRegion.of(plant.time, rate=1).contains_roots_of(open_loop))
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
    lost, fixed = joint_observability(literal), fixed_spectrum(error_system(literal, zeros(plant)))
    note.check("the plant is jointly observable", joint_observability(plant).controllable)
    note.counts(not lost.controllable)
    note.check("what is fed back is not", not lost.controllable)
    note.refute("literal", fixed.polynomial == Polynomial.from_roots([-2]))
    gains = single_channel_gains(error_system(plant, F), want="both", index=plant.m)
    note.check("(16) has gains, with index m", gains.exists)
    wanted = [-3 - k for k in range(plant.n * plant.m + plant.m - 1)]
    design = design_observer(plant, spectrum={"error": wanted}, gains=F)
    note.check(
        "and its errors get a spectrum without −2",
        design.parts["error_polynomial"] == Polynomial.from_roots(wanted),
    )
    note.certify(lost, fixed, gains, design.loop.proof)


LEMMAS: dict[str, Procedure] = {
    "lemma-1": lemma_1,
    "lemma-2": lemma_2,
    "lemma-3": lemma_3,
    "lemma-4": lemma_4,
    "construction": prescribed_rate,
    "recipe": recipe,
}


# Sections II-B, II-D and IV-E: almost all gains serve, and complementary subsystems.

DRAWN = 8
"""How many drawn gains are tried for each system."""


def through(A: Matrix, B: Matrix) -> MultiChannelSystem:
    """The pair (A, B) as a system that nothing measures."""
    return MultiChannelSystem(A, [B], [Matrix.zeros(0, A.nrows)])


def serve(system: MultiChannelSystem, gains: Sequence[Matrix]) -> bool:
    """Whether the loop is controllable and observable through every channel."""
    loop = closed_by(system, gains)
    pairs = [(loop, system.B(q)) for q in range(system.m)]
    pairs += [(loop.T, system.C(q).T) for q in range(system.m)]
    return all(joint_controllability(through(*pair)).controllable for pair in pairs)


def _on_a_line(
    note: Notebook,
    system: MultiChannelSystem,
    start: Sequence[Matrix],
    along: Sequence[Matrix],
    *,
    index: int | None = None,
    dual: bool = False,
) -> None:
    """Along the gains start + h·along finitely many h fail for some channel.

    The gains that fail are the zeros of polynomials.  A polynomial that has finitely many zeros on
    a line is not zero, and so the zeros of all of them are a proper algebraic set.  With the loops
    M + hD on the line, (M + hD, B) is controllable iff a multiple of it is, as D + g(M + D) with
    h = (1 + g)/g; in this form Lemma 3 finds all exceptions.
    """
    M = closed_by(system, start)
    D = closed_by(system, along) - system.A
    for q in range(system.m):
        port = system.C(q).T if dual else system.B(q)
        first, direction = (M.T, D.T) if dual else (M, D)
        exceptional = exceptional_gains(direction, first + direction, port)
        failing = exceptional.controllability_set if index is None else exceptional.index_set
        if index is not None:
            note.check("drawn gains have index m", exceptional.index == index)
        what = "observable" if dual else "controllable"
        claim = f"on a line of gains, finitely many are not {what} through channel {q + 1}"
        note.check(claim, not failing.polynomial.is_zero())
        if q == 0:
            note.certify(failing)


def error_gains(note: Notebook) -> None:
    """The gains of (7), of Lemma 4 for given K_i, and those that make (16) observable."""
    numbers = Numbers(23, largest=9)
    for plant in note.each(plants(1)):
        system = error_system(plant, zeros(plant))
        drawn = [numbers.gains(system) for _ in range(DRAWN)]
        note.check("all drawn gains serve every channel", all(serve(system, G) for G in drawn))
        note.refute("few", all(serve(system, G) for G in drawn))
        none = [G * 0 for G in drawn[0]]
        note.counts(not serve(system, none))
        note.refute("all", not serve(system, none))
        _on_a_line(note, system, drawn[0], drawn[1])
        _on_a_line(note, system, drawn[0], drawn[1], dual=True)
    for plant in note.each(plants(1)):
        system = error_system(plant, numbers.feedbacks(plant))
        parts = [_apart(G, plant.q(i)) for i, G in enumerate(numbers.gains(system))]
        K, H = [K for K, _ in parts], [H for _, H in parts]
        start = [k + h for k, h in zip(K, H, strict=True)]
        _on_a_line(note, system, start, H, index=plant.m)
        _on_a_line(note, system, start, numbers.gains(system), dual=True)
        note.check("some gains do both", serve(system, start))
        note.counts(needs_gains(system))
        if note.here == PAPER:
            reach = controllability_indices(through(closed_by(system, K), system.B(0)))
            note.refute("H=0", reach.index is None)
            note.certify(reach)


def _apart(gains: Matrix, q: int) -> tuple[Matrix, Matrix]:
    """The gains K_i of C_i e_i and H_i of the e_i − e_j, each with zeros in place of the other."""
    n, width = gains.nrows, gains.ncols - q
    K, H = gains.take(cols=range(q)), gains.take(cols=range(q, gains.ncols))
    return hstack([K, Matrix.zeros(n, width)]), hstack([Matrix.zeros(n, q), H])


def extended_gains(note: Notebook) -> None:
    """The gains F̄_i of (31), with n_i ≥ 1."""
    numbers = Numbers(24, largest=99)
    for plant in note.each(plants(3)):
        system = extended_system(plant, [1] * plant.m)
        drawn = [numbers.gains(system) for _ in range(DRAWN)]
        note.check("all drawn gains serve every channel", all(serve(system, G) for G in drawn))
        note.refute("few", all(serve(system, G) for G in drawn))
        none = [G * 0 for G in drawn[0]]
        note.counts(not serve(system, none))
        note.refute("all", not serve(system, none))
        _on_a_line(note, system, drawn[0], drawn[1])
        _on_a_line(note, system, drawn[0], drawn[1], dual=True)


def complementary(note: Notebook) -> None:
    """All complementary subsystems of (16) are complete."""
    numbers = Numbers(25)
    for plant in note.each(plants(8)):
        F = numbers.feedbacks(plant)
        answer = completeness(error_system(plant, F))
        note.counts(not completeness(error_system(without_arcs(plant), F)).complete)
        note.check("(16) is complete for all subsets of channels", answer.complete)
        note.certify(answer)
    plant = three_channels()
    note.on(f"{PAPER}, without arcs", without_arcs(plant))
    lost = completeness(error_system(without_arcs(plant), numbers.feedbacks(plant)))
    note.refute("any-graph", not lost.complete)
    note.certify(lost)
    note.on(PAPER, plant)
    own = completeness(plant)
    note.refute("plant", not own.complete)
    note.certify(own)


ALMOST_ANY: dict[str, Procedure] = {
    "almost-any": error_gains,
    "complementary": complementary,
    "almost-any-extended": extended_gains,
}


# Section II-A: certainty equivalence, the cancellation rule, and the graphs that respect it.


def one_agent(note: Notebook) -> None:
    """With one agent the spectrum is that of A + BF and that of A + KC."""
    numbers = Numbers(4)
    for plant in note.each(plants(8)):
        B, C = plant.input_matrix(), plant.output_matrix()
        F, K = numbers.matrix(B.ncols, plant.n), numbers.matrix(plant.n, C.nrows)
        loop = block([[plant.A, B @ F], [-(K @ C), plant.A + K @ C + B @ F]])
        x, e = numbers.column(plant.n), numbers.column(plant.n)
        ahead = loop @ vstack([x, x + e])
        error = ahead.take(rows=range(plant.n, 2 * plant.n)) - ahead.take(rows=range(plant.n))
        note.check("ė = (A + KC)e, whatever x is", error == (plant.A + K @ C) @ e)
        apart = characteristic_polynomial(plant.A + B @ F) * characteristic_polynomial(
            plant.A + K @ C
        )
        note.check("the loop's polynomial is the product", characteristic_polynomial(loop) == apart)
        note.counts(apart != characteristic_polynomial(plant.A) ** 2)
        if note.here == PAPER:
            twice = characteristic_polynomial(plant.A + B @ F) ** 2
            wrong = characteristic_polynomial(plant.A + B @ F) * characteristic_polynomial(
                plant.A - K @ C
            )
            kept = block([[plant.A, B @ F], [-(K @ C), plant.A + K @ C]])
            note.refute("twice", characteristic_polynomial(loop) != twice)
            note.refute("sign", characteristic_polynomial(loop) != wrong)
            note.refute("without-input", characteristic_polynomial(kept) != apart)


def _after_steps(
    plant: MultiChannelSystem, F: Matrix, x: Matrix, errors: Sequence[Matrix]
) -> Matrix:
    """The state after steps of x(t+1) = Ax + BF(x + e), with one e for each."""
    for e in errors:
        x = plant.A @ x + plant.input_matrix() @ (F @ (x + e))
    return x


def small_errors(note: Notebook) -> None:
    """The state under u = F(x + e) deviates from that under u = Fx by a linear function of e."""
    numbers = Numbers(20)
    for plant in note.each(plants(8, time="discrete")):
        F = numbers.matrix(plant.input_matrix().ncols, plant.n)
        x = numbers.column(plant.n)
        errors = [numbers.column(plant.n) for _ in range(plant.n + 2)]
        deviations = {
            size: _after_steps(plant, F, x, [e * size for e in errors])
            - _after_steps(plant, F, x, [e * 0 for e in errors])
            for size in (1, -3, 2, 1000)
        }
        note.counts(not deviations[1].is_zero())
        note.check(
            "errors times g make g times the deviation",
            all(deviation == deviations[1] * size for size, deviation in deviations.items()),
        )
        note.refute("exact", not deviations[1].is_zero())
        note.refute("square", deviations[2] != deviations[1] * 4)


def respects(
    plant: MultiChannelSystem, feedbacks: Sequence[Matrix], graph: NeighborGraph, agent: int
) -> bool:
    """Whether Σ B_j F_j x_j is a function of the x_j that an agent receives."""
    unit = Matrix.identity(plant.n * plant.m)
    heard = graph.neighborhood(agent)
    received = vstack(
        [unit.take(rows=range(j * plant.n, (j + 1) * plant.n)) for j in heard], ncols=unit.ncols
    )
    needed = hstack([plant.B(j) @ feedbacks[j] for j in range(plant.m)])
    return rank(vstack([received, needed])) == rank(received)


def graphs(note: Notebook) -> None:
    """The rule respects a graph iff all agents receive from all others, unless a B_j F_j is 0."""
    numbers = Numbers(21)
    complete = three_channels().with_neighbors(NeighborGraph.complete(("1", "2", "3")))
    for plant in note.each(
        [(f"{PAPER}, over the complete graph", complete)],
        plants(4),
        drawn_plants(4, connected=False),
    ):
        graph, agents = graph_of(plant), range(plant.m)
        F = [numbers.matrix(plant.p(i), plant.n) for i in agents]
        acting = {i for i in agents if not (plant.B(i) @ F[i]).is_zero()}
        note.check("no B_j F_j is zero", acting == set(agents))
        kept = all(respects(plant, F, graph, i) for i in agents)
        everybody = all(len(graph.neighborhood(i)) == plant.m for i in agents)
        note.counts(not everybody)
        note.check("the rule respects the graph just when the graph is complete", kept == everybody)
        for zero in product((False, True), repeat=plant.m):
            G = [F[j] * int(not zero[j]) for j in agents]
            some = {j for j in agents if not zero[j]}
            note.check(
                "and agent i just when all j with B_j F_j ≠ 0 are neighbors of i",
                all(
                    respects(plant, G, graph, i) == (some <= set(graph.neighborhood(i)))
                    for i in agents
                ),
            )
        if graph.is_strongly_connected() and not everybody:
            note.refute("connected", not kept)
    name, plant, gains = dependent_inputs()
    note.on(name, plant)
    note.print(plant)
    graph = graph_of(plant)
    kept = all(respects(plant, gains, graph, i) for i in range(plant.m))
    nonzero = all(not F.is_zero() for F in gains)
    note.refute("F_j", kept and nonzero and len(graph.neighborhood(0)) < plant.m)


CANCELLATION: dict[str, Procedure] = {
    "cancellation": one_agent,
    "small-errors": small_errors,
    "cancellation-graph": graphs,
}
