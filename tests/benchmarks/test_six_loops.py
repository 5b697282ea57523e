"""What is measured of the six loops, of the smallest ones."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks import six_loops
from benchmarks.six_loops import AIMS, LOOPS, Figures, measured, page


def test_every_loop_has_its_files() -> None:
    names = {path.name.split(".")[0] for path in LOOPS.glob("*.plant.json")}
    assert names == {path.name.split(".")[0] for path in LOOPS.glob("*.controller.json")} == {*AIMS}


def test_the_smallest_loop_is_proved_within_its_aims() -> None:
    row = measured("chain-10")
    assert row.refused == 0 and row.ports == 6 and row.states == 16
    assert 1 < row.figures.ratio < 1.2 and row.least > 0.4
    assert not {"ratio", "bytes", "margin_bytes"} & {*row.worse()}
    assert "| chain-10 | 16 | 1.1" in page([row]) and "not find valid: 0." in page([row])


def test_what_is_above_twice_its_aim_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    row = measured("chain-10")
    fast = replace(row, figures=Figures(1.3, 5e3, 0.04, 9e3, 0.03))
    assert fast.worse() == [] and "designed for: none." in page([fast])
    slow = replace(row, figures=Figures(2.6, 9e3, 0.06, 9e3, 0.03), refused=1)
    assert slow.worse() == ["ratio", "bytes", "checked"]
    assert "chain-10: ratio, bytes, checked." in page([slow]) and "valid: 1." in page([slow])
    monkeypatch.setattr(six_loops, "measured", lambda name: replace(row, name=name, refused=1))
    assert six_loops.main(["chain-10"]) == 1
