"""`mcexact sample`: what is drawn is bounded, by its size, by time and by memory."""

import sys
from pathlib import Path

import pytest

from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.errors import LimitReached
from mcexact.model.system_file import read_system
from tests.end_to_end.command_line import run
from tests.wording import says


@pytest.mark.parametrize("size", ["--states=100000000", "--channels=1000000000", "--states=5000"])
def test_a_system_that_no_file_could_hold_is_not_drawn(size: str) -> None:
    done = run("sample", size)
    assert done.status == 4
    assert says(done.messages[-1], "draw fewer")


def test_the_size_is_judged_before_anything_is_drawn() -> None:
    with pytest.raises(LimitReached, match="100000000 channels has 200000000 numbers or more"):
        drawn_system(Draw(0, states=0, channels=10**8))


def test_drawing_keeps_a_time_limit() -> None:
    done = run("sample", "--states", "3000", "--timeout", "0.5")
    assert done.status == 4
    assert says(done.messages[-1], "while drawing") and "0.5 s" in done.messages[-1]


@pytest.mark.skipif(sys.platform != "linux", reason="there the limit is defined")
def test_drawing_keeps_a_memory_limit() -> None:
    done = run("sample", "--states", "3000", "--max-memory", "20")
    assert done.status == 4
    assert says(done.messages[-1], "mib drawing") and "20 MiB" in done.messages[-1]


def test_what_is_drawn_in_a_process_of_its_own_is_the_same_system(tmp_path: Path) -> None:
    folder = tmp_path / "drawn"
    assert run("sample", "--seed", "5", "--count", "2", "-o", str(folder)).status == 0
    for seed in (5, 6):
        made = (folder / f"sample-{seed}.json").read_bytes()
        assert read_system(made) == drawn_system(Draw(seed))
