"""How long does ``mcexact --help`` take, beside the import of the library that prints it?"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

from benchmarks.fixed_spectrum import Row
from benchmarks.measure import interleaved


def rows() -> Iterator[Row]:
    """The one question of this file."""
    times = interleaved(
        {
            "help": lambda: subprocess.run(
                [sys.executable, "-m", "mcexact", "--help"], capture_output=True, check=True
            ),
            "click": lambda: subprocess.run(
                [sys.executable, "-c", "import click"], capture_output=True, check=True
            ),
        },
        runs=9,
    )
    ratio = times["help"].median / times["click"].median
    yield Row(
        "mcexact --help, against python -c 'import click'",
        ratio,
        "<= 3",
        ratio <= 3,
        f"{times['help'].median:.3f} s / {times['click'].median:.3f} s",
    )
