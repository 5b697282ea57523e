"""Running the program as a user does: another process, its status, its output, what it used."""

import contextlib
import os
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

MCEXACT = (sys.executable, "-m", "mcexact")


@dataclass(frozen=True)
class Run:
    """What one run of the program ended with and used."""

    status: int
    stdout: str
    stderr: str
    cpu_seconds: float
    wall_seconds: float
    mebibytes: float


def run(
    *arguments: str,
    program: Sequence[str] = MCEXACT,
    stdin: bytes = b"",
    environment: Mapping[str, str] | None = None,
) -> Run:
    """Run the program and wait for it."""
    start = time.monotonic()
    with subprocess.Popen(
        [*program, *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "COLUMNS": "200", **(environment or {})},
    ) as process:
        # communicate() would reap the process and lose what it used.
        collected: dict[str, bytes] = {}

        def collect(name: str) -> None:
            stream = getattr(process, name)
            collected[name] = stream.read()

        readers = [threading.Thread(target=collect, args=(name,)) for name in ("stdout", "stderr")]
        for reader in readers:
            reader.start()
        if process.stdin is None:
            raise RuntimeError("no standard input")
        with contextlib.suppress(BrokenPipeError):
            process.stdin.write(stdin)
            process.stdin.close()
        _, wait_status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(wait_status)
        for reader in readers:
            reader.join()
    return Run(
        status=process.returncode,
        stdout=collected["stdout"].decode(),
        stderr=collected["stderr"].decode(),
        cpu_seconds=usage.ru_utime + usage.ru_stime,
        wall_seconds=time.monotonic() - start,
        mebibytes=usage.ru_maxrss / 1024,
    )
