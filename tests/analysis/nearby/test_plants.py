"""Plants nearby: what is found is exact, near, and lacks what is said, by an oracle of its own.

The searches are in floating point: nothing here depends on which plant of several is found.
"""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.analysis.analyze import analyze
from mcexact.analysis.nearby.allowances import digits, rounding, typed
from mcexact.analysis.nearby.plants import Nearby, NearPlant
from mcexact.analysis.nearby.search import nearby_plants
from mcexact.answer.check import check
from mcexact.answer.nearby import LOST
from mcexact.derived.constructions import dual
from mcexact.errors import InputError
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from tests.oracle.enumeration import fixed_factors, plain

LINES = [(0, 1, "2.1"), (1, 2, "1.7"), (2, 3, "2.4"), (3, 0, "1.3")]
MASSES, DAMPING = (11, 7, 13, 9), ("0.8", "1.1", "0.9", "0.7")


def grid(divided: Any, units: Any = lambda k: 1) -> MultiChannelSystem:
    """A swing grid with one machine in each channel, whose entries are quotients.

    Frequencies are measured, so that no output shows one common angle.
    """
    n = 2 * len(MASSES)
    A = [[Fraction(0)] * n for _ in range(n)]
    for i, mass in enumerate(MASSES):
        near = [(a + b - i, Fraction(x)) for a, b, x in LINES if i in (a, b)]
        row = 2 * i + 1
        A[2 * i][row] = Fraction(1)
        A[row][2 * i] = divided(-sum(x for _, x in near), mass)
        A[row][row] = divided(-Fraction(DAMPING[i]), mass)
        for j, x in near:
            A[row][2 * j] = divided(x, mass)
    unit = [Fraction(units(k)) for k in range(n)]
    A = [[x * unit[i] / unit[j] for j, x in enumerate(row)] for i, row in enumerate(A)]
    B = [
        [[divided(Fraction(1), mass) * unit[k] if k == 2 * i + 1 else 0] for k in range(n)]
        for i, mass in enumerate(MASSES)
    ]
    C = [[[1 / unit[k] if k == 2 * i + 1 else 0 for k in range(n)]] for i in range(4)]
    return MultiChannelSystem(A, B, C)


def in_floats(x: Fraction, y: int) -> Fraction:
    """The quotient of two floats as it is printed."""
    return Fraction(repr(float(x) / float(y)))


def to_digits(number: int) -> Any:
    return lambda x, y: Fraction(f"{float(x / y):.{number - 1}e}")


def disturbed(system: MultiChannelSystem, part: float, seed: int = 0) -> MultiChannelSystem:
    """The plant with a relative error of each entry, as floats are printed."""
    rng = random.Random(seed)

    def moved(M: Matrix) -> Matrix:
        entries = [
            (i, j, Fraction(repr(float(M[i, j]) * (1 + part * rng.uniform(-1, 1)))))
            for i, j, _ in M.nonzero()
        ]
        return Matrix.from_entries(M.shape, entries)

    return MultiChannelSystem(
        moved(system.A), [*map(moved, system.B)], [*map(moved, system.C)], time=system.time
    )


def entries(system: MultiChannelSystem) -> list[Fraction]:
    return [x for M in (system.A, *system.B, *system.C) for row in M.rows() for x in row]


def require_near(system: MultiChannelSystem, found: NearPlant) -> None:
    """The plant keeps zeros, is as near as it says, and has the mode for one of all subsets."""
    pairs = [*zip(entries(system), entries(found.plant), strict=True)]
    assert all(y == 0 for x, y in pairs if x == 0) and all(y for x, y in pairs if x)
    assert max(abs(y - x) / abs(x) for x, y in pairs if x) == found.part > 0
    unit = {"rounding": rounding, "digits": typed, None: lambda x: abs(x) * Fraction(1, 10**6)}
    assert all(abs(y - x) <= unit[found.within](x) for x, y in pairs)
    fixed = fixed_factors(plain(found.plant))
    assert tuple(found.mode.coefficients) in {tuple(p) for p in fixed}
    if found.lost == "unstable":
        assert not StabilityRegion(system.time).contains_roots_of(found.mode)
    if found.lost == "uncontrollable":
        assert found.channels == ()
    if found.lost == "unobservable":
        assert found.channels == system.names
    assert found.proof.rank < system.n and check(found.proof).verdict == "VALID"
    assert found.proof.about.plant.digest() == found.plant.digest()


def require_all_near(system: MultiChannelSystem, found: Nearby) -> None:
    for each in found.plants:
        require_near(system, each)


def test_a_grid_divided_in_floating_point_is_beside_one_that_nothing_stabilizes() -> None:
    plant = grid(in_floats)
    found = nearby_plants(plant)
    require_all_near(plant, found)
    near, hidden = found.get("unstable"), found.get("unobservable")
    assert near is not None and hidden is not None and found.get("fixed") is None
    assert near.mode == Polynomial.from_roots([0]) == hidden.mode
    assert near.within == "rounding" and near.part < Fraction(1, 10**15)
    assert near.channels == plant.names


def test_the_same_grid_in_fractions_has_the_mode_itself_and_no_other_nearby() -> None:
    spectrum = analyze(grid(Fraction), ["fixed_spectrum", "joint_controllability"])
    assert not spectrum.fixed_spectrum.stabilizable
    assert spectrum.nearby.searched == ("uncontrollable",) and spectrum.nearby.plants == ()


@pytest.mark.parametrize("power", [2, 4, 6, 9])
def test_other_units_of_states_do_not_hide_a_plant_nearby(power: int) -> None:
    rng = random.Random(power)
    scales = [Fraction(repr(10 ** rng.uniform(-power, power))) for _ in range(8)]
    plant = disturbed(grid(Fraction, scales.__getitem__), 1e-16)
    near = nearby_plants(plant, ["fixed"]).get("fixed")
    assert near is not None and near.within == "rounding"
    require_near(plant, near)


def chained(n: int, step: Fraction) -> MultiChannelSystem:
    """A plant in floats with a mode that no input moves: Σ (−step)^k x_k, whatever the inputs."""
    rng = random.Random(1)
    entry = lambda: Fraction(rng.randint(-99, 99), 100)  # noqa: E731
    A = [[entry() if i and (2 * i >= n or 2 * j < n) else 0 for j in range(n)] for i in range(n)]
    A[0][0] = Fraction(3, 10)
    T = Matrix.from_rows(
        [[1 if i == j else step if j == i + 1 else 0 for j in range(n)] for i in range(n)]
    )
    back = inverse(T)
    assert back is not None
    B = [T @ Matrix.from_rows([[entry() if i else 0] for i in range(n)]) for _ in range(2)]
    C = [Matrix.from_rows([[entry() for _ in range(n)]]) for _ in range(2)]
    return disturbed(MultiChannelSystem(T @ Matrix.from_rows(A) @ back, B, C), 1e-16)


@pytest.mark.parametrize(("n", "step"), [(5, "1/2000"), (6, "1/1000")])
def test_tiny_entries_of_a_null_space_count(n: int, step: str) -> None:
    """The smallest entry is 10⁻¹³ or less: zero in its place is another plant."""
    plant = chained(n, Fraction(step))
    near = nearby_plants(plant, ["fixed"]).get("fixed")
    assert near is not None and near.within == "rounding"
    require_near(plant, near)


@pytest.mark.parametrize("number", [3, 5, 8])
def test_digits_that_were_not_typed_are_told_of(number: int) -> None:
    plant = grid(to_digits(number))
    near = nearby_plants(plant, ["unstable"]).get("unstable")
    assert near is not None and near.within == "digits"
    require_near(plant, near)


def test_entries_of_one_or_two_digits_count_as_exact() -> None:
    plant = grid(to_digits(2))
    assert nearby_plants(plant).plants == ()
    assert {digits(x) for x in entries(plant) if x} <= {1, 2}


@pytest.mark.parametrize("part", [1e-15, 1e-12, 1e-9, 1e-7])
def test_a_mode_fixed_between_two_channels_is_found_again(part: float) -> None:
    # What the first channel does to the mode 1/3 only the second one sees, which cannot answer.
    planted = MultiChannelSystem(
        [["1/3", 0, 0], [0, "2/5", 0], [0, 0, "-2/3"]],
        [[["1/3"], [0], ["1/2"]], [[0], ["2/3"], [0]]],
        [[[0, 0, "1/2"]], [["1/5", "1/7", 0]]],
    )
    T = Matrix.from_rows([[1, "1/2", 0], ["1/3", 1, "2/7"], ["1/7", "1/9", 1]])
    back = inverse(T)
    assert back is not None
    plant = MultiChannelSystem(
        T @ planted.A @ back, [T @ M for M in planted.B], [M @ back for M in planted.C]
    )
    assert len(fixed_factors(plain(plant))) == 1
    moved = disturbed(plant, part)
    assert fixed_factors(plain(moved)) == {}
    near = nearby_plants(moved, ["fixed"]).get("fixed")
    assert near is not None and near.part <= 20 * Fraction(part)
    require_near(moved, near)


def test_a_pair_of_complex_modes_is_found() -> None:
    turn = [["1/3", "2/3"], ["-4/3", "1/5"]]
    A: list[list[Any]] = [
        [*turn[0], 0, 0],
        [*turn[1], 0, 0],
        ["1/2", "1/3", "-1/7", "3/5"],
        ["1/5", 1, "-2/3", "-1/9"],
    ]
    T = Matrix.from_rows(
        [[1, "1/3", 0, "1/2"], [0, 1, "1/7", 0], ["1/5", 0, 1, 0], [0, "2/3", 0, 1]]
    )
    back = inverse(T)
    assert back is not None
    B = [Matrix.from_rows([[0], [0], [1], ["1/2"]])] * 2
    C = [Matrix.from_rows([["1/3", 1, "1/2", 0]]), Matrix.from_rows([[1, 0, 0, "1/3"]])]
    plant = disturbed(
        MultiChannelSystem(
            T @ Matrix.from_rows(A) @ back, [T @ M for M in B], [M @ back for M in C]
        ),
        1e-14,
    )
    near = nearby_plants(plant, ["uncontrollable"]).get("uncontrollable")
    assert near is not None and near.mode.degree == 2
    require_near(plant, near)


def test_integers_are_kept_where_that_is_possible() -> None:
    plant = grid(in_floats)
    near = nearby_plants(plant, ["unstable"]).get("unstable")
    assert near is not None
    pairs = zip(entries(plant), entries(near.plant), strict=True)
    assert all(x == y for x, y in pairs if x.denominator == 1)


def test_the_dual_of_a_plant_nearby_is_near_the_dual_plant() -> None:
    plant = grid(in_floats)
    turned = MultiChannelSystem(plant.A.T, [M.T for M in plant.C], [M.T for M in plant.B])
    near = nearby_plants(turned, ["uncontrollable"]).get("uncontrollable")
    assert near is not None and near.within == "rounding"
    require_near(turned, near)


@pytest.mark.filterwarnings("ignore::mcexact.errors.RoundingWarning")
def test_discrete_time_has_the_unit_disc_for_the_half_plane() -> None:
    # Shares that are handed on: their sum stays, but for rounding errors.
    A = [[0.7, 0.1, 0.2], [0.1, 0.6, 0.3], [0.2, 0.3, 0.5]]
    A = [[x / 3 + (0.0 if i != j else 2 / 3) for j, x in enumerate(row)] for i, row in enumerate(A)]
    B, C = [[[0.3], [-0.3], [0.0]], [[0.0], [0.7], [-0.7]]], [[[1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]]]
    plant = disturbed(
        MultiChannelSystem.from_float(A, B, C, rounding="decimal", time="discrete"), 1e-15
    )
    near = nearby_plants(plant, ["unstable", "uncontrollable"]).get("uncontrollable")
    assert near is not None
    require_near(plant, near)
    assert abs(near.mode.coefficients[0] + 1) < Fraction(1, 10**12)


@pytest.mark.parametrize("seed", range(12))
def test_well_posed_plants_of_few_digits_have_no_other_plant_nearby(seed: int) -> None:
    rng = random.Random(seed)
    n, number = rng.randint(2, 7), rng.choice([2, 3])

    def table(r: int, c: int) -> list[list[str]]:
        return [[f"{rng.uniform(-3, 3):.{number}g}" for _ in range(c)] for _ in range(r)]

    plant = MultiChannelSystem(table(n, n), [table(n, 1)] * 2, [table(1, n)] * 2)
    found = nearby_plants(plant)
    require_all_near(plant, found)
    assert not any(each.within == "rounding" for each in found.plants)


EDGES = [
    ("no states", MultiChannelSystem([], [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)])),
    ("one state", MultiChannelSystem([["1/3"]], [[["1/7"]]], [[["2/3"]]])),
    ("no inputs that act", MultiChannelSystem([["1/3"]], [[[0]]], [[[1]]])),
    ("no ports", MultiChannelSystem([["1/3"]], [Matrix.zeros(1, 0)], [Matrix.zeros(0, 1)])),
    ("A = 0", MultiChannelSystem([[0, 0], [0, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])),
    (
        "a small entry is no rounding error",
        MultiChannelSystem([[1, 0], [0, 2]], [[[1], ["1e-20"]]], [[[1, 1]]]),
    ),
    ("beyond the range of floats", MultiChannelSystem([[10**400]], [[[1]]], [[[1]]])),
    ("below the range of floats", MultiChannelSystem([["1e-400"]], [[[1]]], [[["1e-350"]]])),
]


@pytest.mark.parametrize(("why", "plant"), EDGES, ids=[why for why, _ in EDGES])
def test_nothing_is_found_where_nothing_is(why: str, plant: MultiChannelSystem) -> None:
    assert nearby_plants(plant).plants == ()


def test_what_is_asked_for_is_known_and_about_a_plant() -> None:
    plant = grid(in_floats)
    with pytest.raises(InputError, match="expected some of"):
        nearby_plants(plant, ["robust"])  # type: ignore[list-item]
    with pytest.raises(InputError, match="derived system"):
        nearby_plants(dual(plant))
    assert nearby_plants(plant, []).searched == () and LOST[0] == "unstable"
