"""The checker's arithmetic beside sympy's, and modulo numbers that are not prime."""

from __future__ import annotations

import itertools
import math
import random
from fractions import Fraction

import pytest
from sympy import QQ, ZZ, isprime
from sympy.polys.matrices import DomainMatrix

from mcexact.checker.core import arithmetic as characteristic
from mcexact.checker.core.arithmetic import (
    Echelon,
    Matrix,
    NotAUnit,
    banded_pivots,
    banded_rank,
    characteristic_polynomial,
    characteristic_polynomial_modulo,
    coprime,
    exponent,
    poly_divide,
    poly_product,
    rank,
)


def drawn(rng: random.Random, nrows: int, ncols: int, size: int) -> Matrix:
    """Small entries, many zeros, some rows repeated."""
    rows = [
        [rng.choice([0, 0, rng.randint(-size, size)]) for _ in range(ncols)] for _ in range(nrows)
    ]
    for i in range(1, nrows):
        if rng.random() < 0.2:
            rows[i] = list(rows[i - 1])
    return Matrix(rows, ncols, rng.choice([1, 1, 6]))


def test_characteristic_polynomials_over_q_are_sympys() -> None:
    rng = random.Random(1)
    for _ in range(150):
        n = rng.randint(0, 6)
        A = drawn(rng, n, n, rng.choice([1, 3, 10**30]))
        expected = DomainMatrix(A.rows, (n, n), ZZ).charpoly()[::-1] if n else [1]
        scaled = [Fraction(int(c), A.denominator ** (n - k)) for k, c in enumerate(expected)]
        assert characteristic_polynomial(A) == scaled


def test_a_matrix_full_of_the_first_moduli_is_no_obstacle() -> None:
    q = characteristic.FIRST * (characteristic.FIRST - 2)
    A = Matrix([[0, 0, 1], [q, 0, 0], [q, q + 2, 1]], 3)
    expected = DomainMatrix(A.rows, (3, 3), ZZ).charpoly()[::-1]
    assert characteristic_polynomial(A) == [int(c) for c in expected]
    A = Matrix([[1, 0, 0], [0, q, 0], [0, 0, q]], 3, q)
    assert characteristic_polynomial(A) == poly_product([Fraction(-1, q), 1], [1, -2, 1])


@pytest.mark.parametrize("bits", [148, 149, 150, 297, 298, 299, 300, 449])
def test_coefficients_as_large_as_the_moduli_allow_are_read_off(bits: int) -> None:
    for sign, less in itertools.product((1, -1), (1, 2, 3)):
        number = sign * (2**bits - less)
        assert characteristic_polynomial(Matrix([[number]], 1)) == [-number, 1]


def moduli_of(A: Matrix, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The moduli that the characteristic polynomial over Q is combined from."""
    found: list[int] = []

    def recorded(rows: list[list[int]], ell: int) -> list[int]:
        found.append(ell)
        return characteristic_polynomial_modulo(rows, ell)

    with monkeypatch.context() as patch:
        patch.setattr(characteristic, "characteristic_polynomial_modulo", recorded)
        characteristic_polynomial(A)
    return found


def test_moduli_are_pairwise_coprime_of_5_limbs_and_as_many_as_needed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    moduli = moduli_of(Matrix([[2**60000]], 1), monkeypatch)
    assert len(moduli) == 60001 // 149 + 1
    assert all(2**149 < ell < 2**150 for ell in moduli)
    assert all(math.gcd(a, b) == 1 for a, b in itertools.combinations(moduli, 2))
    assert all(math.gcd(ell, math.factorial(1000)) == 1 for ell in moduli)
    assert moduli[:2] == [characteristic.FIRST, characteristic.FIRST - 2]
    assert isprime(moduli[0])


LONG = [3**400 + 2 * k for k in range(6)]
"""Denominators of 635 bits."""


@pytest.mark.parametrize(
    ("A", "moduli"),
    [
        ([[Fraction(i + j, LONG[i]) for j in range(6)] for i in range(6)], 26),
        ([[Fraction(i + j, LONG[j]) for j in range(6)] for i in range(6)], 26),
        ([[Fraction(i * i + j, LONG[0]) for j in range(6)] for i in range(6)], 1),
    ],
    ids=["rows of one denominator", "columns of one denominator", "one denominator"],
)
def test_the_sharpest_bound_decides_how_many_moduli_there_are(
    A: list[list[Fraction]], moduli: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    d = math.lcm(*(entry.denominator for row in A for entry in row))
    given = Matrix([[int(d * entry) for entry in row] for row in A], 6, d)
    assert len(moduli_of(given, monkeypatch)) == moduli
    expected = DomainMatrix(
        [[QQ(e.numerator, e.denominator) for e in row] for row in A], (6, 6), QQ
    )
    found = characteristic_polynomial(given)
    assert found == [
        Fraction(int(c.numerator), int(c.denominator)) for c in expected.charpoly()[::-1]
    ]


def test_moduli_are_looked_for_down_to_the_least(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(characteristic, "FIRST", 2003)
    A = Matrix([[2, 1], [1, 3]], 2)
    found = list(characteristic._residues(A))
    assert [ell for ell, _ in found] == [k for k in range(2003, 1000, -2) if isprime(k)]
    assert all(p == [5, ell - 5, 1] for ell, p in found)


def test_characteristic_polynomials_modulo_l_are_reductions_or_nothing() -> None:
    rng = random.Random(2)
    for _ in range(300):
        n, ell = rng.randint(0, 6), rng.choice([2, 3, 4, 6, 7, 35, 2**61 - 1])
        A = Matrix(drawn(rng, n, n, 3).rows, n)
        try:
            found = characteristic_polynomial_modulo(A.modulo(ell), ell)
        except NotAUnit:
            continue
        assert found == [int(c) % ell for c in characteristic_polynomial(A)]


def test_ranks_over_q_are_sympys() -> None:
    rng = random.Random(3)
    for _ in range(200):
        r, c = rng.randint(0, 6), rng.randint(0, 6)
        A = drawn(rng, r, c, 3)
        assert rank(A) == (
            DomainMatrix(A.rows, (r, c), ZZ).convert_to(ZZ.get_field()).rank() if r and c else 0
        )


def test_an_echelon_never_claims_more_than_the_rank() -> None:
    rng = random.Random(4)
    for _ in range(200):
        A, ell = drawn(rng, rng.randint(0, 5), 5, 5), rng.choice([2, 6, 7, 2**61 - 1])
        echelon = Echelon(ell)
        try:
            for row in A.rows:
                echelon.add([entry % ell for entry in row])
        except NotAUnit:
            pass
        assert len(echelon.rows) <= rank(A)


def test_division_and_exponents() -> None:
    p, f = [Fraction(-1), Fraction(1)], [Fraction(2), Fraction(0), Fraction(1)]
    power = poly_product(poly_product(p, p), f)
    assert exponent(p, power) == (2, f)
    assert exponent(f, p) == (0, p)
    assert poly_divide(power, [Fraction(2)])[1] == []
    assert poly_divide([3, 2, 1], [2, 1], 5) == ([0, 1], [3])
    assert poly_divide([1, 4, 3], [4, 3], 5) == ([0, 1], [1])
    halves = [Fraction(1), Fraction(5, 2), Fraction(1)], [Fraction(1), Fraction(2)]
    assert poly_divide(*halves) == ([Fraction(1), Fraction(1, 2)], [])
    assert poly_product(halves[1], [Fraction(1), Fraction(1, 2)]) == halves[0]
    assert poly_product([2, 1], [3, 1]) == [6, 5, 1]
    assert poly_product([Fraction(1, 2)], [Fraction(1, 3), Fraction(1)]) == [
        Fraction(1, 6),
        Fraction(1, 2),
    ]


def test_residues_are_between_0_and_l() -> None:
    quotient, rest = poly_divide([6, 6, 6, 6], [3, 5], 7)
    assert all(0 <= entry < 7 for entry in (*quotient, *rest))
    echelon = Echelon(7)
    assert echelon.add([0, 3, 6]) == [0, 1, 2]
    assert echelon.rows == [(1, [0, 1, 2])]
    assert echelon.add([0, 5, 3]) is None
    assert characteristic_polynomial_modulo([[5, 6, 4], [3, 2, 6], [1, 5, 6]], 7)[-1] == 1
    for rows in itertools.product((0, 5), repeat=9):
        A = [list(rows[k : k + 3]) for k in (0, 3, 6)]
        assert all(0 <= c < 7 for c in characteristic_polynomial_modulo(A, 7))


def test_matrices_that_do_not_fit_have_no_product() -> None:
    A = Matrix([[1, 2, 3], [4, 5, 6]], 3)
    for B, nrows in ((A, 2), (Matrix([[1]] * 4, 1), 4)):
        with pytest.raises(ValueError, match=f"no product of 3 columns and {nrows} rows"):
            A @ B
    assert (A @ A.T).rows == [[14, 32], [32, 77]]


def test_a_matrix_makes_others_of_any_shape() -> None:
    A = Matrix([[1]], 1)
    assert A.zeros(2, 3).rows == [[0, 0, 0], [0, 0, 0]]
    assert A.unit_rows(3, 1, 2).rows == [[0, 1, 0], [0, 0, 1]]


def test_a_column_of_zeros_does_not_end_an_elimination() -> None:
    assert rank(Matrix([[0, 1, 1], [0, 0, 1]], 3)) == 2
    assert rank(Matrix([[2, 4, 0], [1, 2, 5]], 3)) == 2


def test_coprime_modulo_a_composite_number_needs_units() -> None:
    assert coprime([0, 1], [1, 1], 6)
    assert not coprime([0, 1], [0, 1], 6)
    with pytest.raises(NotAUnit):
        coprime([0, 1], [2, 1], 6)
    with pytest.raises(NotAUnit):
        Matrix([[1]], 1, 3).modulo(6)


@pytest.mark.parametrize("ell", [2, 3, 7, 31, 61])
def test_ranks_in_a_band_are_those_of_an_echelon(ell: int) -> None:
    rng = random.Random(ell)
    deficient = 0
    for _ in range(60):
        nrows, ncols, width = rng.randint(0, 30), rng.randint(1, 30), rng.randint(1, 30)
        rows = [[0] * ncols for _ in range(nrows)]
        for row in rows:
            middle = rng.randrange(ncols)
            for j in range(max(0, middle - width), min(ncols, middle + width)):
                row[j] = rng.randrange(ell) if rng.random() < 0.4 else 0
        if nrows > 2:  # one row depends on others
            rows[0] = [(a + 2 * b) % ell for a, b in zip(rows[1], rows[2], strict=True)]
        entries = [(i, j, x) for i, row in enumerate(rows) for j, x in enumerate(row) if x]
        basis = Echelon(ell)
        expected = sum(basis.add(row) is not None for row in rows)
        deficient += expected < min(nrows, ncols)
        assert banded_rank(entries, nrows, ncols, ell) == expected
    assert deficient > 20


@pytest.mark.parametrize("ell", [7, 31, 61])
def test_a_band_of_many_rows_that_all_meet_keeps_its_bytes_apart(ell: int) -> None:
    """Bytes that run over into others make the rank larger, as no row depends on others then."""
    n, r, rng = 80, 45, random.Random(ell)
    left = [[rng.choice([1, ell - 1]) for _ in range(r)] for _ in range(n)]
    right = [[rng.choice([1, ell - 1]) for _ in range(n)] for _ in range(r)]
    columns = list(zip(*right, strict=True))
    entries = [
        (i, j, sum(a * b for a, b in zip(left[i], columns[j], strict=True)) % ell)
        for i in range(n)
        for j in range(n)
    ]
    assert 40 <= banded_rank(entries, n, n, ell) <= r


@pytest.mark.parametrize("ell", [2, 7, 61])
def test_pivots_in_a_band_count_the_ranks_of_the_first_turns(ell: int) -> None:
    rng, late = random.Random(ell), 0
    for _ in range(60):
        ncols, turns, width = rng.randint(1, 30), rng.randint(1, 5), rng.randint(1, 12)
        starting: list[list[tuple[int, int]]] = [[] for _ in range(ncols)]
        rows: list[tuple[int, list[int]]] = []
        for _ in range(rng.randint(0, 30)):
            first, turn = rng.randrange(ncols), rng.randrange(turns)
            line = [0] * first + [rng.randrange(ell) for _ in range(first, ncols)]
            line[first + width :] = [0] * len(line[first + width :])
            rows.append((turn, line))
            starting[first].append((turn, int.from_bytes(bytes(line[first:]), "little")))
        expected, basis = [0] * turns, Echelon(ell)
        for turn, line in sorted(rows, key=lambda row: row[0]):
            expected[turn] += basis.add(line) is not None
        assert banded_pivots(starting, turns, ell) == expected
        late += sum(expected[1:])
    assert late > 100


def test_a_pivot_in_a_band_has_to_be_a_unit() -> None:
    assert banded_rank([(0, 0, 5), (1, 1, 7)], 2, 2, 6) == 2
    with pytest.raises(NotAUnit):
        banded_rank([(0, 0, 3)], 1, 1, 6)
