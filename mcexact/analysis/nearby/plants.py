"""Plants beside a given one of which an answer is another one: what was found, and its words.

A `NearPlant` is exact and has a certificate; a `Suspicion` is computed and has none.  `search`
finds both, with numpy, which this module does not load.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.nearby.allowances import FARTHEST, Allowance, distance
from mcexact.answer.modes import PencilRank
from mcexact.answer.nearby import LACKS, Lost
from mcexact.answer.templates import about_mode
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import digits_outward, written
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown


@dataclass(frozen=True, eq=False)
class NearPlant:
    """A plant nearby with the same zeros that lacks what the given one has.

    Attributes
    ----------
    lost : {"unstable", "fixed", "uncontrollable", "unobservable"}
    plant : MultiChannelSystem
    part : Fraction
        The largest change of an entry, as a part of the entry.
    within : {"rounding", "digits"} or None
        Whether rounding errors, or half a unit of the last digits, explain all changes.
    mode : Polynomial
        Its roots are fixed modes of the plant.
    channels : tuple of str
        s: rank [λI − A, B_T; C_s, 0] < n at the roots, T the other channels.
    proof : PencilRank
        The rank; of the dual plant and T where its null space is smaller.
    """

    lost: Lost
    plant: MultiChannelSystem
    part: Fraction
    within: Allowance | None
    mode: Polynomial
    channels: tuple[str, ...]
    proof: PencilRank

    @classmethod
    def of(cls, system: MultiChannelSystem, lost: Lost, proof: PencilRank) -> NearPlant | None:
        """The plant of a proof that was verified; None if it is too far or does not lack that.

        Parameters
        ----------
        system : MultiChannelSystem
            The given plant.
        lost : {"unstable", "fixed", "uncontrollable", "unobservable"}
        proof : PencilRank
            About another plant, or about its dual.
        """
        plant, dual = proof.about.plant, bool(proof.subject)
        apart = distance(system, plant)
        if apart is None or not apart[0] or proof.rank >= plant.n:
            return None
        inside = {*proof.subset}
        channels = tuple(name for name in plant.names if (name in inside) is not dual)
        unstable = not StabilityRegion(plant.time).contains_roots_of(proof.polynomial)
        lacks = {
            "fixed": True,
            "unstable": unstable,
            "uncontrollable": not channels,
            "unobservable": channels == plant.names,
        }
        near = apart[1] is not None or apart[0] <= FARTHEST
        return (
            cls(lost, plant, *apart, proof.polynomial, channels, proof)
            if near and lacks.get(lost)
            else None
        )

    @property
    def about(self) -> str:
        """The mode with six digits; a pair of complex ones as one."""
        return about_mode(self.mode)

    def explain(self) -> str:
        """Say in plain words how far the plant is, and what it lacks."""
        part = digits_outward(self.part, up=True, digits=2)
        what = LACKS[self.lost].format(mode=f"mode {self.about}")
        return f"a plant within {part} of every entry {what}"

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "lost": self.lost,
            "part": written(self.part),
            "within": self.within,
            "mode": [written(c) for c in self.mode.coefficients],
            "mode_about": self.about,
            "channels": list(self.channels),
            "certificate": f"nearby_{self.lost}.json",
            "plant": self.plant.to_dict(),
        }


@dataclass(frozen=True)
class Suspicion:
    """A mode that floating point finds nearly fixed, of which no exact plant was found.

    Attributes
    ----------
    lost : {"unstable", "fixed", "uncontrollable", "unobservable"}
    point : complex
    channels : tuple of str
        s, as in `NearPlant`.
    part : float
        About how far the plant is, as a part of every entry.
    """

    lost: Lost
    point: complex
    channels: tuple[str, ...]
    part: float

    def explain(self) -> str:
        """Say in plain words what is computed."""
        sign = f" ± {abs(self.point.imag):.6g}i" if self.point.imag else ""
        what = LACKS[self.lost].format(mode=f"mode {self.point.real:.6g}{sign}")
        return (
            f"computed, not certified: a plant within about {self.part:.1e} of every entry {what}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        at = [self.point.real, abs(self.point.imag)]
        return {"lost": self.lost, "mode": at, "channels": list(self.channels), "part": self.part}


@dataclass(frozen=True, eq=False)
class Nearby(Shown):
    """What was found near a plant.

    Attributes
    ----------
    system : MultiChannelSystem
    searched : tuple of str
        What was looked for: one of `LOST` each.
    plants : tuple of NearPlant
        At most one for each of these.
    suspected : tuple of Suspicion
        What is computed, and was not made exact.
    ended : str
        Why the search ended before its end; empty if it did not.
    """

    system: MultiChannelSystem
    searched: tuple[Lost, ...]
    plants: tuple[NearPlant, ...]
    suspected: tuple[Suspicion, ...]
    ended: str = ""

    @property
    def leading(self) -> tuple[NearPlant, ...]:
        """The plants that the data allow as well as the given one."""
        return tuple(each for each in self.plants if each.within is not None)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Say that an answer depends on rounding errors, one text for each plant that shows it."""
        near = (each.explain() for each in self.plants if each.within == "rounding")
        return tuple(f"an answer depends on rounding errors: {text}" for text in near)

    @property
    def answers(self) -> dict[str, PencilRank]:
        """The proofs, by the names of their certificates."""
        return {f"nearby_{each.lost}": each.proof for each in self.plants}

    def get(self, lost: Lost) -> NearPlant | None:
        """Return the plant that lacks something, if one was found."""
        return next((each for each in self.plants if each.lost == lost), None)

    def explain(self) -> str:
        """Say in plain words what was found, one plant a line."""
        said = [text for _, text in self._labeled()]
        return "\n".join(said) or "no plant nearby was found, which proves nothing"

    def __repr__(self) -> str:
        return f"Nearby({len(self.plants)} plants, searched: {', '.join(self.searched)})"

    def _labeled(self) -> Iterator[tuple[str, str]]:
        """Yield what was found."""
        yield from ((each.lost, each.explain()) for each in self.plants)
        yield from ((each.lost, each.explain()) for each in self.suspected)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "searched": list(self.searched),
            "plants": [each.to_dict() for each in self.plants],
            "computed_not_certified": [each.to_dict() for each in self.suspected],
        }
