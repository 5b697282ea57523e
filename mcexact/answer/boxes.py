"""Every plant in a box, or at all values in ranges: answers and sentences.

The answers are that no mode is fixed, that channels control every mode, and that every eigenvalue
lies in a region.  Each is given twice: for a box (all systems whose entries are within their
radii), and for all real values of parameters in ranges.  The latter is proved cell by cell, with
the evidence of a box around the plants of each cell.  Their evidence is discs, inverses and
weights, which prove that a pencil is regular for every member on every disc of a cover.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.evidence import ComplexMatrix, Cover, ExteriorDiscs, InverseFrame
from mcexact.answer.loops import LyapunovMethod, PolynomialMethod
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.answer.sentence import Claim, Context, Rulebook
from mcexact.answer.templates import Sentence, Template, allowed
from mcexact.derived.constructions import ParametricLoop
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem

# The region that an answer is about.


class ModesAllowed:
    """An answer that no plant has certain modes, or none outside of a region."""

    about: Any
    bound: Fraction | None

    @property
    def region(self) -> StabilityRegion | None:
        """The region in which plants may have such modes, if any."""
        return None if self.bound is None else StabilityRegion.of(self.about.time, bound=self.bound)


class EigenvaluesInside:
    """An answer that all eigenvalues of every loop lie in a region."""

    about: Any
    bound: Fraction | None

    @property
    def region(self) -> StabilityRegion:
        """The region in which all eigenvalues lie."""
        return StabilityRegion.of(self.about.time, bound=self.bound)


# Answer: no plant in a box has a fixed mode.


@dataclass(frozen=True)
class PencilGains(Part):
    """X and W, block diagonal by channel, of the pencil [λI − A, −B; XC, W].

    Where it is regular, λ is no fixed mode: F = −W⁻¹X moves it, after a small change of W if W is
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
    """V, approximately the inverse of a pencil at some λ, and weights w > 0 of its rows.

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
class BoxFixedModes(ModesAllowed, Answer):
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
        Each contains the eigenvalues of all members, with gains or without; so every fixed mode is
        in a disc of each.
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
BOX_FIXED_RULES = Rulebook()


@BOX_FIXED_RULES.rule("table", NOTHING_FIXED, premises=("box_fixed_modes",))
def _nothing_fixed(box_fixed_modes: Claim, context: Context) -> Iterator[Sentence]:
    if box_fixed_modes.bound is None:
        yield NOTHING_FIXED()


@BOX_FIXED_RULES.rule("table", STABILIZABLE, premises=("box_stabilizability",))
def _stabilizable(box_stabilizability: Claim, context: Context) -> Iterator[Sentence]:
    if box_stabilizability.bound is not None:
        yield STABILIZABLE()


@BOX_FIXED_RULES.rule("table", SETPOINTS, premises=("box_setpoints",))
def _setpoints(box_setpoints: Claim, context: Context) -> Iterator[Sentence]:
    if box_setpoints.bound is not None:
        yield SETPOINTS()


# Answer: channels control every plant in a box.


@dataclass(frozen=True)
class RightInverseFrame(Part):
    """R, approximately a right inverse of [cI − A, −B_T] at some c, and weights w > 0 of its rows.

    Attributes
    ----------
    R : ComplexMatrix
        n + p_T rows and n columns.
    w : tuple of int
    """

    R: ComplexMatrix
    w: tuple[int, ...]


@answer("box_controllable")
class BoxControllability(ModesAllowed, Answer):
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
        Each contains the eigenvalues of all members, with gains from the state to the channels or
        without; so every uncontrollable mode is in a disc of each.
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
BOX_CONTROLLABLE_RULES = Rulebook()


@BOX_CONTROLLABLE_RULES.rule("table", CONTROLLABLE, premises=("box_controllability",))
def _controllable(box_controllability: Claim, context: Context) -> Iterator[Sentence]:
    if box_controllability.bound is None and len(box_controllability.channels) == context.m:
        yield CONTROLLABLE()


@BOX_CONTROLLABLE_RULES.rule("table", OBSERVABLE, premises=("box_observability",))
def _observable(box_observability: Claim, context: Context) -> Iterator[Sentence]:
    if box_observability.bound is None and len(box_observability.channels) == context.m:
        yield OBSERVABLE()


# Answer: every loop in a box is stable.


@dataclass(frozen=True)
class SingleDisk(Part):
    """Each input, or each output, is multiplied by (1 + δ/2)/(1 − δ/2) by itself, |δ| ≤ margin.

    Attributes
    ----------
    at : "inputs" or "outputs"
    margin : Fraction
        Above 0 and below 2.
    """

    at: str
    margin: Fraction


@answer("box_stable")
class BoxStability(EigenvaluesInside, Answer):
    """Every eigenvalue of every member of a box lies in a region: usually of a closed loop.

    Attributes
    ----------
    bound : Fraction or None
        A rate ≥ 0 (continuous time) or a radius in (0, 1] (discrete time); None means 0 or 1.
    gain_radii : dict or None
        The radii of the controller's gains, as the object of a controller with the same agents;
        None if they are certain.
    disk : SingleDisk or None
        The claim is also for each input, or output, multiplied by complex numbers near 1.
    nominal : PolynomialMethod or LyapunovMethod
        Evidence that the nominal loop is stable, as in the kind ``stability``.
    points : tuple of Fraction
        The points that divide the upper half of the border of the region into segments.
    growth : tuple of int or None
        Weights of the states that exclude eigenvalues beyond the last point, in continuous time.
    segments : tuple of int
        For each segment of the border the position of its frame.
    frames : tuple of InverseFrame
        Frames of the pencil of the loop in x, the controller's states, all y_i and all u_i.
    """

    bound: Fraction | None = claim("every eigenvalue of every member")
    gain_radii: dict[str, Any] | None = claim("gains")
    disk: SingleDisk | None = claim(optional=True)
    nominal: PolynomialMethod | LyapunovMethod = witness()
    points: tuple[Fraction, ...] = witness()
    growth: tuple[int, ...] | None = witness()
    segments: tuple[int, ...] = witness()
    frames: tuple[InverseFrame, ...] = witness()

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "every eigenvalue of every member", str(self.region)
        yield "gains", "certain" if self.gain_radii is None else "within radii of their own"


# Answer: no mode is fixed at any values of the parameters within their ranges.

Cuts = tuple[int | None, ...]
"""In preorder: the position of the parameter in whose middle a cell is cut, or None for a cell."""


@dataclass(frozen=True)
class FixedModesOfCell(Part):
    """The evidence of `BoxFixedModes` for the plants at all values of a cell.

    Attributes
    ----------
    exterior : tuple of ExteriorDiscs
    gains : tuple of PencilGains
    frames : tuple of PencilFrame
    cover : tuple of tuples of int or None
    """

    exterior: tuple[ExteriorDiscs, ...]
    gains: tuple[PencilGains, ...]
    frames: tuple[PencilFrame, ...]
    cover: Cover


@answer("parametric_box_fixed")
class ParametricBoxFixedModes(ModesAllowed, Answer):
    """No mode is fixed at any real values of the parameters within their ranges.

    Attributes
    ----------
    bound : Fraction or None
        None: no plant has a fixed mode.  A rate ≥ 0 (continuous time) or a radius in (0, 1]
        (discrete time): every plant has its fixed modes in this region.  With 0, or 1, each plant
        is stabilized by a decentralized controller of its own.
    cuts : tuple of int or None
        How the ranges are cut into cells.
    parts : tuple of FixedModesOfCell
        One for each cell.
    """

    about: ParametricSystem  # type: ignore[assignment]
    bound: Fraction | None = claim("fixed modes at all values")
    cuts: Cuts = witness()
    parts: tuple[FixedModesOfCell, ...] = witness()

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "fixed modes at all values", allowed(self.region)


# Answer: channels control every mode at all values of the parameters within their ranges.


@dataclass(frozen=True)
class ControlOfCell(Part):
    """The evidence of `BoxControllability` for the plants at all values of a cell.

    Attributes
    ----------
    exterior : tuple of ExteriorDiscs
    frames : tuple of RightInverseFrame
    cover : tuple of tuples of int or None
    """

    exterior: tuple[ExteriorDiscs, ...]
    frames: tuple[RightInverseFrame, ...]
    cover: Cover


@answer("parametric_box_controllable")
class ParametricBoxControllability(ModesAllowed, Answer):
    """Channels control every mode at all real values of the parameters within their ranges.

    About the dual of a system it says what the channels observe.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    bound : Fraction or None
        None: (A, B_T) is controllable for every plant.  A rate ≥ 0 or a radius in (0, 1]: every
        plant has its uncontrollable modes in this region.
    cuts : tuple of int or None
        How the ranges are cut into cells.
    parts : tuple of ControlOfCell
        One for each cell.
    """

    about: ParametricSystem  # type: ignore[assignment]
    channels: tuple[str, ...] = claim()
    bound: Fraction | None = claim("modes at any values that these do not control")
    cuts: Cuts = witness()
    parts: tuple[ControlOfCell, ...] = witness()

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "channels", ", ".join(self.channels)
        yield "modes at any values that these do not control", allowed(self.region)


# Answer: a loop is stable at all values of the parameters within their ranges.


@dataclass(frozen=True)
class StabilityOfCell(Part):
    """The evidence of `BoxStability` for the loops at all values of a cell.

    Attributes
    ----------
    nominal : PolynomialMethod or LyapunovMethod
    points : tuple of Fraction
    growth : tuple of int or None
    segments : tuple of int
    frames : tuple of InverseFrame
    """

    nominal: PolynomialMethod | LyapunovMethod
    points: tuple[Fraction, ...]
    growth: tuple[int, ...] | None
    segments: tuple[int, ...]
    frames: tuple[InverseFrame, ...]


@answer("parametric_box_stable")
class ParametricBoxStability(EigenvaluesInside, Answer):
    """Every eigenvalue lies in a region at all real values of the parameters within their ranges.

    Attributes
    ----------
    about : ParametricLoop or ParametricSystem
        Usually a closed loop.
    bound : Fraction or None
        A rate ≥ 0 (continuous time) or a radius in (0, 1] (discrete time); None means 0 or 1.
    gain_radii : dict or None
        The radii of the controller's gains, as for `BoxStability`.
    cuts : tuple of int or None
        How the ranges are cut into cells.
    parts : tuple of StabilityOfCell
        One for each cell.
    """

    about: ParametricLoop | ParametricSystem  # type: ignore[assignment]
    bound: Fraction | None = claim()
    gain_radii: dict[str, Any] | None = claim()
    cuts: Cuts = witness()
    parts: tuple[StabilityOfCell, ...] = witness()
