"""Each command does what it says, ends with its status, and writes whole files."""

import json
import os
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import pytest

import mcexact
from mcexact.analysis.questions import QUESTIONS
from mcexact.cli import command_line, main
from mcexact.cli.commands import COMMANDS
from mcexact.crosschecks import demonstration
from mcexact.crosschecks.table import libraries_here
from mcexact.model import gallery
from mcexact.model.files import load_system
from tests.checker.manifests import write
from tests.end_to_end.command_line import without_notes
from tests.wording import says

GALLERY = Path(gallery.__file__).parent
TRIPLE = str(GALLERY / "hidden-triple-mode.json")
UNLINKED = str(GALLERY / "liu2020-3ch-no-communication.json")
DOUBLE = str(GALLERY / "compleib-dis2.json")
QUOTING = Path(mcexact.__file__).parents[1] / "docs" / "why-exactly.md"

Call = Callable[..., tuple[int, str, str]]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """Run the command line in this process: status, output, standard error without notes."""

    def run(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        code = ended.value.code
        assert isinstance(code, int)
        captured = capsys.readouterr()
        return code, captured.out, without_notes(captured.err)

    return run


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_with_a_sentence_and_its_options(name: str, call: Call) -> None:
    status, out, _ = call(name, "--help")
    assert status == 0
    assert out.startswith(f"Usage: mcexact {name} ")
    assert "--json" in out or "COMMAND [ARGS]" in out
    assert call("--help")[1].count(f"  {name} ") == 1


@pytest.mark.parametrize("group", [(), ("design",)])
def test_the_list_of_commands_has_the_line_of_help_of_each(group: tuple[str, ...]) -> None:
    listing: Any = command_line
    for name in group:
        listing = listing.listed[name].load()
    for name, listed in listing.listed.items():
        command = listed.load()
        assert (name, listed.help) == (command.name, command.get_short_help_str(limit=10**3))


def test_names_of_commands_and_options_are_completed() -> None:
    with click.Context(command_line) as context:
        completed = [each.value for each in command_line.shell_complete(context, "c")]
        assert completed == ["check", "certify", "crosscheck", "convert", "c2d"]
        assert [each.value for each in command_line.shell_complete(context, "--v")] == ["--version"]


@pytest.mark.parametrize("group", [(), ("design",)])
def test_a_group_without_a_command_shows_its_help(group: tuple[str, ...], call: Call) -> None:
    status, out, err = call(*group)
    assert (status, out) == (2, "")
    assert err.startswith("Usage: mcexact ")
    assert "\nCommands:\n" in err and "\\n" not in err


@pytest.mark.parametrize(
    ("typed", "meant"),
    [("anlyze", "analyze"), ("analyse", "analyze"), ("chekc", "check"), ("sampel", "sample")],
)
def test_a_near_miss_is_answered_with_the_nearest_command(
    typed: str, meant: str, call: Call
) -> None:
    status, out, err = call(typed, "file.json")
    assert (status, out) == (2, "")
    assert f"did you mean '{meant}'?" in err


def test_a_word_that_is_near_to_nothing_gets_the_list(call: Call) -> None:
    assert "one of analyze, check" in call("xyzzy")[2]


def test_an_error_that_nobody_foresaw_asks_to_be_reported(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken() -> None:
        raise ZeroDivisionError("surprise")

    monkeypatch.setattr(demonstration, "demonstration", broken)
    status, out, err = call("demo")
    assert (status, out) == (70, "")
    assert "internal error, ZeroDivisionError: surprise" in err
    assert "please report it" in err
    assert err.count("\n") == 1


def test_an_interruption_is_status_130(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(demonstration, "demonstration", interrupted)
    assert call("demo")[0] == 130


def test_demo_prints_what_the_documentation_says_was_recorded(call: Call) -> None:
    status, out, _ = call("demo")
    assert status == 0
    recorded, _, here = out.partition("\nOn this machine ")
    assert recorded in QUOTING.read_text(encoding="utf-8")
    assert f"{libraries_here()}" in here


def test_demo_as_json_has_both_failures_and_what_this_machine_says(call: Call) -> None:
    shown = json.loads(call("demo", "--json")[1])
    assert shown["controllability"]["mcexact"]["rank"] == 20
    (fixed,) = shown["fixed_modes"]["mcexact"]
    assert fixed == {"factor": "x - 1", "multiplicity_at_most": 3}
    assert shown["numpy"]["recorded"]["rank"] < 20
    assert shown["numpy"]["here"]["libraries"] == libraries_here().document()


def is_an_answer(entry: object) -> bool:
    """Whether an entry of the JSON of `analyze` is an answer with its certificate."""
    return isinstance(entry, dict) and "certificate" in entry


def test_analyze_writes_a_valid_certificate_for_every_answer(call: Call, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "evidence"
    status, out, err = call(
        "analyze", TRIPLE, "--json", "--subset", "u1", "--certificates", str(folder)
    )
    assert (status, err) == (0, "")
    answer = json.loads(out)
    named = {found["certificate"] for found in answer.values() if is_an_answer(found)}
    assert named | {"manifest.json"} == {path.name for path in folder.iterdir()}
    assert call("check", "--manifest", str(folder), "--system", TRIPLE)[0] == 0
    everything = [str(path) for path in folder.iterdir()]
    assert call("check", *everything, "--system", TRIPLE)[0] == 0
    files = [str(folder / name) for name in sorted(named)]
    status, out, _ = call("check", *files, "--system", TRIPLE)
    assert status == 0
    assert [line.split()[0] for line in out.splitlines()] == ["VALID"] * len(files)


def test_what_took_long_is_listed_and_a_question_that_is_left_out_can_be_named(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "took long" not in call("analyze", TRIPLE)[1]
    setpoint = replace(QUESTIONS["setpoint"], most=2)
    monkeypatch.setattr(
        "mcexact.analysis.analyze.Analysis.questions", {**QUESTIONS, "setpoint": setpoint}
    )
    text = call("analyze", TRIPLE)[1]
    assert says(text, "questions took")
    reason = "left out: more than 2 states, of which it needs dense matrices"
    assert reason in " ".join(text.split())
    assert "took long" not in call("analyze", TRIPLE, "--also", "setpoint")[1]
    assert call("analyze", TRIPLE, "--also", "wishes")[0] == 2


def test_certificates_can_name_the_system_by_its_digest(call: Call, tmp_path: Path) -> None:
    folders = {name: str(tmp_path / name) for name in ("whole", "named")}
    outputs = [
        call("analyze", TRIPLE, "--certificates", folders["whole"]),
        call("analyze", TRIPLE, "--certificates", folders["named"], "--system-by-digest"),
    ]
    assert outputs[0] == outputs[1]
    sizes = [(tmp_path / name / "transfer_graph.json").stat().st_size for name in folders]
    assert sizes[1] < sizes[0]
    checks = [call("check", "--manifest", each, "--system", TRIPLE)[1] for each in folders.values()]
    whole, named = (said.rpartition("; ")[0] for said in checks)  # without the manifest's digest
    assert whole == named.replace("named", "whole") != ""
    assert call("check", "--manifest", folders["named"])[0] == 5
    status, _, err = call("analyze", TRIPLE, "--system-by-digest")
    assert status == 2
    assert "give --certificates, too" in err


def test_the_same_input_gives_the_same_bytes(call: Call, tmp_path: Path) -> None:
    for name in ("first", "second"):
        call("analyze", TRIPLE, "--certificates", str(tmp_path / name))
    first, second = (
        {path.name: path.read_bytes() for path in (tmp_path / name).iterdir()}
        for name in ("first", "second")
    )
    assert first == second


def test_an_assertion_that_holds_is_status_0_and_one_that_does_not_is_1(call: Call) -> None:
    free = str(GALLERY / "quadruple-tank-pminus.json")
    assert call("analyze", free, "--assert", "no-fixed-modes")[0] == 0
    assert call("analyze", TRIPLE, "--assert", "no-fixed-modes")[0] == 1


def test_the_empty_subset_is_written_as_nothing(call: Call) -> None:
    answer = json.loads(call("analyze", TRIPLE, "--json", "--subset", "")[1])
    ranks = [found for name, found in answer.items() if name.startswith("pencil_rank_")]
    assert {tuple(rank["subset"]) for rank in ranks} == {()}


def test_check_ends_with_the_worst_status_in_its_order(call: Call, tmp_path: Path) -> None:
    call("analyze", TRIPLE, "--certificates", str(tmp_path))
    good = tmp_path / "fixed_spectrum.json"
    document = json.loads(good.read_text(encoding="ascii"))
    made = {
        "valid": document,
        "invalid": {**document, "claim": {**document["claim"], "stabilizable": True}},
        "incomplete": {**document, "kind": "wish"},
        "malformed": {**document, "verified": True},
    }
    files = {}
    for name, content in made.items():
        files[name] = str(tmp_path / f"{name}.json")
        Path(files[name]).write_text(json.dumps(content), encoding="ascii")
    assert call("check", files["valid"])[0] == 0
    assert call("check", files["valid"], files["incomplete"])[0] == 5
    assert call("check", files["incomplete"], files["invalid"])[0] == 1
    status, out, _ = call("check", *files.values())
    assert status == 3
    words = [line.split()[0] for line in out.splitlines()]
    assert words == ["VALID", "INVALID", "INCOMPLETE", "MALFORMED"]
    status, out, _ = call("check", "--json", *files.values())
    assert [row["verdict"] for row in json.loads(out)["verdicts"]] == words


def test_check_says_what_certificates_imply(call: Call, tmp_path: Path) -> None:
    status, out, _ = call("check", "--manifest", str(write(tmp_path)))
    found = {line.split()[0] for line in out.splitlines()}
    assert (status, found) == (0, {"VALID", "IMPLIED", "COUNTED"})
    (tmp_path / "neighbor_graph.json").unlink()
    status, out, _ = call("check", "--manifest", str(tmp_path), "--json")
    refused = [row for row in json.loads(out)["verdicts"] if row["verdict"] == "INVALID"]
    assert (status, refused[0]["file"]) == (1, "neighbor_graph.json")
    assert call("check")[0] == 2
    assert call("check", "--manifest", str(tmp_path), "--expect", "said.txt")[0] == 2


def test_check_refuses_what_cannot_be_asked(call: Call, tmp_path: Path) -> None:
    call("analyze", TRIPLE, "--certificates", str(tmp_path))
    asked = ("check", str(tmp_path / "fixed_spectrum.json"), "--controller", TRIPLE)
    status, out, err = call(*asked)
    assert (status, out, err.count(TRIPLE)) == (3, "", 1)
    status, out, _ = call(*asked, "--json")
    ((row),) = json.loads(out)["verdicts"]
    assert (status, row["file"], row["verdict"]) == (3, TRIPLE, "MALFORMED")
    assert call(*asked[:2], "--system", TRIPLE, "--max-bytes", "9")[0] == 5


def test_sample_draws_the_same_system_from_the_same_seed(call: Call) -> None:
    drawn = [call("sample", "--seed", seed, "--states", "5")[1] for seed in ("1", "1", "2")]
    assert drawn[0] == drawn[1] != drawn[2]


def test_sample_plants_a_fixed_mode_of_the_degree_that_was_asked_for(
    call: Call, tmp_path: Path
) -> None:
    for degree in ("1", "3"):
        out = call("sample", "--states", "5", "--channels", "3", "--plant-fixed-mode", degree)[1]
        file = tmp_path / "drawn.json"
        file.write_text(out, encoding="utf-8")
        answer = json.loads(call("analyze", str(file), "--json")[1])
        assert answer["joint_controllability"]["controllable"]
        assert answer["joint_observability"]["observable"]
        degrees = [len(f["polynomial"]) - 1 for f in answer["fixed_spectrum"]["factors"]]
        assert int(degree) in degrees


def test_sample_writes_many_files_and_neighbors_when_asked(call: Call, tmp_path: Path) -> None:
    options = ("--count", "3", "--seed", "7", "--neighbors", "--time", "discrete")
    assert call("sample", *options)[0] == 2
    assert call("sample", *options, "--output", str(tmp_path / "drawn"))[0] == 0
    files = sorted((tmp_path / "drawn").iterdir())
    assert [file.name for file in files] == ["sample-7.json", "sample-8.json", "sample-9.json"]
    for file in files:
        system = load_system(file)
        assert system.time == "discrete"
        assert system.neighbors is not None
        assert system.neighbors.is_strongly_connected()


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="there are no terminals here")
def test_a_terminal_gets_styles_and_a_pipe_gets_the_same_text_without(call: Call) -> None:
    import subprocess
    import sys

    terminal, end = os.openpty()
    with subprocess.Popen(
        [sys.executable, "-m", "mcexact", "analyze", TRIPLE],
        stdout=end,
        env=os.environ | {"TERM": "xterm", "COLUMNS": "80"},
    ) as process:
        os.close(end)
        drawn = b""
        while chunk := _read(terminal):
            drawn += chunk
        assert process.wait() == 0
    os.close(terminal)
    plain = call("analyze", TRIPLE)[1]
    assert "\x1b[1m" in drawn.decode() and "\x1b" not in plain
    assert re.sub(r"\x1b\[\d*m", "", drawn.decode()).replace("\r\n", "\n") == plain
    assert re.search(r"x - 1 +1 +no +3 +3 +\{u1\} +4\n", plain)


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # how Linux says that the other end was closed
        return b""


def test_a_folder_stands_for_its_manifest_or_its_certificates(call: Call, tmp_path: Path) -> None:
    write(tmp_path)
    every = sorted(map(str, tmp_path.glob("*.json")))
    status, out, _ = call("check", str(tmp_path))
    assert (status, call("check", *every)[1]) == (0, out)
    assert out == call("check", "--manifest", str(tmp_path / "manifest.json"))[1]
    assert "IMPLIED by 2: the mode 1" in out
    (tmp_path / "manifest.json").unlink()
    status, out, _ = call("check", str(tmp_path))
    assert (status, {line.split()[0] for line in out.splitlines()}) == (0, {"VALID"})
    assert len(out.splitlines()) == len(every) - 1


def test_the_controller_is_asked_of_loops_among_several_certificates(
    call: Call, tmp_path: Path
) -> None:
    made = ("design", "decentralized", DOUBLE, "--rate", "1", "-o", str(tmp_path / "controller"))
    call(*made, "--certificates", str(tmp_path / "loop"))
    call("analyze", DOUBLE, "--certificates", str(tmp_path / "plant"))
    asked = ("--system", DOUBLE, "--controller", str(tmp_path / "controller"))
    loop, plant = (str(tmp_path / each) for each in ("loop/stability.json", "plant/setpoint.json"))
    assert call("check", str(tmp_path / "loop"), *asked)[0] == 0
    assert call("check", loop, plant, *asked)[0] == 0
    status, out, _ = call("check", plant, *asked)
    assert (status, out.split(" controller")[0]) == (1, "NOT ABOUT")
    status, out, _ = call("check", plant, plant, *asked)
    assert (status, [line.split(" '")[0] for line in out.splitlines()]) == (
        1,
        ["VALID", "VALID", "NOT ABOUT"],
    )


def test_an_audit_is_a_page_with_what_is_proved_and_how_to_repeat_it(
    call: Call, tmp_path: Path
) -> None:
    folder, page = tmp_path / "a folder", tmp_path / "audit.html"
    folder.mkdir()
    write(folder)
    assert call("check", str(folder), "--html", str(page))[0] == 0
    text = page.read_text("utf-8")
    assert f"python -I mcexact-checker.pyz &#x27;{folder}&#x27;" in text
    assert "letter by letter" in text and says(text, "given compare")
    assert text.count("VALID") == len(list(folder.iterdir()))
    (folder / "neighbor_graph.json").write_text("{}")
    assert call("check", str(folder), "--html", str(page))[0] == 1
    assert says(page.read_text("utf-8"), "bytes names")
    file = str(folder / "manifest.json")
    assert call("check", file, "--html", file)[0] == 3


def test_a_pattern_is_asked_about_without_its_numbers(call: Call, tmp_path: Path) -> None:
    folder = tmp_path / "proofs"
    asked = ("analyze", UNLINKED, "--pattern")
    status, out, _ = call(*asked, "--certificates", str(folder))
    assert status == 0 and "fixed modes  those of state 3" in out
    assert call("check", str(folder), "--system", UNLINKED)[0] == 0
    told = json.loads(call(*asked, "--json")[1])
    assert {"structural_fixed_modes"} == {key for key in told if key.endswith("modes")}


@pytest.mark.parametrize(
    "more",
    [
        ("--uncertainty", "1%"),
        ("--modulo", "both"),
        ("--assert", "no-fixed-modes"),
        ("--failures",),
        ("--subset", "1"),
    ],
)
def test_what_needs_numbers_is_not_asked_of_a_pattern(call: Call, more: tuple[str, ...]) -> None:
    status, _, err = call("analyze", UNLINKED, "--pattern", *more)
    assert status == 2 and "--pattern" in err
