"""A limit on the memory of a process, and recognition of errors that it causes."""

from __future__ import annotations

import contextlib
import errno
import importlib
import re
import signal
from collections.abc import Iterator, Sequence

from mcexact.errors import InternalError, LimitReached, McexactError, UsageError

_MEBIBYTE = 1 << 20
# An unexpected error this close to the limit is attributed to the limit.
_NEAR = 16 * _MEBIBYTE
# Compiled libraries end by these signals without memory; OpenBLAS interrupts its own process.
_DEATHS = frozenset({signal.SIGABRT, signal.SIGSEGV, signal.SIGINT}) | {
    getattr(signal, name) for name in ("SIGBUS", "SIGILL", "SIGTRAP") if hasattr(signal, name)
}


class MemoryLimit:
    """A limit on the memory of this process, in force until it is lifted.

    Parameters
    ----------
    mebibytes : int
        The amount that may be added to the address space that the process occupies now.
    libraries : sequence of str
        Compiled libraries to load before the limit: if memory runs out while they load, they fail
        in ways that look like bugs, or wait forever.

    Raises
    ------
    UsageError
        If the platform does not limit memory.
    """

    def __init__(self, mebibytes: int, libraries: Sequence[str]) -> None:
        occupied = _kibibytes("VmSize") * 1024
        try:
            import resource

            resource.RLIMIT_AS  # noqa: B018 - not every platform has it
        except (ImportError, AttributeError):
            occupied = 0
        if not occupied:  # macOS has the limit and does not enforce it
            raise UsageError("this platform does not limit memory: leave out --max-memory")
        for name in libraries:
            importlib.import_module(name)
        if "numpy" in libraries:
            _claim_working_memory(libraries)
        self._resource = resource
        self._before = resource.getrlimit(resource.RLIMIT_AS)
        hard = self._before[1]
        limit = _kibibytes("VmSize") * 1024 + mebibytes * _MEBIBYTE  # with the libraries
        self._bytes = limit if hard == resource.RLIM_INFINITY else min(limit, hard)
        resource.setrlimit(resource.RLIMIT_AS, (self._bytes, hard))

    def lift(self) -> None:
        """Remove the limit, so that an error can be reported."""
        self._resource.setrlimit(self._resource.RLIMIT_AS, self._before)

    def explains(self, error: BaseException) -> bool:
        """Whether this limit caused an error, or one that led to it."""
        for cause in _causes(error):
            # These are the messages of a library that could not be mapped or initialized.
            missing = isinstance(cause, ModuleNotFoundError)
            if isinstance(cause, ImportError | SystemError) and not missing:
                return True
        intended = isinstance(error, McexactError) and not isinstance(error, InternalError)
        return not intended and _kibibytes("VmPeak") * 1024 > self._bytes - _NEAR


def ran_out(error: BaseException) -> bool:
    """Whether an error, or one that led to it, reports that memory ran out."""
    return any(
        isinstance(cause, MemoryError) or getattr(cause, "errno", None) == errno.ENOMEM
        for cause in _causes(error)
    )


def died_of_memory(exit_code: int | None, max_memory: int | None) -> bool:
    """Whether a process that ended without a message had too little memory.

    The operating system sends SIGKILL to a process that takes too much.  Under a limit, a library
    that gets no memory aborts or ends the process with a status of its own.
    """
    if exit_code is None:
        return False
    if exit_code == -getattr(signal, "SIGKILL", 9):
        return True
    return max_memory is not None and (exit_code > 0 or -exit_code in _DEATHS)


def out_of_memory(doing: str, max_memory: int | None) -> LimitReached:
    """Return the error to raise when memory ran out."""
    if max_memory is None:
        return LimitReached(f"the memory was exhausted while {doing}; nothing has been decided")
    return LimitReached(
        f"the memory limit of {max_memory} MiB was exhausted while {doing}; "
        "nothing has been decided (--max-memory allows more)"
    )


def _claim_working_memory(libraries: Sequence[str]) -> None:
    """Multiply matrices once, so that OpenBLAS allocates buffers without which it waits forever."""
    import numpy as np

    M = np.ones((128, 128))
    _ = M @ M
    if "scipy.linalg" in libraries:
        from scipy.linalg import blas

        blas.dgemm(1.0, M, M)


def _causes(error: BaseException) -> Iterator[BaseException]:
    """Yield an error and those that led to it."""
    found: BaseException | None = error
    while found is not None:
        yield found
        found = found.__cause__ or found.__context__


def _kibibytes(name: str) -> int:
    """A size from the kernel's status of this process; 0 where the platform has none."""
    with contextlib.suppress(OSError), open("/proc/self/status", encoding="ascii") as status:
        found = re.search(rf"^{name}:\s*(\d+) kB$", status.read(), re.MULTILINE)
        return int(found[1]) if found else 0
    return 0
