"""Controllability, observability, their indices, and exceptional gains.

`joint_controllability` decides whether the channels T control (A, B_T), and which modes they do not
control.  A rank modulo a prime bounds the controllable dimension from below, an annihilator W over
Q, WA = ZW and WB_T = 0, from above.  Small systems are decided by that rank.  For large ones blocks
of states (`blocks`) are tried first, O(n³): those with the outputs of the system, if all channels
are asked about; else, and if these leave modes, the channels measure states, because the modes that
they do not control are fixed whatever they measure.

`controllability_indices` has the ranks of [B … A^{k−1}B]: modulo a prime from below; from above by
the relations among the columns of these blocks, after which ranks grow less.  A plant whose ranks
are generic has none, and a prime is all the evidence.  Of large sparse plants these blocks are
eliminated in a band, in which states that A joins are near each other; what has no narrow band, or
relations among many columns, is left open beyond 1,500 states.

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
from typing import TYPE_CHECKING, Any, overload

from mcexact.analysis.blocks import (
    free_blocks,
    measured_blocks,
    measured_system,
    modes_left,
    transposed_blocks,
)
from mcexact.analysis.sparse import annihilator, is_large_and_sparse
from mcexact.answer.evidence import Block, RootDisc
from mcexact.answer.modes import ByBlocks as FixedByBlocks
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.structure import (
    ByBlocks,
    ByGrowth,
    ByRank,
    ControllabilityIndices,
    ExceptionalFactor,
    ExceptionalSet,
    JointControllability,
)
from mcexact.derived.constructions import dual
from mcexact.derived.modular import SHORT, generator, residue_systems, short_modulus
from mcexact.errors import Impossible, InternalError, LimitReached
from mcexact.exact.krylov import InvariantSubspace, controllable_subspace, krylov_rows
from mcexact.exact.linear_algebra import (
    PolynomialMatrix,
    characteristic_polynomial,
    determinant,
    field_nullspace,
    solve_nonsingular,
)
from mcexact.exact.matrix import Matrix, hstack
from mcexact.exact.modular import (
    ModularMatrix,
    krylov_pivots,
    polynomial_residues,
    primes,
    residues,
)
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import root_discs
from mcexact.model.entries import as_matrix, require_shape
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem, any_system

if TYPE_CHECKING:
    from mcexact.answer.parameters import ParametricFixedSpectrum, ParametricRank

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
        # start-up: few plants need it
        from mcexact.analysis.parameters.modes import parametric_controllability

        return parametric_controllability(system, channels, observed=observed)
    any_system(system)
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
    subspace, A, B = _subspace(system, T), system.A, system.input_matrix(T)
    W, free = subspace.annihilator(), subspace.free

    def is_reached(ell: int) -> bool:
        return len(krylov_rows(A, B, ell)[1]) == subspace.dimension

    modulus = short_modulus(A.denominator * B.denominator, is_reached, subspace.modulus)
    return JointControllability(
        system,
        channels=system.named(T),
        dimension=subspace.dimension,
        controllable=subspace.dimension == system.n,
        uncontrollable_polynomial=characteristic_polynomial((W @ system.A).take(cols=free)),
        evidence=ByRank(modulus, W, free),
    )


# Controllability and observability indices of some channels, by the ranks of [B … A^{k−1}B].


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
    Exact.  The ranks modulo a prime bound them from below.  From above: the steps from one rank to
    the next do not grow, a relation Σ A^i B v_i = 0 of degree k takes one input from all steps
    after the first k, and W with WA = ZW, WB = 0 bounds all ranks.  A relation is found for each
    input whose column A^k b depends on those before it, if a step is less than these bounds
    without it.  O(n³) word operations if ranks are generic, else for each word of a relation.

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
        # start-up: few plants need it
        from mcexact.analysis.parameters.ranks import parametric_indices

        return parametric_indices(system, channels)
    any_system(system)
    T = range(system.m) if channels is None else system.indices(channels)
    B = system.input_matrix(T)
    if is_large_and_sparse(system) and (evidence := _by_bands(system, T, B)):
        return _indices(system, T, *evidence)
    rng = generator(system, "controllability_indices")
    for modular in residue_systems(system, rng, bits=61):
        degrees = _column_degrees(modular.A, residues(B, modular.modulus))
        growth = _growth(system.A, B, degrees, modular.modulus, rng)
        if growth is not None:
            return _indices(system, T, _ranks(degrees), growth)
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
        # start-up: few plants need it
        from mcexact.analysis.parameters.ranks import parametric_indices

        return parametric_indices(system, channels, observed=True)
    any_system(system)
    return controllability_indices(dual(system), channels)


def _column_degrees(A: ModularMatrix, B: ModularMatrix) -> list[int]:
    """The degree κ_j of each input j: A^i b_j depends on the columns before it iff i ≥ κ_j.

    The columns are those of [B, AB, …] in this order.  Several blocks are eliminated at once: as
    many as a generic pair needs for rank n.
    """
    n, p, blocks = A.nrows, B.ncols, 0
    degrees, live, power = [0] * p, list(range(p)), B
    basis: list[list[int]] = []
    while live and len(basis) < n:
        turns = -(-(n - len(basis)) // len(live))
        rows = power.T.rows()
        for _ in range(turns - 1):
            power = A @ power
            rows += power.T.rows()
        places = [(blocks + turn, j) for turn in range(turns) for j in live]
        table = ModularMatrix.from_rows(basis + rows, A.modulus, ncols=n)
        grown = [c - len(basis) for c in table.T.rref()[1] if c >= len(basis)]
        for c in grown:
            block, j = places[c]
            degrees[j] = block + 1
        basis += [rows[c] for c in grown]
        blocks += turns
        kept = [k for k, j in enumerate(live) if degrees[j] == blocks]
        live = [live[k] for k in kept]
        power = A @ power.take(cols=kept)
    return degrees


def _ranks(degrees: Sequence[int]) -> tuple[int, ...]:
    """The ranks of the first 1, 2, … blocks, until they stop growing."""
    return tuple(sum(min(d, k) for d in degrees) for k in range(1, max(degrees, default=0) + 1))


def _growth(
    A: Matrix, B: Matrix, degrees: Sequence[int], modulus: int, rng: Random
) -> ByGrowth | None:
    """The evidence that the ranks are at most those modulo a prime; None if they are larger."""
    ranks = _ranks(degrees)
    W, pivots = Matrix.zeros(0, A.nrows), tuple[int, ...]()
    if ranks and ranks[-1] < A.nrows:
        subspace = controllable_subspace(A, B, rng)
        if subspace.dimension != ranks[-1]:
            return None
        W, pivots = subspace.annihilator(), subspace.free
    inputs = _inputs_with_relations(A.nrows - W.nrows, degrees)
    relations = _relations(A, B, degrees, inputs, modulus)
    if relations is None:
        return None

    def is_reached(ell: int) -> bool:
        return _ranks(_column_degrees(residues(A, ell), residues(B, ell))) == ranks

    short = short_modulus(A.denominator * B.denominator, is_reached, modulus)
    return ByGrowth(short, W, pivots, relations, tuple(inputs))


def _inputs_with_relations(dimension: int, degrees: Sequence[int]) -> list[int]:
    """The inputs whose relations show that ranks grow no faster; ``dimension`` bounds them all."""
    needed, step, ranks = -1, len(degrees), (0, *_ranks(degrees))
    for k, (rank, following) in enumerate(pairwise((*ranks, ranks[-1]))):
        if following < min(dimension, rank + step):
            needed = k
        step = following - rank
    listed = (j for j, degree in enumerate(degrees) if degree <= needed)
    return sorted(listed, key=lambda j: (degrees[j], j))


_MOST_IN_BANDS = 4 * 10**9
"""The bytes that an elimination in bands may go through: some seconds."""
_MOST_RELATED = 1000
"""The columns among which relations are looked for where the plant is large and sparse."""
_MOST_DENSE = 1500
"""The states of a sparse plant for which exact elimination takes a minute."""


def _by_bands(
    system: MultiChannelSystem, T: Sequence[int], B: Matrix
) -> tuple[tuple[int, ...], ByGrowth] | None:
    """Ranks and evidence of a large sparse plant, with eliminations in bands modulo short primes.

    None if they are not found, and the plant is small enough for other ways.

    Raises
    ------
    LimitReached
        If it is not.
    """
    reason = "no short prime keeps the ranks of [B, AB, …]"
    try:
        for ell in SHORT:
            if system.A.denominator * B.denominator % ell:
                degrees = _banded_degrees(system.A, B, ell)
                growth = _growth_in_bands(system, T, B, degrees, ell)
                if growth is not None:
                    return _ranks(degrees), growth
    except LimitReached as limit:
        reason = str(limit)
    if system.n > _MOST_DENSE:
        raise LimitReached(f"indices of {system.n} states: {reason}")
    return None


def _banded_degrees(A: Matrix, B: Matrix, ell: int) -> list[int]:
    """`_column_degrees` for an A of few entries: more blocks as long as these grow."""
    n, p = B.shape
    blocks = -(-n // max(p, 1))
    while True:
        pivots = krylov_pivots(A, B, blocks, ell, _MOST_IN_BANDS)
        last = sum(k == blocks - 1 for k, _ in pivots)
        if len(pivots) == n or not last:
            break
        blocks += -(-(n - len(pivots)) // last)  # as many as reach n in steps like the last one
    degrees = [0] * p
    for _, j in pivots:
        degrees[j] += 1
    return degrees


def _growth_in_bands(
    system: MultiChannelSystem, T: Sequence[int], B: Matrix, degrees: Sequence[int], ell: int
) -> ByGrowth | None:
    """`_growth` for a large sparse plant: None also if the evidence would be long."""
    left = system.n - sum(degrees)
    W, pivots = Matrix.zeros(0, system.n), tuple[int, ...]()
    if 0 < left < system.n:
        part, _ = measured_system(system, T)
        annihilating = annihilator(part, left)
        if annihilating is None:
            return None
        W, pivots = annihilating
    inputs = _inputs_with_relations(system.n - W.nrows, degrees)
    top = max((degrees[j] for j in inputs), default=0)
    if inputs and sum(min(degree, top + 1) for degree in degrees) > _MOST_RELATED:
        return None
    relations = _relations(system.A, B, degrees, inputs, ell)
    return None if relations is None else ByGrowth(ell, W, pivots, relations, tuple(inputs))


def _relations(
    A: Matrix, B: Matrix, degrees: Sequence[int], inputs: Sequence[int], modulus: int
) -> PolynomialMatrix | None:
    """V with Σ A^i B V_i = 0 and a column of integers for each input.

    The column of input j has A^κ b_j, κ its degree, by those columns A^i b_l before it for which i
    is below the degree of l.  None if it does not depend on these.
    """
    d, p = A.denominator, B.ncols
    A, B = A * d, B * B.denominator
    top = max((degrees[j] for j in inputs), default=0)
    blocks = [B]
    for _ in range(top):
        blocks.append(A @ blocks[-1])
    layers = [[[0] * len(inputs) for _ in range(p)] for _ in range(top + 1)]
    if inputs:
        last = degrees[inputs[-1]], inputs[-1]
        columns = [
            [j for j in range(p) if k < degrees[j] and (k, j) < last] for k in range(top + 1)
        ]
        left = hstack([block.take(cols=c) for block, c in zip(blocks, columns, strict=True)])
        right = hstack([blocks[degrees[j]].take(cols=[j]) for j in inputs])
        solution = _combinations(left, right, modulus)
        if solution is None:
            return None
        places = [(k, j) for k, listed in enumerate(columns) for j in listed]
        for t, j in enumerate(inputs):
            used = (at for at, row in zip(places, solution.numerators, strict=True) if row[t])
            if max(used, default=(-1, -1)) > (degrees[j], j):
                return None  # the prime makes it depend on those before it, not Q
            terms = [(degrees[j], j, -solution.denominator)]
            terms += [(*at, row[t]) for at, row in zip(places, solution.numerators, strict=True)]
            content = math.gcd(*(entry * d**k for k, _, entry in terms))
            for k, other, entry in terms:
                layers[k][other][t] = entry * d**k // content
    tables = (Matrix.from_integers(layer, ncols=len(inputs)) for layer in layers)
    return PolynomialMatrix.from_matrices(*tables)


def _combinations(M: Matrix, N: Matrix, ell: int) -> Matrix | None:
    """The X with M X = N, the columns of M independent modulo a prime; None if there is none."""
    rows = residues(M.T, ell).rref()[1]
    X = solve_nonsingular(M.take(rows=rows), N.take(rows=rows))
    return X if X is not None and M @ X == N else None


def _indices(
    system: MultiChannelSystem, T: Iterable[int], ranks: tuple[int, ...], evidence: ByGrowth
) -> ControllabilityIndices:
    reached = ranks[-1] if ranks else 0
    steps = [b - a for a, b in pairwise((0, *ranks))]
    return ControllabilityIndices(
        system,
        channels=system.named(T),
        ranks=ranks,
        index=len(ranks) if reached == system.n else None,
        indices=tuple(sum(step > i for step in steps) for i in range(max(steps, default=0))),
        evidence=evidence,
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
            rows, pivots = field_nullspace(K.T, f)
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
