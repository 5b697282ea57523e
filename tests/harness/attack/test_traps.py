"""Traps: what each condition would let pass is false."""

from __future__ import annotations

import pytest

from mcexact.checker.kinds import check_document
from tests.assurance.attack.campaign import judged
from tests.assurance.attack.conditions import require_one_gate
from tests.assurance.attack.forgeries import (
    box_traps,
    construction_traps,
    plain_traps,
    saturation,
)
from tests.oracle.certificates.judge import FALSE

TRAPS = {
    **box_traps.TRAPS,
    **construction_traps.TRAPS,
    **plain_traps.TRAPS,
}


@pytest.mark.parametrize("trap", TRAPS)
def test_every_trap_is_false_and_closed_by_one_condition(trap: str) -> None:
    assert judged(TRAPS[trap])[0] == FALSE
    require_one_gate(TRAPS[trap])


@pytest.mark.parametrize("trap", saturation.TRAPS)
def test_every_trap_about_limits_is_false_and_refused(trap: str) -> None:
    assert judged(saturation.TRAPS[trap])[0] == FALSE
    assert check_document(saturation.TRAPS[trap]).verdict in ("INVALID", "MALFORMED")
