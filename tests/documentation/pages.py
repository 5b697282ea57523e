"""Runs a page: files are written, commands and Python examples are executed, outputs compared.

- A block ``{code-block}`` with a caption is a file of that name, and so is one of ``json`` below a
  line that ends with the name in backquotes and a colon.
- In a block ``console`` a line that begins with ``$`` is a command, mcexact or python; a backslash
  at its end continues it.  The lines below are what it prints; ``...`` stands for any text.
  ``# status 1`` after a command is its status.  A block of the class ``processor`` is run and not
  compared: its numbers depend on the processor.
- A block ``pycon`` is a doctest.  All of them share their names, and the folder of the page.
"""

from __future__ import annotations

import contextlib
import doctest
import io
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcexact.cli import main

FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
_BLOCK = re.compile(
    r"^(?P<fence>`{3,})(?:\{code-block\} *)?(?P<language>\w+)\n"
    r"(?P<options>(?::[\w-]+:[^\n]*\n)*)(?P<text>.*?)^(?P=fence)$",
    re.MULTILINE | re.DOTALL,
)
_NAMED = re.compile(r"`([\w-]+\.json)`:\n\n`{3,}$")
_STATUS = re.compile(r" +# status (\d+)$")


@dataclass(frozen=True)
class Block:
    """A block of code: its language, its options, its text, and the line where it begins."""

    language: str
    options: dict[str, str]
    text: str
    line: int


def blocks(page: str) -> Iterator[Block]:
    """Yield the blocks of code of a page in their order."""
    for found in _BLOCK.finditer(page):
        options = dict(re.findall(r"^:([\w-]+): *(.*)$", found["options"], re.MULTILINE))
        if named := _NAMED.search(page, 0, found.end("fence")):
            options.setdefault("caption", named[1])
        line = page.count("\n", 0, found.start("text"))
        yield Block(found["language"], options, found["text"], line)


def run(path: Path, folder: Path) -> int:
    """Run a page in a folder, and return how many examples and commands it had.

    Raises
    ------
    AssertionError
        If an output is another than the page says.
    """
    names: dict[str, Any] = {"__name__": "__main__"}
    done = 0
    with contextlib.chdir(folder):
        for block in blocks(path.read_text(encoding="utf-8")):
            if "caption" in block.options:
                Path(block.options["caption"]).write_text(block.text, encoding="utf-8")
            elif block.language == "console":
                done += _commands(block, path)
            elif block.language == "pycon":
                done += _examples(block, path, names)
    return done


def _examples(block: Block, path: Path, names: dict[str, Any]) -> int:
    """Run a block of doctests with the names of the blocks before it."""
    test = doctest.DocTestParser().get_doctest(block.text, names, path.name, str(path), block.line)
    said: list[str] = []
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    runner.run(test, out=said.append, clear_globs=False)
    names.update(test.globs)
    assert runner.failures == 0, "".join(said)
    return len(test.examples)


def _commands(block: Block, path: Path) -> int:
    """Run the commands of a block and compare what they print."""
    text = block.text.replace("\\\n", "")
    parts = re.split(r"^\$ (.*)\n", text, flags=re.MULTILINE)[1:]
    for call, wanted in zip(parts[::2], parts[1::2], strict=True):
        status = int(found[1]) if (found := _STATUS.search(call)) else 0
        program, *arguments = shlex.split(_STATUS.sub("", call))
        ended, out, err = RUNNERS[program](arguments)
        place = f"{path.name}:{block.line}: $ {call}"
        assert ended == status, f"{place}\n{out}{err}"
        if "processor" in block.options.get("class", ""):
            wanted = "..."
        checker = doctest.OutputChecker()
        example = doctest.Example(call, wanted)
        if not checker.check_output(wanted, out, FLAGS):
            raise AssertionError(f"{place}\n{checker.output_difference(example, out, FLAGS)}")
    return len(parts) // 2


def _python(arguments: list[str]) -> tuple[int, str, str]:
    """Run this Python: its status, and what it prints."""
    done = subprocess.run([sys.executable, *arguments], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def called(arguments: list[str]) -> tuple[int, str, str]:
    """Run a command in this process: its status, and what it prints."""
    out, err = io.StringIO(), io.StringIO()
    before = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "80"
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            main(arguments)
    except SystemExit as ended:
        assert isinstance(ended.code, int)
        return ended.code, out.getvalue(), err.getvalue()
    finally:
        if before is None:
            del os.environ["COLUMNS"]
        else:
            os.environ["COLUMNS"] = before
    raise AssertionError(arguments)


RUNNERS = {"mcexact": called, "python": _python}
