"""The command that asks many systems: its table, its file, its statuses, and an interruption."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer import protocol
from mcexact.cli import main
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.model import gallery
from mcexact.model.controller import save_controller
from mcexact.model.files import save_system
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.report.sweep import sweep_tables
from mcexact.sweeps.questions import QUESTIONS
from tests.effort import PATIENCE
from tests.end_to_end.command_line import interruptible, without_notes
from tests.wording import says

Call = Callable[..., tuple[int, str, str]]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """Run the command in this process: status, standard output, standard error."""

    def run(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main(("sweep", *arguments))
        captured = capsys.readouterr()
        assert isinstance(ended.value.code, int)
        return ended.value.code, captured.out, without_notes(captured.err)

    return run


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two systems, the first of them with a fixed mode."""
    made = tmp_path / "plants"
    made.mkdir()
    save_system(gallery.load("hidden-triple-mode"), made / "a.json")
    save_system(gallery.load("quadruple-tank-pminus"), made / "b.json")
    return made


def test_a_folder_is_a_table_with_its_counts(call: Call, folder: Path) -> None:
    status, out, err = call(str(folder), "--question", "completeness", "--question=fixed_spectrum")
    assert (status, err) == (0, "")
    lines = [line.split() for line in out.splitlines()]
    assert ["a.json", "5", "2", "x", "-", "1,", "not", "stabilizable", "no"] in [
        line[:9] for line in lines
    ]
    assert ["b.json", "4", "2", "empty", "yes"] in [line[:5] for line in lines]
    assert says(out, "stabilizable invariant")
    assert ["with", "fixed", "modes", "1"] in lines and ["complete", "1"] in lines


def test_every_question_has_words_for_its_answer(call: Call, folder: Path) -> None:
    asked = [f"--question={name}" for name in QUESTIONS]
    status, out, _ = call(str(folder), *asked, "--json")
    assert status == 0
    documents = json.loads(out)["records"]
    table, _ = sweep_tables(documents, tuple(QUESTIONS))
    assert table.rows[1][3:-1] == (
        "empty", "yes", "yes", "yes", "2, 2", "2, 2", "yes", "parts of degree 4", "yes",
    )  # fmt: skip


def test_files_draws_and_certificates_go_together(call: Call, folder: Path, tmp_path: Path) -> None:
    made = tmp_path / "evidence"
    status, out, _ = call(
        str(folder / "a.json"), "--draws=2", "--seed=5", "--plant-fixed-mode", "--json",
        "--certificates", str(made),
    )  # fmt: skip
    view = json.loads(out)
    assert status == 0
    assert view["counts"] == {
        "systems": 3, "decided": 3, "with_fixed_modes": 3,
        "not_stabilizable": view["counts"]["not_stabilizable"],
    }  # fmt: skip
    assert [record["name"] for record in view["records"][1:]] == ["seed 5", "seed 6"]
    names = sorted(path.name for path in made.iterdir())
    assert names == [
        "1-a-fixed_spectrum.json", "2-seed-5-fixed_spectrum.json", "3-seed-6-fixed_spectrum.json",
    ]  # fmt: skip
    with pytest.raises(SystemExit) as ended:
        main(["check", "--statements", *(str(made / name) for name in names)])
    assert ended.value.code == 0


@pytest.mark.parametrize("workers", ["0", "-1", "1000000000", "two"])
def test_a_number_of_workers_that_makes_no_sense_is_wrong_usage(workers: str, call: Call) -> None:
    status, out, err = call("--draws", "1", "--workers", workers)
    assert (status, out) == (2, "") and "--workers" in err and err.count("\n") == 1


def test_nothing_to_sweep_over_is_wrong_usage(call: Call, tmp_path: Path) -> None:
    status, _, err = call()
    assert status == 2 and "--draws" in err
    status, _, err = call(str(tmp_path))
    assert status == 3 and "no *.json files" in err


def test_what_cannot_be_read_is_named_and_the_rest_is_decided(call: Call, folder: Path) -> None:
    (folder / "c.json").write_text("{")
    status, out, _ = call(str(folder), str(folder / "missing.json"))
    assert status == 3
    assert "no such file" in out and "c.json" in out and "decided           2" in out


def test_a_limit_is_for_each_system_and_another_run_goes_on(call: Call, tmp_path: Path) -> None:
    results, large = str(tmp_path / "results.jsonl"), tmp_path / "large.json"
    save_system(drawn_system(Draw(1, states=120, channels=10, fixed_degree=1)), large)
    arguments = (str(large), "-o", results)
    status, out, _ = call(*arguments, "--timeout", "0.1")  # less than it takes
    assert status == 4 and "time limit of 0.1 s" in out
    status, out, _ = call(*arguments, "--timeout", str(PATIENCE), "--json")
    assert status == 0 and json.loads(out)["counts"]["decided"] == 1
    assert len(Path(results).read_text().splitlines()) == 2


def test_many_systems_are_shown_by_the_most_telling_ones(call: Call) -> None:
    out = call("--draws=70", "--states=1", "--channels=1", "--json")[1]
    documents = json.loads(out)["records"]
    documents[66] = {"number": 66, "name": "seed 66", "error": {"status": 4, "message": "late"}}
    table, _ = sweep_tables(documents, ("fixed_spectrum",))
    assert len(table.rows) == 60 and table.note.startswith("60 of 70")
    assert ("seed 66", "", "", "late", "") in table.rows


def test_an_interrupted_sweep_says_so_and_goes_on(tmp_path: Path) -> None:
    results = tmp_path / "results.jsonl"
    arguments = ["sweep", "--draws=100000", "--states=6", "--workers=1", "-o", str(results)]
    begun = subprocess.Popen(
        [sys.executable, "-m", "mcexact", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        preexec_fn=interruptible,
    )
    while not results.exists() or results.stat().st_size < 2000:
        assert begun.poll() is None
        time.sleep(0.02)
    os.killpg(begun.pid, signal.SIGINT)
    out, err = begun.communicate(timeout=PATIENCE)
    assert begun.returncode == 130 and not out
    [line] = without_notes(err.decode()).splitlines()
    assert line.startswith("mcexact: interrupted after ") and str(results) in line
    kept = len(results.read_bytes().splitlines())
    assert 0 < kept < 100_000
    again = subprocess.run(
        [sys.executable, "-m", "mcexact", "sweep", f"--draws={kept}", "--states=6", "--json",
         "-o", str(results)],
        capture_output=True,
        check=True,
    )  # fmt: skip
    assert json.loads(again.stdout)["counts"]["decided"] == kept


def test_of_a_folder_only_system_files_are_read_and_the_others_are_named(
    call: Call, folder: Path, tmp_path: Path
) -> None:
    plant = gallery.load("hidden-triple-mode")
    protocol.save_certificate(fixed_spectrum(plant), folder / "certificate.json")
    gains = [[[0] * plant.q(i)] * plant.p(i) for i in range(plant.m)]
    save_controller(local_controllers(plant, gains), folder / "controller.json")
    (folder / "other.json").write_text("[1, 2]", encoding="ascii")
    (folder / "README.md").write_text("what these are", encoding="ascii")
    results = str(tmp_path / "results.jsonl")
    expected = [
        ("README.md", "its name does not end in .json"),
        ("certificate.json", "format: expected a system file, found a certificate"),
        ("controller.json", "format: expected a system file, found a controller file"),
        ("other.json", 'expected a JSON object with "format": "mcexact-system/1", found a list'),
    ]
    for _ in range(2):  # the second time from the results
        status, out, _ = call(str(folder), "--json", "-o", results)
        found = json.loads(out)
        assert status == 0
        assert found["counts"]["systems"] == found["counts"]["decided"] == 2
        assert [(Path(s["name"]).name, s["reason"]) for s in found["skipped"]] == expected
    told = " ".join(call(str(folder))[1].split())
    assert says(told, "skipped because")
    assert all(name in told and reason in told for name, reason in expected)


def test_a_malformed_system_file_in_a_folder_is_a_failure(call: Call, folder: Path) -> None:
    for name, text in {
        "short.json": '{"format": "mcexact-system/1"}',
        "later.json": '{"format": "mcexact-system/9"}',
        "broken.json": "{",
    }.items():
        (folder / name).write_text(text, encoding="ascii")
    status, out, _ = call(str(folder), "--json")
    found = json.loads(out)
    assert (status, found["skipped"]) == (3, [])
    assert found["counts"]["systems"] == 5
    assert found["counts"]["decided"] == 2


def test_a_file_that_is_named_is_never_skipped(call: Call, folder: Path) -> None:
    (folder / "other.json").write_text("{}", encoding="ascii")
    status, out, _ = call(str(folder / "other.json"), str(folder), "--json")
    found = json.loads(out)
    assert (status, found["counts"]["systems"], len(found["skipped"])) == (3, 3, 1)


def test_a_folder_without_any_system_file_is_bad_input(call: Call, tmp_path: Path) -> None:
    (tmp_path / "other.json").write_text("{}", encoding="ascii")
    status, _, err = call(str(tmp_path))
    assert status == 3
    assert says(err, "system file") and str(tmp_path) in err


def test_variants_of_a_plant_in_floats_are_made_without_a_warning(
    call: Call, tmp_path: Path
) -> None:
    plant = str(tmp_path / "rounded.npz")
    A, B, C = [[-0.30000000000000004, 0.7], [0.3, -0.7]], [[0.1], [-0.1]], [[1.0, 0.0]]
    np.savez(plant, A=A, B_1=B, C_1=C, rounding="decimal")
    status, out, err = call(plant, "--all-sensors")
    assert status == 0 and says(out, "depends errors") and not err


def test_a_system_of_which_the_data_allow_another_answer_is_marked(
    call: Call, tmp_path: Path
) -> None:
    A = [["-0.30000000000000004", "0.7"], ["0.3", "-0.7"]]
    plant = MultiChannelSystem(A, [[["0.1"], ["-0.1"]]], [[[1, 0]]])
    save_system(plant, tmp_path / "rounded.json")
    page = tmp_path / "page.html"
    status, out, _ = call(str(tmp_path / "rounded.json"), "--html", str(page))
    assert status == 0 and "rounded.json *" in out and says(out, "depends errors")
    assert says(page.read_text("utf-8"), "data allow")
    [record] = json.loads(call(str(tmp_path / "rounded.json"), "--json")[1])["records"]
    assert record["nearby"][0]["within"] == "rounding"
