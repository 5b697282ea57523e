"""Options of `mcexact sweep` that make many systems of each file, and the cluster that decides."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import options

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from mcexact.derived.variants import Variant
    from mcexact.exact.rational import Limits
    from mcexact.sweeps.jobs import Source

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
    """What is asked of each file: the systems that are made of it.

    Parameters
    ----------
    given : dict
        The values of the options of `families`, which are removed.
    """

    def __init__(self, given: dict[str, Any]) -> None:
        self._grid, self._parts = dict(given.pop("grid")), given.pop("tolerances") or ()
        self._sensors, self._graphs = given.pop("all_sensors"), given.pop("all_graphs")
        self._kinds = {
            name: given.pop(name) for name in ("up_to_isomorphism", "strongly_connected")
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
        from mcexact.sweeps.questions import KNOWN, WITHIN_RADII

        able = WITHIN_RADII if self._parts else KNOWN
        if other := next((name for name in named if name not in able), ""):
            raise click.UsageError(
                f"--tolerances is for questions about every plant within the radii, "
                f"{', '.join(able)}; {other} is none of them"
            )
        return tuple(name for name in able if name in (named or {next(iter(able))}))

    def of(self, paths: Sequence[str], limits: Limits) -> Iterator[tuple[int, Source]]:
        """Yield the systems to ask about, each with the position of its file.

        A file that cannot be read stays itself, so that its error is told like that of any other.
        """
        from mcexact.errors import InputError, LimitReached

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
        from dataclasses import replace

        from mcexact.derived.variants import (
            neighbor_graph_variants,
            parameter_grid,
            sensor_variants,
            tolerance_variants,
        )
        from mcexact.errors import InputError, place_of
        from mcexact.model.files import load_parametric_system, load_system

        found: Iterator[Variant]
        if self._grid:
            plant = load_parametric_system(path, limits=limits)
            with InputError.inside(place_of(path)):
                found = parameter_grid(plant, self._grid)
        elif self._parts:
            found = tolerance_variants(load_system(path, limits=limits), self._parts)
        elif self._graphs:
            found = neighbor_graph_variants(
                load_system(path, limits=limits), information="outputs", **self._kinds
            )
        else:
            found = sensor_variants(load_system(path, limits=limits))
        return (replace(each, name=f"{path}: {each.name}") for each in found)


def _failing(path: str, error: Exception) -> Variant:
    """A member of a family that has none, whose error is told when it is asked for."""
    from mcexact.derived.variants import Variant

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
    from mcexact.errors import InputError, MissingExtra

    with MissingExtra.named("cluster"):
        import distributed
    connect: Any = distributed.Client
    try:
        client = connect(address, timeout="10s", set_as_default=False)
    except (OSError, ValueError, TimeoutError, ImportError) as error:
        said = str(error).partition("\n")[0]
        raise InputError(f"no scheduler of dask answers: {said}", where=address) from None
    with client:
        threads = sum(client.ncores().values())
        with client.get_executor() as executor:
            yield executor, max(1, min(256, threads))
