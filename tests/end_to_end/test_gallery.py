"""Every system of the gallery, from its file to checked certificates that say the same."""

import json
import re
import shutil
import sys
from fractions import Fraction
from operator import itemgetter
from pathlib import Path
from typing import Any

import pytest
import sympy

import mcexact
from mcexact.model import gallery
from tests.end_to_end.command_line import run
from tests.wording import says

GALLERY = Path(gallery.__file__).parent
CHECKER = Path(mcexact.__file__).parent / "checker"
X = sympy.Symbol("x")


@pytest.fixture(scope="module")
def copied_checker(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the checker, copied to where nothing else is."""
    folder = tmp_path_factory.mktemp("copied")
    shutil.copytree(CHECKER, folder / "checker", ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def polynomial(text: str) -> tuple[Fraction, ...]:
    """The coefficients of a polynomial written out, made monic, constant term first."""
    written = sympy.Poly(sympy.sympify(text.replace("^", "**"), rational=True), X).monic()
    return tuple(Fraction(int(c.p), int(c.q)) for c in reversed(written.all_coeffs()))


def coefficients(listed: list[int | str]) -> tuple[Fraction, ...]:
    return tuple(map(Fraction, listed))


def named(system: Any, numbers: list[int]) -> list[str]:
    return [system.names[number - 1] for number in numbers]


def test_every_system_with_known_answers_is_in_the_gallery() -> None:
    known = json.loads((GALLERY / "expected.json").read_text(encoding="utf-8"))
    assert known and known.keys() == {*gallery.names()}


@pytest.mark.parametrize("name", gallery.names())
def test_the_answers_are_the_known_ones_and_the_certificates_say_the_same(
    name: str, copied_checker: Path, tmp_path: Path
) -> None:
    file = GALLERY / f"{name}.json"
    done = run("analyze", str(file), "--json", "--certificates", str(tmp_path))
    assert (done.status, done.messages) == (0, [])
    answer = json.loads(done.stdout)
    agrees_with_what_is_known(answer, name)
    theorems = checked_theorems(answer, file, copied_checker, tmp_path)
    theorems_state_the_answer(answer, theorems)


REACH = {
    "joint_controllability": ("controllable", "jointly_controllable"),
    "joint_observability": ("observable", "jointly_observable"),
}
"""The key of the answer to each question, and that of the published one."""


def agrees_with_what_is_known(answer: dict[str, Any], name: str) -> None:
    """Compare an answer with the published one."""
    system, expected = gallery.load(name), gallery.expected(name)
    spectrum = answer["fixed_spectrum"]
    assert {
        coefficients(factor["polynomial"]): factor["multiplicity_at_most"]
        for factor in spectrum["factors"]
    } == {polynomial(f["factor"]): f["multiplicity"] for f in expected["fixed_factors"]}
    assert spectrum["empty"] == (not expected["fixed_factors"])
    for question, (key, known) in REACH.items():
        assert answer[question][key] == expected[known]
    assert answer["completeness"]["complete"] == expected["complete"]
    graph = answer["transfer_graph"]
    assert graph["arcs"] == [named(system, arc) for arc in expected["transfer_graph_arcs"]]
    components = [named(system, part) for part in expected["strong_components"]]
    assert sorted(graph["components"]) == sorted(components)
    assert graph["strongly_connected"] == (len(components) <= 1)
    for known in expected.get("anderson_clements", ()):
        found = next(
            factor
            for factor in spectrum["factors"]
            if coefficients(factor["polynomial"]) == polynomial(known["factor"])
        )
        least = min((case["rank"] for case in known["deficient"]), default=found["rank"])
        assert found["rank"] == least
        subsets = [named(system, c["s_1based"]) for c in known["deficient"] if c["rank"] == least]
        assert found["channels"] in subsets
        assert all(set(subset) <= set(found["channels"]) for subset in subsets)


def checked_theorems(
    answer: dict[str, Any], file: Path, copied_checker: Path, folder: Path
) -> dict[str, str]:
    """The theorem behind each answer, from the checker that was copied out."""
    named_files = {
        name: found["certificate"]
        for name, found in answer.items()
        if isinstance(found, dict) and "certificate" in found
    }
    assert {*REACH, "transfer_graph", "fixed_spectrum", "completeness"} <= named_files.keys()
    plants = answer.get("nearby", {}).get("plants", [])
    files = sorted({*named_files.values(), *(each["certificate"] for each in plants)})
    assert sorted([*files, "manifest.json"]) == sorted(path.name for path in folder.iterdir())
    program = [
        "env",
        "-C",
        str(copied_checker),
        sys.executable,
        "-S",
        "-E",
        "-m",
        "checker",
        "--statements",
    ]
    listed = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    others = listed.get("nearby", [])  # about plants with other numbers at the same places
    assert run(*(str(folder / each) for each in others), program=program).status == 0 or not others
    files = [each for each in files if each not in others]
    paths = [str(folder / each) for each in files]
    implied = run("--system", str(file), "--manifest", str(folder), program=program)
    assert implied.status == 0, implied
    done = run("--system", str(file), *paths, program=program)
    assert done.status == 0, done
    lines = done.stdout.splitlines()
    assert [line.split(" ", 1)[0] for line in lines] == ["VALID"] * len(files)
    by_file = dict(zip(files, lines, strict=True))
    return {answered: by_file[each] for answered, each in named_files.items() if each in by_file}


FACTOR = re.compile(
    r"(?P<polynomial>[-+*/^x0-9 ]+) is (?P<unstable>not )?(?:Hurwitz|Schur), has the exponent "
    r"(?P<in_A>\d+) in det\(xI - A\) and at most (?P<at_most>\d+) in the greatest common divisor "
    r"of det\(xI - A_F\) over all constant gains F, and one root in each of the discs "
    r"\{(?P<roots>[^}]*)\}, where the least rank of \[xI - A, B; C, 0\] [^;]*, is (?P<rank>\d+), "
    r"reached by \{(?P<channels>[^}]*)\}"
)
EDGE = re.compile(r'"([^"]*)" -> "([^"]*)"')


def disc(text: str) -> tuple[Fraction, Fraction, Fraction]:
    """A disc written as 1 + 2i +- 1/8: its center and radius."""
    center, _, radius = text.partition(" +- ")
    real, sign, imaginary = re.fullmatch(r"(\S+)(?: ([-+]) (\S+)i)?", center).groups()
    return Fraction(real), Fraction(f"{sign or ''}{imaginary or 0}"), Fraction(radius)


def theorems_state_the_answer(answer: dict[str, Any], theorems: dict[str, str]) -> None:
    """Read the answers out of the theorems and compare."""
    spectrum = answer["fixed_spectrum"]
    theorem = theorems["fixed_spectrum"]
    read = [
        {
            "polynomial": polynomial(found["polynomial"]),
            "multiplicity_in_A": int(found["in_A"]),
            "multiplicity_at_most": int(found["at_most"]),
            "rank": int(found["rank"]),
            "channels": re.findall(r'"([^"]*)"', found["channels"]),
            "stable": not found["unstable"],
            "roots": sorted(disc(each) for each in found["roots"].split(", ")),
        }
        for found in FACTOR.finditer(theorem.partition(": ")[2])
    ]
    known = [
        {
            **factor,
            "polynomial": coefficients(factor["polynomial"]),
            "roots": sorted(
                tuple(Fraction(root[part]) for part in ("re", "im", "radius"))
                for root in factor["roots"]
            ),
        }
        for factor in spectrum["factors"]
    ]
    by_polynomial = itemgetter("polynomial")
    assert sorted(read, key=by_polynomial) == sorted(known, key=by_polynomial)
    assert says(theorem, "none") if spectrum["empty"] else ": no mode" not in theorem
    assert ("not stabilizable" in theorem) == (not spectrum["stabilizable"])
    if spectrum["best_rate"] is not None:
        rate = spectrum["best_rate"]
        assert f" is from {Fraction(rate['lower'])} to {Fraction(rate['upper'])}" in theorem
    for question, (key, _) in REACH.items():
        holds = answer[question][key]
        assert ("not controllable" in theorems[question]) == (not holds)
        assert ("the dual of" in theorems[question]) == (question == "joint_observability")
    graph = answer["transfer_graph"]
    arcs = theorems["transfer_graph"].partition("has exactly the edges ")[2].partition("}")[0]
    assert [list(arc) for arc in EDGE.findall(arcs)] == graph["arcs"]
    for component in graph["components"]:
        assert (
            "{" + ", ".join(f'"{name}"' for name in component) + "}" in theorems["transfer_graph"]
        )
    assert ("not strongly connected" in theorems["transfer_graph"]) != graph["strongly_connected"]
    assert (" is not complete" in theorems["completeness"]) != answer["completeness"]["complete"]


@pytest.fixture
def ring(tmp_path: Path) -> Path:
    """The paper's example, its three agents on a ring."""
    document = json.loads(gallery.text("liu2020-3ch-no-communication"))
    document["neighbors"] = {"1": ["2"], "2": ["3"], "3": ["1"]}
    file = tmp_path / "example.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    return file


@pytest.mark.parametrize("information", ["own", "outputs"])
def test_every_answer_about_agents_with_neighbors_has_a_valid_certificate(
    information: str, ring: Path, copied_checker: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "certificates"
    options = ("--json", "--minimal", "--information", information, "--subset", "2")
    done = run("analyze", str(ring), *options, "--certificates", str(folder))
    assert (done.status, done.messages) == (0, [])
    answer = json.loads(done.stdout)
    for share, total in (("outputs_states", 1), ("states", 2)):
        assert sum(answer[f"minimal_shared_dimensions_{share}"]["dimensions"]) == total
    theorems = checked_theorems(answer, ring, copied_checker, folder)
    about = " with the outputs of neighbors measured" if information == "outputs" else "the plant "
    assert about in theorems["fixed_spectrum"]
    assert "strongly connected" in theorems["neighbor_graph"]


def test_the_example_with_outputs_of_neighbors_is_the_augmented_example(ring: Path) -> None:
    heard = run("analyze", str(ring), "--json", "--information", "outputs")
    augmented = run("analyze", str(GALLERY / "liu2020-3ch-augmented-outputs.json"), "--json")
    answers = [json.loads(done.stdout) for done in (heard, augmented)]
    factors = [
        [
            (factor["polynomial"], factor["channels"], factor["rank"])
            for factor in answer["fixed_spectrum"]["factors"]
        ]
        for answer in answers
    ]
    assert factors[0] == factors[1] == [([-1, 1], ["2"], 2)]
    assert answers[0]["neighbor_graph"]["strongly_connected"] is True
    own = json.loads(run("analyze", str(ring), "--json").stdout)
    assert [
        (factor["polynomial"], factor["channels"]) for factor in own["fixed_spectrum"]["factors"]
    ] == [([-1, 1], ["2", "3"])]
