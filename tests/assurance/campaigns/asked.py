"""The certificates of every kind pass what can be asked of them, for the plants of the gallery.

Run as ``python -m tests.assurance.campaigns.asked FOLDER [PLANT…]``.  Every certificate is checked
in a process of its own with ``--system``, ``--expect`` its own statement and, where its subject has
a closed loop, ``--controller``; and it is refused for another plant, controller or statement.
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from mcexact.analysis.controllability import exceptional_gains
from mcexact.answer.protocol import document, save_certificate
from mcexact.answer.sentence import MANIFEST
from mcexact.checker.command import main as check
from mcexact.checker.kinds import KINDS
from mcexact.cli import main
from mcexact.errors import Impossible
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from tests.answer.written import with_graph

OF_A_PAIR = "exceptional_gains.json"
"""About the plant of a pair (A, B) alone, with one channel."""
LIMIT = "--timeout=60"
Seen = Counter[str]


def questions(plant: MultiChannelSystem, file: str, place: Path) -> dict[str, list[str]]:
    """What is asked on the command line, by the names of the subfolders."""
    channel, bound = (
        plant.names[0],
        "--radius=99/100" if plant.time == "discrete" else "--rate=1/100",
    )
    controllers = {name: str(place / f"{name}.controller") for name in ("observer", "extended")}
    asked = {
        "analyze": ["analyze", file, "--minimal", "--subset", channel, "--channel", channel],
        "gains": ["analyze", file, "--every-channel"],
        "allocate": ["allocate", file],
        "links": ["allocate", file, "--links"],
    }
    for name, controller in controllers.items():
        for arithmetic in ("exact", "float"):
            options = [bound, "--arithmetic", arithmetic, "-o", f"{controller}-{arithmetic}"]
            asked[f"{name}-{arithmetic}"] = ["design", name, file, *options]
        asked[f"certify-{name}"] = ["certify", file, f"{controller}-float", bound]
    return asked


def run(arguments: list[str]) -> int:
    """The exit status of a command, which prints nothing."""
    quiet = contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO())
    with quiet[0], quiet[1]:
        try:
            main(arguments)
            return 0
        except SystemExit as ended:
            return int(ended.code or 0)


def checked(*arguments: str) -> tuple[int, list[dict[str, Any]]]:
    """What the checker's own command line answers."""
    told = io.StringIO()
    with contextlib.redirect_stdout(told):
        status = check([*arguments, "--json"])
    return status, json.loads(told.getvalue())["verdicts"]


def write(name: str, folder: Path) -> None:
    """Ask all questions about one plant, and write the certificates."""
    plant, place = with_graph(gallery.load(name)), folder / name
    place.mkdir(parents=True)
    save_system(plant, folder / f"{name}.json")
    for question, arguments in questions(plant, str(folder / f"{name}.json"), place).items():
        run([*arguments, LIMIT, "--certificates", str(place / question)])
    ones = Matrix.from_integers([[1] * plant.n for _ in range(plant.n)])
    if plant.n <= 4:
        with contextlib.suppress(Impossible):  # the pair is not controllable
            found = exceptional_gains(ones, plant.A, plant.input_matrix())
            save_certificate(found.controllability_set, place / OF_A_PAIR)
            pair = {"format": "mcexact-system/1", **document(found.controllability_set)["system"]}
            (place / "pair.system").write_text(json.dumps(pair), encoding="ascii")


def insist(name: str, folder: Path, other: str, seen: Seen) -> None:
    """Check every certificate about one plant with all that can be asked.

    Raises
    ------
    AssertionError
        If what should be VALID is not, or the other way round.
    """
    for file in sorted((folder / name).rglob("*.json")):
        if file.name == MANIFEST:
            continue
        certificate, plant = json.loads(file.read_bytes()), folder / f"{name}.json"
        system = str(plant if file.name != OF_A_PAIR else folder / name / "pair.system")
        ((status, (verdict,)),) = [checked(str(file), "--system", system)]
        require(status == 0, f"{file}: {verdict}")
        expected = folder / "statement.txt"
        expected.write_text(verdict["statement"] + "\n", encoding="ascii")
        asked = ["--system", system, "--expect", str(expected)]
        loop = any(step["construction"] == "closed_loop" for step in certificate["subject"])
        seen[certificate["kind"]] += 1
        seen["certificates"] += 1
        if loop:
            written = sorted((folder / name).glob("*.controller-*"))
            fits = [
                each for each in written if checked(str(file), "--controller", str(each))[0] == 0
            ]
            require(len(fits) >= 1, f"{file}: about none of {len(written)} controllers")
            asked += ["--controller", str(fits[0])]
            seen["of loops"] += 1
        require(checked(str(file), *asked)[0] == 0, f"{file}: refused with {asked}")
        require(checked(str(file), "--system", str(folder / other))[0] == 1, f"{file}: {other}")
        if not loop and (written := sorted((folder / name).glob("*.controller-*"))):
            status, _ = checked(str(file), "--controller", str(written[0]))
            require(status == 1, f"{file}: a controller without a loop")


def require(holds: bool, message: str) -> None:
    """Stop unless this holds."""
    if not holds:
        raise AssertionError(message)


def campaign(folder: Path, names: list[str]) -> Seen:
    """All of it for these plants; what was seen."""
    seen = Seen()
    other = "another.json"
    folder.mkdir(parents=True, exist_ok=True)
    save_system(MultiChannelSystem([[7]], [[[1]]], [[[1]]]), folder / other)
    for name in names:
        write(name, folder)
        insist(name, folder, other, seen)
        seen["plants"] += 1
    return seen


if __name__ == "__main__":
    found = campaign(Path(sys.argv[1]), sys.argv[2:] or list(gallery.names()))
    for what, number in sorted(found.items()):
        print(f"{number:6} {what}")
    print("kinds that none has:", ", ".join(sorted(set(KINDS) - set(found))) or "none")
