"""Answer: channels control every plant in a box."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.evidence import ComplexMatrix, Cover, ExteriorDiscs
from mcexact.answer.formats import allowed
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.template import Sentence, Template
from mcexact.exact.roots import StabilityRegion


@dataclass(frozen=True)
class RightInverseFrame(Part):
    """R about a right inverse of [cI − A, −B_T] at some c, and weights w > 0 of its rows.

    Attributes
    ----------
    R : ComplexMatrix
        n + p_T rows and n columns.
    w : tuple of int
    """

    R: ComplexMatrix
    w: tuple[int, ...]


@answer("box_controllable")
class BoxControllability(Answer):
    """A set of channels controls every mode of every member of a box, or all outside of a region.

    About the dual of a system it says what the channels observe.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    bound : Fraction or None
        None: (A, B_T) is controllable for every member.  A rate ≥ 0 or a radius in (0, 1]: every
        member has its uncontrollable modes in this region.
    exterior : tuple of ExteriorDiscs
        Where the eigenvalues of all members are, with gains from the state to the channels or
        without: what is not controlled is in a disc of each.
    frames : tuple of RightInverseFrame
    cover : tuple of tuples of int or None
        Discs and squares that cover the first discs, each with the frame that proves it, except
        those that meet none of some others.
    """

    channels: tuple[str, ...] = claim()
    bound: Fraction | None = claim("modes of members that these do not control")
    exterior: tuple[ExteriorDiscs, ...] = witness()
    frames: tuple[RightInverseFrame, ...] = witness()
    cover: Cover = witness()

    @property
    def region(self) -> StabilityRegion | None:
        """The region in which members may have uncontrollable modes, if any."""
        return None if self.bound is None else StabilityRegion.of(self.about.time, bound=self.bound)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "channels", ", ".join(self.channels)
        yield "modes of members that these do not control", allowed(self.region)


_HAUTUS = "joint_controllability.controllable_hautus"
_LABEL = "within the radii"
CONTROLLABLE = Template(
    "members-controllable", "every plant is controllable by all channels together", _HAUTUS, _LABEL
)
OBSERVABLE = Template(
    "members-observable", "every plant is observable by all channels together", _HAUTUS, _LABEL
)
RULES = Rulebook()


@RULES.rule("table", CONTROLLABLE)
def _controllable(box_controllability: Claim, given: Given) -> Iterator[Sentence]:
    if box_controllability.bound is None and len(box_controllability.channels) == given.m:
        yield CONTROLLABLE()


@RULES.rule("table", OBSERVABLE)
def _observable(box_observability: Claim, given: Given) -> Iterator[Sentence]:
    if box_observability.bound is None and len(box_observability.channels) == given.m:
        yield OBSERVABLE()
