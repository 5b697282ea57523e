"""The part that counts, against enumeration over all sets of channels, on drawn systems."""

import random
from fractions import Fraction

import pytest
from hypothesis import given

from mcexact import testing
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.modulo import MinimalRealization, minimal_realization, modulo
from mcexact.answer.check import check
from mcexact.derived.modulo import parts_of
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import product
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from tests.oracle import enumeration
from tests.oracle.draws import exact, sparse_system
from tests.wording import says

SEEDS = 600
"""The number of drawn systems that are compared with enumeration."""


def drawn(seed):
    """A small system; many have fixed modes, and states that are not controlled or observed."""
    return sparse_system(random.Random(seed))


def polynomial_of(system):
    """The characteristic polynomial of everything that was left out."""
    return product(each.polynomial for each in parts_of(system))


def parameters(system, count):
    """The Markov parameters C A^k B of all channels together, as plain rows."""
    B, C = system.input_matrix(), system.output_matrix()
    found = []
    for _ in range(count):
        found.append((C @ B).rows())
        B = system.A @ B
    return found


def order_by_hankel(system):
    """The least number of states of any system with this transfer matrix."""
    n = max(system.n, 1)
    markov = parameters(system, 2 * n)
    rows = [
        [x for j in range(n) for x in markov[i + j][row]]
        for i in range(n)
        for row in range(len(markov[0]))
    ]
    return enumeration.rank(rows) if rows and rows[0] else 0


@pytest.mark.parametrize("first", range(0, SEEDS, 100))
def test_fixed_modes_split_into_those_of_the_parts_and_those_of_the_rest(first):
    """With multiplicities, for each part and for both; against enumeration over all F and s."""
    split = 0
    for seed in range(first, first + 100):
        plain = drawn(seed)
        system = exact(plain, "discrete" if seed % 2 else "continuous")
        for part in ("unobservable", "uncontrollable", "both"):
            left = modulo(system, part)
            if left is system:
                continue
            split, rest, gone = split + 1, enumeration.plain(left), polynomial_of(left)
            assert left.n + gone.degree == system.n
            for p in enumeration.irreducible_factors(
                enumeration.characteristic_polynomial(plain.A)
            ):
                joint = enumeration.multiplicity(p, tuple(gone.coefficients))
                own = enumeration.least_multiplicity(rest, p, seed) if left.n else 0
                assert enumeration.least_multiplicity(plain, p, seed) == joint + own, (seed, part)
    assert split > 20


@pytest.mark.parametrize("first", range(0, SEEDS, 100))
def test_what_is_left_of_both_is_minimal_and_has_the_same_transfer_matrix(first):
    smaller = 0
    for seed in range(first, first + 100):
        system = exact(drawn(seed))
        made = minimal_realization(system)
        assert made.order == order_by_hankel(system), seed
        assert parameters(made.system, 2 * system.n) == parameters(system, 2 * system.n)
        assert made.controllability.controllable and made.observability.observable
        assert made.T @ made.S == Matrix.identity(made.order)
        assert made.T @ system.A @ made.S == made.system.A
        assert [made.T @ B for B in system.B] == list(made.system.B)
        assert [C @ made.S for C in system.C] == list(made.system.C)
        smaller += made.order < system.n
    assert smaller > 20


@given(testing.jointly_controllable_systems(max_states=4, max_channels=3))
def test_a_plant_that_is_controlled_and_observed_stays_as_it_is(drawn):
    for part in ("unobservable", "uncontrollable", "both"):
        assert modulo(drawn.system, part) is drawn.system


@given(testing.systems_with_joint_modes())
def test_the_part_that_was_added_to_a_plant_is_found(drawn):
    assert minimal_realization(drawn.system).order == drawn.order
    assert polynomial_of(modulo(drawn.system, "both")) == drawn.left_out


def test_certificates_about_the_rest_are_valid():
    checked = 0
    for seed in range(40):
        system = exact(drawn(seed))
        made = minimal_realization(system)
        for answer in (made.controllability, made.observability, fixed_spectrum(made.system)):
            assert check(answer, None if made.order == system.n else made.system).valid or (
                answer.about.subject[-1]["construction"] == "dual"
            )
            assert check(answer).valid
            checked += 1
    assert checked == 120


def test_only_what_lies_in_both_parts_is_counted_once():
    """diag(1, 2, 3, 4): 1 counts; 2 is not observed, 3 not controlled, 4 neither."""
    system = MultiChannelSystem(
        [[k if i == j else 0 for j in range(4)] for i, k in enumerate((1, 2, 3, 4))],
        [[[1], [1], [0], [0]]],
        [[[1, 0, 1, 0]]],
    )
    made = minimal_realization(system)
    assert made.order == 1
    assert [(each.part, str(each.polynomial)) for each in made.left_out] == [
        ("uncontrollable", "x^2 - 7*x + 12"),
        ("unobservable", "x - 2"),
    ]
    assert str(modulo(system).A.rows()) == str(
        ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(3)))
    )


def test_the_joint_mode_of_integrators_goes_and_the_rest_is_free():
    plant = gallery.load("relative-positions-4")
    assert str(fixed_spectrum(plant).polynomial) == "x"
    relative = modulo(plant)
    assert relative.n == 3 and fixed_spectrum(relative).empty
    own = modulo(plant, {"unobservable": [[3, 3, 3, 3]]})
    assert own.A == relative.A and own.subject == relative.subject


@pytest.mark.parametrize("name", ["swing-grid-four-buses", "formation-of-twelve"])
def test_nothing_is_fixed_modulo_what_grids_and_formations_have_in_common(name):
    plant = gallery.load(name)
    assert not fixed_spectrum(plant).empty
    assert fixed_spectrum(modulo(plant)).empty


def test_a_realization_says_what_it_is():
    made = minimal_realization(gallery.load("formation-of-twelve"))
    assert isinstance(made, MinimalRealization)
    assert repr(made) == "MinimalRealization(22 of 24 states)"
    assert says(made.explain(), "dimension characteristic")
    assert "22 of 24" in made._repr_html_()


def test_a_step_behind_another_construction_has_coordinates_of_its_own():
    system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])
    once = minimal_realization(system).system
    again = minimal_realization(once)
    assert again.T == Matrix.identity(1) and again.left_out == ()


@pytest.mark.parametrize(
    ("part", "message"),
    [
        ("hidden", "unobservable"),
        ({}, "expected one subspace"),
        ({"unobservable": [[1] * 4], "uncontrollable": [[1] * 4]}, "expected one subspace"),
        ({"both": [[1] * 4]}, "unobservable"),
        ({"unobservable": [[1, 0, 0, 0]]}, "no output shows"),
    ],
)
def test_what_is_no_part_is_refused(part, message):
    with pytest.raises((InputError, UsageError), match=message):
        modulo(gallery.load("relative-positions-4"), part)


def realized(*columns):
    """One companion form beside the other for each entry (numerator, denominator) of columns."""
    entries = [(i, j, *each) for j, column in enumerate(columns) for i, each in column.items()]
    sizes = [len(den) - 1 for *_, den in entries]
    n, rows = sum(sizes), 1 + max(i for i, *_ in entries)
    A = [[Fraction(0)] * n for _ in range(n)]
    B = [[0] * len(columns) for _ in range(n)]
    C = [[Fraction(0)] * n for _ in range(rows)]
    start = 0
    for (i, j, num, den), size in zip(entries, sizes, strict=True):
        last = start + size - 1
        for k in range(size):
            if k:
                A[start + k - 1][start + k] = Fraction(1)
            A[last][start + k] = -Fraction(den[k], den[-1])
        B[last][j] = 1
        for k, c in enumerate(num):
            C[i][start + k] = Fraction(c, den[-1])
        start += size
    return MultiChannelSystem(A, [B], [C])


def times(p, q):
    """The product of two polynomials, constant terms first."""
    found = [0] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        for j, y in enumerate(q):
            found[i + j] += x * y
    return found


def test_two_public_reports_of_numerical_realizations_have_exact_orders():
    """ControlSystems.jl, issues 992 (5 of 7 states were left) and 890 (21 of 21), without D.

    The first is [W1, -W1 G; 0, W2; 0, W3 G; 1, -G], the second one has the entries s^k/(s - 1)^4
    for k = -1, 0, 1, 2, 3; each entry is realized by itself.
    """
    G, W1, W2, W3 = [3, 2], [6, 5], [9, 8], [12, 11]
    weights = realized(
        {0: ([4], W1)},
        {
            0: ([-4], times(W1, G)),
            1: ([7], W2),
            2: ([10], times(W3, G)),
            3: ([-1], G),
        },
    )
    fourth = times(times([-1, 1], [-1, 1]), times([-1, 1], [-1, 1]))
    powers = realized(
        {0: ([1], times([0, 1], fourth)), **{k + 1: ([0] * k + [1], fourth) for k in range(4)}}
    )
    for system, n, order in ((weights, 7, 4), (powers, 21, 5)):
        made = minimal_realization(system)
        assert (system.n, made.order, order_by_hankel(system)) == (n, order, order)
        assert check(made.controllability).valid and check(made.observability).valid
        assert parameters(made.system, 2 * n) == parameters(system, 2 * n)
