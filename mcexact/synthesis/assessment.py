"""Whether a person would install a controller: figures of its loop, and what to beware of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Any, Literal

import numpy as np

from mcexact.errors import InputError
from mcexact.exact.floats import finite, to_float
from mcexact.exact.location import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.shown import Shown, fitting
from mcexact.synthesis.design import Design
from mcexact.synthesis.integrated_plant import integrated_plant
from mcexact.synthesis.network.networks import decentralized_network
from mcexact.synthesis.optimum.aims import MARGIN, Aims
from mcexact.synthesis.optimum.diagnosis import Diagnosis, diagnosed
from mcexact.synthesis.optimum.figures import Figures, figures_of, step_peak
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.loop_figures import (
    MOST_DIGITS,
    digits_that_suffice,
    figures_of_loop,
    integrators_of,
)
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.shape import NO_LIMITS, Shape
from mcexact.synthesis.optimum.weights import Weights

Install = Literal["yes", "with care", "no"]

BASIS = "computed in floating point, not certified"
_COMPUTED = " (computed)"
_NO_MARGIN, _PEAK, _TIMES_THE_PEAK, _TIMES_THE_COST = 0.05, 100.0, 5.0, 10.0
_STEP_PEAK, _DIGITS, _TIMES_THE_GAIN, _HARDLY, _NEARLY = 2.0, 4, 10.0, 1.02, 0.9


@dataclass(frozen=True)
class Link:
    """A link that a controller uses, with how many numbers it carries at each step.

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
        What was chosen for the user, and what is to be known of the method.
    uncontrolled : Figures or None
        Of the plant without a controller; None with integrators, which are not stable alone.
    shape : Shape
        The limits on the eigenvalues that were aimed at.
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
        found = self.diagnosis.central
        return None if found is None else found.figures

    @property
    def relative_cost(self) -> float:
        """The cost divided by that of this controller; NaN if it is not known."""
        return np.nan if self.central is None else self.figures.cost / self.central.cost

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """What to beware of, the most important first."""
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
        told = {"yes": "Worth installing", "with care": "Install with care", "no": "Do not install"}
        reason = (self.warnings or (self._strengths(),))[0]
        marked = not self.certified or reason.endswith(_COMPUTED)
        return f"{told[self.install]}: {reason}{'' if marked else _COMPUTED}"

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
            f"margin {_shown(self.figures.margin)}, cost {_shown(self.relative_cost)} times that "
            f"of one controller for all agents, {digits}"
        )

    def _dangers(self) -> list[str]:
        seen = self.figures
        if not self.certified:
            return [f"the loop does not satisfy {self.region}"]
        if not seen.margin > 0:
            return ["in double precision the computed loop is not even stable"]
        if seen.margin < _NO_MARGIN:
            return [
                f"the margin at the plant's inputs is {_shown(seen.margin)}: an error of this part "
                "of the inputs may destabilize the loop"
            ]
        return []

    def _cares(self) -> list[str]:
        seen, central, told = self.figures, self.central, list[str]()
        if not seen.margin > 0:
            return []
        if _NO_MARGIN <= seen.margin < MARGIN:
            told.append(f"fragile, the margin at the plant's inputs is {_shown(seen.margin)}")
        if not self.shape.met(seen.damping, seen.fastest):
            told.append(
                f"the least damping ratio is {_shown(seen.damping)} and the largest modulus of an "
                f"eigenvalue {_shown(seen.fastest)}, not as aimed at"
            )
        if self.digits is None and self.certified:
            told.append(
                f"rounded to {MOST_DIGITS} digits, the programs lose {self.region} or the margin"
            )
        elif self.digits is not None and self.digits > _DIGITS:
            told.append(
                f"the programs need {self.digits} digits to keep {self.region} and the margin"
            )
        beside = central.peak if central and self._compares_peaks else np.inf
        if seen.peak > min(_PEAK, _TIMES_THE_PEAK * beside):
            other = f", {_shown(beside)} with one controller for all" if isfinite(beside) else ""
            told.append(f"the state can reach {_shown(seen.peak)} from a start of size 1{other}")
        if self.step_peak is not None and self.step_peak > _STEP_PEAK:
            told.append(f"an output reaches {_shown(self.step_peak)} after a unit step")
        if self.relative_cost > _TIMES_THE_COST:
            told.append(f"its cost is {_shown(self.relative_cost)} times the one for all agents")
        if central and seen.largest_gain > _TIMES_THE_GAIN * max(central.largest_gain, 1.0):
            told.append(
                f"the largest gain is {_shown(seen.largest_gain)}, "
                f"{_shown(central.largest_gain)} with one controller for all agents"
            )
        if self.region.bound is not None and not self._is_sensible:
            told.append(f"{self.region} is beyond what is sensible: {self.diagnosis}")
        return told

    def rows(self) -> list[tuple[str, str]]:
        """Return the figures as labels and texts."""
        seen, central, word = self.figures, self.central, self.region.word

        def compared(name: str) -> str:
            told = _finite(getattr(seen, name))
            if central is None:
                return told
            return f"{told} (one controller for all agents: {_shown(getattr(central, name))})"

        per_agent = ", ".join(f"{name}: {order}" for name, order in self.orders.items())
        if len(self.orders) > 1 and len(set(self.orders.values())) == 1:
            per_agent = f"{min(self.orders.values())}, alike for all {len(self.orders)}"
        sent = sum(link.numbers for link in self.links)
        most = max((link.numbers for link in self.links), default=0)
        network = f"{sent} over {len(self.links)} links, at most {most} on one" if sent else "none"
        return [
            ("states of each agent", per_agent),
            ("largest gain", compared("largest_gain")),
            ("slowest eigenvalue", f"{self.region.measure} = {_shown(seen.bound)}"),
            *self._alone(),
            ("fastest eigenvalue", f"|λ| = {_shown(seen.fastest)}"),
            ("least damping ratio", _shown(seen.damping)),
            ("margin at the plant's inputs", compared("margin")),
            ("peak of the state", compared("peak") if self._compares_peaks else _finite(seen.peak)),
            *self._stepped(),
            ("linear-quadratic cost", compared("cost")),
            ("cost relative to that controller", self._relative()),
            *self._digits(),
            ("numbers sent" + " at each step" * self.region.discrete, network),
            (f"sensible {word}", self.diagnosis.sensible_bound),
        ]  # fmt: skip

    def _stepped(self) -> list[tuple[str, str]]:
        if self.step_peak is None:
            return []
        return [("peak of an output after a unit step", _shown(self.step_peak))]

    def _alone(self) -> list[tuple[str, str]]:
        """What the plant does without a controller."""
        alone = self.uncontrolled
        if alone is None:
            return []
        cost = f"cost {_shown(alone.cost)}" if isfinite(alone.cost) else "not stable"
        return [("without a controller", f"{self.region.measure} = {_shown(alone.bound)}, {cost}")]

    def _relative(self) -> str:
        told = _finite(self.relative_cost)
        if not self.relative_cost < 1:
            return told
        return f"{told} (that one is not the cheapest with this {self.region.word})"

    def _digits(self) -> list[tuple[str, str]]:
        """What rounding leaves of the rate, if there is anything to lose."""
        if not self.certified:
            return []
        told = f"more than {MOST_DIGITS}" if self.digits is None else str(self.digits)
        return [("digits that suffice", told)]

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


def _shown(value: float) -> str:
    """Three digits, without an exponent where that is short."""
    return f"{value:.3g}" if not 1000 <= abs(value) < 1e6 else f"{value:.0f}"


def _finite(value: float) -> str:
    """A number, or a dash where a loop that is not stable has none."""
    return _shown(value) if isfinite(value) else "–"


def assess(design: Design, aims: Aims | None = None) -> Assessment:
    """Compute the figures that say whether to install the controller of a design.

    Parameters
    ----------
    design : Design
    aims : Aims, optional
        Those of the design, for its weights.

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
    >>> from mcexact.synthesis.optimum.aims import THEOREM
    >>> rooms = gallery.load("farina-three-rooms")
    >>> assess(design_decentralized(rooms, rate=1, aims=THEOREM)).install
    'no'
    """
    InputError.require(design, Design, "design")
    parts = design.parts.get("designed", design.parts)
    notes = list(design.notes)
    if "blocks" in parts and "diagnosis" in parts:
        notes.append(
            "no search found a controller: this is the one of the theorem, whose dynamics are all "
            "in one agent of each strong component"
        )
    if "observer_gains" in parts and design.order > design.loop.closed.given.m:
        notes.append(
            f"the agents of a distributed observer have {design.order} states together: "
            f"`design {'setpoint' if design.name == 'setpoint' else 'extended'}` searches "
            "controllers of low order over the same links"
        )
    return assessed_loop(
        design.loop.closed,
        design.region,
        certified=design.stable,
        weights=(aims or Aims()).weights,
        notes=tuple(notes),
        diagnosis=parts.get("diagnosis"),
        shape=(aims or Aims()).shape,
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
    given, places = loop.given, integrators_of(loop)
    about, weighed = as_plant(given), Weights.of(given, weights)
    if places:
        about, weighed = integrated_plant(given), weighed.with_integrators(given)
    known = diagnosis or diagnosed(about, region, weighed)
    with quiet_floats():
        figures = figures_of_loop(loop, weighed, places)
        alone = None if places else _uncontrolled(given, weighed)
        if certified and alone is not None and alone.cost <= _HARDLY * figures.cost:
            notes = (*notes, _hardly(alone, figures, region))
        return Assessment(
            {agent.name: agent.shared + agent.private for agent in loop.controller.agents},
            region,
            certified,
            figures,
            known,
            digits_that_suffice(loop, region, _kept(figures.margin)) if certified else None,
            _links(loop.controller, given),
            step_peak(loop) if places and certified else None,
            notes,
            shape,
            alone,
        )


def _kept(margin: float) -> float:
    """What rounding has to leave of a margin: enough not to be fragile, or else nearly all."""
    return MARGIN if margin >= MARGIN else _NEARLY * margin


def _uncontrolled(system: MultiChannelSystem, weights: Weights) -> Figures:
    """The figures of the plant without a controller."""
    network = decentralized_network(as_plant(system))
    problem = FeedbackProblem.of(network, (0,) * system.m, weights)
    return figures_of(problem, np.zeros(problem.mask.shape))


def _hardly(alone: Figures, figures: Figures, region: StabilityRegion) -> str:
    """That a controller hardly improves on none."""
    inside = alone.bound < to_float(region.limit)
    told = f"it satisfies {region}, too" if inside else f"it does not satisfy {region}"
    return (
        f"without a controller the plant has {_shown(alone.cost / figures.cost)} times this cost; "
        f"{told}"
    )


def _links(controller: Controller, system: MultiChannelSystem) -> tuple[Link, ...]:
    """The links that a controller uses."""
    found = []
    for j, i in controller.edges():
        maps = [each.without_zeros() for each in controller.agents[i].maps()]
        outputs = any(j in each.outputs for each in maps) * system.q(j)
        shared = any(j in each.shared for each in maps) * controller.agents[j].shared
        if outputs + shared:
            found.append(Link(system.names[j], system.names[i], outputs + shared))
    return tuple(found)
