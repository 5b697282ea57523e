"""A limit on the memory of a process, and how to tell that it was too little."""

from __future__ import annotations

import contextlib
import errno
import importlib
import re
import signal
from collections.abc import Iterator, Sequence

from mcexact.errors import InternalError, LimitReached, McexactError

_MEBIBYTE = 1 << 20
# An error that nobody raised on purpose this close to the limit is blamed on the limit.
_NEAR = 16 * _MEBIBYTE
# How compiled libraries die of too little memory; OpenBLAS interrupts its own process.
_DEATHS = frozenset({signal.SIGABRT, signal.SIGSEGV, signal.SIGINT}) | {
    getattr(signal, name) for name in ("SIGBUS", "SIGILL", "SIGTRAP") if hasattr(signal, name)
}


class MemoryLimit:
    """A limit that this process keeps until it is lifted.

    Parameters
    ----------
    mebibytes : int
        What may be added to the address space that the process occupies now.
    libraries : sequence of str
        Compiled libraries that are loaded before that: where memory is short they fail in ways that
        are hard to tell from bugs, or wait for ever.

    Raises
    ------
    McexactError
        If the platform has no such limit.
    """

    def __init__(self, mebibytes: int, libraries: Sequence[str]) -> None:
        try:
            import resource
        except ImportError:
            raise McexactError("this platform has no limit on memory") from None
        for name in libraries:
            importlib.import_module(name)
        if "numpy" in libraries:
            _claim_working_memory(libraries)
        self._resource = resource
        self._before = resource.getrlimit(resource.RLIMIT_AS)
        hard = self._before[1]
        limit = _kibibytes("VmSize") * 1024 + mebibytes * _MEBIBYTE
        self._bytes = limit if hard == resource.RLIM_INFINITY else min(limit, hard)
        resource.setrlimit(resource.RLIMIT_AS, (self._bytes, hard))

    def lift(self) -> None:
        """Take the limit away, so that what happened can be told."""
        self._resource.setrlimit(self._resource.RLIMIT_AS, self._before)

    def explains(self, error: BaseException) -> bool:
        """Whether an error, or one that led to it, comes from this limit."""
        for cause in _causes(error):
            # This is what a library says that could not be mapped or set up.
            missing = isinstance(cause, ModuleNotFoundError)
            if isinstance(cause, ImportError | SystemError) and not missing:
                return True
        intended = isinstance(error, McexactError) and not isinstance(error, InternalError)
        return not intended and _kibibytes("VmPeak") * 1024 > self._bytes - _NEAR


def ran_out(error: BaseException) -> bool:
    """Whether an error, or one that led to it, says that there is no more memory."""
    return any(
        isinstance(cause, MemoryError) or getattr(cause, "errno", None) == errno.ENOMEM
        for cause in _causes(error)
    )


def died_of_memory(exit_code: int | None, max_memory: int | None) -> bool:
    """Whether a process that ended without a word had too little memory.

    SIGKILL comes from the system, which ends what takes too much.  Under a limit a library that
    gets no memory aborts, or ends the process with a status of its own.
    """
    if exit_code is None:
        return False
    if exit_code == -getattr(signal, "SIGKILL", 9):
        return True
    return max_memory is not None and (exit_code > 0 or -exit_code in _DEATHS)


def out_of_memory(doing: str, max_memory: int | None) -> LimitReached:
    """What to say when memory was not enough."""
    if max_memory is None:
        return LimitReached(f"the memory was exhausted while {doing}; nothing has been decided")
    return LimitReached(
        f"the memory limit of {max_memory} MiB was exhausted while {doing}; "
        "nothing has been decided (--max-memory allows more)"
    )


def _claim_working_memory(libraries: Sequence[str]) -> None:
    """Multiply matrices once: OpenBLAS then has the buffers without which it waits for ever."""
    import numpy as np

    M = np.ones((128, 128))
    _ = M @ M
    if "scipy.linalg" in libraries:
        from scipy.linalg import blas

        blas.dgemm(1.0, M, M)


def _causes(error: BaseException) -> Iterator[BaseException]:
    """An error and those that led to it."""
    found: BaseException | None = error
    while found is not None:
        yield found
        found = found.__cause__ or found.__context__


def _kibibytes(name: str) -> int:
    """A size from the kernel's account of this process; 0 where there is none."""
    with contextlib.suppress(OSError), open("/proc/self/status", encoding="ascii") as status:
        found = re.search(rf"^{name}:\s*(\d+) kB$", status.read(), re.MULTILINE)
        return int(found[1]) if found else 0
    return 0
