"""Arithmetic modulo primes: defining equations, and agreement with Q."""

import itertools
import pickle
import random
from fractions import Fraction
from math import prod

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import InputError, LimitReached
from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    hstack,
    krylov_pivots,
    low_rank_update,
    polynomial_residues,
    primes,
    random_matrix,
    residue,
    residues,
    residues_modulo_each,
    sparse_rank,
    vstack,
)
from mcexact.exact.polynomial import Polynomial
from tests.exact.draws import matrices, polynomials, square_matrices
from tests.wording import refusal

ELL = 1_000_003
SMALL_PRIME = 5
entries = st.integers(0, SMALL_PRIME - 1)


@st.composite
def modular_matrices(draw, nrows=None, ncols=None):
    """A matrix over the field with five elements."""
    r = draw(st.integers(0, 4)) if nrows is None else nrows
    c = draw(st.integers(0, 4)) if ncols is None else ncols
    rows = [[draw(entries) for _ in range(c)] for _ in range(r)]
    return ModularMatrix.from_rows(rows, SMALL_PRIME, ncols=c)


def test_the_stream_of_primes_is_repeatable_and_prime():
    found = list(itertools.islice(primes(5), 20))
    assert found == list(itertools.islice(primes(5), 20))
    assert found != list(itertools.islice(primes(6), 20))
    assert all(sympy.isprime(ell) and ell.bit_length() == 30 for ell in found)
    assert next(primes(0, bits=63)).bit_length() == 63
    with pytest.raises(InputError, match="expected primes of 8 to 63 bits, found 64"):
        next(primes(0, bits=64))


@pytest.mark.parametrize("modulus", [0, 1, -7, 9, 2**63, 2**61, 2**89 - 1, 7.0, True, "7"])
def test_a_modulus_is_a_prime_below_the_machine_word(modulus):
    for operation in (
        lambda: residues(Matrix.identity(2), modulus),
        lambda: ModularMatrix.from_rows([[1]], modulus),
        lambda: ModularMatrix.zeros(1, 1, modulus),
        lambda: ModularPolynomial.from_coefficients([1], modulus),
        lambda: random_matrix(1, 1, modulus, random.Random(0)),
    ):
        with pytest.raises(InputError, match="expected a prime modulus below"):
            operation()


@given(matrices())
def test_residues_are_those_of_the_entries(M):
    found = residues(M, ELL)
    assert found.rows() == [[residue(q, ELL) for q in row] for row in M.rows()]
    assert found.shape == M.shape


def test_a_modulus_that_divides_a_denominator_is_refused():
    with pytest.raises(InputError, match="the modulus 5 divides a denominator; draw another"):
        residues(Matrix.from_rows([["1/10"]]), 5)
    with pytest.raises(InputError, match="divides a denominator"):
        residue(Fraction(1, 5), 5)
    with pytest.raises(InputError, match="divides a denominator"):
        polynomial_residues(Polynomial.of("1/5"), 5)


@given(square_matrices())
def test_characteristic_polynomials_commute_with_reduction(M):
    expected = polynomial_residues(characteristic_polynomial(M), ELL)
    assert residues(M, ELL).characteristic_polynomial() == expected


@given(matrices())
def test_a_rank_modulo_a_prime_is_never_too_large(M):
    assert residues(M, ELL).rank() <= rank(M)
    integral = M * M.denominator
    assert residues(integral, 2).rank() <= rank(M)


@given(st.data())
def test_sums_products_and_blocks(data):
    r, k, c = (data.draw(st.integers(0, 3)) for _ in range(3))
    A, D = data.draw(modular_matrices(r, k)), data.draw(modular_matrices(r, k))
    B = data.draw(modular_matrices(k, c))
    expected = [
        [sum(A[i, t] * B[t, j] for t in range(k)) % SMALL_PRIME for j in range(c)] for i in range(r)
    ]
    assert (A @ B).rows() == expected
    assert A + D - D == A
    assert ModularMatrix.zeros(r, k, SMALL_PRIME) == A - A
    assert (A - A).is_zero()
    assert -A == A * -1 == -1 * A
    assert (A @ B).T == B.T @ A.T
    both = hstack([A, D])
    assert both.rows() == [x + y for x, y in zip(A.rows(), D.rows(), strict=True)]
    assert both.take(cols=range(k)) == A
    assert vstack([A, D]).rows() == A.rows() + D.rows()
    assert vstack([A, D]).take(rows=range(r, 2 * r)) == D
    assert pickle.loads(pickle.dumps(A)) == A
    assert hash(A) == hash(A + D - D)


@given(modular_matrices())
def test_echelon_forms_and_null_spaces(M):
    reduced, pivots = M.rref()
    assert reduced.shape == M.shape
    r = M.rank()
    assert reduced.take(rows=range(r), cols=pivots) == ModularMatrix.identity(r, SMALL_PRIME)
    assert M.take(cols=pivots) @ reduced.take(rows=range(r)) == M
    X, free = M.nullspace()
    assert (M @ X).is_zero()
    assert X.shape == (M.ncols, M.ncols - r)
    assert X.take(rows=free) == ModularMatrix.identity(X.ncols, SMALL_PRIME)


def determinant(M):
    """The sum of the products along all permutations, with their signs."""
    total = 0
    for order in itertools.permutations(range(M.nrows)):
        inversions = sum(a > b for a, b in itertools.combinations(order, 2))
        total += (-1) ** inversions * prod(M[i, j] for i, j in enumerate(order))
    return total % M.modulus


@given(st.integers(0, 3).flatmap(lambda n: modular_matrices(n, n)))
def test_square_matrices(M):
    n = M.nrows
    chi = M.characteristic_polynomial()
    assert chi(0) == (-1) ** n * determinant(M) % SMALL_PRIME
    assert M.minimal_polynomial().divides(chi)
    assert M.determinant() == determinant(M)
    assert M.entries() == [entry for row in M.rows() for entry in row]
    found = M.inverse()
    assert M.solve(ModularMatrix.identity(n, SMALL_PRIME)) == found
    if found is None:
        assert determinant(M) == 0
    else:
        assert found @ M == ModularMatrix.identity(n, SMALL_PRIME)
    shifted = ModularMatrix.scalar(n, 2, SMALL_PRIME) - M
    assert chi(2) == determinant(shifted)
    assert (shifted.rank() < n) == (2 in chi.roots())


@pytest.mark.parametrize("shape", [(0, 0), (0, 3), (3, 0)])
def test_matrices_without_entries(shape):
    nrows, ncols = shape
    Z = ModularMatrix.zeros(nrows, ncols, ELL)
    assert Z.rank() == 0
    assert Z.rows() == [[]] * nrows
    assert Z.nullspace()[0] == ModularMatrix.identity(shape[1], ELL)
    assert (Z @ Z.T).shape == (shape[0], shape[0])
    assert hstack([Z, Z]).shape == (shape[0], 2 * shape[1])
    assert pickle.loads(pickle.dumps(Z)) == Z


@given(st.data())
def test_a_closed_loop_modulo_a_prime_is_the_residue_of_the_closed_loop(data):
    n, p, q = (data.draw(st.integers(0, 3)) for _ in range(3))
    A, B = data.draw(matrices(n, n)), data.draw(matrices(n, p))
    F, C = data.draw(matrices(p, q)), data.draw(matrices(q, n))
    parts = [residues(M, ELL) for M in (A, B, F, C)]
    assert low_rank_update(*parts) == residues(A + B @ F @ C, ELL)


def test_random_matrices_come_from_the_given_source():
    first = random_matrix(2, 3, ELL, random.Random(4))
    assert first == random_matrix(2, 3, ELL, random.Random(4))
    assert first != random_matrix(2, 3, ELL, random.Random(5))


def test_large_integers_are_reduced():
    assert ModularMatrix.from_rows([[2**200, -5]], 7).rows() == [[4, 2]]


I2 = ModularMatrix.identity(2, 7)


@pytest.mark.parametrize(
    ("operation", "message"),
    [
        (lambda: I2 + ModularMatrix.identity(2, 5), "moduli do not match: 7 and 5"),
        (lambda: I2 + ModularMatrix.identity(3, 7), r"2 × 2 \+ 3 × 3"),
        (lambda: I2 - ModularMatrix.identity(3, 7), r"2 × 2 - 3 × 3"),
        (lambda: I2 @ ModularMatrix.identity(3, 7), r"2 × 2 @ 3 × 3"),
        (lambda: hstack([I2, ModularMatrix.identity(3, 7)]), "2 × 2 stacked with 3 × 3"),
        (lambda: I2.solve(ModularMatrix.identity(3, 7)), "2 × 2 solved for 3 × 3"),
        (lambda: ModularMatrix.zeros(2, 3, 7).determinant(), "expected a square matrix"),
        (lambda: hstack([]), "expected at least one matrix to stack"),
        (lambda: vstack([]), "expected at least one matrix to stack"),
        (lambda: ModularMatrix.zeros(2, 3, 7).inverse(), "expected a square matrix"),
        (lambda: ModularMatrix.zeros(-1, 3, 7), "number of rows that is at least 0"),
        (lambda: ModularMatrix.from_rows([[1], [1, 2]], 7), "expected rows of 1 entries"),
        (lambda: ModularMatrix.from_rows([[0.5]], 7), "expected integer entries"),  # type: ignore[list-item]
        (lambda: ModularMatrix.from_rows([], 7, ncols=-1), "number of columns that is at least 0"),
        (lambda: random_matrix(-1, 2, 7, random.Random(0)), "number of rows that is at least 0"),
    ],
)
def test_what_makes_no_sense_is_refused(operation, message):
    with pytest.raises(InputError, match=message):
        operation()


def test_a_matrix_beyond_memory_is_refused():
    with refusal(LimitReached):
        ModularMatrix.zeros(2**40, 2**40, 7)


def test_positions_outside_are_refused():
    for wrong in (lambda: I2[2, 0], lambda: I2[0, -1], lambda: I2.take(rows=[2])):
        with pytest.raises(IndexError, match="in a 2 × 2 matrix"):
            wrong()


@given(polynomials(), polynomials())
def test_polynomial_arithmetic_commutes_with_reduction(p, q):
    a, b = polynomial_residues(p, ELL), polynomial_residues(q, ELL)
    assert a + b == polynomial_residues(p + q, ELL)
    assert a - b == polynomial_residues(p - q, ELL)
    assert a * b == polynomial_residues(p * q, ELL)
    assert pickle.loads(pickle.dumps(a)) == a
    assert hash(a + b - b) == hash(a)
    if b.degree >= 0:
        assert a // b * b + a % b == a
        assert b.divides(a * b)
    assert a.gcd(b).divides(a)
    inverse = a.inverse_modulo(b)
    assert (inverse is None) == (a.gcd(b).degree != 0)
    if inverse is not None:
        assert b.divides(inverse * a - ModularPolynomial.from_coefficients([1], a.modulus))


def test_roots_and_multiplicities_modulo_a_prime():
    x_minus_2 = ModularPolynomial.from_coefficients([-2, 1], 7)
    p = x_minus_2 * x_minus_2 * ModularPolynomial.from_coefficients([1, 0, 1], 7)
    assert p.roots() == [2]
    assert p(2) == 0
    assert x_minus_2.multiplicity_in(p) == 2
    zero = ModularPolynomial.from_coefficients([7], 7)
    assert zero.degree == -1
    assert zero.divides(zero)
    assert not zero.divides(p)
    assert ModularPolynomial.from_coefficients([3], 7).roots() == []
    assert repr(x_minus_2) == "ModularPolynomial([5, 1], modulus=7)"
    assert repr(I2) == "ModularMatrix([[1, 0], [0, 1]], modulus=7, shape=(2, 2))"


def test_operations_that_make_no_sense_for_polynomials():
    zero = ModularPolynomial.from_coefficients([], 7)
    one = ModularPolynomial.from_coefficients([1], 7)
    with pytest.raises(ZeroDivisionError):
        divmod(one, zero)
    with pytest.raises(InputError, match="every residue is a root of 0"):
        zero.roots()
    with refusal(InputError):
        one.multiplicity_in(one)
    with refusal(InputError):
        one + ModularPolynomial.from_coefficients([1], 5)


@given(matrices(), st.integers(0, 50), st.integers(0, 20))
def test_residues_modulo_several_primes_are_those_modulo_each(M, seed, count):
    ells = [p for p in itertools.islice(primes(seed), count) if M.denominator % p]
    assert residues_modulo_each(M, ells) == [residues(M, ell) for ell in ells]


def test_a_prime_that_divides_the_denominator_is_refused_among_others_too():
    with pytest.raises(InputError, match="divides a denominator"):
        residues_modulo_each(Matrix.from_rows([["1/7"]]), [5, 7])


@pytest.mark.parametrize("ell", [2, 7, 61])
def test_ranks_of_sparse_matrices_are_those_of_all_entries(ell: int) -> None:
    rng = random.Random(ell)
    for _ in range(20):
        nrows, ncols = rng.randint(40, 70), rng.randint(60, 80)
        cells = {
            (i, (i + rng.randint(0, 9)) % ncols): rng.randint(1, 99) for i in [*range(nrows)] * 3
        }
        cells |= {(0, j): x for (i, j), x in cells.items() if i == 1}
        M = Matrix.from_entries((nrows, ncols), [(i, j, x) for (i, j), x in cells.items()])
        assert sparse_rank(M, ell, 10**6) == residues(M, ell).rank()


@pytest.mark.parametrize("ell", [7, 13, 61])
def test_krylov_pivots_are_the_columns_that_depend_on_none_before(ell: int) -> None:
    rng, deficient = random.Random(ell), 0
    for _ in range(20):
        n, p, blocks = rng.randint(46, 60), rng.randint(1, 8), rng.randint(1, 12)
        cells = {(i, (i + rng.randint(0, 2)) % n): rng.randint(1, 99) for i in [*range(n)] * 2}
        cells = {(i, j): x for (i, j), x in cells.items() if i < n - 9 or j >= n - 9}
        A = Matrix.from_entries((n, n), [(i, j, x) for (i, j), x in cells.items()])
        A = A * Fraction(1, 5)
        B = Matrix.from_entries(
            (n, p), [(rng.randrange(n), j, rng.randint(1, 6)) for j in range(p)]
        )
        powers = [residues(B, ell)]
        for _ in range(blocks - 1):
            powers.append(residues(A, ell) @ powers[-1])
        columns = [row for power in powers for row in power.T.rows()]
        pivots = ModularMatrix.from_rows(columns, ell, ncols=n).T.rref()[1]
        deficient += len(pivots) < min(n, blocks * p)
        found = krylov_pivots(A, B, blocks, ell, 10**6)
        assert found == [divmod(c, p) for c in pivots]
    assert deficient > 3
    with pytest.raises(LimitReached, match="a Krylov matrix of"):
        krylov_pivots(A, B, blocks, ell, n * p * blocks - 1)


def test_a_matrix_without_a_narrow_band_is_left_open() -> None:
    rng = random.Random(0)
    cells = [(i, rng.randrange(300), 1 + k) for i in range(300) for k in range(4)]
    M = Matrix.from_entries((300, 300), list({(i, j): (i, j, x) for i, j, x in cells}.values()))
    with pytest.raises(LimitReached, match="no narrow band"):
        sparse_rank(M, 7, 10**5)
    assert sparse_rank(M, 7, 10**8) == residues(M, 7).rank()
