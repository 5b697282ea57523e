"""Options and work of all design commands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import click

from mcexact.cli import options

F = TypeVar("F", bound=Callable[..., Any])

HOW = ("rate", "radius", "arithmetic")
"""The options that are arguments of the functions of `mcexact.synthesis` with the same names."""


def design_options(
    spectrum_help: str,
    agent_help: str = "The agent with the channel controller; by default that of least order.",
) -> Callable[[F], F]:
    """Add the options of every design command."""
    given = (
        options.rate,
        options.radius,
        click.option("--spectrum", metavar="FILE", help=spectrum_help),
        options.arithmetic,
        click.option("--agent", metavar="NAME", help=agent_help),
        options.controller_output,
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
    from mcexact.cli.files import require_other, require_writable
    from mcexact.cli.output import emit, emit_tables
    from mcexact.cli.rechecking import Rechecked
    from mcexact.cli.running import Run
    from mcexact.errors import Impossible
    from mcexact.model.atomic import write_text

    run, spectrum = Run(given), given["spectrum"]
    require_other(given["output"], file, spectrum)
    require_writable(given["output"], run.certificates)
    prescribed = None if spectrum is None else run.read(spectrum)
    keywords = {**wanted, "agent": given["agent"], **{key: given[key] for key in HOW}}
    plant = run.read(file)
    done = run.result(
        _designed, name, plant, prescribed, run.limits, keywords, doing=f"designing for {plant[0]}"
    )
    output, possible = given["output"], "impossible" not in done

    def show() -> bool:
        if possible and output is None:
            emit(done["controller"])
        elif possible:
            emit_tables(done["tables"])
        return possible and output is not None

    def write(_: Rechecked) -> None:
        if possible and output is not None:
            write_text(output, done["controller"])

    checked = run.conclude(done, show, about=f"the design for {plant[0]}", write=write)
    if not possible and checked.missing is not None and not run.as_json:
        click.echo(f"mcexact: {done['impossible']}", err=True)
    checked.require_complete()
    if not possible:
        raise Impossible(done["impossible"])


def _designed(
    name: str,
    plant: tuple[str, bytes],
    prescribed: tuple[str, bytes] | None,
    limits: dict[str, int],
    wanted: dict[str, Any],
) -> dict[str, Any]:
    """Design and format the result, in the child process."""
    import mcexact
    from mcexact.answer.account import Account
    from mcexact.answer.sentence import Given, Sentences
    from mcexact.answer.template import Sentence
    from mcexact.cli.files import system_in
    from mcexact.cli.running import told
    from mcexact.errors import Impossible, InputError
    from mcexact.exact.rational import Limits
    from mcexact.model.controller_file import controller_text
    from mcexact.model.json_text import parse
    from mcexact.report.account import measured, tables
    from mcexact.synthesis.methods.spectrum import require_numbers

    spectrum = None
    system = system_in(*plant, limits)
    try:
        if prescribed is not None:
            spectrum = parse(prescribed[1], Limits(**limits))
            require_numbers(spectrum)
        found = getattr(mcexact, f"design_{name}")(system, spectrum=spectrum, **wanted)
    except InputError as error:
        raise error.within(prescribed[0] if prescribed is not None else plant[0]) from None
    except Impossible as refused:
        reason, proof = refused.message, refused.certificate
        said = Sentences([reason] if isinstance(reason, Sentence) else [])
        account = Account({proof.kind: proof}, Given(system), said)
        return told(account) | {
            "impossible": str(refused),
            "json": account.as_json(design=name, possible=False, reason=reason),
        }
    account = found.account
    figures = measured(found.measures(), account.sentences, found.region.discrete)
    return told(account) | {
        "controller": controller_text(found.controller),
        "json": account.as_json(**found.view()),
        "tables": (*tables(account.sentences), figures),
    }
