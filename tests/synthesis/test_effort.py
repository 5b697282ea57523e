"""What a design does once: it assembles the loop of a proposal, and decides its stability."""

from __future__ import annotations

import cProfile
import pstats
from typing import Any

import pytest

from mcexact.model import loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.optimum.figures import THEOREM
from mcexact.synthesis.setpoint import design_setpoint


def chain_of_three() -> MultiChannelSystem:
    """Three agents in a row, each with a state of its own, coupled with the next ones."""
    unit = [[int(i == j) for j in range(3)] for i in range(3)]
    return MultiChannelSystem(
        [[0, 1, 0], [1, 0, 1], [0, 1, 0]],
        [[[x] for x in row] for row in unit],
        [[row] for row in unit],
        neighbors={"1": ["2"], "2": ["1", "3"], "3": ["2"]},
    )


@pytest.mark.parametrize(
    ("design", "options", "decisions"),
    [
        # Without an agent, loops of several observers are compared before one is proposed.
        (design_setpoint, {"arithmetic": "float", "method": "observer", "agent": "1"}, 1),
        (design_setpoint, {"arithmetic": "float", "method": "extended", "aims": THEOREM}, 1),
        (design_setpoint, {"method": "extended", "aims": THEOREM}, 1),
        (design_observer, {"arithmetic": "float", "agent": "1"}, 1),
        # The spectra of feedback and errors are promised: nothing more is decided.
        (design_observer, {}, 0),
        (design_extended, {"arithmetic": "float", "aims": THEOREM}, 1),
        (design_extended, {"aims": THEOREM}, 1),
        (design_decentralized, {"aims": THEOREM}, 1),
    ],
)
def test_a_proposal_is_assembled_once_and_decided_once(
    design: Any, options: dict[str, Any], decisions: int
) -> None:
    told: list[str] = []
    profile = cProfile.Profile()
    profile.enable()
    design(chain_of_three(), rate="1/2", progress=told.append, **options)
    profile.disable()
    calls = {
        (file, name): number
        for (file, _, name), (number, *_) in pstats.Stats(profile).stats.items()  # type: ignore[attr-defined]
    }
    proposals = told.count("certificate")
    assert proposals >= 1
    assert calls[loop.__file__, "closed_loop"] == calls[loop.__file__, "matrix"] == proposals
    decided = sum(number for (_, name), number in calls.items() if name == "certify_stability")
    assert decided == proposals * decisions
