"""Sections II-B, II-D and IV-E: almost all gains serve, and complementary subsystems."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.analysis.controllability import (
    controllability_indices,
    exceptional_gains,
    joint_controllability,
)
from mcexact.analysis.fixed_modes import completeness
from mcexact.derived.constructions import closed_by, error_system, extended_system
from mcexact.exact.matrix import Matrix, hstack
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import PAPER, Numbers, plants, three_channels
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.observer import without_arcs, zeros

DRAWN = 8
"""How many drawn gains are tried for each system."""


def through(A: Matrix, B: Matrix) -> MultiChannelSystem:
    """The pair (A, B) as a system that nothing measures."""
    return MultiChannelSystem(A, [B], [Matrix.zeros(0, A.nrows)])


def serve(made: MultiChannelSystem, gains: Sequence[Matrix]) -> bool:
    """Whether the loop is controllable and observable through every channel."""
    loop = closed_by(made, gains)
    pairs = [(loop, made.B(q)) for q in range(made.m)]
    pairs += [(loop.T, made.C(q).T) for q in range(made.m)]
    return all(joint_controllability(through(*pair)).controllable for pair in pairs)


def _on_a_line(
    note: Notebook,
    made: MultiChannelSystem,
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
    M = closed_by(made, start)
    D = closed_by(made, along) - made.A
    for q in range(made.m):
        port = made.C(q).T if dual else made.B(q)
        first, direction = (M.T, D.T) if dual else (M, D)
        found = exceptional_gains(direction, first + direction, port)
        failing = found.controllability_set if index is None else found.index_set
        if index is not None:
            note.check("drawn gains have index m", found.index == index)
        what = "observable" if dual else "controllable"
        said = f"on a line of gains, finitely many are not {what} through channel {q + 1}"
        note.check(said, not failing.polynomial.is_zero())
        if q == 0:
            note.certify(failing)


def error_gains(note: Notebook) -> None:
    """The gains of (7), of Lemma 4 for given K_i, and those that make (16) observable."""
    numbers = Numbers(23, largest=9)
    for plant in note.each(plants(1)):
        made = error_system(plant, zeros(plant))
        drawn = [numbers.gains(made) for _ in range(DRAWN)]
        note.check("all drawn gains serve every channel", all(serve(made, G) for G in drawn))
        note.refute("few", all(serve(made, G) for G in drawn))
        none = [G * 0 for G in drawn[0]]
        note.refute("all", not serve(made, none))
        _on_a_line(note, made, drawn[0], drawn[1])
        _on_a_line(note, made, drawn[0], drawn[1], dual=True)
    for plant in note.each(plants(1)):
        made = error_system(plant, numbers.feedbacks(plant))
        parts = [_apart(G, plant.q(i)) for i, G in enumerate(numbers.gains(made))]
        K, H = [K for K, _ in parts], [H for _, H in parts]
        start = [k + h for k, h in zip(K, H, strict=True)]
        _on_a_line(note, made, start, H, index=plant.m)
        _on_a_line(note, made, start, numbers.gains(made), dual=True)
        note.check("some gains do both", serve(made, start))
        if note.here == PAPER:
            reach = controllability_indices(through(closed_by(made, K), made.B(0)))
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
        made = extended_system(plant, [1] * plant.m)
        drawn = [numbers.gains(made) for _ in range(DRAWN)]
        note.check("all drawn gains serve every channel", all(serve(made, G) for G in drawn))
        note.refute("few", all(serve(made, G) for G in drawn))
        note.refute("all", not serve(made, [G * 0 for G in drawn[0]]))
        _on_a_line(note, made, drawn[0], drawn[1])
        _on_a_line(note, made, drawn[0], drawn[1], dual=True)


def complementary(note: Notebook) -> None:
    """All complementary subsystems of (16) are complete."""
    numbers = Numbers(25)
    for plant in note.each(plants(8)):
        found = completeness(error_system(plant, numbers.feedbacks(plant)))
        note.check("(16) is complete for all subsets of channels", found.complete)
        note.certify(found)
    plant = three_channels()
    note.on(f"{PAPER}, without arcs", without_arcs(plant))
    lost = completeness(error_system(without_arcs(plant), numbers.feedbacks(plant)))
    note.refute("any-graph", not lost.complete)
    note.certify(lost)
    note.on(PAPER, plant)
    own = completeness(plant)
    note.refute("plant", not own.complete)
    note.certify(own)


PROCEDURES: dict[str, Procedure] = {
    "almost-any": error_gains,
    "complementary": complementary,
    "almost-any-extended": extended_gains,
}
