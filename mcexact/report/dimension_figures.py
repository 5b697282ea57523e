"""Pictures of the dimensions that agents share, beside the bound of the paper."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.answer.account import Account
from mcexact.plot.canvas import empty_figure
from mcexact.plot.graphs import MARKED
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
_SHARING = ("sufficient to share", "least to share")
_NAMED = 12
"""The largest number of agents whose names stand upright below their bars."""


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
        bound = answers[_BOUNDS[share]].deficiency if holds else None
        _draw_bars(axis, names, sizes, bound, share)
    caption = "; ".join(each.line for each in told) + "."
    return Picture(figure, "".join(said.at("dimensions.title")), caption)


def allocation_picture(account: Account) -> Picture:
    """Draw bars for every agent: the least dimensions, and the bound if its hypotheses hold.

    Parameters
    ----------
    account : Account
        An account as `account_of_dimensions` returns it, with dimensions that suffice.
    """
    least, said = account.answers["minimal_shared_dimensions"], account.sentences
    compared = any(each.template.key == "allocate-total-bound" for each in said.at("table"))
    bound = account.answers["shared_dimension_bound"].deficiency if compared else None
    names = account.given.names
    figure = empty_figure(max(4.4, min(1.5 + 0.3 * len(names), 9.0)), 3.2)
    _draw_bars(figure.subplots(), names, least.dimensions, bound, least.share)
    words = "The least dimension that each agent shares."
    return Picture(
        figure, "Dimensions", words + (" Gray: the bound of the paper." if compared else "")
    )


def _draw_bars(
    axis: Any, names: Sequence[str], sizes: Sequence[int], bound: int | None, title: str
) -> None:
    """A bar for each agent, beside a gray one for the bound."""
    places = range(len(names))
    if bound is not None:
        axis.bar(
            [k - 0.2 for k in places],
            [bound] * len(names),
            0.4,
            color="#bbbbbb",
            label="bound of the paper",
        )
    axis.bar([k + 0.2 for k in places], sizes, 0.4, color=MARKED, label="least")
    turned = 90 if len(names) > _NAMED or max(map(len, names)) > _NAMED else 0
    axis.set_xticks(list(places), names, parse_math=False, rotation=turned)
    axis.set_yticks(range(max(bound or 0, *sizes, 1) + 1))
    axis.set_xlabel("agent")
    axis.set_ylabel("shared dimension")
    axis.set_title(title, fontsize="medium")
    axis.legend(fontsize="small", loc="upper center")
    axis.margins(y=0.35)
