"""Examination of sections II-B and II-C: the distributed observer.

The equations (3) to (16) are evaluated at drawn vectors as the paper prints them; Proposition 1,
Theorem 1 and Remark 1 are checked on designs for small plants and on the example of IV-B.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.derived.constructions import error_system
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import decay_pictures, spectrum_picture
from mcexact.reproduce.instances import (
    PAPER,
    Instance,
    Numbers,
    driven,
    errors_agree,
    graph_of,
    needs_gains,
    outputs,
    plants,
    stacked,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.channel_controller import ChannelController
from mcexact.synthesis.design import Design
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.observer import observer_programs
from mcexact.synthesis.state_feedback import default_polynomial, state_feedback

# The equations of the distributed observer, evaluated at drawn vectors as they are printed.


@dataclass(frozen=True)
class Observer:
    """Drawn matrices of an observer, and the loop that the agents' programs make of them.

    Attributes
    ----------
    plant : MultiChannelSystem
    F : sequence of Matrix
    q : int
        The agent with the channel controller.
    K : list of Matrix
    H : list of dict of int to Matrix
        H_ij for j ∈ N_i∖{i}.
    channel : ChannelController
        Ā, [K̄, H̄_j …], C̄ and D̄, by which K_q and H_qj differ from K̃_q and H̃_qj.
    loop : ClosedLoop
    """

    plant: MultiChannelSystem
    F: Sequence[Matrix]
    q: int
    K: list[Matrix]
    H: list[dict[int, Matrix]]
    channel: ChannelController
    loop: ClosedLoop

    def assembled(self, gains: Matrix) -> tuple[Matrix, dict[int, Matrix]]:
        """The parts of a matrix for (C_q e_q, e_q − e_j, …): that of C_q e_q, and those of j."""
        n, width = self.plant.n, self.plant.q(self.q)
        parts = {
            j: gains.take(cols=range(width + k * n, width + (k + 1) * n))
            for k, j in enumerate(self.H[self.q])
        }
        return gains.take(cols=range(width)), parts


def drawn_observer(plant: MultiChannelSystem, F: Sequence[Matrix], numbers: Numbers) -> Observer:
    """Draw K̃_i, H̃_ij and a channel controller of order m − 1 at the last agent."""
    n, m, graph, q = plant.n, plant.m, graph_of(plant), plant.m - 1
    K = [numbers.matrix(n, plant.q(i)) for i in range(m)]
    H = [{j: numbers.matrix(n, n) for j in graph.neighborhood(i) if j != i} for i in range(m)]
    seen = plant.q(q) + n * len(H[q])
    channel = ChannelController(
        numbers.matrix(m - 1, m - 1),
        numbers.matrix(m - 1, seen),
        numbers.matrix(n, m - 1),
        numbers.matrix(n, seen),
        None,
    )
    gains = [hstack([K[i], *H[i].values()]) for i in range(m)]
    controller = observer_programs(plant, graph, F, gains, {q: channel})
    return Observer(plant, F, q, K, H, channel, closed_loop(plant, controller))


def equations_agree(observer: Observer, numbers: Numbers) -> tuple[bool, bool, bool, bool]:
    """Evaluate (9), (10) and (11), and the errors' (12) and (13); with F_i = 0 (3) to (6).

    Returns
    -------
    tuple of bool
        Whether the loop of the programs obeys (9), (10), (11); and (12) and (13) for e_i = x_i − x.
    """
    plant, q, channel = observer.plant, observer.q, observer.channel
    x, z = numbers.column(plant.n), numbers.column(plant.m - 1)
    x_ = [numbers.column(plant.n) for _ in range(plant.m)]
    state = stacked(
        [x, *(part for i in range(plant.m) for part in ([x_[i], z] if i == q else [x_[i]]))]
    )
    ahead = observer.loop.matrix @ state
    parts = {name: ahead.take(rows=range(at, at + size)) for name, (at, size) in _places(observer)}
    y = outputs(plant, x)
    extra_K, extra_H = observer.assembled(channel.D)
    K_bar, H_bar = observer.assembled(channel.B)
    fed = sum((plant.B(j) @ observer.F[j] for j in range(plant.m)), Matrix.zeros(plant.n, plant.n))
    e = [each - x for each in x_]

    def gains(i: int) -> tuple[Matrix, dict[int, Matrix]]:
        if i != q:
            return observer.K[i], observer.H[i]
        return observer.K[i] + extra_K, {j: observer.H[i][j] + extra_H[j] for j in observer.H[i]}

    plant_moves = driven(plant, x, [observer.F[i] @ x_[i] for i in range(plant.m)])
    estimates, errors = [], []
    for i in range(plant.m):
        K, H = gains(i)
        here = channel.C @ z if i == q else Matrix.zeros(plant.n, 1)
        estimate = (plant.A + K @ plant.C(i)) @ x_[i] - K @ y[i] + fed @ x_[i] + here
        error = (plant.A + K @ plant.C(i)) @ e[i] + here
        for j, H_ij in H.items():
            estimate = estimate + H_ij @ (x_[i] - x_[j])
            error = error + H_ij @ (e[i] - e[j])
        for j in range(plant.m):
            error = error + plant.B(j) @ (observer.F[j] @ (e[i] - e[j]))
        estimates.append(estimate)
        errors.append(error)
    z_moves = channel.A @ z + K_bar @ (plant.C(q) @ x_[q]) - K_bar @ y[q]
    z_of_errors = channel.A @ z + K_bar @ (plant.C(q) @ e[q])
    for j, H_j in H_bar.items():
        z_moves = z_moves + H_j @ (x_[q] - x_[j])
        z_of_errors = z_of_errors + H_j @ (e[q] - e[j])
    return (
        parts["x"] == plant_moves,
        [parts[f"x_{i}"] for i in range(plant.m)] == estimates and parts["z"] == z_moves,
        [parts[f"x_{i}"] - parts["x"] for i in range(plant.m)] == errors,
        parts["z"] == z_of_errors,
    )


def _places(observer: Observer) -> list[tuple[str, tuple[int, int]]]:
    """Where x, the x_i and z are in the state of the loop."""
    blocks = observer.loop.blocks
    places = [("x", blocks["x", 0, 0]), ("z", blocks["z_", observer.q, 0])]
    return places + [(f"x_{i}", blocks["x_", i, 0]) for i in range(observer.plant.m)]


# The statements about the distributed observer and certainty equivalence.


def zeros(plant: MultiChannelSystem) -> list[Matrix]:
    """F_i = 0."""
    return [Matrix.zeros(plant.p(i), plant.n) for i in range(plant.m)]


def without_arcs(plant: MultiChannelSystem) -> MultiChannelSystem:
    """The plant with agents that receive nothing from others."""
    return plant.with_neighbors({name: [] for name in plant.names})


def fed_back(plant: MultiChannelSystem, feedbacks: Sequence[Matrix]) -> MultiChannelSystem:
    """The plant with A + Σ B_i F_i in place of A."""
    parts = [B_i @ F_i for B_i, F_i in zip(map(plant.B, range(plant.m)), feedbacks, strict=True)]
    return MultiChannelSystem(
        sum(parts, plant.A),
        [channel.B for channel in plant.channels],
        [channel.C for channel in plant.channels],
        time=plant.time,
        neighbors=graph_of(plant),
    )


def _acts(plant: MultiChannelSystem, feedbacks: Sequence[Matrix]) -> bool:
    """Whether some B_i F_i is not 0."""
    return any(not (plant.B(i) @ F_i).is_zero() for i, F_i in enumerate(feedbacks))


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


def errors_without_feedback(note: Notebook) -> None:
    """II-B: (3) and (4) give the error system with F = 0."""
    numbers = Numbers(5)
    for plant in note.each(plants(10)):
        system = error_system(plant, zeros(plant))
        note.counts(bool(graph_of(plant).edges()))
        note.check(
            "x_i − x obeys the error system without F",
            errors_agree(plant, system, zeros(plant), numbers),
        )
    plant = note.at((PAPER, three_channels()))
    for each in note.each(plants(5)):
        observed = drawn_observer(each, zeros(each), numbers)
        _, observer, errors, channel = equations_agree(observed, numbers)
        note.check("the agents' programs obey (3) and (4)", observer)
        note.check("x_i − x obeys (5), and z obeys (6)", errors and channel)
    note.on(PAPER)
    observed = drawn_observer(plant, zeros(plant), numbers)
    wrong = replace(observed.channel, B=observed.channel.B * -1)
    opposite = replace(observed, channel=wrong)
    note.refute("sign-of-K̄", not equations_agree(opposite, numbers)[3])
    open_loop, F = error_system(plant, zeros(plant)), numbers.feedbacks(plant)
    note.refute("with-feedback", not errors_agree(plant, open_loop, F, numbers))


def almost_any_choice(note: Notebook) -> None:
    """II-B: some K̃_i, H̃_ij make (7) controllable and observable through channel q."""
    for plant in note.each(plants(5)):
        system = error_system(plant, zeros(plant))
        gains = single_channel_gains(system)
        note.counts(needs_gains(system))
        note.check("one choice of gains serves every q", gains.exists)
        note.certify(gains)
    plant = note.at((PAPER, three_channels()))
    still = error_system(plant, zeros(plant))
    reach = joint_controllability(
        MultiChannelSystem(still.A, [still.B(0)], [still.C(0)], names=plant.names[:1])
    )
    note.refute("no-gains", not reach.controllable)
    note.certify(reach)
    gains = single_channel_gains(error_system(without_arcs(plant), zeros(plant)))
    note.refute("any-graph", not gains.exists)
    note.certify(gains)


def centralized_feedback(note: Notebook) -> None:
    """II-C: A + Σ B_i F_i gets any spectrum by one F split into the F_i."""
    for plant in note.each(plants(10)):
        wanted = default_polynomial(StabilityRegion.of("continuous", rate=1), plant.n)
        design = state_feedback(plant, wanted)
        note.counts(characteristic_polynomial(plant.A) != wanted)
        B, F = plant.input_matrix(), vstack(list(design.gains), ncols=plant.n)
        parts = sum(
            (plant.B(i) @ design.gains[i] for i in range(plant.m)),
            Matrix.zeros(plant.n, plant.n),
        )
        note.check("BF = Σ B_i F_i", B @ F == parts)
        note.check(
            "A + BF has the prescribed polynomial",
            characteristic_polynomial(plant.A + parts) == wanted,
        )
        if note.here == PAPER:
            minus = characteristic_polynomial(plant.A - parts)
            note.refute("sign", minus != wanted)
            alone = characteristic_polynomial(plant.A + plant.B(0) @ design.gains[0])
            note.refute("one-agent", alone != wanted)


def errors_with_feedback(note: Notebook) -> None:
    """(12), (14) to (16): the substitution rule makes the errors autonomous."""
    numbers = Numbers(6)
    for plant in note.each(plants(14)):
        F = numbers.feedbacks(plant)
        system = error_system(plant, F)
        note.counts(_acts(plant, F))
        note.check("x_i − x obeys the error system", errors_agree(plant, system, F, numbers))
    for plant in note.each(plants(5)):
        observed = drawn_observer(plant, numbers.feedbacks(plant), numbers)
        _, _, errors, channel = equations_agree(observed, numbers)
        note.check("x_i − x obeys (12)", errors)
        note.check("z obeys (13)", channel)
    plant = note.at((PAPER, three_channels()))
    F = numbers.feedbacks(plant)
    canceled, opposite = zeros(plant), [each * -1 for each in F]
    note.refute("canceled", not errors_agree(plant, error_system(plant, canceled), F, numbers))
    note.refute("sign", not errors_agree(plant, error_system(plant, opposite), F, numbers))
    literal = error_system(fed_back(plant, F), zeros(plant))
    note.refute("without-Q", not errors_agree(plant, literal, F, numbers))


def whole_loop(note: Notebook) -> None:
    """(9) to (11): the loop of the agents' programs splits as the paper says."""
    numbers = Numbers(19)
    for each in note.each(plants(5)):
        F = numbers.feedbacks(each)
        drawn = drawn_observer(each, F, numbers)
        note.counts(_acts(each, F))
        plant_moves, observer, *_ = equations_agree(drawn, numbers)
        note.check("the plant obeys (9)", plant_moves)
        note.check("the agents' programs obey (10) and (11)", observer)
    note.on(PAPER)
    drawn = drawn_observer(three_channels(), numbers.feedbacks(three_channels()), numbers)
    alone = replace(drawn, channel=replace(drawn.channel, D=drawn.channel.D * 0))
    note.refute("D̄", not equations_agree(alone, numbers)[1])
    for name, plant in small():
        note.on(name)
        design = designed(name)
        open_loop = characteristic_polynomial(plant.A) * design.parts["error_polynomial"]
        note.counts(design.loop.polynomial != open_loop)
        note.check(
            "the loop's polynomial is that of A + Σ B_i F_i times that of the errors",
            characteristic_polynomial(design.loop.matrix) == design.loop.polynomial,
        )
        note.certify(design.loop.proof)
        if name == PAPER:
            note.refute("plant-alone", design.loop.polynomial != open_loop)
            size = design.loop.matrix.nrows
            note.refute("one-more", size != plant.n + plant.n * plant.m + plant.m)


def proposition_1(note: Notebook) -> None:
    """Proposition 1, for drawn F_i."""
    numbers = Numbers(7)
    for plant in note.each(plants(8)):
        F = numbers.feedbacks(plant)
        system = error_system(plant, F)
        gains = single_channel_gains(system, want="both", index=plant.m)
        note.counts(needs_gains(system))
        note.check("one choice of gains serves every q", gains.exists)
        note.check(
            "with controllability index m",
            gains.indices is not None and all(each[0] == plant.m for each in gains.indices),
        )
        note.certify(gains)
        if note.here == PAPER:
            reached = [indices for indices in gains.indices or () if indices[0] < plant.m]
            note.refute("smaller-index", gains.exists and not reached)
    plant = note.at((PAPER, three_channels()))
    gains = single_channel_gains(error_system(without_arcs(plant), numbers.feedbacks(plant)))
    note.refute("any-graph", not gains.exists)
    note.certify(gains)


def theorem_1(note: Notebook) -> None:
    """Theorem 1: every number of the error system is prescribed; any q."""
    for name, plant in small():
        note.on(name, plant)
        design = designed(name)
        note.counts(needs_gains(error_system(plant, zeros(plant))))
        size = plant.n * plant.m + plant.m - 1
        wanted = Polynomial.from_roots([-2 - k % 2 for k in range(size)])
        assigned = design.parts["error_polynomial"]
        note.check("the error system has the prescribed polynomial", assigned == wanted)
        note.certify(design.loop.proof)
    plant = note.at(small()[1])
    size = plant.n * plant.m + plant.m - 1
    pairs = Polynomial.of(2, 2, 1) ** (size // 2) * Polynomial.of(3, 1) ** (size % 2)
    complex_ = design_observer(plant, spectrum={"feedback": [-1] * plant.n, "error": pairs})
    note.check("complex pairs are prescribed", complex_.parts["error_polynomial"] == pairs)
    note.certify(complex_.loop.proof)
    other = plant.names[-1]
    design = design_observer(plant, agent=other, rate=1)
    note.check(f"channel {other} can carry the channel controller", design.parts["agent"] == other)
    note.certify(design.loop.proof)
    note.refute("one-number-less", design.parts["error_polynomial"].degree != plant.n * plant.m)
    plant = note.at((PAPER, three_channels()))
    try:
        design_observer(without_arcs(plant), rate=1)
    except Impossible as refused:
        fixed = fixed_spectrum(error_system(without_arcs(plant), zeros(plant)))
        note.refute("any-graph", not fixed.empty)
        note.certify(fixed, refused.certificate)
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
    for drawn in decay_pictures(run, spectrum, "The example under its distributed observer"):
        note.show(drawn)


def remark_1(note: Notebook) -> None:
    """Remark 1: the design is central, and programs use only signals that their agents receive."""
    for name, plant in small():
        note.on(name, plant)
        controller = designed(name).controller
        graph = graph_of(plant)
        missing = len(graph.edges()) < plant.m * (plant.m - 1)
        note.counts(missing or any(rank(plant.C(i)) < plant.n for i in range(plant.m)))
        note.check(
            "every signal that a program uses comes along an arc",
            set(controller.edges()) <= set(graph.edges()),
        )
        loop = designed(name).loop.closed
        for i in range(plant.m):
            ahead = loop.pick("x_", i) @ loop.matrix
            strangers = set(range(plant.m)) - set(graph.neighborhood(i))
            unheard = all((ahead @ loop.pick("x_", j).T).is_zero() for j in strangers)
            note.check(f"x_{i + 1} moves without the x_j of agents that are no neighbors", unheard)
            felt = ahead @ loop.pick("x").T
            own = rank(vstack([plant.C(i), felt])) == rank(plant.C(i))
            note.check(f"and is moved by x through y_{i + 1} alone", own)
        if name == PAPER:
            note.refute("all-signals", len(controller.edges()) < plant.m * (plant.m - 1))


PROCEDURES: dict[str, Procedure] = {
    "equations-3-6": errors_without_feedback,
    "equations-7-8": almost_any_choice,
    "candidate": centralized_feedback,
    "equations-9-11": whole_loop,
    "equations-12-16": errors_with_feedback,
    "proposition-1": proposition_1,
    "theorem-1": theorem_1,
    "remark-1": remark_1,
}
