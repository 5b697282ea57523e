"""Every file that is written, and the JSON of every command, is as the shipped schemas say."""

import json
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from mcexact.answer.schema import kinds, of_type
from mcexact.cli.commands import COMMANDS
from mcexact.errors import UsageError
from mcexact.model import gallery
from mcexact.model.controller import save_controller
from mcexact.model.files import load_system, save_system
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.report.schema import DOCUMENTS, FOLDER, schema_file, schema_text
from tests.cli.calling import call
from tests.report.schemas import faults, validator
from tests.wording import refusal

PRINT_SYSTEMS = {"sample", "convert", "c2d", "schema"}


@pytest.mark.parametrize("name", DOCUMENTS)
def test_a_shipped_schema_is_made_from_the_declarations(name: str) -> None:
    assert schema_text(name) == schema_file(name), "run make schemas"
    Draft202012Validator.check_schema(json.loads(schema_text(name)))


def test_every_command_has_a_schema_and_no_other_file_is_shipped() -> None:
    assert set(COMMANDS) - PRINT_SYSTEMS <= set(DOCUMENTS)
    assert {path.stem for path in FOLDER.iterdir()} == set(DOCUMENTS)
    assert set(kinds()) == set(json.loads(schema_text("certificate"))["properties"]["kind"]["enum"])


@pytest.mark.parametrize("name", gallery.names())
def test_every_published_plant_is_a_system_file(name: str) -> None:
    assert faults("system", json.loads(gallery.text(name))) == []


def small(folder: Path) -> str:
    """A small plant with a neighbor graph."""
    path = folder / "plant.json"
    ones = [[[1], [0]], [[0], [1]]]
    plant = MultiChannelSystem(
        [[0, 1], ["-1/2", -1]], ones, [[[1, 0]], [[0, 1]]], neighbors={"1": ["2"], "2": ["1"]}
    )
    save_system(plant, path)
    return str(path)


def asked(schema: str, *arguments: str, status: int = 0) -> Any:
    """The JSON of a command, which is as its schema says."""
    found, out, said = call(*arguments, "--json")
    assert found == status, said
    document = json.loads(out)
    assert faults(schema, document) == []
    return document


def written(folder: Path) -> None:
    """The certificates and the manifest in a folder are as their schemas say."""
    paths = sorted(folder.iterdir())
    assert "manifest.json" in [path.name for path in paths]
    for path in paths:
        schema = "manifest" if path.name == "manifest.json" else "certificate"
        assert faults(schema, json.loads(path.read_text())) == [], path.name


def test_answers_are_as_their_schemas_say(tmp_path: Path) -> None:
    plant, folder = small(tmp_path), tmp_path / "made"
    asked("analyze", "analyze", plant, "--certificates", str(folder))
    asked("check", "check", "--manifest", str(folder))
    written(folder)
    assert faults("system", json.loads(Path(plant).read_text())) == []


def test_answers_for_all_values_are_as_their_schemas_say(tmp_path: Path) -> None:
    plant, folder = "gallery:two-areas-parametric", tmp_path / "made"
    asked("analyze-parameters", "analyze", plant, "--certificates", str(folder))
    asked("check", "check", "--manifest", str(folder))
    written(folder)
    asked("system", "convert", plant)
    asked("system", "convert", plant, "--at", "T=1")


def test_the_least_sharing_is_as_its_schema_says(tmp_path: Path) -> None:
    folder = tmp_path / "made"
    asked("allocate", "allocate", small(tmp_path), "--certificates", str(folder))
    written(folder)


@pytest.mark.slow
def test_loops_are_as_their_schemas_say(tmp_path: Path) -> None:
    plant, folder, controller = small(tmp_path), tmp_path / "made", str(tmp_path / "c.json")
    asked(
        "design",
        "design",
        "decentralized",
        plant,
        "--rate",
        "1/10",
        "--effort",
        "0",
        "-o",
        controller,
    )
    assert faults("controller", json.loads(Path(controller).read_text())) == []
    asked("certify", "certify", plant, controller, "--certificates", str(folder))
    written(folder)


@pytest.mark.slow
def test_periodic_controllers_are_as_their_schemas_say(tmp_path: Path) -> None:
    plant, gains = "gallery:movable-by-periodic-gains", str(tmp_path / "gains.json")
    folder = tmp_path / "made"
    made = asked("design", "design", "decentralized", plant, "--periodic", "-o", gains)
    assert faults("periodic-controller", json.loads(Path(gains).read_text())) == []
    assert faults("periodic-controller", made["periodic_controller"]) == []
    asked("certify", "certify", plant, gains, "--certificates", str(folder))
    written(folder)
    asked("simulate", "simulate", plant, gains, "--horizon", "2")


def test_a_run_is_as_its_schema_says(tmp_path: Path) -> None:
    plant, controller = small(tmp_path), tmp_path / "c.json"
    save_controller(local_controllers(load_system(plant), [[[-1]], [[-1]]]), controller)
    loop = plant, str(controller), "--horizon", "1"
    asked("simulate", "simulate", *loop)
    asked("simulate", "simulate", *loop, "--step", "1/4", "--limits=-1,1")


def test_sweeps_and_lists_are_as_their_schemas_say(tmp_path: Path) -> None:
    results, missing = tmp_path / "r.jsonl", str(tmp_path / "missing.json")
    names = [f"--question={name}" for name in ("fixed_spectrum", "transfer_graph")]
    plants = [small(tmp_path), missing]
    asked("sweep", "sweep", *plants, *names, "-o", str(results), "--workers", "1", status=3)
    for line in results.read_text().splitlines():
        assert faults("sweep-record", json.loads(line)) == []
    asked("gallery", "gallery")
    listed = json.loads(call("schema", "--json")[1])
    assert set(listed["schemas"]) == set(DOCUMENTS)
    for name in ("c2d", "convert"):
        step = ("--step", "1/10") if name == "c2d" else ()
        assert faults("system", json.loads(call(name, plants[0], *step)[1])) == []


def test_a_controller_that_does_not_exist_is_told_in_the_same_format() -> None:
    plant = "gallery:hidden-triple-mode"
    found = asked("design", "design", "decentralized", plant, status=1)
    assert found["possible"] is False


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (("analyze", "no-such-file.json"), 3),
        (("analyze", "gallery:x"), 2),
        (("analyze", "--no-such-option"), 2),
        (("design", "decentralized", "gallery:compleib-ac1", "--timeout", "0.01"), 4),
    ],
)
def test_a_failure_is_a_document_too(arguments: tuple[str, ...], status: int) -> None:
    found, out, said = call(*arguments, "--json")
    document = json.loads(out)
    assert faults("error", document) == []
    assert found == document["status"] == status and document["message"] in said
    assert call(*arguments)[1] == ""


BAD: dict[str, tuple[str, Any]] = {
    "an unknown key": ("system", {"chanels": []}),
    "a number with a comma": ("system", {"A": [["0,5"]]}),
    "no channels": ("system", {"channels": []}),
    "an unknown time": ("system", {"time": "now"}),
    "a row that is a number": ("system", {"A": [1]}),
    "a name that is a number": ("system", {"channels": [{"name": 1, "B": [[1]], "C": [[1]]}]}),
    "an expression without parameters": ("system", {"A": [["t"]]}),
}


@pytest.mark.parametrize(("schema", "changed"), BAD.values(), ids=BAD)
def test_a_bad_file_is_refused(schema: str, changed: Any) -> None:
    good = {
        "format": "mcexact-system/1",
        "time": "continuous",
        "A": [["1/2"]],
        "channels": [{"B": [[1]], "C": [[0.5]]}],
    }
    assert faults(schema, good) == []
    assert faults(schema, good | changed)
    assert faults(schema, good | {"parameters": {"t": {"range": [0, None]}}, "A": [["t^2"]]}) == []


def test_a_claim_of_another_kind_is_refused(tmp_path: Path) -> None:
    call("analyze", "gallery:hidden-triple-mode", "--certificates", str(tmp_path / "made"))
    one, other = (
        json.loads((tmp_path / "made" / f"{name}.json").read_text())
        for name in ("fixed_spectrum", "completeness")
    )
    assert faults("certificate", one) == []
    assert faults("certificate", one | {"claim": other["claim"]})
    assert faults("certificate", one | {"witness": other["witness"]})
    assert faults("certificate", one | {"more": 1})


def test_a_type_without_a_schema_and_a_name_without_one_are_refused() -> None:
    with refusal(TypeError):
        of_type(float, "view")
    with pytest.raises(UsageError, match=r"no schema 'sistem' \(did you mean 'system'\?\)"):
        schema_text("sistem")
    assert call("schema", "error")[1] == schema_text("error")
    assert "mcexact schema NAME" in call("schema")[1]
    assert validator("error").is_valid({"format": "mcexact-error/1", "status": 3, "message": ""})
