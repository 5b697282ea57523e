"""What is fixed whatever the numbers of a plant are, and sentences why modes are fixed.

The answer `StructuralFixedModes` is about the places of the entries of a plant that are not 0.  It
has the modes that are fixed for all numbers at these places; almost all numbers fix no others.  So
it divides the fixed modes of the plant in two: those that its zeros fix, which stay with all other
numbers but those among the states without feedback, and those that equalities between its entries
fix, which almost all other numbers free.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from mcexact.answer.protocol import Answer, answer, claim, shown, witness
from mcexact.answer.sentence import Claim, Context, Rulebook
from mcexact.answer.templates import Sentence, Template
from mcexact.exact.polynomial import Polynomial

Information = Literal["own", "outputs"]
Said = Iterator[Sentence]


@answer("structural_fixed_modes")
class StructuralFixedModes(Answer):
    """For all plants with zeros wherever this one has zeros, x^z det(xI − A_UU) is fixed.

    That is, it divides det(xI − A − Σ B_i F_ij C_j) for all constant gains F_ij.  For almost all
    such plants, those outside the zeros of one polynomial in their entries, it is the greatest
    common divisor of these.

    Attributes
    ----------
    information : {"own", "outputs"}
        Whether each agent feeds back its own outputs alone, so that F_ij = 0 for j ≠ i, or also
        those of its neighbors.
    without_feedback : tuple of int
        U, the states, counted from 0, that are on no closed path through an input and an output.
        Their modes are those of A_UU, which move with its numbers.
    at_zero : int
        z, the number of other states less the largest number of them that disjoint closed paths
        cover.
    polynomial : Polynomial
        x^z det(xI − A_UU), with the numbers of this plant.
    rows, columns : tuple of int
        For each state that is not in U, each input and each output: numbers that prove that x^z is
        a factor.
    matching : tuple of int
        Which column is taken from each of these rows, in a product with no more factors x.
    """

    information: Information = claim()
    without_feedback: tuple[int, ...] = claim("states without feedback")
    at_zero: int = claim("further modes at 0")
    polynomial: Polynomial = claim("structural fixed modes")
    rows: tuple[int, ...] = witness()
    columns: tuple[int, ...] = witness()
    matching: tuple[int, ...] = witness()

    @property
    @shown("nothing is fixed for all numbers")
    def empty(self) -> bool:
        """Whether almost all plants with zeros at the same places have no fixed mode."""
        return self.polynomial.degree == 0


# Sentences: what is fixed for all numbers, and why modes of a plant are fixed.

_SOURCES = "M. E. Sezer and D. D. Siljak 1981"
_LABEL = "structural fixed modes"
NONE = Template("structural-none", "none{information:fed}", _SOURCES, _LABEL)
MODES = Template(
    "structural-modes",
    "{modes:of pattern}{information:fed}",
    f"patterns.structural_modes; {_SOURCES}",
    _LABEL,
)
ZEROS = Template(
    "fixed-by-zeros",
    "zeros; no numbers in feedback loops free {p:modes}",
    "patterns.structural_modes",
    "why fixed",
)
EQUALITIES = Template(
    "fixed-by-equalities",
    "equalities; almost all other data free {p:modes}",
    _SOURCES,
    "why fixed",
)
WHY_RULES = Rulebook()


@WHY_RULES.rule("table", NONE, MODES, premises=("structural_fixed_modes",))
def _structural(structural: Claim, context: Context) -> Said:
    """The answer, unless modes of the same plant are fixed: then it is a reason."""
    information, p = structural.information, structural.polynomial
    if information == "own" and context.has("fixed"):
        return
    if not p.degree:
        yield NONE(information=information)
    else:
        apart = tuple(k + 1 for k in structural.without_feedback)
        yield MODES(modes=(apart, structural.at_zero), information=information)


@WHY_RULES.rule("table", ZEROS, EQUALITIES, premises=("structural_fixed_modes", "fixed_spectrum"))
def _why(structural: Claim, spectrum: Claim, context: Context) -> Said:
    """One row if the zeros fix all modes, or none; else a row for each factor."""
    if structural.information != "own" or spectrum.polynomial.degree == 0:
        return
    p, zeros = spectrum.polynomial, structural.polynomial
    if p.divides(zeros):
        yield ZEROS(p=p)
    elif p.gcd(zeros).degree == 0:
        yield EQUALITIES(p=p)
    else:
        for factor in spectrum.factors.separately():
            q = factor.polynomial
            yield (ZEROS if q.divides(zeros) else EQUALITIES)(p=q)
