"""What drawn systems claim about themselves, held against enumeration."""

import itertools
from collections import Counter
from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings

from mcexact import testing
from mcexact.derived.constructions import augmented_outputs
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices, irreducible
from mcexact.derived.drawn.systems import (
    Draw,
    Drawn,
    any_system,
    drawn_system,
    incomplete_system,
    jointly_controllable_system,
    sparse_system,
    system_with_deficiency,
    system_with_fixed_mode,
    system_with_indices,
    system_with_remnant,
    uncontrollable_system,
)
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import hstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from tests.oracle import enumeration as oracle


def holds(drawn: Drawn) -> None:
    """Hold every claim of a drawn system against the slow oracle."""
    plain = oracle.plain(drawn.system)
    n = plain.n
    if drawn.jointly_controllable is not None:
        assert drawn.jointly_controllable == (oracle.controllable_dimension(plain) == n)
    if drawn.jointly_observable is not None:
        assert drawn.jointly_observable == (oracle.controllable_dimension(plain.dual) == n)
    if drawn.fixed_modes is not None:
        assert drawn.fixed_modes == bool(oracle.fixed_factors(plain))
    if drawn.fixed_mode is not None:
        p = drawn.fixed_mode.coefficients
        assert drawn.fixed_mode.is_irreducible() and drawn.fixed_mode.leading == 1
        assert oracle.pencil_rank(plain, drawn.subset, p) < n
        assert oracle.least_multiplicity(plain, p) >= drawn.multiplicity
    if drawn.complete is not None:
        assert drawn.complete == oracle.is_complete(plain)


@given(testing.systems())
def test_every_kind_of_drawn_system_is_what_it_claims(drawn):
    holds(drawn)


@given(testing.jointly_controllable_systems(inactive_channels=True, denominators=True))
def test_minimal_systems_are_jointly_controllable_and_observable(drawn):
    assert drawn.jointly_controllable and drawn.jointly_observable
    holds(drawn)


@given(testing.systems_with_fixed_mode())
def test_a_planted_fixed_mode_is_one(drawn):
    assert drawn.fixed_mode is not None
    holds(drawn)


@given(testing.uncontrollable_systems(observable_side=True))
def test_a_mode_that_nobody_sees_is_fixed(drawn):
    assert drawn.jointly_observable is False
    holds(drawn)


@given(testing.incomplete_systems(max_states=4))
def test_incomplete_systems_are_incomplete_for_the_given_reason(drawn):
    holds(drawn)


@given(testing.incomplete_systems(max_states=4, reason="transfer graph"))
def test_an_incomplete_transfer_graph_comes_without_fixed_modes(drawn):
    assert drawn.fixed_modes is False
    edges = oracle.transfer_arcs(oracle.plain(drawn.system))
    assert not [(j, i) for j, i in edges if i in drawn.subset and j not in drawn.subset]


@given(testing.systems_with_indices())
def test_the_prescribed_indices_are_the_brunovsky_indices(drawn):
    holds(drawn)
    A, B = drawn.system.A, drawn.system.input_matrix()
    ranks, blocks = [0], []
    for k in range(drawn.system.n):
        blocks.append(A.power(k) @ B)
        ranks.append(rank(hstack(blocks)))
    steps = [b - a for a, b in itertools.pairwise(ranks)]
    conjugate = [sum(step > k for step in steps) for k in range(max(steps))]
    assert drawn.indices == tuple(conjugate)


@settings(max_examples=15)
@given(testing.systems_with_remnant(max_states=4, max_channels=2))
def test_the_prescribed_remnant_polynomial_is_the_gcd_of_the_minors(drawn):
    holds(drawn)
    assert remnant_by_minors(drawn) == drawn.remnant


def remnant_by_minors(drawn: Drawn) -> Polynomial:
    """The greatest common divisor of all n×n minors of P_s."""
    x = sympy.Symbol("x")
    system, s = drawn.system, drawn.subset
    T = [i for i in range(system.m) if i not in s]

    def rational(M):
        return sympy.Matrix(M.nrows, M.ncols, [sympy.Rational(e) for r in M.rows() for e in r])

    n = system.n
    upper = (x * sympy.eye(n) - rational(system.A)).row_join(rational(system.input_matrix(T)))
    C = rational(system.output_matrix(s))
    P = upper.col_join(C.row_join(sympy.zeros(C.rows, upper.cols - n)))
    found = sympy.Poly(0, x)
    for rows in itertools.combinations(range(P.rows), n):
        for columns in itertools.combinations(range(P.cols), n):
            minor = P.extract(list(rows), list(columns)).det(method="berkowitz")
            found = sympy.gcd(found, sympy.Poly(minor, x))
            if found.degree() == 0:
                return Polynomial.of(1)
    coefficients = reversed(found.monic().all_coeffs())
    return Polynomial(tuple(Fraction(int(c.p), int(c.q)) for c in coefficients))


@pytest.mark.parametrize("degree", [1, 2, 3, 7])
def test_drawn_polynomials_are_irreducible(degree):
    for seed in range(20):
        coefficients = irreducible(SeededChoices(seed), degree)
        p = Polynomial(tuple(Fraction(c) for c in coefficients))
        assert p.degree == degree and p.leading == 1 and p.is_irreducible()


def test_a_good_share_of_sparse_systems_has_fixed_modes_or_is_uncontrollable():
    seen = Counter()
    for seed in range(60):
        plain = oracle.plain(sparse_system(SeededChoices(seed), 3, 2).system)
        seen["fixed"] += bool(oracle.fixed_factors(plain))
        seen["uncontrollable"] += oracle.controllable_dimension(plain) < 3
        seen["inactive"] += any(not any(map(any, rows)) for rows in (*plain.B, *plain.C))
    assert all(5 < count < 60 for count in seen.values()) and len(seen) == 3


@pytest.mark.parametrize("degree", [1, 3])
def test_a_large_planted_system_is_mixed_and_has_small_integers(degree):
    drawn = system_with_fixed_mode(SeededChoices(1), 80, 40, degree)
    A = drawn.system.A
    entries = [abs(entry) for row in A.numerators for entry in row]
    assert A.denominator == 1 and max(entries) < 100
    assert sum(map(bool, entries)) > 80 * 40
    assert drawn.fixed_mode.degree == degree
    assert drawn.fixed_mode.multiplicity_in(characteristic_polynomial(A)) >= drawn.multiplicity


def test_the_same_seed_draws_the_same_system_and_another_seed_another():
    first, second, other = (any_system(SeededChoices(s), 4, 3).system for s in (5, 5, 6))
    assert first == second != other


def test_systems_without_states_are_drawn():
    assert jointly_controllable_system(SeededChoices(0), 0, 2).system.n == 0
    assert any_system(SeededChoices(0), 0, 1).system.m == 1


@given(testing.neighbor_graphs(("a", "b", "c", "d"), strongly_connected=True, longest_delay=3))
def test_graphs_that_are_to_be_strongly_connected_are(graph):
    assert graph.is_strongly_connected()
    assert all(1 <= d <= 3 for _, _, d in graph.delays)


@given(testing.neighbor_graphs(("a", "b", "c", "d"), strongly_connected=False))
def test_graphs_that_are_not_to_be_strongly_connected_are_not(graph):
    assert not graph.is_strongly_connected()


def test_strongly_connected_graphs_without_a_cycle_through_everybody_are_drawn_too():
    found = {drawn_graph(SeededChoices(seed), ("a", "b", "c"), True).edges() for seed in range(200)}
    assert ((0, 1), (0, 2), (1, 0), (2, 0)) in found


@given(testing.systems_on_graphs(longest_delay=2))
def test_systems_on_graphs_carry_them(drawn):
    assert drawn.system.neighbors is not None and drawn.system.time == "discrete"


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda c: system_with_fixed_mode(c, 3, 1), "at least 2 channels"),
        (lambda c: system_with_fixed_mode(c, 1, 2, 2), "needs at least 2 states"),
        (lambda c: jointly_controllable_system(c, -1, 2), "at least 0 states and 1 channel"),
        (lambda c: uncontrollable_system(c, 0, 2), "without states"),
        (lambda c: system_with_indices(c, [0], 1), "indices >= 1"),
        (lambda c: system_with_remnant(c, 2, 2), "at least 2 channels and 3 states"),
        (lambda c: incomplete_system(c, 1, 2, "transfer graph"), "2 channels and 2 states"),
        (lambda c: incomplete_system(c, 3, 2, "bad luck"), '"fixed mode" or "transfer graph"'),
        (lambda c: drawn_graph(c, ("1",), False), "one agent is strongly connected"),
        (lambda c: irreducible(c, 0), "degree >= 1"),
    ],
)
def test_what_cannot_be_drawn_is_refused(draw, message):
    with pytest.raises(UsageError, match=message):
        draw(SeededChoices(0))


def least_ranks(drawn: Drawn, share: str) -> int:
    """n minus the least rank of the bound's pencils, by enumeration."""
    system = drawn.system
    assert system.neighbors is not None
    plain = oracle.plain(system if share == "states" else augmented_outputs(system))
    factors = [p.coefficients for p, _ in characteristic_polynomial(system.A).factor()]
    subsets = [s for k in range(1, system.m) for s in itertools.combinations(range(system.m), k)]
    return system.n - min(oracle.pencil_rank(plain, s, p) for s in subsets for p in factors)


@settings(max_examples=12)
@given(testing.systems_with_deficiency(2, digits=3))
def test_a_deficient_system_has_the_bound_that_it_claims(drawn):
    assert drawn.system.neighbors.is_strongly_connected()
    assert all(not c.B.is_zero() and not c.C.is_zero() for c in drawn.system.channels)
    p = drawn.fixed_mode
    assert p.is_irreducible()
    bounds = [least_ranks(drawn, share) for share in ("states", "outputs+states")]
    assert drawn.deficiency in bounds


@pytest.mark.parametrize("share", ["states", "outputs+states"])
@pytest.mark.parametrize("bound", [1, 2, 3])
def test_a_deficient_system_attains_its_bound_for_the_way_of_sharing(bound, share):
    drawn = system_with_deficiency(SeededChoices(bound), bound, share=share)
    assert least_ranks(drawn, share) == drawn.deficiency == bound
    holds(drawn)


def test_the_transfer_matrix_of_a_deficient_system_is_zero_only_if_that_is_asked_for():
    for seed, transfer in itertools.product(range(4), (True, False)):
        drawn = system_with_deficiency(SeededChoices(seed), 1, transfer=transfer)
        shared = augmented_outputs(drawn.system)
        B = shared.input_matrix(i for i in range(3) if i not in drawn.subset)
        C = shared.output_matrix(drawn.subset)
        markov = [C @ shared.A.power(k) @ B for k in range(shared.n)]
        assert any(not each.is_zero() for each in markov) == transfer


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_a_stable_deficient_system_has_all_eigenvalues_in_the_stability_region(time):
    drawn = system_with_deficiency(SeededChoices(3), 1, degree=2, stable=True, time=time)
    assert StabilityRegion.of(time).contains_roots_of(characteristic_polynomial(drawn.system.A))


@pytest.mark.parametrize(
    "wrong",
    [{"channels": 2}, {"share": "inputs"}, {"degree": 3}, {"boundary": 0}, {"deficiency": 0}],
)
def test_a_deficient_system_that_cannot_be_is_refused(wrong):
    options = {"deficiency": 1, **wrong}
    with pytest.raises(UsageError):
        system_with_deficiency(SeededChoices(0), options.pop("deficiency"), **options)


def test_a_draw_prescribes_a_bound_or_a_fixed_mode():
    assert drawn_system(Draw(seed=1, channels=3, deficiency=2)).neighbors is not None
    with pytest.raises(UsageError, match="give one"):
        drawn_system(Draw(seed=1, channels=3, deficiency=2, fixed_degree=1))
