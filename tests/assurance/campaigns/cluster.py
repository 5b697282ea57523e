"""A sweep over a dask cluster of two processes, of which one is killed halfway: minutes.

``python -m tests.assurance.campaigns.cluster [SYSTEMS]`` runs ``mcexact sweep --scheduler`` and
compares its records with those of a sweep without a cluster: none is lost, none is made twice, all
are equal.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from tests.end_to_end.command_line import MCEXACT

STATES = "12"


def records(path: Path) -> list[dict[str, Any]]:
    """The records of a file, without the seconds that they took."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    found = [json.loads(line) for line in lines]
    return [{key: each[key] for key in each if key != "seconds"} for each in found]


def sweeping(count: int, path: Path, *options: str) -> subprocess.Popen[bytes]:
    """Start a sweep in a process of its own."""
    command = [*MCEXACT, "sweep", "--draws", str(count), "--states", STATES, "-o", str(path)]
    return subprocess.Popen([*command, *options], stdout=subprocess.DEVNULL)


def problems(count: int, folder: Path) -> list[str]:
    """What went wrong when a process of the cluster was killed halfway."""
    from distributed import LocalCluster

    path = folder / "cluster.jsonl"
    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as cluster:
        process = sweeping(count, path, "--scheduler", cluster.scheduler_address)
        while process.poll() is None and len(records(path)) < count // 2:
            time.sleep(0.05)
        if process.poll() is not None:
            return ["the sweep ended before half of it was done"]
        victim = cluster.workers[0].process.pid
        os.kill(victim, signal.SIGKILL)
        print(f"killed worker {victim} after {len(records(path))} records", flush=True)
        status = process.wait()
    found = records(path)
    wrong = [] if status == 0 else [f"the sweep ended with status {status}"]
    numbers = sorted(each["number"] for each in found)
    if numbers != list(range(count)):
        wrong.append(f"{len(numbers)} records of {len(set(numbers))} systems, not {count}")
    wrong += [f"{each['name']}: {each['error']['message']}" for each in found if "error" in each]
    here = folder / "here.jsonl"
    sweeping(count, here, "--workers", "2").wait()
    expected = sorted(records(here), key=lambda each: each["number"])
    if sorted(found, key=lambda each: each["number"]) != expected:
        wrong.append("the records differ from those of a sweep without a cluster")
    return wrong


def main(arguments: list[str]) -> int:
    """Run it, and end with status 1 if something went wrong."""
    count = int(arguments[0]) if arguments else 2000
    with tempfile.TemporaryDirectory() as folder:
        wrong = problems(count, Path(folder))
    print("; ".join(wrong) or f"{count} systems: nothing lost, nothing twice, all answers equal")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
