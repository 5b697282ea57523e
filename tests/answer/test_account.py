"""The JSON of an account has the names of the questions, and plain exact values."""

import hashlib
import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, NeighborGraph, analyze, check, load_certificate
from mcexact.analysis.questions import QUESTIONS, Question
from mcexact.answer.account import SHORT, Account
from mcexact.answer.sentence import PLANT
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation
from mcexact.errors import InputError, LimitReached
from mcexact.model import gallery
from tests.answer.asking import asked
from tests.report.test_account import EXAMPLE
from tests.wording import says, worded


def view_of(system: MultiChannelSystem, **question: Any) -> dict[str, Any]:
    view = asked(system, **question).to_dict()
    assert json.loads(json.dumps(view)) == view
    return view


def test_every_answer_stands_under_its_name_and_names_its_certificate() -> None:
    view = view_of(MultiChannelSystem(**EXAMPLE))
    assert view["format"] == "mcexact-analysis/1"
    assert view["system"].items() >= {"n": 3, "m": 3, "time": "continuous"}.items()
    plain = {name for name, question in QUESTIONS.items() if question.by_default}
    plain = {name for name in plain if not QUESTIONS[name].needs}
    plain |= {"quotient_fixed_spectrum", "structural_fixed_modes", "minimal_communication"}
    assert plain == view.keys() & QUESTIONS.keys()
    for name in plain:
        assert view[name]["certificate"] == f"{name}.json"
    assert view["fixed_spectrum"]["stabilizable"] is False
    assert view["joint_controllability"]["controllable"] is True
    assert says(view["answer"][0], "cannot stabilized")
    assert {"text", "rule", "theorem"} == view["sentences"][0].keys()


def test_polynomials_are_lists_of_numbers_and_channels_are_names() -> None:
    plant = MultiChannelSystem(
        [["1/3", 0], [0, 2]], [[[1], [0]]] * 2, [[[1, 0]]] * 2, names=["left", "right"]
    )
    spectrum = view_of(plant)["fixed_spectrum"]
    assert spectrum["polynomial"] == [-2, 1]
    (factor,) = spectrum["factors"]
    assert factor["channels"] == ["left", "right"]
    assert factor["roots"] == [{"re": "2", "im": "0", "radius": "0"}]
    assert view_of(plant)["transfer_graph"]["arcs"][1] == ["left", "right"]


def test_with_neighbors_sharing_is_answered_and_least_sharing_only_when_asked() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    heard = plant.with_neighbors(NeighborGraph.ring(plant.names))
    view = view_of(heard)
    assert view["neighbor_graph"]["strongly_connected"] is True
    assert view["shared_dimension_bound_outputs_states"]["deficiency"] == 1
    assert "minimal_shared_dimensions_states" not in view
    least = view_of(heard, minimal=True)
    assert least["minimal_shared_dimensions_outputs_states"]["dimensions"] == [0, 0, 1]
    assert sum(least["minimal_shared_dimensions_states"]["dimensions"]) == 2


def test_the_bounds_that_a_limit_leaves_are_numbers_of_json(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def ended(self: Question, *arguments: Any, **keywords: Any) -> Any:
        raise LimitReached("a limit", lower=Fraction(2), upper=Fraction(7, 2))

    monkeypatch.setattr(Question, "decide", ended)
    view = analyze(MultiChannelSystem(**EXAMPLE), ["minimal_communication"]).to_dict()
    bounds = {"lower": 2, "upper": "7/2"}
    assert view["minimal_communication"] == {"decided": False, "computed_not_certified": bounds}
    [told] = [each["text"] for each in view["sentences"] if each["rule"] == "table-links-limit"]
    assert worded(told)


def test_a_subset_and_a_channel_are_answered_when_they_are_asked_about() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    view = view_of(plant, subset=["2", "3"], channel="1", every_channel=True)
    subsystem = view["complementary_subsystem"]
    assert subsystem["normal_rank"] == 3
    assert subsystem["remnant"] == [-1, 1]
    assert view["channel_observability"]["observable"] is True
    assert view["channel_gains_observable"]["indices"] == [[2]]
    assert view["channel_gains_both"]["exists"] is False
    assert view["every_channel"]["exists"] is False
    assert view["pencil_rank_1"]["rank"] == 2
    assert "complementary_subsystem" not in view_of(plant, subset=[])


def test_the_spectrum_is_split_over_the_components() -> None:
    inactive = MultiChannelSystem([[0]], [[[1]], [[0]]], [[[1]], [[1]]])
    view = view_of(inactive)
    assert view["assignability"]["blocks"][1] == {"channels": ["2"], "dimension": 0}
    assert view["completeness"]["complete"] is False


def test_a_notebook_shows_the_sentences_with_their_reasons() -> None:
    plant = MultiChannelSystem(**EXAMPLE, name="<b>")
    html = analyze(plant)._repr_html_()
    assert "cannot be stabilized" in html and "fixed_spectrum.json#/claim/stabilizable" in html
    assert "<th>fixed modes</th><td>the mode 1</td>" in html
    hostile = gallery.load("hidden-triple-mode")
    assert "<script" not in analyze(hostile)._repr_html_()


def test_a_long_plant_stands_once_beside_the_certificates_that_name_it(tmp_path: Path) -> None:
    plant = long_plant(44)
    analysis = analyze(plant)
    analysis.save(tmp_path)
    (beside,) = tmp_path.glob("*.plant")
    assert beside.name == f"{plant.digest()}.plant"
    assert hashlib.sha256(beside.read_bytes()).hexdigest() == plant.digest()
    assert [v.status for _, v in manifest_verdicts(str(tmp_path), Expectation(), Limits())] == (
        [0] * (len(analysis.account.files()) - 2 + len(analysis.account.derived))
    )
    found = load_certificate(tmp_path / "fixed_spectrum.json")
    assert found == analysis.fixed_spectrum
    assert check(tmp_path / "fixed_spectrum.json", timeout=60).valid
    beside.unlink()
    assert check(tmp_path / "fixed_spectrum.json").code == "system"
    with pytest.raises(InputError, match="system"):
        load_certificate(tmp_path / "fixed_spectrum.json")
    assert load_certificate(tmp_path / "fixed_spectrum.json", plant) == found


@pytest.mark.parametrize("by_digest", [False, True])
def test_a_plant_has_a_file_if_it_is_long_and_named_twice(by_digest: bool) -> None:
    long, short = (analyze(long_plant(n)).account for n in (44, 3))
    lengths = [len(each.given.system.canonical_text()) for each in (long, short)]
    assert lengths[0] > SHORT >= lengths[1]

    def plants(account: Account) -> list[str]:
        files = account.files(system_by_digest=by_digest)
        return [name for name in files if name.endswith(PLANT)]

    assert len(plants(long)) == (not by_digest)
    one = {name: answer for name, answer in long.answers.items() if name == "fixed_spectrum"}
    assert plants(short) == plants(replace(long, answers=one)) == []


def long_plant(n: int) -> MultiChannelSystem:
    """A dense plant with one channel."""
    rows = [[(i * i + 3 * j) % 17 - 8 for j in range(n)] for i in range(n)]
    return MultiChannelSystem(rows, [[[1]] * n], [[[1, *[0] * (n - 1)]]])
