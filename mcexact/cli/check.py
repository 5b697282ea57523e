"""`mcexact check`: the independent checker, which can also be copied away and run alone."""

from __future__ import annotations

import click

from mcexact.cli import options


@click.command(name="check", short_help="Verify certificates with the independent checker.")
@click.argument("certificates", nargs=-1, metavar="CERTIFICATE...")
@click.option(
    "--manifest",
    metavar="FILE",
    help="Check the certificates named in this manifest (or in the manifest of this folder), and "
    "verify each of its sentences from them.",
)
@click.option(
    "--system",
    metavar="FILE",
    help="Require that each certificate is about the system in this file.",
)
@options.as_json
@click.option(
    "--max-work",
    "work",
    type=click.IntRange(min=1, max=10**30),
    metavar="N",
    help="Units of work that the check of a file may take; by default they grow with its size.",
)
@options.file_limits
def command(
    certificates: tuple[str, ...],
    manifest: str | None,
    system: str | None,
    as_json: bool,
    **limits: int | None,
) -> int:
    """Verify each CERTIFICATE and print one line with the verdict and the verified statement.

    VALID is followed by the statement that the certificate proves and the digest of the system.
    INVALID, MALFORMED and INCOMPLETE are followed by a code and a place. A sentence of a manifest
    is IMPLIED instead of VALID; the statement printed for it is made from the certificates, not
    from the text of the sentence.
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
                emit(verdict.line().replace("(Limits.", "(--max-") + "\n")
    except Refused as refused:
        raise InputError(refused.message, where=f"{system}: {refused.place}") from None
    if as_json:
        emit_json({"verdicts": [about | asdict(verdict) for about, verdict in found]})
    return next(status for status in PRECEDENCE if status in {0, *(v.status for _, v in found)})
