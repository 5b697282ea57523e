"""B and C as attributes: by position, by name, and called."""

import pickle

import pytest

from mcexact import MultiChannelSystem
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.shown import LINE

PLANT = MultiChannelSystem(
    [[1, 0], [0, 2]],
    [[[1], [0]], [[0, 1], [1, 0]]],
    [[[1, 0]], [[0, 1]]],
    names=["pump", "valve"],
)


@pytest.mark.parametrize("i", [0, 1])
def test_position_name_call_and_channel_give_the_same_matrix(i):
    name, channel = PLANT.names[i], PLANT.channels[i]
    assert PLANT.B[i] is PLANT.B[name] is PLANT.B(i) is PLANT.B(name) is channel.B
    assert PLANT.C[i] is PLANT.C[name] is PLANT.C(i) is channel.C


def test_they_are_sequences():
    assert len(PLANT.B) == 2 and list(PLANT.B) == [PLANT.B[0], PLANT.B[1]]
    assert PLANT.B[-1] == PLANT.B[1] and PLANT.B[:1] == (PLANT.B[0],)
    assert [M.shape for M in PLANT.C] == [(1, 2), (1, 2)]
    with pytest.raises(IndexError):
        PLANT.B[2]  # type: ignore[misc]


def test_an_unknown_name_is_named_with_the_nearest():
    with pytest.raises(UsageError, match=r"no channel 'pumb' .did you mean 'pump'"):
        PLANT.B["pumb"]


def test_a_system_is_made_again_of_its_own_matrices():
    again = MultiChannelSystem(PLANT.A, PLANT.B, PLANT.C, names=PLANT.names)
    assert again == PLANT
    assert pickle.loads(pickle.dumps(PLANT)).B["valve"] == PLANT.B[1]


def test_one_matrix_in_place_of_a_list_is_refused():
    with pytest.raises(InputError, match=r"^B: expected a list.*found one matrix: write \[B\]"):
        MultiChannelSystem(PLANT.A, PLANT.B[0], PLANT.C)  # type: ignore[arg-type]


def test_they_are_shown_whole_or_by_their_sizes():
    assert repr(PLANT.C) == "(Matrix.from_rows([[1, 0]]), Matrix.from_rows([[0, 1]]))"
    wide = MultiChannelSystem([[0]], [Matrix.zeros(1, 1)] * 60, [Matrix.identity(1)] * 60)
    assert repr(wide.B) == f"<matrices of 60 channels: {', '.join(['1 × 1'] * 8)}, …>"
    assert len(repr(wide.B)) <= LINE
    assert "<td>valve</td>" in PLANT.B._repr_html_()
