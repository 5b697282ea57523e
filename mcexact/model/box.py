"""Boxes of plants: all plants whose entries are within radii of those of a nominal plant.

A `Box` is a nominal plant with `Radii`.  There are three ways to make one: each radius a part of
its entry (`relative`), radii of their own (`absolute`), or half a unit of the last digit of each
decimal as typed (`as_typed`).  `member` draws a plant of the box.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import Any, ClassVar

from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.exact.rational import approximated
from mcexact.model.radii import Radii, typed_radii
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown

_FINE = 2**20
"""Members inside of a box are at multiples of this part of the radii."""


@dataclass(frozen=True, init=False, repr=False)
class Box(Shown):
    """All plants whose entries differ from those of a nominal plant by at most their radii.

    A member has |A − A0| ≤ D_A, |B_i − B0_i| ≤ D_B,i and |C_i − C0_i| ≤ D_C,i entry by entry, each
    entry independently of all others.

    Parameters
    ----------
    system : MultiChannelSystem
        The nominal plant, no derived system.
    radii : Radii, optional
        D_A, D_B and D_C; by default those of the system, of which every entry may be certain.

    Attributes
    ----------
    system : MultiChannelSystem
        The nominal plant with the radii, which certificates about the box are about.

    Raises
    ------
    UsageError
        If the system was made by a construction.
    InputError
        If the radii have other shapes than the matrices.

    Notes
    -----
    The digest covers values and radii: 0.10 and 0.1 differ if the digits are as typed.

    Examples
    --------
    >>> plant = MultiChannelSystem([["0.5"]], [[["2.0"]]], [[[1]]])
    >>> box = Box.relative(plant, "1/100")
    >>> box
    Box(n=1, m=1, continuous time: 3 entries are uncertain, by at most 1 %)
    >>> box.radii.B[0].rows()
    ((Fraction(1, 50),),)
    >>> box.contains(plant), box.contains(MultiChannelSystem([["0.6"]], [[["2.0"]]], [[[1]]]))
    (True, False)
    """

    _becomes: ClassVar[dict[str, str]] = {"MultiChannelSystem": "give the `system` of the box"}
    system: MultiChannelSystem

    def __init__(self, system: MultiChannelSystem, radii: Radii | None = None) -> None:
        InputError.require(system, MultiChannelSystem, "system")
        held = system if radii is None else system.with_uncertainty(radii)
        if held.subject:
            raise UsageError("a box is made of a plant, and not of a derived system")
        object.__setattr__(self, "system", held)

    @classmethod
    def relative(cls, system: MultiChannelSystem, radius: Any) -> Box:
        """The plants each of whose entries differs by at most a part, such as 1 %, of its modulus.

        Zeros are certain.

        Parameters
        ----------
        system : MultiChannelSystem
        radius : rational or str
            A part, such as "0.1%" or "1/1000".
        """
        return cls(system, Radii.relative(system.A, system.B, system.C, radius))

    @classmethod
    def absolute(
        cls,
        system: MultiChannelSystem,
        A: Any = None,
        B: Sequence[Any] | None = None,
        C: Sequence[Any] | None = None,
    ) -> Box:
        """The plants within these radii of the entries of A, B_i and C_i; the default is 0.

        Parameters
        ----------
        system : MultiChannelSystem
        A : matrix, n×n, optional
        B, C : sequences of m matrices, optional
        """
        zeros = _zeros(system)
        radii: list[Any] = [zeros[k] if M is None else M for k, M in enumerate((A, B, C))]
        return cls(system, Radii(radii[0], radii[1], radii[2]))

    @classmethod
    def as_typed(cls, A: Any, B: Sequence[Any], C: Sequence[Any], **options: Any) -> Box:
        """The plants that look like this one to the digits typed.

        Parameters
        ----------
        A, B, C : matrices
            Entries are texts such as "0.10", or Decimals.  A decimal with a point or an exponent is
            known to half a unit of its last digit; integers, quotients and zeros are certain.
        **options
            As `MultiChannelSystem` takes them.

        Examples
        --------
        >>> Box.as_typed([["0.10"]], [[[1]]], [[["0.1"]]]).radii.A[0, 0]
        Fraction(1, 200)
        """
        system = MultiChannelSystem(A, B, C, **options)
        n = system.n
        return cls(
            system,
            Radii(
                typed_radii(A, "A"),
                [typed_radii(M, f"B[{i}]") for i, M in enumerate(B)],
                [typed_radii(M, f"C[{i}]", n) for i, M in enumerate(C)],
            ),
        )

    @property
    def radii(self) -> Radii:
        """D_A, D_B and D_C."""
        uncertainty = self.system.uncertainty
        return Radii(*_zeros(self.system)) if uncertainty is None else uncertainty

    @property
    def part(self) -> Fraction | None:
        """The ratio of radius to modulus that all entries have; None if the ratios differ.

        It is 0 where all entries and all radii are 0.

        Examples
        --------
        >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[0]]])
        >>> Box.relative(plant, "1/50").part
        Fraction(1, 50)
        >>> Box.absolute(plant, A=[[1]]).part is Box.absolute(plant, C=[[[1]]]).part is None
        True
        """
        parts = set()
        for (_, D), M in zip(self.radii.matrices(), matrices_of(self.system), strict=True):
            radii = {(i, j): Fraction(x, D.denominator) for i, j, x in D.nonzero()}
            values = {(i, j): Fraction(abs(x), M.denominator) for i, j, x in M.nonzero()}
            if not radii.keys() <= values.keys():
                return None
            parts |= {radii.get(place, Fraction(0)) / x for place, x in values.items()}
        parts = parts or {Fraction(0)}
        return parts.pop() if len(parts) == 1 else None

    @property
    def nominal(self) -> MultiChannelSystem:
        """The nominal plant, without radii."""
        return self.system.with_uncertainty(None)

    @property
    def n(self) -> int:
        """The number of states."""
        return self.system.n

    @property
    def m(self) -> int:
        """The number of channels."""
        return self.system.m

    def scaled(self, factor: Any) -> Box:
        """The box whose radii are multiplied by a number that is at least 0."""
        return Box(self.system, self.radii * Fraction(factor))

    def contains(self, plant: MultiChannelSystem) -> bool:
        """Whether a plant of the same shapes is a member; names and graphs are not compared."""
        for (_, D), M, M0 in zip(
            self.radii.matrices(), matrices_of(plant), matrices_of(self.system), strict=True
        ):
            if M.shape != M0.shape or plant.time != self.system.time:
                return False
            if any(
                abs(Fraction(x, (M - M0).denominator)) > D[i, j] for i, j, x in (M - M0).nonzero()
            ):
                return False
        return True

    def member(self, rng: random.Random, *, vertex: bool = False) -> MultiChannelSystem:
        """Draw a member.

        Parameters
        ----------
        rng : random.Random
        vertex : bool
            Whether every uncertain entry is at one of its two ends; otherwise it is anywhere in its
            interval, on a grid of 2²¹ steps.

        Examples
        --------
        >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[0]]])
        >>> corner = Box.relative(plant, "1/2").member(random.Random(1), vertex=True)
        >>> corner.A[0, 0] in (1, 3), corner.C[0][0, 0]
        (True, Fraction(0, 1))
        """
        if vertex:
            return self.moved(lambda: Fraction(rng.choice((-1, 1))))
        return self.moved(lambda: Fraction(rng.randint(-_FINE, _FINE), _FINE))

    def moved(self, part: Callable[[], Fraction]) -> MultiChannelSystem:
        """The member with the nominal entries plus drawn multiples, −1 to 1, of their radii."""
        matrices = [
            M0 + _spread(D, part)
            for (_, D), M0 in zip(self.radii.matrices(), matrices_of(self.system), strict=True)
        ]
        return MultiChannelSystem(
            matrices[0],
            matrices[1 : self.m + 1],
            matrices[self.m + 1 :],
            time=self.system.time,
            names=self.system.names,
            neighbors=self.system.neighbors,
        )

    def explain(self) -> str:
        """Say what the box is, in plain words."""
        return self.system.explain()

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the nominal plant and the radii."""
        yield "uncertainty", radii_in_words(self.system)
        yield "nominal plant", self.nominal
        yield "radii", self.radii

    def __repr__(self) -> str:
        words = radii_in_words(self.system)
        return f"Box(n={self.n}, m={self.m}, {self.system.time} time: {words})"


def radii_in_words(system: MultiChannelSystem) -> str:
    """Say how many entries of a system are uncertain, and how large a part of them the radii are.

    Examples
    --------
    >>> plant = MultiChannelSystem([[4]], [[[1]]], [[[0]]])
    >>> radii_in_words(Box.relative(plant, "1/1000").system)
    '2 entries are uncertain, by at most 0.1 %'
    >>> radii_in_words(Box.absolute(plant, A=[[1]], C=[[["1/3"]]]).system)
    '2 entries are uncertain, some of which are 0, by at most 1'
    >>> radii_in_words(Box.absolute(plant, C=[[[1]]]).system)
    'one entry is uncertain, which is 0, by at most 1'
    """
    radii = system.uncertainty
    if radii is None or radii.is_zero():
        return "no entry is uncertain"
    pairs = [
        (Fraction(r, R.denominator), abs(M[i, j]))
        for M, (_, R) in zip(matrices_of(system), radii.matrices(), strict=True)
        for i, j, r in R.nonzero()
    ]
    if all(value for _, value in pairs):
        largest = approximated(max(100 * radius / value for radius, value in pairs)) + " %"
        return f"{radii.explain()}, by at most {largest}"
    largest = approximated(max(radius for radius, _ in pairs))
    which = "which is 0" if len(pairs) == 1 else "some of which are 0"
    return f"{radii.explain()}, {which}, by at most {largest}"


def matrices_of(plant: MultiChannelSystem) -> tuple[Matrix, ...]:
    return plant.A, *plant.B, *plant.C


def _zeros(plant: MultiChannelSystem) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    zeros = [Matrix.zeros(*M.shape) for M in matrices_of(plant)]
    return zeros[0], zeros[1 : plant.m + 1], zeros[plant.m + 1 :]


def _spread(D: Matrix, part: Callable[[], Fraction]) -> Matrix:
    """The radii, each times a number drawn for it."""
    entries = [(i * D.ncols + j, x, part()) for i, j, x in D.nonzero()]
    values = [x * p for _, x, p in entries]
    common = lcm(1, *(value.denominator for value in values))
    cells = [cell for cell, _, _ in entries]
    return from_cells(D.shape, cells, (int(v * common) for v in values), D.denominator * common)
