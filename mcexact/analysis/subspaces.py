"""Shrunk subspaces, which prove that a mode is fixed, and the search for them.

A set T of channels and U, V over K = Q[x]/(p) with

    (xI − A) U = B_T V,   C_i U = 0 for every i outside T,   U has more columns than rank B_T

prove that every root of p is fixed: for every F, λI − A_F maps im U into the smaller im B_T.
So does such a U of the dual system (A', C_i', B_i'), for the complement s of T: it has
rank C_s + d columns where that of T has rank B_T + d, d the deficiency of P_s.

- `obstruction_modulo` decides one point μ modulo a prime: gains are repaired until μI − A_F has the
  greatest rank.  It then is nonsingular, so μ is not fixed, or the limit of a Wong sequence, one
  reduction of [N, B] with N = μI − A_F, is the least T.  No subset of channels is enumerated.
- `shrunk_subspace` takes T from a root of p modulo a prime, and computes the smaller one of both
  subspaces over K, which is itself the proof.
- `decide` finds all fixed factors: for drawn gains the common divisor of χ_A and χ_{A_F} modulo
  primes is lifted to Q and factored, and each factor has a shrunk subspace or is dropped.  It ends
  when the remaining factor of χ_A is coprime to χ_{A_F}, which proves that nothing else is fixed.
  Without fixed modes that takes two characteristic polynomials modulo one prime.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from mcexact.answer.evidence import DualSubspace, ShrunkSubspace
from mcexact.derived.constructions import dual
from mcexact.derived.modular import (
    Gains,
    ModularSystem,
    closed_loop,
    drawn_gains,
    loop_polynomials,
    quick_bits,
    residue_systems,
)
from mcexact.errors import InternalError
from mcexact.exact.linear_algebra import (
    PolynomialMatrix,
    characteristic_polynomial,
    nullspace_at,
    rank,
    row_echelon,
)
from mcexact.exact.matrix import Matrix, block
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    combine,
    hstack,
    integers,
    polynomial_residues,
)
from mcexact.exact.polynomial import Polynomial, from_integer_coefficients, product
from mcexact.model.system import MultiChannelSystem

# Shrunk subspaces for one factor, from Wong sequences modulo a prime.


@dataclass(frozen=True)
class ModularObstruction:
    """A shrunk subspace at one point μ modulo ℓ.

    Attributes
    ----------
    channels_T : tuple of int
        The least T for which rank P_s(μ) is least, s its complement.
    deficiency : int
        n − rank P_s(μ), the dimension of the null space of μI − A_F for the gains below; at
        least 1.
    gains : tuple
        F of greatest rank of μI − A_F modulo ℓ.
    """

    channels_T: tuple[int, ...]
    deficiency: int
    gains: Gains


@dataclass(frozen=True)
class _Echelon:
    """The result of reducing [N, B], N = μI − A_F.

    ``null_space`` is n × (n − rank N).  ``images`` lists, for each column of B, whether N x = b has
    a solution; column j of ``solutions`` (n × Σ p_i) is one, or 0 where there is none.
    """

    null_space: ModularMatrix
    images: list[bool]
    solutions: ModularMatrix


def obstruction_modulo(modular: ModularSystem, gains: Gains, mu: int) -> ModularObstruction | None:
    """Decide whether μ is fixed modulo ℓ, over the field with ℓ elements.

    Parameters
    ----------
    modular : ModularSystem
    gains : tuple
        Initial gains; uniform ones almost never need a repair.
    mu : int
        A residue modulo ℓ.

    Returns
    -------
    ModularObstruction or None
        None if μI − A_F is nonsingular for some F.

    Notes
    -----
    Start with U = ker N and repeat T = {i : C_i U ≠ 0}, U = N⁻¹(im B_T), until T is stable.  With
    one solution X_j of N X_j = B_j for every channel j, N⁻¹(im B_T) is ker N + Σ_{j∈T} im X_j, so
    the whole sequence is one reduction of [N, B] and a search in the graph with an edge from j to
    i wherever C_i X_j ≠ 0.  Where some B_i with i ∈ T is not in im N, F is not of greatest rank,
    and a change of rank one in F_i repairs it: at level 0 the rank grows, at level k the null
    space stays and the violation moves to a lower level.  So at most n rounds of at most m changes.
    """
    n, m = modular.system.n, modular.system.m
    for _ in range((n + 1) * (m + 1)):
        echelon = _reduce(modular, gains, mu)
        if echelon.null_space.ncols == 0:
            return None
        T, repair = _wong_sequence(modular, echelon)
        if repair is None:
            return ModularObstruction(T, echelon.null_space.ncols, gains)
        gains = _repaired(gains, *repair, modular.modulus)
    message = "the repair of the gains did not end within n(m+1) changes"
    raise InternalError(message)


def _reduce(modular: ModularSystem, gains: Gains, mu: int) -> _Echelon:
    """Row-reduce [μI − A_F, B] once and read off null space and solutions."""
    ell, n = modular.modulus, modular.system.n
    N = ModularMatrix.scalar(n, mu, ell) - closed_loop(modular, gains)
    width = modular.B.ncols
    reduced, pivots = hstack([N, modular.B]).rref()
    rows = reduced.rows()
    bound = [j for j in pivots if j < n]
    free = sorted(set(range(n)) - set(bound))
    null_space = [[0] * len(free) for _ in range(n)]
    for k, f in enumerate(free):
        null_space[f][k] = 1
    solutions = [[0] * width for _ in range(n)]
    below = rows[len(bound) : len(pivots)]
    images = [not any(row[n + j] for row in below) for j in range(width)]
    for row, position in zip(rows, bound, strict=False):
        null_space[position] = [-row[f] % ell for f in free]
        solutions[position] = [
            v if inside else 0 for v, inside in zip(row[n:], images, strict=True)
        ]
    return _Echelon(
        ModularMatrix.from_rows(null_space, ell, ncols=len(free)),
        images,
        ModularMatrix.from_rows(solutions, ell, ncols=width),
    )


def _wong_sequence(
    modular: ModularSystem, echelon: _Echelon
) -> tuple[tuple[int, ...], tuple[int, int, int] | None]:
    """The limit T of the Wong sequence, or the first repair (channel, input, output) it needs."""
    m = modular.system.m
    # The output row of channel i by which the sequence reached i; None: not reached.
    reached: list[int | None] = [None] * m
    outputs = (modular.C @ echelon.null_space).rows()
    level = []
    for i in range(m):
        for r in modular.outputs[i]:
            if any(outputs[r]):
                reached[i] = r - modular.outputs[i].start
                level.append(i)
                break
    passed = (modular.C @ echelon.solutions).rows()
    while level:
        for i in level:
            for j in modular.inputs[i]:
                if not echelon.images[j]:
                    row = reached[i]
                    if row is None:
                        raise InternalError("a channel of the Wong sequence has no output row")
                    return (), (i, j - modular.inputs[i].start, row)
        columns = [j for i in level for j in modular.inputs[i]]
        following = []
        for i in range(m):
            if reached[i] is None:
                for r in modular.outputs[i]:
                    if any(passed[r][j] for j in columns):
                        reached[i] = r - modular.outputs[i].start
                        following.append(i)
                        break
        level = following
    return tuple(i for i in range(m) if reached[i] is not None), None


def _repaired(gains: Gains, channel: int, row: int, column: int, ell: int) -> Gains:
    """Add 1 to one entry of F_i, so that N becomes N − bc."""
    F = [list(entries) for entries in gains[channel]]
    F[row][column] = (F[row][column] + 1) % ell
    changed = tuple(tuple(entries) for entries in F)
    return (*gains[:channel], changed, *gains[channel + 1 :])


@dataclass(frozen=True)
class ExactSubspace:
    """A shrunk subspace over Q[x]/(p).

    Attributes
    ----------
    channels_T : tuple of int
    U : PolynomialMatrix
        n × u, u = rank B_T + deficiency; its rows ``pivots`` form the identity.
    V : PolynomialMatrix
        p_T × u.
    pivots : tuple of int
    deficiency : int
        At least 1.
    dual : bool
        Whether U, V and the pivots are those of the dual system, for the complement of T.
    """

    channels_T: tuple[int, ...]
    U: PolynomialMatrix
    V: PolynomialMatrix
    pivots: tuple[int, ...]
    deficiency: int
    dual: bool = False


def shrunk_subspace(
    system: MultiChannelSystem,
    p: Polynomial,
    rng: random.Random,
    *,
    first: ModularSystem | None = None,
) -> ExactSubspace | None:
    """Find a proof that the roots of p are fixed, or None if they are not.

    Parameters
    ----------
    system : MultiChannelSystem
    p : Polynomial
        Monic and irreducible over Q.
    rng : random.Random
    first : ModularSystem, optional
        The system modulo a prime that is tried first.

    Returns
    -------
    ExactSubspace or None
        For the least T, with deficiency n − min rank P_s(λ); None if no root of p is fixed.

    Notes
    -----
    T is that of a root of p modulo a prime where p has one.  Gains that make μI − A_F nonsingular
    there make λI − A_F nonsingular, so the answer None is proved.  The subspace is computed over
    Q[x]/(p), and is itself a proof.  If T or the deficiency is wrong for a prime, the next prime is
    tried.
    """
    known = () if first is None else (first,)
    for modular in itertools.chain(known, residue_systems(system, rng)):
        roots = polynomial_residues(p, modular.modulus).roots()
        if not roots:
            continue
        obstruction = obstruction_modulo(modular, drawn_gains(modular, rng), min(roots))
        if obstruction is None:
            return None
        exact = smaller_subspace(system, obstruction.channels_T, p)
        if exact is not None and exact.deficiency == obstruction.deficiency:
            return exact
    raise InternalError("the stream of primes is endless")


def exact_subspace(
    system: MultiChannelSystem, T: Sequence[int], p: Polynomial
) -> ExactSubspace | None:
    """The whole null space of [−B_T, xI − A; 0, C_{m−T}] over Q[x]/(p), as a shrunk subspace.

    Parameters
    ----------
    system : MultiChannelSystem
    T : sequence of int
        Channels, ascending.
    p : Polynomial
        Monic and irreducible.

    Returns
    -------
    ExactSubspace or None
        None if the null space has at most rank B_T columns, so that T proves nothing about p.

    Notes
    -----
    Columns of B_T that depend on others are left out (their rows of V are 0), so V is determined
    by U, every free column of the elimination is a row of U, and these rows carry the identity.
    """
    n = system.n
    rest = complement(system.m, T)
    B, C = system.input_matrix(T), system.output_matrix(rest)
    _, independent = row_echelon(B)
    b = len(independent)
    constant = block(
        [
            [-B.take(cols=independent), -system.A],
            [Matrix.zeros(C.nrows, b), C],
        ]
    )
    shift = block(
        [
            [Matrix.zeros(n, b), Matrix.identity(n)],
            [Matrix.zeros(C.nrows, b), Matrix.zeros(C.nrows, n)],
        ]
    )
    null_space, pivots = nullspace_at(constant, shift, p)
    if len(pivots) <= b:
        return None
    spread = Matrix.from_integers(
        [[int(j == k) for k in independent] for j in range(B.ncols)], ncols=b
    )
    return ExactSubspace(
        channels_T=tuple(T),
        U=null_space.take(rows=range(b, b + n)),
        V=spread @ null_space.take(rows=range(b)),
        pivots=tuple(pivot - b for pivot in pivots),
        deficiency=len(pivots) - b,
    )


def complement(m: int, channels: Iterable[int]) -> tuple[int, ...]:
    """The channels that are not in a set of channels."""
    listed = set(channels)
    return tuple(i for i in range(m) if i not in listed)


def smaller_subspace(
    system: MultiChannelSystem, T: Sequence[int], p: Polynomial
) -> ExactSubspace | None:
    """`exact_subspace` of the system, or of its dual where that has fewer columns."""
    rest = complement(system.m, T)
    if rank(system.output_matrix(rest)) >= rank(system.input_matrix(T)):
        return exact_subspace(system, T, p)
    turned = exact_subspace(dual(system), rest, p)
    return None if turned is None else replace(turned, channels_T=tuple(T), dual=True)


def evidence(names: Sequence[str], subspace: ExactSubspace) -> ShrunkSubspace | DualSubspace:
    """Make the evidence of a shrunk subspace of a system with these channels, or of its dual."""
    T = subspace.channels_T
    own = complement(len(names), T) if subspace.dual else T
    space = plain_evidence(names, replace(subspace, channels_T=own))
    return DualSubspace(tuple(names[i] for i in T), space) if subspace.dual else space


def plain_evidence(names: Sequence[str], subspace: ExactSubspace) -> ShrunkSubspace:
    """Make the evidence of a shrunk subspace in the system that it is about."""
    T = tuple(names[i] for i in subspace.channels_T)
    return ShrunkSubspace(T, subspace.U, subspace.V, subspace.pivots)


# The search for all fixed factors.


@dataclass(frozen=True)
class Obstruction:
    """An irreducible factor of χ_A that is fixed, with a proof.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic and irreducible.
    multiplicity_in_A : int
        The exponent of p in χ_A.
    subspace : ExactSubspace
        A shrunk subspace for the least T, with the largest deficiency.
    """

    polynomial: Polynomial
    multiplicity_in_A: int
    subspace: ExactSubspace


@dataclass(frozen=True)
class Decision:
    """All fixed factors of a system, and gains that move all others.

    Attributes
    ----------
    modular : ModularSystem
        The system modulo ℓ.
    gains : tuple
        F modulo ℓ: χ_A / Π p^a and χ_{A_F} are coprime modulo ℓ.
    closed : ModularPolynomial
        χ_{A_F} modulo ℓ.
    obstructions : tuple of Obstruction
        Sorted by degree, then by coefficients.
    """

    modular: ModularSystem
    gains: Gains
    closed: ModularPolynomial
    obstructions: tuple[Obstruction, ...]


def decide(system: MultiChannelSystem, rng: random.Random) -> Decision:
    """Find all fixed factors of a system, with the evidence.

    Parameters
    ----------
    system : MultiChannelSystem
    rng : random.Random
        The source of primes and gains, which affects the running time but not the answer.

    Notes
    -----
    F is uniform modulo a prime.  If no mode is fixed, χ_A and χ_{A_F} are nearly always coprime
    modulo the prime, and the search ends after these two characteristic polynomials.  For many
    states the prime has some 22 bits (see `mcexact.exact.krylov`). Otherwise their common factors
    modulo one or more primes are lifted to a factor of χ_A over Q, which is factored; from then on
    primes have 61 bits, so that the exponents in χ_{A_F} are nearly always the least ones.  Each
    irreducible factor has a shrunk subspace or is dropped.  The search ends when the remaining
    factor of χ_A is coprime to χ_{A_F}.
    """
    lift: CommonFactor | None = None
    known: dict[Polynomial, ExactSubspace | None] = {}
    quick = itertools.islice(residue_systems(system, rng, quick_bits(system)), 1)
    for modular in itertools.chain(quick, residue_systems(system, rng, bits=61)):
        gains = drawn_gains(modular, rng)
        opened, closed = loop_polynomials(modular, gains)
        common = opened.gcd(closed)
        if common.degree == 0:
            return Decision(modular, gains, closed, ())
        if modular.modulus < 2**30:
            continue
        if lift is None:
            lift = CommonFactor(characteristic_polynomial(system.A), system.A.denominator)
        candidate = lift.lifted(common)
        if candidate is None:
            continue
        obstructions = []
        for p, _ in candidate.factor():
            if p not in known:
                known[p] = shrunk_subspace(system, p, rng, first=modular)
            subspace = known[p]
            if subspace is not None:
                obstructions.append(
                    Obstruction(p, p.multiplicity_in(lift.characteristic), subspace)
                )
        if _rest_is_free(lift.characteristic, closed, obstructions):
            obstructions.sort(key=lambda o: (o.polynomial.degree, o.polynomial.coefficients))
            return Decision(modular, gains, closed, tuple(obstructions))
    raise InternalError("the stream of primes is endless")


class CommonFactor:
    """The factor of χ_A that all closed loops share, collected from its residues."""

    def __init__(self, characteristic: Polynomial, denominator: int) -> None:
        self.characteristic = characteristic
        self._denominator = denominator
        self._residues: list[int] = []
        self._modulus = 1

    def lifted(self, common: ModularPolynomial) -> Polynomial | None:
        """A monic factor of χ_A with the residues seen so far, if they determine one.

        Notes
        -----
        With A = N/d, N integer, d^k times the coefficient of x^{deg−k} is an integer: symmetric
        residues of these are the candidates.  Only the gcds of least degree count, since a gcd
        has more only by accident.
        """
        degree, ell, d = common.degree, common.modulus, self._denominator
        scaled = [c * pow(d, degree - k, ell) % ell for k, c in enumerate(common.coefficients)]
        if not self._residues or degree < len(self._residues) - 1:
            self._residues, self._modulus = scaled, ell
        elif degree == len(self._residues) - 1:
            [self._residues] = combine([self._residues], self._modulus, [scaled], ell)
            self._modulus *= ell
        else:
            return None
        values = integers(self._residues, self._modulus)
        size = len(values) - 1
        candidate = from_integer_coefficients(
            [value * d**k for k, value in enumerate(values)], d**size
        )
        return candidate if candidate.divides(self.characteristic) else None


def _rest_is_free(
    characteristic: Polynomial, closed: ModularPolynomial, obstructions: list[Obstruction]
) -> bool:
    """Whether χ_A / Π p^a and χ_{A_F} are coprime modulo ℓ, and the p are, pairwise."""
    ell = closed.modulus
    rest = characteristic // product(o.polynomial**o.multiplicity_in_A for o in obstructions)
    if polynomial_residues(rest, ell).gcd(closed).degree > 0:
        return False
    residues = [polynomial_residues(o.polynomial, ell) for o in obstructions]
    return all(p.gcd(q).degree == 0 for p, q in itertools.combinations(residues, 2))
