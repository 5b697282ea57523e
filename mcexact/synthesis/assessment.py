"""Whether a person would install a controller.

A controller that is certified can still be useless: fragile, costly, or with gains that no device
has.  `assess` computes the figures that say so for a design, `assessed_loop` those of any loop, and
the verdict of an `Assessment` follows from them:

- "Do not install": the region is not certified, a plant or gains within the radii are refuted, or
  the margin is next to nothing;
- "Install with care": the loop is fragile, needs many digits, lets the state grow, costs or acts
  much more than the one controller that all agents together would have, or the region is beyond
  what is sensible;
- "Worth installing": none of these.

The figures are computed in floating point.  The verdict names what is proved and what is open.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import isfinite, isnan
from typing import Any, Literal

import numpy as np

from mcexact.answer.templates import count, listed
from mcexact.errors import InputError
from mcexact.exact.matrix import finite, to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.shown import Shown, fitting
from mcexact.synthesis.design import Design
from mcexact.synthesis.networks import decentralized_network, integrated_plant
from mcexact.synthesis.optimum.diagnosis import (
    MOST_DIGITS,
    TIMES_THE_COST,
    Diagnosis,
    diagnosed,
    digits_that_suffice,
    integrators_of,
    step_peak,
    sure_figures,
)
from mcexact.synthesis.optimum.figures import MARGIN, NO_LIMITS, Aims, Figures, Shape, figures_of
from mcexact.synthesis.optimum.problem import FeedbackProblem, Weights, quiet_floats
from mcexact.synthesis.robustness import EveryLoop, WithinRadii

Install = Literal["yes", "with care", "no"]

BASIS = "computed in floating point, not certified"
_COMPUTED = " (computed)"
_NO_MARGIN, _PEAK, _TIMES_THE_PEAK, _TIMES_THE_COST = 0.05, 100.0, 5.0, 10.0
_STEP_PEAK, _DIGITS, _TIMES_THE_GAIN = 2.0, 4, 10.0
_REFUTED = "within the given uncertainty there is a plant whose loop is not stable"
_OPEN = "stability is not proved for everything within the given uncertainty"


@dataclass(frozen=True)
class Link:
    """A link that a controller uses, and the count of numbers that it carries at each step.

    Attributes
    ----------
    sender, receiver : str
    numbers : int
    """

    sender: str
    receiver: str
    numbers: int


@dataclass(frozen=True, eq=False)
class Assessment(Shown):
    """Figures of a closed loop, computed in floating point and not certified.

    Attributes
    ----------
    orders : mapping of str to int
        The number of states of each agent.
    region : StabilityRegion
    certified : bool
        Whether it is certified that every eigenvalue lies in the region.
    figures : Figures
        Of the loop.
    diagnosis : Diagnosis
        Of the plant, for the region; with integrators if the controller has them.
    digits : int or None
        See `digits_that_suffice`: for the region, and for a margin of 0.3 or nine tenths of it.
    links : tuple of Link
    step_peak : float or None
        The largest output while one set-point steps from 0 to 1; None without integrators.
    notes : tuple of str
        What was chosen for the user, and remarks about the method.
    uncontrolled : Figures or None
        Of the plant without a controller; None with integrators, which are not stable alone.
    shape : Shape
        The limits on the eigenvalues that were aimed at.
    within_radii : str or None
        Whether stability is proved or refuted for all plants and gains within the radii that were
        given; None if none were.
    """

    orders: Mapping[str, int]
    region: StabilityRegion
    certified: bool
    figures: Figures
    diagnosis: Diagnosis
    digits: int | None
    links: tuple[Link, ...]
    step_peak: float | None = None
    notes: tuple[str, ...] = ()
    shape: Shape = NO_LIMITS
    uncontrolled: Figures | None = None
    within_radii: WithinRadii | None = None

    def __repr__(self) -> str:
        return fitting(f"Assessment({self.verdict})")

    def explain(self) -> str:
        """Say in plain words whether to install the controller, and why."""
        return "\n".join([self.verdict, *self.warnings[1:], *self.notes])

    def _labeled(self) -> list[tuple[str, str]]:
        """Return the verdict and the figures as labels and texts."""
        return [("verdict", self.verdict), *self.rows()]

    @property
    def central(self) -> Figures | None:
        """The figures of the optimal controller of all agents together, for the same region."""
        optimum = self.diagnosis.central
        return None if optimum is None else optimum.figures

    @property
    def relative_cost(self) -> float:
        """The cost divided by that of `central`; NaN if either is not known."""
        return np.nan if self.central is None else self.figures.cost / self.central.cost

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """The warnings, the most important first."""
        return (*self._dangers(), *self._cares())

    @property
    def install(self) -> Install:
        """Whether to install the controller."""
        if any(True for _ in self._dangers()):
            return "no"
        return "with care" if any(True for _ in self._cares()) else "yes"

    @property
    def verdict(self) -> str:
        """One line that says whether to install the controller, and why."""
        words = {
            "yes": "Worth installing",
            "with care": "Install with care",
            "no": "Do not install",
        }
        reason = (self.warnings or (self._strengths(),))[0]
        exact = not self.certified or reason in (_REFUTED, _OPEN)
        marked = exact or reason.endswith(_COMPUTED)
        return f"{words[self.install]}: {reason}{'' if marked else _COMPUTED}"

    @property
    def _is_sensible(self) -> bool:
        """Whether this loop, or the one for all agents, shows that the region is affordable."""
        return self.diagnosis.is_sensible or self.diagnosis.allows(self.figures)

    @property
    def _compares_peaks(self) -> bool:
        """Whether the peak of one controller for all is of the same states, without integrals."""
        return self.uncontrolled is not None

    def _strengths(self) -> str:
        digits = "1 digit suffices" if self.digits == 1 else f"{self.digits} digits suffice"
        return (
            f"margin {shown(self.figures.margin)}, cost {shown(self.relative_cost)} times that "
            f"of one controller for all agents, {digits}"
        )

    def _dangers(self) -> list[str]:
        seen = self.figures
        if not self.certified:
            return [f"the loop does not satisfy {self.region}"]
        if self.within_radii == "refuted":
            return [_REFUTED]
        if seen.margin <= 0:
            return ["in double precision the computed loop is not even stable"]
        if seen.margin < _NO_MARGIN:
            return [
                f"the margin at the plant's inputs is {shown(seen.margin)}: an error of this part "
                "of the inputs may destabilize the loop"
            ]
        return []

    def _cares(self) -> list[str]:
        seen, central, cares = self.figures, self.central, list[str]()
        if seen.margin <= 0:
            return []
        unknown = [name for name in ("margin", "peak", "cost") if isnan(getattr(seen, name))]
        if unknown:
            cares.append(
                f"the {listed(unknown)} of the loop {'is' if len(unknown) == 1 else 'are'} not "
                "known: the loop is too sensitive for double precision"
            )
        if self.certified and self.within_radii == "open":
            cares.append(_OPEN)
        if _NO_MARGIN <= seen.margin < MARGIN:
            cares.append(f"fragile, the margin at the plant's inputs is {shown(seen.margin)}")
        if not self.shape.met(seen.damping, seen.fastest):
            cares.append(
                f"the least damping ratio is {shown(seen.damping)} and the largest modulus of an "
                f"eigenvalue {shown(seen.fastest)}, not as aimed at"
            )
        if self.digits is None and self.certified:
            cares.append(
                f"rounded to {MOST_DIGITS} digits, the programs lose {self.region} or the margin"
            )
        elif self.digits is not None and self.digits > _DIGITS:
            cares.append(
                f"the programs need {self.digits} digits to keep {self.region} and the margin"
            )
        beside = central.peak if central and self._compares_peaks else np.inf
        if seen.peak > min(_PEAK, _TIMES_THE_PEAK * beside):
            other = f", {shown(beside)} with one controller for all" if isfinite(beside) else ""
            cares.append(f"the state can reach {shown(seen.peak)} from a start of size 1{other}")
        if self.step_peak is not None and self.step_peak > _STEP_PEAK:
            cares.append(f"an output reaches {shown(self.step_peak)} after a unit step")
        if self.relative_cost > _TIMES_THE_COST:
            cares.append(f"its cost is {shown(self.relative_cost)} times the one for all agents")
        if central and seen.largest_gain > _TIMES_THE_GAIN * max(central.largest_gain, 1.0):
            cares.append(
                f"the largest gain is {shown(seen.largest_gain)}, "
                f"{shown(central.largest_gain)} with one controller for all agents"
            )
        if self.region.bound is not None and not self._is_sensible:
            cares.append(f"{self.region} is beyond what is sensible: {self.diagnosis}")
        return cares

    def rows(self) -> list[tuple[str, str]]:
        """Return the figures as labels and texts."""
        seen, central, word = self.figures, self.central, self.region.word

        def compared(name: str) -> str:
            text = _finite(getattr(seen, name))
            if central is None:
                return text
            return f"{text} (one controller for all agents: {shown(getattr(central, name))})"

        per_agent = ", ".join(f"{name}: {order}" for name, order in self.orders.items())
        if len(self.orders) > 1 and len(set(self.orders.values())) == 1:
            per_agent = f"{min(self.orders.values())}, alike for all {len(self.orders)}"
        sent = sum(link.numbers for link in self.links)
        most = max((link.numbers for link in self.links), default=0)
        network = f"{sent} over {count(len(self.links), 'link')}, at most {most} on one"
        network = network if sent else "none"
        return [
            ("states of each agent", per_agent),
            ("largest gain", compared("largest_gain")),
            ("slowest eigenvalue", f"{self.region.measure} = {shown(seen.bound)}"),
            *self._alone(),
            ("fastest eigenvalue", f"|λ| = {shown(seen.fastest)}"),
            ("least damping ratio", shown(seen.damping)),
            ("margin at the plant's inputs", compared("margin")),
            ("peak of the state", compared("peak") if self._compares_peaks else _finite(seen.peak)),
            *self._stepped(),
            ("linear-quadratic cost", compared("cost")),
            ("cost relative to that controller", self._relative()),
            *self._digits(),
            ("numbers sent" + " at each step" * self.region.discrete, network),
            (f"sensible {word}", self._sensible()),
        ]  # fmt: skip

    def _sensible(self) -> str:
        """The sensible rate, and what it is."""
        text = self.diagnosis.sensible_bound
        if self.diagnosis.sensible is None:
            return text
        pace = "least" if self.region.discrete else "largest"
        return (
            f"{text} (the {pace} with which one controller for all agents has a margin of {MARGIN} "
            f"and at most {TIMES_THE_COST:g} times the least cost)"
        )

    def _stepped(self) -> list[tuple[str, str]]:
        if self.step_peak is None:
            return []
        return [("peak of an output after a unit step", shown(self.step_peak))]

    def _alone(self) -> list[tuple[str, str]]:
        """What the plant does without a controller."""
        alone = self.uncontrolled
        if alone is None:
            return []
        cost = f"cost {shown(alone.cost)}" if isfinite(alone.cost) else "not stable"
        return [("without a controller", f"{self.region.measure} = {shown(alone.bound)}, {cost}")]

    def _relative(self) -> str:
        text = _finite(self.relative_cost)
        if not self.relative_cost < 1:
            return text
        return f"{text} (that one is not the cheapest with this {self.region.word})"

    def _digits(self) -> list[tuple[str, str]]:
        """The number of digits that suffice, if the region is certified."""
        if not self.certified:
            return []
        text = f"more than {MOST_DIGITS}" if self.digits is None else str(self.digits)
        text += ", where each number is rounded to the nearest"
        return [("digits that suffice", text)]

    def to_dict(self) -> dict[str, Any]:
        """Return the assessment as plain data."""
        return {
            "basis": BASIS,
            "install": self.install,
            "verdict": self.verdict,
            "warnings": list(self.warnings),
            "notes": list(self.notes),
            "states_of_each_agent": dict(self.orders),
            **_numbers(self.figures),
            "relative_cost": finite(self.relative_cost),
            "step_peak": None if self.step_peak is None else finite(self.step_peak),
            "without_a_controller": None
            if self.uncontrolled is None
            else _numbers(self.uncontrolled),
            "digits_that_suffice": self.digits,
            "links": [vars(link) for link in self.links],
            "one_controller_for_all_agents": None
            if self.central is None
            else _numbers(self.central),
            **self.diagnosis.view(),
        }


def _numbers(figures: Figures) -> dict[str, float | None]:
    return {name: finite(float(value)) for name, value in vars(figures).items()}


def shown(value: float) -> str:
    """Three digits, without an exponent where that is short."""
    if isnan(value):
        return "not known"
    return f"{value:.3g}" if not 1000 <= abs(value) < 1e6 else f"{value:.0f}"


def _finite(value: float) -> str:
    """A number, or a dash where a loop that is not stable has none."""
    return shown(value) if isfinite(value) or isnan(value) else "–"


# The figures of a design or of a loop, computed for its assessment.

_HARDLY, _NEARLY = 1.02, 0.9


def assess(
    design: Design, aims: Aims | None = None, every_loop: EveryLoop | None = None
) -> Assessment:
    """Compute the figures that say whether to install the controller of a design.

    Parameters
    ----------
    design : Design
    aims : Aims, optional
        Those of the design, for its weights.
    every_loop : EveryLoop, optional
        What is proved about all loops within the radii of the plant, if it has some.  A controller
        that fails for a plant within them should not be installed.

    Returns
    -------
    Assessment

    Notes
    -----
    In floating point: only what the certificates of the design say is proved.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> from mcexact.synthesis.decentralized import design_decentralized
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> assess(design_decentralized(plant, rate="1/2")).install
    'yes'
    >>> from mcexact.synthesis.optimum.figures import THEOREM
    >>> rooms = gallery.load("farina-three-rooms")
    >>> assess(design_decentralized(rooms, rate=1, aims=THEOREM)).install
    'no'
    """
    InputError.require(design, Design, "design")
    aims = Aims() if aims is None else aims
    InputError.require(aims, Aims, "aims")
    parts = design.parts.get("designed", design.parts)
    notes = list(design.notes)
    if "blocks" in parts and "diagnosis" in parts:
        notes.append(
            "no search found a controller: this is the one of the theorem, whose dynamics are all "
            "in one agent of each strong component"
        )
    if "observer_gains" in parts and design.order > design.loop.closed.plant.m:
        other = "`design setpoint`" if design.name == "setpoint" else "`--order low`"
        notes.append(
            "every agent of a distributed observer estimates the whole state, with "
            f"{design.order} states together: where this is not wanted, {other} tries controllers "
            "of low order over the same links"
        )
    assessment = assessed_loop(
        design.loop.closed,
        design.region,
        certified=design.stable,
        weights=aims.weights,
        notes=tuple(notes),
        diagnosis=parts.get("diagnosis"),
        shape=(aims or Aims()).shape,
    )
    if design.loop.closed.plant.uncertainty is None:
        return assessment
    return replace(
        assessment, within_radii="open" if every_loop is None else every_loop.within_radii
    )


def assessed_loop(
    loop: ClosedLoop,
    region: StabilityRegion,
    *,
    certified: bool,
    weights: Mapping[str, Any] | None = None,
    notes: tuple[str, ...] = (),
    diagnosis: Diagnosis | None = None,
    shape: Shape = NO_LIMITS,
) -> Assessment:
    """Compute the figures of a closed loop.

    Parameters
    ----------
    loop : ClosedLoop
    region : StabilityRegion
    certified : bool
        Whether it is certified that every eigenvalue lies in the region.
    weights : mapping, optional
        See `Weights.of`.
    notes : tuple of str
    diagnosis : Diagnosis, optional
        That of the plant, with integrators if the controller has them, for the same region.
    shape : Shape
        The limits on the eigenvalues that were aimed at.
    """
    plant, places = loop.plant, integrators_of(loop)
    about, weighed = as_plant(plant), Weights.of(plant, weights)
    if places:
        about, weighed = integrated_plant(plant), weighed.with_integrators(plant)
    known = diagnosis or diagnosed(about, region, weighed)
    with quiet_floats():
        figures = sure_figures(loop, weighed, places)
        alone = None if places else _uncontrolled(plant, weighed)
        if certified and alone is not None and alone.cost <= _HARDLY * figures.cost:
            notes = (*notes, _hardly(alone, figures, region))
        return Assessment(
            {agent.name: agent.shared + agent.private for agent in loop.controller.agents},
            region,
            certified,
            figures,
            known,
            digits_that_suffice(loop, region, _kept(figures.margin)) if certified else None,
            _links(loop.controller, plant),
            step_peak(loop) if places and certified else None,
            notes,
            shape,
            alone,
        )


def _kept(margin: float) -> float:
    """The margin that must remain after rounding: `MARGIN`, or nearly all of a smaller one."""
    if np.isnan(margin):
        return 0.0
    return MARGIN if margin >= MARGIN else _NEARLY * margin


def _uncontrolled(system: MultiChannelSystem, weights: Weights) -> Figures:
    """The figures of the plant without a controller."""
    network = decentralized_network(as_plant(system))
    problem = FeedbackProblem.of(network, (0,) * system.m, weights)
    return figures_of(problem, np.zeros(problem.mask.shape))


def _hardly(alone: Figures, figures: Figures, region: StabilityRegion) -> str:
    """A warning that the loop is hardly better than the plant without a controller."""
    inside = alone.bound < to_float(region.limit)
    clause = f"it satisfies {region}, too" if inside else f"it does not satisfy {region}"
    return (
        f"without a controller the plant has {shown(alone.cost / figures.cost)} times this cost; "
        f"{clause}"
    )


def _links(controller: Controller, system: MultiChannelSystem) -> tuple[Link, ...]:
    """The links that a controller uses."""
    links = []
    for j, i in controller.edges():
        maps = [each.without_zeros() for each in controller.agents[i].maps()]
        outputs = any(j in each.outputs for each in maps) * system.q(j)
        shared = any(j in each.shared for each in maps) * controller.agents[j].shared
        if outputs + shared:
            links.append(Link(system.names[j], system.names[i], outputs + shared))
    return tuple(links)
