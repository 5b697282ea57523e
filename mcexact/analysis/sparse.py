"""Fixed modes, controllability and transfer graphs of large sparse systems.

The dense algorithms take O(n³) operations and memory for n² entries.  Here a closed loop A_F is a
sparse matrix, used only in products with vectors modulo primes, which are exact in floating point.

Fixed factors with shrunk subspaces (`fixed_subspaces`).  With N = μI − A_F, m = (x − μ) g the
minimal polynomial of A_F modulo a prime, and g(μ) ≠ 0,

    ker N = im g(A_F),      N x = b has the solution x = q(A_F) b / g(μ) or none,

where (x − μ) q = g − g(μ).  So the Wong sequence of `shrunk_subspace` takes n products with A_F for
each vector.  Its limit has a basis of few entries where the obstruction is local; it is lifted to
the rational numbers from residues modulo one prime, or several.  Every factor is proved to be
fixed; that these are all is proved elsewhere, by `blocks`.

Uncontrollable modes (`annihilator`).  Let h be the common divisor of the minimal polynomials of two
closed loops whose feedback moves all that the channels control, and m = h g that of A_F, g coprime
to h.  Then the rows of g(A_F) span the annihilator W of what they control.

The transfer graph (`reachable_pairs`, `edge_powers`).  Where no path leads from the inputs of a
channel to the outputs of another, no transfer does, and the structure of the matrices is the
evidence.  Where one does, a Markov parameter that is not 0 modulo a prime is an edge; all columns
of A^k B are computed at once, for one k after the other.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from typing import TYPE_CHECKING, Any

from mcexact.analysis.subspaces import ExactSubspace
from mcexact.derived.modular import ModularSystem, drawn_gains, generator
from mcexact.errors import InternalError, LimitReached
from mcexact.exact.krylov import SparseLoop, SparsePowers, largest_prime, reduce, row_echelon
from mcexact.exact.linear_algebra import PolynomialMatrix, rank, solve
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    combine,
    polynomial_residues,
    primes,
    rationals,
)
from mcexact.exact.polynomial import Polynomial, from_integer_coefficients
from mcexact.model.system import MultiChannelSystem

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Flags = npt.NDArray[np.bool_]
    Integers = npt.NDArray[np.int64]


# Closed loops modulo primes, with their minimal polynomials.

# Each column has n entries in the certificate, and takes n products with A_F.
MOST_COLUMNS = 256
# Each prime takes two sequences, each of 2n products of a vector with A_F, 1 ns for each entry that
# is not 0, and what it takes to begin; together they take about a minute at most.
MOST_WORK = 2**36
_STEP, _START = 10**4, 10**8
# A rank that is another one modulo two primes of 22 bits is nearly always another one over Q.
_MISSES = 2


@dataclass(frozen=True)
class DrawnLoop:
    """The closed loop of drawn gains modulo ℓ, and the minimal polynomial of its matrix.

    Attributes
    ----------
    parts : SparseLoop
    powers : SparsePowers
        Of A_F.
    polynomial : ModularPolynomial
    """

    parts: SparseLoop
    powers: SparsePowers
    polynomial: ModularPolynomial


def exact_primes(system: MultiChannelSystem, rng: random.Random) -> Iterator[int]:
    """Primes modulo which products with closed loops are exact and no denominator is 0."""
    parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    denominators = {M.denominator for M in parts}
    rows = [0] * system.n
    for i, _, _ in system.A.nonzero():
        rows[i] += 1
    for channel in system.channels:
        outputs = sum(1 for _ in channel.C.nonzero())
        for i in {i for i, _, _ in channel.B.nonzero()}:
            rows[i] += outputs
    bits = largest_prime(system.n, max(rows, default=0)).bit_length() - 1
    for ell in primes(rng.getrandbits(64), bits):
        if all(d % ell for d in denominators):
            yield ell


def affordable(system: MultiChannelSystem) -> int:
    """The number of primes for which two sequences each are computed."""
    entries = sum(1 for _ in system.A.nonzero()) + system.n
    return max(2, MOST_WORK // (4 * system.n * (entries + _STEP) + _START))


def drawn_loop(system: MultiChannelSystem, ell: int, rng: random.Random) -> DrawnLoop:
    """Draw gains modulo a prime, and compute the minimal polynomial of the loop."""
    channels = system.channels
    parts = SparseLoop(system.A, [c.B for c in channels], [c.C for c in channels], ell)
    gains = drawn_gains(ModularSystem(system, ell), rng)
    powers = SparsePowers(parts.closed(gains), ell)
    return DrawnLoop(parts, powers, powers.minimal_polynomial(rng))


# Fixed factors with shrunk subspaces.

# One of n! primes splits a polynomial of degree n, mostly.
_MOST_DEGREE = 6
_SURE = 2**10


@dataclass(frozen=True)
class _Limit:
    """The limit of the Wong sequence at a point: T, and the rows of a basis in echelon form."""

    T: tuple[int, ...]
    basis: Any
    pivots: tuple[int, ...]

    @property
    def place(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """What the limits at all roots and primes have in common."""
        return self.T, self.pivots


def fixed_subspaces(system: MultiChannelSystem) -> tuple[tuple[Polynomial, ExactSubspace], ...]:
    """The irreducible factors that are fixed, each with a shrunk subspace of the least T.

    Parameters
    ----------
    system : MultiChannelSystem
        Its closed loops are sparse.

    Returns
    -------
    tuple of (Polynomial, ExactSubspace)
        Sorted by degree, then by coefficients.  Every factor is proved to be fixed, but nothing
        proves that these are all.

    Raises
    ------
    LimitReached
        A mode is fixed by a Jordan chain, or its factor has a high degree, or its subspace a high
        dimension or long entries.
    """
    rng = generator(system, "fixed_spectrum")
    moduli = exact_primes(system, rng)
    whole, loop = _common_factor(system, moduli, rng)
    factors = []
    for p, often in whole.factor():
        if often > 1:
            raise LimitReached(f"the modes of {p} are fixed by Jordan chains of a large system")
        if p.degree > _MOST_DEGREE:
            raise LimitReached(f"a fixed factor of a large system has degree {p.degree}")
        fitting = (ell for ell in moduli if len(polynomial_residues(p, ell).roots()) == p.degree)
        loops = chain([loop], (drawn_loop(system, ell, rng) for ell in fitting))
        if len(polynomial_residues(p, loop.parts.ell).roots()) < p.degree:
            next(loops)
        factors.append((p, _subspace(system, p, loops, rng)))
    return tuple(sorted(factors, key=lambda each: (each[0].degree, each[0].coefficients)))


def _common_factor(
    system: MultiChannelSystem, moduli: Iterator[int], rng: random.Random
) -> tuple[Polynomial, DrawnLoop]:
    """The common divisor of the minimal polynomials of two loops, lifted to Q; and one of them."""
    residues: list[int] = []
    modulus = 1
    for ell in islice(moduli, affordable(system)):
        first, second = (drawn_loop(system, ell, rng) for _ in range(2))
        common = first.polynomial.gcd(second.polynomial).coefficients
        if not residues or len(common) < len(residues):
            residues, modulus = list(common), ell
        elif len(common) == len(residues):
            [residues] = combine([residues], modulus, [common], ell)
            modulus *= ell
        lifted = rationals([residues], modulus)
        if lifted is not None:
            [numerators], d = lifted
            # few residues lift to numbers so short by accident
            if _SURE * max(*map(abs, numerators), d) ** 2 < modulus:
                return from_integer_coefficients(numerators, d), first
    raise LimitReached(f"coefficients of fixed factors do not fit in {affordable(system)} primes")


def _subspace(
    system: MultiChannelSystem, p: Polynomial, loops: Iterator[DrawnLoop], rng: random.Random
) -> ExactSubspace:
    """A shrunk subspace for an irreducible polynomial, from its residues where p has all roots."""
    known: tuple[_Limit, list[list[int]], int] | None = None
    for loop in islice(loops, affordable(system)):
        ell, roots = loop.parts.ell, polynomial_residues(p, loop.parts.ell).roots()
        limits = [_limit(loop, mu, rng) for mu in roots]
        first = limits[0]
        if first is None or any(at is None or at.place != first.place for at in limits):
            continue
        layers = _interpolated([at.basis for at in limits if at], roots, ell)
        if known is not None and known[0].place == first.place:
            layers, ell = combine(known[1], known[2], layers, ell), known[2] * ell
        known = first, layers, ell
        lifted = rationals(layers, ell)
        subspace = None if lifted is None else _exact(system, p, first, *lifted)
        if subspace is not None:
            return subspace
    raise LimitReached(f"entries of the subspace for {p} do not fit in {affordable(system)} primes")


def _limit(loop: DrawnLoop, mu: int, rng: random.Random) -> _Limit | None:
    """The limit of the Wong sequence at μ; None for gains that are not of greatest rank."""
    import numpy as np

    ell, powers, n = loop.parts.ell, loop.powers, loop.powers.n
    line = ModularPolynomial.from_coefficients([-mu, 1], ell)
    g = loop.polynomial // line
    if not g(mu):
        raise LimitReached("a mode of a large system is fixed by Jordan chains")
    size = 1
    while True:
        drawn = [[rng.randrange(ell) for _ in range(size)] for _ in range(n)]
        basis, _ = row_echelon(powers.applied(g, np.array(drawn)).T, ell)
        if len(basis) < size:
            break
        size *= 2
    # (x − μ) q = g − g(μ)
    q = (g - ModularPolynomial.from_coefficients([g(mu)], ell)) // line
    T: set[int] = set()
    new = _seen(loop, basis.T)
    while new:
        T |= new
        inputs = loop.parts.inputs
        columns = [j for i in sorted(new) for j in range(inputs[i], inputs[i + 1])]
        B = loop.parts.B[:, columns].toarray()
        if len(basis) + B.shape[1] > MOST_COLUMNS:
            raise LimitReached(f"a shrunk subspace has more than {MOST_COLUMNS} dimensions")
        X = powers.applied(q, B) * pow(g(mu), -1, ell) % ell
        if ((mu * X - powers.product(X) - B) % ell).any():
            return None
        basis = np.vstack([basis, X.T])
        new = _seen(loop, X) - T
    return _Limit(tuple(sorted(T)), *row_echelon(basis, ell))


def _seen(loop: DrawnLoop, X: Any) -> set[int]:
    """The channels whose outputs are not all 0 on the columns of X."""
    outputs, nonzero = loop.parts.outputs, (loop.parts.C @ X % loop.parts.ell).any(axis=1)
    return {i for i in range(len(outputs) - 1) if nonzero[outputs[i] : outputs[i + 1]].any()}


def _interpolated(values: Sequence[Any], roots: Sequence[int], ell: int) -> list[list[int]]:
    """The rows of U_0', U_1', …, one after the other, with Σ μ^t U_t the value at each root."""
    inverse = ModularMatrix.from_rows(
        [[pow(mu, t, ell) for t in range(len(roots))] for mu in roots], ell
    ).inverse()
    if inverse is None:
        raise InternalError("different roots have an invertible Vandermonde matrix")
    rows: list[list[int]] = []
    for weights in inverse.rows():
        layer = sum(w * value % ell for w, value in zip(weights, values, strict=True)) % ell
        rows += layer.tolist()
    return rows


def _exact(
    system: MultiChannelSystem,
    p: Polynomial,
    at: _Limit,
    numerators: list[list[int]],
    denominator: int,
) -> ExactSubspace | None:
    """The subspace over Q with these columns, if it is one."""
    n, u, k = system.n, len(at.pivots), p.degree
    B, rest = system.input_matrix(at.T), [i for i in range(system.m) if i not in set(at.T)]
    U = [_columns(numerators[t * u : (t + 1) * u], n, denominator) for t in range(k)]
    lost = u - rank(_nonzero_rows(B)[1])
    if lost < 1 or any(not (system.output_matrix(rest) @ M).is_zero() for M in U):
        return None
    V = []
    for t, M in enumerate(U):
        image = -(system.A @ M) - U[-1] * p.coefficients[t]
        V.append(_solution(B, image + U[t - 1] if t else image))
    if any(M is None for M in V):
        return None
    return ExactSubspace(
        channels_T=at.T,
        U=PolynomialMatrix.from_matrices(*U),
        V=PolynomialMatrix.from_matrices(*(M for M in V if M is not None)),
        pivots=at.pivots,
        deficiency=lost,
    )


def _columns(columns: Sequence[Sequence[int]], n: int, denominator: int) -> Matrix:
    """The matrix with these columns over a denominator."""
    size = len(columns)
    cells = sorted(
        (i * size + j, x) for j, column in enumerate(columns) for i, x in enumerate(column) if x
    )
    places, values = [cell for cell, _ in cells], [x for _, x in cells]
    return from_cells((n, size), places, values, denominator)


def _nonzero_rows(M: Matrix) -> tuple[list[int], Matrix]:
    """The rows of a sparse matrix that are not 0, and their numbers."""
    rows = sorted({i for i, _, _ in M.nonzero()})
    return rows, M.take(rows=rows)


def _solution(B: Matrix, right: Matrix) -> Matrix | None:
    """The V with B V = right, 0 in the rows of columns that depend on others; None without one."""
    rows, kept = _nonzero_rows(B)
    V = solve(kept, right.take(rows=rows))
    return V if V is not None and (B @ V - right).is_zero() else None


# Annihilators of what channels control.


def annihilator(system: MultiChannelSystem, size: int) -> tuple[Matrix, tuple[int, ...]] | None:
    """The W of ``size`` rows with WA = ZW and WB = 0, B all inputs; None if the search fails.

    Parameters
    ----------
    system : MultiChannelSystem
        Its closed loops are sparse, and its outputs such that all that is controlled is moved.
    size : int
        n − d, at least 1.

    Returns
    -------
    W : Matrix
        n − d rows; the columns ``pivots`` form the identity.
    pivots : tuple of int
    """
    if size > MOST_COLUMNS:
        return None
    rng = generator(system, "controllability")
    known: tuple[tuple[int, ...], list[list[int]], int] | None = None
    misses = 0
    for ell in islice(exact_primes(system, rng), affordable(system)):
        rows, pivots = _residues(system, size, ell, rng)
        if len(pivots) != size:
            misses += 1
            if misses == _MISSES:
                return None
            continue
        table: list[list[int]] = rows.tolist()
        if known is not None and known[0] == pivots:
            table, ell = combine(known[1], known[2], table, ell), known[2] * ell
        known = pivots, table, ell
        lifted = rationals(table, ell)
        W = None if lifted is None else _matrix(*lifted, system.n)
        if W is not None and _annihilates(system, W, pivots):
            return W, pivots
    return None


def _residues(
    system: MultiChannelSystem, size: int, ell: int, rng: random.Random
) -> tuple[Any, tuple[int, ...]]:
    """The row space of g(A_F) modulo ℓ, as far as one vector more than it should have shows it."""
    import numpy as np

    first, second = (drawn_loop(system, ell, rng) for _ in range(2))
    g = first.polynomial // first.polynomial.gcd(second.polynomial)
    turned = SparsePowers(first.powers.M.T.tocsr(), ell)
    drawn = [[rng.randrange(ell) for _ in range(size + 1)] for _ in range(system.n)]
    return row_echelon(turned.applied(g, np.array(drawn)).T, ell)


def _matrix(numerators: list[list[int]], denominator: int, n: int) -> Matrix:
    entries = [(i * n + j, x) for i, row in enumerate(numerators) for j, x in enumerate(row) if x]
    cells, values = [cell for cell, _ in entries], [x for _, x in entries]
    return from_cells((len(numerators), n), cells, values, denominator)


def _annihilates(system: MultiChannelSystem, W: Matrix, pivots: tuple[int, ...]) -> bool:
    image = W @ system.A
    stays = (image - image.take(cols=pivots) @ W).is_zero()
    return stays and (W @ system.input_matrix()).is_zero()


# Transfer graphs.

# Modulo small primes the checker adds up whole rows as long integers, a byte for each column.
_MODULI = (31, 61, 53)
# Modulo these a byte holds the sums of most rows.  An edge is missed at some powers more often.
_QUICK, _MORE_POWERS = (7, 11, 13), 24
# Up to this size the evidence is what dense matrices give.
_SMALL = 128
# The numbers of a table A^k B, in single precision, and the products of all of them.
_MOST_NUMBERS = 2**28
_MOST_PRODUCTS = 2**38


def is_large_and_sparse(system: MultiChannelSystem) -> bool:
    """Whether the structure of the matrices is looked at first."""
    return system.n > _SMALL and system.A.is_sparse


def is_connected(edges: Flags) -> bool:
    """Whether a graph, an entry for each edge, is strongly connected."""
    from scipy.sparse.csgraph import connected_components

    return len(edges) < 2 or connected_components(edges, connection="strong")[0] == 1


def edge_modulus(system: MultiChannelSystem, moduli: Sequence[int] = _MODULI) -> int | None:
    """The first prime that divides no denominator and keeps all sums exact, if there is one."""
    parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    longest = max((_longest_row(M) for M in parts), default=0)
    usable = (
        ell
        for ell in moduli
        if longest * (ell // 2 + 3) ** 2 < 2**24 and all(M.denominator % ell for M in parts)
    )
    return next(usable, None)


def _longest_row(M: Matrix) -> int:
    return max(Counter(i for i, _, _ in M.nonzero()).values(), default=0)


def reachable_pairs(system: MultiChannelSystem) -> Flags:
    """Whether a path leads from an input of j to an output of i: row j, column i."""
    import numpy as np

    reached, m = _reached(system), system.m
    pairs = np.zeros((m, m), dtype=np.bool_)
    for i, channel in enumerate(system.channels):
        mask = 0
        for b in {b for _, b, _ in channel.C.nonzero()}:
            mask |= reached[b]
        sources = np.frombuffer(mask.to_bytes(m // 8 + 1, "little"), dtype=np.uint8)
        pairs[:, i] = np.unpackbits(sources, bitorder="little")[:m]
    return pairs


def _reached(system: MultiChannelSystem) -> list[int]:
    """For each state the channels that drive it, over any path, as bits."""
    reached = [0] * system.n
    for j, channel in enumerate(system.channels):
        for a, _, _ in channel.B.nonzero():
            reached[a] |= 1 << j
    arcs = [(a, b) for a, b, _ in system.A.nonzero() if a != b]
    before: list[int] = []
    while reached != before:
        before = list(reached)
        for a, b in arcs:
            reached[a] |= reached[b]
        arcs.reverse()
    return reached


def edge_powers(
    system: MultiChannelSystem, enough: Callable[[Flags], bool]
) -> tuple[int, Integers] | None:
    """A modulus ℓ, and powers k with C_i A^k B_j ≠ 0 modulo ℓ for enough pairs, if they are found.

    Parameters
    ----------
    system : MultiChannelSystem
    enough : function
        Takes the pairs (j, i) that have a k, in row j and column i.

    Returns
    -------
    modulus : int
    powers : array
        −1 for pairs without a k.  ℓ is one of those that are checked quickest, where so small a
        one shows enough pairs in a few powers more than a larger one.
    """
    ell, short = edge_modulus(system), edge_modulus(system, _QUICK)
    if ell is None:
        return None
    powers = sparse_powers(system, ell, enough)
    if not enough(powers >= 0):
        return None
    if short is not None:
        others = sparse_powers(system, short, enough, int(powers.max()) + _MORE_POWERS)
        if enough(others >= 0):
            return short, others
    return ell, powers


def sparse_powers(
    system: MultiChannelSystem,
    ell: int,
    enough: Callable[[Flags], bool],
    limit: int | None = None,
) -> Integers:
    """The least k with C_i A^k B_j ≠ 0 modulo ℓ in row j and column i, −1 where there is none.

    Parameters
    ----------
    system : MultiChannelSystem
    ell : int
        One of the moduli of `edge_modulus`.
    enough : function
        Takes the pairs that have a k, each time that there are more, and ends the search.
    limit : int, optional
        How many powers are tried, if not n.

    Raises
    ------
    LimitReached
        If the tables are too large.
    """
    import numpy as np

    channels, n = system.channels, system.n
    loop = SparseLoop(system.A, [c.B for c in channels], [c.C for c in channels], ell)
    width = loop.inputs[-1]
    if n * width > _MOST_NUMBERS:
        raise LimitReached(f"{n} states and {width} inputs have too many Markov parameters")
    V = loop.B.toarray().astype(np.float32)
    A, seen = loop.A.astype(np.float32), _observed(loop)
    powers = np.full((system.m, system.m), -1, dtype=np.int64)
    most = _MOST_PRODUCTS // max(loop.A.nnz * width + n, 1)
    for k in range(min(n, most + 1, n if limit is None else limit)):
        if k:
            V = reduce(A @ V, ell)
        new = seen(V) & (powers < 0)
        if new.any():
            powers[new] = k
            if enough(powers >= 0):
                break
    return powers


def _observed(loop: SparseLoop) -> Callable[[Any], Flags]:
    """A function of A^k B: which channels j (rows) act on which channels i (columns)."""
    import numpy as np

    C = loop.C.astype(np.float32)
    outputs, inputs = _members(loop.outputs), _members(loop.inputs)

    def seen(V: Any) -> Flags:
        nonzero = (reduce(C @ V, loop.ell) % loop.ell != 0).astype(np.float32)
        pairs: Flags = (outputs @ nonzero @ inputs.T).T > 0
        return pairs

    return seen


def _members(offsets: list[int]) -> Any:
    """A row for each channel, 1 in the columns of its inputs or outputs."""
    import numpy as np
    import scipy.sparse as sp

    owners = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    shape = len(offsets) - 1, len(owners)
    return sp.csr_array((np.ones(len(owners), np.float32), (owners, np.arange(len(owners)))), shape)
