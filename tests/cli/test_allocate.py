"""`mcexact allocate`: what it says, its status and its certificates."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from mcexact.model import gallery
from mcexact.model.files import save_system
from mcexact.model.graph import NeighborGraph
from tests.analysis.sharing.test_allocation import triangles
from tests.end_to_end.command_line import run
from tests.wording import says

PLANT = gallery.load("liu2020-3ch-no-communication")


@pytest.fixture
def ring(tmp_path: Path) -> str:
    path = tmp_path / "ring.json"
    save_system(PLANT.with_neighbors(NeighborGraph.ring(PLANT.names)), path)
    return str(path)


@pytest.fixture
def chain(tmp_path: Path) -> str:
    path = tmp_path / "chain.json"
    graph = NeighborGraph.from_names(PLANT.names, {"1": ["2"], "3": ["1"]})
    save_system(PLANT.with_neighbors(graph), path)
    return str(path)


def answer(*arguments: str, status: int = 0) -> Any:
    done = run("allocate", *arguments, "--json")
    assert done.status == status, done.stderr
    return json.loads(done.stdout)


def test_the_papers_example_is_answered_beside_its_bound(ring: str, tmp_path: Path) -> None:
    found = answer(ring, "--certificates", str(tmp_path / "certificates"))
    assert found["shared_dimension_bound"]["deficiency"] == 1
    assert least(found)["dimensions"] == [0, 0, 1]
    assert said(found, "allocate-total-bound") == ["total | 1 | 3"]
    assert said(found, "allocate-reason") == ["2 | 3 | 1 | the mode 1"]
    folder = tmp_path / "certificates"
    files = [str(folder / name) for name in folder.iterdir() if name.name != "manifest.json"]
    checked = run("check", "--statements", *files, "--system", ring)
    assert checked.status == 0
    assert all(line.startswith("VALID ") for line in checked.stdout.splitlines())
    implied = run("check", "--statements", "--manifest", str(folder), "--system", ring)
    assert implied.status == 0 and implied.stdout.count("IMPLIED") == len(found["sentences"])


def test_dimensions_are_told_by_agent_with_the_total_of_the_bound(ring: str, chain: str) -> None:
    shares = answer(ring)["shares"]
    sizes = [shares["by_agent"][name]["least"] for name in PLANT.names]
    bounds = {shares["by_agent"][name]["bound"] for name in PLANT.names}
    assert (sizes, bounds) == ([0, 0, 1], {1})
    assert shares["total"] == {"least": sum(sizes), "bound": len(sizes)}
    assert "shares" not in answer(chain, status=1)  # no numbers of shared states are enough


def test_at_the_node_limit_both_bounds_are_said_and_certified(tmp_path: Path) -> None:
    path, folder = str(tmp_path / "triangles.json"), tmp_path / "certificates"
    save_system(triangles(2), path)
    found = answer(path, "--node-limit", "1", "--certificates", str(folder), status=4)
    claim = least(found)
    assert (claim["cost"], claim["at_least"], len(claim["dimensions"])) == (4, 3, 18)
    [title] = said(found, "allocate-within")
    assert "suffice, at a cost of 4, and nothing below 3 does" in title
    assert said(found, "allocate-within-proof") and "shares" not in found
    assert not said(found, "allocate-least") + said(found, "allocate-row")
    implied = run("check", "--statements", "--manifest", str(folder), "--system", path)
    assert implied.status == 0 and implied.stdout.count("IMPLIED") == len(found["sentences"])
    page = tmp_path / "page.html"
    assert run("allocate", path, "--node-limit", "1", "--html", str(page)).status == 4
    assert says(page.read_text(encoding="utf-8"), "dimension shares")


def least(found: Any) -> Any:
    return found["minimal_shared_dimensions"]


def said(found: Any, rule: str) -> list[str]:
    """What is said by a rule."""
    return [each["text"] for each in found["sentences"] if each["rule"] == rule]


def test_the_table_says_who_shares_how_much_and_why(ring: str) -> None:
    text = run("allocate", ring, "--share", "states").stdout
    assert (
        re.search(r"total +2 +3", text)
        and "can receive from" in text
        and "2 nested subsets" in text
    )


def test_a_price_an_upper_bound_and_a_rate_move_the_answer(ring: str) -> None:
    priced = least(answer(ring, "--share", "states", "--cost", "3", "1/2"))
    assert priced["cost"] == "3/2"
    assert least(answer(ring, "--upper", "3", "0", status=1))["dimensions"] is None
    assert sum(least(answer(ring, "--rate", "1/2", "--free"))["dimensions"]) == 1


def test_a_missing_link_is_named_and_ends_with_status_1(chain: str) -> None:
    found = answer(chain, status=1)
    assert least(found)["dimensions"] is None
    assert said(found, "allocate-reason")[0].split(" | ")[1] == "nobody"


def test_links_are_added_where_they_help(chain: str, tmp_path: Path) -> None:
    found = answer(chain, "--links", "--dimensions", "0,0,1")
    assert found["minimal_communication"]["added"] == [["3", "2"]]
    forbidden = answer(chain, "--links", "--dimensions", "0,0,1", "--forbid", "3", "2")
    assert forbidden["minimal_communication"]["added"] != [["3", "2"]]
    priced = answer(chain, "--links", "--link-cost", "1", "2", "7", "--certificates", str(tmp_path))
    assert priced["minimal_communication"]["share"] == "outputs"
    assert run("check", "--statements", str(tmp_path / "minimal_communication.json")).status == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--radius", "1/2"], "continuous time: give --rate"),
        (["--cost", "9", "1"], "there is no agent '9'"),
        (["--cost", "1", "dear"], "expected a number, found 'dear'"),
        (["--upper", "1", "1/2"], "expected a number"),
        (["--dimensions", "1,1,1"], "go with --links"),
        (["--links", "--dimensions", "1,x"], "integers >= 0 such as 0,0,1"),
        (["--links", "--free"], "do not go with --links"),
        (["--cost", "1", "0"], "positive"),
    ],
)
def test_wrong_usage_ends_with_status_2(ring: str, options: list[str], message: str) -> None:
    done = run("allocate", ring, *options)
    assert done.status == 2 and message in done.stderr and done.stdout == ""


def test_a_file_without_a_graph_is_told_how_to_get_one(tmp_path: Path) -> None:
    path = tmp_path / "plant.json"
    save_system(PLANT, path)
    done = run("allocate", str(path))
    assert done.status == 2 and "'neighbors'" in done.stderr


def test_theorem_2_has_no_bound_where_its_hypotheses_fail(ring: str, tmp_path: Path) -> None:
    document = json.loads(Path(ring).read_text(encoding="utf-8"))
    document["neighbors"] = {"2": ["1"], "3": ["1"]}
    chain = tmp_path / "chain.json"
    chain.write_text(json.dumps(document), encoding="utf-8")
    assert said(answer(str(chain)), "allocate-total-bound") == []
    assert "Theorem 2" not in run("allocate", str(chain)).stdout
    assert "Theorem 2" in run("allocate", ring).stdout


def test_links_are_found_for_a_plant_without_neighbors(tmp_path: Path) -> None:
    plant = str(Path(gallery.__file__).parent / "liu2020-unimodular.json")
    found = answer(plant, "--links", "--certificates", str(tmp_path))
    assert found["minimal_communication"]["added"] == [["3", "2"]]
    checked = run(
        "check", "--statements", str(tmp_path / "minimal_communication.json"), "--system", plant
    )
    assert checked.status == 0
