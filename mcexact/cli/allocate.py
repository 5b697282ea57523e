"""`mcexact allocate`: find the least that agents must share, or the links to add."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.commands import DEFINITE_NO

if TYPE_CHECKING:
    from mcexact.answer.account import Account
    from mcexact.exact.roots import StabilityRegion


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
    help="Number of nodes of the branch tree after which the search ends with status 4.",
)
@options.page("the answers, a picture and all certificates")
@options.answering
def command(file: str, **given: Any) -> int:
    """Find the least dimensions that the agents of the system in FILE must share.

    The file needs a neighbor graph. The answer is the least total dimension of shared sub-states
    for which no mode is fixed, with a proof that no smaller dimension suffices. It names the
    subsets of agents that require it, and gives the uniform bound of the paper's Theorem 2 for
    comparison. If no dimensions suffice, the status is 1. With --links, the answer is the cheapest
    set of communication links for which no mode is fixed.
    """

    from mcexact.cli.files import require_apart, require_page, write_result
    from mcexact.cli.running import Rechecked, Run, show_tables

    run, html = Run(given), given.pop("html")
    require_page(html, run.certificates, file)
    require_apart(html, run.certificates)
    plant = run.read(file)
    answer = run.result(
        _answer,
        plant,
        run.limits,
        given,
        html is not None,
        run.system_by_digest,
        doing=f"allocating for {plant[0]}",
    )

    def write(checked: Rechecked) -> None:
        if html is not None:
            write_result(html, answer["page"].rendered(answer["certificates"], checked.verdicts))

    about = f"the answers about {plant[0]}"
    run.conclude(answer, show_tables(answer), about=about, write=write).require_complete()
    return 0 if answer["feasible"] else DEFINITE_NO


def _answer(
    plant: tuple[str, bytes],
    limits: dict[str, int],
    question: dict[str, Any],
    with_page: bool,
    system_by_digest: bool,
) -> dict[str, Any]:
    """Decide and format the answer, in the child process."""
    from mcexact.analysis.analyze import account_of_dimensions, account_of_links
    from mcexact.cli.files import system_in
    from mcexact.cli.running import told
    from mcexact.report.text import tables

    system = system_in(*plant, limits)
    region = _region(system.time, question.pop("rate"), question.pop("radius"))
    if question.pop("links"):
        account = account_of_links(system, **_links(question, region))
        least = account.answers["minimal_communication"]
    else:
        account = account_of_dimensions(system, **_dimensions(system.names, question, region))
        least = account.answers["minimal_shared_dimensions"]
    page = None
    if with_page:
        from mcexact.report.pages import allocation_page

        page = allocation_page(account)
    return told(account, system_by_digest) | {
        "page": page,
        "json": account.as_json(**_shares(account)),
        "tables": tables(account.sentences),
        "feasible": least.feasible,
    }


def _shares(account: Account) -> dict[str, Any]:
    """The dimensions by agent and in all: the least, and those of a bound that holds."""
    from mcexact.answer.sharing import ROW_BOUND

    least = account.answers.get("minimal_shared_dimensions")
    if least is None or least.dimensions is None:
        return {}
    holds = any(each.template.key == ROW_BOUND.key for each in account.sentences)
    k = account.answers["shared_dimension_bound"].deficiency if holds else None
    named = zip(account.given.names, least.dimensions, strict=True)
    total = {"least": least.total, "bound": None if k is None else k * account.given.m}
    by_agent = {agent: {"least": size, "bound": k} for agent, size in named}
    return {"shares": {"by_agent": by_agent, "total": total}}


def _region(time: str, rate: Fraction | None, radius: Fraction | None) -> StabilityRegion | None:
    """Return the region of the rate or the radius; a rate of 0 means stability."""
    from mcexact.errors import UsageError
    from mcexact.exact.roots import StabilityRegion

    own = StabilityRegion(time).word
    given = {"rate": rate, "radius": radius}
    bound = given.pop(own)
    if any(other is not None for other in given.values()):
        raise UsageError(f"the system is in {time} time: give --{own}")
    return None if bound is None else StabilityRegion.of(time, bound=bound)


def _dimensions(
    names: Sequence[str], question: dict[str, Any], region: StabilityRegion | None
) -> dict[str, Any]:
    """Return the arguments of `minimal_shared_dimensions`."""
    from mcexact.errors import UsageError
    from mcexact.exact.rational import parse_rational

    if question["dimensions"] or question["link_costs"] or question["forbid"]:
        raise UsageError("--dimensions, --link-cost and --forbid go with --links")
    prices = _by_agent(names, question["costs"], "--cost", parse_rational)
    most = _by_agent(names, question["upper"], "--upper", options.count)
    return {
        "share": question["share"],
        "costs": [prices.get(name, 1) for name in names],
        "upper": [most.get(name) for name in names],
        "region": region,
        "free_assignability": question["free"],
        "node_limit": question["node_limit"],
    }


def _by_agent(
    names: Sequence[str], pairs: Sequence[tuple[str, str]], option: str, read: Callable[[str], Any]
) -> dict[str, Any]:
    """Parse the values given for agents."""
    from mcexact.errors import UsageError

    found = {}
    for name, text in pairs:
        if name not in names:
            raise UsageError(f"{option}: there is no agent {name!r}")
        try:
            found[name] = read(text)
        except ValueError:  # an InputError is one
            raise UsageError(f"{option} {name}: expected a number, found {text!r}") from None
    return found


def _links(question: dict[str, Any], region: StabilityRegion | None) -> dict[str, Any]:
    """Return the arguments of `minimal_communication`."""
    from mcexact.errors import UsageError
    from mcexact.exact.rational import parse_rational

    if question["costs"] or question["upper"] or question["free"]:
        raise UsageError("--cost, --upper and --free do not go with --links")
    sizes = None
    costs: dict[tuple[str, str], Any] = {}
    for j, i, price in question["link_costs"]:
        costs[j, i] = _by_agent([i], [(i, price)], f"--link-cost {j}", parse_rational)[i]
    if question["dimensions"] is not None:
        try:
            sizes = [options.count(size) for size in question["dimensions"].split(",")]
        except ValueError:
            raise UsageError("--dimensions: expected integers >= 0 such as 0,0,1") from None
    return {
        "dimensions": sizes,
        "share": "outputs" if sizes is None else question["share"],
        "costs": costs,
        "forbidden": question["forbid"],
        "region": region,
        "node_limit": question["node_limit"],
    }
