"""What the commands that assess a controller show besides certified sentences."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.answer.account import Account
    from mcexact.model.loop import ClosedLoop
    from mcexact.report.html import EmbeddedPicture
    from mcexact.report.text import Table
    from mcexact.synthesis.assessment import Assessment


def assessed(
    account: Account,
    found: Assessment,
    loop: ClosedLoop,
    tables: tuple[Table, ...],
    with_page: bool,
    pictures: tuple[EmbeddedPicture, ...] = (),
) -> dict[str, Any]:
    """Return the lines before the tables, the first of which is the verdict, and the page.

    What is certified of all loops near this one follows the verdict; ``pictures`` come first on the
    page.
    """
    # Help loads every command, and must not load flint with the templates.
    from mcexact.answer.loops import EVERY_LOOP, EVERY_LOOP_PART

    all_loops = (EVERY_LOOP, EVERY_LOOP_PART)
    said = [found.verdict, *(each.line for each in account.sentences if each.template in all_loops)]
    said += [f"warning: {each}" for each in found.warnings[1:]]
    said += [f"note: {each}" for each in found.notes]
    page = None
    if with_page:
        from mcexact.report.pages import loop_page
        from mcexact.synthesis.optimum.diagnosis import curves_of

        curves = curves_of(loop, found.region)
        page = loop_page(account, found.install, said, tables, curves, loop.controller)
        page = replace(page, pictures=(*pictures, *page.pictures))
    return {"said": said, "tables": tables, "page": page}
