"""The program mcexact-verified beside `mcexact check`: a second checker, made from its own proof.

The program is extracted from the proof of its own soundness (``verified/README.md``).  It verifies
what it can of certificates that the checker has found VALID, and may confirm them; it can make no
verdict better.  It prints the statement that it has proved, which has to be the one of the checker.
Where the program is missing, or of another version, nothing is confirmed.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from mcexact.checker.core.system import digest_of

NAME = "mcexact-verified"
VERSION = f"{NAME} 3"
"""What the program must say of itself: the version of what it prints and of the format it reads."""
SECONDS = 60.0
"""After this time, or that of the whole run, the program is stopped and has confirmed nothing."""
_LONGEST = 1e6
"""No process is waited for longer, in seconds: some longer times are errors of the system."""


@dataclass(frozen=True)
class Confirmation:
    """What the program says of one certificate.

    Attributes
    ----------
    verdict : str
        CONFIRMED, INVALID, MALFORMED, INCOMPLETE or ERROR; empty if it says nothing.
    message : str
        Why the certificate is not confirmed.
    """

    verdict: str = ""
    message: str = ""

    @property
    def confirmed(self) -> bool:
        """Whether the program has verified the whole claim, too."""
        return self.verdict == "CONFIRMED"

    @property
    def contradicts(self) -> bool:
        """Whether the two checkers disagree about a VALID certificate, so that one has a bug."""
        return self.verdict in ("INVALID", "MALFORMED", "ERROR")


@cache
def program() -> str | None:
    """The path of the program beside Python or on the search path, if it has the right version."""
    beside = Path(sys.executable).parent / NAME
    path = str(beside) if beside.is_file() else shutil.which(NAME)
    if path is None:
        return None
    try:
        asked = subprocess.run([path, "--version"], capture_output=True, timeout=10, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return path if asked.stdout.decode("ascii", "replace").strip() == VERSION else None


def confirmations(
    paths: Sequence[str], statements: Sequence[str], seconds: float | None = None
) -> list[Confirmation]:
    """What the program says of some files that were found VALID, with these statements."""
    path = program()
    run = None if path is None or not paths else _run([path], paths, seconds)
    if run is None:
        return [Confirmation() for _ in paths]
    lines = run.stdout.decode("ascii", "replace").splitlines()
    if len(lines) != len(paths):
        return [Confirmation("ERROR", "the program ended early") for _ in paths]
    return [_read(*each) for each in zip(lines, statements, strict=True)]


def _run(
    call: Sequence[str], files: Sequence[str], seconds: float | None
) -> subprocess.CompletedProcess[bytes] | None:
    """Run the program on files; None where it cannot be run, or not within the time."""
    named = [f"./{each}" if each.startswith("-") else each for each in files]  # no options
    limit = SECONDS if seconds is None else min(seconds, _LONGEST)
    try:
        return subprocess.run([*call, *named], capture_output=True, timeout=limit, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None


def _read(line: str, statement: str) -> Confirmation:
    """One line of the program about a file with this statement."""
    verdict, _, rest = line.partition(" ")
    if verdict != "CONFIRMED":
        return Confirmation(verdict, rest)
    if rest != f"{digest_of(statement)} {statement}":
        return Confirmation("ERROR", "it states something else")
    return Confirmation(verdict)


def rocq_file(certificate: str, seconds: float | None = None) -> str:
    """A file of Rocq whose theorem is the claim of a certificate, about its plant.

    Raises
    ------
    LookupError
        If the program is missing, takes too long or cannot verify this certificate; the text says
        which.
    """
    path = program()
    if path is None:
        raise LookupError(f"{NAME} is missing, or of another version: make verified")
    run = _run([path, "--rocq"], [certificate], seconds)
    if run is None:
        limit = SECONDS if seconds is None else seconds
        raise LookupError(f"{NAME} could not be run, or not within {limit:g} s")
    text = run.stdout.decode("ascii", "replace")
    if run.returncode:
        raise LookupError(f"{NAME} does not confirm this certificate: {text.strip()}")
    return text
