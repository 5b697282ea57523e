"""Some channels alone: the matrices, the fixed modes, and what is refused."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import fixed_spectrum, testing
from mcexact.constructions import restricted
from mcexact.errors import UsageError
from mcexact.model.system import MultiChannelSystem
from tests.oracle import enumeration

THREE = MultiChannelSystem(
    [[0]], [[[1]], [[2]], [[3]]], [[[4]], [[5]], [[6]]], names=["a", "b", "c"], neighbors={}
)


@given(testing.systems(max_states=3, max_channels=3), st.data())
def test_fewer_channels_never_move_more(drawn: Any, data: st.DataObject) -> None:
    system = drawn.system
    chosen = data.draw(st.lists(st.sampled_from(system.names), min_size=1, unique=True))
    made = restricted(system, chosen)
    assert fixed_spectrum(system).polynomial.divides(fixed_spectrum(made).polynomial)
    places = [i for i, name in enumerate(system.names) if name in chosen]
    numbers, plain = enumeration.plain(system), enumeration.plain(made)
    assert plain.A == numbers.A
    assert [plain.B, plain.C] == [[M[i] for i in places] for M in (numbers.B, numbers.C)]


def test_channels_keep_their_order_and_lose_the_graph() -> None:
    made = restricted(THREE, ["c", "a", "c"])
    assert (made.names, made.neighbors, made.plant) == (("a", "c"), None, THREE)
    assert made.subject == ({"construction": "restricted", "channels": ["a", "c"]},)
    with pytest.raises(UsageError, match="made by 'restricted'"):
        made.with_neighbors({"a": ["c"]})


@pytest.mark.parametrize(("channels", "message"), [([], "at least one"), (["d"], "'d'")])
def test_no_channel_and_unknown_channels_are_refused(channels: list[str], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        restricted(THREE, channels)
