"""How do the commands grow with the states and the channels, in time and in memory?

Every command runs in a process of its own on plants of two or three sizes and two or three numbers
of channels; seconds are those of the processor.  The exponents a and b of n^a m^b are fitted to all
of them by least squares, with the peak memory in the same way.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.fixed_spectrum import Row
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.model.files import save_system

_MEASURED = Path(__file__).with_name("measured.py")
_SECONDS = 300


@dataclass(frozen=True)
class Command:
    """A command on plants of a network: ``sizes`` are pairs (n, m); earlier runs prepare the last.

    ``{system}`` stands for the file of the plant, ``{folder}`` for a directory of its own.
    """

    network: str
    sizes: tuple[tuple[int, int], ...]
    runs: tuple[str, ...]
    neighbors: bool = False


_LARGE = ((500, 25), (1000, 25), (1000, 50), (2000, 50), (2000, 100))
_SMALL = ((48, 4), (96, 4), (96, 8), (192, 8))
_LOOPS = ((8, 2), (16, 2), (16, 4), (32, 4))
_DESIGN = "design decentralized {system} -o {folder}/c.json"

COMMANDS = {
    "analyze": Command("building", _LARGE, ("analyze {system} --json",)),
    "check": Command(
        "building",
        _LARGE,
        (
            "analyze {system} --certificates {folder}/e",
            "check {folder}/e/fixed_spectrum.json --system {system}",
        ),
    ),
    "allocate": Command("swing-speed", _SMALL, ("allocate {system}",), neighbors=True),
    "design decentralized": Command("swing-grid", _LOOPS, (_DESIGN,)),
    "design extended": Command(
        "swing-grid",
        _LOOPS[:3],
        ("design extended {system} --rate 1/20 -o {folder}/c.json",),
        neighbors=True,
    ),
    "design observer": Command(
        "swing-grid",
        _LOOPS[:3],
        ("design observer {system} --rate 1/20 --arithmetic float -o {folder}/c.json",),
        neighbors=True,
    ),
    "certify": Command("swing-grid", _LOOPS, (_DESIGN, "certify {system} {folder}/c.json")),
    "simulate": Command("swing-grid", _LOOPS, (_DESIGN, "simulate {system} {folder}/c.json")),
    "c2d": Command("swing-grid", _SMALL, ("c2d {system} --step 1/10 -o {folder}/d.json",)),
    "crosscheck": Command("swing-grid", _SMALL, ("crosscheck {system}",)),
    "sweep": Command("swing-grid", _SMALL, ("sweep {system} -o {folder}/a.jsonl",)),
    "sample": Command(
        "building",
        ((1000, 50), (10000, 50), (10000, 500)),
        ("sample --network building --states {n} --channels {m}",),
    ),
}


def command_rows(name: str) -> Iterator[Row]:
    """The seconds and the memory of a command for each size, and the exponents of both."""
    command, costs = COMMANDS[name], []
    for n, m in command.sizes:
        status, seconds, mebibytes = _cost(command, n, m)
        good = status in (0, 1)
        if good:
            costs.append((n, m, seconds, mebibytes))
        yield Row(
            f"{name}, {command.network}, n={n}, m={m}",
            seconds,
            "reported",
            good,
            f"{mebibytes:.0f} MiB" + ("" if good else f", status {status}"),
            unit="s",
        )
    if len(costs) >= 3:
        time, memory = (_exponents(costs, k) for k in (2, 3))
        grows = f"MiB as n^{memory[0]:.1f} m^{memory[1]:.1f}"
        yield Row(
            f"{name}, growth of the time",
            time[0],
            "reported",
            True,
            f"seconds as n^{time[0]:.1f} m^{time[1]:.1f}, {grows}",
            unit="exponent",
        )


def _cost(command: Command, n: int, m: int) -> tuple[int, float, float]:
    """The status of the last run, its seconds of processor time, and its MiB at most."""
    with tempfile.TemporaryDirectory() as folder:
        system, usage = Path(folder) / "plant.json", Path(folder) / "usage.txt"
        draw = Draw(0, n, m, network=command.network, neighbors=command.neighbors)
        save_system(drawn_system(draw), system)
        status = 0
        for run in command.runs:
            words = [word.format(system=system, folder=folder, n=n, m=m) for word in run.split()]
            program = [sys.executable, "-m", "mcexact", *words]
            try:
                status = subprocess.run(
                    [sys.executable, "-S", "-E", str(_MEASURED), str(usage), *program],
                    stdin=subprocess.DEVNULL,
                    capture_output=True,
                    check=False,
                    timeout=_SECONDS,
                ).returncode
            except subprocess.TimeoutExpired:
                return 4, _SECONDS, 0.0
        seconds, mebibytes = map(float, usage.read_text(encoding="ascii").split())
    return status, seconds, mebibytes


def _exponents(costs: list[tuple[int, int, float, float]], column: int) -> tuple[float, float]:
    """The a and b of the n^a m^b that is nearest in the logarithms."""
    table = np.array(costs, dtype=float)
    left = np.column_stack([np.ones(len(table)), np.log(table[:, 0]), np.log(table[:, 1])])
    found = np.linalg.lstsq(left, np.log(table[:, column]), rcond=None)[0]
    return float(found[1]), float(found[2])
