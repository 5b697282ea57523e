"""`mcexact design` and its kinds: decentralized, extended, observer, setpoint.

The four commands share their options (`design_options`) and their work (`answer`): design in a
child process, show the result, have the certificates verified, write the files.  `read_spectrum`
reads what ``--spectrum`` takes.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from math import log10
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import options
from mcexact.cli.commands import Commands, GroupedCommand

if TYPE_CHECKING:
    from mcexact.answer.account import Account
    from mcexact.answer.protocol import Answer
    from mcexact.cli.running import Run
    from mcexact.exact.rational import Limits
    from mcexact.exact.roots import StabilityRegion
    from mcexact.model.loop import ClosedLoop
    from mcexact.model.system import MultiChannelSystem
    from mcexact.report.html import EmbeddedPicture
    from mcexact.report.text import Table
    from mcexact.synthesis.assessment import Assessment
    from mcexact.synthesis.design import Design
    from mcexact.synthesis.robustness import EveryLoop


# `mcexact design`: the group of the design commands, each in its own module.


@click.group(
    name="design",
    cls=Commands,
    names={
        "decentralized": "mcexact.cli.design:design_decentralized_command",
        "observer": "mcexact.cli.design:design_observer_command",
        "extended": "mcexact.cli.design:design_extended_command",
        "setpoint": "mcexact.cli.design:design_setpoint_command",
    },
    short_help="Design a controller and prove its closed loop.",
)
def design_command() -> None:
    """Design a linear time-invariant controller and certify its closed loop."""


# Options and work of all design commands.

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
        options.aims if searches else options.weights,
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
        emit,
        emit_tables,
        require_apart,
        require_other,
        require_page,
        require_writable,
        write_result,
    )
    from mcexact.cli.running import Rechecked, Run
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
    aimed = {key: given[key] for key in options.AIMS if key in given}
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
    """Which command to try if no controller without communication exists, but others may.

    This is a design over the links of the plant, if sharing outputs over these leaves no fixed mode
    outside the region; otherwise a search of links to add.
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
    weighed = options.read_weights(weights, limits)
    aims = options.aims_of(aimed, weighed) if aimed else Aims(weights=weighed)
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


# What ``--spectrum`` takes: numbers, JSON or a file, with an example of each form for the help.

NUMBERS = "-1, -1+2i"
ROOTS = [-1, "-1+2i"]
PAIRS: list[Any] = ["-1", {"re": -1, "im": "2"}]
COEFFICIENTS = [5, 7, 3, 1]
_HEAD = (
    "Examples for --spectrum, as text or in a file; the numbers are as many as the\n"
    "degree, and a pair counts twice:"
)
_LIST = re.compile(r"[-+0-9./eEij,\s]*[0-9ij][-+0-9./eEij,\s]*", re.ASCII)


def spectrum_text(given: str) -> str | None:
    """Return the JSON of a spectrum that is given as text; None for the name of a file.

    Numbers are separated by commas, and may have blanks around signs.  A file of the name that is
    given is read whatever its name is.

    Examples
    --------
    >>> spectrum_text("-1 + 2i, -1 - 2i, -1/3")
    '["-1+2i", "-1-2i", "-1/3"]'
    >>> spectrum_text("[1, 2]"), spectrum_text("spectrum.json"), spectrum_text("-")
    ('[1, 2]', None, None)
    """
    if given.lstrip()[:1] in {"{", "["}:
        return given
    if not _LIST.fullmatch(given) or os.path.exists(given):
        return None
    return json.dumps([re.sub(r"\s*([-+])\s*", r"\1", each).strip() for each in given.split(",")])


def read_spectrum(given: str, run: Run) -> tuple[str, bytes]:
    """Return the name by which messages refer to a spectrum, and its JSON, from text or a file.

    Raises
    ------
    InputError
        If it is neither, or the file cannot be read.
    """
    from mcexact.errors import InputError

    text = spectrum_text(given)
    if text is None and given != "-" and not os.path.exists(given):
        raise InputError(
            f"expected numbers such as '-1+2i, -3', JSON, or the name of a file, found {given!a}",
            where="--spectrum",
        )
    return run.read(given) if text is None else ("--spectrum", text.encode())


def spectrum_examples(*keys: str, parts: bool = False) -> str:
    """Return the end of a help text, with an example of each form.

    Parameters
    ----------
    *keys : str
        The keys of the document: ``"closed_loop"``, which may be left out, or ``"feedback"`` and
        ``"error"``.
    parts : bool
        Whether a spectrum can be given for each strong component.

    Examples
    --------
    >>> print(spectrum_examples("closed_loop").removeprefix("\\b\\n"))
    Examples for --spectrum, as text or in a file; the numbers are as many as the
    degree, and a pair counts twice:
      '-1, -1+2i'
          the root -1 and the pair -1 ± 2i
      {"closed_loop": [-1, "-1+2i"]}
          the same as JSON
      {"closed_loop": ["-1", {"re": -1, "im": "2"}]}
          the same; a fraction such as "-1/3" is a string
      {"closed_loop": [5, 7, 3, 1]}
          the same as coefficients, the constant term first: x^3 + 3x^2 + 7x + 5
    """
    told = "the root -1 and the pair -1 ± 2i"
    shown: list[tuple[dict[str, Any], str]] = [
        (
            dict.fromkeys(keys, ROOTS),
            told if len(keys) > 1 else "the same as JSON",
        ),
        (
            dict.fromkeys(keys, PAIRS),
            'the same; a fraction such as "-1/3" is a string',
        ),
        (
            dict.fromkeys(keys, COEFFICIENTS),
            "the same as coefficients, the constant term first: x^3 + 3x^2 + 7x + 5",
        ),
    ]
    if parts:
        each: Any = {"1": [-1, -2], "3": ["-1/2"]}
        shown.append(
            (
                dict.fromkeys(keys, each),
                "a list for each strong component of the transfer graph, by one of its agents",
            )
        )
    lines = ["\b", _HEAD]
    if len(keys) == 1:
        lines += [f"  '{NUMBERS}'", f"      {told}"]
    for document, meaning in shown:
        lines += [f"  {json.dumps(document)}", f"      {meaning}"]
    return "\n".join(lines)


# `mcexact design decentralized`: design a controller without communication.


@click.command(
    cls=GroupedCommand,
    name="decentralized",
    short_help="Design a controller without communication.",
    epilog=spectrum_examples("closed_loop", parts=True),
)
@click.argument("file")
@design_options(
    "Roots such as '-1+2i, -3', as text; or JSON {\"closed_loop\": P}, as text or a file, P a list "
    "of coefficients or of roots and pairs, or a mapping from one agent of each strong component "
    "of the transfer graph to such a list."
)
def design_decentralized_command(file: str, **given: Any) -> None:
    """Design a decentralized controller for the system in FILE (- for standard input).

    Agent i computes u_i from y_i alone. Without --rate or --radius, half the sensible rate is
    taken. The first line of the answer says whether to install the controller. No linear
    time-invariant controller of this form moves the fixed modes, which remain if they are fast
    enough; if one is too slow, the status is 1 and a certificate proves that no such controller
    exists.
    """
    answer("decentralized", file, given, {})


# `mcexact design extended`: design a controller with shared sub-states of least dimension.


@click.command(
    name="extended",
    cls=GroupedCommand,
    short_help="Design a controller with shared sub-states.",
    epilog=spectrum_examples("closed_loop"),
)
@click.argument("file")
@design_options(
    "Roots such as '-1+2i, -3', as text; or JSON {\"closed_loop\": P}, as text or a file, P a list "
    "of coefficients or of roots and pairs, without constraint."
)
@click.option(
    "--dimensions",
    default="minimal",
    show_default=True,
    metavar="WHICH",
    help="`minimal`, `bound` (Theorem 2's), or n_1,n_2,… in the order of the channels.",
)
@click.option(
    "--share",
    type=click.Choice(["outputs+states", "states"]),
    help="Signals that agents send; by default both, but with holding sub-states alone.",
)
@click.option(
    "--network",
    type=click.Choice(["extended", "lifted", "held"]),
    help="With delays: `lifted` (the mode 0 is fixed) or `held` (no mode is fixed). By default a "
    "search tries both and keeps the cheaper one; else it is `lifted`.",
)
@click.option(
    "--free",
    "free_assignability",
    is_flag=True,
    help="Share enough that the whole spectrum can be assigned without partition.",
)
def design_extended_command(
    file: str,
    dimensions: str,
    share: str | None,
    network: str | None,
    free_assignability: bool,
    **given: Any,
) -> None:
    """Design a distributed controller through the extended system of FILE (- for standard input).

    FILE needs a neighbor graph, and may have delays in discrete time. Agents share sub-states; the
    controller file says for how many steps agents hold them. If no shared dimensions suffice for
    linear time-invariant control, the status is 1.
    """
    sizes: str | list[int] = dimensions
    if dimensions not in ("minimal", "bound"):
        try:
            sizes = [options.count(part) for part in dimensions.split(",")]
        except ValueError:
            raise click.BadParameter(
                f"expected minimal, bound or integers >= 0 such as 0,0,1, found '{dimensions}'",
                param_hint="--dimensions",
            ) from None
    wanted = {
        "dimensions": sizes,
        "share": share,
        "network": network,
        "free_assignability": free_assignability,
    }
    answer("extended", file, given, wanted)


# `mcexact design observer`: design a distributed observer-based controller.


@click.command(
    cls=GroupedCommand,
    name="observer",
    short_help="Design a distributed observer-based controller.",
    epilog=spectrum_examples("feedback", "error"),
)
@click.argument("file")
@design_options(
    'JSON {"feedback": P, "error": P}, as text or a file, P a list of coefficients or of roots and '
    "pairs.",
    agent_help="The agent with the channel controller; by default the first, in floating point "
    "none where none is needed.",
    searches=False,
)
@click.option(
    "--order",
    type=click.Choice(["least", "low"]),
    help="`least`: the least order that one of the indices allows, instead of m - 1; in floating "
    "point an observer of reduced order. `low`: compare it with a controller of low order over the "
    "same links, whose agents do not estimate the whole state, and keep the better one.",
)
def design_observer_command(file: str, order: str | None, **given: Any) -> None:
    """Design a distributed observer-based controller for the system in FILE (- for standard input).

    FILE needs a neighbor graph. Without a rate, a radius or a spectrum, half the sensible rate is
    taken. A spectrum has n numbers for the feedback and nm + m - 1 for the estimation errors. If no
    linear time-invariant controller of this form exists, the status is 1 and a certificate proves
    this.
    """
    answer("observer", file, given, {"order": order})


# `mcexact design setpoint`: design a controller that holds every output at its set-point.


@click.command(
    cls=GroupedCommand,
    name="setpoint",
    short_help="Design a controller that holds outputs at set-points.",
    epilog=spectrum_examples("feedback", "error"),
)
@click.argument("file")
@design_options(
    'JSON for the plant with its integrators, as text or a file: {"feedback": P, "error": P}, or '
    '{"closed_loop": P} with --method extended.'
)
@click.option(
    "--method",
    type=click.Choice(["observer", "extended"]),
    help="Use a distributed observer, or shared sub-states; by default a controller of low order "
    "without communication if one exists, else with shared sub-states.",
)
def design_setpoint_command(file: str, method: str | None, **given: Any) -> None:
    """Design a distributed controller that holds every output of FILE at its agent's set-point.

    Without a neighbor graph in FILE agents receive nothing. Without a rate, a radius or a spectrum,
    half the sensible rate is taken. `mcexact simulate --reference` runs the controller with given
    set-points. If some set-points have no equilibrium, the status is 1 and a certificate gives
    their linear combinations.
    """
    answer("setpoint", file, given, {"method": method})


# The verdict, the tables and the page of an assessed controller.


def assessed(
    account: Account,
    found: Assessment,
    loop: ClosedLoop,
    tables: tuple[Table, ...],
    with_page: bool,
    pictures: tuple[EmbeddedPicture, ...] = (),
) -> dict[str, Any]:
    """Return the lines before the tables, the first of which is the verdict, and the page.

    What is certified of all loops near this one follows the verdict; ``pictures`` come first on the
    page.
    """
    # Help loads every command, and must not load flint with the templates.
    from mcexact.answer.loops import EVERY_LOOP, EVERY_LOOP_PART

    all_loops = (EVERY_LOOP, EVERY_LOOP_PART)
    said = [found.verdict, *(each.line for each in account.sentences if each.template in all_loops)]
    said += [f"warning: {each}" for each in found.warnings[1:]]
    said += [f"note: {each}" for each in found.notes]
    page = None
    if with_page:
        from mcexact.report.pages import loop_page
        from mcexact.synthesis.optimum.diagnosis import curves_of

        curves = curves_of(loop, found.region)
        page = loop_page(account, found.install, said, tables, curves, loop.controller)
        page = replace(page, pictures=(*pictures, *page.pictures))
    return {"said": said, "tables": tables, "page": page}
