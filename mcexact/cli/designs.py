"""What the commands of `mcexact design` design and prove, in their child processes.

`designed` calls the function of `mcexact.synthesis` that a command is about, and assesses the
controller that it certified.  For a controller that meets the request and is stable it also
searches a part by which all entries of the plant may differ.  Where no controller of the kind
exists, the result is the proof of this, with advice: a design over the links of the plant, if
outputs that are shared over them leave no fixed mode, or else a search of links to add.
"""

from __future__ import annotations

import shlex
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import log10
from typing import Any

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.account import Account
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.protocol import Answer, is_about_dual
from mcexact.answer.sentence import Context, Sentences
from mcexact.answer.structure import JointControllability, SetpointSolvability
from mcexact.answer.templates import Sentence
from mcexact.cli import parts, periodic
from mcexact.cli.files import system_in
from mcexact.cli.loops import (
    assessed,
    limited_controller,
    read_weights,
    sampled,
    unproved,
    with_limits,
    with_sizes,
)
from mcexact.cli.options import AIMS
from mcexact.cli.results import DESIGNED, Evidence, Loop, Refused
from mcexact.cli.running import Reporting
from mcexact.derived.constructions import augmented_outputs, merged
from mcexact.derived.feedthrough import input_filters, plant_controller
from mcexact.derived.sampling import is_sampled
from mcexact.errors import Impossible, InputError, LimitReached, UsageError
from mcexact.exact.rational import Limits, percent, written
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.model.controller import controller_text
from mcexact.model.regulated import positions_of, selection_in_words
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import parse
from mcexact.report.text import Table, measured, tables
from mcexact.synthesis.assessment import Assessment, assess, assessed_by_search
from mcexact.synthesis.certify import certify_controller
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.design import Design
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.gate import Warned
from mcexact.synthesis.longest_step import LongestStep, longest_step
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.performance import NO_TIME, Performance, PerformanceSearch
from mcexact.synthesis.periodic import MOST_STATES
from mcexact.synthesis.robustness import EveryLoop
from mcexact.synthesis.setpoint import design_setpoint, held_together, selected
from mcexact.synthesis.state_feedback import require_numbers

_PROVING = 0.5
"""The part of the rest of the time after which no further proof of the performance is begun."""
_SHOWING = 0.2
"""The part of the rest of the time that is left for showing the result."""
_STEPPING = 5.0
"""The seconds after which no longer step of a sampled plant is tried."""
_HOLDING = 20.0
"""The seconds after which no other step of a controller in continuous time is tried."""
_NOTHING_ELSE = (
    "the time limit ended the proofs of the cost and of the margins, whose figures are computed, "
    "and no box of plants was sought"
)
_NO_BOX = "the time limit ended the search of a box of plants"
_NO_STEP = "the time limit ended the search of the longest time between samples"
_FIGURES = (
    "costs and margins are those of the system with its inputs as states, whose inputs are the "
    "derivatives, or next values, of the inputs of the plant"
)
_DESIGNERS: dict[str, Callable[..., Design]] = {
    "decentralized": design_decentralized,
    "extended": design_extended,
    "observer": design_observer,
    "setpoint": design_setpoint,
}


def designed(
    name: str,
    plant: tuple[str, bytes],
    prescribed: tuple[str, bytes] | None,
    weights: tuple[str, bytes] | None,
    sizes: tuple[str, bytes] | None,
    limited: Sequence[str],
    limits: Mapping[str, int],
    sampling: Mapping[str, Any],
    part: parts.Part,
    wanted: dict[str, Any],
    aimed: Mapping[str, Any],
    with_box: bool,
    prove_all: bool,
    with_page: bool,
    system_by_digest: bool,
    left: float | None,
    tell: Callable[[str], None],
    report: Reporting,
) -> Loop | Refused:
    """Design a controller, prove its loop, and format the result.

    Parameters
    ----------
    name : str
        The name of the command, which is that of the function without ``design_``.
    plant : tuple of str and bytes
        The name of the file and its content.
    prescribed, weights, sizes : tuple of str and bytes, or None
        The spectrum, the weights and the typical sizes, with the names by which messages refer to
        them.
    limited : sequence of str
        The limits of inputs; if empty, those of the plant.
    limits : mapping
        The limits on input files.
    sampling : mapping
        The step and the delay with which the plant is sampled; empty if it is not.
    part : str, or tuple of str and bytes, or None
        The part of the state that is left out, or a file with a subspace.
    wanted : dict
        Keyword arguments of the function.
    aimed : mapping
        The options of a search (`mcexact.cli.options.AIMS`); empty if the command has none.
    with_box : bool
        Whether to search a part by which the entries of the plant may differ.
    prove_all : bool
        Whether costs and margins are proved however large the certificates are.
    with_page, system_by_digest : bool
    left : float or None
        The seconds of the time limit; None without one.
    tell : callable
        Shows a warning to the user at once.
    report : Reporting
        Takes the progress, and with a time limit the design whenever more is proved of it.

    Raises
    ------
    InputError
        If a file is malformed or does not fit the plant; the message names the file.
    UsageError
        If a box is asked for of a plant with feedthrough.
    LimitReached
        If no command would read the controller.
    """

    def progress(step: str) -> None:
        if isinstance(step, Warned):
            tell(step)
        else:
            report.step(step)

    spectrum, end = None, None if left is None else time.monotonic() + left
    sized = with_sizes(system_in(*plant, limits), sizes, limits)
    system = sampled(with_limits(sized, limited), sampling)
    base = parts.without(system, part, limits)
    if "longest" in wanted:
        radius, longest = wanted["radius"], wanted["longest"]
        return periodic.designed(plant, base, radius, longest, system_by_digest, progress)
    system = _inputs_as_states(base)
    weighed = read_weights(weights, limits)
    aims = _aims(aimed, weighed)
    if base.D is not None and aims.box is not None:
        raise UsageError("boxes are not known of plants with feedthrough: leave out --box")
    if aimed:
        wanted["aims"] = aims
    try:
        if prescribed is not None:
            spectrum = parse(prescribed[1], Limits(**limits))
            require_numbers(spectrum)
        design = _DESIGNERS[name](system, spectrum=spectrum, progress=progress, **wanted)
    except InputError as error:
        file = prescribed or weights or plant
        raise error.within(file[0]) from None
    except Impossible as refused:
        reason, proof = refused.message, refused.certificate
        region = StabilityRegion.of(system.time, wanted["rate"], wanted["radius"])
        sentences = Sentences([reason] if isinstance(reason, Sentence) else [])
        account = Account({proof.kind: proof}, Context(system), sentences, system.subject)
        return Refused(
            evidence=Evidence.of(account, system_by_digest),
            document=account.as_json(design=name, possible=False, reason=reason),
            reason=str(refused),
            advice=_advice(name, plant[0], proof, system, region, sampling)
            + _held(plant[0], proof, system, wanted, sampling),
        )
    _require_readable(design, Limits(**limits))
    with_box = with_box and base.D is None
    direct = None if base.D is None else base
    shape = _Shaped(design, aims, weighed, prove_all, with_box, with_page, system_by_digest, direct)
    return shape.in_time(end, report)


@dataclass(frozen=True)
class _Shaped:
    """A certified design, of which more is proved step by step, and how it is shown."""

    design: Design
    aims: Aims
    weights: Mapping[str, Any] | None
    prove_all: bool
    with_box: bool
    with_page: bool
    system_by_digest: bool
    direct: MultiChannelSystem | None = None
    """The plant with feedthrough, if the design is for its inputs as states."""

    def in_time(self, end: float | None, report: Reporting) -> Loop:
        """Prove the performance, then a box, and hand over what is proved before each step.

        Parameters
        ----------
        end : float or None
            The time of `time.monotonic` at which the time limit ends this process.
        report : Reporting
        """
        design = self.design
        every_loop: EveryLoop | None = None
        if not design.stable:
            return self._shown(assess(design, self.aims), None, None)
        if end is not None and (quick := assessed_by_search(design, self.aims)) is not None:
            report.keep(DESIGNED, self._shown(quick, None, None, _NOTHING_ELSE))
            report.step("figures of the loop")
        search = PerformanceSearch(design.loop.closed, self.weights)
        computed = search.computed
        assessment = assess(design, self.aims, performance=computed)

        def shown(proved: Performance, note: str | None = None) -> Loop:
            known = assessment.with_proofs(design, every_loop, proved)
            return self._shown(known, proved, every_loop, note)

        deadline = None
        if end is not None:
            computed = replace(computed, left_out=dict.fromkeys(computed.left_out, NO_TIME))
            report.keep(DESIGNED, shown(computed, _NOTHING_ELSE))
            deadline = time.monotonic() + _PROVING * (end - time.monotonic())
        report.step("proofs of the cost and of the margins")
        proved = search.proved(prove_all=self.prove_all, deadline=deadline)
        if self.with_box:
            if end is not None:
                report.keep(DESIGNED, shown(proved, _NO_BOX))
            report.step("a proof for a box of plants")
            effort = {"effort": self.aims.effort} if self.aims.effort else {}
            rest = None if end is None else end - _SHOWING * (end - time.monotonic())
            asked = None if self.aims.box is None else Fraction(self.aims.box)
            every_loop = design.every_loop(**effort, deadline=rest, part=asked)
        longest = None
        plant = design.loop.closed.plant
        if is_sampled(plant) or not is_discrete(plant.time):
            if end is not None:
                report.keep(DESIGNED, shown(proved, _NO_STEP))
            longest = self._longest_step(end, report)
        return self._shown(
            assessment.with_proofs(design, every_loop, proved), proved, every_loop, longest=longest
        )

    def _longest_step(self, end: float | None, report: Reporting) -> LongestStep:
        """The longest time between samples with which the controller keeps its margins."""
        closed = self.design.loop.closed
        report.step("the longest step with these margins")
        now = time.monotonic()
        deadline = now + (_STEPPING if is_sampled(closed.plant) else _HOLDING)
        if end is not None:
            deadline = min(deadline, end - _SHOWING * (end - now))
        return longest_step(
            closed.plant,
            closed.controller,
            margin=Fraction(str(self.aims.disk)),
            prove_all=self.prove_all,
            deadline=deadline,
        )

    def _shown(
        self,
        assessment: Assessment,
        proved: Performance | None,
        every_loop: EveryLoop | None,
        note: str | None = None,
        longest: LongestStep | None = None,
    ) -> Loop:
        """The design with what is proved of it, and a note of what is left out."""
        design = self.design
        notes = [*([] if note is None else [note]), *_box_missed(self.aims, every_loop)]
        notes += [] if self.direct is None else [_FIGURES]
        assessment = replace(assessment, notes=(*assessment.notes, *notes))
        account = design.account_with(every_loop, proved, longest)
        rows = (*unproved(proved), *assessment.rows())
        figures = measured(design.measures(), rows, account.sentences, design.region.discrete)
        listed = tables(account.sentences, note=account.reading)
        limits = design.loop.closed.plant.limits
        told = assessed(
            account,
            assessment,
            design.loop.closed,
            tables=(*listed, *_box(every_loop), *_steps(longest), figures),
            with_page=self.with_page,
            system_by_digest=self.system_by_digest,
            document=account.as_json(
                **design.to_dict(),
                **({} if every_loop is None else {"every_loop": every_loop.to_dict()}),
                **({} if longest is None else {"longest_step": longest.to_dict()}),
                assessment=assessment.to_dict(),
            ),
            controller=controller_text(
                limited_controller(design.controller, limits, proved)
                if self.direct is None
                else plant_controller(design.controller, self.direct)
            ),
        )
        if self.direct is not None:
            return self._of_plant(told, self.direct)
        return told

    def _of_plant(self, told: Loop, plant: MultiChannelSystem) -> Loop:
        """The design with a certificate about the loop of the plant with its feedthrough."""
        region = self.design.region
        given: dict[str, Any] = {region.word: region.bound, **region.limits}
        verdict = certify_controller(
            plant, plant_controller(self.design.controller, plant), **given
        )
        others = Evidence.about_own_plants({"loop_of_plant.json": verdict})
        return replace(told, evidence=told.evidence.with_others(others))


def _inputs_as_states(system: MultiChannelSystem) -> MultiChannelSystem:
    """The system, or with its inputs as states if it has feedthrough.

    Raises
    ------
    InputError
        If something was asked that is not known of systems with feedthrough.
    """
    if system.D is None:
        return system
    if system.limits is not None:
        InputError.require(system, MultiChannelSystem, "system")
    return input_filters(system)


def _aims(aimed: Mapping[str, Any], weights: Mapping[str, Any] | None) -> Aims:
    """Return the aims that the options of a search give, and the content of a file of weights."""
    if not aimed:
        return Aims(weights=weights)
    chosen = {name: aimed[name] for name in AIMS}
    seconds = aimed.get("seconds")
    return Aims(weights=weights, digits=chosen.pop("most_digits"), seconds=seconds, **chosen)


def _advice(
    name: str,
    file: str,
    proof: Answer,
    system: MultiChannelSystem,
    region: StabilityRegion,
    sampling: Mapping[str, Any],
) -> str:
    """Return which command may help where no controller without communication exists.

    This is a design over the links of the plant, if sharing outputs over these leaves no fixed mode
    outside the region; otherwise a search of links to add.  A command without --step is advised for
    the file of the sampled plant.
    """
    about, held = "; ", file
    if sampling:
        held = "sampled.json"
        command = f"mcexact c2d {file}{_options_of(sampling)} -o {held}"
        about = f"; of the plant at the samples, which `{command}` writes, "
    if lacking(proof, region):
        command = f"mcexact design {name} {held} --modulo unobservable"
        return f"{about}`{command}` designs for the plant modulo what no output shows"
    if not isinstance(proof, FixedSpectrum):
        return ""
    if [each["construction"] for each in proof.subject][-2:-1] == ["arcs"]:
        return f"{about}`mcexact allocate {held} --links` says which links to add"
    if name != "decentralized":
        return ""
    if all(len(factor.channels) in (0, system.m) for factor in proof.factors):
        return ""
    advice = _over_links(file, system, region, sampling, about, held)
    if _moved_by_periodic_gains(system, region):
        asked = "" if region.bound is None else f" --{region.word} {written(region.bound)}"
        command = f"mcexact design decentralized {file}{_options_of(sampling)} --periodic{asked}"
        advice += f"; `{command}` designs gains that vary periodically, which move the mode"
    return advice


def _moved_by_periodic_gains(system: MultiChannelSystem, region: StabilityRegion) -> bool:
    """Whether a periodic design has no quotient fixed mode against it, in discrete time."""
    made = [each["construction"] for each in system.subject]
    if not is_discrete(system.time) or system.n > MOST_STATES or made not in ([], ["sampled"]):
        return False
    parts_ = transfer_graph(system).components
    return not fixed_spectrum(merged(system, parts_)).outside(region)


def _over_links(
    file: str,
    system: MultiChannelSystem,
    region: StabilityRegion,
    sampling: Mapping[str, Any],
    about: str,
    held: str,
) -> str:
    """Return the advice about links."""
    links = "links between agents change"
    if system.neighbors is not None and system.neighbors.edges():
        left = fixed_spectrum(augmented_outputs(system)).factors
        if all(region.contains_roots_of(factor.polynomial) for factor in left):
            asked = "" if region.bound is None else f" --{region.word} {written(region.bound)}"
            command = f"mcexact design extended {file}{_options_of(sampling)}{asked}"
            return f"; over the links of this plant, `{command}` designs one"
        links = "more links between agents change"
    return f"{about}`mcexact allocate {held} --links` says whether {links} this"


def _options_of(sampling: Mapping[str, Any]) -> str:
    """The options with which a command samples the plant in the same way."""
    if not sampling:
        return ""
    late = f" --late {sampling['late']}" if sampling["late"] else ""
    return f" --step {written(sampling['step'])}{late}"


def lacking(proof: Answer, region: StabilityRegion) -> bool:
    """Whether a proof that no controller exists is only about modes that no output shows."""
    if isinstance(proof, FixedSpectrum):
        outside = proof.outside(region)
        return bool(outside) and all(len(f.channels) == proof.about.m for f in outside)
    return isinstance(proof, JointControllability) and is_about_dual(proof.subject)


def _held(
    file: str,
    proof: Answer,
    system: MultiChannelSystem,
    wanted: Mapping[str, Any],
    sampling: Mapping[str, Any],
) -> str:
    """Return which outputs can be held together where not all that were asked for can be."""
    if not isinstance(proof, SetpointSolvability):
        return ""
    kept = held_together(system, selected(system, wanted.get("regulate")))
    if not any(S.nrows for S in kept):
        return ""
    said = f"; all set-points of {selection_in_words(kept, system.names)} have one"
    chosen = [(name, positions_of(S)) for name, S in zip(system.names, kept, strict=True)]
    if any(positions is None for _, positions in chosen):
        return said
    texts = [f"{name}:{','.join(map(str, positions))}" for name, positions in chosen if positions]
    command = shlex.join(["mcexact", "design", "setpoint", file]) + _options_of(sampling)
    asked = " ".join(f"--regulate {shlex.quote(text)}" for text in texts)
    if wanted.get("signals") is not None:
        asked += f" --signals {shlex.quote(wanted['signals'])}"
    return f"{said}: `{command} {asked}` asks for these"


def _box_missed(aims: Aims, every_loop: EveryLoop | None) -> Iterator[str]:
    """What --box asked for, where less is proved of a plant without radii of its own."""
    if aims.box is None or every_loop is None:
        return
    asked, part = Fraction(aims.box), every_loop.part
    if part is None:
        yield f"--box asked for {percent(asked)} of each entry, and no box is proved"
    elif part < asked:
        yield f"--box asked for {percent(asked)} of each entry: {percent(part)} is proved"


def _box(every_loop: EveryLoop | None) -> tuple[Table, ...]:
    """The table of what is not proved of every loop in a box, if there is anything."""
    rows = () if every_loop is None else tuple(every_loop.rows())
    return (Table("plants near this one", (), rows),) if rows else ()


def _steps(longest: LongestStep | None) -> tuple[Table, ...]:
    """The table of the longest step, of whose proofs there is a sentence."""
    if longest is None:
        return ()
    title = "the controller at samples" if longest.held else "other times between samples"
    return (Table(title, (), (("longest step", longest.explain()),)),)


def _require_readable(design: Design, limits: Limits) -> None:
    """Stop where no command would read the controller, or check what is certified of it."""
    digits = int(design.controller.bit_length() * log10(2)) + 1
    if digits > limits.digits:
        other = " or choose gains in floating point (--arithmetic float)"
        raise LimitReached(
            f"the controller has numbers of about {digits} digits, and files with more than "
            f"{limits.digits} in a row are not read: allow them (--max-digits {digits + 1})"
            f"{other if design.arithmetic == 'exact' else ''}"
        )
