"""What design, certify and simulate do with periodic controllers, in their child processes.

A loop whose programs repeat after some steps has no spectrum of one step, and no costs or margins
are known of it.  So most options say nothing about such a controller: `require_only` refuses them
in one message.  What is proved is where the eigenvalues of the loop over one period lie.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import Any

from mcexact.answer.account import Account
from mcexact.answer.sentence import Context, Sentences
from mcexact.answer.time_varying import PERIODIC_SLOW
from mcexact.cli import parts
from mcexact.cli.results import Evidence, Loop, Refused, Simulated, loop_document
from mcexact.derived.modulo import states_of_rest
from mcexact.errors import Impossible, InputError, UsageError
from mcexact.exact.rational import Limits
from mcexact.exact.roots import StabilityRegion
from mcexact.model.periodic import periodic_text, read_periodic_controller
from mcexact.model.system import MultiChannelSystem
from mcexact.report.simulation import SimulationReport
from mcexact.report.text import tables
from mcexact.simulation.envelope import SimulatedLoop
from mcexact.simulation.periodic import simulate_periodic
from mcexact.synthesis.periodic import account_of_period, certify_periodic, design_periodic

_UNKNOWN = "costs, margins and peaks of loops with periodic controllers are not known"
_SPELLED = {"limited": "limits", "late": "step", "ranges": "range"}
"""Options of another name than their value."""


def require_only(given: Mapping[str, Any], taken: Collection[str]) -> None:
    """Stop if an option is given that says nothing about periodic controllers.

    Parameters
    ----------
    given : mapping
        The values of options by name; those that are not given are None, False or empty.
    taken : collection of str
        The options that it has.

    Raises
    ------
    UsageError
    """
    others = sorted(name for name, value in given.items() if value and name not in taken)
    if others:
        listed = ", ".join(f"--{_SPELLED.get(name, name).replace('_', '-')}" for name in others)
        raise UsageError(
            "of a periodic controller only stability and a radius are decided, and it is run "
            f"without set-points in the ideal loop: leave out {listed}"
        )


def designed(
    plant: tuple[str, bytes],
    system: MultiChannelSystem,
    radius: Any,
    longest: int | None,
    system_by_digest: bool,
    tell: Callable[[str], None],
) -> Loop | Refused:
    """Design a periodic controller, and format the result.

    Parameters
    ----------
    plant : tuple of str and bytes
        The file, for messages.
    system : MultiChannelSystem
        The plant, or what was made of it.
    radius : rational or None
    longest : int or None
        The longest period that is tried.
    system_by_digest : bool
    tell : callable
        Takes the progress.
    """
    more = {} if longest is None else {"longest": longest}
    try:
        with InputError.inside(plant[0]):
            design = design_periodic(system, radius=radius, progress=tell, **more)
    except Impossible as refused:
        proof = refused.certificate
        account = Account({proof.kind: proof}, Context(system), Sentences([]))
        return Refused(
            evidence=Evidence.of(account, system_by_digest),
            document=account.as_json(design="periodic", possible=False, reason=str(refused)),
            reason=str(refused),
            advice=f"; `mcexact analyze {plant[0]}` proves that these modes stay",
        )
    account = design.account
    lines = [*account.sentences.at("answer"), *(f"note: {each}" for each in design.notes)]
    return Loop(
        Evidence.of(account, system_by_digest),
        account.as_json(design="periodic", **design.to_dict(), first_line=str(lines[0])),
        tables(account.sentences, note=account.reading),
        None,
        [*lines, f"note: {_UNKNOWN}"],
        periodic_text(design.controller),
    )


def certified(
    system: MultiChannelSystem,
    program: tuple[str, bytes],
    limits: Mapping[str, int],
    radius: Any,
    with_page: bool,
    system_by_digest: bool,
) -> Loop:
    """Decide about the loop of a periodic controller over one period, and format the answer.

    Raises
    ------
    InputError
        If the file is malformed, or the controller does not fit the plant.
    UsageError
        If a page is asked for, or the plant is in continuous time.
    """
    require_only({"html": with_page}, ())
    region = StabilityRegion.of(system.time, None, radius)
    with InputError.inside(program[0]):
        controller = read_periodic_controller(program[1], Limits(**limits))
        verdict = certify_periodic(system, controller, radius=radius)
    account = account_of_period(verdict, controller, region)
    decay = [each for each in account.sentences.at("table") if each.template is PERIODIC_SLOW]
    document = {
        **loop_document(verdict, controller.warnings_for(system)),
        "region": str(region),
        "bound": None if region.bound is None else str(region.bound),
        "period": controller.period,
    }
    lines = [each.line for each in account.sentences.at("answer") or decay]
    return Loop.without_figures(account, document, [*lines, f"note: {_UNKNOWN}"], system_by_digest)


_RUN_WITH = ("initial", "horizon", "disturbances", "arithmetic")
"""The options of `mcexact simulate` that a periodic controller has."""


def simulated(
    given: MultiChannelSystem,
    part: parts.Part,
    program: tuple[str, bytes],
    limits: Mapping[str, int],
    wanted: Mapping[str, Any],
    real: Mapping[str, Any],
    suffix: str,
    fractions: bool,
    system_by_digest: bool,
) -> Simulated:
    """Run a periodic controller, decide whether its loop is stable, and format the results."""
    require_only({**wanted, **real}, _RUN_WITH)
    if suffix == ".html":
        raise UsageError("a run of a periodic controller is written as .csv or .png, not as .html")
    system = parts.without(given, part, limits)
    with InputError.inside(program[0]):
        controller = read_periodic_controller(program[1], Limits(**limits))
        initial = wanted["initial"]
        if initial is not None:
            initial = initial * given.n if len(initial) == 1 else initial
            if system is not given and len(initial) == given.n:
                initial = states_of_rest(system, initial)
        options = {name: wanted[name] for name in _RUN_WITH if name != "initial"}
        run = simulate_periodic(system, controller, initial=initial, **options)
        verdict = certify_periodic(system, controller)
    account = account_of_period(verdict, controller, StabilityRegion(system.time))
    warnings = controller.warnings_for(system)
    done = SimulatedLoop(system.name or "simulation", run, None, None, warnings)
    report = SimulationReport(done, fractions)
    document = {**report.as_json(), "stable": verdict.stable, "period": controller.period}
    return Simulated(
        evidence=Evidence.of(account, system_by_digest),
        document=account.as_json(**document),
        tables=(
            *report.tables(),
            *tables(account.sentences, note=" ".join(map(str, account.sentences.at("answer")))),
        ),
        page=None,
        warnings=warnings,
        file=report.file(suffix),
    )
