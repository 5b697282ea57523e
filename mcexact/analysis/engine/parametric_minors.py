"""Ranks of matrices of polynomials in a parameter, for all its values."""

from __future__ import annotations

from typing import Any

from mcexact.analysis.engine.named_matrices import Entries, Named
from mcexact.answer.evidence import RootDisc
from mcexact.answer.parameter_values import (
    OutsideValue,
    meets,
)
from mcexact.answer.parametric_rank import Kernel, LowerRank, ParametricRank, TwoMinors
from mcexact.derived.modular import PolynomialSystem, generator
from mcexact.errors import InternalError
from mcexact.exact import bivariate
from mcexact.exact.bivariate import (
    ZERO,
    determinant,
    determinant_modulo,
    entries_of,
    generic_kernel,
    kernel_modulo,
    matrix_of,
    matrix_product,
)
from mcexact.exact.bivariate import Kernel as Columns
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import primes
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import root_discs, steady_point
from mcexact.model.parametric import ParametricSystem

_BITS = 61
_DRAWS = 60


def parametric_rank(system: ParametricSystem, matrix: Named) -> ParametricRank:
    """Decide the rank of a matrix for all values of a parameter.

    Parameters
    ----------
    system : ParametricSystem
        With one parameter.
    matrix : SetpointMatrix, SignalMatrix, ControllabilityMatrix or TransferColumn

    Notes
    -----
    Exact, for every complex value at which all entries of the plant are defined.  The roots of one
    minor of full order are the candidates; each irreducible factor is decided modulo a prime in
    which it has a root, and what is lost there is proved by a kernel over its number field.  That
    no other value counts is proved by a second, drawn minor modulo a prime.
    """
    return _Search(PolynomialSystem(system), matrix).found()


class _Search:
    """One minor, what is lost at its roots, and another minor that has no other root in common."""

    def __init__(self, system: PolynomialSystem, matrix: Named) -> None:
        self.system, self.matrix = system, matrix
        self.rng = generator(system.system, "parametric_rank")
        entries = _entries(system)
        self.rows, self.ncols = entries.matrix(matrix), entries.columns(matrix)
        self.M = matrix_of(self.rows, self.ncols)
        self.stream = primes(self.rng.getrandbits(64), _BITS)

    def found(self) -> ParametricRank:
        """The answer."""
        above, beside = self._pivots()
        rank, bounds = len(above), self.system.system.ranges[0]
        minor = determinant(self.M.take(rows=above, cols=beside))
        factors = [q for q, _ in _polynomial(minor).factor()]
        undefined = [q for q in factors if q in self.system.poles]
        lost = [
            q for q in factors if q not in self.system.poles and self._rank_at(q._rational) < rank
        ]
        discs = {q: tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(q)) for q in lost}
        outside = [
            q
            for q in lost
            if bounds != (None, None) and not any(meets(disc, bounds) for disc in discs[q])
        ]
        exceptional = [q for q in lost if q not in outside]
        kernels = [self._kernel(kernel_modulo(self.rows, self.ncols, q)) for q in exceptional]
        ranks = [self.ncols - len(kernel.pivots) for kernel in kernels]
        rest = bivariate.freed(minor, [q._rational for q in [*lost, *undefined]])
        full = rank == min(len(self.rows), self.ncols)
        ell, X_, Y = self._drawn(rank, rest, list(zip(exceptional, ranks, strict=True)))
        return ParametricRank(
            self.system.system,
            matrix=self.matrix,
            rank=rank,
            exceptional=tuple(
                LowerRank(q, discs[q], r) for q, r in zip(exceptional, ranks, strict=True)
            ),
            outside=tuple(OutsideValue(q, discs[q]) for q in outside),
            evidence=TwoMinors(
                kernel=None if full else self._kernel(generic_kernel(self.rows, self.ncols)),
                rows=above,
                columns=beside,
                modulus=ell,
                compressions=(X_, Y),
                exceptional=tuple(kernels),
                undefined=tuple(undefined),
            ),
        )

    def _pivots(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Rows and columns of a minor of full order that is not 0."""
        ell = next(ell for ell in self.stream if self.M.denominator % ell)
        value = self.M.at_residue(self.rng.randrange(ell), ell)
        columns = tuple(value.rref()[1])
        return tuple(value.take(cols=columns).T.rref()[1]), columns

    def _rank_at(self, q: Any) -> int:
        """The rank at a root of q modulo a prime, which is nearly always that at a root of q."""
        for ell in self.stream:
            if self.M.denominator % ell == 0 or int(q.denom()) % ell == 0:
                continue
            for root, _ in bivariate.residues(q, ell).roots():
                return self.M.at_residue(int(root), ell).rank()
        raise InternalError("no prime has a root of the polynomial")

    def _kernel(self, found: Columns) -> Kernel:
        pivots, vectors = found
        rows = [[v[i][0] for v in vectors] for i in range(self.ncols)]
        return Kernel(matrix_of(rows, len(vectors)), pivots)

    def _drawn(
        self, rank: int, rest: Any, values: list[tuple[Polynomial, int]]
    ) -> tuple[int, Matrix, Matrix]:
        """A prime, and X and Y whose minors have no other root in common with the first one."""
        for attempt in range(1, _DRAWS):
            ell = next(self.stream)
            known = [rest, *(q._rational for q, _ in values)]
            if self.M.denominator % ell == 0 or any(int(p.denom()) % ell == 0 for p in known):
                continue
            X_, Y = (
                Matrix.from_integers(
                    [[self.rng.randint(-attempt, attempt) for _ in range(c)] for _ in range(r)],
                    ncols=c,
                )
                for r, c in ((rank, len(self.rows)), (self.ncols, rank))
            )
            small = X_ @ self.M @ Y
            corners = [(q, small.take(rows=range(r), cols=range(r))) for q, r in values]
            pairs = [(rest, small), *((q._rational, corner) for q, corner in corners)]
            if all(
                bivariate.is_coprime_modulo(p, determinant_modulo(M, ell), ell) for p, M in pairs
            ):
                return ell, X_, Y
        raise InternalError("no drawn minors have a root in common where the rank is less")


def _polynomial(p: Any) -> Polynomial:
    return bivariate.polynomials([p])[0]


def _entries(system: PolynomialSystem) -> Entries:
    """The entries of A', B_i' and C_i' as polynomials of flint."""
    return Entries(
        names=system.system.names,
        A=entries_of(system.A),
        B=[entries_of(M) for M in system.B],
        C=[entries_of(M) for M in system.C],
        widths=[M.ncols for M in system.B],
        scale=system.scale._rational,
        steady=steady_point(system.system.time),
        zero=ZERO,
        product=matrix_product,
    )
