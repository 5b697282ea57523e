"""Answer: no plant in a box has a fixed mode."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.evidence import ComplexMatrix, Cover, ExteriorDiscs
from mcexact.answer.formats import allowed
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.answer.sentence import Claim, Rulebook
from mcexact.answer.template import Sentence, Template
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion


@dataclass(frozen=True)
class PencilGains(Part):
    """X and W, block diagonal by channel, of the pencil [λI − A, −B; XC, W].

    Where it is regular, λ is no fixed mode: F = −W⁻¹X moves it, after W is moved a little if it is
    singular.

    Attributes
    ----------
    X : tuple of Matrix
        p_i × q_i, one for each channel.
    W : tuple of Matrix
        p_i × p_i.
    """

    X: tuple[Matrix, ...]
    W: tuple[Matrix, ...]


@dataclass(frozen=True)
class PencilFrame(Part):
    """V about the inverse of a pencil at some λ, and weights w > 0 of its rows.

    Attributes
    ----------
    gains : int or None
        The position of the X and W of the pencil; None for λI − A.
    V : ComplexMatrix
    w : tuple of int
    """

    gains: int | None
    V: ComplexMatrix
    w: tuple[int, ...]


@answer("box_fixed")
class BoxFixedModes(Answer):
    """No member of the box of a system has a fixed mode, or none outside of a region.

    The members are all systems whose entries are within their radii; entries that a construction
    copies may differ from each other.

    Attributes
    ----------
    bound : Fraction or None
        None: no member has a fixed mode.  A rate ≥ 0 (continuous time) or a radius in (0, 1]
        (discrete time): every member has its fixed modes in this region.  With 0, or 1, each
        member is stabilized by a decentralized controller of its own.
    exterior : tuple of ExteriorDiscs
        Where the eigenvalues of all members are, with gains or without: what is fixed is in a disc
        of each.
    gains : tuple of PencilGains
    frames : tuple of PencilFrame
    cover : tuple of tuples of int or None
        Discs and squares that cover the first discs, each with the frame that proves it, except
        those that meet none of some others.
    """

    bound: Fraction | None = claim("fixed modes of every member")
    exterior: tuple[ExteriorDiscs, ...] = witness()
    gains: tuple[PencilGains, ...] = witness()
    frames: tuple[PencilFrame, ...] = witness()
    cover: Cover = witness()

    @property
    def region(self) -> StabilityRegion | None:
        """The region in which members may have fixed modes, if any."""
        return None if self.bound is None else StabilityRegion.of(self.about.time, bound=self.bound)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "fixed modes of every member", allowed(self.region)


NOTHING_FIXED = Template(
    "members-nothing-fixed",
    "no plant has a fixed mode",
    "boxes.regular_not_fixed",
    "within the radii",
)
STABILIZABLE = Template(
    "members-stabilizable",
    "every plant is stabilizable by a decentralized linear time-invariant controller of its own",
    "S. H. Wang and E. J. Davison 1973",
    "within the radii",
)
SETPOINTS = Template(
    "members-setpoints",
    "for every plant some decentralized linear time-invariant controller of its own holds all "
    "outputs at any constant set-points",
    "S. H. Wang and E. J. Davison 1973; E. J. Davison 1976",
    "within the radii",
)
RULES = Rulebook()


@RULES.rule("table", NOTHING_FIXED)
def _nothing_fixed(box_fixed_modes: Claim) -> Iterator[Sentence]:
    if box_fixed_modes.bound is None:
        yield NOTHING_FIXED()


@RULES.rule("table", STABILIZABLE)
def _stabilizable(box_stabilizability: Claim) -> Iterator[Sentence]:
    if box_stabilizability.bound is not None:
        yield STABILIZABLE()


@RULES.rule("table", SETPOINTS)
def _setpoints(box_setpoints: Claim) -> Iterator[Sentence]:
    if box_setpoints.bound is not None:
        yield SETPOINTS()
