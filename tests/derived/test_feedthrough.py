"""Systems with feedthrough: laws, a comparison with brute force, and who refuses them.

The oracle knows (A, B, C, D) alone: λ is fixed iff rank [λI − A, −B_T; C_s, D_{s,T}] < n for some
set s of channels with T for the others.  It enumerates all sets, over Q or a companion matrix.
"""

from __future__ import annotations

import inspect
import random
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import chain, combinations
from typing import Any

import pytest
from flint import fmpq, fmpq_mat, fmpq_poly

import mcexact
from mcexact import (
    InputError,
    MultiChannelSystem,
    check,
    completeness,
    fixed_spectrum,
    joint_controllability,
    joint_observability,
    setpoint_solvability,
    transfer_graph,
)
from mcexact.checker import constructions
from mcexact.checker.constructions import read_subject
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import read_plant
from mcexact.constructions import input_filters, periodic_loop
from mcexact.derived.constructions import add_links, feedback, full_output
from mcexact.derived.feedthrough import without_feedthrough
from mcexact.derived.modulo import without_part
from mcexact.designs import PeriodicController, local_controllers
from mcexact.model.loop import closed_loop
from mcexact.model.text import plain
from tests.public import PUBLIC

DRAWS = 500
A, B, C = [[-1, -1], [-1, -1]], [[[-1], [-1]], [[1], [0]]], [[[1, 0]], [[1, 1]]]
SIGNED = {sign: MultiChannelSystem(A, B, C, D=[[0, 0], [sign, 0]]) for sign in (1, -1)}
"""Two plants that differ in the sign of D: 0 is fixed for 1, and nothing is for -1."""


def drawn(rng: random.Random) -> MultiChannelSystem:
    """A small system with feedthrough, many of whose entries are 0."""
    n, m = rng.randint(1, 4), rng.randint(1, 3)
    p, q = ([rng.choice((1, 1, 1, 2, 0)) for _ in range(m)] for _ in range(2))

    def entries(rows: int, columns: int, zeros: int) -> list[list[int]]:
        choices = [0] * zeros + [1, -1, 2]
        return [[rng.choice(choices) for _ in range(columns)] for _ in range(rows)]

    A = [[0] * n for _ in range(n)]
    for i in range(n):
        A[i][i] = rng.choice((0, 0, 1, -1))
        for j in range(i):
            A[i][j] = rng.choice((0, 0, 1))
    if n > 1 and rng.random() < 0.4:  # irrational modes
        A[0][1] = rng.choice((-1, 2))
    return MultiChannelSystem(
        A,
        [entries(n, width, 3) for width in p],
        [entries(height, n, 3) if height else [] for height in q],
        D=entries(sum(q), sum(p), 2) if sum(q) else None,
        time=rng.choice(("continuous", "discrete")),
    )


def short_by_one(rng: random.Random) -> MultiChannelSystem:
    """A system whose pencil of one set has rank n − 1 at a mode, whose B_T and D count for it."""
    n = rng.randint(2, 3)
    mode = rng.choice((0, 1, -1))

    def entries(rows: int, columns: int) -> fmpq_mat:
        cells = [fmpq(rng.choice((0, 1, -1, 2))) for _ in range(rows * columns)]
        return fmpq_mat(rows, columns, cells)

    upper = entries(n, n - 1) * entries(n - 1, n + 1)
    lower = entries(1, n) * upper
    A = [[int(i == j) * mode - int(upper[i, j]) for j in range(n)] for i in range(n)]
    return MultiChannelSystem(
        A,
        [[[-int(upper[i, n])] for i in range(n)], [[rng.randint(-2, 2)] for _ in range(n)]],
        [[[rng.randint(-2, 2) for _ in range(n)]], [[int(lower[0, j]) for j in range(n)]]],
        D=[[0, 0], [int(lower[0, n]), 0]],
    )


def all_drawn(count: int = DRAWS, seed: int = 7) -> Iterator[MultiChannelSystem]:
    """So many systems whose feedthrough is not 0."""
    rng = random.Random(seed)
    while count:
        system = (drawn if rng.random() < 0.7 else short_by_one)(rng)
        if system.D is not None:
            count -= 1
            yield system


def rational(M: mcexact.Matrix, nrows: int, ncols: int) -> fmpq_mat:
    """A matrix of flint."""
    cells = [fmpq(x.numerator, x.denominator) for row in M.rows() for x in row]
    return fmpq_mat(nrows, ncols, cells)


def inflated(M: fmpq_mat, d: int) -> list[list[Any]]:
    """M ⊗ I_d as rows."""
    rows = M.tolist()
    return [
        [rows[i][j] if k == r else fmpq(0) for j in range(M.ncols()) for k in range(d)]
        for i in range(M.nrows())
        for r in range(d)
    ]


def companion(p: fmpq_poly) -> list[list[Any]]:
    """A matrix with the characteristic polynomial p, monic."""
    d = p.degree()
    rows = [[fmpq(int(i == j + 1)) for j in range(d)] for i in range(d)]
    for i in range(d):
        rows[i][d - 1] = -p[i]
    return rows


def pencil_is_short(system: MultiChannelSystem, s: set[int], p: fmpq_poly, sign: int) -> bool:
    """Whether rank [λI − A, −B_T; C_s, D_{s,T}] < n at the roots of p; ``sign`` 1 for −B_T."""
    n, d = system.n, p.degree()
    T = [i for i in range(system.m) if i not in s]
    B, C = system.input_matrix(T), system.output_matrix(s)
    D = system.feedthrough_matrix(sorted(s), T)
    A = inflated(rational(system.A, n, n), d)
    block = companion(p)
    for i in range(n):
        for r in range(d):
            for k in range(d):
                A[i * d + r][i * d + k] = block[r][k] - A[i * d + r][i * d + k]
            for j in range(n):
                if j != i:
                    for k in range(d):
                        A[i * d + r][j * d + k] = -A[i * d + r][j * d + k]
    upper = inflated(rational(B, n, B.ncols) * fmpq(-sign), d)
    left = inflated(rational(C, C.nrows, n), d)
    right = inflated(rational(D, C.nrows, B.ncols), d)
    rows = [a + b for a, b in zip(A, upper, strict=True)]
    rows += [a + b for a, b in zip(left, right, strict=True)]
    width = d * (n + B.ncols)
    return bool(fmpq_mat(len(rows), width, list(chain(*rows))).rref()[1] < n * d)


def fixed_by_enumeration(system: MultiChannelSystem, sign: int = 1) -> set[str]:
    """The irreducible polynomials of fixed modes, by all sets of channels."""
    chi = rational(system.A, system.n, system.n).charpoly()
    numerator = chi.numer()
    found = set()
    for factor, _ in numerator.factor()[1]:
        p = fmpq_poly(factor) / factor[factor.degree()]
        sets = chain(*(combinations(range(system.m), k) for k in range(system.m + 1)))
        if any(pencil_is_short(system, set(s), p, sign) for s in sets):
            found.add(str(p))
    return found


def fixed_as_decided(system: MultiChannelSystem) -> set[str]:
    """The same from the answer."""
    return {str(fmpq_poly_of(p)) for p in found(system)}


def test_fixed_modes_are_those_that_enumeration_finds() -> None:
    """Of 500 drawn systems none differs; with the other sign of B some would."""
    some, trapped = 0, 0
    for system in all_drawn():
        expected = fixed_by_enumeration(system)
        assert fixed_as_decided(system) == expected, system.to_dict()
        some += bool(expected)
        trapped += expected != fixed_by_enumeration(system, sign=-1)
    assert some > DRAWS // 10 and trapped > DRAWS // 50


def test_the_sign_of_the_feedthrough_decides() -> None:
    assert [str(fixed_spectrum(SIGNED[sign]).polynomial) for sign in (1, -1)] == ["x", "1"]
    for system in SIGNED.values():
        assert check(fixed_spectrum(system), input_filters(system)).valid


def looped(system: MultiChannelSystem, rng: random.Random) -> fmpq_poly:
    """det [xI − A, −B; −FC, I − FD] for drawn gains: det(I − FD) det(xI − A_F)."""
    n = system.n
    F = [
        [[fmpq(rng.randint(-9, 9)) for _ in range(system.q(i))] for _ in range(system.p(i))]
        for i in range(system.m)
    ]
    p, q = sum(a for a, _ in system.sizes), sum(b for _, b in system.sizes)
    gain = fmpq_mat(p, q)
    row = column = 0
    for i in range(system.m):
        for k in range(system.p(i)):
            for j in range(system.q(i)):
                gain[row + k, column + j] = F[i][k][j]
        row, column = row + system.p(i), column + system.q(i)
    inner = -(gain * rational(system.feedthrough_matrix(), q, p))
    for k in range(p):
        inner[k, k] = inner[k, k] + 1
    if inner.det() == 0:
        return fmpq_poly([0])
    back = inner.inv() * gain * rational(system.output_matrix(), q, n)
    return (rational(system.A, n, n) + rational(system.input_matrix(), n, p) * back).charpoly()


def in_all_loops(system: MultiChannelSystem, rng: random.Random) -> fmpq_poly:
    """The greatest common divisor of the loops with drawn static gains."""
    common = fmpq_poly([0])
    for _ in range(6):
        common = common.gcd(looped(system, rng))
    return common


def test_the_fixed_polynomial_is_that_of_well_posed_static_loops() -> None:
    """With multiplicities, and of the plant itself on one side, without any filters."""
    rng, often = random.Random(3), 0
    for system in all_drawn(200, seed=11):
        common = in_all_loops(system, rng)
        assert common == in_all_loops(input_filters(system), rng), system.to_dict()
        assert {str(fmpq_poly(p)) for p, _ in common.numer().factor()[1]} == {
            str(fmpq_poly(fmpq_poly(p).numer())) for p in map(fmpq_poly_of, found(system))
        }
        often += common.degree() > len(found(system))
    assert often > 0


def found(system: MultiChannelSystem) -> list[mcexact.Polynomial]:
    """The irreducible factors of the fixed spectrum."""
    factors = fixed_spectrum(system).factors
    return [p for factor in factors for p, _ in factor.polynomial.factor()]


def fmpq_poly_of(p: mcexact.Polynomial) -> fmpq_poly:
    """The polynomial as one of flint."""
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in p.coefficients])


def test_edges_are_those_of_the_feedthrough_and_of_markov_parameters() -> None:
    for system in all_drawn(200, seed=5):
        markov = [
            (j, i)
            for j in range(system.m)
            for i in range(system.m)
            if not system.feedthrough(i, j).is_zero()
            or any(
                not (system.C(i) @ system.A.power(k) @ system.B(j)).is_zero()
                for k in range(system.n)
            )
        ]
        names = system.names
        own = {(j, j) for j in range(system.m) if system.p(j)}
        expected = {(names[j], names[i]) for j, i in {*markov, *own}}
        assert set(transfer_graph(system).arcs) == expected


def test_joint_modes_are_those_without_feedthrough() -> None:
    for system in all_drawn(100, seed=6):
        bare = MultiChannelSystem(system.A, list(system.B), list(system.C), time=system.time)
        for decide in (joint_controllability, joint_observability):
            known = decide(bare).uncontrollable_polynomial
            assert decide(system).uncontrollable_polynomial == known
            assert decide(input_filters(system)).uncontrollable_polynomial == known
            assert check(decide(system), system).valid


def test_set_points_need_the_rank_of_all_four_matrices() -> None:
    solvable = 0
    for system in all_drawn(150, seed=8):
        n, (p, q) = system.n, map(sum, zip(*system.sizes, strict=True))
        one = mcexact.Matrix.identity(n) * int(system.time == "discrete")
        blocks = [
            a + b
            for a, b in (
                *zip((system.A - one).tolist(), system.input_matrix().tolist(), strict=True),
                *zip(
                    system.output_matrix().tolist(),
                    system.feedthrough_matrix().tolist(),
                    strict=True,
                ),
            )
        ]
        cells = [fmpq(x.numerator, x.denominator) for row in blocks for x in row]
        rank = fmpq_mat(n + q, n + p, cells).rref()[1]
        answer = setpoint_solvability(system)
        assert answer.solvable == (rank == n + q)
        solvable += answer.solvable
        assert check(answer).valid
    assert 0 < solvable < 150


def test_complete_is_a_connected_graph_without_fixed_modes() -> None:
    seen = set()
    for system in all_drawn(150, seed=9):
        connected = transfer_graph(system).strongly_connected
        expected = connected and not fixed_by_enumeration(system)
        assert completeness(system).complete == expected
        seen.add(expected)
    assert seen == {True, False}


def test_constructions_and_filters_change_places() -> None:
    """Of the channels alone, and of what neighbors receive, by plain lists of numbers."""
    plant = MultiChannelSystem(
        [[1]],
        [[[1]], [[2]], [[3]]],
        [[[4]], [[5]], [[6]]],
        D=[[11, 12, 13], [21, 22, 23], [31, 32, 33]],
        neighbors={"1": ["2"], "2": [], "3": ["1", "2"]},
    )
    alone = mcexact.constructions.restricted(plant, ["3", "1"])
    assert alone.D is not None and alone.D.tolist() == [[11, 13], [31, 33]]
    together = mcexact.constructions.merged(plant, [["1", "3"], ["2"]])
    assert together.D is not None
    assert together.D.tolist() == [[11, 13, 12], [31, 33, 32], [21, 23, 22]]
    heard = mcexact.constructions.augmented_outputs(plant)
    assert heard.feedthrough(0, 1).tolist() == [[12], [22]]
    assert heard.feedthrough(2, 0).tolist() == [[11], [21], [31]]
    assert mcexact.constructions.dual(plant).feedthrough(0, 1).tolist() == [[21]]
    picked = mcexact.constructions.regulated_outputs(plant, [[[2]], [], [[1], [-1]]])
    assert picked.D is not None
    assert picked.D.tolist() == [[22, 24, 26], [31, 32, 33], [-31, -32, -33]]
    assert add_links(plant, [(2, 1)]).D == plant.D
    filtered = input_filters(plant)
    assert filtered.D is None and filtered.neighbors == plant.neighbors
    assert filtered.A.tolist() == [[1, 1, 2, 3], *[[0] * 4] * 3]
    assert filtered.B(1).tolist() == [[0], [0], [1], [0]]
    assert filtered.C(2).tolist() == [[6, 31, 32, 33], [0, 0, 0, 1]]


def test_filters_of_a_system_without_feedthrough_change_no_fixed_mode() -> None:
    for system in all_drawn(60, seed=10):
        bare = MultiChannelSystem(system.A, list(system.B), list(system.C), time=system.time)
        assert without_feedthrough(bare) is bare
        assert fixed_spectrum(input_filters(bare)).polynomial == fixed_spectrum(bare).polynomial


# Who takes feedthrough, and who refuses it: nobody ignores it.

CARRIED = {
    "arcs": lambda s: add_links(s, [(0, 1)]),
    "augmented_outputs": mcexact.constructions.augmented_outputs,
    "closed_loop": lambda s: closed_loop(s, local_controllers(s, [[[1]], [[1]]])).system,
    "dual": mcexact.constructions.dual,
    "failed": lambda s: mcexact.constructions.failed(s, sensors=[("1", 1)]),
    "input_filters": input_filters,
    "internal_model": lambda s: mcexact.constructions.internal_model(s, "sine:1"),
    "merged": lambda s: mcexact.constructions.merged(s, [["1"], ["2"]]),
    "modulo": lambda s: without_part(s, "uncontrollable", [[1, -1]]),
    "regulated": lambda s: mcexact.constructions.regulated_outputs(s, [[[1]], [[2]]]),
    "restricted": lambda s: mcexact.constructions.restricted(s, ["1"]),
}
REFUSED = {
    "error": lambda s: mcexact.constructions.error_system(s, [[[1, 1]], [[1, 1]]]),
    "extended": lambda s: mcexact.constructions.extended_system(s, [1, 0]),
    "feedback": lambda s: feedback(s, [[[1]], [[1]]]),
    "full_output": lambda s: full_output(s, 0),
    "held": lambda s: mcexact.constructions.held_system(s, [1, 0]),
    "integrators": mcexact.constructions.setpoint_system,
    "lifted": lambda s: mcexact.constructions.lifted_system(s, [1, 0]),
    "periodic_loop": lambda s: periodic_loop(
        s, PeriodicController((local_controllers(s, [[[1]], [[1]]]),))
    ),
    "sampled": lambda s: mcexact.constructions.sampled_system(s, Fraction(1, 10)),
    "servo": lambda s: mcexact.constructions.servo_system(s, [[[1]], [[1]]]),
    "slow": lambda s: mcexact.constructions.slow_system(s, 4),
}
DISCRETE = {"held", "lifted", "periodic_loop", "slow"}
TAKEN = {
    *("analyze", "assignability", "complementary_subsystem", "completeness", "fixed_spectrum"),
    *("controllability_indices", "joint_controllability", "joint_observability", "modulo"),
    *("local_controllers", "minimal_realization", "observability_indices", "pencil_rank"),
    *(
        "certify_controller",
        "fewest_failures",
        "simulate",
        "pencil_ranks",
        "save_system",
        "setpoint_solvability",
        "transfer_graph",
        "without_part",
    ),
    *(
        "augmented_outputs",
        "closure",
        "dual",
        "failed",
        "failures",
        "input_filters",
        "internal_model",
        "merged",
    ),
    *("regulated_outputs", "restricted"),
}
"""The public functions of systems with feedthrough."""


def of_systems() -> dict[str, Any]:
    """The public functions whose first argument is a system, by name."""
    found = {}
    for name, public in PUBLIC.items():
        if inspect.isfunction(public):
            first = next(iter(inspect.signature(public).parameters.values()), None)
            if first is not None and "MultiChannelSystem" in str(first.annotation):
                found[name] = public
    return found


def with_feedthrough(time: str = "continuous") -> MultiChannelSystem:
    """Two states and two channels, of which nothing is 0."""
    return MultiChannelSystem(
        [[1, 0], [0, 1]],
        [[[1], [1]], [[2], [2]]],
        [[[1, 2]], [[3, 4]]],
        D=[[1, 2], [3, 4]],
        time=time,
        neighbors={"1": ["2"], "2": []},
    )


@pytest.mark.parametrize("name", sorted(CARRIED))
def test_the_checker_carries_feedthrough_as_the_package_does(name: str) -> None:
    made = CARRIED[name](with_feedthrough())
    ours = read_subject(plain(made.subject), read_plant(made.canonical_document()))
    assert (ours.D is None) == (made.D is None) == (name in ("closed_loop", "input_filters"))
    if ours.D is not None and made.D is not None:
        assert ours.D.denominator == 1 and ours.D.rows == made.D.tolist()


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_a_construction_that_does_not_carry_feedthrough_refuses_it(name: str) -> None:
    system = with_feedthrough("discrete" if name in DISCRETE else "continuous")
    with pytest.raises(InputError, match="system without feedthrough"):
        REFUSED[name](system)
    bare = MultiChannelSystem(
        system.A, list(system.B), list(system.C), time=system.time, neighbors=system.neighbors
    )
    steps = plain(REFUSED[name](bare).subject)
    with pytest.raises(Refused) as found:
        read_subject(steps, read_plant(system.canonical_document()))
    assert found.value.args[:3] == ("INCOMPLETE", "feedthrough", "subject[0]")


def test_every_public_function_takes_feedthrough_or_refuses_it() -> None:
    assert of_systems().keys() > TAKEN
    for name in sorted(of_systems().keys() - TAKEN):
        public = of_systems()[name]
        others = list(inspect.signature(public).parameters.values())[1:]
        needed = {each.name: None for each in others if each.default is each.empty}
        with pytest.raises(InputError, match="system without feedthrough"):
            public(with_feedthrough(), **needed)


def test_an_answer_about_a_system_with_feedthrough_is_not_made() -> None:
    """Also where a function forgot to refuse it."""
    bare = fixed_spectrum(MultiChannelSystem([[1]], [[[1]]], [[[1]]]))
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], D=[[1]])
    with pytest.raises(InputError, match="system without feedthrough"):
        replace(bare, about=plant)


def test_radii_are_refused_beside_feedthrough() -> None:
    plant = with_feedthrough()
    radii = mcexact.boxes.Box.relative(MultiChannelSystem(plant.A, list(plant.B), list(plant.C)), 1)
    with pytest.raises(InputError, match="radii"):
        plant.with_uncertainty(radii.system.uncertainty)


def test_every_construction_carries_feedthrough_or_refuses_it_by_name() -> None:
    assert CARRIED.keys() == constructions.CARRIED
    assert CARRIED.keys() | REFUSED.keys() == constructions.CONSTRUCTIONS.keys()
