"""`mcexact design` and its kinds: decentralized, extended, observer, setpoint.

The four commands differ in what they ask of `mcexact.synthesis`; their options (`design_options`)
and their work (`answer`) are the same: `mcexact.cli.designs.designed` designs in a child process,
the result is shown, its certificates are verified, and the files are written.  Where a limit ends
the child after it certified a controller, this one is the result, with what was proved of it by
then, and a note says what is left out.  `read_spectrum`
reads what ``--spectrum`` takes: numbers, JSON or the name of a file.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import click
from click.core import ParameterSource

from mcexact.cli import options, parts
from mcexact.cli.commands import Commands, GroupedCommand, Listed
from mcexact.cli.files import (
    emit_tables,
    require_apart,
    require_other,
    require_page,
    require_writable,
    write_result,
)
from mcexact.cli.output import emit
from mcexact.cli.results import DESIGNED, Loop, Refused
from mcexact.cli.running import Kept, Rechecked, Run, supervised
from mcexact.errors import Impossible, InputError, LimitReached
from mcexact.model.regulated import regulated_in


@click.group(
    name="design",
    cls=Commands,
    listed={
        "decentralized": Listed(
            "design:design_decentralized_command", "Design a controller without communication."
        ),
        "observer": Listed(
            "design:design_observer_command", "Design a distributed observer-based controller."
        ),
        "extended": Listed(
            "design:design_extended_command", "Design a controller with shared sub-states."
        ),
        "setpoint": Listed(
            "design:design_setpoint_command",
            "Design a controller that holds outputs at set-points.",
        ),
    },
    short_help="Design a controller and prove its closed loop.",
)
def design_command() -> None:
    """Design a linear time-invariant controller and certify its closed loop."""


F = TypeVar("F", bound=Callable[..., Any])

_SEARCHING = 0.5
"""The part of the time of --timeout after which a search ends."""
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
    every_option = (
        parts.option("Design for"),
        options.step,
        options.late,
        options.rate,
        options.radius,
        click.option("--spectrum", metavar="SPECTRUM", help=spectrum_help),
        options.arithmetic,
        click.option("--agent", metavar="NAME", help=agent_help),
        options.aims if searches else options.weighed,
        options.limited,
        options.no_box,
        options.prove_all,
        options.controller_output,
        options.page("figures of the loop and all certificates"),
        options.answering,
    )

    def decorate(function: F) -> F:
        for option in reversed(every_option):
            function = option(function)
        return function

    return decorate


def answer(name: str, file: str, values: dict[str, Any], wanted: Mapping[str, Any]) -> None:
    """Design in a child process, show the result, verify its certificates and write the files.

    Parameters
    ----------
    name : str
        The name of the command; the function of `mcexact.synthesis` is ``design_`` and this name.
    file : str
    values : dict
        The values of `design_options`.
    wanted : mapping
        Further keyword arguments of the function.

    Raises
    ------
    Impossible
        If no controller of this form exists, which a certificate proves.
    """
    run, spectrum, weights = Run(values), values["spectrum"], values["weights"]
    sizes = values["sizes"]
    output, html = values["output"], values["html"]
    inputs = file, spectrum, weights, sizes, parts.file_of(values)
    require_other(output, *inputs)
    require_writable(output, run.certificates)
    require_page(html, run.certificates, *inputs)
    require_apart(output, html, run.certificates)
    extra = (
        None if spectrum is None else read_spectrum(spectrum, run),
        None if weights is None else run.read(weights),
        None if sizes is None else run.read(sizes),
    )
    sampling, limited = options.sampling(values), values["limited"]
    part = parts.taken(values, run)
    if part is not None and sampling:
        raise click.UsageError(parts.NOT_SAMPLED)
    keywords = {**wanted, "agent": values["agent"], **{key: values[key] for key in HOW}}
    aimed = {key: values[key] for key in options.AIMS if key in values}
    left = run.deadline.left()
    if aimed and left is not None:
        # The best controller so far is certified in the rest of the time.
        aimed["seconds"] = _SEARCHING * left
    plant, kept = run.read(file), Kept()
    result: Loop | Refused
    try:
        result = supervised(
            _designed,
            *(name, plant, *extra, limited, run.limits, sampling, part, keywords, aimed),
            *(not values["no_box"], values["prove_all"]),
            *(html is not None, run.system_by_digest, left),
            doing=f"designing for {plant[0]}",
            timeout=run.deadline,
            max_memory=run.max_memory,
            telling=True,
            kept=kept,
        )
    except LimitReached:
        if DESIGNED not in kept.parts:
            raise
        result = kept.parts[DESIGNED]

    def show() -> bool:
        if isinstance(result, Refused):
            return False
        if output is None:
            click.echo("\n".join(f"mcexact: {line}" for line in result.verdict), err=True)
            emit(result.controller)
            return False
        emit("\n".join(result.verdict) + "\n\n")
        emit_tables(result.tables)
        return True

    def write(checked: Rechecked) -> None:
        if isinstance(result, Refused):
            return
        if output is not None:
            write_result(output, result.controller)
        if html is not None and result.page is not None:
            page = result.page.rendered(result.evidence.certificates, checked.verdicts)
            write_result(html, page)

    checked = run.conclude(result, show, about=f"the design for {plant[0]}", write=write)
    if isinstance(result, Refused):
        if checked.missing is not None and not run.as_json:
            click.echo(f"mcexact: {result.reason}", err=True)
        checked.require_complete()
        raise Impossible(f"{result.reason}{result.advice}")
    checked.require_complete()


def _designed(*arguments: Any, **messages: Any) -> Loop | Refused:
    """Design and format the result, in the child process."""
    # The child process alone loads what decides: the clock runs while it does, and Ctrl-C ends it.
    from mcexact.cli.designs import designed

    return designed(*arguments, **messages)


NUMBERS = "-1, -1+2i"
ROOTS = [-1, "-1+2i"]
PAIRS: list[Any] = ["-1", {"re": -1, "im": "2"}]
COEFFICIENTS = [5, 7, 3, 1]
_HEAD = (
    "Examples for --spectrum, as text or in a file; the numbers are as many as the\n"
    "degree, and a pair counts twice:"
)
_LIST = re.compile(r"[-+0-9./eEij,\s]*[0-9ij][-+0-9./eEij,\s]*", re.ASCII)


def spectrum_text(text: str) -> str | None:
    """Return the JSON of a spectrum that is written as text; None for the name of a file.

    Numbers are separated by commas, and may have blanks around signs.  A text that is the name of a
    file stands for this file, even if it looks like numbers.

    Examples
    --------
    >>> spectrum_text("-1 + 2i, -1 - 2i, -1/3")
    '["-1+2i", "-1-2i", "-1/3"]'
    >>> spectrum_text("[1, 2]"), spectrum_text("spectrum.json"), spectrum_text("-")
    ('[1, 2]', None, None)
    """
    if text.lstrip()[:1] in {"{", "["}:
        return text
    if not _LIST.fullmatch(text) or os.path.exists(text):
        return None
    return json.dumps([re.sub(r"\s*([-+])\s*", r"\1", each).strip() for each in text.split(",")])


def read_spectrum(value: str, run: Run) -> tuple[str, bytes]:
    """Return the name by which messages refer to a spectrum, and its JSON, from text or a file.

    Raises
    ------
    InputError
        If it is neither, or the file cannot be read.
    """
    text = spectrum_text(value)
    if text is None and value != "-" and not os.path.exists(value):
        raise InputError(
            f"expected numbers such as '-1+2i, -3', JSON, or the name of a file, found {value!a}",
            where="--spectrum",
        )
    return run.read(value) if text is None else ("--spectrum", text.encode())


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
    meaning_of_roots = "the root -1 and the pair -1 ± 2i"
    shown: list[tuple[dict[str, Any], str]] = [
        (
            dict.fromkeys(keys, ROOTS),
            meaning_of_roots if len(keys) > 1 else "the same as JSON",
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
        lines += [f"  '{NUMBERS}'", f"      {meaning_of_roots}"]
    for document, meaning in shown:
        lines += [f"  {json.dumps(document)}", f"      {meaning}"]
    return "\n".join(lines)


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
@click.option(
    "--periodic",
    is_flag=True,
    help="In discrete time, design a controller whose gains repeat after some steps, which moves "
    "fixed modes that no time-invariant one moves. It has a radius, and no figures.",
)
@click.option(
    "--longest-period",
    type=click.IntRange(min=2, max=100),
    metavar="N",
    help="With --periodic, the longest period that is tried; 6 by default.",
)
def design_decentralized_command(
    file: str, periodic: bool, longest_period: int | None, **values: Any
) -> None:
    """Design a decentralized controller for the system in FILE (- for standard input).

    Agent i computes u_i from y_i alone. Without --rate or --radius, a search minimizes the cost
    with disk margins of 0.4 in every single loop and a margin of 0.3 at all inputs together. The
    first line of the answer says whether to install the controller. A rate that no loop with these
    margins has is answered with the fastest one that was found. No linear time-invariant controller
    of this form moves the fixed modes, which remain if they are fast enough; if one is too slow,
    the status is 1 and a certificate proves that no such controller exists.
    """
    if not periodic:
        if longest_period is not None:
            raise click.UsageError("--longest-period is for --periodic: add it")
        answer("decentralized", file, values, {})
        return
    context = click.get_current_context()
    typed = ParameterSource.COMMANDLINE
    others = [
        option.opts[0]
        for option in context.command.params
        if option.name in _NOT_PERIODIC and context.get_parameter_source(option.name) is typed
    ]
    if others:
        raise click.UsageError(
            f"--periodic takes no {', '.join(others)}: costs, margins and peaks of loops with "
            "periodic controllers are not known"
        )
    answer("decentralized", file, values, {"longest": longest_period})


_NOT_PERIODIC = {
    *("rate", "spectrum", "arithmetic", "agent", "weights", "sizes", "limited"),
    *("prove_all", "html", *options.AIMS),
}
"""The options of a search, and those about figures, which a periodic controller does not have."""


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
    **values: Any,
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
    answer("extended", file, values, wanted)


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
def design_observer_command(file: str, order: str | None, **values: Any) -> None:
    """Design a distributed observer-based controller for the system in FILE (- for standard input).

    FILE needs a neighbor graph. Without a rate, a radius or a spectrum, half the sensible rate is
    taken. A spectrum has n numbers for the feedback and nm + m - 1 for the estimation errors. If no
    linear time-invariant controller of this form exists, the status is 1 and a certificate proves
    this.
    """
    answer("observer", file, values, {"order": order})


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
@click.option(
    "--regulate",
    multiple=True,
    metavar="AGENT[:OUTPUTS]",
    help="Hold these outputs of an agent alone, counted from 1, such as left:1,3; all of them if "
    "none is named. With one option for each agent that holds something. It replaces what the key "
    "regulated of FILE says.",
)
@click.option(
    "--signals",
    metavar="SIGNALS",
    help="Follow references, and reject disturbances, that are sums of these: step, ramp, "
    "sine:OMEGA in rad per unit of time, in discrete time cosine:C with the cosine of the angle "
    "per step, or poly:P for the solutions of a polynomial, such as poly:s^2+2 or poly:z^2-z+1; "
    "separated by commas. By default step.",
)
def design_setpoint_command(
    file: str,
    method: str | None,
    regulate: tuple[str, ...],
    signals: str | None,
    **values: Any,
) -> None:
    """Design a distributed controller that holds outputs of FILE at their agents' set-points.

    By default every output is held, or what the key regulated of FILE names. With --signals it
    follows ramps, sinusoids and other signals.

    Without a neighbor graph in FILE agents receive nothing. Without a rate, a radius or a spectrum,
    a search minimizes the cost, with margins. `mcexact simulate --reference` runs the controller
    with given set-points. If some set-points have no equilibrium, the status is 1 and a certificate
    gives their linear combinations.
    """
    answer(
        "setpoint",
        file,
        values,
        {"method": method, "regulate": regulated_in(regulate), "signals": signals},
    )
