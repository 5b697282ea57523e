"""Both ends of what is known about a property near a plant: proved up to one, failing at another.

Every search for a largest box is an instance of `Search`, which `two_sided` carries out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.boxes.failing_plants import FailingPlant
from mcexact.answer.mode_words import blame
from mcexact.answer.protocol import Answer
from mcexact.errors import require_seconds
from mcexact.exact.matrix import to_float
from mcexact.exact.rational import percent, three_digits
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.parameters import uncertainty
from mcexact.shown import Shown

_STEPS = 14
_CLOSE = 1.03
_LEAST = 1e-12
"""A computed largest factor below this is reported as 0."""
_SQUARES, _TRIES = 2000, 4
"""For a second of effort: how many squares are tested, and how many sets and modes are tried for a
plant that fails."""
_MOST_TRIES = 40


@dataclass(frozen=True, repr=False)
class LargestUncertainty(Shown):
    """A box for which a property is proved, and a plant outside of it that lacks the property.

    Attributes
    ----------
    wanted : str
        The property.
    relative : bool
        Whether factors are parts of the moduli of entries; otherwise they are multiples of the
        radii that the plant has.
    lower : Fraction
        The factor for which every member has the property; 0 if none is proved.
    proof : Answer or None
        The answer that proves it.
    upper : Fraction or None
        The factor within which a plant lacks it; None if none was found.
    failing : MultiChannelSystem or None
        That plant.
    refutation : Answer or None
        The exact answer about it.
    channels : tuple of str or None
        The channels whose outputs do not show the mode that is fixed there.
    """

    wanted: str
    relative: bool
    lower: Fraction
    proof: Answer | None
    upper: Fraction | None
    failing: MultiChannelSystem | None
    refutation: Answer | None
    channels: tuple[str, ...] | None

    def explain(self) -> str:
        """Say in plain words up to where the property is proved, and where it fails."""
        proved = f"{self.wanted}: for every plant within {self.proved_part}"
        if not self.lower:
            proved = f"{self.wanted}: not proved for any box"
        if self.upper is None:
            return f"{proved}; no plant that fails was found"
        near = _number(self.upper, self.relative, up=True)
        return f"{proved}; not for a plant within {near}{self._unit}"

    @property
    def proved_part(self) -> str:
        """The largest radii with a proof in words: a percentage of the entries, or a multiple."""
        return f"{_number(self.lower, self.relative)}{self._unit}"

    @property
    def _unit(self) -> str:
        return " of each entry" if self.relative else " times the radii"

    @property
    def nearby(self) -> FailingPlant | None:
        """The plant that fails, its distance in the radii with a proof, or in the given unit."""
        if self.failing is None or self.upper is None:
            return None
        distance, channels = self.upper / (self.lower or 1), self.channels or ()
        return FailingPlant(self.failing, distance, complex("nan"), channels, self.refutation)

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield labels and texts: the property, and up to where it is proved and where it fails."""
        unit = "" if self.relative else " times the radii"
        yield "property", self.wanted
        proved = f"within {_number(self.lower, self.relative)}{unit}" if self.lower else "no box"
        yield "proved for every plant", proved
        near = "not found"
        if self.upper is not None:
            near = f"{_number(self.upper, self.relative, up=True)}{unit}"
        yield "a plant fails within", near
        told = self.wanted == "no fixed mode"
        if told and self.channels is not None and self.failing is not None:
            yield "the mode that is fixed there", blame(self.channels, self.failing.names)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the property, the factors, and the plant that fails."""
        yield from self.rows()
        if self.failing is not None:
            yield "plant that fails", self.failing

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        from mcexact.exact.rational import written

        return {
            "property": self.wanted,
            "relative": self.relative,
            "lower": written(self.lower),
            "upper": None if self.upper is None else _above(self.upper),
            "failing": None if self.failing is None else self.failing.to_dict(),
            "channels": None if self.channels is None else list(self.channels),
        }

    def plot(self, ax: Any = None) -> Any:
        """Draw the proved part in blue, and where a plant fails in red.

        Parameters
        ----------
        ax : axes of matplotlib, optional

        Returns
        -------
        matplotlib.figure.Figure
        """
        return uncertainty(self, ax)

    def __repr__(self) -> str:
        return f"LargestUncertainty({self.explain()})"


def _number(factor: Fraction, relative: bool, *, up: bool = False) -> str:
    """A factor with three digits, rounded down or up, as a percentage if it is relative."""
    return percent(factor, up=up) if relative else three_digits(factor, up=up)


def _above(factor: Fraction) -> str:
    """A factor rounded up to about six digits, as text."""
    digits = 6
    while factor * 10**digits < 10**5 and digits < 40:
        digits += 1
    return f"{-(-factor.numerator * 10**digits // factor.denominator)}e-{digits}"


@dataclass
class Search:
    """What is proved for one factor of the radii, and a plant that fails.

    Attributes
    ----------
    capacity : callable
        About how far the radii can grow.
    proof : callable
        The answer for a factor of the radii, or None.
    refuted : callable
        The exact answer about a plant that fails, or None.
    failing : callable
        A plant that is thought to fail, found with so many tries.
    severed : callable
        Plants that may fail as their channels do nothing.
    work : callable
        The work done so far.
    likely : callable
        A factor of the radii for which a proof is likely; it is tried first.
    rounds : int
        How often factors that failed are tried again: a search that learns may prove them then.
    """

    capacity: Callable[[], float]
    proof: Callable[[Fraction], Answer | None]
    refuted: Callable[[MultiChannelSystem], Answer | None]
    failing: Callable[[int], FailingPlant | None]
    severed: Callable[[], Iterable[FailingPlant]]
    work: Callable[[], float]
    likely: Callable[[], float] = lambda: float("inf")
    rounds: int = 1


def two_sided(search: Search, wanted: str, relative: bool, effort: float) -> LargestUncertainty:
    """Search both ends; see `largest_uncertainty`."""
    require_seconds(effort, "effort")
    near, refutation = nearest(search, min(1 + int(_TRIES * effort), _MOST_TRIES))
    beyond = 1e6 if near is None else to_float(near.distance)
    lower, proof = largest_factor(search, _SQUARES * effort, beyond)
    return LargestUncertainty(
        wanted,
        relative,
        lower,
        proof,
        None if near is None else near.distance,
        None if near is None else near.plant,
        refutation,
        None if near is None else near.channels,
    )


def nearest(search: Search, tries: int) -> tuple[FailingPlant | None, Answer | None]:
    """The nearest plant found that fails, and the exact answer about it."""
    found = search.failing(tries)
    known = [*([] if found is None else [found]), *search.severed()]
    for near in sorted(known, key=lambda each: each.distance):
        refutation = search.refuted(near.plant)
        if refutation is not None:
            return near, refutation
    return None, None


def largest_factor(search: Search, work: float, beyond: float) -> tuple[Fraction, Answer | None]:
    """Bisect for the largest factor of the radii with a proof; beyond some factor there is none."""
    most = min(search.capacity(), beyond) if beyond > 0 else 0.0
    low, best = Fraction(0), None
    if not most > _LEAST:
        return low, best
    likely = search.likely()
    tried = [0.97 * most, 0.97 * likely] if likely < most else [0.97 * most]
    ended = search.work() + work
    for _ in range(search.rounds):
        began, high = low, most
        for step in range(_STEPS):
            if low and high < _CLOSE * low:
                break
            middle = (float(low) * high) ** 0.5 if low else high * (0.5 if step < 3 else 0.1)
            x = tried.pop() if tried else middle
            growth = short(x)
            found = search.proof(growth) if growth > 0 else None
            if found is None:
                high, tried = x, []
            else:
                low, best = growth, found
            if search.work() > ended or high < _LEAST:
                return low, best
        if low == began:
            break
    return low, best


def short(x: float) -> Fraction:
    """A number with three significant digits, rounded down.

    Examples
    --------
    >>> short(0.012345), short(-1.0)
    (Fraction(123, 10000), Fraction(0, 1))
    """
    if not x > 0:
        return Fraction(0)
    exponent = 0
    while x * 10**exponent < 100:
        exponent += 1
    while x * 10.0**exponent >= 1000:
        exponent -= 1
    return Fraction(int(x * 10.0**exponent)) / Fraction(10) ** exponent
