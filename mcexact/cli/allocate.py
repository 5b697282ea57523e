"""`mcexact allocate`: the options of a search for the least that agents share, or links to add.

`mcexact.cli.decisions.allocated` reads the prices and limits of agents and links, once the names of
the agents are known, and decides, in a child process.
"""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import options
from mcexact.cli.commands import DEFINITE_NO
from mcexact.cli.files import require_apart, require_page, write_result
from mcexact.cli.results import Allocated
from mcexact.cli.running import Rechecked, Run, show_tables
from mcexact.errors import LimitReached


@click.command(name="allocate", short_help="Find the least that agents must share, and prove it.")
@click.argument("file")
@click.option(
    "--share",
    type=click.Choice(["outputs+states", "states"]),
    default="outputs+states",
    show_default=True,
    help="Signals that an agent sends to its followers.",
)
@click.option("--links", is_flag=True, help="Find the cheapest communication links to add instead.")
@click.option(
    "--dimensions",
    metavar="N,N,…",
    help="With --links: dimensions of the shared sub-states; by default only outputs are shared.",
)
@click.option(
    "--cost",
    "costs",
    nargs=2,
    multiple=True,
    metavar="AGENT PRICE",
    help="Price of one dimension of an agent's sub-state, by default 1. May be repeated.",
)
@click.option(
    "--upper",
    nargs=2,
    multiple=True,
    metavar="AGENT N",
    help="Largest dimension that an agent may share. May be repeated.",
)
@click.option(
    "--link-cost",
    "link_costs",
    nargs=3,
    multiple=True,
    metavar="FROM TO PRICE",
    help="With --links: price of a link, by default 1. May be repeated.",
)
@click.option(
    "--forbid",
    nargs=2,
    multiple=True,
    metavar="FROM TO",
    help="With --links: a link that must not be added. May be repeated.",
)
@click.option("--rate", type=options.rational, help="Consider only modes slower than this rate.")
@click.option("--radius", type=options.rational, help="Consider only modes outside this radius.")
@click.option(
    "--free", is_flag=True, help="Also make the whole closed-loop spectrum freely assignable."
)
@click.option(
    "--node-limit",
    type=click.IntRange(min=1),
    default=10_000,
    show_default=True,
    help="Number of nodes of the branch tree after which the search ends with status 4, and with "
    "dimensions that suffice and a lower bound.",
)
@options.page("the answers, a picture and all certificates")
@options.answering
def command(file: str, **values: Any) -> int:
    """Find the least dimensions that the agents of the system in FILE must share.

    The file needs a neighbor graph. The answer is the least total dimension of shared sub-states
    for which no mode is fixed, with a proof that no smaller dimension suffices. It names the
    subsets of agents that require it, and gives the uniform bound of the paper's Theorem 2 for
    comparison. If no dimensions suffice, the status is 1. With --links, the answer is the cheapest
    set of communication links for which no mode is fixed.
    """
    run, html = Run(values), values.pop("html")
    require_page(html, run.certificates, file)
    require_apart(html, run.certificates)
    plant = run.read(file)
    answer = run.result(
        _allocated,
        plant,
        run.limits,
        values,
        html is not None,
        run.system_by_digest,
        doing=f"allocating for {plant[0]}",
    )

    def write(checked: Rechecked) -> None:
        if html is not None and answer.page is not None:
            page = answer.page.rendered(answer.evidence.certificates, checked.verdicts)
            write_result(html, page)

    about = f"the answers about {plant[0]}"
    run.conclude(answer, show_tables(answer), about=about, write=write).require_complete()
    if answer.within:
        return LimitReached.exit_status
    return 0 if answer.feasible else DEFINITE_NO


def _allocated(*arguments: Any) -> Allocated:
    """Decide and format the answer, in the child process."""
    # The child process alone loads what decides: the clock runs while it does, and Ctrl-C ends it.
    from mcexact.cli.decisions import allocated

    return allocated(*arguments)
