"""How long are the numbers of an exact distributed observer; how long do design and check take?

Run as ``python -m benchmarks.distributed_observer [STATES CHANNELS]…``, by default 2 2, 3 3, 4 4
and 6 5; plants are drawn with entries −2 … 2 over a ring, every eigenvalue of the errors is −1.
Prints, for each size: how many numbers were prescribed, the bits of the longest number in the
controller, the largest entry of the loop, the seconds of the design with its certificate, the
seconds of the check by a copy of the checker in a process of its own, and the largest real part of
an eigenvalue as numpy sees it (exactly, it is −1).
"""

from __future__ import annotations

import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mcexact.checker
from mcexact.answer.protocol import encode
from mcexact.exact.matrix import largest_entry, matrix_to_float
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.distributed_observer import design_observer


def drawn(n: int, m: int, seed: int = 5) -> MultiChannelSystem:
    """A plant with dense small entries and one input and one output for each channel."""
    rng = random.Random(seed)

    def entries(nrows: int, ncols: int) -> list[list[int]]:
        return [[rng.randint(-2, 2) for _ in range(ncols)] for _ in range(nrows)]

    return MultiChannelSystem(
        entries(n, n),
        [entries(n, 1) for _ in range(m)],
        [entries(1, n) for _ in range(m)],
        neighbors=NeighborGraph.ring([str(i + 1) for i in range(m)]),
    )


def checked(text: str) -> float:
    """Seconds that a copied-out checker takes to say VALID."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "checker"
        shutil.copytree(Path(mcexact.checker.__file__).parent, copy)
        file = Path(folder) / "certificate.json"
        file.write_text(text, encoding="ascii")
        began = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-S", "-E", "-m", "checker", file.name],
            cwd=folder,
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stdout.startswith("VALID"), done.stdout
        return time.perf_counter() - began


def measure(n: int, m: int) -> None:
    """Design, write, check, print one line."""
    import numpy as np

    system, degree = drawn(n, m), n * m + m - 1
    began = time.perf_counter()
    spectrum = {"feedback": [-1] * n, "error": [-1] * degree}
    design = design_observer(system, spectrum=spectrum)
    text = encode(design.loop.proof)
    designed = time.perf_counter() - began
    seen = np.linalg.eigvals(matrix_to_float(design.loop.matrix)).real.max()
    print(
        f"n={n} m={m}: {degree} numbers, {design.controller.bit_length()} bits, "
        f"entries up to {float(largest_entry([design.loop.matrix])):.1e}, "
        f"design {designed:.1f} s, "
        f"check {checked(text):.1f} s, certificate {len(text) // 1000} kB, "
        f"numpy's abscissa {seen:+.2g}"
    )


if __name__ == "__main__":
    sizes = [int(text) for text in sys.argv[1:]] or [2, 2, 3, 3, 4, 4, 6, 5]
    for n, m in zip(sizes[::2], sizes[1::2], strict=True):
        measure(n, m)
