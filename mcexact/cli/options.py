"""Options of several commands, and the types of their values.

Values are parsed as exact numbers by the grammar of numbers in files (`rational`, `part`), and a
value that does not fit is a click.BadParameter, which names the option.  Options that always come
together are one decorator: `answering` for every command with certificates, `aims` for a search,
`draws` for drawn systems, `file_limits` and `work_limits`.  Every command imports this module, and
it loads none of the package besides errors, rational numbers and a constant of exports.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import click
from click.core import ParameterSource

from mcexact.errors import InputError
from mcexact.exact.rational import as_part, parse_rational
from mcexact.export import MOST_BITS

F = TypeVar("F", bound=Callable[..., Any])


def rational(text: str) -> Fraction:
    """Parse an exact number, in the grammar of numbers in files.

    Examples
    --------
    >>> rational("-1/2")
    Fraction(-1, 2)
    """
    try:
        return parse_rational(text)
    except InputError as error:
        raise click.BadParameter(error.message) from None


def part(text: str) -> Fraction:
    """Parse a part of something, as a number from 0 to 1 or as a percentage, which may be larger.

    Examples
    --------
    >>> part("0.1%"), part("1/50"), part("200%")
    (Fraction(1, 1000), Fraction(1, 50), Fraction(2, 1))
    """
    try:
        return as_part(text)
    except InputError as error:
        raise click.BadParameter(error.message) from None


def count(text: str) -> int:
    """Parse an integer that is written in digits alone; other texts raise a ValueError."""
    if not (text.isascii() and text.isdigit()):
        raise ValueError(text)
    return int(text)


def seconds(text: str) -> float:
    """Parse a time limit, a finite number of seconds above 0."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0 < number < float("inf"):
        raise click.BadParameter(f"expected a number of seconds above 0, found '{text}'")
    return number


FOLDER = click.Path(path_type=Path)

rate = click.option(
    "--rate", type=rational, help="In continuous time: every real part is below -RATE."
)

radius = click.option(
    "--radius", type=rational, help="In discrete time: every modulus is below RADIUS."
)

step = click.option(
    "--step",
    type=rational,
    metavar="TIME",
    help="Sample the plant in FILE, which is in continuous time, every TIME, with its inputs held.",
)

late = click.option(
    "--late",
    type=click.IntRange(min=0),
    metavar="STEPS",
    help="With --step: apply every input so many steps late, 0 by default; 1 if agents measure at "
    "a sample and set their inputs at the next one.",
)

uncertainty = click.option(
    "--uncertainty",
    type=part,
    metavar="PART",
    help="Also decide about every plant whose entries differ by at most this part of their moduli, "
    "such as 0.1% or 1/1000. It replaces the uncertainty that the file gives.",
)


def largest_uncertainty(searched: str) -> Callable[[F], F]:
    """Return the options for a search of the largest radii; ``searched`` says for what."""
    largest = click.option("--largest-uncertainty", is_flag=True, help=searched)
    effort = click.option(
        "--effort",
        type=seconds,
        default=10.0,
        show_default=True,
        metavar="SECONDS",
        help="With --largest-uncertainty: about how long to search; the work is counted and not "
        "timed.",
    )
    return lambda function: largest(effort(function))


def sampling(values: dict[str, Any]) -> dict[str, Any]:
    """Take --step and --late from the values of a command: how its plant is sampled, if it is."""
    step, late = values.pop("step"), values.pop("late")
    if step is None:
        if late is not None:
            raise click.UsageError("--late is for plants that are sampled: add --step")
        return {}
    return {"step": step, "late": late or 0}


def effort_of_search(values: dict[str, Any], *others: str) -> float | None:
    """Return the effort of the search of the largest radii in seconds; None without a search.

    Parameters
    ----------
    values : dict
        The values of all options of the command, from which those of the search are removed.
    others : str
        Further options that are for the search alone.

    Raises
    ------
    click.UsageError
        If the radii are prescribed as well, or an option of the search is given without it.
    """
    context, largest = click.get_current_context(), values.pop("largest_uncertainty")
    if largest and values["uncertainty"] is not None:
        raise click.UsageError("--largest-uncertainty searches the part: leave out --uncertainty")
    for name in ("effort", *others):
        typed = context.get_parameter_source(name) is ParameterSource.COMMANDLINE
        if typed and not largest:
            raise click.UsageError(
                f"--{name} is for --largest-uncertainty: add this, or leave it out"
            )
    effort = float(values.pop("effort"))
    return effort if largest else None


arithmetic = click.option(
    "--arithmetic",
    type=click.Choice(["exact", "float"]),
    default="exact",
    show_default=True,
    help="The arithmetic of the controllers of theorems: `exact` assigns the whole spectrum, for "
    "small systems; its gains can be very large. `float` meets a rate or radius. The proof is "
    "exact in both cases; searched gains, and those of `float`, depend on the processor.",
)

controller_output = click.option(
    "-o",
    "--output",
    type=FOLDER,
    metavar="FILE",
    help="Write the controller to this file; by default to standard output.",
)


def page(contents: str) -> Callable[[F], F]:
    """Return the option for a page, which has these contents besides what is printed."""
    return click.option(
        "--html",
        type=FOLDER,
        metavar="FILE",
        help=f"Write a report as an HTML page, with {contents}.",
    )


as_json = click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")

certificates = click.option(
    "--certificates",
    "certificates",
    type=FOLDER,
    metavar="DIR",
    help="Write a certificate of every answer into this directory.",
)

system_by_digest = click.option(
    "--system-by-digest",
    is_flag=True,
    help="Leave the system out of these files, which name it by its digest; `mcexact check` then "
    "needs the system file, too (--system).",
)


NETWORKS = ("swing-grid", "swing-hubs", "swing-speed", "platoon", "consensus", "building")
"""The kinds of networks, as in `mcexact.derived.drawn.networks`, which would import numpy."""


def file_limits(function: F) -> F:
    """Add the options that change the limits on input files.

    The command receives them as the keywords ``bytes``, ``depth``, ``digits`` and ``exponent``; see
    `set_limits`.  Only ``--help-all`` shows them.
    """
    function = click.option(
        "--help-all",
        is_flag=True,
        is_eager=True,
        expose_value=False,
        callback=_show_all,
        help="Show this message with the limits on input files.",
    )(function)
    for name, what in (
        ("exponent", "exponent of a decimal"),
        ("digits", "number of digits"),
        ("depth", "nesting"),
        ("bytes", "size of a file"),
    ):
        function = click.option(
            f"--max-{name}",
            name,
            type=click.IntRange(min=1, max=10**15),
            metavar="N",
            hidden=True,
            help=f"Largest {what} that is read.",
        )(function)
    return function


def _show_all(context: click.Context, _: click.Parameter, asked: bool) -> None:
    """Show the help of a command with its hidden options, and end."""
    if not asked or context.resilient_parsing:
        return
    for parameter in context.command.params:
        if isinstance(parameter, click.Option):
            parameter.hidden = False
    click.echo(context.get_help())
    context.exit()


def set_limits(limits: Mapping[str, int | None]) -> dict[str, int]:
    """Return the limits that are set, without those that are None."""
    return {name: limit for name, limit in limits.items() if limit is not None}


def work_limits(function: F) -> F:
    """Add the options that limit time and memory."""
    for option in (
        click.option(
            "--max-memory",
            type=click.IntRange(min=1),
            metavar="MIB",
            help="Limit on memory in MiB; if it is reached, the status is 4, and `analyze` goes on "
            "with the other questions.",
        ),
        click.option(
            "--timeout",
            type=seconds,
            metavar="SECONDS",
            help="Limit on time in seconds; if it is reached, the status is 4. `analyze` shows and "
            "re-checks what was decided by then, in a quarter of the time again (at least 5 s).",
        ),
    ):
        function = option(function)
    return function


def draws(function: F) -> F:
    """Add the options that describe drawn systems: the fields of a `Draw` except its seed."""
    for option in (
        click.option(
            "--neighbors", is_flag=True, help="Draw a strongly connected neighbor graph as well."
        ),
        click.option(
            "--time",
            type=click.Choice(["continuous", "discrete"]),
            default="continuous",
            show_default=True,
        ),
        click.option(
            "--network",
            type=click.Choice(NETWORKS),
            help="Draw the numbers of a large sparse plant of this kind: a power grid (agents "
            "measure angle and frequency, or the frequency alone), a platoon, consensus, or a "
            "building. Nothing else about it is prescribed.",
        ),
        click.option(
            "--plant-fixed-mode",
            "fixed_degree",
            type=click.IntRange(min=1),
            is_flag=False,
            flag_value=1,
            metavar="[DEGREE]",
            help="Plant a fixed mode: the roots of an irreducible factor of this degree, by "
            "default 1.",
        ),
        click.option(
            "--deficiency",
            type=click.IntRange(min=1),
            metavar="BOUND",
            help="Draw a plant over a strongly connected neighbor graph for which the bound of "
            "Theorem 2 on shared dimensions is this, with 3 channels or more; the number of "
            "states follows from it.",
        ),
        click.option("--channels", type=click.IntRange(min=1), default=2, show_default=True),
        click.option("--states", type=click.IntRange(min=0), default=4, show_default=True),
    ):
        function = option(function)
    return function


def answering(function: F) -> F:
    """Add the options of every command whose answers have certificates."""
    for add in (file_limits, work_limits, as_json, system_by_digest, certificates):
        function = add(function)
    return function


AIMS = (
    "margin", "disk", "box", "damping", "largest_modulus", "largest_gain", "largest_order",
    "most_digits",
    "effort", "seeds",
)  # fmt: skip
"""What a search aims at: the names of the options that `aims` adds."""


def number(text: str) -> float:
    """Parse a finite number of at least 0."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not (value >= 0 and isfinite(value)):
        raise click.BadParameter(f"expected a number of at least 0, found '{text}'")
    return value


weights = click.option(
    "--weights",
    metavar="FILE",
    help='JSON {"Q": rows, "R": rows, "W": rows, "V": rows}, or some of them: weights of states '
    "and inputs, and covariances of the noises of states and outputs; by default identities, and "
    "I/100 for V.",
)


sizes = click.option(
    "--sizes",
    metavar="FILE",
    help='JSON {"states": list, "inputs": {agent: list}, "errors": {agent: list}, '
    '"disturbances": r}, or some of them: typical sizes x and u and errors e of sensors, which '
    "replace those of the file; the weights are 1/x^2, 1/u^2, r x^2 and e^2.",
)


def limits(then: str) -> Callable[[F], F]:
    """Return the option of the limits of inputs; ``then`` says what the command does with them.

    Texts are read where the plant is known, by `mcexact.model.limits.limits_in`.
    """
    return click.option(
        "--limits",
        "limited",
        metavar="[AGENT:]LOW,HIGH",
        multiple=True,
        help="The least and the largest value of every input, such as --limits=-1,1, of those of "
        "an agent, such as left:-1,1, or of one of them, such as left[2]:-1,1, in place of the "
        f"limits in FILE. Repeatable. {then}",
    )


limited = limits(
    "Then a proof is sought that the loop is stable while inputs are cut off there; with it "
    "anti-windup gains are written into the controller, beside the limits."
)


def weighed(function: F) -> F:
    """Add the options of weights."""
    return weights(sizes(function))


no_box = click.option(
    "--no-box",
    is_flag=True,
    help="Search no part by which all entries of the plant may differ while every loop is stable, "
    "which is otherwise proved, or for the uncertainty of FILE, with the work of --effort or of "
    "five seconds; loops with more than 160 states, inputs and outputs are left out.",
)
prove_all = click.option(
    "--prove-all",
    is_flag=True,
    help="Prove costs and disk margins however large the certificates are; by default those beyond "
    "two megabytes, or some five seconds of checking, are left out and computed.",
)


damping = click.option(
    "--damping",
    type=rational,
    metavar="RATIO",
    help="Every eigenvalue has a damping ratio above RATIO; in discrete time a design aims at it, "
    "which is not certified.",
)

fastest = click.option(
    "--fastest",
    "largest_modulus",
    type=rational,
    metavar="MODULUS",
    help="In continuous time: every modulus is below MODULUS.",
)


def aims(function: F) -> F:
    """Add the options of a search, whose names are `AIMS`."""
    for option in (
        click.option(
            "--seeds",
            type=click.IntRange(min=1, max=1000),
            default=4,
            show_default=True,
            metavar="N",
            help="Drawn starts of each order.",
        ),
        click.option(
            "--effort",
            type=number,
            metavar="SECONDS",
            help="About how long a processor of 2024 may search for each rate that is tried, by "
            "counted work: half of it for a controller of least cost, the rest for margins that "
            "were missed, more starts, damping and a box. Proofs follow. 0 gives the controller "
            "of the theorem without a search.",
        ),
        click.option(
            "--digits",
            "most_digits",
            type=click.IntRange(min=1, max=17),
            metavar="N",
            help="Largest number of significant digits of a gain.",
        ),
        click.option(
            "--max-order",
            "largest_order",
            type=click.IntRange(min=0, max=1000),
            metavar="N",
            help="Largest number of states of each agent.",
        ),
        click.option(
            "--max-gain",
            "largest_gain",
            type=number,
            metavar="GAIN",
            help="Largest gain to aim at; by default ten times that of one controller for all.",
        ),
        fastest,
        damping,
        click.option(
            "--box",
            type=part,
            metavar="PART",
            help="Part of each entry by which plants may differ while every loop is stable, such "
            "as 2%, to aim at; without a rate by default 1% where it costs little.",
        ),
        click.option(
            "--disk",
            type=number,
            default=0.4,
            show_default=True,
            help="Disk margin of every single input and output to aim at.",
        ),
        click.option(
            "--margin",
            type=number,
            default=0.3,
            show_default=True,
            help="Margin of all of the plant's inputs together to aim at.",
        ),
        weights,
        sizes,
    ):
        function = option(function)
    return function


fixed_point = click.option(
    "--fixed-point",
    type=click.IntRange(min=0, max=MOST_BITS),
    metavar="BITS",
    help="Compute in integers of 32 bits, with every number of the controller rounded to this many "
    "fractional bits.",
)

ranges = click.option(
    "--range",
    "ranges",
    multiple=True,
    metavar="[KIND=]NUMBER",
    help="With --fixed-point: the largest modulus of all signals, by default 1000, or of one kind: "
    "y outputs, r set-points, u inputs, x shared and z private states, such as --range z=50. "
    "Repeatable.",
)


def ranges_of_signals(values: dict[str, Any]) -> dict[str, Fraction]:
    """Take the ranges of signals in fixed point from the values of a command, kind by kind."""
    found = dict[str, Fraction]()
    for text in values.pop("ranges"):
        kind, equals, number = text.rpartition("=")
        if equals and kind not in _KINDS:
            raise click.BadParameter(
                f"expected one of {', '.join(_KINDS)} before =, found '{kind}'",
                param_hint="--range",
            )
        found |= dict.fromkeys((kind,) if equals else _KINDS, rational(number))
    return found


_KINDS = ("y", "r", "u", "x", "z")


def parameter_value(text: str) -> tuple[str, Fraction]:
    """Parse ``NAME=VALUE`` with an exact number.

    Examples
    --------
    >>> parameter_value("t=1/3")
    ('t', Fraction(1, 3))
    """
    name, equals, value = text.partition("=")
    if not (name.strip() and equals and value.strip()):
        raise click.BadParameter(f"expected NAME=VALUE, such as t=1/3, found '{text}'")
    return name.strip(), rational(value.strip())


def at_values(use: str, more: str) -> Callable[[F], F]:
    """Return the option for values of parameters, whose help says their use, and more."""
    return click.option(
        "--at",
        type=parameter_value,
        multiple=True,
        metavar="NAME=VALUE",
        help=f"Of a system with parameters: {use}, such as t=1/3.  {more}",
    )
