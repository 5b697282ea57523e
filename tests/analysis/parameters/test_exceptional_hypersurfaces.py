"""Several parameters: what is fixed for almost all values, and on which hypersurfaces more is."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from mcexact import (
    ParametricSystem,
    check,
    fixed_spectrum,
    observability_indices,
    setpoint_solvability,
)
from mcexact.errors import UsageError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import RationalFunction
from mcexact.parameters import exceptional_hypersurfaces, load_parametric_system
from tests.assurance.campaigns import hypersurfaces
from tests.wording import says, worded


def surfaces(plant: ParametricSystem) -> list[str]:
    """The hypersurfaces, as texts."""
    return [str(each.polynomial) for each in exceptional_hypersurfaces(plant).hypersurfaces]


def count_fixed(plant: ParametricSystem, at: dict[str, Any]) -> int:
    """How many different modes are fixed at a point."""
    return sum(f.polynomial.degree for f in fixed_spectrum(plant.at(at)).factors)


def test_the_quadruple_tank_is_exceptional_where_a_valve_is_closed() -> None:
    tank = load_parametric_system("gallery:quadruple-tank-parametric")
    found = exceptional_hypersurfaces(tank)
    assert [str(each) for each in found.hypersurfaces] == ["gamma1 = 1", "gamma2 = 1"]
    assert not found.generic and not found.undefined_at
    assert says(found.words, "almost gamma")
    assert worded(found.words[-1])


def test_along_every_line_a_certificate_proves_it() -> None:
    tank = load_parametric_system("gallery:quadruple-tank-parametric")
    found = exceptional_hypersurfaces(tank)
    assert len(found.lines) == len(found.certificates) == 2
    for each in found.lines:
        assert check(each.answer, tank).valid
        assert each.answer.generic == () and len(each.answer.exceptional) == 2


def test_a_curve_that_is_no_product_of_lines_is_found() -> None:
    plant = ParametricSystem(
        [[0, "a"], [0, 1]], [[[0], [1]]], [[["b - a", 1]]], parameters=["a", "b"]
    )
    assert surfaces(plant) == ["a", "a - b", "a^2 - a*b - 1"]
    [curve] = [
        each
        for each in exceptional_hypersurfaces(plant).hypersurfaces
        if each.polynomial.numerator.total_degree() == 2
    ]
    assert str(curve.to_sympy().as_expr()) == "a**2 - a*b - 1"
    for a in (1, 2, -3, Fraction(1, 2)):
        assert count_fixed(plant, {"a": a, "b": a - 1 / Fraction(a)}) == 1


def test_generic_modes_are_polynomials_in_the_parameters() -> None:
    plant = ParametricSystem(
        [["a*b", 0, 0], [0, "a", "b"], [0, 0, 2]],
        [[[0], [0], [1]]],
        [[[1, 1, 0]]],
        parameters=["a", "b"],
    )
    found = exceptional_hypersurfaces(plant)
    assert [[str(c) for c in p] for p in found.generic] == [["-a*b", "1"]]
    assert says(found.words, "roots almost")
    assert count_fixed(plant, {"a": 5, "b": 7}) == 1
    assert surfaces(plant)[0] == "b" and count_fixed(plant, {"a": 5, "b": 0}) == 3


def test_where_only_a_multiplicity_grows_nothing_is_exceptional() -> None:
    plant = ParametricSystem([["a", 1], [0, "b"]], [[[0], [1]]], [[[1, 0]]], parameters=["a", "b"])
    assert surfaces(plant) == []


def test_denominators_are_undefined_and_not_exceptional() -> None:
    plant = ParametricSystem(
        [["1/(a - b)", 1], [0, 1]], [[[0], ["b"]]], [[["1/a", 0]]], parameters=["a", "b"]
    )
    found = exceptional_hypersurfaces(plant)
    assert [str(each) for each in found.undefined_at] == ["a", "a - b"]
    assert [str(each.polynomial) for each in found.hypersurfaces] == ["b"]


@pytest.mark.parametrize("question", ["fixed_spectrum", "joint_controllability", "setpoint"])
def test_lines_inside_a_hypersurface_and_beside_it_say_nothing_of_it(question: Any) -> None:
    """Of the drawn lines some lie in a + b = 0, and some never meet it."""
    for k in (-29, -17, -10, -7, 5, 12, 22, 25, 28):
        plant = ParametricSystem([[k]], [[["a + b"]]], [[[1]]], parameters=["a", "b"])
        found = exceptional_hypersurfaces(plant, question)
        assert [str(each) for each in found.exceptional_at] == ["a + b"]


@pytest.mark.parametrize("number", [17, 24])
def test_drawn_plants_agree_with_enumeration_modulo_primes(number: int) -> None:
    wrong, seen = hypersurfaces.examined(number)
    assert not wrong
    assert seen["certificates"] > 0


def test_enumeration_notices_a_hypersurface_that_is_left_out() -> None:
    plant = ParametricSystem([[1]], [[["a + b"]]], [[[1]]], parameters=["a", "b"])
    found = exceptional_hypersurfaces(plant)
    for told, agrees in ((found, True), (replace(found, hypersurfaces=()), False)):
        told_of = hypersurfaces.more_fixed(told)
        assert (hypersurfaces.differing(plant, told, random.Random(1), told_of) == []) is agrees


def test_several_parameters_name_the_question_that_decides_for_them() -> None:
    plant = ParametricSystem([["a*b"]], [[[1]]], [[[1]]], parameters=["a", "b"])
    with pytest.raises(UsageError, match="exceptional_hypersurfaces"):
        fixed_spectrum(plant)


def test_no_states_and_channels_without_inputs_are_no_special_cases() -> None:
    assert surfaces(ParametricSystem([], [[]], [[]], parameters=["a", "b"])) == []
    idle = ParametricSystem([["a", 1], [0, "b"]], [[[], []]], [[]], parameters=["a", "b"])
    assert len(exceptional_hypersurfaces(idle).generic) == 2


def fixed_at(plant: ParametricSystem, at: dict[str, Any]) -> set[Polynomial]:
    """The irreducible factors of what is fixed at a point."""
    return {f.polynomial for f in fixed_spectrum(plant.at(at)).factors}


def test_drawn_plants_agree_with_what_is_fixed_at_points() -> None:
    """A point off all hypersurfaces has the generic modes alone, a point on one has more."""
    rng = random.Random(7)
    entries = ["0", "1", "a", "b", "a - b", "a*b + 1"]
    on, off = 0, 0
    for _ in range(6):
        A = [[rng.choice(entries) if i <= j else "0" for j in range(3)] for i in range(3)]
        B = [[[rng.choice(entries)] for _ in range(3)] for _ in range(2)]
        C = [[[rng.choice(entries) for _ in range(3)]] for _ in range(2)]
        plant = ParametricSystem(A, B, C, parameters=["a", "b"])
        found = exceptional_hypersurfaces(plant)

        def generic(at: dict[str, Any], found: Any = found) -> set[Polynomial]:
            zero = RationalFunction.constant(0, ())
            point = [at["a"], at["b"]]
            values = (
                Polynomial.from_coefficients([c.substituted(point, zero).value for c in p])
                for p in found.generic
            )
            return {q for p in values for q, _ in p.factor()}

        for _ in range(3):
            at = {name: Fraction(rng.randint(-99, 99), 7) for name in ("a", "b")}
            assert fixed_at(plant, at) == generic(at)
            off += 1
        for each in found.hypersurfaces:
            a = Fraction(rng.randint(10, 99), 7)
            met = solutions(each.polynomial, a)
            for b in met:
                at = {"a": a, "b": b}
                assert fixed_at(plant, at) > generic(at)
                on += 1
    assert on > 5 and off == 18


def solutions(h: RationalFunction, a: Fraction) -> list[Fraction]:
    """The rational b at which a polynomial in a and b is 0."""
    b = RationalFunction.parameter("b", ("b",))
    at = h.substituted([b * 0 + a, b], b * 0).polynomials()[0]
    return [-q.coefficients[0] for q, _ in at.factor() if q.degree == 1] if at else []


TANK = load_parametric_system("gallery:quadruple-tank-parametric")


def test_set_points_of_the_quadruple_tank_fail_where_the_shares_add_up_to_1() -> None:
    found = exceptional_hypersurfaces(TANK, "setpoint")
    assert found.rank == 6
    assert [(str(h), h.rank) for h in found.hypersurfaces] == [("gamma1 + gamma2 - 1 = 0", 5)]
    assert "rank 5 where gamma1 + gamma2 - 1 = 0" in found.words
    assert repr(found) == "RankHypersurfaces(rank 6, exceptional: gamma1 + gamma2 - 1 = 0)"
    assert found.to_dict()["hypersurfaces"] == [{"polynomial": "gamma1 + gamma2 - 1", "rank": 5}]
    for each in found.lines:
        assert check(each.answer, TANK).valid
    for gamma1 in ("1/3", 0, 2):
        there = TANK.at({"gamma1": gamma1, "gamma2": 1 - Fraction(gamma1)})
        assert not setpoint_solvability(there).solvable


def test_edges_vanish_where_a_valve_sends_nothing() -> None:
    graph = exceptional_hypersurfaces(TANK, "transfer_graph")
    lost = {pair: [str(h) for h in values] for pair, values in graph.lost.items()}
    assert len(graph.arcs) == 4 and len(graph.certificates) == 8
    assert lost == {
        ("1", "1"): ["gamma1 = 0"],
        ("1", "2"): ["gamma1 = 1"],
        ("2", "1"): ["gamma2 = 1"],
        ("2", "2"): ["gamma2 = 0"],
    }
    complete = exceptional_hypersurfaces(TANK, "completeness")
    assert complete.generic
    assert [str(h) for h in complete.exceptional] == ["gamma1 - 1", "gamma2 - 1"]


def test_controllability_is_about_the_channels_that_are_named() -> None:
    alone = exceptional_hypersurfaces(TANK, "channel_controllability", channels=["1"])
    assert len(alone.generic) == 1
    assert [str(h) for h in alone.hypersurfaces] == ["gamma1 = 0", "gamma1 = 1"]
    observed = exceptional_hypersurfaces(TANK, "joint_observability")
    assert not observed.generic and not observed.hypersurfaces
    with pytest.raises(UsageError, match="about all channels"):
        exceptional_hypersurfaces(TANK, "setpoint", channels=["1"])  # type: ignore[call-overload]
    with pytest.raises(UsageError, match="fixed_spectrum"):
        exceptional_hypersurfaces(TANK, "fixed_modes")  # type: ignore[call-overload]


def drawn(rng: random.Random, time: str) -> ParametricSystem:
    """A plant of three states and two channels with entries in a and b."""
    entries = ["0", "1", "a", "b", "a - b", "a*b + 1"]

    def table(r: int, c: int) -> list[list[str]]:
        return [[rng.choice(entries) for _ in range(c)] for _ in range(r)]

    B, C = ([table(*size) for _ in range(2)] for size in ((3, 1), (1, 3)))
    return ParametricSystem(table(3, 3), B, C, parameters=["a", "b"], time=time)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_ranks_of_drawn_plants_agree_with_those_at_points(time: str) -> None:
    rng, on = random.Random(11), 0
    for _ in range(3):
        plant = drawn(rng, time)
        steady = exceptional_hypersurfaces(plant, "setpoint")
        blocks = exceptional_hypersurfaces(plant, "observability_indices")
        for _ in range(3):
            at = {name: Fraction(rng.randint(-99, 99), 7) for name in ("a", "b")}
            assert setpoint_solvability(plant.at(at)).rank == steady.rank
            assert ranks_at(plant, at, len(blocks)) == tuple(each.rank for each in blocks)
        for each in steady.hypersurfaces:
            for a in (Fraction(rng.randint(10, 99), 7) for _ in range(2)):
                for b in solutions(each.polynomial, a):
                    assert setpoint_solvability(plant.at({"a": a, "b": b})).rank == each.rank
                    on += 1
    assert on > 1


def ranks_at(plant: ParametricSystem, at: dict[str, Any], blocks: int) -> tuple[int, ...]:
    """The ranks of [C; CA; …] with up to so many blocks, at a point."""
    ranks = list(observability_indices(plant.at(at)).ranks)
    return tuple((ranks + [ranks[-1]] * blocks)[:blocks])


def test_a_matrix_that_is_0_has_no_exceptional_values() -> None:
    idle = ParametricSystem([["a", 1], [0, "b"]], [[[0], [0]]], [[["a", 0]]], parameters=["a", "b"])
    graph = exceptional_hypersurfaces(idle, "transfer_graph")
    assert graph.arcs == () and graph.lost == {}
    none = ParametricSystem([], [[]], [[]], parameters=["a", "b"])
    assert exceptional_hypersurfaces(none, "setpoint").rank == 0
    assert [each.rank for each in exceptional_hypersurfaces(none, "controllability_indices")] == [0]
