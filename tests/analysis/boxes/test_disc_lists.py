"""Exterior discs of several matrices: few points are in a disc of each."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest

from mcexact import MultiChannelSystem, check, fixed_spectrum
from mcexact.analysis.boxes import cover as disc_lists_module
from mcexact.analysis.boxes import members
from mcexact.analysis.boxes.cover import GainBox, Outside, disc_lists
from mcexact.analysis.boxes.pencils import FloatBox, Members
from mcexact.boxes import Box, box_controllability, box_fixed_modes
from mcexact.errors import LimitReached
from mcexact.model.gallery import load

PLANT = "quadruple-tank-pminus"


def of_box(box: Box) -> GainBox:
    """The plant and its radii, for gains."""
    plant = box.system
    near = FloatBox.of(Members.of(plant))
    return GainBox(plant.A, tuple(plant.B), tuple(plant.C), box.radii, near)


@pytest.fixture
def large(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have gains drawn for small plants, too."""
    monkeypatch.setattr(disc_lists_module, "_DRAWS", 4)
    monkeypatch.setattr(members, "MANY", 1)


@pytest.mark.usefixtures("large")
def test_eigenvalues_of_members_under_gains_are_in_the_discs_of_each_list() -> None:
    box = Box.relative(load(PLANT), "1/100")
    whole, outside = of_box(box), Outside("continuous", None)
    lists = disc_lists(whole, np.random.default_rng(0), Fraction(1), outside, several=True)
    assert lists is not None and len(lists) > 1
    assert sum(each.F is None for each in lists) <= 1
    for k in range(4):
        member = box.member(random.Random(k), vertex=k > 1)
        for each in lists:
            A = member.A
            for i, F_i in enumerate(each.F or ()):
                A = A + member.B(i) @ F_i @ member.C(i)
            for value in np.linalg.eigvals(A.to_numpy()):
                assert any(
                    abs(value - complex(float(disc.re), float(disc.im)))
                    <= float(disc.radius) * (1 + 1e-6)
                    for disc in each.discs
                )


@pytest.mark.usefixtures("large")
def test_lists_prove_what_is_so_and_nothing_else() -> None:
    plant = load(PLANT)
    system = Box.relative(plant, "1/100").system
    proof = box_fixed_modes(system)
    assert len(proof.exterior) > 1 and check(proof).valid
    assert check(box_controllability(system)).valid
    lost = MultiChannelSystem([[1, 0], [1, 2]], [[[0], [1]]], [[[1, 1]]])
    assert not fixed_spectrum(lost).empty
    with pytest.raises(LimitReached, match="no proof"):
        box_fixed_modes(Box.relative(lost, "1/1000").system)


def test_of_a_small_plant_the_discs_of_a_do() -> None:
    proof = box_fixed_modes(Box.relative(load(PLANT), "1/1000").system)
    assert [each.F for each in proof.exterior] == [None]


def test_a_plant_of_thirty_states_needs_few_frames() -> None:
    """Ten oscillators, each with a channel of its own and coupled to the next one."""
    n, m = 30, 10
    A = [[0] * n for _ in range(n)]
    for i in range(m):
        k = 3 * i
        A[k][k + 1], A[k + 1][k], A[k + 1][k + 1] = 1, -2 - i, -1
        A[k + 2][k + 1], A[k + 2][k + 2] = 1, -3 - i
        A[k][(k + 3) % n] = 1
    B = [[[int(j == 3 * i + 1)] for j in range(n)] for i in range(m)]
    C = [[[int(j == 3 * i + 2) for j in range(n)]] for i in range(m)]
    proof = box_fixed_modes(Box.relative(MultiChannelSystem(A, B, C), "1/100000").system)
    assert check(proof).valid and len(proof.exterior) > 1 and len(proof.frames) < 5
