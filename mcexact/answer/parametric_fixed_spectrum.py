"""Answer: the fixed modes for every value of a parameter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from mcexact.answer.evidence import ZeroBlock
from mcexact.answer.mode_words import blame
from mcexact.answer.parameter_values import (
    LeftOut,
    ModePolynomial,
    OutsideValue,
    ParameterValue,
    Row,
    in_parameter,
    left_out,
    mode_in_sympy,
    mode_text,
    rows_left_out,
    rows_of_values,
    value_text,
)
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction, rational_text
from mcexact.model.parametric import ParametricSystem


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
        """What is fixed for every value, and at which values what else, in the parameter's name."""
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
        """What modes are, in a word: those that remain where the whole state is measured."""
        made = [each["construction"] for each in self.about.subject]
        if made[-1:] != ["full_output"]:
            return "fixed"
        return "unobservable" if "dual" in made else "uncontrollable"

    def at(self, value: Any) -> tuple[Polynomial, ...]:
        """What is fixed at one value of the parameter.

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
