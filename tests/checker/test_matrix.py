"""The checker's matrices and polynomials beside plain lists of fractions."""

from __future__ import annotations

import itertools
import random
from fractions import Fraction

import pytest

from mcexact.checker.core.arithmetic import (
    BLOCK,
    SMALL,
    ByteEchelon,
    Echelon,
    Matrix,
    NotAUnit,
    beside,
    coprime,
    diagonal,
    echelon,
    exponent,
    inverse,
    poly_divide,
    poly_modulo,
    poly_product,
    product,
    rank,
    stack,
    stripped,
)

Plain = list[list[Fraction]]


def plain(M: Matrix) -> Plain:
    return [[Fraction(entry, M.denominator) for entry in row] for row in M.rows]


def drawn(rng: random.Random, nrows: int, ncols: int) -> Matrix:
    rows = [[rng.randint(-4, 4) for _ in range(ncols)] for _ in range(nrows)]
    return Matrix(rows, ncols, rng.choice([1, 2, 4, 6]))


SHAPES = list(itertools.product(range(4), repeat=2))


def test_shapes_are_kept_where_nothing_stands() -> None:
    for r, c in SHAPES:
        zero = Matrix.zeros(r, c)
        assert (zero.nrows, zero.ncols, zero.denominator) == (r, c, 1)
        assert zero.is_zero()
        assert (zero.T.nrows, zero.T.ncols) == (c, r)
        assert plain(zero @ Matrix.zeros(c, 2)) == [[0, 0]] * r
        assert (zero.times(Fraction(1, 3)).nrows, zero.times(Fraction(1, 3)).ncols) == (r, c)


def test_rows_of_the_identity() -> None:
    for n, start, size in ((3, 0, 3), (3, 1, 2), (3, 2, 1), (4, 1, 2), (3, 3, 0), (0, 0, 0)):
        found = Matrix.unit_rows(n, start, size)
        expected = [[Fraction(int(j == start + i)) for j in range(n)] for i in range(size)]
        assert (plain(found), found.nrows, found.ncols) == (expected, size, n)


def test_sums_products_and_multiples() -> None:
    rng = random.Random(11)
    for r, c in SHAPES:
        A, B, C = drawn(rng, r, c), drawn(rng, r, c), drawn(rng, c, 2)
        a, b, k = plain(A), plain(B), plain(C)
        pairs = [list(zip(x, y, strict=True)) for x, y in zip(a, b, strict=True)]
        assert plain(A + B) == [[x + y for x, y in row] for row in pairs]
        assert plain(A - B) == [[x - y for x, y in row] for row in pairs]
        assert plain(A.times(Fraction(-3, 5))) == [[Fraction(-3, 5) * x for x in row] for row in a]
        columns = list(zip(*k, strict=True)) if k else [()] * 2
        dots = [[sum(map(lambda x, y: x * y, row, col)) for col in columns] for row in a]
        assert plain(A @ C) == dots
        assert (A @ C).ncols == 2
        assert plain(A.T) == [[row[j] for row in a] for j in range(c)]
        assert A.is_zero() == (not any(map(any, a)))
        assert A.equals(B) == (a == b)
        assert A.equals(Matrix([[3 * x for x in row] for row in A.rows], c, 3 * A.denominator))


def test_matrices_that_do_not_fit_have_no_product_and_no_sum() -> None:
    two, three = Matrix.zeros(2, 2), Matrix.zeros(3, 3)
    for left, right in ((two, three), (three, two), (Matrix.zeros(2, 3), two)):
        with pytest.raises(ValueError, match="no product"):
            left @ right
    for other in (three, Matrix.zeros(2, 3), Matrix.zeros(3, 2)):
        with pytest.raises(ValueError):
            two + other


def test_parts_of_a_matrix() -> None:
    A = Matrix([[1, 2, 3], [4, 5, 6]], 3, 2)
    assert A.take() == A
    assert plain(A.take([1])) == [[2, Fraction(5, 2), 3]]
    assert plain(A.take([1, 0])) == plain(A)[::-1]
    assert plain(A.take(cols=[2, 0])) == [[Fraction(3, 2), Fraction(1, 2)], [3, 2]]
    assert plain(A.take([0], [1])) == [[1]]
    assert (A.take([], [0, 1]).nrows, A.take([], [0, 1]).ncols) == (0, 2)
    assert (A.take([0], []).nrows, A.take([0], []).ncols) == (1, 0)


def test_blocks_are_put_together() -> None:
    rng = random.Random(12)
    for r, c in SHAPES:
        A, B, C = drawn(rng, r, c), drawn(rng, 2, c), drawn(rng, r, 3)
        assert plain(stack([A, B], c)) == plain(A) + plain(B)
        assert plain(beside([A, C], r)) == [x + y for x, y in zip(plain(A), plain(C), strict=True)]
        both = plain(diagonal(A, C))
        zeros = [Fraction(0)]
        assert both[:r] == [row + zeros * 3 for row in plain(A)]
        assert both[r:] == [zeros * c + row for row in plain(C)]
        assert (diagonal(A, C).nrows, diagonal(A, C).ncols) == (2 * r, c + 3)
    assert stack([], 3) == Matrix([], 3)
    assert beside([], 2) == Matrix([[], []], 0)


def test_residues_and_inverses() -> None:
    assert Matrix([[1, -2], [0, 9]], 2, 3).modulo(7) == [[5, 4], [0, 3]]
    assert Matrix([], 2, 3).modulo(7) == []
    for ell in (2, 3, 4, 7, 12):
        for number in range(-5, 13):
            try:
                assert number * inverse(number, ell) % ell == 1
            except NotAUnit:
                assert any(number % p == 0 and ell % p == 0 for p in (2, 3, 7))
    assert product([[1, 2], [3, 4]], [[5], [6]], 1) == [[17], [39]]
    assert product([[1, 2], [3, 4]], [[5], [6]], 1, 7) == [[3], [4]]
    assert product([[], []], [], 2) == [[0, 0], [0, 0]]
    assert product([], [[1]], 1) == []


def test_an_echelon_keeps_what_is_new_with_pivots_1() -> None:
    basis = Echelon(7)
    assert basis.add([0, 3, 6]) == [0, 1, 2]
    assert basis.add([0, 5, 3]) is None
    assert basis.add([2, 1, 4]) == [1, 0, 1]
    assert basis.add([3, 1, 5]) is None
    assert basis.add([0, 0, 0]) is None
    assert basis.add([0, 1, 3]) == [0, 0, 1]
    assert basis.add([6, 5, 4]) is None
    assert [pivot for pivot, _ in basis.rows] == [1, 0, 2]
    with pytest.raises(NotAUnit):
        Echelon(6).add([2, 1])
    assert Echelon(6).add([0, 5]) == [0, 1]


@pytest.mark.parametrize("ell", [2, 3, 7, 13, 19, 31, 61])
def test_an_echelon_of_bytes_keeps_what_one_of_integers_keeps(ell: int) -> None:
    rng = random.Random(ell)
    n, size = 2 * BLOCK + 30, 2 * BLOCK + 9
    basis = [[rng.randrange(ell) for _ in range(n)] for _ in range(size)]
    rows = basis[: 2 * BLOCK + 1] + [
        [sum(f * x for f, x in zip(factors, column, strict=True)) % ell for column in columns]
        for columns in [list(zip(*basis, strict=True))]
        for factors in [[rng.choice((0, 1, rng.randrange(ell))) for _ in basis] for _ in range(40)]
    ]
    short, long = ByteEchelon(ell, n), Echelon(ell)
    for row in rows:
        assert (short.add(row) is None) == (long.add(row) is None)
    assert short.count == long.count > 2 * BLOCK
    for k, (pivots, numbers) in enumerate(short.blocks):
        table = [number.to_bytes(n, "little") for number in numbers]
        assert all(entry < ell for row in table for entry in row)
        assert [[row[j] for j in pivots] for row in table] == [
            [int(a == b) for b in range(len(table))] for a in range(len(table))
        ]
        earlier = [j for before, _ in short.blocks[:k] for j in before]
        assert not any(row[j] for row in table for j in earlier)


@pytest.mark.parametrize("ell", [6, 25, 60, 64])
def test_an_echelon_of_bytes_claims_no_rank_that_is_not_there(ell: int) -> None:
    rng, seen = random.Random(ell), 0
    for _ in range(300):
        A = Matrix([[rng.choice((0, 0, 1, 5, ell - 1)) for _ in range(4)] for _ in range(4)], 4)
        basis = ByteEchelon(ell, 4)
        try:
            for row in A.modulo(ell):
                basis.add(row)
            seen += basis.count == 4
        except NotAUnit:
            pass
        assert basis.count <= rank(A)
    assert seen


def test_ranks_take_bytes_up_to_a_small_modulus() -> None:
    assert isinstance(echelon(SMALL, 3), ByteEchelon)
    assert isinstance(echelon(SMALL + 1, 3), Echelon)
    assert ByteEchelon(7, 3).add([0, 0, 0]) is None
    assert ByteEchelon(7, 3).add([0, 3, 6]) == bytes([0, 1, 2])
    assert ByteEchelon(7, 0).add([]) is None


def fractions(*numbers: object) -> list[Fraction]:
    return [Fraction(str(number)) for number in numbers]


def value(p: list[Fraction], x: Fraction) -> Fraction:
    return sum((c * x**k for k, c in enumerate(p)), Fraction(0))


def test_polynomials_multiply_and_divide() -> None:
    rng = random.Random(13)
    for _ in range(200):
        a = fractions(*(rng.randint(-3, 3) for _ in range(rng.randint(1, 5))))
        b = stripped(fractions(*(rng.randint(-3, 3) for _ in range(rng.randint(0, 3))), 2))
        for x in fractions(-2, 0, 1, 3):
            assert value(poly_product(a, b), x) == value(a, x) * value(b, x)
        quotient, rest = poly_divide(a, b)
        assert len(rest) < len(b) and (not rest or rest[-1])
        for x in fractions(-2, 0, 1, 3, 5):
            assert value(quotient, x) * value(b, x) + value(rest, x) == value(a, x)
        ell = rng.choice([3, 5, 7, 9])
        p, q = [int(c) % ell for c in a], [int(c) % ell for c in b]
        quotient, rest = poly_divide(p, q, ell)
        assert all(0 <= c < ell for c in (*quotient, *rest)) and len(rest) < len(q)
        total = poly_product(quotient, q) if quotient else []
        total = [
            c % ell for c in (x + y for x, y in itertools.zip_longest(total, rest, fillvalue=0))
        ]
        assert stripped(total) == stripped(p)


def test_polynomials_modulo_l() -> None:
    assert poly_modulo(fractions("1/2", 8, 7), 7) == [4, 1]
    assert poly_modulo(fractions(7), 7) == []
    with pytest.raises(NotAUnit):
        poly_modulo(fractions("1/7"), 7)
    assert stripped([0, 1, 0, 0]) == [0, 1]
    assert stripped([0, 0]) == []


def test_how_often_one_polynomial_divides_another() -> None:
    p, q = fractions(-1, 1), fractions(3, 1)
    for times in range(5):
        power = fractions(1)
        for _ in range(times):
            power = poly_product(power, p)
        assert exponent(p, poly_product(power, q)) == (times, q)
        assert exponent([6, 1], [int(c) % 7 for c in poly_product(power, q)], 7) == (times, [3, 1])


def test_coprime_polynomials_modulo_a_prime_share_no_root() -> None:
    for ell in (2, 3, 5):
        monic = [[*p, 1] for k in range(3) for p in itertools.product(range(ell), repeat=k)]
        for a, b in itertools.product(monic, repeat=2):
            short = len(a) <= 2 or len(b) <= 2
            roots = [
                x
                for x in range(ell)
                if not any(sum(c * x**k for k, c in enumerate(p)) % ell for p in (a, b))
            ]
            if short or roots:
                same_constant = len(a) == 1 or len(b) == 1
                assert coprime(list(a), list(b), ell) == (same_constant or not roots)
