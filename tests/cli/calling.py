"""The command line in this process."""

import contextlib
import io

import pytest

from mcexact.cli import main
from tests.end_to_end.command_line import without_notes


def call(*arguments: str) -> tuple[int, str, str]:
    """Run the command line: status, standard output, standard error without notes."""
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        pytest.raises(SystemExit) as ended,
    ):
        main(arguments)
    code = ended.value.code
    return int(code or 0), out.getvalue(), without_notes(err.getvalue())
