"""Gains with which single channels control and observe.

`single_channel_gains` decides whether decentralized gains F exist with which (A_F, B_q) is
controllable and (C_q, A_F) observable for one channel q, or for all with the same F.  If some gains
do, then all outside of a proper algebraic set do (Corfmat and Morse 1976).  So uniform residues
modulo a prime show which answer to prove:

- yes: small gains are drawn until ranks modulo a prime accept them.  A rank over Q is at least the
  rank modulo a prime, so accepted gains are proved; O(n³) word operations for each channel.
- no: a shrunk subspace that contains q in its T, or a zero transfer, is the obstruction.

`error_gains` is Proposition 1 of the paper: gains with which every agent alone controls and
observes the estimation errors, decided on the error system.  `reaching_gains` is the bare search,
for callers with draws and limits of their own, such as `error_gain_draws`; that it yields nothing
proves nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from random import Random
from typing import Any, Literal

from mcexact.analysis.structure import suspected_edges, zero_transfer
from mcexact.analysis.subspaces import decide, evidence
from mcexact.answer.structure import (
    GainsWitness,
    SingleChannelGains,
    StuckWitness,
    UnreachedWitness,
)
from mcexact.derived.constructions import checked_gains, closed_by, dual, error_system, full_output
from mcexact.derived.modular import (
    ModularSystem,
    closed_loop,
    drawn_gains,
    generator,
    residue_systems,
)
from mcexact.errors import InputError, InternalError, UsageError, one_of, shown_value
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import solve_nonsingular
from mcexact.exact.matrix import Matrix, block_diagonal, hstack
from mcexact.exact.modular import ModularMatrix, residues
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph

# The search by drawn gains.

Draw = Callable[[int, Random], tuple[Matrix, ...]]
"""A function that makes the gains F_i of a trial from its number and a source of choices."""


@dataclass(frozen=True)
class ReachingGains:
    """Gains F_i with which every channel of a set controls and observes the system.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i×q_i.
    matrix : Matrix
        A_F = A + Σ B_i F_i C_i, cyclic: its minimal polynomial has degree n.
    controllability_indices : tuple of int
        The index of (A_F, B_q) for each channel q of the set.
    observability_indices : tuple of int
        The index of (C_q, A_F).
    """

    gains: tuple[Matrix, ...]
    matrix: Matrix
    controllability_indices: tuple[int, ...]
    observability_indices: tuple[int, ...]

    @property
    def largest(self) -> int:
        """The largest absolute numerator or denominator in the gains."""
        entries = [entry for F in self.gains for row in F.rows() for entry in row]
        return max((max(abs(e.numerator), e.denominator) for e in entries), default=0)


def reaching_gains(
    system: MultiChannelSystem,
    channels: Sequence[int],
    draw: Draw,
    *,
    index: int | None = None,
    attempts: int = 200,
) -> Iterator[ReachingGains]:
    """Draw gains, and yield those with which every named channel controls and observes the system.

    Parameters
    ----------
    system : MultiChannelSystem
    channels : sequence of int
        The channels q, which must all control and observe the system with the same gains.
    draw : callable
        The function that makes the gains of a trial.
    index : int, optional
        The largest accepted controllability index.
    attempts : int
        The number of draws.

    Notes
    -----
    A_F is also cyclic: some drawn vector generates the whole space.  Each test is a rank modulo
    a word-size prime, O(n³) word operations for each channel.
    """
    rng = generator(system, "reaching_gains")
    modular = next(iter(residue_systems(system, rng)))
    B, C = system.input_matrix(), system.output_matrix()
    bound = system.n if index is None else min(index, system.n)
    for trial in range(attempts):
        gains = draw(trial, rng)
        if any(F.denominator % modular.modulus == 0 for F in gains):
            continue
        F = block_diagonal(gains)
        M = modular.A + modular.B @ residues(F, modular.modulus) @ modular.C
        indices = _indices(modular, M, channels, bound)
        if indices is not None and _is_cyclic(M, rng):
            yield ReachingGains(gains, system.A + B @ F @ C, *indices)


def _indices(
    modular: ModularSystem, M: ModularMatrix, channels: Sequence[int], bound: int
) -> tuple[tuple[int, ...], tuple[int, ...]] | None:
    """Controllability and observability indices modulo ℓ, or None if one does not exist."""
    controllable, observable = [], []
    for q in channels:
        controllability_index = reach_index(M, modular.B.take(cols=list(modular.inputs[q])), bound)
        if controllability_index is None:
            return None
        observability_index = reach_index(
            M.T, modular.C.take(rows=list(modular.outputs[q])).T, M.nrows
        )
        if observability_index is None:
            return None
        controllable.append(controllability_index)
        observable.append(observability_index)
    return tuple(controllable), tuple(observable)


def reach_index(M: ModularMatrix, B: ModularMatrix, bound: int) -> int | None:
    """The least ν ≤ bound with rank [B, MB, …, M^{ν−1}B] = n modulo ℓ, at least 1, or None.

    Parameters
    ----------
    M : ModularMatrix, n × n
    B : ModularMatrix, n × p
    bound : int
        The largest ν to try; n or more decides whether the pair is controllable modulo ℓ.

    Examples
    --------
    >>> M = ModularMatrix.from_rows([[0, 0], [1, 0]], 7)
    >>> b = ModularMatrix.from_rows([[1], [0]], 7)
    >>> reach_index(M, b, 2), reach_index(M, b, 1), reach_index(M.T, b, 2)
    (2, None, None)
    """
    n, rows = M.nrows, []
    if n == 0:
        return 1
    block = B
    for index in range(1, bound + 1):
        rows += [list(row) for row in block.T.rows()]
        if len(rows) >= n and ModularMatrix.from_rows(rows, M.modulus, ncols=n).rank() == n:
            return index
        block = M @ block
    return None


def _is_cyclic(M: ModularMatrix, rng: Random) -> bool:
    """Whether a drawn vector generates the whole space modulo ℓ."""
    n, ell = M.nrows, M.modulus
    vector = ModularMatrix.from_rows([[rng.randrange(ell)] for _ in range(n)], ell, ncols=1)
    return n == 0 or reach_index(M, vector, n) is not None


def error_gain_draws(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    feedback: Sequence[Matrix],
    center: Fraction = Fraction(0),
) -> Draw:
    """Draw small gains [K_i, H_ij …] for the error system, in four shapes by turns.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant, n states.
    graph : NeighborGraph
    feedback : sequence of Matrix
        F_i, p_i×n.
    center : Fraction
        An approximate location for the eigenvalues of the error matrix: the mean of the spectrum
        that a channel controller has to assign.

    Notes
    -----
    With H_ij = −B_jF_j − S the block E_ij of the error matrix is S, and E_ii = A + K_iC_i − Σ E_ij.
    S is a signed permutation or sparse, and for one j the shift −c I is added, c an integer near
    ``center``: then E_ii is near c I, and the channel controller has to move the eigenvalues
    little.  On the paper's example with the spectrum −1, …, −11 this brings the largest gain from
    10¹⁷ to below 10³.  Dense draws of growing range come last.
    """
    n = system.n
    coupling = [system.B(j) @ feedback[j] for j in range(system.m)]
    unit = Matrix.identity(n)

    def block_of(trial: int, rng: Random) -> Matrix:
        if trial % 2:
            return _signed_permutation(rng, n)
        if trial % 8 == 6:
            return drawn_integers(rng, n, n, 1 + trial // 80, 0.8)
        return drawn_integers(rng, n, n, 1, 0.3)

    def draw(trial: int, rng: Random) -> tuple[Matrix, ...]:
        shift = unit * (round(center) + (0, 1, -1, 0)[trial // 2 % 4])
        gains = []
        for i in range(system.m):
            others = [j for j in graph.neighborhood(i) if j != i]
            chosen = rng.choice(others) if others else i
            blocks = [drawn_integers(rng, n, system.q(i), 2, 0.4)]
            for j in others:
                S = block_of(trial, rng) - (shift if j == chosen else Matrix.zeros(n, n))
                blocks.append(-coupling[j] - S)
            gains.append(hstack(blocks, nrows=n))
        return tuple(gains)

    return draw


def drawn_integers(rng: Random, nrows: int, ncols: int, bound: int, density: float) -> Matrix:
    """Draw a matrix of integers in −bound … bound, most of them 0 where the density is low.

    Parameters
    ----------
    rng : Random
    nrows, ncols : int
    bound : int
    density : float
        From 0 to 1: the probability that an entry is drawn; others are 0.
    """

    def entry() -> int:
        return rng.randint(-bound, bound) if rng.random() < density else 0

    return Matrix.from_integers(
        [[entry() for _ in range(ncols)] for _ in range(nrows)], ncols=ncols
    )


def _signed_permutation(rng: Random, n: int) -> Matrix:
    """A permutation matrix with signs."""
    places = list(range(n))
    rng.shuffle(places)
    rows = [[0] * n for _ in range(n)]
    for i, j in enumerate(places):
        rows[i][j] = rng.choice((1, -1))
    return Matrix.from_integers(rows, ncols=n)


# Existence, with gains or an obstruction as proof.

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
    >>> answer = single_channel_gains(ring)
    >>> answer.indices
    ((2, 2), (2, 2))
    >>> apart = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    >>> single_channel_gains(apart, "1", want="controllable").exists
    False
    """
    InputError.require(system, MultiChannelSystem, "system")
    one_of(want, tuple(SIDES), "want")
    if index is not None and type(index) is not int:
        raise UsageError(f"expected an integer, found {shown_value(index)}", where="index")
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
            obstruction = _obstruction(system, q, side, rng)
            if obstruction is not None:
                return SingleChannelGains(
                    system,
                    channels=system.named(channels),
                    wanted=want,
                    exists=False,
                    cyclic=False,
                    indices=None,
                    evidence=obstruction,
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
    """An obstruction to gains with which channel q controls (or observes), if there is one."""
    target = system if side == "controllable" else dual(system)
    name = system.names[q]
    for obstruction in decide(full_output(target, q), rng).obstructions:
        return StuckWitness(
            name, side, obstruction.polynomial, evidence(target.names, obstruction.subspace)
        )
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
    drawn = 0 if draw is None else 400
    for trial in range(10**6):
        gains = draw(trial, rng) if draw and trial < drawn else grown(trial - drawn, rng)
        if any(F.denominator % modular.modulus == 0 for F in gains):
            continue
        answer = _served(question, modular, gains, rng)
        if answer is not None:
            return answer
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
        of_channel = []
        for side in SIDES[question.wanted]:
            control = side == "controllable"
            limited = control and question.index is not None
            bound = min(question.index or 0, system.n) if limited else system.n
            nu = _index(closed if control else closed.T, _part(modular, q, side), bound)
            if nu is None:
                return None
            of_channel.append(nu)
        indices.append(tuple(of_channel))
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


# Proposition 1: the error system.


@dataclass(frozen=True)
class ErrorGains:
    """The answer whether some K_i, H_ij make every agent control and observe the error system.

    Attributes
    ----------
    answer : SingleChannelGains
        The answer for the error system, whose matrix the gains make cyclic.
    """

    answer: SingleChannelGains

    @property
    def exists(self) -> bool:
        """Whether such gains exist."""
        return self.answer.exists

    @property
    def error(self) -> MultiChannelSystem:
        """The open-loop error system, nm states."""
        return self.answer.about

    @property
    def indices(self) -> tuple[tuple[int, ...], ...] | None:
        """The controllability and observability indices for each agent."""
        return self.answer.indices

    @property
    def gains(self) -> tuple[tuple[Matrix, ...], ...] | None:
        """The gains of each agent i: K_i, n × q_i, then H_ij, n × n, for j ∈ N_i∖{i}, in order."""
        plant, matrices = self.error.plant, self.answer.gains
        if matrices is None:
            return None
        return tuple(_split(gain, plant.q(i), plant.n) for i, gain in enumerate(matrices))


def error_gains(
    system: MultiChannelSystem,
    feedback: Sequence[Any],
    graph: NeighborGraph | Mapping[str, Sequence[str]] | None = None,
) -> ErrorGains:
    """Decide for given F_i whether the gains K_i, H_ij of Proposition 1 exist.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant, m channels, n states.
    feedback : sequence of m matrices
        F_i, p_i × n.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If a gain has the wrong shape.

    Notes
    -----
    Paper, Proposition 1: for a jointly observable plant and a strongly connected graph they exist,
    with controllability index m.  Strong connectivity is sufficient, not necessary: the terms B_j
    F_j (e_i − e_j) couple the agents through the plant, so the question is decided on the error
    system itself, and the answer no has an obstruction.  Exact.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> alone = MultiChannelSystem([[0]], [[[1]]] * 2, [[[1]]] * 2, neighbors={"1": [], "2": []})
    >>> error_gains(alone, [[[-1]], [[-1]]]).indices
    ((2, 2), (2, 2))
    >>> error_gains(alone, [[[0]], [[0]]]).exists
    False
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    exact = checked_gains(system, feedback, [system.n] * system.m)
    error = error_system(system, exact)
    draw = error_gain_draws(system, graph, exact, Fraction(0))
    answer = single_channel_gains(error, cyclic=True, index=system.m, draw=draw)
    return ErrorGains(answer)


def _split(gain: Matrix, q: int, n: int) -> tuple[Matrix, ...]:
    """K_i and the H_ij, side by side in one gain."""
    starts = range(q, gain.ncols, n) if n else range(0)
    blocks = [gain.take(cols=range(start, start + n)) for start in starts]
    return (gain.take(cols=range(q)), *blocks)
