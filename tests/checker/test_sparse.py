"""Matrices that keep their entries alone, beside the same matrices with all rows."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import Matrix, SparseMatrix, beside, listed, stack
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import digest, read_matrix, read_plant
from mcexact.model import system_file
from tests.checker.handmade import listed as in_json
from tests.checker.handmade import plant
from tests.checker.test_system import digest_of
from tests.wording import refusal


def drawn(rng: random.Random, nrows: int, ncols: int) -> tuple[SparseMatrix, Matrix]:
    """One matrix in both forms."""
    rows = [[rng.choice([0, 0, 0, 1, -2, 2**70]) for _ in range(ncols)] for _ in range(nrows)]
    entries = [(i, j, x) for i, row in enumerate(rows) for j, x in enumerate(row) if x]
    d = rng.choice([1, 6])
    return SparseMatrix(nrows, ncols, entries, d), Matrix(rows, ncols, d)


def same(M: Matrix, N: Matrix) -> bool:
    return (M.rows, M.nrows, M.ncols, M.denominator) == (N.rows, N.nrows, N.ncols, N.denominator)


@pytest.mark.parametrize("seed", range(30))
def test_both_forms_are_the_same_matrix(seed: int) -> None:
    rng = random.Random(seed)
    r, c = rng.randint(0, 5), rng.randint(0, 5)
    S, M = drawn(rng, r, c)
    rows = rng.sample(range(r), rng.randint(0, r))
    cols = rng.sample(range(c), rng.randint(0, c))
    assert same(S, M)
    assert same(S.T, M.T)
    assert isinstance(S.T, SparseMatrix)
    assert (S.limbs, S.is_zero()) == (M.limbs, M.is_zero())
    for chosen in ((rows, None), (None, cols), (rows, cols), (None, None), (rows + rows, cols)):
        assert same(S.take(*chosen), M.take(*chosen))
        assert isinstance(S.take(*chosen), SparseMatrix)
    other, plain = drawn(rng, c, 3)
    for left, right in ((S, other), (S, plain), (M, other)):
        assert same(left @ right, M @ plain)
    assert same(S + S, M + M)
    assert (S - M).is_zero()
    assert same(S.times(Fraction(-2, 3)), M.times(Fraction(-2, 3)))
    if S.denominator == 1:
        assert S.modulo(7) == M.modulo(7)


@pytest.mark.parametrize("seed", range(20))
def test_matrices_stand_beside_each_other_in_both_forms(seed: int) -> None:
    rng = random.Random(seed)
    c, sizes = rng.randint(0, 5), [rng.randint(0, 4) for _ in range(rng.randint(1, 4))]
    parts = [drawn(rng, r, c) for r in sizes]
    one, other = [S for S, _ in parts], [M for _, M in parts]
    mixed = [rng.choice(pair) for pair in parts]
    for found in (stack(one, c), stack(mixed, c)):
        assert same(found, stack(other, c))
    turned = [S.T for S in one]
    assert same(beside(turned, c), beside([M.T for M in other], c))
    assert isinstance(stack(one, c), SparseMatrix)
    assert isinstance(beside(turned, c), SparseMatrix)
    assert not isinstance(stack([*one, other[0]], c), SparseMatrix)
    with limited(Budget(90)), pytest.raises(Refused, match="units of work"):
        stack([SparseMatrix(1, 1, [(0, 0, 1)]), SparseMatrix(1, 1, [(0, 0, 1)])], 1)


def test_the_longest_of_the_entries_and_the_denominator_counts() -> None:
    assert SparseMatrix(1, 3, [(0, 0, 1), (0, 2, -(2**60))]).limbs == 3
    assert SparseMatrix(1, 3, [(0, 0, 1)], 2**60).limbs == 3
    assert SparseMatrix(1, 3, []).limbs == 1
    assert SparseMatrix(1, 3, []).denominator == 1


def test_matrices_that_do_not_fit_have_no_product() -> None:
    S = SparseMatrix(1, 2, [])
    for left, right in ((S, S), (S, Matrix([[1]], 1))):
        with pytest.raises(ValueError, match="no product of 2 columns and 1 rows"):
            _ = left @ right
    with pytest.raises(ValueError, match="no product of"):
        _ = Matrix([[1, 1]], 2) @ S


def test_products_are_charged_before_they_are_made() -> None:
    full = SparseMatrix(1, 3000, [(0, j, 2**90) for j in range(3000)])
    column = Matrix([[2**90]] * 3000, 1)
    wide = Matrix([[1] * 1000], 1000)
    for left, right, least in (
        (full, column, 300_000),
        (SparseMatrix(1000, 1, []), wide, 40_000_000),
        (SparseMatrix(1000, 1, [(i, 0, 1) for i in range(1000)]), wide, 40_000_000),
    ):
        with limited(Budget(least)), pytest.raises(Refused, match="units of work"):
            _ = left @ right


def test_rows_are_charged_before_they_are_made() -> None:
    zero = SparseMatrix(10**6, 10**6, [])
    with limited(Budget(10**6)), pytest.raises(Refused, match="units of work"):
        _ = zero.rows
    for step in (lambda M: M.T, lambda M: M.at(range(1, 3)), lambda M: M.limbs):
        full = SparseMatrix(3000, 1, [(i, 0, 1) for i in range(3000)])
        with limited(Budget(2000)), pytest.raises(Refused, match="units of work"):
            step(full)
    with limited(Budget(2000)), pytest.raises(Refused, match="units of work"):
        zero.at(range(1000))
    with limited(Budget(2000)), pytest.raises(Refused, match="units of work"):
        listed(Matrix([[0] * 1000] * 3, 1000))
    with limited(Budget(6000)), pytest.raises(Refused, match="units of work"):
        listed(Matrix([[1] * 100 + [0] * 900] * 3, 1000))


def rows_with(nrows: int, ncols: int, nonzero: int) -> list[list[Any]]:
    """Rows of which so many entries, the last ones, are not 0."""
    cells = [0] * (nrows * ncols - nonzero) + list(range(1, nonzero + 1))
    return [cells[i * ncols : (i + 1) * ncols] for i in range(nrows)]


FORMS = [
    ("a large matrix of which an eighth is not 0", 32, 64, 256, True),
    ("a large matrix of zeros", 1, 2048, 0, True),
    ("a larger matrix", 64, 64, 100, True),
    ("one entry more than an eighth", 32, 64, 257, False),
    ("one cell less", 23, 89, 0, False),
    ("a matrix that is too small", 2, 2, 0, False),
]


@pytest.mark.parametrize(("what", "nrows", "ncols", "nonzero", "sparse"), FORMS)
def test_the_form_of_a_matrix_is_that_of_its_size_and_its_zeros(
    what: str, nrows: int, ncols: int, nonzero: int, sparse: bool
) -> None:
    rows = rows_with(nrows, ncols, nonzero)
    entries = in_json(rows, ncols)
    dense, read = Matrix(rows, ncols), read_matrix(entries, "A", None, None)
    assert isinstance(read, SparseMatrix) == sparse
    assert same(read, dense)
    assert (listed(read) is not None) == sparse
    found = listed(dense)
    assert (found is not None) == sparse
    if found is not None:
        assert isinstance(read, SparseMatrix)
        assert found.entries == read.entries
        assert same(found, dense)
    many = SparseMatrix(nrows, ncols, [tuple(triple) for triple in entries["entries"]])
    assert (listed(many) is not None) == sparse
    zeros = [[0] * ncols] * ncols
    A = in_json(zeros, ncols) if ncols > 2 else zeros
    for C, canonical in ((entries, sparse), (rows, not sparse)):
        system = plant(A, ([[]] * ncols, C))
        if canonical:
            read_plant(system)
        else:
            with refusal(Refused):
                read_plant(system)


def test_the_form_of_the_file_does_not_change_the_digest() -> None:
    rows = [[Fraction(i + 1, 6) if i == j else 0 for j in range(50)] for i in range(50)]
    texts = [[str(x) if x else 0 for x in row] for row in rows]
    none = {"shape": [0, 50], "entries": []}
    dense = {"A": texts, "channels": [{"B": [[]] * 50, "C": none}]}
    entries = in_json(texts, 50)
    entries["entries"] = [[49, 0, "0/3"], *reversed(entries["entries"])]
    files = [
        json.dumps({"format": "mcexact-system/1", "time": "discrete", **parts})
        for parts in (dense, {**dense, "A": entries})
    ]
    assert digest_of(files[0]) == digest_of(files[1])
    assert {system_file.read_system(text).digest() for text in files} == {digest_of(files[0])}
    (text,) = {system_file.read_system(text).canonical_text() for text in files}
    assert '"A":{"entries":[[0,0,"1/6"],[1,1,"1/3"],' in text
    assert digest(read_plant(json.loads(text))) == digest_of(files[0])


@pytest.mark.parametrize(
    ("reason", "edit"),
    [
        ("a zero is listed", lambda e: e.append([49, 49, 0])),
        ("not row by row", lambda e: e.reverse()),
        ("an entry is listed twice", lambda e: e.append(e[-1])),
        ("a value that can be reduced", lambda e: e.append([3, 3, "2/4"])),
        ("a value that is no number", lambda e: e.append([3, 3, "x"])),
        ("a position that is true", lambda e: e.insert(0, [0, True, 1])),
        ("a row outside", lambda e: e.append([50, 0, 1])),
        ("a column outside", lambda e: e.append([3, 50, 1])),
        ("a row below", lambda e: e.insert(0, [-1, 0, 1])),
        ("two numbers", lambda e: e.append([3, 3])),
    ],
)
def test_entries_are_written_in_one_form(reason: str, edit: Any) -> None:
    A: dict[str, Any] = {"shape": [50, 50], "entries": [[0, 0, 5], [2, 1, "-1/2"]]}
    none = {"shape": [0, 50], "entries": []}
    system = plant(A, ([[]] * 50, none))
    read_plant(system)
    edit(A["entries"])
    with pytest.raises(Refused) as found:
        read_plant(system)
    assert found.value.verdict == "MALFORMED"
