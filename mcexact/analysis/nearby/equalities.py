"""Why modes are fixed: by equalities between entries, or by the places of the zeros alone.

`why_fixed` draws other numbers at the places of the entries of a plant, and looks at what is fixed
then.  It decides block by block: in the blocks of `state_blocks` the closed loop separates whatever
the numbers are, so that a mode of one block says nothing about another block.

1. Blocks in which no mode of the drawn plant is fixed are *free*.  The *redrawn* plant has other
   numbers in these, and those of the given plant in all others.  A mode of the given plant that is
   not fixed there is fixed by equalities between entries of free blocks; the certificate is the
   fixed spectrum of the redrawn plant.  That a block has other fixed modes proves nothing: with
   diag(a, b) and no inputs, other numbers have other modes, and none of them can be moved.
2. Other blocks keep fixed modes with drawn numbers.  If as many are fixed with these as with the
   own ones, the zeros alone fix them; that is computed, since other numbers might do better.
3. Laws: for a rational mode that is freed, and that all channels together do not observe, or not
   control, the null space of [λI − A; C], or of [λI − A'; B'].
"""

from __future__ import annotations

import random
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, Literal

from mcexact.analysis.blocks import (
    StateBlock,
    bounded_blocks,
    completed_blocks,
    modes_left,
    state_blocks,
)
from mcexact.analysis.fixed_modes import fixed_spectrum, pencil_rank
from mcexact.answer.modes import ByBlocks, FixedFactor, FixedSpectrum, PencilRank
from mcexact.answer.templates import modes
from mcexact.derived.constructions import dual
from mcexact.derived.modular import generator
from mcexact.errors import InputError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import written
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown

Cause = Literal["equalities", "zeros"]
_LARGEST = 99
_MOST_LAWS = 4
_X = Polynomial.from_roots([0])
_SAID = {
    "equalities": "equalities between entries fix {}: other nonzero entries leave fewer fixed",
    "zeros": "the zeros alone fix {}: other nonzero entries leave as many fixed",
}


@dataclass(frozen=True, eq=False)
class WhyFixed(Shown):
    """Why modes of a plant are fixed.

    Attributes
    ----------
    system : MultiChannelSystem
    freed : tuple of Polynomial
        Factors of the fixed spectrum that equalities between entries fix, as `proof` shows.
    proof : FixedSpectrum or None
        The fixed spectrum of a plant with other numbers at the same places; None if no factor is
        freed.
    laws : tuple of PencilRank
        For such modes that all channels together do not observe, or, of the dual plant, not
        control: the vectors of their null spaces.
    computed : tuple of (Polynomial, {"equalities", "zeros"})
        What is computed of other factors, and not certified.
    """

    system: MultiChannelSystem
    freed: tuple[Polynomial, ...]
    proof: FixedSpectrum | None
    laws: tuple[PencilRank, ...]
    computed: tuple[tuple[Polynomial, Cause], ...]

    @property
    def answers(self) -> dict[str, FixedSpectrum | PencilRank]:
        """The proofs, by the names of their certificates."""
        named: dict[str, FixedSpectrum | PencilRank] = {}
        if self.proof is not None:
            named["redrawn"] = self.proof
        return named | {f"law_{k}": law for k, law in enumerate(self.laws, 1)}

    @property
    def known(self) -> bool:
        """Whether anything is known, certified or computed."""
        return bool(self.freed or self.laws or self.computed)

    def explain(self) -> str:
        """Say in plain words why modes are fixed, one reason a line."""
        return "\n".join(text for _, text in self._labeled()) or "nothing is known"

    def in_words(self) -> list[str]:
        """What is computed and not certified, one sentence for each factor."""
        return [_SAID[cause].format(modes(p)) for p, cause in self.computed]

    def __repr__(self) -> str:
        return f"WhyFixed({len(self.freed)} factors by equalities, {len(self.computed)} computed)"

    def _labeled(self) -> Iterator[tuple[str, str]]:
        """Yield the reasons."""
        for p in self.freed:
            yield "certified", _SAID["equalities"].format(modes(p))
        yield from (("computed", f"computed, not certified: {text}") for text in self.in_words())

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        laws = [
            {"mode": _listed(law.polynomial), "certificate": f"law_{k}.json"}
            for k, law in enumerate(self.laws, 1)
        ]
        proved = (
            {}
            if self.proof is None
            else {
                "certificate": "redrawn.json",
                "plant": self.proof.about.plant.to_dict(),
            }
        )
        return {
            "by_equalities": [_listed(p) for p in self.freed],
            **proved,
            "laws": laws,
            "computed_not_certified": [
                {"mode": _listed(p), "fixed_by": cause} for p, cause in self.computed
            ],
        }


def _listed(p: Polynomial) -> list[Any]:
    return [written(c) for c in p.coefficients]


def why_fixed(system: MultiChannelSystem, spectrum: FixedSpectrum | None = None) -> WhyFixed:
    """Say why modes of a plant are fixed.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, no derived system.
    spectrum : FixedSpectrum, optional
        Its fixed spectrum, if it is known already.

    Raises
    ------
    InputError
        If the system is a derived one.

    Notes
    -----
    What is freed is exact.  It costs three fixed spectra at most, since what is computed of the
    rest compares those of the blocks, and what the ranks of at most 4 pencils cost.

    Examples
    --------
    The outputs do not show (1, 1), since the rows of A sum to the same number:

    >>> plant = MultiChannelSystem([[1, 2], [4, -1]], [[[1], [0]]], [[[1, -1]]])
    >>> why = why_fixed(plant)
    >>> [str(p) for p in why.freed], why.laws[0].kernel.matrices[0].rows()
    (['x - 3'], ((Fraction(1, 1),), (Fraction(1, 1),)))

    No input drives the first state, so that its mode is fixed whatever its number is:

    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[0], [1]]], [[[1, 1]]])
    >>> [(str(p), cause) for p, cause in why_fixed(plant).computed]
    [('x - 1', 'zeros')]
    """
    InputError.require(system, MultiChannelSystem, "system")
    if system.subject:
        raise InputError("expected a plant, found a derived system", where="system")
    if spectrum is None:
        spectrum = fixed_spectrum(system)
    own = [factor.polynomial for factor in spectrum.factors]
    if not own:
        return WhyFixed(system, (), None, (), ())
    rng = generator(system, "redrawn")
    drawn = _redrawn(system, range(system.n), rng)
    blocks = completed_blocks(drawn, bounded_blocks(drawn))
    free = {a for block in blocks if not modes_left([block]) for a in block.states}
    freed, proof = _freed(system, own, drawn, free)
    rest = [p for p in own if p not in freed]
    laws = tuple(_laws(system, [f for f in spectrum.factors if f.polynomial in freed]))
    return WhyFixed(system, freed, proof, laws, tuple(_computed(system, drawn, rest)))


def _redrawn(
    system: MultiChannelSystem, states: Collection[int], rng: random.Random
) -> MultiChannelSystem:
    """The plant with other numbers in the rows and columns of some states."""
    kept = {*states}
    able = [x for x in range(-_LARGEST, _LARGEST + 1) if x]

    def table(M: Matrix, *, rows: bool, columns: bool) -> Matrix:
        inside = (
            (
                i,
                j,
                rng.choice(able)
                if (i in kept or not rows) and (j in kept or not columns)
                else M[i, j],
            )
            for i, j, _ in M.nonzero()
        )
        return Matrix.from_entries(M.shape, inside)

    return MultiChannelSystem(
        table(system.A, rows=True, columns=True),
        [table(M, rows=True, columns=False) for M in system.B],
        [table(M, rows=False, columns=True) for M in system.C],
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )


def _freed(
    system: MultiChannelSystem, own: list[Polynomial], drawn: MultiChannelSystem, free: set[int]
) -> tuple[tuple[Polynomial, ...], FixedSpectrum | None]:
    """The factors that other numbers in free blocks free, and the proof."""
    if not free:
        return (), None
    whole = len(free) == system.n
    other = drawn if whole else _redrawn(system, free, generator(system, "redrawn"))
    proof = fixed_spectrum(other)
    if proof.factors and not isinstance(proof.evidence, ByBlocks):
        return (), None
    if proof.factors and not free <= _left_free(proof.evidence):
        return (), None
    kept = {factor.polynomial for factor in proof.factors}
    freed = tuple(p for p in own if p not in kept)
    return freed, proof if freed else None


def _left_free(evidence: Any) -> set[int]:
    """The states of the blocks that leave no mode by this evidence."""
    return {a for block in evidence.blocks if not modes_left([block]) for a in block.states}


def _computed(
    system: MultiChannelSystem, drawn: MultiChannelSystem, rest: list[Polynomial]
) -> Iterator[tuple[Polynomial, Cause]]:
    """What fixes the other factors, as far as one set of drawn numbers tells."""
    if not rest:
        return
    pairs = [*zip(state_blocks(system), state_blocks(drawn), strict=True)]
    causes = [_causes(system.A, own, other) for own, other in pairs]
    for p in rest:
        of_blocks = {each[p] for each in causes if p in each}
        if "zeros" in of_blocks:
            yield p, "zeros"
        elif of_blocks == {"equalities"}:
            yield p, "equalities"


def _causes(A: Matrix, own: StateBlock, drawn: StateBlock) -> dict[Polynomial, Cause | None]:
    """What fixes the factors of one block; None where the drawn numbers do not tell."""
    if own.system is None or drawn.system is None:
        within = A.take(own.states, own.states)
        return {p: "zeros" for p, _ in characteristic_polynomial(within).factor()}
    factors = fixed_spectrum(own.system).factors
    others = fixed_spectrum(drawn.system).factors if factors else ()
    same = _count(factors) == _count(others)
    # Modes at 0 do not depend on the numbers: the zeros fix as many as the drawn plant keeps.
    at_zero = all(factor.polynomial == _X for factor in others)
    kept = sum(factor.multiplicity_at_most for factor in others if factor.polynomial == _X)
    causes: dict[Polynomial, Cause | None] = {}
    for factor in factors:
        p = factor.polynomial
        causes[p] = "equalities" if at_zero else None
        if same or (at_zero and p == _X and kept >= factor.multiplicity_at_most):
            causes[p] = "zeros"
        elif at_zero and p == _X and kept:
            causes[p] = None
    return causes


def _count(factors: Iterable[FixedFactor]) -> int:
    """How many modes are fixed, with multiplicity."""
    return sum(each.polynomial.degree * each.multiplicity_at_most for each in factors)


def _laws(system: MultiChannelSystem, factors: Iterable[FixedFactor]) -> Iterator[PencilRank]:
    """Null spaces at rational modes that all channels together do not observe or control."""
    whole = (
        factor
        for factor in factors
        if factor.polynomial.degree == 1 and factor.channels in ((), system.names)
    )
    for factor in islice(whole, _MOST_LAWS):
        about = system if factor.channels else dual(system)
        yield pencil_rank(about, system.names, factor.polynomial)
