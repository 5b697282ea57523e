"""Options and work of all design commands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import log10
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import aiming, options

if TYPE_CHECKING:
    from mcexact.answer.protocol import Answer
    from mcexact.exact.rational import Limits
    from mcexact.exact.roots import StabilityRegion
    from mcexact.model.system import MultiChannelSystem
    from mcexact.report.text import Table
    from mcexact.synthesis.design import Design
    from mcexact.synthesis.robustness import EveryLoop

F = TypeVar("F", bound=Callable[..., Any])

HOW = ("rate", "radius", "arithmetic")
"""The options that are arguments of the functions of `mcexact.synthesis` with the same names."""


def design_options(
    spectrum_help: str,
    agent_help: str = "The agent with the channel controller of the theorem, which is then "
    "constructed without a search.",
    *,
    searches: bool = True,
) -> Callable[[F], F]:
    """Add the options of every design command, and those of a search if there is one."""
    given = (
        options.rate,
        options.radius,
        click.option("--spectrum", metavar="SPECTRUM", help=spectrum_help),
        options.arithmetic,
        click.option("--agent", metavar="NAME", help=agent_help),
        aiming.aims if searches else aiming.weights,
        click.option(
            "--box/--no-box",
            default=True,
            show_default=True,
            help="Search a part by which all entries of the plant may differ while every loop is "
            "stable, or prove it for the uncertainty of FILE, with the work of --effort or of five "
            "seconds; loops with more than 160 states, inputs and outputs are left out.",
        ),
        options.controller_output,
        options.page("figures of the loop and all certificates"),
        options.answering,
    )

    def decorate(function: F) -> F:
        for option in reversed(given):
            function = option(function)
        return function

    return decorate


def answer(name: str, file: str, given: dict[str, Any], wanted: Mapping[str, Any]) -> None:
    """Design in a child process, show the result, verify its certificates and write the files.

    Parameters
    ----------
    name : str
        The name of the command; the function of `mcexact.synthesis` is ``design_`` and this name.
    file : str
    given : dict
        The values of `design_options`.
    wanted : mapping
        Further keyword arguments of the function.
    """
    from mcexact.cli.files import (
        require_apart,
        require_other,
        require_page,
        require_writable,
        write_result,
    )
    from mcexact.cli.output import emit, emit_tables
    from mcexact.cli.rechecking import Rechecked
    from mcexact.cli.running import Run
    from mcexact.cli.spectra import read_spectrum
    from mcexact.errors import Impossible

    run, spectrum, weights = Run(given), given["spectrum"], given["weights"]
    output, html = given["output"], given["html"]
    require_other(output, file, spectrum, weights)
    require_writable(output, run.certificates)
    require_page(html, run.certificates, file, spectrum, weights)
    require_apart(output, html, run.certificates)
    extra = (
        None if spectrum is None else read_spectrum(spectrum, run),
        None if weights is None else run.read(weights),
    )
    keywords = {**wanted, "agent": given["agent"], **{key: given[key] for key in HOW}}
    aimed = {key: given[key] for key in aiming.AIMS if key in given}
    plant = run.read(file)
    done = run.result(
        _designed,
        *(name, plant, extra, run.limits, keywords, aimed, given["box"]),
        *(html is not None, run.system_by_digest),
        doing=f"designing for {plant[0]}",
        telling=True,
    )
    possible = "impossible" not in done

    def show() -> bool:
        if possible and output is None:
            click.echo("\n".join(f"mcexact: {line}" for line in done["said"]), err=True)
            emit(done["controller"])
        elif possible:
            emit("\n".join(done["said"]) + "\n\n")
            emit_tables(done["tables"])
        return possible and output is not None

    def write(checked: Rechecked) -> None:
        if possible and output is not None:
            write_result(output, done["controller"])
        if possible and html is not None:
            write_result(html, done["page"].rendered(done["certificates"], checked.verdicts))

    checked = run.conclude(done, show, about=f"the design for {plant[0]}", write=write)
    if not possible and checked.missing is not None and not run.as_json:
        click.echo(f"mcexact: {done['impossible']}", err=True)
    checked.require_complete()
    if not possible:
        raise Impossible(f"{done['impossible']}{done['advice']}")


def _advice(
    name: str, file: str, proof: Answer, system: MultiChannelSystem, region: StabilityRegion
) -> str:
    """What to ask where agents that share nothing have no controller, and all together may.

    Over the links that the plant has a controller may exist, which then is what is named.
    """
    from mcexact.analysis.fixed_modes import fixed_spectrum
    from mcexact.answer.modes import FixedSpectrum
    from mcexact.derived.constructions import augmented_outputs
    from mcexact.exact.rational import written

    if name != "decentralized" or not isinstance(proof, FixedSpectrum):
        return ""
    if all(len(factor.channels) in (0, system.m) for factor in proof.factors):
        return ""
    links = "links between agents change"
    if system.neighbors is not None and system.neighbors.edges():
        left = fixed_spectrum(augmented_outputs(system)).factors
        if all(region.contains_roots_of(factor.polynomial) for factor in left):
            asked = "" if region.bound is None else f" --{region.word} {written(region.bound)}"
            command = f"mcexact design extended {file}{asked}"
            return f"; over the links of this plant, `{command}` designs one"
        links = "more links between agents change"
    return f"; `mcexact allocate {file} --links` says whether {links} this"


def _designed(
    name: str,
    plant: tuple[str, bytes],
    extra: tuple[tuple[str, bytes] | None, ...],
    limits: dict[str, int],
    wanted: dict[str, Any],
    aimed: dict[str, Any],
    with_box: bool,
    with_page: bool,
    system_by_digest: bool,
    tell: Callable[[str], None],
) -> dict[str, Any]:
    """Design and format the result, in the child process."""
    import mcexact
    from mcexact.answer.account import Account
    from mcexact.answer.sentence import Given, Sentences
    from mcexact.answer.templates import Sentence
    from mcexact.cli.assessing import assessed
    from mcexact.cli.files import system_in
    from mcexact.cli.running import told
    from mcexact.errors import Impossible, InputError
    from mcexact.exact.rational import Limits
    from mcexact.exact.roots import StabilityRegion
    from mcexact.model.controller import controller_text
    from mcexact.model.text import parse
    from mcexact.report.text import measured, tables
    from mcexact.synthesis.assessment import assess
    from mcexact.synthesis.gate import Warned
    from mcexact.synthesis.optimum.figures import Aims
    from mcexact.synthesis.state_feedback import require_numbers

    def progress(step: str) -> None:
        if isinstance(step, Warned):
            tell(step)

    (prescribed, weights), spectrum = extra, None
    system = system_in(*plant, limits)
    weighed = aiming.read_weights(weights, limits)
    aims = aiming.aims_of(aimed, weighed) if aimed else Aims(weights=weighed)
    if aimed:
        wanted["aims"] = aims
    try:
        if prescribed is not None:
            spectrum = parse(prescribed[1], Limits(**limits))
            require_numbers(spectrum)
        found = getattr(mcexact, f"design_{name}")(
            system, spectrum=spectrum, progress=progress, **wanted
        )
    except InputError as error:
        place = next((each[0] for each in extra if each is not None), plant[0])
        raise error.within(place) from None
    except Impossible as refused:
        reason, proof = refused.message, refused.certificate
        region = StabilityRegion.of(system.time, wanted["rate"], wanted["radius"])
        said = Sentences([reason] if isinstance(reason, Sentence) else [])
        account = Account({proof.kind: proof}, Given(system), said)
        return told(account, system_by_digest) | {
            "impossible": str(refused),
            "advice": _advice(name, plant[0], proof, system, region),
            "json": account.as_json(design=name, possible=False, reason=reason),
        }
    _require_readable(found, Limits(**limits))
    around = None
    if with_box and found.stable:
        around = found.every_loop(**({"effort": aims.effort} if aims.effort else {}))
    account, assessment = found.account_with(around), assess(found, aims, around)
    figures = measured(
        found.measures(), assessment.rows(), account.sentences, found.region.discrete
    )
    return (
        told(account, system_by_digest)
        | assessed(
            account,
            assessment,
            found.loop.closed,
            (*tables(account.sentences), *_box(around), figures),
            with_page,
        )
        | {
            "controller": controller_text(found.controller),
            "json": account.as_json(
                **found.to_dict(),
                **({} if around is None else {"every_loop": around.to_dict()}),
                assessment=assessment.to_dict(),
            ),
        }
    )


def _box(around: EveryLoop | None) -> tuple[Table, ...]:
    """What is not proved of every loop in a box, as a table."""
    from mcexact.report.text import Table

    rows = () if around is None else tuple(around.rows())
    return (Table("plants near this one", (), rows),) if rows else ()


def _require_readable(found: Design, limits: Limits) -> None:
    """Stop where no command would read the controller, or check what is certified of it."""
    from mcexact.errors import LimitReached

    digits = int(found.controller.bit_length() * log10(2)) + 1
    if digits > limits.digits:
        other = " or choose gains in floating point (--arithmetic float)"
        raise LimitReached(
            f"the controller has numbers of about {digits} digits, and files with more than "
            f"{limits.digits} in a row are not read: allow them (--max-digits {digits + 1})"
            f"{other if found.arithmetic == 'exact' else ''}"
        )
