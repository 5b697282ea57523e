"""All values of parameters: answers and sentences.

There are two kinds of answers about one parameter t.  `ParametricFixedSpectrum` has the modes that
are fixed for almost all t, and the exceptional values with the modes that are fixed there.
`ParametricRank` has the rank of a matrix made from the plant (equilibria, controllability,
transfer from one channel to another) and the values at which it is less.  Both are proved for every
complex t at which all entries are defined.  Values without a real one in the assumed range may be
left out of the claim (``outside``).

The rules of the sentences of `mcexact analyze` read certificates if the plant has one parameter.
With several parameters a certificate is about one line through their space: what it implies for
almost all values (``ALMOST``) and what it says of its line (``ON_LINE``) are sentences by rules.
The functions that fill the templates of one parameter are shared with `several_parameters`, whose
other sentences no manifest claims.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from mcexact.answer.evidence import RootDisc, ZeroBlock
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.answer.sentence import Claim, Context, Rulebook
from mcexact.answer.templates import Sentence, Template, blame, polynomial_in_x
from mcexact.errors import InputError
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction, rational_text, rounded
from mcexact.exact.roots import exact_decimal, root_discs
from mcexact.model.graph import connects
from mcexact.model.parametric import ParametricSystem, Range

# Values of a parameter in answers, the modes there, and their words.

ModePolynomial = tuple[Polynomial, ...]
"""A polynomial in x, monic, by its coefficients, constant first, which are polynomials in t."""


@dataclass(frozen=True)
class ParameterValue(Part):
    """Values of the parameter, the roots of an irreducible polynomial.

    Attributes
    ----------
    value : Polynomial
        q, monic and irreducible over Q.
    roots : tuple of RootDisc
        Disjoint discs with one root each, centered on the real axis exactly for real roots.
    """

    value: Polynomial
    roots: tuple[RootDisc, ...]

    def to_sympy(self) -> list[Any]:
        """All values exactly: rational numbers, or instances of ``CRootOf``.

        Examples
        --------
        >>> from mcexact import ParametricSystem, fixed_spectrum
        >>> plant = ParametricSystem([[1]], [[["t^3 - 2"]]], [[[1]]], parameters=["t"])
        >>> fixed_spectrum(plant).exceptional[0].to_sympy()[0]
        CRootOf(x**3 - 2, 0)
        """
        import sympy

        p = self.value.to_sympy()
        return [sympy.CRootOf(p, k, radicals=False) for k in range(self.value.degree)]

    @property
    def exact(self) -> Fraction | None:
        """The value, if it is rational."""
        return -self.value.coefficients[0] if self.value.degree == 1 else None

    @property
    def real(self) -> tuple[RootDisc, ...]:
        """The discs of the real roots."""
        return tuple(disc for disc in self.roots if exact_decimal(disc.im) == 0)

    def inside(self, bounds: Range) -> bool:
        """Whether a root is real and in a range, or within the radius of its disc of it."""
        low, high = bounds
        if self.exact is not None:
            return (low is None or low <= self.exact) and (high is None or self.exact <= high)
        return any(meets(disc, bounds) for disc in self.real)


@dataclass(frozen=True)
class OutsideValue(Part):
    """Values of the parameter without a real one in the range, of which nothing is claimed."""

    value: Polynomial
    roots: tuple[RootDisc, ...]


def in_parameter(p: Polynomial, t: str) -> str:
    """A polynomial in the parameter.

    Examples
    --------
    >>> in_parameter(Polynomial.of(-2, 0, 1), "t")
    't^2 - 2'
    """
    return str(p).replace("x", t)


def mode_text(p: ModePolynomial, t: str) -> str:
    """A polynomial in x whose coefficients depend on the parameter.

    Examples
    --------
    >>> mode_text((Polynomial.of(0, -1), Polynomial.of(2), Polynomial.of(1)), "t")
    'x^2 + 2*x - t'
    """
    return polynomial_in_x([in_parameter(c, t) for c in p])


def value_text(q: Polynomial, roots: Sequence[RootDisc], t: str) -> str:
    """Where a polynomial in t is 0, in words: its rational root, or its real roots, rounded.

    Examples
    --------
    >>> value_text(Polynomial.of("-1/2", 1), [], "t")
    't = 1/2'
    >>> from mcexact.exact.roots import root_discs
    >>> q = Polynomial.of(-2, 0, 1)
    >>> value_text(q, [RootDisc(d.re, d.im, d.radius) for d in root_discs(q)], "t")
    't^2 - 2 = 0 (t about -1.41421, 1.41421)'
    """
    if q.degree == 1:
        return f"{t} = {rational_text(-q.coefficients[0] / q.leading)}"
    real = [disc.re for disc in roots if exact_decimal(disc.im) == 0]
    listed = ", ".join(rounded(exact_decimal(each)) for each in real)
    told = f"{t} about {listed}" if real else f"no real {t}"
    return f"{in_parameter(q, t)} = 0 ({told})"


Row = tuple[str, str, str]
"""Where, what holds there, and why."""


@dataclass(frozen=True)
class LeftOut:
    """The values of which answers say nothing.

    Attributes
    ----------
    outside : tuple of str
        Those out of the range, as conditions.
    assumed : str
        The parameter with its range.
    undefined : tuple of str
        Those at which an entry of the plant is undefined, as conditions.
    """

    outside: tuple[str, ...]
    assumed: str
    undefined: tuple[str, ...]


def rows_left_out(parts: Iterable[LeftOut]) -> tuple[Row, ...]:
    """Rows for the values of which some of the answers say nothing, each value once."""
    parts = [*parts]
    outside = dict.fromkeys(at for each in parts for at in each.outside)
    undefined = dict.fromkeys(at for each in parts for at in each.undefined)
    rows = [(at, "undefined", "a denominator is 0") for at in undefined]
    if not outside:
        return tuple(rows)
    where = f"{', '.join(outside)} (out of range)"
    return (where, "not decided", f"{parts[0].assumed} is assumed"), *rows


def left_out(found: Any) -> LeftOut:
    """The values of which an answer about one parameter says nothing."""
    [t], [bounds] = found.about.parameters, found.about.ranges
    return LeftOut(
        outside=tuple(value_text(each.value, each.roots, t) for each in found.outside),
        assumed=found.about.parameters_in_words[0],
        undefined=tuple(
            value_text(each.value, each.roots, t) + within(each.inside(bounds), bounds)
            for each in poles_of(found.about)
        ),
    )


def rows_of_values(found: Any, told: Callable[[Any], Sequence[tuple[str, str]]]) -> tuple[Row, ...]:
    """The rows of an answer about exceptional values.

    Parameters
    ----------
    found : ParametricFixedSpectrum or ParametricRank
    told : callable
        What holds at an exceptional value, and why.
    """
    [t], [bounds] = found.about.parameters, found.about.ranges
    return tuple(
        (value_text(each.value, each.roots, t) + within(True, bounds), what, why)
        for each in found.exceptional
        for what, why in told(each)
    )


def within(inside: bool, bounds: Range) -> str:
    """Whether a value is in the range that is assumed, if one is.

    Examples
    --------
    >>> within(True, (0, None)), within(False, (None, None))
    (' (in range)', '')
    """
    if bounds == (None, None):
        return ""
    return " (in range)" if inside else " (out of range)"


def joined(parts: Iterable[tuple[str, Any]]) -> tuple[Row, ...]:
    """The rows of several answers, each after its name, and rows for the values left out."""
    parts = [*parts]
    said = [
        (where, f"{name}: {what}", why) for name, each in parts for where, what, why in each.told
    ]
    return *said, *rows_left_out(each.left_out for _, each in parts)


def undefined_where(about: ParametricSystem) -> list[str]:
    """The values of one parameter, in its range if it has one, at which an entry is undefined."""
    [t], [bounds] = about.parameters, about.ranges
    inside = [each for each in poles_of(about) if bounds == (None, None) or each.inside(bounds)]
    return [value_text(each.value, each.roots, t) for each in inside]


def apart_from_poles(about: ParametricSystem) -> str:
    """The values at which an entry is undefined, as words to append to "every value of t".

    Examples
    --------
    >>> plant = ParametricSystem([["1/(t^3 - t^2)"]], [[[1]]], [[[1]]], parameters=["t"])
    >>> apart_from_poles(plant)
    ' with t ≠ 1 and t ≠ 0'
    """
    [t], [bounds] = about.parameters, about.ranges
    apart = [
        f"{in_parameter(each.value, t)} ≠ 0"
        if each.exact is None
        else f"{t} ≠ {rational_text(each.exact)}"
        for each in poles_of(about)
        if bounds == (None, None) or each.inside(bounds)
    ]
    return f" with {' and '.join(apart)}" if apart else ""


def poles_of(about: ParametricSystem) -> tuple[ParameterValue, ...]:
    """The values of one parameter at which an entry of the plant is undefined."""
    return tuple(
        ParameterValue(q, tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(q)))
        for q in about.poles
    )


def mode_in_sympy(p: ModePolynomial, parameter: Any = "t") -> Any:
    """A polynomial in x whose coefficients depend on the parameter, as a ``sympy.Poly`` in x.

    Examples
    --------
    >>> mode_in_sympy((Polynomial.of(0, -1), Polynomial.of(1)), "k")
    Poly(x - k, x, domain='QQ[k]')
    """
    import sympy

    t = sympy.Symbol(parameter) if isinstance(parameter, str) else parameter
    descending = [c.to_sympy(t).as_expr() for c in reversed(p)]
    return sympy.Poly(descending, sympy.Symbol("x"), domain=sympy.QQ[t])


def meets(disc: RootDisc, bounds: Range) -> bool:
    """Whether a disc meets a range of real numbers, by its center and radius."""
    re, im, radius = map(exact_decimal, (disc.re, disc.im, disc.radius))
    low, high = bounds
    below, above = low is not None and re + radius < low, high is not None and re - radius > high
    return not (below or above or abs(im) > radius)


# Answer: the fixed modes for every value of a parameter.


@dataclass(frozen=True)
class ExceptionalMode(Part):
    """A mode that is fixed at exceptional values, and is no root of a generic polynomial there.

    Attributes
    ----------
    polynomial : tuple of Polynomial
        p, monic in x, its coefficients polynomials in t, reduced modulo the value's q.
    channels : tuple of str
        A set s of channels whose pencil [xI − A, B_{m−s}; C_s, 0] loses rank.
    """

    polynomial: ModePolynomial
    channels: tuple[str, ...]

    def to_sympy(self, parameter: Any = "t") -> Any:
        """The polynomial as a ``sympy.Poly`` in x over the polynomials in the parameter."""
        return mode_in_sympy(self.polynomial, parameter)


@dataclass(frozen=True)
class ExceptionalValue(ParameterValue):
    """Values of the parameter at which more is fixed.

    Attributes
    ----------
    modes : tuple of ExceptionalMode
        What is fixed there besides the roots of the generic polynomials.
    """

    modes: tuple[ExceptionalMode, ...]


@dataclass(frozen=True)
class ExceptionalEvidence(Part):
    """A zero block for each mode, and divisors of generic polynomials modulo q."""

    modes: tuple[ZeroBlock, ...]
    divisors: tuple[ModePolynomial, ...]


@dataclass(frozen=True)
class SettledValue(Part):
    """Values at which nothing more is fixed, but perhaps a multiplicity is larger."""

    value: Polynomial
    divisors: tuple[ModePolynomial, ...]


@dataclass(frozen=True)
class CommonDivisor(Part):
    """A value q, and what divides det(xI − A_E) and det(xI − A_F) there besides generic modes."""

    value: Polynomial
    divisor: ModePolynomial


@dataclass(frozen=True)
class MovedModes(Part):
    """Evidence of the generic and exceptional modes, and that gains move all others.

    Attributes
    ----------
    gains : three tuples of Matrix
        E, F and G.
    modulus : int
        ℓ, modulo which det(xI − A_G) and all resultants with it are computed.
    moduli : tuple of int
        Modulo these the resultant of what is left of det(xI − A_E) and det(xI − A_F) is computed;
        none if ℓ is enough.
    common : tuple of CommonDivisor
        If ℓ is enough, divisors at values, which prove how often these divide the resultant.
    generic : tuple of ZeroBlock
        One for each generic polynomial.
    exceptional : tuple of ExceptionalEvidence
        One for each exceptional value.
    settled : tuple of SettledValue
    undefined : tuple of Polynomial
        Roots of that resultant at which an entry is undefined.
    """

    gains: tuple[tuple[Matrix, ...], tuple[Matrix, ...], tuple[Matrix, ...]]
    modulus: int
    moduli: tuple[int, ...]
    common: tuple[CommonDivisor, ...]
    generic: tuple[ZeroBlock, ...]
    exceptional: tuple[ExceptionalEvidence, ...]
    settled: tuple[SettledValue, ...]
    undefined: tuple[Polynomial, ...]


@answer("parametric_fixed_spectrum")
class ParametricFixedSpectrum(Answer):
    """The modes that no linear time-invariant decentralized feedback moves, for every parameter.

    It is about A'/δ, B_i'/β_i, C_i'/γ_i in lowest terms, and every complex value of the parameter
    at which all entries of the plant are defined.  The modes of the system are the roots x named
    here divided by the value of δ.

    Attributes
    ----------
    generic : tuple of tuples of Polynomial
        The irreducible polynomials in x whose roots are fixed for every value of the parameter,
        each by its coefficients, constant first.
    exceptional : tuple of ExceptionalValue
        All values at which another mode is fixed, and these modes.
    outside : tuple of OutsideValue
        Values of which nothing is claimed, because none is real and in the range assumed.
    evidence : MovedModes
    """

    about: ParametricSystem  # type: ignore[assignment]
    generic: tuple[ModePolynomial, ...] = claim("fixed for every value")
    exceptional: tuple[ExceptionalValue, ...] = claim("exceptional values")
    outside: tuple[OutsideValue, ...] = claim("values out of range")
    evidence: MovedModes = witness(whole=True)

    @property
    @shown("undefined at the roots of")
    def undefined_at(self) -> tuple[Polynomial, ...]:
        """The irreducible polynomials at whose roots an entry is undefined."""
        return self.about.poles

    @property
    def exceptional_at(self) -> tuple[Polynomial, ...]:
        """The irreducible polynomials at whose roots another mode is fixed."""
        return tuple(each.value for each in self.exceptional)

    @property
    def settled(self) -> tuple[Polynomial, ...]:
        """Values at which a multiplicity may be larger, but nothing more is fixed."""
        return tuple(each.value for each in self.evidence.settled)

    @property
    def scale(self) -> Polynomial:
        """δ, the denominator of A, by which the roots named here are to be divided."""
        return self.about.A.reduced[1]

    @property
    @shown("in words")
    def words(self) -> tuple[str, ...]:
        """The modes that are fixed for every value, and those at exceptional values, in words."""
        t = self.about.parameters[0]
        scaled = "" if self.scale.degree < 1 else f" divided by {in_parameter(self.scale, t)}"
        told = [f"the roots of {mode_text(p, t)}{scaled} for every {t}" for p in self.generic]
        for each in self.exceptional:
            modes = " and ".join(
                f"{mode_text(mode.polynomial, t)}{scaled}"
                + (f" ({why})" if (why := self.because(mode)) else "")
                for mode in each.modes
            )
            told.append(f"the roots of {modes} where {value_text(each.value, each.roots, t)}")
        anywhere = self.about.parameters_in_words[0] if self.outside else t
        return tuple(told) or (f"no mode is {self._lost} for any {anywhere}",)

    @property
    def _lost(self) -> str:
        """The adjective of the modes: fixed modes are uncontrollable if all states are measured."""
        made = [each["construction"] for each in self.about.subject]
        if made[-1:] != ["full_output"]:
            return "fixed"
        return "unobservable" if "dual" in made else "uncontrollable"

    def at(self, value: Any) -> tuple[Polynomial, ...]:
        """The modes that are fixed at one value of the parameter.

        Parameters
        ----------
        value : exact number
            As entries of a system are given.

        Returns
        -------
        tuple of Polynomial
            The monic irreducible polynomials whose roots are the fixed modes, as
            ``fixed_spectrum(plant.at({…}))`` finds them.

        Raises
        ------
        InputError
            If an entry is undefined there, or nothing is claimed of values out of the range.

        Examples
        --------
        >>> from mcexact import ParametricSystem, fixed_spectrum
        >>> plant = ParametricSystem([["t"]], [[["t - 2"]]], [[[1]]], parameters=["t"])
        >>> found = fixed_spectrum(plant)
        >>> [str(p) for p in found.at(2)], found.at("1/2")
        (['x - 2'], ())
        """
        t, told = as_fraction(value, where="value"), self.about.parameters_in_words[0]
        if any(q(t) == 0 for q in self.undefined_at):
            raise InputError(f"an entry is undefined at {rational_text(t)}", where="value")
        if any(each.value(t) == 0 for each in self.outside):
            raise InputError(f"only {told} is decided, found {rational_text(t)}", where="value")
        here = [each for each in self.exceptional if each.value(t) == 0]
        fixed = [*self.generic, *(mode.polynomial for each in here for mode in each.modes)]
        found = {
            q.monic()
            for p in fixed
            for q, _ in Polynomial.from_coefficients([c(t) for c in p])
            .scale(self.scale(t))
            .factor()
        }
        return tuple(sorted(found, key=lambda q: (q.degree, q.coefficients)))

    def to_sympy(self) -> dict[Any, list[Any]]:
        """The modes at the exceptional values as polynomials of sympy, and with True the generic.

        Examples
        --------
        >>> from mcexact import ParametricSystem, fixed_spectrum
        >>> plant = ParametricSystem(
        ...     [["t", 0], [0, 3]], [[[0], ["t - 1/2"]]], [[[1, 1]]], parameters=["t"]
        ... )
        >>> fixed_spectrum(plant).to_sympy()
        {True: [Poly(x - t, x, domain='QQ[t]')], 1/2: [Poly(x - 3, x, domain='QQ[t]')]}
        """
        import sympy

        [t] = self.about.parameters
        # sympy's own True, as that of Python is equal to the value 1
        found: dict[Any, list[Any]] = {sympy.true: [mode_in_sympy(p, t) for p in self.generic]}
        for each in self.exceptional:
            found |= {root: [mode.to_sympy(t) for mode in each.modes] for root in each.to_sympy()}
        return found

    @property
    def rows(self) -> tuple[Row, ...]:
        """Where, the polynomials in x of the modes, and why these are fixed there."""
        return *self.told, *rows_left_out([self.left_out])

    @property
    def left_out(self) -> LeftOut:
        """The values of which it says nothing."""
        return left_out(self)

    @property
    def told(self) -> tuple[Row, ...]:
        """The rows about values of which it says something."""
        [t] = self.about.parameters
        scaled = "" if self.scale.degree < 1 else f", divided by {in_parameter(self.scale, t)}"
        found = [(f"every {t}", mode_text(p, t) + scaled, "") for p in self.generic]
        return (
            *found,
            *rows_of_values(
                self,
                lambda each: [
                    (mode_text(mode.polynomial, t) + scaled, self.because(mode))
                    for mode in each.modes
                ],
            ),
        )

    def explain(self) -> str:
        """Say in plain words what is fixed for every value, and what else at which."""
        return "\n".join(self.words)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield where, and what is fixed there."""
        for where, modes, why in self.rows or ((self.words[0], "", ""),):
            yield where, f"{modes}: {why}" if why else modes

    def because(self, mode: ExceptionalMode) -> str:
        """Which channels cause that a mode is fixed; empty if the answer is about some together."""
        made = self.about.subject
        if made and made[-1]["construction"] == "full_output":
            return ""
        return blame(mode.channels, self.about.names)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the modes against the parameter; see `mcexact.plot.parameter_modes`."""
        from mcexact.plot.parameters import parameter_modes

        return parameter_modes(self, ax, **options)

    def in_range(self) -> tuple[ExceptionalValue, ...]:
        """The exceptional values with a root in the range that is assumed of the parameter."""
        return tuple(each for each in self.exceptional if each.inside(self.about.ranges[0]))


# Answer: the rank of a matrix made from a plant, for every value of a parameter.


@dataclass(frozen=True)
class SetpointMatrix(Part):
    """[A, B; C, 0], in discrete time [A − I, B; C, 0], with all channels."""

    name: str = "setpoint"


@dataclass(frozen=True)
class SignalMatrix(Part):
    """[I⊗A − K⊗I, I⊗B; I⊗C, 0] with all channels, K the companion matrix of a polynomial.

    Its rows are independent iff those of [A − λI, B; C, 0] are at every root λ of the polynomial.

    Attributes
    ----------
    polynomial : Polynomial
        Monic, of degree 1 or more: s² + 4 for sinusoids of the angular frequency 2 in continuous
        time.
    """

    polynomial: Polynomial
    name: str = "signal"


@dataclass(frozen=True)
class ControllabilityMatrix(Part):
    """[B_T, A B_T, …, A^(k−1) B_T].

    Attributes
    ----------
    channels : tuple of str
        T.
    blocks : int
        k.
    """

    channels: tuple[str, ...]
    blocks: int
    name: str = "controllability"


@dataclass(frozen=True)
class TransferColumn(Part):
    """The column of all entries of C_i A^k B_j, k < n, which is 0 iff C_i (xI − A)⁻¹ B_j is.

    Attributes
    ----------
    source : str
        Channel j.
    to : str
        Channel i.
    """

    source: str = field(metadata={"key": "from"})
    to: str
    name: str = "transfer"


@dataclass(frozen=True)
class LowerRank(ParameterValue):
    """Values of the parameter at which the rank is less.

    Attributes
    ----------
    rank : int
        The rank there.
    """

    rank: int


@dataclass(frozen=True)
class Kernel(Part):
    """Independent columns that the matrix annihilates; its rows ``pivots`` are c(t) I."""

    columns: PolynomialMatrix
    pivots: tuple[int, ...]


@dataclass(frozen=True)
class TwoMinors(Part):
    """Evidence that the rank is no larger, and less at the values named alone.

    Attributes
    ----------
    kernel : Kernel or None
        None if the rank is full.
    rows, columns : tuples of int
        They form a minor of order r that is not 0.
    modulus : int
        ℓ.
    compressions : two of Matrix
        X and Y: det(X M Y), of order r, has modulo ℓ no other root in common with the minor.
    exceptional : tuple of Kernel
        One for each value, modulo it.
    undefined : tuple of Polynomial
        Roots of the minor at which an entry is undefined.
    """

    kernel: Kernel | None
    rows: tuple[int, ...]
    columns: tuple[int, ...]
    modulus: int
    compressions: tuple[Matrix, Matrix]
    exceptional: tuple[Kernel, ...]
    undefined: tuple[Polynomial, ...]


@answer("parametric_rank")
class ParametricRank(Answer):
    """The rank of a matrix M for every complex value of the parameter at which it is defined.

    Attributes
    ----------
    matrix : SetpointMatrix, SignalMatrix, ControllabilityMatrix or TransferColumn
        How M is made.
    rank : int
        r, the rank at almost all values.
    exceptional : tuple of LowerRank
        All values at which the rank is less, and the rank there.
    outside : tuple of OutsideValue
        Values of which nothing is claimed, because none is real and in the range assumed.
    evidence : TwoMinors
    """

    about: ParametricSystem  # type: ignore[assignment]
    matrix: SetpointMatrix | SignalMatrix | ControllabilityMatrix | TransferColumn = claim("matrix")
    rank: int = claim("rank")
    exceptional: tuple[LowerRank, ...] = claim("exceptional values")
    outside: tuple[OutsideValue, ...] = claim("values out of range")
    evidence: TwoMinors = witness(whole=True)

    @property
    def exceptional_at(self) -> tuple[Polynomial, ...]:
        """The irreducible polynomials at whose roots the rank is less."""
        return tuple(each.value for each in self.exceptional)

    @property
    def said(self) -> tuple[object, ...]:
        """The ranks, and where they are, to compare with those of another matrix."""
        return self.rank, {(each.value, each.rank) for each in self.exceptional}, self.outside

    @property
    @shown("in words")
    def words(self) -> tuple[str, ...]:
        """The rank for almost all values, and at which it is less, in the parameter's name."""
        t = self.about.parameters[0]
        told = [f"rank {self.rank} for {'almost ' * bool(self.exceptional)}every {self._every}"]
        for each in self.exceptional:
            told.append(f"rank {each.rank} where {value_text(each.value, each.roots, t)}")
        return tuple(told)

    @property
    def rows(self) -> tuple[Row, ...]:
        """The rows: values, the rank there, and the values of which nothing is said."""
        return *self.told, *rows_left_out([self.left_out])

    @property
    def left_out(self) -> LeftOut:
        """The values of which it says nothing."""
        return left_out(self)

    @property
    def told(self) -> tuple[Row, ...]:
        """The rows about values of which it says something."""
        generic = (
            f"{'almost ' * bool(self.exceptional)}every {self._every}",
            f"rank {self.rank}",
            "",
        )
        return generic, *rows_of_values(self, lambda each: [(f"rank {each.rank}", "")])

    @property
    def _every(self) -> str:
        """The parameter, with its range where values out of it are left out."""
        about = self.about
        return about.parameters_in_words[0] if self.outside else about.parameters[0]

    def in_range(self) -> tuple[LowerRank, ...]:
        """The exceptional values with a root in the range that is assumed of the parameter."""
        return tuple(each for each in self.exceptional if each.inside(self.about.ranges[0]))


# Templates of `mcexact analyze` about a plant with parameters.

_HAUTUS = "joint_controllability.controllable_hautus"
_RANK = "setpoint.setpoint_rank"

HEADING = Template(
    "parametric-heading",
    "{name:name}: {n:count state}, {m:count channel} {names:set}, {time:time} time, "
    "{parameters:words}{undefined:undefined}",
)

# The answer in words.

NOTHING_FIXED = Template("parametric-nothing-fixed", "For {every:words} no mode is fixed.")
FIXED = Template("parametric-fixed", "For {every:words} the roots of {modes:words} are fixed.")
ANOTHER = Template("parametric-another", "{another:another} mode is fixed where {where:values}.")

# For all values within ranges: proved by answers about boxes.

WITHIN_RANGES = {
    "box_fixed_modes": "no mode is fixed",
    "box_stabilizability": "a decentralized controller of its own stabilizes every plant",
    "box_controllability": "all channels together control every mode",
    "box_observability": "all channels together observe every mode",
}


def _ranges(stem: str, question: str, theorem: str) -> Template:
    said = f"For all values of {{parameters:words}}: {WITHIN_RANGES[question]}."
    return Template(f"parametric-ranges-{stem}", said, theorem)


RANGES = {
    "box_fixed_modes": _ranges("nothing-fixed", "box_fixed_modes", "boxes.regular_not_fixed"),
    "box_stabilizability": _ranges(
        "stabilizable", "box_stabilizability", "S. H. Wang and E. J. Davison 1973"
    ),
    "box_controllability": _ranges("controllable", "box_controllability", _HAUTUS),
    "box_observability": _ranges("observable", "box_observability", _HAUTUS),
}

# The table of all answers.


def _modes(stem: str, label: str, every: str, theorem: str = "") -> tuple[Template, ...]:
    """The sentences on modes: none for every value, none unless, some, some and others."""
    return (
        Template(f"parametric-{stem}-always", f"{every}, for {{every:words}}", theorem, label),
        Template(f"parametric-{stem}-unless", f"{every}, unless {{where:values}}", theorem, label),
        Template(
            f"parametric-{stem}-some",
            ("" if every == "none" else "all but ") + "the roots of {modes:words}, for "
            "{every:words}",
            theorem,
            label,
        ),
        Template(
            f"parametric-{stem}-more",
            ("" if every == "none" else "all but ") + "the roots of {modes:words}; "
            "others, too, where {where:values}",
            theorem,
            label,
        ),
    )


MODES = {
    "fixed_spectrum": _modes("modes", "fixed modes", "none"),
    "joint_controllability": _modes("controllable", "jointly controllable", "every mode", _HAUTUS),
    "joint_observability": _modes("observable", "jointly observable", "every mode", _HAUTUS),
    "channel_controllability": _modes(
        "channel-controllable", "controlled by the channel", "every mode", _HAUTUS
    ),
    "channel_observability": _modes(
        "channel-observable", "observed by the channel", "every mode", _HAUTUS
    ),
}
GRAPH = (
    Template("parametric-graph-always", "{edges:edges}, for {every:words}", label="transfer graph"),
    Template("parametric-graph-lost", "{edges:edges}; {lost:lost}", label="transfer graph"),
)
COMPLETE = (
    Template("parametric-complete-always", "yes, for {every:words}", label="complete"),
    Template("parametric-complete-unless", "yes, unless {where:values}", label="complete"),
    Template("parametric-complete-never", "no, for no value of {t:words}", label="complete"),
)


def _indices(name: str) -> tuple[Template, ...]:
    """The sentences on indices: for every value, or others at some."""
    return (
        Template(
            f"parametric-{name}-indices-always",
            "{indices:indices}, for {every:words}",
            label=f"{name} indices",
        ),
        Template(
            f"parametric-{name}-indices-unless",
            "{indices:indices}, unless {where:values}",
            label=f"{name} indices",
        ),
    )


INDICES = {name: _indices(name) for name in ("controllability", "observability")}
SETPOINT = (
    Template(
        "parametric-setpoint-always",
        "every set-point has an equilibrium, for {every:words}",
        _RANK,
        "set-points",
    ),
    Template(
        "parametric-setpoint-unless",
        "every set-point has an equilibrium, unless {where:values}",
        _RANK,
        "set-points",
    ),
    Template(
        "parametric-setpoint-never",
        "not every set-point has an equilibrium, for any value of {t:words}",
        _RANK,
        "set-points",
    ),
)

# With several parameters: what a certificate along a line implies for almost all values, and
# what it says of its line.


def _almost(stem: str, said: str, theorem: str = "") -> Template:
    text = f"For almost all values of {{parameters:words}} {said}."
    return Template(f"parametric-almost-{stem}", text, theorem)


ALMOST = {
    "fixed_spectrum": _almost("nothing-fixed", "no mode is fixed"),
    "joint_controllability": _almost(
        "controllable", "all channels together control every mode", _HAUTUS
    ),
    "joint_observability": _almost(
        "observable", "all channels together observe every mode", _HAUTUS
    ),
    "channel_controllability": _almost(
        "channel-controllable", "the channel controls every mode", _HAUTUS
    ),
    "channel_observability": _almost(
        "channel-observable", "the channel observes every mode", _HAUTUS
    ),
    "transfer_graph": _almost("graph", "the transfer graph has these edges: {edges:edges}"),
    "completeness": _almost("complete", "the plant is complete"),
    "setpoint": _almost("setpoint", "every set-point has an equilibrium", _RANK),
}


def _on_line(stem: str, label: str) -> Template:
    return Template(f"parametric-line-{stem}", "{line:words} | {found:words}", label=label)


ON_LINE = {
    "fixed_spectrum": _on_line("modes", "fixed modes"),
    "joint_controllability": _on_line("controllable", "modes that no channel controls"),
    "joint_observability": _on_line("observable", "modes that no channel observes"),
    "controllability_indices": _on_line("controllability-indices", "ranks of [B, AB, …]"),
    "observability_indices": _on_line("observability-indices", "ranks of [C; CA; …]"),
    "transfer_graph": _on_line("graph", "edges of the transfer graph"),
    "setpoint": _on_line("setpoint", "rank of the matrix of equilibria"),
    "channel_controllability": _on_line(
        "channel-controllable", "modes that the channel does not control"
    ),
    "channel_observability": _on_line(
        "channel-observable", "modes that the channel does not observe"
    ),
}


# Sentences for one parameter or several, filled from values, whatever proves these.

RULES = Rulebook()
rule = RULES.rule

Said = Iterator[Sentence]
Edge = tuple[str, str]


@dataclass(frozen=True)
class Values:
    """The exceptional values, and the words for all others.

    Attributes
    ----------
    every : str
        The values that are decided, such as "every value of t in [0, 1]".
    where : tuple of str
        The exceptional ones, each as a condition such as "t = 1/2".
    """

    every: str
    where: tuple[str, ...]

    @property
    def almost(self) -> str:
        """The values without the exceptional ones, in words."""
        return self.every.replace("every", "almost every", 1) if self.where else self.every

    @property
    def given(self) -> dict[str, Any]:
        """The fields of templates."""
        return {"every": self.almost, "where": self.where}


def values_of(claims: Iterable[Claim], context: Context) -> Values:
    """The exceptional values of certificates about one parameter."""
    where: dict[str, None] = {}
    every = f"every value of {context.parameter}{context.apart}"
    for certified in claims:
        if [each.value for each in certified.outside]:
            every = f"every value of {context.parameters}{context.apart}"
        for each in certified.exceptional:
            where[value_text(each.value, [*each.roots], context.parameter)] = None
    return Values(every, tuple(where))


def scaled(context: Context) -> str:
    """The words for what modes are divided by; empty unless A has denominators."""
    if context.scale.degree < 1:
        return ""
    return f", divided by {in_parameter(context.scale, context.parameter)}"


def fixed(modes: str, values: Values) -> Said:
    """Which modes are fixed for almost every value, and that others are at some."""
    if modes:
        # What they are divided by is put in, between two commas.
        yield FIXED(modes=modes + "," * (", divided by " in modes), every=values.almost)
    else:
        yield NOTHING_FIXED(every=values.almost)


def another(modes: str, values: Values) -> Said:
    """The values at which another mode is fixed."""
    if values.where:
        yield ANOTHER(another=bool(modes), where=values.where)


def in_table(question: str, modes: str, values: Values) -> Said:
    """The modes of a question for almost every value, and the values at which there are others."""
    always, unless, some, more = MODES[question]
    told = (more if values.where else some) if modes else (unless if values.where else always)
    yield told(modes=modes, **values.given)


def graph(columns: Sequence[tuple[Edge, int, Values]]) -> Said:
    """The edges for almost every value, and the values at which edges vanish."""
    edges = [edge for edge, rank, _ in columns if rank]
    lost = [(edge, values.where) for edge, _, values in columns if values.where]
    if lost:
        yield GRAPH[1](edges=edges, lost=lost)
    else:
        whole = [values.every for _, _, values in columns]
        yield GRAPH[0](edges=edges, every=max(whole, key=len))


def complete(
    names: Sequence[str],
    modes: str,
    values: Values,
    columns: Sequence[tuple[Edge, int, Values]],
    t: str,
) -> Said:
    """Whether no mode is fixed and the edges connect all channels, and where not."""
    edges = {edge: found.where for edge, rank, found in columns if rank}
    if modes or not connects(names, edges):
        yield COMPLETE[2](t=t)
        return
    where = dict.fromkeys(values.where)
    for at in dict.fromkeys(each for listed in edges.values() for each in listed):
        if not connects(names, [edge for edge, lost in edges.items() if at not in lost]):
            where[at] = None
    every = max([values.every, *(found.every for _, _, found in columns)], key=len)
    told = Values(every, tuple(where))
    yield (COMPLETE[1] if where else COMPLETE[0])(**told.given)


def indices(name: str, ranks: Sequence[int], values: Values) -> Said:
    """The indices for almost every value: how many k have a rank that grows by j or more."""
    growth = [b - a for a, b in zip([0, *ranks], ranks, strict=False)]
    sizes = [sum(g > j for g in growth) for j in range(growth[0])]
    told = INDICES[name][bool(values.where)]
    yield told(indices=[size for size in sizes if size], **values.given)


def setpoints(rank: int, full: int, values: Values, t: str) -> Said:
    """Whether every set-point has an equilibrium."""
    always, unless, never = SETPOINT
    if rank < full:
        yield never(t=t)
    else:
        yield (unless if values.where else always)(**values.given)


# Rules that fill these sentences from certificates about one parameter.


@rule("title", HEADING)
def _heading(context: Context) -> Said:
    yield heading(context)


def heading(context: Context) -> Sentence:
    """The sizes of the system, and its parameters."""
    return HEADING(
        name=context.name or "system",
        n=context.n,
        m=context.m,
        names=context.names,
        time=context.time,
        parameters=context.parameters,
        undefined=context.undefined,
    )


def modes_of(spectrum: Claim, context: Context) -> str:
    """The generic modes of a certificate, with what all are divided by; nothing if it has none."""
    modes = ", ".join(mode_text(p, context.parameter) for p in spectrum.generic)
    return modes and modes + scaled(context)


RANGE_RULES = Rulebook()
"""The rules about all values within ranges, of which there may be several."""


def _within_ranges(question: str, holds: Callable[[Claim, Context], bool]) -> None:
    @RANGE_RULES.rule("answer", RANGES[question], premises=(question,))
    def _said(found: Claim, context: Context) -> Said:
        if holds(found, context):
            yield RANGES[question](parameters=context.parameters)


_within_ranges("box_fixed_modes", lambda found, context: found.bound is None)
_within_ranges("box_stabilizability", lambda found, context: found.bound is not None)
for each in ("box_controllability", "box_observability"):
    _within_ranges(
        each, lambda found, context: found.bound is None and len(found.channels) == context.m
    )
RULES.extend(RANGE_RULES)


@rule("answer", FIXED, NOTHING_FIXED, premises=("fixed_spectrum",))
def _fixed(fixed_spectrum: Claim, context: Context) -> Said:
    yield from fixed(modes_of(fixed_spectrum, context), values_of([fixed_spectrum], context))


@rule("answer", ANOTHER, premises=("fixed_spectrum",))
def _another(fixed_spectrum: Claim, context: Context) -> Said:
    yield from another(modes_of(fixed_spectrum, context), values_of([fixed_spectrum], context))


def _of_modes(question: str) -> None:
    @rule("table", *MODES[question], premises=(question,))
    def _row(found: Claim, context: Context) -> Said:
        yield from in_table(question, modes_of(found, context), values_of([found], context))


for each in ("joint_controllability", "joint_observability"):
    _of_modes(each)


def _columns(edges: Iterable[Claim], context: Context) -> list[tuple[Edge, int, Values]]:
    return [
        ((getattr(each.matrix, "from"), each.matrix.to), each.rank, values_of([each], context))
        for each in edges
    ]


@rule("table", *GRAPH, premises=("transfer_graph",))
def _graph(transfer_graph: Iterable[Claim], context: Context) -> Said:
    yield from graph(_columns(transfer_graph, context))


_of_modes("fixed_spectrum")


@rule("table", *COMPLETE, premises=("fixed_spectrum", "transfer_graph"))
def _complete(fixed_spectrum: Claim, transfer_graph: Iterable[Claim], context: Context) -> Said:
    yield from complete(
        context.names,
        modes_of(fixed_spectrum, context),
        values_of([fixed_spectrum], context),
        _columns(transfer_graph, context),
        context.parameter,
    )


def _of_indices(name: str) -> None:
    @rule("table", *INDICES[name], premises=(f"{name}_indices",))
    def _row(found: Iterable[Claim], context: Context) -> Said:
        parts = [(each.rank, values_of([each], context)) for each in found]
        every = max((values.every for _, values in parts), key=len)
        where = dict.fromkeys(at for _, values in parts for at in values.where)
        yield from indices(name, [rank for rank, _ in parts], Values(every, tuple(where)))


for each in INDICES:
    _of_indices(each)


@rule("table", *SETPOINT, premises=("setpoint",))
def _setpoints(setpoint: Claim, context: Context) -> Said:
    values = values_of([setpoint], context)
    yield from setpoints(setpoint.rank, context.n + context.outputs, values, context.parameter)


for each in ("channel_controllability", "channel_observability"):
    _of_modes(each)
