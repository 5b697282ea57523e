"""Examination of section III: distributed set-point control.

The plant with integrators and the conditions under which it is controllable; designs by both
methods run on the network; and what the section says about further signals and added references.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.structure import setpoint_solvability
from mcexact.derived.constructions import setpoint_system
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial, determinant, rank, solve
from mcexact.exact.matrix import Matrix, block, hstack, kronecker, to_float, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import TIMES, StabilityRegion, is_discrete, steady_point
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import response_picture
from mcexact.reproduce.instances import (
    PAPER,
    Instance,
    Numbers,
    deficient_plants,
    drawn_plants,
    hidden_zero,
    integrators_agree,
    plants,
    stacked,
    three_channels,
    two_tanks,
    unreached,
    unseen,
    washed_out,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import designed, small
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.design import Design
from mcexact.synthesis.optimum.figures import THEOREM
from mcexact.synthesis.setpoint import SetpointMethod, design_setpoint
from mcexact.synthesis.state_feedback import default_polynomial, state_feedback

# The plant with integrators, its controllability, and designs.

METHODS: tuple[SetpointMethod, ...] = ("observer", "extended")


def integrators(note: Notebook) -> None:
    """(17) and (18), in both time domains."""
    numbers = Numbers(13)
    for name, plant in [*plants(5), *drawn_plants(2, time="discrete")]:
        note.on(f"{name}, {plant.time} time", plant)
        system = setpoint_system(plant)
        note.counts(not plant.output_matrix().is_zero())
        note.check("the states w_i integrate y_i", integrators_agree(plant, system, numbers))
        note.certify(joint_observability(system))
    note.on(PAPER)
    plant = three_channels()
    system = setpoint_system(plant)
    x = numbers.column(plant.n)
    state = stacked([x, Matrix.zeros(system.n - plant.n, 1)])
    ahead, y = (system.A @ state).take(rows=range(plant.n, system.n)), plant.output_matrix() @ x
    note.refute("sign", ahead == y and ahead != y * -1)
    note.refute("outputs", system.output_matrix() @ state != y)


def _held_plants() -> Iterator[Instance]:
    """Plants whose set-points can be held, over graphs, in both time domains."""
    for time in TIMES:
        name, plant = two_tanks(time)
        yield f"{name}, {time} time", plant
    for name, plant in drawn_plants(10, states=3, channels=2, first=31):
        if joint_controllability(setpoint_system(plant)).controllable:
            yield name, plant


def any_stabilizing_control(note: Notebook) -> None:
    """A stabilizing control holds y at r: at the equilibrium ẇ = y − r = 0.

    Static state feedback, decentralized dynamic controllers, and distributed ones: the equilibrium
    is computed exactly, and the loop is proved stable, so that the state tends to it.
    """
    for name, plant in _held_plants():
        note.on(name, plant)
        system = setpoint_system(plant)
        q = system.n - plant.n
        wanted = Matrix.identity(q)
        region = StabilityRegion.of(plant.time, *_speed(plant.time))
        F = state_feedback(system, default_polynomial(region, system.n))
        loop = system.A + system.input_matrix() @ vstack(list(F.gains), ncols=system.n)
        still = Matrix.identity(system.n) * steady_point(plant.time) - loop
        # ẇ = y − r (w(t+1) − w = y − r), and r enters nowhere else.
        rest = solve(still, vstack([Matrix.zeros(plant.n, q), wanted * -1]))
        C = plant.output_matrix()
        held = None if rest is None else C @ rest.take(rows=range(plant.n))
        note.check("at rest y = r under state feedback, for every r", held == wanted)
        for what, design in _designs(plant):
            note.counts(held is not None)
            note.check(f"at rest y = r, {what}", design.loop.closed.steady_gain == wanted)
            note.check(f"which is stable, {what}", "stability" in design.certificates)
            note.certify(*design.certificates.values())
        if plant.n == q == plant.input_matrix().ncols and held is not None:
            note.refute("sign", held != wanted * -1)
            # u_i = −3(y_i − r_i), without integrators.
            B, place = plant.input_matrix() * -3, steady_point(plant.time)
            rest = solve(Matrix.identity(plant.n) * place - plant.A - B @ C, B * -1)
            note.refute("without-integrators", rest is not None and C @ rest != wanted)


def _speed(time: str) -> tuple[str | None, str | None]:
    """A rate in continuous time, or a radius in discrete time."""
    return (None, "1/2") if is_discrete(time) else ("1", None)


def _designs(plant: MultiChannelSystem) -> Iterator[tuple[str, Design]]:
    """Controllers that stabilize plant and integrators: both methods, and without messages."""
    rate, radius = _speed(plant.time)
    if plant.n == 2:
        for method in METHODS:
            design = design_setpoint(plant, rate=rate, radius=radius, method=method, aims=THEOREM)
            yield f"distributed, by the method {method}", design
    apart = plant.with_neighbors({name: [] for name in plant.names})
    if fixed_spectrum(setpoint_system(apart)).empty:
        design = design_setpoint(apart, rate=rate, radius=radius, method="extended", aims=THEOREM)
        yield "decentralized", design


def always_observable(note: Notebook) -> None:
    """(19): the plant with integrators is jointly observable if the plant is."""
    for plant in note.each(plants(8), deficient_plants(4), (washed_out(), hidden_zero())):
        observability = joint_observability(setpoint_system(plant))
        note.counts(rank(plant.output_matrix()) < plant.n)
        note.check("jointly observable through the w_i", observability.controllable)
        note.certify(observability)
    plant = note.at(unseen())
    observability = joint_observability(setpoint_system(plant))
    note.refute("any-plant", not observability.controllable)
    note.certify(observability)


def only_zero_matters(note: Notebook) -> None:
    """(20) holds at every s ≠ 0: uncontrollable modes are at 0."""
    for plant in note.each(plants(8), deficient_plants(4), (washed_out(), hidden_zero())):
        controllability = joint_controllability(setpoint_system(plant))
        lost = controllability.uncontrollable_polynomial
        note.counts(rank(plant.input_matrix()) < plant.n)
        note.check("what is out of reach is at 0", not any(lost.coefficients[:-1]))
        note.certify(controllability)
        if note.here == washed_out()[0]:
            note.refute("also-0", lost == Polynomial.x())
    plant = note.at(unreached())
    controllability = joint_controllability(setpoint_system(plant))
    note.refute("any-plant", any(controllability.uncontrollable_polynomial.coefficients[:-1]))
    note.certify(controllability)


def condition(note: Notebook) -> None:
    """(21) is joint controllability of (18)."""
    for plant in note.each(plants(10), (two_tanks(), washed_out(), hidden_zero())):
        solvability = setpoint_solvability(plant)
        B, C = plant.input_matrix(), plant.output_matrix()
        S = block([[plant.A, B], [C, Matrix.zeros(C.nrows, B.ncols)]])
        note.counts(C.nrows <= B.ncols)
        note.check("the rank of [A B; C 0] is as reported", rank(S) == solvability.rank)
        augmented = joint_controllability(setpoint_system(plant))
        note.check(
            "full rank just when (18) is jointly controllable",
            solvability.solvable == augmented.controllable,
        )
        if not solvability.solvable:
            lost = augmented.uncontrollable_polynomial
            note.check("otherwise the mode 0 of integrators is canceled", lost(0) == 0)
        note.certify(solvability, augmented)
        if note.here == washed_out()[0]:
            note.refute("always", not solvability.solvable)
            note.refute("rank-n", solvability.rank >= plant.n and not augmented.controllable)


def determinant_at_zero(note: Notebook) -> None:
    """If G is square and 0 ∉ σ(A), (21) iff det C A⁻¹ B ≠ 0; refuted for a pole at 0."""
    for plant in note.each((two_tanks(), washed_out())):
        B, C = plant.input_matrix(), plant.output_matrix()
        inside = solve(plant.A, B)
        note.counts(inside is not None)
        nonzero = inside is not None and determinant(C @ inside) != 0
        solvability = setpoint_solvability(plant)
        note.check(
            "no pole at 0: solvable just when det C A⁻¹ B ≠ 0", solvability.solvable == nonzero
        )
        note.certify(solvability)
    plant = note.at(hidden_zero())
    note.print(plant)
    solvability = setpoint_solvability(plant)
    pole = characteristic_polynomial(plant.A)(0) == 0
    note.counts(pole)
    note.check("0 is a pole", pole)
    # det [sI − A, B; −C, 0] = det(sI − A) det G(s), where the pole hides the zero.
    note.check(
        "det(sI − A) is s(s + 1)²",
        characteristic_polynomial(plant.A) == Polynomial.from_roots([0, -1, -1]),
    )
    B, C, unit = plant.input_matrix(), plant.output_matrix(), Matrix.identity(plant.n)
    pencils = [
        block([[unit * s - plant.A, B], [C * -1, Matrix.zeros(C.nrows, B.ncols)]])
        for s in range(plant.n + 1)
    ]
    note.check(
        "det [sI − A, B; −C, 0] is s, so that det G is 1/(s + 1)²",
        [determinant(pencil) for pencil in pencils] == list(range(plant.n + 1)),
    )
    note.refute("pole-at-0", not solvability.solvable)
    note.certify(solvability)


def distributed_setpoints(note: Notebook) -> None:
    """Both methods lead every output to the set-point of its agent; run on the network."""
    plant = note.at(two_tanks())
    solvable = setpoint_solvability(plant).solvable
    for method in METHODS:
        design = design_setpoint(plant, rate=1, method=method, aims=THEOREM)
        note.counts(solvable)
        note.check(f"a stable loop by the method {method}", "stability" in design.certificates)
        note.certify(*design.certificates.values())
    wanted = [Fraction(1), Fraction(-2)]
    design = design_setpoint(plant, rate=1, aims=THEOREM)
    run = simulate(plant, design.controller, horizon=16, reference=[[r] for r in wanted])
    outputs = list(run.values("outputs").values())
    goals = [to_float(r) for r in wanted]
    gain = design.loop.closed.steady_gain
    note.check("exactly, every output rests at its set-point", gain == Matrix.identity(2))
    note.refute("other-agent", gain != Matrix.from_integers([[0, 1], [1, 0]]))
    near = all(abs(y[-1] - r) < 1e-3 for y, r in zip(outputs, goals, strict=True))
    note.check("the run ends at the set-points 1 and −2", near)
    note.show(response_picture(run, "Set-point responses"))
    _exactly_in_time(note, wanted)
    plant = note.at(washed_out())
    try:
        design_setpoint(plant.with_neighbors({plant.names[0]: []}), rate=1)
    except Impossible as refused:
        note.check("refused where a set-point cannot be held", True)
        note.refute("always", not setpoint_solvability(plant).solvable)
        note.certify(refused.certificate)
    else:
        note.check("refused where a set-point cannot be held", False)


def _exactly_in_time(note: Notebook, wanted: Sequence[Fraction]) -> None:
    """In discrete time, with all eigenvalues at 0, the outputs are at the set-points and stay."""
    name, plant = two_tanks("discrete")
    note.on(f"{name}, discrete time", plant)
    order = plant.n + plant.m
    spectrum = {"feedback": [0] * order, "error": [0] * (order * plant.m + plant.m - 1)}
    design = design_setpoint(plant, spectrum=spectrum, method="observer")
    size = design.loop.matrix.nrows
    nilpotent = characteristic_polynomial(design.loop.matrix) == Polynomial.x() ** size
    note.counts(nilpotent)
    note.check("all eigenvalues of the loop are 0", nilpotent)
    run = simulate(plant, design.controller, horizon=size + 3, reference=[[r] for r in wanted])
    goal = Matrix.column(wanted)
    there = [plant.output_matrix() @ Matrix.column(shot.plant) == goal for shot in run.snapshots]
    note.check("after as many steps as it has states y = r, exactly", all(there[size:]))
    note.refute("at-once", not all(there))
    note.certify(design.loop.proof)


def wrong_estimates(note: Notebook) -> None:
    """The observers of the set-point design estimate the state wrongly, and y = r all the same."""
    for time in TIMES:
        name, plant = two_tanks(time)
        note.on(f"{name}, {time} time", plant)
        rate, radius = _speed(time)
        design = design_setpoint(plant, rate=rate, radius=radius, method="observer", aims=THEOREM)
        loop = design.loop.closed
        still = Matrix.identity(loop.dimension) * steady_point(time) - loop.matrix
        rest = solve(still, loop.reference)
        note.counts(rest is not None)
        note.check("there is one equilibrium for every r", rest is not None)
        if rest is None:
            continue
        x = loop.pick("x") @ rest
        note.check("at which y = r", plant.output_matrix() @ x == Matrix.identity(2))
        wrong = [(loop.pick("x_", i) @ rest).take(rows=range(plant.n)) - x for i in range(plant.m)]
        note.check("for every r ≠ 0 some estimate is wrong", rank(vstack(wrong)) == plant.m)
        note.refute("right-estimates", all(not each.is_zero() for each in wrong))
        note.certify(*design.certificates.values())


SETPOINT: dict[str, Procedure] = {
    "equations-17-18": integrators,
    "attained": any_stabilizing_control,
    "equation-19": always_observable,
    "equation-20": only_zero_matters,
    "equation-21": condition,
    "determinant": determinant_at_zero,
    "setpoints": distributed_setpoints,
    "wrong-estimates": wrong_estimates,
}


# Section III: signals that can be tracked, and references that are added to the control.

SIGNALS = {
    "continuous": {
        "steps": Polynomial.of(0, 1),
        "ramps": Polynomial.of(0, 0, 1),
        "sinusoids of frequency 1": Polynomial.of(1, 0, 1),
        "sinusoids of frequency 2": Polynomial.of(4, 0, 1),
    },
    "discrete": {
        "steps": Polynomial.of(-1, 1),
        "ramps": Polynomial.of(1, -2, 1),
        "sinusoids": Polynomial.of(1, "-6/5", 1),
    },
}
"""Polynomials whose roots are the modes of the signals."""


def generator(signal: Polynomial) -> Matrix:
    """A matrix whose characteristic polynomial is that of the signals."""
    degree = signal.degree
    last = [-coefficient for coefficient in signal.coefficients[:-1]]
    rows = [[int(c == r + 1) for c in range(degree)] for r in range(degree - 1)]
    return Matrix.from_rows([*rows, last])


def with_internal_model(plant: MultiChannelSystem, signal: Polynomial) -> MultiChannelSystem:
    """Give every agent with a scalar output ξ̇_i = Sξ_i + b(y_i − r_i), all of which it measures.

    For S = 0 it is (18).  The references enter as −b r_i.
    """
    S, degree, m = generator(signal), signal.degree, plant.m
    b = Matrix.column([*[0] * (degree - 1), 1])
    unit = Matrix.identity(m)
    A = block(
        [
            [plant.A, Matrix.zeros(plant.n, m * degree)],
            [kronecker(unit, b) @ plant.output_matrix(), kronecker(unit, S)],
        ]
    )
    whole = Matrix.identity(plant.n + m * degree)
    starts = [plant.n + i * degree for i in range(m)]
    C = [whole.take(rows=range(start, start + degree)) for start in starts]
    B = [vstack([plant.B(i), Matrix.zeros(m * degree, plant.p(i))]) for i in range(m)]
    return MultiChannelSystem(A, B, C, time=plant.time, neighbors=plant.neighbors)


def lasting_error(
    plant: MultiChannelSystem, loop: ClosedLoop, model: Polynomial, signal: Polynomial
) -> Matrix | None:
    """Compute how y − r depends on the state ρ of the signals after all transients.

    The loop of plant and internal models is ż = Mz + Nr with ρ̇ = Sρ and r = Γρ, the first state of
    each generator.  Then z tends to Πρ with ΠS = MΠ + NΓ, and y − r to (CΠ − Γ)ρ; None if there is
    no such Π.  In discrete time z(t+1) is in place of ż.
    """
    M, size = loop.matrix, loop.dimension
    unit = Matrix.identity(plant.m)
    b = Matrix.column([*[0] * (model.degree - 1), 1])
    into = kronecker(unit, b) * -1
    after = size - plant.n - into.nrows
    N = vstack([Matrix.zeros(plant.n, plant.m), into, Matrix.zeros(after, plant.m)])
    S = kronecker(unit, generator(signal))
    first = Matrix.identity(signal.degree).take(rows=[0])
    drive = N @ kronecker(unit, first)
    # In columns below each other: (S' ⊗ I − I ⊗ M) Π = NΓ.
    left = kronecker(S.T, Matrix.identity(size)) - kronecker(Matrix.identity(S.nrows), M)
    right = vstack([drive.take(cols=[k]) for k in range(drive.ncols)])
    solution = solve(left, right)
    if solution is None:
        return None
    columns = [solution.take(rows=range(k * size, (k + 1) * size)) for k in range(S.nrows)]
    reached = hstack(columns).take(rows=range(plant.n))
    return plant.output_matrix() @ reached - kronecker(unit, first)


def _plants() -> Iterator[Instance]:
    """Plants with scalar outputs, and no zero at a mode of the signals, in both time domains."""
    for time, signals in SIGNALS.items():
        name, plant = two_tanks(time)
        yield f"{name}, {time} time", plant
        for name, plant in drawn_plants(2, states=3, channels=2, time=time, first=31):
            scalar = all(plant.q(i) == 1 for i in range(plant.m))
            if scalar and all(
                joint_controllability(with_internal_model(plant, signal)).controllable
                for signal in signals.values()
            ):
                yield f"{name}, {time} time", plant


def tracked(note: Notebook) -> None:
    """With a model of the signals at every agent, a distributed controller tracks them exactly."""
    for plant in note.each(_plants()):
        time = plant.time
        signals = SIGNALS[time]
        radius = "1/2" if is_discrete(time) else None
        rate = None if is_discrete(time) else 1
        for what, model in signals.items():
            system = with_internal_model(plant, model)
            joint = joint_controllability(system), joint_observability(system)
            both = all(answer.controllable for answer in joint)
            note.check(f"{what}: jointly controllable and observable", both)
            design = design_extended(system, rate=rate, radius=radius, aims=THEOREM)
            loop = design.loop.closed
            error = lasting_error(plant, loop, model, model)
            note.counts(not model.divides(characteristic_polynomial(plant.A)))
            note.check(f"{what}: the error tends to 0", error is not None and error.is_zero())
            note.check(f"{what}: the loop is stable", "stability" in design.certificates)
            note.certify(*joint, *design.certificates.values())
            for other, signal in signals.items():
                if signal.divides(model):
                    continue
                missed = lasting_error(plant, loop, model, signal)
                wrong = missed is not None and not missed.is_zero()
                if what == "steps" and other == "ramps":
                    note.refute("one-integrator", wrong)
                if "sinusoids" in what and "sinusoids" in other:
                    note.refute("any-frequency", wrong)


def _errors_at_rest(plant: MultiChannelSystem, loop: ClosedLoop, known: Matrix) -> Iterator[Matrix]:
    """The x_i − x at rest under u_i = F_i x_i + r_i, where agent i adds known[i, j] B_j r_j.

    A column for every entry of (r_1, …, r_m).
    """
    added = hstack([plant.B(j) for j in range(plant.m)])
    parts = [loop.pick("x").T @ added]
    for i in range(plant.m):
        seen = [plant.B(j) * known[i, j] for j in range(plant.m)]
        parts.append(loop.pick("x_", i).T @ hstack(seen))
    drive = sum(parts[1:], parts[0])
    rest = solve(loop.matrix, drive * -1)
    if rest is None:
        raise ValueError("the loop has the eigenvalue 0")
    for i in range(plant.m):
        yield (loop.pick("x_", i) - loop.pick("x")) @ rest


def added_references(note: Notebook) -> None:
    """With u_i = F_i x_i + r_i, and every agent adding its own B_i r_i, estimates are wrong."""
    for name, plant in small():
        note.on(name, plant)
        loop, m = designed(name).loop.closed, plant.m
        note.counts(m > 1)
        own, all_ = Matrix.identity(m), Matrix.from_integers([[1] * m] * m)
        wrong = vstack(list(_errors_at_rest(plant, loop, own)))
        every = [wrong.take(cols=[k]) for k in range(wrong.ncols)]
        note.check("every reference makes estimates wrong", all(not e.is_zero() for e in every))
        note.check(
            "only if every agent knew all references, they would be right",
            all(e.is_zero() for e in _errors_at_rest(plant, loop, all_)),
        )
        note.refute("substitution", any(not e.is_zero() for e in every))


TRACKING: dict[str, Procedure] = {
    "signals": tracked,
    "added-references": added_references,
}
