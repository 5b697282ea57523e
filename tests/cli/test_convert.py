"""`mcexact convert` loses nothing, and other commands name it where they cannot read a file."""

import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mcexact.model import gallery
from mcexact.model.controller import is_controller, save_controller
from mcexact.model.files import load_parametric_system, load_system, save_system
from mcexact.model.parametric import ParametricSystem
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from tests.cli.calling import call
from tests.model.formats.hostile import mat
from tests.wording import says

TANKS = "gallery:quadruple-tank-pminus"


def test_a_plant_goes_through_all_kinds_and_comes_back(tmp_path: Path) -> None:
    way = [TANKS, *(str(tmp_path / name) for name in ("a.yaml", "b", "c.npz", "d.json"))]
    for source, target in itertools.pairwise(way):
        assert call("convert", source, "-o", target)[:2] == (0, "")
    assert load_system(way[-1]) == gallery.load("quadruple-tank-pminus")
    status, out, _ = call("convert", str(tmp_path / "b"))
    assert status == 0 and out == (tmp_path / "d.json").read_text()


@pytest.mark.parametrize(
    ("options", "exact"),
    [
        ((), "1/3"),
        (("--rounding", "simplest"), "1/3"),
        (("--rounding", "decimal"), "3333333333333333/10000000000000000"),
        (("--rounding", "dyadic"), "6004799503160661/18014398509481984"),
    ],
)
def test_floats_are_converted_by_a_rounding(
    options: tuple[str, ...], exact: str, tmp_path: Path
) -> None:
    source, target = tmp_path / "p.mat", tmp_path / "p.json"
    source.write_bytes(mat(A=np.array([[1 / 3, 0], [0, 1]]), inputs=None, outputs=None))
    sizes = ("--inputs", "1", "--outputs", "1")
    done = call("convert", str(source), *sizes, *options, "-o", str(target))
    assert done[:2] == (0, "")
    document = json.loads(target.read_text())
    assert document["A"] == [[exact, 0], [0, 1]]
    assert document["source"].startswith(f"rounding {options[1] if options else 'simplest'}: ")


@pytest.mark.parametrize(("rounding", "warned"), [("simplest", False), ("decimal", True)])
def test_a_plant_is_converted_with_a_warning_where_an_answer_depends_on_rounding_errors(
    rounding: str, warned: bool, tmp_path: Path
) -> None:
    """Columns that add up to 0 make the sum of all states uncontrollable, but for rounding."""
    source = tmp_path / "p.npz"
    rates = np.array([[0, 0.7, 1.9], [0.1, 0, 1.3], [0.2, 2.3, 0]]) / 7
    A = rates - np.diag(rates.sum(axis=0))
    assert np.any(A.sum(axis=0) != 0)
    eye = np.eye(3)
    B = [eye[:, [i]] - eye[:, [i + 1]] for i in range(2)]
    np.savez(source, A=A, B_1=B[0], C_1=eye[:1], B_2=B[1], C_2=eye[1:2])
    target = str(tmp_path / "p.json")
    status, out, said = call("convert", str(source), "--rounding", rounding, "-o", target)
    assert (status, out) == (0, "") and load_system(target).n == 3
    assert says(said, "warning") if warned else "warning" not in said
    # What is typed was not rounded here.
    assert "warning" not in call("convert", target, "-o", str(tmp_path / "q.json"))[2]


def test_an_output_that_cannot_hold_the_numbers_is_not_written(tmp_path: Path) -> None:
    target = tmp_path / "p.mat"
    status, _, said = call("convert", TANKS, "-o", str(target), "--rounding", "decimal")
    assert status == 3 and not target.exists()
    assert says(said, "rounding decimal") and str(target) in said
    assert call("convert", TANKS, "-o", str(target), "--nearest")[:2] == (0, "")


def test_a_folder_of_other_files_is_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "notes").mkdir()
    (tmp_path / "notes" / "a.txt").write_text("keep")
    status, _, said = call("convert", TANKS, "-o", str(tmp_path / "notes"))
    assert status == 3 and says(said, "other csv")
    assert (tmp_path / "notes" / "a.txt").read_text() == "keep"


@pytest.mark.parametrize("sizes", ["1,x", "-1", "", "1;2"])
def test_sizes_are_integers(sizes: str) -> None:
    status, _, said = call("convert", TANKS, "--inputs", sizes)
    assert status == 2 and says(said, "expected integers")


@pytest.mark.parametrize("file", ["tanks", "tanks.npz", "tanks.yaml"])
def test_every_command_takes_every_kind(file: str, tmp_path: Path) -> None:
    path = str(tmp_path / file)
    save_system(gallery.load("quadruple-tank-pminus"), path)
    status, out, _ = call("sweep", path, TANKS, "--workers", "1")
    assert status == 0 and "systems           2" in out
    assert call("c2d", path, "--step", "1")[0] == 0


def test_the_checker_reads_json_and_the_gallery(tmp_path: Path) -> None:
    made = tmp_path / "made"
    call("analyze", "gallery:hidden-triple-mode", "--certificates", str(made))
    certificate = str(made / "fixed_spectrum.json")
    status, out, _ = call(
        "check", "--statements", certificate, "--system", "gallery:hidden-triple-mode"
    )
    assert status == 0 and out.startswith("VALID")
    status, _, said = call(
        "check", "--statements", certificate, "--system", str(tmp_path / "p.mat")
    )
    assert status == 3 and says(said, "reads convert")
    assert call("check", "--statements", certificate, "--system", "gallery:x")[0] == 2


def test_a_controller_in_another_form_gets_a_hint(tmp_path: Path) -> None:
    path = tmp_path / "c.mat"
    path.write_bytes(mat())
    status, _, said = call("certify", TANKS, str(path))
    assert status == 3 and "local_controllers makes a controller of matrices" in said


@pytest.mark.parametrize("text", ["A = [1 2; 3 4]", "# a comment\n", "x", "\x89PNG"])
def test_a_file_of_another_program_gets_a_hint(text: str, tmp_path: Path) -> None:
    path = tmp_path / "plant.m"
    path.write_text(text)
    status, _, said = call("analyze", str(path))
    assert status == 3 and "Expecting value" not in said
    assert "a system file is JSON ('mcexact sample --template' prints one), .yaml, .mat" in said


@pytest.mark.parametrize(
    "option", [("--modulo", "both"), ("--at", "t=1"), ("--inputs", "1"), ("--outputs", "1")]
)
def test_options_about_plants_are_refused_for_controllers(
    tmp_path: Path, option: tuple[str, str]
) -> None:
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    save_controller(local_controllers(plant, [[[-1]]]), tmp_path / "c.json")
    status, _, said = call("convert", str(tmp_path / "c.json"), *option)
    assert status == 2 and "found a controller" in said and option[0] in said


def test_a_plant_is_not_read_in_order_to_know_that_it_is_no_controller(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fails(*_: object) -> None:
        raise AssertionError("the file is read")

    named = b'{"format": "mcexact-controller/1"}'
    assert is_controller(named) and is_controller(named.replace(b"/", rb"\/"))
    monkeypatch.setattr("mcexact.model.controller.parse", fails)
    assert not is_controller(b'{"format": "mcexact-system/1"}')


PARAMETRIC = "gallery:quadruple-tank-parametric"


@pytest.mark.parametrize("name", ["plant.json", "plant.yaml"])
def test_a_system_with_parameters_is_written_and_read_again(tmp_path: Path, name: str) -> None:
    first, again = tmp_path / name, tmp_path / "again.json"
    assert call("convert", PARAMETRIC, "-o", str(first))[:2] == (0, "")
    assert call("convert", str(first), "-o", str(again))[:2] == (0, "")
    assert load_parametric_system(again) == load_parametric_system(PARAMETRIC)


@pytest.mark.parametrize("name", ["plant.mat", "plant.npz", "folder"])
def test_letters_are_no_arrays(tmp_path: Path, name: str) -> None:
    status, _, err = call("convert", PARAMETRIC, "-o", str(tmp_path / name))
    assert status == 3 and "or give values, --at gamma1=1/3" in err


@pytest.mark.parametrize("name", ["plant.json", "plant.npz", "folder"])
def test_values_make_it_a_system_of_every_kind(tmp_path: Path, name: str) -> None:
    values = {"gamma1": "1/2", "gamma2": "0.25"}
    plant = ParametricSystem([["gamma1"]], [[["gamma2"]]], [[[1]]], parameters=list(values))
    save_system(plant, tmp_path / "letters.json")
    at = [f"--at={letter}={value}" for letter, value in values.items()]
    path = str(tmp_path / name)
    assert call("convert", str(tmp_path / "letters.json"), *at, "-o", path)[:2] == (0, "")
    rounding: Any = "dyadic" if name.endswith(".npz") else None
    assert load_system(path, rounding=rounding) == plant.at(values)


@pytest.mark.parametrize(
    ("file", "at", "said"),
    [
        (PARAMETRIC, ["gamma1=1"], "expected a value of the parameter 'gamma2'"),
        (PARAMETRIC, ["t=1"], "unknown parameter 't'"),
        ("gallery:quadruple-tank-pminus", ["t=1"], "without parameters: leave out --at"),
        (PARAMETRIC, ["gamma1"], "expected NAME=VALUE, such as t=1/3, found 'gamma1'"),
    ],
)
def test_values_that_do_not_fit_are_refused(file: str, at: list[str], said: str) -> None:
    status, _, err = call("convert", file, *(f"--at={each}" for each in at))
    assert status in (2, 3) and said in err


def test_a_file_of_an_unknown_kind_is_not_written(tmp_path: Path) -> None:
    status, _, said = call("convert", TANKS, "-o", str(tmp_path / "plant.xlsx"))
    assert status == 2 and "ends in '.xlsx': choose .json" in said
    assert not list(tmp_path.iterdir())
