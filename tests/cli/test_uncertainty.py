"""What commands say about every plant whose entries are within their radii."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from pathlib import Path

import pytest

from mcexact import MultiChannelSystem, fixed_spectrum, save_controller, save_system
from mcexact.boxes import Box
from mcexact.cli.options import part
from mcexact.constructions import c2d
from mcexact.designs import local_controllers
from mcexact.model.system_file import read_system
from tests.cli.calling import call
from tests.report.schemas import faults
from tests.wording import lacks, says

CERTIFIED = "cli/test_uncertainty.py::test_certify_is_about_every_plant_and_all_gains"
PLANT = MultiChannelSystem(
    [["-0.5", 1], ["0.1", 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], names=["a", "b"]
)
FIXED = MultiChannelSystem([[-1, 0], [0, 2]], [[[0], [1]]], [[[0, 1]]])


@pytest.fixture
def plant(tmp_path: Path) -> str:
    """The file of a plant."""
    save_system(PLANT, tmp_path / "plant.json")
    return str(tmp_path / "plant.json")


@pytest.fixture
def gains(tmp_path: Path) -> str:
    """The file of a controller for it."""
    save_controller(local_controllers(PLANT, [[[-2]], [["-1.234"]]]), tmp_path / "gains.json")
    return str(tmp_path / "gains.json")


def test_analyze_leads_with_what_holds_for_every_plant(plant: str, tmp_path: Path) -> None:
    status, out, _ = call(
        "analyze", plant, "--uncertainty", "0.1%", "--certificates", str(tmp_path / "proofs")
    )
    assert status == 0 and "VALID" in out
    first, _, rest = out.partition("At the nominal values:")
    assert "within the radii: no plant has a fixed mode" in " ".join(first.split())
    assert says(rest, "mode fixed")
    assert (tmp_path / "proofs" / "box_fixed_modes.json").is_file()
    status, out, _ = call("analyze", plant)
    assert status == 0 and "radii" not in out


def test_the_page_leads_with_it_too_and_says_which_matrices_it_shows(
    plant: str, tmp_path: Path
) -> None:
    page = tmp_path / "page.html"
    status, _, said = call("analyze", plant, "--uncertainty", "0.1%", "--html", str(page))
    assert status == 0, said
    first, found, rest = page.read_text("utf-8").partition("<p>At the nominal values:</p>")
    assert (
        found
        and "within the radii: no plant has a fixed mode" in first
        and says(rest, "mode fixed")
    )
    assert says(rest, "matrices nominal")
    assert all("7 entries are uncertain, by at most 0.1 %" in each for each in (first, rest))


def test_the_page_names_what_is_open_and_the_largest_uncertainty(tmp_path: Path) -> None:
    save_system(FIXED, tmp_path / "fixed.json")
    page = tmp_path / "page.html"
    fixed = str(tmp_path / "fixed.json")
    assert call("analyze", fixed, "--uncertainty", "1/100", "--html", str(page))[0] == 0
    said = page.read_text("utf-8")
    assert says(said, "questions took")
    assert says(said, "itself nominal")
    assert says(said, "box observable")
    search = ("--largest-uncertainty", "--effort", "1")
    save_system(PLANT, tmp_path / "plant.json")
    plant = str(tmp_path / "plant.json")
    assert call("analyze", plant, *search, "--html", str(page))[0] == 0
    said = page.read_text("utf-8")
    assert "Largest uncertainty" in said and says(said, "mode fixed")
    assert says(said, "alt within")
    assert says(said, "largest radii")


def test_analyze_reads_the_uncertainty_of_the_file(tmp_path: Path) -> None:
    document = PLANT.to_dict() | {"uncertainty": {"relative": "1/100"}}
    path = tmp_path / "plant.json"
    path.write_text(json.dumps(document))
    status, out, _ = call("analyze", str(path), "--json")
    found = json.loads(out)
    assert status == 0 and found["box_fixed_modes"]["bound"] is None
    assert not faults("analyze", found)
    assert found["box_stabilizability"]["bound"] in (0, "0")
    assert found["box_setpoints"]["bound"] in (0, "0")
    status, out, _ = call("analyze", str(path))
    first = " ".join(out.partition("At the nominal values:")[0].split())
    assert says(first, "own constant")


def test_set_points_are_open_unless_the_plant_itself_has_none(tmp_path: Path) -> None:
    for C, told in (([["1.1", -2]], True), ([[1, -2]], False)):
        plant = MultiChannelSystem([[-1, 0], [0, -2]], [[[1], [1]]], [C])
        save_system(Box.relative(plant, "1/5").system, tmp_path / "plant.json")
        status, out, _ = call("analyze", str(tmp_path / "plant.json"))
        first, _, rest = out.partition("At the nominal values:")
        _, _, left = first.partition("open, as no proof was found:")
        assert status == 0 and rest and ("setpoints" in left) is told


def test_a_plant_that_fails_at_its_nominal_values_leaves_the_question_open(tmp_path: Path) -> None:
    save_system(FIXED, tmp_path / "fixed.json")
    status, out, _ = call("analyze", str(tmp_path / "fixed.json"), "--uncertainty", "1/100")
    said = " ".join(out.split())
    assert status == 0 and says(said, "itself nominal")
    assert says(said, "plant stabilizable")


def test_analyze_searches_the_largest_uncertainty(plant: str) -> None:
    status, out, _ = call("analyze", plant, "--largest-uncertainty", "--effort", "1", "--json")
    found = json.loads(out)
    assert status == 0 and found["largest_uncertainty"]["relative"] is True
    assert not faults("analyze", found) and "box_fixed_modes" in found
    status, _, err = call("analyze", plant, "--largest-uncertainty", "--uncertainty", "1%")
    assert status == 2 and "leave out --uncertainty" in err
    status, _, err = call("analyze", plant, "--effort", "1")
    assert status == 2 and "--effort is for --largest-uncertainty" in err
    status, _, err = call("analyze", plant, "--also", "box_setpoints")
    assert status == 2 and says(err, "also setpoints")


@pytest.mark.parametrize(
    ("wanted", "question"),
    [("stabilizable", "box_stabilizability"), ("observable", "box_observability")],
)
def test_analyze_searches_the_largest_uncertainty_of_a_property(
    plant: str, wanted: str, question: str
) -> None:
    search = ("--largest-uncertainty", "--effort", "1", "--property", wanted)
    status, out, _ = call("analyze", plant, *search, "--json")
    found = json.loads(out)
    assert status == 0 and found["largest_uncertainty"]["property"] == wanted
    assert not faults("analyze", found) and question in found
    status, _, err = call("analyze", plant, "--property", wanted)
    assert status == 2 and "--property is for --largest-uncertainty" in err
    status, _, err = call("analyze", plant, *search, "--information", "outputs")
    assert status == 2 and says(err, "feed back")


def test_certify_searches_the_largest_uncertainty(plant: str, gains: str, tmp_path: Path) -> None:
    search = ("certify", plant, gains, "--largest-uncertainty", "--effort", "1")
    status, out, _ = call(*search, "--json", "--html", str(tmp_path / "page.html"))
    found = json.loads(out)
    largest = found["largest_uncertainty"]
    assert status == 0 and not faults("certify", found)
    assert 0 < Fraction(largest["lower"]) < Fraction(largest["upper"])
    assert found["every_loop"]["certified"]
    assert "Largest uncertainty" in (tmp_path / "page.html").read_text("utf-8")
    status, out, _ = call(*search, "--rate", "1/1000")
    assert status == 0 and says(out, "eigenvalue satisfies")
    status, _, err = call(*search, "--uncertainty", "1%")
    assert status == 2 and "leave out --uncertainty" in err
    status, out, _ = call(*search, "--rate", "1000000")
    assert status == 1 and "no box" in out and "a plant fails within    0 %" in out


def test_the_largest_radii_do_not_hide_that_the_loop_fails_within_those_of_the_file(
    gains: str, tmp_path: Path
) -> None:
    file = str(tmp_path / "uncertain.json")
    search = ("certify", file, gains, "--largest-uncertainty", "--effort", "1")
    for radius, told in (
        ("300%", "Do not install: fails within the radii"),
        ("0.001", "Worth installing"),
    ):
        save_system(Box.relative(PLANT, radius).system, file)
        status, out, _ = call(*search)
        assert status == 0 and says(out, "loop near") and told in " ".join(out.split())
    status, out, _ = call(*search, "--rate", "1/1000", "--json")
    assert json.loads(out)["every_loop"]["region"] == "Re λ < -1/1000"


def test_what_the_largest_radii_prove_is_certified_and_is_about_the_gains_as_they_are(
    plant: str, gains: str, tmp_path: Path
) -> None:
    search = ("certify", plant, gains, "--largest-uncertainty", "--effort", "1")
    status, out, _ = call(*search, "--certificates", str(tmp_path / "proofs"), "--json")
    assert status == 0
    largest, proof = json.loads(out)["largest_uncertainty"], tmp_path / "proofs/box_stability.json"
    system = json.loads(proof.read_text("utf-8"))["system"]
    proved = read_system(json.dumps({**system, "format": "mcexact-system/1"}))
    assert Box(proved) == Box.relative(PLANT, largest["lower"])
    status, _, err = call(*search, "--gains", "1%")
    assert status == 2 and "leave out --gains" in err


@pytest.mark.parametrize(
    ("absolute", "rule"), [(False, "certify-failing-plant"), (True, "certify-failing-plant-radii")]
)
def test_the_plant_that_ends_the_search_is_certified(
    gains: str, tmp_path: Path, absolute: bool, rule: str
) -> None:
    file, folder = str(tmp_path / "plant.json"), tmp_path / "proofs"
    tenths = [["1/10", "1/10"], ["1/10", "1/10"]]
    save_system(Box.absolute(PLANT, A=tenths).system if absolute else PLANT, file)
    search = ("certify", file, gains, "--largest-uncertainty", "--effort", "1")
    status, out, _ = call(*search, "--certificates", str(folder), "--json")
    found = json.loads(out)
    assert status == 0 and rule in {each["rule"] for each in found["sentences"]}
    assert not faults("certify", found)
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    assert manifest["nearby"] == ["failing_loop.json"]
    certificate = json.loads((folder / "failing_loop.json").read_text("utf-8"))
    assert certificate["claim"] == {"bound": None, "stable": False}
    failing = read_system(json.dumps(found["largest_uncertainty"]["failing"]))
    written = read_system(json.dumps({**certificate["system"], "format": "mcexact-system/1"}))
    assert written == failing
    assert call("check", "--statements", "--manifest", str(folder), "--controller", gains)[0] == 0


def test_a_plant_that_is_only_too_slow_is_certified_but_not_called_unstable(
    plant: str, gains: str, tmp_path: Path
) -> None:
    search = ("certify", plant, gains, "--largest-uncertainty", "--effort", "1", "--rate", "1")
    status, out, _ = call(*search, "--certificates", str(tmp_path / "proofs"))
    assert status == 0 and lacks(out, CERTIFIED, "loop stable")
    certificate = json.loads((tmp_path / "proofs/failing_loop.json").read_text("utf-8"))
    assert certificate["claim"] == {"bound": 1, "stable": False}
    checks = ("check", "--manifest", str(tmp_path / "proofs"), "--system", plant)
    assert call(*checks, "--controller", gains)[0] == 0


def test_certify_is_about_every_plant_and_all_gains(plant: str, gains: str) -> None:
    status, out, err = call("certify", plant, gains, "--uncertainty", "1%", "--gains", "1%")
    assert status == 0 and "another plant" not in err
    said = " ".join(out.split())
    assert says(said, "entry gains")
    told = "every loop near this one: Re λ < 0 for every plant within 1 % of each entry"
    assert out.splitlines()[1].startswith(told)
    assert "(3 digits, however rounded)" in said
    status, out, _ = call("certify", plant, gains, "--uncertainty", "300%")
    assert status == 0 and "Re λ < 0 is not proved" in out
    assert says(out, "install fails")
    assert says(out, "warning given")
    table = " ".join(out.partition("closed loop")[2].split())
    table = table.partition("computed in floating point")[0]
    assert says(table, "loop stable") and "of each entry" in table.partition("not stable")[2]
    status, out, _ = call("certify", plant, gains, "--uncertainty", "300%", "--json")
    found = json.loads(out)
    assert status == 0 and found["certified"] and not found["every_loop"]["certified"]
    assert 0 < Fraction(found["every_loop"]["fails_within"]) < 1
    assert found["assessment"]["install"] == "no" and not faults("certify", found)


def test_where_a_rate_is_not_proved_for_every_loop_stability_is(plant: str, gains: str) -> None:
    # The nominal loop has the eigenvalue -1.16, which a hundredth may move beyond this rate.
    asked = ("--rate", "1.155", "--uncertainty", "1%")
    status, out, _ = call("certify", plant, gains, *asked)
    said = " ".join(out.split())
    assert status == 0 and "Re λ < -231/200 is not proved" in said and "neither" not in said
    assert says(said, "within entry")
    status, out, _ = call("certify", plant, gains, "--rate", "10", "--uncertainty", "1%")
    assert status == 1 and "Re λ < -10 is not proved" in out and "neither" not in out


def test_limits_on_damping_and_modulus_are_not_claimed_of_every_loop(
    plant: str, gains: str
) -> None:
    asked = ("--damping", "1/2", "--fastest", "100", "--gains", "1%", "--round-gains", "3")
    status, out, _ = call("certify", plant, gains, *asked, "--json")
    found = json.loads(out)
    assert status == 0 and found["region"] == "Re λ < 0, |λ| < 100 and damping ratio > 1/2"
    assert found["every_loop"] == {"certified": True, "region": "Re λ < 0"}
    _, out, _ = call("certify", plant, gains, *asked)
    assert "1 digit, however rounded, for Re λ < 0 alone" in " ".join(out.split())


def test_a_controller_for_the_plant_is_checked_within_radii_too(plant: str, tmp_path: Path) -> None:
    controller, folder = str(tmp_path / "controller.json"), tmp_path / "proofs"
    assert call("design", "decentralized", plant, "--rate", "1/10", "-o", controller)[0] == 0
    page = str(tmp_path / "page.html")
    to = ("--certificates", str(folder), "--html", page, "--system-by-digest")
    status, _, err = call("certify", plant, controller, "--uncertainty", "1%", *to)
    assert status == 0 and "another plant" not in err
    said = " ".join((tmp_path / "page.html").read_text("utf-8").split())
    assert says(said, "within entry")
    asked = ("--system", plant, "--controller", controller)
    status, out, _ = call("check", "--statements", "--manifest", str(folder), *asked)
    assert status == 0 and says(out, "absolute latter")
    assert says(out, "changes modulus")
    for name in ("box_stability", "stability"):
        assert call("check", "--statements", str(folder / f"{name}.json"), *asked)[0] == 0


def test_a_design_says_for_which_box_it_holds(plant: str, tmp_path: Path) -> None:
    controller, folder = str(tmp_path / "controller.json"), str(tmp_path / "proofs")
    asked = ("design", "decentralized", plant, "--rate", "1/10", "-o", controller)
    page = tmp_path / "page.html"
    status, out, _ = call(*asked, "--certificates", folder, "--html", str(page), "--json")
    found = json.loads(out)["every_loop"]
    assert status == 0 and found["certified"] and found["region"] == "Re λ < 0"
    assert 0 < Fraction(found["part"]) < Fraction(found["fails_within"]) <= 1
    assert found["gains"] == "1/100000" and not faults("design", json.loads(out))
    said = " ".join(page.read_text("utf-8").split())
    assert says(said, "loop near") and "6 digits, however rounded" in said
    assert says(said, "loop stable") and {"failing_loop.json", "manifest.json"} <= {
        path.name for path in Path(folder).iterdir()
    }
    status, out, _ = call("check", "--statements", "--manifest", folder, "--system", plant)
    assert status == 0 and says(out, "eigenvalue below")
    checks = ("check", "--manifest", folder, "--system", plant, "--controller", controller)
    status, out, _ = call(*checks, "--statements")
    assert status == 0 and says(out, "more none") and f" {found['part']} of " in out
    status, out, _ = call(*asked, "--no-box", "--json")
    assert status == 0 and "every_loop" not in json.loads(out)


@pytest.mark.slow
def test_a_design_is_certified_for_the_box_of_its_file_or_says_that_it_is_not(
    tmp_path: Path,
) -> None:
    for size, told in (("1/100", "every eigenvalue of every loop"), ("3", "is not proved for")):
        path = str(tmp_path / "typed.json")
        document = PLANT.to_dict() | {"uncertainty": {"relative": size}}
        Path(path).write_text(json.dumps(document))
        to = ("-o", str(tmp_path / "controller.json"))
        status, out, _ = call("design", "decentralized", path, "--rate", "1/10", *to)
        said = " ".join(out.split())
        assert status == 0 and (told in said or "within 1 % of each entry" in said)
        assert size == "1/100" or "of each entry" in said.partition("not stable")[2]


@pytest.mark.slow
def test_a_controller_is_made_for_the_values_of_a_plant_with_radii(tmp_path: Path) -> None:
    typed, controller = str(tmp_path / "typed.json"), str(tmp_path / "controller.json")
    Path(typed).write_text(json.dumps(PLANT.to_dict() | {"uncertainty": {"relative": "1/50"}}))
    assert call("design", "decentralized", typed, "--rate", "1/10", "-o", controller)[0] == 0
    for radii in ((), ("--uncertainty", "1%")):
        folder = str(tmp_path / f"proofs{len(radii)}")
        status, _, err = call("certify", typed, controller, *radii, "--certificates", folder)
        assert status == 0 and "another plant" not in err
        assert (
            call("check", "--statements", "--manifest", folder, "--controller", controller)[0] == 0
        )
        # The radii of the file are not those that replace them.
        assert call("check", "--statements", "--manifest", folder, "--system", typed)[0] == (
            1 if radii else 0
        )


def test_certify_says_how_many_digits_are_safe(plant: str, gains: str) -> None:
    status, out, _ = call("certify", plant, gains, "--round-gains", "3", "--json")
    found = json.loads(out)
    assert status == 0 and found["safe_digits"] == {"safe": 1, "too_few": None}
    assert not faults("certify", found)
    status, out, _ = call("certify", plant, gains, "--round-gains", "3")
    assert "1 digit, however rounded" in out
    assert "rounded gains" in out


def test_a_part_is_a_number_or_a_percentage() -> None:
    assert part("0.1%") == part("1/1000") == part("1e-3") == part("0.1 %")
    from click import BadParameter

    for text in ("-1", "x", "%", "1%%"):
        with pytest.raises(BadParameter):
            part(text)
    # A person who writes 5 means 5 %, and would read of plants within 500 %.
    with pytest.raises(BadParameter, match='write "5%" for 5 percent'):
        part("5")
    assert part("500%") == 5


def test_what_is_open_within_the_radii_is_said_first(plant: str) -> None:
    status, out, _ = call("analyze", plant, "--uncertainty", "200%")
    first, _, rest = out.partition("At the nominal values:")
    assert status == 0 and rest
    assert "radii: 7 entries are uncertain, by at most 200 %" in first
    said = " ".join(first.split())
    assert "within the radii: some plant has a fixed mode" in said
    assert says(said, "some controllable")
    assert says(said, "open setpoints")
    assert says(first, "searches fails")


def test_no_search_about_own_outputs_is_advised_where_agents_feed_back_those_of_neighbors(
    tmp_path: Path,
) -> None:
    graph = {"a": ["a", "b"], "b": ["b"]}
    heard = MultiChannelSystem(PLANT.A, PLANT.B, PLANT.C, names=["a", "b"], neighbors=graph)
    save_system(Box.relative(heard, 2).system, tmp_path / "heard.json")
    status, out, _ = call("analyze", str(tmp_path / "heard.json"), "--information", "outputs")
    assert status == 0 and says(out, "open modes")
    assert "--largest-uncertainty" not in out


def test_a_plant_that_fails_has_a_certificate(plant: str, tmp_path: Path) -> None:
    proofs, page = tmp_path / "proofs", tmp_path / "page.html"
    status, _, said = call(
        *("analyze", plant, "--uncertainty", "200%", "--certificates", str(proofs)),
        *("--html", str(page)),
    )
    assert status == 0, said
    refuted = proofs / "box_fixed_modes_refuted.json"
    status, out, _ = call("check", "--statements", str(refuted))
    assert status == 0 and out.startswith("VALID")
    certificate = json.loads(refuted.read_text("utf-8"))
    member = read_system(json.dumps({**certificate["system"], "format": "mcexact-system/1"}))
    assert Box.relative(PLANT, 2).contains(member)
    assert not fixed_spectrum(member).empty
    assert refuted.name in page.read_text("utf-8")
    status, out, _ = call("check", "--statements", "--manifest", str(proofs), "--system", plant)
    assert status == 0 and "0 not" in out


def test_a_sampled_plant_has_the_radii_of_all_members_or_those_of_rounding(tmp_path: Path) -> None:
    save_system(Box.relative(PLANT, "1/100").system, tmp_path / "box.json")
    status, out, said = call("c2d", str(tmp_path / "box.json"), "--step", "1/10", "--late", "1")
    assert status == 0 and not said
    document = json.loads(out)
    assert "applied 1 step late" in document["source"] and "radii contain" in document["source"]
    box, rng = Box(read_system(out)), random.Random(5)
    for _ in range(20):
        member = Box.relative(PLANT, "1/100").member(rng, vertex=True)
        assert box.contains(c2d(member, "1/10", 1, decimals=40))
    save_system(PLANT, tmp_path / "plant.json")
    status, out, said = call("c2d", str(tmp_path / "plant.json"), "--step", "1/10")
    assert status == 0 and "radii" not in said + out and "uncertainty" not in json.loads(out)
    status, out, said = call("c2d", str(tmp_path / "plant.json"), "--step", "1/10", "--enclose")
    assert Box(read_system(out)).contains(c2d(PLANT, "1/10", decimals=40))
