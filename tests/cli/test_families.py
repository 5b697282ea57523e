"""`mcexact sweep` about families of systems, and on a cluster."""

import json
from pathlib import Path
from typing import Any

import pytest

from mcexact import fixed_spectrum, load_system
from mcexact.boxes import Box
from mcexact.cli.sweep import values
from mcexact.model.system_file import read_system
from tests.cli.calling import call
from tests.wording import says

PAPER = "gallery:liu2020-3ch-no-communication"
PARAMETRIC = {
    "format": "mcexact-system/1",
    "time": "continuous",
    "parameters": {"t": {}},
    "A": [[1, "t"], [0, 2]],
    "channels": [{"B": [[1], [0]], "C": [[1, 0]]}, {"B": [[0], [1]], "C": [["1/(t - 1)", 0]]}],
}


def swept(*arguments: str, status: int = 0) -> dict[str, Any]:
    found, out, said = call("sweep", *arguments, "--workers", "1", "--json")
    assert found == status, said
    document: dict[str, Any] = json.loads(out)
    return document


@pytest.fixture
def parametric(tmp_path: Path) -> str:
    path = tmp_path / "p.json"
    path.write_text(json.dumps(PARAMETRIC))
    return str(path)


def test_a_grid_of_a_parameter_is_asked_point_by_point(parametric: str) -> None:
    document = swept(parametric, "--grid", "t=0:2:5", status=3)
    records = document["records"]
    assert [r["name"].rpartition(": ")[2] for r in records] == [
        "t=0",
        "t=1/2",
        "t=1",
        "t=3/2",
        "t=2",
    ]
    assert ["undefined there" in r.get("error", {}).get("message", "") for r in records] == [
        k == 2 for k in range(5)
    ]
    assert records[0]["answers"]["fixed_spectrum"]["claim"]["polynomial"] == [-2, 1]
    assert document["counts"]["with_fixed_modes"] == 1
    status, out, _ = call("sweep", parametric, "--grid", "t=2,1/2", "--workers", "1")
    assert status == 0 and "\n  t=2 " in out and "\n  t=1/2 " in out


def test_graphs_and_sensors_are_asked_about_each_file(tmp_path: Path) -> None:
    graphs = ("--all-graphs", "--strongly-connected", "--up-to-isomorphism")
    certificates = tmp_path / "made"
    document = swept(PAPER, *graphs, "--certificates", str(certificates))
    assert document["counts"] == {
        "systems": 5, "decided": 5, "with_fixed_modes": 4, "not_stabilizable": 4,
    }  # fmt: skip
    assert len(list(certificates.iterdir())) == 5
    assert swept(PAPER, "--all-sensors", "--question", "completeness")["counts"]["systems"] == 81


def test_tolerances_are_asked_of_each_file(tmp_path: Path) -> None:
    plant = {
        "format": "mcexact-system/1",
        "time": "continuous",
        "A": [[1, 0], [0, 2]],
        "channels": [{"B": [[1], [1]], "C": [[1, 1]]}],
    }
    path = tmp_path / "plant.json"
    path.write_text(json.dumps(plant))
    asked = ("--tolerances", "0.1%,10%,50%", "--question", "box_fixed_modes", "--workers", "1")
    status, out, _ = call("sweep", str(path), *asked, "--json")
    first, second, third = json.loads(out)["records"]
    assert status == 0 and first["answers"]["box_fixed_modes"]["claim"] == {"bound": None}
    assert "member" not in second["answers"]["box_fixed_modes"]
    assert third["name"].endswith("within 1/2")
    failing = read_system(json.dumps(third["answers"]["box_fixed_modes"]["member"]))
    assert not fixed_spectrum(failing).empty
    assert Box.relative(load_system(str(path)), "1/2").contains(failing)
    assert json.loads(out)["tolerances"] == [
        {
            "question": "box_fixed_modes",
            "part": part,
            "plants": 1,
            "proved": proved,
            "failing": fails,
        }
        for part, proved, fails in (("1/1000", 1, 0), ("1/10", 1, 0), ("1/2", 0, 1))
    ]
    page = tmp_path / "page.html"
    status, out, _ = call("sweep", str(path), *asked, "--html", str(page))
    told = [line.split() for line in out.splitlines() if "no fixed mode" in line]
    assert told == [
        [*["no", "fixed", "mode"], part, "%", *numbers]
        for part, numbers in (("0.1", "1001"), ("10", "1001"), ("50", "0101"))
    ]
    assert "Plants by uncertainty: no fixed mode" in page.read_text()
    first, *_ = swept(str(path), "--tolerances", "0.1%")["records"]
    assert list(first["answers"]) == ["box_fixed_modes"]


def test_a_file_that_cannot_be_read_is_told_like_any_other(tmp_path: Path, parametric: str) -> None:
    missing = str(tmp_path / "no.json")
    document = swept(missing, parametric, "--all-sensors", "--draws", "1", status=3)
    first, second, drawn = document["records"]
    assert says(first["error"]["message"], "file")
    assert "parameters" in second["error"]["message"] and "answers" in drawn


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ("--all-graphs", "--all-sensors"),
            "give one of --grid, --tolerances, --all-graphs and --all-sensors",
        ),
        (("--up-to-isomorphism",), "need --all-graphs"),
        (("--grid", "t"), "expected NAME=FROM:TO:COUNT or NAME=VALUE,VALUE, found 't'"),
        (("--tolerances", "1%,x"), "found 'x'"),
        (
            ("--tolerances", "1%", "--question", "fixed_spectrum"),
            "box_observability; fixed_spectrum is none of them",
        ),
        (("--grid", "t=0:1"), "expected FROM:TO:COUNT with a count from 2"),
        (("--grid", "t=0:1:1"), "with a count from 2 to 1000000, found '0:1:1'"),
        (("--grid", "t=0.5,x"), "found 'x'"),
        (("--scheduler", "tcp://127.0.0.1:1", "--timeout", "1"), "limits on time and memory hold"),
    ],
)
def test_options_that_make_no_sense_are_refused(arguments: tuple[str, ...], said: str) -> None:
    status, _, message = call("sweep", PAPER, *arguments)
    assert status == 2 and said in message


def test_values_are_exact() -> None:
    name, found = values("k_1=0.1:0.2:3")
    assert (name, list(map(str, found))) == ("k_1", ["1/10", "3/20", "1/5"])


def test_a_cluster_decides_by_the_address_of_its_scheduler(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    results = tmp_path / "r.jsonl"
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, dashboard_address=":0"
    ) as cluster:
        address = cluster.scheduler_address
        asked = ("sweep", "--draws", "6", "--scheduler", address, "-o", str(results), "--json")
        status, out, said = call(*asked)
        assert status == 0, said
    records = json.loads(out)["records"]
    assert [r["number"] for r in records] == list(range(6)) and all("answers" in r for r in records)
    assert len(results.read_text().splitlines()) == 6
    alone = swept("--draws", "6")["records"]
    assert [r["answers"] for r in alone] == [r["answers"] for r in records]
