"""Text for people: tables on a terminal, plain lines when piped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TextIO

from mcexact.errors import LimitReached
from mcexact.report.assessment import Assessment, ChannelAnswers

if TYPE_CHECKING:
    from mcexact.analysis.allocation import SharedDimensions
    from mcexact.analysis.assignability import Assignability
    from mcexact.analysis.complementary_subsystem import ComplementarySubsystem
    from mcexact.analysis.controllability import JointControllability
    from mcexact.analysis.controllability_indices import ControllabilityIndices
    from mcexact.analysis.fixed_spectrum import FixedFactor, FixedSpectrum
    from mcexact.analysis.setpoint import SetpointSolvability
    from mcexact.analysis.single_channel_gains import SingleChannelGains
    from mcexact.analysis.transfer_graph import TransferGraph


@dataclass(frozen=True)
class Table:
    """A table with a title; without columns it is a list of names and values."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def assessment_tables(assessment: Assessment) -> tuple[Table, ...]:
    """The answers of `analyze`, as tables."""
    system = assessment.system
    heading = (
        f"{system.name or 'system'}: {count(system.n, 'state')}, "
        f"{count(system.m, 'channel')} {_set(system.names)}, {system.time} time"
    )
    if assessment.information == "outputs":
        heading += "; each agent feeds back the outputs of all its neighbors"
    spectrum = assessment.fixed_spectrum
    rows = [
        ("jointly controllable", _controllable(assessment.controllability)),
        ("jointly observable", _controllable(assessment.observability)),
        ("transfer graph", _transfer_graph(assessment.transfer_graph)),
        ("fixed spectrum", "empty" if spectrum.empty else shorten(str(spectrum.polynomial))),
        ("decentrally stabilizable", _yes(spectrum.stabilizable)),
        ("best decay rate" if system.time == "continuous" else "least radius", _rate(spectrum)),
        ("complete", _yes(assessment.completeness.complete)),
        ("controllability indices", _indices(assessment.controllability_indices)),
        ("observability indices", _indices(assessment.observability_indices)),
        ("spectrum", _assignability(assessment.assignability)),
        ("set-points", _setpoint(assessment.setpoint)),
    ]
    if assessment.every_channel is not None:
        rows.append(("through every channel", _gains(assessment, assessment.every_channel)))
    rows += _of_the_graph(assessment)
    tables = [Table(heading, (), tuple(rows))]
    if not spectrum.empty:
        tables.append(_fixed_modes(assessment))
    if assessment.pencil_ranks:
        tables.append(_pencil_ranks(assessment))
    if assessment.complementary_subsystem is not None:
        tables.append(_complementary_subsystem(assessment.complementary_subsystem))
    if assessment.channel is not None:
        tables.append(_channel(assessment, assessment.channel))
    return tuple(tables)


def _of_the_graph(assessment: Assessment) -> list[tuple[str, str]]:
    """What depends on the neighbor graph."""
    if assessment.neighbor_graph is None:
        return []
    connected = _yes(assessment.neighbor_graph.strongly_connected)
    rows = [("neighbor graph strongly connected", connected)]
    for share, bound in assessment.shared_dimension_bounds.items():
        enough = f"{bound.per_agent} by each agent, {bound.total} together"
        rows.append((f"enough to share ({share})", enough))
    for share, least in (assessment.minimal_shared_dimensions or {}).items():
        rows.append((f"least to share ({share})", _least(assessment, least)))
    delayed = assessment.delayed
    if delayed is not None:
        for name, verdict, sizes in (
            ("lifted", delayed.lifted, delayed.lifted_dimensions),
            ("held", delayed.held, delayed.held_dimensions),
        ):
            fixed = "nothing"
            if not verdict.nothing_fixed:
                fixed = f"the roots of {shorten(str(verdict.spectrum.polynomial))}"
            said = f"{fixed}, of {verdict.system.n} states, {sizes[0]} shared by each agent"
            rows.append((f"fixed with delays, {name}", said))
    return rows


def _setpoint(found: SetpointSolvability) -> str:
    """Whether every output can be held, or what stands against it."""
    if found.solvable:
        return "every output can be held at any set-point"
    if found.invariant_zero:
        return "not all can be held: an invariant zero"
    return "not all can be held: the outputs are dependent"


def _least(assessment: Assessment, least: SharedDimensions | LimitReached) -> str:
    """The least dimensions, or why there are none."""
    if isinstance(least, LimitReached):
        return str(least)
    if least.dimensions is None:
        return "no amount of sharing over this graph suffices"
    names = assessment.system.names
    used = [f"{n} by {name}" for name, n in zip(names, least.dimensions, strict=True) if n]
    return f"{least.total}: {', '.join(used)}" if used else "nothing"


def _pencil_ranks(assessment: Assessment) -> Table:
    """One row for each mode of A, for the subset that was asked about."""
    n = assessment.system.n
    return Table(
        f"rank of [xI-A, B of the others; C of s, 0] for s = "
        f"{_set(assessment.pencil_ranks[0].subset)}",
        ("mode of A", "rank", "below n"),
        tuple(
            (shorten(str(found.polynomial)), str(found.rank), _yes(found.rank < n))
            for found in assessment.pencil_ranks
        ),
    )


def _indices(found: ControllabilityIndices | None) -> str:
    """The partition, and the index where there is one."""
    if found is None:
        return "left out: many states for few ports; ask for them from Python"
    listed = shorten(", ".join(map(str, found.indices)) or "none")
    return listed if found.index is None else f"{listed}; index {found.index}"


def _assignability(found: Assignability) -> str:
    """Free, or the parts that belong to the strong components."""
    if found.free:
        return "freely assignable"
    blocks = ", ".join(f"{block.dimension} by {_set(block.channels)}" for block in found.blocks)
    fixed = f"; {found.fixed_degree} by no gain" if found.fixed_degree else ""
    return f"moved in parts: {shorten(blocks, 120)}{fixed}"


def _complementary_subsystem(found: ComplementarySubsystem) -> Table:
    """One row for each answer about the subsystem."""
    zeros = ", ".join(str(z.polynomial) for z in found.zeros)
    rows = (
        ("normal rank", str(found.normal_rank)),
        ("invariant zeros", shorten(f"the roots of {zeros}") if zeros else "none"),
        ("remnant polynomial", shorten(str(found.remnant))),
        ("complete", f"{_yes(found.complete)}: {shorten(found.reason, 120)}"),
    )
    return Table(f"complementary subsystem of s = {_set(found.subset)}", (), rows)


def _channel(assessment: Assessment, found: ChannelAnswers) -> Table:
    """One row for each answer about the channel."""
    rows = [
        ("controllable alone", _controllable(found.controllability)),
        ("observable alone", _controllable(found.observability)),
    ]
    rows += [
        (f"{want} with gains", _gains(assessment, gains)) for want, gains in found.gains.items()
    ]
    return Table(f"channel {shorten(found.name)}", (), tuple(rows))


def _gains(assessment: Assessment, found: SingleChannelGains) -> str:
    """Gains, where they are short, and the indices they reach; or why there are none."""
    if found.gains is None or found.indices is None:
        return f"no: {shorten(found.reason, 120)}"
    listed = [
        f"F_{name} = {[[str(entry) for entry in row] for row in F.rows()]}".replace("'", "")
        for name, F in zip(assessment.system.names, found.gains, strict=True)
        if not F.is_zero()
    ]
    reached = ", ".join(" and ".join(map(str, pair)) for pair in found.indices)
    return f"yes, indices {shorten(reached)}, {shorten(', '.join(listed) or 'no gains', 120)}"


def _fixed_modes(assessment: Assessment) -> Table:
    """One row for each factor of the fixed spectrum."""
    system = assessment.system
    return Table(
        "fixed modes: no decentralized controller moves them",
        ("mode", "roots", "stable", "in A", "at most", "s", "rank"),
        tuple(
            (
                shorten(str(factor.polynomial)),
                shorten(_roots(factor)),
                _yes(factor.stable),
                str(factor.multiplicity_in_A),
                str(factor.multiplicity_at_most),
                _set(factor.channels),
                f"{factor.rank} of {system.n}",
            )
            for factor in assessment.fixed_spectrum.factors
        ),
        note="rank: of [xI-A, B of the channels outside s; C of the channels in s, 0] at the mode. "
        "in A: its multiplicity in A; at most: the multiplicity that no gain removes, from above.",
    )


def _transfer_graph(graph: TransferGraph) -> str:
    """The arcs, where they are few, the components, and the channels without effect."""
    arcs = ", ".join(f"{start} -> {end}" for start, end in graph.arcs)
    said = arcs if 0 < len(arcs) <= 60 else count(len(graph.arcs), "arc")
    if graph.strongly_connected:
        said += "; strongly connected"
    else:
        components = " ".join(_set(component) for component in graph.components)
        said += f"; components {shorten(components, 120)}"
    return f"{said}; dead channels {_set(graph.dead)}" if graph.dead else said


def _controllable(verdict: JointControllability) -> str:
    """Yes, or the modes that are out of reach."""
    if verdict.controllable:
        return "yes"
    return f"no, out of reach: the roots of {shorten(str(verdict.uncontrollable_polynomial))}"


def _roots(factor: FixedFactor) -> str:
    """The centers of the enclosures, cut to a few digits; a rational root exactly."""
    if factor.polynomial.degree == 1:
        return str(-factor.polynomial.coefficients[0])
    return ", ".join(_complex(disc.re, disc.im) for disc in factor.roots)


def _complex(re: str, im: str) -> str:
    """A complex number in six significant digits."""
    real, imaginary = float(re), float(im)
    if imaginary == 0:
        return f"{real:.6g}"
    return f"{real:.6g}{imaginary:+.6g}i"


def _rate(spectrum: FixedSpectrum) -> str:
    """The best rate, to the digits that its enclosure is sure of."""
    rate = spectrum.best_rate
    if rate is None:
        return "any: nothing is fixed"
    if rate.lower == rate.upper:
        return shorten(rate.lower, 24)
    return f"between {shorten(rate.lower, 24)} and {shorten(rate.upper, 24)}"


def _yes(value: bool) -> str:
    return "yes" if value else "no"


def count(number: int, noun: str) -> str:
    """A number with its noun, such as 2 nodes."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _set(names: Iterable[str], limit: int = 12) -> str:
    """Channels in braces; a long list is cut."""
    listed = list(names)
    more = [f"… {len(listed) - limit} more"] if len(listed) > limit else []
    return shorten("{" + ", ".join(listed[:limit] + more) + "}", 120)


def shorten(text: str, limit: int = 60) -> str:
    """The text, cut in the middle if it is long.

    Examples
    --------
    >>> shorten("0123456789" * 20, 21)
    '0123456789…0123456789'
    """
    if len(text) <= limit:
        return text
    half = (limit - 1) // 2
    return f"{text[:half]}…{text[-half:]}"


def plain(tables: Sequence[Table]) -> str:
    """The tables as aligned lines."""
    return "\n".join(_plain(table) for table in tables)


def _plain(table: Table) -> str:
    rows = [table.columns, *table.rows] if table.columns else list(table.rows)
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    lines = [table.title]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        lines.append(("  " + "  ".join(cells)).rstrip())
    if table.note:
        lines.append(f"  ({table.note})")
    return "\n".join(lines) + "\n"


def show(tables: Sequence[Table], stream: TextIO) -> None:
    """Draw the tables on a terminal."""
    from rich.console import Console
    from rich.table import Table as Drawn
    from rich.text import Text

    console = Console(file=stream)
    for table in tables:
        drawn = Drawn(
            title=Text(table.title, style="bold"),
            caption=Text(table.note) if table.note else None,
            title_justify="left",
            caption_justify="left",
            show_header=bool(table.columns),
        )
        for column in table.columns or ("", ""):
            drawn.add_column(Text(column))
        for row in table.rows:
            drawn.add_row(*(Text(cell) for cell in row))
        console.print(drawn)
