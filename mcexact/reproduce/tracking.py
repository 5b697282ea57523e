"""Section III: signals that can be tracked, and references that are added to the control."""

from __future__ import annotations

from collections.abc import Iterator

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.exact.linear_algebra import solve
from mcexact.exact.matrix import Matrix, block, hstack, kronecker, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import is_discrete
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import Instance, drawn_plants
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import designed, small
from mcexact.reproduce.plants import two_tanks
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.optimum.figures import THEOREM

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
    found = solve(left, right)
    if found is None:
        return None
    columns = [found.take(rows=range(k * size, (k + 1) * size)) for k in range(S.nrows)]
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
            made = with_internal_model(plant, model)
            joint = joint_controllability(made), joint_observability(made)
            both = all(found.controllable for found in joint)
            note.check(f"{what}: jointly controllable and observable", both)
            design = design_extended(made, rate=rate, radius=radius, aims=THEOREM)
            loop = design.loop.closed
            error = lasting_error(plant, loop, model, model)
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
        own, all_ = Matrix.identity(m), Matrix.from_integers([[1] * m] * m)
        wrong = vstack(list(_errors_at_rest(plant, loop, own)))
        every = [wrong.take(cols=[k]) for k in range(wrong.ncols)]
        note.check("every reference makes estimates wrong", all(not e.is_zero() for e in every))
        note.check(
            "only if every agent knew all references, they would be right",
            all(e.is_zero() for e in _errors_at_rest(plant, loop, all_)),
        )
        note.refute("substitution", any(not e.is_zero() for e in every))


PROCEDURES: dict[str, Procedure] = {
    "signals": tracked,
    "added-references": added_references,
}
