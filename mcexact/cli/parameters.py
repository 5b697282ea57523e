"""Systems with parameters on the command line: values, and the answers for all values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import options

if TYPE_CHECKING:
    from mcexact.cli.running import Known
    from mcexact.cli.supervision import Reporting
    from mcexact.model.parametric import ParametricSystem

F = TypeVar("F", bound=Callable[..., Any])


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
    return name.strip(), options.rational(value.strip())


def at_values(use: str, more: str) -> Callable[[F], F]:
    """Return the option for values of parameters, whose help says their use, and more."""
    return click.option(
        "--at",
        type=parameter_value,
        multiple=True,
        metavar="NAME=VALUE",
        help=f"Of a system with parameters: {use}, such as t=1/3.  {more}",
    )


def for_all_values(
    system: ParametricSystem,
    also: Sequence[str],
    channel: str | None,
    refused: bool,
    with_page: bool,
    with_latex: bool,
    system_by_digest: bool,
    *,
    known: Known,
    report: Reporting,
) -> dict[str, Any]:
    """Decide and format the answers for all values, in the child process.

    Parameters
    ----------
    system : ParametricSystem
    also : sequence of str
        Questions that are asked as well.
    channel : str or None
    refused : bool
        Whether something is asked that is only decided for systems without parameters.
    with_page, with_latex, system_by_digest : bool
    known : Known
    report : Reporting

    Raises
    ------
    UsageError
        If something else is asked.
    """
    from dataclasses import replace

    from mcexact.analysis.analyze import ParametricAnalysis
    from mcexact.cli.effort import effort_tables
    from mcexact.errors import UsageError
    from mcexact.report.pages import parameter_latex, parameter_page, parameter_tables
    from mcexact.report.text import WIDTH, wrapped

    if refused or not ParametricAnalysis.questions.keys() >= {*also}:
        raise UsageError(
            "these questions are about systems without parameters: give values to "
            f"{', '.join(system.parameters)} by --at NAME=VALUE"
        )
    found = ParametricAnalysis(system, channel=channel)
    found.also(also)
    known.resume(found, report)
    account, taken = found.account, effort_tables(found.effort())
    page = parameter_page(account) if with_page else None
    if page is not None:
        page = replace(page, tables=(*page.tables, *taken))
    words = [line for said in account.at("answer") for line in wrapped(said, WIDTH)]
    return {
        "certificates": account.certificates,
        "files": account.files(system_by_digest=system_by_digest),
        "plant": account.about,
        "json": found.to_dict(),
        "words": "\n".join(words) + "\n",
        "tables": (*parameter_tables(account), *taken),
        "latex": parameter_latex(account) if with_latex else "",
        "page": page,
        "ended": found.ended(),
    }
