"""The command line, with a module for each command or group of them.

`mcexact.cli.commands` lists the commands, so that ``--help`` loads none of them.  The module of a
command has its options and the work of this process: it reads, waits, prints and writes, and loads
no library that starts threads, because a process with threads cannot be forked.  What decides runs
in a child process (`mcexact.cli.running`), in a module that the child loads alone; between the two
go the types of `mcexact.cli.results`.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Sequence

import click

from mcexact.cli import output
from mcexact.cli.commands import Commands, exit_status, one_message
from mcexact.errors import NotWritten


@click.group(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit status: 0 done, 1 the answer is no, 2 wrong usage, 3 malformed or missing input, "
    "4 a limit was reached, 5 the checker cannot handle a certificate, 69 an optional library is "
    "missing, 70 a bug in mcexact, 74 the output cannot be written, 130 interrupted.",
)
@click.version_option(package_name="mcexact")
def command_line() -> None:
    """Exact, certified answers about multi-channel linear systems.

    Which modes can no linear time-invariant decentralized controller move, which channels cause
    that, and what must agents share so that a controller can move them? Start with `mcexact analyze
    plant.json`.
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
    # The readers limit the length of numbers themselves, and printed numbers may be longer.
    sys.set_int_max_str_digits(0)
    output.begin()
    try:
        # A limit on time counts from here on, also while the command is imported.
        start = time.monotonic()
        status = command_line.main(arguments, prog_name="mcexact", standalone_mode=False, obj=start)
        sys.exit(status if isinstance(status, int) else 0)
    except Exception as error:
        message, status = one_message(error), exit_status(error)
        _complain(message)
        _tell(message, status, sys.argv[1:] if arguments is None else arguments)
        sys.exit(status)
    except KeyboardInterrupt:
        sys.exit(130)


def _tell(message: str, status: int, arguments: Sequence[str]) -> None:
    """Print an error as a JSON document, where one is asked for and nothing was printed before."""
    if "--json" in arguments and not output.has_written():
        with contextlib.suppress(NotWritten):
            output.emit_json({"format": "mcexact-error/1", "status": status, "message": message})


def _complain(message: str) -> None:
    """Print a message on standard error, if that is possible: the status tells as much."""
    try:
        click.echo(message, err=True)
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())
