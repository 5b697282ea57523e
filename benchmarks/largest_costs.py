"""The ten largest costs of `analyze` of a dense plant: start-up, questions, writing and checks.

``python -m benchmarks.largest_costs 20 200`` prints rows of a table.  An earlier commit is measured
by the same program, ``PYTHONPATH=CHECKOUT python -m benchmarks.largest_costs 20``, as it uses only
what the package had for long.
"""

from __future__ import annotations

import random
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

MOST = 10
"""So many costs are listed."""

T = TypeVar("T")


def costs_of(n: int) -> dict[str, float]:
    """Seconds of the processor by cost, all costs of one run of the command."""
    import mcexact
    from mcexact.answer.check import recheck
    from mcexact.cli.results import Evidence

    costs, system = dict[str, float](), _plant(n)

    def timed(name: str, work: Callable[[], T]) -> T:
        start = time.process_time()
        result = work()
        costs[name] = time.process_time() - start
        return result

    with tempfile.TemporaryDirectory() as place:
        file = Path(place, "plant.json")
        mcexact.save_system(system, file)
        before = _children()
        command = [sys.executable, "-m", "mcexact", "analyze", str(file)]
        subprocess.run([*command, "--certificates", f"{place}/c"], capture_output=True, check=False)
        whole = _children() - before
        mcexact.load_system(file)  # so that nothing is imported while it is timed
        system = timed("reading the file", lambda: mcexact.load_system(file))
    analysis = mcexact.analyze(system)
    for name in analysis.by_default:
        timed(f"{name}, decided", lambda name=name: getattr(analysis, name))  # type: ignore[misc]
    account = timed("sentences, and the search nearby", lambda: analysis.account)
    evidence = timed("certificates and manifest, written", lambda: Evidence.of(account, True))
    last = time.process_time()

    def checked(name: str, _: object) -> None:
        nonlocal last
        last, start = time.process_time(), last
        costs[f"{name}, checked"] = last - start

    recheck(evidence.files, evidence.plants, checked)
    costs["start-up, and all else"] = max(whole - sum(costs.values()), 0.0)
    return costs | {"**the whole command**": whole}


def _children() -> float:
    """The seconds of the processor that other processes have used."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _plant(n: int) -> Any:
    """The dense plant of `benchmarks.every_question`, with max(n/10, 2) channels."""
    import mcexact

    m = max(n // 10, 2)
    rng = random.Random(n + m)

    def matrix(rows: int, cols: int) -> list[list[int]]:
        return [[rng.randint(-9, 9) for _ in range(cols)] for _ in range(rows)]

    return mcexact.MultiChannelSystem(
        matrix(n, n), [matrix(n, 1) for _ in range(m)], [matrix(1, n) for _ in range(m)]
    )


if __name__ == "__main__":
    for number in map(int, sys.argv[1:]):
        largest = sorted(costs_of(number).items(), key=lambda item: -item[1])[: MOST + 1]
        for what, seconds in largest:
            print(f"| {number} | {what} | {seconds:.3g} |", flush=True)
