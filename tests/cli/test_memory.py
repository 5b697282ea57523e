"""Too little memory is a limit that was reached, in whatever way the work dies of it."""

import errno
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from mcexact.cli import running
from mcexact.cli.running import supervised
from mcexact.errors import InternalError, LimitReached, UsageError
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from tests.end_to_end.command_line import run
from tests.wording import refusal

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="there the limit is defined")
_PLENTY = 500  # MiB


class TooLargeToSend:
    """A result that cannot be pickled for lack of memory."""

    def __reduce__(self) -> str:
        raise MemoryError


def unmapped_library() -> None:
    raise ImportError("libopenblas.so: failed to map segment from shared object")


def library_not_set_up() -> None:
    raise SystemError("error return without exception set")


def no_room_for_a_process() -> None:
    raise OSError(errno.ENOMEM, os.strerror(errno.ENOMEM))


def wrapped() -> None:
    try:
        raise MemoryError
    except MemoryError as error:
        raise InternalError("the integer program could not be solved") from error


def too_large_to_send() -> TooLargeToSend:
    return TooLargeToSend()


def ended_by_a_library() -> None:
    os._exit(1)


def thread_not_started() -> None:
    """What OpenBLAS does where pthread_create fails."""
    os.kill(os.getpid(), signal.SIGINT)


def aborted() -> None:
    os.abort()


def fill_and_misread() -> None:
    """An error that follows from memory that is nearly gone, and does not say so."""
    filled = []
    try:
        while True:
            filled.append(bytearray(1 << 20))
    except MemoryError:
        pass
    error = SyntaxError("expected ':'")
    raise error from None


def missing_library() -> None:
    raise ModuleNotFoundError("no module named 'control'")


def mistaken() -> None:
    raise KeyError("surprise")


def ended_by_somebody() -> None:
    os.kill(os.getpid(), signal.SIGTERM)


@pytest.mark.parametrize(
    "work",
    [
        unmapped_library,
        library_not_set_up,
        no_room_for_a_process,
        wrapped,
        too_large_to_send,
        ended_by_a_library,
        thread_not_started,
        aborted,
        fill_and_misread,
    ],
)
def test_every_way_to_die_of_a_memory_limit_names_the_limit(work: Callable[[], None]) -> None:
    with refusal(LimitReached, quantity="500 MiB"):
        supervised(work, doing="working", max_memory=_PLENTY, libraries=())


@pytest.mark.parametrize("work", [no_room_for_a_process, wrapped, too_large_to_send])
def test_memory_can_be_exhausted_without_a_limit(work: Callable[[], None]) -> None:
    with refusal(LimitReached):
        supervised(work, doing="working")


@pytest.mark.parametrize("work", [missing_library, mistaken, ended_by_somebody])
def test_a_limit_with_room_to_spare_explains_no_bug(work: Callable[[], None]) -> None:
    with pytest.raises(InternalError):
        supervised(work, doing="working", max_memory=_PLENTY, libraries=())


@pytest.mark.parametrize("work", [unmapped_library, library_not_set_up, ended_by_a_library])
def test_without_a_limit_the_same_deaths_are_bugs(work: Callable[[], None]) -> None:
    with pytest.raises(InternalError):
        supervised(work, doing="working")


@pytest.mark.parametrize("mebibytes", ["1", "20", "100"])
@pytest.mark.parametrize(
    "command", [("crosscheck",), ("design", "decentralized", "--rate=1/2", "--arithmetic=float")]
)
def test_a_command_with_too_little_memory_ends_with_status_4_and_says_so(
    tmp_path: Path, command: tuple[str, ...], mebibytes: str
) -> None:
    plant = tmp_path / "plant.json"
    save_system(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), plant)
    done = run(*command, str(plant), "--max-memory", mebibytes)
    assert done.status in (0, 4), done.stderr
    if done.status == 4:
        assert f"memory limit of {mebibytes} MiB was exhausted" in done.messages[-1]
    if mebibytes == "1":
        assert done.status == 4


@pytest.mark.parametrize("missing", ["resource", "the limit", "the size of the process"])
def test_a_platform_that_does_not_limit_memory_is_named(
    missing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    import resource

    if missing == "resource":
        monkeypatch.setitem(sys.modules, "resource", None)
    elif missing == "the limit":
        monkeypatch.delattr(resource, "RLIMIT_AS")
    else:
        monkeypatch.setattr(running, "_kibibytes", lambda name: 0)
    with refusal(UsageError):
        supervised(os.getpid, doing="working", max_memory=_PLENTY)
