"""The floating-point kernels that this processor can run, and environments that select them.

numpy and scipy carry an OpenBLAS that chooses its kernel by processor, and numpy's own loops choose
theirs: the same program rounds differently on different machines.  Each environment here stands for
such machines, and nothing that a test compares may depend on which one it runs in.  Run as a
program, it prints the environments, one a line, as `env` takes them.
"""

from __future__ import annotations

import os
import platform
import shlex
import subprocess
import sys
from collections.abc import Mapping
from functools import cache

# The names by which OPENBLAS_CORETYPE knows its kernels, those first that differ most.
_CANDIDATES = {
    "x86_64": (
        "Haswell",
        "Prescott",
        "SkylakeX",
        "Nehalem",
        "Sandybridge",
        "Zen",
        "Cooperlake",
        "SapphireRapids",
    ),
    "aarch64": ("ARMV8", "NEOVERSEN1", "NEOVERSEV1", "CORTEXA57"),
}
_CANDIDATES["AMD64"] = _CANDIDATES["x86_64"]
_CANDIDATES["arm64"] = _CANDIDATES["aarch64"]

_PROBE = """
import numpy as np
import scipy.linalg
from threadpoolctl import threadpool_info

A = np.arange(65 * 67).reshape(65, 67) % 19 - 9
assert np.array_equal(A.astype(float) @ A.T.astype(float), A @ A.T)
assert np.allclose(scipy.linalg.inv(A @ A.T + np.eye(65)) @ (A @ A.T + np.eye(65)), np.eye(65))
print(*sorted(info["architecture"] for info in threadpool_info() if "architecture" in info))
"""

_FEATURES = """
try:
    from numpy._core import _multiarray_umath as loops
except ImportError:  # numpy 1
    from numpy.core import _multiarray_umath as loops

print(*(name for name in loops.__cpu_dispatch__ if loops.__cpu_features__[name]))
"""


@cache
def usable_kernels() -> tuple[str, ...]:
    """The values of OPENBLAS_CORETYPE under which different kernels run here, and run rightly.

    Notes
    -----
    A process is started under each name that OpenBLAS knows for this family of processors.  It
    multiplies two matrices of integers, which every kernel does without rounding, inverts a third,
    and says by `threadpoolctl` which kernels it ran.  A name is usable if the process ends well.
    OpenBLAS answers a name that it does not have with the kernel it prefers, and gives some kernels
    under several names: of the names that ran the same kernels, only the first is kept.
    """
    ran: dict[str, str] = {}
    for name in _CANDIDATES.get(platform.machine(), ()):
        found = _printed(_PROBE, {"OPENBLAS_CORETYPE": name})
        if found and found not in ran.values():
            ran[name] = found
    return tuple(ran)


@cache
def numpy_features() -> tuple[str, ...]:
    """The instruction sets for which numpy has loops of its own here, to be switched off."""
    return tuple((_printed(_FEATURES, {}) or "").split())


def environments() -> tuple[Mapping[str, str], ...]:
    """What to add to the environment of a process: every kernel, numbers of threads, plain loops.

    Each usable kernel occurs with one thread and with four; the last environment leaves the kernel
    to OpenBLAS and switches off numpy's own loops for the processor at hand.
    """
    found: list[Mapping[str, str]] = [
        {"OPENBLAS_CORETYPE": kernel, "OPENBLAS_NUM_THREADS": threads}
        for kernel in usable_kernels()
        for threads in ("1", "4")
    ]
    if features := numpy_features():
        found.append({"NPY_DISABLE_CPU_FEATURES": " ".join(features)})
    return tuple(found)


def _printed(program: str, added: Mapping[str, str]) -> str | None:
    """What a Python program prints under an environment; None if it fails."""
    cleared = {"OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES"}
    kept = {name: value for name, value in os.environ.items() if name not in cleared}
    done = subprocess.run(
        [sys.executable, "-c", program], env=kept | dict(added), capture_output=True, text=True
    )
    return done.stdout.strip() if done.returncode == 0 else None


if __name__ == "__main__":
    for environment in environments():
        print(shlex.join(f"{name}={value}" for name, value in environment.items()))
