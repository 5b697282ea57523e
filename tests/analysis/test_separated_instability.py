"""A "no" put together from the diagonal blocks of a loop."""

from dataclasses import replace

import pytest

from mcexact.analysis.stability import Separation, certify_stability, matrix_system
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix

T = Matrix.from_rows([[1, 0, 0], [1, 1, 0], [0, 1, 1]])
INVERSE = Matrix.from_rows([[1, 0, 0], [-1, 1, 0], [1, -1, 1]])


def loop_of(Delta, time="continuous"):
    return matrix_system(T @ Delta @ INVERSE, time)


@pytest.mark.parametrize(
    ("time", "rows"),
    [
        ("continuous", [[-1, 500, 7], [0, -2, 1], [0, 3, 1]]),
        ("continuous", [[2, 500, 7], [0, -2, 1], [0, -1, -2]]),
        ("discrete", [["1/2", 500, 7], [0, 0, 1], [0, 3, 0]]),
        ("discrete", [[-3, 500, 7], [0, 0, "1/2"], [0, "1/2", 0]]),
    ],
)
def test_one_unstable_block_makes_a_no(time, rows):
    Delta = Matrix.from_rows(rows)
    loop, separation = loop_of(Delta, time), Separation(T, Delta, (1, 2), INVERSE)
    verdict = certify_stability(loop, method="lyapunov", separation=separation)
    assert not verdict.stable and verdict.method == "instability"
    checked = check_document(encode(verdict).encode())
    assert checked.verdict == "VALID", checked.line()


def test_a_wrong_inverse_is_refused():
    Delta = Matrix.from_rows([[-1, 5, 7], [0, -2, 1], [0, -1, -2]])
    separation = Separation(T, Delta, (1, 2), INVERSE)
    assert certify_stability(loop_of(Delta), separation=separation).stable
    with pytest.raises(UsageError, match="inverse of T"):
        certify_stability(loop_of(Delta), separation=replace(separation, inverse=T))
