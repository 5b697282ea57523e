"""The construction ``lifted``, written out for one plant whose messages from agent 2 are late."""

from __future__ import annotations

from mcexact.checker.constructions import read_subject
from mcexact.checker.core.system import read_plant
from tests.checker.handmade import plant

LATE = read_plant(
    plant(
        [[7]],
        ([[4]], [[1]]),
        ([[5]], [[2]]),
        ([[6]], [[3]]),
        time="discrete",
        neighbors={"1": ["2", "3"], "2": [], "3": []},
        delays={"1": {"2": 2}},
    )
)
"""Agent 1 receives what agent 2 sends after 2 steps, and what agent 3 sends at once."""

STEP = {"construction": "lifted", "share": "outputs+states", "dimensions": [1, 1, 1]}


def test_messages_under_way_are_states() -> None:
    system = read_subject([STEP], LATE)
    #  x, x_1, x_2(t), x_2(t−1), x_2(t−2), y_2(t−1), y_2(t−2), x_3
    assert system.A.rows == [
        [7, 0, 0, 0, 0, 0, 0, 0],
        [0, 0, 0, 0, 0, 0, 0, 0],
        [0, 0, 0, 0, 0, 0, 0, 0],
        [0, 0, 1, 0, 0, 0, 0, 0],
        [0, 0, 0, 1, 0, 0, 0, 0],
        [2, 0, 0, 0, 0, 0, 0, 0],
        [0, 0, 0, 0, 0, 1, 0, 0],
        [0, 0, 0, 0, 0, 0, 0, 0],
    ]


def test_outputs_without_delay_come_first_and_states_in_the_order_of_the_agents() -> None:
    system = read_subject([STEP], LATE)
    assert system.C[0].rows == [
        [1, 0, 0, 0, 0, 0, 0, 0],
        [3, 0, 0, 0, 0, 0, 0, 0],
        [0, 0, 0, 0, 0, 0, 1, 0],
        [0, 1, 0, 0, 0, 0, 0, 0],
        [0, 0, 0, 0, 1, 0, 0, 0],
        [0, 0, 0, 0, 0, 0, 0, 1],
    ]
    assert system.C[1].rows == [[2, 0, 0, 0, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0, 0, 0]]
    assert system.B[1].rows == [[5, 0], [0, 0], [0, 1], *([[0, 0]] * 5)]
