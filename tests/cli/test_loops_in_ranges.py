"""`mcexact certify` about a loop at all values of parameters within their ranges."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact import certify_controller, load_controller, save_controller
from mcexact.designs import local_controllers
from mcexact.parameters import load_parametric_system
from tests.cli.calling import call
from tests.report.schemas import faults
from tests.wording import says

PLANT: dict[str, Any] = {
    "format": "mcexact-system/1",
    "time": "continuous",
    "parameters": {"k": {"range": ["1/4", "3/4"]}},
    "A": [["1 - k", "k"], ["k", "1 - k"]],
    "channels": [{"B": [[1], [0]], "C": [[1, 0]]}, {"B": [[0], [1]], "C": [[0, 1]]}],
}
"""Two states joined by a damper k: with u = −3y the eigenvalues are −2 and −2 − 2k."""


@pytest.fixture
def gains(tmp_path: Path) -> str:
    """The file of a controller, made at one value of the parameter."""
    plant = load_parametric_system(plant_file(tmp_path, ["1/4", "3/4"])).at({"k": "1/2"})
    path = tmp_path / "gains.json"
    save_controller(local_controllers(plant, [[[-3]], [[-3]]]), path)
    return str(path)


def plant_file(folder: Path, ends: list[Any]) -> str:
    """The file of the plant with a range."""
    path = folder / "plant.json"
    path.write_text(json.dumps({**PLANT, "parameters": {"k": {"range": ends}}}))
    return str(path)


def test_a_loop_is_certified_for_every_value(gains: str, tmp_path: Path) -> None:
    plant, folder = plant_file(tmp_path, ["1/4", "3/4"]), tmp_path / "proofs"
    page = tmp_path / "page.html"
    to = ("--certificates", str(folder), "--html", str(page), "--system-by-digest")
    status, out, err = call("certify", plant, gains, "--rate", "1/2", "--gains", "1%", *to)
    assert status == 0 and "warning" not in err
    assert "Re λ < -1/2 for every k in [1/4, 3/4]: proved." in out
    said = " ".join(out.split())
    assert says(said, "gains within")
    assert says(out, "certificate independent")
    assert "for every k in [1/4, 3/4]: proved" in page.read_text("utf-8")
    asked = ("--system", plant, "--controller", gains)
    status, out, _ = call("check", "--statements", "--manifest", str(folder), *asked)
    ranges, spread = "of the parameter k from 1/4 to 3/4", "by at most 1/100 of the absolute values"
    assert status == 0 and ranges in out and spread in out
    status, out, _ = call("check", "--statements", str(folder / "box_stability.json"), *asked)
    assert status == 0 and out.startswith("VALID")


def test_values_at_which_the_loop_fails_are_told_beside_the_part_that_is_proved(
    gains: str, tmp_path: Path
) -> None:
    plant, folder = plant_file(tmp_path, [-2, 4]), tmp_path / "proofs"
    status, out, _ = call("certify", plant, gains, "--certificates", str(folder))
    assert status == 1 and says(out, "hold")
    assert says(out, "certificates independent")
    names = sorted(path.name for path in folder.iterdir())
    assert names == ["box_stability_in_part.json", "stability_at_values.json"]
    assert call("check", "--statements", *map(str, sorted(folder.iterdir())))[0] == 0
    status, out, _ = call("certify", plant, gains, "--json")
    found = json.loads(out)
    assert status == 1 and faults("certify-parameters", found) == []
    assert not found["certified"] and found["refuted"]
    largest = found["largest_ranges"]
    assert 0 < Fraction(largest["lower"]) < Fraction(largest["upper"]) <= 1
    at = load_parametric_system(plant).at(largest["failing"])
    assert not certify_controller(at, load_controller(gains)).stable


def test_what_is_neither_proved_nor_refuted_is_open(tmp_path: Path) -> None:
    """x' = −x/k is stable wherever it is defined, but it is not at k = 0."""
    open_ = {
        **PLANT,
        "parameters": {"k": {"range": [0, 2]}},
        "A": [["-1/k"]],
        "channels": [{"B": [[1]], "C": [[1]]}],
    }
    (tmp_path / "plant.json").write_text(json.dumps(open_))
    plant = load_parametric_system(tmp_path / "plant.json").at({"k": 1})
    save_controller(local_controllers(plant, [[[0]]]), tmp_path / "gains.json")
    files = str(tmp_path / "plant.json"), str(tmp_path / "gains.json")
    status, out, _ = call("certify", *files)
    assert status == 4 and says(out, "open fails")
    assert says(out, "values found")
    # A part of the ranges can be proved all the same, which has a certificate.
    nothing = "of no part of the ranges" in " ".join(out.split())
    assert ("no certificate" in out) is nothing and ("VALID" in out) is not nothing


def test_the_json_of_a_proof_is_as_its_schema_says(gains: str, tmp_path: Path) -> None:
    plant = plant_file(tmp_path, ["1/4", "3/4"])
    status, out, _ = call("certify", plant, gains, "--json")
    found = json.loads(out)
    assert status == 0 and faults("certify-parameters", found) == []
    assert found["certified"] and found["largest_ranges"]["failing"] is None
    [told] = found["sentences"]
    assert told["rule"] == "parametric-ranges-in-region"


def test_values_make_the_plant_of_which_everything_is_decided(gains: str, tmp_path: Path) -> None:
    plant = plant_file(tmp_path, ["1/4", "3/4"])
    status, out, _ = call("certify", plant, gains, "--at", "k=1/2", "--uncertainty", "1%")
    assert status == 0 and says(out, "satisfies")
    assert call("certify", plant, gains, "--at", "k=-3/2")[0] == 1


@pytest.mark.parametrize(
    "option", [["--largest"], ["--uncertainty", "1%"], ["--round-gains", "3"], ["--damping", "1/2"]]
)
def test_what_is_decided_without_parameters_alone_says_what_to_give(
    gains: str, tmp_path: Path, option: list[str]
) -> None:
    plant = plant_file(tmp_path, ["1/4", "3/4"])
    status, _, err = call("certify", plant, gains, *option)
    assert status == 2 and "give values to k by --at NAME=VALUE" in err, err


def test_a_range_without_an_end_is_refused(gains: str, tmp_path: Path) -> None:
    status, _, err = call("certify", plant_file(tmp_path, [0, None]), gains)
    assert status == 2 and says(err, "needs ends")
