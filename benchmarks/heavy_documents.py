"""What do documents cost that ask for as much work as they can?

Run as ``python -m benchmarks.heavy_documents``.  Every document of ``tests/checker/heavy.py`` is
checked by a copied-out checker in a process of its own, at the default limits.  Prints for each the
bytes, the seconds, the MiB at most, the loop that it aims at where this is one of the rules about
parameters and boxes, and the start of the verdict; the last line has the largest of each.
`tests/checker/test_work.py` holds the same documents to the work that is counted.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import mcexact.checker
from tests.checker import heavy
from tests.checker.heavy_parameters import LOOPS

_MEASURED = Path(__file__).with_name("measured.py")


def main() -> int:
    """Measure all; ends with 1 if one takes 5 seconds or 300 MiB."""
    slowest, largest = 0.0, 0.0
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(Path(mcexact.checker.__file__).parent, Path(folder) / "checker")
        for name in heavy.HEAVY:
            data = heavy.text(name)
            Path(folder, "heavy.json").write_bytes(data)
            seconds, mebibytes, line = measured(folder)
            slowest, largest = max(slowest, seconds), max(largest, mebibytes)
            loop = f" [{LOOPS[name][0]}]" if name in LOOPS else ""
            print(
                f"{len(data):6} B {seconds:6.2f} s {mebibytes:5.0f} MiB  {name}{loop}: {line[:60]}"
            )
    print(f"at most {slowest:.2f} s and {largest:.0f} MiB")
    return int(slowest >= 5 or largest >= 300)


def measured(folder: str) -> tuple[float, float, str]:
    """Seconds of processor time, MiB at most, and the line of one check."""
    program = [sys.executable, "-S", "-E", "-m", "checker", "heavy.json"]
    done = subprocess.run(
        [sys.executable, "-S", "-E", str(_MEASURED), "usage.txt", *program],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    seconds, mebibytes = map(float, Path(folder, "usage.txt").read_text("ascii").split())
    return seconds, mebibytes, done.stdout.strip()


if __name__ == "__main__":
    raise SystemExit(main())
