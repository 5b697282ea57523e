"""All JSON of all commands about every published plant, against the shipped schemas: an hour.

``python -m tests.assurance.campaigns.schemas [NAME ...]``.  Plants that ``build/schemas.jsonl``
holds without a fault are not tried again: after an interruption the same command goes on.  At the
end it says which commands took longest.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mcexact.model import gallery
from mcexact.model.files import save_system
from mcexact.model.graph import NeighborGraph
from tests.end_to_end.command_line import run
from tests.report.schemas import faults

FILE = Path("build") / "schemas.jsonl"
LIMIT = ("--timeout", "120")
EFFORT = ("--effort", "1")
MEANT = {0, 1, 4}
"""Done, a proved no, and a limit that was reached."""
SLOWEST = 12


def commands(plant: str, folder: Path) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The schema and the arguments of every command about a plant."""
    controller, evidence = str(folder / "controller.json"), str(folder / "evidence")
    yield "analyze", ("analyze", plant, "--certificates", evidence, *LIMIT)
    yield "check", ("check", "--manifest", evidence)
    yield (
        "allocate",
        ("allocate", plant, "--links", "--certificates", str(folder / "links"), *LIMIT),
    )
    yield "crosscheck", ("crosscheck", plant, *LIMIT)
    yield "sweep", ("sweep", plant, "-o", str(folder / "records.jsonl"), "--workers", "1", *LIMIT)
    design = ("design", "decentralized", plant, *EFFORT, "-o", controller, *LIMIT)
    yield "design", (*design, "--certificates", str(folder / "design"))
    if Path(controller).exists():
        certify = ("certify", plant, controller, "--certificates", str(folder / "loop"), *LIMIT)
        yield "certify", certify
        yield "simulate", ("simulate", plant, controller, *LIMIT)
    yield "design", ("design", "setpoint", plant, *EFFORT, *LIMIT)
    ring = str(folder / "ring.json")
    yield "design", ("design", "extended", ring, *EFFORT, *LIMIT)
    yield "design", ("design", "observer", ring, "--arithmetic", "float", *LIMIT)
    yield "system", ("convert", plant)
    if "discrete" not in (folder / "plant.json").read_text(encoding="utf-8"):
        yield "system", ("c2d", plant, "--step", "1/10", *LIMIT)


def commands_for_all_values(plant: str, folder: Path) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The same about a plant with parameters."""
    evidence = folder / "evidence"
    yield "analyze-parameters", ("analyze", plant, "--certificates", str(evidence), *LIMIT)
    if (evidence / "manifest.json").exists():
        yield "check", ("check", "--manifest", str(evidence))
    else:
        yield from (("check", ("check", str(each))) for each in sorted(evidence.glob("*.json")))
    yield "system", ("convert", plant)
    known = gallery.load_parametric(plant.removeprefix("gallery:"))
    values = [f"--at={name}=1/7" for name in known.parameters]
    yield "system", ("convert", plant, *values)
    yield "analyze", ("analyze", plant, *values, *LIMIT)
    grid = [f"--grid={name}=1/7:6/7:2" for name in known.parameters]
    records = ("-o", str(folder / "records.jsonl"), "--workers", "1")
    yield "sweep", ("sweep", plant, *grid, *records, *LIMIT)


def tried(name: str, folder: Path) -> dict[str, Any]:
    """What is not as a schema says, for one plant, and how long and with which status."""
    (folder / "plant.json").write_text(gallery.text(name), encoding="utf-8")
    asked = commands
    if name in gallery.parametric_names():
        asked = commands_for_all_values
    else:
        plant = gallery.load(name)
        linked = plant if plant.neighbors else plant.with_neighbors(NeighborGraph.ring(plant.names))
        save_system(linked, folder / "ring.json")
    problems: list[str] = []
    took: dict[str, tuple[float, int]] = {}
    for schema, arguments in asked(f"gallery:{name}", folder):
        began = time.monotonic()
        done = run(*arguments, "--json")
        command = " ".join(arguments[: 2 if schema == "design" else 1])
        took[command] = (round(time.monotonic() - began, 1), done.status)
        if done.status not in MEANT:
            problems.append(f"{' '.join(arguments)}: status {done.status}: {done.stderr[-300:]}")
            continue
        document = json.loads(done.stdout)
        failed = document.get("format") == "mcexact-error/1"
        problems += faults("error" if failed else schema, document)
    for path in sorted(folder.rglob("*.json")):
        document = json.loads(path.read_text(encoding="utf-8"))
        kind = document["format"].removeprefix("mcexact-").partition("/")[0]
        problems += [f"{path.name}: {fault}" for fault in faults(kind, document)]
    records = folder / "records.jsonl"
    for line in records.read_text(encoding="utf-8").splitlines() if records.exists() else ():
        problems += faults("sweep-record", json.loads(line))
    return {"name": name, "problems": problems, "took": took}


def known() -> dict[str, dict[str, Any]]:
    """The plants of the file that had no fault."""
    lines = FILE.read_text(encoding="utf-8").splitlines() if FILE.exists() else []
    return {row["name"]: row for row in map(json.loads, lines) if not row["problems"]}


def told(problems: list[str]) -> str:
    """What was found, in words."""
    return "; ".join(problems) or "as the schemas say"


def main(names: list[str]) -> int:
    """Try some published plants, or all of them; the status is 1 if something is wrong."""
    FILE.parent.mkdir(parents=True, exist_ok=True)
    found = known()
    for name in names or (*gallery.names(), *gallery.parametric_names()):
        if name not in found:
            with tempfile.TemporaryDirectory() as folder:
                found[name] = tried(name, Path(folder))
            with FILE.open("a", encoding="utf-8") as file:
                file.write(json.dumps(found[name]) + "\n")
        print(f"{name}: {told(found[name]['problems'])}", flush=True)
    wrong = sum(bool(row["problems"]) for row in found.values())
    for schema, arguments in (("demo", ("demo",)), ("gallery", ("gallery",))):
        problems = faults(schema, json.loads(run(*arguments, "--json").stdout))
        wrong += bool(problems)
        print(f"{schema}: {told(problems)}", flush=True)
    took = [(*each, row["name"], of) for row in found.values() for of, each in row["took"].items()]
    for spent, status, name, command in sorted(took, reverse=True)[:SLOWEST]:
        print(f"{spent:7.1f} s  status {status}  {command} {name}")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
