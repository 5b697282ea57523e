"""The folder that goes from a plant to a compiled controller, as it is and made again."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mcexact import certify_controller, load_controller, load_system
from mcexact.constructions import sampled_system
from mcexact.export.code import export_controller
from mcexact.export.equations import EQUATIONS
from mcexact.simulation.real import Quantizer, simulate_real
from tests.wording import worded

FOLDER = Path(__file__).parents[2] / "examples" / "tanks"
COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
MAKE = shutil.which("make")


def test_the_code_is_that_of_the_controller() -> None:
    files = export_controller(load_controller(FOLDER / "controller.json"), "c")
    assert {path.name for path in (FOLDER / "code").iterdir()} == set(files)
    for name, text in files.items():
        kept = (FOLDER / "code" / name).read_text(encoding="ascii")
        if name == EQUATIONS:
            agents = zip(json.loads(kept)["agents"], json.loads(text)["agents"], strict=True)
            assert all(old.items() <= new.items() for old, new in agents)
        else:
            assert _without_comments(kept) == _without_comments(text), name


def _without_comments(text: str) -> str:
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def test_what_runs_is_stable_for_the_plant_of_the_folder() -> None:
    plant = sampled_system(load_system(FOLDER / "plant.json"), 5, 1)
    for name in ("controller.json", "code/controller.json"):
        controller = load_controller(FOLDER / name)
        assert controller.warnings_for(plant) == ()
        assert certify_controller(plant, controller).stable


def test_the_recording_is_that_of_the_real_loop() -> None:
    run = simulate_real(
        load_system(FOLDER / "plant.json"),
        load_controller(FOLDER / "controller.json"),
        step=5,
        late=1,
        initial=[0, 0],
        reference=[2, 1],
        limits=[("-3/10", "3/10")] * 2,
        quantized_outputs=[Quantizer.of_bits(12, -10, 10)] * 2,
    )
    with (FOLDER / "recorded.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    signals = run.signals()
    assert len(rows) == len(run.times)
    for name, values in signals.items():
        # The ideal loop runs in numpy, whose roundings depend on the processor.
        if not name.startswith("ideal"):
            assert [float(row[name]) for row in rows] == values, name


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
def test_the_program_computes_every_recorded_input_bit_by_bit(tmp_path: Path) -> None:
    def play(recording: Path) -> subprocess.CompletedProcess[str]:
        command = [str(tmp_path / "play"), str(recording)]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    sources = [str(FOLDER / "main.c"), *map(str, sorted((FOLDER / "code").glob("*.c")))]
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"]
    command = [str(COMPILER), *flags, f"-I{FOLDER / 'code'}", *sources, "-o", "play"]
    built = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert built.returncode == 0 and not built.stderr, built.stderr
    done = play(FOLDER / "recorded.csv")
    assert done.returncode == 0 and worded(done.stdout)
    with (FOLDER / "recorded.csv").open(encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    k = head.index("computed u pump")
    rows[3][k] = repr(float(rows[3][k]) * (1 + 2**-52))
    with (tmp_path / "other.csv").open("w", encoding="utf-8") as file:
        csv.writer(file).writerows([head, *rows])
    done = play(tmp_path / "other.csv")
    assert done.returncode == 1 and done.stdout.startswith("31 samples, 1 inputs differ")


def test_the_guide_has_the_commands_of_the_folder() -> None:
    makefile = (FOLDER / "Makefile").read_text(encoding="utf-8")
    commands = re.findall(r"\$\(MCEXACT\) (\w+(?: setpoint)?)", makefile)
    assert commands == ["design setpoint", "check", "export", "simulate"]
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert all(f"`mcexact {command} " in readme for command in commands)


@pytest.mark.slow
@pytest.mark.skipif(COMPILER is None or MAKE is None, reason="there is no C compiler or no make")
def test_the_folder_is_made_again_from_the_plant_alone(tmp_path: Path) -> None:
    for name in ("plant.json", "Makefile", "main.c"):
        shutil.copy(FOLDER / name, tmp_path / name)
    environment = {**os.environ, "PYTHONPATH": str(FOLDER.parents[1])}
    command = [str(MAKE), f"MCEXACT={sys.executable} -m mcexact", f"CC={COMPILER}"]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert re.search(r"\d+ samples, 0 inputs differ", done.stdout)
    assert "Proved: cost" in done.stdout and "INVALID" not in done.stdout
    assert "Proved: cost" in (tmp_path / "code.html").read_text(encoding="utf-8")
