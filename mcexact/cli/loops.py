"""What `mcexact certify` and `mcexact simulate` decide about a loop, in their child processes.

`certified` decides about the loop itself, whose eigenvalues are enclosed (`certify_controller`),
and then about all loops near it: within the radii of the plant's entries and of the gains
(`loops_within`), with the largest radii if these are searched, and with gains of fewer digits
(`loops_with_digits`).  A proof for the region that is asked for is tried first, then one of mere
stability; where neither is found, a plant within the radii whose loop fails is searched.

A plant with parameters has a loop for all values in their ranges (`_certified_for_all_values`): one
search gives the largest part of the ranges with a proof, and values at which the loop fails.

`assessed` states the verdict on a controller and its figures, also for `mcexact.cli.designs`.
`simulated` runs the controller, and proves bounds on the outputs where the loop is stable.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

from mcexact.analysis.boxes.failure import FailingPlant
from mcexact.analysis.boxes.largest import (
    LargestRanges,
    LargestUncertainty,
    largest_loop_ranges,
    largest_loop_uncertainty,
)
from mcexact.analysis.boxes.loops import box_stability
from mcexact.answer.account import Account
from mcexact.answer.boxes import BoxStability
from mcexact.answer.loops import (
    EVERY_LOOP,
    EVERY_LOOP_PART,
    EVERY_LOOP_RULES,
    EVERY_SAMPLED,
    EVERY_SAMPLED_PART,
    SAMPLED_EXACTLY,
    StabilityVerdict,
)
from mcexact.answer.protocol import Answer
from mcexact.answer.saturation import SaturationStability
from mcexact.answer.sentence import Context, Sentences
from mcexact.answer.templates import count
from mcexact.cli import parts, periodic, uncertainty
from mcexact.cli.files import plant_in, system_in
from mcexact.cli.results import Evidence, Loop, Simulated, loop_document
from mcexact.derived.modulo import states_of_rest
from mcexact.derived.sampling import DECIMALS, is_sampled, sampled_system, tustin
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.rational import Limits, percent, written
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.export.fixed import FixedPoint
from mcexact.model.box import radii_in_words
from mcexact.model.controller import (
    Controller,
    controller_text,
    is_periodic,
    read_controller,
)
from mcexact.model.limits import InputLimits, limits_in
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.parametric import ParametricSystem
from mcexact.model.sizes import read_sizes
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import parse
from mcexact.report.html import AnswerPage, EmbeddedPicture, shown_plant
from mcexact.report.pages import loop_page
from mcexact.report.simulation import RealReport, SimulationReport
from mcexact.report.text import Table, tables
from mcexact.simulation.envelope import loop_of, simulated_loop
from mcexact.simulation.real import Quantizer, simulate_real
from mcexact.synthesis.assessment import BASIS, Assessment, assessed_loop
from mcexact.synthesis.certify import (
    account_of_verdict,
    certify_controller,
    enclosed_outside,
    safe_digits,
)
from mcexact.synthesis.optimum.diagnosis import curves_of, rounded_controller
from mcexact.synthesis.performance import Performance, performance_of
from mcexact.synthesis.robustness import (
    WithinRadii,
    every_loop,
    failing_plant,
    known_within,
    margins_view,
    margins_within,
)

_EFFORT = 5.0
"""The seconds of a search for the largest part of the ranges of parameters."""
_OF_DIGITS = ("digits of the gains that are safe", "digits that are too few")
"""The labels of the rows about rounded gains."""
_OF_EVERY_LOOP = (
    EVERY_LOOP,
    EVERY_LOOP_PART,
    EVERY_SAMPLED,
    EVERY_SAMPLED_PART,
    SAMPLED_EXACTLY,
)
"""What is said of every loop in a box follows the first line of an answer."""
_OF_RANGES = ("rate", "radius")
"""The options of `mcexact certify` that say what is proved for all values, besides --gains."""


def certified(
    plant: tuple[str, bytes],
    program: tuple[str, bytes],
    weights: tuple[str, bytes] | None,
    sizes: tuple[str, bytes] | None,
    limits: Mapping[str, int],
    wanted: dict[str, Any],
    with_page: bool,
    system_by_digest: bool,
) -> Loop:
    """Decide whether a controller makes its loop stable, or fast enough, and format the answer.

    Parameters
    ----------
    plant, program : tuple of str and bytes
        The names of the files of the plant and of the controller, and their contents.
    weights : tuple of str and bytes, or None
        The file of weights for the figures.
    sizes : tuple of str and bytes, or None
        The file of typical sizes, which replace those of the plant.
    limits : mapping
        The limits on input files.
    wanted : dict
        The options of `mcexact certify` that say what is asked.
    with_page, system_by_digest : bool

    Raises
    ------
    InputError
        If a file is malformed, or the controller does not fit the plant.
    UsageError
        If options contradict each other, or do not apply to the plant.
    """
    gains, effort, at = wanted.pop("gains"), wanted.pop("effort"), dict(wanted.pop("at"))
    sampling, limited = wanted.pop("sampling"), wanted.pop("limited")
    part = wanted.pop("part")
    with_box, prove_all = not wanted.pop("no_box"), wanted.pop("prove_all")
    typed_plant = plant_in(*plant, limits, at)
    if is_periodic(program[1], Limits(**limits)) and isinstance(typed_plant, MultiChannelSystem):
        others = wanted | {"gains": gains, "largest_uncertainty": effort, "limited": limited}
        others |= {"weights": weights, "sizes": sizes}
        periodic.require_only(others, ("radius", "rate"))
        asked = StabilityRegion.of(typed_plant.time, wanted["rate"], wanted["radius"])
        system = parts.without(sampled(typed_plant, sampling), part, limits)
        how = with_page, system_by_digest
        return periodic.certified(system, program, limits, asked.bound, *how)
    with InputError.inside(program[0]):
        controller = read_controller(program[1], Limits(**limits))
    if isinstance(typed_plant, ParametricSystem):
        if sampling:
            raise UsageError("a plant with parameters is not sampled: give them values with --at")
        if limited:
            raise UsageError("a plant with parameters has no limits: give them values with --at")
        parts.without(typed_plant, part, limits)
        every_option = wanted | {"weights": weights, "sizes": sizes, "effort": effort}
        return _certified_for_all_values(
            typed_plant, controller, gains, every_option, with_page, system_by_digest
        )
    sized = with_limits(with_sizes(typed_plant, sizes, limits), limited)
    system, search = uncertainty.with_radii(sized, wanted.pop("uncertainty"))
    system = parts.without(sampled(system, sampling), part, limits)
    with InputError.inside(program[0]):
        digits, notes = wanted.pop("round_gains"), tuple[str, ...]()
        warnings = list(controller.warnings_for(system))
        if sampling and not is_discrete(controller.time):
            warnings = list(controller.warnings_for(typed_plant))
            controller, note = at_samples(controller, system, digits)
            notes = (note,)
        typed = controller
        if digits is not None:
            controller = rounded_controller(controller, digits)
            rounded = f"the verdict is about the controller rounded to {count(digits, 'digit')}"
            notes = (*notes, rounded)
        if effort is not None:
            asked = StabilityRegion.of(system.time, wanted["rate"], wanted["radius"])
            bound: dict[str, Any] = {asked.word: asked.bound}
            search = largest_loop_uncertainty(system, controller, effort=effort, **bound)
            system = uncertainty.with_proved_radii(system, search)
        verdict = certify_controller(system, controller, **wanted)
    outside = enclosed_outside(verdict)
    if outside is not None:
        center = f"{outside.re} + {outside.im} i".replace("+ -", "- ")
        near = f"an eigenvalue is at most {outside.radius} from {center}"
        notes = (*notes, f"{near}, outside {verdict.region}")
    if system.D is not None:
        if gains is not None or weights is not None or with_page:
            raise UsageError(
                "of a plant with feedthrough only the eigenvalues of the loop are decided: leave "
                "out --gains, --weights and the page"
            )
        document = loop_document(verdict, warnings, wanted["largest"], digits, outside)
        return _without_figures(verdict, notes, document, system_by_digest)
    loop, weighed = closed_loop(system, controller), read_weights(weights, limits)
    with InputError.inside(plant[0] if weights is None else weights[0]):
        proved = None
        if verdict.stable:
            proved = performance_of(loop, weights=weighed, prove_all=prove_all)
        assessment = assessed_loop(
            loop,
            verdict.region,
            certified=verdict.stable,
            weights=weighed,
            notes=notes,
            performance=proved,
        )
    loops = loops_within(system, controller, verdict, gains, search)
    if with_box and verdict.stable and not loops.view:
        loops, gains = loops_near(loop, verdict, loops)
    assessment = replace(
        assessment, within_radii=loops.within_radii, fails_within=loops.fails_within(system)
    )
    account = account_of_verdict(
        verdict,
        largest=wanted["largest"],
        every_loop=loops.proof,
        gains=gains,
        failing=loops.failing,
        performance=proved,
        margins=loops.margins,
    )
    if digits is not None:
        loops = loops.with_digits(loops_with_digits(system, typed, verdict, digits))
    figures = Table(BASIS, (), (*unproved(proved), *assessment.rows()))
    return assessed(
        account,
        assessment,
        loop,
        tables=(
            *uncertainty.tables(search),
            *loops.tables(),
            *tables(account.sentences, note=account.reading),
            figures,
        ),
        pictures=uncertainty.pictures(search) if with_page else (),
        with_page=with_page,
        system_by_digest=system_by_digest and system.plant is sized,
        document=account.as_json(
            **loop_document(verdict, warnings, wanted["largest"], digits, outside),
            **loops.view,
            **uncertainty.view(search),
            assessment=assessment.to_dict(),
        ),
        controller=controller_text(limited_controller(controller, system.limits, proved)),
    )


def _without_figures(
    verdict: StabilityVerdict,
    notes: Sequence[str],
    document: Mapping[str, Any],
    system_by_digest: bool,
) -> Loop:
    """The verdict on the loop of a plant with feedthrough, whose figures are not computed."""
    account = account_of_verdict(verdict, largest=document["largest"] is not None)
    holds = "proved" if verdict.stable else "this does not hold, which is proved"
    lines = [
        f"{verdict.region}: {holds}; the loop of the plant with its feedthrough is well posed.",
        "note: costs, margins and peaks of such loops are not computed",
        *(f"note: {each}" for each in notes),
    ]
    return Loop.without_figures(account, document, lines, system_by_digest)


def assessed(
    account: Account,
    assessment: Assessment,
    loop: ClosedLoop,
    *,
    tables: tuple[Table, ...],
    pictures: tuple[EmbeddedPicture, ...] = (),
    with_page: bool,
    system_by_digest: bool,
    document: Mapping[str, Any],
    controller: str,
) -> Loop:
    """Return a controller with the verdict on its loop, as it is shown.

    Parameters
    ----------
    account : Account
        The certified answers; what they say of all loops near this one follows the verdict.
    assessment : Assessment
        The verdict, with figures that are computed and not certified.
    loop : ClosedLoop
    tables : tuple of Table
    pictures : tuple of EmbeddedPicture
        The pictures that come first on the page.
    with_page, system_by_digest : bool
    document : mapping
        What ``--json`` prints.
    controller : str
        The controller's file.
    """
    lines = [assessment.first_line(account.sentences.at("first"))]
    lines += [each.line for each in account.sentences if each.template in _OF_EVERY_LOOP]
    lines += [each.line for each in account.sentences.at("modulo")]
    lines += [f"warning: {each}" for each in assessment.warnings if each not in lines[0]]
    lines += [f"note: {each}" for each in assessment.notes]
    page = None
    if with_page:
        curves = curves_of(loop, assessment.region)
        page = loop_page(
            account,
            assessment.install,
            lines,
            tables,
            curves,
            loop.controller,
            assessment.performance,
        )
        page = replace(page, pictures=(*pictures, *page.pictures))
    evidence = Evidence.of(account, system_by_digest)
    whole = {**document, "first_line": lines[0]}
    return Loop(evidence, whole, tables, page, lines, controller)


def unproved(performance: Performance | None) -> tuple[tuple[str, str], ...]:
    """The rows of what is not proved of the performance."""
    return () if performance is None else tuple(performance.rows())


def read_weights(
    file: tuple[str, bytes] | None, limits: Mapping[str, int]
) -> dict[str, Any] | None:
    """Read a file of weights, an object of lists of rows; None without a file.

    Raises
    ------
    InputError
        If it is malformed; sizes and entries are checked when the plant is known.
    """
    if file is None:
        return None
    with InputError.inside(file[0]):
        content = parse(file[1], Limits(**limits))
        if not isinstance(content, dict):
            raise InputError('expected an object such as {"Q": rows, "R": rows}')
    return content


def with_sizes(
    system: MultiChannelSystem, file: tuple[str, bytes] | None, limits: Mapping[str, int]
) -> MultiChannelSystem:
    """The plant with the typical sizes of a file, an object as in a system file; or with its own.

    Raises
    ------
    InputError
        If it is malformed, or does not fit the plant.
    """
    if file is None:
        return system
    p, q = ([size(i) for i in range(system.m)] for size in (system.p, system.q))
    with InputError.inside(file[0]):
        content = parse(file[1], Limits(**limits))
        sizes = read_sizes(content, system.names, system.n, p, q, Limits(**limits))
    return system.with_typical_sizes(sizes)


def with_limits(system: MultiChannelSystem, texts: Sequence[str]) -> MultiChannelSystem:
    """The plant with the limits of inputs that texts give, or with its own if there are none."""
    if not texts:
        return system
    chosen = limits_in(texts, system.names, [system.p(i) for i in range(system.m)])
    return system.with_limits(
        None if chosen is None else dict(zip(system.names, chosen, strict=True))
    )


def limited_controller(
    controller: Controller, limits: InputLimits | None, proved: Performance | None
) -> Controller:
    """The controller with limits of its inputs, and with the anti-windup gains of a proof.

    Without a proof it has its own limits, or else those of the plant, and its own gains.
    """
    found = None if proved is None else proved.answers.get("saturation")
    if isinstance(found, SaturationStability):
        return controller.with_saturation(found.limits, found.back_calculation)
    own = any(agent.limits is not None for agent in controller.agents)
    return controller if own or limits is None else controller.with_saturation(limits)


def at_samples(
    controller: Controller, system: MultiChannelSystem, digits: int | None = None
) -> tuple[Controller, str]:
    """A controller in continuous time for the samples of a plant, and what was done to it.

    Its entries are rounded to 12 digits, unless they are rounded to others afterwards.
    """
    said = "the controller, in continuous time, is taken at the samples by Tustin's rule"
    held = tustin(controller, system)
    if digits is not None:
        return held, said
    return rounded_controller(held, DECIMALS), f"{said}, rounded to {count(DECIMALS, 'digit')}"


def sampled(system: MultiChannelSystem, sampling: Mapping[str, Any]) -> MultiChannelSystem:
    """The plant at the samples, or itself if no step is given."""
    return sampled_system(system, **sampling) if sampling else system


@dataclass(frozen=True)
class Loops:
    """What is proved about all loops within radii of plant and gains.

    Attributes
    ----------
    rows : tuple of (str, str)
        Labels and texts of a table.
    proof : BoxStability or None
        The proof that all of them are in a region.
    view : mapping
        What the JSON of an answer says of them.
    within_radii : str or None
        Whether all loops within the radii of the plant are stable; None if it has none.
    failing : FailingPlant or None
        A plant nearby whose loop is not stable.
    margins : mapping
        Proofs of disk margins of single inputs and outputs in a box.
    """

    rows: tuple[tuple[str, str], ...] = ()
    proof: BoxStability | None = None
    view: Mapping[str, Any] = field(default_factory=dict)
    within_radii: WithinRadii | None = None
    failing: FailingPlant | None = None
    margins: Mapping[str, BoxStability] = field(default_factory=dict)

    def fails_within(self, plant: MultiChannelSystem) -> Fraction | None:
        """The part of its entries within which a plant fails, if it has no radii of its own."""
        own = plant.uncertainty is not None
        return None if self.failing is None or own else self.failing.distance

    def tables(self) -> tuple[Table, ...]:
        """The table, if there is something to say."""
        about_digits = all(label in _OF_DIGITS for label, _ in self.rows)
        title = "rounded gains" if about_digits else "every loop in the box"
        return (Table(title, (), self.rows),) if self.rows else ()

    def with_digits(self, other: Loops) -> Loops:
        """The same with rows and data about digits."""
        return replace(self, rows=self.rows + other.rows, view={**self.view, **other.view})


def loops_within(
    system: MultiChannelSystem,
    controller: Controller,
    verdict: StabilityVerdict,
    gains: Fraction | None,
    search: LargestUncertainty | None = None,
) -> Loops:
    """Decide whether every loop within the radii of plant and gains is in the region of a verdict.

    Where this is not proved, stability alone is tried, and then a plant whose loop fails is
    searched.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    verdict : StabilityVerdict
        About the nominal loop.
    gains : Fraction or None
        The radii of the gains, as a part of their moduli.
    search : LargestUncertainty or None
        The search that found the radii of the system.
    """
    near = None if search is None or not verdict.stable else search.nearby
    uncertain = system.plant.uncertainty is not None
    if not uncertain and gains is None:
        return Loops(failing=near)
    rows = [("plant", radii_in_words(system.plant))] if uncertain else []
    rows += [] if gains is None else [("gains", f"within {percent(gains)}")]
    proof, failing, region = None, None, _region_for_boxes(verdict)
    unproved = [region]
    if verdict.stable:
        known = None if search is None else search.proof
        proof, region, unproved = _proof(system, controller, region, gains, known)
    if unproved:
        neither = "".join(f", and neither is {each}" for each in unproved[1:])
        rows.append(("eigenvalues of every loop", f"{unproved[0]} is not proved{neither}"))
    view: dict[str, Any] = {"certified": proof is not None, "region": str(region)}
    sampled_or_own = not system.subject or is_sampled(system)
    if proof is None and verdict.stable and uncertain and sampled_or_own:
        failing = failing_plant(closed_loop(system, controller))
    if failing is not None:
        view |= {"fails_within": written(failing.distance), "failing": failing.plant.to_dict()}
    within: WithinRadii | None = known_within(proof, failing)
    if search is not None and search.proof is not None:
        within = _within_radii_of_file(search)
    margins = dict[str, BoxStability]()
    if proof is not None and uncertain:
        margins = margins_within(closed_loop(system, controller))
        view["margins"] = margins_view(margins)
    return Loops(tuple(rows), proof, {"every_loop": view}, within, failing or near, margins)


def loops_near(
    loop: ClosedLoop, verdict: StabilityVerdict, known: Loops
) -> tuple[Loops, Fraction | None]:
    """All loops in a box that is searched around a plant without radii, and the gains' radii."""
    around = every_loop(loop, verdict.region)
    failing = known.failing or around.failing
    view = {"every_loop": around.to_dict()}
    rows, margins = tuple(around.rows()), around.margins
    own = loop.plant.plant.uncertainty is not None
    within = around.within_radii if own else None
    return Loops(rows, around.proof, view, within, failing, margins), around.gains


def _within_radii_of_file(search: LargestUncertainty) -> WithinRadii | None:
    """Whether all loops are stable within the radii of the file, from which a search began."""
    if search.relative:
        return None
    if search.lower >= 1:
        return "proved"
    # A plant that misses a rate or radius may be stable.
    fails = isinstance(search.proof, BoxStability) and search.proof.bound is None
    return "refuted" if fails and search.upper is not None and search.upper <= 1 else "open"


def _proof(
    system: MultiChannelSystem,
    controller: Controller,
    asked: StabilityRegion,
    gains: Fraction | None,
    known: Answer | None,
) -> tuple[BoxStability | None, StabilityRegion, list[StabilityRegion]]:
    """A proof for the region that is asked for, or else for stability, and what is not proved.

    A proof in ``known`` is used and not made again.
    """
    unproved = list[StabilityRegion]()
    for region in dict.fromkeys((asked, StabilityRegion(asked.time))):
        if isinstance(known, BoxStability) and known.region == region:
            return known, region, unproved
        bound: dict[str, Any] = {region.word: region.bound}
        with suppress(LimitReached):
            proof = box_stability(system, controller, gains=gains, **bound)
            return proof, region, unproved
        unproved.append(region)
    return None, asked, unproved


def _region_for_boxes(verdict: StabilityVerdict) -> StabilityRegion:
    """The region of a verdict without its limits on damping and modulus: boxes have none."""
    return replace(verdict.region, damping=None, largest_modulus=None)


def loops_with_digits(
    system: MultiChannelSystem, controller: Controller, verdict: StabilityVerdict, most: int
) -> Loops:
    """Decide how many digits of the gains are safe, however rounded, and find too few of them."""
    region = _region_for_boxes(verdict)
    bound: dict[str, Any] = {region.word: region.bound}
    known = safe_digits(system, controller, most=most, **bound)
    safe = "none proved" if known.safe is None else f"{count(known.safe, 'digit')}, however rounded"
    safe += "" if region == verdict.region else f", for {region} alone"
    few = (
        "none found"
        if known.unsafe is None
        else f"{count(known.unsafe, 'digit')}, rounded up or down so that the loop fails"
    )
    view = {"safe_digits": {"safe": known.safe, "too_few": known.unsafe}}
    rows = tuple(zip(_OF_DIGITS, (safe, few), strict=True))
    return Loops(rows, None, view)


def _certified_for_all_values(
    system: ParametricSystem,
    controller: Controller,
    gains: Fraction | None,
    wanted: Mapping[str, Any],
    with_page: bool,
    system_by_digest: bool,
) -> Loop:
    """Prove a loop for all values, or search the largest part of the ranges and values that fail.

    Parameters
    ----------
    system : ParametricSystem
    controller : Controller
    gains : Fraction or None
        The radii of the gains, as a part of their moduli.
    wanted : mapping
        The other options by name.
    with_page, system_by_digest : bool

    Raises
    ------
    UsageError
        If something is asked that is only decided for systems without parameters.
    """
    if any(value for name, value in wanted.items() if name not in _OF_RANGES):
        raise UsageError(
            "with parameters only --rate, --radius and --gains are decided: give values to "
            f"{', '.join(system.parameters)} by --at NAME=VALUE"
        )
    asked = {name: wanted[name] for name in _OF_RANGES}
    region = StabilityRegion.of(system.time, **asked)
    search = largest_loop_ranges(system, controller, gains=gains, effort=_EFFORT, **asked)
    account = _account_of_ranges(system, search, gains)
    ranges = ", ".join(system.parameters_in_words)
    proved = search.lower == 1
    if proved:
        sentence = f"{region} for every {ranges}: proved."
    elif search.failing is not None:
        sentence = f"{region} does not hold for every {ranges}."
    else:
        sentence = (
            f"{region} for every {ranges}: open, as no proof and no value that fails was found."
        )
    table = _ranges_table(account, search, proved)
    return Loop(
        evidence=_ranges_evidence(account, search, proved, system_by_digest),
        document=account.as_json(
            certified=proved,
            refuted=search.failing is not None,
            region=str(region),
            bound=None if region.bound is None else str(region.bound),
            parameters=system.document()["parameters"],
            largest_ranges=search.to_dict(),
            warnings=[],
        ),
        tables=(table,),
        page=_ranges_page(system, sentence, table, proved) if with_page else None,
        verdict=[sentence],
        controller="",
    )


def _account_of_ranges(
    system: ParametricSystem, search: LargestRanges, gains: Fraction | None
) -> Account:
    """The proof for the whole ranges with its sentence, if there is one."""
    ranges = ", ".join(system.parameters_in_words)
    asked = Context(system, {"parameters": ranges, "part_of_gains": gains})
    whole = search.proof is not None and search.lower == 1
    answers: dict[str, Any] = {"box_stability": search.proof} if whole else {}
    return Account(answers, asked, EVERY_LOOP_RULES.sentences(answers, asked))


def _ranges_evidence(
    account: Account, search: LargestRanges, proved: bool, system_by_digest: bool
) -> Evidence:
    """The certificates: of the whole ranges, or of a part of them and of values that fail."""
    if proved:
        return Evidence.of(account, system_by_digest)
    parts = {
        "box_stability_in_part.json": search.proof,
        "stability_at_values.json": search.refutation,
    }
    return Evidence.about_own_plants(
        {name: answer for name, answer in parts.items() if answer is not None}
    )


def _ranges_table(account: Account, search: LargestRanges, proved: bool) -> Table:
    """The sentence, or how large a part of the ranges is proved and where the loop fails."""
    rows = [each.cells for each in account.sentences] if proved else list(search.rows())
    return Table("closed loop" if proved else "largest part of the ranges", (), tuple(rows))


def _ranges_page(system: ParametricSystem, sentence: str, table: Table, proved: bool) -> AnswerPage:
    """The page of a loop for all values."""
    return AnswerPage(
        title=system.name or "A closed loop",
        heading="A controller and its closed loops, for all values of the plant's parameters.",
        good=proved,
        answer=(sentence,),
        pictures=(),
        tables=(table,),
        plant=shown_plant(system),
    )


def simulated(
    plant: tuple[str, bytes],
    program: tuple[str, bytes],
    limits: Mapping[str, int],
    wanted: dict[str, Any],
    suffix: str,
    fractions: bool,
    system_by_digest: bool,
    real: Mapping[str, Any],
) -> Simulated:
    """Run a controller on a plant, prove bounds on the outputs, and format the results.

    Parameters
    ----------
    plant, program : tuple of str and bytes
        The names of the files of the plant and of the controller, and their contents.
    limits : mapping
        The limits on input files.
    wanted : dict
        The arguments of `simulated_loop`, and the part that is left out; one number as the initial
        state is that of every state of the plant.
    suffix : str
        The end of the name of the file that is written: ".csv", ".png", ".html" or nothing.
    fractions : bool
        Whether exact numbers are written as fractions.
    system_by_digest : bool
    real : mapping
        What makes the loop real: the sampling, limits, converters and code; empty if nothing does.

    Raises
    ------
    InputError
        If a file is malformed, or the controller does not fit the plant.
    """
    given, part = system_in(*plant, limits), wanted.pop("part")
    if is_periodic(program[1], Limits(**limits)):
        how = suffix, fractions, system_by_digest
        return periodic.simulated(given, part, program, limits, wanted, real, *how)
    system = parts.without(given, part, limits)
    with InputError.inside(program[0]):
        controller = read_controller(program[1], Limits(**limits))
    initial = wanted["initial"]
    if initial is not None:
        initial = initial * given.n if len(initial) == 1 else initial
        own = system is given or len(initial) != given.n
        wanted = wanted | {"initial": initial if own else states_of_rest(system, initial)}
    report: SimulationReport | RealReport
    if real:
        run = simulate_real(system, controller, **_realized(system, real), **_signals(wanted))
        warnings = controller.warnings_for(run.ideal.loop.plant)
        report = RealReport(run, loop_of(run.ideal, system.name, warnings))
    else:
        report = SimulationReport(simulated_loop(system, controller, **wanted), fractions)
    simulation = report.done
    account = Account({}, Context(system), Sentences([]))
    evidence = Evidence({}, {}, system.canonical_text())
    if simulation.envelope is not None:
        account = account_of_verdict(simulation.envelope.proof, largest=False)
        evidence = Evidence.of(account, system_by_digest)
    return Simulated(
        evidence=evidence,
        document=account.as_json(**report.as_json()),
        tables=report.tables(),
        page=report.page() if suffix == ".html" else None,
        warnings=simulation.warnings,
        file=report.file(suffix),
    )


def _signals(wanted: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a simulation that a real loop has as well."""
    ideal = ("arithmetic", "points", "cosines")
    return {name: value for name, value in wanted.items() if name not in ideal}


def _realized(system: MultiChannelSystem, real: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of `simulate_real`; what is given once holds for all signals."""
    p, q = (sum(size(i) for i in range(system.m)) for size in (system.p, system.q))
    converters = {
        "quantized_outputs": real["quantize_outputs"],
        "quantized_inputs": real["quantize_inputs"],
    }
    given: dict[str, Any] = {name: real[name] for name in ("step", "late") if name in real}
    if real["limited"] is not None:
        chosen = limits_in(real["limited"], system.names, [system.p(i) for i in range(system.m)])
        given["limits"] = [pair for own in chosen or () for pair in own]
    for (name, texts), count_ in zip(converters.items(), (q, p), strict=True):
        if texts is not None:
            made = [_converter(each) for each in texts]
            given[name] = made * (count_ if len(made) == 1 else 1)
    if real["fixed_point"] is not None:
        given["fixed"] = FixedPoint(real["fixed_point"], real["ranges"])
    return given | ({} if real["code"] is None else {"code": real["code"]})


def _converter(numbers: Sequence[Fraction]) -> Quantizer:
    """A converter of a step, or of bits and a range."""
    if len(numbers) == 1:
        return Quantizer(numbers[0])
    bits, low, high = numbers
    if bits.denominator != 1:
        raise UsageError(f"expected a number of bits, found {bits}")
    return Quantizer.of_bits(int(bits), low, high)
