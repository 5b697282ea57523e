"""The search for the largest radii, as `mcexact analyze` and `mcexact certify` show it.

`with_radii` gives a plant the radii that are asked for, or searches the largest ones for which a
property of every plant within them is proved.  The other functions show such a search: as the first
lines of an answer, as a table, as a picture of a page, and as a part of the JSON; without a search
they show nothing.

A plant with parameters is uncertain in another way: `mcexact.cli.decisions` decides the answers for
all values, and `mcexact.cli.loops` a loop for all values in their ranges.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mcexact.answer.account import Account
from mcexact.derived.sampling import is_sampled, resampled
from mcexact.model.box import Box
from mcexact.model.properties import PROPERTIES, Property
from mcexact.model.system import MultiChannelSystem
from mcexact.report.html import EmbeddedPicture, Picture
from mcexact.report.text import WIDTH, Table, wrapped

if TYPE_CHECKING:
    from mcexact.analysis.boxes.largest import LargestUncertainty


def with_radii(
    system: MultiChannelSystem,
    part: Fraction | None,
    effort: float | None = None,
    wanted: Property = "no fixed mode",
) -> tuple[MultiChannelSystem, LargestUncertainty | None]:
    """Return the system with the radii that are asked for, and the search for the largest ones.

    Parameters
    ----------
    system : MultiChannelSystem
    part : Fraction or None
        The radii, as a part of the moduli of the entries.
    effort : float or None
        The seconds for the search; None if it is not asked for.
    wanted : str
        The property that every plant is to have, in words.
    """
    if effort is None:
        return (system if part is None else Box.relative(system, part).system), None
    # An analysis without this search does not load numpy, which takes as long as a small analysis.
    from mcexact.analysis.boxes.largest import largest_uncertainty

    search = largest_uncertainty(system, wanted, effort=effort)
    return with_proved_radii(system, search), search


def with_proved_radii(system: MultiChannelSystem, search: LargestUncertainty) -> MultiChannelSystem:
    """Return the system with the radii for which the search has a proof, if it has one.

    A sampled system is sampled again, from the plant with these radii.
    """
    if search.proof is None:
        return system
    plant = search.proof.about.plant
    return resampled(system, plant) if is_sampled(system) else plant


def leading(account: Account, search: LargestUncertainty | None) -> tuple[str, ...]:
    """Return the first lines of an answer: the radii with a proof, or how to search them."""
    own = account.given.asked.get("information", "own") == "own"
    if search is None and own and {*account.open} & PROPERTIES.keys():
        *sentences, last = account.leading
        return (
            *sentences,
            "--largest-uncertainty searches radii with a proof, and a plant that fails",
            last,
        )
    if search is None or search.proof is None:
        return account.leading
    unit = "" if search.relative else " of the file"
    first = f"largest radii that were found with a proof: {search.proved_part}{unit}"
    return (first, *account.leading)


def lead(account: Account, search: LargestUncertainty | None) -> str:
    """Return the lines of `leading` as text, the last of which introduces what follows."""
    *sentences, last = leading(account, search) or ("",)
    lines = [line for each in sentences for line in wrapped(each, WIDTH)]
    return "\n".join([*lines, "", last, ""]) if last else ""


def view(search: LargestUncertainty | None) -> dict[str, Any]:
    """Return the search as a part of the JSON of an answer."""
    return {} if search is None else {"largest_uncertainty": search.to_dict()}


def pictures(search: LargestUncertainty | None) -> tuple[EmbeddedPicture, ...]:
    """Return the search as a picture of a page."""
    if search is None:
        return ()
    return (Picture(search.plot(), "Largest uncertainty", f"{search.explain()}.").embedded(),)


def tables(search: LargestUncertainty | None) -> tuple[Table, ...]:
    """Return the search as a table."""
    if search is None:
        return ()
    rows = [(label, str(value)) for label, value in search.rows()]
    return (Table("largest uncertainty", (), tuple(rows)),)
