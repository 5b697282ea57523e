"""All JSON of all commands about every published plant, against the shipped schemas: half an hour.

``python -m tests.campaigns.schemas [NAME ...]``
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from mcexact.model import gallery
from tests.end_to_end.command_line import run
from tests.report.schemas import faults

LIMIT = ("--timeout", "120")
MEANT = {0, 1, 4}
"""Done, a proved no, and a limit that was reached."""


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
    design = ("design", "decentralized", plant, "--effort", "1", "-o", controller, *LIMIT)
    yield "design", (*design, "--certificates", str(folder / "design"))
    if Path(controller).exists():
        certify = ("certify", plant, controller, "--certificates", str(folder / "loop"), *LIMIT)
        yield "certify", certify
        yield "simulate", ("simulate", plant, controller, *LIMIT)
    yield "design", ("design", "setpoint", plant, "--effort", "1", *LIMIT)
    if "discrete" not in (folder / "plant.json").read_text(encoding="utf-8"):
        yield "system", ("c2d", plant, "--step", "1/10", *LIMIT)


def problems(name: str, folder: Path) -> Iterator[str]:
    """What is not as a schema says, for one plant."""
    (folder / "plant.json").write_text(gallery.text(name), encoding="utf-8")
    for schema, arguments in commands(f"gallery:{name}", folder):
        done = run(*arguments, "--json")
        if done.status not in MEANT:
            yield f"{' '.join(arguments)}: status {done.status}: {done.stderr[-300:]}"
            continue
        document = json.loads(done.stdout)
        failed = document.get("format") == "mcexact-error/1"
        yield from faults("error" if failed else schema, document)
    for path in sorted(folder.rglob("*.json")):
        document = json.loads(path.read_text(encoding="utf-8"))
        kind = document["format"].removeprefix("mcexact-").partition("/")[0]
        yield from (f"{path.name}: {fault}" for fault in faults(kind, document))
    records = folder / "records.jsonl"
    for line in records.read_text(encoding="utf-8").splitlines() if records.exists() else ():
        yield from faults("sweep-record", json.loads(line))


def main(names: list[str]) -> int:
    """Try some published plants, or all of them; the status is 1 if something is wrong."""
    wrong = 0
    for name in names or gallery.names():
        with tempfile.TemporaryDirectory() as folder:
            found = list(problems(name, Path(folder)))
        wrong += bool(found)
        print(f"{name}: {'as the schemas say' if not found else '; '.join(found)}", flush=True)
    for schema, arguments in (("demo", ("demo",)), ("gallery", ("gallery",))):
        found = faults(schema, json.loads(run(*arguments, "--json").stdout))
        wrong += bool(found)
        print(f"{schema}: {found or 'as the schemas say'}", flush=True)
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
