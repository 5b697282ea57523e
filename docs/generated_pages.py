"""Pages that are made from the package itself, so that they are as it is."""

from __future__ import annotations

import importlib
import inspect
import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

import mcexact
from mcexact.analysis.patterns import why_fixed
from mcexact.answer.modes import FixedFactor
from mcexact.answer.templates import count, modes
from mcexact.cli import command_line
from mcexact.constructions import merged
from mcexact.crosschecks.gallery import exhibits, shown
from mcexact.model import gallery
from mcexact.model.gallery import published
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.notebook import table

ROOT = Path(__file__).parents[1]
ROWS = ROOT / "benchmarks" / "rows"


def write_pages(folder: Path) -> None:
    """Write all generated pages and copy the notebooks, both below ``generated/``."""
    made = folder / "generated"
    shutil.rmtree(made, ignore_errors=True)
    (made / "notebooks").mkdir(parents=True)
    for notebook in sorted((ROOT / "notebooks").glob("*.ipynb")):
        shutil.copy(notebook, made / "notebooks")
    (made / "interface").mkdir()
    pages = {
        **interface_pages(),
        "gallery.md": gallery_page(),
        "commands.md": commands_page(),
        "certificates.md": certificates_page(),
        "exhibits.md": _table(_exhibits()),
        "designs.md": _table(_by_hand()),
        "speed.md": _table(_speed()),
        "examinations.md": examinations_page(),
    }
    for name, text in pages.items():
        (made / name).write_text(text, encoding="utf-8")


def interface_pages() -> dict[str, str]:
    """A page for the names at the top and one for each public module; numpydoc sets docstrings."""
    said = inspect.getdoc(mcexact) or ""
    modules = re.findall(r"^`(\w+)`  ", said, re.M)
    groups = re.findall(r"^(\w[^\n]*)\n((?:    [A-Za-z][\w ]*\n)+)", said, re.M)
    top = [
        "# The Python interface",
        "",
        "These are all public names. Other names may change without notice. Every example on these",
        "pages runs as a test.",
        "",
        "```{toctree}",
        *(f"interface/{module}" for module in modules),
        "```",
        "",
    ]
    for title, names in groups:
        top += [f"## {title}", "", *_summary("mcexact", names.split(), "api")]
    return {
        "api.md": "\n".join(top),
        **{f"interface/{module}.md": _module_page(f"mcexact.{module}") for module in modules},
    }


def _module_page(module: str) -> str:
    """What a public module says of itself, which begins with its use, and its names."""
    said = ["```{eval-rst}", f".. automodule:: {module}", "```", ""]
    return "\n".join([f"# {module}", "", *said, *_summary(module, public(module), "../api")])


def _summary(module: str, names: list[str], place: str) -> list[str]:
    """A table of names, each with a page of its own."""
    lines = ["```{eval-rst}", f".. currentmodule:: {module}", "", ".. autosummary::"]
    return [
        *lines,
        f"   :toctree: {place}",
        "   :nosignatures:",
        "",
        *(f"   {name}" for name in names),
        "```",
        "",
    ]


def public(module: str) -> list[str]:
    """The public functions and classes of a module of the package."""
    found = importlib.import_module(module)
    named = {name: getattr(found, name) for name in getattr(found, "__all__", dir(found))}
    return sorted(
        name
        for name, value in named.items()
        if name[0] != "_" and callable(value) and value.__module__.startswith("mcexact.")
    )


def gallery_page() -> str:
    """An entry for each plant of the gallery: its size, its fixed modes, and its source."""
    lines = [
        "# Gallery",
        "",
        "These plants ship with the package: `mcexact analyze gallery:NAME` takes one by its name.",
        "Decimals are exact as typed. The fixed modes are what two independent programs computed",
        "exactly, where they have been recorded.",
        "",
    ]
    for name in gallery.names():
        plant, known = gallery.load(name), _expected(name)
        source = plant.source or known.get("source") or ""
        size = f"{count(plant.n, 'state')}, {count(plant.m, 'channel')}, {plant.time} time"
        lines += [f"`{name}`", f": {size}. {_fixed(known)}", "", f"  {source}", ""]
    lines += [*classified(), ""]
    lines += [
        "## With parameters",
        "",
        "`mcexact analyze gallery:NAME` decides these for all values, and `--at NAME=1/2` at one;",
        "`load_parametric_system` reads them.",
        "",
    ]
    for each in published():
        if each.parameters:
            word = "parameter" if len(each.parameters) == 1 else "parameters"
            size = f"{each.n} states, {each.m} channels, {word} {', '.join(each.parameters)}"
            lines += [f"`{each.name}`", f": {size}. {each.shows[:1].upper()}{each.shows[1:]}.", ""]
            lines += [f"  {each.source}", ""]
    return "\n".join(lines)


def classified() -> list[str]:
    """A table of all fixed modes of the gallery: why each is fixed, and what would move it."""
    lines = [
        "## Why their modes are fixed, and what would move them",
        "",
        "A mode is *joint* if all channels together do not control it, or not observe it, and",
        "*decentralized* if it stays fixed in a minimal realization. The zeros fix it if it stays",
        "fixed with all other numbers at the places of the nonzero entries, but those among states",
        "without feedback; else equalities of entries do, and almost all other numbers free it.",
        "The last two columns say whether",
        "[control that varies in time](../how-to/time-varying-control.md) moves it, and the fewest",
        "links along which sending outputs leaves no mode of the plant fixed. All of it is decided",
        "with certificates.",
        "Plants with [feedthrough](../how-to/feedthrough.md) are left out.",
        "",
        "| plant | modes | stable | missed by | fixed by | time-varying control | links |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in gallery.names():
        plant = gallery.load(name)
        rows = fixed_modes_of(plant) if plant.D is None else []
        lines += [f"| `{name}` | {' | '.join(row)} |" for row in rows]
    return lines


def fixed_modes_of(plant: MultiChannelSystem) -> list[tuple[str, ...]]:
    """A row for each irreducible factor of the fixed polynomial, as `classified` heads it."""
    spectrum = mcexact.fixed_spectrum(plant)
    if spectrum.empty:
        return []
    by_zeros = why_fixed(plant, spectrum).by_zeros
    components = mcexact.transfer_graph(plant).components
    quotient = mcexact.fixed_spectrum(merged(plant, components)).polynomial
    left = mcexact.fixed_spectrum(mcexact.minimal_realization(plant).system).polynomial
    lost = [
        mcexact.joint_controllability(plant).uncontrollable_polynomial,
        mcexact.joint_observability(plant).uncontrollable_polynomial,
    ]
    added = mcexact.minimal_communication(plant).added
    links = "none help" if added is None else ", ".join(f"{a} → {b}" for a, b in added)

    def row(factor: FixedFactor) -> tuple[str, ...]:
        p = factor.polynomial
        joint = any(p.divides(each) for each in lost)
        kinds = ["joint"] * joint + ["decentralized"] * p.divides(left)
        return (
            modes(p, 12) if p.degree < 3 else f"{p.degree} modes",
            "yes" if factor.stable else "no",
            " and ".join(kinds),
            "zeros" if p in by_zeros else "equalities",
            "does not move it" if p.divides(quotient) else "moves it",
            links or "those it has",
        )

    return [row(factor) for factor in spectrum.factors]


def _fixed(known: dict[str, Any]) -> str:
    """What is known of the fixed modes of a plant."""
    factors = known.get("fixed_factors")
    if factors is None:
        return ""
    if not factors:
        return "No mode is fixed."
    listed = " and ".join(f"`{_tidy(each['factor'])}`" for each in factors)
    return f"Fixed modes: the roots of {listed}."


def _expected(name: str) -> dict[str, Any]:
    try:
        return gallery.expected(name)
    except KeyError:
        return {}


def _tidy(factor: str) -> str:
    """A factor without signs in brackets."""
    return re.sub(r"\+ \(-([^()]*)\)", r"- \1", factor)


def commands_page() -> str:
    """The help of every command, as it is printed."""
    lines = [
        "# The command line",
        "",
        "The words of commands and answers, such as [complete](../glossary.md#complete),",
        "[box](../glossary.md#box), [margin](../glossary.md#margin) and",
        "[sensible rate](../glossary.md#sensible-rate), are explained in the",
        "[glossary](../glossary.md).",
        "",
    ]
    context = click.Context(command_line, info_name="mcexact", max_content_width=88)
    for path, command in _commands(command_line, context, ("mcexact",)):
        title = " ".join(path)
        lines += [f"{'##' if len(path) < 3 else '###'} `{title}`", "", "```text"]
        with click.Context(command, info_name=title, max_content_width=88) as own:
            lines += [command.get_help(own), "```", ""]
    return "\n".join(lines)


def _commands(
    group: click.Group, context: click.Context, path: tuple[str, ...]
) -> Iterator[tuple[tuple[str, ...], click.Command]]:
    """Every command of a group, and of the groups in it."""
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        if command is not None:
            yield (*path, name), command
            if isinstance(command, click.Group):
                yield from _commands(command, context, (*path, name))


def certificates_page() -> str:
    """FORMAT.md, with the paths of files in the repository in the place of links to them."""
    text = (ROOT / "mcexact" / "answer" / "FORMAT.md").read_text(encoding="utf-8")
    return re.sub(r"\[([^\]]+)\]\((?!#|http)([^)]+)\)", r"\1 (`\2`)", text)


def examinations_page() -> str:
    """What `mcexact reproduce` carries out, from the ledger of the package."""
    head = """# The examinations of the paper

What `mcexact reproduce` carries out: for every row its instances, the code that decides them, the
certificates that the independent checker verifies, and false statements nearby that an instance has
to refute. An instance has content where the statement says something about it. The numbers of
statements are those of the list that `mcexact reproduce` prints, and of `proofs/STATEMENTS.md`.

"""
    return head + table()


def _table(lines: list[str]) -> str:
    return "\n".join([*lines, ""])


def _exhibits() -> list[str]:
    """What was recorded in floating point beside what is true."""
    lines = ["| system | question | recorded | exact |", "|---|---|---|---|"]
    for found in map(shown, exhibits()):
        cells = (
            found.exhibit.name,
            found.exhibit.question,
            found.exhibit.record.floating,
            found.here.exact,
        )
        lines.append("| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |")
    return lines


def _rows(stem: str) -> list[dict[str, Any]]:
    lines = (ROWS / f"{stem}.jsonl").read_text(encoding="utf-8").splitlines()
    return [json.loads(line) for line in lines]


def _by_hand() -> list[str]:
    """Designs beside those that an engineer makes by hand from the usual functions."""
    methods = ("static BFGS", "local LQR", "local LQG", "python-control")
    lines = [
        "| plant | mcexact | " + " | ".join(methods) + " |",
        "|---|---|" + "---|" * len(methods),
    ]
    for row in _rows("families"):
        if row["answer"] != "designed" or not row.get("by hand"):
            continue
        own = {**row, "over bound": row["ratio"]}
        hand = row["by hand"]
        cells = [
            _figures(own),
            *("–" if each not in hand else _figures(hand[each]) for each in methods),
        ]
        lines.append(f"| {row['name']} | " + " | ".join(cells) + " |")
    return lines


def _figures(found: dict[str, Any] | None) -> str:
    """The cost over the bound, the least disk margin and the order, or that there is none."""
    if found is None or found["over bound"] is None or found["disk"] is None:
        return "none"
    return f"cost {found['over bound']:.3g}, disk {found['disk']:.2f}, order {found['order']}"


def _speed() -> list[str]:
    """The kept times, beside those of numpy where it is the peer."""
    lines = ["| question | ratio | aimed at | seconds, mcexact and peer |", "|---|---|---|---|"]
    for part in _rows("speed"):
        for row in part["rows"]:
            if row.get("unit") != "x":
                continue
            value = f"{row['ratio']:.3g}" if row["ratio"] < 1000 else f"{row['ratio']:.0f}"
            short = "" if row.get("holds") is not False else "**falls short**"
            detail = str(row.get("detail", "")).replace("|", "\\|")
            lines.append(
                f"| {row['question']} | {value} | {row.get('limit', '')} | {detail} {short} |"
            )
    return lines
