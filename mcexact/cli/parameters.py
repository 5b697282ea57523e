"""Systems with parameters on the command line: values, and the answers for all values."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import options

if TYPE_CHECKING:
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
    asked: bool,
    with_page: bool,
    with_latex: bool,
    system_by_digest: bool,
) -> dict[str, Any]:
    """Decide and format the answers for all values, in the child process.

    Parameters
    ----------
    system : ParametricSystem
    asked : bool
        Whether something is asked that is only decided for systems without parameters.
    with_page, with_latex, system_by_digest : bool

    Raises
    ------
    UsageError
        If something else is asked.
    """
    from mcexact.analysis.parametric_analysis import parametric_analysis
    from mcexact.answer import codec
    from mcexact.errors import UsageError
    from mcexact.model.system_file import canonical_text
    from mcexact.report.parameters import parameter_latex, parameter_page, parameter_tables
    from mcexact.report.text import WIDTH, wrapped

    if asked:
        raise UsageError(
            "these questions are about systems without parameters: give values to "
            f"{', '.join(system.parameters)} by --at NAME=VALUE"
        )
    found = parametric_analysis(system)
    certificates = {f"{name}.json": each for name, each in found.certificates.items()}
    return {
        "certificates": {name: codec.encode(each) for name, each in certificates.items()},
        "files": {
            name: codec.encode(each, system_by_digest=system_by_digest)
            for name, each in certificates.items()
        },
        "plant": {name: canonical_text(each.about) for name, each in certificates.items()},
        "json": found.to_dict(),
        "words": "".join(f"{line}\n" for said in found.sentences for line in wrapped(said, WIDTH)),
        "tables": parameter_tables(found),
        "latex": parameter_latex(found) if with_latex else "",
        "page": parameter_page(found) if with_page else None,
    }
