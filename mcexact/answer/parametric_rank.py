"""Answer: the rank of a matrix made from a plant, for every value of a parameter."""

from __future__ import annotations

from dataclasses import dataclass, field

from mcexact.answer.parameter_values import (
    LeftOut,
    OutsideValue,
    ParameterValue,
    Row,
    left_out,
    rows_left_out,
    rows_of_values,
    value_text,
)
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.parametric import ParametricSystem


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
        """Where the rank is which."""
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
