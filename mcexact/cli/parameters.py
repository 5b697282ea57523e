"""Systems with parameters on the command line: values, and the answers for all values."""

from __future__ import annotations

from fractions import Fraction

import click

from mcexact.cli import options


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
