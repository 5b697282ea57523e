"""Exported C, compiled and called: the code itself in the loop, not a model of it.

`compiled_agents` writes the files of `export.code` into a folder of its own, compiles them into a
shared library with the C compiler of this machine, and calls its functions through ctypes.  The
agents that it returns are called as `AgentRun` is, and compute the same bits: the compiler is told
to leave products and sums apart.
"""

from __future__ import annotations

import ctypes
import os
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mcexact.errors import InternalError, UsageError
from mcexact.export.code import export_controller
from mcexact.export.equations import CONTROLLER, EQUATIONS, AgentStep, Kind, steps_of
from mcexact.export.fixed import FixedPoint
from mcexact.model.controller import Controller

FLAGS = ("-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off")
"""How exported code compiles; the last one forbids that a product and a sum are rounded once."""


def compiler() -> list[str]:
    """Return the command of the C compiler: that of the variable CC, else cc, gcc or clang.

    Raises
    ------
    UsageError
        If there is none.
    """
    command = shlex.split(os.environ.get("CC", ""))
    named = [command] if command else [["cc"], ["gcc"], ["clang"]]
    for words in named:
        if shutil.which(words[0]) is not None:
            return words
    tried = ", ".join(words[0] for words in named)
    raise UsageError(
        f"compiled code needs a C compiler, and there is none here (tried {tried}): install one, "
        "or name it in the environment variable CC, or run the code in doubles instead"
    )


def compiled_library(files: Mapping[str, str]) -> ctypes.CDLL:
    """Compile files of C into a shared library, without a warning, and load it.

    Parameters
    ----------
    files : mapping of str to str
        Their texts by name.

    Raises
    ------
    UsageError
        If there is no C compiler.
    InternalError
        If they do not compile.
    """
    command = compiler()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in files.items():
            (folder / file).write_text(text, encoding="ascii")
        sources = sorted(file for file in files if file.endswith(".c"))
        command += [*FLAGS, "-shared", "-fPIC", *sources, "-o", "code.so"]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise InternalError(f"exported code does not compile: {done.stderr}")
        return ctypes.CDLL(str(folder / "code.so"))


class CompiledAgent:
    """An agent whose step is a function of a shared library.

    Signals are doubles here, as for `AgentRun` and `FixedAgent`.

    Parameters
    ----------
    library : ctypes.CDLL
    steps : sequence of AgentStep
    position : int
    fixed : FixedPoint, optional
        The arithmetic of the code, by default doubles.
    """

    def __init__(
        self,
        library: ctypes.CDLL,
        steps: Sequence[AgentStep],
        position: int,
        fixed: FixedPoint | None = None,
    ) -> None:
        self._library, self._steps, self.step = library, steps, steps[position]
        self._fixed = fixed
        self._type: Any = ctypes.c_double if fixed is None else ctypes.c_int32
        states = (self.step.remembered + 1) * len(self.step.x) + len(self.step.z)
        self._state = (self._type * max(states, 1))()
        self._call("reset")

    def _call(self, function: str, *arguments: Any) -> None:
        getattr(self._library, f"{self.step.identifier}_{function}")(self._state, *arguments)

    def _array(self, kind: str, values: Sequence[float]) -> Any:
        numbers = values if self._fixed is None else self._fixed.integers(kind, values)
        return (self._type * len(values))(*numbers)

    def _doubles(self, kind: str, array: Any) -> list[float]:
        return list(array) if self._fixed is None else self._fixed.doubles(kind, list(array))

    def start(self, y: Sequence[float], r: Sequence[float]) -> None:
        """Put the states at rest; see `AgentRun`.  The code has this where the step has a start."""
        given = [(kind, own) for kind, own in (("y", y), ("r", r)) if own]
        self._call("start", *(self._array(kind, own) for kind, own in given))

    def sent_to(self, follower: int) -> list[float]:
        """What a follower receives of x in this step, before delays."""
        x = self._array("x", [0.0] * len(self.step.x))
        self._call(f"send_to_{self._steps[follower].identifier}", x)
        return self._doubles("x", x)

    def __call__(
        self,
        y: Sequence[float],
        r: Sequence[float],
        received: Mapping[tuple[Kind, int], Sequence[float]],
    ) -> list[float]:
        """Run one step, and return the inputs; see `AgentRun`."""
        step, u = self.step, self._array("u", [0.0] * len(self.step.u))
        arguments = [self._array("y", y[: step.outputs])] * bool(step.outputs)
        arguments += [self._array("r", r[: step.references])] * bool(step.references)
        arguments += [self._array(kind, received[kind, j]) for kind, j, _ in step.received]
        self._call("step", *arguments, *[u] * bool(step.u))
        return self._doubles("u", u)


def compiled_agents(controller: Controller, fixed: FixedPoint | None = None) -> list[CompiledAgent]:
    """Compile a controller, and return its agents.

    Parameters
    ----------
    controller : Controller
        In discrete time.
    fixed : FixedPoint, optional
        The arithmetic, by default doubles.

    Raises
    ------
    UsageError
        If there is no C compiler, or the controller is in continuous time.
    """
    steps, files = steps_of(controller), export_controller(controller, "c", fixed)
    del files[EQUATIONS], files[CONTROLLER]
    library = compiled_library(files)
    return [CompiledAgent(library, steps, i, fixed) for i in range(len(steps))]
