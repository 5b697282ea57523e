"""The pages of `mcexact allocate` and `mcexact sweep`: what they say, draw and prove."""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.colors import to_hex

from mcexact.analysis.analyze import account_of_dimensions, account_of_links
from mcexact.cli import main
from mcexact.model import gallery
from mcexact.model.files import save_system
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.graphs import ADDED
from mcexact.report.figures import allocation_picture, links_picture
from mcexact.report.pages import allocation_page
from mcexact.report.sweep import sweep_page
from tests.report.strict_html import external_addresses
from tests.wording import says, worded

PLANT = gallery.load("liu2020-3ch-no-communication")


def ring() -> MultiChannelSystem:
    return PLANT.with_neighbors(NeighborGraph.ring(PLANT.names))


def test_the_least_dimensions_stand_beside_the_bound() -> None:
    account = account_of_dimensions(ring())
    [axis] = allocation_picture(account).figure.axes
    assert sorted(bar.get_height() for bar in axis.patches) == [0, 0, 1, 1, 1, 1]
    page = allocation_page(account)
    titles = ["The least dimensions", "bound and least", "why"]
    assert page.good and [each.title for each in page.tables] == titles
    assert worded(page.answer)  # fmt: skip


def test_a_bound_whose_hypotheses_fail_is_not_drawn() -> None:
    account = account_of_dimensions(ring(), free_assignability=True)
    picture = allocation_picture(account)
    assert len(picture.figure.axes[0].patches) == 3 and "bound" not in picture.alternative


def test_links_to_add_are_blue_among_those_that_exist() -> None:
    account = account_of_links(PLANT.with_neighbors({"1": ["2"]}))
    added = account.answers["minimal_communication"].added
    picture = links_picture(account)
    arrows = [each for each in picture.figure.axes[0].patches if hasattr(each, "get_arrowstyle")]
    blue = [each for each in arrows if to_hex(each.get_edgecolor()) == ADDED]
    assert len(blue) == len(added) == len(arrows) - 1
    assert all(f"{start} → {end}" in picture.alternative for start, end in added)


def test_where_nothing_is_missing_the_page_has_no_empty_table() -> None:
    page = allocation_page(account_of_links(gallery.load("quadruple-tank-pminus")))
    assert page.good and page.tables == () and "proved with" in page.answer[1]
    assert says(page.rendered(), "links added")


def test_the_impossible_is_not_drawn() -> None:
    page = allocation_page(account_of_dimensions(ring(), upper=[0, 0, 0]))
    assert page.good is False and page.pictures == ()
    assert [each.title for each in page.tables] == ["bound and least", "why"]


def decided(number: int) -> dict[str, object]:
    claim = {"polynomial": ["0", "1"], "factors": [{}], "stabilizable": False}
    answers = {"fixed_spectrum": {"claim": claim, "statement": ""}}
    return {"number": number, "name": f"<{number}>", "system": {"n": 2, "m": 1},
            "answers": answers, "seconds": 0.5}  # fmt: skip


def test_the_page_of_a_sweep_has_more_rows_than_a_terminal_and_escapes_names() -> None:
    failed = {"number": 70, "name": "x", "error": {"status": 3, "message": "not a system"}}
    page = sweep_page([*map(decided, range(70)), failed], ["fixed_spectrum"], [("a", "b")])
    assert [len(each.rows) for each in page.tables] == [71, 1] and not page.tables[0].note
    assert page.title == "A sweep over 71 systems"
    assert page.answer[0].startswith("Systems: 71; decided: 70; with fixed modes: 70")
    assert worded(page.answer[1])
    text = page.rendered()
    assert "&lt;1&gt;" in text and "not a system" in text and external_addresses(text) == []
    assert "Evidence" not in text


@pytest.mark.parametrize("command", ["allocate", "sweep"])
def test_commands_write_their_pages(command: str, tmp_path: Path) -> None:
    plant, page = tmp_path / "ring.json", tmp_path / "page.html"
    save_system(ring(), plant)
    with pytest.raises(SystemExit) as ended:
        main([command, str(plant), "--html", str(page)])
    assert ended.value.code == 0
    text = page.read_text(encoding="utf-8")
    assert external_addresses(text) == []
    assert text.count(': <span class="yes">VALID') == (7 if command == "allocate" else 0)
    with pytest.raises(SystemExit) as ended:
        main([command, str(plant), "--html", str(plant)])
    assert ended.value.code == 3
