"""The option ``--modulo``: analyses, designs, verdicts and files without a part of the state."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mcexact.model import gallery
from mcexact.model.files import load_system
from mcexact.model.system_file import system_text
from tests.end_to_end.command_line import run
from tests.wording import says

FOLDER = Path(gallery.__file__).parent
RELATIVE = str(FOLDER / "relative-positions-4.json")


def own_subspace(folder: Path, content: str) -> str:
    file = folder / "subspace.json"
    file.write_text(content, encoding="ascii")
    return str(file)


def test_an_analysis_names_the_option_where_no_output_shows_a_mode() -> None:
    done = run("analyze", RELATIVE)
    assert done.status == 0
    assert says(done.stdout, "unobservable asks")
    assert "joint fixed modes          the mode 0" in done.stdout
    assert "decentralized fixed modes  none" in done.stdout


def test_an_analysis_of_the_rest_says_what_stays(tmp_path: Path) -> None:
    done = run("analyze", RELATIVE, "--modulo", "unobservable", "--json")
    told = json.loads(done.stdout)
    assert done.status == 0 and told["fixed_spectrum"]["empty"]
    spoken = run("analyze", RELATIVE, "--modulo", "unobservable").stdout
    assert says(spoken, "answers state")
    own = run(
        "analyze", RELATIVE, "--modulo", own_subspace(tmp_path, '{"unobservable": [[2, 2, 2, 2]]}')
    )
    assert own.stdout == spoken


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('{"unobservable": [[1, 0, 0, 0]]}', "subspace: expected a subspace that no output shows"),
        ('{"hidden": [[1, 1, 1, 1]]}', "unobservable"),
        ("[[1, 1, 1, 1]]", "expected an object such as"),
        ('{"unobservable": [[1, 1, 1]]}', "expected at least one row of 4 entries"),
    ],
)
def test_what_is_no_such_subspace_is_refused(tmp_path: Path, content: str, message: str) -> None:
    done = run("analyze", RELATIVE, "--modulo", own_subspace(tmp_path, content))
    assert done.status == 3 and message in done.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("analyze", RELATIVE, "--modulo", "hidden"), "the name of a file, found 'hidden'"),
        (("analyze", RELATIVE, "--modulo", "both", "--uncertainty", "1%"), "--modulo is about"),
        (
            ("design", "decentralized", RELATIVE, "--modulo", "both", "--step", "1/10"),
            "--modulo is about the plant in FILE as it is",
        ),
        (
            (
                *("analyze", str(FOLDER / "parametric" / "quadruple-tank-parametric.json")),
                *("--modulo", "both"),
            ),
            "--modulo is about plants without parameters",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(arguments: tuple[str, ...], message: str) -> None:
    done = run(*arguments)
    assert done.status in (2, 3) and message in done.stderr, done.stderr


@pytest.mark.parametrize("command", [("design", "decentralized"), ("certify",), ("analyze",)])
def test_a_page_does_not_replace_the_file_of_the_subspace(
    tmp_path: Path, command: tuple[str, ...]
) -> None:
    content = '{"unobservable": [[1, 1, 1, 1]]}'
    subspace = own_subspace(tmp_path, content)
    files = (RELATIVE, RELATIVE) if command == ("certify",) else (RELATIVE,)
    done = run(*command, *files, "--modulo", subspace, "--html", subspace)
    assert done.status in (2, 3) and "subspace.json" in done.stderr, done.stderr
    assert Path(subspace).read_text("ascii") == content


def test_a_design_that_is_refused_names_the_option() -> None:
    done = run("design", "decentralized", RELATIVE)
    assert done.status == 1
    assert says(done.stderr, "modulo unobservable")


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["relative-positions-4", "swing-grid-four-buses", "formation-of-twelve"]
)
def test_a_design_for_the_rest_runs_on_the_plant(tmp_path: Path, name: str) -> None:
    plant, file = str(FOLDER / f"{name}.json"), str(tmp_path / "controller.json")
    folder = tmp_path / "proofs"
    done = run(
        *("design", "decentralized", plant, "--modulo", "unobservable", "-o", file),
        *("--certificates", str(folder)),
    )
    assert done.status == 0, done.stderr
    assert says(done.stdout, "answers modulo")
    assert run("check", "--statements", "--manifest", str(folder / "manifest.json")).status == 0
    assert run("certify", plant, file, "--modulo", "unobservable").status == 0
    assert run("certify", plant, file).status == 1
    start = ("--initial", ",".join(map(str, range(gallery.load(name).n))))
    for part in ((), ("--modulo", "unobservable")):
        ran = run("simulate", plant, file, *start, *part, "--horizon", "300", "--json")
        told = json.loads(ran.stdout)
        assert ran.status == 0 and "made for" not in ran.stderr
        assert told["stable"] == bool(part) and (told["proved_bounds"] is not None) == bool(part)
        last = [float(y) for agent in told["agents"] for y in agent["outputs"][-1]]
        assert max(map(abs, last)) < 1e-3


def test_a_minimal_realization_is_written(tmp_path: Path) -> None:
    file = tmp_path / "minimal.json"
    done = run(
        "convert", str(FOLDER / "swing-grid-four-buses.json"), "--modulo", "both", "-o", str(file)
    )
    assert done.status == 0
    assert load_system(file).n == 7
    assert "modulo" not in system_text(load_system(file))
