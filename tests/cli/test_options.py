"""Option values: exact numbers, also negative ones, and limits."""

import click
import pytest
from click.testing import CliRunner

from mcexact.cli import options


@click.command()
@click.option("--shift", type=options.rational)
@click.option("--timeout", type=options.seconds)
@options.file_limits
def echo(shift: object, timeout: object, **limits: int | None) -> None:
    click.echo(f"{shift} {timeout} {options.set_limits(limits)}")


@pytest.mark.parametrize(
    ("arguments", "shown"),
    [
        (["--shift", "-1/2"], "-1/2 None {}"),
        (["--shift=-0.25"], "-1/4 None {}"),
        (["--shift", "-1e-3"], "-1/1000 None {}"),
        (["--timeout", "0.5"], "None 0.5 {}"),
        (["--max-digits", "5", "--max-depth", "3"], "None None {'digits': 5, 'depth': 3}"),
    ],
)
def test_a_value_is_taken_as_it_is_written(arguments: list[str], shown: str) -> None:
    assert CliRunner().invoke(echo, arguments).output == f"{shown}\n"


@pytest.mark.parametrize(
    "arguments",
    [
        ["--shift", "1 / 2"],
        ["--shift", "1e99999"],
        ["--shift", "foo"],
        ["--shift", "1/0"],
        ["--timeout", "inf"],
        ["--timeout", "-1"],
        ["--max-digits", "two"],
        ["--max-digits", "-1"],
        ["--max-digits", "9999999999999999999"],
    ],
)
def test_a_value_outside_the_grammar_is_wrong_usage(arguments: list[str]) -> None:
    result = CliRunner().invoke(echo, arguments)
    assert result.exit_code == 2
    assert f"Invalid value for '{arguments[0]}'" in result.output
