"""Systems modulo a prime, with drawn gains, and with polynomial matrices.

A `ModularSystem` is a system modulo a prime that divides no denominator; `residue_systems` yields
one for each prime of an endless stream, so a caller whose draw failed takes the next.  Gains are
drawn with a `generator` that depends only on the plant, the subject and the kind of certificate,
so that the same question gives the same certificate.

Closed loops are computed in one of three ways.  `channel_sequences` takes sparse products if
A + Σ B_i F_i C_i stays sparse; from 128 states on exact floating-point products, if the prime has
at most `quick_bits` bits; otherwise flint.  `loop_polynomials` chooses between the last two.

A `PolynomialSystem` is a system with one parameter whose matrices are each multiplied by a common
denominator, so that their entries are polynomials.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from itertools import islice
from typing import Any

from mcexact.errors import UsageError
from mcexact.exact import krylov
from mcexact.exact.krylov import SparseLoop, stays_sparse
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix, from_numerators
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    integers,
    low_rank_update,
    primes,
    residues,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, plain, sha256

# Systems modulo a prime, with drawn gains and their closed loops.

Gains = tuple[tuple[tuple[int, ...], ...], ...]
"""One p_i × q_i matrix of residues for each channel."""

SHORT = (7, 13, 19, 31, 61)
"""Primes modulo which the checker computes ranks and powers quickly."""

# From this size on, polynomials by floats save about the time of importing numpy: 8 ms at n = 200,
# 1.1 s at n = 800.
_KRYLOV_SIZE = 128


@dataclass(frozen=True, eq=False)
class ModularSystem:
    """A, B = [B_1 … B_m] and C = [C_1; …; C_m] modulo a prime.

    Attributes
    ----------
    system : MultiChannelSystem
    modulus : int
        A prime ℓ that divides no denominator of the system.
    """

    system: MultiChannelSystem
    modulus: int

    @cached_property
    def A(self) -> ModularMatrix:
        """A modulo ℓ, n × n."""
        return residues(self.system.A, self.modulus)

    @cached_property
    def B(self) -> ModularMatrix:
        """All inputs, n × Σ p_i."""
        return residues(self.system.input_matrix(), self.modulus)

    @cached_property
    def C(self) -> ModularMatrix:
        """All outputs, Σ q_i × n."""
        return residues(self.system.output_matrix(), self.modulus)

    @cached_property
    def inputs(self) -> tuple[range, ...]:
        """The columns of ``B`` that belong to each channel."""
        return _ranges([channel.B.ncols for channel in self.system.channels])

    @cached_property
    def outputs(self) -> tuple[range, ...]:
        """The rows of ``C`` that belong to each channel."""
        return _ranges([channel.C.nrows for channel in self.system.channels])


def _ranges(sizes: Sequence[int]) -> tuple[range, ...]:
    """Consecutive ranges of the given sizes."""
    ranges, start = [], 0
    for size in sizes:
        ranges.append(range(start, start + size))
        start += size
    return tuple(ranges)


def generator(system: MultiChannelSystem | ParametricSystem, kind: str) -> random.Random:
    """Return a source of draws that depends on the plant, the subject and the kind alone.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
    kind : str
        The kind of certificate for which the draws are used.
    """
    text = canonical([system.plant.digest(), plain(system.subject), kind])
    return random.Random(int(sha256(text), 16))


def residue_systems(
    system: MultiChannelSystem, rng: random.Random, bits: int = 30
) -> Iterator[ModularSystem]:
    """Yield the system modulo primes of a bit length, none of which divides a denominator.

    Parameters
    ----------
    system : MultiChannelSystem
    rng : random.Random
        Gives the seed of the primes, by one draw.
    bits : int
        The bit length of the primes.

    Notes
    -----
    The systems go on without end, so a caller whose draw failed takes the next one.
    """
    for ell in primes(rng.getrandbits(64), bits):
        if system.denominator % ell:
            yield ModularSystem(system, ell)


def short_modulus(denominator: int, is_reached: Callable[[int], bool], otherwise: int) -> int:
    """Find a short prime modulo which a rank over Q is reached, so that it is quick to check.

    Parameters
    ----------
    denominator : int
        Of the matrices; the prime does not divide it.
    is_reached : callable
        Says of a prime whether the rank is reached modulo it.
    otherwise : int
        A long prime modulo which it is, for a plant whose rank is lost modulo all short ones.
    """
    usable = (ell for ell in SHORT if denominator % ell)
    return next((ell for ell in usable if is_reached(ell)), otherwise)


def drawn_gains(modular: ModularSystem, rng: random.Random) -> Gains:
    """Draw uniform residues for every gain F_i, p_i × q_i."""
    sizes, drawn = modular.system.sizes, drawn_residues(rng, modular.modulus)
    if set(sizes) == {(1, 1)}:
        return tuple([((x,),) for x in islice(drawn, len(sizes))])
    return tuple([tuple([tuple(islice(drawn, q)) for _ in range(p)]) for p, q in sizes])


def drawn_residues(rng: random.Random, ell: int) -> Iterator[int]:
    """Uniform residues without end: the least bits that hold ℓ, until they make one.

    Examples
    --------
    >>> list(islice(drawn_residues(random.Random(1), 7), 5))
    [1, 4, 6, 6, 6]
    """
    drawn = iter(partial(rng.getrandbits, ell.bit_length()), -1)
    return filter(ell.__gt__, drawn)


def closed_loop(modular: ModularSystem, gains: Gains) -> ModularMatrix:
    """Compute A_F = A + B diag(F_1, …, F_m) C modulo ℓ, n × n.

    Parameters
    ----------
    modular : ModularSystem
    gains : Gains
        F_i, p_i × q_i residues modulo ℓ, as `drawn_gains` gives them.
    """
    q = modular.C.nrows
    rows = []
    for F, outputs in zip(gains, modular.outputs, strict=True):
        before, after = (0,) * outputs.start, (0,) * (q - outputs.stop)
        rows += [(*before, *row, *after) for row in F]
    stacked = ModularMatrix.from_rows(rows, modular.modulus, ncols=q)
    return low_rank_update(modular.A, modular.B, stacked, modular.C)


def quick_bits(system: MultiChannelSystem) -> int:
    """The bit length of the primes modulo which `loop_polynomials` is fastest."""
    if system.n < _KRYLOV_SIZE:
        return 30
    inputs, outputs = zip(*system.sizes, strict=True)
    return krylov.exact_bits(max(system.n, sum(inputs), *outputs))


def loop_polynomials(
    modular: ModularSystem, gains: Gains
) -> tuple[ModularPolynomial, ModularPolynomial]:
    """Compute χ_A and χ_{A_F} modulo ℓ.

    Parameters
    ----------
    modular : ModularSystem
    gains : Gains
        F_i, p_i × q_i residues modulo ℓ.

    Notes
    -----
    If the two are coprime modulo ℓ, no mode is fixed over Q: every fixed mode is a root of both.
    For large systems and primes of at most `quick_bits` bits, Krylov sequences in floats compute
    them; all numbers that occur are integers that floats represent exactly.
    """
    system, ell = modular.system, modular.modulus
    if system.n < _KRYLOV_SIZE or ell.bit_length() > quick_bits(system):
        closed = closed_loop(modular, gains)
        return modular.A.characteristic_polynomial(), closed.characteristic_polynomial()
    B, C = zip(*((channel.B, channel.C) for channel in system.channels), strict=True)
    return krylov.loop_polynomials(system.A, B, C, gains, ell)


def channel_sequences(
    modular: ModularSystem, gains: Gains, starts: Iterable[krylov.Start]
) -> Iterator[list[int]]:
    """Compute y C_q A_F^k B_q x modulo ℓ, k < 2n, for one channel q with x and y after the other.

    Parameters
    ----------
    modular : ModularSystem
    gains : Gains
        F_i, p_i × q_i residues modulo ℓ.
    starts : iterable of (int, residues, residues)
        (q, x, y), x of p_q and y of q_q residues.
    """
    system, ell = modular.system, modular.modulus
    B, C = [channel.B for channel in system.channels], [channel.C for channel in system.channels]
    if stays_sparse(system.A, B, C):
        sparse = SparseLoop(system.A, B, C, ell)
        sequences = sparse.sequences(sparse.closed(gains), starts)
        if sequences is not None:
            yield from sequences
            return
    if system.n >= _KRYLOV_SIZE and ell.bit_length() <= quick_bits(system):
        yield from krylov.loop_sequences(system.A, B, C, gains, ell, starts)
        return
    A_F = closed_loop(modular, gains)
    for q, x, y in starts:
        inputs, outputs = residues(system.B(q), ell), residues(system.C(q), ell)
        b = inputs @ ModularMatrix.from_rows([[entry] for entry in x], ell, ncols=1)
        c = ModularMatrix.from_rows([y], ell) @ outputs
        numbers = []
        for _ in range(2 * system.n):
            numbers.append((c @ b)[0, 0])
            c = c @ A_F
        yield numbers


def lifted(M: ModularMatrix) -> Matrix:
    """The integer matrix with the symmetric residues, which lie between −ℓ/2 and ℓ/2.

    Examples
    --------
    >>> lifted(residues(Matrix.from_rows([[6, "1/2"]]), 7)).numerators
    ((-1, -3),)
    """
    return Matrix.from_integers([integers(row, M.modulus) for row in M.rows()], ncols=M.ncols)


def lifted_gains(modular: ModularSystem, gains: Gains) -> tuple[Matrix, ...]:
    """The gains as integer matrices with the symmetric residues; equal ones are one object."""
    sized = list(zip(gains, modular.system.sizes, strict=True))
    matrices = {
        (F, (p, q)): from_numerators([integers(row, modular.modulus) for row in F], 1, q)
        for F, (p, q) in set(sized)
    }
    return tuple(map(matrices.__getitem__, sized))


# Systems with one parameter, whose matrices are multiplied by their denominators.


@dataclass(frozen=True, eq=False)
class PolynomialSystem:
    """A', B_i', C_i' with A = A'/δ, B_i = B_i'/β_i, C_i = C_i'/γ_i in lowest terms.

    Where no denominator vanishes, the modes of these matrices are those of the system times δ, and
    a mode is fixed if and only if its multiple is.

    Attributes
    ----------
    system : ParametricSystem
        With one parameter.
    """

    system: ParametricSystem

    def __post_init__(self) -> None:
        if len(self.system.parameters) != 1:
            raise UsageError(
                f"one parameter is needed, found {', '.join(self.system.parameters)}: "
                "exceptional_hypersurfaces(…) decides for several, .along(…) makes one of them"
            )

    @property
    def n(self) -> int:
        """The number of states."""
        return self.system.n

    @property
    def m(self) -> int:
        """The number of channels."""
        return self.system.m

    @cached_property
    def A(self) -> PolynomialMatrix:
        """A'."""
        return self.system.A.reduced[0]

    @cached_property
    def B(self) -> tuple[PolynomialMatrix, ...]:
        """B_1', …, B_m'."""
        return tuple(channel.B.reduced[0] for channel in self.system.channels)

    @cached_property
    def C(self) -> tuple[PolynomialMatrix, ...]:
        """C_1', …, C_m'."""
        return tuple(channel.C.reduced[0] for channel in self.system.channels)

    @property
    def scale(self) -> Polynomial:
        """δ."""
        return self.system.A.reduced[1]

    @cached_property
    def poles(self) -> tuple[Polynomial, ...]:
        """The polynomials at whose roots an entry of the plant is undefined."""
        return self.system.poles

    def closed(self, gains: Sequence[Matrix]) -> PolynomialMatrix:
        """A' + Σ B_i' F_i C_i'."""
        total = self.A
        for B_i, F_i, C_i in zip(self.B, gains, self.C, strict=True):
            total = total + B_i @ F_i @ C_i
        return total

    def at(self, t: int | Fraction) -> MultiChannelSystem:
        """The system of the polynomial matrices at a value of t."""
        return MultiChannelSystem(
            self.A.at(t),
            [B_i.at(t) for B_i in self.B],
            [C_i.at(t) for C_i in self.C],
            names=self.system.names,
        )

    def modulo(self, t: int, ell: int) -> ModularSystem:
        """The system of `at` modulo a prime that divides no denominator, t a residue."""

        def integers(M: PolynomialMatrix) -> Matrix:
            return Matrix.from_integers(M.at_residue(t, ell).rows(), ncols=M.ncols)

        system = MultiChannelSystem(
            integers(self.A),
            [integers(B_i) for B_i in self.B],
            [integers(C_i) for C_i in self.C],
            names=self.system.names,
        )
        return ModularSystem(system, ell)

    def is_defined_modulo(self, ell: int) -> bool:
        """Whether a prime divides no denominator of a coefficient."""
        return all(M.denominator % ell for M in (self.A, *self.B, *self.C))

    def drawn_gains(self, draw: Any) -> list[Matrix]:
        """Gains of drawn integers."""
        return [
            Matrix.from_integers(
                [[draw() for _ in range(C_i.nrows)] for _ in range(B_i.ncols)], ncols=C_i.nrows
            )
            for B_i, C_i in zip(self.B, self.C, strict=True)
        ]
