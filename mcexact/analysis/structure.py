"""Transfer graph, complementary subsystems, and set-points.

`transfer_graph` decides for each pair of channels whether u_j affects y_i.  An edge is proved by a
Markov parameter C_i A^k B_j that is not 0 modulo a prime; the absence of one by an invariant
subspace that contains im B_j and lies in ker C_i.  Large sparse systems are first searched for
paths in the structure of their matrices (`sparse`): if every path carries an edge, no subspace is
needed.  One value of the transfer matrix modulo a prime shows which edges to look for, so the graph
takes O(n³) word operations, and O(n² p) for each power.

`complementary_subsystem` brings the pencil of a set of channels to a block form, from which its
normal rank, its invariant zeros and the remnant polynomial follow.

`setpoint_solvability` decides whether all outputs can be held at any set-points (section III of
the paper): the rank of [A, B; C, 0], in discrete time with A − I.  A rank modulo a prime proves
yes, an annihilating matrix no.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import reduce
from random import Random
from typing import TYPE_CHECKING, overload

from mcexact.analysis.sparse import (
    edge_powers,
    is_large_and_sparse,
    reachable_pairs,
)
from mcexact.answer.evidence import ZeroTransfer
from mcexact.answer.structure import ComplementarySubsystem, SetpointSolvability, TransferGraph
from mcexact.derived.feedthrough import own_outputs, without_feedthrough
from mcexact.derived.modular import (
    SHORT,
    ModularSystem,
    generator,
    residue_systems,
    short_modulus,
)
from mcexact.errors import InternalError, LimitReached, UsageError
from mcexact.exact.krylov import InvariantSubspace, controllable_subspace
from mcexact.exact.linear_algebra import (
    PolynomialMatrix,
    characteristic_polynomial,
    companions,
    invariant_form,
    inverse,
    left_nullspace,
    nullspace,
    nullspace_and_pivots,
    row_echelon,
    solve,
)
from mcexact.exact.matrix import Matrix, block, hstack, vstack
from mcexact.exact.modular import ModularMatrix, primes, residues, sparse_rank
from mcexact.exact.modular import hstack as modular_hstack
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import steady_point
from mcexact.exact.tables import LARGEST_WRITTEN_OUT
from mcexact.model.graph import strong_components
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

if TYPE_CHECKING:
    from mcexact.analysis.parameters.hypersurfaces import ParametricTransferGraph
    from mcexact.answer.parameters import ParametricRank

# Edges of the transfer graph modulo a prime.

Edge = tuple[int, int]
# Modulo 7 every seventh of the edges of one input and one output is missed at each power.
_LEAST_SHORT = 19
_MORE_POWERS = 24


def _channel_of(ranges: Sequence[range]) -> list[int]:
    return [i for i, positions in enumerate(ranges) for _ in positions]


def _nonzero_blocks(modular: ModularSystem, G: ModularMatrix) -> set[Edge]:
    """The pairs (j, i) with a nonzero block (i, j) of a Σ q_i × Σ p_i matrix."""
    sources, targets = _channel_of(modular.inputs), _channel_of(modular.outputs)
    pairs: set[Edge] = set()
    for i, row in zip(targets, G.rows(), strict=True):
        pairs.update((j, i) for j, value in zip(sources, row, strict=True) if value)
    return pairs


def suspected_edges(modular: ModularSystem, rng: random.Random) -> set[Edge]:
    """The pairs (j, i) with C_i (zI − A)⁻¹ B_j ≠ 0 modulo ℓ at a drawn z.

    Parameters
    ----------
    modular : ModularSystem
        The system modulo a prime ℓ.
    rng : random.Random
        Draws z again until zI − A is invertible modulo ℓ.

    Notes
    -----
    Each pair is an edge of the transfer graph over Q.  An edge is missed if its transfer matrix
    vanishes modulo ℓ at z, so a pair that is missing proves nothing.
    """
    n, ell = modular.system.n, modular.modulus
    if n == 0 or not modular.B.ncols or not modular.C.nrows:
        return set()
    while True:
        resolvent = ModularMatrix.scalar(n, rng.randrange(ell), ell) - modular.A
        inverse = resolvent.inverse()
        if inverse is not None:
            return _nonzero_blocks(modular, (modular.C @ inverse) @ modular.B)


def witnessed_powers(
    modular: ModularSystem, suspected: set[Edge], most: int | None = None
) -> dict[Edge, int]:
    """The least k with C_i A^k B_j ≠ 0 modulo ℓ, for every pair (j, i) that has one below n.

    Parameters
    ----------
    modular : ModularSystem
    suspected : set of (int, int)
        The search ends as soon as each of these pairs has its k; the k of other pairs are kept.
    most : int, optional
        How many powers are tried, if not n.

    Notes
    -----
    The rational C_i A^k B_j is then not 0 either, so k proves the edge j → i.
    """
    powers: dict[Edge, int] = {}
    if not suspected:
        return powers
    AkB = modular.B
    n = modular.system.n
    for k in range(n if most is None else min(n, most)):
        if k:
            AkB = modular.A @ AkB
        for edge in _nonzero_blocks(modular, modular.C @ AkB):
            powers.setdefault(edge, k)
        if suspected <= powers.keys():
            break
    return powers


def short_powers(modular: ModularSystem, powers: dict[Edge, int]) -> tuple[int, dict[Edge, int]]:
    """Find powers for the same edges modulo a short prime, which are quick to check.

    Parameters
    ----------
    modular : ModularSystem
    powers : dict
        Those of `witnessed_powers` that are to be proved.

    Returns
    -------
    modulus : int
        A short prime; that of ``modular`` if some edge is not seen in about as many powers.
    powers : dict
        Of the same edges, and of others that are seen.
    """
    system, most = modular.system, max(powers.values(), default=0) + _MORE_POWERS
    for ell in SHORT:
        if ell >= _LEAST_SHORT and system.denominator % ell:
            short = witnessed_powers(ModularSystem(system, ell), set(powers), most)
            if powers.keys() <= short.keys():
                return ell, short
    return modular.modulus, powers


def zero_transfer(
    system: MultiChannelSystem, sources: Sequence[int], space: InvariantSubspace
) -> ZeroTransfer:
    """Make the evidence of an invariant subspace that contains im B_j for some channels."""
    return ZeroTransfer(channels_from=system.named(sources), X=space.X, pivots=space.pivots)


# The transfer graph.


@overload
def transfer_graph(system: MultiChannelSystem) -> TransferGraph: ...


@overload
def transfer_graph(system: ParametricSystem) -> ParametricTransferGraph: ...


def transfer_graph(
    system: MultiChannelSystem | ParametricSystem,
) -> TransferGraph | ParametricTransferGraph:
    """Decide for every pair of channels whether C_i (xI − A)⁻¹ B_j ≠ 0.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        For a plant with one parameter the answer says at which values which edges vanish
        (`ParametricTransferGraph`).

    Notes
    -----
    Exact.  For an edge the certificate has a k < n with C_i A^k B_j ≠ 0 modulo a prime.  Pairs that
    no path connects in the structure of the matrices are no edges.  For all others, and for small
    systems for all pairs, it has invariant subspaces that contain im B_j and lie in ker C_i, one
    for all j that reach the same channels.  One value of the transfer matrix modulo the prime
    determines the edges to be proved.  O(n³) word operations, and O(n² p) for each power looked at.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> B, C = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    >>> system = MultiChannelSystem([[0, 0], [1, 0]], B, C)
    >>> graph = transfer_graph(system)
    >>> graph.arcs
    (('1', '1'), ('1', '2'), ('2', '2'))
    >>> graph.strongly_connected
    False
    """
    if isinstance(system, ParametricSystem):
        # start-up: few plants need it
        from mcexact.analysis.parameters.hypersurfaces import parametric_transfer_graph

        return parametric_transfer_graph(system)
    system = without_feedthrough(system)
    if is_large_and_sparse(system):
        graph = _by_structure(system)
        if graph is not None:
            return graph
    rng = generator(system, "transfer_graph")
    for modular in residue_systems(system, rng):
        suspected = suspected_edges(modular, rng)
        powers = witnessed_powers(modular, suspected)
        zeros = _zero_transfers(system, set(powers), rng)
        if zeros is not None:
            return _graph_answer(system, *short_powers(modular, powers), zeros)
    raise InternalError("the stream of primes is endless")


def _by_structure(system: MultiChannelSystem) -> TransferGraph | None:
    """The graph by paths, if there is an edge for each pair that a path connects."""
    paths = reachable_pairs(system)
    found = edge_powers(system, lambda edges: bool((edges | ~paths).all()))
    if found is None:
        return None
    ell, powers = found
    edges = [(int(j), int(i)) for j, i in zip(*paths.nonzero(), strict=True)]
    return _graph_answer(system, ell, {edge: int(powers[edge]) for edge in edges}, [])


def _zero_transfers(
    system: MultiChannelSystem, edges: set[Edge], rng: random.Random
) -> list[tuple[tuple[int, ...], InvariantSubspace]] | None:
    """Invariant subspaces that prove that no other pair is an edge; None if one is."""
    m = system.m
    groups: dict[tuple[int, ...], list[int]] = {}
    for j in range(m):
        unreached = tuple(i for i in range(m) if (j, i) not in edges)
        if unreached:
            groups.setdefault(unreached, []).append(j)
    zeros = []
    for unreached, sources in groups.items():
        space = controllable_subspace(system.A, system.input_matrix(sources), rng)
        if not (system.output_matrix(unreached) @ space.X).is_zero():
            return None
        zeros.append((tuple(sources), space))
    return zeros


def _graph_answer(
    system: MultiChannelSystem,
    modulus: int,
    powers: dict[Edge, int],
    zeros: list[tuple[tuple[int, ...], InvariantSubspace]],
) -> TransferGraph:
    edges = sorted(powers)
    names = system.names
    components = tuple(system.named(c) for c in strong_components(system.m, edges))
    return TransferGraph(
        system,
        arcs=tuple((names[j], names[i]) for j, i in edges),
        components=components,
        strongly_connected=len(components) <= 1,
        modulus=modulus,
        powers=tuple(powers[edge] for edge in edges),
        zeros=tuple(zero_transfer(system, sources, space) for sources, space in zeros),
    )


# Complementary subsystems.


@dataclass(frozen=True)
class _Outside:
    """L, c × n, with L = G C + N L A and N L B = 0, N strictly lower triangular.

    The null space of L is the largest subspace V of that of C with A V ⊂ V + im B.
    """

    L: Matrix
    G: Matrix
    N: Matrix


def complementary_subsystem(
    system: MultiChannelSystem, subset: Iterable[str]
) -> ComplementarySubsystem:
    """Analyze the complementary subsystem (C_s, A, B_{m−s}).

    Parameters
    ----------
    system : MultiChannelSystem
    subset : iterable of str
        The set s: names of channels, at least one but not all.

    Raises
    ------
    UsageError
        If there is no channel of that name, or the subset is empty or holds all channels.

    Notes
    -----
    With V the largest (A, im B)-invariant subspace in ker C and R the controllable subspace in it,
    bases adapted to R ⊂ V bring P_s to the block form ::

        [ xI − A_1   B_1     *       *        *   ]
        [    0        0    xI − K    *        *   ]
        [    0        0      0    xI − A_3   B_3  ]
        [    0        0      0      C_3       0   ]

    where the first block has full row rank and the last full column rank for every x, so the Smith
    form of P_s consists of that of xI − K and ones; K is brought to rational canonical form.  The
    certificate has these rational matrices.  Exact.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> A = [[1, 0, 0], [0, 1, 0], [0, 1, 1]]
    >>> B = [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]]
    >>> C = [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]]
    >>> answer = complementary_subsystem(MultiChannelSystem(A, B, C), ["2", "3"])
    >>> answer.complete, str(answer.remnant)
    (False, 'x - 1')
    >>> answer.transfer_zero, [(str(zeros.polynomial), zeros.rank) for zeros in answer.zeros]
    (True, [('x - 1', 2)])
    """
    system = without_feedthrough(system)
    inside = system.indices(subset)
    if not 0 < len(inside) < system.m:
        raise UsageError("expected a nonempty proper subset of the channels")
    rng = generator(system, "complementary_subsystem")
    rest = [i for i in range(system.m) if i not in inside]
    B, C = system.input_matrix(rest), system.output_matrix(inside)
    for modular in residue_systems(system, rng, bits=61):
        outside = _outside(system.A, B, C, modular.modulus)
        decomposition = None if outside is None else _decomposed(system.A, B, outside, rng)
        if outside is None or decomposition is None:
            continue
        parts, polynomials, reachable = decomposition
        evidence = {**parts, "L": outside.L, "G": outside.G, "N": outside.N}
        if _full_ranks(evidence, B, reachable, modular.modulus):
            names = system.named(inside)
            k = system.n + B.ncols - parts["S"].ncols
            return _result(system, names, k, polynomials, reachable, modular.modulus, evidence)
    raise InternalError("the stream of primes is endless")


def _outside(A: Matrix, B: Matrix, C: Matrix, ell: int) -> _Outside | None:
    """L, level by level: the rows of C, then y L A for the y with y L B = 0."""
    n = A.nrows
    if C.denominator % ell == 0:
        return None
    first = list(residues(C.T, ell).rref()[1])
    L = C.take(rows=first)
    G = Matrix.identity(C.nrows).take(rows=first)
    N = Matrix.zeros(L.nrows, L.nrows)
    places = list(residues(L, ell).rref()[1]) if L.nrows else []
    while 0 < L.nrows < n:
        Y = left_nullspace(L @ B) if B.ncols else Matrix.identity(L.nrows)
        YLA = Y @ L @ A
        stacked = vstack([L, YLA], ncols=n)
        if stacked.denominator % ell == 0:
            return None
        chosen = [j - L.nrows for j in residues(stacked.T, ell).rref()[1] if j >= L.nrows]
        if not chosen:
            break
        Y, YLA = Y.take(rows=chosen), YLA.take(rows=chosen)
        # Clear the columns of the earlier pivots, and make the new pivots an identity.
        c = solve(L.take(cols=places).T, YLA.take(cols=places).T)
        if c is None:
            return None
        c = c.T
        new = YLA - c @ L
        if new.denominator % ell == 0:
            return None
        fresh = list(residues(new, ell).rref()[1])
        scale = inverse(new.take(cols=fresh)) if len(fresh) == len(chosen) else None
        if scale is None:
            return None
        N = vstack(
            [
                hstack([N, Matrix.zeros(L.nrows, len(chosen))]),
                hstack([scale @ (Y - c @ N), Matrix.zeros(len(chosen), len(chosen))]),
            ]
        )
        G = vstack([G, -(scale @ c @ G)])
        L = vstack([L, scale @ new])
        places = [*places, *fresh]
    return _Outside(L, G, N)


def _decomposed(
    A: Matrix, B: Matrix, outside: _Outside, rng: Random
) -> tuple[dict[str, Matrix], tuple[Polynomial, ...], int] | None:
    """X, F, A1, S, B1, the invariant polynomials, and the dimension of the controlled part."""
    n, p = A.nrows, B.ncols
    X, pivots = (
        nullspace_and_pivots(outside.L)
        if outside.L.nrows
        else (Matrix.identity(n), tuple(range(n)))
    )
    v = X.ncols
    solution = solve(hstack([X, -B], nrows=n), A @ X)
    if solution is None:
        return None
    inner, F = solution.take(rows=range(v)), solution.take(rows=range(v, v + p))
    S = nullspace(outside.L @ B) if outside.L.nrows else Matrix.identity(p)
    driven = (B @ S).take(rows=pivots)
    space = controllable_subspace(inner, driven, rng)
    Z = (space.annihilator() @ inner).take(cols=space.free)
    T, polynomials = invariant_form(Z, rng)
    units = Matrix.identity(v).take(cols=space.free)
    coordinates = hstack([space.X, units @ T], nrows=v)
    below = units @ T @ companions(polynomials)
    a = space.dimension
    upper = hstack([inner @ space.X, inner @ units @ T - below], nrows=v)
    parts = {
        "X": X @ coordinates,
        "F": F @ coordinates,
        "A1": upper.take(rows=space.pivots),
        "S": S,
        "B1": driven.take(rows=space.pivots),
    }
    return parts, polynomials, a


def _full_ranks(evidence: dict[str, Matrix], B: Matrix, a: int, ell: int) -> bool:
    """Whether every rank that the certificate needs is reached modulo ℓ."""
    if any(M.denominator % ell == 0 for M in evidence.values()):
        return False
    X, L, S = (residues(evidence[name], ell) for name in ("X", "L", "S"))
    LB = L @ residues(B, ell)
    full = X.rank() == X.ncols and L.rank() == L.nrows and S.rank() == S.ncols
    A1, B1 = evidence["A1"].take(cols=range(a)), evidence["B1"]
    reached, block = [residues(B1, ell)], residues(B1, ell)
    for _ in range(a - 1):
        block = residues(A1, ell) @ block
        reached.append(block)
    return (
        full and LB.rank() == B.ncols - S.ncols and (a == 0 or modular_hstack(reached).rank() == a)
    )


def _result(
    system: MultiChannelSystem,
    names: tuple[str, ...],
    k: int,
    polynomials: tuple[Polynomial, ...],
    reachable: int,
    modulus: int,
    evidence: dict[str, Matrix],
) -> ComplementarySubsystem:
    extra = k - system.n
    remnant = product(polynomials[: max(len(polynomials) - extra, 0)])
    return ComplementarySubsystem(
        system,
        subset=names,
        normal_rank=k,
        invariant_polynomials=polynomials,
        remnant=remnant,
        transfer_zero=extra == 0,
        complete=extra > 0 and remnant.degree == 0,
        reachable=reachable,
        modulus=modulus,
        **evidence,
    )


# Set-points.

_POINTS = 8
_MINORS = 3


@overload
def setpoint_solvability(system: MultiChannelSystem) -> SetpointSolvability: ...


@overload
def setpoint_solvability(system: ParametricSystem) -> ParametricRank: ...


def setpoint_solvability(
    system: MultiChannelSystem | ParametricSystem,
) -> SetpointSolvability | ParametricRank:
    """Decide whether linear time-invariant set-point control of all outputs is possible.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        For a plant with one parameter the answer is the rank of [A, B; C, 0] (discrete time: A − I)
        for all values, and where it is less (`ParametricRank`): set-points are possible where it is
        n + Σ q_i.

    Notes
    -----
    Exact; paper, section III, equation (21).  The certificate for yes is a rank modulo a prime,
    that for no a matrix W with W S = 0.  A row (w_1, w_2) of W gives w_2 r = 0 for every
    equilibrium Ax + Bu = 0, r = Cx; w_2 = 0 only if the mode is not controllable.  An invariant
    zero is claimed only if the pencil has full rank somewhere; otherwise the certificate has a
    polynomial row that annihilates the pencil everywhere.  The paper's "no zero of the determinant
    at 0" is this condition unless 0 is an eigenvalue of A.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> plant = MultiChannelSystem([[-1, 0], [0, -2]], [[[1], [0]], [[0], [1]]], [[[1, 1]]] * 2)
    >>> answer = setpoint_solvability(plant)
    >>> answer.solvable, answer.invariant_zero, answer.combinations.numerators
    (False, False, ((-1, 1),))
    >>> wash = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[0, 1]]])
    >>> setpoint_solvability(wash).invariant_zero
    True
    """
    if isinstance(system, ParametricSystem):
        # start-up: few plants need it
        from mcexact.analysis.parameters.ranks import parametric_setpoints

        return parametric_setpoints(system)
    system = own_outputs(without_feedthrough(system))
    n, B, C = system.n, system.input_matrix(), system.output_matrix()
    place, unit, none = steady_point(system.time), Matrix.identity(n), Matrix.zeros
    lower = none(C.nrows, B.ncols)
    S = block([[system.A - unit * place, B], [C, lower]])
    W, pivots = none(0, S.nrows), tuple[int, ...]()
    modulus = _full_rank_by_bands(S) if is_large_and_sparse(system) else None
    if modulus is not None:
        return _solvable(system, S.nrows, modulus)
    rng = generator(system, "setpoint")
    modulus = next(_usable_primes(S, rng))
    if residues(S, modulus).rank() < S.nrows:
        W, pivots = row_echelon(left_nullspace(S))
    rank, point, normal = S.nrows - W.nrows, None, None
    if W.nrows:
        M0 = block([[-system.A, B], [C, lower]])
        M1 = block([[unit, none(n, B.ncols)], [none(C.nrows, n), lower]])
        modulus = next(ell for ell in _usable_primes(S, rng) if residues(S, ell).rank() == rank)
        point = _full_rank_point(M0, M1, modulus, rng)
        normal = None if point is not None else _annihilating_row(system, M0, M1, rng)
    if point is None:
        modulus = short_modulus(S.denominator, lambda ell: residues(S, ell).rank() == rank, modulus)
    else:
        modulus, point = _short_point(S, rank, M0, M1) or (modulus, point)
    zero = None if not W.nrows else point is not None
    return SetpointSolvability(
        system,
        solvable=not W.nrows,
        rank=rank,
        invariant_zero=zero,
        modulus=modulus,
        left=W,
        pivots=pivots,
        point=point,
        normal=normal,
    )


def _solvable(system: MultiChannelSystem, rank: int, modulus: int) -> SetpointSolvability:
    """The answer yes, by the rank modulo a prime."""
    return SetpointSolvability(
        system,
        solvable=True,
        rank=rank,
        invariant_zero=None,
        modulus=modulus,
        left=Matrix.zeros(0, rank),
        pivots=(),
        point=None,
        normal=None,
    )


_MOST_IN_BANDS = 10**9
"""The bytes that an elimination in bands may go through: some seconds."""


def _full_rank_by_bands(S: Matrix) -> int | None:
    """A short prime modulo which a large sparse S = [A B; C 0] has full row rank, or None.

    Raises
    ------
    LimitReached
        None was found, and S is too large for other ways.
    """
    reason = f"[A B; C 0] has no rank {S.nrows} modulo small primes"
    try:
        for ell in SHORT:
            if S.denominator % ell and sparse_rank(S, ell, _MOST_IN_BANDS) == S.nrows:
                return ell
    except LimitReached as limit:
        reason = str(limit)
    if S.nrows * S.ncols > LARGEST_WRITTEN_OUT:
        raise LimitReached(f"{reason}; larger numbers would take all of its zeros")
    return None


def _usable_primes(S: Matrix, rng: random.Random) -> Iterator[int]:
    """Long primes that do not divide the denominator."""
    return (ell for ell in primes(rng.getrandbits(64), bits=61) if S.denominator % ell)


def _short_point(S: Matrix, rank: int, M0: Matrix, M1: Matrix) -> tuple[int, int] | None:
    """A short prime modulo which S keeps its rank, and a place where M0 + x M1 has full row rank.

    None if there is none, or not among the first places.
    """
    for ell in SHORT:
        if S.denominator % ell and residues(S, ell).rank() == rank:
            for x in range(2, min(ell, _POINTS + 2)):
                if residues(M0 + M1 * x, ell).rank() == M0.nrows:
                    return ell, x
    return None


def _full_rank_point(M0: Matrix, M1: Matrix, modulus: int, rng: random.Random) -> int | None:
    """A place where M0 + x M1 has full row rank modulo the prime, or None if a few had not."""
    for _ in range(_POINTS):
        x = rng.randrange(2, 10**6)
        if residues(M0 + M1 * x, modulus).rank() == M0.nrows:
            return x
    return None


def _annihilating_row(
    system: MultiChannelSystem, M0: Matrix, M1: Matrix, rng: random.Random
) -> PolynomialMatrix:
    """A nonzero polynomial row w(x) with w(x) (M0 + x M1) = 0.

    Its degree is about n over the rank of the transfer matrix: where that rank is small the row
    comes from minors, else degree after degree from linear equations.
    """
    for ell in primes(rng.getrandbits(64), bits=61):
        if M0.denominator % ell:
            x = rng.randrange(2, 10**6)
            rank = residues(M0 + M1 * x, ell).rank() - system.n
            if rank > _MINORS:
                return _row_of_least_degree(M0, M1)
            row = _row_of_minors(system, x, ell)
            if row is not None and (row @ PolynomialMatrix.pencil(M0, M1)).is_zero():
                return row
    raise InternalError("the stream of primes is endless")


def _row_of_minors(system: MultiChannelSystem, x: int, ell: int) -> PolynomialMatrix | None:
    """(−w C adj(xI − A), w χ_A) without its common factor, w N = 0 for N = C adj(xI − A) B.

    The entries of w are minors of N; None if the rows of N look independent modulo the prime.
    """
    A, B, C = system.A, system.input_matrix(), system.output_matrix()
    chi = characteristic_polynomial(A)
    parts: list[Matrix] = []
    for c in reversed(chi.coefficients[1:]):
        parts.append(parts[-1] @ A + C * c if parts else C)
    adjugate = PolynomialMatrix.from_matrices(*(parts[::-1] or [C]))
    N = adjugate @ B
    if N.denominator % ell == 0:
        return None
    value = N.at_residue(x, ell)
    columns, rows = list(value.rref()[1]), list(value.T.rref()[1])
    extra = next((i for i in range(C.nrows) if i not in rows), None)
    if extra is None:
        return None
    chosen = [*rows, extra]
    table = [[N.entry(i, j) for j in columns] for i in chosen]
    w = [Polynomial.of()] * C.nrows
    for k, i in enumerate(chosen):
        minor = _minor([row for other, row in enumerate(table) if other != k])
        w[i] = -minor if k % 2 else minor
    row = PolynomialMatrix.from_polynomials([w])
    left = -(row @ adjugate)
    entries = [left.entry(0, j) for j in range(system.n)] + [p * chi for p in w]
    common = reduce(Polynomial.gcd, entries)
    return PolynomialMatrix.from_polynomials([[p // common for p in entries]])


def _minor(rows: list[list[Polynomial]]) -> Polynomial:
    """The determinant of a small matrix of polynomials, along its first row."""
    total = Polynomial.of() if rows else Polynomial.of(1)
    for j, p in enumerate(rows[0] if rows else ()):
        rest = [row[:j] + row[j + 1 :] for row in rows[1:]]
        total = total + p * _minor(rest) * (-1) ** j
    return total


def _row_of_least_degree(M0: Matrix, M1: Matrix) -> PolynomialMatrix:
    """Compute an annihilating row of least degree, for pencils that have one of small degree.

    Σ w_k x^k annihilates iff w_0 M0 = 0, w_k M0 + w_{k−1} M1 = 0 and w_d M1 = 0.
    """
    rows, width = M0.shape
    for degree in range(rows + 1):
        blocks = []
        for k in range(degree + 1):
            parts = [Matrix.zeros(rows, width)] * (degree + 2)
            parts[k], parts[k + 1] = M0, M1
            blocks.append(hstack(parts))
        rows_of_degree = left_nullspace(vstack(blocks))
        if rows_of_degree.nrows:
            row = rows_of_degree.take(rows=[0])
            return PolynomialMatrix.from_matrices(
                *(row.take(cols=range(k * rows, (k + 1) * rows)) for k in range(degree + 1))
            )
    raise InternalError("a pencil without full row rank anywhere has no annihilating row")
