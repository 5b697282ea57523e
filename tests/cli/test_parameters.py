"""Systems with parameters on the command line: for all values, at some, and from what is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mcexact import ParametricSystem, analyze
from tests.cli.calling import call
from tests.report.schemas import faults
from tests.wording import says

PLANT = {
    "format": "mcexact-system/1",
    "time": "continuous",
    "parameters": {"t": {"range": [0, 1]}},
    "A": [["-1", 0], ["4*t^2 - 1", "-2"]],
    "channels": [{"B": [[1], [0]], "C": [[0, 1]]}],
}
TWO = {
    **PLANT,
    "parameters": {"a": {}, "b": {"range": [0, None]}},
    "A": [["-a", 0], ["a*b - 1", "-2"]],
}


@pytest.fixture
def file(tmp_path: Path) -> str:
    """A plant with one parameter."""
    path = tmp_path / "plant.json"
    path.write_text(json.dumps(PLANT))
    return str(path)


def test_analyze_answers_for_every_value_with_what_is_in_range(file: str, tmp_path: Path) -> None:
    folder = tmp_path / "certificates"
    page = tmp_path / "page.html"
    status, out, _ = call("analyze", file, "--certificates", str(folder), "--html", str(page))
    assert status == 0
    assert says(out, "almost value")
    assert says(out, "mode fixed")
    assert "t = 1/2 (in range)" in out and "t = -1/2 (out of range)" in out
    assert says(out, "equilibrium unless")
    assert says(out, "certificates independent")
    text = page.read_text()
    assert says(text, "almost value 2") and "t in [0, 1]" in text
    for certificate in sorted(folder.iterdir()):
        status, said, _ = call("check", "--statements", str(certificate), "--system", file)
        assert status == 0 and said.startswith(("VALID", "IMPLIED"))


def test_the_json_is_as_its_schema_says(file: str, tmp_path: Path) -> None:
    status, out, _ = call("analyze", file, "--json")
    found = json.loads(out)
    assert status == 0 and faults("analyze-parameters", found) == []
    assert found["parameters"] == {"t": {"range": [0, 1]}}
    assert found["fixed_spectrum"]["rows"][0]["where"] == "t = 1/2 (in range)"
    several = tmp_path / "two.json"
    several.write_text(json.dumps(TWO))
    status, out, _ = call("analyze", str(several), "--json")
    found = json.loads(out)
    assert status == 0 and faults("analyze-parameters", found) == []
    where = [row["where"] for row in found["fixed_spectrum"]["rows"]]
    assert where[0] == "a*b - 1 = 0" and found["re_checked"]["valid"] == 18


def test_certificates_along_lines_are_about_the_file(tmp_path: Path) -> None:
    """Also where a denominator is a sum, and where the plant has the letter of lines."""
    several, folder = tmp_path / "two.json", tmp_path / "certificates"
    for letters in (("a", "b"), ("s", "s1")):
        first, second = letters
        plant = {
            **TWO,
            "parameters": {key: {} for key in letters},
            "A": [[f"-{first}", 0], [f"({first}*{second} - 1)/({first} + {second})", "-2"]],
        }
        several.write_text(json.dumps(plant))
        assert call("analyze", str(several), "--certificates", str(folder / first))[0] == 0
        files = sorted(map(str, (folder / first).glob("*.json")))
        assert len(files) > 10
        status, out, _ = call("check", "--statements", "--system", str(several), *files)
        assert status == 0
        verdicts = {line.split()[0] for line in out.splitlines()}
        assert verdicts == {"VALID", "IMPLIED", "COUNTED"}
        manifest = str(folder / first / "manifest.json")
        assert call("check", "--statements", "--system", str(several), manifest)[0] == 0
        files.remove(manifest)
    other = tmp_path / "other.json"
    other.write_text(json.dumps({**plant, "A": [[0, 0], [0, 0]]}))
    assert call("check", "--statements", "--system", str(other), files[0])[0] == 1


def test_values_make_the_plant_of_which_all_questions_are_asked(file: str, tmp_path: Path) -> None:
    status, out, _ = call("analyze", file, "--at", "t=1/2")
    assert status == 0 and "the 2 roots of x^2 + 3*x + 2" in out
    several = tmp_path / "two.json"
    several.write_text(json.dumps(TWO))
    status, out, _ = call("analyze", str(several), "--at", "a=2")
    assert status == 0 and says(out, "mode fixed")


def test_fixed_modes_at_some_value_fail_an_assertion_that_there_are_none(file: str) -> None:
    assert call("analyze", file, "--assert", "no-fixed-modes")[0] == 1
    assert call("analyze", file, "--at", "t=1", "--assert", "no-fixed-modes")[0] == 0


def test_latex_has_the_plant_and_the_conditions(file: str) -> None:
    status, out, _ = call("analyze", file, "--latex")
    assert status == 0 and "4 t^{2} - 1" in out and r"\text{t = 1/2 (in range)}" in out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--at", "u=1"], "unknown parameter 'u'"),
        (["--at", "t"], "expected NAME=VALUE"),
        (["--at", "t=half"], "expected an integer"),
        (["--subset", "1"], "--at NAME=VALUE"),
        (["--also", "assignability"], "--at NAME=VALUE"),
        (["--information", "outputs"], "--at NAME=VALUE"),
        (["--channel", "2"], "2"),
    ],
)
def test_what_cannot_be_answered_says_what_to_give(
    file: str, options: list[str], said: str
) -> None:
    status, _, told = call("analyze", file, *options)
    assert status != 0 and said in told


def test_one_channel_is_asked_about_and_every_question_has_its_seconds(file: str) -> None:
    status, out, _ = call("analyze", file, "--channel", "1", "--json")
    found = json.loads(out)
    assert status == 0 and faults("analyze-parameters", found) == []
    rows = dict(map(tuple, found["table"]))
    assert rows["controlled by the channel"] == rows["jointly controllable"]
    assert [each["outcome"] for each in found["questions"]] == ["decided"] * 10
    assert {each["rule"] for each in found["sentences"]} > {"parametric-complete-unless"}


def test_questions_that_would_take_long_are_left_out_and_said(tmp_path: Path) -> None:
    large = {
        **PLANT,
        "parameters": {"a": {}, "b": {}},
        "A": [["a" if i == j else "b" if i == 0 else 1 for j in range(11)] for i in range(11)],
        "channels": [{"B": [[1]] * 11, "C": [[1] * 11]}],
    }
    path = tmp_path / "large.json"
    path.write_text(json.dumps(large))
    status, out, _ = call("analyze", str(path))
    assert status == 0 and says(" ".join(out.split()), "more several")
    assert says(out, "decide also")


def test_a_plant_without_parameters_takes_no_values() -> None:
    status, _, told = call("analyze", "gallery:quadruple-tank-pminus", "--at", "t=1")
    assert status != 0 and "leave out --at" in told


def test_a_table_without_reasons_has_no_column_for_them() -> None:
    plant = ParametricSystem([[1, 0], [0, "t"]], [[["t - 3"], [1]]], [[[1, 1]]], parameters=["t"])
    account = analyze(plant, ["fixed_spectrum", "joint_controllability"]).account
    columns = {name: account.table(name)[0] for name in account.detailed()}
    assert columns == {
        "fixed_spectrum": ("where", "what", "because"),
        "joint_controllability": ("where", "what"),
    }
    assert all(len(row) == 2 for row in account.table("joint_controllability")[1])


def test_several_parameters_with_ranges_lead_with_what_holds_within_them(tmp_path: Path) -> None:
    inside = {**TWO, "parameters": {"a": {"range": [2, 3]}, "b": {"range": [1, "3/2"]}}}
    path = tmp_path / "plant.json"
    path.write_text(json.dumps(inside))
    folder = tmp_path / "certificates"
    status, out, _ = call("analyze", str(path), "--certificates", str(folder), "--json")
    found = json.loads(out)
    assert status == 0 and faults("analyze-parameters", found) == []
    said = "For all values of a in [2, 3], b in [1, 3/2]: no mode is fixed."
    assert found["answer"][0] == said
    kept = json.loads((folder / "box_fixed_modes.json").read_text())
    assert kept["kind"] == "parametric_box_fixed"
    status, out, _ = call(
        "check", "--statements", str(folder / "manifest.json"), "--system", str(path)
    )
    assert (
        status == 0 and " sentences implied, 0 not" in out and "20 certificates valid, 0 not" in out
    )


def test_ranges_need_two_ends_to_be_asked_about(tmp_path: Path) -> None:
    path = tmp_path / "plant.json"
    path.write_text(json.dumps(TWO))
    status, _, err = call("analyze", str(path), "--also", "box_fixed_modes")
    assert status == 2 and says(err, "range ends")
