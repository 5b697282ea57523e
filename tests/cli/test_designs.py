"""What the design commands and `certify` show besides what is certified."""

import json
import re
import time
from fractions import Fraction
from html import unescape
from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.kinds import check_document
from mcexact.cli import designs
from mcexact.cli.loops import limited_controller
from mcexact.cli.options import AIMS
from mcexact.cli.results import DESIGNED, Loop, Refused
from mcexact.cli.running import Reporting
from mcexact.model import gallery
from mcexact.model.files import save_system
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from mcexact.synthesis.design import Design
from tests.answer.written import with_graph
from tests.cli.calling import call
from tests.end_to_end.command_line import run
from tests.report.strict_html import Page, external_addresses
from tests.wording import says, worded


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A double integrator, of which the position is measured."""
    path = tmp_path_factory.mktemp("designs") / "plant.json"
    save_system(MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]]), path)
    return str(path)


def test_a_file_is_enough_and_the_first_line_says_whether_to_install(
    plant: str, tmp_path: Path
) -> None:
    controller, page = tmp_path / "controller.json", tmp_path / "page.html"
    done = run("design", "decentralized", plant, "-o", str(controller), "--html", str(page))
    assert done.status == 0, done.stderr
    first, *said = done.stdout.partition("\n\n")[0].splitlines()
    assert first.startswith("Proved: cost ≤ ") and first.endswith(". Worth installing")
    rate = re.compile(
        r"note: no rate was given: a search minimized the cost, at a rate of at least .*"
    )
    assert any(rate.fullmatch(line) for line in said)
    assert done.stdout.count("not certified") == 1
    assert "numbers sent" in done.stdout and "sensible rate" in done.stdout
    shown = page.read_text(encoding="utf-8")
    Page(shown)
    assert not external_addresses(shown)
    assert first in unescape(shown) and shown.count("<figure") == 8
    told = run("certify", plant, str(controller), "--rate", "1/100")
    assert told.status == 0
    assert told.stdout.splitlines()[0].startswith("Proved: cost ≤ ")
    fast = run("certify", plant, str(controller), "--rate", "1000")
    assert fast.status == 1
    assert worded(fast.stdout.splitlines()[0])


def test_rounded_gains_are_certified_and_written(plant: str, tmp_path: Path) -> None:
    controller, rounded = tmp_path / "controller.json", tmp_path / "rounded.json"
    run("design", "decentralized", plant, "--rate", "1/2", "--effort", "0", "-o", str(controller))
    done = run(
        "certify", plant, str(controller), "--round-gains", "3", "-o", str(rounded), "--json"
    )
    told = json.loads(done.stdout)
    assert told["rounded_to_digits"] == 3
    assert worded(told["assessment"]["notes"])
    again = json.loads(run("certify", plant, str(rounded), "--json").stdout)
    assert again["stability"] == told["stability"] and again["rounded_to_digits"] is None
    assert run("certify", plant, str(controller), "-o", str(rounded)).status == 2


def test_few_digits_can_lose_stability(plant: str, tmp_path: Path) -> None:
    controller = tmp_path / "controller.json"
    run("design", "decentralized", plant, "--rate", "20", "--effort", "0", "-o", str(controller))
    assert run("certify", plant, str(controller), "--rate", "20").status == 0
    done = run("certify", plant, str(controller), "--rate", "20", "--round-gains", "1")
    assert done.status == 1
    assert "rounded to 16 digits" not in done.stdout


def test_without_an_output_the_verdict_is_on_standard_error(plant: str) -> None:
    done = run("design", "decentralized", plant, "--rate", "1/2")
    assert json.loads(done.stdout)["format"].startswith("mcexact-controller/")
    assert done.messages[0].startswith("mcexact: Proved: cost ≤ ")


def test_a_controller_that_no_command_would_read_is_not_written(tmp_path: Path) -> None:
    controller, folder = tmp_path / "controller.json", tmp_path / "certificates"
    plant = str(tmp_path / "plant.json")
    save_system(with_graph(gallery.load("quadruple-tank-pminus")), plant)
    ask = ("design", "observer", plant, "--rate", "1/100", "--arithmetic", "exact")
    files = ("-o", str(controller), "--certificates", str(folder))
    refused = run(*ask, *files, "--max-digits", "20")
    assert refused.status == 4
    digits = re.search(r"of about ([0-9]+) digits", refused.stderr)
    assert digits is not None and int(digits[1]) > 20
    assert f"(--max-digits {int(digits[1]) + 1})" in refused.stderr
    assert "--arithmetic float" in refused.stderr
    assert not controller.exists() and not folder.exists()


def test_json_has_the_figures_apart_from_what_is_certified(plant: str, tmp_path: Path) -> None:
    weights = tmp_path / "weights.json"
    weights.write_text('{"R": [["1/100"]]}', encoding="utf-8")
    options = ("--rate", "1/2", "--weights", str(weights), "--digits", "2", "--max-order", "1")
    done = run("design", "decentralized", plant, *options, "--json")
    told = json.loads(done.stdout)
    figures = told["assessment"]
    assert worded(figures["basis"])
    assert figures["install"] == "yes" and figures["margin"] >= 0.3
    assert figures["states_of_each_agent"] == {"1": 1} and figures["digits_that_suffice"] <= 2
    assert figures["verdict"] not in [each["text"] for each in told["sentences"]]
    assert told["stability"]["stable"] is True


def test_the_theorem_is_asked_for_by_no_effort(plant: str) -> None:
    done = run("design", "decentralized", plant, "--rate", "20", "--effort", "0", "--json")
    told = json.loads(done.stdout)
    assert told["blocks"] and told["assessment"]["install"] == "with care"
    assert told["assessment"]["performance"]["proved"]


def test_a_refusal_names_the_channels_and_the_command_that_goes_on(tmp_path: Path) -> None:
    done = run("design", "decentralized", "gallery:liu2020-3ch-no-communication")
    assert done.status == 1
    why = "which channel 1 does not control and channels 2 and 3 do not observe"
    assert why in done.messages[-1] and "`mcexact allocate gallery:" in done.messages[-1]
    path = tmp_path / "unseen.json"
    for row, told in (([[[1], [1]]], "observe"), ([[[0], [0]]], "control")):
        C = [[[0, 0]]] if told == "observe" else [[[1, 1]]]
        save_system(MultiChannelSystem([[1, 0], [0, 2]], row, C), path)
        [line] = run("design", "decentralized", str(path)).messages
        # No link helps where all channels together do not move the mode.
        assert says(line, told) and "allocate" not in line


def test_what_is_out_of_reach_ends_with_the_diagnosis(tmp_path: Path) -> None:
    path = tmp_path / "plant.json"
    save_system(MultiChannelSystem([[1, 0], [0, -1]], [[[1], ["1e-7"]]], [[[1, 1]]]), path)
    done = run("design", "decentralized", str(path), "--rate", "2")
    assert done.status == 4
    [line] = done.messages
    assert "out of reach" in line and "mode -1: a relative change of" in line
    assert "sensible rate" in line


def test_what_is_hard_is_said_before_the_search_ends(tmp_path: Path) -> None:
    path = tmp_path / "plant.json"
    save_system(MultiChannelSystem([[1, 0], [0, -1]], [[[1], ["1e-7"]]], [[[1, 1]]]), path)
    asked = ("design", "decentralized", str(path), "--rate", "2", "--effort", "1", "--json")
    done = run(*asked)
    assert done.status in (0, 4)
    assert says(done.messages[0], "hard together")


@pytest.mark.parametrize(
    ("content", "status", "message"),
    [
        ("[1]", 3, "expected an object"),
        ('{"Z": [[1]]}', 3, "weights.Z: expected one of Q, R, W, V"),
        ('{"Q": [[1]]}', 3, "weights.Q: expected a 2 × 2 matrix, found 1 × 1"),
    ],
)
def test_bad_weights_are_named(
    plant: str, tmp_path: Path, content: str, status: int, message: str
) -> None:
    weights = tmp_path / "weights.json"
    weights.write_text(content, encoding="utf-8")
    done = run("design", "decentralized", plant, "--rate", "1", "--weights", str(weights))
    assert done.status == status
    assert message in done.stderr and "weights.json" in done.stderr


def test_help_is_in_groups_and_hides_the_limits_on_files() -> None:
    short, whole = (run("design", "extended", option).stdout for option in ("--help", "--help-all"))
    headings = [line for line in whole.splitlines() if re.fullmatch(r"[A-Z][\w ]+:", line)]
    assert worded(headings)
    assert "Reading:" not in short and "--max-depth" not in short
    assert "--max-depth" in whole and "--max-order" in short


def test_radii_are_asked_of_the_loop() -> None:
    asked = run("certify", "--help").stdout.partition("Limits and help:")[0]
    assert "--uncertainty PART" in asked and "--gains PART" in asked


@pytest.mark.parametrize(
    ("neighbors", "advised"),
    [
        ({}, "mcexact allocate {} --links"),
        ({"neighbors": {"b": ["a"]}}, "mcexact allocate {} --links"),
        ({"neighbors": {"a": ["b"]}}, "mcexact design extended {} --rate 1/10"),
    ],
)
def test_a_link_that_the_plant_has_is_used_and_not_advised(
    neighbors: dict[str, object], advised: str, tmp_path: Path
) -> None:
    path = tmp_path / "plant.json"
    document = {
        "format": "mcexact-system/1",
        "time": "continuous",
        "A": [[-1, 0], [1, 0]],
        "channels": [
            {"name": "a", "B": [[1], [0]], "C": [[1, 0]]},
            {"name": "b", "B": [[0], [0]], "C": [[0, 1]]},
        ],
    }
    path.write_text(json.dumps({**document, **neighbors}), encoding="utf-8")
    assert run("design", "decentralized", str(path), "--step", "1/2").status == 1
    done = run("design", "decentralized", str(path), "--rate", "1/10")
    assert done.status == 1 and f"`{advised.format(path)}`" in done.stderr


@pytest.mark.parametrize(
    ("neighbors", "advised"),
    [
        (None, "`mcexact allocate sampled.json --links`"),
        ({"a": ["b"]}, "`mcexact design extended plant.json --step 1/10 --late 1`"),
    ],
)
def test_a_design_at_the_samples_is_advised_with_the_same_samples(
    neighbors: dict[str, list[str]] | None, advised: str
) -> None:
    A, B, C = [[-1, 0], [1, 0]], [[[1], [0]], [[0], [0]]], [[[1, 0]], [[0, 1]]]
    plant = MultiChannelSystem(A, B, C, names=["a", "b"], neighbors=neighbors)
    sampling = {"step": Fraction(1, 10), "late": 1}
    refused = designed(system_text(plant).encode(), sampling, None, list[Any]())
    assert isinstance(refused, Refused) and advised in refused.advice
    written = "which `mcexact c2d plant.json --step 1/10 --late 1 -o sampled.json` writes"
    assert (written in refused.advice) is (neighbors is None)


def test_the_rest_of_a_sampled_plant_is_advised_as_a_file_of_its_samples() -> None:
    plant = gallery.load("relative-positions-4")
    sampling = {"step": Fraction(1, 10), "late": 0}
    refused = designed(system_text(plant).encode(), sampling, None, list[Any]())
    assert isinstance(refused, Refused)
    assert "`mcexact c2d plant.json --step 1/10 -o sampled.json` writes" in refused.advice
    assert says(refused.advice, "sampled unobservable")


def test_the_proofs_of_the_longest_step_are_shown_and_checked_with_the_others() -> None:
    integrator = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    made, handed = at_samples(integrator, 600.0)
    names = {f"longest_step_{side}_margin.json" for side in ("input", "output")}
    assert names < made.evidence.files.keys() and names < made.evidence.certificates.keys()
    for name in names:
        assert check_document(made.evidence.files[name].encode("ascii")).verdict == "VALID"
    manifest = json.loads(made.evidence.files["manifest.json"])
    assert names < manifest["certificates"].keys()
    [sentence] = [s for s in manifest["sentences"] if s["rule"] == "performance-another-step"]
    assert names < {name for name, *_ in sentence["because"]}
    (row,) = [t.rows for t in made.tables if t.title == "other times between samples"]
    assert row[0][0] == "longest step" and made.document["longest_step"]["step"]
    assert all("longest step" not in str(t) for t in made.tables if "not certified" in t.title)
    # what is handed over last before the search of the step has the box
    assert "box_stability.json" in handed[-1].evidence.files
    assert says(handed[-1].verdict, "longest samples")


def test_a_controller_in_continuous_time_has_its_longest_step_too() -> None:
    integrator = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    made, handed = parts_of(system_text(integrator).encode(), {}, 600.0)
    names = {f"longest_step_{side}_margin.json" for side in ("input", "output")}
    manifest = json.loads(made.evidence.files["manifest.json"])
    assert names < manifest["certificates"].keys()
    [sentence] = [s for s in manifest["sentences"] if s["rule"] == "performance-at-samples"]
    assert {*names, "stability.json"} >= {name for name, *_ in sentence["because"]} >= names
    (row,) = [t.rows for t in made.tables if t.title == "the controller at samples"]
    assert row[0][0] == "longest step" and made.document["longest_step"]["proved"]
    assert "box_stability.json" in handed[-1].evidence.files


def test_limits_are_written_where_nothing_is_proved_of_them() -> None:
    integrator = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    controller = local_controllers(integrator, [[[-1]]])
    limits = ((((Fraction(-1), Fraction(1)),)),)
    (agent,) = limited_controller(controller, limits, None).agents
    assert agent.limits == limits[0] and agent.back_calculation is None
    own = controller.with_saturation((((Fraction(-2), Fraction(2)),),))
    assert limited_controller(own, limits, None) == own
    assert limited_controller(controller, None, None) == controller


def test_a_box_and_disk_margins_are_aims_of_a_search(plant: str) -> None:
    done = run("design", "decentralized", plant, "--box", "10%", "--disk", "0.8", "--json")
    assert done.status == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["every_loop"]["certified"]
    refused = run("design", "decentralized", plant, "--disk", "3")
    assert refused.status == 2 and "disk: expected a number above 0 and below 2" in refused.stderr


def test_a_box_that_is_asked_for_and_not_proved_is_told(plant: str) -> None:
    sampled = ("--step", "1/10", "--late", "1")
    done = run("design", "decentralized", plant, *sampled, "--box", "90%", "--json")
    assert done.status == 0, done.stderr
    told = json.loads(done.stdout)
    proved = Fraction(told["every_loop"]["part"])
    [note] = [each for each in told["assessment"]["notes"] if "--box asked for" in each]
    assert proved < Fraction(9, 10) and note.startswith("--box asked for 90 % of each entry")


def handed_over(plant: str, left: float | None) -> tuple[Loop, list[Loop]]:
    """The design for a plant, and what is handed over before it is complete."""
    return parts_of(Path(plant).read_bytes(), {}, left)


def at_samples(system: MultiChannelSystem, left: float) -> tuple[Loop, list[Loop]]:
    """The same for a plant that is sampled."""
    return parts_of(system_text(system).encode(), {"step": Fraction(1, 10), "late": 0}, left)


def parts_of(
    content: bytes, sampling: dict[str, Any], left: float | None
) -> tuple[Loop, list[Loop]]:
    """The design for the content of a file, and what is handed over before it is complete."""
    sent = list[Any]()
    made = designed(content, sampling, left, sent)
    assert isinstance(made, Loop)
    return made, [each.value for each in sent if getattr(each, "name", "") == DESIGNED]


def designed(
    content: bytes, sampling: dict[str, Any], left: float | None, sent: list[Any]
) -> Loop | Refused:
    """Design for the content of a file, in this process."""
    options: dict[str, object] = dict.fromkeys(AIMS)
    options |= {"margin": 0.3, "disk": 0.4, "seeds": 4, "seconds": left}
    return designs.designed(
        "decentralized", ("plant.json", content), None, None, None, (), {}, sampling, None,
        {"rate": None, "radius": None, "arithmetic": "exact", "agent": None}, options,
        with_box=True, with_page=False, prove_all=False, system_by_digest=False, left=left,
        tell=print, report=Reporting(sent.append),
    )  # fmt: skip


def test_with_a_time_limit_a_design_is_handed_over_before_each_further_proof(plant: str) -> None:
    made, (at_once, certified, with_margins, with_box) = handed_over(plant, 600.0)
    steps = (at_once, certified, with_margins, with_box, made)
    proved = [set(each.evidence.certificates) for each in steps]
    assert proved[0] == proved[1] < proved[2] < proved[3] < proved[4]
    told = ["\n".join(each.verdict) for each in steps]
    assert ["time limit" in each for each in told] == [True, True, True, True, False]
    care = "Install with care: the time limit left no time to compute its margins"
    assert at_once.verdict[0].startswith(care)
    assert certified.verdict[0].startswith("Worth installing")
    assert handed_over(plant, None)[1] == []


def test_a_search_whose_time_is_over_gives_the_best_so_far(plant: str) -> None:
    made, _ = handed_over(plant, 1e-9)
    assert says(made.verdict, "best far")
    assert "stability.json" in made.evidence.certificates
    assert says(made.tables, "limit left")
    assert says(made.tables, "ended search")


def test_what_is_certified_when_the_time_limit_comes_is_the_result(
    plant: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Design, "every_loop", lambda *_, **__: time.sleep(600))
    controller = tmp_path / "controller.json"
    status, out, err = call(
        "design", "decentralized", plant, "--timeout", "20", "-o", str(controller)
    )
    assert status == 0, err
    assert says(out, "note search")
    assert out.startswith("Proved: cost ≤ ")
    assert "VALID" in out and run("certify", plant, str(controller)).status == 0


def test_a_time_limit_before_anything_is_certified_is_one(
    plant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(designs, "assessed_by_search", lambda *_, **__: time.sleep(600))
    status, _, err = call("design", "decentralized", plant, "--timeout", "3")
    assert status == 4 and says(err, "nothing been")


def test_a_certified_controller_is_the_result_before_its_figures_are_computed(
    plant: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(designs, "assess", lambda *_, **__: time.sleep(600))
    controller = tmp_path / "controller.json"
    status, out, err = call(
        "design", "decentralized", plant, "--timeout", "12", "-o", str(controller)
    )
    assert status == 0, err
    assert says(out, "care compute")
    assert "VALID" in out and run("certify", plant, str(controller)).status == 0
