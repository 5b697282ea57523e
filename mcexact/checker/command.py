"""The command line, which prints one line for each file and ends with one exit status."""

from __future__ import annotations

import argparse
import io
import json
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from functools import partial

from .kinds import Verdict, answer, check_document
from .manifest import NAME, manifest_verdicts
from .reading import Limits, Refused
from .system import digest, read_system_file

PRECEDENCE = (70, 3, 1, 5, 0)


def _read_file(path: str, limits: Limits) -> bytes:
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


def _check_file(path: str, wanted: str | None, limits: Limits) -> Verdict:
    """The verdict on the certificate in a file."""
    return check_document(_read_file(path, limits), wanted, limits)


def verdicts(
    paths: Sequence[str], manifest: str | None, system: str | None, limits: Limits
) -> Iterator[tuple[dict[str, str], Verdict]]:
    """Yield each verdict after its subject, a ``file`` or the ``text`` of a sentence.

    A path that ends with the usual name of a manifest is read as a manifest.

    Raises
    ------
    Refused
        If the system file cannot be read.
    """
    wanted = (
        None if system is None else digest(read_system_file(_read_file(system, limits), limits))
    )
    for path in paths:
        if os.path.basename(path) == NAME:
            yield from manifest_verdicts(path, wanted, limits)
        else:
            check = partial(_check_file, path, wanted, limits)
            yield {"file": path}, answer(check)
    if manifest is not None:
        yield from manifest_verdicts(manifest, wanted, limits)


def main(arguments: Sequence[str] | None = None) -> int:
    """Check files, print one line for each (or one JSON document), and return the exit status.

    The status is the first that applies of 70, 3, 1, 5, 0; wrong usage ends with 2, an interruption
    with 130.
    """
    parser = argparse.ArgumentParser(prog="checker", description=__doc__, allow_abbrev=False)
    parser.add_argument(
        "files", nargs="*", metavar="FILE", help="certificates; - is standard input"
    )
    parser.add_argument(
        "--manifest",
        metavar="FILE",
        help="verify the sentences of a manifest from its certificates",
    )
    parser.add_argument(
        "--system", metavar="FILE", help="require certificates about the system in this file"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    for name in ("bytes", "digits", "depth"):
        default = getattr(Limits, name)
        parser.add_argument(f"--max-{name}", type=int, default=default, metavar="N")
    parser.add_argument(
        "--max-work",
        type=int,
        metavar="N",
        help="units of work that each check may take; by default they grow with the bytes read",
    )
    options = parser.parse_args(arguments)
    if not options.files and options.manifest is None:
        parser.error("expected a FILE or --manifest")
    limits = Limits(options.max_bytes, options.max_depth, options.max_digits, work=options.max_work)
    sys.set_int_max_str_digits(0)
    # A character that the terminal's encoding lacks must not raise an error.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    found = []
    try:
        for about, verdict in verdicts(options.files, options.manifest, options.system, limits):
            found.append((about, verdict))
            if not options.json:
                print(verdict.line().replace("(Limits.", "(--max-"), flush=True)
    except Refused as error:
        print(f"checker: {options.system}: {error.place}: {error.message}", file=sys.stderr)
        return 3
    except KeyboardInterrupt:
        return 130
    if options.json:
        print(json.dumps({"verdicts": [about | asdict(v) for about, v in found]}, indent=1))
    return next(status for status in PRECEDENCE if status in {0, *(v.status for _, v in found)})
