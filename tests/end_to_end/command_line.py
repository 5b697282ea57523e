"""Running the program as a user does: another process, its status and its output."""

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tests.effort import PATIENCE
from tests.end_to_end.prepared import prepared

MCEXACT = (sys.executable, "-m", "mcexact")


@dataclass(frozen=True)
class Run:
    """What one run of the program ended with."""

    status: int
    stdout: str
    stderr: str

    @property
    def messages(self) -> list[str]:
        """The lines on standard error, without notes on the work and on files."""
        return without_notes(self.stderr).splitlines()


def run(
    *arguments: str,
    module: str = "mcexact",
    program: Sequence[str] = (),
    stdin: bytes = b"",
    environment: Mapping[str, str] | None = None,
) -> Run:
    """Run the program and wait for it.

    Parameters
    ----------
    *arguments : str
    module : str
        What is run, in a process that has imported the libraries before; if its memory is limited,
        in one that starts anew, since without memory OpenBLAS waits forever for some of it.
    program : sequence of str
        What is run instead, in a process that starts anew, as it does with another environment.
    stdin : bytes
    environment : mapping, optional
        Variables to set.
    """
    done: subprocess.CompletedProcess[bytes]
    anew = program or environment or "--max-memory" in arguments
    if anew or sys.platform != "linux":
        done = subprocess.run(
            [*(program or (sys.executable, "-m", module)), *arguments],
            input=stdin,
            capture_output=True,
            check=False,
            env={**os.environ, **(environment or {})},
            timeout=PATIENCE,
        )
    else:
        done = prepared().run(module, arguments, stdin)
    return Run(done.returncode, done.stdout.decode(), done.stderr.decode())


def without_notes(text: str) -> str:
    """What is on standard error without the lines that say what takes long, or what was written."""
    return "".join(
        line
        for line in text.splitlines(True)
        if not (line.endswith(" …\n") or line.startswith("mcexact: wrote "))
    )


def interruptible() -> None:
    """In a child before it starts: let it hear interrupts, which a job in the background may not.

    Where a shell starts the tests with ``&``, they and their children are told to ignore SIGINT.
    """
    signal.signal(signal.SIGINT, signal.SIG_DFL)
