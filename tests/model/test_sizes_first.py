"""Sizes are compared before numbers are read: a wrong shape is told without reading any."""

import json
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.model import entries
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system

N = 40


@pytest.fixture
def entries_read(monkeypatch: pytest.MonkeyPatch) -> Callable[[], int]:
    """How many entries of matrices have been read, in files and from Python."""
    read = 0

    def counted(function: Callable[..., Any]) -> Callable[..., Any]:
        def counting(*arguments: Any, **options: Any) -> Any:
            nonlocal read
            read += 1
            return function(*arguments, **options)

        return counting

    def counted_rows(rows: Any, *arguments: Any, **options: Any) -> Matrix:
        nonlocal read
        # A Fraction comes from `read_number`, which has counted it.
        read += sum(type(entry) is not Fraction for row in rows for entry in row)
        return from_rows(rows, *arguments, **options)

    from_rows = Matrix.from_rows
    monkeypatch.setattr(entries, "read_number", counted(entries.read_number))
    monkeypatch.setattr(Matrix, "from_rows", counted_rows)
    return lambda: read


def document(zero: Any, **changed: Any) -> dict[str, Any]:
    """A system file of N states in which every number is a zero of this kind."""
    channel = {"B": [[zero]] * N, "C": [[zero] * N]}
    found = {"format": "mcexact-system/1", "time": "continuous", "A": [[zero] * N] * N}
    channel |= {key: changed.pop(key) for key in ("B", "C") if key in changed}
    return found | {"channels": [{"B": [[zero]] * N, "C": [[zero] * N]}, channel]} | changed


WRONG = [
    ({"B": [[0]] * (N - 1)}, r"channels\[1\]\.B: expected 40 rows, found 39"),
    ({"C": [[0] * (N + 1)]}, r"channels\[1\]\.C: expected 40 columns, found 41"),
    ({"C": [[0] * N, [0]]}, r"channels\[1\]\.C\[1\]: expected 40 entries as in row 0, found 1"),
    ({"A": [[0] * N] * (N + 1)}, r"A: expected a square matrix, found 41 × 40"),
    ({"B": {"shape": [N + 1, 1], "entries": []}}, r"channels\[1\]\.B: expected 40 rows, found 41"),
]


@pytest.mark.parametrize("zero", [0, 0.0, "0/1"])
@pytest.mark.parametrize(("changed", "message"), WRONG)
def test_a_file_with_a_wrong_shape_is_refused_before_any_number_is_read(
    entries_read: Callable[[], int], zero: Any, changed: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        read_system(json.dumps(document(zero, **changed)))
    assert entries_read() == 0


@pytest.mark.parametrize("zero", [0, "0/1"])
def test_matrices_from_python_of_a_wrong_shape_are_refused_before_any_entry_is_read(
    entries_read: Callable[[], int], zero: Any
) -> None:
    A, B, C = [[zero] * N] * N, [[zero]] * N, [[zero] * N]
    with pytest.raises(InputError, match=r"B\[1\]: expected 40 rows, found 39"):
        MultiChannelSystem(A, [B, B[1:]], [C, C])
    with pytest.raises(InputError, match=r"C\[1\]: expected 40 columns, found 39"):
        MultiChannelSystem(A, [B, B], [C, [C[0][1:]]])
    with pytest.raises(InputError, match="A: expected a square matrix, found 39 × 40"):
        MultiChannelSystem(A[1:], [B], [C])
    assert entries_read() == 0


def test_the_entries_of_right_shapes_are_counted(entries_read: Callable[[], int]) -> None:
    read_system(json.dumps(document(0)))
    assert entries_read() == N * N + 4 * N


def test_a_number_that_occurs_again_is_read_once(entries_read: Callable[[], int]) -> None:
    system = read_system(json.dumps(document(0.5)))
    assert system.A[N - 1, 0] * 2 == 1
    assert entries_read() == 5


def test_long_and_short_numbers_beside_each_other_are_read_exactly() -> None:
    long = 10**30 + 7
    text = json.dumps(document(0, A=[[long] + [-3] * (N - 1)] + [[0.25] * N] * (N - 1)))
    A = read_system(text).A
    assert (A[0, 0], A[0, 1], A[1, 0] * 4) == (long, -3, 1)
