"""Stability decided exactly, both ways, by both methods."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from mcexact.analysis.lyapunov import is_dominant, quadratic_form
from mcexact.analysis.stability import Separation, certify_stability, fastest_region, matrix_system
from mcexact.answer.loops import StabilityVerdict
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import FloatRefused, UsageError
from mcexact.exact.matrix import Matrix, block_diagonal
from mcexact.exact.roots import StabilityRegion
from tests.wording import refusal

NEAR = Fraction(1, 10**9)


def assert_valid(verdict: StabilityVerdict) -> None:
    checked = check_document(encode(verdict).encode("ascii"))
    assert checked.verdict == "VALID", checked.line()


def hidden(blocks: list[list[list[Fraction]]], seed: int = 1) -> Matrix:
    """These diagonal blocks after a drawn unimodular change of coordinates."""
    rng = random.Random(seed)
    M = block_diagonal([Matrix.from_rows(block) for block in blocks])
    N = M.nrows
    for _ in range(2 * N):
        i, j = rng.sample(range(N), 2)
        rows = [[int(a == b) for b in range(N)] for a in range(N)]
        back = [list(row) for row in rows]
        rows[i][j] = rng.choice([1, -1])
        back[i][j] = -rows[i][j]
        M = Matrix.from_rows(rows) @ M @ Matrix.from_rows(back)
    return M


def with_eigenvalues(slowest: Fraction, states: int) -> Matrix:
    """Real eigenvalues, the slowest one given, hidden."""
    values = [slowest, *(Fraction(-1 - k % 5) for k in range(states - 1))]
    return hidden([[[value]] for value in values])


@pytest.mark.parametrize("states", [1, 2, 5, 20])
@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("stable", [True, False])
def test_both_roads_agree(states: int, time: str, stable: bool) -> None:
    rng = random.Random(states)
    shift = (0 if stable else 4) if time == "continuous" else 0
    M = Matrix.from_rows(
        [
            [
                Fraction(rng.randint(-9, 9), 9 * states) - (2 - shift) * int(i == j)
                if time == "continuous"
                else Fraction(rng.randint(-9, 9), 10 * states) + int(i == j and not stable) * 2
                for j in range(states)
            ]
            for i in range(states)
        ]
    )
    loop = matrix_system(M, time)
    for method in ("polynomial", "lyapunov"):
        verdict = certify_stability(loop, method=method)
        assert verdict.stable is stable
        assert_valid(verdict)


@pytest.mark.parametrize(
    ("slowest", "stable"), [(NEAR, False), (-NEAR, True), (Fraction(0), False)]
)
def test_an_abscissa_of_one_billionth_is_told_apart(slowest: Fraction, stable: bool) -> None:
    verdict = certify_stability(matrix_system(with_eigenvalues(slowest, 40)))
    assert verdict.stable is stable
    assert_valid(verdict)


def test_a_pair_exactly_on_the_boundary_is_not_stable() -> None:
    rotation = [[Fraction(0), Fraction(1)], [Fraction(-1), Fraction(0)]]
    for time in ("continuous", "discrete"):
        M = hidden([rotation, [[Fraction(-1, 2)]], [[Fraction(-1, 3)]]])
        verdict = certify_stability(matrix_system(M, time))
        assert not verdict.stable
        assert_valid(verdict)


def test_a_loop_is_certified_block_by_block() -> None:
    T = Matrix.from_rows([[1, 0, 0], [1, 1, 0], [0, 1, 1]])
    Delta = Matrix.from_rows([[-1, 5, 7], [0, -2, 1], [0, -1, -2]])
    inverse = Matrix.from_rows([[1, 0, 0], [-1, 1, 0], [1, -1, 1]])
    loop = matrix_system(T @ Delta @ inverse)
    separation = Separation(T, Delta, (1, 2))
    verdict = certify_stability(loop, rate="1/2", separation=separation)
    assert verdict.stable and verdict.method == "lyapunov"
    assert_valid(verdict)
    late = certify_stability(loop, rate=1, separation=separation)
    assert not late.stable and late.method == "polynomial"
    assert_valid(late)


@pytest.mark.parametrize(
    ("separation", "message"),
    [
        (Separation(Matrix.identity(1), Matrix.identity(1), (1,)), "blocks of 2 states"),
        (Separation(Matrix.identity(2), Matrix.identity(2), (1, 1)), "differs"),
        (
            Separation(Matrix.identity(2), Matrix.from_rows([[0, 1], [1, 0]]), (1, 1)),
            "triangular",
        ),
        (Separation(Matrix.zeros(2, 2), Matrix.identity(2) * -1, (1, 1)), "singular"),
    ],
)
def test_a_separation_that_does_not_fit_is_refused(separation: Separation, message: str) -> None:
    loop = matrix_system(Matrix.from_rows([[-1, 1], [0, -2]]))
    with pytest.raises(UsageError, match=message):
        certify_stability(loop, separation=separation)


def test_lyapunov_matrices_do_not_decide_on_the_boundary() -> None:
    loop = matrix_system(Matrix.from_rows([[0, 1], [-1, 0]]))
    with pytest.raises(UsageError, match="leave out `method`"):
        certify_stability(loop, method="lyapunov")


@pytest.mark.parametrize("size", [1, 45])
def test_a_bound_beyond_floats_is_decided_by_the_polynomial(size: int) -> None:
    loop = matrix_system(Matrix.identity(size) * -1)
    assert not certify_stability(loop, rate=10**400).stable
    with pytest.raises(UsageError, match="leave out `method`"):
        certify_stability(loop, rate=10**400, method="lyapunov")


def test_a_quadratic_form_means_what_it_says() -> None:
    D = with_eigenvalues(Fraction(-1), 8)
    form = quadratic_form(D, StabilityRegion("continuous", Fraction(1, 2)))
    assert form is not None and form.R is not None
    S = -(D.T @ form.P + form.P @ D + form.P)
    assert form.P == form.P.T
    assert is_dominant(form.R.T @ form.P @ form.R) and is_dominant(form.R2.T @ S @ form.R2)


def test_the_largest_rate_is_found_by_bisection() -> None:
    loop = matrix_system(with_eigenvalues(Fraction(-3, 7), 6))
    found = fastest_region(loop, accuracy=Fraction(1, 1000))
    assert found is not None and found.edge < Fraction(3, 7) <= found.edge + Fraction(1, 1000)
    assert_valid(certify_stability(loop, found))
    shrinking = matrix_system(hidden([[[Fraction(2, 3)]], [[Fraction(-1, 2)]]]), "discrete")
    found = fastest_region(shrinking, accuracy=Fraction(1, 1000))
    assert found is not None and found.edge - Fraction(1, 1000) <= Fraction(2, 3) < found.edge
    assert fastest_region(matrix_system(Matrix.from_rows([[1]]))) is None
    with pytest.raises(UsageError, match="positive"):
        fastest_region(loop, accuracy=0)


def test_a_loop_may_be_a_list_of_rows() -> None:
    assert_valid(certify_stability(matrix_system([[-1, "1/2"], [0, -2]]), rate="1/2"))
    with pytest.raises(FloatRefused, match=r"M\[0\]\[0\]"):
        matrix_system([[-1.5]])


def test_no_states_are_stable() -> None:
    for method in ("polynomial", "lyapunov"):
        verdict = certify_stability(matrix_system(Matrix.zeros(0, 0)), method=method)
        assert verdict.stable
        assert_valid(verdict)


def test_a_region_of_the_other_time_domain_is_refused() -> None:
    loop = matrix_system([[-1]])
    for options in ({}, {"rate": 1}):
        with refusal(UsageError):
            time = "continuous" if options else "discrete"
            certify_stability(loop, StabilityRegion(time), **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("method", ["polynomial", "lyapunov"])
@pytest.mark.parametrize(
    ("limits", "stable"),
    [
        ({"damping": "59/100"}, True),
        ({"damping": "61/100"}, False),
        ({"largest_modulus": "51/10"}, True),
        ({"largest_modulus": "49/10"}, False),
        ({"damping": 0.5, "largest_modulus": 6, "rate": 1}, True),
        ({"damping": 0.5, "largest_modulus": 6, "rate": "7/2"}, False),
    ],
)
def test_a_region_is_decided_with_limits_by_both_methods(limits, stable, method):
    loop = matrix_system([[-3, 4, 1], [-4, -3, 0], [0, 0, -2]])
    found = certify_stability(loop, method=method, **limits)
    assert found.stable == stable and found.region.limits.keys() == limits.keys() - {"rate"}
    assert_valid(found)


def test_limits_are_decided_block_by_block():
    blocks = [[[Fraction(-3), Fraction(4)], [Fraction(-4), Fraction(-3)]], [[Fraction(-1)]]]
    M = block_diagonal([Matrix.from_rows(block) for block in blocks])
    T = Matrix.from_rows([[1, 0, 2], [0, 1, 1], [0, 0, 1]])
    inverse = Matrix.from_rows([[1, 0, -2], [0, 1, -1], [0, 0, 1]])
    loop = matrix_system(T @ M @ inverse)
    separation = Separation(T, M, (2, 1), inverse)
    for damping in ("1/2", "7/10"):
        found = certify_stability(
            loop, method="lyapunov", separation=separation, damping=damping, largest_modulus=8
        )
        assert found.stable == (damping == "1/2")
        assert_valid(found)
