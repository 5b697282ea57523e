"""Results as tables of pandas."""

import sys
from fractions import Fraction

import pandas
import pytest

import mcexact
from mcexact.errors import InputError, MissingExtra
from mcexact.model import gallery

PLANT = gallery.load("hidden-triple-mode")


def test_the_answers_of_an_analysis_are_rows() -> None:
    table = mcexact.to_pandas(mcexact.analyze(PLANT, ["fixed_spectrum", "completeness"]))
    assert list(table["question"]) == ["fixed_spectrum", "completeness"]
    assert table["polynomial"].tolist()[0] == "x - 1"
    assert table["complete"].dropna().tolist() == [False]


def test_answers_about_many_systems_are_rows() -> None:
    found = [mcexact.fixed_spectrum(gallery.load(name)) for name in gallery.names()[:3]]
    table = mcexact.to_pandas(found)
    assert len(table) == 3 and set(table["kind"]) == {"fixed_spectrum"}
    assert table["stabilizable"].dtype == bool
    assert table.equals(pandas.DataFrame([each.to_row() for each in found]))
    assert len(mcexact.to_pandas(found[0])) == 1


def test_the_records_of_a_sweep_are_rows() -> None:
    table = mcexact.to_pandas(
        mcexact.sweep([mcexact.constructions.Draw(seed) for seed in range(3)])
    )
    assert table["n"].tolist() == [4, 4, 4]
    assert table["fixed_spectrum.stabilizable"].dtype == bool
    assert table["error"].isna().all()


def test_times_of_a_trajectory_are_floats_and_rows_with_exact_numbers() -> None:
    plant = mcexact.MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    controller = mcexact.designs.local_controllers(plant, [[["-3/2"]]])
    table = mcexact.to_pandas(mcexact.simulate(plant, controller, horizon=2))
    assert table["x[1]"].tolist() == [1, Fraction(1, 2), Fraction(1, 4)]
    assert table["t"].dtype == float and table["t"].tolist() == [0, 1, 2]


@pytest.mark.parametrize("wrong", [PLANT, [PLANT], "records.jsonl", 3])
def test_what_has_no_rows_is_refused(wrong: object) -> None:
    with pytest.raises(InputError, match=r"^results: expected an analysis, a trajectory, answers"):
        mcexact.to_pandas(wrong)


def test_a_missing_library_is_named_with_the_line_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingExtra, match=r"pip install 'mcexact\[pandas\]'"):
        mcexact.to_pandas([])
