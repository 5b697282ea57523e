"""`mcexact check`: the independent checker, which can also be copied away and run alone."""

from __future__ import annotations

import click

from mcexact.cli import options


@click.command(name="check", short_help="Check certificates, independently of what made them.")
@click.argument("certificates", nargs=-1, metavar="CERTIFICATE...")
@click.option(
    "--manifest",
    metavar="FILE",
    help="Check the certificates of this manifest, or of the one in this folder, and say for each "
    "of its sentences what they imply.",
)
@click.option(
    "--system",
    metavar="FILE",
    help="Insist that each certificate is about the system in this file.",
)
@options.as_json
@options.file_limits
def command(
    certificates: tuple[str, ...],
    manifest: str | None,
    system: str | None,
    as_json: bool,
    **limits: int | None,
) -> int:
    """Check each CERTIFICATE and print one line: the verdict and the theorem that was checked.

    VALID names the theorem and the digest of the system; INVALID, MALFORMED and INCOMPLETE name a
    code and a place. Of a sentence it is IMPLIED instead of VALID, and what is printed follows from
    the certificates: it is made from them, not from the text of the sentence.
    """
    from dataclasses import asdict

    from mcexact.checker.command import PRECEDENCE, verdicts
    from mcexact.checker.reading import Limits, Refused
    from mcexact.cli.output import emit, emit_json
    from mcexact.errors import InputError

    if not certificates and manifest is None:
        raise click.UsageError("expected a CERTIFICATE or --manifest")
    found = []
    allowed = Limits(**options.given(limits))
    try:
        for about, verdict in verdicts(certificates, manifest, system, allowed):
            found.append((about, verdict))
            if not as_json:
                emit(verdict.line() + "\n")
    except Refused as refused:
        raise InputError(refused.message, where=f"{system}: {refused.place}") from None
    if as_json:
        emit_json({"verdicts": [about | asdict(verdict) for about, verdict in found]})
    return next(status for status in PRECEDENCE if status in {0, *(v.status for _, v in found)})
