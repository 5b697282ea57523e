"""Shrunk subspaces: Wong sequence and repair over tiny fields, exact subspaces over Q."""

import itertools
import random
from collections.abc import Sequence

import pytest

from mcexact.analysis.subspaces import (
    evidence,
    exact_subspace,
    obstruction_modulo,
    shrunk_subspace,
)
from mcexact.answer.evidence import DualSubspace
from mcexact.derived.modular import ModularSystem, closed_loop, drawn_gains
from mcexact.exact.linear_algebra import PolynomialMatrix, rank
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem

Table = list[list[int]]


def rank_modulo(rows: Sequence[Sequence[int]], ell: int) -> int:
    """Plain elimination modulo a prime."""
    table = [[value % ell for value in row] for row in rows]
    found = 0
    for j in range(len(table[0]) if table else 0):
        pivot = next((i for i in range(found, len(table)) if table[i][j]), None)
        if pivot is None:
            continue
        table[found], table[pivot] = table[pivot], table[found]
        inverse = pow(table[found][j], -1, ell)
        for i in range(len(table)):
            if i != found and table[i][j]:
                factor = table[i][j] * inverse
                table[i] = [
                    (a - factor * b) % ell for a, b in zip(table[i], table[found], strict=True)
                ]
        found += 1
    return found


def pencil_ranks(system: MultiChannelSystem, mu: int, ell: int) -> dict[tuple[int, ...], int]:
    """The rank of P_s(μ) modulo ℓ for every subset s."""
    n, m, ranks = system.n, system.m, {}
    for size in range(m + 1):
        for s in itertools.combinations(range(m), size):
            rows = []
            for i in range(n):
                row = [mu * (i == j) - system.A.numerators[i][j] for j in range(n)]
                for t in range(m):
                    row += system.B(t).numerators[i] if t not in s else ()
                rows.append(row)
            for t in s:
                rows += [[*row, *[0] * (len(rows[0]) - n)] for row in system.C(t).numerators]
            ranks[s] = rank_modulo(rows, ell)
    return ranks


def drawn_over(ell: int, rng: random.Random) -> MultiChannelSystem:
    """A system with residues as entries, up to 4 states and 3 channels of up to 2 inputs."""
    n, m = rng.randint(1, 4), rng.randint(1, 3)

    def draw(nrows: int, ncols: int) -> Matrix:
        density = rng.choice([0.3, 0.6, 1.0])
        rows = [
            [rng.randrange(ell) if rng.random() < density else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]
        return Matrix.from_integers(rows, ncols=ncols)

    B = [draw(n, rng.randint(0, 2)) for _ in range(m)]
    C = [draw(rng.randint(0, 2), n) for _ in range(m)]
    return MultiChannelSystem(draw(n, n), B, C)


@pytest.mark.parametrize("ell", [2, 3, 5])
def test_the_search_agrees_with_enumeration_over_small_fields_from_any_gains(ell: int) -> None:
    """Over two elements most draws are not of greatest rank, so the repair has to work."""
    rng = random.Random(ell)
    obstructed = 0
    for _ in range(300):
        system, mu = drawn_over(ell, rng), rng.randrange(ell)
        modular = ModularSystem(system, ell)
        zero = tuple(tuple((0,) * system.q(i) for _ in range(system.p(i))) for i in range(system.m))
        ranks = pencil_ranks(system, mu, ell)
        least = min(ranks.values())
        for gains in (zero, drawn_gains(modular, rng)):
            found = obstruction_modulo(modular, gains, mu)
            if least >= system.n:
                assert found is None
                continue
            obstructed += 1
            assert found is not None
            assert found.deficiency == system.n - least
            largest = max((s for s, value in ranks.items() if value == least), key=len)
            assert found.channels_T == tuple(i for i in range(system.m) if i not in largest)
            shifted = [
                [mu * (i == j) - value for j, value in enumerate(row)]
                for i, row in enumerate(closed_loop(modular, found.gains).rows())
            ]
            assert rank_modulo(shifted, ell) == least
    assert obstructed > 50


def test_exact_subspaces_satisfy_the_three_identities() -> None:
    """±√2: channel 1 does not reach it, channel 2 does not see what channel 1 drives and it."""
    A = [[1, 1, 2, 1], [0, 0, 2, 3], [0, 1, 0, 1], [0, 0, 0, 2]]
    B = [[[1], [0], [0], [0]], [[1], [2], [0], [1]]]
    C = [[[1, 3, 1, 2]], [[0, 0, 0, 1]]]
    system = MultiChannelSystem(A, B, C)
    p = Polynomial.of(-2, 0, 1)
    found = shrunk_subspace(system, p, random.Random(0))
    assert found is not None
    T = found.channels_T
    assert T == (0,)
    pencil = PolynomialMatrix.pencil(-system.A, Matrix.identity(4))
    assert ((pencil @ found.U - system.input_matrix(T) @ found.V) % p).is_zero()
    for i in range(system.m):
        if i not in T:
            assert (system.C(i) @ found.U).is_zero()
    assert found.U.take(rows=found.pivots) == PolynomialMatrix.identity(found.U.ncols)
    assert found.U.ncols == rank(system.input_matrix(T)) + found.deficiency


def test_a_mode_that_no_input_drives_takes_one_row_and_not_a_column_for_each_input() -> None:
    A = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 8, 7, 6], [0, 0, 0, 2]]
    B = [[[1], [0], [0], [0]], [[0], [1], [0], [0]], [[0], [0], [1], [0]]]
    C = [[[1, 2, 0, 1]], [[0, 1, 3, 1]], [[1, 1, 1, 1]]]
    system, p = MultiChannelSystem(A, B, C), Polynomial.of(-2, 1)
    found = shrunk_subspace(system, p, random.Random(0))
    assert found is not None
    assert found.dual
    assert found.channels_T == (0, 1, 2)
    assert found.U.ncols == found.deficiency == 1
    pencil = PolynomialMatrix.pencil(-system.A.T, Matrix.identity(4))
    assert ((pencil @ found.U) % p).is_zero()
    assert (system.input_matrix().T @ found.U).is_zero()
    whole = exact_subspace(system, found.channels_T, p)
    assert whole is not None
    assert whole.U.ncols == 4
    made = evidence(system.names, found)
    assert isinstance(made, DualSubspace)
    assert (made.channels_T, made.dual.channels_T) == (("1", "2", "3"), ())


def test_a_set_that_proves_nothing_has_no_subspace() -> None:
    system = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    mode = Polynomial.of(-1, 1)
    assert exact_subspace(system, [], mode) is None
    assert exact_subspace(system, [0], mode) is None
    assert shrunk_subspace(system, mode, random.Random(0)) is None


def test_dependent_inputs_do_not_count_twice() -> None:
    """Channel 1 has one input written twice; its rank is 1, so U has two columns."""
    system = MultiChannelSystem([[1, 0], [0, 1]], [[[1, 1], [0, 0]]], [[[1, 0]]])
    found = shrunk_subspace(system, Polynomial.of(-1, 1), random.Random(0))
    assert found is not None
    assert found.deficiency == 1
    assert found.V.nrows == (2 if found.channels_T else 0)
