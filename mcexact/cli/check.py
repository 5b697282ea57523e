"""`mcexact check`: the independent checker, which can also be copied away and run alone.

The verdicts are those of `mcexact.checker`; the command reads its options, prints a line as soon as
a file is checked, and shows progress on a terminal.  It runs in this process, and loads nothing of
the package besides the checker, so that no fault of the rest can change a verdict.  The limits on
time and memory are the checker's own (`Clock`, `memory`): what they end is INCOMPLETE.

`checker_archive` packs the checker as one file, whose bytes depend on its sources alone.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import sys
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any

import click

from mcexact import __version__, checker
from mcexact.checker.command import (
    FORMAT,
    UNWRITTEN,
    NotAsked,
    line_of,
    manifest_file,
    misuse,
    status_of,
    verdicts,
)
from mcexact.checker.core.budget import Verdict
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Clock, Found, memory
from mcexact.checker.page import Audit
from mcexact.cli import options, verified
from mcexact.cli.commands import INTERRUPTED
from mcexact.cli.output import deliver, json_text
from mcexact.errors import InputError, NotWritten

BUG = 70
"""The status if the two checkers disagree."""
FIRST_DAY = (1980, 1, 1, 0, 0, 0)
"""The earliest time of a member of an archive, whose bytes shall not depend on the time."""


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
    help="Require that each certificate is about the system in this file; one that names its "
    "system by its digest needs the file.",
)
@click.option(
    "--controller",
    metavar="FILE",
    help="Require that each certificate is about the closed loop of the plant with the controller "
    "in this file, and that nothing else is in the loop unless --expect says so.",
)
@click.option(
    "--expect",
    metavar="FILE",
    help="Require what this file holds: a statement, its SHA-256, the line of a verdict, or a "
    'claim as a JSON object {"kind": ..., "subject": [...], "claim": {...}}; '
    "subject is [] if left out.",
)
@click.option(
    "--statements",
    is_flag=True,
    help="Print whole statements, each behind its SHA-256, in place of what they say in short.",
)
@click.option(
    "--timeout",
    type=options.seconds,
    metavar="SECONDS",
    help="Limit on the time of the whole run; what is not decided by then is INCOMPLETE.",
)
@click.option(
    "--max-memory",
    type=click.IntRange(min=1),
    metavar="MIB",
    help="Limit on memory in MiB; what needs more is INCOMPLETE.",
)
@click.option(
    "--export",
    type=options.FOLDER,
    metavar="FILE",
    help="Check nothing, but write the checker to this file, an archive that `python -I` runs.",
)
@click.option(
    "--rocq",
    type=options.FOLDER,
    metavar="FILE",
    help="Write to this file a theorem of Coq (now Rocq) that is the claim of the one CERTIFICATE, "
    "proved by one computation (needs the program mcexact-verified: make verified).",
)
@options.page("verdicts, statements, and how to repeat the check: what an auditor signs")
@click.option(
    "--verified/--no-verified",
    "ask_verified",
    default=True,
    help="Have the program mcexact-verified, where it is installed, confirm what is VALID.",
)
@options.as_json
@click.option(
    "--max-work",
    "work",
    type=click.IntRange(min=1, max=10**30),
    metavar="N",
    help="Units of work that the check of a file may take, or that of a manifest with its "
    "certificates; by default 40,000,000 and 4,000 for each byte, four times as many if the plant "
    "has a parameter.",
)
@options.file_limits
def command(
    certificates: tuple[str, ...],
    manifest: str | None,
    system: str | None,
    controller: str | None,
    expect: str | None,
    statements: bool,
    timeout: float | None,
    max_memory: int | None,
    export: Path | None,
    rocq: Path | None,
    html: Path | None,
    ask_verified: bool,
    as_json: bool,
    **limits: int | None,
) -> int:
    """Verify each CERTIFICATE and print one line with the verdict and what it proves in short.

    A folder stands for its manifest: for the certificates that it names, numbered, and the
    sentences of the report. Behind IMPLIED stands what the checker proves from the certificates of
    these numbers, in its own words, and then the sentence that the report makes of it, in quotes.
    Its fixed words, and its costs, margins, distances, rates and steps are checked; compare what
    else it says, such as yes or no, modes, names, weights and whole numbers.

    --statements prints whole statements, each behind its SHA-256. INVALID, MALFORMED and
    INCOMPLETE are followed by a code and a place. A certificate about another plant, another loop
    or another claim than asked for is NOT ABOUT it, whatever it proves. A sentence that claims
    nothing, such as a title, is a REMARK, and not counted as implied. Of several certificates,
    those about no loop are judged without --controller.

    Where the program mcexact-verified is installed, a line on standard error says which VALID
    certificates it confirms, too, and one of how many sentences it confirms all certificates. If it
    finds one false, one of the two has a bug, and the status is 70.

    The status is the first that applies of 70, 3 (MALFORMED), 1 (INVALID, NOT ABOUT), 5
    (INCOMPLETE) and 0, or 74 if the verdicts cannot be written. The file that --export writes
    prints the same verdicts: python -I FILE CERTIFICATE...
    """
    if export is not None:
        if certificates or manifest is not None:
            raise click.UsageError("--export checks nothing: give it alone")
        _export(export)
        return 0
    if rocq is not None and (len(certificates) != 1 or manifest is not None):
        raise click.UsageError("--rocq is about one CERTIFICATE")
    if rocq is not None and certificates[0] == "-":
        raise click.UsageError("--rocq needs a CERTIFICATE in a file")
    asking = None if system is None else _plant_file(system), controller, expect
    if wrong := misuse(certificates, manifest, asking, bool(timeout or max_memory)):
        raise click.UsageError(wrong)
    _require_page(html, [*certificates, manifest, *asking])
    judged, clock = [], Clock(timeout)
    allowed = Limits(**options.set_limits(limits))
    paths = [*certificates, *([manifest] if manifest else [])]
    named = len(paths) > 1 or manifest is not None or any(map(os.path.isdir, paths))
    progress, interrupted = _Progress(shows=named), False
    try:
        try:
            with memory(max_memory), clock.running(), progress.shown():
                for each in verdicts(certificates, manifest, asking, allowed, clock):
                    judged.append(each)
                    progress.clear()
                    if not as_json:
                        deliver(line_of(each, named=named, statements=statements) + "\n")
                    progress.after()
        except KeyboardInterrupt:
            interrupted = True
        except NotAsked as refused:
            if not as_json:
                error = InputError(str(refused))
                error.exit_status = status_of([refused.found])
                raise error from None
            judged = [refused.found]
        second = {} if interrupted or not ask_verified else _confirmed(judged, timeout)
        layers = second | _layers(judged, second)
        if as_json:
            rows = [
                about | asdict(verdict) | ({"verified": layers[k]} if k in layers else {})
                for k, (about, verdict) in enumerate(judged)
            ]
            deliver(json_text({"format": FORMAT, "verdicts": rows}))
        if rocq is not None and not interrupted:
            _write_theorem(rocq, certificates[0], timeout)
        if html is not None and not interrupted:
            last = line_of(judged[-1], named=named)
            audit = {"files": certificates, "manifest": manifest, "asking": asking, "last": last}
            _write_page(html, judged, system, audit | {"second": second})
    except NotWritten as error:
        if not error.reader_left:
            raise
        return UNWRITTEN
    if interrupted:
        click.echo(f"mcexact: interrupted after {progress.done()}", err=True)
        return INTERRUPTED
    contradicted = any(not each.startswith("CONFIRMED") for each in second.values())
    return BUG if contradicted else status_of(judged)


def file_of(about: Mapping[str, str]) -> str:
    """The file of a certificate, which may be beside a manifest."""
    folder = os.path.dirname(manifest_file(about["manifest"])) if "manifest" in about else ""
    return os.path.join(folder, about["file"])


def _confirmed(judged: Sequence[Found], seconds: float | None) -> dict[int, str]:
    """What mcexact-verified says of VALID certificates, by their places; a line of each is printed.

    What it does not verify at all is left out.
    """
    places = [
        k
        for k, (about, verdict) in enumerate(judged)
        if verdict.verdict == "VALID" and about["file"] != "-"
    ]
    found: dict[int, str] = {}
    if not places or verified.program() is None:
        return found
    files = [file_of(judged[k][0]) for k in places]
    statements = [judged[k][1].statement for k in places]
    answers = verified.confirmations(files, statements, seconds)
    for k, file, answer in zip(places, files, answers, strict=True):
        if not (answer.confirmed or answer.contradicts):
            continue
        found[k] = f"{answer.verdict} {answer.message}".strip()
        said = "confirms" if answer.confirmed else f"says {found[k]} of"
        click.echo(f"{verified.NAME} {said} {file!a}", err=True)
    return found


def _layers(judged: Sequence[Found], confirmed: Mapping[int, str]) -> dict[int, str]:
    """What sentences rest on, by their places: the layer of their weakest premise.

    CONFIRMED where mcexact-verified confirms every certificate that a sentence names, else VALID
    and the numbers of those that it does not confirm.  A line says of how many sentences it
    confirms all; a sentence that names no certificate is about the plant itself.
    """
    twice = {
        (about["manifest"], about["number"])
        for k, (about, _) in enumerate(judged)
        if confirmed.get(k, "").startswith("CONFIRMED") and "number" in about
    }
    layers, once = dict[int, str](), set[int]()
    for k, (about, verdict) in enumerate(judged):
        if twice and verdict.verdict == "IMPLIED" and about["premises"]:
            named = about["premises"].split(", ")
            weak = [number for number in named if (about["manifest"], number) not in twice]
            once.update(map(int, weak))
            layers[k] = f"VALID {', '.join(weak)}" if weak else "CONFIRMED"
    if layers:
        many = list(layers.values()).count("CONFIRMED")
        rest = f"; not confirmed: {', '.join(map(str, sorted(once)))}" if once else ""
        told = f"confirms all certificates of {many} of {len(layers)} sentences{rest}"
        click.echo(f"{verified.NAME} {told}", err=True)
    return layers


def _write_theorem(file: Path, certificate: str, seconds: float | None) -> None:
    """Write the theorem about the plant of the one certificate.

    Raises
    ------
    InputError
        If the program is missing, or does not confirm it.
    """
    # The checker shall not need what writes files.
    from mcexact.cli.files import write_result

    try:
        text = verified.rocq_file(certificate, seconds)
    except LookupError as missing:
        raise InputError(str(missing), where=certificate) from None
    write_result(file, text.encode("ascii"))


def _require_page(page: Path | None, inputs: Sequence[str | None]) -> None:
    """Check before the work that a page would overwrite no input."""
    if page is not None:
        # The checker shall not need what writes files.
        from mcexact.cli.files import require_other

        require_other(page, *(path for path in inputs if path not in (None, "-")))


def _write_page(
    page: Path, judged: Sequence[Found], plant: str | None, audit: Mapping[str, Any]
) -> None:
    """Write the page of the audit; what the package makes of the certificates is beside it."""
    # The checker shall not need what writes pages, nor what makes sentences.
    from mcexact.cli.audit import sentences_again
    from mcexact.cli.files import write_result

    evidence = list[tuple[str, bytes, Verdict]]()
    for about, verdict in judged:
        if "text" not in about and verdict.verdict != "COUNTED" and about["file"] != "-":
            with contextlib.suppress(OSError):
                file = file_of(about)
                evidence.append((file, Path(file).read_bytes(), verdict))
    archive = hashlib.sha256(checker_archive()).hexdigest()
    made: dict[str, Any] = {
        "archive": archive,
        "program": f"mcexact {__version__}",
        "status": status_of(judged),
    }
    worded = sentences_again(evidence, plant)
    write_result(page, Audit.of(judged, **audit, **made, worded=worded).page())


class _Progress:
    """How much is checked, on standard error if that is a terminal."""

    def __init__(self, *, shows: bool) -> None:
        self._checked = 0
        self._shows = shows and sys.stderr is not None and sys.stderr.isatty()

    def done(self) -> str:
        """How much is checked, in words."""
        return f"{self._checked} certificates and sentences"

    def after(self) -> None:
        """Show what is checked, after one more verdict."""
        self._checked += 1
        self._show()

    @contextlib.contextmanager
    def shown(self) -> Iterator[None]:
        """Show a line while files are checked, and clear it."""
        self._show()
        try:
            yield
        finally:
            self.clear()

    def clear(self) -> None:
        """Clear the line, so that another can be printed."""
        if self._shows:
            click.echo("\r\x1b[K", nl=False, err=True)

    def _show(self) -> None:
        if self._shows:
            click.echo(f"\r\x1b[Kchecked {self.done()}", nl=False, err=True)


def _plant_file(system: str) -> str:
    """The JSON file of a plant, which is what the checker reads.

    Raises
    ------
    InputError
        If it is a file of another kind.
    """
    # The checker shall not need what reads plants of other kinds.
    from mcexact.model import gallery
    from mcexact.model.files import GALLERY, is_foreign

    if system.startswith(GALLERY):
        name = gallery.require_name(system.removeprefix(GALLERY))
        return str(resources.files(gallery).joinpath(f"{name}.json"))
    if is_foreign(system):
        raise InputError(
            "the checker reads JSON alone: convert the plant by 'mcexact convert', "
            "with the rounding it was analyzed with",
            where=system,
        )
    return system


def _export(file: Path) -> None:
    """Write the archive of the checker."""
    # The checker shall not need what writes files.
    from mcexact.cli.files import write_result

    write_result(file, checker_archive())


def checker_archive() -> bytes:
    """The folder of the checker as an archive that ``python -I`` runs.

    Returns
    -------
    bytes
        The same for the same sources: the members are sorted, not compressed, and have no times.
    """
    folder, archive = Path(checker.__path__[0]), io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as packed:
        for path in sorted([*folder.rglob("*.py"), *folder.rglob("*.json")]):
            member = zipfile.ZipInfo(path.relative_to(folder).as_posix(), FIRST_DAY)
            member.create_system, member.external_attr = 3, 0o644 << 16
            packed.writestr(member, path.read_bytes())
    return archive.getvalue()
