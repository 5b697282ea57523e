"""`mcexact sweep`: answer the same questions about many systems."""

from __future__ import annotations

import contextlib
import os
import re
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.failures import INTERRUPTED
from mcexact.cli.families import Families, cluster, families
from mcexact.sweeps.questions import KNOWN

if TYPE_CHECKING:
    from mcexact.exact.rational import Limits
    from mcexact.sweeps.jobs import Job, Source
    from mcexact.sweeps.run import Record

# The status of a sweep is the first of these with which some system ended.
_PRECEDENCE = (70, 3, 2, 4, 0)
_SAY_EVERY = 10.0  # seconds


@click.command(name="sweep", short_help="Answer the same questions about many systems.")
@click.argument("files", nargs=-1, metavar="[FILE|DIRECTORY]...")
@click.option(
    "--question",
    "questions",
    type=click.Choice(KNOWN),
    multiple=True,
    metavar="NAME",
    help=f"A question to decide: {', '.join(KNOWN)}; by default the first, or with --tolerances "
    "box_fixed_modes. May be repeated.",
)
@click.option(
    "--draws",
    type=click.IntRange(min=1),
    metavar="N",
    help="Add N drawn systems, as `mcexact sample` draws them.",
)
@click.option("--seed", type=int, default=0, show_default=True, help="Seed of the first draw.")
@options.draws
@families
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write every answer to this file, one line of JSON for each system. Finished systems are "
    "skipped: run the same command again to resume.",
)
@click.option(
    "--workers",
    type=click.IntRange(1, 256),
    metavar="N",
    help="Number of processes; by default the number of processors.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Have a running dask cluster decide, such as tcp://host:8786, on whose workers mcexact is "
    "installed; the checker verifies every certificate here.",
)
@options.page("counts and a row for every system")
@options.certificates
@options.as_json
@options.work_limits
@options.file_limits
def command(
    files: tuple[str, ...],
    questions: tuple[str, ...],
    draws: int | None,
    seed: int,
    output: Path | None,
    workers: int | None,
    scheduler: str | None,
    certificates: Path | None,
    html: Path | None,
    as_json: bool,
    timeout: float | None,
    max_memory: int | None,
    **rest: Any,
) -> int:
    """Answer the same questions about every system in the FILEs.

    --grid, --tolerances, --all-graphs and --all-sensors ask about many systems that are made of
    each FILE.
    In a DIRECTORY, a *.json file is read if its key "format" says that it is a system file; other
    files are skipped and named in the summary.

    The independent checker verifies every certificate before an answer counts. Files that fail are
    reported; the sweep continues. The limits on time and memory apply to each system. With
    --certificates, only the systems decided in this run give certificates, not those skipped.
    """
    from functools import partial

    from mcexact.cli.files import (
        directory,
        require_apart,
        require_other,
        require_writable,
        say_written,
        write_result,
    )
    from mcexact.cli.output import emit_json, emit_tables
    from mcexact.derived.drawn.systems import Draw
    from mcexact.errors import InputError
    from mcexact.exact.rational import Limits
    from mcexact.report.sweep import (
        skipped_table,
        sweep_page,
        sweep_tables,
        sweep_view,
        tolerance_tables,
    )
    from mcexact.report.text import WIDE
    from mcexact.sweeps.jobs import decide
    from mcexact.sweeps.run import sweep

    limits = Limits(
        **options.given({name: rest.pop(name) for name in ("bytes", "depth", "digits", "exponent")})
    )
    made_of = Families(rest)
    listed = _Listed(files)
    sources: list[Source] = listed.expanded(made_of.of(listed.paths, limits))
    sources += [Draw(number, **rest) for number in range(seed, seed + (draws or 0))]
    if not sources:
        raise click.UsageError("there are no systems to sweep over: name files, or give --draws N")
    asked = made_of.questions(questions)
    require_writable(output, certificates)
    require_other(html, *listed.paths)
    require_writable(html, certificates)
    require_apart(output, html, certificates)
    limited = timeout is not None or max_memory is not None
    if limited and scheduler is not None:
        raise click.UsageError("limits on time and memory hold here: leave them out on a cluster")
    documents: list[dict[str, Any]] = []
    written = 0
    try:
        with cluster(scheduler) as (executor, threads), _progress(len(sources)) as tell:
            records = sweep(
                sources,
                asked,
                results=output,
                executor=executor,
                workers=workers or threads or _processors(),
                limits=limits,
                read=partial(_read, timeout=timeout),
                work=partial(_limited, timeout=timeout, max_memory=max_memory)
                if limited
                else decide,
            )
            with contextlib.closing(records):  # type: ignore[type-var]
                for record in records:
                    documents.append(record.to_dict())
                    tell(documents)
                    if certificates is not None:
                        written += _write(directory(certificates), record, len(sources))
    except KeyboardInterrupt:
        kept = f"; run the same command again to resume from {output}" if output is not None else ""
        said = f"interrupted after {len(documents)} of {len(sources)} systems{kept}"
        click.echo(f"mcexact: {said}", err=True)
        return INTERRUPTED
    documents.sort(key=lambda document: int(document["number"]))
    documents, skipped = listed.separated(documents)
    if not documents:
        raise InputError("found no system file", where=", ".join(files))
    if output is not None:
        say_written(output)
    if certificates is not None:
        say_written(certificates, written)
    if html is not None:
        write_result(html, sweep_page(documents, asked, skipped).rendered())
    if as_json:
        emit_json({"format": "mcexact-sweep-summary/1", **sweep_view(documents, asked, skipped)})
    else:
        tables = [*sweep_tables(documents, asked), *tolerance_tables(documents, asked)]
        tables += [skipped_table(skipped)] if skipped else []
        emit_tables(tables, width=WIDE)
    ended = {document["error"]["status"] for document in documents if "error" in document}
    return next(status for status in _PRECEDENCE if status in {0, *ended})


class _Listed:
    """The named files, and the files in named directories that may be system files.

    Attributes
    ----------
    paths : list of str
    """

    def __init__(self, files: tuple[str, ...]) -> None:
        from mcexact.errors import InputError
        from mcexact.model.arrays import MARK

        self.paths: list[str] = []
        self._found: set[int] = set()
        self._skipped: list[tuple[str, str]] = []
        for file in files:
            if not os.path.isdir(file) or os.path.isfile(os.path.join(file, MARK)):
                self.paths.append(file)
                continue
            before = len(self.paths)
            for path in sorted(Path(file).iterdir()):
                self._take(path)
            if len(self.paths) == before:
                raise InputError("there are no *.json files in this directory", where=file)

    def _take(self, path: Path) -> None:
        """Add a file of a directory, unless its name or type excludes it."""
        if path.is_dir() or path.name.startswith("."):
            return
        if path.suffix != ".json":
            self._skipped.append((str(path), "its name does not end in .json"))
        elif not path.is_file():
            self._skipped.append((str(path), "it is no regular file"))
        else:
            self._found.add(len(self.paths))
            self.paths.append(str(path))

    def expanded(self, members: Iterable[tuple[int, Source]]) -> list[Source]:
        """List what is made of the files, of which those in directories may be skipped."""
        sources: list[Source] = []
        found = set()
        for k, source in members:
            if k in self._found:
                found.add(len(sources))
            sources.append(source)
        self._found = found
        return sources

    def separated(
        self, documents: list[dict[str, Any]]
    ) -> tuple[list[dict[str, Any]], list[tuple[str, str]]]:
        """Separate records from skipped files of directories; a named file is never skipped."""
        kept, skipped = [], list(self._skipped)
        for document in documents:
            error = document.get("error", {})
            if document["number"] in self._found and error.get("other_format"):
                skipped.append((document["name"], error["message"]))
            else:
                kept.append(document)
        return kept, sorted(skipped)


def _processors() -> int:
    """Return the number of processes that can run at once."""
    if hasattr(os, "sched_getaffinity"):
        return min(256, len(os.sched_getaffinity(0)))
    return min(256, os.cpu_count() or 1)


def _limited(job: Job, timeout: float | None, max_memory: int | None) -> dict[str, Any]:
    """Decide a job in a child process, which is ended at a limit."""
    from mcexact.cli.supervision import supervised
    from mcexact.errors import McexactError
    from mcexact.sweeps.jobs import decide, failure

    try:
        return supervised(
            decide,
            job,
            doing=f"deciding {job.name}",
            timeout=timeout,
            max_memory=max_memory,
            libraries=("flint", "numpy"),
            quiet=True,
        )
    except McexactError as error:
        return failure(error)


def _read(path: str | os.PathLike[str], limits: Limits, timeout: float | None) -> bytes:
    """Read a file; waiting for a pipe is limited to the time allowed for a system."""
    from mcexact.cli.deadline import Deadline
    from mcexact.model.files import read_input

    if os.path.isfile(path):
        return read_input(path, limits)
    with Deadline(timeout).interrupting(f"reading {os.fspath(path)}"):
        return read_input(path, limits)


def _write(folder: Path, record: Record, total: int) -> int:
    """Write the certificates of one system; file names give its number, name and question.

    Returns how many these are.
    """
    from mcexact.model.text import write_text

    number = str(record.number + 1).zfill(len(str(total)))
    path, _, member = record.name.partition(": ")
    stem = re.sub(r"[^A-Za-z0-9_.-]+", "-", Path(path).stem + (f"-{member}" if member else ""))[:60]
    for question, text in record.certificates.items():
        write_text(folder / f"{number}-{stem}-{question}.json", text)
    return len(record.certificates)


@contextlib.contextmanager
def _progress(total: int) -> Iterator[Any]:
    """Show progress on standard error: a bar on a terminal, otherwise a line at intervals."""
    import sys

    if sys.stderr is not None and sys.stderr.isatty():
        with click.progressbar(length=total, file=sys.stderr, show_pos=True) as bar:
            yield lambda documents: bar.update(len(documents) - bar.pos)
        return
    last = time.monotonic()

    def say(documents: list[dict[str, Any]]) -> None:
        nonlocal last
        if time.monotonic() - last >= _SAY_EVERY:
            last = time.monotonic()
            print(f"mcexact: {len(documents)} of {total} systems …", file=sys.stderr, flush=True)

    yield say
