"""Documents on which the checker answers otherwise after a change, in a fork of this process."""

from __future__ import annotations

import importlib.abc
import importlib.util
import os
import signal
import sys
from collections.abc import Sequence
from types import CodeType, ModuleType
from typing import Any

from tests.checker.kept import Case, answer

NONE, HANGS, UNLOADABLE = -1, -2, -3
SECONDS = 5.0
"""Of processor time for one document."""


class Changed(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Loads one module of the checker from changed code."""

    def __init__(self, stem: str, code: CodeType) -> None:
        self.names = {f"mcexact.checker.{stem}", f"mcexact.checker.core.{stem}"}
        self.code = code

    def find_spec(self, name: str, path: Any, target: Any = None) -> Any:
        return importlib.util.spec_from_loader(name, self) if name in self.names else None

    def exec_module(self, module: ModuleType) -> None:
        exec(self.code, module.__dict__)


def telling(stem: str, code: CodeType, cases: Sequence[Case]) -> int:
    """The first case that is answered otherwise with a change, or ``NONE``.

    ``HANGS`` says that one is not answered in time, and ``UNLOADABLE`` that the changed file cannot
    even be loaded.  It is what the tests of these documents find, without collecting them.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if not child:
        os.close(reader)
        signal.signal(signal.SIGVTALRM, signal.SIG_DFL)
        os.write(writer, str(_first(stem, code, cases)).encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as stream:
        said = stream.read()
    os.waitpid(child, 0)
    return int(said) if said else HANGS


def _first(stem: str, code: CodeType, cases: Sequence[Case]) -> int:
    devnull = os.open(os.devnull, os.O_WRONLY)
    os.dup2(devnull, 1)
    os.dup2(devnull, 2)
    for name in [name for name in sys.modules if name.startswith("mcexact.checker")]:
        del sys.modules[name]
    sys.meta_path.insert(0, Changed(stem, code))
    try:
        signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
        importlib.import_module("mcexact.checker.kinds")
    except BaseException:
        return UNLOADABLE
    for k, case in enumerate(cases):
        signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
        try:
            found = answer(case)
        except BaseException:
            found = "an exception"
        if found != case["answer"]:
            return k
    return NONE
