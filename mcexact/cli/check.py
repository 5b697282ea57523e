"""`mcexact check`: the independent checker, which can also be copied away and run alone."""

from __future__ import annotations

import click

from mcexact.cli import options


@click.command(name="check", short_help="Check certificates, independently of what made them.")
@click.argument("certificates", nargs=-1, required=True, metavar="CERTIFICATE...")
@click.option(
    "--system",
    metavar="FILE",
    help="Insist that each certificate is about the system in this file.",
)
@options.as_json
@options.file_limits
def command(
    certificates: tuple[str, ...],
    system: str | None,
    as_json: bool,
    **limits: int | None,
) -> int:
    """Check each CERTIFICATE and print one line: the verdict and the theorem that was checked.

    VALID names the theorem and the digest of the system; INVALID, MALFORMED and INCOMPLETE name a
    code and a place.
    """
    from dataclasses import asdict

    from mcexact.checker.command import PRECEDENCE, verdicts
    from mcexact.checker.reading import Limits, Refused
    from mcexact.cli.output import emit, emit_json
    from mcexact.errors import InputError

    found = []
    try:
        for verdict in verdicts(certificates, system, Limits(**options.given(limits))):
            found.append(verdict)
            if not as_json:
                emit(verdict.line() + "\n")
    except Refused as refused:
        raise InputError(refused.message, where=f"{system}: {refused.place}") from None
    if as_json:
        rows = [{"file": file, **asdict(v)} for file, v in zip(certificates, found, strict=True)]
        emit_json({"verdicts": rows})
    return next(status for status in PRECEDENCE if status in {0, *(v.status for v in found)})
