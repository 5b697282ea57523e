"""A system with one parameter, its matrices multiplied by what makes them polynomial."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from mcexact.derived.modular_system import ModularSystem
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.two_variables import value_at
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True, eq=False)
class PolynomialSystem:
    """A', B_i', C_i' with A = A'/δ, B_i = B_i'/β_i, C_i = C_i'/γ_i in lowest terms.

    Where no denominator vanishes, a mode of the system times δ is one of these matrices, and one is
    fixed if and only if the other is.

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
            value_at(self.A, t),
            [value_at(B_i, t) for B_i in self.B],
            [value_at(C_i, t) for C_i in self.C],
            names=self.system.names,
        )

    def modulo(self, t: int, ell: int) -> ModularSystem:
        """The same modulo a prime that divides no denominator, t a residue."""

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
