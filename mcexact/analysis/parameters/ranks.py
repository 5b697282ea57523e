"""Ranks of matrices of polynomials for all values of parameters.

The matrices are built by name from those of a plant: [A, B; C, 0] for set-points and its extension
for signals, [B, AB, …] for controllability, and the columns C_i A^k B_j of a transfer matrix.  The
denominators of the entries are cleared first (`Entries`), which keeps the rank.

- One parameter (`parametric_rank`): the roots of one minor of full order are the candidates for a
  lower rank.  Each irreducible factor is decided modulo a prime, and proved by a null space over
  its number field; a second, drawn minor modulo a prime proves that no other value counts.  The
  answer holds for every complex value at which all entries of the plant are defined.
- Several parameters (`rank_hypersurfaces`): the rank for almost all values, and the hypersurfaces
  on which it is less.  The irreducible factors of one minor are the candidates.  Drawn lines
  through the space of parameters decide which of them count (`confirming_lines`): along a line
  there is one parameter, so everything is proved for all its values.

`setpoint_rank`, `signal_solvability` and `indices_for_all_values` apply these to the questions of
analysis.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, TypeVar

from mcexact.answer.evidence import RootDisc
from mcexact.answer.parameters import (
    ControllabilityMatrix,
    Kernel,
    LowerRank,
    OutsideValue,
    ParametricFixedSpectrum,
    ParametricRank,
    SetpointMatrix,
    SignalMatrix,
    TransferColumn,
    TwoMinors,
    meets,
)
from mcexact.answer.several_parameters import A, Hypersurface, Line, RankHypersurfaces
from mcexact.derived.constructions import along_line, dual, points_of, rearranged
from mcexact.derived.modular import PolynomialSystem, generator
from mcexact.errors import InputError, InternalError, LimitReached
from mcexact.exact import rational_functions
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import ModularMatrix, polynomial_residues, primes
from mcexact.exact.parametric_polynomials import (
    Basis,
    determinant,
    determinant_modulo,
    generic_nullspace,
    nullspace_over_field,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import (
    FunctionMatrix,
    RationalFunction,
    Rows,
    cleared,
    irreducible_factors,
    polynomial_matrix,
)
from mcexact.exact.roots import root_discs, steady_point
from mcexact.model.parametric import ParametricSystem

# Matrices built by name from those of a system, over the polynomials in its parameters.

Named = SetpointMatrix | SignalMatrix | ControllabilityMatrix | TransferColumn


@dataclass(frozen=True)
class Entries:
    """The entries of A', B_i' and C_i', which are polynomials in the parameters.

    Attributes
    ----------
    names : sequence of str
        The channels.
    A, B, C
        The rows of A', and of each B_i' and C_i'.
    widths : sequence of int
        The number of columns of each B_i'.
    scale : polynomial
        δ.
    steady : int
        The mode of constant signals: 0, or in discrete time 1.
    zero : polynomial
    """

    names: Sequence[str]
    A: Rows
    B: Sequence[Rows]
    C: Sequence[Rows]
    widths: Sequence[int]
    scale: Any
    steady: int
    zero: Any

    @classmethod
    def of(cls, system: ParametricSystem) -> Entries:
        """The entries of a system with one parameter or several."""
        names = system.parameters
        A, scale = cleared(system.A, names)
        return cls(
            names=system.names,
            A=A,
            B=[cleared(c.B, names)[0] for c in system.channels],
            C=[cleared(c.C, names)[0] for c in system.channels],
            widths=[c.B.ncols for c in system.channels],
            scale=scale,
            steady=steady_point(system.time),
            zero=rational_functions.ring(names).constant(0),
        )

    def matrix(self, named: Named) -> Rows:
        """The rows of a matrix, the rank of which is that of the same matrix from A, B_i, C_i."""
        if isinstance(named, ControllabilityMatrix):
            return self._controllability(named)
        if isinstance(named, TransferColumn):
            return self._transfer(named)
        p = Polynomial.of(-self.steady, 1)
        return self._signal(named.polynomial if isinstance(named, SignalMatrix) else p)

    def columns(self, named: Named) -> int:
        """How many columns it has."""
        if isinstance(named, TransferColumn):
            return 1
        if isinstance(named, ControllabilityMatrix):
            pairs = zip(self.names, self.widths, strict=True)
            return named.blocks * sum(width for name, width in pairs if name in named.channels)
        times = named.polynomial.degree if isinstance(named, SignalMatrix) else 1
        return times * (len(self.A) + sum(self.widths))

    def _product(self, M: Rows, N: Rows) -> Rows:
        return rational_functions.product(M, N, self.zero)

    def _signal(self, p: Polynomial) -> Rows:
        """[I⊗A' − K⊗δI, I⊗B'; I⊗C', 0], K the companion matrix of p."""
        d, n, width = p.degree, len(self.A), sum(self.widths)
        inputs = [[entry for M in self.B for entry in M[k]] for k in range(n)]
        outputs = [row for M in self.C for row in M]
        upper, lower = [], []
        for i in range(d):
            for k, row in enumerate(self.A):
                entries = [self.zero] * (d * (n + width))
                entries[i * n : (i + 1) * n] = row
                if i:
                    entries[(i - 1) * n + k] = entries[(i - 1) * n + k] - self.scale
                last = (d - 1) * n + k
                c = p.coefficients[i]
                entries[last] = entries[last] + self.scale * c.numerator / c.denominator
                entries[d * n + i * width : d * n + (i + 1) * width] = inputs[k]
                upper.append(entries)
            for row in outputs:
                entries = [self.zero] * (d * (n + width))
                entries[i * n : (i + 1) * n] = row
                lower.append(entries)
        return upper + lower

    def _controllability(self, named: ControllabilityMatrix) -> Rows:
        chosen = [B for B, name in zip(self.B, self.names, strict=True) if name in named.channels]
        power = [[entry for M in chosen for entry in M[k]] for k in range(len(self.A))]
        rows: Rows = [[] for _ in self.A]
        for _ in range(named.blocks):
            rows = [row + more for row, more in zip(rows, power, strict=True)]
            power = self._product(self.A, power)
        return rows

    def _transfer(self, named: TransferColumn) -> Rows:
        power = self.B[self.names.index(named.source)]
        outputs, markov = self.C[self.names.index(named.to)], []
        for _ in self.A:
            columns = zip(*self._product(outputs, power), strict=True)
            markov += [[entry] for column in columns for entry in column]
            power = self._product(self.A, power)
        return markov


# One parameter: a minor of full order, null spaces, and a second minor.

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
    which it has a root, and a lower rank is proved by a null space over its number field.  A
    second, drawn minor modulo a prime proves that the rank is lower at no other value.
    """
    return _Search(PolynomialSystem(system), matrix).answer()


class _Search:
    """One minor, the loss of rank at its roots, and a second minor with no other common root."""

    def __init__(self, system: PolynomialSystem, matrix: Named) -> None:
        self.system, self.matrix = system, matrix
        self.rng = generator(system.system, "parametric_rank")
        entries = Entries.of(system.system)
        self.M = polynomial_matrix(entries.matrix(matrix), entries.columns(matrix))
        self.stream = primes(self.rng.getrandbits(64), _BITS)

    def answer(self) -> ParametricRank:
        """The answer."""
        above, beside = self._pivots()
        rank, bounds = len(above), self.system.system.ranges[0]
        minor = determinant(self.M.take(rows=above, cols=beside))
        factors = [q for q, _ in minor.factor()]
        undefined = [q for q in factors if q in self.system.poles]
        lost = [q for q in factors if q not in self.system.poles and self._rank_at(q) < rank]
        discs = {q: tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(q)) for q in lost}
        outside = [
            q
            for q in lost
            if bounds != (None, None) and not any(meets(disc, bounds) for disc in discs[q])
        ]
        exceptional = [q for q in lost if q not in outside]
        null_spaces = [_witness(nullspace_over_field([self.M], q)) for q in exceptional]
        ranks = [self.M.ncols - len(each.pivots) for each in null_spaces]
        rest = _without(minor, [*lost, *undefined])
        full = rank == min(self.M.shape)
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
                kernel=None if full else _witness(generic_nullspace([self.M])),
                rows=above,
                columns=beside,
                modulus=ell,
                compressions=(X_, Y),
                exceptional=tuple(null_spaces),
                undefined=tuple(undefined),
            ),
        )

    def _pivots(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Rows and columns of a minor of full order that is not 0."""
        ell = next(ell for ell in self.stream if self.M.denominator % ell)
        value = self.M.at_residue(self.rng.randrange(ell), ell)
        columns = tuple(value.rref()[1])
        return tuple(value.take(cols=columns).T.rref()[1]), columns

    def _rank_at(self, q: Polynomial) -> int:
        """The rank at a root of q modulo a prime, which is nearly always that at a root of q."""
        for ell in self.stream:
            if self.M.denominator % ell == 0 or q.denominator % ell == 0:
                continue
            for root in polynomial_residues(q, ell).roots():
                return self.M.at_residue(root, ell).rank()
        raise InternalError("no prime has a root of the polynomial")

    def _drawn(
        self, rank: int, rest: Polynomial, values: list[tuple[Polynomial, int]]
    ) -> tuple[int, Matrix, Matrix]:
        """A prime, and X and Y whose minors have no other root in common with the first one."""
        for attempt in range(1, _DRAWS):
            ell = next(self.stream)
            denominators = [
                self.M.denominator,
                rest.denominator,
                *(q.denominator for q, _ in values),
            ]
            if any(d % ell == 0 for d in denominators):
                continue
            X_, Y = (
                Matrix.from_integers(
                    [[self.rng.randint(-attempt, attempt) for _ in range(c)] for _ in range(r)],
                    ncols=c,
                )
                for r, c in ((rank, self.M.nrows), (self.M.ncols, rank))
            )
            small = X_ @ self.M @ Y
            corners = ((q, small.take(rows=range(r), cols=range(r))) for q, r in values)
            if all(
                polynomial_residues(p, ell).gcd(determinant_modulo(M, ell)).degree == 0
                for p, M in [(rest, small), *corners]
            ):
                return ell, X_, Y
        raise InternalError("no drawn minors have a root in common where the rank is less")


def _witness(basis: Basis) -> Kernel:
    pivots, (columns,) = basis
    return Kernel(columns, pivots)


def _without(p: Polynomial, factors: Iterable[Polynomial]) -> Polynomial:
    """p divided by each factor as often as this divides it, and by its leading coefficient."""
    for q in factors:
        for _ in range(q.multiplicity_in(p)):
            p //= q
    return p.monic()


# Several parameters: lines along which candidates are proved to be exceptional.

DRAWS = 60
"""How often gains or minors are drawn."""
_LINES = 2
"""The number of lines along which the answer is proved."""
Along = ParametricFixedSpectrum | ParametricRank
Confirmed = dict[RationalFunction, list[Any]]
"""The exceptional values of all lines on each hypersurface."""


def confirming_lines(
    about: ParametricSystem,
    decide: Callable[[ParametricSystem], A],
    is_generic: Callable[[A], bool],
    candidates: Sequence[RationalFunction],
    rng: random.Random,
) -> tuple[tuple[Line[A], ...], Confirmed] | None:
    """Draw lines along which the candidates are the exceptional values, or some of them are.

    Parameters
    ----------
    about : ParametricSystem
    decide : callable
        Answers the question about the system along a line, with a proof.
    is_generic : callable
        Whether the generic answer along a line is the generic answer for all parameters.
    candidates : sequence of RationalFunction
    rng : random.Random

    Returns
    -------
    tuple or None
        The lines, and the candidates that are exceptional; None if lines disagree.
    """
    lines: list[Line[A]] = []
    confirmed: Confirmed = {}
    for attempt in range(_LINES + 2):
        try:
            line = _line(about, rng, 3 + attempt)
        except InputError:
            continue
        at = points_of(line)
        met = {h: _values(h, at) for h in candidates}
        if any(values & {*line.poles} for values in met.values()):
            continue  # nothing is claimed where an entry is undefined
        answer = decide(line)
        on_line = _confirmed(answer, met)
        if on_line is None or not is_generic(answer):
            continue
        if lines and on_line.keys() != confirmed.keys():
            return None
        for h, values in on_line.items():
            confirmed.setdefault(h, []).extend(values)
        lines.append(Line(at, answer))
        if len(lines) == _LINES:
            return tuple(lines), confirmed
    return None


def poles(parts: Collection[FunctionMatrix], names: tuple[str, ...]) -> set[RationalFunction]:
    """The irreducible factors of the denominators of matrices."""
    return {q for M in parts for q in irreducible_factors(cleared(M, names)[1], names)}


def in_order(surfaces: Collection[RationalFunction]) -> list[RationalFunction]:
    """Polynomials in parameters in a fixed order, those of low degree first."""
    return sorted(surfaces, key=lambda h: (int(h.numerator.total_degree()), str(h)))


def _line(about: ParametricSystem, rng: random.Random, size: int) -> ParametricSystem:
    """The system on a line through a drawn point in a drawn direction.

    Raises
    ------
    InputError
        If an entry is undefined on all of the line.
    """
    slopes = [k for k in range(-size, size + 1) if k]
    drawn = {name: (rng.choice(slopes), rng.randint(-size, size)) for name in about.parameters}
    point, direction = ({name: ends[k] for name, ends in drawn.items()} for k in (1, 0))
    return along_line(about, point, direction, _letter(about.parameters))


def _letter(parameters: Collection[str]) -> str:
    """The parameter of the lines, which is none of the system: s, or s1, s2, …"""
    letters = ("s" + str(k or "") for k in range(len(parameters) + 1))
    return next(s for s in letters if s not in parameters)


def _values(h: RationalFunction, at: Mapping[str, RationalFunction]) -> set[Polynomial]:
    """The values at which a line meets a hypersurface, as monic irreducible polynomials.

    The set is empty if all values do, or none: along such a line nothing is confirmed.
    """
    values = [at[name] for name in h.parameters]
    met = h.substituted(values, values[0] * 0).polynomials()[0]
    return set() if met.is_zero() else {q.monic() for q, _ in met.factor()}


def _confirmed(answer: Along, met: Mapping[RationalFunction, set[Polynomial]]) -> Confirmed | None:
    """The candidates that are exceptional; None if other values are exceptional as well."""
    exceptional = {each.value: each for each in answer.exceptional}
    if exceptional.keys() - set().union(*met.values()):
        return None
    confirmed: Confirmed = {}
    for h, values in met.items():
        if not values or 0 < len(values & exceptional.keys()) < len(values):
            return None
        if values <= exceptional.keys():
            confirmed[h] = [exceptional[q] for q in values]
    return confirmed


# Several parameters: the generic rank, and the hypersurfaces on which the rank is less.

_LINE_BITS = 61


def rank_for_all_values(
    system: ParametricSystem, matrix: Named
) -> ParametricRank | RankHypersurfaces:
    """Decide the rank of a matrix for all values of one parameter, or almost all of several."""
    if len(system.parameters) == 1:
        return parametric_rank(system, matrix)
    return rank_hypersurfaces(system, matrix)


def rank_hypersurfaces(
    system: ParametricSystem, matrix: Named, *, observed: bool = False
) -> RankHypersurfaces:
    """Decide the rank of a matrix for almost all values of parameters, and where it is less.

    Parameters
    ----------
    system : ParametricSystem
    matrix : SetpointMatrix, SignalMatrix, ControllabilityMatrix or TransferColumn
    observed : bool
        Whether the matrix is that of the dual system.

    Notes
    -----
    Exact.  Where the rank is less, one minor of full order is 0 that is not 0 everywhere: its
    irreducible factors are the candidates.  Of these, the ones are kept on which the rank is less
    along drawn lines, where it is proved for every value.
    """
    rng = generator(system, "rank_hypersurfaces")
    names = system.parameters
    entries = Entries.of(rearranged(system, dual) if observed else system)
    rows, width = entries.matrix(matrix), entries.columns(matrix)
    parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    undefined = poles(parts, names)
    for ell in islice(primes(rng.getrandbits(64), _LINE_BITS), DRAWS):
        above, beside = _pivots(rows, width, [rng.randrange(ell) for _ in names], ell)
        minor = [[rows[i][j] for j in beside] for i in above]
        candidates = irreducible_factors(rational_functions.determinant(minor, names), names)

        def is_generic(answer: ParametricRank, rank: int = len(above)) -> bool:
            return answer.rank == rank

        def decide(line: ParametricSystem) -> ParametricRank:
            return parametric_rank(rearranged(line, dual) if observed else line, matrix)

        left = [h for h in candidates if h not in undefined]
        result = confirming_lines(system, decide, is_generic, left, rng)
        if result is not None:
            break
    else:
        raise LimitReached("no drawn point has the rank of almost all")
    lines, confirmed = result
    return RankHypersurfaces(
        about=system,
        hypersurfaces=tuple(
            Hypersurface(h, rank=max(value.rank for value in confirmed[h]))
            for h in in_order(confirmed)
        ),
        undefined_at=tuple(in_order(undefined)),
        lines=lines,
        matrix=matrix,
        rank=len(above),
    )


def _pivots(
    rows: Rows, width: int, point: list[int], ell: int
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Rows and columns of a minor of full order that is not 0 at a point modulo a prime."""

    def residue(entry: Any) -> int:
        value = rational_functions.value(entry, point)
        return int(value.p) * pow(int(value.q), -1, ell) % ell

    table = [[residue(entry) for entry in row] for row in rows]
    value = ModularMatrix.from_rows(table, ell, ncols=width)
    columns = tuple(value.rref()[1])
    return tuple(value.take(cols=columns).T.rref()[1]), columns


# Set-points and controllability indices for all values of one parameter or several.

R = TypeVar("R", ParametricRank, RankHypersurfaces)


def parametric_setpoints(system: ParametricSystem) -> ParametricRank:
    """The rank of [A, B; C, 0], or [A − I, B; C, 0], for all values of a parameter.

    Examples
    --------
    >>> plant = ParametricSystem([[-1]], [[["1 - t"]]], [[[1]]], parameters=["t"])
    >>> answer = parametric_setpoints(plant)
    >>> answer.words
    ('rank 2 for almost every t', 'rank 1 where t = 1')
    """
    return parametric_rank(system, SetpointMatrix())


def setpoint_rank(system: ParametricSystem) -> ParametricRank | RankHypersurfaces:
    """The rank of `parametric_setpoints`, for one parameter or several."""
    return rank_for_all_values(system, SetpointMatrix())


def signal_solvability(
    system: ParametricSystem, signal: Polynomial
) -> ParametricRank | RankHypersurfaces:
    """Decide for which values of parameters all outputs can track the signals of a polynomial.

    Parameters
    ----------
    system : ParametricSystem
    signal : Polynomial
        Its roots are the modes of the signals: s for steps and ramps, s² + ω² for sinusoids of the
        angular frequency ω, in discrete time z − 1 for steps.  Multiplicities do not matter.

    Returns
    -------
    ParametricRank or RankHypersurfaces
        The rank of [I⊗A − K⊗I, I⊗B; I⊗C, 0], K the companion matrix of the polynomial, of degree d:
        where it is d (n + Σ q_i), and nowhere else, [A − λI, B; C, 0] has independent rows at every
        root λ, so that every reference and every disturbance of these signals has a steady state.

    Notes
    -----
    Exact.  With one parameter the certificate is about all values; with several there is one along
    each line.

    Examples
    --------
    >>> A = [[0, 1, 0], [0, 0, 1], [-1, -3, -3]]
    >>> plant = ParametricSystem(A, [[[0], [0], [1]]], [[["t", 0, 1]]], parameters=["t"])
    >>> signal_solvability(plant, Polynomial.of(4, 0, 1)).words
    ('rank 8 for almost every t', 'rank 6 where t = 4')
    >>> signal_solvability(plant, Polynomial.of(0, 1)).words
    ('rank 4 for almost every t', 'rank 3 where t = 0')
    """
    InputError.require(system, ParametricSystem, "system")
    InputError.require(signal, Polynomial, "signal")
    if signal.degree < 1:
        raise InputError(f"expected a polynomial with roots, found {signal}", where="signal")
    return rank_for_all_values(system, SignalMatrix(signal.monic()))


def parametric_indices(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, observed: bool = False
) -> tuple[ParametricRank, ...]:
    """The ranks of [B_T, A B_T, …, A^(k−1) B_T] for k = 1, 2, …, until none grows at any value.

    Parameters
    ----------
    system : ParametricSystem
    channels : iterable of str, optional
        T, by default all.
    observed : bool
        Whether to use the dual system: then these are ranks of observability.

    Returns
    -------
    tuple of ParametricRank
        One for each k; the last two say the same unless the last k is n, so that no rank grows
        further at any value.
    """
    about = rearranged(system, dual) if observed else system
    return _growing(about, channels, lambda matrix: parametric_rank(about, matrix))


def indices_for_all_values(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, observed: bool = False
) -> tuple[ParametricRank | RankHypersurfaces, ...]:
    """The ranks of `parametric_indices`, for one parameter or several."""
    if len(system.parameters) == 1:
        return parametric_indices(system, channels, observed=observed)
    return _growing(
        system, channels, lambda matrix: rank_hypersurfaces(system, matrix, observed=observed)
    )


def _growing(
    system: ParametricSystem,
    channels: Iterable[str] | None,
    decide: Callable[[ControllabilityMatrix], R],
) -> tuple[R, ...]:
    """The answers for 1, 2, … blocks, until two agree or there are n blocks."""
    chosen = system.names if channels is None else system.named(system.indices(channels))
    answers: list[R] = []
    for k in range(1, max(system.n, 1) + 1):
        answers.append(decide(ControllabilityMatrix(chosen, k)))
        if k > 1 and answers[-1].said == answers[-2].said:
            break
    return tuple(answers)
