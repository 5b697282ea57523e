"""Controllability, observability, their indices, and exceptional gains.

`joint_controllability` decides whether the channels T control (A, B_T), and which modes they do not
control.  A rank modulo a prime bounds the controllable dimension from below, an annihilator W over
Q, WA = ZW and WB_T = 0, from above.  Small systems are decided by that rank.  For large ones blocks
of states (`blocks`) are tried first, O(n³): those with the outputs of the system, if all channels
are asked about; else, and if these leave modes, the channels measure states, because the modes that
they do not control are fixed whatever they measure.

`controllability_indices` has the ranks of [B … A^{k−1}B]: modulo a prime from below, and by one
matrix W, the first n − r_k rows of which annihilate the first k blocks, from above.

Observability is controllability of the dual system.  With one parameter in the plant, both are
decided for all its values (`parameters`).

`exceptional_gains` is Lemma 3 of the paper: the values of g at which (M + gA, B) loses
controllability or its index, as roots of an exact polynomial.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from random import Random
from typing import Any, overload

from mcexact.analysis.blocks import (
    free_blocks,
    measured_blocks,
    measured_system,
    modes_left,
    transposed_blocks,
)
from mcexact.analysis.parameters.modes import parametric_controllability
from mcexact.analysis.parameters.ranks import parametric_indices
from mcexact.analysis.sparse import annihilator
from mcexact.answer.evidence import Block, RootDisc
from mcexact.answer.modes import ByBlocks as FixedByBlocks
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.parameters import ParametricFixedSpectrum, ParametricRank
from mcexact.answer.structure import (
    ByBlocks,
    ByRank,
    ControllabilityIndices,
    ExceptionalFactor,
    ExceptionalSet,
    JointControllability,
)
from mcexact.derived.constructions import dual
from mcexact.derived.modular import generator, residue_systems
from mcexact.errors import Impossible, InputError, InternalError
from mcexact.exact.krylov import InvariantSubspace, controllable_subspace
from mcexact.exact.linear_algebra import (
    PolynomialMatrix,
    characteristic_polynomial,
    determinant,
    field_kernel,
    solve_nonsingular,
)
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.modular import ModularMatrix, polynomial_residues, primes, residues
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import root_discs
from mcexact.model.entries import as_matrix, require_shape
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

# Controllability and observability of channels together.

# Up to this size a rank modulo a prime is the shorter evidence, and quick to check.
_SMALL = 128


@overload
def joint_controllability(
    system: MultiChannelSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability: ...


@overload
def joint_controllability(
    system: ParametricSystem, channels: Iterable[str] | None = None
) -> ParametricFixedSpectrum: ...


def joint_controllability(
    system: MultiChannelSystem | ParametricSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability | ParametricFixedSpectrum:
    """Decide whether (A, B_T) is controllable.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant with one parameter is decided for all values: the answer has the modes that T does
        not control, and the values at which they are more (`ParametricFixedSpectrum`).
    channels : iterable of str, optional
        T, names of channels, by default all.
    spectrum : FixedSpectrum, optional
        ``fixed_spectrum(system)`` of a plant without parameters, if it is known already.

    Notes
    -----
    Exact.  The certificate has a rational W, WA = ZW and WB_T = 0, that bounds the dimension from
    above.  From below it has a prime modulo which [B_T, AB_T, …] reaches the rank; or, for large
    systems, blocks of states that feedback of T moves.  These are those of the fixed spectrum if no
    mode is fixed, else they are of channels that measure states.  O(n³ log n) word operations, for
    each word of the entries of W; O(n³) with blocks.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 1]]] * 2)
    >>> joint_controllability(system).controllable
    True
    >>> alone = joint_controllability(system, ["1"])
    >>> alone.controllable, str(alone.uncontrollable_polynomial)
    (False, 'x - 2')
    """
    return _decided(system, channels, spectrum, observed=False)


@overload
def joint_observability(
    system: MultiChannelSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability: ...


@overload
def joint_observability(
    system: ParametricSystem, channels: Iterable[str] | None = None
) -> ParametricFixedSpectrum: ...


def joint_observability(
    system: MultiChannelSystem | ParametricSystem,
    channels: Iterable[str] | None = None,
    *,
    spectrum: FixedSpectrum | None = None,
) -> JointControllability | ParametricFixedSpectrum:
    """Decide whether (C_T, A) is observable, by controllability of the dual system.

    Parameters
    ----------
    system, channels, spectrum
        As for `joint_controllability`; ``spectrum`` is that of the system, not of its dual.

    Returns
    -------
    JointControllability or ParametricFixedSpectrum
        The answer about ``dual(system)``: ``observable`` says whether (C_T, A) is, ``dimension`` is
        the rank of [C_T; C_T A; …], and ``uncontrollable_polynomial`` has the unobservable modes.
    """
    return _decided(system, channels, spectrum, observed=True)


def _decided(
    system: MultiChannelSystem | ParametricSystem,
    channels: Iterable[str] | None,
    spectrum: FixedSpectrum | None,
    *,
    observed: bool,
) -> JointControllability | ParametricFixedSpectrum:
    """Decide controllability of the system or its dual, by rank if small, else by blocks."""
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        return parametric_controllability(system, channels, observed=observed)
    InputError.require(system, MultiChannelSystem, "system")
    subject = dual(system) if observed else system
    T = range(system.m) if channels is None else system.indices(channels)
    if system.n <= _SMALL:
        return _by_rank(subject, T)
    if len(T) == system.m:
        blocks = _own(system, spectrum)
        blocks = transposed_blocks(blocks) if observed else blocks
        if not modes_left(blocks):
            return _all_reached(subject, T, ByBlocks(blocks, None, Matrix.zeros(0, system.n), ()))
    measuring = _by_measuring(subject, T)
    return _by_rank(subject, T) if measuring is None else measuring


def _by_measuring(system: MultiChannelSystem, T: Sequence[int]) -> JointControllability | None:
    """Decide it by blocks, with channels T that measure states; None if sequences are too short."""
    if not T:
        return None
    part, measured = measured_system(system, T)
    blocks = measured_blocks(part)
    left = modes_left(blocks)
    if not left:
        evidence = ByBlocks(blocks, measured, Matrix.zeros(0, system.n), ())
        return _all_reached(system, T, evidence)
    annihilating = annihilator(part, left) if system.A.is_sparse else _annihilator(system, T)
    if annihilating is None or len(annihilating[1]) < left:
        return None
    W, pivots = annihilating
    return JointControllability(
        system,
        channels=system.named(T),
        dimension=system.n - left,
        controllable=False,
        uncontrollable_polynomial=characteristic_polynomial((W @ system.A).take(cols=pivots)),
        evidence=ByBlocks(blocks, measured, W, pivots),
    )


def _annihilator(system: MultiChannelSystem, T: Sequence[int]) -> tuple[Matrix, tuple[int, ...]]:
    subspace = _subspace(system, T)
    return subspace.annihilator(), subspace.free


def _subspace(system: MultiChannelSystem, T: Sequence[int]) -> InvariantSubspace:
    """The subspace that channels T control."""
    B = system.input_matrix(T)
    return controllable_subspace(system.A, B, generator(system, "controllability"))


def _own(system: MultiChannelSystem, spectrum: FixedSpectrum | None) -> tuple[Block, ...]:
    """Blocks with the system's own outputs; those of the fixed spectrum, if it is known."""
    blocks = free_blocks(system) if spectrum is None else None
    if spectrum is not None and isinstance(spectrum.evidence, FixedByBlocks):
        blocks = spectrum.evidence.blocks
    return blocks or (Block(tuple(range(system.n)), None),)


def _all_reached(
    system: MultiChannelSystem, T: Sequence[int], evidence: ByBlocks
) -> JointControllability:
    return JointControllability(
        system,
        channels=system.named(T),
        dimension=system.n,
        controllable=True,
        uncontrollable_polynomial=Polynomial.from_coefficients([1]),
        evidence=evidence,
    )


def _by_rank(system: MultiChannelSystem, T: Sequence[int]) -> JointControllability:
    subspace = _subspace(system, T)
    W, free = subspace.annihilator(), subspace.free
    return JointControllability(
        system,
        channels=system.named(T),
        dimension=subspace.dimension,
        controllable=subspace.dimension == system.n,
        uncontrollable_polynomial=characteristic_polynomial((W @ system.A).take(cols=free)),
        evidence=ByRank(subspace.modulus, W, free),
    )


# Controllability and observability indices of some channels, by the ranks of [B … A^{k−1}B].


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
    Exact.  The ranks modulo a prime bound them from below.  From above: W, whose first n − r_k rows
    annihilate the first k blocks.  With independent rows P and columns J of the first k blocks K,
    each row f outside P that block k + 1 no longer leaves dependent gives one row of W, the
    solution of w_P K_{P,J} = −K_{f,J}.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> A = [[0, 1, 0], [0, 0, 0], [0, 0, 0]]
    >>> B = [[[0], [1], [0]], [[0], [0], [1]]]
    >>> answer = controllability_indices(MultiChannelSystem(A, B, [[[1, 0, 0]]] * 2))
    >>> answer.ranks, answer.index, answer.indices
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
        W = _index_annihilator(system.A, B, profile)
        if W is not None:
            return _indices(system, T, profile.ranks, modular.modulus, W)
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


def _index_annihilator(A: Matrix, B: Matrix, profile: _Profile) -> Matrix | None:
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
    solution = solve_nonsingular(K.take(rows=P).T, -K.take(rows=wanted).T)
    if solution is None:
        raise InternalError("independent rows and columns make a nonsingular matrix")
    table = []
    for i, f in enumerate(wanted):
        row = [0] * n
        for j, entries in zip(P, solution.numerators, strict=True):
            row[j] = entries[i]
        row[f] = solution.denominator
        content = math.gcd(*row)
        table.append([entry // content for entry in row])
    return Matrix.from_integers(table, ncols=n)


def _indices(
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


# Exceptional gains of Lemma 3.


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
    >>> exceptional = exceptional_gains([[0, 2], [1, 0]], [[0, 1], [0, 0]], [[0], [1]])
    >>> exceptional.index, str(exceptional.index_set.polynomial), -2 in exceptional.index_set
    (2, 'x + 2', True)
    >>> [(int(a), int(b)) for a, b in exceptional.index_set.real_roots]
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
        by_M = [M @ part for part in last] + [Matrix.zeros(*B.shape)]
        layers.append([by_M[0], *(x + A @ y for x, y in zip(by_M[1:], last, strict=True))])
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
    """Compute all g where some number of blocks of [B, (M+gA)B, …] have rank below n.

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
            return _exceptional(system, M, blocks, confirmed, (R, S), left, second)
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


def _exceptional(
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
