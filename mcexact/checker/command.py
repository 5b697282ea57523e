"""Verify certificates, and print one line for each.

The line is VALID, the SHA-256 of the statement that the certificate proves, and this statement; or
INVALID, MALFORMED or INCOMPLETE, a code and a place.  With several files it names its file.  A file
named manifest.json is read as a manifest.  With --controller there is nothing else in the loop
unless --expect says so.  Work is limited by default to 40,000,000 units and 4,000 for each byte,
four times as many if the plant has a parameter.
"""

import argparse
import errno
import io
import json
import os
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from typing import IO, NoReturn

from .allowance import SUPPORTED, Clock, OutOfTime, memory
from .expectation import CLAIM, Expectation
from .kinds import Found, Verdict, attempt, check_document
from .manifest import NAME, manifest_verdicts
from .reading import Limits, read_file
from .statement import counted

PRECEDENCE = (70, 3, 1, 5, 0)
"""Of these statuses the first that any verdict has is that of the run."""
FORMAT = "mcexact-verdicts/1"
UNWRITTEN = 74
"""The status if the verdicts cannot be written."""


Asking = Sequence[str | None]
"""The files that hold a system, a controller, and a statement or claim; None for any."""


class NotAsked(Exception):
    """What a file asks cannot be read; the verdict on this file says why."""

    def __init__(self, path: str, verdict: Verdict) -> None:
        place = f"{ascii(path)[1:-1]}: {verdict.place}"
        super().__init__(as_options(f"{place}: {verdict.message}"))
        self.found: Found = {"file": path}, verdict


def as_options(text: str) -> str:
    """A message that names the limits as options."""
    return text.replace("(Limits.", "(--max-")


def line_of(found: Found, paths: Sequence[str]) -> str:
    """A verdict as one line, with the name of its file behind it if there are several."""
    about, verdict = found
    name = about.get("manifest") or about["file"]
    return as_options(verdict.line(ascii(name) if len(paths) > 1 else ""))


def misuse(paths: Sequence[str], manifest: str | None, asking: Asking, bounded: bool) -> str:
    """Why the arguments contradict each other, or nothing."""
    if not paths and manifest is None:
        return "expected a FILE or --manifest"
    if [*paths, *asking].count("-") > 1:
        return "standard input can be read once: give - once"
    many = manifest is not None or NAME in map(os.path.basename, paths)
    if many and asking[-1] is not None:
        return "a manifest makes more than one statement: leave out --expect"
    if bounded and not SUPPORTED:
        return "this platform has no limits on time and memory"
    return ""


def _told(path: str, read: Callable[..., Expectation], limits: Limits, clock: Clock) -> Expectation:
    """What one file asks."""
    try:
        found = clock.within(lambda: attempt(lambda: read(read_file(path, limits), limits)))
    except OutOfTime:
        found = clock.verdict()
    if isinstance(found, Verdict):
        raise NotAsked(path, found)
    return found


def _certificate(path: str, wanted: Expectation, limits: Limits) -> Iterator[Found]:
    """The verdict on the certificate in a file."""
    about = {"file": path}
    yield about, attempt(lambda: check_document(read_file(path, limits), wanted, limits))


def _manifest(path: str, wanted: Expectation, limits: Limits) -> Iterator[Found]:
    """The verdicts on a manifest without those of VALID certificates, and then their numbers."""
    numbers, remarks = Counter[tuple[str, bool]](), 0
    for about, verdict in manifest_verdicts(path, wanted, limits):
        own = about == {"file": NAME}
        if verdict.verdict == "REMARK":
            remarks += 1
        elif not own:
            numbers.update((what, not verdict.status) for what in about)
        if verdict.verdict != "VALID":
            yield {"file": path} if own else {**about, "manifest": path}, verdict
    implied, rest = numbers["text", True], numbers["text", False]
    valid, other = numbers["file", True], numbers["file", False]
    told = f"{implied} sentences implied, {rest} not, {counted(remarks, 'remark')}"
    told += f"; {valid} certificates valid, {other} not"
    yield {"file": path}, Verdict("COUNTED", told)


def verdicts(
    paths: Sequence[str], manifest: str | None, asking: Asking, limits: Limits, clock: Clock
) -> Iterator[Found]:
    """Yield each verdict after its subject, a ``file`` or the ``text`` of a sentence.

    What a manifest holds is followed by the path of the ``manifest``.

    A path that ends with the usual name of a manifest is read as a manifest.  Every certificate
    is asked for what three files hold: a system, a controller, and a statement or claim.

    Raises
    ------
    NotAsked
        If one of the three cannot be read, or not in time.
    """
    wanted, new = Expectation(), Expectation
    for path, read in zip(asking, (new.about, new.controlled, new.saying), strict=True):
        if path is not None:
            wanted = _told(path, partial(read, wanted), limits, clock)
    listed = [(path, os.path.basename(path) == NAME) for path in paths]
    listed += [] if manifest is None else [(manifest, True)]
    for path, many in listed:
        look = _manifest if many else _certificate
        yield from clock.limited(look(path, wanted, limits), {"file": path})


def status_of(found: Sequence[Found]) -> int:
    """The exit status of a run with these verdicts."""
    return next(status for status in PRECEDENCE if status in {0, *(v.status for _, v in found)})


def count(text: str) -> int:
    """An integer from 1 on, in digits alone."""
    if not (text.isascii() and text.isdigit() and int(text)):
        raise argparse.ArgumentTypeError(f"expected an integer from 1 on, found {text!a}")
    return int(text)


def seconds(text: str) -> float:
    """A number of seconds above 0."""
    with suppress(ValueError):
        if 0 < float(text) < float("inf"):
            return float(text)
    raise argparse.ArgumentTypeError(f"expected a number of seconds above 0, found {text!a}")


OPTIONS: tuple[tuple[str, str, Callable[[str], object], str], ...] = (
    ("manifest", "FILE", str, "verify the sentences of this manifest from its certificates"),
    ("system", "FILE", str, "require this system; certificates with its digest alone need it"),
    ("controller", "FILE", str, "require loops of the plant with the controller in this file"),
    ("expect", "FILE", str, f"require a statement, its SHA-256, its line of a verdict, or {CLAIM}"),
    ("max-bytes", "N", count, "most bytes of a file"),
    ("max-digits", "N", count, "most digits in a row"),
    ("max-depth", "N", count, "most nested levels"),
    ("max-work", "N", count, "most units for a file, or for a manifest with its certificates"),
    ("timeout", "SECONDS", seconds, "the time of the run; what is not decided is INCOMPLETE"),
    ("max-memory", "MIB", count, "the memory that may be added; what needs more is INCOMPLETE"),
)
"""Name, value, how it is read, and help; what begins with ``max-`` may stand in ``Limits``."""


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are ASCII that prints, whatever the arguments are."""

    def error(self, message: str) -> NoReturn:
        """End with wrong usage."""
        super().error(ascii(message)[1:-1])


def _parser() -> argparse.ArgumentParser:
    """The options, and in the help what these docstrings say."""
    parser = Parser("checker", None, __doc__, main.__doc__, allow_abbrev=False)
    parser.add_argument("files", nargs="*", metavar="FILE", help="certificates; - is the input")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    for name, value, read, told in OPTIONS:
        default = getattr(Limits, name.removeprefix("max-"), None)
        told += f" (default: {default:,})" if default else ""
        parser.add_argument(f"--{name}", metavar=value, type=read, default=default, help=told)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status: the first that applies of 70, 3, 1, 5, 0.

    70 is a bug in this checker, 3 MALFORMED, 1 INVALID, 5 INCOMPLETE, 0 all VALID or IMPLIED, or a
    REMARK, which claims nothing; 2 is wrong usage, 74 the verdicts cannot be written, 130
    interrupted.  Python itself ends with 1 if it cannot start: a status of 1 without a line that
    says INVALID is no verdict.
    """
    try:
        try:
            status = _run(_parser(), arguments)
        except SystemExit as end:  # help, or wrong usage
            status = int(end.code or 0)
        _flush(sys.stdout)
    except OSError as error:
        # An OSError about an input has become a verdict.
        if not isinstance(error, BrokenPipeError):
            _complain(f"the verdicts cannot be written: {error.strerror}")
        status = UNWRITTEN
        _drop(sys.stdout)
    except KeyboardInterrupt:
        status = 130
    try:
        _flush(sys.stderr)
    except OSError:
        _drop(sys.stderr)
    return status


def _run(parser: argparse.ArgumentParser, arguments: Sequence[str] | None) -> int:
    """Check what the arguments name, print the verdicts, and return the exit status."""
    options = parser.parse_args(arguments)
    files, manifest = options.files, options.manifest
    asking = options.system, options.controller, options.expect
    if wrong := misuse(files, manifest, asking, bool(options.timeout or options.max_memory)):
        parser.error(wrong)
    limits = Limits(options.max_bytes, options.max_depth, options.max_digits, work=options.max_work)
    sys.set_int_max_str_digits(0)
    # A character that the terminal's encoding lacks must not raise an error.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    found, clock = [], Clock(options.timeout)
    try:
        with memory(options.max_memory), clock.running():
            for each in verdicts(files, manifest, asking, limits, clock):
                found.append(each)
                if not options.json:
                    _say(line_of(each, [*files, manifest] if manifest else files))
    except NotAsked as error:
        _complain(str(error))
        found = [error.found]
    if options.json:
        rows = [about | asdict(verdict) for about, verdict in found]
        _say(json.dumps({"format": FORMAT, "verdicts": rows}, indent=1))
    return status_of(found)


def _say(text: str) -> None:
    """Print a line, or raise an OSError if that is impossible."""
    if sys.stdout is None:
        raise OSError(errno.EBADF, "standard output is closed")
    print(text, flush=True)


def _complain(text: str) -> None:
    """Print a line on standard error, if that is possible."""
    if sys.stderr is not None:  # to print to None is to print to standard output
        with suppress(OSError):  # at the end it is tried again
            print(f"checker: {text}", file=sys.stderr, flush=True)


def _flush(stream: IO[str] | None) -> None:
    if stream is not None:
        stream.flush()


def _drop(stream: IO[str] | None) -> None:
    """Lead a stream nowhere: the interpreter flushes it at its end, which must not fail again."""
    if stream is not None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
