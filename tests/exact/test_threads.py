"""Shared exact objects are used from several threads at once."""

from concurrent.futures import ThreadPoolExecutor

from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import root_discs


def test_threads_that_share_a_matrix_find_what_one_thread_finds():
    M = Matrix.from_rows([[(3 * i + 5 * j) % 7 - 3 for j in range(12)] for i in range(12)])

    def work(_):
        return characteristic_polynomial(M), rank(M), residues(M, 7).rank(), M @ M

    fresh = Matrix.from_rows(M.rows())
    expected = (
        characteristic_polynomial(fresh),
        rank(fresh),
        residues(fresh, 7).rank(),
        fresh @ fresh,
    )
    with ThreadPoolExecutor(4) as pool:
        assert all(found == expected for found in pool.map(work, range(40)))


def test_the_precision_of_one_thread_does_not_reach_another():
    polynomials = [Polynomial.of(-k, 0, 0, 1) * Polynomial.of(10**k, 1) for k in range(2, 14)]
    expected = [root_discs(p) for p in polynomials]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(root_discs, polynomials * 3)) == expected * 3
