"""`mcexact check`: the independent checker."""

from __future__ import annotations

import click

from mcexact.cli import options

# The first that applies is the exit status of several files.
_PRECEDENCE = (70, 3, 1, 5, 0)
_STATUS = {"VALID": 0, "INVALID": 1, "MALFORMED": 3, "INCOMPLETE": 5}


@click.command(name="check", short_help="Check certificates, independently of what made them.")
@click.argument("certificates", nargs=-1, required=True, metavar="CERTIFICATE...")
@click.option(
    "--system",
    "system_file",
    metavar="FILE",
    help="Insist that each certificate is about the system in this file.",
)
@options.as_json
@options.file_limits
def command(
    certificates: tuple[str, ...],
    system_file: str | None,
    as_json: bool,
    limits: tuple[tuple[str, int], ...],
) -> int:
    """Check each CERTIFICATE and print one line: the verdict and the theorem that was checked.

    VALID names the theorem and the digest of the system; INVALID, MALFORMED and INCOMPLETE name a
    code and a place.
    """
    from mcexact.cli.output import emit, emit_json

    expected = None if system_file is None else _digest(system_file, dict(limits))
    lines = [_line(file, expected, dict(limits)) for file in certificates]
    if as_json:
        emit_json(lines)
    else:
        for line in lines:
            emit(_text(line) + "\n")
    statuses = {_STATUS[line["verdict"]] for line in lines}
    return next(status for status in _PRECEDENCE if status in statuses)


def _digest(file: str, limits: dict[str, int]) -> str:
    from mcexact.exact.rational import Limits
    from mcexact.model.system_file import digest, load_system

    return digest(load_system(file, limits=Limits(**limits)))


def _line(file: str, expected: str | None, limits: dict[str, int]) -> dict[str, str]:
    """The verdict on one file."""
    from mcexact.checker import check_document
    from mcexact.errors import InputError
    from mcexact.exact.rational import Limits
    from mcexact.model.json_text import read_bytes

    try:
        data = read_bytes(file, Limits(**limits))
    except InputError as error:
        return {"file": file, "verdict": "MALFORMED", "code": "unreadable", "place": error.message}
    verdict = check_document(data, system_digest=expected)
    line = {"file": file, "verdict": verdict.verdict, "system": verdict.digest}
    if verdict.verdict == "VALID":
        return line | {"theorem": verdict.theorem}
    return line | {"code": verdict.code, "place": verdict.place}


def _text(line: dict[str, str]) -> str:
    """The verdict as one line; what is not VALID names its file."""
    from mcexact.cli.failures import printable

    if line["verdict"] == "VALID":
        return printable(f"VALID {line['theorem']} {line['system']}", limit=100_000)
    return printable(f"{line['verdict']} {line['code']} {line['file']}: {line['place']}")
