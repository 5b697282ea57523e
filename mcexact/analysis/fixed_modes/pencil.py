"""The rank of the pencil P_s(λ) for a set of channels and a mode."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from mcexact.analysis.stability.closed_loop_spectrum import open_loop_spectrum
from mcexact.answer.closed_loop_spectrum import ClosedLoopSpectrum
from mcexact.answer.pencil_rank import PencilRank
from mcexact.derived.modular import generator
from mcexact.errors import InputError, InternalError
from mcexact.exact.linear_algebra import PolynomialMatrix, inflate, kernel_at
from mcexact.exact.matrix import Matrix, block
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction
from mcexact.model.system import MultiChannelSystem


def pencil(system: MultiChannelSystem, s: Iterable[int]) -> tuple[Matrix, Matrix]:
    """The two coefficients of P_s(x) = M_0 + x M_1.

    Parameters
    ----------
    system : MultiChannelSystem
    s : iterable of int
        Positions of channels.

    Returns
    -------
    M0, M1 : Matrix
        Both (n + q_s) × (n + p_{m−s}):

            [ xI − A   B_{m−s} ]
            [   C_s       0    ]
    """
    inside = set(s)
    n = system.n
    B = system.input_matrix(i for i in range(system.m) if i not in inside)
    C = system.output_matrix(inside)
    M0 = block([[-system.A, B], [C, Matrix.zeros(C.nrows, B.ncols)]])
    M1 = block(
        [
            [Matrix.identity(n), Matrix.zeros(n, B.ncols)],
            [Matrix.zeros(C.nrows, n), Matrix.zeros(C.nrows, B.ncols)],
        ]
    )
    return M0, M1


def pencil_rank(system: MultiChannelSystem, subset: Iterable[str], mode: Any) -> PencilRank:
    """Compute the rank of P_s(λ) = [λI − A, B_{m−s}; C_s, 0].

    Parameters
    ----------
    system : MultiChannelSystem
    subset : iterable of str
        Names of channels; the empty set and all channels are allowed.
    mode : Polynomial, or a rational number
        An irreducible polynomial whose roots are the λ, or λ itself.

    Raises
    ------
    InputError
        If the polynomial is constant or reducible: its roots could have different ranks.
    UsageError
        If there is no channel of that name.

    Notes
    -----
    Exact.  The certificate has the kernel over Q[x]/(p), which bounds the rank from above, and a
    prime modulo which elimination with unit pivots bounds it from below.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 1]]] * 2)
    >>> pencil_rank(system, ["1"], 1).rank
    2
    >>> pencil_rank(system, [], 3).rank
    2
    """
    InputError.require(system, MultiChannelSystem, "system")
    p = _irreducible(mode)
    inside = system.indices(subset)
    M0, M1 = pencil(system, inside)
    kernel, pivots = kernel_at(M0, M1, p)
    rank = M0.ncols - len(pivots)
    return PencilRank(
        system,
        subset=system.named(inside),
        polynomial=p,
        rank=rank,
        modulus=_modulus(system, M0, M1, p, rank),
        kernel=kernel,
        pivots=pivots,
    )


def pencil_ranks(
    system: MultiChannelSystem,
    subset: Iterable[str],
    *,
    spectrum: ClosedLoopSpectrum | None = None,
) -> tuple[PencilRank, ...]:
    """Compute the rank of P_s at every mode of A, one for each irreducible factor of det(xI − A).

    Parameters
    ----------
    system : MultiChannelSystem
    subset : iterable of str
        Names of channels.
    spectrum : ClosedLoopSpectrum, optional
        ``open_loop_spectrum(system)``, if it is known already.
    """
    InputError.require(system, MultiChannelSystem, "system")
    names = system.named(system.indices(subset))
    known = ClosedLoopSpectrum.known(spectrum, system, "spectrum")
    found = open_loop_spectrum(system) if known is None else known
    return tuple(pencil_rank(system, names, mode) for mode, _ in found.polynomial.factor())


def _irreducible(mode: Any) -> Polynomial:
    p = (
        mode
        if isinstance(mode, Polynomial)
        else Polynomial.from_roots([as_fraction(mode, where="mode")])
    )
    if p.degree < 1:
        raise InputError("expected a number or a polynomial of degree at least 1", where="mode")
    factors = [factor for factor, _ in p.factor()]
    if factors != [p.monic()]:
        listed = ", ".join(map(str, factors))
        raise InputError(
            f"expected an irreducible polynomial; ask for each of its factors: {listed}",
            where="mode",
        )
    return factors[0]


def _modulus(system: MultiChannelSystem, M0: Matrix, M1: Matrix, p: Polynomial, rank: int) -> int:
    """A prime modulo which the pencil keeps its rank at every root of p."""
    inflated = inflate(PolynomialMatrix.pencil(M0, M1), p)
    for ell in primes(generator(system, "pencil_rank").getrandbits(64), bits=61):
        if (inflated.denominator * M0.denominator) % ell == 0 or p.denominator % ell == 0:
            continue
        if residues(inflated, ell).rank() == rank * p.degree:
            return ell
    raise InternalError("the stream of primes is endless")
