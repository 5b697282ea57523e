"""`mcexact sweep`: the same questions about many systems.

`Families` makes many systems of each file (grids of parameters, tolerances, all graphs, all
sensors), and `_Listed` the files of directories, which are skipped and named if they are no system
files.  `command` runs `mcexact.sweeps.run.sweep` over them, in processes of this machine or on a
dask cluster.  Workers are new interpreters, never forks, and one system has the limits on time and
memory to itself: then the worker is a child process of `supervised`.
"""

from __future__ import annotations

import contextlib
import os
import re
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import options
from mcexact.cli.commands import INTERRUPTED
from mcexact.cli.files import (
    Deadline,
    directory,
    emit_tables,
    require_apart,
    require_other,
    require_writable,
    say_written,
    write_result,
)
from mcexact.cli.output import emit_json
from mcexact.cli.results import PART_OF_SEARCH
from mcexact.cli.running import LIMITS, supervised
from mcexact.derived.drawn.systems import Draw
from mcexact.derived.variants import (
    Variant,
    neighbor_graph_variants,
    parameter_grid,
    sensor_variants,
    tolerance_variants,
)
from mcexact.errors import InputError, LimitReached, McexactError, MissingExtra, place_of
from mcexact.exact.rational import Limits
from mcexact.model.arrays import MARK, Reading
from mcexact.model.files import load_parametric_system, read_any, read_input
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import write_text
from mcexact.report.sweep import (
    nearby_tables,
    skipped_table,
    sweep_page,
    sweep_tables,
    sweep_view,
    tolerance_tables,
)
from mcexact.report.text import WIDE
from mcexact.sweeps import run
from mcexact.sweeps.jobs import Job, Source, decide, failure
from mcexact.sweeps.questions import KNOWN, WITHIN_RADII
from mcexact.sweeps.run import Record

if TYPE_CHECKING:
    from concurrent.futures import Executor

F = TypeVar("F", bound=Callable[..., Any])
_MOST_VALUES = 10**6


def values(text: str) -> tuple[str, tuple[Fraction, ...]]:
    """Parse ``NAME=FROM:TO:COUNT`` or ``NAME=VALUE,VALUE,…``, with exact numbers.

    Examples
    --------
    >>> values("t=0:1:3")
    ('t', (Fraction(0, 1), Fraction(1, 2), Fraction(1, 1)))
    >>> values("t=1/3,2")
    ('t', (Fraction(1, 3), Fraction(2, 1)))
    """
    name, equals, listed = text.partition("=")
    if not equals or not name or not listed:
        raise click.BadParameter(f"expected NAME=FROM:TO:COUNT or NAME=VALUE,VALUE, found '{text}'")
    if ":" not in listed:
        return name, tuple(options.rational(part.strip()) for part in listed.split(","))
    parts = listed.split(":")
    if len(parts) != 3 or not parts[2].isdecimal() or not 2 <= int(parts[2]) <= _MOST_VALUES:
        raise click.BadParameter(
            f"expected FROM:TO:COUNT with a count from 2 to {_MOST_VALUES}, found '{listed}'"
        )
    low, high, steps = options.rational(parts[0]), options.rational(parts[1]), int(parts[2]) - 1
    return name, tuple(low + (high - low) * k / steps for k in range(steps + 1))


def parts(text: str) -> tuple[Fraction, ...]:
    """Parse parts, as numbers or percentages with commas.

    Examples
    --------
    >>> parts("0.1%,1/50")
    (Fraction(1, 1000), Fraction(1, 50))
    """
    return tuple(options.part(each.strip()) for each in text.split(","))


def families(function: F) -> F:
    """Add the options that make many systems of each file."""
    for option in (
        click.option(
            "--all-sensors",
            is_flag=True,
            help="Ask about every way of giving the sensors of each FILE, the rows of all C_i, to "
            "its channels.",
        ),
        click.option(
            "--all-graphs",
            is_flag=True,
            help="Ask about the agents of each FILE with every neighbor graph, over which they "
            "send each other their outputs.",
        ),
        click.option(
            "--up-to-isomorphism",
            is_flag=True,
            help="With --all-graphs: only one of those graphs that differ by the agents' names.",
        ),
        click.option(
            "--strongly-connected",
            is_flag=True,
            help="With --all-graphs: only strongly connected graphs.",
        ),
        click.option(
            "--tolerances",
            type=parts,
            metavar="PARTS",
            help="Ask about each FILE with all entries that are not 0 known to these parts of "
            "their values: 0.1%,0.3%,1%. For the questions about every plant within the radii; "
            "where no proof is found, a plant that fails is searched.",
        ),
        click.option(
            "--grid",
            type=values,
            multiple=True,
            metavar="NAME=VALUES",
            help="Ask about each FILE, a system with parameters, at these values of a parameter: "
            "t=0:1:11 for eleven values from 0 to 1, or t=1/3,2. One for each parameter.",
        ),
    ):
        function = option(function)
    return function


class Families:
    """The systems that are made of each file, and the questions about them.

    Parameters
    ----------
    values : dict
        The values of the options of `families`, which are removed.
    """

    def __init__(self, values: dict[str, Any]) -> None:
        self._grid, self._parts = dict(values.pop("grid")), values.pop("tolerances") or ()
        self._sensors, self._graphs = values.pop("all_sensors"), values.pop("all_graphs")
        self._kinds = {
            name: values.pop(name) for name in ("up_to_isomorphism", "strongly_connected")
        }
        self._ways = (self._grid, self._parts, self._sensors, self._graphs)
        if sum(map(bool, self._ways)) > 1:
            raise click.UsageError(
                "give one of --grid, --tolerances, --all-graphs and --all-sensors"
            )
        if any(self._kinds.values()) and not self._graphs:
            raise click.UsageError("--up-to-isomorphism and --strongly-connected need --all-graphs")

    def questions(self, named: tuple[str, ...]) -> tuple[str, ...]:
        """The questions to ask, by default the first that can be asked about such systems."""
        able = WITHIN_RADII if self._parts else KNOWN
        if other := next((name for name in named if name not in able), ""):
            raise click.UsageError(
                f"--tolerances is for questions about every plant within the radii, "
                f"{', '.join(able)}; {other} is none of them"
            )
        return tuple(name for name in able if name in (named or {next(iter(able))}))

    def of(self, paths: Sequence[str], limits: Limits) -> Iterator[tuple[int, Source]]:
        """Yield the systems to ask about, each with the position of its file.

        A file that cannot be read is yielded as it is, so that its error is in its record.
        """
        for k, path in enumerate(paths):
            if not any(self._ways):
                yield k, path
                continue
            try:
                for variant in self._variants(path, limits):
                    yield k, variant
            except (InputError, LimitReached) as error:
                yield k, _failing(path, error)

    def _variants(self, path: str, limits: Limits) -> Iterator[Variant]:
        variants: Iterator[Variant]
        if self._grid:
            plant = load_parametric_system(path, limits=limits)
            with InputError.inside(place_of(path)):
                variants = parameter_grid(plant, self._grid)
        elif self._parts:
            variants = tolerance_variants(_system(path, limits), self._parts)
        elif self._graphs:
            variants = neighbor_graph_variants(
                _system(path, limits), information="outputs", **self._kinds
            )
        else:
            variants = sensor_variants(_system(path, limits))
        return (replace(each, name=f"{path}: {each.name}") for each in variants)


def _system(path: str, limits: Limits) -> MultiChannelSystem:
    """Read a system; a sweep says itself which answers depend on rounding errors."""
    with InputError.inside(place_of(path)):
        return read_any(read_input(path, limits), path, Reading(limits))


def _failing(path: str, error: Exception) -> Variant:
    """Stands for a family without members; reading it raises the error."""

    def fail() -> Any:
        raise error

    return Variant(path, fail)


@contextlib.contextmanager
def cluster(address: str | None) -> Iterator[tuple[Executor | None, int]]:
    """Yield the executor of a dask cluster with the number of its threads; None without an address.

    Raises
    ------
    MissingExtra
        If dask is not installed.
    InputError
        If no scheduler answers at the address.
    """
    if address is None:
        yield None, 0
        return
    with MissingExtra.named("cluster"):
        import distributed
    connect: Any = distributed.Client
    try:
        client = connect(address, timeout="10s", set_as_default=False)
    except (OSError, ValueError, TimeoutError, ImportError) as error:
        reason = str(error).partition("\n")[0]
        raise InputError(f"no scheduler of dask answers: {reason}", where=address) from None
    with client:
        threads = sum(client.ncores().values())
        with client.get_executor() as executor:
            yield executor, max(1, min(256, threads))


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
    limits = Limits(**options.set_limits({name: rest.pop(name) for name in LIMITS}))
    families_asked = Families(rest)
    listed = _Listed(files)
    sources: list[Source] = listed.expanded(families_asked.of(listed.paths, limits))
    sources += [Draw(number, **rest) for number in range(seed, seed + (draws or 0))]
    if not sources:
        raise click.UsageError("there are no systems to sweep over: name files, or give --draws N")
    asked = families_asked.questions(questions)
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
            records = run.sweep(
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
        progress = f"{len(documents)} of {len(sources)} systems"
        click.echo(f"mcexact: interrupted after {progress}{kept}", err=True)
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
        tables = [*sweep_tables(documents, asked), *nearby_tables(documents)]
        tables += tolerance_tables(documents, asked)
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
        self.paths: list[str] = []
        self._in_directories: set[int] = set()
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
            self._in_directories.add(len(self.paths))
            self.paths.append(str(path))

    def expanded(self, members: Iterable[tuple[int, Source]]) -> list[Source]:
        """List what is made of the files, of which those in directories may be skipped."""
        sources: list[Source] = []
        positions = set()
        for k, source in members:
            if k in self._in_directories:
                positions.add(len(sources))
            sources.append(source)
        self._in_directories = positions
        return sources

    def separated(
        self, documents: list[dict[str, Any]]
    ) -> tuple[list[dict[str, Any]], list[tuple[str, str]]]:
        """Separate records from skipped files of directories; a named file is never skipped."""
        kept, skipped = [], list(self._skipped)
        for document in documents:
            error = document.get("error", {})
            if document["number"] in self._in_directories and error.get("other_format"):
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
    try:
        return supervised(
            partial(decide, seconds=timeout / PART_OF_SEARCH) if timeout is not None else decide,
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
    if os.path.isfile(path):
        return read_input(path, limits)
    with Deadline(timeout).interrupting(f"reading {os.fspath(path)}"):
        return read_input(path, limits)


def _write(folder: Path, record: Record, total: int) -> int:
    """Write the certificates of one system; file names give its number, name and question.

    Returns how many these are.
    """
    number = str(record.number + 1).zfill(len(str(total)))
    path, _, member = record.name.partition(": ")
    stem = re.sub(r"[^A-Za-z0-9_.-]+", "-", Path(path).stem + (f"-{member}" if member else ""))[:60]
    for question, text in record.certificates.items():
        write_text(folder / f"{number}-{stem}-{question}.json", text)
    return len(record.certificates)


@contextlib.contextmanager
def _progress(total: int) -> Iterator[Any]:
    """Show progress on standard error: a bar on a terminal, otherwise a line at intervals."""
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
