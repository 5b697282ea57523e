"""Pictures of neighbor and transfer graphs with a colored obstruction, and of dimensions."""

from __future__ import annotations

from mcexact.answer.account import Account
from mcexact.plot.canvas import empty_figure, one_axis
from mcexact.plot.graphs import MARKED, graph_size, structure
from mcexact.report.picture import Picture

LEAST = {
    "outputs+states": "minimal_shared_dimensions_outputs_states",
    "states": "minimal_shared_dimensions_states",
}
"""The question about each way of sharing."""
_BOUNDS = {
    "outputs+states": "shared_dimension_bound_outputs_states",
    "states": "shared_dimension_bound_states",
}
_NEIGHBORS, _TRANSFER = "picture-neighbor-graph", "picture-transfer-graph"
_SHARING = ("sufficient to share", "least to share")


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


def dimensions_picture(account: Account) -> Picture:
    """Draw bars for every agent: the least dimensions for each way of sharing, and the bound.

    Parameters
    ----------
    account : Account
        An account with the least dimensions for some way of sharing.
    """
    names, said, answers = account.given.names, account.sentences, account.answers
    least = {share: answers[name] for share, name in LEAST.items() if name in answers}
    told = [each for each in said.at("table") if each.template.label in _SHARING]
    read = {file for each in told for file, *_ in each.because}
    holds = any(file.startswith("shared_dimension_bound") for file in read)
    figure = empty_figure(4.4 * len(least), 3.2)
    for axis, (share, found) in zip(
        figure.subplots(1, len(least), squeeze=False)[0], least.items(), strict=True
    ):
        sizes = (0,) * len(names) if found.dimensions is None else found.dimensions
        places = range(len(names))
        bound = answers[_BOUNDS[share]].deficiency if holds else None
        if bound is not None:
            axis.bar(
                [k - 0.2 for k in places],
                [bound] * len(names),
                0.4,
                color="#bbbbbb",
                label="bound of the paper",
            )
        axis.bar([k + 0.2 for k in places], sizes, 0.4, color=MARKED, label="least")
        axis.set_xticks(list(places), names, parse_math=False)
        axis.set_yticks(range(max(bound or 0, *sizes, 1) + 1))
        axis.set_xlabel("agent")
        axis.set_ylabel("shared dimension")
        axis.set_title(share, fontsize="medium")
        axis.legend(fontsize="small", loc="upper center")
        axis.margins(y=0.35)
    caption = "; ".join(each.line for each in told) + "."
    return Picture(figure, "".join(said.at("dimensions.title")), caption)
