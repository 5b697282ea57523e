"""The table of verdicts, on systems where everything is known."""

import pytest

import mcexact
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.crosschecks.table import crosscheck
from mcexact.floating import verdicts
from mcexact.model.system import MultiChannelSystem
from tests.synthesis.three_channels import three_channels
from tests.wording import worded

PLAIN = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])


def test_floating_point_is_right_about_a_double_integrator():
    found = crosscheck(PLAIN)
    assert not found.disagreements
    answers = {row.question: row.exact for row in found.rows}
    assert answers["joint controllability"] == "yes, rank 2 of 2"
    assert answers["controllability index"] == "2"
    assert answers["any fixed mode, pencils"] == "no"
    assert answers["completeness"] == "yes"
    assert answers["stability of A"] == "no"


def test_every_call_is_quoted():
    quoted = "numpy.", "control.", "scipy.", "networkx."
    for row in crosscheck(three_channels()).rows:
        assert any(name in row.call for name in quoted), row.call


def test_a_fixed_mode_is_at_distance_zero():
    near = crosscheck(three_channels()).nearest
    assert near is not None and near.distance == 0 and not fixed_spectrum(near.plant).empty


def test_a_plant_nearby_has_a_fixed_mode():
    found = crosscheck(PLAIN)
    assert found.nearest is not None and 0 < found.nearest.distance <= 1
    assert not fixed_spectrum(found.nearest.plant).empty


def test_no_states_have_answers_too():
    found = crosscheck(MultiChannelSystem([], [[]], [[]]))
    assert found.nearest is None
    assert all(row.agree is not False for row in found.rows if row.question != "stability of A")


def test_a_library_that_is_missing_gives_no_answer(monkeypatch):
    def missing(*_):
        raise ModuleNotFoundError("No module named 'control'", name="control")

    monkeypatch.setattr(verdicts, "control_rank", missing)
    [row] = [row for row in crosscheck(PLAIN).rows if row.question == "joint controllability"]
    assert row.agree is None and worded(row.floating)


def test_a_library_that_cannot_be_loaded_is_not_called_missing(monkeypatch):
    def unmapped(*_):
        raise ImportError("failed to map segment from shared object", name="control")

    monkeypatch.setattr(verdicts, "control_rank", unmapped)
    with pytest.raises(ImportError, match="failed to map"):
        crosscheck(PLAIN)


def test_numbers_beyond_doubles_are_no_error():
    found = crosscheck(MultiChannelSystem([[10**400]], [[[1]]], [[[1]]]))
    assert any(row.agree is None for row in found.rows)


def test_the_package_is_called_by_the_name_that_it_exports():
    assert len(mcexact.crosscheck(PLAIN).rows) == len(crosscheck(PLAIN).rows)


def test_floating_point_is_not_wrong_where_rounding_errors_explain_the_difference() -> None:
    # The sum of both states is not controlled but for a rounding error.
    plant = MultiChannelSystem(
        [["-0.30000000000000004", "0.7"], ["0.3", "-0.7"]],
        [[["0.1"], ["-0.1"]]],
        [[["1", 0]]],
    )
    found = crosscheck(plant)
    judged = {row.question: row for row in found.rows}
    row = judged["joint controllability, Hautus"]
    assert (row.exact, row.agree) != ("yes", False) or row.within_data
    assert found.nearby is not None and found.nearby.leading
    assert all(row.agree is False for row in found.within_data)
    assert not {*found.within_data} & {*found.disagreements}


def test_an_input_that_is_not_zero_is_no_rounding_error() -> None:
    plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], ["1e-20"]]], [[[1, 1]]])
    found = crosscheck(plant)
    assert found.disagreements and found.within_data == ()
