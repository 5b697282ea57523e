"""A controller is read with the sizes of a system only if its agents are the channels of that."""

from __future__ import annotations

import pytest

from tests.checker.handmade import Document, changed, checked
from tests.checker.test_closed_loop_spectrum import LOOP

IDLE: Document = {
    "shared": 0,
    "private": 0,
    "shared_update": {},
    "private_update": {},
    "input": {},
}
AGENTS = "subject.0.controller.agents"


@pytest.mark.parametrize(
    ("channel", "agents"),
    [("2", ["1", "2"]), ("1", ["1", "2"]), ("2", ["1"]), ("1", ["2"]), ("3", ["1", "2", "3"])],
)
def test_other_agents_than_the_channels_are_no_controller_of_the_plant(
    channel: str, agents: list[str]
) -> None:
    """Channels may be fewer than agents, with names before or after theirs."""
    document = changed(
        LOOP,
        ("system.channels.0.name", channel),
        ("system.neighbors", {channel: []}),
        (AGENTS, [{"name": name, **IDLE} for name in agents]),
    )
    verdict = checked(document)
    assert (verdict.verdict, verdict.code) == ("INVALID", "subject"), verdict.line()
