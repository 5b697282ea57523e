"""Running the program as a user does: another process, its status, its output, what it used."""

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

MCEXACT = (sys.executable, "-m", "mcexact")
_MEASURED = Path(__file__).parent / "measured.py"


@dataclass(frozen=True)
class Run:
    """What one run of the program ended with and used."""

    status: int
    stdout: str
    stderr: str
    cpu_seconds: float
    mebibytes: float

    @property
    def messages(self) -> list[str]:
        """The lines on standard error, without those that say what takes long."""
        return [line for line in self.stderr.splitlines() if not line.endswith(" …")]


def run(
    *arguments: str,
    program: Sequence[str] = MCEXACT,
    stdin: bytes = b"",
    environment: Mapping[str, str] | None = None,
) -> Run:
    """Run the program and wait for it."""
    with tempfile.NamedTemporaryFile("r", encoding="ascii") as report:
        done = subprocess.run(
            [sys.executable, "-S", "-E", str(_MEASURED), report.name, *program, *arguments],
            input=stdin,
            capture_output=True,
            check=False,
            env={**os.environ, **(environment or {})},
        )
        cpu_seconds, mebibytes = map(float, report.read().split())
    return Run(done.returncode, done.stdout.decode(), done.stderr.decode(), cpu_seconds, mebibytes)


def interruptible() -> None:
    """In a child before it starts: let it hear interrupts, which a job in the background may not.

    Where a shell starts the tests with ``&``, they and their children are told to ignore SIGINT.
    """
    signal.signal(signal.SIGINT, signal.SIG_DFL)
