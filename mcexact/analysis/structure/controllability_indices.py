"""Controllability and observability indices of some channels, by the ranks of [B … A^{k−1}B]."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import overload

from mcexact.analysis.structure.parametric_ranks import parametric_indices
from mcexact.answer.controllability_indices import ControllabilityIndices
from mcexact.answer.parametric_rank import ParametricRank
from mcexact.derived.constructions import dual
from mcexact.derived.modular import generator, residue_systems
from mcexact.errors import InputError, InternalError
from mcexact.exact.linear_algebra import solve_nonsingular
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.modular import ModularMatrix, residues
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class _Profile:
    """Ranks r_1 < … < r_ν modulo ℓ; r_k independent columns and rows of [B … A^{k−1}B]."""

    columns: list[list[int]]
    rows: list[tuple[int, ...]]

    @property
    def ranks(self) -> tuple[int, ...]:
        return tuple(map(len, self.rows))


@overload
def controllability_indices(
    system: MultiChannelSystem, channels: Iterable[str] | None = None
) -> ControllabilityIndices: ...


@overload
def controllability_indices(
    system: ParametricSystem, channels: Iterable[str] | None = None
) -> tuple[ParametricRank, ...]: ...


def controllability_indices(
    system: MultiChannelSystem | ParametricSystem, channels: Iterable[str] | None = None
) -> ControllabilityIndices | tuple[ParametricRank, ...]:
    """Compute the controllability index and the controllability indices of (A, B_T).

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        For a plant with one parameter the answers are the ranks of the first k blocks for
        k = 1, 2, …, for all values, until none grows at any value (`ParametricRank`).
    channels : iterable of str, optional
        T, names of channels, by default all.

    Notes
    -----
    Exact.  The ranks are found modulo a prime, which bounds them from below.  From above: W, whose
    first n − r_k rows annihilate the first k blocks.  With independent rows P and columns J of the
    first k blocks K, each row f outside P that block k + 1 no longer leaves dependent gives one row
    of W, the solution of w_P K_{P,J} = −K_{f,J}.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> A = [[0, 1, 0], [0, 0, 0], [0, 0, 0]]
    >>> B = [[[0], [1], [0]], [[0], [0], [1]]]
    >>> found = controllability_indices(MultiChannelSystem(A, B, [[[1, 0, 0]]] * 2))
    >>> found.ranks, found.index, found.indices
    ((2, 3), 2, (2, 1))
    >>> controllability_indices(MultiChannelSystem(A, B, [[[1, 0, 0]]] * 2), ["2"]).index is None
    True
    """
    if isinstance(system, ParametricSystem):
        return parametric_indices(system, channels)
    InputError.require(system, MultiChannelSystem, "system")
    T = range(system.m) if channels is None else system.indices(channels)
    B = system.input_matrix(T)
    rng = generator(system, "controllability_indices")
    for modular in residue_systems(system, rng, bits=61):
        profile = _profile(modular.A, residues(B, modular.modulus))
        W = _annihilator(system.A, B, profile)
        if W is not None:
            return _result(system, T, profile.ranks, modular.modulus, W)
    raise InternalError("the stream of primes is endless")


@overload
def observability_indices(
    system: MultiChannelSystem, channels: Iterable[str] | None = None
) -> ControllabilityIndices: ...


@overload
def observability_indices(
    system: ParametricSystem, channels: Iterable[str] | None = None
) -> tuple[ParametricRank, ...]: ...


def observability_indices(
    system: MultiChannelSystem | ParametricSystem, channels: Iterable[str] | None = None
) -> ControllabilityIndices | tuple[ParametricRank, ...]:
    """Compute the observability index and indices of (C_T, A), by those of the dual system.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
    channels : iterable of str, optional
        T, names of channels, by default all.
    """
    if isinstance(system, ParametricSystem):
        return parametric_indices(system, channels, observed=True)
    InputError.require(system, MultiChannelSystem, "system")
    return controllability_indices(dual(system), channels)


def _profile(A: ModularMatrix, B: ModularMatrix) -> _Profile:
    """Independent columns and rows of the first k blocks modulo ℓ, until the rank stops growing."""
    n, p = A.nrows, B.ncols
    columns: list[list[int]] = []
    rows: list[tuple[int, ...]] = []
    chosen: list[int] = []
    block, basis = B, ModularMatrix.zeros(0, n, A.modulus)
    for k in range(n):
        table = basis.rows() + block.T.rows()
        stacked = ModularMatrix.from_rows(table, A.modulus, ncols=n)
        _, independent = stacked.T.rref()
        new = [j - basis.nrows for j in independent if j >= basis.nrows]
        if not new:
            break
        chosen = chosen + [k * p + j for j in new]
        basis, places = stacked.take(rows=independent).rref()
        columns.append(chosen)
        rows.append(places)
        block = A @ block
    return _Profile(columns, rows)


def _annihilator(A: Matrix, B: Matrix, profile: _Profile) -> Matrix | None:
    """W, its first n − r_k rows annihilating the first k blocks; None if the ranks are larger."""
    n, ranks = A.nrows, profile.ranks
    if not ranks:
        return Matrix.identity(n) if B.is_zero() else None
    blocks = [B]
    for _ in ranks:
        blocks.append(A @ blocks[-1])
    K = hstack(blocks, nrows=n)
    W = Matrix.zeros(0, n)
    for k in reversed(range(len(ranks))):
        J, P = profile.columns[k], profile.rows[k]
        later = set(profile.rows[k + 1]) if k + 1 < len(ranks) else set(range(n))
        part = _rows_of(K.take(cols=J), P, sorted(later - set(P)))
        W = vstack([W, part], ncols=n)
        last = blocks[: k + 2] if k + 1 == len(ranks) else blocks[: k + 1]
        if not all((part @ block).is_zero() for block in last):
            return None
    return W


def _rows_of(K: Matrix, P: tuple[int, ...], wanted: list[int]) -> Matrix:
    """For each wanted f, a primitive integer row with support in f and P, wK = 0; K n × |P|.

    The rows have no denominators: one for all of W would be as long as all of theirs together.
    """
    n = K.nrows
    found = solve_nonsingular(K.take(rows=P).T, -K.take(rows=wanted).T)
    if found is None:
        raise InternalError("independent rows and columns make a nonsingular matrix")
    table = []
    for i, f in enumerate(wanted):
        row = [0] * n
        for j, entries in zip(P, found.numerators, strict=True):
            row[j] = entries[i]
        row[f] = found.denominator
        content = math.gcd(*row)
        table.append([entry // content for entry in row])
    return Matrix.from_integers(table, ncols=n)


def _result(
    system: MultiChannelSystem,
    T: Iterable[int],
    ranks: tuple[int, ...],
    modulus: int,
    W: Matrix,
) -> ControllabilityIndices:
    reached = ranks[-1] if ranks else 0
    steps = [b - a for a, b in pairwise((0, *ranks))]
    return ControllabilityIndices(
        system,
        channels=system.named(T),
        ranks=ranks,
        index=len(ranks) if reached == system.n else None,
        indices=tuple(sum(step > i for step in steps) for i in range(max(steps, default=0))),
        modulus=modulus,
        annihilator=W,
    )
