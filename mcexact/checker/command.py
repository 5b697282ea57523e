"""The command line: one line a file, and an exit status for all of them."""

from __future__ import annotations

import argparse
import io
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import TextIO

from .kinds import Verdict, check_document
from .reading import Limits, Refused
from .system import digest, read_system_file

PRECEDENCE = (70, 3, 1, 5, 0)


def read_file(path: str, limits: Limits) -> bytes:
    """The bytes of a file, or of standard input for ``-``; one more than the limit is enough."""
    try:
        if path == "-":
            return sys.stdin.buffer.read(limits.bytes + 1)
        with open(path, "rb") as stream:
            return stream.read(limits.bytes + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise Refused(
            "MALFORMED", "unreadable", ascii(path)[1:-1], f"cannot be read: {reason}"
        ) from error


def verdicts(paths: Sequence[str], system: str | None, limits: Limits) -> Iterator[Verdict]:
    """The verdict on each file.

    Raises
    ------
    Refused
        If the system file cannot be read.
    """
    wanted = None if system is None else digest(read_system_file(read_file(system, limits), limits))
    for path in paths:
        try:
            data = read_file(path, limits)
        except Refused as found:
            yield Verdict(found.verdict, "", "", found.code, found.place, found.message)
        else:
            yield check_document(data, wanted, limits)


def report(
    paths: Sequence[str],
    system: str | None = None,
    as_json: bool = False,
    limits: Limits | None = None,
    out: TextIO | None = None,
) -> int:
    """Check the files, print one line for each (or one JSON document), return the exit status.

    Parameters
    ----------
    paths : sequence of str
        ``-`` is standard input.
    system : str, optional
        A system file that every certificate must be about.
    as_json : bool, optional
    limits : Limits, optional
    out : text stream, optional
        Standard output by default.

    Returns
    -------
    int
        The first that applies of 70, 3, 1, 5, 0.
    """
    stream, found = out or sys.stdout, []
    try:
        for verdict in verdicts(paths, system, limits or Limits()):
            found.append(verdict)
            if not as_json:
                print(verdict.line(), file=stream, flush=True)
    except Refused as error:
        print(f"mcexact check: {system}: {error.place}: {error.message}", file=sys.stderr)
        return 3
    if as_json:
        rows = [{"file": path, **asdict(v)} for path, v in zip(paths, found, strict=True)]
        print(json.dumps({"verdicts": rows}, indent=1), file=stream)
    return next(status for status in PRECEDENCE if status in {0, *(v.status for v in found)})


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; wrong usage ends with status 2, an interruption with 130."""
    limits = Limits()
    parser = argparse.ArgumentParser(prog="checker", description=__doc__, allow_abbrev=False)
    parser.add_argument(
        "files", nargs="+", metavar="FILE", help="certificates; - is standard input"
    )
    parser.add_argument("--system", metavar="FILE", help="insist on certificates about its system")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    for name in ("bytes", "digits", "depth"):
        parser.add_argument(f"--max-{name}", type=int, default=getattr(limits, name), metavar="N")
    options = parser.parse_args(arguments)
    sys.set_int_max_str_digits(0)
    # Never a traceback for a character that the terminal's encoding lacks.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    limits = Limits(options.max_bytes, options.max_depth, options.max_digits)
    try:
        return report(options.files, options.system, options.json, limits)
    except KeyboardInterrupt:
        return 130
