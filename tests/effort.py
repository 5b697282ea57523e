"""Work that is counted and not timed: what passes here passes on a slow and busy machine too.

    python -m tests.effort STEPS ARGUMENT…

runs ``mcexact`` with these arguments and lets it do so much work and no more.
"""

from __future__ import annotations

import os
import runpy
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import CodeType, FrameType
from typing import Any

import mcexact

PATIENCE = 900.0
"""Seconds after which a test gives up a process that hangs; no test concludes anything from it."""

_PACKAGE = os.path.dirname(mcexact.__file__) + os.sep


class TooMuchWork(BaseException):
    """More steps were taken than are allowed; no handler of errors takes it for one of its own."""


@contextmanager
def at_most(steps: int) -> Iterator[None]:
    """Stop the work inside as soon as the package's own functions have taken more steps than that.

    A step is a line that is run, or a return; a line that is a loop counts in each turn.  Processes
    that are forked inside may take as many each.  What modules do when they are first imported is
    free, since it depends on what was imported before.

    Raises
    ------
    TooMuchWork
        At the first step too many.
    """
    left = steps
    counted: dict[CodeType, bool] = {}

    def count(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal left
        left -= 1
        if left < 0:
            raise TooMuchWork(f"more than {steps} steps were taken")
        return count

    def enter(frame: FrameType, event: str, argument: Any) -> Any:
        code = frame.f_code
        if code not in counted:
            own = code.co_filename.startswith(_PACKAGE)
            counted[code] = own and code.co_name != "<module>"
        return count if counted[code] else None

    before = sys.gettrace()
    sys.settrace(enter)
    try:
        yield
    finally:
        sys.settrace(before)


if __name__ == "__main__":
    _, most, *sys.argv[1:] = sys.argv
    with at_most(int(most)):
        runpy.run_module("mcexact", run_name="__main__", alter_sys=True)
