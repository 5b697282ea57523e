"""Pictures of neighbor and transfer graphs with a colored obstruction, and of links to add."""

from __future__ import annotations

from mcexact.answer.account import Account
from mcexact.plot.canvas import one_axis
from mcexact.plot.graphs import graph, graph_size, structure
from mcexact.report.picture import Picture

_NEIGHBORS, _TRANSFER = "picture-neighbor-graph", "picture-transfer-graph"


def graph_pictures(account: Account) -> list[Picture]:
    """Draw the neighbor graph, if there is one, and the transfer graph, one picture for each.

    Parameters
    ----------
    account : Account
        An account with the transfer graph and the fixed spectrum; see `structure`.
    """
    system, said, answers = account.given.system, account.sentences, account.answers
    panels = [_NEIGHBORS, _TRANSFER] if system.neighbors is not None else [_TRANSFER]
    axes = [one_axis(None, *graph_size(system.m)) for _ in panels]
    structure(system, answers["fixed_spectrum"], answers["transfer_graph"], axes)
    title, sentences = "".join(said.at("graphs.title")), said.at("graphs")
    pictures = []
    for panel, axis in zip(panels, axes, strict=True):
        others = {_NEIGHBORS, _TRANSFER} - {panel}
        told = [each for each in sentences if each.template.key not in others]
        pictures.append(Picture(axis.figure, title, "; ".join(told) + "."))
    return pictures


def links_picture(account: Account) -> Picture:
    """Draw the neighbor graph with the links to add.

    Parameters
    ----------
    account : Account
        An account with links to add, as `account_of_links` returns it.
    """
    system, added = account.given.system, account.answers["minimal_communication"].added
    names, there = system.names, system.neighbors
    edges = [] if there is None else [(names[j], names[i]) for j, i in there.edges()]
    axis = one_axis(None, *graph_size(system.m))
    graph((names, [*edges, *added]), axis, added=added, title="neighbor graph")
    told = ", ".join(f"{start} → {end}" for start, end in added)
    words = f"Blue: the links to add, {told}." if added else "No links have to be added."
    return Picture(axis.figure, "Links", words)
