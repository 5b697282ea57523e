"""Whether a person would install a controller.

A controller that is certified can still be useless: fragile, costly, or with gains that no device
has.  `assess` computes the figures that say so for a design, `assessed_loop` those of any loop, and
the verdict of an `Assessment` follows from them:

- "Do not install": the region is not certified, a plant or gains within the radii are refuted, the
  loop is not stable in double precision, a plant within 0.1 % of each entry has a loop that fails,
  or a single input or output has next to no disk margin;
- "Install with care": a single input or output has a disk margin below 0.4, or all of them together
  one below 0.2; a plant within 1 % fails; the damping is below 0.05, or below the aim; the loop is
  slower than the plant without it, or than was asked; it holds no set-points and costs more than
  three times a bound for every linear time-invariant controller; it needs more than four digits;
  an output reaches twice its set-point; radii that were given are not proved, or a figure is not
  known;
- "Worth installing": none of these.

Only ratios decide, which no change of units changes: costs beside a bound, margins, damping ratios,
parts of entries.  What is proved of them is in the first line (`Assessment.first_line`) and in the
sentences of the account; the other figures are computed in floating point.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import isfinite, isnan
from typing import Any, Literal

import numpy as np

from mcexact.answer.templates import count, listed
from mcexact.errors import InputError
from mcexact.exact.matrix import finite, to_float
from mcexact.exact.rational import percent
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.model.units import Units, loop_in
from mcexact.shown import Shown, fitting
from mcexact.synthesis.design import Design
from mcexact.synthesis.networks import decentralized_network, without_integrators
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
from mcexact.synthesis.optimum.figures import (
    DISK,
    FEW_DIGITS,
    LEAST_DAMPING,
    MARGIN,
    NO_LIMITS,
    TOGETHER,
    Aims,
    Figures,
    Shape,
    figures_of,
)
from mcexact.synthesis.optimum.problem import (
    NAMES,
    FeedbackProblem,
    Weights,
    integrated_problem,
    quiet_floats,
)
from mcexact.synthesis.performance import Performance, performance_of
from mcexact.synthesis.robustness import EveryLoop, WithinRadii

Install = Literal["yes", "with care", "no"]

BASIS = "computed in floating point, not certified"
_COMPUTED = " (computed)"
LONGEST = 172
"""The characters of the first line."""
_NO_DISK, _TIMES_THE_BOUND = 0.1, 3.0
FAILS, _FAILS_AT_ONCE = Fraction(1, 100), Fraction(1, 1000)
"""Parts of entries: a loop that fails within them is installed with care, or not at all."""
_SLOWER = 0.99
_STEP_PEAK = 2.0
_REFUTED = "within the given uncertainty there is a plant whose loop is not stable"
_OPEN = "stability is not proved for everything within the given uncertainty"
_NOT_EXAMINED = "the time limit left no time to compute its margins"


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
        See `digits_that_suffice`.
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
    performance : Performance or None
        The cost beside a bound, and disk margins, of a loop that is certified.
    fails_within : Fraction or None
        The part of each entry within which a plant is known whose loop is not stable.
    asked : StabilityRegion or None
        The region that was asked for, where no loop in it was found to have the margins.
    weighed_by : str
        Where the weights of the cost come from.
    measured : bool
        Whether figures are in units near the typical sizes of the plant, not in those of the file.
    examined : bool
        Whether margins and rounded programs were looked at; else figures are those of a search.
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
    performance: Performance | None = None
    fails_within: Fraction | None = None
    asked: StabilityRegion | None = None
    weighed_by: str = ""
    measured: bool = False
    examined: bool = True

    def __repr__(self) -> str:
        return fitting(f"Assessment({self.verdict})")

    def explain(self) -> str:
        """Say in plain words whether to install the controller, and why."""
        return "\n".join([self.verdict, *self.warnings[1:], *self.notes])

    def _labeled(self) -> list[tuple[str, str]]:
        """Return the verdict and the figures as labels and texts."""
        return [("verdict", self.verdict), *self.rows()]

    def with_proofs(
        self,
        design: Design,
        every_loop: EveryLoop | None = None,
        performance: Performance | None = None,
    ) -> Assessment:
        """Return the assessment of the same design with what else is proved of it.

        Parameters
        ----------
        design : Design
        every_loop, performance : optional
            As for `assess`; a performance that is left out stays as it was.
        """
        known = self if performance is None else replace(self, performance=performance)
        if design.loop.closed.plant.plant.uncertainty is None:
            failing = None if every_loop is None else every_loop.failing
            return replace(known, fails_within=None if failing is None else failing.distance)
        return replace(
            known, within_radii="open" if every_loop is None else every_loop.within_radii
        )

    @property
    def central(self) -> Figures | None:
        """The figures of the optimal controller of all agents together, for the same region."""
        optimum = self.diagnosis.central
        return None if optimum is None else optimum.figures

    @property
    def relative_cost(self) -> float:
        """The cost divided by a bound for every linear time-invariant controller, proved or not."""
        return np.nan if self.performance is None else self.performance.times_the_bound

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """The warnings, the most important first."""
        return tuple(text for _, text in (*self._dangers(), *self._cares()))

    @property
    def install(self) -> Install:
        """Whether to install the controller."""
        if self._dangers():
            return "no"
        return "with care" if self._cares() else "yes"

    @property
    def verdict(self) -> str:
        """One line that says whether to install the controller, and why."""
        words, reason = _WORDS[self.install], (self.warnings or (self._strengths(),))[0]
        failing = () if self.fails_within is None else (self._fails(self.fails_within)[1],)
        sure = (_REFUTED, _OPEN, _NOT_EXAMINED, self._slower(), *failing)
        exact = not self.certified or reason in sure
        return f"{words}: {reason}{'' if exact or reason.endswith(_COMPUTED) else _COMPUTED}"

    def first_line(self, proved: Sequence[str] = ()) -> str:
        """What is proved of the loop, and the verdict with its reason, if 172 characters hold it.

        Parameters
        ----------
        proved : sequence of str
            The sentences about the cost, the single margins and the plants nearby, which follow
            from certificates.
        """
        reasons = [*self._dangers(), *self._cares()]
        verdict = _WORDS[self.install]
        facts = ", ".join(proved) if self.certified else ""
        facts = f"Proved: {facts}. " if facts else ""
        for short, text in reasons[:1]:
            endings = (f": {text}", f": {short}", "")
            able = (each for each in endings if len(facts + verdict + each) <= LONGEST)
            verdict += next(able, "")
        return facts + verdict

    def _strengths(self) -> str:
        digits = "1 digit suffices" if self.digits == 1 else f"{self.digits} digits suffice"
        seen = self.performance
        if seen is None:
            return digits
        parts = [f"disk margin {shown(seen.least_margin)} in every single loop"]
        if isfinite(seen.times_the_bound):
            parts.append(f"cost {shown(seen.times_the_bound)} times a bound for every controller")
        return ", ".join([*parts, digits])

    def _dangers(self) -> list[tuple[str, str]]:
        """Why nobody should install the controller: in few words, and in a sentence."""
        seen, known = self.figures, self.performance
        if not self.certified:
            return [("the loop is outside the region", f"the loop does not satisfy {self.region}")]
        if self.within_radii == "refuted":
            return [("fails within the radii", _REFUTED)]
        if seen.margin <= 0:
            text = "in double precision the computed loop is not even stable"
            return [("not stable in double precision", text)]
        dangers = []
        if known is not None and known.least_margin < _NO_DISK:
            dangers.append(self._weak(known))
        if self.fails_within is not None and self.fails_within < _FAILS_AT_ONCE:
            dangers.append(self._fails(self.fails_within))
        return dangers

    def _slower(self) -> str:
        return f"it has {self.region} in place of {self.asked}, for its margins"

    def _weak(self, known: Performance) -> tuple[str, str]:
        margin = shown(known.least_margin)
        return f"margin {margin}", f"the disk margin of the {known.weakest} is {margin}"

    def _fails(self, distance: Fraction) -> tuple[str, str]:
        part = percent(distance, up=True)
        return (
            f"fails within {part}",
            f"the loop of a plant within {part} of each entry is not stable",
        )

    def _cares(self) -> list[tuple[str, str]]:
        """Why to install the controller with care: in few words, and in a sentence."""
        seen, cares = self.figures, list[tuple[str, str]]()
        if not self.certified or seen.margin <= 0:
            return cares
        margin = seen.margin if self.performance is None else self.performance.least_margin
        figures = {"margin": margin, "peak": seen.peak, "cost": seen.cost}
        unknown = [name for name, value in figures.items() if isnan(value)]
        if unknown:
            text = (
                f"the {listed(unknown)} of the loop {'is' if len(unknown) == 1 else 'are'} not "
                "known: the loop is too sensitive for double precision"
            )
            cares.append(("too sensitive for double precision", text))
        if not self.examined:
            cares.append(("not examined", _NOT_EXAMINED))
        if self.within_radii == "open":
            cares.append(("not proved within the radii", _OPEN))
        if self.asked is not None:
            cares.append(("slower than asked", self._slower()))
        cares += self._of_margins()
        failing = self.fails_within
        if failing is not None and _FAILS_AT_ONCE <= failing < FAILS:
            cares.append(self._fails(failing))
        cares += self._of_eigenvalues()
        cares += self._of_programs()
        if self.step_peak is not None and self.step_peak > _STEP_PEAK:
            text = f"an output reaches {shown(self.step_peak)} after a unit step"
            cares.append((f"overshoot to {shown(self.step_peak)}", text))
        # No controller that holds set-points comes near a bound for those that hold none.
        if self.step_peak is None and self.relative_cost > _TIMES_THE_BOUND:
            times = shown(self.relative_cost)
            text = f"its cost is {times} times a bound for every controller"
            cares.append((f"cost {times} times the bound", text))
        return cares

    def _of_margins(self) -> Iterator[tuple[str, str]]:
        known = self.performance
        if known is None:
            return
        if _NO_DISK <= known.least_margin < DISK:
            yield self._weak(known)
        if known.joint_margin < TOGETHER:
            margin = shown(known.joint_margin)
            text = f"the disk margin of all inputs, or of all outputs, together is {margin}"
            yield f"joint margin {margin}", text

    def _of_eigenvalues(self) -> Iterator[tuple[str, str]]:
        seen, alone = self.figures, self.uncontrolled
        damping = shown(seen.damping)
        if seen.damping < LEAST_DAMPING:
            yield f"damping {damping}", f"the least damping ratio is {damping}"
        elif not self.shape.met(seen.damping, seen.fastest):
            text = (
                f"the least damping ratio is {damping} and the largest modulus of an eigenvalue "
                f"{located(seen.fastest)}, not as aimed at"
            )
            yield f"damping {damping}", text
        if alone is not None and self._pace(seen) < _SLOWER * self._pace(alone):
            text = (
                f"the slowest eigenvalue has {self.region.measure} = {located(seen.bound)}, and "
                f"{located(alone.bound)} without the controller"
            )
            yield "slower than the open loop", text

    def _pace(self, figures: Figures) -> float:
        """How fast the slowest eigenvalue decays; not above 0 if it does not."""
        if self.region.discrete:
            return -float(np.log(max(figures.bound, 1e-300)))
        return -figures.bound

    def _of_programs(self) -> Iterator[tuple[str, str]]:
        if self.digits is None:
            text = f"rounded to {MOST_DIGITS} digits, the programs lose {self.region} or the margin"
            yield f"{MOST_DIGITS} digits are too few", text
        elif self.digits > FEW_DIGITS:
            text = f"the programs need {self.digits} digits to keep {self.region} and the margin"
            yield f"{self.digits} digits are needed", text

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
        peak = compared("peak") if self.uncontrolled else _finite(seen.peak)
        unit = ", in units near the sizes" if self.measured else ""
        return [
            ("states of each agent", per_agent),
            (f"largest gain{unit}", compared("largest_gain")),
            ("slowest eigenvalue", f"{self.region.measure} = {located(seen.bound)}"),
            *self._alone(),
            ("fastest eigenvalue", f"|λ| = {located(seen.fastest)}"),
            ("least damping ratio", shown(seen.damping)),
            *self._margins(),
            ("margin at the plant's inputs", compared("margin")),
            (f"peak of the state{unit}", peak),
            *self._stepped(),
            ("cost" if self.step_peak is None else "cost with integrators", _finite(seen.cost)),
            ("cost relative to the bound", _finite(self.relative_cost)),
            ("weights of the cost", self.weighed_by),
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
        return [("without a controller", f"{self.region.measure} = {located(alone.bound)}, {cost}")]

    def _margins(self) -> Iterator[tuple[str, str]]:
        """The least disk margin of a single input or output."""
        known = self.performance
        if known is not None and isfinite(known.least_margin):
            yield "least disk margin", f"{shown(known.least_margin)} ({known.weakest})"

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
            "weights_of_the_cost": self.weighed_by,
            "performance": None if self.performance is None else self.performance.to_dict(),
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


def located(value: float) -> str:
    """Three digits, or as many as tell a modulus from 1, the border of stability.

    >>> located(0.99998414), located(1.0)
    ('0.99998', '1')
    """
    if not 0.99 < value < 1.01:
        return shown(value)
    texts = (f"{value:.{digits}g}" for digits in range(3, 12))
    return next((text for text in texts if text != "1"), "1")


def _finite(value: float) -> str:
    """A number, or a dash where a loop that is not stable has none."""
    return shown(value) if isfinite(value) or isnan(value) else "–"


# The figures of a design or of a loop, computed for its assessment.

_HARDLY = 1.02
_WORDS: Mapping[Install, str] = {
    "yes": "Worth installing",
    "with care": "Install with care",
    "no": "Do not install",
}


def assess(
    design: Design,
    aims: Aims | None = None,
    every_loop: EveryLoop | None = None,
    performance: Performance | None = None,
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
    performance : Performance, optional
        What is proved of the cost and the margins; by default they are computed.

    Returns
    -------
    Assessment

    Notes
    -----
    In floating point, in units near the sizes of the plant: only what the certificates of the
    design say is proved.

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
    parts, notes = design.parts.get("designed", design.parts), _notes(design)
    assessment = assessed_loop(
        design.loop.closed,
        design.region,
        certified=design.stable,
        weights=aims.weights,
        notes=notes,
        diagnosis=parts.get("diagnosis"),
        shape=aims.shape,
        performance=performance,
    )
    optimum = parts.get("optimum")
    if optimum is not None:
        assessment = replace(assessment, asked=optimum.asked)
    return assessment.with_proofs(design, every_loop, performance)


def _notes(design: Design) -> tuple[str, ...]:
    """The notes of a design, and remarks about its method."""
    parts, notes = design.parts.get("designed", design.parts), list(design.notes)
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
    return tuple(notes)


def assessed_by_search(design: Design, aims: Aims) -> Assessment | None:
    """Assess a design by what its search knows, at once; None for a design without a search.

    Parameters
    ----------
    design : Design
    aims : Aims
        Those of the design.

    Returns
    -------
    Assessment or None
        Never a recommendation without reserve: the margins of all ports are not looked at.
    """
    parts, loop = design.parts.get("designed", design.parts), design.loop.closed
    optimum, diagnosis = parts.get("optimum"), parts.get("diagnosis")
    if optimum is None or diagnosis is None:
        return None
    return Assessment(
        _orders(loop.controller),
        design.region,
        design.stable,
        optimum.figures,
        diagnosis,
        optimum.digits,
        _links(loop.controller, loop.plant),
        notes=_notes(design),
        shape=aims.shape,
        asked=optimum.asked,
        weighed_by=_weighed_by(loop.plant, aims.weights),
        measured=Units.of(loop.plant) is not None,
        examined=False,
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
    performance: Performance | None = None,
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
    performance : Performance, optional
        What is proved of the cost and the margins; by default they are computed.
    """
    typed, held, units = loop, integrators_of(loop), Units.of(loop.plant)
    if held is not None:
        about, weighed, units = integrated_problem(loop.plant, held.selection, weights)
        if units is not None:
            ports = units.outputs
            sigma = [each[: S.nrows] for each, S in zip(ports, held.selection, strict=True)]
            loop = loop_in(without_integrators(units, held.selection), loop, sigma)
            held = integrators_of(loop)
    else:
        weighed = Weights.of(loop.plant, weights, units)
        loop = loop if units is None else loop_in(units, loop)
        about = as_plant(loop.plant)
    plant = loop.plant
    known = diagnosis or diagnosed(about, region, weighed)
    with quiet_floats():
        figures = sure_figures(loop, weighed, held)
        alone = None if held is not None else _uncontrolled(plant, weighed)
        if certified and alone is not None and alone.cost <= _HARDLY * figures.cost:
            notes = (*notes, _hardly(alone, figures, region))
        if performance is None and certified:
            performance = performance_of(typed, weights=weights, proofs=False)
        return Assessment(
            _orders(loop.controller),
            region,
            certified,
            figures,
            known,
            digits_that_suffice(loop, region) if certified else None,
            _links(loop.controller, plant),
            step_peak(loop, held) if held is not None and certified else None,
            notes,
            shape,
            alone,
            performance=performance,
            weighed_by=_weighed_by(typed.plant, weights),
            measured=units is not None,
        )


def _weighed_by(plant: MultiChannelSystem, weights: Mapping[str, Any] | None) -> str:
    """Where the weights of the cost come from, as the table of figures says it."""
    given = sorted(weights or {})
    others = "from the typical sizes of the plant"
    if plant.typical_sizes is None:
        others = "1 for states, inputs and disturbances, 1/100 for noise, in the units of the file"
    if not given:
        return others
    return f"{listed(given)} as given" + (f"; {others}" if len(given) < len(NAMES) else "")


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


def _orders(controller: Controller) -> dict[str, int]:
    """The number of states of each agent."""
    return {agent.name: agent.shared + agent.private for agent in controller.agents}


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
