"""Lemma 3: the values of g for which (M + gA, B) loses controllability or its index."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random
from typing import Any

from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.analysis.structure.controllability_indices import controllability_indices
from mcexact.answer.controllability_indices import ControllabilityIndices
from mcexact.answer.evidence import RootDisc
from mcexact.answer.exceptional_gains import ExceptionalFactor, ExceptionalSet
from mcexact.derived.modular import generator
from mcexact.errors import Impossible, InternalError
from mcexact.exact.linear_algebra import PolynomialMatrix, determinant, field_kernel
from mcexact.exact.matrix import Matrix, hstack
from mcexact.exact.modular import polynomial_residues, primes
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import root_discs
from mcexact.model.entries import as_matrix, require_shape
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class ExceptionalGains:
    """The two exceptional sets of Lemma 3.

    Attributes
    ----------
    indices : ControllabilityIndices
        The answer that (A, B) is controllable with index m.
    index_set : ExceptionalSet
        E_index: the first m blocks of [B, (M+gA)B, …] lose rank n.
    controllability_set : ExceptionalSet
        E_ctrl ⊂ E_index: all n blocks do, (M+gA, B) is not controllable.
    """

    indices: ControllabilityIndices
    index_set: ExceptionalSet
    controllability_set: ExceptionalSet

    def __repr__(self) -> str:
        index, ctrl = len(self.index_set.roots), len(self.controllability_set.roots)
        return f"ExceptionalGains(values of g: {index} in E_index, {ctrl} in E_ctrl)"

    @property
    def index(self) -> int:
        """m, the controllability index of (A, B)."""
        return len(self.indices.ranks)


def exceptional_gains(M: Any, A: Any, B: Any) -> ExceptionalGains:
    """Compute all g for which (M + gA, B) is not controllable, or not within the index of (A, B).

    Parameters
    ----------
    M, A : n×n matrix
    B : n×p matrix
        (A, B) controllable.

    Returns
    -------
    ExceptionalGains

    Raises
    ------
    Impossible
        If (A, B) is not controllable, so that the lemma does not apply; with the certificate.
    InputError
        If a matrix has the wrong shape, or a float in it.

    Notes
    -----
    Paper, Lemma 3.  Each set is the zero set of the greatest common divisor of the n×n minors of
    K(g) = [B, (M+gA)B, …], which is not 0 because the coefficient of the highest power of g in each
    block is A^k B.  It divides the determinant of every compression K(g)R; the factors that two of
    them share are confirmed over their number fields by a row that annihilates K(g).  Exact.

    Examples
    --------
    >>> found = exceptional_gains([[0, 2], [1, 0]], [[0, 1], [0, 0]], [[0], [1]])
    >>> found.index, str(found.index_set.polynomial), -2 in found.index_set
    (2, 'x + 2', True)
    >>> [(int(a), int(b)) for a, b in found.index_set.real_roots]
    [(-2, -2)]
    """
    A = as_matrix(A, "A")
    M = require_shape(as_matrix(M, "M"), "M", A.nrows, A.nrows)
    B = require_shape(as_matrix(B, "B"), "B", A.nrows, None)
    system = MultiChannelSystem(A, [B], [Matrix.zeros(0, A.nrows)])
    indices = controllability_indices(system)
    if indices.index is None:
        raise Impossible(
            "(A, B) is not controllable, which Lemma 3 requires",
            joint_controllability(system),
        )
    rng = generator(system, "exceptional_gains")
    within = _exceptional_set(system, M, max(indices.index, 1), rng)
    everything = within
    if system.n > within.blocks:
        everything = _exceptional_set(system, M, system.n, rng)
    return ExceptionalGains(indices, within, everything)


def _blocks_of_g(M: Matrix, A: Matrix, B: Matrix, blocks: int) -> PolynomialMatrix:
    """K(g) = [B, (M+gA)B, …, (M+gA)^{blocks−1}B], n × blocks·p, as a polynomial matrix in g."""
    layers = [[B]]
    for _ in range(blocks - 1):
        last = layers[-1]
        moved = [M @ part for part in last] + [Matrix.zeros(*B.shape)]
        layers.append([moved[0], *(x + A @ y for x, y in zip(moved[1:], last, strict=True))])
    zero = Matrix.zeros(*B.shape)
    return PolynomialMatrix.from_matrices(
        *(
            hstack([part[k] if k < len(part) else zero for part in layers], nrows=A.nrows)
            for k in range(blocks)
        )
    )


def _exceptional_set(
    system: MultiChannelSystem, M: Matrix, blocks: int, rng: Random
) -> ExceptionalSet:
    """Find all g where some number of blocks of [B, (M+gA)B, …] have rank below n.

    Parameters
    ----------
    system : MultiChannelSystem
        A and B, all channels taken together.
    M : Matrix
        n×n.
    blocks : int
        At least 1.
    rng : Random
        The source of the compressions, which affects the running time but not the answer.
    """
    K = _blocks_of_g(M, system.A, system.input_matrix(), blocks)
    for bound in _growing():
        R, S = (_compression(rng, K.ncols, K.nrows, bound) for _ in range(2))
        first, second = _determinant(K @ R), _determinant(K @ S)
        if first.is_zero() or second.is_zero():
            continue
        confirmed: list[ExceptionalFactor] = []
        left = first
        for f, _ in first.gcd(second).factor():
            rows, pivots = field_kernel(K.T, f)
            if rows.ncols:
                left = left // f ** f.multiplicity_in(left)
                row = rows.take(cols=[0]).T
                confirmed.append(ExceptionalFactor(f, row, pivots[0]))
        if left.gcd(second).degree == 0:
            return _result(system, M, blocks, confirmed, (R, S), left, second)
    raise InternalError("compressions that share no other root were not found")


def _growing() -> Iterator[int]:
    for trial in range(10**4):
        yield 1 + 2 ** (trial // 4)


def _compression(rng: Random, nrows: int, ncols: int, bound: int) -> Matrix:
    """A matrix of small integers."""
    table = [[rng.randint(-bound, bound) for _ in range(ncols)] for _ in range(nrows)]
    return Matrix.from_integers(table, ncols=ncols)


def _determinant(N: PolynomialMatrix) -> Polynomial:
    """The determinant of a square polynomial matrix, through its values at 0, 1, … (Newton)."""
    parts = N.matrices
    result, basis = Polynomial.of(), Polynomial.of(1)
    for g in range(N.nrows * (len(parts) - 1) + 1):
        value = parts[-1]
        for part in reversed(parts[:-1]):
            value = value * g + part
        slope = (determinant(value) - result(g)) / basis(g)
        result = result + basis * slope
        basis = basis * Polynomial.of(-g, 1)
    return result


def _modulus(first: Polynomial, second: Polynomial, rng: Random) -> int:
    """A prime modulo which the two stay coprime, the first made monic."""
    monic = first.monic()
    for ell in primes(rng.getrandbits(64), bits=61):
        if monic.denominator * second.denominator % ell == 0:
            continue
        if polynomial_residues(monic, ell).gcd(polynomial_residues(second, ell)).degree == 0:
            return ell
    raise InternalError("the stream of primes is endless")


def _result(
    system: MultiChannelSystem,
    M: Matrix,
    blocks: int,
    confirmed: list[ExceptionalFactor],
    compressions: tuple[Matrix, Matrix],
    left: Polynomial,
    second: Polynomial,
) -> ExceptionalSet:
    polynomial = product(evidence.polynomial for evidence in confirmed)
    discs = root_discs(polynomial) if confirmed else ()
    return ExceptionalSet(
        system,
        M=M,
        blocks=blocks,
        polynomial=polynomial,
        roots=tuple(RootDisc(d.re, d.im, d.radius) for d in discs),
        modulus=_modulus(left, second, generator(system, "exceptional_gains")),
        factors=tuple(confirmed),
        compressions=compressions,
    )
