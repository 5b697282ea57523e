"""Decentralized gains with which single channels control and observe a system."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from random import Random
from typing import Literal

from mcexact.analysis.engine import decide, evidence, suspected_edges, zero_transfer
from mcexact.analysis.fixed_modes.gains import Draw, drawn_integers, reach_index
from mcexact.answer.single_channel_gains import (
    GainsWitness,
    SingleChannelGains,
    StuckWitness,
    UnreachedWitness,
)
from mcexact.derived.constructions import closed_by, dual, full_output
from mcexact.derived.modular import (
    ModularSystem,
    closed_loop,
    drawn_gains,
    generator,
    residue_systems,
)
from mcexact.errors import InputError, InternalError, UsageError, one_of, told
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import solve_nonsingular
from mcexact.exact.matrix import Matrix, hstack
from mcexact.exact.modular import ModularMatrix, residues
from mcexact.model.system import MultiChannelSystem

SIDES = {
    "controllable": ("controllable",),
    "observable": ("observable",),
    "both": ("controllable", "observable"),
}
Want = Literal["controllable", "observable", "both"]
Indices = tuple[int, ...]


@dataclass(frozen=True)
class _Question:
    """The question: the channels, the required properties, and whether A_F has to be cyclic."""

    system: MultiChannelSystem
    channels: tuple[int, ...]
    wanted: str
    cyclic: bool
    index: int | None = None


def single_channel_gains(
    system: MultiChannelSystem,
    channel: str | None = None,
    *,
    want: Want = "both",
    cyclic: bool = False,
    index: int | None = None,
    draw: Draw | None = None,
) -> SingleChannelGains:
    """Find F with (A_F, B_q) controllable and (C_q, A_F) observable, or prove that none exists.

    Parameters
    ----------
    system : MultiChannelSystem
    channel : str, optional
        The name of q; by default all channels, with the same gains.
    want : {"both", "controllable", "observable"}
    cyclic : bool
        Whether A_F also has to be cyclic, with a minimal polynomial of degree n.
    index : int, optional
        A limit on the controllability index, used if some gains meet it for all channels.
    draw : callable, optional
        A function that makes gains from the number of a trial and a source of choices; by default
        small integers that grow.

    Raises
    ------
    UsageError
        If there is no such channel, or the property is unknown.

    Notes
    -----
    Exact.  Some F makes (A_F, B_q) controllable iff the system with C_q replaced by the identity
    has no fixed mode and every i with C_i ≠ 0 is reachable from q in the transfer graph; then all F
    outside a proper algebraic set do (Corfmat and Morse 1976; observability is the same of the
    dual).  So uniform residues decide which certificate is searched for: small gains that reach
    rank n modulo a prime, or a shrunk subspace with q ∈ T, or a zero transfer.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> I = [[1, 0], [0, 1]]
    >>> ring = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[0, 1]], [[1, 0]]])
    >>> found = single_channel_gains(ring)
    >>> found.indices
    ((2, 2), (2, 2))
    >>> apart = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    >>> single_channel_gains(apart, "1", want="controllable").exists
    False
    """
    InputError.require(system, MultiChannelSystem, "system")
    one_of(want, tuple(SIDES), "want")
    if index is not None and type(index) is not int:
        raise UsageError(f"expected an integer, found {told(index)}", where="index")
    if cyclic and want != "both":
        raise UsageError("a cyclic matrix is available only with both properties")
    channels = tuple(range(system.m)) if channel is None else tuple(system.indices([channel]))
    question = _Question(system, channels, want, cyclic, index)
    rng = generator(system, "single_channel_gains")
    for modular in residue_systems(system, rng, bits=61):
        closed = closed_loop(modular, drawn_gains(modular, rng))
        failing = list(_failing(question, modular, closed))
        if not failing:
            return _with_gains(_attainable(question, modular, closed), modular, draw, rng)
        for q, side in failing:
            found = _obstruction(system, q, side, rng)
            if found is not None:
                return SingleChannelGains(
                    system,
                    channels=system.named(channels),
                    wanted=want,
                    exists=False,
                    cyclic=False,
                    indices=None,
                    evidence=found,
                )
    raise InternalError("the stream of primes is endless")


def _part(modular: ModularSystem, q: int, side: str) -> ModularMatrix:
    """B_q, or (C_q)', modulo ℓ."""
    if side == "controllable":
        return modular.B.take(cols=list(modular.inputs[q]))
    return modular.C.take(rows=list(modular.outputs[q])).T


def _failing(
    question: _Question, modular: ModularSystem, closed: ModularMatrix
) -> Iterator[tuple[int, str]]:
    """The channels and properties that fail for these gains modulo ℓ."""
    for q in question.channels:
        for side in SIDES[question.wanted]:
            M = closed if side == "controllable" else closed.T
            if M.nrows and reach_index(M, _part(modular, q, side), M.nrows) is None:
                yield q, side


def _obstruction(
    system: MultiChannelSystem, q: int, side: str, rng: Random
) -> StuckWitness | UnreachedWitness | None:
    """Find an obstruction to gains with which channel q controls (or observes), if there is one."""
    target = system if side == "controllable" else dual(system)
    name = system.names[q]
    for found in decide(full_output(target, q), rng).obstructions:
        return StuckWitness(name, side, found.polynomial, evidence(target, found.subspace))
    modular = next(residue_systems(target, rng))
    edges = suspected_edges(modular, rng)
    reached = {q}
    while new := {i for j, i in edges if j in reached} - reached:
        reached |= new
    T, rest = sorted(reached), [i for i in range(target.m) if i not in reached]
    C = target.output_matrix(rest)
    space = controllable_subspace(target.A, target.input_matrix(T), rng)
    if C.is_zero() or not (C @ space.X).is_zero():
        return None
    return UnreachedWitness(name, side, zero_transfer(target, T, space))


def _growing_draws(system: MultiChannelSystem) -> Draw:
    """Make integer gains: zeros first, then sparse signs, then larger and denser ones.

    Parameters
    ----------
    system : MultiChannelSystem
    """

    def draw(trial: int, rng: Random) -> tuple[Matrix, ...]:
        bound = 0 if trial == 0 else 2 ** (trial // 12)
        density = (0.3, 0.6, 1.0)[trial % 3]
        return tuple(
            drawn_integers(rng, system.p(i), system.q(i), bound, density) for i in range(system.m)
        )

    return draw


def _attainable(question: _Question, modular: ModularSystem, closed: ModularMatrix) -> _Question:
    """The question with the index that almost all gains have, as those of A_F modulo ℓ do."""
    if question.index is None or question.wanted == "observable":
        return replace(question, index=None)
    parts = (_part(modular, q, "controllable") for q in question.channels)
    least = [_index(closed, part, closed.nrows) or 0 for part in parts]
    return replace(question, index=max(question.index, *least))


def _with_gains(
    question: _Question, modular: ModularSystem, draw: Draw | None, rng: Random
) -> SingleChannelGains:
    """Try gains until some are accepted; all outside a proper algebraic set are."""
    grown = _growing_draws(question.system)
    given = 0 if draw is None else 400
    for trial in range(10**6):
        gains = draw(trial, rng) if draw and trial < given else grown(trial - given, rng)
        if any(F.denominator % modular.modulus == 0 for F in gains):
            continue
        found = _served(question, modular, gains, rng)
        if found is not None:
            return found
    raise InternalError("gains that exist were not found")


def _served(
    question: _Question,
    modular: ModularSystem,
    gains: Sequence[Matrix],
    rng: Random,
) -> SingleChannelGains | None:
    """Make the answer with these gains, if they are accepted modulo ℓ within the index."""
    system, ell = question.system, modular.modulus
    F = tuple(tuple(map(tuple, residues(G, ell).rows())) for G in gains)
    closed = closed_loop(modular, F)
    indices: list[Indices] = []
    for q in question.channels:
        found = []
        for side in SIDES[question.wanted]:
            control = side == "controllable"
            limited = control and question.index is not None
            bound = min(question.index or 0, system.n) if limited else system.n
            nu = _index(closed if control else closed.T, _part(modular, q, side), bound)
            if nu is None:
                return None
            found.append(nu)
        indices.append(tuple(found))
    spun = _generator(closed, rng) if question.cyclic else None
    if question.cyclic and spun is None:
        return None
    rows = _annihilators(question, gains, indices, ell)
    if rows is None:
        return None
    return SingleChannelGains(
        system,
        channels=system.named(question.channels),
        wanted=question.wanted,
        exists=True,
        cyclic=question.cyclic,
        indices=tuple(indices),
        evidence=GainsWitness(tuple(gains), ell, rows, spun),
    )


def _index(M: ModularMatrix, B: ModularMatrix, bound: int) -> int | None:
    return 0 if M.nrows == 0 else reach_index(M, B, bound)


def _generator(M: ModularMatrix, rng: Random) -> Matrix | None:
    """A column of small integers that generates the whole space modulo ℓ, if there is one."""
    n = M.nrows
    if M.minimal_polynomial().degree < n:
        return None
    for trial in range(10**6):
        b = Matrix.column([rng.randint(-1 - trial // 4, 1 + trial // 4) for _ in range(n)])
        if n == 0 or reach_index(M, residues(b, M.modulus), n) is not None:
            return b
    return None


def _annihilators(
    question: _Question, gains: Sequence[Matrix], indices: Sequence[Indices], ell: int
) -> tuple[tuple[Matrix, ...], ...] | None:
    """Rows that annihilate all blocks except the last one of the index, as far as claimed."""
    system = question.system
    A_F = closed_by(system, gains)
    result = []
    for q, numbers in zip(question.channels, indices, strict=True):
        rows = []
        for side, nu in zip(SIDES[question.wanted], numbers, strict=True):
            A, B = (A_F, system.B(q)) if side == "controllable" else (A_F.T, system.C(q).T)
            row = _unreached_row(A, B, nu - 1, ell) if nu else Matrix.zeros(1, system.n)
            if row is None:
                return None
            rows.append(row)
        result.append(tuple(rows))
    return tuple(result)


def _unreached_row(A: Matrix, B: Matrix, blocks: int, ell: int) -> Matrix | None:
    """A row w ≠ 0 with w A^k B = 0 for k < blocks, or None if there is none modulo ℓ.

    Parameters
    ----------
    A : Matrix
        n × n, n ≥ 1.
    B : Matrix
        n × p.
    blocks : int
    ell : int
        A prime modulo which independent columns are chosen.
    """
    n = A.nrows
    K, block = [Matrix.zeros(n, 0)], B
    for _ in range(blocks):
        K.append(block)
        block = A @ block
    whole = hstack(K, nrows=n)
    if not whole.ncols:
        return Matrix.from_integers([[int(j == 0) for j in range(n)]])
    reduced = residues(whole, ell)
    columns = list(reduced.rref()[1])
    rows = list(reduced.take(cols=columns).T.rref()[1]) if columns else []
    free = next((i for i in range(n) if i not in rows), None)
    if free is None:
        return None
    chosen = whole.take(cols=columns)
    part = solve_nonsingular(chosen.take(rows=rows).T, -chosen.take(rows=[free]).T)
    if part is None:
        return None
    entries = [0] * n
    for k, i in enumerate(rows):
        entries[i] = part.numerators[k][0]
    entries[free] = part.denominator
    w = Matrix.from_integers([entries], part.denominator)
    return w if (w @ whole).is_zero() else None
