"""`mcexact export`: code into a folder, equations to standard output, and refusals."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import jsonschema

from mcexact import MultiChannelSystem, load_controller, save_controller, save_system
from mcexact.constructions import sampled_system
from mcexact.model.statespace import local_controllers
from mcexact.report.schema import schema_text
from tests.cli.calling import call
from tests.wording import says


def controller(folder: Path, time: str = "discrete") -> Path:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time=time, names=["pump"])
    path = folder / f"{time}.json"
    save_controller(local_controllers(plant, [[["-1/3"]]]), path)
    return path


def test_code_goes_into_a_folder_and_again(tmp_path: Path) -> None:
    path, code = controller(tmp_path), tmp_path / "code"
    for language, files in (("c", {"pump.c", "pump.h"}), ("st", {"pump.st"})):
        for _ in range(2):
            status, _, err = call("export", str(path), "--to", language, "-o", str(code))
            assert status == 0, err
        assert {each.name for each in code.iterdir()} == {
            *files,
            "equations.json",
            "controller.json",
        }


def test_equations_go_to_standard_output(tmp_path: Path) -> None:
    path, code = controller(tmp_path), tmp_path / "code"
    status, out, _ = call("export", str(path), "--to", "json")
    assert status == 0 and json.loads(out)["agents"][0]["name"] == "pump"
    jsonschema.validate(json.loads(out), json.loads(schema_text("export")))
    status, again, _ = call("export", str(path), "-o", str(code), "--json")
    assert status == 0 and again == out == (code / "equations.json").read_text()
    target = tmp_path / "sums.json"
    assert call("export", str(path), "--to", "json", "-o", str(target))[0] == 0
    assert target.read_text() == out


def test_what_cannot_be_exported_is_refused_and_nothing_is_overwritten(tmp_path: Path) -> None:
    path = controller(tmp_path)
    status, _, err = call("export", str(path))
    assert status != 0 and "-o FOLDER" in err
    status, _, err = call("export", str(controller(tmp_path, "continuous")), "--to", "json")
    assert status != 0 and "discrete time" in err
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "work.c").write_text("int x;")
    status, _, err = call("export", str(path), "-o", str(tmp_path / "mine"))
    assert status != 0 and (tmp_path / "mine" / "work.c").read_text() == "int x;"


def sampled(folder: Path) -> tuple[str, str]:
    """Files of an unstable plant in continuous time, and of gains for its samples."""
    plant = MultiChannelSystem([["1/10"]], [[[1]]], [[[1]]], names=["pump"])
    files = str(folder / "plant.json"), str(folder / "gains.json")
    save_system(plant, files[0])
    save_controller(local_controllers(sampled_system(plant, "1/2", 1), [[["-1/3"]]]), files[1])
    return files


SAMPLED = ("--step", "1/2", "--late", "1")


def test_the_code_is_certified_with_its_numbers(tmp_path: Path) -> None:
    plant, gains = sampled(tmp_path)
    code, evidence, page = (str(tmp_path / name) for name in ("code", "evidence", "page.html"))
    options = ("--plant", plant, *SAMPLED, "-o", code, "--certificates", evidence, "--html", page)
    status, told, err = call("export", gains, "--fixed-point", *options)
    assert status == 0, err
    assert "Proved: cost" in told and "fixed point, " in told and "VALID" in told
    about = "note: the verdict is about a controller with the numbers of the code (fixed point, "
    assert about in told and says(told, "signals beyond")
    bits = int(told.split("fixed point, ")[1].split()[0])
    controller = Path(code, "controller.json")
    [agent] = load_controller(controller).agents
    gain = agent.input.outputs[0][0, 0]
    assert gain != Fraction(-1, 3) and (gain * 2**bits).denominator == 1
    assert "int32_t" in Path(code, "pump.c").read_text()
    proof = json.loads(Path(evidence, "rounded_gains.json").read_text())
    assert proof["kind"] == "box_stable"
    assert "Proved: cost" in Path(page).read_text(encoding="utf-8")
    status, told, err = call("certify", plant, str(controller), *SAMPLED)
    assert status == 0 and "warning" not in err


def test_code_whose_loop_is_not_stable_is_not_written(tmp_path: Path) -> None:
    plant, gains = sampled(tmp_path)
    code = tmp_path / "code"
    options = ("--plant", plant, *SAMPLED, "-o", str(code))
    status, told, err = call("export", gains, "--fixed-point", "0", *options)
    assert status == 1 and says(err, "code written") and not code.exists()
    assert "not" in told.splitlines()[0]


def test_equations_have_the_scales_of_fixed_point(tmp_path: Path) -> None:
    _, gains = sampled(tmp_path)
    options = ("--fixed-point", "6", "--range", "50", "--range", "u=3", "--to", "json")
    status, told, _ = call("export", gains, *options)
    document = json.loads(told)
    jsonschema.validate(document, json.loads(schema_text("export")))
    scales = document["fixed point"]["fractional bits of signals"]
    assert status == 0 and (scales["y"], scales["u"]) == (25, 29)
    assert document["fixed point"]["fractional bits of numbers"] == 6


def test_options_that_need_others_are_refused(tmp_path: Path) -> None:
    _, gains = sampled(tmp_path)
    code = ("-o", str(tmp_path / "code"))
    for options, told in (
        (("--fixed-point",), "the fewest bits depend on the plant: add --plant"),
        (("--fixed-point", "49"), "expected 0 to 48 bits, found '49'"),
        (("--range", "3"), "add --fixed-point"),
        (SAMPLED, "--step is about a plant"),
        (("--html", str(tmp_path / "page.html")), "add --plant"),
        (("--fixed-point", "44", "--range", "1"), "could leave 64 bits"),
    ):
        status, _, err = call("export", gains, *options, *code)
        assert status in (2, 3) and told in err, err
    assert not (tmp_path / "code").exists()
