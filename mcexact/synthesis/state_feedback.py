"""Prescribed spectra, and state feedback that assigns them.

All feedback here is exact.  A gain F with a prescribed characteristic polynomial of A + B F exists
for every controllable pair, but its numbers can be very long, and every later proof is about them.
`assigning_feedback` therefore draws many directions (Heymann's lemma, then Ackermann's formula) and
keeps the gain with the shortest numbers.  `state_feedback` does this for all channels together, or
proves that the system is not jointly controllable; `feedback_for_region` leaves uncontrollable
modes where they are if these lie in the region.

A spectrum comes from one of three places:

- `spectrum_polynomial` reads a prescribed one, as coefficients or as roots and conjugate pairs;
- `default_polynomial` has small integers as roots, in discrete time 0 alone, for short numbers;
- `scaled_polynomial` keeps what is fast enough in the plant and moves the rest no farther than the
  rate asks, since gains grow with the distance by which roots are moved.  Its numbers are decimals
  of a fixed precision, so that the spectrum is the same on every processor.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_DOWN, Context, Decimal, localcontext
from fractions import Fraction
from math import ceil
from random import Random
from typing import Any

from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.single_channel import drawn_integers
from mcexact.answer import loops as say
from mcexact.answer.loops import refusal
from mcexact.derived.modular import generator
from mcexact.errors import InputError, InternalError, LimitReached
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import (
    characteristic_polynomial,
    companion,
    determinant,
    row_echelon,
    solve,
)
from mcexact.exact.matrix import Matrix, as_requested, bit_length, hstack, largest_entry
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.rational import as_fraction, rational_text
from mcexact.exact.roots import StabilityRegion, root_discs
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import quoted

# Exact state feedback u_i = F_i x for a prescribed characteristic polynomial.

_CANDIDATES = 24
_DRAWS = 4000
_DRAWS_IF_FOUND = 600


@dataclass(frozen=True)
class StateFeedback:
    """Gains F_i (p_i×n), with the characteristic polynomial of A + Σ B_i F_i.

    Attributes
    ----------
    gains : tuple of Matrix
    polynomial : Polynomial
    """

    gains: tuple[Matrix, ...]
    polynomial: Polynomial


def state_feedback(system: MultiChannelSystem, polynomial: Polynomial) -> StateFeedback:
    """Find F with the given characteristic polynomial of A + Σ B_i F_i.

    Parameters
    ----------
    system : MultiChannelSystem
        Jointly controllable.
    polynomial : Polynomial
        Monic, of degree n.

    Raises
    ------
    Impossible
        If the system is not jointly controllable; the certificate is that of the joint
        controllability.

    Notes
    -----
    Exact.  Heymann: a small F_0 and an input direction g with (A + B F_0, B g) controllable, then
    one row by Ackermann's formula; of several candidates the one with the shortest numbers.
    Continuous and discrete time are the same.  (Paper, beginning of section II-C.)

    Examples
    --------
    >>> from fractions import Fraction
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> feedback = state_feedback(system, Polynomial((Fraction(2), Fraction(3), Fraction(1))))
    >>> feedback.gains[0].numerators
    ((-2, -3),)
    """
    controllable = joint_controllability(system)
    if not controllable.controllable:
        raise refusal("unreached", controllable, template=say.NOT_CONTROLLABLE)
    B = system.input_matrix()
    F = assigning_feedback(system.A, B, polynomial)
    return given_feedback(system, split_by_channel(system, F))


def given_feedback(system: MultiChannelSystem, gains: tuple[Matrix, ...]) -> StateFeedback:
    """Return prescribed gains F_i with the characteristic polynomial of A + Σ B_i F_i.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : tuple of m Matrix
        F_i, p_i × n.
    """
    return StateFeedback(gains, characteristic_polynomial(loop_matrix(system, gains)))


def loop_matrix(system: MultiChannelSystem, gains: tuple[Matrix, ...]) -> Matrix:
    """A + Σ B_i F_i, n×n, the loop in which every agent measures the whole state.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : tuple of m Matrix
        F_i, p_i × n.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> loop_matrix(system, (Matrix.from_rows([[-2, -3]]),)).numerators
    ((0, 1), (-2, -3))
    """
    result = system.A
    for i, F in enumerate(gains):
        result = result + system.B(i) @ F
    return result


def assigning_feedback(A: Matrix, B: Matrix, polynomial: Polynomial, *, seed: int = 0) -> Matrix:
    """Find F (p×n) with short numbers and the given characteristic polynomial of A + B F.

    Parameters
    ----------
    A : Matrix, n×n
    B : Matrix, n×p
        (A, B) controllable.
    polynomial : Polynomial
        Monic, of degree n.
    seed : int

    Raises
    ------
    LimitReached
        If no suitable direction was drawn, which does not happen for a controllable pair.

    Notes
    -----
    The denominators of F divide det X, X = [b, Mb, …, M^{n−1}b], with M = A + B F_0 and b = B g,
    where A, B, F_0 and g are integral; and F is close to F_0 where M has nearly the prescribed
    spectrum.  So many F_0 and g are drawn: some sparse, the others such that M comes close, as far
    as im B reaches, to a chain of companion blocks (of the prescribed polynomial, or of powers of
    x) in drawn coordinates, for which det X would be ±1.
    """
    n, p = B.shape
    if n == 0:
        return Matrix.zeros(p, 0)
    rng, reach = Random(seed), _left_inverse(B)
    targets = [companions(polynomial), [Matrix.zeros(1, 1)] * n]
    best: tuple[int, Matrix] | None = None
    least, count = Fraction(0), 0
    for draw in range(_DRAWS):
        if count >= _CANDIDATES and draw >= _DRAWS_IF_FOUND:
            break
        direction = _drawn_direction(A, B, reach, targets, rng, draw)
        size = abs(determinant(direction.X))
        if not size:
            continue
        least = size if not count else min(least, size)
        # A larger determinant leads to longer denominators of F, so the draw is dropped.
        if size > 4 * least and count >= _CANDIDATES:
            continue
        count += 1
        F = direction.feedback(polynomial)
        if best is None or _cost(F) < best[0]:
            best = _cost(F), F
    if best is None:
        raise LimitReached("no input direction was found that controls the system by itself")
    return best[1]


def _cost(F: Matrix) -> int:
    """A measure of the length of numbers in a design with F, dominated by denominators."""
    size = ceil(largest_entry([F])).bit_length()
    return 4 * F.denominator.bit_length() + bit_length([F]) + 3 * size


@dataclass(frozen=True)
class _Direction:
    """M = A + B F_0, an input direction g, and X = [b, Mb, …, M^{n−1}b] with b = B g."""

    F0: Matrix
    g: Matrix
    M: Matrix
    X: Matrix

    def feedback(self, polynomial: Polynomial) -> Matrix:
        """F = F_0 + g k with χ_{M + bk} = p: k = −w p(M), w the last row of X⁻¹ (Ackermann)."""
        n = self.M.nrows
        last = solve(self.X.T, Matrix.column([int(k == n - 1) for k in range(n)]))
        if last is None:
            raise InternalError("a direction lost its rank")
        row, result = last.T, Matrix.zeros(1, n)
        for coefficient in polynomial.coefficients:
            result = result + row * coefficient
            row = row @ self.M
        return self.F0 - self.g @ result


def _drawn_direction(
    A: Matrix,
    B: Matrix,
    reach: Matrix,
    targets: Sequence[Sequence[Matrix]],
    rng: Random,
    draw: int,
) -> _Direction:
    """Yield unit directions without feedback first, then sparse draws and targets by turns."""
    n, p = B.shape
    bound = 1 + draw // 1000
    if draw < p:
        F0, g = Matrix.zeros(p, n), Matrix.column([int(k == draw) for k in range(p)])
    elif draw % 3 == 2:
        F0, g = drawn_integers(rng, p, n, bound, 0.25), drawn_integers(rng, p, 1, bound, 0.5)
    else:
        target, first = _drawn_target(rng, targets[draw % 3])
        F0 = _rounded(reach @ (target - A))
        g = (
            _rounded(reach.take(cols=[first]))
            if draw % 4
            else drawn_integers(rng, p, 1, bound, 0.5)
        )
    M = A + B @ F0
    columns = [B @ g]
    for _ in range(n - 1):
        columns.append(M @ columns[-1])
    return _Direction(F0, g, M, hstack(columns))


def _left_inverse(B: Matrix) -> Matrix:
    """L (p×n) with B L the orthogonal projection onto im B; rows of dependent columns are 0."""
    _, independent = row_echelon(B)
    chosen = B.take(cols=independent)
    inner = solve(chosen.T @ chosen, chosen.T)
    if inner is None:
        raise InternalError("independent columns have a singular Gram matrix")
    rows = {j: inner.rows()[k] for k, j in enumerate(independent)}
    zero = (0,) * B.nrows
    return Matrix.from_rows([rows.get(j, zero) for j in range(B.ncols)], ncols=B.nrows)


def _rounded(M: Matrix) -> Matrix:
    """Round to the nearest integers."""
    return Matrix.from_integers([[round(x) for x in row] for row in M.rows()], ncols=M.ncols)


def _drawn_target(rng: Random, blocks: Sequence[Matrix]) -> tuple[Matrix, int]:
    """Chain the blocks in a drawn order of coordinates; return the matrix and the first state."""
    blocks = list(blocks)
    rng.shuffle(blocks)
    n = sum(block.nrows for block in blocks)
    order = list(range(n))
    rng.shuffle(order)
    rows: list[list[Fraction | int]] = [[0] * n for _ in range(n)]
    start = 0
    for block in blocks:
        size = block.nrows
        for i in range(size):
            for k in range(size):
                rows[order[start + i]][order[start + k]] = block[i, k]
        if start:
            rows[order[start]][order[start - 1]] = rng.choice((1, -1))
        start += size
    return Matrix.from_rows(rows, ncols=n), order[0] if n else 0


def companions(polynomial: Polynomial) -> list[Matrix]:
    """Companion matrices of the irreducible factors over Q, each as often as its multiplicity.

    Examples
    --------
    >>> p = Polynomial.of(-1, 1)**2 * Polynomial.of(-2, 0, 1)
    >>> [M.shape for M in companions(p)]
    [(1, 1), (1, 1), (2, 2)]
    """
    blocks = []
    for factor, times in polynomial.factor():
        blocks += [companion(factor)] * times
    return blocks


def split_by_channel(system: MultiChannelSystem, F: Matrix) -> tuple[Matrix, ...]:
    """Split F = [F_1; …; F_m], Σ p_i rows, into the gains F_i of the channels, p_i rows each.

    Examples
    --------
    >>> system = MultiChannelSystem([[0]], [[[1, 1]], [[1]]], [[[1]], [[1]]])
    >>> [F.numerators for F in split_by_channel(system, Matrix.column([4, 5, 6]))]
    [((4,), (5,)), ((6,),)]
    """
    gains, start = [], 0
    for i in range(system.m):
        stop = start + system.p(i)
        gains.append(F.take(rows=range(start, stop)))
        start = stop
    return tuple(gains)


# Prescribed spectra as monic polynomials over Q, from coefficients or from roots and pairs.


def spectrum_polynomial(spectrum: Any, degree: int, *, where: str = "spectrum") -> Polynomial:
    """Return the monic polynomial whose roots are a prescribed symmetric set of numbers.

    Parameters
    ----------
    spectrum : Polynomial, sequence or array
        The coefficients of a monic polynomial, constant term first; or its roots.  A root is a real
        number or complex: ``"-1+2i"``, ``-1+2j`` or ``{"re": -1, "im": 2}`` stands for the pair
        −1 ± 2i, and its conjugate may be listed as well, as in arrays of numpy.  Floats stand for
        the decimals that print them.
    degree : int
        The number of prescribed numbers, which distinguishes degree + 1 coefficients from degree
        roots.
    where : str
        The place to name in an error.

    Returns
    -------
    Polynomial
        Monic, of the given degree.

    Raises
    ------
    InputError
        If the length is wrong (the message states the right one), the polynomial is not monic, or
        an entry is not a rational number.

    Examples
    --------
    >>> str(spectrum_polynomial(["-1", "-1+2i"], 3))
    'x^3 + 3*x^2 + 7*x + 5'
    >>> spectrum_polynomial([5, 2, 1], 2) == spectrum_polynomial([-1 - 2j, -1 + 2j], 2)
    True
    >>> spectrum_polynomial([-1, -2], 3)
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: spectrum: expected 3 numbers (or 4 coefficients of a monic \
polynomial, constant term first), found a list of 2
    """
    entries = _listed(spectrum, where)
    if any(map(_is_complex, entries)) or len(entries) != degree + 1:
        if isinstance(spectrum, Polynomial):
            raise InputError(
                f"expected a polynomial of degree {degree}, found degree {spectrum.degree}",
                where=where,
            )
        return _from_roots(entries, degree, where)
    values = [as_requested(e, where=f"{where}[{k}]") for k, e in enumerate(entries)]
    if values[-1] != 1:
        raise InputError(
            f"expected a monic polynomial of degree {degree} (last coefficient 1) or "
            f"{degree} roots, found {degree + 1} numbers of which the last is {values[-1]}",
            where=where,
        )
    return Polynomial(tuple(values))


def _listed(spectrum: Any, where: str) -> Sequence[Any]:
    """Return the coefficients or roots as a sequence."""
    if isinstance(spectrum, Polynomial):
        return spectrum.coefficients
    if getattr(spectrum, "ndim", 0) == 1 and hasattr(spectrum, "tolist"):
        # Items of single precision are read in their own precision, which `tolist` would lose.
        return list(spectrum)
    if isinstance(spectrum, Sequence) and not isinstance(spectrum, (str, bytes)):
        return spectrum
    raise InputError(
        f"expected a list of coefficients, or of roots and pairs, found {type(spectrum).__name__}",
        where=where,
    )


def _is_complex(entry: Any) -> bool:
    """Whether an entry can only be a root; a real number can also be a coefficient."""
    if isinstance(entry, str):
        return entry[-1:] in {"i", "j"}
    return isinstance(entry, (Mapping, complex)) or _kind_of(entry) == "c"


def _kind_of(entry: Any) -> str:
    return str(getattr(getattr(entry, "dtype", None), "kind", ""))


def _from_roots(entries: Sequence[Any], degree: int, where: str) -> Polynomial:
    """The product of the factors of the roots and pairs."""
    real, pairs = list[Fraction](), Counter[tuple[Fraction, Fraction]]()
    for k, entry in enumerate(entries):
        re, im = _root(entry, f"{where}[{k}]")
        if im:
            pairs[re, im] += 1
        else:
            real.append(re)
    result = Polynomial.from_roots(real)
    for re, im in dict.fromkeys((re, abs(im)) for re, im in pairs):
        above, below = pairs[re, im], pairs[re, -im]
        if above and below and above != below:
            raise InputError(
                f"expected as many of {_shown(re, im)} as of its conjugate, or one of the two for "
                f"each pair, found {above} and {below}",
                where=where,
            )
        factor = Polynomial((re * re + im * im, -2 * re, Fraction(1)))
        result = result * factor ** max(above, below)
    if result.degree != degree:
        description = f"a list of {len(entries)}"
        if result.degree != len(entries):
            description += f" with {result.degree} numbers (a pair counts twice)"
        raise InputError(
            f"expected {degree} numbers (or {degree + 1} coefficients of a monic polynomial, "
            f"constant term first), found {description}",
            where=where,
        )
    return result


def _shown(re: Fraction, im: Fraction) -> str:
    return f"{rational_text(re)}+{rational_text(im)}i"


def _root(entry: Any, place: str) -> tuple[Fraction, Fraction]:
    """The real and the imaginary part of a root, which is 0 for a real one."""
    if isinstance(entry, Mapping):
        return _pair(entry, place)
    if isinstance(entry, str) and _is_complex(entry):
        return _parsed(entry, place)
    if _is_complex(entry):
        return as_requested(entry.real, where=place), as_requested(entry.imag, where=place)
    return as_requested(entry, where=place), Fraction(0)


def _parsed(text: str, place: str) -> tuple[Fraction, Fraction]:
    """The parts of a complex number such as -1+2i, 3/2-i or 2i."""
    digits = text[:-1]
    # The imaginary part begins with the last sign that does not belong to an exponent.
    signs = (k for k in range(len(digits) - 1, 0, -1) if digits[k] in "+-")
    start = next((k for k in signs if digits[k - 1] not in "eE"), 0)
    im = digits[start:].removeprefix("+")
    try:
        return as_fraction(digits[:start] or 0), as_fraction(f"{im}1" if im in {"", "-"} else im)
    except InputError:
        raise InputError(
            f'expected a complex number such as "-1+2i" or "1/2-3i", found {quoted(text)}',
            where=place,
        ) from None


def _pair(entry: Mapping[str, Any], place: str) -> tuple[Fraction, Fraction]:
    """The parts of one root of a pair, whose conjugate is implied."""
    if set(entry) != {"re", "im"}:
        raise InputError(
            'expected a pair as {"re": a, "im": b}, its conjugate is implied', where=place
        )
    re = as_requested(entry["re"], where=f"{place}.re")
    im = as_requested(entry["im"], where=f"{place}.im")
    if im == 0:
        raise InputError(
            "expected an imaginary part that is not 0; write a real root as one number",
            where=place,
        )
    return re, im


def require_numbers(spectrum: Any, where: str = "spectrum") -> None:
    """Raise an error for a prescribed spectrum with an entry that is not a number.

    The required number of entries is known only when the order of the controller is.

    Parameters
    ----------
    spectrum : list of numbers and pairs, or mapping to such
    where : str

    Raises
    ------
    InputError
        If an entry is neither a rational number nor a pair.

    Examples
    --------
    >>> require_numbers({"closed_loop": ["-1", {"re": "-1", "im": "2"}, "3/2-i"]})
    >>> require_numbers({"closed_loop": ["-1", "foo"]})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: spectrum.closed_loop[1]: expected an integer, a decimal such as \
"-0.25" or "1e-3", or a quotient such as "1/3", found 'foo'
    """
    if isinstance(spectrum, Mapping):
        for key, numbers in spectrum.items():
            require_numbers(numbers, f"{where}.{key}")
    elif isinstance(spectrum, Sequence) and not isinstance(spectrum, (str, bytes)):
        for k, entry in enumerate(spectrum):
            _root(entry, f"{where}[{k}]")


def default_polynomial(region: StabilityRegion, degree: int) -> Polynomial:
    """Return a polynomial with short numbers and every root in a region.

    Parameters
    ----------
    region : StabilityRegion
    degree : int

    Returns
    -------
    Polynomial
        Continuous time: the roots −c, −c−1, −c−2, −c, … with c the least integer above the rate.
        Discrete time: x^degree (deadbeat), which meets every radius and has the shortest numbers.

    Examples
    --------
    >>> str(default_polynomial(StabilityRegion.of("continuous", rate="1/2"), 2))
    'x^2 + 3*x + 2'
    """
    if region.discrete:
        return Polynomial((Fraction(0),) * degree + (Fraction(1),))
    least = region.edge.numerator // region.edge.denominator + 1
    result = Polynomial((Fraction(1),))
    for k in range(degree):
        result = result * Polynomial((Fraction(least + k % 3), Fraction(1)))
    return result


# Spectra for a rate alone: the plant's own roots, moved no farther than the rate asks.

_FASTER = Decimal("1.25")
_INSIDE = Decimal("0.9")
_PRECISION, _DIGITS = Context(prec=28), Context(prec=2)

Root = tuple[Decimal, Decimal]
"""Real and imaginary part; of a pair the one above the axis."""


def scaled_polynomial(own: Polynomial, region: StabilityRegion, degree: int) -> Polynomial:
    """Return a polynomial with every root in a region, and most roots those of ``own``.

    Parameters
    ----------
    own : Polynomial
        The characteristic polynomial of what a controller moves, of the given degree at most.
    region : StabilityRegion
        With a rate or a radius.
    degree : int
        The roots beyond those of ``own`` are those of the controller.

    Returns
    -------
    Polynomial
        Continuous time: a root gets the real part −max(5/4·rate, |Re λ|), and further roots are
        minus the geometric mean of the moduli.  Discrete time: a modulus r becomes the least of r,
        1/r and ρ^(5/4) for the radius ρ, 9/10 for the radius 1, and further roots are the geometric
        mean of the moduli; what has a modulus below about 1/100 becomes 0.  Of equal roots the
        second and the third are two and three times as fast.  All numbers have two digits, in
        discrete time of their distance to 1.

    Raises
    ------
    InputError
        If the degree is less than that of the polynomial.

    Notes
    -----
    Fast roots stay where they are, since gains grow with the distances by which roots are moved:
    for the four tanks of Johansson and the rate 1/100, the roots −1, −2 and −3 take gains of 9e24,
    the roots of this function gains of 1.

    Examples
    --------
    >>> own = Polynomial.from_roots([-4, "1/3", 0])
    >>> scaled = scaled_polynomial(own, StabilityRegion.of("continuous", rate="1/10"), 4)
    >>> [float(-factor.coefficients[0]) for factor, _ in scaled.factor()]
    [-0.12, -0.33, -0.55, -4.0]
    """
    if degree < own.degree:
        raise InputError(f"expected a degree of at least {own.degree}, found {degree}")
    with localcontext(_PRECISION):
        roots = [_into_region(each, region) for each in _roots(own)]
        mean = _mean([_modulus(each) for each in roots], region)
        more = (mean if region.discrete else -mean), Decimal(0)
        roots += [more] * (degree - own.degree)
        return product(_factor(each, region) for each in _apart(roots, region))


def _roots(own: Polynomial) -> Iterator[Root]:
    """The roots on the real axis and above it, each as often as it occurs, to twelve digits."""
    left = own
    while left.degree > 0:
        single = left.squarefree_part()
        for disc in root_discs(single):
            if not disc.im.startswith("-"):
                yield Decimal(disc.re), Decimal(disc.im)
        left = left // single


def _modulus(root: Root) -> Decimal:
    return (root[0] * root[0] + root[1] * root[1]).sqrt()


def _limit(region: StabilityRegion) -> Decimal:
    """The least rate, or the largest radius, of a root."""
    edge = Decimal(region.edge.numerator) / Decimal(region.edge.denominator)
    if not region.discrete:
        return _FASTER * edge
    return _INSIDE if edge == 1 else edge**_FASTER


def _into_region(root: Root, region: StabilityRegion) -> Root:
    """Move a root into the region."""
    (re, im), limit, size = root, _limit(region), _modulus(root)
    if not region.discrete:
        return -max(limit, abs(re)), im
    if size <= limit:
        return root
    shrunk = min(limit, 1 / size) / size
    return shrunk * re, shrunk * im


def _mean(sizes: Sequence[Decimal], region: StabilityRegion) -> Decimal:
    """The geometric mean of the moduli that are not 0; the limit without any."""
    logarithms = [each.ln() for each in sizes if each]
    if not logarithms:
        return _limit(region)
    return (sum(logarithms, Decimal(0)) / len(logarithms)).exp()


def _apart(roots: Sequence[Root], region: StabilityRegion) -> Iterator[Root]:
    """Make the second of equal roots twice as fast, the third three times, the fourth not, …"""
    seen = Counter[Root]()
    for root in roots:
        times = seen[root] % 3 + 1
        seen[root] += 1
        if region.discrete:
            part = _modulus(root) ** (times - 1) if times > 1 else Decimal(1)
            yield root[0] * part, root[1] * part
        else:
            yield root[0] * times, root[1]


def _factor(root: Root, region: StabilityRegion) -> Polynomial:
    """The monic factor of a root with two digits, and of its conjugate."""
    if region.discrete:
        # Towards 0, so that the modulus does not grow.
        unit = Decimal(10) ** ((1 - _modulus(root)).adjusted() - 1)
        re, im = (Fraction(each.quantize(unit, ROUND_DOWN)) for each in root)
    else:
        re, im = (Fraction(_DIGITS.plus(each)) for each in root)
    if not root[1]:
        return Polynomial((-re, Fraction(1)))
    return Polynomial((re * re + im * im, -2 * re, Fraction(1)))


# Feedback that leaves modes where they are if these are fast enough or unobservable.


def feedback_for_region(system: MultiChannelSystem, region: StabilityRegion) -> StateFeedback:
    """Find F with every eigenvalue of A + Σ B_i F_i in a region; uncontrollable modes in it stay.

    Parameters
    ----------
    system : MultiChannelSystem
    region : StabilityRegion
        A region with a rate or radius.

    Raises
    ------
    Impossible
        If an uncontrollable mode is outside the region; the certificate is that of the joint
        controllability.

    Notes
    -----
    Exact.  With X a basis of the controllable subspace, its rows ``pivots`` the identity,
    A X = X A_1, B = X B_1: F = F_1 L assigns A_1 + B_1 F_1, L the selection of these rows.

    Examples
    --------
    >>> system = MultiChannelSystem([[1, 0], [0, -9]], [[[1], [0]]], [[[1, 1]]])
    >>> str(feedback_for_region(system, StabilityRegion("continuous", 1)).polynomial)
    'x^2 + 11*x + 18'
    """
    if region.bound is None:
        raise InternalError("a design for a region needs its bound")
    decided = joint_controllability(system)
    B = system.input_matrix()
    if decided.controllable:
        polynomial = default_polynomial(region, system.n)
        gains = split_by_channel(system, assigning_feedback(system.A, B, polynomial))
        return given_feedback(system, gains)
    rest = decided.uncontrollable_polynomial
    if not region.contains_roots_of(rest):
        raise refusal("unreached", decided, template=say.NOT_CONTROLLABLE_IN, region=region)
    subspace = controllable_subspace(system.A, B, generator(system, "controllability"))
    pivots = list(subspace.pivots)
    A1 = (system.A @ subspace.X).take(rows=pivots)
    polynomial = default_polynomial(region, len(pivots))
    F1 = assigning_feedback(A1, B.take(rows=pivots), polynomial)
    selection = Matrix.identity(system.n).take(rows=pivots)
    return given_feedback(system, split_by_channel(system, F1 @ selection))


def observable_part(system: MultiChannelSystem) -> tuple[MultiChannelSystem, Matrix]:
    """The observable quotient of a plant, with respect to all channels together.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.

    Returns
    -------
    part : MultiChannelSystem
        (A_o, L B_i, C_{o,i}), jointly observable, with the same channels and graph.
    L : Matrix, d×n
        Of full row rank, with L A = A_o L and C_i = C_{o,i} L, so that L x is the state of the
        part.

    Examples
    --------
    >>> system = MultiChannelSystem([[1, 0], [0, -9]], [[[1], [1]]], [[[2, 0]]])
    >>> part, L = observable_part(system)
    >>> part.A.numerators, L.numerators
    (((1,),), ((1, 0),))
    """
    subspace = controllable_subspace(
        system.A.T, system.output_matrix().T, generator(system, "observability")
    )
    L, pivots = subspace.X.T, list(subspace.pivots)
    part = MultiChannelSystem(
        (L @ system.A).take(cols=pivots),
        [L @ channel.B for channel in system.channels],
        [channel.C.take(cols=pivots) for channel in system.channels],
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
        name=system.name,
    )
    return part, L
