"""What cannot be written is refused before the work, and work that fails leaves nothing behind."""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mcexact.cli import convert, design, main, reproduce, running, sweep
from mcexact.cli.files import require_apart, require_writable
from mcexact.errors import InputError, LimitReached, NotWritten
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from tests.wording import refusal, says, worded

WRITING = {
    "analyze --html": ("analyze", "PLANT", "--html", "FILE"),
    "analyze --certificates": ("analyze", "PLANT", "--certificates", "FOLDER"),
    "allocate --certificates": ("allocate", "PLANT", "--certificates", "FOLDER"),
    "certify --certificates": ("certify", "PLANT", "PLANT", "--certificates", "FOLDER"),
    "crosscheck --html": ("crosscheck", "--exhibits", "--html", "FILE"),
    "design decentralized -o": ("design", "decentralized", "PLANT", "--rate=1", "-o", "FILE"),
    "design extended -o": ("design", "extended", "PLANT", "--rate=1", "-o", "FILE"),
    "design setpoint -o": ("design", "setpoint", "PLANT", "--rate=1", "-o", "FILE"),
    "design observer -o": ("design", "observer", "PLANT", "--rate=1", "-o", "FILE"),
    "design observer --certificates": (
        *("design", "observer", "PLANT", "--rate=1", "--certificates", "FOLDER"),
    ),
    "design extended --certificates": (
        *("design", "extended", "PLANT", "--rate=1", "--certificates", "FOLDER"),
    ),
    "reproduce -o": ("reproduce", "-o", "FOLDER"),
    "sample -o": ("sample", "-o", "FOLDER"),
    "c2d -o": ("c2d", "PLANT", "--step", "1/10", "-o", "FILE"),
    "simulate -o": ("simulate", "PLANT", "PLANT", "-o", "FILE.csv"),
    "sweep -o": ("sweep", "PLANT", "-o", "FILE"),
    "sweep --certificates": ("sweep", "PLANT", "--certificates", "FOLDER"),
}

Ended = Callable[..., tuple[int, str]]


@pytest.fixture
def ended(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Ended:
    """Run a command in this process: its status, and what it says on standard error."""
    plant = tmp_path / "plant.json"
    save_system(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), plant)

    def run(arguments: tuple[str, ...], place: Path) -> tuple[int, str]:
        filled = [
            each.replace("PLANT", str(plant)).replace("FILE", str(place / "result"))
            if each != "FOLDER"
            else str(place / "results" / "deep")
            for each in arguments
        ]
        with pytest.raises(SystemExit) as exit_:
            main(filled)
        assert isinstance(exit_.value.code, int)
        return exit_.value.code, capsys.readouterr().err

    return run


def working(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Replace all work by a limit that is reached; the list says how often there was any."""
    begun: list[str] = []

    def limited(*_: Any, **options: Any) -> Any:
        begun.append(options.get("doing", "sweeping"))
        raise LimitReached("the work was begun")

    for module in (convert, design, reproduce, running, sweep):
        monkeypatch.setattr(module, "supervised", limited)
    monkeypatch.setattr("mcexact.sweeps.run.sweep", limited)
    return begun


@pytest.mark.parametrize("arguments", WRITING.values(), ids=WRITING.keys())
def test_a_place_that_cannot_be_written_is_refused_before_the_work(
    ended: Ended, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    begun = working(monkeypatch)
    barrier = tmp_path / "barrier"
    barrier.write_text("no folder", encoding="ascii")
    status, told = ended(arguments, barrier)
    assert (status, begun) == (74, [])
    assert "cannot write: Not a directory" in told


@pytest.mark.parametrize("arguments", WRITING.values(), ids=WRITING.keys())
def test_work_that_fails_leaves_no_file_or_folder_behind(
    ended: Ended, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    begun = working(monkeypatch)
    place = tmp_path / "place"
    place.mkdir()
    status, _ = ended(arguments, place)
    assert (status, len(begun)) == (4, 1)
    assert list(place.iterdir()) == []


def test_an_existing_file_is_not_touched(tmp_path: Path) -> None:
    file = tmp_path / "result.json"
    file.write_text("earlier", encoding="ascii")
    require_writable(file, tmp_path)
    assert file.read_text(encoding="ascii") == "earlier"
    assert [path.name for path in tmp_path.iterdir()] == ["result.json"]


@pytest.mark.parametrize(
    ("file", "message"),
    [
        ("missing/result.json", "cannot write: No such file or directory"),
        ("folder", "cannot write: it is no file"),
        ("x" * 1000, "cannot write: File name too long"),
        ("loop/result", "cannot write: Too many levels of symbolic links"),
    ],
)
def test_a_file_that_cannot_be_made_is_refused_with_the_reason(
    tmp_path: Path, file: str, message: str
) -> None:
    (tmp_path / "folder").mkdir()
    os.symlink("loop", tmp_path / "loop")
    with pytest.raises(NotWritten, match=message):
        require_writable(tmp_path / file)


def test_what_is_no_name_of_a_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is not a file name"):
        require_writable(tmp_path / "a\0b")


def test_a_folder_where_a_file_stands_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="ascii")
    with pytest.raises(NotWritten, match="cannot be made a directory"):
        require_writable(None, tmp_path / "file")


def test_a_file_may_go_into_the_folder_that_is_made_for_other_results(tmp_path: Path) -> None:
    made = tmp_path / "evidence" / "deep"
    require_writable(made / "controller.json", made)
    require_writable(tmp_path / "evidence" / "controller.json", made)
    with refusal(NotWritten):
        require_writable(tmp_path / "elsewhere" / "controller.json", made)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not os.path.exists("/dev/null"), reason="there are no devices")
def test_a_device_is_written_as_it_is() -> None:
    require_writable(Path("/dev/null"))


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a full device")
def test_output_that_cannot_be_written_ends_with_74(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for closed in (False, True):
        with open("/dev/full", "w") as full, pytest.raises(SystemExit) as ended:
            monkeypatch.setattr(sys, "stdout", None if closed else full)
            main(["sample"])
        assert ended.value.code == 74
        monkeypatch.undo()
        [line] = capsys.readouterr().err.splitlines()
        assert line.startswith("mcexact: standard output: cannot be written: ")


NEEDS_NEIGHBORS = ("allocate", "design extended", "design observer")
ABLE = {name: each for name, each in WRITING.items() if not name.startswith(NEEDS_NEIGHBORS)}
"""The commands that do something with one integrator alone."""
FULL = {
    name: tuple("/dev/full" if each in ("FILE", "FILE.csv") else each for each in arguments)
    for name, arguments in ABLE.items()
    if "FOLDER" not in arguments and name not in ("simulate -o", "sweep -o")
}


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a full device")
@pytest.mark.parametrize("arguments", FULL.values(), ids=FULL.keys())
def test_every_file_that_cannot_be_written_ends_with_74(
    ended: Ended, tmp_path: Path, arguments: tuple[str, ...]
) -> None:
    status, told = ended(arguments, tmp_path)
    assert status == 74 and worded(told.splitlines()[-1])


@pytest.mark.parametrize("arguments", ABLE.values(), ids=ABLE.keys())
def test_every_command_says_what_it_wrote(
    ended: Ended, tmp_path: Path, arguments: tuple[str, ...]
) -> None:
    place = tmp_path / "place"
    place.mkdir()
    controller = tmp_path / "controller.json"
    ended(("design", "decentralized", "PLANT", "--rate=1", "-o", str(controller)), place)
    if arguments[0] in ("certify", "simulate"):
        arguments = (arguments[0], "PLANT", str(controller), *arguments[3:])
    status, told = ended(arguments, place)
    assert status in (0, 1)
    said = [line for line in told.splitlines() if line.startswith("mcexact: wrote ")]
    files = [path for path in place.rglob("*") if path.is_file()]
    if "FOLDER" in arguments:
        number = f"{len(files)} file{'s' if len(files) > 1 else ''}"
        assert said == [f"mcexact: wrote {number} into {place / 'results' / 'deep'}/"]
    else:
        assert said == [f"mcexact: wrote {path}" for path in files] and len(files) == 1


def test_nothing_is_said_of_a_stream(ended: Ended, tmp_path: Path) -> None:
    _, told = ended(("analyze", "PLANT", "--html", os.devnull), tmp_path)
    assert "wrote" not in told


TWICE = {
    "design": ("design", "decentralized", "PLANT", "--rate=1", "-o", "FILE", "--html", "FILE"),
    "certify": (
        *("certify", "PLANT", "PLANT", "--round-gains", "3", "-o", "FILE"),
        *("--html", "FILE"),
    ),
    "sweep": ("sweep", "PLANT", "-o", "FILE", "--html", "FILE"),
    "analyze": ("analyze", "PLANT", "--html", "FOLDER", "--certificates", "FOLDER"),
    "allocate": ("allocate", "PLANT", "--html", "FOLDER", "--certificates", "FOLDER"),
    "simulate": ("simulate", "PLANT", "PLANT", "-o", "FILE.csv", "--certificates", "FILE.csv"),
}


@pytest.mark.parametrize("arguments", TWICE.values(), ids=TWICE.keys())
def test_two_results_do_not_go_to_one_place(
    ended: Ended, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    begun = working(monkeypatch)
    place = tmp_path / "place"
    (place / "results").mkdir(parents=True)
    status, told = ended(arguments, place)
    assert (status, begun) == (3, [])
    assert says(told, "results written")


def test_one_place_has_two_names(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to("folder")
    with refusal(InputError):
        require_apart(tmp_path / "folder" / "new.json", None, tmp_path / "link" / "new.json")
    require_apart(tmp_path / "folder" / "new.json", tmp_path / "folder" / "other.json", None)
    require_apart(Path(os.devnull), Path(os.devnull))
