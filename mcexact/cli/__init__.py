"""The command line: one module per command, each of them thin.

This package imports whatever it likes, but inside the commands only, so that ``--help`` is quick.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import click

from mcexact.cli.commands import Commands
from mcexact.cli.failures import exit_status, one_message


@click.group(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit status: 0 done, 1 a definite no, 2 wrong usage, 3 malformed or missing input, "
    "4 a limit was reached, 5 a certificate that this checker does not handle, 70 a bug here, "
    "130 interrupted.",
)
@click.version_option(package_name="mcexact")
def command_line() -> None:
    """Exact, certified answers about multi-channel linear systems.

    Which modes can no linear time-invariant decentralized controller move, which channels are to
    blame, and what sharing would free them? Start with `mcexact analyze plant.json`.
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its status.

    Parameters
    ----------
    arguments : sequence of str, optional
        ``sys.argv[1:]`` by default.

    Raises
    ------
    SystemExit
        Always.
    """
    # What is read is limited by its own grammar; what is printed may be longer.
    sys.set_int_max_str_digits(0)
    try:
        returned = command_line.main(arguments, prog_name="mcexact", standalone_mode=False)
        sys.exit(returned if isinstance(returned, int) else 0)
    except Exception as error:
        click.echo(one_message(error), err=True)
        sys.exit(exit_status(error))
    except KeyboardInterrupt:
        sys.exit(130)
