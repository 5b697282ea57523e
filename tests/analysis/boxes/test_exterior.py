"""Discs that contain the eigenvalues of all members, and the squares that cover them."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
from hypothesis import given, settings

from mcexact import MultiChannelSystem, testing
from mcexact.analysis.boxes.cover import Cover, Outside, exterior
from mcexact.analysis.boxes.pencils import FloatBox, Members, Point
from mcexact.answer.evidence import RootDisc
from mcexact.boxes import Box


@given(testing.systems(min_states=1, max_states=4))
@settings(max_examples=15)
def test_eigenvalues_of_members_are_in_the_discs(drawn: testing.Drawn) -> None:
    box = Box.relative(drawn.system, "1/10")
    found = exterior(
        FloatBox.of(Members.of(box.system)), box.system.A, box.radii.A, np.random.default_rng(0)
    )
    if found is None:
        return
    for k in range(3):
        member = box.member(random.Random(k), vertex=bool(k))
        for value in np.linalg.eigvals(member.A.to_numpy()):
            # Multiple eigenvalues are computed with large errors.
            assert any(
                abs(value - complex(float(disc.re), float(disc.im))) <= float(disc.radius) + 1e-2
                for disc in found.discs
            )


def test_a_chain_of_integrators_has_small_discs() -> None:
    """Its structure keeps all eigenvalues at 0, however long the chain."""
    A = [[0, 1, 0], [0, 0, 1], [0, 0, 0]]
    box = Box.relative(MultiChannelSystem(A, [[[0], [0], [1]]], [[[1, 0, 0]]]), "1/2")
    found = exterior(
        FloatBox.of(Members.of(box.system)), box.system.A, box.radii.A, np.random.default_rng(0)
    )
    assert found is not None and max(float(disc.radius) for disc in found.discs) < 1e-2


def test_modes_that_are_all_0_at_the_values_have_discs() -> None:
    """Nothing but the radii says how large the discs may be."""
    plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [0]]], [[[0, 0], [0, 0]]], time="discrete")
    D = [["1/256", "1/64"], [0, "1/1024"]]
    box = Box.absolute(plant, A=D)
    found = exterior(
        FloatBox.of(Members.of(box.system)), plant.A, box.radii.A, np.random.default_rng(0)
    )
    assert found is not None and max(float(disc.radius) for disc in found.discs) < 1e-2


def test_what_couples_blocks_in_one_direction_does_not_make_their_discs_larger() -> None:
    """The slow mode is known to a thousandth, however strongly a fast one drives it."""
    A = [[-1, 0], [100, "-1/100000"]]
    box = Box.relative(MultiChannelSystem(A, [[[1], [0]]], [[[0, 1]]]), "1/1000")
    found = exterior(
        FloatBox.of(Members.of(box.system)), box.system.A, box.radii.A, np.random.default_rng(0)
    )
    assert found is not None
    assert min(float(disc.radius) for disc in found.discs) < 1e-6


def test_squares_are_cut_until_they_pass_and_those_outside_are_left_out() -> None:
    asked: list[Point] = []

    def small(c: Point, rho: Fraction, depth: int) -> int | None:
        asked.append(c)
        return depth if rho < Fraction(1, 2) else None

    disc = RootDisc("0", "0", "0.5")
    whole = Cover(small, Outside("continuous", None), 100)
    assert whole.of((disc, RootDisc("0", "-2", "0.5"))) == ((None, 1, 1, 1, 1), ())
    assert whole.tested == len(asked) == 5 and all(c[1] <= Fraction(1, 4) for c in asked)
    right = Cover(small, Outside("continuous", Fraction(0)), 100)
    assert right.of((RootDisc("0", "1", "0.5"),)) == ((None, 1, 1, 1, 1),)
    shifted = Cover(small, Outside("continuous", Fraction(1, 4)), 100)
    assert shifted.of((RootDisc("-0.6", "1", "0.5"),)) == ((None, 1, 1),)
    assert Cover(small, Outside("continuous", None), 3).of((disc, RootDisc("9", "0", "4"))) is None


def test_what_lies_inside_of_a_circle_is_outside_of_the_claim() -> None:
    inside = Outside("discrete", Fraction(1))
    origin, half = (Fraction(0), Fraction(0)), (Fraction(1, 2), Fraction(0))
    assert inside.has_disc(origin, Fraction(9, 10)) and not inside.has_disc(origin, Fraction(1))
    assert inside.has_disc(half, Fraction(2, 5)) and not inside.has_disc(half, Fraction(1, 2))
    assert inside.has_square(origin, Fraction(7, 10)) and not inside.has_square(
        origin, Fraction(3, 4)
    )
    assert not Outside("discrete", None).has_square(origin, Fraction(1, 10))
    assert Outside("discrete", None).has_square((Fraction(0), Fraction(-2)), Fraction(1))


def test_squares_that_meet_no_disc_of_another_list_are_left_out() -> None:
    asked: list[Point] = []

    def never(c: Point, rho: Fraction, depth: int) -> int | None:
        asked.append(c)
        return 0 if depth else None

    first, corner = RootDisc("0", "0", "2"), RootDisc("1.5", "1.5", "0.25")
    cover = Cover(never, Outside("continuous", None), 100)
    assert cover.of((first,), (RootDisc("9", "0", "1"),)) == ((),) and not asked
    assert cover.of((first,), (RootDisc("9", "0", "1"), corner)) == ((None, 0),)
    assert asked == [(0, 0), (1, 1)]
    assert cover.of((first,), (corner,), (RootDisc("0", "0", "0.5"),)) == ((None, 0),)
    assert cover.of((first,), (corner,), (RootDisc("-1", "-1", "0.9"),)) == ((None,),)
