"""A process that has imported the program once, and in which each run of it is a fork.

A fork is a process of its own, with its own streams, folder, environment and status.  It saves the
import of the libraries, which takes most of the time of a short command.

    python -m tests.end_to_end.prepared NUMBER

serves the client at the other end of the socket of this number, and ends with it.
"""

from __future__ import annotations

import atexit
import contextlib
import gc
import importlib
import json
import os
import runpy
import selectors
import socket
import subprocess
import sys
import time
import traceback
from collections.abc import Sequence
from functools import cache
from typing import ClassVar

from tests.effort import PATIENCE

LIBRARIES = ("flint", "networkx", "numpy", "scipy.linalg", "scipy.optimize", "sympy")
PACKAGE = (
    "mcexact.cli.running",
    "mcexact.model.files",
    "mcexact.synthesis.certify",
    "mcexact.synthesis.decentralized",
    "mcexact.synthesis.setpoint",
)
LONGEST = 1 << 20  # bytes of a message


class Prepared:
    """The client of such a process.

    Attributes
    ----------
    seconds : float
        What all runs took of the processor so far.
    """

    seconds: ClassVar[float] = 0.0

    def __init__(self) -> None:
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "tests.end_to_end.prepared", str(theirs.fileno())],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
            )
        atexit.register(self.end)

    def end(self) -> None:
        """End the process."""
        self._socket.close()
        self._process.wait()

    def run(
        self, module: str, arguments: Sequence[str], stdin: bytes
    ) -> subprocess.CompletedProcess[bytes]:
        """Run a module as a program, with few bytes to read, and wait for it."""
        pipes = [os.pipe() for _ in range(3)]
        (given, _), (_, out), (_, err) = pipes
        argv = [module, *arguments]
        what = {"argv": argv, "environment": dict(os.environ), "folder": os.getcwd()}
        socket.send_fds(self._socket, [json.dumps(what).encode()], [given, out, err])
        for each in (given, out, err):
            os.close(each)
        with contextlib.suppress(BrokenPipeError), open(pipes[0][1], "wb") as stream:
            stream.write(stdin)
        texts = _texts(pipes[1][0], pipes[2][0])
        ended = json.loads(self._socket.recv(LONGEST))
        Prepared.seconds += ended["seconds"]
        return subprocess.CompletedProcess(argv, ended["status"], *texts)


@cache
def prepared() -> Prepared:
    """The one that this process uses."""
    return Prepared()


def _texts(*streams: int) -> list[bytes]:
    """What is written to pipes until their ends are closed.

    Raises
    ------
    subprocess.TimeoutExpired
        If that does not happen.
    """
    texts = dict.fromkeys(streams, b"")
    until = time.monotonic() + PATIENCE
    with selectors.DefaultSelector() as selector:
        for stream in streams:
            selector.register(stream, selectors.EVENT_READ)
        while selector.get_map():
            if time.monotonic() > until:
                raise subprocess.TimeoutExpired("a prepared run", PATIENCE)
            for key, _ in selector.select(1.0):
                found = os.read(key.fd, 1 << 16)
                texts[key.fd] += found
                if not found:
                    selector.unregister(key.fd)
                    os.close(key.fd)
    return list(texts.values())


def serve(number: int) -> list[str] | None:
    """Fork for each request; the fork returns what it has to run, and the process None."""
    with socket.socket(fileno=number) as theirs:
        while True:
            data, streams, _, _ = socket.recv_fds(theirs, LONGEST, 3)
            if not data:
                return None
            what = json.loads(data)
            child = os.fork()
            if not child:
                break
            for each in streams:
                os.close(each)
            _, status, used = os.wait4(child, 0)
            ended = {
                "status": os.waitstatus_to_exitcode(status),
                "seconds": used.ru_utime + used.ru_stime,
            }
            theirs.send(json.dumps(ended).encode())
    for place, stream in enumerate(streams):
        os.dup2(stream, place)
        os.close(stream)
    os.environ.clear()
    os.environ.update(what["environment"])
    os.chdir(what["folder"])
    argv: list[str] = what["argv"]
    return argv


def status_of(argv: list[str]) -> int:
    """Run a module as a program, and return the status with which Python would end."""
    sys.argv = argv
    sys.modules.pop(argv[0], None)  # a program that starts anew is not imported yet
    try:
        runpy.run_module(argv[0], run_name="__main__", alter_sys=True)
    except SystemExit as ended:
        if not isinstance(ended.code, str):
            return ended.code or 0
        print(ended.code, file=sys.stderr)
        return 1
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    for name in (*LIBRARIES, *PACKAGE):
        importlib.import_module(name)
    gc.freeze()
    if (argv := serve(int(sys.argv[1]))) is not None:
        status = status_of(argv)
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        # Taking everything apart that was imported would copy all of its memory first.
        os._exit(status)
