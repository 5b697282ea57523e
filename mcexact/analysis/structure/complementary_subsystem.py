"""Complementary subsystems: normal rank, invariant zeros, remnant polynomial."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from random import Random

from mcexact.answer.complementary_subsystem import ComplementarySubsystem
from mcexact.derived.modular import generator, residue_systems
from mcexact.errors import InputError, InternalError, UsageError
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import (
    companions,
    invariant_form,
    inverse,
    kernel,
    left_nullspace,
    nullspace,
    solve,
)
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.modular import hstack as modular_hstack
from mcexact.exact.modular import residues
from mcexact.exact.polynomial import Polynomial, product
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class _Outside:
    """L, c × n, with L = G C + N L A and N L B = 0, N strictly lower triangular.

    The kernel of L is the largest subspace V of the kernel of C with A V ⊂ V + im B.
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
    >>> found = complementary_subsystem(MultiChannelSystem(A, B, C), ["2", "3"])
    >>> found.complete, str(found.remnant)
    (False, 'x - 1')
    >>> found.transfer_zero, [(str(zeros.polynomial), zeros.rank) for zeros in found.zeros]
    (True, [('x - 1', 2)])
    """
    InputError.require(system, MultiChannelSystem, "system")
    inside = system.indices(subset)
    if not 0 < len(inside) < system.m:
        raise UsageError("expected a nonempty proper subset of the channels")
    rng = generator(system, "complementary_subsystem")
    rest = [i for i in range(system.m) if i not in inside]
    B, C = system.input_matrix(rest), system.output_matrix(inside)
    for modular in residue_systems(system, rng, bits=61):
        outside = _outside(system.A, B, C, modular.modulus)
        found = None if outside is None else _decomposed(system.A, B, outside, rng)
        if outside is None or found is None:
            continue
        parts, polynomials, reachable = found
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
        moved = Y @ L @ A
        stacked = vstack([L, moved], ncols=n)
        if stacked.denominator % ell == 0:
            return None
        chosen = [j - L.nrows for j in residues(stacked.T, ell).rref()[1] if j >= L.nrows]
        if not chosen:
            break
        Y, moved = Y.take(rows=chosen), moved.take(rows=chosen)
        # Clear the columns of the earlier pivots, and make the new pivots an identity.
        c = solve(L.take(cols=places).T, moved.take(cols=places).T)
        if c is None:
            return None
        c = c.T
        new = moved - c @ L
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
    X, pivots = kernel(outside.L) if outside.L.nrows else (Matrix.identity(n), tuple(range(n)))
    v = X.ncols
    found = solve(hstack([X, -B], nrows=n), A @ X)
    if found is None:
        return None
    inner, F = found.take(rows=range(v)), found.take(rows=range(v, v + p))
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
